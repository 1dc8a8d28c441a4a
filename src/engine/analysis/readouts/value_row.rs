//! The rows of the lab's values pane: how each readout is shown, and beside which exact value.

use super::Readouts;
use super::table::{READOUTS, Readout};
use crate::analysis::MeasuredNumber;
use crate::analysis::remarks::short_unit;
use crate::analysis::theory::{AxlePath, TheoryAxis};
use crate::run::Moment;
use crate::text::number::{exponent, fixed, rounded};

/// Below this number of seconds a period is shown in milliseconds.
const LEAST_SECONDS: f64 = 0.1;
/// The part of the arm, and of a value itself, that it may be off.
const OFF_PART: f64 = 0.01;
/// In fewer columns a number has at most three decimals.
const FULL_DECIMALS_FROM: usize = 7;
const NARROW_DECIMALS: usize = 3;
/// A smaller difference from the exact value has an exponent.
const LEAST_DECIMAL_DIFFERENCE: f64 = 1e-4;

/// The row of a readout in the values pane.
#[derive(Clone, Copy, Debug)]
pub struct ValueRow {
    pub group: ValueGroup,
    /// Its place among the rows of its group.
    pub place: u8,
    pub label: &'static str,
    /// The label in a narrow pane, at most 8 characters.
    pub short_label: &'static str,
    /// If there is no room for all rows, those of the highest rank are left out first; rank 0 stays.
    pub rank: u8,
    unit: ShownUnit,
    digits: Digits,
    tolerance: Tolerance,
    /// Reads it off a moment of the run, of the exact motion, or at the cursor.
    of_moment: Option<fn(&Moment) -> Option<f64>>,
    measured: Option<fn(&Readouts) -> Option<MeasuredNumber>>,
    /// Whether the motion has no such value.
    has_none: fn(&Readouts) -> bool,
}

