//! What the lab says, read by one who has never seen it.

use crate::support::stage::{SMALL, Stage};
use gyrolab::tui::keymap::Key;
use rustix::fs::{CWD, FileType, Mode, mknodat};
use std::sync::mpsc;
use std::thread;
use std::time::Duration;

#[test]
fn esc_turns_from_the_values_back_to_the_run() {
    let mut stage = Stage::open("method-2", &[], SMALL);
    for key in ["e", "P"] {
        stage.press(key);
        assert_eq!(stage.focus(), "parameters", "{key}");
        while stage.focus() == "parameters" {
            stage.shows_no("nothing to close");
            stage.key(Key::Esc);
        }
        assert_eq!(stage.focus(), "traces", "{key}");
    }
    stage.key(Key::Esc);
    stage.shows("nothing to close; q leaves");
}

#[test]
fn what_was_changed_is_told_of_a_preset_as_of_a_file() {
    let mut stage = Stage::open("method-2", &[], SMALL);
    stage.press("p.");
    stage.shows("differs from what was opened: one more push");
}

/// A FIFO that nobody writes to does for a file that takes for ever to read.
#[test]
fn a_file_that_takes_long_to_read_does_not_hold_up_the_browser() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("tardy.toml");
    std::fs::write(&path, "").unwrap();
    let (done, result) = mpsc::channel();
    thread::spawn(move || {
        let mut stage = Stage::open("method-2", &[], SMALL);
        stage.lab.files_mut().work_in(folder.path());
        stage.press("o");
        std::fs::remove_file(&path).unwrap();
        mknodat(CWD, &path, FileType::Fifo, Mode::from_raw_mode(0o600), 0).unwrap();
        stage.press("/tardy").shows("reading ...");
        done.send(()).unwrap();
    });
    let patience = Duration::from_secs(60);
    result
        .recv_timeout(patience)
        .expect("it waits for the file");
}
