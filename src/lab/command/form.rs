//! What the value of a command may be, and how another one is refused.

use super::{CursorTo, SeekTarget};
use crate::engine::export::layout::LayoutFile;
use crate::engine::journal::expression::Expression;
use crate::engine::journal::next_push::Toward;
use crate::engine::scenario::dotted::join;
use crate::engine::scenario::head::is_file;
use crate::engine::scenario::keys::{self, Range, ValueKind};
use crate::engine::scenario::problem::nearest;
use crate::engine::scenario::{Problem, presets};
use crate::lab::numbers;
use crate::plot::PageFormat;
use crate::report::figure::kind::FigureKind;
use serde::de::DeserializeOwned;
use std::path::Path;
use toml::{Table, Value};

const MOST_TIMES: i64 = 10_000;
const MOST_STEPS_AT_ONCE: i64 = 1_000_000_000;
const LONGEST_WAIT: f64 = 86_400.0;
pub const MOST_MAGNIFIED: f64 = 1e6;

pub(super) enum ValueSchema {
    Is(ValueKind),
    /// As the key or table of this name in `[view]`.
    View(&'static str),
    /// What this function takes; otherwise this is the rule.
    As(fn(&Value) -> bool, &'static str),
    /// What passes this check.
    By(fn(&Value) -> Result<(), String>),
    /// A line of text that passes it.
    Text(fn(&str) -> Result<(), String>),
    /// Dotted keys of the scenario and their values.
    Keys,
    Fields(Fields),
}

pub(super) struct Fields {
    known: &'static [(&'static str, ValueSchema)],
    alone: Shorthand,
    /// What several fields must fulfil: the field that is refused, and why.
    rule: fn(&Table) -> Result<(), Problem>,
}

