//! A dialog: the form that the user fills in, and its purpose.

use super::action::{Ask, FieldEdit};
use super::answer::Refusal;
use super::command::{Command, Export, FigureCommand, Save, SeekTarget};
use super::edits::Edits;
use super::files::{Files, run_up_to};
use super::form::{InputField, InputForm, edit_line, type_into};
use super::player::{Player, WHERE};
use super::settings::SETTINGS;
use super::values::Values;
use super::values::list::{ListedValue, Match, ValueSource};
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

const DIALOG_KEYS: &str = "Enter: apply   Esc: cancel";
const KEYS_OF_TWO: &str = "Enter: write the file   Tab: next field   Esc: cancel";
const KEYS_OF_SETTINGS: &str = "Left, Right or Enter: change   Esc: close";

/// A form on top of the panes, and its purpose.
#[derive(Clone, Debug)]
pub struct Dialog {
    pub(super) question: DialogKind,
    pub form: InputForm,
    /// The existing file that the next Enter replaces, after the user was asked.
    asked_to_replace: Option<PathBuf>,
}

#[derive(Clone, Debug)]
pub(super) enum DialogKind {
    /// A value of the selected row of the values pane.
    Value(ValueEffect),
    GoTo,
    /// The CSV file for the rows of this run, and the interval of the rows.
    Export(Arc<Scenario>),
    /// The file of a figure of the run up to this step, and its kind.
    Figure(u64),
    /// The run file of the run up to this step.
    SaveRun(u64),
    /// The file for this text, a scenario that starts from the present state. The text was created when the dialog was
    /// opened, because the run may continue while the user types.
    SavePresent(String),
    /// A number in this unit, requested by a module above the lab.
    Number(String),
    /// New values of the settings.
    Settings {
        /// The typed text. Only settings whose labels match it are listed.
        filter: String,
        /// The rows of all settings.
        all: Vec<InputField>,
    },
}

/// The time at which a typed value takes effect.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ValueEffect {
    /// At once, because it does not change the motion.
    AtOnce,
    /// From the start of a new run.
    Rerun,
    /// The same as `Rerun`, but Tab switches to `FromNowOn`.
    RerunByChoice,
    /// From the next step on. Tab switches to `RerunByChoice`.
    FromNowOn,
}

impl ValueEffect {
    fn of(value: &ListedValue) -> Self {
        match value.key.as_deref().map(Effect::of_key) {
            None | Some(Effect::None) => Self::AtOnce,
            Some(Effect::NewRun) => Self::Rerun,
            Some(Effect::FromHere) => Self::RerunByChoice,
        }
    }

    fn other(self) -> Self {
        match self {
            Self::RerunByChoice => Self::FromNowOn,
            Self::FromNowOn => Self::RerunByChoice,
            only => only,
        }
    }

    fn keys(self) -> &'static str {
        match self {
            Self::AtOnce => DIALOG_KEYS,
            Self::Rerun => "Enter: rerun from the start  Esc: cancel",
            Self::RerunByChoice => "Enter: rerun from the start  Tab: from now on  Esc: cancel",
            Self::FromNowOn => "Enter: from now on  Tab: rerun from the start  Esc: cancel",
        }
    }
}

impl Dialog {
    /// Creates a dialog that asks for a step or a time to go to.
    pub(super) fn go_to() -> Self {
        let fields = [("to", String::new())];
        Self::new(DialogKind::GoTo, "go to a step or a time", &fields, [WHERE])
    }

