//! The path of the traced point from above, x to the right and y up, with axes in meters.
//!
//! The path in the window of the traces is bright, the path before it is dim. A ring marks the start, and a spot the
//! displayed time. The exact motion is dashed, with a spot at the same time.

mod extent;

use super::traces::with_minus_sign;
use super::{MOST_SHOWN_PUSHES, PaneRow, PlotInputs, round_title, rule};
use crate::engine::data::MeasuredPlace;
use crate::engine::recording::RecordedSample;
use crate::engine::text::nice_numbers::climbed;
use crate::engine::text::number::{fixed, significant};
use crate::engine::text::wrap::columns;
use crate::lab::playback::ghost::Ghost;
use crate::lab::view::theme::Marker;
use crate::lab::view::{HideablePart, Pane};
use crate::plot::camera::Zoom;
use crate::tui::dots::{self, Dashes};
use crate::tui::keymap;
use crate::tui::labels::{AROUND_MARK, AROUND_POINT, AT_AXIS_END, LabelOffset, Labels};
use crate::tui::layered_dots::{DotInk, FineDot, Layer, LayeredDots, Spot};
use crate::tui::plane::Plane;
use crate::tui::points::{Ends, Points};
use crate::tui::theme::Role;
use extent::{PlaneExtent, predicted_circle};
use nalgebra::Vector2;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::widgets::Widget;
use std::f64::consts::{FRAC_1_SQRT_2, TAU};

/// Length of a push's arrow, as a fraction of half the visible size. Only its direction has a meaning.
const PUSH_ARROW_SHARE: f64 = 0.35;
/// A force whose horizontal component is a smaller fraction of it counts as straight up or down.
const VERTICAL_FORCE_SHARE: f64 = 0.1;
/// Length of a push's arrowhead, fine dots.
const PUSH_HEAD_DOTS: f64 = 5.0;

/// Fine dots between the motion and the edge of the picture.
const MARGIN_DOTS: f64 = 4.0;
/// Minimum distance between two ticks, as a fraction of the visible size. It is rounded up.
const TICK_SHARE: f64 = 0.2;
/// Maximum decimals of a tick's number. A finer tick is written with an exponent.
const MOST_TICK_DECIMALS: i64 = 4;

/// Fine dots between two dots of the circle predicted by theory.
const CIRCLE_DOTS: f64 = 3.0;
/// Fine dots per dash of the exact path.
const EXACT_DASH_DOTS: f64 = 8.0;
/// Longest line between two points of the earlier path, fine dots.
const LONGEST_EARLIER_LINE: f64 = 8.0;
/// Longest line between two points of the bright path, as a fraction of the sheet's shorter side.
const LONGEST_RECENT_LINE: f64 = 0.5;

pub const FROM_ABOVE_ROW: PaneRow = PaneRow {
    id: Pane::Above,
    title: "from above",
    draw: |lab, area, buf| {
        FromAbove(PlotInputs::of_path(lab)).render(area, buf);
    },
    keys: keymap::FROM_ABOVE_KEYS,
    arrows: None,
};

/// The view from above, as a widget.
pub struct FromAbove<'a>(pub PlotInputs<'a>);

impl Widget for FromAbove<'_> {
    fn render(self, area: Rect, buf: &mut Buffer) {
        let seen = self.0;
        let view = seen.view;
        let title = round_title(
            "from above (m)",
            view.look.zoom.above,
            seen.reading,
            area.width,
        );
        let has_places = seen
            .measured
            .is_some_and(|data| !data.compared.places.is_empty());
        let measured = format!("{} measured", view.marker.point());
        let right = has_places.then_some((measured.as_str(), Role::Measured));
        let has_focus = view.marks_focus_of(Pane::Above);
        let picture = rule(&title, right, has_focus, area, &view.theme, buf);
        if picture.height >= 2 && picture.width > 0 {
            AbovePicture::new(seen, picture).draw(buf);
        }
    }
}

struct AbovePicture<'a> {
    seen: PlotInputs<'a>,
    picture: Rect,
    plane: Plane,
    now: RecordedSample,
    /// Exact motion at the same time, if its curves are shown.
    exact: Option<Vector2<f64>>,
}

