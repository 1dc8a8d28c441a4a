//! Many steps at once: one thread does nothing but take them, and hands them over, many together, to another, which measures
//! them, adds them to the pictures and holds them against the exact motion. That takes about as long as stepping. They share
//! nothing but the steps handed over, so that what is found is the same on any number of cores.

use super::{LiveRun, PlayEnd};
use crate::observe::checkpoints::bare;
use crate::run::{Batch, NotFinite, Step};
use std::panic;
use std::sync::mpsc::{self, Receiver, Sender, SyncSender};
use std::thread::{self, Scope, ScopedJoinHandle};

/// Fewer steps than this are not worth a thread.
const FEWEST: u64 = 4096;
/// The most batches that wait to be followed; then stepping waits too.
const WAITING: usize = 8;
/// At least and at most so many steps are handed over together: every time, a thread has to be woken, but until the first
/// steps come and after the last ones one of the two has nothing to do.
const TOGETHER: (u64, u64) = (1024, 16_384);
/// So many where the run stops every now and then, for the keyboard to be read.
const TOGETHER_IN_A_HURRY: usize = 4096;
/// What is to be stepped is handed over in about so many batches, within these limits.
const BATCHES: u64 = 64;

impl LiveRun {
    /// Steps until the run stands at `step`. All that is read off it then is as if it had taken them
    /// [one by one](Self::step).
    ///
    /// # Errors
    /// When the numbers stop being finite; the run then stays at the step before.
    pub fn step_to(&mut self, step: u64) -> Result<(), NotFinite> {
        let steps = step.saturating_sub(self.simulation.step_number());
        let together = (steps / BATCHES).clamp(TOGETHER.0, TOGETHER.1) as usize;
        if steps >= FEWEST
            && let Some(stepped) = self.step_on_cores_to(step, together, || false)
        {
            return stepped;
        }
        self.step_alone_to(step)
    }

    /// Steps until the run stands at the step `stop`, or `enough` returns true because the time for computing is used up.
    pub fn hurry_to(&mut self, stop: u64, mut enough: impl FnMut() -> bool) -> PlayEnd {
        let steps = stop.saturating_sub(self.simulation.step_number());
        if steps < FEWEST {
            return self.play(f64::INFINITY, stop, enough, |_| false).end;
        }
        let (every, mut is_enough) = (self.steps_per_look(), false);
        let mut until_look = every;
        let look = || {
            until_look -= 1;
            if until_look == 0 {
                (until_look, is_enough) = (every, enough());
            }
            is_enough
        };
        match self.step_on_cores_to(stop, TOGETHER_IN_A_HURRY, look) {
            Some(Ok(())) if self.simulation.step_number() >= stop => PlayEnd::AtStop,
            Some(Ok(())) => PlayEnd::CutShort,
            Some(Err(error)) => PlayEnd::NotFinite(error),
            None => self.play(f64::INFINITY, stop, enough, |_| false).end,
        }
    }

    fn step_alone_to(&mut self, step: u64) -> Result<(), NotFinite> {
        while self.simulation.step_number() < step {
            self.step()?;
        }
        Ok(())
    }

    /// Hands over `together` steps at a time, up to `step` or the first one after which `is_enough`. `None` where the system
    /// gives no thread; nothing has been done then.
    fn step_on_cores_to(
        &mut self,
        step: u64,
        together: usize,
        mut is_enough: impl FnMut() -> bool,
    ) -> Option<Result<(), NotFinite>> {
        let Self {
            simulation,
            monitor,
            checkpoints,
            pictures,
            ..
        } = self;
        let (gauges, beside) = monitor.parts();
        let follow = |batch: &Batch| {
            batch.each(|step| {
                gauges.follow(step);
                pictures.follow(step);
                checkpoints.gauges.offer(step.number(), || gauges.clone());
            });
            let (mut number, mut states) = (batch.before_first(), batch.states());
            while !states.is_empty() {
                let (next, later) =
                    states.split_at(checkpoints.besides.until_due(number, states.len()));
                beside.hold_all(next);
                number += next.len() as u64;
                checkpoints.besides.offer(number, || beside.clone());
                states = later;
            }
        };
        thread::scope(|scope| {
            let (to_follow, to_be_followed) = mpsc::sync_channel(WAITING);
            let (seen, blank) = mpsc::channel();
            let follower = follower(scope, to_be_followed, follow, seen)?;
            let mut steps = HandOver::to(to_follow, blank, together);
            let stepped = loop {
                if simulation.step_number() >= step {
                    break Ok(());
                }
                match simulation.step() {
                    Ok(step) => steps.push(step),
                    Err(error) => break Err(error),
                }
                let stored = &mut checkpoints.simulations;
                stored.offer(simulation.step_number(), || bare(simulation));
                if is_enough() {
                    break Ok(());
                }
            };
            steps.finish();
            if let Err(reason) = follower.join() {
                panic::resume_unwind(reason);
            }
            Some(stepped)
        })
    }
}

