//! What the user does to the run: values and pushes, undo and redo, and the opening of another scenario.

use super::advice::Offer;
use super::answer::{ActionResult, Done, PendingAction, Refusal};
use super::command::{Force, PushChoice};
use super::player::{Player, RunChange};
use super::runs::{HistoryDirection, Runs};
use super::values::Values;
use crate::engine::journal::history::{History, Reversal};
use crate::engine::journal::next_push::NextPush;
use crate::engine::journal::restart::in_force;
use crate::engine::journal::restart::replaced;
use crate::engine::journal::{Act, number_of_push};
use crate::engine::run::pushes::acts_s;
use crate::engine::scenario::Scenario;
use crate::engine::scenario::file::PushFile;
use crate::engine::scenario::keys::Effect;
use crate::engine::scenario::problem::nearest;
use std::sync::Arc;
use std::time::Duration;
use toml::Table;

/// What is said of undo and redo: that there is nothing to do, what was done, to which run it leads, and the way back.
const UNDO: [&str; 4] = [
    "nothing to undo",
    "undone",
    "the run before",
    "U brings it again",
];
const REDO: [&str; 4] = [
    "nothing to do again",
    "done again",
    "the run after",
    "u takes it back",
];

/// The runs, and the values that can be edited.
pub struct Edits {
    pub(super) runs: Runs,
    pub(super) values: Values,
}

/// What an edit has done: the run goes over to another scenario. The other parts of the lab follow.
pub(super) struct ScenarioEdit {
    pub(super) change: RunChange,
    pub(super) scenario: Arc<Scenario>,
    /// The time at which the run ends, s, where the edit has moved its end.
    pub(super) end_s: Option<f64>,
    said: EditMessage,
    under_way: Option<PendingAction>,
}

enum EditMessage {
    Nothing,
    Text(String),
    /// The value of this key, and from when on it acts.
    Value(String),
}

impl EditMessage {
    fn text(text: &str) -> Self {
        Self::Text(text.to_owned())
    }
}

/// What a command has changed; `None` where the run is as it was.
type Edited = Result<Option<ScenarioEdit>, Refusal>;

impl Edits {
    pub(super) fn new(name: &str, scenario: &Arc<Scenario>) -> Self {
        Self {
            runs: Runs::new(name, scenario),
            values: Values::new(scenario),
        }
    }

    /// Takes up the history and the push to come of a session.
    pub(super) fn resume(
        &mut self,
        history: History,
        file: &Arc<Scenario>,
        next_push: NextPush,
        player: &Player,
    ) {
        self.runs = Runs::resumed(history, file);
        self.values.next_push = next_push;
        self.values.suit(player.run().scenario());
    }

    /// Records the step and the push to come with which the present run may be left now. The step is the one that the
    /// run is on its way back to, if it is.
    fn leave(&mut self, player: &Player) {
        let step = player.step_to_keep();
        self.runs.leave_at(step, &self.values.next_push);
    }

    /// Leaves the present run for that of `scenario`, opened as `name`.
    pub(super) fn open(
        &mut self,
        name: &str,
        scenario: Arc<Scenario>,
        player: &Player,
    ) -> ScenarioEdit {
        self.leave(player);
        self.runs.open(name, &scenario);
        self.values.next_push = NextPush::of(&scenario);
        ScenarioEdit {
            change: RunChange::Opens,
            scenario,
            end_s: None,
            said: EditMessage::Nothing,
            under_way: None,
        }
    }

    /// Sets all keys of `table` as one act, with `is_again` together with the act before. Keys of body and start begin a new
    /// run; the others act from the next step on.
    pub(super) fn set(&mut self, table: &Table, is_again: bool, player: &Player) -> Edited {
        let (new, rest): (Table, Table) = table
            .clone()
            .into_iter()
            .partition(|(key, _)| Effect::of_key(key) == Effect::NewRun);
        let acts = acts(rest);
        if new.is_empty() {
            let said = match table.len() {
                1 => EditMessage::Value(table.keys().cloned().collect()),
                more => EditMessage::Text(format!("{more} values; u takes them back")),
            };
            self.act(acts, is_again, said, player)
        } else {
            self.begin_with(&new, acts, is_again, player).map(Some)
        }
    }

