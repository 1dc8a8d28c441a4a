//! Coverage of stated uncertainties where theory gives no number: for the motion that a scheme produces, under-sampled
//! runs and lopsided bodies.
//!
//! A measurement describes the run at its steps. The true value is therefore that of a longer run. It has the same scheme
//! and time step if these determine the motion, and finer rows of the exact motion if they only sample it. A scheme whose
//! motion changes over time has no true value: only pairs in which both halves of the longer run agree are compared.

use super::{Case, between, log_between, preset, random};
use crate::support::dice::Dice;
use crate::support::scenarios::parse;
use gyrolab::engine::analysis::{Instruments, MeasuredNumber, WithoutNutation};
use gyrolab::engine::run::Simulation;
use gyrolab::engine::scenario::{Document, Scenario};
use rayon::prelude::*;
use std::f64::consts::TAU;
use std::sync::Arc;

/// Precession (rad/s) and nutation (s).
type Measurements = [Option<MeasuredNumber>; 2];

/// Measurements of a short run, and of a longer one: the whole of it, and each half.
struct Pair {
    seed: u64,
    short: Measurements,
    long: [Measurements; 3],
}

fn both(instruments: &Instruments) -> Measurements {
    [
        instruments.precession_rad_per_s(),
        instruments.nutation_period_s().ok(),
    ]
}

/// Measures the whole run, its first half and its second half. Returns `None` if the run breaks down.
fn measure_halves(scenario: &Arc<Scenario>) -> Option<[Measurements; 3]> {
    let mut simulation = Simulation::new(Arc::clone(scenario));
    let mut whole = Instruments::new(simulation.now());
    let (mut first, mut second) = (whole.clone(), whole.clone());
    while simulation.step_number() < scenario.steps {
        simulation.step().ok()?;
        whole.record(simulation.now());
        if simulation.step_number() == scenario.steps / 2 {
            (first, second) = (whole.clone(), Instruments::new(simulation.now()));
        } else {
            second.record(simulation.now());
        }
    }
    Some([&whole, &first, &second].map(both))
}

fn dice(seed: u64) -> Dice {
    let mut dice = Dice(seed.wrapping_mul(0xD134_2543_DE82_EF95) | 1);
    (0..20).for_each(|_| {
        dice.unit();
    });
    dice
}

/// Returns `scenario` with another scheme, time step and number of steps.
fn with_motion(scenario: &Scenario, scheme: &str, time_step_s: f64, steps: u64) -> Arc<Scenario> {
    let mut file = scenario.file.clone();
    file.motion.scheme = Some(scheme.to_owned());
    file.motion.time_step_s = time_step_s;
    file.motion.steps = steps;
    let document = Document::from_file("again", &file).unwrap();
    Arc::new(document.scenario().unwrap())
}

/// Measures a random symmetric body under `scheme`, and the same motion for 20 times as long. `rows` is the range of steps
/// per nutation or turn of the body, whichever is shorter (below 2: per nutation).
fn stepped(seed: u64, scheme: &str, rows: [f64; 2]) -> Option<Pair> {
    let Case {
        scenario, truth, ..
    } = random(seed)?;
    let mut dice = dice(seed);
    let start = Simulation::new(Arc::clone(&scenario));
    let turn_s = TAU / start.now().angular_velocity().norm();
    let (quickest_s, lasts) = if rows[0] < 2.0 {
        (truth[1], [20.0, 400.0])
    } else {
        (truth[1].min(turn_s), [0.6, 40.0])
    };
    let time_step_s = quickest_s / log_between(&mut dice, rows[0], rows[1]);
    let nutations = log_between(&mut dice, lasts[0], lasts[1]);
    let steps = (nutations * truth[1] / time_step_s).max(2.0) as u64;
    let run = |count| measure_halves(&with_motion(&scenario, scheme, time_step_s, count));
    Some(Pair {
        seed,
        short: run(steps)?[0],
        long: run(20 * steps)?,
    })
}

