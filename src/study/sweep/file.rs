//! The shape of sweep files, read with a place for everything that is wrong.

use crate::scenario::document::Document;
use crate::scenario::dotted::join;
use crate::scenario::keys;
use crate::scenario::problem::nearest;
use crate::scenario::{Problem, Problems, ScenarioFile};
use serde::Serialize;
use toml::{Table, Value};

/// A sweep as its file tells it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SweepFile {
    /// The version that wrote the file; only in the header of a CSV.
    pub gyrolab: Option<String>,
    /// What it is called; without one, as the scenario is.
    pub title: Option<String>,
    /// What it shows.
    pub about: Option<String>,
    /// Where it comes from.
    pub source: Option<String>,
    /// `K/N`: of its rows only those of this shard.
    pub shard: Option<String>,
    /// The readouts; without any, every number.
    pub measure: Option<Vec<String>>,
    /// What varies; the last fastest.
    pub vary: Vec<VaryFile>,
    /// What is run.
    pub scenario: Base,
}

/// The scenario of a sweep, the key `scenario` of its file.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Base {
    /// The name of a preset, or a file's path from the sweep file on.
    Name(String),
    /// The scenario itself, as it is written.
    Written(Table),
    /// The scenario itself, checked.
    Checked(Box<ScenarioFile>),
}

/// A key that varies, a table `[[vary]]` of a sweep's file.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct VaryFile {
    /// The dotted key.
    pub key: String,
    /// Its values, one by one.
    pub values: Option<Vec<Value>>,
    /// The first of evenly spaced values, where `values` has none.
    pub from: Option<f64>,
    /// The last of them.
    pub to: Option<f64>,
    /// How many there are.
    pub count: Option<u64>,
}

const KEYS: [&str; 8] = [
    "gyrolab", "title", "about", "source", "shard", "measure", "vary", "scenario",
];
const VARY_KEYS: [&str; 5] = ["key", "values", "from", "to", "count"];

impl SweepFile {
    /// A sweep that varies nothing yet.
    pub fn from_nothing() -> Self {
        Self {
            gyrolab: None,
            title: None,
            about: None,
            source: None,
            shard: None,
            measure: None,
            vary: Vec::new(),
            scenario: Base::Written(Table::new()),
        }
    }

    /// The sweep that `document` tells; what its values mean is not checked.
    ///
    /// # Errors
    /// Unknown keys, wrong types, what is missing.
    pub fn read(document: &Document) -> Result<Self, Problems> {
        let mut reader = Reader {
            table: document.table(),
            path: String::new(),
            problems: Vec::new(),
        };
        reader.know(&KEYS);
        let file = Self {
            gyrolab: reader.as_in_scenarios("gyrolab"),
            title: reader.as_in_scenarios("title"),
            about: reader.as_in_scenarios("about"),
            source: reader.as_in_scenarios("source"),
            shard: reader.text("shard"),
            measure: reader.words("measure"),
            vary: Vec::new(),
            scenario: reader.scenario(),
        };
        let vary = reader.varied();
        if reader.problems.is_empty() {
            Ok(Self { vary, ..file })
        } else {
            Err(document.placed(reader.problems))
        }
    }

    /// The file as TOML.
    pub fn to_toml(&self) -> String {
        // It holds nothing that TOML cannot write.
        toml::to_string(self).unwrap_or_default()
    }
}

/// Reads the values of one table, and notes what is wrong with them.
struct Reader<'a> {
    table: &'a Table,
    path: String,
    problems: Vec<Problem>,
}

impl<'a> Reader<'a> {
    fn refuse(&mut self, name: &str, rule: impl Into<String>) {
        let key = join(&self.path, name);
        self.problems.push(match self.table.get(name) {
            Some(value) => Problem::with_value(key, value, rule),
            None => Problem::at(key, rule),
        });
    }

    fn know(&mut self, known: &[&str]) {
        let unknown = self
            .table
            .keys()
            .filter(|name| !known.contains(&name.as_str()));
        for name in unknown.cloned().collect::<Vec<_>>() {
            let near = nearest(&name, known.iter().copied());
            let key = join(&self.path, &name);
            self.problems
                .push(Problem::at(key, format!("unknown key: {near}")));
        }
    }

    /// The value of `name`, if there is one and `read` takes it; `wanted` says what that would be.
    fn value<T>(
        &mut self,
        name: &str,
        wanted: &str,
        read: impl Fn(&'a Value) -> Option<T>,
    ) -> Option<T> {
        let value = self.table.get(name)?;
        let read = read(value);
        if read.is_none() {
            self.refuse(name, format!("must be {wanted}"));
        }
        read
    }

    fn text(&mut self, name: &str) -> Option<String> {
        self.value(name, "text", Value::as_str).map(str::to_owned)
    }

    /// The text of a key that scenarios have too, by their rule.
    fn as_in_scenarios(&mut self, name: &str) -> Option<String> {
        let value = self.table.get(name)?;
        if let Err(rule) = keys::find(name).and_then(|(_, kind)| kind.check(value)) {
            self.refuse(name, rule);
        }
        value.as_str().map(str::to_owned)
    }

    fn number(&mut self, name: &str) -> Option<f64> {
        let number = |value: &Value| match value {
            Value::Integer(whole) => Some(*whole as f64),
            other => other.as_float(),
        };
        self.value(name, "a number", number)
    }

    fn count(&mut self, name: &str) -> Option<u64> {
        let count = |value: &Value| u64::try_from(value.as_integer()?).ok();
        self.value(name, "a whole number, 0 or more", count)
    }

    fn words(&mut self, name: &str) -> Option<Vec<String>> {
        let words = |value: &Value| -> Option<Vec<String>> {
            let word = |value: &Value| value.as_str().map(str::to_owned);
            value.as_array()?.iter().map(word).collect()
        };
        self.value(name, "a list of names in brackets", words)
    }

    fn scenario(&mut self) -> Base {
        let is_one = |value: &Value| match value {
            Value::String(name) => Some(Base::Name(name.clone())),
            Value::Table(table) => Some(Base::Written(table.clone())),
            _ => None,
        };
        let wanted =
            "a preset's name, a file's path, or a table [scenario] with the scenario itself";
        let found = self.value("scenario", wanted, is_one);
        if !self.table.contains_key("scenario") {
            self.refuse("scenario", format!("is missing: it must be {wanted}"));
        }
        found.unwrap_or(Base::Written(Table::new()))
    }

    fn varied(&mut self) -> Vec<VaryFile> {
        let is_list = |list: &&Vec<Value>| list.iter().all(Value::is_table);
        let read = |value: &'a Value| value.as_array().filter(is_list);
        let Some(list) = self.value("vary", "tables: write [[vary]]", read) else {
            return Vec::new();
        };
        let tables = list.iter().filter_map(Value::as_table).enumerate();
        let mut all = Vec::new();
        for (index, table) in tables {
            let mut reader = Reader {
                table,
                path: format!("vary.{index}"),
                problems: Vec::new(),
            };
            reader.know(&VARY_KEYS);
            if !table.contains_key("key") {
                reader.refuse("key", "is missing: the dotted key that varies");
            }
            all.push(VaryFile {
                key: reader.text("key").unwrap_or_default(),
                values: reader.value("values", "a list in brackets", |value| {
                    value.as_array().cloned()
                }),
                from: reader.number("from"),
                to: reader.number("to"),
                count: reader.count("count"),
            });
            self.problems.append(&mut reader.problems);
        }
        all
    }
}
