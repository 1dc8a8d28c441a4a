//! Hooks that run before the terminal is given back, whether the lab's own loop, a signal or a panic ends the lab.
//!
//! A part that has something to save or to clean up registers a [`hook`]; [`terminal`](crate::tui::terminal) runs all
//! hooks.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, mpsc};
use std::thread;
use std::time::Duration;

/// Why the terminal is given back.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Release {
    /// The process ends.
    Exit,
    /// The shell suspends the process, which may be resumed or killed later.
    Suspend,
}

/// How long all hooks together may delay the shell that suspends the process.
const PATIENCE: Duration = Duration::from_millis(600);
/// How long they may delay the end of the process. On a busy machine a hook may need seconds until it runs at all; only a
/// disk that no longer answers makes the user wait for the whole of it.
const LAST_PATIENCE: Duration = Duration::from_secs(5);

type Hook = Arc<dyn Fn(Release) + Send + Sync>;

static REGISTRY: Registry = Registry::new();

struct Registry {
    hooks: Mutex<Vec<(u64, Hook)>>,
    next: AtomicU64,
}

/// A registered hook. Dropping this value removes the hook.
#[must_use = "dropping this removes the hook"]
pub struct Registered {
    id: u64,
    registry: &'static Registry,
}

/// Registers `hook`, which is called on a thread of its own before the terminal is given back. It may be called more than
/// once, and while the lab is still running. It should give up after half a second where the process is suspended, and
/// after four seconds where it ends.
pub fn hook(hook: impl Fn(Release) + Send + Sync + 'static) -> Registered {
    REGISTRY.add(Arc::new(hook))
}

/// Calls every hook and waits until all have returned, but at most 0.6 s where the process is suspended and 5 s where it
/// ends: a hook must not keep it from that.
pub fn run_hooks(release: Release) {
    let patience = match release {
        Release::Exit => LAST_PATIENCE,
        Release::Suspend => PATIENCE,
    };
    REGISTRY.run_hooks(release, patience);
}

impl Registry {
    const fn new() -> Self {
        Self {
            hooks: Mutex::new(Vec::new()),
            next: AtomicU64::new(0),
        }
    }

    fn hooks(&self) -> MutexGuard<'_, Vec<(u64, Hook)>> {
        self.hooks.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn add(&'static self, hook: Hook) -> Registered {
        let id = self.next.fetch_add(1, Ordering::Relaxed);
        self.hooks().push((id, hook));
        Registered { id, registry: self }
    }

    /// Runs each hook on its own thread, so that one that hangs or panics does not affect the others.
    fn run_hooks(&self, release: Release, patience: Duration) {
        let hooks = self.hooks().clone();
        let (done, all_done) = mpsc::channel::<()>();
        for (_, hook) in hooks {
            let done = done.clone();
            let threads_hook = Arc::clone(&hook);
            let run = move || {
                call(&threads_hook, release);
                drop(done);
            };
            let spawned = thread::Builder::new().name("at exit".to_owned()).spawn(run);
            if spawned.is_err() {
                call(&hook, release); // the system gives no thread: run it here
            }
        }
        drop(done);
        let _ = all_done.recv_timeout(patience); // nothing is sent: receiving ends when the last sender is dropped
    }
}

fn call(hook: &Hook, release: Release) {
    let _ = catch_unwind(AssertUnwindSafe(|| hook(release)));
}

impl Drop for Registered {
    fn drop(&mut self) {
        self.registry.hooks().retain(|(id, _)| *id != self.id);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::AtomicUsize;

    fn registry() -> &'static Registry {
        Box::leak(Box::new(Registry::new()))
    }

    #[test]
    fn exactly_the_registered_hooks_are_called() {
        let (registry, count) = (registry(), Arc::new(AtomicUsize::new(0)));
        let counted = || {
            let count = Arc::clone(&count);
            registry.add(Arc::new(move |release| {
                assert_eq!(release, Release::Suspend);
                count.fetch_add(1, Ordering::SeqCst);
            }))
        };
        let (_one, two, _three) = (counted(), counted(), counted());
        registry.run_hooks(Release::Suspend, Duration::from_secs(20));
        assert_eq!(count.load(Ordering::SeqCst), 3);
        drop(two);
        registry.run_hooks(Release::Suspend, Duration::from_secs(20));
        assert_eq!(count.load(Ordering::SeqCst), 5);
    }

    #[test]
    fn a_hook_that_hangs_or_panics_does_not_affect_the_others() {
        let (registry, count) = (registry(), Arc::new(AtomicUsize::new(0)));
        let _hangs = registry.add(Arc::new(|_| {
            loop {
                thread::park();
            }
        }));
        let _panics = registry.add(Arc::new(|_| panic!("this hook panics, as it should")));
        let counted = Arc::clone(&count);
        let _counts = registry.add(Arc::new(move |_| {
            counted.fetch_add(1, Ordering::SeqCst);
        }));
        registry.run_hooks(Release::Exit, Duration::from_secs(1));
        assert_eq!(count.load(Ordering::SeqCst), 1);
    }
}
