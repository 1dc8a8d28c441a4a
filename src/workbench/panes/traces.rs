//! x, y, z and the magnified tilt over time, a strip each, as an oscilloscope draws them.

use super::{frame, write};
use crate::workbench::dots::{Dots, Ink};
use crate::workbench::live::LiveRun;
use crate::workbench::markers::Marker;
use crate::workbench::recording::{Curve, Extent};
use crate::workbench::sweep::Sweep;
use crate::workbench::theme::Role;
use crate::workbench::view::{Pane, View};
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::widgets::Widget;

/// Cells left empty ahead of the pen.
const GAP: usize = 2;
/// Fewest rows of a strip: its label and one row of dots.
const STRIP: u16 = 2;

/// The traces of a run.
pub struct Traces<'a> {
    /// The run.
    pub run: &'a LiveRun,
    /// How it is looked at.
    pub view: &'a View,
}

impl Widget for Traces<'_> {
    fn render(self, area: Rect, buf: &mut Buffer) {
        let theme = &self.view.theme;
        let inside = frame(
            &self.title(),
            area,
            self.view.focus == Pane::Traces,
            theme,
            buf,
        );
        let strips = (inside.height.saturating_sub(1) / STRIP).min(Curve::ALL.len() as u16);
        if strips == 0 || inside.width == 0 {
            return;
        }
        let sweep = self.sweep(inside);
        let heights = (inside.height - 1) / strips;
        let spare = (inside.height - 1) % strips;
        let mut y = inside.y;
        for (curve, strip) in Curve::ALL.into_iter().zip(0..strips) {
            let height = heights + u16::from(strip < spare);
            self.label(
                curve,
                Rect {
                    y,
                    height: 1,
                    ..inside
                },
                buf,
            );
            let sheet = Rect {
                y: y + 1,
                height: height - 1,
                ..inside
            };
            self.curve(curve, &sweep, sheet, buf);
            self.pen(&sweep, sheet, buf);
            y += height;
        }
        self.time_axis(
            &sweep,
            Rect {
                y,
                height: 1,
                ..inside
            },
            buf,
        );
    }
}

impl Traces<'_> {
    fn title(&self) -> String {
        let named = self.run.scenario().file.trace.as_deref();
        format!("{} over time", named.unwrap_or("axle top"))
    }
    fn sweep(&self, inside: Rect) -> Sweep {
        let across = self.view.marker.dots().0;
        let columns = inside.width as usize * across;
        Sweep::new(
            self.view.window_s,
            self.run.now().time_s,
            columns,
            GAP * across,
        )
    }

    fn label(&self, curve: Curve, area: Rect, buf: &mut Buffer) {
        let (look, theme) = (Look::of(curve), &self.view.theme);
        let name = write(area, (0, 0), look.name, theme.style(look.role), buf);
        let range = format!(" {} {}", self.scale(curve).in_words(), look.unit);
        write(area, (name, 0), &range, theme.style(Role::Quiet), buf);
    }

    fn curve(&self, curve: Curve, sweep: &Sweep, area: Rect, buf: &mut Buffer) {
        let scale = self.scale(curve);
        let mut dots = Dots::new(area, self.view.marker);
        if let Some(overlay) = self.run.overlay() {
            let exact = dashed(sweep.extents(overlay.recording(), curve), self.view.marker);
            draw(&mut dots, &exact, &scale, Ink::Faint(Role::Exact));
        }
        let extents = sweep.extents(self.run.recording(), curve);
        draw(
            &mut dots,
            &extents,
            &scale,
            Ink::Strong(Look::of(curve).role),
        );
        dots.render(&self.view.theme, buf);
    }

    /// The range of values a strip shows: x and y share one about 0, z and tilt have their own.
    fn scale(&self, curve: Curve) -> Scale {
        let extent = |curve| self.extent(curve);
        match curve {
            Curve::X | Curve::Y => {
                let both = extent(Curve::X).and(extent(Curve::Y));
                Scale::about_zero(both.max.max(-both.min).max(PLANE_LEAST * self.reach()))
            }
            Curve::Z => Scale::around(extent(curve), Z_LEAST * self.reach()),
            Curve::Tilt => Scale::around(extent(curve), TILT_LEAST),
        }
    }

    /// Everything the strip of `curve` has to show: the run, and the exact motion where it is shown.
    fn extent(&self, curve: Curve) -> Extent {
        let exact = self
            .run
            .overlay()
            .and_then(|overlay| overlay.recording().whole());
        let blocks = self.run.recording().whole().into_iter().chain(exact);
        let extents = blocks.map(|block| block.extents[curve as usize]);
        extents.reduce(Extent::and).unwrap_or(Extent::of(0.0))
    }

    fn reach(&self) -> f64 {
        let scenario = self.run.scenario();
        scenario.body.mechanics.points()[scenario.trace].at.norm()
    }

    /// The pen: a line where the next dots will stand.
    fn pen(&self, sweep: &Sweep, area: Rect, buf: &mut Buffer) {
        let column = (sweep.pen() / self.view.marker.dots().0 + 1) as u16;
        if column >= area.width {
            return;
        }
        for y in area.top()..area.bottom() {
            let cell = buf.cell_mut((area.x + column, y));
            if let Some(cell) = cell.filter(|cell| cell.symbol() == " ") {
                cell.set_char('│')
                    .set_style(self.view.theme.style(Role::Quiet));
            }
        }
    }

    fn time_axis(&self, sweep: &Sweep, area: Rect, buf: &mut Buffer) {
        let style = self.view.theme.style(Role::Quiet);
        let (begin, end) = ends(sweep, area.width as usize);
        write(area, (0, 0), &begin, style, buf);
        let room = area.width as usize;
        if begin.len() + end.len() < room {
            write(area, ((room - end.len()) as u16, 0), &end, style, buf);
        }
    }
}

