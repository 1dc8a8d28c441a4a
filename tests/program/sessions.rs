//! Sessions: how the program saves, lists and confines them. The real program runs in a pty.

use crate::support::ground::{Ground, code, names, stderr};
use crate::support::pty::Terminal;
use crate::support::words::{has, has_all};
use std::fs;
use std::os::unix::fs::symlink;

const ESC: &str = "\u{1b}";
const CTRL_Z: &str = "\u{1a}";
/// Ctrl-U: clears the field of a dialog.
const CLEAR: &str = "\u{15}";
const AS_LEFT: &str = "session resumed";

#[test]
fn resume_restores_backdated_edits() {
    let ground = Ground::new();
    let mut lab = ground.open("method-2 --paused");
    lab.wait_for("L lessons");
    lab.press("157g");
    lab.wait_for_step(157);
    for step in (81..157).rev() {
        lab.press("p,");
        lab.wait_for_step(step);
    }
    lab.quit();
    lab.wait_for("reopens step 81 of Method 2");
    let mut resumed = ground.open("--resume");
    resumed.wait_for(AS_LEFT);
    resumed.wait_for_step(81);
    resumed.quit();
}

/// A file size limit of zero simulates a full disk: files can be created, but not written to.
#[test]
fn a_full_disk_is_reported_until_the_session_is_saved() {
    let ground = Ground::new();
    let mut lab = ground.open_shell();
    lab.wait_for("shell>");
    let program = env!("CARGO_BIN_EXE_gyrolab");
    lab.press(&format!("ulimit -f 0; {program} --paused --at 30\r"));
    lab.wait_for("the session cannot be saved");
    lab.press(".");
    lab.wait_for_step(31);
    lab.wait_for("the session cannot be saved");
    lab.ask("P", "session not saved · the next push");
    lab.ask(ESC, "session not saved");
    lab.clear_output();
    lab.press("q");
    lab.wait_for("there is no session to resume");
    assert!(!lab.words().contains("reopens step"), "{}", lab.words());
}

/// Nothing more can be saved, but the earlier session is intact.
#[test]
fn on_a_full_disk_the_last_message_names_the_saved_step() {
    let ground = Ground::new();
    let mut lab = ground.open("--paused --at 30");
    lab.wait_for("L lessons");
    lab.quit();
    let mut shell = ground.open_shell();
    shell.wait_for("shell>");
    let program = env!("CARGO_BIN_EXE_gyrolab");
    shell.press(&format!("ulimit -f 0; {program} --resume\r"));
    shell.wait_for(AS_LEFT);
    shell.press(".");
    shell.wait_for_step(31);
    shell.wait_for("the session cannot be saved");
    shell.press("q");
    shell.wait_for("the last changes are lost: the session cannot be saved");
    shell.wait_for("--resume reopens step 30 of Method 2");
}

#[test]
fn sessions_of_other_versions_are_named_and_left_alone() {
    let ground = Ground::new();
    let folder = ground.state().join("gyrolab");
    fs::create_dir_all(&folder).unwrap();
    for (name, version) in [("1.session", 4), ("2.session", 6)] {
        fs::write(folder.join(name), format!("gyrolab session {version}\nx\n")).unwrap();
    }
    let mut lab = ground.open("--resume");
    for name in ["1.session", "2.session"] {
        lab.wait_for(&format!(
            "{name} was skipped (another version of gyrolab wrote it)"
        ));
    }
    lab.quit();
    assert!(folder.join("1.session").exists() && folder.join("2.session").exists());
}

#[test]
fn a_command_after_options_is_rejected_with_the_right_order() {
    let words = |name: &str| {
        format!(
            "gyrolab: {name} is a command, and commands come before their options: gyrolab {name} ..."
        )
    };
    for (name, more, end, with) in [
        ("run", " cusps", "; --folder is an option of the lab", 2),
        ("sessions", "", "", 1),
    ] {
        let output = Ground::new().run(&format!("--folder . {name}{more}"));
        assert_eq!(code(&output), with);
        assert_eq!(stderr(&output), format!("{}{end}\n", words(name)));
    }
}

