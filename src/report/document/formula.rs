//! Formulas in a line: letters, indices and roots.

/// A formula in pieces.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Formula(pub Vec<Piece>);

#[derive(Clone, Debug, PartialEq)]
pub enum Piece {
    /// Letters of variables, which are italic.
    Variables(String),
    /// A word that is upright: a function, or a name of several letters in an index.
    Word(String),
    /// Digits, operators, brackets and spaces.
    Other(String),
    Index(Formula),
    Power(Formula),
    Root(Formula),
}

/// Words that are not variables.
const FUNCTIONS: [&str; 9] = [
    "sin", "cos", "tan", "arcsin", "arccos", "arctan", "exp", "min", "max",
];

impl Formula {
    /// Parses `text`: `_` lowers and `^` raises the next character or the next `{...}`; `√` takes the next character or the
    /// next `(...)`. Everything else is written as it is: `κ`, `−`, `≈`.
    pub fn parse(text: &str) -> Self {
        Self::of_line(text, false)
    }

    fn of_line(text: &str, is_index: bool) -> Self {
        let mut pieces = Vec::new();
        let mut rest = text;
        while let Some(c) = rest.chars().next() {
            let after = &rest[c.len_utf8()..];
            rest = match c {
                '_' | '^' => {
                    let (inner, left) = argument(after, '{', '}');
                    let inner = Self::of_line(inner, true);
                    pieces.push(if c == '_' {
                        Piece::Index(inner)
                    } else {
                        Piece::Power(inner)
                    });
                    left
                }
                '√' => {
                    let (inner, left) = argument(after, '(', ')');
                    pieces.push(Piece::Root(Self::of_line(inner, is_index)));
                    left
                }
                _ if c.is_alphabetic() => {
                    let end = rest.find(|letter: char| !letter.is_alphabetic());
                    let (word, left) = rest.split_at(end.unwrap_or(rest.len()));
                    let is_name = is_index && word.is_ascii() && word.len() > 1;
                    pieces.push(if is_name || FUNCTIONS.contains(&word) {
                        Piece::Word(word.to_owned())
                    } else {
                        Piece::Variables(word.to_owned())
                    });
                    left
                }
                _ => {
                    match pieces.last_mut() {
                        Some(Piece::Other(other)) => other.push(c),
                        _ => pieces.push(Piece::Other(c.to_string())),
                    }
                    after
                }
            };
        }
        Self(pieces)
    }

    /// Returns the digits and signs of a formula that holds nothing else: an index such as 0 or a power such as -9.
    pub(super) fn as_digits(&self) -> Option<&str> {
        match &self.0[..] {
            [Piece::Other(text)] if text.chars().all(|c| "0123456789+-−".contains(c)) => {
                Some(text)
            }
            _ => None,
        }
    }
}

/// Returns what is between `open` and `close` at the beginning of `text`, or the first character, and the rest.
fn argument(text: &str, open: char, close: char) -> (&str, &str) {
    let mut depth = 0;
    for (at, c) in text.char_indices() {
        if c == open {
            depth += 1;
        } else if c == close && depth > 0 {
            depth -= 1;
        }
        if depth == 0 {
            let end = at + c.len_utf8();
            let inner = if c == close && at > 0 {
                &text[open.len_utf8()..at]
            } else {
                &text[..end]
            };
            return (inner, &text[end..]);
        }
    }
    (text, "")
}
