//! The scenario's values and the readouts, each with its unit, in fixed columns.
//!
//! With the focus it is an editor: the values above, one on each line, one of them selected; the readouts to watch
//! below.

mod lines;

use super::{PaneRow, SELECTED_MARK, leave_one_out, rule, shortened, write};
use crate::engine::scenario::{Motion, Scenario};
use crate::engine::text::printable::printable;
use crate::engine::text::wrap::columns;
use crate::lab::action::Action;
use crate::lab::playback::reading::Reading;
use crate::lab::values::list::ValueList;
use crate::lab::values::list::{ListedValue, Match};
use crate::lab::view::{HideablePart, Pane, View};
use crate::tui::keymap::{Binding, Key, Mode, row};
use crate::tui::split::{split_columns, split_rows};
use crate::tui::theme::Role;
use lines::{
    COLUMN, PREDICTED_LABEL, ParameterLine, VALUE_END, body_lines, derived_lines, fewer_digits,
    further_lines, heading, in_pane, motion_lines, now_lines, start_lines, watched_lines,
};
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::widgets::Widget;

const UNIT_COLUMN: u16 = 19;
/// How many columns of values that can be edited stand side by side at most; the readouts have one more.
const MOST_EDITED: u16 = 6;
/// The marks of a list that continues above or below.
const MORE_ABOVE: &str = "▲";
const MORE_BELOW: &str = "▼";
/// From this height on there is room for the readouts to watch, below the values.
const WATCHED_FROM: usize = 8;

pub const PARAMETERS_ROW: PaneRow = PaneRow {
    id: Pane::Parameters,
    title: "parameters",
    draw: |lab, area, buf| {
        Parameters {
            scenario: lab.player().run().scenario(),
            motion: &lab.player().reading.motion,
            reading: &lab.player().reading,
            list: &lab.values().list,
            is_searched: lab.popups().mode == Mode::Find,
            view: lab.view(),
        }
        .render(area, buf);
    },
    keys: PARAMETER_PANE_KEYS,
    arrows: None,
};

/// The keys that the footer names while the pane has the focus.
#[rustfmt::skip]
const PARAMETER_PANE_KEYS: &[Binding] = &[
    row(&[Mode::Lab], &[Key::Char('/')], Action::FindValue, "find", "find a value by a part of its name; Esc shows all again"),
];

pub struct Parameters<'a> {
    pub scenario: &'a Scenario,
    /// Gravity, scheme and time step as they are now: edits may have changed them.
    pub motion: &'a Motion,
    pub reading: &'a Reading,
    pub list: &'a ValueList,
    /// Whether a part of a name is being typed, to find a value.
    pub is_searched: bool,
    pub view: &'a View,
}

impl Widget for Parameters<'_> {
    fn render(self, area: Rect, buf: &mut Buffer) {
        let focus = self.view.focus == PARAMETERS_ROW.id;
        let list = Some(self.list).filter(|_| focus);
        let title = pane_title(list, self.is_searched);
        let inside = rule(&title, None, focus, area, &self.view.theme, buf);
        if inside.is_empty() {
            return;
        }
        match (list, self.view.fullscreen) {
            (Some(list), true) => self.edited_and_read(list, inside, buf),
            (Some(list), false) => self.edited_above_read(list, inside, buf),
            (None, _) => self.most_important(inside, buf),
        }
    }
}

