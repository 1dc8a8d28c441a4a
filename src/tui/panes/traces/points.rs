//! The measured points on a strip: with the curve of the run, or less what the run says.

use super::Traces;
use super::plot::Plot;
use crate::lab::measured::Shown;
use crate::observe::recording::Extent;
use crate::observe::scale::Scale;
use crate::observe::strip::Strip;
use crate::tui::dots::{Dots, Ink};
use crate::tui::points::{Ends, Points};
use crate::tui::theme::Role;
use ratatui::buffer::Buffer;

/// The least range of residuals, where nothing has been compared yet.
const LEAST: f64 = 1e-9;

/// The range of values that `points` need: those in the time of `strip`, or all.
pub(super) fn extent(points: Option<&[Shown]>, strip: Option<&Strip>) -> Option<Extent> {
    let is_shown = |point: &&Shown| strip.is_none_or(|strip| strip.column(point.time_s).is_some());
    let extent = |point: &Shown| {
        let sigma = point.sigma.unwrap_or(0.0);
        Extent::of(point.value - sigma).and(Extent::of(point.value + sigma))
    };
    let points = points?.iter().filter(is_shown);
    points.map(extent).reduce(Extent::and)
}

/// The range of the residuals of `points`, about 0.
pub(super) fn residual_scale(points: Option<&[Shown]>) -> Scale {
    let reach = |point: &Shown| point.residual().unwrap_or(0.0).abs() + point.sigma.unwrap_or(0.0);
    let points = points.unwrap_or_default().iter();
    Scale::about_zero(points.map(reach).fold(LEAST, f64::max))
}

impl Traces<'_> {
    /// The line of the residual 0.
    pub(super) fn draw_zero(&self, plot: &Plot, dots: &mut Dots) {
        let row = plot.scale.from_top(0.0) * dots.height() as f64;
        for x in (0..dots.width()).step_by(dots.in_a_cell().0) {
            dots.set(x as f64, row, Ink::Faint(Role::Quiet));
        }
    }

    /// The points of `plot`: those that the run has not reached are faint; as residuals they do not show.
    pub(super) fn draw_points(&self, plot: &Plot, buf: &mut Buffer) {
        let (strip, sheet) = (&plot.strip, plot.sheet);
        let all = self.points(plot.content).unwrap_or_default();
        let begin = all.partition_point(|point| point.time_s < strip.begin_s);
        let end = all.partition_point(|point| point.time_s <= strip.end_s());
        let across = self.view.marker.dots().0;
        let height = f64::from(sheet.height);
        let row = |value: f64| plot.scale.from_top(value) * height;
        let mut points = Points::new(sheet, self.view.marker);
        for point in &all[begin..end.max(begin)] {
            let value = if plot.is_residual {
                point.residual()
            } else {
                Some(point.value)
            };
            let (Some(value), Some(column)) = (value, strip.column(point.time_s)) else {
                continue;
            };
            let ends = |sigma: f64| -> Ends { (row(value + sigma), row(value - sigma)) };
            let role = if point.model.is_some() {
                Role::Measured
            } else {
                Role::Quiet
            };
            // The lowest value stands on the last row.
            let at = row(value);
            let at = if at == height { at - 1.0 } else { at };
            let at = ((column / across) as f64, at);
            points.add(at, None, point.sigma.map(ends), role);
        }
        points.render(&self.view.theme, buf);
    }
}
