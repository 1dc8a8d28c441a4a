//! The style of each role on the screen, in four palettes and for two backgrounds.
//!
//! The run is blue and the exact motion is orange in every pane. Text and axes have no hue, so that curves are
//! prominent. No meaning depends on hue alone: the exact motion is dashed, arrows have letters, a value that disagrees
//! is bold, and the verdict has words. The environment variables for colors and markers are read here.

use crate::lab::view::theme::Marker;
use crate::lab::view::theme::{Background, Palette, Theme};
use ratatui::style::{Color, Modifier, Style};

/// Role of an element on the screen, which decides its style.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Role {
    #[default]
    Text,
    /// Units, ticks, and words less prominent than values.
    Label,
    /// The line above a pane, and axes.
    Rule,
    /// Titles and keys.
    Heading,
    /// The run, in the window of the traces.
    Run,
    /// The run before that window.
    RunEarlier,
    /// Envelope between minimum and maximum of swings that are too fast to draw one by one.
    Fill,
    /// The background of the window in the overview.
    WindowTint,
    Exact,
    /// The previous run and the pinned run.
    Previous,
    Measured,
    /// First word of the verdict if the run needs attention.
    Badge,
    /// A value that disagrees with the exact motion, and warnings.
    Off,
    AngularMomentum,
    AngularVelocity,
    Torque,
    RimNear,
    RimFar,
    Floor,
    /// The cursor and the displayed time.
    Cursor,
    Push,
    /// A value that can be edited.
    Editable,
    /// The selected row, and the title of the pane in focus.
    Selected,
}

/// A color in each palette.
struct Shades {
    ansi: Color,
    xterm: u8,
    rgb: u32,
}

const fn shades(ansi: Color, xterm: u8, rgb: u32) -> Shades {
    Shades { ansi, xterm, rgb }
}

impl Shades {
    fn color(&self, palette: Palette) -> Color {
        match palette {
            Palette::Plain => Color::Reset,
            Palette::Ansi16 => self.ansi,
            Palette::Xterm256 => Color::Indexed(self.xterm),
            Palette::TrueColor => Color::from_u32(self.rgb),
        }
    }
}

impl Theme {
    pub fn style(&self, role: Role) -> Style {
        let style = Style::new().add_modifier(self.modifier(role));
        if self.palette == Palette::Plain {
            return style;
        }
        let ink = ink(role, self.background).map(|shades| shades.color(self.palette));
        let ground = ground(role, self.background).map(|shades| shades.color(self.palette));
        Style {
            // Text has the terminal's own color, so that it is legible even on an unexpected background.
            fg: (role != Role::WindowTint).then_some(ink.unwrap_or_default()),
            bg: ground,
            ..style
        }
    }

    fn modifier(&self, role: Role) -> Modifier {
        let is_plain = self.palette == Palette::Plain;
        match role {
            Role::Heading | Role::Off | Role::Push => Modifier::BOLD,
            Role::Badge if is_plain => Modifier::BOLD | Modifier::REVERSED,
            Role::Badge => Modifier::BOLD,
            Role::Cursor | Role::Measured if is_plain => Modifier::BOLD,
            Role::Selected => Modifier::BOLD | Modifier::REVERSED,
            Role::Editable => Modifier::UNDERLINED,
            // The 16 colors have one gray, which is used for rules.
            Role::Label if is_plain || self.palette == Palette::Ansi16 => Modifier::DIM,
            Role::Rule
            | Role::RunEarlier
            | Role::Fill
            | Role::Previous
            | Role::RimFar
            | Role::Floor
                if is_plain =>
            {
                Modifier::DIM
            }
            _ => Modifier::empty(),
        }
    }
}

