//! Draws a chart on its page.

use super::curve::Squares;
use super::layout::{self, ChartLayout, PAGE_EDGE, PlacedPanel, TICK_LENGTH};
use super::legend::{Legend, longest_name};
use super::map::ColorMap;
use super::ticks::{Ticks, with_minus};
use super::{Chart, ChartSeries, Panel};
use crate::engine::text::number::significant;
use crate::plot::ink::{self, BLACK, LABEL_PT, MARK_PT, at, pen};
use crate::plot::letters;
use crate::plot::scene::{PageScene, Point, TextAnchor};
use std::collections::HashSet;

/// Maximum number of marks in a panel.
const MOST_MARKS: f64 = 10_000.0;
pub const FRAME_PT: f64 = 0.5;
/// Length of a tick without a label, pt.
const MINOR_TICK: f64 = 1.7;
const BAR_END: f64 = 1.7;
/// Mean distance below which marks are drawn smaller, pt, and their minimum size relative to the default.
const MARK_SPACING_PT: f64 = 2.5;
const LEAST_MARK_SHARE: f64 = 0.5;
/// Length of an error bar that even the lowest mark covers, pt.
const COVERED_PT: f64 = 2.8;

impl Chart {
    pub fn scene(&self) -> PageScene {
        let bare = ChartLayout::new(self, 0.0);
        self.as_seen(&bare).placed(bare)
    }

    /// Returns the chart as it can be seen with this `layout`: without overlapping marks. Runs whose curves coincide in
    /// all panels become one curve with both names. Curves outside all panels have no name in the legend.
    fn as_seen(&self, layout: &ChartLayout) -> Self {
        let mut seen = self.clone();
        seen.x.range = layout.panels.first().map(|placed| placed.x.range);
        let magnified = seen
            .magnified
            .iter_mut()
            .flat_map(|chart| &mut chart.panels);
        let places = layout.panels.iter().chain(&layout.magnified);
        for (panel, placed) in seen.panels.iter_mut().chain(magnified).zip(places) {
            panel.y.range = Some(placed.y.range);
            for series in &mut panel.series {
                placed.thin_marks(series);
            }
        }
        seen.forget_names_of_unseen(layout);
        seen.join_coinciding(layout);
        seen
    }

    fn forget_names_of_unseen(&mut self, layout: &ChartLayout) {
        for (panel, placed) in self.panels.iter_mut().zip(&layout.panels) {
            for series in &mut panel.series {
                let is_curve = !series.points.is_empty() && series.band.is_empty();
                let mut places = series.points.iter().map(|point| placed.place(point));
                let has_point = places.any(|place| placed.frame.holds(place));
                if is_curve && !has_point && !placed.has_in(&placed.frame, series) {
                    series.name.clear();
                }
            }
        }
    }

    /// Joins runs whose curves coincide in all panels into one curve.
    fn join_coinciding(&mut self, layout: &ChartLayout) {
        let counts = self.panels.iter().map(|panel| panel.series.len());
        let count = counts.min().unwrap_or(0);
        for first in 0..count {
            for second in first + 1..count {
                if self.coincide(first, second, layout) {
                    self.join(first, second);
                }
            }
        }
    }

    /// Returns true if two runs look the same in all panels.
    fn coincide(&self, first: usize, second: usize, layout: &ChartLayout) -> bool {
        let mut panels = self.panels.iter().zip(&layout.panels);
        panels.all(|(panel, placed)| {
            let [a, b] = [&panel.series[first], &panel.series[second]];
            a.can_join(b) && {
                let [a, b] = [a, b].map(|series| Squares::new(&placed.pieces(series)));
                a.coincide(&b)
            }
        })
    }

    /// Removes the curve `second` from each panel and adds its name to `first`, if both names fit into the legend.
    fn join(&mut self, first: usize, second: usize) {
        let magnified = self
            .magnified
            .iter_mut()
            .flat_map(|chart| &mut chart.panels);
        let room = longest_name(self.width_pt);
        for panel in self.panels.iter_mut().chain(magnified) {
            let names = [first, second].map(|index| panel.series[index].name.as_str());
            let joined = match names {
                [a, b] if a == b => a.to_owned(),
                both => both.join(" and "),
            };
            if ink::width(&joined, LABEL_PT) <= room {
                panel.series[first].name = joined;
                panel.series[second] = ChartSeries::named(String::new());
            }
        }
    }

