use std::f64::consts::PI;

use super::*;
use crate::workings::Nobody;

const GRAVITY: f64 = 9.8;
const KINDS: [Kind; 2] = [Kind::Strang, Kind::Srkn11b];

/// Inertia and moment.
type Body = (Matrix3<f64>, Matrix3<f64>);

/// A body of equal points under gravity.
fn loaded(points: &[[f64; 3]], mass_kg: f64) -> Body {
    let weight = Vector3::new(0.0, 0.0, -mass_kg * GRAVITY);
    points
        .iter()
        .map(|x| Vector3::from(*x))
        .fold(Default::default(), |(inertia, moment), x| {
            let own = (Matrix3::identity() * x.dot(&x) - x * x.transpose()) * mass_kg;
            (inertia + own, moment + x * weight.transpose())
        })
}

/// Ten points on a rim of 0.8 m at 1 m, four on the axle, 0.5 kg each: I1 = 8.35, I3 = 3.2 kg m^2, 63.7 N m.
fn heavy_top() -> Body {
    let rim = (0..10)
        .map(|j| PI * f64::from(j) / 5.0)
        .map(|a| [0.8 * libm::cos(a), 0.8 * libm::sin(a), 1.0]);
    let axle = [0.0, 0.5, 1.0, 1.5].map(|z| [0.0, 0.0, z]);
    loaded(&rim.chain(axle).collect::<Vec<_>>(), 0.5)
}

/// The body's axes named y, z, x.
const RENAMED: Matrix3<f64> = Matrix3::new(0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0);

