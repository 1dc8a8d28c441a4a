//! The largest distance of a run's traced point from the exact motion, over every step.
//!
//! The exact motion with its last bit costs as much as a step. Nearly all steps need it less well: a distance that is known
//! within some rounding tells that it is not the largest. Only those that may be are kept, and computed to the last bit when
//! the largest is asked for. It is the same number as if all had been.

use super::trial::{Deviation, distance_near};
use crate::physics::State;
use crate::physics::exact::AT_ONCE;
use crate::run::Truth;
use nalgebra::Vector3;

/// What a distance that is known nearly may be off, as a part of the arm: more than ten times what it was found to be.
const OFF: f64 = 3e-14;
/// A run that is no farther off than so many of these is held to the last bit at once.
const WORTH_IT: f64 = 10.0;
/// So many steps are kept at most.
const KEPT: usize = 32;

/// The largest distance so far.
#[derive(Clone, Debug)]
pub(super) struct Farthest {
    /// What a distance that is known nearly may be off, m.
    off_m: f64,
    /// Of all steps but those in `kept`, m.
    most_m: f64,
    /// Of all steps, within [`OFF`].
    near_m: f64,
    /// The steps that may be farther off than `most_m`.
    kept: Vec<State>,
    /// The newest steps, which are looked at together.
    waiting: Vec<State>,
}

impl Farthest {
    /// Of a run whose traced point is so far from the pivot, m.
    pub fn new(arm_m: f64) -> Self {
        Self {
            off_m: OFF * arm_m,
            most_m: 0.0,
            near_m: 0.0,
            kept: Vec::new(),
            waiting: Vec::new(),
        }
    }

    /// Takes in a step of the run beside `truth`; whether all distances that were looked at are numbers.
    #[inline]
    pub fn follow(&mut self, state: &State, truth: &mut Truth) -> bool {
        self.waiting.push(*state);
        self.waiting.len() < AT_ONCE || self.look(truth)
    }

    /// The same of `states`, which follow one another, without keeping them all.
    pub fn follow_all(&mut self, states: &[State], truth: &mut Truth) -> bool {
        let first = match self.waiting.len() {
            0 => 0,
            waiting => states.len().min(AT_ONCE - waiting),
        };
        let (first, states) = states.split_at(first);
        let (together, last) = states.as_chunks();
        let mut are_numbers = true;
        for state in first {
            are_numbers &= self.follow(state, truth);
        }
        for states in together {
            are_numbers &= self.look_at_all(states, truth);
        }
        self.waiting.extend_from_slice(last);
        are_numbers
    }

    /// Looks at the steps that wait.
    fn look(&mut self, truth: &mut Truth) -> bool {
        let states = std::mem::take(&mut self.waiting);
        let mut are_numbers = true;
        match states.as_array() {
            Some(states) => are_numbers = self.look_at_all(states, truth),
            None => {
                for state in &states {
                    are_numbers &= self.look_at(state, None, truth);
                }
            }
        }
        self.waiting = states;
        self.waiting.clear();
        are_numbers
    }

    /// Looks at steps that follow one another.
    fn look_at_all(&mut self, states: &[State; AT_ONCE], truth: &mut Truth) -> bool {
        let is_worth_it = self.near_m > WORTH_IT * self.off_m;
        let near = is_worth_it.then(|| distances_near(states, truth)).flatten();
        let is_below = |near_m: &f64| *near_m < self.near_m - 2.0 * self.off_m;
        let mut are_numbers = true;
        if !near.is_some_and(|near| near.iter().all(is_below)) {
            for (place, state) in states.iter().enumerate() {
                let near_m = near.map(|near| near[place]);
                are_numbers &= self.look_at(state, near_m, truth);
            }
        }
        are_numbers
    }

    /// Looks at one step, the distance of which may be known nearly.
    fn look_at(&mut self, state: &State, near_m: Option<f64>, truth: &mut Truth) -> bool {
        if self.near_m > WORTH_IT * self.off_m
            && let Some(near_m) = near_m.or_else(|| distance_near(state, truth))
            && near_m.is_finite()
        {
            return near_m < self.near_m - 2.0 * self.off_m || self.keep(state, near_m, truth);
        }
        // The forces may change here: what is kept belongs to those before.
        let are_numbers = self.settle_kept(truth);
        self.take_in(Deviation::distance_of(state, truth)) && are_numbers
    }

    fn keep(&mut self, state: &State, near_m: f64, truth: &mut Truth) -> bool {
        if near_m > self.near_m + 2.0 * self.off_m {
            self.kept.clear(); // none of them is as far off
        }
        self.near_m = self.near_m.max(near_m);
        self.kept.push(*state);
        self.kept.len() < KEPT || self.settle_kept(truth)
    }

