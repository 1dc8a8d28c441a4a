//! Rotation matrices by the report's formula, with compiled-in sine and cosine.

use super::trig;
use nalgebra::{Matrix3, Vector3};

/// Returns \[v\]× times `matrix`: v × each of its columns.
#[inline]
pub fn crossed(v: &Vector3<f64>, matrix: &Matrix3<f64>) -> Matrix3<f64> {
    Matrix3::from_columns(&[0, 1, 2].map(|j| v.cross(&matrix.column(j))))
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct AxisAngle {
    /// A unit vector.
    pub axis: Vector3<f64>,
    pub angle: f64,
    pub sine: f64,
    pub cosine: f64,
}

impl AxisAngle {
    /// About `vector` by the angle |`vector`| · `time`; `None` for the zero vector, which has no direction.
    #[inline]
    pub fn new(vector: &Vector3<f64>, time: f64) -> Option<Self> {
        let length = vector.norm();
        if length == 0.0 {
            return None;
        }
        let angle = length * time;
        // Before sine and cosine, for which the matrix waits longest: the division is done beside them.
        let axis = vector * (1.0 / length);
        let (sine, cosine) = trig::sin_cos(angle);
        Some(Self {
            axis,
            angle,
            sine,
            cosine,
        })
    }

    /// P = uuᵀ: what of a vector lies along the axis.
    #[inline]
    pub fn projection(&self) -> Matrix3<f64> {
        let u = self.axis;
        let (xy, xz, yz) = (u.x * u.y, u.x * u.z, u.y * u.z);
        Matrix3::new(u.x * u.x, xy, xz, xy, u.y * u.y, yz, xz, yz, u.z * u.z)
    }

    /// R = P + cos(E − P) + sin \[u\]× (report, section 3).
    #[inline]
    pub fn matrix(&self) -> Matrix3<f64> {
        let (u, sin, cos, p) = (self.axis, self.sine, self.cosine, self.projection());
        let (xx, yy, zz) = (p[(0, 0)], p[(1, 1)], p[(2, 2)]);
        let (xy, xz, yz) = (p[(0, 1)], p[(0, 2)], p[(1, 2)]);
        let (bxy, bxz, byz) = (xy - cos * xy, xz - cos * xz, yz - cos * yz);
        Matrix3::new(
            xx + cos * (1.0 - xx),
            bxy - sin * u.z,
            bxz + sin * u.y,
            bxy + sin * u.z,
            yy + cos * (1.0 - yy),
            byz - sin * u.x,
            bxz - sin * u.y,
            byz + sin * u.x,
            zz + cos * (1.0 - zz),
        )
    }
}

/// Returns the rotation about `vector` by the angle |`vector`| · `time`, rad, to a few units of rounding. The zero vector
/// gives the identity.
///
/// `about(&Vector3::x(), tilt)` tilts the upright axle towards −y; `about(&omega, dt)` is the rotation with the angular
/// velocity `omega` (rad/s) during `dt` (s).
pub fn about(vector: &Vector3<f64>, time: f64) -> Matrix3<f64> {
    AxisAngle::new(vector, time).map_or_else(Matrix3::identity, |turn| turn.matrix())
}

/// Returns a rotation near `matrix`: the column of the axle is normalized, and the others are made perpendicular to it. The
/// result is a rotation for any `matrix`.
pub fn straightened(matrix: &Matrix3<f64>) -> Matrix3<f64> {
    let axle = matrix.column(2).normalize();
    let x = matrix.column(0);
    let x = (x - axle * axle.dot(&x)).normalize();
    Matrix3::from_columns(&[x, axle.cross(&x), axle])
}
