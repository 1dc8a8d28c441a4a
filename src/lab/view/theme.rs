//! The user's choice of dots and colours. `tui` has the dots and colours themselves.

/// The kinds of dots.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Marker {
    /// Two by four dots in a cell.
    Braille,
    /// Two halves of a cell, one above the other.
    HalfBlock,
    /// One round point in a cell.
    Dot,
    /// One ASCII character in a cell; texts and borders are ASCII then too.
    Ascii,
}

impl Marker {
    /// Every marker, in the order in which the settings go through them.
    pub const ALL: [Self; 4] = [Self::Braille, Self::HalfBlock, Self::Dot, Self::Ascii];

    /// Whether a terminal can show it that can show `other`: Braille needs most, then half blocks and points, then ASCII.
    pub fn needs_no_more_than(self, other: Self) -> bool {
        self.need() <= other.need()
    }

    fn need(self) -> u8 {
        match self {
            Self::Braille => 2,
            Self::HalfBlock | Self::Dot => 1,
            Self::Ascii => 0,
        }
    }

    pub fn name(self) -> &'static str {
        match self {
            Self::Braille => "braille",
            Self::HalfBlock => "half-block",
            Self::Dot => "dot",
            Self::Ascii => "ascii",
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Background {
    Dark,
    Light,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Theme {
    pub colour: bool,
    pub background: Background,
}

impl Background {
    pub fn name(self) -> &'static str {
        match self {
            Self::Dark => "dark",
            Self::Light => "light",
        }
    }
}

impl Theme {
    pub const PLAIN: Self = Self {
        colour: false,
        background: Background::Dark,
    };
}
