//! Compares the report's step with its record, and the steps of the splittings alone, with the same loops in plain C
//! (`report_step.c`, `splitting.c`), and prints the ratios. Both sides run alternately. Other work of the machine only adds
//! time, so the fastest of many short rounds counts. Run: cargo bench --bench against_c. CC and CFLAGS choose the compiler
//! and its options; the defaults are gcc and -O3.
//!
//! Time of the report's step by sampling (Zen 4, baseline x86-64, 14 points, 60 ns without the surrounding simulation): I
//! and the solution of I Ω = L 14 ns, a third of it one division; the square root 6 ns; sine and cosine 11 ns; the matrix
//! 4 ns; turning the points with mass 7 ns; their sums 8 ns; massless points 4 ns; orientation, torque and the new I 7 ns.
//! Each part waits for the previous one. None can be removed without another order of operations, and thus other bits.
//!
//! Optimizations tried, all with the same bits:
//! - Turning and summing in two passes instead of one: 7 ns less. In one pass, the rotation and the sums do not fit into
//!   the 16 registers. Two passes are also faster for 1000 and 100 000 points (3 %); in blocks of 128 pairs, 3 ns slower.
//! - Excluding massless points from the sums if they come last: part of these 7 ns.
//! - Storing the inertia in the pairs in which the next step loads it: 2.5 ns less. The compiler stored six numbers in any
//!   order, or a matrix, in pieces, and one load then spanned several of them.
//! - Turning the orientation like a pair of points, after the sums: no gain alone, but without it the registers spill.
//! - Outside the step: copying the values that edits change only if there are edits, and adding up the numbers of the new
//!   state one by one to check that they are finite: 2 ns less. Loads of two numbers had to wait for single stores.
//! - Computing the axis before sine and cosine: 0.5 ns less. The division by |Ω| overlaps with them.
//! - Instructions with three operands (built for AVX): 3 ns less. This would need a second version of the code, or unsafe.
//!
//! Result at the time step of method-2: 73 ns per step, compared with 121 for clang -O3 -march=native -ffp-contract=off
//! (0.60), 134 for clang -O3 (0.54) and 228 for gcc -O3 (0.32), in one run each.

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

/// A wheel of ten points and four points of 0.5 kg on its axle: I1 = 8.35, I3 = 3.2, mgl = 63.7, as in `splitting.c`.
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

/// Returns the compiler and its options from the environment variables `CC` and `CFLAGS`, or gcc and -O3.
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

/// Compiles `source` from this folder. Returns the path of the program, or `None` if it cannot be built.
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
