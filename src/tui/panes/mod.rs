//! The panes. Each borrows what it shows and draws it on its area; none of them changes anything.
//!
//! A new pane is a variant of [`Pane`], a file with its `ROW`, and that row's name in [`row`].

pub mod browser;
pub mod chrome;
pub mod form;
pub mod from_above;
pub mod help;
pub mod hint;
pub mod lesson;
pub mod measured;
pub mod parameters;
pub mod step;
pub mod three_d;
pub mod timeline;
pub mod traces;

use crate::engine::run::Sample;
use crate::engine::text::printable::printable;
use crate::engine::text::wrap::{columns, wrapped};
use crate::lab::action::{Action, Direction, repeated};
use crate::lab::comparison::DataComparison;
use crate::lab::playback::detail::Detail;
use crate::lab::playback::ghost::Ghost;
use crate::lab::playback::live::LiveRun;
use crate::lab::playback::reading::Reading;
use crate::lab::step_pane::StepWorkings;
use crate::lab::view::theme::Theme;
use crate::lab::view::{Pane, View};
use crate::lab::{KeyCommands, Lab, LabRequest};
use crate::tui::keymap::{Binding, KeyEffect, Mode};
use crate::tui::theme::Role;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::{Modifier, Style};
use ratatui::widgets::{Block, Clear, Widget};
use std::borrow::Cow;

/// The mark of the selected line of a list.
const SELECTED_MARK: &str = "►";

/// A row of the table of panes: what the layout, the focus, the footer and the help need to know.
#[derive(Debug)]
pub struct PaneRow {
    pub id: Pane,
    /// Its title, in its frame and over its keys in the help; the pane may add words to it.
    pub title: &'static str,
    /// How wide it is where panes stand side by side.
    pub width: Width,
    /// Its place in the order in which panes join the others as the screen becomes wider; the first is 0.
    pub rank: u8,
    /// The fewest columns with which it stands beside others, and the fewest rows with which it shares a column.
    pub least: (u16, u16),
    pub draw: fn(&Lab, Rect, &mut Buffer),
    /// The keys that are its own while it has the focus; they go before the keys of the lab.
    pub keys: &'static [Binding],
    /// What an arrow or page key means while it has the focus, pressed so many times, if there is something it means.
    pub arrows: Option<Arrows>,
}

pub type Arrows = fn(&Lab, Direction, i32) -> KeyCommands;

/// How wide a pane is where panes stand side by side.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Width {
    /// What the others leave.
    Wide,
    /// As the others of this kind, and no wider than a circle needs; two of them share a column of a high screen.
    Round,
    /// Its least width.
    Fixed,
}

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

/// The rows of all panes, from left to right on the screen.
pub fn rows() -> impl Iterator<Item = &'static PaneRow> {
    Pane::ALL.into_iter().map(row)
}

/// The keys of the pane in focus; in a lesson also the keys of the step pane where it is shown, and the keys that turn
/// pages.
pub fn keys_of(lab: &Lab) -> impl Iterator<Item = &'static Binding> + Clone {
    let view = lab.view();
    let is_beside = view.sheet.is_some() && view.side_by_side.contains(&Pane::Step);
    let own = row(view.focus).keys;
    let beside = match view.focus {
        Pane::Lesson if is_beside => step::STEP_ROW.keys,
        _ if is_beside => step::STEP_ROW.keys.split_at(step::PHASE_KEYS).0,
        _ => &[],
    };
    let turns = if view.sheet.is_some() {
        lesson::EVERYWHERE
    } else {
        &[]
    };
    let others = beside.iter().chain(turns);
    own.iter().chain(others.filter(|row| {
        let mut keys = own.iter().flat_map(|own| own.keys);
        keys.all(|key| !row.keys.contains(key))
    }))
}

/// Carries out what a key does; an arrow does what it means in the pane that has the focus.
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

/// What the panes of the motion draw: a run, the runs and data beside it, and how they are looked at.
#[derive(Clone, Copy)]
pub struct PlotInputs<'a> {
    pub view: &'a View,
    pub run: &'a LiveRun,
    /// The run before.
    pub ghost: Option<&'a Ghost>,
    /// The run that was pinned as the reference, unless it is the present one.
    pub pinned: Option<&'a Ghost>,
    pub measured: Option<&'a DataComparison>,
    /// The latest reading of the run, if it is read at all: by it a path is recent or old. The scene in space is that of
    /// its time: a turning wheel changes most of the picture, which would load a slow line in every frame.
    pub reading: Option<&'a Reading>,
    /// The time step that the step pane takes apart: the scene in space shows what its page is about.
    pub explained: Option<&'a StepWorkings>,
    pub detail: Detail,
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
            reading: Some(&player.reading),
            explained: lab.step_pane().shown(),
            detail: *player.detail(),
            cursor: player.cursor(),
        }
    }
}

