//! Which lines are shown: of the values that can be edited all or those that a search finds, and of all lines those for
//! which there is room.

use super::super::leave_one_out;
use super::ROW;
use super::lines::{
    COLUMN, Line, PREDICTED, VALUE_END, heading, in_pane, now_lines, watched_lines,
};
use crate::lab::values::list::ValueList;
use crate::lab::values::listed::ListedValue;
use crate::lab::view::{Part, View};
use crate::playback::reading::Reading;
use crate::text::printable::printable;
use crate::text::wrap::columns;
use crate::tui::theme::Role;

/// The pane's title, which says where in the list the selected value is, and what is searched for.
pub(super) fn title(list: Option<&ValueList>, is_searched: bool) -> String {
    let Some(list) = list else {
        return ROW.title.to_owned();
    };
    let shown = list.shown();
    let mut indices = shown.iter().map(|(index, _)| *index);
    let at = indices.position(|index| index == list.selected_index());
    let at = at.map_or(0, |at| at + 1);
    match (list.name.as_str(), is_searched, shown.len()) {
        (name, true, count) => format!("/{name}_ {at} of {count}"),
        ("", false, 0) => ROW.title.to_owned(),
        ("", false, count) => format!("{} {at} of {count}", ROW.title),
        (name, false, count) => format!("/{name} {at} of {count}"),
    }
}

/// The lines of the values of `list` that are shown, each group under its heading.
pub(super) fn edited_lines(list: &ValueList) -> Vec<Line> {
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

fn edited_line(value: &ListedValue, is_selected: bool) -> Line {
    let value_role = if value.is_default {
        Role::Quiet
    } else {
        Role::Text
    };
    let text = on_one_line(&value.text);
    let number = text.parse().ok().filter(|_| text.contains(['.', 'e']));
    let text = number.map_or(text, in_pane);
    Line {
        rank: 0,
        label: on_one_line(&value.label).into(),
        label_role: Role::Quiet,
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
pub(super) fn key_lines(value: &ListedValue, width: usize) -> Vec<String> {
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
pub(super) fn needed(line: &Line) -> u16 {
    let is_number = line.value.parse::<f64>().is_ok();
    let words = columns(&line.label) + columns(&line.value) + 2;
    let behind = COLUMN - VALUE_END;
    if is_number { words as u16 + behind } else { 0 }
}

/// The `room` lines around the selected one, its group's heading kept on top; whether there are more above and below.
pub(super) fn around_selected(lines: &[Line], room: usize) -> (Vec<Line>, bool, bool) {
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
pub(super) fn read_lines(view: &View, reading: &Reading, room: usize) -> Vec<Line> {
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

/// `lines` without those that are hidden.
pub(super) fn shown(view: &View, mut lines: Vec<Line>) -> Vec<Line> {
    if view.hides(Part::Predicted) {
        lines.retain(|line| line.label != PREDICTED);
    }
    lines
}

/// `lines` in columns of at most `height` that begin with a heading; `None` where a group is higher than that.
pub(super) fn by_group(lines: &[Line], height: usize) -> Option<Vec<&[Line]>> {
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
    let fits = columns.iter().all(|lines| lines.len() <= height);
    fits.then_some(columns)
}

/// The lines for which there is room, the least important left out.
pub(super) fn fitting(mut lines: Vec<Line>, room: usize) -> Vec<Line> {
    // Where all of it matters, the rest is cut off.
    while lines.len() > room && leave_one_out(&mut lines, |line| line.rank) {
        lines = without_empty_groups(lines);
    }
    lines
}

/// `lines` without those that have no value, the headings kept.
pub(super) fn without_dashes(mut lines: Vec<Line>) -> Vec<Line> {
    lines.retain(|line| line.is_heading() || line.value != "-");
    without_empty_groups(lines)
}

/// No heading stands alone.
fn without_empty_groups(lines: Vec<Line>) -> Vec<Line> {
    let alone = |index: usize| {
        lines[index].is_heading() && lines.get(index + 1).is_none_or(Line::is_heading)
    };
    let keep: Vec<bool> = (0..lines.len()).map(|index| !alone(index)).collect();
    let kept = lines.into_iter().zip(keep).filter(|&(_, keep)| keep);
    kept.map(|(line, _)| line).collect()
}
