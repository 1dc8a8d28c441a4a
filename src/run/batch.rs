//! Consecutive steps of a run, for whoever follows it on another core.
//!
//! A [`Step`] is read where the [simulation](super::Simulation) stands. What a step has that the one before has not is
//! little: a batch holds its first step whole, and of each further one the state and the work done. The further ones have
//! the forces of the first; where these change, another batch begins.

use super::Step;
use crate::physics::State;

/// Consecutive steps under the same forces.
#[derive(Clone, Debug, Default)]
pub struct Batch {
    first: Option<Step>,
    further: Vec<Further>,
}

/// What a step has that the one before has not.
#[derive(Clone, Copy, Debug)]
pub(super) struct Further {
    pub after: State,
    /// Work of pushes and edits since the start of the run, J.
    pub work: f64,
    /// Work of friction since then, J.
    pub friction: f64,
}

impl Batch {
    /// An empty one, with memory for `steps`.
    pub fn with_capacity(steps: usize) -> Self {
        Self {
            first: None,
            further: Vec::with_capacity(steps),
        }
    }

    /// Appends `step`, the one after the last. Returns false, and does not, where it belongs into another batch.
    #[inline]
    pub fn push(&mut self, step: &Step) -> bool {
        let Some(first) = &self.first else {
            self.first = Some(step.clone());
            return true;
        };
        let goes_on = step.changes == first.changes && step.segment == first.segment;
        if goes_on {
            self.further.push(Further {
                after: step.after,
                work: step.energy.work,
                friction: step.energy.friction,
            });
        }
        goes_on
    }

    /// The number of its steps.
    pub fn len(&self) -> usize {
        usize::from(self.first.is_some()) + self.further.len()
    }

    /// Whether it has no step.
    pub fn is_empty(&self) -> bool {
        self.first.is_none()
    }

    /// Removes its steps, and keeps their memory.
    pub fn clear(&mut self) {
        self.first = None;
        self.further.clear();
    }

    /// Shows `follow` each of its steps, as the run stood there; workings are those of the first alone.
    pub fn each(&self, mut follow: impl FnMut(&Step)) {
        let Some(mut step) = self.first.clone() else {
            return;
        };
        follow(&step);
        for further in &self.further {
            step.go_on(further);
            follow(&step);
        }
    }

    /// The number and the state of each of its steps: what [`each`](Self::each) shows, for who needs no more.
    pub fn states(&self) -> impl Iterator<Item = (u64, &State)> {
        let begin = self.first.as_ref().map_or(0, Step::number);
        let first = self.first.iter().map(Step::after);
        let states = first.chain(self.further.iter().map(|further| &further.after));
        (begin..).zip(states)
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
            let handed = batches.iter().flat_map(Batch::states);
            assert!(
                handed.map(|(step, state)| (step, *state)).eq(states),
                "{preset}"
            );
            assert_eq!(batches.len() > 1, preset.starts_with("wobble"), "{preset}");
        }
    }
}
