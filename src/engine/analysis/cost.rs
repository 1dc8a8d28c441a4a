//! Cost of the exact motion of a scenario: none in closed form, otherwise the rotation that must be integrated.

use crate::physics::{Damping, Loads, State, SymmetricTop, observables};
use crate::run::Clock;
use crate::scenario::{Edit, Scenario};
use crate::text::number::shortest;

/// Rotation through which the exact motion may be integrated alongside a run, rad. It takes less than half a second,
/// and is no more than an integration does in one time step.
pub const AFFORDABLE_RAD: f64 = 2e5;

/// Returns true if the exact motion of `scenario` is cheap enough to be computed alongside a run. A closed form always
/// is; an integration must be short.
pub fn is_affordable(scenario: &Scenario) -> bool {
    integration_rad(scenario) <= AFFORDABLE_RAD
}

/// Returns why the exact motion of `scenario` is not [affordable](is_affordable), or `None` if it is.
pub fn why_exact_unavailable(scenario: &Scenario) -> Option<String> {
    (!is_affordable(scenario)).then(|| {
        format!(
            "its exact motion must be integrated, which would take too long for {} s",
            shortest(Clock::end_s(scenario))
        )
    })
}

/// Returns the rotation through which the exact motion of `scenario` must be integrated, rad; 0 for a closed form.
pub fn integration_rad(scenario: &Scenario) -> f64 {
    integration_rad_per_s(scenario, &scenario.start) * Clock::end_s(scenario)
}

/// Returns the rotation per second that must be integrated from `state` on, rad/s.
pub fn integration_rad_per_s(scenario: &Scenario, state: &State) -> f64 {
    if has_closed_form(scenario) {
        return 0.0;
    }
    let weight = Loads {
        gravity: scenario.motion.gravity,
        pushes: Vec::new(),
        friction: scenario.friction,
    };
    turning_rad_per_s(scenario, &weight, state)
}

/// Returns the rate at which the body of `scenario` turns or swings under `loads`, from `state` on, rad/s.
pub(super) fn turning_rad_per_s(scenario: &Scenario, loads: &Loads, state: &State) -> f64 {
    let body = &scenario.body.mechanics;
    let spin = observables::angular_velocity(body, state).norm();
    // A body at rest will swing and turn under its weight, at about this rate.
    let moment = loads.moment(body).norm();
    let swing = (moment * body.inverse_inertia().trace()).sqrt();
    // Strong friction shortens the steps of the integration as much as fast turning does.
    let damping = Damping::new(body, &scenario.friction);
    let slowing = damping.map_or(0.0, |damping| damping.rate(spin));
    spin + swing + slowing
}

/// Returns true if there is no friction, the body is symmetric, and every push, including those set by edits, acts on
/// its axle.
pub fn has_closed_form(scenario: &Scenario) -> bool {
    let body = &scenario.body.mechanics;
    let edited = scenario.edits.iter().flat_map(Edit::pushes_set);
    let mut pushed = scenario.pushes.iter().chain(edited).map(|push| push.point);
    let on_axle =
        |top: &SymmetricTop, point: usize| top.has_on_axle(body, &body.points()[point].at);
    scenario.friction.is_none()
        && SymmetricTop::from_body(body).is_some_and(|top| pushed.all(|point| on_axle(&top, point)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::preset as scenario;

    #[test]
    fn strong_friction_costs_as_much_as_fast_turning() {
        for (set, is_cheap) in [
            ("friction.spin_viscous_Nms=10.0", true),
            ("friction.spin_viscous_Nms=1e6", false),
        ] {
            assert_eq!(
                is_affordable(&scenario("first-dip", &[set])),
                is_cheap,
                "{set}"
            );
        }
    }

    #[test]
    fn a_push_near_the_axle_needs_no_integration() {
        for (aside_m, is_free) in [(0.0, true), (1e-12, true), (1e-3, false)] {
            let point = format!("body.point.2={{name='aside',at_m=[{aside_m:e},0,1.5],mass_kg=0}}");
            let push = "push.0={point='aside',force_N=[1,0,0],from_s=1,for_s=1}";
            let rad = integration_rad(&scenario("method-2", &[&point, push]));
            assert!(
                if is_free { rad == 0.0 } else { rad > 0.0 },
                "{aside_m} m: {rad}"
            );
        }
    }
}
