//! The path of the traced point from above, x to the right and y up: a true circle at every size.
//!
//! It shows where the point is, and the shape of its last swings behind it, as a line. The turn before them and all
//! that came before are dotted, more and more sparsely; dots are denser where the point stayed longer.

mod legend;
mod points;

use super::{PaneRow, Width, frame, round_title, write};
use crate::lab::measured::Beside;
use crate::lab::view::markers::Marker;
use crate::lab::view::{Pane, View};
use crate::observe::ages::{Age, Ages};
use crate::observe::camera::Zoom;
use crate::observe::ghost::Ghost;
use crate::observe::live::LiveRun;
use crate::observe::overlay::Overlay;
use crate::observe::path::Path;
use crate::observe::reading::Reading;
use crate::observe::recording::Moment;
use crate::run::Clock;
use crate::tui::dashes::{self, on_and_off};
use crate::tui::dots::{Dots, Ink};
use crate::tui::keymap::ZOOM_KEYS;
use crate::tui::labels::Labels;
use crate::tui::theme::Role;
use crate::tui::trail::{Around, Trail};
use nalgebra::{Vector2, Vector3};
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::widgets::Widget;
use std::f64::consts::TAU;

/// Length of a push's line, as a share of the radius shown. Only its direction has a meaning.
const ARROW: f64 = 0.35;
/// A force with a horizontal part smaller than this share of it counts as straight up or down.
const UPRIGHT: f64 = 0.1;
/// The most pushes that are drawn at one time.
const MOST_PUSHES: usize = 20;

/// The least radius shown, m. The path of a point that stays on the vertical has no radius.
const LEAST: f64 = 1e-6;

/// The radius shown grows by this factor's exponential, or not at all.
const STEP: f64 = 0.05;

/// If gravity turns L by less than this in the whole run, rad, the path is a circle about L, and the picture is centred
/// on it.
const STANDING: f64 = 0.35;
/// A point that is nearer to the axle than this part of its distance from the pivot is on it.
const ON_AXLE: f64 = 1e-6;

/// Swings larger than this, dots, cover each other where they are close together.
const LARGE_SWING: f64 = 4.0;

/// Rows of the pane for each line of its legend, and the most lines.
const ROWS_A_LINE: u16 = 5;
const MOST_LINES: u16 = 3;

/// Its row in the table of panes.
pub const ROW: PaneRow = PaneRow {
    id: Pane::FROM_ABOVE,
    title: "from above",
    width: Width::Round,
    rank: 1,
    least: (27, 17),
    draw: |lab, area, buf| {
        FromAbove {
            run: lab.player().run(),
            ghost: lab.player().ghost(),
            pinned: lab.player().pinned(),
            measured: lab.player().measured(),
            view: lab.view(),
            reading: Some(&lab.player().reading),
        }
        .render(area, buf);
    },
    keys: ZOOM_KEYS,
};

/// The view from above on a run.
pub struct FromAbove<'a> {
    /// The run.
    pub run: &'a LiveRun,
    /// The run before, faint under it.
    pub ghost: Option<&'a Ghost>,
    /// The run that was pinned as the reference, unless it is the present one.
    pub pinned: Option<&'a Ghost>,
    /// The measured data beside the run.
    pub measured: Option<&'a Beside>,
    /// How it is looked at.
    pub view: &'a View,
    /// The latest reading of the run, if it is read at all: by it the path is recent or old.
    pub reading: Option<&'a Reading>,
}

