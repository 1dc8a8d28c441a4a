//! Many steps at once: while one core takes them, another holds them against the exact motion, which takes as long.

use super::LiveRun;
use crate::analysis::{Beside, Monitor};
use crate::physics::State;
use crate::run::NotFinite;
use std::panic;
use std::sync::mpsc::{self, Receiver, Sender};
use std::thread;

/// Fewer steps than this are not worth a thread.
const FEWEST: u64 = 4096;
/// The most steps that are handed over together.
const TOGETHER: usize = 1024;

/// Steps in order, for the other core.
struct Handed {
    states: Vec<State>,
    /// The step of the last of them if a checkpoint was stored there, which lacks what is found of them.
    checkpoint: Option<u64>,
}

impl LiveRun {
    /// Steps until the run stands at `step`. All that is read off it then is as if it had taken them
    /// [one by one](Self::step).
    ///
    /// # Errors
    /// When the numbers stop being finite; the run then stays at the step before.
    pub fn step_to(&mut self, step: u64) -> Result<(), NotFinite> {
        let steps = step.saturating_sub(self.simulation.step_number());
        if steps < FEWEST || !self.monitor.beside().is_known() {
            return self.step_alone_to(step);
        }
        thread::scope(|scope| {
            let beside = self.monitor.beside().clone();
            let (hand_over, handed) = mpsc::channel();
            let holding = thread::Builder::new()
                .name("beside".to_owned())
                .spawn_scoped(scope, || hold(beside, handed));
            let Ok(holding) = holding else {
                return self.step_alone_to(step); // the system gives no thread
            };
            let stepped = self.step_handing_over(step, &hand_over);
            drop(hand_over);
            let (beside, at_checkpoints) = match holding.join() {
                Ok(held) => held,
                Err(reason) => panic::resume_unwind(reason),
            };
            self.monitor.set_beside(beside);
            for (step, beside) in at_checkpoints {
                self.checkpoints.set_beside(step, beside);
            }
            stepped
        })
    }

    fn step_alone_to(&mut self, step: u64) -> Result<(), NotFinite> {
        while self.simulation.step_number() < step {
            self.step()?;
        }
        Ok(())
    }

    /// Steps until the run stands at `step`, and gives the states to whoever holds them against the exact motion.
    fn step_handing_over(
        &mut self,
        step: u64,
        hand_over: &Sender<Handed>,
    ) -> Result<(), NotFinite> {
        // Sending fails only where the other thread has panicked, which is reported where it is joined.
        let give = |states: &mut Vec<State>, checkpoint| {
            let states = std::mem::replace(states, Vec::with_capacity(TOGETHER));
            let _ = hand_over.send(Handed { states, checkpoint });
        };
        let mut states = Vec::with_capacity(TOGETHER);
        let mut stepped = Ok(());
        while stepped.is_ok() && self.simulation.step_number() < step {
            match self.take_step(Monitor::measure) {
                Ok(is_stored) => {
                    states.push(*self.simulation.state());
                    let checkpoint = is_stored.then_some(self.simulation.step_number());
                    if is_stored || states.len() == TOGETHER {
                        give(&mut states, checkpoint);
                    }
                }
                Err(error) => stepped = Err(error),
            }
        }
        give(&mut states, None);
        stepped
    }
}

/// Holds the steps that are handed over against the exact motion. Returns what was found of all of them, and up to each
/// checkpoint.
fn hold(mut beside: Beside, handed: Receiver<Handed>) -> (Beside, Vec<(u64, Beside)>) {
    let mut at_checkpoints = Vec::new();
    for Handed { states, checkpoint } in handed {
        states.iter().for_each(|state| beside.hold(state));
        at_checkpoints.extend(checkpoint.map(|step| (step, beside.clone())));
    }
    (beside, at_checkpoints)
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
    fn it_stays_before_the_step_whose_numbers_are_not_finite() {
        let mut document = Document::open("method-2").unwrap();
        document.set("motion.time_step_s=1e3").unwrap();
        document.set("motion.gravity_m_per_s2=1e306").unwrap();
        let scenario = Arc::new(document.scenario().unwrap());
        let (mut one_by_one, mut at_once) =
            (LiveRun::new(Arc::clone(&scenario)), LiveRun::new(scenario));
        let alone = one_by_one.step_alone_to(STEPS);
        assert!(alone.is_err());
        assert_eq!(at_once.step_to(STEPS), alone);
        assert_eq!(at_once.now(), one_by_one.now());
    }
}
