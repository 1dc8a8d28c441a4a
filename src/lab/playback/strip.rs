//! The geometry of a curve over time: it maps a time window to the columns of a strip.

use crate::engine::recording::{Extent, RecordedCurve, Recording, RecordingBin};
use std::ops::Range;

/// An interval shorter than this share of a column is rounding error.
const STRETCH_ROUNDING: f64 = 1e-6;
/// Maximum length of a window, s. It is small enough that adding it to a time does not overflow.
const LONGEST_S: f64 = f64::MAX / 4.0;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Strip {
    pub begin_s: f64,
    pub window_s: f64,
    pub columns: usize,
}

impl Strip {
    pub fn new(begin_s: f64, window_s: f64, columns: usize) -> Self {
        Self {
            begin_s,
            window_s: window_s.min(LONGEST_S),
            columns,
        }
    }

    pub fn end_s(&self) -> f64 {
        self.begin_s + self.window_s
    }

    /// Returns the column of `time_s` (s); `None` if that time is not shown.
    pub fn column(&self, time_s: f64) -> Option<usize> {
        let is_shown = time_s >= self.begin_s && time_s <= self.end_s() && self.columns > 0;
        is_shown.then(|| self.place(time_s).min(self.columns - 1))
    }

    pub fn time_s(&self, column: usize) -> f64 {
        self.begin_s + (column as f64 + 0.5) / self.columns.max(1) as f64 * self.window_s
    }

    /// Returns the columns that show part of the interval from `begin_s` to `end_s` (s).
    pub fn shown(&self, begin_s: f64, end_s: f64) -> Range<usize> {
        let (begin_s, end_s) = (begin_s.max(self.begin_s), end_s.min(self.end_s()));
        if begin_s >= end_s {
            return 0..0;
        }
        let [from, to] = [begin_s, end_s].map(|time_s| self.columns_before(time_s));
        let first = ((from + STRETCH_ROUNDING) as usize).min(self.columns.saturating_sub(1));
        // An interval that ends where a column begins does not include that column. Every interval has at least one
        // column.
        let end = ((to - STRETCH_ROUNDING).ceil() as usize).max(first + 1);
        first..end.min(self.columns)
    }

    /// Returns the number of columns from the left edge to `time_s` (s), negative before the edge.
    fn columns_before(&self, time_s: f64) -> f64 {
        (time_s - self.begin_s) / self.window_s * self.columns as f64
    }

    /// Returns the column of a time (s) that is not before the left edge. It may be beyond the right edge.
    fn place(&self, time_s: f64) -> usize {
        (self.columns_before(time_s).max(0.0) as usize).min(usize::MAX / 2)
    }

    /// Maps the bins of `recording` to columns, for all its curves at once.
    pub fn bins(&self, recording: &Recording) -> PlacedBins {
        let column = |time_s: f64| self.place(time_s.max(self.begin_s));
        let bins = recording.in_columns(self.begin_s, self.end_s(), Some(column));
        PlacedBins {
            columns: self.columns,
            placed: bins
                .map(|bin| {
                    let shown = self.column(bin.end_s);
                    let last = shown.unwrap_or_else(|| self.place(bin.end_s));
                    (bin, column(bin.begin_s).min(last), last)
                })
                .collect(),
        }
    }
}

pub struct PlacedBins {
    columns: usize,
    placed: Vec<(RecordingBin, usize, usize)>,
}

impl PlacedBins {
    /// Returns the minimum and maximum of `curve` in each column; `None` if the recording is empty there.
    ///
    /// They include all steps, and the straight lines to the steps before and after. No line crosses a time in `cuts`
    /// (s).
    pub fn columns(&self, curve: RecordedCurve, cuts: &[f64]) -> Vec<Option<Extent>> {
        let mut pen = StripPen {
            columns: vec![DrawnColumn::default(); self.columns],
            curve,
            cuts,
            before: None,
        };
        for (bin, first, last) in &self.placed {
            pen.draw(bin, *first, *last);
        }
        pen.finish()
    }
}

