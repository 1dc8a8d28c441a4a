//! The scenario's values and the readouts, each with its unit, in fixed columns.
//!
//! In focus it is an editor: the values one by one above, one of them selected, and the readouts to watch below.

use super::{columns, frame, shortened, write};
use crate::physics::Body;
use crate::scenario::problem::printable;
use crate::scenario::{Motion, Scenario, Window};
use crate::workbench::lab::editor::{Editor, Line};
use crate::workbench::view::theme::Role;
use crate::workbench::view::{Pane, View};
use crate::workbench::watch::readouts::Readouts;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::widgets::Widget;
use std::borrow::Cow;

/// Column of the last character of values.
const VALUE_END: u16 = 18;
/// Column of units.
const UNIT: u16 = 19;
/// Width of a column of lines.
const COLUMN: u16 = 26;
/// How many columns of values that can be edited stand side by side at most; the readouts have one more.
const MOST_EDITED: u16 = 6;
/// What marks the selected line, and a list that goes on above or below.
const SELECTED: &str = "►";
const ABOVE: &str = "▲";
const BELOW: &str = "▼";
/// From this height on the readouts to watch have a place below the editor's lines.
const WATCHED_FROM: usize = 8;

/// The values of a scenario and of its run.
pub struct Parameters<'a> {
    /// The scenario.
    pub scenario: &'a Scenario,
    /// Gravity, scheme and time step as they are now: edits may have changed them.
    pub motion: &'a Motion,
    /// The latest reading of its run.
    pub readouts: &'a Readouts,
    /// What can be edited.
    pub editor: &'a Editor,
    /// How it is looked at.
    pub view: &'a View,
}

/// One line: a heading, or a value.
#[derive(Clone)]
struct Row {
    /// Lines with larger numbers go first where there is no room for all.
    rank: u8,
    label: Cow<'static, str>,
    label_role: Role,
    value: String,
    value_role: Role,
    unit: Cow<'static, str>,
    is_selected: bool,
}

impl Widget for Parameters<'_> {
    fn render(self, area: Rect, buf: &mut Buffer) {
        let focus = self.view.focus == Pane::Parameters;
        let editor = Some(self.editor).filter(|_| focus);
        let inside = frame(&title(editor), area, focus, &self.view.theme, buf);
        if inside.is_empty() {
            return;
        }
        match (editor, self.view.filled) {
            (Some(editor), true) => self.edited_and_read(editor, inside, buf),
            (Some(editor), false) => self.edited_above_read(editor, inside, buf),
            (None, _) => self.most_important(inside, buf),
        }
    }
}

