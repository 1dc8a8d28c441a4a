//! The scene in space: the wheel on its axle over the ground, the path of the axle's top, and what turns it.
//!
//! The scene shows which way is up, a wheel with masses in front and behind, and why it goes where it goes: the weight g
//! makes a torque τ about the pivot; L changes by dL along it, and the axle follows L.

mod arrows;
mod body;

use super::{PaneRow, PlotInputs, ROWS_A_LINE, Width, round_frame, write};
use crate::engine::recording::RecordedCurve;
use crate::engine::text::wrap::columns;
use crate::lab::playback::ages::{Age, Ages};
use crate::lab::playback::live::LiveRun;
use crate::lab::view::Pane;
use crate::physics::friction::Damping;
use crate::physics::{State, loads, observables};
use crate::plot::camera::Zoom;
use crate::tui::dots::{self, Dots, Ink};
use crate::tui::keymap::{ZOOM_KEYS, one};
use crate::tui::plane::LabelCells;
use crate::tui::scene::{self, DotScene, LineStroke};
use crate::tui::split::split_rows;
use crate::tui::theme::Role;
use crate::tui::trail::{self, Around, Trail};
use arrows::StepArrows;
use body::{BodySign, DrawnBody};
use nalgebra::Vector3;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::widgets::Widget;
use std::f64::consts::TAU;

/// Length of the arrow of L, in lengths of the axle. Only its direction has a meaning. Where it lies along the axle, its end
/// shows beyond the axle's top and the arrow of the angular velocity; a longer one would leave less room for the wheel.
const MOMENTUM_ARROW_LENGTH: f64 = 1.36;
/// The least length of the axle as a unit of arrows, as a share of the body's size.
const LEAST_ARM: f64 = 0.7;
/// Length of the arrow of the change of L, as a share of the body's size.
const CHANGE_ARROW_SHARE: f64 = 0.3;
/// Length of the axes of the world, as a share of the body's size.
const GROUND: f64 = 0.45;
/// Height of the stand that carries the pivot, and radius of its foot, as shares of the body's size.
const STAND: f64 = 0.26;
const FOOT: f64 = 0.22;
/// Tilts are rounded to multiples of this, degrees, so that the scale does not change all the time.
const TILT_DEG: f64 = 5.0;
/// Margin around what is drawn, as a share of it, for letters.
const PICTURE_MARGIN: f64 = 1.06;
/// A torque smaller than this share of the largest torque of the weight counts as zero.
const NO_TORQUE: f64 = 1e-9;
const CIRCLE_PARTS: usize = 72;

pub const THREE_D_ROW: PaneRow = PaneRow {
    id: Pane::ThreeD,
    title: "3-D",
    width: Width::Round,
    rank: 3,
    least: (40, 17),
    draw: |lab, area, buf| {
        ThreeD(PlotInputs::from_lab(lab)).render(area, buf);
    },
    keys: ZOOM_KEYS,
    arrows: Some(|lab, direction, times| one(lab.view().turned(direction, times))),
};

pub struct ThreeD<'a>(pub PlotInputs<'a>);

type SpaceLabel = (&'static str, Role, Vector3<f64>);

impl Widget for ThreeD<'_> {
    fn render(self, area: Rect, buf: &mut Buffer) {
        let zoom = self.0.view.look.zoom.three_d;
        let Some(inside) = round_frame(&THREE_D_ROW, zoom, &self.0, area, buf) else {
            return;
        };
        let subject = SceneSubject::new(self.0);
        let most = (inside.height / ROWS_A_LINE).max(1) as usize;
        let lines = subject.legend_lines(inside.width as usize, most) as u16;
        let [picture, legend] = split_rows(inside, inside.height - lines);
        subject.draw(picture, buf);
        subject.legend(legend, buf);
    }
}

/// The run at the time of the picture, and what several parts of the picture need of it.
struct SceneSubject<'a> {
    seen: PlotInputs<'a>,
    ages: Ages,
    state: &'a State,
    position: Vector3<f64>,
    shape: DrawnBody,
    /// The size of the body, m: the unit of the arrows' lengths.
    reach: f64,
    /// The length of the axle, m: the unit of the arrows along it.
    arm: f64,
    /// The direction of the torque of all forces about the pivot, where there is one.
    torque: Option<Vector3<f64>>,
    /// That of this torque and friction's together: the direction of dL.
    change: Option<Vector3<f64>>,
    /// The phase that the step pane is at, where that is on the screen.
    shown_phase: Option<StepArrows<'a>>,
}

