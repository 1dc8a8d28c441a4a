//! Lessons in the real program: what a session saves of them, and the teacher's notes in a second terminal.

use crate::support::ground::{Ground, code, done, failed, stderr, stdout};
use crate::support::words::has_all;
use std::io::{BufRead, BufReader};
use std::process::Stdio;
use std::sync::mpsc;
use std::thread;
use std::time::Duration;

const LESSON: &str = "is-the-wobble-real";
const DOWN: &str = "\x1b[B";

#[test]
fn a_prediction_survives_a_kill_and_can_be_exported() {
    let ground = Ground::new();
    let mut lab = ground.open(&["lesson", LESSON, "--page", "2"]);
    lab.wait_for("1 stays as it is");
    lab.ask(&DOWN.repeat(3), "lock this prediction");
    lab.press("\r");
    // The session is saved within half a second, or a little later on a busy machine.
    lab.wait_until("the saved prediction", |_| {
        let output = ground.run(&["lesson", LESSON, "--answers"]);
        stdout(&output).contains("**Predicted.** is more than a hundred times smaller")
    });
    lab.kill();
    let mut resumed = ground.open("--resume");
    resumed.wait_for("Locked: is more than a hundred times");
    resumed.wait_for("2 of 10");
    resumed.press("n");
    resumed.wait_for("The run is playing");
    resumed.press("n");
    resumed.wait_for("Came out: The tilt now stays within");
    resumed.quit();
    let output = ground.run(&["lesson", LESSON, "--answers"]);
    let text = stdout(&output);
    assert!(!text.contains("x² + y²"), "that was not predicted:\n{text}");
    let answers = done(ground.run(&["lesson", LESSON, "--answers", "-o", "mine.md"]));
    assert!(stdout(&answers).is_empty());
    let written = ground.read("mine.md");
    assert!(written.contains("Left at page 3 of 10."), "{written}");
    let came_out =
        "**Came out.** is more than a hundred times smaller. The tilt now stays within 0.042";
    has_all(&written, [came_out, "no push, the rest as given: not done"]);
}

#[test]
fn the_answers_option_needs_a_session() {
    let ground = Ground::new();
    let output = ground.run(&["lesson", LESSON, "--answers"]);
    failed(
        &output,
        &[
            "no session contains a prediction for is-the-wobble-real",
            "gyrolab lesson",
        ],
    );
    failed(
        &ground.run("lesson --notes"),
        &["no lesson is open in any lab"],
    );
    failed(
        &ground.run("lesson --notes nobody"),
        &["--notes nobody", "gyrolab sessions"],
    );
}

#[test]
fn notes_follow_the_lab_from_page_to_page() {
    let ground = Ground::new();
    let mut lab = ground.open(&["lesson", LESSON, "--page", "2"]);
    lab.wait_for("2 of 10");
    let (sender, lines) = mpsc::channel();
    let mut notes = loop {
        let mut notes = ground
            .command("lesson --notes")
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        thread::sleep(Duration::from_millis(300));
        // The lab can be followed only after its first save.
        if notes.try_wait().unwrap().is_none() {
            break notes;
        }
    };
    let output = notes.stdout.take().unwrap();
    thread::spawn(move || {
        for line in BufReader::new(output).lines().map_while(Result::ok) {
            if sender.send(line).is_err() {
                return;
            }
        }
    });
    let wait_for = |words: &str| {
        let patience = Duration::from_secs(60);
        while let Ok(line) = lines.recv_timeout(patience) {
            if line.contains(words) {
                return;
            }
        }
        panic!("no {words:?}");
    };
    wait_for("== 2 of 10 · Is the wobble real?");
    wait_for("let two answers be defended");
    wait_for("next: A finer step: run");
    lab.press("nn");
    wait_for("== 3 of 10");
    notes.kill().unwrap();
    notes.wait().unwrap();
    // It ends without a panic at a closed pipe and at Ctrl-C.
    let closed = ground.shell("exec 3>&1; { timeout 60 $G lesson --notes; echo $? >&3; } | true");
    assert_eq!((stdout(&closed), stderr(&closed)), ("0\n", ""));
    let ended = ground.shell("timeout --preserve-status -s INT 2 $G lesson --notes >/dev/null");
    assert_eq!(code(&ended), 130);
    lab.quit();
}
