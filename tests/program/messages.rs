//! Error messages on the command line: each quotes what the user typed and says what to do.

use crate::support::ground::{Ground, done, failed, refused, stderr};
use crate::support::pty::Terminal;
use crate::support::words::{has, has_no};

const PUSHED: &str = "[[push]]\npoint = \"top\"\nforce_N = [0, 0, 1]\n";

/// Writes a scenario to the file `name`: Method 2 with `more` appended.
fn scenario(ground: &Ground, name: &str, more: &str) {
    let method_2 = ground.stdout("presets method-2");
    ground.write(name, &format!("{method_2}\n{more}"));
}

#[test]
fn wrong_arguments_have_specific_messages() {
    let ground = Ground::new();
    let whole = "must be a whole number of steps, 1 or more";
    let no_number = "must be a number greater than zero";
    for (args, words) in [
        (
            "runn wobble-push",
            "there is no command runn: did you mean gyrolab run?",
        ),
        ("cusps --at -3", "must be a whole number of steps"),
        ("run cusps --steps 1e3", whole),
        ("run cusps --steps 0", whole),
        ("cusps --fps 100", "must be a whole number from 1 to 60"),
        ("run cusps --folder x", "--folder is for the lab"),
        ("show cusps --size 0x9", "80x24"),
        ("show cusps --size 1000x501", "1000x500"),
        ("run cusps --dt 0.1", "--time-step 0.05 holds the seconds"),
        (
            "figure cusps -o x.svg --kind measured_tilt_swing_deg",
            "is a readout, one number of a run, and no column",
        ),
        ("run cusps -o - --json", "Usage: gyrolab run"),
        // numbers with a unit
        ("figure method-2 --to 20s -o f.svg", "write 20, in seconds"),
        (
            "figure method-2 --from '2.5 s' -o f.svg",
            "write 2.5, in seconds",
        ),
        ("run method-2 --from 2s -o out.csv", "write 2, in seconds"),
        (
            "run method-2 --to 1e1sec -o out.csv",
            "write 1e1, in seconds",
        ),
        ("run method-2 --duration 20s", "write 20, in seconds"),
        (
            "run method-2 --duration 3min",
            "without a unit (min), in seconds",
        ),
        (
            "run method-2 --time-step 50ms",
            "without a unit (ms), in seconds",
        ),
        (
            "compare method-2 --time-steps 0.1,0.05s",
            "write 0.05, in seconds",
        ),
        (
            "show method-2 --at 20s",
            "without a unit (s), in time steps",
        ),
        (
            "run method-2 --steps 20s",
            "without a unit (s), in time steps",
        ),
        // Other text gets the general message.
        ("run method-2 --duration long", no_number),
        ("run method-2 --duration=-2s", no_number),
        ("run method-2 --duration inf", no_number),
    ] {
        let output = ground.run(args);
        refused(args, &output, 2, &[words]);
        let said = stderr(&output);
        for wrong in ["-- -3", "--force", "invalid digit", "9223372036854775807"] {
            let is_usage = said.contains("Usage: gyrolab run [OPTIONS]");
            assert!(is_usage || !said.contains(wrong), "{args}: {said}");
        }
    }
    assert_eq!(ground.files(), [""; 0]);
    // The British spelling of --color works too.
    done(ground.run("cusps --colour never"));
}

