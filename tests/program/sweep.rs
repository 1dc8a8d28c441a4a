//! `gyrolab sweep`: its CSV, resuming, error messages, and joining shards.

use crate::support::dice::Dice;
use crate::support::ground::{Ground, code, names, refused};
use crate::support::pty::signal;
use crate::support::words::{has, has_all, has_no};
use std::fs;
use std::os::unix::fs::symlink;
use std::process::{Output, Stdio};
use std::thread::sleep;
use std::time::Duration;

/// A sweep of 60 short runs over a number and a text, some of which fail.
const GRID: &str = "cusps --set motion.steps=400 --vary start.momentum_Js.2=10..400:20 \
    --vary motion.scheme=report,rk4,exact --measure=z_m,tilt_deg,path,measured_tilt_swing_deg,most_distance_m";

/// Returns the command that sweeps `args` into the file `output`.
fn sweep_command(args: &str, output: &str) -> String {
    format!("sweep {args} -o {output}")
}

/// Runs a sweep, which must succeed without output on stdout, and returns its stderr.
#[track_caller]
fn run_sweep(ground: &Ground, args: &str, output: &str) -> String {
    successful(&ground.run(&sweep_command(args, output)))
}

#[track_caller]
fn successful(output: &Output) -> String {
    assert_eq!(code(output), 0, "{output:?}");
    assert!(output.stdout.is_empty(), "{output:?}");
    String::from_utf8(output.stderr.clone()).unwrap()
}

#[track_caller]
fn assert_rejected(ground: &Ground, args: &str, output: &str, words: &[&str]) {
    ground.refused(&sweep_command(args, output), 1, words);
}

/// Returns the lines of a CSV below the sweep file in its header.
fn rows(csv: &str) -> Vec<&str> {
    csv.lines().filter(|line| !line.starts_with('#')).collect()
}

fn remove(ground: &Ground, name: &str) {
    fs::remove_file(ground.file(name)).unwrap();
}

/// Computes each shard of the sweep `args` into `1.csv` and so on.
#[track_caller]
fn run_shards(ground: &Ground, args: &str, of: usize) {
    for shard in 1..=of {
        let args = format!("{args} --shard {shard}/{of}");
        run_sweep(ground, &args, &format!("{shard}.csv"));
    }
}

