//! The Taylor series compared with reference motions and an independent integration, and the laws of a rigid body.

use super::common::{Dice, greatest, table};
use differential_equations::prelude::*;
use gyrolab::physics::exact::{AccurateMotion, LagrangeTop};
use nalgebra::{Matrix3, Vector3};

struct Body {
    inertia: Matrix3<f64>,
    moment: Matrix3<f64>,
    orientation: Matrix3<f64>,
    momentum: Vector3<f64>,
}

impl Body {
    fn motion(&self) -> AccurateMotion {
        AccurateMotion::new(self.inertia, self.moment, self.orientation, self.momentum)
            .expect("a body")
    }

    /// Kinetic and potential energy, J: constant forces have the potential -sum (Q x).F = -trace(Q M).
    fn energy(&self, (q, l): &(Matrix3<f64>, Vector3<f64>)) -> f64 {
        let body = q.tr_mul(l);
        let spin = self.inertia.try_inverse().expect("a body") * body;
        0.5 * body.dot(&spin) - (q * self.moment).trace()
    }
}

/// Five point masses with gravity at their center of mass and two more forces elsewhere.
fn random_body(dice: &mut Dice) -> Body {
    let points: Vec<Vector3<f64>> = (0..5).map(|_| dice.vector()).collect();
    let inertia = points
        .iter()
        .map(|x| Matrix3::identity() * x.norm_squared() - x * x.transpose())
        .sum();
    let weight = points.iter().sum::<Vector3<f64>>() * Vector3::new(0.0, 0.0, -9.8).transpose();
    let pushes: Matrix3<f64> = (0..2)
        .map(|_| dice.vector() * (dice.vector() * 5.0).transpose())
        .sum();
    let turn = dice.scale(0.3, 30.0);
    Body {
        inertia,
        moment: weight + pushes,
        orientation: dice.orientation(),
        momentum: dice.vector() * turn,
    }
}

impl ODE<f64, [f64; 12]> for Body {
    fn diff(&self, _t: f64, y: &[f64; 12], rate: &mut [f64; 12]) {
        let q = Matrix3::from_column_slice(&y[..9]);
        let l = Vector3::new(y[9], y[10], y[11]);
        // Torque of one force at a time: x F^T splits into three, and body axis k carries row k.
        let spin = q * (self.inertia.try_inverse().expect("a body") * q.tr_mul(&l));
        let mut torque = Vector3::zeros();
        for k in 0..3 {
            rate[3 * k..3 * k + 3].copy_from_slice(spin.cross(&q.column(k)).as_slice());
            torque += q.column(k).cross(&self.moment.row(k).transpose());
        }
        rate[9..].copy_from_slice(torque.as_slice());
    }
}

fn integrated(body: &Body, t: f64) -> (Matrix3<f64>, Vector3<f64>) {
    let mut y = [0.0; 12];
    y[..9].copy_from_slice(body.orientation.as_slice());
    y[9..].copy_from_slice(body.momentum.as_slice());
    let method = ExplicitRungeKutta::dop853()
        .rtol(1e-15)
        .atol(1e-15)
        .max_steps(1_000_000);
    let solution = IVP::ode(body, 0.0, t, y)
        .method(method)
        .solve()
        .expect("a smooth motion");
    let end = solution.y.last().expect("an end");
    (
        Matrix3::from_column_slice(&end[..9]),
        Vector3::new(end[9], end[10], end[11]),
    )
}

fn apart(a: &(Matrix3<f64>, Vector3<f64>), b: &(Matrix3<f64>, Vector3<f64>)) -> f64 {
    greatest([(a.0 - b.0).amax(), (a.1 - b.1).norm() / (a.1.norm() + 1.0)])
}

