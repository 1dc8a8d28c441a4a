//! Nanoseconds per step, including its record: the schemes on the report's 14 points, alone, with the monitor, and in a
//! watched run; and the report's scheme with more points.

#![allow(missing_docs, clippy::unwrap_used)]

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use gyrolab::engine::analysis::Monitor;
use gyrolab::engine::run::Simulation;
use gyrolab::engine::scenario::Document;
use gyrolab::lab::playback::live::LiveRun;
use gyrolab::physics::scheme::SCHEMES;
use std::hint::black_box;
use std::sync::Arc;

fn new_simulation(scheme: &str, rim: usize) -> Simulation {
    let mut document = Document::open("method-2").unwrap();
    let mass = 5.0 / rim as f64;
    for set in [
        format!("motion.scheme={scheme}"),
        format!("body.rim.points={rim}"),
        format!("body.rim.point_mass_kg={mass}"),
        // At the preset's 0.1 s, the wheel turns five times per step, and the Runge-Kutta scheme breaks down.
        "motion.time_step_s=0.001".to_owned(),
    ] {
        document.set(&set).unwrap();
    }
    Simulation::new(Arc::new(document.scenario().unwrap()))
}

fn schemes(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("step with record, 14 points");
    for scheme in SCHEMES {
        let mut simulation = new_simulation(scheme.name, 10);
        group.bench_function(scheme.name, |bencher| {
            bencher.iter(|| {
                black_box(simulation.step().unwrap());
            });
        });
    }
}

fn points(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("report, a step of many points");
    for rim in [10, 1_000, 10_000, 99_996] {
        let mut simulation = new_simulation("report", rim);
        group.throughput(Throughput::Elements(rim as u64 + 4));
        group.bench_function(BenchmarkId::from_parameter(rim + 4), |bencher| {
            bencher.iter(|| {
                black_box(simulation.step().unwrap());
            });
        });
    }
}

// Monitoring costs half the time of the report's step. Comparing every step with the exact motion to the last bit, with
// libm's sines, costs one and a half times the step. Three optimizations would change a last bit somewhere: the schemes' own
// sines in the exact motion, phases advanced from step to step, and one sine for two angles. Skipping steps by a bound on
// the speeds is not worth it: for a nearly exact scheme, it skips none.
fn followed(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("step followed by the monitor, 14 points");
    for scheme in SCHEMES {
        let mut simulation = new_simulation(scheme.name, 10);
        let mut monitor = Monitor::new(simulation.now());
        group.bench_function(scheme.name, |bencher| {
            bencher.iter(|| {
                monitor.record(simulation.step().unwrap());
            });
        });
    }
}

fn watched(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("step of a watched run, 14 points");
    for scheme in SCHEMES {
        let mut run = LiveRun::new(Arc::clone(new_simulation(scheme.name, 10).scenario()));
        group.bench_function(scheme.name, |bencher| {
            bencher.iter(|| run.step().unwrap());
        });
    }
}

criterion_group!(benches, schemes, points, followed, watched);
criterion_main!(benches);
