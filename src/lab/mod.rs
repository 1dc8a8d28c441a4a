//! The lab: a run, what the user does to it, and how it is shown. It draws nothing, and reads no clock: the time is
//! passed to it.
//!
//! It uses the [`engine`](crate::engine) for the run, and [`report`](crate::report) and [`studies`](crate::studies) for figures
//! and checks. All state of the lab belongs here. What a terminal draws belongs to [`tui`](crate::tui).
//!
//! [`Lab`] consists of parts. Each owns its state; [`Lab::carry_out`] calls the part that carries out a [`Command`](command::Command):
//!
//! | part | state | commands |
//! |---|---|---|
//! | [`Player`] | step, speed, cursor's numbers, readouts | `step`, `go_to`, `run_until`, `run`, `pause`, `speed` |
//! | [`Comparison`] | exact motion, ghost, pinned run, measured data | `exact`, `pin`, `measured` |
//! | [`Edits`] | journal of the runs, values, push to come | `open`, `set`, `nudge`, `push`, `next_push`, `undo`, `redo`, `take_advice` |
//! | [`Adviser`] | search for advice, offer | |
//! | [`View`] | `[view]`, focus, window, cursor | every key of `[view]`, `since_s`, `magnify`, `cursor`, `fill`, `point_at` |
//! | [`StepPane`] | workings of a time step | |
//! | [`Files`] | folder, export under way | `export`, `figure`, `save` |
//! | [`CommandScript`] | commands to come | `wait_s`, `chapter` |
//! | [`Popups`] | browser, help, dialog, count | |
//! | [`Messages`] | message, trouble with the session | |
//! | [`Settings`] | what is remembered | |
//!
//! For a command that changes the run, [`Edits`] returns a `ScenarioEdit`; `Lab::apply` changes the other parts.
//! `dispatch` leads commands to the parts, `routing` leads [actions](action::Action), and `time` lets time pass.
//!
//! A new command changes three files: [`command`] with the row in its table, the `match` of `Lab::dispatch`, and the part that
//! carries it out. It is also added to the table above.

pub mod action;
mod advice;
mod answer;
pub mod browser;
pub mod command;
pub mod comparison;
pub mod dialog;
mod dispatch;
mod edits;
mod files;
#[cfg(test)]
mod for_tests;
pub mod form;
mod messages;
pub mod numbers;
mod paste_rows;
pub mod playback;
mod player;
mod popups;
mod routing;
mod runs;
mod script;
mod session;
mod settings;
pub mod sheet;
mod snapshot;
pub mod step_pane;
pub mod storage;
mod time;
pub mod values;
pub mod view;

pub use action::LabRequest;
pub use advice::Adviser;
pub use answer::{ActionResult, Done, PendingAction, Refusal};
pub use comparison::Comparison;
pub use dispatch::KeyCommands;
pub use edits::Edits;
pub use files::Files;
pub use messages::{Cleared, Messages};
pub use paste_rows::MOST_PASTED;
pub use player::{Player, SeekPurpose};
pub use popups::{MOST_COUNTED, Mode, Popups};
pub use runs::Runs;
pub use script::CommandScript;
pub use session::{SessionSummary, Unreadable, lessons_in};
pub use settings::Settings;
pub use snapshot::Snapshot;
pub use step_pane::StepPane;
pub use values::Values;

use crate::engine::data::ColumnOptions;
use crate::engine::scenario::{Problems, Scenario};
use crate::engine::text::printable::printable;
use crate::lab::storage::confined::Confined;
use crate::lab::storage::session::SessionContent;
use session::{KeptPinned, KeptPlace};
use sheet::Sheet;
use std::borrow::Cow;
use std::sync::Arc;
use std::time::Duration;
use toml::Table;
use view::View;

pub struct Lab {
    edits: Edits,
    player: Player,
    comparison: Comparison,
    adviser: Adviser,
    step_pane: StepPane,
    files: Files,
    view: View,
    popups: Popups,
    messages: Messages,
    script: CommandScript,
    pub settings: Settings,
    /// The time since the lab was opened.
    now: Duration,
    /// Whether the picture has changed since it was drawn.
    changed: bool,
    /// What is said before the lab is left, where leaving ends something for others.
    quit_warning: Option<String>,
}

