//! The traced point and the tilt over time. The upper strip shows the tilt over a few swings, so that fast motion is seen
//! as it is; those below show x, y and z over a longer time, so that slow motion is.

mod axis;
mod border;
mod groups;
mod plot;

use super::{PaneRow, PlotInputs, Width, frame, longest, write};
use crate::lab::action::{Action, Direction, repeated, signed};
use crate::lab::command::{Command, CursorTo};
use crate::lab::playback::marks::Marks;
use crate::lab::view::Pane;
use crate::tui::dots::{Dots, Ink};
use crate::tui::keymap::{Binding, Key, Mode, does, narrower, one, row, wider};
use crate::tui::points::{Ends, Points};
use crate::tui::theme::Role;
use plot::Plot;
use ratatui::buffer::Buffer;
use ratatui::layout::{Margin, Rect};
use ratatui::style::Style;
use ratatui::widgets::Widget;

/// Fewest rows of a strip: its label and one row of dots.
const STRIP: u16 = 2;
/// A strip that shows less than this part of the time of the others shows the fast motion alone.
const WHOLE_TIME_SHARE: f64 = 0.999;
/// What marks the strip that shows less time than the others.
const ZOOM_MARK: &str = "zoom";
/// What is said of a strip with bands, on a line above it and beside it: the longest that fits.
const BAND_TEXTS: [&str; 2] = ["fast swings", "swings"];
const BAND_BESIDE: [&str; 2] = ["fast", "band"];
/// What it says while that strip is drawn anew once a second only, because its time would pass before anyone had seen it:
/// the longest that fits.
const HELD: [&str; 3] = ["zoom, held for a second each", "zoom, held", "held"];
/// What follows the name of what was measured where it is shown less what the run says.
const LESS_RUN: &str = " less run";
const STRIP_NAME_WIDTH: u16 = 5;
/// What marks the time of an edit, and the time where the run stands.
const EDIT_LINE: char = ':';
const NOW_LINE: char = '│';
const CURSOR_MARK: char = '┃';

pub const TRACES_ROW: PaneRow = PaneRow {
    id: Pane::Traces,
    title: "over time",
    width: Width::Wide,
    rank: 0,
    least: (27, 0),
    draw: |lab, area, buf| {
        Traces(PlotInputs::from_lab(lab)).render(area, buf);
    },
    keys: TRACES_PANE_KEYS,
    arrows: Some(|lab, direction, times| {
        let (view, player) = (lab.view(), lab.player());
        one(match direction {
            Direction::Left | Direction::Right => {
                view.moved_cursor(signed(direction, times), player)
            }
            _ => view.other_detail(direction, times, player),
        })
    }),
};

/// The keys that mean something here while the pane has the focus.
#[rustfmt::skip]
const TRACES_PANE_KEYS: &[Binding] = &[
    row(&[Mode::Lab], &[Key::Left], Action::Move(Direction::Left, 1), "cursor", "the cursor to the left: its values are shown; Esc takes it away"),
    row(&[Mode::Lab], &[Key::Right], Action::Move(Direction::Right, 1), "", "the cursor to the right"),
    does(&[Mode::Lab], &[Key::Char('<')], |lab, count| one(lab.view().stepped_cursor(-i64::from(repeated(count)), lab.player())), "", "the cursor one step to the left; 10< ten"),
    does(&[Mode::Lab], &[Key::Char('>')], |lab, count| one(lab.view().stepped_cursor(repeated(count).into(), lab.player())), "", "the cursor one step to the right"),
    does(&[Mode::Lab], &[Key::Char('(')], |_, _| one(Command::Cursor(CursorTo::TurnBefore)), "", "the cursor to the last turn of the tilt before it"),
    does(&[Mode::Lab], &[Key::Char(')')], |_, _| one(Command::Cursor(CursorTo::NextTurn)), "", "the cursor to the next turn of the tilt"),
    does(&[Mode::Lab], &[Key::Char('|')], |_, _| one(Command::Cursor(CursorTo::Mark)), "", "mark the turn at the cursor; at another turn, count the swings between: period, mean, and theory's"),
    row(&[Mode::Lab], &[Key::Enter], Action::GoToCursor, "", "go to the step at the cursor; without one, to the values"),
    does(&[Mode::Lab], &[Key::Char('w')], wider, "", "show twice the time"),
    does(&[Mode::Lab], &[Key::Char('W')], narrower, "zoom", "show half the time"),
    does(&[Mode::Lab], &[Key::Char('[')], |lab, count| one(lab.view().panned(-repeated(count), lab.player())), "pan", "show earlier times"),
    does(&[Mode::Lab], &[Key::Char(']')], |lab, count| one(lab.view().panned(repeated(count), lab.player())), "", "show later times"),
    does(&[Mode::Lab], &[Key::Char('z')], |lab, count| one(lab.view().other_magnification(repeated(count))), "values", "magnify the values"),
    does(&[Mode::Lab], &[Key::Char('Z')], |lab, count| one(lab.view().other_magnification(-repeated(count))), "", "magnify them less"),
    row(&[Mode::Lab], &[Key::Up], Action::Move(Direction::Up, 1), "", "another curve in the strip zoom: tilt, z, y, x; Home: what swings"),
    row(&[Mode::Lab], &[Key::Down], Action::Move(Direction::Down, 1), "", "the same, the other way round"),
    does(&[Mode::Lab], &[Key::Home], |lab, _| Ok(lab.view().whole(lab.player())), "whole", "show the run again as at first: no cursor, no zoom"),
];

