//! The scenario's values and the readouts, each with its unit, in fixed columns.
//!
//! In focus it is an editor: the values one by one above, one of them selected, and the readouts to watch below.

mod edited;
mod lines;

use super::{PaneRow, Width, frame, shortened, write};
use crate::lab::action::Action;
use crate::lab::values::list::ValueList;
use crate::lab::view::{Pane, Part, View};
use crate::observe::reading::Reading;
use crate::scenario::{Motion, Scenario};
use crate::text::wrap::columns;
use crate::tui::keymap::{Binding, Key, Mode, row};
use crate::tui::theme::Role;
use edited::{around_selected, edited_rows, fewer_digits, key_lines, needed, title};
use lines::{
    COLUMN, PREDICTED, Row, VALUE_END, body_rows, derived_rows, further_rows, heading, motion_rows,
    now_rows, start_rows, watched_rows,
};
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::widgets::Widget;

/// Column of units.
const UNIT: u16 = 19;
/// How many columns of values that can be edited stand side by side at most; the readouts have one more.
const MOST_EDITED: u16 = 6;
/// What marks the selected line, and a list that goes on above or below.
const SELECTED: &str = "►";
const ABOVE: &str = "▲";
const BELOW: &str = "▼";
/// From this height on the readouts to watch have a place below the editor's lines.
const WATCHED_FROM: usize = 8;

/// Its row in the table of panes.
pub const ROW: PaneRow = PaneRow {
    id: Pane::PARAMETERS,
    title: "parameters",
    width: Width::Fixed,
    rank: 2,
    least: (COLUMN, 0),
    draw: |lab, area, buf| {
        Parameters {
            scenario: lab.player().run().scenario(),
            motion: &lab.player().motion(),
            reading: lab.player().reading(),
            list: lab.values().list(),
            is_searched: lab.on_top().mode() == Mode::Find,
            view: lab.view(),
        }
        .render(area, buf);
    },
    keys: KEYS,
};

/// The keys that the footer names while the pane has the focus.
#[rustfmt::skip]
const KEYS: &[Binding] = &[
    row(&[Mode::Lab], &[Key::Char('/')], Action::FindValue, "find", "find a value by a part of its name; Esc shows all again"),
];

/// The values of a scenario and of its run.
pub struct Parameters<'a> {
    /// The scenario.
    pub scenario: &'a Scenario,
    /// Gravity, scheme and time step as they are now: edits may have changed them.
    pub motion: &'a Motion,
    /// The latest reading of its run.
    pub reading: &'a Reading,
    /// The values that can be edited.
    pub list: &'a ValueList,
    /// Whether a part of a name is being typed, to find a value.
    pub is_searched: bool,
    /// How it is looked at.
    pub view: &'a View,
}

impl Widget for Parameters<'_> {
    fn render(self, area: Rect, buf: &mut Buffer) {
        let focus = self.view.focus == ROW.id;
        let list = Some(self.list).filter(|_| focus);
        let inside = frame(
            &title(list, self.is_searched),
            area,
            focus,
            &self.view.theme,
            buf,
        );
        if inside.is_empty() {
            return;
        }
        match (list, self.view.filled) {
            (Some(list), true) => self.edited_and_read(list, inside, buf),
            (Some(list), false) => self.edited_above_read(list, inside, buf),
            (None, _) => self.most_important(inside, buf),
        }
    }
}

