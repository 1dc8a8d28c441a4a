//! The files of the sessions in their folder, and which of them are ours.
//!
//! ```text
//! ID.lock    held by the process whose session it is; kill -9 frees it
//! ID.work    revision n, the work, and the place as it was then
//! ID.place   revision n, the place: it belongs to the work of that revision and to no other
//! ID.work.damaged, ID.place.damaged     what could not be read, kept
//! lock       held for a moment while sessions are chosen or cleared away
//! ```
//!
//! A file is written under another name and then renamed, so that it is always whole. Nothing is synced to the disk:
//! it is processes that die here, not machines, and the system keeps what a dead process has written. The ID is a number,
//! the one after the largest that is there; older versions had longer ones, with hyphens.

use super::{form, own};
use crate::text::printable::Shown;
use signal_hook::consts::SIGXFSZ;
use std::fs::{self, DirBuilder, File, OpenOptions, TryLockError};
use std::io::{self, Write};
use std::os::unix::fs::{DirBuilderExt, MetadataExt, OpenOptionsExt};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Once};
use std::thread;
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

/// How many sessions that are not in use are kept.
const MOST_KEPT: usize = 20;
/// How long another process may be busy choosing.
const PATIENCE: Duration = Duration::from_millis(200);

/// What is kept of the lab.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Content {
    /// The run and its journal, or whatever changes seldom: it is written only when it is another.
    pub work: Arc<str>,
    /// Where in it the lab stands: short.
    pub place: String,
}

/// Says whether a content can be read back as what it was kept of; else why not.
pub type Check = fn(&Content) -> Result<(), String>;

/// A session's files: ours as long as this lives.
pub(super) struct Slot {
    folder: PathBuf,
    id: String,
    lock: Lock,
    /// Of the work that is on the disk.
    revision: u64,
    written: Option<Content>,
}

/// What the files of a session hold.
pub(super) struct Stored {
    /// The work, and the place in it.
    pub content: Content,
    /// Of the work.
    pub revision: u64,
    /// Why the place written last could not be read: the content has an earlier one.
    pub damage: Option<String>,
}

/// A lock file that is locked.
pub(super) struct Lock(File);

impl Drop for Lock {
    /// Closing the file alone would leave it locked for as long as a process that is just being started has it too.
    fn drop(&mut self) {
        let _ = self.0.unlock();
    }
}

/// Something that could not be read: where it is now, and why.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct KeptAside {
    /// Where it has been put.
    pub path: PathBuf,
    /// What is wrong with it.
    pub reason: String,
}

/// Makes the folder if there is none, for the user's eyes only.
pub(super) fn make_folder(folder: &Path) -> io::Result<()> {
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

/// Has other processes wait that would choose a session or clear some away, but not for long: one of them may have been
/// stopped on the way. The locks of the sessions hold without it; it only lets nobody take a passing look for use.
pub(super) fn door(folder: &Path) -> Option<Lock> {
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

/// Whether the session `id` is the user's own.
///
/// # Errors
/// When it belongs to another.
pub(super) fn is_own(folder: &Path, id: &str) -> io::Result<()> {
    own::look(&file(folder, id, "work")).map(drop)
}

/// Whether a living process has the session `id`.
pub(super) fn is_in_use(folder: &Path, id: &str) -> bool {
    let lock = own::open(&file(folder, id, "lock"), OpenOptions::new().read(true));
    lock.is_ok_and(|lock| matches!(lock.try_lock_shared(), Err(TryLockError::WouldBlock)))
}

/// What the session `id` holds, whoever has it; and why the place in it had to be left out, if it had to be.
///
/// # Errors
/// Why it cannot be read.
pub(super) fn stored(folder: &Path, id: &str) -> Result<Stored, String> {
    let text = own::read(&file(folder, id, "work"))?;
    let (revision, carried, work) = form::parse_work(&text)
        .ok_or("it has been cut off or changed, or another version of gyrolab wrote it")?;
    let (place, damage) = match stored_place(folder, id, revision) {
        Ok(place) => (place, None),
        Err(reason) => (None, Some(reason)),
    };
    let content = Content {
        work: Arc::from(work),
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
    if !own::is_there(&path) {
        return Ok(None);
    }
    let text = own::read(&path)?;
    let (of, place) = form::parse_place(&text).ok_or("it has been cut off or changed")?;
    Ok((of == revision).then(|| place.to_owned()))
}

fn file(folder: &Path, id: &str, kind: &str) -> PathBuf {
    folder.join(format!("{id}.{kind}"))
}

/// Clears away all but the newest sessions, and what sessions without any work have left behind. What cannot be
/// cleared away stays.
pub(super) fn prune(folder: &Path) {
    let old = sessions(folder).unwrap_or_default();
    let own = old.iter().filter(|id| is_own(folder, id).is_ok());
    let free = own.filter_map(|id| Slot::take(folder, id).ok()?);
    free.skip(MOST_KEPT).for_each(Slot::remove);
    for name in names(folder).unwrap_or_default() {
        if let Some(id) = name.strip_suffix(".lock")
            && !own::is_there(&file(folder, id, "work"))
            && let Ok(Some(slot)) = Slot::take(folder, id)
        {
            slot.remove();
        }
    }
}

/// A write past `ulimit -f` is an error from now on, like one to a full disk, and not the end of the process.
fn outlive_the_file_limit() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let _ = signal_hook::flag::register(SIGXFSZ, Arc::default());
    });
}

