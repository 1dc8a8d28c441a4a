//! What can be measured on one run over its time: quantities that it has at every step.

use crate::analysis::readouts::{self, Readout};
use crate::export::Column;
use crate::run::Step;
use crate::text::unit::Unit;

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
}

const fn column(name: &'static str) -> Quantity {
    Quantity {
        name,
        is_direction: false,
    }
}

/// Every quantity that can be measured over time.
pub static QUANTITIES: [Quantity; 14] = [
    column("x_m"),
    column("y_m"),
    column("z_m"),
    column("Lx_Js"),
    column("Ly_Js"),
    column("Lz_Js"),
    column("wx_rad_per_s"),
    column("wy_rad_per_s"),
    column("wz_rad_per_s"),
    column("tilt_deg"),
    Quantity {
        is_direction: true,
        ..column("azimuth_deg")
    },
    column("energy_J"),
    column("spin_rpm"),
    column("L_axle_Js"),
];

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
        let column = Column::all().find(|column| column.name == self.name);
        column.map_or(f64::NAN, |column| {
            column.value(step.scenario(), &step.sample())
        })
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
    use crate::export::columns::COLUMNS;

    #[test]
    fn every_column_of_a_run_and_nothing_without_a_readout_can_be_measured() {
        for column in COLUMNS {
            assert!(names().any(|name| name == column.name), "{}", column.name);
        }
        for quantity in &QUANTITIES {
            let readout = quantity.readout().unwrap();
            assert_eq!(readout.source, readouts::Source::State, "{}", quantity.name);
        }
    }
}
