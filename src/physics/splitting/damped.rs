//! The splitting of order 2 with friction: half a kick, the free motion, half a kick, where friction acts during the kicks.
//!
//! A kick leaves the body where it is. What torque and friction together do to L meanwhile is known in closed form
//! ([`Damping::act`]), so that dry friction holds the body, and strong friction does not overshoot. The composition stays
//! palindromic, hence of order 2.

use super::free_body::{FreeBody, orthonormal};
use super::phases;
use crate::physics::loads::torque;
use crate::physics::workings::Listener;
use crate::physics::{Body, Damping, Loads, State, friction};
use nalgebra::Matrix3;

/// The splitting for one body under constant forces and friction.
#[derive(Clone, Debug)]
pub(super) struct DampedStrang {
    body: FreeBody,
    moment: Matrix3<f64>,
    damping: Damping,
}

impl DampedStrang {
    /// For `body` under `loads`; `None` where there is no friction.
    pub fn new(body: &Body, loads: &Loads) -> Option<Self> {
        Some(Self {
            body: FreeBody::new(&body.inertia()),
            moment: loads.moment(body),
            damping: Damping::new(body, &loads.friction)?,
        })
    }

    /// One step of `h` seconds; returns the work of friction, J.
    pub fn step<L: Listener>(&self, state: &mut State, h: f64, listener: &mut L) -> f64 {
        let before = self.kick(0.5 * h, state, listener);
        self.body
            .advance(&mut state.orientation, &state.momentum, h);
        listener.hear(|| phases::free_motion(h, &state.momentum, &state.orientation));
        state.orientation = orthonormal(&state.orientation);
        listener.hear(|| phases::orthonormal(&state.orientation));
        before + self.kick(0.5 * h, state, listener)
    }

    fn kick<L: Listener>(&self, duration_s: f64, state: &mut State, listener: &mut L) -> f64 {
        let q = &state.orientation;
        let torque = torque(q, &self.moment);
        let omega = self.damping.inverse_inertia() * q.tr_mul(&state.momentum);
        let action = self.damping.act(&omega, &q.tr_mul(&torque), duration_s);
        state.momentum += torque * duration_s;
        listener.hear(|| phases::kick(duration_s, &torque, &state.momentum));
        let impulse = q * action.impulse;
        state.momentum += impulse;
        listener.hear(|| friction::phase(duration_s, &omega, &impulse, &state.momentum));
        action.work
    }
}
