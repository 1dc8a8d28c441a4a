//! Changing the run: a value of its scenario, a push; and taking it back.

use super::carry_out::{Answer, Done, UnderWay};
use super::values::Target;
use super::{Lab, dialogs::Asking};
use crate::lab::view::Pane;
use crate::run::Clock;
use crate::run::pushes::acts_s;
use crate::scenario::Scenario;
use crate::scenario::keys::Effect;
use crate::work::history::{History, Reversal};
use crate::work::journal::{Act, number_of_push};
use crate::work::next_push::NextPush;
use crate::work::parameters::Parameter;
use crate::work::restart::in_force;
use std::sync::Arc;
use toml::Table;

impl Lab {
    /// Lists what can be edited, as it is now.
    pub(super) fn list_parameters(&mut self) {
        self.values
            .list(self.player.run(), &self.history.present().journal);
    }

    pub(super) fn turn_to_parameters(&mut self) {
        self.turn_to(Pane::PARAMETERS);
        self.say(
            "Up and Down choose a value, Left and Right nudge it, Enter types it; u takes it back",
        );
    }

    pub(super) fn choose_push(&mut self) {
        self.turn_to(Pane::PARAMETERS);
        self.values.select_next_push();
        self.say("the push to come: p gives it");
    }

    pub(super) fn choose_next_push(&mut self, next: NextPush) {
        self.values.set_next_push(next);
        self.list_parameters();
    }

    /// Asks for the value of the line that is selected.
    pub(super) fn ask_for_value(&mut self) {
        if self.view.focus != Pane::PARAMETERS {
            return self.turn_to_parameters();
        }
        let Some(line) = self.values.editor().selected().cloned() else {
            return;
        };
        let title = match line.key.is_empty() {
            true => format!("{} {}", line.group, line.label),
            false => line.key.clone(),
        };
        let label = match line.unit.is_empty() {
            true => line.label.clone(),
            false => format!("{}, {}", line.label, line.unit),
        };
        let about = match self.values.selected() {
            Some(Target::Parameter(parameter)) => about(parameter),
            Some(Target::NextPush(field)) => vec![
                field.about().to_owned(),
                "it acts when p gives the push".to_owned(),
            ],
            None => Vec::new(),
        };
        let about: Vec<_> = about.iter().map(String::as_str).collect();
        self.ask(Asking::Value, &title, &[(&label, line.value)], &about);
    }

    /// Begins a new run with the values of `set` in its scenario, and does `acts` at its beginning.
    pub(super) fn begin_with(&mut self, set: &Table, acts: Vec<Act>, is_again: bool) -> Answer {
        let here = self.player.playback.step_number();
        let had_begun = here > 0;
        self.history.set_left_at(here, self.values.next_push()); // wherever it was bound for: the new run moves as it does here
        let before = (!acts.is_empty()).then(|| self.history.clone());
        let begun = match is_again {
            true => self.history.begin_again_with(set),
            false => self.history.begin_with(set),
        };
        let mut scenario = begun.map_err(|problems| problems.in_one_line())?;
        for act in acts {
            match self.history.act(0, act) {
                Ok(changed) => scenario = changed,
                Err(problems) => {
                    self.history = before.unwrap_or_else(|| self.history.clone());
                    return Err(problems.in_one_line().into());
                }
            }
        }
        self.history.set_end(Clock::end_s(&scenario));
        self.begin_run(Arc::new(scenario));
        Ok(match had_begun {
            true => Done::saying("a new run; the one before is dotted, and u goes back to it"),
            false => Done::SILENT,
        })
    }

    /// What is to be said of `key`, now that it is set.
    pub(super) fn said_of(&self, key: &str) -> String {
        let value = self.values.in_words(key);
        match Effect::of(key) {
            Effect::None => format!("{value}; u takes it back"),
            _ if self.is_of_a_push_that_is_over(key) => {
                "that push is over and acts no more: u takes this back, \
                and g goes to before it"
                    .to_owned()
            }
            _ => format!("{value}, from the next step on; u takes it back"),
        }
    }

    fn is_of_a_push_that_is_over(&self, key: &str) -> bool {
        let simulation = self.run().simulation();
        let (step, time_s) = (simulation.step_number(), simulation.state().time_s);
        let (_, pushes) = in_force(simulation.scenario(), step);
        let push = number_of_push(key).and_then(|number| pushes.get(number));
        push.is_some_and(|push| acts_s(push, simulation.scenario()).1 <= time_s)
    }

