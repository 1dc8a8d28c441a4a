//! Parses the numbers in the cells of a file, and checks them.

use super::names::{ColumnRole, NamedColumn};
use super::{MeasuredCurve, MeasuredPoint, MeasuredReadout, RunSetting, RunTable, TimeSeries};
use crate::scenario::Problem;
use crate::scenario::csv::Csv;
use crate::scenario::document::toml_or_text;
use crate::scenario::kind::ValueKind;
use crate::scenario::problem::{Problems, at_line};
use crate::text::number::shortest;
use crate::text::printable::brief;
use toml::Value;

/// Parses cells and collects their errors.
pub(super) struct CellParser<'a> {
    cells: &'a Csv,
    pub found: Problems,
    /// Columns without numbers that are not mapped, in a file with mapped columns.
    pub left_out: Vec<String>,
    /// Decimal signs that the file has used so far.
    uses_points: bool,
    uses_commas: bool,
}

impl<'a> CellParser<'a> {
    pub fn new(cells: &'a Csv) -> Self {
        Self {
            cells,
            found: Problems::default(),
            left_out: Vec::new(),
            uses_points: false,
            uses_commas: false,
        }
    }

    pub fn series(&mut self, columns: &[NamedColumn]) -> TimeSeries {
        let time = columns
            .iter()
            .find(|column| matches!(column.is, ColumnRole::Time));
        let times_s = time.map_or_else(Vec::new, |column| self.times(column));
        let curves = columns.iter().filter_map(|column| match column.is {
            ColumnRole::Quantity(quantity) => {
                let points = self.points(column)?;
                Some(MeasuredCurve { quantity, points })
            }
            _ => None,
        });
        TimeSeries {
            curves: curves.collect(),
            times_s,
        }
    }

    pub fn table(&mut self, columns: &[NamedColumn]) -> RunTable {
        let (mut settings, mut readouts) = (Vec::new(), Vec::new());
        for column in columns {
            match column.is {
                ColumnRole::Key(kind) => settings.push(self.setting(column, kind)),
                ColumnRole::Readout(readout) => {
                    let points = self.points(column);
                    readouts.extend(points.map(|points| MeasuredReadout { readout, points }));
                }
                ColumnRole::Time
                | ColumnRole::Count
                | ColumnRole::Foreign
                | ColumnRole::Quantity(_) => {}
            }
        }
        RunTable { settings, readouts }
    }

    fn times(&mut self, column: &NamedColumn) -> Vec<f64> {
        let mut times_s: Vec<f64> = Vec::with_capacity(self.cells.rows.len());
        let mut before: Option<(u64, f64)> = None;
        for (line, texts) in &self.cells.rows {
            let text = &texts[column.place];
            let number = self.number(*line, &column.name, text);
            let time_s = number.unwrap_or(f64::NAN);
            if number.is_none() && (text.is_empty() || text.eq_ignore_ascii_case("nan")) {
                let rule = "is missing: every row needs its time";
                self.refuse(*line, &column.name, text, rule);
            }
            if let Some((above, earlier)) = before.filter(|(_, earlier)| time_s < *earlier) {
                let rule = format!(
                    "is before the time {} in line {above}: sort the rows by time, and put another run into its own file",
                    shortest(earlier)
                );
                self.refuse(*line, &column.name, text, rule);
            }
            if time_s.is_finite() {
                before = Some((*line, time_s));
            }
            times_s.push(time_s);
        }
        times_s
    }

    /// Returns the values of a measured column, with their uncertainties. `None` if the column is left out.
    fn points(&mut self, column: &NamedColumn) -> Option<Vec<MeasuredPoint>> {
        let own = &self.cells.own[column.place];
        if own.is_mapped || !self.cells.own.iter().any(|other| other.is_mapped) {
            return Some(self.every_point(column));
        }
        let before = (self.found.clone(), self.uses_points, self.uses_commas);
        let points = self.every_point(column);
        if self.found == before.0 {
            return Some(points);
        }
        (self.found, self.uses_points, self.uses_commas) = before;
        self.left_out.push(own.shown());
        None
    }

    fn every_point(&mut self, column: &NamedColumn) -> Vec<MeasuredPoint> {
        let rows = self.cells.rows.iter().enumerate();
        let points = rows.filter_map(|(row, (line, texts))| {
            let value = self.number(*line, &column.name, &texts[column.place]);
            let sigma = self.sigma(*line, column, texts);
            value.map(|value| MeasuredPoint { row, value, sigma })
        });
        points.collect()
    }

    fn setting(&mut self, column: &NamedColumn, kind: ValueKind) -> RunSetting {
        let cells = self.cells;
        let mut setting = RunSetting {
            key: column.name.clone(),
            values: Vec::new(),
            sigmas: Vec::new(),
        };
        let is_number = matches!(kind, ValueKind::Number(_));
        for (line, texts) in &cells.rows {
            let text = &texts[column.place];
            let value = match (text.is_empty(), is_number) {
                (true, _) => None,
                (false, true) => self.number(*line, &column.name, text).map(Value::Float),
                (false, false) => Some(toml_or_text(text).0),
            };
            if let Some(rule) = value.as_ref().and_then(|value| kind.check(value).err()) {
                self.refuse(*line, &column.name, text, rule);
            }
            setting.values.push(value);
            setting.sigmas.push(self.sigma(*line, column, texts));
        }
        setting
    }

    /// Returns the uncertainty of the value in `column`, from the same row.
    fn sigma(&mut self, line: u64, column: &NamedColumn, texts: &[String]) -> Option<f64> {
        let place = column.uncertainty?;
        let name = self.cells.names[place].clone();
        let sigma = self.number(line, &name, &texts[place])?;
        if sigma > 0.0 {
            return Some(sigma);
        }
        let rule = "must be greater than zero: leave the cell empty if there is no uncertainty";
        self.refuse(line, &name, &texts[place], rule);
        None
    }

    /// Parses `text` in the column `name` as a number. `None` if it is empty, if it is NaN (which many programs write
    /// for a missing value), or if it is not valid.
    fn number(&mut self, line: u64, name: &str, text: &str) -> Option<f64> {
        if text.is_empty() || text.eq_ignore_ascii_case("nan") {
            return None;
        }
        let has_comma = text.contains(',');
        let written = if has_comma && self.cells.separator != ',' && !text.contains('.') {
            text.replacen(',', ".", 1)
        } else {
            text.to_owned()
        };
        let rule = match written.parse::<f64>() {
            Ok(number) if number.is_finite() => Ok(number),
            Ok(_) => Err("must be a finite number: leave the cell empty if the value is missing"),
            Err(_) if has_comma => {
                Err("must be a number with a decimal point (1.5) and no thousands separator")
            }
            Err(_) => {
                Err("must be a number without a unit: leave the cell empty if the value is missing")
            }
        };
        let read = rule.map_err(|rule| self.refuse(line, name, text, rule));
        let number = read.ok()?;
        self.uses_commas |= has_comma;
        self.uses_points |= text.contains('.');
        if self.uses_commas && self.uses_points {
            let mixed = "has a different decimal sign from the numbers before it: use only points, or only commas";
            self.refuse(line, name, text, mixed);
            // Report it once. Otherwise each later number would be an error for one of the two.
            (self.uses_commas, self.uses_points) = (false, false);
        }
        Some(number)
    }

    fn refuse(&mut self, line: u64, name: &str, text: &str, rule: impl Into<String>) {
        self.found.add(|| {
            let problem = Problem {
                value: brief(text, 40),
                ..Problem::at(name, rule)
            };
            at_line(line, problem)
        });
    }
}
