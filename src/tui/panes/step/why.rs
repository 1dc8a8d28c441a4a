//! Why the axle goes sideways, not down: torque, dL and L from above, and the first dip magnified.

use super::super::write;
use super::numbers::{self, Format};
use super::page::{self, Section};
use crate::lab::Lab;
use crate::lab::explained::Explained;
use crate::lab::view::View;
use crate::observe::dip::Dip;
use crate::physics::loads::torque;
use crate::physics::workings::{Quantity, Value};
use crate::text::ladder::at_or_below;
use crate::text::number::shortest;
use crate::text::wrap::wrapped;
use crate::tui::dots::{Dots, Ink};
use crate::tui::theme::Role;
use nalgebra::Vector2;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

const DOWN: &str = "The forces pull down, but their torque τ = X × F is level: square to the axle. In the time dt it adds \
                        dL, along τ, to L; and the axle goes with L: sideways.";
const ANY: &str = "Each force makes a torque τ = X × F square to it. In the time dt it adds dL, along τ, to L; and the axle goes with L, \
                   not with the force.";
const RUBBED: &str = "The forces make a torque τ = X × F, and friction makes one too. In the time dt both add dL to L, which is not along τ; \
                      and the axle goes with L.";
const NONE: &str = "No torque acts: L stays as it is, and the axle circles about it.";
/// The fewest lines of a picture.
const LEAST_PICTURE: u16 = 6;
/// Lengths in the picture from above, in units of the axle as it is drawn: τ, dL, and L from the pivot.
const TORQUE: f64 = 0.75;
const CHANGE: f64 = 0.45;
const BEYOND: f64 = 1.45;
/// Arrows are at least as long as for an axle that is seen at this part of its length: from above an upright axle is a
/// point.
const LEAST_SEEN: f64 = 0.25;
/// A displacement shorter than this part of the arm is rounding error.
const ROUNDING: f64 = 1e-12;

/// Draws the page for the step at which the run of `lab` stands.
pub fn draw(lab: &Lab, area: Rect, buf: &mut Buffer) {
    let Some(explained) = lab.player().explained() else {
        return;
    };
    let view = lab.view();
    let width = usize::from(area.width);
    let mut sections = vec![Section::text(0, reason(explained), width, 0, Role::Text)];
    sections.extend(vectors(explained, width));
    let room = area.height.saturating_sub(LEAST_PICTURE);
    page::fit(&mut sections, room.into());
    page::draw(&sections, area, &view.theme, buf);
    let taken = (page::height(&sections) as u16).min(area.height);
    let below = Rect {
        y: area.y + taken,
        height: area.height - taken,
        ..area
    };
    if below.height < LEAST_PICTURE {
        return;
    }
    let left = Rect {
        width: below.width / 2,
        ..below
    };
    let right = Rect {
        x: left.right(),
        width: below.width - left.width,
        ..below
    };
    from_above(explained, view, left, buf);
    let is_seen = lab.player().reading.readouts.nutation_is_resolved() != Some(false);
    let dip_and_arm = (explained.dip(), explained.scenario.arm_m());
    dip(dip_and_arm, is_seen, view, right, buf);
}

/// What the axle does under the forces of the step, and why.
fn reason(explained: &Explained) -> &'static str {
    let Some(part) = explained.workings.parts.last() else {
        return NONE;
    };
    let loads = &part.loads;
    let is_down = |force: &nalgebra::Vector3<f64>| force.xy() == Vector2::zeros() && force.z <= 0.0;
    let (before, after) = &explained.states;
    match () {
        () if before.momentum == after.momentum => NONE,
        () if !loads.friction.is_none() => RUBBED,
        () if loads.gravity >= 0.0 && loads.pushes.iter().all(|push| is_down(&push.force)) => DOWN,
        () => ANY,
    }
}

/// The last quantity of the step that has this symbol, if it is a vector.
fn last<'a>(explained: &'a Explained, symbols: &[&str]) -> Option<&'a Quantity> {
    let quantities = explained
        .workings
        .phases()
        .flat_map(|phase| &phase.quantities);
    let wanted = |quantity: &&Quantity| {
        symbols.contains(&quantity.symbol) && matches!(quantity.value, Value::Vector(_))
    };
    quantities.rev().find(wanted)
}

/// The numbers of the step that the pictures draw.
fn vectors(explained: &Explained, width: usize) -> Vec<Section> {
    let format = Format::of_vectors(width);
    let before = Quantity::new("L", "J s", explained.states.0.momentum);
    let all = [
        (4, last(explained, &["τ"])),
        (3, Some(&before)),
        (2, last(explained, &["dL"])),
        (1, last(explained, &["new L"])),
    ];
    let section = |(rank, quantity): (u8, Option<&Quantity>)| Section {
        rank,
        lines: quantity.map_or_else(Vec::new, |quantity| {
            numbers::lines(quantity, format, rank == 1)
        }),
        ..Section::default()
    };
    std::iter::once(numbers::heads(5, format))
        .chain(all.map(section))
        .collect()
}

