//! `--do` and `check` on files of commands, by the program itself.

use crate::support::ground::Ground;
use std::fs;
use std::io::Write;
use std::process::{Command, Output, Stdio};

const GYROLAB: &str = env!("CARGO_BIN_EXE_gyrolab");

const DEMO: &str = "[[do]]\nopen = \"method-2\"\n[[do]]\nset = { \"motion.time_step_s\" = 0.05 }\n[[do]]\nwait_s = 3600\n\
    [[do]]\nrun_until = \"t_s >= 30\"\n[[do]]\nexact = true\n";

fn gyrolab(folder: &tempfile::TempDir, args: &[&str]) -> Command {
    let mut command = Command::new(GYROLAB);
    command.current_dir(folder).args(args).stdin(Stdio::null());
    command
}

fn run(folder: &tempfile::TempDir, args: &[&str]) -> (String, String, Option<i32>) {
    let Output {
        stdout,
        stderr,
        status,
    } = gyrolab(folder, args).output().unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    (text(stdout), text(stderr), status.code())
}

#[test]
fn show_prints_the_picture_after_the_commands() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("demo.toml"), DEMO).unwrap();
    let (picture, talk, code) = run(&folder, &["show", "--do", "demo.toml"]);
    assert_eq!((talk.as_str(), code), ("", Some(0)));
    assert!(
        picture.contains("step 600") && picture.contains("dt 0.05 s"),
        "{picture}"
    );
    let (same, ..) = run(&folder, &["show", "cusps", "--do", "demo.toml"]);
    assert_eq!(same, picture);
    // Without a terminal the lab prints its picture.
    let (same, ..) = run(&folder, &["--do", "demo.toml"]);
    assert_eq!(same, picture);
    // From standard input, which is read once.
    let mut child = gyrolab(&folder, &["show", "--do", "-"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    child
        .stdin
        .take()
        .unwrap()
        .write_all(DEMO.as_bytes())
        .unwrap();
    let output = child.wait_with_output().unwrap();
    assert_eq!(String::from_utf8(output.stdout).unwrap(), picture);
}

#[test]
fn a_fifo_is_read_once() {
    let folder = tempfile::tempdir().unwrap();
    let made = Command::new("mkfifo")
        .arg(folder.path().join("pipe"))
        .status()
        .unwrap();
    assert!(made.success());
    let child = gyrolab(&folder, &["show", "--do", "pipe"])
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    fs::write(folder.path().join("pipe"), DEMO).unwrap();
    let output = child.wait_with_output().unwrap();
    assert!(
        String::from_utf8(output.stdout)
            .unwrap()
            .contains("step 600")
    );
}

#[test]
fn what_is_refused_is_told_and_the_picture_up_to_there_shown() {
    let folder = tempfile::tempdir().unwrap();
    let text = "[[do]]\nstep = 5\n[[do]]\nredo = 1\n[[do]]\nstep = 5\n";
    fs::write(folder.path().join("demo.toml"), text).unwrap();
    let (picture, talk, code) = run(&folder, &["show", "--do", "demo.toml"]);
    assert_eq!(code, Some(1));
    assert!(picture.contains("step 5 "), "{picture}");
    assert!(
        talk.contains(
            "demo.toml:3: redo: nothing to do again; the command after it is not carried out"
        ),
        "{talk}"
    );
    assert!(
        !picture.contains("nothing to do again"),
        "it is said once: {picture}"
    );
    fs::write(folder.path().join("demo.toml"), "[[do]]\nstp = 5\n").unwrap();
    let (picture, talk, code) = run(&folder, &["show", "--do", "demo.toml"]);
    assert_eq!((picture.as_str(), code), ("", Some(1)));
    assert!(
        talk.contains("demo.toml:2: do.0.stp: unknown command: did you mean step?"),
        "{talk}"
    );
    let (_, talk, code) = run(&folder, &["show", "--do", "none.toml"]);
    assert_eq!(code, Some(1));
    assert!(talk.contains("none.toml: there is no such file"), "{talk}");
    assert_eq!(run(&folder, &["show"]).2, Some(2));
}

/// A limit on the size of files does for a full disk.
#[test]
fn an_export_that_fails_on_the_way_ends_the_commands() {
    let ground = Ground::new();
    let text = "[[do]]\nstep = 2000\n[[do]]\nexport = \"run.csv\"\n[[do]]\nstep = 5\n";
    ground.write("demo.toml", text);
    let shown = ground.shell("ulimit -f 64; $G show --do demo.toml");
    let talk = String::from_utf8(shown.stderr).unwrap();
    assert_eq!(shown.status.code(), Some(1), "{talk}");
    let wanted = "demo.toml:3: export: cannot write ";
    assert!(
        talk.contains(wanted) && talk.contains("the command after it"),
        "{talk}"
    );
    assert_eq!(ground.files(), ["demo.toml"]);
}

/// A step that is never reached, and an export of one: a signal ends the wait. Commands do not go that far.
#[test]
fn a_signal_ends_show_with_130_and_leaves_nothing() {
    let ground = Ground::new();
    ground.write("far.toml", "[[do]]\ngo_to = \"1e12 s\"\n");
    ground.write("never.toml", "[[do]]\nset = { \"motion.steps\" = 9000000000000 }\n[[do]]\nexport = { path = \"run.csv\", to_step = 9000000000000 }\n");
    // timeout sends its signal to the process and then to the group: twice, and it is meant once.
    let script = "timeout --preserve-status -s INT 2 $G show cusps --at 18000000000000000000";
    assert_eq!(ground.shell(script).status.code(), Some(130));
    let output = ground.run(&["show", "--do", "far.toml"]);
    let talk = String::from_utf8_lossy(&output.stderr);
    let far = "far.toml:1: go_to: is more than 10,000,000 steps away: a longer time step";
    assert_eq!(output.status.code(), Some(1), "{talk}");
    assert!(talk.contains(far), "{talk}");
    let script = "timeout --preserve-status -s TERM 2 $G show --do never.toml";
    assert_eq!(ground.shell(script).status.code(), Some(130));
    assert_eq!(ground.files(), ["far.toml", "never.toml"]);
}

#[test]
fn check_takes_files_of_commands() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("demo.toml"), DEMO).unwrap();
    fs::write(
        folder.path().join("bad.toml"),
        "[[do]]\nopen = \"method-3\"\n",
    )
    .unwrap();
    let (good, _, code) = run(&folder, &["check", "demo.toml"]);
    assert_eq!(
        (good.as_str(), code),
        ("demo.toml: good: 5 commands\n", Some(0))
    );
    let (_, talk, code) = run(&folder, &["check", "bad.toml"]);
    assert_eq!(code, Some(1));
    assert!(
        talk.contains("bad.toml:2: do.0.open (\"method-3\") is no preset: did you mean"),
        "{talk}"
    );
}

#[test]
fn the_manual_lists_every_command() {
    let folder = tempfile::tempdir().unwrap();
    let (manual, ..) = run(&folder, &["man"]);
    for row in gyrolab::lab::command::COMMANDS {
        assert!(manual.contains(&format!("{} = ", row.name)), "{}", row.name);
    }
}
