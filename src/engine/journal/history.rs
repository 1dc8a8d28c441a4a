//! The runs of a session, in order. An edit of the body or of the start, and the opening of another file, begin a new
//! run; undo returns to the run before it.

use super::next_push::NextPush;
use super::{Act, Journal};
use crate::run::Clock;
use crate::scenario::{Problems, Scenario};
use serde::{Deserialize, Serialize};
use std::sync::Arc;
use toml::Table;

const MOST_RUNS: usize = 200;
/// The most points and parts that the bodies of the earlier runs have together; it limits the memory.
const MOST_HISTORY_POINTS: usize = 200_000;

/// One run of the history: its name, its journal, and the step at which the user left it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RunRecord {
    /// The name under which the user opened the scenario: a preset or a file.
    pub name: String,
    pub left_at: u64,
    /// Time at which the run ends, s. An edit of the time step changes the number of steps, not this time.
    pub end_s: f64,
    /// The push that the user had prepared when they left the run.
    pub next_push: Option<NextPush>,
    /// Whether the run follows the advice about the one before. The edits that it has from that one cannot be undone
    /// one by one in it.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub is_advised: bool,
    pub journal: Journal,
}

/// All runs of a session, with those that were undone.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct History {
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    past: Vec<RunRecord>,
    present: RunRecord,
    /// Undone runs, the one undone last at the end: redo takes it first.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    undone: Vec<RunRecord>,
}

#[derive(Clone, Debug, PartialEq)]
pub enum Reversal {
    /// The present run has changed after `step`; up to there it is the same.
    SameRun {
        step: u64,
        act: Act,
    },
    OtherRun,
}

impl History {
    /// A history whose only run is that of `scenario`, opened as `name`.
    pub fn new(name: &str, scenario: &Arc<Scenario>) -> Self {
        Self {
            past: Vec::new(),
            present: RunRecord::new(name, scenario),
            undone: Vec::new(),
        }
    }

    pub fn scenario(&self) -> Result<Arc<Scenario>, Problems> {
        self.present.journal.scenario()
    }

    pub fn present(&self) -> &RunRecord {
        &self.present
    }

    /// How many earlier runs there are, and how many acts the present one has: undo lessens it.
    pub fn depth(&self) -> (usize, usize) {
        (self.past.len(), self.present.journal.acts())
    }

    /// Records where the present run stands and which push the user has prepared; to be called before it is left.
    pub fn set_left_at(&mut self, step: u64, next_push: &NextPush) {
        self.present.left_at = step;
        self.present.next_push = Some(next_push.clone());
    }

    /// Leaves the present run and begins that of `scenario`, opened as `name`.
    pub fn begin(&mut self, name: &str, scenario: &Arc<Scenario>) {
        self.begin_run(RunRecord::new(name, scenario));
    }

    /// Leaves the present run and begins that of `scenario`, which follows the advice about it: one undo returns to the
    /// present run, whatever edits the new one has from it.
    pub fn begin_as_advised(&mut self, scenario: &Arc<Scenario>) {
        let name = self.present.name.clone();
        self.begin(&name, scenario);
        self.present.is_advised = true;
    }

    fn begin_run(&mut self, next: RunRecord) {
        self.present.journal.forget_undone(); // a new run is a new act: nothing can be redone after it
        self.past.push(std::mem::replace(&mut self.present, next));
        self.undone.clear();
        self.drop_oldest();
    }

    /// Drops the oldest runs beyond [`MOST_RUNS`] and [`MOST_HISTORY_POINTS`]; the newest earlier run always stays.
    fn drop_oldest(&mut self) {
        let mut points = 0;
        let newest = self.past.iter().rev().take_while(|run| {
            let body = &run.journal.base().body;
            points += body.point.len() + body.part.len();
            points <= MOST_HISTORY_POINTS
        });
        let kept = newest.count().clamp(1, MOST_RUNS);
        self.past.drain(..self.past.len().saturating_sub(kept));
    }

