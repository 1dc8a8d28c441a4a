//! Positions of the parts of a chart on the page. Every label is measured, so that none is cut off and none overlaps
//! another.

use super::axis::{AxisScale, BESIDE, widest};
use super::legend::Legend;
use super::map::PlacedBar;
use super::ticks::{Tick, Ticks};
use super::{Chart, Panel};
use crate::plot::COLUMN_PT;
use crate::plot::ink::{self, LABEL_PT, PageRectangle, TITLE_PT};

/// Margin at the edge of the page, pt.
pub const PAGE_EDGE: f64 = 2.0;
/// Gap between an axis and the labels of its ticks, pt.
pub const TICK_LABEL_GAP: f64 = 3.0;
/// Gap between the labels of an axis and its title, on the left and below, pt.
pub const AXIS_TITLE_GAP: f64 = 6.0;
const TITLE_BELOW: f64 = 4.5;
/// Gap between two panels in addition to the height of a label, pt, so that the labels at their ends do not touch.
const PANEL_GAP: f64 = 2.5;
/// Minimum font size of a title that is too long for its axis, pt.
const LEAST_TITLE_PT: f64 = 5.5;
/// Height of a single panel, of each of two, and of each of more panels, on a page as wide as a column, pt.
const HEIGHTS: [f64; 3] = [140.0, 88.0, 66.0];

/// Length of a tick with a label, pt.
pub const TICK_LENGTH: f64 = 3.0;
/// Factor of a panel's height if its axis is logarithmic.
const LOG: f64 = 1.25;

#[derive(Clone, Debug)]
pub struct PlacedPanel {
    pub frame: PageRectangle,
    pub x: AxisScale,
    pub y: AxisScale,
    /// Ticks of the y axis. `below` holds the ticks of the x axis.
    pub ticks: Ticks,
    pub below: Ticks,
    /// Title of the y axis and its font size, pt.
    pub title: (String, f64),
    /// The color bar of its map, if it has one.
    pub bar: Option<PlacedBar>,
    pub is_true_to_scale: bool,
}

/// Layout of a chart without its legend. A legend above the panels moves them down.
#[derive(Clone, Debug)]
pub struct ChartLayout {
    pub panels: Vec<PlacedPanel>,
    /// The panels with the magnified range; empty without one.
    pub magnified: Vec<PlacedPanel>,
    /// Horizontal position of the baseline of the y axes' titles, pt.
    pub titles_at: f64,
    pub height_pt: f64,
    /// Gap between the axes and the labels of their ticks, pt.
    pub tick_gap: f64,
}

/// Returns the gap between the axes of `chart` and the labels of their ticks, pt. The ticks of a map point outward.
fn tick_gap(chart: &Chart) -> f64 {
    let has_map = chart.panels.iter().any(|panel| panel.map.is_some());
    TICK_LABEL_GAP + if has_map { TICK_LENGTH } else { 0.0 }
}

impl PlacedPanel {
    fn new(
        chart: &Chart,
        panel: &Panel,
        [x, y]: [AxisScale; 2],
        ticks: Ticks,
        title: (String, f64),
    ) -> Self {
        let frame = PageRectangle {
            left: x.places.0,
            top: y.places.1,
            right: x.places.1,
            bottom: y.places.0,
        };
        Self {
            bar: panel.map.as_ref().map(|map| map.bar(&frame)),
            is_true_to_scale: chart.is_true_to_scale,
            frame,
            below: x.ticks_below(&chart.x),
            x,
            y,
            ticks,
            title,
        }
    }
}

impl ChartLayout {
    /// Computes the layout of `chart`, with `above` pt left free at the top of the page.
    pub fn new(chart: &Chart, above: f64) -> Self {
        let label = ink::height(LABEL_PT);
        let y_ranges: Vec<_> = chart.panels.iter().map(y_range).collect();
        let tick_gap = tick_gap(chart);
        let (left, right, height) = sides(chart, above, x_range(chart), &y_ranges);
        let top = above + PAGE_EDGE + 0.5 * label;
        let [x, beside] = columns(chart, left, right);
        let panels = placed(chart, x, &y_ranges, top, height);
        let bottom = panels.last().map_or(top, |panel| panel.frame.bottom);
        let magnified = chart.magnified.iter();
        Self {
            titles_at: PAGE_EDGE + ink::height(TITLE_PT) + 1.0,
            height_pt: bottom + tick_gap + 1.5 * label + TITLE_BELOW + title_height() + PAGE_EDGE,
            magnified: magnified
                .flat_map(|beside_it| placed(beside_it, beside, &y_ranges, top, height))
                .collect(),
            panels,
            tick_gap,
        }
    }

