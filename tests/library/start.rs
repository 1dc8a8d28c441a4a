//! The start of a scenario: tilt, turn and roll; momentum, spin, angular velocity or Euler rates; steady precession; rotors.

use crate::support::scenarios::changed;
use crate::support::scenarios::{parse, preset, read};
use crate::support::words::has;
use gyrolab::engine::journal::parameters::{Parameter, parameters, table_of};
use gyrolab::engine::run::Simulation;
use gyrolab::engine::scenario::{Document, Scenario};
use gyrolab::physics::observables::{angular_velocity, tilt_deg};
use gyrolab::physics::rotation;
use nalgebra::{Rotation3, Vector3};
use proptest::prelude::*;
use std::f64::consts::TAU;
use std::sync::Arc;
use toml::Value;

/// The textbook's ring of 5 kg at 1 m (I1 = 6.6, I3 = 3.2 kg m², mgl = 49 N m), with additional text `start` and `motion`.
fn text(start: &str, motion: &str) -> String {
    format!(
        "title = 'x'\n[body.rim]\npoints = 10\nradius_m = 0.8\nheight_m = 1\npoint_mass_kg = 0.5\n[[body.point]]\nname = 'top'\nat_m = [0, 0, 1.5]\n[start]\n{start}\n[motion]\nscheme = 'exact'\ntime_step_s = 0.01\nsteps = 1000\n{motion}\n"
    )
}

fn ring(start: &str) -> Scenario {
    parse(&text(start, ""))
}

fn refusal(start: &str) -> String {
    read(&text(start, "")).unwrap_err().to_string()
}

/// The ring with a mass off its axle.
fn lopsided(start: &str) -> String {
    text(start, "").replace("at_m = [0, 0, 1.5]", "at_m = [0.3, 0, 1.5]\nmass_kg = 1")
}

fn omega(scenario: &Scenario) -> Vector3<f64> {
    angular_velocity(&scenario.body.mechanics, &scenario.start)
}

/// Returns the largest change of the tilt from its initial value, degrees.
fn tilt_swing_deg(scenario: Scenario) -> f64 {
    let (tilt, steps) = (tilt_deg(&scenario.start), scenario.steps);
    let mut simulation = Simulation::new(Arc::new(scenario));
    let mut swing = 0.0f64;
    for _ in 0..steps {
        simulation.step().unwrap();
        swing = swing.max((tilt_deg(simulation.state()) - tilt).abs());
    }
    swing
}

#[test]
fn the_spin_is_the_rate_about_the_axle() {
    let scenario = ring("tilt_deg = 40\nspin_rad_per_s = 20");
    assert!((omega(&scenario) - 20.0 * scenario.start.axle()).amax() < 1e-13);
    assert!((scenario.start.momentum - 64.0 * scenario.start.axle()).amax() < 1e-12);
    let rpm = 20.0 * 60.0 / TAU;
    let same = ring(&format!("tilt_deg = 40\nspin_rpm = {rpm:?}"));
    assert!((same.start.momentum - scenario.start.momentum).amax() < 1e-13);
}

#[test]
fn a_lopsided_body_spins_about_its_axle_too() {
    let scenario = parse(&lopsided("tilt_deg = 40\nspin_rad_per_s = 20"));
    assert!((omega(&scenario) - 20.0 * scenario.start.axle()).amax() < 1e-13);
    assert!(scenario.start.momentum.cross(&scenario.start.axle()).norm() > 1.0);
}

#[test]
fn a_steady_start_keeps_its_tilt() {
    let starts = [
        "tilt_deg = 30\nspin_rad_per_s = 18.75",
        "tilt_deg = 30\nspin_rpm = -300",
        "tilt_deg = 90\nspin_rpm = 300",
        "tilt_deg = 150\nspin_rpm = 100",
        "tilt_deg = 150\nspin_rpm = 0",
        "tilt_deg = -30\nturn_deg = 77\nroll_deg = 5\nspin_rpm = 300",
        "spin_rpm = 300",
        "tilt_deg = 180\nspin_rpm = 300",
    ];
    for start in starts {
        for gravity in [9.8, -3.0, 0.0] {
            let gravity_is = format!("gravity_m_per_s2 = {gravity}");
            let text = text(&format!("{start}\nsteady = true"), &gravity_is);
            match read(&text) {
                Ok(scenario) => {
                    let swing = tilt_swing_deg(scenario);
                    assert!(swing < 1e-9, "{start}, {gravity}: {swing}");
                }
                // With reversed gravity, a hanging top without spin has no steady precession.
                Err(problems) => assert!(start.contains("rpm = 0") && gravity < 0.0, "{problems}"),
            }
        }
    }
    assert!(tilt_swing_deg(ring("tilt_deg = 30\nspin_rad_per_s = 18.75")) > 1.0);
}