    /// Does `act` at `step` of the present run and returns the run's new scenario. With `is_again` it is one more nudge of
    /// the same value: one undo takes back all nudges of the chain. A refused act leaves the history unchanged.
    pub fn act(&mut self, step: u64, act: Act, is_again: bool) -> Result<Arc<Scenario>, Problems> {
        let scenario = self.present.journal.act(step, act, is_again)?;
        self.undone.clear();
        Ok(scenario)
    }

    /// Begins a new run: the present one as it moves where it was left, with the values of `set`; see
    /// [`Journal::begun_with`]. With `is_again`, one more nudge of the value that began the present run, it replaces the
    /// present run: one undo then returns to the run before both. Refused values leave the history unchanged.
    pub fn begin_with(&mut self, set: &Table, is_again: bool) -> Result<Arc<Scenario>, Problems> {
        let replaced = self.past.last().filter(|_| is_again);
        let left = replaced.unwrap_or(&self.present);
        let scenario = left.journal.begun_with(left.left_at, set)?;
        let record = RunRecord::new(&left.name, &scenario);
        if replaced.is_some() {
            self.present = record;
            self.undone.clear();
        } else {
            self.begin_run(record);
        }
        Ok(scenario)
    }

    /// Sets the time at which the present run ends, s.
    pub fn set_end(&mut self, end_s: f64) {
        self.present.end_s = end_s;
    }

    /// Undoes the last act of the present run; where it has none, returns to the run before. `None` where there is none.
    pub fn undo(&mut self) -> Option<Reversal> {
        let is_as_advised = self.present.is_advised && self.present.journal.is_as_opened();
        if !is_as_advised && let Some((step, act)) = self.present.journal.undo() {
            return Some(Reversal::SameRun { step, act });
        }
        self.exchange(|history| (&mut history.past, &mut history.undone))
    }

    /// Does again what was undone last. `None` where nothing is undone.
    pub fn redo(&mut self) -> Option<Reversal> {
        if let Some((step, act)) = self.present.journal.redo() {
            return Some(Reversal::SameRun { step, act });
        }
        self.exchange(|history| (&mut history.undone, &mut history.past))
    }

    /// Takes the present run from the top of the first of the two `stacks`, and puts the old one on the second.
    fn exchange(
        &mut self,
        stacks: impl Fn(&mut Self) -> (&mut Vec<RunRecord>, &mut Vec<RunRecord>),
    ) -> Option<Reversal> {
        let next = stacks(self).0.pop()?;
        let left = std::mem::replace(&mut self.present, next);
        stacks(self).1.push(left);
        Some(Reversal::OtherRun)
    }
}

