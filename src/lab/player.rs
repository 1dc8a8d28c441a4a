//! The player of the run on the screen: its step, its speed, the cursor on its traces, and the numbers read from it.
//!
//! `seek` moves the run: to a step, or forward as time passes. `replay` plays a run that an edit restarted up to the
//! time of the previous run. `window` chooses the time that the traces show.

mod replay;
mod seek;
mod window;

use super::answer::{ActionResult, Done, PendingAction};
use super::command::{Command, SeekTarget};
use super::numbers::{self, NumberSource, RunNumbers};
use super::view::View;
use crate::engine::journal::expression::Expression;
use crate::engine::journal::restart::{in_force, scenario_from};
use crate::engine::run::{Clock, Moment, Sample, Simulation};
use crate::engine::scenario::{Motion, Scenario};
use crate::lab::playback::live::LiveRun;
use crate::lab::playback::lookup::{self, StepNumbers};
use crate::lab::playback::pace::{Pace, Speed};
use crate::lab::playback::reading::{READING_INTERVAL, Reading};
use indicatif::HumanCount;
use replay::Replay;
pub(super) use replay::furthest_s;
use seek::Goal;
pub use seek::SeekPurpose;
pub(super) use seek::{Halt, MOST_UNTIL};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Wall-clock time of a step at the chosen speed above which a message warns the user, s.
const LONG_STEP_S: f64 = 3.0;

/// How the run on the screen changes to another scenario.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum RunChange {
    /// A scenario with the same numbers at every step: another title, length or `[view]`.
    Described,
    /// A change from the present step on.
    GoesOn,
    /// A change from this step on, where an edit was undone or redone.
    ContinuesAt(u64),
    /// A change from the start, replayed to the present time: by an edit at step 0 of the same journal (`is_act`), or
    /// in a new run.
    ///
    /// `is_again` is true if the edit is one more nudge of the same value.
    BeginsAnew { is_act: bool, is_again: bool },
    /// A return to the run before or after in the journal, which was left at this step.
    Returns { left_at: u64, is_of_same_name: bool },
    /// A scenario that was opened, paused at step 0.
    Opens,
}

impl RunChange {
    /// Returns true if the run was opened under a different name than the previous one.
    pub(super) fn is_of_other_name(self) -> bool {
        use RunChange::{Opens, Returns};
        matches!(
            self,
            Opens
                | Returns {
                    is_of_same_name: false,
                    ..
                }
        )
    }
}

/// The numbers at the cursor.
struct CursorNumbers {
    /// The scenario of their run.
    scenario: Arc<Scenario>,
    run: StepNumbers,
    /// The exact motion at the same time; `None` if it is unknown.
    exact: Option<Moment>,
}

/// The run, its speed, its goal, and its latest reading.
pub struct Player {
    pub(super) run: LiveRun,
    pace: Pace,
    goal: Option<Goal>,
    /// The time at which the run ends, s.
    pub end_s: f64,
    /// Clock that limits the duration of stepping before a function returns.
    clock: fn() -> Instant,
    /// The replay after the last edit that restarted the run; `None` after any other edit.
    replay: Option<Replay>,
    pub reading: Reading,
    read_at: Duration,
    /// Time at which the window of the traces was last fixed.
    window_held_at: Duration,
    seen_swing: Option<window::SeenSwing>,
    at_cursor: Option<CursorNumbers>,
    /// True if a single step keeps its intermediate results until they are read.
    pub(super) keeps_workings: bool,
}

impl Player {
    /// Creates a player of the run of `scenario` at step 0. It shows the exact motion if the scenario's `[view]` says
    /// so.
    pub fn new(scenario: Arc<Scenario>, running: bool) -> Self {
        let pace = Pace::of_scenario(&scenario, running);
        let end_s = Clock::end_s(&scenario);
        let exact = begins_with_exact(&scenario).unwrap_or(false);
        let mut run = LiveRun::new(scenario);
        run.set_overlay(exact);
        let reading = Reading::new(&mut run, &pace);
        Self {
            window_held_at: Duration::ZERO,
            seen_swing: None,
            run,
            pace,
            goal: None,
            end_s,
            clock: Instant::now,
            replay: None,
            reading,
            read_at: Duration::ZERO,
            at_cursor: None,
            keeps_workings: false,
        }
    }

