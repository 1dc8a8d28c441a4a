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

mod slot;

pub use slot::{Content, KeptAside};

use super::at_exit::{self, Registered};
use crate::text::printable::Shown;
use etcetera::{BaseStrategy, base_strategy::Xdg};
use slot::Slot;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError, TryLockError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

/// Between two writes, so that a run that plays does not keep the disk busy.
const PERIOD: Duration = Duration::from_millis(500);
/// How long a flush may hold up the end of the process.
const PATIENCE: Duration = Duration::from_millis(400);

/// The session of this process: no other one takes it while this lives. Dropped, it is flushed and free.
pub struct Session {
    shared: Arc<Shared>,
    writer: Option<JoinHandle<()>>,
    _at_end: Registered,
}

/// What was found of earlier sessions.
#[derive(Debug)]
pub struct Found<T> {
    /// The newest one that is not in use and can be read.
    pub resumed: Option<Resumed<T>>,
    /// What could not be read on the way to it, kept under other names.
    pub kept_aside: Vec<KeptAside>,
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
    mut read: impl FnMut(&Content) -> Result<T, String>,
) -> io::Result<Found<T>> {
    let (mut kept_aside, mut in_use_by) = (Vec::new(), Vec::new());
    let _door = slot::door(folder);
    for id in earlier(folder)? {
        let mut slot = match Slot::take(folder, &id) {
            Ok(Some(slot)) => slot,
            Ok(None) => {
                in_use_by.extend(slot::owner(folder, &id));
                continue;
            }
            Err(error) => {
                let path = folder.join(format!("{id}.lock"));
                let reason = format!("it cannot be opened: {error}");
                kept_aside.push(KeptAside { path, reason });
                continue;
            }
        };
        let what = slot.load().and_then(|(content, aside)| {
            kept_aside.extend(aside);
            read(&content)
        });
        match what {
            Ok(what) => {
                let session = Session::keep(slot)?;
                let resumed = Some(Resumed { session, what });
                return Ok(Found {
                    resumed,
                    kept_aside,
                    in_use_by,
                });
            }
            Err(reason) => kept_aside.push(slot.put_all_aside(reason)),
        }
    }
    Ok(Found {
        resumed: None,
        kept_aside,
        in_use_by,
    })
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
        let shared = Arc::new(Shared::default());
        let (ours, at_end) = (Arc::clone(&shared), Arc::clone(&shared));
        let writer = thread::Builder::new()
            .name("session".to_owned())
            .spawn(move || ours.keep_writing(slot))?;
        Ok(Self {
            shared,
            writer: Some(writer),
            _at_end: at_exit::hook(move |_| {
                at_end.flush();
            }),
        })
    }

    /// Has `content` kept in place of what was noted before. It writes nothing itself, and may be called in every round
    /// of the loop.
    pub fn note(&self, content: Content) {
        self.shared.note(content);
    }

    /// Writes at once what is not written yet. It gives up after half a second, so that it may be called from a signal's
    /// thread and from a panic; every farewell calls it by itself.
    pub fn flush(&self) {
        self.shared.flush();
    }

    /// Why the session cannot be kept, once each time that this begins; it is tried again all the while.
    pub fn new_trouble(&self) -> Option<String> {
        self.shared.state().trouble.as_mut()?.take()
    }
}

impl Drop for Session {
    fn drop(&mut self) {
        let is_free = self.shared.flush();
        self.shared.state().is_closing = true;
        self.shared.changed.notify_all();
        // A thread that hangs in a dead disk is left to itself.
        if let Some(writer) = self.writer.take().filter(|_| is_free) {
            let _ = writer.join();
        }
    }
}

impl std::fmt::Debug for Session {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Session").finish_non_exhaustive()
    }
}

/// What the loop, the thread and the flush have between them.
#[derive(Default)]
struct Shared {
    state: Mutex<State>,
    changed: Condvar,
}

#[derive(Default)]
struct State {
    noted: Option<Content>,
    /// How many contents have been noted, and which of them is on the disk.
    notes: u64,
    written: u64,
    /// Somebody waits for the note of that number.
    hurry: Option<u64>,
    is_closing: bool,
    /// That it cannot be kept, and why until this is told.
    trouble: Option<Option<String>>,
}

impl Shared {
    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn note(&self, content: Content) {
        let mut state = self.state();
        if state
            .noted
            .as_ref()
            .is_some_and(|old| Arc::ptr_eq(&old.work, &content.work) && old.place == content.place)
        {
            return;
        }
        let was_written = state.written == state.notes;
        state.noted = Some(content);
        state.notes += 1;
        if was_written {
            self.changed.notify_all();
        }
    }

    /// Whether what was noted has been tried to be written in time.
    fn flush(&self) -> bool {
        let end = Instant::now() + PATIENCE;
        let Some(mut state) = self.state_by(end) else {
            return false;
        };
        state.hurry = Some(state.notes);
        self.changed.notify_all();
        while state.hurry.is_some() {
            let left = end.saturating_duration_since(Instant::now());
            if left.is_zero() {
                return false;
            }
            state = self.wait(state, left);
        }
        true
    }

    /// The state, unless the thread that panicked has it in its hands.
    fn state_by(&self, end: Instant) -> Option<MutexGuard<'_, State>> {
        loop {
            match self.state.try_lock() {
                Ok(state) => return Some(state),
                Err(TryLockError::Poisoned(state)) => return Some(state.into_inner()),
                Err(TryLockError::WouldBlock) if Instant::now() >= end => return None,
                Err(TryLockError::WouldBlock) => thread::sleep(Duration::from_millis(1)),
            }
        }
    }

    fn wait<'a>(&'a self, state: MutexGuard<'a, State>, most: Duration) -> MutexGuard<'a, State> {
        let woken = self.changed.wait_timeout(state, most);
        woken.unwrap_or_else(PoisonError::into_inner).0
    }

    /// The thread's work: it ends when the session is closed.
    fn keep_writing(&self, mut slot: Slot) {
        let mut not_before = Instant::now();
        while let Some((content, note)) = self.next(not_before) {
            let result = slot.save(&content);
            self.tell(note, result);
            not_before = Instant::now() + PERIOD;
        }
        if slot.is_empty() {
            slot.remove();
        }
    }

    /// Waits until there is something to write and time to do so.
    fn next(&self, not_before: Instant) -> Option<(Content, u64)> {
        const FOR_EVER: Duration = Duration::from_secs(3600);
        let mut state = self.state();
        while !state.is_closing {
            let to_go = not_before.saturating_duration_since(Instant::now());
            // Asked to hurry it writes the same once more: the session that was left last is to be the newest.
            let is_due = state.written < state.notes || state.hurry.is_some();
            match state.noted.as_ref().filter(|_| is_due) {
                Some(content) if state.hurry.is_some() || to_go.is_zero() => {
                    return Some((content.clone(), state.notes));
                }
                Some(_) => state = self.wait(state, to_go),
                None => {
                    if state.hurry.take().is_some() {
                        self.changed.notify_all();
                    }
                    state = self.wait(state, FOR_EVER);
                }
            }
        }
        None
    }

    fn tell(&self, note: u64, result: io::Result<()>) {
        let mut state = self.state();
        let is_enough = state.hurry.is_some_and(|wanted| note >= wanted);
        match result {
            Ok(()) => {
                state.written = note;
                state.trouble = None;
            }
            Err(error) if state.trouble.is_none() => {
                state.trouble = Some(Some(format!("the session cannot be kept: {error}")));
            }
            Err(_) => {}
        }
        if is_enough {
            state.hurry = None;
            self.changed.notify_all();
        }
    }
}
