//! A chart drawn on its page.

use super::layout::{EDGE, GAP, Layout, Placed};
use super::legend::Legend;
use super::ticks::Ticks;
use super::{Chart, Circles, Panel, Series};
use super::{curve, slope};
use crate::figure::page::ink::{self, BLACK, Frame, LABEL_PT, MARK_PT, at, pen};
use crate::figure::page::letters;
use crate::figure::page::line::clipped;
use crate::figure::page::scene::{Path, Point, Scene};
use std::collections::HashSet;
use std::f64::consts::{PI, TAU};

/// The most marks in a panel.
const MOST_MARKS: f64 = 10_000.0;
const FRAME_PT: f64 = 0.5;
/// Length of a tick with a label and of one without, pt.
const TICK: f64 = 3.0;
const MINOR_TICK: f64 = 1.7;
const BAR_END: f64 = 1.7;
/// An error bar from end to end that the lowest of the marks covers, pt.
const COVERED_PT: f64 = 2.8;

impl Chart {
    pub fn scene(&self) -> Scene {
        let bare = Layout::new(self, 0.0);
        self.as_seen(&bare).placed(bare)
    }

    /// The chart without what nobody could distinguish in the places of `layout`: points that stand upon each other, and
    /// dashes of a line that fills its own gaps.
    fn as_seen(&self, layout: &Layout) -> Self {
        let mut seen = self.clone();
        seen.x.range = layout.panels.first().map(|placed| placed.x.range);
        for (panel, placed) in seen.panels.iter_mut().zip(&layout.panels) {
            panel.y.range = Some(placed.y.range);
            for series in &mut panel.series {
                placed.thin_marks(series);
                if series.style.width_pt > 0.0 {
                    let lines = placed.pieces(series);
                    series.style = curve::told_apart(&lines, series.style.clone());
                }
            }
        }
        seen
    }

    /// The chart in its places; `bare` leaves no room for a legend above the panels.
    fn placed(&self, bare: Layout) -> Scene {
        let known = if self.lacks_errors() { "known " } else { "" };
        let errors = self.errors.words();
        let remark = match self.bars_hidden(&bare) {
            (0, _) => None,
            (hidden, all) if hidden == all => Some(format!("{known}{errors} smaller than marks")),
            _ => Some(format!(
                "{known}{errors} smaller than marks where no bar is drawn"
            )),
        };
        let remark =
            remark.map(|remark| letters::shortened(&remark, LABEL_PT, self.width_pt - 2.0 * EDGE));
        let legend = Legend::of(self, remark.as_deref());
        let corner = legend.free_corner(self, &bare);
        let layout = match corner {
            Some(_) => bare,
            None => Layout::new(self, legend.height_above(self.width_pt)),
        };
        let mut scene = Scene::new(self.width_pt, layout.height_pt, &self.title);
        for (panel, placed) in self.panels.iter().zip(&layout.panels) {
            panel.draw(placed, &layout, &mut scene);
            slope::draw(panel, placed, corner.as_ref(), &mut scene);
        }
        self.write_below(&layout, &mut scene);
        match corner {
            Some(corner) => legend.draw_in(&corner, &mut scene),
            None => {
                let left = layout.panels.first().map_or(EDGE, |panel| panel.frame.left);
                legend.draw_above(self.width_pt, left, &mut scene);
            }
        }
        scene
    }

    fn write_below(&self, layout: &Layout, scene: &mut Scene) {
        let Some(last) = layout.panels.last() else {
            return;
        };
        for tick in &layout.ticks.major {
            let place = at(last.x.place(tick.at), layout.labels_at());
            scene.write(&tick.label, LABEL_PT, place, 0.5);
        }
        let (title, size) = &layout.title;
        let middle = 0.5 * (last.frame.left + last.frame.right);
        let half = 0.5 * ink::width(title, *size);
        let middle = middle.min(self.width_pt - EDGE - half).max(EDGE + half);
        scene.write(title, *size, at(middle, layout.title_at()), 0.5);
    }

    /// Whether something measured has marks without a known error.
    fn lacks_errors(&self) -> bool {
        let mut series = self.panels.iter().flat_map(|panel| &panel.series);
        series.any(|series| {
            let mark = series.style.mark.filter(|mark| mark.is_of_measured());
            let mut points = series.points.iter().zip(&series.errors);
            let is_unknown = points.any(|(point, error)| point[1].is_finite() && error.is_nan());
            mark.is_some() && (series.errors.is_empty() || is_unknown)
        })
    }

