//! A text next to the panes, such as the page of a lesson. A module above the lab writes it.

use crate::engine::text::ascii::in_ascii;

#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Sheet {
    /// The text at the left of the top rule.
    pub title: String,
    /// The text at the right of the top rule: the page number.
    pub place: String,
    pub paragraphs: Vec<Paragraph>,
    /// The first and the last paragraph that must be visible. A longer sheet is scrolled to them.
    pub seen: Option<(usize, usize)>,
    /// True if a run is played before the rest of the sheet is shown. A screen with room for only one pane is then
    /// shared by both.
    pub plays: bool,
    /// The question that waits for an answer. Until it is answered, everything that reveals the answer is hidden.
    pub asked: Option<AskedAnswer>,
    /// True if a class is still answering the question. Everything that reveals the answer then stays hidden from those
    /// who have answered, too.
    pub is_round_open: bool,
    /// True if a digit selects or begins an answer instead of a count.
    pub takes_digits: bool,
    /// The effect of Enter, in one word; empty if it does nothing.
    pub enter: &'static str,
    pub has_next: bool,
    /// True if the sheet is a list that typed text filters.
    pub is_list: bool,
    /// True if the sheet fills the screen and the run is not shown.
    pub is_alone: bool,
    /// The text on the top rule instead of the title, unless empty. It may change while the page stays.
    pub framed: String,
    /// The text in the last row.
    pub border: String,
}

/// The kind of answer for which a question waits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AskedAnswer {
    Choice {
        /// Number of answers.
        count: usize,
        /// True if an answer is selected but not submitted.
        is_chosen: bool,
    },
    Number,
    /// An answer that is given in other labs.
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
        /// The text in front of the entry: a dash or a number.
        mark: String,
        /// Nesting depth of its list: the number of lists that contain the list.
        depth: u16,
    },
    Code,
    /// Bold words right above the next paragraph.
    Caption,
    Question,
    Choice {
        /// The number of the choice, if it has one.
        number: Option<usize>,
        /// True if the choice is selected.
        is_selected: bool,
        /// The text at the end of the row, such as a note that the choice was submitted.
        mark: &'static str,
    },
    /// The prediction, above the result.
    Said,
    /// The result.
    Result,
    Goal {
        /// True if the goal has been reached.
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
    /// Returns true if it is the selected choice.
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

    /// Returns the paragraph in ASCII, for a terminal without UTF-8.
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
