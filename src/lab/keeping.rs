//! The content of a session: the history of runs, and the place of the lab in it, each as TOML.

use super::command::{self, Command, Commands, Place};
use super::rerun::Reference;
use super::script::{GO_ON_WITH_IT, GO_ON_WITH_THEM};
use super::view::step::Page;
use super::view::{Part, View};
use super::work::Work;
use super::{Lab, Script, UnderWay};
use crate::observe::camera::{Camera, Zoom};
use crate::observe::pace::Speed;
use crate::scenario::file::{Choice, ScenarioFile, ZoomFile};
use crate::scenario::{Document, Problems, Scenario};
use crate::storage::confined::Confined;
use crate::storage::session::{Content, Text};
use crate::text::printable::Shown;
use crate::work::history::History;
use crate::work::journal::Journal;
use crate::work::next_push::NextPush;
use serde::{Deserialize, Serialize};
use std::path::Path;
use std::sync::Arc;

/// The version of this format, and the versions that can be read. Version 1 had other journals; in version 2 the place
/// had neither panes nor what is hidden, nor camera, zoom, line and script.
const FORM: u32 = 3;
const FORMS: std::ops::RangeInclusive<u32> = 1..=FORM;

/// The text of the work.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct KeptWork {
    form: u32,
    history: History,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pinned: Option<KeptPinned>,
}

/// The pinned run: its pictures are made again from its scenario.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct KeptPinned {
    /// The step up to which it was played; of no meaning for the present run.
    step: u64,
    /// The run file with all that was done to the run; `None` where the present run is pinned.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    run: Option<ScenarioFile>,
}

impl KeptPinned {
    fn of(reference: &Reference) -> Self {
        match reference {
            Reference::Present => Self { step: 0, run: None },
            Reference::Run(scenario, step) => Self {
                step: *step,
                run: Some(scenario.file.clone()),
            },
        }
    }

    /// What is to be pinned again.
    ///
    /// # Errors
    /// What is wrong with the run file.
    fn reference(self) -> Result<Reference, Problems> {
        match self.run {
            None => Ok(Reference::Present),
            Some(file) => Ok(Reference::Run(Journal::of(file).scenario()?, self.step)),
        }
    }
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
    /// The time that the strip of the fast motion shows; `None` where the motion or `[view]` of the scenario tells.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    detail_s: Option<f64>,
    /// The id of the pane in focus.
    focus: String,
    filled: bool,
    /// The file of the export that was in progress.
    #[serde(skip_serializing_if = "Option::is_none")]
    exporting: Option<String>,
    /// The ids of the panes that share the screen; `None` where `[view]` of the scenario tells.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    show: Option<Vec<String>>,
    /// The ids of what is hidden; `None` where `[view]` of the scenario tells.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    hide: Option<Vec<String>>,
    /// The line about what there is to see; `None` where the scenario tells.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    look_at: Option<String>,
    /// The line about what to try next; `None` where the scenario or the preset tells.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    next: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    bare: Option<bool>,
    /// The measured data beside the run, and whether they are shown less what it says.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    measured: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    residuals: Option<bool>,
    /// The page of the step pane, and how many rows it adds up; `None` where they are as usual.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    phase: Option<Choice>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    sum_to: Option<usize>,
    next_push: NextPush,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    camera: Option<KeptCamera>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    zoom: Option<ZoomFile>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    script: Option<KeptScript>,
    /// What the room of the lessons keeps.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    lessons: Option<toml::Table>,
}

/// The camera of the 3-D view, as [`Camera`] has it.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct KeptCamera {
    yaw_deg: f64,
    pitch_deg: f64,
}