impl Parameters<'_> {
    fn columns<'r>(&self, columns: impl Iterator<Item = &'r [Row]>, area: Rect, buf: &mut Buffer) {
        for (rows, column) in columns.zip(0..MOST_EDITED) {
            let place = Rect {
                x: area.x + column * COLUMN,
                width: area.width.saturating_sub(column * COLUMN).min(COLUMN),
                ..area
            };
            self.lines(rows, place, buf);
        }
    }

    /// The lines there is room for, and how to see the others.
    fn most_important(&self, area: Rect, buf: &mut Buffer) {
        let rows = self.rows();
        if rows.len() <= area.height as usize {
            return self.lines(&rows, area, buf);
        }
        let (lines, note) = above_last(area);
        let rows = fitting(rows, lines.height as usize);
        self.lines(&rows, lines, buf);
        self.note("e, then f: all of them", note, buf);
    }

    /// The values to edit above, the key of the selected one, and the readouts to watch below.
    fn edited_above_read(&self, editor: &Editor, area: Rect, buf: &mut Buffer) {
        let height = area.height as usize;
        let edited = edited_rows(editor);
        let spare = height.saturating_sub(edited.len() + 1);
        let room = match height {
            WATCHED_FROM.. => spare.max(height * 2 / 5),
            _ => 0,
        };
        let read = read_rows(self.readouts, room);
        let lower = read.len() as u16;
        let upper = Rect {
            height: area.height - lower,
            ..area
        };
        self.edited(&edited, editor, upper, 1, buf);
        let lower = Rect {
            y: upper.bottom(),
            height: lower,
            ..area
        };
        self.lines(&read, lower, buf);
    }

    /// The values to edit in columns, and the readouts in one more.
    fn edited_and_read(&self, editor: &Editor, area: Rect, buf: &mut Buffer) {
        let count = (area.width / COLUMN).saturating_sub(1).min(MOST_EDITED);
        if count == 0 {
            return self.edited_above_read(editor, area, buf);
        }
        let mut read = derived_rows(self.scenario);
        read.extend(now_rows(self.readouts));
        let edited = edited_rows(editor);
        let height = area.height.saturating_sub(1) as usize;
        let grouped = by_group(&edited, height).map_or(usize::MAX, |columns| columns.len());
        let count = grouped.min(count as usize) as u16;
        let width = COLUMN * count;
        self.edited(&edited, editor, Rect { width, ..area }, count, buf);
        let right = Rect {
            x: area.x + width,
            width: area.width - width,
            ..area
        };
        let rows = fitting(read, right.height as usize);
        self.lines(&rows, right, buf);
    }

    /// `rows` of `editor` in `count` columns, as many as there is room for around the selected one, and below them what
    /// `--set` takes for it.
    fn edited(&self, rows: &[Row], editor: &Editor, area: Rect, count: u16, buf: &mut Buffer) {
        let (lines, last) = match area.height {
            0..=1 => (area, Rect { height: 0, ..area }),
            _ => above_last(area),
        };
        if let Some(selected) = editor.selected() {
            let width = last.width as usize;
            self.note(&key_line(selected, width), last, buf);
        }
        let height = lines.height as usize;
        let grouped = by_group(rows, height).filter(|columns| columns.len() <= count as usize);
        if let Some(columns) = grouped {
            return self.columns(columns.into_iter(), lines, buf);
        }
        let room = height * count as usize;
        let (shown, above, below) = around_selected(rows, room);
        self.columns(shown.chunks(height.max(1)), lines, buf);
        // On the frame, or where columns of lines are empty.
        let x = match self.view.filled && area.width == count * COLUMN {
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
        for (row, y) in rows.iter().zip(0..area.height) {
            let line = Rect {
                y: area.y + y,
                height: 1,
                ..area
            };
            self.line(row, line, buf);
        }
    }

    fn line(&self, row: &Row, area: Rect, buf: &mut Buffer) {
        let theme = &self.view.theme;
        let indent = u16::from(!row.is_heading());
        let label = theme.style(row.label_role);
        let end = write(area, (indent, 0), &row.label, label, buf);
        let room = VALUE_END.saturating_sub(end + 1) as usize;
        let value = fewer_digits(&row.value, room);
        let style = theme.style(row.value_role);
        if row.unit.is_empty() && columns(&value) > room {
            // Words have no unit beside them.
            write(area, (end + 1, 0), &value, style, buf);
        } else {
            let value = shortened(&value, room);
            let begin = VALUE_END.saturating_sub(columns(&value) as u16);
            write(area, (begin, 0), &value, style, buf);
        }
        write(area, (UNIT, 0), &row.unit, theme.style(Role::Quiet), buf);
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
        rows.extend(now_rows(self.readouts));
        rows
    }
}

/// The pane's title, which tells where in the list the selected line is.
fn title(editor: Option<&Editor>) -> String {
    match editor.map(|editor| (editor.selected_index() + 1, editor.lines().len())) {
        Some((at, all @ 1..)) => format!("parameters {at} of {all}"),
        _ => "parameters".to_owned(),
    }
}

/// The lines of `editor`, its groups with their headings.
fn edited_rows(editor: &Editor) -> Vec<Row> {
    let mut rows = Vec::with_capacity(2 * editor.lines().len());
    let mut at = 0;
    for group in editor.lines().chunk_by(|a, b| a.group == b.group) {
        rows.extend(group.first().map(|line| heading(on_one_line(&line.group))));
        for line in group {
            rows.push(edited_row(line, at == editor.selected_index()));
            at += 1;
        }
    }
    rows
}

fn edited_row(line: &Line, is_selected: bool) -> Row {
    let value_role = if line.is_default {
        Role::Quiet
    } else {
        Role::Text
    };
    Row {
        rank: 0,
        label: on_one_line(&line.label).into(),
        label_role: Role::Quiet,
        value: on_one_line(&line.value),
        value_role,
        unit: line.unit.clone().into(),
        is_selected,
    }
}

/// `text` as it can stand on a line, whatever it holds.
fn on_one_line(text: &str) -> String {
    printable(&text.replace('\n', " "))
}

/// What `--set` takes for `line`: with its value where there is room for it on `width` columns.
fn key_line(line: &Line, width: usize) -> String {
    if line.key.is_empty() {
        return String::new();
    }
    let value = on_one_line(&line.value);
    let whole = format!("{}={value}", line.key);
    if columns(&whole) <= width {
        whole
    } else {
        line.key.clone()
    }
}

/// The `room` rows around the selected one, its group's heading kept on top; whether there are more above and below.
fn around_selected(rows: &[Row], room: usize) -> (Vec<Row>, bool, bool) {
    let selected = rows.iter().position(|row| row.is_selected).unwrap_or(0);
    let most = rows.len().saturating_sub(room);
    let first = selected.saturating_sub(room / 2).min(most);
    let end = (first + room).min(rows.len());
    let mut shown = rows[first..end].to_vec();
    let before = rows.get(..=first).unwrap_or(rows);
    let heading = before.iter().rfind(|row| row.is_heading());
    if let (Some(top), Some(heading)) = (shown.first_mut(), heading)
        && !top.is_selected
    {
        top.clone_from(heading);
    }
    (shown, first > 0, end < rows.len())
}

