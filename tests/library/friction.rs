//! The laws of friction: decay of spin and swing, stopping of the spin, work, and stability at every time step.

use crate::support::words::has;
use gyrolab::engine::analysis::readouts::{ReadoutValue, find};
use gyrolab::engine::analysis::{Monitor, Readouts};
use gyrolab::engine::run::Simulation;
use gyrolab::engine::scenario::{Document, Scenario};
use gyrolab::physics::scheme::true_to;
use gyrolab::physics::{
    Body, Friction, Loads, PointForce, PointMass, Scheme, SchemeInfo, State, observables, rotation,
};
use nalgebra::Vector3;
use std::f64::consts::FRAC_PI_3;
use std::sync::Arc;

/// The report's wheel of 5 kg, with a massless point on the axle and one off it.
fn wheel() -> Body {
    body(0.5)
}

/// The wheel with a first point of `first` kg: 0.5 is symmetric.
fn body(first: f64) -> Body {
    let ring = (0..10).map(|j| {
        let (sin, cos) = libm::sincos(std::f64::consts::TAU * f64::from(j) / 10.0);
        PointMass {
            at: Vector3::new(0.8 * cos, 0.8 * sin, 0.5),
            mass: if j == 0 { first } else { 0.5 },
        }
    });
    let without_mass =
        [Vector3::z(), Vector3::new(0.4, 0.0, 0.5)].map(|at| PointMass { at, mass: 0.0 });
    Body::new(ring.chain(without_mass).collect()).unwrap()
}

const OFF_AXLE: usize = 11;

fn moments(body: &Body) -> (f64, f64) {
    let inertia = body.inertia();
    (inertia[(0, 0)], inertia[(2, 2)])
}

/// A state tilted by 60 degrees, with the angular velocity `omega` in the body frame.
fn start(body: &Body, omega: [f64; 3]) -> State {
    let orientation = rotation::about(&Vector3::x(), FRAC_PI_3);
    State {
        time_s: 0.0,
        orientation,
        momentum: orientation * (body.inertia() * Vector3::from(omega)),
    }
}

/// Friction from the dry, viscous and quadratic coefficients of the spin and the coefficient of the swing.
fn friction_of([spin_dry, spin_viscous, spin_quadratic, swing_viscous]: [f64; 4]) -> Friction {
    Friction {
        spin_dry,
        spin_viscous,
        spin_quadratic,
        swing_viscous,
    }
}

fn weight(friction: Friction) -> Loads {
    Loads {
        gravity: 9.8,
        ..free(friction)
    }
}

fn free(friction: Friction) -> Loads {
    Loads {
        friction,
        ..Loads::default()
    }
}

#[track_caller]
fn is_near(found: f64, expected: f64, within: f64, case: &str) {
    let off = (found - expected).abs();
    assert!(off < within, "{case}: {found} for {expected}");
}

/// A run under one scheme, with its state and the work done by friction, J.
struct Run {
    scheme: Box<dyn Scheme>,
    state: State,
    work: f64,
}

impl Run {
    fn new(name: &str, body: &Body, loads: &Loads, start: State) -> Self {
        let mut scheme = SchemeInfo::find(name).unwrap().make(body);
        scheme.load(loads);
        scheme.start(&start);
        Self {
            scheme,
            state: start,
            work: 0.0,
        }
    }

    fn step(&mut self, dt: f64, steps: u32) -> &State {
        for _ in 0..steps {
            self.scheme.step(dt, &mut self.state);
            self.work += self.scheme.friction_work();
        }
        &self.state
    }
}

fn spin_momentum(state: &State) -> f64 {
    state.axle().dot(&state.momentum)
}

fn energy(body: &Body, loads: &Loads, state: &State) -> f64 {
    observables::total_energy(body, state, loads.gravity)
}

fn omega_across(body: &Body, state: &State) -> f64 {
    let omega = observables::angular_velocity(body, state);
    let axle = state.axle();
    (omega - axle * axle.dot(&omega)).norm()
}

