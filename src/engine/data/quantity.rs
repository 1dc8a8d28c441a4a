//! Quantities that can be measured on one run over time, because it has them at every step. A new quantity is a column
//! of the CSV.

use crate::analysis::readouts::{self, Readout};
use crate::export::CsvColumn;
use crate::export::columns::DISTANCE;
use crate::run::Step;
use crate::text::unit::Unit;
use std::sync::LazyLock;

pub const TIME_COLUMN: &str = "t_s";

/// Columns of a run's CSV that count its steps and edits, and measure nothing.
pub const COUNTS: [&str; 2] = ["step", "segment"];

/// A quantity that a run has at every step.
#[derive(Debug)]
pub struct RunQuantity {
    /// Name with the unit, as in the run's CSV and in the table of readouts.
    pub name: &'static str,
    /// True if it is an angle that can be measured only up to whole turns.
    pub is_direction: bool,
    column: &'static CsvColumn,
}

/// All quantities that can be measured over time.
pub static QUANTITIES: LazyLock<Vec<RunQuantity>> = LazyLock::new(|| {
    CsvColumn::all()
        .filter(|column| ![TIME_COLUMN, DISTANCE].contains(&column.name))
        .filter(|column| !COUNTS.contains(&column.name))
        .map(|column| RunQuantity {
            name: column.name,
            is_direction: column.name == "azimuth_deg",
            column,
        })
        .collect()
});

impl RunQuantity {
    pub fn find(name: &str) -> Option<&'static Self> {
        QUANTITIES.iter().find(|quantity| quantity.name == name)
    }

    /// Returns its row in the table of readouts, with unit, meaning and symbol.
    pub fn readout(&self) -> Option<&'static Readout> {
        readouts::find(self.name)
    }

    pub fn words(&self) -> String {
        let end = Unit::from_name(self.name).map_or("", |unit| unit.end);
        self.name[..self.name.len() - end.len()].replace('_', " ")
    }

    /// Returns its unit, as written after numbers.
    pub fn unit(&self) -> &'static str {
        self.readout().map_or("", |readout| readout.unit)
    }

    /// Returns its value after `step`, in the unit of its name.
    pub fn value_at(&self, step: &Step) -> f64 {
        self.column.value(step.scenario(), &step.sample())
    }
}

/// Returns the names of all quantities, of the time, and of the columns that count.
pub fn names() -> impl Iterator<Item = &'static str> + Clone {
    let quantities = QUANTITIES.iter().map(|quantity| quantity.name);
    std::iter::once(TIME_COLUMN).chain(quantities).chain(COUNTS)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_quantity_has_a_readout_of_the_state() {
        for quantity in &*QUANTITIES {
            let source = quantity.readout().map(|readout| readout.source);
            assert_eq!(
                source,
                Some(readouts::ReadoutSource::State),
                "{}: READOUTS in analysis/readouts/table.rs needs its row, of the state",
                quantity.name
            );
        }
    }
}