impl<'a> AbovePicture<'a> {
    fn new(seen: PlotInputs<'a>, picture: Rect) -> Self {
        let (now, exact) = shown_moment(&seen);
        let whole = PlaneExtent::of(&seen);
        let zoom = seen.view.look.zoom.above;
        let half = whole.half() / zoom;
        let middle = if zoom <= 1.0 {
            whole.middle()
        } else {
            let [x, y] = [now.position.x, now.position.y].map(|at| Zoom::middle(at, half.min()));
            Vector2::new(x, y)
        };
        Self {
            seen,
            picture,
            plane: plane(picture, middle, half),
            now,
            exact,
        }
    }

    fn draw(&self, buf: &mut Buffer) {
        let (theme, marker) = (&self.seen.view.theme, self.seen.view.marker);
        let mut dots = LayeredDots::new(self.picture, marker);
        self.axes(&mut dots);
        let circle = self.circle(&mut dots);
        self.other_runs(&mut dots);
        self.path(&mut dots);
        self.exact_path(&mut dots);
        self.pushes(&mut dots);
        self.marks(&mut dots);
        dots.render(theme, buf);
        self.points(buf);
        let picture = self.picture;
        let mut labels = Labels { picture, buf };
        self.label_marks(circle, &mut labels);
        self.label_pushes(&mut labels);
        self.label_other_runs(&mut labels);
        self.label_axes(&mut labels);
    }

    fn dot(&self, at: &Vector2<f64>) -> FineDot {
        self.plane.dot((at.x, at.y))
    }

    /// Returns the cell of a point, which may be outside the picture.
    fn cell(&self, at: &Vector2<f64>) -> (i32, i32) {
        let (x, y) = self.dot(at);
        cell_of((x, y))
    }

    /// Returns the crossing of the axes: the origin, or the nearest dot in the picture.
    fn crossing(&self) -> FineDot {
        let (x, y) = self.plane.dot((0.0, 0.0));
        let (width, height) = (self.plane.size.0 as f64, self.plane.size.1 as f64);
        (
            x.clamp(1.0, (width - 2.0).max(1.0)),
            y.clamp(1.0, (height - 2.0).max(1.0)),
        )
    }

    /// Returns the distance of the ticks and their values on both axes, m.
    fn ticks(&self) -> (f64, [Vec<f64>; 2]) {
        let (width, height) = (self.plane.size.0 as f64, self.plane.size.1 as f64);
        let shown = [width / self.plane.scale.0, height / self.plane.scale.1];
        let step = climbed(TICK_SHARE * shown[0].min(shown[1]), 1);
        let middle = [self.plane.middle.0, self.plane.middle.1];
        let ticks = [0, 1].map(|axis| {
            let [low, high] = [-0.5, 0.5].map(|side| (middle[axis] + side * shown[axis]) / step);
            let numbers = low.ceil() as i64..=high.floor() as i64;
            let others = numbers.filter(|number| *number != 0);
            others.map(|number| number as f64 * step).collect()
        });
        (step, ticks)
    }

    fn axes(&self, dots: &mut LayeredDots) {
        let axis = ink(Role::Rule, Layer::Ground);
        let (across, down) = self.crossing();
        let origin = self.plane.dot((0.0, 0.0));
        if origin.1 == down {
            for x in (0..self.plane.size.0).step_by(2) {
                dots.set((x as f64, down), axis);
            }
        }
        if origin.0 == across {
            for y in (0..self.plane.size.1).step_by(2) {
                dots.set((across, y as f64), axis);
            }
        }
        let tick = ink(Role::Label, Layer::Ground);
        let (_, [of_x, of_y]) = self.ticks();
        for x in of_x {
            let (x, _) = self.plane.dot((x, 0.0));
            dots.line((x, down - 1.0), (x, down + 1.0), tick);
        }
        for y in of_y {
            let (_, y) = self.plane.dot((0.0, y));
            dots.line((across - 1.0, y), (across + 1.0, y), tick);
        }
    }

