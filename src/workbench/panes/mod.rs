//! The panes: each borrows what it shows, and draws it on its area. None of them changes anything.

pub mod browser;
pub mod chrome;
pub mod from_above;
pub mod help;
pub mod parameters;
pub mod three_d;
pub mod traces;

use super::theme::{Role, Theme};
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Style;
use ratatui::widgets::{Block, Clear, Widget};

/// A frame with a title, the accent on it where it has the focus; gives the area inside.
pub(super) fn frame(title: &str, area: Rect, focus: bool, theme: &Theme, buf: &mut Buffer) -> Rect {
    let (border, text) = match focus {
        true => (Role::Focus, Role::Focus),
        false => (Role::Quiet, Role::Heading),
    };
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

/// Writes `text` at `x`, `y` relative to `area`, cut off at its right edge; gives the column after it.
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
    let (end, _) = buf.set_stringn(area.x + x, area.y + y, text, room, style);
    end - area.x
}

/// `text` in lines of at most `width` characters, broken between words.
pub(super) fn wrapped(text: &str, width: usize) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in text.split_whitespace() {
        let Some(line) = lines.last_mut() else { break };
        if line.is_empty() || line.chars().count() + 1 + word.chars().count() <= width {
            let space = if line.is_empty() { "" } else { " " };
            line.push_str(space);
            line.push_str(word);
        } else {
            lines.push(word.to_owned());
        }
    }
    lines
}