    /// Draws the chart. `bare` is the layout without a legend above the panels.
    fn placed(&self, bare: ChartLayout) -> PageScene {
        let remarks = self.remark(&bare).into_iter().chain(self.magnified());
        let remarks = remarks.chain(self.remark_of_gaps());
        let legend = Legend::from_chart(self, remarks);
        let corner = legend.free_corner(self, &bare);
        let layout = match corner {
            Some(_) => bare,
            None => ChartLayout::new(self, legend.height_above(self.width_pt)),
        };
        let mut scene = PageScene::new(self.width_pt, layout.height_pt, &self.title);
        scene.decimal_comma = self.decimal_comma;
        for (panel, placed) in self.panels.iter().zip(&layout.panels) {
            panel.draw(placed, &mut scene);
            panel.write_beside(placed, &layout, &mut scene);
        }
        write_below(self, &layout.panels, &layout, &mut scene);
        if let Some(magnified) = &self.magnified {
            for (panel, placed) in magnified.panels.iter().zip(&layout.magnified) {
                panel.draw(placed, &mut scene);
            }
            write_below(magnified, &layout.magnified, &layout, &mut scene);
        }
        match corner {
            Some(corner) => legend.draw_in(&corner, &mut scene),
            None => {
                let left = layout
                    .panels
                    .first()
                    .map_or(PAGE_EDGE, |panel| panel.frame.left);
                legend.draw_above(self.width_pt, left, &mut scene);
            }
        }
        scene
    }

    /// Returns the legend's remark on the magnified range.
    fn magnified(&self) -> Option<String> {
        let (from, to) = self.magnified.as_ref()?.x.range?;
        let [from, to] = [from, to].map(|end| with_minus(&significant(end, 9)));
        let unit = match self.x.unit.as_str() {
            "" => String::new(),
            unit => format!(" {unit}"),
        };
        let remark = format!("right: {from} to {to}{unit}, magnified");
        let room = self.width_pt - 2.0 * PAGE_EDGE;
        Some(letters::shortened(&remark, LABEL_PT, room))
    }

    /// Returns the legend's remark on cells of a map without a color.
    fn remark_of_gaps(&self) -> Option<String> {
        let mut maps = self.panels.iter().filter_map(|panel| panel.map.as_ref());
        maps.any(ColorMap::has_gaps)
            .then(|| "crossed: no value".to_owned())
    }

    /// Returns true if a measured quantity has marks without a known error.
    fn lacks_errors(&self) -> bool {
        let mut series = self.panels.iter().flat_map(|panel| &panel.series);
        series.any(|series| {
            let mark = series.style.mark.filter(|mark| mark.is_of_measured());
            let mut points = series.points.iter().zip(&series.errors[1]);
            let is_unknown = points.any(|(point, error)| point[1].is_finite() && error.is_nan());
            mark.is_some() && (series.errors[1].is_empty() || is_unknown)
        })
    }

    /// Returns the legend's remark on error bars that are too small to be drawn.
    fn remark(&self, layout: &ChartLayout) -> Option<String> {
        let panels = self.panels.iter().zip(&layout.panels);
        let bars = panels.flat_map(|(panel, placed)| {
            panel
                .series
                .iter()
                .flat_map(move |series| [0, 1].map(|axis| placed.bars(series, axis)))
                .flatten()
        });
        let (hidden, drawn): (Vec<_>, Vec<_>) = bars.partition(is_covered);
        if hidden.is_empty() {
            return None;
        }
        let known = if self.lacks_errors() { "known " } else { "" };
        let of = if self.are_read_off {
            " of reading the run"
        } else {
            ""
        };
        let rest = if drawn.is_empty() {
            ""
        } else {
            " where no bar is drawn"
        };
        let remark = format!("{known}errors{of} smaller than marks{rest}");
        let room = self.width_pt - 2.0 * PAGE_EDGE;
        Some(letters::shortened(&remark, LABEL_PT, room))
    }
}