#[test]
fn rows_equal_single_runs_in_grid_order() {
    let ground = Ground::new();
    run_sweep(&ground, GRID, "grid.csv");
    let csv = ground.read("grid.csv");
    let rows = rows(&csv);
    assert_eq!(
        rows[0],
        "start.momentum_Js.2,motion.scheme,z_m,tilt_deg,path,measured_tilt_swing_deg,most_distance_m,reliable"
    );
    assert_eq!(rows.len(), 61);
    assert!(rows[1].starts_with("10.0,report,") && rows[2].starts_with("10.0,rk4,"));
    assert!(rows[60].starts_with("400.0,exact,"));
    // The row of a point equals the output of `run` to the last digit.
    let json =
        ground.stdout("run cusps --steps 400 --set start.momentum_Js.2=400 --scheme rk4 --json");
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
fn the_csv_of_a_sweep_is_its_sweep_file() {
    let ground = Ground::new();
    run_sweep(&ground, GRID, "grid.csv");
    run_sweep(&ground, "grid.csv", "again.csv");
    let csv = ground.read("grid.csv");
    assert_eq!(csv, ground.read("again.csv"));
    let header = csv.lines().filter_map(|line| line.strip_prefix("# "));
    let file: String = header.flat_map(|line| [line, "\n"]).collect();
    ground.write("grid.toml", &file);
    run_sweep(&ground, "grid.toml", "file.csv");
    assert_eq!(csv, ground.read("file.csv"));
    for name in ["grid.csv", "grid.toml"] {
        has(ground.stdout(&format!("check {name}")), "rows: 60");
    }
    // It is not a scenario.
    ground.refused("run grid.csv", 1, &["grid.csv", "gyrolab sweep"]);
}

#[test]
fn scenario_paths_are_relative_to_the_sweep_file() {
    let ground = Ground::new();
    fs::create_dir(ground.file("deep")).unwrap();
    ground.write("deep/mine.toml", &ground.stdout("presets cusps"));
    let file = "scenario = \"mine.toml\"\nmeasure = [\"z_m\"]\n\
        [[vary]]\nkey = \"motion.steps\"\nvalues = [1, 2]\n";
    ground.write("deep/sweep.toml", file);
    run_sweep(&ground, "deep/sweep.toml", "out.csv");
    assert_eq!(rows(&ground.read("out.csv")).len(), 3);
    // --vary replaces the values of the file, and --measure its readouts.
    let args = "deep/sweep.toml --vary motion.steps=1..5:5 --measure t_s";
    run_sweep(&ground, args, "other.csv");
    let other = ground.read("other.csv");
    assert_eq!(rows(&other)[0], "motion.steps,t_s,reliable");
    assert_eq!(rows(&other).len(), 6);
}

#[test]
fn results_do_not_depend_on_threads_or_shards() {
    let ground = Ground::new();
    run_sweep(&ground, GRID, "whole.csv");
    let whole = ground.read("whole.csv");
    for (variable, value) in [
        ("RAYON_NUM_THREADS", "1"),
        ("RAYON_NUM_THREADS", "7"),
        // A thread stack larger than the memory: no thread can be created.
        ("RUST_MIN_STACK", "4611686018427387904"),
    ] {
        let mut command = ground.command(&sweep_command(GRID, "threads.csv"));
        successful(&command.env(variable, value).output().unwrap());
        assert_eq!(ground.read("threads.csv"), whole, "{variable} {value}");
        remove(&ground, "threads.csv");
    }
    for shard in [4, 1, 7, 2, 6, 3, 5] {
        let args = format!("{GRID} --shard {shard}/7");
        run_sweep(&ground, &args, &format!("{shard}.csv"));
    }
    let join = "--join 7.csv 3.csv 1.csv 2.csv 5.csv 4.csv 6.csv";
    run_sweep(&ground, join, "joined.csv");
    assert_eq!(ground.read("joined.csv"), whole);
    // A complete file is left unchanged.
    run_sweep(&ground, join, "joined.csv");
    run_sweep(&ground, join, "whole.csv");
}

#[test]
fn a_sweep_killed_twenty_times_ends_with_the_same_bytes() {
    let ground = Ground::new();
    let args = "cusps --set motion.steps=4000 --vary start.momentum_Js.2=20..400:60 \
        --measure z_m,measured_precession_rad_per_s";
    run_sweep(&ground, args, "whole.csv");
    let whole = ground.read("whole.csv");
    let mut dice = Dice(13);
    let part = ground.file("killed.csv.part");
    let there = || fs::read_to_string(&part).map_or(0, |text| rows(&text).len() as u64);
    let mut most = 0;
    for kill in 0..20 {
        let until = there() + dice.whole(0, 4);
        let mut command = ground.command(&sweep_command(args, "killed.csv"));
        let mut child = command.stderr(Stdio::null()).spawn().unwrap();
        while there() < until && child.try_wait().unwrap().is_none() {
            sleep(Duration::from_millis(1));
        }
        sleep(Duration::from_micros(dice.whole(0, 20_000)));
        child.kill().unwrap();
        child.wait().unwrap();
        let Ok(text) = fs::read_to_string(&part) else {
            // The sweep is complete: start over.
            let _ = fs::remove_file(ground.file("killed.csv"));
            continue;
        };
        assert!(whole.starts_with(&text), "{text}");
        most = most.max(rows(&text).len());
        // Cut off a row, as a crash of the machine could.
        if kill % 3 == 0 && text.ends_with('\n') {
            fs::write(&part, &text[..text.len() - 1]).unwrap();
        }
    }
    assert!(most > 1, "never killed between two rows");
    run_sweep(&ground, args, "killed.csv");
    assert_eq!(ground.read("killed.csv"), whole);
    assert_eq!(ground.files(), ["killed.csv", "whole.csv"]);
}

#[test]
fn a_sweep_resumes_from_a_partial_file() {
    let ground = Ground::new();
    run_sweep(&ground, GRID, "whole.csv");
    let whole = ground.read("whole.csv");
    // Asserts that the sweep resumes from `part` and keeps `kept` of its rows.
    let goes_on = |part: &[u8], kept: usize| {
        fs::write(ground.file("cut.csv.part"), part).unwrap();
        let told = run_sweep(&ground, GRID, "cut.csv");
        let words = format!("continuing after {kept} of 60 rows");
        assert!(kept == 0 || told.contains(&words), "{words}: {told}");
        assert_eq!(ground.read("cut.csv"), whole, "{kept}");
        remove(&ground, "cut.csv");
    };
    let end = whole.len();
    for cut in [0, 1, 50, end - 300, end - 7, end - 1, end] {
        let kept = whole[..cut]
            .rfind('\n')
            .map_or(0, |last| rows(&whole[..last]).len());
        goes_on(&whole.as_bytes()[..cut], kept.saturating_sub(1));
    }
    // An invalid row (a missing cell, another point, other bytes) and all rows after it are computed again.
    let row = rows(&whole)[30];
    let (begin, _) = row.rsplit_once(',').unwrap();
    let field = |cell: &str| format!("{begin},{cell}");
    let extra = format!("{row},x");
    for wrong in [
        begin.to_owned(),
        format!("1{row}"),
        field("x"),
        field("nan"),
        extra,
    ] {
        goes_on(whole.replace(row, &wrong).as_bytes(), 29);
    }
    let before = whole.find(row).unwrap();
    let damaged = [&whole.as_bytes()[..before], &[0, 159, 10, 200, 10]].concat();
    goes_on(&damaged, 29);
}

#[test]
fn files_of_other_sweeps_are_rejected_and_left_alone() {
    let ground = Ground::new();
    run_sweep(&ground, GRID, "grid.csv");
    let whole = ground.read("grid.csv");
    has(run_sweep(&ground, GRID, "grid.csv"), "is complete");
    let other = GRID.replace("400:20", "400:21");
    let words = "its line 9 is \"# count = 20\", not \"# count = 21\"";
    assert_rejected(&ground, &other, "grid.csv", &["grid.csv", words, "--force"]);
    assert_eq!(ground.read("grid.csv"), whole);
    ground.write("part.csv.part", &whole[..whole.len() - 5]);
    let unfinished = ["part.csv.part", "count = 20", "--force"];
    assert_rejected(&ground, &other, "part.csv", &unfinished);
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
        assert_rejected(&ground, GRID, "mine.csv", &["mine.csv", word]);
        assert_eq!(ground.read("mine.csv"), text);
    }
    run_sweep(&ground, &format!("{GRID} --force"), "mine.csv");
    assert_eq!(ground.read("mine.csv"), whole);
    run_sweep(&ground, &format!("{other} --force"), "part.csv");
    assert_eq!(ground.files(), ["grid.csv", "mine.csv", "part.csv"]);
}

