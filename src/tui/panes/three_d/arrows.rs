//! The arrows of the 3-D view, their letters, and the legend. While the step pane is visible, only the arrows of its
//! phase are drawn.

use super::super::{MOST_SHOWN_PUSHES, write};
use super::body::normal;
use super::phase::StepArrows;
use super::{LEGEND_WORD_GAP, Scene, cell_of};
use crate::engine::text::number::significant;
use crate::engine::text::wrap::columns;
use crate::lab::view::theme::Theme;
use crate::physics::observables;
use crate::tui::labels::{AROUND_MARK, AROUND_POINT, LabelOffset, Labels};
use crate::tui::layered_dots::{FineDot, LayeredDots};
use crate::tui::theme::Role;
use nalgebra::Vector3;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

/// Lengths of the arrows, in lengths of the axle.
///
/// Only their directions have a meaning. The angular velocity is shorter, so that its head is away from the axle's top,
/// where L and the path are.
pub const MOMENTUM_ARROW_LENGTH: f64 = 1.12;
pub const TORQUE_ARROW_LENGTH: f64 = 0.42;
const OMEGA_ARROW_LENGTH: f64 = 0.62;
const WEIGHT_ARROW_LENGTH: f64 = 0.5;
const PUSH_ARROW_LENGTH: f64 = 0.42;
/// Minimum length of a torque that is drawn, in lengths of the axle.
const LEAST_TORQUE_ARROW: f64 = 0.05;

/// Fine dots between the axle and an arrow next to it: in small and in large pictures.
const SHIFT_DOTS: f64 = 5.0;
const LARGE_SHIFT_DOTS: f64 = 6.0;
/// Factor of L's distance from the axle if both arrows are on one side.
const OUTER_SHIFT: f64 = 1.9;
/// Minimum angle on the screen between an arrow and the axle for the arrow to be on a side of it, rad.
const SIDE_RAD: f64 = 0.06;
const HEAD_DOTS: f64 = 5.0;
const LARGE_HEAD_DOTS: f64 = 7.0;
/// Distances of a letter from the tip of its arrow, fine dots, best first.
const LETTER_DOTS: [f64; 6] = [4.0, 5.0, 6.0, 3.0, 7.0, 8.0];

/// Kind of an arrow in the 3-D view.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ArrowKind {
    Momentum,
    NewMomentum,
    AngularVelocity,
    Torque,
    ChangeOfMomentum,
    Weight,
    Floor,
    Push,
    TurnAxis,
}

impl ArrowKind {
    /// Arrows that are drawn without the step pane.
    pub const USUAL: &[Self] = &[
        Self::Momentum,
        Self::AngularVelocity,
        Self::Torque,
        Self::Push,
    ];

    /// Arrows of forces.
    pub const FORCES: &[Self] = &[Self::Weight, Self::Floor, Self::Push];

    pub fn label(self) -> &'static str {
        match self {
            Self::Momentum => "L",
            Self::NewMomentum => "new L",
            Self::AngularVelocity => "Ω",
            Self::Torque => "τ",
            Self::ChangeOfMomentum => "dL",
            Self::Weight => "weight",
            Self::Floor => "floor",
            Self::Push => "F",
            Self::TurnAxis => "u",
        }
    }

    pub fn role(self) -> Role {
        match self {
            Self::Momentum | Self::NewMomentum => Role::AngularMomentum,
            Self::AngularVelocity | Self::TurnAxis => Role::AngularVelocity,
            Self::Torque | Self::ChangeOfMomentum => Role::Torque,
            Self::Weight | Self::Floor | Self::Push => Role::Push,
        }
    }
}

/// A label of the 3-D view with its position.
pub struct SpaceLabel {
    text: String,
    role: Role,
    at: FineDot,
    /// Direction of the arrow that ends at `at`, on the sheet; `None` if the label belongs to no arrow.
    along: Option<FineDot>,
}

impl SpaceLabel {
    pub fn beside(text: &str, role: Role, at: FineDot) -> Self {
        Self {
            text: text.to_owned(),
            role,
            at,
            along: None,
        }
    }

