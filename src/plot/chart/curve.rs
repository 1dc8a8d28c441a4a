//! The line of a series on the page, without points that are too close to be seen.

use super::layout::PlacedPanel;
use super::{ChartSeries, Panel, SeriesStyle};
use crate::plot::ink::{PageRectangle, WHITE, at, paler, pen};
use crate::plot::line::{clipped, distance, first_passes, simplified, without_ripples};
use crate::plot::scene::{Color, PageScene, Point, StrokeStyle, VectorPath};
use crate::plot::stroke_outline;
use std::collections::HashSet;

/// Maximum distance of a line from its points, relative to its width: a tenth of a dot at 600 dots per inch for a line
/// of 0.7 pt.
const TOLERANCE: f64 = 0.02;
/// Absolute maximum of this distance, pt.
const UNSEEN_PT: f64 = 0.014;
/// A line with more points than this is drawn as the outline of its ink if the outline has fewer points (about 40 kB).
/// Dashes would merge in it.
const MANY_LINE_POINTS: usize = 5_000;
/// Fraction of white in the color of a band.
pub const BAND_WHITE: f64 = 0.72;
/// Ripples of a dashed line that are lower than this part of its width are not followed.
const UNSEEN_RIPPLE: f64 = 0.35;
/// A dashed line is drawn once where it comes so near to itself again, in its widths.
const AGAIN: f64 = 2.0;
/// Distance beyond the panel up to which a line is drawn before it is clipped, pt: at least half its width.
const BEYOND_PT: f64 = 2.0;

impl PlacedPanel {
    pub fn place(&self, point: &[f64; 2]) -> Point {
        at(self.x.place(point[0]), self.y.place(point[1]))
    }

    /// Draws the line of `series`, or both edges of its band.
    pub fn draw_line(&self, series: &ChartSeries, scene: &mut PageScene) {
        self.draw_with(&series.style.pen(), series, scene);
    }

    /// Draws a white border around the dashes of an exact motion, so that they are visible on dense swings.
    pub fn draw_halo(&self, series: &ChartSeries, scene: &mut PageScene) {
        if series.style.halo_pt() > 0.0 {
            let pen = series.style.pen();
            let halo = StrokeStyle {
                width_pt: pen.width_pt + series.style.halo_pt(),
                color: WHITE,
                ..pen
            };
            self.draw_with(&halo, series, scene);
        }
    }

    /// Draws what [`draw_line`](Self::draw_line) draws, with this `pen`.
    fn draw_with(&self, pen: &StrokeStyle, series: &ChartSeries, scene: &mut PageScene) {
        if series.style.width_pt == 0.0 {
            return;
        }
        let pieces = if !series.band.is_empty() {
            let edges = self
                .edges(&series.band)
                .map(|edge| clipped(edge.into_iter(), &self.clip()));
            edges.concat()
        } else if series.style.is_dots {
            let places = series.points.iter().map(|point| self.place(point));
            dots(places.filter(|place| self.clip().holds(*place)))
        } else {
            self.pieces(series)
        };
        draw_curve(&pieces, pen, Some(&self.frame), scene);
    }

    /// Draws the sparse marks along the line of `series`, if it has them, at equal distances. `place` is the index of
    /// the series in its panel; it shifts the marks so that they do not collide.
    pub fn draw_sparse_marks(&self, series: &ChartSeries, place: usize, scene: &mut PageScene) {
        let Some(mark) = series.style.sparse_mark else {
            return;
        };
        let pieces: Vec<Vec<Point>> = self
            .pieces(series)
            .iter()
            .map(|piece| simplified(piece, UNSEEN_PT))
            .collect();
        let metric = if self.is_true_to_scale {
            distance
        } else {
            distance_along_x
        };
        for point in spread(&pieces, place, metric) {
            if self.frame.holds(point) {
                scene.mark(mark, point, series.style.color);
            }
        }
    }

    /// The line of `series` on the page, cut off at the panel.
    pub fn pieces(&self, series: &ChartSeries) -> Vec<Vec<Point>> {
        let places = series.points.iter().map(|point| self.place(point));
        as_dashed(clipped(places, &self.clip()), &series.style, |place| *place)
    }

    /// A frame around the panel with room for the width of a line.
    fn clip(&self) -> PageRectangle {
        self.frame.grown(BEYOND_PT)
    }

    /// Fills or hatches the band of `series`, if it has one.
    pub fn fill_band(&self, series: &ChartSeries, scene: &mut PageScene) {
        let ([first, .., last], color) = (&series.band[..], series.style.color) else {
            return;
        };
        if series.style.is_hatched {
            let [left, right] = [first[0], last[0]].map(|x| self.x.place(x));
            let stripe = PageRectangle {
                left: left.max(self.frame.left),
                right: right.min(self.frame.right),
                ..self.frame
            };
            return hatch(&stripe, color, scene);
        }
        let [least, greatest] = self.edges(&series.band);
        let corners = least.into_iter().chain(greatest.into_iter().rev());
        let outline = corners.map(|place| self.clip().nearest(place));
        let color = paler(color, BAND_WHITE);
        scene.fill_in(VectorPath::polygon(outline), color, Some(&self.frame));
    }

