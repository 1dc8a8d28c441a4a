//! Curves and paths whose turns are too dense on paper: draws a band from minimum to maximum, and finds a time range in
//! which the turns are visible.

use super::course::{Bin, SampledRun};
use super::job::{Dense, SampledRunNumbers};
use super::path::TracedPath;
use super::spec::FigureSpec;
use crate::engine::export::CsvColumn;
use crate::engine::recording::Extent;
use crate::engine::text::nice_numbers;
use crate::plot::PT_PER_MM;
use crate::plot::chart::layout::{ChartLayout, PlacedPanel};
use crate::plot::chart::{Chart, ChartSeries};
use crate::plot::line;
use crate::plot::scene::Point;
use crate::plot::stroke_outline::Grid;

/// Width of the parts of a panel that are examined, pt.
const PART_PT: f64 = 1.0;
/// A part of a curve is dense if its lines cover this fraction of the part's width, and reach over this fraction of the
/// panel's height.
const FILLED: f64 = 0.75;
const HIGH: f64 = 0.05;
/// A curve is dense if more than this fraction of its parts is dense; a path if this fraction of its positions is
/// inside the ink.
const DENSE_SHARE: f64 = 0.5;
const MAGNIFIED_SWINGS: f64 = 20.0;

/// A curve over time in parts of a panel's width: the number of turns and the range of each part.
struct Columns(Vec<(u32, Option<Extent>)>);

impl Columns {
    fn new(parts: &[Bin], placed: &PlacedPanel) -> Self {
        let count = (placed.frame.width() / PART_PT).ceil() as usize;
        let mut columns: Vec<(u32, Option<Extent>)> = vec![(0, None); count.max(1)];
        for part in parts {
            let time_s = 0.5 * (part.times_s[0] + part.times_s[1]);
            let column = (placed.x.place(time_s) - placed.frame.left) / PART_PT;
            let column = (column.max(0.0) as usize).min(columns.len() - 1);
            let (turns, extent) = &mut columns[column];
            *turns += part.turns;
            *extent = Some(extent.map_or(part.extent, |extent| extent.and(part.extent)));
        }
        Self(columns)
    }

    fn turns(&self) -> u64 {
        self.0.iter().map(|(turns, _)| u64::from(*turns)).sum()
    }

    /// Returns true if a line `width_pt` wide is too dense in most parts.
    fn are_dense(&self, width_pt: f64, placed: &PlacedPanel) -> bool {
        let high = HIGH * (placed.y.range.1 - placed.y.range.0);
        let dense = self.0.iter().filter(|(turns, extent)| {
            let is_high = extent.is_some_and(|extent| extent.max - extent.min >= high);
            f64::from(*turns) * width_pt >= FILLED * PART_PT && is_high
        });
        dense.count() as f64 > DENSE_SHARE * self.0.len() as f64
    }

    /// Returns the band between the extremes of each part and its neighbors.
    fn band(&self, placed: &PlacedPanel) -> Vec<[f64; 3]> {
        let (low, high) = placed.x.range;
        let apart = (high - low) / self.0.len() as f64;
        let mut band: Vec<_> = (0..self.0.len())
            .filter_map(|index| {
                let near = &self.0[index.saturating_sub(1)..(index + 2).min(self.0.len())];
                let extents = near.iter().filter_map(|(_, extent)| *extent);
                let Extent { min, max } = extents.reduce(Extent::and)?;
                Some([low + apart * (index as f64 + 0.5), min, max])
            })
            .collect();
        let (begin, end) = (low + 0.5 * apart, high - 0.5 * apart);
        if let [first, .., last] = &mut band[..] {
            // The outermost parts extend to the ends of the axis.
            first[0] -= if first[0] <= begin { 0.5 * apart } else { 0.0 };
            last[0] += if last[0] >= end { 0.5 * apart } else { 0.0 };
        }
        band
    }
}

/// Returns the width that the line of `series` covers, with its halo, pt.
fn covered_pt(series: &ChartSeries) -> f64 {
    series.style.width_pt + series.style.halo_pt()
}

