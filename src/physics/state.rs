//! Time, orientation and angular momentum of a body.

use super::Body;
use nalgebra::{Matrix3, Vector3};

/// An axle whose direction's length is outside these is that of no rotation.
const LEAST_AXLE: f64 = 0.5;
const MOST_AXLE: f64 = 1.5;

/// Time, orientation and angular momentum of a body: all that passes from step to step and from scheme to scheme.
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
    /// Returns the state at time 0 of a body with this `orientation` that turns about its axle by `spin`, rad/s, while the
    /// axle is at rest. For any other motion, add to `momentum`, or use
    /// [`with_angular_velocity`](Self::with_angular_velocity).
    ///
    /// ω is along the axle; L is too if the axle is a principal axis.
    pub fn spinning(body: &Body, orientation: Matrix3<f64>, spin: f64) -> Self {
        Self::with_angular_velocity(body, orientation, &(spin * orientation.column(2)))
    }

    /// Returns the state at time 0 of a body with this `orientation` and the angular velocity `omega`, world frame, rad/s.
    pub fn with_angular_velocity(
        body: &Body,
        orientation: Matrix3<f64>,
        omega: &Vector3<f64>,
    ) -> Self {
        Self {
            time_s: 0.0,
            orientation,
            momentum: orientation * (body.inertia() * orientation.tr_mul(omega)),
        }
    }

    /// The axle's direction, world frame: the body direction that was +z upright, whatever the masses.
    pub fn axle(&self) -> Vector3<f64> {
        self.orientation.column(2).into_owned()
    }

    /// Whether the orientation is near to a rotation. A scheme that breaks down stretches it, or lets it collapse, before the
    /// numbers stop being finite.
    #[inline]
    pub fn is_a_rotation(&self) -> bool {
        (LEAST_AXLE * LEAST_AXLE..MOST_AXLE * MOST_AXLE).contains(&self.axle().norm_squared())
    }

    /// Whether every number is finite.
    #[inline]
    pub fn is_finite(&self) -> bool {
        // What is infinite or no number makes the sum so; a sum of finite numbers can overflow too, so each is looked at then.
        // Added one by one, as they have just been stored one by one: a processor waits where it loads two together that
        // were not stored together.
        let numbers = || self.orientation.iter().chain(self.momentum.iter());
        let sum = numbers().fold(self.time_s, |sum, number| sum + number);
        sum.is_finite() || (self.time_s.is_finite() && numbers().all(|number| number.is_finite()))
    }
}