#[test]
fn a_steady_start_equals_that_of_the_preset() {
    let preset = preset("steady-slow", &[]);
    let spin = omega(&preset).dot(&preset.start.axle());
    let start = format!("tilt_deg = 30\nspin_rad_per_s = {spin:?}\nsteady = true");
    let momentum = ring(&start).start.momentum;
    let off = (momentum - preset.start.momentum).amax();
    assert!(off < 1e-13, "{momentum}");
}

#[test]
fn the_minimum_spin_in_the_message_is_sufficient() {
    let start = |tilt: f64, rpm: f64| format!("tilt_deg = {tilt}\nspin_rpm = {rpm}\nsteady = true");
    for tilt in [1.0, 30.0, 89.0] {
        let refused = refusal(&start(tilt, 10.0));
        let words = "start.steady (true) has no steady precession at this tilt";
        has(&refused, words);
        let (_, least) = refused.split_once("at least ").unwrap();
        let rpm: f64 = least.split(' ').next().unwrap().parse().unwrap();
        ring(&start(tilt, rpm));
        refusal(&start(tilt, rpm * 0.998));
    }
    has(refusal(&start(90.0, 0.0)), "the spin must not be zero");
}

#[test]
fn two_forms_of_a_start_at_once_are_rejected_with_a_remedy() {
    let mut told = String::new();
    for start in [
        "momentum_Js = [0, 0, 1]\nspin_rpm = 3",
        "momentum_Js = [0, 0, 1]\nspin_rad_per_s = 3",
        "spin_rpm = 2\nspin_rad_per_s = 3",
        "spin_rpm = 2\nmomentum_frame = 'body'",
        "momentum_Js = [0, 0, 1]\nsteady = true",
        "steady = true",
        "spin_rpm = nan",
        "omega_rad_per_s = [0, 0, 1]\nspin_rpm = 3",
        "omega_rad_per_s = [0, 0, 1]\nspin_rad_per_s = 3",
        "omega_rad_per_s = [0, 0, 1]\nmomentum_Js = [0, 0, 1]",
        "omega_rad_per_s = [0, 0, 1]\nmomentum_frame = 'body'",
        "omega_rad_per_s = [0, 0, 1]\nsteady = true",
        "spin_rpm = 3\nomega_frame = 'body'",
    ] {
        told += &format!("{start}\n{}\n\n", refusal(start));
    }
    insta::assert_snapshot!("two_ways", told);
    let lopsided = lopsided("spin_rpm = 3\nsteady = true");
    has(
        read(&lopsided).unwrap_err().to_string(),
        "this one is lopsided",
    );
}

#[test]
fn set_switches_to_the_form_of_start_that_it_names() {
    let spun = preset("method-2", &["start.spin_rpm=300"]).file.start;
    assert_eq!((spun.momentum_Js, spun.momentum_frame), (None, None));
    let ways = [
        "start.spin_rpm=300",
        "start.steady=true",
        "start.momentum_Js=[0,0,7]",
    ];
    let back = preset("method-2", &ways).file.start;
    assert_eq!((back.spin_rpm, back.steady), (None, None));
    let two_spins = ["start.spin_rpm=300", "start.spin_rad_per_s=7"];
    let last = preset("method-2", &two_spins);
    let start = &last.file.start;
    assert_eq!((start.spin_rpm, start.spin_rad_per_s), (None, Some(7.0)));
    assert_eq!(parse(&last.to_toml()).start, last.start);
}

