//! The parallel projection of the world onto a picture, along a direction that the user turns.

use nalgebra::Vector3;

/// The direction from which the picture shows the scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Angle about +z from −y, degrees: at 0 the picture's right is +x and its depth +y.
    pub yaw_deg: f64,
    /// Height of the eye above the horizontal, degrees, −90 to 90.
    pub pitch_deg: f64,
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
        self.pitch_deg = (self.pitch_deg + pitch_deg).clamp(-90.0, 90.0);
    }

    /// Where `point` (world frame, m) stands in the picture: right and up, m.
    pub fn project(&self, point: &Vector3<f64>) -> (f64, f64) {
        let (sin_yaw, cos_yaw) = self.yaw_deg.to_radians().sin_cos();
        let (sin_pitch, cos_pitch) = self.pitch_deg.to_radians().sin_cos();
        let right = cos_yaw * point.x + sin_yaw * point.y;
        let depth = cos_yaw * point.y - sin_yaw * point.x;
        (right, cos_pitch * point.z + sin_pitch * depth)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn from_above_x_is_right_and_y_is_up() {
        let above = Camera {
            yaw_deg: 0.0,
            pitch_deg: 90.0,
        };
        let (right, up) = above.project(&Vector3::new(1.0, 2.0, 3.0));
        assert!((right - 1.0).abs() < 1e-15 && (up - 2.0).abs() < 1e-15);
    }

    #[test]
    fn from_the_side_z_is_up() {
        let side = Camera {
            yaw_deg: 0.0,
            pitch_deg: 0.0,
        };
        assert_eq!(side.project(&Vector3::new(1.0, 2.0, 3.0)), (1.0, 3.0));
    }
}
