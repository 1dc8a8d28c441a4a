//! From the file's shape to a [`Scenario`] whose numbers make sense together.

use super::dotted::is_in;
use super::edits::edits;
use super::file::{BodyFile, ScenarioFile};
use super::keys::TOP;
use super::model::{Body, Motion, Scenario};
use super::parts::{body, motion, pushes};
use super::problem::{Problem, Problems, listed};
use super::rotor;
use super::rubbing::{friction, objects};
use super::start::start;
use crate::physics::{self, Friction, State, observables};
use std::sync::Arc;
use toml::Value;

pub fn scenario(file: ScenarioFile) -> Result<Scenario, Problems> {
    // Without a body nothing can be said of the rest; of that, each part is looked at by itself.
    let mut body = body(&file.body)?;
    let motion = motion(&file.motion);
    let mut problems = Problems::default();
    let trace = problems.kept(match &file.trace {
        Some(name) => body.find("trace", name),
        None => body.point(TOP).ok_or_else(|| no_top(&body)),
    });
    let started = problems.kept(started(&file, &body, &motion));
    let pushed = problems.kept(pushes(&file.push, &body));
    let (Some(trace), Some((spinning, start, friction)), Some(pushes)) = (trace, started, pushed)
    else {
        return Err(problems);
    };
    body.mechanics = spinning;
    let edits = edits(&file, &body, &pushes, &friction)?;
    if !is_readable(&body, trace, &start, motion.gravity) {
        let rule = "energy or traced point leave the range of floating-point numbers: use momentum, gravity and distances nearer to 1";
        return Err(vec![Problem::at("start", rule)].into());
    }
    Ok(Scenario {
        body: Arc::new(body),
        trace,
        start,
        friction,
        motion,
        steps: file.motion.steps,
        written_for_s: motion.time_step_s,
        pushes,
        edits,
        file,
    })
}

/// What spins, its state at the start, and the friction on it.
fn started(
    file: &ScenarioFile,
    body: &Body,
    motion: &Motion,
) -> Result<(physics::Body, State, Friction), Vec<Problem>> {
    let spinning = rotor::spinning(&file.start, body, &file.body.part)?;
    let start = start(&file.start, &spinning, motion.gravity)?;
    let friction = friction(file.friction.as_ref(), &spinning)?;
    objects(motion.scheme, &friction)?;
    Ok((spinning, start, friction))
}

/// Adds the unknown names of points in `table` to the problems `found` with its keys, so that both are printed together.
/// Where the body itself is wrong, its points are unknown and nothing is added.
pub fn names(table: &toml::Table, found: &mut Problems) {
    let file = table.get("body").filter(|_| {
        let wrong = found.list.iter();
        found.more == 0
            && wrong
                .into_iter()
                .all(|problem| !is_in(&problem.key, "body"))
    });
    let file = file.and_then(|body| body.clone().try_into::<BodyFile>().ok());
    let Some(Ok(body)) = file.map(|file| body(&file)) else {
        return;
    };
    let pushes = table.get("push").and_then(Value::as_array);
    let pushes = pushes.into_iter().flatten().enumerate();
    let pushed = pushes.map(|(index, push)| (format!("push.{index}.point"), push.get("point")));
    let traced = std::iter::once(("trace".to_owned(), table.get("trace")));
    for (key, name) in traced.chain(pushed) {
        let name = name.and_then(Value::as_str);
        if let Some(name) = name.filter(|name| body.point(name).is_none()) {
            found.add(|| body.no_point(&key, name));
        }
    }
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
    let known = if names.is_empty() {
        "it has no named point: add a [[body.point]]".to_owned()
    } else {
        let names = listed(names.into_iter());
        format!("name one of its points with trace = \"...\": {names}")
    };
    let rule = format!("the body has no point \"{TOP}\" whose path could be shown; {known}");
    vec![Problem::at("trace", rule)]
}