    pub fn labels_at(&self) -> f64 {
        let bottom = self.panels.last().map_or(0.0, |panel| panel.frame.bottom);
        bottom + self.tick_gap + 1.5 + ink::height(LABEL_PT)
    }

    pub fn title_at(&self) -> f64 {
        self.labels_at() + TITLE_BELOW + ink::height(TITLE_PT)
    }
}

/// Positions the panels of `part` along its scale `x`, each `height` pt high, the first one `top` pt below the upper
/// edge.
fn placed(
    part: &Chart,
    x: AxisScale,
    y_ranges: &[(f64, f64)],
    top: f64,
    height: f64,
) -> Vec<PlacedPanel> {
    let label = ink::height(LABEL_PT);
    let ticks = ticks_of(part, y_ranges, height);
    part.panels
        .iter()
        .zip(y_ranges)
        .zip(ticks)
        .enumerate()
        .map(|(index, ((panel, range), ticks))| {
            let own_top = top + index as f64 * (height + label + PANEL_GAP);
            let y = AxisScale::new(&panel.y, *range, (own_top + height, own_top));
            let title = fitted(panel.y.title(&ticks), height + 0.7 * (label + PANEL_GAP));
            PlacedPanel::new(part, panel, [x, y], ticks, title)
        })
        .collect()
}

fn x_range(chart: &Chart) -> (f64, f64) {
    let maps = chart.panels.iter().filter_map(|panel| panel.map.as_ref());
    let mut of_maps = maps.filter_map(|map| map.range(0, chart.x.is_log));
    let all = chart.panels.iter().flat_map(|panel| &panel.series);
    let of_map = of_maps.next().filter(|_| chart.x.range.is_none());
    of_map.unwrap_or_else(|| chart.x.range_of(all.flat_map(|series| series.reach(0))))
}

/// Returns the x axes of `chart` and of its magnified part, from `left` to `right`, with a gap so that their labels do
/// not touch.
fn columns(chart: &Chart, left: f64, right: f64) -> [AxisScale; 2] {
    let Some(magnified) = &chart.magnified else {
        return [x_scale(chart, (left, right)); 2];
    };
    let half = 0.5 * (left + right);
    let (from, to) = (
        x_scale(chart, (left, half)),
        x_scale(magnified, (half, right)),
    );
    let (last, first) = (from.ticks_below(&chart.x), to.ticks_below(&magnified.x));
    let both =
        over_edge(&from, last.major.last(), half) + over_edge(&to, first.major.first(), half);
    let apart = 0.5 * (both + BESIDE);
    [
        x_scale(chart, (left, half - apart)),
        x_scale(magnified, (half + apart, right)),
    ]
}

/// Returns the scale of the x axis of `part` between two positions on the page.
fn x_scale(part: &Chart, places: (f64, f64)) -> AxisScale {
    AxisScale::new(&part.x, x_range(part), places)
}

/// Returns the length by which the label of a `tick` extends beyond the end of its axis at `edge`, pt.
fn over_edge(along: &AxisScale, tick: Option<&Tick>, edge: f64) -> f64 {
    tick.map_or(0.0, |tick| {
        tick.half_width() - (edge - along.place(tick.at)).abs()
    })
    .max(0.0)
}

/// Returns the left and right end of the panels, and the height of each, pt.
fn sides(
    chart: &Chart,
    above: f64,
    x_range: (f64, f64),
    y_ranges: &[(f64, f64)],
) -> (f64, f64, f64) {
    let mut height = panel_height(chart, above);
    let (mut left, mut right) = (PAGE_EDGE, chart.width_pt - PAGE_EDGE - 1.0);
    // The ticks depend on the space, and the space on their labels: three rounds are enough to settle both.
    for _ in 0..3 {
        let ticks = ticks_of(chart, y_ranges, height);
        let widest = ticks.iter().map(widest).fold(0.0, f64::max);
        left = PAGE_EDGE + title_height() + AXIS_TITLE_GAP + widest + tick_gap(chart);
        let maps = chart.panels.iter().filter_map(|panel| panel.map.as_ref());
        let bar = maps.map(|map| map.bar_room(height)).fold(0.0, f64::max);
        right = right.min(chart.width_pt - PAGE_EDGE - bar);
        right = right.min(right_edge(chart, x_range, left, right));
        if let Some(magnified) = &chart.magnified {
            let half = 0.5 * (left + right);
            let range = self::x_range(magnified);
            right = right.min(right_edge(magnified, range, half, right));
        }
        if chart.is_true_to_scale {
            let (width, span) = (right - left, x_range.1 - x_range.0);
            height = width / span * (y_ranges[0].1 - y_ranges[0].0);
        }
    }
    (left, right, height)
}

