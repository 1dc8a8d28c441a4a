//! What the commands of the tables wrote.

use super::made::Made;
use crate::engine::scenario::Problems;
use crate::engine::scenario::csv::Csv;
use std::collections::BTreeMap;

/// The most values of a table, rows times columns.
const MOST_VALUES: usize = 1_000_000;

/// The tables of the document, each under its name in [`TABLES`](super::TABLES).
#[derive(Debug, Default)]
pub struct Tables(BTreeMap<&'static str, Csv>);

impl Tables {
    /// Adds the `text` that the command of `made` wrote.
    ///
    /// # Errors
    /// When it is not a CSV.
    pub fn add(&mut self, made: &Made, text: &str) -> Result<(), Problems> {
        let csv =
            Csv::parse(text, MOST_VALUES).map_err(|problems| problems.in_file(made.path()))?;
        self.0.insert(made.name, csv);
        Ok(())
    }

    /// Returns the number in the column `readout` of the row that begins with these `labels`; NaN if there is none.
    pub(super) fn number(&self, table: &str, labels: &[&str], readout: &str) -> f64 {
        let found = self.0.get(table).and_then(|csv| {
            let column = csv.names.iter().position(|name| name == readout)?;
            let (_, row) = csv
                .rows
                .iter()
                .find(|(_, row)| row.iter().zip(labels).all(|(cell, label)| cell == label))?;
            row[column].parse().ok()
        });
        found.unwrap_or(f64::NAN)
    }

    /// Returns the numbers of a column; none if there is no such column.
    pub(super) fn column(&self, table: &str, name: &str) -> Vec<f64> {
        let cells = self.0.get(table).and_then(|csv| csv.column(name));
        cells
            .into_iter()
            .flatten()
            .filter_map(|cell| cell.parse().ok())
            .collect()
    }
}