/// Returns true if a mark would cover an error bar.
fn is_covered(&[a, b]: &[Point; 2]) -> bool {
    (a.x - b.x).abs() + (a.y - b.y).abs() < COVERED_PT
}

impl PlacedPanel {
    /// Removes marks of `series` that overlap others. Marks closer than half their width cannot be distinguished.
    fn thin_marks(&self, series: &mut ChartSeries) {
        self.shrink_marks(series);
        let area = self.frame.width() * self.frame.height();
        let cell_pt = MARK_PT.max((area / MOST_MARKS).sqrt());
        if series.style.mark.is_none() || (series.points.len() as f64) <= MOST_MARKS {
            return;
        }
        let mut taken = HashSet::new();
        let kept: Vec<usize> = (0..series.points.len())
            .filter(|&index| {
                let place = self.place(&series.points[index]);
                let cell = [place.x, place.y].map(|length| (length / cell_pt).floor() as i64);
                self.frame.holds(place) && taken.insert(cell)
            })
            .collect();
        series.errors = [0, 1].map(|axis| {
            let errors = kept
                .iter()
                .filter_map(|&index| series.errors[axis].get(index));
            errors.copied().collect()
        });
        series.points = kept.iter().map(|&index| series.points[index]).collect();
    }

    /// Reduces the size of the marks of `series` if they are close together.
    fn shrink_marks(&self, series: &mut ChartSeries) {
        let places = series.points.iter().map(|point| self.place(point));
        let count = places.filter(|place| self.frame.holds(*place)).count();
        let apart_pt = self.frame.width() / count.max(1) as f64;
        series.style.mark_share = (apart_pt / MARK_SPACING_PT).clamp(LEAST_MARK_SHARE, 1.0);
    }

    /// Returns the ends of the error bars along an axis for the points of `series` in the panel, clipped to its frame.
    fn bars<'a>(
        &'a self,
        series: &'a ChartSeries,
        axis: usize,
    ) -> impl Iterator<Item = [Point; 2]> + 'a {
        let points = series.points.iter().zip(&series.errors[axis]).enumerate();
        let shown = points
            .filter(|(_, (point, error))| error.is_finite() && self.frame.holds(self.place(point)));
        shown.map(move |(index, _)| {
            let ends = series.ends(index, axis);
            ends.map(|end| self.frame.nearest(self.place(&end)))
        })
    }
}

/// Writes labels and title below `panels`, a column of `layout` that shows `chart`.
fn write_below(chart: &Chart, panels: &[PlacedPanel], layout: &ChartLayout, scene: &mut PageScene) {
    let Some(last) = panels.last() else {
        return;
    };
    for tick in &last.below.major {
        let place = at(last.x.place(tick.at), layout.labels_at());
        scene.write(&tick.label, LABEL_PT, place, TextAnchor::Middle);
    }
    let columns = if layout.magnified.is_empty() {
        1.0
    } else {
        2.0
    };
    let room = chart.width_pt / columns - 2.0 * PAGE_EDGE;
    let (title, size) = layout::fitted(chart.x.title(&last.below), room);
    let half = 0.5 * ink::width(&title, size);
    let middle = (0.5 * (last.frame.left + last.frame.right))
        .min(chart.width_pt - PAGE_EDGE - half)
        .max(PAGE_EDGE + half);
    scene.write(
        &title,
        size,
        at(middle, layout.title_at()),
        TextAnchor::Middle,
    );
}

