//! A strip as it is drawn: what it shows, of which time and values, and its curves.

use super::Traces;
use super::groups::{Group, StripContent};
use crate::engine::data::compared::ComparedPoint;
use crate::engine::recording::{Extent, RecordedCurve, Recording};
use crate::engine::text::number::fixed;
use crate::lab::comparison::DataComparison;
use crate::lab::playback::marks::Marks;
use crate::lab::playback::scale::StripScale;
use crate::lab::playback::strip::{PlacedBins, Strip, StripColumn};
use crate::tui::dots::{Dots, Ink};
use crate::tui::theme::Role;
use ratatui::layout::Rect;
use std::ops::RangeInclusive;

/// Digits after the point of a value at the cursor.
const CURSOR_DECIMALS: usize = 6;
/// Least range of z, as a share of the distance between pivot and traced point: a smaller swing is drawn small.
const Z_LEAST: f64 = 0.05;
/// Least range of the tilt, degrees. Below it there is only rounding error, and the labels would have too many digits.
const TILT_LEAST: f64 = 0.02;
/// Least range of other quantities, as a share of their size.
const SHARE_LEAST: f64 = 1e-3;
/// Least reach of x and y, as a share of the distance between pivot and traced point.
const PLANE_LEAST: f64 = 1e-4;
/// The least range of residuals, where nothing has been compared yet.
const RESIDUAL_LEAST: f64 = 1e-9;
/// A band whose edges are nearer to one another than this, in dots, has no room for a gap: it is drawn as a thick line.
const THINNEST_BAND: usize = 2;

/// Whose curve it is, in the order in which they are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Whose {
    Before,
    Pinned,
    Exact,
    Run,
}

const DRAWING_ORDER: [Whose; 4] = [Whose::Before, Whose::Pinned, Whose::Exact, Whose::Run];

pub(super) struct Plot {
    pub content: StripContent,
    pub strip: Strip,
    /// Whether it shows less time than the others: the fast motion.
    pub is_zoom: bool,
    /// Whether it shows what was measured less what the run says.
    pub is_residual: bool,
    pub scale: StripScale,
    /// The curves, the run's last; none of residuals.
    pub curves: Vec<(Vec<Option<StripColumn>>, CurveStroke, Ink)>,
    /// Whether the run's curve is in part a band.
    pub has_band: bool,
    /// All of the strip, and the part that its curves have.
    pub area: Rect,
    pub sheet: Rect,
}

