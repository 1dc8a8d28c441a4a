//! Carries actions out: by commands, or, where no command does it, by changing what lies on top, the focus, and what is
//! typed.

use super::action::{Action, Direction, FieldEdit, LessonKey};
use super::answer::{Answer, Done};
use super::command::{Command, CursorTo, Place, PushChoice};
use super::dialog::Dialog;
use super::form::edit_line;
use super::on_top::{Cleared, Mode};
use super::values::listed::Of;
use super::view::Pane;
use super::{Lab, Request};
use crate::playback::camera::Zoom;
use std::path::Path;

pub(super) const PAGE: isize = 10;
/// The factor of the arrows with Shift.
const FAR: i32 = 10;
/// The most times that an action is repeated; more repetitions would make no difference on the screen.
const MOST_REPEATED: u64 = 1000;

impl Lab {
    /// Carries out `action`. Returns what only the main loop can do.
    pub fn update(&mut self, action: Action) -> Option<Request> {
        let cleared = self.on_top.clear();
        if !matches!(
            action,
            Action::Move(_) | Action::MoveFar(_) | Action::Digit(_)
        ) {
            self.values.forget_nudge();
        }
        match self.act(action, cleared) {
            Ok(None) => {}
            Ok(request) => return request,
            Err(reason) => self.say(reason),
        }
        self.view.keep_focus();
        self.read_now();
        None
    }

    /// # Errors
    /// Why the action does nothing now.
    fn act(&mut self, action: Action, cleared: Cleared) -> Result<Option<Request>, String> {
        let Cleared { count, .. } = cleared;
        let times = repeated(count);
        match action {
            Action::TogglePause => self.toggle_pause(),
            Action::Step => self.take_steps(count, 1),
            Action::StepBack => self.take_steps(count, -1),
            Action::GoTo => match count {
                Some(step) => self.one(Command::GoTo(Place::Step(step))),
                None => self.on_top.open_dialog(Dialog::go_to()),
            },
            Action::Undo => self.one(Command::Undo(times.unsigned_abs())),
            Action::Redo => self.one(Command::Redo(times.unsigned_abs())),
            Action::Push => self.one(Command::Push(PushChoice::default())),
            Action::TakeAdvice => match self.player.why_no_advice() {
                Some(reason) => return Err(reason.to_owned()),
                None => self.one(Command::TakeAdvice),
            },
            Action::TogglePin => self.one(Command::Pin(!self.player.is_pinned())),
            Action::ChoosePush => self.turn_to_next_push(),
            Action::Parameters => self.turn_to_parameters(),
            Action::Edit => self.edit_value(),
            Action::Export | Action::Figure | Action::SaveRun | Action::SavePresent => {
                let dialog = self.dialog_for_a_file(action)?;
                self.on_top.open_dialog(dialog);
            }
            Action::Digit(digit) => self.on_top.add_digit(count, digit),
            Action::Faster => self.one(Command::Speed(self.player.other_speed(times)?)),
            Action::Slower => self.one(Command::Speed(self.player.other_speed(-times)?)),
            Action::Restart => self.restart(),
            Action::ToggleExact => self.one(Command::Exact(!self.player.run().shows_exact())),
            Action::ToggleResiduals => self.one(Command::look("residuals", !self.view.residuals)),
            Action::NextPane => self.view.shift_focus(true),
            Action::PreviousPane => self.view.shift_focus(false),
            Action::FillScreen => {
                self.one(Command::Fill(
                    (!self.view.filled).then_some(self.view.focus),
                ));
            }
            Action::ThreeD => self.view.toggle_three_d(),
            Action::ToggleStep => self.toggle_step(),
            Action::NextPhase => self.carry_out_all(&self.other_phase(i64::from(times))?),
            Action::PhaseBack => self.carry_out_all(&self.other_phase(-i64::from(times))?),
            Action::Why => self.one(self.why_toggled()),
            Action::Move(direction) => self.move_by(direction, times)?,
            Action::MoveFar(direction) => self.move_by(direction, times.saturating_mul(FAR))?,
            Action::WiderWindow => self.change_window(true),
            Action::NarrowerWindow => self.change_window(false),
            Action::StepCursor(direction) => {
                self.one(self.stepped_cursor(signed(direction, times).into()));
            }
            Action::ToTurn(Direction::Left) => self.one(Command::Cursor(CursorTo::TurnBefore)),
            Action::ToTurn(_) => self.one(Command::Cursor(CursorTo::NextTurn)),
            Action::GoToCursor => match self.view.cursor {
                Some(step) => self.one(Command::GoTo(Place::Step(step))),
                None => self.turn_to_parameters(),
            },
            Action::Pan(direction) => self.one(self.panned(direction, times)),
            Action::Magnify(true) => self.one(self.magnified(times)),
            Action::Magnify(false) => self.one(self.magnified(-times)),
            Action::WholeView => self.carry_out_all(&self.whole_view()),
            Action::ZoomIn => self.one(self.other_zoom(times)?),
            Action::ZoomOut => self.one(self.other_zoom(-times)?),
            Action::ZoomToWhole => self.one(self.zoom_to(1.0)?),
            Action::Settings => self.on_top.open_dialog(Dialog::settings(&self.view, 0)),
            Action::Browse => self.browse(),
            Action::FindValue => self.find_value(),
            Action::DoEntry => {} // tui has the entries, and carries it out
            Action::Choose => self.open_chosen(),
            Action::Filter => self.on_top.mode = Mode::Filter,
            Action::InField(edit) => self.edit_field(edit),
            Action::Accept if self.shows_settings() => self.change_setting(true),
            Action::Accept => return Ok(self.accept()),
            Action::Help => self.on_top.toggle_help(),
            Action::Close => return Ok(self.close(&cleared)),
            Action::Class => {
                let rule = "this is no lab of a class: gyrolab man class says how one begins";
                return Err(rule.to_owned());
            }
            Action::Lesson(key) => return Ok(Some(Request::Lesson(key))),
            Action::Redraw => return Ok(Some(Request::Redraw)),
            Action::Suspend if self.files.confined().is_some() => {
                return Err("there is no shell to go back to: q leaves".to_owned());
            }
            Action::Suspend => return Ok(Some(Request::Suspend)),
            Action::Quit if self.files.is_exporting() && !cleared.was_warned => {
                self.on_top.warn_of_export(self.now);
            }
            Action::Quit => return Ok(Some(Request::Quit)),
        }
        Ok(None)
    }