#[test]
fn two_processes_cannot_write_one_sweep() {
    let ground = Ground::new();
    let file = fs::File::create(ground.file("grid.csv.part")).unwrap();
    file.lock().unwrap();
    let words = ["grid.csv.part", "another gyrolab"];
    assert_rejected(&ground, GRID, "grid.csv", &words);
}

#[test]
fn wrong_keys_values_and_readouts_are_rejected_before_any_run() {
    let ground = Ground::new();
    for (args, words) in [
        ("cusps", &["vary", "--vary"][..]),
        ("cusp --vary motion.steps=1,2", &["did you mean cusps?"]),
        (
            "precesion-over-tilt",
            &["did you mean precession-over-tilt?"],
        ),
        ("none.toml", &["none.toml"]),
        (
            "cusps --vary motion.step=1,2",
            &["motion.step", "did you mean motion.steps?"],
        ),
        ("cusps --vary motion.steps=1..2", &["A..B:N"]),
        (
            "cusps --vary motion.steps=0,2",
            &["motion.steps (0)", "1 or more"],
        ),
        ("cusps --vary push.0.steps=1,2", &["push.0"]),
        (
            "cusps --vary motion.steps=1,2 --vary motion.steps=3,4",
            &["motion.steps", "twice"],
        ),
        (
            "cusps --vary start.momentum_Js.2=1,2 --vary start.spin_rpm=10,20",
            &[
                "start.spin_rpm",
                "so does start.momentum_Js.2: a start has one of them",
            ],
        ),
        (
            "cusps --vary motion.steps=1,2 --measure tilt",
            &["gyrolab: --measure tilt: is no readout: did you mean tilt_deg?"],
        ),
        (
            "cusps --vary motion.steps=1,2 --measure wall_s",
            &["wall_s", "clock"],
        ),
        (
            "cusps --vary motion.steps=1,2 --measure z_m,z_m",
            &["z_m", "twice"],
        ),
        (
            "cusps --vary motion.steps=1,2 --set motion.time_step_s=-1",
            &["motion.time_step_s", "zero"],
        ),
        (
            "cusps --vary motion.time_step_s=1e-9..1e-8:1000000000",
            &["at most"],
        ),
        (
            "cusps --vary motion.steps=1..2000000:2000000 --vary motion.time_step_s=1e-9..1e-8:1000",
            &["gyrolab: --vary: is a grid of 2000000000 points: at most"],
        ),
        // A push has its times either in steps or in seconds.
        (
            "wobble-push --time-step=0.01 --vary=push.0.steps=20,200",
            &[
                "--vary push.0.steps=20,200: push.0.steps: the push counts in seconds (--time-step turns steps into seconds): vary push.0.for_s",
            ],
        ),
        (
            "wobble-push --time-step=0.01 --vary=push.0.first_step=20,200",
            &["vary push.0.from_s"],
        ),
        (
            "wobble-push --vary=push.0.for_s=1,2",
            &["push.0.for_s: the push counts in steps: vary push.0.steps"],
        ),
        (
            "wobble-push --vary=push.0.from_s=1,2",
            &["push.0.from_s: the push counts in steps: vary push.0.first_step"],
        ),
    ] {
        assert_rejected(&ground, args, "out.csv", words);
        assert_eq!(ground.files(), [""; 0], "{args}");
    }
    for args in [
        "sweep cusps --vary motion.steps=1,2",
        "sweep cusps --shard 3/2 -o a.csv",
        "sweep cusps --join b.csv -o a.csv",
        "sweep --join b.csv",
    ] {
        ground.refused(args, 2, &[]);
    }
    for args in [
        "wobble-push --measure=z_m --set=motion.steps=10 --vary=push.0.steps=2,3",
        "wobble-push --measure=z_m --set=motion.steps=10 --vary=push.0.for_s=2,3 --time-step=0.1",
    ] {
        has_no(run_sweep(&ground, args, "out.csv"), "without readouts");
        remove(&ground, "out.csv");
    }
}

