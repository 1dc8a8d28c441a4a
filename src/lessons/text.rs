//! Markdown text with placeholders for numbers, such as `{z_m:.3}`.
//!
//! A placeholder has an expression and, after a colon, an optional format: `.3` for three decimals, `.2e` for an
//! exponent. Without a format, the number has four significant digits. A literal brace is written `\{`, as in Markdown.
//! In code, braces are literal.

use super::names::{KeptNumbers, value};
use super::structure::on_line;
use crate::engine::journal::expression::Expression;
use crate::engine::scenario::Problem;
use crate::engine::text::number;
use crate::engine::text::printable::brief;
use crate::lab::Lab;
use pulldown_cmark::{Event, Parser, Tag};
use std::ops::Range;

/// Significant digits of a number without a format.
const LESSON_NUMBER_DIGITS: usize = 4;
/// Maximum number of decimals.
const MOST_DECIMALS: usize = 12;
const MOST_TEXT_PROBLEMS: usize = 100;

/// Markdown text with placeholders.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LessonText {
    /// First line of the text in the file, from 1.
    pub line: usize,
    parts: Vec<Piece>,
}

/// A piece of text, or a placeholder.
#[derive(Clone, Debug, PartialEq)]
pub enum Piece {
    Plain(String),
    Number(Expression, TextFormat),
}

/// Format of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TextFormat {
    /// Four significant digits.
    Short,
    /// This number of decimals.
    Fixed(usize),
    /// An exponent, and this number of decimals.
    Exponent(usize),
}

impl TextFormat {
    /// Returns `number` in this format, or "n/a" if it is missing or not finite.
    pub fn written(self, number: Option<f64>) -> String {
        let Some(number) = number.filter(|number| number.is_finite()) else {
            return number::NOT_AVAILABLE.to_owned();
        };
        match self {
            Self::Short => number::significant(number, LESSON_NUMBER_DIGITS),
            Self::Fixed(digits) => number::fixed(number, digits),
            Self::Exponent(digits) => number::exponent(number, digits),
        }
    }

    fn read(text: &str) -> Result<Self, String> {
        Self::parse(text).ok_or_else(|| {
            format!(
                "{text} is not a number format: use .3 for three decimals, or .2e for an exponent"
            )
        })
    }

    fn parse(text: &str) -> Option<Self> {
        let decimals = text.strip_prefix('.')?;
        let (digits, format): (_, fn(usize) -> Self) = match decimals.strip_suffix('e') {
            Some(digits) => (digits, Self::Exponent),
            None => (decimals, Self::Fixed),
        };
        let count = digits.parse().ok();
        count.filter(|count| *count <= MOST_DECIMALS).map(format)
    }
}

impl LessonText {
    /// Parses `source`, which begins at `line`. `find` returns an error for an unknown name.
    pub(super) fn read(
        source: &str,
        line: usize,
        find: impl Fn(&str) -> Result<(), String>,
    ) -> Result<Self, Vec<Problem>> {
        let code = code_in(source);
        let (mut parts, mut problems) = (Vec::new(), Vec::new());
        let (mut plain, mut at) = (0, 0);
        while let Some(found) = source[at..].find('{') {
            let open = at + found;
            at = open + 1;
            let is_code = code.iter().any(|range| range.contains(&open));
            if is_code || source[..open].ends_with('\\') {
                continue;
            }
            match placeholder(&source[at..], &find) {
                Ok((expression, format, length)) => {
                    parts.push(Piece::Plain(source[plain..open].to_owned()));
                    parts.push(Piece::Number(expression, format));
                    at += length;
                    plain = at;
                }
                Err((key, rule)) => {
                    let lines = source[..open].matches('\n').count();
                    problems.push(on_line(line + lines, Problem::at(key, rule)));
                    if problems.len() == MOST_TEXT_PROBLEMS {
                        break;
                    }
                }
            }
        }
        parts.push(Piece::Plain(source[plain..].to_owned()));
        parts.retain(|part| !matches!(part, Piece::Plain(text) if text.is_empty()));
        if !problems.is_empty() {
            return Err(problems);
        }
        Ok(Self { line, parts })
    }

    /// Returns the text in Markdown, with the numbers of `lab` and the `kept` ones. Numbers that are not available
    /// become "n/a".
    pub fn with_numbers(&self, lab: &Lab, kept: &KeptNumbers) -> String {
        self.filled(|expression, format| format.written(value(expression, lab, kept)))
    }

    /// Returns the expressions of the placeholders, each with its line in the file.
    pub(super) fn numbers(&self) -> impl Iterator<Item = (usize, &Expression)> {
        let mut line = self.line;
        self.parts.iter().filter_map(move |part| match part {
            Piece::Plain(text) => {
                line += text.matches('\n').count();
                None
            }
            Piece::Number(expression, _) => Some((line, expression)),
        })
    }

    /// Returns the text in Markdown, with each placeholder replaced by the result of `written`.
    pub fn filled(&self, mut written: impl FnMut(&Expression, TextFormat) -> String) -> String {
        let pieces = self.parts.iter();
        pieces
            .map(|piece| match piece {
                Piece::Plain(text) => text.clone(),
                Piece::Number(expression, format) => written(expression, *format),
            })
            .collect()
    }
}

/// Parses a placeholder. `text` begins after its brace. Returns the expression, the format, and the length including
/// the closing brace.
///
/// # Errors
///
/// Returns the placeholder's text and the problem.
fn placeholder(
    text: &str,
    find: &impl Fn(&str) -> Result<(), String>,
) -> Result<(Expression, TextFormat, usize), (String, String)> {
    // If the line ends or another placeholder begins first, the closing brace is missing.
    let first = text.find(['\n', '{', '}']);
    let Some(end) = first.filter(|&end| text[end..].starts_with('}')) else {
        let rule = "is not closed by } on its line: write a literal brace as \\{";
        let begin = brief(&text[..first.unwrap_or(text.len())], 40);
        return Err((format!("{{{}", begin.trim_end()), rule.to_owned()));
    };
    let inside = &text[..end];
    match placeholder_content(inside, find) {
        Ok((expression, format)) => Ok((expression, format, end + 1)),
        Err(rule) => Err((format!("{{{inside}}}"), rule)),
    }
}

/// Parses the content of a placeholder, without its braces.
fn placeholder_content(
    text: &str,
    find: &impl Fn(&str) -> Result<(), String>,
) -> Result<(Expression, TextFormat), String> {
    let (written, format) = match text.split_once(':') {
        Some((written, format)) => (written, TextFormat::read(format.trim())?),
        None => (text, TextFormat::Short),
    };
    let expression = Expression::parse(written.trim()).map_err(|fault| fault.to_string())?;
    expression.bind(find).map_err(|fault| fault.to_string())?;
    if expression.is_condition() {
        return Err("is a comparison: write a number".to_owned());
    }
    Ok((expression, format))
}

fn code_in(source: &str) -> Vec<Range<usize>> {
    let events = Parser::new(source).into_offset_iter();
    events
        .filter_map(|(event, range)| match event {
            Event::Code(_) | Event::Start(Tag::CodeBlock(_)) => Some(range),
            _ => None,
        })
        .collect()
}
