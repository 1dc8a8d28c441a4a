//! The commands that change how the run is looked at, and those that the keys of its panes mean.

use super::swings;
use super::{Pane, View};
use crate::engine::recording::RecordedCurve;
use crate::engine::run::Simulation;
use crate::engine::scenario::screen::AUTO;
use crate::lab::action::{Direction, signed};
use crate::lab::answer::{ActionResult, Done};
use crate::lab::command::{Command, CursorTo, MOST_MAGNIFIED, SeekTarget};
use crate::lab::playback::lookup;
use crate::lab::playback::strip::Strip;
use crate::lab::player::Player;
use crate::lab::step_pane::StepPane;
use crate::plot::camera::Zoom;
use toml::Table;

/// The share of the window by which a key moves the cursor, and by which it moves the window.
const CURSOR_SHARE: f64 = 0.02;
const PAN_SHARE: f64 = 0.5;
/// What is said of residuals that are shown, and that are refused.
const RESIDUALS_TEXT: &str = "measured less run, where something was measured; m shows both again";
const NO_DATA: &str = "there are no measured data beside the run: gyrolab --measured FILE";
const TURN_DEG: f64 = 10.0;

impl View {
    /// Shows the run as `patch`, keys of `[view]` and their values, says.
    pub(in crate::lab) fn look(
        &mut self,
        patch: &Table,
        player: &Player,
        step_pane: &StepPane,
    ) -> ActionResult {
        let look = self.look.patched(patch)?;
        let least_s = 2.0 * player.motion().time_step_s;
        let mut said = None;
        for key in patch.keys() {
            said = match key.as_str() {
                "window_s" if look.window_s < least_s => {
                    return too_short("traces show", least_s);
                }
                "window_s" => Some(format!(
                    "the traces show {} s; Home shows the usual time",
                    look.window_s
                )),
                "detail_s" if look.detail_s < Some(least_s) => {
                    return too_short("strip shows", least_s);
                }
                "detail_s" => look
                    .detail_s
                    .map(|detail_s| format!("the strip of the fast motion shows {detail_s} s")),
                "detail_of" => Some(match look.detail_of {
                    Some(curve) => format!("the upper strip shows {}", curve.name()),
                    None => "the upper strip shows what swings: the tilt, or x".to_owned(),
                }),
                "phase" => {
                    step_pane.may_show(look.phase, player)?;
                    None
                }
                "residuals" if !self.measured => return Err(NO_DATA.into()),
                "residuals" if look.residuals => Some(RESIDUALS_TEXT.to_owned()),
                "residuals" => Some("measured values and the run".to_owned()),
                "bare" if look.bare => Some("a bare screen: c brings the rest back".to_owned()),
                _ => None,
            };
        }
        self.set_look(look);
        Ok(Done::saying_any(said))
    }

    pub(in crate::lab) fn set_since(&mut self, since_s: Option<f64>) -> Done {
        self.since_s = since_s;
        Done::saying(match since_s {
            Some(since_s) => format!("the traces begin at {since_s} s; Home shows the run again"),
            None => "the traces follow the run".to_owned(),
        })
    }

    pub(in crate::lab) fn magnify(&mut self, times: f64) -> Done {
        self.magnified = times;
        Done::saying(if times > 1.0 {
            format!("values are magnified {times} times; Home shows all of them again")
        } else {
            "values are shown in full".to_owned()
        })
    }

    pub(in crate::lab) fn set_cursor(&mut self, to: CursorTo, player: &Player) -> ActionResult {
        let run = player.run();
        let here = self.cursor_or_here(player);
        let target = match to {
            CursorTo::Mark => return self.mark_turn(player),
            CursorTo::Nowhere => None,
            CursorTo::Place(SeekTarget::End) => Some(run.furthest()),
            CursorTo::Place(place) => Some(player.step_of(place)?),
            CursorTo::NextTurn | CursorTo::TurnBefore => {
                let turn = lookup::turn(run, here, to == CursorTo::NextTurn);
                Some(turn.map_err(|missing| missing.to_string())?)
            }
        };
        let step = target.map(|step| step.min(run.furthest()));
        if let Some(step) = step {
            let sample = lookup::sample(run, step).map_err(|missing| missing.to_string())?;
            let (begin_s, window_s) = (self.begin_s(player), self.look.window_s);
            if !(begin_s..=begin_s + window_s).contains(&sample.time_s) {
                self.since_s = Some((sample.time_s - 0.5 * window_s).max(0.0));
            }
        }
        self.cursor = step;
        Ok(Done::SILENT)
    }

