//! What is read off a run at one step: the numbers of one CSV row, and the orientation.

use nalgebra::{Matrix3, Vector3};

/// The state at one step as it leaves the program.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Number of the step, 0 at the start.
    pub step: u64,
    pub time_s: f64,
    /// Orientation: turns body-frame vectors into world-frame ones.
    pub orientation: Matrix3<f64>,
    /// The traced point, world frame, m.
    pub position: Vector3<f64>,
    /// Angular momentum about the pivot, world frame, J s.
    pub momentum: Vector3<f64>,
    /// ω = I⁻¹L at this state, world frame, rad/s.
    pub angular_velocity: Vector3<f64>,
    /// Angle of the axle from +z, degrees.
    pub tilt_deg: f64,
    /// Azimuth of the axle, counted on through full turns, degrees.
    pub azimuth_deg: f64,
    /// Kinetic energy and that of the weight, from the pivot, J.
    pub energy: f64,
    /// The angle about the axle by which a rotor has turned in its frame since the start, rad; 0 where the whole body spins.
    pub rotor_turn: f64,
    /// The number of edits of time step, scheme or gravity before this step.
    pub segment: u64,
}
