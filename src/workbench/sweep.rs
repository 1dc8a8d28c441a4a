//! The geometry of an oscilloscope's sweep: the pen moves to the right and the picture stays.
//!
//! Right of the pen, behind a gap, the sweep before is still to be seen. Only the pen's column changes from frame to
//! frame, which a slow line can carry where a scrolling window is too much for it.

use super::recording::{Block, Curve, Extent, Recording};

/// A window of time on a number of columns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sweep {
    /// Length of the window, s.
    pub window_s: f64,
    /// When the present sweep began, s.
    pub begin_s: f64,
    /// Now, s.
    pub now_s: f64,
    /// Columns (of dots) the window is wide.
    pub columns: usize,
    /// Columns left empty ahead of the pen.
    pub gap: usize,
}

impl Sweep {
    /// The sweep at `now_s`, in a window of `window_s` (both s) that is `columns` wide, `gap` of them kept empty ahead
    /// of the pen.
    pub fn new(window_s: f64, now_s: f64, columns: usize, gap: usize) -> Self {
        // A run of exactly one window ends at its right edge, not at its left.
        let sweeps = (now_s / window_s * (1.0 - 1e-12)).floor().max(0.0);
        Self {
            window_s,
            begin_s: sweeps * window_s,
            now_s,
            columns,
            gap,
        }
    }

    /// The column of the pen.
    pub fn pen(&self) -> usize {
        self.column(self.now_s)
    }

    /// The earliest time that is still shown, s.
    pub fn since_s(&self) -> f64 {
        (self.now_s - self.window_s).max(0.0)
    }

    /// The column of `time_s`, within the present sweep or the one before.
    fn column(&self, time_s: f64) -> usize {
        let passed = time_s - self.begin_s;
        let passed = if passed < 0.0 {
            passed + self.window_s
        } else {
            passed
        };
        let column = (passed / self.window_s * self.columns as f64) as usize;
        column.min(self.columns.saturating_sub(1))
    }

    /// Whether the sweep before is still shown at `column`.
    fn keeps(&self, column: usize) -> bool {
        column > self.pen() + self.gap
    }

    /// The first and the last column of `block`, `None` where the pen has been since.
    fn place(&self, block: &Block) -> Option<(usize, usize)> {
        let present = block.end_s >= self.begin_s;
        let begin_s = if present {
            block.begin_s.max(self.begin_s)
        } else {
            block.begin_s
        };
        let (first, last) = (self.column(begin_s), self.column(block.end_s));
        if present {
            return Some((first, last));
        }
        let first = (first..=last).find(|&column| self.keeps(column))?;
        Some((first, last))
    }

    /// What `curve` does in each column: the extremes of every step in it, and of the straight way to the next.
    pub fn extents(&self, recording: &Recording, curve: Curve) -> Vec<Option<Extent>> {
        let mut columns = vec![None; self.columns];
        let mut before: Option<(usize, Extent)> = None;
        for block in recording.since(self.since_s()) {
            let Some((first, last)) = self.place(block) else {
                before = None;
                continue;
            };
            let extent = block.extents[curve as usize];
            if let Some((column, from)) = before.filter(|&(column, _)| column < first) {
                join(&mut columns, (column, from), (first, extent));
            }
            for slot in columns.iter_mut().take(last + 1).skip(first) {
                *slot = Some(slot.map_or(extent, |old: Extent| old.and(extent)));
            }
            before = Some((last, extent));
        }
        columns
    }
}

/// The straight way from one block to the next, over the columns between them and half of it in each of their own.
fn join(columns: &mut [Option<Extent>], from: (usize, Extent), to: (usize, Extent)) {
    let ((begin, from), (end, to)) = (from, to);
    let (leave, arrive) = nearest(from, to);
    let length = (end - begin) as f64;
    let (low, high) = (leave.min(arrive), leave.max(arrive));
    let at = |place: f64| (leave + (arrive - leave) * (place / length)).clamp(low, high);
    for (place, slot) in columns[begin..=end].iter_mut().enumerate() {
        let place = place as f64;
        let way = Extent::of(at(place - 0.5)).and(Extent::of(at(place + 0.5)));
        *slot = Some(slot.map_or(way, |old| old.and(way)));
    }
}

/// The two values, one of each extent, that are nearest to each other.
fn nearest(from: Extent, to: Extent) -> (f64, f64) {
    if from.max < to.min {
        (from.max, to.min)
    } else if to.max < from.min {
        (from.min, to.max)
    } else {
        let shared = from.min.max(to.min);
        (shared, shared)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::workbench::recording::Moment;
    use nalgebra::Vector3;
    use proptest::prelude::*;

    fn recorded(values: &[f64], dt: f64) -> Recording {
        let mut recording = Recording::default();
        for (step, &x) in values.iter().enumerate() {
            let position = Vector3::new(x, 0.0, 0.0);
            recording.push(&Moment {
                time_s: step as f64 * dt,
                position,
                tilt_deg: 0.0,
            });
        }
        recording
    }

    proptest! {
        #[test]
        fn every_sub_steps_extremes_are_drawn(
            values in prop::collection::vec(-1.0..1.0f64, 2..9_000), columns in 1usize..300
        ) {
            let recording = recorded(&values, 1.0);
            let now = (values.len() - 1) as f64;
            let drawn = Sweep::new(now, now, columns, 2).extents(&recording, Curve::X);
            let of = |pick: fn(&Extent) -> f64| drawn.iter().flatten().map(pick).collect::<Vec<_>>();
            let (lowest, highest) = (of(|e| e.min), of(|e| e.max));
            prop_assert_eq!(lowest.into_iter().fold(2.0, f64::min), values.iter().copied().fold(2.0, f64::min));
            prop_assert_eq!(highest.into_iter().fold(-2.0, f64::max), values.iter().copied().fold(-2.0, f64::max));
            prop_assert!(drawn.iter().all(Option::is_some), "a gap in a whole run");
        }

        #[test]
        fn columns_stay_inside_the_window(
            steps in 1usize..4_000, window in 0.01..500.0f64, columns in 1usize..200, gap in 0usize..5
        ) {
            let recording = recorded(&vec![0.5; steps], 0.1);
            let sweep = Sweep::new(window, (steps - 1) as f64 * 0.1, columns, gap);
            prop_assert!(sweep.pen() < columns);
            prop_assert_eq!(sweep.extents(&recording, Curve::X).len(), columns);
        }
    }

    #[test]
    fn the_picture_stays_and_the_pen_moves() {
        let values: Vec<f64> = (0..150).map(f64::from).collect();
        let recording = recorded(&values, 1.0);
        let extents = Sweep::new(100.0, 149.0, 100, 4).extents(&recording, Curve::X);
        assert_eq!(extents[10].unwrap().max, 110.5);
        assert_eq!(extents[60].unwrap().max, 60.5);
        assert!(
            extents[50..=53].iter().all(Option::is_none),
            "{:?}",
            &extents[48..56]
        );
    }

    #[test]
    fn neighbours_are_joined() {
        let recording = recorded(&[0.0, 10.0], 1.0);
        let extents = Sweep::new(1.0, 1.0, 6, 0).extents(&recording, Curve::X);
        for pair in extents.windows(2) {
            assert!(pair[0].unwrap().max >= pair[1].unwrap().min - 1e-12);
        }
    }
}
