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
