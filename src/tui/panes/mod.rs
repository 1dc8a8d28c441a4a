//! The panes. Each draws what it borrows on its area; none changes anything.
//!
//! A new pane needs a variant of [`Pane`], a file with its [`PaneRow`], and an arm in [`row`].

pub mod browser;
pub mod chrome;
pub mod form;
pub mod from_above;
mod gravity_motion;
pub mod help;
pub mod hint;
pub mod lesson;
pub mod measured;
pub mod overview;
pub mod parameters;
pub mod step;
pub mod three_d;
pub mod traces;

use crate::engine::analysis::MeasuredNumber;
use crate::engine::run::Sample;
use crate::engine::text::printable::printable;
use crate::engine::text::wrap::{columns, wrapped};
use crate::lab::action::{Action, Direction, repeated};
use crate::lab::comparison::{DataComparison, RecordedColumn};
use crate::lab::playback::ghost::Ghost;
use crate::lab::playback::live::{LiveRun, Overlay};
use crate::lab::playback::reading::Reading;
use crate::lab::step_pane::StepWorkings;
use crate::lab::view::theme::Theme;
use crate::lab::view::{HideablePart, Pane, View};
use crate::lab::{KeyCommands, Lab, LabRequest};
use crate::tui::keymap::{self, Binding, KeyEffect, Mode};
use crate::tui::split::split_rows;
use crate::tui::theme::Role;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::{Modifier, Style};
use ratatui::widgets::{Clear, Widget};
use std::borrow::Cow;
use std::f64::consts::TAU;

/// Mark of the selected line of a list.
const SELECTED_MARK: &str = "►";

/// A row of the table of panes: the data of a pane for the layout, the focus, the footer and the help.
#[derive(Debug)]
pub struct PaneRow {
    pub id: Pane,
    /// Title on the rule of the pane and above its keys in the help. The pane may add words to it.
    pub title: &'static str,
    pub draw: fn(&Lab, Rect, &mut Buffer),
    /// Keys of the pane while it has the focus. They have priority over the keys of the lab.
    pub keys: &'static [Binding],
    /// Meaning of an arrow or page key while the pane has the focus, if it has one.
    pub arrows: Option<Arrows>,
}

/// Returns the commands for an arrow or page key that is pressed this number of times.
pub type Arrows = fn(&Lab, Direction, i32) -> KeyCommands;

pub fn row(pane: Pane) -> &'static PaneRow {
    match pane {
        Pane::Lesson => &lesson::LESSON_ROW,
        Pane::Traces => &traces::TRACES_ROW,
        Pane::Above => &from_above::FROM_ABOVE_ROW,
        Pane::ThreeD => &three_d::THREE_D_ROW,
        Pane::Parameters => &parameters::PARAMETERS_ROW,
        Pane::Step => &step::STEP_ROW,
    }
}

/// Returns the rows of all panes, from left to right on the screen.
pub fn rows() -> impl Iterator<Item = &'static PaneRow> {
    Pane::ALL.into_iter().map(row)
}

/// Returns the keys of the pane in focus.
///
/// In a lesson, these include the keys that turn pages and, while the step pane is visible, its keys.
pub fn keys_of(lab: &Lab) -> impl Iterator<Item = &'static Binding> + Clone {
    let view = lab.view();
    let is_beside = view.sheet.is_some() && view.side_by_side.contains(&Pane::Step);
    let own = row(view.focus).keys;
    let beside = match view.focus {
        Pane::Lesson if is_beside => keymap::STEP_KEYS,
        _ if is_beside => keymap::STEP_KEYS.split_at(keymap::PHASE_KEYS).0,
        _ => &[],
    };
    let turns = if view.sheet.is_some() {
        keymap::LESSON_KEYS_EVERYWHERE
    } else {
        &[]
    };
    let others = beside.iter().chain(turns);
    own.iter().chain(others.filter(|row| {
        let mut keys = own.iter().flat_map(|own| own.keys);
        keys.all(|key| !row.keys.contains(key))
    }))
}

/// Carries out the effect of a key. An arrow key does what the pane in focus defines.
pub fn carry_out(does: KeyEffect, lab: &mut Lab) -> Option<LabRequest> {
    let arrows = row(lab.view().focus).arrows;
    match (does, arrows.filter(|_| lab.popups().mode == Mode::Lab)) {
        (KeyEffect::Commands(meant), _) => lab.press(meant),
        (KeyEffect::Action(Action::Move(direction, times)), Some(arrows)) => {
            lab.press(|lab, count| arrows(lab, direction, times * repeated(count)));
        }
        (KeyEffect::Action(action), _) => return lab.update(action),
    }
    None
}

