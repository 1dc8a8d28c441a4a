//! The runs beside the present one: the run before an edit, kept as a ghost, and the pinned run. And the replay of a
//! run that was begun anew, to the time at which the lab stood.

use super::answer::Done;
use super::player::Player;
use crate::playback::Halt;
use crate::playback::ghost::{Ghost, GhostToBe};
use crate::run::{Clock, Simulation};
use crate::scenario::Scenario;
use std::sync::Arc;

/// A run that is shorter than this share of its ghost does not replace the ghost: it was not played far enough.
const SHORT: f64 = 0.1;

/// The step to which the run is on its way by itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Heading {
    step: u64,
    /// Whether the run was begun anew by an edit; otherwise it returns to where it was left.
    is_replay: bool,
    /// Whether the run goes on from there.
    goes_on: bool,
}

/// The time to which a run that was begun anew is played.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Replay {
    /// The time at which the lab stood, s.
    time_s: f64,
    /// Whether the run goes on from there.
    goes_on: bool,
    /// Whether the edit is an act at step 0 of the same journal.
    is_act_at_start: bool,
}

pub(super) enum Pinned {
    /// The present run: nothing has changed it since.
    Present,
    /// An earlier run, or the present one before an edit.
    Before(Box<Ghost>),
    /// An earlier run that a session has kept: its pictures are being made again.
    Returning(GhostToBe),
}

/// What a session keeps of a pinned run, to pin it again.
#[derive(Clone, Default)]
pub(super) struct Reference {
    /// The step up to which it was played; of no meaning for the present run.
    pub(super) step: u64,
    /// Its scenario; `None` where the present run is pinned.
    pub(super) run: Option<Arc<Scenario>>,
}

impl PartialEq for Reference {
    fn eq(&self, other: &Self) -> bool {
        let run = |of: &Self| of.run.as_ref().map(Arc::as_ptr);
        (self.step, run(self)) == (other.step, run(other))
    }
}

impl Player {
    /// Begins the run of `scenario`, which differs from the present one by an edit, and plays it to the time at which the
    /// present one stands. That one stays as a ghost. With `is_again` the edit is one more nudge of the same value: time and
    /// ghost are those of the first.
    pub(super) fn begin(&mut self, scenario: Arc<Scenario>, is_again: bool) {
        let to = self.leave_for(&scenario, is_again);
        self.playback.begin(scenario);
        self.replay(to, is_again);
    }

    /// Continues with `scenario`, which differs by an edit made at step 0, as [`begin`](Self::begin) does.
    pub(super) fn begin_with_act(&mut self, scenario: &Arc<Scenario>, is_again: bool) {
        let to = Replay {
            is_act_at_start: true,
            ..self.leave_for(scenario, is_again)
        };
        self.playback.continue_at(0, scenario);
        self.replay(to, is_again);
    }

    /// Leaves the present run for that of `scenario`; returns to where that is to be played.
    fn leave_for(&mut self, scenario: &Arc<Scenario>, is_again: bool) -> Replay {
        self.forget_advice(); // now, so that its search does not take a processor from the steps to come
        let to = self.to_be_played_to(is_again);
        self.leave_ghost(is_again && self.replay.is_some());
        self.measure_again(scenario);
        to
    }

    /// Continues with `scenario`, which differs by an act at the present step.
    pub(super) fn go_on_in(&mut self, scenario: &Arc<Scenario>) {
        self.keep_pinned();
        (self.heading, self.replay) = (None, None);
        self.measure_on(self.playback.step_number(), scenario);
        self.playback.go_on_in(scenario);
    }

    /// Goes to `step` and continues with `scenario`, in which an act at that step was undone or done again.
    pub(super) fn continue_at(&mut self, step: u64, scenario: &Arc<Scenario>) {
        match step {
            0 => self.leave_ghost(false),
            _ => self.keep_pinned(),
        }
        (self.heading, self.replay) = (None, None);
        self.measure_on(step, scenario);
        self.playback.continue_at(step, scenario);
    }

