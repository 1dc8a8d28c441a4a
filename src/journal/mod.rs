//! What a user does to a run: its journal, from which everything else, any earlier state and any export, is computed again.
//!
//! A [`Journal`] is a scenario and the acts of the user, each at a step. An act has its effect from the next step on. When
//! the user goes back and acts at an earlier step, the entries at later steps are dropped. Undo takes the last entry back;
//! redo does it again. The journal lists all acts in the order in which the user did them. Which entries are in force is
//! computed from their steps: an entry that a newer one dropped stays in the list, and is in force again once the newer
//! one is undone.
//!
//! - `entry` is one act; `run_file` decides which entries are in force and makes the run file of them; [`history`] keeps
//!   the journals of all runs of a session and undoes and redoes across them.
//! - [`parameters`] lists and changes the values of a scenario, [`next_push`] those of the push that the user prepares.
//! - [`expression`] reads and evaluates conditions over a run's numbers.
//! - [`mended`] makes the run that follows an advice; [`restart`] makes a scenario that starts where a run stands;
//!   [`changed`] says how a scenario differs from its file.

pub mod changed;
mod entry;
pub mod expression;
pub mod history;
pub mod mended;
pub mod next_push;
pub mod parameters;
pub mod restart;
mod run_file;

pub use crate::scenario::dotted::number_of_push;
pub use entry::{Act, Entry};

use crate::scenario::file::{EditFile, PushFile, ScenarioFile};
use crate::scenario::{Document, Problems, Scenario, float, rescale};
use run_file::describe;
use serde::{Deserialize, Serialize};
use std::sync::Arc;
use toml::{Table, Value};

const ORIGIN: &str = "the run";

/// A scenario and what the user did to it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Journal {
    base: Arc<ScenarioFile>,
    /// All acts in the order in which the user did them, including those that newer ones have dropped.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    log: Vec<Arc<Entry>>,
    /// Undone entries, the one undone last at the end: redo takes it first.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    undone: Vec<Arc<Entry>>,
}

impl Journal {
    /// The journal of a run file: the file without its edits is the base, and each edit is an entry.
    pub fn of(mut file: ScenarioFile) -> Self {
        let entry = |edit: EditFile| {
            Arc::new(Entry {
                step: edit.step,
                act: Act::Edit(edit.set),
                from_file: true,
                is_chained: false,
            })
        };
        let edits = std::mem::take(&mut file.edit).into_iter();
        Self {
            log: edits.map(entry).collect(),
            base: Arc::new(file),
            undone: Vec::new(),
        }
    }

    pub fn base(&self) -> &ScenarioFile {
        &self.base
    }

    pub fn file(&self) -> ScenarioFile {
        self.file_with(&self.in_force())
    }

    /// The checked scenario of the run file.
    ///
    /// # Errors
    /// What is wrong with the run file. A journal that was changed by [`act`](Self::act) alone has no errors.
    pub fn scenario(&self) -> Result<Arc<Scenario>, Problems> {
        checked(&self.file())
    }

    /// The scenario as it was when its number of steps was set last: by the opened file, or by a later `motion.steps`.
    pub fn when_steps_were_set(&self) -> Result<Arc<Scenario>, Problems> {
        let sets_steps = |entry: &Entry| match &entry.act {
            Act::Describe(set) => set.contains_key("motion.steps"),
            Act::Edit(_) | Act::Push(_) => entry.from_file,
        };
        let entries = self.in_force();
        let last = entries.iter().rposition(|entry| sets_steps(entry));
        checked(&self.file_with(&entries[..last.map_or(0, |last| last + 1)]))
    }

    /// The run up to `step`: it has that many steps (at least one), and no later entry.
    pub fn scenario_until(&self, step: u64) -> Result<Arc<Scenario>, Problems> {
        let mut file = self.file_with(&self.in_force_by(step));
        file.motion.steps = step.max(1);
        checked(&file)
    }

    pub fn acts(&self) -> usize {
        self.log.len()
    }

    /// Whether the last act was a push at `step`.
    pub fn ends_with_push_at(&self, step: u64) -> bool {
        let last = self.log.last();
        last.is_some_and(|entry| entry.step == step && matches!(entry.act, Act::Push(_)))
    }

    /// How many entries in force stand at steps later than `step`.
    pub fn later_than(&self, step: u64) -> usize {
        self.in_force().len() - self.count_by(step)
    }

