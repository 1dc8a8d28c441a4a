//! CSVs that do not contain a run: the tables of a comparison, a sweep or a fit.

use crate::engine::export::layout::above_run_file;
use crate::engine::scenario::csv::{self, Csv};
use crate::engine::scenario::head::Head;
use crate::engine::scenario::{Problem, Problems};
use crate::engine::text::io_errors::unread;
use crate::engine::text::number::NOT_AVAILABLE;
use crate::studies::sweep::SweepFigure;
use crate::studies::sweep::axis::split_keys;
use serde::{Deserialize, Serialize};
use std::fs::File;
use std::io::BufReader;
use std::path::Path;

/// Maximum number of values in a table (rows times columns), enough for a sweep of several hundred thousand runs.
const MOST_TABLE_VALUES: usize = 4_000_000;

#[derive(Clone, Debug, PartialEq)]
pub enum TableSubject {
    Comparison(ComparisonSource),
    Sweep(SweepTable),
    /// Measured values and the values of the fitted model.
    Fit(FitTable),
}

/// The run whose schemes were compared.
#[derive(Clone, Debug, PartialEq)]
pub struct ComparisonSource {
    /// Its run file; empty if the table has none.
    pub run_file: String,
}

#[derive(Clone, Debug, PartialEq)]
pub struct SweepTable {
    /// The varied keys, slowest first; keys that vary together form one axis.
    pub axes: Vec<Vec<String>>,
    /// The scenario that the varied keys belong to.
    pub scenario: toml::Table,
    /// How the table is drawn by default.
    pub figure: SweepFigure,
}

impl SweepTable {
    /// Returns the varied keys in the order of their columns.
    pub fn varied(&self) -> impl DoubleEndedIterator<Item = &String> {
        self.axes.iter().flatten()
    }

    pub fn has_varied(&self, name: &str) -> bool {
        self.varied().any(|key| key == name)
    }
}

#[derive(Clone, Debug, PartialEq)]
pub struct FitTable {
    /// The columns that locate each measured value: the time, or the settings.
    pub settings: Vec<String>,
    /// The run file of the fitted scenario.
    pub run_file: String,
    /// The fitted values of the free keys.
    pub found: Vec<FittedKey>,
}

/// A fitted key in the header of a fit's CSV.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FittedKey {
    pub key: String,
    pub value: f64,
    /// One standard uncertainty, in the unit of the key.
    pub uncertainty: Option<f64>,
}

/// The last columns of a fit's CSV, after the row number and the settings.
pub const FIT_COLUMNS: [&str; 6] = [
    "quantity",
    "measured",
    "uncertainty",
    "model",
    "residual",
    "residual_sigmas",
];

#[derive(Clone, Debug)]
pub struct TableSource {
    pub subject: TableSubject,
    /// The title in the table's header, or empty.
    pub title: String,
    /// The file name as the user typed it. `text` holds the content.
    pub origin: String,
    pub text: String,
    csv: Csv,
}

impl TableSource {
    /// Reads the table in the file `path`. Returns `None` if the file is a run or not a CSV.
    ///
    /// # Errors
    /// Returns an error if the file cannot be read or parsed, or if it is the `.part` file of an unfinished sweep.
    pub fn read(path: &Path) -> Result<Option<Self>, Problems> {
        let origin = path.display().to_string();
        let ending = path.extension().and_then(|ending| ending.to_str());
        let is_part = ending == Some("part");
        if !(ending == Some("csv") || is_part) || !path.is_file() {
            return Ok(None);
        }
        let head = File::open(path)
            .and_then(|file| Head::read(&mut BufReader::new(file)))
            .map_err(|error| Problems::one(origin.clone(), Problem::at("", unread(&error))))?;
        if subject(&head).is_none() {
            return Ok(None);
        }
        if is_part {
            let rule = "holds the rows of an unfinished sweep: repeat the command that started it to complete the file";
            return Err(Problems::one(origin, Problem::at("", rule)));
        }
        let text = csv::text(path).map_err(|problem| Problems::one(origin.clone(), problem))?;
        Self::from_csv(&origin, text)
    }

