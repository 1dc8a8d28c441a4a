//! x, y, z and the magnified tilt over time, a strip each, as an oscilloscope draws them.

use super::{PaneRow, Width, frame, write};
use crate::lab::view::markers::Marker;
use crate::lab::view::{Pane, View};
use crate::observe::ghost::Ghost;
use crate::observe::live::LiveRun;
use crate::observe::marks::Marks;
use crate::observe::overlay::Overlay;
use crate::observe::recording::{Curve, Extent, Recording};
use crate::observe::sweep::Sweep;
use crate::text::number::{decimal, exponent, fixed};
use crate::tui::dots::{Dots, Ink};
use crate::tui::theme::Role;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::widgets::Widget;

/// Cells left empty ahead of the pen.
const GAP: usize = 2;
/// Fewest rows of a strip: its label and one row of dots.
const STRIP: u16 = 2;

/// Its row in the table of panes.
pub const ROW: PaneRow = PaneRow {
    id: Pane::TRACES,
    title: "over time",
    width: Width::Wide,
    rank: 0,
    least: (27, 0),
    draw: |lab, area, buf| {
        let (run, ghost, view) = (lab.player().run(), lab.player().ghost(), lab.view());
        Traces { run, ghost, view }.render(area, buf);
    },
    keys: &[],
};

/// The traces of a run.
pub struct Traces<'a> {
    /// The run.
    pub run: &'a LiveRun,
    /// The run before, faint under it.
    pub ghost: Option<&'a Ghost>,
    /// How it is looked at.
    pub view: &'a View,
}

impl Widget for Traces<'_> {
    fn render(self, area: Rect, buf: &mut Buffer) {
        let theme = &self.view.theme;
        let inside = frame(&self.title(), area, self.view.focus == ROW.id, theme, buf);
        let strips = (inside.height.saturating_sub(1) / STRIP).min(Curve::ALL.len() as u16);
        if strips == 0 || inside.width == 0 {
            return;
        }
        let sweep = self.sweep(inside);
        let marks = Marks::of(self.run.scenario());
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
            self.curve(curve, &sweep, &marks, sheet, buf);
            self.pen(&sweep, sheet, buf);
            self.edits(&marks, &sweep, sheet, buf);
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
        let border = Rect {
            y: area.bottom() - 1,
            height: 1,
            ..inside
        };
        self.pushes(&marks, &sweep, border, buf);
    }
}