    /// Changes to the run of `scenario` after an undo or redo: the present run stays as a ghost if it was played; an
    /// earlier ghost does not stay.
    pub(super) fn go_over_to(&mut self, scenario: Arc<Scenario>) {
        self.ghost = None;
        self.leave_ghost(false);
        (self.heading, self.replay) = (None, None);
        self.measure_again(&scenario);
        self.playback.begin(scenario);
    }

    /// Goes to `step`, at which the run was left.
    pub(super) fn return_to(&mut self, step: u64) {
        self.playback.go_to(step);
        self.heading = Some(Heading {
            step,
            is_replay: false,
            goes_on: false,
        });
    }

    /// The step to which the run is on its way.
    pub(super) fn bound_for(&self) -> Option<u64> {
        let to_go = self.playback.steps_to_go()?;
        Some(self.playback.step_number().saturating_add(to_go))
    }

    /// The step to which the run is on its way by itself.
    fn heading(&self) -> Option<Heading> {
        let step = self.bound_for()?;
        self.heading.filter(|heading| heading.step == step)
    }

    /// Whether a run that an edit has begun anew is on its way to the time at which the lab stood.
    pub(super) fn is_replaying(&self) -> bool {
        self.heading().is_some_and(|heading| heading.is_replay)
    }

    /// The step to be recorded when an edit leaves the present run.
    pub(super) fn step_to_leave_at(&self) -> u64 {
        // The new run begins with the settings that the old one has at the step on the screen, even if the old one is
        // on its way back to another step. A run that is being replayed to the time at which the lab stood has the same
        // settings there as here.
        let replaying = self.heading().filter(|heading| heading.is_replay);
        replaying.map_or(self.playback.step_number(), |heading| heading.step)
    }

    /// The present step, or the step to which the run is on its way by itself.
    pub(super) fn step_to_keep(&self) -> u64 {
        let heading = self.heading().map(|heading| heading.step);
        let destination = self.run().destination().or(heading);
        destination.unwrap_or(self.playback.step_number())
    }

    /// Whether one more nudge of the value that was nudged last acts at step 0, as that one did.
    pub(super) fn acts_at_start_again(&self) -> bool {
        self.replay.is_some_and(|replay| replay.is_act_at_start)
    }

    /// Whether an edit at the present step begins the run anew: at step 0 of a run that was played further.
    pub(super) fn stands_at_start(&self) -> bool {
        let has_further = self.furthest_s() > 0.0 || self.is_replaying();
        self.playback.step_number() == 0 && has_further
    }

    /// The latest time that the run has reached, s.
    fn furthest_s(&self) -> f64 {
        let recorded = self.run().pictures().0.whole();
        recorded.map_or(0.0, |whole| whole.end_s)
    }

    /// The time to which the run is to be played after an edit. It is where the run stands or is on its way to; at step
    /// 0 it is the latest time that the run has reached; with `is_again` it is that of the edit before.
    fn to_be_played_to(&self, is_again: bool) -> Replay {
        if let Some(replay) = self.replay.filter(|_| is_again) {
            return replay;
        }
        let heading = self.heading();
        let time_s = match heading {
            Some(Heading { step, .. }) => Clock::at(self.run().scenario(), step).time_s(step),
            None if self.playback.step_number() == 0 => self.furthest_s(),
            None => self.run().now().time_s,
        };
        Replay {
            time_s,
            goes_on: heading.map_or(self.playback.is_running(), |heading| heading.goes_on),
            is_act_at_start: false,
        }
    }

    /// Plays the run, which stands at step 0, to the step that is nearest to the time of `to`.
    fn replay(&mut self, to: Replay, is_again: bool) {
        let scenario = self.run().scenario();
        let half_a_step_s = 0.5 * self.motion().time_step_s;
        let step = Simulation::step_at(scenario, (to.time_s - half_a_step_s).max(0.0));
        self.replay = Some(to);
        let has_arrived = self.playback.catch_up(step, is_again);
        self.heading = (!has_arrived).then_some(Heading {
            step,
            is_replay: true,
            goes_on: to.goes_on,
        });
        if has_arrived {
            self.playback.set_running(to.goes_on);
        }
    }