    /// Changes to the run of `scenario`, which ends at `end_s`.
    pub(super) fn change_run(&mut self, change: RunChange, scenario: &Arc<Scenario>, end_s: f64) {
        if !matches!(change, RunChange::Described | RunChange::BeginsAnew { .. }) {
            self.replay = None;
        }
        match change {
            RunChange::Described => self.run.replace_metadata(scenario),
            RunChange::GoesOn => {
                let running = self.is_running();
                self.branch_at(self.step_number(), scenario);
                if self.goal.is_none() {
                    self.set_running(running);
                }
            }
            RunChange::ContinuesAt(step) => self.branch_at(step, scenario),
            RunChange::BeginsAnew { is_act, is_again } => {
                let replay = self.next_replay(is_act, is_again);
                if is_act {
                    self.branch_at(0, scenario);
                } else {
                    self.restart(scenario);
                }
                self.begin_replay(replay, is_again);
            }
            _ if change.is_of_other_name() => self.open(scenario),
            RunChange::Returns { .. } | RunChange::Opens => self.restart(scenario),
        }
        self.end_s = end_s;
        if let RunChange::Returns { left_at, .. } = change {
            self.seek(left_at, SeekPurpose::Resume);
        }
    }

    /// Starts the run of another `scenario`. Speed, pause and the display of the exact motion stay as they are.
    pub(super) fn restart(&mut self, scenario: &Arc<Scenario>) {
        let shows_exact = self.run.shows_exact();
        self.run = LiveRun::new(Arc::clone(scenario));
        self.run.set_overlay(shows_exact);
        self.goal = None;
        self.end_s = Clock::end_s(scenario);
    }

    /// Starts the run of `scenario`, paused, with the speed and display that its `[view]` says.
    fn open(&mut self, scenario: &Arc<Scenario>) {
        self.pace = Pace::of_scenario(scenario, false);
        self.restart(scenario);
        if let Some(exact) = begins_with_exact(scenario) {
            self.run.set_overlay(exact);
        }
    }

    /// Seeks `step`, at which a session left the run, and restores its speed, end (s) and display of the exact motion.
    pub(super) fn resume(&mut self, step: u64, speed: Speed, shows_exact: bool, end_s: f64) {
        self.end_s = end_s;
        self.pace.set_speed(speed);
        self.run.set_overlay(shows_exact);
        self.seek(step, SeekPurpose::Resume);
    }

    pub(super) fn step(&mut self, steps: i64) -> ActionResult {
        let here = self.step_number();
        match steps {
            0.. => {
                // The step pane then need not take the step a second time.
                if steps == 1 {
                    self.run.keep_workings(self.keeps_workings);
                }
                self.take_steps(steps.unsigned_abs(), SeekPurpose::Command);
            }
            _ if here == 0 => return Err("the run begins here".into()),
            _ => self.seek(
                here.saturating_sub(steps.unsigned_abs()),
                SeekPurpose::Command,
            ),
        }
        Ok(Done::SILENT.going_on(PendingAction::Going))
    }

    pub(super) fn go_to(&mut self, place: SeekTarget) -> ActionResult {
        let step = self.step_of(place)?;
        let end = self.end_step();
        let is_beyond = step > end && step > self.run.furthest();
        self.seek(step, SeekPurpose::Command);
        let said = is_beyond.then(|| {
            let (step, end) = (HumanCount(step), HumanCount(end));
            format!("step {step} is beyond the end of the run, step {end}: playing on to it")
        });
        Ok(Done::saying_any(said).going_on(PendingAction::Going))
    }

    pub(super) fn step_of(&self, place: SeekTarget) -> Result<u64, String> {
        match place {
            SeekTarget::Step(step) => Ok(step),
            SeekTarget::Time(time_s) => self.step_at(time_s),
            SeekTarget::Start => Ok(0),
            SeekTarget::End => Ok(self.end_step()),
        }
    }

    fn step_at(&self, time_s: f64) -> Result<u64, String> {
        if time_s >= 0.0 && time_s.is_finite() {
            Ok(Simulation::step_at(self.run().scenario(), time_s))
        } else {
            Err("must be a time from 0 s on, where the run begins".to_owned())
        }
    }

