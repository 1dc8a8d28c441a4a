//! The values of a run at the measured times.

use crate::support::scenarios::preset;
use gyrolab::engine::data::{DataKind, TimeSeries, at_times, read};
use gyrolab::engine::run::{Simulation, Truth};
use std::sync::Arc;

/// A series of `columns` with a row at each of `times_s`.
fn series(columns: &[&str], times_s: &[f64]) -> TimeSeries {
    let mut text = format!("t_s,{}\n", columns.join(","));
    for time_s in times_s {
        text += &format!("{time_s}{}\n", ",0".repeat(columns.len()));
    }
    match read("lab.csv", &text).unwrap().data {
        DataKind::Series(series) => series,
        DataKind::Table(_) => unreachable!(),
    }
}

fn values(series: &TimeSeries, preset_name: &str, set: &[&str]) -> Vec<Vec<f64>> {
    let scenario = Arc::new(preset(preset_name, set));
    at_times(series, &scenario, &|| true).unwrap().unwrap()
}

#[test]
fn values_at_steps_equal_the_exported_ones() {
    let times_s: Vec<f64> = (0..40).map(|step| f64::from(step) * 0.1).collect();
    let series = series(&["z_m", "azimuth_deg", "Lx_Js"], &times_s);
    for scheme in ["report", "strang", "exact"] {
        let set = [format!("motion.scheme={scheme}")];
        let set: Vec<&str> = set.iter().map(String::as_str).collect();
        let values = values(&series, "wobble-push", &set);
        let mut simulation = Simulation::new(Arc::new(preset("wobble-push", &set)));
        let rows = values[0].iter().zip(&values[1]).zip(&values[2]);
        for (row, ((z_m, azimuth_deg), lx_js)) in (0..).zip(rows) {
            simulation.step_to(row).unwrap();
            let sample = simulation.sample();
            assert_eq!(*z_m, sample.position.z, "{scheme} {row}");
            assert_eq!(*azimuth_deg, sample.azimuth_deg, "{scheme} {row}");
            assert_eq!(*lx_js, sample.momentum.x, "{scheme} {row}");
        }
    }
}

#[test]
fn values_between_steps_have_the_accuracy_of_the_scheme() {
    // Two thirds of a time step after every step, with a push in seconds and one in steps.
    let times_s: Vec<f64> = (0..30)
        .map(|step| f64::from(step) * 0.02 + 0.0133)
        .collect();
    let series = series(&["tilt_deg", "spin_rpm"], &times_s);
    let set = ["motion.time_step_s=0.02", "motion.scheme=srkn11b"];
    let found = values(&series, "loops", &set);
    let mut truth = Truth::new(Arc::new(preset("loops", &set)));
    for (row, &time_s) in times_s.iter().enumerate() {
        let state = truth.state_at(time_s);
        let tilt_deg = gyrolab::physics::observables::tilt_deg(&state);
        assert!(
            (found[0][row] - tilt_deg).abs() < 1e-6,
            "{} {tilt_deg}",
            found[0][row]
        );
    }
}

#[test]
fn values_of_exact_do_not_depend_on_the_time_step() {
    let times_s = [0.0, 0.137, 0.137, 2.5, 90.0];
    let series = series(&["tilt_deg", "x_m", "Lz_Js"], &times_s);
    let coarse = values(
        &series,
        "cusps",
        &["motion.scheme=exact", "motion.time_step_s=7"],
    );
    let fine = values(
        &series,
        "cusps",
        &["motion.scheme=exact", "motion.time_step_s=0.01"],
    );
    for (one, other) in coarse.iter().flatten().zip(fine.iter().flatten()) {
        assert!(
            (one - other).abs() <= 1e-10 * other.abs().max(1.0),
            "{one} {other}"
        );
    }
}

#[test]
fn values_after_the_last_step_continue_the_motion() {
    let series = series(&["tilt_deg", "azimuth_deg"], &[0.0, 5.0]);
    let short = values(&series, "method-1", &["motion.steps=1"]);
    assert_eq!(short, values(&series, "method-1", &[]));
}
