//! A session: what the lab needs to resume where it was. It is saved to the disk while the lab runs, at most a second late,
//! so that it survives whatever ends the process.
//!
//! ```text
//! loop ─note→ Shared (the content to save) ←waits─ thread ─save→ Slot: the files of one session
//!                └─ flush: before the process ends, makes the thread save at once
//! ```
//!
//! The content is two texts, which this module does not interpret: the work, which changes seldom and may be long, and the
//! place in it, which changes all the time.

mod content;
mod files;
mod format;
mod lock;
pub(super) mod own;
mod slot;
mod text;
mod writer;

pub use content::{Check, Content};
pub(super) use files::make_folder;
pub(super) use lock::lock_folder;
pub use slot::KeptAside;
pub use text::Text;

use super::at_exit::{self, Registered, Release};
use crate::text::printable::Shown;
use etcetera::{BaseStrategy, base_strategy::Xdg};
use slot::Slot;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::thread::{self, JoinHandle};
use std::time::{Duration, SystemTime};
use writer::Shared;

/// How long a flush may hold up the loop, or the shell that suspends the process.
const PATIENCE: Duration = Duration::from_millis(400);
/// How long it may hold up the end of the process.
const LAST_PATIENCE: Duration = Duration::from_secs(4);

/// The session of this process. No other process can take it while this value lives; dropping it saves the session and
/// frees it.
pub struct Session {
    name: String,
    shared: Arc<Shared>,
    /// The saving thread. It returns the slot, or `None` if it never saved anything.
    writer: Option<JoinHandle<Option<Slot>>>,
    _at_end: Registered,
}

/// The result of looking for a session to resume.
#[derive(Debug)]
pub struct Found<T> {
    /// The newest session that is not in use and can be read.
    pub resumed: Option<Resumed<T>>,
    /// Newer files that could not be read; they have been renamed.
    pub kept_aside: Vec<KeptAside>,
    /// Newer files that belong to another user or cannot be opened; they are unchanged.
    pub left_alone: Vec<KeptAside>,
    /// Process numbers of the processes that use newer sessions, as far as they are known.
    pub in_use_by: Vec<u32>,
}

/// An earlier session that this process has resumed.
#[derive(Debug)]
pub struct Resumed<T> {
    /// The session, now held by this process.
    pub session: Session,
    /// What the caller's `read` made of its content.
    pub what: T,
}

/// A session in a listing.
#[derive(Debug)]
pub struct Listed {
    /// Name of the session.
    pub name: String,
    /// When it was saved last.
    pub written: SystemTime,
    /// Whether a running process holds it.
    pub is_in_use: bool,
    /// The number of that process, if known.
    pub owner: Option<u32>,
    /// What it holds, or why it cannot be read.
    pub content: Result<Content, String>,
}

/// The user has no home folder in which sessions could be kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "sessions cannot be kept: there is no home folder; set HOME or XDG_STATE_HOME to the full path of a folder"
)]
pub struct NoHome;

/// The folder for sessions: `$XDG_STATE_HOME/gyrolab`, by default `~/.local/state/gyrolab`.
///
/// # Errors
/// When the user has no home.
pub fn folder() -> Result<PathBuf, NoHome> {
    let state = Xdg::new().ok().and_then(|places| places.state_dir());
    state
        .filter(|folder| folder.is_absolute())
        .map(|folder| folder.join("gyrolab"))
        .ok_or(NoHome)
}

/// Resumes the newest session in `folder` that no running process holds and that `read` accepts. A session that cannot be
/// read, or that `read` refuses, is renamed and reported in [`Found::kept_aside`].
///
/// # Errors
/// When `folder` cannot be listed, or the system gives no thread. A `folder` that does not exist yet is no error.
pub fn resume<T>(
    folder: &Path,
    read: impl FnMut(&Content) -> Result<T, String>,
) -> io::Result<Found<T>> {
    let _lock = lock_folder(folder);
    resume_one_of(folder, &earlier(folder)?, read)
}

