//! The area that the ink of a line covers, as outlines.
//!
//! The ink is drawn into a grid of square cells. The boundary of the inked cells is traced, and its steps are
//! straightened. The grid is finer than the dots of a printer, so that lines closer than a cell become one area.

use super::line::simplified;
use super::scene::{Point, Segment, VectorPath, at};
use crate::plot::extent;

/// Sides of a cell, pt, at 1200 and at 600 dots per inch. The coarser grid is used if the finer one gives too many
/// points.
const CELLS_PT: [f64; 2] = [0.06, 0.12];
/// Number of points above which the coarser grid is used, about 800 kB in a file.
const MANY_OUTLINE_POINTS: usize = 100_000;
const MOST_GRID_CELLS: f64 = 32e6;
/// Maximum distance of an outline from the midpoints of the cells' sides, in cells.
const OUTLINE_TOLERANCE: f64 = 1.0;
/// Outlines with at most this number of cell sides are invisible dots.
const SMALLEST_OUTLINE: usize = 8;

/// Returns the outline of lines with round corners and ends, `width_pt` wide. It winds around the inked area.
pub fn area(lines: &[Vec<Point>], width_pt: f64) -> VectorPath {
    let mut area = VectorPath::default();
    for cell_pt in CELLS_PT {
        let Some(mut grid) = Grid::inked(lines, cell_pt, width_pt) else {
            continue;
        };
        grid.widen(0.5 * width_pt / cell_pt);
        area = grid.outlines();
        if area.0.len() <= MANY_OUTLINE_POINTS {
            break;
        }
    }
    area
}

/// Cells in rows from the top, with an empty cell at each edge.
pub struct Grid {
    origin: Point,
    cell_pt: f64,
    columns: usize,
    is_inked: Vec<bool>,
}

impl Grid {
    /// Creates a grid for lines `width_pt` wide, and inks the cells that `lines` cross. Returns `None` if nothing is
    /// drawn, if a coordinate is not a number, or if the grid would be too large.
    pub fn inked(lines: &[Vec<Point>], cell_pt: f64, width_pt: f64) -> Option<Self> {
        let mut grid = Self::around(lines, width_pt, cell_pt)?;
        for pair in lines.iter().flat_map(|line| line.windows(2)) {
            grid.trace(pair[0], pair[1]);
        }
        Some(grid)
    }

    pub fn area_pt2(&self) -> f64 {
        let inked = self.is_inked.iter().filter(|inked| **inked).count();
        inked as f64 * self.cell_pt * self.cell_pt
    }

    /// Returns the area of the inked cells that are the lower right corner of an inked square with sides of more than
    /// `inside` cells, pt².
    pub fn area_inside_pt2(&self, inside: usize) -> f64 {
        // Side of the largest inked square whose lower right corner is this cell.
        let mut sides = vec![0_u16; self.is_inked.len()];
        let mut count = 0;
        let cells = self.is_inked.iter().enumerate();
        for (here, _) in cells.filter(|(_, inked)| **inked) {
            let before = [1, self.columns, self.columns + 1]
                .map(|back| here.checked_sub(back).map_or(0, |place| sides[place]));
            let side = 1 + before[0].min(before[1]).min(before[2]);
            sides[here] = side;
            count += usize::from(usize::from(side) > inside);
        }
        count as f64 * self.cell_pt * self.cell_pt
    }

    fn around(lines: &[Vec<Point>], width_pt: f64, cell_pt: f64) -> Option<Self> {
        let points = lines.iter().flatten();
        let (left, right) = range(points.clone().map(|p| p.x))?;
        let (top, bottom) = range(points.map(|p| p.y))?;
        let margin = 0.5 * width_pt + 2.0 * cell_pt;
        let [columns, rows] = [right - left, bottom - top]
            .map(|length| libm::ceil((length + 2.0 * margin) / cell_pt));
        let fits = columns * rows <= MOST_GRID_CELLS;
        fits.then(|| Self {
            origin: at(left - margin, top - margin),
            cell_pt,
            columns: columns as usize,
            is_inked: vec![false; columns as usize * rows as usize],
        })
    }

