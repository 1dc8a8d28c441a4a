//! What the tests of several files of the lab begin with.

use super::view::theme::{Background, Marker, Theme};
use super::view::{Pane, View};
use crate::scenario::{Document, Scenario};
use std::sync::Arc;

/// The scenario of the preset method-2.
pub(in crate::lab) fn scenario() -> Arc<Scenario> {
    preset("method-2")
}

pub(in crate::lab) fn preset(name: &str) -> Arc<Scenario> {
    Arc::new(Document::open(name).unwrap().scenario().unwrap())
}

pub(in crate::lab) fn view(panes: &'static [Pane]) -> View {
    let theme = Theme {
        colour: false,
        background: Background::Dark,
    };
    View::new(&scenario(), Marker::Braille, theme, panes)
}
