//! The lab: a run, what the user does to it, and how it is shown. It draws nothing, and reads no clock: the time is
//! passed to it.
//!
//! [`Lab`] consists of parts, each of which owns its state: the [`Work`] that was done to the run, the [`Player`] of the
//! run, the [`Values`] that can be edited, the [`Files`], the [`View`] of the run, what lies [`OnTop`] of the panes, and the
//! [`Script`] of commands that are not carried out yet. `Lab` itself carries out what concerns several parts:
//!
//! - `carry_out`: each [`Command`](command::Command), and `editing` for those that change the run;
//! - `steering`: each [`Action`](action::Action) of the user, which stands for commands or changes the interface;
//! - [`explained`]: the time step that the step pane takes apart, and its keys;
//! - `script`: the commands of a script, one after the other;
//! - `messages`: what the lab says;
//! - `keeping`: the content of a session.

pub mod action;
mod advised;
mod answer;
mod answering;
pub mod browser;
mod carry_out;
pub mod command;
mod course;
mod dialog;
mod editing;
pub mod explained;
mod files;
#[cfg(test)]
mod for_tests;
pub mod form;
mod keeping;
pub mod measured;
mod messages;
pub mod notice;
pub mod numbers;
mod on_top;
mod opening;
mod player;
pub mod preview;
mod rerun;
mod script;
mod settings;
pub mod sheet;
mod steering;
mod traces;
pub mod values;
pub mod view;
mod work;

pub use answer::{Answer, Done, Refusal, UnderWay};
pub use files::Files;
pub use keeping::{Summary, Unreadable};
pub use on_top::{MOST_COUNTED, Mode, OnTop};
pub use player::Player;
pub use script::{STOPPED, Script};
pub use values::Values;
pub use work::Work;

use crate::run::NotFinite;
use crate::scenario::Scenario;
use crate::storage::settings::remember;
use action::LessonKey;
use form::type_into;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;
use view::{Pane, View};

/// What the lab leaves to the rooms above it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Request {
    /// Do in the lesson what a key stands for.
    Lesson(LessonKey),
    /// Take this number as the answer to the question of the lesson that was asked last.
    Answer(f64),
    /// Draw the whole screen again.
    Redraw,
    /// Suspend the program until the shell resumes it.
    Suspend,
    Quit,
}

pub struct Lab {
    work: Work,
    player: Player,
    values: Values,
    files: Files,
    view: View,
    on_top: OnTop,
    script: Script,
    /// The folder in which the settings that the user chooses are remembered; `None` where nothing is.
    pub settings: Option<PathBuf>,
    /// What the session keeps of the lessons.
    pub lessons: Option<toml::Table>,
    /// Whether there are colours where nobody chooses; `None` where that is not known.
    pub usual_colour: Option<bool>,
    /// The time since the lab was opened.
    now: Duration,
    /// Whether the picture has changed since it was drawn.
    changed: bool,
}

impl Lab {
    /// A lab with the run of `scenario`, opened as `name`, at step 0. It plays if `running` is true.
    pub fn new(name: &str, scenario: Arc<Scenario>, view: View, running: bool) -> Self {
        let mut lab = Self {
            work: Work::new(name, &scenario),
            values: Values::new(&scenario),
            player: Player::new(scenario, running),
            files: Files::default(),
            view,
            on_top: OnTop::default(),
            script: Script::default(),
            settings: None,
            lessons: None,
            usual_colour: None,
            now: Duration::ZERO,
            changed: true,
        };
        lab.list_parameters();
        lab.turn_camera();
        lab
    }

    /// Makes `file` the scenario as the user opened it. Where the run differs from it, the lab says so instead of showing
    /// the file's line about what there is to see.
    pub fn set_file(&mut self, file: &Arc<Scenario>) {
        self.work.set_file(file);
        self.work.compare_with_file(self.player.run().scenario());
    }

    /// From now on looks in the background for a scheme or time step that would make doubtful numbers right.
    pub fn take_advice(&mut self) {
        self.player.is_advised = true;
        self.read_now(); // a run that stands still is not read again by itself
    }

