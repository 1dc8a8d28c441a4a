//! The runs of a session with their journals, for undo and redo; the scenario as the user opened it, and how the present
//! run differs from it.

use crate::engine::journal::changed::Original;
use crate::engine::journal::history::{History, Reversal, RunRecord};
use crate::engine::journal::next_push::NextPush;
use crate::engine::journal::{Act, Journal};
use crate::engine::run::Clock;
use crate::engine::scenario::{Problems, Scenario};
use crate::lab::storage::session::SharedText;
use std::sync::Arc;
use toml::Table;

/// The history of the lab and the scenario as it was opened. It shows nothing and plays nothing: its methods return the
/// scenario that the run has afterwards.
pub struct Runs {
    history: History,
    /// The scenario that the words of the opened file were written for.
    original: Original,
    /// How the present run differs from that scenario, in words; `None` where it does not.
    changed_from_file: Option<String>,
    /// The history as the session keeps it; `None` where the history has changed since it was written.
    kept: Option<SharedText>,
    /// The pinned run that is kept with it.
    kept_reference: Option<Reference>,
    /// The depth of the history that undo does not go below: where the page of a lesson began.
    floor: Option<(usize, usize)>,
}

/// What a session keeps of a pinned run, to pin it again.
#[derive(Clone, Default)]
pub(super) struct Reference {
    /// The step up to which it was played; of no meaning for the present run.
    pub(super) step: u64,
    /// Its scenario; `None` where the present run is pinned.
    pub(super) run: Option<Arc<Scenario>>,
}

impl PartialEq for Reference {
    fn eq(&self, other: &Self) -> bool {
        let run = |of: &Self| of.run.as_ref().map(Arc::as_ptr);
        (self.step, run(self)) == (other.step, run(other))
    }
}

/// The direction in the history.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum HistoryDirection {
    Undo,
    Redo,
}

/// What an undo or a redo has changed, and the scenario of the present run afterwards.
pub(super) struct UndoResult {
    pub(super) what: Reversal,
    pub(super) scenario: Arc<Scenario>,
    /// Whether the run before was opened under the same name.
    pub(super) is_of_same_name: bool,
}

impl Runs {
    /// The history of a run of `scenario`, opened as `name`, to which nothing was done yet.
    pub(super) fn new(name: &str, scenario: &Arc<Scenario>) -> Self {
        Self::resumed(History::new(name, scenario), scenario)
    }

    /// A history from a session; the present run was opened from `file`.
    pub(super) fn resumed(history: History, file: &Arc<Scenario>) -> Self {
        Self {
            original: Original::of(&history.present().name, file),
            history,
            changed_from_file: None,
            kept: None,
            kept_reference: None,
            floor: None,
        }
    }

    /// The name under which the user opened the present run: a preset or a file.
    pub fn name(&self) -> &str {
        &self.present().name
    }

    pub fn present(&self) -> &RunRecord {
        self.history.present()
    }

    /// What was done to the present run.
    pub fn journal(&self) -> &Journal {
        &self.present().journal
    }

    /// How many runs and acts undo could take back, see [`History::depth`].
    pub fn depth(&self) -> (usize, usize) {
        self.history.depth()
    }

    /// Keeps undo from taking back what was done up to now, or lets it again.
    pub(super) fn set_floor(&mut self, is_here: bool) {
        self.floor = is_here.then(|| self.depth());
    }

    pub(super) fn is_at_floor(&self) -> bool {
        self.floor == Some(self.depth())
    }

    /// Whether more was done to the runs since undo was kept from taking back what there was.
    pub fn is_above_floor(&self) -> bool {
        self.floor.is_some_and(|floor| floor != self.depth())
    }

    /// How the present run differs from the scenario as it was opened, in words; `None` where it does not.
    pub fn changed_from_file(&self) -> Option<&str> {
        self.changed_from_file.as_deref()
    }

    /// Makes `file` the scenario as the user opened it.
    pub(super) fn set_file(&mut self, file: &Arc<Scenario>) {
        self.original = Original::of(self.name(), file);
    }

