//! The lessons that come with the program, compiled in.

use crate::engine::text::shipped::{Shipped, shipped};

/// All lessons, by level, in an order in which they build on each other.
pub const LESSONS: &[Shipped] = shipped!["../../presets/lessons", "md":
    "why-it-does-not-fall"
    "what-holds-the-weight-up"
    "does-a-faster-spin-precess-faster"
    "the-wheel-one-carries"
    "why-it-seems-to-stand-still"
    "one-step-by-hand"
    "method-1-and-its-z"
    "method-2-and-its-straight-line"
    "is-the-wobble-real"
    "cusps-loops-and-waves"
    "does-steeper-precess-faster"
    "halve-the-step"
    "write-it-yourself"
    "which-way-does-your-phone-tumble"
    "the-sleeping-top-wakes"
    "kappa-and-the-scheme"
    "what-is-conserved"
    "a-real-gyroscope"
];

pub fn find(name: &str) -> Option<&'static Shipped> {
    Shipped::find(LESSONS, name)
}

/// Returns the program frame that a lesson asks for, in Python or else in a file for both Octave and MATLAB.
pub fn frame(lesson: &str, language: &str) -> Option<&'static str> {
    let frame = match language {
        "python" => include_str!("../../presets/frames/write-it-yourself.py"),
        _ => include_str!("../../presets/frames/write-it-yourself.m"),
    };
    (lesson == "write-it-yourself").then_some(frame)
}

/// A small lesson with a comment on each part, as a template for new lessons.
pub const TEMPLATE: &str = include_str!("template.md");
