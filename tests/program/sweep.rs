//! `gyrolab sweep`: its CSV, how it goes on, what it refuses, and how shards become one file.

use crate::support::dice::Dice;
use crate::support::ground::{Ground, code, names};
use std::fs;
use std::os::unix::fs::symlink;
use std::process::{Command, Output, Stdio};
use std::thread::sleep;
use std::time::Duration;

/// A sweep of 60 short runs over a number and a text, some of which fail.
const GRID: [&str; 9] = [
    "sweep",
    "cusps",
    "--set",
    "motion.steps=400",
    "--vary",
    "start.momentum_Js.2=10..400:20",
    "--vary",
    "motion.scheme=report,rk4,exact",
    "--measure=z_m,tilt_deg,path,measured_tilt_swing_deg,most_distance_m",
];

fn sweep(ground: &Ground, args: &[&str], output: &str) -> Output {
    ground.run(&[args, &["-o", output]].concat())
}

#[track_caller]
fn made(output: &Output) -> String {
    assert_eq!(code(output), 0, "{output:?}");
    assert!(output.stdout.is_empty(), "{output:?}");
    String::from_utf8(output.stderr.clone()).unwrap()
}

#[track_caller]
fn refused(output: &Output, with: i32, words: &[&str]) {
    let told = String::from_utf8_lossy(&output.stderr);
    assert_eq!(code(output), with, "{told}");
    for word in words {
        assert!(told.contains(word), "{word}: {told}");
    }
}

/// The lines of a CSV below its sweep file.
fn rows(csv: &str) -> Vec<&str> {
    csv.lines().filter(|line| !line.starts_with('#')).collect()
}

#[test]
fn rows_are_those_of_single_runs_in_the_order_of_the_grid() {
    let ground = Ground::new();
    made(&sweep(&ground, &GRID, "grid.csv"));
    let csv = ground.read("grid.csv");
    let rows = rows(&csv);
    assert_eq!(
        rows[0],
        "start.momentum_Js.2,motion.scheme,z_m,tilt_deg,path,measured_tilt_swing_deg,most_distance_m"
    );
    assert_eq!(rows.len(), 61);
    assert!(rows[1].starts_with("10.0,report,") && rows[2].starts_with("10.0,rk4,"));
    assert!(rows[60].starts_with("400.0,exact,"));
    // The row of a point is what run says of the same scenario, to the last digit.
    let set = "start.momentum_Js.2=400";
    let args = [
        "run", "cusps", "--steps", "400", "--set", set, "--scheme", "rk4", "--json",
    ];
    let run = ground.run(&args);
    let json = String::from_utf8(run.stdout).unwrap();
    let cells: Vec<_> = rows[59].split(',').collect();
    assert_eq!(cells[..2], ["400.0", "rk4"]);
    for (name, cell) in rows[0].split(',').zip(&cells).skip(2) {
        let is_there = [cell.to_string(), format!("\"{cell}\"")]
            .iter()
            .any(|cell| json.contains(&format!("\"{name}\":{cell},")));
        assert!(is_there, "{name} is {cell}: {json}");
    }
    assert_eq!(ground.files(), ["grid.csv"]);
}

#[test]
fn its_csv_is_its_sweep_file() {
    let ground = Ground::new();
    made(&sweep(&ground, &GRID, "grid.csv"));
    made(&sweep(&ground, &["sweep", "grid.csv"], "again.csv"));
    let csv = ground.read("grid.csv");
    assert_eq!(csv, ground.read("again.csv"));
    let file: String = csv
        .lines()
        .filter_map(|line| line.strip_prefix("# "))
        .flat_map(|line| [line, "\n"])
        .collect();
    ground.write("grid.toml", &file);
    made(&sweep(&ground, &["sweep", "grid.toml"], "file.csv"));
    assert_eq!(csv, ground.read("file.csv"));
    for name in ["grid.csv", "grid.toml"] {
        let checked = ground.run(&["check", name]);
        let told = String::from_utf8_lossy(&checked.stdout);
        assert!(told.contains("rows: 60") && code(&checked) == 0, "{told}");
    }
    // A scenario it is not.
    let run = ground.run(&["run", "grid.csv"]);
    refused(&run, 1, &["grid.csv", "gyrolab sweep"]);
}

#[test]
fn a_scenario_is_found_from_the_sweep_file_on() {
    let ground = Ground::new();
    fs::create_dir(ground.file("deep")).unwrap();
    let preset = ground.run(&["presets", "cusps"]);
    fs::write(ground.file("deep/mine.toml"), preset.stdout).unwrap();
    let file = "scenario = \"mine.toml\"\nmeasure = [\"z_m\"]\n\
        [[vary]]\nkey = \"motion.steps\"\nvalues = [1, 2]\n";
    ground.write("deep/sweep.toml", file);
    made(&sweep(&ground, &["sweep", "deep/sweep.toml"], "out.csv"));
    assert_eq!(rows(&ground.read("out.csv")).len(), 3);
    // --vary takes the place of the file's values, and --measure of its readouts.
    let args = [
        "sweep",
        "deep/sweep.toml",
        "--vary",
        "motion.steps=1..5:5",
        "--measure",
        "t_s",
    ];
    made(&sweep(&ground, &args, "other.csv"));
    let other = ground.read("other.csv");
    assert_eq!(rows(&other)[0], "motion.steps,t_s");
    assert_eq!(rows(&other).len(), 6);
}

