//! Measured data: a CSV file from an experiment, read and checked, and the same quantities of a run.
//!
//! There are two kinds. A [`TimeSeries`] has the time in a column `t_s`, and quantities that a run has at every step
//! ([`quantity`]). A [`RunTable`] has a run in each row: columns named after keys of the scenario set it, and columns
//! named after readouts were measured on it. The uncertainty of a column is in a column of its own, named as for
//! readouts: `tilt_uncertainty_deg` for `tilt_deg`.
//!
//! - [`open`]: reads a file, or data that come with the program.
//! - `names`: the roles of the columns; `numbers`: their cells; `spellings`: the names that other programs use.
//! - `hint`: suggests a `--map` with which a rejected file can be read.
//! - [`of_run`]: reads a run at the times of a series.
//! - [`compared`]: compares the measured data with the run; [`doubts`]: finds data that cannot be right.

pub mod compared;
mod doubts;
mod hint;
mod names;
mod numbers;
pub mod of_run;
pub mod places;
pub mod quantity;
mod reading;
mod sigma;
mod spellings;

pub use compared::{Residual, is_counted, residuals};
pub use doubts::doubts;
pub use hint::map_option;
pub use of_run::{RunReader, at_times, is_within_reach};
pub use places::{MeasuredPlace, places};
pub use quantity::{QUANTITIES, RunQuantity};
pub use reading::{SHIPPED, find_shipped, open, open_with, read, read_with, text};
pub use sigma::{ColumnOptions, ColumnSigma};
pub use spellings::{name_columns, time_like};

use crate::analysis::readouts::Readout;
use crate::scenario::problem::listed;
use crate::scenario::{Problem, Problems};
use crate::text::number::{counted, shortest};
use crate::text::printable::printable;
use crate::text::unit::with_word;
use std::ops::Range;
use std::sync::Arc;
use toml::Value;

#[derive(Clone, Debug)]
pub struct MeasuredData {
    /// Name of the file, as the user typed it.
    pub origin: String,
    /// Content of the file.
    pub text: Arc<str>,
    /// Time after which the measured values were removed, s.
    pub until_s: Option<f64>,
    /// Comments above the names of the columns, without their marks. They describe the source of the data.
    pub about: String,
    pub lines: Vec<u64>,
    /// Names of unknown columns, which are not read.
    pub left_out: Vec<String>,
    /// Describes how columns with names of other programs were read.
    pub read_as: Option<String>,
    /// Number of rows before t = 0, which are ignored.
    pub rows_before: usize,
    /// Number of rows outside the requested time, which are ignored.
    pub rows_outside: usize,
    pub data: DataKind,
}

#[derive(Clone, Debug)]
pub enum DataKind {
    Series(TimeSeries),
    Table(RunTable),
}

#[derive(Clone, Debug)]
pub struct TimeSeries {
    /// Time of each row, s. Times are not negative and do not decrease.
    pub times_s: Vec<f64>,
    /// Curves of the columns, in the order of the file.
    pub curves: Vec<MeasuredCurve>,
}

impl TimeSeries {
    /// Returns the series as a CSV with the program's names.
    pub fn to_csv(&self) -> String {
        let curves: Vec<(&MeasuredCurve, bool)> = self
            .curves
            .iter()
            .map(|curve| (curve, has_sigma(curve)))
            .collect();
        let mut text = String::from("t_s");
        for (curve, has_sigma) in &curves {
            let name = curve.quantity.name;
            text += &format!(",{name}");
            if *has_sigma {
                text += &format!(",{}", with_word(name, names::UNCERTAINTY_WORD));
            }
        }
        for (row, time_s) in self.times_s.iter().enumerate() {
            text += &format!("\n{}", shortest(*time_s));
            for (curve, has_sigma) in &curves {
                let place = curve.points.binary_search_by_key(&row, |point| point.row);
                let point = place.ok().map(|place| &curve.points[place]);
                text.push(',');
                text += &point.map_or(String::new(), |point| shortest(point.value));
                if *has_sigma {
                    let sigma = point.and_then(|point| point.sigma);
                    text.push(',');
                    text += &sigma.map_or(String::new(), shortest);
                }
            }
        }
        text + "\n"
    }
}

fn has_sigma(curve: &MeasuredCurve) -> bool {
    curve.points.iter().any(|point| point.sigma.is_some())
}

#[derive(Clone, Debug)]
pub struct MeasuredCurve {
    /// Measured quantity. Its [`readout`](RunQuantity::readout) has name, unit and symbol.
    pub quantity: &'static RunQuantity,
    /// Values, by rows. A row without a value has no point.
    pub points: Vec<MeasuredPoint>,
}

#[derive(Clone, Debug)]
pub struct RunTable {
    /// Columns that set the scenario, in the order of the file.
    pub settings: Vec<RunSetting>,
    /// Columns that were measured, in the order of the file.
    pub readouts: Vec<MeasuredReadout>,
}

