//! Hooks that run before the terminal is restored, whether the lab's main loop, a signal or a panic ends the lab.
//!
//! A part that has something to save or to clean up registers a [`hook`]. [`terminal`](crate::tui::terminal) runs all
//! hooks.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, mpsc};
use std::thread;
use std::time::Duration;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Release {
    Exit,
    /// The shell suspends the process, which may be resumed or killed later.
    Suspend,
}

impl Release {
    /// Returns the time by which all hooks together may delay it.
    ///
    /// On a busy machine a hook may need seconds before it runs at all. The user waits for the whole time only if a
    /// disk no longer responds.
    pub fn patience(self) -> Duration {
        match self {
            Self::Exit => Duration::from_secs(5),
            Self::Suspend => Duration::from_millis(600),
        }
    }
}

type Hook = Arc<dyn Fn(Release) + Send + Sync>;

/// The registered hooks with their numbers, in the order of registration.
static HOOKS: Mutex<Vec<(u64, Hook)>> = Mutex::new(Vec::new());

fn hooks() -> MutexGuard<'static, Vec<(u64, Hook)>> {
    HOOKS.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A registered hook. Dropping this value removes the hook.
#[must_use = "dropping this removes the hook"]
#[derive(Debug)]
pub struct Registered(u64);

impl Drop for Registered {
    fn drop(&mut self) {
        hooks().retain(|(number, _)| *number != self.0);
    }
}

/// Registers `hook`, which is called on a separate thread before the terminal is restored.
///
/// It may be called more than once, and while the lab is still running. It should give up after [`Release::patience`].
pub fn hook(hook: impl Fn(Release) + Send + Sync + 'static) -> Registered {
    let mut registered = hooks();
    let number = registered.last().map_or(0, |(last, _)| last + 1);
    registered.push((number, Arc::new(hook)));
    Registered(number)
}

/// Calls all hooks and waits until all have returned, but no longer than [`Release::patience`].
pub fn run_hooks(release: Release) {
    let (done, all_done) = mpsc::channel::<()>();
    let registered = hooks().clone();
    for (_, hook) in registered {
        let (thread_hook, thread_done) = (Arc::clone(&hook), done.clone());
        // Each hook runs on its own thread, so that one that hangs or panics does not affect the others.
        let spawned = thread::Builder::new().spawn(move || {
            call(&thread_hook, release);
            drop(thread_done);
        });
        if spawned.is_err() {
            call(&hook, release); // the system provides no thread: run it here
        }
    }
    drop(done);
    let _ = all_done.recv_timeout(release.patience()); // nothing is sent: it ends when the last sender is dropped
}

fn call(hook: &Hook, release: Release) {
    let _ = catch_unwind(AssertUnwindSafe(|| hook(release)));
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicUsize, Ordering};

    #[test]
    fn exit_hooks_run_even_if_others_hang_or_panic() {
        let count = Arc::new(AtomicUsize::new(0));
        let counted = || {
            let count = Arc::clone(&count);
            hook(move |_| {
                count.fetch_add(1, Ordering::SeqCst);
            })
        };
        let (_one, two) = (counted(), counted());
        drop(two);
        let _hangs = hook(|_| {
            loop {
                thread::park();
            }
        });
        let _panics = hook(|_| panic!("this hook panics, as it should"));
        let _three = counted();
        run_hooks(Release::Suspend);
        while count.load(Ordering::SeqCst) < 2 {
            thread::yield_now(); // a busy machine may need longer than the patience
        }
        assert_eq!(count.load(Ordering::SeqCst), 2);
    }
}
