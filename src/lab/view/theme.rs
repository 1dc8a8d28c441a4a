//! The user's choice of colours. `tui` has the colours themselves.

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Background {
    /// Light text on a dark screen.
    Dark,
    /// Dark text on a light screen.
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
    /// No colours.
    pub const PLAIN: Self = Self {
        colour: false,
        background: Background::Dark,
    };
}
