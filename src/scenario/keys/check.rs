//! Checks files against the table of keys.

use super::{KEYS, Key};
use crate::scenario::dotted::join;
use crate::scenario::problem::{Found, Problem, nearest};
use std::collections::HashMap;
use std::sync::LazyLock;
use toml::Value;

/// Tables that a file must have.
const REQUIRED_TABLES: [&str; 2] = ["start", "motion"];

/// Checks the whole `table`: unknown names, wrong types, numbers out of range, missing keys.
pub fn check(table: &toml::Table) -> Found {
    let mut problems = Found::default();
    check_table(table, "", "", &mut problems);
    problems
}

/// Checks `value`, a part of a file: the table at the dotted `path`.
pub(in crate::scenario) fn check_part(value: &Value, path: &str) -> Vec<Problem> {
    let mut problems = Found::default();
    let is_place = |name: &str| name.parse::<usize>().is_ok();
    let names = path
        .split('.')
        .map(|name| if is_place(name) { "*" } else { name });
    let pattern = names.collect::<Vec<_>>().join(".");
    match value {
        Value::Table(table) => check_table(table, &pattern, path, &mut problems),
        other => problems.add(|| Problem::with_value(path, other, "must be a table")),
    }
    problems.list
}

/// Checks `table`, whose keys begin with the pattern `under`, and which stands at `path` in the file.
fn check_table(table: &toml::Table, under: &str, path: &str, problems: &mut Found) {
    let nothing = Level::default();
    let level = LEVELS.get(under).unwrap_or(&nothing);
    for (name, value) in table {
        let key = join(path, name);
        if !level.names.contains(&name.as_str()) {
            problems.add(|| {
                let near =
                    elsewhere(name).unwrap_or_else(|| nearest(name, level.names.iter().copied()));
                // In quotes, or a dot in the name would make it the path of another key.
                let key = if name.contains('.') {
                    join(path, &format!("\"{name}\""))
                } else {
                    key
                };
                Problem::at(key, format!("unknown key: {near}"))
            });
        } else {
            check_value(value, &join(under, name), &key, problems);
        }
    }
    let is_there = |name: &&str| table.contains_key(*name);
    for (missing, key) in &level.required {
        let is_replaced = key.is_some_and(|key| key.instead.iter().any(is_there));
        if is_there(missing) || is_replaced {
            continue;
        }
        problems.add(|| {
            let rule = match key {
                Some(key) => format!("is missing ({})", key.about),
                None => format!(
                    "is missing: add a table [{missing}], at the end of the file for instance; gyrolab keys lists what it holds"
                ),
            };
            Problem::at(join(path, missing), rule)
        });
    }
}

/// Where a name belongs that stands in the wrong table.
fn elsewhere(name: &str) -> Option<String> {
    let mut homes = KEYS
        .iter()
        .filter(|key| key.path.rsplit('.').next() == Some(name) && key.path != name);
    match (homes.next(), homes.next()) {
        (Some(home), None) if !home.path.contains('*') => {
            Some(format!("did you mean {}?", home.path))
        }
        _ => None,
    }
}

fn check_value(value: &Value, pattern: &str, path: &str, problems: &mut Found) {
    if let Some(key) = KEYS.iter().find(|key| key.path == pattern) {
        if let Err(rule) = key.kind.check(value) {
            problems.add(|| Problem::with_value(path, value, rule));
        }
        return;
    }
    let element = format!("{pattern}.*");
    match value {
        Value::Array(items) if is_known(&element) => {
            for (index, item) in items.iter().enumerate() {
                let path = join(path, &index.to_string());
                match item {
                    Value::Table(table) => check_table(table, &element, &path, problems),
                    other => problems.add(|| Problem::with_value(path, other, "must be a table")),
                }
            }
        }
        Value::Table(table) if !is_known(&element) => check_table(table, pattern, path, problems),
        other if is_known(&element) => {
            let rule = format!("must be an array of tables: write [[{pattern}]]");
            problems.add(|| Problem::with_value(path, other, rule));
        }
        other => {
            let rule = format!("must be a table: write [{pattern}]");
            problems.add(|| Problem::with_value(path, other, rule));
        }
    }
}

/// Whether `pattern` is a key, or a table that holds some.
fn is_known(pattern: &str) -> bool {
    KEYS.iter()
        .any(|key| key.path == pattern || is_under(key.path, pattern))
}

pub(in crate::scenario) fn is_under(path: &str, table: &str) -> bool {
    path.strip_prefix(table)
        .is_some_and(|rest| rest.starts_with('.'))
}

/// What may stand in the tables of one pattern, and what must.
#[derive(Debug, Default)]
struct Level {
    /// The names, each once.
    names: Vec<&'static str>,
    /// Those without which the table is incomplete; a key's row, of a table none.
    required: Vec<(&'static str, Option<&'static Key>)>,
}

/// Every pattern of a table, such as `body.point.*`, and what it holds: looked up for each table of a file.
static LEVELS: LazyLock<HashMap<String, Level>> = LazyLock::new(|| {
    let mut levels: HashMap<String, Level> = HashMap::new();
    for key in KEYS {
        let mut under = String::new();
        for name in key.path.split('.') {
            let path = join(&under, name);
            let level = levels.entry(under).or_default();
            if name != "*" && !level.names.contains(&name) {
                level.names.push(name);
                if REQUIRED_TABLES.contains(&path.as_str()) {
                    level.required.push((name, None));
                } else if key.path == path && key.required {
                    level.required.push((name, Some(key)));
                }
            }
            under = path;
        }
    }
    levels
});

#[cfg(test)]
mod tests {
    use super::*;

    fn problems(text: &str) -> Vec<String> {
        check(&text.parse().unwrap())
            .list
            .iter()
            .map(ToString::to_string)
            .collect()
    }

    const WHOLE: &str =
        "title = 'x'\n[start]\nmomentum_Js = [0, 0, 1]\n[motion]\ntime_step_s = 0.1\nsteps = 3\n";

    #[test]
    fn a_whole_file_passes() {
        assert_eq!(problems(WHOLE), Vec::<String>::new());
    }

    #[test]
    fn every_table_and_key_that_is_missing_is_named() {
        let found = problems("[motion]\nsteps = 3\n").join("\n");
        for name in [
            "title: is missing",
            "start: is missing",
            "motion.time_step_s: is missing",
        ] {
            assert!(found.contains(name), "{found}");
        }
    }

    #[test]
    fn a_dot_in_a_quoted_name_is_no_path() {
        let found = problems(&format!("'motion.steps' = 3\n{WHOLE}"));
        assert_eq!(found.len(), 1, "{found:?}");
        assert!(found[0].contains("unknown key"), "{found:?}");
    }
}
