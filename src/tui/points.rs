//! Measured points on a picture: a mark in the cell of each, and a bar if its uncertainty is larger than the cell.
//!
//! No other sign on a picture has the shape of the mark. Bars do not cover the curve. After a mark that covers the
//! curve, the next few cells show the curve, because a row of marks would hide it.

use crate::lab::view::theme::Marker;
use crate::lab::view::theme::Theme;
use crate::tui::dots::on_sheet;
use crate::tui::theme::Role;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

impl Marker {
    pub fn point(self) -> char {
        match self {
            Self::Ascii => 'X', // an axis may be named x
            _ => '×',
        }
    }

    /// Returns the characters of a bar: upper end, middle and lower end of a vertical one, then left end, middle and
    /// right end of a horizontal one.
    fn bars(self) -> [[char; 3]; 2] {
        match self {
            Self::Ascii => [['-', '|', '-'], ['|', '-', '|']],
            _ => [['┬', '│', '┴'], ['├', '─', '┤']],
        }
    }
}

/// Cells of the curve that are shown after a mark that covers the curve.
const CURVE_CELLS_SHOWN: u8 = 3;

/// Sign in a cell. A later variant covers an earlier one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum CellSign {
    Nothing,
    Bar(char),
    End(char),
    Mark,
}

/// Measured points on an area of the screen.
pub struct Points {
    area: Rect,
    marker: Marker,
    cells: Vec<(CellSign, Role)>,
}

/// Ends of a bar, cells from the upper left. They may be outside the picture.
pub type Ends = (f64, f64);

impl Points {
    pub fn new(area: Rect, marker: Marker) -> Self {
        let nothing = (CellSign::Nothing, Role::Measured);
        Self {
            area,
            marker,
            cells: vec![nothing; area.width as usize * area.height as usize],
        }
    }

    /// Adds a point at `x` and `y` (cells from the upper left) with the ends of its horizontal and vertical bars.
    ///
    /// The mark is omitted if it is outside the picture.
    pub fn add(
        &mut self,
        (x, y): (f64, f64),
        level: Option<Ends>,
        upright: Option<Ends>,
        role: Role,
    ) {
        let [up, across] = self.marker.bars();
        if let Some(ends) = upright {
            self.bar(y, ends, self.area.height, up, |row| (x, row), role);
        }
        if let Some(ends) = level {
            self.bar(x, ends, self.area.width, across, |column| (column, y), role);
        }
        self.set((x, y), CellSign::Mark, role);
    }

    /// Draws a bar through `middle` along a side of `cells` cells. `place` returns the position of each cell.
    ///
    /// A bar that ends in the cell of its mark is not drawn.
    fn bar(
        &mut self,
        middle: f64,
        (begin, end): Ends,
        cells: u16,
        [first, between, last]: [char; 3],
        place: impl Fn(f64) -> (f64, f64),
        role: Role,
    ) {
        let (begin, end) = (begin.min(end).floor(), begin.max(end).floor());
        let last_cell = f64::from(cells) - 1.0;
        let shown = [begin, end, middle.floor()];
        if shown.iter().any(|cell| cell.is_nan()) || end < 0.0 || begin >= f64::from(cells) {
            return;
        }
        let mut cell = begin.clamp(0.0, last_cell);
        while cell <= end.clamp(0.0, last_cell) {
            let sign = match cell {
                _ if cell == begin && begin < middle.floor() => CellSign::End(first),
                _ if cell == end && end > middle.floor() => CellSign::End(last),
                _ => CellSign::Bar(between),
            };
            if cell != middle.floor() {
                self.set(place(cell), sign, role);
            }
            cell += 1.0;
        }
    }

    fn set(&mut self, (x, y): (f64, f64), sign: CellSign, role: Role) {
        let size = (self.area.width.into(), self.area.height.into());
        let Some((x, y)) = on_sheet((x, y), size) else {
            return;
        };
        let cell = &mut self.cells[y * size.0 + x];
        if sign >= cell.0 {
            *cell = (sign, role);
        }
    }

    pub fn render(&self, theme: &Theme, buf: &mut Buffer) {
        let width = usize::from(self.area.width.max(1));
        for (cells, y) in self.cells.chunks(width).zip(self.area.y..) {
            let mut to_be_seen = 0u8;
            for (&(sign, role), x) in cells.iter().zip(self.area.x..) {
                let Some(target) = buf.cell_mut((x, y)) else {
                    continue;
                };
                let is_free = target.symbol() == " ";
                let (symbol, is_shown) = match sign {
                    CellSign::Nothing => (' ', false),
                    CellSign::Bar(symbol) | CellSign::End(symbol) => (symbol, is_free),
                    CellSign::Mark => (self.marker.point(), is_free || to_be_seen == 0),
                };
                if is_shown {
                    target.set_char(symbol).set_style(theme.style(role));
                }
                to_be_seen = if is_shown && !is_free {
                    CURVE_CELLS_SHOWN
                } else {
                    to_be_seen.saturating_sub(1)
                };
            }
        }
    }
}
