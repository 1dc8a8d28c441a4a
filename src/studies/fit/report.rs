//! A fit as text, JSON and CSV.

use super::fitted::{Fitted, Sides};
use super::free::shown;
use super::model::Model;
use super::search::Fit;
use super::solution::student;
use crate::engine::data::quantity::TIME_COLUMN;
use crate::engine::data::{DataKind, Residual};
use crate::engine::export::layout::commented;
use crate::engine::scenario::Scenario;
use crate::engine::text::number::{NOT_AVAILABLE, short, shortest, significant, uncertain};
use crate::engine::text::printable::{printable, printable_lines};
use crate::engine::text::wrap::columns;
use crate::studies::table::{FIT_COLUMNS, FittedKey};
use serde::ser::Serializer;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use std::fmt;
use std::io::{self, Write};

#[derive(Clone, Copy, Debug)]
pub struct FitReport<'a> {
    pub fit: &'a Fit,
    pub model: &'a Model,
    /// The scheme of the scenario, if the runs use a different one.
    pub instead_of: Option<&'static str>,
}

/// Uncertainties of the two sides that differ by at most this fraction are shown as one.
const SAME_SIDES: f64 = 0.05;
/// Significant digits of a value without an uncertainty.
const REPORT_VALUE_DIGITS: usize = 7;

/// Formats `number` down to the second digit of `uncertainty`: 3.040e-4 for an uncertainty of 2.2e-6.
fn to_the_digit_of(number: f64, uncertainty: f64) -> String {
    let stated = uncertain(number, uncertainty).filter(|_| number != 0.0);
    stated.map_or_else(
        || significant(number, REPORT_VALUE_DIGITS),
        |stated| stated.to_the_same_digit(number),
    )
}

impl Fitted {
    /// Formats the value with its uncertainty: 0.003920(38), or 0.003920 +0.000042 -0.000038 if the two sides differ.
    pub fn stated(&self) -> String {
        if let Some(Sides { below, above }) = self.sides
            && (below - above).abs() > SAME_SIDES * below.max(above)
        {
            let value = to_the_digit_of(self.value, below.max(above));
            let [above, below] = [above, below].map(|side| to_the_digit_of(side, side));
            return format!("{value} +{above} -{below}");
        }
        let stated = self.sigma.and_then(|sigma| uncertain(self.value, sigma));
        match stated {
            Some(stated) => stated.to_string(),
            None => significant(self.value, REPORT_VALUE_DIGITS),
        }
    }

    fn json(&self) -> Value {
        json!({
            "key": self.free.key, "value": self.value, "uncertainty": self.sigma, "start": self.free.start,
            "uncertainty_below": self.sides.map(|sides| sides.below), "uncertainty_above": self.sides.map(|sides| sides.above),
            "from": finite(self.free.from), "to": finite(self.free.to), "is_at_bound": self.is_held,
        })
    }
}

