//! A CSV that is no run: the table of a comparison, of a sweep, or of a fit.

use crate::export::comments::above_run_file;
use crate::scenario::Problem;
use crate::text::number::NONE;
use crate::text::unread;
use serde::{Deserialize, Serialize};
use std::fs::File;
use std::io::{BufRead, BufReader};
use std::path::Path;

/// The longest file that is drawn, bytes: a sweep of some hundred thousand runs.
const LONGEST: u64 = 32 << 20;

/// What kind of table it is.
#[derive(Clone, Debug, PartialEq)]
pub enum Subject {
    /// Errors of schemes over time steps.
    Comparison,
    /// Readouts over what was varied.
    Sweep {
        /// The keys that were varied, the last of which runs fastest.
        varied: Vec<String>,
        /// The scenario, in which the keys have their names.
        scenario: toml::Table,
    },
    /// What was measured, and what a fitted model says of it.
    Fit {
        /// The columns that say where each value was measured: the time, or settings.
        settings: Vec<String>,
        /// The run file of the fitted scenario.
        run_file: String,
        /// What was found for the free keys.
        found: Vec<Found>,
    },
}

/// What was found for a key by a fit, as it stands above the run file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Found {
    /// The key.
    pub key: String,
    /// Its value.
    pub value: f64,
    /// One standard uncertainty of it.
    pub uncertainty: Option<f64>,
}

/// The columns of a fit, behind those that say where each value was measured.
pub const OF_FIT: [&str; 6] = [
    "quantity",
    "measured",
    "uncertainty",
    "model",
    "residual",
    "residual_sigmas",
];

/// The columns of a table.
#[derive(Clone, Debug)]
pub struct Table {
    /// What kind of table it is.
    pub subject: Subject,
    /// The title in its header, or empty.
    pub title: String,
    /// The names of its columns.
    pub names: Vec<String>,
    /// Its rows, as they are written.
    rows: Vec<Vec<String>>,
}

impl Table {
    /// The table in the file `path`; `None` where that is a run or no CSV.
    ///
    /// # Errors
    /// When it is a table and cannot be read.
    pub fn read(path: &Path) -> Result<Option<Self>, Problem> {
        let is_part = path.extension().is_some_and(|ending| ending == "part");
        let is_csv = path.extension().is_some_and(|ending| ending == "csv");
        if !(is_csv || is_part) || !path.is_file() {
            return Ok(None);
        }
        let refused = |error: std::io::Error| Problem::at("", unread::why(&error));
        let file = File::open(path).map_err(refused)?;
        let size = file.metadata().map_err(refused)?.len();
        let mut lines = BufReader::new(file);
        let (header, names) = head(&mut lines).map_err(refused)?;
        let Some((subject, title)) = subject(&header, &names) else {
            return Ok(None);
        };
        if is_part {
            let rule = "holds the rows of a sweep that is not whole yet: the command that began it goes on with it, and the file gets its name";
            return Err(Problem::at("", rule));
        }
        if size > LONGEST {
            let most = LONGEST >> 20;
            let rule = format!("is longer than {most} MiB, the most that is drawn: leave rows out");
            return Err(Problem::at("", rule));
        }
        let mut reader = csv::ReaderBuilder::new()
            .has_headers(false)
            .flexible(true)
            .from_reader(lines);
        let mut rows = Vec::new();
        for (index, row) in reader.records().enumerate() {
            let row = row.map_err(|error| Problem::at("", format!("cannot be read: {error}")))?;
            if row.len() != names.len() {
                let rule = format!(
                    "row {}: has {} values, and {} columns have a name",
                    index + 1,
                    row.len(),
                    names.len()
                );
                return Err(Problem::at("", rule));
            }
            rows.push(row.iter().map(str::to_owned).collect());
        }
        if rows.is_empty() {
            return Err(Problem::at("", "has no rows: there is nothing to draw"));
        }
        Ok(Some(Self {
            subject,
            title,
            names,
            rows,
        }))
    }

    /// How many rows it has.
    pub fn count(&self) -> usize {
        self.rows.len()
    }

    /// The texts of the column of that name.
    pub fn texts(&self, name: &str) -> Option<Vec<&str>> {
        let place = self.names.iter().position(|other| other == name)?;
        Some(self.rows.iter().map(|row| row[place].as_str()).collect())
    }

    /// The numbers of the column of that name, NaN where there is none; `None` where the column has texts that are no numbers.
    pub fn numbers(&self, name: &str) -> Option<Vec<f64>> {
        let number = |text: &str| match text.trim() {
            "" | NONE => Some(f64::NAN),
            "true" => Some(1.0),
            "false" => Some(0.0),
            text => text.parse().ok(),
        };
        self.texts(name)?.into_iter().map(number).collect()
    }
}

/// The lines of comments at the begin of a CSV without their marks, and the names of its columns.
fn head(lines: &mut impl BufRead) -> std::io::Result<(String, Vec<String>)> {
    let mut header = String::new();
    let mut line = Vec::new();
    loop {
        line.clear();
        if lines.read_until(b'\n', &mut line)? == 0 {
            return Ok((header, Vec::new()));
        }
        let text = String::from_utf8_lossy(&line);
        let text = text.trim_start_matches('\u{feff}').trim_end();
        match text.strip_prefix('#') {
            Some(comment) => {
                header.push_str(comment.strip_prefix(' ').unwrap_or(comment));
                header.push('\n');
            }
            None => {
                let names = text
                    .split(',')
                    .map(|name| name.trim_matches('"').to_owned());
                return Ok((header, names.collect()));
            }
        }
    }
}

fn subject(header: &str, names: &[String]) -> Option<(Subject, String)> {
    let table: Option<toml::Table> = header.parse().ok();
    let title = |table: &toml::Table| {
        let title = table.get("title").and_then(toml::Value::as_str);
        title.unwrap_or_default().to_owned()
    };
    let has = |name: &str| names.iter().any(|other| other == name);
    if has("scheme") && has("time_step_s") && has("error_m") {
        let title = table.as_ref().map(title).unwrap_or_default();
        return Some((Subject::Comparison, title));
    }
    let table = table?;
    if let Some(settings) = settings_of_fit(names) {
        let fit = Subject::Fit {
            settings,
            run_file: header.to_owned(),
            found: found(header),
        };
        return Some((fit, title(&table)));
    }
    let vary = table.get("vary")?.as_array()?;
    let keys = vary.iter().filter_map(|vary| vary.get("key")?.as_str());
    let varied: Vec<String> = keys.map(str::to_owned).collect();
    let of_scenario = table.get("scenario").and_then(toml::Value::as_table);
    let title = match title(&table) {
        own if own.is_empty() => of_scenario.map(title).unwrap_or_default(),
        own => own,
    };
    let scenario = of_scenario.cloned().unwrap_or_default();
    Some((Subject::Sweep { varied, scenario }, title))
}

/// What was found by the fit in whose CSV this is the `header`; nothing where that does not tell.
fn found(header: &str) -> Vec<Found> {
    #[derive(Deserialize)]
    struct AboveRunFile {
        key: Vec<Found>,
    }
    let above: Option<AboveRunFile> = toml::from_str(&above_run_file(header)).ok();
    above.map(|above| above.key).unwrap_or_default()
}

/// The columns of the CSV of a fit that say where its values were measured; `None` where it is none.
fn settings_of_fit(names: &[String]) -> Option<Vec<String>> {
    let (row, rest) = names.split_first()?;
    let count = rest.len().checked_sub(OF_FIT.len())?;
    (row == "row" && rest[count..] == OF_FIT).then(|| rest[..count].to_vec())
}
