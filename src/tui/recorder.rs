//! The lab drawn without a terminal, as the bytes that a terminal would be sent.

use super::screen;
use crate::lab::Lab;
use crossterm::style;
use ratatui::backend::{Backend, ClearType, CrosstermBackend};
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use std::{io, mem};

/// A terminal of which there are the bytes alone.
pub struct Recorder {
    sent: Vec<u8>,
    shown: Buffer,
}

impl Recorder {
    /// A terminal of so many columns and lines, and what clears it and hides its cursor. `lab` is fitted to it.
    ///
    /// # Errors
    /// None that can be thought of: the bytes go into memory.
    pub fn new(lab: &mut Lab, (columns, lines): (u16, u16)) -> io::Result<Self> {
        // The recording is the same whatever NO_COLOR says.
        style::force_color_output(true);
        let area = Rect::new(0, 0, columns, lines);
        let mut sent = Vec::new();
        let mut backend = CrosstermBackend::new(&mut sent);
        backend.clear_region(ClearType::All)?;
        backend.hide_cursor()?;
        screen::fit(lab, area);
        let shown = Buffer::empty(area);
        Ok(Self { sent, shown })
    }

    /// Draws `lab` if its picture has changed, and gives what the terminal is sent for that: only what differs.
    ///
    /// # Errors
    /// None that can be thought of.
    pub fn draw(&mut self, lab: &mut Lab) -> io::Result<String> {
        let area = self.shown.area;
        if lab.has_changed() {
            screen::refit(lab, area);
        }
        if lab.take_changed() {
            let mut next = Buffer::empty(area);
            screen::draw(lab, true, area, &mut next);
            let mut backend = CrosstermBackend::new(&mut self.sent);
            backend.draw(self.shown.diff(&next).into_iter())?;
            self.shown = next;
        }
        let sent = mem::take(&mut self.sent);
        Ok(String::from_utf8_lossy(&sent).into_owned())
    }
}
