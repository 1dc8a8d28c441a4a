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
use super::principal::{SYMMETRY_ROUNDING, principal_axes};
use super::turn::RotationByVector;
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
        // Equal to rounding is symmetric; the elliptic functions take over continuously. z first: a sphere's axis is then the axle.
        for (axis, i, j) in [(2, 0, 1), (1, 0, 2), (0, 1, 2)] {
            let rounding = SYMMETRY_ROUNDING * moments[i].max(moments[j]);
            if (moments[i] - moments[j]).abs() <= rounding {
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
    pub fn turn(&self, orientation: &mut Matrix3<f64>, momentum: &Vector3<f64>, duration_s: f64) {
        match self {
            Self::Symmetric(body) => body.turn(orientation, momentum, duration_s),
            Self::Lopsided(body) => body.turn(orientation, momentum, duration_s),
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
    fn turn(&self, orientation: &mut Matrix3<f64>, momentum: &Vector3<f64>, duration_s: f64) {
        let axis = *orientation * self.axis;
        // L.axis from world vectors, as |L|: taken from body components the errors of a carried matrix would feed on themselves.
        let spin = RotationByVector::new(axis * (self.excess * axis.dot(momentum) * duration_s));
        let precession = RotationByVector::new(momentum * (self.across * duration_s));
        *orientation = precession.apply_to_columns(&spin.apply_to_columns(orientation));
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

    fn turn(&self, orientation: &mut Matrix3<f64>, momentum: &Vector3<f64>, duration_s: f64) {
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
type PrincipalAxis = usize;

/// The constants of one polhode, the curve on which L moves in the body.
struct Polhode {
    /// The parameters of `Jacobi`, and p - q.
    p: f64,
    q: f64,
    difference: f64,
    node: PrincipalAxis,
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
fn frame(m: &Vector3<f64>, node: PrincipalAxis) -> Matrix3<f64> {
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
mod tests {
    use super::*;
    use nalgebra::{Quaternion, UnitQuaternion, Vector4};

    /// Returns a reproducible random number in (-1, 1) (splitmix64).
    struct Random(u64);

    impl Random {
        fn number(&mut self) -> f64 {
            self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
            let mut z = self.0;
            z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
            ((z ^ (z >> 31)) >> 11) as f64 * 2.0_f64.powi(-52) - 1.0
        }
        fn vector(&mut self) -> Vector3<f64> {
            Vector3::from_fn(|_, _| self.number())
        }
        fn rotation(&mut self) -> Matrix3<f64> {
            RotationByVector::new(self.vector() * 3.0).apply_to_columns(&Matrix3::identity())
        }
        /// Returns a number from 0.1 to 10, uniform in the logarithm.
        fn size(&mut self) -> f64 {
            libm::pow(10.0, self.number())
        }
    }

    /// Inertia, start, angular momentum and time.
    #[derive(Debug)]
    struct FreeMotion(Matrix3<f64>, Matrix3<f64>, Vector3<f64>, f64);

    impl FreeMotion {
        /// Euler's equations and the quaternion's, by Taylor series of the order 50 in steps of a radian at the most: more steps of the
        /// same kind would add up their rounding. The terms are kept with their powers of the step, so that none is too large.
        fn integrated(&self) -> Matrix3<f64> {
            let Self(inertia, start, momentum, t) = self;
            let inverse = inertia.try_inverse().unwrap();
            let steps = (t.abs() * inverse.norm() * momentum.norm()).ceil().max(1.0);
            let (mut m, mut q) = (start.tr_mul(momentum), Quaternion::identity().coords);
            for _ in 0..steps as usize {
                let (mut ms, mut ws, mut qs) = (vec![m], vec![inverse * m], vec![q]);
                for n in 0..50 {
                    let over = t / steps / (n + 1) as f64;
                    let dm: Vector3<f64> = (0..=n).map(|k| ms[k].cross(&ws[n - k])).sum();
                    let dq: Vector4<f64> = (0..=n)
                        .map(|k| {
                            (Quaternion::from(qs[k]) * Quaternion::from_imag(ws[n - k])).coords
                        })
                        .sum();
                    ms.push(dm * over);
                    ws.push(inverse * ms[n + 1]);
                    qs.push(dq * (0.5 * over));
                }
                (m, q) = (ms.iter().rev().sum(), qs.iter().rev().sum());
                q /= q.norm();
            }
            let turn = UnitQuaternion::from_quaternion(Quaternion::from(q));
            start * turn.to_rotation_matrix().matrix()
        }

        fn advanced(&self) -> Matrix3<f64> {
            let Self(inertia, start, momentum, t) = self;
            let mut q = *start;
            FreeBody::new(inertia).turn(&mut q, momentum, *t);
            q
        }

        fn is_near(&self, expected: &Matrix3<f64>, bound: f64) {
            let error = (self.advanced() - expected).norm();
            assert!(error < bound, "{error:e}, not below {bound:e}: {self:?}");
        }

        fn is_as_integrated(&self, bound: f64) {
            let q = self.advanced();
            let off = (q.tr_mul(&q) - Matrix3::identity()).norm();
            assert!(off < 4e-15, "not orthonormal: {q}");
            self.is_near(&self.integrated(), bound);
        }
    }

    fn diagonal(a: f64, b: f64, c: f64) -> Matrix3<f64> {
        Matrix3::from_diagonal(&Vector3::new(a, b, c))
    }

    #[test]
    fn random_bodies_agree_with_an_integration() {
        let mut random = Random(1);
        let mut moments: Vec<_> = (0..600).map(|_| [0; 3].map(|_| random.size())).collect();
        let thin_flat_and_extreme = [
            [1.0, 2.0, 3.0],
            [1e-9, 1.0, 1.0 + 1e-9],
            [1e-6, 1.0, 1.1],
            [1.0, 1e3, 1e3 + 1.0],
            [1e-3, 1.0, 1.001],
        ];
        moments.extend(thin_flat_and_extreme.repeat(20));
        for principal in moments {
            let inertia = Matrix3::from_diagonal(&principal.into());
            let (start, momentum) = (random.rotation(), random.vector() * random.size());
            let t = 20.0 * random.number() * inertia.diagonal().min() / momentum.norm();
            FreeMotion(inertia, start, momentum, t).is_as_integrated(1e-13);
        }
    }

    #[test]
    fn bodies_with_tilted_principal_axes_agree_with_an_integration() {
        let mut random = Random(2);
        for _ in 0..300 {
            let axes = random.rotation();
            let moments = Vector3::from_fn(|_, _| random.size());
            let inertia = axes * Matrix3::from_diagonal(&moments) * axes.transpose();
            let inertia = (inertia + inertia.transpose()) * 0.5;
            let (start, momentum) = (random.rotation(), random.vector());
            let t = 5.0 * random.number() * moments.min() / momentum.norm();
            // The matrix is rounded relative to its largest moment, but the smallest one turns the body fastest.
            let condition = moments.max() / moments.min();
            FreeMotion(inertia, start, momentum, t).is_as_integrated(2e-14 + 5e-16 * condition);
        }
    }

    /// Tests differences down to rounding, where the solution of two rotations takes over.
    #[test]
    fn nearly_symmetric_bodies_are_a_continuous_limit() {
        let mut random = Random(4);
        for exponent in 1..=16 {
            let delta = libm::pow(10.0, -f64::from(exponent));
            // Below the limit, the moments count as equal, which changes the rates by 1e-14.
            let is_taken_as_equal = f64::from(u8::from(delta <= SYMMETRY_ROUNDING));
            for inertia in [
                diagonal(2.0, 2.0 + delta, 1.0),
                diagonal(1.0, 1.0 + delta, 1.9),
                diagonal(1.0 + delta, 1.9, 1.0),
                diagonal(1.0, 1.0 + delta, 1.0 - delta),
            ] {
                for _ in 0..10 {
                    let motion = FreeMotion(
                        inertia,
                        random.rotation(),
                        random.vector(),
                        12.0 * random.number(),
                    );
                    motion.is_as_integrated(2e-14 + is_taken_as_equal * delta * 12.0 * 1.8);
                }
            }
        }
    }

    /// On the separatrix, L comes to rest along the middle axis; near it, the body tumbles.
    #[test]
    fn motions_near_the_separatrix_agree_with_an_integration() {
        let start = Random(5).rotation();
        for off in [0.0, 1e-16, -1e-15, 1e-12, -1e-9, 1e-6, -1e-4, 1e-2] {
            for t in [0.1, -1.0, 4.0, 8.0_f64] {
                // m1^2 (1/I1 - 1/I2) = m3^2 (1/I2 - 1/I3)
                let m = Vector3::new(1.0 + off, 0.7, 3.0_f64.sqrt());
                // Nearby motions separate by up to e^(lambda t).
                let growth = libm::exp(m.norm() * (0.5 * (0.5 - 1.0 / 3.0_f64)).sqrt() * t.abs());
                FreeMotion(diagonal(1.0, 2.0, 3.0), start, start * m, t)
                    .is_as_integrated(4e-15 * (growth + 20.0 * t.abs()));
            }
        }
    }

    #[test]
    fn rotation_about_a_principal_axis_is_uniform() {
        let start = Random(6).rotation();
        for (i, moment) in [1.0, 2.0, 3.0].into_iter().enumerate() {
            for offset in [0.0, 1e-300, 1e-160, 1e-20, 1e-9] {
                for t in [0.3, -2.0, 9.0, 1e3_f64] {
                    let is_unstable = i == 1;
                    if is_unstable && t > 10.0 {
                        continue; // the rounding of L has been amplified
                    }
                    let mut m = Vector3::from_element(offset);
                    m[i] = -1.5;
                    let axis: Vector3<f64> = start.column(i).into();
                    let expected =
                        RotationByVector::new(axis * (-1.5 / moment * t)).apply_to_columns(&start);
                    let rate = if is_unstable { 0.5 } else { 0.0 };
                    let growth = libm::exp(rate * t.abs());
                    let bound = 4e-15 * (growth + t.abs()) + 10.0 * offset * growth;
                    FreeMotion(diagonal(1.0, 2.0, 3.0), start, start * m, t)
                        .is_near(&expected, bound);
                }
            }
        }
    }

    /// Compares one long step with the same time in parts, to check the count of periods.
    #[test]
    fn a_long_time_equals_many_short_ones() {
        let mut random = Random(9);
        for _ in 0..100 {
            let [a, b, c] = [0; 3].map(|_| random.number());
            let inertia = diagonal(1.0 + 0.9 * a, 3.0 + b, 6.0 + 1.5 * c);
            let (start, momentum) = (random.rotation(), random.vector());
            let body = FreeBody::new(&inertia);
            let mut in_parts = start;
            (0..8).for_each(|_| body.turn(&mut in_parts, &momentum, 256.0));
            // Each part starts with a rounded L in the body frame, and keeps its slightly different rates to its end.
            let phase = 2048.0 * momentum.norm() / inertia.diagonal().min();
            FreeMotion(inertia, start, momentum, 2048.0).is_near(&in_parts, 1e-14 * phase);
        }
    }
}
