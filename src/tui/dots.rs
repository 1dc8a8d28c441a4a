//! A canvas of dots on which panes draw curves, whichever characters show the dots.

use crate::lab::view::markers::Marker;
use crate::lab::view::theme::Theme;
use crate::tui::theme::Role;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

/// The layer of a dot. Layers differ not in colour alone: see [`Marker::strong`] and [`Marker::faint`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ink {
    /// The run's own motion. It hides the layers under it; the dashes of the exact motion hide it.
    Strong(Role),
    /// The exact motion, axes, and the previous sweep.
    Faint(Role),
    /// What a path has left behind, under these.
    Under(Role),
    /// The previous run, under all other layers.
    Ghost,
}

#[derive(Clone, Copy, Debug, Default)]
struct Cell {
    strong: u8,
    faint: u8,
    under: u8,
    ghost: u8,
    strong_role: Role,
    faint_role: Role,
    under_role: Role,
}

/// Dots on an area of cells; columns and rows are counted from the upper left.
pub struct Dots {
    area: Rect,
    marker: Marker,
    cells: Vec<Cell>,
}

impl Dots {
    pub fn new(area: Rect, marker: Marker) -> Self {
        let cells = vec![Cell::default(); area.width as usize * area.height as usize];
        Self {
            area,
            marker,
            cells,
        }
    }

    /// Dots in a cell, across and down.
    pub fn in_a_cell(&self) -> (usize, usize) {
        self.marker.dots()
    }

    /// Dots across.
    pub fn width(&self) -> usize {
        self.area.width as usize * self.marker.dots().0
    }

    /// Dots down.
    pub fn height(&self) -> usize {
        self.area.height as usize * self.marker.dots().1
    }

    /// Sets the dot at column `x`, row `y`; outside the sheet nothing happens.
    pub fn set(&mut self, x: f64, y: f64, ink: Ink) {
        let inside = x >= 0.0 && y >= 0.0 && x < self.width() as f64 && y < self.height() as f64;
        if !inside {
            return; // so is NaN
        }
        let (x, y) = (x as usize, y as usize);
        let (across, down) = self.marker.dots();
        let bit = self.marker.bit(x % across, y % down);
        let cell = &mut self.cells[y / down * self.area.width as usize + x / across];
        match ink {
            Ink::Strong(role) => {
                cell.strong |= bit;
                cell.strong_role = role;
            }
            Ink::Faint(role) => {
                cell.faint |= bit;
                cell.faint_role = role;
            }
            Ink::Under(role) => {
                cell.under |= bit;
                cell.under_role = role;
            }
            Ink::Ghost => cell.ghost |= bit,
        }
    }

    /// Takes the dot at column `x`, row `y` away, of whatever layer.
    pub fn clear(&mut self, x: usize, y: usize) {
        let (across, down) = self.marker.dots();
        let kept = !self.marker.bit(x % across, y % down);
        if let Some(cell) = self
            .cells
            .get_mut(y / down * self.area.width as usize + x / across)
        {
            cell.strong &= kept;
            cell.faint &= kept;
            cell.under &= kept;
            cell.ghost &= kept;
        }
    }

    /// Takes all dots of a cell away, in which the dot at column `x`, row `y` is.
    pub fn clear_cell(&mut self, x: usize, y: usize) {
        let (across, down) = self.marker.dots();
        let cell = y / down * self.area.width as usize + x / across;
        if let Some(cell) = self.cells.get_mut(cell) {
            *cell = Cell::default();
        }
    }

    pub fn marker(&self) -> Marker {
        self.marker
    }

    pub fn line(&mut self, from: (f64, f64), to: (f64, f64), ink: Ink) {
        let (dx, dy) = (to.0 - from.0, to.1 - from.1);
        let length = dx.abs().max(dy.abs()).ceil();
        let longest = 4.0 * (self.width() + self.height()) as f64;
        if length.is_nan() || length > longest {
            return; // nowhere near the sheet
        }
        for dot in 0..=length as usize {
            let share = if length > 0.0 {
                dot as f64 / length
            } else {
                0.0
            };
            self.set(from.0 + share * dx, from.1 + share * dy, ink);
        }
    }

    pub fn column(&mut self, x: usize, top: usize, bottom: usize, ink: Ink) {
        for y in top..=bottom.min(self.height().saturating_sub(1)) {
            self.set(x as f64, y as f64, ink);
        }
    }

    /// Draws the dots on the screen; cells without dots are left as they are.
    pub fn render(&self, theme: &Theme, buf: &mut Buffer) {
        for (cell, position) in self.cells.iter().zip(self.area.positions()) {
            let (symbol, role) = match (cell.strong, cell.faint, cell.under, cell.ghost) {
                (0, 0, 0, 0) => continue,
                (0, 0, 0, ghost) => (self.marker.ghost(ghost), Role::Ghost),
                (0, 0, under, _) => (self.marker.faint(under), cell.under_role),
                (0, faint, ..) => (self.marker.faint(faint), cell.faint_role),
                // The exact motion is dashed: where it coincides with the run, the run is seen between its dashes.
                (_, faint, ..) if faint != 0 && cell.faint_role == Role::Exact => {
                    (self.marker.faint(faint), cell.faint_role)
                }
                (strong, ..) => (self.marker.strong(strong), cell.strong_role),
            };
            if let Some(target) = buf.cell_mut(position) {
                target.set_char(symbol).set_style(theme.style(role));
            }
        }
    }
}