impl FitReport<'_> {
    /// Returns remarks on the fit, one sentence each.
    pub fn remarks(&self) -> Vec<String> {
        let other = self.instead_of.map(|own| {
            format!(
                "The fitted runs use the scheme {}; the scenario's scheme is {own} (use --scheme {own} to fit with it).",
                self.model.scheme
            )
        });
        let remarks = other.into_iter().chain(self.fit.remarks());
        remarks.chain(self.fit.aliased(self.model)).collect()
    }

    /// Returns a short remark on a key, or an empty text.
    pub fn remark(&self, index: usize) -> String {
        let key = &self.fit.keys[index];
        let held = self.fit.edges.iter().filter(|edge| edge.holds[index]);
        let of_part: Vec<String> = held.filter_map(|edge| Some(edge.of_part()?.1)).collect();
        match (&of_part[..], key.is_held, key.sigma) {
            ([_, ..], ..) => format!("{}, at the bound", of_part.join(", ")),
            ([], true, _) => "at its bound".to_owned(),
            ([], false, None) => "no uncertainty can be stated".to_owned(),
            ([], false, Some(_)) => String::new(),
        }
    }

    fn keys(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let rows = self.fit.keys.iter().enumerate().map(|(index, key)| {
            let free = &key.free;
            let bounds = match (free.from.is_finite(), free.to.is_finite()) {
                (false, false) => String::new(),
                _ => format!("{}..{}", shown(free.from), shown(free.to)),
            };
            [
                free.key.clone(),
                key.stated(),
                shortest(free.start),
                bounds,
                self.remark(index),
            ]
        });
        write_table(f, ["key", "value", "initial guess", "bounds", ""], rows)
    }

    fn correlations(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let count = self.fit.keys.len();
        if count < 2 {
            return Ok(());
        }
        writeln!(f, "\nCorrelations, keys in the same order:")?;
        for i in 0..count {
            let cells: String = (0..=i)
                .map(|j| match self.fit.solution.correlation(i, j) {
                    Some(correlation) => format!("{correlation:>9.4}"),
                    None => format!("{NOT_AVAILABLE:>9}"),
                })
                .collect();
            writeln!(f, " {cells}")?;
        }
        Ok(())
    }

    /// Returns the places of all residuals, the largest first.
    pub fn by_size(&self) -> Vec<usize> {
        let residuals = &self.fit.residuals;
        let mut all: Vec<usize> = (0..residuals.len()).collect();
        all.sort_by(|a, b| size(&residuals[*b]).total_cmp(&size(&residuals[*a])));
        all
    }

    fn furthest(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        const MOST_REPORTED_ROWS: usize = 5;
        let all = self.by_size();
        let rows = all.iter().take(MOST_REPORTED_ROWS).map(|index| {
            let residual = &self.fit.residuals[*index];
            let readout = self.model.columns[self.model.data[*index].column].readout;
            let sigmas = residual.in_sigmas();
            [
                (residual.row + 1).to_string(),
                readout.name.to_owned(),
                significant(residual.measured, 6),
                residual.sigma.map(short).unwrap_or_default(),
                significant(residual.model, 6),
                significant(residual.value(), 3),
                sigmas.map_or(String::new(), |sigmas| format!("{sigmas:+.1}")),
            ]
        });
        let head = [
            "row",
            "quantity",
            "measured",
            "sigma",
            "model",
            "residual",
            "in sigmas",
        ];
        match all.len() {
            0..=MOST_REPORTED_ROWS => writeln!(f, "\nResiduals:")?,
            count => writeln!(
                f,
                "\nThe {MOST_REPORTED_ROWS} largest of {count} residuals:"
            )?,
        }
        write_table(f, head, rows)
    }

    fn json(&self) -> Value {
        let (fit, quality) = (self.fit, self.fit.quality);
        let keys = fit.keys.iter().map(Fitted::json);
        let count = fit.keys.len();
        let covariance = matrix(count, |i, j| {
            Some(fit.solution.covariance[i][j]? * fit.variance?)
        });
        let correlation = matrix(count, |i, j| fit.solution.correlation(i, j));
        let alike = fit.solution.alike.iter().map(|alike| {
            let parts = alike.iter().map(|(index, part)| {
                json!({ "key": fit.keys[*index].free.key, "relative_change": part })
            });
            parts.collect::<Vec<_>>()
        });
        let silent = fit
            .solution
            .silent
            .iter()
            .map(|&index| &fit.keys[index].free.key);
        let residuals = fit
            .residuals
            .iter()
            .zip(&self.model.data)
            .map(|(residual, datum)| {
                let mut row = json!(ValueColumns::from_residual(residual));
                row["row"] = json!(residual.row + 1);
                row["quantity"] = json!(self.model.columns[datum.column].readout.name);
                row
            });
        let freedom = quality.degrees_of_freedom;
        json!({
            "measured": self.model.measured.origin, "scenario": self.model.title, "scheme": self.model.scheme,
            "keys": keys.collect::<Vec<_>>(),
            "correlation": correlation, "covariance": covariance,
            "chi_squared": quality.chi_squared, "degrees_of_freedom": freedom,
            "chi_squared_per_degree_of_freedom": quality.chi_squared.filter(|_| freedom > 0).map(|sum| sum / freedom as f64),
            "probability": quality.probability, "scatter": quality.scatter,
            "student_factor": quality.scatter.and(fit.variance).map(|_| student(freedom)),
            "fits": quality.fits(), "verdict": fit.sentence(self.model), "remarks": self.remarks(),
            "bounds": fit.edges.iter().map(|edge| edge.json(&fit.keys)).collect::<Vec<_>>(),
            "cannot_be_told_apart": alike.collect::<Vec<_>>(), "no_influence": silent.collect::<Vec<_>>(),
            "residuals": residuals.collect::<Vec<_>>(), "steps": fit.steps,
        })
    }
}

/// Returns a square matrix with `count` rows from a function for its cells.
fn matrix(count: usize, cell: impl Fn(usize, usize) -> Option<f64>) -> Vec<Vec<Option<f64>>> {
    (0..count)
        .map(|i| (0..count).map(|j| cell(i, j)).collect())
        .collect()
}

impl fmt::Display for FitReport<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let quality = self.fit.quality;
        writeln!(
            f,
            "{} in {}, scheme {}: {} values, {} free\n",
            printable(&self.model.measured.origin),
            printable(&self.model.title),
            self.model.scheme,
            self.model.data.len(),
            self.fit.keys.len()
        )?;
        self.keys(f)?;
        self.correlations(f)?;
        self.furthest(f)?;
        writeln!(f)?;
        if let (Some(sum), freedom @ 1..) = (quality.chi_squared, quality.degrees_of_freedom) {
            let each = significant(sum / freedom as f64, 3);
            let probability = quality
                .probability
                .map_or(NOT_AVAILABLE.to_owned(), |p| significant(p, 2));
            writeln!(
                f,
                "chi^2/degree of freedom: {each}, probability of this value or more: {probability}"
            )?;
        }
        for remark in self.remarks() {
            writeln!(f, "{}", printable_lines(&remark))?;
        }
        f.write_str(&self.fit.sentence(self.model))
    }
}

impl Serialize for FitReport<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.json().serialize(serializer)
    }
}