impl Lab {
    /// A lab with the run of `scenario`, opened as `name`, at step 0. It plays if `running` is true.
    pub fn new(name: &str, scenario: Arc<Scenario>, view: View, running: bool) -> Self {
        let mut lab = Self {
            edits: Edits::new(name, &scenario),
            player: Player::new(scenario, running),
            comparison: Comparison::default(),
            adviser: Adviser::default(),
            step_pane: StepPane::default(),
            files: Files::default(),
            view,
            popups: Popups::default(),
            messages: Messages::default(),
            script: CommandScript::default(),
            settings: Settings::default(),
            now: Duration::ZERO,
            changed: true,
            quit_warning: None,
        };
        lab.edits.list_values(&lab.player);
        lab.view.turn_camera(&lab.player);
        lab
    }

    /// Makes `file` the scenario as the user opened it. Where the run differs from it, the lab says so instead of showing
    /// the file's line about what there is to see.
    pub fn set_file(&mut self, file: &Arc<Scenario>) {
        self.edits.runs.set_file(file);
        self.edits.follow(&self.player);
    }

    /// Looks for what would make an unreliable run reliable, and waits for it: a picture shows it.
    pub fn look_for_advice(&mut self) {
        self.adviser.look_now(&self.player);
    }

    /// From now on looks in the background for a scheme or time step that would make an unreliable run reliable.
    pub fn take_advice(&mut self) {
        self.adviser.is_on = true;
        self.read_now(); // a run that stands still is not read again by itself
    }

    /// Says `warning` before the lab is left; `None`: it is left at once.
    pub fn set_quit_warning(&mut self, warning: Option<String>) {
        self.quit_warning = warning;
    }

    /// Shows so many swings in the traces, if the run has more.
    pub fn show_swings(&mut self, swings: usize) {
        self.view.swings = swings;
        self.choose_window();
    }

    /// Chooses the time that the traces show.
    fn choose_window(&mut self) {
        self.view.window = self.player.window(self.now, &self.view, &self.comparison);
    }

    /// Reads the numbers of the run, and whatever depends on them.
    fn read_now(&mut self) {
        self.player.read(self.now, &self.view);
        self.comparison.compare(&self.player);
        self.view.measured = self.comparison.data().is_some();
        let column = self.view.look.detail_of.column();
        self.comparison.record_column(column, &self.player);
        self.step_pane.read(&mut self.player, &self.view);
        self.adviser.look(&self.player);
        self.choose_window();
        self.view.turn_camera(&self.player);
        self.edits.read(&self.player);
        self.changed = true;
    }

    /// Shows why a key means nothing here, and forgets the count that was typed.
    pub fn refuse(&mut self, text: impl Into<String>) {
        self.popups.count = None;
        self.say(text);
    }

    /// Shows `text` for a few seconds.
    fn say(&mut self, text: impl Into<String>) {
        self.messages.say(text, self.now);
        self.changed = true;
    }

    /// Shows `text` until the next key.
    pub fn tell(&mut self, text: impl Into<String>) {
        self.messages.keep_saying(text);
        self.changed = true;
    }

    pub fn messages_mut(&mut self) -> &mut Messages {
        self.changed = true;
        &mut self.messages
    }

    /// Shows why the session cannot be saved, until it can.
    pub fn set_trouble(&mut self, trouble: Option<String>) {
        self.changed |= self.messages.set_trouble(trouble);
    }

    /// How long the present message stays; `None` where only a key removes it, or there is none.
    pub fn notice_ends_in(&self) -> Option<Duration> {
        self.messages.ends_in(self.now)
    }

