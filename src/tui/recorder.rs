//! The lab drawn without a terminal, as the bytes that a terminal would be sent.

use super::screen;
use crate::lab::Lab;
use crossterm::style;
use ratatui::backend::{Backend, ClearType, CrosstermBackend};
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use std::cell::RefCell;
use std::io::{self, Write};
use std::mem;
use std::rc::Rc;

/// A terminal of which there are the bytes alone.
pub struct Recorder {
    backend: CrosstermBackend<Shared>,
    sent: Shared,
    shown: Buffer,
}

/// Bytes that one has and another writes.
#[derive(Clone, Default)]
struct Shared(Rc<RefCell<Vec<u8>>>);

impl Write for Shared {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.borrow_mut().extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl Recorder {
    /// A terminal of so many columns and lines, and what clears it and hides its cursor. `lab` is fitted to it.
    ///
    /// # Errors
    /// None that can be thought of: the bytes go into memory.
    pub fn new(lab: &mut Lab, (columns, lines): (u16, u16)) -> io::Result<Self> {
        // The recording is the same whatever NO_COLOR says.
        style::force_color_output(true);
        let sent = Shared::default();
        let area = Rect::new(0, 0, columns, lines);
        let mut recorder = Self {
            backend: CrosstermBackend::new(sent.clone()),
            sent,
            shown: Buffer::empty(area),
        };
        recorder.backend.clear_region(ClearType::All)?;
        recorder.backend.hide_cursor()?;
        screen::fit(lab, area);
        Ok(recorder)
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
            self.backend.draw(self.shown.diff(&next).into_iter())?;
            self.shown = next;
        }
        let sent = mem::take(&mut *self.sent.0.borrow_mut());
        Ok(String::from_utf8_lossy(&sent).into_owned())
    }
}
