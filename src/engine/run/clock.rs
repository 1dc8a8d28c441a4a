//! The time of each step, and the same run at another time step.

use crate::physics::SchemeInfo;
use crate::scenario::{Edit, Scenario};

/// Time as a function of the step: t = t_a + (step − a) dt, where a is the step of the last edit of dt. A running sum
/// would accumulate rounding errors over the run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clock {
    anchor_step: u64,
    anchor_s: f64,
    pub time_step_s: f64,
}

impl Clock {
    /// Returns a clock that is at 0 s at step 0.
    pub fn new(time_step_s: f64) -> Self {
        Self {
            anchor_step: 0,
            anchor_s: 0.0,
            time_step_s,
        }
    }

    /// Returns the clock in force at `step` of `scenario`, before the edits made at that step.
    pub fn at(scenario: &Scenario, step: u64) -> Self {
        let mut clock = Self::new(scenario.motion.time_step_s);
        let edits = scenario.edits.iter().take_while(|edit| edit.step < step);
        edits
            .filter(|edit| edit.sets_time_step)
            .for_each(|edit| clock.change(edit.step, edit.motion.time_step_s));
        clock
    }

    pub fn edits(scenario: &Scenario) -> impl Iterator<Item = (f64, &Edit)> {
        let mut clock = Self::new(scenario.motion.time_step_s);
        scenario.edits.iter().map(move |edit| {
            let time_s = clock.time_s(edit.step);
            if edit.sets_time_step {
                clock.change(edit.step, edit.motion.time_step_s);
            }
            (time_s, edit)
        })
    }

    /// Returns the time at which the run of `scenario` ends, s.
    pub fn end_s(scenario: &Scenario) -> f64 {
        Self::at(scenario, scenario.steps).time_s(scenario.steps)
    }

    /// Returns the time at `step`, s. The step must not be before the last edit of dt.
    pub fn time_s(&self, step: u64) -> f64 {
        // Converted as i64, because processors have no instruction for u64.
        self.anchor_s + (step - self.anchor_step) as i64 as f64 * self.time_step_s
    }

    pub fn change(&mut self, step: u64, time_step_s: f64) {
        *self = Self {
            anchor_step: step,
            anchor_s: self.time_s(step),
            time_step_s,
        };
    }

    /// Returns the first step at or after `time_s`, to within a billionth of a time step.
    pub fn step_at(&self, time_s: f64) -> u64 {
        let steps = ((time_s - self.anchor_s) / self.time_step_s - 1e-9).ceil();
        self.anchor_step.saturating_add(steps.max(0.0) as u64)
    }
}

/// Returns the same run with the time step `time_step_s` (s) and `scheme` throughout. The run is as long in seconds,
/// with its pushes and its edits of gravity at the same times. It has no edits of time step and scheme.
pub fn resampled(scenario: &Scenario, time_step_s: f64, scheme: &'static SchemeInfo) -> Scenario {
    let mut other = scenario.clone();
    for (edit, (time_s, _)) in other.edits.iter_mut().zip(Clock::edits(scenario)) {
        edit.step = (time_s / time_step_s).round() as u64;
        (edit.motion.time_step_s, edit.motion.scheme) = (time_step_s, scheme);
        edit.sets_time_step = false;
    }
    other.steps = ((Clock::end_s(scenario) / time_step_s).round() as u64).max(1);
    (other.motion.time_step_s, other.motion.scheme) = (time_step_s, scheme);
    other
}