    /// Computes to the last bit what may be the largest; whether all of it is a number.
    pub fn settle(&mut self, truth: &mut Truth) -> bool {
        let are_numbers = self.look(truth);
        self.settle_kept(truth) && are_numbers
    }

    fn settle_kept(&mut self, truth: &mut Truth) -> bool {
        let kept = std::mem::take(&mut self.kept);
        let mut are_numbers = true;
        for state in &kept {
            are_numbers &= self.take_in(Deviation::distance_of(state, truth));
        }
        self.kept = kept;
        self.kept.clear();
        are_numbers
    }

    /// Takes in a distance, m; whether it is a number.
    pub fn take_in(&mut self, distance_m: f64) -> bool {
        if distance_m.is_finite() {
            self.most_m = self.most_m.max(distance_m);
            self.near_m = self.near_m.max(distance_m);
        }
        distance_m.is_finite()
    }

    /// The largest distance of all that has been settled, m.
    pub fn most_m(&self) -> f64 {
        self.most_m
    }
}

/// Distance of the traced point of each of `states`, which follow one another, from where it should be, within a few units
/// of rounding of the arm, m; `None` where that is not had in less time.
fn distances_near(states: &[State; AT_ONCE], truth: &Truth) -> Option<[f64; AT_ONCE]> {
    let scenario = truth.scenario();
    let at = &scenario.body.mechanics.points()[scenario.trace].at;
    let [x, y, z] = truth.traced_near(&states.each_ref().map(|state| state.time_s))?;
    Some(std::array::from_fn(|place| {
        let exact = Vector3::new(x[place], y[place], z[place]);
        (states[place].orientation * at - exact).norm()
    }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::Simulation;
    use crate::scenario::Document;
    use std::sync::Arc;

    #[test]
    fn it_is_the_largest_of_all_to_the_last_bit() {
        for (preset, sets) in [
            ("wobble-push", &["motion.steps=600"][..]),
            ("method-2-slow", &["motion.steps=1500"]),
            ("cusps", &["motion.steps=1500", "motion.time_step_s=0.02"]),
            ("cusps", &["motion.steps=600", "motion.scheme=exact"]),
            ("cusps", &["motion.steps=600", "motion.scheme=srkn11b"]),
            ("sleeping", &["motion.steps=600", "motion.scheme=report"]),
        ] {
            let mut document = Document::open(preset).unwrap();
            sets.iter().for_each(|set| document.set(set).unwrap());
            let scenario = Arc::new(document.scenario().unwrap());
            let mut simulation = Simulation::new(Arc::clone(&scenario));
            let truths = || Truth::new(Arc::clone(&scenario));
            let (mut every, mut some) = (truths(), truths());
            let (mut most_m, mut farthest) = (0.0_f64, Farthest::new(scenario.arm_m()));
            let (mut many, mut in_parts) = (truths(), Farthest::new(scenario.arm_m()));
            let (mut kept, mut states) = (0, Vec::new());
            for number in 1..=scenario.steps {
                let state = simulation.step().unwrap().after();
                most_m = most_m.max(Deviation::distance_of(state, &mut every));
                assert!(farthest.follow(state, &mut some));
                kept = kept.max(farthest.kept.len());
                states.push(*state);
                // In parts of 1 to 40 steps: some shorter than those looked at together, some several times as long.
                if states.len() as u64 > number % 41 {
                    assert!(in_parts.follow_all(&states, &mut many));
                    states.clear();
                }
                if number % 97 == 0 {
                    assert!(farthest.settle(&mut some));
                    assert_eq!(farthest.most_m().to_bits(), most_m.to_bits(), "{preset}");
                    assert!(in_parts.follow_all(&states, &mut many));
                    states.clear();
                    assert!(in_parts.settle(&mut many));
                    assert_eq!(in_parts.most_m().to_bits(), most_m.to_bits(), "{preset}");
                }
            }
            let is_worth_it = most_m > WORTH_IT * farthest.off_m;
            assert_eq!(kept > 0, is_worth_it, "{preset} {sets:?}");
        }
    }

    #[test]
    fn what_is_known_nearly_is_known_well_enough() {
        for preset in [
            "wobble-push",
            "cusps",
            "loops",
            "sleeping",
            "torque-free",
            "method-1",
        ] {
            let scenario = Arc::new(Document::open(preset).unwrap().scenario().unwrap());
            let mut truth = Truth::new(Arc::clone(&scenario));
            let mut most = 0.0_f64;
            for number in 0..20_000 {
                let time_s = 0.0137 * f64::from(number);
                let exact = truth.orientation_at(time_s);
                if let Some(near) = truth.orientation_near(time_s) {
                    most = most.max((exact - near).norm());
                }
            }
            assert!((0.0..0.1 * OFF).contains(&most), "{preset}: {most:e}");
        }
    }
}
