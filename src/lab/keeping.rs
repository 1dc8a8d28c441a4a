//! The content of a session: the history of runs, and the place of the lab in it, each as TOML.

mod resuming;

use super::Lab;
use super::command::{self, Command};
use super::rerun::Reference;
use super::view::Look;
use crate::journal::Journal;
use crate::journal::history::History;
use crate::journal::next_push::NextPush;
use crate::playback::pace::Speed;
use crate::scenario::Problems;
use crate::scenario::file::ScenarioFile;
use crate::storage::session::{Content, Text, later};
use crate::text::printable::Shown;
use serde::{Deserialize, Serialize};

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct KeptWork {
    history: History,
    pinned: Option<KeptPinned>,
}

/// The pinned run: its pictures are made again from its scenario.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct KeptPinned {
    /// The step up to which it was played; of no meaning for the present run.
    step: u64,
    /// The run file with all that was done to the run; `None` where the present run is pinned.
    run: Option<ScenarioFile>,
}

impl KeptPinned {
    fn of(reference: &Reference) -> Self {
        let run = reference.run.as_ref();
        Self {
            step: reference.step,
            run: run.map(|scenario| scenario.file.clone()),
        }
    }

    /// What is to be pinned again.
    fn reference(self) -> Result<Reference, Problems> {
        let run = self.run.map(|file| Journal::of(file).scenario());
        Ok(Reference {
            step: self.step,
            run: run.transpose()?,
        })
    }
}

/// The text of the place: the step, how the run is shown, and the push to come.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct KeptPlace {
    step: u64,
    speed: Speed,
    shows_exact: bool,
    focus: String,
    filled: bool,
    look: Look,
    exporting: Option<String>,
    /// The measured data beside the run.
    measured: Option<String>,
    next_push: NextPush,
    script: Option<KeptScript>,
    /// What the room of the lessons keeps.
    lessons: Option<toml::Table>,
}

/// The commands of the script that were not complete, as a file of commands. The first lead back to the command under
/// way: it is carried out again, but steps that were under way are only taken to their end.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct KeptScript {
    /// The file from which they were read, as the user named it.
    origin: String,
    commands: String,
}

/// What a list of sessions shows of a session.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Summary {
    /// The name under which the user opened the scenario: a preset or a file.
    pub name: String,
    /// The title of the run.
    pub title: String,
    /// The step of the run.
    pub step: u64,
}

/// Why the content of a session cannot be read.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct Unreadable(String);

impl Lab {
    pub fn content(&mut self) -> Content {
        Content {
            work: self.work.kept(self.player.reference()),
            place: toml::to_string(&self.place()).unwrap_or_default(),
        }
    }

    /// What a list of sessions shows of `content`.
    pub fn summary(content: &Content) -> Result<Summary, Unreadable> {
        let work: KeptWork = read("the run", &content.work)?;
        let place: KeptPlace = read("the place in it", &content.place)?;
        let present = work.history.present();
        Ok(Summary {
            name: present.name.clone(),
            title: present.journal.file().title,
            step: place.step,
        })
    }

    /// What is kept of the lessons in `content`; `None` where nothing is, or it cannot be read.
    pub fn lessons_in(content: &Content) -> Option<toml::Table> {
        read::<KeptPlace>("the place in it", &content.place)
            .ok()?
            .lessons
    }

    fn place(&self) -> KeptPlace {
        KeptPlace {
            step: self.player.step_to_keep(),
            speed: self.player.playback.speed(),
            shows_exact: self.player.run().shows_exact(),
            focus: self.view.focus.id().to_owned(),
            filled: self.view.filled,
            look: self.view.look.clone(),
            exporting: self.files.exported_to().map(|path| Shown(path).to_string()),
            measured: self.measured_to_keep(),
            next_push: self.values.next_push.clone(),
            script: self.kept_script(),
            lessons: self.lessons.clone(),
        }
    }

    /// The commands of the script that are not complete; `None` where all are.
    fn kept_script(&self) -> Option<KeptScript> {
        if self.script.is_done() {
            return None;
        }
        let plays = self.plays_again() || self.script.is_held && self.script.plays_again;
        let run = plays.then_some(Command::Run);
        let again = self.under_way_again(false).map(|placed| placed.command);
        let left = self.script.left().cloned();
        let commands: Vec<_> = run.into_iter().chain(again).chain(left).collect();
        Some(KeptScript {
            origin: self.script.origin.clone(),
            commands: command::to_toml(&commands),
        })
    }
}

/// `history` as a session keeps it, with the pinned run. The text is written by the thread that first reads it.
pub(super) fn written(history: &History, reference: Option<&Reference>) -> Text {
    let (history, reference) = (history.clone(), reference.cloned());
    later(move || {
        let work = KeptWork {
            history,
            pinned: reference.as_ref().map(KeptPinned::of),
        };
        toml::to_string(&work).unwrap_or_default()
    })
}

fn read<'a, T: Deserialize<'a>>(what: &str, text: &'a str) -> Result<T, Unreadable> {
    toml::from_str(text).map_err(|error| {
        let line = error.message().lines().next().unwrap_or_default();
        Unreadable(format!("{what} is not what gyrolab keeps: {line}"))
    })
}
