//! The dialogs: the text that a dialog for a file offers, and the command that an answered dialog stands for.

use super::action::{Action, FieldEdit};
use super::answer::{Answer, Done};
use super::command::{Command, Export, Figure, Place, Save};
use super::dialog::{Dialog, Question};
use super::view::Pane;
use super::{Lab, Request};
use crate::export::Layout;

impl Lab {
    /// Asks for a number, of which `typed` is there already: `title` says for what, `label` what it is and in which unit,
    /// `about` how to answer. It comes back as [`Request::Answer`].
    pub fn ask_number(&mut self, title: &str, label: &str, about: &str, typed: Option<u8>) {
        self.on_top.open_dialog(Dialog::number(title, label, about));
        if let Some(digit) = typed {
            let digit = char::from(b'0' + digit % 10);
            self.on_top.edit_field(FieldEdit::Type(digit));
        }
        self.changed = true;
    }

    /// The dialog that asks for the file of an export, a run file or a scenario of the present state.
    pub(super) fn dialog_for_a_file(&self, action: Action) -> Result<Dialog, String> {
        let free_name = |about, extension| self.files.free_name(self.work.name(), about, extension);
        match action {
            Action::Export | Action::Figure if self.files.is_exporting() => {
                Err("one export at a time: Esc stops the one under way".to_owned())
            }
            Action::Export => {
                let scenario = self.run_up_to(None, "export")?;
                Ok(Dialog::export(scenario, free_name("", "csv")))
            }
            Action::Figure => {
                let step = self.run_up_to(None, "draw")?.steps;
                let kind = match self.view.focus {
                    pane @ (Pane::FROM_ABOVE | Pane::THREE_D) => pane,
                    _ => Pane::TRACES,
                };
                Ok(Dialog::figure(step, free_name("", "pdf"), kind.id()))
            }
            Action::SaveRun => {
                let step = self.run_up_to(None, "save")?.steps;
                let later = self.work.journal().later_than(step);
                Ok(Dialog::save_run(step, later, free_name("-run", "toml")))
            }
            _ => {
                let content = self.player.present_as_text()?;
                Ok(Dialog::save_present(
                    content,
                    free_name("-from-here", "toml"),
                ))
            }
        }
    }

    /// Carries out the command that the open dialog asked for. If it is refused, the dialog stays and shows the reason.
    /// Returns the number that a room above asked for.
    pub(super) fn accept(&mut self) -> Option<Request> {
        let dialog = self.on_top.take_dialog()?;
        if let Question::Number = &dialog.question {
            match number_typed(dialog.form.text(0)) {
                Ok(number) => return Some(Request::Answer(number)),
                Err(reason) => self.on_top.open_dialog(dialog.refused(reason.into())),
            }
            return None;
        }
        let answer = self.answer_to(&dialog);
        match answer {
            Ok(_) => self.tell_answer(answer),
            Err(refusal) => self.on_top.open_dialog(dialog.refused(refusal)),
        }
        None
    }

    fn answer_to(&mut self, dialog: &Dialog) -> Answer {
        let text = dialog.form.text(0);
        let path = self.files.path_of(text);
        let force = dialog.may_replace(&path);
        let command = match &dialog.question {
            Question::Value => {
                let run = self.player.run();
                let time_step_s = self.player.motion().time_step_s;
                self.values.value_typed(text, run.scenario(), time_step_s)?
            }
            Question::GoTo => {
                let step = self.player.step_meant(text)?;
                Some(Command::GoTo(Place::Step(step)))
            }
            Question::Export(scenario) => Some(Command::Export(Export {
                path: text.to_owned(),
                layout: Layout::every(dialog.every()?).file().clone(),
                to_step: Some(scenario.steps),
                force,
            })),
            Question::Figure(to_step) => Some(Command::Figure(Figure {
                path: text.to_owned(),
                kind: dialog.form.text(1).trim().to_owned(),
                exact: self.player.run().overlay().is_some(),
                to_step: Some(*to_step),
                force,
            })),
            Question::SaveRun(to_step) => Some(Command::Save(Save {
                path: text.to_owned(),
                from_here: false,
                to_step: Some(*to_step),
                force,
            })),
            Question::Number | Question::Settings => None, // taken before
            Question::SavePresent(content) => {
                return self.files.save("the scenario", content, &path, force);
            }
        };
        command.map_or(Ok(Done::SILENT), |command| self.carry_out(&command))
    }
}

/// The number in `text`; a comma may stand for the decimal point.
fn number_typed(text: &str) -> Result<f64, String> {
    let text = text.trim().replace(',', ".");
    let number: Option<f64> = text.parse().ok();
    let number = number.filter(|number| number.is_finite());
    number.ok_or_else(|| "must be a number, such as 2.5 or 1e-3".to_owned())
}
