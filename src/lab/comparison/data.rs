//! Measured data compared with the run: the values of the same quantities in the run at the same times, and the
//! residuals.
//!
//! A second simulation of the run's scenario follows the run, like the exact motion does, and reads it at the measured
//! times. It also records the measured quantities that the run's own recording does not contain, so that their curves
//! can be drawn. [`Compared`] holds data and run side by side.

use super::OwnCode;
use crate::engine::data::compared::Compared;
use crate::engine::data::{ColumnOptions, MeasuredData, RunQuantity, RunReader, TimeSeries};
use crate::engine::recording::{RecordedCurve, RecordedSample, Recording};
use crate::engine::run::Simulation;
use crate::engine::scenario::{Problems, Scenario};
use nalgebra::Vector3;
use std::sync::Arc;

/// Number of quantities in a recording besides the tilt: in the places of x, y and z.
const IN_A_RECORDING: usize = RecordedCurve::OF_POINT.len();

/// Measured data, and the corresponding values of the run so far.
pub struct DataComparison {
    pub name: String,
    /// The user's options for its columns.
    pub(in crate::lab) options: ColumnOptions,
    pub measured: Arc<MeasuredData>,
    pub own: Option<OwnCode>,
    series: Arc<TimeSeries>,
    simulation: Simulation,
    reader: RunReader<Arc<TimeSeries>>,
    recorded: Vec<Recording>,
    before: Vec<Recording>,
    /// True if the run's numbers stopped being finite on the way.
    has_broken: bool,
    pub compared: Compared,
}

impl DataComparison {
    /// Creates a comparison of `measured` with the run of `scenario`, without any values of the run yet.
    ///
    /// # Errors
    /// Returns an error if the data are not a time series.
    pub(super) fn new(
        name: &str,
        options: &ColumnOptions,
        measured: MeasuredData,
        scenario: &Arc<Scenario>,
    ) -> Result<Self, Problems> {
        let series = Arc::new(measured.series()?.clone());
        let mut comparison = Self {
            name: name.to_owned(),
            options: options.clone(),
            own: None,
            simulation: Simulation::new(Arc::clone(scenario)),
            reader: RunReader::new(Arc::clone(&series)),
            recorded: Vec::new(),
            before: Vec::new(),
            has_broken: false,
            compared: Compared::default(),
            series,
            measured: Arc::new(measured),
        };
        comparison.begin(scenario);
        Ok(comparison)
    }

    pub fn quantities(&self) -> impl Iterator<Item = &'static RunQuantity> + Clone + '_ {
        self.series.curves.iter().map(|curve| curve.quantity)
    }

    pub fn last_s(&self) -> Option<f64> {
        self.series.times_s.last().copied()
    }

    /// Returns the recording that contains the quantity with this index, and its curve there; `None` if it is not
    /// recorded here.
    pub fn recorded(&self, index: usize) -> Option<(&Recording, RecordedCurve)> {
        self.place_of(index, &self.recorded)
    }

    pub fn recorded_before(&self, index: usize) -> Option<(&Recording, RecordedCurve)> {
        self.place_of(index, &self.before)
    }

    fn place_of<'a>(
        &self,
        index: usize,
        recordings: &'a [Recording],
    ) -> Option<(&'a Recording, RecordedCurve)> {
        let place = self.recorded_here().position(|(other, _)| other == index)?;
        let recording = recordings.get(place / IN_A_RECORDING)?;
        Some((recording, RecordedCurve::OF_POINT[place % IN_A_RECORDING]))
    }

    /// Returns the quantities that the run's own recording does not contain, with their indices.
    fn recorded_here(&self) -> impl Iterator<Item = (usize, &'static RunQuantity)> + '_ {
        let quantities = self.quantities().enumerate();
        quantities.filter(|(_, quantity)| {
            RecordedCurve::ALL
                .iter()
                .all(|curve| curve.column() != quantity.name)
        })
    }

    pub(super) fn begin(&mut self, scenario: &Arc<Scenario>) {
        self.simulation = Simulation::new(Arc::clone(scenario));
        self.reader = RunReader::new(Arc::clone(&self.series));
        let recordings = self.recorded_here().count().div_ceil(IN_A_RECORDING);
        self.recorded = vec![Recording::default(); recordings];
        self.has_broken = false;
        self.record();
    }

    /// Restarts with `scenario`, and keeps the recordings of the previous run for comparison.
    pub(super) fn begin_after_ghost(&mut self, scenario: &Arc<Scenario>) {
        self.before = std::mem::take(&mut self.recorded);
        self.begin(scenario);
    }

    /// Continues with `scenario`, which has the same motion up to `step`.
    pub(super) fn branch(&mut self, scenario: &Arc<Scenario>, step: u64) {
        if self.simulation.step_number() > step || self.has_broken {
            return self.begin(scenario);
        }
        self.simulation.branch(Arc::clone(scenario));
        self.reader.forget_after(self.simulation.now().time_s());
    }

    /// Returns true if it is behind a run that is at `step`.
    pub(super) fn is_behind(&self, step: u64) -> bool {
        let has_to_go_on = !self.recorded.is_empty() || self.reader.next_time_s().is_some();
        has_to_go_on && !self.has_broken && self.simulation.step_number() < step
    }

    /// Follows a run to `step`, or until `enough` returns true.
    pub(super) fn follow(&mut self, step: u64, mut enough: impl FnMut() -> bool) {
        while self.is_behind(step) {
            let gone_on = self.reader.read_to_next_step(&self.simulation);
            if gone_on.is_err() || self.simulation.step().is_err() {
                self.has_broken = true;
                return;
            }
            self.record();
            if enough() {
                return;
            }
        }
        if !self.has_broken && self.simulation.step_number() <= step {
            // Reads values measured at exactly this step. If the next step breaks down, the run reports it.
            self.has_broken = self.reader.read_to_next_step(&self.simulation).is_err();
        }
    }

    fn record(&mut self) {
        let now = self.simulation.now();
        let values: Vec<f64> = self
            .recorded_here()
            .map(|(_, quantity)| quantity.value_at(now))
            .collect();
        let (time_s, axle_height) = (now.time_s(), now.after().axle().z);
        for (group, recording) in values.chunks(IN_A_RECORDING).zip(&mut self.recorded) {
            recording.push(&RecordedSample {
                time_s,
                position: Vector3::from_fn(|place, _| {
                    group.get(place).copied().unwrap_or_default()
                }),
                axle_height,
            });
        }
    }

    pub(super) fn compare(&mut self, now_s: f64) {
        let scenario = self.simulation.scenario();
        let traced = &scenario.body.mechanics.points()[scenario.trace].at;
        self.compared = Compared::new(&self.series, self.reader.values(), now_s, traced);
    }
}