/// A key of the scenario that the rows of a table set.
#[derive(Clone, Debug)]
pub struct RunSetting {
    pub key: String,
    /// Value in each row. `None` if the scenario's own value applies.
    pub values: Vec<Option<Value>>,
    /// Standard uncertainty of the value in each row, if given, in the value's unit.
    pub sigmas: Vec<Option<f64>>,
}

/// A readout that was measured on the runs of a table.
#[derive(Clone, Debug)]
pub struct MeasuredReadout {
    pub readout: &'static Readout,
    /// Values, by rows. A row without a value has no point.
    pub points: Vec<MeasuredPoint>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeasuredPoint {
    /// Row, from 0: the index of the time, or of the settings.
    pub row: usize,
    /// Value, in the unit of its column.
    pub value: f64,
    /// Standard uncertainty of the value, positive, if given.
    pub sigma: Option<f64>,
}

const IS_RUN_TABLE: &str = "is a table of runs, with one run per row, and cannot be shown next to a single run: use gyrolab fit, or a file with a column t_s";

impl MeasuredData {
    /// Returns the data as a time series of one run.
    ///
    /// # Errors
    /// Returns an error if the data are a table of runs.
    pub fn series(&self) -> Result<&TimeSeries, Problems> {
        match &self.data {
            DataKind::Series(series) => Ok(series),
            DataKind::Table(_) => Err(Problems::one(&self.origin, Problem::at("", IS_RUN_TABLE))),
        }
    }

    /// Describes the columns and rows that are not read, and how columns with names of other programs are read.
    pub fn notes(&self) -> Vec<String> {
        let names = listed(self.left_out.iter().map(String::as_str));
        let columns = format!("unknown columns ignored: {names}");
        let [before, outside] = [
            (self.rows_before, "before t = 0"),
            (self.rows_outside, "outside --from and --to"),
        ]
        .map(|(count, place)| {
            let rows = counted(count as u64, "row");
            (count > 0).then(|| format!("{rows} {place} ignored"))
        });
        let notes = [
            self.read_as.clone(),
            (!self.left_out.is_empty()).then_some(columns),
            before,
            outside,
        ];
        let origin = printable(&self.origin);
        notes
            .into_iter()
            .flatten()
            .map(|note| format!("{origin}: {note}"))
            .collect()
    }

    /// Returns the data without values measured after `until_s`, s, if that is given.
    #[must_use]
    pub fn until(mut self, until_s: Option<f64>) -> Self {
        if let (DataKind::Series(TimeSeries { times_s, .. }), Some(until_s)) = (&self.data, until_s)
        {
            let times = times_s.clone();
            self.keep_rows(|row| times[row] <= until_s);
        }
        Self { until_s, ..self }
    }

    /// Keeps the rows of a time series from `from_s` to `to_s`, and counts time from `from_s` on. Returns true if a
    /// measured value remains.
    pub fn keep_between(&mut self, from_s: f64, to_s: f64) -> bool {
        let DataKind::Series(TimeSeries { times_s, .. }) = &mut self.data else {
            return false;
        };
        let first = times_s.partition_point(|time_s| *time_s < from_s);
        let end = times_s.partition_point(|time_s| *time_s <= to_s).max(first);
        self.rows_outside += times_s.len() - (end - first);
        times_s.iter_mut().for_each(|time_s| *time_s -= from_s);
        self.keep_range(first..end)
    }

    /// Removes the rows of a time series before t = 0. Returns true if a measured value remains.
    fn leave_out_rows_before_0(&mut self) -> bool {
        let DataKind::Series(TimeSeries { times_s, .. }) = &self.data else {
            return true;
        };
        self.rows_before = times_s.partition_point(|time_s| *time_s < 0.0);
        let rows = self.rows_before..times_s.len();
        rows.start == 0 || self.keep_range(rows)
    }

    /// Keeps these rows of a time series. Returns true if a measured value remains.
    fn keep_range(&mut self, rows: Range<usize>) -> bool {
        let DataKind::Series(series) = &mut self.data else {
            return false;
        };
        series.times_s = series.times_s[rows.clone()].to_vec();
        self.lines = self.lines[rows.clone()].to_vec();
        for curve in &mut series.curves {
            curve.points.retain(|point| rows.contains(&point.row));
            let points = curve.points.iter_mut();
            points.for_each(|point| point.row -= rows.start);
        }
        series.curves.retain(|curve| !curve.points.is_empty());
        !series.curves.is_empty()
    }

    /// Keeps the measured values in the rows, counted from 0, for which `is_kept` is true. Returns the number of values
    /// kept.
    pub fn keep_rows(&mut self, is_kept: impl Fn(usize) -> bool) -> usize {
        let keep = |points: &mut Vec<MeasuredPoint>| {
            points.retain(|point| is_kept(point.row));
            points.len()
        };
        match &mut self.data {
            DataKind::Series(TimeSeries { curves, .. }) => {
                (curves.iter_mut().map(|it| keep(&mut it.points))).sum()
            }
            DataKind::Table(RunTable { readouts, .. }) => {
                (readouts.iter_mut().map(|it| keep(&mut it.points))).sum()
            }
        }
    }
}
