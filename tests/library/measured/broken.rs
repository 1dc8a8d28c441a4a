//! Rejected files of measured data: messages name file, line, column, value, rule and remedy.

use crate::support::words::without_lists;
use gyrolab::engine::data::{open, read};
use gyrolab::engine::text::printable::is_steering;
use std::fs;

#[track_caller]
fn refusal(text: &str) -> String {
    match read("lab.csv", text) {
        Ok(_) => panic!("accepted: {text}"),
        Err(problems) => problems.to_string(),
    }
}

/// Files that are rejected.
const BROKEN: &[&str] = &[
    // names of columns
    "t_s,tild_deg\n0,1\n",
    "# a pendulum\n# of ours\nt_s,theta\n0,1\n",
    "Dauer,tilt_deg\n0,1\n1,2\n",
    "t,x,y,x,y\n0,1,2,3,4\n",
    "t_s,tilt_deg,tilt_deg\n0,1,2\n",
    "t_s,start.spin_rpm,tilt_deg\n0,1,2\n",
    "t_s,predicted_nutation_period_s\n0,1\n",
    "start.spin_rpn,tilt_deg\n0,1\n",
    "start.spin_rpm,health\n0,1\n",
    "start.spin_rpm,wall_s\n0,1\n",
    "t_s,t_uncertainty_s,tilt_deg\n0,1,2\n",
    // columns that have nothing in common with a run
    "t_s\n0\n1\n",
    "tilt_deg,x_m\n0,1\n",
    "start.spin_rpm,start.tilt_deg\n0,1\n",
    // rows
    "t_s,tilt_deg\n0,1\n1,2,3\n2\n",
    "t_s,tilt_deg\n",
    "# only a remark\n",
    "t_s,tilt_deg\n0,\n1,\n",
    // numbers
    "t_s,tilt_deg\n0,NaN\n1,-inf\n",
    "t_s,tilt_deg\n0,12 deg\n1,1e999\n",
    "t_s,tilt_deg\n0,\"1,5\"\n",
    "t_s;tilt_deg\n0,5;1.5\n",
    "t_s;tilt_deg\n0,5;1.234,5\n",
    "t_s,tilt_deg,tilt_uncertainty_deg\n0,1,0\n1,1,-0.5\n",
    "body.rim.radius_m,tilt_deg\n-1,2\n",
    "motion.scheme,tilt_deg\nrk5,2\n",
    // times
    "t_s,tilt_deg\n0,1\n3,1\n2,1\n",
    "t_s,tilt_deg\n-1,1\n",
    "t_s,tilt_deg\n,1\n",
];

#[test]
fn every_error_names_line_column_value_rule_and_remedy() {
    let told = BROKEN
        .iter()
        .map(|text| format!("{text}{}\n\n", without_lists(&refusal(text))));
    insta::assert_snapshot!("refusals", told.collect::<String>());
}

#[test]
fn shipped_data_are_opened_by_name() {
    assert_eq!(
        open("heidelberg-nutation").unwrap().origin,
        "heidelberg-nutation"
    );
}

#[test]
fn files_that_are_not_text_are_rejected() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("lab.csv");
    let name = path.to_str().unwrap();
    fs::write(&path, b"t_s,tilt_deg\n0,1\n# Pr\xe4zession\x00\n").unwrap();
    assert_eq!(
        open(name).unwrap_err().to_string(),
        format!("{name}:3: is not text in UTF-8: save the file in that encoding (\"CSV UTF-8\")")
    );
    let of = |file: &str| open(file).unwrap_err().to_string();
    let folder = folder.path().to_str().unwrap();
    assert_eq!(
        of(folder),
        format!("{folder}: is a folder: name a CSV file in it")
    );
    assert_eq!(
        of("./nothing.csv"),
        "./nothing.csv: there is no such file: check the name and the current folder"
    );
    assert_eq!(
        of("heidelberg-nutatoin"),
        "heidelberg-nutatoin: no measured data of that name: did you mean heidelberg-nutation? (a file's name contains a / or ends in .csv)"
    );
    let file = fs::File::create(&path).unwrap();
    file.set_len(100 << 20).unwrap();
    assert!(of(name).contains("is larger than 32 MiB"), "{}", of(name));
    fs::write(
        &path,
        "t_s,tilt_deg\n".to_owned() + &"0,1\n".repeat(500_001),
    )
    .unwrap();
    let told = "has more than 1000000 values (rows times columns): remove rows or columns";
    assert!(of(name).ends_with(told), "{}", of(name));
}

#[test]
fn errors_of_hostile_files_are_short_and_escaped() {
    let cell = format!("\u{1b}[2J{}", "9".repeat(100_000));
    let text = format!("t_s,tilt_deg\n{}", format!("0,{cell}\n").repeat(400));
    let told = refusal(&text);
    assert_eq!(told.lines().count(), 13, "{told}");
    assert!(told.len() < 4000 && !told.replace('\n', "").chars().any(is_steering));
    assert!(told.ends_with("lab.csv: and 388 more"), "{told}");
    // Here, each line violates a different rule.
    let rows: String = (0..401).rev().map(|time| format!("{time},1\n")).collect();
    let of_times = refusal(&format!("t_s,tilt_deg\n{rows}"));
    assert_eq!(of_times.lines().count(), 13, "{of_times}");
    assert!(of_times.ends_with("lab.csv: and 388 more"), "{of_times}");
    let names = format!("t_s,{}\n0\n", "\u{202e}x".repeat(50_000));
    assert!(refusal(&names).len() < 400);
}
