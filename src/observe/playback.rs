//! A run being played: at its pace, as far as its next stop.

use super::live::{LiveRun, PlayEnd, Played};
use super::pace::{Pace, Speed};
use super::reading::Reading;
use crate::run::{Clock, NotFinite, Simulation};
use crate::scenario::{Scenario, keys};
use std::sync::Arc;
use std::time::Duration;

/// Longest stretch of stepping between two looks at the keyboard: a key pressed at its beginning is answered after the
/// stretch that follows.
const STEPPING: Duration = Duration::from_millis(12);
/// The exact motion's share of that, and of a frame of 15 a second: a tenth.
const FOLLOWING_FLAT_OUT: Duration = Duration::from_micros(1200);
const FOLLOWING: Duration = Duration::from_millis(6);
/// What may be stepped at once, before the next picture, on the way to a step where the run has been before: points,
/// and so many more for what a step costs beside them, times steps. It takes about 0.2 s.
const AT_ONCE: u64 = 100_000_000;
const BESIDE_POINTS: u64 = 60;
/// The same for steps that are asked for: before the next key, so that keys that come together count one by one. It
/// takes a few milliseconds.
const BEFORE_THE_NEXT_KEY: u64 = 1_000_000;
/// How many steps are played until a condition holds, before that is given up.
const MOST_UNTIL: u64 = 10_000_000;

/// Whether a run stands where it was to be played to.
pub type Condition = Box<dyn Fn(&LiveRun) -> bool>;

/// Why a run has stopped by itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Halt {
    /// The condition that it was played to holds.
    Fulfilled,
    /// The condition that it was played to did not hold on any of so many steps.
    NotFulfilled(u64),
    /// It stands at the scenario's last step; it can go on.
    EndOfRun,
    /// The steps that were asked for are taken.
    StepsTaken,
    /// The numbers would stop being finite.
    NotFinite(NotFinite),
}

/// A run, its pace, and where it is to stop.
pub struct Playback {
    run: LiveRun,
    pace: Pace,
    /// The step at which it stops by itself: the scenario's end at first, or where steps that were asked for lead.
    stop: u64,
    /// Whether it is on its way to `stop` as fast as it can.
    hurries: bool,
    /// When the scenario's run is over, s.
    end_s: f64,
    /// What it is played to, at its pace, if it is on its way there.
    until: Option<Condition>,
}

impl Playback {
    /// The run of `scenario` at step 0, at the speed the scenario names.
    pub fn new(scenario: Arc<Scenario>, running: bool) -> Self {
        let speed = scenario.file.view.as_ref().and_then(|view| view.speed);
        let (stop, end_s) = (scenario.steps, Clock::end_s(&scenario));
        let run = LiveRun::new(scenario);
        Self {
            run,
            pace: Pace::new(speed.unwrap_or(keys::SPEED), running),
            stop,
            hurries: false,
            end_s,
            until: None,
        }
    }

    /// The run is over at `end_s` (s), however many steps that is.
    pub fn set_end(&mut self, end_s: f64) {
        self.end_s = end_s;
        if !self.hurries && self.until.is_none() {
            self.stop = self.next_stop();
        }
    }

    /// The step at which the run is over.
    pub fn end_step(&self) -> u64 {
        Simulation::step_at(self.run.scenario(), self.end_s)
    }

    /// Takes the run to `step` at once.
    ///
    /// # Errors
    /// When the numbers stop being finite on the way.
    pub fn begin_at(&mut self, step: u64) -> Result<(), NotFinite> {
        while self.step_number() < step {
            self.run.step()?;
        }
        self.stop = self.next_stop();
        Ok(())
    }

    /// Back to step 0; speed, running or not, and the exact motion's being shown stay as they are.
    pub fn restart(&mut self) {
        let running = self.pace.is_running();
        self.go_to(0);
        self.set_running(running);
    }

