//! The report's step with its record against the same loop in plain C (`report_step.c`, gcc -O3), by turns in one run,
//! and the ratio of the two. Whatever else the machine does only adds time: of many short rounds the fastest counts. Run: cargo bench --bench against_c

#![allow(missing_docs, clippy::unwrap_used)]

use gyrolab::run::Simulation;
use gyrolab::scenario::Document;
use std::hint::black_box;
use std::path::Path;
use std::process::{Command, ExitCode};
use std::sync::Arc;
use std::time::Instant;

const STEPS: u64 = 100_000;
const ROUNDS: usize = 60;

fn nanoseconds_in_rust() -> f64 {
    let scenario = Document::open("method-2").unwrap().scenario().unwrap();
    let mut simulation = Simulation::new(Arc::new(scenario));
    let begin = Instant::now();
    for _ in 0..STEPS {
        simulation.step().unwrap();
        black_box(simulation.record());
    }
    begin.elapsed().as_nanos() as f64 / STEPS as f64
}

fn nanoseconds_in_c(program: &Path) -> f64 {
    let output = Command::new(program)
        .arg(STEPS.to_string())
        .output()
        .unwrap();
    String::from_utf8(output.stdout)
        .unwrap()
        .trim()
        .parse()
        .unwrap()
}

fn main() -> ExitCode {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("benches/report_step.c");
    let program = std::env::temp_dir().join(format!("gyrolab-report-step-{}", std::process::id()));
    let gcc = Command::new("gcc")
        .args(["-O3", "-o"])
        .arg(&program)
        .arg(&source)
        .arg("-lm")
        .status();
    if !gcc.is_ok_and(|status| status.success()) {
        eprintln!("gcc is needed to build {}", source.display());
        return ExitCode::FAILURE;
    }
    let (mut c, mut rust) = (f64::INFINITY, f64::INFINITY);
    for _ in 0..ROUNDS {
        c = c.min(nanoseconds_in_c(&program));
        rust = rust.min(nanoseconds_in_rust());
    }
    let ratio = rust / c;
    println!(
        "report, 14 points, with its record: C {c:.0} ns, gyrolab {rust:.0} ns a step, ratio {ratio:.3}"
    );
    let _ = std::fs::remove_file(program);
    ExitCode::SUCCESS
}
