//! The page that explains why the axle goes sideways, not down: torque, dL and L from above, and the first dip
//! magnified.

use super::super::write;
use super::numbers::{self, CellFormat};
use super::page::{self, StepPageSection};
use crate::engine::text::wrap::wrapped;
use crate::lab::Lab;
use crate::lab::step_pane::StepWorkings;
use crate::lab::view::View;
use crate::lab::view::theme::Marker;
use crate::physics::loads::torque;
use crate::physics::workings::{WorkedQuantity, WorkedValue};
use crate::tui::layered_dots::{DotInk, Layer, LayeredDots};
use crate::tui::plane::Plane;
use crate::tui::split::{split_columns, split_rows};
use crate::tui::theme::Role;
use nalgebra::Vector2;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

const DOWNWARD_FORCES_TEXT: &str = "The forces pull down, but their torque τ = X × F is level: square to the axle. In the time dt it adds \
                        dL, along τ, to L; and the axle goes with L: sideways.";
const ANY: &str = "Each force makes a torque τ = X × F square to it. In the time dt it adds dL, along τ, to L; and the axle goes with L, \
                   not with the force.";
const FRICTION_TORQUE_TEXT: &str = "The forces make a torque τ = X × F, and friction makes one too. In the time dt both add dL to L, which is not along τ; \
                      and the axle goes with L.";
const NO_TORQUE_TEXT: &str = "No torque acts. L stays constant, and the axle circles about it.";
const UPRIGHT_TEXT: [&str; 2] = ["L is upright:", "no side is sideways"];
/// Minimum lines of a picture.
const LEAST_PICTURE: u16 = 6;
/// Lengths in the picture from above, in units of the drawn axle: τ, dL, and L from the pivot.
const TORQUE_ARROW_LENGTH: f64 = 0.75;
const CHANGE_ARROW_LENGTH: f64 = 0.45;
const BEYOND: f64 = 1.45;
/// Minimum length of the arrows' unit, as a fraction of the axle's true length. Seen from above, an upright axle is a
/// point.
const LEAST_AXLE_SEEN: f64 = 0.25;
/// Displacements shorter than this fraction of the arm are rounding errors.
const DISPLACEMENT_ROUNDING: f64 = 1e-12;

pub fn draw(lab: &Lab, area: Rect, buf: &mut Buffer) {
    let Some(explained) = lab.step_pane().shown() else {
        return;
    };
    let view = lab.view();
    let width = usize::from(area.width);
    let mut sections = vec![StepPageSection::text(
        0,
        reason(explained),
        width,
        0,
        Role::Text,
    )];
    sections.extend(vectors(explained, width));
    let room = area.height.saturating_sub(LEAST_PICTURE);
    page::fit(&mut sections, room.into());
    page::draw(&sections, area, &view.theme, buf);
    let used_rows = (page::height(&sections) as u16).min(area.height);
    let [_, below] = split_rows(area, used_rows);
    if below.height < LEAST_PICTURE {
        return;
    }
    let [left, right] = split_columns(below, below.width / 2);
    from_above(explained, view, left, buf);
    let is_seen = lab.player().reading.readouts.nutation_is_resolved() != Some(false);
    dip(explained, is_seen, view, right, buf);
}

fn reason(explained: &StepWorkings) -> &'static str {
    let (before, after) = &explained.states;
    let parts = &explained.workings.parts;
    let Some(part) = parts.last().filter(|_| before.momentum != after.momentum) else {
        return NO_TORQUE_TEXT;
    };
    let loads = &part.loads;
    let mut forces = loads.pushes.iter().map(|push| push.force);
    let are_down = forces.all(|force| force.xy() == Vector2::zeros() && force.z <= 0.0);
    if !loads.friction.is_none() {
        FRICTION_TORQUE_TEXT
    } else if loads.gravity >= 0.0 && are_down {
        DOWNWARD_FORCES_TEXT
    } else {
        ANY
    }
}

/// Returns the last vector quantity of the step with one of these symbols.
fn last<'a>(explained: &'a StepWorkings, symbols: &[&str]) -> Option<&'a WorkedQuantity> {
    let quantities = explained
        .workings
        .phases()
        .flat_map(|phase| &phase.quantities);
    quantities.rev().find(|quantity| {
        symbols.contains(&quantity.symbol) && matches!(quantity.value, WorkedValue::Vector(_))
    })
}

