//! The closed form compared with an independent integration (Dormand-Prince 8(5,3), tolerance 1e-15), and conservation laws.

use super::common::{Dice, Start, greatest};
use differential_equations::prelude::*;
use gyrolab::physics::exact::LagrangeTop;
use nalgebra::{Matrix3, SVector, Vector3};

const TIMES: [f64; 5] = [0.7, 2.3, 5.0, 7.9, 10.0];

/// Euler's equations for three body axes and L in the world frame, without angles or quaternions.
struct Spinning<'a>(&'a Start);

type State = SVector<f64, 12>;

impl ODE<f64, [f64; 12]> for Spinning<'_> {
    fn diff(&self, _t: f64, y: &[f64; 12], rate: &mut [f64; 12]) {
        let y = State::from_column_slice(y);
        let (axes, momentum) = (
            Matrix3::from_column_slice(&y.as_slice()[..9]),
            y.fixed_rows::<3>(9),
        );
        let axle = axes.column(2);
        let along = momentum.dot(&axle);
        let spin =
            momentum / self.0.across + axle * along * (1.0 / self.0.along - 1.0 / self.0.across);
        for k in 0..3 {
            rate[3 * k..3 * k + 3].copy_from_slice(spin.cross(&axes.column(k)).as_slice());
        }
        rate[9..].copy_from_slice(axle.cross(&self.0.load).as_slice());
    }
}

fn integrated(start: &Start) -> Vec<(Matrix3<f64>, Vector3<f64>)> {
    let mut first = [0.0; 12];
    first[..9].copy_from_slice(start.orientation.as_slice());
    first[9..].copy_from_slice(start.momentum.as_slice());
    let body = Spinning(start);
    let mut states = Vec::new();
    let (mut from, mut y) = (0.0, first);
    for to in TIMES {
        let method = ExplicitRungeKutta::dop853()
            .rtol(1e-15)
            .atol(1e-15)
            .max_steps(1_000_000);
        let solution = IVP::ode(&body, from, to, y)
            .method(method)
            .solve()
            .expect("a smooth motion");
        y = *solution.y.last().expect("an end");
        from = to;
        let momentum = Vector3::new(y[9], y[10], y[11]);
        states.push((Matrix3::from_column_slice(&y[..9]), momentum));
    }
    states
}

fn random_start(dice: &mut Dice) -> Start {
    let across = dice.scale(0.5, 10.0);
    let size = dice.scale(5.0, 80.0);
    let load = match dice.unit() {
        x if x < 0.5 => Vector3::new(0.0, 0.0, -size),
        x if x < 0.9 => dice.vector() * size,
        _ => Vector3::zeros(),
    };
    let orientation = dice.orientation();
    let typical = dice.scale(0.1, 6.0) * (across * size).sqrt();
    let along_axle = dice.unit() < 0.3;
    let momentum = if along_axle {
        orientation.column(2) * typical
    } else {
        dice.vector() * typical
    };
    let along = across * dice.between(0.2, 2.0);
    Start {
        name: String::new(),
        across,
        along,
        load,
        orientation,
        momentum,
    }
}

fn error(start: &Start) -> f64 {
    let top = start.top();
    greatest(
        TIMES
            .into_iter()
            .zip(integrated(start))
            .map(|(t, (axes, momentum))| {
                let (q, l) = top.at(t);
                greatest([
                    (q - axes).amax(),
                    (l - momentum).norm() / start.momentum_scale(),
                ])
            }),
    )
}

#[test]
fn random_tops_agree_with_an_independent_integration() {
    let mut dice = Dice(0x2545_F491_4F6C_DD1D);
    let mut errors: Vec<f64> = (0..400).map(|_| error(&random_start(&mut dice))).collect();
    errors.sort_by(f64::total_cmp);
    println!("median {:.1e}, worst {:.1e}", errors[200], errors[399]);
    assert!(
        errors[200] < 2e-13 && errors[399] < 1e-11,
        "worst {:e}",
        errors[399]
    );
}

/// Returns the conserved quantities at the time `t`: spin momentum, vertical momentum and energy.
fn constants(start: &Start, top: &LagrangeTop, t: f64) -> [f64; 3] {
    let (q, l) = top.at(t);
    let axle = q.column(2);
    let up = -start.load / start.load.norm().max(f64::MIN_POSITIVE);
    let along = l.dot(&axle);
    let moving = (l.norm_squared() - along * along) / (2.0 * start.across);
    [along, l.dot(&up), moving - start.load.dot(&axle)]
}