#[test]
fn tilt_turn_and_roll_are_three_rotations() {
    let tilt = rotation::about(&Vector3::x(), 40f64.to_radians());
    let tilted = |more: &str| {
        ring(&format!("tilt_deg = 40\nmomentum_Js = [0, 0, 1]\n{more}"))
            .start
            .orientation
    };
    assert_eq!(tilted(""), tilt);
    assert_eq!(tilted("turn_deg = 0\nroll_deg = -0.0"), tilt);
    let turn = |degrees: f64| Rotation3::from_axis_angle(&Vector3::z_axis(), degrees.to_radians());
    let expected = turn(70.0).matrix() * tilt * turn(-20.0).matrix();
    assert!((tilted("turn_deg = 70\nroll_deg = -20") - expected).amax() < 1e-15);
}

fn value(scenario: &Scenario, key: &str) -> (f64, bool) {
    let rows = parameters(&table_of(&scenario.file), scenario);
    let row = rows.into_iter().find(|row| row.key == key).unwrap();
    (row.value.as_float().unwrap(), row.is_default)
}

fn assert_near((told, is_default): (f64, bool), number: f64, expected_default: bool) {
    assert!(
        (told - number).abs() < 1e-12 * number.abs().max(1.0),
        "{told}, not {number}"
    );
    assert_eq!(is_default, expected_default);
}

#[test]
fn spin_and_momentum_are_both_listed() {
    let spun = ring("tilt_deg = 40\nspin_rad_per_s = 20");
    assert_near(value(&spun, "start.spin_rad_per_s"), 20.0, false);
    assert_near(value(&spun, "start.spin_rpm"), 1200.0 / TAU, true);
    assert_near(
        value(&spun, "start.momentum_Js.2"),
        64.0 * 40f64.to_radians().cos(),
        true,
    );
    let told = ring("tilt_deg = 40\nmomentum_Js = [0, 9, 64]\nmomentum_frame = 'body'");
    assert_near(value(&told, "start.spin_rad_per_s"), 20.0, true);
    assert_near(value(&told, "start.momentum_Js.1"), 9.0, false);
}

/// Returns `scenario` with `key` changed to `value`, which must be allowed.
#[track_caller]
fn with(scenario: &Scenario, key: &str, value: impl Into<Value>) -> Scenario {
    changed(&scenario.file, key, value.into()).unwrap_or_else(|problems| panic!("{problems}"))
}

#[test]
fn editing_a_value_converts_the_start_to_its_form() {
    let told = ring("tilt_deg = 40\nmomentum_Js = [0, 9, 64]\nmomentum_frame = 'body'");
    let spun = with(&told, "start.spin_rpm", 100.0);
    let in_rpm = &spun.file.start;
    assert_eq!((in_rpm.momentum_Js, in_rpm.momentum_frame), (None, None));
    assert_eq!(in_rpm.spin_rpm, Some(100.0));
    let other = with(&spun, "start.spin_rad_per_s", 5.0);
    let in_rad = &other.file.start;
    assert_eq!((in_rad.spin_rpm, in_rad.spin_rad_per_s), (None, Some(5.0)));
    // Changing one component of L keeps the others.
    let back = with(&other, "start.momentum_Js.0", 3.0);
    let momentum = other.start.momentum;
    let known = Vector3::new(3.0, momentum.y, momentum.z);
    assert_eq!(back.start.momentum, known);
    let told_by_momentum = &back.file.start;
    assert_eq!(told_by_momentum.spin_rad_per_s, None);
    assert_eq!(told_by_momentum.momentum_frame, None);
    // Changing only the frame keeps L and converts its components.
    let turned = with(&other, "start.momentum_frame", "body");
    assert!((turned.start.momentum - momentum).amax() < 1e-13);
    let in_body = Vector3::from(turned.file.start.momentum_Js.unwrap());
    assert!((in_body - Vector3::new(0.0, 0.0, 16.0)).amax() < 1e-13);
    // A steady start keeps the spin.
    let steady = with(&told, "start.steady", true);
    assert!((steady.file.start.spin_rad_per_s.unwrap() - 20.0).abs() < 1e-13);
    assert!((omega(&steady).dot(&steady.start.axle()) - 20.0).abs() < 1e-13);
    assert!(tilt_swing_deg(steady.clone()) < 1e-9);
    let unsteady = with(&steady, "start.momentum_Js.1", 1.0).file.start;
    assert_eq!((unsteady.steady, unsteady.spin_rad_per_s), (None, None));
}

