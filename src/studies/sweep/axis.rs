//! A key that varies, and its values.

use super::file::VaryFile;
use crate::engine::scenario::document::toml_or_text;
use crate::engine::scenario::dotted::{join, overlap};
use crate::engine::scenario::keys;
use crate::engine::scenario::kind::ValueKind;
use crate::engine::scenario::start::exclude_each_other;
use crate::engine::scenario::{Problem, Problems};
use crate::engine::text::number::rounded;
use crate::engine::text::printable::{brief, is_steering};
use toml::Value;

/// Keys that vary together, mostly one, and their values in order.
#[derive(Clone, Debug, PartialEq)]
pub struct SweepAxis {
    pub keys: Vec<String>,
    /// The values at each point of the axis, one for each key.
    pub points: Vec<Vec<Value>>,
}

/// Separates keys that vary together.
pub const KEY_SEPARATOR: char = '+';

const MOST_AXIS_VALUES: u64 = 10_000_000;

/// Digits of a value between two ends: one less than rounding spoils.
const AXIS_VALUE_DIGITS: usize = 15;
/// Digits of a value between two ends with equal ratios, which is a root: as many as are ever set by hand.
const LOG_VALUE_DIGITS: usize = 6;
/// The logarithm of the ratio of two such values from which on these digits tell them apart.
const LEAST_LOG_STEP: f64 = 1e-4;

impl SweepAxis {
    pub(super) fn new(vary: &VaryFile, place: &str) -> Result<Self, Vec<Problem>> {
        let kinds = kinds_of(&vary.key).map_err(|(key, rule)| {
            let key = Value::String(key);
            vec![Problem::with_value(join(place, "key"), &key, rule)]
        })?;
        let is_log = vary.log == Some(true);
        let values = match (&vary.values, vary.from, vary.to, vary.count) {
            (Some(values), None, None, None) if vary.log.is_none() => values.clone(),
            (None, Some(from), Some(to), Some(count)) => {
                range(from, to, count, is_log).map_err(|rule| vec![Problem::at(place, rule)])?
            }
            _ => {
                let rule = "must hold either values = [...], or from, to and count, and log = true for equal ratios";
                return Err(vec![Problem::at(place, rule)]);
            }
        };
        if values.is_empty() {
            let rule = "must hold at least one value";
            return Err(vec![Problem::at(join(place, "values"), rule)]);
        }
        let keys: Vec<String> = split_keys(&vary.key).map(str::to_owned).collect();
        let points = values.into_iter().map(|value| point(&kinds, value));
        let axis = Self {
            keys,
            points: points.collect(),
        };
        let mut problems = Vec::new();
        for point in &axis.points {
            for ((key, kind), value) in axis.keys.iter().zip(&kinds).zip(point) {
                if let Err(rule) = check_value(*kind, value) {
                    problems.push(Problem::with_value(key.clone(), value, rule));
                }
            }
        }
        problems.is_empty().then_some(axis).ok_or(problems)
    }

    /// Returns its keys with their values at its first point.
    pub(super) fn first_values(&self) -> impl Iterator<Item = (&str, &Value)> {
        let keys = self.keys.iter().map(String::as_str);
        keys.zip(self.points.iter().take(1).flatten())
    }
}

/// Returns the keys that the key of a `[[vary]]` or `--vary` names: those between its `+`.
pub fn split_keys(key: &str) -> impl Iterator<Item = &str> {
    key.split(KEY_SEPARATOR).map(str::trim)
}

/// Returns the kinds of the keys in `key`, or the first that cannot vary, and why.
fn kinds_of(key: &str) -> Result<Vec<ValueKind>, (String, String)> {
    let kinds = split_keys(key).map(|key| kind_of(key).map_err(|rule| (key.to_owned(), rule)));
    kinds.collect()
}

/// Returns the values of the keys of these `kinds` for `value`: one in a list for each key, or the same for all of them.
fn point(kinds: &[ValueKind], value: Value) -> Vec<Value> {
    let is_of_each = kinds.iter().all(|kind| kind.check(&value).is_ok());
    match value {
        Value::Array(list) if !is_of_each && kinds.len() > 1 && list.len() == kinds.len() => {
            let each = kinds.iter().zip(list);
            each.map(|(kind, own)| as_kind(*kind, own)).collect()
        }
        same => {
            let each = kinds.iter();
            each.map(|kind| as_kind(*kind, same.clone())).collect()
        }
    }
}

pub(super) fn read_axes(files: &[VaryFile], problems: &mut Vec<Problem>) -> Vec<SweepAxis> {
    let mut axes: Vec<SweepAxis> = Vec::new();
    if files.is_empty() {
        let rule = "is missing: a sweep varies at least one key, by [[vary]] or --vary KEY=A..B:N";
        problems.push(Problem::at("vary", rule));
    }
    for (index, file) in files.iter().enumerate() {
        let place = format!("vary.{index}");
        match SweepAxis::new(file, &place) {
            Ok(axis) => {
                let mut earlier: Vec<&String> = axes.iter().flat_map(|other| &other.keys).collect();
                for key in &axis.keys {
                    let clash = earlier.iter().find_map(|other| clash(key, other));
                    problems.extend(clash.map(|rule| Problem::at(key.clone(), rule)));
                    earlier.push(key);
                }
                axes.push(axis);
            }
            Err(mut wrong) => problems.append(&mut wrong),
        }
    }
    axes
}

