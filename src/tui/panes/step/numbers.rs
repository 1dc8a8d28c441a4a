//! The numbers of a phase in columns: vectors and matrices of x, y and z, numbers by themselves, each with its unit.

use super::page::{Line, Section};
use crate::physics::workings::{Quantity, Value};
use crate::text::number::{NONE, exponent, significant};
use crate::text::wrap::columns;
use crate::tui::theme::Role;
use std::f64::consts::{PI, TAU};

/// Columns of the symbols, and of the units.
pub const SYMBOL: usize = 6;
const UNIT: usize = 6;
/// Columns of a number besides its digits: sign, point, a zero before it, and a space.
const AROUND: usize = 4;
/// The fewest and the most digits of a number.
const DIGITS: std::ops::RangeInclusive<usize> = 3..=9;
/// A number smaller than this part of the largest beside it is the rounding error of a zero: a few units in the last
/// place of its terms.
const ROUNDING: f64 = 16.0 * f64::EPSILON;
/// The text for such a number, which is not exactly zero.
const ALMOST_ZERO: &str = "~0";
/// A component that would show fewer digits than this is written with an exponent.
const LEAST_SEEN: i32 = 3;

const DIGITS_OF_TURNS: usize = 5;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Format {
    /// Columns of a number, with a space before it.
    pub cell: usize,
    /// Digits of the largest number of a vector, a matrix or a column.
    pub digits: usize,
}

impl Format {
    /// For `count` numbers side by side on `width` columns.
    pub fn new(width: usize, count: usize) -> Self {
        let digits = (width / count.max(1)).saturating_sub(AROUND);
        let digits = digits.clamp(*DIGITS.start(), *DIGITS.end());
        Self {
            cell: digits + AROUND,
            digits,
        }
    }

    /// For vectors between their symbols and their units on `width` columns.
    pub fn of_vectors(width: usize) -> Self {
        Self::new(width.saturating_sub(SYMBOL + UNIT), 3)
    }

    /// `numbers` with as many decimals as the largest needs, each as wide as a cell, the decimal points in one column.
    /// A number that is small beside the largest is written with an exponent, so that it does not look like zero; one
    /// that is its rounding error is written as almost zero.
    pub fn aligned(self, numbers: &[f64]) -> Vec<String> {
        let sizes = numbers.iter().map(|number| number.abs());
        let largest = sizes.filter(|size| size.is_finite()).fold(0.0, f64::max);
        let text = |number: &f64| format!("{:>1$}", self.one(*number, largest), self.cell);
        numbers.iter().map(text).collect()
    }

    /// `number` beside others of which `largest` is the largest.
    fn one(self, number: f64, largest: f64) -> String {
        if !number.is_finite() {
            return NONE.to_owned();
        }
        if number == 0.0 {
            return "0".to_owned();
        }
        if number.abs() <= ROUNDING * largest {
            return ALMOST_ZERO.to_owned();
        }
        let digits = self.digits as i32;
        let power = libm::floor(libm::log10(largest)) as i32;
        let wanted = digits - 1 - power;
        let decimals = wanted.min(digits);
        let seen = libm::floor(libm::log10(number.abs())) as i32 + decimals + 1;
        let fits = (0..=digits + 1).contains(&wanted);
        if fits && seen >= LEAST_SEEN {
            format!("{number:.*}", decimals.unsigned_abs() as usize)
        } else {
            // As many digits as leave room for the exponent.
            let text = exponent(number, 0);
            let taken = columns(&text) + 2;
            exponent(number, self.cell.saturating_sub(taken).min(self.digits - 1))
        }
    }
}

/// The lines of `quantity`, which is no table; `is_result` says whether the phase was about it.
pub fn lines(quantity: &Quantity, format: Format, is_result: bool) -> Vec<Line> {
    let role = if is_result { Role::Heading } else { Role::Text };
    let (numbers, across): (Vec<f64>, usize) = match &quantity.value {
        Value::Number(number) => (vec![*number], 1),
        Value::Vector(vector) => (vector.iter().copied().collect(), 3),
        Value::Matrix(matrix) => (matrix.transpose().iter().copied().collect(), 3),
        Value::Table(_) => return Vec::new(),
    };
    let mut cells = format.aligned(&numbers);
    if let [number] = numbers[..] {
        let text = significant(number, format.digits);
        if columns(&text) < format.cell {
            cells = vec![format!("{text:>0$}", format.cell)];
        }
    }
    let line = |cells: &[String]| Line::of(SYMBOL, cells.concat(), role);
    let mut lines: Vec<_> = cells.chunks(across).map(line).collect();
    let unit = SYMBOL + across * format.cell + 1;
    let unit = (unit, unit_of(quantity), Role::Quiet);
    lines[0].pieces.push(unit);
    let symbol = Line::of(0, quantity.symbol, Role::Focus);
    if columns(quantity.symbol) < SYMBOL {
        lines[0].pieces.extend(symbol.pieces);
    } else {
        lines.insert(0, symbol);
    }
    lines
}

/// The unit of `quantity`; after an angle of more than half a turn also how many turns it is.
fn unit_of(quantity: &Quantity) -> String {
    match quantity.value {
        Value::Number(angle) if quantity.unit == "rad" && angle.abs() > PI => {
            let turns = significant(angle / TAU, DIGITS_OF_TURNS);
            format!("rad = {turns} turns")
        }
        _ => quantity.unit.to_owned(),
    }
}

/// The heads of the columns of vectors and matrices.
pub fn heads(rank: u8, format: Format) -> Section {
    let heads = ["x", "y", "z"].map(|head| format!("{head:>0$}", format.cell));
    Section::new(rank, vec![Line::of(SYMBOL, heads.concat(), Role::Quiet)])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_number_is_wider_than_its_cell() {
        for width in [12, 30, 42, 60, 100] {
            let format = Format::of_vectors(width);
            for power in -320..308 {
                for other in [0, -3, -8, 5] {
                    let numbers = [-9.99999999_f64, 1.0, 5.5].map(|n| n * 10f64.powi(power));
                    let numbers = [numbers[0], numbers[1], numbers[2] * 10f64.powi(other)];
                    for text in format.aligned(&numbers) {
                        assert_eq!(columns(&text), format.cell, "{text} of {numbers:?}");
                    }
                }
            }
        }
    }
}