impl Widget for FromAbove<'_> {
    fn render(self, area: Rect, buf: &mut Buffer) {
        let theme = &self.view.theme;
        let zoom = self.view.zoom.above;
        let title = round_title(ROW.title, zoom, self.reading, area.width);
        let inside = frame(&title, area, self.view.focus == ROW.id, theme, buf);
        if inside.height < 2 || inside.width == 0 {
            return;
        }
        let above = |rows: usize| Rect {
            height: inside.height.saturating_sub(rows as u16),
            ..inside
        };
        let most = (inside.height / ROWS_A_LINE).clamp(1, MOST_LINES) as usize;
        let lines = self.legend(&self.plan(above(1)), inside.width, most).len();
        let picture = above(lines);
        let plan = self.plan(picture);
        self.path(&plan, picture, buf);
        self.points(&plan, picture, buf);
        let forces = self.pushes(&plan, picture, buf);
        let mut places = self.marks(&plan, picture, buf);
        // Words do not cover marks; heads of arrows stand where they point.
        let push = self.view.theme.style(Role::Push);
        for (cell, sign) in forces {
            let width = sign.len() as u16;
            let cell = if width > 1 {
                places.place(cell, width)
            } else {
                cell
            };
            write(picture, cell, sign, push, buf);
        }
        let legend = Rect {
            y: picture.bottom(),
            height: lines as u16,
            ..inside
        };
        self.write_legend(&plan, legend, buf);
    }
}

