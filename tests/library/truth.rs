//! The exact motion of whole scenarios, from `Truth` and from the scheme `exact`, compared with an independent integration
//! (Dormand-Prince 8(5,3), tolerance 1e-15) that uses the same numbers and shares no code with them.

use crate::support::dice::Dice;
use crate::support::scenarios::{find_scheme, parse, preset};
use differential_equations::prelude::*;
use gyrolab::engine::run::resampled;
use gyrolab::engine::run::{Simulation, Truth};
use gyrolab::engine::scenario::file::{EditFile, PushFile, ScenarioFile};
use gyrolab::engine::scenario::{Document, Scenario};
use gyrolab::physics::State;
use gyrolab::physics::exact::ExactMethod;
use nalgebra::{Matrix3, Rotation3, Vector3};
use std::fmt::Write;
use std::sync::Arc;

const TIMES: [f64; 6] = [0.7, 2.3, 4.0, 5.9, 8.1, 10.0];
/// Tolerance: m for positions, relative to the largest |L| for L.
const WITHIN: f64 = 1e-10;

/// The contents of a scenario file as plain numbers.
#[derive(Clone)]
struct PlainScenario {
    /// Name, position in the upright pose (m), mass (kg).
    points: Vec<(String, Vector3<f64>, f64)>,
    tilt_deg: f64,
    /// World frame, J s.
    momentum: Vector3<f64>,
    time_step_s: f64,
    pushes: Vec<Pushed>,
    edits: Vec<Edited>,
    gravity: f64,
}

/// A position in the upright pose (m) and the force there (N).
type PointForce = (Vector3<f64>, Vector3<f64>);

#[derive(Clone)]
struct Pushed {
    point: usize,
    force: Vector3<f64>,
    window: Window,
    accumulates: bool,
}

#[derive(Clone, Copy)]
enum Window {
    /// Start and duration, s.
    Seconds(f64, f64),
    /// First step and number of steps.
    Steps(u64, u64),
}

#[derive(Clone)]
struct Edited {
    step: u64,
    change: Change,
}

#[derive(Clone, Copy)]
enum Change {
    Gravity(f64),
    TimeStep(f64),
    Scheme(&'static str),
    /// Push number, new force.
    Force(usize, Vector3<f64>),
}

impl PlainScenario {
    fn toml(&self, scheme: &str) -> String {
        let mut text = "title = 'x'\n".to_owned();
        for (name, at, mass) in &self.points {
            let at = array(at);
            writeln!(
                text,
                "[[body.point]]\nname = '{name}'\nat_m = {at}\nmass_kg = {mass:?}"
            )
            .unwrap();
        }
        let (tilt, momentum) = (self.tilt_deg, array(&self.momentum));
        writeln!(
            text,
            "[start]\ntilt_deg = {tilt:?}\nmomentum_Js = {momentum}"
        )
        .unwrap();
        let (dt, gravity) = (self.time_step_s, self.gravity);
        writeln!(text, "[motion]\nscheme = '{scheme}'\ntime_step_s = {dt:?}\nsteps = {}\ngravity_m_per_s2 = {gravity:?}", self.steps()).unwrap();
        for push in &self.pushes {
            let (point, force) = (&self.points[push.point].0, array(&push.force));
            writeln!(text, "[[push]]\npoint = '{point}'\nforce_N = {force}").unwrap();
            match push.window {
                Window::Seconds(from, long) => {
                    writeln!(text, "from_s = {from:?}\nfor_s = {long:?}")
                }
                Window::Steps(first, count) => writeln!(
                    text,
                    "first_step = {first}\nsteps = {count}\naccumulates = {}",
                    push.accumulates
                ),
            }
            .unwrap();
        }
        for edit in &self.edits {
            let set = match edit.change {
                Change::Gravity(g) => format!("'motion.gravity_m_per_s2' = {g:?}"),
                Change::TimeStep(step_s) => format!("'motion.time_step_s' = {step_s:?}"),
                Change::Scheme(name) => format!("'motion.scheme' = '{name}'"),
                Change::Force(push, force) => format!("'push.{push}.force_N' = {}", array(&force)),
            };
            writeln!(text, "[[edit]]\nstep = {}\nset = {{ {set} }}", edit.step).unwrap();
        }
        text
    }