impl<'a> SceneSubject<'a> {
    fn new(seen: PlotInputs<'a>) -> Self {
        let run = seen.run;
        let mechanics = &run.scenario().body.mechanics;
        let state = match seen.reading {
            Some(reading) => &reading.state,
            None => run.simulation().state(),
        };
        let ages = seen
            .reading
            .map(|reading| Ages::from_readouts(&reading.readouts));
        let shape = DrawnBody::new(run);
        let reach = shape.reach();
        let [torque, change] = torques(run, state);
        Self {
            seen,
            ages: ages.unwrap_or(Ages::UNKNOWN),
            state,
            position: observables::position(mechanics, state, run.scenario().trace),
            reach,
            arm: shape.arm().max(LEAST_ARM * reach),
            shape,
            torque,
            change,
            shown_phase: StepArrows::of_shown_phase(seen.explained, seen.view),
        }
    }

    fn draw(&self, picture: Rect, buf: &mut Buffer) {
        let (theme, marker) = (&self.seen.view.theme, self.seen.view.marker);
        let mut dots = Dots::new(picture, marker);
        let mut scene = DotScene::new(picture, marker, self.seen.view.camera, &self.shown());
        let mut labels = self.ground(&mut scene);
        self.other_runs(&mut scene, &mut dots);
        self.path(&scene, &mut dots);
        self.body(&mut scene);
        labels.extend(self.phase(&mut scene));
        labels.extend(self.draw_arrows(&mut scene));
        let way = self.way(&scene);
        let signs = self.signs(&way, &scene);
        let labels: Vec<_> = labels
            .iter()
            .rev()
            .map(|(name, role, at)| (*name, *role, scene.cell(at)))
            .collect();
        scene.draw(&mut dots);
        way.join(&mut dots);
        dots.render(theme, buf);
        let mut places = LabelCells::new(picture);
        for (sign, role, cell) in signs {
            write(picture, cell, sign, theme.style(role), buf);
            places.take(cell);
        }
        for (name, role, cell) in labels {
            let cell = places.place(cell, columns(name) as u16);
            write(picture, cell, name, theme.style(role), buf);
        }
    }

    /// The signs that no letter covers, the most important last.
    fn signs(&self, way: &ScreenPath, scene: &DotScene) -> Vec<BodySign> {
        let mut signs: Vec<_> = way.head.into_iter().collect();
        signs.extend(self.signs_of_phase(scene));
        signs.extend(self.masses(scene));
        let marks = [
            ("+", Role::Heading, Vector3::zeros()),
            ("*", Role::Focus, self.position),
        ];
        let shown = marks.iter().filter(|(_, _, at)| scene.shows(at));
        signs.extend(shown.map(|(sign, role, at)| (*sign, *role, scene.cell(at))));
        signs
    }

    /// What the scene needs to show: the body as it precesses at the tilts that it has had, L, and the ground.
    fn shown(&self) -> scene::VisibleArea {
        let circles = self.circles();
        let (sin, cos) = libm::sincos(self.seen.view.camera.pitch_deg.to_radians());
        let end = |side: f64| move |&(radius, z): &(f64, f64)| z * cos + side * radius * sin.abs();
        let lowest = circles.iter().map(end(-1.0)).fold(0.0, f64::min);
        let highest = circles.iter().map(end(1.0)).fold(0.0, f64::max);
        let widest = circles.iter().map(|circle| circle.0).fold(0.0, f64::max);
        let zoom = self.seen.view.look.zoom.three_d;
        let half = [widest, 0.5 * (highest - lowest)].map(|half| PICTURE_MARGIN * half / zoom);
        let middle = if zoom > 1.0 {
            let (right, up) = self.seen.view.camera.project(&self.wheel());
            (Zoom::middle(right, half[0]), Zoom::middle(up, half[1]))
        } else {
            (0.0, 0.5 * (lowest + highest))
        };
        scene::VisibleArea {
            middle,
            half: half.into(),
            reach: self.reach,
        }
    }

