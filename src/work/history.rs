//! The runs one after the other: an edit of the body, or another file, begins a new one, and the old one is one undo away.

use super::journal::{Act, Journal};
use super::next_push::NextPush;
use crate::run::Clock;
use crate::scenario::{Problems, Scenario};
use serde::{Deserialize, Serialize};
use toml::Table;

/// Runs that can be gone back to, and for large bodies as many as have so many points together.
const MOST_RUNS: usize = 200;
const MOST_POINTS: usize = 200_000;

/// One run: where it came from, its journal, and where it was left.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Chapter {
    /// SCENARIO as it was opened.
    pub name: String,
    /// The step it was left at.
    pub left_at: u64,
    /// When it is over, s: an edit of the time step changes how many steps that is.
    pub end_s: f64,
    /// The push that was to come when it was left.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub next_push: Option<NextPush>,
    /// What it is.
    pub journal: Journal,
}

/// The runs so far, and those that were taken back.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct History {
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    past: Vec<Chapter>,
    present: Chapter,
    /// The next one to be brought again last.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    undone: Vec<Chapter>,
}

/// What taking back, or bringing again, has led to.
#[derive(Clone, Debug, PartialEq)]
pub enum Turn {
    /// Another journal of the same run: the same up to `step`.
    Here {
        /// The step at which it was done.
        step: u64,
        /// What was taken back or brought again.
        act: Act,
    },
    /// Another run.
    Elsewhere,
}

impl History {
    /// Begins with the run of `scenario`, opened as `name`.
    pub fn new(name: &str, scenario: &Scenario) -> Self {
        Self {
            past: Vec::new(),
            present: Chapter::new(name, Journal::of(scenario.file.clone()), scenario),
            undone: Vec::new(),
        }
    }

    /// Whether every run in it can be gone to: nothing is wrong with any, unless it was changed by hand.
    ///
    /// # Errors
    /// What is wrong with the first that cannot.
    pub fn check(&self) -> Result<(), Problems> {
        let runs = self.past.iter().chain(&self.undone);
        runs.map(|chapter| &chapter.journal)
            .try_for_each(|journal| journal.scenario().map(drop))
    }

    /// The present run.
    pub fn present(&self) -> &Chapter {
        &self.present
    }

    /// Says where the present run stands, and which push is to come: it may be left.
    pub fn stands(&mut self, step: u64, next_push: &NextPush) {
        self.present.left_at = step;
        self.present.next_push = Some(next_push.clone());
    }

    /// Leaves the present run and begins that of `scenario`, opened as `name`.
    pub fn begin(&mut self, name: &str, scenario: &Scenario) {
        let journal = Journal::of(scenario.file.clone());
        self.begin_chapter(Chapter::new(name, journal, scenario));
    }

    fn begin_chapter(&mut self, next: Chapter) {
        self.present.journal.forget_undone(); // something new was done: this
        self.past.push(std::mem::replace(&mut self.present, next));
        self.undone.clear();
        self.forget_the_oldest();
    }

    fn forget_the_oldest(&mut self) {
        let points = |chapter: &Chapter| chapter.journal.base().body.point.len();
        let mut room = MOST_POINTS;
        let affordable = self
            .past
            .iter()
            .rev()
            .take(MOST_RUNS)
            .take_while(|chapter| {
                let needed = points(chapter);
                let fits = needed <= room;
                room = room.saturating_sub(needed);
                fits
            });
        let kept = affordable.count().max(1).min(self.past.len());
        self.past.drain(..self.past.len() - kept);
    }

    /// Does `act` at `step` of the present run; gives what the run is then.
    ///
    /// # Errors
    /// Why it cannot be done; nothing has changed then.
    pub fn act(&mut self, step: u64, act: Act) -> Result<Scenario, Problems> {
        let scenario = self.present.journal.act(step, act)?;
        self.undone.clear();
        Ok(scenario)
    }

    /// The same as one more nudge, which is taken back together with those before.
    ///
    /// # Errors
    /// Why it cannot be done; nothing has changed then.
    pub fn act_again(&mut self, step: u64, act: Act) -> Result<Scenario, Problems> {
        let scenario = self.present.journal.act_again(step, act)?;
        self.undone.clear();
        Ok(scenario)
    }

    /// Begins a new run with the values of `set`, as [`Journal::begun_with`] has it.
    ///
    /// # Errors
    /// Why it cannot begin so; nothing has changed then.
    pub fn begin_with(&mut self, set: &Table) -> Result<Scenario, Problems> {
        let left = &self.present;
        let (journal, scenario) = left.journal.begun_with(left.left_at, set)?;
        self.begin_chapter(Chapter::new(&left.name, journal, &scenario));
        Ok(scenario)
    }

    /// Begins the present run once more with other values of the keys that it was begun with, in its place.
    ///
    /// # Errors
    /// Why it cannot begin so; nothing has changed then.
    pub fn begin_again_with(&mut self, set: &Table) -> Result<Scenario, Problems> {
        let Some(left) = self.past.last() else {
            return self.begin_with(set);
        };
        let (journal, scenario) = left.journal.begun_with(left.left_at, set)?;
        self.present = Chapter::new(&left.name, journal, &scenario);
        self.undone.clear();
        Ok(scenario)
    }

    /// Says that the present run is now over at `end_s` (s).
    pub fn set_end(&mut self, end_s: f64) {
        self.present.end_s = end_s;
    }

