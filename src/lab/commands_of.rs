//! The commands that an action stands for as the lab is now.

use super::Lab;
use super::action::{Action, Direction};
use super::command::{Command, CursorTo, Place, PushChoice};
use super::on_top::Mode;
use super::values::listed::ListedValue;
use super::view::Pane;
use crate::observe::camera::Zoom;

/// The factor of the arrows with Shift.
pub(super) const FAR: i32 = 10;
/// The most times that an action is repeated; more repetitions would make no difference on the screen.
const MOST_REPEATED: u64 = 1000;

impl Lab {
    /// The commands that `action` stands for as the lab is now; `None` for an action that only changes the interface.
    ///
    /// # Errors
    /// Why the action does nothing now.
    pub(super) fn commands_of(
        &self,
        action: Action,
        count: Option<u64>,
    ) -> Result<Option<Vec<Command>>, String> {
        let times = repeated(count);
        let one = |command| Ok(Some(vec![command]));
        let steps = || i64::try_from(count.unwrap_or(1)).unwrap_or(i64::MAX);
        let speed = |notches| Ok(Command::Speed(self.player.other_speed(notches)?));
        match action {
            Action::TogglePause if !self.script.is_done() => Ok(None),
            Action::TogglePause => one(if self.player.is_moving() {
                Command::Pause
            } else {
                Command::Run
            }),
            Action::Step | Action::StepBack if count == Some(0) => one(Command::Pause),
            Action::Step => one(Command::Step(steps())),
            Action::StepBack => one(Command::Step(-steps())),
            Action::Faster => speed(times).and_then(one),
            Action::Slower => speed(-times).and_then(one),
            Action::Restart => {
                let run = self.player.playback.is_running().then_some(Command::Run);
                let begin = Command::GoTo(Place::Start);
                Ok(Some([Some(begin), run].into_iter().flatten().collect()))
            }
            Action::GoTo => Ok(count.map(|step| vec![Command::GoTo(Place::Step(step))])),
            Action::Undo => one(Command::Undo(times.unsigned_abs())),
            Action::Redo => one(Command::Redo(times.unsigned_abs())),
            Action::Push => one(Command::Push(PushChoice::default())),
            Action::TakeAdvice => match self.player.why_no_advice() {
                Some(reason) => Err(reason.to_owned()),
                None => one(Command::TakeAdvice),
            },
            Action::TogglePin => one(Command::Pin(!self.player.is_pinned())),
            Action::ToggleExact => one(Command::Exact(!self.player.run().shows_exact())),
            Action::ToggleResiduals => one(Command::look("residuals", !self.view.residuals)),
            Action::FillScreen => one(Command::Fill(
                (!self.view.filled).then_some(self.view.focus),
            )),
            Action::ThreeD if !self.view.is_filled_by(Pane::THREE_D) => {
                one(Command::Fill(Some(Pane::THREE_D)))
            }
            Action::StepCursor(direction) => one(self.stepped_cursor(signed(direction, times))),
            Action::ToTurn(direction) => one(Command::Cursor(match direction {
                Direction::Left => CursorTo::TurnBefore,
                _ => CursorTo::NextTurn,
            })),
            Action::GoToCursor => match self.view.cursor {
                Some(step) => one(Command::GoTo(Place::Step(step))),
                None => Ok(None),
            },
            Action::Pan(direction) => one(self.panned(direction, times)),
            Action::Magnify(more) => one(self.magnified(if more { times } else { -times })),
            Action::WholeView => Ok(Some(self.whole_view())),
            Action::WiderWindow => Ok(self.other_window(true)),
            Action::NarrowerWindow => Ok(self.other_window(false)),
            Action::ZoomIn => self.other_zoom(times).map(Some),
            Action::ZoomOut => self.other_zoom(-times).map(Some),
            Action::ZoomToWhole => self.zoom_to(1.0).map(Some),
            Action::NextPhase => self.other_phase(i64::from(times)).map(Some),
            Action::PhaseBack => self.other_phase(-i64::from(times)).map(Some),
            Action::Why => one(self.why_toggled()),
            Action::Move(direction) => self.moved(direction, times),
            Action::MoveFar(direction) => self.moved(direction, times.saturating_mul(FAR)),
            _ => Ok(None),
        }
    }

    /// The command that shows the round picture in focus `rungs` larger.
    fn other_zoom(&self, rungs: i32) -> Result<Vec<Command>, String> {
        let now = match self.view.focus {
            Pane::THREE_D => self.view.zoom.three_d,
            _ => self.view.zoom.above,
        };
        match Zoom::shifted(now, rungs) {
            Some(next) => self.zoom_to(next),
            None if rungs > 0 => Err("this is the largest; Z makes it smaller".to_owned()),
            None => Err("this is the smallest; z makes it larger".to_owned()),
        }
    }

    /// The command that shows the round picture in focus `factor` times as large as the whole.
    fn zoom_to(&self, factor: f64) -> Result<Vec<Command>, String> {
        let mut zoom = self.view.zoom;
        match self.view.focus {
            Pane::FROM_ABOVE => zoom.above = factor,
            Pane::THREE_D => zoom.three_d = factor,
            _ => return Err("the view from above and the 3-D view are zoomed: Tab".to_owned()),
        }
        Ok(vec![Command::look("zoom", zoom)])
    }

    /// The commands of an arrow key that is pressed `times` times.
    fn moved(&self, direction: Direction, times: i32) -> Result<Option<Vec<Command>>, String> {
        match (self.on_top.mode, self.view.focus) {
            (Mode::Lab, Pane::THREE_D) => {
                let camera = self.view.turned(direction, times);
                Ok(Some(vec![Command::look("camera", camera)]))
            }
            (Mode::Lab | Mode::Find, Pane::PARAMETERS) => match direction {
                Direction::Left => self.nudged(-times),
                Direction::Right => self.nudged(times),
                _ => Ok(None),
            },
            (Mode::Lab, Pane::STEP) => self.other_sum(direction, times).map(|sum| Some(vec![sum])),
            (Mode::Lab, Pane::TRACES)
                if matches!(direction, Direction::Left | Direction::Right) =>
            {
                Ok(Some(vec![self.moved_cursor(signed(direction, times))]))
            }
            (Mode::Lab, Pane::TRACES) => Ok(Some(vec![self.other_detail(direction, times)])),
            (Mode::Lab, _) => Err(
                "z and Z zoom here; arrows turn the 3-D view (d) and choose values (e)".to_owned(),
            ),
            _ => Ok(None),
        }
    }

    fn nudged(&self, times: i32) -> Result<Option<Vec<Command>>, String> {
        Ok(match self.values.list.selected() {
            None => None,
            Some(_) if times == 0 => None,
            Some(ListedValue::OfScenario(parameter)) => Some(vec![Command::Nudge {
                key: parameter.key.clone(),
                times,
            }]),
            Some(ListedValue::OfNextPush { field, .. }) => {
                let scenario = self.player.run().scenario();
                let next = self.values.next_push.nudged(*field, times, scenario)?;
                Some(vec![Command::NextPush(PushChoice::field(*field, &next))])
            }
        })
    }
}

/// `times` to the right, or as many to the left.
fn signed(direction: Direction, times: i32) -> i32 {
    match direction {
        Direction::Left => -times,
        _ => times,
    }
}

pub(super) fn repeated(count: Option<u64>) -> i32 {
    count.unwrap_or(1).min(MOST_REPEATED) as i32
}
