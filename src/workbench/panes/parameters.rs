//! The scenario's values and the readouts, each with its unit, in fixed columns.

use super::{frame, shortened, write};
use crate::physics::Body;
use crate::scenario::{Motion, Scenario, Window};
use crate::workbench::readouts::Readouts;
use crate::workbench::theme::Role;
use crate::workbench::view::{Pane, View};
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::widgets::Widget;

/// Column of the last character of values.
const VALUE_END: u16 = 18;
/// Column of units.
const UNIT: u16 = 19;
/// Width of a column of lines, and how many stand side by side at most.
const COLUMN: u16 = 26;
const MOST_COLUMNS: u16 = 3;

/// The values of a scenario and of its run.
pub struct Parameters<'a> {
    /// The scenario.
    pub scenario: &'a Scenario,
    /// Gravity, scheme and time step as they are now: edits may have changed them.
    pub motion: &'a Motion,
    /// The latest reading of its run.
    pub readouts: &'a Readouts,
    /// How it is looked at.
    pub view: &'a View,
}

/// One line: a heading, or a value.
struct Row {
    /// Lines with larger numbers go first where there is no room for all.
    rank: u8,
    label: &'static str,
    label_role: Role,
    value: String,
    unit: &'static str,
}

impl Widget for Parameters<'_> {
    fn render(self, area: Rect, buf: &mut Buffer) {
        let focus = self.view.focus == Pane::Parameters;
        let inside = frame("parameters", area, focus, &self.view.theme, buf);
        if inside.is_empty() {
            return;
        }
        if self.view.filled {
            self.all(inside, buf);
        } else {
            self.most_important(inside, buf);
        }
    }
}

impl Parameters<'_> {
    /// Every line, in columns, scrolled where even they are too short.
    fn all(&self, area: Rect, buf: &mut Buffer) {
        let height = area.height as usize;
        let count = (area.width / COLUMN).clamp(1, MOST_COLUMNS) as usize;
        let rows = self.rows();
        let hidden = rows.len().saturating_sub(count * height);
        if hidden > 0 {
            let (lines, note) = above_last(area);
            let room = lines.height as usize * count;
            let scroll = self.view.scroll.min(rows.len() - room);
            let rows = rows.get(scroll..).unwrap_or_default();
            self.columns(rows.chunks(lines.height.max(1) as usize), lines, buf);
            let more = rows.len().saturating_sub(room);
            self.note(&format!("Up, Down: {more} more below"), note, buf);
        } else if let Some(columns) = by_group(&rows, height).filter(|all| all.len() <= count) {
            self.columns(columns.into_iter(), area, buf);
        } else {
            self.columns(rows.chunks(height), area, buf);
        }
    }

    fn columns<'r>(&self, columns: impl Iterator<Item = &'r [Row]>, area: Rect, buf: &mut Buffer) {
        for (rows, column) in columns.zip(0..MOST_COLUMNS) {
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
        let keys = match self.view.focus {
            Pane::Parameters => "f: all of them",
            _ => "Tab, then f: all of them",
        };
        self.note(keys, note, buf);
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
        let end = write(area, (indent, 0), row.label, label, buf);
        let value = shortened(&row.value, VALUE_END.saturating_sub(end + 1) as usize);
        let begin = VALUE_END.saturating_sub(value.chars().count() as u16);
        write(area, (begin, 0), &value, theme.style(Role::Text), buf);
        write(area, (UNIT, 0), row.unit, theme.style(Role::Quiet), buf);
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

fn heading(label: &'static str) -> Row {
    Row {
        rank: 0,
        label,
        label_role: Role::Heading,
        value: String::new(),
        unit: "",
    }
}

fn value(rank: u8, label: &'static str, value: String, unit: &'static str) -> Row {
    Row {
        rank,
        label,
        label_role: Role::Quiet,
        value,
        unit,
    }
}

/// A number, with as many of `digits` decimals as stand beside its label.
fn number(rank: u8, label: &'static str, number: f64, digits: usize, unit: &'static str) -> Row {
    value(rank, label, fixed(label, Some(number), digits), unit)
}

fn body_rows(scenario: &Scenario) -> Vec<Row> {
    let body: &Body = &scenario.body.mechanics;
    let height = body.first_moment().z / body.mass();
    let mut rows = vec![
        heading("body"),
        number(3, "mass", body.mass(), 3, "kg"),
        number(6, "mass at z", height, 4, "m"),
    ];
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
    vec![
        heading("now"),
        axis("x", Role::X, sample.position.x),
        axis("y", Role::Y, sample.position.y),
        axis("z", Role::Z, sample.position.z),
        number(0, "tilt", sample.tilt_deg, 3, "deg"),
        value(
            0,
            "precession",
            fixed("precession", readouts.precession_deg_per_s, 3),
            "deg/s",
        ),
        value(
            1,
            "predicted",
            fixed("predicted", readouts.predicted_precession_deg_per_s, 3),
            "deg/s",
        ),
        value(
            1,
            "nutation",
            fixed("nutation", readouts.nutation_s, 5),
            "s",
        ),
        value(
            1,
            "predicted",
            fixed("predicted", readouts.predicted_nutation_s, 5),
            "s",
        ),
        value(
            2,
            "E drift",
            readouts
                .health
                .energy_drift
                .map_or("n/a".to_owned(), |drift| signed("E drift", drift, 4)),
            "mgl",
        ),
        number(3, "|L|", sample.momentum.norm(), 3, "J s"),
        number(4, "Lz", sample.momentum.z, 3, "J s"),
        number(4, "energy", sample.energy, 2, "J"),
    ]
}

/// `number` beside `label` with `digits` decimals, or fewer; a dash where there is none.
fn fixed(label: &str, number: Option<f64>, digits: usize) -> String {
    number.map_or("-".to_owned(), |number| {
        fitted(label, digits, |digits| format!("{number:.digits$}"), number)
    })
}

/// As [`fixed`], with its sign.
fn signed(label: &str, number: f64, digits: usize) -> String {
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
