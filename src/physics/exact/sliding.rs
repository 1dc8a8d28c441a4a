//! Friction in the Taylor series of an exact motion ([`taylor`](super::taylor)).
//!
//! While the spin keeps its sign, friction is a polynomial in ω, and so is one more term of the series. Where dry or
//! quadratic friction has a kink, at a spin of zero, the series ends: it is begun anew with the other sign, or, where dry
//! friction is strong enough, with the torque that holds the spin at zero, until it is not strong enough any more.

use super::series::{SERIES_ORDER, convolve};
use crate::Damping;
use crate::loads::axial;
use nalgebra::{Matrix3, Vector3};

/// How the body rubs about its axle.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Contact {
    /// Without a kink at zero: no dry friction, none by the square.
    Smooth,
    /// The spin has this sign.
    Slips(f64),
    /// Dry friction holds the spin at zero.
    Holds,
}

/// A spin whose momentum is below this part of all there is has stopped but for rounding.
const STOPPED_SPIN: f64 = 1e-15;
/// Into so many pieces a stretch is cut when the first event in it is sought: in it the body turns by about a radian.
const PIECES: u32 = 16;
/// An event nearer to the beginning of a stretch than this part of it is the event at which the stretch begins.
const SAME_EVENT: f64 = 1e-9;

/// Friction on one body from one stretch of its motion to the next.
#[derive(Clone, Debug)]
pub(super) struct Sliding {
    damping: Damping,
    /// Σ x Fᵀ of the other forces, as in [`AccurateMotion`](super::AccurateMotion), N m.
    moment: Matrix3<f64>,
    contact: Contact,
    /// Whether the contact changes where the present series ends.
    ends: bool,
    /// Coefficients of friction's torque, body frame, N m.
    torque: [Vector3<f64>; SERIES_ORDER],
    /// Coefficients of the other forces' torque, world frame, N m.
    load: [Vector3<f64>; SERIES_ORDER],
    /// Coefficients of ω3, rad/s.
    spin: [f64; SERIES_ORDER],
    /// Coefficients of the work of friction, J; the first is the work up to the center of the series.
    work: [f64; SERIES_ORDER + 1],
}

/// How the body rubbed, and the work of friction, where a series begins.
#[derive(Clone, Copy, Debug)]
pub(super) struct FrictionStart {
    contact: Contact,
    ends: bool,
    work: f64,
}

/// The coefficients found so far of what friction depends on: up to that of the order asked for.
pub(super) struct FrictionCoefficients<'a> {
    /// Of the orientation.
    pub matrix: &'a [Matrix3<f64>],
    /// Of ω, body frame, rad/s.
    pub omega: &'a [Vector3<f64>],
}

impl Sliding {
    pub fn new(damping: Damping, moment: Matrix3<f64>) -> Self {
        Self {
            damping,
            moment,
            contact: Contact::Smooth,
            ends: false,
            torque: [Vector3::zeros(); SERIES_ORDER],
            load: [Vector3::zeros(); SERIES_ORDER],
            spin: [0.0; SERIES_ORDER],
            work: [0.0; SERIES_ORDER + 1],
        }
    }

    /// Decides how the body rubs from here on: it stands as `matrix` says and has the momentum `momentum` (world frame,
    /// J s), from which the spin is taken where it has stopped; momenta are of the size `unit`.
    pub fn begin(&mut self, matrix: &Matrix3<f64>, momentum: &mut Vector3<f64>, unit: f64) {
        let friction = &self.damping.friction;
        if friction.spin_dry == 0.0 && friction.spin_quadratic == 0.0 {
            return;
        }
        let omega = self.omega(matrix, momentum);
        let along = self.damping.along;
        let (was, ends) = (self.contact, std::mem::take(&mut self.ends));
        let has_stopped = ends || was == Contact::Holds;
        if !has_stopped && omega.z.abs() * along > STOPPED_SPIN * unit {
            self.contact = Contact::Slips(omega.z.signum());
            return;
        }
        *momentum -= matrix.column(2) * (along * omega.z);
        let slowed = self.omega(matrix, momentum);
        let load = axial(&(matrix * self.moment));
        let swing = self.swing(&slowed);
        let gyration = slowed.cross(&(self.damping.inertia * slowed));
        let hold = self.hold(&(matrix.tr_mul(&load) + swing - gyration));
        let is_strong_enough = match was {
            Contact::Holds => !ends,
            Contact::Smooth | Contact::Slips(_) => hold.abs() <= friction.spin_dry,
        };
        self.contact = if is_strong_enough {
            Contact::Holds
        } else {
            // It is set off against the torque that would have held it.
            Contact::Slips(-hold.signum())
        };
    }