    /// Returns the lower and upper edge of a `band`.
    fn edges(&self, band: &[[f64; 3]]) -> [Vec<Point>; 2] {
        [1, 2].map(|edge| {
            band.iter()
                .map(|at| self.place(&[at[0], at[edge]]))
                .collect()
        })
    }

    /// Returns true if `frame` contains nothing of `panel`.
    pub fn is_clear(&self, frame: &PageRectangle, panel: &Panel) -> bool {
        let mut series = panel.series.iter();
        series.all(|series| !self.has_in(frame, series))
    }

    /// Returns true if `frame` contains a part of `series`.
    pub fn has_in(&self, frame: &PageRectangle, series: &ChartSeries) -> bool {
        let mut bars =
            (0..series.points.len()).flat_map(|index| [0, 1].map(|axis| series.ends(index, axis)));
        (series.style.width_pt > 0.0 && self.has_line_in(frame, &series.points))
            || (series.style.mark.is_some() && bars.any(|bar| self.has_line_in(frame, &bar)))
            || self.has_stripe_in(frame, series)
    }

    /// Returns whether a part of the stripe of `series` is in `frame`, if it is one along the axis x.
    fn has_stripe_in(&self, frame: &PageRectangle, series: &ChartSeries) -> bool {
        let mut limits = series.band.iter().map(|at| at[2]);
        let is_along_x = series.points.is_empty() && limits.all(f64::is_finite);
        let top = series.band.first().map(|at| self.y.place(at[2]));
        is_along_x && top.is_some_and(|top| top < frame.bottom)
    }

    /// Returns true if `frame` contains a part of the line through `points`.
    fn has_line_in(&self, frame: &PageRectangle, points: &[[f64; 2]]) -> bool {
        let places = points.iter().map(|point| self.place(point));
        !clipped(places, frame).is_empty()
    }
}

/// Hatches a rectangle of the page.
pub fn hatch(rectangle: &PageRectangle, color: Color, scene: &mut PageScene) {
    const APART_PT: f64 = 4.0;
    const HATCH_PT: f64 = 0.35;
    let pen = pen(HATCH_PT, color);
    let height = rectangle.height();
    let count = ((rectangle.width() + height) / APART_PT).ceil() as u32;
    for number in 0..count {
        let foot = rectangle.left - height + (f64::from(number) + 0.5) * APART_PT;
        let line = [at(foot, rectangle.bottom), at(foot + height, rectangle.top)];
        scene.stroke(VectorPath::polyline(line), pen.clone(), Some(rectangle));
    }
}

pub fn dots(places: impl Iterator<Item = Point>) -> Vec<Vec<Point>> {
    const LENGTH_PT: f64 = 0.02;
    places
        .map(|place| vec![place, at(place.x + LENGTH_PT, place.y)])
        .collect()
}

/// Returns the parts of a line of this `style` that are drawn, with its points at a `place` on the page: of a dashed one each
/// part once, since dashes that follow each other would make it solid.
pub fn as_dashed<P: Copy>(
    pieces: Vec<Vec<P>>,
    style: &SeriesStyle,
    place: impl Fn(&P) -> Point,
) -> Vec<Vec<P>> {
    if style.dash_pt.is_empty() {
        return pieces;
    }
    let steady: Vec<Vec<P>> = pieces
        .iter()
        .map(|piece| without_ripples(piece, &place, UNSEEN_RIPPLE * style.width_pt))
        .collect();
    let mut pairs = steady.iter().flat_map(|piece| piece.array_windows());
    if pairs.all(|[from, to]| place(from).x <= place(to).x) {
        return steady; // a curve over time
    }
    first_passes(&steady, &place, AGAIN * style.width_pt)
}

/// Draws a line that is clipped at `clip`, with fewer points and the same appearance.
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
    if count > MANY_LINE_POINTS {
        let area = stroke_outline::area(&lines, pen.width_pt);
        // The area is empty if the lines need too large a grid.
        if !area.0.is_empty() && area.0.len() < count {
            return scene.fill_in(area, pen.color, clip);
        }
    }
    for line in lines {
        scene.stroke(VectorPath::polyline(line), pen.clone(), clip);
    }
}

/// Number of marks along a line, and the shift between consecutive series as a fraction of the distance between marks.
const SPARSE_MARKS: usize = 6;
const SPARSE_SHIFT: f64 = 0.23;

