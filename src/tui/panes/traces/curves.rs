//! The curves of a strip: their recordings, and how they are drawn.

use super::canvas::{Canvas, Layer};
use super::content::StripContent;
use super::{Plot, Traces};
use crate::engine::recording::{Extent, RecordedCurve, Recording};
use crate::engine::run::marks::Marks;
use crate::lab::playback::envelope::{Rows, envelope};
use crate::lab::playback::scale::StripScale;
use std::ops::Range;

/// Period of the exact motion's dashes, and length of a dash, in columns of cells.
const EXACT_CELLS: (usize, usize) = (3, 2);
/// The same for the pinned run.
const PINNED_CELLS: (usize, usize) = (7, 5);
/// Period of the previous run's dots, in columns of dots.
const PREVIOUS_DOTS: usize = 3;

/// Tolerance, in rows of dots, by which a value on the edge between two dots counts as below it.
///
/// Otherwise a constant would move up and down with its rounding.
const DOT_ROUNDING: f64 = 1e-4;

/// Motion that a curve shows, in drawing order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum CurveOwner {
    Previous,
    Pinned,
    Exact,
    Run,
}

pub(super) const CURVE_OWNERS: [CurveOwner; 4] = [
    CurveOwner::Previous,
    CurveOwner::Pinned,
    CurveOwner::Exact,
    CurveOwner::Run,
];

impl Traces<'_> {
    /// Draws the curve of `owner` on `plot`, if there is one.
    pub(super) fn draw_curve(
        &self,
        owner: CurveOwner,
        plot: &Plot,
        marks: &Marks,
        canvas: &mut Canvas,
    ) {
        let Some((recording, curve)) = self.recorded(owner, plot.content) else {
            return;
        };
        let mut extents = plot
            .strip
            .bins(recording)
            .columns(curve, self.cuts(owner, marks));
        if owner == CurveOwner::Run {
            // The run may have been ahead of its current time; that part is not drawn.
            let now_s = self.0.run.now().time_s;
            let shown = plot.strip.shown(plot.strip.begin_s, now_s);
            extents[shown.end..].fill(None);
        }
        let across = canvas.in_a_cell().0;
        let columns = rows(&extents, &plot.scale, canvas.height());
        let is_drawn: fn(usize, usize) -> bool = match owner {
            CurveOwner::Run => return draw_run(&columns, |_| Layer::Run, canvas),
            CurveOwner::Previous => |x, cell| x.is_multiple_of(PREVIOUS_DOTS.min(cell + 1)),
            CurveOwner::Pinned => |x, cell| x / cell % PINNED_CELLS.0 < PINNED_CELLS.1,
            CurveOwner::Exact => |x, cell| x / cell % EXACT_CELLS.0 < EXACT_CELLS.1,
        };
        let layer = match owner {
            CurveOwner::Exact => Layer::Exact,
            _ => Layer::Previous,
        };
        for (x, column) in columns.iter().enumerate() {
            if let Some(rows) = column.filter(|_| is_drawn(x, across)) {
                canvas.upright(x, rows, layer);
            }
        }
    }

    /// Returns the ranges of cells in which the exact motion is above the strip, and those in which it is below.
    pub(super) fn exact_outside(&self, plot: &Plot, height: usize) -> [Vec<Range<usize>>; 2] {
        let Some((recording, curve)) = self.recorded(CurveOwner::Exact, plot.content) else {
            return [Vec::new(), Vec::new()];
        };
        let extents = plot.strip.bins(recording).columns(curve, &[]);
        let columns = rows(&extents, &plot.scale, height);
        let across = self.0.view.marker.dots().0;
        let last = height as f64 - 1.0;
        [
            stretches(&columns, across, |(_, lower)| lower < 0.0),
            stretches(&columns, across, |(upper, _)| upper > last),
        ]
    }

    /// Returns the recording of `content` for the motion of `owner`, and the curve in it, or `None` if it is not shown.
    pub(super) fn recorded(
        &self,
        owner: CurveOwner,
        content: StripContent,
    ) -> Option<(&Recording, RecordedCurve)> {
        match (owner, content) {
            (CurveOwner::Run, StripContent::Curve(curve)) => Some((self.0.run.recording(), curve)),
            (CurveOwner::Run, StripContent::Measured(index)) => self.0.measured?.recorded(index),
            (CurveOwner::Run, StripContent::Distance) => {
                Some((&self.0.overlay()?.distance, RecordedCurve::X))
            }
            (CurveOwner::Run, StripContent::Column) => {
                Some((self.0.column?.recording(), RecordedCurve::X))
            }
            (CurveOwner::Previous, StripContent::Column) => {
                Some((self.0.ghost.and(self.0.column)?.before()?, RecordedCurve::X))
            }
            (CurveOwner::Previous, StripContent::Curve(curve)) => {
                Some((&self.0.ghost?.recording, curve))
            }
            (CurveOwner::Previous, StripContent::Measured(index)) => {
                self.0.ghost.and(self.0.measured)?.recorded_before(index)
            }
            (CurveOwner::Pinned, StripContent::Curve(curve)) => {
                Some((&self.0.pinned?.recording, curve))
            }
            (CurveOwner::Exact, StripContent::Curve(curve)) => {
                Some((&self.0.overlay()?.recording, curve))
            }
            (CurveOwner::Previous, StripContent::Distance)
            | (
                CurveOwner::Pinned | CurveOwner::Exact,
                StripContent::Measured(_) | StripContent::Distance | StripContent::Column,
            ) => None,
        }
    }

    /// Returns the times at which a curve is interrupted, s.
    fn cuts<'s>(&'s self, owner: CurveOwner, marks: &'s Marks) -> &'s [f64] {
        let ghost = match owner {
            CurveOwner::Run => return &marks.edits,
            CurveOwner::Previous => self.0.ghost,
            CurveOwner::Pinned => self.0.pinned,
            CurveOwner::Exact => None,
        };
        ghost.map_or(&[], |ghost| &ghost.marks.edits)
    }

    /// Returns the extremes of a recorded quantity in the window.
    pub(super) fn recorded_extent(&self, content: StripContent) -> Option<Extent> {
        let window = &self.0.view.window;
        CURVE_OWNERS
            .into_iter()
            .filter_map(|owner| self.recorded(owner, content))
            .filter_map(|(recording, curve)| {
                recording.extent_between(window.begin_s, window.end_s, curve)
            })
            .reduce(Extent::and)
    }

    /// Returns the recorded value of `content` for the step at `time_s`.
    pub(super) fn value_at(&self, content: StripContent, time_s: f64) -> Option<f64> {
        let (recording, curve) = self.recorded(CurveOwner::Run, content)?;
        let bin = recording.between(time_s, time_s).last()?;
        (bin.samples() == 1).then(|| bin.extent(curve).max)
    }
}

