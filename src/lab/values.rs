//! The values that the user can edit: the values of the scenario at the present step, and of the next push. One of them
//! is selected.

pub mod list;

use super::command::{Command, Force, PushChoice};
use crate::engine::journal::next_push::{NextPush, PushField, Toward};
use crate::engine::journal::parameters::{self, parameters};
use crate::engine::journal::{Journal, number_of_push};
use crate::engine::scenario::problem::nearest;
use crate::engine::scenario::{Scenario, ScenarioFile};
use crate::lab::playback::live::LiveRun;
use list::{ListedValue, MAIN_GROUPS, NEXT_PUSH_HEADING, ValueList, ValueSource, main_values};
use nalgebra::Vector3;
use std::time::Duration;
use toml::Table;

/// Maximum pause between nudges of the same value that count as one edit, which a single undo restores.
const NUDGE_PAUSE: Duration = Duration::from_secs(3);

/// The order of the groups in the list. The scenario's pushes follow the next push, and its points follow its motion.
const GROUP_ORDER: [&str; 7] = [
    MAIN_GROUPS[0],
    MAIN_GROUPS[1],
    NEXT_PUSH_HEADING,
    "start",
    "motion",
    "view",
    "scenario",
];

/// The list of values, the next push, and the value that was nudged last.
#[derive(Clone)]
pub struct Values {
    pub list: ValueList,
    /// The next push. The list shows a change once it is listed again.
    pub next_push: NextPush,
    /// The scenario's file when the list was made, including the edits up to then.
    file: ScenarioFile,
    /// Number of journal entries in force when the list was made.
    entries_listed: usize,
    /// The key of the last nudge, whether it restarted the run, and its time; `None` after any other action.
    last_nudged: Option<(String, bool, Duration)>,
}

impl Values {
    /// Creates an empty list, and a next push that is possible in `scenario`.
    pub(super) fn new(scenario: &Scenario) -> Self {
        Self {
            list: ValueList::default(),
            next_push: NextPush::suggested_for(scenario),
            file: ScenarioFile::default(),
            entries_listed: 0,
            last_nudged: None,
        }
    }

    /// Lists the values of `run`, whose journal is `journal`, at its present step.
    pub(super) fn list_again(&mut self, run: &LiveRun, journal: &Journal) {
        let step = run.simulation().step_number();
        self.entries_listed = journal.count_by(step);
        let scenario = run.scenario();
        let table = parameters::table_at(scenario, step);
        // A push at a later step cannot be edited here: an edit here would discard it.
        let pushes = journal.pushes_by(step);
        let first_added = scenario.file.push.len(); // later pushes come from edits that are in force in the table
        let mut listed = parameters(&table, scenario);
        listed.retain(|parameter| {
            number_of_push(&parameter.key)
                .is_none_or(|number| number < pushes || number >= first_added)
        });
        self.file = parameters::file_at(scenario, step);
        let mut values = main_values(&mut listed, &self.file, scenario);
        values.extend(listed.into_iter().map(ListedValue::from));
        values.extend(ListedValue::all_of(&self.next_push));
        values.sort_by_key(|value| rank(&value.group)); // stable: keeps the order within a group
        self.list.set(values);
    }

    /// Returns true if other entries of `journal` are in force at `step` than when the list was made.
    pub(super) fn is_outdated(&self, step: u64, journal: &Journal) -> bool {
        journal.count_by(step) != self.entries_listed
    }

    pub(super) fn select_next_push(&mut self) {
        self.list.filter_by(String::clear);
        self.list
            .select(NEXT_PUSH_HEADING, PushField::Size.label().0);
    }

    /// Returns the keys to set to nudge the listed value of this `key` `times` times.
    ///
    /// # Errors
    /// Returns an error if there is no such value or it cannot be nudged this way.
    pub(super) fn nudged(
        &self,
        key: &str,
        times: i32,
        scenario: &Scenario,
    ) -> Result<Table, String> {
        let listed = &self.list.values;
        let is_meant = |value: &&ListedValue| value.key.as_deref() == Some(key);
        let Some(value) = listed.iter().find(is_meant) else {
            let near = nearest(key, listed.iter().filter_map(|value| value.key.as_deref()));
            return Err(format!("{key} is not a value of this scenario: {near}"));
        };
        let nudged = value.nudged(times, &self.file, scenario);
        nudged.map_err(|reason| format!("{} {reason}", value.label))
    }

    /// Returns the value of `key` with its label and unit.
    ///
    /// A vector is given by the values that follow from it, such as |L| and the tilt of L. Returns the key alone if
    /// none of its values are listed.
    pub(super) fn in_words(&self, key: &str) -> String {
        let is_part = |own: &str| {
            own.strip_prefix(key)
                .is_some_and(|rest| rest.starts_with('.'))
        };
        let values = self.list.values.iter();
        let of_key = values.filter(|value| {
            let own = value.key.as_deref().unwrap_or_default();
            own == key || value.file_key().is_none() && is_part(own)
        });
        let words: Vec<_> = of_key
            .map(|value| format!("{} {} {}", value.label, value.text, value.unit))
            .collect();
        match &words[..] {
            [] => key.to_owned(),
            _ => words.join(", ").trim_end().to_owned(),
        }
    }

    /// Returns true if a nudge of `key` at `now` and the previous nudge are one edit.
    pub(super) fn coalesces_with_last_nudge(&self, key: &str, rerun: bool, now: Duration) -> bool {
        self.last_nudged.as_ref().is_some_and(|(last, reran, at)| {
            *last == key && *reran == rerun && now.saturating_sub(*at) < NUDGE_PAUSE
        })
    }

    pub(super) fn note_nudge(&mut self, key: &str, rerun: bool, now: Duration) {
        self.last_nudged = Some((key.to_owned(), rerun, now));
    }

