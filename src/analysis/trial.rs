//! A run played through beside the exact motion: how far it strays, and what of the constants of the motion it loses.

use crate::physics::State;
use crate::run::{NotFinite, Simulation, Step, Truth};
use crate::scenario::Scenario;
use nalgebra::Matrix3;
use std::ops::ControlFlow;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Number of steps of a trial, evenly spread, at which the energy is read off. The distance is read at every step.
const LOOKS: u64 = 1000;
/// Steps that are taken at once, without a look at the clock, the exact motion or the watcher.
const BLOCK: u64 = 4096;

/// Fewer steps than these tell little of what a step costs.
const TIMED: u64 = 1000;

/// How a run went beside the exact motion.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Trial {
    pub steps: u64,
    /// Largest distance of the traced point from where it should have been, m.
    pub most_distance_m: f64,
    /// The same at the end, m.
    pub end_distance_m: f64,
    /// Largest |(E − E0 − W)/S|; `None` where it means nothing.
    pub energy_drift: Option<f64>,
    /// Largest deviation of L·axle from the exact motion's, over |L| at the start (J s where that is 0).
    pub spin_drift: f64,
    /// Largest deviation of L_z, likewise.
    pub lz_drift: f64,
    /// Time spent on stepping alone.
    pub stepping: Duration,
    /// Time of a step where stepping went fastest, s: what other work on the machine has cost is not in it.
    pub fastest_s: f64,
    /// Where the numbers stopped being finite, if they did.
    pub broke: Option<NotFinite>,
}

/// How far a run is off at one moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Deviation {
    /// Distance of the traced point from where it should be, m.
    pub distance_m: f64,
    /// L·axle less the exact motion's, J s.
    pub spin: f64,
    /// L_z less the exact motion's, J s.
    pub lz: f64,
}

impl Deviation {
    /// Of a run that is `seen` so, from its `truth`.
    pub fn of(seen: &State, truth: &mut Truth) -> Self {
        let exact = truth.state_at(seen.time_s);
        Self {
            distance_m: distance_m(seen, &exact.orientation, truth.scenario()),
            spin: seen.momentum.dot(&seen.axle()) - exact.momentum.dot(&exact.axle()),
            lz: seen.momentum.z - exact.momentum.z,
        }
    }

    /// Its distance alone, m.
    #[inline]
    pub fn distance_of(seen: &State, truth: &mut Truth) -> f64 {
        let exact = truth.orientation_at(seen.time_s);
        distance_m(seen, &exact, truth.scenario())
    }
}

/// Distance of the traced point from where it is if the body stands as `exact`, m.
#[inline]
pub(super) fn distance_m(seen: &State, exact: &Matrix3<f64>, scenario: &Scenario) -> f64 {
    let at = &scenario.body.mechanics.points()[scenario.trace].at;
    ((seen.orientation - exact) * at).norm()
}

impl Trial {
    /// Plays `scenario` to its end. `watch` is asked from time to time, with the step, whether to go on; `None` where it
    /// said no.
    pub fn run(
        scenario: &Arc<Scenario>,
        mut watch: impl FnMut(u64) -> ControlFlow<()>,
    ) -> Option<Self> {
        let mut simulation = Simulation::new(Arc::clone(scenario));
        let mut truth = Truth::new(Arc::clone(scenario));
        let mut trial = Self {
            fastest_s: f64::INFINITY,
            ..Self::default()
        };
        let stride = stride(scenario.steps);
        let momentum = scenario.start.momentum.norm();
        let scale = if momentum > 0.0 { momentum } else { 1.0 };
        let mut states = Vec::new();
        let mut timed = (0, Duration::ZERO);
        while simulation.step_number() < scenario.steps && trial.broke.is_none() {
            let looks = simulation.step_number() / stride + 1;
            let next_look = scenario.steps.min(looks.saturating_mul(stride));
            let next = next_look.min(simulation.step_number() + BLOCK);
            states.clear();
            let begin = Instant::now();
            trial.broke = take_steps(&mut simulation, next, &mut states).err();
            timed = (timed.0 + states.len() as u64, timed.1 + begin.elapsed());
            if timed.0 >= TIMED {
                trial.time(timed);
                timed = (0, Duration::ZERO);
            }
            for state in &states {
                trial.hold(state, &mut truth, scale);
            }
            if next == next_look || trial.broke.is_some() {
                trial.read_off(simulation.now());
            }
            watch(simulation.step_number()).continue_value()?;
        }
        trial.steps = simulation.step_number();
        trial.time(timed);
        Some(trial)
    }