impl FromAbove<'_> {
    /// The middle and the scale of the picture.
    fn plan(&self, picture: Rect) -> Plan {
        let middle = self.circled().unwrap_or_default();
        let exact = self.run.overlay().map(Overlay::path);
        let before = self.ghost.map(Ghost::path);
        let pinned = self.pinned.map(Ghost::path);
        let paths = [Some(self.run.path()), exact, before, pinned];
        let about = |path: &Path| {
            if middle == Vector2::zeros() {
                path.radius()
            } else {
                path.radius_about(middle.x, middle.y).max(middle.norm())
            }
        };
        let radii = paths.into_iter().flatten().map(about);
        let away = self.places().iter().map(|place| (place.at - middle).norm());
        let radius = radii.chain(away).fold(LEAST, f64::max);
        // In steps of 5 %, so that the scale does not change all the time.
        let radius = libm::exp((libm::log(radius) / STEP).ceil() * STEP) * 1.02;
        let zoom = self.view.zoom.above;
        let half = radius / zoom;
        let plan = Plan::new(picture, middle, half, self.view.marker);
        if zoom <= 1.0 {
            return plan;
        }
        let at = self.now(plan.across).position.xy();
        let middle = at.map(|at| Zoom::middle(at, half));
        Plan { middle, ..plan }
    }

    /// The place from above around which the axle circles: where the line of L is, at the height of the traced point, as
    /// long as gravity cannot turn L noticeably within the run; `None` where the circle is about the vertical.
    fn circled(&self) -> Option<Vector2<f64>> {
        let scenario = self.run.scenario();
        let momentum = scenario.start.momentum;
        let axis = momentum.try_normalize(f64::MIN_POSITIVE)?;
        let at = scenario.body.mechanics.points()[scenario.trace].at;
        let torque = scenario.motion.gravity * scenario.body.mechanics.first_moment().norm();
        let turn = torque.abs() / momentum.norm() * Clock::end_s(scenario);
        let is_steady = scenario.pushes.is_empty() && scenario.edits.is_empty() && turn < STANDING;
        let place = axis.xy() * at.norm();
        (is_steady && is_on_axle(&at) && place.norm() > 0.0).then_some(place)
    }

    /// The ages of the path where a metre is `across` dots.
    fn ages(&self, across: f64) -> Ages {
        let ages = self.reading.map(|reading| Ages::of(&reading.readouts));
        let turn_dots = TAU * self.run.path().radius() * across;
        ages.unwrap_or(Ages::UNKNOWN).on_picture(turn_dots)
    }

    /// The moment that is shown: the present one. Where the swings cover each other and the eye cannot follow them, it
    /// is that of the latest reading, so that not every frame has to be sent. Where the scheme has broken down, it is
    /// the last moment before.
    fn now(&self, across: f64) -> Moment {
        let scenario = self.run.scenario();
        let traced = scenario.body.mechanics.points()[scenario.trace].at;
        match self.reading {
            Some(reading) if reading.last_whole.is_some() => Moment::new(&reading.state, &traced),
            Some(reading) if self.ages(across).are_crowded => {
                let extremes = &reading.readouts.extremes;
                let swing_deg = extremes.highest_tilt_deg - extremes.lowest_tilt_deg;
                let swing_dots = swing_deg.to_radians() * traced.norm() * across;
                if swing_dots > LARGE_SWING {
                    Moment::new(&reading.state, &traced)
                } else {
                    *self.run.now()
                }
            }
            _ => *self.run.now(),
        }
    }

    /// The exact motion at `time_s` (s), the moment that is shown; `None` where it is not shown, or has not come so far yet.
    fn exact_at(&self, time_s: f64) -> Option<&Moment> {
        let read = self.reading.and_then(|reading| reading.exact.as_ref());
        let known = [self.run.exact_now(), read].into_iter().flatten();
        known.into_iter().find(|exact| exact.time_s == time_s)
    }

    fn path(&self, plan: &Plan, picture: Rect, buf: &mut Buffer) {
        let mut dots = Dots::new(picture, self.view.marker);
        if let Some(ghost) = self.ghost {
            let before = ghost.path().dots().map(|(x, y)| plan.dot(x, y));
            for (x, y) in on_and_off(before, dashes::before(self.view.marker)) {
                dots.set(x, y, Ink::Ghost);
            }
        }
        if let Some(pinned) = self.pinned {
            let kept = pinned.path().dots().map(|(x, y)| plan.dot(x, y));
            for (x, y) in on_and_off(kept, dashes::PINNED) {
                dots.set(x, y, Ink::Faint(Role::Pinned));
            }
        }
        let mut trail = Trail::new(&dots, Around::Nothing);
        for (x, y) in self.run.path().dots() {
            trail.dot(plan.dot(x, y), Age::Old);
        }
        let ages = self.ages(plan.across);
        let now = self.now(plan.across);
        let to_dot = |at: &Vector3<f64>| plan.dot(at.x, at.y);
        trail.follow(
            self.run.recording(),
            &ages,
            (now.time_s, &now.position),
            to_dot,
        );
        trail.draw(&mut dots);
        if let Some(overlay) = self.run.overlay() {
            let exact = overlay.path().dots().map(|(x, y)| plan.dot(x, y));
            for (x, y) in on_and_off(exact, dashes::EXACT) {
                dots.set(x, y, Ink::Faint(Role::Exact));
            }
        }
        dots.render(&self.view.theme, buf);
    }

    /// Each push that acts: a line from the pushed point. Returns its head, or a word where it is straight up or down, and
    /// where that is to stand.
    fn pushes(
        &self,
        plan: &Plan,
        picture: Rect,
        buf: &mut Buffer,
    ) -> Vec<((u16, u16), &'static str)> {
        let simulation = self.run.simulation();
        let points = self.run.scenario().body.mechanics.points();
        let mut dots = Dots::new(picture, self.view.marker);
        let mut signs = Vec::new();
        for push in simulation.loads().pushes.iter().take(MOST_PUSHES) {
            let at = simulation.state().orientation * points[push.point].at;
            let plane = push.force.xy();
            match plane.try_normalize(UPRIGHT * push.force.norm()) {
                Some(direction) => {
                    let tip = at.xy() + direction * (ARROW * plan.radius_m);
                    dots.line(
                        plan.dot(at.x, at.y),
                        plan.dot(tip.x, tip.y),
                        Ink::Strong(Role::Push),
                    );
                    signs.push((plan.cell(tip.x, tip.y), head(direction.x, direction.y)));
                }
                None => signs.push(upright(plan.cell(at.x, at.y), push.force.z, picture)),
            }
        }
        dots.render(&self.view.theme, buf);
        signs
    }

    /// The pivot, the axes' names, and where the point is now. Returns which places are left for words.
    fn marks(&self, plan: &Plan, picture: Rect, buf: &mut Buffer) -> Labels {
        let mut places = Labels::new(picture);
        let mut mark = |cell, sign: &str, role| {
            write(picture, cell, sign, self.view.theme.style(role), buf);
            places.take(cell);
        };
        let (right, middle) = (picture.width - 1, picture.height / 2);
        mark((right, middle), "x", Role::X);
        mark((picture.width / 2, 0), "y", Role::Y);
        if plan.shows(0.0, 0.0) {
            mark(plan.cell(0.0, 0.0), "+", Role::Quiet);
        }
        let now = self.now(plan.across);
        let here = plan.cell(now.position.x, now.position.y);
        let mut sign = "o";
        if let Some(exact) = self.exact_at(now.time_s) {
            let at = exact.position;
            let exact = plan.cell(at.x, at.y);
            if plan.shows(at.x, at.y) {
                mark(exact, "e", Role::Exact);
            }
            sign = if exact == here { "*" } else { sign };
        }
        mark(here, sign, Role::Focus);
        places
    }
}

