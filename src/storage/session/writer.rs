//! The state that a session's loop, its saving thread and its flush share.

use super::Content;
use super::slot::Slot;
use std::io;
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError, TryLockError};
use std::thread;
use std::time::{Duration, Instant};

/// Least time between two saves, so that a running run does not keep the disk busy.
const PERIOD: Duration = Duration::from_millis(500);

/// The state that the loop, the saving thread and the flush share.
#[derive(Default)]
pub(super) struct Shared {
    state: Mutex<State>,
    pub(super) changed: Condvar,
}

/// The content to save, and what has been saved.
#[derive(Default)]
pub(super) struct State {
    noted: Option<Content>,
    /// How many contents have been noted; it numbers the notes.
    notes: u64,
    /// The number of the note that is on the disk.
    written: u64,
    /// What is on the disk.
    pub(super) kept: Option<Content>,
    /// The number of the note for which a flush is waiting.
    hurry: Option<u64>,
    pub(super) is_closing: bool,
    /// Why the last attempt to save failed.
    pub(super) trouble: Option<String>,
}

impl Shared {
    /// The state of a session of which the disk holds `kept`.
    pub(super) fn of(kept: Option<Content>) -> Self {
        let shared = Self::default();
        shared.state().kept = kept;
        shared
    }

    pub(super) fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub(super) fn note(&self, content: Content) {
        let mut state = self.state();
        if state
            .noted
            .as_ref()
            .is_some_and(|old| old.work.is_clone_of(&content.work) && old.place == content.place)
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

    /// Makes the thread save at once, and waits for it at most `patience`. Returns whether it tried in that time.
    pub(super) fn flush(&self, patience: Duration) -> bool {
        let end = Instant::now() + patience;
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

    /// The state, or `None` if it stays locked until `end`: the thread that panicked may hold the lock itself.
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

    /// The body of the saving thread. It returns when the session is closed; one of which the disk holds nothing leaves
    /// nothing.
    pub(super) fn keep_writing(&self, mut slot: Slot) {
        let mut not_before = Instant::now();
        while let Some((note, content)) = self.next(not_before) {
            let result = slot.save(&content);
            self.record(note, content, result);
            not_before = Instant::now() + PERIOD;
        }
        if self.state().kept.is_none() {
            slot.remove();
        }
    }

    /// Waits until there is something to save and `not_before` has passed, or a flush is waiting. The number of the note
    /// and its content; `None` when the session is closed.
    fn next(&self, not_before: Instant) -> Option<(u64, Content)> {
        const FOR_EVER: Duration = Duration::from_secs(3600);
        let mut state = self.state();
        while !state.is_closing {
            let to_go = not_before.saturating_duration_since(Instant::now());
            // A flush saves even unchanged content, so that the session left last has the newest file.
            let is_due = state.written < state.notes || state.hurry.is_some();
            match state.noted.as_ref().filter(|_| is_due) {
                Some(content) if state.hurry.is_some() || to_go.is_zero() => {
                    return Some((state.notes, content.clone()));
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

    /// Records the `result` of saving `content`, the note of that number, and wakes the flush that waited for it.
    fn record(&self, note: u64, content: Content, result: io::Result<()>) {
        let mut state = self.state();
        let is_enough = state.hurry.is_some_and(|wanted| note >= wanted);
        match result {
            Ok(()) => {
                state.written = note;
                state.kept = Some(content);
                state.trouble = None;
            }
            Err(error) => state.trouble = Some(format!("the session cannot be kept: {error}")),
        }
        if is_enough {
            state.hurry = None;
            self.changed.notify_all();
        }
    }
}