#[test]
fn spin_vertical_momentum_and_energy_are_constant_at_any_time() {
    let mut dice = Dice(77);
    for _ in 0..300 {
        let start = random_start(&mut dice);
        let top = start.top();
        let scale = start.momentum_scale();
        let first = constants(&start, &top, 0.0);
        let units = [scale, scale, scale * scale / start.across];
        for t in [1.0, -3.0, 40.0, 1e3, -1e5, 1e6] {
            let now = constants(&start, &top, t);
            for k in 0..3 {
                let change = (now[k] - first[k]).abs() / units[k];
                assert!(
                    change < 4e-14,
                    "constant {k} changed by {change:e} at {t} s"
                );
            }
        }
    }
}

#[test]
fn every_orientation_is_a_rotation_matrix() {
    let mut dice = Dice(78);
    for _ in 0..300 {
        let top = random_start(&mut dice).top();
        let (q, _) = top.at(dice.between(-1e4, 1e4));
        assert!((q.tr_mul(&q) - Matrix3::identity()).amax() < 1e-14 && q.determinant() > 0.0);
    }
}

#[test]
fn a_top_starts_at_its_initial_state() {
    let mut dice = Dice(79);
    for _ in 0..300 {
        let start = random_start(&mut dice);
        let (q, l) = start.top().at(0.0);
        assert!((q - start.orientation).amax() < 2e-14);
        assert!((l - start.momentum).norm() < 2e-14 * start.momentum_scale());
    }
}

#[test]
fn continuing_from_a_later_state_gives_the_same_motion() {
    let mut dice = Dice(80);
    for _ in 0..300 {
        let start = random_start(&mut dice);
        let top = start.top();
        let (orientation, momentum) = top.at(1.7);
        let later = LagrangeTop::new(start.across, start.along, start.load, orientation, momentum);
        for t in [-1.7, 0.9, 3.0] {
            let ((q, l), (p, k)) = (later.at(t), top.at(1.7 + t));
            let gap = greatest([(q - p).amax(), (l - k).norm() / start.momentum_scale()]);
            assert!(gap < 1e-11, "{gap:e} at {t} s");
        }
    }
}

#[test]
fn degenerate_starts_are_limits_of_nearby_starts() {
    // Steady, upright, hanging, free, plane: for offsets from 1e-3 down to 0, the motion changes no more than its start.
    let load = Vector3::new(0.0, 0.0, -49.0);
    let at = |tilt: f64, momentum: Vector3<f64>, pull: Vector3<f64>| {
        LagrangeTop::new(6.6, 3.2, pull, super::common::tilted(tilt), momentum).at(0.8)
    };
    let (z, push) = (Vector3::z(), Vector3::new(0.3, -0.2, 0.1));
    let steady = super::common::tilted(30.0) * Vector3::new(0.0, 2.945_444_198_542_434_7, 60.0);
    for (tilt, momentum) in [
        (30.0, steady),
        (0.0, z * 40.0),
        (0.0, z * 34.0),
        (0.0, z * 0.0),
        (180.0, z * 20.0),
        (100.0, z * 0.0),
    ] {
        let (exact_q, exact_l) = at(tilt, momentum, load);
        for k in 3..=15 {
            let d = 10_f64.powi(-k);
            let (q, l) = at(tilt + 10.0 * d, momentum + push * d, load * (1.0 + d));
            let gap = greatest([(q - exact_q).amax(), (l - exact_l).norm() / 50.0]);
            assert!(gap < 4.0 * d + 1e-13, "tilt {tilt}, {d:e} away: {gap:e}");
        }
    }
    let (free_q, free_l) = at(30.0, steady, Vector3::zeros());
    for k in 3..=300 {
        let (q, l) = at(30.0, steady, load * 10_f64.powi(-k));
        let gap = greatest([(q - free_q).amax(), (l - free_l).norm() / 50.0]);
        assert!(gap < 10_f64.powi(1 - k) + 1e-13, "load 1e-{k}: {gap:e}");
    }
}

#[test]
fn extreme_values_always_terminate() {
    let values = [
        0.0,
        -0.0,
        1.0,
        -3.0,
        1e-300,
        1e300,
        5e-324,
        f64::MAX,
        f64::INFINITY,
        f64::NAN,
    ];
    let mut dice = Dice(81);
    let mut pick = || values[(dice.unit() * values.len() as f64) as usize];
    for _ in 0..20_000 {
        let orientation =
            super::common::tilted(40.0) * Matrix3::from_diagonal_element(1.0 + 0.0 * pick());
        let (load, momentum) = (
            Vector3::from_fn(|_, _| pick()),
            Vector3::from_fn(|_, _| pick()),
        );
        let top = LagrangeTop::new(pick(), pick(), load, orientation, momentum);
        top.at(pick());
        top.tilt_range();
        top.mean_precession();
        assert!(top.nutation_period().is_none_or(f64::is_finite));
    }
}