#[test]
fn sessions_are_listed_and_resumed_by_name() {
    let ground = Ground::new();
    for (preset, step) in [("cusps", "20"), ("method-2", "30")] {
        let mut lab = ground.open(&format!("{preset} --paused --at {step}"));
        lab.wait_for("L lessons");
        lab.quit();
    }
    let mut first = ground.open("--resume 1");
    first.wait_for(AS_LEFT);
    first.wait_for_step(20);
    let text = ground.stdout("sessions");
    assert_eq!(text.lines().count(), 3, "{text}");
    let line = |name: &str| text.lines().find(|line| line.starts_with(name)).unwrap();
    let process = format!("by process {}", first.child.process_id().unwrap());
    has_all(line("1 "), [&process, "(cusps)"]);
    has_all(line("2 "), [" 30 ", " no ", "Method 2 (method-2)"]);
    for (name, words) in [
        ("1", "it is open in another lab"),
        ("7", "there is no such session"),
    ] {
        let mut lab = ground.open(&format!("--resume {name}"));
        assert_eq!(lab.wait_for_end().exit_code(), 1);
        lab.wait_for(words);
    }
    first.quit();
}

/// Opens a lab confined to the folder `inside`, next to which is `secret.toml`.
fn open_confined(ground: &Ground) -> Terminal {
    let inside = ground.file("inside");
    if !inside.exists() {
        fs::create_dir(&inside).unwrap();
        let preset = ground.stdout("presets cusps");
        ground.write("secret.toml", &preset);
        ground.write("inside/own.toml", &preset);
        symlink(ground.file("secret.toml"), inside.join("out.toml")).unwrap();
        symlink(ground.file(""), inside.join("up")).unwrap();
        ground.make_fifo("inside/pipe.csv");
    }
    let folder = inside.to_str().unwrap();
    let lab = ground.open(&format!("--folder {folder} --paused --at 30"));
    lab.wait_for("L lessons");
    lab
}

#[test]
fn a_confined_lab_writes_only_in_its_folder() {
    let ground = Ground::new();
    let mut lab = open_confined(&ground);
    for key in ["x", "s", "S"] {
        for (name, reason) in [
            ("../new.toml", "stays in its folder"),
            ("/tmp/gyrolab-new.toml", "stays in its folder"),
            ("up/new.toml", "leads out of it"),
            ("out.toml", "leads out of it"),
            ("own/../../new.toml", "stays in its folder"),
            (".gyrolab/1.session", "begin with a dot"),
            ("/dev/tty", "stays in its folder"),
            ("pipe.csv", "only regular files"),
            ("-", "cannot be the name of a file"),
        ] {
            lab.press(key);
            lab.press(&format!("{CLEAR}{name}\r"));
            lab.wait_for(reason);
            lab.press(ESC);
            lab.wait_until("no dialog", |lab| !lab.words().contains(reason));
        }
    }
    lab.press("s");
    lab.press(&format!("{CLEAR}new.toml\r"));
    lab.wait_for("the run is in");
    lab.ask(CTRL_Z, "no shell to return to");
    lab.quit();
    assert_eq!(ground.files(), ["inside", "secret.toml"], "no state folder");
    let files = ".gyrolab new.toml out.toml own.toml pipe.csv up";
    assert_eq!(names(&ground.file("inside")).join(" "), files);
    assert!(ground.file("inside/.gyrolab/1.session").exists());
}

#[test]
fn a_confined_lab_reads_only_in_its_folder() {
    let ground = Ground::new();
    let mut lab = open_confined(&ground);
    lab.press("o");
    lab.ask("/toml", "own.toml");
    assert!(!lab.words().contains("out.toml"), "{}", lab.words());
    lab.press("\r");
    lab.wait_for_step(0);
    lab.quit();

    let folder = ground.file("inside");
    let folder = folder.to_str().unwrap();
    let scenarios = "../secret.toml out.toml up/secret.toml /dev/null.toml";
    for scenario in scenarios.split(' ') {
        let mut outside = ground.open(&format!("--folder {folder} {scenario}"));
        assert_eq!(outside.wait_for_end().exit_code(), 1, "{scenario}");
        outside.wait_for("stays in its folder");
    }
    let secret = ground.file("secret.toml");
    let piped = ground.run(&["--folder", folder, secret.to_str().unwrap()]);
    assert_eq!(piped.status.code(), Some(1));

    let listed = ground.stdout(&format!("sessions --folder {folder}"));
    has(listed, "(own.toml)");
    let mut resumed = ground.open(&format!("--folder {folder} --resume"));
    resumed.wait_for(AS_LEFT);
    resumed.quit();
    resumed.wait_for("gyrolab --folder");
}
