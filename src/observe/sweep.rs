//! The geometry of an oscilloscope's sweep: the pen moves to the right over a picture that does not scroll.
//!
//! To the right of the pen, after a gap, the previous sweep is still shown. Only the columns at the pen change from frame
//! to frame; a slow line can transmit these, but not a scrolling picture.

use super::recording::{Block, Curve, Extent, Recording};

/// A part of a column below this share is rounding.
const ROUNDING: f64 = 1e-6;

/// The longest window, s: small enough that adding it to a time does not overflow.
const LONGEST_S: f64 = f64::MAX / 4.0;

/// A window of time on a number of columns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sweep {
    /// Length of the window, s.
    pub window_s: f64,
    /// When the present sweep began, s.
    pub begin_s: f64,
    /// Now, s.
    pub now_s: f64,
    /// Columns (of dots) the window is wide.
    pub columns: usize,
    /// Columns left empty ahead of the pen.
    pub gap: usize,
}

impl Sweep {
    /// The sweep at `now_s`, in a window of `window_s` (both s) that is `columns` wide, `gap` of them kept empty ahead
    /// of the pen.
    pub fn new(window_s: f64, now_s: f64, columns: usize, gap: usize) -> Self {
        let window_s = window_s.min(LONGEST_S);
        // A run of exactly one window ends at its right edge, not at its left.
        let sweeps = (now_s / window_s * (1.0 - 1e-12)).floor().max(0.0);
        Self {
            window_s,
            begin_s: sweeps * window_s,
            now_s,
            columns,
            gap,
        }
    }

    /// The column of the pen.
    pub fn pen(&self) -> usize {
        self.column(self.now_s)
    }

    /// The earliest time that is still shown, s.
    pub fn since_s(&self) -> f64 {
        (self.now_s - self.window_s).max(0.0)
    }

    /// The column of `time_s`, which lies within the present sweep or the previous one.
    fn column(&self, time_s: f64) -> usize {
        let passed = time_s - self.begin_s;
        let passed = if passed < 0.0 {
            passed + self.window_s
        } else {
            passed
        };
        let column = (passed / self.window_s * self.columns as f64) as usize;
        column.min(self.columns.saturating_sub(1))
    }

    /// Whether the previous sweep is still shown at `column`.
    fn keeps(&self, column: usize) -> bool {
        column > self.pen() + self.gap
    }

    /// The first and the last column of `block`; `None` where the present sweep has overwritten all of them.
    fn place(&self, block: &Block) -> Option<(usize, usize)> {
        let present = block.end_s >= self.begin_s;
        let begin_s = if present {
            block.begin_s.max(self.begin_s)
        } else {
            block.begin_s
        };
        let (first, last) = (self.column(begin_s), self.column(block.end_s));
        if present {
            return Some((first, last));
        }
        let first = (first..=last).find(|&column| self.keeps(column))?;
        Some((first, last))
    }

    /// The columns in which some of the time from `begin_s` to `end_s` (s) is shown.
    pub fn shown(&self, begin_s: f64, end_s: f64) -> Vec<usize> {
        let mut columns = self.clipped(begin_s, end_s, self.begin_s, self.now_s);
        let before = self.clipped(begin_s, end_s, self.begin_s - self.window_s, self.begin_s);
        columns.extend(before.into_iter().filter(|&column| self.keeps(column)));
        columns
    }

    /// The columns of the part of `begin_s` to `end_s` between `low_s` and `high_s`, which lie within one sweep.
    fn clipped(&self, begin_s: f64, end_s: f64, low_s: f64, high_s: f64) -> Vec<usize> {
        let (begin_s, end_s) = (begin_s.max(low_s), end_s.min(high_s));
        if low_s < 0.0 || begin_s >= end_s {
            return Vec::new();
        }
        let share = |time_s: f64| (time_s - low_s) / self.window_s * self.columns as f64;
        let first = ((share(begin_s) + ROUNDING) as usize).min(self.columns.saturating_sub(1));
        // A stretch that ends where a column begins does not include that column; every stretch has at least one column.
        let end = ((share(end_s) - ROUNDING).ceil() as usize).max(first + 1);
        (first..end.min(self.columns)).collect()
    }

    /// The column of `time_s` (s), `None` where it is not shown.
    pub fn place_of(&self, time_s: f64) -> Option<usize> {
        let column = self.column(time_s);
        let present = time_s >= self.begin_s && time_s <= self.now_s;
        let before = time_s >= self.since_s() && time_s < self.begin_s && self.keeps(column);
        (present || before).then_some(column)
    }

