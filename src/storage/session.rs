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

mod lock;
pub(super) mod own;
mod slot;
mod text;
mod writer;

pub(super) use lock::lock_folder;
pub use slot::KeptAside;
pub use text::Text;

use super::at_exit::{self, Registered, Release};
use crate::text::printable::Shown;
use etcetera::{BaseStrategy, base_strategy::Xdg};
use slot::{Slot, Unread};
use std::fs::DirBuilder;
use std::io;
use std::os::unix::fs::DirBuilderExt;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::thread::{self, JoinHandle};
use std::time::{Duration, SystemTime};
use writer::Shared;

/// How long a flush may hold up the loop, or the shell that suspends the process.
const PATIENCE: Duration = Duration::from_millis(400);
/// How long it may hold up the end of the process.
const LAST_PATIENCE: Duration = Duration::from_secs(4);

/// The content of a session, as two texts.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Content {
    /// What changes seldom, such as the runs and their journals.
    pub work: Text,
    /// What changes all the time, such as the step at which the lab stands. It is short.
    pub place: String,
}

/// What is left of a session that has ended.
#[derive(Debug)]
pub struct Closed {
    /// The content that was saved last; `None` if none was.
    pub kept: Option<Content>,
    /// Why that is not the content that was noted last.
    pub trouble: Option<String>,
}

/// The session of this process. No other process can take it while this value lives; dropping it saves the session and
/// frees it.
pub struct Session {
    name: String,
    shared: Arc<Shared>,
    /// The saving thread.
    writer: Option<JoinHandle<()>>,
    _at_end: Registered,
}

/// The result of looking for a session to resume.
#[derive(Debug)]
pub struct Found<T> {
    /// The newest session that is not in use and can be read.
    pub resumed: Option<Resumed<T>>,
    /// Newer files that could not be read; they have been renamed.
    pub kept_aside: Vec<KeptAside>,
    /// Newer files of another user or another version, and those that cannot be opened; they are unchanged.
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
        let alone = |reason| KeptAside {
            path: slot::file_of(folder, id),
            reason,
        };
        let slot = match Slot::take(folder, id) {
            Ok(Some(slot)) => slot,
            Ok(None) => {
                found.in_use_by.extend(slot::owner(folder, id));
                continue;
            }
            Err(error) => {
                found.left_alone.push(alone(error.to_string()));
                continue;
            }
        };
        let content = match slot::stored(folder, id) {
            Ok(content) => content,
            Err(Unread::Foreign(reason)) => {
                found.left_alone.push(alone(reason));
                continue;
            }
            Err(damaged) => {
                found.kept_aside.push(slot.put_aside(damaged.reason()));
                continue;
            }
        };
        match read(&content) {
            Ok(what) => {
                let session = Session::start(slot, Some(content))?;
                found.resumed = Some(Resumed { session, what });
                break;
            }
            Err(reason) => found.kept_aside.push(slot.put_aside(reason)),
        }
    }
    Ok(found)
}

/// Lists the sessions in `folder`, the one saved last first. It changes nothing.
///
/// # Errors
/// When `folder` cannot be listed. A `folder` that does not exist yet is no error.
pub fn list(folder: &Path) -> io::Result<Vec<Listed>> {
    let ids = earlier(folder)?;
    let _lock = (!ids.is_empty()).then(|| lock_folder(folder));
    let listed = ids.into_iter().map(|name| listed(folder, name));
    Ok(listed.collect())
}

/// The session called `name` in `folder`, as [`list`] has it; `None` if there is none.
pub fn look_at(folder: &Path, name: &str) -> Option<Listed> {
    let mut ids = earlier(folder).ok()?.into_iter();
    let id = ids.find(|id| id == name)?;
    let _lock = lock_folder(folder);
    Some(listed(folder, id))
}

fn listed(folder: &Path, name: String) -> Listed {
    let is_in_use = slot::is_in_use(folder, &name);
    Listed {
        written: slot::written_at(folder, &name),
        is_in_use,
        owner: slot::owner(folder, &name).filter(|_| is_in_use),
        content: slot::stored(folder, &name).map_err(Unread::reason),
        name,
    }
}

/// Creates the folder if it does not exist, accessible to the user alone.
pub(super) fn make_folder(folder: &Path) -> io::Result<()> {
    let mut builder = DirBuilder::new();
    let made = builder.recursive(true).mode(0o700).create(folder);
    made.map_err(|error| not_kept(folder, &error))
}

/// Says that sessions cannot be kept in `folder`, because of `error`.
fn not_kept(folder: &Path, error: &io::Error) -> io::Error {
    let text = format!("sessions cannot be kept in {}: {error}", Shown(folder));
    io::Error::new(error.kind(), text)
}

/// The IDs of all sessions in `folder`, the one saved last first; none where there is no such folder.
fn earlier(folder: &Path) -> io::Result<Vec<String>> {
    match slot::sessions(folder) {
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
        let slot = Slot::new(folder).map_err(|error| not_kept(folder, &error))?;
        Self::start(slot, None)
    }

    /// The session of `slot`, of which the disk holds `kept`: starts its saving thread and registers its hook.
    fn start(slot: Slot, kept: Option<Content>) -> io::Result<Self> {
        let name = slot.id().to_owned();
        let shared = Arc::new(Shared::of(kept));
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

    /// Saves at once, and gives up after 0.4 s so that a signal handler's thread and a panic may call it. Returns whether
    /// saving was attempted in that time; [`trouble`](Self::trouble) tells whether it failed.
    pub fn flush(&self) -> bool {
        self.shared.flush(PATIENCE)
    }

    /// Why the last attempt to save failed; `None` if it succeeded. The thread tries again every half second.
    pub fn trouble(&self) -> Option<String> {
        self.shared.state().trouble.clone()
    }

    /// Saves and ends the session. It waits at most `patience` for the disk.
    pub fn close(mut self, patience: Duration) -> Closed {
        let is_in_time = self.shared.flush(patience);
        if is_in_time {
            self.end();
        } else {
            self.leave();
        }
        let state = self.shared.state();
        let slow = || "the session cannot be kept: the disk takes too long".to_owned();
        Closed {
            kept: state.kept.clone(),
            trouble: state.trouble.clone().or_else(|| (!is_in_time).then(slow)),
        }
    }

    /// Ends the thread and waits for it.
    fn end(&mut self) {
        self.leave();
        if let Some(writer) = self.writer.take() {
            let _ = writer.join();
        }
    }

    /// Tells the thread to end, without waiting for one that hangs in a write to a dead disk.
    fn leave(&self) {
        self.shared.state().is_closing = true;
        self.shared.changed.notify_all();
    }
}

impl Drop for Session {
    fn drop(&mut self) {
        if self.writer.is_none() {
            return;
        }
        if self.shared.flush(PATIENCE) {
            self.end();
        } else {
            self.leave();
        }
    }
}

impl std::fmt::Debug for Session {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Session").finish_non_exhaustive()
    }
}
