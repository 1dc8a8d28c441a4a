//! A key whose value is looked for.

use crate::engine::scenario::dotted;
use crate::engine::scenario::keys::{self, Effect};
use crate::engine::scenario::kind::{Range, ValueKind};
use crate::engine::scenario::schema::Nudge;
use crate::engine::scenario::{Document, Problem, Problems, float};
use crate::engine::text::number::shortest;
use crate::engine::text::printable::brief;

/// A free key: where the search begins, and what it may not leave.
#[derive(Clone, Debug, PartialEq)]
pub struct Free {
    /// The dotted key; of several that have one value, all of them with + between.
    pub key: String,
    pub keys: Vec<String>,
    pub start: f64,
    /// The least value; -infinity where there is none.
    pub from: f64,
    /// The greatest value; infinity where there is none.
    pub to: f64,
    /// The least value that it can have at all; -infinity where it can have any.
    pub least: f64,
    /// A value of the size that is usual for it.
    pub scale: f64,
}

/// A change of a value that is 0 and has no bounds, where the table of keys names none.
const ZERO_VALUE_CHANGE: f64 = 0.01;

impl Free {
    /// The free key that `argument`, KEY or KEY=FROM..TO, means in `scenario`; either end may be left out. KEY+KEY are two
    /// keys that have the same value, such as the two moments across the axle of a symmetric body.
    ///
    /// # Errors
    /// When there is no such key, no number of a run depends on it, it has no value to begin from, or the bounds are none
    /// or leave the value out.
    pub fn parse(argument: &str, scenario: &Document) -> Result<Self, Problems> {
        Self::read(argument.trim(), scenario).map_err(|rule| {
            let mut problem = Problem::at("", rule);
            problem.place = Some(format!("--free {}", brief(argument, 80)));
            Problems::one("", problem)
        })
    }

    /// The size of the key at `value`, by which relative changes are measured.
    pub(super) fn size(&self, value: f64) -> f64 {
        match value.abs() {
            0.0 => self.scale,
            size => size,
        }
    }

    fn read(argument: &str, scenario: &Document) -> Result<Self, String> {
        let (key, bounds) = argument.split_once('=').unwrap_or((argument, ".."));
        let (lowest, to) = ends(bounds)?;
        let keys: Vec<String> = key.split('+').map(|key| key.trim().to_owned()).collect();
        let (start, nudge, least) = Self::one(&keys[0], scenario)?;
        for other in &keys[1..] {
            let (start_of_other, ..) = Self::one(other, scenario)?;
            if start_of_other != start {
                return Err(format!(
                    "{} is {} and {other} is {}: keys that have one value must begin with it",
                    keys[0],
                    shortest(start),
                    shortest(start_of_other)
                ));
            }
        }
        let from = lowest.max(least);
        can_begin(key.trim(), start, from, to)?;
        let width = Some(to - from).filter(|width| width.is_finite());
        let scale = match start.abs() {
            0.0 => width.unwrap_or(nudge),
            size => size,
        };
        Ok(Self {
            key: keys.join("+"),
            keys,
            start,
            from,
            to,
            least,
            scale,
        })
    }

    /// The value of `key` in `scenario`, a small change of it, and the least value that it may have.
    fn one(key: &str, scenario: &Document) -> Result<(f64, f64, f64), String> {
        let (row, kind) = keys::find(key)?;
        let ValueKind::Number(range) = kind else {
            return Err(not_a_number(key, kind));
        };
        if Effect::of_key(key) == Effect::None || key.starts_with("edit.") {
            return Err("no number of a run depends on this key: it cannot be fitted".to_owned());
        }
        let written = dotted::find(scenario.table(), key).cloned();
        let stated = written.or_else(|| row.default.map(toml::Value::from));
        let start = stated.and_then(|value| float(&value)).ok_or_else(|| {
            format!(
                "has no value in the scenario, from which the search would begin: give it one by --set {key}=..."
            )
        })?;
        let nudge = match row.lab.map(|lab| lab.nudge) {
            Some(Nudge::By(size) | Nudge::Hundredth(size)) => size,
            _ => ZERO_VALUE_CHANGE,
        };
        let least = match range {
            Range::NotNegative | Range::Positive => 0.0,
            Range::Any | Range::Within(_) => f64::NEG_INFINITY,
        };
        Ok((start, nudge, least))
    }
}

/// Whether the search for `key` can begin at `start` within these bounds.
fn can_begin(key: &str, start: f64, from: f64, to: f64) -> Result<(), String> {
    if from >= to {
        return Err(format!(
            "the bounds leave no room: it is never below {}, and the upper bound must be above that",
            shown(from)
        ));
    }
    if !(from..=to).contains(&start) {
        return Err(format!(
            "begins at {}, the scenario's value, outside of {}..{}: give other bounds, or begin inside by --set {key}=...",
            shortest(start),
            shown(from),
            shown(to)
        ));
    }
    Ok(())
}

fn not_a_number(key: &str, kind: ValueKind) -> String {
    match kind {
        ValueKind::Vector => {
            format!("is a vector, of which each number can be free: {key}.0, {key}.1, {key}.2")
        }
        ValueKind::Whole(..) | ValueKind::WholeOr(..) => {
            "is a whole number, which cannot be varied by little: vary it by gyrolab sweep"
                .to_owned()
        }
        _ => "is no number: it cannot be fitted".to_owned(),
    }
}

fn ends(bounds: &str) -> Result<(f64, f64), String> {
    const WRONG: &str = "bounds must be FROM..TO, two numbers of which either may be left out, such as 0.1..0.5 or 0..";
    let (from, to) = bounds.split_once("..").ok_or(WRONG)?;
    let from = end(from, f64::NEG_INFINITY).ok_or(WRONG)?;
    let to = end(to, f64::INFINITY).ok_or(WRONG)?;
    if from < to {
        Ok((from, to))
    } else {
        Err(format!(
            "the bounds leave no room: {} must be below {}",
            shown(from),
            shown(to)
        ))
    }
}

/// Returns the number in `text`, or the `absent` one where it is empty; `None` where it is no finite number.
fn end(text: &str, absent: f64) -> Option<f64> {
    match text.trim() {
        "" => Some(absent),
        number => number
            .parse()
            .ok()
            .filter(|number: &f64| number.is_finite()),
    }
}

/// A bound as it is written; nothing where there is none.
pub(super) fn shown(bound: f64) -> String {
    if bound.is_finite() {
        shortest(bound)
    } else {
        String::new()
    }
}
