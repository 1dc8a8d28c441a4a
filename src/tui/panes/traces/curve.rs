//! A curve of a strip as dots: a line, or the edges and the mean of a band where its swings are too fast to be drawn one
//! by one.

use crate::observe::scale::Scale;
use crate::observe::strip::Column;
use crate::tui::dots::{Dots, Ink};

/// A band whose edges are nearer to one another than this, in dots, has no room for a gap: it is drawn as a thick line.
const THINNEST_BAND: usize = 2;
/// A mean nearer to an edge than this, in dots, is not drawn.
const CLEAR_OF_EDGE: usize = 2;

/// A value this part of a dot above the edge between two dots counts as below it: a value on the edge, such as a constant
/// in the middle of its strip, would else go up and down with its rounding.
const ROUNDING: f64 = 1e-4;

/// Cells after which long and short dashes repeat.
const LONG_AND_SHORT: usize = 6;

/// Which dots of a curve are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stroke {
    /// All of them, and the mean of a band.
    Full,
    /// Those in every other cell: the exact motion.
    Dashed,
    /// Single ones: the run before.
    Dotted,
    /// Those in three cells, then in one, with a cell between: the pinned run.
    LongAndShort,
}

/// Draws `columns` on `dots`.
pub fn draw(dots: &mut Dots, columns: &[Option<Column>], scale: &Scale, stroke: Stroke, ink: Ink) {
    let (across, down) = dots.in_a_cell();
    let height = dots.height();
    if height == 0 {
        return;
    }
    let row = |value: f64| {
        let row = scale.from_top(value) * height as f64 + ROUNDING;
        row.clamp(0.0, height as f64 - 1.0) as usize
    };
    let keeps = |x: usize| match stroke {
        Stroke::Full => true,
        Stroke::Dashed => (x / across).is_multiple_of(2),
        Stroke::LongAndShort => !matches!(x / across % LONG_AND_SHORT, 3 | 5),
        Stroke::Dotted => x.is_multiple_of(across.max(2)),
    };
    // A steep piece of a dotted curve has two dots in each cell, counted from the cell's top. A level piece is seen at
    // any height.
    let apart = match stroke {
        Stroke::Dotted => (down / 2).max(1),
        _ => 1,
    };
    let mut before: Option<(usize, usize)> = None;
    for (x, column) in columns.iter().enumerate() {
        let Some(column) = column.filter(|column| scale.meets(column.extent)) else {
            before = None;
            continue;
        };
        let extent = column.band.unwrap_or(column.extent);
        let (top, bottom) = (row(extent.max), row(extent.min));
        let mut set = |from: usize, to: usize| {
            for y in (from..=to).step_by(apart).filter(|_| keeps(x)) {
                dots.set(x as f64, y as f64, ink);
            }
        };
        if column.band.is_none() || bottom < top + THINNEST_BAND {
            set(row(column.extent.max), row(column.extent.min));
            before = None;
            continue;
        }
        let (top_before, bottom_before) = before.unwrap_or((top, bottom));
        let (from, to) = toward(top, top_before);
        set(from, to);
        let (from, to) = toward(bottom, bottom_before);
        set(from, to);
        let mean = row(column.mean);
        let is_clear = mean >= top + CLEAR_OF_EDGE && mean + CLEAR_OF_EDGE <= bottom;
        if stroke == Stroke::Full && is_clear && x.is_multiple_of(across.max(2)) {
            set(mean, mean);
        }
        before = Some((top, bottom));
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::view::markers::Marker;
    use crate::lab::view::theme::{Background, Theme};
    use crate::observe::recording::Extent;
    use crate::tui::theme::Role;
    use ratatui::buffer::Buffer;
    use ratatui::layout::Rect;

    #[test]
    fn a_constant_in_the_middle_of_its_strip_is_one_line_whatever_its_rounding() {
        let area = Rect::new(0, 0, 20, 2);
        let scale = Scale {
            low: 29.99,
            high: 30.01,
        };
        let column = |x: usize| {
            let value = 30.0 + 1e-13 * (x % 3) as f64 - 1e-13;
            Some(Column {
                extent: Extent::of(value),
                mean: value,
                band: None,
            })
        };
        let columns: Vec<_> = (0..40).map(column).collect();
        let mut dots = Dots::new(area, Marker::Braille);
        let ink = Ink::Strong(Role::Text);
        draw(&mut dots, &columns, &scale, Stroke::Full, ink);
        let mut buf = Buffer::empty(area);
        let theme = Theme {
            colour: false,
            background: Background::Dark,
        };
        dots.render(&theme, &mut buf);
        let row = |y| -> String { (0..20).map(|x| buf[(x, y)].symbol()).collect() };
        assert_eq!([row(0), row(1)], [" ".repeat(20), "⠉".repeat(20)]);
    }
}