/// Measures a random lopsided body under `exact`, and the same in steps of 1/40 nutation for 10 times as long.
fn lopsided(seed: u64) -> Option<Pair> {
    let mut dice = dice(seed);
    let dice = &mut dice;
    let (radius, height) = (between(dice, 0.3, 1.5), between(dice, 0.2, 1.5));
    let extra = log_between(dice, 0.003, 0.5);
    let mass = 3.0;
    let across = mass * (0.5 * radius * radius + height * height);
    let spin = 2.0 * (across * mass * 9.8 * height).sqrt() * log_between(dice, 1.0, 6.0);
    let tilt = between(dice, 10.0, 100.0);
    let aside = [(); 2].map(|()| between(dice, -0.3, 0.3) * spin);
    let build = |step: f64, steps: u64| {
        let text = format!(
            "title = 'x'\n[body.rim]\npoints = 6\nradius_m = {radius}\nheight_m = {height}\n\
             point_mass_kg = 0.5\n[[body.point]]\nname = 'top'\nat_m = [0, 0, {}]\n[[body.point]]\n\
             name = 'more'\nat_m = [{radius}, 0, {height}]\nmass_kg = {extra}\n\
             [start]\ntilt_deg = {tilt}\nmomentum_Js = [{}, {}, {spin}]\nmomentum_frame = 'body'\n\
             [motion]\nscheme = 'exact'\ntime_step_s = {step}\nsteps = {steps}\n",
            2.0 * height,
            aside[0],
            aside[1],
        );
        Arc::new(parse(&text))
    };
    let guess_s = TAU * across / spin;
    let period_s = measure_halves(&build(guess_s / 40.0, 800))?[0][1]?.value;
    let per_nutation = log_between(dice, 2.2, 60.0);
    let nutations = log_between(dice, 3.0, 40.0);
    let steps = (nutations * per_nutation) as u64;
    Some(Pair {
        seed,
        short: measure_halves(&build(period_s / per_nutation, steps))?[0],
        long: measure_halves(&build(period_s / 40.0, (400.0 * nutations) as u64))?,
    })
}

/// Compares the short runs with the long ones; at least `fewest` of them must have a true value.
fn assert_coverage(what: &str, pairs: &[Pair], fewest: usize) {
    let is_exact = what == "strobed" || what.starts_with("lopsided");
    for (which, name) in ["precession", "nutation"].into_iter().enumerate() {
        let mut off: Vec<(f64, u64)> = Vec::new();
        for pair in pairs {
            let [whole, first, second] = pair.long.map(|both| both[which]);
            let (Some(short), Some(long)) = (pair.short[which], whole) else {
                continue;
            };
            let apart = first
                .zip(second)
                .map_or(f64::INFINITY, |(a, b)| (a.value - b.value).abs());
            let error = short.uncertainty.hypot(long.uncertainty);
            // Differing halves belong to different motions, except under `exact`, where they differ only by beats.
            if is_exact || apart <= 0.5 * short.uncertainty {
                off.push(((short.value - long.value).abs() / error, pair.seed));
            }
        }
        off.sort_by(|a, b| a.0.total_cmp(&b.0));
        let within = off.partition_point(|(off, _)| *off <= 2.0);
        let worst = off.last().copied().unwrap_or_default();
        let count = off.len();
        let median = off.get(count / 2).map_or(0.0, |(off, _)| *off);
        println!(
            "{what} {name}: {count} held, {within} within 2 standard errors, median {median:.2}, worst {worst:?}"
        );
        let is_padded = what.starts_with("lopsided") && median < 0.2;
        assert!(!is_padded, "{what} {name} is padded: {median}");
        assert!(count >= fewest, "{what} {name}: {count} held");
        let is_covered = within as f64 >= 0.93 * count as f64;
        assert!(is_covered, "{what} {name}: {within} of {count}");
        let pair = pairs.iter().find(|pair| pair.seed == worst.1);
        let told = pair.map(|pair| (pair.short[which], pair.long.map(|both| both[which])));
        assert!(worst.0 < 6.0, "{what} {name}: {worst:?}, {told:?}");
    }
}

#[test]
#[ignore = "measures 360 runs: seconds"]
fn stated_uncertainties_cover_the_motion_of_each_scheme() {
    for (scheme, fewest) in [("rk4", 20), ("strang", 80), ("srkn11b", 80)] {
        let seeds = (1..=120_u64).into_par_iter();
        let pairs: Vec<_> = seeds
            .filter_map(|seed| stepped(seed, scheme, [20.0, 200.0]))
            .collect();
        assert_coverage(scheme, &pairs, fewest);
    }
}

