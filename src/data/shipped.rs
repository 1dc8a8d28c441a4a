//! The measured data that come with the program, compiled in.

use crate::text::shipped::{Shipped, shipped};

pub const SHIPPED: &[Shipped] = shipped!["measured", "csv":
    "heidelberg-body-cone"
    "heidelberg-nutation"
    "heidelberg-precession"
    "heidelberg-spin-decay"
];

pub fn find(name: &str) -> Option<&'static Shipped> {
    Shipped::find(SHIPPED, name)
}
