//! The report's scheme (its section 3), to the letter. One step of length dt from positions X and momentum L:
//!
//! 1. I = Σ m (|X|²E − XXᵀ), about the pivot, from the positions as they stand
//! 2. Ω = I⁻¹L
//! 3. R = P + cos(|Ω|dt)(E − P) + sin(|Ω|dt)\[u\]×, P = uuᵀ, u = Ω/|Ω|; |Ω| = 0 turns nothing
//! 4. X ← R X, point by point
//! 5. L ← L + dt Σ X × F, at the *new* positions
//!
//! Friction, which the report does not have, acts in 5, with the Ω of the step and the axle after the rotation.
//!
//! The points themselves are carried from step to step, as the report carries them, two at a time: they are turned, and
//! then summed to the torque (5) and the inertia that the next step begins with (1). Two lanes on every processor, added
//! up in one fixed order, give every machine the same bits. The baseline x86-64 has 16 registers: they hold a rotation and
//! two points, or nine sums and two points, but not all of these, nor four lanes of either.
//!
//! Each step waits for the numbers of the one before, and most of its time is that wait. What the next step needs comes
//! first, and what it does not need (points without mass, the orientation) fills the gaps.

use super::rotation::AxisAngle;
use super::workings::{Listener, Nobody, Phase};
use super::{Body, Damping, Loads, PointForce, Scheme, State, friction};
use nalgebra::{Matrix3, Vector3};
use points::{Inertia, LANES, LaneRotation, Moments, Pair};
use wide::f64x2;

mod phases;
mod points;

/// The report's scheme, of order 1; see the [module's text](self).
#[derive(Clone, Debug)]
pub struct ReportScheme {
    body: Body,
    points: Vec<Pair>,
    /// How many pairs there are up to the last one with mass. What those after it add to the sums is zero: [`Body`] has
    /// none so far off that it would not be.
    massive: usize,
    gravity: f64,
    pushes: Vec<PointForce>,
    damping: Option<Damping>,
    /// Work of friction in the step taken last, J.
    work: f64,
    /// From the positions as they stand: what the next step begins with.
    inertia: Inertia,
}

impl ReportScheme {
    /// Makes the scheme for `body`.
    pub fn new(body: &Body) -> Self {
        Self {
            body: body.clone(),
            points: Vec::with_capacity(body.points().len().div_ceil(LANES)),
            massive: 0,
            gravity: 0.0,
            pushes: Vec::new(),
            damping: None,
            work: 0.0,
            inertia: Inertia::from_matrix(&body.inertia()),
        }
    }

    /// Returns the position of point `index`, world frame, m, as the scheme carries it.
    ///
    /// # Panics
    /// If the body has no such point, or before [`start`](Scheme::start).
    pub fn position(&self, index: usize) -> Vector3<f64> {
        let pair = &self.points[index / LANES];
        let lane = index % LANES;
        Vector3::new(
            pair.x.to_array()[lane],
            pair.y.to_array()[lane],
            pair.z.to_array()[lane],
        )
    }

    /// The inertia of points with these `moments`, less that about the axle of what does not spin.
    #[inline]
    fn inertia_of(&self, moments: &Moments, state: &State) -> Inertia {
        let (of_points, axle) = (Inertia::from_moments(moments), state.axle());
        if self.body.frame_moment() == 0.0 {
            return of_points;
        }
        Inertia::from_matrix(
            &(of_points.matrix() - axle * axle.transpose() * self.body.frame_moment()),
        )
    }

    /// The torque of the weight, N m, from Σ m X: it has no moment about z, so that L_z keeps its bits.
    fn weight_torque(&self, first_moment: &Vector3<f64>) -> Vector3<f64> {
        Vector3::new(
            -self.gravity * first_moment.y,
            self.gravity * first_moment.x,
            0.0,
        )
    }

    /// X × F, N m.
    fn push_torque(&self, push: &PointForce) -> Vector3<f64> {
        self.position(push.point).cross(&push.force)
    }

    /// Σ X × F, N m, from Σ m X and the pushed points.
    fn torque(&self, first_moment: &Vector3<f64>) -> Vector3<f64> {
        let weight = self.weight_torque(first_moment);
        let pushes = self.pushes.iter();
        pushes.fold(weight, |sum, push| sum + self.push_torque(push))
    }

