//! The line of a series on the page, without the points that nobody could see.

use super::layout::Placed;
use super::{Panel, Series, Style};
use crate::figure::page::cover::{self, Grid};
use crate::figure::page::ink::{Frame, at};
use crate::figure::page::line::{clipped, simplified};
use crate::figure::page::scene::{Path, Pen, Point, Scene};

/// How far a solid line may leave its points, of its width: a tenth of a dot at 600 an inch for a line of 0.7 pt.
const TOLERANCE: f64 = 0.02;
/// A solid line of more points than this is drawn by the outline of its ink if that has fewer: a file of 40 kB.
const MANY: usize = 5_000;
/// How far a dashed line may leave its points, pt: below a dot at 600 an inch. And where it is a ripple about a flatter line.
const UNSEEN_PT: f64 = 0.015;
const FLAT_PT: f64 = 0.4;
/// A line has ripples where the flatter one is at most this part of its length.
const RIPPLED: f64 = 0.8;
/// A line of more pieces than this is interrupted because it was there before.
const MOST_PIECES: usize = 50;
/// Parts of a dashed line that are nearer to each other than this lie in each other's gaps, in periods of its dashes.
const APART: f64 = 1.0 / 3.0;
/// The least area of the places that a line passes, as a share of a straight line's area, where no part lies in another part's gaps.
const SHARE: f64 = 0.7;
/// How far outside of its panel a line is followed, pt: half its width, which is cut off at the edge.
const BEYOND_PT: f64 = 2.0;

impl Placed {
    pub fn place(&self, point: &[f64; 2]) -> Point {
        at(self.x.place(point[0]), self.y.place(point[1]))
    }

    /// Draws the line of `series`, if it has one.
    pub fn draw_line(&self, series: &Series, scene: &mut Scene) {
        if series.style.width_pt == 0.0 {
            return;
        }
        let pieces = self.pieces(series);
        draw_curve(&pieces, &series.style.pen(), Some(&self.frame), scene);
    }

    pub fn pieces(&self, series: &Series) -> Vec<Vec<Point>> {
        let places = series.points.iter().map(|point| self.place(point));
        let clip = self.frame.grown(BEYOND_PT);
        if series.style.is_dots {
            dots(places.filter(|place| clip.holds(*place)))
        } else {
            clipped(places, &clip)
        }
    }

    /// Whether nothing of `panel` is in `frame`.
    pub fn is_clear(&self, frame: &Frame, panel: &Panel) -> bool {
        let mut series = panel.series.iter();
        series.all(|series| !self.has_in(frame, series))
    }

    /// Whether something of `series` is in `frame`.
    fn has_in(&self, frame: &Frame, series: &Series) -> bool {
        let is_in = |points: &[[f64; 2]]| {
            let places = points.iter().map(|point| self.place(point));
            !clipped(places, frame).is_empty()
        };
        let mut bars =
            (0..series.points.len()).flat_map(|index| [0, 1].map(|axis| series.ends(index, axis)));
        (series.style.width_pt > 0.0 && is_in(&series.points))
            || (series.style.mark.is_some() && bars.any(|bar| is_in(&bar)))
    }
}

pub fn dots(places: impl Iterator<Item = Point>) -> Vec<Vec<Point>> {
    const LENGTH_PT: f64 = 0.02;
    let dot = |place: Point| vec![place, at(place.x + LENGTH_PT, place.y)];
    places.map(dot).collect()
}

/// Draws a line that is cut off outside of `clip`, in fewer pieces that look the same.
pub fn draw_curve(pieces: &[Vec<Point>], pen: &Pen, clip: Option<&Frame>, scene: &mut Scene) {
    let thinned = |piece: &Vec<Point>| {
        if pen.dash_pt.is_empty() {
            simplified(piece, TOLERANCE * pen.width_pt)
        } else {
            without_ripples(piece)
        }
    };
    let lines: Vec<Vec<Point>> = pieces.iter().map(thinned).collect();
    let count: usize = lines.iter().map(Vec::len).sum();
    if pen.dash_pt.is_empty() && count > MANY {
        let area = cover::area(&lines, pen.width_pt);
        // There is none of lines that need too large a grid.
        if !area.0.is_empty() && area.0.len() < count {
            return scene.fill_in(area, pen.color, clip);
        }
    }
    for line in lines {
        scene.stroke(Path::polyline(line), pen.clone(), clip);
    }
}

/// `line` through fewer points; without the swings that are too low to be seen, where these would use its dashes up.
fn without_ripples(line: &[Point]) -> Vec<Point> {
    let (fine, flat) = (simplified(line, UNSEEN_PT), simplified(line, FLAT_PT));
    if length(&flat) < RIPPLED * length(&fine) {
        flat
    } else {
        fine
    }
}

pub fn length(line: &[Point]) -> f64 {
    let pairs = line.windows(2);
    let ways = pairs.map(|pair| (pair[1].x - pair[0].x).hypot(pair[1].y - pair[0].y));
    ways.sum()
}

/// `style` for the line that consists of `pieces`: thin and solid where its dashes would fill their own gaps.
pub fn told_apart(pieces: &[Vec<Point>], style: Style) -> Style {
    if fills_its_gaps(pieces, style.dash_pt) {
        style.solid()
    } else {
        style
    }
}

/// Whether the dashes of a line that consists of `pieces` would lie in its own gaps: it then looks solid, and not evenly so.
fn fills_its_gaps(pieces: &[Vec<Point>], dash_pt: &[f64]) -> bool {
    let period_pt: f64 = dash_pt.iter().sum();
    if period_pt == 0.0 || pieces.len() > MOST_PIECES {
        return period_pt > 0.0;
    }
    let lines: Vec<_> = pieces.iter().map(|piece| without_ripples(piece)).collect();
    let length_pt: f64 = lines.iter().map(|line| length(line)).sum();
    let place_pt = APART * period_pt;
    let area_pt2 = Grid::inked(&lines, place_pt, 0.0).map_or(0.0, |grid| grid.area_pt2());
    area_pt2 < SHARE * place_pt * length_pt
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn dashes_are_told_apart_or_would_fill_their_gaps() {
        let dash_pt = Style::exact().dash_pt;
        let zigzag = |apart: f64, high: f64| -> Vec<Point> {
            let place = |i: i32| at(f64::from(i) * apart, f64::from(i % 2) * high);
            (0..400).map(place).collect()
        };
        let circle = |turns: u32| -> Vec<Point> {
            let angles = (0..=100 * turns).map(|i| 0.02 * PI * f64::from(i));
            let place = |angle: f64| at(40.0 * libm::cos(angle), 40.0 * libm::sin(angle));
            angles.map(place).collect()
        };
        assert!(fills_its_gaps(&[zigzag(0.5, 40.0)], dash_pt));
        assert!(fills_its_gaps(&[circle(2)], dash_pt));
        assert!(!fills_its_gaps(&[circle(1)], dash_pt));
        assert!(!fills_its_gaps(&[zigzag(8.0, 40.0)], dash_pt));
        // Ripples that nobody sees are no swings.
        assert!(!fills_its_gaps(&[zigzag(0.1, 0.3)], dash_pt));
        assert!(without_ripples(&zigzag(0.1, 0.3)).len() < 10);
    }
}