#[test]
fn mistakes_in_a_sweep_file_are_reported_with_their_line() {
    let ground = Ground::new();
    let good = "title = \"t\"\nscenario = \"cusps\"\nmeasure = [\"z_m\"]\n[[vary]]\nkey = \"motion.steps\"\nvalues = [1, 2]\n";
    let values = "values = [1, 2]";
    let both = "from = 1\nto = 5\ncount = 3\nvalues = [1]";
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
        (values, "from = 1", &["s.toml:", "from, to and count"]),
        (values, both, &["either"]),
        ("scenario = \"cusps\"\n", "", &["scenario", "is missing"]),
        (
            "\"t\"",
            r#""t\u001b]0;P\u0007""#,
            &[
                "s.toml:1: title (",
                "control, direction or invisible characters (here U+001B)",
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
        ground.refused("check s.toml", 1, words);
        assert_rejected(&ground, "s.toml", "out.csv", words);
    }
    // The file contains the scenario.
    let inside = "[scenario]\ntitle = \"x\"\n[scenario.start]\nmomentum_Js = [0, 0, 1]\n[scenario.motion]\ntime_step_s = 0.1\nsteps = 0\n";
    let text = format!("{}{inside}", good.replace("scenario = \"cusps\"\n", ""));
    ground.write("s.toml", &text);
    let words = ["s.toml:12:", "scenario.motion.steps (0)"];
    ground.refused("check s.toml", 1, &words);
}

/// A sweep over the scheme whose rk4 runs break down.
const SOME_ROWS_FAIL: &str = "method-2 --set motion.steps=40 --vary motion.scheme=report,rk4";

#[test]
fn a_failed_point_has_an_empty_row_and_a_reported_reason() {
    let ground = Ground::new();
    let args =
        format!("{SOME_ROWS_FAIL} --vary=body.rim.height_m=0.5,0,1e200 --measure=z_m,path,steps");
    let told = run_sweep(&ground, &args, "out.csv");
    let csv = ground.read("out.csv");
    let rows = rows(&csv);
    assert!(rows[1].starts_with("report,0.5,0.8"), "{csv}");
    let empty = [rows[3], rows[4], rows[6]];
    let wanted = ["report,1e200,,,,", "rk4,0.5,,,,", "rk4,1e200,,,,"];
    assert_eq!(empty, wanted, "{csv}");
    has_all(
        &told,
        [
            "rows without readouts: 3 of 6",
            "motion.scheme = \"rk4\", body.rim.height_m = 0.5: the numbers are no longer finite",
        ],
    );
    let of_height = told.matches("body.rim.height_m = 1e200").count();
    assert_eq!(of_height, 2, "{told}");
    run_sweep(&ground, "out.csv", "again.csv");
    assert_eq!(csv, ground.read("again.csv"));
}

/// The file does not say why a row is empty, so commands name the point of the row.
#[test]
fn every_command_reports_the_rows_without_readouts() {
    let ground = Ground::new();
    let args = &format!("{SOME_ROWS_FAIL} --vary=body.rim.height_m=0.5,1e200 --measure=z_m");
    let is_told = |told: &str| {
        has_all(
            told,
            [
                "gyrolab: rows without readouts: 3 of 4\n",
                "motion.scheme = \"rk4\", body.rim.height_m = 0.5: ",
                "motion.scheme = \"report\", body.rim.height_m = 1e200: ",
                "motion.scheme = \"rk4\", body.rim.height_m = 1e200: ",
            ],
        );
    };
    let told = run_sweep(&ground, args, "whole.csv");
    is_told(&told);
    has(&told, "0.5: the numbers are no longer finite");
    let whole = ground.read("whole.csv");
    // A complete file, and files that end after their second row or before their last.
    is_told(&run_sweep(&ground, args, "whole.csv"));
    for (kept, empty) in [(2, 1), (3, 2)] {
        let lost = rows(&whole)
            .into_iter()
            .skip(1 + kept)
            .map(|row| row.len() + 1);
        ground.write("cut.csv.part", &whole[..whole.len() - lost.sum::<usize>()]);
        let continued = run_sweep(&ground, args, "cut.csv");
        has(
            &continued,
            format!(
                "continuing after {kept} of 4 rows in cut.csv.part, {empty} of them without readouts\n"
            ),
        );
        is_told(&continued);
        assert_eq!(ground.read("cut.csv"), whole);
        remove(&ground, "cut.csv");
    }
    // Joined shards, and the same once the joined file is complete.
    run_shards(&ground, args, 2);
    for _ in 0..2 {
        is_told(&run_sweep(&ground, "--join 1.csv 2.csv", "joined.csv"));
    }
    assert_eq!(ground.read("joined.csv"), whole);
}

#[test]
fn varying_the_time_step_keeps_durations_in_seconds() {
    let ground = Ground::new();
    let args = "wobble-push --vary motion.time_step_s=0.1,0.05,0.2,500 --measure t_s,steps,measured_lowest_z_m";
    let told = run_sweep(&ground, args, "out.csv");
    has(&told, "not be longer than the whole run, 230 s");
    let csv = ground.read("out.csv");
    let rows = rows(&csv);
    let beginnings = ["0.1,230.0,2300,", "0.05,230.0,4600,", "0.2,230.0,1150,"];
    for (row, beginning) in rows[1..].iter().zip(beginnings) {
        assert!(row.starts_with(beginning), "{csv}");
    }
    // The push lasts 20 s, as with `run --time-step`.
    let json = ground.json("run wobble-push --time-step 0.05 --json");
    let lowest = json["measured_lowest_z_m"].as_f64().unwrap();
    assert!(rows[2].contains(&format!(",{lowest},")), "{csv} {lowest}");
    // An accumulating push depends on the time step.
    let accumulating = "wobble-push-accumulating --vary motion.time_step_s=0.1,0.05 --measure t_s";
    let of_one = run_sweep(&ground, accumulating, "acc.csv");
    has_all(of_one, ["rows without readouts: 1 of 2", "accumulates"]);
}

#[test]
fn ctrl_c_keeps_the_finished_rows() {
    let ground = Ground::new();
    let args =
        "cusps --set motion.steps=2000 --vary start.momentum_Js.2=20..400:100000 --measure z_m";
    let mut command = ground.command(&sweep_command(args, "out.csv"));
    let child = command.stderr(Stdio::piped()).spawn().unwrap();
    let part = ground.file("out.csv.part");
    while fs::read_to_string(&part).map_or(0, |text| rows(&text).len()) < 3 {
        sleep(Duration::from_millis(5));
    }
    signal(child.id(), "INT");
    let output = child.wait_with_output().unwrap();
    let text = fs::read_to_string(&part).unwrap();
    assert!(text.ends_with('\n'));
    let kept = format!("{} of 100000 rows", rows(&text).len() - 1);
    let words = ["rows are in", "out.csv.part", "to continue", &kept];
    refused(args, &output, 130, &words);
}

#[test]
fn a_full_disk_or_unwritable_folder_fails_a_sweep() {
    let ground = Ground::new();
    let grid = "\"$G\" sweep cusps --set motion.steps=2 --vary start.momentum_Js.2=10..400:2000 --measure z_m,x_m,y_m";
    let full = ground.shell(&format!("ulimit -f 40; {grid} -o out.csv"));
    let words = [
        "out.csv.part",
        "large",
        "of 2000 rows are in",
        "to continue",
    ];
    refused("a full disk", &full, 1, &words);
    // With space available again, the same command continues; no row is lost or repeated.
    let told = successful(&ground.shell(&format!("{grid} -o out.csv")));
    has(&told, "continuing after");
    successful(&ground.shell(&format!("{grid} -o whole.csv")));
    assert_eq!(ground.read("out.csv"), ground.read("whole.csv"));
    fs::create_dir(ground.file("folder")).unwrap();
    symlink("/dev/full", ground.file("link.csv.part")).unwrap();
    let args = "cusps --vary motion.steps=1,2 --measure=z_m";
    let advice = "name a file in a folder that exists";
    for (output, reasons) in [
        ("none/out.csv", &["none/out.csv", "there is no folder"][..]),
        ("folder", &["folder", "is a folder"]),
        ("folder/", &["folder", "is a folder"]),
        ("/dev/null", &["/dev/null", "not a regular file"]),
        ("/dev/full", &["/dev/full", "not a regular file"]),
        ("link.csv", &["link.csv", "not a regular file"]),
        ("/proc/out.csv", &["/proc/out.csv", "cannot write", advice]),
        ("-", &["-", "not written to stdout"]),
    ] {
        assert_rejected(&ground, args, output, reasons);
    }
    let files = ["folder", "link.csv.part", "out.csv", "whole.csv"];
    assert_eq!(ground.files(), files);
    // Joining writes the whole file at once.
    run_shards(&ground, args, 1);
    assert_rejected(&ground, "--join 1.csv", "/proc/out.csv", &[advice]);
}

#[test]
fn only_complete_shards_of_one_sweep_are_joined() {
    let ground = Ground::new();
    run_shards(&ground, GRID, 3);
    let other = GRID.replace("steps=400", "steps=300");
    run_sweep(&ground, &format!("{GRID} --shard 2/4"), "of-4.csv");
    run_sweep(&ground, &format!("{other} --shard 3/3"), "other.csv");
    let text = ground.read("3.csv");
    ground.write("torn.csv", &text[..text.len() - 1]);
    let last = text.lines().last().unwrap();
    ground.write("twice.csv", &format!("{text}{last}\n"));
    ground.write("changed.csv", &text.replace(",exact,", ",rk4,"));
    for (parts, words) in [
        ("1.csv 3.csv", &["3 shards", "missing: 2"][..]),
        ("1.csv", &["missing: 2, 3"]),
        (
            "1.csv 2.csv 3.csv 2.csv",
            &["2.csv", "shard 2/3", "so is another"],
        ),
        (
            "1.csv 2.csv of-4.csv",
            &["of-4.csv", "shard 2/4", "one of 3"],
        ),
        (
            "1.csv 2.csv other.csv",
            &["other.csv", "steps = 300", "steps = 400"],
        ),
        (
            "1.csv 2.csv torn.csv",
            &["torn.csv", "is not row 20 of 20", "again"],
        ),
        (
            "1.csv 2.csv twice.csv",
            &["twice.csv", "more than the rows"],
        ),
        (
            "1.csv 2.csv changed.csv",
            &["changed.csv", "is not row 2 of 20"],
        ),
        ("1.csv 2.csv none.csv", &["none.csv"]),
    ] {
        assert_rejected(&ground, &format!("--join {parts}"), "joined.csv", words);
        assert!(!ground.file("joined.csv").exists(), "{parts}");
    }
    run_sweep(&ground, "--join 3.csv 1.csv 2.csv", "joined.csv");
    run_sweep(&ground, GRID, "whole.csv");
    assert_eq!(ground.read("joined.csv"), ground.read("whole.csv"));
}

#[test]
fn the_shipped_sweeps_are_listed_and_printed() {
    let ground = Ground::new();
    let list = ground.stdout("sweep");
    for name in [
        "wobble-over-time-step",
        "precession-over-momentum",
        "precession-over-tilt",
    ] {
        has(&list, format!("{name}: "));
        ground.write("mine.toml", &ground.stdout(&format!("presets {name}")));
        ground.stdout("check mine.toml");
    }
}

/// A terminal shows progress before the first row, without an invented rate or time left.
#[test]
fn progress_is_shown_from_the_beginning() {
    let args = "cusps --vary start.tilt_deg=10..40:1000 --set motion.steps=100000000 --measure=z_m";
    let mut terminal = Ground::new().open(&sweep_command(args, "slow.csv"));
    terminal.wait_for("row 0 of 1,000");
    let text = terminal.sent_text();
    assert!(!text.contains("left") && !text.contains("/s"), "{text}");
    terminal.press("\u{3}");
    assert_eq!(terminal.wait_for_end().exit_code(), 130);
}

/// A program that asks for it gets the progress as lines. Rows of an earlier command count.
#[test]
fn the_progress_of_a_resumed_sweep_counts_the_whole() {
    let ground = Ground::new();
    let args = "cusps --set=motion.steps=2 --vary=start.tilt_deg=10,20,30 --measure=z_m";
    run_sweep(&ground, args, "out.csv");
    let whole = ground.read("out.csv");
    let begun: Vec<&str> = whole.split_inclusive('\n').collect();
    ground.write("out.csv.part", &begun[..begun.len() - 2].concat());
    remove(&ground, "out.csv");
    let mut command = ground.command(&sweep_command(args, "out.csv"));
    let told = successful(&command.env("GYROLAB_PROGRESS", "lines").output().unwrap());
    has(&told, "\rrow 1 of 3\n\r\n");
    assert_eq!(ground.read("out.csv"), whole);
}

#[test]
fn a_value_may_be_an_empty_string() {
    let ground = Ground::new();
    let args = "cusps --set=motion.steps=2 --vary 'about=\"\",x,\"a,b\"' --measure=z_m";
    run_sweep(&ground, args, "out.csv");
    has(
        run_sweep(&ground, args, "out.csv"),
        "out.csv is complete: 3 rows",
    );
    ground.stdout("verify out.csv");
    run_shards(&ground, args, 2);
    run_sweep(&ground, "--join 1.csv 2.csv", "joined.csv");
    assert_eq!(ground.read("joined.csv"), ground.read("out.csv"));
}

/// The message begins with the shortened difference between the sweeps, and does not alter the users' own words.
#[test]
fn a_different_sweep_is_identified_by_the_first_differing_line() {
    let ground = Ground::new();
    for (title, shard) in [("a top here and there", 1), ("a top", 2)] {
        let args = format!(
            "cusps --set=motion.steps=2 '--set=title={title}' --vary=start.momentum_Js.2=10..400:4 --measure=z_m --shard {shard}/2"
        );
        run_sweep(&ground, &args, &format!("{shard}.csv"));
    }
    let words = "2.csv: is no shard of the sweep of 1.csv: its line 2 is";
    let words = [words, "a top\"", "a top here and there"];
    assert_rejected(&ground, "--join 1.csv 2.csv", "joined.csv", &words);
    let vary = "cusps --set=motion.steps=2 --vary start.momentum_Js.2";
    run_sweep(&ground, &format!("{vary}=10,20,30"), "all.csv");
    for (more, reason) in [
        ("=10,20,30 --measure=steps,z_m", "measure"),
        (
            "=10,21,30",
            "is \"# values = [10, 20, 30]\", not \"# values = [10, 21, 30]\"; --force replaces it\n",
        ),
    ] {
        let output = ground.run(&sweep_command(&format!("{vary}{more}"), "all.csv"));
        refused(more, &output, 1, &[reason]);
        assert!(output.stderr.len() < 300, "{output:?}");
    }
}

#[test]
fn a_symbolic_link_is_kept_and_its_target_replaced() {
    let ground = Ground::new();
    let args = "cusps --measure=z_m --vary=motion.steps=2,3";
    fs::create_dir(ground.file("deep")).unwrap();
    ground.write("deep/mine.csv", "mine\n");
    symlink("deep/mine.csv", ground.file("link.csv")).unwrap();
    assert_rejected(&ground, args, "link.csv", &["link.csv", "--force"]);
    let told = run_sweep(&ground, &format!("{args} --force"), "link.csv");
    has(&told, "gyrolab: 2 rows in link.csv\n");
    assert!(ground.file("link.csv").is_symlink());
    assert_eq!(rows(&ground.read("deep/mine.csv")).len(), 3);
    assert_eq!(ground.files(), ["deep", "link.csv"]);
    assert_eq!(names(&ground.file("deep")), ["mine.csv"]);
}

#[test]
fn joining_works_with_more_shards_than_open_files_allowed() {
    let ground = Ground::new();
    let grid =
        "cusps --set motion.steps=2 --vary start.momentum_Js.2=10..400:200 --measure z_m,x_m,y_m";
    run_sweep(&ground, grid, "whole.csv");
    let whole = ground.read("whole.csv");
    let (header, all) = whole.split_at(whole.find("start.momentum_Js.2,z_m").unwrap());
    let all: Vec<&str> = all.split_inclusive('\n').collect();
    const OF: usize = 150;
    run_sweep(&ground, &format!("{grid} --shard 1/{OF}"), "1.csv");
    let first = ground.read("1.csv");
    let of_first = &first[..first.find("start.momentum_Js.2,z_m").unwrap()];
    assert_ne!(of_first, header);
    for number in 1..=OF {
        let of_number = of_first.replace(&format!("\"1/{OF}\""), &format!("\"{number}/{OF}\""));
        let [begin, end] = [number - 1, number].map(|number| 1 + 200 * number / OF);
        let rows = all[begin..end].concat();
        ground.write(&format!("{number}.csv"), &(of_number + all[0] + &rows));
    }
    assert_eq!(ground.read("1.csv"), first);
    let parts: Vec<String> = (1..=OF).map(|number| format!("{number}.csv")).collect();
    let join = sweep_command(&format!("--join {}", parts.join(" ")), "joined.csv");
    successful(&ground.shell(&format!("ulimit -n 64; \"$G\" {join}")));
    assert_eq!(ground.read("joined.csv"), whole);
}

#[test]
fn options_set_the_length_of_every_run_of_a_sweep() {
    let ground = Ground::new();
    let steps = |args: &str| {
        let vary = "--vary start.tilt_deg=20,30 --measure t_s";
        ground.stderr(&format!("sweep cusps {vary} {args} -o out.csv --force"));
        let first = ground.read("out.csv");
        first
            .lines()
            .find(|line| line.contains("steps ="))
            .unwrap_or_default()
            .to_owned()
    };
    assert!(steps("--duration 0.25").ends_with("steps = 250"));
    assert!(steps("--steps 40").ends_with("steps = 40"));
    ground.refused(
        "sweep cusps --steps 4 --duration 1 -o out.csv",
        2,
        &["cannot be used with"],
    );
    ground.refused(
        "sweep -o out.csv",
        2,
        &["--output needs a sweep, a scenario, or --join"],
    );
}

#[test]
fn keys_vary_together_and_with_equal_ratios() {
    let ground = Ground::new();
    let args = "cusps --set motion.steps=20 --vary start.tilt_deg+start.momentum_Js.2=[10,20],[30,60] \
        --vary motion.time_step_s=0.0001..0.01:3:log --measure z_m";
    let told = run_sweep(&ground, args, "out.csv");
    has(&told, "gyrolab: reliable: ");
    let csv = ground.read("out.csv");
    let rows = rows(&csv);
    assert_eq!(
        rows[0],
        "start.tilt_deg,start.momentum_Js.2,motion.time_step_s,z_m,reliable"
    );
    let points: Vec<_> = rows[1..]
        .iter()
        .map(|row| row.splitn(4, ',').take(3).collect::<Vec<_>>().join(","))
        .collect();
    assert_eq!(points[..2], ["10.0,20.0,0.0001", "10.0,20.0,0.001"]);
    assert_eq!((points.len(), &*points[5]), (6, "30.0,60.0,0.01"));
    ground.stdout("verify out.csv");
    run_sweep(&ground, "out.csv", "again.csv");
    assert_eq!(ground.read("again.csv"), csv);
    let mistakes = [
        ("start.tilt_deg+start.tilt_deg=1,2", "varies"),
        ("motion.time_step_s=0..0.1:3:log", "above 0"),
        ("motion.time_step_s=0.01..0.1:3:lin", "A..B:N:log"),
        ("start.tilt_deg+start.tlt_deg=1,2", "start.tilt_deg"),
    ];
    for (vary, words) in mistakes {
        let wrong = format!("cusps --vary {vary} --measure z_m");
        assert_rejected(&ground, &wrong, "wrong.csv", &[words]);
    }
}

#[test]
fn a_figure_block_is_checked_and_sets_the_default_figure() {
    let ground = Ground::new();
    let file = |figure: &str| {
        format!(
            "scenario = \"cusps\"\nmeasure = [\"turns_per_step\", \"z_m\"]\n[figure]\n{figure}\n\
             [[vary]]\nkey = \"motion.time_step_s\"\nvalues = [0.1, 0.05]\n"
        )
    };
    ground.write("good.toml", &file("x = \"turns_per_step\"\ny = [\"z_m\"]"));
    run_sweep(&ground, "good.toml", "good.csv");
    ground.stdout("figure good.csv --text -o good.svg");
    has(ground.read("good.svg"), "turns per step");
    for (figure, word) in [
        ("x = \"turns\"", "turns_per_step"),
        ("kind = \"pie\"", "map"),
        ("log = \"q\"", "x, y, z"),
        ("x_range = [2, 1]", "lower one first"),
        ("colour = 1", "figure.colour"),
    ] {
        ground.write("bad.toml", &file(figure));
        ground.refused("check bad.toml", 1, &["bad.toml", word]);
    }
}
