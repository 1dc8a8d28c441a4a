//! A strip: its rule with pushes and edits, its curves, and the cursor.

use super::axis::{Gutter, value_text};
use super::canvas::{Canvas, Layer};
use super::content::StripContent;
use super::curves::{CURVE_OWNERS, rows};
use super::{Plot, TRACES_ROW, Traces, write};
use crate::engine::recording::{Extent, RecordedCurve};
use crate::engine::run::marks::Marks;
use crate::engine::text::wrap::columns;
use crate::tui::panes::rule;
use crate::tui::points::{Ends, Points};
use crate::tui::theme::Role;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Style;

/// Text on the first strip's rule while the window is held.
const HELD_TEXT: &str = "every 1 s";
const EXACT_WORD: &str = "exact";
/// Legend of the exact motion.
const EXACT_LEGEND: &str = "╌╌ exact";
/// Legend of the exact motion if the run covers it everywhere.
const COVERED_EXACT_LEGEND: &str = "exact under run";
const PREVIOUS_LEGEND: &str = "··· previous run";
const PINNED_LEGEND: &str = "-- pinned run";
/// Suffix of a strip's title for residuals.
const RESIDUAL_SUFFIX: &str = "data - run";
/// Mark of a push on the rule.
pub const PUSH_BAR: &str = "━";
/// Mark of an edit on the rule.
pub const EDIT_MARK: &str = "┴";
const CURSOR_LINE: char = '│';
/// Dots of the cursor's line in a cell of small dots.
const CURSOR_BITS: u32 = 0x47;

