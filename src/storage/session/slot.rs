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
//! it is processes that die here, not machines, and the system keeps what a dead process has written.

use crate::text::printable::Shown;
use std::fs::{self, DirBuilder, File, OpenOptions, TryLockError};
use std::io::{self, Write};
use std::os::unix::fs::{DirBuilderExt, MetadataExt, OpenOptionsExt};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread;
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

/// How many sessions that are not in use are kept.
const MOST_KEPT: usize = 20;
/// How long another process may be busy choosing.
const PATIENCE: Duration = Duration::from_millis(200);

const WORK: &str = "gyrolab session 1";
const PLACE: &str = "gyrolab place 1";

/// What is kept of the lab.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Content {
    /// The run and its journal, or whatever changes seldom: it is written only when it is another.
    pub work: Arc<str>,
    /// Where in it the lab stands: short.
    pub place: String,
}

/// A session's files: ours as long as this lives.
pub(super) struct Slot {
    folder: PathBuf,
    id: String,
    lock: Lock,
    /// Of the work that is on the disk.
    revision: u64,
    written: Option<Content>,
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

fn written_at(folder: &Path, id: &str) -> SystemTime {
    ["work", "place"]
        .into_iter()
        .filter_map(|kind| fs::metadata(file(folder, id, kind)).ok()?.modified().ok())
        .max()
        .unwrap_or(UNIX_EPOCH)
}

fn file(folder: &Path, id: &str, kind: &str) -> PathBuf {
    folder.join(format!("{id}.{kind}"))
}

/// Clears away all but the newest sessions, and what sessions without any work have left behind. What cannot be
/// cleared away stays.
pub(super) fn prune(folder: &Path) {
    let old = sessions(folder).unwrap_or_default();
    let free = old.iter().filter_map(|id| Slot::take(folder, id).ok()?);
    free.skip(MOST_KEPT).for_each(Slot::remove);
    for name in names(folder).unwrap_or_default() {
        if let Some(id) = name.strip_suffix(".lock")
            && !file(folder, id, "work").exists()
            && let Ok(Some(slot)) = Slot::take(folder, id)
        {
            slot.remove();
        }
    }
}

/// The lock at `path`, or `None` where a living process has it. Where the file system knows no locks it counts as free.
fn take(path: &Path) -> io::Result<Option<Lock>> {
    let mut lock = OpenOptions::new()
        .write(true)
        .create(true)
        .truncate(false)
        .mode(0o600)
        .open(path)?;
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
    fs::read_to_string(file(folder, id, "lock"))
        .ok()?
        .parse()
        .ok()
}

fn is_at(file: &File, path: &Path) -> bool {
    let identity = |of: fs::Metadata| (of.dev(), of.ino());
    match (file.metadata(), fs::metadata(path)) {
        (Ok(ours), Ok(there)) => identity(ours) == identity(there),
        _ => false,
    }
}

impl Slot {
    /// A session that is not there yet.
    pub(super) fn new(folder: &Path) -> io::Result<Self> {
        static COUNT: AtomicU64 = AtomicU64::new(0);
        loop {
            let since = SystemTime::now().duration_since(UNIX_EPOCH);
            let id = format!(
                "{:013}-{}-{}",
                since.unwrap_or_default().as_millis(),
                std::process::id(),
                COUNT.fetch_add(1, Ordering::Relaxed)
            );
            // Another process of that number, in another container, may have the folder too.
            let is_new = !file(folder, &id, "lock").exists() && !file(folder, &id, "work").exists();
            if is_new && let Some(slot) = Self::take(folder, &id)? {
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

    /// Writes what has changed since it was written last. When that fails, what was there before is still there.
    pub(super) fn save(&mut self, content: &Content) -> io::Result<()> {
        match self.save_changes(content) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                self.make_again()?;
                self.save_changes(content)?;
            }
            saved => saved?,
        }
        self.written = Some(content.clone());
        Ok(())
    }

    fn save_changes(&mut self, content: &Content) -> io::Result<()> {
        match &self.written {
            Some(written) if same(&written.work, &content.work) => self.save_place(&content.place),
            _ => self.save_work(content),
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
        let (place_bytes, work_bytes) = (place.len(), work.len());
        let head = format!("{WORK}\nrevision {revision}\nplace {place_bytes}\nwork {work_bytes}\n");
        replace(&self.file("work"), &[&head, place, work])?;
        self.revision = revision;
        Ok(())
    }

    fn save_place(&mut self, place: &str) -> io::Result<()> {
        let head = format!(
            "{PLACE}\nrevision {}\nplace {}\n",
            self.revision,
            place.len()
        );
        replace(&self.file("place"), &[&head, place])
    }

    /// Reads the session, and what of it had to be put aside; or says why it cannot be read.
    pub(super) fn load(&mut self) -> Result<(Content, Option<KeptAside>), String> {
        let text = read(&self.file("work"))?;
        let (revision, carried, work) = parse_work(&text)
            .ok_or("it has been cut off or changed, or another version of gyrolab wrote it")?;
        let (place, aside) = match self.load_place(revision) {
            Ok(place) => (place, None),
            Err(reason) => (None, Some(self.put_aside("place", reason))),
        };
        let content = Content {
            work: Arc::from(work),
            place: place.unwrap_or_else(|| carried.to_owned()),
        };
        self.revision = revision;
        self.written = Some(content.clone());
        Ok((content, aside))
    }

    /// The place written last, if it belongs to the work of that `revision`.
    fn load_place(&self, revision: u64) -> Result<Option<String>, String> {
        let path = self.file("place");
        if !path.exists() {
            return Ok(None);
        }
        let text = read(&path)?;
        let (of, place) = parse_place(&text).ok_or("it has been cut off or changed")?;
        Ok((of == revision).then(|| place.to_owned()))
    }

    /// Gives the session's files other names, so that they are neither read again nor lost.
    pub(super) fn put_all_aside(self, reason: String) -> KeptAside {
        if self.file("place").exists() {
            let _ = self.put_aside("place", String::new());
        }
        let aside = self.put_aside("work", reason);
        if !self.file("work").exists() {
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
            .find(|path| !path.exists());
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

fn replace(path: &Path, parts: &[&str]) -> io::Result<()> {
    let mut temporary = path.as_os_str().to_owned();
    temporary.push(".new");
    let temporary = Path::new(&temporary);
    let written = write(temporary, parts).and_then(|()| fs::rename(temporary, path));
    if written.is_err() {
        let _ = fs::remove_file(temporary); // on a full disk it would be in the way
    }
    written
}

fn write(path: &Path, parts: &[&str]) -> io::Result<()> {
    let mut file = OpenOptions::new()
        .write(true)
        .create(true)
        .truncate(true)
        .mode(0o600)
        .open(path)?;
    parts
        .iter()
        .try_for_each(|part| file.write_all(part.as_bytes()))
}

fn read(path: &Path) -> Result<String, String> {
    match fs::metadata(path) {
        Ok(there) if !there.is_file() => return Err("it is not a file".to_owned()),
        _ => {}
    }
    fs::read_to_string(path).map_err(|error| match error.kind() {
        io::ErrorKind::InvalidData => "it is not UTF-8 text".to_owned(),
        _ => format!("it cannot be read: {error}"),
    })
}

fn parse_work(text: &str) -> Option<(u64, &str, &str)> {
    let rest = text.strip_prefix(WORK)?.strip_prefix('\n')?;
    let (revision, rest) = number("revision ", rest)?;
    let (place, rest) = number("place ", rest)?;
    let (work, rest) = number("work ", rest)?;
    let (place, rest) = rest.split_at_checked(usize::try_from(place).ok()?)?;
    (rest.len() as u64 == work).then_some((revision, place, rest))
}

fn parse_place(text: &str) -> Option<(u64, &str)> {
    let rest = text.strip_prefix(PLACE)?.strip_prefix('\n')?;
    let (revision, rest) = number("revision ", rest)?;
    let (place, rest) = number("place ", rest)?;
    (rest.len() as u64 == place).then_some((revision, rest))
}

/// The number on a line of its own after `name`, and what follows that line.
fn number<'a>(name: &str, text: &'a str) -> Option<(u64, &'a str)> {
    let (line, rest) = text.split_once('\n')?;
    Some((line.strip_prefix(name)?.parse().ok()?, rest))
}
