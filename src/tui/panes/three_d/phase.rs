//! The phase of the step pane in the scene: only the arrows that it is about, the axis of its turn, and the body as it
//! stood before the step.

use super::body::Sign;
use super::{Label, MOMENTUM, Subject};
use crate::lab::explained::{Explained, table_of};
use crate::lab::view::View;
use crate::physics::State;
use crate::physics::workings::{Phase, Value};
use crate::tui::dots::Ink;
use crate::tui::scene::{Scene, Stroke};
use crate::tui::theme::Role;
use nalgebra::Vector3;

/// How far the axis of a turn goes beyond the body on both sides, as a share of its size.
const AXIS: f64 = 1.0;
/// Directions that differ by less than this, rad, are drawn as one.
const SEEN: f64 = 0.03;

#[derive(Clone, Copy)]
pub struct Shown<'a> {
    explained: &'a Explained,
    phase: &'a Phase,
    /// The point that was added last to the sum of the table, or chosen in it.
    point: Option<usize>,
}

impl<'a> Shown<'a> {
    /// The phase on the page of the step pane of `view`, if that is on the screen.
    pub fn of(explained: Option<&'a Explained>, view: &View) -> Option<Self> {
        let explained = explained.filter(|_| view.shows_step())?;
        let (phase, ..) = explained.phase(view.page)?;
        let row = view.sum_to.and_then(|rows| rows.checked_sub(1));
        let points = table_of(phase).map(|table| &table.points);
        Some(Self {
            explained,
            phase,
            point: row
                .zip(points)
                .and_then(|(row, points)| points.get(row).copied()),
        })
    }

    /// The letters of the arrows that the phase is about.
    pub fn letters(&self) -> &'static [&'static str] {
        match self.phase.name {
            "inertia" => &[],
            "angular velocity" => &["Ω", "L"],
            "torque" => &["τ", "g", "F"],
            "new momentum" | "kick" => &["L", "dL", "new L"],
            "free motion" | "friction" => &["L"],
            name if name.starts_with("slope") => &["Ω", "τ"],
            _ => &["u"],
        }
    }

    /// Whether the body is drawn as it stood before the step too.
    pub fn has_before(&self) -> bool {
        match self.phase.name {
            "angular velocity" | "axis and angle" | "torque" | "new momentum" | "kick"
            | "friction" => false,
            name => !name.starts_with("slope"),
        }
    }

    /// The direction of the last vector of this `symbol` in the step up to this phase.
    pub fn direction(&self, symbol: &str) -> Option<Vector3<f64>> {
        let is_later = |phase: &&Phase| !std::ptr::eq(*phase, self.phase);
        let phases = self.explained.workings.phases().rev().skip_while(is_later);
        let mut quantities = phases.flat_map(|phase| phase.quantities.iter().rev());
        let found = quantities.find(|quantity| quantity.symbol == symbol)?;
        match found.value {
            Value::Vector(vector) => vector.try_normalize(f64::MIN_POSITIVE),
            _ => None,
        }
    }

    /// Whether friction has a part in dL, which is not along τ then.
    fn is_rubbed(&self) -> bool {
        let mut parts = self.explained.workings.parts.iter();
        parts.any(|part| !part.loads.friction.is_none())
    }

    fn before(&self) -> &State {
        &self.explained.states.0
    }
}

impl Subject<'_> {
    /// Whether the arrow of this letter is drawn. Where the step pane is shown, only those are that its phase is about.
    pub(super) fn draws(&self, letter: &str) -> bool {
        let shown = self.shown_phase.as_ref();
        shown.is_none_or(|shown| shown.letters().contains(&letter))
    }

    /// The direction of `letter` in the numbers of the phase, or else `now`.
    pub(super) fn direction(
        &self,
        letter: &str,
        now: Option<Vector3<f64>>,
    ) -> Option<Vector3<f64>> {
        let shown = self.shown_phase.as_ref();
        shown.and_then(|shown| shown.direction(letter)).or(now)
    }

    /// The axis of the turn, and the body before it.
    pub(super) fn phase(&self, scene: &mut Scene) -> Vec<Label> {
        let mut labels = Vec::new();
        let Some(shown) = &self.shown_phase else {
            return labels;
        };
        if let Some(axis) = shown.direction("u").filter(|_| self.draws("u")) {
            let end = axis * (AXIS * MOMENTUM * self.arm);
            scene.line(&-end, &end, Stroke::Thin, Ink::Strong(Role::Y));
            labels.push(("u", Role::Y, end * 1.04));
        }
        if shown.has_before() {
            self.body_before(shown.before(), scene);
        }
        if let Some(point) = shown.point {
            let points = self.run.scenario().body.mechanics.points();
            let Some(point) = points.get(point) else {
                return labels;
            };
            let before = shown.before().orientation * point.at;
            let (from, to) = match shown.phase.name {
                "inertia" => (Vector3::zeros(), before),
                _ => (before, self.state.orientation * point.at),
            };
            scene.line(&from, &to, Stroke::Thin, Ink::Strong(Role::Focus));
            labels.push(("@", Role::Focus, to));
        }
        labels
    }

    /// The masses where they were before the step.
    pub(super) fn signs_of_phase(&self, scene: &Scene) -> Vec<Sign> {
        let shown = self.shown_phase.as_ref().filter(|shown| shown.has_before());
        shown.map_or_else(Vec::new, |shown| self.masses_before(shown.before(), scene))
    }

    /// The direction of the new L, if the phase makes one that is seen to differ from the old.
    pub(super) fn new_momentum(&self) -> Option<Vector3<f64>> {
        let shown = self.shown_phase.as_ref().filter(|_| self.draws("dL"))?;
        let (old, new) = (shown.direction("L")?, shown.direction("new L")?);
        Some(new).filter(|new| (new - old).norm() > SEEN)
    }

    /// What the letters of the phase mean.
    pub(super) fn phase_legend(&self) -> Option<Vec<([&'static str; 3], Role)>> {
        let shown = self.shown_phase.as_ref()?;
        let word = |letter: &&str| match *letter {
            "Ω" => (["Ω angular velocity", "Ω", "Ω"], Role::Y),
            "u" => (["u axis of the turn", "u axis", "u"], Role::Y),
            "τ" => (["τ torque", "τ torque", "τ"], Role::X),
            "dL" if shown.is_rubbed() => (["dL, its direction", "dL, direction", "dL"], Role::X),
            "dL" => (
                ["dL along τ, its direction", "dL, direction", "dL"],
                Role::X,
            ),
            "g" => (["g weight", "g weight", "g"], Role::Push),
            "F" => (["F push", "F push", "F"], Role::Push),
            _ => (["L angular momentum", "L", "L"], Role::Z),
        };
        let has = |letter: &&&str| match **letter {
            "F" => !self.run.simulation().loads().pushes.is_empty(),
            "u" => shown.direction("u").is_some(),
            "new L" => false, // the arrow says it
            _ => true,
        };
        let mut words: Vec<_> = shown.letters().iter().filter(has).map(word).collect();
        if shown.has_before() {
            words.push((["° dotted: before the step", "° before", "°"], Role::Quiet));
        }
        if shown.point.is_some() {
            words.push((["@ the point", "@ point", "@"], Role::Focus));
        }
        Some(words)
    }
}