#[test]
fn neither_threads_nor_shards_change_a_byte() {
    let ground = Ground::new();
    made(&sweep(&ground, &GRID, "whole.csv"));
    let whole = ground.read("whole.csv");
    for threads in ["1", "7"] {
        let mut command = ground.command(&[&GRID[..], &["-o", "threads.csv"]].concat());
        made(&command.env("RAYON_NUM_THREADS", threads).output().unwrap());
        assert_eq!(ground.read("threads.csv"), whole, "{threads}");
        fs::remove_file(ground.file("threads.csv")).unwrap();
    }
    // A stack larger than any memory: no thread can be had.
    let mut command = ground.command(&[&GRID[..], &["-o", "none.csv"]].concat());
    made(
        &command
            .env("RUST_MIN_STACK", "4611686018427387904")
            .output()
            .unwrap(),
    );
    assert_eq!(ground.read("none.csv"), whole);
    for shard in ["4/7", "1/7", "7/7", "2/7", "6/7", "3/7", "5/7"] {
        let name = format!("{}.csv", shard.replace('/', "-"));
        made(&sweep(
            &ground,
            &[&GRID[..], &["--shard", shard]].concat(),
            &name,
        ));
    }
    let parts: Vec<_> = [7, 3, 1, 2, 5, 4, 6].map(|k| format!("{k}-7.csv")).into();
    let parts: Vec<_> = parts.iter().map(String::as_str).collect();
    let join = [&["sweep", "--join"], &parts[..]].concat();
    made(&sweep(&ground, &join, "joined.csv"));
    assert_eq!(ground.read("joined.csv"), whole);
    // What is there and whole is left as it is.
    made(&sweep(&ground, &join, "joined.csv"));
    made(&sweep(&ground, &join, "whole.csv"));
}

#[test]
fn killed_twenty_times_it_ends_with_the_same_bytes() {
    let ground = Ground::new();
    let args = [
        "sweep",
        "cusps",
        "--set",
        "motion.steps=4000",
        "--vary",
        "start.momentum_Js.2=20..400:60",
        "--measure",
        "z_m,measured_precession_rad_per_s",
    ];
    made(&sweep(&ground, &args, "whole.csv"));
    let whole = ground.read("whole.csv");
    let mut dice = Dice(13);
    let part = ground.file("killed.csv.part");
    let there = || fs::read_to_string(&part).map_or(0, |text| rows(&text).len() as u64);
    let mut most = 0;
    for kill in 0..20 {
        let until = there() + dice.whole(0, 4);
        let mut command = ground.command(&[&args[..], &["-o", "killed.csv"]].concat());
        let mut child = command.stderr(Stdio::null()).spawn().unwrap();
        while there() < until && child.try_wait().unwrap().is_none() {
            sleep(Duration::from_millis(1));
        }
        sleep(Duration::from_micros(dice.whole(0, 20_000)));
        // SIGKILL.
        child.kill().unwrap();
        child.wait().unwrap();
        let Ok(text) = fs::read_to_string(&part) else {
            // It has become whole: from the beginning once more.
            let _ = fs::remove_file(ground.file("killed.csv"));
            continue;
        };
        assert!(whole.starts_with(&text), "{text}");
        most = most.max(rows(&text).len());
        // What a crash of the machine would tear.
        if kill % 3 == 0 && text.ends_with('\n') {
            fs::write(&part, &text[..text.len() - 1]).unwrap();
        }
    }
    assert!(most > 1, "it was never killed between two rows");
    made(&sweep(&ground, &args, "killed.csv"));
    assert_eq!(ground.read("killed.csv"), whole);
    assert_eq!(ground.files(), ["killed.csv", "whole.csv"]);
}

