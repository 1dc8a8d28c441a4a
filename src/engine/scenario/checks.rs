//! Turns the parsed file into a [`Scenario`] whose numbers are consistent. Each `[[edit]]` in turn is written into the
//! tables `motion` and `push`, and the result must satisfy the same rules as a scenario.

use super::dotted::{find, is_in, number_of_push, set_key};
use super::file::{BodyFile, EditFile, MotionFile, PushFile, ScenarioFile};
use super::keys::{self, EDITABLE_MOTION, Effect, KEYS, TOP};
use super::limits::too_many;
use super::model::{Edit, Motion, NamedBody, Pushes, Scenario};
use super::parts::{
    check_scheme, read_body, read_friction, read_motion, read_push, read_pushes, spinning_body,
};
use super::problem::{Problem, Problems, nearest};
use super::start::start_state;
use crate::physics::{self, Friction, PointMass, State, observables};
use serde::de::DeserializeOwned;
use std::collections::BTreeSet;
use std::sync::Arc;
use toml::{Table, Value};

pub fn scenario(mut file: ScenarioFile) -> Result<Scenario, Problems> {
    // Without a valid body, the rest cannot be checked. With one, each part is checked by itself.
    let mut body = read_body(&file.body)?;
    let motion = read_motion(&file.motion);
    let mut problems = Problems::default();
    let trace = problems.kept(match &file.trace {
        Some(name) => body.find("trace", name),
        None => Ok(traced(&body)),
    });
    let started = problems.kept(read_start(&file, &body, &motion));
    let pushed = problems.kept(read_pushes(&file.push, &body));
    let (Some(trace), Some((spinning, start, friction)), Some(pushes)) = (trace, started, pushed)
    else {
        return Err(problems);
    };
    body.mechanics = spinning;
    if file.trace.is_none() && body.point(TOP).is_none() {
        // Readers of the file need the name of the point.
        let mut names = body.names().into_iter();
        let name = names.find(|name| body.point(name) == Some(trace));
        file.trace = name.map(str::to_owned);
    }
    let edits = read_edits(&file, &body, &pushes, &friction)?;
    if !is_readable(&body, trace, &start, motion.gravity) {
        let rule = "energy or traced point leave the range of floating-point numbers: use momentum, gravity and distances nearer to 1";
        return Err(Problem::at("start", rule).into());
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

/// Returns the body that spins, its state at the start, and the friction on it.
fn read_start(
    file: &ScenarioFile,
    body: &NamedBody,
    motion: &Motion,
) -> Result<(physics::Body, State, Friction), Problem> {
    let spinning = spinning_body(&file.start, body, &file.body.part)?;
    let start = start_state(&file.start, &spinning, motion.gravity)?;
    let friction = read_friction(file.friction.as_ref(), &spinning)?;
    check_scheme(motion.scheme, &friction)?;
    Ok((spinning, start, friction))
}

/// Adds the unknown names of points in `table` to the problems `found` with its keys, so that both are printed
/// together. If the body itself is invalid, its points are unknown and nothing is added.
pub fn check_names(table: &Table, found: &mut Problems) {
    if found.more > 0 || found.list.iter().any(|problem| is_in(&problem.key, "body")) {
        return;
    }
    let Some(Ok(file)) = table
        .get("body")
        .map(|body| body.clone().try_into::<BodyFile>())
    else {
        return;
    };
    let Ok(body) = read_body(&file) else {
        return;
    };
    let pushes = table.get("push").and_then(Value::as_array);
    let pushed = (0..pushes.map_or(0, Vec::len)).map(|index| format!("push.{index}.point"));
    for key in std::iter::once("trace".to_owned()).chain(pushed) {
        if let Some(Value::String(name)) = find(table, &key)
            && body.point(name).is_none()
        {
            found.add(|| body.no_point(&key, name));
        }
    }
}

/// Returns true if the first row of the run's CSV consists of finite numbers.
fn is_readable(body: &NamedBody, trace: usize, start: &State, gravity: f64) -> bool {
    let mechanics = &body.mechanics;
    let energy = observables::total_energy(mechanics, start, gravity);
    let traced = observables::position(mechanics, start, trace);
    energy.is_finite() && traced.iter().all(|c| c.is_finite())
}

/// Returns the point to trace if the file names none: "top", else the named point farthest from the pivot, else the
/// farthest point of all.
fn traced(body: &NamedBody) -> usize {
    if let Some(top) = body.point(TOP) {
        return top;
    }
    let points = body.mechanics.points();
    let named = body.names().into_iter().filter_map(|name| body.point(name));
    farthest(points, named)
        .filter(|&place| points[place].at.norm() > 0.0)
        .or_else(|| farthest(points, 0..points.len()))
        .unwrap_or(0)
}

/// Returns the first of `places` whose point is farthest from the pivot.
fn farthest(points: &[PointMass], places: impl Iterator<Item = usize>) -> Option<usize> {
    places.reduce(|best, place| {
        if points[place].at.norm() > points[best].at.norm() {
            place
        } else {
            best
        }
    })
}

/// Reads the edits of `file`, which has the pushes `pushes` and the friction `friction`.
fn read_edits(
    file: &ScenarioFile,
    body: &NamedBody,
    pushes: &Pushes,
    friction: &Friction,
) -> Result<Vec<Edit>, Problems> {
    if file.edit.is_empty() {
        return Ok(Vec::new());
    }
    let mut progress = Progress {
        file,
        body,
        friction,
        written: tables(file),
        motion: read_motion(&file.motion),
        pushes: Arc::clone(pushes),
    };
    let (mut edits, mut last) = (Vec::with_capacity(file.edit.len()), 0);
    for (index, entry) in file.edit.iter().enumerate() {
        if entry.step < last {
            let rule =
                format!("comes before the edit above it (step {last}): sort the edits by step");
            let step = Value::Integer(i64::try_from(entry.step).unwrap_or(i64::MAX));
            let key = format!("edit.{index}.step");
            return Err(Problem::with_value(key, &step, rule).into());
        }
        last = entry.step;
        let edit = progress
            .edit(entry)
            .map_err(|problems| problems.inside(&format!("edit.{index}.set")));
        edits.push(edit?);
    }
    Ok(edits)
}

fn tables(file: &ScenarioFile) -> Table {
    // The tables contain nothing that TOML cannot write.
    let motion = Value::try_from(&file.motion).unwrap_or(Value::Array(Vec::new()));
    let push = Value::try_from(&file.push).unwrap_or(Value::Array(Vec::new()));
    Table::from_iter([("motion".to_owned(), motion), ("push".to_owned(), push)])
}

/// Motion and pushes after the edits so far.
struct Progress<'a> {
    file: &'a ScenarioFile,
    body: &'a NamedBody,
    friction: &'a Friction,
    /// `motion` and `push` as a file would contain them.
    written: Table,
    motion: Motion,
    pushes: Pushes,
}

impl Progress<'_> {
    /// Makes the edit `entry`. Problems name the keys that it sets.
    fn edit(&mut self, entry: &EditFile) -> Result<Edit, Problems> {
        let mut set_pushes = BTreeSet::new();
        for (key, value) in &entry.set {
            let written =
                may_edit(key, value).and_then(|()| set_key(&mut self.written, key, value.clone()));
            set_pushes.extend(number_of_push(key));
            written.map_err(|problem| Problem {
                key: key.clone(),
                ..problem
            })?;
        }
        let begins_segment = EDITABLE_MOTION
            .iter()
            .any(|key| entry.set.contains_key(*key));
        let mut problems = Problems::default();
        if begins_segment {
            problems.kept(self.set_motion());
        }
        for &place in &set_pushes {
            problems.kept(self.set_push(place));
        }
        problems.or(())?;
        Ok(Edit {
            step: entry.step,
            motion: self.motion,
            pushes: Arc::clone(&self.pushes),
            set_pushes: set_pushes.into_iter().collect(),
            sets_time_step: entry.set.contains_key("motion.time_step_s"),
            begins_segment,
        })
    }

    fn set_motion(&mut self) -> Result<(), Problems> {
        self.motion = read_motion(&self.read::<MotionFile>("motion")?);
        Ok(check_scheme(self.motion.scheme, self.friction)?)
    }

    fn set_push(&mut self, place: usize) -> Result<(), Problems> {
        let key = format!("push.{place}");
        let push = read_push(&self.read::<PushFile>(&key)?, self.body, &key)?;
        let pushes = Arc::make_mut(&mut self.pushes);
        match pushes.get_mut(place) {
            Some(old) => *old = push,
            None => pushes.push(push),
        }
        let (edits, body) = (self.file.edit.len(), &self.file.body);
        let bodies = body.rim_points() + body.point.len() + body.part.len();
        too_many(edits, bodies, pushes.len()).map_or(Ok(()), |problem| Err(problem.into()))
    }

    /// Reads the table at `key`, after checking it against the known keys.
    fn read<T: DeserializeOwned>(&self, key: &str) -> Result<T, Problems> {
        let table = find(&self.written, key).unwrap_or(&Value::Boolean(false));
        keys::check_part(table, key).or(())?;
        let read = table.clone().try_into();
        read.map_err(|error: toml::de::Error| Problem::at(key, error.message()).into())
    }
}

fn may_edit(key: &str, value: &Value) -> Result<(), Problem> {
    if Effect::of_key(key) == Effect::FromHere {
        return Ok(());
    }
    if value.is_table() {
        let rule = "must be a dotted key in quotes, such as \"motion.time_step_s\" = 0.05";
        return Err(Problem::at(key, rule));
    }
    let rule = match nearest(key, EDITABLE_MOTION.into_iter()) {
        near if near.starts_with("did") && !KEYS.iter().any(|known| known.path == key) => {
            format!("unknown key: {near}")
        }
        _ => format!(
            "cannot be edited during a run (only {} and push.N can): set it in the scenario",
            EDITABLE_MOTION.join(", ")
        ),
    };
    Err(Problem::at(key, rule))
}
