//! Coverage of stated uncertainties: measured precession and nutation of random runs, compared with theory.

mod foot_force;
mod others;

use crate::support::dice::Dice;
use crate::support::scenarios;
use gyrolab::engine::analysis::{Instruments, MeasuredNumber, Monitor};
use gyrolab::engine::run::Simulation;
use gyrolab::engine::scenario::Scenario;
use rayon::prelude::*;
use std::sync::Arc;

fn preset(name: &str, set: &[&str]) -> Arc<Scenario> {
    Arc::new(scenarios::preset(name, set))
}

fn measured(scenario: &Arc<Scenario>) -> [Option<MeasuredNumber>; 2] {
    let mut simulation = Simulation::new(Arc::clone(scenario));
    let mut instruments = Instruments::new(simulation.now());
    while simulation.step_number() < scenario.steps {
        simulation.step().unwrap();
        instruments.record(simulation.now());
    }
    [
        instruments.precession_rad_per_s(),
        instruments.nutation_period_s().ok(),
    ]
}

fn log_between(dice: &mut Dice, least: f64, most: f64) -> f64 {
    least * (dice.unit() * (most / least).ln()).exp()
}

fn between(dice: &mut Dice, least: f64, most: f64) -> f64 {
    least + dice.unit() * (most - least)
}

/// A random number between `1 - most` and `1 + most`, but not closer to 1 than `least`.
fn about_one(dice: &mut Dice, least: f64, most: f64) -> f64 {
    let part = log_between(dice, least, most);
    1.0 + if dice.unit() < 0.5 { -part } else { part }
}

/// Kinds of starts of random runs.
const STARTS: [&str; 8] = [
    "released",
    "loops and waves",
    "near steady precession, slow",
    "near the sleeping limit, almost upright",
    "falling",
    "near the vertical",
    "hanging",
    "near steady precession, fast",
];

/// A random run under `exact`, with its true precession (rad/s), nutation period (s) and number of nutations.
struct Case {
    scenario: Arc<Scenario>,
    truth: [f64; 2],
    nutations: f64,
}

fn random(seed: u64) -> Option<Case> {
    let mut dice = Dice(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1);
    (0..20).for_each(|_| {
        dice.unit();
    });
    let dice = &mut dice;
    let points = 3 + (dice.unit() * 10.0) as usize;
    let (radius, height) = (between(dice, 0.3, 1.5), between(dice, 0.2, 1.5));
    let (kg, top_kg) = (between(dice, 0.1, 1.0), dice.unit());
    let mass = points as f64 * kg;
    let across = mass * (0.5 * radius * radius + height * height) + top_kg * 4.0 * height * height;
    let load = 9.8 * (mass * height + top_kg * 2.0 * height);
    let limit = 2.0 * (across * load).sqrt();
    let mut tilt = between(dice, 5.0, 120.0);
    let mut spin = limit * log_between(dice, 0.3, 10.0);
    let mut aside = [0.0, 0.0];
    let start = (seed % 8) as usize;
    match STARTS[start] {
        "released" => {}
        "loops and waves" => aside = [(); 2].map(|()| between(dice, -0.7, 0.7) * spin),
        "near steady precession, slow" | "near steady precession, fast" => {
            tilt = between(dice, 5.0, 80.0);
            spin = limit * log_between(dice, 1.05, 10.0);
            let (sin, cos) = tilt.to_radians().sin_cos();
            let root = spin + (spin * spin - 4.0 * across * load * cos).sqrt();
            let rate = match start {
                2 => 2.0 * load / root,
                _ => root / (2.0 * across * cos),
            };
            aside[1] = across * rate * sin * about_one(dice, 1e-6, 1e-1);
        }
        "near the sleeping limit, almost upright" => {
            tilt = log_between(dice, 0.01, 3.0);
            spin = limit * between(dice, 0.6, 1.5);
        }
        "falling" => {
            tilt = between(dice, 5.0, 60.0);
            spin = limit * between(dice, 0.01, 0.4);
        }
        "near the vertical" => {
            // It passes through the vertical if L_z equals L.axle.
            let (sin, cos) = tilt.to_radians().sin_cos();
            aside[1] = (spin * about_one(dice, 1e-6, 1e-1) - spin * cos) / sin;
        }
        _ => {
            tilt = between(dice, 120.0, 179.0);
            aside = [(); 2].map(|()| between(dice, -0.7, 0.7) * spin);
        }
    }
    let build = |step: f64, steps: u64| {
        let [x, y] = aside;
        let text = format!(
            "title = 'x'\n[body.rim]\npoints = {points}\nradius_m = {radius}\nheight_m = {height}\n\
             point_mass_kg = {kg}\n[[body.point]]\nname = 'top'\nat_m = [0, 0, {}]\nmass_kg = {top_kg}\n\
             [start]\ntilt_deg = {tilt}\nmomentum_Js = [{x}, {y}, {spin}]\nmomentum_frame = 'body'\n\
             [motion]\nscheme = 'exact'\ntime_step_s = {step}\nsteps = {steps}\n",
            2.0 * height
        );
        Arc::new(scenarios::parse(&text))
    };
    let theory = Monitor::new(Simulation::new(build(0.01, 1)).now()).theory(0.0)?;
    let truth = [theory.precession?, theory.nutation_period_s?];
    let per_nutation = log_between(dice, 2.2, 300.0);
    let steps = (log_between(dice, 0.3, 100.0) * per_nutation).max(2.0) as u64;
    Some(Case {
        scenario: build(truth[1] / per_nutation, steps),
        truth,
        nutations: steps as f64 / per_nutation,
    })
}

