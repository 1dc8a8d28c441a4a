//! The 3-D view: a wheel with masses on an axle, the path of the axle's top, and the arrows of L, angular velocity and
//! torque.
//!
//! The foot of the axle is on a floor. L and the angular velocity begin at the pivot and are drawn next to the axle, so
//! that they do not cover it. The torque begins at the tip of L and shows where L moves. The lengths of arrows have no
//! meaning.

mod arrows;
mod body;
mod fit;
mod phase;

use super::{PaneRow, PlotInputs, round_title, rule};
use crate::engine::recording::Recording;
use crate::lab::playback::live::LiveRun;
use crate::lab::view::Pane;
use crate::physics::friction::Damping;
use crate::physics::{State, loads, observables};
use crate::plot::camera::CameraView;
use crate::tui::dots::{self, Dashes};
use crate::tui::keymap::{self, one};
use crate::tui::labels::{AROUND_POINT, Labels};
use crate::tui::layered_dots::{DotInk, FineDot, Layer, LayeredDots, Spot};
use crate::tui::plane::Plane;
use crate::tui::split::split_rows;
use crate::tui::theme::Role;
use arrows::SpaceLabel;
use body::DrawnBody;
use nalgebra::Vector3;
use phase::StepArrows;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::widgets::Widget;
use std::f64::consts::TAU;

/// Minimum length of the axle as the unit of arrows, as a fraction of the body's size.
const LEAST_ARM: f64 = 0.7;
/// Torques smaller than this fraction of the weight's maximum torque count as zero.
const NO_TORQUE: f64 = 1e-9;
/// Torque whose arrow has its full length, as a fraction of the weight's maximum torque.
const FULL_TORQUE: f64 = 0.35;
const CIRCLE_PARTS: usize = 72;

/// Minimum columns for axes on the floor and a shadow.
const SMALL_COLUMNS: u16 = 32;
/// Maximum rows of a pane with small masses and arrowheads.
const LARGE_ROWS: u16 = 20;
/// Minimum rows and columns for a legend in the last row.
const LEGEND_ROWS: u16 = 17;
const LEGEND_COLUMNS: u16 = 48;
/// Columns between two words of the legend.
const LEGEND_WORD_GAP: u16 = 2;

/// Number of swings of the path in space, if the run has more.
const SWINGS: f64 = 2.2;
/// Longest line between two points of a path, as a fraction of the sheet's shorter side.
const LONGEST_LINE: f64 = 0.5;
const FLOOR_DASHES: Dashes = (1, 3);
const AXIS_DASHES: Dashes = (1, 2);
const PLUMB_DASHES: Dashes = (1, 4);

pub const THREE_D_ROW: PaneRow = PaneRow {
    id: Pane::ThreeD,
    title: "3-D",
    draw: |lab, area, buf| {
        ThreeD(PlotInputs::of_path(lab)).render(area, buf);
    },
    keys: keymap::THREE_D_KEYS,
    arrows: Some(|lab, direction, times| one(lab.view().turned(direction, times))),
};

/// The 3-D view, as a widget.
pub struct ThreeD<'a>(pub PlotInputs<'a>);

impl Widget for ThreeD<'_> {
    fn render(self, area: Rect, buf: &mut Buffer) {
        let view = self.0.view;
        let scene = Scene::new(self.0, below(area));
        let title = round_title("3-D", view.look.zoom.three_d, self.0.reading, area.width);
        let stretch = scene.change_stretch_text();
        let right = stretch.as_deref().map(|text| (text, Role::Label));
        let has_focus = view.marks_focus_of(Pane::ThreeD);
        let inside = rule(&title, right, has_focus, area, &view.theme, buf);
        if inside.height >= 2 && inside.width > 0 {
            scene.draw(buf);
            scene.legend(split_rows(inside, scene.picture.height)[1], buf);
        }
    }
}

/// Returns the area of the picture in a pane on `area`: below its rule, and above its legend if there is one.
fn below(area: Rect) -> Rect {
    let inside = super::below_rule(area);
    let has_legend = inside.height >= LEGEND_ROWS && inside.width >= LEGEND_COLUMNS;
    let legend = u16::from(has_legend);
    split_rows(inside, inside.height - legend)[0]
}

/// The run at the time of the picture, with the projection onto the sheet.
struct Scene<'a> {
    seen: PlotInputs<'a>,
    picture: Rect,
    camera: CameraView,
    plane: Plane,
    state: &'a State,
    position: Vector3<f64>,
    shape: DrawnBody,
    /// Size of the body, m.
    reach: f64,
    /// Length of the axle, m: the unit of the arrows' lengths.
    arm: f64,
    /// Height of the floor, m.
    floor_z: f64,
    /// Radius of the circle on the floor, m.
    floor_radius: f64,
    /// Torque of all forces about the pivot, as a fraction of the full length of its arrow; `None` if zero.
    torque: Option<Vector3<f64>>,
    /// The same including friction.
    change: Option<Vector3<f64>>,
    /// Phase on the page of the step pane, if that pane is visible.
    phase: Option<StepArrows<'a>>,
}

