//! The measured data that come with the program, compiled in.

use crate::text::shipped::{Shipped, shipped};

/// All of them.
pub const SHIPPED: &[Shipped] = shipped!["measured", "csv":
    "heidelberg-body-cone"
    "heidelberg-nutation"
    "heidelberg-precession"
    "heidelberg-spin-decay"
];

/// The data of that name.
pub fn find(name: &str) -> Option<&'static Shipped> {
    Shipped::find(SHIPPED, name)
}