impl Traces<'_> {
    fn title(&self) -> String {
        let named = self.run.scenario().file.trace.as_deref();
        format!("{} {}", named.unwrap_or("axle top"), ROW.title)
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
        let theme = &self.view.theme;
        let name = write(area, (0, 0), curve.name(), theme.style(role(curve)), buf);
        let range = format!(" {} {}", self.scale(curve).in_words(), curve.unit());
        write(area, (name, 0), &range, theme.style(Role::Quiet), buf);
    }

    fn curve(&self, curve: Curve, sweep: &Sweep, marks: &Marks, area: Rect, buf: &mut Buffer) {
        let scale = self.scale(curve);
        let mut dots = Dots::new(area, self.view.marker);
        if let Some(ghost) = self.ghost {
            let cuts = &ghost.marks().edits;
            let before = sweep.extents_of_window(ghost.recording(), curve, cuts);
            dotted(&mut dots, &before, &scale, self.view.marker);
        }
        if let Some(overlay) = self.run.overlay() {
            let exact = sweep.extents(overlay.recording(), curve, &[]);
            let exact = dashed(exact, self.view.marker);
            draw(&mut dots, &exact, &scale, Ink::Faint(Role::Exact));
        }
        let extents = sweep.extents(self.run.recording(), curve, &marks.edits);
        draw(&mut dots, &extents, &scale, Ink::Strong(role(curve)));
        dots.render(&self.view.theme, buf);
    }

    /// The range of values a strip shows: x and y share one about 0, z and tilt have their own.
    fn scale(&self, curve: Curve) -> Scale {
        let extent = |curve| self.extent(curve);
        match curve {
            Curve::X | Curve::Y => {
                let both = extent(Curve::X).and(extent(Curve::Y));
                Scale::about_zero(
                    both.max
                        .max(-both.min)
                        .max(PLANE_LEAST * self.run.scenario().arm_m()),
                )
            }
            Curve::Z => Scale::around(extent(curve), Z_LEAST * self.run.scenario().arm_m()),
            Curve::Tilt => Scale::around(extent(curve), TILT_LEAST),
        }
    }

    /// Everything the strip of `curve` has to show: the run, and where they are shown the exact motion and the run
    /// before: the whole of it at once, so that the picture stays while the run comes after it.
    fn extent(&self, curve: Curve) -> Extent {
        let exact = self.run.overlay().map(Overlay::recording);
        let before = self.ghost.map(Ghost::recording);
        let recordings = [Some(self.run.recording()), exact, before];
        let blocks = recordings
            .into_iter()
            .flatten()
            .filter_map(Recording::whole);
        let extents = blocks.map(|block| block.extent(curve));
        extents.reduce(Extent::and).unwrap_or(Extent::of(0.0))
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

    /// A dotted line where an edit was made.
    fn edits(&self, marks: &Marks, sweep: &Sweep, area: Rect, buf: &mut Buffer) {
        let across = self.view.marker.dots().0;
        let style = self.view.theme.style(Role::Quiet);
        let places = marks.edits.iter().filter_map(|&at_s| sweep.place_of(at_s));
        for x in places.map(|column| area.x + (column / across) as u16) {
            for y in area.top()..area.bottom() {
                let cell = buf.cell_mut((x, y));
                if let Some(cell) = cell.filter(|cell| cell.symbol() == " ") {
                    cell.set_char(EDIT).set_style(style);
                }
            }
        }
    }

    /// Where pushes act: on the border below the strips, with the word beside it where there is room.
    fn pushes(&self, marks: &Marks, sweep: &Sweep, border: Rect, buf: &mut Buffer) {
        let across = self.view.marker.dots().0;
        let mut pushed = vec![false; border.width as usize];
        let shown = |&(begin_s, end_s): &(f64, f64)| sweep.shown(begin_s, end_s);
        for column in marks.pushes.iter().flat_map(shown) {
            if let Some(cell) = pushed.get_mut(column / across) {
                *cell = true;
            }
        }
        let style = self.view.theme.style(Role::Push);
        let signs = pushed.iter().map(|&pushed| if pushed { PUSH } else { " " });
        for (x, sign) in (0..).zip(signs).filter(|(_, sign)| *sign == PUSH) {
            write(border, (x, 0), sign, style, buf);
        }
        for x in words(&pushed) {
            write(border, (x as u16, 0), WORD, style, buf);
        }
    }

    fn time_axis(&self, sweep: &Sweep, area: Rect, buf: &mut Buffer) {
        let style = self.view.theme.style(Role::Quiet);
        let (begin, end) = ends(sweep, area.width as usize);
        let after_begin = write(area, (0, 0), &begin, style, buf);
        let room = area.width as usize;
        if begin.len() + end.len() >= room {
            return;
        }
        let end_at = (room - end.len()) as u16;
        write(area, (end_at, 0), &end, style, buf);
        let between = (end_at - after_begin) as usize;
        let legend = LEGENDS
            .into_iter()
            .find(|legend| legend.len() + 2 <= between);
        if let Some(legend) = legend.filter(|_| self.ghost.is_some()) {
            let x = after_begin + (between - legend.len()) as u16 / 2;
            write(
                area,
                (x, 0),
                legend,
                self.view.theme.style(Role::Ghost),
                buf,
            );
        }
    }
}

/// The columns at which [`WORD`] stands for the stretches of `pushed` columns: in the stretch, or beside it.
fn words(pushed: &[bool]) -> Vec<usize> {
    let mut places: Vec<usize> = Vec::new();
    let mut begin = 0;
    for stretch in pushed.chunk_by(|a, b| a == b) {
        let end = begin + stretch.len();
        if stretch.contains(&true) {
            let free_from = places.last().map_or(0, |last| last + WORD.len());
            places.extend(word(pushed, (begin, end), free_from));
        }
        begin = end;
    }
    places
}

/// The column of [`WORD`] for the pushed columns from `begin` to before `end`; before `free_from` there are others.
fn word(pushed: &[bool], (begin, end): (usize, usize), free_from: usize) -> Option<usize> {
    let length = WORD.len();
    if end - begin >= length + 2 {
        return Some(begin + (end - begin - length) / 2);
    }
    // With a free column at its end, lest it seem to belong to the next stretch.
    let is_free = |from: usize, to: usize| {
        let columns = pushed.get(from..to.min(pushed.len()));
        columns.is_some_and(|columns| columns.len() >= length && !columns.contains(&true))
    };
    let before = begin.checked_sub(length);
    let before = before.filter(|&at| at >= free_from && is_free(at.saturating_sub(1), begin));
    match is_free(end, end + length + 1) {
        true => Some(end),
        false => before,
    }
}

