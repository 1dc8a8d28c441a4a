//! Stored states of a run, from which any earlier step is computed again in a few steps.
//!
//! They are equally spaced from the start. When there are too many, every second one is dropped and the spacing doubles,
//! so that memory is bounded however long the run is.
//!
//! A checkpoint has three parts, each in a series of its own, so that each can be stored on the core where it is found.
//! All series have the same steps, because every one of them is offered every step.

use crate::analysis::{Beside, Gauges, Monitor};
use crate::run::Simulation;

/// Steps between two checkpoints at first; a power of two.
const SPACING: u64 = 256;
/// Memory for all checkpoints, bytes.
const MEMORY: usize = 24 << 20;
/// Memory of one checkpoint for each point of the body, bytes.
const PER_POINT: usize = 64;
/// Memory of one checkpoint besides its points, bytes.
const PER_CHECKPOINT: usize = 9 << 10;
/// Least number of checkpoints, however large the body.
const FEWEST: usize = 8;

/// One part of the checkpoints of a run, the first at its start.
pub struct Series<T> {
    start: T,
    later: Vec<(u64, T)>,
    spacing: u64,
    most: usize,
}

impl<T> Series<T> {
    fn new(start: T, most: usize) -> Self {
        Self {
            start,
            later: Vec::new(),
            spacing: SPACING,
            most,
        }
    }

    /// Stores what `part` gives if `step`, at which the run stands, is a multiple of the spacing. To be called after every
    /// step.
    #[inline]
    pub fn offer(&mut self, step: u64, part: impl FnOnce() -> T) {
        if step & (self.spacing - 1) == 0 {
            self.keep(step, part);
        }
    }

    /// How many of the `steps` steps after `step` lead to the next that may be stored, or to the last of them.
    pub fn until_due(&self, step: u64, steps: usize) -> usize {
        let until_due = self.spacing - (step & (self.spacing - 1));
        usize::try_from(until_due).map_or(steps, |until_due| until_due.min(steps))
    }

    fn keep(&mut self, step: u64, part: impl FnOnce() -> T) {
        if self.later.last().is_some_and(|(last, _)| *last >= step) || step == 0 {
            return; // this step is stored already
        }
        self.later.push((step, part()));
        if self.later.len() > self.most {
            self.spacing *= 2;
            let spacing = self.spacing;
            self.later.retain(|(step, _)| step.is_multiple_of(spacing));
        }
    }

    /// The part of the last checkpoint at `step` or earlier.
    fn before(&self, step: u64) -> &T {
        let earlier = self.later.partition_point(|(at, _)| *at <= step);
        earlier
            .checked_sub(1)
            .map_or(&self.start, |last| &self.later[last].1)
    }

    fn cut_back(&mut self, step: u64) {
        let earlier = self.later.partition_point(|(at, _)| *at <= step);
        self.later.truncate(earlier);
    }
}

/// The checkpoints of one run, the first at its start.
pub struct Checkpoints {
    /// The run as it stood.
    pub simulations: Series<Simulation>,
    /// What was measured on its steps up to there.
    pub gauges: Series<Gauges>,
    /// How far it had been off the exact motion.
    pub besides: Series<Beside>,
}

impl Checkpoints {
    /// The checkpoints of a run that stands at step 0.
    pub fn new(simulation: &Simulation, monitor: &Monitor) -> Self {
        let points = simulation.scenario().body.mechanics.points().len();
        let most = (MEMORY / (PER_CHECKPOINT + PER_POINT * points)).max(FEWEST);
        Self {
            simulations: Series::new(bare(simulation), most),
            gauges: Series::new(monitor.gauges().clone(), most),
            besides: Series::new(monitor.beside(), most),
        }
    }

    /// Offers a run as it stands, with the measurements on its steps, to all series. To be called after every step.
    #[inline]
    pub fn offer(&mut self, simulation: &Simulation, monitor: &Monitor) {
        let step = simulation.step_number();
        self.simulations.offer(step, || bare(simulation));
        self.gauges.offer(step, || monitor.gauges().clone());
        self.besides.offer(step, || monitor.beside());
    }

    /// The run at the last checkpoint that is at `step` or earlier.
    pub fn before(&self, step: u64) -> &Simulation {
        self.simulations.before(step)
    }

    /// The measurements up to there.
    pub fn monitor_before(&self, step: u64) -> Monitor {
        Monitor::of(
            self.gauges.before(step).clone(),
            self.besides.before(step).clone(),
        )
    }

    /// Drops the checkpoints later than `step`, because the run changes from there on.
    pub fn cut_back(&mut self, step: u64) {
        self.simulations.cut_back(step);
        self.gauges.cut_back(step);
        self.besides.cut_back(step);
    }
}

/// A copy of the run without its workings: they may take much memory, and are found again by a step.
pub fn bare(simulation: &Simulation) -> Simulation {
    let mut simulation = simulation.clone();
    simulation.keep_workings(false);
    simulation
}