    /// Circles about the vertical around all that is drawn, radius and height.
    fn circles(&self) -> Vec<(f64, f64)> {
        let tilts = self
            .seen
            .run
            .recording()
            .whole()
            .map_or((0.0, 0.0), |whole| {
                let tilt = whole.extent(RecordedCurve::Tilt);
                (tilt.min, tilt.max)
            });
        let (first, last) = ((tilts.0 / TILT_DEG).floor(), (tilts.1 / TILT_DEG).ceil());
        let ground = GROUND * self.reach;
        let mut circles = if self.stands() {
            vec![(ground, -STAND * self.reach)]
        } else {
            vec![(ground, 0.0), (0.0, ground)] // z too has a letter
        };
        for tilt in first as i32..=last as i32 {
            let (sin, cos) = libm::sincos((f64::from(tilt) * TILT_DEG).to_radians());
            for &(across, height) in &self.shape.corners {
                circles.extend([across, -across].map(|side| {
                    let radius = height * sin + side * cos;
                    (radius.abs(), height * cos - side * sin)
                }));
            }
        }
        for other in [self.seen.ghost, self.seen.pinned].into_iter().flatten() {
            if let Some(whole) = other.recording.whole() {
                let z = whole.extent(RecordedCurve::Z);
                circles.extend([z.min, z.max].map(|z| (other.path.radius, z)));
            }
        }
        if let Some(axis) = self.state.momentum.try_normalize(f64::MIN_POSITIVE) {
            let angle = libm::acos(axis.z.clamp(-1.0, 1.0)).to_degrees() / (3.0 * TILT_DEG);
            for whole in [angle.floor(), angle.ceil()] {
                let (sin, cos) = libm::sincos((whole * 3.0 * TILT_DEG).to_radians());
                let length = MOMENTUM_ARROW_LENGTH * self.arm;
                circles.push((
                    libm::hypot(length * sin, CHANGE_ARROW_SHARE * self.reach),
                    length * cos,
                ));
            }
        }
        circles
    }

    /// The stand on which the axle rests, or a level circle about a pivot that carries no weight; and the directions of x,
    /// y and z. Where there is a stand, z has no letter, which would lie over the hub: the stand shows what is up.
    fn ground(&self, scene: &mut DotScene) -> Vec<SpaceLabel> {
        let stands = self.stands();
        let floor = Vector3::z() * if stands { -STAND * self.reach } else { 0.0 };
        let radius = self.reach * if stands { FOOT } else { GROUND };
        let ink = Ink::Faint(Role::Quiet);
        let circle: Vec<_> = (0..CIRCLE_PARTS)
            .map(|part| {
                let (sin, cos) = libm::sincos(TAU * part as f64 / CIRCLE_PARTS as f64);
                floor + Vector3::new(radius * cos, radius * sin, 0.0)
            })
            .collect();
        if stands {
            scene.ring(&circle, |_| (LineStroke::Thin, ink));
            scene.line(&Vector3::zeros(), &floor, LineStroke::Thin, ink);
        } else {
            for pair in circle.chunks(2) {
                if let [from, to] = pair {
                    scene.line(from, to, LineStroke::Thin, ink);
                }
            }
        }
        let length = GROUND * self.reach;
        let axes = [
            ("x", floor, Vector3::x()),
            ("y", floor, Vector3::y()),
            ("z", Vector3::zeros(), Vector3::z()),
        ];
        let drawn = &axes[..if stands { 2 } else { 3 }];
        drawn
            .iter()
            .map(|(name, from, axis)| {
                let tip = from + axis * length;
                scene.line(from, &tip, LineStroke::Dotted(3), ink);
                // The colours of the traces of x, y and z are those of arrows here.
                (*name, Role::Quiet, tip)
            })
            .collect()
    }

    /// Whether the pivot carries a weight that is off it, so that a stand is seen under it.
    fn stands(&self) -> bool {
        let body = &self.seen.run.scenario().body.mechanics;
        let weight = self.seen.run.simulation().loads().gravity.abs() * body.first_moment().norm();
        weight > 0.0
    }

    fn path(&self, scene: &DotScene, dots: &mut Dots) {
        let mut trail = Trail::new(dots, Around::Body);
        let now = (self.state.time_s, &self.position);
        let ages = self
            .ages
            .on_picture(TAU * self.seen.run.path().radius * scene.plane.scale.0);
        trail.follow(self.seen.run.recording(), &ages, now, |at| scene.dot(at));
        trail.draw(dots);
        if let Some(overlay) = self.seen.run.overlay() {
            let exact = overlay.recording.since(0.0);
            for (x, y) in exact.map(|block| scene.dot(&block.end())) {
                dots.set(x, y, Ink::Faint(Role::Exact));
            }
        }
    }

