//! A key and its value in the name of a curve.

use super::names::scheme_in_words;
use super::of_table::within_room;
use super::quantity;
use crate::engine::text::number::significant;
use crate::plot::chart::ticks::with_minus;
use crate::plot::letters;
use toml::{Table, Value};

/// The key whose values are names.
pub(super) const SCHEME_KEY: &str = "motion.scheme";
/// Keys of a scenario file that do not affect the motion, and keys that names show in other ways.
const NOT_NAMED: [&str; 8] = [
    "gyrolab",
    "title",
    "about",
    "source",
    "view",
    "expected",
    "motion.scheme",
    "motion.time_step_s",
];
const STEPS_KEY: &str = "motion.steps";

/// A key and its value: as on an axis, such as "*θ*_{0} = 20°", and in full.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct CurveSetting {
    markup: String,
    plain: String,
}

/// Minimum and maximum number of digits of a value.
const FEWEST_DIGITS: usize = 4;
const MOST_DIGITS: usize = 17;

/// Returns the number of digits that distinguish all different numbers among `values`.
pub(super) fn telling_digits<'a>(values: impl Iterator<Item = &'a str>) -> usize {
    let mut numbers: Vec<f64> = values.filter_map(|text| text.parse().ok()).collect();
    numbers.sort_by(f64::total_cmp);
    numbers.dedup();
    let are_told = |digits: &usize| {
        let mut pairs = numbers.windows(2);
        pairs.all(|pair| significant(pair[0], *digits) != significant(pair[1], *digits))
    };
    (FEWEST_DIGITS..MOST_DIGITS)
        .find(are_told)
        .unwrap_or(MOST_DIGITS)
}

impl CurveSetting {
    /// Creates the setting `key` = `value` in `scenario`, with `digits` digits for a number.
    pub fn new(scenario: &Table, key: &str, value: &str, digits: usize) -> Self {
        if key == SCHEME_KEY {
            let words = scheme_in_words(value);
            return Self {
                markup: letters::escape(words),
                plain: words.to_owned(),
            };
        }
        let axis = quantity::axis_in(scenario, key);
        let said = match value.parse() {
            Ok(number) => {
                let unit = axis.unit;
                let space = if unit.is_empty() || unit == "°" {
                    ""
                } else {
                    " "
                };
                format!("{}{space}{unit}", with_minus(&significant(number, digits)))
            }
            Err(_) => letters::escape(value),
        };
        Self {
            markup: format!("{} = {said}", axis.name),
            plain: format!("{key} = {value}"),
        }
    }

    /// Returns the settings in which `scenarios` differ, for each scenario: its values of the keys that are not the
    /// same in all of them. Title, scheme, time step and number of steps are ignored.
    pub fn that_differ(scenarios: &[Table]) -> Vec<Vec<Self>> {
        let all: Vec<Vec<(String, String)>> = scenarios.iter().map(flat).collect();
        let entry = |of: usize, key: &str| all[of].iter().find(|(other, _)| other == key);
        let mut keys: Vec<&String> = Vec::new();
        for (key, _) in all.iter().flatten() {
            let is_same = (1..all.len()).all(|of| entry(of, key) == entry(0, key));
            if !is_same && !keys.contains(&key) {
                keys.push(key);
            }
        }
        let digits = keys.iter().map(|key| {
            let entries = (0..all.len()).filter_map(|of| entry(of, key));
            telling_digits(entries.map(|(_, value)| value.as_str()))
        });
        let digits: Vec<usize> = digits.collect();
        let of_one = scenarios.iter().enumerate().map(|(of, scenario)| {
            let told = keys.iter().zip(&digits);
            let here = told.filter_map(|(key, most)| Some((entry(of, key)?, *most)));
            here.map(|((key, value), most)| Self::new(scenario, key, value, most))
                .collect()
        });
        of_one.collect()
    }
}

/// Returns the keys of `scenario` that a name can contain, with their values as text.
fn flat(scenario: &Table) -> Vec<(String, String)> {
    let mut found = Vec::new();
    for (key, value) in scenario {
        add_flat(key.clone(), value, &mut found);
    }
    found
}

fn add_flat(key: String, value: &Value, found: &mut Vec<(String, String)>) {
    if NOT_NAMED.contains(&key.as_str()) || key == STEPS_KEY {
        return;
    }
    match value {
        Value::Table(table) => {
            for (name, inner) in table {
                add_flat(format!("{key}.{name}"), inner, found);
            }
        }
        Value::Array(array) => {
            for (place, inner) in array.iter().enumerate() {
                add_flat(format!("{key}.{place}"), inner, found);
            }
        }
        Value::String(text) => found.push((key, text.clone())),
        other => found.push((key, other.to_string())),
    }
}

/// Returns the name of a curve with these `settings` after `word`, as markup of at most `room_pt`.
pub(super) fn name(word: &str, settings: &[CurveSetting], room_pt: f64) -> String {
    let before = Some((word, word)).filter(|_| !word.is_empty());
    let written = settings.iter().map(|it| (&*it.markup, &*it.plain));
    let (markup, plain): (Vec<&str>, Vec<&str>) = before.into_iter().chain(written).unzip();
    within_room(markup.join(", "), &plain.join(", "), room_pt)
}
