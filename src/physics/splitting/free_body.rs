//! The free motion of a rigid body about its fixed point, exactly, for any time.
//!
//! Without torques L is constant in the world frame. A body with two equal moments turns twice: about its axis of
//! symmetry as it stands, and about L. One with three different moments moves by Jacobi's elliptic functions; what is
//! done here follows R. van Zon & J. Schofield, J. Comput. Phys. 225, 145 (2007) and E. Celledoni, F. Fasso,
//! N. Safstrom & A. Zanna, SIAM J. Sci. Comput. 30, 2084 (2008), with two differences: addition theorems start the
//! motion from where the body is, so that no initial phase has to be found (there is none on a principal axis), and the
//! functions treat the two sides of the separatrix alike (`jacobi`).

use nalgebra::{Matrix3, Vector3};

use super::jacobi::{Jacobi, carlson_rj};
use super::principal::{ROUNDING, principal_axes};
use super::turn::Turn;
use crate::trig::sin_cos;

/// A rigid body that turns about a fixed point without torque.
#[derive(Clone, Debug)]
pub enum FreeBody {
    /// Two principal moments are equal.
    Symmetric(SymmetricBody),
    /// All three differ.
    Lopsided(LopsidedBody),
}

impl FreeBody {
    /// `inertia` about the fixed point, body frame, kg m^2; symmetric and positive definite. Of any other matrix the
    /// motion is not a number.
    pub fn new(inertia: &Matrix3<f64>) -> Self {
        let (moments, axes) = principal_axes(inertia);
        let equal = |i: usize, j: usize| {
            (moments[i] - moments[j]).abs() <= ROUNDING * moments[i].max(moments[j])
        };
        // Equal to rounding is symmetric; the elliptic functions take over continuously. z first: a sphere's axis is then the axle.
        for (axis, i, j) in [(2, 0, 1), (1, 0, 2), (0, 1, 2)] {
            if equal(i, j) {
                return Self::Symmetric(SymmetricBody::new(
                    &moments,
                    axes.column(axis).into(),
                    [axis, i, j],
                ));
            }
        }
        Self::Lopsided(LopsidedBody::new(&moments, &axes))
    }

    /// Turns the body (`orientation`: body to world, orthonormal) by its free motion of `duration_s` (of either sign),
    /// `momentum` (about the fixed point, world frame, J s) staying as it is. The orientation stays orthonormal to
    /// rounding, which adds up over many calls until `orthonormal` takes it away.
    #[inline]
    pub fn advance(
        &self,
        orientation: &mut Matrix3<f64>,
        momentum: &Vector3<f64>,
        duration_s: f64,
    ) {
        match self {
            Self::Symmetric(body) => body.advance(orientation, momentum, duration_s),
            Self::Lopsided(body) => body.advance(orientation, momentum, duration_s),
        }
    }
}

/// A matrix that is orthonormal but for rounding, made so: one step of Newton's for the nearest one.
#[inline]
pub fn orthonormal(q: &Matrix3<f64>) -> Matrix3<f64> {
    q * 1.5 - q * (q.tr_mul(q) * 0.5)
}

/// Two equal moments: I1 across the axis and I3 along it.
#[derive(Clone, Debug)]
pub struct SymmetricBody {
    /// Unit vector, body frame.
    pub axis: Vector3<f64>,
    /// 1 / I1, 1/(kg m^2): times L, the angular velocity of the axis.
    pub across: f64,
    /// 1 / I3 - 1 / I1, 1/(kg m^2): times L.axis, the spin over and above it.
    pub excess: f64,
}

impl SymmetricBody {
    fn new(moments: &Vector3<f64>, axis: Vector3<f64>, [along, i, j]: [usize; 3]) -> Self {
        // The mean of the inverses: over a turn of the body what is left of the difference cancels.
        let across = 0.5 * (1.0 / moments[i] + 1.0 / moments[j]);
        Self {
            axis,
            across,
            excess: 1.0 / moments[along] - across,
        }
    }

