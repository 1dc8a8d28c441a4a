//! The model of a fit: the runs of a scenario for given values of its free keys, compared with the data.

use super::free::Free;
use super::levenberg::Stop;
use crate::engine::analysis::readouts::{self, Readout};
use crate::engine::cores;
use crate::engine::data::{
    DataKind, MeasuredData, MeasuredPoint, Residual, RunQuantity, RunSetting, RunTable, TimeSeries,
    at_times, doubts, is_within_reach, residuals,
};
use crate::engine::run::Clock;
use crate::engine::scenario::dotted::overlap;
use crate::engine::scenario::{Document, Problem, Problems, Scenario};
use crate::engine::text::number::shortest;
use std::collections::{BTreeSet, HashMap};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use toml::Value;

pub type FitProgress<'a> = &'a (dyn Fn() -> bool + Sync);

/// A scenario, its free keys, and the data to compare its runs with.
#[derive(Debug)]
pub struct Model {
    base: Document,
    pub free: Vec<Free>,
    pub measured: MeasuredData,
    pub title: String,
    pub scheme: &'static str,
    pub columns: Vec<Measurand>,
    /// All measured values, by column and then by row.
    pub data: Vec<Datum>,
    runs: AtomicU64,
}

#[derive(Clone, Copy, Debug)]
pub struct Measurand {
    pub readout: &'static Readout,
    /// The quantity, if the data are a time series.
    pub quantity: Option<&'static RunQuantity>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Datum {
    pub column: usize,
    pub point: MeasuredPoint,
}

impl Model {
    /// Creates the model of `scenario` with the keys `free` for the data `measured`.
    ///
    /// # Errors
    /// Returns an error if the scenario is wrong, if a data column sets a free key, or if the run needs too many steps
    /// to reach the last row.
    pub fn new(
        scenario: &Document,
        free: Vec<Free>,
        measured: MeasuredData,
    ) -> Result<Self, Problems> {
        let checked = scenario.scenario()?;
        are_apart(&free, settings(&measured.data))?;
        if let DataKind::Series(series) = &measured.data
            && !is_within_reach(series, &checked)
        {
            return Err(too_far(&measured, series, &checked));
        }
        let file = checked.file.bare();
        let (columns, data) = listed(&measured.data);
        Ok(Self {
            title: file.title.clone(),
            scheme: checked.motion.scheme.name,
            base: Document::from_file(scenario.origin(), &file)?,
            free,
            measured,
            columns,
            data,
            runs: AtomicU64::new(0),
        })
    }

    /// Returns warnings about data that cannot be right for the scenario's body.
    pub fn doubts(&self) -> Vec<String> {
        let scenario = self.base.scenario();
        scenario.map_or_else(
            |_| Vec::new(),
            |scenario| doubts(&self.measured, &Arc::new(scenario)),
        )
    }

    pub fn runs(&self) -> u64 {
        self.runs.load(Ordering::Relaxed)
    }

    pub fn scenario(&self, p: &[f64]) -> Result<Scenario, String> {
        Ok(self.document(p)?.scenario()?)
    }

    /// Returns the scenario for the values `p`, extended to the last time of a time series if necessary.
    pub fn as_long_as_measured(&self, p: &[f64]) -> Result<Scenario, String> {
        let scenario = self.scenario(p)?;
        let last_s = match &self.measured.data {
            DataKind::Series(series) => series.times_s.last().copied().unwrap_or(0.0),
            DataKind::Table(_) => 0.0,
        };
        let steps = Clock::at(&scenario, scenario.steps).step_at(last_s);
        match i64::try_from(steps) {
            Ok(steps) if last_s > Clock::end_s(&scenario) => {
                let mut document = self.document(p)?;
                document.set_value("motion.steps", Value::Integer(steps))?;
                Ok(document.scenario()?)
            }
            _ => Ok(scenario),
        }
    }

    fn document(&self, p: &[f64]) -> Result<Document, String> {
        let mut document = self.base.clone();
        for (free, &value) in self.free.iter().zip(p) {
            for key in &free.keys {
                document.set_value(key, Value::Float(value))?;
            }
        }
        Ok(document)
    }

