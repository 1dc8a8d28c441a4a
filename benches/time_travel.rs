//! How long it takes to play a run ahead, as `--at` does, beside the bare steps of the same run; to go to a step
//! where it has been before; and how much memory the run takes: prints a table. Below it, what has to be done for a step:
//! one thread steps, the other measures, adds to the pictures and holds the step against the exact motion.
//!
//! `cargo bench --bench time_travel`, with `-- 1000000` for a run of that many steps alone, or with `-- threads` for what
//! has to be done for a step alone.
//!
//! Of a run of 14 points by the report's scheme (Zen 4, baseline x86-64, ns a step, each the least of many short rounds):
//! bare step 67; stepping and handing over 75; measuring and pictures 46, the exact motion 31, together 77. So on two cores
//! playing ahead could come to 1.15 of the bare steps. It comes to 1.27 to 1.36 (10^7 steps, five runs by turns with the
//! program before, which had 1.28 to 1.44): there each thread also waits for memory that the other has just written.
//!
//! A session that is resumed plays its run ahead until a key is pressed: in the program it takes 0.91 to 1.18 s from the
//! command to the picture of step 10^7 (1.04 in the middle of eight; played in parts of 40 ms, by turns with it, 1.10). Of
//! the steps themselves 12 ns each are the handing over: without it they take 0.73 s.
//!
//! Tried, and no faster: a third thread for the exact motion, where two cores have to share three threads; batches of 512
//! to 16384 steps; steps that are gathered in a small memory first; batches that are kept for the next part. Of no use
//! either: to leave out steps that cannot be the farthest from the exact motion, because neither the run nor that motion is
//! fast enough. Both move much farther in a step than they are apart.

#![allow(clippy::unwrap_used)]

use gyrolab::analysis::{Beside, Gauges};
use gyrolab::observe::path::Path;
use gyrolab::observe::playback::Playback;
use gyrolab::observe::recording::{Moment, Recording};
use gyrolab::run::{Batch, Simulation};
use gyrolab::scenario::{Document, Scenario};
use std::hint::black_box;
use std::sync::Arc;
use std::time::Instant;

/// Shares of the run to go to, one after the other: far back, a little back, forward, and near the end.
const SHARES: [f64; 7] = [0.5, 0.499, 0.93, 0.07, 0.999, 1.0, 0.0];

/// What is played ahead is measured so often, by turns with the bare steps; the least counts.
const ROUNDS: usize = 3;

/// So many steps are measured together for what has to be done for one, so often.
const STRETCH: u64 = 20_000;
const STRETCHES: usize = 200;
/// So many steps are handed over together here, as where a run is played ahead to a near step.
const TOGETHER: usize = 1024;

fn main() {
    if std::env::args().any(|argument| argument == "threads") {
        return report_threads();
    }
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
    report_threads();
}

fn scenario(points: u64, scheme: &str, steps: u64) -> Arc<Scenario> {
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
    let scenario = scenario(points, scheme, steps);
    let seconds = |playback: &mut Playback, step: u64| {
        let begin = Instant::now();
        playback.go_to(step);
        assert_eq!(playback.step_number(), step);
        playback.read();
        begin.elapsed().as_secs_f64()
    };
    let mut playback = Playback::new(Arc::clone(&scenario), false);
    let (mut play, mut bare) = (f64::INFINITY, f64::INFINITY);
    for _ in 0..ROUNDS {
        let begin = Instant::now();
        playback = Playback::new(Arc::clone(&scenario), false);
        playback.begin_at(steps).unwrap();
        play = play.min(begin.elapsed().as_secs_f64());
        let begin = Instant::now();
        black_box(Simulation::new(Arc::clone(&scenario)))
            .step_to(steps)
            .unwrap();
        bare = bare.min(begin.elapsed().as_secs_f64());
    }
    let mut worst: f64 = 0.0;
    for share in SHARES {
        let step = (share * steps as f64) as u64;
        worst = worst.max(seconds(&mut playback, step));
    }
    playback.go_to(steps / 3);
    let back = (1..100)
        .map(|back| seconds(&mut playback, steps / 3 - back))
        .fold(0.0, f64::max);
    println!(
        "{steps:<12} {points:>9} {scheme:<9} {play:>9.3} {bare:>9.3} {:>6.2} {worst:>9.4} {back:>9.4} {:>9.1}",
        play / bare,
        resident_mb()
    );
}

/// What has to be done for a step of a long run, each part alone on one core.
fn report_threads() {
    println!(
        "ns a step: {:>9} {:<9} {:>6} {:>9} {:>9} {:>9}",
        "points", "scheme", "bare", "stepping", "pictures", "beside"
    );
    for (points, scheme) in [(10, "report"), (96, "report"), (10, "srkn11b")] {
        let [bare, stepping, pictures, beside] = of_threads(points, scheme);
        println!(
            "           {points:>9} {scheme:<9} {bare:>6.1} {stepping:>9.1} {pictures:>9.1} {beside:>9.1}"
        );
    }
}

fn of_threads(points: u64, scheme: &str) -> [f64; 4] {
    let scenario = scenario(points, scheme, 10_000_000);
    let mut simulation = Simulation::new(Arc::clone(&scenario));
    let mut gauges = Gauges::new(simulation.now());
    let mut beside = Beside::new(&scenario);
    let mut recording = Recording::default();
    let mut path = Path::new(scenario.arm_m());
    let mut bare = simulation.clone();
    let mut least = [f64::INFINITY; 4];
    let timed = |least: &mut f64, work: &mut dyn FnMut()| {
        let begin = Instant::now();
        work();
        *least = least.min(begin.elapsed().as_nanos() as f64 / STRETCH as f64);
    };
    let mut batches = vec![Batch::with_capacity(TOGETHER)];
    for _ in 0..STRETCHES {
        let to = bare.step_number() + STRETCH;
        timed(&mut least[0], &mut || bare.step_to(to).unwrap());
        timed(&mut least[1], &mut || {
            let (mut batch, mut given) = (0, 0);
            batches.iter_mut().for_each(Batch::clear);
            while simulation.step_number() < to {
                let step = simulation.step().unwrap();
                if given == TOGETHER || !batches[batch].push(step) {
                    (batch, given) = (batch + 1, 0);
                    if batch == batches.len() {
                        batches.push(Batch::with_capacity(TOGETHER));
                    }
                    batches[batch].push(step);
                }
                given += 1;
            }
        });
        timed(&mut least[2], &mut || {
            for batch in &batches {
                batch.each(|step| {
                    gauges.follow(step);
                    let moment = Moment {
                        time_s: step.time_s(),
                        position: *step.position(),
                        axle_height: step.after().axle().z,
                    };
                    recording.push(&moment);
                    path.follow(step.number(), &moment.position);
                });
            }
        });
        timed(&mut least[3], &mut || {
            let states = batches.iter().map(Batch::states);
            states.for_each(|states| beside.hold_all(states));
        });
    }
    least
}

/// The memory of this process now, MB; 0 where the system does not say.
fn resident_mb() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"));
    line.and_then(|line| line.trim().trim_end_matches(" kB").parse().ok())
        .map_or(0.0, |kb: f64| kb / 1024.0)
}