#[test]
fn a_part_of_the_file_is_gone_on_with_and_no_row_is_computed_again() {
    let ground = Ground::new();
    made(&sweep(&ground, &GRID, "whole.csv"));
    let whole = ground.read("whole.csv");
    for cut in [
        0,
        1,
        50,
        whole.len() - 300,
        whole.len() - 7,
        whole.len() - 1,
        whole.len(),
    ] {
        ground.write("cut.csv.part", &whole[..cut]);
        let told = made(&sweep(&ground, &GRID, "cut.csv"));
        let kept = whole[..cut]
            .rfind('\n')
            .map_or(0, |end| rows(&whole[..end]).len());
        if kept > 1 {
            let words = format!("going on behind {} of 60 rows", kept - 1);
            assert!(told.contains(&words), "{words}: {told}");
        }
        assert_eq!(ground.read("cut.csv"), whole, "{cut}");
        fs::remove_file(ground.file("cut.csv")).unwrap();
    }
    // What is no row, and all behind it, is computed anew: a cell too few, another point.
    let row = rows(&whole)[30];
    let (begin, _) = row.rsplit_once(',').unwrap();
    for wrong in [begin.to_owned(), format!("1{row}")] {
        ground.write("cut.csv.part", &whole.replace(row, &wrong));
        let told = made(&sweep(&ground, &GRID, "cut.csv"));
        assert!(told.contains("going on behind 29 of 60 rows"), "{told}");
        assert_eq!(ground.read("cut.csv"), whole);
        fs::remove_file(ground.file("cut.csv")).unwrap();
    }
    let end = whole.find(row).unwrap();
    let damaged = [&whole.as_bytes()[..end], &[0, 159, 10, 200, 10]].concat();
    fs::write(ground.file("cut.csv.part"), damaged).unwrap();
    made(&sweep(&ground, &GRID, "cut.csv"));
    assert_eq!(ground.read("cut.csv"), whole);
}

#[test]
fn what_is_not_this_sweep_is_refused_and_left_alone() {
    let ground = Ground::new();
    made(&sweep(&ground, &GRID, "grid.csv"));
    let whole = ground.read("grid.csv");
    let told = made(&sweep(&ground, &GRID, "grid.csv"));
    assert!(told.contains("is whole"), "{told}");
    let mut other = GRID;
    other[5] = "start.momentum_Js.2=10..400:21";
    let words = [
        "grid.csv",
        "its line 9 is \"# count = 20\", not \"# count = 21\"",
        "--force",
    ];
    refused(&sweep(&ground, &other, "grid.csv"), 1, &words);
    assert_eq!(ground.read("grid.csv"), whole);
    ground.write("part.csv.part", &whole[..whole.len() - 5]);
    refused(
        &sweep(&ground, &other, "part.csv"),
        1,
        &["part.csv.part", "count = 20", "--force"],
    );
    assert_eq!(ground.read("part.csv.part"), whole[..whole.len() - 5]);
    let longer = format!("{whole}{}\n", rows(&whole)[60]);
    let shorter = &whole[..whole.len() - rows(&whole)[60].len() - 1];
    let swapped = whole.replace("\n10.0,rk4", "\n11.0,rk4");
    for (text, word) in [
        ("mine\n", "its line 1 is"),
        (&longer, "more than the rows"),
        (shorter, "59 of the 60 rows"),
        (&swapped, "is not row 2 of 60"),
        (&whole.replace("gyrolab = \"", "gyrolab = \"9."), "\"9."),
        (&whole.replace(",z_m,", ",y_m,"), ",y_m,"),
    ] {
        ground.write("mine.csv", text);
        refused(&sweep(&ground, &GRID, "mine.csv"), 1, &["mine.csv", word]);
        assert_eq!(ground.read("mine.csv"), text);
    }
    made(&sweep(
        &ground,
        &[&GRID[..], &["--force"]].concat(),
        "mine.csv",
    ));
    assert_eq!(ground.read("mine.csv"), whole);
    let forced = [&other[..], &["--force"]].concat();
    made(&sweep(&ground, &forced, "part.csv"));
    assert_eq!(ground.files(), ["grid.csv", "mine.csv", "part.csv"]);
}

#[test]
fn two_at_once_do_not_write_into_each_others_rows() {
    let ground = Ground::new();
    let file = fs::File::create(ground.file("grid.csv.part")).unwrap();
    file.lock().unwrap();
    refused(
        &sweep(&ground, &GRID, "grid.csv"),
        1,
        &["grid.csv.part", "another gyrolab"],
    );
}