    /// Inks the cells that a straight line crosses, one run per row.
    fn trace(&mut self, from: Point, to: Point) {
        let [mut upper, mut lower] = [from, to].map(|p| {
            (
                (p.x - self.origin.x) / self.cell_pt,
                (p.y - self.origin.y) / self.cell_pt,
            )
        });
        if upper.1 > lower.1 {
            std::mem::swap(&mut upper, &mut lower);
        }
        let slope = (lower.0 - upper.0) / (lower.1 - upper.1);
        if !(upper.0 + upper.1 + lower.0 + lower.1).is_finite() {
            return;
        }
        let mut enters = upper.0;
        for row in upper.1 as usize..=lower.1 as usize {
            let leaves = if row == lower.1 as usize {
                lower.0
            } else {
                upper.0 + ((row + 1) as f64 - upper.1) * slope
            };
            let (left, right) = (enters.min(leaves) as usize, enters.max(leaves) as usize);
            let begin = row * self.columns;
            if let Some(inked) = self.is_inked.get_mut(begin + left..=begin + right) {
                inked.fill(true);
            }
            enters = leaves;
        }
    }

    /// Inks all cells whose center is within `radius` (in cells) of the center of an inked cell.
    fn widen(&mut self, radius: f64) {
        let blank = vec![false; self.is_inked.len()];
        let traced = std::mem::replace(&mut self.is_inked, blank);
        let reach = libm::floor(radius) as usize;
        let halves: Vec<usize> = (0..=reach)
            .map(|down| (radius * radius - (down * down) as f64).max(0.0).sqrt() as usize)
            .collect();
        for (row, cells) in traced.chunks(self.columns).enumerate() {
            let mut column = 0;
            for run in cells.chunk_by(|a, b| a == b) {
                let end = column + run.len();
                if run[0] {
                    for other in row.saturating_sub(reach)..=row + reach {
                        let half = halves[other.abs_diff(row)];
                        let begin = other * self.columns + column.saturating_sub(half);
                        let end = other * self.columns + (end + half).min(self.columns);
                        if let Some(inked) = self.is_inked.get_mut(begin..end) {
                            inked.fill(true);
                        }
                    }
                }
                column = end;
            }
        }
    }

    /// Returns true if the cell to the lower right of this grid corner is inked.
    fn at(&self, x: isize, y: isize) -> bool {
        let is_inside = x >= 0 && y >= 0 && (x as usize) < self.columns;
        is_inside && self.is_inked.get(y as usize * self.columns + x as usize) == Some(&true)
    }

    /// Returns all outlines, with the ink on their right. Each outline runs to the right at least once, along the upper
    /// side of an inked cell. The uppermost row is empty.
    fn outlines(&self) -> VectorPath {
        let mut path = VectorPath::default();
        let mut is_done = vec![false; self.is_inked.len()];
        for start in self.columns..self.is_inked.len() {
            let begins = self.is_inked[start] && !self.is_inked[start - self.columns];
            if !begins || is_done[start] {
                continue;
            }
            let (column, row) = (start % self.columns, start / self.columns);
            let outline = self.outline((column as isize, row as isize), &mut is_done);
            if outline.len() <= SMALLEST_OUTLINE {
                continue;
            }
            let corners = simplified(&outline, OUTLINE_TOLERANCE);
            let places = corners[..corners.len() - 1].iter().map(|p| {
                at(
                    self.origin.x + p.x * self.cell_pt,
                    self.origin.y + p.y * self.cell_pt,
                )
            });
            path.0.extend(VectorPath::polyline(places).0);
            path.0.push(Segment::Close);
        }
        path
    }

