//! States of a run that are kept on the way, so that any earlier step is a few steps away.
//!
//! They stand at even distances from the start. When there are too many every second one goes, so that a run of any
//! length has enough of them in bounded memory.

use crate::analysis::Monitor;
use crate::run::Simulation;

/// Steps between two checkpoints at first.
const SPACING: u64 = 256;
/// Memory for all of them, bytes, and what one takes: so much for each point, and the rest.
const MEMORY: usize = 24 << 20;
const OF_A_POINT: usize = 64;
const OF_THE_REST: usize = 9 << 10;
/// However large the body, so many are kept.
const FEWEST: usize = 8;

/// A run as it stood at one step, with what had been measured on it.
#[derive(Clone)]
pub struct Checkpoint {
    /// The run.
    pub simulation: Simulation,
    /// What followed it.
    pub monitor: Monitor,
}

impl Checkpoint {
    /// The step it stands at.
    pub fn step(&self) -> u64 {
        self.simulation.step_number()
    }
}

/// The checkpoints of one run, the first at its start.
pub struct Checkpoints {
    start: Checkpoint,
    later: Vec<Checkpoint>,
    spacing: u64,
    most: usize,
}

impl Checkpoints {
    /// The checkpoints of a run that stands at step 0.
    pub fn new(simulation: &Simulation, monitor: &Monitor) -> Self {
        let points = simulation.scenario().body.mechanics.points().len();
        Self {
            start: Checkpoint {
                simulation: simulation.clone(),
                monitor: monitor.clone(),
            },
            later: Vec::new(),
            spacing: SPACING,
            most: (MEMORY / (OF_THE_REST + OF_A_POINT * points)).max(FEWEST),
        }
    }

    /// Keeps the run as it stands, if it is time to; to be shown every step.
    #[inline]
    pub fn offer(&mut self, simulation: &Simulation, monitor: &Monitor) {
        if simulation.step_number().is_multiple_of(self.spacing) {
            self.keep(simulation, monitor);
        }
    }

    fn keep(&mut self, simulation: &Simulation, monitor: &Monitor) {
        let step = simulation.step_number();
        if self.later.last().is_some_and(|last| last.step() >= step) || step == 0 {
            return; // it has been here before
        }
        self.later.push(Checkpoint {
            simulation: simulation.clone(),
            monitor: monitor.clone(),
        });
        if self.later.len() > self.most {
            self.spacing *= 2;
            let spacing = self.spacing;
            self.later
                .retain(|checkpoint| checkpoint.step().is_multiple_of(spacing));
        }
    }

    /// The last one that does not stand later than `step`.
    pub fn before(&self, step: u64) -> &Checkpoint {
        let earlier = self
            .later
            .partition_point(|checkpoint| checkpoint.step() <= step);
        earlier
            .checked_sub(1)
            .map_or(&self.start, |last| &self.later[last])
    }

    /// Forgets those that stand later than `step`: from there on the run goes another way.
    pub fn cut_back(&mut self, step: u64) {
        let earlier = self
            .later
            .partition_point(|checkpoint| checkpoint.step() <= step);
        self.later.truncate(earlier);
    }
}
