//! The report's scheme compared with an independent implementation (Octave, written from section 3 of the report).
//!
//! `tests/reference/*.csv` contain the trajectories of that program: step, t, top of the axle, L. Two correct
//! implementations differ only by rounding, which these motions amplify to at most 6e-10 m.

#![allow(clippy::expect_used)]

use crate::support::scenarios::preset;
use gyrolab::engine::run::Simulation;
use std::path::Path;
use std::sync::Arc;

/// Returns the rows of a reference: step, t, x, y, z, Lx, Ly, Lz.
fn reference(name: &str) -> Vec<[f64; 8]> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/reference")
        .join(format!("{name}.csv"));
    let mut rows = csv::Reader::from_path(path).expect("the reference file");
    rows.deserialize()
        .map(|row| row.expect("eight numbers per row"))
        .collect()
}

/// Returns the largest deviations in position (m) and momentum (J s) over all rows of the reference.
fn deviations(name: &str) -> (f64, f64) {
    let mut simulation = Simulation::new(Arc::new(preset(name, &[])));
    let (mut of_position, mut of_momentum) = (0.0f64, 0.0f64);
    let rows = reference(name);
    assert!(rows.len() > 40, "{name} has its rows");
    for [step, t, x, y, z, lx, ly, lz] in rows {
        simulation.step_to(step as u64).expect("finite numbers");
        let sample = simulation.sample();
        assert!(
            (sample.time_s - t).abs() <= 1e-12 * t,
            "{name}, step {step}: t = {}",
            sample.time_s
        );
        of_position = of_position.max((sample.position - nalgebra::Vector3::new(x, y, z)).amax());
        of_momentum =
            of_momentum.max((sample.momentum - nalgebra::Vector3::new(lx, ly, lz)).amax());
    }
    assert_eq!(
        simulation.step_number(),
        simulation.scenario().steps,
        "{name}: the reference covers the run"
    );
    println!("{name}: {of_position:.1e} m, {of_momentum:.1e} J s");
    (of_position, of_momentum)
}

macro_rules! agrees {
    ($($test:ident: $name:literal)*) => {$(
        #[test]
        fn $test() {
            let (position, momentum) = deviations($name);
            assert!(position < 1e-8, "x, y, z are off by {position:e} m");
            assert!(momentum < 1e-6, "L is off by {momentum:e} J s");
        }
    )*};
}

agrees! {
    method_1: "method-1"
    method_1_steeper: "method-1-steeper"
    method_2_slow: "method-2-slow"
    method_2: "method-2"
    wobble_push: "wobble-push"
    wobble_push_accumulating: "wobble-push-accumulating"
}