/// Returns the numbers of the step that the pictures draw.
fn vectors(explained: &StepWorkings, width: usize) -> Vec<StepPageSection> {
    let format = CellFormat::of_vectors(width);
    let before = WorkedQuantity::new("L", "J s", explained.states.0.momentum);
    let all = [
        (4, last(explained, &["τ"])),
        (3, Some(&before)),
        (2, last(explained, &["dL"])),
        (1, last(explained, &["new L"])),
    ];
    std::iter::once(numbers::heads(5, format))
        .chain(all.map(|(rank, quantity)| {
            let lines = quantity.map(|quantity| numbers::lines(quantity, format, rank == 1));
            StepPageSection::new(rank, lines.unwrap_or_default())
        }))
        .collect()
}

/// Length of an arrow's head, fine dots.
const HEAD_DOTS: f64 = 5.0;

/// A picture of horizontal directions with arrows, x to the right and y up.
struct ArrowDiagram {
    plane: Plane,
    dots: LayeredDots,
    signs: Vec<((u16, u16), &'static str, Role)>,
}

impl ArrowDiagram {
    /// Creates a diagram of everything between `least` and `most`. `margin` enlarges the half size, m.
    fn new(
        area: Rect,
        view: &View,
        (least, most): (Vector2<f64>, Vector2<f64>),
        margin: impl Fn(f64) -> f64,
    ) -> Self {
        let (middle, half) = ((least + most) * 0.5, ((most - least) * 0.5).map(margin));
        Self {
            plane: Plane::new(
                area,
                Marker::Braille,
                (middle.x, middle.y),
                (half.x, half.y),
            ),
            dots: LayeredDots::new(area, view.marker),
            signs: Vec::new(),
        }
    }

    fn dot(&self, at: Vector2<f64>) -> (f64, f64) {
        self.plane.dot((at.x, at.y))
    }

    fn line(&mut self, from: Vector2<f64>, to: Vector2<f64>, role: Role) {
        let (from, to) = (self.dot(from), self.dot(to));
        let ink = DotInk {
            role,
            layer: Layer::Shaft,
        };
        self.dots.line(from, to, ink);
    }

    fn sign(&mut self, at: Vector2<f64>, sign: &'static str, role: Role) {
        self.signs.push((self.plane.cell((at.x, at.y)), sign, role));
    }

    /// Draws an arrow from a point, with its name at its tip.
    fn arrow(&mut self, from: Vector2<f64>, along: Vector2<f64>, name: &'static str, role: Role) {
        let tip = from + along;
        let (begin, end) = (self.dot(from), self.dot(tip));
        self.dots.arrow(begin, end, HEAD_DOTS, role);
        let plane = self.plane;
        let cell = plane.in_cell.0 as f64 / plane.scale.0;
        self.sign(tip + along.normalize() * (1.3 * cell), name, role);
    }

