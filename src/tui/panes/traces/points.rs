//! The measured points on a strip: with the curve of the run, or less what the run says.

use super::Traces;
use super::content::Content;
use crate::lab::measured::Shown;
use crate::observe::recording::Extent;
use crate::observe::scale::Scale;
use crate::observe::strip::Strip;
use crate::tui::dots::{Dots, Ink};
use crate::tui::points::{Ends, Points};
use crate::tui::theme::Role;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

/// The least range of residuals, where nothing has been compared yet.
const LEAST: f64 = 1e-9;

impl Traces<'_> {
    /// The range of values that the points of `content` need: those in the time of `strip`, or all.
    pub(super) fn extent_of_points(
        &self,
        content: Content,
        strip: Option<&Strip>,
    ) -> Option<Extent> {
        let is_shown =
            |point: &&Shown| strip.is_none_or(|strip| strip.column(point.time_s).is_some());
        let points = self.points(content)?.iter().filter(is_shown);
        let extent = |point: &Shown| {
            let sigma = point.sigma.unwrap_or(0.0);
            Extent::of(point.value - sigma).and(Extent::of(point.value + sigma))
        };
        points.map(extent).reduce(Extent::and)
    }

    /// The range of the residuals of `content`, about 0.
    pub(super) fn residual_scale(&self, content: Content) -> Scale {
        let points = self.points(content).unwrap_or_default();
        let reach = |point: &Shown| {
            let residual = point.residual().unwrap_or(0.0).abs();
            residual + point.sigma.unwrap_or(0.0)
        };
        let reach = points.iter().map(reach).fold(LEAST, f64::max);
        let scale = Scale::about_zero(reach);
        if self.view.magnified > 1.0 {
            scale.zoomed(self.view.magnified, 0.0)
        } else {
            scale
        }
    }

    /// The line of the residual 0, on `area`.
    pub(super) fn draw_zero(&self, scale: &Scale, area: Rect, buf: &mut Buffer) {
        let mut dots = Dots::new(area, self.view.marker);
        let row = scale.from_top(0.0) * dots.height() as f64;
        let apart = self.view.marker.dots().0;
        for x in (0..dots.width()).step_by(apart) {
            dots.set(x as f64, row, Ink::Faint(Role::Quiet));
        }
        dots.render(&self.view.theme, buf);
    }

    /// The points of `content` on `area`: those that the run has not reached are faint; as residuals they do not show.
    pub(super) fn draw_points(
        &self,
        content: Content,
        strip: &Strip,
        scale: &Scale,
        is_residual: bool,
        area: Rect,
        buf: &mut Buffer,
    ) {
        let Some(all) = self.points(content) else {
            return;
        };
        let begin = all.partition_point(|point| point.time_s < strip.begin_s);
        let end = all.partition_point(|point| point.time_s <= strip.end_s());
        let across = self.view.marker.dots().0;
        let row = |value: f64| scale.from_top(value) * f64::from(area.height);
        let mut points = Points::new(area, self.view.marker);
        for point in &all[begin..end.max(begin)] {
            let value = if is_residual {
                point.residual()
            } else {
                Some(point.value)
            };
            let (Some(value), Some(column)) = (value, strip.column(point.time_s)) else {
                continue;
            };
            let ends = |sigma: f64| -> Ends { (row(value + sigma), row(value - sigma)) };
            let role = match point.model {
                Some(_) => Role::Measured,
                None => Role::Quiet,
            };
            // The lowest value stands on the last row.
            let at = row(value);
            let at = if at == f64::from(area.height) {
                at - 1.0
            } else {
                at
            };
            points.add(
                ((column / across) as f64, at),
                None,
                point.sigma.map(ends),
                role,
            );
        }
        points.render(&self.view.theme, buf);
    }
}
