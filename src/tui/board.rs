//! Lines of text, redrawn at intervals without a lab: the board of a class.

use super::decoder::Typed;
use super::job_control::can_be_resumed;
use super::keymap::Key;
use super::screen::to_ascii;
use super::terminal::{Event, Screen};
use super::theme::marker;
use crate::engine::text::printable::printable;
use crate::lab::action::Direction;
use crate::lab::view::theme::Marker;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::{Modifier, Style};
use std::io;
use std::time::Duration;

/// Time between two updates of the lines.
const BOARD_INTERVAL: Duration = Duration::from_millis(500);

/// Shows `lines`, called with the width of the screen, until q, Esc or Ctrl-C.
///
/// If there are more lines than rows, arrows and page keys scroll them.
///
/// # Errors
///
/// Returns an error if the terminal cannot be opened, read or written.
pub fn run(lines: impl Fn(usize) -> Vec<String>) -> io::Result<()> {
    let mut screen = Screen::enter()?;
    let is_ascii = marker(|name| std::env::var(name).ok()) == Marker::Ascii;
    let mut first = 0;
    loop {
        let size = screen.size()?;
        let shown = lines(size.width.into());
        let rows = rows_of(&shown, size);
        first = first.min(shown.len() - rows);
        screen.draw(|area, buf| {
            draw(&shown, first, area, buf);
            if is_ascii {
                to_ascii(area, buf);
            }
        })?;
        for event in screen.events(BOARD_INTERVAL)? {
            match event {
                Event::Typed(Typed::Key(Key::Char('q') | Key::Esc | Key::Ctrl('c'))) => {
                    return Ok(());
                }
                Event::Typed(Typed::Key(key)) => {
                    let by = direction(key).map_or(0, |it| it.rows(rows as isize));
                    first = first.saturating_add_signed(by).min(shown.len() - rows);
                }
                Event::Suspend if can_be_resumed() => screen.suspend(false)?,
                Event::Resumed => screen.resume()?,
                Event::Resized => screen.forget()?,
                Event::Suspend | Event::Typed(_) => {}
            }
        }
    }
}

/// Returns how many of `lines` a screen of this size shows. If they do not all fit, the last row names the keys.
fn rows_of(lines: &[String], size: Rect) -> usize {
    let rows = usize::from(size.height);
    if lines.len() <= rows {
        lines.len()
    } else {
        rows.saturating_sub(1)
    }
}

/// Returns the direction in which `key` scrolls, if it does.
pub(super) fn direction(key: Key) -> Option<Direction> {
    Some(match key {
        Key::Up => Direction::Up,
        Key::Down => Direction::Down,
        Key::PageUp => Direction::PageUp,
        Key::PageDown | Key::Char(' ') => Direction::PageDown,
        Key::Home => Direction::First,
        Key::End => Direction::Last,
        _ => return None,
    })
}

fn draw(lines: &[String], first: usize, area: Rect, buf: &mut Buffer) {
    let rows = rows_of(lines, area);
    let shown = lines.iter().skip(first).take(rows);
    let mut write = |text: &str, y: u16, style: Style| {
        buf.set_stringn(area.left(), y, printable(text), area.width.into(), style);
    };
    for (line, y) in shown.zip(area.top()..) {
        write(line, y, Style::new());
    }
    if rows < lines.len() && !area.is_empty() {
        let (last, all) = (first + rows, lines.len());
        let text = format!(
            "lines {} to {last} of {all}   arrows, PgDn: scroll   q: quit",
            first + 1
        );
        write(
            &text,
            area.bottom() - 1,
            Style::new().add_modifier(Modifier::DIM),
        );
    }
}
