//! A form, drawn over the bottom of the panes.

use super::{below_rule, popup_rule, wrapped_to, write};
use crate::engine::text::wrap::{columns, wrapped};
use crate::lab::form::{InputField, InputForm};
use crate::lab::view::theme::Theme;
use crate::tui::split::{split_columns, split_rows};
use crate::tui::theme::Role;
use ratatui::buffer::Buffer;
use ratatui::layout::{Margin, Position, Rect};
use ratatui::widgets::{Clear, Widget};

const FORM_WIDTH: u16 = 80;
/// Minimum height and width for a frame, cells.
const LEAST_FRAMED: u16 = 3;
/// Maximum number of lines of an error message.
const MOST_COMPLAINT: usize = 3;

/// A form over the panes, at the bottom of its area and only as high as necessary.
pub struct FormPane<'a> {
    pub form: &'a InputForm,
    pub theme: &'a Theme,
}

enum FormLine<'a> {
    Field(usize, &'a InputField),
    Text(String, Role),
}

impl Widget for FormPane<'_> {
    fn render(self, area: Rect, buf: &mut Buffer) {
        let Some(PlacedForm {
            lines,
            place,
            is_framed,
        }) = self.placed(area)
        else {
            return;
        };
        // A blank column at each side separates the form from the panes.
        Clear.render(place.outer(Margin::new(1, 0)).intersection(area), buf);
        let inside = if is_framed {
            popup_rule(&self.form.title, place, self.theme, buf)
        } else {
            place
        };
        for (line, row) in lines.iter().zip(inside.rows()) {
            match line {
                FormLine::Text(text, role) => {
                    write(row, (0, 0), text, self.theme.style(*role), buf);
                }
                FormLine::Field(index, field) => {
                    self.field(*index == self.form.selected, field, row, buf);
                }
            }
        }
    }
}

/// Lines of a form, and their area.
struct PlacedForm<'a> {
    lines: Vec<FormLine<'a>>,
    place: Rect,
    /// True if there is room for the title.
    is_framed: bool,
}

