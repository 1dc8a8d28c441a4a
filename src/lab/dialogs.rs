//! What the lab asks for in a dialog, and what it does with the answer.

use super::carry_out::{Answer, Done, Refusal};
use super::command::Command;
use super::form::{Field, Form};
use super::{Lab, Mode};
use crate::lab::action::FieldEdit;
use crate::scenario::{Document, Scenario};
use crate::storage::exporting::{self, Estimate};
use crate::text::printable::Shown;
use crate::work::restart::scenario_from;
use indicatif::{DecimalBytes, HumanCount};
use std::num::NonZeroU64;
use std::path::PathBuf;
use std::sync::Arc;

/// The keys that end a dialog.
const KEYS: &str = "Enter takes it, typing replaces it, Esc leaves it";
const KEYS_OF_TWO: &str = "Enter writes it, Up and Down the other line, Esc leaves it";

/// A form on top of the lab, and what it is for.
#[derive(Clone, Debug)]
pub struct Dialog {
    asking: Asking,
    form: Form,
    /// A file that exists, of which the user has been told.
    told_of: Option<PathBuf>,
}

/// What is asked for.
#[derive(Clone, Debug)]
pub(super) enum Asking {
    /// The value of the line that is selected.
    Value,
    /// A step or a time.
    GoTo,
    /// Where the rows of a run go, and how many of them.
    Export(Arc<Scenario>),
    /// Where the run file goes, of the run up to this step.
    SaveRun(u64),
    /// Where the scenario of the present state goes, which is this text.
    SavePresent(String),
}

impl Dialog {
    /// What it looks like.
    pub fn form(&self) -> &Form {
        &self.form
    }
}

impl Lab {
    /// Opens a dialog with `fields` (label and text each).
    pub(super) fn ask(
        &mut self,
        asking: Asking,
        title: &str,
        fields: &[(&str, String)],
        info: &[&str],
    ) {
        let keys = if fields.len() > 1 { KEYS_OF_TWO } else { KEYS };
        let fields = fields
            .iter()
            .map(|(label, text)| Field::new(label, text))
            .collect();
        let mut form = Form::new(title, fields, keys);
        form.info = info.iter().map(|line| (*line).to_owned()).collect();
        self.dialog = Some(Dialog {
            asking,
            form,
            told_of: None,
        });
        self.mode = Mode::Dialog;
    }

    pub(super) fn close_dialog(&mut self) {
        self.dialog = None;
        self.mode = Mode::Lab;
    }

    pub(super) fn type_char(&mut self, typed: char) {
        match &mut self.dialog {
            Some(dialog) => dialog.form.type_char(typed),
            None => self.browser.type_char(typed),
        }
        self.look_at_export();
    }

    /// Takes a pasted `text` where text is typed. Anywhere else it does nothing: its letters are not meant as keys.
    pub fn paste(&mut self, text: &str) {
        self.count = None;
        self.notice.take_back();
        self.was_warned = false;
        self.changed = true;
        match (&mut self.dialog, self.mode) {
            (Some(dialog), _) => dialog.form.paste(text),
            (None, Mode::Filter) => {
                if !self.browser.paste(text) {
                    let most = super::browser::MOST_TYPED;
                    self.say(format!(
                        "the filter takes at most {most} characters: what was pasted is cut"
                    ));
                }
            }
            _ => self.say("what is pasted goes into fields and the filter; here it does nothing"),
        }
        self.look_at_export();
    }

    pub(super) fn erase(&mut self) {
        match &mut self.dialog {
            Some(dialog) => dialog.form.erase(),
            None => self.browser.erase(),
        }
        self.look_at_export();
    }

    pub(super) fn edit_field(&mut self, edit: FieldEdit) {
        let Some(form) = self.dialog.as_mut().map(|dialog| &mut dialog.form) else {
            return;
        };
        match edit {
            FieldEdit::Delete => form.delete(),
            FieldEdit::Clear => form.clear(),
            FieldEdit::Left => form.left(),
            FieldEdit::Right => form.right(),
            FieldEdit::Home => form.home(),
            FieldEdit::End => form.end(),
            FieldEdit::Next => form.next_field(),
            FieldEdit::Previous => form.previous_field(),
        }
        self.look_at_export();
    }

    /// Does with what is typed what it was asked for. What is refused stays, with the reason.
    pub(super) fn accept(&mut self) {
        let Some(dialog) = self.dialog.take() else {
            return;
        };
        self.mode = Mode::Lab;
        let (text, second) = (dialog.form.text(0), dialog.form.text(1));
        let path = self.files.path_of(text);
        let force = dialog.told_of.as_deref() == Some(&*path);
        let answer = match &dialog.asking {
            Asking::Value => self.carry_out_typed(self.values.value_typed(
                text,
                self.run().scenario(),
                self.motion().time_step_s,
            )),
            Asking::GoTo => self.carry_out_typed(self.place_typed(text).map(Some)),
            Asking::Export(scenario) => match every(second) {
                Ok(every) => self.carry_out(&Command::Export {
                    path: text.to_owned(),
                    every,
                    to_step: Some(scenario.steps),
                    force,
                }),
                Err(reason) => Err(reason.into()),
            },
            Asking::SaveRun(to_step) => self.carry_out(&Command::Save {
                path: text.to_owned(),
                from_here: false,
                to_step: Some(*to_step),
                force,
            }),
            // The state as it was when it was asked for: the run may have gone on since.
            Asking::SavePresent(content) => self.files.save("the scenario", content, &path, force),
        };
        match answer {
            Ok(_) => self.tell_answer(answer),
            Err(refusal) => {
                self.dialog = Some(refused(dialog, refusal));
                self.mode = Mode::Dialog;
            }
        }
    }

