//! The values of the scenario: the most important ones or, while the pane has the focus, the whole list with a
//! selection.

use super::{ListPlace, ValuesPane, with_minus};
use crate::engine::analysis::readouts::four_digits;
use crate::engine::text::number::shortest;
use crate::engine::text::printable::printable;
use crate::engine::text::wrap::columns;
use crate::lab::form::InputField;
use crate::lab::values::list::{ListedValue, MAIN_GROUPS, ValueList};
use crate::tui::panes::{rule, shortened, write};
use crate::tui::split::split_columns;
use crate::tui::theme::Role;
use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use std::iter;

/// Columns of a field.
const FIELD: u16 = 7;
/// Columns between two lists.
const GAP: u16 = 2;
/// Columns of the longest number that is not rounded.
const MOST_DIGITS: usize = 12;
/// Minimum width for a long heading, columns.
const LONG_HEADING_FROM: u16 = 27;

pub(super) struct Editor<'p, 'a> {
    pub(super) pane: &'p ValuesPane<'a>,
    pub(super) place: ListPlace,
}

/// A row of the list.
#[derive(Clone, Copy)]
enum EditorRow<'a> {
    Blank,
    Heading(&'a str),
    /// A value, its number in the list, and a flag for the selection.
    Value(&'a ListedValue, usize, bool),
    /// Message that no value matches the search.
    Nothing,
}

impl EditorRow<'_> {
    fn is_heading(&self) -> bool {
        matches!(self, Self::Heading(_))
    }

    fn is_selected(&self) -> bool {
        matches!(self, Self::Value(_, _, true))
    }
}

/// Returns the rows of the first group of values that are always shown, including its heading.
pub(super) fn main_rows(list: &ValueList) -> u16 {
    let first = list
        .values
        .iter()
        .filter(|value| value.rank.is_some() && value.group == MAIN_GROUPS[0]);
    first.count() as u16 + 1
}

impl Editor<'_, '_> {
    pub(super) fn render(&self, buf: &mut Buffer) {
        for (place, row) in self.rows() {
            self.row(&row, place, buf);
        }
    }

    /// Returns the number, in the list of values, of the value at the cell `at`.
    pub(super) fn value_at(&self, at: Position) -> Option<usize> {
        let mut rows = self.rows().into_iter();
        let (_, row) = rows.find(|(place, _)| place.contains(at))?;
        match row {
            EditorRow::Value(_, index, _) => Some(index),
            EditorRow::Blank | EditorRow::Heading(_) | EditorRow::Nothing => None,
        }
    }

    /// Returns the visible rows, each with its area.
    fn rows(&self) -> Vec<(Rect, EditorRow<'_>)> {
        let ListPlace { area, columns, .. } = self.place;
        if area.is_empty() || columns == 0 {
            return Vec::new();
        }
        let height = area.height.into();
        let lists = if self.pane.has_focus() {
            self.in_focus(height)
        } else {
            self.most_important(height)
        };
        let mut rows = Vec::with_capacity(height);
        let mut rest = area;
        for list in lists {
            let [mut place, right] = split_columns(rest, area.width / columns);
            if !right.is_empty() {
                place.width = place.width.saturating_sub(GAP);
            }
            rows.extend(place.rows().zip(list));
            rest = right;
        }
        rows
    }

