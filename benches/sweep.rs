//! What a sweep of many short runs costs beside its runs: prints the time of one core for all of them, the time of the sweep
//! on all cores, files and all, and its ratio to (one core's time / cores).
//!
//! `cargo bench --bench sweep`

#![allow(clippy::unwrap_used)]

use gyrolab::scenario::Document;
use gyrolab::study::sweep::Sweep;
use gyrolab::study::sweep::in_order::in_order;
use gyrolab::study::sweep::part::{Opened, PartFile};
use std::ops::ControlFlow;
use std::time::Instant;

/// 10 000 runs of the cusps of 200 steps, 2 s each.
const SWEEP: &str = "scenario = \"cusps\"\nmeasure = [\"z_m\", \"tilt_deg\", \"measured_highest_tilt_deg\"]\n\
    [[vary]]\nkey = \"motion.steps\"\nvalues = [200]\n\
    [[vary]]\nkey = \"start.momentum_Js.2\"\nfrom = 20\nto = 400\ncount = 10000\n";

/// The machine may be busy with other work: the best of so many times counts.
const TIMES: usize = 5;

fn main() {
    let document = Document::parse("sweep.toml", SWEEP).unwrap();
    let sweep = Sweep::open(&document).unwrap();
    let cores = std::thread::available_parallelism().unwrap().get();
    let best =
        |measure: &dyn Fn() -> f64| (0..TIMES).map(|_| measure()).fold(f64::INFINITY, f64::min);
    let one = best(&|| {
        let begin = Instant::now();
        (0..sweep.rows()).for_each(|row| drop(sweep.row(row, &|| true)));
        begin.elapsed().as_secs_f64()
    });
    let all = best(&|| swept(&sweep));
    println!(
        "{} runs: {one:.3} s on one core, {all:.3} s on {cores}: {:.3} of (one core's time / cores)",
        sweep.rows(),
        all * cores as f64 / one
    );
}

/// The time of the whole sweep, from its file's opening to its last name, s.
fn swept(sweep: &Sweep) -> f64 {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("sweep.csv");
    let begin = Instant::now();
    let Opened::Part(mut part) = PartFile::open(&path, sweep, false).unwrap() else {
        return f64::NAN;
    };
    in_order(
        0..sweep.rows(),
        |row, go_on| sweep.row(row, go_on),
        |rows| {
            let lines: String = rows.iter().map(|row| row.line.as_str()).collect();
            part.add(&lines, rows.len() as u64).unwrap();
            ControlFlow::Continue(())
        },
    );
    part.keep().unwrap();
    begin.elapsed().as_secs_f64()
}
