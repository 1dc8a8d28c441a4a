//! The settings of the display. A dialog lists them with their present values.
//!
//! Choices of markers, colors, background, frame rate and mouse are saved for the next session. A new setting is a row
//! of `SETTINGS`.

use super::command::Command;
use super::view::theme::{Background, Marker, Palette};
use super::view::{HideablePart, View};
use crate::lab::storage::settings::remember;
use std::path::PathBuf;

/// Frame rates that the dialog offers, frames per second.
const FRAME_RATES: [u32; 5] = [2, 5, 10, 15, 30];

/// The saved choices, and the defaults.
#[derive(Default)]
pub struct Settings {
    /// The folder in which choices are saved; `None` to save nothing.
    pub folder: Option<PathBuf>,
    /// The palette without a choice; `None` if unknown.
    pub usual_palette: Option<Palette>,
    /// True if the terminal is asked for its background because the user did not choose one.
    pub asks_background: bool,
}

/// A setting: its label, its present value, and the change to its next value (`true`) or its previous one (`false`).
pub(super) struct LabSetting {
    pub(super) label: &'static str,
    pub(super) value: fn(&View) -> String,
    change: fn(&mut View, bool) -> Changed,
}

/// The effect of a changed setting.
enum Changed {
    /// This command changes the view.
    By(Command),
    /// The view has changed, and this value must be saved under this key.
    Remembered(&'static str, toml::Value),
    Palette,
}

const fn row(
    label: &'static str,
    value: fn(&View) -> String,
    change: fn(&mut View, bool) -> Changed,
) -> LabSetting {
    LabSetting {
        label,
        value,
        change,
    }
}

/// All settings. The first three belong to the run and its lesson. The others are saved for the next session.
#[rustfmt::skip]
pub(super) const SETTINGS: [LabSetting; 8] = [
    row("verdict", |view| shown(view, HideablePart::Health), |view, _| hide_or_show(view, HideablePart::Health)),
    row("theory", |view| shown(view, HideablePart::Predicted), |view, _| hide_or_show(view, HideablePart::Predicted)),
    row("screen", |view| if view.look.bare { "bare: two panes, title and time" } else { "everything" }.to_owned(), |view, _| {
        Changed::By(Command::look("bare", !view.look.bare))
    }),
    row("markers", |view| format!("{}  {}", view.marker.name(), view.marker.preview()), |view, forward| {
        view.marker = next(&Marker::ALL, view.marker, forward);
        Changed::Remembered("marker", view.marker.name().into())
    }),
    row("colors", |view| if view.theme.palette == Palette::Plain { "off" } else { view.theme.palette.name() }.to_owned(), |view, forward| {
        view.theme.palette = next(&Palette::ALL, view.theme.palette, forward);
        Changed::Palette
    }),
    row("background", |view| view.theme.background.name().to_owned(), |view, forward| {
        view.theme.background = next(&Background::ALL, view.theme.background, forward);
        Changed::Remembered("background", view.theme.background.name().into())
    }),
    row("frames per second", |view| format!("{} at most", view.fps), |view, forward| {
        // config.toml may contain another number: the next offered one follows it.
        let before = FRAME_RATES.partition_point(|rate| *rate < view.fps);
        let after = FRAME_RATES.partition_point(|rate| *rate <= view.fps);
        let count = FRAME_RATES.len();
        let index = if forward { after } else { before + count - 1 };
        view.fps = FRAME_RATES[index % count];
        Changed::Remembered("fps", view.fps.into())
    }),
    row("mouse", |view| if view.mouse { "controls the lab" } else { "selects text in the terminal" }.to_owned(), |view, _| {
        view.mouse = !view.mouse;
        Changed::Remembered("mouse", view.mouse.into())
    }),
];

impl Settings {
    /// Changes the setting with the index `number` in `view`, and saves the choice. Returns the command that changes
    /// the view, if one is needed.
    ///
    /// # Errors
    /// Returns an error if the choice cannot be saved.
    pub(super) fn change(
        &self,
        number: usize,
        forward: bool,
        view: &mut View,
    ) -> Result<Option<Command>, String> {
        let Some(setting) = SETTINGS.get(number) else {
            return Ok(None);
        };
        let (key, value) = match (setting.change)(view, forward) {
            Changed::By(command) => return Ok(Some(command)),
            Changed::Remembered(key, value) => (key, value),
            Changed::Palette => ("color", self.color_choice(view.theme.palette).into()),
        };
        match &self.folder {
            Some(folder) => remember(folder, key, value).map(|()| None),
            None => Ok(None),
        }
    }

    fn color_choice(&self, palette: Palette) -> &'static str {
        if self.usual_palette == Some(palette) {
            "auto"
        } else {
            palette.name()
        }
    }
}

fn hide_or_show(view: &View, part: HideablePart) -> Changed {
    let mut hidden = view.look.hide.clone();
    hidden.retain(|other| *other != part);
    if hidden.len() == view.look.hide.len() {
        hidden.push(part);
    }
    Changed::By(Command::look("hide", hidden))
}

fn shown(view: &View, part: HideablePart) -> String {
    if view.hides(part) { "hidden" } else { "shown" }.to_owned()
}

/// Returns the value after `now` in `all`, or the value before it. The list is circular.
fn next<T: Copy + PartialEq>(all: &[T], now: T, forward: bool) -> T {
    let here = all.iter().position(|value| *value == now).unwrap_or(0);
    let step = if forward { 1 } else { all.len() - 1 };
    all[(here + step) % all.len()]
}
