//! The sweeps that come with the program, compiled in.

use crate::text::shipped::{Shipped, shipped};

pub const SWEEPS: &[Shipped] = shipped!["sweeps", "toml":
    "wobble-over-time-step"
    "precession-over-momentum"
    "precession-over-tilt"
];

pub fn find(name: &str) -> Option<&'static Shipped> {
    Shipped::find(SWEEPS, name)
}
