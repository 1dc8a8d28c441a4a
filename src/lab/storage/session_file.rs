//! The files of one session, and the lock with which a process reserves it.
//!
//! ```text
//! N.session    the place and the work
//! N.lock       locked by the process that uses the session, and contains its ID; kill -9 unlocks it
//! ```
//!
//! A session file begins with three lines. The two texts follow:
//!
//! ```text
//! gyrolab session 5
//! sum 8d4f1d92          CRC-32 of everything after this line
//! place 204             length of the place, bytes
//! ```
//!
//! Raise the number in the first line when the format or the meaning of the texts changes. Nothing is synced to the
//! disk: sessions must survive a crash of the process, not of the machine.

use super::confined::SESSIONS;
use super::{private_files, shared};
use crate::engine::text::checksum::crc32;
use rustix::io::Errno;
use rustix::process::{Pid, test_kill_process};
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, Write};
use std::os::unix::fs::{MetadataExt, OpenOptionsExt};
use std::path::{Path, PathBuf};
use std::sync::{Arc, LazyLock};
use std::thread::sleep;
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

const SESSION_FORMAT: &str = "gyrolab session 5";
/// Maximum number of sessions that are kept, for a user, and for a login that several people share.
const MOST_KEPT_SESSIONS: usize = 20;
const MOST_SHARED_SESSIONS: usize = 200;
/// Maximum size of a session file, bytes.
const LONGEST_SESSION: usize = 64 << 20;
/// Maximum size of a lock file, bytes. It contains a process ID.
const LONGEST_LOCK: usize = 100;
/// Maximum duration of a lock by a process that only inspects the session. A longer lock means that the session is in
/// use.
const GLANCE: Duration = Duration::from_millis(10);
/// Time that the system may take to release the lock of a process that has ended. On a busy machine it is longer than
/// `GLANCE`.
const UNLOCKING: Duration = Duration::from_secs(1);

/// A text that is created when it is first read. Clones share it.
pub type SharedText = Arc<LazyLock<String, Box<dyn FnOnce() -> String + Send>>>;

pub fn later(write: impl FnOnce() -> String + Send + 'static) -> SharedText {
    Arc::new(LazyLock::new(Box::new(write)))
}

/// The content of a session.
#[derive(Clone, Debug)]
pub struct SessionContent {
    /// The part that rarely changes, such as the runs and their journals.
    pub work: SharedText,
    /// The part that changes all the time, such as the present step. It is short.
    pub place: String,
}

impl SessionContent {
    pub(super) fn is_same(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.work, &other.work) && self.place == other.place
    }
}

/// A session that this process has locked as long as this value exists.
pub(super) struct HeldSession {
    folder: PathBuf,
    name: String,
    lock: File,
}

pub(super) fn file(folder: &Path, name: &str, kind: &str) -> PathBuf {
    folder.join(format!("{name}.{kind}"))
}

/// Returns the names of the files in `folder` with the extension `kind`, without the extension.
fn names(folder: &Path, kind: &str) -> io::Result<Vec<String>> {
    let entries = match fs::read_dir(folder) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Vec::new()),
        entries => entries?,
    };
    Ok(entries
        .filter_map(|entry| {
            let file = entry.ok()?.file_name().into_string().ok()?;
            Some(file.strip_suffix(kind)?.strip_suffix('.')?.to_owned())
        })
        .collect())
}

/// Returns the names of the sessions in `folder`, the latest first.
pub(super) fn sessions(folder: &Path) -> io::Result<Vec<String>> {
    let mut names = names(folder, "session")?;
    names.sort_by_cached_key(|name| (written_at(folder, name), name.clone()));
    names.reverse();
    Ok(names)
}

/// Returns the time at which the session was last written; the beginning of 1970 if it does not exist.
pub(super) fn written_at(folder: &Path, name: &str) -> SystemTime {
    shared::modified(&file(folder, name, "session")).unwrap_or(UNIX_EPOCH)
}

pub(super) fn is_in_use(folder: &Path, name: &str) -> bool {
    let lock = private_files::open(&file(folder, name, "lock"), OpenOptions::new().read(true));
    lock.is_ok_and(|lock| matches!(lock.try_lock_shared(), Err(TryLockError::WouldBlock)))
}

/// Returns the ID of the process that uses, or last used, the session; `None` if its lock file does not contain one.
pub(super) fn owner(folder: &Path, name: &str) -> Option<u32> {
    let bytes = private_files::read(&file(folder, name, "lock"), LONGEST_LOCK).ok()?;
    str::from_utf8(&bytes).ok()?.parse().ok()
}

fn is_running(process: u32) -> bool {
    let id = i32::try_from(process).ok().and_then(Pid::from_raw);
    id.is_some_and(|id| test_kill_process(id) != Err(Errno::SRCH))
}

/// Reads the session, even if a process uses it.
pub(super) fn stored(folder: &Path, name: &str) -> Result<SessionContent, String> {
    let bytes = private_files::read(&file(folder, name, "session"), LONGEST_SESSION)
        .map_err(|error| error.to_string())?;
    let text = String::from_utf8(bytes).unwrap_or_default();
    let (format, rest) = text.split_once('\n').unwrap_or_default();
    if format != SESSION_FORMAT && format.starts_with("gyrolab session ") {
        return Err("another version of gyrolab wrote it".to_owned());
    }
    match content(rest) {
        Some(content) if format == SESSION_FORMAT => Ok(content),
        _ => Err("it has been cut off or changed".to_owned()),
    }
}