    /// Takes the last thing back: what was done in the present run, or else the run itself.
    pub fn undo(&mut self) -> Option<Turn> {
        if let Some((step, act)) = self.present.journal.undo() {
            return Some(Turn::Here { step, act });
        }
        self.turn(|history| (&mut history.past, &mut history.undone))
    }

    /// Brings again what was taken back last.
    pub fn redo(&mut self) -> Option<Turn> {
        if let Some((step, act)) = self.present.journal.redo() {
            return Some(Turn::Here { step, act });
        }
        self.turn(|history| (&mut history.undone, &mut history.past))
    }

    /// Another run in the place of the present one.
    fn turn(
        &mut self,
        stacks: impl Fn(&mut Self) -> (&mut Vec<Chapter>, &mut Vec<Chapter>),
    ) -> Option<Turn> {
        let next = stacks(self).0.pop()?;
        let left = std::mem::replace(&mut self.present, next);
        stacks(self).1.push(left);
        Some(Turn::Elsewhere)
    }
}

impl Chapter {
    fn new(name: &str, journal: Journal, scenario: &Scenario) -> Self {
        Self {
            name: name.to_owned(),
            left_at: 0,
            end_s: Clock::end_s(scenario),
            next_push: None,
            journal,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::Document;
    use toml::Value;

    fn one(key: &str, value: f64) -> Table {
        Table::from_iter([(key.to_owned(), Value::Float(value))])
    }

    fn opened(name: &str) -> Scenario {
        Document::open(name).unwrap().scenario().unwrap()
    }

    fn leave(history: &mut History, step: u64) {
        history.stands(step, &NextPush::of(&opened("method-2")));
    }

    fn begin_with_tilt(history: &mut History, step: u64, tilt_deg: f64) {
        leave(history, step);
        history
            .begin_with(&one("start.tilt_deg", tilt_deg))
            .unwrap();
    }

    fn time_step(history: &History) -> f64 {
        let scenario = history.present().journal.scenario().unwrap();
        scenario
            .edits
            .last()
            .map_or(scenario.motion.time_step_s, |edit| edit.motion.time_step_s)
    }

    fn tilt(history: &History) -> Option<f64> {
        history.present().journal.file().start.tilt_deg
    }

    #[test]
    fn everything_is_taken_back_and_brought_again_in_order() {
        let mut history = History::new("method-2", &opened("method-2"));
        history
            .act(40, Act::set("motion.time_step_s", Value::Float(0.05)))
            .unwrap();
        begin_with_tilt(&mut history, 90, 30.0);
        history
            .act(7, Act::set("motion.time_step_s", Value::Float(0.02)))
            .unwrap();
        leave(&mut history, 9);
        history.begin("cusps", &opened("cusps"));
        assert_eq!(history.undo(), Some(Turn::Elsewhere));
        assert_eq!((history.present().left_at, tilt(&history)), (9, Some(30.0)));
        let Some(Turn::Here { step: 7, .. }) = history.undo() else {
            panic!()
        };
        assert_eq!(
            time_step(&history),
            0.05,
            "the new run moves as the old one did when it was left"
        );
        assert_eq!(history.undo(), Some(Turn::Elsewhere));
        assert_eq!(
            (history.present().left_at, tilt(&history)),
            (90, Some(45.0))
        );
        let Some(Turn::Here { step: 40, .. }) = history.undo() else {
            panic!()
        };
        assert_eq!(history.undo(), None);
        for _ in 0..4 {
            assert!(history.redo().is_some());
        }
        assert_eq!(history.redo(), None);
        assert_eq!(history.present().name, "cusps");
    }

    #[test]
    fn what_is_done_anew_cannot_be_redone() {
        let mut history = History::new("method-2", &opened("method-2"));
        begin_with_tilt(&mut history, 90, 30.0);
        history.undo();
        history
            .act(5, Act::set("motion.gravity_m_per_s2", Value::Float(1.0)))
            .unwrap();
        assert_eq!(history.redo(), None);
    }

    #[test]
    fn a_run_that_is_nudged_again_is_one_run() {
        let mut history = History::new("method-2", &opened("method-2"));
        begin_with_tilt(&mut history, 90, 30.0);
        for tilt_deg in [31.0, 32.0] {
            leave(&mut history, 5);
            history
                .begin_again_with(&one("start.tilt_deg", tilt_deg))
                .unwrap();
        }
        assert_eq!(tilt(&history), Some(32.0));
        assert_eq!(history.undo(), Some(Turn::Elsewhere));
        assert_eq!(
            (history.present().left_at, tilt(&history)),
            (90, Some(45.0))
        );
        assert_eq!(history.undo(), None);
    }

    #[test]
    fn a_new_run_is_brought_again_before_what_was_undone_earlier() {
        let mut history = History::new("method-2", &opened("method-2"));
        history
            .act(40, Act::set("motion.time_step_s", Value::Float(0.05)))
            .unwrap();
        history.undo();
        begin_with_tilt(&mut history, 90, 30.0);
        history.undo();
        assert_eq!(history.redo(), Some(Turn::Elsewhere));
        assert_eq!(tilt(&history), Some(30.0));
    }

    #[test]
    fn a_refused_edit_changes_nothing() {
        let mut history = History::new("method-2", &opened("method-2"));
        let before = history.clone();
        history
            .act(5, Act::set("motion.time_step_s", Value::Float(-1.0)))
            .unwrap_err();
        history
            .begin_with(&one("body.rim.radius_m", -1.0))
            .unwrap_err();
        history
            .act(5, Act::set("motion.steps", Value::Integer(0)))
            .unwrap_err();
        assert_eq!(history, before);
    }
}
