//! The traced point and the tilt over time. The upper strip shows the tilt over a few swings, so that fast motion is seen
//! as it is; those below show x, y and z over a longer time, so that slow motion is.

mod axis;
mod curve;
mod pointing;
mod pushes;

use super::{PaneRow, Width, frame, write};
use crate::lab::action::{Action, Direction};
use crate::lab::view::{Pane, View};
use crate::observe::detail::Detail;
use crate::observe::ghost::Ghost;
use crate::observe::live::LiveRun;
use crate::observe::marks::Marks;
use crate::observe::overlay::Overlay;
use crate::observe::recording::{Curve, Extent, Recording};
use crate::observe::scale::Scale;
use crate::observe::strip::Strip;
use crate::run::Sample;
use crate::text::number::{decimal, fixed};
use crate::tui::dots::{Dots, Ink};
use crate::tui::keymap::{Binding, Key, Mode, row};
use crate::tui::theme::Role;
use curve::{Stroke, draw};
use nalgebra::Vector3;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Style;
use ratatui::widgets::Widget;

/// Fewest rows of a strip: its label and one row of dots.
const STRIP: u16 = 2;
/// From this width on the values stand beside the strips, and not on a line above each.
const BESIDE_FROM: u16 = 48;
/// What marks the strip that shows less time than the others.
const ZOOM: &str = "zoom";
/// Columns of a strip's name beside it.
const NAME: u16 = 5;
/// What marks the time of an edit, and the time where the run stands.
const EDIT: char = ':';
const PEN: char = '│';
/// What marks the cursor.
const CURSOR: char = '┃';
/// Digits after the point of a value at the cursor.
const DECIMALS: usize = 6;
/// Least range of z, of the distance between pivot and traced point: a swing below it is small, and shall look small.
const Z_LEAST: f64 = 0.05;
/// Least range of the tilt, degrees: below it there is rounding to see, and no end to the digits of its ends.
const TILT_LEAST: f64 = 0.02;
/// Least reach of x and y, of the same distance.
const PLANE_LEAST: f64 = 1e-4;
/// What the title says of bands where there is room.
const BANDS: &str = "bands: lowest, mean (dotted) and highest of fast swings";
/// What the title says of the exact motion, the run before and the pinned run: at length, in short and shorter.
const EXACT: [&str; 3] = ["dashed: exact motion", "- - exact", "--exact"];
const OTHER: [&str; 3] = ["dotted: other run", "··· other run", "···other"];
const PINNED: [&str; 3] = ["long and short: pinned", "-- - pinned", "-- -pinned"];

/// Its row in the table of panes.
pub const ROW: PaneRow = PaneRow {
    id: Pane::TRACES,
    title: "over time",
    width: Width::Wide,
    rank: 0,
    least: (27, 0),
    draw: |lab, area, buf| {
        Traces::of(lab).render(area, buf);
    },
    keys: KEYS,
};

/// The keys that mean something here while the pane has the focus.
#[rustfmt::skip]
const KEYS: &[Binding] = &[
    row(&[Mode::Lab], &[Key::Left], Action::Move(Direction::Left), "cursor", "the cursor to the left: its values are shown; Esc takes it away"),
    row(&[Mode::Lab], &[Key::Right], Action::Move(Direction::Right), "", "the cursor to the right"),
    row(&[Mode::Lab], &[Key::Char('<')], Action::StepCursor(Direction::Left), "", "the cursor one step to the left; 10< ten"),
    row(&[Mode::Lab], &[Key::Char('>')], Action::StepCursor(Direction::Right), "", "the cursor one step to the right"),
    row(&[Mode::Lab], &[Key::Char('(')], Action::ToTurn(Direction::Left), "", "the cursor to the last turn of the tilt before it"),
    row(&[Mode::Lab], &[Key::Char(')')], Action::ToTurn(Direction::Right), "", "the cursor to the next turn of the tilt"),
    row(&[Mode::Lab], &[Key::Enter], Action::GoToCursor, "", "go to the step at the cursor; without one, to the values"),
    row(&[Mode::Lab], &[Key::Char('w')], Action::WiderWindow, "", "show twice the time"),
    row(&[Mode::Lab], &[Key::Char('W')], Action::NarrowerWindow, "zoom", "show half the time"),
    row(&[Mode::Lab], &[Key::Char('[')], Action::Pan(Direction::Left), "pan", "show earlier times"),
    row(&[Mode::Lab], &[Key::Char(']')], Action::Pan(Direction::Right), "", "show later times"),
    row(&[Mode::Lab], &[Key::Char('z')], Action::Magnify(true), "values", "magnify the values"),
    row(&[Mode::Lab], &[Key::Char('Z')], Action::Magnify(false), "", "magnify them less"),
    row(&[Mode::Lab], &[Key::Home], Action::WholeView, "whole", "show the run again as at first: no cursor, no zoom"),
];