    /// Returns as many of the main values as fit.
    fn most_important(&self, height: usize) -> Vec<Vec<EditorRow<'_>>> {
        let values = self.pane.list.values.iter().enumerate();
        let mut groups = MAIN_GROUPS.map(|group| {
            let of_group = values
                .clone()
                .filter(|(_, value)| value.rank.is_some() && value.group == group);
            of_group.collect::<Vec<_>>()
        });
        if self.place.columns > 1 {
            return groups
                .iter_mut()
                .zip(MAIN_GROUPS)
                .map(|(group, heading)| {
                    with_heading(heading, keep_best(group, height.saturating_sub(1)))
                })
                .collect();
        }
        let [start, body] = &mut groups;
        let mut rows = with_heading(MAIN_GROUPS[0], keep_best(start, height.saturating_sub(1)));
        // Leave room for a blank row and a heading.
        let left = height.saturating_sub(rows.len() + 2);
        if left >= 2 && !body.is_empty() {
            rows.push(EditorRow::Blank);
            rows.extend(with_heading(MAIN_GROUPS[1], keep_best(body, left)));
        }
        vec![rows]
    }

    /// Returns the values that match the search, as many as fit around the selected one.
    fn in_focus(&self, height: usize) -> Vec<Vec<EditorRow<'_>>> {
        let list = self.pane.list;
        let shown = list.shown();
        let mut rows = Vec::with_capacity(2 * shown.len());
        for group in shown.chunk_by(|(_, a), (_, b)| a.group == b.group) {
            let heading = group
                .first()
                .map(|(_, value)| EditorRow::Heading(&value.group));
            rows.extend(heading);
            let values = group.iter().map(|(index, value)| {
                EditorRow::Value(value, *index, *index == list.selected_index())
            });
            rows.extend(values);
        }
        if rows.is_empty() && !list.name.is_empty() {
            rows.push(EditorRow::Nothing);
        }
        if let Some(columns) = by_group(&rows, height, self.place.columns.into()) {
            return columns;
        }
        if self.place.columns == 1 {
            return vec![around_selected(&rows, height)];
        }
        // Each column begins with the heading of its first value.
        let room = height.saturating_sub(1).max(1);
        around_selected(&rows, room * usize::from(self.place.columns))
            .chunks(room)
            .map(with_own_heading)
            .collect()
    }

    fn row(&self, row: &EditorRow<'_>, area: Rect, buf: &mut Buffer) {
        let theme = &self.pane.view.theme;
        match row {
            EditorRow::Blank => {}
            EditorRow::Heading(heading) => self.heading(heading, area, buf),
            EditorRow::Value(value, _, is_selected) => self.value(value, *is_selected, area, buf),
            EditorRow::Nothing => {
                write(
                    area,
                    (0, 0),
                    "no editable value",
                    theme.style(Role::Label),
                    buf,
                );
            }
        }
    }

    /// Draws a rule with `heading`. At its right it has the key that finds a value, or the number of the selected value
    /// if the pane has the focus.
    fn heading(&self, heading: &str, area: Rect, buf: &mut Buffer) {
        let pane = self.pane;
        let title = match heading {
            first if first == MAIN_GROUPS[0] && area.width < LONG_HEADING_FROM => "start",
            other => other,
        };
        let is_of_selected = pane
            .list
            .selected()
            .is_some_and(|value| value.group == heading);
        let hint = match (pane.has_focus(), heading == MAIN_GROUPS[0]) {
            (true, _) if is_of_selected => place_in_list(pane.list),
            (false, true) => "/ find".to_owned(),
            _ => String::new(),
        };
        let right = Some((hint.as_str(), Role::Label)).filter(|(hint, _)| !hint.is_empty());
        rule(title, right, false, area, &pane.view.theme, buf);
    }

    fn value(&self, value: &ListedValue, is_selected: bool, area: Rect, buf: &mut Buffer) {
        let pane = self.pane;
        let theme = &pane.view.theme;
        let end = self.place.value_end.min(area.width);
        let label = on_one_line(&value.label);
        let label_room = end
            .saturating_sub(columns(&label) as u16 + 1)
            .max(FIELD.min(end));
        if let Some(field) = pane.field.filter(|_| is_selected) {
            let width = label_room.min(2 * FIELD);
            pane.label(
                &label,
                value.unit,
                (end - width).saturating_sub(1),
                area,
                buf,
            );
            let place = Rect {
                x: area.x + end - width,
                width,
                ..area
            };
            return self.field(field, place, buf);
        }
        let text = with_minus(shown_text(value, label_room.into()));
        let length = columns(&text) as u16;
        let width = if value.is_settable {
            length.max(FIELD.min(end))
        } else {
            length
        };
        pane.label(&label, value.unit, end.saturating_sub(width + 1), area, buf);
        let role = match (is_selected, value.is_settable) {
            (true, _) => Role::Selected,
            (false, true) => Role::Editable,
            (false, false) => Role::Text,
        };
        let field = format!("{text:>width$}", width = usize::from(width));
        write(
            area,
            (end.saturating_sub(width), 0),
            &field,
            theme.style(role),
            buf,
        );
    }

    /// Draws the field of the edited value: the end of its text, with the cursor.
    fn field(&self, field: &InputField, area: Rect, buf: &mut Buffer) {
        let style = self.pane.view.theme.style(Role::Selected);
        let blank = " ".repeat(area.width.into());
        write(area, (0, 0), &blank, style, buf);
        let before: String = field.text().chars().take(field.cursor()).collect();
        let after: String = field.text().chars().skip(field.cursor()).collect();
        let text = format!("{before}_{after}");
        let room = usize::from(area.width);
        let skipped = (columns(&before) + 1)
            .saturating_sub(room)
            .max(columns(&text).saturating_sub(room).min(columns(&before)));
        let shown: String = text.chars().skip(skipped).take(room).collect();
        let begin = area.width.saturating_sub(columns(&shown) as u16);
        write(area, (begin, 0), &shown, style, buf);
    }
}

