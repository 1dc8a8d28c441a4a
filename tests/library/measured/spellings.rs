//! Files from other programs: names, units, and skipped columns and rows.

use gyrolab::engine::data::{ColumnOptions, ColumnSigma, MeasuredData, doubts, read, read_with};
use gyrolab::engine::scenario::Document;
use gyrolab::engine::scenario::csv::renaming;
use gyrolab::engine::text::printable::is_steering;
use std::sync::Arc;

fn options(map: &str, sigma: &str) -> ColumnOptions {
    let map = map.split(',').filter(|part| !part.is_empty());
    let sigma = sigma.split(',').filter(|part| !part.is_empty());
    ColumnOptions {
        map: map.map(|part| renaming(part).unwrap()).collect(),
        sigma: sigma.map(|part| part.parse().unwrap()).collect(),
    }
}

#[track_caller]
fn mapped(text: &str, map: &str) -> MeasuredData {
    let read = read_with("lab.csv", text, &options(map, ""));
    read.unwrap_or_else(|problems| panic!("{text}{problems}"))
}

#[track_caller]
fn refusal(origin: &str, text: &str, map: &str) -> String {
    match read_with(origin, text, &options(map, "")) {
        Ok(_) => panic!("accepted: {text}"),
        Err(problems) => problems.to_string(),
    }
}

