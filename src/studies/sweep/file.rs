//! The shape of sweep files, read with a place for everything that is wrong; and shards, the parts of a sweep's points for
//! several machines.

use crate::engine::scenario::document::Document;
use crate::engine::scenario::float;
use crate::engine::scenario::kind::Range;
use crate::engine::scenario::kind::ValueKind::{By, Flag, Line, Lines, Number, Paragraph, Whole};
use crate::engine::scenario::problem::nearest;
use crate::engine::scenario::schema::{Schema, may, must};
use crate::engine::scenario::{Problem, Problems, ScenarioFile};
use serde::{Deserialize, Serialize};
use std::fmt;
use std::ops;
use std::str::FromStr;
use toml::{Table, Value};

/// A sweep as its file tells it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SweepFile {
    /// The version that wrote the file; only in the header of a CSV.
    pub gyrolab: Option<String>,
    /// What it is called; without one, as the scenario is.
    pub title: Option<String>,
    pub about: Option<String>,
    pub source: Option<String>,
    /// `K/N`: of its rows only those of this shard.
    pub shard: Option<String>,
    /// The readouts; without any, every number.
    pub measure: Option<Vec<String>>,
    /// How its table is drawn where the command line says nothing else.
    pub figure: Option<SweepFigure>,
    #[serde(default)]
    pub vary: Vec<VaryFile>,
    pub scenario: Base,
}

/// The scenario of a sweep, the key `scenario` of its file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Base {
    /// The name of a preset, or a file's path from the sweep file on.
    Name(String),
    /// The scenario itself, as it is written.
    Written(Table),
    /// The scenario itself, checked.
    #[serde(skip_deserializing)]
    Checked(Box<ScenarioFile>),
}

/// A key that varies, a table `[[vary]]` of a sweep's file.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct VaryFile {
    /// The dotted key, or several with `+` between them, which vary together.
    pub key: String,
    pub values: Option<Vec<Value>>,
    /// The first of evenly spaced values, where `values` has none.
    pub from: Option<f64>,
    pub to: Option<f64>,
    pub count: Option<u64>,
    /// Whether these have equal ratios, not equal distances.
    pub log: Option<bool>,
}

/// How the table of a sweep is drawn, the table `[figure]` of a sweep's file; the options of `gyrolab figure` have the same
/// names.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SweepFigure {
    /// `map`; without it, curves.
    pub kind: Option<String>,
    /// The column along the axis below: a key that varies, or a readout.
    pub x: Option<String>,
    /// The readouts, a panel for each quantity.
    pub y: Option<Vec<String>>,
    /// The logarithmic axes: `x`, `y`, or `z` for the colors of a map.
    pub log: Option<String>,
    pub x_range: Option<[f64; 2]>,
}

/// The kind of a figure that shows two keys as a map of colors.
pub const MAP: &str = "map";

impl SweepFigure {
    /// Returns what is wrong with it in a sweep of the keys `varied` and the readouts `measured`.
    pub(super) fn problems(&self, varied: &[&str], measured: &[&str]) -> Vec<Problem> {
        let mut problems = Vec::new();
        if self.kind.as_ref().is_some_and(|kind| kind != MAP) {
            problems.push(Problem::at(
                "figure.kind",
                "must be map, or is left out for curves",
            ));
        }
        let x = self.x.iter().map(|name| ("figure.x", name));
        let y = self.y.iter().flatten().map(|name| ("figure.y", name));
        for (key, name) in x.chain(y) {
            let mut columns = varied.iter().chain(measured);
            if !columns.any(|column| column == name) {
                let near = nearest(name, varied.iter().chain(measured).copied());
                let rule = format!("is no column of this sweep: {near}");
                problems.push(Problem::with_value(key, &Value::String(name.clone()), rule));
            }
        }
        let is_log = |text: &String| text.chars().all(|axis| "xyz".contains(axis));
        if !self.log.iter().all(is_log) {
            problems.push(Problem::at(
                "figure.log",
                "must be x, y, z, or several of them, such as xy",
            ));
        }
        if self.x_range.is_some_and(|[low, high]| low >= high) {
            problems.push(Problem::at(
                "figure.x_range",
                "must be two numbers, the lower one first",
            ));
        }
        problems
    }
}