    /// The extremes of `curve` in each column of the present window, for a run that is over: they are given to the right of
    /// the pen too, and `None` after the end of that run. As in [`extents`](Self::extents), nothing is joined across `cuts`.
    pub fn extents_of_window(
        &self,
        recording: &Recording,
        curve: Curve,
        cuts: &[f64],
    ) -> Vec<Option<Extent>> {
        let end_s = self.begin_s + self.window_s;
        let mut pen = Pen::new(self.columns, curve, cuts);
        for block in recording.since(self.begin_s) {
            let (from_s, to_s) = (block.begin_s.max(self.begin_s), block.end_s.min(end_s));
            pen.draw(block, self.ahead(from_s), self.ahead(to_s));
            if block.end_s >= end_s {
                break;
            }
        }
        pen.columns
    }

    /// The column of `time_s` (s), also for times after the end of the present window.
    fn ahead(&self, time_s: f64) -> usize {
        let column = (time_s - self.begin_s) / self.window_s * self.columns as f64;
        (column as usize).min(usize::MAX / 2)
    }

    /// The extremes of `curve` in each column: of all steps in it, and of the straight lines to the steps before and after.
    /// No line crosses a time of `cuts` (s).
    pub fn extents(
        &self,
        recording: &Recording,
        curve: Curve,
        cuts: &[f64],
    ) -> Vec<Option<Extent>> {
        let mut pen = Pen::new(self.columns, curve, cuts);
        for block in recording.since(self.since_s()) {
            match self.place(block) {
                Some((first, last)) => pen.draw(block, first, last),
                None => pen.lift(),
            }
        }
        pen.columns
    }
}

/// Draws a curve block by block.
struct Pen<'a> {
    columns: Vec<Option<Extent>>,
    curve: Curve,
    cuts: &'a [f64],
    /// Of the previous block: its end, s, its last column and its extremes.
    before: Option<(f64, usize, Extent)>,
}

impl<'a> Pen<'a> {
    fn new(columns: usize, curve: Curve, cuts: &'a [f64]) -> Self {
        Self {
            columns: vec![None; columns],
            curve,
            cuts,
            before: None,
        }
    }

    /// Draws `block` from column `first` to `last`; columns beyond the right edge are left out.
    fn draw(&mut self, block: &Block, first: usize, last: usize) {
        let extent = block.extent(self.curve);
        if let Some((end_s, column, from)) = self.before
            && column < first
            && !self.is_cut(end_s, block.begin_s)
        {
            join(&mut self.columns, (column, from), (first, extent));
        }
        for slot in self.columns.iter_mut().take(last + 1).skip(first) {
            *slot = Some(slot.map_or(extent, |old: Extent| old.and(extent)));
        }
        self.before = Some((block.end_s, last, extent));
    }

    /// Starts a new line: the next block is not joined to the previous one.
    fn lift(&mut self) {
        self.before = None;
    }

    /// Whether there is a cut at `from_s` or later and before `to_s`.
    fn is_cut(&self, from_s: f64, to_s: f64) -> bool {
        let next = self.cuts.partition_point(|&cut| cut < from_s);
        self.cuts.get(next).is_some_and(|&cut| cut < to_s)
    }
}

/// Draws the straight line from one block to the next: over the columns between them, and half a column in each of the
/// blocks' own. It may lead beyond the right edge.
fn join(columns: &mut [Option<Extent>], from: (usize, Extent), to: (usize, Extent)) {
    let ((begin, from), (end, to)) = (from, to);
    let (leave, arrive) = nearest(from, to);
    if !(leave.is_finite() && arrive.is_finite()) {
        return; // the exact motion may overflow where the run does not
    }
    let length = (end - begin) as f64;
    let (low, high) = (leave.min(arrive), leave.max(arrive));
    let at = |place: f64| (leave + (arrive - leave) * (place / length)).clamp(low, high);
    let way = columns.iter_mut().take(end + 1).skip(begin);
    for (place, slot) in way.enumerate() {
        let place = place as f64;
        let way = Extent::of(at(place - 0.5)).and(Extent::of(at(place + 0.5)));
        *slot = Some(slot.map_or(way, |old| old.and(way)));
    }
}

