//! The data from which the pictures of a run are drawn: its curves over time, its path, its present sample, and the
//! exact motion.

use super::PathFromAbove;
use crate::engine::recording::{RecordedSample, Recording};
use crate::engine::run::{Step, Truth};
use crate::engine::scenario::Scenario;
use crate::physics::State;
use nalgebra::Vector3;
use std::cmp::Ordering;
use std::sync::Arc;

/// The data of the pictures of one run. Every step must be passed to it.
pub(super) struct Pictures {
    pub now: RecordedSample,
    pub recording: Recording,
    pub path: PathFromAbove,
    /// The last step in the path. It is later than the present step while the run seeks it.
    pub followed_to: u64,
    pub ahead: Option<Ahead>,
    /// The last state in which the body was rigid, and its step; `None` if it still is rigid.
    pub last_whole: Option<(u64, State)>,
}

/// The pictures of a run up to the furthest step that it has reached, while it is at an earlier step.
pub(super) struct Ahead {
    pub step: u64,
    pub recording: Recording,
    pub path: PathFromAbove,
}

impl Pictures {
    pub fn new(step: &Step, reach: f64) -> Self {
        let mut pictures = Self {
            now: recorded_sample(step),
            recording: Recording::default(),
            path: PathFromAbove::new(reach),
            followed_to: 0,
            ahead: None,
            last_whole: None,
        };
        pictures.recording.push(&pictures.now);
        pictures.path.add(0, &pictures.now.position);
        pictures
    }

    /// Adds `step`, the latest step of the run.
    #[inline]
    pub fn record(&mut self, step: &Step) {
        self.now = recorded_sample(step);
        if self.last_whole.is_none() && !step.after().is_a_rotation() {
            let before = step.before().filter(|before| before.is_a_rotation());
            self.last_whole = before.map(|before| (step.number() - 1, *before));
        }
        self.keep(step.number());
    }

    /// Adds the present sample, at `step`, to the recording and the path, unless they contain it already.
    pub fn keep(&mut self, step: u64) {
        if step >= self.recording.samples() {
            self.recording.push(&self.now);
        }
        match step.cmp(&self.followed_to) {
            Ordering::Less => {}
            Ordering::Equal => self.path.continue_from(&self.now.position),
            Ordering::Greater => {
                self.path.add(step, &self.now.position);
                self.followed_to = step;
            }
        }
        if let Some(ahead) = self.ahead.take_if(|ahead| ahead.step == step) {
            (self.recording, self.path) = (ahead.recording, ahead.path);
        }
    }

    /// Sets `step`, to which the run has returned, as the present step.
    pub fn return_to(&mut self, step: &Step) {
        self.now = recorded_sample(step);
        self.last_whole.take_if(|(at, _)| *at >= step.number());
    }

    /// Seeks `step`, which the run has reached, from the present step `here`. Returns the latest step from which the
    /// run must pass all steps to the pictures again.
    pub fn begin_seek(&mut self, step: u64, here: u64) -> u64 {
        let ahead = self.ahead.get_or_insert_with(|| Ahead {
            step: here,
            recording: self.recording.clone(),
            path: self.path.clone(),
        });
        if step > here {
            self.recording.clone_from(&ahead.recording);
            self.path.clone_from(&ahead.path);
        }
        self.path.cut_back(step);
        self.followed_to = step;
        let recorded = self.cut_back_recording(step + 1);
        step.min(recorded.saturating_sub(1))
    }

    /// Cuts the recording back to at most `samples`, and further if needed for a fine enough recording after it is
    /// refilled. Returns the number of samples that remain.
    fn cut_back_recording(&mut self, samples: u64) -> u64 {
        let kept = self.recording.cut_back(samples);
        match self.recording.coarse_since() {
            Some(from) => self.recording.cut_back(from),
            None => kept,
        }
    }