/// Proposes a time range for `chart` if one of its curves, the `columns` of `drawn`, is too dense. In this range all
/// curves are visible.
pub(super) fn over_time(
    chart: &Chart,
    columns: &[&'static CsvColumn],
    drawn: &[SampledRunNumbers],
    spec: &FigureSpec,
) -> Option<Dense> {
    if chart.x.is_log {
        return None; // swings become denser and denser along it
    }
    let layout = ChartLayout::new(chart, 0.0);
    let panels = columns.iter().zip(chart.panels.iter().zip(&layout.panels));
    let all = panels.flat_map(|(column, (panel, placed))| {
        let series = drawn.iter().zip(&panel.series);
        series.filter_map(|(run, series)| {
            let parts = Columns::new(&run.course.parts(column), placed);
            let is_dense = parts.are_dense(covered_pt(series), placed);
            let swing_s = run.course.swing_s.unwrap_or(f64::INFINITY);
            let swings = (run.course.end_s - spec.from_s) / swing_s;
            is_dense.then(|| parts.turns().max((2.0 * swings) as u64))
        })
    });
    // A range that resolves the curve with the most swings resolves the others too.
    let turns = all.max()?;
    let (_, end_s) = layout.panels.first()?.x.range;
    // The axis may begin before the run, as a margin for a measured point at 0.
    let window_s = 2.0 * MAGNIFIED_SWINGS * (end_s - spec.from_s) / turns as f64;
    let what = format!(
        "about {1} swings are too dense to be drawn on {0} mm: they are drawn as a band from minimum to maximum, with a part of it magnified",
        width_mm(spec),
        turns / 2
    );
    Some(proposal(window_s, spec, what))
}

/// Turns curves of `chart` into bands if they are too dense. In a panel with a band, other curves become bands too if
/// they would be dense with the same line width.
pub(super) fn draw_bands(
    chart: &mut Chart,
    columns: &[&'static CsvColumn],
    drawn: &[SampledRunNumbers],
) {
    let layout = ChartLayout::new(chart, 0.0);
    let panels = chart.panels.iter_mut().zip(&layout.panels);
    for (column, (panel, placed)) in columns.iter().zip(panels) {
        let all: Vec<Columns> = drawn
            .iter()
            .map(|it| Columns::new(&it.course.parts(column), placed))
            .collect();
        let widths = panel.series.iter().map(covered_pt);
        let dense = all
            .iter()
            .zip(widths)
            .filter(|(it, width_pt)| it.are_dense(*width_pt, placed));
        let widest = dense.map(|(_, width_pt)| width_pt).fold(0.0, f64::max);
        for (parts, series) in all.iter().zip(&mut panel.series) {
            if parts.are_dense(covered_pt(series).max(widest), placed) {
                series.band = parts.band(placed);
                series.style.is_band = true;
            }
        }
    }
}

/// Size of the examined positions of a path, pt, and the number of positions from the edge of the ink to its inside.
const PLACE_PT: f64 = 0.5;
const INSIDE: usize = 3;
/// Approximate width of a path's line, pt, and the fraction of the black positions that the lines of a proposed range
/// should cover.
const LINE_PT: f64 = 0.9;
const LOOSE: f64 = 0.3;

/// Proposes a time range as [`over_time`] does, for the `path` of each of `drawn`. `place` maps a point to the page.
/// The exact motion is examined only if no run is dense.
pub(super) fn of_paths(
    drawn: &[SampledRunNumbers],
    spec: &FigureSpec,
    path: fn(&SampledRun) -> &TracedPath,
    place: impl Fn(&[f64; 3]) -> Point,
) -> Option<Dense> {
    let (exact, stepped): (Vec<_>, Vec<_>) = drawn.iter().partition(|run| run.is_exact);
    [stepped, exact].into_iter().find_map(|runs| {
        runs.into_iter()
            .filter_map(|run| of_path(path(&run.course), run.course.end_s, spec, &place))
            .min_by(|a, b| a.to_s.total_cmp(&b.to_s))
    })
}

/// Proposes a time range for one `path`, which was recorded until `end_s`; `None` if it is not dense.
fn of_path(
    path: &TracedPath,
    end_s: f64,
    spec: &FigureSpec,
    place: impl Fn(&[f64; 3]) -> Point,
) -> Option<Dense> {
    if path.points.len() < 2000 {
        return None;
    }
    let lines = path.lines(place);
    let grid = Grid::inked(&lines, PLACE_PT, 0.0)?;
    let area_pt2 = grid.area_pt2();
    if grid.area_inside_pt2(INSIDE) < DENSE_SHARE * area_pt2 {
        return None;
    }
    let length_pt: f64 = lines.iter().map(|line| line::length(line)).sum();
    let share = (LOOSE * area_pt2 / (path.times * length_pt * LINE_PT)).min(0.5);
    let what = format!(
        "its turns are too dense to be drawn on {} mm and cover the paper",
        width_mm(spec)
    );
    Some(proposal(share * (end_s - spec.from_s), spec, what))
}

fn width_mm(spec: &FigureSpec) -> f64 {
    (spec.given_width_pt() / PT_PER_MM).round()
}

fn proposal(window_s: f64, spec: &FigureSpec, what: String) -> Dense {
    Dense {
        what,
        from_s: spec.from_s,
        to_s: spec.from_s + nice_numbers::at_or_below(window_s),
    }
}
