//! The splitting of order 2 with friction: half a kick, the free motion, half a kick, where friction acts during the kicks.
//!
//! A kick leaves the body where it is. What torque and friction together do to L meanwhile is known in closed form
//! ([`Damping::slow`]), so that dry friction holds the body, and strong friction does not overshoot. The composition stays
//! palindromic, hence of order 2.
//!
//! The free motion of a body that is not symmetric about its axle changes ω3 also where dry friction holds it. Friction
//! acts in the kicks alone: in each it meets the spin as if half of that change came during the kick, so that the spin is
//! zero in the mean over the free motion, and at the end of the step. While it is held, friction on the swing slows the
//! held body, whose moments across the axle are others: with those of the free one the order would fall to 1.

use super::free_body::{FreeBody, orthonormal};
use super::phases;
use crate::friction::FreeSpin;
use crate::loads::torque;
use crate::workings::Listener;
use crate::{Body, Damping, Loads, State, friction};
use nalgebra::{Matrix3, Vector3};

/// The splitting for one body under constant forces and friction.
#[derive(Clone, Debug)]
pub(super) struct DampedStrang {
    body: FreeBody,
    moment: Matrix3<f64>,
    damping: Damping,
    /// Whether dry friction has to hold against the free motion.
    gyrates: bool,
}

impl DampedStrang {
    /// For `body` under `loads`; `None` where there is no friction.
    pub fn new(body: &Body, loads: &Loads) -> Option<Self> {
        let free = FreeBody::new(&body.inertia());
        let is_even =
            matches!(&free, FreeBody::Symmetric(symmetric) if symmetric.axis == Vector3::z());
        Some(Self {
            body: free,
            moment: loads.moment(body),
            damping: Damping::new(body, &loads.friction)?,
            gyrates: loads.friction.spin_dry > 0.0 && !is_even,
        })
    }

    /// One step of `h` seconds; returns the work of friction, J.
    pub fn step<L: Listener>(&self, state: &mut State, h: f64, listener: &mut L) -> f64 {
        let before = self.kick(0.5 * h, 0.0, state, listener);
        self.body.turn(&mut state.orientation, &state.momentum, h);
        listener.hear(|| phases::free_motion(h, &state.momentum, &state.orientation));
        state.orientation = orthonormal(&state.orientation);
        listener.hear(|| phases::orthonormal(&state.orientation));
        before + self.kick(0.5 * h, -0.5 * h, state, listener)
    }

    /// A kick; the free motion's change of the spin counts as if it had acted for `lead_s` before and acted during it.
    fn kick<L: Listener>(
        &self,
        duration_s: f64,
        lead_s: f64,
        state: &mut State,
        listener: &mut L,
    ) -> f64 {
        let q = &state.orientation;
        let load = torque(q, &self.moment);
        let omega = self.damping.inverse_inertia * q.tr_mul(&state.momentum);
        let free_spin = self.gyrates.then(|| FreeSpin {
            gyration: self.damping.gyration(&omega),
            lead_s,
        });
        let action = self
            .damping
            .slow(&omega, &q.tr_mul(&load), duration_s, free_spin);
        state.momentum += load * duration_s;
        listener.hear(|| phases::kick(duration_s, &load, &state.momentum));
        let impulse = q * action.impulse;
        state.momentum += impulse;
        listener.hear(|| friction::phase(duration_s, &omega, &impulse, &state.momentum));
        action.work
    }
}