    fn steps(&self) -> u64 {
        (10.0 / self.time_step_s).round() as u64
    }

    fn scenario(&self, scheme: &str) -> Arc<Scenario> {
        Arc::new(parse(&self.toml(scheme)))
    }

    fn start(&self) -> (Matrix3<f64>, Vector3<f64>) {
        let turn = Rotation3::from_axis_angle(&Vector3::x_axis(), self.tilt_deg.to_radians());
        (*turn.matrix(), self.momentum)
    }

    /// Returns the times of the edits, s.
    fn edit_times(&self) -> Vec<f64> {
        let (mut step, mut time, mut dt) = (0, 0.0, self.time_step_s);
        self.edits
            .iter()
            .map(|edit| {
                time += (edit.step - step) as f64 * dt;
                step = edit.step;
                if let Change::TimeStep(new) = edit.change {
                    dt = new;
                }
                time
            })
            .collect()
    }

    /// Returns every time at which a force changes, s.
    fn moments(&self) -> Vec<f64> {
        let mut moments = self.edit_times();
        for push in &self.pushes {
            let (from, long) = self.seconds(push);
            moments.extend([from, from + long]);
            if let (true, Window::Steps(first, count)) = (push.accumulates, push.window) {
                moments.extend((first..first + count).map(|step| step as f64 * self.time_step_s));
            }
        }
        moments
    }

    fn seconds(&self, push: &Pushed) -> (f64, f64) {
        match push.window {
            Window::Seconds(from, long) => (from, long),
            Window::Steps(first, count) => (
                (first - 1) as f64 * self.time_step_s,
                count as f64 * self.time_step_s,
            ),
        }
    }

    /// Returns gravity and the other forces with their points of application at a time at which none changes.
    fn forces(&self, time: f64) -> (f64, Vec<PointForce>) {
        let mut gravity = self.gravity;
        let mut pushes = self.pushes.clone();
        for (edit, at) in self.edits.iter().zip(self.edit_times()) {
            match edit.change {
                Change::Gravity(g) if at < time => gravity = g,
                Change::Force(push, force) if at < time => pushes[push].force = force,
                _ => {}
            }
        }
        let acting = pushes.iter().filter_map(|push| {
            let (from, long) = self.seconds(push);
            let into = ((time - from) / self.time_step_s).ceil();
            let times = match (push.accumulates, push.window) {
                (true, Window::Steps(_, count)) => into.clamp(0.0, count as f64),
                _ => f64::from(time > from && time < from + long),
            };
            (times > 0.0).then(|| (self.points[push.point].1, push.force * times))
        });
        (gravity, acting.collect())
    }
}

fn array(v: &Vector3<f64>) -> String {
    format!("[{:?}, {:?}, {:?}]", v.x, v.y, v.z)
}

/// Point masses under their weight and other forces. y: three body axes and L, world frame.
struct Turning<'a> {
    told: &'a PlainScenario,
    inverse: Matrix3<f64>,
    first_moment: Vector3<f64>,
    gravity: f64,
    pushes: Vec<(Vector3<f64>, Vector3<f64>)>,
}

impl<'a> Turning<'a> {
    fn new(told: &'a PlainScenario) -> Self {
        let inertia: Matrix3<f64> = told
            .points
            .iter()
            .map(|(_, x, m)| (Matrix3::identity() * x.norm_squared() - x * x.transpose()) * *m)
            .sum();
        Self {
            told,
            inverse: inertia.try_inverse().unwrap(),
            first_moment: told.points.iter().map(|(_, x, m)| x * *m).sum(),
            gravity: 0.0,
            pushes: Vec::new(),
        }
    }

    /// Integrates from `from` to `to`, from one change of the forces to the next.
    fn go(&mut self, from: f64, to: f64, mut y: [f64; 12]) -> [f64; 12] {
        let mut stops = self.told.moments();
        stops.push(to);
        stops.retain(|&moment| moment > from && moment <= to);
        stops.sort_by(f64::total_cmp);
        let mut now = from;
        for stop in stops {
            if stop - now < 1e-12 {
                continue;
            }
            (self.gravity, self.pushes) = self.told.forces(0.5 * (now + stop));
            let method = ExplicitRungeKutta::dop853()
                .rtol(1e-15)
                .atol(1e-15)
                .max_steps(10_000_000);
            let solution = IVP::ode(&*self, now, stop, y).method(method).solve();
            y = *solution.expect("a smooth motion").y.last().unwrap();
            now = stop;
        }
        y
    }
}