    /// `scenario`, the present run's, as it is to be written to a file: what its words say of another motion is marked.
    pub(super) fn marked(&self, scenario: &Arc<Scenario>) -> Arc<Scenario> {
        self.original.marked(scenario)
    }

    /// Describes how `scenario`, the present run's, differs from the scenario as it was opened.
    pub(super) fn compare_with_file(&mut self, scenario: &Scenario) {
        self.changed_from_file = self.original.difference(scenario);
    }

    /// The history as the session keeps it, with the pinned run; `written` writes them.
    pub(super) fn kept(
        &mut self,
        reference: Option<Reference>,
        written: fn(&History, Option<&Reference>) -> SharedText,
    ) -> SharedText {
        if self.kept_reference != reference {
            self.kept = None;
            self.kept_reference = reference;
        }
        let (history, reference) = (&self.history, self.kept_reference.as_ref());
        self.kept
            .get_or_insert_with(|| written(history, reference))
            .clone()
    }

    fn change(&mut self) -> &mut History {
        self.kept = None;
        &mut self.history
    }

    /// Records at which `step` the present run is left, and which push the user has prepared. To be called before any
    /// method that may leave the present run.
    pub(super) fn leave_at(&mut self, step: u64, next_push: &NextPush) {
        self.change().set_left_at(step, next_push);
    }

    /// Lets the present run end at `end_s`, s.
    pub(super) fn set_end(&mut self, end_s: f64) {
        self.change().set_end(end_s);
    }

    /// Leaves the present run and begins that of `scenario`, opened as `name`.
    pub(super) fn open(&mut self, name: &str, scenario: &Arc<Scenario>) {
        self.change().begin(name, scenario);
        self.original = Original::of(name, scenario);
    }

    /// Leaves the present run and begins that of `scenario`, which follows the advice about it.
    pub(super) fn begin_as_advised(&mut self, scenario: &Arc<Scenario>) {
        self.change().begin_as_advised(scenario);
    }

    /// Begins a new run: the present one with the values of `set`, to which it does `acts` at step 0. With `is_again` it
    /// replaces the present run, which began with another value of the same key. Returns the new run's scenario.
    ///
    /// # Errors
    /// Why a value or an act is refused; nothing has changed then.
    pub(super) fn begin_with(
        &mut self,
        set: &Table,
        acts: Vec<Act>,
        is_again: bool,
    ) -> Result<Arc<Scenario>, String> {
        let before = (!acts.is_empty()).then(|| self.history.clone());
        let history = self.change();
        let begun = history.begin_with(set, is_again);
        let mut begun_with = None;
        let begun = begun.and_then(|begun| {
            begun_with = Some(Arc::clone(&begun));
            let mut acts = acts.into_iter();
            acts.try_fold(begun, |_, act| history.act(0, act, false))
        });
        let scenario = self.or_back_to(before, begun)?;
        // An edit of the time step holds the seconds of the run, unless the number of steps was set with it.
        let ends = begun_with.filter(|begun| begun.steps == scenario.steps);
        let end_s = Clock::end_s(ends.as_ref().unwrap_or(&scenario));
        self.change().set_end(end_s);
        Ok(scenario)
    }

    /// Does `acts` at `step` of the present run as one act, all or none. With `is_again` they join the act before: one
    /// undo takes back both. `steps` is the length of the run until now. Returns the run's new scenario; `None` if there
    /// are no acts.
    ///
    /// # Errors
    /// Why an act is refused; nothing has changed then.
    pub(super) fn act(
        &mut self,
        step: u64,
        acts: Vec<Act>,
        is_again: bool,
        steps: u64,
    ) -> Result<Option<Arc<Scenario>>, String> {
        let before = (acts.len() > 1).then(|| self.history.clone());
        let history = self.change();
        let mut acts = acts.into_iter().enumerate();
        let done = acts.try_fold(None, |_, (index, act)| {
            history.act(step, act, is_again || index > 0).map(Some)
        });
        let Some(scenario) = self.or_back_to(before, done)? else {
            return Ok(None);
        };
        if scenario.steps != steps {
            self.change().set_end(Clock::end_s(&scenario));
        }
        Ok(Some(scenario))
    }

