//! What a user does to the runs of a session. Everything else, any earlier state and any export, is computed from it.
//!
//! A [`Journal`] is one list of [acts](Act) with a cursor. An act begins a run, or changes the present run at a step, with
//! effect from the next step on. Undo moves the cursor back, redo moves it forward, and a new act drops the acts behind it.
//! An act at an earlier step makes the acts at later steps ineffective. They stay in the list and become effective again
//! once that act is undone.
//!
//! - `run_file` computes the run file of the present run from the acts in force.
//! - [`parameters`] lists and changes the values of a scenario, [`next_push`] those of the push that the user prepares.
//! - [`expression`] reads and evaluates conditions over a run's numbers.
//! - [`restart`] makes the scenario that starts from a state of a run, and the one that follows an advice; [`changed`] says
//!   how a scenario differs from its file.

pub mod changed;
pub mod derived;
pub mod expression;
pub mod next_push;
pub mod parameters;
pub mod restart;
mod run_file;

pub use crate::scenario::dotted::number_of_push;

use crate::run::Clock;
use crate::scenario::file::{PushFile, ScenarioFile};
use crate::scenario::keys::Effect;
use crate::scenario::{Problems, Scenario};
use crate::text::printable::brief;
use next_push::NextPush;
use serde::{Deserialize, Serialize};
use std::sync::Arc;
use toml::Table;

const MOST_RUNS: usize = 200;
/// The most points and parts that the bodies of the earlier runs have together; it limits the memory.
const MOST_HISTORY_POINTS: usize = 200_000;
/// The most characters of a value that a message shows.
const LONGEST_VALUE: usize = 30;

/// The acts of a session, in the order in which the user did them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Journal {
    /// The number of acts at the end of the list that are undone.
    undone: usize,
    /// The run before all acts.
    first: RunRecord,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    entries: Vec<Arc<JournalEntry>>,
}

/// An act, and the step of its run at which it was done.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct JournalEntry {
    pub step: u64,
    /// Whether the entry is an edit that the opened file contained.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    is_from_file: bool,
    /// Whether undo takes it back together with the entry before it.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    is_joined: bool,
    /// It must stay the last field: TOML writes it as a table, and the serializer of `toml` moves the whole text that
    /// follows for each value that it meets after a table.
    pub act: Act,
}

/// What the user did.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Act {
    /// Sets keys of `motion` or `push`, with effect from the next step on.
    Edit(Table),
    Push(PushFile),
    /// Sets keys on which no number of the run depends: title, number of steps, `[view]`.
    Metadata(Table),
    /// Leaves the present run and begins this one.
    Begin(RunRecord),
}

/// A run as it was begun, and how it was left.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RunRecord {
    /// The name under which the user opened the scenario: a preset or a file.
    pub name: String,
    /// The step at which the user left it.
    pub left_at: u64,
    /// Time at which the run ends, s. An edit of the time step changes the number of steps, not this time.
    pub end_s: f64,
    /// The push that the user had prepared when they left the run.
    pub next_push: Option<NextPush>,
    /// The opened file without its edits, each of which is an entry.
    base: Arc<ScenarioFile>,
}

impl Act {
    /// Returns the acts that set the keys of `table`, none of which begins a new run: an edit, metadata, or both.
    pub fn set(table: Table) -> Vec<Self> {
        let (metadata, edit): (Table, Table) = table
            .into_iter()
            .partition(|(key, _)| Effect::of_key(key) == Effect::None);
        let acts = [Self::Edit(edit), Self::Metadata(metadata)];
        acts.into_iter()
            .filter(|act| !matches!(act, Self::Edit(set) | Self::Metadata(set) if set.is_empty()))
            .collect()
    }

    pub fn is_metadata(&self) -> bool {
        matches!(self, Self::Metadata(_))
    }

    pub fn in_words(&self) -> String {
        match self {
            Self::Push(push) => format!("the push on {}", push.point),
            Self::Begin(run) => format!("the run of {}", run.name),
            Self::Edit(set) | Self::Metadata(set) => {
                let words = set.iter().map(|(key, value)| {
                    format!("{key} = {}", brief(&value.to_string(), LONGEST_VALUE))
                });
                words.collect::<Vec<_>>().join(", ")
            }
        }
    }
}

impl JournalEntry {
    /// Returns whether it takes effect after `step`. Metadata belongs to no step.
    fn is_later_than(&self, step: u64) -> bool {
        self.step > step && !self.act.is_metadata()
    }

    fn run(&self) -> Option<&RunRecord> {
        match &self.act {
            Act::Begin(run) => Some(run),
            _ => None,
        }
    }
}

