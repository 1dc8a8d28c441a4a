//! A dialog: the form that the user fills in, and what the answer is for.

use super::action::{Ask, FieldEdit};
use super::answer::Refusal;
use super::command::{Command, Export, FigureCommand, Save, SeekTarget};
use super::edits::Edits;
use super::files::{Files, run_up_to};
use super::form::{InputField, InputForm};
use super::player::{Player, WHERE};
use super::settings::SETTINGS;
use super::values::Values;
use super::values::list::ValueSource;
use super::view::{Pane, View};
use crate::engine::export::CsvLayout;
use crate::engine::journal::parameters::Parameter;
use crate::engine::scenario::Scenario;
use crate::engine::scenario::keys::Effect;
use crate::engine::text::printable::PrintablePath;
use crate::lab::storage::exporting::{self, Estimate};
use crate::report::figure::kind::RUN_FIGURE_NAMES;
use indicatif::{DecimalBytes, HumanCount};
use std::num::NonZeroU64;
use std::path::{Path, PathBuf};
use std::sync::Arc;

const DIALOG_KEYS: &str = "Enter takes it, typing replaces it, Esc leaves it";
const KEYS_OF_TWO: &str = "Enter writes it, Up and Down the other line, Esc leaves it";

const KEYS_OF_SETTINGS: &str = "Up and Down choose, Left and Right or Enter change it, Esc closes";

/// A form on top of the panes, and the question that it asks.
#[derive(Clone, Debug)]
pub struct Dialog {
    pub(super) question: DialogKind,
    pub form: InputForm,
    /// The existing file that the user was last asked about: the next Enter replaces it.
    asked_to_replace: Option<PathBuf>,
}

#[derive(Clone, Debug)]
pub(super) enum DialogKind {
    /// The value of the selected line of the parameters pane.
    Value,
    GoTo,
    /// The CSV file for the rows of this run, and how many of the rows to write.
    Export(Arc<Scenario>),
    /// The file for a figure of the run up to this step, and its kind.
    Figure(u64),
    /// The run file for the run up to this step.
    SaveRun(u64),
    /// The file for this text, a scenario that starts from the present state. The text was made when the dialog was
    /// opened, since the run may go on while the user types.
    SavePresent(String),
    /// A number that a room above the lab asks for.
    Number,
    /// Other values of the settings. Nothing is typed here.
    Settings,
}

impl Dialog {
    /// Asks for a step or a time to go to.
    pub(super) fn go_to() -> Self {
        let fields = [("to", String::new())];
        Self::new(DialogKind::GoTo, "go to a step or a time", &fields, [WHERE])
    }

    /// Asks for the selected one of `values`; `None` if none is shown.
    pub(super) fn value(values: &Values) -> Option<Self> {
        let value = values.list.selected()?;
        let title = match &value.key {
            Some(key) => key.to_owned(),
            None => format!("{} {}", value.group, value.label),
        };
        let label = match value.unit {
            "" => value.label.clone(),
            unit => format!("{}, {unit}", value.label),
        };
        let about = match &value.source {
            ValueSource::Scenario(parameter) => about(parameter),
            ValueSource::NextPush(field) => vec![
                field.about().to_owned(),
                "it acts when p gives the push".to_owned(),
            ],
        };
        let fields = [(label.as_str(), value.text.clone())];
        Some(Self::new(DialogKind::Value, &title, &fields, about))
    }

    /// Opens the dialog that asks for what `ask` says.
    ///
    /// # Errors
    /// Why there is nothing to ask for now.
    pub(super) fn open(
        ask: Ask,
        files: &Files,
        edits: &Edits,
        player: &Player,
        view: &View,
    ) -> Result<Self, String> {
        let runs = &edits.runs;
        let free_name = |about, extension| files.free_name(runs.name(), about, extension);
        match ask {
            Ask::Value => {
                let nothing = "no value to set has that in its name: Esc shows all of them";
                Self::value(&edits.values).ok_or_else(|| nothing.to_owned())
            }
            Ask::Export | Ask::Figure if files.is_exporting() => {
                Err("one export at a time: Esc stops the one under way".to_owned())
            }
            Ask::Export => {
                let scenario = run_up_to(None, "export", runs, player)?;
                Ok(Self::export(scenario, free_name("", "csv")))
            }
            Ask::Figure => {
                let step = run_up_to(None, "draw", runs, player)?.steps;
                Ok(Self::figure(step, free_name("", "pdf"), view.focus))
            }
            Ask::RunFile => {
                let step = run_up_to(None, "save", runs, player)?.steps;
                let later = runs.journal().later_than(step);
                Ok(Self::save_run(step, later, free_name("-run", "toml")))
            }
            Ask::Present => {
                let path = free_name("-from-here", "toml");
                Ok(Self::save_present(player.present_as_text()?, path))
            }
            Ask::Settings => Ok(Self::settings(view, 0)),
            Ask::Place => Ok(Self::go_to()),
        }
    }