/// The pair of values, one from each extent, with the smallest distance.
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
    use super::super::recording::Moment;
    use super::*;
    use nalgebra::Vector3;
    use proptest::prelude::*;

    fn recorded(values: &[f64], dt: f64) -> Recording {
        let mut recording = Recording::default();
        for (step, &x) in values.iter().enumerate() {
            let position = Vector3::new(x, 0.0, 0.0);
            recording.push(&Moment {
                time_s: step as f64 * dt,
                position,
                axle_height: 1.0,
            });
        }
        recording
    }

    #[test]
    fn what_is_no_number_is_joined_to_nothing() {
        let mut columns = vec![None; 8];
        let none = Extent::of(f64::NAN);
        for (from, to) in [
            (none, none),
            (none, Extent::of(1.0)),
            (Extent::of(f64::INFINITY), none),
        ] {
            join(&mut columns, (1, from), (5, to));
        }
        join(
            &mut columns,
            (1, Extent::of(f64::INFINITY)),
            (5, Extent::of(0.0)),
        );
        assert!(
            columns
                .iter()
                .flatten()
                .all(|extent| extent.min.is_finite()),
            "{columns:?}"
        );
    }

    proptest! {
        #[test]
        fn every_sub_steps_extremes_are_drawn(
            values in prop::collection::vec(-1.0..1.0f64, 2..9_000), columns in 1usize..300
        ) {
            let recording = recorded(&values, 1.0);
            let now = (values.len() - 1) as f64;
            let drawn = Sweep::new(now, now, columns, 2).extents(&recording, Curve::X, &[]);
            let of = |pick: fn(&Extent) -> f64| drawn.iter().flatten().map(pick).collect::<Vec<_>>();
            let (lowest, highest) = (of(|e| e.min), of(|e| e.max));
            prop_assert_eq!(lowest.into_iter().fold(2.0, f64::min), values.iter().copied().fold(2.0, f64::min));
            prop_assert_eq!(highest.into_iter().fold(-2.0, f64::max), values.iter().copied().fold(-2.0, f64::max));
            prop_assert!(drawn.iter().all(Option::is_some), "a gap in a whole run");
        }

        #[test]
        fn columns_stay_inside_the_window(
            steps in 1usize..4_000, window in 0.01..500.0f64, columns in 1usize..200, gap in 0usize..5
        ) {
            let recording = recorded(&vec![0.5; steps], 0.1);
            let sweep = Sweep::new(window, (steps - 1) as f64 * 0.1, columns, gap);
            prop_assert!(sweep.pen() < columns);
            prop_assert_eq!(sweep.extents(&recording, Curve::X, &[]).len(), columns);
        }
    }

    #[test]
    fn the_picture_stays_and_the_pen_moves() {
        let values: Vec<f64> = (0..150).map(f64::from).collect();
        let recording = recorded(&values, 1.0);
        let extents = Sweep::new(100.0, 149.0, 100, 4).extents(&recording, Curve::X, &[]);
        assert_eq!(extents[10].unwrap().max, 110.5);
        assert_eq!(extents[60].unwrap().max, 60.5);
        assert!(
            extents[50..=53].iter().all(Option::is_none),
            "{:?}",
            &extents[48..56]
        );
    }

    #[test]
    fn neighbours_are_joined() {
        let recording = recorded(&[0.0, 10.0], 1.0);
        let extents = Sweep::new(1.0, 1.0, 6, 0).extents(&recording, Curve::X, &[]);
        for pair in extents.windows(2) {
            assert!(pair[0].unwrap().max >= pair[1].unwrap().min - 1e-12);
        }
    }

    #[test]
    fn a_run_that_is_over_fills_the_window_and_no_more() {
        // A value a second, from 0 to 299; the window from 100 to 200 on 50 columns, the pen near its left end.
        let values: Vec<f64> = (0..300).map(f64::from).collect();
        let over = recorded(&values, 1.0);
        let drawn = Sweep::new(100.0, 103.0, 50, 2).extents_of_window(&over, Curve::X, &[]);
        assert_eq!(drawn[0].unwrap().min, 100.0);
        assert_eq!(drawn[49].unwrap().max, 199.5);
        assert!(drawn.iter().all(Option::is_some));
        let short = recorded(&values[..151], 1.0);
        let drawn = Sweep::new(100.0, 103.0, 50, 2).extents_of_window(&short, Curve::X, &[]);
        assert_eq!(drawn.iter().rposition(Option::is_some), Some(25));
        assert_eq!(drawn[25].unwrap().max, 150.0);
        let none = Sweep::new(100.0, 203.0, 50, 2).extents_of_window(&short, Curve::X, &[]);
        assert!(none.iter().all(Option::is_none));
    }

    #[test]
    fn stretches_are_shown_where_the_curves_are() {
        // The pen stands at column 24, and columns 25 and 26 are empty; from 27 on there is the sweep before.
        let sweep = Sweep::new(100.0, 149.0, 50, 2);
        assert_eq!((sweep.pen(), sweep.shown(100.0, 104.0)), (24, vec![0, 1]));
        assert_eq!(sweep.shown(140.0, 500.0), [20, 21, 22, 23, 24]);
        assert!(sweep.shown(150.0, 500.0).is_empty());
        assert_eq!(sweep.shown(40.0, 60.0), [27, 28, 29]);
        assert_eq!(sweep.shown(98.0, 102.0), [0, 49]);
        assert_eq!(sweep.shown(120.0, 120.0 + 1e-9), [10]);
        let place = |time_s| sweep.place_of(time_s);
        assert_eq!(place(120.0), Some(10));
        assert_eq!(place(149.0), Some(24));
        assert_eq!(place(149.1), None);
        assert_eq!(place(60.0), Some(30));
        assert_eq!(place(50.0), None);
        assert_eq!(place(40.0), None);
    }
}
