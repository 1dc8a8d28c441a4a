//! How the body stands and moves, and what one time step did to it.

use super::Body;
use nalgebra::{Matrix3, Vector3};

/// What passes from step to step and from scheme to scheme: time, orientation and angular momentum, no more.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State {
    /// Time, s.
    pub time_s: f64,
    /// Orientation: turns body-frame vectors into world-frame ones. Its third column is the axle.
    pub orientation: Matrix3<f64>,
    /// Angular momentum L about the pivot, world frame, J s.
    pub momentum: Vector3<f64>,
}

impl State {
    /// The axle's direction, world frame: the body direction that was +z upright, whatever the masses.
    pub fn axle(&self) -> Vector3<f64> {
        self.orientation.column(2).into_owned()
    }

    /// Whether every number is finite.
    pub fn is_finite(&self) -> bool {
        // 0 · x is 0 for every finite x and NaN for all else: one sum tells, without thirteen branches.
        let zeros =
            (0.0 * self.momentum).sum() + (0.0 * self.orientation).sum() + 0.0 * self.time_s;
        zeros == 0.0
    }
}

/// The numbers between a state and the next, in the words of the report's section 3.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Workings {
    /// Inertia about the pivot from the positions before the step, world frame, kg m².
    pub inertia: Matrix3<f64>,
    /// Ω = I⁻¹L before the step, world frame, rad/s.
    pub angular_velocity: Vector3<f64>,
    /// The rotation R that took the positions from before to after.
    pub rotation: Matrix3<f64>,
    /// The torque that changed L, world frame, N m: for the report's scheme Σ X × F at the new positions, for every
    /// other scheme the mean over the step.
    pub torque: Vector3<f64>,
}

impl Workings {
    /// The workings of a step of `body` as they follow from its two ends alone, for schemes that have no such numbers of
    /// their own.
    pub fn between(body: &Body, before: &State, after: &State, dt: f64) -> Self {
        let q = &before.orientation;
        Self {
            inertia: q * body.inertia() * q.transpose(),
            angular_velocity: q * (body.inverse_inertia() * q.tr_mul(&before.momentum)),
            rotation: after.orientation * q.transpose(),
            torque: (after.momentum - before.momentum) / dt,
        }
    }
}

/// One time step, whole: everything that shows, explains or exports a step reads this.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepRecord {
    /// The step's number: step 1 leads from the start to t = dt.
    pub step: u64,
    /// The time step, s.
    pub time_step_s: f64,
    /// State before the step.
    pub before: State,
    /// What the scheme computed on the way.
    pub workings: Workings,
    /// State after the step.
    pub after: State,
}
