//! The measured numbers of a run beside the numbers of theory.

use super::exact_range::ExactRange;
use crate::analysis::Readouts;
use crate::analysis::readouts::{READOUTS, Readout, Source, find};
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
    /// How much more was measured than theory says, in the same unit; `None` of what is strobed.
    pub difference: Option<f64>,
    /// Since when it counts, s, where that is not the start.
    pub since_s: Option<f64>,
    /// Whether the time step is too long to see it: what was measured is no number of the motion then.
    pub is_strobed: bool,
}

/// The number that a time step can be too long to see.
const NUTATION: &str = "measured_nutation_period_s";

/// How the names of measured numbers begin.
const MEASURED: &str = "measured_";

/// The number whose theory is the difference of two others.
const SWING: &str = "measured_tilt_swing_deg";

/// Digits after the point of a number that has no uncertainty.
const DECIMALS: usize = 6;

/// Every measured number of the table of readouts that `readouts`, of the run of `scenario`, has a value of, or theory; `range`
/// is the one of the exact motion beside it.
pub fn quantities(
    scenario: &Scenario,
    readouts: &Readouts,
    range: Option<ExactRange>,
) -> Vec<Quantity> {
    // The first step under other forces: they changed where it began.
    let changed = readouts.since.checked_sub(1).filter(|step| *step > 0);
    let since_s = changed.map(|step| Clock::at(scenario, step).time_s(step));
    let measured = READOUTS
        .iter()
        .filter(|readout| readout.name.starts_with(MEASURED) && !readout.is_uncertainty());
    let quantities = measured.map(|readout| Quantity::new(readout, readouts, since_s, range));
    quantities
        .filter(|it| it.measured.is_some() || it.predicted.is_some())
        .collect()
}

impl Quantity {
    fn new(
        readout: &'static Readout,
        readouts: &Readouts,
        since_s: Option<f64>,
        range: Option<ExactRange>,
    ) -> Self {
        let number = |readout: Option<&Readout>| readout.and_then(|it| it.of(readouts).number());
        // Of the swing that the report's scheme makes there is a formula, which is no theory of the exact motion.
        let theory = readout.predicted().filter(|it| it.source == Source::Theory);
        let uncertainty = readout.uncertainty().filter(|_| theory.is_some());
        let predicted = match readout.name {
            SWING => swing_by_theory(readouts),
            name if readout.source == Source::EveryStep => {
                // What theory says of the motion since the forces last changed says nothing of the run before.
                let by_formula = number(theory).filter(|_| since_s.is_none());
                by_formula.or(range.and_then(|range| match name {
                    "measured_lowest_tilt_deg" => Some(range.tilt_deg.0),
                    "measured_highest_tilt_deg" => Some(range.tilt_deg.1),
                    "measured_lowest_z_m" => Some(range.z_m.0),
                    "measured_highest_z_m" => Some(range.z_m.1),
                    _ => None,
                }))
            }
            _ => number(theory),
        };
        let measured = number(Some(readout));
        let is_strobed = readout.name == NUTATION && readouts.nutation_is_resolved() == Some(false);
        let both = measured.zip(predicted).filter(|_| !is_strobed);
        Self {
            readout,
            measured,
            uncertainty: number(uncertainty),
            predicted,
            difference: both.map(|(measured, predicted)| measured - predicted),
            since_s: since_s.filter(|_| readout.source == Source::Measured),
            is_strobed,
        }
    }

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

    /// How much more was measured than theory says, as text with two digits: `+5.2e-10`.
    pub fn difference_text(&self) -> String {
        self.difference.map_or(NONE.to_owned(), |difference| {
            with_sign(difference, &significant(difference.abs(), 2))
        })
    }

    /// The same in standard errors: `+64.4`.
    pub fn in_errors_text(&self) -> String {
        match (self.difference, self.uncertainty) {
            (Some(difference), Some(error)) if error > 0.0 => {
                let errors = difference / error;
                with_sign(errors, &short(errors.abs()))
            }
            _ => NONE.to_owned(),
        }
    }
}

/// The swing of the tilt between its least and its greatest value of theory, degrees.
fn swing_by_theory(readouts: &Readouts) -> Option<f64> {
    let of = |name| find(name)?.of(readouts).number();
    Some(of("predicted_highest_tilt_deg")? - of("predicted_lowest_tilt_deg")?)
}

/// `size`, written without a sign, with the sign of `number`.
fn with_sign(number: f64, size: &str) -> String {
    match number {
        number if number < 0.0 => format!("-{size}"),
        number if number > 0.0 => format!("+{size}"),
        _ => size.to_owned(),
    }
}

fn number_or_none(number: Option<f64>) -> String {
    number.map_or(NONE.to_owned(), |number| fixed(number, DECIMALS))
}