#[derive(Clone, Copy, Debug, Default)]
struct DrawnColumn {
    /// The extremes of the lines between bins, in the curve's unit. [`StripPen::finish`] adds the extremes of the bins.
    extent: Option<Extent>,
    stored: Option<Extent>,
}

fn include(all: &mut Option<Extent>, extent: Extent) {
    *all = Some(all.map_or(extent, |old| old.and(extent)));
}

struct StripPen<'a> {
    columns: Vec<DrawnColumn>,
    curve: RecordedCurve,
    cuts: &'a [f64],
    /// End (s), last column and stored extremes of the previous bin.
    before: Option<(f64, usize, Extent)>,
}

impl StripPen<'_> {
    /// Draws `bin` from column `first` to `last`, up to the right edge.
    fn draw(&mut self, bin: &RecordingBin, first: usize, last: usize) {
        let stored = bin.stored(self.curve);
        if let Some((end_s, column, from)) = self.before
            && column < first
            && !self.is_cut(end_s, bin.begin_s)
        {
            let [from, to] = [from, stored].map(|stored| self.curve.in_its_unit(stored));
            join(&mut self.columns, (column, from), (first, to));
        }
        for drawn in self.columns.iter_mut().take(last + 1).skip(first) {
            include(&mut drawn.stored, stored);
        }
        self.before = Some((bin.end_s, last, stored));
    }

    /// Returns true if there is a cut at `from_s` or later and before `to_s`.
    fn is_cut(&self, from_s: f64, to_s: f64) -> bool {
        let next = self.cuts.partition_point(|&cut| cut < from_s);
        self.cuts.get(next).is_some_and(|&cut| cut < to_s)
    }

    fn finish(mut self) -> Vec<Option<Extent>> {
        for drawn in &mut self.columns {
            if let Some(stored) = drawn.stored {
                include(&mut drawn.extent, self.curve.in_its_unit(stored));
            }
        }
        self.columns.iter().map(|drawn| drawn.extent).collect()
    }
}

/// Draws the straight line from one bin to the next: over the columns between them, and half a column in the column of
/// each bin. The line may extend beyond the right edge.
fn join(columns: &mut [DrawnColumn], from: (usize, Extent), to: (usize, Extent)) {
    let ((begin, from), (end, to)) = (from, to);
    let (leave, arrive) = nearest(from, to);
    if !(leave.is_finite() && arrive.is_finite()) {
        return; // the exact motion may overflow where the run does not
    }
    let length = (end - begin) as f64;
    let (low, high) = (leave.min(arrive), leave.max(arrive));
    for (index, drawn) in columns.iter_mut().take(end + 1).skip(begin).enumerate() {
        for place in [index as f64 - 0.5, index as f64 + 0.5] {
            let value = (leave + (arrive - leave) * (place / length)).clamp(low, high);
            include(&mut drawn.extent, Extent::single(value));
        }
    }
}

fn nearest(from: Extent, to: Extent) -> (f64, f64) {
    if from.max < to.min {
        (from.max, to.min)
    } else if to.max < from.min {
        (from.min, to.max)
    } else {
        let shared = from.min.max(to.min);
        (shared, shared)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_extremes_of_every_step_are_drawn(
            values in prop::collection::vec(-1.0..1.0f64, 2..9_000), columns in 1usize..300
        ) {
            let mut recording = Recording::default();
            for (step, &x) in values.iter().enumerate() {
                recording.push_values(step as f64, [x, 0.0, 0.0, -1.0]);
            }
            let strip = Strip::new(0.0, (values.len() - 1) as f64, columns);
            let drawn = strip.bins(&recording).columns(RecordedCurve::X, &[]);
            let whole = drawn.iter().flatten().copied().reduce(Extent::and);
            prop_assert_eq!(whole, values.iter().copied().map(Extent::single).reduce(Extent::and));
            prop_assert!(drawn.iter().all(Option::is_some), "a gap in a whole run");
        }
    }
}
