//! Changes of the run: values and pushes, undo and redo, and the change from one run to another.

use super::Lab;
use super::answer::{Answer, Done, UnderWay};
use super::view::Pane;
use super::work::{Turned, Way};
use crate::journal::history::Reversal;
use crate::journal::next_push::NextPush;
use crate::journal::restart::in_force;
use crate::journal::{Act, number_of_push};
use crate::run::Simulation;
use crate::run::pushes::acts_s;
use crate::scenario::Scenario;
use crate::scenario::keys::Effect;
use std::sync::Arc;
use toml::Table;

impl Lab {
    pub(super) fn list_parameters(&mut self) {
        self.values
            .list_again(self.player.run(), self.work.journal());
    }

    /// Moves the focus to the values, and says which keys change them.
    pub(super) fn turn_to_parameters(&mut self) {
        self.view.turn_to(Pane::PARAMETERS);
        self.say("Up, Down choose a value; Left, Right nudge it; Enter types it; u undoes");
    }

    /// Moves the focus to the values of the push to come.
    pub(super) fn turn_to_next_push(&mut self) {
        self.view.turn_to(Pane::PARAMETERS);
        self.values.select_next_push();
        self.say("the push to come: p gives it");
    }

    pub(super) fn choose_next_push(&mut self, next: NextPush) -> Done {
        self.values.next_push = next;
        self.list_parameters();
        Done::SILENT
    }

    /// Begins a new run with the values of `set` in its scenario, and does `acts` at its beginning. With `is_again` it
    /// replaces the present run, which began with another value of the same key.
    pub(super) fn begin_with(&mut self, set: &Table, acts: Vec<Act>, is_again: bool) -> Answer {
        let left_at = self.player.step_to_leave_at();
        self.work.leave_at(left_at, &self.values.next_push);
        let scenario = self.work.begin_with(set, acts, is_again)?;
        self.values.suit(&scenario);
        self.player.begin(scenario, is_again);
        self.player.playback.set_end(self.work.present().end_s);
        self.scenario_has_changed();
        let said = "a new run; the one before is dotted, and u goes back to it".to_owned();
        Ok(self.on_its_way(Done::saying_any((left_at > 0).then_some(said))))
    }

    /// `done`; it says that the command is under way where the run is replayed to the time at which the lab stood.
    pub(super) fn on_its_way(&self, done: Done) -> Done {
        if self.player.is_replaying() {
            done.going_on(UnderWay::Going)
        } else {
            done
        }
    }

    /// The message after setting `key`.
    pub(super) fn said_of(&self, key: &str) -> String {
        let value = self.values.in_words(key);
        match Effect::of(key) {
            Effect::None => format!("{value}; u takes it back"),
            _ if self.is_of_a_push_that_is_over(key) => {
                "that push is over and acts no more: u takes this back, \
                and g goes to before it"
                    .to_owned()
            }
            _ if self.player.acts_at_start_again() => {
                format!("{value}, from the start; the run before is dotted, u takes it back")
            }
            _ => format!("{value}, from the next step on; u takes it back"),
        }
    }

    fn is_of_a_push_that_is_over(&self, key: &str) -> bool {
        let simulation = self.player.run().simulation();
        let (step, time_s) = (simulation.step_number(), simulation.state().time_s);
        let (_, pushes) = in_force(simulation.scenario(), step);
        let push = number_of_push(key).and_then(|number| pushes.get(number));
        push.is_some_and(|push| acts_s(push, simulation.scenario()).1 <= time_s)
    }

    /// Does `acts` at the present step as one act, all or none; with `is_again`, undo takes them back together with the
    /// act before. An edit at step 0 of a run that was played further plays it as far again. Returns a message if later acts were discarded.
    pub(super) fn act_all(
        &mut self,
        acts: Vec<Act>,
        is_again: bool,
    ) -> Result<Option<String>, String> {
        let is_edited = acts.iter().any(|act| matches!(act, Act::Edit(_)));
        let acts_at_start_again = is_again && self.player.acts_at_start_again();
        let from_start = is_edited && (acts_at_start_again || self.player.stands_at_start());
        let step = if from_start {
            0
        } else {
            self.player.playback.step_number()
        };
        let steps = self.player.run().scenario().steps;
        let is_described = acts.iter().all(|act| matches!(act, Act::Describe(_)));
        let later = self.work.journal().later_than(step);
        let Some(scenario) = self.work.act(step, acts, is_again, steps)? else {
            return Ok(None);
        };
        if is_described {
            self.player.playback.describe_as(&scenario);
        } else if from_start {
            self.player.begin_with_act(&scenario, is_again);
        } else {
            self.player.go_on_in(&scenario);
        }
        self.scenario_has_changed();
        if scenario.steps != steps {
            self.player.playback.set_end(self.work.present().end_s);
        }
        let made_way = later > 0 && !is_described;
        Ok(made_way.then(|| match later {
            1 => "a later action has made way for it; u brings it back".to_owned(),
            _ => format!("{later} later actions have made way for it; u brings them back"),
        }))
    }