    fn draw(&self, area: Rect, view: &View, buf: &mut Buffer) {
        self.dots.render(&view.theme, buf);
        for &((x, y), sign, role) in &self.signs {
            let last = area.width.saturating_sub(sign.chars().count() as u16);
            write(area, (x.min(last), y), sign, view.theme.style(role), buf);
        }
    }
}

fn with_heading(heading: &str, view: &View, area: Rect, buf: &mut Buffer) -> Rect {
    let [heading_line, below] = split_rows(area, 1);
    let style = view.theme.style(Role::Label);
    write(heading_line, (0, 0), heading, style, buf);
    below
}

fn text(text: &str, role: Role, view: &View, area: Rect, buf: &mut Buffer) {
    let lines = wrapped(text, area.width.into());
    for (line, y) in lines.iter().zip(0..area.height) {
        write(area, (0, y), line, view.theme.style(role), buf);
    }
}

/// Returns the directions of the torque and of the change of L in the picture from above, if any.
///
/// For a scheme that computes no torque, both are the change of L in the step. With friction, the two differ.
fn torque_and_change(explained: &StepWorkings) -> [Option<Vector2<f64>>; 2] {
    let (before, after) = &explained.states;
    let changed = after.momentum - before.momentum;
    let last_part = explained.workings.parts.last();
    let rubbing = last_part.filter(|part| !part.loads.friction.is_none());
    let given = last(explained, &["τ", "dL", "ΔL"]).map(|quantity| &quantity.value);
    let both = match (rubbing, given) {
        (Some(part), _) => {
            let moment = part.loads.moment(&explained.scenario.body.mechanics);
            [torque(&after.orientation, &moment), changed]
        }
        (None, Some(WorkedValue::Vector(torque))) => [*torque, *torque],
        (None, _) => [changed, changed],
    };
    both.map(|vector| vector.xy().try_normalize(f64::MIN_POSITIVE))
}

/// Draws the axle and L from above, with τ at the tip of the axle and dL at the tip of L.
fn from_above(explained: &StepWorkings, view: &View, area: Rect, buf: &mut Buffer) {
    let area = with_heading("from above, o: top", view, area, buf);
    let (_, after) = &explained.states;
    let arm = explained.scenario.arm_m();
    let tip = after.axle().xy() * arm;
    let momentum = after.momentum.xy();
    let Some(along) = momentum.try_normalize(1e-9 * after.momentum.norm()) else {
        for (line, y) in UPRIGHT_TEXT.iter().zip(0..) {
            write(area, (0, y), line, view.theme.style(Role::Text), buf);
        }
        return;
    };
    if area.height < 3 || area.width < 8 {
        return;
    }
    let length = tip.norm().max(LEAST_AXLE_SEEN * arm);
    let [torque, change] = torque_and_change(explained);
    let momentum_tip = along * (BEYOND * length);
    let origin = Vector2::zeros();
    let mut arrows = vec![(origin, momentum_tip, "L", Role::AngularMomentum)];
    arrows.extend(torque.map(|torque| {
        (
            tip,
            torque * (TORQUE_ARROW_LENGTH * length),
            "τ",
            Role::Torque,
        )
    }));
    let change_arrow = change.map(|change| change * (CHANGE_ARROW_LENGTH * length));
    arrows.extend(change_arrow.map(|arrow| (momentum_tip, arrow, "dL", Role::Torque)));
    let corners: Vec<_> = arrows
        .iter()
        .map(|(from, arrow, ..)| from + arrow)
        .chain([tip])
        .collect();
    let mut picture = ArrowDiagram::new(area, view, around(&corners), |half| {
        1.3 * half + 0.05 * length
    });
    for (from, arrow, name, role) in arrows {
        picture.arrow(from, arrow, name, role);
        if name == "L" {
            picture.line(origin, tip, Role::Text);
        }
    }
    picture.sign(origin, "+", Role::Label);
    picture.sign(tip, "o", Role::Heading);
    picture.draw(area, view, buf);
}

/// Draws the path of the axle's tip in its first dip, magnified to fill the picture.
fn dip(explained: &StepWorkings, is_seen: bool, view: &View, area: Rect, buf: &mut Buffer) {
    let area = with_heading("first dip, magnified", view, area, buf);
    let Some(dip) = &explained.dip else {
        let upright = "the axle starts upright: it cannot dip to a side";
        return text(upright, Role::Text, view, area, buf);
    };
    if area.height < 4 || area.width < 8 {
        return;
    }
    let path: Vec<_> = dip
        .way_m
        .iter()
        .map(|(side, down)| Vector2::new(*side, -down))
        .collect();
    let far = path.iter().fold(0.0_f64, |far, at| far.max(at.amax()));
    if far <= DISPLACEMENT_ROUNDING * explained.scenario.arm_m() {
        let still = "no motion yet; press . to take a step";
        return text(still, Role::Text, view, area, buf);
    }
    let note = match (is_seen, dip.is_whole) {
        (false, _) => "dt is too long: this dip comes from the time step",
        (true, true) => "",
        (true, false) => "so far",
    };
    let mut notes = wrapped(note, area.width.into());
    notes.retain(|line| !line.is_empty());
    let [place, below] = split_rows(area, area.height.saturating_sub(1 + notes.len() as u16));
    let mut picture = ArrowDiagram::new(place, view, around(&path), |half| 1.15 * half + 0.1 * far);
    for pair in path.windows(2) {
        // Steps too long for the true dip are not joined.
        let from = if is_seen { pair[0] } else { pair[1] };
        picture.line(from, pair[1], Role::Run);
    }
    picture.sign(Vector2::zeros(), "o", Role::Heading);
    picture.draw(place, view, buf);
    let [scale, below] = split_rows(below, 1);
    let bar = picture.plane.bar(0.5 * f64::from(area.width));
    write(scale, (0, 0), &bar, view.theme.style(Role::Label), buf);
    text(note, Role::Off, view, below, buf);
}

/// Returns the corners of a rectangle around `places` and the origin.
fn around(places: &[Vector2<f64>]) -> (Vector2<f64>, Vector2<f64>) {
    let origin = Vector2::zeros();
    let least = places.iter().fold(origin, |least, at| least.inf(at));
    let most = places.iter().fold(origin, |most, at| most.sup(at));
    (least, most)
}
