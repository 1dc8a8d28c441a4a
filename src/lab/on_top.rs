//! What lies on top of the panes and gets the keys: the browser, the help, a dialog; the count typed before a key; and
//! the message at the bottom of the screen.

use super::action::FieldEdit;
use super::browser::Browser;
use super::dialog::Dialog;
use super::form::{MOST_IN_LINE, edit_line, type_into};
use super::notice::Notice;
use super::preview::Preview;
use std::time::Duration;

pub const MOST_COUNTED: u64 = 999_999_999;

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mode {
    /// The panes: nothing lies on top of them.
    #[default]
    Lab,
    Browser,
    /// The line in which the user types the browser's filter.
    Filter,
    /// The line in which the user types a part of the name of a value.
    Find,
    /// The list of keys and words.
    Help,
    Dialog,
}

/// The browser, the help and the dialog, and which of them is open; the count; the message.
#[derive(Default)]
pub struct OnTop {
    pub mode: Mode,
    /// The mode to return to when the help is closed.
    pub under_help: Mode,
    /// The open dialog; `Some` exactly in [`Mode::Dialog`].
    dialog: Option<Dialog>,
    pub browser: Browser,
    pub help: HelpSearch,
    pub count: Option<u64>,
    pub notice: Notice,
    /// Whether the last key asked to leave while an export was in progress, and the user was warned.
    was_warned: bool,
}

/// What was on the screen when a key was pressed; the key has removed it.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Cleared {
    pub(super) count: Option<u64>,
    /// Whether a message or a count was removed.
    pub(super) anything: bool,
    /// Whether the user was warned that leaving stops the export.
    pub(super) was_warned: bool,
}

impl OnTop {
    pub fn dialog(&self) -> Option<&Dialog> {
        self.dialog.as_ref()
    }

    /// Removes the message and the count, as every key does.
    pub(super) fn clear(&mut self) -> Cleared {
        let count = self.count.take();
        Cleared {
            count,
            anything: self.notice.take_back() || count.is_some(),
            was_warned: std::mem::take(&mut self.was_warned),
        }
    }

    /// Adds `digit` to `count`, the count that the key has removed.
    pub(super) fn add_digit(&mut self, count: Option<u64>, digit: u8) {
        let count = count.unwrap_or(0) * 10 + u64::from(digit);
        self.count = Some(count.min(MOST_COUNTED));
    }

    /// Warns at `now` that leaving stops the export; asked again right after it, the lab ends.
    pub(super) fn warn_of_export(&mut self, now: Duration) {
        self.was_warned = true;
        let text = "an export is under way: q again leaves it unfinished, and writes nothing";
        self.notice.say(text, now);
    }

    pub(super) fn open_dialog(&mut self, dialog: Dialog) {
        self.dialog = Some(dialog);
        self.mode = Mode::Dialog;
    }

    pub(super) fn take_dialog(&mut self) -> Option<Dialog> {
        let dialog = self.dialog.take()?;
        self.mode = Mode::Lab;
        Some(dialog)
    }

    /// The file that was chosen to be opened and what it holds, once it has been read. Where the browser no longer has
    /// the keys, the choice is forgotten.
    pub(super) fn take_chosen(&mut self) -> Option<(String, Preview)> {
        if !matches!(self.mode, Mode::Browser | Mode::Filter) {
            self.browser.forget_chosen();
        }
        self.browser.take_chosen()
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

    /// Closes the topmost of help, filters, browser and dialog; returns whether one of them was open. Of the help it first
    /// clears the search. The filter of the values is the caller's to clear.
    pub(super) fn close(&mut self) -> bool {
        match self.mode {
            Mode::Lab => return false,
            Mode::Find => self.mode = Mode::Lab,
            Mode::Help if !self.help.text.is_empty() => self.help = HelpSearch::default(),
            Mode::Help => self.toggle_help(),
            Mode::Filter => {
                self.browser.filter_by(String::clear);
                self.mode = Mode::Browser;
            }
            Mode::Browser if self.browser.forget_chosen() => {}
            Mode::Browser => self.mode = Mode::Lab,
            Mode::Dialog => drop(self.take_dialog()),
        }
        true
    }

    /// Moves the selection of the browser or the help by `rows`.
    pub(super) fn shift(&mut self, rows: isize) {
        match self.mode {
            Mode::Browser | Mode::Filter => self.browser.shift(rows),
            Mode::Help => self.help.shift(rows),
            Mode::Lab | Mode::Find | Mode::Dialog => {}
        }
    }

    pub(super) fn edit_field(&mut self, edit: FieldEdit) {
        match (&mut self.dialog, self.mode) {
            (Some(dialog), _) => dialog.edit_field(edit),
            (None, Mode::Help) => self.help.search(|line| edit_line(line, edit)),
            (None, _) => self.browser.filter_by(|line| edit_line(line, edit)),
        }
    }

    /// Puts the pasted `text` into the dialog or the filter, and says at `now` if it does not fit. In other modes it says
    /// that pasting does nothing: the letters of a pasted text are not meant as keys.
    pub(super) fn paste(&mut self, text: &str, now: Duration) {
        self.clear();
        match (&mut self.dialog, self.mode) {
            (Some(dialog), _) => dialog.paste(text),
            (None, Mode::Help) => {
                self.help.search(|line| type_into(line, text));
            }
            (None, Mode::Filter) => {
                if !self.browser.filter_by(|line| type_into(line, text)) {
                    let text = format!(
                        "the filter takes at most {MOST_IN_LINE} characters: what was pasted is cut"
                    );
                    self.notice.say(text, now);
                }
            }
            _ => {
                let text = "what is pasted goes into fields and filters; here it does nothing";
                self.notice.say(text, now);
            }
        }
    }
}

/// The text that is searched for, and the selected entry.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct HelpSearch {
    pub text: String,
    pub selected: usize,
}

