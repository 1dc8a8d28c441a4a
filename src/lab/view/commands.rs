//! Carries out the commands of the view, and returns the commands for the keys of its panes.

use super::swings;
use super::{FourthStrip, Pane, View};
use crate::engine::data::QUANTITIES;
use crate::engine::recording::RecordedCurve;
use crate::engine::run::Simulation;
use crate::engine::scenario::screen::AUTO;
use crate::engine::text::number::short;
use crate::lab::action::{Direction, signed};
use crate::lab::answer::{ActionResult, Done};
use crate::lab::command::{Command, CursorTo, MOST_MAGNIFIED, SeekTarget};
use crate::lab::playback::lookup::{self, StepNumbers};
use crate::lab::player::Player;
use crate::lab::step_pane::StepPane;
use crate::plot::camera::{Camera, Zoom};
use toml::Table;

/// Shares of the window by which a key moves the cursor, and the window.
const CURSOR_SHARE: f64 = 0.02;
const PAN_SHARE: f64 = 0.5;
/// The messages about residuals: shown, and refused.
const RESIDUALS_TEXT: &str = "measured minus run, where there are measurements; m shows both again";
const NO_DATA: &str = "there are no measured data: start with gyrolab --measured FILE";
const TURN_DEG: f64 = 10.0;
/// Maximum number of swings that is given in a message.
const MOST_COUNTED_SWINGS: f64 = 100.0;

