//! Cost of the exact motion and the readouts: one evaluation of the exact motion, a recorded step, the readouts of a frame,
//! and the schemes alone, without a run. Run: cargo bench --bench analysis

#![allow(missing_docs, clippy::unwrap_used)]

use criterion::{Criterion, criterion_group, criterion_main};
use gyrolab::engine::analysis::Monitor;
use gyrolab::engine::run::{Simulation, Truth};
use gyrolab::engine::scenario::{Document, Scenario};
use gyrolab::physics::scheme::SCHEMES;
use gyrolab::physics::{Loads, State};
use std::fmt::Write;
use std::hint::black_box;
use std::sync::Arc;

/// A wheel of ten points with four points of 0.5 kg on its axle: kappa = 0.38, L = 100 J s. `rest` may make it lopsided.
fn read_scenario(rest: &str) -> Arc<Scenario> {
    let mut text =
        "title = 'x'\n[body.rim]\npoints = 10\nradius_m = 0.8\nheight_m = 1\npoint_mass_kg = 0.5\n"
            .to_owned();
    for (name, height) in [("hub", 1.0), ("top", 1.5), ("foot", 0.0), ("middle", 0.5)] {
        writeln!(
            text,
            "[[body.point]]\nname = '{name}'\nat_m = [0, 0, {height}]\nmass_kg = 0.5"
        )
        .unwrap();
    }
    text += rest;
    text += "[start]\ntilt_deg = 45\nmomentum_Js = [0, 0, 100]\nmomentum_frame = 'body'\n[motion]\ntime_step_s = 0.016666666666666666\nsteps = 600\n";
    Arc::new(
        Document::parse("x.toml", &text)
            .unwrap()
            .scenario()
            .unwrap(),
    )
}

const LUMP: &str = "[[body.point]]\nname = 'lump'\nat_m = [0.6, 0, 1]\nmass_kg = 0.5\n";

fn exact(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("exact motion");
    for (name, rest) in [("closed form", ""), ("integrated, in order", LUMP)] {
        let mut truth = Truth::new(read_scenario(rest));
        let mut time = 0.0;
        group.bench_function(name, |bencher| {
            bencher.iter(|| {
                time += 1.0 / 60.0;
                black_box(truth.state_at(black_box(time)))
            });
        });
    }
    let scenario = read_scenario("");
    group.bench_function("set-up and one evaluation", |bencher| {
        bencher.iter(|| Truth::new(Arc::clone(&scenario)).state_at(black_box(1.0)));
    });
}

fn readouts(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("readouts");
    for (name, rest) in [("symmetric", ""), ("lopsided", LUMP)] {
        let mut simulation = Simulation::new(read_scenario(rest));
        let mut monitor = Monitor::new(simulation.now());
        group.bench_function(format!("a step and its following, {name}"), |bencher| {
            bencher.iter(|| {
                monitor.record(black_box(simulation.step().unwrap()));
            });
        });
        group.bench_function(
            format!("a frame: health, theory, sentence's numbers, {name}"),
            |bencher| {
                bencher.iter(|| {
                    simulation.step().unwrap();
                    let health = monitor.health(black_box(simulation.now()));
                    let theory = monitor.theory(simulation.state().time_s);
                    let instruments = &monitor.instruments;
                    black_box((
                        health,
                        theory,
                        instruments.nutation_period_s(),
                        instruments.precession_rad_per_s(),
                    ))
                });
            },
        );
    }
}

fn schemes(criterion: &mut Criterion) {
    for (name, rest) in [("symmetric", ""), ("lopsided", LUMP)] {
        let mut group = criterion.benchmark_group(format!("a step by the scheme alone, {name}"));
        let scenario = read_scenario(rest);
        let loads = Loads {
            gravity: scenario.motion.gravity,
            pushes: Vec::new(),
            ..Loads::default()
        };
        for info in SCHEMES {
            let mut scheme = info.make(&scenario.body.mechanics);
            let mut state: State = scenario.start;
            scheme.load(&loads);
            scheme.start(&state);
            group.bench_function(info.name, |bencher| {
                bencher.iter(|| scheme.step(black_box(1.0 / 60.0), black_box(&mut state)));
            });
        }
    }
}

fn billionth(criterion: &mut Criterion) {
    // The minimum number of time steps for order 6 to stay within 1e-9 m of the exact motion for ten seconds, and their cost.
    let scenario = read_scenario("");
    let info = gyrolab::physics::SchemeInfo::find("srkn11b").unwrap();
    let loads = Loads {
        gravity: scenario.motion.gravity,
        pushes: Vec::new(),
        ..Loads::default()
    };
    let body = &scenario.body.mechanics;
    let run = |steps: u32, look: &mut dyn FnMut(u32, &State)| {
        let mut scheme = info.make(body);
        let mut state = scenario.start;
        scheme.load(&loads);
        scheme.start(&state);
        for step in 1..=steps {
            scheme.step(10.0 / f64::from(steps), &mut state);
            look(step, &state);
        }
        state
    };
    let mut truth = Truth::new(Arc::clone(&scenario));
    let mut error = |steps: u32| {
        let mut most = 0.0_f64;
        run(steps, &mut |step, state| {
            let known = truth.state_at(10.0 * f64::from(step) / f64::from(steps));
            most = most.max((state.axle() - known.axle()).norm() * scenario.arm_m());
        });
        most
    };
    let steps = (50..2000).find(|&steps| error(steps) < 1e-9).unwrap();
    println!("1e-9 m over 10 s takes {steps} steps of srkn11b");
    criterion.bench_function("10 s to 1e-9 m by srkn11b", |bencher| {
        bencher.iter(|| run(black_box(steps), &mut |_, _| ()));
    });
}

criterion_group!(benches, exact, readouts, schemes, billionth);
criterion_main!(benches);
