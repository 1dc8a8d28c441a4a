//! Overhead of a sweep of many short runs. Prints the time of all runs on one core, the time of the sweep on all cores
//! including files, and its ratio to (one core's time / cores). On a busy machine, the ratio of the processor times is more
//! meaningful: it excludes the time that other processes took.
//!
//! `cargo bench --bench sweep`

#![allow(clippy::unwrap_used)]

use gyrolab::engine::scenario::Document;
use gyrolab::studies::sweep::Sweep;
use gyrolab::studies::sweep::in_order::in_order;
use gyrolab::studies::sweep::part::{Opened, PartialSweep};
use std::ops::ControlFlow;
use std::time::Instant;

/// 10 000 runs of the preset cusps with 200 steps each.
const SWEEP: &str = "scenario = \"cusps\"\nmeasure = [\"z_m\", \"tilt_deg\", \"measured_highest_tilt_deg\"]\n\
    [[vary]]\nkey = \"motion.steps\"\nvalues = [200]\n\
    [[vary]]\nkey = \"start.momentum_Js.2\"\nfrom = 20\nto = 400\ncount = 10000\n";

/// Number of measurements; the best one counts, since the machine may be busy with other work.
const TIMES: usize = 5;

fn main() {
    let document = Document::parse("sweep.toml", SWEEP).unwrap();
    let sweep = Sweep::open(&document).unwrap();
    let cores = std::thread::available_parallelism().unwrap().get();
    let best =
        |measure: &dyn Fn() -> f64| (0..TIMES).map(|_| measure()).fold(f64::INFINITY, f64::min);
    let one = best(&|| one_core(&sweep));
    let all = best(&|| swept(&sweep));
    println!(
        "{} runs: {one:.3} s on one core, {all:.3} s on {cores}: {:.3} of (one core's time / cores)",
        sweep.rows(),
        all * cores as f64 / one
    );
    let [one_s, all_s] = [one_core as fn(&Sweep) -> f64, swept].map(|work| {
        let before = processors_s();
        (0..TIMES).for_each(|_| {
            work(&sweep);
        });
        processors_s() - before
    });
    println!(
        "processors' time, {TIMES} times: {one_s:.2} s on one core, {all_s:.2} s on {cores}: {:.3} of it",
        all_s / one_s
    );
}

/// Returns the processor time of this program, s, or 0 if the system does not report it.
fn processors_s() -> f64 {
    /// Clock ticks per second in /proc, the same on every Linux.
    const TICKS: f64 = 100.0;
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    // After the name, which may contain any characters, the 12th field is the user time and the 13th the system time.
    let fields = stat.rsplit(')').next().unwrap_or_default();
    let ticks = fields.split_whitespace().skip(11).take(2);
    ticks
        .filter_map(|ticks| ticks.parse::<f64>().ok())
        .sum::<f64>()
        / TICKS
}

/// Returns the time of the runs alone, one after the other, s.
fn one_core(sweep: &Sweep) -> f64 {
    let begin = Instant::now();
    (0..sweep.rows()).for_each(|row| drop(sweep.row(row, &|| true)));
    begin.elapsed().as_secs_f64()
}

/// Returns the time of the whole sweep, from opening its file to renaming it, s.
fn swept(sweep: &Sweep) -> f64 {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("sweep.csv");
    let begin = Instant::now();
    let Opened::Part(mut part) = PartialSweep::open(&path, sweep, false).unwrap() else {
        return f64::NAN;
    };
    in_order(
        0..sweep.rows(),
        |row, go_on| sweep.row(row, go_on),
        |rows| {
            part.add(rows).unwrap();
            ControlFlow::Continue(())
        },
    );
    part.keep().unwrap();
    begin.elapsed().as_secs_f64()
}
