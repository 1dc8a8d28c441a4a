//! The journal of a run file: each `[[edit]]` held against the same rules as the scenario it changes.

use super::dotted::{names, number_of_push, past_the_end, set_key};
use super::file::{EditFile, MotionFile, PushFile, ScenarioFile};
use super::keys::{self, EDITABLE_MOTION, Effect, KEYS};
use super::model::{Body, Edit, Motion, Scenario, Touches};
use super::parts::{motion, push};
use super::problem::{Problem, nearest};
use super::pushes::{Push, PushFiles, Pushes};
use super::rubbing::objection;
use crate::physics::Friction;
use std::collections::BTreeMap;
use toml::{Table, Value};

/// Motion and pushes as the edits so far have made them. One more edit costs what it changes, however many there are.
pub(super) struct Progress<'a> {
    body: &'a Body,
    friction: Friction,
    motion: Motion,
    /// Length of the run in steps; no edit changes it.
    steps: u64,
    pushes: Pushes,
    /// The pushes as a file would give them.
    written: PushFiles,
    /// The step of the edit before.
    last: u64,
}

/// The edits of `file`, whose pushes are `pushes` and whose friction is `friction`.
pub(super) fn edits(
    file: &ScenarioFile,
    body: &Body,
    pushes: &Pushes,
    friction: &Friction,
) -> Result<Vec<Edit>, Vec<Problem>> {
    let mut progress = Progress::at_start(file, body, pushes, friction);
    let entries = file.edit.iter().enumerate();
    entries
        .map(|(index, entry)| progress.edit(entry, &format!("edit.{index}")))
        .collect()
}

impl<'a> Progress<'a> {
    /// Before the first edit of `file`, whose pushes are `pushes` and whose friction is `friction`.
    pub(super) fn at_start(
        file: &ScenarioFile,
        body: &'a Body,
        pushes: &Pushes,
        friction: &Friction,
    ) -> Self {
        Self {
            body,
            friction: *friction,
            motion: motion(&file.motion),
            steps: file.motion.steps,
            pushes: pushes.clone(),
            written: if file.edit.is_empty() {
                PushFiles::default()
            } else {
                file.push.iter().cloned().collect()
            },
            last: 0,
        }
    }

    /// After the last edit of `scenario`, which has been checked.
    pub(super) fn after(scenario: &'a Scenario) -> Self {
        let start = Self {
            body: &scenario.body,
            friction: scenario.friction,
            motion: scenario.motion,
            steps: scenario.file.motion.steps,
            pushes: scenario.pushes.clone(),
            written: PushFiles::default(),
            last: 0,
        };
        match scenario.edits.last() {
            None => Self {
                written: scenario.file.push.iter().cloned().collect(),
                ..start
            },
            Some(edit) => Self {
                motion: edit.motion,
                pushes: edit.pushes.clone(),
                written: edit.written.clone(),
                last: edit.step,
                ..start
            },
        }
    }

    /// The edit `entry`, which stands at the key `here`.
    pub(super) fn edit(&mut self, entry: &EditFile, here: &str) -> Result<Edit, Vec<Problem>> {
        if entry.step < self.last {
            let rule = format!(
                "comes before the edit above it (step {}): edits stand in the order of their steps",
                self.last
            );
            let step = Value::Integer(i64::try_from(entry.step).unwrap_or(i64::MAX));
            let problem = Problem::with_value(format!("{here}.step"), &step, rule);
            return Err(vec![problem]);
        }
        let mut touches = Touches {
            time_step: false,
            segment: false,
        };
        let mut set = Set::default();
        for (key, value) in entry.set.iter() {
            let inside = |problem: Problem| vec![moved(problem, here, key)];
            may_edit(key, value).map_err(inside)?;
            match key.strip_prefix("motion.") {
                Some(name) => {
                    let written = set.motion.get_or_insert_with(|| self.motion_table());
                    written.insert(name.to_owned(), value.clone());
                }
                None => self.set_push(&mut set.pushes, key, value).map_err(inside)?,
            }
            touches.time_step |= key == "motion.time_step_s";
            touches.segment |= key.starts_with("motion.");
        }
        let inside = |problems: Vec<Problem>| -> Vec<Problem> {
            let moved = |problem: Problem| {
                let key = problem.key.clone();
                moved(problem, here, &key)
            };
            problems.into_iter().map(moved).collect()
        };
        let (motion_now, pushes_now) = set.read(self.body).map_err(inside)?;
        if let Some(motion) = &motion_now
            && let Some(problem) = objection("motion.scheme", motion.scheme, &self.friction)
        {
            return Err(inside(vec![problem]));
        }
        self.last = entry.step;
        self.motion = motion_now.unwrap_or(self.motion);
        let mut set_pushes = Vec::with_capacity(pushes_now.len());
        for (place, file, push) in pushes_now {
            self.pushes.put(place, push);
            self.written.put(place, file);
            set_pushes.push(place);
        }
        Ok(Edit {
            step: entry.step,
            motion: self.motion,
            pushes: self.pushes.clone(),
            set_pushes,
            touches,
            written: self.written.clone(),
        })
    }

