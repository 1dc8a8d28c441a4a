//! Work on all cores.

use rayon::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder, current_thread_index};

/// Applies `of` to each of `items` on all cores, and returns the results in the order of the items.
///
/// If the system cannot create threads, the calling thread does all the work.
pub fn map<T: Sync, R: Send, All: FromParallelIterator<R> + FromIterator<R> + Send>(
    items: &[T],
    of: impl Fn(&T) -> R + Sync + Send,
) -> All {
    let all = || items.par_iter().map(&of).collect();
    if current_thread_index().is_some() {
        return all(); // already on a thread of such a pool
    }
    match threads() {
        Some(threads) => threads.install(all),
        None => items.iter().map(&of).collect(),
    }
}

/// Creates a pool with one thread per core. Returns `None` if the system cannot create threads.
///
/// Rayon's global pool is not used, because it panics if its threads cannot be created. Also, a thread of it that waits
/// may begin other work on top of its own stack, which can overflow.
pub fn threads() -> Option<ThreadPool> {
    ThreadPoolBuilder::new().build().ok()
}