    /// The paths of the run before and of the pinned one, and a line from the pivot to where each is at this time.
    fn other_runs(&self, scene: &mut DotScene, dots: &mut Dots) {
        let before = (Ink::Ghost, dots::of_run_before(self.seen.view.marker), 3);
        let pinned = (Ink::Faint(Role::Pinned), dots::PINNED_DASHES, 2);
        for (run, (ink, path, axle)) in [(self.seen.ghost, before), (self.seen.pinned, pinned)] {
            let Some(recording) = run.map(|run| &run.recording) else {
                continue;
            };
            let places = recording.since(f64::NEG_INFINITY);
            dots.dashed(places.map(|block| scene.dot(&block.end())), path, ink);
            let mut until_now = recording.between(self.state.time_s, self.state.time_s);
            if let Some(now) = until_now.next() {
                scene.line(&Vector3::zeros(), &now.end(), LineStroke::Dotted(axle), ink);
            }
        }
    }
}

/// The directions of the torque of all forces about the pivot at `state`, and of that with friction's, where there is one.
fn torques(run: &LiveRun, state: &State) -> [Option<Vector3<f64>>; 2] {
    let (loads, body) = (run.simulation().loads(), &run.scenario().body.mechanics);
    let torque = loads::torque(&state.orientation, &loads.moment(body));
    let largest = loads.gravity.abs() * body.first_moment().norm();
    let friction = Damping::new(body, &loads.friction).map(|damping| {
        let omega = observables::angular_velocity(body, state);
        state.orientation * damping.torque(&(state.orientation.transpose() * omega))
    });
    let least = (NO_TORQUE * largest).max(f64::MIN_POSITIVE);
    [torque, torque + friction.unwrap_or_default()].map(|torque| torque.try_normalize(least))
}

/// Distances from the point, columns, a row counting as two: up to the first the path is drawn over everything, at the
/// second the sign stands.
const JOINED: f64 = 3.0;
const PATH_HEAD_DOTS: f64 = 7.0;
/// Length of the stretch of path that gives the sign its direction, columns.
const STRETCH: f64 = 1.5;

/// A place on the sheet, dots across and down.
type DotPosition = (f64, f64);

pub struct ScreenPath {
    /// From the point backwards.
    dots: Vec<DotPosition>,
    /// The sign that shows where the point goes, if the path is long enough.
    pub head: Option<(&'static str, Role, (u16, u16))>,
}

impl SceneSubject<'_> {
    /// The way on which the point has come.
    pub(super) fn way(&self, scene: &DotScene) -> ScreenPath {
        let until = self.state.time_s;
        let [turn, recent] = [Age::Turn, Age::Recent].map(|age| self.ages.since(age, until));
        let blocks: Vec<_> = self
            .seen
            .run
            .recording()
            .since(turn)
            .filter(|block| block.end_s >= turn && block.end_s <= until)
            .collect();
        let now = scene.dot(&self.position);
        let (across, down) = (
            scene.plane.in_cell.0 as f64,
            0.5 * scene.plane.in_cell.1 as f64,
        );
        let columns = |from: DotPosition, to: DotPosition| {
            libm::hypot((to.0 - from.0) / across, (to.1 - from.1) / down)
        };
        let (mut way, mut joined) = (vec![now], 0);
        let mut head = None;
        for block in blocks.iter().rev() {
            let at = scene.dot(&block.end());
            let longest = trail::longest_line(scene.plane.size, block.end_s >= recent);
            let last = way[way.len() - 1];
            let apart = (at.0 - last.0).abs().max((at.1 - last.1).abs());
            if apart.is_nan() || apart > longest {
                break; // the path has a gap here
            }
            way.push(at);
            joined += usize::from(joined + 2 == way.len() && columns(now, last) < JOINED);
            if columns(now, at) < PATH_HEAD_DOTS {
                continue;
            }
            let newer = way
                .iter()
                .rev()
                .find(|place| columns(at, **place) >= STRETCH);
            let to = newer.unwrap_or(&now);
            let direction = ((to.0 - at.0) / across, (to.1 - at.1) / down);
            let cell = scene.plane.cell_of(at);
            head = cell.map(|cell| (sign(direction), Role::Focus, cell));
            break;
        }
        way.truncate(joined + 1);
        ScreenPath { dots: way, head }
    }
}

/// The sign that points most nearly along `right`, `down`.
fn sign((right, down): DotPosition) -> &'static str {
    match (right.abs() >= down.abs(), right >= 0.0, down >= 0.0) {
        (true, true, _) => "►",
        (true, false, _) => "◄",
        (false, _, true) => "▼",
        (false, _, false) => "▲",
    }
}

impl ScreenPath {
    pub fn join(&self, dots: &mut Dots) {
        for pair in self.dots.windows(2) {
            if let [from, to] = pair {
                dots.line(*from, *to, Ink::Strong(Role::Focus));
            }
        }
    }
}