impl Traces<'_> {
    /// The strips of `group`, with `beside` columns for their values, or else a line above each.
    pub(super) fn plots(&self, group: &Group, beside: u16, marks: &Marks) -> Vec<Plot> {
        let mut plots = Vec::with_capacity(group.strips.len());
        for &(content, area) in &group.strips {
            let is_residual =
                self.0.view.look.residuals && !group.is_zoom && self.index(content).is_some();
            let above = u16::from(beside == 0);
            plots.push(Plot {
                content,
                strip: group.strip,
                is_zoom: group.is_zoom,
                is_residual,
                scale: if is_residual {
                    self.magnified(residual_scale(self.points(content)), 0.0)
                } else {
                    self.scale(content, group.is_zoom.then_some(&group.strip))
                },
                curves: Vec::new(),
                has_band: false,
                area,
                sheet: Rect {
                    x: area.x + beside,
                    y: area.y + above,
                    width: area.width - beside,
                    height: area.height.saturating_sub(above),
                },
            });
        }
        for whose in DRAWING_ORDER {
            self.add_curves(whose, marks, &mut plots);
        }
        plots
    }

    /// Adds the curves of `whose` to `plots`, which show the same time.
    fn add_curves<'s>(&'s self, whose: Whose, marks: &Marks, plots: &mut [Plot]) {
        // The recording that was placed on the columns last: most plots are of the same.
        let mut placed: Option<(&'s Recording, PlacedBins)> = None;
        for plot in plots.iter_mut().filter(|plot| !plot.is_residual) {
            let Some((recording, curve)) = self.recorded(whose, plot.content) else {
                continue;
            };
            let placed = match &mut placed {
                Some((last, blocks)) if std::ptr::eq(*last, recording) => blocks,
                other => &mut other.insert((recording, plot.strip.bins(recording))).1,
            };
            let mut columns = placed.columns(curve, self.cuts(whose, marks));
            if plot.is_zoom {
                // Where swings are shown one by one, few columns are no reason for a band.
                let shown = columns.iter_mut().flatten();
                shown.for_each(|column| column.band = None);
            }
            if whose == Whose::Run {
                self.end_at_run(plot, &mut columns);
                plot.has_band = self.has_band(plot, &columns);
            }
            let (stroke, ink) = self.look(whose, plot.content);
            plot.curves.push((columns, stroke, ink));
        }
    }

    /// Leaves out what was recorded beyond where the run stands: what follows the run may have been further.
    fn end_at_run(&self, plot: &Plot, columns: &mut [Option<StripColumn>]) {
        if let StripContent::Measured(_) = plot.content {
            let now_s = self.0.run.now().time_s;
            let shown = plot.strip.shown(plot.strip.begin_s, now_s);
            columns[shown.end..].fill(None);
        }
    }

    fn has_band(&self, plot: &Plot, columns: &[Option<StripColumn>]) -> bool {
        let (across, down) = self.0.view.marker.dots();
        let rows = f64::from(plot.area.height) * down as f64;
        // A band of large dots hides the curve as soon as it is one dot high.
        let thinnest = across.min(THINNEST_BAND) as f64;
        let mut bands = columns.iter().flatten().filter_map(|column| column.band);
        bands.any(|band| {
            let [bottom, top] = [band.min, band.max].map(|value| plot.scale.from_top(value) * rows);
            bottom - top >= thinnest
        })
    }

    fn look(&self, whose: Whose, content: StripContent) -> (CurveStroke, Ink) {
        let (across, down) = self.0.view.marker.dots();
        match whose {
            Whose::Before => (CurveStroke::Dotted, Ink::Ghost),
            Whose::Pinned => (CurveStroke::LongAndShort, Ink::Faint(Role::Pinned)),
            Whose::Exact => (CurveStroke::Dashed, Ink::Faint(Role::Exact)),
            // The dots of a filled band and the dashes of the exact motion look different only where dots are small.
            Whose::Run if self.0.run.overlay().is_some() && across * down <= 2 => {
                (CurveStroke::Edges, Ink::Strong(content.role()))
            }
            Whose::Run => (CurveStroke::Full, Ink::Strong(content.role())),
        }
    }

    /// The recording that has what `content` shows of `whose` motion, where that is shown, and which of its curves it is.
    fn recorded(&self, whose: Whose, content: StripContent) -> Option<(&Recording, RecordedCurve)> {
        match (whose, content) {
            (Whose::Run, StripContent::Curve(curve)) => Some((self.0.run.recording(), curve)),
            (Whose::Run, StripContent::Measured(index)) => self.0.measured?.recorded(index),
            (Whose::Before, StripContent::Curve(curve)) => Some((&self.0.ghost?.recording, curve)),
            (Whose::Before, StripContent::Measured(index)) => {
                self.0.ghost.and(self.0.measured)?.recorded_before(index)
            }
            (Whose::Pinned, StripContent::Curve(curve)) => Some((&self.0.pinned?.recording, curve)),
            (Whose::Exact, StripContent::Curve(curve)) => {
                Some((&self.0.run.overlay()?.recording, curve))
            }
            (Whose::Pinned | Whose::Exact, StripContent::Measured(_)) => None,
        }
    }

    /// The times that no line of a curve crosses, s.
    fn cuts<'s>(&'s self, whose: Whose, marks: &'s Marks) -> &'s [f64] {
        let ghost = match whose {
            Whose::Run => return &marks.edits,
            Whose::Before => self.0.ghost,
            Whose::Pinned => self.0.pinned,
            Whose::Exact => None,
        };
        ghost.map_or(&[], |ghost| &ghost.marks.edits)
    }

    /// What was measured, the curves that every run has before the others.
    pub(super) fn measured_contents(&self) -> Vec<StripContent> {
        let quantities = self
            .0
            .measured
            .map_or(0, |beside| beside.quantities().count());
        let others = (0..quantities)
            .map(StripContent::Measured)
            .filter(|content| self.recorded(Whose::Run, *content).is_some());
        let curves = StripContent::of_every_run()
            .into_iter()
            .filter(|content| self.index(*content).is_some());
        curves.chain(others).collect()
    }

    /// The index of what `content` shows among the measured quantities.
    fn index(&self, content: StripContent) -> Option<usize> {
        match content {
            StripContent::Measured(index) => Some(index),
            StripContent::Curve(curve) => {
                let mut quantities = self.0.measured?.quantities();
                quantities.position(|quantity| quantity.name == curve.column())
            }
        }
    }

    /// The measured values of what `content` shows; none where it was not measured.
    pub(super) fn points(&self, content: StripContent) -> Option<&[ComparedPoint]> {
        let index = self.index(content)?;
        let curves = &self.0.measured?.compared.curves;
        curves.get(index).map(Vec::as_slice)
    }

    pub(super) fn named(&self, content: StripContent) -> (String, &'static str) {
        match content {
            StripContent::Curve(curve) => (curve.name().to_owned(), curve.unit()),
            StripContent::Measured(index) => {
                let quantities = self.0.measured.map(DataComparison::quantities);
                let quantity = quantities.and_then(|mut quantities| quantities.nth(index));
                quantity.map_or_else(Default::default, |quantity| {
                    (quantity.words(), quantity.unit())
                })
            }
        }
    }

    /// What was recorded of `content` at a step at `time_s`.
    fn value_at(&self, content: StripContent, time_s: f64) -> Option<f64> {
        let (recording, curve) = self.recorded(Whose::Run, content)?;
        let block = recording.between(time_s, time_s).last()?;
        (block.samples() == 1).then(|| block.extent(curve).max)
    }

    /// The value that was measured at the step at `time_s`.
    fn measured_at(&self, content: StripContent, time_s: f64) -> Option<f64> {
        let half_s = 0.5 * self.0.run.simulation().motion().time_step_s;
        let points = self.points(content)?;
        let next = points.partition_point(|point| point.time_s < time_s - half_s);
        let point = points.get(next)?;
        (point.time_s <= time_s + half_s).then_some(point.value)
    }

    /// The column (of cells) of the cursor on `plot`, and the value there with its unit, where it is known.
    pub(super) fn at_cursor(&self, plot: &Plot) -> Option<(u16, String)> {
        let cursor = self.0.cursor?;
        let column = plot.strip.column(cursor.time_s)? / self.0.view.marker.dots().0;
        let value = match plot.content {
            StripContent::Curve(curve) => Some(curve.at(cursor)),
            StripContent::Measured(_) => self.value_at(plot.content, cursor.time_s),
        };
        let unit = self.named(plot.content).1;
        let measured = self
            .measured_at(plot.content, cursor.time_s)
            .map(|data| format!(", data {}", fixed(data, CURSOR_DECIMALS)))
            .unwrap_or_default();
        let words =
            value.map(|value| format!("{} {unit}{measured}", fixed(value, CURSOR_DECIMALS)));
        Some((column as u16, words.unwrap_or_default()))
    }

    /// The range of values of a strip, magnified as the view wants it: of the whole run, or of the time of `strip` alone.
    pub(super) fn scale(&self, content: StripContent, strip: Option<&Strip>) -> StripScale {
        let now = self.0.run.now();
        let about = match (self.0.cursor, content) {
            (Some(cursor), StripContent::Curve(curve)) => curve.at(cursor),
            (None, StripContent::Curve(curve)) => now.value(curve),
            (_, StripContent::Measured(_)) => self.value_at(content, now.time_s).unwrap_or(0.0),
        };
        self.magnified(self.whole_scale(content, strip), about)
    }

    fn magnified(&self, scale: StripScale, about: f64) -> StripScale {
        if self.0.view.magnified > 1.0 {
            scale.zoomed(self.0.view.magnified, about)
        } else {
            scale
        }
    }

    /// The same without magnification: x and y of the whole run share one about 0, the others have their own.
    fn whole_scale(&self, content: StripContent, strip: Option<&Strip>) -> StripScale {
        let extent = self.extent(content, strip);
        let size = extent.max.abs().max(extent.min.abs());
        let arm_m = self.0.run.scenario().arm_m();
        let least = match content {
            StripContent::Curve(RecordedCurve::X | RecordedCurve::Y) if strip.is_none() => {
                let [x, y] = [RecordedCurve::X, RecordedCurve::Y]
                    .map(|curve| self.extent(StripContent::Curve(curve), None));
                let both = x.and(y);
                let reach = both.max.max(-both.min);
                return StripScale::about_zero(reach.max(PLANE_LEAST * arm_m));
            }
            StripContent::Curve(RecordedCurve::X | RecordedCurve::Y) => PLANE_LEAST * arm_m,
            StripContent::Curve(RecordedCurve::Z) => Z_LEAST * arm_m,
            StripContent::Curve(RecordedCurve::Tilt) => TILT_LEAST,
            StripContent::Measured(_) => (SHARE_LEAST * size).max(f64::MIN_POSITIVE),
        };
        StripScale::around(extent, least)
    }

    /// The extent of all that the strip of `content` shows. The exact motion, the run before and the pinned one count as a
    /// whole, so that the scale stays while the run catches up with them.
    fn extent(&self, content: StripContent, strip: Option<&Strip>) -> Extent {
        let recordings = DRAWING_ORDER
            .into_iter()
            .filter_map(|whose| self.recorded(whose, content));
        let extents = recordings
            .filter_map(|(recording, curve)| match strip {
                Some(strip) => recording.extent_between(strip.begin_s, strip.end_s(), curve),
                None => recording.whole().map(|block| block.extent(curve)),
            })
            .chain(extent_of(self.points(content), strip));
        extents.reduce(Extent::and).unwrap_or(Extent::single(0.0))
    }
}

