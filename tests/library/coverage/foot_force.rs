//! The mean force of the floor on the foot over whole nutations equals the weight within its stated uncertainty.

use super::{Case, preset, random};
use crate::support::scenarios;
use gyrolab::engine::analysis::{MeasuredNumber, Monitor};
use gyrolab::engine::run::Simulation;
use gyrolab::engine::scenario::Scenario;
use rayon::prelude::*;
use std::sync::Arc;

/// Returns the mean force over a whole run and its expected value, N.
fn mean_of(scenario: &Arc<Scenario>) -> (Option<MeasuredNumber>, f64) {
    let mut simulation = Simulation::new(Arc::clone(scenario));
    let mut monitor = Monitor::new(simulation.now());
    while simulation.step_number() < scenario.steps {
        monitor.measure(simulation.step().unwrap());
    }
    let weight = monitor.predicted_mean_foot_force(simulation.now());
    (monitor.mean_foot_force(), weight)
}

#[test]
fn the_mean_force_does_not_depend_on_the_end_of_the_run() {
    for steps in [300, 995, 1000, 1003, 1500, 1990, 2000, 2001] {
        let scenario = preset("method-1", &[&format!("motion.steps={steps}")]);
        let (mean, weight) = mean_of(&scenario);
        let mean = mean.unwrap();
        assert!((weight - 49.0).abs() < 1e-12, "{weight}");
        let off = (mean.value - weight).abs();
        assert!(off <= 2.0 * mean.uncertainty, "{steps}: {mean:?}");
        let known_to = 1500.0 / steps as f64;
        assert!(mean.uncertainty < known_to, "{steps}: {mean:?}");
    }
}

#[test]
fn the_mean_force_needs_a_whole_nutation() {
    // A nutation takes 0.8225 s; the start is at the highest point.
    for (steps, is_known) in [(80, false), (85, true)] {
        let motion = format!("motion={{scheme='exact', time_step_s=0.01, steps={steps}}}");
        let (mean, _) = mean_of(&preset("cusps", &[&motion]));
        assert_eq!(mean.is_some(), is_known, "{steps} steps: {mean:?}");
    }
    // A steady top has no nutation.
    let (mean, _) = mean_of(&preset("steady-slow", &["motion.scheme=exact"]));
    assert!(mean.is_none_or(|mean| (mean.value - 49.0).abs() < 1e-6));
}

#[test]
fn the_mean_force_includes_a_push() {
    let push = "push=[{point='top', force_N=[0, 0, -50], from_s=2, for_s=100}]";
    let (mean, weight) = mean_of(&preset("cusps", &["motion.steps=20000", push]));
    let mean = mean.unwrap();
    assert_eq!(weight, 99.0);
    let off = (mean.value - weight).abs();
    assert!(
        off <= 2.0 * mean.uncertainty && mean.uncertainty < 0.1,
        "{mean:?}"
    );
}

#[test]
fn the_mean_force_of_a_lopsided_body_is_its_weight() {
    let lopsided = include_str!("../../reference/lopsided/uneven.toml");
    let (mean, weight) = mean_of(&Arc::new(scenarios::parse(lopsided)));
    let mean = mean.unwrap();
    let off = (mean.value - weight).abs();
    assert!(
        off <= 2.0 * mean.uncertainty && mean.uncertainty < 0.01,
        "{mean:?}"
    );
}

#[test]
fn the_stated_uncertainty_covers_the_weight_in_random_runs() {
    let runs: Vec<_> = (1..=1000_u64)
        .into_par_iter()
        .filter_map(|seed| {
            let Case {
                scenario,
                nutations,
                ..
            } = random(seed)?;
            Some((seed, nutations, mean_of(&scenario)))
        })
        .collect();
    let mut errors = Vec::new();
    for (seed, nutations, (mean, weight)) in &runs {
        let Some(mean) = mean else {
            assert!(
                *nutations < 2.0,
                "no mean for seed {seed}, {nutations} nutations"
            );
            continue;
        };
        let off = (mean.value - weight).abs() / mean.uncertainty;
        assert!(off < 6.0, "{seed}: {off}, {mean:?}");
        errors.push(off);
    }
    errors.sort_by(f64::total_cmp);
    let (count, within) = (errors.len(), errors.partition_point(|&off| off <= 2.0));
    let median = errors[count / 2];
    println!("foot force: {count} given, {within} within 2 standard errors, median {median}");
    assert!(within as f64 >= 0.93 * count as f64, "{within} of {count}");
    assert!(median >= 0.2, "uncertainties too large: {median}");
    assert!(count >= 700, "too few stated: {count}");
}
