//! Reading files of measured data.

use gyrolab::engine::data::SHIPPED;
use gyrolab::engine::data::{DataKind, MeasuredData, RunTable, TimeSeries, open, read};
use toml::Value;

#[track_caller]
fn measured(text: &str) -> MeasuredData {
    read("lab.csv", text).unwrap_or_else(|problems| panic!("{problems}"))
}

#[track_caller]
fn series(text: &str) -> TimeSeries {
    match measured(text).data {
        DataKind::Series(series) => series,
        DataKind::Table(_) => panic!("is a table of runs: {text}"),
    }
}

#[track_caller]
fn table(text: &str) -> RunTable {
    match measured(text).data {
        DataKind::Table(table) => table,
        DataKind::Series(_) => panic!("is a time series: {text}"),
    }
}

#[test]
fn a_time_series_has_curves_with_gaps_and_uncertainties() {
    let text = "\u{feff}# a wheel\n#  on a string\nt_s,tilt_deg,spin_rpm,tilt_uncertainty_deg\n\
                0,30,,0.5\n\n# stopped for lunch\n1.5,31.5,600,\n1.5,32,,0.25\n";
    let measured = measured(text);
    assert_eq!(measured.about, "a wheel\n on a string\n");
    assert_eq!(measured.clone().keep_rows(|_| true), 4);
    let series = series(text);
    assert_eq!(series.times_s, [0.0, 1.5, 1.5]);
    assert_eq!(measured.lines, [4, 7, 8]);
    let [tilt, spin] = &series.curves[..] else {
        panic!("{series:?}")
    };
    let points = |curve: &gyrolab::engine::data::MeasuredCurve| -> Vec<(usize, f64, Option<f64>)> {
        let points = curve.points.iter();
        points
            .map(|point| (point.row, point.value, point.sigma))
            .collect()
    };
    assert_eq!(tilt.quantity.name, "tilt_deg");
    assert_eq!(
        points(tilt),
        [(0, 30.0, Some(0.5)), (1, 31.5, None), (2, 32.0, Some(0.25))]
    );
    assert_eq!(points(spin), [(1, 600.0, None)]);
    assert_eq!(spin.quantity.readout().unwrap().unit, "rpm");
}

#[test]
fn a_table_of_runs_has_settings_and_readouts() {
    let table = table(
        "motion.scheme,start.spin_rpm,start.spin_uncertainty_rpm,tilt_deg\nrk4,300,5,1\n,400,,\n",
    );
    let [scheme, spin] = &table.settings[..] else {
        panic!("{table:?}")
    };
    assert_eq!(scheme.values[0].as_ref().unwrap().as_str(), Some("rk4"));
    assert_eq!(scheme.values[1], None);
    let spins: Vec<_> = spin.values.iter().flatten().map(Value::as_float).collect();
    assert_eq!(spins, [Some(300.0), Some(400.0)]);
    assert_eq!(spin.sigmas, [Some(5.0), None]);
    assert_eq!(table.readouts[0].readout.name, "tilt_deg");
    assert_eq!(table.readouts[0].points.len(), 1);
}

#[test]
fn decimal_commas_of_spreadsheets_are_recognized() {
    let with_commas = series("\u{feff}t_s;tilt_deg;;\r\n0;1,5;;\r\n2,25;-3,5e1;;\r\n;;;\r\n");
    assert_eq!(with_commas.times_s, [0.0, 2.25]);
    assert_eq!(with_commas.curves[0].points[1].value, -35.0);
    let with_tabs = series("t_s\ttilt_deg\n0\t1.5\n");
    assert_eq!(with_tabs.curves[0].points[0].value, 1.5);
}

#[test]
fn exports_of_gyrolab_can_be_read_as_measured_data() {
    use gyrolab::engine::export::CsvWriter;
    use gyrolab::engine::export::layout::LayoutFile;
    let scenario = std::sync::Arc::new(crate::support::scenarios::preset("steady-slow", &[]));
    for excel in [false, true] {
        let layout = LayoutFile {
            excel,
            ..LayoutFile::default()
        };
        let layout = layout.check().unwrap();
        let mut csv = CsvWriter::with_layout(Vec::new(), &scenario, layout).unwrap();
        let simulation = gyrolab::engine::run::Simulation::new(std::sync::Arc::clone(&scenario));
        csv.write(&simulation.sample()).unwrap();
        let text = String::from_utf8(csv.finish().unwrap()).unwrap();
        let series = series(&text);
        assert_eq!(series.curves.len(), 12, "{text}");
        let tilt = series
            .curves
            .iter()
            .find(|curve| curve.quantity.name == "tilt_deg");
        assert_eq!(tilt.unwrap().points[0].value, simulation.sample().tilt_deg);
    }
}

#[test]
fn shipped_data_can_be_read() {
    for data in SHIPPED {
        let measured = open(data.name).unwrap_or_else(|problems| panic!("{problems}"));
        assert!(measured.about.contains("Heidelberg"), "{}", data.name);
        assert!(measured.clone().keep_rows(|_| true) > 6);
    }
}

/// The gyroscope file of phyphox in its five variants.
#[test]
fn a_recording_of_phyphox_is_read_unchanged() {
    let names = "\"Time (s)\",\"Gyroscope x (rad/s)\",\"Gyroscope y (rad/s)\",\"Gyroscope z (rad/s)\",\"Absolute (rad/s)\"";
    let rows =
        "0.000000000E0,1.234567890E0,-2.5E-1,NaN,3.0E0\n1.000000000E-2,1.3E0,-2.0E-1,5.0E0,3.1E0\n";
    for (separator, point) in [(",", "."), ("\t", "."), (";", "."), ("\t", ","), (";", ",")] {
        let rows = rows.replace(',', separator).replace('.', point);
        let measured = measured(&format!("{}\n{rows}", names.replace(',', separator)));
        assert_eq!(measured.left_out, ["Absolute (rad/s)"]);
        let series = measured.series().unwrap();
        assert_eq!(series.times_s, [0.0, 0.01]);
        let curves: Vec<_> = series
            .curves
            .iter()
            .map(|curve| {
                (
                    curve.quantity.name,
                    curve.points.iter().map(|it| it.value).collect::<Vec<_>>(),
                )
            })
            .collect();
        let expected = [
            ("w1_rad_per_s", vec![1.23456789, 1.3]),
            ("w2_rad_per_s", vec![-0.25, -0.2]),
            ("w3_rad_per_s", vec![5.0]),
        ];
        assert_eq!(curves, expected);
    }
}

#[test]
fn an_export_of_tracker_is_read_unchanged() {
    for begin in ["", "#multi:\n"] {
        let series = series(&format!(
            "{begin}\tmass A\t\t\nt\tx\ty\t\n0.0\t1.5E-1\t-2\n0.033\t0.16\t-2.1\n"
        ));
        let names: Vec<_> = series
            .curves
            .iter()
            .map(|curve| curve.quantity.name)
            .collect();
        assert_eq!(
            (names, &series.times_s[..]),
            (vec!["x_m", "y_m"], &[0.0, 0.033][..])
        );
    }
}

#[test]
fn a_zip_file_is_rejected_with_the_advice_to_unpack_it() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("phyphox.csv");
    std::fs::write(&path, b"PK\x03\x04\x14\x00\xff\xfe").unwrap();
    let refused = open(path.to_str().unwrap()).unwrap_err().to_string();
    assert!(refused.contains("unpack it"), "{refused}");
}