    /// Returns the step that `typed` means at the present step.
    pub(super) fn step_meant(&self, typed: &str) -> Result<u64, String> {
        let text = typed.trim();
        let (here, here_s) = (self.step_number(), self.run().now().time_s);
        let sign = text.chars().next().filter(|sign| "+-".contains(*sign));
        let size = SeekTarget::parse(&text[sign.map_or(0, char::len_utf8)..]);
        // A number with a sign counts from the present step.
        match (sign, size) {
            (None, Some(place)) => self.step_of(place),
            (Some('+'), Some(SeekTarget::Step(steps))) => Ok(here.saturating_add(steps)),
            (_, Some(SeekTarget::Step(steps))) => Ok(here.saturating_sub(steps)),
            (Some('+'), Some(SeekTarget::Time(time_s))) => self.step_at(here_s + time_s),
            (_, Some(SeekTarget::Time(time_s))) => self.step_at(here_s - time_s),
            (None, None) if text.contains('.') && !text.ends_with('s') => {
                Err("must be a whole number of steps, or a time such as 12.5 s".to_owned())
            }
            _ => Err(format!("must be {WHERE}")),
        }
    }

    pub(super) fn run_until(&mut self, condition: &Expression) -> ActionResult {
        let sources = condition
            .bind(|name| numbers::find(name, Some(&self.run)))
            .map_err(|fault| fault.to_string())?;
        let (expression, mut numbers) = (condition.clone(), RunNumbers::default());
        let is_played = self.play_until(Box::new(move |run| {
            let mut now = numbers.at(run);
            let value = expression.value_at(|index| now.value(&sources[index]));
            value.is_some_and(|value| value != 0.0)
        }));
        Ok(if is_played {
            Done::SILENT.going_on(PendingAction::Playing)
        } else {
            Done::saying("the condition holds already, at this step")
        })
    }

    pub(super) fn pause(&mut self) -> Done {
        let to_go = self.steps_to_go().map(HumanCount);
        self.set_running(false);
        Done::saying_any(to_go.map(|left| format!("stopped with {left} steps to go")))
    }

    pub(super) fn set_speed(&mut self, speed: Speed) -> Done {
        self.pace.set_speed(speed);
        let Speed::Times(speed) = speed else {
            return Done::SILENT;
        };
        let wall_s = self.run().simulation().motion().time_step_s / speed;
        Done::saying_any(
            (wall_s > LONG_STEP_S)
                .then(|| format!("a step takes {wall_s:.0} s at this speed; . takes one now")),
        )
    }

    /// Returns the command for the speed that is `notches` places higher in the list of speeds, or lower if negative.
    ///
    /// # Errors
    /// Returns an error if there is no such speed.
    pub fn other_speed(&self, notches: i32) -> Result<Command, String> {
        let now = self.speed();
        match now.shifted(notches) {
            next if next != now => Ok(Command::Speed(next)),
            Speed::Times(_) if notches <= 0 => {
                Err("this is the lowest speed; . takes a single step".to_owned())
            }
            _ => Err("this is the top speed".to_owned()),
        }
    }

    pub fn speed(&self) -> Speed {
        self.pace.speed
    }

    pub fn is_running(&self) -> bool {
        self.pace.is_running
    }

    pub fn step_number(&self) -> u64 {
        self.run.simulation().step_number()
    }

    pub fn end_step(&self) -> u64 {
        Simulation::step_at(self.run.scenario(), self.end_s)
    }

    /// Returns a scenario that starts from the present state, as TOML.
    pub(super) fn present_as_text(&self) -> Result<String, String> {
        let run = self.run().simulation();
        let scenario = scenario_from(run.scenario(), run.state(), run.step_number())
            .map_err(|problems| problems.in_one_line())?;
        toml::to_string(&scenario.file).map_err(|error| error.to_string())
    }

    /// Returns true if the numbers must be read again at `now`, the time since the lab was opened.
    pub(super) fn is_due(&self, now: Duration) -> bool {
        self.is_flat_out() || now >= self.read_at + READING_INTERVAL
    }

