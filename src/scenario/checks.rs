//! From the file's shape to a [`Scenario`] whose numbers make sense together.

use super::edits::edits;
use super::file::ScenarioFile;
use super::keys::TOP;
use super::model::{Body, Scenario};
use super::parts::{body, motion, pushes};
use super::problem::{Found, Problem, listed};
use super::rubbing::{friction, objection};
use super::start::start;
use crate::physics::{State, observables};
use std::sync::Arc;

/// Makes a scenario of `file`.
///
/// # Errors
/// Every rule that its numbers break together.
pub fn scenario(file: ScenarioFile) -> Result<Scenario, Found> {
    let body = body(&file.body)?;
    let trace = match &file.trace {
        Some(name) => body.find("trace", name)?,
        None => body.point(TOP).ok_or_else(|| no_top(&body))?,
    };
    let motion = motion(&file.motion);
    let (start, rotor) = start(&file.start, &body, &file.body.part, motion.gravity)?;
    let friction = friction(file.friction.as_ref(), &body, rotor)?;
    if let Some(problem) = objection("motion.scheme", motion.scheme, &friction) {
        return Err(vec![problem].into());
    }
    let pushes = pushes(&file.push, &body)?;
    let edits = edits(&file, &body, &pushes, &friction)?;
    if !is_readable(&body, trace, &start, motion.gravity) {
        let rule = "energy or traced point leave the range of floating-point numbers: use momentum, gravity and distances nearer to 1";
        return Err(vec![Problem::at("start", rule)].into());
    }
    Ok(Scenario {
        body: Arc::new(body),
        trace,
        start,
        rotor,
        friction,
        motion,
        steps: file.motion.steps,
        written_for_s: motion.time_step_s,
        pushes,
        edits,
        file,
    })
}

/// Whether the first row of the run's CSV is made of finite numbers.
fn is_readable(body: &Body, trace: usize, start: &State, gravity: f64) -> bool {
    let body = &body.mechanics;
    let energy = observables::kinetic_energy(body, start)
        + gravity * observables::weight_height(body, start);
    let traced = observables::position(body, start, trace);
    energy.is_finite() && traced.iter().all(|c| c.is_finite())
}

fn no_top(body: &Body) -> Vec<Problem> {
    let names = body.names();
    let known = match names.len() {
        0 => "it has no named point: add a [[body.point]]".to_owned(),
        _ => format!(
            "name one of its points with trace = \"...\": {}",
            listed(names.into_iter())
        ),
    };
    vec![Problem::at(
        "trace",
        format!("the body has no point \"{TOP}\" whose path could be shown; {known}"),
    )]
}
