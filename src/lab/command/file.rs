//! Reads a file of commands: a list of `[[do]]` tables with one command each.

use super::{COMMANDS, Command, CommandRow, RERUN, SET};
use crate::engine::scenario::problem::nearest;
use crate::engine::scenario::schema::quoted;
use crate::engine::scenario::{Document, Problem, Problems};
use std::path::Path;
use toml::Value;

#[derive(Clone, Debug, PartialEq)]
pub struct LocatedCommand {
    pub command: Command,
    /// The line of the command in its file, from 1; `None` if unknown.
    pub line: Option<usize>,
}

#[derive(Clone, Debug, Default, PartialEq)]
pub struct Commands {
    /// The file, as the user named it.
    pub origin: String,
    pub list: Vec<LocatedCommand>,
}

/// Returns true if `document` contains `[[do]]`, which makes it a file of commands.
pub fn is_file_of_commands(document: &Document) -> bool {
    document.table().contains_key("do")
}

/// Reads the file of commands at `path`, or standard input if `path` is `-`.
pub fn open(path: &Path) -> Result<Commands, Problems> {
    read(&if path == Path::new("-") {
        Document::read_from("standard input", std::io::stdin().lock())?
    } else {
        Document::read(path)?
    })
}

pub fn read(document: &Document) -> Result<Commands, Problems> {
    let mut problems = Problems::default();
    let mut list = Vec::new();
    for name in document.table().keys().filter(|name| *name != "do") {
        let rule = "unknown key: a file of commands contains only [[do]] tables";
        problems.add(|| Problem::at(name, rule));
    }
    match document.table().get("do") {
        Some(Value::Array(tables)) => {
            let places: Vec<_> = (0..tables.len())
                .map(|index| format!("do.{index}"))
                .collect();
            let lines = document.lines_of(places.iter().cloned());
            for ((place, value), line) in places.iter().zip(tables).zip(lines) {
                let read = parse_command(value).map_err(|found| found.inside(place));
                let command = problems.kept(read);
                list.extend(command.map(|command| LocatedCommand { command, line }));
            }
        }
        Some(other) => problems.add(|| {
            let rule = "must be an array of tables: write [[do]]";
            Problem::with_value("do", other, rule)
        }),
        None => problems.add(|| {
            let rule = "contains no command: write a [[do]] table for each";
            Problem::at("", rule)
        }),
    }
    let origin = document.origin().to_owned();
    let commands = problems.or(Commands { origin, list });
    commands.map_err(|found| document.placed(found))
}

/// Parses the command in `value`, a `[[do]]` table.
fn parse_command(value: &Value) -> Result<Command, Problems> {
    let Value::Table(table) = value else {
        return Err(Problem::with_value("", value, "must be a table").into());
    };
    let beside = COMMANDS.iter().find(|row| table.contains_key(row.name));
    let mut unknown_names = Problems::default();
    for name in table.keys() {
        let is_known = COMMANDS.iter().any(|row| row.name == name);
        let is_rerun = name == RERUN && table.contains_key(SET);
        if !is_known && !is_rerun {
            unknown_names.add(|| unknown(name, beside));
        }
    }
    unknown_names.or(())?;
    let commands = table.iter().filter(|(name, _)| *name != RERUN);
    match commands.collect::<Vec<_>>()[..] {
        [(name, argument)] => Command::new(name, argument)?.with_rerun(table.get(RERUN)),
        [] => {
            let rule = "contains no command: gyrolab man lists their names";
            Err(Problem::at("", rule).into())
        }
        _ => {
            let names = table
                .keys()
                .map(String::as_str)
                .collect::<Vec<_>>()
                .join(", ");
            let rule = format!("contains {names}: write each command in its own [[do]]");
            Err(Problem::at("", rule).into())
        }
    }
}

/// Returns the problem that the command `name` is unknown. `beside` is another command in the same table: `name` may
/// belong in its value.
pub(super) fn unknown(name: &str, beside: Option<&CommandRow>) -> Problem {
    let near = match beside {
        Some(row) => format!(
            "values for {} go inside its own value: {}",
            row.name, row.value
        ),
        None => nearest(name, COMMANDS.iter().map(|row| row.name)),
    };
    Problem::at(quoted(name), format!("unknown command: {near}"))
}
