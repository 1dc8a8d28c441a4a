//! A column of the run's CSV, recorded over time for a separate strip.
//!
//! A second simulation of the run's scenario follows the run, as for measured data. The value of the column is recorded
//! at each of its steps.

use crate::engine::data::RunQuantity;
use crate::engine::recording::Recording;
use crate::engine::run::Simulation;
use crate::engine::scenario::Scenario;
use std::sync::Arc;

pub struct RecordedColumn {
    pub quantity: &'static RunQuantity,
    simulation: Simulation,
    /// The recording of the column, in the place of x.
    recording: Recording,
    before: Option<Recording>,
    /// True if the run's numbers stopped being finite on the way.
    has_broken: bool,
}

impl RecordedColumn {
    pub(super) fn new(quantity: &'static RunQuantity, scenario: &Arc<Scenario>) -> Self {
        let mut column = Self {
            quantity,
            simulation: Simulation::new(Arc::clone(scenario)),
            recording: Recording::default(),
            before: None,
            has_broken: false,
        };
        column.record();
        column
    }

    pub fn recording(&self) -> &Recording {
        &self.recording
    }

    /// Returns the recording of the previous run, as far as it was played.
    pub fn before(&self) -> Option<&Recording> {
        self.before.as_ref()
    }

    pub(super) fn begin(&mut self, scenario: &Arc<Scenario>) {
        let before = self.before.take();
        *self = Self {
            before,
            ..Self::new(self.quantity, scenario)
        };
    }

    /// Restarts with `scenario`, and keeps the recording for comparison.
    pub(super) fn begin_after_ghost(&mut self, scenario: &Arc<Scenario>) {
        self.before = Some(std::mem::take(&mut self.recording));
        self.begin(scenario);
    }

    /// Continues with `scenario`, which has the same motion up to `step`.
    pub(super) fn branch(&mut self, scenario: &Arc<Scenario>, step: u64) {
        if self.simulation.step_number() > step || self.has_broken {
            self.begin(scenario);
        } else {
            self.simulation.branch(Arc::clone(scenario));
        }
    }

    pub(super) fn is_behind(&self, step: u64) -> bool {
        !self.has_broken && self.simulation.step_number() < step
    }

    /// Follows a run to `step`, or until `enough` returns true.
    pub(super) fn follow(&mut self, step: u64, mut enough: impl FnMut() -> bool) {
        while self.is_behind(step) {
            if self.simulation.step().is_err() {
                self.has_broken = true;
                return;
            }
            self.record();
            if enough() {
                return;
            }
        }
    }

    fn record(&mut self) {
        let now = self.simulation.now();
        let value = self.quantity.value_at(now);
        self.recording
            .push_values(now.time_s(), [value, 0.0, 0.0, 0.0]);
    }
}
