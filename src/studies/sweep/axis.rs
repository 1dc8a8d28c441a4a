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

/// A key that varies, and its values in their order.
#[derive(Clone, Debug, PartialEq)]
pub struct SweepAxis {
    pub key: String,
    pub values: Vec<Value>,
}

const MOST_AXIS_VALUES: u64 = 10_000_000;

/// Digits of a value between two ends: one less than rounding spoils.
const AXIS_VALUE_DIGITS: usize = 15;

impl SweepAxis {
    pub(super) fn new(vary: &VaryFile, place: &str) -> Result<Self, Vec<Problem>> {
        let kind = kind_of(&vary.key).map_err(|rule| {
            let key = Value::String(vary.key.clone());
            vec![Problem::with_value(join(place, "key"), &key, rule)]
        })?;
        let values = match (&vary.values, vary.from, vary.to, vary.count) {
            (Some(values), None, None, None) => values.clone(),
            (None, Some(from), Some(to), Some(count)) => {
                range(from, to, count).map_err(|rule| vec![Problem::at(place, rule)])?
            }
            _ => {
                let rule = "must hold either values = [...], or from, to and count";
                return Err(vec![Problem::at(place, rule)]);
            }
        };
        if values.is_empty() {
            let rule = "must hold at least one value";
            return Err(vec![Problem::at(join(place, "values"), rule)]);
        }
        let axis = Self {
            key: vary.key.clone(),
            values: values
                .into_iter()
                .map(|value| as_kind(kind, value))
                .collect(),
        };
        let mut problems = Vec::new();
        for value in &axis.values {
            if let Err(rule) = check_value(kind, value) {
                problems.push(Problem::with_value(axis.key.clone(), value, rule));
            }
        }
        problems.is_empty().then_some(axis).ok_or(problems)
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
                let clash = axes.iter().find_map(|other| clash(&axis.key, &other.key));
                problems.extend(clash.map(|rule| Problem::at(axis.key.clone(), rule)));
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

/// `count` values from `from` to `to`, both among them, evenly spaced, without the last digits that only rounding makes.
fn range(from: f64, to: f64, count: u64) -> Result<Vec<Value>, String> {
    if !(from.is_finite() && to.is_finite() && (to - from).is_finite()) {
        return Err("must have finite ends".to_owned());
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
            let inner = (1..last).map(|index| {
                let share = index as f64 / last as f64;
                rounded(from + (to - from) * share, AXIS_VALUE_DIGITS)
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

/// What `--vary` is given: `KEY=A..B:N` or `KEY=V1,V2,...`.
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
    let is_number = matches!(
        kind_of(&vary.key),
        Ok(ValueKind::Number(_) | ValueKind::Whole(..))
    );
    let Some((from, rest)) = text.split_once("..").filter(|_| is_number) else {
        vary.values = Some(listed(text)?);
        return Ok(vary);
    };
    let (to, count) = rest.split_once(':').unwrap_or_default();
    vary.from = from.trim().parse().ok();
    vary.to = to.trim().parse().ok();
    vary.count = count.trim().parse().ok();
    if vary.from.and(vary.to).and(vary.count).is_none() {
        return Err("must be A..B:N: two numbers and how many values, both ends among them".into());
    }
    Ok(vary)
}

/// The values between the commas of `text` that stand in no brackets and no quotes: each TOML, or else text.
fn listed(text: &str) -> Result<Vec<Value>, String> {
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
        .map(|part| match (part.trim(), toml_or_text(part.trim())) {
            ("", _) => Err("has an empty place between its commas".to_owned()),
            (_, (value, mistake)) => mistake.map_or(Ok(value), Err),
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
        Ok(axis.values.iter().map(ToString::to_string).collect())
    }

    #[test]
    fn both_ends_are_among_the_values_and_no_digit_is_made_by_rounding() {
        let values = axis("motion.time_step_s=0.01..0.1:10").unwrap();
        assert_eq!(values[..4], ["0.01", "0.02", "0.03", "0.04"]);
        assert_eq!((values.len(), values[9].as_str()), (10, "0.1"));
    }

    #[test]
    fn values_are_those_of_a_range_or_toml_or_else_text() {
        let forces = "push.0.force_N=[0,0,-50],[0, 0, 50]";
        for (argument, values) in [
            ("motion.gravity_m_per_s2=1..-1:3", "1.0; 0.0; -1.0"),
            ("body.rim.points=4..12:3", "4; 8; 12"),
            ("motion.scheme=report,rk4", "\"report\"; \"rk4\""),
            ("motion.time_step_s=1, 0.5", "1.0; 0.5"),
            (forces, "[0, 0, -50]; [0, 0, 50]"),
            ("title=\"a,b\",c", "\"a,b\"; \"c\""),
        ] {
            assert_eq!(axis(argument).unwrap().join("; "), values, "{argument}");
        }
    }
}