fn is_on_axle(at: &Vector3<f64>) -> bool {
    at.xy().norm() <= ON_AXLE * at.norm()
}

/// The head of an arrow that points to the right by `x` and up by `y`.
fn head(x: f64, y: f64) -> &'static str {
    match (x.abs() > y.abs(), x > 0.0, y > 0.0) {
        (true, true, _) => ">",
        (true, false, _) => "<",
        (false, _, true) => "^",
        (false, _, false) => "v",
    }
}

/// What says that a force at `cell` is straight up or down, beside that cell and inside `picture`.
fn upright((x, y): (u16, u16), up: f64, picture: Rect) -> ((u16, u16), &'static str) {
    let sign = if up < 0.0 { "F down" } else { "F up" };
    let width = sign.len() as u16;
    let right = x + 2;
    let left = x.saturating_sub(width + 1);
    let place = if right + width <= picture.width {
        right
    } else {
        left
    };
    ((place, y), sign)
}

/// From metres to dots and cells.
struct Plan {
    /// What is in the middle of the picture, m.
    middle: Vector2<f64>,
    width: f64,
    height: f64,
    /// Dots in a metre, across and down.
    across: f64,
    down: f64,
    dots: (f64, f64),
    cell_width_m: f64,
    radius_m: f64,
}

impl Plan {
    fn new(picture: Rect, middle: Vector2<f64>, radius_m: f64, marker: Marker) -> Self {
        let (in_x, in_y) = marker.dots();
        let (width, height) = (
            picture.width as f64 * in_x as f64,
            picture.height as f64 * in_y as f64,
        );
        // A dot is `aspect` times as wide as high: this is what keeps circles round.
        let aspect = marker.dot_aspect();
        let down = (0.5 * height).min(0.5 * width * aspect) / radius_m;
        let across = down / aspect;
        let cell_width_m = in_x as f64 / across;
        Self {
            middle,
            width,
            height,
            across,
            down,
            dots: (in_x as f64, in_y as f64),
            cell_width_m,
            radius_m,
        }
    }

    fn dot(&self, x: f64, y: f64) -> (f64, f64) {
        (
            0.5 * self.width + (x - self.middle.x) * self.across,
            0.5 * self.height - (y - self.middle.y) * self.down,
        )
    }

    /// Whether this place is in the picture.
    fn shows(&self, x: f64, y: f64) -> bool {
        let (column, row) = self.dot(x, y);
        (0.0..self.width).contains(&column) && (0.0..self.height).contains(&row)
    }

    fn cell(&self, x: f64, y: f64) -> (u16, u16) {
        let (column, row) = self.dot(x, y);
        let inside = |dot: f64, dots: f64| dot.clamp(0.0, dots - 1.0);
        let column = inside(column, self.width) / self.dots.0;
        let row = inside(row, self.height) / self.dots.1;
        (column as u16, row as u16)
    }
}
