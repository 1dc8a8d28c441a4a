//! The phases of a step of a splitting scheme, with their numbers.

use super::turn::RotationByVector;
use crate::workings::{Phase, PhaseName, PhaseTarget};
use nalgebra::{Matrix3, Vector3};

/// Of a symmetric body: the spin that it has more than its turning about L, done once a step.
pub(super) fn spin(angle: f64, side: &Vector3<f64>) -> Phase {
    Phase::new(
        PhaseName::SpinAboutAxle,
        "e ← cos(angle) Qx + sin(angle) Qy, angle = (1/I₃ − 1/I₁) (L · a) dt",
    )
    .with("angle", "rad", angle)
    .with("e", "", *side)
    .changing(PhaseTarget::Orientation)
}

/// Of a body whose forces all act on the axle `a`.
pub(super) fn axle_kick(
    duration_s: f64,
    force: &Vector3<f64>,
    axle: &Vector3<f64>,
    change: &Vector3<f64>,
    momentum: &Vector3<f64>,
) -> Phase {
    Phase::new(
        PhaseName::Kick,
        "L ← L + ΔL, ΔL = a × (h Σ s F), s F: a force times its height on the axle",
    )
    .with("h", "s", duration_s)
    .with("Σ s F", "N m", *force)
    .with("a", "", *axle)
    .with("ΔL", "J s", *change)
    .with("new L", "J s", *momentum)
    .changing(PhaseTarget::Momentum)
}

/// The free motion of a symmetric body but for its spin: a turn about L.
pub(super) fn axle_turn(
    duration_s: f64,
    turn: &RotationByVector,
    axle: &Vector3<f64>,
    side: &Vector3<f64>,
) -> Phase {
    Phase::new(
        PhaseName::FreeMotion,
        "a and e turn about L by the angle |w|, w = L h/I₁",
    )
    .with("h", "s", duration_s)
    .with("w", "rad", turn.vector)
    .with("new a", "", *axle)
    .with("new e", "", *side)
    .changing(PhaseTarget::Orientation)
}

/// The orientation from the axle and a vector that is square to it but for rounding.
pub(super) fn put_together(
    axle: &Vector3<f64>,
    side: &Vector3<f64>,
    orientation: &Matrix3<f64>,
) -> Phase {
    Phase::new(
        PhaseName::NewOrientation,
        "Q ← (e, a × e, a), e made a unit vector square to a",
    )
    .with("a", "", *axle)
    .with("e", "", *side)
    .with("new Q", "", *orientation)
    .changing(PhaseTarget::Orientation)
}

/// Of any body under any forces.
pub(super) fn kick(duration_s: f64, torque: &Vector3<f64>, momentum: &Vector3<f64>) -> Phase {
    Phase::new(PhaseName::Kick, "L ← L + h τ(Q)")
        .with("h", "s", duration_s)
        .with("τ", "N m", *torque)
        .with("new L", "J s", *momentum)
        .changing(PhaseTarget::Momentum)
}

/// The free motion of any body.
pub(super) fn free_motion(
    duration_s: f64,
    momentum: &Vector3<f64>,
    orientation: &Matrix3<f64>,
) -> Phase {
    Phase::new(
        PhaseName::FreeMotion,
        "Q ← Q after the time h without forces, exactly; L stays",
    )
    .with("h", "s", duration_s)
    .with("L", "J s", *momentum)
    .with("new Q", "", *orientation)
    .changing(PhaseTarget::Orientation)
}

/// What rounding has added to the orientation is taken away.
pub(super) fn orthonormal(orientation: &Matrix3<f64>) -> Phase {
    Phase::new(PhaseName::RoundingTakenOut, "Q ← 3/2 Q − 1/2 Q Qᵀ Q")
        .with("new Q", "", *orientation)
        .changing(PhaseTarget::Orientation)
}
