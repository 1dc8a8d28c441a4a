//! The overview below the panes: z over the whole run, the window of the traces, the pushes and the edits.
//!
//! It is also a time line: a click or a drag goes to that time. If the traces show the whole run, it is one line, the
//! scrub line.

use super::traces::canvas::{Canvas, Layer};
use super::traces::{EDIT_MARK, Gutter, PUSH_BAR, cursor_line, draw_run, rows, times};
use super::{rule, write};
use crate::engine::recording::RecordedCurve;
use crate::engine::run::marks::Marks;
use crate::engine::text::number::decimal;
use crate::engine::text::wrap::columns;
use crate::lab::Lab;
use crate::lab::playback::scale::StripScale;
use crate::lab::playback::strip::Strip;
use crate::tui::split::split_rows;
use crate::tui::theme::Role;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

/// Minimum rows of an overview: its rule, a row of its curve, and its ruler. With fewer it is a scrub line.
const OVERVIEW_ROWS: u16 = 3;
/// Minimum columns of an overview.
const LEAST_WIDTH: u16 = 16;
/// Word next to a push.
const PUSH_WORD: &str = "push";
/// Word next to an edit.
const EDIT_WORD: &str = "edit";
/// Words at the end of the rule.
const WHOLE_RUN: &str = "whole run";
/// Edges of the window.
const WINDOW_EDGES: [&str; 2] = ["▕", "▏"];
/// Part of the scrub line that the run has reached.
const REACHED: &str = "━";
/// Part of the scrub line ahead of the run.
const AHEAD: &str = "─";
/// Current time on the scrub line.
const NOW_MARK: &str = "┃";
/// End of the scenario, or the cursor, on the scrub line.
const END_MARK: &str = "│";
/// Furthest time of the pinned run.
const PINNED_MARK: &str = "┤";

/// The overview of a run on an area of the screen.
pub struct Overview<'a> {
    lab: &'a Lab,
    marks: Marks,
    span: Strip,
    scale: StripScale,
    gutter: Gutter,
    area: Rect,
    /// Area of the curve, or the scrub line.
    sheet: Rect,
}

impl<'a> Overview<'a> {
    /// Returns the overview of `lab` on `area`, or `None` if there is no room.
    pub fn new(lab: &'a Lab, area: Rect) -> Option<Self> {
        if area.width < LEAST_WIDTH || area.height == 0 {
            return None;
        }
        let window = &lab.view().window;
        let scale = StripScale::of(window.overview, 0.0);
        let (gutter, sheet) = if area.height < OVERVIEW_ROWS {
            let label = columns(&end_label(lab)) as u16;
            let line = Rect {
                x: area.x + columns(START_LABEL) as u16,
                width: area
                    .width
                    .saturating_sub(label + columns(START_LABEL) as u16),
                height: 1,
                ..area
            };
            (Gutter { width: 0 }, line)
        } else {
            let [_, below] = split_rows(area, 1);
            let [curve, _] = split_rows(below, below.height - 1);
            let gutter = Gutter::new(&[scale], curve.height.into(), area.width);
            let sheet = Rect {
                x: curve.x + gutter.width,
                width: (curve.width - gutter.width).saturating_sub(1),
                ..curve
            };
            (gutter, sheet)
        };
        let across = lab.view().marker.dots().0;
        let span = Strip::new(
            window.span_begin_s,
            window.span_end_s - window.span_begin_s,
            usize::from(sheet.width) * across,
        );
        Some(Self {
            marks: Marks::new(lab.player().run().scenario()),
            lab,
            span,
            scale,
            gutter,
            area,
            sheet,
        })
    }

    /// Returns the time at column `x` of the screen, s, or `None` outside the overview.
    pub fn time_s(&self, x: u16) -> Option<f64> {
        let is_inside = (self.sheet.left()..self.sheet.right()).contains(&x);
        is_inside.then(|| self.nearest_time_s(x))
    }

