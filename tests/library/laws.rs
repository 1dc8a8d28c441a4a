//! Laws that the schemes obey, or violate in a known way.

use gyrolab::physics::report::ReportScheme;
use gyrolab::physics::{Body, Loads, PointMass, Scheme, SchemeInfo, State, rotation};
use nalgebra::{Complex, Matrix3, Vector3};
use std::f64::consts::TAU;

/// The report's wheel: 5 kg on ten points at R = 0.8 m, the hub at `height` (m), and the four points of the axle.
fn wheel(height: f64) -> Body {
    let rim = (0..10).map(|j| {
        let angle = TAU * f64::from(j) / 10.0;
        PointMass {
            at: Vector3::new(0.8 * angle.cos(), 0.8 * angle.sin(), height),
            mass: 0.5,
        }
    });
    let axle = [1.0, 2.0, 0.0, 0.5].map(|s| PointMass {
        at: Vector3::new(0.0, 0.0, s * height),
        mass: 0.0,
    });
    Body::new(rim.chain(axle).collect()).unwrap()
}

/// A state tilted by `tilt` (radians) about +x, with L in the body frame.
fn tilted(tilt: f64, momentum: [f64; 3]) -> State {
    let orientation = rotation::about(&Vector3::x(), tilt);
    State {
        time_s: 0.0,
        orientation,
        momentum: orientation * Vector3::from(momentum),
    }
}

fn weight() -> Loads {
    Loads {
        gravity: 9.8,
        ..Loads::default()
    }
}

fn scheme(name: &str, body: &Body, loads: &Loads, state: &State) -> Box<dyn Scheme> {
    let mut scheme = SchemeInfo::find(name).unwrap().make(body);
    scheme.load(loads);
    scheme.start(state);
    scheme
}

fn run(name: &str, body: &Body, loads: &Loads, start: &State, dt: f64, steps: u64) -> State {
    let mut state = *start;
    let mut scheme = scheme(name, body, loads, start);
    (0..steps).for_each(|_| scheme.step(dt, &mut state));
    state
}

#[test]
fn the_body_stays_rigid_over_a_million_steps() {
    let body = wheel(0.8 / 2f64.sqrt());
    let mut state = tilted(0.7, [3.0, -20.0, 1000.0]);
    let mut report = ReportScheme::new(&body);
    report.load(&weight());
    report.start(&state);
    (0..1_000_000).for_each(|_| report.step(0.01, &mut state));
    let points = body.points();
    let mut worst = 0.0f64;
    for i in 0..points.len() {
        // the stored points turn like the orientation ...
        let apart = (report.position(i) - state.orientation * points[i].at).norm();
        assert!(
            apart < 1e-9,
            "point {i} and the orientation are {apart:e} m apart"
        );
        for j in 0..i {
            let now = (report.position(i) - report.position(j)).norm();
            worst = worst.max((now - (points[i].at - points[j].at).norm()).abs());
        }
    }
    // ... and rounding grows no faster than a random walk of a million roundings of 1e-16 with a small bias.
    println!("distances between points: off by {worst:.1e} m");
    assert!(worst < 1e-10, "distances are off by {worst:e} m");
}

/// Returns the factor by which a step without torque multiplies a small offset of the axle from L, as a complex number.
fn measured_multiplier(height: f64, momentum: f64, dt: f64) -> Complex<f64> {
    let body = wheel(height);
    let offset = 1e-5;
    let start = tilted(
        0.0,
        [
            0.0,
            momentum * libm::sin(offset),
            momentum * libm::cos(offset),
        ],
    );
    let along = start.momentum.normalize();
    let across = Vector3::x();
    let frame = Matrix3::from_columns(&[across, along.cross(&across), along]);
    let seen = |state: &State| {
        let axle = frame.tr_mul(&state.axle());
        Complex::new(axle.x, axle.y)
    };
    let no_weight = Loads {
        gravity: 0.0,
        pushes: Vec::new(),
        ..Loads::default()
    };
    let end = run("report", &body, &no_weight, &start, dt, 1);
    seen(&end) / seen(&start)
}

#[test]
fn the_report_scheme_multiplies_nutation_by_the_predicted_factor() {
    // A = 1 − κ + κ e^{iψ}, κ = I3/I1, ψ = |Ω| dt; the exact factor is e^{iκψ}. The heights give κ below, at and above 1.
    for (height, side) in [(1.0, "below"), (0.8 / 2f64.sqrt(), "at"), (0.2, "above")] {
        let moments = wheel(height).inertia();
        let kappa = moments[(2, 2)] / moments[(0, 0)];
        for psi in [0.05, 0.4, 1.5, 3.0, 31.25] {
            let dt = psi * moments[(2, 2)] / 100.0;
            let measured = measured_multiplier(height, 100.0, dt);
            let predicted = Complex::from(1.0 - kappa) + Complex::from_polar(kappa, psi);
            let off = (measured - predicted).norm();
            assert!(
                off < 1e-7,
                "kappa {side} 1, psi {psi}: {measured} instead of {predicted}"
            );
            let size = (1.0 - 2.0 * kappa * (1.0 - kappa) * (1.0 - psi.cos())).sqrt();
            assert!((measured.norm() - size).abs() < 1e-7);
            let grows = measured.norm() - 1.0;
            match side {
                "below" => assert!(grows < -1e-4, "a long axle is damped: {grows}"),
                "at" => assert!(grows.abs() < 1e-7, "the isotropic body is neutral: {grows}"),
                _ => assert!(grows > 1e-4, "a flat body is fed: {grows}"),
            }
        }
    }
}