/// The schemes that follow the law of the spin to rounding, since nothing else changes L along the axle.
const TRUE_TO_SPIN: [&str; 2] = ["strang", "exact"];

/// L along the axle after `t` seconds by the law of the spin: arguments are the initial L (J s), the moment and `t`.
type Law = fn(f64, f64, f64) -> f64;

#[test]
fn the_spin_decays_by_its_law_for_any_motion_of_the_axle() {
    let body = wheel();
    let (_, along) = moments(&body);
    let cases: [(Friction, Law); 3] = [
        (friction_of([0.0, 0.3, 0.0, 0.0]), |begun, inertia, t| {
            begun * (-0.3 * t / inertia).exp()
        }),
        (friction_of([2.0, 0.0, 0.0, 0.0]), |begun, _, t| {
            begun.signum() * (begun.abs() - 2.0 * t).max(0.0)
        }),
        (friction_of([0.0, 0.0, 0.02, 0.0]), |begun, inertia, t| {
            begun / (1.0 + begun.abs() * 0.02 * t / (inertia * inertia))
        }),
    ];
    for (friction, law) in cases {
        for (swing, spin) in [(0.0, 12.0), (0.7, 12.0), (0.7, -12.0), (0.0, -3.0)] {
            let friction = Friction {
                swing_viscous: swing,
                ..friction
            };
            for name in TRUE_TO_SPIN {
                let begin = start(&body, [0.4, -0.3, spin]);
                let first = spin_momentum(&begin);
                let mut run = Run::new(name, &body, &weight(friction), begin);
                for second in 1..=25 {
                    run.step(0.01, 100);
                    let expected = law(first, along, f64::from(second));
                    let case = format!("{name}, {friction:?}, {spin} rad/s, {second} s");
                    let found = spin_momentum(&run.state);
                    is_near(found, expected, 1e-11 * first.abs(), &case);
                }
            }
        }
    }
}

#[test]
fn combined_dry_viscous_and_quadratic_friction_solves_its_equation() {
    let body = wheel();
    let (_, along) = moments(&body);
    // The three signs of the discriminant k1^2 - 4 k0 k2.
    for [dry, viscous, quadratic] in [
        [0.5, 2.0, 0.1],
        [0.4, 0.4, 0.1],
        [2.0, 0.1, 0.5],
        [0.0, 0.2, 0.1],
    ] {
        let friction = friction_of([dry, viscous, quadratic, 0.0]);
        let slope = |spin: f64| -(dry + viscous * spin + quadratic * spin * spin) / along;
        for name in TRUE_TO_SPIN {
            let mut run = Run::new(name, &body, &free(friction), start(&body, [0.2, 0.0, 5.0]));
            let mut spin = 5.0;
            for step in 1..=2000 {
                run.step(0.01, 1);
                // Runge-Kutta steps so short that their error is rounding.
                for _ in 0..20 {
                    let h = 0.0005;
                    let k1 = slope(spin);
                    let k2 = slope(spin + 0.5 * h * k1);
                    let k3 = slope(spin + 0.5 * h * k2);
                    let k4 = slope(spin + h * k3);
                    spin += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
                }
                if spin <= 0.05 {
                    break;
                }
                let found = spin_momentum(&run.state) / along;
                let case = format!("{name}, {friction:?}, step {step}");
                is_near(found, spin, 1e-10, &case);
            }
            run.step(0.01, 3000);
            let stopped = spin_momentum(&run.state);
            if dry > 0.0 {
                assert!(stopped.abs() < 1e-12, "{name}, {friction:?}: {stopped}");
            }
        }
    }
}

