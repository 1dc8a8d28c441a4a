//! The extent of the picture from above: the origin, the run, and the motion predicted by theory.
//!
//! It does not change while the run agrees with theory. Otherwise it grows in steps and never shrinks, because every
//! change of the scale redraws the whole picture.

use super::super::PlotInputs;
use super::super::gravity_motion::{gravity_motion, predicted_tilts_deg};
use crate::engine::run::Clock;
use crate::engine::scenario::Scenario;
use nalgebra::{Vector2, Vector3};
use std::f64::consts::TAU;

/// Minimum half size of a picture, for a point that stays on the vertical, m.
const LEAST_HALF_M: f64 = 1e-6;
/// A run that exceeds the predicted motion by less than this fraction is inside the picture's margin.
const MARGIN_SHARE: f64 = 0.02;
/// Natural logarithm of the factor by which a side grows: 10 %.
const STEP: f64 = 0.0953;

/// Maximum rotation of L by gravity in the whole run for which the path is a circle about L, rad.
const STEADY_MOMENTUM_RAD: f64 = 0.35;
/// A point counts as on the axle if it is nearer to it than this fraction of its distance from the pivot.
const POINT_ON_AXLE: f64 = 1e-6;
/// Maximum swing of the tilt for which a motion is a circle, rad.
const CIRCLE_SWING_RAD: f64 = 0.01;
/// Minimum fraction of a turn for which a run shows its circle.
const COVERED_TURN: f64 = 1.0 / 3.0;

/// A rectangle that contains the origin, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlaneExtent {
    least: Vector2<f64>,
    most: Vector2<f64>,
}

impl PlaneExtent {
    pub fn of(seen: &PlotInputs<'_>) -> Self {
        let scenario = seen.run.scenario();
        let mut reached = Self::about(Vector2::zeros(), 0.0);
        let (_, own) = seen.run.pictures();
        let exact = seen.overlay().map(|overlay| &overlay.path);
        let others = [seen.ghost, seen.pinned].into_iter().flatten();
        let others = others.map(|other| &other.path);
        for path in [own].into_iter().chain(exact).chain(others) {
            path.dots()
                .for_each(|(x, y)| reached.add(Vector2::new(x, y)));
        }
        let places = seen.measured.map_or(&[][..], |data| &data.compared.places);
        places.iter().for_each(|place| reached.add(place.at));
        let predicted = Self::predicted(scenario);
        reached.in_steps(&predicted, scenario.arm_m())
    }

    fn about(middle: Vector2<f64>, radius: f64) -> Self {
        let half = Vector2::new(radius, radius);
        Self {
            least: (middle - half).inf(&Vector2::zeros()),
            most: (middle + half).sup(&Vector2::zeros()),
        }
    }

    fn add(&mut self, at: Vector2<f64>) {
        if at.iter().all(|part| part.is_finite()) {
            (self.least, self.most) = (self.least.inf(&at), self.most.sup(&at));
        }
    }

    /// Returns the extent of the traced point's motion, predicted from the start without pushes.
    fn predicted(scenario: &Scenario) -> Self {
        let traced = scenario.body.mechanics.points()[scenario.trace].at;
        if !is_on_axle(&traced) {
            return Self::about(Vector2::zeros(), 0.0);
        }
        if let Some((middle, radius)) = circle_about_momentum(scenario) {
            return Self::about(middle, radius);
        }
        let radius = predicted_tilts_deg(scenario).map_or(0.0, |(low, high)| {
            let widest = 90.0_f64.max(low).min(high);
            traced.norm() * libm::sin(widest.to_radians())
        });
        Self::about(Vector2::zeros(), radius)
    }

    /// Returns the sides of `predicted`, each grown in steps to contain this extent.
    fn in_steps(&self, predicted: &Self, arm_m: f64) -> Self {
        let grown = |reached, theory| side_in_steps(reached, theory, arm_m);
        Self {
            least: -(-self.least).zip_map(&-predicted.least, grown),
            most: self.most.zip_map(&predicted.most, grown),
        }
    }

    pub fn middle(&self) -> Vector2<f64> {
        0.5 * (self.least + self.most)
    }

    /// Returns half the width and height, m.
    pub fn half(&self) -> Vector2<f64> {
        (0.5 * (self.most - self.least)).map(|half| half.max(LEAST_HALF_M))
    }
}

/// Returns a side of an extent, m: `theory`, grown in steps until it contains `reached`.
fn side_in_steps(reached: f64, theory: f64, arm_m: f64) -> f64 {
    if reached <= theory * (1.0 + MARGIN_SHARE) {
        return theory;
    }
    let base = if theory > 0.0 { theory } else { arm_m };
    base * libm::exp((libm::log(reached / base) / STEP).ceil() * STEP)
}

/// Returns the radius of the circle predicted by theory, m, if the run is too short to show the circle.
pub fn predicted_circle(scenario: &Scenario) -> Option<f64> {
    let traced = scenario.body.mechanics.points()[scenario.trace].at;
    let is_left_alone = scenario.pushes.is_empty() && scenario.edits.is_empty();
    if !is_left_alone || !is_on_axle(&traced) || circle_about_momentum(scenario).is_some() {
        return None;
    }
    let motion = gravity_motion(scenario)?;
    let (low, high) = motion.tilt_range();
    let turn = motion.mean_precession().abs() * Clock::end_s(scenario) / TAU;
    let is_circle = high - low < CIRCLE_SWING_RAD && low > CIRCLE_SWING_RAD;
    (is_circle && turn < COVERED_TURN).then(|| traced.norm() * libm::sin(high))
}

/// Returns the circle about L that the traced point describes, from above: middle and radius, m.
///
/// Returns `None` if gravity turns L noticeably within the run.
fn circle_about_momentum(scenario: &Scenario) -> Option<(Vector2<f64>, f64)> {
    let momentum = scenario.start.momentum;
    let axis = momentum.try_normalize(f64::MIN_POSITIVE)?;
    let torque = scenario.motion.gravity * scenario.body.mechanics.first_moment().norm();
    let turn = torque.abs() / momentum.norm() * Clock::end_s(scenario);
    let is_left_alone = scenario.pushes.is_empty() && scenario.edits.is_empty();
    let start = scenario.start.orientation * scenario.body.mechanics.points()[scenario.trace].at;
    let middle = axis * axis.dot(&start);
    let radius = (start - middle).norm();
    let is_steady = is_left_alone && turn < STEADY_MOMENTUM_RAD;
    // A point on the line of L does not circle about L: it moves with L, which gravity turns.
    let circles = radius > turn * start.norm() && middle.xy().norm() > 0.0;
    (is_steady && circles).then(|| (middle.xy(), radius))
}

fn is_on_axle(at: &Vector3<f64>) -> bool {
    at.xy().norm() <= POINT_ON_AXLE * at.norm()
}
