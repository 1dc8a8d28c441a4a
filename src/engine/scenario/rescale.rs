//! Changes the time step of a scenario file. Step counts become seconds.

use super::file::{PushFile, ScenarioFile};
use super::problem::Problem;
use super::{Edit, Scenario};
use crate::text::number::decimal;

/// Returns `file` with the time step `time_step_s` (s). Its duration and the times of its pushes stay the same.
pub fn at_time_step(file: &ScenarioFile, time_step_s: f64) -> Result<ScenarioFile, Problem> {
    let written_for_s = file.motion.time_step_s;
    if !file.edit.is_empty() {
        let rule =
            "has edits at steps, which another time step would move: change the steps by hand";
        return Err(Problem::at("edit", rule));
    }
    let duration_s = file.motion.steps as f64 * written_for_s;
    if time_step_s > duration_s * (1.0 + 1e-9) {
        let value = toml::Value::Float(time_step_s);
        let length = decimal(duration_s);
        let rule = format!("must not be longer than the whole run, {length} s");
        return Err(Problem::with_value("motion.time_step_s", &value, rule));
    }
    let mut other = file.clone();
    let steps = (duration_s / time_step_s).round();
    if steps > MOST_RUN_STEPS_BY_TIME {
        let rule = format!("would be {steps:e}: too many");
        return Err(Problem::at("motion.steps", rule));
    }
    other.motion.steps = (steps as u64).max(1);
    other.motion.time_step_s = time_step_s;
    for (index, push) in other.push.iter_mut().enumerate() {
        hold_seconds(push, written_for_s)
            .map_err(|rule| Problem::at(format!("push.{index}"), rule))?;
    }
    Ok(other)
}

/// Returns true if seconds can replace every number of steps in `file`.
pub fn can_be_rescaled(file: &ScenarioFile) -> bool {
    file.edit.is_empty() && !file.push.iter().any(|push| push.accumulates == Some(true))
}

/// Returns true if a push of `scenario` accumulates per step. At another time step, its force would be different.
pub fn accumulates(scenario: &Scenario) -> bool {
    let edited = scenario.edits.iter().flat_map(Edit::pushes_set);
    let mut pushes = scenario.pushes.iter().chain(edited);
    pushes.any(|push| push.accumulates)
}

/// Maximum number of steps in a run whose length is given in seconds. Whole numbers are exact up to here.
pub const MOST_RUN_STEPS_BY_TIME: f64 = 9e15;

fn hold_seconds(push: &mut PushFile, written_for_s: f64) -> Result<(), &'static str> {
    let Some(count) = push.steps else {
        return Ok(());
    };
    if push.accumulates == Some(true) {
        return Err("accumulates per step, so another time step would change its force");
    }
    let first = push.first_step.unwrap_or(1);
    push.from_s = Some((first - 1) as f64 * written_for_s);
    push.for_s = Some(count as f64 * written_for_s);
    (push.first_step, push.steps) = (None, None);
    Ok(())
}