#[test]
fn editing_to_an_impossible_steady_start_is_rejected() {
    let slow = ring("tilt_deg = 40\nspin_rpm = 10");
    let problems = changed(&slow.file, "start.steady", Value::Boolean(true)).unwrap_err();
    let line = problems.in_one_line();
    let begin = "start.steady (true) has no steady precession";
    assert!(line.starts_with(begin), "{line}");
}

proptest! {
    #[test]
    fn no_start_panics_or_gives_non_finite_values(
        angles in prop::array::uniform3(prop_oneof![Just(0.0), Just(90.0), Just(180.0), -400.0..400.0f64]),
        spin in prop_oneof![Just(0.0), Just(-0.0), Just(1e-308), Just(1e308), -1e4..1e4f64],
        gravity in prop_oneof![Just(0.0), Just(1e-300), Just(1e308), -20.0..20.0f64],
        radius in prop_oneof![Just(1e-5), Just(1e100), Just(0.8)],
    ) {
        let [tilt, turn, roll] = angles;
        let start = format!("tilt_deg = {tilt:?}\nturn_deg = {turn:?}\nroll_deg = {roll:?}\nspin_rpm = {spin:?}\nsteady = true");
        let text = text(&start, &format!("gravity_m_per_s2 = {gravity:?}")).replace("radius_m = 0.8", &format!("radius_m = {radius:?}"));
        match read(&text) {
            Ok(scenario) => prop_assert!(scenario.start.is_finite()),
            Err(problems) => prop_assert!(!problems.to_string().contains("NaN") && !problems.to_string().contains("inf "), "{}", problems),
        }
    }
}

#[test]
fn an_angular_velocity_determines_the_momentum() {
    let omega_told = Vector3::new(1.0, -2.0, 30.0);
    let world = ring("tilt_deg = 40\nturn_deg = 10\nomega_rad_per_s = [1, -2, 30]");
    assert!((omega(&world) - omega_told).amax() < 1e-13);
    let body =
        ring("tilt_deg = 40\nturn_deg = 10\nomega_rad_per_s = [1, -2, 30]\nomega_frame = 'body'");
    assert!((omega(&body) - body.start.orientation * omega_told).amax() < 1e-13);
    // I1 = 6.6, I3 = 3.2 kg m².
    let in_body = body.start.orientation.tr_mul(&body.start.momentum);
    assert!((in_body - Vector3::new(6.6, -13.2, 96.0)).amax() < 1e-12);
    // The spin is the angular velocity along the axle.
    let spun = ring("tilt_deg = 40\nspin_rad_per_s = 20");
    let told = ring("tilt_deg = 40\nomega_rad_per_s = [0, 0, 20]\nomega_frame = 'body'");
    assert!((told.start.momentum - spun.start.momentum).amax() < 1e-13);
}

#[test]
fn the_editor_keeps_the_form_of_the_start() {
    let scenario = ring("tilt_deg = 40\nomega_rad_per_s = [1, -2, 30]\nomega_frame = 'body'");
    let listed = parameters(&table_of(&scenario.file), &scenario);
    let shown = |key: &str| {
        let row = listed.iter().find(|row| row.key == key);
        row.map(Parameter::shown)
    };
    assert_eq!(shown("start.omega_rad_per_s.2").as_deref(), Some("30"));
    assert_eq!(shown("start.omega_frame").as_deref(), Some("body"));
    // Editing its components or the body keeps this form.
    let faster = with(&scenario, "start.omega_rad_per_s.2", 60.0);
    assert_eq!(faster.file.start.omega_rad_per_s, Some([1.0, -2.0, 60.0]));
    let wider = with(&scenario, "body.rim.radius_m", 1.6);
    assert_eq!(wider.file.start, scenario.file.start);
    assert!(wider.start.momentum.norm() > 3.0 * scenario.start.momentum.norm());
    // Another form replaces it, with the values converted.
    let momentum = with(&scenario, "start.momentum_Js.0", 0.0);
    assert_eq!(momentum.file.start.omega_rad_per_s, None);
    assert_eq!(momentum.file.start.omega_frame, None);
    assert_eq!(momentum.start.momentum.yz(), scenario.start.momentum.yz());
    let spun = with(&scenario, "start.spin_rpm", 60.0);
    assert_eq!(spun.file.start.omega_rad_per_s, None);
    let steady = with(&scenario, "start.steady", true);
    assert!((steady.file.start.spin_rad_per_s.unwrap() - 30.0).abs() < 1e-12);
    // The conversion also works in the other direction.
    let told = with(&spun, "start.omega_rad_per_s.0", 0.5)
        .file
        .start
        .omega_rad_per_s
        .unwrap();
    assert!((Vector3::from(told) - Vector3::new(0.5, 0.0, 0.0)).x == 0.0);
    assert!((told[1].hypot(told[2]) - TAU).abs() < 1e-12);
    let framed = with(&spun, "start.omega_frame", "body");
    let in_body = Vector3::from(framed.file.start.omega_rad_per_s.unwrap());
    let off = (in_body - Vector3::new(0.0, 0.0, TAU)).amax();
    assert!(off < 1e-13, "{in_body}");
}

