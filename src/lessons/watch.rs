//! Detects changes of a file by its time and length, once per second. The system's watchers miss changes on network
//! drives, and by editors that replace the file.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

/// Time between two checks.
const LESSON_WATCH_INTERVAL: Duration = Duration::from_secs(1);

/// A file that is checked for changes.
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

    /// Returns true if the file has changed since the last check. `now` is the time since the lab was opened.
    ///
    /// A file that is missing for a moment, while it is replaced, has not changed.
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
