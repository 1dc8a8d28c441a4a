//! What is read off a run at its end, for whoever makes many runs and asks each for the same numbers.

use super::health::advise;
use super::readouts::{Readout, Source, Value};
use super::{Monitor, Readouts};
use crate::run::{Clock, Simulation};
use crate::scenario::{Scenario, Window};
use std::sync::Arc;

/// Steps that are taken without asking whether to go on.
const BLOCK: u64 = 4096;

/// Plays the run of `scenario` to its end and reads `wanted` off it; `None` where `go_on` said no on the way.
pub fn readouts(
    scenario: Scenario,
    wanted: &[&Readout],
    go_on: &dyn Fn() -> bool,
) -> Result<Option<Vec<Value>>, String> {
    let scenario = Arc::new(scenario);
    // Only these need every step compared with the exact motion, which may take longer than the run.
    let is_held = wanted.iter().any(|readout| readout.source == Source::Exact);
    let mut simulation = Simulation::new(Arc::clone(&scenario));
    let mut monitor = Monitor::new(simulation.now());
    let jumps = needs_no_steps(&scenario, wanted);
    if jumps {
        let end_s = Clock::end_s(&scenario);
        let ended = simulation.step_to_time(end_s);
        ended.map_err(|error| error.to_string())?;
    }
    while !jumps && simulation.step_number() < scenario.steps {
        let end = scenario.steps.min(simulation.step_number() + BLOCK);
        while simulation.step_number() < end {
            let step = simulation.step().map_err(|error| error.to_string())?;
            if is_held {
                monitor.follow(step);
            } else {
                monitor.measure(step);
            }
        }
        if !go_on() {
            return Ok(None);
        }
    }
    let health = monitor.health(simulation.now());
    // What would mend a run is part of the one sentence about it, and takes a search.
    let is_asked = wanted.iter().any(|readout| readout.name == "health");
    let is_wrong = health.is_believed() == Some(false);
    let advice = (is_asked && is_wrong).then(|| advise(&scenario));
    let read = Readouts::new(&simulation, &mut monitor, &health, advice.as_ref());
    Ok(Some(
        wanted.iter().map(|readout| readout.of(&read)).collect(),
    ))
}

/// Whether the `wanted` numbers are the same however the run gets to its end: those of theory, where nothing happens at
/// certain steps on the way, and the scheme needs none.
fn needs_no_steps(scenario: &Scenario, wanted: &[&Readout]) -> bool {
    let counts_steps = |window: Window| matches!(window, Window::Steps { .. });
    scenario.motion.scheme.order.is_none()
        && wanted
            .iter()
            .all(|readout| readout.source == Source::Theory)
        && scenario.edits.is_empty()
        && !scenario.pushes.iter().any(|push| counts_steps(push.window))
}
