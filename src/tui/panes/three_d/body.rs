//! The body in the 3-D view: axle, hub, rim, masses and solid parts. Near parts are drawn heavier than far ones.

use super::{CIRCLE_PARTS, Scene, ink};
use crate::engine::scenario::file::RimFile;
use crate::lab::playback::live::LiveRun;
use crate::lab::playback::outline::{self, LineKind, Polyline};
use crate::physics::{PlacedSolid, State};
use crate::tui::dots::Dashes;
use crate::tui::layered_dots::{FineDot, Layer, LayeredDots, Spot};
use crate::tui::theme::Role;
use nalgebra::Vector3;
use std::f64::consts::TAU;

/// Maximum number of free points and parts that are drawn.
const MOST_FREE: usize = 60;
const MOST_PARTS: usize = 60;
/// A line of a part is far if it is behind the part's center by more than this fraction of the part's size.
const FAR_SHARE: f64 = 0.33;
/// Maximum distance of a center from the axle without a line to it, as a fraction of the body's size.
const CENTER_ON_AXLE: f64 = 1e-3;
/// Minimum distance between the masses on a rim for them to be drawn, fine dots.
const CLOSEST_MASSES: f64 = 5.0;
/// Dashes of lines from the axle to off-axle parts, of far lines, and of the body before a step.
const STRUT_DASHES: Dashes = (1, 2);

/// The drawn parts of the body in the body frame, where the axle is vertical.
pub struct DrawnBody {
    pub rim: Option<RimFile>,
    /// Heights of the axle's ends, m.
    pub axle: (f64, f64),
    /// Distance from the axle and height of the rim, of each drawn free point and of the ends of solid parts, m.
    pub corners: Vec<(f64, f64)>,
    /// Free points that have a mass.
    free: Vec<Vector3<f64>>,
    solids: Vec<Solid>,
}

impl DrawnBody {
    pub fn new(run: &LiveRun) -> Self {
        let scenario = run.scenario();
        let points = scenario.body.mechanics.points();
        let rim = scenario.file.body.rim.clone();
        let after = scenario.file.body.rim_points();
        let count = scenario.file.body.point.len().min(MOST_FREE);
        let free: Vec<_> = points.iter().skip(after).take(count).collect();
        let of_rim = rim.iter().map(|rim| (rim.radius_m, rim.height_m));
        let mut corners: Vec<_> = of_rim.collect();
        let traced = &points[scenario.trace];
        let single = free.iter().copied().chain([traced]);
        corners.extend(single.map(|point| (point.at.xy().norm(), point.at.z)));
        let parts = scenario.body.parts.iter().take(MOST_PARTS);
        let solids: Vec<_> = parts.map(Solid::new).collect();
        corners.extend(solids.iter().flat_map(Solid::corners));
        let heights = corners.iter().map(|(_, height)| *height);
        let axle = (
            heights.clone().fold(0.0, f64::min),
            heights.fold(0.0, f64::max),
        );
        let has_mass = free.iter().filter(|point| point.mass > 0.0);
        Self {
            rim,
            axle,
            free: has_mass.map(|point| point.at).collect(),
            corners,
            solids,
        }
    }

    /// Returns the distance from the pivot to the farther end of the axle, m.
    pub fn arm(&self) -> f64 {
        self.axle.0.abs().max(self.axle.1.abs())
    }

    /// Returns the size of the body, m.
    pub fn reach(&self) -> f64 {
        let corners = self.corners.iter().copied();
        let reaches = corners.map(|(across, height)| libm::hypot(across, height));
        reaches.fold(f64::MIN_POSITIVE, f64::max)
    }
}

/// Returns the point `index` of `points` equally spaced points on the rim, in the world frame.
fn rim_point(rim: &RimFile, state: &State, index: usize, points: usize) -> Vector3<f64> {
    let (sin, cos) = libm::sincos(TAU * index as f64 / points as f64);
    let (x, y) = (rim.radius_m * cos, rim.radius_m * sin);
    state.orientation * Vector3::new(x, y, rim.height_m)
}

fn rim_circle(rim: &RimFile, state: &State) -> Vec<Vector3<f64>> {
    (0..CIRCLE_PARTS)
        .map(|part| rim_point(rim, state, part, CIRCLE_PARTS))
        .collect()
}