/// Writes a header and rows as aligned columns.
fn write_table<const N: usize>(
    f: &mut fmt::Formatter<'_>,
    head: [&str; N],
    rows: impl Iterator<Item = [String; N]>,
) -> fmt::Result {
    let rows: Vec<_> = std::iter::once(head.map(str::to_owned))
        .chain(rows)
        .collect();
    let has_cells = |column: &usize| rows[1..].iter().any(|row| !row[*column].is_empty());
    let columns: Vec<usize> = (0..N).filter(has_cells).collect();
    let widest = |column: &usize| rows.iter().map(|row| width(&row[*column])).max();
    let widths: Vec<usize> = columns.iter().filter_map(widest).collect();
    for row in &rows {
        let cells = columns.iter().zip(&widths).map(|(column, most)| {
            let cell = &row[*column];
            let room = " ".repeat(most - width(cell));
            format!("  {}{room}", printable(cell))
        });
        writeln!(f, "{}", cells.collect::<String>().trim_end())?;
    }
    Ok(())
}

/// The TOML in the comments above the run file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Header {
    pub fit: FitCommand,
    pub key: Vec<FittedKey>,
}

/// The command of a fit, and the quality of the result.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FitCommand {
    /// The complete command, without its output option.
    pub command: String,
    pub measured: String,
    #[serde(rename = "in")]
    pub scenario: String,
    pub scheme: String,
    pub free: Vec<String>,
    /// The rows that were fitted, if not all.
    pub rows: Option<String>,
    /// chi^2, if the data have uncertainties.
    pub chi_squared: Option<f64>,
    pub degrees_of_freedom: u64,
    /// The scatter of data without uncertainties, in their unit.
    pub scatter: Option<f64>,
    pub verdict: String,
}

/// Writes a CSV with one row per measured value, below the run file of the fitted `scenario`. The CSV opens as this
/// run.
///
/// The command `asked` and the fitted values are written above the run file, as TOML in comments of the TOML.
pub fn write_csv(
    mut out: impl Write,
    report: &FitReport<'_>,
    scenario: &Scenario,
    asked: FitCommand,
) -> io::Result<()> {
    let found = report.fit.keys.iter().map(|key| FittedKey {
        key: key.free.key.clone(),
        value: key.value,
        uncertainty: key.sigma,
    });
    let header = Header {
        fit: asked,
        key: found.collect(),
    };
    let text = toml::to_string(&header).map_err(io::Error::other)?;
    out.write_all(commented(&commented(&text)).as_bytes())?;
    out.write_all(commented(&scenario.to_toml()).as_bytes())?;
    let mut rows = csv::WriterBuilder::new()
        .has_headers(false)
        .from_writer(out);
    let data = &report.model.measured.data;
    let mut names = vec!["row"];
    names.extend(at_names(data));
    names.extend(FIT_COLUMNS);
    rows.write_record(&names).map_err(io::Error::other)?;
    for (residual, datum) in report.fit.residuals.iter().zip(&report.model.data) {
        let quantity = report.model.columns[datum.column].readout.name;
        let row = (
            residual.row + 1,
            at_cells(data, residual.row),
            quantity,
            ValueColumns::from_residual(residual),
        );
        rows.serialize(row).map_err(io::Error::other)?;
    }
    rows.flush()
}

/// The columns of a row after its quantity.
#[derive(Serialize)]
struct ValueColumns {
    measured: f64,
    uncertainty: Option<f64>,
    model: f64,
    residual: f64,
    residual_sigmas: Option<f64>,
}

impl ValueColumns {
    fn from_residual(residual: &Residual) -> Self {
        Self {
            measured: residual.measured,
            uncertainty: residual.sigma,
            model: residual.model,
            residual: residual.value(),
            residual_sigmas: residual.in_sigmas(),
        }
    }
}

/// Returns the names of the columns that locate a measured value.
fn at_names(data: &DataKind) -> Vec<&str> {
    match data {
        DataKind::Series(_) => vec![TIME_COLUMN],
        DataKind::Table(table) => table.settings.iter().map(|it| it.key.as_str()).collect(),
    }
}

/// Returns the cells of these columns for `row`, counted from 0.
fn at_cells(data: &DataKind, row: usize) -> Vec<String> {
    match data {
        DataKind::Series(series) => vec![number(series.times_s[row])],
        DataKind::Table(table) => {
            let values = table.settings.iter().map(|setting| &setting.values[row]);
            values
                .map(|value| match value {
                    None => String::new(),
                    Some(toml::Value::Float(value)) => number(*value),
                    Some(toml::Value::String(text)) => text.clone(),
                    Some(other) => other.to_string(),
                })
                .collect()
        }
    }
}

/// Formats a number as in the CSV of a run.
fn number(number: f64) -> String {
    ryu::Buffer::new().format(number).to_owned()
}

fn finite(bound: f64) -> Option<f64> {
    bound.is_finite().then_some(bound)
}

/// Returns the size of a residual in units of its uncertainty, or in its own unit if it has none.
fn size(residual: &Residual) -> f64 {
    residual.in_sigmas().unwrap_or(residual.value()).abs()
}

/// Returns the width of a cell on a terminal, in columns.
fn width(cell: &str) -> usize {
    columns(&printable(cell))
}