/// Returns the color of letters, lines and dots of `role`; `None` is the terminal's own.
fn ink(role: Role, background: Background) -> Option<Shades> {
    let (on_dark, on_light) = match role {
        Role::Text
        | Role::Heading
        | Role::Push
        | Role::Editable
        | Role::Selected
        | Role::WindowTint => return None,
        Role::Label => (
            shades(Color::Reset, 246, 0x969aa2),
            shades(Color::Reset, 241, 0x63676e),
        ),
        Role::Rule => (
            shades(Color::DarkGray, 240, 0x555b66),
            shades(Color::Gray, 250, 0xb4b8bf),
        ),
        Role::Run => (
            shades(Color::LightBlue, 75, 0x6cb6ff),
            shades(Color::Blue, 25, 0x0b62b8),
        ),
        Role::RunEarlier => (
            shades(Color::Blue, 24, 0x34618f),
            shades(Color::LightBlue, 110, 0x93c0ea),
        ),
        Role::Fill => (
            shades(Color::Blue, 23, 0x2a4767),
            shades(Color::LightBlue, 189, 0xcfe3f6),
        ),
        Role::Exact => (
            shades(Color::LightRed, 209, 0xff8f5a),
            shades(Color::Red, 166, 0xcf4a06),
        ),
        Role::Previous => (
            shades(Color::DarkGray, 245, 0x8d9096),
            shades(Color::DarkGray, 246, 0x94979c),
        ),
        Role::Badge => (
            shades(Color::Black, 16, 0x17181a),
            shades(Color::Black, 16, 0x17181a),
        ),
        Role::Off => (
            shades(Color::LightYellow, 221, 0xf2c94c),
            shades(Color::Black, 16, 0x000000),
        ),
        Role::AngularMomentum => (
            shades(Color::LightMagenta, 169, 0xe765cf),
            shades(Color::Magenta, 90, 0x861493),
        ),
        Role::AngularVelocity => (
            shades(Color::LightGreen, 156, 0xa5f194),
            shades(Color::Green, 65, 0x4d7f34),
        ),
        Role::Torque => (
            shades(Color::LightCyan, 81, 0x58e9fe),
            shades(Color::Cyan, 23, 0x2a5c66),
        ),
        Role::RimNear => (
            shades(Color::Gray, 250, 0xb4b8c0),
            shades(Color::Black, 240, 0x55585e),
        ),
        Role::RimFar => (
            shades(Color::DarkGray, 243, 0x6f747e),
            shades(Color::DarkGray, 248, 0xa4a8af),
        ),
        Role::Floor => (
            shades(Color::DarkGray, 241, 0x5a606b),
            shades(Color::Gray, 249, 0xb0b4bb),
        ),
        Role::Cursor | Role::Measured => (
            shades(Color::White, 231, 0xffffff),
            shades(Color::Black, 16, 0x000000),
        ),
    };
    Some(match background {
        Background::Dark => on_dark,
        Background::Light => on_light,
    })
}

/// Returns the background of `role`, if it has its own.
fn ground(role: Role, background: Background) -> Option<Shades> {
    match (role, background) {
        (Role::Badge, _) => Some(shades(Color::Yellow, 221, 0xf2c94c)),
        (Role::Off, Background::Light) => Some(shades(Color::Yellow, 223, 0xfbe6a0)),
        // The 16 colors have no tint: there, the edges mark the window.
        (Role::WindowTint, Background::Dark) => Some(shades(Color::Reset, 236, 0x262b33)),
        (Role::WindowTint, Background::Light) => Some(shades(Color::Reset, 255, 0xeaf1fa)),
        _ => None,
    }
}

/// Colors requested by the user.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ColorChoice {
    /// Colors, unless NO_COLOR is set or the terminal has none.
    #[default]
    Auto,
    Always,
    Never,
    Palette(Palette),
}

impl ColorChoice {
    pub const ALL: [Self; 6] = [
        Self::Auto,
        Self::Always,
        Self::Never,
        Self::Palette(Palette::Ansi16),
        Self::Palette(Palette::Xterm256),
        Self::Palette(Palette::TrueColor),
    ];

    pub fn name(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::Always => "always",
            Self::Never => Palette::Plain.name(),
            Self::Palette(palette) => palette.name(),
        }
    }
}

/// Returns the marker for these environment variables: ASCII if the locale is not UTF-8, half blocks on the Linux
/// console (its fonts have no Braille), else Braille.
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

/// Returns true if these environment variables disable colors (<https://no-color.org>).
pub fn refuses_color(variable: impl Fn(&str) -> Option<String>) -> bool {
    variable("NO_COLOR").is_some_and(|value| !value.is_empty())
}

/// Returns the palette of the terminal that these environment variables describe, wanted or not.
pub fn terminal_palette(variable: impl Fn(&str) -> Option<String>) -> Palette {
    let term = variable("TERM").unwrap_or_default();
    // GNU screen passes COLORTERM through but does not support 24-bit color.
    let is_gnu_screen = term.starts_with("screen") && variable("TMUX").is_none();
    let has_24_bits =
        variable("COLORTERM").is_some_and(|value| ["truecolor", "24bit"].contains(&value.as_str()));
    if term.ends_with("-direct") || has_24_bits && !is_gnu_screen && term != "linux" {
        Palette::TrueColor
    } else if term.contains("256color") {
        Palette::Xterm256
    } else {
        Palette::Ansi16
    }
}

