//! The lessons that come with the program, compiled in.

/// A lesson that comes with the program.
#[derive(Clone, Copy, Debug)]
pub struct Shipped {
    /// Its name on the command line; `presets/lessons/NAME.md` in the source.
    pub name: &'static str,
    /// The file's text.
    pub text: &'static str,
}

macro_rules! lessons {
    ($($name:literal)*) => {
        &[$(Shipped {
            name: $name,
            text: include_str!(concat!("../../presets/lessons/", $name, ".md")),
        }),*]
    };
}

/// Every lesson, in the order in which they build on each other.
pub const LESSONS: &[Shipped] = lessons![
    "why-it-does-not-fall"
    "one-step-by-hand"
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
    "two-roads-and-a-poor-fit"
];

/// The lesson of that name.
pub fn find(name: &str) -> Option<&'static Shipped> {
    LESSONS.iter().find(|lesson| lesson.name == name)
}

/// A small lesson with a comment on each part, to begin one's own from.
pub const TEMPLATE: &str = include_str!("template.md");