/// Returns the number of the selected value among the visible ones, and their count.
fn place_in_list(list: &ValueList) -> String {
    let shown = list.shown();
    let at = shown
        .iter()
        .position(|(index, _)| *index == list.selected_index());
    format!("{} of {}", at.map_or(0, |at| at + 1), shown.len())
}

/// A value with its number in the list.
type NumberedValue<'a> = (usize, &'a ListedValue);

fn with_heading<'a>(heading: &'a str, values: &[NumberedValue<'a>]) -> Vec<EditorRow<'a>> {
    let rows = values
        .iter()
        .map(|(index, value)| EditorRow::Value(value, *index, false));
    iter::once(EditorRow::Heading(heading))
        .chain(rows)
        .collect()
}

/// Removes values of the highest rank until the rest fit in `room`.
fn keep_best<'v, 'a>(
    values: &'v mut Vec<NumberedValue<'a>>,
    room: usize,
) -> &'v [NumberedValue<'a>] {
    while values.len() > room {
        let ranks = values.iter().map(|(_, value)| value.rank).enumerate();
        let last = ranks.max_by_key(|(_, rank)| *rank);
        let Some((last, _)) = last else { break };
        values.remove(last);
    }
    values
}

/// Returns `rows` in at most `most` columns of at most `height` that each begin with a heading. Returns `None` if they
/// do not fit.
fn by_group<'a>(
    rows: &[EditorRow<'a>],
    height: usize,
    most: usize,
) -> Option<Vec<Vec<EditorRow<'a>>>> {
    let mut columns: Vec<Vec<EditorRow<'a>>> = vec![Vec::new()];
    for group in rows.chunk_by(|_, next| !next.is_heading()) {
        let column = columns.last_mut()?;
        if column.is_empty() || column.len() + group.len() <= height {
            column.extend_from_slice(group);
        } else {
            columns.push(group.to_vec());
        }
    }
    let fits = columns.len() <= most && columns.iter().all(|column| column.len() <= height);
    fits.then_some(columns)
}

/// Returns `rows` below the heading of the first value, unless the first is a heading itself.
fn with_own_heading<'a>(rows: &[EditorRow<'a>]) -> Vec<EditorRow<'a>> {
    let heading = rows.first().and_then(|first| match first {
        EditorRow::Value(value, ..) => Some(EditorRow::Heading(&value.group)),
        EditorRow::Blank | EditorRow::Heading(_) | EditorRow::Nothing => None,
    });
    heading.into_iter().chain(rows.iter().copied()).collect()
}

/// Returns the `room` rows around the selected one, with the heading of its group.
fn around_selected<'a>(rows: &[EditorRow<'a>], room: usize) -> Vec<EditorRow<'a>> {
    let selected = rows.iter().position(EditorRow::is_selected).unwrap_or(0);
    let most = rows.len().saturating_sub(room);
    let first = selected.saturating_sub(room / 2).min(most);
    let end = (first + room).min(rows.len());
    let mut shown = rows[first..end].to_vec();
    let before = rows.get(..=selected).unwrap_or(rows);
    let heading = before.iter().rposition(EditorRow::is_heading);
    if let (Some(top), Some(heading)) = (shown.first_mut(), heading)
        && heading < first
        && !top.is_selected()
    {
        *top = rows[heading];
    }
    shown
}

/// Returns the text of `value` on at most `room` columns: all given digits if they fit, else four.
fn shown_text(value: &ListedValue, room: usize) -> String {
    let text = on_one_line(&value.text);
    let field = room.min(MOST_DIGITS);
    match text.parse::<f64>() {
        Ok(number) if text.len() > field => four_digits(number, field.min(FIELD.into())),
        Ok(number) if text.contains(['.', 'e']) => shortest(number),
        _ => shortened(&text, room).into_owned(),
    }
}

/// Returns `text` on one line and printable.
fn on_one_line(text: &str) -> String {
    printable(&text.replace('\n', " ")).into_owned()
}