#[test]
fn wrong_keys_values_and_readouts_are_refused_before_anything_runs() {
    let ground = Ground::new();
    let vary = "motion.steps=1,2";
    for (args, words) in [
        (&["cusps"][..], &["vary", "--vary"][..]),
        (&["cusp", "--vary", vary], &["did you mean cusps?"]),
        (
            &["precesion-over-tilt"],
            &["did you mean precession-over-tilt?"],
        ),
        (&["none.toml"], &["none.toml", "there is no such file"]),
        (
            &["cusps", "--vary", "motion.step=1,2"],
            &["motion.step", "did you mean motion.steps?"],
        ),
        (&["cusps", "--vary", "motion.steps=1..2"], &["A..B:N"]),
        (
            &["cusps", "--vary", "motion.steps=0,2"],
            &["motion.steps (0)", "1 or more"],
        ),
        (&["cusps", "--vary", "push.0.steps=1,2"], &["push.0"]),
        (
            &["cusps", "--vary", vary, "--vary", "motion.steps=3,4"],
            &["motion.steps", "twice"],
        ),
        (
            &[
                "cusps",
                "--vary",
                "start.momentum_Js.2=1,2",
                "--vary",
                "start.spin_rpm=10,20",
            ],
            &[
                "start.spin_rpm",
                "so does start.momentum_Js.2: a start has one of them",
            ],
        ),
        (
            &["cusps", "--vary", vary, "--measure", "tilt"],
            &["gyrolab: --measure tilt: is no readout: did you mean tilt_deg?"],
        ),
        (
            &["cusps", "--vary", vary, "--measure", "wall_s"],
            &["wall_s", "clock"],
        ),
        (
            &["cusps", "--vary", vary, "--measure", "z_m,z_m"],
            &["z_m", "twice"],
        ),
        (
            &["cusps", "--vary", vary, "--set", "motion.time_step_s=-1"],
            &["motion.time_step_s", "zero"],
        ),
        (
            &[
                "cusps",
                "--vary",
                "motion.time_step_s=1e-9..1e-8:1000000000",
            ],
            &["at most"],
        ),
        (
            &[
                "cusps",
                "--vary",
                "motion.steps=1..2000000:2000000",
                "--vary",
                "motion.time_step_s=1e-9..1e-8:1000",
            ],
            &["gyrolab: --vary: is a grid of 2000000000 points: at most"],
        ),
    ] {
        let output = sweep(&ground, &[&["sweep"], args].concat(), "out.csv");
        let told = String::from_utf8_lossy(&output.stderr).into_owned();
        refused(&output, 1, words);
        assert!(!told.contains("panicked"), "{told}");
        assert_eq!(ground.files(), [""; 0], "{args:?}");
    }
    for args in [
        &["sweep", "cusps", "--vary", vary][..],
        &["sweep", "cusps", "--shard", "3/2", "-o", "a.csv"],
        &["sweep", "cusps", "--join", "b.csv", "-o", "a.csv"],
        &["sweep", "--join", "b.csv"],
    ] {
        refused(&ground.run(args), 2, &[]);
    }
}

#[test]
fn what_is_wrong_in_a_sweep_file_is_told_with_its_line() {
    let ground = Ground::new();
    let good = "title = \"t\"\nscenario = \"cusps\"\nmeasure = [\"z_m\"]\n[[vary]]\nkey = \"motion.steps\"\nvalues = [1, 2]\n";
    for (from, to, words) in [
        ("title", "titel", &["s.toml:1:", "did you mean title?"][..]),
        ("\"cusps\"", "3", &["s.toml:2:", "scenario (3)"]),
        ("\"cusps\"", "\"cups\"", &["did you mean cusps?"]),
        ("[\"z_m\"]", "[\"z\"]", &["s.toml:3:", "did you mean z_m?"]),
        ("[[vary]]", "[vary]", &["s.toml:4:", "[[vary]]"]),
        ("key", "keys", &["vary.0", "did you mean key?"]),
        (
            "motion.steps",
            "motion.stops",
            &["s.toml:5:", "did you mean motion.steps?"],
        ),
        ("[1, 2]", "[1, 2.5]", &["whole number"]),
        ("[1, 2]", "[]", &["s.toml:6:", "at least one"]),
        (
            "values = [1, 2]",
            "from = 1",
            &["s.toml:", "from, to and count"],
        ),
        (
            "values = [1, 2]",
            "from = 1\nto = 5\ncount = 3\nvalues = [1]",
            &["either"],
        ),
        ("scenario = \"cusps\"\n", "", &["scenario", "is missing"]),
        (
            "\"t\"",
            r#""t\u001b]0;P\u0007""#,
            &[
                "s.toml:1: title (",
                "no control, direction or invisible characters (here U+001B)",
            ],
        ),
        (
            "title",
            "about = \"a\u{202e}b\"\ntitle",
            &["s.toml:1: about (", "U+202E"],
        ),
    ] {
        let text = good.replacen(from, to, 1);
        assert_ne!(text, good);
        ground.write("s.toml", &text);
        for args in [
            &["check", "s.toml"][..],
            &["sweep", "s.toml", "-o", "out.csv"],
        ] {
            refused(&ground.run(args), 1, words);
        }
    }
    // The scenario itself, in the file.
    let inside = "[scenario]\ntitle = \"x\"\n[scenario.start]\nmomentum_Js = [0, 0, 1]\n[scenario.motion]\ntime_step_s = 0.1\nsteps = 0\n";
    let text = format!("{}{inside}", good.replace("scenario = \"cusps\"\n", ""));
    ground.write("s.toml", &text);
    refused(
        &ground.run(&["check", "s.toml"]),
        1,
        &["s.toml:12:", "scenario.motion.steps (0)"],
    );
}

/// A sweep over the scheme, of which the rows by rk4 break down.
const SOME_ROWS_FAIL: [&str; 6] = [
    "sweep",
    "method-2",
    "--set",
    "motion.steps=40",
    "--vary",
    "motion.scheme=report,rk4",
];

