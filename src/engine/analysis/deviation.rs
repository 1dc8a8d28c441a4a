//! How far a run strays from the exact motion beside it, over every step, and how the tilts of both swing.
//!
//! The exact motion to the last bit costs as much as a step. Eight steps together are looked at within rounding, for a quarter
//! of that; the farthest of all is computed to the last bit when it is asked for.

use super::cost::{has_closed_form, is_affordable};
use super::predictability::{Companion, Predictability};
use super::swings::{SwingComparison, Swings, height};
use crate::physics::State;
use crate::physics::exact::AT_ONCE;
use crate::run::Truth;
use crate::scenario::Scenario;
use nalgebra::{Matrix3, Vector3};
use std::ops::ControlFlow;
use std::sync::Arc;

/// The exact motion beside one run, and how far the run has been off it.
#[derive(Clone, Debug)]
pub struct ExactReference {
    /// `None` where it would take too long, or has left the range of numbers.
    truth: Option<Truth>,
    /// Made when the first steps are looked at: of a run that is never compared it is never needed.
    companion: Option<Companion>,
    /// The newest steps, which are looked at together, and how many these are: only a closed form is had faster for several.
    waiting: Vec<State>,
    together: usize,
    /// The step that is farthest off so far, where its distance is known within rounding alone.
    farthest: Option<State>,
    /// The distance of the farthest step, m.
    most_m: f64,
    swings: Swings,
}

impl ExactReference {
    /// The exact motion beside the run of `scenario`, which stands at its start.
    pub fn new(scenario: &Arc<Scenario>) -> Self {
        let truth = is_affordable(scenario).then(|| Truth::new(Arc::clone(scenario)));
        Self {
            truth,
            companion: None,
            waiting: Vec::new(),
            together: looked_at_together(scenario),
            farthest: None,
            most_m: 0.0,
            swings: Swings::new(&scenario.start),
        }
    }

    /// Goes on beside a run of `scenario`, whose past is the same.
    pub fn branch(&mut self, scenario: &Arc<Scenario>) {
        self.settle(); // its steps so far belong to the forces so far
        self.together = looked_at_together(scenario);
        match &mut self.truth {
            Some(truth) => truth.branch(scenario),
            None => {
                self.truth = Some(Truth::new(Arc::clone(scenario)));
                self.companion = None;
            }
        }
        if let Some(companion) = &mut self.companion {
            companion.branch(scenario);
        }
        self.truth.take_if(|_| !is_affordable(scenario));
    }

    /// Whether the run is compared with the exact motion.
    fn is_known(&self) -> bool {
        self.truth.is_some()
    }

    /// Returns how many exact motions go on beside the run: that, and its companion.
    pub fn motions(&self) -> u32 {
        match &self.truth {
            Some(_) if !self.has_parted() => 2,
            _ => 0,
        }
    }

    /// The exact motion, where the run is compared with it.
    pub fn truth(&mut self) -> Option<&mut Truth> {
        self.settle();
        self.truth.as_mut()
    }

    /// Compares the next `state` of the run with the exact motion.
    #[inline]
    pub fn hold(&mut self, state: &State) {
        self.wait(state);
        if self.waiting.len() >= self.together {
            self.look();
        }
    }

    /// The same, at the latest when the run is [settled](Self::settle).
    #[inline]
    pub fn wait(&mut self, state: &State) {
        if self.is_known() && !self.has_parted() {
            self.waiting.push(*state);
        }
    }

    /// Looks at the steps that wait.
    fn look(&mut self) {
        let _ = self.look_while(&mut || ControlFlow::Continue(()));
    }

    /// Looks at the steps that wait as long as `go_on` says so; it is asked after a few of them. Those that are left then
    /// are never looked at.
    fn look_while(&mut self, go_on: &mut dyn FnMut() -> ControlFlow<()>) -> ControlFlow<()> {
        let mut states = std::mem::take(&mut self.waiting);
        for together in states.chunks(self.together) {
            self.look_at(together);
            go_on()?;
        }
        states.clear();
        self.waiting = states;
        ControlFlow::Continue(())
    }

    fn look_at(&mut self, states: &[State]) {
        let near = self
            .truth
            .as_ref()
            .zip(states.as_array())
            .and_then(|(truth, run)| Some((run, near_exact(run, truth)?)));
        if let Some((run, (distances_m, heights))) = near
            && self.is_predictable_at(run[AT_ONCE - 1].time_s)
        {
            self.swings.record(run, &heights);
            for (state, distance_m) in run.iter().zip(distances_m) {
                if distance_m > self.most_m {
                    (self.farthest, self.most_m) = (Some(*state), distance_m);
                }
            }
        } else {
            for state in states {
                self.settle_farthest(); // the forces may change here, and it stood under those before
                if !self.is_predictable_at(state.time_s) {
                    break;
                }
                let Some(truth) = &mut self.truth else {
                    break;
                };
                let exact = truth.orientation_at(state.time_s);
                self.swings.record(&[*state], &[height(exact.m33)]);
                let off_m = distance_m(state, &exact, truth.scenario());
                self.take_in(off_m);
            }
        }
    }

    /// Whether the exact motion can be predicted up to `time_s`, which is not before the last such question. Of what comes
    /// later no step is judged.
    #[inline]
    fn is_predictable_at(&mut self, time_s: f64) -> bool {
        let Some(truth) = &mut self.truth else {
            return true;
        };
        let companion = self
            .companion
            .get_or_insert_with(|| Companion::new(truth.scenario()));
        companion.look_until(truth, time_s);
        companion.until_s().is_none_or(|until_s| time_s <= until_s)
    }