    /// Marks the step of the cursor; where another is marked, says what the swings of the tilt between are.
    fn mark_turn(&mut self, player: &Player) -> ActionResult {
        let none = "the cursor is nowhere: ) and ( put it on a turn of the tilt";
        let here = self.cursor.ok_or(none)?;
        let Some(mark) = self.swing_mark.take().filter(|mark| *mark != here) else {
            self.swing_mark = Some(here);
            return Ok(Done::saying(
                "marked: ) to a later turn of the tilt, and | counts the swings between",
            ));
        };
        let (from, to) = (mark.min(here), mark.max(here));
        let turns = lookup::turns(player.run(), from, to).map_err(|missing| missing.to_string())?;
        let (time_step_s, readouts) = (player.motion().time_step_s, &player.reading.readouts);
        let said = swings::in_words(&turns, time_step_s, readouts);
        let few = "fewer than two turns of the tilt from the mark to the cursor";
        Ok(Done {
            stays: true,
            ..Done::saying(said.ok_or(few)?)
        })
    }

    /// Leaves the cursor at its time where the run of `player` has gone over to another scenario: that may be another step.
    pub(in crate::lab) fn keep_cursor(&mut self, player: &Player) {
        if let (Some(_), Some(cursor)) = (self.cursor, player.cursor()) {
            self.cursor = Some(Simulation::step_at(player.run().scenario(), cursor.time_s));
        }
    }

    /// Turns the camera so that the axle is seen aslant, unless its direction was chosen. A moving picture is left as it is:
    /// the motion shows where the axle points.
    pub(in crate::lab) fn turn_camera(&mut self, player: &Player) {
        let is_still = !player.is_running() || player.step_number() == 0;
        if is_still && self.look.camera.is_none() {
            self.camera = self.camera.aside_of(&player.reading.state.axle());
        }
    }

    fn cursor_or_here(&self, player: &Player) -> u64 {
        self.cursor.unwrap_or(player.step_number())
    }

    /// The time at the left edge of the traces, s.
    fn begin_s(&self, player: &Player) -> f64 {
        let (now_s, window_s) = (player.run().now().time_s, self.look.window_s);
        self.since_s
            .unwrap_or_else(|| Strip::following(now_s, window_s, 1).begin_s)
    }

    /// The command that shows twice the time in the traces (`wider`), or half of it; where less than two time steps would
    /// remain, which time is shown.
    pub fn other_window(&self, wider: bool, player: &Player) -> Result<Command, String> {
        let time_step_s = player.run().simulation().motion().time_step_s;
        let window_s = self.look.window_s * if wider { 2.0 } else { 0.5 };
        if window_s >= 2.0 * time_step_s && window_s.is_finite() {
            Ok(Command::look("window_s", window_s))
        } else {
            Err(format!("the traces show {} s", self.look.window_s))
        }
    }

    /// The command that shows another curve in the strip of the fast motion than it shows now.
    pub fn other_detail(&self, direction: Direction, times: i32, player: &Player) -> Command {
        let shown = self.look.detail_of.unwrap_or(player.detail().curve);
        let curves = [
            RecordedCurve::X,
            RecordedCurve::Y,
            RecordedCurve::Z,
            RecordedCurve::Tilt,
        ];
        let now = curves.iter().position(|curve| *curve == shown).unwrap_or(0) as i32;
        let by = match direction {
            Direction::Up | Direction::PageUp => -times,
            _ => times,
        };
        let next = (now + by).rem_euclid(curves.len() as i32) as usize;
        Command::look("detail_of", curves[next])
    }