/// Resumes the session called `name` in `folder`, as [`resume`] does with the newest.
///
/// # Errors
/// As [`resume`]; and when there is no session of that name.
pub fn resume_named<T>(
    folder: &Path,
    name: &str,
    read: impl FnMut(&Content) -> Result<T, String>,
) -> io::Result<Found<T>> {
    let _lock = lock_folder(folder);
    let named: Vec<_> = earlier(folder)?
        .into_iter()
        .filter(|id| id == name)
        .collect();
    if named.is_empty() {
        return Err(io::Error::new(
            io::ErrorKind::NotFound,
            "there is no such session",
        ));
    }
    resume_one_of(folder, &named, read)
}

fn resume_one_of<T>(
    folder: &Path,
    ids: &[String],
    mut read: impl FnMut(&Content) -> Result<T, String>,
) -> io::Result<Found<T>> {
    let mut found = Found {
        resumed: None,
        kept_aside: Vec::new(),
        left_alone: Vec::new(),
        in_use_by: Vec::new(),
    };
    for id in ids {
        let taken = files::check_own(folder, id).and_then(|()| Slot::take(folder, id));
        let mut slot = match taken {
            Ok(Some(slot)) => slot,
            Ok(None) => {
                found.in_use_by.extend(files::owner(folder, id));
                continue;
            }
            Err(error) => {
                let path = folder.join(format!("{id}.work"));
                let reason = error.to_string();
                found.left_alone.push(KeptAside { path, reason });
                continue;
            }
        };
        let what = slot.load().and_then(|(content, aside)| {
            found.kept_aside.extend(aside);
            read(&content)
        });
        match what {
            Ok(what) => {
                let session = Session::start(slot)?;
                found.resumed = Some(Resumed { session, what });
                break;
            }
            Err(reason) => found.kept_aside.push(slot.put_all_aside(reason)),
        }
    }
    Ok(found)
}

/// Lists the user's own sessions in `folder`, the one saved last first. It changes nothing.
///
/// # Errors
/// When `folder` cannot be listed. A `folder` that does not exist yet is no error.
pub fn list(folder: &Path) -> io::Result<Vec<Listed>> {
    let mut ids = earlier(folder)?;
    ids.retain(|id| files::check_own(folder, id).is_ok());
    let _lock = (!ids.is_empty()).then(|| lock_folder(folder));
    let listed = ids.into_iter().map(|name| listed(folder, name));
    Ok(listed.collect())
}

/// The user's own session called `name` in `folder`, as [`list`] has it; `None` if there is none.
pub fn look_at(folder: &Path, name: &str) -> Option<Listed> {
    let mut ids = earlier(folder).ok()?.into_iter();
    let id = ids.find(|id| id == name)?;
    files::check_own(folder, &id).ok()?;
    let _lock = lock_folder(folder);
    Some(listed(folder, id))
}

/// Whether a running process holds the session called `name` in `folder`.
pub fn is_in_use(folder: &Path, name: &str) -> bool {
    files::is_in_use(folder, name)
}

/// When the session called `name` in `folder` was saved last; the beginning of 1970 if there is none.
pub fn saved_at(folder: &Path, name: &str) -> SystemTime {
    files::written_at(folder, name)
}

fn listed(folder: &Path, name: String) -> Listed {
    let is_in_use = files::is_in_use(folder, &name);
    Listed {
        written: files::written_at(folder, &name),
        is_in_use,
        owner: files::owner(folder, &name).filter(|_| is_in_use),
        content: content::stored(folder, &name).map(|stored| stored.content),
        name,
    }
}

/// The IDs of all sessions in `folder`, the one saved last first; none where there is no such folder.
fn earlier(folder: &Path) -> io::Result<Vec<String>> {
    match files::sessions(folder) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(Vec::new()),
        Err(error) => {
            let text = format!("cannot look for sessions in {}: {error}", Shown(folder));
            Err(io::Error::new(error.kind(), text))
        }
        found => found,
    }
}

