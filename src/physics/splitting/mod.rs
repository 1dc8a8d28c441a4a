//! Symplectic schemes for a body with a fixed point under constant forces: kicks of L by the torque, and between them the
//! free motion, exactly.
//!
//! The energy is T + V, the kinetic energy and the work of the forces. T alone is the free motion (`free_body`); V alone
//! leaves the body where it is and changes L at the constant rate of the torque. Both flows are exact and symplectic, so
//! every composition of them is, and a palindromic one is reversible. T is quadratic in L and V a function of the
//! orientation alone: {V, {V, T}} is then a function of the orientation alone, and {V, {V, {V, T}}} = 0. That is the
//! condition of the Runge-Kutta-Nystroem methods, which therefore keep their orders here, with the free motion in place
//! of the straight one (S. Blanes & P. C. Moan, J. Comput. Appl. Math. 142, 313, 2002; the splitting of a heavy top is
//! in S. Reich, Fields Inst. Commun. 10, 181, 1996, and E. Celledoni et al., SIAM J. Sci. Comput. 30, 2084, 2008).

use nalgebra::{Matrix3, Vector3};

use crate::loads::torque;
use crate::trig::sin_cos;
use crate::workings::{Listener, Nobody, Phase};
use crate::{Body, Loads, Scheme, State};
use damped::DampedStrang;
use free_body::{FreeBody, SymmetricBody, orthonormal};
use principal::SYMMETRY_ROUNDING;
use turn::RotationByVector;

mod damped;
mod free_body;
mod jacobi;
mod phases;
mod principal;
mod turn;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SplittingMethod {
    /// Kick, free motion, kick: order 2 (G. Strang, SIAM J. Numer. Anal. 5, 506, 1968).
    Strang,
    /// Order 6 with 11 free motions: SRKN_11^b of Blanes & Moan.
    Srkn11b,
}

impl SplittingMethod {
    /// Pairs (kick, free motion) in parts of the step; the last kick, which follows them, is the first once more.
    fn stages(self) -> &'static [(f64, f64)] {
        match self {
            Self::Strang => &[(0.5, 1.0)],
            Self::Srkn11b => &srkn11b::STAGES,
        }
    }
}

/// Blanes & Moan (2002), table 3; the middle coefficients from the sums, which must be 1.
mod srkn11b {
    const B: [f64; 5] = [
        0.0414649985182624,
        0.198128671918067,
        -0.0400061921041533,
        0.0752539843015807,
        -0.0115113874206879,
    ];
    const B6: f64 = 0.5 - (B[0] + B[1] + B[2] + B[3] + B[4]);
    const A: [f64; 5] = [
        0.123229775946271,
        0.290553797799558,
        -0.127049212625417,
        -0.246331761062075,
        0.357208872795928,
    ];
    const A6: f64 = 1.0 - 2.0 * (A[0] + A[1] + A[2] + A[3] + A[4]);

    pub const STAGES: [(f64, f64); 11] = [
        (B[0], A[0]),
        (B[1], A[1]),
        (B[2], A[2]),
        (B[3], A[3]),
        (B[4], A[4]),
        (B6, A6),
        (B6, A[4]),
        (B[4], A[3]),
        (B[3], A[2]),
        (B[2], A[1]),
        (B[1], A[0]),
    ];
}

/// A composition as a scheme.
#[derive(Clone, Debug)]
pub struct SplittingScheme {
    body: Body,
    kind: SplittingMethod,
    splitting: Splitting,
    /// Takes the steps where there is friction.
    damped: Option<DampedStrang>,
    /// Work of friction in the step taken last, J.
    work: f64,
}

impl SplittingScheme {
    pub fn new(kind: SplittingMethod, body: &Body) -> Self {
        let splitting = Splitting::new(kind, &body.inertia(), &Loads::default().moment(body));
        Self {
            body: body.clone(),
            kind,
            splitting,
            damped: None,
            work: 0.0,
        }
    }

