//! Whether a file has changed: its time and its length are looked at once a second. Watchers of the system miss changes on
//! network drives, and of editors that replace the file.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

/// The time between two looks.
const LESSON_WATCH_INTERVAL: Duration = Duration::from_secs(1);

#[derive(Clone, Debug)]
pub struct Watch {
    pub path: PathBuf,
    seen: Option<(SystemTime, u64)>,
    next: Duration,
}

impl Watch {
    pub fn new(path: &Path) -> Self {
        Self {
            path: path.to_owned(),
            seen: state(path),
            next: Duration::ZERO,
        }
    }

    /// Returns whether the file has changed since it was last looked at; `now` is the time since the lab was opened. A
    /// file that is gone for a moment, as it is replaced, has not changed.
    pub fn has_changed(&mut self, now: Duration) -> bool {
        if now < self.next {
            return false;
        }
        self.next = now + LESSON_WATCH_INTERVAL;
        let state = state(&self.path);
        let has_changed = state.is_some() && state != self.seen;
        if has_changed {
            self.seen = state;
        }
        has_changed
    }
}

fn state(path: &Path) -> Option<(SystemTime, u64)> {
    let file = fs::metadata(path).ok()?;
    Some((file.modified().ok()?, file.len()))
}
