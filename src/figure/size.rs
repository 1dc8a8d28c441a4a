//! How large the quantities of a run are by their nature: a difference far below that is rounding.

use super::request::Run;
use crate::physics::observables;
use crate::scenario::Scenario;
use crate::scenario::start;

/// The greatest of the sizes of the column or quantity `name` in `runs`, in its unit; 0 where none is known.
pub(super) fn of(runs: &[Run], name: &str) -> f64 {
    let sizes = runs.iter().map(|run| of_run(&run.scenario, name));
    sizes.filter(|size| size.is_finite()).fold(0.0, f64::max)
}

/// The part of its size below which a difference of the column or quantity `name` is drawn flat. Drawn as high as the page, an
/// error of the scheme in the eighth digit of a position or an angle looks like a motion.
pub(super) fn flat_below(name: &str) -> f64 {
    match name {
        "x_m" | "y_m" | "z_m" | "tilt_deg" | "azimuth_deg" => 1e-7,
        _ => 0.0,
    }
}

/// That of a run of `scenario`: the traced point's arm, one radian, or what the start has of the quantity.
fn of_run(scenario: &Scenario, name: &str) -> f64 {
    let (body, state) = (&scenario.body.mechanics, &scenario.start);
    let rate = || observables::angular_velocity(body, state).norm();
    match name {
        "x_m" | "y_m" | "z_m" => scenario.arm_m(),
        "tilt_deg" | "azimuth_deg" => 1.0_f64.to_degrees(),
        "Lx_Js" | "Ly_Js" | "Lz_Js" | "L_axle_Js" => state.momentum.norm(),
        "wx_rad_per_s" | "wy_rad_per_s" | "wz_rad_per_s" => rate(),
        "spin_rpm" => start::rpm(rate()),
        "energy_J" => {
            let weight = scenario.motion.gravity * body.first_moment().norm();
            observables::kinetic_energy(body, state) + weight.abs()
        }
        _ => 0.0,
    }
}
