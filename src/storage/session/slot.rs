//! The files of one session, and the lock by which this process holds it.
//!
//! ```text
//! ID.lock               locked by the process that holds the session; kill -9 unlocks it
//! ID.session            the place and the work
//! ID.session.damaged    a file that could not be read
//! lock                  locked for a moment while a process chooses or removes sessions
//! ```
//!
//! A session begins with three lines, and the two texts follow:
//!
//! ```text
//! gyrolab session 3
//! sum 8d4f1d92          CRC-32 of all that follows this line
//! place 204             bytes of the place
//! ```
//!
//! The number in the first line is raised when the format or what the texts hold changes; sessions of other numbers, and
//! of the versions that wrote ID.work, are left alone. Nothing is synced to the disk: sessions must survive the death of
//! the process, not of the machine. The ID of a new session is one more than the largest number in the folder.

use super::lock::{self, Lock};
use super::{Content, make_folder, own};
use crate::storage::session::Text;
use std::fs::{self, OpenOptions, TryLockError};
use std::io;
use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};

/// The most unused sessions that are kept.
const MOST_KEPT: usize = 20;

const FORMAT: &str = "gyrolab session 3";
const OTHER_VERSION: &str = "another version of gyrolab wrote it";

/// The files of one session, locked by this process as long as this value lives.
pub(super) struct Slot {
    folder: PathBuf,
    id: String,
    lock: Lock,
}

/// A file that could not be read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct KeptAside {
    /// Its present path: a new name if it was renamed.
    pub path: PathBuf,
    /// Why it could not be read.
    pub reason: String,
}

/// Why a session cannot be read.
pub(super) enum Unread {
    /// It is not this program's to judge: another user's, no regular file, or another version's.
    Foreign(String),
    /// It was cut off or changed.
    Damaged,
}

impl Unread {
    pub(super) fn reason(self) -> String {
        match self {
            Self::Foreign(reason) => reason,
            Self::Damaged => "it has been cut off or changed".to_owned(),
        }
    }
}

/// The file of the session `id` whose name ends in `kind`.
fn file(folder: &Path, id: &str, kind: &str) -> PathBuf {
    folder.join(format!("{id}.{kind}"))
}

/// The file that holds the session `id`.
pub(super) fn file_of(folder: &Path, id: &str) -> PathBuf {
    let present = file(folder, id, "session");
    let earlier = file(folder, id, "work");
    if !exists(&present) && exists(&earlier) {
        earlier
    } else {
        present
    }
}

/// Whether there is anything at `path`; a symbolic link to nothing counts too.
fn exists(path: &Path) -> bool {
    fs::symlink_metadata(path).is_ok()
}

/// The names of all files in `folder`.
fn names(folder: &Path) -> io::Result<Vec<String>> {
    let names =
        fs::read_dir(folder)?.filter_map(|entry| entry.ok()?.file_name().into_string().ok());
    Ok(names.collect())
}

/// The sessions in `folder`, the one written last first.
pub(super) fn sessions(folder: &Path) -> io::Result<Vec<String>> {
    let mut found: Vec<_> = names(folder)?
        .iter()
        .filter_map(|name| {
            name.strip_suffix(".session")
                .or_else(|| name.strip_suffix(".work"))
        })
        .map(|id| (written_at(folder, id), id.to_owned()))
        .collect();
    found.sort_unstable();
    Ok(found.into_iter().rev().map(|(_, id)| id).collect())
}

/// When the session `id` was written last; the beginning of 1970 if there is none.
pub(super) fn written_at(folder: &Path, id: &str) -> SystemTime {
    let there = fs::symlink_metadata(file_of(folder, id));
    there
        .and_then(|there| there.modified())
        .unwrap_or(UNIX_EPOCH)
}

/// Whether a running process holds the session `id`.
pub(super) fn is_in_use(folder: &Path, id: &str) -> bool {
    let lock = own::open(&file(folder, id, "lock"), OpenOptions::new().read(true));
    lock.is_ok_and(|lock| matches!(lock.try_lock_shared(), Err(TryLockError::WouldBlock)))
}

/// The number of the process that holds, or last held, the session `id`; `None` where its lock file does not tell.
pub(super) fn owner(folder: &Path, id: &str) -> Option<u32> {
    let bytes = own::read(&file(folder, id, "lock")).ok()?;
    str::from_utf8(&bytes).ok()?.parse().ok()
}

/// Reads the session `id`, whether or not a process holds it.
pub(super) fn stored(folder: &Path, id: &str) -> Result<Content, Unread> {
    let bytes = own::read(&file_of(folder, id));
    let bytes = bytes.map_err(|error| Unread::Foreign(error.to_string()))?;
    let text = String::from_utf8(bytes).map_err(|_| Unread::Damaged)?;
    match text.split_once('\n') {
        Some((FORMAT, rest)) => content(rest).ok_or(Unread::Damaged),
        Some((other, _)) if other.starts_with("gyrolab session ") => {
            Err(Unread::Foreign(OTHER_VERSION.to_owned()))
        }
        _ => Err(Unread::Damaged),
    }
}