/// The range of values that `points` need: those in the time of `strip`, or all.
fn extent_of(points: Option<&[ComparedPoint]>, strip: Option<&Strip>) -> Option<Extent> {
    points?
        .iter()
        .filter(|point| strip.is_none_or(|strip| strip.column(point.time_s).is_some()))
        .map(|point| {
            let sigma = point.sigma.unwrap_or(0.0);
            Extent::single(point.value - sigma).and(Extent::single(point.value + sigma))
        })
        .reduce(Extent::and)
}

fn residual_scale(points: Option<&[ComparedPoint]>) -> StripScale {
    StripScale::about_zero(
        points
            .unwrap_or_default()
            .iter()
            .map(|point| point.residual().unwrap_or(0.0).abs() + point.sigma.unwrap_or(0.0))
            .fold(RESIDUAL_LEAST, f64::max),
    )
}

/// A value this part of a dot above the edge between two dots counts as below it: a value on the edge, such as a constant
/// in the middle of its strip, would else go up and down with its rounding.
const DOT_ROUNDING: f64 = 1e-4;

/// Cells after which long and short dashes repeat.
const LONG_AND_SHORT: usize = 6;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CurveStroke {
    /// All of them, and a band is filled with a few.
    Full,
    /// All of them, and of a band its edges alone.
    Edges,
    /// Those in every other cell: the exact motion.
    Dashed,
    /// Single ones: the run before.
    Dotted,
    /// Those in three cells, then in one, with a cell between: the pinned run.
    LongAndShort,
}

