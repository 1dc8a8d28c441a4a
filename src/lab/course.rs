//! Commands about the course of the run: steps, going to a place or a condition, play and pause, and the speed.

use super::answer::{Answer, Done, UnderWay};
use super::command::Place;
use super::numbers::{self, Numbers};
use super::player::Player;
use crate::analysis::cost;
use crate::journal::expression::Expression;
use crate::journal::restart::scenario_from;
use crate::playback::Halt;
use crate::playback::live::LiveRun;
use crate::playback::pace::Speed;
use crate::run::Simulation;
use indicatif::HumanCount;

/// If a step takes longer than this at the chosen speed, s, a message says so.
const LONG_STEP_S: f64 = 3.0;

impl Player {
    pub(super) fn step(&mut self, steps: i64) -> Answer {
        let here = self.playback.step_number();
        self.heading = None;
        match steps {
            1 => self.take_one_step(),
            0.. => self.playback.take_steps(steps.unsigned_abs()),
            _ if here == 0 => return Err("the run begins here".into()),
            _ => self
                .playback
                .go_to(here.saturating_sub(steps.unsigned_abs())),
        }
        Ok(Done::SILENT.going_on(UnderWay::Going))
    }

    pub(super) fn go_to(&mut self, place: Place) -> Answer {
        let step = self.step_of(place)?;
        self.heading = None;
        let end = self.playback.end_step();
        let is_beyond = step > end && step > self.run().furthest();
        self.playback.go_to(step);
        let (step, end) = (HumanCount(step), HumanCount(end));
        let said = is_beyond.then(|| {
            format!(
                "step {step} is beyond the end of the run, step {end}: it is played on to there"
            )
        });
        Ok(Done::saying_any(said).going_on(UnderWay::Going))
    }

    pub(super) fn step_of(&self, place: Place) -> Result<u64, String> {
        match place {
            Place::Step(step) => Ok(step),
            Place::Time(time_s) => self.step_at(time_s),
            Place::Start => Ok(0),
            Place::End => Ok(self.playback.end_step()),
        }
    }

    /// The step at `time_s`.
    fn step_at(&self, time_s: f64) -> Result<u64, String> {
        if time_s >= 0.0 && time_s.is_finite() {
            Ok(Simulation::step_at(self.run().scenario(), time_s))
        } else {
            Err("must be a time from 0 s on: the run begins there".to_owned())
        }
    }

    pub(super) fn run_until(&mut self, condition: &Expression) -> Answer {
        let run = self.run();
        let sources = condition
            .bind(|name| numbers::find(name, Some(run)))
            .map_err(|fault| fault.to_string())?;
        let condition = condition.clone();
        self.heading = None;
        let mut numbers = Numbers::default();
        let holds = move |run: &mut LiveRun| {
            let mut now = numbers.at(run);
            let value = condition.value_at(|index| now.value(&sources[index]));
            value.is_some_and(|value| value != 0.0)
        };
        Ok(if self.playback.run_until(Box::new(holds)) {
            Done::SILENT.going_on(UnderWay::Playing)
        } else {
            Done::saying("it holds already, at this step")
        })
    }

    /// Whether it plays, or takes steps that were asked for.
    pub(super) fn is_moving(&self) -> bool {
        self.playback.is_running() || self.playback.steps_to_go().is_some()
    }

    /// The speed `notches` places higher, or lower, in the list of speeds.
    pub(super) fn other_speed(&self, notches: i32) -> Result<Speed, String> {
        let now = self.playback.speed();
        match now.shifted(notches) {
            next if next != now => Ok(next),
            Speed::Top => Err("this is the top speed".to_owned()),
            Speed::Times(_) if notches > 0 => Err("this is the top speed".to_owned()),
            Speed::Times(_) => Err("this is the lowest speed; . takes a single step".to_owned()),
        }
    }

    /// The scenario that starts from the present state, as TOML.
    pub(super) fn present_as_text(&self) -> Result<String, String> {
        let run = self.run().simulation();
        let scenario = scenario_from(run.scenario(), run.state(), run.step_number())
            .map_err(|problems| problems.in_one_line())?;
        toml::to_string(&scenario.file).map_err(|error| error.to_string())
    }

    /// Lets the run go on.
    pub(super) fn play(&mut self) -> Done {
        self.heading = None;
        self.playback.set_running(true);
        Done::SILENT
    }

    pub(super) fn pause(&mut self) -> Done {
        let to_go = self.playback.steps_to_go();
        self.heading = None;
        self.playback.set_running(false);
        let to_go = to_go.map(HumanCount);
        Done::saying_any(to_go.map(|left| format!("stopped with {left} steps to go")))
    }