impl Parameters<'_> {
    /// Draws columns of lines side by side, each `wide` columns of the screen.
    fn columns<'r>(
        &self,
        columns: impl Iterator<Item = &'r [ParameterLine]>,
        wide: u16,
        area: Rect,
        buf: &mut Buffer,
    ) {
        let mut rest = area;
        for lines in columns.take(MOST_EDITED.into()) {
            let [place, right] = split_columns(rest, wide);
            self.draw(lines, wide, place, buf);
            rest = right;
        }
    }

    /// The most important lines, and a note how to see the others.
    fn most_important(&self, area: Rect, buf: &mut Buffer) {
        let mut lines = self.lines();
        if lines.len() <= area.height as usize {
            let further = without_dashes(further_lines(self.reading));
            lines.extend(shown(self.view, further));
            let lines = fitting(lines, area.height as usize);
            return self.draw(&lines, COLUMN, area, buf);
        }
        let [place, note] = split_rows(area, area.height.saturating_sub(1));
        let lines = fitting(lines, place.height as usize);
        self.draw(&lines, COLUMN, place, buf);
        self.note("all values: e, then f", note, buf);
    }

    /// The values to edit above, the key of the selected one, and the readouts to watch below.
    fn edited_above_read(&self, list: &ValueList, area: Rect, buf: &mut Buffer) {
        let height = area.height as usize;
        let edited = edited_lines(list);
        let spare = height.saturating_sub(edited.len() + 1);
        let room = match height {
            WATCHED_FROM.. => spare.max(height * 2 / 5),
            _ => 0,
        };
        let read = match list.name.as_str() {
            "" => read_lines(self.view, self.reading, room),
            name => self.found(name, room),
        };
        let [upper, lower] = split_rows(area, area.height.saturating_sub(read.len() as u16));
        self.edited(&edited, list, upper, (1, COLUMN), buf);
        self.draw(&read, COLUMN, lower, buf);
    }

    /// The values to edit in columns, and the readouts in one more.
    fn edited_and_read(&self, list: &ValueList, area: Rect, buf: &mut Buffer) {
        let count = (area.width / COLUMN).saturating_sub(1).min(MOST_EDITED);
        if count == 0 {
            return self.edited_above_read(list, area, buf);
        }
        let read = if list.name.is_empty() {
            let mut read = derived_lines(self.scenario);
            read.extend(shown(self.view, now_lines(self.reading)));
            read
        } else {
            self.found(&list.name, usize::MAX)
        };
        let edited = edited_lines(list);
        let height = area.height.saturating_sub(1) as usize;
        let grouped = by_group(&edited, height).map_or(usize::MAX, |columns| columns.len());
        let count = grouped.min(count as usize) as u16;
        let most = (area.width - COLUMN) / count;
        let wide = edited
            .iter()
            .map(needed)
            .max()
            .unwrap_or(COLUMN)
            .clamp(COLUMN, most.max(COLUMN));
        let [left, right] = split_columns(area, wide * count);
        self.edited(&edited, list, left, (count, wide), buf);
        let lines = fitting(read, right.height as usize);
        self.draw(&lines, COLUMN, right, buf);
    }

    /// The numbers that cannot be edited and have `name` in theirs, with what theory predicts for them, in `room` lines.
    fn found(&self, name: &str, room: usize) -> Vec<ParameterLine> {
        let mut lines = derived_lines(self.scenario);
        lines.extend(shown(self.view, now_lines(self.reading)));
        lines.extend(shown(self.view, further_lines(self.reading)));
        let answer =
            |line: &ParameterLine| Match::find(&line.label, name).filter(|_| !line.is_heading());
        let best = lines.iter().filter_map(answer).min();
        let mut is_found = false;
        lines.retain(|line| {
            let is_of_line_above = is_found && line.label == PREDICTED_LABEL;
            is_found = is_of_line_above || (best.is_some() && answer(line) == best);
            is_found
        });
        if !lines.is_empty() {
            lines.insert(0, heading("read only:"));
        }
        lines.truncate(room);
        lines
    }

    /// `lines` of `list` in `count` columns, each `wide` columns of the screen: as many as there is room for around the
    /// selected one, and below them what `--set` takes for it, with all its digits.
    fn edited(
        &self,
        lines: &[ParameterLine],
        list: &ValueList,
        area: Rect,
        (count, wide): (u16, u16),
        buf: &mut Buffer,
    ) {
        let mut place = area;
        let notes = list
            .selected()
            .map(|value| key_lines(value, area.width.into()));
        for note in notes.into_iter().flatten().rev() {
            if place.height > 1 {
                let [above, last] = split_rows(place, place.height - 1);
                self.note(&note, last, buf);
                place = above;
            }
        }
        let height = place.height as usize;
        let grouped = by_group(lines, height).filter(|columns| columns.len() <= count as usize);
        if let Some(columns) = grouped {
            return self.columns(columns.into_iter(), wide, place, buf);
        }
        let room = height * count as usize;
        let (shown, above, below) = around_selected(lines, room);
        self.columns(shown.chunks(height.max(1)), wide, place, buf);
        // On the frame, or in the last column of the lines, which is empty.
        let x = if self.view.fullscreen && area.width == count * wide {
            area.right() - 1
        } else {
            area.right()
        };
        self.hint(above, (x, place.y), MORE_ABOVE, buf);
        self.hint(
            below,
            (x, place.bottom().saturating_sub(1)),
            MORE_BELOW,
            buf,
        );
    }

    /// Marks at `place` that a list goes on, if it does.
    fn hint(&self, goes_on: bool, place: (u16, u16), sign: &str, buf: &mut Buffer) {
        if let Some(cell) = buf.cell_mut(place).filter(|_| goes_on) {
            cell.set_symbol(sign)
                .set_style(self.view.theme.style(Role::Heading));
        }
    }

    fn note(&self, text: &str, area: Rect, buf: &mut Buffer) {
        write(area, (0, 0), text, self.view.theme.style(Role::Label), buf);
    }

    /// Draws `lines` one below the other, each `wide` columns of the screen.
    fn draw(&self, lines: &[ParameterLine], wide: u16, area: Rect, buf: &mut Buffer) {
        for (line, place) in lines.iter().zip(area.rows()) {
            self.draw_line(line, VALUE_END + wide - COLUMN, place, buf);
        }
    }

    /// One line; `value_end` is the column of the last character of its value.
    fn draw_line(&self, line: &ParameterLine, value_end: u16, area: Rect, buf: &mut Buffer) {
        let theme = &self.view.theme;
        let indent = u16::from(!line.is_heading());
        let label = theme.style(line.label_role);
        let end = write(area, (indent, 0), &line.label, label, buf);
        let room = value_end.saturating_sub(end + 1) as usize;
        let value = fewer_digits(&line.value, room);
        let style = theme.style(line.value_role);
        if line.unit.is_empty() && columns(&value) > room {
            // Words may take the columns of the unit, since they have none.
            write(area, (end + 1, 0), &value, style, buf);
        } else {
            let value = shortened(&value, room);
            let begin = value_end.saturating_sub(columns(&value) as u16);
            write(area, (begin, 0), &value, style, buf);
        }
        let unit = value_end + UNIT_COLUMN - VALUE_END;
        write(area, (unit, 0), &line.unit, theme.style(Role::Label), buf);
        if line.is_selected {
            write(area, (0, 0), SELECTED_MARK, theme.style(Role::Heading), buf);
            buf.set_style(area, theme.style(Role::Selected));
        }
    }

    fn lines(&self) -> Vec<ParameterLine> {
        let mut lines = body_lines(self.scenario);
        lines.extend(start_lines(self.scenario));
        lines.extend(motion_lines(self.scenario, self.motion));
        lines.extend(shown(self.view, now_lines(self.reading)));
        lines
    }
}

