//! The path of the traced point from above, x to the right and y up: a true circle at every size.
//!
//! It shows where the point is, and the shape of its last swings behind it, as a line. The turn before them and all
//! that came before are dotted, more and more sparsely; dots are denser where the point stayed longer.

use super::{MOST_SHOWN_PUSHES, PaneRow, PlotInputs, ROWS_A_LINE, Width, round_frame, write};
use crate::engine::data::MeasuredPlace;
use crate::engine::recording::RecordedSample;
use crate::engine::run::Clock;
use crate::engine::text::wrap::columns;
use crate::lab::playback::ages::{Age, Ages};
use crate::lab::view::Pane;
use crate::lab::view::theme::Marker;
use crate::plot::camera::Zoom;
use crate::tui::dots::{self, Dots, Ink};
use crate::tui::keymap::ZOOM_KEYS;
use crate::tui::plane::{LabelCells, Plane};
use crate::tui::points::{Ends, Points};
use crate::tui::split::split_rows;
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
const VERTICAL_FORCE_SHARE: f64 = 0.1;

/// The least radius shown, m. The path of a point that stays on the vertical has no radius.
const LEAST_RADIUS_M: f64 = 1e-6;

/// The radius shown grows by this factor's exponential, or not at all.
const RADIUS_STEP: f64 = 0.05;

/// If gravity turns L by less than this in the whole run, rad, the path is a circle about L, and the picture is centred
/// on it.
const STANDING: f64 = 0.35;
/// A point that is nearer to the axle than this part of its distance from the pivot is on it.
const POINT_ON_AXLE: f64 = 1e-6;

/// Swings larger than this, dots, cover each other where they are close together.
const LARGE_SWING: f64 = 4.0;

const MOST_LEGEND_LINES: u16 = 3;

/// What stands between two words of a legend at length, and in short.
const LEGEND_SEPARATORS: [&str; 2] = [", ", " "];
const EARLIER_RUN_LEGEND: [&str; 2] = ["dotted: before"; 2];

pub const FROM_ABOVE_ROW: PaneRow = PaneRow {
    id: Pane::Above,
    title: "from above",
    width: Width::Round,
    rank: 1,
    least: (27, 17),
    draw: |lab, area, buf| {
        FromAbove(PlotInputs::from_lab(lab)).render(area, buf);
    },
    keys: ZOOM_KEYS,
    arrows: None,
};

pub struct FromAbove<'a>(pub PlotInputs<'a>);

impl Widget for FromAbove<'_> {
    fn render(self, area: Rect, buf: &mut Buffer) {
        let zoom = self.0.view.look.zoom.above;
        let Some(inside) = round_frame(&FROM_ABOVE_ROW, zoom, &self.0, area, buf) else {
            return;
        };
        let most = (inside.height / ROWS_A_LINE).clamp(1, MOST_LEGEND_LINES) as usize;
        let (plane_over_one_line, _) = self.plane(split_rows(inside, inside.height - 1)[0]);
        let lines = self
            .legend(&plane_over_one_line, inside.width.into(), most)
            .len();
        let [picture, legend] = split_rows(inside, inside.height - lines as u16);
        let (plane, radius_m) = self.plane(picture);
        self.path(&plane, picture, buf);
        self.points(&plane, picture, buf);
        let forces = self.pushes(&plane, radius_m, picture, buf);
        let mut places = self.marks(&plane, picture, buf);
        // Words do not cover marks; heads of arrows stand where they point.
        for (cell, sign) in forces {
            let cell = match sign.len() {
                1 => cell,
                width => places.place(cell, width as u16),
            };
            let push = self.0.view.theme.style(Role::Push);
            write(picture, cell, sign, push, buf);
        }
        self.write_legend(&plane, legend, buf);
    }
}

