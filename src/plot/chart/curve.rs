//! The line of a series on the page, without the points that nobody could see.

use super::layout::PlacedPanel;
use super::{ChartSeries, Panel, SeriesStyle};
use crate::plot::ink::{PageRectangle, at, paler};
use crate::plot::line::{clipped, simplified};
use crate::plot::scene::{PageScene, Point, StrokeStyle, VectorPath};
use crate::plot::stroke_outline;
use std::collections::{HashMap, HashSet};

/// How far a line may leave its points, of its width: a tenth of a dot at 600 an inch for a line of 0.7 pt.
const TOLERANCE: f64 = 0.02;
/// And at most, of however wide a line, pt.
const UNSEEN_PT: f64 = 0.014;
/// A solid line of more points than this is drawn by the outline of its ink if that has fewer: a file of 40 kB.
const MANY_LINE_POINTS: usize = 5_000;
/// The part of white in the colour of a band, which its line has pure.
pub const BAND_WHITE: f64 = 0.72;
/// How far outside of its panel a line is followed, pt: half its width, which is cut off at the edge.
const BEYOND_PT: f64 = 2.0;

impl PlacedPanel {
    pub fn place(&self, point: &[f64; 2]) -> Point {
        at(self.x.place(point[0]), self.y.place(point[1]))
    }

    /// Draws the line of `series`, if it has one; of a band its two edges.
    pub fn draw_line(&self, series: &ChartSeries, scene: &mut PageScene) {
        if series.style.width_pt == 0.0 {
            return;
        }
        let clip = self.frame.grown(BEYOND_PT);
        let places = series.points.iter().map(|point| self.place(point));
        let pieces = if !series.band.is_empty() {
            let edges = self
                .edges(&series.band)
                .map(|edge| clipped(edge.into_iter(), &clip));
            edges.concat()
        } else if series.style.is_dots {
            dots(places.filter(|place| clip.holds(*place)))
        } else {
            clipped(places, &clip)
        };
        draw_curve(&pieces, &series.style.pen(), Some(&self.frame), scene);
    }

    /// Draws the core of the line of `series`, if it has one.
    pub fn draw_core(&self, series: &ChartSeries, scene: &mut PageScene) {
        if let Some(pen) = series.style.core_pen() {
            draw_curve(&self.pieces(series), &pen, Some(&self.frame), scene);
        }
    }

    pub fn pieces(&self, series: &ChartSeries) -> Vec<Vec<Point>> {
        let places = series.points.iter().map(|point| self.place(point));
        clipped(places, &self.frame.grown(BEYOND_PT))
    }

    /// Fills the band of `series`, if it has one.
    pub fn fill_band(&self, series: &ChartSeries, scene: &mut PageScene) {
        let [least, greatest] = self.edges(&series.band);
        let outline: Vec<_> = least
            .into_iter()
            .chain(greatest.into_iter().rev())
            .map(|place| self.frame.grown(BEYOND_PT).nearest(place))
            .collect();
        if !outline.is_empty() {
            let color = paler(series.style.color, BAND_WHITE);
            scene.fill_in(VectorPath::polygon(outline), color, Some(&self.frame));
        }
    }

    /// The lower and the upper edge of a `band`.
    fn edges(&self, band: &[[f64; 3]]) -> [Vec<Point>; 2] {
        [1, 2].map(|edge| {
            band.iter()
                .map(|at| self.place(&[at[0], at[edge]]))
                .collect()
        })
    }

    /// Whether nothing of `panel` is in `frame`.
    pub fn is_clear(&self, frame: &PageRectangle, panel: &Panel) -> bool {
        let mut series = panel.series.iter();
        series.all(|series| !self.has_in(frame, series))
    }

    /// Whether something of `series` is in `frame`.
    fn has_in(&self, frame: &PageRectangle, series: &ChartSeries) -> bool {
        let mut bars =
            (0..series.points.len()).flat_map(|index| [0, 1].map(|axis| series.ends(index, axis)));
        (series.style.width_pt > 0.0 && self.has_line_in(frame, &series.points))
            || (series.style.mark.is_some() && bars.any(|bar| self.has_line_in(frame, &bar)))
    }

    /// Returns whether a part of the line through `points` is in `frame`.
    fn has_line_in(&self, frame: &PageRectangle, points: &[[f64; 2]]) -> bool {
        let places = points.iter().map(|point| self.place(point));
        !clipped(places, frame).is_empty()
    }
}

pub fn dots(places: impl Iterator<Item = Point>) -> Vec<Vec<Point>> {
    const LENGTH_PT: f64 = 0.02;
    places
        .map(|place| vec![place, at(place.x + LENGTH_PT, place.y)])
        .collect()
}

/// Draws a line that is cut off outside of `clip`, in fewer pieces that look the same.
pub fn draw_curve(
    pieces: &[Vec<Point>],
    pen: &StrokeStyle,
    clip: Option<&PageRectangle>,
    scene: &mut PageScene,
) {
    let within_pt = (TOLERANCE * pen.width_pt).min(UNSEEN_PT);
    let lines: Vec<Vec<Point>> = pieces
        .iter()
        .map(|piece| simplified(piece, within_pt))
        .collect();
    let count: usize = lines.iter().map(Vec::len).sum();
    if pen.dash_pt.is_empty() && count > MANY_LINE_POINTS {
        let area = stroke_outline::area(&lines, pen.width_pt);
        // There is none of lines that need too large a grid.
        if !area.0.is_empty() && area.0.len() < count {
            return scene.fill_in(area, pen.color, clip);
        }
    }
    for line in lines {
        scene.stroke(VectorPath::polyline(line), pen.clone(), clip);
    }
}

