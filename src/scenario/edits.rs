//! The journal of a run file: each `[[edit]]` held against the same rules as the scenario it changes.

use super::dotted::{find, number_of_push, set_key};
use super::file::{EditFile, MotionFile, PushFile, ScenarioFile};
use super::keys::{self, EDITABLE_MOTION, Effect, KEYS};
use super::model::{Body, Edit, Motion, Touches};
use super::parts::{motion, push};
use super::problem::{Problem, nearest};
use super::pushes::Pushes;
use toml::{Table, Value};

/// The part of a file that edits may change.
#[derive(serde::Serialize)]
struct Editable<'a> {
    motion: &'a MotionFile,
    push: &'a [PushFile],
}

/// Motion and pushes as the edits so far have made them: an edit costs what it changes, however much there is.
struct Journal<'a> {
    body: &'a Body,
    /// As the file would say it.
    table: Table,
    motion: Motion,
    pushes: Pushes,
    /// The step of the edit before.
    last: u64,
}

/// The edits of `file`, whose pushes are `pushes`.
pub(super) fn edits(
    file: &ScenarioFile,
    body: &Body,
    pushes: &Pushes,
) -> Result<Vec<Edit>, Vec<Problem>> {
    if file.edit.is_empty() {
        return Ok(Vec::new());
    }
    let unwritable = |error: toml::ser::Error| vec![Problem::at("motion", error.to_string())];
    let editable = Editable {
        motion: &file.motion,
        push: &file.push,
    };
    let mut journal = Journal {
        body,
        table: Table::try_from(&editable).map_err(unwritable)?,
        motion: motion(&file.motion),
        pushes: pushes.clone(),
        last: 0,
    };
    let entries = file.edit.iter().enumerate();
    entries
        .map(|(index, entry)| journal.edit(entry, &format!("edit.{index}")))
        .collect()
}

impl Journal<'_> {
    /// The edit `entry`, which stands at the key `here`.
    fn edit(&mut self, entry: &EditFile, here: &str) -> Result<Edit, Vec<Problem>> {
        if entry.step < self.last {
            let rule = format!(
                "comes before the edit above it (step {}): edits stand in the order of their steps",
                self.last
            );
            let step = Value::Integer(i64::try_from(entry.step).unwrap_or(i64::MAX));
            let problem = Problem::with_value(format!("{here}.step"), &step, rule);
            return Err(vec![problem]);
        }
        self.last = entry.step;
        let mut touches = Touches {
            time_step: false,
            segment: false,
        };
        let mut set_pushes = Vec::new();
        for (key, value) in &entry.set {
            let inside = |problem: Problem| vec![moved(problem, here, key)];
            may_edit(key, value).map_err(inside)?;
            set_key(&mut self.table, key, value.clone()).map_err(inside)?;
            touches.time_step |= key == "motion.time_step_s";
            touches.segment |= key.starts_with("motion.");
            set_pushes.extend(number_of_push(key));
        }
        set_pushes.sort_unstable();
        set_pushes.dedup();
        let inside = |problems: Vec<Problem>| -> Vec<Problem> {
            let moved = |problem: Problem| {
                let key = problem.key.clone();
                moved(problem, here, &key)
            };
            problems.into_iter().map(moved).collect()
        };
        self.check(touches, &set_pushes).map_err(inside)?;
        if touches.segment {
            let file: MotionFile = read(&self.table, "motion").map_err(inside)?;
            self.motion = motion(&file);
        }
        for &place in &set_pushes {
            let key = format!("push.{place}");
            let file: PushFile = read(&self.table, &key).map_err(inside)?;
            let push = push(&file, self.body, &key).map_err(inside)?;
            self.pushes.put(place, push);
        }
        Ok(Edit {
            step: entry.step,
            motion: self.motion,
            pushes: self.pushes.clone(),
            set_pushes,
            touches,
        })
    }

    /// Holds against the keys what has been set: the rest has been.
    fn check(&self, touches: Touches, set_pushes: &[usize]) -> Result<(), Vec<Problem>> {
        let motion = touches.segment.then(|| "motion".to_owned());
        let pushes = set_pushes.iter().map(|place| format!("push.{place}"));
        let problems: Vec<_> = motion
            .into_iter()
            .chain(pushes)
            .filter_map(|key| Some(keys::check_part(find(&self.table, &key)?, &key)))
            .flatten()
            .collect();
        match problems.is_empty() {
            true => Ok(()),
            false => Err(problems),
        }
    }
}

/// The part of `table` at `key`, which has been held against the keys.
fn read<T: serde::de::DeserializeOwned>(table: &Table, key: &str) -> Result<T, Vec<Problem>> {
    let part = find(table, key).cloned();
    let part = part.unwrap_or_else(|| Value::Table(Table::new()));
    part.try_into()
        .map_err(|error: toml::de::Error| vec![Problem::at(key, error.message().to_owned())])
}

/// `problem` at the edit that caused it.
fn moved(problem: Problem, here: &str, key: &str) -> Problem {
    Problem {
        key: format!("{here}.set.{key}"),
        ..problem
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
