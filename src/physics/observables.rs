//! Quantities of a state: positions, angles, energy, forces.

use super::friction::Damping;
use super::loads::{self, Loads};
use super::{Body, State};
use nalgebra::Vector3;

/// If the horizontal part of the axle's unit vector is at most this long, the axle counts as vertical and has no azimuth.
pub const VERTICAL_WITHIN: f64 = 1e-12;

/// Returns the position of the point `index` of the body, world frame, m.
///
/// # Panics
/// If the body has no such point.
pub fn position(body: &Body, state: &State, index: usize) -> Vector3<f64> {
    state.orientation * body.points()[index].at
}

/// Returns the angular velocity ω = I⁻¹L, world frame, rad/s.
pub fn angular_velocity(body: &Body, state: &State) -> Vector3<f64> {
    state.orientation * (body.inverse_inertia() * state.orientation.tr_mul(&state.momentum))
}

/// Returns the kinetic energy ½ L·ω, J.
pub fn kinetic_energy(body: &Body, state: &State) -> f64 {
    0.5 * state.momentum.dot(&angular_velocity(body, state))
}

/// Returns Σ m z, kg m, with z from the pivot. Times g it is the potential energy.
pub fn weight_height(body: &Body, state: &State) -> f64 {
    state
        .orientation
        .row(2)
        .transpose()
        .dot(&body.first_moment())
}

/// Returns the total energy, J: the kinetic energy, and the potential energy in `gravity` (m/s²) from the height of the
/// pivot. It does not contain the work of pushes.
pub fn total_energy(body: &Body, state: &State, gravity: f64) -> f64 {
    kinetic_energy(body, state) + gravity * weight_height(body, state)
}

/// Returns Σ m dz/dt, kg m/s: the vertical momentum of the body.
pub fn vertical_momentum(body: &Body, state: &State) -> f64 {
    let moment = state.orientation * body.first_moment();
    angular_velocity(body, state).cross(&moment).z
}

/// Returns the vertical force of the pivot on the body under `loads`, world frame, N. With the weight and the pushes, it
/// accelerates the center of mass.
///
/// Ignores the torque with which dry friction holds a spin of exactly 0. It matters only if the body is lopsided.
pub fn pivot_force_z(body: &Body, state: &State, loads: &Loads) -> f64 {
    let turn = state.orientation;
    let (moment, omega) = (turn * body.first_moment(), angular_velocity(body, state));
    let friction = Damping::new(body, &loads.friction);
    let friction = friction.map(|damping| turn * damping.torque(&turn.tr_mul(&omega)));
    let torque = loads::torque(&turn, &loads.moment(body)) + friction.unwrap_or_default()
        - omega.cross(&state.momentum);
    let alpha = turn * (body.inverse_inertia() * turn.tr_mul(&torque));
    let inertial = alpha.cross(&moment) + omega.cross(&omega.cross(&moment));
    let pushes: f64 = loads.pushes.iter().map(|push| push.force.z).sum();
    inertial.z + body.mass() * loads.gravity - pushes
}

/// Returns the angle of the axle from +z, 0 to 180 degrees.
pub fn tilt_deg(state: &State) -> f64 {
    tilt_of(&state.axle())
}

/// Returns the angle of `axle` (world frame, of any length) from +z, 0 to 180 degrees. Small angles are accurate too, to a
/// few units of rounding.
pub fn tilt_of(axle: &Vector3<f64>) -> f64 {
    libm::atan2(libm::hypot(axle.x, axle.y), axle.z).to_degrees()
}

/// The azimuth of the axle, with all full turns.
///
/// It stores the last direction off the vertical and the number of full turns. It therefore does not drift, and needs no
/// arc tangent until it is read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Azimuth {
    x: f64,
    y: f64,
    turns: i64,
}

impl Azimuth {
    /// Begins with the azimuth of `axle` (unit vector, world frame): atan2(y, x), or 0 if it is vertical.
    pub fn start(axle: &Vector3<f64>) -> Self {
        let mut azimuth = Self {
            x: 1.0,
            y: 0.0,
            turns: 0,
        };
        if !is_vertical(axle) {
            (azimuth.x, azimuth.y) = (axle.x, axle.y + 0.0);
        }
        azimuth
    }

    /// Follows the axle to its next direction. Adds the change, wrapped to (−180, 180] degrees; a vertical axle changes
    /// nothing.
    pub fn turn_to(&mut self, axle: &Vector3<f64>) {
        if is_vertical(axle) {
            return;
        }
        let (x, y) = (axle.x, axle.y + 0.0); // + 0.0 makes of −0.0 a 0.0, whose atan2 is +180, not −180
        let cross = self.x * y - self.y * x;
        let opposite = cross == 0.0 && self.x * x + self.y * y < 0.0;
        // atan2 jumps by a turn where the direction crosses the negative x axis: there, and only there, y changes
        // sign on a way that does not lead past the positive x axis.
        match (self.y >= 0.0, y >= 0.0) {
            (true, false) if cross > 0.0 || opposite => self.turns += 1,
            (true, true) if opposite && self.x < 0.0 => self.turns += 1, // from 180 to 0 degrees
            (false, true) if cross < 0.0 => self.turns -= 1,
            _ => {}
        }
        (self.x, self.y) = (x, y);
    }

