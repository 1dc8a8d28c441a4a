//! A free key: a scenario key whose value is fitted.

use crate::engine::scenario::dotted;
use crate::engine::scenario::keys::{self, Effect};
use crate::engine::scenario::kind::{Range, ValueKind};
use crate::engine::scenario::schema::Nudge;
use crate::engine::scenario::{Document, Problem, Problems, float};
use crate::engine::text::number::shortest;
use crate::engine::text::printable::brief;

/// A free key: the start of the search and its bounds.
#[derive(Clone, Debug, PartialEq)]
pub struct Free {
    /// The dotted key. Several keys that share one value are joined by +.
    pub key: String,
    pub keys: Vec<String>,
    pub start: f64,
    /// Lower bound; -infinity if there is none.
    pub from: f64,
    /// Upper bound; infinity if there is none.
    pub to: f64,
    /// Lowest value that the key allows in any scenario; -infinity if every value is allowed.
    pub least: f64,
    /// A typical size of the value.
    pub scale: f64,
}

/// Typical change of a value that is 0 and has no bounds, if the table of keys has none.
const ZERO_VALUE_CHANGE: f64 = 0.01;

impl Free {
    /// Parses `argument`, KEY or KEY=FROM..TO, for `scenario`. Either bound may be omitted.
    ///
    /// KEY+KEY means two keys that share one value, such as the two moments across the axle of a symmetric body.
    ///
    /// # Errors
    /// Returns an error if the key is unknown, has no value to start from, or does not affect any number of a run. Also
    /// if the bounds cannot be parsed or exclude the start value.
    pub fn parse(argument: &str, scenario: &Document) -> Result<Self, Problems> {
        Self::read(argument.trim(), scenario).map_err(|rule| {
            let mut problem = Problem::at("", rule);
            problem.place = Some(format!("--free {}", brief(argument, 80)));
            Problems::one("", problem)
        })
    }

    /// Returns the size of `value`, the unit of relative changes; a typical size if it is 0.
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
                    "{} is {} and {other} is {}: keys that share one value must start from the same value",
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

    /// Returns the value of `key` in `scenario`, a small change of it, and its lowest allowed value.
    fn one(key: &str, scenario: &Document) -> Result<(f64, f64, f64), String> {
        let (row, kind) = keys::find(key)?;
        let ValueKind::Number(range) = kind else {
            return Err(not_a_number(key, kind));
        };
        if Effect::of_key(key) == Effect::None || key.starts_with("edit.") {
            return Err("cannot be fitted: no number of a run depends on this key".to_owned());
        }
        let written = dotted::find(scenario.table(), key).cloned();
        let stated = written.or_else(|| row.default.map(toml::Value::from));
        let start = stated.and_then(|value| float(&value)).ok_or_else(|| {
            format!(
                "has no value in the scenario to start the search from: set one with --set {key}=..."
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

/// Checks that the search for `key` can start at `start` within these bounds.
fn can_begin(key: &str, start: f64, from: f64, to: f64) -> Result<(), String> {
    if from >= to {
        return Err(format!(
            "the upper bound must be above {}, the lowest value of this key",
            shown(from)
        ));
    }
    if !(from..=to).contains(&start) {
        return Err(format!(
            "starts at {}, the scenario's value, which is outside {}..{}: change the bounds, or start inside with --set {key}=...",
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
            format!("is a vector: free its components {key}.0, {key}.1, {key}.2")
        }
        ValueKind::Whole(..) | ValueKind::WholeOr(..) => {
            "is a whole number and cannot be fitted: vary it with gyrolab sweep".to_owned()
        }
        _ => "cannot be fitted: it is not a number".to_owned(),
    }
}

fn ends(bounds: &str) -> Result<(f64, f64), String> {
    const WRONG: &str =
        "bounds must be FROM..TO, with at least one number, such as 0.1..0.5 or 0..";
    let (from, to) = bounds.split_once("..").ok_or(WRONG)?;
    let from = end(from, f64::NEG_INFINITY).ok_or(WRONG)?;
    let to = end(to, f64::INFINITY).ok_or(WRONG)?;
    if from < to {
        Ok((from, to))
    } else {
        Err(format!(
            "the lower bound {} must be below the upper bound {}",
            shown(from),
            shown(to)
        ))
    }
}

/// Parses the number in `text`; an empty text gives `absent`. Returns `None` if it is not a finite number.
fn end(text: &str, absent: f64) -> Option<f64> {
    match text.trim() {
        "" => Some(absent),
        number => number
            .parse()
            .ok()
            .filter(|number: &f64| number.is_finite()),
    }
}

/// Returns a bound as text; empty if it is infinite.
pub fn shown(bound: f64) -> String {
    if bound.is_finite() {
        shortest(bound)
    } else {
        String::new()
    }
}