    /// Draws the circle predicted by theory, for a run too short to show it. Returns a point on the circle.
    fn circle(&self, dots: &mut LayeredDots) -> Option<Vector2<f64>> {
        if self.seen.view.hides(HideablePart::Predicted) {
            return None;
        }
        let radius_m = predicted_circle(self.seen.run.scenario())?;
        let count = (TAU * radius_m * self.plane.scale.0 / CIRCLE_DOTS) as u32;
        for part in 0..count {
            let (sin, cos) = libm::sincos(TAU * f64::from(part) / f64::from(count));
            let at = Vector2::new(cos, sin) * radius_m;
            dots.set(self.dot(&at), ink(Role::Exact, Layer::Previous));
        }
        Some(Vector2::new(FRAC_1_SQRT_2, FRAC_1_SQRT_2) * radius_m)
    }

    /// Returns the previous and the pinned run, each with its name and dashes.
    fn ghosts(&self) -> [(Option<&'a Ghost>, &'static str, Dashes); 2] {
        [
            (self.seen.ghost, "previous", dots::PREVIOUS_DASHES),
            (self.seen.pinned, "pinned", dots::PINNED_DASHES),
        ]
    }

    fn other_runs(&self, dots: &mut LayeredDots) {
        for (ghost, _, dashes) in self.ghosts() {
            let path = ghost.into_iter().flat_map(|ghost| ghost.path.dots());
            let places = path.map(|at| self.plane.dot(at));
            let of_ghost = ink(Role::Previous, Layer::Previous);
            dots.path(places, Some(dashes), 0.0, of_ghost);
        }
    }

    fn path(&self, dots: &mut LayeredDots) {
        let earlier = ink(Role::RunEarlier, Layer::Earlier);
        for at in self.seen.run.path().dots() {
            dots.set(self.plane.dot(at), earlier);
        }
        let shorter = self.plane.size.0.min(self.plane.size.1) as f64;
        let now_s = self.now.time_s;
        let bright = ink(Role::Run, Layer::Run);
        for (since_s, longest, ink) in [
            (f64::NEG_INFINITY, LONGEST_EARLIER_LINE, earlier),
            (
                self.seen.bright_since_s(now_s),
                LONGEST_RECENT_LINE * shorter,
                bright,
            ),
        ] {
            let bins = self.seen.run.recording().between(since_s, now_s);
            let until_now = bins.filter(|bin| bin.end_s >= since_s && bin.end_s <= now_s);
            let ends = until_now.map(|bin| bin.end().xy());
            let places = ends.chain([self.now.position.xy()]);
            dots.path(places.map(|at| self.dot(&at)), None, longest, ink);
        }
    }

    /// Draws the exact path over the run; where both coincide, its dashes alternate with the run.
    ///
    /// The dashes are fixed in space, so that those of different turns coincide.
    fn exact_path(&self, dots: &mut LayeredDots) {
        let Some(overlay) = self.seen.overlay() else {
            return;
        };
        let dash_m = EXACT_DASH_DOTS / self.plane.scale.1;
        let shown_m = 0.5 * self.plane.size.1 as f64 / self.plane.scale.1;
        let around = 2.0 * (0.5 * TAU * shown_m / dash_m).round().max(1.0);
        for (x, y) in overlay.path.dots() {
            let ring = libm::hypot(x, y) / dash_m;
            let sector = libm::atan2(y, x) / TAU * around;
            if (ring.floor() + sector.floor()).rem_euclid(2.0) == 0.0 {
                dots.set(self.plane.dot((x, y)), ink(Role::Exact, Layer::Exact));
            }
        }
    }

    /// Draws the measured points. Points at times that the run has not reached are less prominent.
    fn points(&self, buf: &mut Buffer) {
        let Some(data) = self.seen.measured else {
            return;
        };
        let mut points = Points::new(self.picture, self.seen.view.marker);
        for place in &data.compared.places {
            self.point(place, &mut points);
        }
        points.render(&self.seen.view.theme, buf);
    }

    fn point(&self, place: &MeasuredPlace, points: &mut Points) {
        let role = if place.time_s <= self.seen.run.now().time_s {
            Role::Measured
        } else {
            Role::Label
        };
        let [of_x, of_y] = place.sigmas;
        let (x, y) = (place.at.x, place.at.y);
        let level = of_x.map(|sigma| -> Ends {
            (self.in_cells(x - sigma, y).0, self.in_cells(x + sigma, y).0)
        });
        let upright = of_y.map(|sigma| -> Ends {
            (self.in_cells(x, y + sigma).1, self.in_cells(x, y - sigma).1)
        });
        points.add(self.in_cells(x, y), level, upright, role);
    }