    /// Does `acts` here, all or none, to be taken back at once; gives what is to be said of what has made way for them.
    /// What `is_again` done is taken back together with what was done before.
    pub(super) fn act_all(
        &mut self,
        acts: Vec<Act>,
        is_again: bool,
    ) -> Result<Option<String>, String> {
        let step = self.player.playback.step_number();
        let is_described = acts.iter().all(|act| matches!(act, Act::Describe(_)));
        let later = self.history.present().journal.later_than(step);
        let before = (acts.len() > 1).then(|| self.history.clone());
        let mut done = None;
        for (index, act) in acts.into_iter().enumerate() {
            let result = match is_again || index > 0 {
                true => self.history.act_again(step, act),
                false => self.history.act(step, act),
            };
            match result {
                Ok(scenario) => done = Some(scenario),
                Err(problems) => {
                    self.history = before.unwrap_or_else(|| self.history.clone());
                    return Err(problems.in_one_line());
                }
            }
        }
        let Some(scenario) = done else {
            return Ok(None);
        };
        let is_as_long = scenario.steps == self.run().scenario().steps;
        self.take_over(scenario, is_described);
        if !is_as_long {
            self.history.set_end(Clock::end_s(self.run().scenario()));
            self.player.playback.set_end(self.history.present().end_s);
        }
        let made_way = later > 0 && !is_described;
        Ok(made_way.then(|| match later {
            1 => "a later action has made way for it; u brings it back".to_owned(),
            _ => format!("{later} later actions have made way for it; u brings them back"),
        }))
    }

    fn take_over(&mut self, scenario: Scenario, is_described: bool) {
        let scenario = Arc::new(scenario);
        match is_described {
            true => self.player.playback.describe_as(&scenario),
            false => self.player.playback.go_on_in(&scenario),
        }
        self.is_another();
    }

    pub(super) fn undo(&mut self, times: u32) -> Answer {
        let nothing = "nothing to undo";
        self.turn_back_or_on(
            times,
            ("undone", "U brings it again"),
            nothing,
            History::undo,
        )
    }

    pub(super) fn redo(&mut self, times: u32) -> Answer {
        let nothing = "nothing to do again";
        self.turn_back_or_on(
            times,
            ("done again", "u takes it back"),
            nothing,
            History::redo,
        )
    }

    fn turn_back_or_on(
        &mut self,
        times: u32,
        (done, other_way): (&str, &str),
        nothing: &str,
        turn: impl Fn(&mut History) -> Option<Reversal>,
    ) -> Answer {
        let mut answer = Done::SILENT;
        for _ in 0..times {
            let name = self.name().to_owned();
            self.stands();
            answer = match turn(&mut self.history) {
                None => return Err(nothing.into()),
                Some(Reversal::SameRun { step, act }) => {
                    self.turn_here(step, &act)?;
                    let act = act.in_words();
                    Done::saying(format!("{done}: {act}, at step {step}; {other_way}"))
                }
                Some(Reversal::OtherRun) => {
                    self.turn_elsewhere(&name)?;
                    Done::saying(format!("{done}: another run; {other_way}"))
                }
            };
        }
        Ok(answer.going_on(UnderWay::Going))
    }

    /// The same run with another journal, from `step` on.
    fn turn_here(&mut self, step: u64, act: &Act) -> Result<(), String> {
        let scenario = self.history.present().journal.scenario();
        let scenario = Arc::new(scenario.map_err(|problems| problems.in_one_line())?);
        if scenario.steps != self.run().scenario().steps {
            // Not by this scenario: edits of the time step since then have not moved the end.
            let told = self.history.present().journal.when_steps_were_set();
            self.history
                .set_end(Clock::end_s(told.as_ref().unwrap_or(&scenario)));
        }
        match act {
            Act::Describe(_) => self.player.playback.describe_as(&scenario),
            Act::Edit(_) | Act::Push(_) => self.player.playback.continue_at(step, &scenario),
        }
        self.player.playback.set_end(self.history.present().end_s);
        self.is_another();
        Ok(())
    }

    /// Another run, where it was left; the one opened as `before` was shown until now.
    fn turn_elsewhere(&mut self, before: &str) -> Result<(), String> {
        let chapter = self.history.present();
        let (name, left_at, end_s) = (chapter.name.clone(), chapter.left_at, chapter.end_s);
        let next_push = chapter.next_push.clone();
        let scenario = chapter.journal.scenario();
        let scenario = Arc::new(scenario.map_err(|problems| problems.in_one_line())?);
        match name == before {
            true => self.go_over_to(scenario),
            false => self.show_another(scenario),
        }
        if let Some(push) = next_push {
            self.values.set_next_push(push);
            self.values.suit(self.player.run().scenario());
        }
        self.player.playback.set_end(end_s);
        self.player.return_to(left_at);
        self.list_parameters();
        Ok(())
    }
}

/// What is known of a parameter: its meaning, its choices, when a change acts.
fn about(parameter: &Parameter) -> Vec<String> {
    let mut lines = vec![parameter.spec.about.to_owned()];
    if parameter.value.is_bool() {
        lines.push("true or false".to_owned());
    }
    if !parameter.choices.is_empty() {
        lines.push(format!("one of {}", parameter.choices.join(", ")));
    }
    let when = match Effect::of(&parameter.key) {
        Effect::NewRun => "a new run begins with it; the one before stays, dotted",
        Effect::FromHere => "it acts from the next step on",
        Effect::None => "no number depends on it",
    };
    lines.push(when.to_owned());
    lines
}
