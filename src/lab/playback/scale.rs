//! The range of values on an axis, and the number of decimals for its labels.

use crate::engine::recording::Extent;

/// Rounding error of a decimal logarithm, allowed when digits are counted.
const STRIP_TICK_ROUNDING: f64 = 1e-9;
/// Ratio of a range to the last digit of its ends, which is the third significant digit of the range.
const END_DIGITS: f64 = 100.0;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StripScale {
    pub low: f64,
    pub high: f64,
}

impl StripScale {
    /// Creates a scale that shows `extent`, with a range of at least `least`.
    pub fn of(extent: Extent, least: f64) -> Self {
        let missing = (least - (extent.max - extent.min)).max(0.0);
        Self {
            low: extent.min - 0.5 * missing,
            high: extent.max + 0.5 * missing,
        }
    }

    /// Creates a scale from `-reach` to `reach`.
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

    /// Returns the position of `value`: 0 at the high end, 1 at the low end.
    pub fn from_top(&self, value: f64) -> f64 {
        (self.high - value) / (self.high - self.low)
    }

    /// Returns the number of decimals of its ends: three significant digits of the range.
    pub fn decimals(&self) -> usize {
        decimals((self.high - self.low) / END_DIGITS)
    }
}

/// Returns the number of decimals at which numbers that differ by `apart` can be distinguished.
pub fn decimals(apart: f64) -> usize {
    (-libm::log10(apart) - STRIP_TICK_ROUNDING)
        .ceil()
        .clamp(0.0, 9.0) as usize
}
#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_show_the_range_to_three_digits() {
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
}
