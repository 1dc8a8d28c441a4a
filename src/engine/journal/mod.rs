//! What a user does to a run: its journal, from which everything else, any earlier state and any export, is computed again.
//!
//! A [`Journal`] is a scenario and the acts of the user, each at a step. An act has its effect from the next step on. When
//! the user goes back and acts at an earlier step, the entries at later steps are dropped. Undo takes the last entry back;
//! redo does it again. The journal lists all acts in the order in which the user did them. Which entries are in force is
//! computed from their steps: an entry that a newer one dropped stays in the list, and is in force again once the newer
//! one is undone.
//!
//! - [`history`] keeps the journals of all runs of a session and undoes and redoes across them.
//! - [`parameters`] lists and changes the values of a scenario, [`next_push`] those of the push that the user prepares.
//! - [`expression`] reads and evaluates conditions over a run's numbers.
//! - [`restart`] makes the scenario that starts where a run stands, and the one that follows an advice; [`changed`] says how
//!   a scenario differs from its file.

pub mod changed;
pub mod expression;
pub mod history;
pub mod next_push;
pub mod parameters;
pub mod restart;

pub use crate::scenario::dotted::number_of_push;

use crate::scenario::file::{EditFile, PushFile, ScenarioFile};
use crate::scenario::keys::Effect;
use crate::scenario::{Document, Problems, Scenario, float, rescale};
use crate::text::printable::brief;
use serde::{Deserialize, Serialize};
use std::sync::Arc;
use toml::{Table, Value};

const ORIGIN: &str = "the run";
/// The most characters of a value that a message shows.
const LONGEST_VALUE: usize = 30;

/// A scenario and what the user did to it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Journal {
    base: Arc<ScenarioFile>,
    /// All acts in the order in which the user did them, including those that newer ones have dropped.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    log: Vec<Arc<JournalEntry>>,
    /// Undone entries, the one undone last at the end: redo takes it first.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    undone: Vec<Arc<JournalEntry>>,
}

/// One act of the user, and the step at which it was done.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct JournalEntry {
    step: u64,
    /// Whether the entry is an edit that the opened file contained.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    from_file: bool,
    /// Whether it is one more nudge of the same value: undo takes it back together with the entry before it.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    is_chained: bool,
    /// What the user did. It must stay the last field: TOML writes it as a table, and the serializer of `toml` moves the
    /// whole text that follows for each value that it meets after a table.
    act: Act,
}

/// What can be done to a run without beginning a new one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Act {
    Push(PushFile),
    /// Sets keys of `motion` or `push`, with effect from the next step on.
    Edit(Table),
    /// Sets keys on which no number of the run depends: title, number of steps, `[view]`.
    Describe(Table),
}

impl Act {
    /// Sets `key` to `value`: a [`Describe`](Self::Describe) where the key has no effect on the numbers, else an
    /// [`Edit`](Self::Edit).
    pub fn set(key: &str, value: Value) -> Self {
        let set = Table::from_iter([(key.to_owned(), value)]);
        match Effect::of_key(key) {
            Effect::None => Self::Describe(set),
            Effect::FromHere | Effect::NewRun => Self::Edit(set),
        }
    }

    pub fn in_words(&self) -> String {
        match self {
            Self::Push(push) => format!("the push on {}", push.point),
            Self::Edit(set) | Self::Describe(set) => {
                let words = set.iter().map(|(key, value)| {
                    format!("{key} = {}", brief(&value.to_string(), LONGEST_VALUE))
                });
                words.collect::<Vec<_>>().join(", ")
            }
        }
    }
}

impl JournalEntry {
    /// Whether it has its effect later than an act done at `step` would. A description belongs to no step.
    fn is_later_than(&self, step: u64) -> bool {
        self.step > step && !self.is_description()
    }

    fn is_description(&self) -> bool {
        matches!(self.act, Act::Describe(_))
    }

    /// Whether it may be joined with other edits at the same step. An edit that adds a push may not: a TOML table sorts its
    /// keys as text, `push.10` before `push.9`, and pushes must be added in the order of their numbers.
    fn may_be_joined(&self) -> bool {
        let adds = matches!(&self.act, Act::Edit(set) if set.values().any(Value::is_table));
        !self.from_file && !adds
    }
}