    fn colour_choice(&self) -> &'static str {
        let colour = self.view.theme.colour;
        if self.usual_colour == Some(colour) {
            "auto"
        } else if colour {
            "always"
        } else {
            "never"
        }
    }

    /// Remembers that the user has chosen `value` for the setting `key`.
    fn remember(&mut self, key: &'static str, value: impl Into<toml::Value>) {
        if let Some(folder) = &self.settings
            && let Err(trouble) = remember(folder, key, value.into())
        {
            self.tell(trouble);
        }
    }

    /// Takes the run to `step` at once.
    pub fn begin_at(&mut self, step: u64) -> Result<(), NotFinite> {
        let arrived = self.player.playback.begin_at(step);
        self.arrive();
        arrived
    }

    /// Advances everything that changes with time up to now. `clock` returns the time since the lab was opened; it is read
    /// several times, so that the steps of a fast run end in time for the next frame.
    pub fn advance(&mut self, clock: &mut dyn FnMut() -> Duration) {
        let now = clock();
        let wall = now.saturating_sub(self.now);
        self.now = now;
        self.changed |= self.on_top.notice.expire(now);
        let (halt, is_new) = self.player.advance(now, wall, clock);
        self.changed |= is_new;
        if let Some(halt) = halt {
            self.halted(halt);
        }
        self.tell_what_was_found();
        self.changed |= self.on_top.browser.take_what_was_read();
        self.open_what_was_read();
        self.follow_export();
        self.go_on_with_script(halt);
        if self.changed && self.player.is_due(now, self.view.window_s) {
            self.read_now();
        }
    }

    /// From now on the run goes on at the scenario's end, until another is opened.
    pub fn play_on(&mut self) {
        self.player.playback.play_on();
    }

    /// Draws at most `fps` frames a second.
    pub fn set_fps(&mut self, fps: u32) {
        self.view.fps = fps;
    }

    pub fn set_mouse(&mut self, listens: bool) {
        self.view.mouse = listens;
    }

    /// Takes note of the progress of the export, and says when it has ended.
    fn follow_export(&mut self) {
        self.changed |= self.files.is_exporting();
        if let Some(text) = self.files.follow_export() {
            self.tell(text);
        }
    }

    /// Takes a pasted text, where text is typed.
    pub fn paste(&mut self, text: &str) {
        match self.on_top.mode {
            Mode::Find => {
                self.values.list.filter_by(|line| type_into(line, text));
            }
            _ => self.on_top.paste(text, self.now),
        }
        self.changed = true;
    }

    /// Reads the numbers of the run, and lists its values again if others are in force.
    fn read_now(&mut self) {
        if let Some(said) = self.player.read(self.now, &self.view) {
            self.say(said);
        }
        self.turn_camera();
        self.changed = true;
        let step = self.player.playback.step_number();
        if self.values.is_outdated(step, self.work.journal()) {
            self.list_parameters();
        }
    }

    /// Turns the camera so that the axle is seen aslant, unless its direction was chosen. A moving picture is left
    /// as it is: the motion shows where the axle points.
    fn turn_camera(&mut self) {
        let playback = &self.player.playback;
        let is_still = !playback.is_running() || playback.step_number() == 0;
        if is_still && self.view.look.camera.is_none() {
            let axle = self.player.reading.state.axle();
            self.view.camera = self.view.camera.aside_of(&axle);
        }
    }

    /// Tells the lab which panes stand side by side on the screen while none fills it, from left to right. The whole
    /// picture is then drawn again.
    pub fn set_side_by_side(&mut self, panes: Vec<Pane>) {
        self.view.side_by_side = panes;
        self.view.keep_focus();
        self.changed = true;
    }

    /// Whether the picture has changed since it was drawn.
    pub fn has_changed(&self) -> bool {
        self.changed
    }

    /// As [`has_changed`](Self::has_changed); from then on the picture counts as drawn.
    pub fn take_changed(&mut self) -> bool {
        std::mem::take(&mut self.changed)
    }

    pub fn work(&self) -> &Work {
        &self.work
    }

    pub fn player(&self) -> &Player {
        &self.player
    }

    pub fn values(&self) -> &Values {
        &self.values
    }

    pub fn files(&self) -> &Files {
        &self.files
    }

    pub fn files_mut(&mut self) -> &mut Files {
        &mut self.files
    }

    pub fn view(&self) -> &View {
        &self.view
    }

    pub fn on_top(&self) -> &OnTop {
        &self.on_top
    }

    pub fn script(&self) -> &Script {
        &self.script
    }
}