    /// Undoes the last `times` acts, or does as many undone ones again.
    pub(super) fn turn(&mut self, way: Way, times: u32) -> Answer {
        let mut answer = Done::SILENT;
        for _ in 0..times {
            if way == Way::Back && self.work.is_at_floor() {
                return Err("nothing to undo: the page began here; N turns back".into());
            }
            self.leave();
            let steps = self.player.run().scenario().steps;
            let turned = self.work.turn(way, steps)?;
            answer = match (turned, way) {
                (Some(turned), _) => self.turned(turned, way),
                (None, Way::Back) => return Err("nothing to undo".into()),
                (None, Way::On) => return Err("nothing to do again".into()),
            };
        }
        Ok(answer.going_on(UnderWay::Going))
    }

    /// Shows the run as an undo or a redo has left it.
    fn turned(&mut self, turned: Turned, way: Way) -> Done {
        let (done, run, other_way) = match way {
            Way::Back => ("undone", "the run before", "U brings it again"),
            Way::On => ("done again", "the run after", "u takes it back"),
        };
        let scenario = turned.scenario;
        Done::saying(match turned.what {
            Reversal::SameRun { step, act } => {
                match act {
                    Act::Describe(_) => self.player.playback.describe_as(&scenario),
                    Act::Edit(_) | Act::Push(_) => self.player.continue_at(step, &scenario),
                }
                self.player.playback.set_end(self.work.present().end_s);
                self.scenario_has_changed();
                let act = act.in_words();
                format!("{done}: {act}, at step {step}; {other_way}")
            }
            Reversal::OtherRun => {
                self.return_to_run(scenario, turned.is_of_same_name);
                format!("{done}: this is {run}; {other_way}")
            }
        })
    }

    /// Shows the run of `scenario`, which is the present one again, at the step where it was left. `is_of_same_name` tells
    /// whether the run shown until now was opened under the same name: that one then stays as a ghost.
    fn return_to_run(&mut self, scenario: Arc<Scenario>, is_of_same_name: bool) {
        if is_of_same_name {
            self.values.suit(&scenario);
            self.player.go_over_to(scenario);
            self.scenario_has_changed();
        } else {
            self.show_another(scenario);
        }
        let run = self.work.present();
        if let Some(push) = run.next_push.clone() {
            self.values.next_push = push;
            self.values.suit(self.player.run().scenario());
        }
        self.player.playback.set_end(run.end_s);
        self.player.return_to(run.left_at);
        self.list_parameters();
    }

    /// Leaves the present run for that of `scenario`, opened as `name`, which is paused at step 0.
    pub(super) fn open(&mut self, name: &str, scenario: Arc<Scenario>) {
        self.leave();
        let before = Arc::clone(self.player.run().scenario());
        self.work.open(name, &scenario);
        self.show_another(scenario);
        self.measure_as_opened(&before);
    }

    /// Records the step and the push to come with which the present run may be left now. The step is the one that the
    /// run is on its way back to, if it is.
    fn leave(&mut self) {
        let step = self.player.step_to_keep();
        self.work.leave_at(step, &self.values.next_push);
    }

    /// Shows the run of `scenario`, which was opened under another name than the run shown until now.
    fn show_another(&mut self, scenario: Arc<Scenario>) {
        self.view.fit(&scenario);
        self.values.next_push = NextPush::of(&scenario);
        self.player.open(scenario);
        self.scenario_has_changed();
    }

    /// Brings up to date what depends on the run's scenario. To be called after every change of it.
    pub(super) fn scenario_has_changed(&mut self) {
        self.player.forget_advice();
        // The cursor stays at its time, which may be another step now.
        if let (Some(_), Some(cursor)) = (self.view.cursor, self.player.cursor()) {
            let step = Simulation::step_at(self.player.run().scenario(), cursor.time_s);
            self.view.cursor = Some(step);
        }
        self.work.compare_with_file(self.player.run().scenario());
        self.list_parameters();
    }
}