/// A gyroscope in a frame: a spinning wheel and a hoop in another plane that does not spin, on an axle of 2 kg.
fn gyroscope(start: &str) -> String {
    format!(
        "title = 'x'\n[[body.point]]\nname = 'top'\nat_m = [0, 0, 0.3]\n\
         [[body.part]]\nshape = 'cylinder'\nname = 'wheel'\nmass_kg = 1\nat_m = [0, 0, 0.2]\nradius_m = 0.1\n\
         [[body.part]]\nshape = 'shell'\nname = 'cage'\nmass_kg = 0.5\nat_m = [0, 0, 0.2]\nradius_m = 0.12\n\
         [[body.part]]\nshape = 'rod'\nname = 'axle'\nmass_kg = 0.1\nat_m = [0, 0, 0.2]\nlength_m = 0.4\n\
         [start]\n{start}\n[motion]\nscheme = 'exact'\ntime_step_s = 0.01\nsteps = 300\n"
    )
}

/// Moment about the axle of the wheel of [`gyroscope`], kg m².
const WHEEL: f64 = 0.5 * 0.01;

#[test]
fn only_the_rotor_has_the_spin() {
    let spun = parse(&gyroscope(
        "tilt_deg = 30\nspin_rpm = 3000\nrotor = 'wheel'",
    ));
    let spin = 3000.0 * TAU / 60.0;
    let momentum = WHEEL * spin * spun.start.axle();
    assert!((spun.start.momentum - momentum).amax() < 1e-14);
    assert!((spun.body.mechanics.inertia()[(2, 2)] - WHEEL).abs() < 1e-17);
    assert!((spun.spin_rad_per_s(&spun.start) - spin).abs() < 1e-11);
    let listed = parameters(&table_of(&spun.file), &spun);
    let row = listed.iter().find(|row| row.key == "start.rotor").unwrap();
    assert_eq!((row.shown().as_str(), row.choices.len()), ("wheel", 3));
    // With the same L given directly, the list shows the spin of the rotor.
    let told = parse(&gyroscope(
        "tilt_deg = 30\nmomentum_Js = [0, 0, 1]\nmomentum_frame = 'body'\nrotor = 'wheel'",
    ));
    let rates = parameters(&table_of(&told.file), &told);
    let rate = rates
        .iter()
        .find(|rate| rate.key == "start.spin_rad_per_s")
        .unwrap();
    assert!((rate.value.as_float().unwrap() - 1.0 / WHEEL).abs() < 1e-9);
    // An angular velocity is that of the rotor along the axle, and that of the whole body across it.
    let turning = parse(&gyroscope("omega_rad_per_s = [2, 0, 100]\nrotor = 'wheel'"));
    let across = turning.body.mechanics.inertia()[(0, 0)];
    assert!(
        (turning.start.momentum - Vector3::new(2.0 * across, 0.0, 100.0 * WHEEL)).amax() < 1e-14
    );
}