/// A thread that shows `follow` every one of `batches` and then sends it to `seen`; `None` where the system gives none.
fn follower<'scope>(
    scope: &'scope Scope<'scope, '_>,
    batches: Receiver<Batch>,
    mut follow: impl FnMut(&Batch) + Send + 'scope,
    seen: Sender<Batch>,
) -> Option<ScopedJoinHandle<'scope, ()>> {
    let follow_all = move || {
        for batch in batches {
            follow(&batch);
            drop(seen.send(batch)); // this fails where no more blank batches are wanted
        }
    };
    let thread = thread::Builder::new().name("follower".to_owned());
    thread.spawn_scoped(scope, follow_all).ok()
}

/// Gathers steps into batches, and hands them over.
struct HandOver {
    to: SyncSender<Batch>,
    /// Batches that have been seen: their memory is used again.
    blank: Receiver<Batch>,
    batch: Batch,
    /// The most steps of a batch.
    together: usize,
}

impl HandOver {
    fn to(to: SyncSender<Batch>, blank: Receiver<Batch>, together: usize) -> Self {
        Self {
            to,
            blank,
            batch: Batch::with_capacity(together),
            together,
        }
    }

    #[inline]
    fn push(&mut self, step: &Step) {
        if self.batch.len() == self.together || !self.batch.push(step) {
            let mut blank = match self.blank.try_recv() {
                Ok(seen) => seen,
                Err(_) => Batch::with_capacity(self.together),
            };
            blank.clear();
            blank.push(step);
            self.give(blank);
        }
    }

    /// Hands over the steps so far, and goes on with `next`.
    fn give(&mut self, next: Batch) {
        // This fails only where the other thread has panicked, which is reported where it is joined.
        drop(self.to.send(std::mem::replace(&mut self.batch, next)));
    }

    /// Hands over what is left. The follower ends when it has seen it.
    fn finish(mut self) {
        self.give(Batch::default());
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::Document;
    use std::sync::Arc;

    const STEPS: u64 = 20_000;

    fn run(name: &str) -> LiveRun {
        let mut document = Document::open(name).unwrap();
        document.set("motion.steps=1000000").unwrap();
        LiveRun::new(Arc::new(document.scenario().unwrap()))
    }

    /// All that is read off a run, in digits that tell any two numbers apart.
    fn read(run: &mut LiveRun) -> String {
        let dots: Vec<_> = run.path().dots().collect();
        format!(
            "{:?} {:?} {:?} {dots:?}",
            run.readouts(),
            run.now(),
            run.recording()
        )
    }

    #[test]
    fn it_is_read_as_if_its_steps_were_taken_one_by_one() {
        for name in ["method-2", "wobble-push", "cusps", "wing-nut"] {
            let (mut one_by_one, mut at_once) = (run(name), run(name));
            one_by_one.step_alone_to(STEPS).unwrap();
            at_once.step_to(STEPS).unwrap();
            assert!(
                read(&mut one_by_one) == read(&mut at_once),
                "{name} at {STEPS}"
            );
            // Back at a step behind a checkpoint that was stored on the way.
            for run in [&mut one_by_one, &mut at_once] {
                run.set_out_for(5000);
                while run.destination().is_some() {
                    run.step().unwrap();
                }
            }
            assert!(
                read(&mut one_by_one) == read(&mut at_once),
                "{name} at 5000"
            );
        }
    }

    #[test]
    fn in_a_hurry_it_ends_at_its_stop_or_when_the_time_is_used_up() {
        for name in ["method-2", "wobble-push"] {
            let (mut one_by_one, mut in_parts) = (run(name), run(name));
            let mut parts = 0;
            loop {
                let begin = in_parts.simulation.step_number();
                let mut looks = 0;
                let end = in_parts.hurry_to(STEPS, || {
                    looks += 1;
                    looks == 3
                });
                let here = in_parts.simulation.step_number();
                parts += 1;
                if end == PlayEnd::AtStop {
                    assert_eq!(here, STEPS);
                    break;
                }
                assert_eq!(end, PlayEnd::CutShort);
                let every = in_parts.steps_per_look() as u64;
                assert_eq!(here - begin, 3 * every, "{name}");
            }
            assert!(parts > 10, "{name}: {parts}");
            one_by_one.step_alone_to(STEPS).unwrap();
            assert!(read(&mut one_by_one) == read(&mut in_parts), "{name}");
        }
    }

    #[test]
    fn it_stays_before_the_step_whose_numbers_are_not_finite() {
        let mut document = Document::open("method-2").unwrap();
        document.set("motion.time_step_s=1e3").unwrap();
        document.set("motion.gravity_m_per_s2=1e306").unwrap();
        let scenario = Arc::new(document.scenario().unwrap());
        let mut in_a_hurry = LiveRun::new(Arc::clone(&scenario));
        let (mut one_by_one, mut at_once) =
            (LiveRun::new(Arc::clone(&scenario)), LiveRun::new(scenario));
        let alone = one_by_one.step_alone_to(STEPS);
        assert!(alone.is_err());
        assert_eq!(at_once.step_to(STEPS), alone);
        assert_eq!(at_once.now(), one_by_one.now());
        let end = in_a_hurry.hurry_to(STEPS, || false);
        assert_eq!(Err(end), alone.map_err(PlayEnd::NotFinite));
        assert_eq!(in_a_hurry.now(), one_by_one.now());
    }
}