    /// Returns the time at column `x` of the screen, s. Outside the overview, returns the time of its nearer end.
    pub fn nearest_time_s(&self, x: u16) -> f64 {
        let last = self.sheet.width.saturating_sub(1);
        let cell = x.saturating_sub(self.sheet.x).min(last);
        let share = f64::from(cell) / f64::from(last.max(1));
        self.span.begin_s + share * self.span.window_s
    }

    /// Returns the column of `time_s`, in cells. A time outside is moved to the nearer end.
    fn cell(&self, time_s: f64) -> u16 {
        let share = ((time_s - self.span.begin_s) / self.span.window_s).clamp(0.0, 1.0);
        (share * f64::from(self.sheet.width.saturating_sub(1))).round() as u16
    }

    fn draw(&self, buf: &mut Buffer) {
        if self.area.height < OVERVIEW_ROWS {
            return self.draw_scrub_line(buf);
        }
        let theme = &self.lab.view().theme;
        let right = Some((WHOLE_RUN, Role::Label));
        rule("z (m)", right, false, self.area, theme, buf);
        self.mark_rule(buf);
        self.gutter.write(&self.scale, self.sheet, theme, buf);
        self.draw_curve(buf);
        self.draw_window(buf);
        if let Some(cursor) = self.lab.player().cursor() {
            let style = theme.style(Role::Cursor);
            cursor_line(self.cell(cursor.time_s), self.sheet, style, buf);
        }
        let ruler = Rect {
            y: self.area.bottom() - 1,
            height: 1,
            ..self.sheet
        };
        for (at, label) in times(&self.span, ruler.width.into()) {
            write(ruler, (at as u16, 0), &label, theme.style(Role::Label), buf);
        }
    }

    /// Marks pushes and edits on the rule, with a word if there is room.
    fn mark_rule(&self, buf: &mut Buffer) {
        let line = Rect {
            y: self.area.y,
            width: self
                .sheet
                .width
                .saturating_sub(columns(WHOLE_RUN) as u16 + 1),
            height: 1,
            ..self.sheet
        };
        let across = self.lab.view().marker.dots().0;
        let theme = &self.lab.view().theme;
        let mut words = Vec::new();
        for &(begin_s, end_s) in &self.marks.pushes {
            let shown = self.span.shown(begin_s, end_s);
            let cells = (shown.start / across) as u16..shown.end.div_ceil(across) as u16;
            words.extend((!cells.is_empty()).then_some((cells.end, PUSH_WORD)));
            for x in cells {
                write(line, (x, 0), PUSH_BAR, theme.style(Role::Push), buf);
            }
        }
        for edit_s in self.shown_edits() {
            let x = self.cell(edit_s);
            words.push((x + 1, EDIT_WORD));
            write(line, (x, 0), EDIT_MARK, theme.style(Role::Push), buf);
        }
        words.sort_unstable();
        for (index, (x, word)) in words.iter().enumerate() {
            let text = format!(" {word} ");
            let end = x + columns(&text) as u16;
            let next = words.get(index + 1).map_or(line.width, |(next, _)| *next);
            if end <= next.min(line.width) {
                write(line, (*x, 0), &text, theme.style(Role::Text), buf);
            }
        }
    }

