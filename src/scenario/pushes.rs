//! A push, and the list of pushes that a run has at one time.

use nalgebra::Vector3;
use std::sync::Arc;

/// A force on one point for a while.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Push {
    /// Index of the pushed point.
    pub point: usize,
    /// Force, world frame, N.
    pub force: Vector3<f64>,
    pub window: Window,
    /// Whether it is the report's line taken literally: j times the force on its j-th step, and kept to the end.
    pub accumulates: bool,
}

/// When a push acts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Window {
    /// On `count` steps from step `first` on; step 1 ends at t = dt.
    Steps { first: u64, count: u64 },
    /// From one time on, for a length of time.
    Time { from_s: f64, for_s: f64 },
}

/// The pushes that a run has at one time. Edits that set no push share the list of the edit before.
pub type Pushes = Arc<Vec<Push>>;