impl ODE<f64, [f64; 12]> for Turning<'_> {
    fn diff(&self, _t: f64, y: &[f64; 12], rate: &mut [f64; 12]) {
        let q = Matrix3::from_column_slice(&y[..9]);
        let l = Vector3::new(y[9], y[10], y[11]);
        let spin = q * (self.inverse * q.tr_mul(&l));
        for k in 0..3 {
            rate[3 * k..3 * k + 3].copy_from_slice(spin.cross(&q.column(k)).as_slice());
        }
        let weight = (q * self.first_moment).cross(&Vector3::new(0.0, 0.0, -self.gravity));
        let torque = self
            .pushes
            .iter()
            .fold(weight, |sum, (x, force)| sum + (q * x).cross(force));
        rate[9..].copy_from_slice(torque.as_slice());
    }
}

/// Returns the states at `TIMES`, and the largest factor by which nearby states separate between two of them: a lower bound
/// on the error of any computation.
fn integrated(told: &PlainScenario) -> (Vec<Known>, f64) {
    let (q, l) = told.start();
    let mut start = [0.0; 12];
    start[..9].copy_from_slice(q.as_slice());
    start[9..].copy_from_slice(l.as_slice());
    let path = follow(told, 0, start);
    let mut growth = 1.0_f64;
    let begins = std::iter::once(&start).chain(&path).take(TIMES.len());
    for (first, begin) in begins.enumerate() {
        // Rotates the body slightly, with or without L.
        for push in [1.0, 0.0] {
            let near = follow(told, first, neighbour(begin, push));
            for (one, known) in near.iter().zip(&path[first..]) {
                let gap = (0..9).map(|k| (one[k] - known[k]).abs());
                growth = growth.max(gap.fold(0.0, f64::max) / NEAR);
            }
        }
    }
    let states = path.iter().map(|y| {
        let turned = Matrix3::from_column_slice(&y[..9]);
        (turned, Vector3::new(y[9], y[10], y[11]))
    });
    (states.collect(), growth)
}

type Known = (Matrix3<f64>, Vector3<f64>);

const NEAR: f64 = 1e-7;

fn neighbour(y: &[f64; 12], push: f64) -> [f64; 12] {
    let turn = *Rotation3::new(Vector3::new(0.5, -0.6, 0.6) * NEAR).matrix();
    let (q, l) = (
        turn * Matrix3::from_column_slice(&y[..9]),
        Vector3::new(y[9], y[10], y[11]),
    );
    let l = l + Vector3::new(0.6, 0.5, -0.6) * (push * NEAR * l.norm().max(1.0));
    let mut near = [0.0; 12];
    near[..9].copy_from_slice(q.as_slice());
    near[9..].copy_from_slice(l.as_slice());
    near
}

/// Returns the states from `TIMES[first]` on, integrated from the time before it.
fn follow(told: &PlainScenario, first: usize, mut y: [f64; 12]) -> Vec<[f64; 12]> {
    let mut turning = Turning::new(told);
    let mut now = if first == 0 { 0.0 } else { TIMES[first - 1] };
    TIMES[first..]
        .iter()
        .map(|&time| {
            y = turning.go(now, time, y);
            now = time;
            y
        })
        .collect()
}

/// Returns the distance of the farthest point (m) or that of L relative to `size`, whichever is larger.
fn apart(
    told: &PlainScenario,
    size: f64,
    seen: &State,
    known: &(Matrix3<f64>, Vector3<f64>),
) -> f64 {
    let arm = told
        .points
        .iter()
        .map(|(_, at, _)| ((seen.orientation - known.0) * at).norm())
        .fold(0.0, f64::max);
    let momentum = (seen.momentum - known.1).norm() / size;
    if arm.is_finite() && momentum.is_finite() {
        arm.max(momentum)
    } else {
        f64::INFINITY
    }
}