impl CurveStroke {
    /// Sets the dots of the column `x` from one row to another. Of a steep piece a dotted curve has two in each cell, counted
    /// from the cell's top; a level piece is seen at any height.
    fn set(self, dots: &mut Dots, x: usize, (from, to): (usize, usize), ink: Ink) {
        let (across, down) = dots.in_a_cell();
        let (is_drawn, apart) = match self {
            Self::Full | Self::Edges => (true, 1),
            Self::Dashed => ((x / across).is_multiple_of(2), 1),
            Self::LongAndShort => (!matches!(x / across % LONG_AND_SHORT, 3 | 5), 1),
            Self::Dotted => (x.is_multiple_of(across.max(2)), (down / 2).max(1)),
        };
        for y in (from..=to).step_by(apart).filter(|_| is_drawn) {
            dots.set(x as f64, y as f64, ink);
        }
    }
}

/// Draws a curve as a line, or as a band where its swings are too fast to be drawn one by one.
pub(super) fn draw_curve(
    dots: &mut Dots,
    columns: &[Option<StripColumn>],
    scale: &StripScale,
    stroke: CurveStroke,
    ink: Ink,
) {
    let height = dots.height() as f64;
    if height == 0.0 {
        return;
    }
    let place = |value: f64| scale.from_top(value) * height + DOT_ROUNDING;
    let row = |value: f64| place(value).clamp(0.0, height - 1.0) as usize;
    let is_inside = |value: f64| (0.0..height + 2.0 * DOT_ROUNDING).contains(&place(value));
    let mut before: Option<(usize, usize)> = None;
    for (x, column) in columns.iter().enumerate() {
        let last = before.take();
        let whole = column.map(|column| column.band.unwrap_or(column.extent));
        let (Some(column), Some(band)) = (column, whole.filter(|band| scale.meets(*band))) else {
            continue;
        };
        let (top, bottom) = (row(band.max), row(band.min));
        if column.band.is_none() || bottom < top + THINNEST_BAND {
            let rows = (row(column.extent.max), row(column.extent.min));
            stroke.set(dots, x, rows, ink);
            continue;
        }
        let (last_top, last_bottom) = last.unwrap_or((top, bottom));
        // An edge beyond the strip is not drawn: the band goes on there.
        if is_inside(band.max) {
            stroke.set(dots, x, toward(top, last_top), ink);
        }
        if is_inside(band.min) {
            stroke.set(dots, x, toward(bottom, last_bottom), ink);
        }
        if stroke == CurveStroke::Full {
            fill(dots, x, top..=bottom, ink);
        }
        before = Some((top, bottom));
    }
}

/// Sets one of four dots between the edges of a band, on slanting lines that are seen to be no curves.
fn fill(dots: &mut Dots, x: usize, rows: RangeInclusive<usize>, ink: Ink) {
    let (across, down) = dots.in_a_cell();
    let ink = match ink {
        Ink::Strong(role) if across * down <= 2 => Ink::Under(role), // large dots would hide the edges
        _ => ink,
    };
    for y in rows.filter(|y| (x + 2 * y).is_multiple_of(4)) {
        dots.set(x as f64, y as f64, ink);
    }
}

/// The rows from `row` to the one next to `before`, so that an edge has no gap.
fn toward(row: usize, before: usize) -> (usize, usize) {
    if before < row {
        (before + 1, row)
    } else {
        (row, before.saturating_sub(1).max(row))
    }
}
