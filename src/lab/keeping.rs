//! The content of a session: the history of runs, and the place of the lab in it, each as TOML.

use super::Lab;
use super::work::Work;
use crate::lab::view::View;
use crate::observe::pace::Speed;
use crate::scenario::{Problems, Scenario};
use crate::storage::confined::Confined;
use crate::storage::session::Content;
use crate::text::printable::Shown;
use crate::work::history::History;
use crate::work::next_push::NextPush;
use serde::{Deserialize, Serialize};
use std::path::Path;
use std::sync::Arc;

/// The version of this format, and the versions that can be read. Version 1 had other journals.
const FORM: u32 = 2;
const FORMS: std::ops::RangeInclusive<u32> = 1..=FORM;

/// The text of the work.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct KeptWork {
    form: u32,
    history: History,
}

/// The text of the place: the step, how the run is shown, and the push to come.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct KeptPlace {
    step: u64,
    /// Simulated seconds a second; `None` at top speed.
    #[serde(skip_serializing_if = "Option::is_none")]
    speed: Option<f64>,
    shows_exact: bool,
    window_s: f64,
    /// The id of the pane in focus.
    focus: String,
    filled: bool,
    /// The file of the export that was in progress.
    #[serde(skip_serializing_if = "Option::is_none")]
    exporting: Option<String>,
    next_push: NextPush,
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
    /// The content of the session.
    pub fn content(&mut self) -> Content {
        Content {
            work: self.work.kept(),
            place: toml::to_string(&self.place()).unwrap_or_default(),
        }
    }

    /// Checks that `content` can be read and would be written in the same way again.
    ///
    /// # Errors
    /// In words, where that is not so.
    pub fn check(content: &Content) -> Result<(), String> {
        let work = reads_back::<KeptWork>("the run", &content.work);
        let place = reads_back::<KeptPlace>("the place in it", &content.place);
        work.and(place).map_err(|error| error.to_string())
    }

    /// What a list of sessions shows of `content`.
    ///
    /// # Errors
    /// Why it cannot be read.
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

    fn place(&self) -> KeptPlace {
        let speed = match self.player.playback.speed() {
            Speed::Times(speed) => Some(speed),
            Speed::Top => None,
        };
        KeptPlace {
            step: self.player.step_to_keep(),
            speed,
            shows_exact: self.player.run().overlay().is_some(),
            window_s: self.view.window_s,
            focus: self.view.focus.id().to_owned(),
            filled: self.view.filled,
            exporting: self.files.exported_to().map(|path| Shown(path).to_string()),
            next_push: self.values.next_push().clone(),
        }
    }

    /// The lab with `content`: on its way to the step where it stood, and paused there. `view` returns how its run is
    /// shown on this screen.
    ///
    /// # Errors
    /// Why it cannot be read.
    pub fn resumed(
        content: &Content,
        view: impl FnOnce(&Scenario) -> View,
    ) -> Result<Self, Unreadable> {
        Self::resumed_in(content, None, view)
    }

    /// As [`resumed`](Self::resumed), for a lab that reads and writes in the folder `confined` only, if one is given.
    ///
    /// # Errors
    /// Why it cannot be read.
    pub fn resumed_in(
        content: &Content,
        confined: Option<&Confined>,
        view: impl FnOnce(&Scenario) -> View,
    ) -> Result<Self, Unreadable> {
        let work: KeptWork = read("the run", &content.work)?;
        if !FORMS.contains(&work.form) {
            return Err(Unreadable(
                "it was kept by another version of gyrolab".to_owned(),
            ));
        }
        let place: KeptPlace = read("the place in it", &content.place)?;
        let unreadable = |problems: Problems| Unreadable(problems.in_one_line());
        work.history.check().map_err(unreadable)?;
        let present = work.history.present();
        let scenario = present.journal.scenario().map_err(unreadable)?;
        let scenario = Arc::new(scenario);
        let mut view = view(&scenario);
        view.focus = view
            .kept_as(&place.focus)
            .ok_or_else(|| Unreadable(format!("there is no pane {}", place.focus)))?;
        view.filled = place.filled;
        if place.window_s.is_finite() && place.window_s >= 2.0 * scenario.motion.time_step_s {
            view.window_s = place.window_s;
        }
        let mut lab = Self::new(&present.name.clone(), scenario, view, false);
        if let Some(folder) = confined {
            lab.files.confine(folder.clone());
        }
        let file = lab.file_as_opened();
        lab.work = Work::resumed(work.history, file);
        lab.values.set_next_push(place.next_push);
        lab.values.suit(lab.player.run().scenario());
        lab.player.playback.set_end(lab.work.present().end_s);
        lab.player
            .playback
            .set_speed(place.speed.map_or(Speed::Top, Speed::Times));
        lab.player.playback.set_exact(place.shows_exact);
        lab.player.return_to(place.step);
        lab.scenario_has_changed();
        lab.tell(match place.exporting {
            Some(path) => {
                format!("as it was left; the export to {path} was cut off, x begins another")
            }
            None => "as it was left; space goes on".to_owned(),
        });
        lab.read_now();
        Ok(lab)
    }

    /// The scenario as the user opened it, if its file can still be read; otherwise the present one.
    fn file_as_opened(&self) -> Arc<Scenario> {
        let (name, run) = (self.work.name(), self.player.run());
        if self.files.admit(Path::new(name)).is_err() {
            return Arc::clone(run.scenario());
        }
        let file = super::opening::read(name).and_then(|document| document.scenario());
        file.map_or_else(|_| Arc::clone(run.scenario()), Arc::new)
    }
}

/// `history` as a session keeps it.
pub(super) fn written(history: &History) -> Arc<str> {
    let work = KeptWork {
        form: FORM,
        history: history.clone(),
    };
    toml::to_string(&work).unwrap_or_default().into()
}

/// Checks that `text` can be read as a `T` and would be written in the same way again.
fn reads_back<T: Serialize + for<'a> Deserialize<'a>>(
    what: &str,
    text: &str,
) -> Result<(), Unreadable> {
    let value: T = read(what, text)?;
    match toml::to_string(&value).is_ok_and(|again| again == text) {
        true => Ok(()),
        false => Err(Unreadable(format!("{what} is read as something else"))),
    }
}

fn read<'a, T: Deserialize<'a>>(what: &str, text: &'a str) -> Result<T, Unreadable> {
    toml::from_str(text).map_err(|error| {
        let line = error.message().lines().next().unwrap_or_default();
        Unreadable(format!("{what} is not what gyrolab keeps: {line}"))
    })
}
