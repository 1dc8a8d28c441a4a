//! The numbers that were read off a run beside the numbers of theory.

use super::exact_range::ExactRange;
use crate::analysis::Readouts;
use crate::analysis::readouts::{READOUTS, Readout, Source, find};
use crate::run::Clock;
use crate::scenario::Scenario;
use crate::text::number::{NONE, fixed, short, significant, uncertain};
use crate::text::unit::Unit;

/// A measured number beside what theory says of it.
pub struct Row {
    /// What was measured, measured, theory, difference, the same in errors, unit.
    pub cells: [String; 6],
    pub meaning: String,
}

/// The number that a time step can be too long to see.
const NUTATION: &str = "measured_nutation_period_s";

/// How the names of measured numbers begin.
const MEASURED: &str = "measured_";

/// The number whose theory is the difference of two others.
const SWING: &str = "measured_tilt_swing_deg";

/// Digits after the point of a number that has no uncertainty.
const DECIMALS: usize = 6;

/// Every measured number of the table of readouts that `readouts`, of the run of `scenario`, has a value of, or theory.
pub fn rows(scenario: &Scenario, readouts: &Readouts, range: Option<ExactRange>) -> Vec<Row> {
    // The first step under other forces: they changed where it began.
    let changed = readouts.since.checked_sub(1).filter(|step| *step > 0);
    let since_s = changed.map(|step| Clock::at(scenario, step).time_s(step));
    let measured = READOUTS
        .iter()
        .filter(|readout| readout.name.starts_with(MEASURED) && !readout.is_uncertainty());
    let rows = measured.filter_map(|readout| {
        let predicted = predicted(readout, readouts, since_s, range);
        let since_s = since_s.filter(|_| readout.source == Source::Measured);
        row(readout, readouts, predicted, since_s)
    });
    rows.collect()
}

/// The number of the run that a readout is, in its unit.
fn number(readout: Option<&Readout>, readouts: &Readouts) -> Option<f64> {
    readout.and_then(|readout| readout.of(readouts).number())
}

/// The readout with the theory of the exact motion. (The swing that the report's scheme makes has a formula, which is none.)
fn theory(readout: &Readout) -> Option<&'static Readout> {
    readout.predicted().filter(|it| it.source == Source::Theory)
}

/// What theory says of `readout`; `range` is the one of the exact motion, `since_s` when the forces last changed.
fn predicted(
    readout: &Readout,
    readouts: &Readouts,
    since_s: Option<f64>,
    range: Option<ExactRange>,
) -> Option<f64> {
    let by_formula = number(theory(readout), readouts);
    match readout.name {
        SWING => {
            let of = |name| number(find(name), readouts);
            Some(of("predicted_highest_tilt_deg")? - of("predicted_lowest_tilt_deg")?)
        }
        name if readout.source == Source::EveryStep => {
            // What theory says of the motion since the forces last changed says nothing of the run before.
            let by_formula = by_formula.filter(|_| since_s.is_none());
            by_formula.or(range.and_then(|range| match name {
                "measured_lowest_tilt_deg" => Some(range.tilt_deg.0),
                "measured_highest_tilt_deg" => Some(range.tilt_deg.1),
                "measured_lowest_z_m" => Some(range.z_m.0),
                "measured_highest_z_m" => Some(range.z_m.1),
                _ => None,
            }))
        }
        _ => by_formula,
    }
}

/// The row of `readout`, which counts since `since_s` where that is not the start; `None` where nothing can be said.
fn row(
    readout: &Readout,
    readouts: &Readouts,
    predicted: Option<f64>,
    since_s: Option<f64>,
) -> Option<Row> {
    let measured = number(Some(readout), readouts);
    measured.or(predicted)?;
    let error = theory(readout).and(number(readout.uncertainty(), readouts));
    // What was measured of a nutation that the steps are too far apart to see is no number of the motion.
    let is_strobed = readout.name == NUTATION && readouts.nutation_is_resolved() == Some(false);
    let stated = measured
        .zip(error)
        .and_then(|(it, error)| uncertain(it, error));
    let both = measured.zip(predicted).filter(|_| !is_strobed);
    let difference = both.map(|(measured, predicted)| measured - predicted);
    let in_errors = difference.zip(error.filter(|error| *error > 0.0));
    let in_errors = in_errors.map(|(difference, error)| difference / error);
    let (label, meaning) = words(readout, is_strobed, since_s);
    let none = || NONE.to_owned();
    let plain = |number: Option<f64>| number.map_or_else(none, |number| fixed(number, DECIMALS));
    let to_its_digit = stated.as_ref().zip(predicted);
    Some(Row {
        cells: [
            format!("{label} (`{}`)", readout.name),
            stated
                .as_ref()
                .map_or_else(|| plain(measured), ToString::to_string),
            to_its_digit.map_or_else(
                || plain(predicted),
                |(it, value)| it.to_the_same_digit(value),
            ),
            difference.map_or_else(none, |it| with_sign(it, &significant(it.abs(), 2))),
            in_errors.map_or_else(none, |it| with_sign(it, &short(it.abs()))),
            readout.unit.to_owned(),
        ],
        meaning,
    })
}

/// The label of the row of `readout`, and the line that says what it is.
fn words(readout: &Readout, is_strobed: bool, since_s: Option<f64>) -> (String, String) {
    let mut label = bare(readout.name);
    let mut meaning = format!("{label}: {}", readout.meaning);
    let since_s = since_s.map(|since_s| significant(since_s, 9));
    if is_strobed {
        label += " (strobed)";
    }
    if let Some(since_s) = since_s {
        label += &format!(" since {since_s} s");
        meaning += &format!("; since the forces last changed, at t = {since_s} s");
    }
    if is_strobed {
        meaning += "; strobed: the time step is too long to see the nutation, and the number is what the steps make of it";
    }
    (label, meaning)
}

/// The `name` of a measured number in words.
fn bare(name: &str) -> String {
    let bare = name.strip_prefix(MEASURED).unwrap_or(name);
    let end = Unit::of(bare).map_or("", |unit| unit.end);
    bare[..bare.len() - end.len()].replace('_', " ")
}

/// `size`, written without a sign, with the sign of `number`.
fn with_sign(number: f64, size: &str) -> String {
    match number {
        number if number < 0.0 => format!("-{size}"),
        number if number > 0.0 => format!("+{size}"),
        _ => size.to_owned(),
    }
}
