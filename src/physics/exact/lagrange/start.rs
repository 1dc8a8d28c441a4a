//! The state at the start, in the frame along the vertical of the load.

use crate::exact::turning::TurningStart;
use nalgebra::{Complex, Matrix3, Quaternion, Rotation3, UnitQuaternion, Vector3};

/// The direction that the energy and the constant part of L refer to, of a length near one: against the load, or along L
/// for a free top.
pub(super) fn up(load: Vector3<f64>, momentum: Vector3<f64>, axle: Vector3<f64>) -> Vector3<f64> {
    let candidates = [-load, momentum, axle];
    let up = candidates
        .into_iter()
        .find(|v| v.amax() != 0.0)
        .unwrap_or(axle);
    // Scaled by a power of two, which is exact: products of its components then neither vanish nor overflow.
    let (_, exponent) = libm::frexp(up.amax());
    up.map(|x| libm::scalbn(x, -exponent))
}

/// The shortest turn that brings the third axis along `up`, by way of a flip if that is below the horizon.
pub(super) fn frame_along(up: Vector3<f64>) -> UnitQuaternion<f64> {
    if up.z >= 0.0 {
        UnitQuaternion::new_normalize(Quaternion::new(1.0 + up.z, -up.y, up.x, 0.0))
    } else {
        UnitQuaternion::new_normalize(Quaternion::new(-up.y, 1.0 - up.z, 0.0, up.x))
    }
}

/// `orientation`, a rotation matrix, as a quaternion.
pub(super) fn quaternion(orientation: Matrix3<f64>) -> UnitQuaternion<f64> {
    UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(orientation))
}

/// The frame along the vertical, with the exact vector `up` that it is rounded from.
#[derive(Clone, Copy)]
pub(super) struct InFrame {
    pub vertical: UnitQuaternion<f64>,
    pub up: Vector3<f64>,
}

impl InFrame {
    /// Horizontal part of `v` as x + i y, to full relative accuracy: a small tilt is as well known as a large one.
    fn level(&self, v: Vector3<f64>) -> Complex<f64> {
        let across = self.vertical.inverse() * (cross(self.up, v) / self.up.norm());
        Complex::new(across.y, -across.x)
    }

    fn vertical_part(&self, v: Vector3<f64>) -> f64 {
        self.up.dot(&v) / self.up.norm()
    }
}

/// a x b with each component to full relative accuracy.
fn cross(a: Vector3<f64>, b: Vector3<f64>) -> Vector3<f64> {
    Vector3::new(
        difference_of_products(a.y, b.z, a.z, b.y),
        difference_of_products(a.z, b.x, a.x, b.z),
        difference_of_products(a.x, b.y, a.y, b.x),
    )
}

/// a b - c d without loss when the products nearly cancel (Kahan; C.-P. Jeannerod et al., Math. Comp. 82 (2013) 2245).
fn difference_of_products(a: f64, b: f64, c: f64, d: f64) -> f64 {
    let product = c * d;
    libm::fma(a, b, -product) + libm::fma(-c, d, product)
}

/// The state at the start, in the frame along the vertical.
pub(super) fn start_in(
    across: f64,
    load: Vector3<f64>,
    frame: &InFrame,
    axle: Vector3<f64>,
    momentum: Vector3<f64>,
) -> TurningStart {
    let level = frame.level(axle) / axle.norm();
    let rise = frame.vertical_part(axle) / axle.norm();
    // The larger part of the axle follows the smaller one: a length off by rounding would pass for a tilt.
    let height = if level.norm_sqr() < 0.5 {
        (1.0 - level.norm_sqr()).sqrt().copysign(rise)
    } else {
        rise
    };
    TurningStart {
        pull: load.norm() / across,
        axle: level,
        height,
        spin: frame.level(momentum) / across,
        spin_vertical: frame.vertical_part(momentum) / across,
    }
}

/// alpha and beta at the start; the smaller one from the axle, which knows it to full relative accuracy.
pub(super) fn cayley_klein(
    start: &TurningStart,
    turn: UnitQuaternion<f64>,
) -> (Complex<f64>, Complex<f64>) {
    let half_i_axle = start.axle * Complex::new(0.0, 0.5);
    if start.height > 0.0 {
        let direction = Complex::new(turn.w, turn.k);
        let alpha =
            direction * ((1.0 - 0.5 * start.below_top()).sqrt() / direction.norm_sqr().sqrt());
        (alpha, half_i_axle / alpha)
    } else {
        let direction = Complex::new(turn.i, turn.j);
        let beta =
            direction * ((1.0 - 0.5 * start.above_bottom()).sqrt() / direction.norm_sqr().sqrt());
        (half_i_axle / beta, beta)
    }
}
