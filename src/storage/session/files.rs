//! The files of the sessions in their folder: which there are, when each was written last, and which process holds it.

use super::own;
use crate::text::printable::Shown;
use std::fs::{self, DirBuilder, OpenOptions, TryLockError};
use std::io;
use std::os::unix::fs::DirBuilderExt;
use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};

/// Creates the folder if it does not exist, accessible to the user alone.
pub(in crate::storage) fn make_folder(folder: &Path) -> io::Result<()> {
    DirBuilder::new()
        .recursive(true)
        .mode(0o700)
        .create(folder)
        .and_then(|()| own::check_folder(folder))
        .map_err(|error| not_kept(folder, &error))
}

/// Says that sessions cannot be kept in `folder`, because of `error`.
pub(super) fn not_kept(folder: &Path, error: &io::Error) -> io::Error {
    let text = format!("sessions cannot be kept in {}: {error}", Shown(folder));
    io::Error::new(error.kind(), text)
}

/// The sessions in `folder`, the one written last first.
pub(super) fn sessions(folder: &Path) -> io::Result<Vec<String>> {
    own::check_folder(folder)?;
    let mut found: Vec<_> = names(folder)?
        .iter()
        .filter_map(|name| name.strip_suffix(".work"))
        .map(|id| (written_at(folder, id), id.to_owned()))
        .collect();
    found.sort_unstable();
    Ok(found.into_iter().rev().map(|(_, id)| id).collect())
}

/// The names of all files in `folder`.
pub(super) fn names(folder: &Path) -> io::Result<Vec<String>> {
    let names =
        fs::read_dir(folder)?.filter_map(|entry| entry.ok()?.file_name().into_string().ok());
    Ok(names.collect())
}

/// When the session `id` was written last.
pub(super) fn written_at(folder: &Path, id: &str) -> SystemTime {
    let modified = |kind| {
        fs::symlink_metadata(file(folder, id, kind))
            .ok()?
            .modified()
            .ok()
    };
    let times = ["work", "place"].into_iter().filter_map(modified);
    times.max().unwrap_or(UNIX_EPOCH)
}

/// Checks that the session `id` is the user's own.
///
/// # Errors
/// When it belongs to another user.
pub(super) fn check_own(folder: &Path, id: &str) -> io::Result<()> {
    own::metadata(&file(folder, id, "work")).map(drop)
}

/// Whether a running process holds the session `id`.
pub(super) fn is_in_use(folder: &Path, id: &str) -> bool {
    let lock = own::open(&file(folder, id, "lock"), OpenOptions::new().read(true));
    lock.is_ok_and(|lock| matches!(lock.try_lock_shared(), Err(TryLockError::WouldBlock)))
}

/// The number of the process that holds, or last held, the session `id`; `None` where its lock file does not tell.
pub(super) fn owner(folder: &Path, id: &str) -> Option<u32> {
    own::read(&file(folder, id, "lock")).ok()?.parse().ok()
}

/// The file of the session `id` whose name ends in `kind`.
pub(super) fn file(folder: &Path, id: &str, kind: &str) -> PathBuf {
    folder.join(format!("{id}.{kind}"))
}
