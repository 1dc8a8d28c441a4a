//! The traces: the traced point over time, with one strip for each of x, y and z over the same window. A fourth strip
//! is shown if there is room or if one was chosen. The overview below the panes shows the whole run.

mod axis;
pub mod canvas;
mod content;
mod curves;
mod strip;

use super::{PaneRow, PlotInputs, write};
use crate::engine::run::marks::Marks;
use crate::lab::action::{Direction, signed};
use crate::lab::playback::scale::StripScale;
use crate::lab::playback::strip::Strip;
use crate::lab::view::theme::Marker;
use crate::lab::view::{Pane, USUAL_SWINGS};
use crate::tui::keymap::{self, one};
use crate::tui::split::split_rows;
use crate::tui::theme::Role;
pub(super) use axis::{Gutter, times, with_minus_sign};
use content::StripContent;
pub(super) use curves::{draw_run, rows};
use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use ratatui::widgets::Widget;
pub(super) use strip::{EDIT_MARK, PUSH_BAR, cursor_line};

/// Columns of dots per swing, and the minimum number of swings: for small dots, and for dots as wide as a cell.
const SMALL_DOTS: (usize, usize) = (10, 4);
const LARGE_DOTS: (usize, usize) = (8, 2);
/// Minimum rows of a strip: its rule, and one row of its curves.
const LEAST_STRIP_ROWS: u16 = 2;
/// Approximate columns of ticks next to a strip.
const USUAL_GUTTER: usize = 7;

pub const TRACES_ROW: PaneRow = PaneRow {
    id: Pane::Traces,
    title: "over time",
    draw: |lab, area, buf| {
        Traces(PlotInputs::from_lab(lab)).render(area, buf);
    },
    keys: keymap::TRACES_KEYS,
    arrows: Some(|lab, direction, times| {
        let (view, player) = (lab.view(), lab.player());
        one(match direction {
            Direction::Left | Direction::Right => {
                view.moved_cursor(signed(direction, times), player)
            }
            _ => view.other_magnification(signed(direction, times)),
        })
    }),
};

/// Returns how many swings the traces can show on `width` columns.
pub fn swings(width: u16, marker: Marker) -> usize {
    let across = marker.dots().0;
    let (columns, fewest) = if across > 1 { SMALL_DOTS } else { LARGE_DOTS };
    let dots = usize::from(width).saturating_sub(USUAL_GUTTER) * across;
    (dots / columns).clamp(fewest, USUAL_SWINGS)
}

/// The traces, as a widget.
pub struct Traces<'a>(pub PlotInputs<'a>);

/// A strip with its area.
struct Plot {
    content: StripContent,
    /// True if it shows residuals: measured values minus the values of the run.
    is_residual: bool,
    strip: Strip,
    scale: StripScale,
    /// Area of the rule and, below it, of the curves and ticks.
    area: Rect,
    /// Area of the curves.
    sheet: Rect,
}

impl Widget for Traces<'_> {
    fn render(self, area: Rect, buf: &mut Buffer) {
        let (plots, gutter) = self.plots(area);
        let marks = Marks::new(self.0.run.scenario());
        for (index, plot) in plots.iter().enumerate() {
            self.strip(index, plot, &plots, &gutter, &marks, buf);
        }
        if let Some(plot) = plots.first() {
            let axis = Rect {
                x: plot.sheet.x,
                y: area.bottom() - 1,
                width: plot.sheet.width,
                height: 1,
            };
            let style = self.0.view.theme.style(Role::Label);
            for (at, label) in times(&plot.strip, axis.width.into()) {
                write(axis, (at as u16, 0), &label, style, buf);
            }
        }
    }
}

impl Traces<'_> {
    /// Returns the strips that fit on `area`, above the time axis, and the columns of their ticks.
    fn plots(&self, area: Rect) -> (Vec<Plot>, Gutter) {
        let [strips, _] = split_rows(area, area.height.saturating_sub(1));
        let contents = if strips.height < LEAST_STRIP_ROWS {
            Vec::new()
        } else {
            self.contents(strips.height)
        };
        let scales: Vec<_> = contents
            .iter()
            .map(|(content, is_residual)| self.scale(*content, *is_residual))
            .collect();
        let rows = strips.height / contents.len().max(1) as u16;
        let gutter = Gutter::new(&scales, rows.saturating_sub(1).into(), area.width);
        let (window, across) = (&self.0.view.window, self.0.view.marker.dots().0);
        let columns = usize::from(area.width - gutter.width) * across;
        let mut rest = strips;
        let mut plots = Vec::with_capacity(contents.len());
        for (index, (content, is_residual)) in contents.iter().enumerate() {
            // Rows left over go to the lowest strips.
            let left = (contents.len() - index) as u16;
            let [place, below] = split_rows(rest, rest.height / left);
            rest = below;
            let [_, sheet] = split_rows(place, 1);
            plots.push(Plot {
                content: *content,
                is_residual: *is_residual,
                strip: Strip::new(window.begin_s, window.length_s(), columns),
                scale: scales[index],
                area: place,
                sheet: Rect {
                    x: sheet.x + gutter.width,
                    width: sheet.width - gutter.width,
                    ..sheet
                },
            });
        }
        (plots, gutter)
    }

    /// Returns the time at the cell `at` of the screen if the traces are drawn on `area`, s. Returns `None` beside the
    /// strips.
    pub fn time_s(&self, area: Rect, at: Position) -> Option<f64> {
        let (plots, _) = self.plots(area);
        let plot = plots.first()?;
        let cell = area
            .contains(at)
            .then(|| at.x.checked_sub(plot.sheet.x))??;
        let across = self.0.view.marker.dots().0;
        let column = cell as usize * across + (across - 1) / 2;
        Some(plot.strip.time_s(column))
    }
}