    /// A step with friction. It stands apart from the step itself, which without it keeps its numbers in registers.
    #[cold]
    #[inline(never)]
    fn rub<L: Listener>(&mut self, dt: f64, state: &mut State, listener: &mut L) {
        let angular_velocity = self.inertia.solve(&state.momentum);
        self.advance(dt, state, listener);
        let Some(damping) = &self.damping else {
            return;
        };
        let torque = self.torque(&Moments::from_pairs(&self.points[..self.massive]).first());
        let q = &state.orientation;
        let omega = q.tr_mul(&angular_velocity);
        let action = damping.slow(&omega, &q.tr_mul(&torque), dt, None);
        let impulse = q * action.impulse;
        state.momentum += impulse;
        self.work = action.work;
        listener.hear(|| friction::phase(dt, &omega, &impulse, &state.momentum));
    }

    #[inline]
    fn advance<L: Listener>(&mut self, dt: f64, state: &mut State, listener: &mut L) {
        let inertia = self.inertia;
        listener.hear(|| self.inertia_phase());
        let angular_velocity = inertia.solve(&state.momentum);
        listener.hear(|| phases::velocity_phase(&inertia, &state.momentum, &angular_velocity));
        let turn = AxisAngle::new(&angular_velocity, dt);
        let rotation = turn.map_or_else(Matrix3::identity, |turn| turn.matrix());
        listener.hear(|| phases::axis_phase(&angular_velocity, dt, turn.as_ref()));
        listener.hear(|| phases::rotation_phase(&rotation));
        let before = L::LISTENS.then(|| self.points.clone());
        // What the next step waits for comes first: the points with mass, and their sums.
        let lane_turn = LaneRotation::from_matrix(&rotation);
        let (massive, massless) = self.points.split_at_mut(self.massive);
        lane_turn.points(massive);
        let moments = Moments::from_pairs(massive);
        lane_turn.points(massless);
        state.orientation = lane_turn.times(&state.orientation);
        listener.hear(|| self.positions_phase(before.as_deref().unwrap_or_default()));
        let first_moment = moments.first();
        let torque = self.torque(&first_moment);
        listener.hear(|| self.torque_phase(&first_moment, &torque));
        let momentum = state.momentum;
        state.momentum += dt * torque;
        listener.hear(|| phases::momentum_phase(dt, &torque, &momentum, &state.momentum));
        self.inertia = self.inertia_of(&moments, state);
    }
}

impl Scheme for ReportScheme {
    fn start(&mut self, state: &State) {
        self.points.clear();
        self.massive = pairs_up_to_the_last_mass(&self.body);
        for points in self.body.points().chunks(LANES) {
            let mut lanes = [[0.0; LANES]; 4];
            for (lane, point) in points.iter().enumerate() {
                let at = state.orientation * point.at;
                for (row, value) in lanes.iter_mut().zip([at.x, at.y, at.z, point.mass]) {
                    row[lane] = value;
                }
            }
            let [x, y, z, mass] = lanes.map(f64x2::new);
            self.points.push(Pair { x, y, z, mass });
        }
        self.inertia = self.inertia_of(&Moments::from_pairs(&self.points), state);
    }

    fn load(&mut self, loads: &Loads) {
        self.gravity = loads.gravity;
        self.pushes.clone_from(&loads.pushes);
        self.damping = Damping::new(&self.body, &loads.friction);
        self.work = 0.0;
    }

    fn friction_work(&self) -> f64 {
        self.work
    }

    fn step(&mut self, dt: f64, state: &mut State) {
        if self.damping.is_some() {
            self.rub(dt, state, &mut Nobody);
        } else {
            self.advance(dt, state, &mut Nobody);
        }
    }

    fn explain(&mut self, dt: f64, state: &mut State, phases: &mut Vec<Phase>) {
        if self.damping.is_some() {
            self.rub(dt, state, phases);
        } else {
            self.advance(dt, state, phases);
        }
    }

    fn boxed(&self) -> Box<dyn Scheme> {
        Box::new(self.clone())
    }
}

/// The number of pairs up to the last one that has mass.
fn pairs_up_to_the_last_mass(body: &Body) -> usize {
    let last = body.points().iter().rposition(|point| point.mass != 0.0);
    last.map_or(0, |last| last / LANES + 1)
}