#[test]
fn friction_of_the_swing_does_not_slow_the_spin() {
    let body = wheel();
    let (across, _) = moments(&body);
    let friction = friction_of([0.0, 0.0, 0.0, 0.9]);
    for spin in [8.0, 0.0, -8.0] {
        let begin = start(&body, [0.6, 0.2, spin]);
        let (swing, first) = (omega_across(&body, &begin), spin_momentum(&begin));
        for name in TRUE_TO_SPIN {
            let mut run = Run::new(name, &body, &free(friction), begin);
            for second in 1..=20 {
                run.step(0.01, 100);
                let expected = swing * (-0.9 * f64::from(second) / across).exp();
                let found = omega_across(&body, &run.state);
                is_near(found, expected, 1e-11 * swing, name);
                let within = 1e-11 * first.abs().max(1.0);
                is_near(spin_momentum(&run.state), first, within, name);
            }
        }
    }
}

#[test]
fn the_work_of_friction_equals_the_energy_loss() {
    let all = friction_of([0.4, 0.05, 0.01, 0.3]);
    let smooth = Friction {
        spin_dry: 0.0,
        ..all
    };
    for body in [body(0.5), body(0.9)] {
        for (name, friction, allowed) in [
            ("exact", all, 1e-11),
            ("exact", smooth, 1e-11),
            ("rk4", smooth, 1e-8),
            ("strang", all, 2e-6),
        ] {
            let loads = weight(friction);
            let begin = start(&body, [0.4, -0.3, 20.0]);
            let first = energy(&body, &loads, &begin);
            let mut run = Run::new(name, &body, &loads, begin);
            run.step(0.002, 5000);
            let lost = energy(&body, &loads, &run.state) - first;
            assert!(run.work < -100.0, "{name}: {}", run.work);
            let case = format!("{name}, {friction:?}");
            is_near(lost, run.work, allowed * first.abs(), &case);
        }
    }
}

#[test]
fn schemes_with_friction_converge_to_the_exact_motion() {
    let smooth = friction_of([0.0, 0.2, 0.01, 0.4]);
    let dry = friction_of([0.5, 0.2, 0.01, 0.4]);
    for body in [body(0.5), body(0.9)] {
        for friction in [smooth, dry] {
            let loads = weight(friction);
            let begin = start(&body, [0.4, -0.3, 9.0]);
            let at_end = |scheme: &str, count: u32| {
                let mut run = Run::new(scheme, &body, &loads, begin);
                run.step(3.0 / f64::from(count), count).axle()
            };
            let exact = at_end("exact", 300);
            for scheme in true_to(friction) {
                let Some(order) = scheme.order else { continue };
                let off = |steps| (at_end(scheme.name, steps) - exact).norm();
                let steps = if order == 1 { 30_000 } else { 1500 };
                let found = (off(steps) / off(2 * steps)).log2();
                let case = format!("{}, {friction:?}", scheme.name);
                is_near(found, f64::from(order), 0.15, &case);
            }
        }
    }
}

/// The free motion of a lopsided body turns it about its axle even while dry friction holds the spin at zero, and friction
/// of the swing slows the held body.
#[test]
fn splitting_keeps_its_order_while_dry_friction_holds_the_spin() {
    let body = body(0.9);
    for (friction, omega) in [
        (friction_of([8.0, 0.0, 0.0, 0.0]), [1.4, -1.3, 0.0]),
        (friction_of([8.0, 0.0, 0.0, 1.0]), [1.4, -1.3, 0.0]),
        // The spin stops during the run.
        (friction_of([8.0, 0.1, 0.02, 1.0]), [1.4, -1.3, 2.0]),
    ] {
        let begin = start(&body, omega);
        let at_end = |name: &str, steps: u32| {
            let mut run = Run::new(name, &body, &weight(friction), begin);
            *run.step(2.0 / f64::from(steps), steps)
        };
        let exact = at_end("exact", 300);
        let turning = exact
            .orientation
            .tr_mul(&observables::angular_velocity(&body, &exact));
        assert!(turning.z.abs() < 1e-12 && turning.norm() > 0.1, "{turning}");
        for part in [
            |state: &State| state.orientation.column(0).into_owned(),
            |state: &State| state.momentum,
        ] {
            let off = |steps| (part(&at_end("strang", steps)) - part(&exact)).norm();
            let found = (off(3000) / off(12_000)).log2() / 2.0;
            assert!((found - 2.0).abs() < 0.15, "{friction:?}: order {found}");
        }
    }
}