    /// Returns the azimuth in degrees, with full turns.
    pub fn degrees(&self) -> f64 {
        libm::atan2(self.y, self.x).to_degrees() + 360.0 * self.turns as f64
    }
}

fn is_vertical(axle: &Vector3<f64>) -> bool {
    axle.x * axle.x + axle.y * axle.y <= VERTICAL_WITHIN * VERTICAL_WITHIN
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn the_pivot_force_balances_weight_push_and_acceleration() {
        let at = [[0.8, 0.1, 0.5], [-0.3, 0.7, 0.6], [0.1, 0.0, 1.1]];
        let points = at.map(|at| crate::PointMass::new(Vector3::from(at), 0.5));
        let body = Body::new(points.to_vec()).unwrap();
        let push = crate::PointForce {
            point: 2,
            force: Vector3::new(3.0, -4.0, 5.0),
        };
        let loads = Loads {
            gravity: 9.8,
            pushes: vec![push],
            ..Loads::default()
        };
        let turn = crate::rotation::about(&Vector3::new(0.3, -1.0, 0.4), 0.7);
        let state = State {
            time_s: 0.0,
            orientation: turn,
            momentum: Vector3::new(2.0, -1.0, 4.0),
        };
        let short_s = 1e-6;
        let after = |time_s: f64| {
            let omega = angular_velocity(&body, &state);
            let torque = loads::torque(&turn, &loads.moment(&body));
            let later = State {
                time_s,
                orientation: crate::rotation::about(&omega, time_s) * turn,
                momentum: state.momentum + torque * time_s,
            };
            vertical_momentum(&body, &later)
        };
        let gained = (after(short_s) - after(-short_s)) / (2.0 * short_s);
        let carried = gained + body.mass() * loads.gravity - push.force.z;
        let known = pivot_force_z(&body, &state, &loads);
        assert!((known - carried).abs() < 1e-6, "{known} {carried}");
    }

    /// Computes the azimuth literally as documented.
    fn by_arc_tangents(axles: &[Vector3<f64>]) -> f64 {
        let azimuth = |axle: &Vector3<f64>| libm::atan2(axle.y, axle.x).to_degrees();
        let changes = axles
            .windows(2)
            .map(|pair| azimuth(&pair[1]) - azimuth(&pair[0]));
        let wrapped = changes.map(|change| change - 360.0 * ((change - 180.0) / 360.0).ceil());
        azimuth(&axles[0]) + wrapped.sum::<f64>()
    }

    proptest! {
        #[test]
        fn the_azimuth_equals_the_sum_of_arc_tangents(
            directions in prop::collection::vec((-1.0..1.0f64, -1.0..1.0f64), 1..60)
        ) {
            let axles: Vec<_> = directions.iter().map(|&(x, y)| Vector3::new(x, y, 0.5)).collect();
            prop_assume!(axles.iter().all(|a| !is_vertical(a)));
            let mut azimuth = Azimuth::start(&axles[0]);
            axles[1..].iter().for_each(|axle| azimuth.turn_to(axle));
            prop_assert!((azimuth.degrees() - by_arc_tangents(&axles)).abs() < 1e-9);
        }
    }

    #[test]
    fn half_turns_count_as_plus_180() {
        let mut azimuth = Azimuth::start(&Vector3::new(1.0, 0.0, 0.0));
        for x in [-1.0, 1.0, -1.0, 1.0] {
            azimuth.turn_to(&Vector3::new(x, -0.0, 0.0));
        }
        assert_eq!(azimuth.degrees(), 720.0);
    }

    #[test]
    fn a_vertical_axle_has_azimuth_0_or_the_previous_one() {
        let mut azimuth = Azimuth::start(&Vector3::new(1e-13, 0.0, 1.0));
        assert_eq!(azimuth.degrees(), 0.0);
        azimuth.turn_to(&Vector3::new(0.0, 1.0, 0.0));
        azimuth.turn_to(&Vector3::new(0.0, 0.0, -1.0));
        assert_eq!(azimuth.degrees(), 90.0);
    }

    #[test]
    fn tilt_is_exact_near_the_vertical() {
        let tilted = |radians: f64| State {
            time_s: 0.0,
            orientation: crate::rotation::about(&Vector3::x(), radians),
            momentum: Vector3::zeros(),
        };
        for radians in [1e-9f64, 0.5, 3.0] {
            assert!((tilt_deg(&tilted(radians)) / radians.to_degrees() - 1.0).abs() < 1e-15);
        }
    }
}
