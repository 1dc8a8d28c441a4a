//! `gyrolab fit`: what it prints, its CSV, its figure, its exit codes, and what it refuses.

use crate::support::ground::{GYROLAB, Ground, code};
use std::fs;
use std::process::{Command, Output, Stdio};
use std::thread::sleep;
use std::time::Duration;

const NUTATION: [&str; 7] = [
    "fit",
    "heidelberg-nutation",
    "--in",
    "heidelberg",
    "--set",
    "body.point.0.at_m.2=0",
    "--free=body.part.0.moments_kg_m2.2",
];

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

#[track_caller]
fn refused(output: &Output, with: i32, words: &str) {
    let told = text(&output.stderr);
    assert_eq!(code(output), with, "{told}");
    assert!(told.contains(words), "{words}: {told}");
}

#[test]
fn it_says_the_value_with_its_uncertainty_and_whether_the_model_fits() {
    let ground = Ground::new();
    let output = ground.run(&NUTATION);
    assert_eq!((code(&output), text(&output.stderr)), (0, String::new()));
    let told = text(&output.stdout);
    assert!(
        told.contains("body.part.0.moments_kg_m2.2  0.003751(27)  0.00375"),
        "{told}"
    );
    assert!(told.contains("\nThe model fits, but the uncertainties are too large: chi^2 0.718 at 9 degrees of freedom"), "{told}");
}

