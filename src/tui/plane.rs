//! A plane, m to the right and up, on an area of cells: circles are round at every size. And places for its letters and
//! words, where they cover neither each other nor its marks.

use crate::engine::text::nice_numbers::at_or_below;
use crate::engine::text::number::shortest;
use crate::lab::view::theme::Marker;
use crate::tui::dots::on_sheet;
use ratatui::layout::Rect;

#[derive(Clone, Copy, Debug)]
pub struct Plane {
    /// What is in the middle of the area, m.
    pub middle: (f64, f64),
    /// Dots in a metre, across and down.
    pub scale: (f64, f64),
    /// Dots of the area, across and down.
    pub size: (usize, usize),
    /// Dots in a cell, across and down.
    pub in_cell: (usize, usize),
}

impl Plane {
    /// The plane on `area`, as large as there is room for `half` to each side, and up and down (m).
    pub fn new(area: Rect, marker: Marker, middle: (f64, f64), half: (f64, f64)) -> Self {
        let in_cell = marker.dots();
        let size = (
            area.width as usize * in_cell.0,
            area.height as usize * in_cell.1,
        );
        let aspect = marker.dot_aspect();
        let down = (0.5 * size.1 as f64 / half.1).min(0.5 * size.0 as f64 * aspect / half.0);
        Self {
            middle,
            scale: (down / aspect, down),
            size,
            in_cell,
        }
    }

    pub fn dot(&self, (right, up): (f64, f64)) -> (f64, f64) {
        (
            0.5 * self.size.0 as f64 + (right - self.middle.0) * self.scale.0,
            0.5 * self.size.1 as f64 - (up - self.middle.1) * self.scale.1,
        )
    }

    pub fn shows(&self, at: (f64, f64)) -> bool {
        self.place(self.dot(at)).is_some()
    }

    /// The column and row of a dot; `None` outside of the area.
    pub fn place(&self, dot: (f64, f64)) -> Option<(usize, usize)> {
        on_sheet(dot, self.size)
    }

    /// The cell of a dot; `None` outside of the area.
    pub fn cell_of(&self, dot: (f64, f64)) -> Option<(u16, u16)> {
        let (x, y) = self.place(dot)?;
        Some(((x / self.in_cell.0) as u16, (y / self.in_cell.1) as u16))
    }

    /// The cell of a place, or the one at the edge that is nearest to it.
    pub fn cell(&self, at: (f64, f64)) -> (u16, u16) {
        let (x, y) = self.dot(at);
        let (width, height) = (self.size.0 as f64, self.size.1 as f64);
        (
            (x.clamp(0.0, (width - 1.0).max(0.0)) / self.in_cell.0 as f64) as u16,
            (y.clamp(0.0, (height - 1.0).max(0.0)) / self.in_cell.1 as f64) as u16,
        )
    }

    /// The scale: a line of a round length, at most `columns` long.
    pub fn bar(&self, columns: f64) -> String {
        let cell_m = self.in_cell.0 as f64 / self.scale.0;
        let length_m = at_or_below(columns * cell_m);
        // From the middle of its first cell to that of its last.
        let cells = (length_m / cell_m).round() as usize + 1;
        let line = "─".repeat(cells.saturating_sub(2));
        format!("├{line}┤ {} m", shortest(length_m))
    }
}

/// How far a label may stand from its own cell, columns and rows.
const ACROSS: u16 = 8;
const LABEL_ROWS_DOWN: u16 = 2;

/// The cells of a picture that are taken by labels and marks; counted from its upper left.
pub struct LabelCells {
    width: u16,
    height: u16,
    /// Column and row, and how many columns.
    taken: Vec<((u16, u16), u16)>,
}

impl LabelCells {
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
        let rows = y.saturating_sub(LABEL_ROWS_DOWN)
            ..=(y + LABEL_ROWS_DOWN).min(self.height.saturating_sub(1));
        let cells = rows.flat_map(|row| columns.clone().map(move |column| (column, row)));
        let free = cells.filter(|other| self.is_free(*other, width));
        // A row is about twice as high as a column is wide; of two places as near, the one to the right.
        let place = free
            .min_by_key(|&(column, row)| {
                let distance = column.abs_diff(x) + 2 * row.abs_diff(y);
                (distance, row != y, column < x)
            })
            .unwrap_or((x, y));
        self.taken.push((place, width));
        place
    }

    fn is_free(&self, (x, y): (u16, u16), width: u16) -> bool {
        let mut on_row = self.taken.iter().filter(|((_, row), _)| *row == y);
        on_row.all(|&((other, _), columns)| x > other + columns || x + width < other)
    }
}
