//! The parts of the 3-D view that belong to the page of the step pane.
//!
//! These are the arrows of its phase, the axis of its rotation, the body before the step, and the point that is added
//! to a sum.

use super::super::step::name_of;
use super::arrows::{ArrowKind, MOMENTUM_ARROW_LENGTH, SpaceLabel, TORQUE_ARROW_LENGTH};
use super::{Scene, ink};
use crate::engine::text::nice_numbers::at_or_below;
use crate::engine::text::number::decimal;
use crate::lab::step_pane::{StepWorkings, table_of};
use crate::lab::view::{FourthStrip, HideablePart, Pane, View};
use crate::physics::State;
use crate::physics::workings::{Phase, PhaseName, WorkedValue};
use crate::tui::dots::Dashes;
use crate::tui::layered_dots::{Layer, LayeredDots, Spot};
use crate::tui::theme::Role;
use nalgebra::Vector3;

/// Length of the axis of a rotation on both sides of the pivot, in lengths of the axle.
const TURN_AXIS_LENGTH: f64 = 1.2;
/// Minimum angle between two directions that are drawn separately, rad.
const DISTINCT_DIRECTIONS_RAD: f64 = 0.03;
const POINT_DASHES: Dashes = (2, 4);

/// The phase of a step, and its arrows.
#[derive(Clone, Copy)]
pub struct StepArrows<'a> {
    explained: &'a StepWorkings,
    phase: &'a Phase,
    /// Point that was added last to the sum of the table, or chosen in it.
    point: Option<usize>,
}

impl<'a> StepArrows<'a> {
    /// Returns the phase on the page of the step pane, if that pane is visible in `view`.
    pub fn of_shown_phase(explained: Option<&'a StepWorkings>, view: &View) -> Option<Self> {
        let shown = explained.filter(|_| view.shows(Pane::Step))?;
        let (phase, ..) = shown.phase(view.look.phase)?;
        let row = view.look.sum_to.and_then(|rows| rows.checked_sub(1));
        let points = table_of(phase).map(|table| &table.points);
        Some(Self {
            explained: shown,
            phase,
            point: row
                .zip(points)
                .and_then(|(row, points)| points.get(row).copied()),
        })
    }

    /// Returns the arrows of the phase.
    fn kinds(&self) -> &'static [ArrowKind] {
        use ArrowKind::*;
        match self.phase.name {
            PhaseName::Inertia => &[],
            PhaseName::AngularVelocity => &[AngularVelocity, Momentum],
            PhaseName::Torque => &[Torque, Weight, Push],
            PhaseName::NewMomentum | PhaseName::Kick => {
                &[Momentum, ChangeOfMomentum, NewMomentum, Weight]
            }
            PhaseName::FreeMotion | PhaseName::Friction => &[Momentum],
            name if name.is_slope() => &[AngularVelocity, Torque],
            _ => &[TurnAxis],
        }
    }

    /// Returns true if the body before the step is drawn too.
    pub fn has_before(&self) -> bool {
        match self.phase.name {
            PhaseName::AngularVelocity
            | PhaseName::AxisAndAngle
            | PhaseName::Torque
            | PhaseName::NewMomentum
            | PhaseName::Kick
            | PhaseName::Friction => false,
            name => !name.is_slope(),
        }
    }

    /// Returns the last vector with this `symbol` in the step up to this phase.
    fn vector(&self, symbol: &str) -> Option<Vector3<f64>> {
        let phases = self
            .explained
            .workings
            .phases()
            .rev()
            .skip_while(|phase| !std::ptr::eq(*phase, self.phase));
        let mut quantities = phases.flat_map(|phase| phase.quantities.iter().rev());
        let found = quantities.find(|quantity| quantity.symbol == symbol)?;
        match found.value {
            WorkedValue::Vector(vector) => Some(vector),
            _ => None,
        }
    }

    pub fn direction(&self, symbol: &str) -> Option<Vector3<f64>> {
        self.vector(symbol)?.try_normalize(f64::MIN_POSITIVE)
    }

    fn before(&self) -> &State {
        &self.explained.states.0
    }
}