pub struct Traces<'a>(pub PlotInputs<'a>);

impl Widget for Traces<'_> {
    fn render(self, area: Rect, buf: &mut Buffer) {
        let inside = area.inner(Margin::new(1, 1));
        let marks = Marks::new(self.0.run.scenario());
        let (beside, groups) = if inside.is_empty() {
            (0, Vec::new())
        } else {
            let beside = self.beside(inside);
            (beside, self.groups(inside, beside))
        };
        let plots: Vec<_> = groups
            .iter()
            .flat_map(|group| self.plots(group, beside, &marks))
            .collect();
        let has_band = plots.iter().any(|plot| plot.has_band);
        let title = self.title(has_band, area.width.saturating_sub(4) as usize);
        let theme = &self.0.view.theme;
        frame(&title, area, self.0.view.focus == TRACES_ROW.id, theme, buf);
        for plot in &plots {
            self.strip(plot, &marks, buf);
        }
        let line = |y| Rect {
            x: inside.x + beside,
            y,
            width: inside.width - beside,
            height: 1,
        };
        for group in &groups {
            let axis = line(group.area.bottom().saturating_sub(1));
            for (at, label) in axis::times(&group.strip, axis.width as usize) {
                write(axis, (at as u16, 0), &label, theme.style(Role::Quiet), buf);
            }
        }
        if let Some(last) = groups.last() {
            let zoomed = groups
                .iter()
                .find(|group| group.is_zoom)
                .map(|group| &group.strip);
            self.below(&marks, zoomed, &last.strip, line(area.bottom() - 1), buf);
        }
    }
}