#[test]
fn stated_uncertainties_cover_under_sampled_runs() {
    let seeds = (1..=400_u64).into_par_iter();
    let pairs: Vec<_> = seeds
        .filter_map(|seed| stepped(seed, "exact", [0.6, 1.9]))
        .collect();
    assert_coverage("strobed", &pairs, 100);
}

#[test]
#[ignore = "measures 800 runs: seconds"]
fn stated_uncertainties_cover_lopsided_bodies() {
    let pairs: Vec<_> = (1..=800_u64).into_par_iter().filter_map(lopsided).collect();
    assert_coverage("lopsided", &pairs, 100);
}

/// Measures a random body of three solids on the axle and a lump off it under `exact`, and the same in steps of
/// 1/40 nutation for 20 times as long.
fn lopsided_of_parts(seed: u64) -> Option<Pair> {
    let mut dice = dice(seed);
    let dice = &mut dice;
    let parts: String = (0..3)
        .map(|part| {
            let (mass, at) = (between(dice, 0.2, 1.5), between(dice, 0.05, 0.8));
            let (radius, length) = (between(dice, 0.1, 0.4), between(dice, 0.02, 0.3));
            format!(
                "[[body.part]]\nshape = 'cylinder'\nname = 'p{part}'\nmass_kg = {mass}\n\
                 at_m = [0, 0, {at}]\nradius_m = {radius}\nlength_m = {length}\n"
            )
        })
        .collect();
    let lump = [
        between(dice, -0.1, 0.1),
        between(dice, -0.1, 0.1),
        between(dice, -0.1, 0.3),
    ];
    let (lump_kg, lump_m) = (log_between(dice, 0.01, 0.3), between(dice, 0.03, 0.12));
    let (tilt, turn) = (between(dice, 10.0, 100.0), between(dice, 0.0, 360.0));
    let (faster, aside) = (log_between(dice, 1.0, 6.0), 0.15 * dice.unit().powi(2));
    let aside = [(); 2].map(|()| between(dice, -aside, aside));
    let build = |momentum: [f64; 3], step: f64, steps: u64| {
        let text = format!(
            "title = 'x'\n[[body.point]]\nname = 'top'\nat_m = [0, 0, 1]\n{parts}[[body.part]]\n\
             shape = 'ball'\nname = 'lump'\nmass_kg = {lump_kg}\nat_m = {lump:?}\nradius_m = {lump_m}\n\
             [start]\ntilt_deg = {tilt}\nturn_deg = {turn}\nmomentum_Js = {momentum:?}\n\
             momentum_frame = 'body'\n[motion]\nscheme = 'exact'\ntime_step_s = {step}\nsteps = {steps}\n"
        );
        Arc::new(parse(&text))
    };
    let body = &build([0.0, 0.0, 1.0], 0.01, 1).body.mechanics;
    let across = body.inertia()[(0, 0)];
    let spin = 2.0 * (across * 9.8 * body.first_moment().z).sqrt() * faster;
    let momentum = [aside[0] * spin, aside[1] * spin, spin];
    let period_s = TAU * across / spin;
    let (per_nutation, nutations) = (log_between(dice, 8.0, 60.0), log_between(dice, 17.0, 80.0));
    let steps = (nutations * per_nutation) as u64;
    Some(Pair {
        seed,
        short: measure_halves(&build(momentum, period_s / per_nutation, steps))?[0],
        long: measure_halves(&build(
            momentum,
            period_s / 40.0,
            (800.0 * nutations) as u64,
        ))?,
    })
}

#[test]
#[ignore = "measures hundreds of long runs: a minute"]
fn stated_uncertainties_cover_lopsided_bodies_of_parts() {
    let seeds = (1..=200_u64).into_par_iter();
    let pairs: Vec<_> = seeds.filter_map(lopsided_of_parts).collect();
    assert_coverage("lopsided of parts", &pairs, 60);
}

/// Parses the scenario in `text` and extends it to `times` its duration.
fn extended(text: &str, times: u64) -> Arc<Scenario> {
    let scenario = parse(text);
    let (motion, steps) = (scenario.motion, scenario.steps * times);
    with_motion(&scenario, motion.scheme.name, motion.time_step_s, steps)
}