    pub fn moved_cursor(&self, fiftieths: i32, player: &Player) -> Command {
        let steps = CURSOR_SHARE * self.look.window_s / player.motion().time_step_s;
        self.stepped_cursor(steps.round().max(1.0) as i64 * i64::from(fiftieths), player)
    }

    pub fn stepped_cursor(&self, steps: i64, player: &Player) -> Command {
        let step = self.cursor_or_here(player).saturating_add_signed(steps);
        Command::Cursor(CursorTo::Place(SeekTarget::Step(step)))
    }

    /// The command that moves the window to later times, `times` halves of its length, or to earlier ones.
    pub fn panned(&self, times: i32, player: &Player) -> Command {
        let by_s = PAN_SHARE * self.look.window_s * f64::from(times);
        Command::SinceS(Some((self.begin_s(player) + by_s).max(0.0)))
    }

    /// The command that doubles the magnification `notches` times, or halves it.
    pub fn other_magnification(&self, notches: i32) -> Command {
        let times = self.magnified * 2_f64.powi(notches);
        Command::Magnify(times.clamp(1.0, MOST_MAGNIFIED))
    }

    /// The commands that show the run again, after the time or the values were chosen by hand.
    pub fn whole(&self, player: &Player) -> Vec<Command> {
        let usual_s = self.usual_window_s(player.run().scenario());
        vec![
            Command::look("detail_of", AUTO),
            Command::Cursor(CursorTo::Nowhere),
            Command::Magnify(1.0),
            Command::look("window_s", usual_s),
            Command::SinceS(None),
        ]
    }

    /// The command that shows the round picture in focus `rungs` larger.
    pub fn other_zoom(&self, rungs: i32) -> Result<Command, String> {
        let now = match self.focus {
            Pane::ThreeD => self.look.zoom.three_d,
            _ => self.look.zoom.above,
        };
        match Zoom::shifted(now, rungs) {
            Some(next) => self.zoom_to(next),
            None if rungs > 0 => Err("this is the largest; Z makes it smaller".to_owned()),
            None => Err("this is the smallest; z makes it larger".to_owned()),
        }
    }

    /// The command that shows the round picture in focus `factor` times as large as the whole.
    pub fn zoom_to(&self, factor: f64) -> Result<Command, String> {
        let mut zoom = self.look.zoom;
        match self.focus {
            Pane::Above => zoom.above = factor,
            Pane::ThreeD => zoom.three_d = factor,
            _ => return Err("the view from above and the 3-D view are zoomed: Tab".to_owned()),
        }
        Ok(Command::look("zoom", zoom))
    }

    /// The command that turns the camera as an arrow key does that is pressed `times` times.
    pub fn turned(&self, direction: Direction, times: i32) -> Command {
        let degrees = f64::from(signed(direction, times)) * TURN_DEG;
        let mut camera = self.camera;
        match direction {
            Direction::Left | Direction::Right => camera.turn(degrees, 0.0),
            Direction::Up | Direction::PageUp => camera.turn(0.0, degrees),
            Direction::Down | Direction::PageDown => camera.turn(0.0, -degrees),
        }
        Command::look("camera", camera)
    }

    /// The command that fills the screen with the pane in focus, or shows all panes again.
    pub fn fill_toggled(&self) -> Command {
        Command::Fill((!self.fullscreen).then_some(self.focus))
    }

    /// The commands that fill the screen with the 3-D view, or show all panes again, with the page or the traces in focus.
    pub fn three_d_toggled(&self) -> Vec<Command> {
        if !self.is_filled_by(Pane::ThreeD) {
            return vec![Command::Fill(Some(Pane::ThreeD))];
        }
        let has_page = self.may_show(Pane::Lesson);
        let next = if has_page { Pane::Lesson } else { Pane::Traces };
        vec![Command::Fill(Some(next)), Command::Fill(None)]
    }
}

/// Refuses a length of time that is less than two time steps.
fn too_short(what: &str, least_s: f64) -> ActionResult {
    Err(format!("the {what} two time steps at least: {least_s} s").into())
}