/// The lock at `path`, or `None` where a living process has it. Where the file system knows no locks it counts as free.
fn take(path: &Path) -> io::Result<Option<Lock>> {
    outlive_the_file_limit();
    let mut options = OpenOptions::new();
    options.write(true).create(true).truncate(false).mode(0o600);
    let mut lock = own::open(path, &mut options)?;
    match lock.try_lock() {
        Err(TryLockError::WouldBlock) => Ok(None),
        // Its last owner may have removed it between the two calls: then it is a lock to nothing.
        Ok(()) | Err(TryLockError::Error(_)) => {
            // For who finds it in use; where that cannot be written nobody is told.
            let _ = lock
                .set_len(0)
                .and_then(|()| write!(lock, "{}", std::process::id()));
            let lock = Lock(lock);
            Ok(is_at(&lock.0, path).then_some(lock))
        }
    }
}

/// The number of the process that has the session `id`, as far as it can be told.
pub(super) fn owner(folder: &Path, id: &str) -> Option<u32> {
    own::read(&file(folder, id, "lock")).ok()?.parse().ok()
}

fn is_at(file: &File, path: &Path) -> bool {
    let identity = |of: fs::Metadata| (of.dev(), of.ino());
    match (file.metadata(), fs::symlink_metadata(path)) {
        (Ok(ours), Ok(there)) => identity(ours) == identity(there),
        _ => false,
    }
}

impl Slot {
    /// A session that is not there yet.
    pub(super) fn new(folder: &Path) -> io::Result<Self> {
        let number = |name: &String| name.split('.').next()?.parse::<u32>().ok();
        let largest = names(folder)?.iter().filter_map(number).max();
        let mut number = largest.unwrap_or(0);
        loop {
            number = number.wrapping_add(1);
            let id = number.to_string();
            let is_new = || !own::is_there(&file(folder, &id, "work"));
            // Another process may have begun it, or even ended it, between two of these calls.
            if is_new()
                && !own::is_there(&file(folder, &id, "lock"))
                && let Some(slot) = Self::take(folder, &id)?
                && is_new()
            {
                return Ok(slot);
            }
        }
    }

    /// The session `id`, or `None` where a living process has it.
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

    /// What the session is called.
    pub(super) fn id(&self) -> &str {
        &self.id
    }

    /// Writes what has changed since it was written last, a work only if `check` accepts it. When that fails, what was
    /// there before is still there.
    pub(super) fn save(&mut self, content: &Content, check: Option<Check>) -> io::Result<()> {
        match self.save_changes(content, check) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                self.make_again()?;
                self.save_changes(content, check)?;
            }
            saved => saved?,
        }
        self.written = Some(content.clone());
        Ok(())
    }

    fn save_changes(&mut self, content: &Content, check: Option<Check>) -> io::Result<()> {
        match &self.written {
            Some(written) if same(&written.work, &content.work) => self.save_place(&content.place),
            _ => {
                check.map_or(Ok(()), |check| check(content).map_err(io::Error::other))?;
                self.save_work(content)
            }
        }
    }

    /// Somebody has cleared the folder away: all of it is to be written anew.
    fn make_again(&mut self) -> io::Result<()> {
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
        let head = form::head_of_work(revision, place, work);
        own::replace(&self.file("work"), &[&head, place, work])?;
        self.revision = revision;
        Ok(())
    }

    fn save_place(&mut self, place: &str) -> io::Result<()> {
        let head = form::head_of_place(self.revision, place);
        own::replace(&self.file("place"), &[&head, place])
    }

    /// Reads the session, and what of it had to be put aside; or says why it cannot be read.
    pub(super) fn load(&mut self) -> Result<(Content, Option<KeptAside>), String> {
        let stored = stored(&self.folder, &self.id)?;
        let aside = stored.damage.map(|reason| self.put_aside("place", reason));
        self.revision = stored.revision;
        self.written = Some(stored.content.clone());
        Ok((stored.content, aside))
    }

    /// What is on the disk.
    ///
    /// # Errors
    /// Why it cannot be read.
    pub(super) fn read_back(&self) -> Result<Content, String> {
        let stored = stored(&self.folder, &self.id)?;
        stored.damage.map_or(Ok(stored.content), Err)
    }

    /// Gives the session's files other names, so that they are neither read again nor lost.
    pub(super) fn put_all_aside(self, reason: String) -> KeptAside {
        if own::is_there(&self.file("place")) {
            let _ = self.put_aside("place", String::new());
        }
        let aside = self.put_aside("work", reason);
        if !own::is_there(&self.file("work")) {
            self.remove();
        }
        aside
    }

    fn put_aside(&self, kind: &str, reason: String) -> KeptAside {
        let from = self.file(kind);
        let free = (1_u32..)
            .map(|n| match n {
                1 => self.file(&format!("{kind}.damaged")),
                n => self.file(&format!("{kind}.damaged-{n}")),
            })
            .find(|path| !own::is_there(path));
        match free.map(|to| fs::rename(&from, &to).map(|()| to)) {
            Some(Ok(path)) => KeptAside { path, reason },
            Some(Err(error)) => KeptAside {
                path: from,
                reason: format!("{reason}; nor can it be renamed: {error}"),
            },
            None => KeptAside { path: from, reason },
        }
    }

    /// Removes the session. The lock goes last: until then the session is ours.
    pub(super) fn remove(self) {
        ["work.new", "place.new", "place", "work", "lock"]
            .into_iter()
            .for_each(|kind| {
                let _ = fs::remove_file(self.file(kind));
            });
        drop(self.lock);
    }

    /// Whether there is nothing to come back to.
    pub(super) fn is_empty(&self) -> bool {
        self.written.is_none() && self.revision == 0
    }
}

/// The pointer tells at once in nearly every case; the text where the same work has been written down anew.
fn same(one: &Arc<str>, other: &Arc<str>) -> bool {
    Arc::ptr_eq(one, other) || one == other
}