    /// Lets the run go on once its replay has arrived, if it went on before the edit.
    pub(super) fn has_halted(&mut self, halt: Halt) {
        let here = self.playback.step_number();
        let goes_on = |heading: Heading| heading.step == here && heading.goes_on;
        if self.heading.take().is_some_and(goes_on) && halt == Halt::StepsTaken {
            self.playback.set_running(true);
        }
    }

    /// Keeps the present run as the ghost if it was played far enough, unless `keeps_ghost`. A pinned run does not
    /// become the ghost, since it is drawn as the pinned run.
    fn leave_ghost(&mut self, keeps_ghost: bool) {
        let is_pinned = matches!(self.pinned, Some(Pinned::Present));
        self.keep_pinned();
        if keeps_ghost {
            return;
        }
        if is_pinned {
            self.ghost = None;
            return;
        }
        let left = Ghost::of(self.run());
        let is_short = |before: &Ghost| left.end_s() < SHORT * before.end_s();
        if left.end_s() > 0.0 && !self.ghost.as_ref().is_some_and(is_short) {
            self.ghost = Some(left);
        }
    }

    /// Keeps the pictures of the present run if it is pinned. To be called before it changes.
    pub(super) fn keep_pinned(&mut self) {
        if matches!(self.pinned, Some(Pinned::Present)) {
            self.pinned = Some(Pinned::Before(Box::new(Ghost::of(self.run()))));
        }
    }

    /// Pins the present run as the reference, or no run.
    pub(super) fn set_pinned(&mut self, pinned: bool) -> Done {
        let was_pinned = self.is_pinned();
        self.pinned = pinned.then_some(Pinned::Present);
        Done::saying(match (pinned, was_pinned) {
            (true, false) => {
                "this run is pinned: all of it stays, in long and short dashes, whatever changes; i unpins it"
            }
            (true, true) => "this run is pinned now, instead of the one before",
            (false, true) => "the pinned run is taken away",
            (false, false) => "no run is pinned",
        })
    }

    pub fn is_pinned(&self) -> bool {
        self.pinned.is_some()
    }

    /// The pictures of the pinned run; `None` where none is pinned, or where it is the present run.
    pub fn pinned(&self) -> Option<&Ghost> {
        match &self.pinned {
            Some(Pinned::Before(run)) => Some(run),
            Some(Pinned::Present | Pinned::Returning(_)) | None => None,
        }
    }

    /// The time that the pinned run had reached, s; `None` where none is pinned, or its pictures are not made yet.
    pub fn pinned_end_s(&self) -> Option<f64> {
        match &self.pinned {
            Some(Pinned::Present) => Some(self.furthest_s()),
            Some(Pinned::Before(run)) => Some(run.end_s()),
            Some(Pinned::Returning(_)) | None => None,
        }
    }

    /// What a session keeps of the pinned run.
    pub(super) fn reference(&self) -> Option<Reference> {
        let (scenario, step) = match self.pinned.as_ref()? {
            Pinned::Present => return Some(Reference::default()),
            Pinned::Before(run) => (&run.scenario, run.furthest),
            Pinned::Returning(run) => (&run.scenario, run.furthest),
        };
        let run = Some(Arc::clone(scenario));
        Some(Reference { step, run })
    }

    /// Pins `reference` again: its pictures come a little later.
    pub(super) fn pin_again(&mut self, reference: Reference) {
        let begin = |scenario| Pinned::Returning(GhostToBe::begin(scenario, reference.step));
        self.pinned = Some(reference.run.map_or(Pinned::Present, begin));
    }

    /// Takes the pictures of the pinned run once they are made again. Returns whether they have come just now.
    pub(super) fn take_pinned_news(&mut self) -> bool {
        if let Some(Pinned::Returning(run)) = &self.pinned
            && let Some(ghost) = run.made()
        {
            self.pinned = Some(Pinned::Before(Box::new(ghost)));
            return true;
        }
        false
    }
}