impl<'a> Scene<'a> {
    fn new(seen: PlotInputs<'a>, picture: Rect) -> Self {
        let run = seen.run;
        let state = match seen.reading {
            Some(reading) => &reading.state,
            None => run.simulation().state(),
        };
        let shape = DrawnBody::new(run);
        let reach = shape.reach();
        let arm = shape.arm().max(LEAST_ARM * reach);
        let [torque, change] = torques(run, state);
        let position =
            observables::position(&run.scenario().body.mechanics, state, run.scenario().trace);
        let swept = fit::Swept::new(&seen, &shape, arm);
        let wheel = state.axle() * shape.rim.as_ref().map_or(shape.axle.1, |rim| rim.height_m);
        Self {
            camera: seen.view.camera.view(),
            plane: swept.plane(picture, seen.view, &wheel),
            floor_z: swept.floor_z,
            floor_radius: swept.floor_radius,
            seen,
            picture,
            state,
            position,
            shape,
            reach,
            arm,
            torque,
            change,
            phase: StepArrows::of_shown_phase(seen.explained, seen.view),
        }
    }

    fn is_small(&self) -> bool {
        self.picture.width < SMALL_COLUMNS
    }

    fn is_large(&self) -> bool {
        self.picture.height > LARGE_ROWS
    }

    /// Returns the position of `point` (world frame, m) on the sheet.
    fn dot(&self, point: &Vector3<f64>) -> FineDot {
        self.plane.dot(self.camera.project(point))
    }

    fn draw(&self, buf: &mut Buffer) {
        let view = self.seen.view;
        let mut dots = LayeredDots::new(self.picture, view.marker);
        self.floor(&mut dots);
        let mut labels = self.other_runs(&mut dots);
        self.paths(&mut dots);
        self.body(&mut dots);
        labels.extend(self.phase_marks(&mut dots));
        labels.extend(self.draw_arrows(&mut dots));
        self.traced_points(&mut dots);
        dots.render(&view.theme, buf);
        let picture = self.picture;
        let mut sheet = Labels { picture, buf };
        if let Some(cursor) = self.seen.cursor {
            let cell = cell_of(self.dot(&cursor.position));
            sheet.write(cell, "◊", view.theme.style(Role::Cursor));
        }
        for label in &labels {
            label.place(&mut sheet, &view.theme);
        }
        self.label_floor(&mut sheet);
    }

    /// Draws the floor, the post that carries the pivot, and the shadow of the path.
    fn floor(&self, dots: &mut LayeredDots) {
        let floor = ink(Role::Floor, Layer::Ground);
        let circle = (0..=CIRCLE_PARTS).map(|part| {
            let (sin, cos) = libm::sincos(TAU * part as f64 / CIRCLE_PARTS as f64);
            self.dot(&Vector3::new(
                self.floor_radius * cos,
                self.floor_radius * sin,
                self.floor_z,
            ))
        });
        dots.path(circle, Some(FLOOR_DASHES), f64::INFINITY, floor);
        let middle = Vector3::new(0.0, 0.0, self.floor_z);
        if !self.is_small() {
            for end in self.floor_axes() {
                let ends = [self.dot(&middle), self.dot(&end)];
                dots.path(ends.into_iter(), Some(AXIS_DASHES), f64::INFINITY, floor);
            }
            let shadow = |at: Vector3<f64>| Vector3::new(at.x, at.y, self.floor_z);
            let places = self
                .bins(self.seen.run.recording())
                .map(|at| self.dot(&shadow(at)));
            dots.path(places, None, self.longest_line(), floor);
            let plumb = [self.dot(&self.position), self.dot(&shadow(self.position))];
            dots.path(plumb.into_iter(), Some(PLUMB_DASHES), f64::INFINITY, floor);
        }
        if self.has_post() {
            let post = ink(Role::RimFar, Layer::Far);
            dots.line(self.dot(&Vector3::zeros()), self.dot(&middle), post);
        }
    }

    /// Returns the ends of the x and y axes on the floor.
    fn floor_axes(&self) -> [Vector3<f64>; 2] {
        [
            Vector3::new(self.floor_radius, 0.0, self.floor_z),
            Vector3::new(0.0, self.floor_radius, self.floor_z),
        ]
    }

    fn label_floor(&self, labels: &mut Labels<'_>) {
        if self.is_small() {
            return;
        }
        let style = self.seen.view.theme.style(Role::Label);
        for (end, name) in self.floor_axes().iter().zip(["x", "y"]) {
            labels.place(cell_of(self.dot(end)), AROUND_POINT, name, style);
        }
    }

