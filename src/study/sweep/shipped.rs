//! The sweeps that come with the program, compiled in.

use crate::text::shipped::{Shipped, shipped};

/// Every sweep.
pub const SWEEPS: &[Shipped] = shipped!["sweeps", "toml":
    "wobble-over-time-step"
    "precession-over-momentum"
    "precession-over-tilt"
];

/// The sweep of that name.
pub fn find(name: &str) -> Option<&'static Shipped> {
    Shipped::find(SWEEPS, name)
}