#[test]
fn a_point_that_fails_is_a_row_without_readouts_and_its_reason_is_told() {
    let ground = Ground::new();
    let more = [
        "--vary=body.rim.height_m=0.5,0,1e200",
        "--measure=z_m,path,steps",
    ];
    let args = [&SOME_ROWS_FAIL[..], &more].concat();
    let told = made(&sweep(&ground, &args, "out.csv"));
    let csv = ground.read("out.csv");
    let rows = rows(&csv);
    assert!(rows[1].starts_with("report,0.5,0.8"), "{csv}");
    assert_eq!(rows[4], "rk4,0.5,,,", "{csv}");
    assert_eq!(
        [rows[3], rows[6]],
        ["report,1e200,,,", "rk4,1e200,,,"],
        "{csv}"
    );
    assert!(told.contains("rows without readouts: 3 of 6"), "{told}");
    assert!(
        told.contains(
            "motion.scheme = \"rk4\", body.rim.height_m = 0.5: the numbers are no longer finite"
        ),
        "{told}"
    );
    assert_eq!(
        told.matches("body.rim.height_m = 1e200").count(),
        2,
        "{told}"
    );
    made(&sweep(&ground, &["sweep", "out.csv"], "again.csv"));
    assert_eq!(csv, ground.read("again.csv"));
}

/// A file does not say why a row is empty: of such a row the point is named.
#[test]
fn rows_without_readouts_are_told_by_every_command_that_finds_them() {
    let ground = Ground::new();
    let more = ["--vary=body.rim.height_m=0.5,1e200", "--measure=z_m"];
    let args = [&SOME_ROWS_FAIL[..], &more].concat();
    let count = "gyrolab: rows without readouts: 3 of 4\n";
    let reasons = [
        "motion.scheme = \"rk4\", body.rim.height_m = 0.5: ",
        "motion.scheme = \"report\", body.rim.height_m = 1e200: ",
        "motion.scheme = \"rk4\", body.rim.height_m = 1e200: ",
    ];
    let is_told = |told: &str| {
        assert!(told.contains(count), "{told}");
        let missing = reasons.iter().find(|reason| !told.contains(*reason));
        assert_eq!(missing, None, "{told}");
    };
    let told = made(&sweep(&ground, &args, "whole.csv"));
    is_told(&told);
    assert!(
        told.contains("0.5: the numbers are no longer finite"),
        "{told}"
    );
    let whole = ground.read("whole.csv");
    // A file that is whole already, and one that was ended behind its second row or before its last.
    is_told(&made(&sweep(&ground, &args, "whole.csv")));
    for (kept, words) in [
        (
            2,
            "behind 2 of 4 rows in cut.csv.part, 1 of them without readouts\n",
        ),
        (
            3,
            "behind 3 of 4 rows in cut.csv.part, 2 of them without readouts\n",
        ),
    ] {
        let lost: usize = rows(&whole)[1 + kept..]
            .iter()
            .map(|row| row.len() + 1)
            .sum();
        ground.write("cut.csv.part", &whole[..whole.len() - lost]);
        let told = made(&sweep(&ground, &args, "cut.csv"));
        assert!(told.contains(words), "{told}");
        is_told(&told);
        assert_eq!(ground.read("cut.csv"), whole);
        fs::remove_file(ground.file("cut.csv")).unwrap();
    }
    // Shards joined, and once more where the file is whole.
    for shard in ["1/2", "2/2"] {
        let name = format!("{}.csv", &shard[..1]);
        made(&sweep(
            &ground,
            &[&args[..], &["--shard", shard]].concat(),
            &name,
        ));
    }
    for _ in 0..2 {
        let join = ["sweep", "--join", "1.csv", "2.csv"];
        is_told(&made(&sweep(&ground, &join, "joined.csv")));
    }
    assert_eq!(ground.read("joined.csv"), whole);
}

/// What a broken disk leaves behind good rows is told as such, with what to do.
#[test]
fn a_time_step_that_varies_holds_the_seconds() {
    let ground = Ground::new();
    let args = [
        "sweep",
        "wobble-push",
        "--vary",
        "motion.time_step_s=0.1,0.05,0.2,500",
        "--measure",
        "t_s,steps,measured_lowest_z_m",
    ];
    let told = made(&sweep(&ground, &args, "out.csv"));
    assert!(
        told.contains("not be longer than the whole run, 230 s"),
        "{told}"
    );
    let csv = ground.read("out.csv");
    let rows = rows(&csv);
    for (row, beginning) in [
        (1, "0.1,230.0,2300,"),
        (2, "0.05,230.0,4600,"),
        (3, "0.2,230.0,1150,"),
    ] {
        assert!(rows[row].starts_with(beginning), "{csv}");
    }
    // As `run --time-step` has it: the push lasts 20 s.
    let run = ground.run(&["run", "wobble-push", "--time-step", "0.05", "--json"]);
    let json: serde_json::Value = serde_json::from_slice(&run.stdout).unwrap();
    let lowest = json["measured_lowest_z_m"].as_f64().unwrap();
    assert!(rows[2].ends_with(&format!(",{lowest}")), "{csv} {lowest}");
    // A push that accumulates is another at another time step.
    let args = [
        "sweep",
        "wobble-push-accumulating",
        "--vary",
        "motion.time_step_s=0.1,0.05",
        "--measure",
        "t_s",
    ];
    let told = made(&sweep(&ground, &args, "acc.csv"));
    assert!(
        told.contains("rows without readouts: 1 of 2") && told.contains("accumulates"),
        "{told}"
    );
}

