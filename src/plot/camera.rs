//! The parallel projection of the world onto a picture, in a direction that the user can turn.

use crate::engine::scenario::kind::{PITCH_DEG, ZOOM_RANGE};
use crate::engine::text::nice_numbers;
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Camera {
    /// Angle about +z from −y, degrees. At 0, the picture's right is +x and its depth is +y.
    pub yaw_deg: f64,
    /// Elevation of the eye above the horizontal, degrees, −90 to 90.
    pub pitch_deg: f64,
}

/// Elevation of the eye for an oblique view of the axle, degrees. The floor appears as an open ellipse.
const ASLANT_PITCH_DEG: f64 = 24.0;
/// Angle from the picture's right toward the eye, to which the camera turns an axle, degrees. The axle then shows its
/// length, and the wheel shows its face.
const ASIDE_DEG: f64 = 14.0;
/// Minimum fraction of an axle's lean that must be visible sideways, not toward or away from the eye.
const LEAST_ASIDE: f64 = 0.8;
/// Minimum width of a wheel's ellipse, relative to its length.
const OPEN_WHEEL: f64 = 0.15;
/// An axle closer to the vertical than this, degrees, looks the same from every side.
const UPRIGHT_DEG: f64 = 8.0;
/// Chosen directions are multiples of this angle, degrees.
const NOTCH_DEG: f64 = 2.0;

/// Magnification of the pictures in space; 1 shows the whole scene.
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
    /// Moves `zoom` by `rungs` on the ladder 1, 2, 5, ..., down if negative. Returns `None` if it is already at its
    /// limit.
    pub fn shifted(zoom: f64, rungs: i32) -> Option<f64> {
        let next = nice_numbers::climbed(zoom, rungs).clamp(ZOOM_RANGE.0, ZOOM_RANGE.1);
        (next != zoom).then_some(next)
    }

    /// Returns the center of a picture with half-width `half` that shows the point `at`. The center is a multiple of
    /// `half`, so that the picture does not move with the point. The point is at most `half`/2 away from it.
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
    /// Turns the viewing direction by these angles, degrees. The pitch stays within −90 to 90.
    pub fn turn(&mut self, yaw_deg: f64, pitch_deg: f64) {
        self.yaw_deg = (self.yaw_deg + yaw_deg).rem_euclid(360.0);
        self.pitch_deg = (self.pitch_deg + pitch_deg).clamp(PITCH_DEG.0, PITCH_DEG.1);
    }

    /// Returns a camera with an oblique view of `axle` (a direction, world frame), which leans to the right and
    /// slightly toward the eye.
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

    /// Returns true if the lean of `axle` is visible and the wheel does not appear as a line.
    pub fn reads(&self, axle: &Vector3<f64>) -> bool {
        let (right, _) = self.project(axle);
        let leans_aside = is_upright(axle) || right.abs() >= LEAST_ASIDE * axle.xy().norm();
        leans_aside && self.view().depth(axle).abs() >= OPEN_WHEEL * axle.norm()
    }

    /// Computes the sines and cosines once for many points. They are the same on every machine.
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

    /// Projects `point` (world frame, m) onto the picture: right and up, m.
    pub fn project(&self, point: &Vector3<f64>) -> (f64, f64) {
        self.view().project(point)
    }
}

fn is_upright(axle: &Vector3<f64>) -> bool {
    axle.xy().norm() < libm::sin(UPRIGHT_DEG.to_radians()) * axle.norm()
}

/// A camera given by the sines and cosines of its angles.
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

    /// Returns the direction of the picture's right, world frame.
    pub fn right(&self) -> Vector3<f64> {
        Vector3::new(self.cos_yaw, self.sin_yaw, 0.0)
    }

    /// Returns the additional distance of `point` (world frame, m) from the eye compared with the pivot, m.
    pub fn depth(&self, point: &Vector3<f64>) -> f64 {
        let depth = self.cos_yaw * point.y - self.sin_yaw * point.x;
        self.cos_pitch * depth - self.sin_pitch * point.z
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn y_is_up_from_above_and_z_from_the_side() {
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
