//! The parallel projection of the world onto a picture, along a direction that the user turns.

use crate::engine::scenario::kind::{PITCH_DEG, ZOOM_RANGE};
use crate::engine::text::nice_numbers;
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Camera {
    /// Angle about +z from −y, degrees: at 0 the picture's right is +x and its depth +y.
    pub yaw_deg: f64,
    /// Height of the eye above the horizontal, degrees, −90 to 90.
    pub pitch_deg: f64,
}

/// The height of the eye for an axle that is seen aslant, degrees: the floor is an open ellipse.
const ASLANT_PITCH_DEG: f64 = 24.0;
/// The direction to which the camera turns an axle: this angle from the picture's right towards the eye, degrees. The
/// axle is then seen at its length, and the wheel across it shows its face.
const ASIDE_DEG: f64 = 14.0;
/// The least share of an axle's lean that is seen to the side, and not towards the eye or away from it.
const LEAST_ASIDE: f64 = 0.8;
/// The least width of a wheel's ellipse, as a share of its length.
const OPEN_WHEEL: f64 = 0.15;
/// An axle nearer to the vertical than this, degrees, is seen from every side alike.
const UPRIGHT_DEG: f64 = 8.0;
/// Directions that are chosen are multiples of this, degrees.
const NOTCH_DEG: f64 = 2.0;

/// The enlargement of the pictures in space: 1 where a picture shows the whole.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Zoom {
    pub above: f64,
    #[serde(rename = "3d")]
    pub three_d: f64,
}

impl Default for Zoom {
    fn default() -> Self {
        Self {
            above: 1.0,
            three_d: 1.0,
        }
    }
}

impl Zoom {
    /// `zoom` moved by `rungs` on the ladder 1, 2, 5, ..., down if negative; `None` if it is at its limit already.
    pub fn shifted(zoom: f64, rungs: i32) -> Option<f64> {
        let next = nice_numbers::climbed(zoom, rungs).clamp(ZOOM_RANGE.0, ZOOM_RANGE.1);
        (next != zoom).then_some(next)
    }

    /// The middle of a picture that reaches `half` to each side and shows a point at `at`. It is a multiple of `half`, so
    /// that the picture stands still while the point moves, and the point is at most half of `half` away from it.
    pub fn middle(at: f64, half: f64) -> f64 {
        (at / half).round() * half
    }
}

impl Default for Camera {
    fn default() -> Self {
        Self {
            yaw_deg: 30.0,
            pitch_deg: 20.0,
        }
    }
}

impl Camera {
    /// Turns the viewing direction by these angles, degrees; the pitch stays within −90 to 90.
    pub fn turn(&mut self, yaw_deg: f64, pitch_deg: f64) {
        self.yaw_deg = (self.yaw_deg + yaw_deg).rem_euclid(360.0);
        self.pitch_deg = (self.pitch_deg + pitch_deg).clamp(PITCH_DEG.0, PITCH_DEG.1);
    }

    /// Returns the camera from which `axle` (a direction, world frame) is seen aslant: leaning to the right, and a little
    /// towards the eye.
    pub fn aslant(self, axle: &Vector3<f64>) -> Self {
        let azimuth_deg = libm::atan2(axle.y, axle.x).to_degrees();
        let yaw_deg = ((azimuth_deg + ASIDE_DEG) / NOTCH_DEG).round() * NOTCH_DEG;
        Self {
            yaw_deg: if is_upright(axle) || yaw_deg.is_nan() {
                self.yaw_deg
            } else {
                yaw_deg.rem_euclid(360.0) + 0.0 // no negative zero
            },
            pitch_deg: ASLANT_PITCH_DEG,
        }
    }

    /// Returns true if it is seen how far `axle` leans, and the wheel across it is not seen as a line.
    pub fn reads(&self, axle: &Vector3<f64>) -> bool {
        let (right, _) = self.project(axle);
        let leans_aside = is_upright(axle) || right.abs() >= LEAST_ASIDE * axle.xy().norm();
        leans_aside && self.view().depth(axle).abs() >= OPEN_WHEEL * axle.norm()
    }

    /// Its sines and cosines: for many points in turn. The same on every machine.
    pub fn view(&self) -> CameraView {
        let (sin_yaw, cos_yaw) = libm::sincos(self.yaw_deg.to_radians());
        let (sin_pitch, cos_pitch) = libm::sincos(self.pitch_deg.to_radians());
        CameraView {
            sin_yaw,
            cos_yaw,
            sin_pitch,
            cos_pitch,
        }
    }

    /// Where `point` (world frame, m) stands in the picture: right and up, m.
    pub fn project(&self, point: &Vector3<f64>) -> (f64, f64) {
        self.view().project(point)
    }
}

fn is_upright(axle: &Vector3<f64>) -> bool {
    axle.xy().norm() < libm::sin(UPRIGHT_DEG.to_radians()) * axle.norm()
}

/// A camera whose angles are known by their sines and cosines.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraView {
    sin_yaw: f64,
    cos_yaw: f64,
    sin_pitch: f64,
    cos_pitch: f64,
}

impl CameraView {
    pub fn project(&self, point: &Vector3<f64>) -> (f64, f64) {
        let right = self.cos_yaw * point.x + self.sin_yaw * point.y;
        let depth = self.cos_yaw * point.y - self.sin_yaw * point.x;
        (right, self.cos_pitch * point.z + self.sin_pitch * depth)
    }

    /// The direction to the picture's right, world frame.
    pub fn right(&self) -> Vector3<f64> {
        Vector3::new(self.cos_yaw, self.sin_yaw, 0.0)
    }

    /// How much farther from the eye than the pivot `point` (world frame, m) is, m.
    pub fn depth(&self, point: &Vector3<f64>) -> f64 {
        let depth = self.cos_yaw * point.y - self.sin_yaw * point.x;
        self.cos_pitch * depth - self.sin_pitch * point.z
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn from_above_y_is_up_and_from_the_side_z_is() {
        let at = Vector3::new(1.0, 2.0, 3.0);
        let seen = |pitch_deg| {
            let view = Camera {
                yaw_deg: 0.0,
                pitch_deg,
            }
            .view();
            (view.project(&at), view.depth(&at))
        };
        let ((right, up), _) = seen(90.0);
        assert!((right - 1.0).abs() < 1e-15 && (up - 2.0).abs() < 1e-15);
        assert_eq!(seen(0.0), ((1.0, 3.0), 2.0));
    }
}
