//! The geometry of a curve over time: a window of time on the columns of a strip.
//!
//! Time runs from left to right under one axis. Where the run goes on beyond the right edge, the window moves on by half
//! its length at once: between two such moves only the columns at the pen change, which a slow line can transmit, but
//! not a scrolling picture.

mod pen;

use super::recording::{Block, Curve, Extent, Recording};
use pen::Pen;
use std::ops::Range;

/// A stretch shorter than this share of a column is rounding.
const ROUNDING: f64 = 1e-6;

/// A tilt that changes by less than this, degrees, does not swing: it has no more than rounding.
pub(super) const LEAST_SWING_DEG: f64 = 0.01;

/// The longest window, s: small enough that adding it to a time does not overflow.
const LONGEST_S: f64 = f64::MAX / 4.0;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Strip {
    pub begin_s: f64,
    pub window_s: f64,
    pub columns: usize,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Column {
    /// The extremes of all steps in the column, and of the straight lines to the steps before and after.
    pub extent: Extent,
    /// Where the curve swings too fast to be drawn swing by swing: from the lowest to the highest values of the swings
    /// about the column.
    pub band: Option<Extent>,
}

impl Strip {
    pub fn new(begin_s: f64, window_s: f64, columns: usize) -> Self {
        Self {
            begin_s,
            window_s: window_s.min(LONGEST_S),
            columns,
        }
    }

    /// The window of `window_s` on `columns` for a run that stands at `now_s` (both s): the first one, or one later by
    /// half its length as often as that is needed.
    pub fn following(now_s: f64, window_s: f64, columns: usize) -> Self {
        let window_s = window_s.min(LONGEST_S);
        // A run of exactly one window ends at its right edge.
        let halves = ((now_s / window_s * (1.0 - 1e-12) - 1.0) / 0.5).ceil();
        Self::new(halves.max(0.0) * 0.5 * window_s, window_s, columns)
    }

    pub fn end_s(&self) -> f64 {
        self.begin_s + self.window_s
    }

    /// The column of `time_s` (s); `None` where it is not shown.
    pub fn column(&self, time_s: f64) -> Option<usize> {
        let is_shown = time_s >= self.begin_s && time_s <= self.end_s() && self.columns > 0;
        is_shown.then(|| self.place(time_s).min(self.columns - 1))
    }

    pub fn time_s(&self, column: usize) -> f64 {
        self.begin_s + (column as f64 + 0.5) / self.columns.max(1) as f64 * self.window_s
    }

    /// The columns in which some of the time from `begin_s` to `end_s` (s) is shown.
    pub fn shown(&self, begin_s: f64, end_s: f64) -> Range<usize> {
        let (begin_s, end_s) = (begin_s.max(self.begin_s), end_s.min(self.end_s()));
        if begin_s >= end_s {
            return 0..0;
        }
        let share = |time_s: f64| (time_s - self.begin_s) / self.window_s * self.columns as f64;
        let first = ((share(begin_s) + ROUNDING) as usize).min(self.columns.saturating_sub(1));
        // A stretch that ends where a column begins does not include that column; every stretch has at least one column.
        let end = ((share(end_s) - ROUNDING).ceil() as usize).max(first + 1);
        first..end.min(self.columns)
    }

    /// The column of a time (s) that is not before the left edge; it may lie beyond the right one.
    fn place(&self, time_s: f64) -> usize {
        let column = (time_s - self.begin_s) / self.window_s * self.columns as f64;
        (column.max(0.0) as usize).min(usize::MAX / 2)
    }

    /// Where the blocks of `recording` are on the columns: for all its curves at once.
    pub fn blocks(&self, recording: &Recording) -> Blocks {
        let column = |time_s: f64| self.place(time_s.max(self.begin_s));
        let place = |block: Block| {
            let last = if block.end_s <= self.end_s() {
                self.place(block.end_s).min(self.columns.saturating_sub(1))
            } else {
                self.place(block.end_s)
            };
            (block, column(block.begin_s).min(last), last)
        };
        let blocks = recording.in_columns(self.begin_s, self.end_s(), Some(column));
        Blocks {
            columns: self.columns,
            placed: blocks.map(place).collect(),
        }
    }
}

pub struct Blocks {
    columns: usize,
    placed: Vec<(Block, usize, usize)>,
}

impl Blocks {
    /// `curve` in each column; `None` where the recording has nothing. No line crosses a time of `cuts` (s).
    pub fn columns(&self, curve: Curve, cuts: &[f64]) -> Vec<Option<Column>> {
        let mut pen = Pen::new(self.columns, curve, cuts);
        for (block, first, last) in &self.placed {
            pen.draw(block, *first, *last);
        }
        pen.finish()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn drawn(strip: Strip, values: &[f64]) -> Vec<Option<Column>> {
        let mut recording = Recording::default();
        for (step, &x) in values.iter().enumerate() {
            recording.push_values(step as f64, [x, 0.0, 0.0, -1.0]);
        }
        strip.blocks(&recording).columns(Curve::X, &[])
    }

    /// On 100 columns the bands, where there are any, of 1000 steps of a sine of `period` steps.
    fn bands(period: f64) -> Vec<Option<Extent>> {
        let sine = |step: u32| libm::sin(f64::from(step) / period * std::f64::consts::TAU);
        let values: Vec<f64> = (0..1000).map(sine).collect();
        let columns = drawn(Strip::new(0.0, 1000.0, 100), &values);
        columns
            .iter()
            .map(|column| column.and_then(|column| column.band))
            .collect()
    }

    proptest! {
        #[test]
        fn every_sub_steps_extremes_are_drawn(
            values in prop::collection::vec(-1.0..1.0f64, 2..9_000), columns in 1usize..300
        ) {
            let now = (values.len() - 1) as f64;
            let drawn = drawn(Strip::following(now, now, columns), &values);
            let whole = drawn.iter().flatten().map(|column| column.extent).reduce(Extent::and);
            prop_assert_eq!(whole, values.iter().copied().map(Extent::of).reduce(Extent::and));
            prop_assert!(drawn.iter().all(Option::is_some), "a gap in a whole run");
            let has_all = |c: &Column| {
                let band = c.band.unwrap_or(c.extent);
                band.min <= c.extent.min + 1e-12 && c.extent.max <= band.max + 1e-12
            };
            prop_assert!(drawn.iter().flatten().all(has_all));
        }

        #[test]
        fn now_is_in_the_window_and_half_of_it_is_filled(
            now in 0.0..1e7f64, window in 0.01..500.0f64, columns in 1usize..200
        ) {
            let strip = Strip::following(now, window, columns);
            prop_assert!(strip.column(now).is_some());
            prop_assert!(strip.begin_s == 0.0 || now - strip.begin_s > 0.49 * window);
        }
    }

    #[test]
    fn swings_are_a_band_where_five_columns_hold_a_whole_one() {
        for (period, count) in [
            (25.0, 100),
            (10.0, 100),
            (7.3, 100),
            (2.5, 100),
            (60.0, 0),
            (100.0, 0),
            (1000.0, 0),
        ] {
            let bands: Vec<_> = bands(period).into_iter().flatten().collect();
            assert_eq!(bands.len(), count, "{period}");
            let is_whole = |band: &Extent| band.max > 0.9 && band.min < -0.9;
            assert!(bands.iter().all(is_whole), "{bands:?} of {period}");
        }
    }

    #[test]
    fn line_and_band_do_not_take_turns() {
        // As fast as can be drawn: of 13 columns some have five turns and some have six.
        for period in [50.0, 52.0] {
            let bands = bands(period);
            let changes = bands
                .windows(2)
                .filter(|pair| pair[0].is_some() != pair[1].is_some());
            let changes = changes.count();
            assert!(changes <= 2, "{period}: {changes}");
        }
    }
}