    /// Parses `text`, the content of the file `origin`. Returns `None` if it is not a table of this kind.
    pub fn from_csv(origin: &str, text: String) -> Result<Option<Self>, Problems> {
        let head = Head::read(&mut text.as_bytes()).ok();
        let Some((subject, title)) = head.and_then(|head| subject(&head)) else {
            return Ok(None);
        };
        let csv = Csv::parse(&text, MOST_TABLE_VALUES).map_err(|found| found.in_file(origin))?;
        let origin = origin.to_owned();
        Ok(Some(Self {
            subject,
            title,
            origin,
            text,
            csv,
        }))
    }

    pub fn names(&self) -> &[String] {
        &self.csv.names
    }

    pub fn count(&self) -> usize {
        self.csv.rows.len()
    }

    /// Returns the cells of the column `name` as text.
    pub fn texts(&self, name: &str) -> Option<Vec<&str>> {
        Some(self.csv.column(name)?.collect())
    }

    /// Returns the numbers of the column `name`, with NaN for empty cells. Returns `None` if a cell is not a number.
    pub fn numbers(&self, name: &str) -> Option<Vec<f64>> {
        self.csv
            .column(name)?
            .map(|text| match text.trim() {
                "" | NOT_AVAILABLE => Some(f64::NAN),
                "true" => Some(1.0),
                "false" => Some(0.0),
                text => text.parse().ok(),
            })
            .collect()
    }
}

/// Returns the kind of table with this head, and its title; `None` if it is not a table of this kind.
fn subject(head: &Head) -> Option<(TableSubject, String)> {
    let first_line = String::from_utf8_lossy(head.names());
    let names: Vec<&str> = first_line
        .split(',')
        .map(|name| name.trim_matches('"'))
        .collect();
    let header = head.header().unwrap_or_default();
    let parsed: Option<toml::Table> = header.parse().ok();
    let of_comparison = ["scheme", "time_step_s", "error_m"];
    if of_comparison.iter().all(|name| names.contains(name)) {
        let title = parsed.as_ref().map(title_in).unwrap_or_default();
        let source = ComparisonSource { run_file: header };
        return Some((TableSubject::Comparison(source), title));
    }
    let table = parsed?;
    if let Some(settings) = settings_of_fit(&names) {
        let fit = FitTable {
            settings,
            found: found(&header),
            run_file: header,
        };
        return Some((TableSubject::Fit(fit), title_in(&table)));
    }
    let vary = table.get("vary")?.as_array()?;
    let keys = vary.iter().filter_map(|vary| vary.get("key")?.as_str());
    let axes = keys.map(|key| split_keys(key).map(str::to_owned).collect());
    let figure = table.get("figure").cloned();
    let figure = figure.and_then(|figure| figure.try_into().ok());
    let of_scenario = table.get("scenario").and_then(toml::Value::as_table);
    let title = match title_in(&table) {
        own if own.is_empty() => of_scenario.map(title_in).unwrap_or_default(),
        own => own,
    };
    let scenario = of_scenario.cloned().unwrap_or_default();
    let sweep = SweepTable {
        axes: axes.collect(),
        scenario,
        figure: figure.unwrap_or_default(),
    };
    Some((TableSubject::Sweep(sweep), title))
}

/// Returns the title in `table`, or an empty text.
fn title_in(table: &toml::Table) -> String {
    let title = table.get("title").and_then(toml::Value::as_str);
    title.unwrap_or_default().to_owned()
}

/// Returns the fitted keys in the `header` of a fit's CSV, or nothing if they cannot be parsed.
fn found(header: &str) -> Vec<FittedKey> {
    #[derive(Deserialize)]
    struct AboveRunFile {
        key: Vec<FittedKey>,
    }
    let above: Option<AboveRunFile> = toml::from_str(&above_run_file(header)).ok();
    above.map(|above| above.key).unwrap_or_default()
}

/// Returns the setting columns of a fit's CSV; `None` if the columns `names` are not a fit's.
fn settings_of_fit(names: &[&str]) -> Option<Vec<String>> {
    let (row, rest) = names.split_first()?;
    let count = rest.len().checked_sub(FIT_COLUMNS.len())?;
    let settings = rest[..count].iter().map(|name| (*name).to_owned());
    (*row == "row" && rest[count..] == FIT_COLUMNS).then(|| settings.collect())
}
