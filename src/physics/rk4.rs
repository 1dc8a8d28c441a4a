//! The classical Runge-Kutta scheme on dQ/dt = \[Ω\]× Q, dL/dt = torque(Q), Ω = Q I₀⁻¹ Qᵀ L.
//!
//! It is here so that the textbook's tops have a scheme that is true to them. It works on the matrix Q itself, whose
//! equation is smooth off the rotations too, and pulls it back to a rotation once, at the end of the step: that
//! changes the result by no more than the step's own error.

use super::{Body, Loads, Scheme, State, loads::torque, rotation};
use nalgebra::{Matrix3, Vector3};

/// Runge-Kutta of order 4; see the module's text.
#[derive(Clone, Debug)]
pub struct Rk4 {
    inverse_inertia: Matrix3<f64>,
    moment: Matrix3<f64>,
    body: Body,
}

#[derive(Clone, Copy)]
struct Slope {
    orientation: Matrix3<f64>,
    momentum: Vector3<f64>,
}

impl Rk4 {
    /// The scheme for `body`.
    pub fn new(body: &Body) -> Self {
        Self {
            inverse_inertia: body.inverse_inertia(),
            moment: Matrix3::zeros(),
            body: body.clone(),
        }
    }

    #[inline]
    fn slope(&self, orientation: &Matrix3<f64>, momentum: &Vector3<f64>) -> Slope {
        let omega = orientation * (self.inverse_inertia * orientation.tr_mul(momentum));
        Slope {
            orientation: rotation::crossed(&omega, orientation),
            momentum: torque(orientation, &self.moment),
        }
    }

    fn slope_after(&self, state: &State, slope: &Slope, time: f64) -> Slope {
        let orientation = state.orientation + slope.orientation * time;
        self.slope(&orientation, &(state.momentum + slope.momentum * time))
    }
}

impl Scheme for Rk4 {
    fn start(&mut self, _: &State) {}

    fn load(&mut self, loads: &Loads) {
        self.moment = loads.moment(&self.body);
    }

    fn step(&mut self, dt: f64, state: &mut State) {
        let k1 = self.slope(&state.orientation, &state.momentum);
        let k2 = self.slope_after(state, &k1, 0.5 * dt);
        let k3 = self.slope_after(state, &k2, 0.5 * dt);
        let k4 = self.slope_after(state, &k3, dt);
        let turned = k1.orientation + (k2.orientation + k3.orientation) * 2.0 + k4.orientation;
        let torque = k1.momentum + (k2.momentum + k3.momentum) * 2.0 + k4.momentum;
        state.orientation = rotation::straightened(&(state.orientation + turned * (dt / 6.0)));
        state.momentum += torque * (dt / 6.0);
    }

    fn boxed(&self) -> Box<dyn Scheme> {
        Box::new(self.clone())
    }
}
