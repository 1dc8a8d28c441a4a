//! Reads a file of measured data, from its text to checked numbers.

use super::hint::hint;
use super::names::{Columns, may_be, named};
use super::numbers::CellParser;
use super::quantity::TIME_COLUMN;
use super::sigma::set_sigmas;
use super::spellings::{depends_on_name, name_columns, read_as};
use super::{ColumnOptions, DataKind, MeasuredData};
use crate::scenario::csv::{self, Csv};
use crate::scenario::problem::{at_line, nearest};
use crate::scenario::{Document, Problem, Problems};
use crate::text::shipped::{Shipped, shipped};
use std::borrow::Cow;
use std::path::Path;
use toml::Value;

/// Maximum number of values in a file, rows times columns.
const MOST_DATA_VALUES: usize = 1_000_000;

/// Measured data that are compiled into the program.
pub const SHIPPED: &[Shipped] = shipped!["../../../presets/measured", "csv":
    "heidelberg-body-cone"
    "heidelberg-nutation"
    "heidelberg-precession"
    "heidelberg-spin-decay"
];

pub fn find_shipped(name: &str) -> Option<&'static Shipped> {
    Shipped::find(SHIPPED, name)
}

/// Opens data that come with the program, or a file. A file's name contains a `/` or ends in `.csv`.
pub fn open(name: &str) -> Result<MeasuredData, Problems> {
    open_with(name, &ColumnOptions::default())
}

/// Does the same as [`open`], with the user's options for its columns.
pub fn open_with(name: &str, options: &ColumnOptions) -> Result<MeasuredData, Problems> {
    read_with(name, &text(name)?, options)
}

pub fn text(name: &str) -> Result<Cow<'static, str>, Problems> {
    if let Some(shipped) = find_shipped(name) {
        return Ok(shipped.text.into());
    }
    let path = Path::new(name);
    if !name.contains('/') && !name.contains('.') && !path.exists() {
        let near = nearest(name, SHIPPED.iter().map(|data| data.name));
        let rule = format!(
            "no measured data of that name: {near} (a file's name contains a / or ends in .csv)"
        );
        return Err(Problems::one(name, Problem::at("", rule)));
    }
    let text = csv::text(path).map_err(|problem| Problems::one(name, problem))?;
    Ok(text.into())
}

/// Returns the error message if `text`, which is not valid as measured data, is a scenario.
fn scenario_instead(origin: &str, text: &str) -> Option<Problems> {
    const OF_SCENARIOS: [&str; 3] = ["body", "start", "motion"];
    let document = Document::parse_header(origin, text).ok()?;
    let rule = "is a scenario, not measured data: give it as SCENARIO (gyrolab SCENARIO --measured FILE.csv, gyrolab fit FILE.csv --in SCENARIO); measured data are a CSV, see gyrolab man fit";
    let is_scenario = OF_SCENARIOS
        .into_iter()
        .any(|name| document.table().get(name).is_some_and(Value::is_table));
    is_scenario.then(|| Problems::one(origin, Problem::at("", rule)))
}

/// Reads the measured data in `text`, the content of the file `origin`.
pub fn read(origin: &str, text: &str) -> Result<MeasuredData, Problems> {
    read_with(origin, text, &ColumnOptions::default())
}

/// Does the same as [`read`], with the user's options for its columns.
pub fn read_with(
    origin: &str,
    text: &str,
    options: &ColumnOptions,
) -> Result<MeasuredData, Problems> {
    let (cells, columns) = taken_apart(origin, text, options)
        .map_err(|found| scenario_instead(origin, text).unwrap_or_else(|| found.in_file(origin)))?;
    let mut numbers = CellParser::new(&cells);
    let mut data = if columns.read.iter().any(|column| column.name == TIME_COLUMN) {
        DataKind::Series(numbers.series(&columns.read))
    } else {
        DataKind::Table(numbers.table(&columns.read))
    };
    let mut left_out = columns.left_out;
    left_out.append(&mut numbers.left_out);
    let mut found = numbers.found;
    found.kept(set_sigmas(&mut data, &cells, &options.sigma));
    let mut measured = MeasuredData {
        origin: origin.to_owned(),
        text: text.into(),
        until_s: None,
        about: cells.header.clone(),
        left_out,
        read_as: read_as(&cells),
        rows_before: 0,
        rows_outside: 0,
        lines: cells.rows.iter().map(|(line, _)| *line).collect(),
        data,
    };
    if found.list.is_empty() && measured.keep_rows(|_| true) == 0 {
        found.add(|| {
            Problem::at(
                "",
                "has no measured value: all cells of its measured columns are empty",
            )
        });
    }
    if found.list.is_empty() && !measured.leave_out_rows_before_0() {
        let rule = "has no value measured at t = 0 or later: a run begins at t = 0, so count the time from there";
        found.add(|| Problem::at("", rule));
    }
    if found.list.is_empty() {
        // Information that is not in the text itself is written into it.
        if let DataKind::Series(series) = &measured.data
            && (options.is_some() || depends_on_name(&cells))
        {
            measured.text = series.to_csv().into();
        }
        return Ok(measured);
    }
    // Columns are read one after the other, but people correct a file from top to bottom.
    found.list.sort_by_key(|problem| {
        let place = problem.place.as_deref()?.strip_prefix("line ")?;
        place.parse::<u64>().ok()
    });
    Err(found.in_file(origin))
}

/// Returns the cells of `text`, the file `origin`, and the roles of its columns.
fn taken_apart(
    origin: &str,
    text: &str,
    options: &ColumnOptions,
) -> Result<(Csv, Columns), Problems> {
    let mut cells = Csv::parse(text, MOST_DATA_VALUES)?;
    cells.rename(&options.map, may_be)?;
    let known = name_columns(&mut cells, origin, |_| true).and_then(|()| named(&cells));
    let mut problems = match known {
        Ok(columns) => return Ok((cells, columns)),
        Err(problems) => problems,
    };
    if let Some(last) = problems.last_mut() {
        last.rule += &hint(&cells, &options.map, origin);
    }
    Err(problems
        .into_iter()
        .map(|problem| at_line(cells.line_of_names, problem))
        .collect::<Vec<_>>()
        .into())
}
