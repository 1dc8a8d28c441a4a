//! The schemas of command values, and the rules for several fields of a command.

use super::{Command, CursorTo, Force, PushChoice, SeekTarget};
use crate::engine::export::layout::LAYOUT_KEYS;
use crate::engine::journal::expression::Expression;
use crate::engine::journal::next_push::Toward;
use crate::engine::scenario::dotted::join;
use crate::engine::scenario::head::is_file;
use crate::engine::scenario::keys::{self, SCENARIO};
use crate::engine::scenario::kind::Range::{NotNegative, Positive, Within};
use crate::engine::scenario::kind::ValueKind::{self, By, Flag, Line, Number, Text, Vector, Whole};
use crate::engine::scenario::problem::nearest;
use crate::engine::scenario::schema::{Schema, SchemaRow, may, must, quoted};
use crate::engine::scenario::{Problem, Problems, presets};
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
    /// The value of the key or table at this path in `[view]`.
    View(&'static str),
    /// Dotted keys of the scenario and their values.
    Keys,
    /// A table with these fields, or its shorthand.
    Fields(Schema, Shorthand),
}

/// The shorthand that may replace a table.
pub(super) enum Shorthand {
    Nothing,
    /// `true` means the empty table.
    True,
    /// A text is the value of this field.
    Field(&'static str),
}

use Shorthand::{Field, Nothing, True};
use ValueSchema::{Fields, Is};

pub(super) const TRUE: ValueSchema = Is(By(|value| match value.as_bool() {
    Some(true) => Ok(()),
    _ => Err("must be true".to_owned()),
}));
pub(super) const COUNT_SCHEMA: ValueSchema = Is(Whole(1, MOST_TIMES));
pub(super) const STEPS_SCHEMA: ValueSchema = Is(By(|value| not_zero(value, MOST_STEPS_AT_ONCE)));
pub(super) const OPEN_SCHEMA: ValueSchema = Is(Text(is_scenario));
pub(super) const PLACE_SCHEMA: ValueSchema = Is(By(|value| {
    let rule = "must be a step from 0 on (421), a time (\"12.5 s\"), \"start\" or \"end\"";
    is::<SeekTarget>(value, rule)
}));
pub(super) const CURSOR_SCHEMA: ValueSchema = Is(By(|value| {
    let rule = "must be a step from 0 on (421), a time (\"12.5 s\"), \"start\", \"end\", \"next turn\", \"turn before\", \"mark\" or \"none\"";
    is::<CursorTo>(value, rule)
}));
pub(super) const CONDITION: ValueSchema = Is(Text(|text| {
    let condition = Expression::condition(text);
    let bound = condition.and_then(|condition| condition.bind(|name| numbers::find(name, None)));
    bound.map(drop).map_err(|fault| fault.to_string())
}));
pub(super) const WAIT: ValueSchema = Is(Number(Within((0.0, LONGEST_WAIT))));
pub(super) const SPEED_SCHEMA: ValueSchema = Is(By(|value| match value.as_str() {
    Some("top") => Ok(()),
    Some(_) => Err("must be a number greater than zero, or \"top\"".to_owned()),
    None => Number(Positive).check(value),
}));
pub(super) const SINCE: ValueSchema = Is(By(|value| match value.as_str() {
    Some("none") => Ok(()),
    _ => Number(NotNegative).check(value),
}));
pub(super) const MAGNIFY: ValueSchema = Is(Number(Within((1.0, MOST_MAGNIFIED))));
pub(super) const NUDGE: ValueSchema = Fields(Schema(&[OF_NUDGE]), Field("key"));
pub(super) const PUSH_SCHEMA: ValueSchema = Fields(Schema(&[OF_PUSH]), True);
pub(super) const NEXT_PUSH_SCHEMA: ValueSchema = Fields(Schema(&[OF_PUSH]), Nothing);
pub(super) const EXPORT: ValueSchema = Fields(Schema(&[OF_FILE, LAYOUT_KEYS]), Field("path"));
pub(super) const FIGURE: ValueSchema = Fields(Schema(&[OF_FILE, OF_FIGURE]), Field("path"));
pub(super) const SAVE: ValueSchema = Fields(Schema(&[OF_FILE, OF_SAVE]), Field("path"));

const OF_NUDGE: &[SchemaRow] = &[
    must("key", Text(can_be_nudged), "the dotted key that is nudged"),
    may("times", By(|value| not_zero(value, MOST_TIMES)), ""),
    may("rerun", Flag, ""),
];
const OF_PUSH: &[SchemaRow] = &[
    may("point", Line, ""),
    may("force_N", By(is_force), ""),
    may("toward", Text(|text| Toward::typed(text).map(drop)), ""),
    may("from_s", Number(NotNegative), ""),
    may("for_s", Number(Positive), ""),
];
/// Fields of every command that writes a file.
const OF_FILE: &[SchemaRow] = &[
    must("path", Line, "the file"),
    may("to_step", Whole(1, i64::MAX), "the last step in it"),
    may("force", Flag, "whether an existing file is replaced"),
];
const OF_FIGURE: &[SchemaRow] = &[
    may("kind", Text(|name| FigureKind::named(name).map(drop)), ""),
    may("exact", Flag, ""),
];
const OF_SAVE: &[SchemaRow] = &[may("from_here", Flag, "")];

/// Checks the rules for several fields of `command`. The key of a problem is the key of the refused field.
pub(super) fn check_together(command: &Command) -> Result<(), Problem> {
    match command {
        Command::Export(export) => export.layout.clone().check().map(drop),
        Command::Figure(figure) => match PageFormat::from_path(Path::new(&figure.path)) {
            Ok(_) => Ok(()),
            Err(refusal) => Err(Problem::at("", refusal.to_string())),
        },
        Command::Save(save) if save.from_here && save.to_step.is_some() => Err(Problem::at(
            "to_step",
            "cannot be used with from_here, which saves the present state",
        )),
        Command::NextPush(choice) if *choice == PushChoice::default() => Err(Problem::at(
            "",
            "must contain one of point, force_N, toward, from_s, for_s",
        )),
        Command::Push(PushChoice {
            force_N: Some(Force::Vector(_)),
            toward: Some(_),
            ..
        })
        | Command::NextPush(PushChoice {
            force_N: Some(Force::Vector(_)),
            toward: Some(_),
            ..
        }) => Err(Problem::at(
            "toward",
            "cannot be used with a force of three numbers, which has a direction",
        )),
        _ => Ok(()),
    }
}

impl ValueSchema {
    /// Checks `value` of the command `name`, and returns it with any shorthand expanded.
    pub(super) fn check(&self, name: &str, value: &Value) -> Result<Value, Problems> {
        match self {
            Is(kind) => kind
                .check(value)
                .map_err(|rule| Problem::with_value(name, value, rule))?,
            Self::View(path) => SCENARIO.check_part(value, path, name).or(())?,
            Self::Keys => check_keys(name, value)?,
            Fields(schema, shorthand) => {
                let whole = match (shorthand, value) {
                    (True, Value::Boolean(true)) => Table::new().into(),
                    (Field(field), Value::String(_)) => {
                        Table::from_iter([((*field).to_owned(), value.clone())]).into()
                    }
                    _ => value.clone(),
                };
                schema.check_part(&whole, "", name).or(())?;
                return Ok(whole);
            }
        }
        Ok(value.clone())
    }
}

fn is<T: DeserializeOwned>(value: &Value, rule: &str) -> Result<(), String> {
    let read = value.clone().try_into::<T>();
    read.map(drop).map_err(|_| rule.to_owned())
}

fn is_force(value: &Value) -> Result<(), String> {
    match value {
        Value::Array(_) => Vector.check(value),
        _ => Number(Positive).check(value),
    }
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
    Err(format!("is not a preset: {near}"))
}

fn can_be_nudged(key: &str) -> Result<(), String> {
    match keys::find(key)? {
        (_, Vector) => Err(format!("is a vector: nudge {key}.0, .1 or .2")),
        (row, _) if row.lab.is_some() => Ok(()),
        _ => Err("cannot be nudged".to_owned()),
    }
}

/// Checks `value` of the command `name`: dotted keys of the scenario, each with an allowed value.
fn check_keys(name: &str, value: &Value) -> Result<(), Problems> {
    let keys = match value {
        Value::Table(table) if !table.is_empty() => table,
        _ => {
            let rule = "must contain a key and its value: { \"motion.time_step_s\" = 0.05 }";
            return Err(Problem::with_value(name, value, rule).into());
        }
    };
    let mut problems = Problems::default();
    for (key, new) in keys {
        let path = join(name, &quoted(key));
        let is_table = new.is_table() && !key.ends_with('.');
        match keys::find(key) {
            // In { motion.time_step_s = 0.05 }, TOML reads a dotted key without quotes as nested tables.
            Err(_) if is_table && !key.contains('.') => {
                let inner = first_inside(key, new);
                let rule =
                    format!("would be set as a whole: write each key in quotes, \"{inner}\"");
                problems.add(|| Problem::at(path, rule));
            }
            // A whole push, or another table, is checked when it is set.
            Err(_) if is_table && SCENARIO.is_table(key) => {}
            Err(rule) => problems.add(|| Problem::at(path, rule)),
            Ok((_, kind)) => {
                let checked = kind.check(new);
                problems.kept(checked.map_err(|rule| Problem::with_value(path, new, rule)));
            }
        }
    }
    problems.or(())
}

/// Returns the dotted key of the first value inside `value`, whose own key is `key`.
fn first_inside(key: &str, value: &Value) -> String {
    match value.as_table().and_then(|table| table.iter().next()) {
        Some((name, inner)) => first_inside(&join(key, name), inner),
        None => key.to_owned(),
    }
}