    /// Returns true if the pivot carries an off-center weight, so that a post is drawn under it.
    fn has_post(&self) -> bool {
        let body = &self.seen.run.scenario().body.mechanics;
        let weight = self.seen.run.simulation().loads().gravity.abs() * body.first_moment().norm();
        weight > 0.0
    }

    /// Returns the time from which paths are drawn, s.
    fn since_s(&self) -> f64 {
        let now_s = self.state.time_s;
        let since_s = self.seen.bright_since_s(now_s);
        match self.seen.view.window.swing_s {
            Some(swing_s) if self.seen.view.window.has_overview => {
                since_s.max(now_s - SWINGS * swing_s)
            }
            _ => since_s,
        }
    }

    /// Returns the positions of the traced point in `recording` during the drawn part of the paths.
    fn bins(&self, recording: &'a Recording) -> impl Iterator<Item = Vector3<f64>> {
        let (since_s, now_s) = (self.since_s(), self.state.time_s);
        let bins = recording.between(since_s, now_s);
        let until_now = bins.filter(move |bin| bin.end_s >= since_s && bin.end_s <= now_s);
        until_now.map(|bin| bin.end())
    }

    fn longest_line(&self) -> f64 {
        LONGEST_LINE * self.plane.size.0.min(self.plane.size.1) as f64
    }

    fn paths(&self, dots: &mut LayeredDots) {
        let longest = self.longest_line();
        let run = self.bins(self.seen.run.recording()).chain([self.position]);
        let run = run.map(|at| self.dot(&at));
        dots.path(run, None, longest, ink(Role::Run, Layer::Run));
        if let Some(overlay) = self.seen.overlay() {
            let exact = self.bins(&overlay.recording).map(|at| self.dot(&at));
            let of_exact = ink(Role::Exact, Layer::Exact);
            dots.path(exact, Some(dots::EXACT_DASHES), longest, of_exact);
        }
    }

    /// Draws the paths of the previous and the pinned run, and a line from the pivot to the end of each.
    fn other_runs(&self, dots: &mut LayeredDots) -> Vec<SpaceLabel> {
        let others = [
            (self.seen.ghost, "previous", dots::PREVIOUS_DASHES),
            (self.seen.pinned, "pinned", dots::PINNED_DASHES),
        ];
        let mut labels = Vec::new();
        for (run, name, dashes) in others {
            let Some(run) = run else {
                continue;
            };
            let of_run = ink(Role::Previous, Layer::Previous);
            let path = self.bins(&run.recording).map(|at| self.dot(&at));
            dots.path(path, Some(dashes), self.longest_line(), of_run);
            if let Some(at) = self.bins(&run.recording).last() {
                let axle = [self.dot(&Vector3::zeros()), self.dot(&at)];
                dots.path(axle.into_iter(), Some(dashes), f64::INFINITY, of_run);
                labels.push(SpaceLabel::beside(name, Role::Previous, self.dot(&at)));
            }
        }
        labels
    }

    /// Draws the traced point of the run and of the exact motion.
    fn traced_points(&self, dots: &mut LayeredDots) {
        let spot = if self.is_large() {
            Spot::Five
        } else {
            Spot::Three
        };
        let exact = self.seen.reading.and_then(|reading| reading.exact.as_ref());
        if let Some(exact) = exact.filter(|_| self.seen.overlay().is_some()) {
            let of_exact = ink(Role::Exact, Layer::ExactNow);
            dots.spot(self.dot(&exact.position), Spot::Three, of_exact);
        }
        dots.spot(self.dot(&self.position), spot, ink(Role::Run, Layer::Now));
    }
}

/// Returns the torque of all forces about the pivot at `state`, without and with friction.
///
/// They are relative to [`FULL_TORQUE`] times the weight's maximum torque, at most 1 in length; `None` if zero.
fn torques(run: &LiveRun, state: &State) -> [Option<Vector3<f64>>; 2] {
    let (loads, body) = (run.simulation().loads(), &run.scenario().body.mechanics);
    let torque = loads::torque(&state.orientation, &loads.moment(body));
    let largest = loads.gravity.abs() * body.first_moment().norm();
    let friction = Damping::new(body, &loads.friction).map(|damping| {
        let omega = observables::angular_velocity(body, state);
        state.orientation * damping.torque(&(state.orientation.transpose() * omega))
    });
    let least = (NO_TORQUE * largest).max(f64::MIN_POSITIVE);
    [torque, torque + friction.unwrap_or_default()].map(|torque| {
        let direction = torque.try_normalize(least)?;
        let share = torque.norm() / (FULL_TORQUE * largest);
        Some(direction * share.min(1.0))
    })
}

fn ink(role: Role, layer: Layer) -> DotInk {
    DotInk { role, layer }
}

fn cell_of((x, y): FineDot) -> (i32, i32) {
    ((x / 2.0).floor() as i32, (y / 4.0).floor() as i32)
}
