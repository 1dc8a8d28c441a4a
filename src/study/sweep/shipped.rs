//! The sweeps that come with the program, compiled in.

/// A sweep that comes with the program.
#[derive(Clone, Copy, Debug)]
pub struct Shipped {
    /// Its name on the command line; `presets/sweeps/NAME.toml` in the source.
    pub name: &'static str,
    /// The file's text.
    pub text: &'static str,
}

macro_rules! sweeps {
    ($($name:literal)*) => {
        &[$(Shipped {
            name: $name,
            text: include_str!(concat!("../../../presets/sweeps/", $name, ".toml")),
        }),*]
    };
}

/// Every sweep.
pub const SWEEPS: &[Shipped] = sweeps![
    "wobble-over-time-step"
    "precession-over-momentum"
    "precession-over-tilt"
];

/// The sweep of that name.
pub fn find(name: &str) -> Option<&'static Shipped> {
    SWEEPS.iter().find(|sweep| sweep.name == name)
}