/// Returns the rows of `extents` on a canvas of `height` rows of dots, for each column. They may be outside the canvas.
pub fn rows(extents: &[Option<Extent>], scale: &StripScale, height: usize) -> Vec<Option<Rows>> {
    let last = height.saturating_sub(1) as f64;
    let row = |value: f64| (scale.from_top(value) * last + DOT_ROUNDING).round();
    let rows = |extent: Extent| (row(extent.max), row(extent.min));
    extents.iter().map(|extent| extent.map(rows)).collect()
}

/// Draws a run as a line, or as an envelope where its swings are unresolved. `layer` returns the layer of a column.
pub fn draw_run(columns: &[Option<Rows>], layer: impl Fn(usize) -> Layer, canvas: &mut Canvas) {
    let envelope = envelope(columns);
    let mut before: Option<Rows> = None;
    for (x, column) in columns.iter().enumerate() {
        let edges = envelope.get(x).copied().flatten();
        match (edges, column) {
            (Some((upper, lower)), _) => {
                let (last_upper, last_lower) = before.unwrap_or((upper, lower));
                canvas.upright(x, (upper + 1.0, lower - 1.0), Layer::Fill);
                canvas.upright(x, toward(upper, last_upper), layer(x));
                canvas.upright(x, toward(lower, last_lower), layer(x));
            }
            (None, Some(rows)) => canvas.upright(x, *rows, layer(x)),
            (None, None) => {}
        }
        before = edges;
    }
}

/// Returns the rows from `row` to the one next to `before`, so that an edge has no gap.
fn toward(row: f64, before: f64) -> Rows {
    if before < row {
        (before + 1.0, row)
    } else {
        (row, (before - 1.0).max(row))
    }
}

/// Returns the ranges of cells, `across` columns each, in which `is_outside` holds for every column.
fn stretches(
    columns: &[Option<Rows>],
    across: usize,
    is_outside: impl Fn(Rows) -> bool,
) -> Vec<Range<usize>> {
    let mut stretches: Vec<Range<usize>> = Vec::new();
    for (cell, dots) in columns.chunks(across).enumerate() {
        if !dots.iter().all(|rows| rows.is_some_and(&is_outside)) {
            continue;
        }
        match stretches.last_mut() {
            Some(last) if last.end == cell => last.end = cell + 1,
            _ => stretches.push(cell..cell + 1),
        }
    }
    stretches
}