impl View {
    /// Sets the display settings in `patch`, a table with keys of `[view]`.
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
                "window_s" if look.window_s.is_some_and(|window_s| window_s < least_s) => {
                    return too_short("overview spans", least_s);
                }
                "detail_s" if look.detail_s.is_some_and(|detail_s| detail_s < least_s) => {
                    return too_short("traces show", least_s);
                }
                "detail_s" => Some(self.window_in_words(look.detail_s)),
                "detail_of" => Some(fourth_strip_in_words(look.detail_of)),
                "phase" => {
                    step_pane.may_show(look.phase, player)?;
                    None
                }
                "residuals" if !self.measured => return Err(NO_DATA.into()),
                "residuals" if look.residuals => Some(RESIDUALS_TEXT.to_owned()),
                "residuals" => Some("measured values and the run".to_owned()),
                "bare" if look.bare => Some("a bare screen: c shows the rest again".to_owned()),
                _ => None,
            };
        }
        self.set_look(look);
        Ok(Done::saying_any(said))
    }

    pub(in crate::lab) fn set_since(&mut self, since_s: Option<f64>) -> Done {
        self.since_s = since_s;
        Done::saying(match since_s {
            Some(since_s) => format!(
                "the traces begin at {} s; W follows the run again",
                short(since_s)
            ),
            None => "the traces follow the run".to_owned(),
        })
    }

    pub(in crate::lab) fn magnify(&mut self, times: f64) -> Done {
        self.magnified = times;
        Done::saying(if times > 1.0 {
            format!("values are magnified {times} times; Z zooms out")
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
            let StepNumbers { sample, .. } =
                lookup::numbers(run, step).map_err(|missing| missing.to_string())?;
            if !self.window.contains(sample.time_s) {
                let begin_s = sample.time_s - 0.5 * self.window.length_s();
                self.since_s = Some(begin_s.max(0.0));
            }
        }
        self.cursor = step;
        Ok(Done::SILENT)
    }

    /// Marks the step of the cursor. If another step is marked, reports the swings of the tilt between the two.
    fn mark_turn(&mut self, player: &Player) -> ActionResult {
        let none = "there is no cursor: ) and ( put it on a turn of the tilt";
        let here = self.cursor.ok_or(none)?;
        let Some(mark) = self.swing_mark.take().filter(|mark| *mark != here) else {
            self.swing_mark = Some(here);
            return Ok(Done::saying(
                "marked: ) moves to a later turn of the tilt, | counts the swings between",
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

    /// Keeps the cursor at its time after the run of `player` has changed to another scenario, in which that time may
    /// be another step.
    pub(in crate::lab) fn keep_cursor(&mut self, player: &Player) {
        if let (Some(_), Some(cursor)) = (self.cursor, player.cursor()) {
            self.cursor = Some(Simulation::step_at(player.run().scenario(), cursor.time_s));
        }
    }

    /// Turns the camera so that the axle is seen at an angle at the start of a run, unless its direction was chosen.
    ///
    /// Later the camera stays, because the axle would seem to jump if the camera turned at a pause. It also stays for a
    /// run that an edit restarted, which is compared with the previous run.
    pub(in crate::lab) fn turn_camera(&mut self, player: &Player) {
        if self.look.camera.is_some() {
            return;
        }
        let axle = player.reading.state.axle();
        let is_new = self.camera == Camera::default();
        let is_at_start = player.step_number() == 0 && !player.has_just_restarted();
        if is_new || is_at_start && !self.camera.reads(&axle) {
            self.camera = self.camera.aslant(&axle);
        }
    }

    fn cursor_or_here(&self, player: &Player) -> u64 {
        self.cursor.unwrap_or(player.step_number())
    }

    /// Returns the command that shows the whole run in the traces, or a few swings if the traces show the whole run.
    /// With a `count`, it shows that number of swings.
    pub fn other_window(&self, count: Option<u64>, player: &Player) -> Result<Command, String> {
        let whole_s = player.whole_s();
        if self.window.has_overview && count.is_none() {
            return Ok(Command::look("detail_s", whole_s));
        }
        if count.is_none() && self.look.detail_s.is_some() {
            return Ok(Command::look("detail_s", AUTO));
        }
        let swings = count.unwrap_or(self.swings as u64) as f64;
        match self.window.swing_s.map(|swing_s| swings * swing_s) {
            Some(length_s) if length_s < whole_s => Ok(Command::look("detail_s", length_s)),
            Some(_) => Err("the traces show the whole run: it has no more swings".to_owned()),
            None => Err("the traces show the whole run: nothing swings in it".to_owned()),
        }
    }

    /// Returns the commands that show the default window at the run's time.
    pub fn usual_window(&self) -> Vec<Command> {
        vec![Command::look("detail_s", AUTO), Command::SinceS(None)]
    }

    /// Returns the commands that halve the window about `about_s` (s), or double it.
    pub fn zoomed_window(
        &self,
        about_s: f64,
        is_larger: bool,
        player: &Player,
    ) -> Result<Vec<Command>, String> {
        let factor = if is_larger { 0.5 } else { 2.0 };
        let length_s = factor * self.window.length_s();
        if length_s < 2.0 * player.motion().time_step_s {
            return Err("the shortest window is two time steps".to_owned());
        }
        if length_s >= player.whole_s() {
            let whole = Command::look("detail_s", player.whole_s());
            return Ok(vec![whole, Command::SinceS(None)]);
        }
        let begin_s = about_s - factor * (about_s - self.window.begin_s);
        Ok(vec![
            Command::look("detail_s", length_s),
            Command::SinceS(Some(begin_s.max(0.0))),
        ])
    }

    fn window_in_words(&self, detail_s: Option<f64>) -> String {
        match (detail_s, self.window.swing_s) {
            (None, _) => "the traces show the usual window".to_owned(),
            (Some(detail_s), Some(swing_s)) if detail_s < MOST_COUNTED_SWINGS * swing_s => {
                let swings = detail_s / swing_s;
                format!(
                    "the traces show {} s: {swings:.1} swings; W shows the usual window",
                    short(detail_s)
                )
            }
            (Some(detail_s), _) => {
                format!(
                    "the traces show {} s; W shows the usual window",
                    short(detail_s)
                )
            }
        }
    }

    /// Returns the command that moves `times` choices on in the list of fourth strips.
    pub fn other_fourth_strip(&self, times: i32) -> Command {
        let fixed = [
            FourthStrip::Auto,
            FourthStrip::Tilt,
            FourthStrip::Distance,
            FourthStrip::None,
        ];
        let of_point = RecordedCurve::ALL.map(RecordedCurve::column);
        let columns = QUANTITIES
            .iter()
            .filter(|quantity| !of_point.contains(&quantity.name))
            .map(|quantity| FourthStrip::Column(quantity.name));
        let choices: Vec<_> = fixed.into_iter().chain(columns).collect();
        let mut strips = choices.iter();
        let now = strips.position(|choice| *choice == self.look.detail_of);
        let next = now.map_or(1, |now| {
            (now as i64 + i64::from(times)).rem_euclid(choices.len() as i64)
        });
        Command::look("detail_of", choices[next as usize].name())
    }

    pub fn moved_cursor(&self, fiftieths: i32, player: &Player) -> Command {
        let steps = CURSOR_SHARE * self.window.length_s() / player.motion().time_step_s;
        self.stepped_cursor(steps.round().max(1.0) as i64 * i64::from(fiftieths), player)
    }

    pub fn stepped_cursor(&self, steps: i64, player: &Player) -> Command {
        let step = self.cursor_or_here(player).saturating_add_signed(steps);
        Command::Cursor(CursorTo::Place(SeekTarget::Step(step)))
    }

    /// Returns the command that moves the window by `times` halves of its length; negative to earlier times.
    pub fn panned(&self, times: i32) -> Command {
        let by_s = PAN_SHARE * self.window.length_s() * f64::from(times);
        Command::SinceS(Some((self.window.begin_s + by_s).max(0.0)))
    }

    /// Returns the command that doubles the magnification `notches` times, or halves it if negative.
    pub fn other_magnification(&self, notches: i32) -> Command {
        let times = self.magnified * 2_f64.powi(notches);
        Command::Magnify(times.clamp(1.0, MOST_MAGNIFIED))
    }

    /// Returns the command that zooms the picture in focus in by `rungs` zoom levels, or out if negative.
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

    /// Returns the command that sets the zoom of the picture in focus to `factor`; 1 shows the whole picture.
    pub fn zoom_to(&self, factor: f64) -> Result<Command, String> {
        let mut zoom = self.look.zoom;
        match self.focus {
            Pane::Above => zoom.above = factor,
            Pane::ThreeD => zoom.three_d = factor,
            _ => return Err("only the view from above and the 3-D view zoom: press Tab".to_owned()),
        }
        Ok(Command::look("zoom", zoom))
    }

    /// Returns the command that turns the camera by `times` presses of an arrow key.
    pub fn turned(&self, direction: Direction, times: i32) -> Command {
        let degrees = f64::from(signed(direction, times)) * TURN_DEG;
        let mut camera = self.camera;
        match direction {
            Direction::Left | Direction::Right => camera.turn(degrees, 0.0),
            Direction::Up | Direction::PageUp | Direction::First => camera.turn(0.0, degrees),
            Direction::Down | Direction::PageDown | Direction::Last => camera.turn(0.0, -degrees),
        }
        Command::look("camera", camera)
    }

    /// Returns the command that fills the screen with the pane in focus, or leaves full screen.
    pub fn fill_toggled(&self) -> Command {
        Command::Fill((!self.fullscreen).then_some(self.focus))
    }
}

fn fourth_strip_in_words(strip: FourthStrip) -> String {
    let words = match strip {
        FourthStrip::Auto => "a large screen has a fourth strip: tilt, or distance from exact",
        FourthStrip::Tilt => "a strip shows the tilt",
        FourthStrip::Distance => {
            "a strip shows the distance from the exact motion, if t shows that"
        }
        FourthStrip::Column(name) => {
            return format!("a strip shows {name}; j shows the next column");
        }
        FourthStrip::None | FourthStrip::X | FourthStrip::Y | FourthStrip::Z => {
            "the strips show x, y and z"
        }
    };
    words.to_owned()
}

/// Returns the error for a length of time below two time steps.
fn too_short(what: &str, least_s: f64) -> ActionResult {
    Err(format!("the {what} at least two time steps: {least_s} s").into())
}