fn tops() -> [(&'static str, Body); 4] {
    // The centre of mass is off every axis.
    let lopsided = [
        [0.9, 0.0, 0.7],
        [-0.3, 0.5, 1.1],
        [0.1, -0.6, 0.9],
        [0.2, 0.1, 1.6],
    ];
    let (inertia, moment) = heavy_top();
    let aside = Vector3::new(0.8, 0.0, 1.0) * Vector3::new(3.0, -2.0, -5.0).transpose();
    // The axis of the body is along x, the load still on z.
    let rolled = RENAMED * inertia * RENAMED.transpose();
    [
        ("heavy", (inertia, moment)),
        ("lopsided", loaded(&lopsided, 1.2)),
        ("side load", (inertia, moment + aside)),
        ("load across the axis", (rolled, moment)),
    ]
}

/// Tilted by 45 degrees about +x; `momentum` in the body frame.
fn tilted(momentum: [f64; 3]) -> State {
    let c = 0.5_f64.sqrt();
    let orientation = Matrix3::new(1.0, 0.0, 0.0, 0.0, c, -c, 0.0, c, c);
    State {
        time_s: 0.0,
        orientation,
        momentum: orientation * Vector3::from(momentum),
    }
}

fn general_start() -> State {
    tilted([2.0, -5.0, 30.0])
}

fn run(kind: Kind, (inertia, moment): Body, mut state: State, seconds: f64, steps: u32) -> State {
    let scheme = Splitting::new(kind, &inertia, &moment);
    (0..steps).for_each(|_| scheme.step(&mut state, seconds / f64::from(steps), &mut Nobody));
    state
}

fn distance(a: &State, b: &State) -> f64 {
    (a.orientation - b.orientation).norm() + (a.momentum - b.momentum).norm() / b.momentum.norm()
}

fn energy((inertia, moment): &Body, state: &State) -> f64 {
    let momentum = state.orientation.tr_mul(&state.momentum);
    let omega = inertia
        .cholesky()
        .map_or(momentum, |factors| factors.solve(&momentum));
    0.5 * momentum.dot(&omega) - (state.orientation * moment).trace()
}

/// Against the axle's direction after 10 s by the closed form of the heavy top (elliptic functions, 25 digits): a cusped and a looping
/// motion.
#[test]
fn the_exact_motion_of_a_heavy_top_is_met() {
    let cusped = [0.27223876596338725, -0.6990663388712098, 0.6612051936909865];
    let looping = [
        -0.5598361163703238,
        0.39797433249092845,
        -0.7267736604237891,
    ];
    for (momentum, exact, strang) in [
        ([0.0, 0.0, 100.0], cusped, 1.2e-3),
        ([0.0, -20.0, 30.0], looping, 6e-3),
    ] {
        for (kind, tolerance) in [(Kind::Strang, strang), (Kind::Srkn11b, 2e-12)] {
            let end = run(kind, heavy_top(), tilted(momentum), 10.0, 600);
            let error = 1.5 * (end.orientation.column(2) - Vector3::from(exact)).norm();
            assert!(error < tolerance, "{kind:?}: {error:e} m");
        }
    }
}

#[test]
fn the_coefficients_are_consistent_and_palindromic() {
    for kind in KINDS {
        let (mut kicks, free): (Vec<f64>, Vec<f64>) = kind.stages().iter().copied().unzip();
        kicks.push(kicks[0]);
        for coefficients in [kicks, free] {
            let sum: f64 = coefficients.iter().sum();
            assert!((sum - 1.0).abs() < 1e-15, "{kind:?}: {sum}");
            assert!(coefficients.iter().eq(coefficients.iter().rev()));
        }
    }
}

/// The order from the self-distances at steps of one ratio 1 : 2 : 4, in a range where neither rounding nor higher orders show.
#[test]
fn the_order_is_as_named() {
    for (name, top) in tops() {
        for (kind, named, coarse) in [(Kind::Strang, 2.0, 400), (Kind::Srkn11b, 6.0, 40)] {
            let end = |steps| run(kind, top, general_start(), 2.0, steps);
            let [a, b, c] = [coarse, 2 * coarse, 4 * coarse].map(end);
            let order: f64 = libm::log2(distance(&a, &b) / distance(&b, &c));
            assert!((order - named).abs() < 0.15, "{name}, {kind:?}: {order}");
        }
    }
}

/// A scheme that is not symplectic adds a little at every turn; here the swing of the first seconds is never left.
#[test]
fn energy_does_not_drift_over_a_million_steps() {
    const ALL: u32 = if cfg!(debug_assertions) {
        50_000
    } else {
        1_000_000
    };
    let parts = [20_000, ALL - 20_000];
    for (name, body) in tops() {
        for (kind, h, tolerance) in [(Kind::Strang, 0.005, 1e-2), (Kind::Srkn11b, 0.02, 1e-7)] {
            let scheme = Splitting::new(kind, &body.0, &body.1);
            let mut state = general_start();
            let start = energy(&body, &state);
            let [early, late] = parts.map(|steps| {
                (0..steps).fold(0.0_f64, |most, _| {
                    scheme.step(&mut state, h, &mut Nobody);
                    most.max((energy(&body, &state) - start).abs() / start.abs())
                })
            });
            let q = state.orientation;
            let off = (q.tr_mul(&q) - Matrix3::identity()).norm() + (q.determinant() - 1.0).abs();
            assert!(off < 4e-15, "{name}, {kind:?}: {state:?}");
            // Rounding, where it does not cancel: 1e-16 a step.
            let rounding = 1e-16 * f64::from(ALL);
            assert!(
                early < tolerance && late < 1.2 * early + rounding,
                "{name}, {kind:?}: {early:e}, then {late:e}"
            );
        }
    }
}

/// Over 5 s, in which neighbouring motions part by less than 200 times: later the load across the axis is chaotic.
#[test]
fn backwards_undoes_forwards() {
    for (name, top) in tops() {
        for kind in KINDS {
            let start = general_start();
            let there = run(kind, top, start, 5.0, 250);
            let back = run(kind, top, there, -5.0, 250);
            let error = distance(&back, &start);
            assert!(error < 3e-12, "{name}, {kind:?}: {error:e}");
            assert!(distance(&there, &start) > 0.1);
        }
    }
}

/// The quick way for loads on the axle is the general one.
#[test]
fn axle_and_any_top_agree() {
    let (inertia, moment) = heavy_top();
    let body = FreeBody::new(&inertia);
    let general = AnyTop { body, moment };
    for (kind, h, steps) in [
        (Kind::Strang, 0.01, 20),
        (Kind::Srkn11b, 0.1, 20),
        (Kind::Srkn11b, 3.0, 1),
    ] {
        let scheme = Splitting::new(kind, &inertia, &moment);
        assert!(matches!(scheme.top, Top::Axle(_)));
        let (mut quick, mut slow) = (general_start(), general_start());
        for _ in 0..steps {
            scheme.step(&mut quick, h, &mut Nobody);
            general.step(kind.stages(), &mut slow, h, &mut Nobody);
        }
        let error = distance(&quick, &slow);
        assert!(error < 1e-13, "{kind:?} {h}: {error:e}");
    }
}

/// The same top with the axes of its body named differently: x, y, z become y, z, x and z, x, y.
#[test]
fn the_axis_of_symmetry_may_be_any() {
    let (start, (inertia, moment)) = (general_start(), heavy_top());
    for kind in KINDS {
        let expected = run(kind, heavy_top(), start, 5.0, 100);
        for names in [RENAMED, RENAMED * RENAMED] {
            let renamed = (names.tr_mul(&inertia) * names, names.tr_mul(&moment));
            let mut state = start;
            state.orientation *= names;
            let mut end = run(kind, renamed, state, 5.0, 100);
            end.orientation *= names.transpose();
            let error = distance(&end, &expected);
            assert!(error < 1e-12, "{kind:?}: {error:e}");
        }
    }
}

#[test]
fn a_fresh_scheme_continues_bit_for_bit() {
    for (name, (inertia, moment)) in tops() {
        let scheme = Splitting::new(Kind::Srkn11b, &inertia, &moment);
        let mut whole = tilted([0.0, 0.0, 100.0]);
        let mut parts = whole;
        for _ in 0..50 {
            scheme.step(&mut whole, 0.02, &mut Nobody);
            Splitting::new(Kind::Srkn11b, &inertia, &moment).step(&mut parts, 0.02, &mut Nobody);
        }
        assert_eq!(whole, parts, "{name}");
    }
}

#[test]
fn without_momentum_without_load_and_with_nonsense() {
    let (inertia, moment) = heavy_top();
    let still = tilted([0.0; 3]);
    let left = run(Kind::Strang, (inertia, Matrix3::zeros()), still, 1.0, 10);
    assert!((left.orientation - still.orientation).norm() < 1e-15);
    let falling = run(Kind::Srkn11b, (inertia, moment), still, 0.5, 10);
    assert!(falling.orientation.m33 < still.orientation.m33);
    for value in [f64::NAN, f64::INFINITY] {
        let loaded = (inertia, Matrix3::from_element(value));
        let lost = run(Kind::Srkn11b, loaded, still, 1.0, 2);
        assert!(!lost.momentum.x.is_finite());
    }
}