impl RunRecord {
    fn new(name: &str, scenario: &Scenario) -> Self {
        Self {
            name: name.to_owned(),
            left_at: 0,
            end_s: Clock::end_s(scenario),
            next_push: None,
            is_advised: false,
            journal: Journal::of(scenario.file.clone()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::Document;

    fn opened(name: &str) -> Arc<Scenario> {
        Arc::new(Document::open(name).unwrap().scenario().unwrap())
    }

    fn method_2() -> History {
        History::new("method-2", &opened("method-2"))
    }

    fn leave(history: &mut History, step: u64) {
        history.set_left_at(step, &NextPush::of(&opened("method-2")));
    }

    fn begin_with_tilt(history: &mut History, left_at: u64, tilt_deg: f64, is_again: bool) {
        leave(history, left_at);
        let set = Table::from_iter([("start.tilt_deg".to_owned(), tilt_deg.into())]);
        history.begin_with(&set, is_again).unwrap();
    }

    fn set(history: &mut History, step: u64, key: &str, value: f64) -> Arc<Scenario> {
        let act = Act::set(key, value.into());
        history.act(step, act, false).unwrap()
    }

    fn time_step(history: &History) -> f64 {
        let scenario = history.present().journal.scenario().unwrap();
        let edit = scenario.edits.last();
        edit.map_or(scenario.motion, |edit| edit.motion).time_step_s
    }

    /// The step at which the present run was left, and its start tilt.
    fn place(history: &History) -> (u64, Option<f64>) {
        let run = history.present();
        (run.left_at, run.journal.file().start.tilt_deg)
    }

    /// Takes an edit of the same run back, and gives its step; `None` for a whole run taken back.
    fn undone(history: &mut History) -> Option<u64> {
        match history.undo().unwrap() {
            Reversal::SameRun { step, .. } => Some(step),
            Reversal::OtherRun => None,
        }
    }

    #[test]
    fn undo_and_redo_go_through_all_acts_and_runs_in_order() {
        let mut history = method_2();
        set(&mut history, 40, "motion.time_step_s", 0.05);
        begin_with_tilt(&mut history, 90, 30.0, false);
        set(&mut history, 7, "motion.time_step_s", 0.02);
        leave(&mut history, 9);
        history.begin("cusps", &opened("cusps"));
        assert_eq!(undone(&mut history), None);
        assert_eq!(place(&history), (9, Some(30.0)));
        assert_eq!(undone(&mut history), Some(7));
        // The new run moves as the old one did when it was left.
        assert_eq!(time_step(&history), 0.05);
        assert_eq!(undone(&mut history), None);
        assert_eq!(place(&history), (90, Some(45.0)));
        assert_eq!(undone(&mut history), Some(40));
        assert_eq!(history.undo(), None);
        for _ in 0..4 {
            assert!(history.redo().is_some());
        }
        assert_eq!(history.redo(), None);
        assert_eq!(history.present().name, "cusps");
    }

    #[test]
    fn undo_takes_the_advice_back_before_the_edits_that_it_kept() {
        let mut history = method_2();
        let edited = set(&mut history, 40, "motion.gravity_m_per_s2", 5.0);
        leave(&mut history, 90);
        history.begin_as_advised(&edited);
        set(&mut history, 7, "motion.time_step_s", 0.02);
        assert_eq!(undone(&mut history), Some(7));
        assert_eq!(undone(&mut history), None);
        assert_eq!(history.present().left_at, 90);
        assert_eq!(undone(&mut history), Some(40));
        for _ in 0..3 {
            assert!(history.redo().is_some());
        }
        assert!(history.present().is_advised && time_step(&history) == 0.02);
    }

    #[test]
    fn a_new_act_leaves_nothing_to_redo() {
        let mut history = method_2();
        begin_with_tilt(&mut history, 90, 30.0, false);
        history.undo();
        set(&mut history, 5, "motion.gravity_m_per_s2", 1.0);
        assert_eq!(history.redo(), None);
    }

    #[test]
    fn nudging_a_run_again_replaces_it() {
        let mut history = method_2();
        begin_with_tilt(&mut history, 90, 30.0, false);
        begin_with_tilt(&mut history, 5, 31.0, true);
        begin_with_tilt(&mut history, 5, 32.0, true);
        assert_eq!(place(&history).1, Some(32.0));
        assert_eq!(undone(&mut history), None);
        assert_eq!(place(&history), (90, Some(45.0)));
        assert_eq!(history.undo(), None);
    }

    #[test]
    fn few_runs_with_large_bodies_are_kept_and_small_ones_stay_behind_a_large_one() {
        let points = |count: usize| {
            let scenario = opened("method-2");
            let mut file = scenario.file.clone();
            let top = file.body.point[0].clone();
            file.body.point = vec![top; count];
            Arc::new(Scenario {
                file,
                ..(*scenario).clone()
            })
        };
        let mut history = method_2();
        for count in [10, 10, MOST_HISTORY_POINTS - 20, 1] {
            history.begin("x", &points(count));
        }
        assert_eq!(history.past.len(), 3, "method-2 went");
        history.begin("x", &points(1));
        assert_eq!(history.past.len(), 3, "the first with ten points went");
    }
}
