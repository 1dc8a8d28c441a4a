//! A new lab, with the scenario, the colours and the dots that the command line asks for.

use super::args::{Changes, Look};
use super::scenario::change;
use crate::lab::Lab;
use crate::lab::view::View;
use crate::lab::view::markers::Marker;
use crate::lab::view::theme::{Background, Theme};
use crate::scenario::Document;
use crate::tui::panes;
use crate::tui::theme;
use std::sync::Arc;

/// What is opened where nothing is named.
pub(super) const DEFAULT: &str = "method-2";

/// A lab with what `name` names, changed.
pub(super) fn lab(
    name: &str,
    changes: &Changes,
    markers: Option<Marker>,
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
    let theme = theme::theme(look.color.unwrap_or_default(), variable);
    Theme {
        background: look.background.unwrap_or(theme.background),
        ..theme
    }
}

/// The dots that are asked for, or that suit locale and terminal.
pub(super) fn marker(markers: Option<Marker>) -> Marker {
    markers.unwrap_or_else(|| theme::marker(variable))
}

/// A lab without colours, for pictures as plain text.
pub(super) fn plain_lab(
    name: &str,
    changes: &Changes,
    markers: Option<Marker>,
) -> anyhow::Result<Lab> {
    let plain = Theme {
        colour: false,
        background: Background::Dark,
    };
    lab(name, changes, markers, plain, false)
}