    /// Ends a seek at the present step, `step`. If the recording lacks steps, it is filled with the present sample.
    pub fn cancel_seek(&mut self, step: u64) {
        self.path.cut_back(step);
        self.path.continue_from(&self.now.position);
        self.followed_to = step;
        for _ in self.recording.cut_back(step + 1)..=step {
            self.recording.push(&self.now);
        }
    }

    pub fn furthest(&self) -> u64 {
        let ahead = self.ahead.as_ref().map_or(0, |ahead| ahead.step);
        ahead.max(self.followed_to)
    }
}

fn recorded_sample(step: &Step) -> RecordedSample {
    RecordedSample {
        time_s: step.time_s(),
        position: *step.position(),
        axle_height: step.after().axle().z,
    }
}

/// Maximum number of samples of the exact motion that one call of [`advance_to`](Overlay::advance_to) computes. If the
/// run is further ahead, only every second, third, ... step is sampled.
const MOST_SAMPLES: f64 = 20_000.0;

pub struct Overlay {
    truth: Truth,
    traced: Vector3<f64>,
    /// Minimum time between two samples, s.
    time_step_s: f64,
    pub now: RecordedSample,
    pub recording: Recording,
    /// The distance of the traced point from the exact motion, m, recorded as the curve x.
    pub distance: Recording,
    pub path: PathFromAbove,
    has_ended: bool,
}

impl Overlay {
    pub fn new(scenario: &Arc<Scenario>) -> Self {
        let traced = scenario.body.mechanics.points()[scenario.trace].at;
        let now = RecordedSample::new(&scenario.start, &traced);
        let mut overlay = Self {
            truth: Truth::new(Arc::clone(scenario)),
            traced,
            time_step_s: scenario.motion.time_step_s,
            now,
            recording: Recording::default(),
            distance: Recording::default(),
            path: PathFromAbove::new(traced.norm()),
            has_ended: false,
        };
        overlay.record(now);
        overlay.distance.push_values(now.time_s, [0.0; 4]);
        overlay
    }

    /// Continues as the exact motion of `scenario`, which has the same motion up to the present time.
    pub fn branch(&mut self, scenario: &Arc<Scenario>) {
        self.truth.branch(scenario);
    }

    /// Advances to `time_s` (s), or until `is_over` returns true. `run` is the recording of the run up to that time.
    pub fn advance_to(&mut self, time_s: f64, run: &Recording, mut is_over: impl FnMut() -> bool) {
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
            let sample = RecordedSample {
                time_s: next,
                ..RecordedSample::new(&state, &self.traced)
            };
            self.has_ended = !sample.is_finite();
            if !self.has_ended {
                self.record(sample);
                self.record_distance(run);
            }
            if is_over() {
                return;
            }
        }
    }

    fn record(&mut self, sample: RecordedSample) {
        self.recording.push(&sample);
        self.path.add(self.recording.samples(), &sample.position);
        self.now = sample;
    }

    /// Records the distance of the run from the present sample, if the run's sample at that time is known.
    fn record_distance(&mut self, run: &Recording) {
        let now_s = self.now.time_s;
        let half_s = 0.5 * self.time_step_s;
        let nearest = run.between(now_s - half_s, now_s + half_s).last();
        if let Some(bin) = nearest.filter(|bin| bin.samples() == 1) {
            let distance_m = (bin.end() - self.now.position).norm();
            self.distance
                .push_values(now_s, [distance_m, 0.0, 0.0, 0.0]);
        }
    }

    /// Returns true if it can continue from a run that is at `time_s` (s): it has neither passed that time nor ended.
    pub fn can_continue_at(&self, time_s: f64) -> bool {
        !self.has_ended && self.now.time_s <= time_s
    }

    /// Returns true if it has not reached `time_s` (s) and has not ended.
    pub fn is_before(&self, time_s: f64) -> bool {
        !self.has_ended && self.now.time_s < time_s
    }
}
