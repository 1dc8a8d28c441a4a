//! The program itself in a pty: what it does to a terminal, and how it gives it back at every end.

#![cfg(unix)]
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use portable_pty::{Child, CommandBuilder, ExitStatus, MasterPty, PtySize, native_pty_system};
use std::io::{Read, Write};
use std::num::NonZero;
use std::process::{Command, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::{Duration, Instant};

const PATIENCE: Duration = Duration::from_secs(20);
const LEAVES_ALTERNATE_SCREEN: &str = "\u{1b}[?1049l";
const SHOWS_CURSOR: &str = "\u{1b}[?25h";

/// The program in a pty of its own.
struct Session {
    child: Box<dyn Child + Send + Sync>,
    keys: Option<Box<dyn Write + Send>>,
    pty: Option<Box<dyn MasterPty + Send>>,
    bytes: Arc<Mutex<Vec<u8>>>,
    size: (u16, u16),
    /// The reader hangs up at the next byte.
    lost: Arc<AtomicBool>,
    /// The reader takes no more bytes, as a terminal stopped by Ctrl-S does.
    stopped: Arc<AtomicBool>,
}

impl Session {
    fn open(args: &[&str]) -> Self {
        Self::open_with(args, &[("TERM", "xterm"), ("LANG", "C.UTF-8")])
    }

    fn open_with(args: &[&str], variables: &[(&str, &str)]) -> Self {
        let size = (80, 24);
        let pty = native_pty_system().openpty(pty_size(size)).unwrap();
        let mut command = CommandBuilder::new(env!("CARGO_BIN_EXE_gyrolab"));
        command.args(args);
        for name in ["LC_ALL", "LC_CTYPE", "NO_COLOR", "COLORFGBG"] {
            command.env_remove(name);
        }
        variables
            .iter()
            .for_each(|(name, value)| command.env(name, value));
        let child = pty.slave.spawn_command(command).unwrap();
        let mut output = pty.master.try_clone_reader().unwrap();
        let bytes = Arc::new(Mutex::new(Vec::new()));
        let kept = Arc::clone(&bytes);
        let lost = Arc::new(AtomicBool::new(false));
        let cut = Arc::clone(&lost);
        let stopped = Arc::new(AtomicBool::new(false));
        let shut = Arc::clone(&stopped);
        thread::spawn(move || {
            let mut buffer = [0; 65536];
            while let Ok(length @ 1..) = output.read(&mut buffer) {
                kept.lock().unwrap().extend_from_slice(&buffer[..length]);
                if cut.load(Ordering::Relaxed) {
                    break; // the last handle of the pty's near side: the line is lost
                }
                while shut.load(Ordering::Relaxed) {
                    thread::sleep(Duration::from_millis(20));
                }
            }
        });
        let keys = Some(pty.master.take_writer().unwrap());
        Self {
            child,
            keys,
            pty: Some(pty.master),
            bytes,
            size,
            lost,
            stopped,
        }
    }

    fn press(&mut self, keys: &str) {
        let writer = self.keys.as_mut().unwrap();
        writer.write_all(keys.as_bytes()).unwrap();
        writer.flush().unwrap();
    }

    fn resize(&mut self, size: (u16, u16)) {
        self.size = size;
        self.pty.as_ref().unwrap().resize(pty_size(size)).unwrap();
    }

    fn signal(&self, name: &str) {
        let id = self.child.process_id().unwrap().to_string();
        assert!(
            Command::new("kill")
                .args(["-s", name, &id])
                .status()
                .unwrap()
                .success()
        );
    }

    fn sent(&self) -> Vec<u8> {
        self.bytes.lock().unwrap().clone()
    }

    fn sent_text(&self) -> String {
        String::from_utf8_lossy(&self.sent()).into_owned()
    }

    /// What a terminal would show of the last full picture.
    fn screen(&self) -> String {
        let [rows, columns] = [self.size.1, self.size.0].map(|side| NonZero::new(side).unwrap());
        let mut parser = vt100::Parser::new(rows, columns, 0);
        parser.process(&self.sent());
        parser.screen().contents()
    }

    #[track_caller]
    fn wait_for(&self, words: &str) {
        self.wait_until(words, |session: &Self| session.screen().contains(words));
    }

    #[track_caller]
    fn wait_until(&self, wanted: &str, is_so: impl Fn(&Self) -> bool) {
        let begin = Instant::now();
        while !is_so(self) {
            assert!(
                begin.elapsed() < PATIENCE,
                "no {wanted:?} in\n{}",
                self.screen()
            );
            thread::sleep(Duration::from_millis(20));
        }
    }

    #[track_caller]
    fn wait_for_end(&mut self) -> ExitStatus {
        let begin = Instant::now();
        loop {
            if let Some(status) = self.child.try_wait().unwrap() {
                return status;
            }
            assert!(begin.elapsed() < PATIENCE, "it does not end");
            thread::sleep(Duration::from_millis(10));
        }
    }

    #[track_caller]
    fn has_given_the_terminal_back(&self) {
        self.wait_until("the cursor", |session| {
            let sent = session.sent_text();
            let left = sent.rfind(LEAVES_ALTERNATE_SCREEN);
            left.is_some_and(|left| sent[left..].contains(SHOWS_CURSOR))
        });
    }
}

impl Drop for Session {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn pty_size((cols, rows): (u16, u16)) -> PtySize {
    PtySize {
        rows,
        cols,
        pixel_width: 0,
        pixel_height: 0,
    }
}

#[test]
fn it_opens_runs_and_leaves() {
    let mut session = Session::open(&[]);
    session.wait_for("q quit");
    session.wait_for("Method 2");
    session.wait_for("► ×20");
    session.press("q");
    assert_eq!(session.wait_for_end().exit_code(), 0);
    session.has_given_the_terminal_back();
}

#[test]
fn a_screen_is_prepared_in_one_command() {
    let session = Session::open(&[
        "cusps",
        "--paused",
        "--at",
        "500",
        "--set",
        "start.tilt_deg=20",
    ]);
    session.wait_for("paused");
    session.wait_for("step 500");
    session.wait_for("20.000 deg");
}

#[test]
fn not_a_byte_while_it_stands_still() {
    let session = Session::open(&["--paused"]);
    session.wait_for("q quit");
    thread::sleep(Duration::from_millis(300));
    let before = session.sent().len();
    thread::sleep(Duration::from_secs(2));
    assert_eq!(session.sent().len(), before);
}

#[test]
fn keys_are_answered_at_top_speed() {
    let mut session = Session::open(&["--set", "motion.steps=1000000000"]);
    session.wait_for("q quit");
    session.press("99+");
    session.wait_for("top ×");
    let begin = Instant::now();
    session.press("?");
    session.wait_for("keys: Esc");
    assert!(
        begin.elapsed() < Duration::from_millis(500),
        "{:?}",
        begin.elapsed()
    );
}

#[test]
fn it_follows_the_size_of_the_screen() {
    let mut session = Session::open(&["--paused"]);
    session.wait_for("q quit");
    for size in [(200, 50), (40, 10), (1, 1), (120, 30)] {
        session.resize(size);
        thread::sleep(Duration::from_millis(200));
    }
    session.wait_for("3-D");
    session.press("q");
    assert_eq!(session.wait_for_end().exit_code(), 0);
}

#[test]
fn signals_to_end_give_the_terminal_back() {
    for (signal, code) in [("TERM", 143), ("INT", 130), ("HUP", 129), ("QUIT", 131)] {
        let mut session = Session::open(&["--fps", "60"]);
        session.wait_for("q quit");
        session.signal(signal);
        assert_eq!(session.wait_for_end().exit_code(), code, "{signal}");
        session.has_given_the_terminal_back();
        let sent = session.sent_text();
        let farewell = sent.rfind(LEAVES_ALTERNATE_SCREEN).unwrap();
        assert_eq!(
            &sent[farewell..],
            format!("{LEAVES_ALTERNATE_SCREEN}{SHOWS_CURSOR}")
        );
    }
}

#[test]
#[cfg(debug_assertions)]
fn a_panic_gives_the_terminal_back_and_is_told_there() {
    let variables = [("TERM", "xterm"), ("GYROLAB_PANIC_AFTER_MS", "600")];
    let mut session = Session::open_with(&[], &variables);
    session.wait_for("q quit");
    assert_eq!(session.wait_for_end().exit_code(), 101);
    session.has_given_the_terminal_back();
    session.wait_until("the message", |session| {
        let sent = session.sent_text();
        let farewell = sent.rfind(LEAVES_ALTERNATE_SCREEN).unwrap();
        sent[farewell..].contains("a panic was asked for")
    });
    let sent = session.sent_text();
    assert_eq!(sent.matches(LEAVES_ALTERNATE_SCREEN).count(), 1);
}

#[test]
#[cfg(debug_assertions)]
fn a_panic_in_the_background_waits_for_the_end_to_be_told() {
    let variables = [("TERM", "xterm"), ("GYROLAB_PANIC_ASIDE_AFTER_MS", "300")];
    let mut session = Session::open_with(&[], &variables);
    session.wait_for("q quit");
    thread::sleep(Duration::from_secs(1));
    session.wait_for("q quit");
    assert!(!session.sent_text().contains(LEAVES_ALTERNATE_SCREEN));
    assert!(!session.sent_text().contains("asked for"));
    session.press("q");
    assert_eq!(session.wait_for_end().exit_code(), 0);
    session.wait_until("the message", |session| {
        let sent = session.sent_text();
        let farewell = sent.rfind(LEAVES_ALTERNATE_SCREEN).unwrap();
        sent[farewell..].contains("a panic was asked for aside")
    });
}

#[test]
fn a_lost_line_ends_it() {
    for _ in 0..3 {
        let mut session = Session::open(&[]);
        session.wait_for("q quit");
        session.lost.store(true, Ordering::Relaxed);
        session.keys = None;
        session.pty = None;
        // By the signal, or by the frame that could not be written: whichever comes first.
        assert!([1, 129].contains(&session.wait_for_end().exit_code()));
    }
}

#[test]
fn a_terminal_that_takes_no_bytes_does_not_hold_up_the_end() {
    let mut session = Session::open(&["--fps", "60", "--set", "motion.steps=1000000000"]);
    session.wait_for("q quit");
    session.press("99+");
    session.stopped.store(true, Ordering::Relaxed);
    thread::sleep(Duration::from_secs(3)); // until the pty is full and a frame hangs
    let begin = Instant::now();
    session.signal("TERM");
    session.wait_for_end();
    assert!(
        begin.elapsed() < Duration::from_secs(3),
        "{:?}",
        begin.elapsed()
    );
    session.stopped.store(false, Ordering::Relaxed);
}

#[test]
fn ctrl_l_draws_all_of_it_again() {
    let mut session = Session::open(&["--paused"]);
    session.wait_for("q quit");
    thread::sleep(Duration::from_millis(300));
    session.bytes.lock().unwrap().clear();
    session.press("\u{c}");
    session.wait_for("q quit");
    session.wait_for("Method 2");
}

#[test]
fn ctrl_z_gives_the_terminal_back_and_resuming_draws_all_of_it() {
    let mut session = Session::open(&["--paused"]);
    session.wait_for("q quit");
    session.press("\u{1a}");
    session.has_given_the_terminal_back();
    thread::sleep(Duration::from_millis(300));
    session.bytes.lock().unwrap().clear();
    session.signal("CONT");
    session.wait_for("q quit");
    session.wait_for("Method 2");
    session.press("q");
    assert_eq!(session.wait_for_end().exit_code(), 0);
}

#[test]
fn no_color_means_no_colour_and_the_selection_still_shows() {
    let variables = [("TERM", "xterm"), ("LANG", "C.UTF-8"), ("NO_COLOR", "1")];
    let mut session = Session::open_with(&["--paused"], &variables);
    session.wait_for("q quit");
    session.press("o");
    session.wait_for("> method-2");
    let sent = session.sent_text();
    assert!(
        !sent.contains("\u{1b}[38;") && !sent.contains("\u{1b}[48;"),
        "a colour"
    );
    assert!(sent.contains("\u{1b}[7m"), "no reversed selection");
}

#[test]
fn a_locale_without_utf8_gets_ascii() {
    for variables in [
        [("TERM", "xterm"), ("LANG", "C")],
        [("TERM", "linux"), ("LANG", "POSIX")],
    ] {
        let session = Session::open_with(&["--paused", "--at", "100"], &variables);
        session.wait_for("q quit");
        assert!(session.sent().is_ascii());
    }
}

fn gyrolab(args: &[&str]) -> std::process::Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_gyrolab"));
    command
        .args(args)
        .env("LANG", "C.UTF-8")
        .env_remove("LC_ALL")
        .env("TERM", "xterm")
        .stdin(Stdio::null());
    command.output().unwrap()
}

#[test]
fn without_a_terminal_it_shows_the_picture_and_says_so() {
    let shown = gyrolab(&["cusps"]);
    assert!(shown.status.success());
    assert!(String::from_utf8_lossy(&shown.stderr).contains("no terminal"));
    let same = gyrolab(&["show", "cusps"]);
    assert_eq!(shown.stdout, same.stdout);
    assert!(same.stderr.is_empty());
}

#[test]
fn show_prints_plain_text_of_the_size_asked_for() {
    for (size, lines, columns) in [("80x24", 24, 80), ("200x50", 50, 200), ("1x1", 1, 1)] {
        let output = gyrolab(&["show", "method-2", "--size", size]);
        let text = String::from_utf8(output.stdout).unwrap();
        assert_eq!(text.lines().count(), lines, "{size}");
        assert!(
            text.lines()
                .all(|line| line.chars().count() <= columns && !line.contains('\u{1b}')),
            "{size}"
        );
    }
    let text = String::from_utf8(gyrolab(&["show", "method-2"]).stdout).unwrap();
    assert!(
        text.contains("step 2300") && text.contains("0.8109"),
        "{text}"
    );
}

#[test]
fn what_is_wrong_on_the_command_line_is_refused_in_words() {
    for (args, code, words) in [
        (vec!["no-such-preset"], 1, "no preset of that name"),
        (vec!["show"], 2, "SCENARIO"),
        (vec!["show", "cusps", "--size", "0x9"], 2, "80x24"),
        (vec!["--scheme", "euler"], 2, "report"),
        (vec!["--at", "x"], 2, "a whole number of steps"),
        (
            vec!["--set", "motion.time_step_s=-1"],
            1,
            "must be greater than zero",
        ),
    ] {
        let output = gyrolab(&args);
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(code), "{args:?}: {said}");
        assert!(said.contains(words), "{args:?}: {said}");
    }
}
