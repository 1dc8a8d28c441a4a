//! What the environment variables say about the terminal: whether it shows colours, and more than ASCII.

use crate::lab::view::theme::Marker;
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

#[cfg(test)]
mod tests {
    use super::*;

    /// The variables of `NAME=VALUE NAME=VALUE`.
    fn with(variables: &str) -> impl Fn(&str) -> Option<String> {
        move |wanted| {
            let mut pairs = variables.split(' ').filter_map(|pair| pair.split_once('='));
            let found = pairs.find(|(name, _)| *name == wanted);
            found.map(|(_, value)| value.to_owned())
        }
    }

    #[test]
    fn the_locale_decides_on_ascii() {
        for (variables, wanted) in [
            ("LANG=de_DE.UTF-8 TERM=xterm", Marker::Braille),
            ("LANG=de_DE.UTF-8 LC_ALL=C", Marker::Ascii),
            ("LC_ALL= LANG=C.utf8", Marker::Braille),
            ("LANG=C.UTF-8 TERM=linux", Marker::HalfBlock),
            ("", Marker::Ascii),
        ] {
            assert_eq!(marker(with(variables)), wanted, "{variables:?}");
        }
    }

    #[test]
    fn no_color_is_honoured_unless_colour_is_asked_for() {
        for (variables, choice, wanted) in [
            ("NO_COLOR=1 TERM=xterm", ColourChoice::Auto, false),
            ("NO_COLOR=1 TERM=xterm", ColourChoice::Always, true),
            ("NO_COLOR= TERM=xterm", ColourChoice::Auto, true),
            ("NO_COLOR= TERM=xterm", ColourChoice::Never, false),
        ] {
            let colour = theme(choice, with(variables)).colour;
            assert_eq!(colour, wanted, "{variables:?} {choice:?}");
        }
    }
}