impl FromAbove<'_> {
    /// The plane of the picture, and the radius that it shows, m.
    fn plane(&self, picture: Rect) -> (Plane, f64) {
        let middle = self.circled().unwrap_or_default();
        let exact = self.0.run.overlay().map(|overlay| &overlay.path);
        let before = self.0.ghost.map(|ghost| &ghost.path);
        let pinned = self.0.pinned.map(|ghost| &ghost.path);
        let paths = [Some(self.0.run.path()), exact, before, pinned];
        let radii = paths.into_iter().flatten().map(|path| {
            if middle == Vector2::zeros() {
                path.radius
            } else {
                path.radius_about(middle.x, middle.y).max(middle.norm())
            }
        });
        let away = self.places().iter().map(|place| (place.at - middle).norm());
        let radius = radii.chain(away).fold(LEAST_RADIUS_M, f64::max);
        // In steps of 5 %, so that the scale does not change all the time.
        let radius = libm::exp((libm::log(radius) / RADIUS_STEP).ceil() * RADIUS_STEP) * 1.02;
        let zoom = self.0.view.look.zoom.above;
        let half = radius / zoom;
        let plane = |at| Plane::new(picture, self.0.view.marker, at, (half, half));
        let whole = plane((middle.x, middle.y));
        if zoom <= 1.0 {
            return (whole, half);
        }
        let at = self.now(whole.scale.0).position.xy();
        let [x, y] = [at.x, at.y].map(|at| Zoom::middle(at, half));
        (plane((x, y)), half)
    }

    /// The place from above around which the axle circles: where the line of L is, at the height of the traced point, as
    /// long as gravity cannot turn L noticeably within the run; `None` where the circle is about the vertical.
    fn circled(&self) -> Option<Vector2<f64>> {
        let scenario = self.0.run.scenario();
        let momentum = scenario.start.momentum;
        let axis = momentum.try_normalize(f64::MIN_POSITIVE)?;
        let at = scenario.body.mechanics.points()[scenario.trace].at;
        let torque = scenario.motion.gravity * scenario.body.mechanics.first_moment().norm();
        let turn = torque.abs() / momentum.norm() * Clock::end_s(scenario);
        let is_steady = scenario.pushes.is_empty() && scenario.edits.is_empty() && turn < STANDING;
        let place = axis.xy() * at.norm();
        (is_steady && is_on_axle(&at) && place.norm() > 0.0).then_some(place)
    }

    fn ages(&self, across: f64) -> Ages {
        let ages = self
            .0
            .reading
            .map(|reading| Ages::from_readouts(&reading.readouts));
        let turn_dots = TAU * self.0.run.path().radius * across;
        ages.unwrap_or(Ages::UNKNOWN).on_picture(turn_dots)
    }

    /// The moment that is shown: the present one. Where the swings cover each other and the eye cannot follow them, it
    /// is that of the latest reading, so that not every frame has to be sent. Where the scheme has broken down, it is
    /// the last moment before.
    fn now(&self, across: f64) -> RecordedSample {
        let scenario = self.0.run.scenario();
        let traced = scenario.body.mechanics.points()[scenario.trace].at;
        match self.0.reading {
            Some(reading) if reading.last_whole.is_some() => {
                RecordedSample::new(&reading.state, &traced)
            }
            Some(reading) if self.ages(across).are_crowded => {
                let extremes = &reading.readouts.extremes;
                let swing_deg = extremes.tilt.highest_deg - extremes.tilt.lowest_deg;
                let swing_dots = swing_deg.to_radians() * traced.norm() * across;
                if swing_dots > LARGE_SWING {
                    RecordedSample::new(&reading.state, &traced)
                } else {
                    *self.0.run.now()
                }
            }
            _ => *self.0.run.now(),
        }
    }

    /// The exact motion at `time_s` (s), the moment that is shown; `None` where it is not shown, or has not come so far yet.
    fn exact_at(&self, time_s: f64) -> Option<&RecordedSample> {
        let read = self.0.reading.and_then(|reading| reading.exact.as_ref());
        let known = [self.0.run.exact_now(), read].into_iter().flatten();
        known.into_iter().find(|exact| exact.time_s == time_s)
    }

    fn path(&self, plane: &Plane, picture: Rect, buf: &mut Buffer) {
        let mut dots = Dots::new(picture, self.0.view.marker);
        let before = dots::of_run_before(self.0.view.marker);
        let pinned = Ink::Faint(Role::Pinned);
        for (ghost, dashes, ink) in [
            (self.0.ghost, before, Ink::Ghost),
            (self.0.pinned, dots::PINNED_DASHES, pinned),
        ] {
            let path = ghost.into_iter().flat_map(|ghost| ghost.path.dots());
            dots.dashed(path.map(|at| plane.dot(at)), dashes, ink);
        }
        let mut trail = Trail::new(&dots, Around::Nothing);
        for at in self.0.run.path().dots() {
            trail.dot(plane.dot(at), Age::Old);
        }
        let ages = self.ages(plane.scale.0);
        let now = self.now(plane.scale.0);
        let now = (now.time_s, &now.position);
        trail.follow(self.0.run.recording(), &ages, now, |at| {
            plane.dot((at.x, at.y))
        });
        trail.draw(&mut dots);
        if let Some(overlay) = self.0.run.overlay() {
            let exact = overlay.path.dots().map(|at| plane.dot(at));
            dots.dashed(exact, dots::EXACT_DASHES, Ink::Faint(Role::Exact));
        }
        dots.render(&self.0.view.theme, buf);
    }

    /// The measured places; none where the columns of the data do not say them.
    fn places(&self) -> &[MeasuredPlace] {
        self.0
            .measured
            .map_or(&[], |beside| &beside.compared.places)
    }

    /// The measured places: those at times that the run has not reached are faint.
    fn points(&self, plane: &Plane, picture: Rect, buf: &mut Buffer) {
        let now_s = self.0.run.now().time_s;
        let mut points = Points::new(picture, self.0.view.marker);
        for place in self.places() {
            let cell = |x: f64, y: f64| {
                let (column, row) = plane.dot((x, y));
                (
                    column / plane.in_cell.0 as f64,
                    row / plane.in_cell.1 as f64,
                )
            };
            let (x, y) = (place.at.x, place.at.y);
            let role = if place.time_s <= now_s {
                Role::Measured
            } else {
                Role::Quiet
            };
            let [of_x, of_y] = place.sigmas;
            points.add(
                cell(x, y),
                of_x.map(|sigma| -> Ends { (cell(x - sigma, y).0, cell(x + sigma, y).0) }),
                of_y.map(|sigma| -> Ends { (cell(x, y + sigma).1, cell(x, y - sigma).1) }),
                role,
            );
        }
        points.render(&self.0.view.theme, buf);
    }

    /// Each push that acts: a line from the pushed point. Returns its head, or a word where it is straight up or down, and
    /// where that is to stand.
    fn pushes(
        &self,
        plane: &Plane,
        radius_m: f64,
        picture: Rect,
        buf: &mut Buffer,
    ) -> Vec<((u16, u16), &'static str)> {
        let simulation = self.0.run.simulation();
        let points = self.0.run.scenario().body.mechanics.points();
        let mut dots = Dots::new(picture, self.0.view.marker);
        let mut signs = Vec::new();
        for push in simulation.loads().pushes.iter().take(MOST_SHOWN_PUSHES) {
            let at = (simulation.state().orientation * points[push.point].at).xy();
            match push
                .force
                .xy()
                .try_normalize(VERTICAL_FORCE_SHARE * push.force.norm())
            {
                Some(direction) => {
                    let tip = at + direction * (ARROW * radius_m);
                    let [from, to] = [at, tip].map(|at| plane.dot((at.x, at.y)));
                    dots.line(from, to, Ink::Strong(Role::Push));
                    let cell = plane.cell((tip.x, tip.y));
                    signs.push((cell, head(direction.x, direction.y)));
                }
                None => signs.push(upright(plane.cell((at.x, at.y)), push.force.z, picture)),
            }
        }
        dots.render(&self.0.view.theme, buf);
        signs
    }

    /// The pivot, the axes' names, and where the point is now. Returns which places are left for words.
    fn marks(&self, plane: &Plane, picture: Rect, buf: &mut Buffer) -> LabelCells {
        let mut places = LabelCells::new(picture);
        let mut mark = |cell, sign: &str, role| {
            write(picture, cell, sign, self.0.view.theme.style(role), buf);
            places.take(cell);
        };
        let (right, middle) = (picture.width - 1, picture.height / 2);
        mark((right, middle), "x", Role::X);
        mark((picture.width / 2, 0), "y", Role::Y);
        if plane.shows((0.0, 0.0)) {
            mark(plane.cell((0.0, 0.0)), "+", Role::Quiet);
        }
        let now = self.now(plane.scale.0);
        let here = plane.cell((now.position.x, now.position.y));
        let mut sign = "o";
        if let Some(exact) = self.exact_at(now.time_s) {
            let at = (exact.position.x, exact.position.y);
            if plane.shows(at) {
                mark(plane.cell(at), "e", Role::Exact);
            }
            sign = if plane.cell(at) == here { "*" } else { sign };
        }
        mark(here, sign, Role::Focus);
        places
    }
}