    /// Records another action, so that the next nudge is a separate edit.
    pub(super) fn forget_nudge(&mut self) {
        self.last_nudged = None;
    }

    /// Moves the next push to a point that `scenario` has, if it must.
    pub(super) fn suit(&mut self, scenario: &Scenario) {
        self.next_push = self.next_push.clone().suited_to(scenario);
    }

    /// Returns the next push, changed by the values of `choice`. `time_step_s` is the time step in force, s.
    pub(super) fn chosen(
        &self,
        choice: &PushChoice,
        scenario: &Scenario,
        time_step_s: f64,
    ) -> Result<NextPush, String> {
        let mut push = self.next_push.clone();
        if let Some(point) = &choice.point {
            push = push.typed(PushField::Point, point, scenario, time_step_s)?;
        }
        match choice.force_N {
            None => {}
            Some(Force::Size(size)) => push.size_N = size,
            Some(Force::Vector(vector)) => {
                push.size_N = Vector3::from(vector).norm();
                push.toward = Toward::Along(vector);
            }
        }
        push.toward = choice.toward.unwrap_or(push.toward);
        push.from_s = choice.from_s.unwrap_or(push.from_s);
        push.for_s = choice.for_s.unwrap_or(push.for_s);
        push.checked()
    }

    /// Returns the command that nudges the selected value; `None` if no value is shown.
    pub(super) fn selected_nudged(
        &self,
        times: i32,
        scenario: &Scenario,
    ) -> Result<Option<Command>, String> {
        let Some(value) = self.list.selected().filter(|_| times != 0) else {
            return Ok(None);
        };
        Ok(match (&value.source, &value.key) {
            (ValueSource::NextPush(field), _) => {
                let next = self.next_push.nudged(*field, times, scenario)?;
                Some(Command::NextPush(PushChoice::field(*field, &next)))
            }
            (_, key) => key.clone().map(|key| Command::Nudge {
                key,
                times,
                rerun: true,
            }),
        })
    }

    /// Returns the command that sets the selected value to `text`, in a new run or from now on; `None` if it already
    /// has that value.
    pub(super) fn value_typed(
        &self,
        text: &str,
        from_now_on: bool,
        scenario: &Scenario,
        time_step_s: f64,
    ) -> Result<Option<Command>, String> {
        let Some(value) = self.list.selected() else {
            return Ok(None);
        };
        if let ValueSource::NextPush(field) = value.source {
            let next = self.next_push.typed(field, text, scenario, time_step_s)?;
            return Ok(Some(Command::NextPush(PushChoice::field(field, &next))));
        }
        let typed = value.typed(text, &self.file, scenario);
        let (set, is_new) = typed.map_err(|reason| format!("{} {reason}", value.label))?;
        let mut edits = scenario.file.edit.iter();
        let is_edited = edits.any(|edit| set.keys().any(|key| edit.set.contains_key(key)));
        Ok(if from_now_on {
            is_new.then_some(Command::Set(set))
        } else {
            (is_new || is_edited).then_some(Command::Rerun(set))
        })
    }
}

impl PushChoice {
    fn field(field: PushField, push: &NextPush) -> Self {
        let mut choice = Self::default();
        match field {
            PushField::Point => choice.point = Some(push.point.clone()),
            PushField::Size => choice.force_N = Some(Force::Size(push.size_N)),
            PushField::Toward => choice.toward = Some(push.toward),
            PushField::Length => {
                (choice.for_s, choice.from_s) = (Some(push.for_s), Some(push.from_s));
            }
        }
        choice
    }
}

/// Returns the sort key of a group in the list.
fn rank(group: &str) -> usize {
    let place = |of: &str| GROUP_ORDER.iter().position(|known| *known == of);
    let (before, offset) = match place(group) {
        Some(place) => (Some(place), 0),
        None if group.starts_with("push") => (place(NEXT_PUSH_HEADING), 1),
        None => (place("motion"), 1),
    };
    2 * before.unwrap_or(0) + offset
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::for_tests::scenario;
    use std::sync::Arc;

    fn listed() -> (Values, Arc<Scenario>) {
        let scenario = scenario();
        let run = LiveRun::new(Arc::clone(&scenario));
        let journal = Journal::new("method-2", &scenario);
        let mut values = Values::new(&scenario);
        values.list_again(&run, &journal);
        assert!(!values.is_outdated(0, &journal));
        (values, scenario)
    }

    #[test]
    fn missing_values_of_a_push_come_from_the_next_push() {
        let (values, scenario) = listed();
        let choice = PushChoice {
            force_N: Some(Force::Vector([3.0, 0.0, 4.0])),
            for_s: Some(0.5),
            ..PushChoice::default()
        };
        let push = values.chosen(&choice, &scenario, 0.1).unwrap();
        assert_eq!((push.size_N, push.for_s), (5.0, 0.5));
        assert_eq!(push.toward, Toward::Along([3.0, 0.0, 4.0]));
        assert_eq!(push.point, values.next_push.point);
        let nobody = PushChoice {
            point: Some("nobody".to_owned()),
            ..PushChoice::default()
        };
        assert!(values.chosen(&nobody, &scenario, 0.1).is_err());
    }

    #[test]
    fn a_typed_value_becomes_a_command_for_the_selection() {
        let (mut values, scenario) = listed();
        values.select_next_push();
        let command = values.value_typed("70", false, &scenario, 0.1).unwrap();
        let size = PushChoice {
            force_N: Some(Force::Size(70.0)),
            ..PushChoice::default()
        };
        assert_eq!(command, Some(Command::NextPush(size)));
        assert!(values.value_typed("hard", false, &scenario, 0.1).is_err());
    }
}
