//! Explicit Runge-Kutta schemes on dQ/dt = \[Ω\]× Q, dL/dt = torque(Q, Ω), Ω = Q I₀⁻¹ Qᵀ L; the torque depends on Ω where
//! there is friction. Each scheme is a [`Tableau`].
//!
//! They are here so that the textbook's tops have a scheme that is true to them. They work on the matrix Q itself, whose
//! equation is smooth off the rotations too, and pull it back to a rotation once, at the end of the step: that
//! changes the result by no more than the step's own error.

use crate::workings::{Listener, Nobody, Phase, PhaseName, PhaseTarget};
use crate::{Body, Damping, Loads, Scheme, State, loads::torque, rotation};
use nalgebra::{Matrix3, Vector3};
use std::ops::{Add, Mul};

/// What the first slope is, without friction and with it.
const FRICTIONLESS_TEXT: &str = "Ω₁ = Q I₀⁻¹ Qᵀ L, Q₁′ = [Ω₁]× Q, L₁′ = τ(Q)";
const FRICTION_TEXT: &str = "Ω₁ = Q I₀⁻¹ Qᵀ L, Q₁′ = [Ω₁]× Q, L₁′ = τ(Q) + friction's torque at Ω₁";

/// The coefficients of a scheme each of whose slopes follows from the one before: the first is that at the beginning.
#[derive(Debug)]
pub(super) struct Tableau<const SLOPES: usize> {
    /// How each slope is found.
    stages: [Stage; SLOPES],
    /// The share of each slope in the step: its weight over the sum of all.
    weights: [f64; SLOPES],
    weight_sum: f64,
    /// Formulas of the new orientation, of that before it is made a rotation again, and of the new momentum.
    orientation: &'static str,
    bent: &'static str,
    momentum: &'static str,
}

/// How a slope is found.
#[derive(Debug)]
struct Stage {
    name: PhaseName,
    formula: &'static str,
    /// The share of the step that is taken by the slope before, to where this slope is found.
    share: f64,
}

/// The classical scheme of order 4.
pub(super) static RK4: Tableau<4> = Tableau {
    stages: [
        Stage {
            name: PhaseName::Slope1AtBeginning,
            formula: FRICTIONLESS_TEXT,
            share: 0.0,
        },
        Stage {
            name: PhaseName::Slope2HalfWay,
            formula: "the same at Q + ½ dt Q₁′, L + ½ dt L₁′",
            share: 0.5,
        },
        Stage {
            name: PhaseName::Slope3HalfWay,
            formula: "the same at Q + ½ dt Q₂′, L + ½ dt L₂′",
            share: 0.5,
        },
        Stage {
            name: PhaseName::Slope4AtEnd,
            formula: "the same at Q + dt Q₃′, L + dt L₃′",
            share: 1.0,
        },
    ],
    weights: [1.0, 2.0, 2.0, 1.0],
    weight_sum: 6.0,
    orientation: "Q ← Q + dt/6 (Q₁′ + 2 Q₂′ + 2 Q₃′ + Q₄′), then made a rotation again",
    bent: "Q + dt/6 (...)",
    momentum: "L ← L + dt/6 (L₁′ + 2 L₂′ + 2 L₃′ + L₄′)",
};

#[derive(Clone, Debug)]
pub(super) struct RungeKutta<const SLOPES: usize> {
    tableau: &'static Tableau<SLOPES>,
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

impl<const SLOPES: usize> Tableau<SLOPES> {
    /// Returns the sum of the `slopes` by their weights, the slopes between the first and the last added up first.
    #[inline]
    fn weighted_sum<T>(&self, slopes: &[Slope; SLOPES], part: impl Fn(&Slope) -> T) -> T
    where
        T: Add<Output = T> + Mul<f64, Output = T>,
    {
        let weighted = |index: usize| part(&slopes[index]) * self.weights[index];
        let (first, last) = (weighted(0), weighted(SLOPES - 1));
        match (1..SLOPES - 1).map(weighted).reduce(Add::add) {
            Some(between) => first + between + last,
            None => first + last,
        }
    }
}

impl<const SLOPES: usize> RungeKutta<SLOPES> {
    pub(super) fn new(tableau: &'static Tableau<SLOPES>, body: &Body) -> Self {
        Self {
            tableau,
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
    fn take_step<L: Listener>(&mut self, dt: f64, state: &mut State, listener: &mut L) {
        let tableau = self.tableau;
        let first = self.slope(&state.orientation, &state.momentum);
        let first_formula = match self.damping {
            Some(_) => FRICTION_TEXT,
            None => tableau.stages[0].formula,
        };
        listener.hear(|| first.phase(tableau.stages[0].name, first_formula));
        let mut slopes = [first; SLOPES];
        for index in 1..SLOPES {
            let stage = &tableau.stages[index];
            let slope = self.slope_after(state, &slopes[index - 1], stage.share * dt);
            listener.hear(|| slope.phase(stage.name, stage.formula));
            slopes[index] = slope;
        }
        let each = dt / tableau.weight_sum;
        let before = *state;
        let turned = tableau.weighted_sum(&slopes, |slope| slope.orientation);
        let bent = state.orientation + turned * each;
        state.orientation = rotation::straightened(&bent);
        listener.hear(|| tableau.orientation_phase(dt, &before, &bent, state));
        state.momentum += tableau.weighted_sum(&slopes, |slope| slope.momentum) * each;
        listener.hear(|| tableau.momentum_phase(dt, &before, state));
        if self.damping.is_some() {
            self.work = tableau.weighted_sum(&slopes, |slope| slope.power) * each;
        }
    }
}

impl Slope {
    fn phase(&self, name: PhaseName, formula: &'static str) -> Phase {
        Phase::new(name, formula)
            .with("Ω", "rad/s", self.angular_velocity)
            .with("Q′", "1/s", self.orientation)
            .with("L′", "N m", self.momentum)
    }
}

impl<const SLOPES: usize> Tableau<SLOPES> {
    fn orientation_phase(
        &self,
        dt: f64,
        before: &State,
        bent: &Matrix3<f64>,
        after: &State,
    ) -> Phase {
        Phase::new(PhaseName::NewOrientation, self.orientation)
            .with("Q", "", before.orientation)
            .with("dt", "s", dt)
            .with(self.bent, "", *bent)
            .with("new Q", "", after.orientation)
            .changing(PhaseTarget::Orientation)
    }

    fn momentum_phase(&self, dt: f64, before: &State, after: &State) -> Phase {
        Phase::new(PhaseName::NewMomentum, self.momentum)
            .with("L", "J s", before.momentum)
            .with("dt", "s", dt)
            .with("new L", "J s", after.momentum)
            .changing(PhaseTarget::Momentum)
    }
}

impl<const SLOPES: usize> Scheme for RungeKutta<SLOPES> {
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
        self.take_step(dt, state, &mut Nobody);
    }

    fn explain(&mut self, dt: f64, state: &mut State, phases: &mut Vec<Phase>) {
        self.take_step(dt, state, phases);
    }

    fn boxed(&self) -> Box<dyn Scheme> {
        Box::new(self.clone())
    }
}