#[test]
fn ctrl_c_keeps_what_was_done() {
    let ground = Ground::new();
    let args = [
        "sweep",
        "cusps",
        "--set",
        "motion.steps=2000",
        "--vary",
        "start.momentum_Js.2=20..400:100000",
        "--measure",
        "z_m",
        "-o",
        "out.csv",
    ];
    let child = ground
        .command(&args)
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let part = ground.file("out.csv.part");
    while fs::read_to_string(&part).map_or(0, |text| rows(&text).len()) < 3 {
        sleep(Duration::from_millis(5));
    }
    let pid = child.id().to_string();
    assert!(
        Command::new("kill")
            .args(["-INT", &pid])
            .status()
            .unwrap()
            .success()
    );
    let output = child.wait_with_output().unwrap();
    refused(&output, 130, &["rows are in", "out.csv.part", "goes on"]);
    let text = fs::read_to_string(&part).unwrap();
    assert!(text.ends_with('\n'));
    let kept = rows(&text).len() - 1;
    let told = String::from_utf8(output.stderr).unwrap();
    assert!(
        told.contains(&format!("{kept} of 100000 rows")),
        "{kept}: {told}"
    );
}

#[test]
fn a_disk_that_is_full_and_a_folder_that_takes_no_file() {
    let ground = Ground::new();
    let grid = "\"$G\" sweep cusps --set motion.steps=2 --vary start.momentum_Js.2=10..400:2000 --measure z_m,x_m,y_m";
    let full = ground.shell(&format!("ulimit -f 40; {grid} -o out.csv"));
    refused(
        &full,
        1,
        &["out.csv.part", "large", "of 2000 rows are in", "goes on"],
    );
    // With room again the same command goes on, and nothing is lost or twice.
    let told = made(&ground.shell(&format!("{grid} -o out.csv")));
    assert!(told.contains("going on behind"), "{told}");
    made(&ground.shell(&format!("{grid} -o whole.csv")));
    assert_eq!(ground.read("out.csv"), ground.read("whole.csv"));
    fs::create_dir(ground.file("folder")).unwrap();
    symlink("/dev/full", ground.file("link.csv.part")).unwrap();
    for (output, word) in [
        ("none/out.csv", "there is no folder"),
        ("folder", "is a folder"),
        ("folder/", "is a folder"),
        ("/dev/null", "not a regular file"),
        ("/dev/full", "not a regular file"),
        ("link.csv", "not a regular file"),
        ("/proc/out.csv", "cannot write"),
        ("-", "not written to stdout"),
    ] {
        let args = ["sweep", "cusps", "--vary", "motion.steps=1,2"];
        refused(
            &sweep(&ground, &args, output),
            1,
            &[output.trim_end_matches('/'), word],
        );
    }
    assert_eq!(
        ground.files(),
        ["folder", "link.csv.part", "out.csv", "whole.csv"]
    );
}

#[test]
fn only_whole_shards_of_one_sweep_are_joined() {
    let ground = Ground::new();
    let shard = |args: &[&str], shard: &str, name: &str| {
        made(&sweep(&ground, &[args, &["--shard", shard]].concat(), name));
    };
    let mut other = GRID;
    other[3] = "motion.steps=300";
    shard(&GRID, "1/3", "1.csv");
    shard(&GRID, "2/3", "2.csv");
    shard(&GRID, "3/3", "3.csv");
    shard(&GRID, "2/4", "of-4.csv");
    shard(&other, "3/3", "other.csv");
    let text = ground.read("3.csv");
    ground.write("torn.csv", &text[..text.len() - 1]);
    let last = text.lines().last().unwrap();
    ground.write("twice.csv", &format!("{text}{last}\n"));
    ground.write("changed.csv", &text.replace(",exact,", ",rk4,"));
    for (parts, words) in [
        (&["1.csv", "3.csv"][..], &["3 shards", "missing: 2"][..]),
        (&["1.csv"], &["missing: 2, 3"]),
        (
            &["1.csv", "2.csv", "3.csv", "2.csv"],
            &["2.csv", "shard 2/3", "so is another"],
        ),
        (
            &["1.csv", "2.csv", "of-4.csv"],
            &["of-4.csv", "shard 2/4", "one of 3"],
        ),
        (
            &["1.csv", "2.csv", "other.csv"],
            &["other.csv", "steps = 300", "steps = 400"],
        ),
        (
            &["1.csv", "2.csv", "torn.csv"],
            &["torn.csv", "is not row 20 of 20", "again"],
        ),
        (
            &["1.csv", "2.csv", "twice.csv"],
            &["twice.csv", "more than the rows"],
        ),
        (
            &["1.csv", "2.csv", "changed.csv"],
            &["changed.csv", "is not row 2 of 20"],
        ),
        (
            &["1.csv", "2.csv", "none.csv"],
            &["none.csv", "there is no such file"],
        ),
    ] {
        let join = [&["sweep", "--join"], parts].concat();
        refused(&sweep(&ground, &join, "joined.csv"), 1, words);
        assert!(!ground.file("joined.csv").exists(), "{parts:?}");
    }
    made(&sweep(
        &ground,
        &["sweep", "--join", "3.csv", "1.csv", "2.csv"],
        "joined.csv",
    ));
    made(&sweep(&ground, &GRID, "whole.csv"));
    assert_eq!(ground.read("joined.csv"), ground.read("whole.csv"));
}

