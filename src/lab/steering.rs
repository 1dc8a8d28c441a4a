//! Carries actions out. An action stands for commands, or it changes the interface, which no command does: dialogs, the
//! browser, the focus, dots and colours.

use super::action::{Action, Direction, FieldEdit, LessonKey};
use super::answer::{Answer, Done};
use super::command::{Command, CursorTo};
use super::commands_of::{FAR, repeated};
use super::dialog::Dialog;
use super::on_top::{Cleared, Mode};
use super::script::{GO_ON_WITH_IT, GO_ON_WITH_THEM};
use super::view::Pane;
use super::{Lab, Request};

pub(super) const PAGE: isize = 10;

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
        match self.commands_of(action, cleared.count) {
            Ok(Some(commands)) => self.carry_out_all(&commands),
            Ok(None) => {
                let request = self.change_interface(action, cleared);
                if request.is_some() {
                    return request;
                }
            }
            Err(reason) => self.say(reason),
        }
        self.view.keep_focus();
        self.read_now();
        None
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
        match answer {
            Ok(Done {
                said: Some(text),
                stays: true,
                ..
            }) => self.tell(text),
            Ok(Done {
                said: Some(text), ..
            }) => self.say(text),
            Ok(Done { said: None, .. }) => {}
            Err(refusal) => self.say(refusal.to_string()),
        }
    }

    /// Carries out an action that is no command.
    fn change_interface(&mut self, action: Action, cleared: Cleared) -> Option<Request> {
        let times = repeated(cleared.count);
        match action {
            Action::Digit(digit) => self.on_top.add_digit(cleared.count, digit),
            Action::TogglePause if self.script.is_held => self.release_script(),
            Action::TogglePause => self.hold_script(),
            Action::GoTo => self.on_top.open_dialog(Dialog::go_to()),
            Action::ChoosePush => self.turn_to_next_push(),
            Action::Parameters | Action::GoToCursor => self.turn_to_parameters(),
            Action::Edit if self.view.focus != Pane::PARAMETERS => self.turn_to_parameters(),
            Action::Edit if self.values.list.selected().is_none() => {
                self.say("no value to set has that in its name: Esc shows all of them");
            }
            Action::Edit => {
                if let Some(dialog) = Dialog::value(&self.values) {
                    self.on_top.open_dialog(dialog);
                }
            }
            Action::Export | Action::Figure | Action::SaveRun | Action::SavePresent => {
                match self.dialog_for_a_file(action) {
                    Ok(dialog) => self.on_top.open_dialog(dialog),
                    Err(reason) => self.say(reason),
                }
            }
            Action::NextPane => self.view.shift_focus(true),
            Action::PreviousPane => self.view.shift_focus(false),
            Action::ThreeD => self.view.toggle_three_d(),
            Action::ToggleStep => self.toggle_step(),
            Action::WiderWindow | Action::NarrowerWindow => {
                self.say(format!("the traces show {} s", self.view.window_s));
            }
            Action::Move(direction) => self.shift(direction, times),
            Action::MoveFar(direction) => self.shift(direction, times.saturating_mul(FAR)),
            Action::Settings => self.on_top.open_dialog(Dialog::settings(&self.view, 0)),
            Action::Browse => {
                let files = &self.files;
                let may_be_read = |path: &std::path::Path| files.admit(path).is_ok();
                let name = self.work.name();
                self.on_top.open_browser(files.folder(), name, may_be_read);
            }
            Action::Choose => self.open_chosen(),
            Action::Filter => self.on_top.mode = Mode::Filter,
            Action::FindValue => self.find_value(),
            Action::Type(typed) if self.on_top.mode == Mode::Find => {
                self.values.type_name(typed.encode_utf8(&mut [0; 4]));
            }
            Action::Erase if self.on_top.mode == Mode::Find => self.values.erase_name(),
            Action::Type(typed) => self.on_top.type_char(typed),
            Action::Erase => self.on_top.erase(),
            Action::InField(FieldEdit::Clear) if self.on_top.mode == Mode::Find => {
                self.values.forget_name();
            }
            Action::InField(edit @ (FieldEdit::Left | FieldEdit::Right))
                if self.shows_settings() =>
            {
                self.change_setting(edit == FieldEdit::Right);
            }
            Action::Accept if self.shows_settings() => self.change_setting(true),
            Action::InField(edit) => self.on_top.edit_field(edit),
            Action::Accept => return self.accept(),
            Action::Help => self.on_top.toggle_help(),
            Action::Close => return self.close(&cleared),
            Action::Lesson(key) => return Some(Request::Lesson(key)),
            Action::Redraw => return Some(Request::Redraw),
            Action::Suspend if self.files.confined().is_some() => {
                self.say("there is no shell to go back to: q leaves");
            }
            Action::Suspend => return Some(Request::Suspend),
            Action::Quit if self.files.is_exporting() && !cleared.was_warned => {
                self.on_top.warn_of_export(self.now);
            }
            Action::Quit => return Some(Request::Quit),
            _ => {} // a command, or an entry of the help, which tui carries out
        }
        None
    }

    /// Moves the selection of what lies on top, or of the values.
    fn shift(&mut self, direction: Direction, times: i32) {
        let rows = direction.rows(PAGE) * times as isize;
        match (self.on_top.mode, self.view.focus) {
            (Mode::Lab | Mode::Find, Pane::PARAMETERS) => {
                self.values.shift(rows.signum() * times as isize);
            }
            _ => self.on_top.shift(rows),
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
        if (is_found || is_filtered) && self.values.forget_name() && !is_left {
            self.on_top.close();
            return None;
        }
        if self.on_top.close() {
            return None;
        }
        if !self.script.is_done() {
            self.stop_script();
        } else if self.player.playback.steps_to_go().is_some() {
            self.carry_out_all(&[Command::Pause]);
        } else if self.view.cursor.is_some() {
            self.carry_out_all(&[Command::Cursor(CursorTo::Nowhere)]);
        } else if self.view.filled {
            self.carry_out_all(&[Command::Fill(None)]);
            self.turn_to_sheet();
            // On a screen that has no place for the values beside the run, they fill it: leaving them shows the run
            // again.
            if !self.view.side_by_side.contains(&Pane::PARAMETERS) {
                self.view.leave_parameters();
            }
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

    /// Moves the focus to the values and begins to search for one by a part of its name.
    fn find_value(&mut self) {
        self.view.turn_to(Pane::PARAMETERS);
        self.values.forget_name();
        self.on_top.mode = Mode::Find;
    }

    /// Says that the help has `entries` entries that are found: the selected one is among them.
    pub fn limit_help(&mut self, entries: usize) {
        self.on_top.help.limit(entries);
    }

    /// Pauses the run and the commands that are not carried out yet.
    fn hold_script(&mut self) {
        let left = self.script.count();
        self.pause_script();
        self.carry_out_all(&[Command::Pause]);
        let origin = &self.script.origin;
        self.tell(match left {
            1 => format!("paused: 1 command of {origin} is left: {GO_ON_WITH_IT}"),
            left => format!("paused: {left} commands of {origin} are left: {GO_ON_WITH_THEM}"),
        });
    }

    /// Stops the run and drops the commands that are not carried out yet.
    fn stop_script(&mut self) {
        let left = self.script.drop_all();
        self.carry_out_all(&[Command::Pause]);
        self.say(match left {
            1 => "stopped: 1 command is left out".to_owned(),
            left => format!("stopped: {left} commands are left out"),
        });
    }
}
