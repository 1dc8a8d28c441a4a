//! The settings: what is shown, and how. One dialog lists them with their present values.

use super::Lab;
use super::command::Command;
use super::dialog::Dialog;
use super::view::markers::Marker;
use super::view::theme::Background;
use super::view::{Part, View};

/// Frames a second that the dialog offers.
const FRAME_RATES: [u32; 5] = [2, 5, 10, 15, 30];

/// A setting: its label, its present value, and the change to its next value (`true`) or the one before.
pub(super) struct Setting {
    pub(super) label: &'static str,
    pub(super) value: fn(&View) -> String,
    change: fn(&mut Lab, bool),
}

const fn row(
    label: &'static str,
    value: fn(&View) -> String,
    change: fn(&mut Lab, bool),
) -> Setting {
    Setting {
        label,
        value,
        change,
    }
}

/// Every setting. The first three belong to the run and its lesson; the others are remembered for the next time.
#[rustfmt::skip]
pub(super) const SETTINGS: [Setting; 8] = [
    row("line about the numbers", |view| shown(view, Part::Health), |lab, _| lab.hide_or_show(Part::Health)),
    row("what theory predicts", |view| shown(view, Part::Predicted), |lab, _| lab.hide_or_show(Part::Predicted)),
    row("screen", |view| if view.bare { "bare: two panes, title and time" } else { "everything" }.to_owned(), |lab, _| {
        lab.carry_out_all(&[Command::look("bare", !lab.view.bare)]);
    }),
    row("dots", |view| view.marker.name().to_owned(), |lab, forward| {
        lab.view.marker = beside(&Marker::ALL, lab.view.marker, forward);
        lab.remember("marker", lab.view.marker.name());
    }),
    row("colours", |view| if view.theme.colour { "on" } else { "off" }.to_owned(), |lab, _| {
        lab.view.theme.colour = !lab.view.theme.colour;
        lab.remember("colour", lab.colour_choice());
    }),
    row("colours for a screen", |view| view.theme.background.name().to_owned(), |lab, forward| {
        let all = [Background::Dark, Background::Light];
        lab.view.theme.background = beside(&all, lab.view.theme.background, forward);
        lab.remember("background", lab.view.theme.background.name());
    }),
    row("frames a second", |view| format!("{} at most", view.fps), |lab, forward| {
        // Another number may stand in config.toml: the nearest offered one follows it.
        let before = FRAME_RATES.partition_point(|rate| *rate < lab.view.fps);
        let after = FRAME_RATES.partition_point(|rate| *rate <= lab.view.fps);
        let count = FRAME_RATES.len();
        let index = if forward { after } else { before + count - 1 };
        lab.view.fps = FRAME_RATES[index % count];
        lab.remember("fps", i64::from(lab.view.fps));
    }),
    row("mouse", |view| if view.mouse { "acts on the lab" } else { "selects the terminal's text" }.to_owned(), |lab, _| {
        lab.view.mouse = !lab.view.mouse;
        lab.remember("mouse", lab.view.mouse);
    }),
];

impl Lab {
    /// Changes the setting that is selected in the dialog, which then shows its new value.
    pub(super) fn change_setting(&mut self, forward: bool) {
        let Some(selected) = self.on_top.dialog().map(|dialog| dialog.form.selected) else {
            return;
        };
        if let Some(setting) = SETTINGS.get(selected) {
            (setting.change)(self, forward);
        }
        self.on_top
            .open_dialog(Dialog::settings(&self.view, selected));
    }

    pub fn shows_settings(&self) -> bool {
        self.on_top.dialog().is_some_and(Dialog::is_of_settings)
    }

    fn hide_or_show(&mut self, part: Part) {
        let mut hidden = self.view.hidden.clone();
        hidden.retain(|other| *other != part);
        if hidden.len() == self.view.hidden.len() {
            hidden.push(part);
        }
        self.carry_out_all(&[Command::look("hide", hidden)]);
    }
}

fn shown(view: &View, part: Part) -> String {
    if view.hides(part) { "hidden" } else { "shown" }.to_owned()
}

/// The value after `now` among `all`, or the one before; after the last comes the first.
fn beside<T: Copy + PartialEq>(all: &[T], now: T, forward: bool) -> T {
    let here = all.iter().position(|value| *value == now).unwrap_or(0);
    let step = if forward { 1 } else { all.len() - 1 };
    all[(here + step) % all.len()]
}
