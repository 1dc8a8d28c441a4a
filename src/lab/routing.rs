//! Passes actions to the parts of the lab.
//!
//! A new [`Action`] gets its arm in `Lab::act`, or in `act_on_popups` if it concerns popups or the main loop.

use super::action::{
    Action, Ask, Direction, FieldEdit, LabRequest, LessonKey, PAGE_KEY_ROWS, repeated, signed,
};
use super::answer::{ActionResult, Done};
use super::command::{Command, Commands, CursorTo, SeekTarget};
use super::dialog::{Dialog, DialogKind};
use super::form::{edit_line, type_into};
use super::popups::Mode;
use super::view::Pane;
use super::{Cleared, Lab, Snapshot, paste_rows};
use crate::engine::scenario::{Document, Problems};
use crate::engine::text::unit::number_in;
use std::sync::Arc;

impl Lab {
    /// Carries out `action`. Returns a request if only the main loop can do it.
    pub fn update(&mut self, action: Action) -> Option<LabRequest> {
        let cleared = self.clear();
        if !action.keeps_nudge() {
            self.edits.values.forget_nudge();
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

    /// Carries out `action`, with the count and messages that its key has `cleared`.
    ///
    /// # Errors
    /// Returns an error if the action does nothing now.
    fn act(&mut self, action: Action, cleared: Cleared) -> Result<Option<LabRequest>, String> {
        let count = cleared.count;
        let times = repeated(count);
        match action {
            Action::TogglePause => self.toggle_pause(),
            Action::GoTo => match count {
                Some(step) => self.carry_out_all(&[Command::GoTo(SeekTarget::Step(step))]),
                None => self.ask(Ask::Place)?,
            },
            Action::GoToCursor => match self.view.cursor {
                Some(step) => self.carry_out_all(&[Command::GoTo(SeekTarget::Step(step))]),
                None => self.turn_to_parameters(),
            },
            Action::ChoosePush => {
                self.view.turn_to(Pane::Parameters);
                self.edits.values.select_next_push();
                self.say("the next push: p starts it");
            }
            Action::Parameters => self.turn_to_parameters(),
            Action::Edit if self.view.focus != Pane::Parameters => self.turn_to_parameters(),
            Action::Edit => self.ask(Ask::Value)?,
            Action::NextPane => self.view.shift_focus(true),
            Action::PreviousPane => self.view.shift_focus(false),
            Action::ThreeD => self.view.toggle_three_d(),
            Action::ToDifference => {
                let commands = self.comparison.to_difference(&self.view)?;
                self.carry_out_all(&commands);
                self.view.turn_to(Pane::Step);
            }
            Action::Toggle(pane) => {
                let is_shown = self.view.shows(pane);
                self.carry_out_all(&self.view.toggled(pane));
                if !is_shown {
                    self.view.turn_to(pane);
                }
            }
            Action::Move(direction, far) => self.move_by(direction, times * far)?,
            other => return self.act_on_popups(other, &cleared),
        }
        Ok(None)
    }

    /// Carries out an action on popups, or returns the request for an action of the main loop.
    fn act_on_popups(
        &mut self,
        action: Action,
        cleared: &Cleared,
    ) -> Result<Option<LabRequest>, String> {
        match action {
            Action::Ask(ask) => self.ask(ask)?,
            Action::Digit(digit) => self.popups.add_digit(cleared.count, digit),
            Action::Browse => self.popups.browse(self.edits.runs.name(), &self.files),
            Action::FindValue => {
                self.view.turn_to(Pane::Parameters);
                self.edits.values.list.filter_by(String::clear);
                self.popups.mode = Mode::Find;
            }
            Action::Choose => self.open_chosen()?,
            Action::InField(edit) => self.edit_field(edit),
            Action::Accept if self.popups.shows_settings() => self.change_setting(true),
            Action::Accept => return Ok(self.accept()),
            Action::Help => self.popups.toggle_help(),
            Action::Close => return Ok(self.close(cleared)),
            Action::Class => return Ok(Some(LabRequest::Class)),
            Action::Lesson(key) => return Ok(Some(LabRequest::Lesson(key))),
            Action::Redraw => return Ok(Some(LabRequest::Redraw)),
            Action::Suspend if self.files.confined().is_some() => {
                return Err("no shell to return to; press q to quit".to_owned());
            }
            Action::Suspend => return Ok(Some(LabRequest::Suspend)),
            Action::Quit => match self.quit_warning() {
                Some(warning) if !cleared.was_warned => self.messages.warn(warning, self.now),
                _ => return Ok(Some(LabRequest::Quit)),
            },
            _ => {} // `tui` has the entries of the help and carries them out
        }
        Ok(None)
    }

    /// Returns the warning to show before the user quits, if quitting ends something.
    fn quit_warning(&self) -> Option<String> {
        if self.files.is_exporting() {
            let text =
                "an export is running: press q again to stop it and quit; nothing is written";
            return Some(text.to_owned());
        }
        self.quit_warning.clone()
    }

    fn ask(&mut self, ask: Ask) -> Result<(), String> {
        let (files, edits) = (&self.files, &self.edits);
        let dialog = Dialog::open(ask, files, edits, &self.player, &self.view)?;
        self.popups.open_dialog(dialog);
        Ok(())
    }

    /// Carries out `times` presses of an arrow or page key that is not a command of the pane in focus.
    fn move_by(&mut self, direction: Direction, times: i32) -> Result<(), String> {
        let rows = direction.rows(PAGE_KEY_ROWS) * times as isize;
        let of_values = self.view.focus == Pane::Parameters;
        match self.popups.mode {
            Mode::Lab | Mode::Find if of_values && direction.is_sideways() => {
                let (times, scenario) = (signed(direction, times), self.player.run().scenario());
                if let Some(nudge) = self.edits.values.selected_nudged(times, scenario)? {
                    self.carry_out_all(&[nudge]);
                }
            }
            Mode::Lab | Mode::Find if of_values => {
                let list = &mut self.edits.values.list;
                list.shift(rows.signum() * times as isize);
            }
            Mode::Lab => {
                let rule = "z and Z zoom here; arrows turn the 3-D view (d) and choose values (e)";
                return Err(rule.to_owned());
            }
            _ => self.popups.shift(rows),
        }
        Ok(())
    }

    fn turn_to_parameters(&mut self) {
        self.view.turn_to(Pane::Parameters);
        self.say("Up, Down choose a value; Left, Right nudge it; Enter types it; u undoes");
    }

    pub fn turn_to(&mut self, pane: Pane) {
        self.clear();
        self.view.turn_to(pane);
        self.read_now();
    }

    /// Selects the value at `index` in the list of values.
    pub fn select_value(&mut self, index: usize) {
        self.edits.values.list.select_index(index);
        self.changed = true;
    }

    fn edit_field(&mut self, edit: FieldEdit) {
        match edit {
            edit if self.popups.mode == Mode::Find => {
                self.edits
                    .values
                    .list
                    .filter_by(|line| edit_line(line, edit));
            }
            FieldEdit::Left | FieldEdit::Right if self.popups.shows_settings() => {
                self.change_setting(edit == FieldEdit::Right);
            }
            edit => self.popups.edit_field(edit),
        }
    }

    pub fn paste(&mut self, text: &str) {
        if self.popups.mode == Mode::Find {
            let list = &mut self.edits.values.list;
            list.filter_by(|line| type_into(line, text));
        } else {
            self.clear();
            if self.popups.mode == Mode::Lab && text.trim().contains(['\n', '\r']) {
                let answer = self.take_rows(text);
                return self.tell_answer(answer);
            }
            if let Some(said) = self.popups.paste(text) {
                self.say(said);
            }
        }
        self.changed = true;
    }

    /// Shows pasted rows as measured data. Undo removes them.
    fn take_rows(&mut self, text: &str) -> ActionResult {
        let (words, command) = paste_rows::keep(text, &self.files, &self.comparison, &self.player)?;
        self.carry_out(&command)?;
        Ok(Done::saying(words))
    }

    /// Changes the selected setting to its next value (or to the previous one), and updates the dialog.
    fn change_setting(&mut self, forward: bool) {
        let Some(dialog) = self.popups.take_dialog() else {
            return;
        };
        let (row, filter) = (dialog.form.selected, dialog.setting_filter().unwrap_or(""));
        if let Some(setting) = dialog.selected_setting() {
            match self.settings.change(setting, forward, &mut self.view) {
                Ok(command) => self.carry_out_all(command.as_slice()),
                Err(trouble) => self.tell(trouble),
            }
        }
        let changed = Dialog::settings(&self.view, filter, row);
        self.popups.open_dialog(changed);
    }

    /// Carries out the command of the open dialog. If it is refused, the dialog stays open and shows the reason.
    /// Returns the number if a module above asked for one.
    fn accept(&mut self) -> Option<LabRequest> {
        let dialog = self.popups.take_dialog()?;
        let answer = match &dialog.question {
            DialogKind::Number(unit) => match number_in(unit, dialog.form.text(0)) {
                Ok(number) => return Some(LabRequest::Answer(number)),
                Err(reason) => Err(reason.into()),
            },
            DialogKind::SavePresent(content) => {
                let path = self.files.path_of(dialog.form.text(0));
                let force = dialog.may_replace(&path);
                self.files.save("the scenario", content, &path, force)
            }
            _ => match dialog.command(&self.files, &self.edits.values, &self.player) {
                Ok(Some(command)) => self.carry_out(&command),
                Ok(None) => Ok(Done::SILENT),
                Err(reason) => Err(reason.into()),
            },
        };
        match answer {
            Ok(_) => self.tell_answer(answer),
            Err(refusal) => self.popups.open_dialog(dialog.with_error(refusal)),
        }
        None
    }

    /// Closes or stops the first that applies: a popup, the script, the seek, the cursor, full screen, the focus on the
    /// values.
    ///
    /// If none applies and the key has not removed a message or a count, the order continues: the export, the pane in
    /// focus if it is shown on request, the lesson. In the end, says how to quit.
    fn close(&mut self, cleared: &Cleared) -> Option<LabRequest> {
        // The focus returns from the values to the run even if the key has also removed a message.
        let is_done = self.close_popup()
            || self.stop()
            || self.unfill()
            || (cleared.count.is_none() && self.view.leave_parameters())
            || cleared.anything;
        if is_done {
            return None;
        }
        if self.files.is_exporting() {
            self.files.stop_export();
        } else if self.view.focus.is_on_request() && self.view.shows(self.view.focus) {
            self.carry_out_all(&self.view.toggled(self.view.focus));
        } else if self.view.sheet.is_some() {
            return Some(LabRequest::Lesson(LessonKey::Leave));
        } else {
            self.say("nothing to close; q quits");
        }
        None
    }

    /// Closes the top popup, or lists all values again. Returns true if it did one of these.
    fn close_popup(&mut self) -> bool {
        let is_found = self.popups.mode == Mode::Find;
        let is_filtered = self.popups.mode == Mode::Lab && self.view.focus == Pane::Parameters;
        // In a lesson, a single Esc leads from a value that was searched for back to the page, as from any other value.
        let is_left = is_filtered && self.view.sheet.is_some();
        let list = &mut self.edits.values.list;
        let is_shown = (is_found || is_filtered)
            && list.filter_by(|line| !std::mem::take(line).is_empty())
            && !is_left;
        self.popups.close() || is_shown
    }

    /// Stops the script or the seek. Returns false if there was neither.
    fn stop(&mut self) -> bool {
        if !self.script.is_done() {
            let left_out = self.script.drop_all();
            self.carry_out_all(&[Command::Pause]);
            self.say(left_out);
        } else if self.player.steps_to_go().is_some() {
            self.carry_out_all(&[Command::Pause]);
        } else {
            return false;
        }
        true
    }

    /// Removes the cursor, or else leaves full screen. Returns false if there was neither.
    fn unfill(&mut self) -> bool {
        match self.view.cursor {
            Some(_) => self.carry_out_all(&[Command::Cursor(CursorTo::Nowhere)]),
            None if self.view.fullscreen => {
                self.carry_out_all(&[Command::Fill(None)]);
                self.view.leave_filled();
            }
            None => return false,
        }
        true
    }

    /// Opens the entry that is selected in the browser: plays its run, or lists its folder.
    fn open_chosen(&mut self) -> Result<(), String> {
        if let Some(name) = self.popups.choose(&self.files)? {
            let was_edited = self.edits.runs.changed_from_file().is_some();
            let answer = self.carry_out(&Command::Open(name));
            if answer.is_ok() {
                self.popups.mode = Mode::Lab;
                self.carry_out_all(&[Command::Run]);
                if was_edited {
                    self.say("the run that you edited is kept: u returns to it");
                }
            }
            self.tell_answer(answer);
        }
        Ok(())
    }

    /// Opens the run of `snapshot`, which another lab shows. The run is paused at step 0.
    ///
    /// # Errors
    /// Returns an error if the run of `snapshot` is not valid. Nothing has changed then.
    pub fn show_run(&mut self, snapshot: &Snapshot) -> Result<(), Problems> {
        let scenario = Document::parse(&snapshot.name, &snapshot.run)?.scenario()?;
        self.take_commands(Commands::default());
        self.edits.values.forget_nudge();
        let edit = self
            .edits
            .open(&snapshot.name, Arc::new(scenario), &self.player);
        if let Some(end_s) = snapshot.end_s {
            self.edits.runs.journal_mut().set_end(end_s);
        }
        self.apply(edit);
        self.view.keep_focus();
        self.read_now();
        Ok(())
    }
}
