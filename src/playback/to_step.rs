//! Goes to a step and stops there, however fast the playback is: before the call returns where that takes a moment, and over
//! the next frames otherwise.

use super::Playback;
use crate::run::NotFinite;
use crate::scenario::Scenario;
use std::sync::Arc;

/// The greatest [cost](Playback::cost) of returning to a step within one frame; it takes about 0.2 s.
const MOST_COST_PER_FRAME: u64 = 100_000_000;
/// The greatest cost of steps that are taken before the next key is read, so that keys that arrive together act one by
/// one; it takes a few milliseconds.
const MOST_COST_PER_KEY: u64 = 1_000_000;
/// The same for the steps of an edit, after which the run is played to the time at which it stood: about 50 ms for the
/// first one, and a little less for each further nudge of a held key.
const MOST_COST_PER_EDIT: u64 = 10_000_000;
const MOST_COST_PER_NUDGE: u64 = 8_000_000;

impl Playback {
    /// Steps the run to `step` before returning.
    ///
    /// # Errors
    /// When the numbers stop being finite on the way.
    pub fn begin_at(&mut self, step: u64) -> Result<(), NotFinite> {
        self.run.step_to(step)?;
        self.stop = self.next_stop();
        Ok(())
    }

    /// Goes to `step` and stops there. A step that the run has reached before is usually shown at once; a later step, or a
    /// long way with a large body, takes several frames.
    pub fn go_to(&mut self, step: u64) {
        self.set_running(false);
        self.run.set_out_for(step);
        self.go_on_to(step);
    }

    /// Goes to `step`, continues with `scenario`, which has the same motion up to there, and stops.
    pub fn continue_at(&mut self, step: u64, scenario: &Arc<Scenario>) {
        self.set_running(false);
        self.run.set_out_for(step);
        self.run.go_on_in(scenario);
        self.go_on_to(step);
    }

    fn go_on_to(&mut self, step: u64) {
        self.arrive();
        if step > self.run.furthest() {
            self.take_steps(step - self.step_number());
        }
    }

    /// Continues with `scenario` from the present step; whether the run goes on stays as it is.
    pub fn go_on_in(&mut self, scenario: &Arc<Scenario>) {
        let running = self.pace.is_running();
        self.set_running(running);
        self.run.go_on_in(scenario);
        self.arrive();
        if !self.hurries {
            self.set_running(running);
        }
    }

    /// Takes `steps` time steps as fast as it can and stops. A few steps are taken before returning, many over the next
    /// frames.
    pub fn take_steps(&mut self, steps: u64) {
        let is_short = steps == 1 || self.cost(steps) <= MOST_COST_PER_KEY;
        self.take_in_parts(steps, if is_short { steps } else { 0 });
    }

    /// Plays on to `step` and stops there, after an edit or, with `is_again`, after one more nudge of the same value. As
    /// many steps as take about 50 ms (40 ms for a nudge) are taken before returning, and the others over the next frames.
    /// Returns whether it has arrived.
    pub fn catch_up(&mut self, step: u64, is_again: bool) -> bool {
        let most = if is_again {
            MOST_COST_PER_NUDGE
        } else {
            MOST_COST_PER_EDIT
        };
        let steps = step.saturating_sub(self.step_number());
        self.take_in_parts(steps, steps.min(most / self.cost(1)));
        !self.hurries
    }

    /// Takes `steps` time steps and stops: the first `at_once` before returning, the others over the next frames.
    fn take_in_parts(&mut self, steps: u64, at_once: u64) {
        self.set_running(false);
        let here = self.step_number();
        self.stop = here.saturating_add(steps);
        let first = here.saturating_add(at_once);
        let _ = self.run.step_to(first); // a failed step is tried again by advance(), which reports it
        self.hurries = self.step_number() < self.stop;
        if !self.hurries {
            self.stop = self.next_stop();
        }
    }

    /// Steps the run to its destination, either before returning or, if that takes too long, over the next frames.
    fn arrive(&mut self) {
        let is_near = |to: u64| self.cost(to - self.step_number()) <= MOST_COST_PER_FRAME;
        if let Some(to) = self.run.destination().filter(|to| is_near(*to)) {
            let _ = self.run.step_to(to); // it has been there before: its numbers are finite
        }
        self.stop = self.run.destination().unwrap_or(self.next_stop());
        self.hurries = self.run.destination().is_some();
    }

    fn cost(&self, steps: u64) -> u64 {
        steps.saturating_mul(self.run.cost_of_a_step())
    }
}
