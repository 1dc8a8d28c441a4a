//! The panes: each borrows what it shows, and draws it on its area. None of them changes anything.

pub mod browser;
pub mod chrome;
pub mod form;
pub mod from_above;
pub mod help;
pub mod parameters;
pub mod three_d;
pub mod traces;

use crate::lab::view::theme::Theme;
use crate::text::printable::printable;
use crate::text::wrap::{columns, wrapped};
use crate::tui::theme::Role;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Style;
use ratatui::widgets::{Block, Clear, Widget};
use std::borrow::Cow;

/// A frame with a title, the accent on it where it has the focus; gives the area inside.
pub(super) fn frame(title: &str, area: Rect, focus: bool, theme: &Theme, buf: &mut Buffer) -> Rect {
    let (border, text) = match focus {
        true => (Role::Focus, Role::Focus),
        false => (Role::Quiet, Role::Heading),
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

/// As [`frame`], on top of whatever is there.
pub(super) fn frame_on_top(title: &str, area: Rect, theme: &Theme, buf: &mut Buffer) -> Rect {
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
    let text = printable(text);
    let text = shortened(&text, room);
    let (end, _) = buf.set_stringn(area.x + x, area.y + y, text, room, style);
    end - area.x
}

/// What stands for the rest of a text: no single character for it is in every terminal's font.
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
    if lines.len() > height && height > 0 {
        let rest = lines.split_off(height - 1).join(" ");
        lines.push(shortened(&rest, width).into_owned());
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

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
