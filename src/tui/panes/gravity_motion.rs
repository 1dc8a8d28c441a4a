//! The motion of a run under gravity alone. It determines the size of its pictures in advance.

use crate::engine::scenario::Scenario;
use crate::physics::{LagrangeTop, Loads, SymmetricTop};

/// Returns the exact motion from the start under gravity alone, about the vertical.
///
/// Returns `None` without gravity, and for a body that is not nearly symmetric about its axle.
pub fn gravity_motion(scenario: &Scenario) -> Option<LagrangeTop> {
    let body = &scenario.body.mechanics;
    let (top, _) = SymmetricTop::nearly(body)?;
    let gravity = Loads {
        gravity: scenario.motion.gravity,
        ..Loads::default()
    };
    let load = gravity.on_axle(body, &top)?;
    let start = &scenario.start;
    (load.norm() > 0.0).then(|| {
        LagrangeTop::new(
            top.across,
            top.along,
            load,
            start.orientation,
            start.momentum,
        )
    })
}

/// Returns the minimum and the maximum tilt of that motion, degrees from +z.
pub fn predicted_tilts_deg(scenario: &Scenario) -> Option<(f64, f64)> {
    let motion = gravity_motion(scenario)?;
    let (low, high) = motion.tilt_range();
    let is_pulled_up = scenario.motion.gravity * scenario.body.mechanics.first_moment().z < 0.0;
    let (low, high) = (low.to_degrees(), high.to_degrees());
    Some(if is_pulled_up {
        (180.0 - high, 180.0 - low)
    } else {
        (low, high)
    })
}
