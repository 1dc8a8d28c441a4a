//! Computes the run file of the present run: the opened file with the acts in force.

use super::{Act, Journal, JournalEntry, number_of_push, parameters};
use crate::scenario::file::{EditFile, PushFile, ScenarioFile};
use crate::scenario::{Document, Problems, Scenario, float, rescale};
use std::sync::Arc;
use toml::{Table, Value};

const ORIGIN: &str = "the run";

impl Journal {
    /// Returns the entries of the present run in force, in the order in which they were done. A newer entry at an
    /// earlier step disables the entries at later steps. Metadata is always in force and disables nothing.
    fn in_force(&self) -> Vec<&JournalEntry> {
        let mut earliest = u64::MAX; // smallest step of the newer entries
        let of_run = self.entries[self.begun()..self.done()].iter();
        let newest_first = of_run.rev().filter(|entry| {
            let is_in_force = !entry.is_later_than(earliest);
            if !entry.act.is_metadata() {
                earliest = earliest.min(entry.step);
            }
            is_in_force
        });
        let mut entries: Vec<_> = newest_first.map(|entry| &**entry).collect();
        entries.reverse();
        entries
    }

    /// Returns the entries in force that take effect at or before `step`. Metadata always does.
    fn in_force_by(&self, step: u64) -> Vec<&JournalEntry> {
        let mut entries = self.in_force();
        entries.retain(|entry| !entry.is_later_than(step));
        entries
    }

    /// Returns the base with `entries` applied.
    fn document(&self, entries: &[&JournalEntry]) -> Result<Document, Problems> {
        let mut file = ScenarioFile::clone(&self.present().base);
        let mut metadata = Table::new();
        // Step of the last edit, if another one may extend it.
        let mut open = None;
        for entry in entries {
            match &entry.act {
                Act::Begin(_) => {}
                Act::Metadata(set) => metadata.extend(set.clone()),
                Act::Push(push) => file.push.push(push.clone()),
                Act::Edit(set) => match file.edit.last_mut() {
                    Some(last) if open == Some(entry.step) && may_extend(entry, set) => {
                        last.set.extend(set.clone());
                    }
                    _ => {
                        open = (!entry.is_from_file).then_some(entry.step);
                        file.edit.push(EditFile {
                            step: entry.step,
                            set: set.clone(),
                        });
                    }
                },
            }
        }
        let mut document = Document::from_file(ORIGIN, &file)?;
        for (key, value) in metadata {
            document.write(&key, value)?;
        }
        Ok(document)
    }

    pub fn file(&self) -> ScenarioFile {
        let file = self.document(&self.in_force()).and_then(|it| it.file());
        file.unwrap_or_else(|_| (*self.present().base).clone()) // each entry was checked when it was made
    }

    /// Returns the checked scenario of the run file. It causes no errors if all acts were accepted.
    pub fn scenario(&self) -> Result<Arc<Scenario>, Problems> {
        self.document(&self.in_force())?.scenario().map(Arc::new)
    }

    /// Returns the scenario at the time when its number of steps was last set: by the opened file, or by a later
    /// `motion.steps`.
    pub(super) fn when_steps_were_set(&self) -> Result<Scenario, Problems> {
        let entries = self.in_force();
        let last = entries.iter().rposition(|entry| match &entry.act {
            Act::Metadata(set) => set.contains_key("motion.steps"),
            _ => entry.is_from_file,
        });
        self.document(&entries[..last.map_or(0, |last| last + 1)])?
            .scenario()
    }

    /// Returns the number of steps of the present run.
    pub(super) fn steps(&self) -> Option<i64> {
        let of_run = self.entries[self.begun()..self.done()].iter().rev();
        let mut set = of_run.filter_map(|entry| match &entry.act {
            Act::Metadata(set) => set.get("motion.steps")?.as_integer(),
            _ => None,
        });
        set.next()
            .or_else(|| self.present().base.motion.steps.try_into().ok())
    }

