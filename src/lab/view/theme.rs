//! The user's choice of markers and colors. The characters and colors themselves are in `tui`.

/// The characters with which dots are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Marker {
    /// Two by four dots per cell.
    Braille,
    /// Two by four dots per cell, without gaps (Unicode 16). Few fonts have these characters.
    Octant,
    /// Two half cells, one above the other.
    HalfBlock,
    /// One round dot per cell.
    Dot,
    /// One ASCII character per cell. Texts and borders are ASCII too.
    Ascii,
}

impl Marker {
    /// All markers, in the order of the settings dialog.
    pub const ALL: [Self; 5] = [
        Self::Braille,
        Self::Octant,
        Self::HalfBlock,
        Self::Dot,
        Self::Ascii,
    ];

    /// Returns true if a terminal that can show `other` can show this marker too.
    ///
    /// Octants need the most, then Braille, then half blocks and points, then ASCII.
    pub fn needs_no_more_than(self, other: Self) -> bool {
        self.need() <= other.need()
    }

    fn need(self) -> u8 {
        match self {
            Self::Octant => 3,
            Self::Braille => 2,
            Self::HalfBlock | Self::Dot => 1,
            Self::Ascii => 0,
        }
    }

    pub fn name(self) -> &'static str {
        match self {
            Self::Braille => "braille",
            Self::Octant => "octant",
            Self::HalfBlock => "half-block",
            Self::Dot => "dot",
            Self::Ascii => "ascii",
        }
    }

    /// Returns a wave drawn with the marker. It shows whether the terminal's font has the characters.
    pub fn preview(self) -> &'static str {
        match self {
            Self::Braille => "⠔⠉⠑⢄⣀⠤",
            Self::Octant => "𜴐🮂𜴄𜶀▂𜴧",
            Self::HalfBlock => "█▀▀▄▄▄",
            Self::Dot => "••••••",
            Self::Ascii => "**..**",
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Background {
    Dark,
    Light,
}

impl Background {
    pub const ALL: [Self; 2] = [Self::Dark, Self::Light];

    pub fn name(self) -> &'static str {
        match self {
            Self::Dark => "dark",
            Self::Light => "light",
        }
    }
}

/// The number of colors of a screen, in ascending order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Palette {
    /// No color: roles differ by bold, faint, underline and reverse video.
    Plain,
    /// The 16 colors that every color terminal has.
    Ansi16,
    /// The 256 colors of xterm.
    Xterm256,
    /// 24 bits.
    TrueColor,
}

impl Palette {
    pub const ALL: [Self; 4] = [Self::Plain, Self::Ansi16, Self::Xterm256, Self::TrueColor];

    /// Returns its name in `--color` and in the settings.
    pub fn name(self) -> &'static str {
        match self {
            Self::Plain => "never",
            Self::Ansi16 => "16",
            Self::Xterm256 => "256",
            Self::TrueColor => "truecolor",
        }
    }
}

/// The colors of the lab.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Theme {
    pub palette: Palette,
    pub background: Background,
}

impl Theme {
    pub const PLAIN: Self = Self {
        palette: Palette::Plain,
        background: Background::Dark,
    };
}
