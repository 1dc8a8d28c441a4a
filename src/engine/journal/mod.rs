//! The user's acts on the runs of a session. Everything else, including any earlier state and any export, is computed
//! from it.
//!
//! A [`Journal`] is one list of [acts](Act) with a cursor. An act begins a run, or changes the present run at a step,
//! with effect from the next step on. Undo moves the cursor back, and redo moves it forward. A new act drops the acts
//! after the cursor. An act at an earlier step disables the acts at later steps. They stay in the list, and take effect
//! again once that act is undone.
//!
//! - `run_file`: computes the run file of the present run from the acts in force.
//! - [`parameters`]: lists and changes the values of a scenario. [`next_push`]: the push that the user prepares.
//! - [`expression`]: parses and evaluates conditions over a run's numbers.
//! - [`restart`]: makes the scenario that starts from a state of a run, and the one that follows an advice.
//! - [`changed`]: describes how a scenario differs from its file.

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
/// Maximum number of points and parts in the bodies of all earlier runs, to limit memory.
const MOST_HISTORY_POINTS: usize = 200_000;
/// Maximum number of characters of a value in a message.
const LONGEST_VALUE: usize = 30;

/// The acts of a session, in the order in which the user did them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Journal {
    /// Number of acts at the end of the list that are undone.
    undone: usize,
    /// The run before all acts.
    first: RunRecord,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    entries: Vec<Arc<JournalEntry>>,
}

/// An act, and the step of its run at which the user did it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct JournalEntry {
    pub step: u64,
    /// True if the entry is an edit from the opened file.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    is_from_file: bool,
    /// True if undo reverts it together with the entry before it.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    is_joined: bool,
    /// The act. It must be the last field, because TOML writes it as a table: for each value after a table, the
    /// serializer of `toml` moves all the text that follows.
    pub act: Act,
}

/// An act of the user.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Act {
    /// Sets keys of `motion` or `push`, with effect from the next step on.
    Edit(Table),
    Push(PushFile),
    /// Sets keys that do not affect any number of the run: title, number of steps, `[view]`.
    Metadata(Table),
    /// Leaves the present run and begins this one.
    Begin(RunRecord),
}

/// A run: its beginning, and its state when the user left it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RunRecord {
    /// Name under which the user opened the scenario: a preset or a file.
    pub name: String,
    /// Step at which the user left it.
    pub left_at: u64,
    /// Time at which the run ends, s. An edit of the time step changes the number of steps, not this time.
    pub end_s: f64,
    /// The push that the user had prepared when leaving the run.
    pub next_push: Option<NextPush>,
    /// The opened file without its edits, which are separate entries.
    base: Arc<ScenarioFile>,
}

impl Act {
    /// Returns the acts that set the keys of `table`: an edit, metadata, or both. The keys must not be ones that begin
    /// a new run.
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
    /// Returns true if the entry takes effect after `step`. Metadata edits never do.
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

/// Returns the run of `scenario`, opened as `name`, and the edits of its file as entries. `is_joined` joins them to the
/// run's beginning.
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

/// List and cursor.
impl Journal {
    /// Creates a journal with a single run: `scenario`, opened as `name`.
    pub fn new(name: &str, scenario: &Scenario) -> Self {
        let (first, entries) = opened(name, scenario, false);
        Self {
            undone: 0,
            first,
            entries,
        }
    }

    /// Returns the number of entries before the cursor. Undo decreases it.
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

    /// Records the step at which the user leaves the present run, and the push that is prepared. Call it before any
    /// method that may leave the run.
    pub fn set_left_at(&mut self, step: u64, next_push: &NextPush) {
        let run = self.present_mut();
        run.left_at = step;
        run.next_push = Some(next_push.clone());
    }

    /// Sets the time at which the present run ends, s.
    pub fn set_end(&mut self, end_s: f64) {
        self.present_mut().end_s = end_s;
    }

    /// Drops the undone acts, which can then no longer be redone.
    fn drop_undone(&mut self) {
        self.entries.truncate(self.done());
        self.undone = 0;
    }

    /// Leaves the present run, and begins the run of `scenario`, opened as `name`.
    pub fn begin(&mut self, name: &str, scenario: &Scenario) {
        self.begin_run(name, scenario, false);
    }

    /// Leaves the present run, and begins it again as `scenario`, opened under the same name. One undo returns to the
    /// present run, including any edits that the new run takes from it.
    pub fn begin_again(&mut self, scenario: &Scenario) {
        let (name, end_s) = (self.present().name.clone(), self.present().end_s);
        let is_as_long = self.steps() == scenario.steps.try_into().ok();
        self.begin_run(&name, scenario, true);
        if is_as_long {
            self.set_end(end_s); // an edit of the time step that is kept does not move the end
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

    /// Drops the oldest runs beyond [`MOST_RUNS`] and [`MOST_HISTORY_POINTS`]. The newest earlier run always stays.
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

    /// Performs `acts` at `step` of the present run as one act, and returns the run's new scenario. With `coalesces`,
    /// they are another nudge of the same value, and one undo reverts them together with the previous act.
    ///
    /// # Errors
    /// Returns an error if an act is invalid. Nothing has changed then.
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

    /// Begins a new run, opened under the same name, and performs `acts` at its step 0.
    ///
    /// The new run has the settings that the present run had when it was left, and the values of `set`; see
    /// [`begun_with`](Self::begun_with). With `coalesces`, this is another nudge of the value that began the present
    /// run, and the new run replaces it. One undo then returns to the run before both.
    ///
    /// # Errors
    /// Returns an error if a value or an act is invalid. Nothing has changed then.
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

    /// Begins a new run, opened under the same name: the present run from its start, with the values of `set`
    /// throughout.
    ///
    /// See [`rerun_with`](restart::rerun_with). With `coalesces`, this is another nudge of the value that began the
    /// present run, and the new run replaces it.
    ///
    /// # Errors
    /// Returns an error if a value is invalid. Nothing has changed then.
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

    /// Drops the present run and the act that began it, unless it is the first.
    fn forget_present_run(&mut self) {
        if let Some(beginning) = self.begun().checked_sub(1) {
            self.entries.truncate(beginning);
            self.undone = 0;
        }
    }

    /// Undoes the last act with those joined to it, and returns them. Returns an empty slice if there is nothing to
    /// undo.
    pub fn undo(&mut self) -> &[Arc<JournalEntry>] {
        let done = &self.entries[..self.done()];
        let last = done.iter().rposition(|entry| !entry.is_joined);
        self.move_cursor(last.unwrap_or(0))
    }

    /// Redoes the act that was undone last, with those joined to it, and returns them. Returns an empty slice if there
    /// is nothing to redo.
    pub fn redo(&mut self) -> &[Arc<JournalEntry>] {
        let second = self.done() + 1;
        let mut after = self.entries.iter().skip(second);
        let next = after.position(|entry| !entry.is_joined);
        self.move_cursor(next.map_or(self.entries.len(), |next| second + next))
    }

    /// Moves the cursor after the first `done` entries, and returns the entries that it has passed.
    fn move_cursor(&mut self, done: usize) -> &[Arc<JournalEntry>] {
        let passed = done.min(self.done())..done.max(self.done());
        let steps = self.steps();
        self.undone = self.entries.len() - done;
        let is_same_run = self.entries[passed.clone()]
            .iter()
            .all(|entry| entry.run().is_none());
        // Edits of the time step after the number of steps was set have not moved the end. So the end is computed from
        // the scenario in which that number was set.
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