impl Session {
    /// Begins a new session in `folder`, which is created if it does not exist, and removes the oldest unused sessions.
    /// Nothing is saved before the first [`note`](Self::note).
    ///
    /// # Errors
    /// When the folder cannot be written to.
    pub fn begin(folder: &Path) -> io::Result<Self> {
        make_folder(folder)?;
        let _lock = lock_folder(folder);
        slot::prune(folder);
        let slot = Slot::new(folder).map_err(|error| files::not_kept(folder, &error))?;
        Self::start(slot)
    }

    /// The session of `slot`: starts its saving thread and registers its hook.
    fn start(slot: Slot) -> io::Result<Self> {
        let name = slot.id().to_owned();
        let shared = Arc::new(Shared::default());
        let (ours, at_end) = (Arc::clone(&shared), Arc::clone(&shared));
        let writer = thread::Builder::new()
            .name("session".to_owned())
            .spawn(move || ours.keep_writing(slot))?;
        Ok(Self {
            name,
            shared,
            writer: Some(writer),
            _at_end: at_exit::hook(move |release| {
                at_end.flush(match release {
                    Release::Exit => LAST_PATIENCE,
                    Release::Suspend => PATIENCE,
                });
            }),
        })
    }

    /// Makes `content` the content to save. It only wakes the saving thread, and may be called in every round of the
    /// loop.
    pub fn note(&self, content: Content) {
        self.shared.note(content);
    }

    /// Name of the session.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// From now on a changed work is saved only if `check` accepts it. A [`flush`](Self::flush) saves without checking.
    pub fn check_with(&self, check: Check) {
        self.shared.state().check = Some(check);
    }

    /// Saves at once, and gives up after 0.4 s so that a signal handler's thread and a panic may call it. Returns whether
    /// saving was attempted in that time; [`trouble`](Self::trouble) tells whether it failed.
    pub fn flush(&self) -> bool {
        self.shared.flush(PATIENCE)
    }

    /// Why the last attempt to save failed; `None` if it succeeded. The thread tries again every half second.
    pub fn trouble(&self) -> Option<String> {
        self.shared.state().trouble.clone()
    }

    /// Saves and ends the session, and returns its content as read back from the disk. It waits at most `patience` for the
    /// disk to save.
    ///
    /// # Errors
    /// Why the disk does not hold the content that was noted last.
    pub fn close(mut self, patience: Duration) -> Result<Content, String> {
        if !self.shared.flush(patience) {
            return Err("the session is not kept: the disk takes too long".to_owned());
        }
        if let Some(trouble) = self.trouble() {
            return Err(trouble);
        }
        let slot = self
            .end()
            .ok_or("the session is not kept: there is nothing in it")?;
        let content = slot
            .read_back()
            .map_err(|reason| format!("the session was not kept: {reason}"))?;
        if self.shared.state().noted.as_ref() == Some(&content) {
            Ok(content)
        } else {
            Err("the session was not kept: the disk holds an earlier one".to_owned())
        }
    }

    /// Ends the thread and waits for it; returns its slot, or `None` if nothing was ever saved.
    fn end(&mut self) -> Option<Slot> {
        self.shared.state().is_closing = true;
        self.shared.changed.notify_all();
        self.writer.take()?.join().ok()?
    }
}

impl Drop for Session {
    fn drop(&mut self) {
        if self.writer.is_none() {
            return;
        }
        match self.shared.flush(PATIENCE) {
            true => drop(self.end()),
            // Do not wait for a thread that hangs in a write to a dead disk.
            false => self.shared.state().is_closing = true,
        }
    }
}

impl std::fmt::Debug for Session {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Session").finish_non_exhaustive()
    }
}
