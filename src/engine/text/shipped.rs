//! Files that come with the program, compiled in.

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

/// The files `FOLDER/NAME.END`, with the folder's path from the file that calls it:
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
