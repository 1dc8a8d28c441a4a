//! Reads the quantities of a series from a run, at the times at which they were measured.
//!
//! Between two steps, the scheme takes one shorter step. Nothing is interpolated, and the value is as accurate as at
//! the steps. If the motion does not depend on the steps, as with `exact`, it is computed from one measured time to the
//! next, and the time step does not matter. The length of the run does not matter either: the motion continues after
//! its last step.

use super::TimeSeries;
use crate::run::{NotFinite, Simulation};
use crate::scenario::{Scenario, Window};
use std::borrow::Borrow;
use std::sync::Arc;

/// Number of steps between two calls of `go_on`.
const DATA_BLOCK_STEPS: u64 = 4096;

/// Reads a run at the times of a series, which it borrows or shares, while the run is stepped.
#[derive(Clone, Debug)]
pub struct RunReader<S> {
    series: S,
    /// Index of the next point to read, for each curve.
    next: Vec<usize>,
    values: Vec<Vec<f64>>,
}

impl<S: Borrow<TimeSeries>> RunReader<S> {
    pub fn new(series: S) -> Self {
        let curves = series.borrow().curves.len();
        Self {
            next: vec![0; curves],
            values: vec![Vec::new(); curves],
            series,
        }
    }

    /// Drops the values read after `time_s`, because the run has changed from there on.
    pub fn forget_after(&mut self, time_s: f64) {
        let series = self.series.borrow();
        let curves = series.curves.iter().zip(&mut self.next);
        for ((curve, next), values) in curves.zip(&mut self.values) {
            let read = &curve.points[..*next];
            *next = read.partition_point(|point| series.times_s[point.row] <= time_s);
            values.truncate(*next);
        }
    }

    /// Returns the earliest time that has not been read, s.
    pub fn next_time_s(&self) -> Option<f64> {
        let series = self.series.borrow();
        let curves = series.curves.iter().zip(&self.next);
        let rows = curves.filter_map(|(curve, &next)| Some(curve.points.get(next)?.row));
        rows.min().map(|row| series.times_s[row])
    }

    /// Reads `simulation` at every measured time from now until just before its next step.
    pub fn read_to_next_step(&mut self, simulation: &Simulation) -> Result<(), NotFinite> {
        let end_s = simulation.next_time_s();
        while let Some(time_s) = self.next_time_s().filter(|time_s| *time_s < end_s) {
            if time_s <= simulation.now().time_s() {
                self.read(simulation, time_s);
                continue;
            }
            let mut between = simulation.clone();
            between.step_to_time(time_s)?;
            self.read(&between, time_s);
        }
        Ok(())
    }

    /// Reads the measured quantities from `simulation`, which is at `time_s`.
    fn read(&mut self, simulation: &Simulation, time_s: f64) {
        let series = self.series.borrow();
        let curves = series.curves.iter().zip(&mut self.next);
        for ((curve, next), values) in curves.zip(&mut self.values) {
            while curve
                .points
                .get(*next)
                .is_some_and(|point| series.times_s[point.row] == time_s)
            {
                values.push(curve.quantity.value_at(simulation.now()));
                *next += 1;
            }
        }
    }

    /// Returns the values read so far. The values of a curve belong to its first points.
    pub fn values(&self) -> &[Vec<f64>] {
        &self.values
    }
}

/// Returns the values of the run of `scenario` at the times of `series`: for each curve, a value for every point, in
/// the point's unit. `None` if `go_on` returned false on the way.
pub fn at_times(
    series: &TimeSeries,
    scenario: &Arc<Scenario>,
    go_on: &dyn Fn() -> bool,
) -> Result<Option<Vec<Vec<f64>>>, NotFinite> {
    let mut reader = RunReader::new(series);
    let mut simulation = Simulation::new(Arc::clone(scenario));
    let jumps = needs_no_steps(series, scenario);
    while let Some(time_s) = reader.next_time_s() {
        if jumps {
            // A long integration is split into parts, so that it can be canceled.
            let stride_s = DATA_BLOCK_STEPS as f64 * scenario.motion.time_step_s;
            let next_s = time_s.min(simulation.now().time_s() + stride_s);
            simulation.step_to_time(next_s)?;
            if next_s == time_s {
                reader.read(&simulation, time_s);
            }
        } else {
            reader.read_to_next_step(&simulation)?;
            simulation.step()?;
        }
        if (jumps || simulation.step_number().is_multiple_of(DATA_BLOCK_STEPS)) && !go_on() {
            return Ok(None);
        }
    }
    Ok(Some(reader.values))
}

/// Returns true if the run of `scenario` reaches the last time of `series` in ten million steps, or parts of an
/// integration.
pub fn is_within_reach(series: &TimeSeries, scenario: &Scenario) -> bool {
    const MOST_RUN_STEPS: f64 = 1e7;
    let last_s = series.times_s.last().copied().unwrap_or(0.0);
    let steps = last_s / scenario.motion.time_step_s;
    let parts = if needs_no_steps(series, scenario) {
        steps / DATA_BLOCK_STEPS as f64
    } else {
        steps
    };
    parts <= MOST_RUN_STEPS
}

/// Returns true if the motion at a time does not depend on the steps before it.
fn needs_no_steps(series: &TimeSeries, scenario: &Scenario) -> bool {
    let is_exact = scenario.motion.scheme.order.is_none();
    // Full turns are counted step by step.
    let counts_turns = series
        .curves
        .iter()
        .any(|curve| curve.quantity.is_direction);
    is_exact
        && !counts_turns
        && scenario.edits.is_empty()
        && !scenario
            .pushes
            .iter()
            .any(|push| matches!(push.window, Window::Steps { .. }))
}
