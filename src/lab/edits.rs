//! The user's edits of the run: values and pushes, undo and redo, and opening another scenario.

use super::advice::Offer;
use super::answer::{ActionResult, Done, PendingAction, Refusal};
use super::command::{Force, PushChoice};
use super::player::{Player, RunChange};
use super::runs::Runs;
use super::values::Values;
use crate::engine::journal::next_push::NextPush;
use crate::engine::journal::restart::{edited_motion, in_force};
use crate::engine::journal::{Act, Journal, JournalEntry, number_of_push};
use crate::engine::run::pushes::acts_s;
use crate::engine::scenario::Scenario;
use crate::engine::scenario::file::PushFile;
use crate::engine::scenario::keys::Effect;
use std::sync::Arc;
use std::time::Duration;
use toml::Table;

/// The texts of messages about undo and redo: nothing to do, the effect, the run that was reached, and the way back.
const UNDO: [&str; 4] = [
    "nothing to undo",
    "undone",
    "the previous run",
    "U redoes it",
];
const REDO: [&str; 4] = ["nothing to redo", "redone", "the next run", "u undoes it"];

/// The end of the message about an edit that restarted the run.
const FROM_START: &str = "rerun from the start; u returns to the previous run";

/// The runs, and the values that can be edited.
pub struct Edits {
    pub(super) runs: Runs,
    pub(super) values: Values,
}

/// The result of an edit: the run's new scenario, and how the run continues.
pub(super) struct ScenarioEdit {
    pub(super) change: RunChange,
    pub(super) scenario: Arc<Scenario>,
    said: EditMessage,
}

enum EditMessage {
    Nothing,
    Text(String),
    /// The value of this key, and when it takes effect.
    Value(String),
    /// The value of this key, with which the run was restarted.
    ValueFromStart(String),
}

pub(super) type Edited = Result<ScenarioEdit, Refusal>;

impl Edits {
    pub(super) fn new(name: &str, scenario: &Arc<Scenario>) -> Self {
        Self {
            runs: Runs::new(name, scenario),
            values: Values::new(scenario),
        }
    }

    /// Restores the journal and the next push of a session.
    pub(super) fn resume(
        &mut self,
        journal: Journal,
        file: &Arc<Scenario>,
        next_push: NextPush,
        player: &Player,
    ) {
        self.runs = Runs::resumed(journal, file);
        self.values.next_push = next_push;
        self.values.suit(player.run().scenario());
    }

    /// Records the next push, and `step` as the step at which the present run is left. Returns the journal.
    fn leave_at(&mut self, step: u64) -> &mut Journal {
        let journal = self.runs.journal_mut();
        journal.set_left_at(step, &self.values.next_push);
        journal
    }

    /// Switches to the run of `scenario`, opened as `name`.
    pub(super) fn open(
        &mut self,
        name: &str,
        scenario: Arc<Scenario>,
        player: &Player,
    ) -> ScenarioEdit {
        self.leave_at(player.step_to_keep()).begin(name, &scenario);
        self.runs.set_file(&scenario);
        self.values.next_push = NextPush::suggested_for(&scenario);
        ScenarioEdit {
            change: RunChange::Opens,
            scenario,
            said: EditMessage::Nothing,
        }
    }

    /// Sets all keys of `table` as one edit. With `coalesces`, a single undo restores it and the edit before.
    ///
    /// Keys of body and start begin a new run. The others take effect from the next step on.
    pub(super) fn set(&mut self, table: &Table, coalesces: bool, player: &Player) -> Edited {
        let keys = table.clone().into_iter();
        let (new, rest): (Table, Table) =
            keys.partition(|(key, _)| Effect::of_key(key) == Effect::NewRun);
        let acts = Act::set(rest);
        if !new.is_empty() {
            return self.begin_with(&new, acts, coalesces, player);
        }
        let said = match table.len() {
            1 => EditMessage::Value(table.keys().cloned().collect()),
            more => EditMessage::Text(format!("{more} values; u undoes them")),
        };
        self.perform(acts, coalesces, said, player)
    }

    /// Sets all keys of `table` in a new run: the present one from its start, replayed to the same time.
    ///
    /// Values that do not affect the numbers need no new run. With `coalesces` the new run replaces the present one,
    /// which began with another value of the same key.
    pub(super) fn rerun(&mut self, table: &Table, coalesces: bool, player: &Player) -> Edited {
        if table.keys().all(|key| Effect::of_key(key) == Effect::None) {
            return self.set(table, coalesces, player);
        }
        let said = match table.len() {
            1 => EditMessage::ValueFromStart(table.keys().cloned().collect()),
            more => EditMessage::Text(format!("{more} values, {FROM_START}")),
        };
        let left_at = player.step_to_leave_at();
        let scenario = self.leave_at(left_at).rerun_with(table, coalesces)?;
        self.values.suit(&scenario);
        Ok(ScenarioEdit {
            change: RunChange::BeginsAnew {
                is_act: false,
                is_again: coalesces,
            },
            scenario,
            said,
        })
    }