fn largest_momentum(known: &[(Matrix3<f64>, Vector3<f64>)]) -> f64 {
    known.iter().map(|(_, l)| l.norm()).fold(1.0, f64::max)
}

fn error_of_truth(told: &PlainScenario, known: &[(Matrix3<f64>, Vector3<f64>)]) -> f64 {
    let mut truth = Truth::new(told.scenario("report"));
    let size = largest_momentum(known);
    TIMES
        .iter()
        .zip(known)
        .map(|(&time, known)| apart(told, size, &truth.state_at(time), known))
        .fold(0.0, f64::max)
}

/// A wheel of at least `n` points, with a symmetric inertia even without the top.
fn wheel(n: u64, radius: f64, height: f64, mass: f64) -> Vec<(String, Vector3<f64>, f64)> {
    let rim = (0..n).map(|j| {
        let angle = std::f64::consts::TAU * j as f64 / n as f64;
        let at = Vector3::new(radius * angle.cos(), radius * angle.sin(), height);
        (format!("p{j}"), at, mass)
    });
    let top = ("top".to_owned(), Vector3::new(0.0, 0.0, 1.3), 0.0);
    std::iter::once(top).chain(rim).collect()
}

fn random_points(dice: &mut Dice, symmetric: bool) -> Vec<(String, Vector3<f64>, f64)> {
    if symmetric {
        let height = dice.between(-1.0, 1.2);
        let mut points = wheel(
            dice.whole(3, 12),
            dice.between(0.3, 1.0),
            height,
            dice.scale(0.1, 1.0),
        );
        points[0].2 = dice.pick(&[0.0, 0.3]);
        return points;
    }
    let top = ("top".to_owned(), Vector3::new(0.0, 0.0, 1.3), 0.2);
    let others =
        (0..dice.whole(3, 6)).map(|j| (format!("p{j}"), dice.vector(), dice.between(0.1, 1.0)));
    std::iter::once(top).chain(others).collect()
}

fn random_push(dice: &mut Dice, points: usize, weight: f64, steps: u64) -> Pushed {
    let size = weight * dice.scale(0.1, 3.0);
    let force = match dice.unit() {
        x if x < 0.4 => Vector3::new(0.0, 0.0, -size),
        x if x < 0.7 => Vector3::new(dice.between(-size, size), dice.between(-size, size), 0.0),
        _ => dice.vector() * size,
    };
    let window = match dice.unit() {
        x if x < 0.6 => Window::Seconds(dice.between(0.0, 7.0), dice.scale(0.01, 3.0)),
        _ => Window::Steps(dice.whole(1, steps * 2 / 3), dice.whole(1, steps / 4)),
    };
    Pushed {
        point: if dice.unit() < 0.6 {
            0
        } else {
            dice.whole(0, points as u64 - 1) as usize
        },
        force,
        window,
        accumulates: matches!(window, Window::Steps(_, count) if count <= 8) && dice.unit() < 0.5,
    }
}

fn random_edits(dice: &mut Dice, told: &PlainScenario) -> Vec<Edited> {
    let mut steps: Vec<u64> = (0..dice.whole(0, 3))
        .map(|_| dice.whole(0, told.steps()))
        .collect();
    steps.sort_unstable();
    steps
        .into_iter()
        .map(|step| Edited {
            step,
            change: match dice.whole(0, 3) {
                0 => Change::Gravity(dice.between(-5.0, 15.0)),
                1 => Change::TimeStep(dice.pick(&[0.1, 0.03, 0.007])),
                2 => Change::Scheme(dice.pick(&["rk4", "report", "strang"])),
                _ => Change::Force(
                    dice.whole(0, told.pushes.len() as u64 - 1) as usize,
                    dice.vector() * 10.0,
                ),
            },
        })
        .collect()
}

