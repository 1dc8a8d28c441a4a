//! A run is its scenario and its journal. After any actions in any order, the saved run file replays the run bit for bit,
//! and seeking back and forth gives the same numbers.

use crate::support::desk::{Desk, commands};
use crate::support::scenarios::preset;
use gyrolab::engine::recording::RecordedCurve;
use gyrolab::engine::run::Simulation;
use gyrolab::engine::scenario::Scenario;
use gyrolab::lab::playback::live::LiveRun;
use gyrolab::lab::{Player, SeekPurpose};
use gyrolab::physics::scheme;
use proptest::prelude::*;
use std::collections::HashMap;
use std::sync::Arc;
use std::time::Duration;

/// Possible actions of a user.
const DEEDS: &[&str] = &[
    "run = true",
    "pause = true",
    "step = 1",
    "step = 7",
    "step = 300",
    "step = -1",
    "step = -9",
    "step = -40",
    "go_to = 55",
    "go_to = 'start'",
    "push = true",
    "push = { force_N = [3, -50, 0.1], for_s = 0.7 }",
    "undo = 1",
    "undo = 2",
    "redo = 1",
    "exact = true",
    "exact = false",
    "nudge = { key = 'motion.time_step_s', times = 1 }",
    "nudge = { key = 'motion.time_step_s', times = -1 }",
    "nudge = { key = 'motion.gravity_m_per_s2', times = 10 }",
    "nudge = { key = 'motion.scheme', times = 1 }",
    "nudge = { key = 'start.tilt_deg', times = -1 }",
    "nudge = { key = 'push.0.force_N.2', times = 3 }",
    "set = { 'motion.time_step_s' = 0.05, 'motion.gravity_m_per_s2' = 7 }",
    "set = { 'start.tilt_deg' = 20, 'motion.scheme' = 'strang' }",
    "next_push = { force_N = 20, toward = 'out' }",
    "next_push = { for_s = 0.3 }",
];

/// Returns the bits of every number of the current step.
fn bits(simulation: &Simulation) -> Vec<u64> {
    let (state, sample) = (simulation.state(), simulation.sample());
    let numbers = state.orientation.iter().chain(state.momentum.iter());
    let rest = [
        state.time_s,
        sample.azimuth_deg,
        sample.energy,
        simulation.now().energy_drift().unwrap_or(0.0),
    ];
    let numbers = numbers.copied().chain(rest);
    let mut bits: Vec<_> = numbers.map(f64::to_bits).collect();
    bits.push(sample.segment);
    bits
}

fn replayed(scenario: Scenario, step: u64) -> Vec<u64> {
    let mut simulation = Simulation::new(Arc::new(scenario));
    let _ = simulation.step_to(step); // a run that ends stays at its last step, like in the lab
    bits(&simulation)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    #[test]
    fn run_files_replay_any_actions_bit_for_bit(
        preset in prop::sample::select(vec!["method-2", "wobble-push", "wobble-push-accumulating", "cusps", "falling"]),
        scheme in prop::sample::select(scheme::names().to_vec()),
        deeds in prop::collection::vec(0..DEEDS.len(), 1..40),
    ) {
        let folder = tempfile::tempdir().unwrap();
        let mut desk = Desk::open(preset);
        desk.lab.files_mut().work_in(folder.path());
        desk.commands(&format!("set = {{ 'motion.scheme' = '{scheme}' }}"));
        for deed in deeds {
            for command in commands(DEEDS[deed]) {
                let _ = desk.carry_out(&command); // impossible actions are skipped
            }
        }
        let here = bits(desk.simulation());
        let step = desk.simulation().step_number();
        let whole = desk.scenario();
        prop_assert_eq!(&replayed(whole, step), &here, "the run as it stands, at step {}", step);
        if let Some(saved) = desk.saved(folder.path()) {
            prop_assert_eq!(saved.steps, step);
            prop_assert_eq!(&replayed(saved, step), &here, "the saved run file, at step {}", step);
        }
    }

    #[test]
    fn seeking_back_and_forth_gives_the_same_numbers(
        preset in prop::sample::select(vec!["method-2", "wobble-push", "wobble-push-accumulating", "loops"]),
        scheme in prop::sample::select(scheme::names().to_vec()),
        way in prop::collection::vec(0u64..3000, 2..30),
        edits in prop::collection::vec((0u64..2000, 0usize..3), 0..4),
    ) {
        let folder = tempfile::tempdir().unwrap();
        let mut desk = Desk::open(preset);
        desk.lab.files_mut().work_in(folder.path());
        let mut edits = edits;
        edits.sort_unstable();
        for (step, edit) in edits {
            desk.commands(&format!("go_to = {step}"));
            desk.commands(match edit {
                0 => "push = true",
                1 => "nudge = { key = 'motion.gravity_m_per_s2', times = 1 }",
                _ => "nudge = { key = 'motion.time_step_s', times = -1 }",
            });
        }
        desk.commands("go_to = 'start'");
        desk.commands(&format!("set = {{ 'motion.scheme' = '{scheme}' }}"));
        let mut seen: HashMap<u64, Vec<u64>> = HashMap::new();
        for step in way {
            desk.commands(&format!("go_to = {step}"));
            let simulation = desk.simulation();
            let reached = simulation.step_number();
            let here = bits(simulation);
            let health = desk.lab.player().reading.readouts.health;
            prop_assert!(health.energy_drift.is_none_or(|drift| !drift.is_nan()));
            prop_assert_eq!(seen.entry(reached).or_insert_with(|| here.clone()), &here, "step {}", reached);
            let (recording, path) = (desk.lab.player().run().recording(), desk.lab.player().run().path());
            prop_assert_eq!(recording.samples(), reached + 1);
            prop_assert_eq!(recording.coarse_since(), None);
            let mut straight = LiveRun::new(Arc::clone(desk.lab.player().run().scenario()));
            let _ = straight.step_to(reached, || false);
            let (whole, known) = (recording.whole().unwrap(), straight.recording().whole().unwrap());
            for curve in RecordedCurve::ALL {
                prop_assert_eq!(whole.extent(curve), known.extent(curve), "{:?} at step {}", curve, reached);
            }
            let [radius, straight_radius] = [path, straight.path()].map(|path| path.radius);
            let off = (radius - straight_radius).abs();
            prop_assert!(off <= 0.02 * straight_radius + 1e-9, "{} for {}", radius, straight_radius);
        }
        for (step, there) in seen {
            prop_assert_eq!(replayed(desk.scenario(), step), there, "step {}", step);
        }
    }
}