/// Returns the time of the last row, and the names and values of its curves.
#[track_caller]
fn last(measured: &MeasuredData) -> (f64, Vec<(&'static str, f64)>) {
    let series = measured.series().unwrap();
    let curves = series.curves.iter();
    let values = curves.map(|curve| {
        let value = curve.points.last().unwrap().value;
        (curve.quantity.name, (value * 1e9).round() / 1e9)
    });
    (*series.times_s.last().unwrap(), values.collect())
}

const RATES: [(&str, f64); 3] = [
    ("w1_rad_per_s", 1.0),
    ("w2_rad_per_s", 2.0),
    ("w3_rad_per_s", 3.0),
];

#[test]
fn known_spellings_are_read_with_their_units() {
    for (names, row) in [
        ("Time (s),X (rad/s),Y (rad/s),Z (rad/s)", "0.5,1,2,3"),
        (
            "\"Time (s)\",\"Rotation x (rad/s)\",\"Rotation y (rad/s)\",\"Rotation z (rad/s)\"",
            "0.5,1,2,3",
        ),
        (
            "Time (s),Angular velocity x (rad/s),Angular velocity y (rad/s),Angular velocity z (rad/s)",
            "0.5,1,2,3",
        ),
        (
            "Time(ms),Gyr X (°/s),Gyr Y (°/s),Gyr Z (°/s)",
            "500,57.29577951308232,114.59155902616465,171.88733853924697",
        ),
        (
            "timestamp_ms,gx_dps,gy_dps,gz_dps",
            "500,57.29577951308232,114.59155902616465,171.88733853924697",
        ),
        (
            "t / ms,gyro_x_deg_per_s,gyro_y_deg_per_s,gyro_z_deg_per_s",
            "500,57.29577951308232,114.59155902616465,171.88733853924697",
        ),
        (
            "t [s],GYROSCOPE X [rad s⁻¹],GYROSCOPE Y [rad s⁻¹],GYROSCOPE Z [rad s⁻¹]",
            "0.5,1,2,3",
        ),
        ("time,wx,wy,wz", "0.5,1,2,3"),
        ("time,gFx,gFy,gFz,wx,wy,wz,TgF", "0.5,9,9,9,1,2,3,9"),
        ("t_us;w1_rad_s;w2_rad_s;w3_rad_s", "500000;1;2;3"),
        (
            "Zeit (s);Drehrate x (rad/s);Drehrate y (rad/s);Drehrate z (rad/s)",
            "0,5;1,0;2,0;3,0",
        ),
    ] {
        let text = format!("{names}\n{row}\n");
        assert_eq!(last(&mapped(&text, "")), (0.5, RATES.to_vec()), "{names}");
    }
    let gyroscope = "time,seconds_elapsed,z,y,x\n1700000000500000000,0.5,3,2,1\n";
    let measured = read("2024/Gyroscope.csv", gyroscope).unwrap();
    assert_eq!(
        measured.series().unwrap().curves[2].quantity.name,
        RATES[0].0
    );
    assert_eq!(measured.left_out, ["time"]);
    // The file of the accelerometer has the same columns.
    let told = refusal("Accelerometer.csv", gyroscope, "");
    assert!(told.contains("--map "), "{told}");
}

#[test]
fn tracker_files_are_read_with_units_and_without_titles() {
    let metres = vec![("x_m", 0.25), ("y_m", -0.125)];
    for text in [
        "t\tx\ty\t\n0\t0\t0\n0.5\t0.25\t-0.125\n",
        "\tmass A\t\t\nt (s)\tx (m)\ty (m)\t\n0\t0\t0\n0.5\t0.25\t-0.125\n",
        "\tmass A\t\t\nt\tx (cm)\ty (cm)\t\n0\t0\t0\n0.5\t25.0\t-12.5\n",
        "t;x (mm);y (mm)\n0;0;0\n0,5;2,5E2;-1,25E2\n",
        "t,x_cm,y_cm,note\n0.5,25,-12.5,end\n",
    ] {
        assert_eq!(last(&mapped(text, "")), (0.5, metres.clone()), "{text}");
    }
}

const TRACKS: &str =
    "#multi:\n\tmass A\t\tmass B\t\t\nt\tx\ty\tx\ty\t\n0\t1\t2\t3\t4\n1\t5\t6\t7\t8\n";

#[test]
fn one_of_several_tracks_is_chosen_by_a_map() {
    let told = refusal("trk.txt", TRACKS, "");
    for words in ["mass A", "mass B", "--map 2=x_m,3=y_m", "--map 4=x_m,5=y_m"] {
        assert!(told.contains(words), "{words}: {told}");
    }
    let chosen = |map| last(&mapped(TRACKS, map)).1;
    assert_eq!(chosen("2=x_m,3=y_m"), [("x_m", 5.0), ("y_m", 6.0)]);
    assert_eq!(chosen("4=x_m,5=y_m"), [("x_m", 7.0), ("y_m", 8.0)]);
    assert_eq!(chosen("2=-,3=-"), [("x_m", 7.0), ("y_m", 8.0)]);
    let ambiguous = refusal("trk.txt", TRACKS, "x=x_m");
    assert!(ambiguous.contains("columns 2 and 4"), "{ambiguous}");
}

#[test]
fn unknown_columns_are_skipped_and_named() {
    let text = "t_s,tilt_deg,ax,ay,az,temp,time,,title\n0,30,1,1,1,1,1,1,a\n";
    let measured = mapped(text, "");
    let left_out = ["ax", "ay", "az", "temp", "time", "column 8", "title"];
    assert_eq!(measured.left_out, left_out);
    assert!(measured.notes().concat().contains("az, temp, time"));
}

#[test]
fn unmapped_columns_of_a_mapped_file_are_ignored() {
    let text = "time,clock,z,start.spin_rpm,spin_rpm,tilt_deg,tilt_deg,x_uncertainty_m,predicted_nutation_period_s\n\
                0,12:00,1,2,fast,1,2,3,4\n1,12:01,2,2,slow,1,2,3,4\n";
    let measured = mapped(text, "z=z_cm");
    assert_eq!(last(&measured).1, [("z_m", 0.02)]);
    assert_eq!(measured.left_out.len(), 7, "{:?}", measured.left_out);
}

#[test]
fn a_map_converts_units_and_skips_columns() {
    let euler = "t,theta,phi,x\n0,0.1,1,2\n0.5,0.5,1,2\n";
    let (_, values) = last(&mapped(euler, "theta=tilt_rad,x=-"));
    let degrees = (0.5_f64.to_degrees() * 1e9).round() / 1e9;
    assert_eq!(values, [("tilt_deg", degrees)]);
    let (time_s, _) = last(&mapped("T,theta\n0,1\n30,2\n", "T=t_min,theta=tilt_deg"));
    assert_eq!(time_s, 1800.0);
    // If the map names the unit of gyrolab, the unit in the column name is converted.
    let (time_of_row_s, of_gyroscope) = last(&mapped(
        "when_ms,gx_dps\n500,100\n",
        "when_ms=t_s,gx_dps=w1_rad_per_s",
    ));
    assert_eq!((time_of_row_s, of_gyroscope[0].1), (0.5, 1.745329252));
    let twice = refusal("lab.csv", euler, "theta=tilt_rad,phi=tilt_deg");
    assert!(twice.contains("is also mapped to tilt_deg"), "{twice}");
    let wrong = refusal("lab.csv", euler, "theta=tilt_kg");
    assert!(wrong.contains("--map theta=tilt_kg"), "{wrong}");
}

#[test]
fn uncertainties_are_converted_with_their_columns() {
    for (text, map) in [
        (
            "t_s,tilt_rad,tilt_uncertainty_rad\n0,1,0.017453292519943295\n",
            "",
        ),
        (
            "t_s,tilt_deg,tilt_uncertainty_rad\n0,1,0.017453292519943295\n",
            "",
        ),
        ("t_s,tilt_deg,tilt_deg_uncertainty\n0,1,1\n", ""),
        (
            "t_s,theta,dtheta\n0,1,0.017453292519943295\n",
            "theta=tilt_rad,dtheta=tilt_uncertainty_rad",
        ),
    ] {
        let measured = mapped(text, map);
        let sigma = measured.series().unwrap().curves[0].points[0].sigma;
        assert!((sigma.unwrap() - 1.0).abs() < 1e-12, "{text}: {sigma:?}");
    }
}

#[test]
fn the_sigma_option_adds_uncertainties() {
    let text = "t_s,theta,x_m,x_uncertainty_m\n0,1,1,0.5\n1,2,2,\n";
    for (sigma, of_tilt) in [
        ("theta=0.1", 0.1_f64.to_degrees()),
        ("tilt_deg=2", 2.0),
        ("tilt_rad=1", 1_f64.to_degrees()),
    ] {
        let measured = read_with("lab.csv", text, &options("theta=tilt_rad", sigma)).unwrap();
        let series = measured.series().unwrap();
        let sigmas = |curve: usize| series.curves[curve].points.iter().map(|point| point.sigma);
        assert!(
            sigmas(0).all(|stated| (stated.unwrap() / of_tilt - 1.0).abs() < 1e-12),
            "{sigma}"
        );
        assert_eq!(sigmas(1).collect::<Vec<_>>(), [Some(0.5), None]);
    }
    let both = read_with("lab.csv", text, &options("theta=tilt_rad", "x_cm=10")).unwrap();
    let sigmas = both.series().unwrap().curves[1]
        .points
        .iter()
        .map(|point| point.sigma);
    assert_eq!(sigmas.collect::<Vec<_>>(), [Some(0.5), Some(0.1)]);
    let wrong = read_with("lab.csv", text, &options("theta=tilt_rad", "y_m=1")).unwrap_err();
    assert!(
        wrong
            .to_string()
            .contains("--sigma y_m=1: is not a measured column"),
        "{wrong}"
    );
    for bad in ["x_m", "x_m=0", "x_m=-1", "x_m=nan", "x_m=a"] {
        assert!(bad.parse::<ColumnSigma>().is_err(), "{bad}");
    }
}

#[test]
fn rows_before_the_start_are_skipped_and_counted() {
    let text = "Time (s),Gyroscope x (rad/s)\n-1.616458334E-3,1\n8.0E-3,2\n1.8E-2,3\n";
    let mut measured = mapped(text, "");
    assert_eq!(measured.rows_before, 1);
    assert_eq!(measured.lines, [3, 4]);
    let series = measured.series().unwrap();
    assert_eq!(
        (series.times_s.len(), series.curves[0].points[0].row),
        (2, 0)
    );
    assert!(measured.keep_between(0.01, 1.0));
    assert_eq!(measured.rows_outside, 1);
    let notes = measured.notes().concat();
    assert!(notes.contains("1 row before t = 0 ignored"), "{notes}");
    let none = refusal("lab.csv", "t_s,tilt_deg\n-2,1\n-1,1\n", "");
    assert!(none.contains("begins at t = 0"), "{none}");
}

/// Returns the `--map` options in an error message.
fn maps_in(told: &str) -> Vec<String> {
    let parts = told.split("--map ").skip(1);
    let words = parts.map(|part| shlex::split(part.lines().next().unwrap()).unwrap());
    words
        .map(|words| words[0].trim_end_matches(',').to_owned())
        .collect()
}

#[test]
fn the_map_suggested_by_an_error_reads_the_file() {
    for (text, map) in [
        ("zeitpunkt,neigung\n0,30\n1,31\n", ""),
        ("a,b,c\n0,30,1\n1,31,1\n", ""),
        ("0,30\n1,31\n", ""),
        ("0 30\n1 31\n", ""),
        (
            "time,seconds_elapsed,z,y,x\n1700000000000000000,0.5,3,2,1\n1700000000000000001,0.6,3,2,1\n",
            "",
        ),
        ("time,x,y\n0,1,2\n1,1,2\n", ""),
        ("timestamp,wx,wy,wz\n0,1,2,3\n20,1,2,3\n40,1,2,3\n", ""),
        ("t_s,tild_deg\n0,1\n", ""),
        ("t_s,theta,phi\n0,0.5,1\n1,0.6,1\n", ""),
        ("t,theta,phi,psi\n0,0.5,1,1\n1,0.6,1,1\n", ""),
        ("theta,phi\n0.5,0\n0.6,1\n", "theta=tilt_rad"),
        ("t_s,tilt_deg,tilt_deg\n0,1,2\n", ""),
        ("t_s,start.spin_rpm,tilt_deg\n0,1,2\n", ""),
        ("t_s,t_uncertainty_s,tilt_deg\n0,1,2\n", ""),
        ("start.spin_rpn,predicted_nutation_period_s\n0,1\n", ""),
        (
            "start.spin_rpm,health,predicted_nutation_period_s\n0,good,1\n",
            "",
        ),
        ("ti'me;x=y;\"a,b\"\n0;30;1\n1;31;1\n", ""),
        (TRACKS, ""),
    ] {
        let told = refusal("lab.csv", text, map);
        let maps = maps_in(&told);
        assert!(!maps.is_empty(), "{text}{told}");
        for printed in maps {
            let read = read_with("lab.csv", text, &options(&printed, ""));
            read.unwrap_or_else(|problems| panic!("{text}{told}\n{printed}: {problems}"));
        }
    }
}

#[test]
fn a_single_column_of_readouts_is_a_table() {
    for text in [
        "predicted_nutation_period_s\n0.11\n0.12\n",
        "predicted_nutation_period_ms\n110\n\n120\n",
        "predicted_nutation_period_s\n0,11\n0,12\n",
    ] {
        let measured = mapped(text, "");
        let gyrolab::engine::data::DataKind::Table(table) = measured.data else {
            panic!("no table")
        };
        let values = table.readouts[0].points.iter().map(|point| point.value);
        assert_eq!(values.collect::<Vec<_>>(), [0.11, 0.12], "{text}");
    }
}

const TOP: &str = r#"
title = "A top"
[[body.part]]
name = "wheel"
shape = "cylinder"
mass_kg = 1
radius_m = 0.1
at_m = [0, 0, 0.25]
[start]
tilt_deg = 0
spin_rpm = 100
[motion]
scheme = "exact"
time_step_s = 0.01
steps = 100
"#;

#[test]
fn implausible_values_are_reported_once() {
    let doubts_of = |set: &str, text: &str| {
        let mut document = Document::parse("top.toml", TOP).unwrap();
        document.set(set).unwrap();
        let scenario = Arc::new(document.scenario().unwrap());
        doubts(&read("lab.csv", text).unwrap(), &scenario)
    };
    let beyond = doubts_of("start.tilt_deg=30", "t_s,x_m,y_m\n0,25,0\n1,15,20\n");
    let [only] = &beyond[..] else {
        panic!("{beyond:?}")
    };
    assert!(only.contains("--map x=x_cm,y=y_cm"), "{only}");
    assert!(doubts_of("start.tilt_deg=30", "t_s,x_m,y_m\n0,0.25,0\n1,0.15,0.2\n").is_empty());
    let radians = "t_s,tilt_deg\n0,0.5\n1,0.6\n";
    let told = doubts_of("start.tilt_deg=30", radians);
    assert!(told.len() == 1 && told[0].contains("tilt_rad"), "{told:?}");
    // A top that starts almost upright falls.
    let of_falling = doubts_of("start.tilt_deg=1", "t_s,tilt_deg\n0,0.02\n0.9,1.6\n");
    assert!(
        of_falling.len() == 1 && of_falling[0].contains("tilt_rad"),
        "{of_falling:?}"
    );
    assert!(doubts_of("start.tilt_deg=0", radians).is_empty());
}

#[test]
fn text_in_other_encodings_is_read_or_rejected_with_a_remedy() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("lab.csv");
    let name = path.to_str().unwrap();
    std::fs::write(&path, b"Time (s);Gyr X (\xb0/s)\r\n0,5;100\r\n").unwrap();
    let measured = gyrolab::engine::data::open(name).unwrap();
    assert_eq!(last(&measured), (0.5, vec![("w1_rad_per_s", 1.745329252)]));
    let utf16 = "t_s,tilt_deg\n0,1\n".encode_utf16();
    let bytes: Vec<u8> = [0xff, 0xfe]
        .into_iter()
        .chain(utf16.flat_map(u16::to_le_bytes))
        .collect();
    std::fs::write(&path, bytes).unwrap();
    let told = gyrolab::engine::data::open(name).unwrap_err().to_string();
    assert!(
        told.contains("UTF-16") && told.contains("CSV UTF-8"),
        "{told}"
    );
}

