//! Work on all cores whose results are taken in order.

use crate::engine::cores;
use rayon::iter::{ParallelBridge, ParallelIterator};
use std::collections::BTreeMap;
use std::ops::{ControlFlow, Range};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering::Relaxed};
use std::sync::mpsc::{Receiver, channel};
use std::thread::sleep;
use std::time::Duration;

/// How far the work may be ahead of the first result that is not there yet.
const AHEAD: u64 = 1 << 14;
/// Least time between two collections: each wakes the collecting thread.
const LEAST_COLLECT_INTERVAL: Duration = Duration::from_millis(10);

/// Calls `compute` for every index of `range` on all cores, and passes the results to `collect` in the order of the range,
/// as many at once as are ready. Ends when `collect` breaks, or when `compute` returns `None`; its second argument says
/// whether to continue.
pub fn in_order<T: Send>(
    range: Range<u64>,
    compute: impl Fn(u64, &dyn Fn() -> bool) -> Option<T> + Sync,
    mut collect: impl FnMut(Vec<T>) -> ControlFlow<()>,
) {
    let Some(pool) = cores::threads() else {
        let mut results = range.map_while(|index| compute(index, &|| true));
        let _ = results.try_for_each(|result| collect(vec![result]));
        return;
    };
    let (taken, goes_on) = (AtomicU64::new(range.start), AtomicBool::new(true));
    let (sender, receiver) = channel();
    pool.in_place_scope(|scope| {
        scope.spawn(|_| {
            // Each core takes the next of the range: what is missing behind a result has been begun.
            range
                .par_bridge()
                .try_for_each_with(sender, |results, index| {
                    while goes_on.load(Relaxed) && index >= taken.load(Relaxed) + AHEAD {
                        sleep(LEAST_COLLECT_INTERVAL);
                    }
                    if !goes_on.load(Relaxed) {
                        return None;
                    }
                    let result = compute(index, &|| goes_on.load(Relaxed))?;
                    results.send((index, result)).ok()
                });
        });
        hand_over(&receiver, &taken, &mut collect);
        goes_on.store(false, Relaxed);
    });
}

/// Passes the results to `collect` in their order, until the work has ended or `collect` breaks. `taken` is the index of the
/// next one.
fn hand_over<T>(
    receiver: &Receiver<(u64, T)>,
    taken: &AtomicU64,
    collect: &mut impl FnMut(Vec<T>) -> ControlFlow<()>,
) {
    let (mut waiting, mut wanted) = (BTreeMap::new(), taken.load(Relaxed));
    while let Ok(first) = receiver.recv() {
        sleep(LEAST_COLLECT_INTERVAL);
        waiting.extend(std::iter::once(first).chain(receiver.try_iter()));
        let mut ready = Vec::new();
        while let Some(result) = waiting.remove(&wanted) {
            ready.push(result);
            wanted += 1;
        }
        if !ready.is_empty() && collect(ready).is_break() {
            return;
        }
        taken.store(wanted, Relaxed);
    }
}
