//! The measured data that come with the program, compiled in.

/// Measured data that come with the program.
#[derive(Clone, Copy, Debug)]
pub struct Shipped {
    /// Their name on the command line, and in messages; `presets/measured/NAME.csv` in the source.
    pub name: &'static str,
    /// The file's text.
    pub text: &'static str,
}

macro_rules! measured {
    ($($name:literal)*) => {
        &[$(Shipped {
            name: $name,
            text: include_str!(concat!("../../presets/measured/", $name, ".csv")),
        }),*]
    };
}

/// All of them.
pub const SHIPPED: &[Shipped] = measured![
    "heidelberg-body-cone"
    "heidelberg-nutation"
    "heidelberg-precession"
    "heidelberg-spin-decay"
];

/// The data of that name.
pub fn find(name: &str) -> Option<&'static Shipped> {
    SHIPPED.iter().find(|data| data.name == name)
}