    /// Whether the exact motion could be predicted no longer at a step that was [looked at](Self::settle).
    fn has_parted(&self) -> bool {
        let companion = self.companion.as_ref();
        companion.is_some_and(|companion| companion.until_s().is_some())
    }

    /// Returns how far the exact motion can be predicted, as found up to the last time that the run was
    /// [settled](Self::settle).
    pub fn predictability(&self) -> Predictability {
        let companion = self.companion.as_ref().filter(|_| self.is_known());
        companion.map_or_else(Predictability::default, Companion::found)
    }

    /// Looks at all steps so far, and computes the largest distance to the last bit.
    pub fn settle(&mut self) {
        self.look();
        self.settle_farthest();
    }

    /// As [`settle`](Self::settle), as long as `go_on` says so: each step may take long. A run that was left in between is
    /// compared no further.
    pub fn settle_while(&mut self, go_on: &mut dyn FnMut() -> ControlFlow<()>) -> ControlFlow<()> {
        self.look_while(go_on)?;
        self.settle_farthest();
        ControlFlow::Continue(())
    }

    fn settle_farthest(&mut self) {
        if let (Some(state), Some(truth)) = (self.farthest.take(), &mut self.truth) {
            self.most_m = 0.0; // it was known within rounding
            let distance_m = Deviation::distance_of(&state, truth);
            self.take_in(distance_m);
        }
    }

    /// Takes in a distance, m, known to the last bit. One that is no number ends the comparison: the exact motion has left the
    /// range of numbers, and does not come back.
    fn take_in(&mut self, distance_m: f64) {
        if !distance_m.is_finite() {
            self.truth = None;
        } else if distance_m > self.most_m {
            (self.farthest, self.most_m) = (None, distance_m);
        }
    }

    /// How far off the run is in `state`; `None` where it is not compared with the exact motion, or that can be predicted
    /// no longer.
    pub fn deviation(&mut self, state: &State) -> Option<Deviation> {
        self.settle();
        if self.has_parted() {
            return None;
        }
        let deviation = Deviation::between(state, self.truth.as_mut()?);
        self.take_in(deviation.distance_m);
        self.truth.as_ref().map(|_| deviation)
    }

    /// Returns the state of the exact motion at `time_s`, s; `None` where the run is not compared with it, or it can no longer
    /// be predicted.
    pub fn exact_state(&mut self, time_s: f64) -> Option<State> {
        self.settle();
        if self.has_parted() {
            return None;
        }
        let state = self.truth.as_mut()?.state_at(time_s);
        state.is_finite().then_some(state)
    }

    /// The largest distance of the traced point from the exact motion up to the last time that it was [settled](Self::settle),
    /// m, while that could be predicted; `None` where it is not compared.
    pub fn most_distance_m(&self) -> Option<f64> {
        self.truth.as_ref().map(|_| self.most_m)
    }

    /// How the tilt has swung up to then beside the exact motion's, where they differ most; `None` where it is not held
    /// against that.
    pub fn swing(&self) -> Option<SwingComparison> {
        self.truth.as_ref().and_then(|_| self.swings.worst())
    }
}

fn looked_at_together(scenario: &Scenario) -> usize {
    if has_closed_form(scenario) {
        AT_ONCE
    } else {
        1
    }
}

/// Distance of the traced point of each of `states`, which follow one another, from where it should be, within a few units
/// of rounding of the arm, m, and the [height] of the exact motion's axle; `None` where that is not had in less time, or is
/// no number.
fn near_exact(
    states: &[State; AT_ONCE],
    truth: &Truth,
) -> Option<([f64; AT_ONCE], [f64; AT_ONCE])> {
    let scenario = truth.scenario();
    let at = &scenario.body.mechanics.points()[scenario.trace].at;
    let times_s = states.each_ref().map(|state| state.time_s);
    let [x, y, z] = truth.positions_near(at, &times_s)?;
    let distances_m: [f64; AT_ONCE] = std::array::from_fn(|place| {
        let exact = Vector3::new(x[place], y[place], z[place]);
        (states[place].orientation * at - exact).norm()
    });
    // Mostly the traced point is one of the axle.
    let cosines = if at.x == 0.0 && at.y == 0.0 && at.z != 0.0 {
        z.map(|z| z / at.z)
    } else {
        truth.positions_near(&Vector3::z(), &times_s)?[2]
    };
    let are_numbers = distances_m.iter().all(|m| m.is_finite());
    are_numbers.then(|| (distances_m, cosines.map(height)))
}

/// How far a run is off at one moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Deviation {
    /// Distance of the traced point from where it should be, m.
    pub distance_m: f64,
    /// L·axle less the exact motion's, J s.
    pub axle_momentum: f64,
    /// L_z less the exact motion's, J s.
    pub lz: f64,
}

impl Deviation {
    /// Of a run that is `seen` so, from its `truth`.
    pub fn between(seen: &State, truth: &mut Truth) -> Self {
        let exact = truth.state_at(seen.time_s);
        Self {
            distance_m: distance_m(seen, &exact.orientation, truth.scenario()),
            axle_momentum: seen.momentum.dot(&seen.axle()) - exact.momentum.dot(&exact.axle()),
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
fn distance_m(seen: &State, exact: &Matrix3<f64>, scenario: &Scenario) -> f64 {
    let at = &scenario.body.mechanics.points()[scenario.trace].at;
    ((seen.orientation - exact) * at).norm()
}
