//! What a run says of the quantities of a series, at the times at which they were measured.
//!
//! Between two steps the scheme itself takes one shorter step: nothing is interpolated, and the value is as good as those
//! of the steps. Where nothing but the time places the rows of a run, as under `exact`, it goes from one measured time to
//! the next, and the time step does not count. Neither does the length of the run: the motion goes on after its last step.

use super::TimeSeries;
use crate::run::{NotFinite, Simulation};
use crate::scenario::{Scenario, Window};
use std::borrow::Borrow;
use std::sync::Arc;

/// Steps that are taken without asking whether to go on.
const DATA_BLOCK_STEPS: u64 = 4096;

/// Reads a run at the times of a series, which it borrows or shares, while the run is stepped.
#[derive(Clone, Debug)]
pub struct RunReader<S> {
    series: S,
    /// The index of the next point to be read of each curve.
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

    /// Forgets what it has read later than `time_s`: the run has been changed from there on.
    pub fn forget_after(&mut self, time_s: f64) {
        let series = self.series.borrow();
        let curves = series.curves.iter().zip(&mut self.next);
        for ((curve, next), values) in curves.zip(&mut self.values) {
            let read = &curve.points[..*next];
            *next = read.partition_point(|point| series.times_s[point.row] <= time_s);
            values.truncate(*next);
        }
    }

    /// The earliest time that has not been read, s.
    pub fn next_time_s(&self) -> Option<f64> {
        let series = self.series.borrow();
        let curves = series.curves.iter().zip(&self.next);
        let rows = curves.filter_map(|(curve, &next)| Some(curve.points.get(next)?.row));
        rows.min().map(|row| series.times_s[row])
    }

    /// Reads `simulation` at every measured time from now up to, and without, its next step.
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

    /// Reads the measured quantities off `simulation`, which is at `time_s`.
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

    /// The values read so far: of each curve those of its first points.
    pub fn values(&self) -> &[Vec<f64>] {
        &self.values
    }
}

/// What the run of `scenario` says at the times of `series`: of each curve a value for every point, in the point's unit.
/// `None` where `go_on` said no on the way.
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
            // An integration that takes long is done in parts, so that it can be ended.
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

/// Whether the run of `scenario` comes to the last time of `series` in ten million steps, or parts of an integration.
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

/// Whether the motion at a time does not depend on the steps that lead there.
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
