//! The public data of a step: its states before and after, derived values, and the workings (its intermediate numbers).

use crate::support::scenarios::parse;
use gyrolab::engine::run::{Simulation, Step};
use gyrolab::engine::scenario::{Document, Scenario};
use gyrolab::lab::playback::live::LiveRun;
use gyrolab::physics::scheme::SCHEMES;
use gyrolab::physics::workings::{Phase, PhaseName, PhaseTarget, PointTable, WorkedValue};
use gyrolab::physics::{observables, rotation};
use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3};
use std::sync::Arc;

/// A wheel with an odd number of points (seven), one of `lump_kg` off the axle, with pushes that start within a step and
/// edits of everything that can be edited.
fn scenario_with_events(scheme: &str, lump_kg: f64) -> Arc<Scenario> {
    let text = format!(
        "title = 'x'
[body.rim]
points = 4
radius_m = 0.8
height_m = 0.9
point_mass_kg = 0.5
[[body.point]]
name = 'top'
at_m = [0, 0, 1.4]
mass_kg = 0.25
[[body.point]]
name = 'foot'
at_m = [0, 0, 0]
mass_kg = 0
[[body.point]]
name = 'lump'
at_m = [0.3, 0.2, 0.7]
mass_kg = {lump_kg}
[start]
tilt_deg = 40
momentum_Js = [1, -2, 20]
[motion]
scheme = '{scheme}'
time_step_s = 0.01
steps = 60
[[push]]
point = 'top'
force_N = [3, -4, 5]
from_s = 0.045
for_s = 0.1
[[push]]
point = 'top'
force_N = [0, 2, 0]
first_step = 3
steps = 9
[[edit]]
step = 20
set = {{ 'motion.gravity_m_per_s2' = 4 }}
[[edit]]
step = 30
set = {{ 'motion.time_step_s' = 0.02 }}
"
    );
    Arc::new(parse(&text))
}

/// Calls `look` with every step of `scenario` and its workings.
fn each_step(scenario: &Arc<Scenario>, mut look: impl FnMut(&Step)) {
    let mut run = Simulation::new(Arc::clone(scenario));
    run.keep_workings(true);
    for _ in 0..scenario.steps {
        look(run.step().unwrap());
    }
}

/// Returns the scenarios with and without a lump.
fn both(scheme: &str) -> [Arc<Scenario>; 2] {
    [
        scenario_with_events(scheme, 0.75),
        scenario_with_events(scheme, 0.0),
    ]
}

fn number(phase: &Phase, symbol: &str) -> f64 {
    match phase.value(symbol) {
        Some(&WorkedValue::Number(number)) => number,
        other => panic!("{} {symbol}: {other:?}", phase.name),
    }
}

fn vector(phase: &Phase, symbol: &str) -> Vector3<f64> {
    match phase.value(symbol) {
        Some(&WorkedValue::Vector(vector)) => vector,
        other => panic!("{} {symbol}: {other:?}", phase.name),
    }
}

fn matrix(phase: &Phase, symbol: &str) -> Matrix3<f64> {
    match phase.value(symbol) {
        Some(&WorkedValue::Matrix(matrix)) => matrix,
        other => panic!("{} {symbol}: {other:?}", phase.name),
    }
}

fn table<'a>(phase: &'a Phase, symbol: &str) -> &'a PointTable {
    match phase.value(symbol) {
        Some(WorkedValue::Table(table)) => table,
        other => panic!("{} {symbol}: {other:?}", phase.name),
    }
}

/// Adds up one column in the order of the report's scheme: the even rows, the odd rows, and then both sums.
fn column_sum(table: &PointTable, column: usize) -> f64 {
    let half = |first: usize| {
        let rows = table.rows().skip(first).step_by(2);
        rows.fold(0.0, |sum, (_, row)| sum + row[column])
    };
    half(0) + half(1)
}

#[test]
fn keeping_the_workings_does_not_change_the_run() {
    for scheme in SCHEMES {
        for scenario in both(scheme.name) {
            let mut plain = Simulation::new(Arc::clone(&scenario));
            each_step(&scenario, |step| {
                let plain = plain.step().unwrap();
                assert_eq!(step.sample(), plain.sample(), "{}", scheme.name);
                assert_eq!(step.after(), plain.after(), "{}", scheme.name);
                assert!(step.workings().is_some() && plain.workings().is_none());
            });
        }
    }
}

#[test]
fn the_parts_of_a_step_add_up_to_its_length() {
    for scheme in SCHEMES {
        for scenario in both(scheme.name) {
            let mut most_parts = 0;
            each_step(&scenario, |step| {
                let workings = step.workings().unwrap();
                let length: f64 = workings.parts.iter().map(|part| part.length_s).sum();
                assert!((length - step.motion().time_step_s).abs() < 1e-15);
                assert_eq!(&workings.parts.last().unwrap().loads, step.loads());
                assert!(workings.parts.iter().all(|part| !part.phases.is_empty()));
                most_parts = most_parts.max(workings.parts.len());
            });
            // The push of 0.045 s starts within a step. A scheme with whole steps only applies its mean.
            assert_eq!(most_parts, if scheme.continuous { 2 } else { 1 });
        }
    }
}