    fn toggle_pause(&mut self) {
        match (self.script.is_done(), self.script.is_held) {
            (false, true) => self.release_script(),
            (false, false) => self.hold_script(),
            (true, _) if self.player.is_moving() => self.one(Command::Pause),
            (true, _) => self.one(Command::Run),
        }
    }

    /// Takes one step, or `count`, forward or back.
    fn take_steps(&mut self, count: Option<u64>, sign: i64) {
        let steps = i64::try_from(count.unwrap_or(1)).unwrap_or(i64::MAX);
        self.one(match steps {
            0 => Command::Pause,
            steps => Command::Step(sign * steps),
        });
    }

    fn restart(&mut self) {
        let is_running = self.player.playback.is_running();
        self.one(Command::GoTo(Place::Start));
        if is_running {
            self.one(Command::Run);
        }
    }

    fn edit_value(&mut self) {
        if self.view.focus != Pane::PARAMETERS {
            self.turn_to_parameters();
        } else if let Some(dialog) = Dialog::value(&self.values) {
            self.on_top.open_dialog(dialog);
        } else {
            self.say("no value to set has that in its name: Esc shows all of them");
        }
    }

    fn browse(&mut self) {
        let files = &self.files;
        let may_be_read = |path: &Path| files.admit(path).is_ok();
        let (folder, name) = (files.folder(), self.work.name());
        self.on_top.browser.begin(folder, name, may_be_read);
        self.on_top.mode = Mode::Browser;
    }