#[test]
fn a_run_that_broke_down_continues_after_a_fix() {
    let folder = tempfile::tempdir().unwrap();
    let mut desk = Desk::open("method-2");
    desk.lab.files_mut().work_in(folder.path());
    desk.commands("go_to = 40\nset = { 'motion.scheme' = 'rk4' }\ngo_to = 2000");
    let ended_at = desk.simulation().step_number();
    assert!((41..2000).contains(&ended_at), "{ended_at}");
    assert!(desk.simulation().has_ended());
    desk.commands("go_to = 40\nset = { 'motion.time_step_s' = 0.001 }\nstep = 50");
    assert_eq!(desk.step(), 90, "an edit before the breakdown fixes it");
    desk.commands(&format!("undo = 1\ngo_to = {}", ended_at + 9));
    assert_eq!(
        desk.step(),
        ended_at,
        "without the edit, the run breaks down again"
    );
}

#[test]
fn undoing_an_edit_that_breaks_the_run_restores_it_exactly() {
    let folder = tempfile::tempdir().unwrap();
    let mut desk = Desk::open("wobble-push");
    desk.lab.files_mut().work_in(folder.path());
    desk.commands("go_to = 60\nset = { 'motion.time_step_s' = 1e300 }\nstep = 1");
    assert!(desk.simulation().has_ended());
    assert_eq!(desk.simulation().step_number(), 60);
    desk.commands("undo = 1\nstep = 300");
    assert_eq!(desk.simulation().step_number(), 360);
    let untouched = preset("wobble-push", &[]);
    assert_eq!(replayed(untouched, 360), bits(desk.simulation()));
}

#[test]
fn traces_of_a_long_run_are_complete_and_fine_after_every_seek() {
    let motion = ["motion.time_step_s=0.001", "motion.steps=400000"];
    let set = [&motion[..], &["push.0.steps=150000"]].concat();
    let scenario = Arc::new(preset("wobble-push", &set));
    let mut player = Player::new(Arc::clone(&scenario), false);
    player.step_to(400_000, Duration::MAX).unwrap();
    for step in [
        399_990, 200_000, 199_999, 350_123, 17, 60_000, 400_000, 150_001,
    ] {
        player.seek(step, SeekPurpose::Command);
        assert_eq!(player.step_number(), step);
        assert_eq!(player.steps_to_go(), None);
        let now_s = player.run().now().time_s;
        for share in [0.003, 0.05, 0.6, 1.0] {
            let since_s = now_s * (1.0 - share);
            let blocks: Vec<_> = player.run().recording().since(since_s).collect();
            let steps = |a: f64, b: f64| ((b - a) / 0.001).round();
            assert!(blocks[0].begin_s <= since_s + 0.001);
            assert_eq!(steps(blocks[blocks.len() - 1].end_s, now_s), 0.0);
            for pair in blocks.windows(2) {
                let apart = steps(pair[0].end_s, pair[1].begin_s);
                assert_eq!(apart, 1.0, "step {step}");
            }
            let fine = (share * step as f64).min(256.0) * 0.9;
            let count = blocks.len() as f64;
            assert!(count >= fine, "{count} for {share} at step {step}");
        }
        let mut straight = Simulation::new(Arc::clone(&scenario));
        straight.step_to(step).unwrap();
        assert_eq!(bits(player.run().simulation()), bits(&straight));
    }
}
