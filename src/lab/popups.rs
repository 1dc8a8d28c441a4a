//! The popups (browser, help, dialog), which are drawn over the panes and receive the keys; and the count typed before
//! a key.

use super::action::FieldEdit;
use super::browser::Browser;
use super::dialog::Dialog;
use super::files::Files;
use super::form::{edit_line, type_into};
use crate::lab::storage::confined::Confined;

pub const MOST_COUNTED: u64 = 999_999_999;

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mode {
    /// The panes, without a popup.
    #[default]
    Lab,
    Browser,
    /// The list of lessons, which is next to the panes and has the focus.
    Lessons,
    /// The line in which the user types part of the name of a value.
    Find,
    /// The list of keys and words.
    Help,
    Dialog,
}

/// The browser, the help, the dialog, the mode that says which of them is open, and the count.
#[derive(Default)]
pub struct Popups {
    pub mode: Mode,
    /// The mode to return to when the help is closed.
    pub under_help: Mode,
    /// The open dialog: `Some` only in [`Mode::Dialog`].
    dialog: Option<Dialog>,
    pub browser: Browser,
    pub help: HelpSearch,
    pub count: Option<u64>,
}

impl Popups {
    pub fn dialog(&self) -> Option<&Dialog> {
        self.dialog.as_ref()
    }

    /// Appends `digit` to `count`, the count that the key has removed.
    pub(super) fn add_digit(&mut self, count: Option<u64>, digit: u8) {
        let longer = count.unwrap_or(0) * 10 + u64::from(digit);
        self.count = Some(longer.min(MOST_COUNTED));
    }

    pub(super) fn open_dialog(&mut self, dialog: Dialog) {
        self.dialog = Some(dialog);
        self.mode = Mode::Dialog;
    }

    /// Opens a dialog that asks for a number in `unit`.
    ///
    /// `title` says what the number is, `about` says how to answer, and `typed` is the first character if it was typed
    /// already.
    pub fn ask_number(&mut self, title: &str, unit: &str, about: &str, typed: Option<char>) {
        self.open_dialog(Dialog::number(title, unit, about));
        if let Some(first) = typed {
            self.edit_field(FieldEdit::Type(first));
        }
    }

    pub(super) fn take_dialog(&mut self) -> Option<Dialog> {
        let dialog = self.dialog.take()?;
        self.mode = Mode::Lab;
        Some(dialog)
    }

    /// Opens the browser in the folder of `files`, with `name` selected.
    pub(super) fn browse(&mut self, name: &str, files: &Files) {
        self.browser.also = files.confined().and_then(Confined::class);
        self.browser.begin(files.folder(), name, |path| {
            files.admit_reading(path).is_ok()
        });
        self.mode = Mode::Browser;
    }

    /// Lists the folder that is selected in the browser, or returns the name of the entry to open.
    ///
    /// # Errors
    /// Returns an error if there is nothing to open.
    pub(super) fn choose(&mut self, files: &Files) -> Result<Option<String>, String> {
        let Some(entry) = self.browser.choice().cloned() else {
            return Err("nothing is selected: Esc clears the filter".to_owned());
        };
        if entry.is_folder {
            let is_listed = self.browser.enter(|path| files.admit_reading(path).is_ok());
            return is_listed
                .then_some(None)
                .ok_or_else(|| format!("{} cannot be opened any more", entry.name));
        }
        Ok(Some(entry.name))
    }

    pub fn shows_settings(&self) -> bool {
        self.dialog.as_ref().is_some_and(Dialog::is_of_settings)
    }

    /// Opens the help on top of the present mode, or closes it.
    pub(super) fn toggle_help(&mut self) {
        self.help = HelpSearch::default();
        if self.mode == Mode::Help {
            self.mode = self.under_help;
        } else {
            self.under_help = self.mode;
            self.mode = Mode::Help;
        }
    }

    /// Closes the top popup, but clears the filter of a list first. Returns false if no popup was open.
    ///
    /// The filter of the values must be cleared by the caller.
    pub(super) fn close(&mut self) -> bool {
        match self.mode {
            Mode::Lab | Mode::Lessons => return false,
            Mode::Find => self.mode = Mode::Lab,
            Mode::Help if !self.help.text.is_empty() => self.help = HelpSearch::default(),
            Mode::Help => self.toggle_help(),
            Mode::Browser if !self.browser.filter.is_empty() => {
                self.browser.filter_by(String::clear);
            }
            Mode::Browser => self.mode = Mode::Lab,
            Mode::Dialog if self.dialog.as_mut().is_some_and(Dialog::clear_filter) => {}
            Mode::Dialog => drop(self.take_dialog()),
        }
        true
    }

    /// Moves the selection of the browser or the help by `rows`.
    pub(super) fn shift(&mut self, rows: isize) {
        match self.mode {
            Mode::Browser => self.browser.shift(rows),
            Mode::Help => self.help.shift(rows),
            Mode::Lab | Mode::Lessons | Mode::Find | Mode::Dialog => {}
        }
    }

    /// Selects the row with this index in the open list or dialog.
    pub fn select(&mut self, row: usize) {
        match (self.mode, &mut self.dialog) {
            (Mode::Browser, _) => self.browser.select(row),
            (Mode::Help, _) => self.help.selected = row,
            (Mode::Dialog, Some(dialog)) => dialog.form.select(row),
            _ => {}
        }
    }

    pub(super) fn edit_field(&mut self, edit: FieldEdit) {
        match (&mut self.dialog, self.mode) {
            (Some(dialog), _) => dialog.edit_field(edit),
            (None, Mode::Help) => self.help.search(|line| edit_line(line, edit)),
            (None, _) => self.browser.filter_by(|line| edit_line(line, edit)),
        }
    }

    /// Inserts the pasted `text` into the dialog or the filter.
    ///
    /// Elsewhere, returns a message instead, because the letters of pasted text are not meant as keys.
    pub(super) fn paste(&mut self, text: &str) -> Option<String> {
        match (&mut self.dialog, self.mode) {
            (Some(dialog), _) => dialog.paste(text),
            (None, Mode::Help) => self.help.search(|line| type_into(line, text)),
            (None, Mode::Browser) => self.browser.filter_by(|line| type_into(line, text)),
            _ => {
                let place =
                    "paste into fields and filters; rows of your own program can be pasted here";
                return Some(place.to_owned());
            }
        }
        None
    }
}

/// The search text of the help, and the selected entry.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct HelpSearch {
    pub text: String,
    pub selected: usize,
}

impl HelpSearch {
    /// Changes the search text, and selects the first entry found. A leading `/` is ignored, because it starts a search
    /// in other panes.
    fn search(&mut self, change: impl FnOnce(&mut String)) {
        change(&mut self.text);
        self.text = self.text.trim_start_matches('/').to_owned();
        self.selected = 0;
    }

    pub(super) fn shift(&mut self, rows: isize) {
        self.selected = self.selected.saturating_add_signed(rows);
    }

    /// Limits the selection to `entries` entries.
    pub fn limit(&mut self, entries: usize) {
        self.selected = self.selected.min(entries.saturating_sub(1));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pasted_text_goes_into_the_active_field() {
        let mut popups = Popups::default();
        assert!(popups.paste("q").unwrap().contains("paste into fields"));
        popups.open_dialog(Dialog::go_to());
        assert_eq!(popups.paste("400"), None);
        assert_eq!(popups.take_dialog().unwrap().form.text(0), "400");
        popups.mode = Mode::Browser;
        assert_eq!(popups.paste("x"), None);
        assert_eq!(popups.browser.filter, "x");
    }
}
