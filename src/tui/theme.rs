//! Colours by what they mean, from the 16 that every terminal names.
//!
//! x, y and z are told apart by people of every kind of colour vision: cyan, yellow and magenta differ in brightness
//! as well as in hue, and so do blue, red and dark cyan on a light screen. Nothing is told by colour alone: each has
//! its letter beside it, and without colours bold, dim and reversed remain.

use crate::lab::view::theme::{Background, Theme};
use ratatui::style::{Color, Modifier, Style};

/// What a piece of the screen is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Role {
    /// Values and sentences.
    #[default]
    Text,
    /// Units, labels, borders: there, and quiet.
    Quiet,
    /// Headings.
    Heading,
    /// x of the traced point.
    X,
    /// y of the traced point.
    Y,
    /// z of the traced point.
    Z,
    /// Tilt, and the path.
    Path,
    /// The exact motion.
    Exact,
    /// The run before.
    Ghost,
    /// What pushes the body, and when.
    Push,
    /// The one accent: what has the focus.
    Focus,
    /// What is selected in a list.
    Selected,
    /// What is wrong with the numbers.
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
        Role::Heading | Role::Focus | Role::Push | Role::Warning => Modifier::BOLD,
        Role::Quiet | Role::Ghost => Modifier::DIM,
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
        Role::Exact | Role::Warning => choose(Color::LightRed, Color::Red),
        Role::Push => Color::Green,
        Role::Focus => choose(Color::LightBlue, Color::Blue),
        _ => Color::Reset,
    }
}
