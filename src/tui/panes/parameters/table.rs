//! The table of readouts of the run and of the exact motion, side by side in the same units.

use super::{ValuesPane, with_minus};
use crate::engine::analysis::readouts::{Readout, ShownValue, ValueGroup, ValueRow, value_rows};
use crate::engine::run::Moment;
use crate::engine::text::number::{significant, uncertain};
use crate::engine::text::wrap::columns;
use crate::lab::values::list::Match;
use crate::tui::panes::{below_rule, write};
use crate::tui::theme::Role;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

/// Minimum width for two further columns.
const FURTHER_COLUMNS_FROM: u16 = 50;
/// Minimum width for long labels and for numbers with all their decimals.
const LONG_FROM: u16 = 28;
/// Minimum width of a column for an uncertainty.
const UNCERTAINTY_FROM: usize = 11;

#[derive(Clone, Copy, PartialEq, Eq)]
enum Column {
    Now,
    Exact,
    OffBy,
    AtCursor,
    ExactAtCursor,
}

pub(super) struct ValueTable<'p, 'a> {
    pub(super) pane: &'p ValuesPane<'a>,
}

/// Returns the columns of the labels, and of each number, in a table of two numbers on `width` columns.
pub(super) fn narrow_columns(width: u16) -> (u16, u16) {
    let numbers = if width < LONG_FROM { 7 } else { 8 };
    (width.saturating_sub(2 * numbers), numbers)
}

/// Returns the minimum rows of the table, and the maximum rows that it can use in a narrow pane.
pub(super) fn row_counts(pane: &ValuesPane<'_>) -> [u16; 2] {
    let rows = shown_rows(pane.searched());
    let least = rows.iter().filter(|(_, row)| row.rank == 0).count();
    let now = rows
        .iter()
        .filter(|(_, row)| row.group == ValueGroup::Now || !pane.searched().is_empty());
    [least as u16, now.count() as u16]
}

/// Returns the rows that match the search for `name`; all rows if it is empty.
fn shown_rows(name: &str) -> Vec<(&'static Readout, ValueRow)> {
    let rows = [ValueGroup::Now, ValueGroup::SoFar]
        .map(value_rows)
        .concat();
    let answer = |row: &ValueRow| Match::find(row.label, name);
    let best = rows.iter().filter_map(|(_, row)| answer(row)).min();
    let answers = rows
        .into_iter()
        .filter(|(_, row)| best.is_some() && answer(row) == best);
    answers.collect()
}

/// Returns the rows that fit in `height`, without those of the highest ranks.
fn fitting_rows(name: &str, height: usize) -> Vec<(&'static Readout, ValueRow)> {
    let mut rows = shown_rows(name);
    while rows.len() > height {
        let ranks = rows.iter().map(|(_, row)| row.rank).enumerate();
        let Some((last, _)) = ranks.max_by_key(|(_, rank)| *rank) else {
            break;
        };
        rows.remove(last);
    }
    rows
}

impl ValueTable<'_, '_> {
    pub(super) fn render(&self, area: Rect, buf: &mut Buffer) {
        if area.is_empty() {
            return;
        }
        let columns = self.columns(area.width);
        let (label_width, width) = match columns.len() {
            2 => narrow_columns(area.width),
            count => (21, area.width.saturating_sub(21) / count as u16),
        };
        self.heads(&columns, (label_width, width), area, buf);
        let below = below_rule(area);
        let rows = fitting_rows(self.pane.searched(), below.height.into());
        for ((readout, row), place) in rows.iter().zip(below.rows()) {
            self.row(readout, row, (&columns, label_width, width), place, buf);
        }
    }

    fn columns(&self, width: u16) -> Vec<Column> {
        match (width >= FURTHER_COLUMNS_FROM, self.pane.cursor.is_some()) {
            (false, false) => vec![Column::Now, Column::Exact],
            (false, true) => vec![Column::AtCursor, Column::ExactAtCursor],
            (true, false) => vec![Column::Now, Column::Exact, Column::OffBy],
            (true, true) => vec![
                Column::Now,
                Column::Exact,
                Column::AtCursor,
                Column::ExactAtCursor,
            ],
        }
    }

    /// Writes the heads of the columns on the rule, if the title leaves room.
    fn heads(
        &self,
        heads: &[Column],
        (label_width, width): (u16, u16),
        area: Rect,
        buf: &mut Buffer,
    ) {
        let theme = &self.pane.view.theme;
        let title = columns(&self.pane.title());
        for (index, head) in heads.iter().enumerate() {
            let (text, role) = self.head(*head);
            let end = label_width + width * (index as u16 + 1);
            let begin = end.saturating_sub(columns(&text) as u16 + 1);
            if usize::from(begin) > title + 1 || label_width < 9 {
                let x = write(area, (begin, 0), " ", theme.style(Role::Rule), buf);
                write(area, (x, 0), &text, theme.style(role).bold(), buf);
            }
        }
    }