    /// Computes the model's value for each datum, in its unit. `p` holds the values of the free keys.
    ///
    /// For a table of runs, `changed` is the index of a setting and a number of its uncertainties, which are added in
    /// every row.
    ///
    /// # Errors
    /// Returns an error if a run is impossible or does not have one of the numbers.
    pub fn values(
        &self,
        p: &[f64],
        changed: Option<(usize, f64)>,
        go_on: FitProgress<'_>,
    ) -> Result<Vec<f64>, Stop> {
        match &self.measured.data {
            DataKind::Series(series) => self.of_series(series, p, go_on),
            DataKind::Table(table) => self.of_table(table, p, changed, go_on),
        }
    }

    fn of_series(
        &self,
        series: &TimeSeries,
        p: &[f64],
        go_on: FitProgress<'_>,
    ) -> Result<Vec<f64>, Stop> {
        let scenario = self.scenario(p).map_err(Stop::Impossible)?;
        self.runs.fetch_add(1, Ordering::Relaxed);
        let values = at_times(series, &Arc::new(scenario), go_on)
            .map_err(|error| Stop::Impossible(error.to_string()))?
            .ok_or(Stop::Interrupted)?;
        let named = self.data.iter().zip(values.into_iter().flatten());
        named
            .map(|(datum, value)| self.finite(datum, Some(value)))
            .collect()
    }

    fn of_table(
        &self,
        table: &RunTable,
        p: &[f64],
        changed: Option<(usize, f64)>,
        go_on: FitProgress<'_>,
    ) -> Result<Vec<f64>, Stop> {
        let document = self.document(p).map_err(Stop::Impossible)?;
        let wanted: Vec<&Readout> = self.columns.iter().map(|column| column.readout).collect();
        let rows: Vec<usize> = self
            .data
            .iter()
            .map(|datum| datum.point.row)
            .collect::<BTreeSet<usize>>()
            .into_iter()
            .collect();
        let of_rows: HashMap<usize, Vec<Option<f64>>> =
            cores::map::<_, _, Result<_, Stop>>(&rows, |&row| {
                let read = with_settings(&document, table, row, changed)
                    .and_then(|document| Ok(document.scenario()?))
                    .and_then(|scenario| {
                        self.runs.fetch_add(1, Ordering::Relaxed);
                        readouts::at_end(scenario, &wanted, &|| go_on())
                    })
                    .map_err(|why| Stop::Impossible(format!("in {}: {why}", self.row(row))))?
                    .ok_or(Stop::Interrupted)?;
                let values = read.iter().map(readouts::ReadoutValue::number);
                Ok((row, values.collect()))
            })?;
        self.data
            .iter()
            .map(|datum| self.finite(datum, of_rows[&datum.point.row][datum.column]))
            .collect()
    }

    fn finite(&self, datum: &Datum, value: Option<f64>) -> Result<f64, Stop> {
        let name = self.columns[datum.column].readout.name;
        value.filter(|value| value.is_finite()).ok_or_else(|| {
            let row = self.row(datum.point.row);
            Stop::Impossible(format!(
                "{name} is null in {row}: the scenario's run does not have this number (see gyrolab readouts)"
            ))
        })
    }

    /// Names a row in words: its number, counted from 1, and its line in the file.
    pub fn row(&self, row: usize) -> String {
        let line = self.measured.lines.get(row).copied().unwrap_or_default();
        format!("row {} (line {line} of the data)", row + 1)
    }

    /// Compares the data with `values` and returns one residual per datum.
    pub fn residuals(&self, values: &[f64]) -> Vec<Residual> {
        let mut all = Vec::with_capacity(values.len());
        for (column, measurand) in self.columns.iter().enumerate() {
            let of_column = self.data.iter().zip(values);
            let (points, model): (Vec<MeasuredPoint>, Vec<f64>) = of_column
                .filter(|(datum, _)| datum.column == column)
                .map(|(datum, value)| (datum.point, *value))
                .unzip();
            all.extend(residuals(measurand.quantity, &points, &model));
        }
        all
    }
}