impl Parameters<'_> {
    /// Columns of lines, each `wide` columns of the screen.
    fn columns<'r>(
        &self,
        columns: impl Iterator<Item = &'r [Row]>,
        wide: u16,
        area: Rect,
        buf: &mut Buffer,
    ) {
        for (rows, column) in columns.zip(0..MOST_EDITED) {
            let place = Rect {
                x: area.x + column * wide,
                width: area.width.saturating_sub(column * wide).min(wide),
                ..area
            };
            self.lines_of(rows, wide, place, buf);
        }
    }

    /// The lines there is room for, and how to see the others.
    fn most_important(&self, area: Rect, buf: &mut Buffer) {
        let mut rows = self.rows();
        if rows.len() <= area.height as usize {
            let further = without_dashes(further_rows(self.reading));
            rows.extend(shown(self.view, further));
            let rows = fitting(rows, area.height as usize);
            return self.lines(&rows, area, buf);
        }
        let (lines, note) = above_last(area);
        let rows = fitting(rows, lines.height as usize);
        self.lines(&rows, lines, buf);
        self.note("e, then f: all of them", note, buf);
    }

    /// The values to edit above, the key of the selected one, and the readouts to watch below.
    fn edited_above_read(&self, list: &ValueList, area: Rect, buf: &mut Buffer) {
        let height = area.height as usize;
        let edited = edited_rows(list);
        let spare = height.saturating_sub(edited.len() + 1);
        let room = match height {
            WATCHED_FROM.. => spare.max(height * 2 / 5),
            _ => 0,
        };
        let read = match list.name() {
            "" => read_rows(self.view, self.reading, room),
            name => self.found(name, room),
        };
        let lower = read.len() as u16;
        let upper = Rect {
            height: area.height - lower,
            ..area
        };
        self.edited(&edited, list, upper, (1, COLUMN), buf);
        let lower = Rect {
            y: upper.bottom(),
            height: lower,
            ..area
        };
        self.lines(&read, lower, buf);
    }

    /// The values to edit in columns, and the readouts in one more.
    fn edited_and_read(&self, list: &ValueList, area: Rect, buf: &mut Buffer) {
        let count = (area.width / COLUMN).saturating_sub(1).min(MOST_EDITED);
        if count == 0 {
            return self.edited_above_read(list, area, buf);
        }
        let read = match list.name() {
            "" => {
                let mut read = derived_rows(self.scenario);
                read.extend(shown(self.view, now_rows(self.reading)));
                read
            }
            name => self.found(name, usize::MAX),
        };
        let edited = edited_rows(list);
        let height = area.height.saturating_sub(1) as usize;
        let grouped = by_group(&edited, height).map_or(usize::MAX, |columns| columns.len());
        let count = grouped.min(count as usize) as u16;
        let most = (area.width - COLUMN) / count;
        let wide = edited.iter().map(needed).max().unwrap_or(COLUMN);
        let wide = wide.clamp(COLUMN, most.max(COLUMN));
        let width = wide * count;
        let place = Rect { width, ..area };
        self.edited(&edited, list, place, (count, wide), buf);
        let right = Rect {
            x: area.x + width,
            width: area.width - width,
            ..area
        };
        let rows = fitting(read, right.height as usize);
        self.lines(&rows, right, buf);
    }

    /// The numbers that cannot be edited and have `name` in theirs, with what theory predicts for them, in `room` lines.
    fn found(&self, name: &str, room: usize) -> Vec<Row> {
        let mut rows = derived_rows(self.scenario);
        rows.extend(shown(self.view, now_rows(self.reading)));
        rows.extend(shown(self.view, further_rows(self.reading)));
        let name = name.to_lowercase();
        let mut is_found = false;
        rows.retain(|row| {
            let label = row.label.to_lowercase();
            let is_of_row_above = is_found && row.label == PREDICTED;
            is_found = !row.is_heading()
                && (is_of_row_above || name.split_whitespace().all(|word| label.contains(word)));
            is_found
        });
        if !rows.is_empty() {
            rows.insert(0, heading("not to be set"));
        }
        rows.truncate(room);
        rows
    }

    /// `rows` of `list` in `count` columns, each `wide` columns of the screen: as many as there is room for around the
    /// selected one, and below them what `--set` takes for it, with all its digits.
    fn edited(
        &self,
        rows: &[Row],
        list: &ValueList,
        area: Rect,
        (count, wide): (u16, u16),
        buf: &mut Buffer,
    ) {
        let mut lines = area;
        let notes = list
            .selected()
            .map(|value| key_lines(value, area.width as usize));
        for note in notes.into_iter().flatten().rev() {
            if lines.height > 1 {
                let (above, last) = above_last(lines);
                self.note(&note, last, buf);
                lines = above;
            }
        }
        let height = lines.height as usize;
        let grouped = by_group(rows, height).filter(|columns| columns.len() <= count as usize);
        if let Some(columns) = grouped {
            return self.columns(columns.into_iter(), wide, lines, buf);
        }
        let room = height * count as usize;
        let (shown, above, below) = around_selected(rows, room);
        self.columns(shown.chunks(height.max(1)), wide, lines, buf);
        // On the frame, or where columns of lines are empty.
        let x = match self.view.filled && area.width == count * wide {
            true => area.right() - 1,
            false => area.right(),
        };
        self.hint(above, (x, lines.y), ABOVE, buf);
        self.hint(below, (x, lines.bottom().saturating_sub(1)), BELOW, buf);
    }

    /// Says at `place` that a list goes on, where it does.
    fn hint(&self, goes_on: bool, place: (u16, u16), sign: &str, buf: &mut Buffer) {
        if let Some(cell) = buf.cell_mut(place).filter(|_| goes_on) {
            cell.set_symbol(sign)
                .set_style(self.view.theme.style(Role::Focus));
        }
    }

    fn note(&self, text: &str, area: Rect, buf: &mut Buffer) {
        write(area, (0, 0), text, self.view.theme.style(Role::Quiet), buf);
    }

    fn lines(&self, rows: &[Row], area: Rect, buf: &mut Buffer) {
        self.lines_of(rows, COLUMN, area, buf);
    }

    /// `rows` in lines that are `wide` columns.
    fn lines_of(&self, rows: &[Row], wide: u16, area: Rect, buf: &mut Buffer) {
        for (row, y) in rows.iter().zip(0..area.height) {
            let line = Rect {
                y: area.y + y,
                height: 1,
                ..area
            };
            self.line(row, VALUE_END + wide - COLUMN, line, buf);
        }
    }

    /// One line; `value_end` is the column of the last character of its value.
    fn line(&self, row: &Row, value_end: u16, area: Rect, buf: &mut Buffer) {
        let theme = &self.view.theme;
        let indent = u16::from(!row.is_heading());
        let label = theme.style(row.label_role);
        let end = write(area, (indent, 0), &row.label, label, buf);
        let room = value_end.saturating_sub(end + 1) as usize;
        let value = fewer_digits(&row.value, room);
        let style = theme.style(row.value_role);
        if row.unit.is_empty() && columns(&value) > room {
            // Words have no unit beside them.
            write(area, (end + 1, 0), &value, style, buf);
        } else {
            let value = shortened(&value, room);
            let begin = value_end.saturating_sub(columns(&value) as u16);
            write(area, (begin, 0), &value, style, buf);
        }
        let unit = value_end + UNIT - VALUE_END;
        write(area, (unit, 0), &row.unit, theme.style(Role::Quiet), buf);
        if row.is_selected {
            write(area, (0, 0), SELECTED, theme.style(Role::Focus), buf);
            buf.set_style(area, theme.style(Role::Selected));
        }
    }

    fn rows(&self) -> Vec<Row> {
        let mut rows = Vec::with_capacity(32);
        rows.extend(body_rows(self.scenario));
        rows.extend(start_rows(self.scenario));
        rows.extend(motion_rows(self.scenario, self.motion));
        rows.extend(shown(self.view, now_rows(self.reading)));
        rows
    }
}

