//! Prints a table: the time to play a run ahead like `--at`, compared with its bare steps; the time to seek an earlier step;
//! and the memory of the run.
//!
//! `cargo bench --bench time_travel`; `-- 1000000` limits it to a run of that many steps.

#![allow(clippy::unwrap_used)]

use gyrolab::engine::run::Simulation;
use gyrolab::engine::scenario::{Document, Scenario};
use gyrolab::lab::{Player, SeekPurpose};
use std::hint::black_box;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Shares of the run to seek, one after the other: far back, slightly back, forward, and near the end.
const SHARES: [f64; 7] = [0.5, 0.499, 0.93, 0.07, 0.999, 1.0, 0.0];

/// Number of measurements of playing ahead, alternating with the bare steps; the minimum counts.
const ROUNDS: usize = 3;

fn main() {
    let asked = std::env::args()
        .skip(1)
        .find_map(|argument| argument.parse().ok());
    let lengths = asked.map_or(vec![1_000_000, 10_000_000], |steps| vec![steps]);
    println!(
        "{:<12} {:>9} {:<9} {:>9} {:>9} {:>6} {:>9} {:>9} {:>9}",
        "steps", "points", "scheme", "play s", "bare s", "ratio", "worst s", "back one", "MB"
    );
    for steps in lengths {
        for (points, scheme) in [
            (10, "report"),
            (96, "report"),
            (10, "srkn11b"),
            (10, "exact"),
        ] {
            travel(steps, points, scheme);
        }
    }
}

fn read_scenario(points: u64, scheme: &str, steps: u64) -> Arc<Scenario> {
    let mut document = Document::open("method-2").unwrap();
    for set in [
        format!("body.rim.points={points}"),
        format!("motion.scheme={scheme}"),
        format!("motion.steps={steps}"),
        "motion.time_step_s=0.001".to_owned(),
    ] {
        document.set(&set).unwrap();
    }
    Arc::new(document.scenario().unwrap())
}

fn travel(steps: u64, points: u64, scheme: &str) {
    let scenario = read_scenario(points, scheme, steps);
    let seconds = |player: &mut Player, step: u64| {
        let begin = Instant::now();
        player.seek(step, SeekPurpose::Command);
        assert_eq!(player.step_number(), step);
        begin.elapsed().as_secs_f64()
    };
    let mut player = Player::new(Arc::clone(&scenario), false);
    let (mut play, mut bare) = (f64::INFINITY, f64::INFINITY);
    for _ in 0..ROUNDS {
        let begin = Instant::now();
        player = Player::new(Arc::clone(&scenario), false);
        player.step_to(steps, Duration::MAX).unwrap();
        play = play.min(begin.elapsed().as_secs_f64());
        let bare_begin = Instant::now();
        black_box(Simulation::new(Arc::clone(&scenario)))
            .step_to(steps)
            .unwrap();
        bare = bare.min(bare_begin.elapsed().as_secs_f64());
    }
    let mut worst: f64 = 0.0;
    for share in SHARES {
        let step = (share * steps as f64) as u64;
        worst = worst.max(seconds(&mut player, step));
    }
    player.seek(steps / 3, SeekPurpose::Command);
    let back = (1..100)
        .map(|back| seconds(&mut player, steps / 3 - back))
        .fold(0.0, f64::max);
    println!(
        "{steps:<12} {points:>9} {scheme:<9} {play:>9.3} {bare:>9.3} {:>6.2} {worst:>9.4} {back:>9.4} {:>9.1}",
        play / bare,
        resident_mb()
    );
}

/// Returns the current memory of this process, MB, or 0 if the system does not report it.
fn resident_mb() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"));
    line.and_then(|line| line.trim().trim_end_matches(" kB").parse().ok())
        .map_or(0.0, |kb: f64| kb / 1024.0)
}
