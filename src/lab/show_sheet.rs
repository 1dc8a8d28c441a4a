//! Shows a sheet beside the panes: where it stands, and how far it is scrolled.

use super::Lab;
use super::action::Direction;
use super::sheet::Sheet;
use super::view::Pane;
use std::sync::Arc;

impl Lab {
    /// Shows `sheet` beside the panes, or none. It stays scrolled as it is where its title is the same.
    pub fn set_sheet(&mut self, sheet: Option<Sheet>) {
        if self.view.sheet.as_deref() == sheet.as_ref() {
            return;
        }
        let before = self.view.sheet.take();
        let is_same = match (&before, &sheet) {
            (Some(before), Some(sheet)) => before.title == sheet.title && before.seen == sheet.seen,
            _ => false,
        };
        if !is_same {
            self.view.sheet_scrolled = None;
        }
        self.view.sheet = sheet.map(Arc::new);
        self.view.keep_focus();
        self.changed = true;
    }

    /// Scrolls the sheet by `rows`; it is `shown` rows high of `all`, and begins at the row `first` now.
    pub fn scroll_sheet(&mut self, rows: isize, first: usize, shown: usize, all: usize) {
        let last = all.saturating_sub(shown);
        let to = first.saturating_add_signed(rows).min(last);
        self.view.sheet_scrolled = Some(to);
        self.changed = true;
    }

    pub fn turn_to_sheet(&mut self) {
        if self.view.sheet.is_some() {
            self.view.filled &= self.view.focus == Pane::LESSON;
            self.view.focus = Pane::LESSON;
            self.changed = true;
        }
    }
}

/// Rows by which a key scrolls a sheet of which `shown` rows are seen.
pub fn scrolled_by(direction: Direction, shown: usize) -> isize {
    let page = shown.saturating_sub(1).max(1) as isize;
    match direction {
        Direction::Up | Direction::Left => -1,
        Direction::Down | Direction::Right => 1,
        Direction::PageUp => -page,
        Direction::PageDown => page,
    }
}