/// The length of a line that consists of `pieces` without swings that are too low to be seen, pt.
fn way_pt(pieces: &[Vec<Point>]) -> f64 {
    const FLAT_PT: f64 = 0.4;
    let lines = pieces.iter().map(|piece| simplified(piece, FLAT_PT));
    lines.map(|line| length(&line)).sum()
}

/// Whether a line of that length hides one beneath it: it swings where that does not.
fn hides(way_pt: f64, beneath_pt: f64) -> bool {
    const LONGER: f64 = 3.0;
    way_pt > LONGER * beneath_pt
}

/// The lines of a panel that have been looked at, the first of which is on top of all others.
#[derive(Default)]
pub struct Above {
    first_pt: Option<f64>,
    /// The squares of the page on which they lie, and the width of the widest line there, pt.
    squares: HashMap<[i32; 2], f64>,
}

impl Above {
    /// Side of a square, pt.
    const SIDE_PT: f64 = 0.5;
    /// How much wider a line is than one that lies on it, pt.
    const WIDER_PT: f64 = 0.9;

    /// Takes note of a line that consists of `pieces`, and makes its `style` one in which it is seen: wide where other lines
    /// cover it for most of its length, thin where they do not, with its core on top where the first line hides it.
    pub fn add(&mut self, pieces: &[Vec<Point>], style: &mut SeriesStyle) {
        let length_pt = way_pt(pieces);
        let is_hidden = self
            .first_pt
            .is_some_and(|first_pt| hides(first_pt, length_pt));
        let covered: HashSet<_> = squares(pieces).collect();
        if let Some(color) = style.core {
            match self.width_over(&covered) {
                Some(width_pt) => style.width_pt = width_pt + Self::WIDER_PT,
                None => style.color = color,
            }
        }
        style.core = style.core.filter(|_| is_hidden);
        self.first_pt.get_or_insert(length_pt);
        for square in covered {
            let width_pt = self.squares.entry(square).or_default();
            *width_pt = width_pt.max(style.width_pt);
        }
    }

    /// The width of the lines that cover most of `squares`, pt; `None` where none do.
    fn width_over(&self, squares: &HashSet<[i32; 2]>) -> Option<f64> {
        let mut widths: Vec<f64> = squares
            .iter()
            .filter_map(|[x, y]| {
                let near = [[*x, *y], [x + 1, *y], [x - 1, *y], [*x, y + 1], [*x, y - 1]];
                let widths = near.iter().filter_map(|square| self.squares.get(square));
                widths.copied().reduce(f64::max)
            })
            .collect();
        widths.sort_by(f64::total_cmp);
        (2 * widths.len() > squares.len()).then(|| widths[widths.len() / 2])
    }
}

/// The squares of the page on which a line lies that consists of `pieces`.
fn squares(pieces: &[Vec<Point>]) -> impl Iterator<Item = [i32; 2]> {
    let lines = pieces.iter().map(|piece| simplified(piece, UNSEEN_PT));
    let segments = lines.flat_map(|line| {
        let ends = line.windows(2).map(|pair| (pair[0], pair[1]));
        ends.collect::<Vec<_>>()
    });
    segments.flat_map(|(from, to)| {
        let (dx, dy) = (to.x - from.x, to.y - from.y);
        let count = (2.0 * libm::hypot(dx, dy) / Above::SIDE_PT).ceil().max(1.0);
        (0..=count as u32).map(move |number| {
            let part = f64::from(number) / count;
            let place = [from.x + part * dx, from.y + part * dy];
            place.map(|at| libm::floor(at / Above::SIDE_PT) as i32)
        })
    })
}

pub fn length(line: &[Point]) -> f64 {
    let pairs = line.windows(2);
    let ways = pairs.map(|pair| libm::hypot(pair[1].x - pair[0].x, pair[1].y - pair[0].y));
    ways.sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A line of 400 points, each so far from the next, every second one so far from a level one at that height, pt.
    fn zigzag(apart: f64, high: f64, from: f64) -> Vec<Vec<Point>> {
        vec![
            (0..400)
                .map(|i: i32| at(f64::from(i) * apart, from + f64::from(i % 2) * high))
                .collect(),
        ]
    }

    #[test]
    fn a_line_hides_what_it_swings_about() {
        let way_pt = |apart, high| way_pt(&zigzag(apart, high, 0.0));
        let level = way_pt(0.5, 0.0);
        assert!(hides(way_pt(0.5, 40.0), level));
        assert!(!hides(level, level));
        // Ripples that nobody sees are no swings.
        assert!(!hides(way_pt(0.1, 0.3), way_pt(0.1, 0.0)));
    }

    #[test]
    fn a_line_is_wide_where_it_lies_on_another() {
        let mut above = Above::default();
        above.add(&zigzag(0.5, 0.0, 0.0), &mut SeriesStyle::curve(0));
        let mut width_at = |height: f64| {
            let mut style = SeriesStyle::exact(1);
            above.add(&zigzag(0.5, 0.0, height), &mut style);
            style.width_pt
        };
        let thin = SeriesStyle::curve(0).width_pt;
        assert_eq!(width_at(0.2), thin + Above::WIDER_PT);
        assert_eq!(width_at(5.0), thin);
        // It lies on the line before it, which is not the first.
        assert_eq!(width_at(5.0), thin + Above::WIDER_PT);
    }
}