impl Panel {
    fn draw(&self, placed: &PlacedPanel, scene: &mut PageScene) {
        let (behind, before): (Vec<_>, Vec<_>) = self
            .series
            .iter()
            .partition(|series| series.style.is_behind);
        if let Some(map) = &self.map {
            map.draw(placed, scene);
        }
        let (hatched, filled): (Vec<_>, Vec<_>) = self
            .series
            .iter()
            .rev()
            .partition(|series| series.style.is_hatched);
        for series in filled.into_iter().chain(hatched) {
            placed.fill_band(series, scene);
        }
        for series in behind.iter().rev() {
            draw_points(series, placed, scene);
            placed.draw_line(series, scene);
        }
        for series in &before {
            placed.draw_halo(series, scene);
            placed.draw_line(series, scene);
        }
        for (place, series) in self.series.iter().enumerate() {
            placed.draw_sparse_marks(series, place, scene);
        }
        match &placed.bar {
            Some(bar) => {
                draw_frame_outwards(placed, scene);
                bar.draw(scene);
            }
            None => draw_frame(placed, scene),
        }
        for series in &before {
            draw_points(series, placed, scene);
        }
    }

    fn write_beside(&self, placed: &PlacedPanel, layout: &ChartLayout, scene: &mut PageScene) {
        let frame = &placed.frame;
        let (title, size) = &placed.title;
        let middle = at(layout.titles_at, 0.5 * (frame.top + frame.bottom));
        scene.write_up(title, *size, middle);
        let label = ink::height(LABEL_PT);
        for tick in &placed.ticks.major {
            let place = at(
                frame.left - layout.tick_gap,
                placed.y.place(tick.at) + 0.5 * label,
            );
            scene.write(&tick.label, LABEL_PT, place, TextAnchor::End);
        }
    }
}

/// Draws the frame with ticks on all four sides, pointing inward.
fn draw_frame(placed: &PlacedPanel, scene: &mut PageScene) {
    let frame = &placed.frame;
    scene.stroke(frame.outline(), pen(FRAME_PT, BLACK), None);
    for (value, length) in lengths(&placed.below) {
        let x = placed.x.place(value);
        for (edge, inwards) in [(frame.bottom, -length), (frame.top, length)] {
            scene.line([at(x, edge), at(x, edge + inwards)], FRAME_PT, BLACK);
        }
    }
    for (value, length) in lengths(&placed.ticks) {
        let y = placed.y.place(value);
        for (edge, inwards) in [(frame.left, length), (frame.right, -length)] {
            scene.line([at(edge, y), at(edge + inwards, y)], FRAME_PT, BLACK);
        }
    }
}

/// Draws the frame with ticks below and on the left, pointing outward, because the colors of a map would hide them.
fn draw_frame_outwards(placed: &PlacedPanel, scene: &mut PageScene) {
    let frame = &placed.frame;
    scene.stroke(frame.outline(), pen(FRAME_PT, BLACK), None);
    for (value, length) in lengths(&placed.below) {
        let x = placed.x.place(value);
        let ends = [at(x, frame.bottom), at(x, frame.bottom + length)];
        scene.line(ends, FRAME_PT, BLACK);
    }
    for (value, length) in lengths(&placed.ticks) {
        let y = placed.y.place(value);
        scene.line(
            [at(frame.left, y), at(frame.left - length, y)],
            FRAME_PT,
            BLACK,
        );
    }
}

/// Returns the value of each tick and its length on the page, pt.
fn lengths(ticks: &Ticks) -> impl Iterator<Item = (f64, f64)> {
    let major = ticks.major.iter().map(|tick| (tick.at, TICK_LENGTH));
    major.chain(ticks.minor.iter().map(|&at| (at, MINOR_TICK)))
}

fn draw_points(series: &ChartSeries, placed: &PlacedPanel, scene: &mut PageScene) {
    let Some(mark) = series.style.mark else {
        return;
    };
    let color = series.style.color;
    for (axis, (dx, dy)) in [(0.0, BAR_END), (BAR_END, 0.0)].into_iter().enumerate() {
        for bar in placed.bars(series, axis).filter(|bar| !is_covered(bar)) {
            scene.line(bar, FRAME_PT, color);
            for end in bar {
                let across = [at(end.x - dx, end.y - dy), at(end.x + dx, end.y + dy)];
                scene.line(across, FRAME_PT, color);
            }
        }
    }
    let places = series.points.iter().map(|point| placed.place(point));
    for place in places.filter(|place| placed.frame.holds(*place)) {
        scene.mark_of_size(mark, series.style.mark_share * MARK_PT, place, color);
    }
}
