//! Damaged session files, and session folders in which another user has placed links, FIFOs or files.

use crate::session::{content, folder};
use gyrolab::storage::session::{Session, resume};
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
fn kept(folder: &Path, work: &str, places: &[&str]) {
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
fn only(folder: &Path, end: &str) -> PathBuf {
    let files = fs::read_dir(folder).unwrap();
    let mut paths = files.map(|file| file.unwrap().path());
    paths
        .find(|path| path.to_str().unwrap().ends_with(end))
        .unwrap()
}

fn make_fifo(path: &Path) {
    mknodat(CWD, path, FileType::Fifo, Mode::from_raw_mode(0o666), 0).unwrap();
}

/// Calls `what` on a thread, and fails if it does not return in time.
#[track_caller]
fn within_patience<T: Send + 'static>(what: impl FnOnce() -> T + Send + 'static) -> T {
    let (done, result) = mpsc::channel();
    thread::spawn(move || done.send(what()));
    result.recv_timeout(PATIENCE).expect("it hangs, or panics")
}

#[test]
fn no_flipped_bit_is_taken_for_what_was_written() {
    let (_outer, folder) = folder();
    kept(
        &folder,
        "form = 2\ntilt = 45.0\n",
        &["step = 11\n", "step = 12\n"],
    );
    for end in [".work", ".place"] {
        let path = only(&folder, end);
        let files: Vec<_> = [".work", ".place"]
            .map(|end| only(&folder, end))
            .into_iter()
            .map(|path| (fs::read(&path).unwrap(), path))
            .collect();
        let good = fs::read(&path).unwrap();
        let mut accepted = Vec::new();
        for bit in 0..8 * good.len() {
            let mut flipped = good.clone();
            flipped[bit / 8] ^= 1 << (bit % 8);
            fs::write(&path, &flipped).unwrap();
            let found = resume(&folder, |content| Ok(content.clone())).unwrap();
            if found.kept_aside.is_empty() {
                accepted.push((bit, found.resumed.map(|resumed| resumed.what)));
            }
            for file in fs::read_dir(&folder).unwrap() {
                let _ = fs::remove_file(file.unwrap().path());
            }
            for (bytes, path) in &files {
                fs::write(path, bytes).unwrap();
            }
        }
        assert!(
            accepted.is_empty(),
            "{end}: {} of {}: {accepted:?}",
            accepted.len(),
            8 * good.len()
        );
    }
}

#[test]
fn no_link_is_followed() {
    let (outer, folder) = folder();
    let victim = outer.path().join("victim");
    fs::write(&victim, "precious").unwrap();
    kept(&folder, "run", &["one"]);
    for end in ["lock", ".lock"] {
        let lock = only(&folder, end);
        fs::remove_file(&lock).unwrap();
        symlink(&victim, &lock).unwrap();
    }
    let found = resume(&folder, |content| Ok(content.clone())).unwrap();
    assert!(found.resumed.is_none());
    assert_eq!(fs::read_to_string(&victim).unwrap(), "precious");

    fs::remove_dir_all(&folder).unwrap();
    kept(&folder, "run", &["one"]);
    let work = only(&folder, ".work");
    fs::rename(&work, outer.path().join("elsewhere")).unwrap();
    symlink(outer.path().join("elsewhere"), &work).unwrap();
    let found = resume(&folder, |content| Ok(content.clone())).unwrap();
    assert!(found.resumed.is_none());
    assert!(outer.path().join("elsewhere").exists());

    fs::remove_dir_all(&folder).unwrap();
    kept(&folder, "run", &["one"]);
    for kind in ["work.new", "place.new"] {
        symlink(&victim, only(&folder, ".work").with_extension(kind)).unwrap();
    }
    let found = resume(&folder, |content| Ok(content.clone())).unwrap();
    let session = found.resumed.unwrap().session;
    for work in ["run", "another"] {
        session.note(content(work, "two"));
        session.flush();
    }
    drop(session);
    assert_eq!(fs::read_to_string(&victim).unwrap(), "precious");
}

#[test]
fn a_second_name_of_a_file_elsewhere_is_left_alone() {
    let (outer, folder) = folder();
    let victim = outer.path().join("victim");
    fs::write(&victim, "precious").unwrap();
    kept(&folder, "run", &["one"]);
    for end in ["lock", ".lock"] {
        let lock = only(&folder, end);
        fs::remove_file(&lock).unwrap();
        fs::hard_link(&victim, &lock).unwrap();
    }
    let found = resume(&folder, |content| Ok(content.clone())).unwrap();
    assert!(found.resumed.is_none());
    assert_eq!(fs::read_to_string(&victim).unwrap(), "precious");
}

#[test]
fn a_fifo_holds_nobody_up() {
    for end in ["lock", ".lock", ".work", ".place"] {
        let (outer, folder) = folder();
        kept(&folder, "run", &["one", "two"]);
        let path = match end {
            "lock" => folder.join("lock"),
            end => only(&folder, end),
        };
        fs::remove_file(&path).unwrap();
        make_fifo(&path);
        let there = folder.clone();
        let found = within_patience(move || {
            let found = resume(&there, |content| Ok(content.clone())).unwrap();
            drop(Session::begin(&there).unwrap());
            found.resumed.map(|resumed| resumed.what.place)
        });
        let wanted = match end {
            "lock" => Some("two"),
            ".place" => Some("one"),
            _ => None,
        };
        assert_eq!(found.as_deref(), wanted, "{end}");
        drop(outer);
    }
}

/// Only root can change the owner of a file; for other users this test does nothing.
#[test]
fn what_belongs_to_another_is_not_taken() {
    const NOBODY: u32 = 65534;
    for end in [".work", ".lock"] {
        let (_outer, folder) = folder();
        kept(&folder, "run", &["one"]);
        let path = only(&folder, end);
        if chown(&path, Some(NOBODY), None).is_err() {
            return;
        }
        let before = fs::read(&path).unwrap();
        let found = resume(&folder, |content| Ok(content.clone())).unwrap();
        assert!(found.resumed.is_none(), "{end}");
        assert_eq!(fs::read(&path).unwrap(), before, "{end}: it is as it was");
    }
}
