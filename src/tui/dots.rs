//! A canvas of dots on which panes draw curves, whichever characters show the dots: how many of these fit in a cell of the
//! screen, and which characters show them.

use crate::lab::view::theme::Marker;
use crate::lab::view::theme::Theme;
use crate::tui::theme::Role;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::symbols::pixel::OCTANTS;

impl Marker {
    /// Dots in a cell, across and down.
    pub fn dots(self) -> (usize, usize) {
        match self {
            Self::Braille | Self::Octant => (2, 4),
            Self::HalfBlock => (1, 2),
            Self::Dot | Self::Ascii => (1, 1),
        }
    }

    /// Width over height of one dot, in cells twice as high as wide.
    pub fn dot_aspect(self) -> f64 {
        let (across, down) = self.dots();
        0.5 * down as f64 / across as f64
    }

    /// The bit of the dot at `x`, `y` of a cell.
    pub fn bit(self, x: usize, y: usize) -> u8 {
        /// Rows of the Braille patterns' bits, left and right (Unicode, block U+2800).
        const BRAILLE: [[u8; 2]; 4] = [[0x01, 0x08], [0x02, 0x10], [0x04, 0x20], [0x40, 0x80]];
        match self {
            Self::Braille => BRAILLE[y % 4][x % 2],
            Self::Octant => 1 << (2 * (y % 4) + x % 2),
            _ => 1 << (y % 2),
        }
    }

    /// The character of a cell with these `bits` in a layer, strong, faint, under or ghost.
    pub(super) fn sign(self, layer: usize, bits: u8) -> char {
        match (self, layer) {
            (Self::Braille, _) => char::from_u32(0x2800 + u32::from(bits)).unwrap_or(' '),
            (Self::Octant, _) => OCTANTS[usize::from(bits)],
            (Self::HalfBlock, 0) => half_block(bits),
            (Self::Dot, 0) => '•',
            (Self::Ascii, 0) => '*',
            (Self::Ascii, 1 | 2) => '.',
            (Self::Ascii, _) => ',',
            (_, 1 | 2) => '·',
            (_, _) => '°',
        }
    }
}

fn half_block(bits: u8) -> char {
    match bits & 3 {
        1 => '▀',
        2 => '▄',
        _ => '█',
    }
}

/// `symbol` in ASCII, for terminals whose locale is not UTF-8: a stand-in of the same width.
pub fn ascii(symbol: &str) -> &'static str {
    match symbol {
        "─" | "╴" => "-",
        "▕" | "▏" => "|",
        "◊" => "+",
        "↑" => "^",
        "↓" => "v",
        "±" => "~",
        "█" | "▀" | "■" | "━" | "┃" | "┏" | "┓" | "┗" | "┛" => "#",
        "│" => "|",
        "┌" | "┐" | "└" | "┘" | "├" | "┤" => "+",
        "×" => "x",
        "═" => "=",
        "°" => ",",
        "▲" => "^",
        "▼" => "v",
        "…" | "·" | "•" => ".",
        "►" | "→" => ">",
        "◄" | "←" => "<",
        "Ω" => "W",
        "τ" => "T",
        "–" | "—" | "−" | "⁻" => "-",
        // Of the formulas of a time step.
        "Σ" => "S",
        "Δ" => "D",
        "ᵀ" | "′" => "'",
        "¹" | "₁" => "1",
        "²" | "₂" => "2",
        "³" | "₃" => "3",
        "₄" => "4",
        "₀" => "0",
        "½" => "h",
        "α" => "a",
        "β" => "b",
        _ => "?",
    }
}

/// The layer of a dot. Layers differ not in color alone: where dots are large, their characters differ too.
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

/// Dots that are drawn, and out of how many: dashes and dots tell the runs apart without colors.
pub type Dashes = (usize, usize);

pub const EXACT_DASHES: Dashes = (2, 4);
/// The pinned run: long dashes.
pub const PINNED_DASHES: Dashes = (5, 7);

/// The run before an edit: single dots, closer where the dots of `marker` are as large as cells.
pub fn of_run_before(marker: Marker) -> Dashes {
    match marker {
        Marker::Braille | Marker::Octant => (1, 3),
        Marker::HalfBlock | Marker::Dot | Marker::Ascii => (1, 2),
    }
}

/// The column and row of a dot; `None` outside of a sheet of this size, as for NaN.
pub fn on_sheet((x, y): (f64, f64), (width, height): (usize, usize)) -> Option<(usize, usize)> {
    let is_inside = x >= 0.0 && y >= 0.0 && x < width as f64 && y < height as f64;
    is_inside.then_some((x as usize, y as usize))
}

