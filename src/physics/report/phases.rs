//! The phases of a step of the report's scheme, with their numbers.

use super::ReportScheme;
use super::points::{Inertia, LANES, Moments, Pair};
use crate::rotation::AxisAngle;
use crate::workings::{Phase, PhaseName, PhaseTarget, PointTable};
use nalgebra::{Matrix3, Vector3};
use wide::f64x2;

impl ReportScheme {
    /// Every point as (its index, its mass in kg, where it is), of `points`.
    fn each<'a>(
        &self,
        points: &'a [Pair],
    ) -> impl Iterator<Item = (usize, f64, [f64; 3], [f64; 9])> + use<'a> {
        let count = self.body.points().len();
        (0..count).map(|index| {
            let (pair, lane) = (&points[index / LANES], index % LANES);
            let of = |lanes: f64x2| lanes.to_array()[lane];
            let m = Moments::from_pair(pair);
            let moments = [m.x, m.y, m.z, m.xx, m.yy, m.zz, m.xy, m.xz, m.yz];
            let at = [pair.x, pair.y, pair.z].map(of);
            (index, of(pair.mass), at, moments.map(of))
        })
    }

    pub(super) fn inertia_phase(&self) -> Phase {
        let mut table = PointTable::new(&[
            ("m", "kg"),
            ("x", "m"),
            ("y", "m"),
            ("z", "m"),
            ("m x²", "kg m²"),
            ("m y²", "kg m²"),
            ("m z²", "kg m²"),
            ("m x y", "kg m²"),
            ("m x z", "kg m²"),
            ("m y z", "kg m²"),
        ]);
        for (point, mass, [x, y, z], [_, _, _, xx, yy, zz, xy, xz, yz]) in self.each(&self.points) {
            table.add(point, [mass, x, y, z, xx, yy, zz, xy, xz, yz]);
        }
        let (frame, inertia) = (self.body.frame_moment(), self.inertia.matrix());
        let whole_spins = frame == 0.0;
        let phase = Phase::new(
            PhaseName::Inertia,
            if whole_spins {
                "I = Σ m (|X|² E − X Xᵀ) = (Sxx + Syy + Szz) E − S, S = Σ m X Xᵀ"
            } else {
                "I = Σ m (|X|² E − X Xᵀ) − F a aᵀ = (Sxx + Syy + Szz) E − S − F a aᵀ, S = Σ m X Xᵀ, F the moment about the axle a of what does not spin"
            },
        );
        let phase = phase.with("X", "", table).with(
            "S",
            "kg m²",
            Moments::from_pairs(&self.points).second(),
        );
        if whole_spins {
            phase.with("I", "kg m²", inertia)
        } else {
            phase.with("F", "kg m²", frame).with("I", "kg m²", inertia)
        }
    }

    pub(super) fn positions_phase(&self, before: &[Pair]) -> Phase {
        let mut table = PointTable::new(&[
            ("x", "m"),
            ("y", "m"),
            ("z", "m"),
            ("new x", "m"),
            ("new y", "m"),
            ("new z", "m"),
        ]);
        let both = self.each(before).zip(self.each(&self.points));
        for ((point, _, [x, y, z], _), (_, _, [new_x, new_y, new_z], _)) in both {
            table.add(point, [x, y, z, new_x, new_y, new_z]);
        }
        Phase::new(PhaseName::NewPositions, "X ← R X, point by point")
            .with("X", "", table)
            .changing(PhaseTarget::Orientation)
    }

    pub(super) fn torque_phase(&self, first_moment: &Vector3<f64>, torque: &Vector3<f64>) -> Phase {
        let mut points = PointTable::new(&[("m x", "kg m"), ("m y", "kg m"), ("m z", "kg m")]);
        for (point, _, _, [x, y, z, ..]) in self.each(&self.points) {
            points.add(point, [x, y, z]);
        }
        let mut pushes = PointTable::new(&[
            ("Fx", "N"),
            ("Fy", "N"),
            ("Fz", "N"),
            ("(X × F)x", "N m"),
            ("(X × F)y", "N m"),
            ("(X × F)z", "N m"),
        ]);
        for push in &self.pushes {
            let (force, push_torque) = (push.force, self.push_torque(push));
            let row = [
                force.x,
                force.y,
                force.z,
                push_torque.x,
                push_torque.y,
                push_torque.z,
            ];
            pushes.add(push.point, row);
        }
        Phase::new(PhaseName::Torque, "τ = Σ X × F at the new positions: the weight's (−g Σ m y, g Σ m x, 0), and each push's").with("m X", "", points).with("Σ m X", "kg m", *first_moment).with("g", "m/s²", self.gravity).with("τ of the weight", "N m", self.weight_torque(first_moment)).with("F", "", pushes).with("τ", "N m", *torque)
    }
}

pub(super) fn velocity_phase(
    inertia: &Inertia,
    momentum: &Vector3<f64>,
    omega: &Vector3<f64>,
) -> Phase {
    Phase::new(PhaseName::AngularVelocity, "Ω = I⁻¹ L")
        .with("I", "kg m²", inertia.matrix())
        .with("L", "J s", *momentum)
        .with("Ω", "rad/s", *omega)
}

/// The axis about which the step turns, and its projection: zeros where nothing turns.
pub(super) fn axis_phase(omega: &Vector3<f64>, dt: f64, turn: Option<&AxisAngle>) -> Phase {
    let (axis, angle, projection) = match turn {
        Some(turn) => (turn.axis, turn.angle, turn.projection()),
        None => (Vector3::zeros(), 0.0, Matrix3::zeros()),
    };
    let (sine, cosine) = turn.map_or((0.0, 1.0), |turn| (turn.sine, turn.cosine));
    Phase::new(
        PhaseName::AxisAndAngle,
        "u = Ω/|Ω|, P = u uᵀ, angle = |Ω| dt",
    )
    .with("Ω", "rad/s", *omega)
    .with("dt", "s", dt)
    .with("u", "", axis)
    .with("angle", "rad", angle)
    .with("sin", "", sine)
    .with("cos", "", cosine)
    .with("P", "", projection)
}

pub(super) fn rotation_phase(rotation: &Matrix3<f64>) -> Phase {
    Phase::new(
        PhaseName::Rotation,
        "R = P + cos(|Ω| dt) (E − P) + sin(|Ω| dt) [u]×",
    )
    .with("R", "", *rotation)
}

pub(super) fn momentum_phase(
    dt: f64,
    torque: &Vector3<f64>,
    from: &Vector3<f64>,
    to: &Vector3<f64>,
) -> Phase {
    Phase::new(PhaseName::NewMomentum, "dL = dt τ, L ← L + dL")
        .with("L", "J s", *from)
        .with("dt", "s", dt)
        .with("τ", "N m", *torque)
        .with("dL", "J s", dt * torque)
        .with("new L", "J s", *to)
        .changing(PhaseTarget::Momentum)
}