    /// Moves the label next to an arrowhead of `head_dots` fine dots, because another arrow begins at its tip.
    fn beside_head(self, head_dots: f64) -> Self {
        let (x, y) = self.along.unwrap_or((0.0, 0.0));
        let half = 0.5 * head_dots;
        Self {
            at: (self.at.0 - x * half, self.at.1 - y * half),
            along: None,
            ..self
        }
    }

    /// Writes the label in front of the arrow's head, or else at a free position near it.
    pub fn place(&self, labels: &mut Labels<'_>, theme: &Theme) {
        let style = theme.style(self.role).bold();
        let Some(along) = self.along else {
            labels.place(cell_of(self.at), AROUND_MARK, &self.text, style);
            return;
        };
        let offset = if along.0 < 0.0 {
            LabelOffset::Left(0, 0)
        } else {
            LabelOffset::Right(0, 0)
        };
        let is_placed = LETTER_DOTS.iter().any(|dots| {
            let at = (self.at.0 + along.0 * dots, self.at.1 + along.1 * dots);
            labels.place(cell_of(at), &[offset], &self.text, style)
        });
        if !is_placed {
            let around = [AROUND_POINT, AROUND_MARK].concat();
            labels.place(cell_of(self.at), &around, &self.text, style);
        }
    }
}

/// Distances of the arrows of L and of the angular velocity from the axle, fine dots. Positive: on the side of the
/// axle's normal.
struct ArrowShifts {
    axle_normal: FineDot,
    momentum: f64,
    omega: f64,
}