fn random(dice: &mut Dice) -> PlainScenario {
    let symmetric = dice.unit() < 0.5;
    let points = random_points(dice, symmetric);
    let weight = 9.8 * points.iter().map(|(_, _, m)| m).sum::<f64>();
    let time_step_s = dice.pick(&[0.1, 0.05, 0.01, 1.0 / 60.0]);
    let mut told = PlainScenario {
        tilt_deg: dice.pick(&[0.0, 30.0, 45.0, 90.0, 170.0]) + dice.between(-1.0, 1.0),
        momentum: Vector3::zeros(),
        time_step_s,
        pushes: Vec::new(),
        edits: Vec::new(),
        gravity: dice.pick(&[9.8, 9.8, 1.6, 0.0]),
        points,
    };
    let spin = weight * dice.scale(0.02, 1.0);
    told.momentum = match dice.unit() {
        x if x < 0.4 => told.start().0.column(2) * spin,
        _ => dice.vector() * spin,
    };
    let (count, steps) = (told.points.len(), told.steps());
    told.pushes = (0..dice.whole(1, 3))
        .map(|_| random_push(dice, count, weight, steps))
        .collect();
    told.edits = random_edits(dice, &told);
    told
}

/// Returns the tolerance: 1e-10, or the integration's own error of 1e-13 times `growth` if that is larger than 1000.
///
/// The integration dominates: closed form and Taylor series, which are independent, agree to a hundredth of that.
fn allowed(growth: f64) -> f64 {
    WITHIN.max(1e-13 * growth)
}

#[test]
#[ignore = "integrates 300 motions: ten seconds"]
fn random_scenarios_agree_with_an_independent_integration() {
    let mut dice = Dice(0x9E37_79B9_7F4A_7C15);
    let (mut errors, mut tame, mut wild) = (Vec::new(), 0, 0);
    for number in 0..300 {
        let told = random(&mut dice);
        let (known, growth) = integrated(&told);
        let error = error_of_truth(&told, &known);
        println!("{number}: {error:.1e}, neighbours part {growth:.0e} times");
        if growth > 1e6 {
            wild += 1; // computations of such a motion need not agree
            continue;
        }
        tame += usize::from(allowed(growth) == WITHIN);
        assert!(error < allowed(growth), "{}", told.toml("report"));
        errors.push(error);
    }
    errors.sort_by(f64::total_cmp);
    println!(
        "median {:.1e}, {tame} of 300 held to 1e-10 m, {wild} too wild to tell",
        errors[150]
    );
    assert!(tame > 200 && wild < 10 && errors[150] < 1e-12);
}

/// The textbook's wheel (I1 = 6.6, I3 = 3.2, mgl = 49) or another one, with a tilt and L in the body frame.
fn named(height: f64, tilt_deg: f64, momentum: [f64; 3]) -> PlainScenario {
    let told = PlainScenario {
        points: wheel(10, 0.8, height, 0.5),
        tilt_deg,
        momentum: Vector3::zeros(),
        time_step_s: 0.01,
        pushes: Vec::new(),
        edits: Vec::new(),
        gravity: 9.8,
    };
    let momentum = told.start().0 * Vector3::from(momentum);
    PlainScenario { momentum, ..told }
}

fn pushed(
    mut told: PlainScenario,
    force: [f64; 3],
    window: Window,
    accumulates: bool,
) -> PlainScenario {
    told.pushes.push(Pushed {
        point: 0,
        force: Vector3::from(force),
        window,
        accumulates,
    });
    told
}