    /// Returns the times of the edits within the overview, s.
    fn shown_edits(&self) -> impl Iterator<Item = f64> + '_ {
        let edits = self.marks.edits.iter().copied();
        edits.filter(|edit_s| (self.span.begin_s..=self.span.end_s()).contains(edit_s))
    }

    fn draw_curve(&self, buf: &mut Buffer) {
        let view = self.lab.view();
        let run = self.lab.player().run();
        let mut canvas = Canvas::new(self.sheet, view.marker);
        let bins = self.span.bins(run.recording());
        let mut extents = bins.columns(RecordedCurve::Z, &self.marks.edits);
        if view.window.is_held {
            // The curve grows with each window, so that little is sent between two of them.
            let drawn = self.span.shown(self.span.begin_s, view.window.end_s);
            extents[drawn.end..].fill(None);
        }
        let columns = rows(&extents, &self.scale, canvas.height());
        let shown = self.span.shown(view.window.begin_s, view.window.end_s);
        let layer = |x: usize| {
            if shown.contains(&x) {
                Layer::Run
            } else {
                Layer::Earlier
            }
        };
        self.draw_run_before(&mut canvas);
        draw_run(&columns, layer, &mut canvas);
        canvas.render(&view.theme, buf);
    }

    /// Draws the edges of the previous run, dotted.
    fn draw_run_before(&self, canvas: &mut Canvas) {
        let Some(before) = self.lab.comparison().ghost() else {
            return;
        };
        let bins = self.span.bins(&before.recording);
        let extents = bins.columns(RecordedCurve::Z, &before.marks.edits);
        let columns = rows(&extents, &self.scale, canvas.height());
        for (x, column) in columns.iter().enumerate().step_by(2) {
            for edge in column.iter().flat_map(|(upper, lower)| [*upper, *lower]) {
                canvas.upright(x, (edge, edge), Layer::Previous);
            }
        }
    }

    /// Draws the window of the traces: its background, and its edges.
    fn draw_window(&self, buf: &mut Buffer) {
        let view = self.lab.view();
        let across = view.marker.dots().0;
        let shown = self.span.shown(view.window.begin_s, view.window.end_s);
        let (first, end) = (shown.start / across, shown.end.div_ceil(across));
        let tint = view.theme.style(Role::WindowTint);
        for x in (first..end).filter(|x| *x < usize::from(self.sheet.width)) {
            for y in self.sheet.top()..self.sheet.bottom() {
                if let Some(cell) = buf.cell_mut((self.sheet.x + x as u16, y)) {
                    cell.set_style(tint);
                }
            }
        }
        let edges = [first.checked_sub(1), Some(end)];
        let style = view.theme.style(Role::Text);
        for (edge, sign) in edges.into_iter().zip(WINDOW_EDGES) {
            for y in 0..self.sheet.height {
                if let Some(x) = edge {
                    write(self.sheet, (x as u16, y), sign, style, buf);
                }
            }
        }
    }

    fn draw_scrub_line(&self, buf: &mut Buffer) {
        let theme = &self.lab.view().theme;
        let run = self.lab.player().run();
        let label = theme.style(Role::Label);
        write(self.area, (0, 0), START_LABEL, label, buf);
        let end = self.sheet.right() - self.area.x;
        write(self.area, (end, 0), &end_label(self.lab), label, buf);
        let mut put = |x: u16, text: &str, role| {
            write(self.sheet, (x, 0), text, theme.style(role), buf);
        };
        let furthest = self.cell(self.lab.player().furthest_s());
        for x in 0..self.sheet.width {
            if x < furthest {
                put(x, REACHED, Role::Run);
            } else {
                put(x, AHEAD, Role::Rule);
            }
        }
        for &(begin_s, end_s) in self
            .marks
            .pushes
            .iter()
            .filter(|push| push.0 < self.span.end_s())
        {
            for x in self.cell(begin_s)..=self.cell(end_s) {
                put(x, PUSH_MARK, Role::Push);
            }
        }
        if self.span.end_s() > self.lab.player().end_s {
            put(self.cell(self.lab.player().end_s), END_MARK, Role::Text);
        }
        for edit_s in self.shown_edits() {
            put(self.cell(edit_s), EDIT_MARK, Role::Push);
        }
        if let Some(pinned_s) = self.lab.comparison().pinned_end_s(run) {
            put(self.cell(pinned_s), PINNED_MARK, Role::Previous);
        }
        put(self.cell(run.now().time_s), NOW_MARK, Role::Cursor);
        if let Some(cursor) = self.lab.player().cursor() {
            put(self.cell(cursor.time_s), END_MARK, Role::Cursor);
        }
    }
}

/// A push on the scrub line.
const PUSH_MARK: &str = "═";
const START_LABEL: &str = "0 s ";

fn end_label(lab: &Lab) -> String {
    format!(" {} s", decimal(lab.view().window.span_end_s))
}

pub fn draw(lab: &Lab, area: Rect, buf: &mut Buffer) {
    if let Some(overview) = Overview::new(lab, area) {
        overview.draw(buf);
    }
}
