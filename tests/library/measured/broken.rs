//! Files of measured data that are refused, and in which words: file, line, column, value, rule and remedy.

use gyrolab::measured::{open, read};
use gyrolab::text::printable::is_steering;
use std::fs;

#[track_caller]
fn refusal(text: &str) -> String {
    match read("lab.csv", text) {
        Ok(_) => panic!("not refused: {text}"),
        Err(problems) => problems.to_string(),
    }
}

#[track_caller]
fn is_refused(text: &str, words: &str) {
    assert_eq!(refusal(text), words);
}

#[test]
fn names_of_columns() {
    is_refused(
        "t_s,tild_deg\n0,1\n",
        "lab.csv:1: tild_deg: is no column that gyrolab knows: did you mean tilt_deg?",
    );
    is_refused(
        "# a pendulum\n# of ours\nt_s,tilt_rad\n0,1\n",
        "lab.csv:3: tilt_rad: is in rad, and is wanted in deg: name the column tilt_deg, its values multiplied by 57.29578",
    );
    is_refused(
        "t_min,spin_rpm\n0,1\n",
        "lab.csv:1: t_min: is in min, and is wanted in s: name the column t_s, its values multiplied by 60",
    );
    is_refused(
        "start.spin_Hz,predicted_body_cone_period_ms\n1,2\n",
        "lab.csv:1: start.spin_Hz: is in Hz, and is wanted in rpm: name the column start.spin_rpm, its values multiplied by 60\n\
         lab.csv:1: predicted_body_cone_period_ms: is in ms, and is wanted in s: name the column predicted_body_cone_period_s, its values multiplied by 0.001",
    );
    is_refused(
        "Zeit,tilt_deg\n0,1\n",
        "lab.csv:1: Zeit: is no column that gyrolab knows: did you mean t_s?",
    );
    is_refused(
        "t_s,tilt_deg,tilt_deg\n0,1,2\n",
        "lab.csv:1: tilt_deg: names two columns: leave one of them out",
    );
    is_refused(
        "t_s,,tilt_deg\n0,1,2\n",
        "lab.csv:1: column 2: has no name: name it, or leave the column out",
    );
    is_refused(
        "t_s,start.spin_rpm,tilt_deg\n0,1,2\n",
        "lab.csv:1: start.spin_rpm: is a key of the scenario: beside t_s stands what was measured on one run; set the key in the scenario, or by --set",
    );
    is_refused(
        "t_s,predicted_nutation_period_s\n0,1\n",
        "lab.csv:1: predicted_nutation_period_s: is a number of a whole run, not of one time: a table of such has no column t_s, and a run in every row",
    );
    is_refused(
        "start.spin_rpn,tilt_deg\n0,1\n",
        "lab.csv:1: start.spin_rpn: unknown key: did you mean start.spin_rpm?",
    );
    is_refused(
        "start.spin_rpm,health\n0,1\n",
        "lab.csv:1: health: is a text of the run, and cannot be measured",
    );
    is_refused(
        "start.spin_rpm,wall_s\n0,1\n",
        "lab.csv:1: wall_s: is told by the clock, and says nothing of the motion",
    );
}

#[test]
fn data_that_come_with_the_program_go_by_their_name() {
    assert_eq!(
        open("heidelberg-nutation").unwrap().origin,
        "heidelberg-nutation"
    );
}

#[test]
fn uncertainties_without_values() {
    is_refused(
        "t_s,tilt_deg,azimuth_uncertainty_deg\n0,1,2\n",
        "lab.csv:1: azimuth_uncertainty_deg: is the uncertainty of no measured column: there is tilt_uncertainty_deg",
    );
    is_refused(
        "t_s,tilt_deg,tilt_deg_uncertainty\n0,1,2\n",
        "lab.csv:1: tilt_deg_uncertainty: is the uncertainty of no measured column: there is tilt_uncertainty_deg",
    );
    is_refused(
        "t_s,t_uncertainty_s,tilt_deg\n0,1,2\n",
        "lab.csv:1: t_uncertainty_s: is not taken: make what was measured the more uncertain, by its change in that time (t_s is without error)",
    );
    is_refused(
        "motion.scheme,motion.scheme_uncertainty,tilt_deg\nrk4,1,2\n",
        "lab.csv:1: motion.scheme_uncertainty: is the uncertainty of no measured column: there is tilt_uncertainty_deg",
    );
    is_refused(
        "t_s,tilt_deg,tilt_uncertainty_rad\n0,1,2\n",
        "lab.csv:1: tilt_uncertainty_rad: is in rad, and is wanted in deg: name the column tilt_uncertainty_deg, its values multiplied by 57.29578",
    );
}

#[test]
fn columns_that_have_nothing_in_common_with_a_run() {
    is_refused(
        "t_s\n0\n1\n",
        "lab.csv:1: has no column that a run has too: beside t_s one is needed, such as tilt_deg, azimuth_deg, x_m or spin_rpm",
    );
    is_refused(
        "tilt_deg,x_m\n0,1\n",
        "lab.csv:1: is neither a time series, which has a column t_s, nor a table of runs, which has a column named by a key of the scenario, such as start.spin_rpm",
    );
    is_refused(
        "start.spin_rpm,start.tilt_deg\n0,1\n",
        "lab.csv:1: has no column that was measured: beside the keys of the scenario a table of runs needs a readout (gyrolab readouts lists them)",
    );
}

