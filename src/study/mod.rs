//! What many runs say, and what an exported run is worth: sweeps, fits, verification, write-ups.
//!
//! - [`fit`]: keys of a scenario so that its runs come nearest to measured data.
//! - [`sweep`]: a grid of runs, a row each.
//! - [`verify`]: a CSV, computed again and held against its rows.
//! - [`writeup`]: a run as a folder of files for a write-up.

pub mod fit;
pub mod sweep;
pub mod verify;
pub mod writeup;

use crate::scenario::{Document, Scenario, ScenarioFile};
use toml::Value;

/// `file` without its version, and without what is about the scenario as it stands alone, or about a screen.
fn alone(file: ScenarioFile) -> ScenarioFile {
    ScenarioFile {
        gyrolab: None,
        expected: Vec::new(),
        view: None,
        ..file
    }
}

fn set(document: &mut Document, key: &str, value: Value) -> Result<(), String> {
    let written = document.set_value(key, value);
    written.map_err(|problem| problem.to_string())
}

fn checked(document: &Document) -> Result<Scenario, String> {
    let scenario = document.scenario();
    scenario.map_err(|problems| problems.in_one_line())
}
