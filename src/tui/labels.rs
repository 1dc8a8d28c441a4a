//! Places for the letters and words of a picture, where they cover neither each other nor its marks.

use ratatui::layout::Rect;

/// How far a label may stand from its own cell, columns and rows.
const ACROSS: u16 = 8;
const DOWN: u16 = 2;

/// The cells of a picture that are taken by labels and marks; counted from its upper left.
pub struct Labels {
    width: u16,
    height: u16,
    /// Column and row, and how many columns.
    taken: Vec<((u16, u16), u16)>,
}

impl Labels {
    pub fn new(picture: Rect) -> Self {
        Self {
            width: picture.width,
            height: picture.height,
            taken: Vec::new(),
        }
    }

    pub fn take(&mut self, cell: (u16, u16)) {
        self.taken.push((cell, 1));
    }

    /// Takes the place of a label of `width` columns that belongs to `cell`: the nearest one with a free column to each
    /// side; the cell itself where there is none.
    pub fn place(&mut self, cell: (u16, u16), width: u16) -> (u16, u16) {
        let last = self.width.saturating_sub(width);
        let (x, y) = (cell.0.min(last), cell.1);
        let columns = x.saturating_sub(ACROSS)..=x.saturating_add(ACROSS).min(last);
        let rows = y.saturating_sub(DOWN)..=(y + DOWN).min(self.height.saturating_sub(1));
        let cells = rows.flat_map(|row| columns.clone().map(move |column| (column, row)));
        let free = cells.filter(|cell| self.is_free(*cell, width));
        // A row is about twice as high as a column is wide; of two places as near, the one to the right.
        let far = |&(column, row): &(u16, u16)| {
            let distance = column.abs_diff(x) + 2 * row.abs_diff(y);
            (distance, row != y, column < x)
        };
        let place = free.min_by_key(far).unwrap_or((x, y));
        self.taken.push((place, width));
        place
    }

    fn is_free(&self, (x, y): (u16, u16), width: u16) -> bool {
        let mut on_row = self.taken.iter().filter(|((_, row), _)| *row == y);
        on_row.all(|&((other, _), columns)| x > other + columns || x + width < other)
    }
}
