//! Lines from the top of a strip to its bottom: the cursor, the time where the run stands, and the edits.

use super::content::Content;
use super::{Group, Traces, write};
use crate::observe::marks::Marks;
use crate::observe::strip::Strip;
use crate::tui::theme::Role;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Style;

/// What marks the time of an edit, and the time where the run stands.
const EDIT: char = ':';
const PEN: char = '│';
const CURSOR: char = '┃';

impl Traces<'_> {
    /// The cursor: a line at its time, and the value there where it does not stand above the strip.
    pub(super) fn cursor(&self, content: Content, group: &Group, area: Rect, buf: &mut Buffer) {
        let Some((column, value)) = self.at_cursor(content, &group.strip) else {
            return;
        };
        let style = self.view.theme.style(Role::Focus);
        let column = (column / self.view.marker.dots().0) as u16;
        self.upright(column, CURSOR, style, area, buf);
        if group.beside > 0 {
            let width = value.len() as u16;
            let right = column + 2;
            let at = if right + width <= area.width {
                right
            } else {
                column.saturating_sub(width + 1)
            };
            write(area, (at, 0), &value, style, buf);
        }
    }

    /// The column (of dots) of the cursor on `strip`, and what `content` has there.
    pub(super) fn at_cursor(&self, content: Content, strip: &Strip) -> Option<(usize, String)> {
        let column = strip.column(self.cursor?.time_s)?;
        Some((column, self.words_at_cursor(content).unwrap_or_default()))
    }

    /// The pen: a line where the run stands.
    pub(super) fn pen(&self, strip: &Strip, area: Rect, buf: &mut Buffer) {
        let Some(column) = strip.column(self.run.now().time_s) else {
            return;
        };
        let column = (column / self.view.marker.dots().0 + 1) as u16;
        self.upright(column, PEN, self.view.theme.style(Role::Quiet), area, buf);
    }

    /// A dotted line where an edit was made.
    pub(super) fn edits(&self, marks: &Marks, strip: &Strip, area: Rect, buf: &mut Buffer) {
        let across = self.view.marker.dots().0;
        let places = marks.edits.iter().filter_map(|&at_s| strip.column(at_s));
        let style = self.view.theme.style(Role::Quiet);
        for column in places {
            self.upright((column / across) as u16, EDIT, style, area, buf);
        }
    }

    /// A line from top to bottom behind everything else.
    fn upright(&self, column: u16, sign: char, style: Style, area: Rect, buf: &mut Buffer) {
        if column >= area.width {
            return;
        }
        for y in area.top()..area.bottom() {
            let cell = buf.cell_mut((area.x + column, y));
            if let Some(cell) = cell.filter(|cell| cell.symbol() == " ") {
                cell.set_char(sign).set_style(style);
            }
        }
    }
}