    /// Asks for the CSV file of the run `scenario`; it offers `path`.
    fn export(scenario: Arc<Scenario>, path: String) -> Self {
        let fields = [("file", path), ("every", "1".to_owned())];
        let title = format!(
            "export steps 0 to {}, where x was pressed, as CSV",
            scenario.steps
        );
        let mut dialog = Self::new(DialogKind::Export(scenario), &title, &fields, [""; 0]);
        dialog.show_estimate();
        dialog
    }

    /// Asks for the file of a figure of the run up to `step`; it offers `path` and the picture of the
    /// pane in `focus`.
    fn figure(step: u64, path: String, focus: Pane) -> Self {
        let kind = match focus {
            Pane::Above | Pane::ThreeD => focus.id(),
            _ => Pane::Traces.id(),
        };
        let fields = [("file", path), ("kind", kind.to_owned())];
        let kinds = RUN_FIGURE_NAMES.join(", ");
        let info = [
            "the file's end says in which form: .svg, .pdf or .png".to_owned(),
            format!("kind: {kinds}, or columns such as tilt_deg,energy_J"),
        ];
        let title = format!("draw steps 0 to {step}");
        Self::new(DialogKind::Figure(step), &title, &fields, info)
    }

    /// Asks for the run file of the run up to `step`, which leaves out `later` actions; it offers `path`.
    fn save_run(step: u64, later: usize, path: String) -> Self {
        let left_out =
            format!("without {later} later actions: go to the end of the run to have them in it");
        let up_to = format!("the run up to step {step}: gyrolab run FILE gives the same rows as x");
        let info = [up_to].into_iter().chain((later > 0).then_some(left_out));
        let fields = [("file", path)];
        Self::new(
            DialogKind::SaveRun(step),
            "save the run file",
            &fields,
            info,
        )
    }

    /// Asks for the file of the scenario `content`; it offers `path`.
    fn save_present(content: String, path: String) -> Self {
        let info = "a scenario that starts from the state on the screen";
        let question = DialogKind::SavePresent(content);
        let title = "save the present state";
        Self::new(question, title, &[("file", path)], [info])
    }

    pub(super) fn number(title: &str, label: &str, about: &str) -> Self {
        let fields = [(label, String::new())];
        Self::new(DialogKind::Number, title, &fields, [about])
    }

    /// Lists the settings with the values that they have in `view`; the one of this number is selected.
    pub(super) fn settings(view: &View, selected: usize) -> Self {
        let info = "dots, colours, frames and mouse are remembered for the next time";
        let mut dialog = Self::new(DialogKind::Settings, "settings", &[], [info]);
        let fields = SETTINGS.iter();
        dialog.form.fields = fields
            .map(|setting| InputField::choice(setting.label, &(setting.value)(view)))
            .collect();
        dialog.form.keys = KEYS_OF_SETTINGS;
        dialog.form.selected = selected;
        dialog
    }

    /// Creates a dialog with `fields`, each with its label and the text that it offers, and the lines `info` below them.
    fn new(
        question: DialogKind,
        title: &str,
        fields: &[(&str, String)],
        info: impl IntoIterator<Item: Into<String>>,
    ) -> Self {
        let keys = if fields.len() > 1 {
            KEYS_OF_TWO
        } else {
            DIALOG_KEYS
        };
        let inputs = fields
            .iter()
            .map(|(label, text)| InputField::new(label, text));
        let mut form = InputForm::new(title, inputs.collect(), keys);
        form.info = info.into_iter().map(Into::into).collect();
        Self {
            question,
            form,
            asked_to_replace: None,
        }
    }

    pub fn is_of_settings(&self) -> bool {
        matches!(self.question, DialogKind::Settings)
    }

    /// Returns whether the user has confirmed that the existing file `path` is to be replaced.
    pub(super) fn may_replace(&self, path: &Path) -> bool {
        self.asked_to_replace.as_deref() == Some(path)
    }

    /// Returns the command that the answer stands for; `None` where it changes nothing.
    ///
    /// # Errors
    /// Why it is refused.
    pub(super) fn command(
        &self,
        files: &Files,
        values: &Values,
        player: &Player,
    ) -> Result<Option<Command>, String> {
        let path = self.form.text(0).to_owned();
        let force = self.may_replace(&files.path_of(&path));
        Ok(Some(match &self.question {
            DialogKind::Value => {
                let time_step_s = player.motion().time_step_s;
                return values.value_typed(&path, player.run().scenario(), time_step_s);
            }
            DialogKind::GoTo => Command::GoTo(SeekTarget::Step(player.step_meant(&path)?)),
            DialogKind::Export(scenario) => Command::Export(Export {
                path,
                layout: CsvLayout::every(self.every()?).file().clone(),
                to_step: Some(scenario.steps),
                force,
            }),
            DialogKind::Figure(to_step) => Command::Figure(Box::new(FigureCommand {
                path,
                kind: self.form.text(1).trim().to_owned(),
                exact: player.run().overlay().is_some(),
                to_step: Some(*to_step),
                force,
            })),
            DialogKind::SaveRun(to_step) => Command::Save(Save {
                path,
                from_here: false,
                to_step: Some(*to_step),
                force,
            }),
            DialogKind::SavePresent(_) | DialogKind::Number | DialogKind::Settings => {
                return Ok(None);
            }
        }))
    }