#[test]
fn precession_depends_on_the_rotor_momentum_alone() {
    // Steady precession: I1 cos(tilt) w² − C spin w + M g c = 0, with C of the wheel, and I1 and M c of the whole body.
    let steady = parse(&gyroscope(
        "tilt_deg = 30\nspin_rpm = 6000\nrotor = 'wheel'\nsteady = true",
    ));
    assert!(tilt_swing_deg(steady.clone()) < 1e-9);
    let body = &steady.body.mechanics;
    let (across, load) = (body.inertia()[(0, 0)], 9.8 * body.first_moment().z);
    let (cosine, spin) = (30.0_f64.to_radians().cos(), 6000.0 * TAU / 60.0);
    let rate =
        omega(&steady).dot(&Vector3::z()) - omega(&steady).dot(&steady.start.axle()) * cosine;
    let rate = rate / 30.0_f64.to_radians().sin().powi(2);
    let rest = across * cosine * rate * rate - WHEEL * spin * rate + load;
    assert!(rest.abs() < 1e-9 * load, "{rest}");
    assert!((rate / (load / (WHEEL * spin)) - 1.0).abs() < 0.1);
    // A scenario saved from the current state keeps the rotor.
    let state = steady.start;
    let again = gyrolab::engine::journal::restart::scenario_from(&steady, &state, 0).unwrap();
    assert_eq!(again.rotor(), steady.rotor());
    assert!(again.rotor().is_some());
}

#[test]
fn invalid_rotors_are_rejected() {
    let start = "spin_rpm = 3000\nrotor = 'wheel'";
    let good = gyroscope(start);
    let across = ("radius_m = 0.1\n", "radius_m = 0.1\naxis = [1, 0, 0]\n");
    let mut texts: Vec<_> = ["weel", "top", "axle"]
        .map(|name| good.replace("rotor = 'wheel'", &format!("rotor = '{name}'")))
        .into();
    texts.push(good.replace("at_m = [0, 0, 0.3]", "at_m = [0.1, 0, 0.3]\nmass_kg = 1"));
    let lying = good.replace(across.0, across.1);
    texts.push(lying.replace("shape = 'cylinder'", "shape = 'ball'"));
    texts.push(lying);
    // Two crossed rods are symmetric, one rod is not. Two balls are symmetric about the axle, but each is off it.
    let crossed = |a: &str, b: &str| {
        gyroscope("spin_rpm = 3000\nrotor = 'one'").replace("[start]", &format!("{a}{b}[start]"))
    };
    let block = |name: &str, size: &str| {
        format!(
            "[[body.part]]\nshape = 'block'\nname = '{name}'\nmass_kg = 1\nat_m = [0, 0, 0.2]\nsize_m = {size}\n"
        )
    };
    let uneven = crossed(
        &block("one", "[0.1, 0.2, 0]"),
        &block("two", "[0.2, 0.1, 0]"),
    );
    texts.push(uneven);
    let ball = |name: &str, x: f64, y: f64| {
        format!(
            "[[body.part]]\nshape = 'ball'\nname = '{name}'\nmass_kg = 1\nat_m = [{x}, {y}, 0.2]\nradius_m = 0.05\n"
        )
    };
    let four = [
        ball("one", 0.1, 0.0),
        ball("two", -0.1, 0.0),
        ball("three", 0.0, 0.1),
        ball("four", 0.0, -0.1),
    ]
    .concat();
    texts.push(crossed(&four, ""));
    let told = texts
        .iter()
        .map(|text| format!("{}\n", read(text).unwrap_err()));
    insta::assert_snapshot!("rotors", told.collect::<String>());
}

/// Computes by central differences the angular velocity (world frame, rad/s) of the rotation Rz(turn) Rx(tilt) Rz(roll)
/// with angles that change at `rates`, rad/s.
fn by_differences(degrees: [f64; 3], rates: [f64; 3]) -> Vector3<f64> {
    let axes = [Vector3::z_axis(), Vector3::x_axis(), Vector3::z_axis()];
    let at = |time: f64| {
        let turns = (0..3).map(|i| {
            let angle = degrees[i].to_radians() + time * rates[i];
            Rotation3::from_axis_angle(&axes[i], angle)
        });
        turns.fold(Rotation3::identity(), |product, turn| product * turn)
    };
    let half = 1e-6;
    let change = (at(half).matrix() - at(-half).matrix()) / (2.0 * half);
    let spin = change * at(0.0).matrix().transpose();
    Vector3::new(spin[(2, 1)], spin[(0, 2)], spin[(1, 0)])
}