    /// Begins the run of another `scenario`; speed, running or not, and the exact motion's being shown stay as they are.
    pub fn begin(&mut self, scenario: Arc<Scenario>) {
        let shows_exact = self.run.overlay().is_some();
        self.end_s = Clock::end_s(&scenario);
        self.run = LiveRun::new(scenario);
        self.run.set_overlay(shows_exact);
        self.hurries = false;
        self.until = None;
        self.stop = self.next_stop();
    }

    /// Goes to `step` and stops there: where the run has been before at once, unless the body is large; beyond, as fast
    /// as it can.
    pub fn go_to(&mut self, step: u64) {
        self.set_running(false);
        self.run.set_out_for(step);
        self.go_on_to(step);
    }

    /// Goes on in `scenario`, which has the same past up to `step`, and stops there.
    pub fn turn_at(&mut self, step: u64, scenario: &Arc<Scenario>) {
        self.set_running(false);
        self.run.set_out_for(step);
        self.run.go_on_in(scenario);
        self.go_on_to(step);
    }

    /// On to where it has set out for, and from there to `step`, where it has not been.
    fn go_on_to(&mut self, step: u64) {
        self.arrive();
        if step > self.run.furthest() {
            self.take_steps(step - self.step_number());
        }
    }

    /// Goes on in `scenario` from here, running or not as it was.
    pub fn go_on_in(&mut self, scenario: &Arc<Scenario>) {
        let running = self.pace.is_running();
        self.set_running(running);
        self.run.go_on_in(scenario);
        self.arrive();
        if !self.hurries {
            self.set_running(running);
        }
    }

    /// Shows `scenario`, which leads to the same numbers.
    pub fn describe_as(&mut self, scenario: &Arc<Scenario>) {
        self.run.describe_as(scenario);
        if !self.hurries && self.until.is_none() {
            self.stop = self.next_stop();
        }
    }

    /// Takes the run to where it has set out for: at once, or as fast as it can where that takes longer.
    fn arrive(&mut self) {
        let is_near = |to: u64| self.cost(to - self.step_number()) <= AT_ONCE;
        if self.run.destination().is_some_and(is_near) {
            while self.run.destination().is_some() && self.run.step().is_ok() {}
        }
        self.stop = self.run.destination().unwrap_or(self.next_stop());
        self.hurries = self.run.destination().is_some();
    }

    /// What `steps` cost, in points times steps.
    fn cost(&self, steps: u64) -> u64 {
        let points = self.run.scenario().body.mechanics.points().len() as u64;
        steps.saturating_mul(points + BESIDE_POINTS)
    }

    /// Plays what `wall` has earned since `now` (as `clock` tells it), as far as there is time for it. Gives why it
    /// stopped, if it did.
    pub fn advance(
        &mut self,
        now: Duration,
        wall: Duration,
        clock: &mut dyn FnMut() -> Duration,
    ) -> Option<Halt> {
        let owed_s = if self.hurries {
            f64::INFINITY
        } else {
            self.pace.earn(wall)
        };
        if owed_s <= 0.0 {
            return None;
        }
        let deadline = now + STEPPING;
        self.play(owed_s, wall, || clock() >= deadline)
    }

    /// Takes the run to where it is on its way to, however long that takes: to a step, or until a condition holds. Gives
    /// why it stopped, if it was on its way at all.
    pub fn finish(&mut self) -> Option<Halt> {
        if self.hurries || self.until.is_some() {
            self.play(f64::INFINITY, Duration::ZERO, || false)
        } else {
            None
        }
    }

    /// Plays what is `owed_s`, as far as there is time for it. Gives why it stopped, if it did.
    fn play(&mut self, owed_s: f64, wall: Duration, enough: impl FnMut() -> bool) -> Option<Halt> {
        let until = self.until.as_ref();
        let is_fulfilled = |run: &LiveRun| until.is_some_and(|until| until(run));
        let Played { stepped_s, end } = self.run.play(owed_s, self.stop, enough, is_fulfilled);
        self.pace.spend(stepped_s, wall, end == PlayEnd::CutShort);
        let halt = match end {
            PlayEnd::InTime | PlayEnd::CutShort => return None,
            PlayEnd::Fulfilled => Halt::Fulfilled,
            PlayEnd::AtStop if self.until.is_some() => Halt::NotFulfilled(MOST_UNTIL),
            PlayEnd::AtStop if self.hurries => Halt::StepsTaken,
            PlayEnd::AtStop => Halt::EndOfRun,
            PlayEnd::NotFinite(error) => Halt::NotFinite(error),
        };
        self.set_running(false);
        self.stop = self.next_stop();
        Some(halt)
    }