    /// The line about what there is to see in the run.
    pub fn note(&self) -> Cow<'_, str> {
        messages::note(&self.view, &self.edits.runs, &self.player)
    }

    /// The message at the bottom of the screen: the steps that are being taken, the message, or the export's progress.
    pub fn notice(&self) -> Option<String> {
        let stepping = self.player.in_words();
        stepping
            .or_else(|| self.messages.text().map(str::to_owned))
            .or_else(|| self.files.export_in_words())
    }

    /// Whether the picture has changed since it was drawn.
    pub fn has_changed(&self) -> bool {
        self.changed
    }

    /// As [`has_changed`](Self::has_changed); from then on the picture counts as drawn.
    pub fn take_changed(&mut self) -> bool {
        std::mem::take(&mut self.changed)
    }

    /// What a session keeps, with the state of the `lessons`.
    pub fn content(&mut self, lessons: &Table) -> SessionContent {
        let (comparison, edits) = (&self.comparison, &self.edits);
        let (files, view, snapshot) = (&self.files, &self.view, self.snapshot());
        let place = KeptPlace::new(snapshot, comparison, edits, files, view, lessons);
        let reference = self.comparison.reference();
        SessionContent {
            work: self.edits.runs.kept(reference, session::written),
            place: toml::to_string(&place).unwrap_or_default(),
        }
    }

    pub fn runs(&self) -> &Runs {
        &self.edits.runs
    }

    /// Keeps undo from taking back what was done up to now, or lets it again.
    pub fn set_undo_floor(&mut self, is_here: bool) {
        self.edits.runs.set_floor(is_here);
    }

    pub fn values(&self) -> &Values {
        &self.edits.values
    }

    pub fn player(&self) -> &Player {
        &self.player
    }

    pub fn comparison(&self) -> &Comparison {
        &self.comparison
    }

    pub fn adviser(&self) -> &Adviser {
        &self.adviser
    }

    pub fn step_pane(&self) -> &StepPane {
        &self.step_pane
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

    /// Returns what is open on top of the panes, or has the focus as a list does: it decides what keys mean.
    pub fn mode(&self) -> Mode {
        let is_list = self.view.sheet.as_ref().is_some_and(|sheet| sheet.is_list);
        match self.popups.mode {
            Mode::Lab if is_list && self.view.focus == view::Pane::Lesson => Mode::Lessons,
            mode => mode,
        }
    }

    /// Returns the time since the lab was opened, as it was last told.
    pub fn now(&self) -> Duration {
        self.now
    }

    /// The view, to be changed by hand; the picture then counts as changed.
    pub fn view_mut(&mut self) -> &mut View {
        self.changed = true;
        &mut self.view
    }

    /// Shows `sheet` beside the panes, or none.
    pub fn set_sheet(&mut self, sheet: Option<Sheet>) {
        self.changed |= self.view.set_sheet(sheet);
    }

    pub fn popups_mut(&mut self) -> &mut Popups {
        self.changed = true;
        &mut self.popups
    }

    pub fn popups(&self) -> &Popups {
        &self.popups
    }

    pub fn messages(&self) -> &Messages {
        &self.messages
    }

    pub fn script_mut(&mut self) -> &mut CommandScript {
        &mut self.script
    }

    pub fn script(&self) -> &CommandScript {
        &self.script
    }
}

/// Sessions, and measured data.
impl Lab {
    /// The lab with `content`: on its way to the step where it stood, and paused there. `view` returns how its run is
    /// shown on this screen. If `confined` is given, the lab reads and writes in that folder only.
    pub fn resumed(
        content: &SessionContent,
        confined: Option<&Confined>,
        view: impl FnOnce(&Scenario) -> View,
    ) -> Result<Self, Unreadable> {
        let (journal, scenario, pinned, place) = session::kept(content)?;
        let mut view = view(&scenario);
        place.restore(&mut view)?;
        let (name, end_s) = (journal.present().name.clone(), journal.present().end_s);
        let mut lab = Self::new(&name, Arc::clone(&scenario), view, false);
        if let Some(folder) = confined {
            lab.files.confine(folder.clone());
        }
        let file = lab.files.open_scenario(&name).map_or(scenario, Arc::new);
        lab.edits
            .resume(journal, &file, place.next_push.clone(), &lab.player);
        let Snapshot {
            step,
            speed,
            shows_exact,
            ..
        } = place.snapshot;
        lab.player.resume(step, speed, shows_exact, end_s);
        lab.edits.follow(&lab.player);
        lab.take_up(&place, pinned);
        lab.read_now();
        Ok(lab)
    }

    /// Takes up what may be lost without the run: the pinned run and the measured data. Says what is there again, and what
    /// is lost.
    fn take_up(&mut self, place: &KeptPlace, pinned: Option<KeptPinned>) {
        let mut text = place.in_words();
        match pinned.map(KeptPinned::reference).transpose() {
            Ok(reference) => self.comparison.pin_again(reference),
            Err(problems) => {
                text += &format!("; the pinned run is lost: {}", problems.in_one_line());
            }
        }
        if let Some(name) = &place.measured
            && let Err(problems) =
                self.comparison
                    .put_beside(name, &place.columns(), &self.player, &self.files, false)
        {
            let (name, why) = (printable(name), problems.in_one_line());
            text += &format!("; the measured data {name} are not beside it: {why}");
        }
        self.tell(text);
    }

    /// Puts the measured data `name` beside the run, as the command line wants it, or else those that the scenario's
    /// `[view]` names.
    pub fn begin_with_measured(
        &mut self,
        name: Option<&str>,
        options: &ColumnOptions,
    ) -> Result<(), Problems> {
        let file = &self.player.run().scenario().file;
        let of_file = file.viewed_text("measured");
        if let Some(name) = name.or(of_file).map(str::to_owned) {
            let (player, files) = (&self.player, &self.files);
            let notes = self
                .comparison
                .put_beside(&name, options, player, files, true)?;
            self.read_now();
            if let Some(notes) = notes {
                self.tell(notes);
            }
        }
        Ok(())
    }
}
