//! The scene in space: wheel, axle, the path of the axle's top, and the vectors L and Ω.

use super::{PaneRow, Width, frame, write};
use crate::lab::view::{Pane, View};
use crate::observe::live::LiveRun;
use crate::observe::recording::{Curve, Recording};
use crate::tui::dots::{Dots, Ink};
use crate::tui::theme::Role;
use nalgebra::Vector3;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::widgets::Widget;

/// Length of the longer vectors, of the distance between pivot and traced point.
const VECTOR: f64 = 1.15;
/// What the picture shows of z, lowest and highest, of the same: for a body that has always stood above the pivot, and
/// for one that has hung.
const STANDING: (f64, f64) = (-0.45, 1.25);
const HANGING: (f64, f64) = (-1.25, 1.25);
/// Length of a push's arrow, and of the two strokes of its head, of the same: its direction is what there is to see.
const ARROW: f64 = 0.45;
const HEAD: f64 = 0.12;
/// Half the angle between the strokes of a head, radians.
const HEAD_ANGLE: f64 = 0.5;
/// More pushes than this at one time are no picture.
const MOST_PUSHES: usize = 20;
/// Points of the body beyond this many are not drawn as a wheel.
const MOST_SPOKES: usize = 400;

/// Its row in the table of panes.
pub const ROW: PaneRow = PaneRow {
    id: Pane::THREE_D,
    title: "3-D",
    width: Width::Round,
    rank: 3,
    least: (40, 18),
    draw: |lab, area, buf| {
        let (run, view) = (lab.player().run(), lab.view());
        ThreeD { run, view }.render(area, buf);
    },
    keys: &[],
};

/// The scene in space.
pub struct ThreeD<'a> {
    /// The run.
    pub run: &'a LiveRun,
    /// How it is looked at.
    pub view: &'a View,
}

impl Widget for ThreeD<'_> {
    fn render(self, area: Rect, buf: &mut Buffer) {
        let theme = &self.view.theme;
        let inside = frame(ROW.title, area, self.view.focus == ROW.id, theme, buf);
        if inside.is_empty() {
            return;
        }
        let mut scene = Scene::new(inside, &self, Dots::new(inside, self.view.marker));
        self.axes(&mut scene);
        self.paths(&mut scene);
        self.body(&mut scene);
        let mut labels = self.vectors(&mut scene);
        labels.extend(self.pushes(&mut scene));
        scene.dots.render(theme, buf);
        let mut taken = Vec::with_capacity(labels.len());
        for (name, role, at) in labels.iter().rev() {
            let cell = beside(scene.cell(at), &taken);
            write(inside, cell, name, theme.style(*role), buf);
            taken.push(cell);
        }
    }
}

/// `cell`, or the next one to its right that keeps off those that are `taken`.
fn beside(cell: (u16, u16), taken: &[(u16, u16)]) -> (u16, u16) {
    let (mut x, y) = cell;
    while taken
        .iter()
        .any(|&(other, row)| row.abs_diff(y) <= 1 && other.abs_diff(x) <= 1)
    {
        x += 2;
    }
    (x, y)
}

type Label = (&'static str, Role, Vector3<f64>);

impl ThreeD<'_> {
    fn reach(&self) -> f64 {
        let scenario = self.run.scenario();
        let furthest = scenario
            .file
            .body
            .rim
            .as_ref()
            .map_or(0.0, |rim| rim.radius_m.hypot(rim.height_m));
        scenario.arm_m().max(furthest).max(f64::MIN_POSITIVE)
    }

    fn axes(&self, scene: &mut Scene<'_>) {
        let length = 0.5 * self.reach();
        for axis in [Vector3::x(), Vector3::y(), Vector3::z()] {
            scene.line(&Vector3::zeros(), &(axis * length), Ink::Faint(Role::Quiet));
        }
    }

    fn paths(&self, scene: &mut Scene<'_>) {
        if let Some(overlay) = self.run.overlay() {
            scene.path(overlay.recording(), Ink::Faint(Role::Exact));
        }
        scene.path(self.run.recording(), Ink::Faint(Role::Path));
    }

    /// The rim as a polygon through its points, one spoke to see it turn, and the axle.
    fn body(&self, scene: &mut Scene<'_>) {
        let scenario = self.run.scenario();
        let state = self.run.simulation().state();
        let points = scenario.body.mechanics.points();
        let place = |index: usize| state.orientation * points[index].at;
        let rim = scenario.file.body.rim.as_ref().map_or(0, |rim| rim.points);
        let every = rim.div_ceil(MOST_SPOKES).max(1);
        let corners: Vec<_> = (0..rim).step_by(every).map(place).collect();
        for (index, corner) in corners.iter().enumerate() {
            scene.line(
                corner,
                &corners[(index + 1) % corners.len()],
                Ink::Strong(Role::X),
            );
        }
        if let (Some(first), Some(rim)) = (corners.first(), &scenario.file.body.rim) {
            let hub = state.axle() * rim.height_m;
            scene.line(&hub, first, Ink::Strong(Role::X));
        }
        scene.line(
            &Vector3::zeros(),
            &self.run.now().position,
            Ink::Strong(Role::Text),
        );
    }

    /// L and Ω, each as long as the scene's vectors are: their directions are what there is to see.
    fn vectors(&self, scene: &mut Scene<'_>) -> Vec<Label> {
        let state = self.run.simulation().state();
        let omega = crate::physics::observables::angular_velocity(
            &self.run.scenario().body.mechanics,
            state,
        );
        let length = VECTOR * self.reach();
        let mut labels: Vec<Label> = [
            ("x", Role::X, Vector3::x()),
            ("y", Role::Y, Vector3::y()),
            ("z", Role::Z, Vector3::z()),
        ]
        .map(|(name, role, axis)| (name, role, axis * (0.55 * self.reach())))
        .to_vec();
        for (name, role, vector, share) in [
            ("Ω", Role::Y, omega, 0.9),
            ("L", Role::Z, state.momentum, 1.0),
        ] {
            if let Some(direction) = vector.try_normalize(f64::MIN_POSITIVE) {
                let tip = direction * (length * share);
                scene.line(&Vector3::zeros(), &tip, Ink::Strong(role));
                labels.push((name, role, tip));
            }
        }
        labels
    }
}

