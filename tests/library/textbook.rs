//! The textbook's top (ring of 5 kg at 1 m: I1 = 6.6, I3 = 3.2, mgl = 49), measured in runs of the shipped presets and
//! compared with values from elliptic integrals (30 digits), which are independent of any integration.

use crate::support::scenarios::preset as preset_with;
use gyrolab::engine::run::{Sample, Simulation};
use std::sync::Arc;

fn samples(preset: &str, set: &[&str]) -> Vec<Sample> {
    let scenario = preset_with(preset, set);
    let steps = scenario.steps;
    let mut simulation = Simulation::new(Arc::new(scenario));
    let mut samples = vec![simulation.sample()];
    for _ in 0..steps {
        simulation.step().unwrap();
        samples.push(simulation.sample());
    }
    samples
}

/// A turning point of the tilt: time (s), tilt (degrees) and azimuth (degrees), from parabolas through three rows.
struct Turn {
    time: f64,
    tilt: f64,
    azimuth: f64,
}

fn turns(samples: &[Sample], lowest: bool) -> Vec<Turn> {
    let sign = if lowest { 1.0 } else { -1.0 };
    samples
        .windows(3)
        .filter(|w| {
            let [a, b, c] = [0, 1, 2].map(|i| sign * w[i].tilt_deg);
            b < a && b <= c
        })
        .map(turn)
        .collect()
}

fn turn(w: &[Sample]) -> Turn {
    let dt = w[1].time_s - w[0].time_s;
    let parabola = |read: fn(&Sample) -> f64| {
        let (a, b, c) = (read(&w[0]), read(&w[1]), read(&w[2]));
        (b, (c - a) / 2.0, a - 2.0 * b + c)
    };
    let (tilt, slope, bend) = parabola(|s| s.tilt_deg);
    let shift = -slope / bend;
    let (azimuth, azimuth_slope, azimuth_bend) = parabola(|s| s.azimuth_deg);
    Turn {
        time: w[1].time_s + shift * dt,
        tilt: tilt + slope * shift / 2.0,
        azimuth: azimuth + azimuth_slope * shift + azimuth_bend * shift * shift / 2.0,
    }
}

/// Returns the nutation period (s) and mean precession (rad/s) between the first and the last upper turning point.
fn period_and_precession(samples: &[Sample]) -> (f64, f64) {
    let tops = turns(samples, true);
    let (first, last) = (&tops[0], &tops[tops.len() - 1]);
    let time = last.time - first.time;
    (
        time / (tops.len() - 1) as f64,
        (last.azimuth - first.azimuth).to_radians() / time,
    )
}

fn close(what: &str, measured: f64, expected: f64, within: f64) {
    let off = (measured / expected - 1.0).abs();
    println!("{what}: {measured:.9}, off by {off:.1e}");
    assert!(off < within, "{what} is {measured}, not {expected}");
}

#[test]
fn tilt_range_nutation_and_precession_match_elliptic_integrals() {
    // preset, lowest and highest tilt (degrees), nutation period (s), mean precession (rad/s)
    let table = [
        ("cusps", 30.0, 36.6891215715, 0.822521087585, 0.886032863298),
        ("loops", 30.0, 43.3267678253, 0.8097216424, 0.872935381503),
        ("waves", 30.0, 33.3002708561, 0.827518102136, 0.890195118803),
        ("sleeping", 1.0, 2.28336417813, 2.36591636939, 1.70342095023),
        (
            "sleeping-unstable",
            1.0,
            38.1878118248,
            8.72583595257,
            2.36684256607,
        ),
        ("falling", 10.0, 130.944390908, 2.93780581566, 1.61148134762),
        (
            "fast-top",
            30.0,
            30.0743677501,
            0.0831243970825,
            0.0981099524335,
        ),
    ];
    for (preset, lowest, highest, period, precession) in table {
        let samples = samples(
            preset,
            &["motion.time_step_s=0.00025", "motion.steps=80000"],
        );
        let low = turns(&samples, true);
        let high = turns(&samples, false);
        close(&format!("{preset}, lowest tilt"), low[0].tilt, lowest, 1e-6);
        close(
            &format!("{preset}, highest tilt"),
            high[0].tilt,
            highest,
            1e-6,
        );
        let (measured_period, measured_precession) = period_and_precession(&samples);
        close(
            &format!("{preset}, nutation period"),
            measured_period,
            period,
            1e-6,
        );
        close(
            &format!("{preset}, precession"),
            measured_precession,
            precession,
            1e-6,
        );
    }
}

#[test]
fn small_nutation_about_steady_precession_has_the_known_period() {
    for (preset, momentum, period) in [
        ("steady-slow", 2.9454441985424347, 0.83131382),
        ("steady-fast", 31.695571952835103, 0.70252998),
    ] {
        // To first order, a nudge also changes the mean tilt and thus the period. Nudges in both directions cancel this.
        let nudged = |nudge: f64| {
            let set = format!("start.momentum_Js.1={}", momentum + nudge);
            let samples = samples(
                preset,
                &[&set, "motion.time_step_s=0.00025", "motion.steps=40000"],
            );
            period_and_precession(&samples).0
        };
        close(preset, 0.5 * (nudged(1e-3) + nudged(-1e-3)), period, 1e-7);
    }
}

#[test]
fn without_torque_the_report_scheme_aligns_the_axle_with_l() {
    // κ = 0.485 is below 1: the scheme damps the free nutation, more strongly with larger steps.
    for (dt, steps, tilt, within) in [("0.001", 20_000, 13.5, 0.05), ("0.01", 2_000, 0.005, 5e-4)] {
        let set = [
            "motion.scheme=report".to_owned(),
            format!("motion.time_step_s={dt}"),
            format!("motion.steps={steps}"),
        ];
        let set: Vec<_> = set.iter().map(String::as_str).collect();
        let end = samples("torque-free", &set).pop().unwrap();
        assert!(
            (end.tilt_deg - tilt).abs() < within,
            "dt = {dt}: {}",
            end.tilt_deg
        );
    }
}
