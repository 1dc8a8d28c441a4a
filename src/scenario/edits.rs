//! The journal of a run file: each `[[edit]]` held against the same rules as the scenario it changes.

use super::dotted::set_key;
use super::file::{EditFile, MotionFile, PushFile, ScenarioFile};
use super::keys::{self, EDITABLE_MOTION, Effect, KEYS};
use super::model::{Body, Edit, Touches};
use super::parts::{motion, pushes};
use super::problem::{Problem, nearest};

/// The part of a file that edits may change.
#[derive(serde::Serialize, serde::Deserialize)]
struct Editable {
    motion: MotionFile,
    #[serde(default)]
    push: Vec<PushFile>,
}

pub(super) fn edits(file: &ScenarioFile, body: &Body) -> Result<Vec<Edit>, Vec<Problem>> {
    if file.edit.is_empty() {
        return Ok(Vec::new());
    }
    let unwritable = |error: toml::ser::Error| vec![Problem::at("motion", error.to_string())];
    let editable = Editable {
        motion: file.motion.clone(),
        push: file.push.clone(),
    };
    let mut table = toml::Table::try_from(&editable).map_err(unwritable)?;
    let mut last = 0;
    file.edit
        .iter()
        .enumerate()
        .map(|(index, entry)| edit(entry, index, &mut table, &mut last, body))
        .collect()
}

/// One edit, on top of those before it in `table`; `last` is the step of the one before.
fn edit(
    entry: &EditFile,
    index: usize,
    table: &mut toml::Table,
    last: &mut u64,
    body: &Body,
) -> Result<Edit, Vec<Problem>> {
    let here = format!("edit.{index}");
    if entry.step < *last {
        let rule = format!(
            "comes before the edit above it (step {last}): edits stand in the order of their steps"
        );
        let step = toml::Value::Integer(i64::try_from(entry.step).unwrap_or(i64::MAX));
        return Err(vec![Problem::with_value(
            format!("{here}.step"),
            &step,
            rule,
        )]);
    }
    *last = entry.step;
    let mut touches = Touches {
        time_step: false,
        segment: false,
    };
    for (key, value) in &entry.set {
        let inside = |problem: Problem| vec![moved(problem, &here, key)];
        may_edit(key, value).map_err(inside)?;
        set_key(table, key, value.clone()).map_err(inside)?;
        touches.time_step |= key == "motion.time_step_s";
        touches.segment |= key.starts_with("motion.");
    }
    // The title and the start are not in this table, and cannot be edited.
    let problems: Vec<_> = keys::check(table)
        .into_iter()
        .filter(|problem| problem.key.starts_with("motion") || problem.key.starts_with("push"))
        .map(|problem| moved(problem.clone(), &here, &problem.key))
        .collect();
    if !problems.is_empty() {
        return Err(problems);
    }
    let editable: Editable = table
        .clone()
        .try_into()
        .map_err(|error: toml::de::Error| vec![Problem::at(&here, error.message().to_owned())])?;
    let pushes = pushes(&editable.push, body, "push").map_err(|list| {
        list.into_iter()
            .map(|p| moved(p.clone(), &here, &p.key))
            .collect::<Vec<_>>()
    })?;
    Ok(Edit {
        step: entry.step,
        motion: motion(&editable.motion),
        pushes,
        touches,
    })
}

/// `problem` at the edit that caused it.
fn moved(problem: Problem, here: &str, key: &str) -> Problem {
    Problem {
        key: format!("{here}.set.{key}"),
        ..problem
    }
}

fn may_edit(key: &str, value: &toml::Value) -> Result<(), Problem> {
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