impl FromAbove<'_> {
    /// The lines of the legend on `width` columns; the last has room for the scale of `plane` beside it. Where `most` lines
    /// are too few for every mark and line of the picture, those named last are left out.
    fn legend(&self, plane: &Plane, width: usize, most: usize) -> Vec<String> {
        let room = width.saturating_sub(columns(&self.bar(plane, width)) + 1);
        let words = self.words();
        let legend = Self::in_fewest_lines(&words, width, room, most);
        if words.contains(&EARLIER_RUN_LEGEND) || self.0.ghost.is_some() {
            return legend;
        }
        // The path before the last swings is dotted too: said where it costs no line.
        let longer = [&words[..], &[EARLIER_RUN_LEGEND]].concat();
        let longer = Self::in_fewest_lines(&longer, width, room, legend.len());
        let has_all = longer
            .iter()
            .any(|line| line.contains(EARLIER_RUN_LEGEND[0]));
        if has_all { longer } else { legend }
    }

    fn in_fewest_lines(words: &[[&str; 2]], width: usize, room: usize, most: usize) -> Vec<String> {
        let fits = |legend: &Vec<String>| legend.len() <= most;
        let whole = [0, 1]
            .map(|form| in_lines(words, form, width, room))
            .into_iter()
            .min_by_key(Vec::len)
            .filter(fits);
        let mut fewer = (1..words.len())
            .rev()
            .map(|count| in_lines(&words[..count], 1, width, room));
        let legend = whole.or_else(|| fewer.find(fits));
        legend.unwrap_or_else(|| vec![String::new()])
    }

    /// The legend and the scale on `area`, which has as many rows as the legend has lines.
    fn write_legend(&self, plane: &Plane, area: Rect, buf: &mut Buffer) {
        let style = self.0.view.theme.style(Role::Quiet);
        let last = area.height.saturating_sub(1);
        let bar = self.bar(plane, area.width as usize);
        write(area, (0, last), &bar, style, buf);
        let lines = self.legend(plane, area.width.into(), area.height.into());
        for (line, y) in lines.iter().zip(0..) {
            let x = if y == last {
                area.width.saturating_sub(columns(line) as u16)
            } else {
                0
            };
            write(area, (x, y), line, style, buf);
        }
    }

    fn bar(&self, plane: &Plane, width: usize) -> String {
        // The longer legend beside it leaves less room for the bar.
        let share = if self.0.run.overlay().is_some() {
            0.25
        } else {
            0.4
        };
        plane.bar(share * width as f64)
    }

    /// What is drawn, the most important first, at length and in short.
    fn words(&self) -> Vec<[&'static str; 2]> {
        let mut words = vec![["o now"; 2]];
        if self.0.run.overlay().is_some() {
            words.extend([["e exact"; 2], ["* both"; 2]]);
        }
        if self.0.pinned.is_some() {
            words.push(["long dashes: pinned", "-- pinned"]);
        }
        if self.0.ghost.is_some() {
            words.push(["dotted: other run", "dotted: other"]);
        }
        if !self.places().is_empty() {
            words.push(match self.0.view.marker {
                Marker::Ascii => ["X measured"; 2],
                _ => ["× measured"; 2],
            });
        }
        if words.len() == 1 {
            words.push(EARLIER_RUN_LEGEND);
        }
        words
    }
}

/// `words` in lines of at most `width` columns, the last of at most `room`.
fn in_lines(words: &[[&str; 2]], form: usize, width: usize, room: usize) -> Vec<String> {
    let (between, words) = (LEGEND_SEPARATORS[form], words.iter().map(|word| word[form]));
    let mut lines: Vec<_> = super::in_lines(words, |word| word, between.len(), width)
        .iter()
        .map(|line| line.join(between))
        .collect();
    if lines.last().is_some_and(|line| columns(line) > room) {
        lines.push(String::new());
    }
    lines
}

fn is_on_axle(at: &Vector3<f64>) -> bool {
    at.xy().norm() <= POINT_ON_AXLE * at.norm()
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
    let place = if x + 2 + width <= picture.width {
        x + 2
    } else {
        x.saturating_sub(width + 1)
    };
    ((place, y), sign)
}