#[test]
fn rows() {
    is_refused(
        "t_s,tilt_deg\n0,1\n1,2,3\n2\n",
        "lab.csv:3: this row: number of cells: 3, of columns: 2; numbers have a decimal point (1.5, not 1,5); a file with decimal commas parts its columns by ;\n\
         lab.csv:4: this row: number of cells: 1, of columns: 2; leave no column out; a value that is missing is an empty place between two separators",
    );
    is_refused(
        "t_s,tilt_deg\n",
        "lab.csv: has no rows below the names of its columns",
    );
    is_refused(
        "# only a remark\n",
        "lab.csv: has no columns: the first line after its comments must name them, such as t_s,tilt_deg",
    );
    is_refused(
        "t_s,tilt_deg\n0,\n1,\n",
        "lab.csv: holds no measured value: every place of its measured columns is empty",
    );
}

#[test]
fn numbers() {
    let missing = "must be a finite number: a value that is missing is an empty place";
    is_refused(
        "t_s,tilt_deg\n0,NaN\n1,-inf\n",
        &format!("lab.csv:2: tilt_deg (NaN) {missing}\nlab.csv:3: tilt_deg (-inf) {missing}"),
    );
    is_refused(
        "t_s,tilt_deg\n0,12 deg\n1,1e999\n",
        &format!(
            "lab.csv:2: tilt_deg (12 deg) must be a number, without its unit; a value that is missing is an empty place\n\
             lab.csv:3: tilt_deg (1e999) {missing}"
        ),
    );
    is_refused(
        "t_s,tilt_deg\n0,\"1,5\"\n",
        "lab.csv:2: tilt_deg (1,5) must be a number with one decimal sign, a point (1.5), and nothing between its thousands",
    );
    is_refused(
        "t_s;tilt_deg\n0,5;1.5\n",
        "lab.csv:2: tilt_deg (1.5) has another decimal sign than the numbers before it: write all of them with a point, or all with a comma",
    );
    is_refused(
        "t_s;tilt_deg\n0,5;1.234,5\n",
        "lab.csv:2: tilt_deg (1.234,5) must be a number with one decimal sign, a point (1.5), and nothing between its thousands",
    );
    let above = "must be greater than zero: where there is no uncertainty the place is empty";
    is_refused(
        "t_s,tilt_deg,tilt_uncertainty_deg\n0,1,0\n1,1,-0.5\n",
        &format!(
            "lab.csv:2: tilt_uncertainty_deg (0) {above}\nlab.csv:3: tilt_uncertainty_deg (-0.5) {above}"
        ),
    );
    is_refused(
        "body.rim.radius_m,tilt_deg\n-1,2\n",
        "lab.csv:2: body.rim.radius_m (-1) must be greater than zero",
    );
    is_refused(
        "motion.scheme,tilt_deg\nrk5,2\n",
        "lab.csv:2: motion.scheme (rk5) must be one of report, rk4, strang, srkn11b, exact; did you mean rk4?",
    );
}

#[test]
fn times() {
    is_refused(
        "t_s,tilt_deg\n0,1\n3,1\n2,1\n",
        "lab.csv:4: t_s (2) is before the time 3 in line 3: sort the rows by time, and put another run's into a file of their own",
    );
    is_refused(
        "t_s,tilt_deg\n-1,1\n",
        "lab.csv:2: t_s (-1) must not be negative: a run begins at t = 0; count the time from there",
    );
    is_refused(
        "t_s,tilt_deg\n,1\n",
        "lab.csv:2: t_s: is missing: every row needs its time",
    );
}

#[test]
fn files_that_are_no_text_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("lab.csv");
    let name = path.to_str().unwrap();
    fs::write(&path, b"t_s,tilt_deg\n0,1\n# Pr\xe4zession\n").unwrap();
    assert_eq!(
        open(name).unwrap_err().to_string(),
        format!("{name}:3: is not text in UTF-8: save the file in that encoding (\"CSV UTF-8\")")
    );
    let of = |name: &str| open(name).unwrap_err().to_string();
    let folder = folder.path().to_str().unwrap();
    assert_eq!(
        of(folder),
        format!("{folder}: is a folder: name a CSV file in it")
    );
    assert_eq!(
        of("./nothing.csv"),
        "./nothing.csv: there is no such file: check the name, and the folder you are in"
    );
    assert_eq!(
        of("heidelberg-nutatoin"),
        "heidelberg-nutatoin: no measured data of that name: did you mean heidelberg-nutation? (a file's name holds a / or ends in .csv)"
    );
    let file = fs::File::create(&path).unwrap();
    file.set_len(100 << 20).unwrap();
    assert!(of(name).contains("is longer than 32 MiB"), "{}", of(name));
    fs::write(
        &path,
        "t_s,tilt_deg\n".to_owned() + &"0,1\n".repeat(500_001),
    )
    .unwrap();
    let told = "has more than 1000000 values (rows times columns): leave rows or columns out";
    assert!(of(name).ends_with(told), "{}", of(name));
}

#[test]
fn a_hostile_file_is_told_in_few_lines_that_steer_no_terminal() {
    let cell = format!("\u{1b}[2J{}", "9".repeat(100_000));
    let text = format!("t_s,tilt_deg\n{}", format!("0,{cell}\n").repeat(400));
    let told = refusal(&text);
    assert_eq!(told.lines().count(), 13, "{told}");
    assert!(told.len() < 4000 && !told.replace('\n', "").chars().any(is_steering));
    assert!(told.ends_with("lab.csv: and 388 more"), "{told}");
    // Here each line breaks a rule of its own.
    let rows: String = (0..401).rev().map(|time| format!("{time},1\n")).collect();
    let told = refusal(&format!("t_s,tilt_deg\n{rows}"));
    assert_eq!(told.lines().count(), 13, "{told}");
    assert!(told.ends_with("lab.csv: and 388 more"), "{told}");
    let names = format!("t_s,{}\n0\n", "\u{202e}x".repeat(50_000));
    assert!(refusal(&names).len() < 400);
}
