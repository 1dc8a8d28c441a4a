//! How the body stands and moves.

use nalgebra::{Matrix3, Vector3};

/// An axle whose direction's length is outside these is that of no rotation.
const LEAST_AXLE: f64 = 0.5;
const MOST_AXLE: f64 = 1.5;

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

    /// Whether the orientation is still that of a rigid body: a scheme that breaks down stretches it, or lets it collapse,
    /// before the numbers stop being finite.
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
