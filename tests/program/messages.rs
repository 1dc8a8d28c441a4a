//! What the program says where something is wrong: each message names what the user typed, and what to do.

use crate::support::ground::{Ground, code, done, failed, stderr, stdout};
use crate::support::pty::Terminal;

const PUSHED: &str = "[[push]]\npoint = \"top\"\nforce_N = [0, 0, 1]\n";

/// A scenario of its own in the file `name`: Method 2 with `more` at its end.
fn scenario(ground: &Ground, name: &str, more: &str) {
    let method_2 = done(ground.run(&["presets", "method-2"]));
    ground.write(name, &format!("{}\n{more}", stdout(&method_2)));
}

#[test]
fn wrong_arguments_are_told_in_words() {
    let ground = Ground::new();
    for (args, words) in [
        (
            &["runn", "wobble-push"][..],
            "there is no command runn: did you mean gyrolab run?",
        ),
        (&["cusps", "--at", "-3"], "must be a whole number of steps"),
        (
            &["run", "cusps", "--steps", "1e3"],
            "must be a whole number of steps, 1 or more",
        ),
        (
            &["run", "cusps", "--steps", "0"],
            "must be a whole number of steps, 1 or more",
        ),
        (
            &["cusps", "--fps", "100"],
            "must be a whole number from 1 to 60",
        ),
        (
            &["run", "cusps", "--folder", "x"],
            "--folder is for the lab",
        ),
        (
            &["run", "cusps", "--dt", "0.1"],
            "--time-step 0.05 holds the seconds",
        ),
        (
            &[
                "figure",
                "cusps",
                "-o",
                "x.svg",
                "--kind",
                "measured_tilt_swing_deg",
            ],
            "is a readout, one number of a run, and no column",
        ),
        (&["run", "cusps", "-o", "-", "--json"], "Usage: gyrolab run"),
    ] {
        let output = ground.run(args);
        let said = stderr(&output);
        assert_eq!(code(&output), 2, "{args:?}: {said}");
        assert!(said.contains(words), "{args:?}: {said}");
        for wrong in ["-- -3", "--force", "invalid digit", "9223372036854775807"] {
            let is_usage = said.contains("Usage: gyrolab run [OPTIONS]");
            assert!(is_usage || !said.contains(wrong), "{args:?}: {said}");
        }
    }
    // The colour of the British is an option too.
    done(ground.run(&["cusps", "--colour", "never"]));
}

#[test]
fn a_wrong_setting_is_named_without_a_file_that_nobody_named() {
    let ground = Ground::new();
    for (set, words) in [
        (
            "motion.time_step=3",
            "motion.time_step: unknown key: did you mean motion.time_step_s?",
        ),
        (
            "push.1.force_N=[0,0,1]",
            "push.1 would be a new one, there is only push.0",
        ),
        (
            "push=[{point=\"top\", force_N=[0,50,0], from_s=10s}]",
            "is no TOML: at \"10s}]\"",
        ),
        ("body.rim.points=1", "the rim has 1 point"),
    ] {
        let output = ground.run(&["run", "wobble-push", "--set", set]);
        failed(&output, &["gyrolab: --set ", words]);
        let said = stderr(&output);
        assert!(!said.contains("presets/"), "{said}");
    }
}

#[test]
fn what_is_wrong_with_a_sweep_names_its_argument() {
    let ground = Ground::new();
    for (vary, words) in [
        (
            "motion.steps=10,x",
            "motion.steps (\"x\") must be a whole number",
        ),
        (
            "start.momentm=3",
            "unknown key: did you mean start.momentum_Js?",
        ),
        ("body.rim.points=-1,2", "must be 1 or more"),
    ] {
        let output = ground.run(&["sweep", "method-2", "-o", "s.csv", "--vary", vary]);
        failed(&output, &[&format!("gyrolab: --vary {vary}: "), words]);
        let said = stderr(&output);
        assert!(!said.contains("presets/"), "{said}");
    }
}