fn rim_masses(rim: &RimFile, state: &State) -> impl Iterator<Item = Vector3<f64>> {
    (0..rim.points).map(|point| rim_point(rim, state, point, rim.points))
}

/// The lines of a solid part in the body frame.
struct Solid {
    center: Vector3<f64>,
    /// Maximum distance of a line from the center, m.
    size: f64,
    lines: Vec<Polyline>,
}

impl Solid {
    fn new(part: &PlacedSolid) -> Self {
        let lines = outline::lines(part);
        let points = lines.iter().flat_map(|line| &line.points);
        let distances = points.map(|at| (at - part.center).norm());
        Self {
            center: part.center,
            size: distances.fold(0.0, f64::max),
            lines,
        }
    }

    /// Returns distance from the axle and height of both ends of the smallest cylinder about the axle that contains the
    /// part, m.
    fn corners(&self) -> [(f64, f64); 2] {
        let (mut across, mut lowest, mut highest) = (0.0_f64, f64::INFINITY, f64::NEG_INFINITY);
        for at in self.lines.iter().flat_map(|line| &line.points) {
            across = across.max(at.xy().norm());
            (lowest, highest) = (lowest.min(at.z), highest.max(at.z));
        }
        [(across, lowest), (across, highest)]
    }
}

impl Scene<'_> {
    /// Draws rim, axle, hub, masses, and the solid parts.
    pub(super) fn body(&self, dots: &mut LayeredDots) {
        let state = self.state;
        for at in &self.shape.free {
            let foot = state.axle() * at.z;
            self.dashed(&foot, &(state.orientation * at), Role::RimNear, dots);
        }
        for solid in &self.shape.solids {
            self.solid(solid, dots);
        }
        if let Some(rim) = &self.shape.rim {
            self.rim(rim, dots);
        }
        let (foot, top) = self.shape.axle;
        self.thick(&(state.axle() * foot), &(state.axle() * top), dots);
        self.masses(dots);
    }

    /// Draws a line two dots thick: the axle, or a marked edge.
    fn thick(&self, from: &Vector3<f64>, to: &Vector3<f64>, dots: &mut LayeredDots) {
        let of_axle = ink(Role::Text, Layer::Axle);
        let ends = (self.dot(from), self.dot(to));
        let (across, down) = normal(ends.0, ends.1);
        dots.line(ends.0, ends.1, of_axle);
        let beside = |at: FineDot| (at.0 + across, at.1 + down);
        dots.line(beside(ends.0), beside(ends.1), of_axle);
    }

    fn rim(&self, rim: &RimFile, dots: &mut LayeredDots) {
        let points = rim_circle(rim, self.state);
        let middle = self.camera.depth(&self.wheel());
        for (index, from) in points.iter().enumerate() {
            let to = &points[(index + 1) % points.len()];
            let is_near = self.camera.depth(&((from + to) * 0.5)) <= middle;
            let of_part = if is_near {
                ink(Role::RimNear, Layer::Near)
            } else {
                ink(Role::RimFar, Layer::Far)
            };
            dots.line(self.dot(from), self.dot(to), of_part);
        }
    }

    /// Draws a part. Its far lines and the hidden edges of a block are dashed. A dashed line connects an off-axle part
    /// to the axle.
    fn solid(&self, solid: &Solid, dots: &mut LayeredDots) {
        let center = self.state.orientation * solid.center;
        let middle = self.camera.depth(&center);
        if solid.center.xy().norm() > CENTER_ON_AXLE * self.reach {
            let foot = self.state.axle() * solid.center.z;
            self.dashed(&foot, &center, Role::RimNear, dots);
        }
        for line in &solid.lines {
            for (from, to) in pieces(line, self.state) {
                let behind = self.camera.depth(&((from + to) * 0.5)) - middle;
                let (is_hidden, is_thick) = match line.kind {
                    LineKind::Outline => (behind > FAR_SHARE * solid.size, false),
                    LineKind::Mark => (false, false),
                    LineKind::Edge { faces, is_marked } => (self.face_away(&faces), is_marked),
                };
                if is_thick {
                    self.thick(&from, &to, dots);
                } else if is_hidden {
                    self.dashed(&from, &to, Role::RimFar, dots);
                } else {
                    let near = ink(Role::RimNear, Layer::Near);
                    dots.line(self.dot(&from), self.dot(&to), near);
                }
            }
        }
    }

    /// Returns true if all faces of the body with these outward normals (body frame) face away from the viewer.
    fn face_away(&self, normals: &[Vector3<f64>]) -> bool {
        let turn = self.state.orientation;
        normals
            .iter()
            .all(|normal| self.camera.depth(&(turn * normal)) >= 0.0)
    }

    fn dashed(&self, from: &Vector3<f64>, to: &Vector3<f64>, role: Role, dots: &mut LayeredDots) {
        let ends = [self.dot(from), self.dot(to)].into_iter();
        dots.path(
            ends,
            Some(STRUT_DASHES),
            f64::INFINITY,
            ink(role, Layer::Far),
        );
    }

    /// Draws the wheel, the axle and the solid parts at `state`, dotted.
    pub(super) fn body_before(&self, state: &State, dots: &mut LayeredDots) {
        let axle = state.axle();
        let (foot, top) = self.shape.axle;
        self.dashed(&(axle * foot), &(axle * top), Role::Previous, dots);
        if let Some(rim) = &self.shape.rim {
            let points = rim_circle(rim, state);
            for (index, from) in points.iter().enumerate() {
                let to = &points[(index + 1) % points.len()];
                self.dashed(from, to, Role::Previous, dots);
            }
        }
        for at in &self.shape.free {
            self.dashed(
                &(axle * at.z),
                &(state.orientation * at),
                Role::Previous,
                dots,
            );
        }
        for line in self.shape.solids.iter().flat_map(|solid| &solid.lines) {
            for (from, to) in pieces(line, state) {
                self.dashed(&from, &to, Role::Previous, dots);
            }
        }
        for at in self.places_of_masses(state) {
            let before = ink(Role::Previous, Layer::Previous);
            dots.spot(self.dot(&at), Spot::Two, before);
        }
    }

    /// Draws the masses and the hub. Near ones are larger.
    fn masses(&self, dots: &mut LayeredDots) {
        let hub = self.wheel();
        let middle = self.camera.depth(&hub);
        let [near, far] = if self.is_large() {
            [Spot::Five, Spot::Three]
        } else {
            [Spot::Three, Spot::Two]
        };
        for at in self.places_of_masses(self.state) {
            if self.camera.depth(&at) <= middle {
                dots.spot(self.dot(&at), near, ink(Role::Text, Layer::Mass));
            } else {
                dots.spot(self.dot(&at), far, ink(Role::RimFar, Layer::Far));
            }
        }
        if self.shape.rim.is_some() {
            dots.spot(self.dot(&hub), Spot::Three, ink(Role::Text, Layer::Mass));
        }
    }

    /// Returns the positions of the masses at `state`. Masses of the rim are included only if they are far enough
    /// apart.
    fn places_of_masses(&self, state: &State) -> Vec<Vector3<f64>> {
        let apart = |rim: &RimFile| {
            TAU * rim.radius_m * self.plane.scale.1 / rim.points as f64 >= CLOSEST_MASSES
        };
        let rim = self.shape.rim.iter().filter(|rim| apart(rim));
        let free = self.shape.free.iter().map(|at| state.orientation * at);
        rim.flat_map(|rim| rim_masses(rim, state))
            .chain(free)
            .collect()
    }

    /// Returns the middle of the wheel, or the axle's top if there is no wheel.
    fn wheel(&self) -> Vector3<f64> {
        let rim = self.shape.rim.as_ref();
        self.state.axle() * rim.map_or(self.shape.axle.1, |rim| rim.height_m)
    }
}

/// Returns the unit vector perpendicular to the line from one dot to another, on the sheet.
pub fn normal(from: FineDot, to: FineDot) -> FineDot {
    let (dx, dy) = (to.0 - from.0, to.1 - from.1);
    let length = libm::hypot(dx, dy);
    if length > 2.0 {
        (-dy / length, dx / length)
    } else {
        (1.0, 0.0)
    }
}

/// Returns the straight segments of a line, in the world frame at `state`.
fn pieces(line: &Polyline, state: &State) -> Vec<(Vector3<f64>, Vector3<f64>)> {
    let points = line.points.iter();
    let turned: Vec<_> = points.map(|at| state.orientation * at).collect();
    turned.windows(2).map(|pair| (pair[0], pair[1])).collect()
}
