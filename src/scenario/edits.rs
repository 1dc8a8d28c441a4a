//! The journal of a run file: each `[[edit]]` in turn is written into the tables `motion` and `push`, and what it leaves
//! there is held against the same rules as in a scenario.

use super::dotted::{find, number_of_push, set_key};
use super::file::{EditFile, MotionFile, PushFile, ScenarioFile};
use super::keys::{self, EDITABLE_MOTION, Effect, KEYS};
use super::limits::too_many;
use super::model::{Body, Edit, Motion, Pushes, Touches};
use super::parts::{motion, push};
use super::problem::{Problem, Problems, nearest};
use super::rubbing::objects;
use crate::physics::Friction;
use serde::de::DeserializeOwned;
use std::collections::BTreeSet;
use std::sync::Arc;
use toml::{Table, Value};

/// The edits of `file`, whose pushes are `pushes` and whose friction is `friction`.
pub(super) fn edits(
    file: &ScenarioFile,
    body: &Body,
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
        motion: motion(&file.motion),
        pushes: Arc::clone(pushes),
    };
    let (mut edits, mut last) = (Vec::with_capacity(file.edit.len()), 0);
    for (index, entry) in file.edit.iter().enumerate() {
        if entry.step < last {
            let rule = format!(
                "comes before the edit above it (step {last}): edits stand in the order of their steps"
            );
            let step = Value::Integer(i64::try_from(entry.step).unwrap_or(i64::MAX));
            let key = format!("edit.{index}.step");
            return Err(vec![Problem::with_value(key, &step, rule)].into());
        }
        last = entry.step;
        let edit = progress.edit(entry).map_err(|mut problems| {
            for problem in &mut problems.list {
                problem.key.insert_str(0, &format!("edit.{index}.set."));
            }
            problems
        });
        edits.push(edit?);
    }
    Ok(edits)
}

/// `motion` and `push` of `file`.
fn tables(file: &ScenarioFile) -> Table {
    let empty = || Value::Array(Vec::new());
    let motion = Value::try_from(&file.motion).unwrap_or_else(|_| empty());
    let push = Value::try_from(&file.push).unwrap_or_else(|_| empty());
    Table::from_iter([("motion".to_owned(), motion), ("push".to_owned(), push)])
}

/// Motion and pushes as the edits so far have left them.
struct Progress<'a> {
    file: &'a ScenarioFile,
    body: &'a Body,
    friction: &'a Friction,
    /// `motion` and `push`, as a file would give them.
    written: Table,
    motion: Motion,
    pushes: Pushes,
}

impl Progress<'_> {
    /// Makes the edit `entry`. In a refusal the keys are those that it sets.
    fn edit(&mut self, entry: &EditFile) -> Result<Edit, Problems> {
        let mut set_pushes = BTreeSet::new();
        for (key, value) in &entry.set {
            let written =
                may_edit(key, value).and_then(|()| set_key(&mut self.written, key, value.clone()));
            let key = key.clone();
            set_pushes.extend(number_of_push(&key));
            written.map_err(|problem| Problems::from(vec![Problem { key, ..problem }]))?;
        }
        let touches = Touches {
            time_step: entry.set.contains_key("motion.time_step_s"),
            segment: EDITABLE_MOTION
                .iter()
                .any(|key| entry.set.contains_key(*key)),
        };
        let mut problems = Problems::default();
        if touches.segment {
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
            touches,
        })
    }

    fn set_motion(&mut self) -> Result<(), Problems> {
        self.motion = motion(&self.read::<MotionFile>("motion")?);
        Ok(objects(self.motion.scheme, self.friction)?)
    }

    fn set_push(&mut self, place: usize) -> Result<(), Problems> {
        let key = format!("push.{place}");
        let push = push(&self.read::<PushFile>(&key)?, self.body, &key)?;
        let pushes = Arc::make_mut(&mut self.pushes);
        match pushes.get_mut(place) {
            Some(old) => *old = push,
            None => pushes.push(push),
        }
        let (edits, body) = (self.file.edit.len(), &self.file.body);
        let bodies = body.rim_points() + body.point.len() + body.part.len();
        too_many(edits, bodies, pushes.len()).map_or(Ok(()), |problem| Err(vec![problem].into()))
    }

    /// The table at `key`, held against the keys.
    fn read<T: DeserializeOwned>(&self, key: &str) -> Result<T, Problems> {
        let table = find(&self.written, key).cloned();
        let table = table.unwrap_or(Value::Boolean(false));
        keys::check_part(&table, key).or(())?;
        let read = table.try_into();
        read.map_err(|error: toml::de::Error| {
            vec![Problem::at(key, error.message().to_owned())].into()
        })
    }
}

fn may_edit(key: &str, value: &Value) -> Result<(), Problem> {
    if Effect::of(key) == Effect::FromHere {
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