#[test]
fn the_report_step_follows_from_its_workings_bit_for_bit() {
    for scenario in both("report") {
        let mut positions: Option<Vec<f64>> = None;
        each_step(&scenario, |step| {
            let workings = step.workings().unwrap();
            let phases: Vec<_> = workings.phases().collect();
            let names: Vec<_> = phases.iter().map(|phase| phase.name.text()).collect();
            let all = "inertia, angular velocity, axis and angle, rotation, new positions, torque, new momentum";
            assert_eq!(names.join(", "), all);
            let [inertia, velocity, axis, turn, moved, torque, momentum] = phases[..] else {
                panic!("seven phases")
            };
            let (before, after) = (step.before().unwrap(), step.after());
            let (dt, gravity) = (step.motion().time_step_s, step.motion().gravity);

            // 1. The inertia from each point's contribution.
            let points = table(inertia, "X");
            let [xx, yy, zz, xy, xz, yz] = [4, 5, 6, 7, 8, 9].map(|c| column_sum(points, c));
            let summed = Matrix3::new(yy + zz, -xy, -xz, -xy, xx + zz, -yz, -xz, -yz, xx + yy);
            assert_eq!(matrix(inertia, "I"), summed);
            let body = &scenario.body.mechanics;
            for ((index, row), point) in points.rows().zip(body.points()) {
                let at = before.orientation * point.at;
                assert!((at - Vector3::new(row[1], row[2], row[3])).amax() < 1e-13);
                assert_eq!((row[0], row[4]), (point.mass, row[0] * row[1] * row[1]));
                assert_eq!(body.points()[index], *point);
            }

            // 2. and 3. Ω, u and the angle.
            let omega = vector(velocity, "Ω");
            assert_eq!(matrix(velocity, "I"), summed);
            assert_eq!(vector(velocity, "L"), before.momentum);
            let off = summed * omega - before.momentum;
            assert!(off.amax() < 1e-14 * before.momentum.amax(), "{off}");
            let (u, angle, p) = (vector(axis, "u"), number(axis, "angle"), matrix(axis, "P"));
            assert_eq!(angle, omega.norm() * dt);
            assert_eq!(u, omega * (1.0 / omega.norm()));
            assert_eq!(p, u * u.transpose());

            // 4. R, and the resulting positions.
            let r = matrix(turn, "R");
            assert_eq!(r, rotation::about(&omega, dt));
            let (sine, cosine) = (number(axis, "sin"), number(axis, "cos"));
            let by_formula = p + cosine * (Matrix3::identity() - p) + sine * u.cross_matrix();
            assert!((r - by_formula).amax() < 1e-15);
            assert_eq!(after.orientation, r * before.orientation);
            let both: Vec<_> = table(moved, "X").rows().map(|(_, row)| row).collect();
            for (row, (_, at)) in both.iter().zip(points.rows()) {
                assert_eq!(row[..3], at[1..4]);
                for i in 0..3 {
                    let turned = r[(i, 0)] * row[0] + r[(i, 1)] * row[1] + r[(i, 2)] * row[2];
                    assert_eq!(row[3 + i], turned);
                }
            }
            let from: Vec<_> = both.iter().flat_map(|row| row[..3].to_vec()).collect();
            let to: Vec<_> = both.iter().flat_map(|row| row[3..].to_vec()).collect();
            assert!(positions.replace(to).is_none_or(|last| last == from));

            // 5. The torque at the new positions, and the new L.
            let moments = table(torque, "m X");
            let first = Vector3::new(0, 1, 2).map(|c: usize| column_sum(moments, c));
            assert_eq!(vector(torque, "Σ m X"), first);
            let weight = Vector3::new(-gravity * first.y, gravity * first.x, 0.0);
            assert_eq!(vector(torque, "τ of the weight"), weight);
            let mut sum = weight;
            for (point, row) in table(torque, "F").rows() {
                let force = Vector3::new(row[0], row[1], row[2]);
                let at = Vector3::from_column_slice(&both[point][3..]);
                assert_eq!(row[3..], at.cross(&force).as_slice()[..]);
                sum += at.cross(&force);
            }
            let forces = table(torque, "F").rows().count();
            assert_eq!(forces, step.loads().pushes.len());
            assert_eq!(vector(torque, "τ"), sum);
            assert_eq!(vector(momentum, "new L"), before.momentum + dt * sum);
            assert_eq!(after.momentum, before.momentum + dt * sum);
        });
    }
}