    /// How many error bars are too small to be drawn, and how many there are.
    fn bars_hidden(&self, layout: &Layout) -> (usize, usize) {
        let panels = self.panels.iter().zip(&layout.panels);
        let series = panels
            .flat_map(|(panel, placed)| panel.series.iter().map(move |series| (series, placed)));
        series.fold((0, 0), |(hidden, all), (series, placed)| {
            let bars: Vec<bool> = placed.bars(series).map(|bar| bar.is_hidden).collect();
            let across = placed.bars_across(series).count();
            let is_hidden = |hidden: &&bool| **hidden;
            (
                hidden + bars.iter().filter(is_hidden).count(),
                all + bars.len() + across,
            )
        })
    }
}

struct Bar {
    x: f64,
    top: f64,
    bottom: f64,
    /// Whether the mark would cover it.
    is_hidden: bool,
}

impl Placed {
    /// Leaves out those points of `series`, which are marks, that stand where another one does: marks that are nearer to each
    /// other than half of their width cannot be told apart.
    fn thin_marks(&self, series: &mut Series) {
        let area = self.frame.width() * self.frame.height();
        let cell_pt = MARK_PT.max((area / MOST_MARKS).sqrt());
        if series.style.mark.is_none() || (series.points.len() as f64) <= MOST_MARKS {
            return;
        }
        let mut taken = HashSet::new();
        let mut is_kept = |point: &[f64; 2]| {
            let place = self.place(point);
            let cell = [place.x, place.y].map(|length| (length / cell_pt).floor() as i64);
            self.frame.holds(place) && taken.insert(cell)
        };
        let is_kept: Vec<bool> = series.points.iter().map(&mut is_kept).collect();
        retain(&mut series.points, &is_kept);
        retain(&mut series.errors, &is_kept);
        retain(&mut series.errors_across, &is_kept);
    }

    /// The error bars of `series` whose point is in the panel.
    fn bars<'a>(&'a self, series: &'a Series) -> impl Iterator<Item = Bar> + 'a {
        let points = series.points.iter().zip(&series.errors);
        let points = points
            .filter(|(point, error)| error.is_finite() && self.frame.holds(self.place(point)));
        points.map(|(point, error)| {
            let y = |sign: f64| self.y.place(point[1] + sign * error);
            let limit = |y: f64| {
                if y.is_finite() {
                    y.clamp(self.frame.top, self.frame.bottom)
                } else {
                    self.frame.bottom
                }
            };
            let (top, bottom) = (limit(y(1.0)), limit(y(-1.0)));
            Bar {
                x: self.x.place(point[0]),
                is_hidden: bottom - top < COVERED_PT,
                top,
                bottom,
            }
        })
    }

    /// The level error bars of `series` that its marks do not cover: their ends, and at which height.
    fn bars_across<'a>(&'a self, series: &'a Series) -> impl Iterator<Item = (f64, f64, f64)> + 'a {
        let points = series.points.iter().zip(&series.errors_across);
        let points = points
            .filter(|(point, error)| error.is_finite() && self.frame.holds(self.place(point)));
        let bars = points.map(|(point, error)| {
            let x = |sign: f64| {
                let x = self.x.place(point[0] + sign * error);
                x.clamp(self.frame.left, self.frame.right)
            };
            (x(-1.0), x(1.0), self.y.place(point[1]))
        });
        bars.filter(|(left, right, _)| right - left >= COVERED_PT)
    }
}

impl Panel {
    fn draw(&self, placed: &Placed, layout: &Layout, scene: &mut Scene) {
        let frame = &placed.frame;
        let to_page = |radius: f64| placed.x.place(radius) - placed.x.place(0.0);
        for &radius in &self.circles.radii {
            let middle = placed.place(&[0.0, 0.0]);
            for arc in arcs(middle, to_page(radius), frame) {
                scene.stroke(Path::polyline(arc), Circles::style().pen(), Some(frame));
            }
        }
        let points = |is_behind: bool, scene: &mut Scene| {
            let series = self.series.iter();
            let series = series.filter(|series| series.style.is_behind == is_behind);
            series.for_each(|series| draw_points(series, placed, scene));
        };
        points(true, scene);
        for series in self
            .series
            .iter()
            .filter(|series| series.style.width_pt > 0.0)
        {
            placed.draw_line(series, scene);
        }
        draw_frame(placed, layout, scene);
        points(false, scene);
        let (title, size) = &placed.title;
        let middle = at(layout.titles_at, 0.5 * (frame.top + frame.bottom));
        scene.write_up(title, *size, middle);
        let label = ink::height(LABEL_PT);
        for tick in &placed.ticks.major {
            let place = at(frame.left - GAP, placed.y.place(tick.at) + 0.5 * label);
            scene.write(&tick.label, LABEL_PT, place, 1.0);
        }
    }
}

