//! The room that the scene needs.

use super::{CHANGE, GROUND, MOMENTUM, STAND, Subject};
use crate::observe::camera::Zoom;
use crate::observe::recording::Curve;
use crate::tui::scene::Shown;

/// Tilts are rounded to multiples of this, degrees, so that the scale does not change all the time.
const TILT_DEG: f64 = 5.0;
/// Margin around what is drawn, as a share of it, for letters.
const MARGIN: f64 = 1.06;

impl Subject<'_> {
    /// The room that the scene needs: for the body as it precesses at the tilts that it has had, for L, and for the
    /// ground.
    pub(super) fn shown(&self) -> Shown {
        let tilts = self.run.recording().whole();
        let tilts = tilts.map_or((0.0, 0.0), |whole| {
            let tilt = whole.extent(Curve::Tilt);
            (tilt.min, tilt.max)
        });
        let (first, last) = ((tilts.0 / TILT_DEG).floor(), (tilts.1 / TILT_DEG).ceil());
        // Circles about the vertical, radius and height.
        let ground = GROUND * self.reach;
        let mut circles = if self.stands() {
            vec![(ground, -STAND * self.reach)]
        } else {
            vec![(ground, 0.0), (0.0, ground)] // z too has a letter
        };
        for tilt in first as i32..=last as i32 {
            let (sin, cos) = (f64::from(tilt) * TILT_DEG).to_radians().sin_cos();
            for &(across, height) in &self.shape.corners {
                let sides = [across, -across];
                let circle =
                    |side: f64| ((height * sin + side * cos).abs(), height * cos - side * sin);
                circles.extend(sides.map(circle));
            }
        }
        for other in [self.ghost, self.pinned].into_iter().flatten() {
            if let Some(whole) = other.recording().whole() {
                let z = whole.extent(Curve::Z);
                circles.extend([z.min, z.max].map(|z| (other.path().radius(), z)));
            }
        }
        let momentum = self.state.momentum;
        if let Some(axis) = momentum.try_normalize(f64::MIN_POSITIVE) {
            let angle = libm::acos(axis.z.clamp(-1.0, 1.0)).to_degrees() / (3.0 * TILT_DEG);
            for angle in [angle.floor(), angle.ceil()] {
                let (sin, cos) = (angle * 3.0 * TILT_DEG).to_radians().sin_cos();
                let length = MOMENTUM * self.arm;
                circles.push(((length * sin).hypot(CHANGE * self.reach), length * cos));
            }
        }
        let (sin, cos) = self.view.camera.pitch_deg.to_radians().sin_cos();
        let lowest = circles
            .iter()
            .map(|(radius, z)| z * cos - radius * sin.abs());
        let highest = circles
            .iter()
            .map(|(radius, z)| z * cos + radius * sin.abs());
        let (lowest, highest) = (lowest.fold(0.0, f64::min), highest.fold(0.0, f64::max));
        let widest = circles
            .iter()
            .map(|(radius, _)| *radius)
            .fold(0.0, f64::max);
        let zoom = self.view.zoom.three_d;
        let half = (
            MARGIN * widest / zoom,
            MARGIN * 0.5 * (highest - lowest) / zoom,
        );
        let middle = if zoom > 1.0 {
            let (right, up) = self.view.camera.project(&self.wheel());
            (Zoom::middle(right, half.0), Zoom::middle(up, half.1))
        } else {
            (0.0, 0.5 * (lowest + highest))
        };
        Shown {
            middle,
            half,
            reach: self.reach,
        }
    }
}