/// A picture of level directions, x to the right and y up, with arrows.
struct Plan {
    middle: Vector2<f64>,
    /// Dots in a metre, across and down.
    scale: (f64, f64),
    dots: Dots,
    /// Signs with the dots at which they stand.
    signs: Vec<((f64, f64), &'static str, Role)>,
}

impl Plan {
    /// Of `half` metres to each side of `middle`.
    fn new(area: Rect, view: &View, middle: Vector2<f64>, half: Vector2<f64>) -> Self {
        let dots = Dots::new(area, view.marker);
        let aspect = view.marker.dot_aspect();
        let down =
            (0.5 * dots.height() as f64 / half.y).min(0.5 * dots.width() as f64 * aspect / half.x);
        Self {
            middle,
            scale: (down / aspect, down),
            dots,
            signs: Vec::new(),
        }
    }

    fn dot(&self, at: Vector2<f64>) -> (f64, f64) {
        (
            0.5 * self.dots.width() as f64 + (at.x - self.middle.x) * self.scale.0,
            0.5 * self.dots.height() as f64 - (at.y - self.middle.y) * self.scale.1,
        )
    }

    fn line(&mut self, from: Vector2<f64>, to: Vector2<f64>, ink: Ink) {
        let (from, to) = (self.dot(from), self.dot(to));
        self.dots.line(from, to, ink);
    }

    fn sign(&mut self, at: Vector2<f64>, sign: &'static str, role: Role) {
        self.signs.push((self.dot(at), sign, role));
    }

    /// A line from one place along another, with its name at its tip.
    fn arrow(&mut self, from: Vector2<f64>, along: Vector2<f64>, name: &'static str, role: Role) {
        self.line(from, from + along, Ink::Strong(role));
        // A head of two strokes.
        let back = -along.normalize()
            * (0.16 * along.norm()).min(0.12 * self.dots.height() as f64 / self.scale.1);
        for (sin, cos) in [0.5_f64, -0.5].map(f64::sin_cos) {
            let stroke = Vector2::new(back.x * cos - back.y * sin, back.x * sin + back.y * cos);
            self.line(from + along, from + along + stroke, Ink::Strong(role));
        }
        let cell = self.dots.in_a_cell().0 as f64 / self.scale.0;
        self.sign(from + along + along.normalize() * (1.3 * cell), name, role);
    }