#[test]
fn a_file_is_what_its_name_says() {
    let ground = Ground::new();
    for command in [
        &["run", "cusps", "-o", "x.xlsx"][..],
        &["compare", "cusps", "-o", "x.XLS"],
        &["sweep", "wobble-over-time-step", "-o", "x.ods"],
    ] {
        failed(&ground.run(command), &["let the name end in .csv"]);
    }
    let args = ["method-2", "--vary", "motion.steps=1,2", "-o", "s.csv"];
    done(ground.run(&[&["sweep"][..], &args].concat()));
    let whole = ground.read("s.csv");
    ground.write("t.csv.part", &whole);
    failed(
        &ground.run(&["figure", "t.csv.part", "-o", "x.svg"]),
        &["t.csv.part", "a sweep that is not whole yet"],
    );
    // Every number there is, of which a page holds a few.
    failed(
        &ground.run(&["figure", "s.csv", "-o", "x.svg"]),
        &["do not fit on a page: choose some with --kind"],
    );
    let chosen = ["figure", "s.csv", "-o", "x.svg", "--kind", "z_m,tilt_deg"];
    done(ground.run(&chosen));
}

#[test]
fn a_time_step_longer_than_the_run_is_refused() {
    let ground = Ground::new();
    let args = ["run", "wobble-push", "--time-step"];
    let longer = ground.run(&[&args[..], &["1000"]].concat());
    failed(
        &longer,
        &[
            "gyrolab: --time-step 1000: ",
            "longer than the whole run, 230 s",
        ],
    );
    let whole = done(ground.run(&[&args[..], &["230"]].concat()));
    assert!(stdout(&whole).contains("1 of 230 s"));
}

#[test]
fn mistakes_in_files_of_commands_are_told_with_the_remedy() {
    let ground = Ground::new();
    for (text, words) in [
        (
            "[do]\nopen = 'cusps'\n[do]\nopen = 'loops'\n",
            "x.toml:3: [do] stands here again: write [[do]]",
        ),
        ("[[do]]\nrun_until = 't_s => 20'\n", "write >= for =>"),
        ("[[do]]\nrun_until = 't_s =< 20'\n", "write <= for =<"),
    ] {
        ground.write("x.toml", text);
        failed(&ground.run(&["check", "x.toml"]), &[words]);
    }
    let missing = ground.run(&["--do", "nofile"]);
    failed(&missing, &["nofile: cannot be read"]);
    assert!(!stderr(&missing).contains("is printed"), "{missing:?}");
}

#[test]
fn a_push_that_never_acts_is_told() {
    let ground = Ground::new();
    let in_steps = format!("{PUSHED}first_step = 100000\nsteps = 5\n");
    scenario(&ground, "steps.toml", &in_steps);
    let checked = done(ground.run(&["check", "steps.toml"]));
    let said = stdout(&checked);
    assert!(
        said.contains("push.0 never acts: it begins at step 100000, and the run ends at step 2300"),
        "{said}"
    );
    let in_seconds = format!("{PUSHED}from_s = 230\nfor_s = 5\n");
    scenario(&ground, "seconds.toml", &in_seconds);
    let checked = done(ground.run(&["check", "seconds.toml"]));
    assert!(stdout(&checked).contains("push.0 never acts: it begins at 230 s"));
    let that_acts = format!("{PUSHED}first_step = 2300\nsteps = 5\n");
    scenario(&ground, "acts.toml", &that_acts);
    let checked = done(ground.run(&["check", "acts.toml"]));
    assert!(!stdout(&checked).contains("never"));
}