impl Journal {
    /// The journal of a run file: the file without its edits is the base, and each edit is an entry.
    pub fn of(mut file: ScenarioFile) -> Self {
        let entry = |edit: EditFile| {
            Arc::new(JournalEntry {
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
        let file = self.document(&self.in_force()).and_then(|it| it.file());
        file.unwrap_or_else(|_| (*self.base).clone()) // each entry was checked when it was made
    }

    /// The checked scenario of the run file. A journal that was changed by [`act`](Self::act) alone has no errors.
    pub fn scenario(&self) -> Result<Arc<Scenario>, Problems> {
        self.scenario_with(&self.in_force())
    }

    fn scenario_with(&self, entries: &[&JournalEntry]) -> Result<Arc<Scenario>, Problems> {
        self.document(entries)?.scenario().map(Arc::new)
    }

    /// The scenario as it was when its number of steps was set last: by the opened file, or by a later `motion.steps`.
    pub fn when_steps_were_set(&self) -> Result<Arc<Scenario>, Problems> {
        let sets_steps = |entry: &JournalEntry| match &entry.act {
            Act::Describe(set) => set.contains_key("motion.steps"),
            Act::Edit(_) | Act::Push(_) => entry.from_file,
        };
        let entries = self.in_force();
        let last = entries.iter().rposition(|entry| sets_steps(entry));
        self.scenario_with(&entries[..last.map_or(0, |last| last + 1)])
    }

    /// The run up to `step`: it has that many steps (at least one), and no later entry.
    pub fn scenario_until(&self, step: u64) -> Result<Arc<Scenario>, Problems> {
        let mut document = self.document(&self.in_force_by(step))?;
        let steps = i64::try_from(step.max(1)).unwrap_or(i64::MAX);
        document.write("motion.steps", steps.into())?;
        document.scenario().map(Arc::new)
    }

    /// The entries in force, in the order in which they were done: those that no newer entry has dropped. Descriptions
    /// are never dropped and drop nothing. Neither do edits of the opened file, which may have any order.
    fn in_force(&self) -> Vec<&JournalEntry> {
        let mut earliest = u64::MAX; // smallest step of the newer entries
        let is_in_force = |entry: &&Arc<JournalEntry>| {
            let is_in_force = !entry.is_later_than(earliest);
            if !entry.from_file && !entry.is_description() {
                earliest = earliest.min(entry.step);
            }
            is_in_force
        };
        let newest_first = self.log.iter().rev().filter(is_in_force);
        let mut entries: Vec<_> = newest_first.map(|entry| &**entry).collect();
        entries.reverse();
        entries
    }

    /// The entries in force that have an effect by `step`; descriptions always do.
    fn in_force_by(&self, step: u64) -> Vec<&JournalEntry> {
        let mut entries = self.in_force();
        entries.retain(|entry| !entry.is_later_than(step));
        entries
    }

    /// The base with the pushes and edits of `entries`, and what they describe.
    fn moved_by(&self, entries: &[&JournalEntry]) -> (ScenarioFile, Table) {
        let mut file = (*self.base).clone();
        let mut described = Table::new();
        // The step of the last edit, where another may be joined with it.
        let mut open = None;
        for entry in entries {
            match &entry.act {
                Act::Describe(set) => described.extend(set.clone()),
                Act::Push(push) => file.push.push(push.clone()),
                Act::Edit(set) => {
                    let (step, set) = (entry.step, set.clone());
                    match file.edit.last_mut() {
                        Some(last) if open == Some(step) && entry.may_be_joined() => {
                            last.set.extend(set);
                        }
                        _ => {
                            file.edit.push(EditFile { step, set });
                            open = (!entry.from_file).then_some(step);
                        }
                    }
                }
            }
        }
        (file, described)
    }

    fn document(&self, entries: &[&JournalEntry]) -> Result<Document, Problems> {
        let (file, described) = self.moved_by(entries);
        let mut document = Document::from_file(ORIGIN, &file)?;
        for (key, value) in described {
            document.write(&key, value)?;
        }
        Ok(document)
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
        let act = match act {
            Act::Push(push) => self.push_with_new_number(push),
            act => act,
        };
        self.log.push(Arc::new(JournalEntry {
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

    /// The act that adds `push` to the run: a `[[push]]` table. Where edits have added pushes, one more table would change
    /// their numbers, so the push is then added by one more edit.
    fn push_with_new_number(&self, push: PushFile) -> Act {
        let (file, _) = self.moved_by(&self.in_force());
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
        let mut document = Document::from_file(ORIGIN, &self.base)?;
        let mut time_step_s = self.base.motion.time_step_s;
        for entry in self.in_force_by(step) {
            let (Act::Edit(set) | Act::Describe(set)) = &entry.act else {
                continue;
            };
            for (key, value) in set {
                if key == "motion.time_step_s" {
                    time_step_s = float(value).unwrap_or(time_step_s);
                } else if number_of_push(key).is_none_or(|number| number < self.base.push.len()) {
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

#[cfg(test)]
mod tests;
