//! The scale of the 3-D view: it shows the solid that the body sweeps as it precesses at all its tilts. The picture
//! thus does not move while the body does.

use super::super::PlotInputs;
use super::super::gravity_motion::predicted_tilts_deg;
use super::SMALL_COLUMNS;
use super::arrows::{MOMENTUM_ARROW_LENGTH, TORQUE_ARROW_LENGTH};
use super::body::DrawnBody;
use crate::engine::recording::RecordedCurve;
use crate::lab::view::View;
use crate::lab::view::theme::Marker;
use crate::plot::camera::Zoom;
use crate::tui::plane::Plane;
use nalgebra::Vector3;
use ratatui::layout::Rect;

/// Tilts are rounded to multiples of this angle, degrees, so that the scale does not change all the time.
const TILT_DEG: f64 = 2.5;
/// Maximum distance of a tilt from such a multiple, degrees, at which the next one is shown too.
const TILT_SLACK_DEG: f64 = 0.75;
/// Distance of the floor below everything, and minimum radius of the circle on it, in lengths of the axle.
const FLOOR_GAP: f64 = 0.16;
const LEAST_FLOOR: f64 = 0.35;
/// Fine dots kept free for labels: at the sides, at the sides of a small pane, and above.
const SIDE_DOTS: f64 = 4.0;
const SMALL_SIDE_DOTS: f64 = 3.0;
const TOP_DOTS: f64 = 5.0;

/// Everything that the view may show, as circles about the vertical.
pub struct Swept {
    /// Radius and height of each circle, m.
    circles: Vec<(f64, f64)>,
    pub floor_z: f64,
    pub floor_radius: f64,
}

impl Swept {
    pub fn new(seen: &PlotInputs<'_>, shape: &DrawnBody, arm: f64) -> Self {
        let tilts = tilts_deg(seen);
        let mut circles = Vec::new();
        for tilt_deg in &tilts {
            let (sin, cos) = libm::sincos(tilt_deg.to_radians());
            for &(across, height) in &shape.corners {
                circles.extend([across, -across].map(|side| {
                    let radius = height * sin + side * cos;
                    (radius.abs(), height * cos - side * sin)
                }));
            }
        }
        let traced = seen.run.scenario().arm_m();
        let of_traced = tilts
            .iter()
            .map(|tilt| traced * libm::sin(tilt.to_radians()).abs());
        let others = [seen.ghost, seen.pinned].into_iter().flatten();
        let radii = others
            .clone()
            .map(|other| other.path.radius)
            .chain(of_traced);
        for other in others {
            if let Some(whole) = other.recording.whole() {
                let z = whole.extent(RecordedCurve::Z);
                circles.extend([z.min, z.max].map(|z| (other.path.radius, z)));
            }
        }
        let floor_radius = radii.fold(LEAST_FLOOR * arm, f64::max);
        let lowest = circles.iter().map(|circle| circle.1).fold(0.0, f64::min);
        let floor_z = lowest - FLOOR_GAP * arm;
        circles.push((floor_radius, floor_z));
        circles.extend(momentum_circles(seen, arm));
        Self {
            circles,
            floor_z,
            floor_radius,
        }
    }

    /// Returns the plane of the picture that shows everything. If magnified, it is centered on `wheel` (world frame, m)
    /// as far as possible.
    pub fn plane(&self, picture: Rect, view: &View, wheel: &Vector3<f64>) -> Plane {
        let (sin, cos) = libm::sincos(view.camera.pitch_deg.to_radians());
        let end = |side: f64| move |&(radius, z): &(f64, f64)| z * cos + side * radius * sin.abs();
        let lowest = self.circles.iter().map(end(-1.0)).fold(0.0, f64::min);
        let highest = self.circles.iter().map(end(1.0)).fold(0.0, f64::max);
        let widest = self
            .circles
            .iter()
            .map(|circle| circle.0)
            .fold(0.0, f64::max);
        let zoom = view.look.zoom.three_d;
        let (width, height) = (
            2.0 * f64::from(picture.width),
            4.0 * f64::from(picture.height),
        );
        let side = if picture.width < SMALL_COLUMNS {
            SMALL_SIDE_DOTS
        } else {
            SIDE_DOTS
        };
        let half = (
            widest / zoom * width / (width - 2.0 * side).max(1.0),
            0.5 * (highest - lowest) / zoom * height / (height - TOP_DOTS).max(1.0),
        );
        let middle = if zoom > 1.0 {
            let (right, up) = view.camera.project(wheel);
            (Zoom::middle(right, half.0), Zoom::middle(up, half.1))
        } else {
            (0.0, 0.5 * (lowest + highest))
        };
        let mut plane = Plane::new(picture, Marker::Braille, middle, half);
        plane.middle.1 += 0.5 * TOP_DOTS / plane.scale.1;
        plane
    }
}

/// Returns the tilts that the body has had, or will have under gravity, in steps, degrees.
fn tilts_deg(seen: &PlotInputs<'_>) -> Vec<f64> {
    let (recording, _) = seen.run.pictures();
    let recorded = recording.whole().map(|whole| {
        let tilt = whole.extent(RecordedCurve::Tilt);
        (tilt.min, tilt.max)
    });
    let known = [recorded, predicted_tilts_deg(seen.run.scenario())];
    let (mut low, mut high) = (180.0_f64, 0.0_f64);
    for (least, most) in known.into_iter().flatten() {
        (low, high) = (low.min(least), high.max(most));
    }
    let (first, last) = (
        ((low - TILT_SLACK_DEG) / TILT_DEG).floor() as i32,
        ((high + TILT_SLACK_DEG) / TILT_DEG).ceil() as i32,
    );
    (first..=last)
        .map(|tilt| f64::from(tilt) * TILT_DEG)
        .collect()
}

/// Returns the circles of the tip of L and of the torque at it: radius and height, m.
fn momentum_circles(seen: &PlotInputs<'_>, arm: f64) -> Vec<(f64, f64)> {
    let momentum = match seen.reading {
        Some(reading) => reading.state.momentum,
        None => seen.run.simulation().state().momentum,
    };
    let Some(axis) = momentum.try_normalize(f64::MIN_POSITIVE) else {
        return Vec::new();
    };
    let tilt_deg = libm::acos(axis.z.clamp(-1.0, 1.0)).to_degrees();
    let [lower, upper] = [-TILT_SLACK_DEG, TILT_SLACK_DEG].map(|slack| tilt_deg + slack);
    let ends = [(lower / TILT_DEG).floor(), (upper / TILT_DEG).ceil()];
    let circles = ends.map(|tilt| {
        let (sin, cos) = libm::sincos((tilt * TILT_DEG).to_radians());
        let length = MOMENTUM_ARROW_LENGTH * arm;
        let radius = libm::hypot(length * sin, TORQUE_ARROW_LENGTH * arm);
        (radius, length * cos)
    });
    circles.into()
}