/// Returns the factor by which the motion separates two nearby states: a lower bound on the error of any integration.
fn growth(body: &Body, t: f64) -> f64 {
    let near = Body {
        momentum: body.momentum * (1.0 + 1e-8),
        orientation: body.orientation,
        ..*body
    };
    1.0 + apart(&body.motion().state_at(t), &near.motion().state_at(t)) / 1e-8
}

#[test]
fn the_reference_tops_are_reproduced_to_1e_12() {
    for (text, momentum) in [
        (
            include_str!("../../reference/exact/cusped.csv"),
            Vector3::new(0.0, 0.0, 100.0),
        ),
        (
            include_str!("../../reference/exact/looping.csv"),
            Vector3::new(0.0, -20.0, 30.0),
        ),
    ] {
        let orientation = super::common::tilted(45.0);
        let inertia = Matrix3::from_diagonal(&Vector3::new(8.35, 8.35, 3.2));
        let moment = Vector3::z() * Vector3::new(0.0, 0.0, -63.7).transpose();
        let mut motion = Body {
            inertia,
            moment,
            orientation,
            momentum: orientation * momentum,
        }
        .motion();
        for line in text.lines().skip(1) {
            let v: Vec<f64> = line
                .split(',')
                .map(|x| x.parse().expect("a number"))
                .collect();
            let three = |k: usize| Vector3::new(v[k], v[k + 1], v[k + 2]);
            let (q, l) = motion.state_at(v[0]);
            let errors = [
                (q.column(2) - three(1)).norm(),
                (q.column(0) - three(7)).norm(),
                (l - three(4)).norm() / 100.0,
            ];
            assert!(greatest(errors) < 5e-13, "{errors:?} at {} s", v[0]);
        }
    }
}

#[test]
fn degenerate_tops_agree_with_the_reference() {
    // Excludes the separatrix, where rounding decides when the top leaves the upright rest.
    let unstable = [
        "pendulum separatrix",
        "pendulum separatrix from bottom",
        "near separatrix from afar",
    ];
    for (start, known) in table(include_str!("../../reference/exact/hard_starts.csv")) {
        if unstable.contains(&start.name.as_str())
            || start.name.contains("random")
            || start.name == "near upright 1e-3 slow"
        {
            continue;
        }
        let mut motion = AccurateMotion::new(
            start.inertia(),
            start.moment(),
            start.orientation,
            start.momentum,
        )
        .expect("a body");
        let error = greatest(known.errors(&motion.state_at(known.t), start.momentum_scale()));
        let allowed = if start.name.contains("tilted sleeping") {
            1e-10
        } else {
            2e-12
        };
        println!("{:32} {error:.1e}", start.name);
        assert!(error < allowed, "{}: {error:e}", start.name);
    }
}

#[test]
fn bodies_without_symmetry_agree_with_an_independent_integration() {
    let mut dice = Dice(0xA5A5_1234_9876_0F0F);
    // The gap is the error of the Runge-Kutta side: 1e-11 at a tolerance of 1e-13. It shrinks with the tolerance.
    let gaps = (0..60)
        .map(|_| random_body(&mut dice))
        .map(|body| apart(&body.motion().state_at(4.0), &integrated(&body, 4.0)));
    let worst = greatest(gaps);
    println!("worst {worst:.1e}");
    assert!(worst < 1e-12, "{worst:e}");
}

#[test]
fn energy_is_constant() {
    let mut dice = Dice(5);
    for _ in 0..60 {
        let body = random_body(&mut dice);
        let mut motion = body.motion();
        let first = body.energy(&motion.state_at(0.0));
        let scale = body.momentum.norm_squared() + body.moment.norm();
        for t in [1.0, 5.0, 20.0] {
            let change = (body.energy(&motion.state_at(t)) - first).abs() / scale;
            assert!(change < 2e-12, "energy changed by {change:e} at {t} s");
        }
    }
}

#[test]
fn a_free_body_keeps_its_momentum_bit_for_bit() {
    let mut dice = Dice(6);
    let body = Body {
        moment: Matrix3::zeros(),
        ..random_body(&mut dice)
    };
    assert_eq!(body.motion().state_at(20.0).1, body.momentum);
}