#[test]
fn euler_rates_are_the_rates_of_turn_tilt_and_roll() {
    for [turn, tilt, roll] in [
        [0.0, 60.0, 0.0],
        [70.0, 40.0, -20.0],
        [10.0, -30.0, 200.0],
        [25.0, 0.0, 50.0],
        [25.0, 180.0, 50.0],
    ] {
        let [precession, nutation, psi_dot] = [0.7, -0.3, 9.0];
        let scenario = ring(&format!(
            "turn_deg = {turn}\ntilt_deg = {tilt}\nroll_deg = {roll}\nprecession_rad_per_s = {precession}\n\
             nutation_rad_per_s = {nutation}\npsi_dot_rad_per_s = {psi_dot}"
        ));
        let known = by_differences([turn, tilt, roll], [precession, nutation, psi_dot]);
        let off = (omega(&scenario) - known).amax();
        assert!(off < 1e-8, "{turn}, {tilt}, {roll}: {off}");
        // omega_3 differs from psi-dot.
        let along = scenario.spin_rad_per_s(&scenario.start);
        let spin = psi_dot + precession * f64::to_radians(tilt).cos();
        assert!((along - spin).abs() < 1e-13, "{along}, not {spin}");
        // In the body frame, L = I (p, q, r) with I1 = 6.6, I3 = 3.2 kg m².
        let momentum = scenario.start.orientation.tr_mul(&scenario.start.momentum);
        let in_body = scenario.start.orientation.tr_mul(&known);
        let expected = Vector3::new(6.6 * in_body.x, 6.6 * in_body.y, 3.2 * in_body.z);
        assert!((momentum - expected).amax() < 1e-7, "{momentum}");
        assert_eq!(parse(&scenario.to_toml()).start, scenario.start);
    }
}

#[test]
fn missing_euler_rates_are_zero() {
    let spun = ring("tilt_deg = 40\nspin_rad_per_s = 20");
    let psi_dot = ring("tilt_deg = 40\npsi_dot_rad_per_s = 20");
    assert!((psi_dot.start.momentum - spun.start.momentum).amax() < 1e-13);
    let swung = ring("tilt_deg = 40\nturn_deg = 90\nnutation_rad_per_s = 2");
    assert!((omega(&swung) - Vector3::new(0.0, 2.0, 0.0)).amax() < 1e-14);
}

#[test]
fn steady_precession_in_euler_rates_equals_the_preset() {
    for (name, sign) in [("steady-slow", -1.0), ("steady-fast", 1.0)] {
        let preset = preset(name, &[]);
        let cosine = 30.0_f64.to_radians().cos();
        // I1 cos(tilt) w² − L3 w + M g l = 0 with 6.6, 60 and 49.
        let root = (60.0_f64.powi(2) - 4.0 * 6.6 * cosine * 49.0).sqrt();
        let rate = (60.0 + sign * root) / (2.0 * 6.6 * cosine);
        let psi_dot = 60.0 / 3.2 - rate * cosine;
        let scenario = ring(&format!(
            "tilt_deg = 30\nprecession_rad_per_s = {rate:?}\npsi_dot_rad_per_s = {psi_dot:?}"
        ));
        let off = (scenario.start.momentum - preset.start.momentum).amax();
        assert!(off < 1e-12, "{name}: {off}");
        assert!(tilt_swing_deg(scenario) < 1e-9);
    }
}

#[test]
fn euler_rates_cannot_be_combined_with_other_forms() {
    for (way, value) in [
        ("momentum_Js", "[0, 0, 1]"),
        ("omega_rad_per_s", "[0, 0, 1]"),
        ("spin_rpm", "3"),
        ("spin_rad_per_s", "3"),
    ] {
        for rate in ["precession", "nutation", "psi_dot"] {
            let told = refusal(&format!("{way} = {value}\n{rate}_rad_per_s = 2"));
            let words = format!("start.{rate}_rad_per_s (2.0) cannot be combined with {way}");
            has(&told, &words);
        }
    }
    has(
        refusal("psi_dot_rad_per_s = 2\nsteady = true"),
        "needs a spin",
    );
    has(
        refusal("psi_dot_rad_per_s = 2\nomega_frame = 'body'"),
        "belongs to omega_rad_per_s",
    );
    has(refusal("tilt_deg = 2"), "psi_dot_rad_per_s");
    has(
        refusal("nutation_rad_per_s = nan"),
        "start.nutation_rad_per_s",
    );
}