    pub(super) fn nudge(
        &mut self,
        key: &str,
        times: i32,
        rerun: bool,
        player: &Player,
        now: Duration,
    ) -> Edited {
        let table = self.values.nudged(key, times, player.run().scenario())?;
        let coalesces = self.values.coalesces_with_last_nudge(key, rerun, now);
        let edited = if rerun {
            self.rerun(&table, coalesces, player)?
        } else {
            self.set(&table, coalesces, player)?
        };
        self.values.note_nudge(key, rerun, now);
        Ok(edited)
    }

    /// Pushes from the next step on: with the next push, changed by the values of `choice`.
    pub(super) fn push(&mut self, choice: &PushChoice, player: &Player) -> Edited {
        let (push, given) = self.resolve_push(choice, player)?;
        let said = format!(
            "pushed: {}; u undoes it, P chooses another",
            push.in_words()
        );
        let acts = vec![Act::Push(given)];
        self.perform(acts, false, EditMessage::Text(said), player)
    }

    /// Returns the push of `choice` in two forms: as the user chooses it, and as it acts at the present step.
    fn resolve_push(
        &self,
        choice: &PushChoice,
        player: &Player,
    ) -> Result<(NextPush, PushFile), String> {
        let push = self.chosen(choice, player)?;
        let run = player.run();
        let mut given = push.given(run.scenario(), run.simulation().state())?;
        if let Some(Force::Vector(vector)) = choice.force_N {
            given.force_N = vector; // the exact numbers: norm and direction would round them
        }
        Ok((push, given))
    }

    /// Returns true if `choice` repeats a push: the last act was a push at the present step, and the run was played on
    /// since.
    pub(super) fn is_push_tried_again(&self, choice: &PushChoice, player: &Player) -> bool {
        let here = player.step_number();
        self.resolve_push(choice, player).is_ok()
            && player.run().furthest() > here
            && self.runs.journal().ends_with_push_at(here)
            && !self.runs.is_at_floor()
    }

    pub(super) fn choose_next_push(
        &mut self,
        choice: &PushChoice,
        player: &Player,
    ) -> ActionResult {
        self.values.next_push = self.chosen(choice, player)?;
        self.list_values(player);
        Ok(Done::SILENT)
    }

    fn chosen(&self, choice: &PushChoice, player: &Player) -> Result<NextPush, String> {
        let time_step_s = player.motion().time_step_s;
        let scenario = player.run().scenario();
        self.values.chosen(choice, scenario, time_step_s)
    }

    /// Begins a new run with the values of `set` in its scenario, and with `acts` at its start.
    ///
    /// With `coalesces` it replaces the present run, which began with another value of the same key.
    fn begin_with(
        &mut self,
        set: &Table,
        acts: Vec<Act>,
        coalesces: bool,
        player: &Player,
    ) -> Edited {
        let left_at = player.step_to_leave_at();
        let scenario = self.leave_at(left_at).begin_with(set, acts, coalesces)?;
        self.values.suit(&scenario);
        let said = format!("a new run, {FROM_START}");
        Ok(ScenarioEdit {
            change: RunChange::BeginsAnew {
                is_act: false,
                is_again: coalesces,
            },
            scenario,
            said: if left_at > 0 {
                EditMessage::Text(said)
            } else {
                EditMessage::Nothing
            },
        })
    }

    /// Restarts the run with the scheme and time step of `offer`.
    pub(super) fn take_offer(&mut self, offer: Offer, player: &Player) -> ScenarioEdit {
        let Offer { what, scenario, .. } = offer;
        let in_place = match edited_motion(player.run().scenario()) {
            Some(edits) => format!(", in place of {edits}"),
            None => String::new(),
        };
        let left_at = player.step_to_leave_at();
        self.leave_at(left_at).begin_again(&scenario);
        self.values.suit(&scenario);
        ScenarioEdit {
            change: RunChange::BeginsAnew {
                is_act: false,
                is_again: false,
            },
            scenario,
            said: EditMessage::Text(format!("{what}{in_place}, {FROM_START}")),
        }
    }

    /// Performs `acts` at the present step as one edit. With `coalesces`, a single undo restores them and the edit
    /// before.
    ///
    /// An edit at step 0 of a run that was played further replays the run to the same time.
    fn perform(
        &mut self,
        acts: Vec<Act>,
        coalesces: bool,
        said: EditMessage,
        player: &Player,
    ) -> Edited {
        let is_edited = acts.iter().any(|act| matches!(act, Act::Edit(_)));
        let is_metadata = acts.iter().all(Act::is_metadata);
        let nudges_at_start = coalesces && player.nudges_at_start();
        let from_start = is_edited && (nudges_at_start || player.restarts_on_edit());
        let step = if from_start { 0 } else { player.step_number() };
        let later = if is_metadata {
            0
        } else {
            self.runs.journal().later_than(step)
        };
        let scenario = self.runs.journal_mut().perform(step, acts, coalesces)?;
        Ok(ScenarioEdit {
            change: if is_metadata {
                RunChange::Described
            } else if from_start {
                RunChange::BeginsAnew {
                    is_act: true,
                    is_again: coalesces,
                }
            } else {
                RunChange::GoesOn
            },
            scenario,
            said: match later {
                0 => said,
                1 => EditMessage::Text("a later action was discarded; u restores it".to_owned()),
                _ => EditMessage::Text(format!(
                    "{later} later actions were discarded; u restores them"
                )),
            },
        })
    }

