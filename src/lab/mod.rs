//! The lab's state, and what every action does to it. It draws nothing and reads no clock: time comes in.
//!
//! This file has the state, the dispatch of actions and the passing of time; the rooms beside it carry out what
//! belongs together: `travel` through the run, `looking` at it, `editing` it, `opening` another, `dialogs` and what
//! they ask for, `keeping` all of it. What they work on has rooms of its own: [`history`](mod@crate::work::history) the runs one after the other, each with its
//! journal; [`editor`] the list of what can be edited; [`next_push`](mod@crate::work::next_push) the push to come; [`form`] what is typed into;
//! [`browser`] the list of presets and files; `files` the folder, what may be written, and the export under way; [`changed`](mod@crate::work::changed) says what there is to see, [`notice`] what has just happened.

pub mod action;
pub mod browser;
mod carry_out;
pub mod command;
mod dialogs;
mod editing;
pub mod editor;
mod files;
pub mod form;
mod keeping;
mod looking;
pub mod notice;
mod numbers;
mod opening;
mod player;
pub mod preview;
mod script;
mod steering;
mod travel;
mod values;
pub mod view;

pub use carry_out::{Answer, Done, Refusal, UnderWay};
pub use dialogs::Dialog;
pub use keeping::{Summary, Unreadable};
pub use script::Script;

use crate::analysis::health::Advice;
use crate::lab::view::{Pane, Part, View};
use crate::observe::ghost::Ghost;
use crate::observe::live::LiveRun;
use crate::observe::playback::{Halt, Playback};
use crate::observe::reading::Reading;
use crate::run::NotFinite;
use crate::scenario::{Motion, Scenario};
use crate::storage::confined::Confined;
use crate::storage::exporting::Written;
use crate::work::changed;
use crate::work::history::History;
use browser::Browser;
use editor::Editor;
use files::Files;
use notice::Notice;
use player::{Player, halt_in_words};
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;
use values::Values;

/// What lies on top of the screen and gets the keys.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// The panes.
    Lab,
    /// The browser of presets and files.
    Browser,
    /// The line in which its filter is typed.
    Filter,
    /// The list of keys.
    Help,
    /// A dialog that is typed into.
    Dialog,
}

impl Mode {
    /// Every mode.
    pub const ALL: [Self; 5] = [
        Self::Lab,
        Self::Browser,
        Self::Filter,
        Self::Help,
        Self::Dialog,
    ];
}

/// What the loop must do that the lab cannot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Request {
    /// Draw the whole screen again.
    Redraw,
    /// Stop until the shell resumes the program.
    Suspend,
    /// End.
    Quit,
}

/// The whole of what the user sees and steers.
pub struct Lab {
    /// The run, what was done to it, and the runs before it.
    history: History,
    /// The scenario as it was opened, and how the run differs from it, where it does.
    file: Arc<Scenario>,
    changed_from_file: Option<String>,
    player: Player,
    values: Values,
    files: Files,
    /// Why the session is not kept, if it is not.
    trouble: Option<String>,
    dialog: Option<Dialog>,
    /// Whether the end was asked for while something was under way.
    was_warned: bool,
    /// The text of run and journal for the session, as long as it holds.
    work: Option<Arc<str>>,
    view: View,
    mode: Mode,
    /// The mode under the help.
    under_help: Mode,
    browser: Browser,
    count: Option<u64>,
    notice: Notice,
    /// Commands that are still to be carried out.
    script: Script,
    now: Duration,
    /// The panes that stand side by side while none fills the screen, in the order in which the focus goes through them.
    side_by_side: Vec<Pane>,
    changed: bool,
}

impl Lab {
    /// A lab with the run of `scenario`, opened as `name`, at step 0.
    pub fn new(name: &str, scenario: Arc<Scenario>, view: View, running: bool) -> Self {
        let history = History::new(name, &scenario);
        let player = Player::new(Arc::clone(&scenario), running);
        let mut lab = Self {
            history,
            changed_from_file: None,
            player,
            values: Values::new(&scenario),
            file: scenario,
            files: Files::default(),
            trouble: None,
            dialog: None,
            was_warned: false,
            work: None,
            side_by_side: view.panes.to_vec(),
            view,
            mode: Mode::Lab,
            under_help: Mode::Lab,
            browser: Browser::default(),
            count: None,
            notice: Notice::default(),
            script: Script::default(),
            now: Duration::ZERO,
            changed: true,
        };
        lab.list_parameters();
        lab
    }

    /// Says that its scenario was `file` before it was changed: the file's note is shown only where it still holds.
    pub fn set_file(&mut self, file: Arc<Scenario>) {
        self.changed_from_file = changed::changed(&file, self.run().scenario());
        self.file = file;
    }

    /// Looks for files in `folder`, and writes them there, instead of the present folder.
    pub fn work_in(&mut self, folder: &Path) {
        self.files.work_in(folder);
    }

    /// From now on reads and writes nothing outside of the folder.
    pub fn confine(&mut self, folder: Confined) {
        self.files.confine(folder);
    }