#[derive(Clone, Copy, Debug)]
enum ShownUnit {
    OfReadout,
    /// This unit, and the number by which the readout is multiplied.
    Scaled(&'static str, f64),
    OfEnergy,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ValueGroup {
    Now,
    /// Extremes, angles and distances, where there is room for more.
    SoFar,
}

#[derive(Clone, Copy, Debug)]
enum Digits {
    /// Digits after the point.
    Decimals(usize),
    /// Four digits.
    Significant,
}

/// How far a value may be from the exact one before it is marked.
#[derive(Clone, Copy, Debug)]
pub(super) enum Tolerance {
    Any,
    /// 1 % of the traced point's distance from the pivot.
    OfArm,
    /// 1 % of the exact value.
    OfItself,
    /// A difference, in the readout's unit.
    Of(f64),
    /// In an unreliable run, this value may not be reached.
    UnlessReliable(f64),
}

pub(super) const fn now(place: u8, label: &'static str, short_label: &'static str) -> ValueRow {
    ValueRow {
        group: ValueGroup::Now,
        place,
        label,
        short_label,
        rank: 0,
        unit: ShownUnit::OfReadout,
        digits: Digits::Significant,
        tolerance: Tolerance::Any,
        of_moment: None,
        measured: None,
        has_none: |_| false,
    }
}

pub(super) const fn so_far(place: u8, label: &'static str) -> ValueRow {
    ValueRow {
        group: ValueGroup::SoFar,
        rank: 4 + place,
        ..now(place, label, label)
    }
}

impl ValueRow {
    pub(super) const fn rank(self, rank: u8) -> Self {
        Self { rank, ..self }
    }

    pub(super) const fn in_unit(self, unit: &'static str, factor: f64) -> Self {
        Self {
            unit: ShownUnit::Scaled(unit, factor),
            ..self
        }
    }

    pub(super) const fn in_unit_of_energy(self) -> Self {
        Self {
            unit: ShownUnit::OfEnergy,
            ..self
        }
    }

    pub(super) const fn unless(self, has_none: fn(&Readouts) -> bool) -> Self {
        Self { has_none, ..self }
    }

    pub(super) const fn decimals(self, decimals: usize) -> Self {
        Self {
            digits: Digits::Decimals(decimals),
            ..self
        }
    }

    pub(super) const fn off_by(self, tolerance: Tolerance) -> Self {
        Self { tolerance, ..self }
    }

    pub(super) const fn of_moment(self, of_moment: fn(&Moment) -> Option<f64>) -> Self {
        Self {
            of_moment: Some(of_moment),
            ..self
        }
    }

    pub(super) const fn measured(self, of: fn(&Readouts) -> Option<MeasuredNumber>) -> Self {
        Self {
            measured: Some(of),
            ..self
        }
    }
}

/// The rows of `group` with their readouts, in order.
pub fn value_rows(group: ValueGroup) -> Vec<(&'static Readout, ValueRow)> {
    let rows = READOUTS
        .iter()
        .filter_map(|readout| Some((readout, readout.row?)));
    let mut of_group: Vec<_> = rows.filter(|(_, row)| row.group == group).collect();
    of_group.sort_by_key(|(_, row)| row.place);
    of_group
}

/// What one row of the values pane shows: the run and the exact motion in one unit, now or at the cursor.
#[derive(Clone, Debug, PartialEq)]
pub struct ShownValue {
    pub unit: &'static str,
    /// The value of the run; `None` if there is none, or none yet.
    pub run: Option<f64>,
    /// Its standard error, if it is measured.
    pub uncertainty: Option<f64>,
    pub exact: Option<f64>,
    /// Whether the run's value disagrees with the exact one.
    pub is_off: bool,
    /// Whether the motion has no such value: its axle passes through the vertical.
    pub has_none: bool,
}

impl ValueRow {
    /// Reads the row of `readout`. `run` and `exact` are the moments that are shown.
    pub fn read(
        &self,
        readout: &Readout,
        readouts: &Readouts,
        run: &Moment,
        exact: Option<&Moment>,
    ) -> ShownValue {
        let measured = self.measured.and_then(|of| of(readouts));
        let settled = measured.filter(MeasuredNumber::is_settled);
        let value = match (self.of_moment, self.measured) {
            (Some(of), _) => of(run),
            (None, Some(_)) => settled.map(|number| number.value),
            (None, None) => readout.read_from(readouts).number(),
        };
        let exact_value = match self.of_moment {
            Some(of) => exact.and_then(of),
            None => readout
                .predicted()
                .and_then(|predicted| predicted.read_from(readouts).number()),
        };
        // A scheme that has broken down leaves neither a position nor an energy of a rigid body.
        let is_lost = readout.is_of_body() && !readouts.health.is_a_rotation;
        let known = value.filter(|value| !is_lost && value.is_finite());
        let (unit, factor) = self.unit_of(readout, readouts, known, exact_value);
        ShownValue {
            unit,
            run: known.map(|number| number * factor),
            uncertainty: settled.map(|number| number.uncertainty * factor),
            exact: exact_value.map(|number| number * factor),
            is_off: self.is_off(readouts, known, exact_value),
            has_none: known.is_none() && (self.has_none)(readouts),
        }
    }

    /// Returns whether it is read off one moment, not off the whole run.
    pub fn is_of_moment(&self) -> bool {
        self.of_moment.is_some()
    }

    fn unit_of(
        &self,
        readout: &Readout,
        readouts: &Readouts,
        run: Option<f64>,
        exact: Option<f64>,
    ) -> (&'static str, f64) {
        let longest = run.into_iter().chain(exact).fold(0.0, f64::max);
        match (self.unit, readout.unit) {
            (ShownUnit::Scaled(unit, factor), _) => (unit, factor),
            (ShownUnit::OfEnergy, _) => (short_unit(readouts.health.energy_unit), 1.0),
            (ShownUnit::OfReadout, "s") if longest > 0.0 && longest < LEAST_SECONDS => ("ms", 1e3),
            (ShownUnit::OfReadout, "deg") => ("°", 1.0),
            (ShownUnit::OfReadout, unit) => (unit, 1.0),
        }
    }

    fn is_off(&self, readouts: &Readouts, run: Option<f64>, exact: Option<f64>) -> bool {
        let difference = run.zip(exact).map(|(run, exact)| (run - exact).abs());
        let (number, most) = match self.tolerance {
            Tolerance::Any => return false,
            Tolerance::OfArm => (difference, OFF_PART * readouts.health.arm_m),
            Tolerance::OfItself => (difference, OFF_PART * exact.unwrap_or(0.0).abs()),
            Tolerance::Of(most) => (difference, most),
            Tolerance::UnlessReliable(most) => {
                let is_unreliable = readouts.health.is_believed() == Some(false);
                (run.filter(|_| is_unreliable), most)
            }
        };
        number.is_some_and(|number| number > most)
    }

    /// Writes `number` of this row on at most `width` columns.
    pub fn written(&self, number: f64, width: usize) -> String {
        let decimals = match self.digits {
            Digits::Decimals(decimals) => decimals,
            Digits::Significant => return four_digits(number, width),
        };
        let most = if width < FULL_DECIMALS_FROM {
            NARROW_DECIMALS
        } else {
            decimals
        };
        let text = fixed(number, decimals.min(most));
        if text.len() <= width {
            text
        } else {
            four_digits(number, width)
        }
    }

    /// Writes a difference from the exact value on at most `width` columns.
    pub fn difference(&self, number: f64, width: usize) -> String {
        if number.abs() < LEAST_DECIMAL_DIFFERENCE {
            return four_digits(number, width);
        }
        self.written(number, width)
    }
}

pub(super) fn passes_through_vertical(readouts: &Readouts) -> bool {
    readouts.theory.as_ref().is_some_and(|theory| {
        theory.axis == TheoryAxis::Z && theory.path == AxlePath::ThroughVertical
    })
}

/// Writes `number` with four digits, at most four of them after the point, on at most `width` columns: with fewer digits, or
/// with an exponent and two digits, if they do not fit.
pub fn four_digits(number: f64, width: usize) -> String {
    let size = rounded(number, 4).abs();
    let decimals = match size {
        0.0 => return "0".to_owned(),
        1e-3..1.0 => Some(4),
        1.0..10.0 => Some(3),
        10.0..100.0 => Some(2),
        100.0..1000.0 => Some(1),
        1000.0..1e5 => Some(0),
        _ => None,
    };
    let plain = decimals
        .into_iter()
        .flat_map(|most| (0..=most).rev())
        .map(|digits| fixed(number, digits));
    let mut fitting = plain
        .chain([exponent(number, 1)])
        .filter(|text| text.len() <= width);
    fitting.next().unwrap_or_else(|| exponent(number, 0))
}
