//! The colour of each role, from the 16 colours that every terminal has.
//!
//! People with any kind of colour vision can tell x, y and z apart: cyan, yellow and magenta differ in brightness as well as
//! in hue, and so do blue, red and dark cyan on a light screen. No meaning depends on colour alone: each curve has its
//! letter, and without colours the roles differ by bold, dim and reversed.

use crate::lab::view::theme::{Background, Theme};
use ratatui::style::{Color, Modifier, Style};

/// The role of a piece of the screen, which decides its style.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Role {
    /// Values and sentences.
    #[default]
    Text,
    /// Units, labels and borders, less prominent than values.
    Quiet,
    /// Headings.
    Heading,
    /// x of the traced point.
    X,
    /// y of the traced point.
    Y,
    /// z of the traced point.
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
    /// The exact motion.
    Exact,
    /// The previous run.
    Ghost,
    /// The pinned run.
    Pinned,
    /// What was measured.
    Measured,
    /// Pushes and their times.
    Push,
    /// What has the focus.
    Focus,
    /// What is selected in a list.
    Selected,
    /// Warnings about the numbers.
    Warning,
}

impl Theme {
    /// The style of `role`.
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
    let dark = background == Background::Dark;
    let choose = |on_dark, on_light| if dark { on_dark } else { on_light };
    match role {
        Role::X => choose(Color::Cyan, Color::Blue),
        Role::Y => choose(Color::Yellow, Color::Red),
        Role::Z => choose(Color::Magenta, Color::Cyan),
        // No curve, push or warning has the colour of the exact motion.
        Role::Exact => choose(Color::LightRed, Color::Magenta),
        Role::Warning => choose(Color::LightYellow, Color::Red),
        Role::Push => Color::Green,
        Role::Focus | Role::Track | Role::OldTrack => choose(Color::LightBlue, Color::Blue),
        _ => Color::Reset,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_else_on_the_traces_has_the_colour_of_the_exact_motion() {
        use Role::{
            Exact, Ghost, Measured, Old, OldTrack, Path, Pinned, Push, Quiet, Recent, Track,
            Warning, X, Y, Z,
        };
        for background in [Background::Dark, Background::Light] {
            for role in [
                X, Y, Z, Path, Recent, Old, Track, OldTrack, Push, Warning, Ghost, Pinned, Quiet,
                Measured,
            ] {
                assert_ne!(
                    colour(role, background),
                    colour(Exact, background),
                    "{role:?} on {background:?}"
                );
            }
        }
    }
}