/// The commands of the script that were not complete, as two files of commands: the one after the other.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct KeptScript {
    /// The file from which they were read, as the user named it.
    origin: String,
    /// What leads back to the command under way: it is carried out again, but steps that were under way are only taken
    /// to their end.
    first: String,
    /// The commands after that one.
    left: String,
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
            work: self.work.kept(self.player.reference()),
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

    /// What is kept of the lessons in `content`; `None` where nothing is, or it cannot be read.
    pub fn lessons_in(content: &Content) -> Option<toml::Table> {
        read::<KeptPlace>("the place in it", &content.place)
            .ok()?
            .lessons
    }

    /// What the session keeps of the lessons, for the room above that knows what it means.
    pub fn lessons_kept(&self) -> Option<&toml::Table> {
        self.lessons.as_ref()
    }

    /// Makes `lessons` what the session keeps of the lessons.
    pub fn keep_lessons(&mut self, lessons: Option<toml::Table>) {
        self.lessons = lessons;
    }

    fn place(&mut self) -> KeptPlace {
        let ids = |list: &mut dyn Iterator<Item = &'static str>| -> Vec<String> {
            list.map(str::to_owned).collect()
        };
        let speed = match self.player.playback.speed() {
            Speed::Times(speed) => Some(speed),
            Speed::Top => None,
        };
        KeptPlace {
            step: self.player.step_to_keep(),
            speed,
            shows_exact: self.player.run().overlay().is_some(),
            window_s: self.view.window_s,
            detail_s: self.view.detail_s,
            focus: self.view.focus.id().to_owned(),
            filled: self.view.filled,
            exporting: self.files.exported_to().map(|path| Shown(path).to_string()),
            show: Some(ids(&mut self.view.shown.iter().map(|pane| pane.id()))),
            hide: Some(ids(&mut self.view.hidden.iter().map(|part| part.id()))),
            look_at: self.view.look_at.clone(),
            next: self.view.next.clone(),
            bare: self.view.bare.then_some(true),
            measured: self.measured_to_keep(),
            residuals: self.view.residuals.then_some(true),
            phase: (self.view.page != Page::default()).then(|| self.view.page.choice()),
            sum_to: self.view.sum_to,
            next_push: self.values.next_push().clone(),
            camera: self.view.camera_is_chosen.then_some(KeptCamera {
                yaw_deg: self.view.camera.yaw_deg,
                pitch_deg: self.view.camera.pitch_deg,
            }),
            zoom: Some(ZoomFile {
                above: Some(self.view.zoom.above),
                three_d: Some(self.view.zoom.three_d),
            }),
            script: self.kept_script(),
            lessons: self.lessons.clone(),
        }
    }

    /// The commands of the script that are not complete; `None` where all are.
    fn kept_script(&mut self) -> Option<KeptScript> {
        if self.script.is_done() {
            return None;
        }
        let playback = &self.player.playback;
        let plays_again = self.script.is_held() && self.script.plays_again();
        let is_playing = plays_again || playback.is_running() && !playback.is_running_until();
        let under_way = self.script.under_way();
        let again = under_way.and_then(|(command, under_way)| match under_way {
            UnderWay::Going => {
                let to_go = playback.steps_to_go()?;
                let step = playback.step_number().saturating_add(to_go);
                Some(Command::GoTo(Place::Step(step)))
            }
            UnderWay::Playing | UnderWay::Waiting(_) | UnderWay::Exporting => Some(command.clone()),
        });
        let run = is_playing.then_some(Command::Run);
        let first: Vec<_> = run.into_iter().chain(again).collect();
        Some(KeptScript {
            origin: self.script.origin().to_owned(),
            first: command::to_toml(&first),
            left: self.script.left_as_text().to_string(),
        })
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
        let mut work: KeptWork = read("the run", &content.work)?;
        if !FORMS.contains(&work.form) {
            return Err(Unreadable(
                "it was kept by another version of gyrolab".to_owned(),
            ));
        }
        let place: KeptPlace = read("the place in it", &content.place)?;
        let unreadable = |problems: Problems| Unreadable(problems.in_one_line());
        work.history.check().map_err(unreadable)?;
        let scenario = work.history.scenario().map_err(unreadable)?;
        let present = work.history.present();
        let mut view = view(&scenario);
        view.focus = view
            .kept_as(&place.focus)
            .ok_or_else(|| Unreadable(format!("there is no pane {}", place.focus)))?;
        view.filled = place.filled;
        if let Some(ids) = &place.show {
            view.shown = ids.iter().filter_map(|id| view.kept_as(id)).collect();
            view.side_by_side = view.to_show();
        }
        if let Some(ids) = &place.hide {
            view.hidden = ids.iter().filter_map(|id| Part::named(id)).collect();
        }
        (view.look_at, view.next) = (place.look_at, place.next);
        view.bare = place.bare.unwrap_or(false);
        view.residuals = place.residuals.unwrap_or(false);
        view.page = place.phase.as_ref().and_then(Page::of).unwrap_or_default();
        view.sum_to = place.sum_to;
        if let Some(KeptCamera { yaw_deg, pitch_deg }) = place.camera
            && yaw_deg.is_finite()
            && (-90.0..=90.0).contains(&pitch_deg)
        {
            view.look_from(Camera { yaw_deg, pitch_deg });
        }
        if let Some(zoom) = place.zoom {
            view.zoom = Zoom::of(zoom);
        }
        if place.window_s.is_finite() && place.window_s >= 2.0 * scenario.motion.time_step_s {
            view.window_s = place.window_s;
        }
        let is_time = |time_s: &f64| time_s.is_finite() && *time_s > 0.0;
        view.detail_s = place.detail_s.filter(is_time).or(view.detail_s);
        let mut lab = Self::new(&present.name.clone(), scenario, view, false);
        if let Some(folder) = confined {
            lab.files.confine(folder.clone());
        }
        let file = lab.file_as_opened();
        let pinned = work.pinned.take().map(KeptPinned::reference);
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
        let mut told = match place.exporting {
            Some(path) => {
                format!("as it was left; the export to {path} was cut off, x begins another")
            }
            None => "as it was left; space goes on".to_owned(),
        };
        match place.script.map(|kept| kept.commands()) {
            None => {}
            Some(Ok(commands)) => {
                let (count, origin) = (commands.list.len(), &commands.origin);
                told = match count {
                    1 => format!("1 command of {origin} is left: {GO_ON_WITH_IT}"),
                    _ => format!("{count} commands of {origin} are left: {GO_ON_WITH_THEM}"),
                };
                lab.script = Script::held(commands);
            }
            Some(Err(problems)) => {
                told += &format!(
                    "; the rest of its script is lost: {}",
                    problems.in_one_line()
                );
            }
        }
        match pinned {
            None => {}
            Some(Ok(reference)) => lab.player.pin_again(reference),
            Some(Err(problems)) => {
                told += &format!("; the pinned run is lost: {}", problems.in_one_line());
            }
        }
        if let Some(name) = &place.measured {
            told += &lab.measure_as_kept(name).unwrap_or_default();
        }
        lab.lessons = place.lessons;
        lab.tell(told);
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

impl KeptScript {
    /// The commands to be carried out.
    ///
    /// # Errors
    /// What is wrong with them.
    fn commands(&self) -> Result<Commands, Problems> {
        let read = |text: &str| {
            let document = Document::parse(&self.origin, text)?;
            command::read(&document)
        };
        let mut commands = read(&self.first)?;
        commands.list.extend(read(&self.left)?.list);
        for placed in &mut commands.list {
            placed.line = None; // the line in the user's file is not kept
        }
        Ok(commands)
    }
}

/// `history` as a session keeps it, with the pinned run. The text is written by the thread that first reads it.
pub(super) fn written(history: &History, reference: Option<&Reference>) -> Text {
    let (history, reference) = (history.clone(), reference.cloned());
    Text::later(move || {
        let work = KeptWork {
            form: FORM,
            history,
            pinned: reference.as_ref().map(KeptPinned::of),
        };
        toml::to_string(&work).unwrap_or_default()
    })
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