    pub(super) fn nudge(
        &mut self,
        key: &str,
        times: i32,
        player: &Player,
        now: Duration,
    ) -> Edited {
        let Some(parameter) = self.values.parameter(key) else {
            let listed = self.values.list.values.iter();
            let near = nearest(key, listed.filter_map(|value| value.key.as_deref()));
            return Err(format!("{key} is no value of this scenario: {near}").into());
        };
        let value = parameter
            .nudged(times)
            .map_err(|reason| format!("{} {reason}", parameter.label))?;
        let is_again = self.values.is_nudged_again(key, now);
        let table = Table::from_iter([(key.to_owned(), value)]);
        let edited = self.set(&table, is_again, player)?;
        self.values.note_nudge(key, now);
        Ok(edited)
    }

    /// Pushes from the next step on: with the push to come, but for the values that `choice` has.
    pub(super) fn push(&mut self, choice: &PushChoice, player: &Player) -> Edited {
        let (push, given) = self.given(choice, player)?;
        let said = format!(
            "pushed: {}; u takes it back, P chooses another",
            push.in_words()
        );
        self.act(
            vec![Act::Push(given)],
            false,
            EditMessage::Text(said),
            player,
        )
    }

    /// The push that `choice` stands for, as the user chooses it and as it acts at the present step.
    fn given(&self, choice: &PushChoice, player: &Player) -> Result<(NextPush, PushFile), String> {
        let push = self.chosen(choice, player)?;
        let run = player.run();
        let mut given = push.given(run.scenario(), run.simulation().state())?;
        if let Some(Force::Vector(vector)) = choice.force_N {
            given.force_N = vector; // exactly as it was written: norm and direction would round it
        }
        Ok((push, given))
    }

