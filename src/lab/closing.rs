//! What Esc closes or stops.

use super::action::{LessonKey, Request};
use super::command::{Command, CursorTo};
use super::popups::Mode;
use super::view::Pane;
use super::{Cleared, Lab};

impl Lab {
    /// Closes or stops the first of these that there is: a popup, the script, the steps asked for, the cursor, the pane that
    /// fills the screen, the focus on the parameters, the export, the pane in focus that was asked for. If there is none of
    /// these, it says how to leave, unless the key has already removed a message or a count.
    pub(super) fn close(&mut self, cleared: &Cleared) -> Option<Request> {
        // The focus returns from the values to the run even if the key has removed a message too.
        let is_done = self.close_popup()
            || self.stop()
            || self.unfill()
            || (cleared.count.is_none() && self.view.leave_parameters())
            || cleared.anything;
        if is_done {
            return None;
        }
        if self.files.is_exporting() {
            self.files.stop_export();
        } else if self.view.focus.is_on_request && self.view.shows(self.view.focus) {
            self.carry_out_all(&self.view.toggled(self.view.focus));
        } else if self.view.sheet.is_some() {
            return Some(Request::Lesson(LessonKey::Leave));
        } else {
            self.say("nothing to close; q leaves");
        }
        None
    }

    /// Closes the topmost popup, or shows all values again; returns whether there was one, or some were left out.
    fn close_popup(&mut self) -> bool {
        let is_found = self.popups.mode == Mode::Find;
        let is_filtered = self.popups.mode == Mode::Lab && self.view.focus == Pane::PARAMETERS;
        // From a value that was searched for, one Esc leads back to the page of a lesson, as it does from any other.
        let is_left = is_filtered && self.view.sheet.is_some();
        let forget = |line: &mut String| !std::mem::take(line).is_empty();
        let list = &mut self.edits.values.list;
        let is_shown = (is_found || is_filtered) && list.filter_by(forget) && !is_left;
        self.popups.close() || is_shown
    }

    /// Stops the script, or the steps asked for.
    fn stop(&mut self) -> bool {
        if !self.script.is_done() {
            let left_out = self.script.drop_all();
            self.one(Command::Pause);
            self.say(left_out);
        } else if self.player.playback.steps_to_go().is_some() {
            self.one(Command::Pause);
        } else {
            return false;
        }
        true
    }

    /// Takes the cursor away, or shows all panes again.
    fn unfill(&mut self) -> bool {
        if self.view.cursor.is_some() {
            self.one(Command::Cursor(CursorTo::Nowhere));
        } else if self.view.filled {
            self.one(Command::Fill(None));
            self.view.turn_to_sheet();
            // On a screen that has no place for the values beside the run, they fill it: leaving them shows the run again.
            if !self.view.side_by_side.contains(&Pane::PARAMETERS) {
                self.view.leave_parameters();
            }
        } else {
            return false;
        }
        true
    }
}
