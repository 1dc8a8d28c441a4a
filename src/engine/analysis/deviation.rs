//! Distance of a run from the exact motion at every step, and a comparison of how the tilts of both swing.
//!
//! The exact motion to the last bit costs as much as a step. So eight steps at a time are compared to within rounding,
//! at a quarter of that cost. The largest distance is computed to the last bit when it is needed.

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

/// The exact motion that accompanies one run, and the run's largest distance from it.
#[derive(Clone, Debug)]
pub struct ExactReference {
    /// `None` if computing it would take too long, or it has left the range of numbers.
    truth: Option<Truth>,
    /// Created at the first comparison. A run that is never compared does not need it.
    companion: Option<Companion>,
    /// The newest steps, which have not been compared yet.
    waiting: Vec<State>,
    /// Number of steps compared together. It is 1 without a closed form, because comparing several at once saves
    /// nothing then.
    together: usize,
    /// The farthest step so far, if its distance is known only to within rounding.
    farthest: Option<State>,
    /// Distance of the farthest step, m.
    most_m: f64,
    swings: Swings,
}

impl ExactReference {
    /// Creates the exact motion for the run of `scenario`, which is at its start.
    pub fn new(scenario: &Arc<Scenario>) -> Self {
        let truth = is_affordable(scenario).then(|| Truth::new(Arc::clone(scenario)));
        Self {
            truth,
            companion: None,
            waiting: Vec::new(),
            together: steps_at_once(scenario),
            farthest: None,
            most_m: 0.0,
            swings: Swings::new(&scenario.start),
        }
    }

    /// Continues with the run of `scenario`, which has the same past.
    pub fn branch(&mut self, scenario: &Arc<Scenario>) {
        self.settle(); // the steps so far belong to the old forces
        self.together = steps_at_once(scenario);
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

    /// Returns true if the run is compared with the exact motion.
    fn is_known(&self) -> bool {
        self.truth.is_some()
    }

    /// Returns the number of exact motions that accompany the run: two with the companion, or none.
    pub fn motions(&self) -> u32 {
        match &self.truth {
            Some(_) if !self.has_separated() => 2,
            _ => 0,
        }
    }

    /// Returns the exact motion, if the run is compared with it.
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

    /// Compares `state` later, at the latest when the run is [settled](Self::settle).
    #[inline]
    pub fn wait(&mut self, state: &State) {
        if self.is_known() && !self.has_separated() {
            self.waiting.push(*state);
        }
    }

    /// Compares the waiting steps.
    fn look(&mut self) {
        let _ = self.compare_waiting_while(&mut || ControlFlow::Continue(()));
    }

    /// Compares the waiting steps while `go_on`, which is called after every few steps, returns `Continue`. The steps
    /// that remain after a break are never compared.
    fn compare_waiting_while(
        &mut self,
        go_on: &mut dyn FnMut() -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let mut states = std::mem::take(&mut self.waiting);
        for together in states.chunks(self.together) {
            self.compare_steps(together);
            go_on()?;
        }
        states.clear();
        self.waiting = states;
        ControlFlow::Continue(())
    }

    fn compare_steps(&mut self, states: &[State]) {
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
                self.settle_farthest(); // the forces may change here; the farthest step is from before
                if !self.is_predictable_at(state.time_s) {
                    break;
                }
                let Some(truth) = &mut self.truth else {
                    break;
                };
                let exact = truth.orientation_at(state.time_s);
                self.swings.record(&[*state], &[height(exact.m33)]);
                let off_m = distance_m(state, &exact, truth.scenario());
                self.record_distance(off_m);
            }
        }
    }

    /// Returns true if the exact motion can be predicted up to `time_s`, which must not decrease from call to call.
    /// Later steps are not judged.
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

    /// Returns true if a step that was [compared](Self::settle) came after the motion had become unpredictable.
    fn has_separated(&self) -> bool {
        let companion = self.companion.as_ref();
        companion.is_some_and(|companion| companion.until_s().is_some())
    }

    /// Returns how far the exact motion can be predicted, as found when the run was last [settled](Self::settle).
    pub fn predictability(&self) -> Predictability {
        let companion = self.companion.as_ref().filter(|_| self.is_known());
        companion.map_or_else(Predictability::default, Companion::found)
    }

    /// Compares all steps so far, and computes the largest distance to the last bit.
    pub fn settle(&mut self) {
        self.look();
        self.settle_farthest();
    }

    /// Does the same as [`settle`](Self::settle) while `go_on` returns `Continue`, because each step may take long.
    /// After a break the run is compared no further.
    pub fn settle_while(&mut self, go_on: &mut dyn FnMut() -> ControlFlow<()>) -> ControlFlow<()> {
        self.compare_waiting_while(go_on)?;
        self.settle_farthest();
        ControlFlow::Continue(())
    }

    fn settle_farthest(&mut self) {
        if let (Some(state), Some(truth)) = (self.farthest.take(), &mut self.truth) {
            self.most_m = 0.0; // it was known only to within rounding
            let distance_m = Deviation::distance_of(&state, truth);
            self.record_distance(distance_m);
        }
    }

    /// Records a distance, m, known to the last bit. A distance that is not finite ends the comparison, because the
    /// exact motion has left the range of numbers for good.
    fn record_distance(&mut self, distance_m: f64) {
        if !distance_m.is_finite() {
            self.truth = None;
        } else if distance_m > self.most_m {
            (self.farthest, self.most_m) = (None, distance_m);
        }
    }

    /// Returns the deviation of the run in `state`. `None` if the run is not compared with the exact motion, or the
    /// motion can no longer be predicted.
    pub fn deviation(&mut self, state: &State) -> Option<Deviation> {
        self.settle();
        if self.has_separated() {
            return None;
        }
        let deviation = Deviation::between(state, self.truth.as_mut()?);
        self.record_distance(deviation.distance_m);
        self.truth.as_ref().map(|_| deviation)
    }

    /// Returns the exact state at `time_s`, s. `None` if the run is not compared with the exact motion, or the motion
    /// can no longer be predicted.
    pub fn exact_state(&mut self, time_s: f64) -> Option<State> {
        self.settle();
        if self.has_separated() {
            return None;
        }
        let state = self.truth.as_mut()?.state_at(time_s);
        state.is_finite().then_some(state)
    }

    /// Returns the largest distance of the traced point from the exact motion, m, as found when the run was last
    /// [settled](Self::settle).
    ///
    /// It covers the time for which the motion could be predicted. `None` if the run is not compared.
    pub fn most_distance_m(&self) -> Option<f64> {
        self.truth.as_ref().map(|_| self.most_m)
    }

    /// Returns the swing of the tilt next to the exact one, over the same time, where they differ most. `None` if the
    /// run is not compared.
    pub fn swing(&self) -> Option<SwingComparison> {
        self.truth.as_ref().and_then(|_| self.swings.worst())
    }
}

