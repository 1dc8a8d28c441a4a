//! Friction about the pivot: on the spin about the axle, and on the swing of the axle.
//!
//! With e3 the axle, ω3 = ω·e3 and ωp = ω − ω3 e3, the torque is −(k0 sgn ω3 + k1 ω3 + k2 |ω3| ω3) e3 − k4 ωp. If ω3 = 0,
//! dry friction balances any torque about the axle up to k0.
//!
//! A scheme cannot use the torque at the beginning of a time step. A spin that dry friction stops would continue past zero,
//! and a spin with k1 dt/I3 above 2 would grow. At a fixed orientation, however, ω under a constant torque and friction has
//! a closed form: about the axle it solves a Riccati equation, and across the axle it decays exponentially. Schemes use
//! this.

use super::workings::{Phase, PhaseName, PhaseTarget};
use super::{Body, Friction};
use nalgebra::{Matrix3, Vector3};

/// Friction on one body.
#[derive(Clone, Debug, PartialEq)]
pub struct Damping {
    pub(crate) friction: Friction,
    /// About the pivot, body frame, kg m².
    pub(crate) inertia: Matrix3<f64>,
    pub(crate) inverse_inertia: Matrix3<f64>,
    /// The moment against a torque about the axle, kg m²: 1/(e3·I⁻¹e3).
    pub(crate) along: f64,
    across: Across,
    /// The same while dry friction holds the spin at zero.
    across_held: Across,
}

/// Two perpendicular directions across the axle in which a torque along one changes ω along it alone, each with its
/// moment of inertia, kg m².
type Across = [(Vector3<f64>, f64); 2];

/// How the free motion, which follows or precedes a kick, changes the spin.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FreeSpin {
    /// The torque about the axle that would change it so, N m.
    pub gyration: f64,
    /// How long that torque has acted before the kick; negative where the free motion has already applied it, s.
    pub lead_s: f64,
}

/// What friction does while the body stands at one orientation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct FrictionAction {
    /// Its part of the change of L, body frame, J s.
    pub impulse: Vector3<f64>,
    /// Its work, J: the impulse times the mean of ω before and after.
    pub work: f64,
}

impl Damping {
    /// Returns the friction on `body`; `None` if there is none.
    pub fn new(body: &Body, friction: &Friction) -> Option<Self> {
        let inverse = body.inverse_inertia();
        let along = 1.0 / inverse[(2, 2)];
        (!friction.is_none()).then(|| Self {
            friction: *friction,
            inertia: body.inertia(),
            inverse_inertia: inverse,
            along,
            across: across(&inverse).map(|(direction, inverse)| (direction, 1.0 / inverse)),
            across_held: across(&body.inertia()),
        })
    }

    /// Returns the smallest moment of inertia against a torque of friction, kg m².
    pub fn least_moment(&self) -> f64 {
        let [(_, first), (_, second)] = self.across;
        first.min(second).min(self.along)
    }

    /// Returns the rate at which friction slows spin and swing together, 1/s, if the body turns with `omega` rad/s.
    pub fn rate(&self, omega: f64) -> f64 {
        let (friction, least) = (&self.friction, self.least_moment());
        let spin = friction.spin_viscous + friction.spin_quadratic * omega.abs();
        (spin + friction.swing_viscous) / least
    }

    /// Returns the torque of friction, N m, on a body with the angular velocity `omega`, rad/s; both in the body frame.
    pub fn torque(&self, omega: &Vector3<f64>) -> Vector3<f64> {
        let (friction, spin) = (&self.friction, omega.z);
        let sign = if spin == 0.0 { 0.0 } else { spin.signum() };
        let about = friction.spin_dry * sign
            + (friction.spin_viscous + friction.spin_quadratic * spin.abs()) * spin;
        let swing = -friction.swing_viscous * omega;
        Vector3::new(swing.x, swing.y, -about)
    }

