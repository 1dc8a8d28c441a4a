//! The traced point and the tilt over time. The upper strip shows the tilt over a few swings, so that fast motion is seen
//! as it is; those below show x, y and z over a longer time, so that slow motion is.

mod axis;
mod content;
mod curve;
mod groups;
mod points;
mod pushes;
mod range;
mod shared;
mod title;
mod uprights;

use super::{PaneRow, Width, frame, write};
use crate::lab::Lab;
use crate::lab::action::{Action, Direction};
use crate::lab::measured::Beside;
use crate::lab::view::{Pane, View};
use crate::observe::detail::Detail;
use crate::observe::ghost::Ghost;
use crate::observe::live::LiveRun;
use crate::observe::marks::Marks;
use crate::observe::scale::Scale;
use crate::observe::strip::Column;
use crate::run::Sample;
use crate::tui::dots::{Dots, Ink};
use crate::tui::keymap::{Binding, Key, Mode, row};
use crate::tui::theme::Role;
use content::Content;
use curve::{Stroke, THINNEST_BAND, draw};
use groups::Group;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::widgets::Widget;
use shared::Shared;

/// Fewest rows of a strip: its label and one row of dots.
const STRIP: u16 = 2;
/// A strip that shows less than this part of the time of the others shows the fast motion alone.
const ALL: f64 = 0.999;
/// What marks the strip that shows less time than the others.
const ZOOM: &str = "zoom";
/// What is said of a strip with bands, on a line above it and beside it: the longest that fits.
const BAND: [&str; 2] = ["fast swings", "swings"];
const BAND_BESIDE: [&str; 2] = ["fast", "band"];
/// What it says while that strip is drawn anew once a second only, because its time would pass before anyone had seen it:
/// the longest that fits.
const HELD: [&str; 3] = ["zoom, held for a second each", "zoom, held", "held"];
/// What follows the name of what was measured where it is shown less what the run says.
const LESS_RUN: &str = " less run";
const NAME: u16 = 5;

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
    row(&[Mode::Lab], &[Key::Up], Action::Move(Direction::Up), "", "another curve in the strip zoom: tilt, z, y, x; Home: what swings"),
    row(&[Mode::Lab], &[Key::Down], Action::Move(Direction::Down), "", "the same, the other way round"),
    row(&[Mode::Lab], &[Key::Home], Action::WholeView, "whole", "show the run again as at first: no cursor, no zoom"),
];

pub struct Traces<'a> {
    pub run: &'a LiveRun,
    pub ghost: Option<&'a Ghost>,
    /// The run that was pinned as the reference, unless it is the present one.
    pub pinned: Option<&'a Ghost>,
    pub measured: Option<&'a Beside>,
    pub view: &'a View,
    pub detail: &'a Detail,
    pub cursor: Option<&'a Sample>,
}

impl<'a> Traces<'a> {
    pub fn of(lab: &'a Lab) -> Self {
        Self {
            run: lab.player().run(),
            ghost: lab.player().ghost(),
            pinned: lab.player().pinned(),
            measured: lab.player().measured(),
            view: lab.view(),
            detail: &lab.player().detail,
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
            let zoomed = groups.iter().find(|group| self.is_detail(&group.strip));
            let zoomed = zoomed.map(|group| &group.strip);
            self.below(&marks, zoomed, &last.strip, border, buf);
        }
    }
}