    #[inline]
    fn advance<L: Listener>(&mut self, dt: f64, state: &mut State, listener: &mut L) {
        match &self.damped {
            None => self.splitting.step(state, dt, listener),
            Some(damped) => self.work = damped.step(state, dt, listener),
        }
    }
}

impl Scheme for SplittingScheme {
    fn start(&mut self, _: &State) {}

    fn load(&mut self, loads: &Loads) {
        self.splitting = Splitting::new(self.kind, &self.body.inertia(), &loads.moment(&self.body));
        self.damped =
            DampedStrang::new(&self.body, loads).filter(|_| self.kind == SplittingMethod::Strang);
        self.work = 0.0;
    }

    fn step(&mut self, dt: f64, state: &mut State) {
        self.advance(dt, state, &mut Nobody);
    }

    fn explain(&mut self, dt: f64, state: &mut State, phases: &mut Vec<Phase>) {
        self.advance(dt, state, phases);
    }

    fn friction_work(&self) -> f64 {
        self.work
    }

    fn boxed(&self) -> Box<dyn Scheme> {
        Box::new(self.clone())
    }
}

/// A composition for one body under constant forces. It keeps nothing from step to step.
#[derive(Clone, Debug)]
struct Splitting {
    stages: &'static [(f64, f64)],
    top: Top,
}

#[derive(Clone, Debug)]
enum Top {
    Axle(AxleTop),
    Any(AnyTop),
}

impl Splitting {
    /// `inertia` as for `FreeBody::new`, `moment` as of [`Loads::moment`].
    fn new(kind: SplittingMethod, inertia: &Matrix3<f64>, moment: &Matrix3<f64>) -> Self {
        let top = match (FreeBody::new(inertia), force_on_axle(moment)) {
            (FreeBody::Symmetric(body), Some(force)) if body.axis == Vector3::z() => {
                Top::Axle(AxleTop { body, force })
            }
            (body, _) => Top::Any(AnyTop {
                body,
                moment: *moment,
            }),
        };
        Self {
            stages: kind.stages(),
            top,
        }
    }

    /// One step of `h` seconds, forwards or backwards. L along a direction in which no force has a part across the others
    /// (the vertical, under vertical forces) keeps every bit.
    #[inline]
    fn step<L: Listener>(&self, state: &mut State, h: f64, listener: &mut L) {
        match &self.top {
            Top::Axle(top) => top.step(self.stages, state, h, listener),
            Top::Any(top) => top.step(self.stages, state, h, listener),
        }
    }
}

/// The third row, if the others are rounding beside it: all forces act on the body's z axis, the axle.
///
/// Why not the wider tolerance of [`symmetry`](crate::symmetry): what is off the axle is dropped here from every
/// kick, so it must be no more than the rounding of the sums.
fn force_on_axle(moment: &Matrix3<f64>) -> Option<Vector3<f64>> {
    let row = |i: usize| moment.row(i).transpose();
    let off = row(0).amax().max(row(1).amax());
    (off <= SYMMETRY_ROUNDING * row(2).amax()).then(|| row(2))
}

/// A body symmetric about its axle, with all forces on the axle: the torque does not see the spin, and the spin commutes
/// with everything else, so that it is done once a step; a free motion is then one rotation about L.
#[derive(Clone, Debug)]
struct AxleTop {
    body: SymmetricBody,
    /// The sum of z F, N m, world frame: the torque is the axle times this.
    force: Vector3<f64>,
}