#[test]
fn the_report_scheme_stops_the_spin_at_the_right_time() {
    let body = wheel();
    let friction = friction_of([2.0, 0.0, 0.0, 0.0]);
    for spin in [3.0, -3.0] {
        let begin = start(&body, [0.0, 0.0, spin]);
        let stop_s = spin_momentum(&begin).abs() / 2.0;
        for dt in [0.01, 0.5, 7.0] {
            let mut run = Run::new("report", &body, &free(friction), begin);
            let before = (stop_s / dt) as u32;
            run.step(dt, before);
            let left = spin_momentum(&run.state) * spin.signum();
            let expected = 2.0 * (stop_s - dt * f64::from(before));
            is_near(left, expected, 1e-9, "before it stops");
            run.step(dt, 101);
            is_near(spin_momentum(&run.state), 0.0, 1e-14, "stopped");
        }
    }
}

#[test]
fn strong_friction_in_long_steps_is_stable() {
    let body = wheel();
    for friction in [
        friction_of([0.0, 1e4, 0.0, 0.0]),
        friction_of([0.0, 0.0, 1e6, 0.0]),
        friction_of([1e9, 1e3, 1e3, 1e4]),
    ] {
        for name in ["report", "strang"] {
            let loads = free(friction);
            let begin = start(&body, [0.5, 0.0, 30.0]);
            let mut run = Run::new(name, &body, &loads, begin);
            let mut before = energy(&body, &loads, &begin);
            for step in 0..50 {
                run.step(0.5, 1);
                let now = energy(&body, &loads, &run.state);
                let case = format!("{name}, {friction:?}, step {step}");
                let is_less = now <= before * (1.0 + 1e-12);
                assert!(is_less, "{case}: {before} to {now}");
                before = now;
            }
            is_near(spin_momentum(&run.state), 0.0, 0.02, name);
        }
    }
}

/// A hanging body at rest, on which a push off the axle exerts a torque of 0.4 m times its force about the axle.
#[test]
fn dry_friction_holds_a_resting_spin_up_to_its_torque() {
    let body = wheel();
    let hanging = State {
        time_s: 0.0,
        orientation: rotation::about(&Vector3::x(), std::f64::consts::PI),
        momentum: Vector3::zeros(),
    };
    let loads = |force: f64| Loads {
        friction: friction_of([2.0, 0.0, 0.0, 0.0]),
        pushes: vec![PointForce {
            point: OFF_AXLE,
            force: Vector3::new(0.0, force, 0.0),
        }],
        gravity: 1e6, // so strong that the push does not swing the body
    };
    for name in ["report", "strang", "exact"] {
        let mut held = Run::new(name, &body, &loads(4.9), hanging);
        held.step(0.0001, 2000);
        is_near(spin_momentum(&held.state), 0.0, 1e-9, name);
        let mut turned = Run::new(name, &body, &loads(5.1), hanging);
        turned.step(0.0001, 2000);
        // 5.1 N at 0.4 m, in the frame of the hanging body, minus 2 N m, for 0.2 s.
        let expected = -(5.1 * 0.4 - 2.0) * 0.2;
        let found = spin_momentum(&turned.state);
        is_near(found, expected, 1e-3 * expected.abs(), name);
    }
}

#[test]
fn the_exact_motion_with_friction_does_not_depend_on_query_order() {
    let body = body(0.9);
    let friction = friction_of([1.5, 0.1, 0.0, 0.2]);
    let begin = start(&body, [0.4, -0.3, 9.0]);
    let loads = weight(friction);
    let exact = || gyrolab::physics::ExactMotion::new(&body, &loads, &begin);
    let mut forward = exact();
    let times: Vec<_> = (0..400).map(|i| f64::from(i) * 0.37).collect();
    let states: Vec<_> = times.iter().map(|&t| forward.at(t)).collect();
    let mut about = exact();
    for i in (0..400).map(|i| i * 167 % 400) {
        assert_eq!(about.at(times[i]), states[i], "at {} s", times[i]);
    }
}

