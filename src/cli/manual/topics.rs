//! The topics of the manual, plain text. The name of a table in braces is replaced by the table.

use super::WIDTH;
use crate::cli::info;
use crate::export::columns::{COLUMNS, OPTIONAL_COLUMNS, POINT_COLUMNS};
use crate::text::wrap::{columns, wrapped};
use clap::Command;
use std::fmt;

/// Name, and text.
const TOPICS: &[(&str, &str)] = &[
    ("class", include_str!("../topics/class.txt")),
    ("csv", include_str!("../topics/csv.txt")),
    ("fit", include_str!("../topics/fit.txt")),
    ("friction", include_str!("../topics/friction.txt")),
    ("lab", include_str!("../topics/lab.txt")),
    ("numbers", include_str!("../topics/numbers.txt")),
    ("own-code", include_str!("../topics/own-code.txt")),
    ("scenario", include_str!("../topics/scenario.txt")),
    ("schemes", include_str!("../topics/schemes.txt")),
    ("sweep", include_str!("../topics/sweep.txt")),
];

/// The names of the topics.
pub(super) fn names() -> impl Iterator<Item = &'static str> + Clone {
    TOPICS.iter().map(|(name, _)| *name)
}

/// The topics, and the commands of `gyrolab` that are none.
pub(in crate::cli) fn names_and_commands(gyrolab: &Command) -> Vec<String> {
    let commands = commands(gyrolab).map(|command| command.get_name().to_owned());
    let commands = commands.filter(|name| names().all(|topic| topic != name));
    names().map(str::to_owned).chain(commands).collect()
}

/// The commands of `gyrolab` that have a page.
pub(super) fn commands(gyrolab: &Command) -> impl Iterator<Item = &Command> {
    let commands = gyrolab.get_subcommands();
    commands.filter(|command| !command.is_hide_set() && command.get_name() != "help")
}

/// The text of the topic `name`, if there is one.
pub(super) fn text(name: &str) -> Result<Option<String>, fmt::Error> {
    let Some((_, text)) = TOPICS.iter().find(|(topic, _)| *topic == name) else {
        return Ok(None);
    };
    let mut text = (*text).to_owned();
    for (place, table) in TABLES {
        if text.contains(place) {
            text = text.replace(place, &in_width(table()?.trim_end()));
        }
    }
    Ok(Some(text))
}

/// The lines of a table. A line that is too long goes on below the beginning of its last column.
fn in_width(table: &str) -> String {
    let lines = table.lines().map(|line| {
        if columns(line) <= WIDTH {
            return line.to_owned();
        }
        let indent = line.len() - line.trim_start().len();
        let text = line.rfind("  ").map_or(indent, |gap| gap + 2);
        let (begin, text) = line.split_at(text);
        let hanging = columns(begin);
        let text = wrapped(text, WIDTH - hanging);
        begin.to_owned() + &text.join(&format!("\n{}", " ".repeat(hanging)))
    });
    lines.collect::<Vec<_>>().join("\n")
}

/// The name of a table in a topic, and what is written in its place.
type Table = (&'static str, fn() -> Result<String, fmt::Error>);

const TABLES: [Table; 6] = [
    ("{COLUMNS}", || Ok(list(COLUMNS, |it| (it.name, it.about)))),
    ("{COLUMNS ON REQUEST}", || {
        Ok(list(OPTIONAL_COLUMNS, |it| (it.name, it.about)))
    }),
    ("{COLUMNS OF POINTS}", || {
        Ok(list(POINT_COLUMNS, |it| (it.name, it.about)))
    }),
    ("{KEYS}", info::key_list),
    ("{READOUTS}", info::readout_list),
    ("{SCHEMES}", info::scheme_list),
];

/// Two columns of text.
fn list<T>(rows: &[T], row: fn(&T) -> (&'static str, &'static str)) -> String {
    let rows = rows.iter().map(row);
    rows.map(|(name, about)| format!("  {name:<14} {about}\n"))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_topic_fits_a_terminal_of_80_columns() {
        for (name, _) in TOPICS {
            let text = text(name).unwrap().unwrap();
            let long = text.lines().find(|line| columns(line) > WIDTH);
            assert_eq!(long, None, "{name}");
        }
    }
}