impl HelpSearch {
    /// Changes the text that is searched for; the first entry found is selected. `/` begins a search in other panes: at
    /// the beginning it means nothing here.
    fn search<T>(&mut self, change: impl FnOnce(&mut String) -> T) -> T {
        let changed = change(&mut self.text);
        self.text = self.text.trim_start_matches('/').to_owned();
        self.selected = 0;
        changed
    }

    pub(super) fn shift(&mut self, rows: isize) {
        self.selected = self.selected.saturating_add_signed(rows);
    }

    /// Moves the selection to the last of `entries` entries, if it is beyond it.
    pub(super) fn limit(&mut self, entries: usize) {
        self.selected = self.selected.min(entries.saturating_sub(1));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NOW: Duration = Duration::ZERO;

    #[test]
    fn what_was_opened_last_is_closed_first() {
        let mut on_top = OnTop::default();
        assert!(!on_top.close());
        on_top.mode = Mode::Browser;
        on_top.toggle_help();
        assert_eq!(on_top.mode, Mode::Help);
        assert!(on_top.close());
        on_top.mode = Mode::Filter;
        on_top.edit_field(FieldEdit::Type('x'));
        let filter = |on_top: &OnTop| (on_top.mode, on_top.browser.filter.clone());
        assert_eq!(filter(&on_top), (Mode::Filter, "x".to_owned()));
        assert!(on_top.close());
        assert_eq!(filter(&on_top), (Mode::Browser, String::new()));
        assert!(on_top.close());
        on_top.open_dialog(Dialog::go_to());
        assert_eq!(on_top.mode, Mode::Dialog);
        assert!(on_top.close() && on_top.dialog().is_none());
        assert_eq!(on_top.mode, Mode::Lab);
    }

    #[test]
    fn a_key_removes_count_message_and_warning() {
        let mut on_top = OnTop::default();
        on_top.add_digit(None, 4);
        on_top.add_digit(Some(4), 2);
        assert_eq!(on_top.count, Some(42));
        on_top.add_digit(Some(MOST_COUNTED), 9);
        assert_eq!(on_top.count, Some(MOST_COUNTED));
        on_top.warn_of_export(NOW);
        let cleared = on_top.clear();
        assert_eq!(cleared.count, Some(MOST_COUNTED));
        assert!(cleared.anything && cleared.was_warned);
        let cleared = on_top.clear();
        assert_eq!((cleared.count, cleared.anything), (None, false));
        assert!(!cleared.was_warned && on_top.notice.text().is_none());
    }

    #[test]
    fn pasted_text_goes_where_text_is_typed() {
        let mut on_top = OnTop::default();
        on_top.paste("q", NOW);
        assert!(on_top.notice.text().unwrap().contains("does nothing"));
        on_top.open_dialog(Dialog::go_to());
        on_top.paste("400", NOW);
        assert_eq!(on_top.take_dialog().unwrap().form.text(0), "400");
        on_top.mode = Mode::Filter;
        on_top.paste(&"x".repeat(MOST_IN_LINE + 1), NOW);
        assert!(on_top.notice.text().unwrap().contains("is cut"));
    }

    #[test]
    fn the_help_begins_at_its_first_entry_each_time() {
        let mut on_top = OnTop::default();
        on_top.toggle_help();
        on_top.shift(10);
        on_top.shift(-3);
        assert_eq!(on_top.help.selected, 7);
        on_top.help.limit(5);
        assert_eq!(on_top.help.selected, 4);
        on_top.shift(-30);
        assert_eq!(on_top.help.selected, 0);
        on_top.shift(1);
        on_top.toggle_help();
        on_top.toggle_help();
        assert_eq!(on_top.help.selected, 0);
    }

    #[test]
    fn the_help_is_searched_and_esc_clears_the_search_first() {
        let mut on_top = OnTop::default();
        on_top.toggle_help();
        on_top.shift(3);
        on_top.edit_field(FieldEdit::Type('d'));
        on_top.paste("t\n", NOW);
        assert_eq!((on_top.help.text.as_str(), on_top.help.selected), ("dt", 0));
        on_top.edit_field(FieldEdit::Erase);
        assert_eq!(on_top.help.text, "d");
        assert!(on_top.close() && on_top.mode == Mode::Help);
        assert_eq!(on_top.help.text, "");
        assert!(on_top.close() && on_top.mode == Mode::Lab);
    }
}
