//! Moves the run: [`seek`](Player::seek) sets the goal, and [`advance`](Player::advance) takes the steps.

use super::Player;
use crate::engine::analysis::cost::has_closed_form;
use crate::engine::run::NotFinite;
use crate::engine::scenario::Scenario;
use crate::lab::playback::live::{LiveRun, PlayEnd};
use crate::lab::playback::pace::Speed;
use std::sync::Arc;
use std::time::Duration;

/// Maximum duration of stepping between two reads of the keyboard.
const PLAY_BUDGET: Duration = Duration::from_millis(12);
/// The same for a run that seeks a step.
const SEEK_BUDGET: Duration = Duration::from_millis(40);
/// Computing time for the exact motion in each round of the main loop during a seek or at top speed: a tenth of the
/// time for steps.
const EXACT_BUDGET_FLAT_OUT: Duration = Duration::from_micros(1200);
/// The same at other times: a tenth of a frame at 15 frames per second.
const EXACT_BUDGET: Duration = Duration::from_millis(6);
/// Number of steps after which playing until a condition gives up. It also limits the steps of the commands in a file.
pub(in crate::lab) const MOST_UNTIL: u64 = 10_000_000;

/// Maximum [cost](Player::cost) of returning to a step within one frame: about 0.2 s.
const MOST_COST_PER_FRAME: u64 = 100_000_000;
/// Maximum cost of steps before the next key is read: a few milliseconds.
///
/// Keys that arrive together then act one by one.
const MOST_COST_PER_KEY: u64 = 1_000_000;
/// Maximum duration of steps before the next key, in case their cost was underestimated.
///
/// A push can make a step expensive, while the cost is estimated from the state before it. The remaining steps follow
/// over the next frames.
const LONGEST_AT_ONCE: Duration = Duration::from_millis(200);

pub(super) type Condition = Box<dyn FnMut(&mut LiveRun) -> bool>;

/// The goal of the run. Without a goal, the run plays at its speed to its end.
pub(super) enum Goal {
    /// Seek a step as fast as possible.
    Seek(Seek),
    /// Play at the set speed until the condition holds.
    Condition { holds: Condition, give_up_at: u64 },
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Seek {
    pub(super) step: u64,
    pub(super) purpose: SeekPurpose,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SeekPurpose {
    /// A command asked for the step.
    Command,
    /// The run was left at the step.
    Resume,
    /// An edit restarted the run. The step has the time of the previous run.
    Replay { then_plays: bool },
}

/// The reason why the run stopped by itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::lab) enum Halt {
    ConditionMet,
    /// The condition did not hold at any of [`MOST_UNTIL`] steps.
    GaveUp,
    /// The run is at the scenario's last step. It can be played further.
    EndOfRun,
    /// The run reached the step that it was seeking.
    Arrived,
    NotFinite(NotFinite),
}

/// Methods that set the goal of the run.
impl Player {
    /// Seeks `step` and stops there.
    ///
    /// A step that the run has reached before is usually shown at once. A later step, or a long distance with a large
    /// body, takes several frames.
    pub fn seek(&mut self, step: u64, purpose: SeekPurpose) {
        self.set_running(false);
        self.run.begin_seek(step);
        self.approach(step, purpose);
    }

    /// Seeks `step`, switches to `scenario`, which has the same motion up to there, and stops.
    pub(super) fn branch_at(&mut self, step: u64, scenario: &Arc<Scenario>) {
        self.set_running(false);
        self.run.begin_seek(step);
        self.run.branch(scenario);
        self.approach(step, SeekPurpose::Command);
    }

    /// Takes the steps to the run's seek target before returning, unless they take too long.
    ///
    /// Then takes the steps to `step` that the run has not reached yet, as [`take_steps`](Self::take_steps) does.
    fn approach(&mut self, step: u64, purpose: SeekPurpose) {
        if let Some(target) = self.run.seek_target()
            && self.cost(target - self.step_number()) <= MOST_COST_PER_FRAME
        {
            self.step_at_once(target);
        }
        if step > self.run.furthest() {
            self.take_steps(step - self.step_number(), purpose);
        } else {
            self.seek_on(self.run.seek_target().unwrap_or(0), purpose);
        }
    }

    /// Takes `steps` time steps as fast as possible and stops. A few steps are complete when it returns. Many steps
    /// follow over the next frames.
    pub(super) fn take_steps(&mut self, steps: u64, purpose: SeekPurpose) {
        let is_short = steps == 1 || self.cost(steps) <= MOST_COST_PER_KEY;
        self.fast_forward(steps, if is_short { steps } else { 0 }, purpose);
    }

