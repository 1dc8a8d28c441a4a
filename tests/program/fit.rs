//! `gyrolab fit`: its output, CSV, figure, exit codes and error messages.

use crate::support::ground::{Ground, code, done, stdout};
use crate::support::words::{has, has_no};

const NUTATION: &str = "fit heidelberg-nutation --in heidelberg --set body.point.0.at_m.2=0 \
    --free=body.part.0.moments_kg_m2.2";

#[test]
fn a_fit_prints_values_uncertainties_and_goodness_of_fit() {
    let output = done(Ground::new().run(NUTATION));
    assert!(output.stderr.is_empty());
    let told = stdout(&output);
    has(told, "body.part.0.moments_kg_m2.2  0.003751(27)  0.00375");
    has(
        told,
        "\nThe model fits, but the uncertainties given look too large: by their scatter the data are about 3.5 times as good as stated (chi^2 0.718 at 9 degrees of freedom).",
    );
}

#[test]
fn the_json_of_a_fit_has_the_numbers_of_the_text() {
    let json = Ground::new().json(&format!("{NUTATION} --json"));
    let near = |value: &serde_json::Value, wanted: f64| {
        let value = value.as_f64().unwrap();
        assert!((value / wanted - 1.0).abs() < 1e-3, "{value} {wanted}");
    };
    near(&json["keys"][0]["value"], 3.7515e-3);
    near(&json["chi_squared"], 0.7183);
    assert_eq!(json["degrees_of_freedom"], 9);
    assert_eq!(json["fits"], true);
    assert_eq!(json["correlation"][0][0], 1.0);
    assert_eq!(json["residuals"].as_array().unwrap().len(), 10);
}

#[test]
fn a_fit_with_another_scheme_than_the_scenarios_remarks_on_it() {
    let ground = Ground::new();
    let data = "t_s,tilt_deg\n0,45.1\n0.5,45\n1,44.9\n1.5,45.1\n";
    ground.write("tilt.csv", data);
    let fit = "fit tilt.csv --in method-2 --free=start.tilt_deg";
    let remark = "The fitted runs use the scheme exact; the scenario's scheme is report (use --scheme report to fit with it).";
    has(ground.stdout(fit), remark);
    let json = ground.json(&format!("{fit} --json"));
    assert_eq!(json["scheme"], "exact");
    assert_eq!(json["remarks"][0], remark);
    let csv = ground.stdout(&format!("{fit} -o -"));
    has(csv, "\n# # scheme = \"exact\"\n");
    // There is no remark if the scheme was requested.
    for asked in ["--scheme report", "--set motion.scheme=exact"] {
        let told = ground.stdout(&format!("{fit} {asked}"));
        has(&told, "scheme ");
        has_no(&told, "scenario's own");
    }
}

#[test]
fn the_csv_of_a_fit_can_be_drawn_run_and_verified() {
    let ground = Ground::new();
    let into_file = format!("{NUTATION} -o fit.csv");
    let output = done(ground.run(&into_file));
    assert!(output.stdout.is_empty());
    assert!(output.stderr.ends_with(b"gyrolab: 10 rows in fit.csv\n"));
    let words = "fit.csv exists; --force replaces it";
    ground.refused(&into_file, 1, &[words]);
    ground.stderr("figure fit.csv -o fit.svg");
    ground.stdout("run fit.csv --steps 1");
    let csv = ground.read("fit.csv");
    let same = "fit.csv: the same: all 10 rows, recomputed\n";
    assert_eq!(ground.stdout("verify fit.csv"), same);
    for (old, new, reason) in [
        (
            "residual_sigmas\n1,",
            "residual_sigmas\n2,",
            "row is 2, computed 1",
        ),
        ("# # verdict = \"", "# # verdict = \"No: ", "# # verdict = "),
    ] {
        ground.write("other.csv", &csv.replacen(old, new, 1));
        let verified = ground.run("verify other.csv");
        assert_eq!(code(&verified), 1);
        has(stdout(&verified), reason);
    }
    // If the data file has moved, the message says so.
    for (old, new, reason) in [
        (
            "fit heidelberg-nutation ",
            "fit lost.csv ",
            "cannot be recomputed: lost.csv: ",
        ),
        (
            "gyrolab fit ",
            "gyrolab run ",
            "not the command line of a fit",
        ),
    ] {
        ground.write("other.csv", &csv.replacen(old, new, 1));
        ground.refused("verify other.csv", 1, &[reason]);
    }
    let mut lines = csv.lines();
    let command: toml::Value = lines
        .find_map(|line| line.strip_prefix("# # command = "))
        .unwrap()
        .parse()
        .unwrap();
    let again = command.as_str().unwrap().replacen("gyrolab", "$G", 1);
    done(ground.shell(&format!("{again} -o again.csv")));
    assert_eq!(ground.read("again.csv"), csv);
    assert_eq!(ground.stdout(&format!("{NUTATION} -o -")), csv);
}

#[test]
fn fit_errors_name_the_remedy() {
    let ground = Ground::new();
    ground.write("lab.csv", "t_s,tilt_deg\n0,20\n");
    for (args, code, words) in [
        (
            "fit lab.csv --in cusps --free start.tilt_deg,start.momentum_Js.2",
            1,
            "gyrolab: lab.csv in cusps: 1 measured value cannot determine 2 keys: free fewer keys, or measure more",
        ),
        ("fit lab.csv --in cusps", 2, "--free"),
        (
            "fit lab.csv --in cusps --free start.tilt_deg --rows 2",
            1,
            "--rows 2: there is no row 2: the data have only 1",
        ),
        (
            &format!("{NUTATION} -o /dev/full"),
            1,
            "cannot write /dev/full",
        ),
    ] {
        ground.refused(args, code, &[words]);
    }
}