    /// Carries out the command that was typed, if one was.
    fn carry_out_typed(&mut self, typed: Result<Option<Command>, String>) -> Answer {
        match typed? {
            Some(command) => self.carry_out(&command),
            None => Ok(Done::SILENT),
        }
    }

    pub(super) fn ask_for_export(&mut self) {
        if self.files.is_exporting() {
            return self.say("one export at a time: Esc stops the one under way");
        }
        let scenario = match self.run_until_step(None, "export") {
            Ok(scenario) => scenario,
            Err(reason) => return self.say(reason),
        };
        let path = self.files.free_name(self.name(), "", "csv");
        let fields = [("file", path), ("every", "1".to_owned())];
        let title = format!("export steps 0 to {} as CSV", scenario.steps);
        self.ask(Asking::Export(scenario), &title, &fields, &[]);
        self.look_at_export();
    }

    /// The run from step 0 to `to_step`, or to where it stands, if there is one to `act` on.
    ///
    /// # Errors
    /// Why there is none.
    pub(super) fn run_until_step(
        &self,
        to_step: Option<u64>,
        act: &str,
    ) -> Result<Arc<Scenario>, String> {
        let step = to_step.unwrap_or(self.player.playback.step_number());
        if step == 0 {
            return Err(format!(
                "there is nothing to {act} yet: the run stands at step 0"
            ));
        }
        let file = self.history.present().journal.file_until(step);
        let run = Document::from_file("the run", &file).and_then(|document| document.scenario());
        run.map(Arc::new).map_err(|problems| problems.in_one_line())
    }

    /// Says what the export that is asked for would come to.
    fn look_at_export(&mut self) {
        let Some(dialog) = &mut self.dialog else {
            return;
        };
        let Asking::Export(scenario) = &dialog.asking else {
            return;
        };
        dialog.form.info = match every(dialog.form.text(1)) {
            Ok(every) => {
                let Estimate { rows, bytes } = exporting::estimate(scenario, every);
                let rows = format!("{} rows, about {}", HumanCount(rows), DecimalBytes(bytes));
                vec![
                    rows,
                    "every 10 writes each tenth row, and the last".to_owned(),
                ]
            }
            Err(reason) => vec![reason],
        };
    }

    /// Looks after the export under way; says what has become of it.
    pub(super) fn follow_export(&mut self) {
        self.changed |= self.files.is_exporting();
        if let Some(text) = self.files.follow_export() {
            self.notice.keep_saying(text);
        }
    }

    /// Whether the lab may end: not at the first word while an export is under way.
    pub(super) fn may_quit(&mut self, was_warned: bool) -> bool {
        if !self.files.is_exporting() || was_warned {
            return true;
        }
        self.was_warned = true;
        self.say("an export is under way: q again leaves it unfinished, and writes nothing");
        false
    }

    pub(super) fn ask_where_to_save_the_run(&mut self) {
        let scenario = match self.run_until_step(None, "save") {
            Ok(scenario) => scenario,
            Err(reason) => return self.say(reason),
        };
        let later = self.history.present().journal.later_than(scenario.steps);
        let left_out =
            format!("without {later} later actions: go to the end of the run to have them in it");
        let up_to = format!(
            "the run up to step {}: gyrolab run FILE gives the same rows as x",
            scenario.steps
        );
        let info = match later {
            0 => vec![up_to.as_str()],
            _ => vec![up_to.as_str(), left_out.as_str()],
        };
        let path = self.files.free_name(self.name(), "-run", "toml");
        self.ask(
            Asking::SaveRun(scenario.steps),
            "save the run file",
            &[("file", path)],
            &info,
        );
    }

    pub(super) fn ask_where_to_save_the_present(&mut self) {
        match self.present_as_text() {
            Err(reason) => self.say(reason),
            Ok(content) => {
                let path = self.files.free_name(self.name(), "-from-here", "toml");
                let info = "a scenario that starts from the state on the screen";
                self.ask(
                    Asking::SavePresent(content),
                    "save the present state",
                    &[("file", path)],
                    &[info],
                );
            }
        }
    }

    /// The scenario that starts from the present state, as TOML.
    ///
    /// # Errors
    /// Why there is none.
    pub(super) fn present_as_text(&self) -> Result<String, String> {
        let run = self.run().simulation();
        let scenario = scenario_from(run.scenario(), run.state(), run.step_number())
            .map_err(|problems| problems.in_one_line())?;
        toml::to_string(&scenario.file).map_err(|error| error.to_string())
    }
}

/// The dialog again, with the reason.
fn refused(mut dialog: Dialog, refusal: Refusal) -> Dialog {
    let (complaint, told_of) = match refusal {
        Refusal::Because(reason) => {
            dialog.form.mark();
            (reason, None)
        }
        Refusal::Exists(path) => (
            format!("{} exists: Enter again replaces it", Shown(&path)),
            Some(path),
        ),
    };
    let form = Form {
        complaint: Some(complaint),
        ..dialog.form
    };
    Dialog {
        form,
        told_of,
        ..dialog
    }
}

fn every(text: &str) -> Result<NonZeroU64, String> {
    text.trim()
        .parse()
        .map_err(|_| "every must be a whole number, 1 or more".to_owned())
}
