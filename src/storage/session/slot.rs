//! The files of one session, and the lock by which this process holds it.
//!
//! ```text
//! ID.lock    locked by the process that holds the session; kill -9 unlocks it
//! ID.work    revision n, the work, and the place as it was then
//! ID.place   revision n, the place: it belongs to the work of that revision and to no other
//! ID.work.damaged, ID.place.damaged     files that could not be read
//! lock       locked for a moment while a process chooses or removes sessions
//! ```
//!
//! A file is written under a temporary name and then renamed, so that it is always complete. Nothing is synced to the disk:
//! sessions must survive the death of the process, not of the machine, and the system keeps what a dead process has
//! written. The ID of a new session is one more than the largest number in the folder; older versions had longer IDs with
//! hyphens.

use super::content::{Check, Content, stored};
use super::files::{check_own, file, make_folder, names, sessions};
use super::lock::{self, Lock};
use super::{format, own};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// The most unused sessions that are kept.
const MOST_KEPT: usize = 20;
/// The files of one session, locked by this process as long as this value lives.
pub(super) struct Slot {
    folder: PathBuf,
    id: String,
    lock: Lock,
    /// Revision of the work on the disk.
    revision: u64,
    written: Option<Content>,
}

/// A file that could not be read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct KeptAside {
    /// Its present path: a new name if it was renamed.
    pub path: PathBuf,
    /// Why it could not be read.
    pub reason: String,
}

/// Removes all but the newest unused sessions, and lock files of sessions without a work file. What cannot be removed
/// stays.
pub(super) fn prune(folder: &Path) {
    let old = sessions(folder).unwrap_or_default();
    let own = old.iter().filter(|id| check_own(folder, id).is_ok());
    let free = own.filter_map(|id| Slot::take(folder, id).ok()?);
    free.skip(MOST_KEPT).for_each(Slot::remove);
    for name in names(folder).unwrap_or_default() {
        if let Some(id) = name.strip_suffix(".lock")
            && !own::exists(&file(folder, id, "work"))
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
            let is_new = || !own::exists(&file(folder, &id, "work"));
            // Another process may have begun, or even ended, a session of this ID between two of these calls.
            if is_new()
                && !own::exists(&file(folder, &id, "lock"))
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
            revision: 0,
            written: None,
        }))
    }

    fn file(&self, kind: &str) -> PathBuf {
        file(&self.folder, &self.id, kind)
    }

    /// Name of the session.
    pub(super) fn id(&self) -> &str {
        &self.id
    }

    /// Writes the work or the place, whichever has changed; a work only if `check` accepts the content. If writing fails,
    /// the old files are unchanged.
    pub(super) fn save(&mut self, content: &Content, check: Option<Check>) -> io::Result<()> {
        match self.save_changes(content, check) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                self.create_again()?;
                self.save_changes(content, check)?;
            }
            saved => saved?,
        }
        self.written = Some(content.clone());
        Ok(())
    }

    fn save_changes(&mut self, content: &Content, check: Option<Check>) -> io::Result<()> {
        match &self.written {
            Some(written) if written.work == content.work => self.save_place(&content.place),
            _ => {
                check.map_or(Ok(()), |check| check(content).map_err(io::Error::other))?;
                self.save_work(content)
            }
        }
    }

    /// Creates the folder and the lock again after somebody has removed the folder; everything is then written anew.
    fn create_again(&mut self) -> io::Result<()> {
        make_folder(&self.folder)?;
        if let Some(lock) = lock::take(&self.file("lock"))? {
            self.lock = lock;
        }
        self.written = None;
        Ok(())
    }

    fn save_work(&mut self, content: &Content) -> io::Result<()> {
        let (place, work) = (&content.place, &content.work);
        let revision = self.revision + 1;
        let head = format::head_of_work(revision, place, work);
        own::replace(&self.file("work"), &[&head, place, work])?;
        self.revision = revision;
        Ok(())
    }

    fn save_place(&mut self, place: &str) -> io::Result<()> {
        let head = format::head_of_place(self.revision, place);
        own::replace(&self.file("place"), &[&head, place])
    }

    /// Reads the session. A place file that cannot be read is renamed and returned too.
    ///
    /// # Errors
    /// Why the work file cannot be read.
    pub(super) fn load(&mut self) -> Result<(Content, Option<KeptAside>), String> {
        let stored = stored(&self.folder, &self.id)?;
        let aside = stored.damage.map(|reason| self.put_aside("place", reason));
        self.revision = stored.revision;
        self.written = Some(stored.content.clone());
        Ok((stored.content, aside))
    }

    /// Reads the content from the disk, without renaming anything.
    ///
    /// # Errors
    /// Why the work or the place cannot be read.
    pub(super) fn read_back(&self) -> Result<Content, String> {
        let stored = stored(&self.folder, &self.id)?;
        stored.damage.map_or(Ok(stored.content), Err)
    }

    /// Renames the session's files, so that they are neither read again nor lost, and removes the rest of the session.
    pub(super) fn put_all_aside(self, reason: String) -> KeptAside {
        if own::exists(&self.file("place")) {
            let _ = self.put_aside("place", String::new());
        }
        let aside = self.put_aside("work", reason);
        if !own::exists(&self.file("work")) {
            self.remove();
        }
        aside
    }

    /// Renames one file of the session; the new name ends in `.damaged` or `.damaged-N`.
    fn put_aside(&self, kind: &str, reason: String) -> KeptAside {
        let from = self.file(kind);
        let free = (1_u32..)
            .map(|n| match n {
                1 => self.file(&format!("{kind}.damaged")),
                n => self.file(&format!("{kind}.damaged-{n}")),
            })
            .find(|path| !own::exists(path));
        match free.map(|to| fs::rename(&from, &to).map(|()| to)) {
            Some(Ok(path)) => KeptAside { path, reason },
            Some(Err(error)) => KeptAside {
                path: from,
                reason: format!("{reason}; nor can it be renamed: {error}"),
            },
            None => KeptAside { path: from, reason },
        }
    }

    /// Removes the session's files, the lock file last: until then no other process can take the session.
    pub(super) fn remove(self) {
        ["work.new", "place.new", "place", "work", "lock"]
            .into_iter()
            .for_each(|kind| {
                let _ = fs::remove_file(self.file(kind));
            });
        drop(self.lock);
    }

    /// Whether the session has never been saved.
    pub(super) fn is_empty(&self) -> bool {
        self.written.is_none() && self.revision == 0
    }
}