#[test]
fn every_time_step_of_a_run_is_told() {
    let ground = Ground::new();
    let edit = "[[edit]]\nstep = 40\nset = { \"motion.time_step_s\" = 0.05 }\n";
    scenario(&ground, "mine.toml", edit);
    let words = "2300: 40 of 0.1 s, then 2260 of 0.05 s";
    let checked = done(ground.run(&["check", "mine.toml"]));
    assert!(stdout(&checked).contains(words), "{checked:?}");
    let summary = done(ground.run(&["run", "mine.toml"]));
    assert!(stdout(&summary).contains(words), "{summary:?}");
    let short = done(ground.run(&["run", "mine.toml", "--steps", "40"]));
    assert!(stdout(&short).contains("  40 of 0.1 s"), "{short:?}");
}

#[test]
fn a_written_file_is_named_with_its_rows() {
    let ground = Ground::new();
    let output = done(ground.run(&["run", "cusps", "--every", "100", "-o", "x.csv"]));
    let last = stderr(&output).lines().last().unwrap_or_default();
    assert_eq!(last, "gyrolab: 101 rows in x.csv");
    let piped = done(ground.run(&["run", "cusps", "--steps", "3", "-o", "-"]));
    assert!(!stderr(&piped).contains("rows in"));
}

#[test]
fn a_precession_that_there_is_not_is_told_why() {
    let ground = Ground::new();
    let summary = done(ground.run(&["run", "method-1"]));
    let said = stdout(&summary);
    assert!(
        said.contains("none measured: the axle passes through the vertical"),
        "{said}"
    );
}

#[test]
fn the_manual_has_the_keys_of_the_lab_and_the_values_of_options() {
    let ground = Ground::new();
    let manual = done(ground.run(&["man"]));
    let manual = stdout(&manual);
    let keys = manual.find("KEYS IN THE LAB").unwrap();
    for key in ["\n  space\n", "\n  d\n", "\n  f\n"] {
        assert!(manual[keys..].contains(key), "{key}");
    }
    for option in ["--at <STEP>", "--resume [<NAME>]", "-o, --output <FILE>"] {
        assert!(manual.contains(option), "{option}");
    }
    let help = done(ground.run(&["keys", "--help"]));
    assert!(
        stdout(&help)
            .contains("scenario or run file may hold; the keys to press are in gyrolab man")
    );
}

const NO_COLOR: [(&str, &str); 3] = [("TERM", "xterm"), ("LANG", "C.UTF-8"), ("NO_COLOR", "1")];

fn open(ground: &Ground) -> Terminal {
    let lab = ground.open(&["method-2", "--paused"]);
    lab.wait_for("q quit");
    lab
}

#[test]
fn colours_that_were_turned_off_and_on_again_are_no_choice() {
    let ground = Ground::new();
    let mut lab = open(&ground);
    lab.ask("c\x1b[B\x1b[B\x1b[B\x1b[B\r", "colours off");
    lab.ask("\r", "colours on");
    lab.ask("\x1b", "q quit");
    lab.quit();
    assert!(
        ground
            .read("state/gyrolab/settings.toml")
            .contains("colour = \"auto\"")
    );
    let mut lab = ground.open_with(&["method-2", "--paused"], &NO_COLOR);
    lab.wait_for("q quit");
    assert!(!lab.sent_text().contains("\u{1b}[38;"));
    // What is remembered does not win over NO_COLOR either; the user's own file does.
    lab.ask("c\x1b[B\x1b[B\x1b[B\x1b[B\r", "colours on");
    lab.ask("\x1b", "q quit");
    lab.quit();
    assert!(
        ground
            .read("state/gyrolab/settings.toml")
            .contains("colour = \"always\"")
    );
    let mut lab = ground.open_with(&["method-2", "--paused"], &NO_COLOR);
    lab.wait_for("q quit");
    assert!(!lab.sent_text().contains("\u{1b}[38;"));
    lab.quit();
    std::fs::create_dir_all(ground.config().join("gyrolab")).unwrap();
    ground.write("config/gyrolab/config.toml", "colour = 'always'\n");
    let mut lab = ground.open_with(&["method-2", "--paused"], &NO_COLOR);
    lab.wait_for("q quit");
    assert!(lab.sent_text().contains("\u{1b}[38;"));
    lab.quit();
}