/// Each of two throws in one recording is fitted separately, and its CSV is verified.
#[test]
fn a_part_of_a_recording_is_fitted_from_its_own_start() {
    let ground = Ground::new();
    let columns = "--columns t_s,w1_rad_per_s,w2_rad_per_s,w3_rad_per_s";
    let mut recording = String::new();
    for (begin_s, rate) in [(1.0, 8.0), (6.0, -9.0)] {
        let thrown =
            format!("run thrown-phone --set start.omega_rad_per_s.0={rate} {columns} -o -");
        for row in ground
            .stdout(&thrown)
            .lines()
            .filter(|line| !line.starts_with('#'))
        {
            match row.split_once(',') {
                Some(("t_s", _)) if recording.is_empty() => recording += &format!("{row}\n"),
                Some(("t_s", _)) | None => {}
                Some((time, rates)) => {
                    let time_s = begin_s + time.parse::<f64>().unwrap();
                    recording += &format!("{time_s},{rates}\n");
                }
            }
        }
    }
    ground.write("throws.csv", &recording);
    let fit = "fit throws.csv --in thrown-phone --set start.omega_rad_per_s.1=1 \
        --free start.omega_rad_per_s.0,start.omega_rad_per_s.1";
    for (part, rate) in [("--from 1 --to 5", 8.0), ("--from 6", -9.0)] {
        let json = ground.json(&format!("{fit} {part} --json"));
        let found = json["keys"][0]["value"].as_f64().unwrap();
        assert!((found - rate).abs() < 1e-6, "{part}: {found}");
    }
    done(ground.run(&format!("{fit} --from 6 -o found.csv")));
    done(ground.run("verify found.csv"));
    let none = format!("{fit} --from 11");
    ground.refused(&none, 1, &["throws.csv: has no measured value"]);
}

/// Writes a recording of two throws. The phone rests between them, with a jolt at each catch.
fn write_two_throws(ground: &Ground) {
    let columns = "--columns t_s,w1_rad_per_s,w2_rad_per_s,w3_rad_per_s";
    let mut recording = String::new();
    let mut time_s = 0.0;
    let mut add = |rates: &str| {
        recording += &format!("{time_s},{rates}\n");
        time_s += 0.01;
    };
    for rate in [8.0, -9.0] {
        (0..40).for_each(|_| add("0,0,0"));
        let thrown = format!(
            "run thrown-phone --set start.omega_rad_per_s.0={rate} --set motion.steps=60 {columns} -o -"
        );
        let told = ground.stdout(&thrown);
        let rows = told.lines().filter(|line| !line.starts_with('#')).skip(1);
        rows.for_each(|row| add(row.split_once(',').unwrap().1));
        (0..20).for_each(|row| add(if row % 2 == 0 { "3,-2,1" } else { "-1,0,2" }));
    }
    let head = "t_s,w1_rad_per_s,w2_rad_per_s,w3_rad_per_s\n";
    ground.write("throws.csv", &format!("{head}{recording}"));
}

#[test]
fn throws_are_found_listed_and_fitted_separately() {
    let ground = Ground::new();
    write_two_throws(&ground);
    let fit =
        "fit throws.csv --in thrown-phone --free start.omega_rad_per_s.0,start.omega_rad_per_s.1";
    let told = ground.stdout(fit);
    has(&told, "2 free flights in throws.csv:\n  flight 1 of 2: ");
    let all = ground.json(&format!("{fit} --json"));
    assert_eq!(all["flights"].as_array().unwrap().len(), 2);
    for (number, rate) in [(1, 8.0), (2, -9.0)] {
        let one = ground.json(&format!("{fit} --flight {number} --json"));
        assert_eq!(one, all["flights"][number - 1]);
        assert_eq!(one["flight"]["number"], number);
        let found = one["keys"][0]["value"].as_f64().unwrap();
        assert!((found / rate - 1.0).abs() < 0.1, "{number}: {found}");
    }
    ground.refused(
        &format!("{fit} --flight 3"),
        1,
        &["no free flight 3", "flight 2 of 2"],
    );
    ground.refused(&format!("{fit} --flight 0"), 2, &["--flight"]);
    ground.refused(&format!("{fit} --flight 1 --from 0"), 2, &["--from"]);
    ground.refused(&format!("{fit} -o out.csv"), 1, &["--flight N"]);
    done(ground.run(&format!("{fit} --flight 2 -o out.csv")));
    done(ground.run("verify out.csv"));
}

#[test]
fn a_recording_without_a_flight_is_rejected_with_a_remedy() {
    let ground = Ground::new();
    let rows = (0..100).map(|row| format!("{},{},0.1,0\n", f64::from(row) / 100.0, row % 5));
    let head = "t_s,w1_rad_per_s,w2_rad_per_s,w3_rad_per_s\n".to_owned();
    ground.write("still.csv", &(head + &rows.collect::<String>()));
    let fit = "fit still.csv --in thrown-phone --free start.omega_rad_per_s.0";
    ground.refused(fit, 1, &["has no free flight", "--from and --to"]);
    done(ground.run(&format!("{fit} --from 0")));
    let other = "fit heidelberg-nutation --in heidelberg --free start.spin_rpm --flight 1";
    ground.refused(other, 1, &["--flight needs a recording"]);
}