#[test]
fn the_shipped_sweeps_are_listed_and_printed() {
    let ground = Ground::new();
    let list = ground.run(&["sweep"]);
    let list = String::from_utf8(list.stdout).unwrap();
    for name in [
        "wobble-over-time-step",
        "precession-over-momentum",
        "precession-over-tilt",
    ] {
        assert!(list.contains(&format!("{name}: ")), "{list}");
        let printed = ground.run(&["presets", name]);
        ground.write("mine.toml", &String::from_utf8(printed.stdout).unwrap());
        assert_eq!(code(&ground.run(&["check", "mine.toml"])), 0);
    }
    let man = ground.run(&["man", "sweep"]);
    let man = String::from_utf8(man.stdout).unwrap();
    assert!(
        man.contains("SLURM_ARRAY_TASK_ID") && man.contains("parallel"),
        "{man}"
    );
}

/// On a terminal there is something to see before the first row, and no rate or time left is made up.
#[test]
fn progress_is_shown_from_the_beginning() {
    let ground = Ground::new();
    let args = [
        "sweep",
        "cusps",
        "--vary",
        "start.tilt_deg=10..40:1000",
        "--set",
        "motion.steps=100000000",
        "--measure=z_m",
        "-o",
        "slow.csv",
    ];
    let mut terminal = ground.open(&args);
    terminal.wait_for("row 0 of 1,000");
    let text = terminal.sent_text();
    assert!(!text.contains("left") && !text.contains("/s"), "{text}");
    terminal.press("\u{3}");
    assert_eq!(terminal.wait_for_end().exit_code(), 130);
}

#[test]
fn steps_and_seconds_of_a_push_are_not_mixed() {
    let ground = Ground::new();
    let vary = |more: &[&str]| {
        let args = [&["sweep", "wobble-push", "--measure=z_m"], more].concat();
        sweep(&ground, &args, "out.csv")
    };
    for (args, words) in [
        (
            &["--time-step=0.01", "--vary=push.0.steps=20,200"][..],
            "--vary push.0.steps=20,200: push.0.steps: the push counts in seconds (--time-step turns steps into seconds): vary push.0.for_s",
        ),
        (
            &["--time-step=0.01", "--vary=push.0.first_step=20,200"],
            "vary push.0.from_s",
        ),
        (
            &["--vary=push.0.for_s=1,2"],
            "push.0.for_s: the push counts in steps: vary push.0.steps",
        ),
        (
            &["--vary=push.0.from_s=1,2"],
            "push.0.from_s: the push counts in steps: vary push.0.first_step",
        ),
    ] {
        refused(&vary(args), 1, &[words]);
        assert_eq!(ground.files(), [""; 0]);
    }
    let told = made(&vary(&["--set=motion.steps=10", "--vary=push.0.steps=2,3"]));
    assert!(!told.contains("without readouts"), "{told}");
    fs::remove_file(ground.file("out.csv")).unwrap();
    let args = [
        "--time-step=0.1",
        "--set=motion.steps=10",
        "--vary=push.0.for_s=2,3",
    ];
    let told = made(&vary(&args));
    assert!(!told.contains("without readouts"), "{told}");
}

#[test]
fn a_value_may_be_an_empty_text() {
    let ground = Ground::new();
    let args = [
        "sweep",
        "cusps",
        "--set=motion.steps=2",
        "--vary",
        "about=\"\",x,\"a,b\"",
        "--measure=z_m",
    ];
    made(&sweep(&ground, &args, "out.csv"));
    let told = made(&sweep(&ground, &args, "out.csv"));
    assert!(told.contains("out.csv is whole, 3 rows"), "{told}");
    let verified = ground.run(&["verify", "out.csv"]);
    assert_eq!(code(&verified), 0, "{verified:?}");
    for shard in ["1/2", "2/2"] {
        let name = format!("{}.csv", &shard[..1]);
        made(&sweep(
            &ground,
            &[&args[..], &["--shard", shard]].concat(),
            &name,
        ));
    }
    let join = ["sweep", "--join", "1.csv", "2.csv"];
    made(&sweep(&ground, &join, "joined.csv"));
    assert_eq!(ground.read("joined.csv"), ground.read("out.csv"));
}