/// Returns the run of `scenario`, opened as `name`, and the edits of its file as entries, joined to its beginning or not.
fn opened(name: &str, scenario: &Scenario, is_joined: bool) -> (RunRecord, Vec<Arc<JournalEntry>>) {
    let mut base = scenario.file.clone();
    let edits = std::mem::take(&mut base.edit).into_iter().map(|edit| {
        Arc::new(JournalEntry {
            step: edit.step,
            is_from_file: true,
            is_joined,
            act: Act::Edit(edit.set),
        })
    });
    let run = RunRecord {
        name: name.to_owned(),
        left_at: 0,
        end_s: Clock::end_s(scenario),
        next_push: None,
        base: Arc::new(base),
    };
    (run, edits.collect())
}

/// The list and its cursor.
impl Journal {
    /// Creates a journal whose only run is that of `scenario`, opened as `name`.
    pub fn new(name: &str, scenario: &Scenario) -> Self {
        let (first, entries) = opened(name, scenario, false);
        Self {
            undone: 0,
            first,
            entries,
        }
    }

    /// Returns the number of entries before the cursor. Undo lessens it.
    pub fn done(&self) -> usize {
        self.entries.len().saturating_sub(self.undone)
    }

    /// Returns the number of entries up to the beginning of the present run.
    fn begun(&self) -> usize {
        let last = self.entries[..self.done()]
            .iter()
            .rposition(|entry| entry.run().is_some());
        last.map_or(0, |last| last + 1)
    }

    pub fn present(&self) -> &RunRecord {
        let begun = self.begun().checked_sub(1);
        begun
            .and_then(|index| self.entries[index].run())
            .unwrap_or(&self.first)
    }

    fn present_mut(&mut self) -> &mut RunRecord {
        if let Some(index) = self.begun().checked_sub(1)
            && let Act::Begin(run) = &mut Arc::make_mut(&mut self.entries[index]).act
        {
            return run;
        }
        &mut self.first
    }

    /// Records the step at which the present run is left and the push that the user has prepared. Call it before any method
    /// that may leave the present run.
    pub fn set_left_at(&mut self, step: u64, next_push: &NextPush) {
        let run = self.present_mut();
        run.left_at = step;
        run.next_push = Some(next_push.clone());
    }

    /// Sets the time at which the present run ends, s.
    pub fn set_end(&mut self, end_s: f64) {
        self.present_mut().end_s = end_s;
    }

    /// Drops what was undone: it can no longer be redone.
    fn drop_undone(&mut self) {
        self.entries.truncate(self.done());
        self.undone = 0;
    }

    /// Leaves the present run and begins that of `scenario`, opened as `name`.
    pub fn begin(&mut self, name: &str, scenario: &Scenario) {
        self.begin_run(name, scenario, false);
    }

    /// Leaves the present run and begins it again, opened under the same name, as `scenario` has it. One undo returns to
    /// the present run, whatever edits the new one has from it.
    pub fn begin_again(&mut self, scenario: &Scenario) {
        let (name, end_s) = (self.present().name.clone(), self.present().end_s);
        let is_as_long = self.steps() == scenario.steps.try_into().ok();
        self.begin_run(&name, scenario, true);
        if is_as_long {
            self.set_end(end_s); // a kept edit of the time step does not move it
        }
    }

    fn begin_run(&mut self, name: &str, scenario: &Scenario, joins_edits: bool) {
        let (run, edits) = opened(name, scenario, joins_edits);
        self.drop_undone();
        self.entries.push(Arc::new(JournalEntry {
            step: 0,
            is_from_file: false,
            is_joined: false,
            act: Act::Begin(run),
        }));
        self.entries.extend(edits);
        self.drop_oldest();
    }

    /// Drops the oldest runs beyond [`MOST_RUNS`] and [`MOST_HISTORY_POINTS`]; the newest earlier run always stays.
    fn drop_oldest(&mut self) {
        let earlier = self.entries[..self.begun().saturating_sub(1)]
            .iter()
            .enumerate();
        let begun = earlier
            .rev()
            .filter_map(|(index, entry)| Some((index + 1, entry.run()?)));
        let (mut runs, mut points, mut oldest) = (0, 0, None);
        for (entries, run) in begun.chain([(0, &self.first)]) {
            points += run.base.body.point.len() + run.base.body.part.len();
            if runs > 0 && (runs >= MOST_RUNS || points > MOST_HISTORY_POINTS) {
                break;
            }
            runs += 1;
            oldest = Some((entries, run));
        }
        if let Some((entries, run)) = oldest {
            self.first = run.clone();
            self.entries.drain(..entries);
        }
    }

