//! The same run at another time step, by another scheme: what was counted in steps keeps its seconds.

use super::Clock;
use crate::physics::SchemeInfo;
use crate::scenario::{Scenario, Touches};

/// `scenario` at `time_step_s` (s) and by `scheme` throughout: as long in seconds, its pushes and its edits of gravity
/// at the same times. Edits of the time step and of the scheme are left out, since both are given here.
pub fn resampled(scenario: &Scenario, time_step_s: f64, scheme: &'static SchemeInfo) -> Scenario {
    let mut other = scenario.clone();
    let mut clock = Clock::new(scenario.motion.time_step_s);
    let steps = |time_s: f64| ((time_s / time_step_s).round() as u64).max(1);
    for edit in &mut other.edits {
        let time_s = clock.time_s(edit.step);
        if edit.touches.time_step {
            clock.change(edit.step, edit.motion.time_step_s);
        }
        edit.step = (time_s / time_step_s).round() as u64;
        (edit.motion.time_step_s, edit.motion.scheme) = (time_step_s, scheme);
        edit.touches = Touches {
            time_step: false,
            ..edit.touches
        };
    }
    let clock_at_end = Clock::at(scenario, scenario.steps);
    other.steps = steps(clock_at_end.time_s(scenario.steps));
    (other.motion.time_step_s, other.motion.scheme) = (time_step_s, scheme);
    other
}
