//! A fit as a CSV: a row for each measured value, below the fitted scenario's run file.
//!
//! What was fitted to what, and what was found, stands above the run file as TOML in TOML's comments, as whatever else an
//! export adds to one: the CSV opens as the run that it fitted.

use super::report::Report;
use crate::data::{Data, Residual};
use crate::export::layout::commented;
use crate::figure::table::{Found, OF_FIT};
use crate::scenario::Scenario;
use serde::{Deserialize, Serialize};
use std::io::{self, Write};

/// The comments above the run file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Header {
    pub fit: Asked,
    pub key: Vec<Found>,
}

/// The command of a fit, and how well the model fits.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Asked {
    /// The whole command, without its output.
    pub command: String,
    pub measured: String,
    #[serde(rename = "in")]
    pub scenario: String,
    pub scheme: String,
    pub free: Vec<String>,
    /// The rows that were fitted, where these are not all.
    pub rows: Option<String>,
    /// chi^2, of data with uncertainties.
    pub chi_squared: Option<f64>,
    pub degrees_of_freedom: u64,
    /// The scatter of data without uncertainties, in their unit.
    pub scatter: Option<f64>,
    pub verdict: String,
}

/// Writes the CSV of `report` on `out`; `scenario` is the fitted one, and `asked` has what was asked for.
pub fn write(
    mut out: impl Write,
    report: &Report<'_>,
    scenario: &Scenario,
    asked: Asked,
) -> io::Result<()> {
    let found = report.fit.keys.iter().map(|key| Found {
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
    names.extend(OF_FIT);
    rows.write_record(&names).map_err(io::Error::other)?;
    for (residual, datum) in report.fit.residuals.iter().zip(&report.model.data) {
        let quantity = report.model.columns[datum.column].readout.name;
        let row = (
            residual.row + 1,
            at_cells(data, residual.row),
            quantity,
            Numbers::of(residual),
        );
        rows.serialize(row).map_err(io::Error::other)?;
    }
    rows.flush()
}

/// The columns of a row behind its quantity.
#[derive(Serialize)]
pub(super) struct Numbers {
    measured: f64,
    uncertainty: Option<f64>,
    model: f64,
    residual: f64,
    residual_sigmas: Option<f64>,
}

impl Numbers {
    pub(super) fn of(residual: &Residual) -> Self {
        Self {
            measured: residual.measured,
            uncertainty: residual.sigma,
            model: residual.model,
            residual: residual.value(),
            residual_sigmas: residual.in_sigmas(),
        }
    }
}

/// The names of what says where a value was measured.
fn at_names(data: &Data) -> Vec<&str> {
    match data {
        Data::Series(_) => vec![crate::data::quantity::TIME],
        Data::Table(table) => table.settings.iter().map(|it| it.key.as_str()).collect(),
    }
}

/// The same of a row, from 0.
fn at_cells(data: &Data, row: usize) -> Vec<String> {
    match data {
        Data::Series(series) => vec![number(series.times_s[row])],
        Data::Table(table) => {
            let values = table.settings.iter().map(|setting| &setting.values[row]);
            let cell = |value: &Option<toml::Value>| match value {
                None => String::new(),
                Some(toml::Value::Float(value)) => number(*value),
                Some(toml::Value::String(text)) => text.clone(),
                Some(other) => other.to_string(),
            };
            values.map(cell).collect()
        }
    }
}

/// A number as CSVs of runs have it.
fn number(number: f64) -> String {
    ryu::Buffer::new().format(number).to_owned()
}
