//! What the mouse did.

/// What the mouse did, and at which cell of the screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Mouse {
    pub did: Did,
    /// The column, from 0.
    pub x: u16,
    /// The line, from 0.
    pub y: u16,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Did {
    /// The left button was pressed.
    Press,
    /// It was moved with the left button held.
    Drag,
    Release,
    WheelUp,
    WheelDown,
}