impl ThreeD<'_> {
    /// An arrow for each push that acts, from the pushed point along the force.
    fn pushes(&self, scene: &mut Scene<'_>) -> Vec<Label> {
        let simulation = self.run.simulation();
        let points = self.run.scenario().body.mechanics.points();
        let mut labels = Vec::new();
        for push in simulation.loads().pushes.iter().take(MOST_PUSHES) {
            let from = simulation.state().orientation * points[push.point].at;
            if let Some(direction) = push.force.try_normalize(f64::MIN_POSITIVE) {
                let tip = from + direction * (ARROW * self.reach());
                scene.arrow(&from, &tip, HEAD * self.reach(), Ink::Strong(Role::Push));
                labels.push(("F", Role::Push, tip));
            }
        }
        labels
    }
}

/// The sheet of dots with the camera's eye on it.
struct Scene<'a> {
    view: &'a View,
    dots: Dots,
    /// Where the pivot stands, dots.
    pivot: (f64, f64),
    /// Dots in a metre, across and down.
    across: f64,
    down: f64,
}

impl<'a> Scene<'a> {
    fn new(area: Rect, pane: &ThreeD<'a>, dots: Dots) -> Self {
        let (in_x, in_y) = pane.view.marker.dots();
        let (width, height) = (
            area.width as f64 * in_x as f64,
            area.height as f64 * in_y as f64,
        );
        let aspect = pane.view.marker.dot_aspect();
        let lowest = pane
            .run
            .recording()
            .whole()
            .map_or(0.0, |whole| whole.extent(Curve::Z).min);
        let (bottom, top) = if lowest < 0.0 { HANGING } else { STANDING };
        let (half_height, middle) = (0.5 * (top - bottom), 0.5 * (top + bottom));
        let reach = pane.reach();
        let down = (0.5 * height / half_height).min(0.5 * width * aspect / HANGING.1) / reach;
        let (_, above_pivot) = pane
            .view
            .camera
            .project(&Vector3::new(0.0, 0.0, middle * reach));
        let pivot = (0.5 * width, 0.5 * height + above_pivot * down);
        Self {
            view: pane.view,
            dots,
            pivot,
            across: down / aspect,
            down,
        }
    }

    fn dot(&self, point: &Vector3<f64>) -> (f64, f64) {
        let (right, up) = self.view.camera.project(point);
        (
            self.pivot.0 + right * self.across,
            self.pivot.1 - up * self.down,
        )
    }

    fn cell(&self, point: &Vector3<f64>) -> (u16, u16) {
        let (x, y) = self.dot(point);
        let (in_x, in_y) = self.view.marker.dots();
        let inside = |dot: f64, dots: usize| dot.clamp(0.0, dots.saturating_sub(1) as f64);
        (
            (inside(x, self.dots.width()) / in_x as f64) as u16,
            (inside(y, self.dots.height()) / in_y as f64) as u16,
        )
    }

    fn line(&mut self, from: &Vector3<f64>, to: &Vector3<f64>, ink: Ink) {
        let (from, to) = (self.dot(from), self.dot(to));
        self.dots.line(from, to, ink);
    }

    /// A line with a head of two strokes, each `head_m` long, at its tip.
    fn arrow(&mut self, from: &Vector3<f64>, tip: &Vector3<f64>, head_m: f64, ink: Ink) {
        self.line(from, tip, ink);
        let (begin, end) = (
            self.view.camera.project(from),
            self.view.camera.project(tip),
        );
        let (right, up) = (begin.0 - end.0, begin.1 - end.1);
        let length = right.hypot(up);
        if length < head_m {
            return; // seen along itself, it has no head
        }
        for (sin, cos) in [HEAD_ANGLE, -HEAD_ANGLE].map(f64::sin_cos) {
            let stroke = (right * cos - up * sin, right * sin + up * cos);
            let share = head_m / length;
            let end_dot = self.dot(tip);
            let stroke_end = (
                end_dot.0 + share * stroke.0 * self.across,
                end_dot.1 - share * stroke.1 * self.down,
            );
            self.dots.line(end_dot, stroke_end, ink);
        }
    }

    fn path(&mut self, recording: &Recording, ink: Ink) {
        for block in recording.since(0.0) {
            let (x, y) = self.dot(&block.end);
            self.dots.set(x, y, ink);
        }
    }
}