    /// Does `acts` at `step` of the present run as one act, and returns the run's new scenario. With `coalesces` they are
    /// one more nudge of the same value: one undo takes them back together with the act before.
    ///
    /// # Errors
    /// Why an act is refused; nothing has changed then.
    pub fn perform(
        &mut self,
        step: u64,
        acts: Vec<Act>,
        coalesces: bool,
    ) -> Result<Arc<Scenario>, Problems> {
        let mut changed = self.clone();
        changed.drop_undone();
        let is_joined = coalesces && changed.done() > changed.begun();
        for (index, act) in acts.into_iter().enumerate() {
            let act = match act {
                Act::Push(push) => changed.added(push),
                act => act,
            };
            changed.entries.push(Arc::new(JournalEntry {
                step,
                is_from_file: false,
                is_joined: is_joined || index > 0,
                act,
            }));
        }
        let scenario = changed.scenario()?;
        if changed.steps() != self.steps() {
            changed.set_end(Clock::end_s(&scenario));
        }
        *self = changed;
        Ok(scenario)
    }

    /// Begins a new run, opened under the same name, and does `acts` at its step 0. It is the present run as it moves where
    /// it was left, with the values of `set`; see [`begun_with`](Self::begun_with). With `coalesces`, one more nudge of the
    /// value that began the present run, it replaces the present run: one undo then returns to the run before both.
    ///
    /// # Errors
    /// Why a value or an act is refused; nothing has changed then.
    pub fn begin_with(
        &mut self,
        set: &Table,
        acts: Vec<Act>,
        coalesces: bool,
    ) -> Result<Arc<Scenario>, Problems> {
        let mut changed = self.clone();
        if coalesces {
            changed.forget_present_run();
        }
        let left = changed.present();
        let (name, left_at) = (left.name.clone(), left.left_at);
        let mut scenario = Arc::new(changed.begun_with(left_at, set)?);
        changed.begin(&name, &scenario);
        if !acts.is_empty() {
            scenario = changed.perform(0, acts, false)?;
        }
        *self = changed;
        Ok(scenario)
    }

    /// Begins a new run, opened under the same name: the present run from its start, with the values of `set` throughout;
    /// see [`rerun_with`](restart::rerun_with). With `coalesces`, one more nudge of the value that began the present run, it
    /// replaces the present run.
    ///
    /// # Errors
    /// Why a value is refused; nothing has changed then.
    pub fn rerun_with(&mut self, set: &Table, coalesces: bool) -> Result<Arc<Scenario>, Problems> {
        let mut changed = self.clone();
        if coalesces {
            changed.forget_present_run();
        }
        let (run, end_s) = (changed.scenario()?, changed.present().end_s);
        let scenario = Arc::new(restart::rerun_with(&run, set, end_s)?);
        changed.begin_again(&scenario);
        *self = changed;
        Ok(scenario)
    }

    /// Drops the present run and its beginning, unless it is the first.
    fn forget_present_run(&mut self) {
        if let Some(beginning) = self.begun().checked_sub(1) {
            self.entries.truncate(beginning);
            self.undone = 0;
        }
    }

    /// Undoes the last act with those joined to it. Returns them; none where nothing was done.
    pub fn undo(&mut self) -> &[Arc<JournalEntry>] {
        let done = &self.entries[..self.done()];
        let last = done.iter().rposition(|entry| !entry.is_joined);
        self.move_cursor(last.unwrap_or(0))
    }

    /// Does again what was undone last, an act with those joined to it. Returns them; none where nothing is undone.
    pub fn redo(&mut self) -> &[Arc<JournalEntry>] {
        let second = self.done() + 1;
        let mut after = self.entries.iter().skip(second);
        let next = after.position(|entry| !entry.is_joined);
        self.move_cursor(next.map_or(self.entries.len(), |next| second + next))
    }

    /// Moves the cursor behind the first `done` entries and returns those that it has passed.
    fn move_cursor(&mut self, done: usize) -> &[Arc<JournalEntry>] {
        let passed = done.min(self.done())..done.max(self.done());
        let steps = self.steps();
        self.undone = self.entries.len() - done;
        let is_same_run = self.entries[passed.clone()]
            .iter()
            .all(|entry| entry.run().is_none());
        // Edits of the time step made after the number of steps was set have not moved the end: the end follows from the
        // scenario in which that number was set.
        if is_same_run
            && self.steps() != steps
            && let Ok(scenario) = self.when_steps_were_set()
        {
            self.set_end(Clock::end_s(&scenario));
        }
        &self.entries[passed]
    }
}

#[cfg(test)]
mod tests;
