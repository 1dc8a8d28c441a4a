//! Reads the values of the commands that act on the run, and the parts of which the values of all commands consist.

use super::write::map;
use super::{Command, Force, Place, PushChoice};
use crate::lab::numbers;
use crate::scenario::dotted::join;
use crate::scenario::keys::{self, Kind, Range};
use crate::scenario::problem::nearest;
use crate::scenario::{Problem, float, presets};
use crate::work::expression::Expression;
use crate::work::next_push::Toward;
use toml::{Table, Value};

/// The largest number of repetitions by one command.
const MOST_TIMES: i64 = 10_000;
/// The longest wait, s.
const LONGEST_WAIT: f64 = 86_400.0;

/// The command, or every rule that its value breaks, with keys below the command's name.
pub(super) type Read = Result<Command, Vec<Problem>>;

pub(super) fn wrong<T>(value: &Value, rule: impl Into<String>) -> Result<T, Vec<Problem>> {
    Err(vec![Problem::with_value("", value, rule)])
}

pub(super) fn wrong_at<T>(
    key: &str,
    value: &Value,
    rule: impl Into<String>,
) -> Result<T, Vec<Problem>> {
    Err(vec![Problem::with_value(key, value, rule)])
}

pub(super) fn checked(kind: Kind, value: &Value) -> Result<&Value, Vec<Problem>> {
    match kind.check(value) {
        Ok(()) => Ok(value),
        Err(rule) => wrong(value, rule),
    }
}

/// `value`, checked as the value of the scenario's key `view.name`.
pub(super) fn of_view<'a>(name: &str, value: &'a Value) -> Result<&'a Value, Vec<Problem>> {
    match keys::find(&format!("view.{name}")) {
        Ok((_, kind)) => checked(kind, value),
        Err(rule) => wrong(value, rule),
    }
}

pub(super) fn number_in(value: &Value) -> f64 {
    float(value).unwrap_or_default()
}

pub(super) fn text_in(value: &Value) -> &str {
    value.as_str().unwrap_or_default()
}

/// A finite number of `range`.
pub(super) fn number(range: Range, value: &Value) -> Result<f64, Vec<Problem>> {
    checked(Kind::Number(range), value).map(number_in)
}

pub(super) fn line(value: &Value) -> Result<&str, Vec<Problem>> {
    checked(Kind::Line, value).map(text_in)
}

pub(super) fn if_true(value: &Value, command: Command) -> Read {
    match value {
        Value::Boolean(true) => Ok(command),
        other => wrong(other, "must be true"),
    }
}

pub(super) fn count(value: &Value) -> Result<u32, Vec<Problem>> {
    let whole = checked(Kind::Whole(1, MOST_TIMES), value)?.as_integer();
    Ok(whole
        .and_then(|whole| u32::try_from(whole).ok())
        .unwrap_or(1))
}

/// The fields of a table, of which only `known` are allowed.
pub(super) fn fields<'a>(value: &'a Value, known: &[&str]) -> Result<&'a Table, Vec<Problem>> {
    let Value::Table(table) = value else {
        return wrong(value, format!("must be a table of {}", known.join(", ")));
    };
    let unknown = table.keys().filter(|name| !known.contains(&name.as_str()));
    let problems: Vec<_> = unknown
        .map(|name| {
            let near = nearest(name, known.iter().copied());
            Problem::at(name.clone(), format!("unknown key: {near}"))
        })
        .collect();
    if problems.is_empty() {
        Ok(table)
    } else {
        Err(problems)
    }
}

/// The value that `read` returns for the field `name`; `None` where there is no such field.
pub(super) fn field<T>(
    table: &Table,
    name: &str,
    read: impl FnOnce(&Value) -> Result<T, Vec<Problem>>,
) -> Result<Option<T>, Vec<Problem>> {
    let below = |problem: Problem| Problem {
        key: join(name, &problem.key).trim_end_matches('.').to_owned(),
        ..problem
    };
    let value = table.get(name).map(read).transpose();
    value.map_err(|problems| problems.into_iter().map(below).collect())
}