/// Returns the measured columns, and all values in them.
fn listed(data: &DataKind) -> (Vec<Measurand>, Vec<Datum>) {
    let measured: Vec<(Measurand, &[MeasuredPoint])> = match data {
        DataKind::Series(series) => series
            .curves
            .iter()
            .filter_map(|curve| {
                let readout = curve.quantity.readout()?;
                let quantity = Some(curve.quantity);
                Some((Measurand { readout, quantity }, &curve.points[..]))
            })
            .collect(),
        DataKind::Table(table) => table
            .readouts
            .iter()
            .map(|column| {
                let (readout, quantity) = (column.readout, None);
                (Measurand { readout, quantity }, &column.points[..])
            })
            .collect(),
    };
    let (mut columns, mut all) = (Vec::new(), Vec::new());
    for (column, (measurand, points)) in measured.into_iter().enumerate() {
        columns.push(measurand);
        all.extend(points.iter().map(|&point| Datum { column, point }));
    }
    (columns, all)
}

/// Returns `document` with the settings of the `row` of `table`. `changed` adds a multiple of its uncertainty to one
/// setting.
fn with_settings(
    document: &Document,
    table: &RunTable,
    row: usize,
    changed: Option<(usize, f64)>,
) -> Result<Document, String> {
    let mut changed_document = document.clone();
    for (index, setting) in table.settings.iter().enumerate() {
        let Some(value) = &setting.values[row] else {
            continue;
        };
        let by = changed.filter(|(key, _)| *key == index);
        let value = match (value, by, setting.sigmas[row]) {
            (Value::Float(number), Some((_, by)), Some(sigma)) => Value::Float(number + by * sigma),
            _ => value.clone(),
        };
        changed_document.set_value(&setting.key, value)?;
    }
    Ok(changed_document)
}

/// Returns the error for data whose last row needs too many steps in the run of `scenario`.
fn too_far(measured: &MeasuredData, series: &TimeSeries, scenario: &Scenario) -> Problems {
    let [first_s, last_s] = [series.times_s.first(), series.times_s.last()];
    let [first_s, last_s] = [first_s, last_s].map(|time_s| time_s.copied().unwrap_or(0.0));
    let begin = if first_s > 0.5 * last_s {
        format!(
            "; the recording starts at {0} s: use --from {0} to count the time from there",
            shortest(first_s)
        )
    } else {
        String::new()
    };
    let mut problem = Problem::at(
        "t_s",
        format!(
            "{} s needs too many time steps of {} s: a run has at most 10 000 000 steps (2^12 times as many with the exact scheme); remove the row, or set a longer motion.time_step_s{begin}",
            shortest(last_s),
            shortest(scenario.motion.time_step_s)
        ),
    );
    problem.place = measured.lines.last().map(|line| format!("line {line}"));
    Problems::one(measured.origin.clone(), problem)
}

/// Returns the settings at which `data` were measured.
pub(super) fn settings(data: &DataKind) -> &[RunSetting] {
    match data {
        DataKind::Table(table) => &table.settings,
        DataKind::Series(_) => &[],
    }
}

/// Checks that no two free keys set the same value, and that no data column sets a free key.
fn are_apart(free: &[Free], settings: &[RunSetting]) -> Result<(), Problems> {
    let keys: Vec<&String> = free.iter().flat_map(|free| &free.keys).collect();
    for (index, key) in keys.iter().enumerate() {
        let rule = if keys[..index].iter().any(|other| overlap(key, other)) {
            "is free twice: name it once".to_owned()
        } else if let Some(RunSetting { key: column, .. }) =
            settings.iter().find(|it| overlap(key, &it.key))
        {
            format!("is set by the column {column} in every row: it cannot be free")
        } else {
            continue;
        };
        let mut problem = Problem::at((*key).clone(), rule);
        problem.place = Some("--free".to_owned());
        return Err(Problems::one("", problem));
    }
    Ok(())
}