    fn draw(&self, area: Rect, view: &View, buf: &mut Buffer) {
        self.dots.render(&view.theme, buf);
        let (across, down) = self.dots.in_a_cell();
        for ((x, y), sign, role) in &self.signs {
            let last = area.width.saturating_sub(sign.chars().count() as u16);
            let cell = |dot: f64, dots: usize, last: u16| {
                ((dot / dots as f64).floor().max(0.0) as u16).min(last)
            };
            let place = (
                cell(*x, across, last),
                cell(*y, down, area.height.saturating_sub(1)),
            );
            write(area, place, sign, view.theme.style(*role), buf);
        }
    }
}

/// The heading of a picture on `area`, and the area below it.
fn headed(heading: &str, view: &View, area: Rect, buf: &mut Buffer) -> Rect {
    let style = view.theme.style(Role::Quiet);
    write(area, (0, 0), heading, style, buf);
    Rect {
        y: area.y + 1,
        height: area.height.saturating_sub(1),
        ..area
    }
}

/// The axle from above with L, and at its tip the weight, τ and dL.
fn from_above(explained: &Explained, view: &View, area: Rect, buf: &mut Buffer) {
    let area = headed("from above, o: top", view, area, buf);
    let (_, after) = &explained.states;
    let arm = explained.scenario.arm_m();
    let level = |vector: nalgebra::Vector3<f64>| vector.xy();
    let tip = level(after.axle()) * arm;
    let momentum = level(after.momentum);
    let Some(along) = momentum.try_normalize(1e-9 * after.momentum.norm()) else {
        write(
            area,
            (0, 0),
            "L is upright:",
            view.theme.style(Role::Text),
            buf,
        );
        write(
            area,
            (0, 1),
            "no side is sideways",
            view.theme.style(Role::Text),
            buf,
        );
        return;
    };
    if area.height < 3 || area.width < 8 {
        return;
    }
    let length = tip.norm().max(LEAST_SEEN * arm);
    let changed = after.momentum - explained.states.0.momentum;
    let rubbing = explained.workings.parts.last();
    let rubbing = rubbing.filter(|part| !part.loads.friction.is_none());
    // Of a scheme that gives no torque the change of L in the step. Under friction that is not along the torque.
    let (torque, change) = match (
        rubbing,
        last(explained, &["τ", "dL", "ΔL"]).map(|quantity| &quantity.value),
    ) {
        (Some(part), _) => {
            let moment = part.loads.moment(&explained.scenario.body.mechanics);
            (torque(&after.orientation, &moment), changed)
        }
        (None, Some(Value::Vector(torque))) => (*torque, *torque),
        (None, _) => (changed, changed),
    };
    let [torque, change] = [torque, change].map(|of| of.xy().try_normalize(f64::MIN_POSITIVE));
    // The corners of all that is drawn.
    let momentum_tip = along * (BEYOND * length);
    let mut corners = vec![Vector2::zeros(), tip, momentum_tip];
    if let Some(torque) = torque {
        corners.push(tip + torque * (TORQUE * length));
    }
    if let Some(change) = change {
        corners.push(momentum_tip + change * (CHANGE * length));
    }
    let least = corners.iter().fold(tip, |least, at| least.inf(at));
    let most = corners.iter().fold(tip, |most, at| most.sup(at));
    let half = (most - least) * 0.5;
    let half = half.map(|half| 1.3 * half + 0.05 * length);
    let mut plan = Plan::new(area, view, (least + most) * 0.5, half);
    plan.arrow(Vector2::zeros(), momentum_tip, "L", Role::Z);
    plan.line(Vector2::zeros(), tip, Ink::Strong(Role::Text));
    if let Some(torque) = torque {
        plan.arrow(tip, torque * (TORQUE * length), "τ", Role::X);
    }
    if let Some(change) = change {
        plan.arrow(momentum_tip, change * (CHANGE * length), "dL", Role::X);
    }
    plan.sign(Vector2::zeros(), "+", Role::Quiet);
    plan.sign(tip, "o", Role::Focus);
    plan.draw(area, view, buf);
}

/// The path of the axle's tip in its first dip, magnified to fill the picture.
fn dip(
    (dip, arm_m): (Option<&Dip>, f64),
    is_seen: bool,
    view: &View,
    area: Rect,
    buf: &mut Buffer,
) {
    let area = headed("first dip, magnified", view, area, buf);
    let text = |line: u16, text: &str, buf: &mut Buffer| {
        let lines = wrapped(text, area.width.into());
        for (text, y) in lines.iter().zip(line..area.height) {
            write(area, (0, y), text, view.theme.style(Role::Text), buf);
        }
    };
    let Some(dip) = dip else {
        return text(
            0,
            "the axle is upright at first: no side of it is down",
            buf,
        );
    };
    let far = dip.way_m.iter().fold(0.0_f64, |far, (side, down)| {
        far.max(side.abs()).max(down.abs())
    });
    if area.height < 4 || area.width < 8 {
        return;
    }
    if far <= ROUNDING * arm_m {
        return text(0, "it has not moved yet: . takes a step", buf);
    }
    let note = match (is_seen, dip.is_whole) {
        (false, _) => "dt is too long for the true dip: this one is dt's own",
        (true, true) => "",
        (true, false) => "so far",
    };
    let note = wrapped(note, area.width.into());
    let notes = if note.concat().is_empty() {
        0
    } else {
        note.len() as u16
    };
    let picture = Rect {
        height: area.height.saturating_sub(1 + notes),
        ..area
    };
    let at = |(side, down): &(f64, f64)| Vector2::new(*side, -down);
    let first = Vector2::zeros();
    let least = dip
        .way_m
        .iter()
        .fold(first, |least, way| least.inf(&at(way)));
    let most = dip.way_m.iter().fold(first, |most, way| most.sup(&at(way)));
    let half = ((most - least) * 0.5).map(|half| 1.15 * half + 0.1 * far);
    let mut plan = Plan::new(picture, view, (least + most) * 0.5, half);
    let ink = Ink::Strong(Role::Path);
    for pair in dip.way_m.windows(2) {
        if is_seen {
            plan.line(at(&pair[0]), at(&pair[1]), ink);
        } else {
            plan.line(at(&pair[1]), at(&pair[1]), ink);
        }
    }
    plan.sign(first, "o", Role::Focus);
    plan.draw(picture, view, buf);
    // The scale, below the picture.
    let cell_m = plan.dots.in_a_cell().0 as f64 / plan.scale.0;
    let length_m = at_or_below(0.5 * f64::from(area.width) * cell_m);
    let cells = (length_m / cell_m).round() as usize + 1;
    let bar = format!(
        "├{}┤ {} m",
        "─".repeat(cells.saturating_sub(2)),
        shortest(length_m)
    );
    let style = view.theme.style(Role::Quiet);
    write(area, (0, picture.height), &bar, style, buf);
    for (line, y) in note.iter().zip(picture.height + 1..area.height) {
        write(area, (0, y), line, view.theme.style(Role::Warning), buf);
    }
}
