//! A text that stands beside the panes, such as the page of a lesson. A room above the lab writes it.

use super::Lab;
use super::view::Pane;
use std::sync::Arc;

#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Sheet {
    /// What stands in its frame.
    pub title: String,
    pub paragraphs: Vec<Paragraph>,
    /// The paragraph that is to be seen: the sheet is scrolled to it where it is longer than its place.
    pub seen: Option<usize>,
    /// What Enter does here, in one word; empty where it does nothing.
    pub enter: &'static str,
    pub has_next: bool,
    /// What stands in its frame instead of the title, where that is not empty: it may change while the page stays.
    pub framed: String,
    /// What stands in the lower line of its frame.
    pub border: String,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Paragraph {
    pub kind: Kind,
    pub words: Vec<Words>,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Kind {
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
    Code,
    Question,
    Choice {
        /// Whether it is the selected one.
        is_selected: bool,
        /// Whether it is the one that was given.
        is_given: bool,
    },
    /// What came out, beside what was predicted.
    Result,
    Goal {
        /// Whether it has been.
        is_reached: bool,
    },
    Hint,
    /// A note for the teacher.
    Note,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Words {
    pub text: String,
    pub emphasis: Emphasis,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Emphasis {
    #[default]
    Plain,
    Strong,
    /// Keys, names and formulas.
    Code,
}

impl Paragraph {
    pub fn new(kind: Kind, text: impl Into<String>) -> Self {
        let text = text.into();
        let words = vec![Words {
            text,
            emphasis: Emphasis::Plain,
        }];
        Self { kind, words }
    }

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
        let is_same = |(before, sheet): (Arc<Sheet>, &Sheet)| {
            before.title == sheet.title && before.seen == sheet.seen
        };
        if !before.zip(sheet.as_ref()).is_some_and(is_same) {
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