    pub(super) fn undo(&mut self, player: &Player) -> Edited {
        if self.runs.is_at_floor() {
            return Err("nothing to undo: the page began here".into());
        }
        self.move_in_journal(Journal::undo, UNDO, player)
    }

    pub(super) fn redo(&mut self, player: &Player) -> Edited {
        self.move_in_journal(Journal::redo, REDO, player)
    }

    /// Undoes or redoes one edit, with `turn`.
    fn move_in_journal(
        &mut self,
        turn: fn(&mut Journal) -> &[Arc<JournalEntry>],
        [nothing, done, run, back]: [&str; 4],
        player: &Player,
    ) -> Edited {
        let name = self.runs.name().to_owned();
        let passed = turn(self.leave_at(player.step_to_keep()));
        let (Some(first), Some(last)) = (passed.first(), passed.last()) else {
            return Err(nothing.into());
        };
        let (step, act) = (first.step, last.act.in_words());
        let is_other_run = matches!(first.act, Act::Begin(_));
        let is_metadata = passed.iter().all(|entry| entry.act.is_metadata());
        let scenario = self.runs.journal().scenario()?;
        Ok(if is_other_run {
            ScenarioEdit {
                change: self.return_to_run(&name, &scenario),
                scenario,
                said: EditMessage::Text(format!("{done}: this is {run}; {back}")),
            }
        } else {
            ScenarioEdit {
                change: if is_metadata {
                    RunChange::Described
                } else {
                    RunChange::ContinuesAt(step)
                },
                scenario,
                said: EditMessage::Text(format!("{done}: {act}, at step {step}; {back}")),
            }
        })
    }

    /// Restores the next push of the run of `scenario`, to which undo or redo has returned. `name` is the name of the
    /// run that is left now.
    fn return_to_run(&mut self, name: &str, scenario: &Arc<Scenario>) -> RunChange {
        let is_of_same_name = self.runs.name() == name;
        if !is_of_same_name {
            self.runs.set_file(scenario);
            self.values.next_push = NextPush::suggested_for(scenario);
        }
        let run = self.runs.present();
        if let Some(push) = &run.next_push {
            self.values.next_push = push.clone();
        }
        self.values.suit(scenario);
        RunChange::Returns {
            left_at: run.left_at,
            is_of_same_name,
        }
    }

    /// Updates everything that depends on the scenario of `player`, after it has changed.
    pub(super) fn follow(&mut self, player: &Player) {
        self.runs.compare_with_file(player.run().scenario());
        self.list_values(player);
    }

    pub(super) fn list_values(&mut self, player: &Player) {
        self.values.list_again(player.run(), self.runs.journal());
    }

    /// Lists the values again if other edits are in force at the present step.
    pub(super) fn read(&mut self, player: &Player) {
        let step = player.step_number();
        if self.values.is_outdated(step, self.runs.journal()) {
            self.list_values(player);
        }
    }

    /// Returns the result of the command that made `edit`, after `player` has applied it.
    pub(super) fn answer(&self, edit: ScenarioEdit, player: &Player) -> Done {
        let said = match edit.said {
            EditMessage::Nothing => None,
            EditMessage::Text(text) => Some(text),
            EditMessage::Value(key) => Some(self.value_in_words(&key, player)),
            EditMessage::ValueFromStart(key) => {
                Some(format!("{}, {FROM_START}", self.values.in_words(&key)))
            }
        };
        let is_going = player.is_replaying()
            || matches!(
                edit.change,
                RunChange::ContinuesAt(_) | RunChange::Returns { .. }
            );
        Done {
            said,
            under_way: is_going.then_some(PendingAction::Going),
            ..Done::SILENT
        }
    }

    fn value_in_words(&self, key: &str, player: &Player) -> String {
        let value = self.values.in_words(key);
        match Effect::of_key(key) {
            Effect::None => format!("{value}; u undoes it"),
            _ if is_of_a_push_that_is_over(key, player) => "that push is over: u undoes this, \
                and g goes back before it"
                .to_owned(),
            _ if player.nudges_at_start() => {
                format!("{value}, {FROM_START}")
            }
            _ => format!("{value}, from the next step on; u undoes it"),
        }
    }
}

fn is_of_a_push_that_is_over(key: &str, player: &Player) -> bool {
    let simulation = player.run().simulation();
    let (step, time_s) = (simulation.step_number(), simulation.state().time_s);
    let (_, pushes) = in_force(simulation.scenario(), step);
    let push = number_of_push(key).and_then(|number| pushes.get(number));
    push.is_some_and(|push| acts_s(push, simulation.scenario()).1 <= time_s)
}
