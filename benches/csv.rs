//! Nanoseconds a row: our writer, which reads the table of columns, against csv + serde on a plain struct.

#![allow(missing_docs, clippy::unwrap_used, non_snake_case)]

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use gyrolab::export::{COLUMNS, CsvWriter};
use gyrolab::run::{Sample, Simulation};
use gyrolab::scenario::{Document, Scenario};
use serde::Serialize;
use std::io;
use std::sync::Arc;

const ROWS: usize = 1000;

#[derive(Serialize)]
struct Plain {
    step: u64,
    t_s: f64,
    x_m: f64,
    y_m: f64,
    z_m: f64,
    Lx_Js: f64,
    Ly_Js: f64,
    Lz_Js: f64,
    wx_rad_per_s: f64,
    wy_rad_per_s: f64,
    wz_rad_per_s: f64,
    tilt_deg: f64,
    azimuth_deg: f64,
    energy_J: f64,
    segment: u64,
}

impl Plain {
    fn new(s: &Sample) -> Self {
        Self {
            step: s.step,
            t_s: s.time_s,
            x_m: s.position.x,
            y_m: s.position.y,
            z_m: s.position.z,
            Lx_Js: s.momentum.x,
            Ly_Js: s.momentum.y,
            Lz_Js: s.momentum.z,
            wx_rad_per_s: s.angular_velocity.x,
            wy_rad_per_s: s.angular_velocity.y,
            wz_rad_per_s: s.angular_velocity.z,
            tilt_deg: s.tilt_deg,
            azimuth_deg: s.azimuth_deg,
            energy_J: s.energy,
            segment: s.segment,
        }
    }
}

fn samples() -> (Arc<Scenario>, Vec<Sample>) {
    let scenario = Arc::new(Document::open("wobble-push").unwrap().scenario().unwrap());
    let mut simulation = Simulation::new(Arc::clone(&scenario));
    let samples = (0..ROWS).map(|_| {
        simulation.step().unwrap();
        simulation.sample()
    });
    (scenario, samples.collect())
}

fn rows(criterion: &mut Criterion) {
    let (scenario, samples) = samples();
    let mut group = criterion.benchmark_group("1000 rows of CSV");
    group.throughput(Throughput::Elements((ROWS * COLUMNS.len()) as u64));
    group.bench_function("csv + serde by itself", |bencher| {
        bencher.iter(|| {
            let mut writer = csv::Writer::from_writer(io::sink());
            samples
                .iter()
                .for_each(|sample| writer.serialize(Plain::new(sample)).unwrap());
            writer.flush().unwrap();
        });
    });
    group.bench_function("gyrolab", |bencher| {
        let mut writer = CsvWriter::new(io::sink(), &scenario).unwrap();
        bencher.iter(|| {
            samples
                .iter()
                .for_each(|sample| writer.write(sample).unwrap());
        });
    });
}

criterion_group!(benches, rows);
criterion_main!(benches);
