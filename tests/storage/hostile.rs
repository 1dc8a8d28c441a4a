//! Damaged session files, and session folders in which another user has placed links, FIFOs or files.

use crate::session::{content, folder, texts};
use gyrolab::lab::storage::session::{Session, resume};
use rustix::fs::{CWD, FileType, Mode, mknodat};
use std::fs;
use std::os::unix::fs::{chown, symlink};
use std::path::{Path, PathBuf};
use std::sync::mpsc;
use std::thread;
use std::time::{Duration, Instant};

/// A call that takes longer than this counts as hanging.
const PATIENCE: Duration = Duration::from_secs(20);

/// Saves a session and closes it.
fn save_session(folder: &Path, work: &str, places: &[&str]) {
    let session = Session::begin(folder).unwrap();
    let begin = Instant::now();
    for place in places {
        session.note(content(work, place));
        let is_written = || {
            let files = fs::read_dir(folder).unwrap();
            let texts = files.filter_map(|file| fs::read_to_string(file.unwrap().path()).ok());
            texts.into_iter().any(|text| text.contains(place))
        };
        while !is_written() {
            assert!(begin.elapsed() < PATIENCE, "it is not written");
            session.flush();
        }
    }
}

/// The only file whose name ends with `end`.
fn only_file(folder: &Path, end: &str) -> PathBuf {
    let files = fs::read_dir(folder).unwrap();
    let mut paths = files.map(|file| file.unwrap().path());
    paths
        .find(|path| path.to_str().unwrap().ends_with(end))
        .unwrap()
}

fn make_fifo(path: &Path) {
    mknodat(CWD, path, FileType::Fifo, Mode::from_raw_mode(0o666), 0).unwrap();
}

/// Calls `what` on a thread, and panics if it does not return in time.
#[track_caller]
fn within_patience<T: Send + 'static>(what: impl FnOnce() -> T + Send + 'static) -> T {
    let (done, result) = mpsc::channel();
    thread::spawn(move || done.send(what()));
    result
        .recv_timeout(PATIENCE)
        .expect("no timeout and no panic")
}

#[test]
fn links_are_not_followed() {
    let (outer, folder) = folder();
    let victim = outer.path().join("victim");
    fs::write(&victim, "precious").unwrap();
    save_session(&folder, "run", &["one"]);
    let lock = only_file(&folder, ".lock");
    fs::remove_file(&lock).unwrap();
    symlink(&victim, &lock).unwrap();
    let found = resume(&folder, None, |content| Ok(texts(content))).unwrap();
    assert!(found.resumed.is_none());
    assert_eq!(fs::read_to_string(&victim).unwrap(), "precious");

    fs::remove_dir_all(&folder).unwrap();
    save_session(&folder, "run", &["one"]);
    let file = only_file(&folder, ".session");
    fs::rename(&file, outer.path().join("elsewhere")).unwrap();
    symlink(outer.path().join("elsewhere"), &file).unwrap();
    let of_session = resume(&folder, None, |content| Ok(texts(content))).unwrap();
    assert!(of_session.resumed.is_none());
    assert!(outer.path().join("elsewhere").exists());
}

#[test]
fn a_fifo_does_not_block_the_search_for_sessions() {
    for end in [".lock", ".session"] {
        let (outer, folder) = folder();
        save_session(&folder, "run", &["one", "two"]);
        let path = only_file(&folder, end);
        fs::remove_file(&path).unwrap();
        make_fifo(&path);
        let there = folder.clone();
        let is_found = within_patience(move || {
            let found = resume(&there, None, |content| Ok(texts(content))).unwrap();
            drop(Session::begin(&there).unwrap());
            found.resumed.is_some()
        });
        assert!(!is_found, "{end}");
        drop(outer);
    }
}

/// Only root can change the owner of a file; for other users this test does nothing.
#[test]
fn files_of_another_user_are_not_used() {
    const NOBODY: u32 = 65534;
    for end in [".session", ".lock"] {
        let (_outer, folder) = folder();
        save_session(&folder, "run", &["one"]);
        let path = only_file(&folder, end);
        if chown(&path, Some(NOBODY), None).is_err() {
            return;
        }
        let before = fs::read(&path).unwrap();
        let found = resume(&folder, None, |content| Ok(texts(content))).unwrap();
        assert!(found.resumed.is_none(), "{end}");
        assert_eq!(fs::read(&path).unwrap(), before, "{end}: unchanged");
    }
}
