//! Nanoseconds per row: our writer, which reads the table of columns, compared with csv + serde on a plain struct, and the
//! ratio. Both run alternately, and the fastest of many short rounds counts. Run: cargo bench --bench csv

#![allow(missing_docs, clippy::unwrap_used, non_snake_case)]

use gyrolab::engine::export::{COLUMNS, CsvWriter};
use gyrolab::engine::run::{Sample, Simulation};
use gyrolab::engine::scenario::{Document, Scenario};
use serde::Serialize;
use std::io;
use std::sync::Arc;
use std::time::Instant;

const ROWS: usize = 1000;
const ROUNDS: usize = 400;

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

fn ns_a_row(write_all: impl FnOnce()) -> f64 {
    let begin = Instant::now();
    write_all();
    begin.elapsed().as_nanos() as f64 / ROWS as f64
}

fn main() {
    let (scenario, samples) = samples();
    let mut ours = CsvWriter::new(io::sink(), &scenario).unwrap();
    let (mut least_plain, mut least_ours) = (f64::INFINITY, f64::INFINITY);
    for _ in 0..ROUNDS {
        let plain = ns_a_row(|| {
            let mut writer = csv::Writer::from_writer(io::sink());
            for sample in &samples {
                writer.serialize(Plain::new(sample)).unwrap();
            }
            writer.flush().unwrap();
        });
        let by_us = ns_a_row(|| {
            for sample in &samples {
                ours.write(sample).unwrap();
            }
        });
        (least_plain, least_ours) = (least_plain.min(plain), least_ours.min(by_us));
    }
    println!(
        "a row of {} columns: csv + serde {least_plain:.0} ns, gyrolab {least_ours:.0} ns, ratio {:.3}",
        COLUMNS.len(),
        least_ours / least_plain
    );
}
