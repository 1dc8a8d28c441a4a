//! The view of the traces: the time that they show, the magnification of their values, and the cursor.

use super::Lab;
use super::action::Direction;
use super::answer::{Answer, Done};
use super::command::{Command, CursorTo, MOST_MAGNIFIED, Place};
use super::steering::signed;
use super::view::View;
use crate::playback::lookup;
use crate::playback::recording::Curve;
use crate::playback::strip::Strip;
use crate::scenario::screen::AUTO;

/// The share of the window by which a key moves the cursor, and by which it moves the window.
const CURSOR_SHARE: f64 = 0.02;
const PAN_SHARE: f64 = 0.5;

impl View {
    pub(super) fn set_since(&mut self, since_s: Option<f64>) -> Done {
        self.since_s = since_s;
        Done::saying(match since_s {
            Some(since_s) => format!("the traces begin at {since_s} s; Home shows the run again"),
            None => "the traces follow the run".to_owned(),
        })
    }

    pub(super) fn magnify(&mut self, times: f64) -> Done {
        self.magnified = times;
        Done::saying(if times > 1.0 {
            format!("values are magnified {times} times; Home shows all of them again")
        } else {
            "values are shown in full".to_owned()
        })
    }
}

impl Lab {
    /// Shows twice the time in the traces (`wider`), or half of it; where less than two time steps would remain, says
    /// which time is shown.
    pub(super) fn change_window(&mut self, wider: bool) {
        let time_step_s = self.player.run().simulation().motion().time_step_s;
        let window_s = self.view.window_s * if wider { 2.0 } else { 0.5 };
        if window_s >= 2.0 * time_step_s && window_s.is_finite() {
            self.carry_out_all(&[Command::look("window_s", window_s)]);
        } else {
            self.say(format!("the traces show {} s", self.view.window_s));
        }
    }

    /// The command that shows another curve in the strip of the fast motion than it shows now.
    pub(super) fn other_detail(&self, direction: Direction, times: i32) -> Command {
        let shown = self.view.detail_of.unwrap_or(self.player.detail.curve);
        let curves = [Curve::X, Curve::Y, Curve::Z, Curve::Tilt];
        let now = curves.iter().position(|curve| *curve == shown).unwrap_or(0) as i32;
        let by = match direction {
            Direction::Up | Direction::PageUp => -times,
            _ => times,
        };
        let next = (now + by).rem_euclid(curves.len() as i32) as usize;
        Command::look("detail_of", curves[next])
    }

    fn cursor_or_here(&self) -> u64 {
        let here = self.player.playback.step_number();
        self.view.cursor.unwrap_or(here)
    }

    pub(super) fn set_cursor(&mut self, to: CursorTo) -> Answer {
        let run = self.player.run();
        let here = self.cursor_or_here();
        let turn = |forward| {
            let found = lookup::turn(run, here, forward);
            found.map(Some).map_err(|missing| missing.to_string())
        };
        let step = match to {
            CursorTo::Nowhere => None,
            CursorTo::Place(Place::End) => Some(run.furthest()),
            CursorTo::Place(place) => Some(self.player.step_of(place)?),
            CursorTo::NextTurn => turn(true)?,
            CursorTo::TurnBefore => turn(false)?,
        };
        let step = step.map(|step| step.min(run.furthest()));
        if let Some(step) = step {
            let sample = lookup::sample(run, step).map_err(|missing| missing.to_string())?;
            self.show_time(sample.time_s);
        }
        self.view.cursor = step;
        Ok(Done::SILENT)
    }

    /// The time at the left edge of the traces, s.
    fn begin_s(&self) -> f64 {
        let (now_s, window_s) = (self.player.run().now().time_s, self.view.window_s);
        let following = || Strip::following(now_s, window_s, 1).begin_s;
        self.view.since_s.unwrap_or_else(following)
    }

    fn show_time(&mut self, time_s: f64) {
        let (begin_s, window_s) = (self.begin_s(), self.view.window_s);
        if !(begin_s..=begin_s + window_s).contains(&time_s) {
            self.view.since_s = Some((time_s - 0.5 * window_s).max(0.0));
        }
    }

    pub(super) fn moved_cursor(&self, fiftieths: i32) -> Command {
        let time_step_s = self.player.motion().time_step_s;
        let steps = CURSOR_SHARE * self.view.window_s / time_step_s;
        self.stepped_cursor(steps.round().max(1.0) as i64 * i64::from(fiftieths))
    }

    pub(super) fn stepped_cursor(&self, steps: i64) -> Command {
        let step = self.cursor_or_here().saturating_add_signed(steps);
        Command::Cursor(CursorTo::Place(Place::Step(step)))
    }

    /// The command that moves the window to earlier or later times, by half its length.
    pub(super) fn panned(&self, direction: Direction, times: i32) -> Command {
        let by_s = PAN_SHARE * self.view.window_s * f64::from(signed(direction, times));
        Command::Since(Some((self.begin_s() + by_s).max(0.0)))
    }

    /// The command that doubles the magnification `notches` times, or halves it.
    pub(super) fn magnified(&self, notches: i32) -> Command {
        let times = self.view.magnified * 2_f64.powi(notches);
        Command::Magnify(times.clamp(1.0, MOST_MAGNIFIED))
    }

    /// The commands that show the run again, after the time or the values were chosen by hand.
    pub(super) fn whole_view(&self) -> Vec<Command> {
        let usual_s = self.view.usual_window_s(self.player.run().scenario());
        vec![
            Command::look("detail_of", AUTO),
            Command::Cursor(CursorTo::Nowhere),
            Command::Magnify(1.0),
            Command::look("window_s", usual_s),
            Command::Since(None),
        ]
    }
}