/// The content from the text of a session behind its first line; `None` if it is incomplete or changed.
fn content(text: &str) -> Option<Content> {
    let (sum, summed) = text.split_once('\n')?;
    if sum != sum_line(&[summed]) {
        return None;
    }
    let (length, texts) = summed.split_once('\n')?;
    let length = length.strip_prefix("place ")?.parse().ok()?;
    let (place, work) = texts.split_at_checked(length)?;
    Some(Content {
        work: Text::from(work),
        place: place.to_owned(),
    })
}

fn sum_line(parts: &[&str]) -> String {
    let mut sum = crc32fast::Hasher::new();
    for part in parts {
        sum.update(part.as_bytes());
    }
    format!("sum {:08x}", sum.finalize())
}

/// Removes all but the newest unused sessions, and lock files without a session. What cannot be removed stays.
pub(super) fn prune(folder: &Path) {
    let mut old = sessions(folder).unwrap_or_default();
    old.retain(|id| {
        let path = file(folder, id, "session");
        own::open(&path, OpenOptions::new().read(true)).is_ok()
    });
    let free = old.iter().filter_map(|id| Slot::take(folder, id).ok()?);
    free.skip(MOST_KEPT).for_each(Slot::remove);
    for name in names(folder).unwrap_or_default() {
        if let Some(id) = name.strip_suffix(".lock")
            && !exists(&file_of(folder, id))
            && let Ok(Some(slot)) = Slot::take(folder, id)
        {
            slot.remove();
        }
    }
}

impl Slot {
    /// A new session with an unused ID.
    pub(super) fn new(folder: &Path) -> io::Result<Self> {
        let number = |name: &String| name.split('.').next()?.parse::<u32>().ok();
        let largest = names(folder)?.iter().filter_map(number).max();
        let mut number = largest.unwrap_or(0);
        loop {
            number = number.wrapping_add(1);
            let id = number.to_string();
            let is_new = || !exists(&file_of(folder, &id));
            // Another process may have begun, or even ended, a session of this ID between two of these calls.
            if is_new()
                && !exists(&file(folder, &id, "lock"))
                && let Some(slot) = Self::take(folder, &id)?
                && is_new()
            {
                return Ok(slot);
            }
        }
    }

    /// Locks the session `id`; `None` if a running process holds it.
    pub(super) fn take(folder: &Path, id: &str) -> io::Result<Option<Self>> {
        let lock = lock::take(&file(folder, id, "lock"))?;
        Ok(lock.map(|lock| Self {
            folder: folder.to_owned(),
            id: id.to_owned(),
            lock,
        }))
    }

    fn file(&self, kind: &str) -> PathBuf {
        file(&self.folder, &self.id, kind)
    }

    /// Name of the session.
    pub(super) fn id(&self) -> &str {
        &self.id
    }

    /// Writes `content`. If writing fails, the old file is unchanged.
    pub(super) fn save(&mut self, content: &Content) -> io::Result<()> {
        let length = format!("place {}\n", content.place.len());
        let parts = [&*length, &content.place, &content.work];
        let head = format!("{FORMAT}\n{}\n", sum_line(&parts));
        let [length, place, work] = parts;
        let write = |path: &Path| own::replace(path, &[&head, length, place, work]);
        match write(&self.file("session")) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                // Somebody has removed the folder.
                make_folder(&self.folder)?;
                if let Some(lock) = lock::take(&self.file("lock"))? {
                    self.lock = lock;
                }
                write(&self.file("session"))
            }
            saved => saved,
        }
    }

    /// Renames the session's file, so that it is neither read again nor lost, and gives the session up.
    pub(super) fn put_aside(self, reason: String) -> KeptAside {
        let (from, to) = (self.file("session"), self.file("session.damaged"));
        match fs::rename(&from, &to) {
            Ok(()) => {
                self.remove();
                KeptAside { path: to, reason }
            }
            Err(error) => KeptAside {
                path: from,
                reason: format!("{reason}; nor can it be renamed: {error}"),
            },
        }
    }

    /// Removes the session's files, the lock file last: until then no other process can take the session.
    pub(super) fn remove(self) {
        for kind in ["session", "lock"] {
            let _ = fs::remove_file(self.file(kind));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_changed_byte_is_detected() {
        let folder = tempfile::tempdir().unwrap();
        let mut slot = Slot::new(folder.path()).unwrap();
        let wanted = Content {
            work: Text::from("title = \"Größe\"\nform = 2\n"),
            place: "step = 12\n".to_owned(),
        };
        slot.save(&wanted).unwrap();
        let path = slot.file("session");
        let bytes = fs::read(&path).unwrap();
        let read = |bytes: &[u8]| {
            fs::write(&path, bytes).unwrap();
            stored(folder.path(), slot.id()).ok()
        };
        assert_eq!(read(&bytes), Some(wanted));
        for bit in 0..8 * bytes.len() {
            let mut changed = bytes.clone();
            changed[bit / 8] ^= 1 << (bit % 8);
            assert_eq!(read(&changed), None, "bit {bit}");
        }
        for end in 0..bytes.len() {
            assert_eq!(read(&bytes[..end]), None, "cut at {end}");
        }
    }
}
