//! The report's step with its record, and the splittings' steps by themselves, against the same loops in plain C
//! (`report_step.c`, `splitting.c`), by turns in one run, and the ratios. Whatever else the machine does only adds time: of
//! many short rounds the fastest counts. Run: cargo bench --bench against_c, with the compiler and its options in CC and
//! CFLAGS; without them they are gcc and -O3.
//!
//! Where the report's step spends its time, by samples of it (Zen 4, baseline x86-64, 14 points, 60 ns without the
//! simulation around it): I and the solution of I Ω = L 14 ns, a third of it one division; the square root 6 ns; sine and
//! cosine 11 ns; the matrix 4 ns; turning the points with mass 7 ns; their sums 8 ns; points without mass 4 ns; orientation,
//! torque and the new I 7 ns. Each waits for the one before, so that none can be taken out without another order of
//! operations and so other bits.
//!
//! What was tried, with the same bits:
//! - Turning and summing in two passes instead of one: 7 ns less. In one pass the rotation and the sums do not fit into
//!   the 16 registers. It is faster for 1000 and 100 000 points too (3 %); in blocks of 128 pairs it is 3 ns slower.
//! - Leaving the points without mass, where they are last, out of the sums: part of these 7 ns.
//! - Storing the inertia in the pairs in which the next step loads it: 2.5 ns less. Six numbers in any order, or a matrix,
//!   were stored by the compiler in pieces that a load straddled.
//! - Turning the orientation like a pair of points, after the sums: nothing by itself, but without it the registers spill.
//! - Around the step: copying what edits change only where there are edits, and adding up the numbers of the new state one by
//!   one to see that they are finite: 2 ns less. Loaded two at a time they had not been stored so, and were waited for.
//! - The axis before sine and cosine: 0.5 ns less. The division by |Ω| is done while they are computed.
//! - Instructions with three operands (built for AVX): 3 ns less. That would need a second version of the code, or unsafe.
//!
//! At the time step of method-2, with all that: 73 ns a step against 121 of clang -O3 -march=native -ffp-contract=off (0.60),
//! 134 of clang -O3 (0.54) and 228 of gcc -O3 (0.32), in one run each.

#![allow(missing_docs, clippy::unwrap_used)]

use gyrolab::engine::run::Simulation;
use gyrolab::engine::scenario::Document;
use gyrolab::physics::{Body, Loads, PointMass, SchemeInfo, State, rotation};
use nalgebra::Vector3;
use std::f64::consts::{FRAC_PI_4, TAU};
use std::hint::black_box;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::sync::Arc;
use std::time::Instant;

const STEPS: u64 = 20_000;
const ROUNDS: usize = 300;

fn report_in_rust() -> f64 {
    let scenario = Document::open("method-2").unwrap().scenario().unwrap();
    let mut simulation = Simulation::new(Arc::new(scenario));
    let begin = Instant::now();
    for _ in 0..STEPS {
        black_box(simulation.step().unwrap());
    }
    begin.elapsed().as_nanos() as f64 / STEPS as f64
}

/// A wheel of ten points and four of 0.5 kg on its axle: I1 = 8.35, I3 = 3.2, mgl = 63.7, as in `splitting.c`.
fn wheel() -> Body {
    let rim = (0..10).map(|j| {
        let angle = TAU * f64::from(j) / 10.0;
        Vector3::new(0.8 * libm::cos(angle), 0.8 * libm::sin(angle), 1.0)
    });
    let axle = [1.0, 1.5, 0.0, 0.5].map(|height| Vector3::new(0.0, 0.0, height));
    let points = rim.chain(axle).map(|at| PointMass { at, mass: 0.5 });
    Body::new(points.collect()).unwrap()
}

fn splitting_in_rust(name: &str) -> f64 {
    let mut scheme = SchemeInfo::find(name).unwrap().make(&wheel());
    let orientation = rotation::about(&Vector3::x(), FRAC_PI_4);
    let momentum = orientation * Vector3::new(0.0, 0.0, 100.0);
    let mut state = State {
        time_s: 0.0,
        orientation,
        momentum,
    };
    scheme.load(&Loads {
        gravity: 9.8,
        pushes: Vec::new(),
        ..Loads::default()
    });
    scheme.start(&state);
    let begin = Instant::now();
    for _ in 0..STEPS {
        scheme.step(1.0 / 60.0, black_box(&mut state));
    }
    begin.elapsed().as_nanos() as f64 / STEPS as f64
}

fn in_c(program: &Path, args: &[&str]) -> f64 {
    let output = Command::new(program)
        .args(args)
        .arg(STEPS.to_string())
        .output()
        .unwrap();
    String::from_utf8(output.stdout)
        .unwrap()
        .trim()
        .parse()
        .unwrap()
}

/// The compiler and its options: those of the environment's `CC` and `CFLAGS`, or gcc and -O3.
fn compiler() -> (String, Vec<String>) {
    let from_environment = |name, default: &str| {
        let value = std::env::var(name).ok();
        value
            .filter(|value| !value.trim().is_empty())
            .unwrap_or_else(|| default.to_owned())
    };
    let options = from_environment("CFLAGS", "-O3")
        .split_whitespace()
        .map(str::to_owned)
        .collect();
    (from_environment("CC", "gcc"), options)
}

/// The program made of a source beside this one; `None` where it cannot be built.
fn compiled(source: &str) -> Option<PathBuf> {
    let source = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("benches")
        .join(source);
    let name = source.file_stem()?.to_str()?;
    let program = std::env::temp_dir().join(format!("gyrolab-{name}-{}", std::process::id()));
    let (compiler, options) = compiler();
    let made = Command::new(&compiler)
        .args(&options)
        .arg("-o")
        .arg(&program)
        .arg(&source)
        .arg("-lm")
        .status();
    if made.is_ok_and(|status| status.success()) {
        return Some(program);
    }
    eprintln!(
        "{compiler} {} does not build {}",
        options.join(" "),
        source.display()
    );
    None
}

fn compare(what: &str, c: impl Fn() -> f64, rust: impl Fn() -> f64) {
    let (mut least_c, mut least_rust) = (f64::INFINITY, f64::INFINITY);
    for _ in 0..ROUNDS {
        least_c = least_c.min(c());
        least_rust = least_rust.min(rust());
    }
    let ratio = least_rust / least_c;
    println!("{what}: C {least_c:.1} ns, gyrolab {least_rust:.1} ns a step, ratio {ratio:.3}");
}

fn main() -> ExitCode {
    let (Some(report), Some(splitting)) = (compiled("report_step.c"), compiled("splitting.c"))
    else {
        return ExitCode::FAILURE;
    };
    let (compiler, options) = compiler();
    println!("C: {compiler} {}", options.join(" "));
    compare(
        "report, 14 points, with its record",
        || in_c(&report, &[]),
        report_in_rust,
    );
    for name in ["strang", "srkn11b"] {
        compare(
            name,
            || in_c(&splitting, &[name]),
            || splitting_in_rust(name),
        );
    }
    for program in [report, splitting] {
        let _ = std::fs::remove_file(program);
    }
    ExitCode::SUCCESS
}
