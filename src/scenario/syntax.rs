//! Where the keys of a file stand in its text, and what is wrong with a text that is no TOML.

use super::problem::{Problem, at_line};
use crate::text::printable::{brief, printable_lines};
use toml::de::{DeTable, DeValue};

/// What is wrong with `text`, which is no TOML, and where.
pub(super) fn syntax_problem(text: &str, error: &toml::de::Error) -> Problem {
    const WIDEST: usize = 160;
    let picture = error.to_string();
    let mut lines = picture.trim_end().lines();
    let rule = if lines.clone().all(|line| line.len() <= WIDEST) {
        printable_lines(picture.trim_end()).into_owned()
    } else {
        // A picture of a line that fills the screen shows nothing.
        let place = brief(lines.next().unwrap_or_default(), WIDEST);
        format!("{place}: {}", brief(error.message(), WIDEST))
    };
    let rule = match error.span() {
        Some(span) => repeated_table(text, span.start).unwrap_or(rule),
        None => format!("cannot be read as TOML: {rule}"),
    };
    let problem = Problem::at("", rule);
    match error.span() {
        Some(span) => at_line(line_at(text, span.start) as u64, problem),
        None => problem,
    }
}

/// The tables of which a file may have several.
const REPEATED: [&str; 6] = ["do", "push", "edit", "expected", "body.point", "body.part"];

/// What is wrong with the line at `offset`, where it begins one of these tables a second time as if it were the only one.
fn repeated_table(text: &str, offset: usize) -> Option<String> {
    let line = text.lines().nth(line_at(text, offset) - 1)?.trim();
    let name = line.strip_prefix('[')?.strip_suffix(']')?.trim();
    REPEATED.contains(&name).then(|| {
        format!("[{name}] stands here again: write [[{name}]], in two brackets, for each of them")
    })
}

fn line_at(text: &str, offset: usize) -> usize {
    text.as_bytes()[..offset.min(text.len())]
        .iter()
        .filter(|&&byte| byte == b'\n')
        .count()
        + 1
}

/// Where the dotted `key`, or as much of it as there is, stands in the text: a value's key, a table's head.
pub(super) fn offset_of(table: &DeTable<'_>, key: &str) -> Option<usize> {
    let entry = |name: &str| table.get_key_value(name);
    let quoted = key.strip_prefix('"').and_then(|key| key.strip_suffix('"'));
    let (name, rest) = match quoted {
        Some(name) => (name, ""),
        None => key.split_once('.').unwrap_or((key, "")),
    };
    // What an edit sets has the whole path for its name.
    let (found, value) = entry(name).or_else(|| entry(key))?;
    Some(offset_inside(value.get_ref(), rest).unwrap_or(found.span().start))
}

fn offset_inside(value: &DeValue<'_>, key: &str) -> Option<usize> {
    match value {
        DeValue::Table(table) => offset_of(table, key),
        DeValue::Array(array) => {
            let (place, rest) = key.split_once('.').unwrap_or((key, ""));
            let item = array.get(place.parse::<usize>().ok()?)?;
            Some(offset_inside(item.get_ref(), rest).unwrap_or(item.span().start))
        }
        _ => None,
    }
}

/// What is wrong with `value`, which begins as an array or a table and is no TOML.
pub(super) fn mistake(value: &str, error: &toml::de::Error) -> Option<String> {
    if !value.starts_with(['[', '{']) {
        return None;
    }
    let from = error.span().map_or(0, |span| span.start);
    let rest = value.get(from..).unwrap_or_default();
    let rest = if rest.is_empty() {
        "its end".to_owned()
    } else {
        format!("\"{}\"", brief(rest, 24))
    };
    let message = brief(error.message(), 120);
    Some(format!("is no TOML: at {rest}: {message}"))
}
