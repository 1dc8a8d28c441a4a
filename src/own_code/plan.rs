//! Body and start of a program of the report's step.

use super::slips::Changes;
use crate::physics::rotation;
use crate::scenario::file::Frame;
use crate::scenario::{Push, Scenario, Window};
use nalgebra::{Matrix3, Vector3};
use std::f64::consts::TAU;

/// What a program of the report's step begins with.
#[derive(Clone, Debug)]
pub struct Plan {
    pub(super) points: Vec<([f64; 3], f64)>,
    /// The number of rim points, which come first, and of the axle's points, which follow.
    pub(super) rim: usize,
    axle: usize,
    traced: usize,
    start: Start,
    pub(super) gravity: f64,
    pub(super) time_step_s: f64,
    pub(super) pushes: Vec<Push>,
}

#[derive(Clone, Debug)]
struct Start {
    tilt_deg: f64,
    /// Whether the tilt alone makes the orientation.
    is_tilt: bool,
    orientation: Matrix3<f64>,
    momentum: Vector3<f64>,
    momentum_is_of_body: bool,
}

impl Plan {
    /// The plan of `scenario`; `None` where it is more than the report's step does: another scheme, friction, a rotor, edits,
    /// pushes in seconds.
    pub fn of(scenario: &Scenario) -> Option<Self> {
        let body = &scenario.body.mechanics;
        let in_steps = |push: &Push| matches!(push.window, Window::Steps { .. });
        let is_plain = scenario.motion.scheme.name == "report"
            && scenario.friction.is_none()
            && body.frame_moment() == 0.0
            && scenario.edits.is_empty()
            && scenario.pushes.iter().all(in_steps);
        let (file, start) = (&scenario.file.body, &scenario.file.start);
        let is_zero = |deg: Option<f64>| deg.unwrap_or(0.0) == 0.0;
        let points = body.points().iter();
        is_plain.then(|| Self {
            points: points.map(|point| (point.at.into(), point.mass)).collect(),
            rim: file.rim_points(),
            axle: file.point.len(),
            traced: scenario.trace,
            start: Start {
                tilt_deg: start.tilt_deg.unwrap_or(0.0),
                is_tilt: is_zero(start.turn_deg) && is_zero(start.roll_deg),
                orientation: scenario.start.orientation,
                momentum: scenario.start.momentum,
                momentum_is_of_body: start.momentum_Js.is_none()
                    || start.momentum_frame == Some(Frame::Body),
            },
            gravity: scenario.motion.gravity,
            time_step_s: scenario.motion.time_step_s,
            pushes: scenario.pushes.to_vec(),
        })
    }

    /// The points of the body with their masses, kg, in the upright pose, m.
    pub(super) fn body(&self, changes: &Changes) -> Vec<([f64; 3], f64)> {
        let mut points = self.points.clone();
        let Some(&([x, _, height], mass)) = points.first().filter(|_| self.rim > 1) else {
            return points;
        };
        if changes.rim_point_twice {
            for (place, point) in points[..self.rim].iter_mut().enumerate() {
                let angle = TAU * place as f64 / (self.rim - 1) as f64;
                let (sine, cosine) = libm::sincos(angle);
                point.0 = [x * cosine, x * sine, height];
            }
        }
        let axle = self.rim..self.rim + self.axle;
        for (place, point) in points.iter_mut().enumerate() {
            let has_mass = changes.axle_mass.is_some_and(|top_alone| {
                place == self.traced || !top_alone && axle.contains(&place)
            });
            if has_mass {
                point.1 = mass;
            }
        }
        points
    }

    /// Orientation and L at the start.
    pub(super) fn start(&self, changes: &Changes) -> (Matrix3<f64>, Vector3<f64>) {
        let start = &self.start;
        let own = start.orientation.tr_mul(&start.momentum);
        let angle = if changes.tilt_in_radians {
            start.tilt_deg
        } else {
            start.tilt_deg.to_radians()
        };
        let (axis, points_alone) = changes.tilt_axis.unwrap_or(([1.0, 0.0, 0.0], false));
        let is_changed = changes.tilt_axis.is_some() || changes.tilt_in_radians;
        let about = |axis: [f64; 3]| {
            if start.is_tilt && is_changed {
                rotation::about(&Vector3::from(axis), angle)
            } else {
                start.orientation
            }
        };
        let turned = about(axis);
        let of_momentum = if points_alone {
            about([1.0, 0.0, 0.0])
        } else {
            turned
        };
        let momentum = match (start.momentum_is_of_body, changes.other_frame) {
            (true, false) => of_momentum * own,
            (true, true) => own,
            (false, false) => start.momentum,
            (false, true) => of_momentum * start.momentum,
        };
        (turned, momentum)
    }

    /// The point that is written.
    pub(super) fn traced(&self, changes: &Changes) -> usize {
        let mut others = (self.rim..self.rim + self.axle).filter(|&place| place != self.traced);
        let traced = changes.traced.map(|number| others.nth(number).unwrap_or(0));
        traced.unwrap_or(self.traced)
    }
}