#[test]
fn phases_change_exactly_their_stated_targets() {
    for scheme in SCHEMES {
        for scenario in both(scheme.name) {
            each_step(&scenario, |step| {
                let workings = step.workings().unwrap();
                let phases = || workings.phases().rev();
                let last = |changes: PhaseTarget| {
                    move |phase: &&Phase| [changes, PhaseTarget::Both].contains(&phase.changes)
                };
                let turned = phases().find(last(PhaseTarget::Orientation)).unwrap();
                match turned.value("new Q") {
                    Some(WorkedValue::Matrix(q)) => assert_eq!(*q, step.after().orientation),
                    _ => assert_eq!(turned.name, PhaseName::NewPositions),
                }
                let kicked = phases().find(last(PhaseTarget::Momentum)).unwrap();
                let known = step.after().momentum;
                assert_eq!(vector(kicked, "new L"), known, "{}", scheme.name);
            });
        }
    }
}

#[test]
fn the_runge_kutta_step_follows_from_its_slopes() {
    for scenario in both("rk4") {
        each_step(&scenario, |step| {
            let workings = step.workings().unwrap();
            let before = step.before().unwrap();
            let (mut q, mut momentum) = (before.orientation, before.momentum);
            for part in &workings.parts {
                let [k1, k2, k3, k4, orientation, kick] = &part.phases[..] else {
                    panic!("six phases")
                };
                let sixth = part.length_s / 6.0;
                let torque = |phase| vector(phase, "L′");
                let torques = torque(k1) + (torque(k2) + torque(k3)) * 2.0 + torque(k4);
                momentum += torques * sixth;
                let rate = |phase| matrix(phase, "Q′");
                let turned = rate(k1) + (rate(k2) + rate(k3)) * 2.0 + rate(k4);
                assert_eq!(rate(k1), rotation::crossed(&vector(k1, "Ω"), &q));
                q = rotation::straightened(&(q + turned * sixth));
                assert_eq!(matrix(orientation, "new Q"), q);
                assert_eq!(vector(kick, "new L"), momentum);
            }
            assert_eq!(q, step.after().orientation);
            assert_eq!(momentum, step.after().momentum);
        });
    }
}

#[test]
fn the_splitting_step_follows_from_its_kicks() {
    for (scheme, kicks) in [("strang", 2), ("srkn11b", 12)] {
        for scenario in both(scheme) {
            each_step(&scenario, |step| {
                let mut momentum = step.before().unwrap().momentum;
                for part in &step.workings().unwrap().parts {
                    let phases = || part.phases.iter();
                    let (mut axle, mut duration_s, mut count) = (Vector3::zeros(), 0.0, 0);
                    for phase in phases() {
                        match phase.name {
                            PhaseName::Kick => {
                                let h = number(phase, "h");
                                momentum += match phase.value("τ") {
                                    Some(WorkedValue::Vector(torque)) => torque * h,
                                    _ => {
                                        axle = vector(phase, "a");
                                        axle.cross(&(vector(phase, "Σ s F") * h))
                                    }
                                };
                                assert_eq!(vector(phase, "new L"), momentum);
                                duration_s += h;
                                count += 1;
                            }
                            PhaseName::FreeMotion if phase.value("w").is_some() => {
                                let turned = rotation::about(&vector(phase, "w"), 1.0) * axle;
                                assert!((turned - vector(phase, "new a")).amax() < 1e-14);
                            }
                            PhaseName::NewOrientation => {
                                let (a, e) = (vector(phase, "a"), vector(phase, "e"));
                                let q = Matrix3::from_columns(&[e, a.cross(&e), a]);
                                assert_eq!(q, matrix(phase, "new Q"));
                            }
                            _ => {}
                        }
                    }
                    assert_eq!(count, kicks, "{scheme}");
                    assert!((duration_s - part.length_s).abs() < 1e-15);
                    let free = phases().filter(|phase| phase.name == PhaseName::FreeMotion);
                    let free_s: f64 = free.map(|phase| number(phase, "h")).sum();
                    assert!((free_s - part.length_s).abs() < 1e-15);
                }
                assert_eq!(momentum, step.after().momentum, "{scheme}");
            });
        }
    }
}

