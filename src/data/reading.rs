//! A file of measured data, from its text to checked numbers.

use super::instruments::name_columns;
use super::names::named;
use super::numbers::Numbers;
use super::quantity::TIME;
use super::{Data, Measured};
use crate::scenario::csv::{self, Csv, Renaming};
use crate::scenario::problem::nearest;
use crate::scenario::{Document, Problem, Problems};
use crate::text::shipped::{Shipped, shipped};
use std::borrow::Cow;
use std::path::Path;
use toml::Value;

/// The most values of one file, rows times columns.
const MOST_VALUES: usize = 1_000_000;

/// The measured data that come with the program, compiled in.
pub const SHIPPED: &[Shipped] = shipped!["measured", "csv":
    "heidelberg-body-cone"
    "heidelberg-nutation"
    "heidelberg-precession"
    "heidelberg-spin-decay"
];

pub fn find_shipped(name: &str) -> Option<&'static Shipped> {
    Shipped::find(SHIPPED, name)
}

/// Opens what `name` names: data that come with the program, or else a file. A file's name holds a `/` or ends in `.csv`.
pub fn open(name: &str) -> Result<Measured, Problems> {
    open_with(name, &[])
}

/// The same, with columns renamed first.
pub fn open_with(name: &str, map: &[Renaming]) -> Result<Measured, Problems> {
    read_with(name, &text(name)?, map)
}

pub fn text(name: &str) -> Result<Cow<'static, str>, Problems> {
    if let Some(shipped) = find_shipped(name) {
        return Ok(shipped.text.into());
    }
    let path = Path::new(name);
    if !name.contains('/') && !name.contains('.') && !path.exists() {
        let near = nearest(name, SHIPPED.iter().map(|data| data.name));
        let rule = format!(
            "no measured data of that name: {near} (a file's name holds a / or ends in .csv)"
        );
        return Err(Problems::one(name, Problem::at("", rule)));
    }
    let text = csv::text(path).map_err(|problem| Problems::one(name, problem))?;
    Ok(text.into())
}

/// What is said where `text`, which is refused as measured data, is a scenario.
fn scenario_instead(origin: &str, text: &str) -> Option<Problems> {
    const OF_SCENARIOS: [&str; 3] = ["body", "start", "motion"];
    let document = Document::parse_header(origin, text).ok()?;
    let is_table = |name: &str| document.table().get(name).is_some_and(Value::is_table);
    let rule = "is a scenario, and no measured data: it stands where SCENARIO does (gyrolab SCENARIO --measured FILE.csv, gyrolab fit FILE.csv --in SCENARIO); measured data are a CSV, which gyrolab man fit describes";
    let is_scenario = OF_SCENARIOS.into_iter().any(is_table);
    is_scenario.then(|| Problems::one(origin, Problem::at("", rule)))
}

/// Reads the measured data that `text` holds, which is the file `origin`.
pub fn read(origin: &str, text: &str) -> Result<Measured, Problems> {
    read_with(origin, text, &[])
}

/// The same, with columns renamed first.
pub fn read_with(origin: &str, text: &str, map: &[Renaming]) -> Result<Measured, Problems> {
    let taken_apart = || {
        let mut cells = Csv::of(text, MOST_VALUES)?;
        cells.rename(map, |_| true)?;
        name_columns(&mut cells);
        Ok((named(&cells)?, cells))
    };
    let ((columns, left_out), cells) = taken_apart().map_err(|found: Problems| {
        scenario_instead(origin, text).unwrap_or_else(|| found.of(origin))
    })?;
    let mut numbers = Numbers::of(&cells);
    let data = if columns.iter().any(|column| column.name == TIME) {
        Data::Series(numbers.series(&columns))
    } else {
        Data::Table(numbers.table(&columns))
    };
    let renamed = match &data {
        Data::Series(series) if !map.is_empty() => Some(series.to_csv()),
        _ => None,
    };
    let mut measured = Measured {
        origin: origin.to_owned(),
        text: renamed.as_deref().unwrap_or(text).into(),
        until_s: None,
        about: cells.header.clone(),
        left_out,
        lines: cells.rows.iter().map(|(line, _)| *line).collect(),
        data,
    };
    let mut found = numbers.found;
    if found.list.is_empty() && measured.keep_rows(|_| true) == 0 {
        found.add(|| {
            Problem::at(
                "",
                "holds no measured value: every place of its measured columns is empty",
            )
        });
    }
    if found.list.is_empty() {
        return Ok(measured);
    }
    // Columns are read one after the other, and a file is mended from its top to its end.
    let line = |problem: &Problem| {
        let place = problem.place.as_deref()?.strip_prefix("line ")?;
        place.parse::<u64>().ok()
    };
    found.list.sort_by_key(line);
    Err(found.of(origin))
}