    /// Whether `choice` is a push at the step at which the last one was given, and the run was played on since.
    pub(super) fn is_push_tried_again(&self, choice: &PushChoice, player: &Player) -> bool {
        let here = player.step_number();
        self.given(choice, player).is_ok()
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

    /// Begins a new run with the values of `set` in its scenario, and does `acts` at its beginning. With `is_again` it
    /// replaces the present run, which began with another value of the same key.
    fn begin_with(
        &mut self,
        set: &Table,
        acts: Vec<Act>,
        is_again: bool,
        player: &Player,
    ) -> Result<ScenarioEdit, Refusal> {
        let left_at = player.step_to_leave_at();
        self.runs.leave_at(left_at, &self.values.next_push);
        let scenario = self.runs.begin_with(set, acts, is_again)?;
        self.values.suit(&scenario);
        let said = "a new run; the one before is dotted, and u goes back to it".to_owned();
        Ok(ScenarioEdit {
            change: RunChange::BeginsAnew {
                is_act: false,
                is_again,
            },
            scenario,
            end_s: Some(self.runs.present().end_s),
            said: if left_at > 0 {
                EditMessage::Text(said)
            } else {
                EditMessage::Nothing
            },
            under_way: None,
        })
    }

    /// Begins the run anew as the advice says.
    pub(super) fn take_offer(&mut self, offer: Offer, player: &Player) -> ScenarioEdit {
        let left_at = player.step_to_leave_at();
        let replaced = replaced(player.run().scenario());
        let replaced = replaced.map_or(String::new(), |edits| format!(", in place of {edits}"));
        let Offer { what, scenario, .. } = offer;
        self.runs.leave_at(left_at, &self.values.next_push);
        self.runs.begin_as_advised(&scenario);
        self.values.suit(&scenario);
        ScenarioEdit {
            change: RunChange::BeginsAnew {
                is_act: false,
                is_again: false,
            },
            scenario,
            end_s: None,
            said: EditMessage::Text(format!(
                "{what} from the start{replaced}; the run before is dotted, u goes back to it"
            )),
            under_way: None,
        }
    }

    /// Does `acts` at the present step as one act, all or none; with `is_again`, undo takes them back together with the
    /// act before. An edit at step 0 of a run that was played further plays it as far again.
    fn act(
        &mut self,
        acts: Vec<Act>,
        is_again: bool,
        said: EditMessage,
        player: &Player,
    ) -> Edited {
        let is_edited = acts.iter().any(|act| matches!(act, Act::Edit(_)));
        let nudges_at_start = is_again && player.nudges_at_start();
        let from_start = is_edited && (nudges_at_start || player.restarts_on_edit());
        let here = player.step_number();
        let step = if from_start { 0 } else { here };
        let steps = player.run().scenario().steps;
        let is_described = acts.iter().all(|act| matches!(act, Act::Describe(_)));
        let later = self.runs.journal().later_than(step);
        let Some(scenario) = self.runs.act(step, acts, is_again, steps)? else {
            return Ok(None);
        };
        Ok(Some(ScenarioEdit {
            change: if is_described {
                RunChange::Described
            } else if from_start {
                RunChange::BeginsAnew {
                    is_act: true,
                    is_again,
                }
            } else {
                RunChange::GoesOn
            },
            end_s: (scenario.steps != steps).then_some(self.runs.present().end_s),
            scenario,
            said: match later {
                0 => said,
                _ if is_described => said,
                1 => EditMessage::text("a later action has made way for it; u brings it back"),
                _ => EditMessage::Text(format!(
                    "{later} later actions have made way for it; u brings them back"
                )),
            },
            under_way: None,
        }))
    }

    /// Undoes the last act, or does the last undone one again.
    pub(super) fn turn(
        &mut self,
        way: HistoryDirection,
        player: &Player,
    ) -> Result<ScenarioEdit, Refusal> {
        if way == HistoryDirection::Undo && self.runs.is_at_floor() {
            return Err("nothing to undo: the page began here".into());
        }
        self.leave(player);
        let [nothing, done, run, other_way] = match way {
            HistoryDirection::Undo => UNDO,
            HistoryDirection::Redo => REDO,
        };
        let turned = self.runs.turn(way, player.run().scenario().steps)?;
        let turned = turned.ok_or(nothing)?;
        let (change, said) = match turned.what {
            Reversal::SameRun { step, act } => {
                let said = format!("{done}: {}, at step {step}; {other_way}", act.in_words());
                let is_described = matches!(act, Act::Describe(_));
                let change = if is_described {
                    RunChange::Described
                } else {
                    RunChange::ContinuesAt(step)
                };
                (change, said)
            }
            Reversal::OtherRun => {
                let said = format!("{done}: this is {run}; {other_way}");
                (
                    self.return_to_run(turned.is_of_same_name, &turned.scenario),
                    said,
                )
            }
        };
        Ok(ScenarioEdit {
            change,
            scenario: turned.scenario,
            end_s: Some(self.runs.present().end_s),
            said: EditMessage::Text(said),
            under_way: Some(PendingAction::Going),
        })
    }

    /// Prepares the push with which the run of `scenario`, the present one again, was left.
    fn return_to_run(&mut self, is_of_same_name: bool, scenario: &Scenario) -> RunChange {
        if !is_of_same_name {
            self.values.next_push = NextPush::of(scenario);
        }
        let run = self.runs.present();
        if let Some(push) = run.next_push.clone() {
            self.values.next_push = push;
        }
        self.values.suit(scenario);
        RunChange::Returns {
            left_at: run.left_at,
            is_of_same_name,
        }
    }

    /// Brings up to date what depends on the scenario of `player`, which has changed.
    pub(super) fn follow(&mut self, player: &Player) {
        self.runs.compare_with_file(player.run().scenario());
        self.list_values(player);
    }

    pub(super) fn list_values(&mut self, player: &Player) {
        self.values.list_again(player.run(), self.runs.journal());
    }

    /// Lists the values again if others are in force.
    pub(super) fn read(&mut self, player: &Player) {
        let step = player.step_number();
        if self.values.is_outdated(step, self.runs.journal()) {
            self.list_values(player);
        }
    }

    /// The answer to the command that has made `edit`, which `player` has followed.
    pub(super) fn answer(&self, edit: ScenarioEdit, player: &Player) -> Done {
        let said = match edit.said {
            EditMessage::Nothing => None,
            EditMessage::Text(text) => Some(text),
            EditMessage::Value(key) => Some(self.value_in_words(&key, player)),
        };
        let is_replaying = player.is_replaying();
        Done {
            said,
            under_way: edit
                .under_way
                .or(is_replaying.then_some(PendingAction::Going)),
            ..Done::SILENT
        }
    }

    fn value_in_words(&self, key: &str, player: &Player) -> String {
        let value = self.values.in_words(key);
        match Effect::of_key(key) {
            Effect::None => format!("{value}; u takes it back"),
            _ if is_of_a_push_that_is_over(key, player) => {
                "that push is over and acts no more: u takes this back, \
                and g goes to before it"
                    .to_owned()
            }
            _ if player.nudges_at_start() => {
                format!("{value}, from the start; the run before is dotted, u takes it back")
            }
            _ => format!("{value}, from the next step on; u takes it back"),
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

/// The acts that set the keys of `table`: an edit, a description, or both.
fn acts(table: Table) -> Vec<Act> {
    let (idle, acting): (Table, Table) = table
        .into_iter()
        .partition(|(key, _)| Effect::of_key(key) == Effect::None);
    let edit = (!acting.is_empty()).then_some(Act::Edit(acting));
    let description = (!idle.is_empty()).then_some(Act::Describe(idle));
    edit.into_iter().chain(description).collect()
}
