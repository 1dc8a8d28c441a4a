//! The runs one after the other: an edit of the body, or another file, begins a new one, and the old one is one undo away.

use crate::scenario::journal::{Act, Journal};
use crate::scenario::{Problems, Scenario};
use serde::{Deserialize, Serialize};
use toml::Value;

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
    /// Begins with the run in `journal`, opened as `name`.
    pub fn new(name: &str, journal: Journal) -> Self {
        Self {
            past: Vec::new(),
            present: Chapter {
                name: name.to_owned(),
                left_at: 0,
                journal,
            },
            undone: Vec::new(),
        }
    }

    /// The present run.
    pub fn present(&self) -> &Chapter {
        &self.present
    }

    /// Leaves the present run at the step `left_at` and begins another.
    pub fn begin(&mut self, left_at: u64, name: &str, journal: Journal) {
        self.present.left_at = left_at;
        self.present.journal.forget_undone(); // something new was done: this
        let next = Self::new(name, journal).present;
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

    /// Begins a new run with `value` at `key`, as [`Journal::begun_with`] has it.
    ///
    /// # Errors
    /// Why it cannot begin so; nothing has changed then.
    pub fn begin_with(&mut self, step: u64, key: &str, value: Value) -> Result<Scenario, Problems> {
        let (journal, scenario) = self.present.journal.begun_with(step, key, value)?;
        let name = self.present.name.clone();
        self.begin(step, &name, journal);
        Ok(scenario)
    }

    /// Takes the last thing back: what was done in the present run, or else the run itself, which stands at `step`.
    pub fn undo(&mut self, step: u64) -> Option<Turn> {
        if let Some(entry) = self.present.journal.undo() {
            return Some(Turn::Here {
                step: entry.step,
                act: entry.act.clone(),
            });
        }
        self.turn(step, |history| (&mut history.past, &mut history.undone))
    }

    /// Brings again what was taken back last; the present run stands at `step`.
    pub fn redo(&mut self, step: u64) -> Option<Turn> {
        if let Some(entry) = self.present.journal.redo() {
            return Some(Turn::Here {
                step: entry.step,
                act: entry.act.clone(),
            });
        }
        self.turn(step, |history| (&mut history.undone, &mut history.past))
    }

    /// Another run in the place of the present one.
    fn turn(
        &mut self,
        left_at: u64,
        stacks: impl Fn(&mut Self) -> (&mut Vec<Chapter>, &mut Vec<Chapter>),
    ) -> Option<Turn> {
        let next = stacks(self).0.pop()?;
        self.present.left_at = left_at;
        let left = std::mem::replace(&mut self.present, next);
        stacks(self).1.push(left);
        Some(Turn::Elsewhere)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::Document;

    fn opened(name: &str) -> Journal {
        Journal::of(Document::open(name).unwrap().scenario().unwrap().file)
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
        let mut history = History::new("method-2", opened("method-2"));
        history
            .act(40, Act::set("motion.time_step_s", Value::Float(0.05)))
            .unwrap();
        history
            .begin_with(90, "start.tilt_deg", Value::Float(30.0))
            .unwrap();
        history
            .act(7, Act::set("motion.time_step_s", Value::Float(0.02)))
            .unwrap();
        history.begin(9, "cusps", opened("cusps"));
        assert_eq!(history.undo(3), Some(Turn::Elsewhere));
        assert_eq!((history.present().left_at, tilt(&history)), (9, Some(30.0)));
        let Some(Turn::Here { step: 7, .. }) = history.undo(9) else {
            panic!()
        };
        assert_eq!(
            time_step(&history),
            0.05,
            "the new run moves as the old one did when it was left"
        );
        assert_eq!(history.undo(9), Some(Turn::Elsewhere));
        assert_eq!(
            (history.present().left_at, tilt(&history)),
            (90, Some(45.0))
        );
        let Some(Turn::Here { step: 40, .. }) = history.undo(90) else {
            panic!()
        };
        assert_eq!(history.undo(40), None);
        for _ in 0..4 {
            assert!(history.redo(1).is_some());
        }
        assert_eq!(history.redo(1), None);
        assert_eq!(history.present().name, "cusps");
    }

    #[test]
    fn what_is_done_anew_cannot_be_redone() {
        let mut history = History::new("method-2", opened("method-2"));
        history
            .begin_with(90, "start.tilt_deg", Value::Float(30.0))
            .unwrap();
        history.undo(0);
        history
            .act(5, Act::set("motion.gravity_m_per_s2", Value::Float(1.0)))
            .unwrap();
        assert_eq!(history.redo(5), None);
    }

    #[test]
    fn a_new_run_is_brought_again_before_what_was_undone_earlier() {
        let mut history = History::new("method-2", opened("method-2"));
        history
            .act(40, Act::set("motion.time_step_s", Value::Float(0.05)))
            .unwrap();
        history.undo(40);
        history
            .begin_with(90, "start.tilt_deg", Value::Float(30.0))
            .unwrap();
        history.undo(5);
        assert_eq!(history.redo(90), Some(Turn::Elsewhere));
        assert_eq!(tilt(&history), Some(30.0));
    }

    #[test]
    fn a_refused_edit_changes_nothing() {
        let mut history = History::new("method-2", opened("method-2"));
        let before = history.clone();
        history
            .act(5, Act::set("motion.time_step_s", Value::Float(-1.0)))
            .unwrap_err();
        history
            .begin_with(5, "body.rim.radius_m", Value::Float(-1.0))
            .unwrap_err();
        history
            .act(5, Act::set("motion.steps", Value::Integer(0)))
            .unwrap_err();
        assert_eq!(history, before);
    }
}
