//! How a time step is taken: what every scheme must do.

use super::{Loads, State, workings::Phase};
use std::fmt::Debug;

/// A way to take the body one time step further. [`SchemeInfo::make`](super::SchemeInfo::make) makes one.
///
/// Its [order](super::SchemeInfo::order) says how fast its error falls with dt. The orientation stays a rotation to rounding,
/// and under vertical forces without friction L_z keeps every bit (`exact`: all but rounding).
///
/// Orientation, L and t are all that passes from one scheme to another; whatever else a scheme keeps (the report's
/// carries the points themselves) it makes anew in [`start`](Scheme::start).
pub trait Scheme: Send + Debug {
    /// Takes the run over at `state`: at its beginning, or from another scheme. Comes before the first step.
    fn start(&mut self, state: &State);

    /// From now on these are the forces and the friction. Of friction a scheme must be given none that it
    /// [cannot be true to](super::scheme::SchemeInfo::admits).
    ///
    /// # Panics
    /// Here or in a step, when a push is on a point that the body does not have.
    fn load(&mut self, loads: &Loads);

    /// Takes `state` `dt` seconds further, its time left as it is: time is the run's, which counts steps.
    fn step(&mut self, dt: f64, state: &mut State);

    /// The same step, to the last bit, with what is computed on the way added to `phases`.
    fn explain(&mut self, dt: f64, state: &mut State, phases: &mut Vec<Phase>);

    /// The work of friction in the step taken last, J: 0, or less. Of friction that acts as an impulse it is the impulse
    /// times the mean of ω before and after it; of friction that is integrated, the integral.
    fn friction_work(&self) -> f64 {
        0.0
    }

    /// Whether the step taken last is no number because it would have taken too long.
    fn has_given_up(&self) -> bool {
        false
    }

    /// What there is to say of how the run was computed, beyond the scheme's name.
    fn remark(&self) -> Option<String> {
        None
    }

    /// A copy that goes its own way from here.
    fn boxed(&self) -> Box<dyn Scheme>;
}

/// Time counted in steps and not summed, so that steps of equal length add no rounding.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct StepClock {
    before_s: f64,
    time_step_s: f64,
    steps: u64,
}

impl StepClock {
    pub fn starting_at(time_s: f64) -> Self {
        Self {
            before_s: time_s,
            ..Self::default()
        }
    }

    /// Counts a step of `time_step_s`, and returns when it ends, s.
    pub fn next_time(&mut self, time_step_s: f64) -> f64 {
        if time_step_s != self.time_step_s {
            *self = Self {
                before_s: self.time_s(),
                time_step_s,
                steps: 0,
            };
        }
        self.steps += 1;
        self.time_s()
    }

    fn time_s(&self) -> f64 {
        self.before_s + self.steps as f64 * self.time_step_s
    }
}

impl Clone for Box<dyn Scheme> {
    fn clone(&self) -> Self {
        self.as_ref().boxed()
    }
}
