//! The scenario's values and the readouts, each with its unit, in fixed columns.

use super::{frame, write};
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
        let rows = fitting(self.rows(), inside.height as usize);
        let below = rows.len().saturating_sub(inside.height as usize);
        let scroll = if focus {
            self.view.scroll.min(below)
        } else {
            0
        };
        for (row, y) in rows.iter().skip(scroll).zip(0..inside.height) {
            self.line(
                row,
                Rect {
                    y: inside.y + y,
                    height: 1,
                    ..inside
                },
                buf,
            );
        }
    }
}

impl Parameters<'_> {
    fn line(&self, row: &Row, area: Rect, buf: &mut Buffer) {
        let theme = &self.view.theme;
        let indent = u16::from(row.label_role != Role::Heading);
        write(
            area,
            (indent, 0),
            row.label,
            theme.style(row.label_role),
            buf,
        );
        let width = row.value.chars().count() as u16;
        let begin = VALUE_END.saturating_sub(width);
        write(area, (begin, 0), &row.value, theme.style(Role::Text), buf);
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

/// The lines for which there is room, the least important left out.
fn fitting(mut rows: Vec<Row>, room: usize) -> Vec<Row> {
    while rows.len() > room {
        let worst = rows
            .iter()
            .enumerate()
            .max_by_key(|(_, row)| row.rank)
            .map(|(index, row)| (index, row.rank));
        match worst {
            Some((index, 1..)) => drop(rows.remove(index)),
            _ => break, // what matters most is scrolled to
        }
    }
    rows
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

fn body_rows(scenario: &Scenario) -> Vec<Row> {
    let body: &Body = &scenario.body.mechanics;
    let height = body.first_moment().z / body.mass();
    let mut rows = vec![
        heading("body"),
        value(0, "mass", format!("{:.3}", body.mass()), "kg"),
        value(3, "mass at z", format!("{height:.4}"), "m"),
    ];
    if let Some(rim) = &scenario.file.body.rim {
        rows.push(value(3, "rim radius", format!("{:.4}", rim.radius_m), "m"));
        rows.push(value(6, "rim points", rim.points.to_string(), ""));
    }
    rows
}

fn start_rows(scenario: &Scenario) -> Vec<Row> {
    let tilt = scenario.file.start.tilt_deg.unwrap_or(0.0);
    let [x, y, z] = scenario.file.start.momentum_Js;
    let frame = match scenario.file.start.momentum_frame {
        Some(crate::scenario::file::Frame::Body) => "body",
        _ => "world",
    };
    vec![
        heading("start"),
        value(0, "tilt", format!("{tilt:.3}"), "deg"),
        value(
            0,
            "|L|",
            format!("{:.3}", scenario.start.momentum.norm()),
            "J s",
        ),
        value(5, "Lx", format!("{x:.3}"), "J s"),
        value(5, "Ly", format!("{y:.3}"), "J s"),
        value(5, "Lz", format!("{z:.3}"), "J s"),
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
        value(2, "scheme", motion.scheme.name.to_owned(), ""),
        value(4, "gravity", format!("{:.3}", motion.gravity), "m/s2"),
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
        ..value(0, label, format!("{metres:.4}"), "m")
    };
    vec![
        heading("now"),
        axis("x", Role::X, sample.position.x),
        axis("y", Role::Y, sample.position.y),
        axis("z", Role::Z, sample.position.z),
        value(0, "tilt", format!("{:.3}", sample.tilt_deg), "deg"),
        value(
            0,
            "precession",
            fixed(readouts.precession_deg_per_s, 3),
            "deg/s",
        ),
        value(
            1,
            "predicted",
            fixed(readouts.predicted_precession_deg_per_s, 3),
            "deg/s",
        ),
        value(3, "nutation", fixed(readouts.nutation_s, 5), "s"),
        value(3, "predicted", fixed(readouts.predicted_nutation_s, 5), "s"),
        value(
            2,
            "E drift",
            readouts
                .health
                .energy_drift
                .map_or("n/a".to_owned(), |drift| format!("{drift:+.4}")),
            "",
        ),
        value(3, "|L|", format!("{:.3}", sample.momentum.norm()), "J s"),
        value(4, "Lz", format!("{:.3}", sample.momentum.z), "J s"),
        value(4, "energy", format!("{:.2}", sample.energy), "J"),
    ]
}

/// Characters a number has beside the longest label, a blank between them.
const ROOM: usize = 6;

/// `number` with `digits` decimals, or fewer where they would run into its label; a dash where there is none.
fn fixed(number: Option<f64>, digits: usize) -> String {
    let Some(number) = number else {
        return "-".to_owned();
    };
    let text = format!("{number:.digits$}");
    let excess = text.len().saturating_sub(ROOM.max(digits + 2));
    format!("{number:.*}", digits.saturating_sub(excess))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_keep_off_their_labels() {
        assert_eq!(fixed(Some(1.5881), 3), "1.588");
        assert_eq!(fixed(Some(171.185), 3), "171.19");
        assert_eq!(fixed(Some(-171.185), 3), "-171.2");
        assert_eq!(fixed(Some(0.80972), 5), "0.80972");
        assert_eq!(fixed(None, 3), "-");
    }
}