    /// Does `act` at `step` and returns the run's new scenario. With `is_again` it is one more nudge of the value that the
    /// last entry set: undo takes all nudges of this chain back at once.
    pub fn act(&mut self, step: u64, act: Act, is_again: bool) -> Result<Arc<Scenario>, Problems> {
        let file = self.file();
        let act = match act {
            Act::Push(push) => push_with_new_number(&file, push),
            act => act,
        };
        if let Act::Describe(set) = &act {
            describe(&mut { file }, set)?;
        }
        self.log.push(Arc::new(Entry {
            step,
            act,
            from_file: false,
            is_chained: is_again && !self.log.is_empty(),
        }));
        let scenario = self.scenario();
        match &scenario {
            Ok(_) => self.undone.clear(),
            Err(_) => drop(self.log.pop()),
        }
        scenario
    }

    /// Takes the last entry back, or all nudges of its chain. Entries that they had dropped are in force again. Returns the
    /// step of the first entry taken back and the act of the last one; `None` where there is no entry.
    pub fn undo(&mut self) -> Option<(u64, Act)> {
        let last = self.log.last()?.act.clone();
        loop {
            let entry = self.log.pop()?;
            let (step, is_chained) = (entry.step, entry.is_chained);
            self.undone.push(entry);
            if !is_chained {
                return Some((step, last));
            }
        }
    }

    /// Does again what was undone last: an entry, or all nudges of a chain. Returns the step of the first of them and the
    /// act of the last one; `None` where nothing is undone.
    pub fn redo(&mut self) -> Option<(u64, Act)> {
        let first = self.undone.last()?.step;
        loop {
            let entry = self.undone.pop()?;
            let act = entry.act.clone();
            self.log.push(entry);
            if !self.undone.last().is_some_and(|next| next.is_chained) {
                return Some((first, act));
            }
        }
    }

    /// Whether nothing was done to the run since its file was opened: all edits are the file's own.
    pub fn is_as_opened(&self) -> bool {
        self.log.iter().all(|entry| entry.from_file)
    }

    /// Drops what was undone: it can no longer be redone.
    pub fn forget_undone(&mut self) {
        self.undone.clear();
    }

    /// How many entries in force were done at `step` or earlier, descriptions of any step included.
    pub fn count_by(&self, step: u64) -> usize {
        self.in_force_by(step).len()
    }

    /// How many pushes the run has at `step`, past and future ones: those of the scenario, and those that the user has
    /// added at `step` or earlier.
    pub fn pushes_by(&self, step: u64) -> usize {
        let mut added = self.in_force();
        added.retain(|entry| entry.step <= step && matches!(entry.act, Act::Push(_)));
        self.base.push.len() + added.len()
    }

    /// A new run with the values of `set`. From its start on it has the gravity, scheme, time step and pushes that this run
    /// has at `step`.
    pub fn begun_with(&self, step: u64, set: &Table) -> Result<Arc<Scenario>, Problems> {
        parameters::changed(&self.settings_at(step)?, set).map(Arc::new)
    }

    /// The base with gravity, scheme, time step and its own pushes as they are at `step`, without added pushes. The base
    /// keeps its time step where its pushes cannot be rescaled to the new one.
    fn settings_at(&self, step: u64) -> Result<ScenarioFile, Problems> {
        let is_added =
            |key: &str| number_of_push(key).is_some_and(|number| number >= self.base.push.len());
        let mut document = Document::from_file(ORIGIN, &self.base)?;
        let mut time_step_s = self.base.motion.time_step_s;
        for entry in self.in_force_by(step) {
            let (Act::Edit(set) | Act::Describe(set)) = &entry.act else {
                continue;
            };
            for (key, value) in set {
                if key == "motion.time_step_s" {
                    time_step_s = float(value).unwrap_or(time_step_s);
                } else if !is_added(key) {
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

fn checked(file: &ScenarioFile) -> Result<Arc<Scenario>, Problems> {
    let scenario = Document::from_file(ORIGIN, file)?.scenario()?;
    Ok(Arc::new(scenario))
}

/// The act that adds `push` to the run of `file`: a `[[push]]` table. Where edits have added pushes, one more table would
/// change their numbers, so the push is then added by one more edit.
fn push_with_new_number(file: &ScenarioFile, push: PushFile) -> Act {
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

#[cfg(test)]
mod tests;
