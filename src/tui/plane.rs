//! A plane, meters to the right and up, on an area of cells. Circles are round at every size.

use crate::engine::text::nice_numbers::at_or_below;
use crate::engine::text::number::shortest;
use crate::lab::view::theme::Marker;
use crate::tui::dots::on_sheet;
use ratatui::layout::Rect;

/// A plane on an area of the screen.
#[derive(Clone, Copy, Debug)]
pub struct Plane {
    /// Point in the middle of the area, m.
    pub middle: (f64, f64),
    /// Dots per meter, across and down.
    pub scale: (f64, f64),
    /// Dots of the area, across and down.
    pub size: (usize, usize),
    /// Dots per cell, across and down.
    pub in_cell: (usize, usize),
}

impl Plane {
    /// Creates the plane on `area` at the largest scale that shows `half` (m) to each side of `middle`.
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

    /// Returns the column and row of a dot, or `None` outside the area.
    pub fn place(&self, dot: (f64, f64)) -> Option<(usize, usize)> {
        on_sheet(dot, self.size)
    }

    /// Returns the cell of a dot, or `None` outside the area.
    pub fn cell_of(&self, dot: (f64, f64)) -> Option<(u16, u16)> {
        let (x, y) = self.place(dot)?;
        Some(((x / self.in_cell.0) as u16, (y / self.in_cell.1) as u16))
    }

    /// Returns the cell of a point, or the nearest cell at the edge.
    pub fn cell(&self, at: (f64, f64)) -> (u16, u16) {
        let (x, y) = self.dot(at);
        let (width, height) = (self.size.0 as f64, self.size.1 as f64);
        (
            (x.clamp(0.0, (width - 1.0).max(0.0)) / self.in_cell.0 as f64) as u16,
            (y.clamp(0.0, (height - 1.0).max(0.0)) / self.in_cell.1 as f64) as u16,
        )
    }

    /// Returns the scale bar: a line of a round length, at most `columns` long, with its length in m.
    pub fn bar(&self, columns: f64) -> String {
        let cell_m = self.in_cell.0 as f64 / self.scale.0;
        let length_m = at_or_below(columns * cell_m);
        // The bar reaches from the middle of its first cell to the middle of its last.
        let cells = (length_m / cell_m).round() as usize + 1;
        let line = "─".repeat(cells.saturating_sub(2));
        format!("├{line}┤ {} m", shortest(length_m))
    }
}