/// Parses the text of a session after its first line; `None` if it is incomplete or changed.
fn content(text: &str) -> Option<SessionContent> {
    let (sum, summed) = text.split_once('\n')?;
    if sum != sum_of(summed) {
        return None;
    }
    let (length, texts) = summed.strip_prefix("place ")?.split_once('\n')?;
    let (place, work) = texts.split_at_checked(length.parse().ok()?)?;
    Some(SessionContent {
        work: later({
            let work = work.to_owned();
            move || work
        }),
        place: place.to_owned(),
    })
}

fn sum_of(text: &str) -> String {
    format!("sum {:08x}", crc32(text.as_bytes()))
}

/// Removes all but the newest unused sessions, and lock files without a session. Files of another user stay.
pub(super) fn prune(folder: &Path) {
    let is_shared = folder.ends_with(SESSIONS);
    let mut left = if is_shared {
        MOST_SHARED_SESSIONS
    } else {
        MOST_KEPT_SESSIONS
    };
    for name in sessions(folder).unwrap_or_default() {
        let path = file(folder, &name, "session");
        if private_files::open(&path, OpenOptions::new().read(true)).is_ok()
            && let Ok(Some(held)) = HeldSession::lock(folder, &name)
        {
            match left.checked_sub(1) {
                Some(less) => left = less,
                None => held.remove(),
            }
        }
    }
    for name in names(folder, "lock").unwrap_or_default() {
        if !exists(&file(folder, &name, "session"))
            && let Ok(Some(held)) = HeldSession::lock(folder, &name)
        {
            held.remove();
        }
    }
}

/// Returns true if anything exists at `path`, even a dangling symbolic link.
fn exists(path: &Path) -> bool {
    fs::symlink_metadata(path).is_ok()
}

impl HeldSession {
    /// Creates a new session. Its name is one more than the largest number in the folder.
    pub(super) fn new(folder: &Path) -> io::Result<Self> {
        let used = [names(folder, "session")?, names(folder, "lock")?].concat();
        let numbers = used.iter().filter_map(|name| name.parse::<u64>().ok());
        let mut number = numbers.max().unwrap_or(0);
        loop {
            number = number.wrapping_add(1);
            let name = number.to_string();
            // Another process may have used the number meanwhile.
            if let Some(held) = Self::lock(folder, &name)?
                && !exists(&file(folder, &name, "session"))
            {
                return Ok(held);
            }
        }
    }

    /// Locks the session; `None` if a running process uses it. On a file system without locks this always succeeds.
    pub(super) fn lock(folder: &Path, name: &str) -> io::Result<Option<Self>> {
        let path = file(folder, name, "lock");
        let mut options = OpenOptions::new();
        options.write(true).create(true).truncate(false).mode(0o600);
        let mut lock = private_files::open(&path, &mut options)?;
        let begin = Instant::now();
        while let Err(TryLockError::WouldBlock) = lock.try_lock() {
            let has_ended = owner(folder, name).is_some_and(|process| !is_running(process));
            if begin.elapsed() > if has_ended { UNLOCKING } else { GLANCE } {
                return Ok(None);
            }
            sleep(Duration::from_millis(1));
        }
        // The previous owner may have removed the file between opening and locking.
        let is_there = fs::symlink_metadata(&path);
        if is_there.is_ok_and(|there| lock.metadata().is_ok_and(|own| own.ino() == there.ino())) {
            // The process ID is for messages of other processes. The lock works without it.
            let written = lock.set_len(0);
            let _ = written.and_then(|()| write!(lock, "{}", std::process::id()));
            Ok(Some(Self {
                folder: folder.to_owned(),
                name: name.to_owned(),
                lock,
            }))
        } else {
            Ok(None)
        }
    }

    pub(super) fn name(&self) -> &str {
        &self.name
    }

    /// Writes `content`. If this fails, the old file is unchanged.
    pub(super) fn save(&self, content: &SessionContent) -> io::Result<()> {
        // The folder may have been removed. If its parent is gone too, such as the seat of a class, do not create it
        // again.
        if self.folder.parent().is_some_and(Path::is_dir) {
            private_files::make_folder(&self.folder)?;
        }
        let SessionContent { place, work } = content;
        let texts = format!("place {}\n{place}{}", place.len(), work.as_str());
        let path = file(&self.folder, &self.name, "session");
        let text = format!("{SESSION_FORMAT}\n{}\n{texts}", sum_of(&texts));
        if text.len() > LONGEST_SESSION {
            return Err(io::Error::other(format!(
                "it would be longer than {LONGEST_SESSION} bytes, the maximum for a session"
            )));
        }
        private_files::replace(&path, &text)
    }

    /// Removes the session's files. The lock file goes last, because no other process can open the session while it
    /// exists.
    pub(super) fn remove(self) {
        for kind in ["session", "lock"] {
            let _ = fs::remove_file(file(&self.folder, &self.name, kind));
        }
    }
}

impl Drop for HeldSession {
    /// Unlocks explicitly. Closing the file is not enough while a child process that is just being started still has it
    /// open.
    fn drop(&mut self) {
        let _ = self.lock.unlock();
    }
}
