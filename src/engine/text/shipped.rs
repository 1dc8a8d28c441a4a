//! Files that are compiled into the program.

#[derive(Clone, Copy, Debug)]
pub struct Shipped {
    pub name: &'static str,
    pub text: &'static str,
}

impl Shipped {
    pub fn find(list: &'static [Self], name: &str) -> Option<&'static Self> {
        list.iter().find(|file| file.name == name)
    }
}

/// Includes the files `FOLDER/NAME.END`. The folder's path is relative to the calling file:
/// `shipped!["../../presets/lessons", "md": "first" "second"]`.
#[macro_export]
macro_rules! shipped {
    ($folder:literal, $end:literal: $($name:literal)*) => {
        &[$($crate::text::shipped::Shipped {
            name: $name,
            text: include_str!(concat!($folder, "/", $name, ".", $end)),
        }),*]
    };
}

pub use shipped;