/// Least range of z, of the distance between pivot and traced point: a swing below it is small, and shall look small.
const Z_LEAST: f64 = 0.05;
/// Least range of the tilt, degrees: below it there is rounding to see, and no end to the digits of its ends.
const TILT_LEAST: f64 = 0.02;
/// Least reach of x and y, of the same distance.
const PLANE_LEAST: f64 = 1e-4;
/// Times below this, s, are written with all their digits.
const LONG_TIME_S: f64 = 1e6;

struct Look {
    name: &'static str,
    unit: &'static str,
    role: Role,
}

impl Look {
    fn of(curve: Curve) -> Self {
        let (name, unit, role) = match curve {
            Curve::X => ("x", "m", Role::X),
            Curve::Y => ("y", "m", Role::Y),
            Curve::Z => ("z", "m", Role::Z),
            Curve::Tilt => ("tilt", "deg", Role::Path),
        };
        Self { name, unit, role }
    }
}

/// From values to rows.
struct Scale {
    low: f64,
    high: f64,
}

impl Scale {
    fn about_zero(reach: f64) -> Self {
        let reach = nice_above(reach.max(1e-9));
        Self {
            low: -reach,
            high: reach,
        }
    }

    /// Round numbers around `extent`, at least `least` apart; they change seldom while the extent grows.
    fn around(extent: Extent, least: f64) -> Self {
        let unit = nice_above((extent.max - extent.min).max(least)) / 4.0;
        let (low, high) = ((extent.min / unit).floor(), (extent.max / unit).ceil());
        let missing = (least / unit - (high - low)).ceil().max(0.0);
        let below = (0.5 * missing).floor();
        Self {
            low: (low - below) * unit,
            high: (high + missing - below) * unit,
        }
    }

    fn row(&self, value: f64, rows: usize) -> f64 {
        let share = (self.high - value) / (self.high - self.low);
        (share * rows as f64).clamp(0.0, rows as f64 - 1.0)
    }

    fn in_words(&self) -> String {
        let digits = (1.0 - (self.high - self.low).log10())
            .ceil()
            .clamp(0.0, 9.0) as usize;
        format!("{:.digits$} .. {:.digits$}", self.low, self.high)
    }
}

/// Every other cell of `columns`: without colours, dashes tell the exact motion from the run.
fn dashed(columns: Vec<Option<Extent>>, marker: Marker) -> Vec<Option<Extent>> {
    let across = marker.dots().0;
    let dash =
        |(x, extent): (usize, Option<Extent>)| extent.filter(|_| (x / across).is_multiple_of(2));
    columns.into_iter().enumerate().map(dash).collect()
}

fn draw(dots: &mut Dots, extents: &[Option<Extent>], scale: &Scale, ink: Ink) {
    let rows = dots.height();
    if rows == 0 {
        return;
    }
    for (x, extent) in extents.iter().enumerate() {
        let Some(extent) = extent else { continue };
        let (top, bottom) = (scale.row(extent.max, rows), scale.row(extent.min, rows));
        dots.column(x, top as usize, bottom as usize, ink);
    }
}

/// The smallest of 1, 1.2, 1.5, 2, 2.5, 3, 4, 5, 6, 8 times a power of ten that is not below `value` (> 0).
fn nice_above(value: f64) -> f64 {
    const STEPS: [f64; 11] = [1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0];
    let unit = libm::exp10(value.log10().floor());
    let step = STEPS
        .into_iter()
        .find(|step| step * unit >= value * 0.999_999);
    step.unwrap_or(10.0) * unit
}

/// What stands at both ends of the time axis: both times, or how much later the right one is where they have too many
/// digits for `width` columns.
fn ends(sweep: &Sweep, width: usize) -> (String, String) {
    let (begin_s, end_s) = (sweep.begin_s, sweep.begin_s + sweep.window_s);
    if end_s < LONG_TIME_S {
        return (short(begin_s), format!("{} s", short(end_s)));
    }
    let digits = (1.0 - sweep.window_s.log10()).ceil().clamp(0.0, 6.0) as usize;
    let begin = format!("{begin_s:.digits$}");
    let end = format!("{end_s:.digits$} s");
    if begin.len() + end.len() < width {
        return (begin, end);
    }
    let later = format!("+ {} s", short(sweep.window_s));
    let whole = format!("{begin} s");
    if whole.len() + later.len() < width {
        return (whole, later);
    }
    (format!("{begin_s:.3e} s"), later)
}

/// A time without digits it does not need.
fn short(time_s: f64) -> String {
    match time_s {
        t if t >= LONG_TIME_S => format!("{t:.3e}"),
        t => format!("{}", (t * 1e6).round() / 1e6),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_calm_tilt_needs_few_digits() {
        let extent = Extent::of(29.999_999_75).and(Extent::of(30.000_000_02));
        assert_eq!(
            Scale::around(extent, TILT_LEAST).in_words(),
            "29.990 .. 30.010"
        );
        let constant = Scale::around(Extent::of(30.0), TILT_LEAST);
        assert_eq!(constant.in_words(), "29.990 .. 30.010");
    }

    #[test]
    fn both_ends_of_the_time_axis_differ() {
        let at = |now_s, width| ends(&Sweep::new(230.0, now_s, 50, 4), width);
        let pair = |begin: &str, end: &str| (begin.to_owned(), end.to_owned());
        assert_eq!(at(240.0, 25), pair("230", "460 s"));
        assert_eq!(at(1_130_300.0, 25), pair("1130220", "1130450 s"));
        assert_eq!(at(1.1303e12, 25).1, "+ 230 s");
        assert_eq!(at(1.1303e12, 18).0, "1.130e12 s");
    }
}
