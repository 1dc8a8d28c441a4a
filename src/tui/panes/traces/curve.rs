//! A curve of a strip as dots: a line, or a band where its swings are too fast to be drawn one by one.

use super::plot::THINNEST_BAND;
use crate::playback::scale::Scale;
use crate::playback::strip::Column;
use crate::tui::dots::{Dots, Ink};
use std::ops::RangeInclusive;

/// A value this part of a dot above the edge between two dots counts as below it: a value on the edge, such as a constant
/// in the middle of its strip, would else go up and down with its rounding.
const ROUNDING: f64 = 1e-4;

/// Cells after which long and short dashes repeat.
const LONG_AND_SHORT: usize = 6;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stroke {
    /// All of them, and a band is filled with a few.
    Full,
    /// All of them, and of a band its edges alone.
    Edges,
    /// Those in every other cell: the exact motion.
    Dashed,
    /// Single ones: the run before.
    Dotted,
    /// Those in three cells, then in one, with a cell between: the pinned run.
    LongAndShort,
}

impl Stroke {
    /// Whether the column `x` of dots is drawn where a cell is `across` dots wide.
    fn keeps(self, x: usize, across: usize) -> bool {
        match self {
            Self::Full | Self::Edges => true,
            Self::Dashed => (x / across).is_multiple_of(2),
            Self::LongAndShort => !matches!(x / across % LONG_AND_SHORT, 3 | 5),
            Self::Dotted => x.is_multiple_of(across.max(2)),
        }
    }

    /// From one dot to the next in a steep piece, where a cell is `down` dots high: a dotted curve has two in each cell,
    /// counted from the cell's top. A level piece is seen at any height.
    fn rows_apart(self, down: usize) -> usize {
        match self {
            Self::Dotted => (down / 2).max(1),
            _ => 1,
        }
    }
}

pub fn draw(dots: &mut Dots, columns: &[Option<Column>], scale: &Scale, stroke: Stroke, ink: Ink) {
    let (across, down) = dots.in_a_cell();
    let height = dots.height() as f64;
    if height == 0.0 {
        return;
    }
    let place = |value: f64| scale.from_top(value) * height + ROUNDING;
    let row = |value: f64| place(value).clamp(0.0, height - 1.0) as usize;
    let is_inside = |value: f64| (0.0..height + 2.0 * ROUNDING).contains(&place(value));
    let mut before: Option<(usize, usize)> = None;
    for (x, column) in columns.iter().enumerate() {
        let last = before.take();
        let band = |column: &Column| column.band.unwrap_or(column.extent);
        let Some(column) = column.filter(|column| scale.meets(band(column))) else {
            continue;
        };
        let band = band(&column);
        let mut set = |(from, to): (usize, usize)| {
            let rows = (from..=to).step_by(stroke.rows_apart(down));
            for y in rows.filter(|_| stroke.keeps(x, across)) {
                dots.set(x as f64, y as f64, ink);
            }
        };
        let (top, bottom) = (row(band.max), row(band.min));
        if column.band.is_none() || bottom < top + THINNEST_BAND {
            set((row(column.extent.max), row(column.extent.min)));
            continue;
        }
        let (last_top, last_bottom) = last.unwrap_or((top, bottom));
        // An edge beyond the strip is not drawn: the band goes on there.
        if is_inside(band.max) {
            set(toward(top, last_top));
        }
        if is_inside(band.min) {
            set(toward(bottom, last_bottom));
        }
        if stroke == Stroke::Full {
            fill(dots, x, top..=bottom, ink);
        }
        before = Some((top, bottom));
    }
}

/// Sets one of four dots between the edges of a band, on slanting lines that are seen to be no curves.
fn fill(dots: &mut Dots, x: usize, rows: RangeInclusive<usize>, ink: Ink) {
    let (across, down) = dots.in_a_cell();
    let ink = match ink {
        Ink::Strong(role) if across * down <= 2 => Ink::Under(role), // large dots would hide the edges
        _ => ink,
    };
    for y in rows.filter(|y| (x + 2 * y).is_multiple_of(4)) {
        dots.set(x as f64, y as f64, ink);
    }
}

/// The rows from `row` to the one next to `before`, so that an edge has no gap.
fn toward(row: usize, before: usize) -> (usize, usize) {
    if before < row {
        (before + 1, row)
    } else {
        (row, before.saturating_sub(1).max(row))
    }
}