/// Returns places along a line that consists of `pieces`, at equal distances by `metric`.
pub fn spread(pieces: &[Vec<Point>], place: usize, metric: fn(Point, Point) -> f64) -> Vec<Point> {
    let pairs = pieces.iter().flat_map(|piece| piece.windows(2));
    let whole: f64 = pairs.map(|pair| metric(pair[0], pair[1])).sum();
    let apart = whole / SPARSE_MARKS as f64;
    let first = apart * (0.3 + SPARSE_SHIFT * place as f64).fract();
    let mut places = Vec::new();
    let mut passed = 0.0;
    for pair in pieces.iter().flat_map(|piece| piece.windows(2)) {
        let long = metric(pair[0], pair[1]);
        while places.len() < SPARSE_MARKS && long > 0.0 {
            let part = (first + apart * places.len() as f64 - passed) / long;
            if part > 1.0 {
                break;
            }
            let [dx, dy] = [pair[1].x - pair[0].x, pair[1].y - pair[0].y];
            places.push(at(pair[0].x + part * dx, pair[0].y + part * dy));
        }
        passed += long;
    }
    places
}

/// The squares of the page that a line crosses.
pub struct Squares(HashSet<[i32; 2]>);

impl Squares {
    /// Side of a square, pt.
    const SIDE_PT: f64 = 0.5;
    /// Fraction of a line that must lie on another line if both are to look like one.
    const SAME: f64 = 0.98;

    pub fn new(pieces: &[Vec<Point>]) -> Self {
        let mut squares = HashSet::new();
        for piece in pieces {
            let line = simplified(piece, UNSEEN_PT);
            for pair in line.windows(2) {
                let (dx, dy) = (pair[1].x - pair[0].x, pair[1].y - pair[0].y);
                let count = (2.0 * libm::hypot(dx, dy) / Self::SIDE_PT).ceil().max(1.0);
                for number in 0..=count as u32 {
                    let part = f64::from(number) / count;
                    let place = [pair[0].x + part * dx, pair[0].y + part * dy];
                    squares.insert(place.map(|at| libm::floor(at / Self::SIDE_PT) as i32));
                }
            }
        }
        Self(squares)
    }

    /// Returns true if both lines look like one line.
    pub fn coincide(&self, other: &Self) -> bool {
        self.are_covered_by(other) && other.are_covered_by(self)
    }

    fn are_covered_by(&self, other: &Self) -> bool {
        let covered = self.0.iter().filter(|[x, y]| {
            let near = [[*x, *y], [x + 1, *y], [x - 1, *y], [*x, y + 1], [*x, y - 1]];
            near.iter().any(|square| other.0.contains(square))
        });
        !self.0.is_empty() && covered.count() as f64 >= Self::SAME * self.0.len() as f64
    }
}

/// Returns how far two points are from each other along the axis x. Marks at equal such distances along a curve over time are
/// at equal times.
fn distance_along_x(from: Point, to: Point) -> f64 {
    (to.x - from.x).abs()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns a line of 400 points, `apart` from each other, every second one `high` off the level `from`, pt.
    fn zigzag(apart: f64, high: f64, from: f64) -> Vec<Vec<Point>> {
        vec![
            (0..400)
                .map(|i: i32| at(f64::from(i) * apart, from + f64::from(i % 2) * high))
                .collect(),
        ]
    }

    #[test]
    fn lines_coincide_if_each_stays_on_the_other() {
        let level = Squares::new(&zigzag(0.5, 0.0, 0.0));
        assert!(!level.coincide(&Squares::new(&zigzag(0.25, 0.0, 0.2))));
        assert!(level.coincide(&Squares::new(&zigzag(0.5, 0.0, 0.2))));
        assert!(!level.coincide(&Squares::new(&zigzag(0.5, 0.0, 3.0))));
        // The level line stays near the zigzag, but not the zigzag near the level line.
        assert!(!level.coincide(&Squares::new(&zigzag(0.5, 40.0, 0.0))));
    }

    #[test]
    fn marks_are_spread_evenly_over_a_line() {
        let line = vec![
            vec![at(0.0, 0.0), at(60.0, 0.0)],
            vec![at(70.0, 0.0), at(130.0, 0.0)],
        ];
        let places: Vec<f64> = spread(&line, 0, distance)
            .iter()
            .map(|place| place.x)
            .collect();
        assert_eq!(places, [6.0, 26.0, 46.0, 76.0, 96.0, 116.0]);
        assert_ne!(spread(&line, 0, distance), spread(&line, 1, distance));
        assert_eq!(spread(&[], 0, distance), []);
        let still = [vec![at(1.0, 1.0), at(1.0, 1.0)]];
        assert_eq!(spread(&still, 0, distance), []);
    }
}
