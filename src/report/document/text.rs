//! The text of a sentence, a caption or a cell, and the markup in which it is written.

use super::formula::Formula;

/// A text in pieces.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Text(pub Vec<Span>);

#[derive(Clone, Debug, PartialEq)]
pub enum Span {
    Plain(String),
    Emphasis(String),
    Strong(String),
    Code(String),
    Formula(Formula),
    Quantity(Quantity),
    /// The label of a figure or a table.
    Reference(String),
    /// The key of a [`Reference`](super::Reference).
    Citation(String),
}

/// A number with its unit.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Quantity {
    /// The digits as [`number`](crate::engine::text::number) writes them: `0.886033(24)`, `2.4e-9`; empty for a unit alone.
    pub number: String,
    /// The unit as readouts write it: `m/s2`, `kg m2`, `deg`; empty for a pure number.
    pub unit: String,
}

/// Characters that have a meaning in markup.
const MARKS: [char; 7] = ['\\', '*', '`', '$', '{', '[', ']'];

/// Returns `text` as markup that shows it unchanged.
pub fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in text.chars() {
        if MARKS.contains(&c) {
            escaped.push('\\');
        }
        escaped.push(c);
    }
    escaped
}

/// Returns the markup of a number with its unit.
pub fn quantity(number: &str, unit: &str) -> String {
    format!("{{{}}}", format!("{number} {unit}").trim_end())
}

impl Text {
    /// Returns `text` as it is, without markup: what a user wrote.
    pub fn plain(text: &str) -> Self {
        Self(vec![Span::Plain(text.to_owned())])
    }

    pub fn code(text: &str) -> Self {
        Self(vec![Span::Code(text.to_owned())])
    }

    /// Returns the cell of a table that holds a pure number; a column of numbers aligns it.
    pub fn number(number: &str) -> Self {
        Self(vec![Span::Quantity(Quantity {
            number: number.to_owned(),
            unit: String::new(),
        })])
    }

    /// Returns a unit as readouts write it: `kg m2`.
    pub fn unit(unit: &str) -> Self {
        Self(vec![Span::Quantity(Quantity {
            number: String::new(),
            unit: unit.to_owned(),
        })])
    }

    pub(super) fn is_empty(&self) -> bool {
        self.0.iter().all(|span| match span {
            Span::Plain(text) | Span::Emphasis(text) | Span::Strong(text) | Span::Code(text) => {
                text.is_empty()
            }
            Span::Quantity(Quantity { number, unit }) => number.is_empty() && unit.is_empty(),
            Span::Formula(_) | Span::Reference(_) | Span::Citation(_) => false,
        })
    }

    /// Parses markup:
    ///
    /// | markup | meaning |
    /// |---|---|
    /// | `*text*`, `**text**` | emphasis, strong emphasis |
    /// | `` `text` `` | code |
    /// | `$ψ = |Ω| dt$` | a formula: letters are italic, `_{...}` lowers, `^{...}` raises, `√(...)` is a root |
    /// | `{0.389(12) m/s2}` | a number with its unit, see [`quantity`] |
    /// | `[#label]` | "Figure 1" or "Table 1" |
    /// | `[@key]` | a citation |
    /// | `\*` | the character itself |
    ///
    /// A mark without its counterpart is an ordinary character.
    pub fn marked(markup: &str) -> Self {
        let mut spans = Vec::new();
        let mut plain = String::new();
        let mut rest = markup;
        while let Some(c) = rest.chars().next() {
            let after = &rest[c.len_utf8()..];
            if let Some((span, left)) = marked_span(rest) {
                if !plain.is_empty() {
                    spans.push(Span::Plain(std::mem::take(&mut plain)));
                }
                spans.push(span);
                rest = left;
                continue;
            }
            let literal = after.chars().next().filter(|_| c == '\\');
            plain.push(literal.unwrap_or(c));
            rest = &after[literal.map_or(0, char::len_utf8)..];
        }
        if !plain.is_empty() {
            spans.push(Span::Plain(plain));
        }
        Self(spans)
    }

    /// Returns the number if the text is a pure number alone.
    pub(super) fn as_number(&self) -> Option<&str> {
        match &self.0[..] {
            [Span::Quantity(quantity)] if quantity.unit.is_empty() => Some(&quantity.number),
            _ => None,
        }
    }
}

/// Returns the marked span at the beginning of `markup`, and what follows it.
fn marked_span(markup: &str) -> Option<(Span, &str)> {
    const PAIRS: [(&str, &str); 7] = [
        ("**", "**"),
        ("*", "*"),
        ("`", "`"),
        ("$", "$"),
        ("{", "}"),
        ("[#", "]"),
        ("[@", "]"),
    ];
    let (open, close) = PAIRS
        .into_iter()
        .find(|(open, _)| markup.starts_with(open))?;
    let (inner, rest) = markup[open.len()..].split_once(close)?;
    if inner.is_empty() {
        return None;
    }
    let text = inner.to_owned();
    let span = match open {
        "**" => Span::Strong(text),
        "*" => Span::Emphasis(text),
        "`" => Span::Code(text),
        "$" => Span::Formula(Formula::parse(inner)),
        "{" => Span::Quantity(Quantity::parse(inner)),
        "[#" => Span::Reference(text),
        _ => Span::Citation(text),
    };
    Some((span, rest))
}

impl Quantity {
    fn parse(text: &str) -> Self {
        let (number, unit) = text.split_once(' ').unwrap_or((text, ""));
        Self {
            number: number.to_owned(),
            unit: unit.to_owned(),
        }
    }

    /// Returns the digits in front of the exponent, and the exponent.
    pub(super) fn parts(&self) -> (&str, Option<&str>) {
        match self.number.split_once('e') {
            Some((digits, exponent)) => (digits, Some(exponent)),
            None => (&self.number, None),
        }
    }
}