    #[inline]
    fn advance(&self, orientation: &mut Matrix3<f64>, momentum: &Vector3<f64>, duration_s: f64) {
        let axis = *orientation * self.axis;
        // L.axis from world vectors, as |L|: taken from body components the errors of a carried matrix would feed on themselves.
        let spin = Turn::new(axis * (self.excess * axis.dot(momentum) * duration_s));
        let precession = Turn::new(momentum * (self.across * duration_s));
        *orientation = precession.of_columns(&spin.of_columns(orientation));
    }
}

/// Three different moments, I1 < I2 < I3.
#[derive(Clone, Debug)]
pub struct LopsidedBody {
    /// Columns: the principal axes, body frame, by rising moments.
    axes: Matrix3<f64>,
    /// 1/I1 and 1/I3.
    e1: f64,
    e3: f64,
    /// 1/I1 - 1/I2, 1/I2 - 1/I3 and 1/I1 - 1/I3, all positive.
    e12: f64,
    e23: f64,
    e13: f64,
}

impl LopsidedBody {
    fn new(moments: &Vector3<f64>, axes: &Matrix3<f64>) -> Self {
        let mut order = [0, 1, 2];
        order.sort_by(|&i, &j| moments[i].total_cmp(&moments[j]));
        let [i1, i2, i3] = order.map(|i| moments[i]);
        let [a1, a2, _] = order.map(|i| axes.column(i).into_owned());
        Self {
            axes: Matrix3::from_columns(&[a1, a2, a1.cross(&a2)]),
            e1: 1.0 / i1,
            e3: 1.0 / i3,
            // Differences of the moments, not of their inverses: nothing is lost when two are nearly equal.
            e12: (i2 - i1) / (i1 * i2),
            e23: (i3 - i2) / (i2 * i3),
            e13: (i3 - i1) / (i1 * i3),
        }
    }

    fn advance(&self, orientation: &mut Matrix3<f64>, momentum: &Vector3<f64>, duration_s: f64) {
        let size = momentum.norm();
        // The only body that does not turn; below the smallest squares it turns by nothing, either.
        if size == 0.0 {
            return;
        }
        let start = (*orientation * self.axes).tr_mul(momentum);
        let polhode = Polhode::new(self, &start);
        let jacobi = Jacobi::new(duration_s, polhode.p, polhode.q, polhode.difference);
        let end = self.momentum_after(&start, &jacobi, size);
        let angle = size * polhode.steady_angle(self, duration_s, &jacobi);
        let about = about_first(
            angle,
            polhode.algebraic_turn(self, &start, &end, size, &jacobi),
        );
        let turn = frame(&start, polhode.node) * about * frame(&end, polhode.node).transpose();
        // Between the axes and their inverse: what rounding leaves of their not being orthonormal then turns nothing. It
        // is the same at every step, so that it would add up.
        *orientation = orthonormal(&(*orientation * (self.axes * turn * self.axes.transpose())));
    }

    /// L in the principal frame after the time of `jacobi`: the addition theorems of sn, cn, dn with the derivatives
    /// of Euler's equations in place of the amplitudes, which may vanish. All terms of the denominator are positive.
    fn momentum_after(&self, m: &Vector3<f64>, jacobi: &Jacobi, size: f64) -> Vector3<f64> {
        let Jacobi { s, c, d, .. } = *jacobi;
        let rate = Vector3::new(
            -self.e23 * m.y * m.z,
            self.e13 * m.z * m.x,
            -self.e12 * m.x * m.y,
        );
        let denominator = c * c + self.e23 * self.e13 * (m.z * s) * (m.z * s);
        let numerator = Vector3::new(
            m.x * c + rate.x * s * d,
            m.y * c * d + rate.y * s,
            m.z * d + rate.z * s * c,
        );
        let end = numerator / denominator;
        end * (size / end.norm())
    }
}

/// The principal axis (0 or 2) whose projection across L is followed about L.
type Node = usize;

/// The constants of one polhode, the curve on which L moves in the body.
struct Polhode {
    /// The parameters of `Jacobi`, and p - q.
    p: f64,
    q: f64,
    difference: f64,
    node: Node,
    /// The node's characteristic: from the crossing on, L^2 - m_node^2 is 1 + nu S^2 times what it was there.
    nu: f64,
}

