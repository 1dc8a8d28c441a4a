//! A run that is being watched: its playback, its earlier steps, its numbers, and the data of its pictures.
//!
//! - [`live`] plays a run and the exact motion beside it, and returns to earlier steps; [`recording`](crate::engine::recording) and [`path`] store the
//!   data of its pictures.
//! - [`outline`] gives the lines by which a solid part is drawn. [`strip`], [`scale`] and [`camera`](crate::plot::camera) are the geometry of the pictures,
//!   for a screen and for a figure alike: a curve in each column of a window of time, the values at an axis, and the
//!   position of a point in space in a plane picture. [`detail`] is the window of time in which fast motion is seen;
//!   [`ages`] says which parts of a path are old.
//! - [`lookup`] gives the numbers of any earlier step.
//! - [`Playback`] plays the run at its [`pace`] until the next stop.
//! - [`reading`] holds the numbers on the screen; [`background`] searches for a setting that makes them reliable.
//! - [`marks`] are the times of pushes and edits; [`ghost`] is the picture of the previous run.

pub mod ages;
pub mod background;
pub mod detail;
pub mod dip;
pub mod ghost;
pub mod live;
pub mod lookup;
pub mod marks;
pub mod outline;
pub mod pace;
pub mod path;
pub mod reading;
pub mod scale;
pub mod strip;

use crate::engine::analysis::cost::has_closed_form;
use crate::engine::run::{Clock, NotFinite, Simulation};
use crate::engine::scenario::{Scenario, keys};
use crate::physics::Workings;
use live::{LiveRun, PlayEnd};
use pace::{Pace, Speed};
use reading::Reading;
use std::ops::ControlFlow;
use std::sync::{Arc, LazyLock};
use std::time::{Duration, Instant};
use toml::Value;

/// The longest time of stepping between two readings of the keyboard.
const STEPPING: Duration = Duration::from_millis(12);
/// The same of a run on its way to a step that was asked for.
const HURRYING: Duration = Duration::from_millis(40);
/// Computing time for the exact motion in each round of the loop while the run steps flat out: a tenth of that time.
const FOLLOWING_FLAT_OUT: Duration = Duration::from_micros(1200);
/// The same otherwise: a tenth of a frame at 15 frames a second.
const EXACT_BUDGET: Duration = Duration::from_millis(6);
/// The number of steps after which playing until a condition holds is given up; commands of a file go no further at once.
pub const MOST_UNTIL: u64 = 10_000_000;

pub type Condition = Box<dyn FnMut(&mut LiveRun) -> bool>;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Halt {
    Fulfilled,
    NotFulfilled(u64),
    /// The run stands at the scenario's last step; it can be played further.
    EndOfRun,
    StepsTaken,
    NotFinite(NotFinite),
}

pub struct Playback {
    run: LiveRun,
    pace: Pace,
    /// The step at which it stops by itself: the scenario's last step, or the last of the requested steps.
    stop: u64,
    /// Whether it steps towards `stop` as fast as it can, whatever its pace.
    hurries: bool,
    end_s: f64,
    is_endless: bool,
    until: Option<Condition>,
    /// Tells the time since some moment, for the steps that are taken before returning.
    clock: fn() -> Duration,
}

/// The time since it was asked for first.
fn elapsed() -> Duration {
    static BEGIN: LazyLock<Instant> = LazyLock::new(Instant::now);
    BEGIN.elapsed()
}

impl Playback {
    pub fn new(scenario: Arc<Scenario>, running: bool) -> Self {
        Self::with_clock(scenario, running, elapsed)
    }

    /// The same with another clock for the steps that are taken before returning.
    pub fn with_clock(scenario: Arc<Scenario>, running: bool, clock: fn() -> Duration) -> Self {
        let speed = scenario.file.viewed("speed").and_then(Value::as_float);
        let (stop, end_s) = (scenario.steps, Clock::end_s(&scenario));
        let run = LiveRun::new(scenario);
        Self {
            run,
            pace: Pace::new(speed.unwrap_or(keys::DEFAULT_SPEED), running),
            stop,
            hurries: false,
            end_s,
            is_endless: false,
            until: None,
            clock,
        }
    }

    pub fn set_end(&mut self, end_s: f64) {
        self.end_s = end_s;
        self.renew_stop();
    }

    /// Takes the next stop from the run, unless one was requested.
    fn renew_stop(&mut self) {
        if !self.hurries && self.until.is_none() {
            self.stop = self.next_stop();
        }
    }

    pub fn end_s(&self) -> f64 {
        self.end_s
    }

    pub fn end_step(&self) -> u64 {
        Simulation::step_at(self.run.scenario(), self.end_s)
    }

