//! Where the run is on its way to by itself: back to the step where it was left, or, begun anew by an edit, to the time at
//! which the run before stood.

use crate::engine::run::{Clock, Simulation};
use crate::lab::playback::live::LiveRun;
use crate::lab::playback::{Halt, Playback};

/// The step to which the run is on its way by itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::lab) struct Heading {
    pub(super) step: u64,
    /// Whether the run was begun anew by an edit; otherwise it returns to where it was left.
    is_replay: bool,
    /// Whether the run goes on from there.
    goes_on: bool,
}

/// The time to which a run that was begun anew is played.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Replay {
    /// The time at which the run before stood, s.
    time_s: f64,
    /// Whether the run goes on from there.
    goes_on: bool,
    /// Whether the edit is an act at step 0 of the same journal.
    is_act_at_start: bool,
}

#[derive(Clone, Copy, Debug, Default)]
pub(in crate::lab) struct Destination {
    /// Out of date where other steps were asked for since.
    pub(super) heading: Option<Heading>,
    /// That of the last edit that began the run anew; `None` if another act came after it.
    replay: Option<Replay>,
}

impl Destination {
    /// Goes to `step`, at which the run was left.
    pub(in crate::lab) fn return_to(&mut self, step: u64, playback: &mut Playback) {
        playback.go_to(step);
        self.heading = Some(Heading {
            step,
            is_replay: false,
            goes_on: false,
        });
    }

    pub(super) fn heading(&self, playback: &Playback) -> Option<Heading> {
        let to_go = playback.steps_to_go()?;
        let step = playback.step_number().saturating_add(to_go);
        self.heading.filter(|heading| heading.step == step)
    }

    /// Whether a run that an edit has begun anew is on its way to the time at which the one before stood.
    pub(in crate::lab) fn is_replaying(&self, playback: &Playback) -> bool {
        self.heading(playback)
            .is_some_and(|heading| heading.is_replay)
    }

    /// The step to be recorded when an edit leaves the present run.
    pub(in crate::lab) fn step_to_leave_at(&self, playback: &Playback) -> u64 {
        // The new run begins with the settings that the old one has at the step on the screen, even if the old one is
        // on its way back to another step. A run that is being replayed has the same settings there as here.
        let replaying = self.heading(playback).filter(|heading| heading.is_replay);
        replaying.map_or(playback.step_number(), |heading| heading.step)
    }

    /// Whether the last edit began the run anew, and no other act came after it.
    pub(in crate::lab) fn is_of_edit(&self) -> bool {
        self.replay.is_some()
    }

    /// Whether one more nudge of the value that was nudged last acts at step 0, as that one did.
    pub(in crate::lab) fn acts_at_start_again(&self) -> bool {
        self.replay.is_some_and(|replay| replay.is_act_at_start)
    }

    /// Whether an edit at the present step begins the run anew: at step 0 of a run that was played further.
    pub(in crate::lab) fn stands_at_start(&self, playback: &Playback) -> bool {
        let has_further = furthest_s(playback.run()) > 0.0 || self.is_replaying(playback);
        playback.step_number() == 0 && has_further
    }

    /// The time to which the run is to be played after an edit. It is that of the present step, or of the step to which
    /// the run is on its way; at step 0 it is the latest time that the run has reached; with `is_again` it is that of the
    /// edit before.
    pub(super) fn replay_of(&self, playback: &Playback, is_act: bool, is_again: bool) -> Replay {
        let run = playback.run();
        let heading = self.heading(playback);
        let time_s = match heading {
            Some(Heading { step, .. }) => Clock::at(run.scenario(), step).time_s(step),
            None if playback.step_number() == 0 => furthest_s(run),
            None => run.now().time_s,
        };
        let new = Replay {
            time_s,
            goes_on: heading.map_or(playback.is_running(), |heading| heading.goes_on),
            is_act_at_start: false,
        };
        let replay = self.replay.filter(|_| is_again).unwrap_or(new);
        Replay {
            is_act_at_start: is_act || replay.is_act_at_start,
            ..replay
        }
    }

    /// Plays the run, which stands at step 0, to the step that is nearest to the time of `to`. `time_step_s` is in force.
    pub(super) fn replay(
        &mut self,
        to: Replay,
        is_again: bool,
        time_step_s: f64,
        playback: &mut Playback,
    ) {
        let nearest_s = (to.time_s - 0.5 * time_step_s).max(0.0);
        let step = Simulation::step_at(playback.run().scenario(), nearest_s);
        self.replay = Some(to);
        let has_arrived = playback.catch_up(step, is_again);
        self.heading = (!has_arrived).then_some(Heading {
            step,
            is_replay: true,
            goes_on: to.goes_on,
        });
        if has_arrived {
            playback.set_running(to.goes_on);
        }
    }

    /// Lets the run go on once its replay has arrived, if it went on before the edit.
    pub(in crate::lab) fn has_halted(&mut self, halt: Halt, playback: &mut Playback) {
        let here = playback.step_number();
        let goes_on = |heading: Heading| heading.step == here && heading.goes_on;
        if self.heading.take().is_some_and(goes_on) && halt == Halt::StepsTaken {
            playback.set_running(true);
        }
    }
}

/// The latest time that `run` has reached, s.
pub(in crate::lab) fn furthest_s(run: &LiveRun) -> f64 {
    let recorded = run.pictures().0.whole();
    recorded.map_or(0.0, |whole| whole.end_s)
}