/// The dots of a straight line, each with its share of the way; none of a line that is far longer than a sheet of
/// `width` and `height` dots.
pub fn line(
    from: (f64, f64),
    to: (f64, f64),
    (width, height): (usize, usize),
) -> impl Iterator<Item = (f64, (f64, f64))> {
    let (dx, dy) = (to.0 - from.0, to.1 - from.1);
    let length = dx.abs().max(dy.abs()).ceil();
    let is_near = length <= 8.0 * (width + height) as f64; // NaN is not
    let dots = if is_near { length as usize + 1 } else { 0 };
    (0..dots).map(move |dot| {
        let share = dot as f64 / length.max(1.0);
        (share, (from.0 + share * dx, from.1 + share * dy))
    })
}

/// The dots of a cell in each layer, strong, faint, under and ghost.
#[derive(Clone, Copy, Debug, Default)]
struct DotCell {
    bits: [u8; 4],
    roles: [Role; 4],
}

pub struct Dots {
    area: Rect,
    marker: Marker,
    cells: Vec<DotCell>,
}

impl Dots {
    pub fn new(area: Rect, marker: Marker) -> Self {
        let cells = vec![DotCell::default(); area.width as usize * area.height as usize];
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

    pub fn width(&self) -> usize {
        self.area.width as usize * self.marker.dots().0
    }

    pub fn height(&self) -> usize {
        self.area.height as usize * self.marker.dots().1
    }

    /// The cell of the dot at column `x`, row `y`, and the dot's bit in it.
    fn cell(&mut self, x: usize, y: usize) -> Option<(&mut DotCell, u8)> {
        let (across, down) = self.marker.dots();
        let cell = y / down * self.area.width as usize + x / across;
        let bit = self.marker.bit(x % across, y % down);
        self.cells.get_mut(cell).map(|cell| (cell, bit))
    }

    /// Sets the dot at column `x`, row `y`; outside the sheet nothing happens.
    pub fn set(&mut self, x: f64, y: f64, ink: Ink) {
        let (layer, role) = match ink {
            Ink::Strong(role) => (0, role),
            Ink::Faint(role) => (1, role),
            Ink::Under(role) => (2, role),
            Ink::Ghost => (3, Role::Previous),
        };
        let dot = on_sheet((x, y), (self.width(), self.height()));
        if let Some((cell, bit)) = dot.and_then(|(column, row)| self.cell(column, row)) {
            cell.bits[layer] |= bit;
            cell.roles[layer] = role;
        }
    }

    /// Takes the dot at column `x`, row `y` away, of whatever layer.
    pub fn clear(&mut self, x: usize, y: usize) {
        if let Some((cell, bit)) = self.cell(x, y) {
            cell.bits = cell.bits.map(|bits| bits & !bit);
        }
    }

    /// Takes all dots of a cell away, in which the dot at column `x`, row `y` is.
    pub fn clear_cell(&mut self, x: usize, y: usize) {
        if let Some((cell, _)) = self.cell(x, y) {
            *cell = DotCell::default();
        }
    }

    pub fn line(&mut self, from: (f64, f64), to: (f64, f64), ink: Ink) {
        let size = (self.width(), self.height());
        for (_, (x, y)) in line(from, to, size) {
            self.set(x, y, ink);
        }
    }

    /// Sets, of the dots that `path` goes through one after the other, the first `drawn` of every `out_of`.
    pub fn dashed(
        &mut self,
        path: impl Iterator<Item = (f64, f64)>,
        (drawn, out_of): Dashes,
        ink: Ink,
    ) {
        let (mut passed, mut last) = (0, None);
        for (x, y) in path {
            let dot = (x.floor(), y.floor());
            passed += usize::from(last.replace(dot) != Some(dot));
            if passed % out_of < drawn {
                self.set(x, y, ink);
            }
        }
    }

    /// Draws the dots on the screen; cells without dots are left as they are.
    pub fn render(&self, theme: &Theme, buf: &mut Buffer) {
        for (cell, position) in self.cells.iter().zip(self.area.positions()) {
            let Some(uppermost) = cell.bits.iter().position(|bits| *bits != 0) else {
                continue;
            };
            // The exact motion is dashed: where it coincides with the run, the run is seen between its dashes.
            let is_exact = cell.bits[1] != 0 && cell.roles[1] == Role::Exact;
            let layer = if is_exact { 1 } else { uppermost };
            let (bits, role) = (cell.bits[layer], cell.roles[layer]);
            if let Some(target) = buf.cell_mut(position) {
                let sign = self.marker.sign(layer, bits);
                target.set_char(sign).set_style(theme.style(role));
            }
        }
    }
}