#[test]
fn friction_of_the_swing_damps_nutation_and_makes_a_fast_top_sink() {
    let body = wheel();
    let (across, _) = moments(&body);
    let swing = 0.5;
    let loads = weight(friction_of([0.0, 0.0, 0.0, swing]));
    let begin = start(&body, [0.0, 0.0, 200.0]);
    let mut run = Run::new("exact", &body, &loads, begin);
    let load = 9.8 * body.first_moment().z;
    run.step(0.01, 10_000); // the nutation has decayed by e^-15
    let (first, spin) = (
        observables::tilt_deg(&run.state).to_radians(),
        spin_momentum(&run.state),
    );
    let precession = load / spin;
    run.step(0.01, 2000);
    let now = observables::tilt_deg(&run.state).to_radians();
    let mean = 0.5 * (now + first);
    let expected = swing * precession * mean.sin() / spin * 20.0;
    // To first order: the ratio is 1 + 2 I1 M g c cos(tilt)/L3^2.
    let next_order = 1.0 + 2.0 * across * load * mean.cos() / (spin * spin);
    let ratio = (now - first) / expected;
    is_near(ratio / next_order, 1.0, 1e-4, "sinking");
}

#[test]
fn a_sleeping_top_falls_when_its_spin_drops_below_the_limit() {
    let body = wheel();
    let (across, along) = moments(&body);
    let load = 9.8 * body.first_moment().z;
    let limit = 2.0 * (across * load).sqrt();
    let tilt: f64 = 1e-4;
    let orientation = rotation::about(&Vector3::x(), tilt);
    let begin = State {
        time_s: 0.0,
        orientation,
        momentum: orientation * Vector3::new(0.0, 0.0, 1.1 * limit),
    };
    // Time in which the spin falls to 1/e, s.
    for decay_s in [300.0, 30.0] {
        let loads = weight(friction_of([0.0, along / decay_s, 0.0, 0.0]));
        let mut run = Run::new("exact", &body, &loads, begin);
        while observables::tilt_deg(&run.state).to_radians() < 10.0 * tilt {
            run.step(0.01, 1);
            assert!(spin_momentum(&run.state) > 0.5 * limit, "still sleeping");
        }
        let found = spin_momentum(&run.state) / limit;
        let expected = waking_momentum(across, load, 1.1 * limit, decay_s) / limit;
        is_near(found, expected, 2e-4, &format!("{decay_s} s"));
        let is_below = (0.85..0.99).contains(&found);
        assert!(is_below, "within the stated range: {found}");
        let mut lowest: f64 = 0.0;
        for _ in 0..300 {
            lowest = lowest.max(observables::tilt_deg(run.step(0.1, 1)));
        }
        assert!(lowest > 30.0, "the top falls: {lowest} degrees");
    }
}

/// Returns L along the axle at which the tilt of an almost upright top is ten times its initial tilt. The horizontal part
/// of the axle, as a complex number, obeys I1 z'' - i L3(t) z' - M g c z = 0 while it is small.
fn waking_momentum(across: f64, load: f64, spin: f64, decay_s: f64) -> f64 {
    type Complex = nalgebra::Complex<f64>;
    let slope = |t: f64, [z, v]: [Complex; 2]| {
        let spin = Complex::new(0.0, spin * (-t / decay_s).exp());
        [v, (spin * v + z * load) / across]
    };
    let mut state = [Complex::new(1.0, 0.0), Complex::new(0.0, 0.0)];
    let (mut t, h) = (0.0, 1e-3);
    while state[0].norm() < 10.0 {
        let moved = |k: [Complex; 2], dt: f64| [state[0] + k[0] * dt, state[1] + k[1] * dt];
        let k1 = slope(t, state);
        let k2 = slope(t + 0.5 * h, moved(k1, 0.5 * h));
        let k3 = slope(t + 0.5 * h, moved(k2, 0.5 * h));
        let k4 = slope(t + h, moved(k3, h));
        for i in 0..2 {
            state[i] += (k1[i] + k2[i] * 2.0 + k3[i] * 2.0 + k4[i]) * (h / 6.0);
        }
        t += h;
    }
    spin * (-t / decay_s).exp()
}

