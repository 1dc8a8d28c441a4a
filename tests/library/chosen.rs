//! A file that is chosen in the browser is read in the background, and opened when it has been read.

use crate::support::desk::Desk;
use gyrolab::lab::Mode;
use gyrolab::scenario::presets;
use gyrolab::tui::keymap::Key;
use gyrolab::tui::press::press;
use std::fmt::Write;
use std::thread;
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// Waiting for longer than this counts as hanging.
const PATIENCE: Duration = Duration::from_secs(60);

/// A lab whose folder holds a run file that takes a while to read, with the browser open at this file.
fn browsing() -> (TempDir, Desk) {
    let folder = tempfile::tempdir().unwrap();
    let mut text = presets::find("loops").unwrap().text.to_owned();
    for step in 0..10_000 {
        let _ = writeln!(
            text,
            "[[edit]]\nstep = {step}\nset.'motion.gravity_m_per_s2' = 9"
        );
    }
    std::fs::write(folder.path().join("long.toml"), text).unwrap();
    let mut desk = Desk::open("method-2");
    desk.lab.files_mut().work_in(folder.path());
    desk.type_text("o/long.toml");
    (folder, desk)
}

fn enter(desk: &mut Desk) {
    press(Key::Enter, &mut desk.lab);
}

/// Lets time pass until `is_so`.
fn wait_until(desk: &mut Desk, is_so: impl Fn(&Desk) -> bool) {
    let begin = Instant::now();
    while !is_so(desk) {
        assert!(begin.elapsed() < PATIENCE);
        thread::sleep(Duration::from_millis(2));
        desk.wait(1);
    }
}

#[test]
fn it_opens_when_it_has_been_read() {
    let (_folder, mut desk) = browsing();
    enter(&mut desk);
    assert!(
        desk.lab.popups().browser.is_loading(),
        "the key has not waited"
    );
    assert_eq!(desk.lab.player().run().scenario().edits.len(), 0);
    wait_until(&mut desk, |desk| desk.lab.popups().mode == Mode::Lab);
    assert_eq!(desk.lab.player().run().scenario().edits.len(), 10_000);
    assert!(desk.lab.player().playback.is_running());
}

#[test]
fn esc_means_that_it_is_not_opened() {
    let (_folder, mut desk) = browsing();
    enter(&mut desk);
    press(Key::Esc, &mut desk.lab);
    assert_eq!(desk.lab.popups().mode, Mode::Browser);
    wait_until(&mut desk, |desk| !desk.lab.popups().browser.is_loading());
    desk.wait(5);
    assert_eq!(desk.lab.player().run().scenario().edits.len(), 0);
    assert_eq!(desk.lab.popups().mode, Mode::Browser);
}
