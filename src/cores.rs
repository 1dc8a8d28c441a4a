//! Work on all cores.

use rayon::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder, current_thread_index};

/// What `of` gives for each of `items`, in their order. Where the system gives no threads, this one computes all of it.
pub fn map<T: Sync, R: Send, All: FromParallelIterator<R> + FromIterator<R> + Send>(
    items: &[T],
    of: impl Fn(&T) -> R + Sync + Send,
) -> All {
    let all = || items.par_iter().map(&of).collect();
    if current_thread_index().is_some() {
        return all(); // it is part of work that is done so
    }
    match threads() {
        Some(threads) => threads.install(all),
        None => items.iter().map(&of).collect(),
    }
}

/// As many threads as there are cores, for one piece of work; `None` where the system does not give them. Rayon's own, which
/// all work would share, panic there; and one of them that waits for its part takes up any other work meanwhile, on top of its
/// stack.
pub fn threads() -> Option<ThreadPool> {
    ThreadPoolBuilder::new().build().ok()
}
