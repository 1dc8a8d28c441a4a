//! A text that stands beside the panes, such as the page of a lesson. A room above the lab writes it; the lab knows where
//! it stands and how far it is scrolled.

use super::Lab;
use super::action::Direction;
use super::view::Pane;
use std::sync::Arc;

/// A text in paragraphs.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Sheet {
    /// What stands in its frame.
    pub title: String,
    /// The paragraphs, from top to bottom.
    pub paragraphs: Vec<Paragraph>,
    /// The paragraph that is to be seen: the sheet is scrolled to it where it is longer than its place.
    pub seen: Option<usize>,
}

/// A paragraph.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Paragraph {
    /// What it is.
    pub kind: Kind,
    /// Its words, in pieces of one look.
    pub words: Vec<Words>,
}

/// What a paragraph is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A heading.
    Heading,
    /// Plain text.
    Text,
    /// An entry of a list.
    Item {
        /// What stands before it: a dash or a number.
        mark: String,
        /// In how many lists the list stands.
        depth: u16,
    },
    /// Lines that are shown as they are.
    Code,
    /// A question.
    Question,
    /// An answer from which to choose.
    Choice {
        /// Whether it is the selected one.
        is_selected: bool,
        /// Whether it is the one that was given.
        is_given: bool,
    },
    /// What came out, beside what was predicted.
    Result,
    /// What is to be reached, and whether it has been.
    Goal {
        /// Whether it has been.
        is_reached: bool,
    },
    /// What to do next, and with which key.
    Hint,
    /// A note for the teacher.
    Note,
}

/// Words of one look.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Words {
    /// The text.
    pub text: String,
    /// How it looks.
    pub look: Look,
}

/// How words look.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Look {
    /// As the text around them.
    #[default]
    Plain,
    /// Strong.
    Strong,
    /// Keys, names and formulas.
    Code,
}

impl Paragraph {
    /// A paragraph of this `kind` in one look.
    pub fn new(kind: Kind, text: impl Into<String>) -> Self {
        let text = text.into();
        let words = vec![Words {
            text,
            look: Look::Plain,
        }];
        Self { kind, words }
    }

    /// Its text.
    pub fn text(&self) -> String {
        self.words.iter().map(|words| words.text.as_str()).collect()
    }
}

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

    /// Moves the focus to the sheet, if there is one.
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