#[test]
fn vertical_forces_keep_the_vertical_momentum_bit_for_bit() {
    let mut dice = Dice(7);
    let body = random_body(&mut dice);
    let vertical = body.moment * Matrix3::from_diagonal(&Vector3::new(0.0, 0.0, 1.0));
    let body = Body {
        moment: vertical,
        ..body
    };
    assert_eq!(body.motion().state_at(20.0).1.z, body.momentum.z);
}

#[test]
fn intermediate_queries_do_not_change_the_motion() {
    let body = random_body(&mut Dice(8));
    let (mut often, mut once) = (body.motion(), body.motion());
    for k in 1..=1000 {
        often.state_at(f64::from(k) * 0.005);
    }
    assert_eq!(often.state_at(5.0), once.state_at(5.0));
}

#[test]
fn integrating_backwards_returns_to_the_start() {
    let body = random_body(&mut Dice(9));
    let mut motion = body.motion();
    motion.state_at(3.0);
    let gap = apart(&motion.state_at(0.0), &(body.orientation, body.momentum));
    assert!(gap < 1e-14 * growth(&body, 3.0) * 10.0, "{gap:e}");
}

#[test]
fn a_body_at_rest_without_forces_stays_at_rest() {
    let body = Body {
        moment: Matrix3::zeros(),
        momentum: Vector3::zeros(),
        ..random_body(&mut Dice(10))
    };
    let (q, l) = body.motion().state_at(1e9);
    assert!((q - body.orientation).amax() < 1e-15 && l == Vector3::zeros());
}

#[test]
fn singular_inertia_and_non_finite_values_are_rejected() {
    let body = random_body(&mut Dice(11));
    let line = Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, 0.0));
    assert!(AccurateMotion::new(line, body.moment, body.orientation, body.momentum).is_none());
    let nowhere = Vector3::new(f64::NAN, 0.0, 0.0);
    assert!(AccurateMotion::new(body.inertia, body.moment, body.orientation, nowhere).is_none());
    assert!(body.motion().state_at(f64::INFINITY).1.x.is_nan());
}

#[test]
fn the_phase_error_of_a_fast_top_is_rounding_of_its_rate() {
    // 400 000 rad of spin. Without compensated summation of L, the rate would drift, and the angle as time to the power 3/2.
    let orientation = super::common::tilted(44.0);
    let (load, momentum) = (
        Vector3::new(0.0, 0.0, -27.72),
        orientation * Vector3::z() * 1000.0,
    );
    let inertia = Matrix3::from_diagonal(&Vector3::new(4.8, 4.8, 1.6));
    let moment = Vector3::z() * load.transpose();
    let mut motion = Body {
        inertia,
        moment,
        orientation,
        momentum,
    }
    .motion();
    let gap = apart(
        &motion.state_at(640.0),
        &LagrangeTop::new(4.8, 1.6, load, orientation, momentum).at(640.0),
    );
    assert!(gap < 4e5 * 2.0 * f64::EPSILON, "{gap:e}");
}

#[test]
fn rounding_of_step_ends_does_not_accumulate() {
    // Step ends are sums of step lengths; uniform rotation shows the effect of their rounding on the angle.
    let inertia = Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, 1.0));
    let momentum = Vector3::new(0.0, 0.0, 512.0);
    let body = Body {
        inertia,
        moment: Matrix3::zeros(),
        orientation: Matrix3::identity(),
        momentum,
    };
    let (q, _) = body.motion().state_at(100.0);
    let (sin, cos) = libm::sincos(51_200.0);
    let gap = greatest([(q[(0, 0)] - cos).abs(), (q[(1, 0)] - sin).abs()]);
    assert!(gap < 51_200.0 * f64::EPSILON, "{gap:e}");
}
