//! How far a run strays from the exact motion beside it, held step by step. It needs nothing of the run but its states, so
//! that it may be found on another core than the one that steps.

use super::cost::is_affordable;
use super::farthest::Farthest;
use super::trial::Deviation;
use crate::physics::State;
use crate::run::Truth;
use crate::scenario::Scenario;
use std::sync::Arc;

/// The exact motion beside one run, and how far the run has been off it.
#[derive(Clone, Debug)]
pub struct Beside {
    /// `None` where it would take too long, or has left the range of numbers.
    truth: Option<Truth>,
    farthest: Farthest,
}

impl Beside {
    /// The exact motion beside the run of `scenario`, which stands at its start.
    pub fn new(scenario: &Arc<Scenario>) -> Self {
        let truth = is_affordable(scenario).then(|| Truth::new(Arc::clone(scenario)));
        Self {
            truth,
            farthest: Farthest::new(scenario.arm_m()),
        }
    }

    /// Goes on beside a run of `scenario`, whose past is the same.
    pub fn go_on_in(&mut self, scenario: &Arc<Scenario>) {
        self.settle(); // its steps so far belong to the forces so far
        match &mut self.truth {
            Some(truth) => truth.go_on_in(scenario),
            None => self.truth = Some(Truth::new(Arc::clone(scenario))),
        }
        self.truth.take_if(|_| !is_affordable(scenario));
    }

    /// Whether the run is held against the exact motion.
    pub fn is_known(&self) -> bool {
        self.truth.is_some()
    }

    /// The exact motion, where the run is held against it.
    pub fn truth(&mut self) -> Option<&mut Truth> {
        self.settle();
        self.truth.as_mut()
    }

    /// Holds the distance of the next `state` of the run.
    #[inline]
    pub fn hold(&mut self, state: &State) {
        if let Some(truth) = &mut self.truth
            && !self.farthest.follow(state, truth)
        {
            self.truth = None; // it has left the range of numbers, and does not come back
        }
    }

    /// The same of the next `states`, in less time.
    pub fn hold_all(&mut self, states: &[State]) {
        if let Some(truth) = &mut self.truth
            && !self.farthest.follow_all(states, truth)
        {
            self.truth = None;
        }
    }

    /// Computes the largest distance so far to the last bit.
    pub fn settle(&mut self) {
        if let Some(truth) = &mut self.truth
            && !self.farthest.settle(truth)
        {
            self.truth = None;
        }
    }

    /// How far off the run is in `state`; `None` where it is not held against the exact motion.
    pub fn deviation(&mut self, state: &State) -> Option<Deviation> {
        self.settle();
        let deviation = Deviation::of(state, self.truth.as_mut()?);
        if !self.farthest.take_in(deviation.distance_m) {
            self.truth = None;
        }
        self.truth.as_ref().map(|_| deviation)
    }

    /// The largest distance of the traced point from the exact motion up to the last time that it was [settled](Self::settle),
    /// m; 0 where it is not held against that.
    pub fn most_distance_m(&self) -> f64 {
        self.farthest.most_m()
    }
}
