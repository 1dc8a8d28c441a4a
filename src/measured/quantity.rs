//! What can be measured on one run over its time: quantities that it has at every step.

use crate::analysis::readouts::{self, Readout};
use crate::export::columns::{COLUMNS, Column, OPTIONAL_COLUMNS, OptionalColumn};
use crate::run::{Sample, Step};
use crate::scenario::Scenario;
use crate::text::unit::Unit;
use std::sync::LazyLock;

pub const TIME: &str = "t_s";

/// Columns of a run's CSV that count its steps and edits, and measure nothing.
pub const COUNTS: [&str; 2] = ["step", "segment"];

/// A quantity that a run has at every step.
#[derive(Debug)]
pub struct Quantity {
    /// Its name with the unit, as in the run's CSV and in the table of readouts.
    pub name: &'static str,
    /// Whether it is an angle that can be measured only up to whole turns.
    pub is_direction: bool,
    read: Read,
}

#[derive(Debug)]
enum Read {
    /// A column of the run's CSV.
    Column(&'static Column),
    /// A column that the CSV has where it is asked for.
    Optional(&'static OptionalColumn),
}

/// Every quantity that can be measured over time.
pub static QUANTITIES: LazyLock<Vec<Quantity>> = LazyLock::new(|| {
    let quantity = |name, read| Quantity {
        name,
        is_direction: name == "azimuth_deg",
        read,
    };
    let is_measured = |column: &&Column| column.name != TIME && !COUNTS.contains(&column.name);
    let columns = COLUMNS.iter().filter(is_measured);
    let columns = columns.map(|column| quantity(column.name, Read::Column(column)));
    let optional = OPTIONAL_COLUMNS.iter();
    let optional = optional.map(|column| quantity(column.name, Read::Optional(column)));
    columns.chain(optional).collect()
});

impl Quantity {
    pub fn find(name: &str) -> Option<&'static Self> {
        QUANTITIES.iter().find(|quantity| quantity.name == name)
    }

    /// Its row in the table of readouts, with unit, meaning and symbol.
    pub fn readout(&self) -> Option<&'static Readout> {
        readouts::find(self.name)
    }

    /// Its name without the unit, in words.
    pub fn words(&self) -> String {
        let end = Unit::of(self.name).map_or("", |unit| unit.end);
        self.name[..self.name.len() - end.len()].replace('_', " ")
    }

    /// Its unit, as it is written after numbers.
    pub fn unit(&self) -> &'static str {
        self.readout().map_or("", |readout| readout.unit)
    }

    /// Its value after `step`, in the unit of its name.
    pub fn of(&self, step: &Step) -> f64 {
        match self.read {
            Read::Optional(column) => column.of(step.scenario(), step.after()),
            Read::Column(column) => column.value(&step.sample()).number(),
        }
    }

    /// Its value at `sample`, which is of a run of `scenario`, in the unit of its name.
    pub fn of_sample(&self, scenario: &Scenario, sample: &Sample) -> f64 {
        match self.read {
            Read::Column(column) => column.value(sample).number(),
            Read::Optional(column) => column.value(scenario, sample),
        }
    }

    /// Whether every CSV of a run has it as a column.
    pub fn is_column(&self) -> bool {
        matches!(self.read, Read::Column(_))
    }
}

/// The names of all quantities, of the time, and of the columns that count.
pub fn names() -> impl Iterator<Item = &'static str> + Clone {
    let quantities = QUANTITIES.iter().map(|quantity| quantity.name);
    std::iter::once(TIME).chain(quantities).chain(COUNTS)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_quantity_has_a_readout_of_the_state() {
        assert_eq!(QUANTITIES.len(), COLUMNS.len() - 3 + OPTIONAL_COLUMNS.len());
        for quantity in &*QUANTITIES {
            let readout = quantity.readout().unwrap();
            assert_eq!(readout.source, readouts::Source::State, "{}", quantity.name);
        }
    }
}