#[test]
fn the_exact_step_names_its_method() {
    let [lopsided, symmetric] = both("exact");
    each_step(&lopsided, |step| {
        let workings = step.workings().unwrap();
        for phase in workings.phases() {
            assert_eq!(phase.name, PhaseName::TaylorSeries);
        }
    });
    each_step(&symmetric, |step| {
        let workings = step.workings().unwrap();
        for part in &workings.parts {
            let [parameters, orientation, momentum] = &part.phases[..] else {
                panic!("three phases")
            };
            let squares = ["Re α", "Im α", "Re β", "Im β"].map(|s| number(parameters, s).powi(2));
            let sum: f64 = squares.iter().sum();
            let norm2 = number(parameters, "|α|² + |β|²");
            assert!((sum / norm2 - 1.0).abs() < 1e-15);
            let [w, i, j, k] = ["q₀", "q₁", "q₂", "q₃"].map(|s| number(orientation, s));
            let turn = UnitQuaternion::new_normalize(Quaternion::new(w, i, j, k));
            let q = turn.to_rotation_matrix().into_inner();
            assert!((q - matrix(orientation, "new Q")).amax() < 2e-15);
            let sizes =
                ["L along the load's vertical", "new L"].map(|s| vector(momentum, s).norm());
            assert!((sizes[0] / sizes[1] - 1.0).abs() < 1e-15);
        }
    });
}

#[test]
fn values_of_a_step_equal_those_of_its_state() {
    for scheme in SCHEMES {
        let scenario = scenario_with_events(scheme.name, 0.75);
        let body = &scenario.body.mechanics;
        let mut last = scenario.start;
        assert_eq!(Simulation::new(Arc::clone(&scenario)).now().before(), None);
        each_step(&scenario, |step| {
            let after = step.after();
            let omega = observables::angular_velocity(body, after);
            assert_eq!(step.before(), Some(&last));
            assert_eq!(*step.angular_velocity(), omega);
            let position = observables::position(body, after, scenario.trace);
            assert_eq!(*step.position(), position);
            assert_eq!(step.tilt_deg(), observables::tilt_deg(after));
            let height = observables::weight_height(body, after);
            let energy = observables::kinetic_energy(body, after) + step.motion().gravity * height;
            assert_eq!(step.energy(), energy);
            // A second call gives the same result.
            assert_eq!(step.sample(), step.sample());
            last = *after;
        });
    }
}

#[test]
fn after_a_breakdown_the_last_finite_step_stays_available() {
    // The push at step 4, after an edit, makes the numbers overflow.
    let text = "title = 'x'\n[body.rim]\npoints = 4\nradius_m = 0.8\nheight_m = 1\npoint_mass_kg = 0.5\n\
                [[body.point]]\nname = 'top'\nat_m = [0, 0, 1]\nmass_kg = 1\n\
                [start]\nmomentum_Js = [0, 1, 30]\n[motion]\ntime_step_s = 0.1\nsteps = 9\n\
                [[push]]\npoint = 'top'\nforce_N = [1, 0, 0]\nfirst_step = 2\nsteps = 2\n\
                [[push]]\npoint = 'top'\nforce_N = [1e308, 1e308, 1e308]\nfirst_step = 4\nsteps = 9\n\
                [[edit]]\nstep = 3\nset = { 'motion.gravity_m_per_s2' = 2 }\n";
    for scheme in SCHEMES {
        let mut document = Document::parse("x.toml", text).unwrap();
        let set = format!("motion.scheme={}", scheme.name);
        document.set(&set).unwrap();
        let mut run = Simulation::new(Arc::new(document.scenario().unwrap()));
        run.step_to(3).unwrap();
        let mut last = run.clone();
        while run.step().is_ok() {
            last = run.clone();
        }
        let (name, known) = (scheme.name, last.now());
        for _ in 0..2 {
            let failed_at = run.step().unwrap_err().step;
            assert_eq!(failed_at, last.step_number() + 1, "{name}");
            let now = run.now();
            assert!(now.sample() == known.sample(), "{name}: other numbers");
            assert!(now.before() != Some(now.after()), "{name}: no step");
            assert!(now.before() == known.before(), "{name}: another step");
            assert_eq!(now.changes(), known.changes(), "{name}");
            let is_same = (now.loads(), now.motion()) == (known.loads(), known.motion());
            assert!(is_same, "{name}: other loads or another motion");
        }
    }
}

#[test]
fn the_workings_of_any_step_are_available_kept_or_not() {
    for scheme in SCHEMES {
        let scenario = scenario_with_events(scheme.name, 0.75);
        let mut known = vec![None];
        each_step(&scenario, |step| known.push(step.workings().cloned()));
        let mut run = LiveRun::new(Arc::clone(&scenario));
        for (step, expected) in known.iter().enumerate() {
            // Some workings are requested later, the others are kept during the run.
            run.keep_workings(step % 3 == 1);
            if step > 0 {
                run.step().unwrap();
            }
            assert_eq!(run.simulation().now().workings().is_some(), step % 3 == 1);
            assert_eq!(&run.workings(), expected, "{} step {step}", scheme.name);
            assert_eq!(&run.workings(), expected, "{} step {step}", scheme.name);
        }
        run.keep_workings(true);
        run.begin_seek(25);
        while run.seek_target().is_some() {
            run.step().unwrap();
        }
        assert_eq!(run.workings(), known[25], "{}", scheme.name);
    }
}