    fn head(&self, column: Column) -> (String, Role) {
        match (column, self.pane.cursor) {
            (Column::Now, _) => ("now".to_owned(), Role::Text),
            (Column::Exact | Column::ExactAtCursor, _) => ("exact".to_owned(), Role::Exact),
            (Column::OffBy, _) => ("off by".to_owned(), Role::Text),
            (Column::AtCursor, Some((moment, _))) => (
                format!("◊ {} s", significant(moment.time_s, 4)),
                Role::Cursor,
            ),
            (Column::AtCursor, None) => (String::new(), Role::Cursor),
        }
    }

    fn row(
        &self,
        readout: &Readout,
        row: &ValueRow,
        (shown, label_width, width): (&[Column], u16, u16),
        area: Rect,
        buf: &mut Buffer,
    ) {
        let pane = self.pane;
        let is_wide = shown.len() > 2;
        let now = self.read(readout, row, (pane.now, pane.exact));
        let at_cursor = pane.cursor.map(|cursor| self.read(readout, row, cursor));
        let label = self.label(row, readout, now.unit, label_width);
        pane.label(label, now.unit, label_width, area, buf);
        for (index, column) in shown.iter().enumerate() {
            let value = match column {
                Column::Now | Column::Exact | Column::OffBy => Some(&now),
                // A measured value belongs to the whole run, not to a time.
                Column::AtCursor | Column::ExactAtCursor if is_wide && !row.is_of_moment() => None,
                Column::AtCursor | Column::ExactAtCursor => at_cursor.as_ref(),
            };
            let cell =
                value.and_then(|value| self.cell(*column, row, value, usize::from(width) - 1));
            let Some((text, role)) = cell else { continue };
            let end = label_width + width * (index as u16 + 1);
            let begin = end.saturating_sub(columns(&text) as u16);
            write(area, (begin, 0), &text, pane.view.theme.style(role), buf);
        }
    }

    /// Returns the label of `row` in a column of this width, with its unit if both fit.
    ///
    /// The units of times and rates change, so they are always shown, and the label is cut instead.
    fn label(
        &self,
        row: &ValueRow,
        readout: &Readout,
        unit: &'static str,
        width: u16,
    ) -> &'static str {
        let room = usize::from(width);
        let unit = match columns(self.pane.unit(unit)) {
            0 => 0,
            unit => unit + 1,
        };
        let has_own_unit = ["s", "rad/s"].contains(&readout.unit);
        let is_long = width > 9 && columns(row.label) > columns(row.short_label) + 4;
        let unit_room = if is_long && !has_own_unit { 0 } else { unit };
        if columns(row.label) + unit_room <= room {
            row.label
        } else if has_own_unit {
            let most = room.saturating_sub(unit);
            row.short_label.get(..most).unwrap_or(row.short_label)
        } else {
            row.short_label
        }
    }

    fn read(
        &self,
        readout: &Readout,
        row: &ValueRow,
        moments: (&Moment, Option<&Moment>),
    ) -> ShownValue {
        let (run, exact) = moments;
        let value = row.read(readout, self.pane.readouts, run, exact);
        if self.pane.hides_exact() {
            return ShownValue {
                exact: None,
                is_off: false,
                ..value
            };
        }
        value
    }

    /// Returns the text of a cell on at most `width` columns, or `None` if it is empty.
    fn cell(
        &self,
        column: Column,
        row: &ValueRow,
        value: &ShownValue,
        width: usize,
    ) -> Option<(String, Role)> {
        let off = if value.is_off { Role::Off } else { Role::Text };
        let text = match column {
            Column::Now | Column::AtCursor => match value.run {
                Some(run) => (self.with_uncertainty(row, value, run, width), off),
                None if value.has_none => ("none".to_owned(), Role::Text),
                None => ("–".to_owned(), Role::Text),
            },
            Column::Exact | Column::ExactAtCursor => match value.exact {
                Some(exact) => (row.written(exact, width), Role::Exact),
                None if value.has_none && !self.pane.hides_exact() => {
                    ("none".to_owned(), Role::Exact)
                }
                None => return None,
            },
            Column::OffBy => {
                let difference = value.run? - value.exact?;
                (row.difference(difference, width), off)
            }
        };
        Some((with_minus(text.0), text.1))
    }

    fn with_uncertainty(
        &self,
        row: &ValueRow,
        value: &ShownValue,
        run: f64,
        width: usize,
    ) -> String {
        let stated = value.uncertainty.filter(|_| width + 1 >= UNCERTAINTY_FROM);
        let text = stated
            .and_then(|stated| uncertain(run, stated))
            .map(|stated| stated.to_string());
        text.filter(|text| text.len() <= width)
            .unwrap_or_else(|| row.written(run, width))
    }
}