    /// Returns the run up to `step`. It has that number of steps, but at least one, and no later entry.
    pub fn scenario_until(&self, step: u64) -> Result<Arc<Scenario>, Problems> {
        let mut document = self.document(&self.in_force_by(step))?;
        let steps = i64::try_from(step.max(1)).unwrap_or(i64::MAX);
        document.write("motion.steps", steps.into())?;
        document.scenario().map(Arc::new)
    }

    /// Returns true if the last act was a push at `step`.
    pub fn ends_with_push_at(&self, step: u64) -> bool {
        let last = self.entries[..self.done()].last();
        last.is_some_and(|entry| entry.step == step && matches!(entry.act, Act::Push(_)))
    }

    /// Returns the number of entries in force at steps after `step`.
    pub fn later_than(&self, step: u64) -> usize {
        self.in_force().len() - self.count_by(step)
    }

    /// Returns the number of entries in force at `step` or earlier, including all metadata.
    pub fn count_by(&self, step: u64) -> usize {
        self.in_force_by(step).len()
    }

    /// Returns the number of pushes that the run has at `step`, past and future. They are those of the scenario, and
    /// those that the user added at `step` or earlier.
    pub fn pushes_by(&self, step: u64) -> usize {
        let by_step = self.in_force_by(step).into_iter();
        let added = by_step.filter(|entry| matches!(entry.act, Act::Push(_)));
        self.present().base.push.len() + added.count()
    }

    /// Returns the act that adds `push` to the run as a `[[push]]` table. If edits have added pushes, another table
    /// would change their numbers, so the act is an edit that adds the push.
    pub(super) fn added(&self, push: PushFile) -> Act {
        let file = self.file();
        let set = file.edit.iter().flat_map(|edit| edit.set.keys());
        let last = set.filter_map(|key| number_of_push(key)).max();
        match (last, Table::try_from(&push)) {
            (Some(last), Ok(table)) if last >= file.push.len() => {
                let key = format!("push.{}", last + 1);
                Act::Edit(Table::from_iter([(key, Value::Table(table))]))
            }
            _ => Act::Push(push),
        }
    }

    /// Returns a new run with the values of `set`. From the start, it has the gravity, scheme, time step and pushes
    /// that the present run has at `step`.
    pub fn begun_with(&self, step: u64, set: &Table) -> Result<Scenario, Problems> {
        parameters::changed(&self.settings_at(step)?, set)
    }

    /// Returns the base with gravity, scheme, time step and its own pushes as they are at `step`, without added pushes.
    /// If its pushes cannot be rescaled to the new time step, the base keeps its own.
    fn settings_at(&self, step: u64) -> Result<ScenarioFile, Problems> {
        let base = &self.present().base;
        let mut document = Document::from_file(ORIGIN, base)?;
        let mut time_step_s = base.motion.time_step_s;
        for entry in self.in_force_by(step) {
            let (Act::Edit(set) | Act::Metadata(set)) = &entry.act else {
                continue;
            };
            for (key, value) in set {
                let is_added = number_of_push(key).is_some_and(|number| number >= base.push.len());
                if key == "motion.time_step_s" {
                    time_step_s = float(value).unwrap_or(time_step_s);
                } else if !is_added {
                    document.write(key, value.clone())?;
                }
            }
        }
        let file = document.file()?;
        Ok(if time_step_s == file.motion.time_step_s {
            file
        } else {
            rescale::at_time_step(&file, time_step_s).unwrap_or(file)
        })
    }
}

/// Returns true if the edit `entry`, which sets `set`, may extend another edit at the same step.
///
/// An edit that adds a push may not. A TOML table sorts its keys as text, `push.10` before `push.9`, but pushes must be
/// added in the order of their numbers.
fn may_extend(entry: &JournalEntry, set: &Table) -> bool {
    !entry.is_from_file && !set.values().any(Value::is_table)
}
