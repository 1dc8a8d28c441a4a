//! The trait of all schemes.

use super::{Loads, State, workings::Phase};
use std::fmt::Debug;

/// A numerical scheme that steps a body. [`SteppedMotion`](super::SteppedMotion) uses one;
/// [`SchemeInfo::make`](super::SchemeInfo::make) makes one.
///
/// The error falls with dt as the [order](super::SchemeInfo::order) says. The orientation remains a rotation to rounding.
/// Under vertical forces without friction, L_z remains the same to the last bit (with `exact`: to rounding).
///
/// Only orientation, L and t pass from one scheme to another. What else a scheme keeps, it sets in
/// [`start`](Scheme::start); the report's scheme keeps the positions of the points.
pub trait Scheme: Send + Debug {
    /// Begins at `state`. Must be called before the first step.
    fn start(&mut self, state: &State);

    /// Sets the forces and the friction from now on. The scheme must [support](super::scheme::SchemeInfo::admits) this
    /// friction.
    ///
    /// # Panics
    /// Here or in a step, if a push acts on a point that the body does not have.
    fn load(&mut self, loads: &Loads);

    /// Steps `state` by `dt` seconds. Does not change its time: the caller counts steps.
    fn step(&mut self, dt: f64, state: &mut State);

    /// Takes the same step, to the last bit, and adds the intermediate results to `phases`.
    fn explain(&mut self, dt: f64, state: &mut State, phases: &mut Vec<Phase>);

    /// Returns the work of friction in the last step, J; 0 or negative. For friction that acts as an impulse, it is the
    /// impulse times the mean of ω before and after it. For friction that is integrated, it is the integral.
    fn friction_work(&self) -> f64 {
        0.0
    }

    /// True if the last step is NaN because it would have taken too long.
    fn has_given_up(&self) -> bool {
        false
    }

    /// Returns a remark on how the run was computed.
    fn remark(&self) -> Option<String> {
        None
    }

    /// Returns an independent copy.
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
