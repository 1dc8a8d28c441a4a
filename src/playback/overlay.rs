//! The exact motion beside the run, computed up to the run's time and recorded like the run. It ends where it is no number.

use super::path::Path;
use super::recording::{Moment, Recording};
use crate::run::Truth;
use crate::scenario::Scenario;
use nalgebra::Vector3;
use std::sync::Arc;

/// The most samples of the exact motion that one call of [`follow`](Overlay::follow) computes. If the run is further
/// ahead, only every second, third, ... step is sampled.
const MOST_SAMPLES: f64 = 20_000.0;

pub struct Overlay {
    truth: Truth,
    traced: Vector3<f64>,
    /// Least time between two samples, s.
    time_step_s: f64,
    samples: u64,
    pub now: Moment,
    pub recording: Recording,
    pub path: Path,
    has_ended: bool,
}

impl Overlay {
    pub fn new(scenario: &Arc<Scenario>) -> Self {
        let traced = scenario.body.mechanics.points()[scenario.trace].at;
        let now = Moment::new(&scenario.start, &traced);
        let mut overlay = Self {
            truth: Truth::new(Arc::clone(scenario)),
            traced,
            time_step_s: scenario.motion.time_step_s,
            samples: 0,
            now,
            recording: Recording::default(),
            path: Path::new(traced.norm()),
            has_ended: false,
        };
        overlay.record(now);
        overlay
    }

    /// Continues as the exact motion of `scenario`, which has the same motion up to the present time.
    pub fn go_on_in(&mut self, scenario: &Arc<Scenario>) {
        self.truth.go_on_in(scenario);
    }

    pub fn follow(&mut self, time_s: f64, mut enough: impl FnMut() -> bool) {
        let due = (time_s - self.now.time_s) / self.time_step_s;
        let spacing_s = self.time_step_s * (due / MOST_SAMPLES).ceil().max(1.0);
        while self.is_before(time_s) {
            let next = self.now.time_s + spacing_s;
            // The last sample is at exactly the run's time, without the rounding of the summed spacings.
            let next = if next > time_s - 0.5 * self.time_step_s {
                time_s
            } else {
                next
            };
            let state = self.truth.state_at(next);
            let moment = Moment {
                time_s: next,
                ..Moment::new(&state, &self.traced)
            };
            self.has_ended = !moment.is_finite();
            if !self.has_ended {
                self.record(moment);
            }
            if enough() {
                return;
            }
        }
    }

    fn record(&mut self, moment: Moment) {
        self.recording.push(&moment);
        self.path.follow(self.samples, &moment.position);
        self.samples += 1;
        self.now = moment;
    }

    /// Whether it can go on from a run that stands at `time_s` (s): it has not come further, nor ended.
    pub fn goes_on_at(&self, time_s: f64) -> bool {
        !self.has_ended && self.now.time_s <= time_s
    }

    /// Whether it has not come as far as `time_s` (s), and goes on.
    pub fn is_before(&self, time_s: f64) -> bool {
        !self.has_ended && self.now.time_s < time_s
    }
}
