//! The range of values that an axis shows, and the round values at its ticks.

use crate::engine::recording::Extent;
use crate::engine::text::nice_numbers;
use crate::engine::text::number::rounded;

/// A tick this share of the range beyond an end is at the end: the difference is rounding.
const STRIP_TICK_ROUNDING: f64 = 1e-9;
/// Significant digits of a tick: no rounding of its last bits is seen.
const STRIP_TICK_DIGITS: usize = 15;
/// Digits of the ends of a range: its third significant digit is the last.
const END_DIGITS: f64 = 100.0;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StripScale {
    pub low: f64,
    pub high: f64,
}

impl StripScale {
    /// Creates the scale that shows `extent`, with a range of at least `least`.
    pub fn of(extent: Extent, least: f64) -> Self {
        let missing = (least - (extent.max - extent.min)).max(0.0);
        Self {
            low: extent.min - 0.5 * missing,
            high: extent.max + 0.5 * missing,
        }
    }

    /// Creates the scale from `-reach` to `reach`.
    pub fn about_zero(reach: f64) -> Self {
        let reach = reach.max(f64::MIN_POSITIVE);
        Self {
            low: -reach,
            high: reach,
        }
    }

    pub fn zoomed(&self, zoom: f64, value: f64) -> Self {
        Self {
            low: value + (self.low - value) / zoom,
            high: value + (self.high - value) / zoom,
        }
    }

    /// Returns the place of `value`: 0 at the high end, 1 at the low one.
    pub fn from_top(&self, value: f64) -> f64 {
        (self.high - value) / (self.high - self.low)
    }

    /// Digits after the point with which its ends are written: three significant digits of the range.
    pub fn decimals(&self) -> usize {
        decimals((self.high - self.low) / END_DIGITS)
    }
}

/// Digits after the point that numbers `apart` need to be told apart.
pub fn decimals(apart: f64) -> usize {
    (-libm::log10(apart) - STRIP_TICK_ROUNDING)
        .ceil()
        .clamp(0.0, 9.0) as usize
}
/// Returns the multiples of a number 1, 2 or 5 times a power of ten from `low` to `high`: as many as there can be, at
/// most `most`.
pub fn ticks(low: f64, high: f64, most: usize) -> Vec<f64> {
    let range = high - low;
    if !(range > 0.0 && range.is_finite()) || most == 0 {
        return Vec::new();
    }
    let first = nice_numbers::rung_below(range / most as f64);
    for rung in first..first + 4 {
        let apart = nice_numbers::rung(rung);
        let from = (low / apart - STRIP_TICK_ROUNDING).ceil();
        let to = (high / apart + STRIP_TICK_ROUNDING).floor();
        if to - from < most as f64 {
            let count = (to - from + 1.0).max(0.0) as usize;
            return (0..count)
                .map(|index| rounded((from + index as f64) * apart, STRIP_TICK_DIGITS))
                .collect();
        }
    }
    Vec::new()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_have_three_digits_of_the_range() {
        for (low, high, digits) in [
            (0.6, 0.95, 3),
            (1.045, 1.131, 4),
            (-0.8, 0.9, 2),
            (0.0, 230.0, 0),
        ] {
            assert_eq!(
                StripScale { low, high }.decimals(),
                digits,
                "{low} to {high}"
            );
        }
    }

    #[test]
    fn ticks_are_round_and_no_more_than_there_is_room_for() {
        for (low, high, most, expected) in [
            (0.0, 230.0, 6, &[0.0, 50.0, 100.0, 150.0, 200.0][..]),
            (0.0, 230.0, 2, &[0.0, 200.0]),
            (-0.8, 0.8, 5, &[-0.5, 0.0, 0.5]),
            (12.25, 12.35, 3, &[12.25, 12.3, 12.35]),
            (1.0, 1.0, 5, &[]),
            (0.0, f64::INFINITY, 5, &[]),
            (0.0, 1.0, 0, &[]),
        ] {
            assert_eq!(ticks(low, high, most), expected, "{low} to {high}");
        }
    }
}