/// The pane's title, which says where in the list the selected value is, and what is searched for.
fn pane_title(list: Option<&ValueList>, is_searched: bool) -> String {
    let Some(list) = list else {
        return PARAMETERS_ROW.title.to_owned();
    };
    let shown = list.shown();
    let mut indices = shown.iter().map(|(index, _)| *index);
    let at = indices
        .position(|index| index == list.selected_index())
        .map_or(0, |at| at + 1);
    match (list.name.as_str(), is_searched, shown.len()) {
        (name, true, count) => format!("/{name}_ {at} of {count}"),
        ("", false, 0) => PARAMETERS_ROW.title.to_owned(),
        ("", false, count) => format!("{} {at} of {count}", PARAMETERS_ROW.title),
        (name, false, count) => format!("/{name} {at} of {count}"),
    }
}

/// The lines of the values of `list` that are shown, each group under its heading.
fn edited_lines(list: &ValueList) -> Vec<ParameterLine> {
    let shown = list.shown();
    let mut lines = Vec::with_capacity(2 * shown.len());
    for group in shown.chunk_by(|(_, a), (_, b)| a.group == b.group) {
        let first = group.first();
        lines.extend(first.map(|(_, value)| heading(on_one_line(&value.group))));
        for (index, value) in group {
            lines.push(edited_line(value, *index == list.selected_index()));
        }
    }
    if lines.is_empty() && !list.name.is_empty() {
        lines.push(heading("no value to set has it"));
    }
    lines
}

fn edited_line(value: &ListedValue, is_selected: bool) -> ParameterLine {
    let value_role = if value.is_default {
        Role::Label
    } else {
        Role::Text
    };
    let text = on_one_line(&value.text);
    let number = text.parse().ok().filter(|_| text.contains(['.', 'e']));
    let text = number.map_or(text, in_pane);
    ParameterLine {
        rank: 0,
        label: on_one_line(&value.label).into(),
        label_role: Role::Label,
        value: text,
        value_role,
        unit: value.unit.into(),
        is_selected,
    }
}

