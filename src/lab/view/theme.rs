//! The user's choice of colours. `tui` has the colours themselves.

/// The kind of screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Background {
    /// Light text on a dark screen.
    Dark,
    /// Dark text on a light screen.
    Light,
}

/// The choice of colours.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Theme {
    /// Whether there are colours at all.
    pub colour: bool,
    /// What kind of screen they are for.
    pub background: Background,
}

impl Background {
    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Dark => "dark",
            Self::Light => "light",
        }
    }
}

impl Theme {
    /// What `--color` takes for it.
    pub fn colour_choice(&self) -> &'static str {
        if self.colour { "always" } else { "never" }
    }
}