    /// From now on looks in the background for what would mend a run that is not to be believed.
    pub fn take_advice(&mut self) {
        self.player.is_advised = true;
    }

    /// What would mend the run, where that is known.
    pub fn advice(&self) -> Option<&Advice> {
        self.player.advice()
    }

    /// Takes the run to `step` at once, before anything is shown.
    ///
    /// # Errors
    /// When the numbers stop being finite on the way.
    pub fn begin_at(&mut self, step: u64) -> Result<(), NotFinite> {
        let arrived = self.player.playback.begin_at(step);
        self.read_now();
        arrived
    }

    /// Lets time pass up to now, as `clock` tells it (since the lab was opened): steps, follows the exact motion, reads.
    pub fn advance(&mut self, clock: &mut dyn FnMut() -> Duration) {
        let now = clock();
        let wall = now.saturating_sub(self.now);
        self.now = now;
        self.changed |= self.notice.expire(now);
        let (halt, is_new) = self.player.advance(now, wall, clock);
        self.changed |= is_new;
        if let Some(halt) = halt {
            self.halted(halt);
        }
        self.changed |= self.browser.take_news();
        self.follow_export();
        self.go_on_with_script(halt);
        if self.changed && self.player.is_due(now, self.view.window_s) {
            self.read_now();
        }
    }

    fn halted(&mut self, halt: Halt) {
        if let Some(text) = halt_in_words(halt) {
            self.notice.keep_saying(text);
        }
        self.read_now();
    }

    /// Says `text`: what was asked for means nothing here. A count that was typed is forgotten.
    pub fn refuse(&mut self, text: impl Into<String>) {
        self.count = None;
        self.say(text);
        self.changed = true;
    }

    fn say(&mut self, text: impl Into<String>) {
        self.notice.say(text, self.now);
    }

    fn read_now(&mut self) {
        self.player.read(self.now);
        self.changed = true;
        let (step, journal) = (
            self.player.playback.step_number(),
            &self.history.present().journal,
        );
        if self.values.is_outdated(step, journal) {
            self.list_parameters();
        }
    }

    /// Says which panes stand side by side on the screen, as it is now, while none fills it, from left to right. Until
    /// this is said, it is all of them. The whole picture is to be drawn again.
    pub fn set_side_by_side(&mut self, panes: Vec<Pane>) {
        self.side_by_side = panes;
        self.keep_focus();
        self.changed = true;
    }

    /// The panes that stand side by side while none fills the screen.
    pub fn side_by_side(&self) -> &[Pane] {
        &self.side_by_side
    }

    /// Whether the picture has changed and is to be taken.
    pub fn has_changed(&self) -> bool {
        self.changed
    }

    /// Whether the picture has changed since this was asked last.
    pub fn take_changed(&mut self) -> bool {
        std::mem::take(&mut self.changed)
    }

    /// How long until the notice goes away by itself.
    pub fn notice_ends_in(&self) -> Option<Duration> {
        self.notice.ends_in(self.now)
    }

    /// The run on its pace.
    pub fn playback(&self) -> &Playback {
        &self.player.playback
    }

    /// The run.
    pub fn run(&self) -> &LiveRun {
        self.player.run()
    }

    /// The run before, where an edit has begun this one anew.
    pub fn ghost(&self) -> Option<&Ghost> {
        self.player.ghost()
    }

    /// What can be edited, and which of it is selected.
    pub fn editor(&self) -> &Editor {
        self.values.editor()
    }

    /// The dialog on top, if there is one.
    pub fn dialog(&self) -> Option<&Dialog> {
        self.dialog.as_ref()
    }

    /// What has been exported since the lab was opened.
    pub fn written(&self) -> &[Written] {
        self.files.written()
    }

    /// Whether something is under way that time changes, beside the run.
    pub fn is_exporting(&self) -> bool {
        self.files.is_exporting()
    }

    /// Gravity, scheme and time step of the step to come.
    pub fn motion(&self) -> Motion {
        self.player.motion()
    }

    /// How it is looked at.
    pub fn view(&self) -> &View {
        &self.view
    }

    /// The latest reading.
    pub fn reading(&self) -> &Reading {
        self.player.reading()
    }

    /// What gets the keys.
    pub fn mode(&self) -> Mode {
        self.mode
    }

    /// The browser of presets and files.
    pub fn browser(&self) -> &Browser {
        &self.browser
    }

    /// The count typed so far.
    pub fn count(&self) -> Option<u64> {
        self.count
    }

    /// What there is to see in the run.
    pub fn note(&self) -> &str {
        if self.view.hides(Part::LookAt) {
            return "";
        }
        let file = || changed::look_at(self.run().scenario());
        let told = self.view.look_at.as_deref();
        let note = told.or(self.changed_from_file.as_deref()).or_else(file);
        note.unwrap_or("r begins the run again, o opens another")
    }

    /// What is to be said now, if anything: what keeps the lab busy, or else what has happened.
    pub fn notice(&self) -> Option<String> {
        let stepping = self.player.in_words();
        let said = || self.notice.text().map(str::to_owned);
        stepping
            .or_else(said)
            .or_else(|| self.files.export_in_words())
    }
}
