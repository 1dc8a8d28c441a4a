//! What is to be done before the terminal is given back, whoever it is that ends the lab: its own loop, a signal, a
//! panic.
//!
//! Whoever has something to bring home registers a [`hook`]; [`terminal`](crate::tui::terminal) calls them all.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, mpsc};
use std::thread;
use std::time::Duration;

/// For what the terminal is given back.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Farewell {
    /// The process ends.
    End,
    /// The process stops, and may go on later or be killed.
    Stop,
}

/// How long all hooks together may hold up the end.
const PATIENCE: Duration = Duration::from_millis(600);

type Hook = Arc<dyn Fn(Farewell) + Send + Sync>;

static REGISTRY: Registry = Registry::new();

struct Registry {
    hooks: Mutex<Vec<(u64, Hook)>>,
    next: AtomicU64,
}

/// A hook is called as long as this lives.
#[must_use = "dropped, it takes its hook away"]
pub struct Registered {
    id: u64,
    registry: &'static Registry,
}

/// Has `hook` called before the terminal is given back, on a thread of its own, perhaps more than once and perhaps
/// while the lab goes on. It should take no longer than half a second.
pub fn hook(hook: impl Fn(Farewell) + Send + Sync + 'static) -> Registered {
    REGISTRY.add(Arc::new(hook))
}

/// Calls every hook and waits for them, but not for ever: at an end nothing may hang.
pub fn say(farewell: Farewell) {
    REGISTRY.say(farewell, PATIENCE);
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

    /// Each hook has a thread: one that hangs or panics takes nothing from the others.
    fn say(&self, farewell: Farewell, patience: Duration) {
        let hooks = self.hooks().clone();
        let (done, all_done) = mpsc::channel::<()>();
        for (_, hook) in hooks {
            let done = done.clone();
            let same = Arc::clone(&hook);
            let aside = move || {
                call(&same, farewell);
                drop(done);
            };
            let spawned = thread::Builder::new()
                .name("farewell".to_owned())
                .spawn(aside);
            if spawned.is_err() {
                call(&hook, farewell); // no thread is to be had
            }
        }
        drop(done);
        let _ = all_done.recv_timeout(patience); // nobody sends: it ends when the last sender is gone
    }
}

fn call(hook: &Hook, farewell: Farewell) {
    let _ = catch_unwind(AssertUnwindSafe(|| hook(farewell)));
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
    fn every_hook_that_is_registered_is_called_and_no_other() {
        let (registry, count) = (registry(), Arc::new(AtomicUsize::new(0)));
        let counted = || {
            let count = Arc::clone(&count);
            registry.add(Arc::new(move |farewell| {
                assert_eq!(farewell, Farewell::Stop);
                count.fetch_add(1, Ordering::SeqCst);
            }))
        };
        let (_one, two, _three) = (counted(), counted(), counted());
        registry.say(Farewell::Stop, Duration::from_secs(20));
        assert_eq!(count.load(Ordering::SeqCst), 3);
        drop(two);
        registry.say(Farewell::Stop, Duration::from_secs(20));
        assert_eq!(count.load(Ordering::SeqCst), 5);
    }

    #[test]
    fn a_hook_that_hangs_or_panics_takes_nothing_from_the_others() {
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
        registry.say(Farewell::End, Duration::from_secs(1));
        assert_eq!(count.load(Ordering::SeqCst), 1);
    }
}
