//! The exact motion of a run's scenario, read off by the same instruments as the run.

use crate::engine::analysis::cost::why_exact_unavailable;
use crate::engine::analysis::{Monitor, Readouts};
use crate::engine::run::{Clock, Simulation, resampled};
use crate::engine::scenario::{Scenario, rescale};
use crate::engine::text::number::short;
use crate::physics::scheme::SCHEMES;
use crate::report::figure::of_runs::is_exact;
use std::ops::ControlFlow;
use std::sync::Arc;

#[derive(Clone, Debug)]
pub enum ExactNumbers {
    Known(Box<Readouts>),
    /// The run has no numbers to compare with, for this reason.
    Missing(String),
}

/// Samples of the exact motion in a nutation, and in a turn of a body of which theory says no nutation.
const SAMPLES_PER_NUTATION: f64 = 32.0;
const SAMPLES_PER_TURN: f64 = 8.0;
/// The most samples of the exact motion, unless the run itself has more steps.
const MOST_SAMPLES: u64 = 1_000_000;
/// Samples between two calls of the watcher.
const BLOCK_SAMPLES: u64 = 1024;

impl ExactNumbers {
    /// Plays the exact motion of `scenario`, whose run ended with the readouts `run`. It is sampled at the run's steps, so that
    /// minimum and maximum of both are of the same times. If the run's scheme cannot follow the nutation at its time step, it
    /// is sampled several times in each step. `watch` receives the samples taken and
    /// their number; if it breaks, the result is `None`.
    pub fn play(
        scenario: &Arc<Scenario>,
        run: &Readouts,
        mut watch: impl FnMut(u64, u64) -> ControlFlow<()>,
    ) -> Option<Self> {
        if let Some(reason) = why_missing(scenario, run) {
            return Some(Self::Missing(reason));
        }
        let Some(exact) = SCHEMES.iter().find(|scheme| scheme.order.is_none()) else {
            return Some(Self::Missing("there is no exact scheme".to_owned()));
        };
        let samples = samples(scenario, run);
        let time_step_s = Clock::end_s(scenario) / samples as f64;
        let mut simulation = Simulation::new(Arc::new(resampled(scenario, time_step_s, exact)));
        let mut monitor = Monitor::new(simulation.now());
        for sample in 1..=samples {
            match simulation.step() {
                Ok(step) => monitor.measure(step),
                Err(error) => return Some(Self::Missing(error.to_string())),
            }
            if sample.is_multiple_of(BLOCK_SAMPLES) && watch(sample, samples).is_break() {
                return None;
            }
        }
        let health = monitor.health(simulation.now());
        let readouts = Readouts::new(&simulation, &mut monitor, &health, None);
        Some(Self::Known(Box::new(readouts)))
    }

    pub fn readouts(&self) -> Option<&Readouts> {
        match self {
            Self::Known(readouts) => Some(readouts),
            Self::Missing(_) => None,
        }
    }

    /// Returns why there are none; empty if there are.
    pub fn reason(&self) -> &str {
        match self {
            Self::Known(_) => "",
            Self::Missing(reason) => reason,
        }
    }
}

/// Returns why a run that ended with the readouts `run` has no exact motion to compare with; `None` if it has one.
fn why_missing(scenario: &Scenario, run: &Readouts) -> Option<String> {
    let limits = run.health.limits();
    if is_exact(scenario) {
        Some("the run is the exact motion itself".to_owned())
    } else if run.sample.step < scenario.steps {
        Some("the run breaks down before its end".to_owned())
    } else if limits.unstable.is_some() {
        Some("rounding decides when the body leaves its unstable equilibrium".to_owned())
    } else if let Some(until_s) = limits.until_s {
        let until = short(until_s);
        Some(format!(
            "the motion cannot be predicted after t = {until} s"
        ))
    } else {
        why_exact_unavailable(scenario)
    }
}

/// Returns the number of samples of the exact motion of `scenario`.
fn samples(scenario: &Scenario, run: &Readouts) -> u64 {
    let steps = scenario.steps.max(1);
    let follows = run.nutation_is_resolved() != Some(false) || run.health.scheme.turns_exactly;
    // The force of a push that accumulates depends on the time step.
    if follows || rescale::accumulates(scenario) {
        return steps;
    }
    let end_s = Clock::end_s(scenario);
    let nutation_s = run.theory.and_then(|theory| theory.nutation_period_s);
    let turn_s = run.time_step_s / run.health.turns_per_step;
    let wanted = match nutation_s {
        Some(nutation_s) => SAMPLES_PER_NUTATION * end_s / nutation_s,
        None => SAMPLES_PER_TURN * end_s / turn_s,
    };
    let has_one_time_step = scenario.edits.iter().all(|edit| !edit.sets_time_step);
    let most = MOST_SAMPLES.max(steps);
    let wanted = if wanted.is_finite() {
        (wanted.ceil() as u64).min(most)
    } else {
        steps
    };
    match wanted.div_ceil(steps) {
        parts if has_one_time_step => (parts.max(1) * steps).min(most / steps * steps),
        _ => wanted.max(steps),
    }
}
