//! A sheet of dots: what panes draw curves on, whatever the dots are made of.

use crate::lab::view::markers::Marker;
use crate::lab::view::theme::Theme;
use crate::tui::theme::Role;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

/// How a dot is meant. Colour is never the only difference: see [`Marker::strong`] and [`Marker::faint`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ink {
    /// The motion itself; it hides what lies under it, but for the exact one in a patch that it fills.
    Strong(Role),
    /// The exact motion, axes, what is old.
    Faint(Role),
    /// The run before, under everything else.
    Ghost,
}

#[derive(Clone, Copy, Debug, Default)]
struct Cell {
    strong: u8,
    faint: u8,
    ghost: u8,
    strong_role: Role,
    faint_role: Role,
}

/// Dots on an area of cells, numbered from the upper left.
pub struct Dots {
    area: Rect,
    marker: Marker,
    cells: Vec<Cell>,
}

impl Dots {
    /// An empty sheet on `area`.
    pub fn new(area: Rect, marker: Marker) -> Self {
        let cells = vec![Cell::default(); area.width as usize * area.height as usize];
        Self {
            area,
            marker,
            cells,
        }
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
            Ink::Ghost => cell.ghost |= bit,
        }
    }

    /// A straight line from one dot to another.
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

    /// Every dot of column `x` from row `top` to row `bottom`.
    pub fn column(&mut self, x: usize, top: usize, bottom: usize, ink: Ink) {
        for y in top..=bottom.min(self.height().saturating_sub(1)) {
            self.set(x as f64, y as f64, ink);
        }
    }

    /// A cell that is filled, which no cell is that has a dot or two.
    fn patch(&self) -> u8 {
        let (across, down) = self.marker.dots();
        if across * down <= 2 {
            return 0;
        }
        let places = (0..across).flat_map(|x| (0..down).map(move |y| (x, y)));
        places.fold(0, |bits, (x, y)| bits | self.marker.bit(x, y))
    }

    /// Puts the dots on the screen; cells without dots are left as they are.
    pub fn render(&self, theme: &Theme, buf: &mut Buffer) {
        let full = self.patch();
        for (cell, position) in self.cells.iter().zip(self.area.positions()) {
            let (symbol, role) = match (cell.strong, cell.faint, cell.ghost) {
                (0, 0, 0) => continue,
                (0, 0, ghost) => (self.marker.ghost(ghost), Role::Ghost),
                (0, faint, _) => (self.marker.faint(faint), cell.faint_role),
                // Where the motion swings too fast to be drawn it fills the cell: the exact one is a line in it.
                (strong, faint, _)
                    if strong == full && faint != 0 && cell.faint_role == Role::Exact =>
                {
                    (self.marker.faint(faint), cell.faint_role)
                }
                (strong, _, _) => (self.marker.strong(strong), cell.strong_role),
            };
            if let Some(target) = buf.cell_mut(position) {
                target.set_char(symbol).set_style(theme.style(role));
            }
        }
    }
}
