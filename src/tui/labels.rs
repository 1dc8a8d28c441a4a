//! Labels of a picture. A label is written at the first free position near its mark, or omitted if none is free.

use crate::engine::text::wrap::columns;
use ratatui::buffer::{Buffer, Cell};
use ratatui::layout::Rect;
use ratatui::style::Style;

/// Positions of a label, best first, as offsets of its first or last column from the mark and as rows down.
#[rustfmt::skip]
pub const AROUND_MARK: &[LabelOffset] = &[
    LabelOffset::Right(3, 0), LabelOffset::Right(2, -1), LabelOffset::Right(2, 1), LabelOffset::Left(2, 0),
    LabelOffset::Left(2, -1), LabelOffset::Left(2, 1), LabelOffset::Right(0, -1), LabelOffset::Right(0, 1),
    LabelOffset::Right(0, -2), LabelOffset::Right(0, 2), LabelOffset::Right(3, -2), LabelOffset::Right(3, 2),
    LabelOffset::Right(4, 1), LabelOffset::Right(5, 0), LabelOffset::Left(-2, 2), LabelOffset::Left(-2, 3),
    LabelOffset::Right(2, 3), LabelOffset::Right(2, -3),
];

/// Positions of a letter that names a point.
#[rustfmt::skip]
pub const AROUND_POINT: &[LabelOffset] = &[
    LabelOffset::Right(1, 0), LabelOffset::Left(1, 0), LabelOffset::Right(2, 0), LabelOffset::Left(2, 0),
    LabelOffset::Right(0, -1), LabelOffset::Right(0, 1), LabelOffset::Right(2, -1), LabelOffset::Right(2, 1),
    LabelOffset::Left(2, -1), LabelOffset::Left(2, 1), LabelOffset::Right(3, 0), LabelOffset::Left(3, 0),
];

/// Positions above or below the end of an axis. The position at the pane's edge is used only if the others are
/// occupied.
#[rustfmt::skip]
pub const AT_AXIS_END: &[LabelOffset] = &[
    LabelOffset::Right(0, -1), LabelOffset::Right(0, 1), LabelOffset::Right(1, -1), LabelOffset::Right(1, 1),
    LabelOffset::Right(2, -1), LabelOffset::Right(2, 1),
];

/// Offset of a label from its mark: columns across, rows down.
#[derive(Clone, Copy, Debug)]
pub enum LabelOffset {
    /// Columns from the mark to the first column of the label, to the right.
    Right(i32, i32),
    /// Columns from the mark to the last column of the label, to the left.
    Left(i32, i32),
}

/// The picture on which labels are written.
pub struct Labels<'a> {
    pub picture: Rect,
    pub buf: &'a mut Buffer,
}

impl Labels<'_> {
    /// Writes `text` at the first free position of `offsets` around the cell `mark`, counted from the picture's upper
    /// left. Returns false if no position is free.
    pub fn place(
        &mut self,
        mark: (i32, i32),
        offsets: &[LabelOffset],
        text: &str,
        style: Style,
    ) -> bool {
        let width = columns(text) as i32;
        let places = offsets.iter().map(|offset| match *offset {
            LabelOffset::Right(across, down) => (mark.0 + across, mark.1 + down),
            LabelOffset::Left(across, down) => (mark.0 - across - width + 1, mark.1 + down),
        });
        let free = places.into_iter().find(|&at| self.is_free(at, width));
        if let Some(at) = free {
            self.write(at, text, style);
        }
        free.is_some()
    }

    /// Writes `text` at this cell, over its content. Does nothing outside the picture.
    pub fn write(&mut self, (x, y): (i32, i32), text: &str, style: Style) {
        if self.contains((x, y), columns(text) as i32) {
            let (x, y) = (self.picture.x + x as u16, self.picture.y + y as u16);
            self.buf.set_string(x, y, text, style);
        }
    }

    fn contains(&self, (x, y): (i32, i32), width: i32) -> bool {
        let (columns, rows) = (
            i32::from(self.picture.width),
            i32::from(self.picture.height),
        );
        x >= 0 && y >= 0 && x + width <= columns && y < rows
    }

    /// Returns true if the cells are blank and no letter or digit is next to them.
    fn is_free(&self, (x, y): (i32, i32), width: i32) -> bool {
        let is_blank = (x..x + width).all(|x| self.symbol((x, y)) == Some(" "));
        let is_apart = [x - 1, x + width].into_iter().all(|x| {
            let sign = self.symbol((x, y)).and_then(|sign| sign.chars().next());
            !sign.is_some_and(char::is_alphanumeric)
        });
        is_blank && is_apart
    }

    /// Returns the content of a cell, or `None` outside the picture.
    fn symbol(&self, (x, y): (i32, i32)) -> Option<&str> {
        let place = self.contains((x, y), 1);
        let cell = place.then(|| {
            self.buf
                .cell((self.picture.x + x as u16, self.picture.y + y as u16))
        });
        cell.flatten().map(Cell::symbol)
    }
}