#[test]
fn errors_in_options_name_the_option_and_no_file() {
    let ground = Ground::new();
    for (option, words) in [
        (
            "--set motion.time_step=3",
            "motion.time_step: unknown key: did you mean motion.time_step_s?",
        ),
        (
            "--set push.1.force_N=[0,0,1]",
            "push.1 would be a new one, there is only push.0",
        ),
        (
            "--set 'push=[{point=\"top\", force_N=[0,50,0], from_s=10s}]'",
            "is not valid TOML at \"10s}]\"",
        ),
        ("--set body.rim.points=1", "a rim with 1 point"),
        (
            "--vary motion.steps=10,x",
            "motion.steps (\"x\") must be a whole number",
        ),
        (
            "--vary start.momentm=3",
            "unknown key: did you mean start.momentum_Js?",
        ),
        ("--vary body.rim.points=-1,2", "must be 1 or more"),
    ] {
        let (command, begin) = match option.strip_prefix("--vary ") {
            Some(vary) => (
                "sweep method-2 -o s.csv",
                format!("gyrolab: --vary {vary}: "),
            ),
            None => ("run wobble-push", "gyrolab: --set ".to_owned()),
        };
        let output = ground.run(&format!("{command} {option}"));
        failed(&output, &[&begin, words]);
        has_no(stderr(&output), "presets/");
    }
}

#[test]
fn files_are_judged_by_their_extensions() {
    let ground = Ground::new();
    for command in [
        "run cusps -o x.xlsx",
        "compare cusps -o x.XLS",
        "sweep wobble-over-time-step -o x.ods",
    ] {
        ground.refused(command, 1, &["let the name end in .csv"]);
    }
    ground.stderr("sweep method-2 --vary motion.steps=1,2 -o s.csv");
    ground.write("t.csv.part", &ground.read("s.csv"));
    let words = ["t.csv.part", "an unfinished sweep"];
    ground.refused("figure t.csv.part -o x.svg", 1, &words);
    // A page has room for only a few of all numbers.
    let too_many = "do not fit on a page: choose some with --kind";
    ground.refused("figure s.csv -o x.svg", 1, &[too_many]);
    done(ground.run("figure s.csv -o x.svg --kind z_m,tilt_deg"));
}

#[test]
fn a_time_step_longer_than_the_run_is_rejected() {
    let ground = Ground::new();
    let run = "run wobble-push --time-step";
    let begin = "gyrolab: --time-step 1000: ";
    let words = [begin, "longer than the whole run, 230 s"];
    ground.refused(&format!("{run} 1000"), 1, &words);
    has(ground.stdout(&format!("{run} 230")), "1 of 230 s");
}

#[test]
fn mistakes_in_command_files_are_reported_with_a_remedy() {
    let ground = Ground::new();
    for (text, words) in [
        (
            "[do]\nopen = 'cusps'\n[do]\nopen = 'loops'\n",
            "x.toml:3: [do] occurs a second time: write [[do]]",
        ),
        ("[[do]]\nrun_until = 't_s => 20'\n", "write >= for =>"),
        ("[[do]]\nrun_until = 't_s =< 20'\n", "write <= for =<"),
    ] {
        ground.write("x.toml", text);
        ground.refused("check x.toml", 1, &[words]);
    }
    let missing = ground.run("--do nofile");
    failed(&missing, &["nofile: cannot be read"]);
    has_no(stderr(&missing), "is printed");
}

#[test]
fn a_push_that_never_acts_is_reported() {
    let ground = Ground::new();
    let never = "push.0 never acts: it begins at";
    for (push, words) in [
        (
            "first_step = 100000\nsteps = 5\n",
            Some("step 100000, and the run ends at step 2300"),
        ),
        ("from_s = 230\nfor_s = 5\n", Some("230 s")),
        ("first_step = 2300\nsteps = 5\n", None),
    ] {
        scenario(&ground, "mine.toml", &format!("{PUSHED}{push}"));
        let said = ground.stdout("check mine.toml");
        match words {
            Some(words) => has(&said, format!("{never} {words}")),
            None => has_no(&said, "never"),
        }
    }
}

#[test]
fn the_summary_lists_every_time_step_of_a_run() {
    let ground = Ground::new();
    let edit = "[[edit]]\nstep = 40\nset = { \"motion.time_step_s\" = 0.05 }\n";
    scenario(&ground, "mine.toml", edit);
    let words = "2300: 40 of 0.1 s, then 2260 of 0.05 s";
    has(ground.stdout("check mine.toml"), words);
    has(ground.stdout("run mine.toml"), words);
    has(ground.stdout("run mine.toml --steps 40"), "  40 of 0.1 s");
}

