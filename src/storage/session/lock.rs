//! Locked files, by which one process keeps others from a session, or for a moment from the folder of the sessions.

use super::own;
use signal_hook::consts::SIGXFSZ;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, Write};
use std::os::unix::fs::{MetadataExt, OpenOptionsExt};
use std::path::Path;
use std::sync::{Arc, Once};
use std::thread;
use std::time::{Duration, Instant};

/// How long to wait for the folder's lock.
const PATIENCE: Duration = Duration::from_millis(200);

/// A lock file that is locked.
pub(in crate::storage) struct Lock(File);

impl Drop for Lock {
    /// Unlocks explicitly: closing alone keeps the lock while a child process that is just being started still has the
    /// file open.
    fn drop(&mut self) {
        let _ = self.0.unlock();
    }
}

/// Locks the folder, so that other processes wait before they choose or remove sessions. `None` if another process keeps
/// the lock longer than 0.2 s: it may have been suspended. Sessions are protected by their own locks; this lock only keeps
/// a process that briefly locks a session to look at it from being mistaken for its user.
pub(in crate::storage) fn lock_folder(folder: &Path) -> Option<Lock> {
    let begin = Instant::now();
    loop {
        match take(&folder.join("lock")) {
            Ok(Some(lock)) => return Some(lock),
            Ok(None) if begin.elapsed() < PATIENCE => thread::sleep(Duration::from_millis(2)),
            Ok(None) | Err(_) => return None,
        }
    }
}

/// Locks the file at `path`; `None` if a running process holds the lock. On a file system without locks it always succeeds.
pub(super) fn take(path: &Path) -> io::Result<Option<Lock>> {
    handle_file_size_signal();
    let mut options = OpenOptions::new();
    options.write(true).create(true).truncate(false).mode(0o600);
    let mut lock = own::open(path, &mut options)?;
    match lock.try_lock() {
        Err(TryLockError::WouldBlock) => Ok(None),
        // The last owner may have removed the file between opening and locking; the lock then protects nothing.
        Ok(()) | Err(TryLockError::Error(_)) => {
            // The process number serves messages of other processes; the lock holds without it.
            let _ = lock
                .set_len(0)
                .and_then(|()| write!(lock, "{}", std::process::id()));
            let lock = Lock(lock);
            Ok(is_same_file(&lock.0, path).then_some(lock))
        }
    }
}

/// Whether the file at `path` is still `file`.
fn is_same_file(file: &File, path: &Path) -> bool {
    let identity = |of: fs::Metadata| (of.dev(), of.ino());
    match (file.metadata(), fs::symlink_metadata(path)) {
        (Ok(ours), Ok(there)) => identity(ours) == identity(there),
        _ => false,
    }
}

/// Handles SIGXFSZ, so that a write past `ulimit -f` fails, like one to a full disk, instead of ending the process.
fn handle_file_size_signal() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let _ = signal_hook::flag::register(SIGXFSZ, Arc::default());
    });
}
