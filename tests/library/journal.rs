//! A run is a scenario and its journal: the effect of an edit, the step from which it acts, and what it leaves unchanged.

use crate::support::scenarios::{parse, preset};
use gyrolab::engine::export::{CsvLayout, CsvWriter, stream};
use gyrolab::engine::run::{Sample, Simulation};
use gyrolab::physics::workings::{PhaseName, WorkedValue};
use std::fmt::Write;
use std::num::NonZeroU64;
use std::ops::ControlFlow;
use std::sync::Arc;

/// The textbook's tilted wheel, loaded only by its weight.
const WHEEL: &str = r#"
title = "Wheel"
[body.rim]
points = 10
radius_m = 0.8
height_m = 1.0
point_mass_kg = 0.5
[[body.point]]
name = "top"
at_m = [0, 0, 1.5]
[start]
tilt_deg = 30
momentum_Js = [0, 1, 60]
momentum_frame = "body"
[motion]
"#;

/// Starts the wheel with `motion` as the text after `[motion]`, and with edits: a step and the TOML of its `set` each.
fn simulation(motion: &str, edits: &[(u64, &str)]) -> Simulation {
    let mut text = format!("{WHEEL}{motion}\n");
    for (step, set) in edits {
        write!(text, "[[edit]]\nstep = {step}\nset = {{ {set} }}\n").unwrap();
    }
    Simulation::new(Arc::new(parse(&text)))
}

/// Returns the samples from step 0 to the last.
fn samples(mut simulation: Simulation) -> Vec<Sample> {
    let mut samples = vec![simulation.sample()];
    while simulation.step_number() < simulation.scenario().steps {
        simulation.step().unwrap();
        samples.push(simulation.sample());
    }
    samples
}

/// True if two samples have the same bits, apart from their segments.
fn same(a: &Sample, b: &Sample) -> bool {
    Sample { segment: 0, ..*a } == Sample { segment: 0, ..*b }
}

const COARSE: &str = "scheme = 'report'\ntime_step_s = 0.1\nsteps = 100";
const FINE: &str = "scheme = 'rk4'\ntime_step_s = 0.001\nsteps = 100";

#[test]
fn time_counts_from_the_last_edit_of_the_time_step() {
    let edits = [
        (40, "'motion.time_step_s' = 0.05"),
        (60, "'motion.gravity_m_per_s2' = 9"),
        (70, "'motion.time_step_s' = 0.3"),
    ];
    let samples = samples(simulation(COARSE, &edits));
    for (n, sample) in samples.iter().enumerate() {
        let n = n as f64;
        let expected = match n {
            ..=40.0 => n * 0.1,
            ..=70.0 => 40.0 * 0.1 + (n - 40.0) * 0.05,
            _ => 40.0 * 0.1 + 30.0 * 0.05 + (n - 70.0) * 0.3,
        };
        assert_eq!(sample.time_s.to_bits(), f64::to_bits(expected), "step {n}");
    }
}

#[test]
fn segments_count_edits_of_time_step_scheme_and_gravity() {
    let edits = [
        (0, "'motion.gravity_m_per_s2' = 9"),
        (3, "'motion.scheme' = 'rk4'"),
        (
            5,
            "'push.0' = { point = 'top', force_N = [1, 0, 0], steps = 3 }",
        ),
        (5, "'motion.time_step_s' = 0.002"),
        (
            9,
            "'motion.time_step_s' = 0.001, 'motion.gravity_m_per_s2' = 9.8",
        ),
        (12, "'motion.time_step_s' = 0.001"),
        (12, "'motion.scheme' = 'report'"),
        (20, "'motion.gravity_m_per_s2' = 1"),
        (25, "'motion.gravity_m_per_s2' = 2"),
    ];
    let motion = "scheme = 'report'\ntime_step_s = 0.001\nsteps = 20";
    let samples = samples(simulation(motion, &edits));
    let segments: String = samples
        .iter()
        .map(|sample| sample.segment.to_string())
        .collect();
    assert_eq!(segments, "011122333344466666666");
}

