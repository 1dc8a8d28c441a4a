//! The value of a key that a fit has found, with its uncertainties.

use super::free::Free;

#[derive(Clone, Debug)]
pub struct Fitted {
    /// The key, where the search began, and its bounds.
    pub free: Free,
    pub value: f64,
    /// One standard uncertainty of it, of two sides the larger one; `None` where it cannot be stated.
    pub sigma: Option<f64>,
    /// The uncertainties to both sides, which differ where a limit of nature holds the key.
    pub sides: Option<Sides>,
    /// Whether it is held at a bound, beyond which the fit would be better.
    pub is_held: bool,
}

/// How far below and above its value a key may be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sides {
    pub below: f64,
    pub above: f64,
}
