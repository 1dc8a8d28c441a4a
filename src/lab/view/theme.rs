//! Which colours the user has chosen. What each of them colours is the terminal's affair.

/// What lies behind the text.
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
