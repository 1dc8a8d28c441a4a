//! Consecutive steps of a run, for whoever follows it on another core.
//!
//! A [`Step`] is read where the [simulation](super::Simulation) stands. What a step has that the one before has not is
//! little: a batch holds its first step whole, and of each one the state and the work done. All have the forces of the first;
//! where these change, another batch begins.

use super::Step;
use crate::physics::State;

/// Consecutive steps under the same forces.
#[derive(Clone, Debug, Default)]
pub struct Batch {
    first: Option<Step>,
    /// After each step.
    states: Vec<State>,
    /// Up to the end of each step.
    work: Vec<Work>,
}

/// Work done since the start of the run.
#[derive(Clone, Copy, Debug)]
pub(super) struct Work {
    /// Of pushes and edits, J.
    pub outside: f64,
    /// Of friction, J.
    pub friction: f64,
}

impl Batch {
    /// An empty one, with memory for `steps`.
    pub fn with_capacity(steps: usize) -> Self {
        Self {
            first: None,
            states: Vec::with_capacity(steps),
            work: Vec::with_capacity(steps),
        }
    }

    /// Appends `step`, the one after the last. Returns false, and does not, where it belongs into another batch.
    #[inline]
    pub fn push(&mut self, step: &Step) -> bool {
        match &self.first {
            Some(first) if step.changes != first.changes || step.segment != first.segment => {
                return false;
            }
            Some(_) => {}
            None => self.first = Some(step.clone()),
        }
        self.states.push(step.after);
        self.work.push(Work {
            outside: step.energy.work,
            friction: step.energy.friction,
        });
        true
    }

    /// The number of its steps.
    pub fn len(&self) -> usize {
        self.states.len()
    }

    /// Whether it has no step.
    pub fn is_empty(&self) -> bool {
        self.states.is_empty()
    }

    /// Removes its steps, and keeps their memory.
    pub fn clear(&mut self) {
        self.first = None;
        self.states.clear();
        self.work.clear();
    }

    /// Shows `follow` each of its steps, as the run stood there; workings are those of the first alone.
    pub fn each(&self, mut follow: impl FnMut(&Step)) {
        let Some(mut step) = self.first.clone() else {
            return;
        };
        follow(&step);
        for (state, work) in self.states.iter().zip(&self.work).skip(1) {
            step.go_on(state, work);
            follow(&step);
        }
    }

    /// The number of the step before its first; 0 where it has none.
    pub fn before_first(&self) -> u64 {
        self.first
            .as_ref()
            .map_or(0, |first| first.number.saturating_sub(1))
    }

    /// The state after each of its steps: of what [`each`](Self::each) shows this alone, for who needs no more.
    pub fn states(&self) -> &[State] {
        &self.states
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::Simulation;
    use crate::scenario::Document;
    use std::sync::Arc;

    #[test]
    fn its_steps_are_those_of_the_run() {
        // Under a push that begins and ends, with friction, and with neither.
        for preset in [
            "wobble-push",
            "wobble-push-accumulating",
            "cusps",
            "wing-nut",
        ] {
            let scenario = Document::open(preset).unwrap().scenario().unwrap();
            let mut simulation = Simulation::new(Arc::new(scenario));
            let (mut seen, mut states, mut batches) =
                (Vec::new(), Vec::new(), vec![Batch::default()]);
            for _ in 0..400 {
                let step = simulation.step().unwrap();
                let everything = (
                    format!("{:?}", step.sample()),
                    format!("{:?} {:?}", step.before(), step.loads()),
                    (step.energy_drift(), step.friction_work(), step.changes()),
                );
                seen.push(everything);
                states.push((step.number(), *step.after()));
                if !batches.last_mut().unwrap().push(step) {
                    let mut next = Batch::default();
                    assert!(next.push(step));
                    batches.push(next);
                }
            }
            let mut again = Vec::new();
            for batch in &batches {
                batch.each(|step| {
                    again.push((
                        format!("{:?}", step.sample()),
                        format!("{:?} {:?}", step.before(), step.loads()),
                        (step.energy_drift(), step.friction_work(), step.changes()),
                    ));
                });
            }
            assert!(again == seen, "{preset}");
            let handed = batches.iter().flat_map(|batch| {
                let numbers = batch.before_first() + 1..;
                numbers.zip(batch.states().iter().copied())
            });
            assert!(handed.eq(states), "{preset}");
            assert_eq!(batches.len() > 1, preset.starts_with("wobble"), "{preset}");
        }
    }
}