    /// Takes `steps` time steps and stops: the first `at_once` before it returns, the others over the next frames.
    pub(super) fn fast_forward(&mut self, steps: u64, at_once: u64, purpose: SeekPurpose) {
        self.set_running(false);
        let here = self.step_number();
        self.step_at_once(here.saturating_add(at_once));
        self.seek_on(here.saturating_add(steps), purpose);
    }

    /// Seeks `step` over the next frames, if it is later than the present step.
    fn seek_on(&mut self, step: u64, purpose: SeekPurpose) {
        let is_later = step > self.step_number();
        self.goal = is_later.then_some(Goal::Seek(Seek { step, purpose }));
    }

    /// Steps the run to `step` before returning.
    ///
    /// If steps may have to be integrated, their cost is unknown, and stepping stops soon after [`LONGEST_AT_ONCE`].
    /// Otherwise there is no time limit, so that the effect of a key does not depend on a clock.
    fn step_at_once(&mut self, step: u64) {
        let budget = if has_closed_form(self.run.scenario()) {
            Duration::MAX
        } else {
            LONGEST_AT_ONCE
        };
        let _ = self.step_to(step, budget); // advance() tries a failed step again and reports it
    }

    /// Steps the run to `step`, but stops soon after `budget`.
    ///
    /// # Errors
    /// Returns an error if the numbers stop being finite on the way.
    pub fn step_to(&mut self, step: u64, budget: Duration) -> Result<(), NotFinite> {
        let (clock, begin) = (self.clock, (self.clock)());
        self.run
            .step_to(step, || clock().duration_since(begin) >= budget)
    }

    /// Returns the cost of `steps` steps, if each costs as much as the next one. A later step may cost far more.
    pub(super) fn cost(&self, steps: u64) -> u64 {
        steps.saturating_mul(self.run.cost_of_a_step())
    }

    /// Starts playing at the set speed until `condition` holds, and then stops.
    ///
    /// Does not stop at the end of the scenario's run, and gives up after [`MOST_UNTIL`] steps. Returns false, and does
    /// not start, if the condition holds already.
    pub(super) fn play_until(&mut self, mut condition: Condition) -> bool {
        self.set_running(false);
        if condition(&mut self.run) {
            return false;
        }
        self.set_running(true);
        self.goal = Some(Goal::Condition {
            holds: condition,
            give_up_at: self.step_number().saturating_add(MOST_UNTIL),
        });
        true
    }

    /// Plays or pauses, and cancels the goal.
    pub(in crate::lab) fn set_running(&mut self, running: bool) {
        self.run.cancel_seek();
        self.goal = None;
        self.pace.set_running(running);
    }

    /// Returns the step at which the run stops by itself: the step of its goal, or the scenario's last step. Returns
    /// `u64::MAX` once the run has reached the scenario's last step.
    pub(in crate::lab) fn stop(&self) -> u64 {
        match self.goal {
            Some(Goal::Seek(Seek { step, .. })) => step,
            Some(Goal::Condition { give_up_at, .. }) => give_up_at,
            None if self.step_number() >= self.end_step() => u64::MAX,
            None => self.end_step(),
        }
    }
}

/// Methods that take the steps that are due.
impl Player {
    /// Advances the run and the exact motion by `wall`, the time up to `now`. `clock` returns the present time.
    ///
    /// Steps for at most 12 ms, or 40 ms if the run seeks a step. Returns the reason if the run stopped by itself, and
    /// true if the picture has changed.
    pub(in crate::lab) fn advance(
        &mut self,
        now: Duration,
        wall: Duration,
        clock: &mut dyn FnMut() -> Duration,
    ) -> (Option<Halt>, bool) {
        let before = self.step_number();
        let (owed_s, budget) = if self.seeking().is_some() {
            (f64::INFINITY, SEEK_BUDGET)
        } else {
            (self.pace.earn(wall), PLAY_BUDGET)
        };
        let halt = if owed_s > 0.0 {
            self.play(owed_s, wall, || clock() >= now + budget)
        } else {
            None
        };
        let is_behind = self.run.overlay_is_behind();
        if is_behind {
            let share = if self.is_flat_out() {
                EXACT_BUDGET_FLAT_OUT
            } else {
                EXACT_BUDGET
            };
            let deadline = clock() + share;
            self.run.follow_exact(|| clock() >= deadline);
        }
        let is_new = halt.is_some() || is_behind || self.step_number() != before;
        (halt, is_new)
    }

    /// Advances the run towards its goal as fast as possible, and stops soon after `budget`. Returns the reason if the
    /// run stopped; `None` if there is no goal or it was not reached.
    pub(in crate::lab) fn advance_to_goal(&mut self, budget: Duration) -> Option<Halt> {
        self.goal.as_ref()?;
        let (clock, begin) = (self.clock, (self.clock)());
        self.play(f64::INFINITY, Duration::ZERO, || {
            clock().duration_since(begin) >= budget
        })
    }