    /// Updates the reading and the numbers at the cursor.
    pub(super) fn read(&mut self, now: Duration, view: &View) {
        self.reading = Reading::new(&mut self.run, &self.pace);
        self.read_at = now;
        self.look_up_cursor(view.cursor);
    }

    /// Looks up the numbers at the cursor, unless they are known.
    fn look_up_cursor(&mut self, cursor: Option<u64>) {
        let scenario = self.run.scenario();
        if let Some(known) = &self.at_cursor
            && Some(known.run.sample.step) == cursor
            && Arc::ptr_eq(&known.scenario, scenario)
        {
            return;
        }
        let found = cursor.and_then(|step| lookup::numbers(&self.run, step).ok());
        self.at_cursor = found.map(|run| CursorNumbers {
            exact: self.exact_at(run.sample.step, run.sample.time_s),
            scenario: Arc::clone(scenario),
            run,
        });
    }

    /// Returns the exact motion at `time_s` (s), the time of `step`; `None` if it is unknown.
    fn exact_at(&self, step: u64, time_s: f64) -> Option<Moment> {
        let predictable = self.reading.readouts.health.predictability;
        let is_predictable = predictable.until_s.is_none_or(|until_s| time_s <= until_s);
        is_predictable
            .then(|| lookup::exact(&self.run, step, time_s))
            .flatten()
    }

    pub fn cursor(&self) -> Option<&Sample> {
        self.at_cursor.as_ref().map(|cursor| &cursor.run.sample)
    }

    /// Returns the run and the exact motion at the cursor.
    pub fn cursor_moments(&self) -> Option<(&Moment, Option<&Moment>)> {
        let cursor = self.at_cursor.as_ref()?;
        Some((&cursor.run.moment, cursor.exact.as_ref()))
    }

    /// Returns the latest time that the run has reached, s.
    pub fn furthest_s(&self) -> f64 {
        furthest_s(&self.run)
    }

    pub fn run(&self) -> &LiveRun {
        &self.run
    }

    /// Returns gravity, scheme and time step of the next step.
    pub fn motion(&self) -> Motion {
        let simulation = self.run().simulation();
        in_force(simulation.scenario(), simulation.step_number()).0
    }

    /// Returns the latest reading of the number called `name`; `None` if there is no such number or it has no value
    /// now.
    pub fn number(&self, name: &str) -> Option<f64> {
        let readouts = &self.reading.readouts;
        match numbers::find(name, Some(self.run())).ok()? {
            NumberSource::Column(column) => {
                Some(column.value(self.run().scenario(), &readouts.sample))
            }
            NumberSource::Readout(readout) => readout.read_from(readouts).number(),
            NumberSource::Gravity => Some(self.motion().gravity),
            NumberSource::TimeStep => Some(self.motion().time_step_s),
            NumberSource::Fixed(value) => value,
        }
        .filter(|number| number.is_finite())
    }

    /// Returns the message about a seek in progress.
    pub(super) fn in_words(&self) -> Option<String> {
        let left = HumanCount(self.steps_to_go()?);
        Some(if self.is_replaying() {
            format!("playing the new run to the same time: {left} steps to go, Esc stops")
        } else {
            format!("stepping: {left} to go, Esc stops")
        })
    }
}

/// The targets that the user may type, for messages.
pub(super) const WHERE: &str =
    "a step (421), a time (12.5 s), forward or back (+50, -2 s), start or end";

fn begins_with_exact(scenario: &Scenario) -> Option<bool> {
    scenario.file.viewed("exact")?.as_bool()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::for_tests::scenario;

    #[test]
    fn steps_and_times_are_absolute_or_relative() {
        let mut player = Player::new(scenario(), false);
        player.step(100).unwrap();
        for (text, step) in [
            ("421", 421),
            (" 1e3 ", 1000),
            ("12.5 s", 125),
            ("+50", 150),
            ("-30", 70),
            ("-300", 0),
            ("+2 s", 120),
            ("-2s", 80),
            ("start", 0),
            ("end", 2300),
        ] {
            assert_eq!(player.step_meant(text), Ok(step), "{text}");
        }
        for text in ["", "soon", "12.5", "-11 s", "nan s", "+x"] {
            assert!(player.step_meant(text).is_err(), "{text}");
        }
    }
}
