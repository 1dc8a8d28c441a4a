//! The body in the scene: axle, hub, spokes, rim and masses, of which some are near and some are far.

use super::{PARTS, Subject};
use crate::physics::State;
use crate::tui::dots::Ink;
use crate::tui::scene::{Scene, Stroke};
use crate::tui::theme::Role;
use nalgebra::Vector3;
use std::f64::consts::TAU;

/// Where the spoke begins, of the radius of the rim.
const HUB: f64 = 0.14;
/// The hub. It is no letter, as those stand for vectors and masses.
pub(super) const HUB_SIGN: &str = "■";
/// A mass is near or far where it is nearer or farther than the hub by this part of the rim's radius.
const NEAR: f64 = 0.33;
/// The least distance of the signs of masses on the rim, cells.
const CLOSEST: f64 = 2.0;

/// A sign, its role and its cell.
type Sign = (&'static str, Role, (u16, u16));

impl Subject<'_> {
    /// The axle from the pivot to its top, hub, spokes and rim, and what joins free masses to the axle.
    pub(super) fn body(&self, scene: &mut Scene) {
        let state = self.state;
        let axle = state.axle();
        let (foot, top) = self.shape.axle;
        scene.rod(&(axle * foot), &(axle * top), Ink::Strong(Role::Focus));
        for at in &self.shape.free {
            let foot = axle * at.z;
            scene.line(
                &foot,
                &(state.orientation * at),
                Stroke::Dotted(2),
                Ink::Strong(Role::Text),
            );
        }
        self.solids(scene);
        if let Some((radius, height, points)) = self.shape.rim {
            let middle = scene.depth(&(axle * height));
            let look = |depth: f64| match is_near(depth, middle, radius) {
                Some(true) => (Stroke::Thick, Ink::Strong(Role::Text)),
                None => (Stroke::Thin, Ink::Strong(Role::Text)),
                Some(false) => (Stroke::Thin, Ink::Faint(Role::Quiet)),
            };
            scene.ring(&circle(state, radius, height), look);
            // One spoke only: it shows that the wheel turns, and more of them would hide the axle.
            let at = on_circle(state, radius, height, 0, points);
            let hub = on_circle(state, HUB * radius, height, 0, points);
            scene.line(&hub, &at, Stroke::Thin, Ink::Strong(Role::Text));
        }
    }

    /// The wheel and the axle as they stood at `state`, dotted, and the way of one of the masses since then.
    pub(super) fn body_before(&self, state: &State, scene: &mut Scene) {
        let (stroke, ink) = (Stroke::Dotted(2), Ink::Strong(Role::Ghost));
        let axle = state.axle();
        let (foot, top) = self.shape.axle;
        scene.line(&(axle * foot), &(axle * top), stroke, ink);
        if let Some((radius, height, points)) = self.shape.rim {
            scene.ring(&circle(state, radius, height), |_| (stroke, ink));
            let spoke = on_circle(state, radius, height, 0, points);
            scene.line(&(axle * height), &spoke, stroke, ink);
        }
        for at in &self.shape.free {
            let foot = axle * at.z;
            scene.line(&foot, &(state.orientation * at), stroke, ink);
        }
        self.solids_before(state, scene);
    }

    /// The masses, the nearest last: a larger sign is nearer; and the hub, which no mass covers.
    pub(super) fn masses(&self, scene: &Scene) -> Vec<Sign> {
        let middle = scene.depth(&self.wheel());
        let radius = self.shape.rim.map_or(self.reach, |(radius, ..)| radius);
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
        let hub = self.wheel();
        let has_hub = self.shape.rim.is_some() && scene.shows(&hub);
        let hub = has_hub.then(|| (HUB_SIGN, Role::Heading, scene.cell(&hub)));
        signs.chain(hub).collect()
    }

    pub(super) fn masses_before(&self, state: &State, scene: &Scene) -> Vec<Sign> {
        let masses = self.places_of_masses(state, scene);
        let sign = |at: &Vector3<f64>| ("°", Role::Ghost, scene.cell(at));
        masses.iter().map(sign).collect()
    }

    /// Where the masses are at `state`: those in the picture, and those of the rim only if their signs have room there.
    fn places_of_masses(&self, state: &State, scene: &Scene) -> Vec<Vector3<f64>> {
        let mut masses: Vec<Vector3<f64>> = Vec::new();
        if let Some((rim, height, points)) = self.shape.rim {
            // From the side the rim is at least as long as twice its width.
            let length = 4.0 * rim * scene.scale.1 / self.view.marker.dots().1 as f64;
            if length * 2.0 >= CLOSEST * points as f64 {
                masses
                    .extend((0..points).map(|point| on_circle(state, rim, height, point, points)));
            }
        }
        masses.extend(self.shape.free.iter().map(|at| state.orientation * at));
        masses.retain(|at| scene.shows(at));
        masses
    }

    /// The middle of the wheel, or the axle's top where there is none.
    pub(super) fn wheel(&self) -> Vector3<f64> {
        let height = self
            .shape
            .rim
            .map_or(self.shape.axle.1, |(_, height, _)| height);
        self.state.axle() * height
    }
}

/// Whether something is in front of `middle`, behind it, or beside it, by `depth`.
fn is_near(depth: f64, middle: f64, radius: f64) -> Option<bool> {
    let share = (depth - middle) / radius;
    (share.abs() > NEAR).then_some(share < 0.0)
}

/// The place of `point` of `points` on a circle across the axle.
fn on_circle(state: &State, radius: f64, height: f64, point: usize, points: usize) -> Vector3<f64> {
    let (sin, cos) = (TAU * point as f64 / points as f64).sin_cos();
    state.orientation * Vector3::new(radius * cos, radius * sin, height)
}

fn circle(state: &State, radius: f64, height: f64) -> Vec<Vector3<f64>> {
    (0..PARTS)
        .map(|part| on_circle(state, radius, height, part, PARTS))
        .collect()
}