#[test]
fn the_uncertainty_of_a_lopsided_top_includes_its_beats() {
    let beats = include_str!("../../reference/lopsided/beats.toml");
    let short = measure_halves(&extended(beats, 1)).unwrap()[0];
    let long = measure_halves(&extended(beats, 20)).unwrap()[0];
    for (of_short, of_long) in short.into_iter().zip(long) {
        let (stated, truth) = (of_short.unwrap(), of_long.unwrap());
        let off = (stated.value - truth.value).abs() / stated.uncertainty;
        assert!(off < 2.0, "{off}: {stated:?}, {truth:?}");
    }
}

#[test]
fn an_ambiguous_nutation_period_is_not_stated() {
    let uneven = extended(include_str!("../../reference/lopsided/uneven.toml"), 1);
    let mut simulation = Simulation::new(Arc::clone(&uneven));
    let mut instruments = Instruments::new(simulation.now());
    while simulation.step_number() < uneven.steps {
        instruments.record(simulation.step().unwrap());
    }
    let nutation = instruments.nutation_period_s();
    assert_eq!(nutation, Err(WithoutNutation::Uneven));
}

/// Measures the nutation of a tumbling block, in coarse rows and in finer rows of the same duration.
fn tumbling(seed: u64) -> Option<[MeasuredNumber; 2]> {
    let mut dice = dice(seed);
    let dice = &mut dice;
    let size = [(); 3].map(|()| log_between(dice, 0.05, 0.4));
    let (height, tilt) = (between(dice, 0.02, 0.4), between(dice, 5.0, 170.0));
    let spin = log_between(dice, 5.0, 60.0);
    let aside = [(); 2].map(|()| between(dice, -1.0, 1.0) * spin);
    let nutation = |step: f64, steps: u64| {
        let text = format!(
            "title = 'x'\ntrace = 'box'\n[[body.part]]\nname = 'box'\nshape = 'block'\nmass_kg = 1\n\
             size_m = {size:?}\nat_m = [0, 0, {height}]\n[start]\ntilt_deg = {tilt}\n\
             omega_rad_per_s = [{}, {}, {spin}]\nomega_frame = 'body'\n\
             [motion]\nscheme = 'exact'\ntime_step_s = {step}\nsteps = {steps}\n",
            aside[0], aside[1]
        );
        super::measured(&Arc::new(parse(&text)))[1]
    };
    let period_s = nutation(TAU / spin / 60.0, 2400)?.value;
    let (per_nutation, nutations) = (log_between(dice, 2.2, 60.0), log_between(dice, 16.0, 60.0));
    let steps = (nutations * per_nutation) as u64;
    let (step_s, finer) = (period_s / per_nutation, (120.0 / per_nutation).ceil());
    Some([
        nutation(step_s, steps)?,
        nutation(step_s / finer, steps * finer as u64)?,
    ])
}

#[test]
#[ignore = "measures hundreds of runs: seconds"]
fn nutations_hidden_between_rows_do_not_bias_the_period() {
    let seeds = (1..=400_u64).into_par_iter();
    let pairs: Vec<_> = seeds
        .filter_map(|seed| Some((seed, tumbling(seed)?)))
        .collect();
    assert!(pairs.len() >= 100, "{}", pairs.len());
    for (seed, [rows, fine]) in pairs {
        let off = (rows.value - fine.value).abs() / rows.uncertainty;
        assert!(off < 6.0, "{seed}: {off}, {rows:?}, {fine:?}");
    }
}

#[test]
fn a_nutation_produced_by_the_scheme_has_its_own_period() {
    // A steady start has no nutation, but the first-order scheme produces a small one.
    for (spin_rpm, period_s) in [(300, 0.2031), (180, 0.348)] {
        let start = format!("start.spin_rpm={spin_rpm}");
        let steady = ["start.tilt_deg=30", &start, "start.steady=true"];
        let motion = ["motion.time_step_s=0.001", "motion.steps=10000"];
        let steady = preset("method-2", &[&steady[..], &motion].concat());
        let [_, nutation] = measure_halves(&steady).unwrap()[0];
        let nutation = nutation.unwrap();
        let off = (nutation.value - period_s).abs();
        assert!(off < 2e-3, "{spin_rpm}: {nutation:?}");
    }
}
