//! What the exact motion of a scenario costs: nothing in closed form, the turning of the body where it is integrated.

use crate::physics::{Damping, Loads, State, SymmetricTop, observables};
use crate::run::Clock;
use crate::scenario::{Edit, Scenario};
use crate::text::number::shortest;

/// Radians of rotation through which the exact motion may be integrated on the side: less than half a second's work, and
/// no more than an integration does in one time step.
pub const AFFORDABLE_RAD: f64 = 2e5;

/// Whether the exact motion of `scenario` can be had on the side: in closed form always, by integration for a while.
pub fn is_affordable(scenario: &Scenario) -> bool {
    integration_rad(scenario) <= AFFORDABLE_RAD
}

/// Why the exact motion of `scenario` cannot be had on the side; `None` where it [can](is_affordable).
pub fn why_exact_unavailable(scenario: &Scenario) -> Option<String> {
    (!is_affordable(scenario)).then(|| {
        format!(
            "its exact motion must be integrated, which would take too long for {} s",
            shortest(Clock::end_s(scenario))
        )
    })
}

/// Radians of rotation through which the exact motion of `scenario` has to be integrated; 0 where it has a closed form.
pub fn integration_rad(scenario: &Scenario) -> f64 {
    integration_rad_per_s(scenario, &scenario.start) * Clock::end_s(scenario)
}

/// The same in a second from `state` on.
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

/// Radians by which the body of `scenario` turns or swings in a second under `loads`, from `state` on.
pub(super) fn turning_rad_per_s(scenario: &Scenario, loads: &Loads, state: &State) -> f64 {
    let body = &scenario.body.mechanics;
    let spin = observables::angular_velocity(body, state).norm();
    // A body at rest will swing and turn under its weight, at about this rate.
    let moment = loads.moment(body).norm();
    let swing = (moment * body.inverse_inertia().trace()).sqrt();
    // Strong friction makes the steps of the integration as short as fast turning does.
    let damping = Damping::new(body, &scenario.friction);
    let slowing = damping.map_or(0.0, |damping| damping.rate(spin));
    spin + swing + slowing
}

/// Whether there is no friction, the body is symmetric and every push, those of edits too, acts on its axle.
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
    fn strong_friction_is_as_dear_as_fast_turning() {
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
    fn a_push_as_near_to_the_axle_as_the_closed_form_takes_costs_no_integration() {
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
