//! The solid parts in the scene.

use super::Subject;
use crate::observe::outline::{self, Polyline};
use crate::physics::{Part, State};
use crate::tui::dots::Ink;
use crate::tui::scene::{Scene, Stroke};
use crate::tui::theme::Role;
use nalgebra::Vector3;

const MOST_PARTS: usize = 60;
/// A line is near or far where it is nearer or farther than the part's centre by this share of the part's size.
const NEAR: f64 = 0.33;
/// A centre that is off the axle by less than this share of the body's size needs no line to it.
const ON_AXLE: f64 = 1e-3;

/// A part as it is drawn, upright.
pub struct Solid {
    centre: Vector3<f64>,
    /// The greatest distance of a line from the centre, m.
    size: f64,
    lines: Vec<Polyline>,
}

impl Solid {
    pub fn of(parts: &[Part]) -> Vec<Self> {
        let solid = |part: &Part| {
            let lines = outline::lines(part);
            let points = lines.iter().flat_map(|line| &line.points);
            let size = points
                .map(|at| (at - part.centre).norm())
                .fold(0.0, f64::max);
            Self {
                centre: part.centre,
                size,
                lines,
            }
        };
        parts.iter().take(MOST_PARTS).map(solid).collect()
    }

    /// Distance from the axle and height of the two ends of the cylinder about the axle in which it lies.
    pub fn corners(&self) -> [(f64, f64); 2] {
        let points = || self.lines.iter().flat_map(|line| &line.points);
        let across = points().map(|at| at.xy().norm()).fold(0.0, f64::max);
        let lowest = points().map(|at| at.z).fold(f64::INFINITY, f64::min);
        let highest = points().map(|at| at.z).fold(f64::NEG_INFINITY, f64::max);
        [(across, lowest), (across, highest)]
    }
}

impl Subject<'_> {
    /// The solid parts: near lines thick, far ones dotted, and a dotted line from the axle to what is off it.
    pub(super) fn solids(&self, scene: &mut Scene) {
        let ink = Ink::Strong(Role::Text);
        for solid in &self.shape.solids {
            let centre = self.state.orientation * solid.centre;
            let middle = scene.depth(&centre);
            if solid.centre.xy().norm() > ON_AXLE * self.reach {
                let foot = self.state.axle() * solid.centre.z;
                scene.line(&foot, &centre, Stroke::Dotted(2), ink);
            }
            for line in &solid.lines {
                for (from, to) in pieces(line, self.state) {
                    let depth = scene.depth(&((from + to) * 0.5)) - middle;
                    let (stroke, ink) = match depth / solid.size {
                        _ if line.is_mark => (Stroke::Thin, ink),
                        share if share < -NEAR => (Stroke::Thick, ink),
                        share if share > NEAR => (Stroke::Dotted(2), Ink::Faint(Role::Quiet)),
                        _ => (Stroke::Thin, ink),
                    };
                    scene.line(&from, &to, stroke, ink);
                }
            }
        }
    }

    /// The solid parts as they stood at `state`, dotted.
    pub(super) fn solids_before(&self, state: &State, scene: &mut Scene) {
        let (stroke, ink) = (Stroke::Dotted(2), Ink::Strong(Role::Ghost));
        for line in self.shape.solids.iter().flat_map(|solid| &solid.lines) {
            for (from, to) in pieces(line, state) {
                scene.line(&from, &to, stroke, ink);
            }
        }
    }
}

/// The straight pieces of a line, in the world at `state`.
fn pieces(line: &Polyline, state: &State) -> Vec<(Vector3<f64>, Vector3<f64>)> {
    let turned: Vec<_> = line
        .points
        .iter()
        .map(|at| state.orientation * at)
        .collect();
    turned.windows(2).map(|pair| (pair[0], pair[1])).collect()
}