/// Why `key` cannot vary together with `other`.
fn clash(key: &str, other: &str) -> Option<String> {
    if other == key {
        Some("varies twice".to_owned())
    } else if exclude_each_other(other, key) {
        Some(format!(
            "varies, and so does {other}: a start has one of them"
        ))
    } else {
        overlap(other, key).then(|| format!("varies, and so does {other}, which writes into it"))
    }
}

/// What a value of the dotted `key` may be.
fn kind_of(key: &str) -> Result<ValueKind, String> {
    if ["gyrolab", "expected", "edit"].contains(&key.split('.').next().unwrap_or_default()) {
        return Err("is no part of the set-up, and cannot vary".to_owned());
    }
    keys::find(key).map(|(_, kind)| kind)
}

/// Whether `value` may stand at a key of this kind. (Whether the scenario takes it shows at its point.)
fn check_value(kind: ValueKind, value: &Value) -> Result<(), String> {
    kind.check(value)?;
    let is_steered = value
        .as_str()
        .is_some_and(|text| text.contains(is_steering));
    if is_steered {
        return Err("must be one line, without control characters".to_owned());
    }
    Ok(())
}

/// Returns `count` values from `from` to `to`, both among them, without the last digits that only rounding makes: at equal
/// distances, or, if `is_log`, with equal ratios.
fn range(from: f64, to: f64, count: u64, is_log: bool) -> Result<Vec<Value>, String> {
    if !(from.is_finite() && to.is_finite() && (to - from).is_finite()) {
        return Err("must have finite ends".to_owned());
    }
    if is_log && (from <= 0.0 || to <= 0.0) {
        return Err("must have ends above 0: its values have equal ratios".to_owned());
    }
    match count {
        1 if from == to => Ok(vec![Value::Float(from)]),
        0 | 1 => Err("must have a count of 2 or more: both ends are among the values".to_owned()),
        _ if from == to => Err("has two ends that are the same".to_owned()),
        count if count > MOST_AXIS_VALUES => Err(format!(
            "has {count} values: at most {MOST_AXIS_VALUES} are allowed"
        )),
        count => {
            let last = count - 1;
            let is_coarse = is_log && libm::log(to / from).abs() > LEAST_LOG_STEP * last as f64;
            let digits = if is_coarse {
                LOG_VALUE_DIGITS
            } else {
                AXIS_VALUE_DIGITS
            };
            let inner = (1..last).map(|index| {
                let share = index as f64 / last as f64;
                let value = if is_log {
                    libm::exp(libm::log(from) * (1.0 - share) + libm::log(to) * share)
                } else {
                    from + (to - from) * share
                };
                rounded(value, digits)
            });
            let values = std::iter::once(from).chain(inner).chain([to]);
            Ok(values.map(Value::Float).collect())
        }
    }
}

/// A whole number where a number is wanted as that number, and a number without decimals where a whole one is.
fn as_kind(kind: ValueKind, value: Value) -> Value {
    const LARGEST_WHOLE_VALUE: f64 = 9e15;
    match (kind, &value) {
        (ValueKind::Number(_), Value::Integer(whole)) => Value::Float(*whole as f64),
        (ValueKind::Whole(..) | ValueKind::WholeOr(..), Value::Float(number))
            if number.fract() == 0.0 && number.abs() < LARGEST_WHOLE_VALUE =>
        {
            Value::Integer(*number as i64)
        }
        _ => value,
    }
}

/// Parses what `--vary` is given: `KEY=A..B:N`, `KEY=A..B:N:log` or `KEY=V1,V2,...`; several keys have `+` between them.
pub fn parse(argument: &str) -> Result<VaryFile, Problems> {
    read(argument).map_err(|rule| {
        let mut problem = Problem::at("", rule);
        place(&mut problem, argument);
        Problems::one("", problem)
    })
}

/// Returns the key and the values that `--vary` is given.
///
/// # Errors
/// When it is no such argument, or the key takes no such value.
pub fn axis(argument: &str) -> Result<SweepAxis, Problems> {
    SweepAxis::new(&parse(argument)?, "vary").map_err(|mut problems| {
        for problem in &mut problems {
            place(problem, argument);
        }
        Problems::from(problems)
    })
}

