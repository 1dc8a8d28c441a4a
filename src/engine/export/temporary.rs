//! Temporary names of files and folders that are being written, beside the place that they will have.
//!
//! A file that is being written is locked. An unlocked one was left by a process that was killed, and the next one that
//! writes in the same folder removes it. On a file system without locks it stays.

use std::fs::{self, File, OpenOptions, Permissions, TryLockError};
use std::io;
use std::os::unix::fs::{MetadataExt, OpenOptionsExt};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use tempfile::{Builder, NamedTempFile, TempDir};

const PREFIX: &str = ".gyrolab-";
/// Random letters and digits between prefix and suffix.
const DRAWN: usize = 6;
const SUFFIX: &str = ".part";

/// The paths of the temporary files and folders of this process, also of those that have got their names or are gone.
static TEMPORARY_FILES: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// Removes the temporary files and folders of this process, which ends on the spot.
pub fn remove_own() {
    /// Another thread may still add files to a folder.
    const ATTEMPTS: usize = 3;
    for path in &*TEMPORARY_FILES
        .lock()
        .unwrap_or_else(PoisonError::into_inner)
    {
        if path.is_dir() {
            let _ = (0..ATTEMPTS).find(|_| fs::remove_dir_all(path).is_ok());
        } else {
            let _ = fs::remove_file(path); // there is nobody to tell
        }
    }
}

fn remember(path: &Path) {
    let mut own = TEMPORARY_FILES
        .lock()
        .unwrap_or_else(PoisonError::into_inner);
    own.push(path.to_owned());
}

pub fn file_in(folder: &Path, permissions: &Permissions) -> io::Result<NamedTempFile> {
    remove_what_was_left(folder);
    loop {
        let made = builder(permissions).tempfile_in(folder);
        let file = made.map_err(|error| of_the_system(&error))?;
        if is_locked_in_time(file.as_file())? {
            remember(file.path());
            return Ok(file);
        }
    }
}

/// A new folder in `folder` under a temporary name, and what holds its lock.
pub fn folder_in(folder: &Path, permissions: &Permissions) -> io::Result<(TempDir, File)> {
    remove_what_was_left(folder);
    loop {
        let made = builder(permissions).tempdir_in(folder);
        let new = made.map_err(|error| of_the_system(&error))?;
        let lock = File::open(new.path())?;
        if is_locked_in_time(&lock)? {
            remember(new.path());
            return Ok((new, lock));
        }
    }
}

fn builder(permissions: &Permissions) -> Builder<'static, 'static> {
    let mut builder = Builder::new();
    builder.prefix(PREFIX).suffix(SUFFIX);
    builder.rand_bytes(DRAWN).permissions(permissions.clone());
    builder
}

/// The system's own error, without the temporary name that `error` speaks of.
fn of_the_system(error: &io::Error) -> io::Error {
    let text = error.to_string();
    let own = text.split(" at path \"").next().unwrap_or_default();
    io::Error::new(error.kind(), own)
}

/// Locks `new`. False where another process took it, while it was not locked yet, for one that was left.
fn is_locked_in_time(new: &File) -> io::Result<bool> {
    match new.try_lock() {
        Err(TryLockError::WouldBlock) => Ok(false),
        Ok(()) | Err(TryLockError::Error(_)) => Ok(new.metadata()?.nlink() > 0),
    }
}

/// Removes from `folder` what processes that were killed have left in it, as far as that can be done.
fn remove_what_was_left(folder: &Path) {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    for entry in entries.filter(|entry| is_temporary(&entry.file_name().to_string_lossy())) {
        let (path, is_folder) = (entry.path(), entry.file_type().is_ok_and(|it| it.is_dir()));
        let flags = rustix::fs::OFlags::NOFOLLOW | rustix::fs::OFlags::NONBLOCK;
        let mut options = OpenOptions::new();
        options.read(true).write(!is_folder);
        let opened = options.custom_flags(flags.bits() as i32).open(&path);
        if opened.is_ok_and(|there| there.try_lock().is_ok()) {
            let _ = if is_folder {
                fs::remove_dir_all(path)
            } else {
                fs::remove_file(path)
            };
        }
    }
}

fn is_temporary(name: &str) -> bool {
    let rest = name.strip_prefix(PREFIX);
    let drawn = rest
        .and_then(|rest| rest.strip_suffix(SUFFIX))
        .unwrap_or("");
    drawn.len() == DRAWN && drawn.bytes().all(|byte| byte.is_ascii_alphanumeric())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::os::unix::fs::PermissionsExt;

    #[test]
    fn what_nobody_writes_any_more_is_removed_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let permissions = Permissions::from_mode(0o700);
        let file = file_in(folder.path(), &permissions).unwrap();
        let (inner, _lock) = folder_in(folder.path(), &permissions).unwrap();
        for own in [".gyrolab-notes.part", ".gyrolab-a1b2c3", "run.csv"] {
            fs::write(folder.path().join(own), "mine").unwrap();
        }
        for left in [".gyrolab-a1b2c3.part", ".gyrolab-d4e5f6.part"] {
            fs::write(folder.path().join(left), "left").unwrap();
        }
        fs::create_dir(folder.path().join(".gyrolab-F00000.part")).unwrap();
        drop(file_in(folder.path(), &permissions).unwrap());
        assert!(file.path().exists() && inner.path().exists());
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 5);
    }
}
