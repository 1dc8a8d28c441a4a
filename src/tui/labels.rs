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

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(taken: &[(u16, u16)]) -> Labels {
        let mut labels = Labels::new(Rect::new(0, 0, 10, 3));
        taken.iter().for_each(|cell| labels.take(*cell));
        labels
    }

    #[test]
    fn a_label_stands_at_its_cell_or_off_marks_beside_it() {
        for (taken, cell, width, place) in [
            (&[][..], (4, 1), 1, (4, 1)),
            (&[(4, 2)], (4, 1), 1, (4, 1)),
            (&[], (9, 1), 2, (8, 1)), // whole in the picture
            (&[(4, 1)], (4, 1), 1, (6, 1)),
            (&[(9, 1)], (9, 1), 1, (7, 1)),
        ] {
            let placed = labels(taken).place(cell, width);
            assert_eq!(placed, place, "{width} at {cell:?} beside {taken:?}");
        }
    }

    #[test]
    fn it_keeps_off_other_labels_and_stays_where_nothing_is_free() {
        let mut crowded = labels(&[(4, 1)]);
        assert_eq!(crowded.place((6, 1), 6), (4, 0), "to another row");
        assert_eq!(crowded.place((6, 1), 6), (4, 2));
        assert_eq!(crowded.place((4, 0), 2), (1, 0), "a free column beside it");
        let mut full = Labels::new(Rect::new(0, 0, 4, 1));
        full.place((0, 0), 4);
        assert_eq!(full.place((1, 0), 3), (1, 0));
    }
}
