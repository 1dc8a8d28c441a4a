//! Through the run: at which speed, back, and to any step or time.

use super::{Lab, dialogs::Asking};
use crate::observe::pace::Speed;
use crate::run::Simulation;
use crate::tui::keymap::Mode;
use indicatif::HumanCount;

/// A step that takes longer than this is announced, s.
const LONG_STEP_S: f64 = 3.0;
/// What the user may type to say where to go.
const WHERE: &str = "a step (421), a time (12.5 s), so many on or back (+50, -2 s), start or end";

impl Lab {
    pub(super) fn toggle_pause(&mut self) {
        if !self.stop_steps() {
            self.playback.set_running(!self.playback.is_running());
        }
    }

    /// Stops on the way through the steps that were asked for; gives whether it was there.
    pub(super) fn stop_steps(&mut self) -> bool {
        let Some(left) = self.playback.steps_to_go() else {
            return false;
        };
        self.playback.set_running(false);
        self.say(format!("stopped with {} steps to go", HumanCount(left)));
        true
    }

    /// Another speed; says so where there is none, or where it lets nothing be seen for a while.
    pub(super) fn shift_speed(&mut self, notches: i32) {
        let before = self.playback.speed();
        self.playback.shift_speed(notches);
        match self.playback.speed() {
            now if now == before && notches > 0 => self.say("this is the top speed"),
            now if now == before => self.say("this is the lowest speed; . takes a single step"),
            Speed::Times(speed) => self.announce_step(speed),
            Speed::Top => {}
        }
    }

    fn announce_step(&mut self, speed: f64) {
        let wall_s = self.run().simulation().motion().time_step_s / speed;
        if wall_s > LONG_STEP_S {
            self.say(format!(
                "a step takes {wall_s:.0} s at this speed; . takes one now"
            ));
        }
    }

    pub(super) fn step_back(&mut self, steps: u64) {
        let here = self.playback.step_number();
        match here {
            0 => self.say("the run begins here"),
            _ => self.playback.go_to(here.saturating_sub(steps)),
        }
    }

    /// Goes to the step that was `counted`, or asks for one.
    pub(super) fn ask_where_to_go(&mut self, counted: Option<u64>) {
        match counted {
            Some(step) => self.playback.go_to(step),
            None => self.ask(
                Asking::GoTo,
                "go to a step or a time",
                &[("to", String::new())],
                &[WHERE],
            ),
        }
    }

    /// Goes where `text` says.
    ///
    /// # Errors
    /// Why that is nowhere.
    pub(super) fn go_where(&mut self, text: &str) -> Result<(), String> {
        let step = self.step_meant(text.trim())?;
        self.mode = Mode::Lab;
        self.playback.go_to(step);
        Ok(())
    }

    fn step_meant(&self, text: &str) -> Result<u64, String> {
        let here = self.playback.step_number();
        let wrong = || format!("must be {WHERE}");
        let digits = text.trim_start_matches(['+', '-']);
        if let Some(time) = text.strip_suffix('s') {
            let time_s: f64 = time.trim().parse().map_err(|_| wrong())?;
            // With a sign it counts from here, as steps do.
            let from_s = if digits == text {
                0.0
            } else {
                self.run().now().time_s
            };
            return self.step_at(from_s + time_s);
        }
        match text {
            "start" => Ok(0),
            "end" => Ok(self.playback.end_step()),
            _ if text.starts_with('+') => whole(digits)
                .map(|steps| here.saturating_add(steps))
                .ok_or_else(wrong),
            _ if text.starts_with('-') => whole(digits)
                .map(|steps| here.saturating_sub(steps))
                .ok_or_else(wrong),
            _ if text.contains('.') => {
                Err("must be a whole number of steps, or a time such as 12.5 s".to_owned())
            }
            _ => whole(text).ok_or_else(wrong),
        }
    }

    fn step_at(&self, time_s: f64) -> Result<u64, String> {
        match time_s >= 0.0 && time_s.is_finite() {
            true => Ok(Simulation::step_at(self.run().scenario(), time_s)),
            false => Err("must be a time from 0 s on: the run begins there".to_owned()),
        }
    }
}

/// A whole number, also as 1e7.
fn whole(text: &str) -> Option<u64> {
    /// Floats are exact whole numbers up to here.
    const EXACT: f64 = 9e15;
    let float = || {
        text.parse()
            .ok()
            .filter(|number: &f64| number.fract() == 0.0 && (0.0..=EXACT).contains(number))
    };
    text.parse().ok().or_else(|| Some(float()? as u64))
}