/// Opens a preset with settings. Returns its scenario, or its problems in one line.
fn preset(name: &str, sets: &[&str]) -> Result<Arc<Scenario>, String> {
    let mut document = Document::open(name).unwrap();
    for set in sets {
        document.set(set).unwrap();
    }
    let scenario = document.scenario();
    scenario
        .map(Arc::new)
        .map_err(|problems| problems.in_one_line())
}

#[test]
fn schemes_that_cannot_model_friction_are_rejected_with_a_reason() {
    let refused = |name: &str, sets: &[&str]| preset(name, sets).unwrap_err();
    let names = |friction| {
        let names: Vec<_> = true_to(friction).map(|scheme| scheme.name).collect();
        names.join(", ")
    };
    let reason = "it goes backwards in time within a step, where friction would feed the motion";
    let others = names(friction_of([0.0, 0.0, 0.0, 0.5]));
    assert_eq!(
        refused("first-dip", &["motion.scheme=srkn11b"]),
        format!(
            "motion.scheme (\"srkn11b\") does not support this friction: {reason}; use one of {others}"
        )
    );
    let dry = "friction.spin_dry_Nm=0.1";
    let of_dry =
        "it takes the torque as smooth in time, which dry friction is not where it stops the spin";
    let true_to_dry = names(friction_of([0.1, 0.0, 0.0, 0.5]));
    assert_eq!(
        refused("first-dip", &["motion.scheme=rk4", dry]),
        format!(
            "motion.scheme (\"rk4\") does not support this friction: {of_dry}; use one of {true_to_dry}"
        )
    );
    let edit = "edit=[{step=10,set={\"motion.scheme\"=\"srkn11b\"}}]";
    assert_eq!(
        refused("first-dip", &[edit]).split(" does not").next(),
        Some("edit.0.set.motion.scheme (\"srkn11b\")")
    );
    // Without friction, or with coefficients of zero, the scheme is allowed.
    let none = ["motion.scheme=srkn11b", "friction.spin_dry_Nm=0"];
    assert!(preset("cusps", &none).is_ok());
}

#[test]
fn theory_with_friction_is_instantaneous_and_predicts_no_motion() {
    let readouts = |name: &str, sets: &[&str], steps: u64| {
        let scenario = preset(name, sets).unwrap();
        let mut simulation = Simulation::new(scenario);
        let mut monitor = Monitor::new(simulation.now());
        for _ in 0..steps {
            monitor.record(simulation.step().unwrap());
        }
        let health = monitor.health(simulation.now());
        Readouts::new(&simulation, &mut monitor, &health, None)
    };
    let rubbed = readouts("first-dip", &[], 3000);
    let spared = readouts("first-dip", &["friction.swing_viscous_Nms=0"], 3000);
    for name in [
        "path",
        "predicted_lowest_tilt_deg",
        "predicted_highest_tilt_deg",
        "predicted_precession_rad_per_s",
        "predicted_nutation_period_s",
        "predicted_precession_period_s",
        "measured_precession_rad_per_s",
        "measured_nutation_period_s",
    ] {
        let of = |of_run: &Readouts| find(name).unwrap().read_from(of_run);
        assert_eq!(of(&rubbed), ReadoutValue::Nothing, "{name}");
        assert_ne!(of(&spared), ReadoutValue::Nothing, "{name}");
    }
    // M g c/L3 at the current time.
    let fast_top = rubbed.number("fast_top_precession_rad_per_s").unwrap();
    assert!((fast_top - 49.0 / 100.0).abs() < 1e-12);
    assert!(rubbed.number("friction_work_J").unwrap() < -1.0);
    assert_eq!(spared.number("friction_work_J"), None);
    assert!(rubbed.number("energy_drift").unwrap().abs() < 1e-6);
    let slowing = rubbed.health.slowing.unwrap();
    assert!((slowing.swing_decay_s.unwrap() - 3.3).abs() < 1e-9);
    assert_eq!((slowing.spin_decay_s, slowing.spin_stop_s), (None, None));
    // A spin of the size of rounding counts as stopped.
    let stopped = readouts("first-dip", &["friction.spin_dry_Nm=100"], 3000);
    let told = stopped.health.slowing.unwrap().to_string();
    has(&told, "; dry: it has stopped the spin; on");
}