/// The traces of a run.
pub struct Traces<'a> {
    /// The run.
    pub run: &'a LiveRun,
    /// The run before, faint under it.
    pub ghost: Option<&'a Ghost>,
    /// The run that was pinned as the reference, unless it is the present one.
    pub pinned: Option<&'a Ghost>,
    /// How it is looked at.
    pub view: &'a View,
    /// The time that the strip of the fast motion shows.
    pub detail: &'a Detail,
    /// The numbers at the cursor, where there is one.
    pub cursor: Option<&'a Sample>,
}

/// Strips one above the other over the same time, and the axis below them.
struct Group {
    curves: Vec<Curve>,
    area: Rect,
    /// Columns beside the strips for their values; none where these stand on a line above each.
    beside: u16,
    strip: Strip,
}

impl Widget for Traces<'_> {
    fn render(self, area: Rect, buf: &mut Buffer) {
        let theme = &self.view.theme;
        let title = self.title(area.width.saturating_sub(4) as usize);
        let inside = frame(&title, area, self.view.focus == ROW.id, theme, buf);
        if inside.width == 0 {
            return;
        }
        let beside = self.beside(inside);
        let groups = self.groups(inside, beside);
        let marks = Marks::of(self.run.scenario());
        for group in &groups {
            self.group(group, &marks, buf);
        }
        if let Some(last) = groups.last() {
            let border = Rect {
                x: inside.x + beside,
                width: inside.width - beside,
                y: area.bottom() - 1,
                height: 1,
            };
            self.pushes(&marks, &last.strip, border, buf);
        }
    }
}