/// Inputs of the panes that show the motion: a run, the runs and data to compare with it, and the view.
#[derive(Clone, Copy)]
pub struct PlotInputs<'a> {
    pub view: &'a View,
    pub run: &'a LiveRun,
    /// Previous run.
    pub ghost: Option<&'a Ghost>,
    /// Run pinned as the reference, unless it is the current run.
    pub pinned: Option<&'a Ghost>,
    pub measured: Option<&'a DataComparison>,
    /// Column of the CSV that a strip shows.
    pub column: Option<&'a RecordedColumn>,
    /// Latest reading of the run, if any.
    ///
    /// Its precession determines the last turn of the path. The 3-D view shows the run at its time: a turning wheel
    /// changes most of the picture, which would load a slow line in every frame.
    pub reading: Option<&'a Reading>,
    /// Time step explained by the step pane. The 3-D view shows the quantities of its page.
    pub explained: Option<&'a StepWorkings>,
    pub cursor: Option<&'a Sample>,
}

impl<'a> PlotInputs<'a> {
    pub fn from_lab(lab: &'a Lab) -> Self {
        let (player, comparison) = (lab.player(), lab.comparison());
        Self {
            view: lab.view(),
            run: player.run(),
            ghost: comparison.ghost(),
            pinned: comparison.pinned(),
            measured: comparison.data(),
            column: comparison.column(),
            reading: Some(&player.reading),
            explained: lab.step_pane().shown(),
            cursor: player.cursor(),
        }
    }

    /// Returns the inputs of the views of the path: as [`from_lab`](Self::from_lab), but next to a lesson's page
    /// without the previous run, which would cover the path.
    fn of_path(lab: &'a Lab) -> Self {
        let inputs = Self::from_lab(lab);
        let ghost = inputs.ghost.filter(|_| lab.view().sheet.is_none());
        Self { ghost, ..inputs }
    }

    /// Returns the exact motion if it is shown.
    fn overlay(&self) -> Option<&'a Overlay> {
        let overlay = self.run.overlay();
        overlay.filter(|_| !self.view.hides(HideablePart::Predicted))
    }

    /// Returns the time from which the path is bright, s.
    ///
    /// This is the start of the traces' window or, if that window is the whole run, the start of the last turn.
    fn bright_since_s(&self, now_s: f64) -> f64 {
        let window = &self.view.window;
        if window.has_overview {
            return window.begin_s;
        }
        let readouts = self.reading.map(|reading| &reading.readouts);
        let rate = readouts.and_then(|readouts| {
            let measured = readouts.precession.filter(MeasuredNumber::is_settled);
            let theory = readouts
                .theory_about_z()
                .and_then(|theory| theory.precession);
            measured.map(|measured| measured.value).or(theory)
        });
        rate.map_or(f64::NEG_INFINITY, |rate| now_s - TAU / rate.abs())
    }
}

/// Draws the rule above a pane: `title` at its left, reversed if the pane has the focus, and `right` at its end.
///
/// Returns the area below.
pub(super) fn rule(
    title: &str,
    right: Option<(&str, Role)>,
    focus: bool,
    area: Rect,
    theme: &Theme,
    buf: &mut Buffer,
) -> Rect {
    let line = "─".repeat(area.width.into());
    write(area, (0, 0), &line, theme.style(Role::Rule), buf);
    let printed = printable(title);
    let short = shortened(&printed, area.width.saturating_sub(3).into());
    let (text, role) = if focus {
        (format!(" {short} "), Role::Selected)
    } else {
        (format!("{short} "), Role::Heading)
    };
    if !title.is_empty() {
        write(area, (0, 0), &text, theme.style(role), buf);
    }
    if let Some((words, look)) = right {
        let x = area.width.saturating_sub(columns(words) as u16 + 1);
        if usize::from(x) > columns(&short) + 3 {
            write(area, (x, 0), " ", theme.style(Role::Rule), buf);
            write(area, (x + 1, 0), words, theme.style(look), buf);
        }
    }
    below_rule(area)
}

/// Returns the area below the rule of a pane on `area`.
pub(super) fn below_rule(area: Rect) -> Rect {
    split_rows(area, 1)[1]
}

