//! What the environment variables say about the terminal: whether it shows colours, and more than ASCII.

use crate::lab::view::markers::Marker;
use crate::lab::view::theme::{Background, Theme};

/// When the lab uses colours.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ColourChoice {
    /// Unless NO_COLOR is set or the terminal has none.
    #[default]
    Auto,
    Always,
    Never,
}

/// The dots for these environment variables: ASCII where the locale is not UTF-8, half blocks on the Linux console,
/// whose fonts have no Braille, else Braille.
pub fn marker(variable: impl Fn(&str) -> Option<String>) -> Marker {
    let locale = ["LC_ALL", "LC_CTYPE", "LANG"]
        .into_iter()
        .filter_map(&variable)
        .find(|value| !value.is_empty());
    let is_utf8 = locale.is_some_and(|locale| {
        let locale = locale.to_lowercase();
        locale.contains("utf-8") || locale.contains("utf8")
    });
    match (is_utf8, variable("TERM").as_deref()) {
        (false, _) | (_, Some("dumb")) => Marker::Ascii,
        (true, Some("linux")) => Marker::HalfBlock,
        (true, _) => Marker::Braille,
    }
}

/// Whether these environment variables refuse colours (<https://no-color.org>).
pub fn refuses_colour(variable: impl Fn(&str) -> Option<String>) -> bool {
    variable("NO_COLOR").is_some_and(|value| !value.is_empty())
}

/// The theme for `choice` and these environment variables (<https://no-color.org>; COLORFGBG as rxvt sets it).
pub fn theme(choice: ColourChoice, variable: impl Fn(&str) -> Option<String>) -> Theme {
    let refused = refuses_colour(&variable);
    let has_none = variable("TERM").is_none_or(|term| term == "dumb" || term.starts_with("vt"));
    let colour = match choice {
        ColourChoice::Auto => !refused && !has_none,
        ColourChoice::Always => true,
        ColourChoice::Never => false,
    };
    let light = variable("COLORFGBG")
        .is_some_and(|value| matches!(value.rsplit(';').next(), Some("7" | "15")));
    Theme {
        colour,
        background: if light {
            Background::Light
        } else {
            Background::Dark
        },
    }
}
