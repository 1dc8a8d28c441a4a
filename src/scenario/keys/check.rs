//! Checks files against the table of keys.

use super::{KEYS, Key, is_table, only, pattern};
use crate::scenario::dotted::join;
use crate::scenario::problem::{Problem, Problems, nearest};
use toml::Value;

/// Tables that a file must have.
const REQUIRED_TABLES: [&str; 2] = ["start", "motion"];

/// Checks the whole `table`: unknown names, wrong types, numbers out of range, missing keys.
pub fn check(table: &toml::Table) -> Problems {
    let mut problems = Problems::default();
    check_table(table, "", "", &mut problems);
    problems
}

/// Checks `value`, a part of a file: the key or table at the dotted `path`.
pub fn check_part(value: &Value, path: &str) -> Problems {
    let mut problems = Problems::default();
    let pattern = pattern(path);
    let is_key = KEYS.iter().any(|key| key.path == pattern);
    match value {
        _ if is_key => check_value(value, &pattern, path, &mut problems),
        Value::Table(table) => check_table(table, &pattern, path, &mut problems),
        other => problems.add(|| {
            let rule = format!("must be a table of {}", names(&pattern).join(", "));
            Problem::with_value(path, other, rule)
        }),
    }
    problems
}

/// Checks `table`, whose keys begin with the pattern `under`, and which stands at `path` in the file.
fn check_table(table: &toml::Table, under: &str, path: &str, problems: &mut Problems) {
    let names = names(under);
    for (name, value) in table {
        let key = join(path, name);
        if !names.contains(&name.as_str()) {
            problems.add(|| {
                // It may belong into another table.
                let home = only(|last| last == name).filter(|home| home != name);
                let near = match home {
                    Some(home) => format!("did you mean {home}?"),
                    None => nearest(name, names.iter().copied()),
                };
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
    check_missing(table, under, path, problems);
}

/// Finds the keys and tables that `table` lacks.
fn check_missing(table: &toml::Table, under: &str, path: &str, problems: &mut Problems) {
    let is_there = |name: &&str| table.contains_key(*name);
    for (name, key) in below(under).filter(|(_, key)| key.required) {
        if name.contains('.') || is_there(&name) || key.instead.iter().any(is_there) {
            continue;
        }
        let rule = format!("is missing ({})", key.about);
        problems.add(|| Problem::at(join(path, name), rule));
    }
    for name in REQUIRED_TABLES {
        if under.is_empty() && !is_there(&name) {
            let rule = format!(
                "is missing: add a table [{name}], at the end of the file for instance; gyrolab keys lists what it holds"
            );
            problems.add(|| Problem::at(name, rule));
        }
    }
}

fn check_value(value: &Value, pattern: &str, path: &str, problems: &mut Problems) {
    if let Some(key) = KEYS.iter().find(|key| key.path == pattern) {
        if let Err(rule) = key.kind.check(value) {
            problems.add(|| Problem::with_value(path, value, rule));
        }
        return;
    }
    let element = format!("{pattern}.*");
    let is_list = is_table(&element);
    match value {
        Value::Array(items) if is_list => {
            for (index, item) in items.iter().enumerate() {
                let path = join(path, &index.to_string());
                match item {
                    Value::Table(table) => check_table(table, &element, &path, problems),
                    other => problems.add(|| Problem::with_value(path, other, "must be a table")),
                }
            }
        }
        Value::Table(table) if !is_list => check_table(table, pattern, path, problems),
        other => problems.add(|| {
            let rule = if is_list {
                format!("must be an array of tables: write [[{pattern}]]")
            } else {
                format!("must be a table: write [{pattern}]")
            };
            Problem::with_value(path, other, rule)
        }),
    }
}

/// The names that may stand in the tables of the pattern `under`, each once.
fn names(under: &str) -> Vec<&'static str> {
    let mut names: Vec<_> = below(under)
        .filter_map(|(rest, _)| rest.split('.').next())
        .filter(|name| *name != "*")
        .collect();
    names.dedup();
    names
}

/// The keys below the pattern `under`, and what their paths have after it.
fn below(under: &str) -> impl Iterator<Item = (&'static str, &'static Key)> {
    let under = if under.is_empty() {
        String::new()
    } else {
        format!("{under}.")
    };
    KEYS.iter()
        .filter_map(move |key| Some((key.path.strip_prefix(&under)?, key)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_dot_in_a_quoted_name_is_no_path() {
        let text = "title = 'x'\n'motion.steps' = 3\n[start]\nmomentum_Js = [0, 0, 1]\n[motion]\n\
                    time_step_s = 0.1\nsteps = 3\n";
        let found = check(&text.parse().unwrap()).list;
        assert_eq!(found.len(), 1, "{found:?}");
        assert!(found[0].rule.contains("unknown key"), "{found:?}");
    }
}