    /// `[motion]` as a file would give it.
    fn motion_table(&self) -> Table {
        Table::from_iter([
            (
                "gravity_m_per_s2".to_owned(),
                Value::Float(self.motion.gravity),
            ),
            (
                "scheme".to_owned(),
                Value::String(self.motion.scheme.name.to_owned()),
            ),
            (
                "time_step_s".to_owned(),
                Value::Float(self.motion.time_step_s),
            ),
            (
                "steps".to_owned(),
                Value::Integer(i64::try_from(self.steps).unwrap_or(i64::MAX)),
            ),
        ])
    }

    /// Writes `value` at the dotted `key` into the push that it belongs to. `set` has the pushes that this edit has
    /// written before.
    fn set_push(
        &self,
        set: &mut BTreeMap<usize, Value>,
        key: &str,
        value: &Value,
    ) -> Result<(), Problem> {
        let names = names(key)?;
        let added = set.last_key_value().map_or(0, |(place, _)| place + 1);
        let length = self.written.len().max(added);
        let place = number_of_push(key);
        if let Some(place) = place.filter(|&place| place > length) {
            return Err(Problem::at(format!("push.{place}"), past_the_end(length)));
        }
        // The one push in a table of its own, where its number is 0.
        let there = place.and_then(|place| {
            let written = || Value::try_from(self.written.get(place)?).ok();
            set.remove(&place).or_else(written)
        });
        let mut alone =
            Table::from_iter([("push".to_owned(), Value::Array(there.into_iter().collect()))]);
        let first = if place.is_some() { "0" } else { names[1] };
        let key_alone = [&["push", first], &names[2..]].concat().join(".");
        set_key(&mut alone, &key_alone, value.clone())?;
        if let (Some(place), Some(Value::Array(pushes))) = (place, alone.remove("push")) {
            set.extend(pushes.into_iter().next().map(|push| (place, push)));
        }
        Ok(())
    }
}

/// The tables that one edit changes, as it leaves them.
#[derive(Default)]
struct Set {
    motion: Option<Table>,
    /// The pushes, by their places.
    pushes: BTreeMap<usize, Value>,
}

impl Set {
    /// Holds the tables against the keys and reads them.
    fn read(self, body: &Body) -> Result<Read, Vec<Problem>> {
        let table = self.motion.map(Value::Table);
        let mut problems = match &table {
            Some(table) => keys::check_part(table, "motion"),
            None => Vec::new(),
        };
        for (place, push) in &self.pushes {
            problems.extend(keys::check_part(push, &format!("push.{place}")));
        }
        if !problems.is_empty() {
            return Err(problems);
        }
        let motion_now = match table {
            Some(table) => Some(motion(&read::<MotionFile>(table, "motion")?)),
            None => None,
        };
        let mut pushes = Vec::with_capacity(self.pushes.len());
        for (place, value) in self.pushes {
            let key = format!("push.{place}");
            let file: PushFile = read(value, &key)?;
            let push = push(&file, body, &key)?;
            pushes.push((place, file, push));
        }
        Ok((motion_now, pushes))
    }
}

/// The motion, where the edit changes it, and the pushes that it sets, each with its place.
type Read = (Option<Motion>, Vec<(usize, PushFile, Push)>);

/// `table` at `key`, which has been held against the keys.
fn read<T: serde::de::DeserializeOwned>(table: Value, key: &str) -> Result<T, Vec<Problem>> {
    let read = table.try_into();
    read.map_err(|error: toml::de::Error| vec![Problem::at(key, error.message().to_owned())])
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
