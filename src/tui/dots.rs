//! Dots of a marker: how many fit in a cell of the screen, which characters show them, and the dots of a line.

use crate::lab::view::theme::Marker;
use ratatui::symbols::pixel::OCTANTS;

impl Marker {
    /// Returns the dots per cell, across and down.
    pub fn dots(self) -> (usize, usize) {
        match self {
            Self::Braille | Self::Octant => (2, 4),
            Self::HalfBlock => (1, 2),
            Self::Dot | Self::Ascii => (1, 1),
        }
    }

    /// Returns the width of one dot divided by its height, for cells twice as high as wide.
    pub fn dot_aspect(self) -> f64 {
        let (across, down) = self.dots();
        0.5 * down as f64 / across as f64
    }

    /// Returns the bit of the dot at `x`, `y` in its cell.
    pub fn bit(self, x: usize, y: usize) -> u8 {
        /// Bits of the Braille patterns by row, left and right column (Unicode, block U+2800).
        const BRAILLE: [[u8; 2]; 4] = [[0x01, 0x08], [0x02, 0x10], [0x04, 0x20], [0x40, 0x80]];
        match self {
            Self::Braille => BRAILLE[y % 4][x % 2],
            Self::Octant => 1 << (2 * (y % 4) + x % 2),
            _ => 1 << (y % 2),
        }
    }

    /// Returns the character of a cell with these `bits` in a layer: 0 strong, 1 faint, 2 dashed, 3 ghost.
    pub(super) fn sign(self, layer: usize, bits: u8) -> char {
        match (self, layer) {
            (Self::Braille, _) => char::from_u32(0x2800 + u32::from(bits)).unwrap_or(' '),
            (Self::Octant, _) => OCTANTS[usize::from(bits)],
            (Self::HalfBlock, 0) => half_block(bits),
            (Self::Dot, 0) => '•',
            (Self::Ascii, 0) => '*',
            (Self::Ascii, 1) => '.',
            (Self::Ascii, 2) => '-',
            (Self::Ascii, _) => ',',
            (_, 1) => '·',
            (_, 2) => '╌',
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

/// Returns the substitute for `symbol` on the Linux console, whose fonts have the 256 characters of the old PC. Returns
/// `None` if they have `symbol`.
pub fn on_console(symbol: &str) -> Option<&'static str> {
    Some(match symbol {
        "━" => "═",
        "╴" | "╌" => "─",
        "┃" | "▏" | "▕" => "│",
        "◊" => "♦",
        "−" => "-",
        "³" => "3",
        _ => return None,
    })
}

/// Returns an ASCII substitute of the same width for `symbol`, for terminals whose locale is not UTF-8.
pub fn ascii(symbol: &str) -> &'static str {
    match symbol {
        "─" | "╴" | "╌" => "-",
        "▕" | "▏" => "|",
        "◊" => "+",
        "↑" => "^",
        "↓" => "v",
        "±" => "~",
        "█" | "▀" | "■" | "┃" | "┏" | "┓" | "┗" | "┛" => "#",
        "│" => "|",
        "┌" | "┐" | "└" | "┘" | "├" | "┤" => "+",
        "×" => "x",
        "═" | "━" => "=",
        "°" => ",",
        "▲" => "^",
        "▼" => "v",
        "…" | "·" | "•" => ".",
        "►" | "→" => ">",
        "◄" | "←" => "<",
        "Ω" => "W",
        "τ" => "T",
        "–" | "—" | "−" | "⁻" => "-",
        // Symbols in the formulas of a time step.
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

/// Dots drawn per period, and the period in dots. Dashes and dots distinguish the runs without colors.
pub type Dashes = (usize, usize);

pub const EXACT_DASHES: Dashes = (4, 8);
/// The pinned run: long dashes.
pub const PINNED_DASHES: Dashes = (5, 7);
/// The previous run: single dots.
pub const PREVIOUS_DASHES: Dashes = (1, 3);

/// Returns the column and row of a dot. Returns `None` outside a sheet of this size, and for NaN.
pub fn on_sheet((x, y): (f64, f64), (width, height): (usize, usize)) -> Option<(usize, usize)> {
    let is_inside = x >= 0.0 && y >= 0.0 && x < width as f64 && y < height as f64;
    is_inside.then_some((x as usize, y as usize))
}

/// Returns the dots of a straight line, each with its fraction of the length.
///
/// Returns none if the line is far longer than a sheet of `width` and `height` dots.
pub fn line(
    from: (f64, f64),
    to: (f64, f64),
    (width, height): (usize, usize),
) -> impl Iterator<Item = (f64, (f64, f64))> {
    let (dx, dy) = (to.0 - from.0, to.1 - from.1);
    let length = dx.abs().max(dy.abs()).ceil();
    let is_near = length <= 8.0 * (width + height) as f64; // false for NaN
    let dots = if is_near { length as usize + 1 } else { 0 };
    (0..dots).map(move |dot| {
        let share = dot as f64 / length.max(1.0);
        (share, (from.0 + share * dx, from.1 + share * dy))
    })
}