/// What marks the time of an edit, and time with a push.
const EDIT: char = ':';
const PUSH: &str = "═";
const WORD: &str = "push";
/// What the dots of the run before mean, at length and in short.
const LEGENDS: [&str; 3] = [
    "dotted: the other run",
    "dotted: other run",
    "dotted: other",
];

/// Least range of z, of the distance between pivot and traced point: a swing below it is small, and shall look small.
const Z_LEAST: f64 = 0.05;
/// Least range of the tilt, degrees: below it there is rounding to see, and no end to the digits of its ends.
const TILT_LEAST: f64 = 0.02;
/// Least reach of x and y, of the same distance.
const PLANE_LEAST: f64 = 1e-4;
/// Times below this, s, are written with all their digits.
const LONG_TIME_S: f64 = 1e6;
/// From this time on (s) it has more digits than anyone reads.
const MOST_TIME_S: f64 = 1e15;

/// The colour of a curve.
fn role(curve: Curve) -> Role {
    match curve {
        Curve::X => Role::X,
        Curve::Y => Role::Y,
        Curve::Z => Role::Z,
        Curve::Tilt => Role::Path,
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
        format!(
            "{} .. {}",
            fixed(self.low, digits),
            fixed(self.high, digits)
        )
    }
}

/// Every other cell of `columns`: without colours, dashes tell the exact motion from the run.
fn dashed(columns: Vec<Option<Extent>>, marker: Marker) -> Vec<Option<Extent>> {
    let across = marker.dots().0;
    let dash =
        |(x, extent): (usize, Option<Extent>)| extent.filter(|_| (x / across).is_multiple_of(2));
    columns.into_iter().enumerate().map(dash).collect()
}

/// Single dots of `columns`, the run before: without colours, they tell it from the run and from the exact motion.
fn dotted(dots: &mut Dots, columns: &[Option<Extent>], scale: &Scale, marker: Marker) {
    let (rows, (across, down)) = (dots.height(), marker.dots());
    if rows == 0 {
        return;
    }
    for (x, extent) in columns.iter().enumerate().step_by(across.max(2)) {
        let Some(extent) = extent else { continue };
        let (top, bottom) = (scale.row(extent.max, rows), scale.row(extent.min, rows));
        for y in (top as usize..=bottom as usize).step_by((down / 2).max(1)) {
            dots.set(x as f64, y as f64, Ink::Ghost);
        }
    }
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
        return (decimal(begin_s), format!("{} s", decimal(end_s)));
    }
    let digits = (1.0 - sweep.window_s.log10()).ceil().clamp(0.0, 6.0) as usize;
    // Whole numbers that tell the two ends apart, up to where they have more digits than anyone reads.
    let [begin, end] = [begin_s, end_s].map(|time_s| match time_s < MOST_TIME_S {
        true => format!("{time_s:.digits$}"),
        false => exponent(time_s, 3),
    });
    let end = format!("{end} s");
    if begin.len() + end.len() < width {
        return (begin, end);
    }
    let later = format!("+ {} s", decimal(sweep.window_s));
    let whole = format!("{begin} s");
    if whole.len() + later.len() < width {
        return (whole, later);
    }
    (format!("{} s", exponent(begin_s, 3)), later)
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

    #[test]
    fn the_word_stands_in_its_stretch_or_beside_it() {
        let places = |picture: &str| {
            let pushed: Vec<bool> = picture.chars().map(|sign| sign == '=').collect();
            words(&pushed)
        };
        assert_eq!(places("..======...."), [3]);
        assert_eq!(places(".==........."), [3]);
        assert_eq!(places("........==.."), [4]);
        assert!(places(".=.=.=.=.=.=").is_empty());
        assert_eq!(places("==.....=...."), [2, 8]);
        assert_eq!(places("==.....=..."), [2]);
        assert_eq!(places("==....=....."), [7]);
        assert!(places("===").is_empty());
        assert!(places("").is_empty());
    }
}
