//! The shipped presets, compiled in.

/// A scenario that comes with the program.
#[derive(Clone, Copy, Debug)]
pub struct Preset {
    /// Its name on the command line; `presets/NAME.toml` in the source.
    pub name: &'static str,
    /// The file's text.
    pub text: &'static str,
}

macro_rules! presets {
    ($($name:literal)*) => {
        &[$(Preset { name: $name, text: include_str!(concat!("../../presets/", $name, ".toml")) }),*]
    };
}

/// Every preset: the report's first, in the report's order, then the textbook's.
pub const PRESETS: &[Preset] = presets![
    "method-1" "method-1-steeper" "method-2-slow" "method-2" "wobble-push" "wobble-push-accumulating"
    "fast-top" "cusps" "loops" "waves" "steady-slow" "steady-fast" "sleeping" "sleeping-unstable" "falling"
    "torque-free"
];

/// The preset of that name.
pub fn find(name: &str) -> Option<&'static Preset> {
    PRESETS.iter().find(|preset| preset.name == name)
}
