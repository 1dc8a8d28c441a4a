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

/// Euler's equations and the quaternion's, by Taylor series of the order 50 in steps of a radian at the most: more steps of the same kind
/// would add up their rounding.
fn integrated(
    inertia: &Matrix3<f64>,
    start: &Matrix3<f64>,
    momentum: &Vector3<f64>,
    t: f64,
) -> Matrix3<f64> {
    let inverse = inertia.try_inverse().unwrap();
    let steps = (t.abs() * inverse.norm() * momentum.norm()).ceil().max(1.0);
    let mut m = start.tr_mul(momentum);
    let mut q = Vector4::new(1.0, 0.0, 0.0, 0.0);
    for _ in 0..steps as usize {
        (m, q) = taylor_step(&inverse, m, q, t / steps);
    }
    let turn = UnitQuaternion::from_quaternion(Quaternion::new(q[0], q[1], q[2], q[3]));
    start * turn.to_rotation_matrix().matrix()
}

/// The terms are kept with their powers of h, so that none is too large.
fn taylor_step(
    inverse: &Matrix3<f64>,
    m: Vector3<f64>,
    q: Vector4<f64>,
    h: f64,
) -> (Vector3<f64>, Vector4<f64>) {
    let (mut ms, mut ws, mut qs) = (vec![m], vec![inverse * m], vec![q]);
    for n in 0..50 {
        let over = h / (n + 1) as f64;
        let dm: Vector3<f64> = (0..=n).map(|k| ms[k].cross(&ws[n - k])).sum();
        let dq: Vector4<f64> = (0..=n).map(|k| times_pure(&qs[k], &ws[n - k])).sum();
        ms.push(dm * over);
        ws.push(inverse * ms[n + 1]);
        qs.push(dq * (0.5 * over));
    }
    let (m, q): (Vector3<f64>, Vector4<f64>) = (ms.iter().rev().sum(), qs.iter().rev().sum());
    (m, q / q.norm())
}

/// The quaternion product q w, w without real part.
fn times_pure(q: &Vector4<f64>, w: &Vector3<f64>) -> Vector4<f64> {
    let v = Vector3::new(q[1], q[2], q[3]);
    let vector = w * q[0] + v.cross(w);
    Vector4::new(-v.dot(w), vector.x, vector.y, vector.z)
}

fn advanced(
    inertia: &Matrix3<f64>,
    start: &Matrix3<f64>,
    momentum: &Vector3<f64>,
    t: f64,
) -> Matrix3<f64> {
    let mut q = *start;
    FreeBody::new(inertia).advance(&mut q, momentum, t);
    q
}

/// The distance from the integration, in units of what rounding the inertia and the time alone can make of it.
fn error(inertia: &Matrix3<f64>, start: &Matrix3<f64>, momentum: &Vector3<f64>, t: f64) -> f64 {
    let q = advanced(inertia, start, momentum, t);
    assert!(
        (q.tr_mul(&q) - Matrix3::identity()).norm() < 4e-15,
        "not orthonormal: {q}"
    );
    (q - integrated(inertia, start, momentum, t)).norm()
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
        let error = error(&inertia, &start, &momentum, t);
        assert!(error < 1e-13, "{error:e} {inertia} {momentum} {t}");
    }
}

#[test]
fn bodies_with_tilted_principal_axes_move_as_integrated() {
    let mut random = Random(2);
    for i in 0..300 {
        let axes = random.rotation();
        let moments = Vector3::new(random.size(), random.size(), random.size());
        let inertia = axes * Matrix3::from_diagonal(&moments) * axes.transpose();
        let inertia = (inertia + inertia.transpose()) * 0.5;
        let (start, momentum) = (random.rotation(), random.vector());
        let t = 5.0 * random.number() * moments.min() / momentum.norm();
        // The matrix is rounded in parts of its largest moment; the smallest turns the body fastest.
        let condition = moments.max() / moments.min();
        let error = error(&inertia, &start, &momentum, t);
        assert!(
            error < 2e-14 + 5e-16 * condition,
            "{i}: {error:e} {condition} {inertia} {momentum} {t}"
        );
    }
}

#[test]
fn symmetric_bodies_about_any_axis() {
    let mut random = Random(3);
    for (a, b, c) in [
        (2.0, 2.0, 1.0),
        (2.0, 1.0, 2.0),
        (1.0, 2.0, 2.0),
        (1.0, 1.0, 1.9),
        (1.0, 1.9, 1.0),
        (1.9, 1.0, 1.0),
        (1.0, 1.0, 1.0),
    ] {
        let inertia = diagonal(a, b, c);
        assert!(matches!(FreeBody::new(&inertia), FreeBody::Symmetric(_)));
        for _ in 0..20 {
            let (start, momentum) = (random.rotation(), random.vector());
            let error = error(&inertia, &start, &momentum, 12.0 * random.number());
            assert!(error < 2e-14, "{a} {b} {c}: {error:e}");
        }
    }
}

