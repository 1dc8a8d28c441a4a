//! The colour of each role, from the 16 colours that every terminal has, and two of the 256 for a light screen.
//!
//! People with any kind of colour vision can tell x, y and z apart: cyan, yellow and magenta differ in brightness as well as
//! in hue, and so do blue, red and dark cyan on a light screen. No meaning depends on colour alone: each curve has its
//! letter, and without colours the roles differ by bold, dim and reversed. What the environment variables say of colours
//! and dots is read here.

use crate::lab::view::theme::Marker;
use crate::lab::view::theme::{Background, Theme};
use ratatui::style::{Color, Modifier, Style};

/// #008787 and #008700 of the 256 colours.
pub(super) const DARK_CYAN: u8 = 30;
pub(super) const DARK_GREEN: u8 = 28;

/// The role of a piece of the screen, which decides its style.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Role {
    #[default]
    Text,
    /// Units, labels and borders, less prominent than values.
    Quiet,
    Heading,
    X,
    Y,
    Z,
    /// Tilt, and the path of the last turn.
    Path,
    /// The path of the last swings.
    Recent,
    /// The path before the last turn.
    Old,
    /// The path of the last turn in space, where it must be told from the body.
    Track,
    /// The path before that in space.
    OldTrack,
    Exact,
    Ghost,
    Pinned,
    Measured,
    Push,
    Focus,
    Selected,
    Warning,
}

impl Theme {
    pub fn style(&self, role: Role) -> Style {
        let style = Style::new().add_modifier(modifier(role));
        if self.colour {
            style.fg(colour(role, self.background))
        } else {
            style
        }
    }
}

fn modifier(role: Role) -> Modifier {
    match role {
        Role::Heading
        | Role::Focus
        | Role::Push
        | Role::Warning
        | Role::Recent
        | Role::Measured => Modifier::BOLD,
        Role::Quiet | Role::Ghost | Role::Old | Role::OldTrack => Modifier::DIM,
        Role::Selected => Modifier::REVERSED,
        _ => Modifier::empty(),
    }
}

fn colour(role: Role, background: Background) -> Color {
    let (on_dark, on_light) = match role {
        Role::X => (Color::Cyan, Color::Blue),
        Role::Y => (Color::Yellow, Color::Red),
        // Cyan and green are too pale on a light screen, and the 16 colours have no darker ones.
        Role::Z => (Color::Magenta, Color::Indexed(DARK_CYAN)),
        // No curve, push or warning has the colour of the exact motion.
        Role::Exact => (Color::LightRed, Color::Magenta),
        Role::Warning => (Color::LightYellow, Color::Red),
        Role::Push => (Color::Green, Color::Indexed(DARK_GREEN)),
        Role::Focus | Role::Track | Role::OldTrack => (Color::LightBlue, Color::Blue),
        _ => (Color::Reset, Color::Reset),
    };
    match background {
        Background::Dark => on_dark,
        Background::Light => on_light,
    }
}

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
        let lower = locale.to_lowercase();
        lower.contains("utf-8") || lower.contains("utf8")
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
    use Role::*;

    #[test]
    fn every_colour_is_seen_on_white() {
        /// What xterm has for the colours that are used, and the two that every terminal has.
        fn rgb(colour: Color) -> Option<[u8; 3]> {
            match colour {
                Color::Reset => None,
                Color::Red => Some([205, 0, 0]),
                Color::Green => Some([0, 205, 0]),
                Color::Blue => Some([0, 0, 238]),
                Color::Magenta => Some([205, 0, 205]),
                Color::Cyan => Some([0, 205, 205]),
                Color::Indexed(DARK_CYAN) => Some([0, 135, 135]),
                Color::Indexed(DARK_GREEN) => Some([0, 135, 0]),
                other => panic!("{other:?} is not known here"),
            }
        }
        // Contrast as WCAG 2 defines it, from the luminance of sRGB.
        let contrast = |rgb: [u8; 3]| {
            let linear = rgb.map(|part| {
                let part = f64::from(part) / 255.0;
                if part <= 0.04045 {
                    part / 12.92
                } else {
                    libm::pow((part + 0.055) / 1.055, 2.4)
                }
            });
            1.05 / (0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2] + 0.05)
        };
        for role in [X, Y, Z, Exact, Warning, Push, Focus, Track, OldTrack] {
            let colour = colour(role, Background::Light);
            let contrast = rgb(colour).map_or(21.0, contrast);
            assert!(contrast >= 3.0, "{role:?}: {contrast}");
        }
    }
}
