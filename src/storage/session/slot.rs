//! The files of the sessions in their folder, and the locks that say which process holds which session.
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

use super::text::Text;
use super::{format, own};
use crate::text::printable::Shown;
use signal_hook::consts::SIGXFSZ;
use std::fs::{self, DirBuilder, File, OpenOptions, TryLockError};
use std::io::{self, Write};
use std::os::unix::fs::{DirBuilderExt, MetadataExt, OpenOptionsExt};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Once};
use std::thread;
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

/// The most unused sessions that are kept.
const MOST_KEPT: usize = 20;
/// How long to wait for the folder's lock.
const PATIENCE: Duration = Duration::from_millis(200);

/// The content of a session, as two texts.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Content {
    /// What changes seldom, such as the runs and their journals. It may be long and is saved only when it has changed.
    pub work: Text,
    /// What changes all the time, such as the step at which the lab stands. It is short.
    pub place: String,
}

/// Checks whether a content can be read back as what was saved; else says why not.
pub type Check = fn(&Content) -> Result<(), String>;

/// The files of one session, locked by this process as long as this value lives.
pub(super) struct Slot {
    folder: PathBuf,
    id: String,
    lock: Lock,
    /// Revision of the work on the disk.
    revision: u64,
    written: Option<Content>,
}

/// What was read from the files of a session.
pub(super) struct Stored {
    /// The work and the place.
    pub content: Content,
    /// Revision of the work.
    pub revision: u64,
    /// Why the place file could not be read, if so; the content then has the older place from the work file.
    pub damage: Option<String>,
}

/// A lock file that is locked.
pub(in crate::storage) struct Lock(File);

impl Drop for Lock {
    /// Unlocks explicitly: closing alone keeps the lock while a child process that is just being started still has the
    /// file open.
    fn drop(&mut self) {
        let _ = self.0.unlock();
    }
}

/// A file that could not be read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct KeptAside {
    /// Its present path: a new name if it was renamed.
    pub path: PathBuf,
    /// Why it could not be read.
    pub reason: String,
}

/// Creates the folder if it does not exist, accessible to the user alone.
pub(in crate::storage) fn make_folder(folder: &Path) -> io::Result<()> {
    DirBuilder::new()
        .recursive(true)
        .mode(0o700)
        .create(folder)
        .and_then(|()| own::check_folder(folder))
        .map_err(|error| {
            let text = format!("sessions cannot be kept in {}: {error}", Shown(folder));
            io::Error::new(error.kind(), text)
        })
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

fn names(folder: &Path) -> io::Result<Vec<String>> {
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

/// Reads the session `id`, whether or not a process holds it.
///
/// # Errors
/// Why the work file cannot be read.
pub(super) fn stored(folder: &Path, id: &str) -> Result<Stored, String> {
    let text = own::read(&file(folder, id, "work"))?;
    let (revision, carried, work) = format::parse_work(&text)
        .ok_or("it has been cut off or changed, or another version of gyrolab wrote it")?;
    let (place, damage) = match stored_place(folder, id, revision) {
        Ok(place) => (place, None),
        Err(reason) => (None, Some(reason)),
    };
    let content = Content {
        work: Text::from(work),
        place: place.unwrap_or_else(|| carried.to_owned()),
    };
    Ok(Stored {
        content,
        revision,
        damage,
    })
}

/// The place written last, if it belongs to the work of that `revision`.
fn stored_place(folder: &Path, id: &str, revision: u64) -> Result<Option<String>, String> {
    let path = file(folder, id, "place");
    if !own::exists(&path) {
        return Ok(None);
    }
    let text = own::read(&path)?;
    let (of, place) = format::parse_place(&text).ok_or("it has been cut off or changed")?;
    Ok((of == revision).then(|| place.to_owned()))
}

fn file(folder: &Path, id: &str, kind: &str) -> PathBuf {
    folder.join(format!("{id}.{kind}"))
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

/// Handles SIGXFSZ, so that a write past `ulimit -f` fails, like one to a full disk, instead of ending the process.
fn handle_file_size_signal() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let _ = signal_hook::flag::register(SIGXFSZ, Arc::default());
    });
}

/// Locks the file at `path`; `None` if a running process holds the lock. On a file system without locks it always succeeds.
fn take(path: &Path) -> io::Result<Option<Lock>> {
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

/// The number of the process that holds, or last held, the session `id`; `None` where its lock file does not tell.
pub(super) fn owner(folder: &Path, id: &str) -> Option<u32> {
    own::read(&file(folder, id, "lock")).ok()?.parse().ok()
}

/// Whether the file at `path` is still `file`.
fn is_same_file(file: &File, path: &Path) -> bool {
    let identity = |of: fs::Metadata| (of.dev(), of.ino());
    match (file.metadata(), fs::symlink_metadata(path)) {
        (Ok(ours), Ok(there)) => identity(ours) == identity(there),
        _ => false,
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
        let lock = take(&file(folder, id, "lock"))?;
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
        if let Some(lock) = take(&self.file("lock"))? {
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