impl Traces<'_> {
    fn group(&self, group: &Group, marks: &Marks, buf: &mut Buffer) {
        let mut columns = Shared::on(&group.strip);
        for &(content, place) in &group.strips {
            self.strip(content, group, marks, &mut columns, place, buf);
        }
        let axis = Rect {
            x: group.area.x + group.beside,
            width: group.area.width - group.beside,
            y: group.area.bottom().saturating_sub(1),
            height: 1,
        };
        let style = self.view.theme.style(Role::Quiet);
        for (at, label) in axis::times(&group.strip, axis.width as usize) {
            write(axis, (at as u16, 0), &label, style, buf);
        }
    }

    fn strip<'s>(
        &'s self,
        content: Content,
        group: &'s Group,
        marks: &Marks,
        columns: &mut Shared<'s>,
        area: Rect,
        buf: &mut Buffer,
    ) {
        let is_detail = self.is_detail(&group.strip);
        let is_residual = self.is_residual(content, is_detail);
        let scale = if is_residual {
            self.residual_scale(content)
        } else {
            self.scale(content, is_detail.then_some(&group.strip))
        };
        let mut run = self.columns_of_run(content, columns, &marks.edits);
        if is_detail {
            without_bands(&mut run);
        }
        let (across, down) = self.view.marker.dots();
        let rows = f64::from(area.height) * down as f64;
        // A band of large dots hides the curve as soon as it is one dot high.
        let thinnest = across.min(THINNEST_BAND) as f64;
        let has_band = run.iter().flatten().filter_map(|column| column.band);
        let has_band = has_band
            .map(|band| scale.from_top(band.min) - scale.from_top(band.max))
            .any(|share| share * rows >= thinnest);
        let sheet = if group.beside > 0 {
            self.beside_strip(content, group, &scale, has_band, area, buf)
        } else {
            self.above_strip(content, group, &scale, has_band, area, buf)
        };
        if is_residual {
            self.draw_zero(&scale, sheet, buf);
        } else {
            self.curves(content, &run, columns, &scale, sheet, buf);
        }
        self.draw_points(content, &group.strip, &scale, is_residual, sheet, buf);
        self.cursor(content, group, sheet, buf);
        self.pen(&group.strip, sheet, buf);
        self.edits(marks, &group.strip, sheet, buf);
    }

    /// Writes the name of `content` at the upper left of `area`; gives the column after it, and the unit.
    fn name(&self, content: Content, area: Rect, buf: &mut Buffer) -> (u16, &'static str) {
        let (name, unit) = self.named(content);
        let style = self.view.theme.style(Self::role(content));
        (write(area, (0, 0), &name, style, buf), unit)
    }

    /// The name of a strip and its values, beside it; gives the area of its curves.
    fn beside_strip(
        &self,
        content: Content,
        group: &Group,
        scale: &Scale,
        has_band: bool,
        area: Rect,
        buf: &mut Buffer,
    ) -> Rect {
        let (_, unit) = self.name(content, area, buf);
        let is_detail = self.is_detail(&group.strip);
        let quiet = self.view.theme.style(Role::Quiet);
        let further = match (is_detail, self.detail.is_snapshot) {
            (true, true) => [unit, ZOOM, HELD[2]],
            (true, false) => [unit, ZOOM, ""],
            (false, _) if self.is_residual(content, is_detail) => [unit, "less", "run"],
            (false, _) if has_band => [unit, BAND_BESIDE[0], BAND_BESIDE[1]],
            (false, _) => [unit, "", ""],
        };
        for (text, y) in further.into_iter().zip(1..area.height) {
            write(area, (0, y), text, quiet, buf);
        }
        for (row, label) in axis::values(scale, area.height as usize) {
            let x = group.beside.saturating_sub(1 + label.len() as u16);
            write(area, (x, row as u16), &label, quiet, buf);
            write(area, (group.beside - 1, row as u16), "┤", quiet, buf);
        }
        Rect {
            x: area.x + group.beside,
            width: area.width - group.beside,
            ..area
        }
    }

    /// The name of a strip and its values on a line above it; gives the area of its curves.
    fn above_strip(
        &self,
        content: Content,
        group: &Group,
        scale: &Scale,
        has_band: bool,
        area: Rect,
        buf: &mut Buffer,
    ) -> Rect {
        let (mut after, unit) = self.name(content, area, buf);
        let is_detail = self.is_detail(&group.strip);
        let theme = &self.view.theme;
        let quiet = theme.style(Role::Quiet);
        if self.is_residual(content, is_detail) {
            after = write(area, (after, 0), LESS_RUN, quiet, buf);
        }
        let room = area.width.saturating_sub(after) as usize;
        let value = self.at_cursor(content, &group.strip);
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
                let rest = room.saturating_sub(unit.len() + 2);
                let range = scale.in_words_within(rest).unwrap_or_default();
                let range = format!(" {range} {unit}");
                let words: &[&str] = match (is_detail, self.detail.is_snapshot) {
                    (false, _) if has_band => &BAND,
                    (false, _) => &[],
                    (true, false) => &[ZOOM],
                    (true, true) => &HELD,
                };
                let fits = |word: &&&str| range.chars().count() + word.len() < room;
                let word = words.iter().find(fits).copied().unwrap_or_default();
                (format!("{range} {word}"), quiet)
            }
        };
        write(area, (after, 0), &text, style, buf);
        Rect {
            y: area.y + 1,
            height: area.height.saturating_sub(1),
            ..area
        }
    }

    fn curves<'s>(
        &'s self,
        content: Content,
        run: &[Option<Column>],
        shared: &mut Shared<'s>,
        scale: &Scale,
        area: Rect,
        buf: &mut Buffer,
    ) {
        let mut dots = Dots::new(area, self.view.marker);
        let is_detail = self.is_detail(shared.strip);
        let without_bands = |mut columns: Vec<Option<Column>>| {
            if is_detail {
                without_bands(&mut columns);
            }
            columns
        };
        if let (Some(ghost), Some((recording, curve))) = (self.ghost, self.recorded_before(content))
        {
            let before = shared.columns(recording, curve, &ghost.marks.edits);
            let before = without_bands(before);
            draw(&mut dots, &before, scale, Stroke::Dotted, Ink::Ghost);
        }
        if let (Some(pinned), Content::Curve(curve)) = (self.pinned, content) {
            let kept = shared.columns(&pinned.recording, curve, &pinned.marks.edits);
            let kept = without_bands(kept);
            let ink = Ink::Faint(Role::Pinned);
            draw(&mut dots, &kept, scale, Stroke::LongAndShort, ink);
        }
        if let (Some(overlay), Content::Curve(curve)) = (self.run.overlay(), content) {
            let exact = without_bands(shared.columns(&overlay.recording, curve, &[]));
            let ink = Ink::Faint(Role::Exact);
            draw(&mut dots, &exact, scale, Stroke::Dashed, ink);
        }
        let ink = Ink::Strong(Self::role(content));
        // The dots of a filled band and the dashes of the exact motion look different only where dots are small.
        let (across, down) = dots.in_a_cell();
        let has_dashes = self.run.overlay().is_some();
        let stroke = if has_dashes && across * down <= 2 {
            Stroke::Edges
        } else {
            Stroke::Full
        };
        draw(&mut dots, run, scale, stroke, ink);
        dots.render(&self.view.theme, buf);
    }
}

/// Makes bands of `columns` lines: where swings are shown one by one, few columns are no reason for a band.
fn without_bands(columns: &mut [Option<Column>]) {
    let columns = columns.iter_mut().flatten();
    columns.for_each(|column| column.band = None);
}