/// What differs between two sweeps comes first, cut short, and the users' own words are left as they are.
#[test]
fn another_sweep_is_told_by_the_first_key_that_differs() {
    let ground = Ground::new();
    let about = |title: &str, shard: &str| {
        let args = [
            "sweep",
            "cusps",
            "--set=motion.steps=2",
            &format!("--set=title={title}"),
            "--vary=start.momentum_Js.2=10..400:4",
            "--measure=z_m",
            "--shard",
            shard,
        ];
        made(&sweep(
            &ground,
            &args,
            &format!("{}.csv", shard.replace('/', "-")),
        ));
    };
    about("a top here and there", "1/2");
    about("a top", "2/2");
    let join = ["sweep", "--join", "1-2.csv", "2-2.csv"];
    let output = sweep(&ground, &join, "joined.csv");
    let words = "2-2.csv: is no shard of the sweep of 1-2.csv: its line 2 is";
    refused(&output, 1, &[words, "a top\"", "a top here and there"]);
    let all = ["sweep", "cusps", "--set=motion.steps=2"];
    let vary = |values: &'static str| ["--vary", values];
    let first = vary("start.momentum_Js.2=10,20,30");
    made(&sweep(&ground, &[&all[..], &first].concat(), "all.csv"));
    for (more, words) in [
        (&[first[0], first[1], "--measure=steps,z_m"][..], "measure"),
        (
            &vary("start.momentum_Js.2=10,21,30"),
            "is \"# values = [10, 20, 30]\", not \"# values = [10, 21, 30]\"; --force replaces it\n",
        ),
    ] {
        let output = sweep(&ground, &[&all[..], more].concat(), "all.csv");
        refused(&output, 1, &[words]);
        assert!(output.stderr.len() < 300, "{output:?}");
    }
}

#[test]
fn a_symbolic_link_is_kept_and_the_file_behind_it_replaced() {
    let ground = Ground::new();
    let args = ["sweep", "cusps", "--measure=z_m", "--vary=motion.steps=2,3"];
    fs::create_dir(ground.file("deep")).unwrap();
    ground.write("deep/mine.csv", "mine\n");
    symlink("deep/mine.csv", ground.file("link.csv")).unwrap();
    refused(
        &sweep(&ground, &args, "link.csv"),
        1,
        &["link.csv", "--force"],
    );
    let force = [&args[..], &["--force"]].concat();
    let told = made(&sweep(&ground, &force, "link.csv"));
    assert!(told.contains("gyrolab: 2 rows in link.csv\n"), "{told}");
    assert!(ground.file("link.csv").is_symlink());
    assert_eq!(rows(&ground.read("deep/mine.csv")).len(), 3);
    assert_eq!(ground.files(), ["deep", "link.csv"]);
    assert_eq!(names(&ground.file("deep")), ["mine.csv"]);
}

#[test]
fn where_it_cannot_be_written_there_is_what_to_do() {
    let ground = Ground::new();
    let args = [
        "sweep",
        "cusps",
        "--vary",
        "motion.steps=1,2",
        "--measure=z_m",
    ];
    let advice = "name a file in a folder that exists";
    refused(&sweep(&ground, &args, "/proc/out.csv"), 1, &[advice]);
    // Joining writes the whole at once.
    made(&sweep(
        &ground,
        &[&args[..], &["--shard", "1/1"]].concat(),
        "whole.csv",
    ));
    let join = ["sweep", "--join", "whole.csv"];
    refused(&sweep(&ground, &join, "/proc/out.csv"), 1, &[advice]);
}

#[test]
fn more_shards_than_files_may_be_open_are_joined() {
    let ground = Ground::new();
    let grid = "\"$G\" sweep cusps --set motion.steps=2 --vary start.momentum_Js.2=10..400:200 --measure z_m,x_m,y_m";
    made(&ground.shell(&format!("{grid} -o whole.csv")));
    let whole = ground.read("whole.csv");
    let (header, all) = whole.split_at(whole.find("start.momentum_Js.2,z_m").unwrap());
    let all: Vec<&str> = all.split_inclusive('\n').collect();
    const OF: usize = 150;
    made(&ground.shell(&format!("{grid} --shard 1/{OF} -o 1.csv")));
    let first = ground.read("1.csv");
    let of_first = &first[..first.find("start.momentum_Js.2,z_m").unwrap()];
    assert_ne!(of_first, header);
    for number in 1..=OF {
        let header = of_first.replace(&format!("\"1/{OF}\""), &format!("\"{number}/{OF}\""));
        let [begin, end] = [number - 1, number].map(|number| 1 + 200 * number / OF);
        let rows = all[begin..end].concat();
        ground.write(&format!("{number}.csv"), &(header + all[0] + &rows));
    }
    assert_eq!(ground.read("1.csv"), first);
    let parts: Vec<String> = (1..=OF).map(|number| format!("{number}.csv")).collect();
    let join = format!(
        "ulimit -n 64; \"$G\" sweep --join {} -o joined.csv",
        parts.join(" ")
    );
    made(&ground.shell(&join));
    assert_eq!(ground.read("joined.csv"), whole);
}
