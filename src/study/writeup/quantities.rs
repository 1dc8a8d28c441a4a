//! The measured numbers of a run beside those of theory.

use crate::analysis::Readouts;
use crate::analysis::readouts::{READOUTS, Readout, Source};
use crate::run::Clock;
use crate::scenario::Scenario;
use crate::text::number::{NONE, Uncertain, fixed, short, significant, uncertain};
use crate::text::unit::Unit;

/// A measured number, with what theory says of it.
#[derive(Clone, Debug)]
pub struct Quantity {
    /// The readout that was measured.
    pub readout: &'static Readout,
    /// Its value in the readout's unit, where there is one.
    pub measured: Option<f64>,
    /// One standard error of it; `None` where the table of readouts has none for it.
    pub uncertainty: Option<f64>,
    /// What theory says, in the same unit.
    pub predicted: Option<f64>,
    /// Since when it counts, s, where that is not the start.
    pub since_s: Option<f64>,
    /// Whether the time step is too long to see it: what was measured is no number of the motion then.
    pub is_strobed: bool,
}

/// The number that a time step can be too long to see.
const NUTATION: &str = "measured_nutation_period_s";

/// How the names of measured numbers begin.
const MEASURED: &str = "measured_";

/// So many standard errors off theory, a number is not off by the reading of it.
const FAR: f64 = 100.0;

/// Digits after the point of a number that has no uncertainty.
const DECIMALS: usize = 6;

/// Every measured number of the table of readouts that `readouts`, of the run of `scenario`, has a value of, or theory.
pub fn quantities(scenario: &Scenario, readouts: &Readouts) -> Vec<Quantity> {
    let since = readouts.since;
    // The first step under other forces: they changed where it began.
    let changed = since.checked_sub(1).filter(|step| *step > 0);
    let since_s = changed.map(|step| Clock::at(scenario, step).time_s(step));
    let is_strobed = readouts.nutation_is_resolved() == Some(false);
    let measured = READOUTS
        .iter()
        .filter(|readout| readout.name.starts_with(MEASURED) && !readout.is_uncertainty());
    let quantities = measured.map(|readout| {
        let number = |readout: Option<&Readout>| readout.and_then(|it| it.of(readouts).number());
        // Of the swing that the report's scheme makes there is a formula, which is no theory of the exact motion.
        let predicted = readout.predicted().filter(|it| it.source == Source::Theory);
        let uncertainty = readout.uncertainty().filter(|_| predicted.is_some());
        Quantity {
            readout,
            measured: number(Some(readout)),
            uncertainty: number(uncertainty),
            predicted: number(predicted),
            since_s: since_s.filter(|_| readout.source == Source::Measured),
            is_strobed: is_strobed && readout.name == NUTATION,
        }
    });
    quantities
        .filter(|it| it.measured.is_some() || it.predicted.is_some())
        .collect()
}

impl Quantity {
    /// Its short name: "tilt swing".
    pub fn name(&self) -> String {
        let name = self.readout.name;
        let bare = name.strip_prefix(MEASURED).unwrap_or(name);
        let end = Unit::of(bare).map_or("", |unit| unit.end);
        bare[..bare.len() - end.len()].replace('_', " ")
    }

    /// Its name with what its reader must know of it: "nutation period (strobed) since 25 s", the time since when it counts.
    pub fn label(&self) -> String {
        let strobed = if self.is_strobed { " (strobed)" } else { "" };
        let since = self
            .since_s
            .map(|since_s| format!(" since {} s", significant(since_s, 9)));
        self.name() + strobed + &since.unwrap_or_default()
    }

    /// What it is.
    pub fn meaning(&self) -> String {
        let mut meaning = self.readout.meaning.to_owned();
        if let Some(since_s) = self.since_s {
            let since_s = significant(since_s, 9);
            meaning += &format!("; since the forces last changed, at t = {since_s} s");
        }
        if self.is_strobed {
            meaning += "; strobed: the time step is too long to see the nutation, and what was measured is what the steps make of it";
        }
        meaning
    }

    /// The measured number with its uncertainty, where it has one.
    pub fn stated(&self) -> Option<Uncertain> {
        uncertain(self.measured?, self.uncertainty?)
    }

    /// The measured number as text: `0.886033(24)`, or with six decimals where it has no uncertainty.
    pub fn measured_text(&self) -> String {
        match (self.stated(), self.measured) {
            (Some(stated), _) => stated.to_string(),
            (None, measured) => number_or_none(measured),
        }
    }

    /// What theory says, as text, to the last digit of the measured number.
    pub fn predicted_text(&self) -> String {
        match (self.stated(), self.predicted) {
            (Some(stated), Some(predicted)) => stated.to_the_same_digit(predicted),
            (_, predicted) => number_or_none(predicted),
        }
    }

    /// By how many standard errors it is off theory, as text: `+1.2`; where they are more than a hundred, which says nothing
    /// any more, by what part of theory: `-3.4 %`.
    pub fn apart_text(&self) -> String {
        if self.is_strobed {
            return NONE.to_owned();
        }
        match (self.measured, self.uncertainty, self.predicted) {
            (Some(measured), Some(error), Some(predicted)) if error > 0.0 => {
                let apart = (measured - predicted) / error;
                let sign = if apart < 0.0 { '-' } else { '+' };
                match apart.abs() <= FAR {
                    true => format!("{sign}{}", short(apart.abs())),
                    false if predicted == 0.0 => "far".to_owned(),
                    false => {
                        let part = ((measured - predicted) / predicted).abs();
                        let sign = if measured < predicted { '-' } else { '+' };
                        format!("{sign}{} %", significant(100.0 * part, 2))
                    }
                }
            }
            _ => NONE.to_owned(),
        }
    }
}

fn number_or_none(number: Option<f64>) -> String {
    number.map_or(NONE.to_owned(), |number| fixed(number, DECIMALS))
}
