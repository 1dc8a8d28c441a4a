//! `--do` and `check` with command files, in the real program.

use crate::support::ground::{Ground, done, failed, stderr, stdout};
use crate::support::words::{has, has_all, has_no};
use std::fs;
use std::process::Stdio;

const DEMO: &str = "[[do]]\nopen = \"method-2\"\n[[do]]\nset = { \"motion.time_step_s\" = 0.05 }\n[[do]]\nwait_s = 3600\n\
    [[do]]\nrun_until = \"t_s >= 30\"\n[[do]]\nexact = true\n";

#[test]
fn show_prints_the_picture_after_the_commands() {
    let ground = Ground::new();
    ground.write("demo.toml", DEMO);
    let output = done(ground.run("show --do demo.toml"));
    assert_eq!(stderr(&output), "");
    let picture = stdout(&output);
    has_all(picture, ["step  600 of", "dt 0.05 s"]);
    assert_eq!(ground.stdout("show cusps --do demo.toml"), picture);
    // Without a terminal the lab prints its picture.
    assert_eq!(ground.stdout("--do demo.toml"), picture);
    // From standard input, which is read once.
    let piped = done(ground.shell("cat demo.toml | $G show --do -"));
    assert_eq!(stdout(&piped), picture);
}

#[test]
fn a_fifo_of_commands_is_read_once() {
    let ground = Ground::new();
    ground.make_fifo("pipe");
    let mut command = ground.command("show --do pipe");
    let child = command.stdout(Stdio::piped()).spawn().unwrap();
    fs::write(ground.file("pipe"), DEMO).unwrap();
    has(stdout(&child.wait_with_output().unwrap()), "step  600 of");
}

#[test]
fn a_rejected_command_is_reported_and_the_picture_before_it_shown() {
    let ground = Ground::new();
    let text = "[[do]]\nstep = 5\n[[do]]\nredo = 1\n[[do]]\nstep = 5\n";
    ground.write("demo.toml", text);
    let output = ground.run("show --do demo.toml");
    let words = "demo.toml:3: redo: nothing to redo; the command after it is not carried out";
    failed(&output, &[words]);
    has(stdout(&output), "step    5 of");
    has_no(stdout(&output), "nothing to redo"); // it is reported only once
    ground.write("demo.toml", "[[do]]\nstp = 5\n");
    let misspelled = ground.run("show --do demo.toml");
    let advice = "demo.toml:2: do.0.stp: unknown command: did you mean step?";
    failed(&misspelled, &[advice]);
    assert_eq!(stdout(&misspelled), "");
    ground.refused("show --do none.toml", 1, &["none.toml: "]);
    ground.refused("show", 2, &[]);
}

/// A file size limit simulates a full disk.
#[test]
fn a_failed_export_stops_the_commands() {
    let ground = Ground::new();
    let text = "[[do]]\nstep = 2000\n[[do]]\nexport = \"run.csv\"\n[[do]]\nstep = 5\n";
    ground.write("demo.toml", text);
    let shown = ground.shell("ulimit -f 64; $G show --do demo.toml");
    let words = "demo.toml:3: export: cannot write ";
    failed(&shown, &[words, "the command after it"]);
    assert_eq!(ground.files(), ["demo.toml"]);
}

/// A signal ends the wait for a step that is too far to reach, and for its export. `go_to` rejects such a distance.
#[test]
fn a_signal_ends_show_with_130_and_leaves_no_files() {
    let ground = Ground::new();
    ground.write("far.toml", "[[do]]\ngo_to = \"1e12 s\"\n");
    ground.write("never.toml", "[[do]]\nset = { \"motion.steps\" = 9000000000000 }\n[[do]]\nexport = { path = \"run.csv\", to_step = 9000000000000 }\n");
    // timeout sends its signal to the process and then to the group, so it arrives twice.
    let script = "timeout --preserve-status -s INT 2 $G show cusps --at 18000000000000000000";
    assert_eq!(ground.shell(script).status.code(), Some(130));
    let far = "far.toml:1: go_to: is more than 10,000,000 steps away: use a longer time step";
    ground.refused("show --do far.toml", 1, &[far]);
    let ended = "timeout --preserve-status -s TERM 2 $G show --do never.toml";
    assert_eq!(ground.shell(ended).status.code(), Some(130));
    assert_eq!(ground.files(), ["far.toml", "never.toml"]);
}

#[test]
fn check_accepts_command_files() {
    let ground = Ground::new();
    ground.write("demo.toml", DEMO);
    ground.write("bad.toml", "[[do]]\nopen = \"method-3\"\n");
    let good = ground.stdout("check demo.toml");
    assert_eq!(good, "demo.toml: good: 5 commands\n");
    let words = "bad.toml:2: do.0.open (\"method-3\") is not a preset: did you mean";
    ground.refused("check bad.toml", 1, &[words]);
}