    /// The torque about the axle with which the free motion of a body that turns by `omega` (body frame, rad/s) changes ω3,
    /// N m: what dry friction must hold against too. It is 0 of a body symmetric about its axle.
    pub(crate) fn gyration(&self, omega: &Vector3<f64>) -> f64 {
        let change = (self.inertia * omega).cross(omega);
        self.along * (self.inverse_inertia * change).z
    }

    /// What friction does during `time_s` to the body that turns by `omega`, while it stands as it is and another torque
    /// acts too, a constant one (N m); everything in the body frame. In closed form for a body symmetric about its axle, of any other
    /// to second order in the time: half the time about the axle, the whole across it, half about the axle.
    ///
    /// With `free_spin`, friction about the axle acts on the spin that there would be if the free motion changed it during
    /// this time too, and the swing of a body whose spin dry friction holds is slowed with the moments of the held body.
    pub(crate) fn slow(
        &self,
        omega: &Vector3<f64>,
        torque: &Vector3<f64>,
        time_s: f64,
        free_spin: Option<FreeSpin>,
    ) -> FrictionAction {
        let half = 0.5 * time_s;
        let (gyration, lead_s) = free_spin.map_or((0.0, 0.0), |it| (it.gyration, it.lead_s));
        let met = |spin: f64, since_s: f64| spin + gyration * (lead_s + since_s) / self.along;
        let about =
            |spin: f64, since_s: f64| self.about(met(spin, since_s), torque.z + gyration, half);
        let turned = |impulse: &Vector3<f64>| omega + self.inverse_inertia * impulse;
        let mut impulse = Vector3::zeros();
        let mut whole = Vector3::zeros();
        let first = about(omega.z, 0.0);
        impulse.z += first;
        whole.z += first + torque.z * half;
        let is_held = free_spin.is_some()
            && self.friction.spin_dry > 0.0
            && self.spin_after(met(omega.z, 0.0), torque.z + gyration, half) == 0.0;
        let across = if is_held {
            &self.across_held
        } else {
            &self.across
        };
        let swing = self.swing(across, &turned(&whole), torque, time_s);
        impulse += swing;
        whole += swing + Vector3::new(torque.x, torque.y, 0.0) * time_s;
        let second = about(turned(&whole).z, half);
        impulse.z += second;
        whole.z += second + torque.z * half;
        let work = 0.5 * impulse.dot(&(omega + turned(&whole)));
        FrictionAction { impulse, work }
    }

    /// The impulse of friction about the axle, J s, beside a constant torque about it (N m).
    fn about(&self, omega: f64, torque: f64, time_s: f64) -> f64 {
        if !self.friction.is_on_spin() {
            return 0.0;
        }
        let after = self.spin_after(omega, torque, time_s);
        self.along * (after - omega) - torque * time_s
    }

    /// The spin that was `omega` after `time_s` under friction and a constant torque about the axle (N m), rad/s.
    fn spin_after(&self, omega: f64, torque: f64, time_s: f64) -> f64 {
        spin_after(&self.friction, self.along, omega, torque, time_s)
    }

    /// The impulse of friction across the axle, J s, beside a constant torque (N m).
    fn swing(
        &self,
        across: &Across,
        omega: &Vector3<f64>,
        torque: &Vector3<f64>,
        time_s: f64,
    ) -> Vector3<f64> {
        let rubbing = self.friction.swing_viscous;
        if rubbing == 0.0 {
            return Vector3::zeros();
        }
        across
            .iter()
            .map(|(direction, moment)| {
                let (rate, torque) = (omega.dot(direction), torque.dot(direction));
                // The rate goes to the one at which friction balances the torque.
                let change = libm::expm1(-rubbing * time_s / moment) * (rate - torque / rubbing);
                direction * (moment * change - torque * time_s)
            })
            .sum()
    }
}

/// The phase of a time step in which friction changes L by `impulse` (world frame, J s) during `time_s`; `omega` is the
/// angular velocity before it, body frame, rad/s.
pub(super) fn phase(
    time_s: f64,
    omega: &Vector3<f64>,
    impulse: &Vector3<f64>,
    momentum: &Vector3<f64>,
) -> Phase {
    Phase::new(PhaseName::Friction, "L ← L + ΔL, ΔL of −(k₀ sgn ω₃ + k₁ ω₃ + k₂ |ω₃| ω₃) a − k₄ ω across a, in the time h at this orientation").with("h", "s", time_s).with("Ω seen from the body", "rad/s", *omega).with("ΔL", "J s", *impulse).with("new L", "J s", *momentum)
    .changing(PhaseTarget::Momentum)
}