impl AxleTop {
    #[inline]
    fn step<L: Listener>(
        &self,
        stages: &[(f64, f64)],
        state: &mut State,
        h: f64,
        listener: &mut L,
    ) {
        let mut axle: Vector3<f64> = state.orientation.column(2).into();
        let mut momentum = state.momentum;
        let impulse = axle.dot(&momentum) * h;
        let mut side = self.spun(&state.orientation, impulse);
        listener.hear(|| phases::spin(self.body.excess * impulse, &side));
        // The rounding that the last step left in the length; found here, it is ready long before it is needed.
        let to_unit = inverse_length(&axle);
        for &(kick, free) in stages {
            let change = axle.cross(&(self.force * (kick * h)));
            momentum += change;
            listener.hear(|| phases::axle_kick(kick * h, &self.force, &axle, &change, &momentum));
            let turn = RotationByVector::new(momentum * (self.body.across * (free * h)));
            axle = turn.apply(axle);
            side = turn.apply(side);
            listener.hear(|| phases::axle_turn(free * h, &turn, &axle, &side));
        }
        axle *= to_unit;
        let change = axle.cross(&(self.force * (stages[0].0 * h)));
        state.momentum = momentum + change;
        listener.hear(|| {
            phases::axle_kick(
                stages[0].0 * h,
                &self.force,
                &axle,
                &change,
                &state.momentum,
            )
        });
        side -= axle * axle.dot(&side);
        side *= inverse_length(&side);
        state.orientation = Matrix3::from_columns(&[side, axle.cross(&side), axle]);
        listener.hear(|| phases::put_together(&axle, &side, &state.orientation));
    }

    /// The body's x axis after the spin in excess of the turning about L; `impulse` is L.axle times the time.
    #[inline]
    fn spun(&self, orientation: &Matrix3<f64>, impulse: f64) -> Vector3<f64> {
        let (sine, cosine) = sin_cos(self.body.excess * impulse);
        orientation.column(0) * cosine + orientation.column(1) * sine
    }
}

/// 1 / |v| of a vector that is of unit length but for rounding: one step of Newton's.
#[inline]
fn inverse_length(v: &Vector3<f64>) -> f64 {
    1.5 - 0.5 * v.dot(v)
}

/// Any body under any constant forces.
#[derive(Clone, Debug)]
struct AnyTop {
    body: FreeBody,
    moment: Matrix3<f64>,
}

impl AnyTop {
    fn step<L: Listener>(
        &self,
        stages: &[(f64, f64)],
        state: &mut State,
        h: f64,
        listener: &mut L,
    ) {
        for &(kick, free) in stages {
            self.kick(kick * h, state, listener);
            self.body
                .turn(&mut state.orientation, &state.momentum, free * h);
            listener.hear(|| phases::free_motion(free * h, &state.momentum, &state.orientation));
        }
        state.orientation = orthonormal(&state.orientation);
        listener.hear(|| phases::orthonormal(&state.orientation));
        self.kick(stages[0].0 * h, state, listener);
    }