    /// Returns the number that was typed; a comma may stand for the decimal point.
    pub(super) fn number_typed(&self) -> Result<f64, String> {
        match self.form.text(0).trim().replace(',', ".").parse() {
            Ok(number) if f64::is_finite(number) => Ok(number),
            _ => Err("must be a number, such as 2.5 or 1e-3".to_owned()),
        }
    }

    /// Returns the interval of the rows to write, as typed in the second field: 10 stands for each tenth row.
    fn every(&self) -> Result<NonZeroU64, String> {
        let text = self.form.text(1).trim();
        text.parse()
            .map_err(|_| "every must be a whole number, 1 or more".to_owned())
    }

    pub(super) fn paste(&mut self, text: &str) {
        self.edit(|form| form.paste(text));
    }

    /// Changes what is typed, where anything is.
    fn edit(&mut self, change: impl FnOnce(&mut InputForm)) {
        if !self.is_of_settings() {
            change(&mut self.form);
            self.show_estimate();
        }
    }

    pub(super) fn edit_field(&mut self, edit: FieldEdit) {
        match edit {
            FieldEdit::Next | FieldEdit::Previous => self.form.edit_field(edit),
            _ => self.edit(|form| form.edit_field(edit)),
        }
    }

    /// Shows how many rows and bytes an export would write. Other dialogs stay as they are.
    fn show_estimate(&mut self) {
        let DialogKind::Export(scenario) = &self.question else {
            return;
        };
        self.form.info = match self.every() {
            Ok(every) => {
                let Estimate { rows, bytes } = exporting::estimate(scenario, every);
                let (rows, bytes) = (HumanCount(rows), DecimalBytes(bytes));
                vec![
                    format!("{rows} rows, about {bytes}"),
                    "every 10 writes each tenth row, and the last".to_owned(),
                ]
            }
            Err(reason) => vec![reason],
        };
    }

    /// Returns the same dialog with the reason why the answer was refused.
    pub(super) fn with_error(mut self, refusal: Refusal) -> Self {
        self.asked_to_replace = None;
        let complaint = match refusal {
            Refusal::Because(reason) => {
                self.form.mark();
                reason
            }
            Refusal::Exists(path) => {
                let path = self.asked_to_replace.insert(path);
                format!("{} exists: Enter again replaces it", PrintablePath(path))
            }
        };
        self.form.info.retain(|line| *line != complaint); // it is said once
        self.form.complaint = Some(complaint);
        self
    }
}

/// Returns what the dialog says about a parameter: its meaning, its choices, and when a change takes effect.
fn about(parameter: &Parameter) -> Vec<String> {
    let mut lines = vec![parameter.spec.about.to_owned()];
    if parameter.value.is_bool() {
        lines.push("true or false".to_owned());
    }
    if !parameter.choices.is_empty() {
        lines.push(format!("one of {}", parameter.choices.join(", ")));
    }
    let when = match Effect::of_key(&parameter.key) {
        Effect::NewRun => "a new run begins with it; the one before stays, dotted",
        Effect::FromHere => "it acts from the next step on",
        Effect::None => "no number depends on it",
    };
    lines.push(when.to_owned());
    lines
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::for_tests::scenario;

    #[test]
    fn a_file_is_replaced_only_after_the_user_was_asked_about_it() {
        let dialog = Dialog::export(scenario(), "method-2.csv".to_owned());
        let (path, other) = (Path::new("method-2.csv"), Path::new("other.csv"));
        assert!(!dialog.may_replace(path));
        let asking = dialog.with_error(Refusal::Exists(path.to_owned()));
        assert!(asking.may_replace(path) && !asking.may_replace(other));
        let refused = asking.with_error(Refusal::Because("no".to_owned()));
        assert!(!refused.may_replace(path));
        assert_eq!(refused.form.complaint.as_deref(), Some("no"));
    }

    #[test]
    fn a_run_file_says_what_it_leaves_out() {
        let info = |later| Dialog::save_run(7, later, String::new()).form.info;
        assert_eq!(info(0).len(), 1);
        assert!(info(3)[1].starts_with("without 3 later actions"));
    }
}