    /// Returns the midpoints of the cell sides along one outline, closed by repeating the first. Marks the sides where
    /// the outline runs to the right.
    fn outline(&self, start: (isize, isize), is_done: &mut [bool]) -> Vec<Point> {
        let (mut at, mut step) = (start, (1, 0));
        let mut middles = Vec::new();
        loop {
            let (x, y) = at;
            if step == (1, 0) {
                is_done[y as usize * self.columns + x as usize] = true;
            }
            middles.push(Point {
                x: x as f64 + 0.5 * step.0 as f64,
                y: y as f64 + 0.5 * step.1 as f64,
            });
            at = (x + step.0, y + step.1);
            let right = (-step.1, step.0);
            let left = (-right.0, -right.1);
            // The cells ahead on each side. The cell of a grid corner is to its lower right.
            let ahead = [right, left].map(|side| {
                let column = at.0 - isize::from(step.0 + side.0 < 0);
                let row = at.1 - isize::from(step.1 + side.1 < 0);
                self.at(column, row)
            });
            step = match ahead {
                [false, _] => right,
                [true, true] => left,
                [true, false] => step,
            };
            if at == start && step == (1, 0) {
                middles.extend(middles.first().copied());
                return middles;
            }
        }
    }
}

/// Returns the minimum and maximum of `numbers`; `None` if there are none, or if one is not finite.
fn range(numbers: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    extent(numbers).filter(|(low, high)| (high - low).is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Counts how often the outlines wind around a point, ignoring the sign's meaning.
    fn winding(area: &VectorPath, x: f64, y: f64) -> i32 {
        let (mut count, mut start) = (0, at(0.0, 0.0));
        let mut at = start;
        for segment in &area.0 {
            let to = segment.end().unwrap_or(start);
            if let Segment::Move(_) = segment {
                start = to;
            } else if (at.y <= y) != (to.y <= y) {
                let crossing = at.x + (y - at.y) / (to.y - at.y) * (to.x - at.x);
                count += i32::from(crossing > x) * if to.y > at.y { 1 } else { -1 };
            }
            at = to;
        }
        count
    }

    fn distance(lines: &[Vec<Point>], x: f64, y: f64) -> f64 {
        let to = |pair: &[Point]| {
            let (dx, dy) = (pair[1].x - pair[0].x, pair[1].y - pair[0].y);
            let (px, py) = (x - pair[0].x, y - pair[0].y);
            let square = dx * dx + dy * dy;
            let share = if square > 0.0 {
                ((px * dx + py * dy) / square).clamp(0.0, 1.0)
            } else {
                0.0
            };
            libm::hypot(px - share * dx, py - share * dy)
        };
        lines
            .iter()
            .flat_map(|line| line.windows(2))
            .map(to)
            .fold(f64::INFINITY, f64::min)
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(48))]
        #[test]
        fn the_outline_encloses_the_stroke(
            places in prop::collection::vec((0.0_f64..12.0, 0.0_f64..12.0), 2..12),
            tries in prop::collection::vec((-2.0_f64..14.0, -2.0_f64..14.0), 300),
            width in 0.4_f64..3.0,
        ) {
            let line: Vec<Point> = places.into_iter().map(|(x, y)| at(x, y)).collect();
            let lines = [line[..line.len() / 2].to_vec(), line[line.len() / 2..].to_vec()];
            let area = area(&lines, width);
            for (x, y) in tries {
                let beyond = distance(&lines, x, y) - 0.5 * width;
                // Half a cell's diagonal at the line, half at the edge, and the tolerance of the smoothing.
                if beyond.abs() > CELLS_PT[0] * (1.42 + OUTLINE_TOLERANCE) {
                    prop_assert_eq!(winding(&area, x, y).abs(), i32::from(beyond < 0.0), "{} {}: {}", x, y, beyond);
                }
            }
        }
    }

    #[test]
    fn lines_without_finite_points_cover_nothing() {
        let far = |x: f64| vec![at(0.0, 0.0), at(x, 1.0)];
        let nowhere = far(f64::NAN)[1..].to_vec();
        for line in [vec![], nowhere, far(f64::INFINITY), far(1e12)] {
            assert_eq!(area(&[line], 0.7), VectorPath::default());
        }
        assert!(!area(&[far(f64::NAN), far(3.0)], 0.7).0.is_empty());
    }
}