pub(super) fn missing<T>(name: &str, rule: &str) -> Result<T, Vec<Problem>> {
    Err(vec![Problem::at(name, rule)])
}

pub(super) fn open(value: &Value) -> Read {
    let name = line(value)?;
    let is_file = name.contains('/') || name.contains(".toml") || name.contains(".csv");
    if !is_file && presets::find(name).is_none() {
        let near = nearest(name, presets::PRESETS.iter().map(|preset| preset.name));
        return wrong(value, format!("is no preset: {near}"));
    }
    Ok(Command::Open(name.to_owned()))
}

pub(super) fn set(value: &Value) -> Read {
    let Value::Table(table) = value else {
        return wrong(value, "must be a table of dotted keys and their values");
    };
    if table.is_empty() {
        return wrong(value, "must hold a key and its value");
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
                problems.push(Problem::at(key.clone(), rule));
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
    if problems.is_empty() {
        Ok(Command::Set(table.clone()))
    } else {
        Err(problems)
    }
}

/// The dotted key of the first value in `value`, which stands at `key`.
fn first_inside(key: &str, value: &Value) -> String {
    match value.as_table().and_then(|table| table.iter().next()) {
        Some((name, inner)) => first_inside(&join(key, name), inner),
        None => key.to_owned(),
    }
}

/// `key` as a TOML table has it as one key: in quotes where it has dots.
fn quoted(key: &str) -> String {
    if key.contains('.') {
        format!("\"{key}\"")
    } else {
        key.to_owned()
    }
}

pub(super) fn nudge(value: &Value) -> Read {
    if value.is_str() {
        let key = nudged_key(value)?;
        return Ok(Command::Nudge { key, times: 1 });
    }
    let table = fields(value, &["key", "times"])?;
    let Some(key) = field(table, "key", nudged_key)? else {
        return missing("key", "is missing: the dotted key that is nudged");
    };
    let times = field(table, "times", |value| {
        let times = checked(Kind::Whole(-MOST_TIMES, MOST_TIMES), value)?.as_integer();
        match times.and_then(|times| i32::try_from(times).ok()) {
            Some(times) if times != 0 => Ok(times),
            _ => wrong(value, "must not be 0"),
        }
    })?;
    let times = times.unwrap_or(1);
    Ok(Command::Nudge { key, times })
}

fn nudged_key(value: &Value) -> Result<String, Vec<Problem>> {
    let key = line(value)?;
    match keys::find(key) {
        Ok((row, kind)) if row.lab.is_some() && kind != Kind::Vector => Ok(key.to_owned()),
        Ok((_, Kind::Vector)) => wrong(value, format!("is a vector: nudge {key}.0, .1 or .2")),
        Ok(_) => wrong(value, "cannot be nudged"),
        Err(rule) => wrong(value, rule),
    }
}

pub(super) fn push(value: &Value) -> Read {
    match value {
        Value::Boolean(true) => Ok(Command::Push(PushChoice::default())),
        Value::Table(_) => push_choice(value).map(Command::Push),
        other => wrong(
            other,
            "must be true, or a table of point, force_N, toward, for_s",
        ),
    }
}

pub(super) fn next_push(value: &Value) -> Read {
    let choice = push_choice(value)?;
    if choice == PushChoice::default() {
        wrong(value, "must hold one of point, force_N, toward, for_s")
    } else {
        Ok(Command::NextPush(choice))
    }
}

fn push_choice(value: &Value) -> Result<PushChoice, Vec<Problem>> {
    let table = fields(value, &["point", "force_N", "toward", "for_s"])?;
    let force = |value: &Value| match value {
        Value::Array(_) => {
            let items = checked(Kind::Vector, value)?.as_array();
            let mut numbers = items.into_iter().flatten().map(number_in);
            let vector = std::array::from_fn(|_| numbers.next().unwrap_or_default());
            Ok(Force::Vector(vector))
        }
        _ => number(Range::Positive, value).map(Force::Size),
    };
    let toward = |value: &Value| Toward::typed(line(value)?).or_else(|rule| wrong(value, rule));
    let choice = PushChoice {
        point: field(table, "point", |value| line(value).map(str::to_owned))?,
        force_N: field(table, "force_N", force)?,
        toward: field(table, "toward", toward)?,
        for_s: field(table, "for_s", |value| number(Range::Positive, value))?,
    };
    match (choice.force_N, table.get("toward")) {
        (Some(Force::Vector(_)), Some(toward)) => wrong_at(
            "toward",
            toward,
            "has no place beside a force of three numbers, which has a direction",
        ),
        _ => Ok(choice),
    }
}

pub(super) fn step(value: &Value) -> Read {
    const MOST: i64 = 1_000_000_000;
    match checked(Kind::Whole(-MOST, MOST), value)?.as_integer() {
        Some(steps) if steps != 0 => Ok(Command::Step(steps)),
        _ => wrong(value, "must not be 0"),
    }
}

/// The step or time that `value` names.
pub(super) fn place(value: &Value) -> Option<Place> {
    match value {
        Value::Integer(step) => u64::try_from(*step).ok().map(Place::Step),
        Value::String(text) => Place::parse(text),
        _ => None,
    }
}

pub(super) fn go_to(value: &Value) -> Read {
    match place(value) {
        Some(place) => Ok(Command::GoTo(place)),
        None => wrong(
            value,
            "must be a step from 0 on (421), a time (\"12.5 s\"), \"start\" or \"end\"",
        ),
    }
}

pub(super) fn run_until(value: &Value) -> Read {
    let read = Expression::condition(line(value)?).and_then(|condition| {
        condition.bind(numbers::find)?;
        Ok(condition)
    });
    match read {
        Ok(condition) => Ok(Command::RunUntil(condition)),
        Err(fault) => wrong(value, fault.to_string()),
    }
}

pub(super) fn wait(value: &Value) -> Read {
    let seconds = number(Range::NotNegative, value)?;
    if seconds <= LONGEST_WAIT {
        Ok(Command::Wait(seconds))
    } else {
        wrong(value, format!("must be at most {LONGEST_WAIT}"))
    }
}

pub(super) fn flag(table: &Table, name: &str) -> Result<bool, Vec<Problem>> {
    let read = |value: &Value| Ok(checked(Kind::Flag, value)?.as_bool());
    Ok(field(table, name, read)?.flatten().unwrap_or(false))
}

pub(super) fn whole(table: &Table, name: &str, least: i64) -> Result<Option<u64>, Vec<Problem>> {
    let read = |value: &Value| Ok(checked(Kind::Whole(least, i64::MAX), value)?.as_integer());
    let number = field(table, name, read)?.flatten();
    Ok(number.and_then(|number| u64::try_from(number).ok()))
}

/// The value as a table: a path alone stands for `{ path = ... }`.
pub(super) fn with_path(value: &Value) -> Value {
    match value {
        Value::String(_) => map([("path", value.clone())]),
        other => other.clone(),
    }
}

pub(super) fn path(table: &Table, value: &Value) -> Result<String, Vec<Problem>> {
    match field(table, "path", |path| line(path).map(str::to_owned)) {
        Ok(Some(path)) => Ok(path),
        Ok(None) => missing("path", "is missing: the file"),
        Err(_) if value.is_str() => line(value).map(str::to_owned),
        Err(problems) => Err(problems),
    }
}

pub(super) fn save(value: &Value) -> Read {
    let given = with_path(value);
    let table = fields(&given, &["path", "from_here", "to_step", "force"])?;
    let command = Command::Save {
        path: path(table, value)?,
        from_here: flag(table, "from_here")?,
        to_step: whole(table, "to_step", 1)?,
        force: flag(table, "force")?,
    };
    match (&command, table.get("to_step")) {
        (
            Command::Save {
                from_here: true, ..
            },
            Some(to_step),
        ) => wrong_at(
            "to_step",
            to_step,
            "has no place beside from_here, which saves the present state",
        ),
        _ => Ok(command),
    }
}
