//! The lab as a session keeps it: the runs with their journals, and where the lab stands.

use super::Lab;
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

/// The form of what is kept, and those before it that are read too: of form 1 only the journals were others.
const FORM: u32 = 2;
const FORMS: std::ops::RangeInclusive<u32> = 1..=FORM;

/// The runs and what was done to them.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Work {
    form: u32,
    history: History,
}

/// Where the lab stands.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Place {
    step: u64,
    /// Simulated seconds a second; none at top speed.
    #[serde(skip_serializing_if = "Option::is_none")]
    speed: Option<f64>,
    shows_exact: bool,
    window_s: f64,
    /// The id of the pane in focus.
    focus: String,
    filled: bool,
    /// The file an export was being written to.
    #[serde(skip_serializing_if = "Option::is_none")]
    exporting: Option<String>,
    next_push: NextPush,
}

/// What a session is about.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Summary {
    /// SCENARIO as it was opened.
    pub name: String,
    /// What the run is called.
    pub title: String,
    /// Where it stands.
    pub step: u64,
}

/// What is kept cannot be read.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct Unreadable(String);

impl Lab {
    /// What a session is to keep of it.
    pub fn content(&mut self) -> Content {
        let work = match &self.work {
            Some(work) => Arc::clone(work),
            None => self.written_work(),
        };
        self.work = Some(Arc::clone(&work));
        Content {
            work,
            place: toml::to_string(&self.place()).unwrap_or_default(),
        }
    }

    fn written_work(&self) -> Arc<str> {
        let work = Work {
            form: FORM,
            history: self.history.clone(),
        };
        toml::to_string(&work).unwrap_or_default().into()
    }

    /// Whether `content` is read as what it was written from.
    ///
    /// # Errors
    /// Why it is not.
    pub fn check(content: &Content) -> Result<(), String> {
        let work = reads_back::<Work>("the run", &content.work);
        let place = reads_back::<Place>("the place in it", &content.place);
        work.and(place).map_err(|error| error.to_string())
    }

    /// What `content` is about.
    ///
    /// # Errors
    /// Why it cannot be read.
    pub fn summary(content: &Content) -> Result<Summary, Unreadable> {
        let work: Work = read("the run", &content.work)?;
        let place: Place = read("the place in it", &content.place)?;
        let present = work.history.present();
        Ok(Summary {
            name: present.name.clone(),
            title: present.journal.file().title,
            step: place.step,
        })
    }

    fn place(&self) -> Place {
        let speed = match self.player.playback.speed() {
            Speed::Times(speed) => Some(speed),
            Speed::Top => None,
        };
        Place {
            step: self.player.step_to_keep(),
            speed,
            shows_exact: self.run().overlay().is_some(),
            window_s: self.view.window_s,
            focus: self.view.focus.id().to_owned(),
            filled: self.view.filled,
            exporting: self.files.exported_to().map(|path| Shown(path).to_string()),
            next_push: self.values.next_push().clone(),
        }
    }

    /// The lab that `content` was kept of, on its way to the step where it stood, and paused there; `view` says what it looks like on this screen.
    ///
    /// # Errors
    /// Why it cannot be read.
    pub fn resumed(
        content: &Content,
        view: impl FnOnce(&Scenario) -> View,
    ) -> Result<Self, Unreadable> {
        Self::resumed_in(content, None, view)
    }

    /// The same, confined to a folder where one is given.
    ///
    /// # Errors
    /// Why it cannot be read.
    pub fn resumed_in(
        content: &Content,
        confined: Option<&Confined>,
        view: impl FnOnce(&Scenario) -> View,
    ) -> Result<Self, Unreadable> {
        let work: Work = read("the run", &content.work)?;
        if !FORMS.contains(&work.form) {
            return Err(Unreadable(
                "it was kept by another version of gyrolab".to_owned(),
            ));
        }
        let place: Place = read("the place in it", &content.place)?;
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
        lab.history = work.history;
        lab.set_file(lab.file_as_opened());
        lab.values.set_next_push(place.next_push);
        lab.values.suit(lab.player.run().scenario());
        lab.player.playback.set_end(lab.history.present().end_s);
        lab.player
            .playback
            .set_speed(place.speed.map_or(Speed::Top, Speed::Times));
        lab.player.playback.set_exact(place.shows_exact);
        lab.player.return_to(place.step);
        lab.is_another();
        lab.notice.keep_saying(match place.exporting {
            Some(path) => {
                format!("as it was left; the export to {path} was cut off, x begins another")
            }
            None => "as it was left; space goes on".to_owned(),
        });
        lab.read_now();
        Ok(lab)
    }

    /// What the run was opened from, where that is still there; else the run itself.
    fn file_as_opened(&self) -> Arc<Scenario> {
        if self.files.admit(Path::new(self.name())).is_err() {
            return Arc::clone(self.run().scenario());
        }
        let file = super::opening::again(self.name()).and_then(|document| document.scenario());
        file.map_or_else(|_| Arc::clone(self.run().scenario()), Arc::new)
    }

    /// Says `text` before what is being said already.
    pub fn tell_first(&mut self, text: &str) {
        let said = self.notice.text().unwrap_or_default();
        self.tell(format!("{text}{said}"));
    }

    /// Says why the session is not kept, as long as it is not.
    pub fn set_trouble(&mut self, trouble: Option<String>) {
        self.changed |= self.trouble != trouble;
        self.trouble = trouble;
    }

    /// Why the session is not kept, if it is not.
    pub fn trouble(&self) -> Option<&str> {
        self.trouble.as_deref()
    }

    /// Says `text` until the next key: something about the session that the user should know.
    pub fn tell(&mut self, text: impl Into<String>) {
        self.notice.keep_saying(text);
        self.changed = true;
    }
}

/// Whether `text` is read as what it was written from.
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
