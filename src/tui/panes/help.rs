//! The list of keys, from the table of keys.

use super::{PANES, frame_on_top, write};
use crate::lab::view::theme::Theme;
use crate::text::wrap::wrapped;
use crate::tui::keymap::{BINDINGS, Binding, Mode};
use crate::tui::theme::Role;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::widgets::Widget;

/// Column of the keys.
const KEYS: usize = 2;
/// Between keys and explanations.
const GAP: usize = 2;
/// Explanations with fewer columns than this stand below their keys, not beside them.
const LEAST_TEXT: usize = 16;

/// The keys of all modes.
pub struct Help<'a> {
    /// First line shown.
    pub scroll: usize,
    /// Colours.
    pub theme: &'a Theme,
}

impl Widget for Help<'_> {
    fn render(self, area: Rect, buf: &mut Buffer) {
        let lines = lines(area.width.saturating_sub(2) as usize);
        let room = area.height.saturating_sub(2) as usize;
        let scroll = self.scroll.min(lines.len().saturating_sub(room));
        let title = match lines.len().saturating_sub(scroll + room) {
            0 => "keys: Esc closes".to_owned(),
            more => format!("keys: Esc closes, Down: {more} more"),
        };
        let inside = frame_on_top(&title, area, self.theme, buf);
        for (line, y) in lines.iter().skip(scroll).zip(0..inside.height) {
            for (x, text, role) in &line.pieces {
                write(inside, (*x as u16, y), text, self.theme.style(*role), buf);
            }
        }
    }
}

/// One line of the screen: texts, and the columns where they begin.
struct Line {
    pieces: Vec<(usize, String, Role)>,
}

impl Line {
    fn of(x: usize, text: impl Into<String>, role: Role) -> Self {
        Self {
            pieces: vec![(x, text.into(), role)],
        }
    }
}

/// Each binding once, under the first mode that has it, in lines of `width` columns.
fn lines(width: usize) -> Vec<Line> {
    let mut lines = Vec::new();
    for (mode, heading) in [
        (Mode::Lab, "the lab"),
        (Mode::Browser, "the list of presets and files"),
        (Mode::Filter, "the filter"),
        (Mode::Dialog, "what is asked for"),
    ] {
        let heading = wrapped(heading, width.saturating_sub(1));
        lines.extend(
            heading
                .into_iter()
                .map(|text| Line::of(1, text, Role::Heading)),
        );
        let rows = BINDINGS.iter().filter(|row| row.modes[0] == mode);
        lines.extend(rows.flat_map(|row| explained(row, width)));
    }
    for pane in PANES.iter().filter(|pane| !pane.keys.is_empty()) {
        lines.push(Line::of(1, pane.title, Role::Heading));
        lines.extend(pane.keys.iter().flat_map(|row| explained(row, width)));
    }
    lines
}

/// The keys of `binding` and, beside them or below, what they mean.
fn explained(binding: &Binding, width: usize) -> Vec<Line> {
    let longest = BINDINGS.iter().map(|row| keys(row).len()).max();
    let column = KEYS + longest.unwrap_or(0) + GAP;
    let beside = width >= column + LEAST_TEXT;
    let x = if beside { column } else { KEYS + GAP };
    let text = wrapped(binding.help, width.saturating_sub(x));
    let mut lines: Vec<_> = text
        .into_iter()
        .map(|text| Line::of(x, text, Role::Text))
        .collect();
    if !beside {
        lines.insert(0, Line { pieces: Vec::new() });
    }
    lines[0].pieces.push((KEYS, keys(binding), Role::Focus));
    lines
}

fn keys(binding: &Binding) -> String {
    binding
        .keys
        .iter()
        .map(ToString::to_string)
        .collect::<Vec<_>>()
        .join(" ")
}
