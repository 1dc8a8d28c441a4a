//! Changing the run: a value of its scenario, a push; and taking it back.

use super::editor::Line;
use super::{BELONGS, Lab, dialogs::Asking};
use crate::lab::action::Direction;
use crate::lab::view::Pane;
use crate::run::Clock;
use crate::run::pushes::acts_s;
use crate::scenario::Scenario;
use crate::scenario::keys::Effect;
use crate::work::history::Turn;
use crate::work::journal::{Act, number_of_push};
use crate::work::next_push::{Field, NextPush};
use crate::work::parameters::{self, Parameter, parameters};
use crate::work::restart::in_force;
use std::sync::Arc;
use std::time::Duration;
use toml::Value;

/// The editor's group of lines for the push to come.
const NEXT_PUSH: &str = "next push (p)";

/// The groups in the order in which the editor lists them; pushes stand after the start, points after the body.
const ORDER: [&str; 6] = ["motion", "start", NEXT_PUSH, "body", "view", "scenario"];

/// What a line of the editor stands for.
#[derive(Clone)]
pub(super) enum Target {
    /// A value of the scenario.
    Parameter(Box<Parameter>),
    /// A value of the push to come.
    NextPush(Field),
}

impl Lab {
    /// Lists what can be edited, as it is now.
    pub(super) fn list_parameters(&mut self) {
        self.entries_listed = self.entries_in_force();
        let scenario = self.run().scenario();
        let table = parameters::table_at(scenario, self.playback.step_number());
        // Of a push that is given later, nothing can be set here: what is done here takes its place.
        let pushes = self
            .history
            .present()
            .journal
            .pushes_by(self.playback.step_number());
        let first_added = scenario.file.push.len(); // by an edit, which stands in the table once it is made
        let is_given = |parameter: &Parameter| {
            number_of_push(&parameter.key)
                .is_none_or(|number| number < pushes || number >= first_added)
        };
        let values = parameters(&table, scenario).into_iter().filter(is_given);
        let values = values.map(|parameter| Target::Parameter(Box::new(parameter)));
        let mut targets: Vec<_> = values.chain(Field::ALL.map(Target::NextPush)).collect();
        targets.sort_by_key(|target| rank(target.group())); // stable: within a group nothing moves
        let lines = targets
            .iter()
            .map(|target| target.line(&self.next_push))
            .collect();
        self.editor.set_lines(lines);
        self.targets = targets;
    }

    /// How many entries of the journal act by now.
    pub(super) fn entries_in_force(&self) -> usize {
        self.history
            .present()
            .journal
            .in_force(self.playback.step_number())
    }

    fn selected(&self) -> Option<&Target> {
        self.targets.get(self.editor.selected_index())
    }

    pub(super) fn turn_to_parameters(&mut self) {
        self.turn_to(Pane::Parameters);
        self.say(
            "Up and Down choose a value, Left and Right nudge it, Enter types it; u takes it back",
        );
    }

    pub(super) fn choose_push(&mut self) {
        self.turn_to(Pane::Parameters);
        self.editor.select(NEXT_PUSH, Field::Size.label().0);
        self.say("the push to come: p gives it");
    }

    pub(super) fn move_in_parameters(&mut self, direction: Direction, times: i32) {
        match direction {
            Direction::Up | Direction::PageUp => self.editor.shift(-(times as isize)),
            Direction::Down | Direction::PageDown => self.editor.shift(times as isize),
            Direction::Left => self.nudge(-times),
            Direction::Right => self.nudge(times),
        }
    }

    fn nudge(&mut self, times: i32) {
        let scenario = Arc::clone(self.run().scenario());
        match self.selected() {
            None => {}
            Some(Target::Parameter(parameter)) => {
                let (key, label) = (parameter.key.clone(), parameter.label.clone());
                let done = parameter
                    .nudged(times)
                    .map_err(|reason| format!("{label} {reason}"));
                let belongs = |(last, at): &(String, Duration)| {
                    *last == key && self.now.saturating_sub(*at) < BELONGS
                };
                let is_again = self.last_nudged.as_ref().is_some_and(belongs);
                match done.and_then(|value| self.set(&key, value, is_again)) {
                    Ok(()) => self.last_nudged = Some((key, self.now)),
                    Err(reason) => self.say(reason),
                }
            }
            Some(Target::NextPush(field)) => {
                match self.next_push.nudged(*field, times, &scenario) {
                    Ok(next) => self.choose_next_push(next),
                    Err(reason) => self.say(reason),
                }
            }
        }
    }

