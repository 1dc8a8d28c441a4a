//! The geometry of a curve over time: a window of time on the columns of a strip.
//!
//! Time runs from left to right under one axis. Where the run goes on beyond the right edge, the window moves on by half
//! its length at once: between two such moves only the columns at the pen change, which a slow line can transmit, but
//! not a scrolling picture.

use crate::engine::recording::{Extent, RecordedCurve, Recording, RecordingBin};
use std::ops::Range;

/// A stretch shorter than this share of a column is rounding.
const STRETCH_ROUNDING: f64 = 1e-6;

/// A tilt that changes by less than this, degrees, does not swing: it has no more than rounding.
pub(super) const LEAST_DRAWN_SWING_DEG: f64 = 0.01;

/// The longest window, s: small enough that adding it to a time does not overflow.
const LONGEST_S: f64 = f64::MAX / 4.0;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Strip {
    pub begin_s: f64,
    pub window_s: f64,
    pub columns: usize,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StripColumn {
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

    /// Returns the window of `window_s` on `columns` for a run that is at `now_s` (both s): the first one, or one
    /// later by half its length as often as that is needed.
    pub fn following(now_s: f64, window_s: f64, columns: usize) -> Self {
        let first = Self::new(0.0, window_s, columns);
        // A run of exactly one window ends at its right edge.
        let halves = ((now_s / first.window_s * (1.0 - 1e-12) - 1.0) / 0.5).ceil();
        Self {
            begin_s: halves.max(0.0) * 0.5 * first.window_s,
            ..first
        }
    }

    pub fn end_s(&self) -> f64 {
        self.begin_s + self.window_s
    }

    /// Returns the column of `time_s` (s); `None` where it is not shown.
    pub fn column(&self, time_s: f64) -> Option<usize> {
        let is_shown = time_s >= self.begin_s && time_s <= self.end_s() && self.columns > 0;
        is_shown.then(|| self.place(time_s).min(self.columns - 1))
    }

    pub fn time_s(&self, column: usize) -> f64 {
        self.begin_s + (column as f64 + 0.5) / self.columns.max(1) as f64 * self.window_s
    }

    /// Returns the columns in which some of the time from `begin_s` to `end_s` (s) is shown.
    pub fn shown(&self, begin_s: f64, end_s: f64) -> Range<usize> {
        let (begin_s, end_s) = (begin_s.max(self.begin_s), end_s.min(self.end_s()));
        if begin_s >= end_s {
            return 0..0;
        }
        let [from, to] = [begin_s, end_s].map(|time_s| self.columns_before(time_s));
        let first = ((from + STRETCH_ROUNDING) as usize).min(self.columns.saturating_sub(1));
        // A stretch that ends where a column begins does not include that column; every stretch has at least one column.
        let end = ((to - STRETCH_ROUNDING).ceil() as usize).max(first + 1);
        first..end.min(self.columns)
    }

    /// Returns the number of columns from the left edge to `time_s` (s), negative before the edge.
    fn columns_before(&self, time_s: f64) -> f64 {
        (time_s - self.begin_s) / self.window_s * self.columns as f64
    }

    /// Returns the column of a time (s) that is not before the left edge; it may lie beyond the right one.
    fn place(&self, time_s: f64) -> usize {
        (self.columns_before(time_s).max(0.0) as usize).min(usize::MAX / 2)
    }

    /// Places the bins of `recording` on the columns, for all its curves at once.
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
    /// `curve` in each column; `None` where the recording has nothing. No line crosses a time of `cuts` (s).
    pub fn columns(&self, curve: RecordedCurve, cuts: &[f64]) -> Vec<Option<StripColumn>> {
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

/// Columns on either side over which the turns of a curve are counted to tell whether its swings can be drawn one by one.
const NEIGHBOURS: usize = 6;

/// With more turns in a column than this, swings cannot be drawn one by one: a swing has two turns and needs five columns.
const MOST_COLUMN_TURNS: f64 = 0.4;

/// The part of a band's width by which slow motion may carry the curve in two swings.
const MOST_CARRIED: f64 = 0.5;

#[derive(Clone, Copy, Debug, Default)]
struct DrawnColumn {
    /// The extremes of the lines from bin to bin, in the curve's unit; [`StripPen::finish`] adds those of the bins.
    extent: Option<Extent>,
    stored: Option<Extent>,
    turns: f64,
    /// How often the tilt turns, which swings with every nutation; the curve itself does not turn where slow motion is
    /// faster than its swings.
    turns_of_tilt: f64,
    tilt: Option<Extent>,
}

fn include(all: &mut Option<Extent>, extent: Extent) {
    *all = Some(all.map_or(extent, |old| old.and(extent)));
}

struct StripPen<'a> {
    columns: Vec<DrawnColumn>,
    curve: RecordedCurve,
    cuts: &'a [f64],
    /// Of the previous bin: its end, s, its last column and its stored extremes.
    before: Option<(f64, usize, Extent)>,
}

impl StripPen<'_> {
    /// Draws `bin` from column `first` to `last`; columns beyond the right edge are left out.
    pub fn draw(&mut self, bin: &RecordingBin, first: usize, last: usize) {
        let stored = bin.stored(self.curve);
        if let Some((end_s, column, from)) = self.before
            && column < first
            && !self.is_cut(end_s, bin.begin_s)
        {
            let [from, to] = [from, stored].map(|stored| self.curve.in_its_unit(stored));
            join(&mut self.columns, (column, from), (first, to));
        }
        let share = 1.0 / (last + 1 - first) as f64;
        let turns = f64::from(bin.turns(self.curve)) * share;
        let turns_of_tilt = f64::from(bin.turns(RecordedCurve::Tilt)) * share;
        let tilt = bin.stored(RecordedCurve::Tilt);
        for drawn in self.columns.iter_mut().take(last + 1).skip(first) {
            include(&mut drawn.stored, stored);
            drawn.turns += turns;
            drawn.turns_of_tilt += turns_of_tilt;
            include(&mut drawn.tilt, tilt);
        }
        self.before = Some((bin.end_s, last, stored));
    }

    /// Returns true if there is a cut at `from_s` or later and before `to_s`.
    fn is_cut(&self, from_s: f64, to_s: f64) -> bool {
        let next = self.cuts.partition_point(|&cut| cut < from_s);
        self.cuts.get(next).is_some_and(|&cut| cut < to_s)
    }

    /// Returns the columns that have something, up to `reach` columns from the column `index`.
    fn about(&self, index: usize, reach: usize) -> impl Iterator<Item = (usize, &DrawnColumn)> {
        self.columns
            .iter()
            .enumerate()
            .take(index + reach + 1)
            .skip(index.saturating_sub(reach))
            .filter(|(_, drawn)| drawn.extent.is_some())
    }

    /// Returns how often the curve turns in a column about the column `index`; where slow motion carries it along, how
    /// often the tilt does, which swings with every nutation.
    fn turns(&self, index: usize) -> f64 {
        let (mut columns, mut turns, mut turns_of_tilt, mut tilt) = (0.0, 0.0, 0.0, None);
        for (_, drawn) in self.about(index, NEIGHBOURS) {
            columns += 1.0;
            turns += drawn.turns;
            turns_of_tilt += drawn.turns_of_tilt;
            if let Some(extent) = drawn.tilt {
                include(&mut tilt, extent);
            }
        }
        match tilt.map(|stored| RecordedCurve::Tilt.in_its_unit(stored)) {
            Some(tilt) if tilt.max - tilt.min > LEAST_DRAWN_SWING_DEG => {
                f64::max(turns, turns_of_tilt) / columns
            }
            _ => turns / f64::max(columns, 1.0),
        }
    }

    /// Returns the curve in each column; `None` where nothing was drawn.
    pub fn finish(mut self) -> Vec<Option<StripColumn>> {
        for drawn in &mut self.columns {
            if let Some(stored) = drawn.stored {
                include(&mut drawn.extent, self.curve.in_its_unit(stored));
            }
        }
        let mut drawn = self.columns.iter().map(|drawn| drawn.extent.is_some());
        let ends = (
            drawn.clone().position(|is_drawn| is_drawn).unwrap_or(0),
            drawn.rposition(|is_drawn| is_drawn).unwrap_or(0),
        );
        let all = 0..self.columns.len();
        let turns: Vec<_> = all
            .clone()
            .map(|index| self.turns(inside(index, NEIGHBOURS, ends)))
            .collect();
        // A swing has two turns: half of one on either side.
        let reach: Vec<_> = turns
            .iter()
            .map(|turns| ((1.0 / turns).ceil() as usize).min(NEIGHBOURS))
            .collect();
        let swings: Vec<_> = all
            .clone()
            .map(|index| self.extent_about(index, reach[index]))
            .collect();
        let fast: Vec<_> = all
            .clone()
            .map(|index| is_fast(index, turns[index], &swings, ends))
            .collect();
        all.map(|index| {
            let extent = self.columns[index].extent?;
            // As most of the columns about it are, lest line and band take turns.
            let about = self.about(inside(index, NEIGHBOURS, ends), NEIGHBOURS);
            let (count, bands) = about.fold((0, 0), |(count, bands), (column, _)| {
                (count + 1, bands + usize::from(fast[column]))
            });
            // The mean of the extremes of all swings that have the column in them: it goes straight from one swing to the
            // next where they grow or shrink.
            let band = mean(&swings, index, reach[index]).filter(|_| 2 * bands > count);
            Some(StripColumn {
                extent,
                band: band.map(|band| band.and(extent)),
            })
        })
        .collect()
    }

    fn extent_about(&self, index: usize, reach: usize) -> Option<Extent> {
        let extents = self
            .about(index, reach)
            .filter_map(|(_, drawn)| drawn.extent);
        extents.reduce(Extent::and)
    }
}

/// Returns the column `index`, or the one `away` columns inside of the nearer of the curve's `ends`: near an end there
/// are turns on one side only.
fn inside(index: usize, away: usize, (first, last): (usize, usize)) -> usize {
    index
        .max((first + away).min(last))
        .min(last.saturating_sub(away).max(first))
}

/// Returns true if a curve with these `turns` in a column about the column `index` is too fast to be drawn swing by
/// swing; `swings` are its extremes over a swing about each column. Where slow motion carries it further in two swings
/// than it swings, before and after, it is drawn as it is.
fn is_fast(index: usize, turns: f64, swings: &[Option<Extent>], ends: (usize, usize)) -> bool {
    if turns <= MOST_COLUMN_TURNS {
        return false;
    }
    let away = (4.0 / turns).ceil() as usize;
    let here = inside(index, 2 * away, ends);
    let before = here.saturating_sub(away).max(ends.0);
    let after = (here + away).min(ends.1);
    let middles = [before, here, after]
        .map(|at| swings[at].map_or(0.0, |swing| 0.5 * (swing.min + swing.max)));
    let carried = (middles[0] - middles[1])
        .abs()
        .min((middles[2] - middles[1]).abs());
    swings[index].is_some_and(|swing| carried < MOST_CARRIED * (swing.max - swing.min))
}

/// Returns the mean lowest and the mean highest value of `extents` up to `reach` from `index`.
fn mean(extents: &[Option<Extent>], index: usize, reach: usize) -> Option<Extent> {
    let about = extents
        .iter()
        .take(index + reach + 1)
        .skip(index.saturating_sub(reach));
    let (min, max, count) = about
        .flatten()
        .fold((0.0, 0.0, 0.0), |(min, max, count), extent| {
            (min + extent.min, max + extent.max, count + 1.0)
        });
    (count > 0.0).then_some(Extent {
        min: min / count,
        max: max / count,
    })
}

/// Draws the straight line from one bin to the next: over the columns between them, and half a column in each of the
/// bins' own. It may lead beyond the right edge.
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

    fn drawn(strip: Strip, values: &[f64]) -> Vec<Option<StripColumn>> {
        let mut recording = Recording::default();
        for (step, &x) in values.iter().enumerate() {
            recording.push_values(step as f64, [x, 0.0, 0.0, -1.0]);
        }
        strip.bins(&recording).columns(RecordedCurve::X, &[])
    }

    /// On 100 columns the bands, where there are any, of 1000 steps of a sine of `period` steps.
    fn bands(period: f64) -> Vec<Option<Extent>> {
        let values: Vec<f64> = (0..1000)
            .map(|step: u32| libm::sin(f64::from(step) / period * std::f64::consts::TAU))
            .collect();
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
            prop_assert_eq!(whole, values.iter().copied().map(Extent::single).reduce(Extent::and));
            prop_assert!(drawn.iter().all(Option::is_some), "a gap in a whole run");
            let has_all = |c: &StripColumn| {
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
            assert!(
                bands.iter().all(|band| band.max > 0.9 && band.min < -0.9),
                "{bands:?} of {period}"
            );
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
