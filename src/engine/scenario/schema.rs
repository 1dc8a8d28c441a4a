//! Schema of a TOML table: a row for each key, and the check of a table against its rows.
//!
//! Scenario files, commands, sweeps, lesson blocks and settings each have their own rows, but share this check. The
//! same mistake therefore gets the same message everywhere. Rules for several values are checked where the values are
//! used.

use super::dotted::{is_in, join};
use super::kind::ValueKind;
use super::problem::{Problem, Problems, nearest};
use std::fmt;
use toml::{Table, Value};

/// A key of a table.
#[derive(Debug, PartialEq)]
pub struct SchemaRow {
    /// Dotted path, with `*` for any position in an array.
    pub path: &'static str,
    pub kind: ValueKind,
    /// Unit as the lab shows it; empty for a value without one.
    pub unit: &'static str,
    /// Value of an absent key, if it is always the same.
    pub default: Option<DefaultValue>,
    /// True if the table must have this key.
    pub required: bool,
    /// Names of keys in the same table that can replace this one. With any of them, it is not required.
    pub instead: &'static [&'static str],
    /// Meaning and unit, in one line.
    pub about: &'static str,
    /// Row in the lab's list of values, if any.
    pub lab: Option<LabValue>,
}

/// Label and nudge of a value in the lab.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LabValue {
    /// Short name. For a vector, the stem to which x, y or z is added.
    pub label: &'static str,
    pub nudge: Nudge,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Nudge {
    /// Adds this amount.
    By(f64),
    /// Adds the largest of 1, 2 and 5 times a power of ten that is not above a hundredth of the size (for a vector: of
    /// its norm). If the size is 0, it adds the given amount.
    Hundredth(f64),
    /// The same in whole numbers, at least 1.
    WholeHundredth,
    /// Goes to the next of ..., 1, 2, 5, 10, 20, ...
    Ladder,
    /// Goes to the next choice, and from the last to the first.
    Turn,
    /// Does nothing: the value must be typed.
    Typed,
}

/// Value of an absent key.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DefaultValue {
    Number(f64),
    Whole(i64),
    Flag(bool),
    Word(&'static str),
}

impl From<DefaultValue> for Value {
    fn from(default: DefaultValue) -> Self {
        match default {
            DefaultValue::Number(number) => number.into(),
            DefaultValue::Whole(number) => number.into(),
            DefaultValue::Flag(flag) => flag.into(),
            DefaultValue::Word(word) => word.into(),
        }
    }
}

impl fmt::Display for DefaultValue {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(number) => number.fmt(f),
            Self::Whole(number) => number.fmt(f),
            Self::Flag(flag) => flag.fmt(f),
            Self::Word(word) => word.fmt(f),
        }
    }
}

/// Returns the row of a key that its table must have.
pub const fn must(path: &'static str, kind: ValueKind, about: &'static str) -> SchemaRow {
    SchemaRow {
        required: true,
        ..may(path, kind, about)
    }
}

/// Returns the row of a key that its table may have.
pub const fn may(path: &'static str, kind: ValueKind, about: &'static str) -> SchemaRow {
    SchemaRow {
        path,
        kind,
        unit: "",
        default: None,
        required: false,
        instead: &[],
        about,
        lab: None,
    }
}

impl SchemaRow {
    pub(super) const fn lab(
        mut self,
        label: &'static str,
        unit: &'static str,
        nudge: Nudge,
    ) -> Self {
        self.unit = unit;
        self.lab = Some(LabValue { label, nudge });
        self
    }

    /// Makes the key optional if the table has one of `names`.
    pub(super) const fn unless(mut self, names: &'static [&'static str]) -> Self {
        self.instead = names;
        self
    }

    pub const fn or(mut self, default: DefaultValue) -> Self {
        self.default = Some(default);
        self
    }

    /// Returns meaning, unit and default, in one line.
    pub fn description(&self) -> String {
        match self.default {
            Some(default) => format!("{} (default: {default})", self.about),
            None => self.about.to_owned(),
        }
    }
}

/// Rows of a table and of the tables in it, in groups, in the order in which files are written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Schema(pub &'static [&'static [SchemaRow]]);