    /// Creates a dialog that asks for the selected value; `None` if no value is shown.
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
            ValueSource::Derived(derived, _) => vec![derived.about().to_owned()],
            ValueSource::NextPush(field) => vec![
                field.about().to_owned(),
                "it takes effect when p starts the push".to_owned(),
            ],
        };
        let fields = [(label.as_str(), value.text.clone())];
        let effect = ValueEffect::of(value);
        let mut dialog = Self::new(DialogKind::Value(effect), &title, &fields, about);
        dialog.form.keys = effect.keys();
        Some(dialog)
    }

    /// Creates the dialog for the purpose `ask`.
    ///
    /// # Errors
    /// Returns an error if there is nothing to ask for now.
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
                let nothing = "no editable value matches: Esc shows all of them";
                Self::value(&edits.values).ok_or_else(|| nothing.to_owned())
            }
            Ask::Export | Ask::Figure if files.is_exporting() => {
                Err("one export at a time: Esc stops the running one".to_owned())
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
            Ask::Settings => Ok(Self::settings(view, "", 0)),
            Ask::Place => Ok(Self::go_to()),
        }
    }

    /// Creates a dialog that asks for the CSV file of the run `scenario`, and suggests `path`.
    fn export(scenario: Arc<Scenario>, path: String) -> Self {
        let fields = [("file", path), ("every", "1".to_owned())];
        let title = format!(
            "export steps 0 to {} (where x was pressed) as CSV",
            scenario.steps
        );
        let mut dialog = Self::new(DialogKind::Export(scenario), &title, &fields, [""; 0]);
        dialog.show_estimate();
        dialog
    }

    /// Creates a dialog that asks for the file of a figure of the run up to `step`. It suggests `path` and the figure
    /// of the pane in `focus`.
    fn figure(step: u64, path: String, focus: Pane) -> Self {
        let kind = match focus {
            Pane::Above | Pane::ThreeD => focus.id(),
            _ => Pane::Traces.id(),
        };
        let fields = [("file", path), ("kind", kind.to_owned())];
        let kinds = RUN_FIGURE_NAMES.join(", ");
        let info = [
            "the extension selects the format: .svg, .pdf or .png".to_owned(),
            format!("kind: {kinds}, or columns such as tilt_deg,energy_J"),
        ];
        let title = format!("draw steps 0 to {step}");
        Self::new(DialogKind::Figure(step), &title, &fields, info)
    }

    /// Creates a dialog that asks for the run file of the run up to `step`, and suggests `path`. The file does not
    /// contain `later` actions.
    fn save_run(step: u64, later: usize, path: String) -> Self {
        let left_out =
            format!("without {later} later actions: go to the end of the run to include them");
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

    /// Creates a dialog that asks for the file of the scenario `content`, and suggests `path`.
    fn save_present(content: String, path: String) -> Self {
        let info = "a scenario that starts from the state on the screen";
        let question = DialogKind::SavePresent(content);
        let title = "save the present state";
        Self::new(question, title, &[("file", path)], [info])
    }

    /// Creates a dialog that asks for a number in `unit`, which is empty for a pure number.
    pub(super) fn number(title: &str, unit: &str, about: &str) -> Self {
        let label = if unit.is_empty() { "number" } else { unit };
        let fields = [(label, String::new())];
        Self::new(DialogKind::Number(unit.to_owned()), title, &fields, [about])
    }

    /// Creates a dialog that lists the settings whose labels match `filter`, with their values in `view`. The row
    /// `selected` is selected.
    pub(super) fn settings(view: &View, filter: &str, selected: usize) -> Self {
        let info = "markers, colors, background, frame rate and mouse are saved";
        let settings = SETTINGS.iter();
        let all = settings
            .map(|setting| InputField::choice(setting.label, &(setting.value)(view)))
            .collect();
        let filter = filter.to_owned();
        let mut dialog = Self::new(DialogKind::Settings { filter, all }, "", &[], [info]);
        dialog.form.keys = KEYS_OF_SETTINGS;
        dialog.filter_settings(|_| {});
        dialog.form.select(selected);
        dialog
    }

    /// Changes the filter of the settings, and lists the settings that match it.
    fn filter_settings(&mut self, change: impl FnOnce(&mut String)) {
        let DialogKind::Settings { filter, all } = &mut self.question else {
            return;
        };
        change(filter);
        let matching = all
            .iter()
            .filter(|field| Match::find(&field.label, filter).is_some());
        self.form.fields = matching.cloned().collect();
        self.form.selected = 0;
        self.form.title = if filter.is_empty() {
            "settings: type to filter".to_owned()
        } else {
            format!("settings: {filter}_ ({})", self.form.fields.len())
        };
    }

    /// Clears the filter of the settings. Returns false if there was none.
    pub(super) fn clear_filter(&mut self) -> bool {
        let is_filtered = self
            .setting_filter()
            .is_some_and(|filter| !filter.is_empty());
        if is_filtered {
            self.filter_settings(String::clear);
        }
        is_filtered
    }

    /// Returns the filter of the settings; `None` in another dialog.
    pub(super) fn setting_filter(&self) -> Option<&str> {
        match &self.question {
            DialogKind::Settings { filter, .. } => Some(filter),
            _ => None,
        }
    }

    /// Returns the index of the selected setting in [`SETTINGS`].
    pub(super) fn selected_setting(&self) -> Option<usize> {
        let label = &self.form.fields.get(self.form.selected)?.label;
        SETTINGS.iter().position(|setting| setting.label == label)
    }

    /// Creates a dialog with `fields`, each with its label and suggested text, and the lines `info` below them.
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

    /// Returns true if the dialog asks for a value, in its row of the values pane.
    pub fn is_of_value(&self) -> bool {
        matches!(self.question, DialogKind::Value(_))
    }

    pub fn is_of_settings(&self) -> bool {
        self.setting_filter().is_some()
    }

    /// Returns true if the user has confirmed replacing the existing file `path`.
    pub(super) fn may_replace(&self, path: &Path) -> bool {
        self.asked_to_replace.as_deref() == Some(path)
    }

    /// Returns the command of the answer; `None` if it changes nothing.
    ///
    /// # Errors
    /// Returns an error if the answer is refused.
    pub(super) fn command(
        &self,
        files: &Files,
        values: &Values,
        player: &Player,
    ) -> Result<Option<Command>, String> {
        let path = self.form.text(0).to_owned();
        let force = self.may_replace(&files.path_of(&path));
        Ok(Some(match &self.question {
            DialogKind::Value(effect) => {
                let time_step_s = player.motion().time_step_s;
                let from_now_on = *effect == ValueEffect::FromNowOn;
                let scenario = player.run().scenario();
                return values.value_typed(&path, from_now_on, scenario, time_step_s);
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
            DialogKind::SavePresent(_) | DialogKind::Number(_) | DialogKind::Settings { .. } => {
                return Ok(None);
            }
        }))
    }

    /// Returns the interval of the rows to write, as typed in the second field: 10 means every tenth row.
    fn every(&self) -> Result<NonZeroU64, String> {
        let text = self.form.text(1).trim();
        text.parse()
            .map_err(|_| "every must be a whole number, 1 or more".to_owned())
    }

    pub(super) fn paste(&mut self, text: &str) {
        if self.is_of_settings() {
            self.filter_settings(|filter| type_into(filter, text));
        } else {
            self.edit(|form| form.paste(text));
        }
    }

    fn edit(&mut self, change: impl FnOnce(&mut InputForm)) {
        change(&mut self.form);
        self.show_estimate();
    }

    pub(super) fn edit_field(&mut self, edit: FieldEdit) {
        match (&mut self.question, edit) {
            (DialogKind::Value(effect), FieldEdit::Next | FieldEdit::Previous) => {
                *effect = effect.other();
                self.form.keys = effect.keys();
            }
            (_, FieldEdit::Next | FieldEdit::Previous) => self.form.edit_field(edit),
            (DialogKind::Settings { .. }, FieldEdit::Home) => self.form.selected = 0,
            (DialogKind::Settings { .. }, FieldEdit::End) => {
                self.form.selected = self.form.fields.len().saturating_sub(1);
            }
            (DialogKind::Settings { .. }, edit) => {
                self.filter_settings(|filter| edit_line(filter, edit));
            }
            _ => self.edit(|form| form.edit_field(edit)),
        }
    }

    /// Shows the number of rows and bytes that an export would write. Does nothing in other dialogs.
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
                    "every 10 writes every tenth row, and the last".to_owned(),
                ]
            }
            Err(reason) => vec![reason],
        };
    }

    /// Returns the dialog with the reason why its answer was refused.
    pub(super) fn with_error(mut self, refusal: Refusal) -> Self {
        self.asked_to_replace = None;
        let complaint = match refusal {
            Refusal::Because(reason) => {
                self.form.mark();
                reason
            }
            Refusal::Exists(path) => {
                let path = self.asked_to_replace.insert(path);
                format!(
                    "{} exists: press Enter again to replace it",
                    PrintablePath(path)
                )
            }
        };
        self.form.info.retain(|line| *line != complaint); // shown only once
        self.form.complaint = Some(complaint);
        self
    }
}

/// Returns the lines about a parameter: its meaning and its choices.
fn about(parameter: &Parameter) -> Vec<String> {
    let mut lines = vec![parameter.spec.about.to_owned()];
    if parameter.value.is_bool() {
        lines.push("true or false".to_owned());
    }
    if !parameter.choices.is_empty() {
        lines.push(format!("one of {}", parameter.choices.join(", ")));
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::for_tests::scenario;

    #[test]
    fn a_file_is_replaced_only_after_confirmation() {
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
    fn the_save_dialog_states_what_it_omits() {
        let info = |later| Dialog::save_run(7, later, String::new()).form.info;
        assert_eq!(info(0).len(), 1);
        assert!(info(3)[1].starts_with("without 3 later actions"));
    }
}