#[test]
fn set_switches_to_euler_rates_without_losing_the_spin() {
    let rates = [
        "start.precession_rad_per_s=0.5",
        "start.psi_dot_rad_per_s=18",
    ];
    for set in [rates, [rates[1], rates[0]]] {
        let file = preset("cusps", &set).file.start;
        assert_eq!((file.momentum_Js, file.momentum_frame), (None, None));
        assert_eq!(file.precession_rad_per_s, Some(0.5));
        assert_eq!(file.psi_dot_rad_per_s, Some(18.0));
    }
    let mut document = Document::open("cusps").unwrap();
    document.set("start.precession_rad_per_s=0.5").unwrap();
    has(
        document.scenario().unwrap_err().to_string(),
        "give psi_dot_rad_per_s instead of momentum_Js",
    );
    let ways = [rates[0], rates[1], "start.spin_rpm=300"];
    let file = preset("cusps", &ways).file.start;
    assert_eq!(
        (file.precession_rad_per_s, file.psi_dot_rad_per_s),
        (None, None)
    );
}

#[test]
fn the_editor_lists_euler_rates_and_converts_them() {
    let scenario = ring("tilt_deg = 40\nprecession_rad_per_s = 0.5\npsi_dot_rad_per_s = 18");
    let near = |key: &str, number, is_default| {
        assert_near(value(&scenario, key), number, is_default);
    };
    near("start.precession_rad_per_s", 0.5, false);
    near("start.nutation_rad_per_s", 0.0, true);
    near("start.psi_dot_rad_per_s", 18.0, false);
    near(
        "start.spin_rad_per_s",
        18.0 + 0.5 * 40.0_f64.to_radians().cos(),
        true,
    );
    let spun = ring("tilt_deg = 40\nspin_rad_per_s = 18");
    let rows = parameters(&table_of(&spun.file), &spun);
    assert!(!rows.iter().any(|row| row.key.contains("psi_dot")));
    // Changing one rate keeps the others, and the tilt may change too.
    let faster = with(&scenario, "start.nutation_rad_per_s", 0.1);
    let file = &faster.file.start;
    assert_eq!(file.nutation_rad_per_s, Some(0.1));
    assert_eq!(file.precession_rad_per_s, Some(0.5));
    let leaning = with(&scenario, "start.tilt_deg", 50.0);
    assert_eq!(leaning.file.start.psi_dot_rad_per_s, Some(18.0));
    // Any start can be converted to rates and back.
    let told = ring("tilt_deg = 40\nroll_deg = 9\nturn_deg = 5\nmomentum_Js = [3, 9, 64]");
    let rates = with(&told, "start.nutation_rad_per_s", 0.0);
    let by_hand = {
        let (vertical, omega) = (told.start.orientation.row(2).transpose(), omega(&told));
        let turned = told.start.orientation.tr_mul(&omega);
        (vertical.x * turned.x + vertical.y * turned.y) / (1.0 - vertical.z * vertical.z)
    };
    let in_rates = &rates.file.start;
    assert!((in_rates.precession_rad_per_s.unwrap() - by_hand).abs() < 1e-12);
    assert_eq!(in_rates.nutation_rad_per_s, Some(0.0));
    let same = with(
        &told,
        "start.psi_dot_rad_per_s",
        in_rates.psi_dot_rad_per_s.unwrap(),
    );
    assert!((same.start.momentum - told.start.momentum).amax() < 1e-12);
    let back = with(&rates, "start.momentum_Js.0", 3.0).file.start;
    assert_eq!(
        (back.precession_rad_per_s, back.psi_dot_rad_per_s),
        (None, None)
    );
    let steady = with(&rates, "start.steady", true).file.start;
    assert!(steady.spin_rad_per_s.is_some() && steady.psi_dot_rad_per_s.is_none());
}

#[test]
fn euler_rates_of_a_vertical_axle_are_converted_if_possible() {
    let spun = ring("spin_rad_per_s = 18");
    let rates = with(&spun, "start.precession_rad_per_s", 1.0).file.start;
    assert_eq!(rates.psi_dot_rad_per_s, Some(18.0));
    let tipped = ring("momentum_Js = [0, 3, 64]");
    let problems = changed(&tipped.file, "start.psi_dot_rad_per_s", Value::Float(1.0));
    has(
        problems.unwrap_err().in_one_line(),
        "start.psi_dot_rad_per_s: cannot be set alone: the axle is vertical",
    );
}
