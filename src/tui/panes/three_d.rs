//! The scene in space: the wheel on its axle over the ground, the path of the axle's top, and what turns it.
//!
//! What there is to see: which way is up, a wheel with its masses of which some are in front and some behind, and why it
//! goes where it goes. The weight g makes a torque τ about the pivot; L changes by dL along it, and the axle follows L.

use super::{PaneRow, Width, frame, write};
use crate::lab::view::{Pane, View};
use crate::observe::ages::Ages;
use crate::observe::camera::Zoom;
use crate::observe::live::LiveRun;
use crate::observe::overlay::Overlay;
use crate::observe::reading::Reading;
use crate::observe::recording::Curve;
use crate::physics::{State, loads, observables};
use crate::text::wrap::columns;
use crate::tui::dots::{Dots, Ink};
use crate::tui::keymap::ZOOM_KEYS;
use crate::tui::scene::{Scene, Shown, Stroke, beside};
use crate::tui::theme::Role;
use crate::tui::trail::Trail;
use nalgebra::Vector3;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::widgets::Widget;
use std::f64::consts::TAU;

/// Lengths of the arrows, of the scene's reach: their directions are what there is to see.
const MOMENTUM: f64 = 1.1;
const OMEGA: f64 = 0.85;
const WEIGHT: f64 = 0.35;
const TORQUE: f64 = 0.5;
const CHANGE: f64 = 0.35;
const PUSH: f64 = 0.4;
/// Radius of the ground, and length of the vertical axis, of the same.
const GROUND: f64 = 0.6;
/// A torque below this part of the largest that the weight can have is none.
const NO_TORQUE: f64 = 1e-9;
/// More pushes than this at one time are no picture.
const MOST_PUSHES: usize = 20;
/// Parts of a circle.
const PARTS: usize = 72;
/// Spokes, and free masses, that are drawn at most.
const MOST_SPOKES: usize = 6;
const MOST_FREE: usize = 60;
/// Radius of the hub, of that of the rim.
const HUB: f64 = 0.14;
/// A mass is near or far where it is nearer or farther than the hub by this part of the rim's radius.
const NEAR: f64 = 0.33;
/// Signs of masses stand no closer than this on the rim, cells.
const CLOSEST: f64 = 2.0;
/// The tilts that are to have room are taken at multiples of this, degrees: the picture shall not breathe.
const TILT_DEG: f64 = 5.0;
/// Room around what is drawn, of it: for letters.
const MARGIN: f64 = 1.06;

/// Its row in the table of panes.
pub const ROW: PaneRow = PaneRow {
    id: Pane::THREE_D,
    title: "3-D",
    width: Width::Round,
    rank: 3,
    least: (40, 18),
    draw: |lab, area, buf| {
        ThreeD {
            run: lab.player().run(),
            view: lab.view(),
            reading: Some(lab.player().reading()),
        }
        .render(area, buf);
    },
    keys: ZOOM_KEYS,
};

/// The scene in space.
pub struct ThreeD<'a> {
    /// The run.
    pub run: &'a LiveRun,
    /// How it is looked at.
    pub view: &'a View,
    /// The latest reading of the run, if it is read at all: the scene is that of its time, and by it the path is recent or
    /// old. A wheel that turns changes most of the picture; sent with every frame it would load a slow line.
    pub reading: Option<&'a Reading>,
}