/// The two principal directions of the part of `matrix` (body frame) across the axle, each with its principal value.
fn across(matrix: &Matrix3<f64>) -> Across {
    let (xx, yy, xy) = (matrix[(0, 0)], matrix[(1, 1)], matrix[(0, 1)]);
    let (sin, cos) = libm::sincos(0.5 * libm::atan2(2.0 * xy, xx - yy));
    [Vector3::new(cos, sin, 0.0), Vector3::new(-sin, cos, 0.0)]
        .map(|direction| (direction, direction.dot(&(matrix * direction))))
}

/// The rate of a spin after `time_s`, rad/s, that was `spin`, of a body with this `moment` (kg m²) about its axle, under friction and a
/// constant torque about the axle, N m.
fn spin_after(friction: &Friction, moment: f64, spin: f64, torque: f64, time_s: f64) -> f64 {
    let (mut spin, mut left) = (spin, time_s);
    // A spin that comes to a stop is held, or set off the other way, from where it does not come back.
    for _ in 0..2 {
        if spin == 0.0 && torque.abs() <= friction.spin_dry {
            return 0.0;
        }
        let sign = if spin == 0.0 { torque } else { spin }.signum();
        let slowing = SpinDecay {
            constant: (sign * torque - friction.spin_dry) / moment,
            linear: friction.spin_viscous / moment,
            square: friction.spin_quadratic / moment,
        };
        match slowing.stops_after(spin.abs()) {
            Some(stop) if stop <= left => (spin, left) = (0.0, left - stop),
            _ => return sign * slowing.after(spin.abs(), left),
        }
    }
    spin
}

/// dω/dt = a − b ω − c ω² for ω at or above 0, b and c not negative: a Riccati equation of constant coefficients.
///
/// With D = b² + 4ac and T = tanh(√D t/2)/√D (of a negative D tan, of none t/2) its solution is
/// ω(t) = (ω₀ (1 − b T) + 2 a T)/(1 + (b + 2 c ω₀) T).
#[derive(Clone, Copy, Debug)]
struct SpinDecay {
    /// a, rad/s².
    constant: f64,
    /// b, 1/s.
    linear: f64,
    /// c, 1/rad.
    square: f64,
}

impl SpinDecay {
    /// √|D|, 1/s, and whether D is not negative.
    fn root(&self) -> (f64, bool) {
        let product = 4.0 * self.constant * self.square;
        if product == 0.0 {
            return (self.linear, true);
        }
        let square = self.linear * self.linear + product;
        (square.abs().sqrt(), square >= 0.0)
    }

    /// ω after `time_s`, before it has come to a stop.
    fn after(&self, omega: f64, time_s: f64) -> f64 {
        let (root, is_real) = self.root();
        let half = 0.5 * root * time_s;
        let reach = match is_real {
            _ if root == 0.0 => 0.5 * time_s,
            true => libm::tanh(half) / root,
            false => libm::tan(half) / root,
        };
        let (a, b, c) = (self.constant, self.linear, self.square);
        let after =
            (omega * (1.0 - b * reach) + 2.0 * a * reach) / (1.0 + (b + 2.0 * c * omega) * reach);
        after.max(0.0)
    }

    /// The time after which ω is 0, s; `None` where it never is.
    fn stops_after(&self, omega: f64) -> Option<f64> {
        if self.constant >= 0.0 {
            return None;
        }
        let reach = omega / (self.linear * omega - 2.0 * self.constant);
        let (root, is_real) = self.root();
        Some(match is_real {
            _ if root == 0.0 => 2.0 * reach,
            true => 2.0 * libm::atanh(root * reach) / root,
            false => 2.0 * libm::atan(root * reach) / root,
        })
    }
}
