//! Work on all cores.

use rayon::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder, current_thread_index};

/// Applies `of` to each of `items` on all cores; the results keep the order of the items. Where the system gives no threads,
/// the thread that calls does all of it.
pub fn map<T: Sync, R: Send, All: FromParallelIterator<R> + FromIterator<R> + Send>(
    items: &[T],
    of: impl Fn(&T) -> R + Sync + Send,
) -> All {
    let all = || items.par_iter().map(&of).collect();
    if current_thread_index().is_some() {
        return all(); // this is one of such threads already
    }
    match threads() {
        Some(threads) => threads.install(all),
        None => items.iter().map(&of).collect(),
    }
}

/// New threads, as many as there are cores; `None` where the system does not give them. Those that rayon shares among all work
/// are not used: rayon panics where it cannot have them, and one that waits for its part begins other work on top of its own
/// stack, which can overflow.
pub fn threads() -> Option<ThreadPool> {
    ThreadPoolBuilder::new().build().ok()
}