impl Traces<'_> {
    /// Draws the strip `index` of `plots`.
    pub(super) fn strip(
        &self,
        index: usize,
        plot: &Plot,
        plots: &[Plot],
        gutter: &Gutter,
        marks: &Marks,
        buf: &mut Buffer,
    ) {
        let theme = &self.0.view.theme;
        let (name, unit) = self.named(plot.content);
        let title = match (plot.is_residual, unit) {
            (true, _) => format!("{name}: {RESIDUAL_SUFFIX} ({unit})"),
            (false, "") => name,
            (false, _) => format!("{name} ({unit})"),
        };
        let is_held = index == 0 && self.0.view.window.is_held;
        let has_focus = index == 0 && self.0.view.marks_focus_of(TRACES_ROW.id);
        let right = is_held.then_some((HELD_TEXT, Role::Label));
        rule(&title, right, has_focus, plot.area, theme, buf);
        self.mark_rule(plot, columns(&title) as u16, marks, buf);
        gutter.write(&plot.scale, plot.sheet, theme, buf);
        let mut canvas = Canvas::new(plot.sheet, self.0.view.marker);
        if plot.is_residual {
            let row = (plot.scale.from_top(0.0) * (canvas.height() as f64 - 1.0)).round();
            (0..canvas.width())
                .step_by(2)
                .for_each(|x| canvas.set(x, row, Layer::Run));
        } else {
            for owner in CURVE_OWNERS {
                self.draw_curve(owner, plot, marks, &mut canvas);
            }
            self.draw_now(plot, &mut canvas);
        }
        canvas.render(theme, buf);
        self.draw_points(plot, buf);
        self.mark_exact_outside(plot, canvas.height(), buf);
        if index + 1 == legend_index(plots) {
            self.legend(plot, buf);
        }
        self.draw_cursor(plot, buf);
    }

    /// Marks pushes and edits on the rule of `plot`, to the right of its title of `title_columns`.
    fn mark_rule(&self, plot: &Plot, title_columns: u16, marks: &Marks, buf: &mut Buffer) {
        let across = self.0.view.marker.dots().0;
        let line = self.rule_line(plot);
        let style = self.0.view.theme.style(Role::Push);
        let first = usize::from((plot.area.x + title_columns + 1).saturating_sub(line.x));
        for &(begin_s, end_s) in &marks.pushes {
            let shown = plot.strip.shown(begin_s, end_s);
            for x in (shown.start / across).max(first)..shown.end.div_ceil(across) {
                write(line, (x as u16, 0), PUSH_BAR, style, buf);
            }
        }
        let edits = marks.edits.iter();
        let cells = edits.filter_map(|edit_s| Some(plot.strip.column(*edit_s)? / across));
        for x in cells.filter(|x| *x >= first) {
            write(line, (x as u16, 0), EDIT_MARK, style, buf);
        }
    }

    /// Returns the part of the rule above the curves.
    fn rule_line(&self, plot: &Plot) -> Rect {
        Rect {
            y: plot.area.y,
            height: 1,
            ..plot.sheet
        }
    }

    /// Draws the dots of the displayed time at the end of the run's curve.
    fn draw_now(&self, plot: &Plot, canvas: &mut Canvas) {
        let now = self.0.run.now();
        let value = match plot.content {
            StripContent::Curve(curve) => Some(now.value(curve)),
            StripContent::Measured(_) | StripContent::Distance | StripContent::Column => {
                self.value_at(plot.content, now.time_s)
            }
        };
        let (Some(column), Some(value)) = (plot.strip.column(now.time_s), value) else {
            return;
        };
        let (across, down) = canvas.in_a_cell();
        let (wide, high) = (across.min(2), down.min(2));
        let height = canvas.height();
        let [Some((row, _))] = rows(&[Some(Extent::single(value))], &plot.scale, height)[..] else {
            return;
        };
        if !(0.0..height as f64).contains(&row) {
            return;
        }
        let column = column.min(canvas.width().saturating_sub(wide));
        let row = row.min(height.saturating_sub(high) as f64);
        for (x, y) in (0..wide).flat_map(|x| (0..high).map(move |y| (x, y))) {
            canvas.set(column + x, row + y as f64, Layer::Now);
        }
    }

    /// Draws the measured points of `plot`. Points that the run has not reached are faint, and have no residual.
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
                Role::Label
            };
            // The minimum value is on the last row.
            let row = |number: f64| plot.scale.from_top(number) * height;
            let at = if row(value) == height {
                height - 1.0
            } else {
                row(value)
            };
            let bar = point
                .sigma
                .map(|sigma| -> Ends { (row(value + sigma), row(value - sigma)) });
            points.add(((column / across) as f64, at), None, bar, role);
        }
        points.render(&self.0.view.theme, buf);
    }

    /// Marks where the exact motion is above or below the strip.
    fn mark_exact_outside(&self, plot: &Plot, height: usize, buf: &mut Buffer) {
        let style = self.0.view.theme.style(Role::Exact);
        let last = plot.sheet.height.saturating_sub(1);
        let outside = self.exact_outside(plot, height);
        for ((stretches, sign), y) in outside.into_iter().zip(["↑", "↓"]).zip([0, last]) {
            for stretch in stretches {
                let x = (stretch.start + stretch.end) / 2;
                write(plot.sheet, (x as u16, y), sign, style, buf);
            }
        }
    }

    /// Names the curves next to the run: the exact motion at the end of its line if there is room, the others on the
    /// rule.
    fn legend(&self, plot: &Plot, buf: &mut Buffer) {
        let theme = &self.0.view.theme;
        let is_named = self.name_exact(plot, buf);
        let has_exact = self.0.overlay().is_some() && !is_named;
        let exact = if self.covers_exact(plot) {
            COVERED_EXACT_LEGEND
        } else {
            EXACT_LEGEND
        };
        let words = [
            (has_exact, exact, Role::Exact),
            (self.0.ghost.is_some(), PREVIOUS_LEGEND, Role::Previous),
            (self.0.pinned.is_some(), PINNED_LEGEND, Role::Previous),
        ];
        let mut right = plot.area.width;
        for (_, text, role) in words.into_iter().filter(|(is_shown, ..)| *is_shown) {
            let width = columns(text) as u16 + 2;
            let Some(x) = right.checked_sub(width).filter(|x| *x > USUAL_TITLE) else {
                return;
            };
            write(
                plot.area,
                (x, 0),
                &format!(" {text} "),
                theme.style(role),
                buf,
            );
            right = x;
        }
    }

    /// Returns true if the run is so near the exact motion that its dots cover it.
    fn covers_exact(&self, plot: &Plot) -> bool {
        let readouts = self.0.reading.map(|reading| &reading.readouts);
        let most_m = readouts.and_then(|readouts| readouts.health.most_distance_m);
        let dots = f64::from(plot.sheet.height) * self.0.view.marker.dots().1 as f64;
        most_m.is_some_and(|most_m| {
            (plot.scale.from_top(0.0) - plot.scale.from_top(most_m)).abs() * dots < 1.0
        })
    }

    /// Writes the name of the exact motion at the end of its line. Returns false if those cells are not free.
    fn name_exact(&self, plot: &Plot, buf: &mut Buffer) -> bool {
        let StripContent::Curve(curve) = plot.content else {
            return false;
        };
        let Some(exact) = self.0.overlay().map(|overlay| &overlay.now) else {
            return false;
        };
        let across = self.0.view.marker.dots().0;
        let Some(column) = plot.strip.column(exact.time_s) else {
            return false;
        };
        let at = (column / across + 2) as u16;
        let share = plot.scale.from_top(exact.value(curve));
        let y =
            (share * f64::from(plot.sheet.height)).clamp(0.0, f64::from(plot.sheet.height) - 1.0);
        let cells =
            (at..at + EXACT_WORD.len() as u16).map(|x| (plot.sheet.x + x, plot.sheet.y + y as u16));
        let is_free = at + EXACT_WORD.len() as u16 <= plot.sheet.width
            && cells
                .into_iter()
                .all(|cell| buf.cell(cell).is_some_and(|it| it.symbol() == " "));
        if is_free {
            let style = self.0.view.theme.style(Role::Exact);
            write(plot.sheet, (at, y as u16), EXACT_WORD, style, buf);
        }
        is_free
    }

    /// Draws the cursor: a line over the whole strip, and its value on the rule.
    fn draw_cursor(&self, plot: &Plot, buf: &mut Buffer) {
        let Some(cursor) = self.0.cursor else {
            return;
        };
        let Some(column) = plot.strip.column(cursor.time_s) else {
            return;
        };
        let x = (column / self.0.view.marker.dots().0) as u16;
        let style = self.0.view.theme.style(Role::Cursor);
        cursor_line(x, plot.sheet, style, buf);
        let value = match plot.content {
            StripContent::Curve(curve) => Some(curve.at(cursor)),
            StripContent::Measured(_) | StripContent::Distance | StripContent::Column => {
                self.value_at(plot.content, cursor.time_s)
            }
        };
        let digits = plot.scale.decimals();
        let model = value.map(|value| value_text(value, digits));
        let data = self.measured_at(plot.content, cursor.time_s);
        let data = data.map(|point| format!("data {}", value_text(point, digits)));
        let parts: Vec<_> = model.into_iter().chain(data).collect();
        let label = format!(" {} ", parts.join(", "));
        let line = self.rule_line(plot);
        let width = columns(&label) as u16;
        let most = line.width.saturating_sub(width);
        let at = x.saturating_sub(width / 2).min(most);
        write(
            line,
            (at, 0),
            &label,
            self.0.view.theme.style(Role::Heading),
            buf,
        );
    }

    /// Returns the value measured within half a time step of `time_s`.
    fn measured_at(&self, content: StripContent, time_s: f64) -> Option<f64> {
        let half_s = 0.5 * self.0.run.simulation().motion().time_step_s;
        let points = self.points(content)?;
        let next = points.partition_point(|point| point.time_s < time_s - half_s);
        let point = points.get(next)?;
        (point.time_s <= time_s + half_s).then_some(point.value)
    }
}

/// Columns of a rule reserved for its title.
const USUAL_TITLE: u16 = 8;

/// Returns the number, from 1, of the strip that names the curves: the strip of z, or else the last.
fn legend_index(plots: &[Plot]) -> usize {
    let z = StripContent::Curve(RecordedCurve::Z);
    let index = plots.iter().position(|plot| plot.content == z);
    index.map_or(plots.len(), |index| index + 1)
}

/// Draws a vertical line at column `x` of `area`, over its content.
pub fn cursor_line(x: u16, area: Rect, style: Style, buf: &mut Buffer) {
    if x >= area.width {
        return;
    }
    for y in area.top()..area.bottom() {
        let Some(cell) = buf.cell_mut((area.x + x, y)) else {
            continue;
        };
        let shown = cell.symbol().chars().next().unwrap_or(' ');
        let joined = match u32::from(shown).checked_sub(0x2800) {
            Some(bits) if bits < 0x100 => char::from_u32(0x2800 | bits | CURSOR_BITS),
            _ => None,
        };
        cell.set_char(joined.unwrap_or(CURSOR_LINE))
            .set_style(style);
    }
}
