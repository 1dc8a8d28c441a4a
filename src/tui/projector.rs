//! The projector of a class: a lab on the terminal that no key changes.

use super::app::{advance_all, idle_time};
use super::board::direction;
use super::decoder::Typed;
use super::job_control::can_be_resumed;
use super::keymap::Key;
use super::pacing::Pacing;
use super::screen;
use super::terminal::{Event, Screen};
use crate::class::ClassRole;
use crate::lab::Lab;
use crate::lessons::Lessons;
use std::io;
use std::time::Instant;

/// Shows `lab`, which `role` changes, until q or Ctrl-C. Arrows and page keys scroll the page.
///
/// # Errors
///
/// Returns an error if the terminal cannot be opened, read or written.
pub fn run(lab: &mut Lab, lessons: &mut Lessons, role: &mut dyn ClassRole) -> io::Result<()> {
    let mut screen = Screen::enter()?;
    let mut pacing = Pacing::new(lab.view().fps);
    let begin = Instant::now();
    if lab.settings.asks_background {
        screen.ask_background()?;
    }
    screen::fit(lab, screen.size()?);
    loop {
        let until_frame = idle_time(lab, lessons, pacing.wait(begin.elapsed()));
        for event in screen.events(until_frame.min(role.wait(begin.elapsed())))? {
            match event {
                Event::Typed(Typed::Key(Key::Char('q') | Key::Ctrl('c'))) => return Ok(()),
                Event::Typed(Typed::Key(key)) => {
                    if let Some(direction) = direction(key) {
                        screen::scroll_page(lab, direction, screen.size()?);
                    }
                }
                Event::Typed(Typed::Background(background)) => {
                    lab.view_mut().theme.background = background;
                }
                Event::Suspend if can_be_resumed() => screen.suspend(false)?,
                Event::Resumed => screen.resume()?,
                Event::Resized => screen.forget()?,
                Event::Suspend | Event::Typed(_) => {}
            }
            screen::fit(lab, screen.size()?);
        }
        advance_all(lab, lessons, role, begin);
        if lab.has_changed() {
            screen::refit(lab, screen.size()?);
        }
        let now = begin.elapsed();
        if pacing.is_due(now) && lab.take_changed() {
            let bytes = screen.draw(|area, buf| screen::draw(lab, false, area, buf))?;
            pacing.drawn(now, bytes, screen.size()?.area());
        }
    }
}