impl Schema {
    pub fn rows(self) -> impl Iterator<Item = &'static SchemaRow> + Clone {
        self.0.iter().copied().flatten()
    }

    /// Returns the row with this path.
    pub fn row(self, path: &str) -> Option<&'static SchemaRow> {
        self.rows().find(|row| row.path == path)
    }

    /// Checks the whole `table` for unknown names, wrong types, numbers out of range, and missing keys.
    pub fn check(self, table: &Table) -> Problems {
        let mut problems = Problems::default();
        self.check_table(table, "", "", &mut problems);
        problems
    }

    /// Checks `value`, which is at `path` in the file, as the key or table `under` of this schema.
    pub fn check_part(self, value: &Value, under: &str, path: &str) -> Problems {
        let mut problems = Problems::default();
        let place = pattern(under);
        match value {
            _ if self.row(&place).is_some() => {
                self.check_value(value, &place, path, &mut problems);
            }
            Value::Table(table) => self.check_table(table, &place, path, &mut problems),
            other => problems.add(|| {
                let rule = format!("must be a table of {}", self.names(&place).join(", "));
                Problem::with_value(path, other, rule)
            }),
        }
        problems
    }

    /// Checks `table`, which is at `path` in the file. The patterns of its keys begin with `under`.
    fn check_table(self, table: &Table, under: &str, path: &str, problems: &mut Problems) {
        let names = self.names(under);
        for (name, value) in table {
            if names.contains(&name.as_str()) {
                self.check_value(value, &join(under, name), &join(path, name), problems);
            } else {
                problems.add(|| self.unknown(name, &names, path));
            }
        }
        for (name, row) in self.below(under).filter(|(_, row)| row.required) {
            let mut alternatives = row.instead.iter().chain([&name]);
            if !name.contains('.') && !alternatives.any(|it| table.contains_key(*it)) {
                let rule = format!("is missing ({})", row.about);
                problems.add(|| Problem::at(join(path, name), rule));
            }
        }
    }

    /// Returns the problem that the table at `path`, with the keys `names`, has no key `name`.
    fn unknown(self, name: &str, names: &[&'static str], path: &str) -> Problem {
        // The key may belong to another table.
        let home = self.only(|last| last == name).filter(|home| *home != name);
        let near = match home {
            Some(home) => format!("did you mean {home}?"),
            None => nearest(name, names.iter().copied()),
        };
        Problem::at(join(path, &quoted(name)), format!("{UNKNOWN_KEY}: {near}"))
    }

    fn check_value(self, value: &Value, pattern: &str, path: &str, problems: &mut Problems) {
        if let Some(row) = self.row(pattern) {
            if let Err(rule) = row.kind.check(value) {
                problems.add(|| Problem::with_value(path, value, rule));
            }
            return;
        }
        let element = format!("{pattern}.*");
        let is_list = self.is_table(&element);
        match value {
            Value::Array(items) if is_list => {
                for (index, item) in items.iter().enumerate() {
                    let path = join(path, &index.to_string());
                    match item {
                        Value::Table(table) => self.check_table(table, &element, &path, problems),
                        other => {
                            problems.add(|| Problem::with_value(path, other, "must be a table"));
                        }
                    }
                }
            }
            Value::Table(table) if !is_list => self.check_table(table, pattern, path, problems),
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

    /// Returns true if the dotted `key` leads to a table of keys, or to an element of an array of tables.
    pub fn is_table(self, key: &str) -> bool {
        let table = pattern(key);
        self.rows()
            .any(|row| row.path != table && is_in(row.path, &table))
    }

    /// Returns the names of the keys that a table with the pattern `under` may have, each once.
    pub fn names(self, under: &str) -> Vec<&'static str> {
        let mut names: Vec<_> = self
            .below(under)
            .filter_map(|(rest, _)| rest.split('.').next())
            .filter(|name| *name != "*")
            .collect();
        names.dedup();
        names
    }

    /// Returns the rows below the pattern `under`, with the rest of their paths.
    fn below(self, under: &str) -> impl Iterator<Item = (&'static str, &'static SchemaRow)> {
        let begin = match under {
            "" => String::new(),
            under => format!("{under}."),
        };
        self.rows()
            .filter_map(move |row| Some((row.path.strip_prefix(&begin)?, row)))
    }

    /// Returns the path outside of arrays for whose last name `is_it` is true, if it is the only one.
    pub(super) fn only(self, is_it: impl Fn(&str) -> bool) -> Option<&'static str> {
        let mut found = self
            .rows()
            .map(|row| row.path)
            .filter(|path| path.rsplit('.').next().is_some_and(&is_it));
        let first = found.next()?;
        (found.next().is_none() && !first.contains('*')).then_some(first)
    }
}

pub const UNKNOWN_KEY: &str = "unknown key";

/// Returns the dotted `key` with each number replaced by `*`.
pub(super) fn pattern(key: &str) -> String {
    let names = key.split('.').map(|name| {
        let is_number = !name.is_empty() && name.bytes().all(|byte| byte.is_ascii_digit());
        if is_number { "*" } else { name }
    });
    names.collect::<Vec<_>>().join(".")
}

/// Returns `key` as a single key of a TOML table: in quotes if it contains dots.
pub fn quoted(key: &str) -> String {
    if key.contains('.') {
        format!("\"{key}\"")
    } else {
        key.to_owned()
    }
}