impl Traces<'_> {
    /// What is drawn: the point, and the runs beside it where there are any, as far as there is room.
    fn title(&self, room: usize) -> String {
        if let Some(cursor) = self.cursor {
            let (step, time_s) = (cursor.step, decimal(cursor.time_s));
            return format!("step {step} at {time_s} s");
        }
        let named = self.run.scenario().file.trace.as_deref();
        let point = named.unwrap_or("axle top");
        let beside = [
            (self.run.overlay().is_some(), EXACT),
            (self.ghost.is_some(), OTHER),
            (self.pinned.is_some(), PINNED),
        ];
        let legend = |length: usize, between: &str| {
            let shown = beside.iter().filter(|(is_shown, _)| *is_shown);
            let words: Vec<_> = shown.map(|(_, legends)| legends[length]).collect();
            words.join(between)
        };
        let long = [ROW.title.to_owned(), legend(0, ", ")];
        let long = long.into_iter().filter(|part| !part.is_empty());
        let long = long.collect::<Vec<_>>().join(", ");
        let mut titles = vec![format!("{point} {long}")];
        let is_divided = self.detail.window_s < 0.999 * self.view.window_s;
        let has_exact = self.run.overlay().is_some();
        if self.ghost.is_none() && self.pinned.is_none() && (is_divided || has_exact) {
            titles.insert(0, format!("{point} {long}; {BANDS}"));
        }
        let shortest = match legend(2, " ") {
            none if none.is_empty() => ROW.title.to_owned(),
            shortest => {
                titles.push(format!("{point} {}", legend(1, " ")));
                titles.push(format!("{point} {shortest}"));
                shortest
            }
        };
        let fits = |title: &String| title.chars().count() <= room;
        titles.into_iter().find(fits).unwrap_or(shortest)
    }

    /// Columns for the values beside the strips.
    fn beside(&self, inside: Rect) -> u16 {
        if inside.width < BESIDE_FROM {
            return 0;
        }
        let labels = Curve::ALL.map(|curve| axis::values(&self.scale(curve, None), 2));
        let widest = labels.iter().flatten().map(|(_, label)| label.len()).max();
        NAME + widest.unwrap_or(0) as u16 + 1
    }

    /// The strips that there is room for, and where they stand.
    fn groups(&self, inside: Rect, beside: u16) -> Vec<Group> {
        let across = self.view.marker.dots().0;
        let columns = (inside.width - beside) as usize * across;
        let long = match self.view.since_s {
            Some(since_s) => Strip::new(since_s, self.view.window_s, columns),
            None => Strip::following(self.run.now().time_s, self.view.window_s, columns),
        };
        let detail = Strip::new(self.detail.begin_s, self.detail.window_s, columns);
        let is_magnified = self.is_detail(&detail);
        let least = if beside > 0 { 1 } else { STRIP };
        let axes = 1 + u16::from(is_magnified);
        let strips = inside.height.saturating_sub(axes) / least;
        let shown = self.shown(strips as usize);
        let split = usize::from(is_magnified).min(shown.len());
        let (upper, lower) = shown.split_at(split);
        let parts = [(upper, detail), (lower, long)];
        let rows = inside.height.saturating_sub(axes);
        let mut y = inside.y;
        let mut groups = Vec::new();
        for (curves, strip) in parts.into_iter().filter(|(curves, _)| !curves.is_empty()) {
            let is_last = curves.last() == shown.last();
            let share = (rows * curves.len() as u16).div_ceil(shown.len() as u16);
            let height = match is_last {
                true => inside.bottom() - y,
                false => share + 1,
            };
            let area = Rect {
                y,
                height,
                ..inside
            };
            y += height;
            groups.push(Group {
                curves: curves.to_vec(),
                area,
                beside,
                strip,
            });
        }
        groups
    }

    /// The curves that are shown where there is room for `most` strips, from the top: the one of the fast motion, and then
    /// the others in their order. Where there is no room for all, z goes before y, and x before both.
    fn shown(&self, most: usize) -> Vec<Curve> {
        let first = self.detail.curve;
        let by_worth = [Curve::X, Curve::Z, Curve::Tilt, Curve::Y];
        let others = by_worth.into_iter().filter(|curve| *curve != first);
        let chosen: Vec<_> = others.take(most.saturating_sub(1)).collect();
        let others = Curve::ALL
            .into_iter()
            .filter(|curve| chosen.contains(curve));
        std::iter::once(first).take(most).chain(others).collect()
    }

    /// Whether `strip` shows less time than the others: the fast motion.
    fn is_detail(&self, strip: &Strip) -> bool {
        strip.window_s < 0.999 * self.view.window_s
    }

    fn group(&self, group: &Group, marks: &Marks, buf: &mut Buffer) {
        let count = group.curves.len() as u16;
        let rows = group.area.height.saturating_sub(1);
        let (share, spare) = (rows / count, rows % count);
        let mut y = group.area.y;
        for (&curve, index) in group.curves.iter().zip(0..) {
            let height = share + u16::from(index < spare);
            let place = Rect {
                y,
                height,
                ..group.area
            };
            self.strip(curve, group, marks, place, buf);
            y += height;
        }
        let axis = Rect {
            x: group.area.x + group.beside,
            width: group.area.width - group.beside,
            y,
            height: 1,
        };
        let style = self.view.theme.style(Role::Quiet);
        for (at, label) in axis::times(&group.strip, axis.width as usize) {
            write(axis, (at as u16, 0), &label, style, buf);
        }
    }

    /// One strip with its name and its values.
    fn strip(&self, curve: Curve, group: &Group, marks: &Marks, area: Rect, buf: &mut Buffer) {
        let is_detail = self.is_detail(&group.strip);
        let scale = self.magnified(curve, self.scale(curve, is_detail.then_some(&group.strip)));
        let theme = &self.view.theme;
        let (name, quiet) = (theme.style(role(curve)), theme.style(Role::Quiet));
        let sheet = if group.beside > 0 {
            write(area, (0, 0), curve.name(), name, buf);
            if area.height > 1 {
                write(area, (0, 1), curve.unit(), quiet, buf);
            }
            if area.height > 2 && self.is_detail(&group.strip) {
                write(area, (0, 2), ZOOM, quiet, buf);
            }
            for (row, label) in axis::values(&scale, area.height as usize) {
                let x = group.beside.saturating_sub(1 + label.len() as u16);
                write(area, (x, row as u16), &label, quiet, buf);
                write(area, (group.beside - 1, row as u16), "┤", quiet, buf);
            }
            Rect {
                x: area.x + group.beside,
                width: area.width - group.beside,
                ..area
            }
        } else {
            let after = write(area, (0, 0), curve.name(), name, buf);
            let value = self.at_cursor(curve, &group.strip);
            let (text, style) = match value {
                Some((_, value)) => (format!(" {value}"), theme.style(Role::Focus)),
                None => {
                    let range = format!(" {} {}", scale.in_words(), curve.unit());
                    let zoom = if self.is_detail(&group.strip) {
                        ZOOM
                    } else {
                        ""
                    };
                    let room = (area.width as usize).saturating_sub(range.len() + NAME as usize);
                    let zoom = if zoom.len() < room { zoom } else { "" };
                    (format!("{range} {zoom}"), quiet)
                }
            };
            write(area, (after, 0), &text, style, buf);
            Rect {
                y: area.y + 1,
                height: area.height.saturating_sub(1),
                ..area
            }
        };
        self.curves(curve, &group.strip, &scale, marks, sheet, buf);
        self.cursor(curve, group, sheet, buf);
        self.pen(&group.strip, sheet, buf);
        self.edits(marks, &group.strip, sheet, buf);
    }

    fn curves(
        &self,
        curve: Curve,
        strip: &Strip,
        scale: &Scale,
        marks: &Marks,
        area: Rect,
        buf: &mut Buffer,
    ) {
        let mut dots = Dots::new(area, self.view.marker);
        // Where swings are shown one by one, few columns are no reason for a band.
        let columns = |recording: &Recording, cuts: &[f64]| {
            let mut columns = strip.columns(recording, curve, cuts);
            if self.is_detail(strip) {
                let columns = columns.iter_mut().flatten();
                columns.for_each(|column| column.band = None);
            }
            columns
        };
        if let Some(ghost) = self.ghost {
            let before = columns(ghost.recording(), &ghost.marks().edits);
            draw(&mut dots, &before, scale, Stroke::Dotted, Ink::Ghost);
        }
        if let Some(pinned) = self.pinned {
            let kept = columns(pinned.recording(), &pinned.marks().edits);
            let ink = Ink::Faint(Role::Pinned);
            draw(&mut dots, &kept, scale, Stroke::LongAndShort, ink);
        }
        if let Some(overlay) = self.run.overlay() {
            let exact = columns(overlay.recording(), &[]);
            draw(
                &mut dots,
                &exact,
                scale,
                Stroke::Dashed,
                Ink::Faint(Role::Exact),
            );
        }
        let run = columns(self.run.recording(), &marks.edits);
        draw(
            &mut dots,
            &run,
            scale,
            Stroke::Full,
            Ink::Strong(role(curve)),
        );
        dots.render(&self.view.theme, buf);
    }

    /// The cursor: a line at its time, and the value there where it does not stand above the strip.
    fn cursor(&self, curve: Curve, group: &Group, area: Rect, buf: &mut Buffer) {
        let Some((column, value)) = self.at_cursor(curve, &group.strip) else {
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

    /// The column (of dots) of the cursor on `strip`, and what `curve` has there.
    fn at_cursor(&self, curve: Curve, strip: &Strip) -> Option<(usize, String)> {
        let cursor = self.cursor?;
        let column = strip.column(cursor.time_s)?;
        let value = fixed(value(curve, &cursor.position, cursor.tilt_deg), DECIMALS);
        Some((column, format!("{value} {}", curve.unit())))
    }

    /// `scale`, magnified as it is looked at.
    fn magnified(&self, curve: Curve, scale: Scale) -> Scale {
        if self.view.magnified <= 1.0 {
            return scale;
        }
        let about = match self.cursor {
            Some(cursor) => value(curve, &cursor.position, cursor.tilt_deg),
            None => self.run.now().value(curve),
        };
        scale.zoomed(self.view.magnified, about)
    }

    /// The range of values a strip shows: x and y share one about 0, z and tilt have their own. It is that of the whole
    /// run, or of the time of `strip` alone.
    fn scale(&self, curve: Curve, strip: Option<&Strip>) -> Scale {
        let extent = |curve| self.extent(curve, strip);
        let arm_m = self.run.scenario().arm_m();
        match curve {
            Curve::X | Curve::Y => {
                let both = extent(Curve::X).and(extent(Curve::Y));
                Scale::about_zero(both.max.max(-both.min).max(PLANE_LEAST * arm_m))
            }
            Curve::Z => Scale::around(extent(curve), Z_LEAST * arm_m),
            Curve::Tilt => Scale::around(extent(curve), TILT_LEAST),
        }
    }

    /// Everything the strip of `curve` has to show: the run, and where they are shown the exact motion, the run before
    /// and the pinned one: the whole of it at once, so that the picture stays while the run comes after it.
    fn extent(&self, curve: Curve, strip: Option<&Strip>) -> Extent {
        let exact = self.run.overlay().map(Overlay::recording);
        let before = self.ghost.map(Ghost::recording);
        let pinned = self.pinned.map(Ghost::recording);
        let recordings = [Some(self.run.recording()), exact, before, pinned];
        let extent = |recording: &Recording| match strip {
            Some(strip) => recording
                .between(strip.begin_s, strip.end_s())
                .map(|block| block.extent(curve))
                .reduce(Extent::and),
            None => recording.whole().map(|block| block.extent(curve)),
        };
        let extents = recordings.into_iter().flatten().filter_map(extent);
        extents.reduce(Extent::and).unwrap_or(Extent::of(0.0))
    }

    /// The pen: a line where the run stands.
    fn pen(&self, strip: &Strip, area: Rect, buf: &mut Buffer) {
        let Some(column) = strip.column(self.run.now().time_s) else {
            return;
        };
        let column = (column / self.view.marker.dots().0 + 1) as u16;
        self.upright(column, PEN, self.view.theme.style(Role::Quiet), area, buf);
    }

    /// A dotted line where an edit was made.
    fn edits(&self, marks: &Marks, strip: &Strip, area: Rect, buf: &mut Buffer) {
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

    /// Where pushes act: on the border below the strips, with the word beside it where there is room.
    fn pushes(&self, marks: &Marks, strip: &Strip, border: Rect, buf: &mut Buffer) {
        let across = self.view.marker.dots().0;
        let mut pushed = vec![false; border.width as usize];
        let shown =
            |&(begin_s, end_s): &(f64, f64)| strip.shown(begin_s, end_s.min(self.reach_s()));
        for column in marks.pushes.iter().flat_map(shown) {
            if let Some(cell) = pushed.get_mut(column / across) {
                *cell = true;
            }
        }
        let style = self.view.theme.style(Role::Push);
        for (x, _) in (0..).zip(&pushed).filter(|(_, pushed)| **pushed) {
            write(border, (x, 0), pushes::BAR, style, buf);
        }
        for x in pushes::words(&pushed) {
            write(border, (x as u16, 0), pushes::WORD, style, buf);
        }
    }

    /// The time up to which there is something to see, s.
    fn reach_s(&self) -> f64 {
        let before = self.ghost.map_or(0.0, Ghost::end_s);
        self.run.now().time_s.max(before)
    }
}

/// What `curve` has where the traced point is at `position` (world frame, m) and the axle at `tilt_deg` (degrees).
fn value(curve: Curve, position: &Vector3<f64>, tilt_deg: f64) -> f64 {
    match curve {
        Curve::X => position.x,
        Curve::Y => position.y,
        Curve::Z => position.z,
        Curve::Tilt => tilt_deg,
    }
}

/// The colour of a curve.
fn role(curve: Curve) -> Role {
    match curve {
        Curve::X => Role::X,
        Curve::Y => Role::Y,
        Curve::Z => Role::Z,
        Curve::Tilt => Role::Path,
    }
}