/// Returns the longest title of a view of the path that fits in `width` columns.
///
/// It has the `name`, the magnification and, if the scheme has broken down since, the displayed step.
fn round_title(name: &str, zoom: f64, reading: Option<&Reading>, width: u16) -> String {
    let title = if zoom == 1.0 {
        name.to_owned()
    } else {
        format!("{name} ×{zoom}")
    };
    let Some(step) = reading.and_then(|reading| reading.last_whole) else {
        return title;
    };
    let forms = [
        format!("{title} at step {step}: then the scheme broke down"),
        format!("{title} at step {step}, then broken"),
        format!("{title}, step {step}"),
    ];
    longest(forms, width.saturating_sub(4).into())
}

/// Returns the first of `forms` (longest first) that fits in `width` columns, else the last.
pub(super) fn longest(forms: impl IntoIterator<Item = String>, width: usize) -> String {
    forms
        .into_iter()
        .reduce(|kept, next| if columns(&kept) <= width { kept } else { next })
        .unwrap_or_default()
}

/// Clears the area and draws a [`rule`] with the focus. Returns the area below.
pub(super) fn popup_rule(title: &str, area: Rect, theme: &Theme, buf: &mut Buffer) -> Rect {
    Clear.render(area, buf);
    rule(title, None, true, area, theme, buf)
}

/// Makes `text` printable and writes it at `x`, `y` relative to `area`, [`shortened`] at its right edge. Returns the column
/// after the text.
pub(super) fn write(
    area: Rect,
    (x, y): (u16, u16),
    text: &str,
    style: Style,
    buf: &mut Buffer,
) -> u16 {
    if x >= area.width || y >= area.height {
        return x;
    }
    let room = (area.width - x) as usize;
    let printed = printable(text);
    let short = shortened(&printed, room);
    // Reset bold and dim, because the text before may have been either.
    let weight = (Modifier::BOLD | Modifier::DIM).difference(style.add_modifier);
    let reset = style.remove_modifier(weight);
    let (end, _) = buf.set_stringn(area.x + x, area.y + y, short, room, reset);
    end - area.x
}

/// Maximum number of pushes that a picture shows at one time.
const MOST_SHOWN_PUSHES: usize = 20;

/// Removes the least important item (the last of the highest rank above 0). Returns false if there is none.
fn remove_least_important<T>(items: &mut Vec<T>, rank: impl Fn(&T) -> u8) -> bool {
    let ranks = items.iter().map(rank).enumerate();
    let last = ranks
        .max_by_key(|&(_, its_rank)| its_rank)
        .filter(|&(_, its_rank)| its_rank > 0);
    last.map(|(index, _)| items.remove(index)).is_some()
}

/// Replaces the end of a shortened text. Not every terminal's font has a single character for it.
const REST: &str = "...";

/// Returns `text`, or as much of it as fits in `width` columns, with dots for the rest.
pub(super) fn shortened(text: &str, width: usize) -> Cow<'_, str> {
    if columns(text.trim_end()) <= width {
        return text.into();
    }
    let mut begin = text.trim_end().to_owned();
    while columns(&begin) + REST.len() > width && begin.pop().is_some() {}
    let rest = &REST[..REST.len().min(width)];
    (begin.trim_end().to_owned() + rest).into()
}

/// Wraps `text` like [`wrapped`], in at most `height` lines, with dots for the rest.
pub(super) fn wrapped_to(text: &str, width: usize, height: usize) -> Vec<String> {
    let mut lines = wrapped(text, width);
    if lines.len() > height {
        let rest = lines.split_off(height.saturating_sub(1)).join(" ");
        lines.push(shortened(&rest, width).into_owned());
    }
    lines.truncate(height);
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_pane_has_its_row() {
        for pane in Pane::ALL {
            assert_eq!(row(pane).id, pane);
        }
    }

    #[test]
    fn shortened_text_ends_with_dots() {
        assert_eq!(shortened("Loops", 5), "Loops");
        assert_eq!(shortened("Loops  ", 5), "Loops  ");
        assert_eq!(shortened("A fast top", 9), "A fast...");
        assert_eq!(shortened("A fast top", 8), "A fas...");
        assert_eq!(shortened("A fast top", 2), "..");
        assert_eq!(shortened("速い独楽", 7), "速い...");
        assert_eq!(shortened("anything", 0), "");
    }
}