#[rustfmt::skip]
const SWEEP_SCHEMA: Schema = Schema(&[&[
    may("gyrolab", Line, "version of gyrolab that wrote the file"),
    may("title", Line, "name of the sweep"),
    may("about", Paragraph, ""),
    may("source", Paragraph, ""),
    may("shard", Line, "K/N: only the rows of this shard"),
    may("measure", Lines, "the readouts"),
    must("vary.*.key", Line, "the dotted key that varies, or several with + between them"),
    may("vary.*.values", By(is_list), "its values"),
    may("vary.*.from", Number(Range::Any), "the first of evenly spaced values"),
    may("vary.*.to", Number(Range::Any), "the last of them"),
    may("vary.*.count", Whole(0, i64::MAX), "how many there are"),
    may("vary.*.log", Flag, "whether they have equal ratios"),
    may("figure.kind", Line, "map for a map of colors; curves without it"),
    may("figure.x", Line, "the column along the axis below"),
    may("figure.y", Lines, "the readouts that are drawn"),
    may("figure.log", Line, "the logarithmic axes: x, y, z for the colors of a map"),
    may("figure.x_range", By(is_range), "from where to where the axis below goes"),
    must("scenario", By(is_scenario), "a preset's name, a file's path, or a table [scenario] with the scenario itself"),
]]);

fn is_list(value: &Value) -> Result<(), String> {
    match value {
        Value::Array(_) => Ok(()),
        _ => Err("must be a list in brackets".to_owned()),
    }
}

fn is_range(value: &Value) -> Result<(), String> {
    let numbers: Option<Vec<f64>> = value
        .as_array()
        .and_then(|list| list.iter().map(float).collect());
    match numbers {
        Some(numbers) if numbers.len() == 2 && numbers.iter().all(|it| it.is_finite()) => Ok(()),
        _ => Err("must be two numbers in brackets, such as [0, 1]".to_owned()),
    }
}

fn is_scenario(value: &Value) -> Result<(), String> {
    match value {
        Value::String(_) | Value::Table(_) => Ok(()),
        _ => Err("must be a preset's name, a file's path, or a table".to_owned()),
    }
}

impl Default for Base {
    fn default() -> Self {
        Self::Written(Table::new())
    }
}

impl SweepFile {
    /// Parses the sweep in `document`; what its values mean is not checked.
    pub fn read(document: &Document) -> Result<Self, Problems> {
        let table = document.table();
        let problems = SWEEP_SCHEMA.check(table);
        problems
            .or(())
            .map_err(|problems| document.placed(problems))?;
        let file = table.clone().try_into();
        file.map_err(|error: toml::de::Error| document.placed(Problem::at("", error.message())))
    }

    pub fn to_toml(&self) -> String {
        // It holds nothing that TOML cannot write.
        toml::to_string(self).unwrap_or_default()
    }
}

/// The shard `number` of `of`: of the points in their order the `number`-th of `of` ranges, which are as long as each other
/// or differ by one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    pub number: u64,
    pub of: u64,
}

const MOST_SHARDS: u64 = 1_000_000;

impl Shard {
    pub const WHOLE: Self = Self { number: 1, of: 1 };

    /// The points, of all `points` of a sweep, that belong to it.
    pub fn range(self, points: u64) -> ops::Range<u64> {
        // Both are small enough for u64.
        points * (self.number - 1) / self.of..points * self.number / self.of
    }
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let numbers = text.split_once('/');
        let numbers =
            numbers.and_then(|(number, of)| Some((number.parse().ok()?, of.parse().ok()?)));
        match numbers {
            Some((number, of)) if (1..=of).contains(&number) && of <= MOST_SHARDS => {
                Ok(Self { number, of })
            }
            Some((number, of)) if number > of && (1..=MOST_SHARDS).contains(&of) => {
                Err(format!("must be one of the shards 1/{of} to {of}/{of}"))
            }
            _ => Err(format!(
                "must be K/N, such as 3/8: the K-th of N shards, K from 1, N at most {MOST_SHARDS}"
            )),
        }
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.number, self.of)
    }
}
