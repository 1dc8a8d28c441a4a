//! A text that stands beside the panes, such as the page of a lesson. A room above the lab writes it.

/// A text in paragraphs.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Sheet {
    /// What stands in its frame.
    pub title: String,
    /// The paragraphs, from top to bottom.
    pub paragraphs: Vec<Paragraph>,
    /// The paragraph that is to be seen: the sheet is scrolled to it where it is longer than its place.
    pub seen: Option<usize>,
    /// What Enter does here, in one word; empty where it does nothing.
    pub enter: &'static str,
    /// Whether there is a page after it.
    pub has_next: bool,
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
