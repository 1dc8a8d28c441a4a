//! The row of one point: its run, played to the end, and what is read off it.

use crate::analysis::health::advise;
use crate::analysis::readouts::{Readout, Source, Value};
use crate::analysis::{Monitor, Readouts};
use crate::run::Simulation;
use crate::scenario::Scenario;
use serde::Serialize;
use std::sync::Arc;

/// Steps that are taken without asking whether to go on.
const BLOCK: u64 = 4096;

/// One row of a sweep's CSV.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// The row as it stands in the file, with its line end.
    pub line: String,
    /// Why it holds no readouts.
    pub failure: Option<String>,
}

/// Plays the run of `scenario` to its end and reads `wanted` off it; `None` where `go_on` said no on the way.
///
/// # Errors
/// Why there is nothing to read: the numbers stop being finite.
pub(super) fn readouts(
    scenario: Scenario,
    wanted: &[&Readout],
    go_on: &dyn Fn() -> bool,
) -> Result<Option<Vec<Value>>, String> {
    let scenario = Arc::new(scenario);
    // Only these need every step held against the exact motion, which may take longer than the run.
    let is_held = wanted.iter().any(|readout| readout.source == Source::Exact);
    let mut simulation = Simulation::new(Arc::clone(&scenario));
    let mut monitor = Monitor::new(simulation.now());
    while simulation.step_number() < scenario.steps {
        let end = scenario.steps.min(simulation.step_number() + BLOCK);
        while simulation.step_number() < end {
            let step = simulation.step().map_err(|error| error.to_string())?;
            match is_held {
                true => monitor.follow(step),
                false => monitor.measure(step),
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

/// `cells` as one line of CSV.
pub(super) fn line(cells: &impl Serialize) -> String {
    let mut writer = csv::WriterBuilder::new()
        .has_headers(false)
        .from_writer(Vec::new());
    // Writing plain values to memory does not fail.
    let written = writer.serialize(cells).is_ok();
    let bytes = writer.into_inner().unwrap_or_default();
    debug_assert!(written);
    String::from_utf8(bytes).unwrap_or_default()
}