    /// What [`begin`](Self::begin) depends on beside the state.
    pub fn before(&self) -> FrictionStart {
        FrictionStart {
            contact: self.contact,
            ends: self.ends,
            work: self.work[0],
        }
    }

    /// Goes back to where it was so.
    pub fn go_back(&mut self, before: FrictionStart) {
        (self.contact, self.ends) = (before.contact, before.ends);
        self.work[0] = before.work;
    }

    /// Coefficient `k` of friction's torque, world frame, N m; those below it must have been asked for.
    pub fn coefficient(&mut self, k: usize, known: &FrictionCoefficients<'_>) -> Vector3<f64> {
        let omega = known.omega[k];
        self.spin[k] = omega.z;
        self.load[k] = axial(&(known.matrix[k] * self.moment));
        let swing = self.swing(&omega);
        let about = match self.contact {
            Contact::Holds => {
                let inertia = self.damping.inertia;
                let load = convolve(k, |i, j| known.matrix[i].tr_mul(&self.load[j]));
                let gyration =
                    convolve(k, |i, j| known.omega[i].cross(&(inertia * known.omega[j])));
                self.hold(&(load + swing - gyration))
            }
            Contact::Smooth => self.slows(k, 0.0),
            Contact::Slips(sign) => self.slows(k, sign),
        };
        self.torque[k] = swing + Vector3::z() * about;
        let power = convolve(k, |i, j| self.torque[i].dot(&known.omega[j]));
        self.work[k + 1] = power / (k + 1) as f64;
        convolve(k, |i, j| known.matrix[i] * self.torque[j])
    }

    /// The distance from the center within `radius` at which the contact changes, s; the series ends there.
    pub fn find_event(&mut self, radius: f64) -> Option<f64> {
        let event = self.event_within(radius);
        self.ends = event.is_some();
        event
    }

    fn event_within(&self, radius: f64) -> Option<f64> {
        let dry = self.damping.friction.spin_dry;
        let left = |t: f64| match self.contact {
            Contact::Smooth => f64::INFINITY,
            Contact::Slips(sign) => sign * value(&self.spin, t),
            Contact::Holds => dry - value(&self.torque.map(|torque| torque.z), t).abs(),
        };
        if self.contact == Contact::Smooth {
            return None;
        }
        let at = |piece: u32| radius * f64::from(piece) / f64::from(PIECES);
        let piece = (1..=PIECES).find(|&piece| left(at(piece)) < 0.0)?;
        let (mut low, mut high) = (at(piece - 1), at(piece));
        while low < 0.5 * (low + high) && 0.5 * (low + high) < high {
            let middle = 0.5 * (low + high);
            if left(middle) < 0.0 {
                high = middle;
            } else {
                low = middle;
            }
        }
        (high > SAME_EVENT * radius).then_some(high)
    }

    /// The work of friction up to `t` s from the center of the series, J.
    pub fn work(&self, t: f64) -> f64 {
        value(&self.work, t)
    }

    /// The next series begins `t` s from the center of this one.
    pub fn go_on_from(&mut self, t: f64) {
        self.work[0] = self.work(t);
    }

    fn omega(&self, matrix: &Matrix3<f64>, momentum: &Vector3<f64>) -> Vector3<f64> {
        self.damping.inverse_inertia * matrix.tr_mul(momentum)
    }

    /// Coefficient `k` of the torque about the axle while the spin has this `sign`.
    fn slows(&self, k: usize, sign: f64) -> f64 {
        let friction = &self.damping.friction;
        let square = convolve(k, |i, j| self.spin[i] * self.spin[j]);
        let dry = if k == 0 { friction.spin_dry } else { 0.0 };
        -sign * (dry + friction.spin_quadratic * square) - friction.spin_viscous * self.spin[k]
    }

    /// Friction's torque across the axle.
    fn swing(&self, omega: &Vector3<f64>) -> Vector3<f64> {
        Vector3::new(omega.x, omega.y, 0.0) * -self.damping.friction.swing_viscous
    }

    /// The torque about the axle that keeps ω3 as it is where dL/dt in the body frame is `change` without it.
    fn hold(&self, change: &Vector3<f64>) -> f64 {
        let rate = self.damping.inverse_inertia * change;
        -self.damping.along * rate.z
    }
}

/// The value of a series `t` from its center, by Horner's rule.
fn value(coefficients: &[f64], t: f64) -> f64 {
    let from_last = coefficients.iter().rev();
    from_last.fold(0.0, |sum, coefficient| sum * t + coefficient)
}