/// Returns the theme for `choice` and these environment variables (<https://no-color.org>; COLORFGBG as set by rxvt).
pub fn theme(choice: ColorChoice, variable: impl Fn(&str) -> Option<String>) -> Theme {
    let refused = refuses_color(&variable);
    let has_none = variable("TERM").is_none_or(|term| term == "dumb" || term.starts_with("vt"));
    let palette = match choice {
        ColorChoice::Auto if refused || has_none => Palette::Plain,
        ColorChoice::Auto | ColorChoice::Always => terminal_palette(&variable),
        ColorChoice::Never => Palette::Plain,
        ColorChoice::Palette(palette) => palette,
    };
    let light = variable("COLORFGBG")
        .is_some_and(|value| matches!(value.rsplit(';').next(), Some("7" | "15")));
    Theme {
        palette,
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

    const TRACES: &[Role] = &[
        Role::Run,
        Role::RunEarlier,
        Role::Fill,
        Role::Exact,
        Role::Previous,
        Role::Cursor,
    ];
    const VIEWS: &[Role] = &[
        Role::Run,
        Role::RunEarlier,
        Role::Exact,
        Role::Previous,
        Role::AngularMomentum,
        Role::AngularVelocity,
        Role::Torque,
        Role::RimNear,
        Role::RimFar,
        Role::Cursor,
    ];

    fn theme(palette: Palette, background: Background) -> Theme {
        Theme {
            palette,
            background,
        }
    }

    #[test]
    fn kinds_of_data_in_a_pane_have_distinct_colors() {
        for palette in [Palette::Xterm256, Palette::TrueColor] {
            for background in Background::ALL {
                for roles in [TRACES, VIEWS] {
                    let theme = theme(palette, background);
                    let colors: Vec<_> = roles.iter().map(|role| theme.style(*role).fg).collect();
                    for (index, color) in colors.iter().enumerate() {
                        let is_shared = colors[..index].contains(color);
                        assert!(!is_shared, "{:?} on {background:?}", roles[index]);
                    }
                }
            }
        }
    }

    /// With 16 colors, the gray parts may share a color, and so may the earlier run and its envelope.
    #[test]
    fn sixteen_colors_distinguish_curves_and_arrows() {
        let roles = [
            Role::Run,
            Role::RunEarlier,
            Role::Exact,
            Role::AngularMomentum,
            Role::AngularVelocity,
            Role::Torque,
        ];
        for background in Background::ALL {
            let theme = theme(Palette::Ansi16, background);
            let mut seen = Vec::new();
            for role in roles {
                let color = theme.style(role).fg;
                assert!(!seen.contains(&color), "{role:?} on {background:?}");
                seen.push(color);
            }
        }
    }

    #[test]
    fn words_and_curves_are_legible_on_both_backgrounds() {
        for (background, paper) in [(Background::Dark, 0x1b1d21), (Background::Light, 0xffffff)] {
            for role in [
                Role::Label,
                Role::Run,
                Role::Exact,
                Role::AngularMomentum,
                Role::AngularVelocity,
                Role::Torque,
                Role::Cursor,
            ] {
                let shades = ink(role, background).unwrap();
                let contrast = contrast(shades.rgb, paper);
                assert!(contrast >= 4.0, "{role:?} on {background:?}: {contrast}");
            }
        }
    }

    /// Returns the contrast of two colors, 0xrrggbb, as defined by WCAG 2 from the luminance of sRGB.
    fn contrast(one: u32, other: u32) -> f64 {
        let [a, b] = [one, other].map(|rgb| {
            let [_, red, green, blue] = rgb.to_be_bytes().map(|byte| {
                let part = f64::from(byte) / 255.0;
                if part <= 0.04045 {
                    part / 12.92
                } else {
                    libm::pow((part + 0.055) / 1.055, 2.4)
                }
            });
            0.2126 * red + 0.7152 * green + 0.0722 * blue + 0.05
        });
        (a / b).max(b / a)
    }

    #[test]
    fn the_plain_theme_has_no_color() {
        for role in TRACES.iter().chain(VIEWS).chain(&[Role::Badge, Role::Off]) {
            let style = Theme::PLAIN.style(*role);
            assert_eq!((style.fg, style.bg), (None, None), "{role:?}");
        }
        let badge = Theme::PLAIN.style(Role::Badge).add_modifier;
        assert!(badge.contains(Modifier::REVERSED));
    }

    #[test]
    fn the_palette_follows_the_terminal() {
        for (variables, palette) in [
            (&[("TERM", "xterm-256color")][..], Palette::Xterm256),
            (
                &[("TERM", "xterm-256color"), ("COLORTERM", "truecolor")],
                Palette::TrueColor,
            ),
            (
                &[("TERM", "screen-256color"), ("COLORTERM", "truecolor")],
                Palette::Xterm256,
            ),
            (&[("TERM", "xterm-direct")], Palette::TrueColor),
            (&[("TERM", "linux")], Palette::Ansi16),
            (&[("TERM", "vt100")], Palette::Plain),
            (
                &[("TERM", "xterm-256color"), ("NO_COLOR", "1")],
                Palette::Plain,
            ),
            (&[], Palette::Plain),
        ] {
            let variable = |name: &str| {
                let mut all = variables.iter();
                all.find(|(key, _)| *key == name)
                    .map(|(_, value)| (*value).to_owned())
            };
            let found = super::theme(ColorChoice::Auto, variable).palette;
            assert_eq!(found, palette, "{variables:?}");
        }
    }
}