    /// Takes in the time of `steps` steps.
    fn time(&mut self, (steps, duration): (u64, Duration)) {
        self.stepping += duration;
        // What is left at the end may be too few.
        if steps >= TIMED || (steps > 0 && self.fastest_s.is_infinite()) {
            self.fastest_s = self.fastest_s.min(duration.as_secs_f64() / steps as f64);
        }
    }

    /// Holds one step of the run against the exact motion.
    fn hold(&mut self, state: &State, truth: &mut Truth, scale: f64) {
        let off = Deviation::of(state, truth);
        self.end_distance_m = off.distance_m;
        self.most_distance_m = greater(self.most_distance_m, off.distance_m);
        self.spin_drift = greater(self.spin_drift, (off.spin / scale).abs());
        self.lz_drift = greater(self.lz_drift, (off.lz / scale).abs());
    }

    fn read_off(&mut self, step: &Step) {
        let drift = step.energy_drift().map(f64::abs);
        self.energy_drift = drift.map(|drift| drift.max(self.energy_drift.unwrap_or(0.0)));
    }
}

/// Steps up to the step `end`, and keeps the states on the way.
fn take_steps(run: &mut Simulation, end: u64, states: &mut Vec<State>) -> Result<(), NotFinite> {
    while run.step_number() < end {
        states.push(*run.step()?.after());
    }
    Ok(())
}

/// The greater of two numbers; NaN, of a run that could not be followed, is kept.
fn greater(most: f64, now: f64) -> f64 {
    if most.is_nan() || now <= most {
        most
    } else {
        now
    }
}

/// Every how many steps to look; odd, so that an even rhythm of the run is not met always at the same beat.
fn stride(steps: u64) -> u64 {
    match steps / LOOKS {
        0 => 1,
        stride => stride | 1,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physics::exact::Kind;
    use crate::scenario::presets;

    #[test]
    fn the_distance_alone_is_that_of_the_whole_deviation_to_the_last_bit() {
        let pushed_aside = [
            "body.point.2={name='aside',at_m=[0.3,0,1.5],mass_kg=0}",
            "push.0={point='aside',force_N=[1,0,0],from_s=1,for_s=1}",
            "motion.time_step_s=0.01",
        ];
        for (preset, sets, kind) in [
            ("wobble-push", &[][..], Kind::Closed),
            ("cusps", &[], Kind::Closed),
            ("sleeping", &["motion.gravity_m_per_s2=-9.8"], Kind::Closed),
            ("method-2", &pushed_aside, Kind::Integrated),
        ] {
            let scenario = presets::scenario(preset, sets);
            let mut simulation = Simulation::new(Arc::clone(&scenario));
            let truths = || Truth::new(Arc::clone(&scenario));
            let (mut whole, mut alone) = (truths(), truths());
            let mut kinds = Vec::new();
            for _ in 0..400 {
                let state = simulation.step().unwrap().after();
                let deviation = Deviation::of(state, &mut whole);
                let distance_m = Deviation::distance_of(state, &mut alone);
                assert_eq!(distance_m.to_bits(), deviation.distance_m.to_bits());
                kinds.push(alone.kind());
            }
            assert!(kinds.contains(&kind), "{preset}");
        }
    }
}