/// `text`, or with fewer decimals where it is a number that is wider than `room`.
fn fewer_digits(text: &str, room: usize) -> Cow<'_, str> {
    let is_number = text.contains('.') && text.len() > room;
    let number = text.parse::<f64>().ok().filter(|_| is_number);
    let Some(number) = number else {
        return text.into();
    };
    let decimals = (1..room).rev().map(|digits| format!("{number:.digits$}"));
    let exponents = (0..room).rev().map(|digits| format!("{number:.digits$e}"));
    let is_told = |text: &String| text.parse::<f64>().is_ok_and(|told| near(told, number));
    let mut fitting = decimals.chain(exponents).filter(|text| text.len() <= room);
    fitting.find(is_told).map_or(text.into(), Cow::from)
}

/// Whether `told` is `number` to within a thousandth.
fn near(told: f64, number: f64) -> bool {
    (told - number).abs() <= 1e-3 * number.abs()
}

/// The readouts for `room` lines: all of them, or those to watch.
fn read_rows(readouts: &Readouts, room: usize) -> Vec<Row> {
    let all = now_rows(readouts);
    if all.len() <= room {
        return all;
    }
    let mut watched = vec![heading("now")];
    watched.extend(watched_rows(readouts));
    let mut rows = fitting(watched, room);
    rows.truncate(room);
    rows
}

