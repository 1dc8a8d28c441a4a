//! A text that stands beside the panes, such as the page of a lesson. A room above the lab writes it.

use crate::engine::text::ascii::in_ascii;

#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Sheet {
    /// What stands on its rule, at the left.
    pub title: String,
    /// What stands there at the right: which of its pages this is.
    pub place: String,
    pub paragraphs: Vec<Paragraph>,
    /// The first and the last of the paragraphs that are to be seen whole: a longer sheet is scrolled to them.
    pub seen: Option<(usize, usize)>,
    /// Whether a run is played before the rest of the sheet comes: where there is room for one pane, both share it.
    pub plays: bool,
    /// The question that waits for an answer. Until it has one, whatever answers it is hidden.
    pub asked: Option<AskedAnswer>,
    /// Whether a class still answers the question: whatever answers it is hidden from those who have answered, too.
    pub is_round_open: bool,
    /// Whether a digit is an answer, or begins one, rather than a count.
    pub takes_digits: bool,
    /// What Enter does here, in one word; empty where it does nothing.
    pub enter: &'static str,
    pub has_next: bool,
    /// Whether it is a list that what is typed filters.
    pub is_list: bool,
    /// Whether it has the whole screen: nothing of the run is shown.
    pub is_alone: bool,
    /// What stands on its rule instead of the title, where that is not empty: it may change while the page stays.
    pub framed: String,
    /// What stands in its last row.
    pub border: String,
}

/// The answer that a question waits for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AskedAnswer {
    Choice {
        /// How many answers there are.
        count: usize,
        /// Whether one is chosen, though not given yet.
        is_chosen: bool,
    },
    Number,
    /// It is given in other labs.
    Elsewhere,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Paragraph {
    pub kind: SheetLineKind,
    pub words: Vec<StyledText>,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SheetLineKind {
    Heading,
    Text,
    /// An entry of a list.
    Item {
        /// What stands before it: a dash or a number.
        mark: String,
        /// In how many lists the list stands.
        depth: u16,
    },
    Code,
    /// Bold words right above the next paragraph.
    Caption,
    Question,
    Choice {
        /// Its number, where it has one.
        number: Option<usize>,
        /// Whether it is the selected one.
        is_selected: bool,
        /// What stands at the end of its row, such as that it was given.
        mark: &'static str,
    },
    /// What was predicted, above what came out.
    Said,
    /// What came out.
    Result,
    Goal {
        /// Whether it has been.
        is_reached: bool,
    },
    Hint,
    Note,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StyledText {
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

impl SheetLineKind {
    /// Returns whether it is the selected one of several choices.
    pub fn is_selected(&self) -> bool {
        matches!(
            self,
            Self::Choice {
                is_selected: true,
                ..
            }
        )
    }
}

impl Paragraph {
    pub fn new(kind: SheetLineKind, text: impl Into<String>) -> Self {
        let text = text.into();
        let words = vec![StyledText {
            text,
            emphasis: Emphasis::Plain,
        }];
        Self { kind, words }
    }

    /// The same for a terminal without UTF-8.
    pub fn in_ascii(&self) -> Self {
        let words = self.words.iter().map(|words| StyledText {
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