    /// Plays on at its pace until `condition` holds, past the end of the scenario's run too, and stops there; gives
    /// whether it has to: where it stands it may hold already. It is given up after ten million steps.
    pub fn run_until(&mut self, condition: Condition) -> bool {
        self.set_running(false);
        if condition(&self.run) {
            return false;
        }
        self.set_running(true);
        self.stop = self.step_number().saturating_add(MOST_UNTIL);
        self.until = Some(condition);
        true
    }

    /// Whether it is on its way to where a condition holds.
    pub fn is_on_its_way(&self) -> bool {
        self.until.is_some()
    }

    /// Lets the exact motion come after the run, where it is shown, for its share of the time.
    pub fn follow_exact(&mut self, clock: &mut dyn FnMut() -> Duration) {
        let share = if self.is_flat_out() {
            FOLLOWING_FLAT_OUT
        } else {
            FOLLOWING
        };
        let deadline = clock() + share;
        self.run.follow_exact(|| clock() >= deadline);
    }

    /// The end of the scenario's run, once it is passed none.
    fn next_stop(&self) -> u64 {
        let end = self.end_step();
        if self.step_number() < end {
            end
        } else {
            u64::MAX
        }
    }

    /// Goes on, or stops where it is.
    pub fn set_running(&mut self, running: bool) {
        if self.hurries || self.until.is_some() {
            self.run.stay();
            self.hurries = false;
            self.until = None;
            self.stop = self.next_stop();
        }
        self.pace.set_running(running);
    }

    /// Takes `steps` time steps as fast as it can, a few of them at once, and stops.
    pub fn take_steps(&mut self, steps: u64) {
        self.set_running(false);
        self.stop = self.step_number().saturating_add(steps);
        if self.cost(steps) <= BEFORE_THE_NEXT_KEY {
            while self.step_number() < self.stop && self.run.step().is_ok() {}
        }
        self.hurries = self.step_number() < self.stop; // a step that fails does so again, and is told of
        if !self.hurries {
            self.stop = self.next_stop();
        }
    }

    /// How many of the steps that were asked for are still to be taken, if it is on its way through them.
    pub fn steps_to_go(&self) -> Option<u64> {
        self.hurries
            .then(|| self.stop.saturating_sub(self.step_number()))
    }

    /// Sets the speed.
    pub fn set_speed(&mut self, speed: Speed) {
        self.pace.set_speed(speed);
    }

    /// The speed that is set.
    pub fn speed(&self) -> Speed {
        self.pace.speed()
    }

    /// Shows the exact motion beside the run, or does not.
    pub fn set_exact(&mut self, shown: bool) {
        self.run.set_overlay(shown);
    }

    /// The numbers as they are now.
    pub fn read(&mut self) -> Reading {
        Reading::new(&mut self.run, &self.pace)
    }

    /// The step it stands at.
    pub fn step_number(&self) -> u64 {
        self.run.simulation().step_number()
    }

    /// The run.
    pub fn run(&self) -> &LiveRun {
        &self.run
    }

    /// Whether it goes on by itself.
    pub fn is_running(&self) -> bool {
        self.pace.is_running()
    }

    /// Whether time changes anything: the run goes on, or something is being computed.
    pub fn is_busy(&self) -> bool {
        self.pace.is_running() || self.hurries || self.run.overlay_is_behind()
    }

    /// Whether it uses all the time there is, rather than moments that one can wait for.
    pub fn is_flat_out(&self) -> bool {
        let catches_up = !self.pace.is_running() && self.run.overlay_is_behind();
        self.hurries || catches_up || (self.pace.is_running() && self.pace.speed() == Speed::Top)
    }
}
