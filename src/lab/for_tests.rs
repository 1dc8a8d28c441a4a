//! Helpers for the tests of several files of the lab.

use super::view::View;
use super::view::theme::{Background, Marker, Palette, Theme};
use crate::engine::scenario::{Document, Scenario};
use std::sync::Arc;

/// Returns the scenario of the preset method-2.
pub(in crate::lab) fn scenario() -> Arc<Scenario> {
    preset("method-2")
}

pub(in crate::lab) fn preset(name: &str) -> Arc<Scenario> {
    preset_with(name, &[])
}

/// Returns the scenario of the preset `name`, changed by the assignments `key=value` in `sets`.
pub(in crate::lab) fn preset_with(name: &str, sets: &[&str]) -> Arc<Scenario> {
    let mut document = Document::open(name).unwrap();
    sets.iter().for_each(|set| document.set(set).unwrap());
    Arc::new(document.scenario().unwrap())
}

pub(in crate::lab) fn view() -> View {
    let theme = Theme {
        palette: Palette::Plain,
        background: Background::Dark,
    };
    View::new(&scenario(), Marker::Braille, theme)
}
