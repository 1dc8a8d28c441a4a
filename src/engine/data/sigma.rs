//! The user's options for the columns of a file: names, and uncertainties for columns without any.

use super::{DataKind, MeasuredPoint};
use crate::scenario::csv::{Csv, Renaming};
use crate::scenario::problem::listed;
use crate::scenario::{Problem, Problems};
use crate::text::number::shortest;
use crate::text::printable::brief;
use crate::text::unit::in_known_unit;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;

/// The user's options for the columns of a file.
#[derive(Clone, Debug, Default)]
pub struct ColumnOptions {
    pub map: Vec<Renaming>,
    pub sigma: Vec<ColumnSigma>,
}

impl ColumnOptions {
    pub fn is_some(&self) -> bool {
        !self.map.is_empty() || !self.sigma.is_empty()
    }
}

/// Uncertainty of every value in a column that has none in the file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ColumnSigma {
    /// gyrolab's name of the column, in any unit, or the file's own name.
    pub column: String,
    /// Standard uncertainty, in the unit of that name.
    pub value: f64,
}

impl FromStr for ColumnSigma {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        const WRONG: &str = "must be COLUMN=VALUE, such as tilt_deg=0.5, with VALUE above 0";
        let (column, number) = text.rsplit_once('=').ok_or(WRONG)?;
        let value = number.trim().parse::<f64>().ok();
        Ok(Self {
            column: column.trim().to_owned(),
            value: value
                .filter(|value| *value > 0.0 && value.is_finite())
                .ok_or(WRONG)?,
        })
    }
}

impl fmt::Display for ColumnSigma {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}={}", self.column, shortest(self.value))
    }
}

/// Sets the uncertainties `sigmas` for values of columns that have none.
///
/// # Errors
/// Returns an error if a column is not among the measured ones of `cells`.
pub(super) fn set_sigmas(
    data: &mut DataKind,
    cells: &Csv,
    sigmas: &[ColumnSigma],
) -> Result<(), Problems> {
    let mut found = Problems::default();
    for sigma in sigmas {
        let known: Vec<String> = measured(data).map(|(name, _)| name.to_owned()).collect();
        let is_known = |name: &str| known.iter().any(|known| known == name);
        let mut columns = cells.own.iter().zip(&cells.names);
        let own = columns.find(|(own, name)| own.name == sigma.column && is_known(name));
        let of_file = own.map(|(own, name)| (name.clone(), own.factor));
        let Some((name, factor)) = of_file.or_else(|| in_known_unit(&sigma.column, is_known))
        else {
            let mut problem = Problem::at(
                "",
                format!(
                    "is not a measured column: there is {}",
                    listed(known.iter().map(String::as_str))
                ),
            );
            problem.place = Some(brief(&format!("--sigma {sigma}"), 80));
            found.add(|| problem);
            continue;
        };
        let value = sigma.value * factor;
        let points = measured(data)
            .filter(|(measured, _)| *measured == name)
            .flat_map(|(_, points)| points);
        for point in points {
            point.sigma = point.sigma.or(Some(value));
        }
    }
    found.or(())
}

/// Returns the measured columns, each with its name in gyrolab and its values.
fn measured(
    data: &mut DataKind,
) -> Box<dyn Iterator<Item = (&'static str, &mut Vec<MeasuredPoint>)> + '_> {
    match data {
        DataKind::Series(series) => {
            let curves = series.curves.iter_mut();
            Box::new(curves.map(|curve| (curve.quantity.name, &mut curve.points)))
        }
        DataKind::Table(table) => {
            let columns = table.readouts.iter_mut();
            Box::new(columns.map(|column| (column.readout.name, &mut column.points)))
        }
    }
}