    fn edit_field(&mut self, edit: FieldEdit) {
        match edit {
            edit if self.on_top.mode == Mode::Find => {
                self.values.list.filter_by(|line| edit_line(line, edit));
            }
            FieldEdit::Left | FieldEdit::Right if self.shows_settings() => {
                self.change_setting(edit == FieldEdit::Right);
            }
            edit => self.on_top.edit_field(edit),
        }
    }

    /// The command that shows the round picture in focus `rungs` larger.
    fn other_zoom(&self, rungs: i32) -> Result<Command, String> {
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
    fn zoom_to(&self, factor: f64) -> Result<Command, String> {
        let mut zoom = self.view.zoom;
        match self.view.focus {
            Pane::FROM_ABOVE => zoom.above = factor,
            Pane::THREE_D => zoom.three_d = factor,
            _ => return Err("the view from above and the 3-D view are zoomed: Tab".to_owned()),
        }
        Ok(Command::look("zoom", zoom))
    }

    /// Does what an arrow or page key does that is pressed `times` times.
    fn move_by(&mut self, direction: Direction, times: i32) -> Result<(), String> {
        let is_sideways = matches!(direction, Direction::Left | Direction::Right);
        match (self.on_top.mode, self.view.focus) {
            (Mode::Lab, Pane::THREE_D) => {
                self.one(Command::look("camera", self.view.turned(direction, times)));
            }
            (Mode::Lab | Mode::Find, Pane::PARAMETERS) if is_sideways => {
                self.nudge_selected(signed(direction, times))?;
            }
            (Mode::Lab | Mode::Find, Pane::PARAMETERS) => {
                let rows = direction.rows(PAGE) * times as isize;
                self.values.list.shift(rows.signum() * times as isize);
            }
            (Mode::Lab, Pane::STEP) => self.one(self.other_sum(direction, times)?),
            (Mode::Lab, Pane::TRACES) if is_sideways => {
                self.one(self.moved_cursor(signed(direction, times)));
            }
            (Mode::Lab, Pane::TRACES) => self.one(self.other_detail(direction, times)),
            (Mode::Lab, _) => {
                let rule = "z and Z zoom here; arrows turn the 3-D view (d) and choose values (e)";
                return Err(rule.to_owned());
            }
            _ => self.on_top.shift(direction.rows(PAGE) * times as isize),
        }
        Ok(())
    }

    fn nudge_selected(&mut self, times: i32) -> Result<(), String> {
        match self.values.list.selected().map(|value| &value.of) {
            Some(Of::Scenario(parameter)) if times != 0 => {
                let key = parameter.key.clone();
                self.one(Command::Nudge { key, times });
            }
            Some(Of::NextPush(field)) if times != 0 => {
                let scenario = self.player.run().scenario();
                let next = self.values.next_push.nudged(*field, times, scenario)?;
                self.one(Command::NextPush(PushChoice::field(*field, &next)));
            }
            _ => {}
        }
        Ok(())
    }

    /// Carries out `command` as a key does: it removes the present message and shows that of the command.
    pub fn carry_out_now(&mut self, command: &Command) {
        self.on_top.clear();
        self.carry_out_all(std::slice::from_ref(command));
    }

    pub fn turn_to(&mut self, pane: Pane) {
        self.on_top.clear();
        self.view.turn_to(pane);
        self.read_now();
    }

    /// Takes note that a key of the pane in focus was pressed: the footer names its keys from then on.
    pub fn touch_pane(&mut self) {
        self.view.is_touched = true;
    }

    pub fn select_in_browser(&mut self, row: usize) {
        self.on_top.clear();
        let selected = self.on_top.browser.selected;
        self.on_top.shift(row as isize - selected as isize);
        self.changed = true;
    }

    fn one(&mut self, command: Command) {
        self.carry_out_all(&[command]);
    }

    /// Carries out `commands` up to the first that is refused, and shows their messages.
    pub(super) fn carry_out_all(&mut self, commands: &[Command]) {
        for command in commands {
            let answer = self.carry_out(command);
            let is_refused = answer.is_err();
            self.tell_answer(answer);
            if is_refused {
                return;
            }
        }
    }

    /// Shows the message of a command, or why it was refused.
    pub(super) fn tell_answer(&mut self, answer: Answer) {
        let done = answer.unwrap_or_else(|refusal| Done::saying(refusal.to_string()));
        match done.said {
            Some(text) if done.stays => self.tell(text),
            Some(text) => self.say(text),
            None => {}
        }
    }

    /// Closes or stops the first of these that there is: what lies on top, the script, the steps asked for, the cursor, the
    /// pane that fills the screen, the focus on the parameters, the export, the step pane in focus. If there is none of these,
    /// it says how to leave, unless the key has already removed a message or a count.
    fn close(&mut self, cleared: &Cleared) -> Option<Request> {
        let is_found = self.on_top.mode == Mode::Find;
        let is_filtered = self.on_top.mode == Mode::Lab && self.view.focus == Pane::PARAMETERS;
        // From a value that was searched for, one Esc leads back to the page of a lesson, as it does from any other.
        let is_left = is_filtered && self.view.sheet.is_some();
        let forget = |line: &mut String| !std::mem::take(line).is_empty();
        if (is_found || is_filtered) && self.values.list.filter_by(forget) && !is_left {
            self.on_top.close();
            return None;
        }
        if self.on_top.close() {
            return None;
        }
        if !self.script.is_done() {
            self.stop_script();
        } else if self.player.playback.steps_to_go().is_some() {
            self.one(Command::Pause);
        } else if self.view.cursor.is_some() {
            self.one(Command::Cursor(CursorTo::Nowhere));
        } else if self.view.filled {
            self.leave_filled();
        } else if cleared.count.is_none() && self.view.leave_parameters() {
            // The focus returns to the run even if the key has removed a message too.
        } else if cleared.anything {
            // The key has done something already.
        } else if self.files.is_exporting() {
            self.files.stop_export();
        } else if self.view.focus == Pane::STEP && self.view.shows_step() {
            self.toggle_step();
        } else if self.view.sheet.is_some() {
            return Some(Request::Lesson(LessonKey::Leave));
        } else {
            self.say("nothing to close; q leaves");
        }
        None
    }

    fn leave_filled(&mut self) {
        self.one(Command::Fill(None));
        self.turn_to_sheet();
        // On a screen that has no place for the values beside the run, they fill it: leaving them shows the run again.
        if !self.view.side_by_side.contains(&Pane::PARAMETERS) {
            self.view.leave_parameters();
        }
    }

    /// Moves the focus to the values and begins to search for one by a part of its name.
    fn find_value(&mut self) {
        self.view.turn_to(Pane::PARAMETERS);
        self.values.list.filter_by(String::clear);
        self.on_top.mode = Mode::Find;
    }

    /// Says that the help has `entries` entries that are found: the selected one is among them.
    pub fn limit_help(&mut self, entries: usize) {
        self.on_top.help.limit(entries);
    }

    /// Pauses the run and the commands that are not carried out yet.
    fn hold_script(&mut self) {
        self.pause_script();
        self.one(Command::Pause);
        self.tell(format!("paused: {}", self.script.left_in_words()));
    }

    /// Stops the run and drops the commands that are not carried out yet.
    fn stop_script(&mut self) {
        let left = self.script.drop_all();
        self.one(Command::Pause);
        self.say(match left {
            1 => "stopped: 1 command is left out".to_owned(),
            left => format!("stopped: {left} commands are left out"),
        });
    }
}

/// `times` to the right, or as many to the left.
pub(super) fn signed(direction: Direction, times: i32) -> i32 {
    match direction {
        Direction::Left => -times,
        _ => times,
    }
}

fn repeated(count: Option<u64>) -> i32 {
    count.unwrap_or(1).min(MOST_REPEATED) as i32
}