/// What may stand in the place of a table.
enum Shorthand {
    Nothing,
    /// `true` stands for the empty table.
    True,
    /// A text stands for the first field, which no table may lack; here is what that field means.
    First(&'static str),
}

use ValueKind::{Flag, Line, Number, Whole};
use ValueSchema::{As, By, Is, Text, View};

const LATER: ValueSchema = Is(Whole(1, i64::MAX));
const TIME_SCHEMA: ValueSchema = Is(Number(Range::NotNegative));
const PATH: (&str, ValueSchema) = ("path", Is(Line));
const TO_STEP: (&str, ValueSchema) = ("to_step", LATER);
const FORCE: (&str, ValueSchema) = ("force", Is(Flag));

pub(super) const TRUE: ValueSchema = As(|value| value.as_bool() == Some(true), "must be true");
pub(super) const COUNT_SCHEMA: ValueSchema = Is(Whole(1, MOST_TIMES));
pub(super) const STEPS_SCHEMA: ValueSchema = By(|value| not_zero(value, MOST_STEPS_AT_ONCE));
pub(super) const OPEN_SCHEMA: ValueSchema = Text(is_scenario);
pub(super) const PLACE_SCHEMA: ValueSchema = As(
    is::<SeekTarget>,
    "must be a step from 0 on (421), a time (\"12.5 s\"), \"start\" or \"end\"",
);
pub(super) const CURSOR_SCHEMA: ValueSchema = As(
    is::<CursorTo>,
    "must be a step from 0 on (421), a time (\"12.5 s\"), \"start\", \"end\", \"next turn\", \"turn before\", \"mark\" or \"none\"",
);
pub(super) const CONDITION: ValueSchema = Text(|text| {
    let condition = Expression::condition(text);
    let bound = condition.and_then(|condition| condition.bind(|name| numbers::find(name, None)));
    bound.map_or_else(|fault| Err(fault.to_string()), |_| Ok(()))
});
pub(super) const WAIT: ValueSchema = Is(Number(Range::Within((0.0, LONGEST_WAIT))));
pub(super) const SPEED_SCHEMA: ValueSchema = By(|value| match value.as_str() {
    Some("top") => Ok(()),
    Some(_) => Err("must be a number greater than zero, or \"top\"".to_owned()),
    None => Number(Range::Positive).check(value),
});
pub(super) const SINCE: ValueSchema = By(|value| match value.as_str() {
    Some("none") => Ok(()),
    _ => Number(Range::NotNegative).check(value),
});
pub(super) const MAGNIFY: ValueSchema = Is(Number(Range::Within((1.0, MOST_MAGNIFIED))));
pub(super) const NUDGE: ValueSchema = ValueSchema::Fields(Fields {
    known: &[
        ("key", Text(can_be_nudged)),
        ("times", By(|value| not_zero(value, MOST_TIMES))),
    ],
    alone: Shorthand::First("the dotted key that is nudged"),
    rule: |_| Ok(()),
});
pub(super) const PUSH_SCHEMA: ValueSchema = ValueSchema::Fields(Fields {
    known: &OF_PUSH,
    alone: Shorthand::True,
    rule: has_one_direction,
});
pub(super) const NEXT_PUSH_SCHEMA: ValueSchema = ValueSchema::Fields(Fields {
    known: &OF_PUSH,
    alone: Shorthand::Nothing,
    rule: |table| {
        if table.is_empty() {
            let rule = "must hold one of point, force_N, toward, from_s, for_s";
            return Err(Problem::at("", rule));
        }
        has_one_direction(table)
    },
});
const OF_PUSH: [(&str, ValueSchema); 5] = [
    ("point", Is(Line)),
    (
        "force_N",
        By(|value| match value {
            Value::Array(_) => ValueKind::Vector.check(value),
            _ => Number(Range::Positive).check(value),
        }),
    ),
    ("toward", Text(|text| Toward::typed(text).map(|_| ()))),
    ("from_s", Is(Number(Range::NotNegative))),
    ("for_s", Is(Number(Range::Positive))),
];
pub(super) const EXPORT: ValueSchema = ValueSchema::Fields(Fields {
    known: &[
        PATH,
        ("every", LATER),
        ("from_s", TIME_SCHEMA),
        ("to_s", TIME_SCHEMA),
        ("columns", By(are_names)),
        ("points", Is(Flag)),
        ("excel", Is(Flag)),
        TO_STEP,
        FORCE,
    ],
    alone: Shorthand::First("the file"),
    rule: |table| {
        let mut layout = table.clone();
        layout.retain(|key, _| !["path", "to_step", "force"].contains(&key));
        let layout: LayoutFile = layout.try_into().unwrap_or_default();
        layout.check().map(drop)
    },
});
pub(super) const FIGURE: ValueSchema = ValueSchema::Fields(Fields {
    known: &[
        PATH,
        ("kind", Text(|name| FigureKind::named(name).map(|_| ()))),
        ("exact", Is(Flag)),
        TO_STEP,
        FORCE,
    ],
    alone: Shorthand::First("the file"),
    rule: |table| {
        let path = table.get("path").and_then(Value::as_str);
        let format = PageFormat::of(Path::new(path.unwrap_or_default()));
        format
            .map(drop)
            .map_err(|refusal| Problem::at("", refusal.to_string()))
    },
});
pub(super) const SAVE: ValueSchema = ValueSchema::Fields(Fields {
    known: &[PATH, ("from_here", Is(Flag)), TO_STEP, FORCE],
    alone: Shorthand::First("the file"),
    rule: |table| {
        let is_from_here = table.get("from_here").and_then(Value::as_bool);
        if is_from_here == Some(true) && table.contains_key("to_step") {
            let rule = "has no place beside from_here, which saves the present state";
            return Err(Problem::at("to_step", rule));
        }
        Ok(())
    },
});
impl ValueSchema {
    /// `value` as serde reads it: what stands alone for a table is one.
    ///
    /// # Errors
    /// Every rule that it breaks, with keys below the command's name.
    pub(super) fn check(&self, value: &Value) -> Result<Value, Vec<Problem>> {
        let checked = match self {
            Is(kind) => kind.check(value),
            View(name) => return of_view(&format!("view.{name}"), value),
            As(is_it, rule) if !is_it(value) => Err((*rule).to_owned()),
            As(..) => Ok(()),
            By(check) => check(value),
            Text(check) => Line
                .check(value)
                .and_then(|()| check(value.as_str().unwrap_or_default())),
            Self::Keys => return are_keys(value),
            Self::Fields(fields) => return fields.check(value),
        };
        checked.map_err(|rule| vec![Problem::with_value("", value, rule)])?;
        Ok(value.clone())
    }
}

impl Fields {
    fn check(&self, value: &Value) -> Result<Value, Vec<Problem>> {
        let table = self.table(value)?;
        let mut problems = Vec::new();
        for (name, value) in &table {
            match self.known.iter().find(|(known, _)| known == name) {
                Some((_, form)) => {
                    let found = form.check(value).err().into_iter().flatten();
                    problems.extend(found.map(|problem| below(name, problem)));
                }
                None => {
                    let rule = format!("unknown key: {}", nearest(name, self.names()));
                    problems.push(Problem::at(name, rule));
                }
            }
        }
        let first = self.known[0].0;
        if let Shorthand::First(meaning) = self.alone
            && problems.is_empty()
            && !table.contains_key(first)
        {
            problems.push(Problem::at(first, format!("is missing: {meaning}")));
        }
        if problems.is_empty()
            && let Err(Problem { key, rule, .. }) = (self.rule)(&table)
        {
            let value = table.get(&key).unwrap_or(value);
            problems.push(Problem::with_value(key, value, rule));
        }
        unless_any(problems, Value::Table(table))
    }

    fn names(&self) -> impl Iterator<Item = &'static str> + Clone {
        self.known.iter().map(|(name, _)| *name)
    }

