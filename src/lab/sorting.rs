//! Finds out which files of the browser's list hold no run. A thread does it, since a file may take long to read.

use std::collections::HashSet;
use std::fs::File;
use std::io::Read;
use std::sync::mpsc::{self, Receiver, RecvTimeoutError};
use std::thread;
use std::time::Duration;

/// How many bytes of a file are searched for its `[motion]`; a body of many points may stand before it.
const HEAD: u64 = 1 << 20;

/// A search, in progress or finished.
#[derive(Debug)]
pub(super) struct Sorting {
    found: Receiver<HashSet<String>>,
}

impl Sorting {
    pub fn begin(names: &[String]) -> Self {
        let (tell, found) = mpsc::channel();
        let names = names.to_vec();
        let search = move || {
            let others = names.into_iter().filter(|name| !may_hold_run(name));
            let _ = tell.send(others.collect()); // the list may be gone
        };
        // If the system gives no thread, every file is listed.
        let _ = thread::Builder::new()
            .name("files".to_owned())
            .spawn(search);
        Self { found }
    }

    /// The files that hold no run, once they are known or are within `wait`.
    pub fn others(&self, wait: Duration) -> Option<HashSet<String>> {
        match self.found.recv_timeout(wait) {
            Ok(others) => Some(others),
            Err(RecvTimeoutError::Disconnected) => Some(HashSet::new()),
            Err(RecvTimeoutError::Timeout) => None,
        }
    }
}

/// Whether the file `name` may hold a run: its first mebibyte names `motion`, as a table or key of a scenario or in the
/// header of an exported CSV. A file that cannot be read counts too: the preview then says why.
fn may_hold_run(name: &str) -> bool {
    let mut head = Vec::new();
    let read = File::open(name).and_then(|file| file.take(HEAD).read_to_end(&mut head));
    if read.is_err() {
        return true;
    }
    let text = String::from_utf8_lossy(&head);
    text.lines().any(|line| {
        let line = line.trim_start_matches(['#', ' ', '\t', '\u{feff}', '[']);
        let rest = line.strip_prefix("motion").map(str::trim_start);
        rest.is_some_and(|rest| rest.starts_with([']', '.', '=']))
    })
}
