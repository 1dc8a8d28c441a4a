//! The numbers in which a run is compared with the exact motion at one time.

use super::step::Step;
use crate::physics::{State, observables};
use crate::scenario::Scenario;
use nalgebra::Vector3;

/// Numbers of a run or of the exact motion at one moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment {
    pub time_s: f64,
    /// Traced point, world frame, m.
    pub position: Vector3<f64>,
    /// Angular momentum about the pivot, world frame, J s.
    pub momentum: Vector3<f64>,
    /// Angle of the axle from +z, degrees.
    pub tilt_deg: f64,
    /// [Energy error](Step::energy_drift). It is 0 for the exact motion.
    pub energy_error: Option<f64>,
}

impl Moment {
    /// Returns the numbers of `step` of a run.
    pub fn of_run(step: &Step) -> Self {
        Self {
            energy_error: step.energy_drift(),
            ..Self::of_exact_motion(step.scenario(), step.after())
        }
    }

    /// Returns the numbers of the exact motion of `scenario` in `state`.
    pub fn of_exact_motion(scenario: &Scenario, state: &State) -> Self {
        Self {
            time_s: state.time_s,
            position: observables::position(&scenario.body.mechanics, state, scenario.trace),
            momentum: state.momentum,
            tilt_deg: observables::tilt_deg(state),
            energy_error: Some(0.0),
        }
    }
}