impl Scene<'_> {
    /// Returns true if arrows of this kind are drawn.
    ///
    /// While the step pane is visible, these are the arrows of its phase. While a strip shows the force of the floor,
    /// these are the forces.
    pub(super) fn draws(&self, kind: ArrowKind) -> bool {
        let kinds = match &self.phase {
            Some(shown) => shown.kinds(),
            None if self.seen.view.hides(HideablePart::Arrows) => &[],
            None if self.shows_floor_force() => ArrowKind::FORCES,
            None => ArrowKind::USUAL,
        };
        kinds.contains(&kind)
    }

    /// Returns true if a strip shows the force of the floor on the foot.
    pub(super) fn shows_floor_force(&self) -> bool {
        self.seen.view.look.detail_of == FourthStrip::Column("foot_force_N")
    }

    /// Draws the axis of the rotation, the body before it, and the chosen point. Returns their labels.
    pub(super) fn phase_marks(&self, dots: &mut LayeredDots) -> Vec<SpaceLabel> {
        let mut labels = Vec::new();
        let Some(shown) = &self.phase else {
            return labels;
        };
        let axis = shown
            .direction("u")
            .filter(|_| self.draws(ArrowKind::TurnAxis));
        if let Some(axis) = axis {
            let end = axis * (TURN_AXIS_LENGTH * self.arm);
            let (from, to) = (self.dot(&-end), self.dot(&end));
            dots.line(from, to, ink(Role::AngularVelocity, Layer::Shaft));
            let kind = ArrowKind::TurnAxis;
            labels.push(SpaceLabel::beside(kind.label(), kind.role(), to));
        }
        if shown.has_before() {
            self.body_before(shown.before(), dots);
        }
        let scenario = self.seen.run.scenario();
        let points = scenario.body.mechanics.points();
        let chosen = shown.point.filter(|index| *index < points.len());
        if let Some(index) = chosen {
            let before = shown.before().orientation * points[index].at;
            let (from, to) = match shown.phase.name {
                PhaseName::Inertia | PhaseName::Torque => {
                    (Vector3::zeros(), self.state.orientation * points[index].at)
                }
                _ => (before, self.state.orientation * points[index].at),
            };
            let (from, to) = (self.dot(&from), self.dot(&to));
            dots.path(
                [from, to].into_iter(),
                Some(POINT_DASHES),
                f64::INFINITY,
                ink(Role::Text, Layer::Shaft),
            );
            dots.spot(to, Spot::Five, ink(Role::Text, Layer::Start));
            labels.push(SpaceLabel::beside(
                &name_of(scenario, index),
                Role::Heading,
                to,
            ));
        }
        labels
    }

    /// Returns the direction of the new L, if the phase computes one that visibly differs from the old one.
    pub(super) fn new_momentum(&self) -> Option<Vector3<f64>> {
        let shown = self.phase.as_ref()?;
        let (old, new) = (shown.direction("L")?, shown.direction("new L")?);
        Some(new).filter(|new| (new - old).norm() > DISTINCT_DIRECTIONS_RAD)
    }

    /// Returns the drawn dL, in lengths of the axle, and its stretch relative to L.
    fn stretched_change(&self) -> Option<(Vector3<f64>, f64)> {
        let shown = self
            .phase
            .as_ref()
            .filter(|_| self.draws(ArrowKind::ChangeOfMomentum))?;
        let change = shown.vector("dL")?;
        let momentum = shown.vector("L").unwrap_or(shown.before().momentum).norm();
        let share = change * (MOMENTUM_ARROW_LENGTH / momentum);
        let stretch = at_or_below(TORQUE_ARROW_LENGTH / share.norm());
        (share.norm() > 0.0 && stretch.is_finite()).then(|| (share * stretch, stretch))
    }

    /// Returns the drawn change of L, in lengths of the axle. If the phase does not compute it, only its direction is
    /// right.
    pub(super) fn drawn_change(&self) -> Option<Vector3<f64>> {
        if !self.draws(ArrowKind::ChangeOfMomentum) {
            return None;
        }
        let stretched = self.stretched_change().map(|(change, _)| change);
        stretched.or(self.change.map(|change| change * TORQUE_ARROW_LENGTH))
    }

    /// Returns the text that states by which factor dL is stretched relative to L.
    pub(super) fn change_stretch_text(&self) -> Option<String> {
        let (_, stretch) = self.stretched_change()?;
        (stretch != 1.0).then(|| format!("dL {} × as long", decimal(stretch)))
    }
}
