//! Typical sizes of the quantities of a run. Differences far below them are rounding errors.

use super::job::FigureRun;
use super::quantity;
use crate::engine::scenario::Scenario;
use crate::engine::scenario::start;
use crate::physics::observables;
use crate::plot::chart::ChartAxis;

/// Returns the axis of the column `name` of `runs`, which hides differences that are only rounding. Magnified to the
/// height of the page, an error in the eighth digit of a position or an angle would look like a motion.
pub(super) fn axis(runs: &[FigureRun], name: &str) -> ChartAxis {
    let sizes = runs.iter().map(|run| of_run(&run.scenario, name));
    ChartAxis {
        size: sizes.filter(|size| size.is_finite()).fold(0.0, f64::max),
        flat_below: match name {
            "x_m" | "y_m" | "z_m" | "tilt_deg" | "azimuth_deg" => 1e-7,
            _ => 0.0,
        },
        ..quantity::axis(name)
    }
}

/// Returns the typical size of the column `name` in a run of `scenario`: the traced point's arm, one radian, or the
/// value at the start; 0 if unknown.
fn of_run(scenario: &Scenario, name: &str) -> f64 {
    let (body, state) = (&scenario.body.mechanics, &scenario.start);
    let rate = observables::angular_velocity(body, state).norm();
    match name {
        "x_m" | "y_m" | "z_m" => scenario.arm_m(),
        "tilt_deg" | "azimuth_deg" => 1.0_f64.to_degrees(),
        "Lx_Js" | "Ly_Js" | "Lz_Js" | "L_axle_Js" => state.momentum.norm(),
        "wx_rad_per_s" | "wy_rad_per_s" | "wz_rad_per_s" | "w1_rad_per_s" | "w2_rad_per_s"
        | "w3_rad_per_s" => rate,
        "foot_force_N" => body.mass() * scenario.motion.gravity.abs(),
        "spin_rpm" => start::rpm(rate),
        "energy_J" => {
            let weight = scenario.motion.gravity * body.first_moment().norm();
            observables::kinetic_energy(body, state) + weight.abs()
        }
        _ => 0.0,
    }
}

/// A distance from the exact motion below this fraction of the arm is rounding, not an error of the scheme.
const DISTANCE_ROUNDING: f64 = 1e-12;

/// Returns the distance of the traced point from the exact motion, m, below which it is only rounding in a run of
/// `scenario`.
pub(super) fn rounding_m(scenario: &Scenario) -> f64 {
    DISTANCE_ROUNDING * scenario.arm_m()
}