#[test]
fn stated_uncertainties_cover_theory_in_random_runs() {
    let runs: Vec<_> = (1..=1000_u64)
        .into_par_iter()
        .filter_map(|seed| {
            let case = random(seed)?;
            Some((seed, measured(&case.scenario), case))
        })
        .collect();
    assert_eq!(runs.len(), 1000, "theory covers every run");
    for (which, name) in ["precession", "nutation"].into_iter().enumerate() {
        let mut errors = Vec::new();
        for (seed, measured, case) in &runs {
            let Some(measured) = measured[which] else {
                // A value is missing only if the run covers less than a nutation or passes through the vertical.
                assert!(case.nutations < 1.0 || *seed % 8 == 3, "{name} of {seed}");
                continue;
            };
            let off = (measured.value - case.truth[which]).abs() / measured.uncertainty;
            assert!(off < 6.0, "{name} of {seed}: {off}, {measured:?}");
            errors.push(off);
        }
        errors.sort_by(f64::total_cmp);
        let (count, within) = (errors.len(), errors.partition_point(|&off| off <= 2.0));
        let median = errors[count / 2];
        println!("{name}: {count} given, {within} within 2 standard errors, median {median}");
        let is_covered = within as f64 >= 0.93 * count as f64;
        assert!(is_covered, "{name}: {within} of {count}");
        assert!(median >= 0.2, "{name} is padded: {median}");
        assert!(count >= 850, "{name} is withheld: {count} given");
    }
}

#[test]
fn short_runs_state_only_what_they_determine() {
    let loops = [
        "motion.scheme=exact",
        "start.momentum_Js=[0,-16,60]",
        "motion.time_step_s=0.005",
        "motion.steps=2000",
    ];
    let [precession, _] = measured(&preset("loops", &loops));
    let precession = precession.unwrap();
    let off = (precession.value - 0.76714098).abs();
    assert!(off < 2.0 * precession.uncertainty + 1e-8, "{precession:?}");

    // A nutation takes 2.366 s.
    for (steps, known) in [(3000, true), (1000, false)] {
        let steps = format!("motion.steps={steps}");
        let set = ["motion.scheme=exact", "motion.time_step_s=0.001", &steps];
        let sleeping = preset("sleeping", &set);
        let found = measured(&sleeping);
        for (one, truth) in found.iter().zip([1.70342095, 2.36591637]) {
            assert_eq!(one.is_some(), known, "{steps}: {one:?}");
            let beyond = one.map_or(0.0, |one| (one.value - truth).abs() - 2.0 * one.uncertainty);
            assert!(beyond < 1e-8, "{one:?}");
        }
    }
}

#[test]
fn whole_turns_between_rows_are_counted() {
    // An unstable sleeper lingers upright and turns there, by more than a turn in each of these time steps.
    let motion = "motion={scheme='exact', time_step_s=3.7, steps=40}";
    let coarse = preset("sleeping-unstable", &[motion]);
    let [precession, _] = measured(&coarse);
    let precession = precession.unwrap();
    let off = (precession.value - 2.36684257).abs() / precession.uncertainty;
    assert!(off < 3.0, "{off} standard errors: {precession:?}");
}
