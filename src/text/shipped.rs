//! Files that come with the program, compiled in.

/// A file that comes with the program.
#[derive(Clone, Copy, Debug)]
pub struct Shipped {
    /// Its name on the command line, and in messages.
    pub name: &'static str,
    /// The file's text.
    pub text: &'static str,
}

impl Shipped {
    /// The file of that name in `list`.
    pub fn find(list: &'static [Self], name: &str) -> Option<&'static Self> {
        list.iter().find(|file| file.name == name)
    }
}

/// The files `presets/FOLDER/NAME.END` of the source: `shipped!["lessons", "md": "first" "second"]`.
macro_rules! shipped {
    ($folder:literal, $end:literal: $($name:literal)*) => {
        &[$($crate::text::shipped::Shipped {
            name: $name,
            text: include_str!(concat!(
                env!("CARGO_MANIFEST_DIR"), "/presets/", $folder, "/", $name, ".", $end
            )),
        }),*]
    };
}

pub(crate) use shipped;