impl Row {
    fn is_heading(&self) -> bool {
        self.label_role == Role::Heading
    }
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

/// No heading stands alone.
fn without_empty_groups(rows: Vec<Row>) -> Vec<Row> {
    let alone =
        |index: usize| rows[index].is_heading() && rows.get(index + 1).is_none_or(Row::is_heading);
    let keep: Vec<bool> = (0..rows.len()).map(|index| !alone(index)).collect();
    let kept = rows.into_iter().zip(keep).filter(|&(_, keep)| keep);
    kept.map(|(row, _)| row).collect()
}

fn heading(label: impl Into<Cow<'static, str>>) -> Row {
    Row {
        label: label.into(),
        label_role: Role::Heading,
        ..value(0, "", String::new(), "")
    }
}

fn value(rank: u8, label: &'static str, value: String, unit: &'static str) -> Row {
    Row {
        rank,
        label: label.into(),
        label_role: Role::Quiet,
        value,
        value_role: Role::Text,
        unit: unit.into(),
        is_selected: false,
    }
}

/// A number, with as many of `digits` decimals as stand beside its label.
fn number(rank: u8, label: &'static str, number: f64, digits: usize, unit: &'static str) -> Row {
    value(rank, label, fixed(label, Some(number), digits), unit)
}

/// What follows from the body's values.
fn derived_rows(scenario: &Scenario) -> Vec<Row> {
    let body: &Body = &scenario.body.mechanics;
    let height = body.first_moment().z / body.mass();
    vec![
        heading("body"),
        number(3, "mass", body.mass(), 3, "kg"),
        number(6, "mass at z", height, 4, "m"),
    ]
}

fn body_rows(scenario: &Scenario) -> Vec<Row> {
    let mut rows = derived_rows(scenario);
    if let Some(rim) = &scenario.file.body.rim {
        rows.push(number(4, "rim radius", rim.radius_m, 4, "m"));
        rows.push(value(6, "rim points", rim.points.to_string(), ""));
    }
    rows
}

fn start_rows(scenario: &Scenario) -> Vec<Row> {
    let tilt = scenario.file.start.tilt_deg.unwrap_or(0.0);
    let momentum = scenario.file.start.momentum_Js;
    let [x, y, z] = momentum.unwrap_or(scenario.start.momentum.into());
    let frame = match scenario.file.start.momentum_frame {
        Some(crate::scenario::file::Frame::Body) => "body",
        _ => "world",
    };
    vec![
        heading("start"),
        number(2, "tilt", tilt, 3, "deg"),
        number(0, "|L|", scenario.start.momentum.norm(), 3, "J s"),
        number(5, "Lx", x, 3, "J s"),
        number(5, "Ly", y, 3, "J s"),
        number(5, "Lz", z, 3, "J s"),
        value(5, "L given in", frame.to_owned(), ""),
    ]
}

fn motion_rows(scenario: &Scenario, motion: &Motion) -> Vec<Row> {
    let pushes = match (scenario.pushes.len(), scenario.pushes.first()) {
        (0, _) => "none".to_owned(),
        (1, Some(push)) => format!("{:.0} N", push.force.norm()),
        (more, _) => more.to_string(),
    };
    let mut rows = vec![
        heading("motion"),
        value(0, "dt", format!("{}", motion.time_step_s), "s"),
        value(3, "scheme", motion.scheme.name.to_owned(), ""),
        number(4, "gravity", motion.gravity, 3, "m/s2"),
        value(6, "steps", scenario.steps.to_string(), ""),
        value(
            if scenario.pushes.is_empty() { 5 } else { 1 },
            "push",
            pushes,
            "",
        ),
    ];
    if let [push] = scenario.pushes[..] {
        let (when, unit) = match push.window {
            Window::Steps { first, count } => (
                format!("{first} to {}", (first - 1).saturating_add(count)),
                "step",
            ),
            Window::Time { from_s, for_s } => (format!("{from_s} to {}", from_s + for_s), "s"),
        };
        rows.push(value(3, "acts", when, unit));
    }
    rows
}

fn now_rows(readouts: &Readouts) -> Vec<Row> {
    let sample = &readouts.sample;
    let axis = |label, role, metres: f64| Row {
        label_role: role,
        ..number(0, label, metres, 4, "m")
    };
    let mut rows = vec![
        heading("now"),
        axis("x", Role::X, sample.position.x),
        axis("y", Role::Y, sample.position.y),
        axis("z", Role::Z, sample.position.z),
    ];
    rows.extend(watched_rows(readouts));
    let after_nutation = rows.len() - 1;
    let predicted = readouts.predicted_nutation_s;
    rows.insert(after_nutation, measured(1, "predicted", predicted, 5, "s"));
    rows.extend([
        number(3, "|L|", sample.momentum.norm(), 3, "J s"),
        number(4, "Lz", sample.momentum.z, 3, "J s"),
        number(4, "energy", sample.energy, 2, "J"),
    ]);
    rows
}

/// The readouts to watch while values are edited; the last is the energy's drift.
fn watched_rows(readouts: &Readouts) -> [Row; 5] {
    let precession = readouts.precession_deg_per_s;
    let predicted = readouts.predicted_precession_deg_per_s;
    let nutation = match readouts.nutation_is_strobed {
        true => "nutation?", // a strobe's picture: the line below the panes says whose swing it is
        false => "nutation",
    };
    let drift = readouts.health.energy_drift;
    let drift = drift.map_or("n/a".to_owned(), |drift| signed("E drift", drift, 4));
    [
        number(0, "tilt", readouts.sample.tilt_deg, 3, "deg"),
        measured(0, "precession", precession, 3, "deg/s"),
        measured(1, "predicted", predicted, 3, "deg/s"),
        measured(1, nutation, readouts.nutation_s, 5, "s"),
        value(2, "E drift", drift, "mgl"),
    ]
}

/// A number that may not be known (yet).
fn measured(
    rank: u8,
    label: &'static str,
    number: Option<f64>,
    digits: usize,
    unit: &'static str,
) -> Row {
    value(rank, label, fixed(label, number, digits), unit)
}

/// `number` beside `label` with `digits` decimals, or fewer; a dash where there is none.
fn fixed(label: &str, number: Option<f64>, digits: usize) -> String {
    number.map_or("-".to_owned(), |number| {
        fitted(label, digits, |digits| format!("{number:.digits$}"), number)
    })
}

/// As [`fixed`], with its sign.
fn signed(label: &str, number: f64, digits: usize) -> String {
    let is_zero = format!("{number:.digits$}")
        .trim_matches(['-', '0', '.'])
        .is_empty();
    let number = if is_zero { 0.0 } else { number }; // no -0.0000
    fitted(
        label,
        digits,
        |digits| format!("{number:+.digits$}"),
        number,
    )
}

/// The most decimals with which `format` keeps off `label`, a blank between them; an exponent where none do.
fn fitted(label: &str, digits: usize, format: impl Fn(usize) -> String, number: f64) -> String {
    let room = (VALUE_END as usize).saturating_sub(label.len() + 2);
    let decimals = (0..=digits).rev().map(format);
    let exponents = (0..=3).rev().map(|digits| format!("{number:.digits$e}"));
    let fits = |text: &String| text.len() <= room;
    let text = decimals.chain(exponents).find(fits);
    text.unwrap_or_else(|| format!("{number:.0e}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_keep_off_their_labels() {
        assert_eq!(fixed("precession", Some(1.5881), 3), "1.588");
        assert_eq!(fixed("precession", Some(171.185), 3), "171.19");
        assert_eq!(fixed("precession", Some(-171.185), 3), "-171.2");
        assert_eq!(fixed("nutation", Some(0.80972), 5), "0.80972");
        assert_eq!(fixed("nutation", None, 5), "-");
        assert_eq!(signed("E drift", 9493.8434, 4), "+9493.843");
        assert_eq!(fixed("precession", Some(-1.2345e12), 3), "-1e12");
        assert_eq!(fixed("precession", Some(1.2345e12), 3), "1.2e12");
    }

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