/// A letter at a place.
type Label = (&'static str, Role, Vector3<f64>);

impl Widget for ThreeD<'_> {
    fn render(self, area: Rect, buf: &mut Buffer) {
        let theme = &self.view.theme;
        let zoom = self.view.zoom.three_d;
        let title = match zoom == 1.0 {
            true => ROW.title.to_owned(),
            false => format!("{} ×{zoom}", ROW.title),
        };
        let inside = frame(&title, area, self.view.focus == ROW.id, theme, buf);
        if inside.height < 2 || inside.width == 0 {
            return;
        }
        let picture = Rect {
            height: inside.height - 1,
            ..inside
        };
        let mut dots = Dots::new(picture, self.view.marker);
        let mut scene = Scene::new(&dots, self.view.camera, &self.shown());
        let mut labels = self.ground(&mut scene);
        self.path(&scene, &mut dots);
        self.body(&mut scene);
        labels.extend(self.vectors(&mut scene));
        labels.extend(self.pushes(&mut scene));
        let masses = self.masses(&scene);
        let cells: Vec<_> = labels
            .iter()
            .map(|(name, role, at)| (*name, *role, scene.cell(at)))
            .collect();
        let here = self.position();
        let here = scene.shows(&here).then(|| scene.cell(&here));
        scene.draw(&mut dots);
        dots.render(theme, buf);
        for (sign, role, cell) in masses {
            write(picture, cell, sign, theme.style(role), buf);
        }
        let mut taken: Vec<_> = here.into_iter().collect();
        for (name, role, cell) in cells.iter().rev() {
            let cell = beside(*cell, columns(name) as u16, &taken, picture);
            write(picture, cell, name, theme.style(*role), buf);
            taken.push(cell);
        }
        if let Some(here) = here {
            write(picture, here, "*", theme.style(Role::Focus), buf);
        }
        let legend = Rect {
            y: picture.bottom(),
            height: 1,
            ..inside
        };
        self.legend(legend, buf);
    }
}

/// The body as it is drawn, upright: distances from the axle and heights.
struct Shape {
    /// Radius, height and number of points of the rim.
    rim: Option<(f64, f64, usize)>,
    /// Heights between which there is an axle.
    axle: (f64, f64),
    /// Distance from the axle and height of the rim and of each free point that is drawn.
    corners: Vec<(f64, f64)>,
    /// The free points that have a mass.
    free: Vec<Vector3<f64>>,
}

impl Shape {
    fn of(run: &LiveRun) -> Self {
        let scenario = run.scenario();
        let points = scenario.body.mechanics.points();
        let rim = scenario.file.body.rim.as_ref();
        let rim = rim.map(|rim| (rim.radius_m, rim.height_m, rim.points));
        let after = rim.map_or(0, |(_, _, points)| points);
        let free: Vec<_> = points.iter().skip(after).take(MOST_FREE).collect();
        let traced = points[scenario.trace].at;
        let mut corners: Vec<_> = rim
            .iter()
            .map(|&(radius, height, _)| (radius, height))
            .collect();
        let corner = |at: &Vector3<f64>| (at.xy().norm(), at.z);
        corners.extend(free.iter().map(|point| corner(&point.at)));
        corners.push(corner(&traced));
        let heights = || corners.iter().map(|(_, height)| *height);
        let axle = (heights().fold(0.0, f64::min), heights().fold(0.0, f64::max));
        let has_mass = free.iter().filter(|point| point.mass > 0.0);
        let free = has_mass.map(|point| point.at).collect();
        Self {
            rim,
            axle,
            corners,
            free,
        }
    }

    /// The size of the body, m.
    fn reach(&self) -> f64 {
        let reaches = self
            .corners
            .iter()
            .map(|(across, height)| across.hypot(*height));
        reaches.fold(f64::MIN_POSITIVE, f64::max)
    }
}

/// Whether something is in front of `middle`, behind it, or beside it, by `depth`.
fn is_near(depth: f64, middle: f64, radius: f64) -> Option<bool> {
    let share = (depth - middle) / radius;
    (share.abs() > NEAR).then_some(share < 0.0)
}

