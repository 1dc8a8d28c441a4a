//! The whole path of the traced point seen from above, in bounded memory.
//!
//! It is a list of the cells of a square grid around the pivot, each with the step of the path's first visit. The grid
//! starts small and doubles its width when the path leaves it. The path of a nearly upright top is thus resolved as
//! finely as the path of a falling one.

use nalgebra::Vector3;

/// Cells along one side: a power of two, so that the grid can be halved about its center.
const SIDE: usize = 512;
/// Maximum distance of two positions that are joined by a line, in cells. A longer gap stays open, because the motion
/// in between is unknown.
const LONGEST_PATH_LINE_CELLS: f64 = 24.0;

#[derive(Clone, Debug)]
pub struct PathFromAbove {
    half_width: f64,
    is_visited: Vec<bool>,
    visits: Vec<Visit>,
    last: Option<(f64, f64)>,
    pub radius: f64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Visit {
    step: u64,
    cell: u32,
}

impl PathFromAbove {
    pub fn new(reach: f64) -> Self {
        let half_width = if reach > 0.0 { reach / 64.0 } else { 1.0 };
        Self {
            half_width,
            is_visited: vec![false; SIDE * SIDE],
            visits: Vec::new(),
            last: None,
            radius: 0.0,
        }
    }

    pub fn add(&mut self, step: u64, position: &Vector3<f64>) {
        let (x, y) = (position.x, position.y);
        let radius = x.abs().max(y.abs());
        while radius >= self.half_width {
            self.double();
        }
        if x * x + y * y > self.radius * self.radius {
            self.radius = libm::hypot(x, y);
        }
        let (from_x, from_y) = self.last.replace((x, y)).unwrap_or((x, y));
        let (way_x, way_y) = (x - from_x, y - from_y);
        let cell = 2.0 * self.half_width / SIDE as f64;
        let cells = way_x.abs().max(way_y.abs()) / cell;
        if cells > 1.0 && cells <= LONGEST_PATH_LINE_CELLS {
            // On processors without an instruction for it, ceil() calls a library.
            let whole = cells as u32;
            let dots = whole + u32::from(f64::from(whole) < cells);
            for dot in 1..=dots {
                let share = f64::from(dot) / f64::from(dots);
                self.visit(step, from_x + share * way_x, from_y + share * way_y);
            }
        } else {
            self.visit(step, from_x + way_x, from_y + way_y);
        }
    }

    fn visit(&mut self, step: u64, x: f64, y: f64) {
        self.visit_cell(step, self.row_or_column(x), self.row_or_column(y));
    }

    fn visit_cell(&mut self, step: u64, column: usize, row: usize) {
        let cell = row * SIDE + column;
        if !std::mem::replace(&mut self.is_visited[cell], true) {
            self.visits.push(Visit {
                step,
                cell: cell as u32,
            });
        }
    }

    fn row_or_column(&self, length: f64) -> usize {
        let share = 0.5 * (length / self.half_width + 1.0);
        ((share * SIDE as f64) as usize).min(SIDE - 1)
    }

    /// Clears the cells that were first visited after `step`. The grid keeps its width, and the radius is then exact to
    /// a cell.
    ///
    /// Call [`continue_from`](Self::continue_from) before following the point further.
    pub fn cut_back(&mut self, step: u64) {
        let kept = self.visits.partition_point(|visit| visit.step <= step);
        for visit in self.visits.drain(kept..) {
            self.is_visited[visit.cell as usize] = false;
        }
        self.radius = self.radius_about(0.0, 0.0);
    }

    pub fn continue_from(&mut self, position: &Vector3<f64>) {
        self.last = Some((position.x, position.y));
    }

    /// Doubles the width of the grid: four cells become one.
    fn double(&mut self) {
        let visits = std::mem::take(&mut self.visits);
        for visit in &visits {
            self.is_visited[visit.cell as usize] = false;
        }
        self.half_width *= 2.0;
        for visit in visits {
            let [column, row] = visit.place().map(|place| SIDE / 4 + place / 2);
            self.visit_cell(visit.step, column, row);
        }
    }

    /// Returns the largest distance of the path from the point (`x`, `y`), m, to the accuracy of a cell.
    pub fn radius_about(&self, x: f64, y: f64) -> f64 {
        let distances = self
            .dots()
            .map(|(at_x, at_y)| libm::hypot(at_x - x, at_y - y));
        distances.fold(0.0, f64::max)
    }

    pub fn dots(&self) -> impl Iterator<Item = (f64, f64)> {
        self.visits.iter().map(move |visit| {
            visit
                .place()
                .map(|place| ((place as f64 + 0.5) / SIDE as f64 * 2.0 - 1.0) * self.half_width)
                .into()
        })
    }
}

impl Visit {
    /// Returns the column and the row of the cell.
    fn place(&self) -> [usize; 2] {
        let cell = self.cell as usize;
        [cell % SIDE, cell / SIDE]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn every_position_has_a_dot_within_half_a_cell(
            positions in prop::collection::vec((-2.0..2.0f64, -2.0..2.0f64), 1..40)
        ) {
            let mut path = PathFromAbove::new(2.0);
            for (&(x, y), step) in positions.iter().zip(0..) {
                path.add(step, &Vector3::new(x, y, 0.0));
            }
            let cell = 2.0 * path.half_width / SIDE as f64;
            for (x, y) in positions {
                let near = path.dots().any(|(a, b)| (a - x).abs() <= cell && (b - y).abs() <= cell);
                prop_assert!(near, "({}, {})", x, y);
            }
        }
    }

    proptest! {
        #[test]
        fn a_truncated_path_equals_the_shorter_path(
            positions in prop::collection::vec((-2.0..2.0f64, -2.0..2.0f64), 2..60), share in 0.0..1.0f64
        ) {
            let follow = |path: &mut PathFromAbove, range: std::ops::Range<usize>| for step in range {
                let (x, y) = positions[step];
                path.add(step as u64, &Vector3::new(x, y, 0.0));
            };
            let at = (share * positions.len() as f64) as usize;
            let (mut short, mut long) = (PathFromAbove::new(2.0), PathFromAbove::new(2.0));
            // Give both grids their final width, so that their cells can be compared.
            (short.half_width, long.half_width) = (2.0, 2.0);
            follow(&mut short, 0..at + 1);
            follow(&mut long, 0..positions.len());
            let (x, y) = positions[at];
            long.cut_back(at as u64);
            long.continue_from(&Vector3::new(x, y, 0.0));
            prop_assert_eq!(&short.visits, &long.visits);
            prop_assert_eq!(short.last, long.last);
            let cell = 4.0 / SIDE as f64;
            prop_assert!((short.radius - long.radius).abs() <= cell);
            follow(&mut short, at + 1..positions.len());
            follow(&mut long, at + 1..positions.len());
            prop_assert_eq!(short.visits, long.visits);
        }
    }
}