#[test]
fn names_in_notes_are_escaped() {
    let notes = mapped("t_s,\u{1b}x (cm)\n0,1\n", "").notes().concat();
    assert!(notes.contains("as x_m (times 0.01)"), "{notes}");
    assert!(!notes.chars().any(is_steering), "{notes}");
}

/// Rows of the user's own program are read in the same way.
#[test]
fn rows_of_a_users_program_may_have_units() {
    use gyrolab::studies::own_code::rows;
    let read = |text: &str, map: &str| rows::read(text, &options(map, "").map, None, 0.1);
    for (text, map) in [
        ("t;x;y;z\n0;0,1;0,2;0,3\n0,1;0,1;0,2;0,3\n", ""),
        ("t_ms,x (cm),y (cm),z (cm)\n0,10,20,30\n100,10,20,30\n", ""),
        (
            "T,X,Y,Z\n0,10,20,30\n100,10,20,30\n",
            "T=t_ms,X=x_cm,Y=y_cm,Z=z_cm",
        ),
        (
            "t_ms,X (cm),b,c,x\n0,10,20,30,9\n100,10,20,30,9\n",
            "2=x_m,3=y_cm,4=z_cm",
        ),
    ] {
        let rows = read(text, map).unwrap();
        let values: Vec<f64> = rows.columns.iter().map(|column| column.values[1]).collect();
        assert_eq!(values, [0.1, 0.2, 0.3], "{text}");
        assert_eq!(rows.times.own_s, None, "{text}");
    }
    let told = read("time,Pos X,Pos Y\n0,1,2\n", "")
        .unwrap_err()
        .to_string();
    assert!(told.contains("--map 'Pos X=x_m,Pos Y=y_m'"), "{told}");
}