    /// Begins the run of another `scenario`. The speed, whether the run goes on, and whether the exact motion is shown stay
    /// as they are.
    pub fn begin(&mut self, scenario: Arc<Scenario>) {
        let shows_exact = self.run.shows_exact();
        self.end_s = Clock::end_s(&scenario);
        self.run = LiveRun::new(scenario);
        self.run.set_overlay(shows_exact);
        self.hurries = false;
        self.until = None;
        self.stop = self.next_stop();
    }

    /// Replaces the scenario by one that leads to the same numbers at every step: another title, length or `[view]`.
    pub fn describe_as(&mut self, scenario: &Arc<Scenario>) {
        self.run.adopt(scenario);
        self.renew_stop();
    }

    /// Plays the simulated time that is due after `wall` of wall time, but steps no longer than 12 ms after `now`, as `clock`
    /// tells it; on its way to a step, 40 ms. Returns why the playback stopped, if it did.
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
        let longest = if self.hurries { HURRYING } else { STEPPING };
        self.play(owed_s, wall, || clock() >= now + longest)
    }

    /// Plays to the requested step, or until the condition holds, however long that takes, or until `enough` returns true.
    /// Returns why the playback stopped; `None` if nothing was requested, or there is more to play.
    pub fn finish_part(&mut self, enough: impl FnMut() -> bool) -> Option<Halt> {
        if self.hurries || self.until.is_some() {
            self.play(f64::INFINITY, Duration::ZERO, enough)
        } else {
            None
        }
    }

    /// Plays `owed_s` of simulated time, or until `enough` returns true. Returns why the playback stopped, if it did.
    fn play(&mut self, owed_s: f64, wall: Duration, enough: impl FnMut() -> bool) -> Option<Halt> {
        let end = if self.hurries {
            self.run.play(f64::INFINITY, self.stop, enough, |_| false)
        } else {
            let begin_s = self.run.now().time_s;
            let mut until = self.until.as_mut();
            let end = self.run.play(owed_s, self.stop, enough, |run| {
                until.as_mut().is_some_and(|until| until(run))
            });
            let stepped_s = self.run.now().time_s - begin_s;
            self.pace.spend(stepped_s, wall, end == PlayEnd::CutShort);
            end
        };
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

    /// Starts playing at its pace until `condition` holds; then it stops. It does not stop at the end of the scenario's
    /// run, and gives up after ten million steps. Returns false, and does not start, if the condition holds already.
    pub fn run_until(&mut self, mut condition: Condition) -> bool {
        self.set_running(false);
        if condition(&mut self.run) {
            return false;
        }
        self.set_running(true);
        self.stop = self.step_number().saturating_add(MOST_UNTIL);
        self.until = Some(condition);
        true
    }

    pub fn stops_at(&self) -> u64 {
        self.stop
    }

    /// Whether it stands still at the last step of the scenario's run, or later.
    pub fn is_at_end(&self) -> bool {
        !self.is_running() && self.step_number() >= self.end_step()
    }

    pub fn is_running_until(&self) -> bool {
        self.until.is_some()
    }

    /// Advances the exact motion towards the run's time, if it is shown, for at most its share of the computing time.
    pub fn follow_exact(&mut self, clock: &mut dyn FnMut() -> Duration) {
        let share = if self.is_flat_out() {
            FOLLOWING_FLAT_OUT
        } else {
            EXACT_BUDGET
        };
        let deadline = clock() + share;
        self.run.follow_exact(|| clock() >= deadline);
    }

    /// Advances the exact motion to the run's time, if it is shown, however long that takes.
    pub fn catch_up_exact(&mut self) {
        self.run.follow_exact(|| false);
    }

    /// From now on it goes on at the end of the scenario's run.
    pub fn play_on(&mut self) {
        self.is_endless = true;
        self.renew_stop();
    }

    pub fn is_endless(&self) -> bool {
        self.is_endless
    }

    /// The last step of the scenario's run; once the run has reached it, there is no further stop.
    fn next_stop(&self) -> u64 {
        let end = self.end_step();
        if self.step_number() < end && !self.is_endless {
            end
        } else {
            u64::MAX
        }
    }

    /// Lets the run go on or stops it, and cancels any requested steps or condition.
    pub fn set_running(&mut self, running: bool) {
        if self.hurries || self.until.is_some() {
            self.run.stay();
            self.hurries = false;
            self.until = None;
            self.stop = self.next_stop();
        }
        self.pace.set_running(running);
    }

    pub fn steps_to_go(&self) -> Option<u64> {
        self.hurries
            .then(|| self.stop.saturating_sub(self.step_number()))
    }

    pub fn set_speed(&mut self, speed: Speed) {
        self.pace.set_speed(speed);
    }

    pub fn speed(&self) -> Speed {
        self.pace.speed
    }

    pub fn set_exact(&mut self, shown: bool) {
        self.run.set_overlay(shown);
    }

    pub fn read(&mut self) -> Reading {
        Reading::new(&mut self.run, &self.pace)
    }

    pub fn step_number(&self) -> u64 {
        self.run.simulation().step_number()
    }

    pub fn workings(&mut self) -> Option<Arc<Workings>> {
        self.run.workings()
    }

    pub fn keep_workings(&mut self, kept: bool) {
        self.run.keep_workings(kept);
    }

    pub fn run(&self) -> &LiveRun {
        &self.run
    }

    pub fn is_running(&self) -> bool {
        self.pace.is_running
    }

    /// Whether the picture changes with time: the run goes on, or something is being computed.
    pub fn is_busy(&self) -> bool {
        self.pace.is_running || self.hurries || self.run.overlay_is_behind()
    }

    /// Whether it computes without pause, so that the loop should not wait for the next frame.
    pub fn is_flat_out(&self) -> bool {
        let catches_up = !self.pace.is_running && self.run.overlay_is_behind();
        self.hurries || catches_up || (self.pace.is_running && self.pace.speed == Speed::Top)
    }
}