fn degenerate() -> Vec<(&'static str, PlainScenario)> {
    const SPIN: [f64; 3] = [0.0, 0.0, 60.0];
    const REST: [f64; 3] = [0.0; 3];
    let kappa_1 = 0.8 / 2_f64.sqrt();
    let even = || named(kappa_1, 45.0, [0.0, 0.0, 100.0]);
    let cusps = || named(1.0, 30.0, SPIN);
    let steady = [0.0, 2.945_444_198_542_434_7, 60.0];
    let sideways = [30.0, -20.0, 0.0];
    let aside = |told: PlainScenario, from: f64, long: f64| {
        pushed(told, sideways, Window::Seconds(from, long), false)
    };
    let mut regrown = cusps();
    regrown.edits = [(100, 0.0), (250, 9.8), (400, -9.8)]
        .map(|(step, gravity)| Edited {
            step,
            change: Change::Gravity(gravity),
        })
        .into();
    let weightless = |told: PlainScenario| PlainScenario {
        gravity: 0.0,
        ..told
    };
    let held = Window::Seconds(1.003, 3.0);
    let first = pushed(cusps(), sideways, Window::Steps(1, 150), false);
    let second = Window::Seconds(1.5, 1.0);
    vec![
        ("cusps", cusps()),
        ("loops", named(1.0, 30.0, [0.0, -3.0, 60.0])),
        ("waves", named(1.0, 30.0, [0.0, 1.5, 60.0])),
        ("steady", named(1.0, 30.0, steady)),
        ("sleeping", named(1.0, 0.0, [0.0, 0.0, 40.0])),
        ("hanging and spinning", named(-1.0, 0.0, [0.0, 0.0, 40.0])),
        (
            "hanging, pushed",
            aside(named(1.0, 180.0, REST), 0.123, 0.7),
        ),
        ("a pendulum", named(1.0, 80.0, REST)),
        (
            "a pendulum, pushed",
            aside(named(1.0, 80.0, REST), 1.111, 2.0),
        ),
        ("kappa = 1", even()),
        (
            "kappa = 1, pushed down",
            pushed(even(), [0.0, 0.0, -100.0], Window::Steps(1, 200), false),
        ),
        (
            "upright, pushed aside: a tilted gravity",
            aside(named(1.0, 0.0, SPIN), 0.0, 10.0),
        ),
        (
            "a push that holds the weight",
            pushed(cusps(), [0.0, 0.0, 49.0 / 1.3], held, false),
        ),
        (
            "an accumulating push",
            pushed(cusps(), [2.0, 1.0, -3.0], Window::Steps(3, 12), true),
        ),
        (
            "two pushes of which one ends as the other begins",
            pushed(first, [0.0, 0.0, -50.0], second, false),
        ),
        (
            "a push of which nothing is left",
            aside(cusps(), 2.0, 1e-15),
        ),
        ("gravity off, on and upside down", regrown),
        ("no forces at all", weightless(cusps())),
        ("at rest without forces", weightless(named(1.0, 30.0, REST))),
    ]
}

#[test]
fn degenerate_scenarios_agree_with_an_independent_integration() {
    for (name, told) in degenerate() {
        let (known, growth) = integrated(&told);
        let error = error_of_truth(&told, &known);
        println!("{name}: {error:.1e}, neighbours part {growth:.0e} times");
        assert!(error < WITHIN, "{name}: {error:e}");
        let mut truth = Truth::new(told.scenario("report"));
        truth.state_at(10.0);
        assert_eq!(truth.kind(), ExactMethod::Closed, "{name}");
    }
}

#[test]
fn a_top_exactly_upright_or_hanging_stays_in_place() {
    // For any spin; no integration could keep the unstable ones upright.
    for (tilt, height, spin) in [
        (0.0, 1.0, 20.0),
        (0.0, 1.0, 0.0),
        (180.0, 1.0, 5.0),
        (0.0, -1.0, 0.0),
    ] {
        let told = named(height, tilt, [0.0, 0.0, spin]);
        let mut truth = Truth::new(told.scenario("report"));
        let axle = truth.state_at(0.0).axle();
        for time in [1.0, 10.0, 1e3, 1e6] {
            let off = (truth.state_at(time).axle() - axle).norm();
            // 180 degrees in radians is 1.2e-16 off, but this position is stable.
            assert!(off < 1e-14, "tilt {tilt}, spin {spin}: {off:e} at {time} s");
        }
    }
}

/// The same scenario without its edits of time step and scheme.
fn without_bookkeeping(told: &PlainScenario) -> PlainScenario {
    let edits = told
        .edits
        .iter()
        .filter(|edit| matches!(edit.change, Change::Gravity(_) | Change::Force(..)));
    PlainScenario {
        edits: edits.cloned().collect(),
        ..told.clone()
    }
}