    fn choose_next_push(&mut self, next: NextPush) {
        self.next_push = next;
        self.list_parameters();
    }

    /// Asks for the value of the line that is selected.
    pub(super) fn ask_for_value(&mut self) {
        if self.view.focus != Pane::Parameters {
            return self.turn_to_parameters();
        }
        let Some(line) = self.editor.selected().cloned() else {
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
        let about = match self.selected() {
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

    /// Takes `text` for the value of the line that is selected.
    ///
    /// # Errors
    /// Why it is none; nothing has changed then.
    pub(super) fn take_value(&mut self, text: &str) -> Result<(), String> {
        let scenario = Arc::clone(self.run().scenario());
        match self.selected() {
            None => Ok(()),
            Some(Target::Parameter(parameter)) => {
                let (key, label) = (parameter.key.clone(), parameter.label.clone());
                let value = parameter
                    .typed(text)
                    .map_err(|reason| format!("{label} {reason}"))?;
                match value == parameter.value && !parameter.is_default {
                    true => Ok(()),
                    false => self.set(&key, value, false),
                }
            }
            Some(Target::NextPush(field)) => {
                let (motion, _) = in_force(&scenario, self.playback.step_number());
                let next = self
                    .next_push
                    .typed(*field, text, &scenario, motion.time_step_s)?;
                self.choose_next_push(next);
                Ok(())
            }
        }
    }

    /// Sets `key` to `value`: for the steps to come, or in a new run. What `is_again` set is taken back together with
    /// what was set before.
    fn set(&mut self, key: &str, value: Value, is_again: bool) -> Result<(), String> {
        match Effect::of(key) {
            Effect::NewRun => self.begin_with(key, value, is_again),
            Effect::FromHere | Effect::None => {
                let said = self.act(Act::set(key, value), is_again)?;
                self.say(said.unwrap_or_else(|| self.said_of(key)));
                Ok(())
            }
        }
    }

    fn begin_with(&mut self, key: &str, value: Value, is_again: bool) -> Result<(), String> {
        let here = self.playback.step_number();
        let had_begun = here > 0;
        self.history.stands(here, &self.next_push); // wherever it was bound for: the new run moves as it does here
        let begun = match is_again {
            true => self.history.begin_again_with(key, value),
            false => self.history.begin_with(key, value),
        };
        let scenario = begun.map_err(|problems| problems.in_one_line())?;
        self.begin_run(Arc::new(scenario));
        if had_begun {
            self.say("a new run; the one before is dotted, and u goes back to it");
        }
        Ok(())
    }

    /// What is to be said of `key`, the value selected, now that it is set.
    fn said_of(&self, key: &str) -> String {
        let line = self.editor.selected().cloned().unwrap_or_default();
        let value = format!("{} {} {}", line.label, line.value, line.unit);
        let value = value.trim_end();
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

    /// Does `act` here; gives what is to be said of what has made way for it.
    fn act(&mut self, act: Act, is_again: bool) -> Result<Option<String>, String> {
        let step = self.playback.step_number();
        let is_described = matches!(act, Act::Describe(_));
        let later = self.history.present().journal.later_than(step);
        let done = match is_again {
            true => self.history.act_again(step, act),
            false => self.history.act(step, act),
        };
        let scenario = done.map_err(|problems| problems.in_one_line())?;
        let is_as_long = scenario.steps == self.run().scenario().steps;
        self.take_over(scenario, is_described);
        if !is_as_long {
            self.history.set_end(Clock::end_s(self.run().scenario()));
            self.playback.set_end(self.history.present().end_s);
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
            true => self.playback.describe_as(&scenario),
            false => self.playback.go_on_in(&scenario),
        }
        self.is_another();
    }

    /// Gives the push to come, from here on.
    pub(super) fn push(&mut self) {
        let run = self.run();
        let given = self
            .next_push
            .given(run.scenario(), run.simulation().state());
        let said = format!(
            "pushed: {}; u takes it back, P chooses another",
            self.next_push.in_words()
        );
        let done = given.and_then(|push| self.act(Act::Push(push), false));
        self.say(match done {
            Ok(made_way) => made_way.unwrap_or(said),
            Err(reason) => reason,
        });
    }

    pub(super) fn undo(&mut self, times: i32) {
        self.turn_back_or_on(
            times,
            "undone",
            "U brings it again",
            "nothing to undo",
            super::History::undo,
        );
    }

    pub(super) fn redo(&mut self, times: i32) {
        self.turn_back_or_on(
            times,
            "done again",
            "u takes it back",
            "nothing to do again",
            super::History::redo,
        );
    }

    fn turn_back_or_on(
        &mut self,
        times: i32,
        done: &str,
        other_way: &str,
        nothing: &str,
        turn: impl Fn(&mut super::History) -> Option<Turn>,
    ) {
        for _ in 0..times {
            let name = self.name().to_owned();
            self.stands();
            match turn(&mut self.history) {
                None => return self.say(nothing),
                Some(Turn::Here { step, act }) => {
                    self.turn_here(step, &act);
                    self.say(format!(
                        "{done}: {}, at step {step}; {other_way}",
                        act.in_words()
                    ));
                }
                Some(Turn::Elsewhere) => {
                    self.turn_elsewhere(&name);
                    self.say(format!("{done}: another run; {other_way}"));
                }
            }
        }
    }

    /// The same run with another journal, from `step` on.
    fn turn_here(&mut self, step: u64, act: &Act) {
        let scenario = match self.history.present().journal.scenario() {
            Ok(scenario) => Arc::new(scenario),
            Err(problems) => return self.say(problems.in_one_line()),
        };
        if scenario.steps != self.run().scenario().steps {
            // Not by this scenario: edits of the time step since then have not moved the end.
            let told = self.history.present().journal.when_its_length_was_told();
            self.history
                .set_end(Clock::end_s(told.as_ref().unwrap_or(&scenario)));
        }
        match act {
            Act::Describe(_) => self.playback.describe_as(&scenario),
            Act::Edit(_) | Act::Push(_) => self.playback.turn_at(step, &scenario),
        }
        self.playback.set_end(self.history.present().end_s);
        self.is_another();
    }

    /// Another run, where it was left; the one opened as `before` was shown until now.
    fn turn_elsewhere(&mut self, before: &str) {
        let chapter = self.history.present();
        let (name, left_at, end_s) = (chapter.name.clone(), chapter.left_at, chapter.end_s);
        let next_push = chapter.next_push.clone();
        match chapter.journal.scenario().map(Arc::new) {
            Err(problems) => self.say(problems.in_one_line()),
            Ok(scenario) if name == before => self.go_over_to(scenario),
            Ok(scenario) => self.show_another(scenario, false),
        }
        self.next_push = next_push.map_or(self.next_push.clone(), |push| {
            push.suited_to(self.run().scenario())
        });
        self.playback.set_end(end_s);
        self.playback.go_to(left_at);
        self.returning_to = Some(left_at);
        self.list_parameters();
    }
}

impl Target {
    fn group(&self) -> &str {
        match self {
            Self::Parameter(parameter) => &parameter.group,
            Self::NextPush(_) => NEXT_PUSH,
        }
    }

    fn line(&self, push: &NextPush) -> Line {
        let group = self.group().to_owned();
        match self {
            Self::Parameter(parameter) => Line {
                key: parameter.key.clone(),
                group,
                label: parameter.label.clone(),
                value: parameter.shown(),
                unit: parameter.unit().to_owned(),
                is_default: parameter.is_default,
            },
            Self::NextPush(field) => Line {
                key: String::new(),
                group,
                label: field.label().0.to_owned(),
                value: push.shown(*field),
                unit: field.label().1.to_owned(),
                is_default: false,
            },
        }
    }
}

/// The place of a group in the list: pushes stand above the push to come, points below the body.
fn rank(group: &str) -> usize {
    let listed = ORDER.iter().position(|known| *known == group);
    let place = |of: &str| ORDER.iter().position(|known| *known == of).unwrap_or(0);
    match listed {
        Some(rank) => 2 * rank,
        None if group.starts_with("push") => 2 * place("start") + 1,
        None => 2 * place("body") + 1,
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
