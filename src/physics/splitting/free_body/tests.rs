use super::super::jacobi::carlson_rj;
use super::*;
use nalgebra::{Quaternion, UnitQuaternion, Vector4};

/// Numbers in (-1, 1), the same every time (splitmix64).
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
        Turn::new(self.vector() * 3.0).of_columns(&Matrix3::identity())
    }
    /// From 0.1 to 10, evenly in the logarithm.
    fn size(&mut self) -> f64 {
        libm::pow(10.0, self.number())
    }
}

/// Inertia, start, angular momentum and time.
#[derive(Debug)]
struct Motion(Matrix3<f64>, Matrix3<f64>, Vector3<f64>, f64);

impl Motion {
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
                let product =
                    |k| (Quaternion::from(qs[k]) * Quaternion::from_imag(ws[n - k])).coords;
                let dq: Vector4<f64> = (0..=n).map(product).sum();
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
        FreeBody::new(inertia).advance(&mut q, momentum, *t);
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
fn random_bodies_move_as_integrated() {
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
    for moments in moments {
        let inertia = Matrix3::from_diagonal(&moments.into());
        let (start, momentum) = (random.rotation(), random.vector() * random.size());
        let t = 20.0 * random.number() * inertia.diagonal().min() / momentum.norm();
        Motion(inertia, start, momentum, t).is_as_integrated(1e-13);
    }
}

#[test]
fn bodies_with_tilted_principal_axes_move_as_integrated() {
    let mut random = Random(2);
    for _ in 0..300 {
        let axes = random.rotation();
        let moments = Vector3::from_fn(|_, _| random.size());
        let inertia = axes * Matrix3::from_diagonal(&moments) * axes.transpose();
        let inertia = (inertia + inertia.transpose()) * 0.5;
        let (start, momentum) = (random.rotation(), random.vector());
        let t = 5.0 * random.number() * moments.min() / momentum.norm();
        // The matrix is rounded in parts of its largest moment; the smallest turns the body fastest.
        let condition = moments.max() / moments.min();
        Motion(inertia, start, momentum, t).is_as_integrated(2e-14 + 5e-16 * condition);
    }
}

#[test]
fn symmetric_bodies_about_any_axis() {
    let mut random = Random(3);
    for (across, along) in [(2.0, 1.0), (1.0, 1.9), (1.0, 1.0)] {
        for axis in [2, 1, 0] {
            let mut moments = Vector3::from_element(across);
            moments[axis] = along;
            let inertia = Matrix3::from_diagonal(&moments);
            assert!(matches!(FreeBody::new(&inertia), FreeBody::Symmetric(_)));
            for _ in 0..20 {
                let (start, momentum) = (random.rotation(), random.vector());
                Motion(inertia, start, momentum, 12.0 * random.number()).is_as_integrated(2e-14);
            }
        }
    }
}

/// Down to a difference of rounding, where the two rotations take over.
#[test]
fn nearly_symmetric_bodies_go_over_continuously() {
    let mut random = Random(4);
    for exponent in 1..=16 {
        let delta = libm::pow(10.0, -f64::from(exponent));
        // Below the limit the moments are taken as equal, which is a change of 1e-14 of the rates.
        let is_taken_as_equal = f64::from(u8::from(delta <= ROUNDING));
        for inertia in [
            diagonal(2.0, 2.0 + delta, 1.0),
            diagonal(1.0, 1.0 + delta, 1.9),
            diagonal(1.0 + delta, 1.9, 1.0),
            diagonal(1.0, 1.0 + delta, 1.0 - delta),
        ] {
            for _ in 0..10 {
                let motion = Motion(
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

/// On the separatrix L comes to rest along the middle axis; beside it the body tumbles.
#[test]
fn the_separatrix_and_its_neighbourhood() {
    let start = Random(5).rotation();
    for off in [0.0, 1e-16, -1e-15, 1e-12, -1e-9, 1e-6, -1e-4, 1e-2] {
        for t in [0.1, -1.0, 4.0, 8.0_f64] {
            // m1^2 (1/I1 - 1/I2) = m3^2 (1/I2 - 1/I3)
            let m = Vector3::new(1.0 + off, 0.7, 3.0_f64.sqrt());
            // Neighbours part by up to e^(lambda t).
            let growth = libm::exp(m.norm() * (0.5 * (0.5 - 1.0 / 3.0_f64)).sqrt() * t.abs());
            Motion(diagonal(1.0, 2.0, 3.0), start, start * m, t)
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
                    continue; // the rounding of L has grown
                }
                let mut m = Vector3::from_element(offset);
                m[i] = -1.5;
                let axis: Vector3<f64> = start.column(i).into();
                let expected = Turn::new(axis * (-1.5 / moment * t)).of_columns(&start);
                let rate = if is_unstable { 0.5 } else { 0.0 };
                let growth = libm::exp(rate * t.abs());
                let bound = 4e-15 * (growth + t.abs()) + 10.0 * offset * growth;
                Motion(diagonal(1.0, 2.0, 3.0), start, start * m, t).is_near(&expected, bound);
            }
        }
    }
}

#[test]
fn without_momentum_or_time_nothing_moves() {
    let start = Random(7).rotation();
    for moments in [[1.0, 2.0, 3.0], [1.0, 1.0, 2.0], [1.0, 1.0, 1.0]] {
        for (momentum, t) in [
            ([0.0; 3], 10.0),
            ([1e-200; 3], 10.0),
            ([f64::MIN_POSITIVE; 3], 10.0),
            ([1.0, 2.0, 3.0], 0.0),
        ] {
            let inertia = Matrix3::from_diagonal(&moments.into());
            Motion(inertia, start, momentum.into(), t).is_near(&start, 2e-15);
        }
    }
}

/// A lopsided body (moments 1 : 1.6 : 5.5) over 800 rad, from a Taylor series of 32 digits (mpmath).
#[test]
fn a_long_time_is_right_to_the_rounding_of_its_phase() {
    let inertia = diagonal(1.3276689778364434, 2.08403257557294, 7.338824642015743);
    let start = Matrix3::new(
        -0.14824400924164527,
        0.49296689611156863,
        -0.8573256983562831,
        -0.042517882740465834,
        -0.8692797243934653,
        -0.49248856880712355,
        -0.9880364079178614,
        -0.03655680643254755,
        0.14982542018036293,
    );
    let end = Matrix3::from([
        [0.4684376567870589, 0.8165008404719185, -0.33747968711094295],
        [-0.5791458398236233, 0.5722488692992537, 0.5806215013248438],
        [0.6672003131885051, -0.0765350187455135, 0.74093598440539],
    ])
    .transpose();
    let momentum = Vector3::new(-0.8183922430644153, 0.701990341551568, 0.0883562620096785);
    Motion(inertia, start, momentum, 2048.0).is_near(&end, 3e-13);
}

/// The count of the periods: at once or in parts.
#[test]
fn long_times_are_many_short_ones() {
    let mut random = Random(9);
    for _ in 0..100 {
        let [a, b, c] = [0; 3].map(|_| random.number());
        let inertia = diagonal(1.0 + 0.9 * a, 3.0 + b, 6.0 + 1.5 * c);
        let (start, momentum) = (random.rotation(), random.vector());
        let body = FreeBody::new(&inertia);
        let mut in_parts = start;
        (0..8).for_each(|_| body.advance(&mut in_parts, &momentum, 256.0));
        // Each part begins with a rounded L in the body, and keeps its slightly different rates to the end.
        let phase = 2048.0 * momentum.norm() / inertia.diagonal().min();
        Motion(inertia, start, momentum, 2048.0).is_near(&in_parts, 1e-14 * phase);
    }
}

#[test]
fn nonsense_does_not_panic() {
    let (body, momentum) = (diagonal(1.0, 2.0, 3.0), Vector3::new(1.0, 2.0, 3.0));
    for value in [f64::NAN, f64::INFINITY, 0.0, -1.0] {
        for (inertia, momentum, t) in [
            (Matrix3::from_element(value), momentum, 1.0),
            (diagonal(1.0, 2.0, value), momentum, 1.0),
            (diagonal(value, 1.0, 1.0), momentum, 1.0),
            (body, Vector3::from_element(value), 1.0),
            (body, momentum, value),
        ] {
            let _ = Motion(inertia, Matrix3::identity(), momentum, t).advanced();
        }
    }
}

/// Digits of an arbitrary-precision computation (mpmath).
#[test]
fn carlson_rj_has_known_values() {
    for ([x, y, z, p], value) in [
        ([0.0, 1.0, 2.0, 3.0], 0.776_886_237_785_823_3),
        ([2.0, 3.0, 4.0, 5.0], 0.142_975_796_671_567_54),
    ] {
        assert!((carlson_rj(x, y, z, p) - value).abs() < 1e-13 * value);
    }
}