#[test]
fn edits_of_time_step_and_scheme_do_not_change_the_exact_motion() {
    let mut dice = Dice(23);
    for _ in 0..100 {
        let mut told = without_bookkeeping(&random(&mut dice));
        let plain = told.scenario("report");
        // After the other edits, whose times would otherwise depend on the new time step.
        let last = told.edits.last().map_or(0, |edit| edit.step);
        for (later, change) in [
            (0, Change::TimeStep(0.123)),
            (4, Change::Scheme("rk4")),
            (9, Change::TimeStep(0.0071)),
            (9, Change::Scheme("exact")),
        ] {
            told.edits.push(Edited {
                step: last + later,
                change,
            });
        }
        let (mut a, mut b) = (Truth::new(plain), Truth::new(told.scenario("strang")));
        for time in TIMES {
            let text = told.toml("strang");
            assert_eq!(a.state_at(time), b.state_at(time), "{text}");
        }
    }
}

#[test]
fn the_exact_motion_does_not_depend_on_query_order() {
    let mut dice = Dice(24);
    for _ in 0..60 {
        let told = random(&mut dice);
        let growth = integrated(&told).1;
        let scenario = told.scenario("report");
        let mut straight = Truth::new(Arc::clone(&scenario));
        let known = TIMES.map(|time| straight.state_at(time));
        let mut wandering = Truth::new(scenario);
        for place in [5, 0, 3, 3, 1, 4, 2, 5, 1] {
            let (seen, known) = (wandering.state_at(TIMES[place]), &known[place]);
            let size = 1.0 + known.momentum.norm();
            let known = (known.orientation, known.momentum);
            let gap = apart(&told, size, &seen, &known);
            let text = told.toml("report");
            let allowed = 1e-13 * growth.max(10.0);
            assert!(gap < allowed, "{gap:e} at {} s\n{text}", TIMES[place]);
        }
    }
}

/// Runs the scheme `exact` at `time_step_s` and returns the maximum distance from `Truth` over its steps.
fn exact_scheme_off(told: &PlainScenario, time_step_s: f64) -> f64 {
    let exact = find_scheme("exact");
    let scenario = Arc::new(resampled(&told.scenario("exact"), time_step_s, exact));
    let mut truth = Truth::new(Arc::clone(&scenario));
    let mut simulation = Simulation::new(Arc::clone(&scenario));
    let mut worst = 0.0_f64;
    while simulation.step_number() < scenario.steps {
        simulation.step().unwrap();
        let seen = *simulation.state();
        let known = truth.state_at(seen.time_s);
        let known = (known.orientation, known.momentum);
        worst = worst.max(apart(told, 1.0 + known.1.norm(), &seen, &known));
    }
    worst
}

#[test]
fn the_scheme_exact_gives_the_exact_motion_at_every_time_step() {
    let mut dice = Dice(25);
    let random = (0..60).map(|_| ("random", random(&mut dice)));
    for (name, told) in degenerate().into_iter().chain(random) {
        let growth = integrated(&told).1;
        for time_step_s in [1.0, 0.37, 0.1, 0.01] {
            let off = exact_scheme_off(&told, time_step_s);
            let allowed = 1e-13 * growth.max(100.0);
            let text = told.toml("exact");
            assert!(off < allowed, "{name}, dt {time_step_s}: {off:e}\n{text}");
        }
    }
}

#[test]
fn the_scheme_exact_names_its_method() {
    let kind = |told: &PlainScenario| {
        let mut simulation = Simulation::new(told.scenario("exact"));
        assert_eq!(simulation.remark(), None);
        simulation.step_to(told.steps()).unwrap();
        simulation.remark().unwrap()
    };
    let top = named(1.0, 30.0, [0.0, 0.0, 60.0]);
    assert_eq!(kind(&top), "closed form");
    let window = Window::Seconds(1.0, 2.0);
    let mut push = pushed(top.clone(), [5.0, 1.0, 2.0], window, false);
    assert_eq!(kind(&push), "closed form");
    push.pushes[0].point = 3;
    let words = "closed form, and off the axle integration held to 1e-12";
    assert_eq!(kind(&push), words);
    let mut lopsided = top;
    lopsided.points[1].2 = 0.6;
    assert_eq!(kind(&lopsided), "integration held to 1e-12");
}

