//! The same run at another time step, by another scheme: what was counted in steps keeps its seconds.

use super::Clock;
use crate::physics::SchemeInfo;
use crate::scenario::Scenario;

/// `scenario` at `time_step_s` (s) and by `scheme` throughout: as long in seconds, its pushes and its edits of gravity
/// at the same times. Edits of the time step and of the scheme are left out, since both are given here.
pub fn resampled(scenario: &Scenario, time_step_s: f64, scheme: &'static SchemeInfo) -> Scenario {
    let mut other = scenario.clone();
    for (edit, (time_s, _)) in other.edits.iter_mut().zip(Clock::edits(scenario)) {
        edit.step = (time_s / time_step_s).round() as u64;
        (edit.motion.time_step_s, edit.motion.scheme) = (time_step_s, scheme);
        edit.touches.time_step = false;
    }
    other.steps = ((Clock::end_s(scenario) / time_step_s).round() as u64).max(1);
    (other.motion.time_step_s, other.motion.scheme) = (time_step_s, scheme);
    other
}