#[test]
fn json_has_what_the_text_has() {
    let ground = Ground::new();
    let output = ground.run(&[&NUTATION[..], &["--json"]].concat());
    let json: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
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
fn a_fit_by_another_scheme_than_the_scenario_has_says_so_wherever_it_is_quoted() {
    let ground = Ground::new();
    ground.write(
        "tilt.csv",
        "t_s,tilt_deg\n0,45.1\n0.5,45\n1,44.9\n1.5,45.1\n",
    );
    let fit = [
        "fit",
        "tilt.csv",
        "--in",
        "method-2",
        "--free=start.tilt_deg",
    ];
    let with = |more: &[&str]| ground.run(&[&fit[..], more].concat());
    let remark = "The fitted runs have the scheme exact; the scenario's own is report (--scheme report fits the runs of that).";
    assert!(text(&with(&[]).stdout).contains(remark));
    let json: serde_json::Value = serde_json::from_slice(&with(&["--json"]).stdout).unwrap();
    assert_eq!(
        (&json["scheme"], &json["remarks"][0]),
        (&"exact".into(), &remark.into())
    );
    let csv = text(&with(&["-o", "-"]).stdout);
    assert!(csv.contains("\n# # scheme = \"exact\"\n"), "{csv}");
    // Where the scheme was asked for, it is no surprise.
    for asked in [["--scheme", "report"], ["--set", "motion.scheme=exact"]] {
        let told = text(&with(&asked).stdout);
        assert!(
            told.contains("scheme ") && !told.contains("scenario's own"),
            "{told}"
        );
    }
}

#[test]
fn the_csv_is_drawn_and_runs_again() {
    let ground = Ground::new();
    let with = |more: &[&str]| ground.run(&[&NUTATION[..], more].concat());
    let output = with(&["-o", "fit.csv"]);
    assert_eq!((code(&output), text(&output.stdout)), (0, String::new()));
    assert!(text(&output.stderr).ends_with("gyrolab: 10 rows in fit.csv\n"));
    refused(
        &with(&["-o", "fit.csv"]),
        1,
        "fit.csv exists; --force replaces it",
    );
    let drawn = ground.run(&["figure", "fit.csv", "-o", "fit.svg"]);
    assert_eq!(code(&drawn), 0, "{}", text(&drawn.stderr));
    let run = ground.run(&["run", "fit.csv", "--steps", "1"]);
    assert_eq!(code(&run), 0, "{}", text(&run.stderr));
    let csv = fs::read_to_string(ground.file("fit.csv")).unwrap();
    let verified = ground.run(&["verify", "fit.csv"]);
    let same = "fit.csv: the same: all 10 rows, computed again\n";
    assert_eq!(
        (code(&verified), text(&verified.stdout)),
        (0, same.to_owned())
    );
    for (old, new, words) in [
        (
            "residual_sigmas\n1,",
            "residual_sigmas\n2,",
            "row is 2, computed 1",
        ),
        ("# # verdict = \"", "# # verdict = \"No: ", "# # verdict = "),
    ] {
        fs::write(ground.file("other.csv"), csv.replacen(old, new, 1)).unwrap();
        let verified = ground.run(&["verify", "other.csv"]);
        assert_eq!(code(&verified), 1);
        let told = text(&verified.stdout);
        assert!(told.contains(words), "{told}");
    }
    // Where its data stand in another place, that is said.
    let lost = csv.replacen("fit heidelberg-nutation ", "fit lost.csv ", 1);
    let wrong = csv.replacen("gyrolab fit ", "gyrolab run ", 1);
    for (text, words) in [
        (lost, "cannot be recomputed: lost.csv: "),
        (wrong, "no command line of a fit"),
    ] {
        fs::write(ground.file("other.csv"), text).unwrap();
        let verified = ground.run(&["verify", "other.csv"]);
        refused(&verified, 1, words);
    }
    let command = csv
        .lines()
        .find_map(|line| line.strip_prefix("# # command = "));
    let command: toml::Value = command.unwrap().parse().unwrap();
    let again = command.as_str().unwrap().replacen("gyrolab", "$G", 1);
    let again = ground.shell(&format!("{again} -o again.csv"));
    assert_eq!(code(&again), 0, "{}", text(&again.stderr));
    assert_eq!(fs::read_to_string(ground.file("again.csv")).unwrap(), csv);
    let on_stdout = with(&["-o", "-"]);
    let csv = fs::read(ground.file("fit.csv")).unwrap();
    assert_eq!(text(&on_stdout.stdout), text(&csv));
}

#[test]
fn what_is_wrong_is_told_with_the_remedy() {
    let ground = Ground::new();
    let fit = |args: &[&str]| ground.run(&[&["fit"], args].concat());
    fs::write(ground.file("lab.csv"), "t_min,tilt_deg\n0,1\n").unwrap();
    refused(
        &fit(&["lab.csv", "--in", "cusps", "--free", "start.tilt_deg"]),
        1,
        "lab.csv:1: t_min: is in min, and is wanted in s: name the column t_s, its values multiplied by 60",
    );
    fs::write(ground.file("lab.csv"), "t_s,tilt_deg\n0,20\n").unwrap();
    refused(
        &fit(&[
            "lab.csv",
            "--in",
            "cusps",
            "--free",
            "start.tilt_deg,start.momentum_Js.2",
        ]),
        1,
        "gyrolab: lab.csv in cusps: 1 measured value cannot say 2 values: free fewer keys, or measure more",
    );
    refused(&fit(&["lab.csv", "--in", "cusps"]), 2, "--free");
    refused(
        &fit(&[
            "lab.csv",
            "--in",
            "cusps",
            "--free",
            "start.tilt_deg",
            "--rows",
            "2",
        ]),
        1,
        "--rows 2: there is no row 2: the data have 1",
    );
    let full = ["-o", "/dev/full"];
    refused(
        &ground.run(&[&NUTATION[..], &full].concat()),
        1,
        "cannot write /dev/full",
    );
}

#[test]
fn ctrl_c_ends_it_with_130_and_leaves_no_file() {
    let ground = Ground::new();
    // Nine million steps of a scheme that steps by milliseconds, in every run.
    fs::write(ground.file("long.csv"), "t_s,tilt_deg\n0,20\n9000,20\n").unwrap();
    let mut fit = Command::new(GYROLAB)
        .args([
            "fit",
            "long.csv",
            "--in",
            "cusps",
            "--scheme",
            "rk4",
            "--free",
            "start.tilt_deg",
            "-o",
            "fit.csv",
        ])
        .current_dir(ground.path())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    sleep(Duration::from_millis(500));
    let ended = Command::new("kill")
        .args(["-INT", &fit.id().to_string()])
        .status();
    assert!(ended.unwrap().success());
    assert_eq!(fit.wait().unwrap().code(), Some(130));
    assert_eq!(ground.files(), ["long.csv"]);
}

/// A stack larger than any memory: no thread can be had.
#[test]
fn without_threads_it_finds_the_same() {
    let ground = Ground::new();
    let fit = |least_stack: &str| {
        let mut command = ground.command(&NUTATION);
        let output = command.env("RUST_MIN_STACK", least_stack).output().unwrap();
        assert_eq!((code(&output), text(&output.stderr)), (0, String::new()));
        text(&output.stdout)
    };
    assert_eq!(fit("4611686018427387904"), fit("2097152"));
}
