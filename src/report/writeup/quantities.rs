//! The numbers that were read off a run beside the numbers of theory.

use crate::engine::analysis::Readouts;
use crate::engine::analysis::readouts::{READOUTS, Readout, ReadoutSource};
use crate::engine::text::number::{NOT_AVAILABLE, fixed, short, significant, uncertain};
use crate::engine::text::unit::Unit;

/// A measured number beside what theory says of it.
pub struct QuantityRow {
    /// What was measured, measured, theory, difference, the same in errors, unit.
    pub cells: [String; 6],
    pub meaning: String,
    pub readout: &'static str,
}

/// The number that a time step can be too long to see.
const NUTATION: &str = "measured_nutation_period_s";

/// How the names of measured numbers begin.
const MEASURED_NAME_PREFIX: &str = "measured_";

/// The number whose theory is the difference of two others.
const SWING: &str = "measured_tilt_swing_deg";

/// Digits after the point of a number that has no uncertainty.
const DECIMALS: usize = 6;

/// Every number of the table that was read off the run and has a value in `readouts`, or theory.
/// `since_s` is when the forces last changed, where that is not the start.
pub fn rows(readouts: &Readouts, since_s: Option<f64>) -> Vec<QuantityRow> {
    let measured = READOUTS.iter().filter(|readout| {
        readout.name.starts_with(MEASURED_NAME_PREFIX) && !readout.is_uncertainty()
    });
    let rows = measured.filter_map(|readout| {
        let counted_since_s = since_s.filter(|_| readout.source == ReadoutSource::Measured);
        row(
            readout,
            readouts,
            predicted(readout, readouts, since_s),
            counted_since_s,
        )
    });
    rows.collect()
}

/// The number of the run that a readout is, in its unit.
fn number(readout: Option<&Readout>, readouts: &Readouts) -> Option<f64> {
    readout.and_then(|readout| readout.read_from(readouts).number())
}

/// The readout with the theory of the exact motion. (The swing that the report's scheme makes has a formula, which is none.)
fn theory(readout: &Readout) -> Option<&'static Readout> {
    readout
        .predicted()
        .filter(|it| it.source == ReadoutSource::Theory)
}

/// What theory says of `readout`; `since_s` is when the forces last changed.
fn predicted(readout: &Readout, readouts: &Readouts, since_s: Option<f64>) -> Option<f64> {
    if readout.name == SWING {
        let range_deg = readouts.predicted_tilt_range_deg();
        return range_deg.map(|(low, high)| high - low);
    }
    // What theory says of the motion since the forces last changed says nothing of the run before.
    let is_of_it = readout.source != ReadoutSource::EveryStep || since_s.is_none();
    number(theory(readout), readouts).filter(|_| is_of_it)
}

/// The row of `readout`, which counts since `since_s` where that is not the start; `None` where nothing can be said.
fn row(
    readout: &Readout,
    readouts: &Readouts,
    predicted: Option<f64>,
    since_s: Option<f64>,
) -> Option<QuantityRow> {
    let measured = number(Some(readout), readouts);
    measured.or(predicted)?;
    let error = theory(readout).and(number(readout.uncertainty(), readouts));
    // What was measured of a nutation that the steps are too far apart to see is no number of the motion.
    let is_strobed = readout.name == NUTATION && readouts.nutation_is_resolved() == Some(false);
    let stated = measured
        .zip(error)
        .and_then(|(it, error)| uncertain(it, error));
    let both = measured.zip(predicted).filter(|_| !is_strobed);
    let difference = both.map(|(own, of_theory)| own - of_theory);
    // What the theory of the mean moment leaves out is no error of reading.
    let is_exact = readouts.theory.is_none_or(|theory| theory.asymmetry == 0.0);
    let in_errors = difference
        .zip(error.filter(|error| *error > 0.0 && is_exact))
        .map(|(difference, error)| difference / error);
    let (label, meaning) = words(readout, is_strobed, since_s);
    let to_its_digit = stated.as_ref().zip(predicted);
    Some(QuantityRow {
        cells: [
            Some(label),
            stated
                .as_ref()
                .map(ToString::to_string)
                .or_else(|| Some(fixed(measured?, DECIMALS))),
            to_its_digit
                .map(|(it, value)| it.to_the_same_digit(value))
                .or_else(|| Some(fixed(predicted?, DECIMALS))),
            difference.map(|it| with_sign(it, &significant(it.abs(), 2))),
            in_errors.map(|it| with_sign(it, &short(it.abs()))),
            Some(readout.unit.to_owned()),
        ]
        .map(|cell| cell.unwrap_or_else(|| NOT_AVAILABLE.to_owned())),
        meaning,
        readout: readout.name,
    })
}

/// The label of the row of `readout`, and the line that says what it is.
fn words(readout: &Readout, is_strobed: bool, since_s: Option<f64>) -> (String, String) {
    let mut label = bare(readout.name);
    let mut meaning = format!("{label}: {}", readout.meaning);
    let changed_at = since_s.map(|since_s| significant(since_s, 9));
    if is_strobed {
        label += " (strobed)";
    }
    if let Some(time_s) = changed_at {
        label += &format!(" since {time_s} s");
        meaning += &format!("; since the forces last changed, at t = {time_s} s");
    }
    if is_strobed {
        meaning += "; strobed: the time step is too long to see the nutation, and the number is what the steps make of it";
    }
    (label, meaning)
}

/// The `name` of a measured number in words.
fn bare(name: &str) -> String {
    let bare = name.strip_prefix(MEASURED_NAME_PREFIX).unwrap_or(name);
    let end = Unit::from_name(bare).map_or("", |unit| unit.end);
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