/// Returns the height of a title including its descenders, pt.
pub fn title_height() -> f64 {
    1.35 * ink::height(TITLE_PT)
}

/// Returns `title` with the font size at which it is at most `room` pt long.
pub fn fitted(title: String, room: f64) -> (String, f64) {
    let size = TITLE_PT * (room / ink::width(&title, TITLE_PT)).min(1.0);
    (title, size.max(LEAST_TITLE_PT))
}

/// Returns the minimum height of `chart` with its legend, pt.
pub fn least_height_pt(chart: &Chart) -> f64 {
    const LEAST_PANEL_PT: f64 = 18.0;
    let legend_pt = Legend::from_chart(chart, []).height_above(chart.width_pt);
    let count = chart.panels.len();
    around_pt(count, legend_pt) + LEAST_PANEL_PT * count as f64
}

/// Returns the height of everything except the panels in a chart of `count` panels, which starts `above` pt below the
/// upper edge; pt.
fn around_pt(count: usize, above: f64) -> f64 {
    let label = ink::height(LABEL_PT);
    let between = (label + PANEL_GAP) * count.saturating_sub(1) as f64;
    above + PAGE_EDGE + 0.5 * label + between + below_pt()
}

/// Returns the height of the part below the panels, pt.
fn below_pt() -> f64 {
    TICK_LABEL_GAP + 1.5 * ink::height(LABEL_PT) + TITLE_BELOW + title_height() + PAGE_EDGE
}

/// Returns the height of each panel of `chart`, `above` pt below the upper edge, pt.
fn panel_height(chart: &Chart, above: f64) -> f64 {
    let count = chart.panels.len();
    if let Some(height_pt) = chart.height_pt {
        return (height_pt - around_pt(count, above)) / count as f64;
    }
    let height = HEIGHTS[count.clamp(1, HEIGHTS.len()) - 1];
    let is_log = chart.panels.iter().any(|panel| panel.y.is_log);
    let height = if is_log { LOG * height } else { height };
    // Relative to its width, a wide figure is lower than a narrow one.
    let wide = libm::pow((chart.width_pt / COLUMN_PT).clamp(0.6, 3.0), 0.6);
    // All panels have the same height, so the longest title decides.
    let longest = chart.panels.iter().map(|panel| {
        let title = panel.y.title(&Ticks::default());
        ink::width(&title, TITLE_PT)
    });
    let most = 1.8 * height * wide;
    (height * wide).max(longest.fold(0.0, f64::max).min(most))
}

fn y_range(panel: &Panel) -> (f64, f64) {
    let map = panel.map.as_ref().filter(|_| panel.y.range.is_none());
    let of_map = map.and_then(|map| map.range(1, panel.y.is_log));
    let values = panel.series.iter().flat_map(|series| series.reach(1));
    of_map.unwrap_or_else(|| panel.y.range_of(values))
}

fn ticks_of(chart: &Chart, ranges: &[(f64, f64)], height: f64) -> Vec<Ticks> {
    let panels = chart.panels.iter().zip(ranges);
    let ticks = panels.map(|(panel, &range)| {
        AxisScale::new(&panel.y, range, (height, 0.0)).ticks_beside(&panel.y)
    });
    ticks.collect()
}

/// Returns the right end of the panels, so that half of the last label has room.
fn right_edge(chart: &Chart, range: (f64, f64), left: f64, right: f64) -> f64 {
    let scale = AxisScale::new(&chart.x, range, (left, right));
    let ticks = scale.ticks_below(&chart.x);
    let over = ticks.major.last().map_or(0.0, |tick| {
        let end = scale.place(tick.at) + tick.half_width();
        end - (chart.width_pt - PAGE_EDGE)
    });
    right - over.max(0.0)
}