/// The readouts for `room` lines: all of them, or those to watch.
fn read_rows(view: &View, reading: &Reading, room: usize) -> Vec<Row> {
    let all = shown(view, now_rows(reading));
    if all.len() <= room {
        return all;
    }
    let mut watched = vec![heading("now")];
    watched.extend(shown(view, watched_rows(reading).into()));
    let mut rows = fitting(watched, room);
    rows.truncate(room);
    rows
}

/// `rows` without those that are hidden.
fn shown(view: &View, mut rows: Vec<Row>) -> Vec<Row> {
    if view.hides(Part::Predicted) {
        rows.retain(|row| row.label != PREDICTED);
    }
    rows
}

/// `area` without its last line, and that line.
fn above_last(area: Rect) -> (Rect, Rect) {
    let height = area.height.saturating_sub(1);
    let last = Rect {
        y: area.y + height,
        height: area.height - height,
        ..area
    };
    (Rect { height, ..area }, last)
}

/// `rows` in columns of at most `height` that begin with a heading; `None` where a group is higher than that.
fn by_group(rows: &[Row], height: usize) -> Option<Vec<&[Row]>> {
    let mut columns = Vec::new();
    let (mut begin, mut end) = (0, 0);
    for group in rows.chunk_by(|_, next| !next.is_heading()) {
        if end + group.len() - begin > height {
            columns.push(&rows[begin..end]);
            begin = end;
        }
        end += group.len();
    }
    columns.push(&rows[begin..]);
    columns
        .iter()
        .all(|rows| rows.len() <= height)
        .then_some(columns)
}

/// The lines for which there is room, the least important left out.
fn fitting(mut rows: Vec<Row>, room: usize) -> Vec<Row> {
    while rows.len() > room {
        let ranks = rows.iter().map(|row| row.rank).enumerate();
        match ranks.max_by_key(|&(_, rank)| rank) {
            Some((index, 1..)) => drop(rows.remove(index)),
            _ => break, // all of it matters: the rest is cut off
        }
        rows = without_empty_groups(rows);
    }
    rows
}

/// `rows` without those that have no value, the headings kept.
fn without_dashes(mut rows: Vec<Row>) -> Vec<Row> {
    rows.retain(|row| row.is_heading() || row.value != "-");
    without_empty_groups(rows)
}

/// No heading stands alone.
fn without_empty_groups(rows: Vec<Row>) -> Vec<Row> {
    let alone =
        |index: usize| rows[index].is_heading() && rows.get(index + 1).is_none_or(Row::is_heading);
    let keep: Vec<bool> = (0..rows.len()).map(|index| !alone(index)).collect();
    let kept = rows.into_iter().zip(keep).filter(|&(_, keep)| keep);
    kept.map(|(row, _)| row).collect()
}

#[cfg(test)]
mod tests {
    use super::lines::value;
    use super::*;

    #[test]
    fn groups_stay_together_where_they_fit() {
        let row = |label| value(0, label, String::new(), "");
        let rows = [heading("a"), row("1"), heading("b"), row("2"), row("3")];
        let columns = |height| by_group(&rows, height).map(|columns| columns.len());
        assert_eq!(columns(5), Some(1));
        assert_eq!(columns(3), Some(2));
        assert_eq!(columns(2), None);
    }
}
