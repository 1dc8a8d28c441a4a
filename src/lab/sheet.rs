//! A text that stands beside the panes, such as the page of a lesson. A room above the lab writes it.

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