    pub(super) fn set_speed(&mut self, speed: Speed) -> Done {
        self.playback.set_speed(speed);
        let Speed::Times(speed) = speed else {
            return Done::SILENT;
        };
        let wall_s = self.run().simulation().motion().time_step_s / speed;
        let is_long = wall_s > LONG_STEP_S;
        let said = || format!("a step takes {wall_s:.0} s at this speed; . takes one now");
        Done::saying_any(is_long.then(said))
    }

    pub(super) fn set_exact(&mut self, shown: bool) -> Done {
        if shown != self.run().shows_exact() {
            self.playback.set_exact(shown);
        }
        if !shown {
            return Done::saying("without the exact motion");
        }
        Done::saying(match cost::objection(self.run().scenario()) {
            Some(objection) => format!("{objection}: it is left out; a shorter run has it"),
            None => {
                "the exact motion (same start, same pushes) is dashed; t takes it away".to_owned()
            }
        })
    }

    /// The message while steps are taken.
    pub(super) fn in_words(&self) -> Option<String> {
        let left = HumanCount(self.playback.steps_to_go()?);
        Some(if self.is_replaying() {
            format!("playing the new run to the same time: {left} steps to go, Esc stops")
        } else {
            format!("stepping: {left} to go, Esc stops")
        })
    }
}

/// The message about a run that has stopped by itself, if it needs one.
pub(super) fn halt_in_words(halt: Halt) -> Option<String> {
    match halt {
        Halt::StepsTaken | Halt::Fulfilled => None,
        Halt::NotFulfilled(steps) => Some(format!(
            "what the run was played to did not come true in {} steps",
            HumanCount(steps)
        )),
        Halt::EndOfRun => {
            Some("end of the scenario's run: space goes on, r begins again".to_owned())
        }
        Halt::NotFinite(error) => Some(format!("{} at step {}", error.fact(), error.step)),
    }
}

/// What the user may type to say where to go.
pub(super) const WHERE: &str =
    "a step (421), a time (12.5 s), so many on or back (+50, -2 s), start or end";

impl Player {
    /// The step that `text` means, seen from where the run stands.
    pub(super) fn step_meant(&self, text: &str) -> Result<u64, String> {
        let text = text.trim();
        let (here, here_s) = (self.playback.step_number(), self.run().now().time_s);
        let sign = text.chars().next().filter(|sign| "+-".contains(*sign));
        let size = Place::parse(&text[sign.map_or(0, char::len_utf8)..]);
        // With a sign it counts from here.
        match (sign, size) {
            (None, Some(place)) => self.step_of(place),
            (Some('+'), Some(Place::Step(steps))) => Ok(here.saturating_add(steps)),
            (_, Some(Place::Step(steps))) => Ok(here.saturating_sub(steps)),
            (Some('+'), Some(Place::Time(time_s))) => self.step_at(here_s + time_s),
            (_, Some(Place::Time(time_s))) => self.step_at(here_s - time_s),
            (None, None) if text.contains('.') && !text.ends_with('s') => {
                Err("must be a whole number of steps, or a time such as 12.5 s".to_owned())
            }
            _ => Err(format!("must be {WHERE}")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::for_tests::scenario;

    #[test]
    fn steps_and_places_lead_where_they_say() {
        let mut player = Player::new(scenario(), false);
        assert!(player.step(-1).is_err());
        player.step(7).unwrap();
        assert_eq!(player.playback.step_number(), 7);
        for (place, step) in [
            (Place::Time(1.5), 15),
            (Place::Step(3), 3),
            (Place::End, 2300),
            (Place::Start, 0),
        ] {
            player.go_to(place).unwrap();
            player.playback.finish_part(|| false);
            assert_eq!(player.playback.step_number(), step, "{place:?}");
        }
        assert!(player.step_at(-1.0).is_err() && player.step_at(f64::NAN).is_err());
    }

    #[test]
    fn a_condition_that_holds_already_begins_nothing() {
        let mut player = Player::new(scenario(), false);
        let holding = Expression::condition("measured_highest_tilt_deg > 1").unwrap();
        let done = player.run_until(&holding).unwrap();
        assert_eq!(
            (done.under_way, player.playback.is_running()),
            (None, false)
        );
        let later = Expression::condition("steps >= 9").unwrap();
        let done = player.run_until(&later).unwrap();
        assert_eq!(done.under_way, Some(UnderWay::Playing));
        assert_eq!(player.playback.finish_part(|| false), Some(Halt::Fulfilled));
        assert_eq!(player.playback.step_number(), 9);
    }

    #[test]
    fn steps_and_times_count_from_the_start_or_from_here() {
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