    /// What is `done`; where it was refused, the history is again as it was `before`.
    fn or_back_to<T>(
        &mut self,
        before: Option<History>,
        done: Result<T, Problems>,
    ) -> Result<T, String> {
        done.map_err(|problems| {
            if let Some(before) = before {
                *self.change() = before;
            }
            problems.in_one_line()
        })
    }

    /// Undoes the last act, or does it again; `steps` is the length of the present run until now. `None` where there is no
    /// such act.
    pub(super) fn turn(
        &mut self,
        way: HistoryDirection,
        steps: u64,
    ) -> Result<Option<UndoResult>, String> {
        let name = self.name().to_owned();
        let history = self.change();
        let turned = match way {
            HistoryDirection::Undo => history.undo(),
            HistoryDirection::Redo => history.redo(),
        };
        let Some(what) = turned else {
            return Ok(None);
        };
        let is_of_same_name = self.name() == name;
        let scenario = self.history.scenario();
        let scenario = scenario.map_err(|problems| problems.in_one_line())?;
        if what != Reversal::OtherRun && scenario.steps != steps {
            // Edits of the time step made after the number of steps was set have not moved the end: the end follows
            // from the scenario in which that number was set.
            let ends = self.journal().when_steps_were_set();
            let end_s = Clock::end_s(ends.as_ref().unwrap_or(&scenario));
            self.change().set_end(end_s);
        }
        if !is_of_same_name {
            self.original = Original::of(self.name(), &scenario);
        }
        Ok(Some(UndoResult {
            what,
            scenario,
            is_of_same_name,
        }))
    }

    /// The scenario of the run from step 0 to `step`, with all that was done up to there; `to` says what it is for.
    pub(super) fn run_up_to(&self, step: u64, to: &str) -> Result<Arc<Scenario>, String> {
        if step == 0 {
            return Err(format!(
                "there is nothing to {to} yet: the run stands at step 0"
            ));
        }
        let run = self.journal().scenario_until(step);
        run.map_err(|problems| problems.in_one_line())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::for_tests::scenario;
    use toml::Value;

    fn runs() -> Runs {
        Runs::new("method-2", &scenario())
    }

    fn time_step(value: f64) -> Act {
        Act::set("motion.time_step_s", Value::Float(value))
    }

    #[test]
    fn acts_are_done_all_or_none() {
        let mut runs = runs();
        let before = runs.journal().clone();
        let acts = vec![time_step(0.05), time_step(-1.0)];
        assert!(runs.act(40, acts, false, 2300).is_err());
        assert_eq!(runs.journal(), &before);
        let acts = vec![
            time_step(0.05),
            Act::set("motion.gravity_m_per_s2", Value::Float(5.0)),
        ];
        assert!(runs.act(40, acts, false, 2300).unwrap().is_some());
        assert!(runs.turn(HistoryDirection::Undo, 2300).unwrap().is_some());
        assert_eq!(runs.journal().file(), before.file());
        assert!(runs.turn(HistoryDirection::Undo, 2300).unwrap().is_none());
        assert!(runs.act(40, Vec::new(), false, 2300).unwrap().is_none());
    }

    fn kept(runs: &mut Runs) -> SharedText {
        runs.kept(None, crate::lab::session::written)
    }

    #[test]
    fn the_kept_text_follows_every_change() {
        let mut runs = runs();
        let first = kept(&mut runs);
        assert_eq!(**first, **kept(&mut runs));
        runs.act(40, vec![time_step(0.05)], false, 2300).unwrap();
        let second = kept(&mut runs);
        assert_ne!(**first, **second);
        runs.turn(HistoryDirection::Undo, 2300).unwrap();
        assert_ne!(**second, **kept(&mut runs));
    }

    #[test]
    fn step_0_is_no_run_to_write() {
        let runs = runs();
        let refused = runs.run_up_to(0, "export").unwrap_err();
        assert!(refused.starts_with("there is nothing to export yet"));
        assert_eq!(runs.run_up_to(7, "export").unwrap().steps, 7);
    }
}
