//! A fitted key: its value and uncertainties.

use super::free::Free;

#[derive(Clone, Debug)]
pub struct Fitted {
    /// The key, its start value and its bounds.
    pub free: Free,
    pub value: f64,
    /// One standard uncertainty, the larger one of the two sides; `None` if it cannot be stated.
    pub sigma: Option<f64>,
    /// The uncertainties on both sides. They differ if a physical limit holds the key.
    pub sides: Option<Sides>,
    /// True if the key is at a bound and the fit would be better beyond it.
    pub is_held: bool,
}

/// Uncertainties below and above the value of a key, in its unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sides {
    pub below: f64,
    pub above: f64,
}