#[test]
fn an_edit_takes_effect_from_the_row_after_its_step() {
    let pushed = format!("{COARSE}\n[[push]]\npoint = 'top'\nforce_N = [0, 50, 0]\nsteps = 90\n");
    let plain = samples(simulation(&pushed, &[]));
    for set in [
        "'motion.time_step_s' = 0.05",
        "'motion.scheme' = 'rk4'",
        "'motion.gravity_m_per_s2' = 3",
        "'push.0.force_N' = [0, 0, 0]",
        "'push.1' = { point = 'top', force_N = [9, 0, 0], first_step = 41, steps = 5 }",
        "'push.1' = { point = 'top', force_N = [9, 0, 0], from_s = 4, for_s = 1 }",
    ] {
        let mut edited = simulation(&pushed, &[(40, set)]);
        for before in &plain[..=40] {
            edited.step_to(before.step).unwrap();
            assert_eq!(edited.sample(), *before, "{set}: step {}", before.step);
        }
        edited.step().unwrap();
        assert!(!same(&edited.sample(), &plain[41]), "{set}");
    }
}

#[test]
fn edits_at_or_after_the_end_have_no_effect() {
    let plain = samples(simulation(COARSE, &[]));
    let edits = [
        (100, "'motion.gravity_m_per_s2' = 1"),
        (100, "'motion.time_step_s' = 7"),
        (5000, "'motion.scheme' = 'rk4'"),
    ];
    assert_eq!(samples(simulation(COARSE, &edits)), plain);
}

#[test]
fn an_edit_at_step_0_equals_an_edited_scenario() {
    for (set, motion) in [
        (
            "'motion.time_step_s' = 0.002",
            FINE.replace("0.001", "0.002"),
        ),
        ("'motion.scheme' = 'report'", FINE.replace("rk4", "report")),
        (
            "'motion.gravity_m_per_s2' = 3",
            format!("{FINE}\ngravity_m_per_s2 = 3"),
        ),
    ] {
        let edited = samples(simulation(FINE, &[(0, set)]));
        let written = samples(simulation(&motion, &[]));
        assert_eq!(edited.len(), written.len());
        for (sample, expected) in edited.iter().zip(&written).skip(1) {
            assert!(same(sample, expected), "{set}: step {}", sample.step);
            assert_eq!(sample.segment, 1);
        }
    }
}

/// Returns the steps with a torque, and the torque in units of one push. Gravity is off, so only pushes cause a torque.
fn pushed_steps(motion: &str, edits: &[(u64, &str)]) -> Vec<(u64, f64)> {
    let mut simulation = simulation(&format!("gravity_m_per_s2 = 0\n{motion}\n"), edits);
    simulation.keep_workings(true);
    let mut pushed = Vec::new();
    while simulation.step_number() < simulation.scenario().steps {
        let workings = simulation.step().unwrap().workings().unwrap();
        let phase = workings
            .phases()
            .find(|phase| phase.name == PhaseName::Torque);
        let Some(&WorkedValue::Vector(torque)) = phase.unwrap().value("τ") else {
            panic!("a torque is a vector");
        };
        let torque = torque.norm();
        if torque > 0.0 {
            let force = nalgebra::Vector3::new(0.0, -2.0, 0.0);
            let one = simulation.sample().position.cross(&force).norm();
            pushed.push((simulation.step_number(), torque / one));
        }
    }
    pushed
}

#[test]
fn pushes_counted_in_steps_keep_their_seconds_after_time_step_edits() {
    let push = |first, steps| {
        format!(
            "scheme = 'report'\ntime_step_s = 0.1\nsteps = 500\n[[push]]\npoint = 'top'\nforce_N = [0, -2, 0]\nfirst_step = {first}\nsteps = {steps}\n"
        )
    };
    let once = &[(40, "'motion.time_step_s' = 0.05")][..];
    let twice = [once[0], (52, "'motion.time_step_s' = 0.2")];
    for (first, steps, edits, pushed) in [
        // 200 steps of 0.1 s are 20 s: 4 s of them before the edit, 16 s or 320 steps of 0.05 s after it.
        (1, 200, &[][..], 1..=200),
        (1, 200, once, 1..=360),
        // From 5 s to 7 s, both after the edit.
        (51, 20, once, 61..=100),
        // The push ends before the edit.
        (11, 20, once, 11..=30),
        // A second edit also keeps the seconds: 12 more steps to 4.6 s, the rest at 0.2 s.
        (1, 200, &twice, 1..=129),
    ] {
        let seen = pushed_steps(&push(first, steps), edits);
        let numbers = seen.iter().map(|(step, _)| *step);
        assert!(numbers.eq(pushed), "{first} {steps} {edits:?}");
    }
}

