//! The shape of sweep files, read with a place for everything that is wrong; and shards, the parts of a sweep's points for
//! several machines.

use crate::engine::scenario::document::Document;
use crate::engine::scenario::dotted::join;
use crate::engine::scenario::keys::{Range, ValueKind};
use crate::engine::scenario::problem::nearest;
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
    pub key: String,
    pub values: Option<Vec<Value>>,
    /// The first of evenly spaced values, where `values` has none.
    pub from: Option<f64>,
    pub to: Option<f64>,
    pub count: Option<u64>,
}

/// The keys of a sweep file and of `[[vary]]`, with what each may hold; the others are checked one by one.
const SWEEP_FILE_KEYS: [(&str, Option<ValueKind>); 8] = [
    ("gyrolab", Some(ValueKind::Line)),
    ("title", Some(ValueKind::Line)),
    ("about", Some(ValueKind::Paragraph)),
    ("source", Some(ValueKind::Paragraph)),
    ("shard", Some(ValueKind::Line)),
    ("measure", None),
    ("vary", None),
    ("scenario", None),
];
const VARY_KEYS: [(&str, Option<ValueKind>); 5] = [
    ("key", Some(ValueKind::Line)),
    ("values", None),
    ("from", Some(ValueKind::Number(Range::Any))),
    ("to", Some(ValueKind::Number(Range::Any))),
    ("count", Some(ValueKind::Whole(0, i64::MAX))),
];

impl Default for Base {
    fn default() -> Self {
        Self::Written(Table::new())
    }
}

impl SweepFile {
    /// The sweep in `document`; what its values mean is not checked.
    pub fn read(document: &Document) -> Result<Self, Problems> {
        let table = document.table();
        let mut problems = check(table, "", &SWEEP_FILE_KEYS);
        let mut refuse = |key: &str, rule: &str| problems.push(refused(table, "", key, rule));
        if !are_all(table.get("measure"), Value::is_str) {
            refuse("measure", "must be a list of names in brackets");
        }
        if !matches!(
            table.get("scenario"),
            Some(Value::String(_) | Value::Table(_))
        ) {
            refuse(
                "scenario",
                "is missing, or is neither a preset's name, nor a file's path, nor a table [scenario] with the scenario itself",
            );
        }
        let vary = table.get("vary");
        if !are_all(vary, Value::is_table) {
            refuse("vary", "must be tables: write [[vary]]");
        }
        let tables = vary.and_then(Value::as_array).into_iter().flatten();
        for (index, table) in tables.filter_map(Value::as_table).enumerate() {
            problems.extend(check_vary(table, &format!("vary.{index}")));
        }
        if !problems.is_empty() {
            return Err(document.placed(problems));
        }
        let file = table.clone().try_into();
        file.map_err(|error: toml::de::Error| {
            document.placed(vec![Problem::at("", error.message().to_owned())])
        })
    }

    pub fn to_toml(&self) -> String {
        // It holds nothing that TOML cannot write.
        toml::to_string(self).unwrap_or_default()
    }
}

/// Whether `list`, if it is there, is a list whose values all are so.
fn are_all(list: Option<&Value>, is_so: fn(&Value) -> bool) -> bool {
    list.is_none_or(|list| list.as_array().is_some_and(|all| all.iter().all(is_so)))
}

/// What is wrong with the `table` `[[vary]]` that stands at `path`.
fn check_vary(table: &Table, path: &str) -> Vec<Problem> {
    let mut problems = check(table, path, &VARY_KEYS);
    let mut refuse = |key: &str, rule: &str| problems.push(refused(table, path, key, rule));
    if !table.contains_key("key") {
        refuse("key", "is missing: the dotted key that varies");
    }
    if !table.get("values").is_none_or(Value::is_array) {
        refuse("values", "must be a list in brackets");
    }
    problems
}

/// The key `name` of `table`, which stands at `path`, breaks a `rule`.
fn refused(table: &Table, path: &str, name: &str, rule: &str) -> Problem {
    let key = join(path, name);
    match table.get(name) {
        Some(value) => Problem::with_value(key, value, rule),
        None => Problem::at(key, rule),
    }
}

/// What is wrong with the names in `table`, which stands at `path`, and with the values of `known` kinds.
fn check(table: &Table, path: &str, known: &[(&str, Option<ValueKind>)]) -> Vec<Problem> {
    let problem = |(name, value): (&String, &Value)| {
        let Some((_, kind)) = known.iter().find(|(known, _)| known == name) else {
            let near = nearest(name, known.iter().map(|(known, _)| *known));
            let key = join(path, name);
            return Some(Problem::at(key, format!("unknown key: {near}")));
        };
        let rule = kind.and_then(|kind| kind.check(value).err())?;
        Some(refused(table, path, name, &rule))
    };
    table.iter().filter_map(problem).collect()
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
        let begin = |number| points * number / self.of; // both are small enough for u64
        begin(self.number - 1)..begin(self.number)
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