/// `text` on one line and printable.
fn on_one_line(text: &str) -> String {
    printable(&text.replace('\n', " ")).into_owned()
}

/// What `--set` takes for `value`: on one line of `width` columns, or else the key on one and a number on the next; a text
/// is shown whole by the dialog. Empty for the push to come.
fn key_lines(value: &ListedValue, width: usize) -> Vec<String> {
    let Some(key) = &value.key else {
        return vec![String::new()];
    };
    let text = on_one_line(&value.text);
    let whole = format!("{key}={text}");
    let is_short = columns(&whole) <= width;
    let is_number = text.parse::<f64>().is_ok();
    match (is_short, is_number) {
        (true, _) => vec![whole],
        (false, true) => vec![key.to_owned(), format!("={text}")],
        (false, false) => vec![key.to_owned()],
    }
}

/// Columns that `line` needs to show its number with all its digits.
fn needed(line: &ParameterLine) -> u16 {
    let is_number = line.value.parse::<f64>().is_ok();
    let words = columns(&line.label) + columns(&line.value) + 2;
    let behind = COLUMN - VALUE_END;
    if is_number { words as u16 + behind } else { 0 }
}

/// The `room` lines around the selected one, its group's heading kept on top; whether there are more above and below.
fn around_selected(lines: &[ParameterLine], room: usize) -> (Vec<ParameterLine>, bool, bool) {
    let selected = lines.iter().position(|line| line.is_selected).unwrap_or(0);
    let most = lines.len().saturating_sub(room);
    let first = selected.saturating_sub(room / 2).min(most);
    let end = (first + room).min(lines.len());
    let mut shown = lines[first..end].to_vec();
    let before = lines.get(..=first).unwrap_or(lines);
    let heading = before.iter().rfind(|line| line.is_heading());
    if let (Some(top), Some(heading)) = (shown.first_mut(), heading)
        && !top.is_selected
    {
        top.clone_from(heading);
    }
    (shown, first > 0, end < lines.len())
}

/// The readouts for `room` lines: all of them, or those to watch.
fn read_lines(view: &View, reading: &Reading, room: usize) -> Vec<ParameterLine> {
    let all = shown(view, now_lines(reading));
    if all.len() <= room {
        return all;
    }
    let mut watched = vec![heading("now")];
    watched.extend(shown(view, watched_lines(reading).into()));
    let mut lines = fitting(watched, room);
    lines.truncate(room);
    lines
}

fn shown(view: &View, mut lines: Vec<ParameterLine>) -> Vec<ParameterLine> {
    if view.hides(HideablePart::Predicted) {
        lines.retain(|line| line.label != PREDICTED_LABEL);
    }
    lines
}

/// `lines` in columns of at most `height` that begin with a heading; `None` where a group is higher than that.
fn by_group(lines: &[ParameterLine], height: usize) -> Option<Vec<&[ParameterLine]>> {
    let mut columns = Vec::new();
    let (mut begin, mut end) = (0, 0);
    for group in lines.chunk_by(|_, next| !next.is_heading()) {
        if end + group.len() - begin > height {
            columns.push(&lines[begin..end]);
            begin = end;
        }
        end += group.len();
    }
    columns.push(&lines[begin..]);
    let fits = columns.iter().all(|column| column.len() <= height);
    fits.then_some(columns)
}

/// The lines for which there is room, the least important left out.
fn fitting(mut lines: Vec<ParameterLine>, room: usize) -> Vec<ParameterLine> {
    // Where all of it matters, the rest is cut off.
    while lines.len() > room && leave_one_out(&mut lines, |line| line.rank) {
        lines = without_empty_groups(lines);
    }
    lines
}

/// `lines` without those that have no value, the headings kept.
fn without_dashes(mut lines: Vec<ParameterLine>) -> Vec<ParameterLine> {
    lines.retain(|line| line.is_heading() || line.value != "-");
    without_empty_groups(lines)
}

/// No heading stands alone.
fn without_empty_groups(lines: Vec<ParameterLine>) -> Vec<ParameterLine> {
    let mut kept: Vec<ParameterLine> = Vec::with_capacity(lines.len());
    for line in lines {
        if line.is_heading() {
            kept.pop_if(|last| last.is_heading());
        }
        kept.push(line);
    }
    kept.pop_if(|last| last.is_heading());
    kept
}
