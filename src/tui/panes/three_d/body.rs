//! The body in the scene: axle, hub, spokes, rim, masses and solid parts. Near parts look heavier than far ones.

use super::{CIRCLE_PARTS, SceneSubject};
use crate::engine::scenario::file::RimFile;
use crate::lab::playback::live::LiveRun;
use crate::lab::playback::outline::{self, Polyline};
use crate::physics::{PlacedSolid, State};
use crate::tui::dots::Ink;
use crate::tui::scene::{DotScene, LineStroke};
use crate::tui::theme::Role;
use nalgebra::Vector3;
use std::f64::consts::TAU;

/// The most free points and parts that are drawn.
const MOST_FREE: usize = 60;
const MOST_PARTS: usize = 60;
/// Where the spoke begins, of the radius of the rim.
const HUB: f64 = 0.14;
/// The hub. It is no letter, as those stand for vectors and masses.
const HUB_SIGN: &str = "■";
/// A mass or a line is near or far where it is nearer or farther than the middle of the rim or of its part by this share of
/// the rim's radius or of the part's size.
const NEAR_SHARE: f64 = 0.33;
/// A centre that is off the axle by less than this share of the body's size needs no line to it.
const CENTER_ON_AXLE: f64 = 1e-3;
/// The least distance of the signs of masses on the rim, cells.
const CLOSEST: f64 = 2.0;

/// Lines of the body as it stood before.
const EARLIER_BODY_STROKE: (LineStroke, Ink) = (LineStroke::Dotted(2), Ink::Strong(Role::Ghost));

