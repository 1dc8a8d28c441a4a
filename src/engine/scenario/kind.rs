//! Kinds of values that a key may have, and the rules for them.

use super::problem::near;
use super::screen;
use crate::text::printable::is_steering;
use Range::{NotNegative, Positive, Within};
use ValueKind::{
    By, Flag, Line, Lines, Number, OneOf, Pane, Panes, Paragraph, Settings, Text, Vector, Whole,
    WholeOr,
};
use nalgebra::Vector3;
use toml::Value;

pub const LONGEST_TEXT_LINE: usize = 1000;

pub const LONGEST_PARAGRAPH: usize = 20_000;

/// Kind of value that a key may have.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(
    unpredictable_function_pointer_comparisons,
    reason = "kinds with a check of their own are not compared"
)]
pub enum ValueKind {
    /// Text on one line, not empty.
    Line,
    /// Text that may have several lines.
    Paragraph,
    Number(Range),
    /// A whole number between a minimum and a maximum.
    Whole(i64, i64),
    /// A whole number from 1 to a maximum, or one of these words.
    WholeOr(i64, &'static [&'static str]),
    Vector,
    Flag,
    OneOf(&'static [&'static str]),
    /// The id of a pane, or one of these words.
    Pane(&'static [&'static str]),
    /// A list of pane ids and these words.
    Panes(&'static [&'static str]),
    /// A table of dotted keys and their new values.
    Settings,
    /// A list of names, each one line.
    Lines,
    /// Text on one line that passes this check.
    Text(fn(&str) -> Result<(), String>),
    /// Any value that passes this check.
    By(fn(&Value) -> Result<(), String>),
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Range {
    Any,
    Positive,
    NotNegative,
    Within((f64, f64)),
}

pub const ZOOM_RANGE: (f64, f64) = (0.5, 100.0);
/// Minimum and maximum height of the eye above the horizontal, degrees.
pub const PITCH_DEG: (f64, f64) = (-90.0, 90.0);

impl ValueKind {
    /// Checks that `value` is of this kind and in its range.
    pub fn check(self, value: &Value) -> Result<(), String> {
        match self {
            Line => text(value).and_then(check_line),
            Paragraph => text(value).and_then(|text| check_text(text, LONGEST_PARAGRAPH, "\n")),
            Number(range) => number(value).and_then(|number| range.check(number)),
            Whole(least, most) => check_whole(value, least, most),
            WholeOr(most, words) => match value {
                Value::String(word) => check_word(word, words)
                    .map_err(|rule| format!("{rule}, or a whole number from 1 to {most}")),
                _ => check_whole(value, 1, most),
            },
            Vector => check_vector(value),
            Flag => is(value.is_bool(), "true or false", value),
            OneOf(_) | Pane(_) => text(value).and_then(|text| check_word(text, &self.words())),
            Panes(_) => check_words(value, &self.words()),
            Settings => is(value.is_table(), "a table of keys and values", value),
            Lines => items(value, "a list of names in brackets")
                .and_then(|items| check_each(items, |item| Line.check(item))),
            Text(check) => text(value).and_then(|text| check_line(text).and_then(|()| check(text))),
            By(check) => check(value),
        }
    }
}

impl ValueKind {
    /// Returns the words that are values of this kind.
    pub fn words(self) -> Vec<&'static str> {
        match self {
            OneOf(words) | WholeOr(_, words) => words.to_vec(),
            Pane(others) | Panes(others) => {
                let panes = screen::Pane::ALL.into_iter().map(screen::Pane::id);
                panes.chain(others.iter().copied()).collect()
            }
            Flag => vec!["true", "false"],
            _ => Vec::new(),
        }
    }
}

impl Range {
    fn check(self, number: f64) -> Result<(), String> {
        match self {
            Positive if number <= 0.0 => Err("must be greater than zero".to_owned()),
            NotNegative if number < 0.0 => Err("must not be negative".to_owned()),
            Within((least, most)) if number < least || number > most => {
                Err(format!("must be from {least} to {most}"))
            }
            _ => Ok(()),
        }
    }
}