    #[inline]
    fn kick<L: Listener>(&self, duration_s: f64, state: &mut State, listener: &mut L) {
        let load = torque(&state.orientation, &self.moment);
        state.momentum += load * duration_s;
        listener.hear(|| phases::kick(duration_s, &load, &state.momentum));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    const KINDS: [SplittingMethod; 2] = [SplittingMethod::Strang, SplittingMethod::Srkn11b];

    /// Inertia and moment.
    type Loaded = (Matrix3<f64>, Matrix3<f64>);

    /// Returns a body of equal points under gravity.
    fn loaded(points: &[[f64; 3]], mass_kg: f64) -> Loaded {
        let weight = Vector3::new(0.0, 0.0, -mass_kg * 9.8);
        points
            .iter()
            .map(|x| Vector3::from(*x))
            .fold(Default::default(), |(inertia, moment), x| {
                let own = (Matrix3::identity() * x.dot(&x) - x * x.transpose()) * mass_kg;
                (inertia + own, moment + x * weight.transpose())
            })
    }

    /// Ten points on a rim of 0.8 m at 1 m, four on the axle, 0.5 kg each: I1 = 8.35, I3 = 3.2 kg m^2, 63.7 N m.
    fn heavy_top() -> Loaded {
        let rim = (0..10)
            .map(|j| PI * f64::from(j) / 5.0)
            .map(|a| [0.8 * libm::cos(a), 0.8 * libm::sin(a), 1.0]);
        let axle = [0.0, 0.5, 1.0, 1.5].map(|z| [0.0, 0.0, z]);
        loaded(&rim.chain(axle).collect::<Vec<_>>(), 0.5)
    }

    /// Permutation that renames the body's axes to y, z, x.
    const RENAMED: Matrix3<f64> = Matrix3::new(0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0);

    fn tops() -> [(&'static str, Loaded); 4] {
        // The center of mass is off every axis.
        let lopsided = [
            [0.9, 0.0, 0.7],
            [-0.3, 0.5, 1.1],
            [0.1, -0.6, 0.9],
            [0.2, 0.1, 1.6],
        ];
        let (inertia, moment) = heavy_top();
        let aside = Vector3::new(0.8, 0.0, 1.0) * Vector3::new(3.0, -2.0, -5.0).transpose();
        // The axis of the body is along x, the load still on z.
        let rolled = RENAMED * inertia * RENAMED.transpose();
        [
            ("heavy", (inertia, moment)),
            ("lopsided", loaded(&lopsided, 1.2)),
            ("side load", (inertia, moment + aside)),
            ("load across the axis", (rolled, moment)),
        ]
    }

    /// Returns a state tilted by 45 degrees about +x, with `momentum` in the body frame.
    fn tilted(momentum: [f64; 3]) -> State {
        let c = 0.5_f64.sqrt();
        let orientation = Matrix3::new(1.0, 0.0, 0.0, 0.0, c, -c, 0.0, c, c);
        State {
            time_s: 0.0,
            orientation,
            momentum: orientation * Vector3::from(momentum),
        }
    }

    fn general_start() -> State {
        tilted([2.0, -5.0, 30.0])
    }

    fn run(
        kind: SplittingMethod,
        (inertia, moment): Loaded,
        mut state: State,
        seconds: f64,
        steps: u32,
    ) -> State {
        let scheme = Splitting::new(kind, &inertia, &moment);
        (0..steps).for_each(|_| scheme.step(&mut state, seconds / f64::from(steps), &mut Nobody));
        state
    }

    fn distance(a: &State, b: &State) -> f64 {
        (a.orientation - b.orientation).norm()
            + (a.momentum - b.momentum).norm() / b.momentum.norm()
    }

    /// Computes the order from distances between runs at step ratios 1 : 2 : 4, where rounding and higher orders are negligible.
    #[test]
    fn each_method_has_its_stated_order() {
        for (name, top) in tops() {
            for (kind, named, coarse) in [
                (SplittingMethod::Strang, 2.0, 400),
                (SplittingMethod::Srkn11b, 6.0, 40),
            ] {
                let [a, b, c] = [coarse, 2 * coarse, 4 * coarse]
                    .map(|steps| run(kind, top, general_start(), 2.0, steps));
                let order: f64 = libm::log2(distance(&a, &b) / distance(&b, &c));
                assert!((order - named).abs() < 0.15, "{name}, {kind:?}: {order}");
            }
        }
    }

    /// Runs for 5 s, in which nearby motions separate by less than a factor of 200. Later, the sideways load is chaotic.
    #[test]
    fn stepping_backwards_undoes_stepping_forwards() {
        for (name, top) in tops() {
            for kind in KINDS {
                let start = general_start();
                let there = run(kind, top, start, 5.0, 250);
                let back = run(kind, top, there, -5.0, 250);
                let error = distance(&back, &start);
                assert!(error < 3e-12, "{name}, {kind:?}: {error:e}");
                assert!(distance(&there, &start) > 0.1);
            }
        }
    }

    /// Uses the same top with renamed body axes: x, y, z become y, z, x and z, x, y.
    #[test]
    fn any_axis_can_be_the_axis_of_symmetry() {
        let (start, (inertia, moment)) = (general_start(), heavy_top());
        for kind in KINDS {
            let expected = run(kind, heavy_top(), start, 5.0, 100);
            for names in [RENAMED, RENAMED * RENAMED] {
                let renamed = (names.tr_mul(&inertia) * names, names.tr_mul(&moment));
                let mut state = start;
                state.orientation *= names;
                let mut end = run(kind, renamed, state, 5.0, 100);
                end.orientation *= names.transpose();
                let error = distance(&end, &expected);
                assert!(error < 1e-12, "{kind:?}: {error:e}");
            }
        }
    }
}
