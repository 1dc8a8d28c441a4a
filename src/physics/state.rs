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
    pub fn is_finite(&self) -> bool {
        // 0 · x is 0 for every finite x and NaN for all else: one sum tells, without thirteen branches. Column by column few
        // additions wait for one another.
        let [x, y, z] = [0, 1, 2].map(|j| 0.0 * self.orientation.column(j));
        let zeros = (x + y) + (z + 0.0 * self.momentum);
        zeros.sum() + 0.0 * self.time_s == 0.0
    }
}
