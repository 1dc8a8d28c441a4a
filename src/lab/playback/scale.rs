//! The range of values that an axis shows, and the round values at its ticks.

use crate::engine::recording::Extent;
use crate::engine::text::nice_numbers;
use crate::engine::text::number::{fixed, rounded};

/// A tick this share of the range beyond an end stands at the end: the difference is rounding.
const STRIP_TICK_ROUNDING: f64 = 1e-9;

/// An end that is written this share of the range beside its place is read at that place.
const UNSEEN_TICK_OFFSET: f64 = 0.025;

/// Significant digits of a tick: no rounding of its last bits is seen.
const STRIP_TICK_DIGITS: usize = 15;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StripScale {
    pub low: f64,
    pub high: f64,
}

impl StripScale {
    /// Creates the scale from `-reach` to `reach`, rounded up.
    pub fn about_zero(reach: f64) -> Self {
        let reach = nice_above(reach.max(1e-9));
        Self {
            low: -reach,
            high: reach,
        }
    }

    /// Returns round numbers around `extent`, at least `least` apart; they change seldom while the extent grows.
    pub fn around(extent: Extent, least: f64) -> Self {
        let unit = nice_numbers::at_or_below((extent.max - extent.min).max(least) / 4.0);
        let (low, high) = ((extent.min / unit).floor(), (extent.max / unit).ceil());
        let missing = (least / unit - (high - low)).ceil().max(0.0);
        let below = (0.5 * missing).floor();
        Self {
            low: rounded((low - below) * unit, STRIP_TICK_DIGITS),
            high: rounded((high + missing - below) * unit, STRIP_TICK_DIGITS),
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

    pub fn meets(&self, extent: Extent) -> bool {
        extent.max >= self.low && extent.min <= self.high
    }

    /// Digits after the point with which its ends are written: as they are, or to a hundredth of the range.
    pub fn decimals(&self) -> usize {
        let range = self.high - self.low;
        let most = decimals(range / 100.0);
        (0..most)
            .find(|digits| {
                let unit = libm::exp10(-(*digits as f64));
                let [low, high] = [self.low, self.high]
                    .map(|end| (end / unit - (end / unit).round()).abs() * unit);
                low.max(high) < 1e-6 * range && unit < 0.5 * range
            })
            .unwrap_or(most)
    }

    /// Returns both ends in at most `width` columns: close together where there is no room for spaces, else as the
    /// middle and the distance of the ends from it, a middle of 0 left out if need be, and then with fewer digits, as
    /// long as no end is seen to be elsewhere. `None` where that has no room either.
    pub fn in_words_within(&self, width: usize) -> Option<String> {
        let digits = self.decimals();
        (0..=digits)
            .rev()
            .flat_map(|digits| self.forms(digits))
            .find(|words| words.chars().count() <= width)
    }

    /// Returns the ways to write both ends with `digits`, the longest first, where no end is seen to be elsewhere.
    fn forms(&self, digits: usize) -> Vec<String> {
        let unit = libm::exp10(-(digits as f64));
        let (middle, half) = (0.5 * (self.low + self.high), 0.5 * (self.high - self.low));
        let [low_fits, high_fits, middle_fits, half_fits] = [self.low, self.high, middle, half]
            .map(|value| {
                (value - (value / unit).round() * unit).abs()
                    <= UNSEEN_TICK_OFFSET * (self.high - self.low)
            });
        let [low, high, middle_text, half_text] =
            [self.low, self.high, middle, half].map(|value| fixed(value, digits));
        let mut forms = Vec::new();
        if low_fits && high_fits {
            forms.extend([format!("{low} .. {high}"), format!("{low}..{high}")]);
        }
        if middle_fits && half_fits {
            forms.push(format!("{middle_text} ± {half_text}"));
            forms.extend((middle == 0.0).then(|| format!("± {half_text}")));
        }
        forms
    }
}

/// Digits after the point that numbers `apart` need to be told apart.
pub fn decimals(apart: f64) -> usize {
    (-libm::log10(apart) - STRIP_TICK_ROUNDING)
        .ceil()
        .clamp(0.0, 9.0) as usize
}

/// Returns the smallest of 1, 1.2, 1.5, 2, 2.5, 3, 4, 5, 6, 8 times a power of ten that is not below `value` (> 0).
fn nice_above(value: f64) -> f64 {
    const TICK_STEPS: [f64; 11] = [1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0];
    let unit = libm::exp10(libm::log10(value).floor());
    let step = TICK_STEPS
        .into_iter()
        .find(|step| step * unit >= value * 0.999_999);
    step.unwrap_or(10.0) * unit
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_calm_value_needs_few_digits() {
        for (low, high, words) in [
            (29.999_999_75, 30.000_000_02, "29.99 .. 30.01"),
            (30.0, 30.0, "29.99 .. 30.01"),
            (31.4, 57.2, "30 .. 60"),
        ] {
            let scale = StripScale::around(Extent::single(low).and(Extent::single(high)), 0.02);
            assert_eq!(scale.in_words_within(40).unwrap(), words);
        }
    }

    #[test]
    fn ends_have_fewer_digits_where_there_is_little_room() {
        // With fewer digits than the last ones have, the ends would be elsewhere.
        for (low, high, width, words) in [
            (29.998_75, 30.001_25, 30, "29.99875 .. 30.00125"),
            (29.998_75, 30.001_25, 20, "29.99875 .. 30.00125"),
            (29.998_75, 30.001_25, 19, "29.99875..30.00125"),
            (29.998_75, 30.001_25, 17, "29.9988..30.0012"),
            (29.998_75, 30.001_25, 16, "29.9988..30.0012"),
            (29.998_75, 30.001_25, 15, ""),
            (0.6, 0.95, 12, "0.60 .. 0.95"),
            (0.6, 0.95, 10, "0.60..0.95"),
            (0.6, 0.95, 9, ""),
        ] {
            let scale = StripScale { low, high };
            let within = |room| scale.in_words_within(room).unwrap_or_default();
            assert_eq!(within(width), words, "{scale:?} within {width}");
            assert!((0..40).all(|room| within(room).chars().count() <= room));
        }
    }
}
