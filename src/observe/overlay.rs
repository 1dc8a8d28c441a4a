//! The exact motion beside the run: followed in time, and recorded as the run is.

use super::path::Path;
use super::recording::{Moment, Recording};
use crate::run::Truth;
use crate::scenario::Scenario;
use nalgebra::Vector3;
use std::sync::Arc;

/// Looks that may be due at once; of a run that is further ahead every second, third, ... step is looked at, so that the
/// exact motion comes after it within a frame.
const MOST_DUE: f64 = 20_000.0;

/// The exact motion from the start to (almost) now.
pub struct Overlay {
    truth: Truth,
    traced: Vector3<f64>,
    /// Time between two looks at it where there is time for all, s.
    time_step_s: f64,
    looks: u64,
    now: Moment,
    recording: Recording,
    path: Path,
}

impl Overlay {
    /// The exact motion of `scenario`, to be looked at once a time step.
    pub fn new(scenario: &Arc<Scenario>) -> Self {
        let traced = scenario.body.mechanics.points()[scenario.trace].at;
        let now = Moment::new(&scenario.start, &traced);
        let mut overlay = Self {
            truth: Truth::new(Arc::clone(scenario)),
            traced,
            time_step_s: scenario.motion.time_step_s,
            looks: 0,
            now,
            recording: Recording::default(),
            path: Path::new(traced.norm()),
        };
        overlay.look(now);
        overlay
    }

    /// Goes on as the exact motion of `scenario`, whose past is the same up to where it stands.
    pub fn go_on_in(&mut self, scenario: &Arc<Scenario>) {
        self.truth.go_on_in(scenario);
    }

    /// Follows it to `time_s` (s), look by look, until `enough` says that there is no more time for it.
    pub fn follow(&mut self, time_s: f64, mut enough: impl FnMut() -> bool) {
        let due = (time_s - self.now.time_s) / self.time_step_s;
        let spacing_s = self.time_step_s * (due / MOST_DUE).ceil().max(1.0);
        while self.now.time_s < time_s {
            let next = self.now.time_s + spacing_s;
            // The last look falls on the run's own time, whatever the rounding of the sums on the way.
            let next = if next > time_s - 0.5 * self.time_step_s {
                time_s
            } else {
                next
            };
            let state = self.truth.state_at(next);
            self.look(Moment {
                time_s: next,
                ..Moment::new(&state, &self.traced)
            });
            if enough() {
                return;
            }
        }
    }

    fn look(&mut self, moment: Moment) {
        self.recording.push(&moment);
        self.path.follow(self.looks, &moment.position);
        self.looks += 1;
        self.now = moment;
    }

    /// Where the exact motion stands.
    pub fn now(&self) -> &Moment {
        &self.now
    }

    /// Its curves over time.
    pub fn recording(&self) -> &Recording {
        &self.recording
    }

    /// Its path from above.
    pub fn path(&self) -> &Path {
        &self.path
    }
}