#[test]
fn accumulating_pushes_grow_by_time_after_time_step_edits() {
    let push = "scheme = 'report'\ntime_step_s = 0.1\nsteps = 20\n[[push]]\npoint = 'top'\nforce_N = [0, -2, 0]\nfirst_step = 2\nsteps = 8\naccumulates = true\n";
    // From step 4 on, 0.1 s is two steps.
    let edit = [(4, "'motion.time_step_s' = 0.05")];
    for (edits, expected) in [
        (&[][..], "1234567888888888888"),
        (&edit, "1234455667788888888"),
    ] {
        let seen = pushed_steps(push, edits);
        let forces = seen.iter().map(|(_, force)| force.round().to_string());
        assert_eq!(forces.collect::<String>(), expected);
    }
}

#[test]
fn a_push_in_steps_equals_the_push_in_seconds() {
    let run = |window: &str, edits: &[(u64, &str)]| {
        let push = format!("[[push]]\npoint = 'top'\nforce_N = [3, 2, 1]\n{window}");
        samples(simulation(&format!("{FINE}\n{push}\n"), edits))
    };
    for edits in [
        &[][..],
        &[(30, "'motion.time_step_s' = 0.0007")],
        &[(0, "'motion.time_step_s' = 0.002")],
    ] {
        let steps = run("first_step = 21\nsteps = 40", edits);
        let seconds = run("from_s = 0.02\nfor_s = 0.04", edits);
        for (counted, timed) in steps.iter().zip(&seconds) {
            let off = (counted.momentum - timed.momentum).norm();
            assert!(off < 1e-12, "step {}", counted.step);
        }
    }
}

/// Energy drift measures only the error of the scheme: neither pushes nor edits of gravity contribute.
#[test]
fn energy_drift_excludes_the_work_of_pushes_and_gravity_edits() {
    let motion = "scheme = 'rk4'\ntime_step_s = 0.0005\nsteps = 8000\n\
        [[push]]\npoint = 'top'\nforce_N = [0, 30, -20]\nfirst_step = 100\nsteps = 900\n\
        [[push]]\npoint = 'top'\nforce_N = [25, 0, 10]\nfrom_s = 1.00017\nfor_s = 0.70031\n\
        [[push]]\npoint = 'top'\nforce_N = [0.02, 0, 0]\nfirst_step = 4000\nsteps = 300\naccumulates = true\n";
    let edits = [
        (500, "'motion.gravity_m_per_s2' = 1.6"),
        (1200, "'push.1.force_N' = [-20, 5, 0]"),
        (
            2000,
            "'motion.gravity_m_per_s2' = 24.8, 'motion.time_step_s' = 0.0004",
        ),
        (5000, "'motion.gravity_m_per_s2' = -3"),
    ];
    let mut simulation = simulation(motion, &edits);
    let weight = 9.8 * 5.0; // M g |c|, J
    let start = simulation.sample().energy;
    let mut largest = 0.0f64;
    for step in 1..=8000 {
        simulation.step_to(step).unwrap();
        let drift = simulation.now().energy_drift().unwrap();
        assert!(drift.abs() < 1e-9, "step {step}: {drift:e}");
        largest = largest.max((simulation.sample().energy - start).abs() / weight);
    }
    assert!(largest > 0.1, "the energy itself has changed: {largest}");
}

#[test]
fn the_azimuth_counts_every_turn_for_any_row_spacing() {
    let azimuths = |every: u64| -> Vec<(u64, f64)> {
        let mut simulation = Simulation::new(Arc::new(preset("torque-free", &[])));
        let layout = CsvLayout::every(NonZeroU64::new(every).unwrap());
        let scenario = Arc::clone(simulation.scenario());
        let mut csv = CsvWriter::with_layout(Vec::new(), &scenario, layout).unwrap();
        stream::play(
            &mut simulation,
            4000,
            Some(&mut csv),
            |_| {},
            |_, _| ControlFlow::Continue(()),
        )
        .unwrap();
        let bytes = csv.finish().unwrap();
        let mut rows = csv::ReaderBuilder::new()
            .comment(Some(b'#'))
            .from_reader(bytes.as_slice());
        let rows = rows.records().map(Result::unwrap);
        rows.map(|row| (row[0].parse().unwrap(), row[12].parse().unwrap()))
            .collect()
    };
    let all = azimuths(1);
    let last = all.last().unwrap().1;
    assert!(last.abs() > 3.0 * 360.0, "several turns: {last}");
    for every in [7, 97, 1999] {
        let mut expected = all.clone();
        expected.retain(|(step, _)| step % every == 0 || *step == 4000);
        assert_eq!(azimuths(every), expected, "--every {every}");
    }
}