    /// Returns a position in cells from the upper left.
    fn in_cells(&self, x: f64, y: f64) -> (f64, f64) {
        let (column, row) = self.plane.dot((x, y));
        let (across, down) = self.plane.in_cell;
        (column / across as f64, row / down as f64)
    }

    /// Returns the acting pushes.
    ///
    /// Each has the pushed point, the tip of its arrow (none if it is straight up or down) and the vertical force, N.
    fn acting_pushes(&self) -> Vec<(Vector2<f64>, Option<Vector2<f64>>, f64)> {
        let simulation = self.seen.run.simulation();
        let points = self.seen.run.scenario().body.mechanics.points();
        let shown = self.plane.size.0.min(self.plane.size.1) as f64 / self.plane.scale.0;
        let pushes = simulation.loads().pushes.iter().take(MOST_SHOWN_PUSHES);
        let of_push = pushes.map(|push| {
            let at = (simulation.state().orientation * points[push.point].at).xy();
            let level = push
                .force
                .xy()
                .try_normalize(VERTICAL_FORCE_SHARE * push.force.norm());
            let tip = level.map(|along| at + along * (0.5 * PUSH_ARROW_SHARE * shown));
            (at, tip, push.force.z)
        });
        of_push.collect()
    }

    fn pushes(&self, dots: &mut LayeredDots) {
        for (at, tip, _) in self.acting_pushes() {
            if let Some(tip) = tip {
                dots.arrow(self.dot(&at), self.dot(&tip), PUSH_HEAD_DOTS, Role::Push);
            }
        }
    }

    /// Draws the start, the exact motion now, and the run now.
    fn marks(&self, dots: &mut LayeredDots) {
        if let Some(at) = self.start() {
            dots.ring(self.dot(&at), ink(Role::Label, Layer::Start));
        }
        if let Some(at) = self.exact {
            let exact = ink(Role::Exact, Layer::ExactNow);
            dots.spot(self.dot(&at), Spot::Three, exact);
        }
        let now = self.dot(&self.now.position.xy());
        dots.spot(now, Spot::Three, ink(Role::Cursor, Layer::Now));
    }

    /// Returns the start of the run, or `None` if it is not finite.
    fn start(&self) -> Option<Vector2<f64>> {
        let scenario = self.seen.run.scenario();
        let traced = scenario.body.mechanics.points()[scenario.trace].at;
        let at = scenario.start.orientation * traced;
        at.iter().all(|part| part.is_finite()).then(|| at.xy())
    }

    /// Labels now, start and exact, the most important first, and marks the cursor.
    fn label_marks(&self, circle: Option<Vector2<f64>>, labels: &mut Labels<'_>) {
        let theme = &self.seen.view.theme;
        if let Some(cursor) = self.seen.cursor {
            let cell = self.cell(&cursor.position.xy());
            labels.write(cell, "◊", theme.style(Role::Cursor));
        }
        let now = self.cell(&self.now.position.xy());
        labels.place(now, AROUND_MARK, "now", theme.style(Role::Heading));
        if let Some(start) = self.start() {
            let style = theme.style(Role::Label);
            labels.place(self.cell(&start), AROUND_MARK, "start", style);
        }
        if let Some(exact) = self.exact.or(circle) {
            let style = theme.style(Role::Exact);
            labels.place(self.cell(&exact), AROUND_MARK, "exact", style);
        }
    }

    fn label_pushes(&self, labels: &mut Labels<'_>) {
        let style = self.seen.view.theme.style(Role::Push);
        for (at, tip, up) in self.acting_pushes() {
            let text = match tip {
                Some(_) => "F",
                None if up < 0.0 => "F down",
                None => "F up",
            };
            labels.place(self.cell(&tip.unwrap_or(at)), AROUND_MARK, text, style);
        }
    }

