//! Lines that are drawn again and again, without a lab: the board of a class.

use super::decoder::Typed;
use super::job_control::can_be_resumed;
use super::keymap::Key;
use super::screen::to_ascii;
use super::terminal::{Event, Screen};
use super::theme::marker;
use crate::engine::text::printable::printable;
use crate::lab::view::theme::Marker;
use ratatui::style::Style;
use std::io;
use std::time::Duration;

/// How often the lines are written anew.
const BOARD_INTERVAL: Duration = Duration::from_millis(500);

/// Shows `lines`, which are given the width of the screen, until q, Esc or Ctrl-C.
pub fn run(lines: impl Fn(usize) -> Vec<String>) -> io::Result<()> {
    let mut screen = Screen::enter()?;
    let is_ascii = marker(|name| std::env::var(name).ok()) == Marker::Ascii;
    loop {
        let shown = lines(screen.size()?.width.into());
        screen.draw(|area, buf| {
            for (line, y) in shown.iter().zip(area.top()..area.bottom()) {
                buf.set_stringn(
                    area.left(),
                    y,
                    printable(line),
                    area.width.into(),
                    Style::new(),
                );
            }
            if is_ascii {
                to_ascii(area, buf);
            }
        })?;
        for event in screen.events(BOARD_INTERVAL)? {
            match event {
                Event::Typed(Typed::Key(Key::Char('q') | Key::Esc | Key::Ctrl('c'))) => {
                    return Ok(());
                }
                Event::Suspend if can_be_resumed() => screen.suspend(false)?,
                Event::Resumed => screen.resume()?,
                Event::Resized => screen.forget()?,
                Event::Suspend | Event::Typed(_) => {}
            }
        }
    }
}
