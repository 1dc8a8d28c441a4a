//! What a session's loop, its writing thread and whoever flushes it have between them.

use super::slot::{Check, Content, Slot};
use std::io;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError, TryLockError};
use std::thread;
use std::time::{Duration, Instant};

/// Between two writes, so that a run that plays does not keep the disk busy.
const PERIOD: Duration = Duration::from_millis(500);

/// What the loop, the thread and the flush have between them.
#[derive(Default)]
pub(super) struct Shared {
    state: Mutex<State>,
    pub(super) changed: Condvar,
}

/// What is to be written, and what has become of it.
#[derive(Default)]
pub(super) struct State {
    pub(super) noted: Option<Content>,
    /// How many contents have been noted, and which of them is on the disk.
    notes: u64,
    written: u64,
    /// Somebody waits for the note of that number.
    hurry: Option<u64>,
    pub(super) is_closing: bool,
    /// Why it cannot be kept.
    pub(super) trouble: Option<String>,
    pub(super) check: Option<Check>,
}

impl Shared {
    pub(super) fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub(super) fn note(&self, content: Content) {
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
    pub(super) fn keep_writing(&self, mut slot: Slot) -> Option<Slot> {
        let mut not_before = Instant::now();
        while let Some(due) = self.next(not_before) {
            let result = slot.save(&due.content, due.check);
            self.tell(due.note, result);
            not_before = Instant::now() + PERIOD;
        }
        if slot.is_empty() {
            slot.remove();
            return None;
        }
        Some(slot)
    }

    /// Waits until there is something to write and time to do so.
    fn next(&self, not_before: Instant) -> Option<Due> {
        const FOR_EVER: Duration = Duration::from_secs(3600);
        let mut state = self.state();
        while !state.is_closing {
            let to_go = not_before.saturating_duration_since(Instant::now());
            // Asked to hurry it writes the same once more: the session that was left last is to be the newest.
            let is_due = state.written < state.notes || state.hurry.is_some();
            match state.noted.as_ref().filter(|_| is_due) {
                Some(content) if state.hurry.is_some() || to_go.is_zero() => {
                    return Some(Due {
                        content: content.clone(),
                        note: state.notes,
                        check: state.check.filter(|_| state.hurry.is_none()),
                    });
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
            Err(error) => state.trouble = Some(format!("the session cannot be kept: {error}")),
        }
        if is_enough {
            state.hurry = None;
            self.changed.notify_all();
        }
    }
}

/// What is to be written now.
struct Due {
    content: Content,
    note: u64,
    check: Option<Check>,
}
