//! What is read off a run at one step: the numbers of one CSV row.

use crate::physics::observables::{self, Azimuth};
use crate::physics::{Body, State};
use nalgebra::Vector3;

/// The state at one step as it leaves the program.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Number of the step, 0 at the start.
    pub step: u64,
    /// Time, s.
    pub time_s: f64,
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
    /// The number of edits of time step, scheme or gravity before this step.
    pub segment: u64,
}

impl Sample {
    /// Reads `state`, at `step` of a run in `segment` under `gravity` (m/s²), whose traced point is `trace`.
    pub fn new(
        body: &Body,
        trace: usize,
        gravity: f64,
        (step, segment): (u64, u64),
        state: &State,
        azimuth: &Azimuth,
    ) -> Self {
        let angular_velocity = observables::angular_velocity(body, state);
        let kinetic = 0.5 * state.momentum.dot(&angular_velocity);
        Self {
            step,
            time_s: state.time_s,
            position: observables::position(body, state, trace),
            momentum: state.momentum,
            angular_velocity,
            tilt_deg: observables::tilt_deg(state),
            azimuth_deg: azimuth.degrees(),
            energy: kinetic + gravity * observables::weight_height(body, state),
            segment,
        }
    }
}
