//! The replay of a run that an edit restarted, up to the time of the previous run; and the step at which a run is left.

use super::Player;
use super::seek::{Seek, SeekPurpose};
use crate::engine::run::{Clock, Simulation};
use crate::lab::playback::live::LiveRun;

/// Maximum [cost](Player::cost) of the steps of a replay before the function returns: about 50 ms for the first edit.
///
/// A further nudge of a held key has slightly less: `MOST_COST_PER_NUDGE`.
const MOST_COST_PER_EDIT: u64 = 10_000_000;
const MOST_COST_PER_NUDGE: u64 = 8_000_000;

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Replay {
    /// The time of the previous run, s.
    time_s: f64,
    /// True if the run plays from there.
    then_plays: bool,
    /// True if the edit was made at step 0 of the same journal.
    is_act_at_start: bool,
}

impl Player {
    /// Returns true if a run that an edit restarted is being replayed to the time of the previous run.
    pub(in crate::lab) fn is_replaying(&self) -> bool {
        self.replayed_to().is_some()
    }

    /// Returns the last step of the replay, if there is one.
    fn replayed_to(&self) -> Option<u64> {
        match self.seeking() {
            Some(Seek {
                step,
                purpose: SeekPurpose::Replay { .. },
            }) => Some(step),
            _ => None,
        }
    }

    /// Returns true if the last edit restarted the run.
    pub(in crate::lab) fn has_just_restarted(&self) -> bool {
        self.replay.is_some()
    }

    /// Returns true if one more nudge of the same value takes effect at step 0, as the previous one did.
    pub(in crate::lab) fn nudges_at_start(&self) -> bool {
        self.replay.is_some_and(|replay| replay.is_act_at_start)
    }

    /// Returns true if an edit at the present step restarts the run. It does at step 0 of a run that was played
    /// further.
    pub(in crate::lab) fn restarts_on_edit(&self) -> bool {
        self.step_number() == 0 && (furthest_s(&self.run) > 0.0 || self.is_replaying())
    }

    /// Returns the step to record when an edit leaves the present run.
    pub(in crate::lab) fn step_to_leave_at(&self) -> u64 {
        // The new run starts with the settings that the old one has at the step on the screen, even if the old one is
        // seeking another step. A run that is being replayed has the same settings at both steps.
        self.replayed_to().unwrap_or(self.step_number())
    }

    /// Returns the present step, or the step to which the run is returning by itself.
    pub(in crate::lab) fn step_to_keep(&self) -> u64 {
        match self.seeking() {
            Some(seek) if seek.purpose != SeekPurpose::Command => seek.step,
            _ => self.run.seek_target().unwrap_or(self.step_number()),
        }
    }

    /// Returns the replay that follows an edit.
    ///
    /// Its time is the time of the present step, or of the step to which the run is returning. At step 0 it is the
    /// latest time that the run has reached. With `is_again` it is the time of the previous replay.
    pub(super) fn next_replay(&self, is_act: bool, is_again: bool) -> Replay {
        let step = self.step_to_keep();
        let (time_s, then_plays) = match self.seeking().map(|seek| seek.purpose) {
            Some(SeekPurpose::Replay { then_plays }) => (self.time_s(step), then_plays),
            Some(SeekPurpose::Resume) => (self.time_s(step), false),
            _ if self.step_number() == 0 => (furthest_s(&self.run), self.is_running()),
            _ => (self.run.now().time_s, self.is_running()),
        };
        let new = Replay {
            time_s,
            then_plays,
            is_act_at_start: false,
        };
        let replay = self.replay.filter(|_| is_again).unwrap_or(new);
        Replay {
            is_act_at_start: is_act || replay.is_act_at_start,
            ..replay
        }
    }

    /// Plays the run, which is at step 0, to the step nearest to the time of `replay`.
    ///
    /// Takes about 50 ms of steps (40 ms with `is_again`) before it returns. The others follow over the next frames.
    pub(super) fn begin_replay(&mut self, replay: Replay, is_again: bool) {
        self.replay = Some(replay);
        let Replay {
            time_s, then_plays, ..
        } = replay;
        let nearest_s = (time_s - 0.5 * self.motion().time_step_s).max(0.0);
        let steps = Simulation::step_at(self.run.scenario(), nearest_s);
        let most_cost = if is_again {
            MOST_COST_PER_NUDGE
        } else {
            MOST_COST_PER_EDIT
        };
        let at_once = steps.min(most_cost / self.cost(1));
        self.fast_forward(steps, at_once, SeekPurpose::Replay { then_plays });
        if self.goal.is_none() {
            self.set_running(then_plays);
        }
    }

    fn time_s(&self, step: u64) -> f64 {
        Clock::at(self.run.scenario(), step).time_s(step)
    }
}

/// Returns the latest time that `run` has reached, s.
pub(in crate::lab) fn furthest_s(run: &LiveRun) -> f64 {
    let (recording, _) = run.pictures();
    recording.whole().map_or(0.0, |whole| whole.end_s)
}
