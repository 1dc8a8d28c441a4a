//! The phases of a step along the exact motion, with their numbers.

use crate::workings::{Phase, PhaseName, PhaseTarget};
use nalgebra::{Complex, Matrix3, Quaternion, Vector3};

/// Cayley and Klein's parameters, short of the common factor by which |α|² + |β|² is `norm2` instead of 1.
pub(super) fn parameters(t: f64, [alpha, beta]: [Complex<f64>; 2], norm2: f64) -> Phase {
    Phase::new(PhaseName::ThetaFunctions, "α and β at the time t since the forces changed, each a theta function of t times a turning").with("t", "s", t).with("Re α", "", alpha.re).with("Im α", "", alpha.im).with("Re β", "", beta.re).with("Im β", "", beta.im).with("|α|² + |β|²", "", norm2)
}

/// The orientation from the quaternion that α and β make, turned from the frame of the load into the world frame.
pub(super) fn orientation(turn: &Quaternion<f64>, orientation: &Matrix3<f64>) -> Phase {
    Phase::new(PhaseName::NewOrientation, "Q ← the rotation of the quaternion q₀ = Re α, q₁ = Re β, q₂ = Im β, q₃ = Im α, seen from the world").with("q₀", "", turn.w).with("q₁", "", turn.i).with("q₂", "", turn.j).with("q₃", "", turn.k).with("new Q", "", *orientation)
    .changing(PhaseTarget::Orientation)
}

/// The angular momentum, from the frame of the load, in which its third part never changes, into the world frame.
pub(super) fn momentum(in_frame: &Vector3<f64>, momentum: &Vector3<f64>) -> Phase {
    Phase::new(
        PhaseName::NewMomentum,
        "L ← (Lx + i Ly = 2 I₁ (α β′ − β α′), Lz as at the start), seen from the world",
    )
    .with("L along the load's vertical", "J s", *in_frame)
    .with("new L", "J s", *momentum)
    .changing(PhaseTarget::Momentum)
}

/// The state from a Taylor series about the time `centre_s`.
pub(super) fn integrated(
    t: f64,
    centre_s: f64,
    (orientation, momentum): &(Matrix3<f64>, Vector3<f64>),
) -> Phase {
    Phase::new(PhaseName::TaylorSeries, "Q and L at the time t since the forces changed, from their series of order 22 about the time c").with("t", "s", t).with("c", "s", centre_s).with("new Q", "", *orientation).with("new L", "J s", *momentum)
    .changing(PhaseTarget::Both)
}
