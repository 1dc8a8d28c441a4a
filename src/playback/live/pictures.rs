//! What the pictures of a run are drawn from: its curves over time, its path, and where it stands.

use super::Path;
use crate::physics::State;
use crate::playback::recording::{Moment, Recording};
use crate::run::Step;
use std::cmp::Ordering;

/// The data of the pictures of one run; to be shown every step.
pub(super) struct Pictures {
    pub now: Moment,
    pub recording: Recording,
    pub path: Path,
    /// The last step in the path. It is later than the present step while the run is still stepping towards it.
    pub followed_to: u64,
    pub ahead: Option<Ahead>,
    /// The last state in which the body was a rigid one, and its step; `None` where it still is one.
    pub last_whole: Option<(u64, State)>,
}

/// The pictures of a run up to the furthest step it has been at, while it stands at an earlier one.
pub(super) struct Ahead {
    pub step: u64,
    pub recording: Recording,
    pub path: Path,
}

impl Pictures {
    pub fn new(step: &Step, reach: f64) -> Self {
        let mut pictures = Self {
            now: moment(step),
            recording: Recording::default(),
            path: Path::new(reach),
            followed_to: 0,
            ahead: None,
            last_whole: None,
        };
        pictures.recording.push(&pictures.now);
        pictures.path.follow(0, &pictures.now.position);
        pictures
    }

    #[inline]
    pub fn follow(&mut self, step: &Step) {
        self.now = moment(step);
        if self.last_whole.is_none() && !step.after().is_a_rotation() {
            let before = step.before().filter(|before| before.is_a_rotation());
            self.last_whole = before.map(|before| (step.number() - 1, *before));
        }
        self.keep(step.number());
    }

    /// Adds the present moment, which is at `step`, to the recording and the path, unless they have it already.
    pub fn keep(&mut self, step: u64) {
        if step >= self.recording.moments() {
            self.recording.push(&self.now);
        }
        match step.cmp(&self.followed_to) {
            Ordering::Less => {}
            Ordering::Equal => self.path.stand_at(&self.now.position),
            Ordering::Greater => {
                self.path.follow(step, &self.now.position);
                self.followed_to = step;
            }
        }
        if let Some(ahead) = self.ahead.take_if(|ahead| ahead.step == step) {
            (self.recording, self.path) = (ahead.recording, ahead.path);
        }
    }

    pub fn stand_at(&mut self, step: &Step) {
        self.now = moment(step);
        self.last_whole.take_if(|(at, _)| *at >= step.number());
    }

    /// Goes back, or forward, to `step`, which the run has reached, from the present step `here`. Returns the latest step
    /// from which it has to be shown the steps up to there again.
    pub fn go_to(&mut self, step: u64, here: u64) -> u64 {
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

    /// Cuts the recording back to at most `moments`, and so far that filling it again makes it fine enough. Returns how
    /// many moments it keeps.
    fn cut_back_recording(&mut self, moments: u64) -> u64 {
        let kept = self.recording.cut_back(moments);
        match self.recording.coarse_since() {
            Some(from) => self.recording.cut_back(from),
            None => kept,
        }
    }

    /// Ends at the present step, `step`, where it was on its way to a later one. Where the recording lacks steps, it is
    /// filled with the present moment.
    pub fn stay(&mut self, step: u64) {
        self.path.cut_back(step);
        self.path.stand_at(&self.now.position);
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

fn moment(step: &Step) -> Moment {
    Moment {
        time_s: step.time_s(),
        position: *step.position(),
        axle_height: step.after().axle().z,
    }
}