fn read(argument: &str) -> Result<VaryFile, String> {
    let (key, written) = argument
        .split_once('=')
        .ok_or("must be KEY=A..B:N, or KEY=V1,V2,..., such as motion.time_step_s=0.01..0.1:10")?;
    let mut vary = VaryFile {
        key: key.trim().to_owned(),
        ..VaryFile::default()
    };
    let text = written.trim();
    let are_numbers = kinds_of(&vary.key).is_ok_and(|kinds| {
        let mut kinds = kinds.iter();
        kinds.all(|kind| matches!(kind, ValueKind::Number(_) | ValueKind::Whole(..)))
    });
    let Some((from, rest)) = text.split_once("..").filter(|_| are_numbers) else {
        let values = if vary.key.contains(KEY_SEPARATOR) {
            listed(text, values_of_keys)
        } else {
            listed(text, toml_value)
        };
        vary.values = Some(values?);
        return Ok(vary);
    };
    let (to, count) = rest.split_once(':').unwrap_or_default();
    let (count, log) = count
        .split_once(':')
        .map_or((count, None), |(count, log)| (count, Some(log.trim())));
    vary.from = from.trim().parse().ok();
    vary.to = to.trim().parse().ok();
    vary.count = count.trim().parse().ok();
    vary.log = log.map(|log| log == "log");
    if vary.from.and(vary.to).and(vary.count).is_none() || vary.log == Some(false) {
        return Err("must be A..B:N, or A..B:N:log for equal ratios: two numbers and how many values, both ends among them".into());
    }
    Ok(vary)
}

/// Parses a value as TOML, or else as text.
fn toml_value(text: &str) -> Result<Value, String> {
    let (value, mistake) = toml_or_text(text);
    mistake.map_or(Ok(value), Err)
}

/// Parses what keys have that vary together: a value, or a list in brackets with a value for each key.
fn values_of_keys(text: &str) -> Result<Value, String> {
    let inner = text
        .strip_prefix('[')
        .and_then(|rest| rest.strip_suffix(']'));
    match inner {
        Some(inner) => listed(inner, toml_value).map(Value::Array),
        None => toml_value(text),
    }
}

/// Splits `text` at the commas outside of brackets and quotes, and parses each part with `parse`.
fn listed(text: &str, parse: fn(&str) -> Result<Value, String>) -> Result<Vec<Value>, String> {
    let (mut depth, mut quote, mut begin) = (0_i64, None, 0);
    let mut parts = Vec::new();
    for (at, c) in text.char_indices() {
        match (quote, c) {
            (Some(open), _) => quote = (c != open).then_some(open),
            (None, '"' | '\'') => quote = Some(c),
            (None, '[' | '{') => depth += 1,
            (None, ']' | '}') => depth -= 1,
            (None, ',') if depth == 0 => {
                parts.push(&text[begin..at]);
                begin = at + 1;
            }
            _ => {}
        }
    }
    parts.push(&text[begin..]);
    parts
        .into_iter()
        .map(|part| match part.trim() {
            "" => Err("has an empty place between its commas".to_owned()),
            part => parse(part),
        })
        .collect()
}

/// Says of `problem` that it is about that `--vary`.
pub fn place(problem: &mut Problem, argument: &str) {
    problem.place = Some(format!("--vary {}", brief(argument, 80)));
    if problem.key.starts_with("vary.") {
        problem.key.clear(); // a place in a file
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn axis(argument: &str) -> Result<Vec<String>, String> {
        let axis = read(argument).and_then(|vary| {
            SweepAxis::new(&vary, "vary.0").map_err(|problems| problems[0].to_string())
        })?;
        let written = |values: &Vec<Value>| {
            let texts: Vec<_> = values.iter().map(ToString::to_string).collect();
            texts.join(" and ")
        };
        Ok(axis.points.iter().map(written).collect())
    }

    #[test]
    fn a_range_includes_both_ends_without_rounding_noise() {
        let values = axis("motion.time_step_s=0.01..0.1:10").unwrap();
        assert_eq!(values[..4], ["0.01", "0.02", "0.03", "0.04"]);
        assert_eq!((values.len(), values[9].as_str()), (10, "0.1"));
    }

    #[test]
    fn values_are_a_range_toml_or_text() {
        let forces = "push.0.force_N=[0,0,-50],[0, 0, 50]";
        for (argument, values) in [
            ("motion.gravity_m_per_s2=1..-1:3", "1.0; 0.0; -1.0"),
            ("body.rim.points=4..12:3", "4; 8; 12"),
            ("motion.scheme=report,rk4", "\"report\"; \"rk4\""),
            ("motion.time_step_s=1, 0.5", "1.0; 0.5"),
            (forces, "[0, 0, -50]; [0, 0, 50]"),
            ("title=\"a,b\",c", "\"a,b\"; \"c\""),
            (
                "motion.time_step_s=0.001..0.1:5:log",
                "0.001; 0.00316228; 0.01; 0.0316228; 0.1",
            ),
            ("body.rim.points=4..64:5:log", "4; 8; 16; 32; 64"),
            (
                "start.tilt_deg+start.turn_deg=0..90:3",
                "0.0 and 0.0; 45.0 and 45.0; 90.0 and 90.0",
            ),
            (
                "motion.scheme+motion.time_step_s=[report,0.1],[rk4,1]",
                "\"report\" and 0.1; \"rk4\" and 1.0",
            ),
            (
                "push.0.force_N+push.1.force_N=[0,0,1]",
                "[0, 0, 1] and [0, 0, 1]",
            ),
        ] {
            assert_eq!(axis(argument).unwrap().join("; "), values, "{argument}");
        }
    }
}