/// A sign, its role and its cell.
pub type BodySign = (&'static str, Role, (u16, u16));

/// The body as it is drawn, upright: distances from the axle and heights.
pub struct DrawnBody {
    pub rim: Option<RimFile>,
    /// Heights between which there is an axle.
    pub axle: (f64, f64),
    /// Distance from the axle and height of the rim and of each free point that is drawn.
    pub corners: Vec<(f64, f64)>,
    /// The free points that have a mass.
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

    /// The distance of the farther end of the axle from the pivot, m.
    pub fn arm(&self) -> f64 {
        self.axle.0.abs().max(self.axle.1.abs())
    }

    /// The size of the body, m.
    pub fn reach(&self) -> f64 {
        let corners = self.corners.iter().copied();
        let reaches = corners.map(|(across, height)| libm::hypot(across, height));
        reaches.fold(f64::MIN_POSITIVE, f64::max)
    }
}

/// The point `index` of `points` on the rim, or on a circle that is `share` as large.
fn rim_point(
    rim: &RimFile,
    state: &State,
    index: usize,
    points: usize,
    share: f64,
) -> Vector3<f64> {
    let (sin, cos) = libm::sincos(TAU * index as f64 / points as f64);
    let radius = share * rim.radius_m;
    state.orientation * Vector3::new(radius * cos, radius * sin, rim.height_m)
}

fn rim_circle(rim: &RimFile, state: &State) -> Vec<Vector3<f64>> {
    (0..CIRCLE_PARTS)
        .map(|part| rim_point(rim, state, part, CIRCLE_PARTS, 1.0))
        .collect()
}

fn rim_masses(rim: &RimFile, state: &State) -> impl Iterator<Item = Vector3<f64>> {
    (0..rim.points).map(|point| rim_point(rim, state, point, rim.points, 1.0))
}

/// A part as it is drawn, upright.
struct Solid {
    centre: Vector3<f64>,
    /// The greatest distance of a line from the centre, m.
    size: f64,
    lines: Vec<Polyline>,
}

impl Solid {
    fn new(part: &PlacedSolid) -> Self {
        let lines = outline::lines(part);
        let points = lines.iter().flat_map(|line| &line.points);
        let distances = points.map(|at| (at - part.centre).norm());
        Self {
            centre: part.centre,
            size: distances.fold(0.0, f64::max),
            lines,
        }
    }

    /// Distance from the axle and height of the two ends of the cylinder about the axle in which it lies.
    fn corners(&self) -> [(f64, f64); 2] {
        let (mut across, mut lowest, mut highest) = (0.0_f64, f64::INFINITY, f64::NEG_INFINITY);
        for at in self.lines.iter().flat_map(|line| &line.points) {
            across = across.max(at.xy().norm());
            (lowest, highest) = (lowest.min(at.z), highest.max(at.z));
        }
        [(across, lowest), (across, highest)]
    }
}

impl SceneSubject<'_> {
    /// The axle from the pivot to its top, hub, spokes and rim, and what joins free masses to the axle.
    pub(super) fn body(&self, scene: &mut DotScene) {
        let state = self.state;
        let axle = state.axle();
        let (foot, top) = self.shape.axle;
        let text = Ink::Strong(Role::Text);
        scene.rod(&(axle * foot), &(axle * top), Ink::Strong(Role::Focus));
        for at in &self.shape.free {
            let on_axle = axle * at.z;
            scene.line(
                &on_axle,
                &(state.orientation * at),
                LineStroke::Dotted(2),
                text,
            );
        }
        for solid in &self.shape.solids {
            self.solid(solid, scene);
        }
        if let Some(rim) = &self.shape.rim {
            let middle = scene.depth(&(axle * rim.height_m));
            scene.ring(&rim_circle(rim, state), |depth| {
                match is_near(depth, middle, rim.radius_m) {
                    Some(true) => (LineStroke::Thick, text),
                    None => (LineStroke::Thin, text),
                    Some(false) => (LineStroke::Thin, Ink::Faint(Role::Quiet)),
                }
            });
            // One spoke only: it shows that the wheel turns, and more of them would hide the axle.
            let [hub, at] = [HUB, 1.0].map(|share| rim_point(rim, state, 0, 1, share));
            scene.line(&hub, &at, LineStroke::Thin, text);
        }
    }

    /// Near lines thick, far ones dotted, and a dotted line from the axle to what is off it.
    fn solid(&self, solid: &Solid, scene: &mut DotScene) {
        let ink = Ink::Strong(Role::Text);
        let centre = self.state.orientation * solid.centre;
        let middle = scene.depth(&centre);
        if solid.centre.xy().norm() > CENTER_ON_AXLE * self.reach {
            let foot = self.state.axle() * solid.centre.z;
            scene.line(&foot, &centre, LineStroke::Dotted(2), ink);
        }
        for line in &solid.lines {
            for (from, to) in pieces(line, self.state) {
                let depth = scene.depth(&((from + to) * 0.5));
                let (stroke, ink) = match is_near(depth, middle, solid.size) {
                    Some(true) if !line.is_mark => (LineStroke::Thick, ink),
                    Some(false) if !line.is_mark => {
                        (LineStroke::Dotted(2), Ink::Faint(Role::Quiet))
                    }
                    _ => (LineStroke::Thin, ink),
                };
                scene.line(&from, &to, stroke, ink);
            }
        }
    }

    /// The wheel, the axle and the solid parts as they stood at `state`, dotted.
    pub(super) fn body_before(&self, state: &State, scene: &mut DotScene) {
        let (stroke, ink) = EARLIER_BODY_STROKE;
        let axle = state.axle();
        let (foot, top) = self.shape.axle;
        scene.line(&(axle * foot), &(axle * top), stroke, ink);
        if let Some(rim) = &self.shape.rim {
            scene.ring(&rim_circle(rim, state), |_| EARLIER_BODY_STROKE);
            let spoke = rim_point(rim, state, 0, 1, 1.0);
            scene.line(&(axle * rim.height_m), &spoke, stroke, ink);
        }
        for at in &self.shape.free {
            let on_axle = axle * at.z;
            scene.line(&on_axle, &(state.orientation * at), stroke, ink);
        }
        for line in self.shape.solids.iter().flat_map(|solid| &solid.lines) {
            for (from, to) in pieces(line, state) {
                scene.line(&from, &to, stroke, ink);
            }
        }
    }

    /// The masses, the nearest last: a larger sign is nearer; and the hub, which no mass covers.
    pub(super) fn masses(&self, scene: &DotScene) -> Vec<BodySign> {
        let hub = self.wheel();
        let middle = scene.depth(&hub);
        let rim = self.shape.rim.as_ref();
        let radius = rim.map_or(self.reach, |rim| rim.radius_m);
        let mut masses = self.places_of_masses(self.state, scene);
        masses.sort_by(|a, b| scene.depth(b).total_cmp(&scene.depth(a)));
        let signs = masses.iter().map(|at| {
            let (sign, role) = match is_near(scene.depth(at), middle, radius) {
                Some(true) => ("O", Role::Heading),
                None => ("o", Role::Text),
                Some(false) => ("·", Role::Quiet),
            };
            (sign, role, scene.cell(at))
        });
        let has_hub = rim.is_some() && scene.shows(&hub);
        let hub = has_hub.then(|| (HUB_SIGN, Role::Heading, scene.cell(&hub)));
        signs.chain(hub).collect()
    }

    pub(super) fn masses_before(&self, state: &State, scene: &DotScene) -> Vec<BodySign> {
        let masses = self.places_of_masses(state, scene);
        masses
            .iter()
            .map(|at| ("°", Role::Ghost, scene.cell(at)))
            .collect()
    }

    /// Where the masses are at `state`: those in the picture, and those of the rim only if their signs have room there.
    fn places_of_masses(&self, state: &State, scene: &DotScene) -> Vec<Vector3<f64>> {
        let rim = self.shape.rim.iter().filter(|rim| {
            // From the side the rim is at least as long as twice its width.
            let plane = &scene.plane;
            let length = 4.0 * rim.radius_m * plane.scale.1 / plane.in_cell.1 as f64;
            length * 2.0 >= CLOSEST * rim.points as f64
        });
        let free = self.shape.free.iter().map(|at| state.orientation * at);
        let masses = rim.flat_map(|rim| rim_masses(rim, state)).chain(free);
        masses.filter(|at| scene.shows(at)).collect()
    }

    /// The middle of the wheel, or the axle's top where there is none.
    pub(super) fn wheel(&self) -> Vector3<f64> {
        let rim = self.shape.rim.as_ref();
        self.state.axle() * rim.map_or(self.shape.axle.1, |rim| rim.height_m)
    }
}

/// Whether something is in front of `middle`, behind it, or beside it, by `depth`.
fn is_near(depth: f64, middle: f64, size: f64) -> Option<bool> {
    let share = (depth - middle) / size;
    (share.abs() > NEAR_SHARE).then_some(share < 0.0)
}

/// The straight pieces of a line, in the world at `state`.
fn pieces(line: &Polyline, state: &State) -> Vec<(Vector3<f64>, Vector3<f64>)> {
    let points = line.points.iter();
    let turned: Vec<_> = points.map(|at| state.orientation * at).collect();
    turned.windows(2).map(|pair| (pair[0], pair[1])).collect()
}