/// Friction of the bearing and the air acts on the wheel alone, so only the wheel's moment counts.
#[test]
fn friction_acts_on_the_spin_of_the_rotor() {
    let wheel: f64 = 0.5 * 1.8 * 0.12 * 0.12;
    for name in TRUE_TO_SPIN {
        let scheme = format!("motion.scheme={name}");
        let sets = [
            "friction.spin_dry_Nm=0",
            "friction.spin_quadratic_Nms2=0",
            &scheme,
        ];
        let scenario = preset("lab-gyroscope", &sets).unwrap();
        let mut simulation = Simulation::new(scenario);
        let first = spin_momentum(simulation.state());
        simulation.step_to(4000).unwrap();
        let expected = first * (-3e-5 * 20.0 / wheel).exp();
        let found = spin_momentum(simulation.state());
        is_near(found / expected, 1.0, 1e-9, name);
    }
}

#[test]
fn energy_and_friction_work_use_the_rotor_moment() {
    // The spin energy of the wheel plus the tilting energy of the whole body, from the moments of the parts.
    let (wheel, mass_moment) = (0.5 * 1.8 * 0.12 * 0.12, 1.8 * 0.15 - 1.3 * 0.2);
    let disk = |kg: f64, r: f64, h: f64, z: f64| kg * ((3.0 * r * r + h * h) / 12.0 + z * z);
    let across =
        disk(1.8, 0.12, 0.02, 0.15) + disk(0.2, 0.0, 0.6, 0.0) + disk(1.3, 0.04, 0.04, 0.2);
    for name in TRUE_TO_SPIN {
        let scenario = preset("lab-gyroscope", &[&format!("motion.scheme={name}")]).unwrap();
        let mut simulation = Simulation::new(scenario);
        let of = |step: &gyrolab::engine::run::Step| {
            let (axle, momentum) = (step.after().axle(), step.after().momentum);
            let spin = momentum.dot(&axle);
            let swing = (momentum.norm_squared() - spin * spin) / across;
            0.5 * (swing + spin * spin / wheel) + 9.81 * mass_moment * axle.z
        };
        let first = of(simulation.now());
        simulation.step_to(20_000).unwrap();
        let step = simulation.now();
        assert!((step.energy() - of(step)).abs() < 1e-12, "{name}");
        let lost = of(step) - first;
        assert!(lost < -15.0, "{name}: {lost}");
        assert!((step.friction_work() - lost).abs() < 1e-6, "{name}: {lost}");
    }
}

#[test]
fn explaining_steps_with_friction_changes_no_bits() {
    for name in ["report", "strang"] {
        let scheme = format!("motion.scheme={name}");
        let scenario = preset("lab-gyroscope", &[&scheme, "motion.time_step_s=0.01"]).unwrap();
        let mut plain = Simulation::new(Arc::clone(&scenario));
        let mut explained = Simulation::new(scenario);
        explained.keep_workings(true);
        for _ in 0..50 {
            plain.step().unwrap();
            explained.step().unwrap();
        }
        assert_eq!(plain.state(), explained.state(), "{name}");
        let workings = explained.now().workings().unwrap();
        let last = workings.phases().last().unwrap();
        assert_eq!(last.name.text(), "friction", "{name}");
        let told = last.value("new L").unwrap();
        assert_eq!(*told, explained.state().momentum.into(), "{name}");
    }
}