/// Keeps the `items` that `is_kept` marks; there may be no items.
fn retain<Item>(items: &mut Vec<Item>, is_kept: &[bool]) {
    let mut kept = is_kept.iter();
    items.retain(|_| kept.next() == Some(&true));
}

/// The parts in `frame` of the circle of that radius (pt), as lines: it may be far larger than the page.
pub(super) fn arcs(middle: Point, radius_pt: f64, frame: &Frame) -> Vec<Vec<Point>> {
    /// How far the lines are off it, pt, and how many there are at most.
    const OFF_PT: f64 = 0.02;
    const MOST: f64 = 1e5;
    let count = (PI * (0.5 * radius_pt / OFF_PT).sqrt())
        .ceil()
        .clamp(8.0, MOST);
    let places = (0..=count as u32).map(|number| {
        let angle = TAU * f64::from(number) / count;
        let (x, y) = (libm::cos(angle), libm::sin(angle));
        at(middle.x + radius_pt * x, middle.y + radius_pt * y)
    });
    clipped(places, frame)
}

/// The frame and its ticks, on all four sides, inwards.
fn draw_frame(placed: &Placed, layout: &Layout, scene: &mut Scene) {
    let frame = &placed.frame;
    scene.stroke(frame.outline(), pen(FRAME_PT, BLACK), None);
    let mut upright = |x: f64, length: f64| {
        let (top, bottom) = (frame.top, frame.bottom);
        scene.line([at(x, bottom), at(x, bottom - length)], FRAME_PT, BLACK);
        scene.line([at(x, top), at(x, top + length)], FRAME_PT, BLACK);
    };
    let x = |value: f64| placed.x.place(value);
    each_tick(&layout.ticks, |value, length| upright(x(value), length));
    let mut level = |y: f64, length: f64| {
        let (left, right) = (frame.left, frame.right);
        scene.line([at(left, y), at(left + length, y)], FRAME_PT, BLACK);
        scene.line([at(right, y), at(right - length, y)], FRAME_PT, BLACK);
    };
    let y = |value: f64| placed.y.place(value);
    each_tick(&placed.ticks, |value, length| level(y(value), length));
}

/// Gives the value and the length on paper (pt) of each of `ticks` to `draw`.
fn each_tick(ticks: &Ticks, mut draw: impl FnMut(f64, f64)) {
    ticks.major.iter().for_each(|tick| draw(tick.at, TICK));
    ticks.minor.iter().for_each(|&at| draw(at, MINOR_TICK));
}

fn draw_points(series: &Series, placed: &Placed, scene: &mut Scene) {
    let Some(mark) = series.style.mark else {
        return;
    };
    let color = series.style.color;
    for (left, right, y) in placed.bars_across(series) {
        let mut line = |a: (f64, f64), b: (f64, f64)| {
            scene.line([at(a.0, a.1), at(b.0, b.1)], FRAME_PT, color);
        };
        line((left, y), (right, y));
        line((left, y - BAR_END), (left, y + BAR_END));
        line((right, y - BAR_END), (right, y + BAR_END));
    }
    for bar in placed.bars(series).filter(|bar| !bar.is_hidden) {
        let mut line = |a: (f64, f64), b: (f64, f64)| {
            scene.line([at(a.0, a.1), at(b.0, b.1)], FRAME_PT, color);
        };
        let (x, top, bottom) = (bar.x, bar.top, bar.bottom);
        line((x, top), (x, bottom));
        line((x - BAR_END, top), (x + BAR_END, top));
        line((x - BAR_END, bottom), (x + BAR_END, bottom));
    }
    let places = series.points.iter().map(|point| placed.place(point));
    for place in places.filter(|place| placed.frame.holds(*place)) {
        scene.mark(mark, place, color);
    }
}
