//! The lessons that come with the program, compiled in.

use crate::engine::text::shipped::{Shipped, shipped};

/// Every lesson, in the order in which they build on each other.
pub const LESSONS: &[Shipped] = shipped!["../../presets/lessons", "md":
    "why-it-does-not-fall"
    "what-holds-the-weight-up"
    "one-step-by-hand"
    "write-it-yourself"
    "method-1-and-its-z"
    "method-2-and-its-straight-line"
    "why-it-seems-to-stand-still"
    "is-the-wobble-real"
    "does-a-faster-spin-precess-faster"
    "does-steeper-precess-faster"
    "cusps-loops-and-waves"
    "the-sleeping-top-wakes"
    "kappa-and-the-scheme"
    "what-is-conserved"
    "halve-the-step"
    "the-wheel-one-carries"
    "which-way-does-your-phone-tumble"
    "a-real-gyroscope"
];

pub fn find(name: &str) -> Option<&'static Shipped> {
    Shipped::find(LESSONS, name)
}

/// Returns the frame of the program that a lesson asks for: what is written is the same in Octave and in MATLAB.
pub fn frame(lesson: &str, language: &str) -> Option<&'static str> {
    let frame = match language {
        "python" => include_str!("../../presets/frames/write-it-yourself.py"),
        _ => include_str!("../../presets/frames/write-it-yourself.m"),
    };
    (lesson == "write-it-yourself").then_some(frame)
}

/// A small lesson with a comment on each part, to begin one's own from.
pub const TEMPLATE: &str = include_str!("template.md");
