//! A new lab, with the scenario, the colours and the dots that the command line asks for.

use super::args::{Changes, Color, Look, Markers, Screen};
use super::scenario::change;
use crate::lab::Lab;
use crate::lab::view::View;
use crate::lab::view::markers::Marker;
use crate::lab::view::theme::{Background, Theme};
use crate::scenario::Document;
use crate::tui::panes;
use crate::tui::surroundings::{self, ColourChoice};
use std::sync::Arc;

/// What is opened where nothing is named.
pub(super) const DEFAULT: &str = "method-2";

/// A lab with what `name` names, changed.
pub(super) fn lab(
    name: &str,
    changes: &Changes,
    markers: Option<Markers>,
    theme: Theme,
    running: bool,
) -> anyhow::Result<Lab> {
    // Read once: what is read from a FIFO is not there again.
    let mut document = Document::open(name)?;
    // What a change has mended is no scenario before it, and has no note to lose.
    let file = document.scenario().ok();
    change(&mut document, changes)?;
    let scenario = Arc::new(document.scenario()?);
    let view = View::new(&scenario, marker(markers), theme, &panes::IDS);
    let mut lab = Lab::new(name, scenario, view, running);
    if let Some(file) = file {
        lab.set_file(&Arc::new(file));
    }
    Ok(lab)
}

/// The environment variable `name`, if it is set to text.
pub(super) fn variable(name: &str) -> Option<String> {
    std::env::var(name).ok()
}

/// The colours that `look` asks for, or that suit the terminal.
pub(super) fn theme(look: Look) -> Theme {
    let choice = match look.color {
        None | Some(Color::Auto) => ColourChoice::Auto,
        Some(Color::Always) => ColourChoice::Always,
        Some(Color::Never) => ColourChoice::Never,
    };
    let theme = surroundings::theme(choice, variable);
    let background = match look.background {
        None => theme.background,
        Some(Screen::Dark) => Background::Dark,
        Some(Screen::Light) => Background::Light,
    };
    Theme {
        background,
        ..theme
    }
}

/// The dots that are asked for, or that suit locale and terminal.
pub(super) fn marker(markers: Option<Markers>) -> Marker {
    match markers {
        None => surroundings::marker(variable),
        Some(Markers::Braille) => Marker::Braille,
        Some(Markers::HalfBlock) => Marker::HalfBlock,
        Some(Markers::Dot) => Marker::Dot,
        Some(Markers::Ascii) => Marker::Ascii,
    }
}
