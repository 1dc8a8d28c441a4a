//! The kinds of dots: how many fit in a cell of the screen, and which characters show them.

use crate::lab::view::markers::Marker;

impl Marker {
    /// Dots in a cell, across and down.
    pub fn dots(self) -> (usize, usize) {
        match self {
            Self::Braille => (2, 4),
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
            _ => 1 << (y % 2),
        }
    }

    /// The character of a cell with these `bits` of the run's own motion.
    pub fn strong(self, bits: u8) -> char {
        match self {
            Self::Braille => braille(bits),
            Self::HalfBlock => half_block(bits),
            Self::Dot => '•',
            Self::Ascii => '*',
        }
    }

    /// The character of a cell with these `bits` of the layer under it: the exact motion, axes, the previous sweep.
    pub fn faint(self, bits: u8) -> char {
        match self {
            Self::Braille => braille(bits),
            Self::HalfBlock | Self::Dot => '·',
            Self::Ascii => '.',
        }
    }

    /// The character of a cell with these `bits` of the previous run, the lowest layer.
    pub fn ghost(self, bits: u8) -> char {
        match self {
            Self::Braille => braille(bits),
            Self::HalfBlock | Self::Dot => '°',
            Self::Ascii => ',',
        }
    }
}

fn braille(bits: u8) -> char {
    char::from_u32(0x2800 + u32::from(bits)).unwrap_or(' ')
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
        "─" => "-",
        "█" | "▀" | "━" | "┃" | "┏" | "┓" | "┗" | "┛" => "#",
        "…" => ".",
        "│" => "|",
        "┌" | "┐" | "└" | "┘" | "├" | "┤" => "+",
        "×" => "x",
        "═" => "=",
        "°" => ",",
        "▲" => "^",
        "▼" => "v",
        "·" | "•" => ".",
        "■" => "#",
        "►" => ">",
        "◄" => "<",
        "Ω" => "W",
        "τ" => "T",
        "–" | "—" | "−" | "⁻" => "-",
        // Of the formulas of a time step.
        "Σ" => "S",
        "Δ" => "D",
        "←" => "<",
        "→" => ">",
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
