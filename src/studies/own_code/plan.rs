//! Body and start of a program of the report's step.

use super::slips::Mutations;
use crate::engine::scenario::file::VectorFrame;
use crate::engine::scenario::{Push, Scenario, Window};
use crate::engine::text::number::{rounded, shortest};
use crate::physics::rotation;
use nalgebra::{Matrix3, Vector3};
use std::f64::consts::TAU;

/// The input of a program of the report's step.
#[derive(Clone, Debug)]
pub struct Plan {
    pub(super) points: Vec<([f64; 3], f64)>,
    /// Number of rim points, which come first.
    pub(super) rim: usize,
    /// Names of the axle's points, which follow the rim.
    pub(super) axle: Vec<String>,
    pub(super) traced: usize,
    start: ProgramStart,
    pub(super) gravity: f64,
    pub(super) time_step_s: f64,
    pub(super) pushes: Vec<Push>,
}

#[derive(Clone, Debug)]
struct ProgramStart {
    tilt_deg: f64,
    /// True if the tilt alone determines the orientation.
    is_tilt: bool,
    orientation: Matrix3<f64>,
    /// L in the frame in which the scenario states it, J s.
    momentum: Vector3<f64>,
    momentum_is_of_body: bool,
}

/// Number of parts of a plan that may be left over from another preset: push, rim, top, tilt and L.
pub(super) const PLAN_PARTS: usize = 5;

impl Plan {
    /// Creates the plan of `scenario`. Returns `None` if the scenario needs more than the report's step: another
    /// scheme, friction, a rotor, edits, or pushes in seconds.
    pub fn from_scenario(scenario: &Scenario) -> Option<Self> {
        let body = &scenario.body.mechanics;
        let is_plain = scenario.motion.scheme.name == "report"
            && scenario.friction.is_none()
            && body.frame_moment() == 0.0
            && scenario.edits.is_empty()
            && scenario
                .pushes
                .iter()
                .all(|push| matches!(push.window, Window::Steps { .. }));
        let (file, start) = (&scenario.file.body, &scenario.file.start);
        let of_body =
            start.momentum_Js.is_none() || start.momentum_frame == Some(VectorFrame::Body);
        let (orientation, momentum) = (scenario.start.orientation, scenario.start.momentum);
        let points = body.points().iter();
        is_plain.then(|| Self {
            points: points.map(|point| (point.at.into(), point.mass)).collect(),
            rim: file.rim_points(),
            axle: file.point.iter().map(|point| point.name.clone()).collect(),
            traced: scenario.trace,
            start: ProgramStart {
                tilt_deg: start.tilt_deg.unwrap_or(0.0),
                is_tilt: [start.turn_deg, start.roll_deg]
                    .iter()
                    .all(|deg| deg.unwrap_or(0.0) == 0.0),
                momentum: if of_body {
                    orientation.tr_mul(&momentum)
                } else {
                    momentum
                },
                orientation,
                momentum_is_of_body: of_body,
            },
            gravity: scenario.motion.gravity,
            time_step_s: scenario.motion.time_step_s,
            pushes: scenario.pushes.to_vec(),
        })
    }

    pub(super) fn part(&self, part: usize) -> String {
        match part {
            0 => match self.pushes.first() {
                None => "no push".to_owned(),
                Some(push) => {
                    let Window::Steps { count, .. } = push.window else {
                        return String::new(); // no plan has a push in seconds
                    };
                    format!("a push of {} N for {count} steps", vector(&push.force))
                }
            },
            1 => format!("the rim at {} m", number(self.points[0].0[2])),
            2 => format!("the top at {} m", number(self.points[self.traced].0[2])),
            3 => format!("a tilt of {} degrees", number(self.start.tilt_deg)),
            _ => format!("L = {} J s", vector(&self.start.momentum)),
        }
    }

    /// Returns this plan with the parts of `other` whose bits are set in `parts`; `None` if the two bodies differ in
    /// kind.
    pub(super) fn with_parts(&self, other: &Self, parts: u8) -> Option<Self> {
        let (count, trace) = (self.points.len(), self.traced);
        let is_alike = self.rim > 0 && (self.rim, count) == (other.rim, other.points.len());
        let mut plan = self.clone();
        for part in (0..PLAN_PARTS).filter(|part| parts & (1 << part) != 0) {
            match part {
                0 => plan.pushes.clone_from(&other.pushes),
                1 => plan.points[..self.rim].clone_from_slice(&other.points[..self.rim]),
                2 => plan.points[trace] = other.points[other.traced],
                3 => {
                    plan.start.tilt_deg = other.start.tilt_deg;
                    plan.start.orientation = other.start.orientation;
                }
                _ => plan.start.momentum = other.start.momentum,
            }
        }
        (is_alike && other.start.is_tilt).then_some(plan)
    }

    /// Returns the points of the body in the upright pose, m, with their masses, kg.
    pub(super) fn body(&self, changes: &Mutations) -> Vec<([f64; 3], f64)> {
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
        let axle = self.rim..self.rim + self.axle.len();
        if let Some(hub) = self.hub().filter(|_| changes.hub_in_plane) {
            points[hub].0[2] = height;
        }
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

    /// Returns the orientation and L at the start.
    pub(super) fn start(&self, changes: &Mutations) -> (Matrix3<f64>, Vector3<f64>) {
        let start = &self.start;
        let angle = if changes.tilt_in_radians {
            start.tilt_deg
        } else {
            start.tilt_deg.to_radians()
        };
        let (axis, points_alone) = changes.tilt_axis.unwrap_or(([1.0, 0.0, 0.0], false));
        let is_changed = changes.tilt_axis.is_some() || changes.tilt_in_radians;
        let axis_of_momentum = if points_alone { [1.0, 0.0, 0.0] } else { axis };
        let [turned, of_momentum] = [axis, axis_of_momentum].map(|direction| {
            if start.is_tilt && is_changed {
                rotation::about(&Vector3::from(direction), angle)
            } else {
                start.orientation
            }
        });
        let momentum = if start.momentum_is_of_body == changes.other_frame {
            start.momentum
        } else {
            of_momentum * start.momentum
        };
        (turned, momentum)
    }

    /// Returns the hub, the first point of the axle, if it is not in the plane of the rim.
    pub(super) fn hub(&self) -> Option<usize> {
        let hub = Some(self.rim).filter(|hub| *hub != self.traced && !self.axle.is_empty())?;
        (self.points[hub].0[2] != self.points[0].0[2]).then_some(hub)
    }

    /// Returns the name of the point that replaces point `k` as `Other::OfAxle(nth)`, if there is one.
    pub(super) fn other_of_axle(&self, nth: usize, k: usize) -> Option<&str> {
        let named = self.axle.iter().enumerate();
        let mut others = named.filter(|(place, _)| self.rim + place != k);
        others.nth(nth).map(|(_, name)| &**name)
    }
}

fn number(value: f64) -> String {
    shortest(rounded(value, 4))
}

fn vector(of: &Vector3<f64>) -> String {
    format!("({})", of.map(number).as_slice().join(", "))
}
