//! What the lab says: the message at the bottom of the screen, the line about what there is to see, and what to try next.

use super::Lab;
use super::course::halt_in_words;
use super::view::Part;
use crate::journal::changed;
use crate::playback::Halt;
use crate::scenario::presets;
use std::borrow::Cow;
use std::time::Duration;

/// What is said at the end of the scenario's run, before what to try next.
const END_OF_RUN: &str = "end of the run: space goes on, r begins again";

/// What is said of what would mend a run that has broken down, until the search for it has ended.
const IS_SOUGHT: &str = "a time step or scheme that mends it is looked for";

/// What a line about what to try says of the exact motion, and what it says where that is drawn.
const ASKS_FOR_EXACT: &str = "t draws the exact motion";
const HAS_EXACT: &str = "the exact motion is drawn in dashes";

impl Lab {
    /// Says why the run has stopped by itself.
    pub(super) fn halted(&mut self, halt: Halt) {
        self.player.has_halted(halt);
        self.read_now();
        let next = self.next().filter(|_| halt == Halt::EndOfRun);
        let said = next.map(|next| format!("{END_OF_RUN}. Next: {next}"));
        let said = said.or_else(|| halt_in_words(halt));
        match (said, halt) {
            (Some(text), Halt::NotFinite(_)) => self.tell_of_break(&text),
            (Some(text), _) => self.tell(text),
            (None, _) => {}
        }
    }

    /// Says `text`, that the numbers have stopped being finite, and what helps: a key that mends the run, which may still be
    /// looked for, and what takes back an edit.
    fn tell_of_break(&mut self, text: &str) {
        let step = self.player.playback.step_number();
        let undo = match self.work.journal().count_by(step) {
            0 => "",
            _ => ", u takes the last edit back",
        };
        let text = format!("{text}: {IS_SOUGHT}{undo}");
        self.on_top.notice.keep_seeking(text, IS_SOUGHT);
        self.changed = true;
        self.tell_what_was_found();
    }

    /// What mends the run, as far as that is known.
    fn what_mends(&self) -> String {
        let offer = self.player.offer().map(|[_, short]| short);
        offer.unwrap_or_else(|| "a shorter time step or another scheme may mend it (e)".to_owned())
    }

    /// Where the message says that advice is looked for, and the search has ended: says what was found instead.
    pub(super) fn tell_what_was_found(&mut self) {
        if self.on_top.notice.is_seeking() && !self.player.is_seeking_advice() {
            let found = self.what_mends();
            self.on_top.notice.find(&found);
            self.changed = true;
        }
    }

    /// The line about what to try after the run: as a command or the scenario has it, or else the preset, as long as its
    /// motion is as it was opened.
    fn next(&self) -> Option<Cow<'_, str>> {
        let file = self.player.run().scenario().file.view.as_ref();
        let told = self.view.next.as_deref();
        let told = told.or_else(|| file?.next.as_deref());
        let preset = || match self.work.changed_from_file() {
            None => presets::find(self.work.name()).map(|preset| preset.next),
            Some(_) => None,
        };
        let next = told.or_else(preset).filter(|next| !next.is_empty())?;
        // What is on the screen already is not to be asked for.
        match self.player.run().overlay() {
            Some(_) => Some(next.replace(ASKS_FOR_EXACT, HAS_EXACT).into()),
            None => Some(next.into()),
        }
    }

    /// Shows why a key means nothing here, and forgets the count that was typed.
    pub fn refuse(&mut self, text: impl Into<String>) {
        self.on_top.count = None;
        self.say(text);
        self.changed = true;
    }

    /// Shows `text` for a few seconds.
    pub(super) fn say(&mut self, text: impl Into<String>) {
        self.on_top.notice.say(text, self.now);
    }

    /// Shows `text` until the next key.
    pub fn tell(&mut self, text: impl Into<String>) {
        self.on_top.notice.keep_saying(text);
        self.changed = true;
    }

    pub fn take_back_message(&mut self) {
        self.changed |= self.on_top.notice.take_back();
    }

    /// Shows `text` before the present message, until the next key.
    pub fn tell_first(&mut self, text: &str) {
        self.on_top.notice.keep_saying_first(text);
        self.changed = true;
    }

    /// Shows why the session cannot be saved, until it can.
    pub fn set_trouble(&mut self, trouble: Option<String>) {
        self.changed |= self.on_top.notice.set_trouble(trouble);
    }

    /// How long the present message stays; `None` where only a key removes it, or there is none.
    pub fn notice_ends_in(&self) -> Option<Duration> {
        self.on_top.notice.ends_in(self.now)
    }

    /// The line about what there is to see in the run.
    pub fn note(&self) -> Cow<'_, str> {
        if self.view.hides(Part::LookAt) {
            return "".into();
        }
        let file = || changed::look_at(self.player.run().scenario());
        let told = self.view.look_at.as_deref();
        let playback = &self.player.playback;
        let is_over = playback.is_endless() && playback.step_number() >= playback.end_step();
        if let Some(next) = self.next().filter(|_| is_over) {
            return next;
        }
        let changed = self.work.changed_from_file();
        if told.is_none() && changed.is_some() && self.view.sheet.is_some() {
            // The page says what the run is. The file's line speaks of another one.
            return "".into();
        }
        let note = told.or(changed).or_else(file);
        let note = note
            .unwrap_or("? lists the keys; the scenario's own line, view.look_at, would stand here");
        note.into()
    }

    /// The message at the bottom of the screen: the steps that are being taken, the message, or the export's progress.
    pub fn notice(&self) -> Option<String> {
        let stepping = self.player.in_words();
        let said = || self.on_top.notice.text().map(str::to_owned);
        stepping
            .or_else(said)
            .or_else(|| self.files.export_in_words())
    }
}
