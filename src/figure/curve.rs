//! The line of a series on the page, without the points that nobody could see.

use super::axis::Scale;
use super::chart::Series;
use super::clip::clipped;
use super::ink::{Frame, at};
use super::layout::Placed;
use super::scene::Point;

/// Width of a column of which only first, lowest, highest and last point are drawn, pt. It is well below the width of a line,
/// and below a dot at 300 dpi.
const COLUMN_PT: f64 = 0.2;
/// How far outside of its panel a line is followed, pt: half its width, which is cut off at the edge.
const BEYOND_PT: f64 = 2.0;

impl Placed {
    /// Where `point` stands on the page.
    pub fn place(&self, point: &[f64; 2]) -> Point {
        at(self.x.place(point[0]), self.y.place(point[1]))
    }

    /// The pieces of the line of `series` in this panel.
    pub fn line(&self, series: &Series) -> Vec<Vec<Point>> {
        let places = series.points.iter().map(|point| self.place(point));
        let pieces = clipped(places, &self.frame.grown(BEYOND_PT));
        pieces.into_iter().map(thinned).collect()
    }

    /// Whether something of `series` is drawn in `frame`.
    pub fn has_in(&self, frame: &Frame, series: &Series) -> bool {
        if series.style.width_pt > 0.0 {
            let places = series.points.iter().map(|point| self.place(point));
            if !clipped(places, frame).is_empty() {
                return true;
            }
        }
        let ends = series.points.iter().enumerate().map(|(index, point)| {
            let error = series.errors.get(index).copied().filter(|e| e.is_finite());
            [-1.0, 1.0].map(|sign| point[1] + sign * error.unwrap_or(0.0))
        });
        let bars = series.points.iter().zip(ends).map(|(point, ends)| {
            let bar = ends.map(|end| self.place(&[point[0], end]));
            clipped(bar.into_iter(), frame)
        });
        series.style.mark.is_some() && bars.into_iter().any(|bar| !bar.is_empty())
    }
}

/// `points` with their first, lowest, highest and last point of each column alone, where they run to the right.
fn thinned(points: Vec<Point>) -> Vec<Point> {
    let runs_right = points.windows(2).all(|pair| pair[1].x >= pair[0].x);
    if points.len() < 8 || !runs_right {
        return points;
    }
    let column = |point: &Point| (point.x / COLUMN_PT).floor();
    let mut kept = Vec::new();
    for column in points.chunk_by(|a, b| column(a) == column(b)) {
        let by_height = |a: &&Point, b: &&Point| a.y.total_cmp(&b.y);
        let first = column.first();
        let lowest = column.iter().max_by(by_height);
        let highest = column.iter().min_by(by_height);
        let last = column.last();
        // In the order in which the line comes to them.
        let mut four: Vec<&Point> = [first, lowest, highest, last]
            .into_iter()
            .flatten()
            .collect();
        four.sort_by_key(|&point| std::ptr::from_ref(point));
        four.dedup_by(|a, b| std::ptr::eq(*a, *b));
        kept.extend(four.into_iter().copied());
    }
    kept
}

impl Scale {
    /// Whether two places of the axis can be told apart at all.
    pub fn is_sound(&self) -> bool {
        let (low, high) = self.range;
        low < high && (high - low).is_finite()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn thinning_keeps_every_extreme(values in prop::collection::vec(-1e3_f64..1e3, 8..4000), width in 1.0_f64..200.0) {
            let step = width / values.len() as f64;
            let points: Vec<_> = values.iter().enumerate().map(|(i, &y)| at(i as f64 * step, y)).collect();
            let kept = thinned(points.clone());
            let columns = (width / COLUMN_PT) as usize + 2;
            prop_assert!(kept.len() <= 4 * columns);
            for column in points.chunk_by(|a, b| (a.x / COLUMN_PT).floor() == (b.x / COLUMN_PT).floor()) {
                for wanted in [f64::min, f64::max] {
                    let extreme = column.iter().map(|p| p.y).reduce(wanted).unwrap();
                    let there = kept.iter().any(|p| p.y == extreme && column.iter().any(|c| c.x == p.x));
                    prop_assert!(there);
                }
            }
            prop_assert!(kept.windows(2).all(|pair| pair[0].x <= pair[1].x));
        }
    }
}