/// Returns the minimum and maximum of z/z0 of the traced point over all steps, with z from `position`.
fn heights(scenario: &Arc<Scenario>, position: impl FnMut(&Simulation) -> f64) -> [String; 2] {
    let mut simulation = Simulation::new(Arc::clone(scenario));
    let mut position = position;
    let start = position(&simulation);
    let (mut low, mut high) = (start, start);
    while simulation.step_number() < scenario.steps {
        simulation.step().unwrap();
        let z = position(&simulation);
        (low, high) = (low.min(z), high.max(z));
    }
    [low / start, high / start].map(|ratio| format!("{ratio:.5}"))
}

#[test]
fn the_wobble_is_caused_by_the_time_step() {
    let preset = preset("wobble-push", &[]);
    let report = find_scheme("report");
    let table = [
        (0.1, "0.77137", "1.14268"),
        (0.05, "0.99739", "1.00238"),
        (0.02, "0.77083", "1.14180"),
        (0.01, "0.99950", "1.00049"),
        (0.005, "0.99939", "1.00013"),
        (0.002, "0.99937", "1.00010"),
        (0.001, "0.99936", "1.00010"),
    ];
    for (time_step_s, least, greatest) in table {
        let scenario = Arc::new(resampled(&preset, time_step_s, report));
        let seen = heights(&scenario, |simulation| simulation.sample().position.z);
        assert_eq!(seen, [least, greatest], "dt {time_step_s}");
    }
    let scenario = Arc::new(resampled(&preset, 0.001, report));
    let mut truth = Truth::new(Arc::clone(&scenario));
    let arm = scenario.arm_m();
    let seen = heights(&scenario, |simulation| {
        truth.state_at(simulation.state().time_s).axle().z * arm
    });
    assert_eq!(seen, ["0.99936", "1.00010"], "the truth");
}

/// Returns the scenario with an edit of gravity at `step`.
fn with_less_gravity(mut file: ScenarioFile, step: u64) -> Arc<Scenario> {
    let gravity = ("motion.gravity_m_per_s2".to_owned(), 3.0.into());
    let set = toml::Table::from_iter([gravity]);
    file.edit.push(EditFile { step, set });
    let edited = Document::from_file("edited", &file).unwrap();
    Arc::new(edited.scenario().unwrap())
}

/// Duration of the random scenarios, s.
const LENGTH_S: f64 = 10.0;

#[test]
fn a_later_edit_gives_the_exact_motion_of_the_edited_scenario() {
    let mut dice = Dice(99);
    for _ in 0..60 {
        let mut told = random(&mut dice);
        told.edits.clear();
        let plain = told.scenario("strang");
        let here_s = dice.between(0.1, 0.9) * LENGTH_S;
        let step = (here_s / plain.motion.time_step_s) as u64;
        let mut file = plain.file.clone();
        let push = file.push.first().cloned();
        file.push.extend(push.map(|push| PushFile {
            first_step: None,
            steps: None,
            accumulates: None,
            from_s: Some(step as f64 * plain.motion.time_step_s),
            for_s: Some(0.3 * LENGTH_S),
            ..push
        }));
        let edited = with_less_gravity(file, step);
        let mut on_the_way = Truth::new(Arc::clone(&plain));
        on_the_way.state_at(step as f64 * plain.motion.time_step_s);
        on_the_way.branch(&edited);
        let mut from_the_start = Truth::new(edited);
        for share in [0.2, 0.5, 1.0] {
            let at_s = here_s + 0.3 * share * LENGTH_S; // a short time, since chaos would amplify rounding
            let (a, b) = (on_the_way.state_at(at_s), from_the_start.state_at(at_s));
            let off = (a.orientation - b.orientation).amax();
            assert!(off < 1e-9, "{off:e} at {at_s} s of {}", told.toml("strang"));
        }
    }
}

#[test]
fn an_edit_at_the_start_takes_effect_from_the_start() {
    let plain = Arc::new(preset("method-2", &[]));
    let edited = with_less_gravity(plain.file.clone(), 0);
    for (from, to) in [(&plain, &edited), (&edited, &plain)] {
        let mut on_the_way = Truth::new(Arc::clone(from));
        on_the_way.state_at(0.0);
        on_the_way.branch(to);
        let mut from_the_start = Truth::new(Arc::clone(to));
        assert_eq!(on_the_way.state_at(30.0), from_the_start.state_at(30.0));
    }
}
