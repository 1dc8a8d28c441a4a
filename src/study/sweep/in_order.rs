//! Work on all cores whose results are taken in order.

use crate::cores;
use std::collections::BTreeMap;
use std::ops::{ControlFlow, Range};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Condvar, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// How far the work may be ahead of the first result that is not there yet.
const AHEAD: u64 = 1 << 14;
/// A core keeps its results for so long before it hands them over: each handing over wakes the thread that takes them.
const KEPT: Duration = Duration::from_millis(10);

/// Results with their numbers in the range.
type Done<T> = Vec<(u64, T)>;

/// Computes `of` for all of `range` on all cores, and gives the results to `take` in the order of the range, as many at once
/// as are there. It ends where `take` breaks, or where `of`, which is told whether to go on, gives nothing.
///
/// Each core takes the next piece of work as soon as it has done with the last.
pub fn in_order<T: Send>(
    range: Range<u64>,
    of: impl Fn(u64, &dyn Fn() -> bool) -> Option<T> + Sync,
    mut take: impl FnMut(Vec<T>) -> ControlFlow<()>,
) {
    let Some(pool) = cores::threads() else {
        for index in range {
            let result = of(index, &|| true);
            if result.is_none_or(|result| take(vec![result]).is_break()) {
                return;
            }
        }
        return;
    };
    let queue = Queue {
        next: AtomicU64::new(range.start),
        end: AtomicU64::new(range.end),
        taken: AtomicU64::new(range.start),
        asleep: Mutex::new(()),
        moved: Condvar::new(),
        stops: AtomicBool::new(false),
    };
    let (sender, receiver) = channel();
    pool.in_place_scope(|scope| {
        for _ in 0..pool.current_num_threads() {
            let (sender, queue, of) = (sender.clone(), &queue, &of);
            scope.spawn(move |_| queue.work(&sender, of));
        }
        drop(sender); // so that the receiver ends with the last worker
        queue.collect(range.start, &receiver, &mut take);
        queue.stop();
    });
}

/// What the workers share.
struct Queue {
    next: AtomicU64,
    /// Where the work ends: at the range's end, or where `of` has given nothing.
    end: AtomicU64,
    /// All results below this one have been taken.
    taken: AtomicU64,
    /// Held between a worker's look and its sleep, and while it is to be woken, so that it misses nothing.
    asleep: Mutex<()>,
    moved: Condvar,
    stops: AtomicBool,
}

impl Queue {
    fn work<T>(
        &self,
        results: &Sender<Done<T>>,
        of: &impl Fn(u64, &dyn Fn() -> bool) -> Option<T>,
    ) {
        let go_on = || !self.stops();
        let (mut done, mut since) = (Vec::new(), Instant::now());
        loop {
            let index = self.next.fetch_add(1, Ordering::Relaxed);
            let is_waiting = self.is_far(index);
            let is_last = self.is_beyond(index);
            if is_last || is_waiting || since.elapsed() >= KEPT {
                // What is not handed over cannot be taken: nobody waits with results in hand.
                if results.send(std::mem::take(&mut done)).is_err() {
                    return;
                }
                since = Instant::now();
            }
            if is_last || (is_waiting && !self.wait_for(index)) {
                return;
            }
            match of(index, &go_on) {
                Some(result) => done.push((index, result)),
                None => self.wake(|| {
                    self.end.fetch_min(index, Ordering::Relaxed);
                }),
            }
        }
    }

    fn stops(&self) -> bool {
        self.stops.load(Ordering::Relaxed)
    }

    /// Whether there is nothing to do at `index`.
    fn is_beyond(&self, index: u64) -> bool {
        index >= self.end.load(Ordering::Relaxed) || self.stops()
    }

    /// Whether `index` is too far ahead of what has been taken.
    fn is_far(&self, index: u64) -> bool {
        index >= self.taken.load(Ordering::Relaxed).saturating_add(AHEAD)
    }

    /// Waits until `index` is not too far ahead; false where the work has stopped.
    fn wait_for(&self, index: u64) -> bool {
        let asleep = self.asleep.lock().unwrap_or_else(PoisonError::into_inner);
        let waits = |_: &mut ()| self.is_far(index) && !self.is_beyond(index);
        let waited = self.moved.wait_while(asleep, waits);
        drop(waited.unwrap_or_else(PoisonError::into_inner));
        !self.is_beyond(index)
    }

    /// Gives the results to `take` in order, until all are there or one is missing for good.
    fn collect<T>(
        &self,
        begin: u64,
        results: &Receiver<Done<T>>,
        take: &mut impl FnMut(Vec<T>) -> ControlFlow<()>,
    ) {
        let mut waiting = BTreeMap::new();
        let mut next = begin;
        while let Ok(first) = results.recv() {
            waiting.extend(std::iter::once(first).chain(results.try_iter()).flatten());
            let mut ready = Vec::new();
            while let Some(result) = waiting.remove(&next) {
                ready.push(result);
                next += 1;
            }
            if !ready.is_empty() && take(ready).is_break() {
                return;
            }
            self.wake(|| self.taken.store(next, Ordering::Relaxed));
        }
    }

    fn stop(&self) {
        self.wake(|| self.stops.store(true, Ordering::Relaxed));
    }

    /// Does what the sleeping workers wait for, and wakes them.
    fn wake(&self, change: impl FnOnce()) {
        let asleep = self.asleep.lock().unwrap_or_else(PoisonError::into_inner);
        change();
        drop(asleep);
        self.moved.notify_all();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_come_in_order_and_each_once() {
        let mut seen = Vec::new();
        in_order(
            3..40_000,
            |index, _| Some(index * index),
            |results| {
                seen.extend(results);
                ControlFlow::Continue(())
            },
        );
        assert!(seen.into_iter().eq((3..40_000).map(|index| index * index)));
    }

    #[test]
    fn it_ends_where_the_taker_or_the_work_does() {
        let mut seen = 0;
        let stop_taking = |results: Vec<u64>| {
            seen += results.len();
            ControlFlow::Break(())
        };
        in_order(0..1_000_000_000, |index, _| Some(index), stop_taking);
        assert!(seen > 0);
        let mut seen = Vec::new();
        let take = |results: Vec<u64>| {
            seen.extend(results);
            ControlFlow::Continue(())
        };
        in_order(
            0..1_000_000,
            |index, _| (index < 1000).then_some(index),
            take,
        );
        assert!(seen.into_iter().eq(0..1000));
        in_order(5..5, |index, _| Some(index), |_| unreachable!());
    }
}