/// Computes the distance of a run's traced point from the exact motion at one step after another.
#[derive(Clone, Debug)]
pub struct DistanceMeter {
    /// `None` if computing it would take too long.
    motions: Option<(Truth, Companion)>,
}

impl DistanceMeter {
    /// Returns a meter for the run of `scenario`, before its start.
    pub fn new(scenario: &Arc<Scenario>) -> Self {
        let motions = || (Truth::new(Arc::clone(scenario)), Companion::new(scenario));
        Self {
            motions: is_affordable(scenario).then(motions),
        }
    }

    /// Returns the distance of the traced point from the exact motion, m, in `state` of the run, which comes after all earlier
    /// ones. `None` if the exact motion is not known or can no longer be predicted.
    pub fn distance_m(&mut self, state: &State) -> Option<f64> {
        let (truth, companion) = self.motions.as_mut()?;
        companion.look_until(truth, state.time_s);
        if companion
            .until_s()
            .is_some_and(|until_s| state.time_s > until_s)
        {
            return None;
        }
        let distance_m = Deviation::distance_of(state, truth);
        distance_m.is_finite().then_some(distance_m)
    }
}

fn steps_at_once(scenario: &Scenario) -> usize {
    if has_closed_form(scenario) {
        AT_ONCE
    } else {
        1
    }
}

/// Returns the distances of the traced point from the exact motion in consecutive `states`, m, and the [height] of the
/// exact motion's axle.
///
/// The distances are accurate to a few units of rounding of the arm. `None` if this saves no time, or a number is not
/// finite.
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
    // Usually the traced point is on the axle.
    let cosines = if at.x == 0.0 && at.y == 0.0 && at.z != 0.0 {
        z.map(|z| z / at.z)
    } else {
        truth.positions_near(&Vector3::z(), &times_s)?[2]
    };
    let are_numbers = distances_m.iter().all(|m| m.is_finite());
    are_numbers.then(|| (distances_m, cosines.map(height)))
}

/// Deviation of a run from the exact motion at one moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Deviation {
    /// Distance of the traced point from its exact position, m.
    pub distance_m: f64,
    /// L·axle minus its exact value, J s.
    pub axle_momentum: f64,
    /// L_z minus its exact value, J s.
    pub lz: f64,
}

impl Deviation {
    /// Returns the deviation of the state `seen` in a run from the exact motion `truth`.
    pub fn between(seen: &State, truth: &mut Truth) -> Self {
        let exact = truth.state_at(seen.time_s);
        Self {
            distance_m: distance_m(seen, &exact.orientation, truth.scenario()),
            axle_momentum: seen.momentum.dot(&seen.axle()) - exact.momentum.dot(&exact.axle()),
            lz: seen.momentum.z - exact.momentum.z,
        }
    }

    /// Returns the distance alone, m.
    #[inline]
    pub fn distance_of(seen: &State, truth: &mut Truth) -> f64 {
        let exact = truth.orientation_at(seen.time_s);
        distance_m(seen, &exact, truth.scenario())
    }
}

/// Returns the distance of the traced point from its position at the orientation `exact`, m.
#[inline]
fn distance_m(seen: &State, exact: &Matrix3<f64>, scenario: &Scenario) -> f64 {
    let at = &scenario.body.mechanics.points()[scenario.trace].at;
    ((seen.orientation - exact) * at).norm()
}