impl Polhode {
    fn new(body: &LopsidedBody, m: &Vector3<f64>) -> Self {
        let (x, y, z) = (m.x * m.x, m.y * m.y, m.z * m.z);
        // The polhode's point in the plane of the axes 1 and 3 is (M1, 0, M3).
        let m1 = x + y * (body.e23 / body.e13);
        let m3 = z + y * (body.e12 / body.e13);
        let p = body.e13 * body.e23 * m3;
        let q = body.e13 * body.e12 * m1;
        let difference = body.e13 * (body.e23 * z - body.e12 * x);
        // The axis farther from the polhode: its angle to L never falls below 45 degrees, so that its turning about L
        // is smooth, whichever axis the polhode goes around and however closely.
        if m1 > m3 {
            Self {
                p,
                q,
                difference,
                node: 2,
                nu: body.e13 * body.e12 * m3,
            }
        } else {
            Self {
                p,
                q,
                difference,
                node: 0,
                nu: body.e13 * body.e23 * m1,
            }
        }
    }

    /// By what angle over |L| the node would turn about L if the motion began at the crossing:
    /// the integral of (2 T - m^2 e) / (L^2 - m^2), m and e = 1/I the node's.
    fn steady_angle(&self, body: &LopsidedBody, t: f64, jacobi: &Jacobi) -> f64 {
        let integral = t - self.nu / 3.0 * self.third_kind(jacobi);
        if self.node == 2 {
            body.e3 * t + body.e13 * integral
        } else {
            body.e1 * t - body.e13 * integral
        }
    }

    /// (3/nu) (t - integral of 1 / (1 + nu S^2)) = S^3 R_J(C^2, D^2, 1, 1 + nu S^2) (DLMF 19.25.14), by whole half
    /// periods and the rest.
    fn third_kind(&self, jacobi: &Jacobi) -> f64 {
        let odd = jacobi.half_periods % 2.0 != 0.0;
        let s = if odd { -jacobi.s } else { jacobi.s };
        let rest = cube_rj(s, jacobi.c * jacobi.c, jacobi.d * jacobi.d, self.nu);
        if jacobi.half_periods == 0.0 {
            return rest;
        }
        let (larger, ratio) = if self.difference >= 0.0 {
            (self.p, self.difference / self.p)
        } else {
            (self.q, -self.difference / self.q)
        };
        rest + jacobi.half_periods
            * 2.0
            * cube_rj(1.0 / larger.sqrt(), 0.0, ratio.max(1e-300), self.nu)
    }

    /// The rest of the node's turning, from the addition theorem of the third kind (Byrd & Friedman 116.03): the
    /// argument of this complex number (re, im).
    fn algebraic_turn(
        &self,
        body: &LopsidedBody,
        m: &Vector3<f64>,
        end: &Vector3<f64>,
        size: f64,
        jacobi: &Jacobi,
    ) -> (f64, f64) {
        let across = size * size - end[self.node] * end[self.node];
        let (e, sense) = if self.node == 2 {
            (body.e12, -1.0)
        } else {
            (body.e23, 1.0)
        };
        let common = e * jacobi.s * m.y;
        (
            across - common * end.x * end.z,
            sense * common * size * end.y,
        )
    }
}

fn cube_rj(s: f64, c2: f64, d2: f64, nu: f64) -> f64 {
    let square = s * s;
    s * square * carlson_rj(c2, d2, 1.0, 1.0 + nu * square)
}

/// The frame of L, the node's direction across it, and the third, in principal components.
fn frame(m: &Vector3<f64>, node: Node) -> Matrix3<f64> {
    let first = m / m.norm();
    let across = Vector3::ith_axis(node).cross(&first);
    let second = across / across.norm();
    Matrix3::from_columns(&[first, second, first.cross(&second)])
}

/// The rotation about the first axis by `angle` and the argument of (re, im).
fn about_first(angle: f64, (re, im): (f64, f64)) -> Matrix3<f64> {
    let (sine, cosine) = sin_cos(angle);
    let size = (re * re + im * im).sqrt();
    let (c, s) = (
        (re * cosine - im * sine) / size,
        (re * sine + im * cosine) / size,
    );
    Matrix3::new(1.0, 0.0, 0.0, 0.0, c, -s, 0.0, s, c)
}

#[cfg(test)]
mod tests;