#[test]
fn a_number_with_a_unit_is_told_without_it() {
    let ground = Ground::new();
    let out = ["-o", "out.csv"];
    for (args, words) in [
        (
            &["figure", "method-2", "--to", "20s", "-o", "f.svg"][..],
            "write 20, in seconds",
        ),
        (
            &["figure", "method-2", "--from", "2.5 s", "-o", "f.svg"],
            "write 2.5, in seconds",
        ),
        (
            &[&["run", "method-2", "--from", "2s"], &out[..]].concat(),
            "write 2, in seconds",
        ),
        (
            &[&["run", "method-2", "--to", "1e1sec"], &out[..]].concat(),
            "write 1e1, in seconds",
        ),
        (
            &["run", "method-2", "--duration", "20s"],
            "write 20, in seconds",
        ),
        (
            &["run", "method-2", "--duration", "3min"],
            "without a unit (min), in seconds",
        ),
        (
            &["run", "method-2", "--time-step", "50ms"],
            "without a unit (ms), in seconds",
        ),
        (
            &["compare", "method-2", "--time-steps", "0.1,0.05s"],
            "write 0.05, in seconds",
        ),
        (
            &["show", "method-2", "--at", "20s"],
            "without a unit (s), in time steps",
        ),
        (
            &["run", "method-2", "--steps", "20s"],
            "without a unit (s), in time steps",
        ),
        // What is no number is told as before.
        (
            &["run", "method-2", "--duration", "long"],
            "must be a number greater than zero",
        ),
        (
            &["run", "method-2", "--duration=-2s"],
            "must be a number greater than zero",
        ),
        (
            &["run", "method-2", "--duration", "inf"],
            "must be a number greater than zero",
        ),
    ] {
        let output = ground.run(args);
        let told = stderr(&output);
        assert_eq!(code(&output), 2, "{args:?}: {told}");
        assert!(told.contains(words), "{args:?}: {told}");
    }
    assert_eq!(ground.files(), [""; 0]);
}

#[test]
fn what_is_not_there_is_refused_before_a_picture_is_promised() {
    let ground = Ground::new();
    for (args, words) in [
        (&["method2"][..], "did you mean method-2?"),
        (&["nothing.toml"], "nothing.toml"),
        (&["method-2", "--set", "motion.steps=0"], "motion.steps"),
        (&["method-2", "--measured", "no.csv"], "no.csv"),
        (&["method-2", "--do", "no.toml"], "no.toml"),
    ] {
        let output = ground.run(args);
        let told = stderr(&output);
        assert_eq!(code(&output), 1, "{args:?}: {told}");
        assert!(told.contains(words) && !told.contains("picture"), "{told}");
    }
}

#[test]
fn a_scenario_given_as_measured_data_is_told_once() {
    let ground = Ground::new();
    let preset = ground.run(&["presets", "wobble-push"]);
    ground.write("own.toml", &String::from_utf8(preset.stdout).unwrap());
    for args in [
        &[
            "fit",
            "own.toml",
            "--in",
            "method-2",
            "--free",
            "start.tilt_deg",
        ][..],
        &["show", "method-2", "--measured", "own.toml"],
        &[
            "figure",
            "method-2",
            "--measured",
            "own.toml",
            "-o",
            "f.svg",
        ],
    ] {
        let output = ground.run(args);
        let told = stderr(&output);
        assert_eq!((code(&output), told.lines().count()), (1, 1), "{told}");
        assert!(
            told.contains("own.toml: is a scenario, and no measured data"),
            "{told}"
        );
    }
    // A table of numbers that is no scenario is told its rows as before.
    ground.write("bad.csv", "t_s,tilt_deg\n0,1\n1,2,3\n");
    let output = ground.run(&["show", "method-2", "--measured", "bad.csv"]);
    assert!(stderr(&output).contains("bad.csv:3: this row"));
}