fn not(wanted: &str, value: &Value) -> String {
    let found = match value {
        Value::String(_) => "text",
        Value::Float(number) if !number.is_finite() => {
            return format!("must be {wanted}, and {number} is not finite");
        }
        Value::Integer(_) | Value::Float(_) => "a number",
        Value::Boolean(_) => "true or false",
        Value::Datetime(_) => "a date",
        Value::Array(_) => "an array",
        Value::Table(_) => "a table",
    };
    format!("must be {wanted}, not {found}")
}

fn is(wanted: bool, what: &str, value: &Value) -> Result<(), String> {
    wanted.then_some(()).ok_or_else(|| not(what, value))
}

fn text(value: &Value) -> Result<&str, String> {
    value.as_str().ok_or_else(|| not("text", value))
}

pub fn float(value: &Value) -> Option<f64> {
    match value {
        Value::Float(number) => Some(*number),
        Value::Integer(whole) => Some(*whole as f64),
        _ => None,
    }
}

fn number(value: &Value) -> Result<f64, String> {
    match float(value).ok_or_else(|| not("a number", value))? {
        number if number.is_finite() => Ok(number),
        _ => Err("must be a finite number".to_owned()),
    }
}

fn check_line(text: &str) -> Result<(), String> {
    if text.trim().is_empty() {
        return Err("must not be empty".to_owned());
    }
    check_text(text, LONGEST_TEXT_LINE, "")
}

fn check_text(text: &str, most: usize, allowed: &str) -> Result<(), String> {
    let length = text.chars().count();
    if length > most {
        return Err(format!(
            "must be at most {most} characters long, not {length}"
        ));
    }
    let mut steering = text
        .chars()
        .filter(|&c| is_steering(c) && !allowed.contains(c));
    steering.next().map_or(Ok(()), |c| {
        let code = c as u32;
        Err(format!(
            "must not contain control, direction or invisible characters (here U+{code:04X})"
        ))
    })
}

fn check_whole(value: &Value, least: i64, most: i64) -> Result<(), String> {
    let whole = value.as_integer().ok_or_else(|| match value {
        Value::Float(_) => "must be a whole number".to_owned(),
        other => not("a whole number", other),
    })?;
    if whole < least {
        return Err(format!("must be {least} or more"));
    }
    if whole > most {
        return Err(format!("must be at most {most}"));
    }
    Ok(())
}

fn check_vector(value: &Value) -> Result<(), String> {
    let numbers = items(value, "three numbers in brackets")?;
    if numbers.len() != 3 {
        return Err(format!("must be three numbers, not {}", numbers.len()));
    }
    check_each(numbers, |item| number(item).map(drop))
}

/// Checks the two ends of an axis, or the word for ends that follow the data.
pub(super) fn check_range(value: &Value) -> Result<(), String> {
    let wanted = "two numbers in brackets, the lower one first, or \"auto\"";
    if value.as_str() == Some(screen::AUTO) {
        return Ok(());
    }
    let numbers: Option<Vec<_>> = items(value, wanted)?.iter().map(float).collect();
    match numbers.as_deref() {
        Some([low, high]) if low < high && (high - low).is_finite() => Ok(()),
        _ => Err(format!("must be {wanted}")),
    }
}

fn check_words(value: &Value, words: &[&str]) -> Result<(), String> {
    check_each(items(value, "a list in brackets")?, |item| {
        check_word(text(item)?, words)
    })
}

fn items<'a>(value: &'a Value, wanted: &str) -> Result<&'a Vec<Value>, String> {
    value.as_array().ok_or_else(|| not(wanted, value))
}

fn check_each(items: &[Value], check: impl Fn(&Value) -> Result<(), String>) -> Result<(), String> {
    items
        .iter()
        .try_for_each(|item| check(item).map_err(|rule| format!("each {rule}")))
}

fn check_word(word: &str, words: &[&str]) -> Result<(), String> {
    if words.contains(&word) {
        return Ok(());
    }
    let one_of = if words.len() > 1 { "one of " } else { "" };
    let rule = format!("must be {one_of}{}", words.join(", "));
    Err(match near(word, words.iter().copied()) {
        Some(near) => format!("{rule}; did you mean {near}?"),
        None => rule,
    })
}

/// Returns `vector` as the value of a key.
pub fn vector(vector: &Vector3<f64>) -> Value {
    Value::Array(vector.iter().map(|&number| Value::Float(number)).collect())
}