/// Draws a frame with a title, marked where the pane has the focus; returns the area inside.
pub(super) fn frame(title: &str, area: Rect, focus: bool, theme: &Theme, buf: &mut Buffer) -> Rect {
    let (border, text) = if focus {
        (Role::Focus, Role::Focus)
    } else {
        (Role::Quiet, Role::Heading)
    };
    let title = printable(title);
    let title = shortened(&title, area.width.saturating_sub(4) as usize);
    let block = Block::bordered()
        .border_style(theme.style(border))
        .title(format!(" {title} "))
        .title_style(theme.style(text));
    let inside = block.inner(area);
    block.render(area, buf);
    inside
}

/// Draws the frame of the round pane `row`, magnified by `zoom`; returns the area inside, where it has room for a picture.
fn round_frame(
    row: &PaneRow,
    zoom: f64,
    seen: &PlotInputs<'_>,
    area: Rect,
    buf: &mut Buffer,
) -> Option<Rect> {
    let title = round_title(row.title, zoom, seen.reading, area.width);
    let has_focus = seen.view.focus == row.id;
    let inside = frame(&title, area, has_focus, &seen.view.theme, buf);
    (inside.height >= 2 && inside.width > 0).then_some(inside)
}

/// The title of a round pane: `name`, its magnification, and the step that it shows if the scheme has broken down
/// since. The longest form that fits in `width` columns.
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

/// The first of `forms`, the longest first, that fits in `width` columns; else the last.
pub(super) fn longest(forms: impl IntoIterator<Item = String>, width: usize) -> String {
    forms
        .into_iter()
        .reduce(|kept, next| if columns(&kept) <= width { kept } else { next })
        .unwrap_or_default()
}

/// The words of a legend in lines of at most `width` columns, with `apart` columns between two words; a word that is wider
/// has a line of its own.
fn in_lines<T>(
    words: impl Iterator<Item = T>,
    text: impl Fn(&T) -> &str,
    apart: usize,
    width: usize,
) -> Vec<Vec<T>> {
    let mut lines: Vec<Vec<T>> = Vec::new();
    let mut taken = 0;
    for word in words {
        let length = columns(text(&word));
        match lines.last_mut() {
            Some(line) if taken + apart + length <= width => {
                taken += apart + length;
                line.push(word);
            }
            _ => {
                taken = length;
                lines.push(vec![word]);
            }
        }
    }
    lines
}

/// As [`frame`], on top of whatever is there.
pub(super) fn popup_frame(title: &str, area: Rect, theme: &Theme, buf: &mut Buffer) -> Rect {
    Clear.render(area, buf);
    frame(title, area, true, theme, buf)
}

/// Writes `text`, made printable, at `x`, `y` relative to `area`, [`shortened`] at its right edge; gives the column after it.
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
    // Bold and faint are reset: the text before may have been either.
    let weight = (Modifier::BOLD | Modifier::DIM).difference(style.add_modifier);
    let reset = style.remove_modifier(weight);
    let (end, _) = buf.set_stringn(area.x + x, area.y + y, short, room, reset);
    end - area.x
}

/// Rows of a round pane for each line of its legend.
const ROWS_A_LINE: u16 = 5;
/// The most pushes that a picture shows at one time.
const MOST_SHOWN_PUSHES: usize = 20;

/// Takes the last of the highest rank out of `items`, but none of rank 0; whether there was one.
fn leave_one_out<T>(items: &mut Vec<T>, rank: impl Fn(&T) -> u8) -> bool {
    let ranks = items.iter().map(rank).enumerate();
    let last = ranks
        .max_by_key(|&(_, its_rank)| its_rank)
        .filter(|&(_, its_rank)| its_rank > 0);
    last.map(|(index, _)| items.remove(index)).is_some()
}

/// Stands for the rest of a text. Not every terminal's font has a single character for it.
const REST: &str = "...";

/// `text`, or as much of it as `width` columns hold, with dots for the rest.
pub(super) fn shortened(text: &str, width: usize) -> Cow<'_, str> {
    if columns(text.trim_end()) <= width {
        return text.into();
    }
    let mut begin = text.trim_end().to_owned();
    while columns(&begin) + REST.len() > width && begin.pop().is_some() {}
    let rest = &REST[..REST.len().min(width)];
    (begin.trim_end().to_owned() + rest).into()
}

/// As [`wrapped`], in no more than `height` lines; dots stand for what does not fit.
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
    fn every_pane_has_a_row_and_a_rank_of_its_own() {
        for (index, pane) in Pane::ALL.into_iter().enumerate() {
            let (id, rank) = (row(pane).id, row(pane).rank);
            assert_eq!(id, pane);
            assert!(rows().take(index).all(|other| other.rank != rank), "{id:?}");
        }
    }

    #[test]
    fn what_is_cut_has_dots() {
        assert_eq!(shortened("Loops", 5), "Loops");
        assert_eq!(shortened("Loops  ", 5), "Loops  ");
        assert_eq!(shortened("A fast top", 9), "A fast...");
        assert_eq!(shortened("A fast top", 8), "A fas...");
        assert_eq!(shortened("A fast top", 2), "..");
        assert_eq!(shortened("速い独楽", 7), "速い...");
        assert_eq!(shortened("anything", 0), "");
    }
}
