//! The lab: a run, the user's edits of it, and how it is shown. It draws nothing and reads no clock: its caller passes
//! the time.
//!
//! It uses the [`engine`](crate::engine) for the run, and [`report`](crate::report) and [`studies`](crate::studies) for figures
//! and checks. All state of the lab belongs here. Drawing on a terminal belongs to [`tui`](crate::tui).
//!
//! [`Lab`] consists of parts. Each owns its state. [`Lab::carry_out`] passes a [`Command`](command::Command) to its part:
//!
//! | part | state | commands |
//! |---|---|---|
//! | [`Player`] | step, speed, numbers at the cursor, readouts | `step`, `go_to`, `run_until`, `run`, `pause`, `speed` |
//! | [`Comparison`] | exact motion, ghost, pinned run, measured data | `exact`, `pin`, `measured` |
//! | [`Edits`] | journal of the runs, values, next push | `open`, `set`, `nudge`, `push`, `next_push`, `undo`, `redo`, `take_advice` |
//! | [`Adviser`] | search for a better scheme or time step, its result | |
//! | [`View`] | `[view]`, focus, window, cursor | every key of `[view]`, `since_s`, `magnify`, `cursor`, `fill`, `point_at` |
//! | [`StepPane`] | intermediate results of a time step | |
//! | [`Files`] | folder, running export | `export`, `figure`, `save` |
//! | [`CommandScript`] | commands not yet carried out | `wait_s`, `chapter` |
//! | [`Popups`] | browser, help, dialog, count | |
//! | [`Messages`] | message, problem with the session | |
//! | [`Settings`] | settings kept between sessions | |
//!
//! For a command that changes the run, [`Edits`] returns a `ScenarioEdit`; `Lab::apply` changes the other parts.
//! `dispatch` passes commands to the parts, `routing` passes [actions](action::Action), and `time` advances the clock.
//!
//! A new command changes three files: [`command`] (a row of its table), the `match` of `Lab::dispatch`, and the part that
//! carries it out. Add it to the table above too.

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
    /// True if the picture has changed since it was last drawn.
    changed: bool,
    /// A warning to show before the user quits, if quitting ends something for others.
    quit_warning: Option<String>,
}

impl Lab {
    /// Creates a lab with the run of `scenario`, opened as `name`, at step 0. The run plays if `running` is true.
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

    /// Sets `file` as the scenario that the user opened.
    ///
    /// If the run differs from it, the lab says so instead of showing the file's line about what to look at.
    pub fn set_file(&mut self, file: &Arc<Scenario>) {
        self.edits.runs.set_file(file);
        self.edits.follow(&self.player);
    }

    /// Searches for a scheme or time step that would make an unreliable run reliable, and waits for the result.
    /// Pictures need it before they are drawn.
    pub fn look_for_advice(&mut self) {
        self.adviser.look_now(&self.player);
    }

    /// Starts searching in the background for a scheme or time step that would make an unreliable run reliable.
    pub fn take_advice(&mut self) {
        self.adviser.is_on = true;
        self.read_now(); // a paused run is not read again by itself
    }

    /// Sets the warning to show before the user quits. With `None` the lab quits at once.
    pub fn set_quit_warning(&mut self, warning: Option<String>) {
        self.quit_warning = warning;
    }

    /// Shows at most `swings` swings in the traces.
    pub fn show_swings(&mut self, swings: usize) {
        self.view.swings = swings;
        self.choose_window();
    }

    /// Chooses the time window of the traces.
    fn choose_window(&mut self) {
        self.view.window = self.player.window(self.now, &self.view, &self.comparison);
    }

    /// Reads the numbers of the run and updates everything that depends on them.
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

    /// Shows why a key does nothing here, and discards the count that was typed.
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

    /// Shows the reason why the session cannot be saved, until it can.
    pub fn set_trouble(&mut self, trouble: Option<String>) {
        self.changed |= self.messages.set_trouble(trouble);
    }

    /// Returns how long the present message stays. Returns `None` if there is no message or only a key removes it.
    pub fn notice_ends_in(&self) -> Option<Duration> {
        self.messages.ends_in(self.now)
    }

    /// Returns the line about what to look at in the run.
    pub fn note(&self) -> Cow<'_, str> {
        messages::note(&self.view, &self.edits.runs, &self.player)
    }

    /// Returns the line at the bottom of the screen: the progress of a seek, the message, or the progress of an export.
    pub fn notice(&self) -> Option<String> {
        let stepping = self.player.in_words();
        stepping
            .or_else(|| self.messages.text().map(str::to_owned))
            .or_else(|| self.files.export_in_words())
    }

    /// Returns true if the picture has changed since it was last drawn.
    pub fn has_changed(&self) -> bool {
        self.changed
    }

    /// Does the same as [`has_changed`](Self::has_changed), and marks the picture as drawn.
    pub fn take_changed(&mut self) -> bool {
        std::mem::take(&mut self.changed)
    }

    /// Returns the content of a session file, including the state of the `lessons`.
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

    /// Stops undo at the present act if `is_here` is true, or removes that limit.
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

    /// Returns the mode that decides what keys mean: the top window, or the list that has the focus.
    pub fn mode(&self) -> Mode {
        let is_list = self.view.sheet.as_ref().is_some_and(|sheet| sheet.is_list);
        match self.popups.mode {
            Mode::Lab if is_list && self.view.focus == view::Pane::Lesson => Mode::Lessons,
            mode => mode,
        }
    }

    /// Returns the time since the lab was opened, as of the last call of [`advance`](Self::advance).
    pub fn now(&self) -> Duration {
        self.now
    }

    /// Returns the view for direct changes, and marks the picture as changed.
    pub fn view_mut(&mut self) -> &mut View {
        self.changed = true;
        &mut self.view
    }

    /// Shows `sheet` next to the panes, or removes it.
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

/// Sessions and measured data.
impl Lab {
    /// Creates a lab from the `content` of a session. It seeks the step at which the session ended, and pauses there.
    ///
    /// `view` returns how the run is shown on this screen. If `confined` is given, the lab reads and writes in that
    /// folder only.
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

    /// Restores the pinned run and the measured data, and reports what was restored and what was lost.
    ///
    /// A failure here does not affect the run.
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
            text += &format!("; the measured data {name} cannot be shown: {why}");
        }
        self.tell(text);
    }

    /// Shows the measured data `name` with the run, with the `options` of the command line. Without `name`, shows the
    /// data that the scenario's `[view]` names.
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
