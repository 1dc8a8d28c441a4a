//! Stored states of a run, from which any earlier step is computed again in a few steps.
//!
//! They are equally spaced from the start. When there are too many, every second one is dropped and the spacing doubles,
//! so that memory is bounded however long the run is.

use crate::analysis::Monitor;
use crate::run::Simulation;

/// Steps between two checkpoints at first; a power of two.
const SPACING: u64 = 256;
const MEMORY: usize = 24 << 20;
const PER_POINT: usize = 64;
/// Memory of one checkpoint besides its points, bytes.
const PER_CHECKPOINT: usize = 16 << 10;
/// Least number of checkpoints, however large the body.
const FEWEST: usize = 8;

/// A run as it stood, and what was measured on its steps up to there.
pub struct Checkpoint {
    pub simulation: Simulation,
    pub monitor: Monitor,
}

pub struct Checkpoints {
    /// In order; the first is that of the start.
    stored: Vec<Checkpoint>,
    spacing: u64,
    most: usize,
}

impl Checkpoint {
    fn of(simulation: &Simulation, monitor: &Monitor) -> Self {
        let mut simulation = simulation.clone();
        simulation.keep_workings(false); // they may take much memory, and are found again by a step
        Self {
            simulation,
            monitor: monitor.clone(),
        }
    }

    fn step(&self) -> u64 {
        self.simulation.step_number()
    }
}

impl Checkpoints {
    pub fn new(simulation: &Simulation, monitor: &Monitor) -> Self {
        let points = simulation.scenario().body.mechanics.points().len();
        Self {
            stored: vec![Checkpoint::of(simulation, monitor)],
            spacing: SPACING,
            most: (MEMORY / (PER_CHECKPOINT + PER_POINT * points)).max(FEWEST),
        }
    }

    /// Stores a run and the measurements on its steps if its step is a multiple of the spacing. To be called after every step.
    #[inline]
    pub fn offer(&mut self, simulation: &Simulation, monitor: &Monitor) {
        if simulation.step_number() & (self.spacing - 1) == 0 {
            self.keep(simulation, monitor);
        }
    }

    fn keep(&mut self, simulation: &Simulation, monitor: &Monitor) {
        if self.before(u64::MAX).step() >= simulation.step_number() {
            return; // this step is stored already
        }
        self.stored.push(Checkpoint::of(simulation, monitor));
        if self.stored.len() > self.most + 1 {
            self.spacing *= 2;
            let spacing = self.spacing;
            let stays = |stored: &Checkpoint| stored.step().is_multiple_of(spacing);
            self.stored.retain(stays);
        }
    }

    pub fn before(&self, step: u64) -> &Checkpoint {
        let begun = self.stored.partition_point(|stored| stored.step() <= step);
        &self.stored[begun.saturating_sub(1)]
    }

    pub fn cut_back(&mut self, step: u64) {
        self.stored.retain(|stored| stored.step() <= step);
    }
}
