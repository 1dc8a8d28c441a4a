//! What the lab would need to come back to where it was, kept on the disk while it runs and at most a second behind,
//! whatever ends the process.
//!
//! ```text
//! loop ─note→ Shared (what is to be kept) ←waits─ thread ─→ Slot: the files of one session
//!                └─ flush: at an end, has the thread write at once
//! ```
//!
//! The content is two texts that mean nothing here: the work, which changes seldom and may be long, and the place in
//! it, which changes all the time.

mod form;
mod own;
mod slot;
mod writer;

pub use slot::{Check, Content, KeptAside};

use super::at_exit::{self, Registered};
use crate::text::printable::Shown;
use etcetera::{BaseStrategy, base_strategy::Xdg};
use slot::Slot;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::thread::{self, JoinHandle};
use std::time::{Duration, SystemTime};
use writer::Shared;

/// How long a flush may hold up the end of the process.
const PATIENCE: Duration = Duration::from_millis(400);

/// The session of this process: no other one takes it while this lives. Dropped, it is flushed and free.
pub struct Session {
    name: String,
    shared: Arc<Shared>,
    /// It gives back what it wrote to, unless it wrote nothing.
    writer: Option<JoinHandle<Option<Slot>>>,
    _at_end: Registered,
}

/// What was found of earlier sessions.
#[derive(Debug)]
pub struct Found<T> {
    /// The newest one that is not in use and can be read.
    pub resumed: Option<Resumed<T>>,
    /// What could not be read on the way to it, kept under other names.
    pub kept_aside: Vec<KeptAside>,
    /// What is not the user's own, or cannot be opened: it is as it was.
    pub left_alone: Vec<KeptAside>,
    /// The processes that have the newer ones, as far as they are known.
    pub in_use_by: Vec<u32>,
}

/// An earlier session, gone on with.
#[derive(Debug)]
pub struct Resumed<T> {
    /// Ours now.
    pub session: Session,
    /// What was read from it.
    pub what: T,
}

/// A session, as it is listed.
#[derive(Debug)]
pub struct Listed {
    /// What it is called.
    pub name: String,
    /// When it was written last.
    pub written: SystemTime,
    /// Whether a living process has it.
    pub is_in_use: bool,
    /// The number of that process, where it is known.
    pub owner: Option<u32>,
    /// What it holds, or why it cannot be read.
    pub content: Result<Content, String>,
}

/// There is no home for sessions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "sessions cannot be kept: there is no home folder; set HOME or XDG_STATE_HOME to the full path of a folder"
)]
pub struct NoHome;

/// Where sessions are kept: `$XDG_STATE_HOME/gyrolab`, by default `~/.local/state/gyrolab`.
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

/// Takes up the newest session in `folder` that no living process has and that `read` accepts. One that cannot be read,
/// or that `read` refuses, is put aside under another name and told of.
///
/// # Errors
/// When `folder` cannot be looked into, or there is no thread to be had; that there is none yet is no error.
pub fn resume<T>(
    folder: &Path,
    read: impl FnMut(&Content) -> Result<T, String>,
) -> io::Result<Found<T>> {
    let _door = slot::door(folder);
    resume_one_of(folder, &earlier(folder)?, read)
}

/// Takes up the session called `name` in `folder`, as [`resume`] does with the newest.
///
/// # Errors
/// As [`resume`]; and when there is no session of that name.
pub fn resume_named<T>(
    folder: &Path,
    name: &str,
    read: impl FnMut(&Content) -> Result<T, String>,
) -> io::Result<Found<T>> {
    let _door = slot::door(folder);
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
        let taken = slot::is_own(folder, id).and_then(|()| Slot::take(folder, id));
        let mut slot = match taken {
            Ok(Some(slot)) => slot,
            Ok(None) => {
                found.in_use_by.extend(slot::owner(folder, id));
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
                let session = Session::keep(slot)?;
                found.resumed = Some(Resumed { session, what });
                break;
            }
            Err(reason) => found.kept_aside.push(slot.put_all_aside(reason)),
        }
    }
    Ok(found)
}

/// The user's own sessions in `folder`, the one written last first. Nothing is changed.
///
/// # Errors
/// When `folder` cannot be looked into; that there is none yet is no error.
pub fn list(folder: &Path) -> io::Result<Vec<Listed>> {
    let mut ids = earlier(folder)?;
    ids.retain(|id| slot::is_own(folder, id).is_ok());
    let _door = (!ids.is_empty()).then(|| slot::door(folder));
    let listed = ids.into_iter().map(|name| {
        let is_in_use = slot::is_in_use(folder, &name);
        Listed {
            written: slot::written_at(folder, &name),
            is_in_use,
            owner: slot::owner(folder, &name).filter(|_| is_in_use),
            content: slot::stored(folder, &name).map(|stored| stored.content),
            name,
        }
    });
    Ok(listed.collect())
}

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
    /// Begins a session in `folder`, which is made if there is none; the oldest that are in no use are cleared away.
    /// Nothing is kept before the first [`note`](Self::note).
    ///
    /// # Errors
    /// When nothing can be written there.
    pub fn begin(folder: &Path) -> io::Result<Self> {
        slot::make_folder(folder)?;
        let _door = slot::door(folder);
        slot::prune(folder);
        let slot = Slot::new(folder).map_err(|error| {
            let text = format!("sessions cannot be kept in {}: {error}", Shown(folder));
            io::Error::new(error.kind(), text)
        })?;
        Self::keep(slot)
    }

    fn keep(slot: Slot) -> io::Result<Self> {
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
            _at_end: at_exit::hook(move |_| {
                at_end.flush(PATIENCE);
            }),
        })
    }

    /// Has `content` kept in place of what was noted before. It writes nothing itself, and may be called in every round
    /// of the loop.
    pub fn note(&self, content: Content) {
        self.shared.note(content);
    }

    /// What the session is called.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// From now on a work is written only if `check` accepts it, but for one that has to be written at once.
    pub fn check_with(&self, check: Check) {
        self.shared.state().check = Some(check);
    }

    /// Writes at once what is not written yet, or gives up after half a second, so that it may be called from a signal's
    /// thread and from a panic; every farewell calls it by itself. Gives whether it was tried in that time.
    pub fn flush(&self) -> bool {
        self.shared.flush(PATIENCE)
    }

    /// Why the session cannot be kept, as long as that is so; it is tried again all the while.
    pub fn trouble(&self) -> Option<String> {
        self.shared.state().trouble.clone()
    }

    /// Ends the session, and gives what can be come back to: what the disk holds, if that is what was noted last. It
    /// waits for the disk at most for `patience`.
    ///
    /// # Errors
    /// Why there is nothing to come back to, or not to what was noted last.
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

    /// Has the thread end, and waits for it.
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
            // A thread that hangs in a dead disk is left to itself.
            false => self.shared.state().is_closing = true,
        }
    }
}

impl std::fmt::Debug for Session {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Session").finish_non_exhaustive()
    }
}