/// The greatest [cost](Playback::cost) of returning to a step within one frame; it takes about 0.2 s.
const MOST_COST_PER_FRAME: u64 = 100_000_000;
/// The greatest cost of steps that are taken before the next key is read, so that keys that arrive together act one by
/// one; it takes a few milliseconds.
const MOST_COST_PER_KEY: u64 = 1_000_000;
/// The same for the steps of an edit, after which the run is played to the time at which it stood: about 50 ms for the
/// first one, and a little less for each further nudge of a held key.
const MOST_COST_PER_EDIT: u64 = 10_000_000;
const MOST_COST_PER_NUDGE: u64 = 8_000_000;
/// The longest time that all of these may take, if their cost was underestimated: a push makes a step dear that is reckoned
/// from the state before it. The other steps are then taken over the next frames.
const LONGEST_AT_ONCE: Duration = Duration::from_millis(200);

impl Playback {
    /// Steps the run to `step` before returning.
    ///
    /// # Errors
    /// When the numbers stop being finite on the way.
    pub fn begin_at(&mut self, step: u64) -> Result<(), NotFinite> {
        self.begin_at_while(step, |_, _| ControlFlow::Continue(()))
    }

    /// As [`begin_at`](Self::begin_at), as long as `go_on` says so: it gets the step reached and `step`, about ten times a
    /// second.
    ///
    /// # Errors
    /// When the numbers stop being finite on the way.
    pub fn begin_at_while(
        &mut self,
        step: u64,
        go_on: impl Fn(u64, u64) -> ControlFlow<()>,
    ) -> Result<(), NotFinite> {
        const SEEK_BUDGET: Duration = Duration::from_millis(100);
        while self.step_number() < step && go_on(self.step_number(), step).is_continue() {
            self.step_for(SEEK_BUDGET, step)?;
        }
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
        let running = self.pace.is_running;
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
        let _ = self.step_at_once(first); // a failed step is tried again by advance(), which reports it
        self.hurries = self.step_number() < self.stop;
        if !self.hurries {
            self.stop = self.next_stop();
        }
    }

    /// Steps the run to its destination, either before returning or, if that takes too long, over the next frames.
    fn arrive(&mut self) {
        let is_near = |to: u64| self.cost(to - self.step_number()) <= MOST_COST_PER_FRAME;
        if let Some(to) = self.run.destination().filter(|to| is_near(*to)) {
            let _ = self.step_at_once(to); // it has been there before: its numbers are finite
        }
        self.stop = self.run.destination().unwrap_or(self.next_stop());
        self.hurries = self.run.destination().is_some();
    }

    /// Steps the run to `step`. Where steps may have to be integrated, their cost is not known, and this takes little more
    /// than [`LONGEST_AT_ONCE`]; elsewhere what one key does depends on no clock.
    fn step_at_once(&mut self, step: u64) -> Result<(), NotFinite> {
        if has_closed_form(self.run.scenario()) {
            self.run.step_to(step, || false)
        } else {
            self.step_for(LONGEST_AT_ONCE, step)
        }
    }

    /// Steps the run to `step`, but for little more than `longest`.
    fn step_for(&mut self, longest: Duration, step: u64) -> Result<(), NotFinite> {
        let (clock, begin) = (self.clock, (self.clock)());
        self.run.step_to(step, || clock() >= begin + longest)
    }

    /// The cost of `steps` like the next one. A later one may cost far more.
    fn cost(&self, steps: u64) -> u64 {
        steps.saturating_mul(self.run.cost_of_a_step())
    }
}
