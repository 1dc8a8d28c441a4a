//! The classical Runge-Kutta scheme on dQ/dt = \[Ω\]× Q, dL/dt = torque(Q, Ω), Ω = Q I₀⁻¹ Qᵀ L; the torque depends on Ω where
//! there is friction.
//!
//! It is here so that the textbook's tops have a scheme that is true to them. It works on the matrix Q itself, whose
//! equation is smooth off the rotations too, and pulls it back to a rotation once, at the end of the step: that
//! changes the result by no more than the step's own error.

use crate::workings::{Listener, Nobody, Phase, PhaseTarget};
use crate::{Body, Damping, Loads, Scheme, State, loads::torque, rotation};
use nalgebra::{Matrix3, Vector3};

// Names and formulas of the phases in which the slopes are found.
const FIRST_SLOPE: &str = "slope 1: at the beginning";
const FRICTIONLESS_TEXT: &str = "Ω₁ = Q I₀⁻¹ Qᵀ L, Q₁′ = [Ω₁]× Q, L₁′ = τ(Q)";
const FRICTION_TEXT: &str = "Ω₁ = Q I₀⁻¹ Qᵀ L, Q₁′ = [Ω₁]× Q, L₁′ = τ(Q) + friction's torque at Ω₁";
type PhaseText = (&'static str, &'static str);
const SECOND_SLOPE: PhaseText = (
    "slope 2: half way by slope 1",
    "the same at Q + ½ dt Q₁′, L + ½ dt L₁′",
);
const THIRD_SLOPE: PhaseText = (
    "slope 3: half way by slope 2",
    "the same at Q + ½ dt Q₂′, L + ½ dt L₂′",
);
const FOURTH: PhaseText = (
    "slope 4: at the end by slope 3",
    "the same at Q + dt Q₃′, L + dt L₃′",
);

#[derive(Clone, Debug)]
pub struct Rk4 {
    inverse_inertia: Matrix3<f64>,
    moment: Matrix3<f64>,
    damping: Option<Damping>,
    /// Work of friction in the step taken last, J.
    work: f64,
    body: Body,
}

#[derive(Clone, Copy)]
struct Slope {
    /// Ω, rad/s.
    angular_velocity: Vector3<f64>,
    /// dQ/dt = \[Ω\]× Q, 1/s.
    orientation: Matrix3<f64>,
    /// dL/dt, the torque, that of friction included, N m.
    momentum: Vector3<f64>,
    /// The power of friction, W.
    power: f64,
}

impl Rk4 {
    pub fn new(body: &Body) -> Self {
        Self {
            inverse_inertia: body.inverse_inertia(),
            moment: Matrix3::zeros(),
            damping: None,
            work: 0.0,
            body: body.clone(),
        }
    }

    #[inline]
    fn slope(&self, orientation: &Matrix3<f64>, momentum: &Vector3<f64>) -> Slope {
        let in_body = self.inverse_inertia * orientation.tr_mul(momentum);
        let omega = orientation * in_body;
        let mut slope = Slope {
            angular_velocity: omega,
            orientation: rotation::crossed(&omega, orientation),
            momentum: torque(orientation, &self.moment),
            power: 0.0,
        };
        if let Some(damping) = &self.damping {
            let friction = damping.torque(&in_body);
            slope.momentum += orientation * friction;
            slope.power = friction.dot(&in_body);
        }
        slope
    }

    fn slope_after(&self, state: &State, slope: &Slope, time: f64) -> Slope {
        let orientation = state.orientation + slope.orientation * time;
        self.slope(&orientation, &(state.momentum + slope.momentum * time))
    }

    #[inline]
    fn advance<L: Listener>(&mut self, dt: f64, state: &mut State, listener: &mut L) {
        let k1 = self.slope(&state.orientation, &state.momentum);
        let is_rubbed = self.damping.is_some();
        listener.hear(|| {
            k1.phase(
                FIRST_SLOPE,
                if is_rubbed {
                    FRICTION_TEXT
                } else {
                    FRICTIONLESS_TEXT
                },
            )
        });
        let k2 = self.slope_after(state, &k1, 0.5 * dt);
        listener.hear(|| k2.phase(SECOND_SLOPE.0, SECOND_SLOPE.1));
        let k3 = self.slope_after(state, &k2, 0.5 * dt);
        listener.hear(|| k3.phase(THIRD_SLOPE.0, THIRD_SLOPE.1));
        let k4 = self.slope_after(state, &k3, dt);
        listener.hear(|| k4.phase(FOURTH.0, FOURTH.1));
        let turned = k1.orientation + (k2.orientation + k3.orientation) * 2.0 + k4.orientation;
        let torque = k1.momentum + (k2.momentum + k3.momentum) * 2.0 + k4.momentum;
        let before = *state;
        let bent = state.orientation + turned * (dt / 6.0);
        state.orientation = rotation::straightened(&bent);
        listener.hear(|| orientation_phase(dt, &before.orientation, &bent, &state.orientation));
        state.momentum += torque * (dt / 6.0);
        listener.hear(|| momentum_phase(dt, &before.momentum, &state.momentum));
        if self.damping.is_some() {
            let power = k1.power + 2.0 * (k2.power + k3.power) + k4.power;
            self.work = power * (dt / 6.0);
        }
    }
}

impl Slope {
    fn phase(&self, name: &'static str, formula: &'static str) -> Phase {
        Phase::of(name, formula)
            .with("Ω", "rad/s", self.angular_velocity)
            .with("Q′", "1/s", self.orientation)
            .with("L′", "N m", self.momentum)
    }
}

fn orientation_phase(
    dt: f64,
    from: &Matrix3<f64>,
    bent: &Matrix3<f64>,
    to: &Matrix3<f64>,
) -> Phase {
    Phase::of(
        "new orientation",
        "Q ← Q + dt/6 (Q₁′ + 2 Q₂′ + 2 Q₃′ + Q₄′), then made a rotation again",
    )
    .with("Q", "", *from)
    .with("dt", "s", dt)
    .with("Q + dt/6 (...)", "", *bent)
    .with("new Q", "", *to)
    .changing(PhaseTarget::Orientation)
}

fn momentum_phase(dt: f64, from: &Vector3<f64>, to: &Vector3<f64>) -> Phase {
    Phase::of("new momentum", "L ← L + dt/6 (L₁′ + 2 L₂′ + 2 L₃′ + L₄′)")
        .with("L", "J s", *from)
        .with("dt", "s", dt)
        .with("new L", "J s", *to)
        .changing(PhaseTarget::Momentum)
}

impl Scheme for Rk4 {
    fn start(&mut self, _: &State) {}

    fn load(&mut self, loads: &Loads) {
        self.moment = loads.moment(&self.body);
        self.damping = Damping::new(&self.body, &loads.friction);
        self.work = 0.0;
    }

    fn friction_work(&self) -> f64 {
        self.work
    }

    fn step(&mut self, dt: f64, state: &mut State) {
        self.advance(dt, state, &mut Nobody);
    }

    fn explain(&mut self, dt: f64, state: &mut State, phases: &mut Vec<Phase>) {
        self.advance(dt, state, phases);
    }

    fn boxed(&self) -> Box<dyn Scheme> {
        Box::new(self.clone())
    }
}