#[test]
fn the_message_about_a_written_file_counts_its_rows() {
    let ground = Ground::new();
    let said = ground.stderr("run cusps --every 100 -o x.csv");
    assert_eq!(said.lines().last(), Some("gyrolab: 101 rows in x.csv"));
    has_no(ground.stderr("run cusps --steps 3 -o -"), "rows in");
}

#[test]
fn a_missing_precession_rate_is_explained() {
    let words = "none in this run: the axle passes through the vertical";
    has(Ground::new().stdout("run method-1"), words);
}

const NO_COLOR: [(&str, &str); 3] = [("TERM", "xterm"), ("LANG", "C.UTF-8"), ("NO_COLOR", "1")];

/// Opens the lab with NO_COLOR set.
fn without_colors(ground: &Ground) -> Terminal {
    let lab = ground.open_with("method-2 --paused", &NO_COLOR);
    lab.wait_for("L lessons");
    lab
}

#[test]
fn colors_turned_off_and_on_again_are_not_remembered() {
    let ground = Ground::new();
    let has_kept = |choice: &str| {
        let settings = ground.read("state/gyrolab/settings.toml");
        has(settings, format!("color = \"{choice}\""));
    };
    let is_colored = |lab: &Terminal| lab.sent_text().contains("\u{1b}[38;");
    let mut lab = ground.open("method-2 --paused");
    lab.wait_for("L lessons");
    lab.ask("c\x1b[B\x1b[B\x1b[B\x1b[B\x1b[D", "colors off");
    lab.ask("\x1b[C", "colors 16");
    lab.ask("\x1b", "L lessons");
    lab.quit();
    has_kept("auto");
    let mut plain = without_colors(&ground);
    assert!(!is_colored(&plain));
    // Remembered settings do not override NO_COLOR either; the user's own file does.
    plain.ask("c\x1b[B\x1b[B\x1b[B\x1b[B\r", "colors 16");
    plain.ask("\x1b", "L lessons");
    plain.quit();
    has_kept("16");
    let mut again = without_colors(&ground);
    assert!(!is_colored(&again));
    again.quit();
    std::fs::create_dir_all(ground.config().join("gyrolab")).unwrap();
    ground.write("config/gyrolab/config.toml", "colour = 'always'\n");
    let mut colored = without_colors(&ground);
    assert!(is_colored(&colored));
    colored.quit();
}

#[test]
fn errors_precede_the_message_about_the_printed_picture() {
    let ground = Ground::new();
    for (args, words) in [
        ("method2", "did you mean method-2?"),
        ("nothing.toml", "nothing.toml"),
        ("method-2 --set motion.steps=0", "motion.steps"),
        ("method-2 --measured no.csv", "no.csv"),
        ("method-2 --do no.toml", "no.toml"),
    ] {
        let output = ground.run(args);
        refused(args, &output, 1, &[words]);
        has_no(stderr(&output), "picture");
    }
}

#[test]
fn a_scenario_given_as_measured_data_is_reported_once() {
    let ground = Ground::new();
    ground.write("own.toml", &ground.stdout("presets wobble-push"));
    for args in [
        "fit own.toml --in method-2 --free start.tilt_deg",
        "show method-2 --measured own.toml",
        "figure method-2 --measured own.toml -o f.svg",
    ] {
        let output = ground.run(args);
        failed(&output, &["own.toml: is a scenario, not measured data"]);
        assert_eq!(stderr(&output).lines().count(), 1, "{args}");
    }
    // For a table that is not a scenario, the message still names the row.
    ground.write("bad.csv", "t_s,tilt_deg\n0,1\n1,2,3\n");
    let output = ground.run("show method-2 --measured bad.csv");
    has(stderr(&output), "bad.csv:3: this row");
}
