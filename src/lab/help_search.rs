//! The search in the help, and the entry that is selected among those found.

use super::typing::type_into;

/// The text that is searched for, and the selected entry.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct HelpSearch {
    pub text: String,
    pub selected: usize,
}

impl HelpSearch {
    /// Shows every entry; the first is selected.
    pub(super) fn clear(&mut self) {
        *self = Self::default();
    }

    /// Adds `text` to the text that is searched for, up to 100 characters; the first entry found is selected. `/` begins a
    /// search in other panes: at the beginning it means nothing here.
    pub(super) fn type_text(&mut self, text: &str) {
        let begun = if self.text.is_empty() { "/" } else { "" };
        type_into(&mut self.text, text.strip_prefix(begun).unwrap_or(text));
        self.selected = 0;
    }

    /// Removes the last character; the first entry found is selected.
    pub(super) fn erase(&mut self) {
        self.text.pop();
        self.selected = 0;
    }

    pub(super) fn shift(&mut self, rows: isize) {
        self.selected = self.selected.saturating_add_signed(rows);
    }

    /// Moves the selection to the last of `entries` entries, if it is beyond it.
    pub(super) fn limit(&mut self, entries: usize) {
        self.selected = self.selected.min(entries.saturating_sub(1));
    }
}
