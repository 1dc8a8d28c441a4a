//! The traced point and the tilt over time. The upper strip shows the tilt over a few swings, so that fast motion is seen
//! as it is; those below show x, y and z over a longer time, so that slow motion is.

mod axis;
mod curve;
mod pointing;
mod pushes;
mod range;
mod title;
mod uprights;

use super::{PaneRow, Width, frame, write};
use crate::lab::Lab;
use crate::lab::action::{Action, Direction};
use crate::lab::view::{Pane, View};
use crate::observe::detail::Detail;
use crate::observe::ghost::Ghost;
use crate::observe::live::LiveRun;
use crate::observe::marks::Marks;
use crate::observe::recording::{Curve, Recording};
use crate::observe::scale::Scale;
use crate::observe::strip::Strip;
use crate::run::Sample;
use crate::tui::dots::{Dots, Ink};
use crate::tui::keymap::{Binding, Key, Mode, row};
use crate::tui::theme::Role;
use curve::{Stroke, draw};
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::widgets::Widget;

/// Fewest rows of a strip: its label and one row of dots.
const STRIP: u16 = 2;
/// From this width on the values stand beside the strips, and not on a line above each.
const BESIDE_FROM: u16 = 48;
/// A strip that shows less than this part of the time of the others shows the fast motion alone.
const ALL: f64 = 0.999;
/// What marks the strip that shows less time than the others.
const ZOOM: &str = "zoom";
/// What it says while that strip stands still, because its time would pass before anyone had seen it.
const STILL: &str = "still";
/// Columns of a strip's name beside it.
const NAME: u16 = 5;

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

impl<'a> Traces<'a> {
    /// The traces of the run in `lab`.
    pub fn of(lab: &'a Lab) -> Self {
        Self {
            run: lab.player().run(),
            ghost: lab.player().ghost(),
            pinned: lab.player().pinned(),
            view: lab.view(),
            detail: lab.player().detail(),
            cursor: lab.player().cursor(),
        }
    }
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
    /// Columns for the values beside the strips.
    fn beside(&self, inside: Rect) -> u16 {
        if inside.width < BESIDE_FROM {
            return 0;
        }
        let labels = Curve::ALL.map(|curve| {
            let scale = self.magnified(curve, self.scale(curve, None));
            let mut labels = axis::values(&scale, 2);
            labels.extend(axis::values(&scale, inside.height as usize));
            labels
        });
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
        strip.window_s < ALL * self.view.window_s
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
            if area.height > 2 && is_detail {
                write(area, (0, 2), ZOOM, quiet, buf);
                if self.detail.is_snapshot && area.height > 3 {
                    write(area, (0, 3), STILL, quiet, buf);
                }
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
            let room = area.width.saturating_sub(after) as usize;
            let value = self.at_cursor(curve, &group.strip);
            let (text, style) = match value {
                Some((_, value)) => {
                    let value = format!(" {value}");
                    let rest = room.saturating_sub(value.len() + " ()".len());
                    if let Some(range) = scale.in_words_within(rest) {
                        let x = after + value.len() as u16;
                        write(area, (x, 0), &format!(" ({range})"), quiet, buf);
                    }
                    (value, theme.style(Role::Focus))
                }
                None => {
                    let unit = curve.unit();
                    let rest = room.saturating_sub(unit.len() + 2);
                    let range = scale.in_words_within(rest).unwrap_or_default();
                    let range = format!(" {range} {unit}");
                    let zoom = match (is_detail, self.detail.is_snapshot) {
                        (false, _) => [""; 3],
                        (true, false) => [ZOOM; 3],
                        (true, true) => ["zoom, stands still", "zoom, still", STILL],
                    };
                    let fits = |zoom: &&str| range.chars().count() + zoom.len() < room;
                    let zoom = zoom.into_iter().find(fits).unwrap_or_default();
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