impl ThreeD<'_> {
    /// The state that is shown.
    fn state(&self) -> &State {
        let state = self.reading.map(|reading| &reading.state);
        state.unwrap_or_else(|| self.run.simulation().state())
    }

    /// Where the traced point is then.
    fn position(&self) -> Vector3<f64> {
        let scenario = self.run.scenario();
        observables::position(&scenario.body.mechanics, self.state(), scenario.trace)
    }

    /// What there must be room for: wherever the body comes as it precesses at the tilts that it has had, L, and the ground.
    fn shown(&self) -> Shown {
        let shape = Shape::of(self.run);
        let reach = shape.reach();
        let tilts = self.run.recording().whole();
        let tilts = tilts.map_or((0.0, 0.0), |whole| {
            let tilt = whole.extent(Curve::Tilt);
            (tilt.min, tilt.max)
        });
        let (first, last) = ((tilts.0 / TILT_DEG).floor(), (tilts.1 / TILT_DEG).ceil());
        // Circles about the vertical, radius and height.
        let mut circles = vec![(GROUND * reach, 0.0), (0.0, GROUND * reach)];
        for tilt in first as i32..=last as i32 {
            let (sin, cos) = (f64::from(tilt) * TILT_DEG).to_radians().sin_cos();
            for &(across, height) in &shape.corners {
                let sides = [across, -across];
                let circle =
                    |side: f64| ((height * sin + side * cos).abs(), height * cos - side * sin);
                circles.extend(sides.map(circle));
            }
        }
        let momentum = self.state().momentum;
        if let Some(axis) = momentum.try_normalize(f64::MIN_POSITIVE) {
            let angle = libm::acos(axis.z.clamp(-1.0, 1.0)).to_degrees() / (3.0 * TILT_DEG);
            for angle in [angle.floor(), angle.ceil()] {
                let (sin, cos) = (angle * 3.0 * TILT_DEG).to_radians().sin_cos();
                let length = MOMENTUM * reach;
                circles.push(((length * sin).hypot(CHANGE * reach), length * cos));
            }
        }
        let (sin, cos) = self.view.camera.pitch_deg.to_radians().sin_cos();
        let lowest = circles
            .iter()
            .map(|(radius, z)| z * cos - radius * sin.abs());
        let highest = circles
            .iter()
            .map(|(radius, z)| z * cos + radius * sin.abs());
        let (lowest, highest) = (lowest.fold(0.0, f64::min), highest.fold(0.0, f64::max));
        let widest = circles
            .iter()
            .map(|(radius, _)| *radius)
            .fold(0.0, f64::max);
        let zoom = self.view.zoom.three_d;
        let half = (
            MARGIN * widest / zoom,
            MARGIN * 0.5 * (highest - lowest) / zoom,
        );
        let middle = match zoom > 1.0 {
            true => {
                let (right, up) = self.view.camera.project(&self.wheel(&shape));
                (Zoom::middle(right, half.0), Zoom::middle(up, half.1))
            }
            false => (0.0, 0.5 * (lowest + highest)),
        };
        Shown {
            middle,
            half,
            reach,
        }
    }

    /// The middle of the wheel, or the axle's top where there is none.
    fn wheel(&self, shape: &Shape) -> Vector3<f64> {
        let height = shape.rim.map_or(shape.axle.1, |(_, height, _)| height);
        self.state().axle() * height
    }

    /// The horizontal plane of the pivot, with the directions of x and y on it, and the vertical.
    fn ground(&self, scene: &mut Scene) -> Vec<Label> {
        let length = GROUND * Shape::of(self.run).reach();
        let ink = Ink::Faint(Role::Quiet);
        let around = |part: usize| {
            let (sin, cos) = (TAU * part as f64 / PARTS as f64).sin_cos();
            Vector3::new(length * cos, length * sin, 0.0)
        };
        let circle: Vec<_> = (0..PARTS).map(around).collect();
        for pair in circle.chunks(2) {
            if let [from, to] = pair {
                scene.line(from, to, Stroke::Thin, ink);
            }
        }
        let axes = [
            ("x", Role::X, Vector3::x()),
            ("y", Role::Y, Vector3::y()),
            ("z", Role::Z, Vector3::z()),
        ];
        for (_, _, axis) in axes {
            scene.line(&Vector3::zeros(), &(axis * length), Stroke::Dotted(3), ink);
        }
        axes.map(|(name, role, axis)| (name, role, axis * length))
            .to_vec()
    }

    fn path(&self, scene: &Scene, dots: &mut Dots) {
        let mut trail = Trail::new(dots, true);
        let now = (self.state().time_s, &self.position());
        let ages = self
            .reading
            .map_or(Ages::UNKNOWN, |reading| Ages::of(&reading.readouts));
        let ages = ages.on_picture(TAU * self.run.path().radius() * scene.scale.0);
        let to_dot = |at: &Vector3<f64>| scene.dot(at);
        trail.follow(self.run.recording(), &ages, now, to_dot);
        trail.draw(dots);
        for block in self
            .run
            .overlay()
            .into_iter()
            .flat_map(|overlay: &Overlay| overlay.recording().since(0.0))
        {
            let (x, y) = scene.dot(&block.end);
            dots.set(x, y, Ink::Faint(Role::Exact));
        }
    }

    /// The axle from the pivot to its top, hub, spokes and rim, and what joins free masses to the axle.
    fn body(&self, scene: &mut Scene) {
        let shape = Shape::of(self.run);
        let state = self.state();
        let axle = state.axle();
        scene.line(
            &(axle * shape.axle.0),
            &(axle * shape.axle.1),
            Stroke::Thick,
            Ink::Strong(Role::Text),
        );
        for at in &shape.free {
            let foot = axle * at.z;
            scene.line(
                &foot,
                &(state.orientation * at),
                Stroke::Dotted(2),
                Ink::Strong(Role::Text),
            );
        }
        if let Some((radius, height, points)) = shape.rim {
            let middle = scene.depth(&(axle * height));
            let look = |depth: f64| match is_near(depth, middle, radius) {
                Some(true) => (Stroke::Thick, Ink::Strong(Role::Text)),
                None => (Stroke::Thin, Ink::Strong(Role::Text)),
                Some(false) => (Stroke::Dotted(2), Ink::Faint(Role::Quiet)),
            };
            scene.ring(&circle(state, radius, height), look);
            let hub = circle(state, HUB * radius, height);
            scene.ring(&hub, |_| (Stroke::Thin, Ink::Strong(Role::Text)));
            let every = points.div_ceil(MOST_SPOKES).max(1);
            for point in (0..points).step_by(every) {
                let at = on_circle(state, radius, height, point, points);
                let hub = on_circle(state, HUB * radius, height, point, points);
                // One of them is told from the others, so that the wheel is seen to turn.
                let stroke = match point {
                    0 => Stroke::Thin,
                    _ => Stroke::Dotted(3),
                };
                scene.line(&hub, &at, stroke, Ink::Strong(Role::Text));
            }
        }
    }

    /// The masses, the nearest last: a larger sign is nearer.
    fn masses(&self, scene: &Scene) -> Vec<(&'static str, Role, (u16, u16))> {
        let shape = Shape::of(self.run);
        let state = self.state();
        let middle = scene.depth(&self.wheel(&shape));
        let mut masses: Vec<Vector3<f64>> = Vec::new();
        let mut radius = shape.reach();
        if let Some((rim, height, points)) = shape.rim {
            radius = rim;
            // From the side the rim is at least as long as twice its width.
            let length = 4.0 * rim * scene.scale.1 / self.view.marker.dots().1 as f64;
            if length * 2.0 >= CLOSEST * points as f64 {
                masses
                    .extend((0..points).map(|point| on_circle(state, rim, height, point, points)));
            }
        }
        masses.extend(shape.free.iter().map(|at| state.orientation * at));
        masses.retain(|at| scene.shows(at));
        masses.sort_by(|a, b| scene.depth(b).total_cmp(&scene.depth(a)));
        let signs = masses.iter().map(|at| {
            let (sign, role) = match is_near(scene.depth(at), middle, radius) {
                Some(true) => ("O", Role::Heading),
                None => ("o", Role::Text),
                Some(false) => ("·", Role::Quiet),
            };
            (sign, role, scene.cell(at))
        });
        signs.collect()
    }

    /// L and Ω from the pivot, the weight at the centre of mass, its torque at the pivot, and at the tip of L where it goes.
    fn vectors(&self, scene: &mut Scene) -> Vec<Label> {
        let simulation = self.run.simulation();
        let state = self.state();
        let body = &self.run.scenario().body.mechanics;
        let reach = Shape::of(self.run).reach();
        let direction = |vector: &Vector3<f64>| vector.try_normalize(f64::MIN_POSITIVE);
        let mut labels = Vec::new();
        let mut arrow = |name, role, from: Vector3<f64>, to: Vector3<f64>| {
            scene.arrow(&from, &(from + to), Ink::Strong(role));
            labels.push((name, role, from + to * 1.04));
        };
        let pivot = Vector3::zeros();
        let weight = Vector3::z() * -simulation.loads().gravity;
        if let Some(down) = direction(&weight) {
            let centre = state.orientation * body.first_moment() / body.mass();
            arrow("g", Role::Push, centre, down * (WEIGHT * reach));
        }
        if let Some(along) = direction(&observables::angular_velocity(body, state)) {
            arrow("Ω", Role::Y, pivot, along * (OMEGA * reach));
        }
        let momentum = direction(&state.momentum).map(|along| along * (MOMENTUM * reach));
        if let Some(torque) = self.torque() {
            arrow("τ", Role::X, pivot, torque * (TORQUE * reach));
            if let Some(momentum) = momentum {
                arrow("dL", Role::X, momentum, torque * (CHANGE * reach));
            }
        }
        if let Some(momentum) = momentum {
            arrow("L", Role::Z, pivot, momentum);
        }
        labels
    }

    /// The direction of the torque of all forces about the pivot, where there is one.
    fn torque(&self) -> Option<Vector3<f64>> {
        let simulation = self.run.simulation();
        let (state, body) = (self.state(), &self.run.scenario().body.mechanics);
        let torque = loads::torque(&state.orientation, &simulation.loads().moment(body));
        let largest = simulation.loads().gravity.abs() * body.first_moment().norm();
        torque.try_normalize((NO_TORQUE * largest).max(f64::MIN_POSITIVE))
    }

    /// An arrow for each push that acts, from the pushed point along the force.
    fn pushes(&self, scene: &mut Scene) -> Vec<Label> {
        let simulation = self.run.simulation();
        let points = self.run.scenario().body.mechanics.points();
        let length = PUSH * Shape::of(self.run).reach();
        let mut labels = Vec::new();
        for push in simulation.loads().pushes.iter().take(MOST_PUSHES) {
            let from = self.state().orientation * points[push.point].at;
            if let Some(direction) = push.force.try_normalize(f64::MIN_POSITIVE) {
                let tip = from + direction * length;
                scene.arrow(&from, &tip, Ink::Strong(Role::Push));
                labels.push(("F", Role::Push, tip));
            }
        }
        labels
    }

    /// What the letters mean, in as many words as there is room for.
    fn legend(&self, area: Rect, buf: &mut Buffer) {
        let theme = &self.view.theme;
        let (torque, change) = match self.torque() {
            Some(_) => (
                ["τ torque", "τ torque", "τ"],
                ["dL where L goes", "dL", "dL"],
            ),
            None => (["no torque", "no torque", ""], ["L stays", "", ""]),
        };
        let weight = match self.run.simulation().loads().gravity == 0.0 {
            true => ["no weight", "", ""],
            false => ["g weight", "g weight", "g"],
        };
        let momentum = ["L angular momentum", "L", "L"];
        let omega = ["Ω angular velocity", "Ω", "Ω"];
        let words = [
            (momentum, Role::Z),
            (omega, Role::Y),
            (weight, Role::Push),
            (torque, Role::X),
            (change, Role::X),
        ];
        let length = |at: usize| -> usize {
            let lengths = words
                .iter()
                .map(|(words, _)| words[at])
                .filter(|word| !word.is_empty());
            lengths.map(|word| columns(word) + 2).sum()
        };
        let at = (0..3)
            .find(|&at| length(at) <= area.width as usize + 2)
            .unwrap_or(2);
        let mut x = 0;
        for (words, role) in words.iter().filter(|(words, _)| !words[at].is_empty()) {
            x = write(area, (x, 0), words[at], theme.style(*role), buf) + 2;
        }
    }
}

/// The place of `point` of `points` on a circle across the axle.
fn on_circle(state: &State, radius: f64, height: f64, point: usize, points: usize) -> Vector3<f64> {
    let (sin, cos) = (TAU * point as f64 / points as f64).sin_cos();
    state.orientation * Vector3::new(radius * cos, radius * sin, height)
}

fn circle(state: &State, radius: f64, height: f64) -> Vec<Vector3<f64>> {
    (0..PARTS)
        .map(|part| on_circle(state, radius, height, part, PARTS))
        .collect()
}