    /// Plays `owed_s` of simulated time, or until `is_over` returns true. Returns the reason if the run stopped.
    fn play(&mut self, owed_s: f64, wall: Duration, is_over: impl FnMut() -> bool) -> Option<Halt> {
        let (begin_s, stop) = (self.run.now().time_s, self.stop());
        let end = match &mut self.goal {
            Some(Goal::Condition { holds, .. }) => self.run.play(owed_s, stop, is_over, holds),
            _ => self.run.play(owed_s, stop, is_over, |_| false),
        };
        if self.seeking().is_none() {
            let stepped_s = self.run.now().time_s - begin_s;
            self.pace.spend(stepped_s, wall, end == PlayEnd::CutShort);
        }
        let halt = match (end, &self.goal) {
            (PlayEnd::InTime | PlayEnd::CutShort, _) => return None,
            (PlayEnd::Fulfilled, _) => Halt::ConditionMet,
            (PlayEnd::AtStop, Some(Goal::Condition { .. })) => Halt::GaveUp,
            (PlayEnd::AtStop, Some(Goal::Seek(_))) => Halt::Arrived,
            (PlayEnd::AtStop, None) => Halt::EndOfRun,
            (PlayEnd::NotFinite(error), _) => Halt::NotFinite(error),
        };
        let purpose = self.seeking().map(|seek| seek.purpose);
        let goes_on = purpose == Some(SeekPurpose::Replay { then_plays: true });
        self.set_running(goes_on && halt == Halt::Arrived);
        Some(halt)
    }

    pub(super) fn seeking(&self) -> Option<Seek> {
        match self.goal {
            Some(Goal::Seek(seek)) => Some(seek),
            _ => None,
        }
    }

    /// Returns the number of steps to the seek target; `None` if there is none.
    pub fn steps_to_go(&self) -> Option<u64> {
        let here = self.step_number();
        self.seeking().map(|seek| seek.step.saturating_sub(here))
    }

    /// Returns true if the run plays until a condition holds.
    pub(in crate::lab) fn seeks_condition(&self) -> bool {
        matches!(self.goal, Some(Goal::Condition { .. }))
    }

    /// Returns true if the run plays or seeks a step.
    pub fn is_moving(&self) -> bool {
        self.is_running() || self.seeking().is_some()
    }

    /// Returns true if the picture changes with time: the run moves, or the exact motion catches up with it.
    pub fn is_busy(&self) -> bool {
        self.is_moving() || self.run.overlay_is_behind()
    }

    /// Returns true if the lab computes without pause, so that the main loop should not wait for the next frame.
    pub fn is_flat_out(&self) -> bool {
        let catches_up = !self.is_running() && self.run.overlay_is_behind();
        self.seeking().is_some() || catches_up || (self.is_running() && self.speed() == Speed::Top)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::scenario::Document;
    use std::cell::Cell;
    use std::time::Instant;

    thread_local! {
        static LOOKS: Cell<(Instant, u64)> = Cell::new((Instant::now(), 0));
    }

    /// A clock that advances by a second each time it is read.
    fn slow_clock() -> Instant {
        let (begin, looks) = LOOKS.get();
        LOOKS.set((begin, looks + 1));
        begin + Duration::from_secs(looks)
    }

    #[test]
    fn expensive_steps_are_taken_singly_until_time_is_up() {
        // A push that makes every step expensive from 0.07 s on. Earlier steps do not show it.
        let push = "push.0={point='camera',force_N=[0,0,-1e9],from_s=0.07,for_s=1}";
        let mut document = Document::open("phone").unwrap();
        document.set(push).unwrap();
        let mut player = Player::new(Arc::new(document.scenario().unwrap()), false);
        player.clock = slow_clock;
        player.take_steps(100, SeekPurpose::Command); // few steps, judged by the cost of the first
        assert_eq!((player.step_number(), player.steps_to_go()), (1, Some(99)));
        player.take_steps(1, SeekPurpose::Command);
        assert_eq!((player.step_number(), player.steps_to_go()), (2, None));
        player.fast_forward(48, 48, SeekPurpose::Command);
        assert_eq!((player.step_number(), player.steps_to_go()), (3, Some(47)));
        // Back to an earlier step, from the start of the run.
        player.step_to(60, Duration::MAX).unwrap();
        player.seek(40, SeekPurpose::Command);
        assert_eq!((player.step_number(), player.steps_to_go()), (1, Some(39)));
    }
}