impl FormPane<'_> {
    /// Returns the number of the field at the cell `at` of the screen if the form is drawn on `area`.
    pub fn field_at(&self, area: Rect, at: Position) -> Option<usize> {
        let placed = self.placed(area)?;
        let inside = if placed.is_framed {
            below_rule(placed.place)
        } else {
            placed.place
        };
        let line = inside.contains(at).then(|| usize::from(at.y - inside.y))?;
        match placed.lines.get(line)? {
            FormLine::Field(index, _) => Some(*index),
            FormLine::Text(..) => None,
        }
    }

    /// Returns the form at the bottom of `area`, or `None` if there is no room.
    fn placed(&self, area: Rect) -> Option<PlacedForm<'_>> {
        let width = area.width.min(FORM_WIDTH);
        let x = area.x + (area.width - width) / 2;
        let middle = Rect { x, width, ..area };
        if middle.is_empty() {
            return None;
        }
        let is_framed = middle.height >= LEAST_FRAMED && width >= LEAST_FRAMED;
        let border = if is_framed { 1 } else { 0 };
        let lines = self.lines(width, (middle.height - border) as usize);
        let [_, place] = split_rows(middle, middle.height - lines.len() as u16 - border);
        Some(PlacedForm {
            lines,
            place,
            is_framed,
        })
    }

    /// Returns the lines that fit in `height`.
    ///
    /// Priority: the selected field and a line of the error message, the other fields, the rest of the message, the
    /// keys, the information.
    fn lines(&self, width: u16, height: usize) -> Vec<FormLine<'_>> {
        let (form, width) = (self.form, usize::from(width));
        let mut room = height;
        let reserved = usize::from(form.complaint.is_some() && height > 1);
        room -= reserved;
        let fields = take_rows(&mut room, form.fields.len());
        room += reserved;
        let most = room.min(MOST_COMPLAINT);
        let complaint: Vec<_> = form
            .complaint
            .iter()
            .flat_map(|text| wrapped_to(text, width, most))
            .collect();
        room -= complaint.len();
        let keys = wrapped(form.keys, width).len();
        let keys = wrapped_to(form.keys, width, take_rows(&mut room, keys));
        let mut info: Vec<_> = form
            .info
            .iter()
            .flat_map(|text| wrapped(text, width))
            .collect();
        info.truncate(take_rows(&mut room, info.len()));
        // Start so that the selected field is visible.
        let first = (form.selected + 1).saturating_sub(fields);
        let fields = form.fields.iter().enumerate().skip(first).take(fields);
        let mut lines: Vec<_> = fields
            .map(|(at, field)| FormLine::Field(at, field))
            .collect();
        lines.extend(
            info.into_iter()
                .map(|text| FormLine::Text(text, Role::Label)),
        );
        lines.extend(
            complaint
                .into_iter()
                .map(|text| FormLine::Text(text, Role::Off)),
        );
        lines.extend(
            keys.into_iter()
                .map(|text| FormLine::Text(text, Role::Label)),
        );
        lines
    }

    /// Draws a field: the label in a column as wide as the widest label, then the text.
    fn field(&self, is_selected: bool, field: &InputField, area: Rect, buf: &mut Buffer) {
        let labels = self.form.fields.iter().map(|other| columns(&other.label));
        let widest = labels.max().unwrap_or(0) as u16 + 1;
        let [label, room] = split_columns(area, widest.min(area.width / 2));
        let [label, _] = split_columns(label, label.width.saturating_sub(1));
        let role = if is_selected {
            Role::Heading
        } else {
            Role::Label
        };
        write(label, (0, 0), &field.label, self.theme.style(role), buf);
        self.text(is_selected, field, room, buf);
    }

    /// Draws the visible part of the text, with the cursor if the field is selected.
    fn text(&self, is_selected: bool, field: &InputField, area: Rect, buf: &mut Buffer) {
        if area.is_empty() {
            return;
        }
        let chars: Vec<char> = field.text().chars().collect();
        let cursor = if is_selected { field.cursor() } else { 0 };
        let first = first_shown(&chars, cursor, area.width as usize);
        let is_marked = is_selected && field.is_marked();
        let role = if is_marked {
            Role::Selected
        } else {
            Role::Editable
        };
        let style = self.theme.style(role);
        let shown: String = chars[first..].iter().collect();
        buf.set_stringn(area.x, area.y, &shown, area.width as usize, style);
        if !is_selected {
            return;
        }
        let before: String = chars[first..cursor.min(chars.len())].iter().collect();
        let at = area.x + columns(&before) as u16;
        if at >= area.right() {
            return;
        }
        match chars.get(cursor) {
            Some(_) if is_marked => {}
            Some(_) => {
                let cell = Rect::new(at, area.y, 1, 1);
                buf.set_style(cell, self.theme.style(Role::Selected));
            }
            None => {
                buf.set_stringn(at, area.y, "_", 1, self.theme.style(Role::Heading));
            }
        }
    }
}

/// Takes up to `wanted` lines from `room` and returns their number.
fn take_rows(room: &mut usize, wanted: usize) -> usize {
    let rows = wanted.min(*room);
    *room -= rows;
    rows
}

/// Returns the first visible one of `chars` on `width` columns, so that the one at `cursor` is visible.
fn first_shown(chars: &[char], cursor: usize, width: usize) -> usize {
    let mut first = cursor.min(chars.len());
    let at_cursor = chars.get(first).map_or(1, |&c| wide(c).max(1));
    let mut room = width.saturating_sub(at_cursor);
    while first > 0 && wide(chars[first - 1]) <= room {
        first -= 1;
        room -= wide(chars[first]);
    }
    first
}

fn wide(c: char) -> usize {
    columns(c.encode_utf8(&mut [0; 4]))
}