impl Scene<'_> {
    /// Draws the arrows. Returns their letters, the most important first.
    pub(super) fn draw_arrows(&self, dots: &mut LayeredDots) -> Vec<SpaceLabel> {
        let shifts = self.shifts();
        let pivot = Vector3::zeros();
        let mut labels = Vec::new();
        let mut momentum_tip = self.dot(&pivot);
        let at_momentum = self.arrows_at_momentum();
        for kind in [ArrowKind::Momentum, ArrowKind::NewMomentum] {
            if let Some(along) = self.along(kind) {
                let tip = along * (MOMENTUM_ARROW_LENGTH * self.arm);
                let ends = self.shifted(&pivot, &tip, shifts.momentum, &shifts);
                let mut label = self.arrow(kind, ends, dots);
                if kind == ArrowKind::Momentum {
                    momentum_tip = ends[1];
                    if !at_momentum.is_empty() {
                        label = label.beside_head(self.head_dots());
                    }
                }
                labels.push(label);
            }
        }
        if let Some(along) = self.along(ArrowKind::AngularVelocity) {
            let tip = along * (OMEGA_ARROW_LENGTH * self.arm);
            let ends = self.shifted(&pivot, &tip, shifts.omega, &shifts);
            labels.push(self.arrow(ArrowKind::AngularVelocity, ends, dots));
        }
        for (kind, vector) in at_momentum {
            let (begin, end) = (self.dot(&pivot), self.dot(&(vector * self.arm)));
            let tip = (
                momentum_tip.0 + end.0 - begin.0,
                momentum_tip.1 + end.1 - begin.1,
            );
            labels.push(self.arrow(kind, [momentum_tip, tip], dots));
        }
        for (kind, from, along) in self.forces() {
            let ends = [self.dot(&from), self.dot(&(from + along * self.arm))];
            labels.push(self.arrow(kind, ends, dots));
        }
        labels
    }

    /// Returns the arrows that begin at the tip of L, in lengths of the axle: the torque, and the change of L.
    fn arrows_at_momentum(&self) -> Vec<(ArrowKind, Vector3<f64>)> {
        let torque = self.along(ArrowKind::Torque);
        let torque = torque.map(|share| share * TORQUE_ARROW_LENGTH);
        let of_torque = torque.filter(|torque| torque.norm() > LEAST_TORQUE_ARROW);
        let change = self.drawn_change();
        [
            of_torque.map(|vector| (ArrowKind::Torque, vector)),
            change.map(|vector| (ArrowKind::ChangeOfMomentum, vector)),
        ]
        .into_iter()
        .flatten()
        .collect()
    }

    fn head_dots(&self) -> f64 {
        if self.is_large() {
            LARGE_HEAD_DOTS
        } else {
            HEAD_DOTS
        }
    }

    fn arrow(&self, kind: ArrowKind, ends: [FineDot; 2], dots: &mut LayeredDots) -> SpaceLabel {
        let [from, tip] = ends;
        dots.arrow(from, tip, self.head_dots(), kind.role());
        let (dx, dy) = (tip.0 - from.0, tip.1 - from.1);
        let length = libm::hypot(dx, dy).max(1.0);
        SpaceLabel {
            along: Some((dx / length, dy / length)),
            ..SpaceLabel::beside(kind.label(), kind.role(), tip)
        }
    }

    /// Returns the vertical force of the floor on the foot, N.
    fn floor_force(&self) -> f64 {
        let simulation = self.seen.run.simulation();
        let body = &self.seen.run.scenario().body.mechanics;
        observables::pivot_force_z(body, self.state, simulation.loads())
    }

    /// Returns the weight, the force of the floor, and the acting pushes.
    ///
    /// Each has its origin (m) and its vector in lengths of the axle. If the force of the floor is drawn, lengths are
    /// proportional to forces.
    fn forces(&self) -> Vec<(ArrowKind, Vector3<f64>, Vector3<f64>)> {
        let loads = self.seen.run.simulation().loads();
        let body = &self.seen.run.scenario().body.mechanics;
        let weight = body.mass() * loads.gravity.abs();
        let in_proportion = |force: f64| (WEIGHT_ARROW_LENGTH * force / weight).clamp(-1.0, 1.0);
        let mut forces = Vec::new();
        let shows_floor = self.draws(ArrowKind::Floor) && weight > 0.0;
        if shows_floor {
            let up = Vector3::z() * in_proportion(self.floor_force());
            forces.push((ArrowKind::Floor, Vector3::zeros(), up));
        }
        if self.draws(ArrowKind::Weight) && loads.gravity != 0.0 {
            let center = self.state.orientation * body.first_moment() / body.mass();
            let down = Vector3::z() * (-WEIGHT_ARROW_LENGTH * loads.gravity.signum());
            forces.push((ArrowKind::Weight, center, down));
        }
        if self.draws(ArrowKind::Push) {
            for push in loads.pushes.iter().take(MOST_SHOWN_PUSHES) {
                let from = self.state.orientation * body.points()[push.point].at;
                let length = if shows_floor {
                    in_proportion(push.force.norm())
                } else {
                    PUSH_ARROW_LENGTH
                };
                let direction = push.force.try_normalize(f64::MIN_POSITIVE);
                let along = direction.map(|direction| direction * length);
                forces.extend(along.map(|along| (ArrowKind::Push, from, along)));
            }
        }
        forces
    }

    /// Returns the direction of an arrow, or for the torque its fraction of the full length; `None` if it is not drawn.
    fn along(&self, kind: ArrowKind) -> Option<Vector3<f64>> {
        if !self.draws(kind) {
            return None;
        }
        let body = &self.seen.run.scenario().body.mechanics;
        let now = match kind {
            ArrowKind::Momentum => Some(self.state.momentum),
            ArrowKind::AngularVelocity => Some(observables::angular_velocity(body, self.state)),
            ArrowKind::Torque => self.torque,
            ArrowKind::NewMomentum => return self.new_momentum(),
            ArrowKind::ChangeOfMomentum
            | ArrowKind::Weight
            | ArrowKind::Floor
            | ArrowKind::Push
            | ArrowKind::TurnAxis => None,
        };
        let shown = self.phase.as_ref();
        let worked = shown.and_then(|shown| shown.direction(kind.label()));
        let own = match kind {
            ArrowKind::Torque => now,
            _ => now.and_then(|now| now.try_normalize(f64::MIN_POSITIVE)),
        };
        worked.or(own)
    }

    fn shifts(&self) -> ArrowShifts {
        let pivot = self.dot(&Vector3::zeros());
        let top = self.dot(&(self.state.axle() * self.arm));
        let axle_normal = normal(pivot, top);
        // Sine of the angle from the axle to a direction, on the sheet.
        let aside = |along: Option<Vector3<f64>>| {
            let (x, y) = self.dot(&(along? * self.arm));
            let (dx, dy) = (x - pivot.0, y - pivot.1);
            let across = dx * axle_normal.0 + dy * axle_normal.1;
            Some(across / libm::hypot(dx, dy).max(1.0))
        };
        let momentum = aside(self.along(ArrowKind::Momentum)).unwrap_or(0.0);
        let side = if momentum < -SIDE_RAD { -1.0 } else { 1.0 };
        let omega = aside(self.along(ArrowKind::AngularVelocity));
        let omega_side = match omega {
            Some(omega) if omega.abs() >= SIDE_RAD => omega.signum(),
            _ => -side,
        };
        let shift = if self.is_large() {
            LARGE_SHIFT_DOTS
        } else {
            SHIFT_DOTS
        };
        let is_outer = omega.is_some() && omega_side == side;
        ArrowShifts {
            axle_normal,
            momentum: side * shift * if is_outer { OUTER_SHIFT } else { 1.0 },
            omega: omega_side * shift,
        }
    }

    /// Returns the ends of an arrow on the sheet, shifted sideways by `shift` to a side of the axle.
    fn shifted(
        &self,
        from: &Vector3<f64>,
        tip: &Vector3<f64>,
        shift: f64,
        shifts: &ArrowShifts,
    ) -> [FineDot; 2] {
        let ends = [self.dot(from), self.dot(tip)];
        let (x, y) = normal(ends[0], ends[1]);
        let is_turned = x * shifts.axle_normal.0 + y * shifts.axle_normal.1 < 0.0;
        let shift = if is_turned { -shift } else { shift };
        ends.map(|end| (end.0 + x * shift, end.1 + y * shift))
    }

    /// Draws the legend with as many words as fit.
    pub(super) fn legend(&self, area: Rect, buf: &mut Buffer) {
        let theme = &self.seen.view.theme;
        let mut words = self.legend_words();
        while legend_columns(&words) > area.width.into() {
            words.pop();
        }
        let mut x = 0;
        for (letter, meaning, role) in words {
            if !letter.is_empty() {
                x = write(area, (x, 0), letter, theme.style(role).bold(), buf) + 1;
            }
            x = write(area, (x, 0), &meaning, theme.style(Role::Label), buf) + LEGEND_WORD_GAP;
        }
    }

    /// Returns each letter with its meaning and its role.
    fn legend_words(&self) -> Vec<(&'static str, String, Role)> {
        let loads = self.seen.run.simulation().loads();
        let kinds = [
            ArrowKind::Momentum,
            ArrowKind::AngularVelocity,
            ArrowKind::Torque,
            ArrowKind::ChangeOfMomentum,
            ArrowKind::Weight,
            ArrowKind::Floor,
            ArrowKind::Push,
            ArrowKind::TurnAxis,
        ];
        let mut words = Vec::new();
        for kind in kinds.into_iter().filter(|kind| self.draws(*kind)) {
            let meaning = match kind {
                ArrowKind::Momentum | ArrowKind::NewMomentum => "angular momentum".to_owned(),
                ArrowKind::AngularVelocity => "angular velocity".to_owned(),
                ArrowKind::Torque if self.torque.is_none() => {
                    words.push(("", "no torque".to_owned(), Role::Label));
                    continue;
                }
                ArrowKind::Torque => "torque".to_owned(),
                ArrowKind::ChangeOfMomentum if !loads.friction.is_none() => {
                    "with friction".to_owned()
                }
                ArrowKind::ChangeOfMomentum => "= dt τ".to_owned(),
                ArrowKind::Weight => {
                    let mass = self.seen.run.scenario().body.mechanics.mass();
                    format!("{} N", significant(mass * loads.gravity.abs(), 3))
                }
                ArrowKind::Floor => format!("{} N", significant(self.floor_force(), 3)),
                ArrowKind::Push if loads.pushes.is_empty() => continue,
                ArrowKind::Push => "push".to_owned(),
                ArrowKind::TurnAxis => "axis of rotation".to_owned(),
            };
            words.push((kind.label(), meaning, kind.role()));
        }
        let has_before = self.phase.as_ref().is_some_and(StepArrows::has_before);
        if has_before {
            words.push(("", "gray: before the step".to_owned(), Role::Label));
        }
        words
    }
}

/// Returns the columns of a legend of these letters and meanings.
fn legend_columns(words: &[(&str, String, Role)]) -> usize {
    let gap = usize::from(LEGEND_WORD_GAP);
    let each = words
        .iter()
        .map(|(letter, meaning, _)| columns(letter) + 1 + columns(meaning) + gap);
    each.sum::<usize>().saturating_sub(gap)
}
