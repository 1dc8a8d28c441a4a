//! Text in Markdown with places for numbers: `{z_m:.3}`.
//!
//! A place holds an expression and, after a colon, how its value is written: `.3` with three decimals, `.2e` with an
//! exponent. Without that it has four significant digits. A brace that is meant as one is written `\{`, as Markdown has it;
//! in code, braces are braces.

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
/// The most digits after the point.
const MOST_DECIMALS: usize = 12;
const MOST_TEXT_PROBLEMS: usize = 100;

#[derive(Clone, Debug, Default, PartialEq)]
pub struct LessonText {
    /// The line at which it begins in the file, from 1.
    pub line: usize,
    parts: Vec<Piece>,
}

#[derive(Clone, Debug, PartialEq)]
pub enum Piece {
    Plain(String),
    Number(Expression, TextFormat),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TextFormat {
    /// With four significant digits.
    Short,
    /// Digits after the point.
    Fixed(usize),
    /// With an exponent; digits after the point.
    Exponent(usize),
}

impl TextFormat {
    /// `number` as it is written; "n/a" where there is none.
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
                "{text} is no way to write a number: there is .3 for three decimals, and .2e with an exponent"
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
    /// Reads `source`, which begins at `line`. `find` says why a name in it stands for no number.
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
            match place(&source[at..], &find) {
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

    /// Returns the text in Markdown, with the numbers of `lab` and those that were `kept`; "n/a" stands for a number that
    /// there is not.
    pub fn with_numbers(&self, lab: &Lab, kept: &KeptNumbers) -> String {
        self.filled(|expression, format| format.written(value(expression, lab, kept)))
    }

    /// Returns the places for numbers, each with its line in the file.
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

    /// Returns the text in Markdown, with what `written` makes of each place for a number.
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

/// What stands in a place for a number, of which `text` is what follows the brace; and how long it is, with the brace that
/// ends it. An error is the place as it is written, and what is wrong with it.
fn place(
    text: &str,
    find: &impl Fn(&str) -> Result<(), String>,
) -> Result<(Expression, TextFormat, usize), (String, String)> {
    // Where the line ends or another place begins first, this one has lost its end.
    let first = text.find(['\n', '{', '}']);
    let Some(end) = first.filter(|&end| text[end..].starts_with('}')) else {
        let rule = "is not closed in its line by }: a brace that is meant as one is written \\{";
        let begin = brief(&text[..first.unwrap_or(text.len())], 40);
        return Err((format!("{{{}", begin.trim_end()), rule.to_owned()));
    };
    let inside = &text[..end];
    match number_in(inside, find) {
        Ok((expression, format)) => Ok((expression, format, end + 1)),
        Err(rule) => Err((format!("{{{inside}}}"), rule)),
    }
}

/// Reads the place `text`, without its braces.
fn number_in(
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
        return Err("compares: a number must stand here".to_owned());
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