impl Traces<'_> {
    fn strip(&self, plot: &Plot, marks: &Marks, buf: &mut Buffer) {
        let at_cursor = self.at_cursor(plot);
        let (name, unit) = self.named(plot.content);
        let style = self.0.view.theme.style(plot.content.role());
        let after = write(plot.area, (0, 0), &name, style, buf);
        let is_beside = plot.sheet.x > plot.area.x;
        if is_beside {
            self.label_beside(plot, unit, buf);
        } else {
            let value = at_cursor.as_ref().map(|(_, value)| value.as_str());
            self.label_above(plot, unit, value, after, buf);
        }
        let mut dots = Dots::new(plot.sheet, self.0.view.marker);
        if plot.is_residual {
            self.draw_zero(plot, &mut dots);
        }
        for (columns, stroke, ink) in &plot.curves {
            plot::draw_curve(&mut dots, columns, &plot.scale, *stroke, *ink);
        }
        dots.render(&self.0.view.theme, buf);
        self.draw_points(plot, buf);
        if let Some((column, value)) = at_cursor {
            self.cursor(column, value.as_str(), is_beside, plot.sheet, buf);
        }
        let quiet = self.0.view.theme.style(Role::Quiet);
        let across = self.0.view.marker.dots().0;
        let column = |time_s: f64| plot.strip.column(time_s).map(|column| column / across);
        if let Some(now) = column(self.0.run.now().time_s) {
            upright(now as u16 + 1, NOW_LINE, quiet, plot.sheet, buf);
        }
        for edit in marks.edits.iter().filter_map(|edit_s| column(*edit_s)) {
            upright(edit as u16, EDIT_LINE, quiet, plot.sheet, buf);
        }
    }

    /// What stands beside a strip besides its name: its unit, what it shows, and its values.
    fn label_beside(&self, plot: &Plot, unit: &str, buf: &mut Buffer) {
        let quiet = self.0.view.theme.style(Role::Quiet);
        let further = match plot {
            Plot { is_zoom: true, .. } if self.0.detail.is_snapshot => [unit, ZOOM_MARK, HELD[2]],
            Plot { is_zoom: true, .. } => [unit, ZOOM_MARK, ""],
            Plot {
                is_residual: true, ..
            } => [unit, "less", "run"],
            Plot { has_band: true, .. } => [unit, BAND_BESIDE[0], BAND_BESIDE[1]],
            _ => [unit, "", ""],
        };
        let area = plot.area;
        for (text, y) in further.into_iter().zip(1..area.height) {
            write(area, (0, y), text, quiet, buf);
        }
        let beside = plot.sheet.x - area.x;
        for (row, label) in axis::values(&plot.scale, area.height as usize) {
            let x = beside.saturating_sub(1 + label.len() as u16);
            write(area, (x, row as u16), &label, quiet, buf);
            write(area, (beside - 1, row as u16), "┤", quiet, buf);
        }
    }

    /// What stands on the line above a strip from the column `after` on: its range of values, or the value at the cursor.
    fn label_above(
        &self,
        plot: &Plot,
        unit: &str,
        value: Option<&str>,
        after: u16,
        buf: &mut Buffer,
    ) {
        let theme = &self.0.view.theme;
        let quiet = theme.style(Role::Quiet);
        let line = plot.area;
        let less_run = if plot.is_residual { LESS_RUN } else { "" };
        let after = write(line, (after, 0), less_run, quiet, buf);
        let room = line.width.saturating_sub(after) as usize;
        let Some(value) = value else {
            let words = self.range_in_words(plot, unit, room);
            write(line, (after, 0), &words, quiet, buf);
            return;
        };
        let after = write(
            line,
            (after, 0),
            &format!(" {value}"),
            theme.style(Role::Focus),
            buf,
        );
        let rest = room.saturating_sub(value.len() + "  ()".len());
        if let Some(range) = plot.scale.in_words_within(rest) {
            write(line, (after, 0), &format!(" ({range})"), quiet, buf);
        }
    }

    /// The range of values of a strip, and what it shows, in `room` columns.
    fn range_in_words(&self, plot: &Plot, unit: &str, room: usize) -> String {
        let range = plot
            .scale
            .in_words_within(room.saturating_sub(unit.len() + 2));
        let range = format!(" {} {unit}", range.unwrap_or_default());
        let words: &[&str] = match (plot.is_zoom, self.0.detail.is_snapshot) {
            (true, true) => &HELD,
            (true, false) => &[ZOOM_MARK],
            (false, _) if plot.has_band => &BAND_TEXTS,
            (false, _) => &[],
        };
        let forms = words
            .iter()
            .chain(&[""])
            .map(|word| format!("{range} {word}"));
        longest(forms, room)
    }

    fn draw_zero(&self, plot: &Plot, dots: &mut Dots) {
        let row = plot.scale.from_top(0.0) * dots.height() as f64;
        for x in (0..dots.width()).step_by(dots.in_a_cell().0) {
            dots.set(x as f64, row, Ink::Faint(Role::Quiet));
        }
    }

    /// The points of `plot`: those that the run has not reached are faint; as residuals they do not show.
    fn draw_points(&self, plot: &Plot, buf: &mut Buffer) {
        let (strip, sheet) = (&plot.strip, plot.sheet);
        let all = self.points(plot.content).unwrap_or_default();
        let begin = all.partition_point(|point| point.time_s < strip.begin_s);
        let end = all.partition_point(|point| point.time_s <= strip.end_s());
        let across = self.0.view.marker.dots().0;
        let height = f64::from(sheet.height);
        let mut points = Points::new(sheet, self.0.view.marker);
        for point in &all[begin..end.max(begin)] {
            let value = if plot.is_residual {
                point.residual()
            } else {
                Some(point.value)
            };
            let (Some(value), Some(column)) = (value, strip.column(point.time_s)) else {
                continue;
            };
            let role = if point.model.is_some() {
                Role::Measured
            } else {
                Role::Quiet
            };
            // The lowest value stands on the last row.
            let at = plot.scale.from_top(value) * height;
            let at = if at == height { at - 1.0 } else { at };
            let at = ((column / across) as f64, at);
            points.add(
                at,
                None,
                point.sigma.map(|sigma| -> Ends {
                    let ends = [value + sigma, value - sigma];
                    ends.map(|bound| plot.scale.from_top(bound) * height).into()
                }),
                role,
            );
        }
        points.render(&self.0.view.theme, buf);
    }

    /// The cursor: a line, and the value there where that does not stand above the strip.
    fn cursor(&self, column: u16, value: &str, is_beside: bool, sheet: Rect, buf: &mut Buffer) {
        let style = self.0.view.theme.style(Role::Focus);
        upright(column, CURSOR_MARK, style, sheet, buf);
        if is_beside {
            let width = value.len() as u16;
            let right = column + 2;
            let at = if right + width <= sheet.width {
                right
            } else {
                column.saturating_sub(width + 1)
            };
            write(sheet, (at, 0), value, style, buf);
        }
    }
}

/// A line from top to bottom behind everything else.
fn upright(column: u16, sign: char, style: Style, area: Rect, buf: &mut Buffer) {
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
