//! A text that stands beside the panes, such as the page of a lesson. A room above the lab writes it.

use super::Lab;
use super::view::Pane;
use crate::text::ascii::in_ascii;
use std::sync::Arc;

#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Sheet {
    /// What stands in its frame.
    pub title: String,
    pub paragraphs: Vec<Paragraph>,
    /// The first and the last of the paragraphs that are to be seen whole: a longer sheet is scrolled to them.
    pub seen: Option<(usize, usize)>,
    /// Whether a run is played before the rest of the sheet comes: where there is room for one pane, both share it.
    pub plays: bool,
    /// Whether a number is asked for: a digit begins to type it.
    pub asks_number: bool,
    /// What Enter does here, in one word; empty where it does nothing.
    pub enter: &'static str,
    pub has_next: bool,
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

    /// The same for a terminal without UTF-8.
    pub fn in_ascii(&self) -> Self {
        let words = self.words.iter().map(|words| Words {
            text: in_ascii(&words.text),
            emphasis: words.emphasis,
        });
        let kind = self.kind.clone();
        Self {
            kind,
            words: words.collect(),
        }
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

    /// Keeps undo from going back beyond what was done up to now, or lets it again.
    pub fn set_undo_floor(&mut self, is_here: bool) {
        self.work.set_floor(is_here);
    }

    /// Whether a digit begins to type the number that the sheet asks for.
    pub fn asks_number(&self) -> bool {
        let sheet = self
            .view
            .sheet
            .as_ref()
            .filter(|_| self.on_top.count.is_none());
        self.view.focus == Pane::LESSON && sheet.is_some_and(|sheet| sheet.asks_number)
    }

    pub fn turn_to_sheet(&mut self) {
        if self.view.sheet.is_some() {
            self.view.filled &= self.view.focus == Pane::LESSON;
            self.view.focus = Pane::LESSON;
            self.changed = true;
        }
    }
}