/// Down to a difference of rounding, where the two rotations take over.
#[test]
fn nearly_symmetric_bodies_go_over_continuously() {
    let mut random = Random(4);
    for exponent in 1..=16 {
        let delta = libm::pow(10.0, -f64::from(exponent));
        for moments in [
            [2.0, 2.0 + delta, 1.0],
            [1.0, 1.0 + delta, 1.9],
            [1.0 + delta, 1.9, 1.0],
            [1.0, 1.0 + delta, 1.0 - delta],
        ] {
            let inertia = Matrix3::from_diagonal(&moments.into());
            for _ in 0..10 {
                let (start, momentum) = (random.rotation(), random.vector());
                let t = 12.0 * random.number();
                let error = error(&inertia, &start, &momentum, t);
                // Below the limit the moments are taken as equal, which is a change of 1e-14 of the rates.
                let taken_as_equal = if delta <= ROUNDING {
                    delta * 12.0 * 1.8
                } else {
                    0.0
                };
                assert!(
                    error < 2e-14 + taken_as_equal,
                    "{delta:e} {moments:?}: {error:e}"
                );
            }
        }
    }
}

/// On the separatrix L comes to rest along the middle axis; beside it the body tumbles.
#[test]
fn the_separatrix_and_its_neighbourhood() {
    let start = Random(5).rotation();
    let body = diagonal(1.0, 2.0, 3.0);
    // m1^2 (1/I1 - 1/I2) = m3^2 (1/I2 - 1/I3)
    let on = Vector3::new(1.0, 0.7, 3.0_f64.sqrt());
    for off in [0.0, 1e-16, -1e-15, 1e-12, -1e-9, 1e-6, -1e-4, 1e-2] {
        for t in [0.1, -1.0, 4.0, 8.0] {
            let m = Vector3::new(on.x + off, on.y, on.z);
            let momentum = start * m;
            // Neighbours part by up to e^(lambda t).
            let growth = libm::exp(m.norm() * (0.5 * (0.5 - 1.0 / 3.0_f64)).sqrt() * f64::abs(t));
            let error = error(&body, &start, &momentum, t);
            assert!(
                error < 4e-15 * (growth + 20.0 * f64::abs(t)),
                "{off:e} {t}: {error:e}, growth {growth}"
            );
        }
    }
}

#[test]
fn rotation_about_a_principal_axis_is_uniform() {
    let start = Random(6).rotation();
    let moments = [1.0, 2.0, 3.0];
    for (i, moment) in moments.into_iter().enumerate() {
        for offset in [0.0, 1e-300, 1e-160, 1e-20, 1e-9] {
            let mut m = Vector3::from_element(offset);
            m[i] = -1.5;
            for t in [0.3, -2.0, 9.0, 1e3] {
                if i == 1 && t > 10.0 {
                    continue; // unstable: the rounding of L has grown
                }
                let axis: Vector3<f64> = start.column(i).into();
                let expected = Turn::new(axis * (-1.5 / moment * t)).of_columns(&start);
                let found = advanced(
                    &Matrix3::from_diagonal(&moments.into()),
                    &start,
                    &(start * m),
                    t,
                );
                let growth = if i == 1 {
                    libm::exp(0.5 * f64::abs(t))
                } else {
                    1.0
                };
                let error = (found - expected).norm();
                assert!(
                    error < 4e-15 * (growth + f64::abs(t)) + 10.0 * offset * growth,
                    "{i} {offset:e} {t}: {error:e}"
                );
            }
        }
    }
}

#[test]
fn without_momentum_or_time_nothing_moves() {
    let start = Random(7).rotation();
    for inertia in [
        diagonal(1.0, 2.0, 3.0),
        diagonal(1.0, 1.0, 2.0),
        diagonal(1.0, 1.0, 1.0),
    ] {
        for momentum in [
            Vector3::zeros(),
            Vector3::from_element(1e-200),
            Vector3::from_element(f64::MIN_POSITIVE),
        ] {
            assert!((advanced(&inertia, &start, &momentum, 10.0) - start).norm() < 2e-15);
        }
        assert!(
            (advanced(&inertia, &start, &Vector3::new(1.0, 2.0, 3.0), 0.0) - start).norm() < 2e-15
        );
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
    let end = Matrix3::new(
        0.4684376567870589,
        0.8165008404719185,
        -0.33747968711094295,
        -0.5791458398236233,
        0.5722488692992537,
        0.5806215013248438,
        0.6672003131885051,
        -0.0765350187455135,
        0.74093598440539,
    );
    let momentum = Vector3::new(-0.8183922430644153, 0.701990341551568, 0.0883562620096785);
    let error = (advanced(&inertia, &start, &momentum, 2048.0) - end).norm();
    assert!(error < 3e-13, "{error:e}");
}

/// The count of the periods: at once or in parts.
#[test]
fn long_times_are_many_short_ones() {
    let mut random = Random(9);
    for i in 0..100 {
        let inertia = diagonal(
            1.0 + 0.9 * random.number(),
            3.0 + random.number(),
            6.0 + 1.5 * random.number(),
        );
        let (start, momentum) = (random.rotation(), random.vector());
        let body = FreeBody::new(&inertia);
        let (mut at_once, mut in_parts) = (start, start);
        body.advance(&mut at_once, &momentum, 2048.0);
        (0..8).for_each(|_| body.advance(&mut in_parts, &momentum, 256.0));
        // Each part begins with a rounded L in the body, and keeps its slightly different rates to the end.
        let phase = 2048.0 * momentum.norm() / inertia.diagonal().min();
        let error = (at_once - in_parts).norm();
        assert!(
            error < 1e-14 * phase,
            "{i}: {error:e} of {phase} rad, {inertia} {momentum}"
        );
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
            let _ = advanced(&inertia, &Matrix3::identity(), &momentum, t);
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