    /// The table that `value` is, or stands for.
    fn table(&self, value: &Value) -> Result<Table, Vec<Problem>> {
        let (first, form) = &self.known[0];
        match (&self.alone, value) {
            (_, Value::Table(table)) => Ok(table.clone()),
            (Shorthand::True, Value::Boolean(true)) => Ok(Table::new()),
            (Shorthand::First(_), Value::String(_)) => Ok(Table::from_iter([(
                (*first).to_owned(),
                form.check(value)?,
            )])),
            _ => {
                let or_true = match self.alone {
                    Shorthand::True => "true, or ",
                    _ => "",
                };
                let names = self.names().collect::<Vec<_>>().join(", ");
                let rule = format!("must be {or_true}a table of {names}");
                Err(vec![Problem::with_value("", value, rule)])
            }
        }
    }
}

/// `problem`, found in the value of `name`.
pub(super) fn below(name: &str, problem: Problem) -> Problem {
    let key = join(name, &problem.key).trim_end_matches('.').to_owned();
    Problem { key, ..problem }
}

fn unless_any(problems: Vec<Problem>, value: Value) -> Result<Value, Vec<Problem>> {
    problems.is_empty().then_some(value).ok_or(problems)
}

fn is<T: DeserializeOwned>(value: &Value) -> bool {
    value.clone().try_into::<T>().is_ok()
}

/// Checks `value` as that of `key`, a key or a table of `[view]`.
fn of_view(key: &str, value: &Value) -> Result<Value, Vec<Problem>> {
    let mut problems = keys::check_part(value, key);
    for problem in &mut problems.list {
        problem.key = problem.key[key.len()..].trim_start_matches('.').to_owned();
    }
    problems.or(value.clone()).map_err(|problems| problems.list)
}

fn not_zero(value: &Value, most: i64) -> Result<(), String> {
    Whole(-most, most).check(value)?;
    match value.as_integer() {
        Some(0) => Err("must not be 0".to_owned()),
        _ => Ok(()),
    }
}

fn is_scenario(name: &str) -> Result<(), String> {
    if is_file(name) || presets::find(name).is_some() {
        return Ok(());
    }
    let near = nearest(name, presets::PRESETS.iter().map(|preset| preset.name));
    Err(format!("is no preset: {near}"))
}

fn can_be_nudged(key: &str) -> Result<(), String> {
    match keys::find(key)? {
        (_, ValueKind::Vector) => Err(format!("is a vector: nudge {key}.0, .1 or .2")),
        (row, _) if row.lab.is_some() => Ok(()),
        _ => Err("cannot be nudged".to_owned()),
    }
}

fn are_names(value: &Value) -> Result<(), String> {
    let Some(list) = value.as_array() else {
        return Err("must be a list of names in brackets".to_owned());
    };
    list.iter().try_for_each(|name| Line.check(name))
}

fn has_one_direction(table: &Table) -> Result<(), Problem> {
    let is_vector = table.get("force_N").is_some_and(Value::is_array);
    if is_vector && table.contains_key("toward") {
        let rule = "has no place beside a force of three numbers, which has a direction";
        return Err(Problem::at("toward", rule));
    }
    Ok(())
}

fn are_keys(value: &Value) -> Result<Value, Vec<Problem>> {
    let wrong = |rule: &str| Err(vec![Problem::with_value("", value, rule)]);
    let Value::Table(table) = value else {
        return wrong("must be a table of dotted keys and their values");
    };
    if table.is_empty() {
        return wrong("must hold a key and its value");
    }
    let mut problems = Vec::new();
    for (key, value) in table {
        let is_table = value.is_table() && !key.ends_with('.');
        match keys::find(key) {
            // { motion.time_step_s = 0.05 }: TOML makes a table of a dotted key without quotes.
            Err(_) if is_table && !key.contains('.') => {
                let inner = first_inside(key, value);
                let rule =
                    format!("would be set as a whole: write each key in quotes, \"{inner}\"");
                problems.push(Problem::at(key, rule));
            }
            // A whole push, or another table: it is checked when it is set.
            Err(_) if is_table && keys::is_table(key) => {}
            Err(rule) => problems.push(Problem::at(quoted(key), rule)),
            Ok((_, kind)) => {
                if let Err(rule) = kind.check(value) {
                    problems.push(Problem::with_value(quoted(key), value, rule));
                }
            }
        }
    }
    unless_any(problems, value.clone())
}

/// The dotted key of the first value in `value`, which stands at `key`.
fn first_inside(key: &str, value: &Value) -> String {
    match value.as_table().and_then(|table| table.iter().next()) {
        Some((name, inner)) => first_inside(&join(key, name), inner),
        None => key.to_owned(),
    }
}

/// `key` as a TOML table has it as one key: in quotes where it has dots.
pub(super) fn quoted(key: &str) -> String {
    if key.contains('.') {
        format!("\"{key}\"")
    } else {
        key.to_owned()
    }
}
