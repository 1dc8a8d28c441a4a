//! Stored states of a run, from which any earlier step is computed again in a few steps.
//!
//! They are equally spaced from the start. When there are too many, every second one is dropped and the spacing doubles,
//! so that memory is bounded however long the run is.

use crate::analysis::{Beside, Monitor};
use crate::run::Simulation;

/// Steps between two checkpoints at first.
const SPACING: u64 = 256;
/// Memory for all checkpoints, bytes.
const MEMORY: usize = 24 << 20;
/// Memory of one checkpoint for each point of the body, bytes.
const PER_POINT: usize = 64;
/// Memory of one checkpoint besides its points, bytes.
const PER_CHECKPOINT: usize = 9 << 10;
/// Least number of checkpoints, however large the body.
const FEWEST: usize = 8;

/// A run at one step, with the measurements up to there.
#[derive(Clone)]
pub struct Checkpoint {
    /// The run.
    pub simulation: Simulation,
    /// The measurements on its steps.
    pub monitor: Monitor,
}

impl Checkpoint {
    /// Of a run as it stands. Workings are left out: they may take much memory, and are found again by a step.
    fn of(simulation: &Simulation, monitor: &Monitor) -> Self {
        let mut simulation = simulation.clone();
        simulation.keep_workings(false);
        Self {
            simulation,
            monitor: monitor.clone(),
        }
    }

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
            start: Checkpoint::of(simulation, monitor),
            later: Vec::new(),
            spacing: SPACING,
            most: (MEMORY / (PER_CHECKPOINT + PER_POINT * points)).max(FEWEST),
        }
    }

    /// Stores the run's present state if its step is a multiple of the spacing. To be called after every step. Returns
    /// whether it was.
    #[inline]
    pub fn offer(&mut self, simulation: &Simulation, monitor: &Monitor) -> bool {
        let is_due = simulation.step_number().is_multiple_of(self.spacing);
        if is_due {
            self.keep(simulation, monitor);
        }
        is_due
    }

    /// Gives the checkpoint at `step`, if it is stored, what was found of its distance from the exact motion later.
    pub fn set_beside(&mut self, step: u64, beside: Beside) {
        if let Ok(place) = self.later.binary_search_by_key(&step, Checkpoint::step) {
            self.later[place].monitor.set_beside(beside);
        }
    }

    fn keep(&mut self, simulation: &Simulation, monitor: &Monitor) {
        let step = simulation.step_number();
        if self.later.last().is_some_and(|last| last.step() >= step) || step == 0 {
            return; // this step is stored already
        }
        self.later.push(Checkpoint::of(simulation, monitor));
        if self.later.len() > self.most {
            self.spacing *= 2;
            let spacing = self.spacing;
            self.later
                .retain(|checkpoint| checkpoint.step().is_multiple_of(spacing));
        }
    }

    /// The last checkpoint at `step` or earlier.
    pub fn before(&self, step: u64) -> &Checkpoint {
        let earlier = self
            .later
            .partition_point(|checkpoint| checkpoint.step() <= step);
        earlier
            .checked_sub(1)
            .map_or(&self.start, |last| &self.later[last])
    }

    /// Drops the checkpoints later than `step`, because the run changes from there on.
    pub fn cut_back(&mut self, step: u64) {
        let earlier = self
            .later
            .partition_point(|checkpoint| checkpoint.step() <= step);
        self.later.truncate(earlier);
    }
}