    /// Writes the names of the other runs at the ends of their paths.
    fn label_other_runs(&self, labels: &mut Labels<'_>) {
        let style = self.seen.view.theme.style(Role::Previous);
        for (ghost, name, _) in self.ghosts() {
            if let Some((x, y)) = ghost.and_then(|ghost| ghost.path.dots().last()) {
                labels.place(self.cell(&Vector2::new(x, y)), AROUND_MARK, name, style);
            }
        }
    }

    fn label_axes(&self, labels: &mut Labels<'_>) {
        let style = self.seen.view.theme.style(Role::Label);
        let crossing = cell_of(self.crossing());
        let right = i32::from(self.picture.width) - 3;
        labels.place((right, crossing.1), AT_AXIS_END, "x", style);
        labels.place((crossing.0, 0), AROUND_POINT, "y", style);
        let (step, [of_x, of_y]) = self.ticks();
        for x in of_x {
            let text = tick_text(x, step);
            let half = columns(&text) as i32 / 2;
            let column = cell_of(self.plane.dot((x, 0.0))).0;
            let below = [LabelOffset::Right(-half, 1), LabelOffset::Right(-half, -1)];
            labels.place((column, crossing.1), &below, &text, style);
        }
        for y in of_y {
            let row = cell_of(self.plane.dot((0.0, y))).1;
            let beside = [LabelOffset::Right(2, 0), LabelOffset::Left(2, 0)];
            labels.place((crossing.0, row), &beside, &tick_text(y, step), style);
        }
    }
}

/// Returns the plane around `middle` that reaches `half` to each side, and up and down (m), with a margin.
///
/// Its origin is in the upper half of a cell, so that the ticks of x are in the cells of the axis.
fn plane(picture: Rect, middle: Vector2<f64>, half: Vector2<f64>) -> Plane {
    let dots = Vector2::new(
        2.0 * f64::from(picture.width),
        4.0 * f64::from(picture.height),
    );
    let share = dots.map(|dots| dots / (dots - 2.0 * MARGIN_DOTS).max(1.0));
    let half = half.component_mul(&share);
    let (marker, middle) = (Marker::Braille, (middle.x, middle.y));
    let mut plane = Plane::new(picture, marker, middle, (half.x, half.y));
    let (x, y) = plane.dot((0.0, 0.0));
    let moved = (
        x.floor() + 0.5 - x,
        4.0 * ((y - 1.5) / 4.0).round() + 1.5 - y,
    );
    plane.middle.0 -= moved.0 / plane.scale.0;
    plane.middle.1 += moved.1 / plane.scale.1;
    plane
}

fn ink(role: Role, layer: Layer) -> DotInk {
    DotInk { role, layer }
}

fn cell_of((x, y): FineDot) -> (i32, i32) {
    ((x / 2.0).floor() as i32, (y / 4.0).floor() as i32)
}

/// Returns the number of a tick, m, if ticks are `step` apart.
fn tick_text(value: f64, step: f64) -> String {
    let decimals = (-libm::log10(step).floor() as i64).max(0);
    with_minus_sign(&if decimals <= MOST_TICK_DECIMALS {
        fixed(value, decimals as usize)
    } else {
        significant(value, 3)
    })
}

/// Returns the displayed sample, and the exact position at its time if the exact curves are shown.
///
/// Usually the sample is the current one. If the traces are held because swings are too fast to follow, it is the
/// sample of the latest reading. If the scheme has broken down, it is the last sample before that.
fn shown_moment(seen: &PlotInputs<'_>) -> (RecordedSample, Option<Vector2<f64>>) {
    let is_shown = seen.overlay().is_some();
    let is_held = seen.view.window.is_held;
    match seen.reading {
        Some(reading) if is_held || reading.last_whole.is_some() => {
            let scenario = seen.run.scenario();
            let traced = scenario.body.mechanics.points()[scenario.trace].at;
            let exact = reading.exact.as_ref().filter(|_| is_shown);
            let exact = exact.map(|exact| exact.position.xy());
            (RecordedSample::new(&reading.state, &traced), exact)
        }
        _ => {
            let now = *seen.run.now();
            let exact = seen
                .run
                .exact_now()
                .filter(|exact| is_shown && exact.time_s == now.time_s);
            (now, exact.map(|exact| exact.position.xy()))
        }
    }
}
