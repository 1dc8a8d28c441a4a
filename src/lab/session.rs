//! Converts the lab to and from the content of a session: the journal of its runs, and the present snapshot, each as
//! TOML.
//!
//! The files of sessions belong to [`storage`](super::storage).

use super::comparison::Comparison;
use super::edits::Edits;
use super::files::Files;
use super::runs::Reference;
use super::snapshot::Snapshot;
use super::view::{Pane, View};
use crate::engine::data::{ColumnOptions, ColumnSigma};
use crate::engine::journal::Journal;
use crate::engine::journal::next_push::NextPush;
use crate::engine::scenario::csv::Renaming;
use crate::engine::scenario::file::ScenarioFile;
use crate::engine::scenario::{Document, Problems, Scenario, keys};
use crate::engine::text::printable::PrintablePath;
use crate::lab::storage::session::{SessionContent, SharedText, later};
use serde::{Deserialize, Serialize};
use std::sync::Arc;
use toml::{Table, Value};

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct KeptRuns {
    journal: Journal,
    pinned: Option<KeptPinned>,
}

/// The pinned run. Its pictures are recomputed from its scenario.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct KeptPinned {
    /// The step up to which it was played; unused if the present run is pinned.
    step: u64,
    /// The run file with all edits; `None` if the present run is pinned.
    run: Option<ScenarioFile>,
}

impl KeptPinned {
    /// Returns the pinned run.
    pub(super) fn reference(self) -> Result<Reference, Problems> {
        let run = self
            .run
            .map(|file| Document::from_file("the pinned run", &file)?.scenario());
        Ok(Reference {
            step: self.step,
            run: run.transpose()?.map(Arc::new),
        })
    }
}

/// The part of a session besides its runs: the snapshot, and the state of this screen.
#[derive(Serialize, Deserialize)]
pub(super) struct KeptPlace {
    #[serde(flatten)]
    pub(super) snapshot: Snapshot,
    focus: String,
    filled: bool,
    exporting: Option<String>,
    /// The measured data shown with the run.
    pub(super) measured: Option<String>,
    /// The renamed columns of these data.
    #[serde(default)]
    map: Vec<Renaming>,
    /// The uncertainties for columns without any.
    #[serde(default)]
    sigma: Vec<ColumnSigma>,
    pub(super) next_push: NextPush,
    /// The state of the lessons, which the lab does not interpret.
    #[serde(default, skip_serializing_if = "Table::is_empty")]
    lessons: Table,
}

/// The entry of a session in a list.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SessionSummary {
    /// The name under which the user opened the scenario: a preset or a file.
    pub name: String,
    pub title: String,
    pub step: u64,
}

impl SessionSummary {
    pub fn read(content: &SessionContent) -> Result<Self, Unreadable> {
        let runs: KeptRuns = read("the run", &content.work)?;
        let place: KeptPlace = read("the state of the screen", &content.place)?;
        let present = runs.journal.present();
        Ok(Self {
            name: present.name.clone(),
            title: runs.journal.file().title,
            step: place.snapshot.step,
        })
    }
}

/// The reason why the content of a session cannot be read.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct Unreadable(String);

/// Returns the state of the lessons in `content`; empty if there is none or it cannot be read.
pub fn lessons_in(content: &SessionContent) -> Table {
    read("the state of the screen", &content.place)
        .map_or(Table::new(), |place: KeptPlace| place.lessons)
}

/// Returns the text of `journal` and the pinned run for a session. It is written on the thread that first reads it.
pub(super) fn written(journal: &Journal, reference: Option<&Reference>) -> SharedText {
    let (journal, reference) = (journal.clone(), reference.cloned());
    later(move || {
        let pinned = reference.map(|reference| KeptPinned {
            step: reference.step,
            run: reference.run.map(|scenario| scenario.file.clone()),
        });
        toml::to_string(&KeptRuns { journal, pinned }).unwrap_or_default()
    })
}

fn read<'a, T: Deserialize<'a>>(what: &str, text: &'a str) -> Result<T, Unreadable> {
    toml::from_str(text).map_err(|error| {
        let line = error.message().lines().next().unwrap_or_default();
        Unreadable(format!("{what} is not valid: {line}"))
    })
}

/// The parsed content of a session: the journal, its present scenario, the pinned run, and the rest.
pub(super) type KeptContent = (Journal, Arc<Scenario>, Option<KeptPinned>, KeptPlace);

pub(super) fn kept(content: &SessionContent) -> Result<KeptContent, Unreadable> {
    let KeptRuns { journal, pinned } = read("the run", &content.work)?;
    let place = read("the state of the screen", &content.place)?;
    let scenario = journal
        .scenario()
        .map_err(|problems| Unreadable(problems.in_one_line()))?;
    Ok((journal, scenario, pinned, place))
}

impl KeptPlace {
    pub(super) fn new(
        snapshot: Snapshot,
        comparison: &Comparison,
        edits: &Edits,
        files: &Files,
        view: &View,
        lessons: &Table,
    ) -> Self {
        let columns = comparison.data().map(|data| data.options.clone());
        let ColumnOptions { map, sigma } = columns.unwrap_or_default();
        let exported_to = files.exported_to();
        Self {
            snapshot,
            focus: view.focus.id().to_owned(),
            filled: view.fullscreen,
            exporting: exported_to.map(|path| PrintablePath(path).to_string()),
            measured: comparison.data_to_keep(files),
            map,
            sigma,
            next_push: edits.values.next_push.clone(),
            lessons: lessons.clone(),
        }
    }

    /// Returns the options of the columns of the measured data.
    pub(super) fn columns(&self) -> ColumnOptions {
        ColumnOptions {
            map: self.map.clone(),
            sigma: self.sigma.clone(),
        }
    }

    /// Restores the display of the session in `view`.
    pub(super) fn restore(&self, view: &mut View) -> Result<(), Unreadable> {
        let look = &self.snapshot.look;
        let table = Value::try_from(look).map_err(|error| Unreadable(error.to_string()))?;
        if let Some(problem) = keys::check_part(&table, "view").list.first() {
            return Err(Unreadable(problem.to_string()));
        }
        view.set_look(look.clone());
        view.focus = Pane::named(&self.focus)
            .ok_or_else(|| Unreadable(format!("there is no pane {}", self.focus)))?;
        view.fullscreen = self.filled;
        Ok(())
    }

    /// Returns the message about the restored session.
    pub(super) fn in_words(&self) -> String {
        match &self.exporting {
            Some(path) => {
                format!("session resumed; the export to {path} was cut off, x starts another")
            }
            None => "session resumed; space continues".to_owned(),
        }
    }
}
