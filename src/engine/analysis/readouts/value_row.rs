//! The rows of the lab's values pane: how each readout is shown, and the exact value next to it.

use super::Readouts;
use super::table::{READOUTS, Readout};
use crate::analysis::MeasuredNumber;
use crate::analysis::remarks::short_unit;
use crate::analysis::theory::{AxlePath, TheoryAxis};
use crate::run::Moment;
use crate::text::number::{exponent, fixed, rounded};

/// Periods shorter than this are shown in milliseconds, s.
const LEAST_SECONDS: f64 = 0.1;
/// Tolerance as a fraction of the arm, or of the value itself.
const OFF_PART: f64 = 0.01;
/// Minimum width, in columns, for all decimals. In a narrower space, a number has at most three.
const FULL_DECIMALS_FROM: usize = 7;
const NARROW_DECIMALS: usize = 3;
/// Differences from the exact value smaller than this are written with an exponent.
const LEAST_DECIMAL_DIFFERENCE: f64 = 1e-4;

/// The row of a readout in the values pane.
#[derive(Clone, Copy, Debug)]
pub struct ValueRow {
    pub group: ValueGroup,
    /// Position among the rows of its group.
    pub place: u8,
    pub label: &'static str,
    /// The label in a narrow pane, at most 8 characters.
    pub short_label: &'static str,
    /// Order in which rows leave the pane if there is no room for all. The highest rank leaves first, and rank 0 stays.
    pub rank: u8,
    unit: ShownUnit,
    digits: Digits,
    tolerance: Tolerance,
    /// Reads the value at a moment of the run, of the exact motion, or at the cursor.
    of_moment: Option<fn(&Moment) -> Option<f64>>,
    measured: Option<fn(&Readouts) -> Option<MeasuredNumber>>,
    /// Returns true if the motion has no such value.
    has_none: fn(&Readouts) -> bool,
}

#[derive(Clone, Copy, Debug)]
enum ShownUnit {
    OfReadout,
    /// A unit, and the factor by which the readout is multiplied.
    Scaled(&'static str, f64),
    OfEnergy,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ValueGroup {
    Now,
    /// Extremes, angles and distances, shown if there is room.
    SoFar,
}

#[derive(Clone, Copy, Debug)]
enum Digits {
    /// Digits after the decimal point.
    Decimals(usize),
    /// Four significant digits.
    Significant,
}

/// Maximum difference from the exact value before a value is marked.
#[derive(Clone, Copy, Debug)]
pub(super) enum Tolerance {
    Any,
    /// 1 % of the traced point's distance from the pivot.
    OfArm,
    /// 1 % of the exact value.
    OfItself,
    /// A fixed difference, in the readout's unit.
    Of(f64),
    /// In an unreliable run, any value above this one is marked.
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

/// Returns the rows of `group` with their readouts, in order.
pub fn value_rows(group: ValueGroup) -> Vec<(&'static Readout, ValueRow)> {
    let rows = READOUTS
        .iter()
        .filter_map(|readout| Some((readout, readout.row?)));
    let mut of_group: Vec<_> = rows.filter(|(_, row)| row.group == group).collect();
    of_group.sort_by_key(|(_, row)| row.place);
    of_group
}

/// Content of one row of the values pane: the run and the exact motion in one unit, now or at the cursor.
#[derive(Clone, Debug, PartialEq)]
pub struct ShownValue {
    pub unit: &'static str,
    /// Value of the run; `None` if there is none, or none yet.
    pub run: Option<f64>,
    /// Standard error of the run's value, if it is measured.
    pub uncertainty: Option<f64>,
    pub exact: Option<f64>,
    /// True if the run's value disagrees with the exact one.
    pub is_off: bool,
    /// True if the motion has no such value because its axle passes through the vertical.
    pub has_none: bool,
}

impl ValueRow {
    /// Reads the row of `readout`. `run` and `exact` are the moments to show.
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
        // A scheme that has broken down yields neither the position nor the energy of a rigid body.
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

    /// Returns true if the value is read at one moment, and not from the whole run.
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

    /// Formats `number` for this row, in at most `width` columns.
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

    /// Formats a difference from the exact value, in at most `width` columns.
    pub fn difference(&self, number: f64, width: usize) -> String {
        if number.abs() < LEAST_DECIMAL_DIFFERENCE {
            return four_digits(number, width);
        }
        self.written(number, width)
    }
}

pub fn passes_through_vertical(readouts: &Readouts) -> bool {
    readouts.theory.as_ref().is_some_and(|theory| {
        theory.axis == TheoryAxis::Z && theory.path == AxlePath::ThroughVertical
    })
}

/// Formats `number` with four digits, at most four of them decimals, in at most `width` columns. If they do not fit, it
/// uses fewer digits, or an exponent and two digits.
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
