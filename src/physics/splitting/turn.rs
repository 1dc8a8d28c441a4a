//! Rotation by a rotation vector (Rodrigues' formula), without a square root for angles up to a quarter turn.

use nalgebra::{Matrix3, Vector3};

use crate::trig::sin_cos;

/// Up to this square of the angle the series are used (an angle of 1.41).
const SERIES_END: f64 = 2.0;

/// The rotation by a rotation vector w: v + s w x v + c w x (w x v), s = sin|w| / |w|, c = (1 - cos|w|) / |w|^2.
#[derive(Clone, Copy, Debug)]
pub struct RotationByVector {
    /// Axis times angle, rad.
    pub vector: Vector3<f64>,
    sine: f64,
    versine: f64,
}

impl RotationByVector {
    /// `vector`: axis times angle, rad.
    #[inline]
    pub fn new(vector: Vector3<f64>) -> Self {
        let square = vector.x * vector.x + vector.y * vector.y + vector.z * vector.z;
        let (sine, versine) = if square <= SERIES_END {
            series(square)
        } else {
            closed(square)
        };
        Self {
            vector,
            sine,
            versine,
        }
    }

    /// The vector turned.
    #[inline]
    pub fn apply(&self, v: Vector3<f64>) -> Vector3<f64> {
        let across = self.vector.cross(&v);
        v + across * self.sine + self.vector.cross(&across) * self.versine
    }

    /// Every column turned.
    #[inline]
    pub fn apply_to_columns(&self, m: &Matrix3<f64>) -> Matrix3<f64> {
        Matrix3::from_columns(&[0, 1, 2].map(|j| self.apply(m.column(j).into())))
    }
}

/// Both factors as polynomials in the square of the angle: minimax fits (Remez), errors below 3e-17.
/// Only the square is needed, so nothing waits for a square root, a division and a reduction of the argument.
#[inline]
fn series(z: f64) -> (f64, f64) {
    let zz = z * z;
    let s = (-0.1666666666666657 + 0.008333333333321188 * z)
        + zz * (-0.0001984126983603416 + 2.75573181536637e-6 * z);
    let s_high = (-2.5051991317864326e-8 + 1.6052000857008033e-10 * z) - 7.427069524982516e-13 * zz;
    let c = (-0.041666666666666616 + 0.0013888888888882313 * z)
        + zz * (-2.480158729872942e-5 + 2.755731863649858e-7 * z);
    let c_high = (-2.087669245587818e-9 + 1.1466849765275946e-11 * z) - 4.657392265163401e-14 * zz;
    let z4 = zz * zz;
    (1.0 + z * (s + z4 * s_high), 0.5 + z * (c + z4 * c_high))
}

#[inline]
fn closed(square: f64) -> (f64, f64) {
    let angle = square.sqrt();
    let (sine, cosine) = sin_cos(angle);
    (sine / angle, (1.0 - cosine) / square)
}
