//! The report's scheme (its section 3), to the letter. One step of length dt from positions X and momentum L:
//!
//! 1. I = Σ m (|X|²E − XXᵀ), about the pivot, from the positions as they stand
//! 2. Ω = I⁻¹L
//! 3. R = P + cos(|Ω|dt)(E − P) + sin(|Ω|dt)\[u\]×, P = uuᵀ, u = Ω/|Ω|; |Ω| = 0 turns nothing
//! 4. X ← R X, point by point
//! 5. L ← L + dt Σ X × F, at the *new* positions
//!
//! The points themselves are carried from step to step, as the report carries them. They are visited once a step,
//! two at a time: the pass that turns them also sums the torque (5) and the inertia that the next step begins with
//! (1). Two lanes on every processor, added up in one fixed order, give every machine the same bits; four lanes would
//! want more registers than the baseline x86-64 has, and are slower there.

use super::rotation::AxisAngle;
use super::workings::{Listener, Nobody, Phase};
use super::{Body, Loads, PointForce, Scheme, State};
use nalgebra::{Matrix3, Vector3};
use wide::f64x2;

mod phases;

const LANES: usize = 2;

/// Two points side by side, world frame; places past the last point hold no mass.
#[derive(Clone, Copy, Debug)]
struct Pair {
    x: f64x2,
    y: f64x2,
    z: f64x2,
    mass: f64x2,
}

/// Masses times coordinates and times their products: of two points side by side, or summed over all pairs of points.
#[derive(Clone, Copy, Debug)]
struct Moments {
    x: f64x2,
    y: f64x2,
    z: f64x2,
    xx: f64x2,
    yy: f64x2,
    zz: f64x2,
    xy: f64x2,
    xz: f64x2,
    yz: f64x2,
}

/// Sums over all points, world frame.
#[derive(Clone, Copy, Debug)]
struct Sums {
    /// Σ m X, kg m.
    first_moment: Vector3<f64>,
    /// Σ m XXᵀ, kg m².
    second_moment: Matrix3<f64>,
}

/// The report's scheme; see the module's text.
#[derive(Clone, Debug)]
pub struct Report {
    body: Body,
    points: Vec<Pair>,
    gravity: f64,
    pushes: Vec<PointForce>,
    /// From the positions as they stand: what the next step begins with.
    inertia: Matrix3<f64>,
}

impl Report {
    /// The scheme for `body`.
    pub fn new(body: &Body) -> Self {
        Self {
            body: body.clone(),
            points: Vec::with_capacity(body.points().len().div_ceil(LANES)),
            gravity: 0.0,
            pushes: Vec::new(),
            inertia: body.inertia(),
        }
    }

    /// Where the scheme has carried point `index`, world frame, m.
    pub fn position(&self, index: usize) -> Vector3<f64> {
        let pair = &self.points[index / LANES];
        let lane = index % LANES;
        Vector3::new(
            pair.x.to_array()[lane],
            pair.y.to_array()[lane],
            pair.z.to_array()[lane],
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

    #[inline]
    fn advance<L: Listener>(&mut self, dt: f64, state: &mut State, listener: &mut L) {
        let inertia = self.inertia;
        listener.hear(|| self.inertia_phase());
        let angular_velocity = solve(&inertia, &state.momentum);
        listener.hear(|| phases::velocity_phase(&inertia, &state.momentum, &angular_velocity));
        let turn = AxisAngle::new(&angular_velocity, dt);
        let rotation = turn.map_or_else(Matrix3::identity, |turn| turn.matrix());
        listener.hear(|| phases::axis_phase(&angular_velocity, dt, turn.as_ref()));
        listener.hear(|| phases::rotation_phase(&rotation));
        let before = L::LISTENS.then(|| self.points.clone());
        let sums = turn_points(&mut self.points, &rotation);
        state.orientation = rotation * state.orientation;
        listener.hear(|| self.positions_phase(before.as_deref().unwrap_or_default()));
        let torque = self.torque(&sums.first_moment);
        listener.hear(|| self.torque_phase(&sums.first_moment, &torque));
        let momentum = state.momentum;
        state.momentum += dt * torque;
        listener.hear(|| phases::momentum_phase(dt, &torque, &momentum, &state.momentum));
        self.inertia = inertia_of(&sums.second_moment);
    }
}

impl Scheme for Report {
    fn start(&mut self, state: &State) {
        self.points.clear();
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
        self.inertia = inertia_of(&sums(&self.points).second_moment);
    }

    fn load(&mut self, loads: &Loads) {
        self.gravity = loads.gravity;
        self.pushes.clone_from(&loads.pushes);
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

/// I⁻¹ L for the symmetric positive I, by cofactors: one division, and exact to a few units in the last place for
/// any inertia that [`Body`] lets pass.
fn solve(inertia: &Matrix3<f64>, momentum: &Vector3<f64>) -> Vector3<f64> {
    let (a, b, c) = (inertia[(0, 0)], inertia[(1, 1)], inertia[(2, 2)]);
    let (f, g, h) = (inertia[(1, 2)], inertia[(0, 2)], inertia[(0, 1)]);
    let (aa, bb, cc) = (b * c - f * f, a * c - g * g, a * b - h * h);
    let (ff, gg, hh) = (g * h - a * f, h * f - b * g, f * g - c * h);
    let scale = 1.0 / (a * aa + h * hh + g * gg);
    let (x, y, z) = (momentum.x, momentum.y, momentum.z);
    Vector3::new(
        aa * x + hh * y + gg * z,
        hh * x + bb * y + ff * z,
        gg * x + ff * y + cc * z,
    ) * scale
}

/// Turns every point by `rotation` and adds up what the torque and the next inertia need.
#[inline]
fn turn_points(points: &mut [Pair], rotation: &Matrix3<f64>) -> Sums {
    let r = |row, column| f64x2::splat(rotation[(row, column)]);
    let (r00, r01, r02) = (r(0, 0), r(0, 1), r(0, 2));
    let (r10, r11, r12) = (r(1, 0), r(1, 1), r(1, 2));
    let (r20, r21, r22) = (r(2, 0), r(2, 1), r(2, 2));
    let mut moments = Moments::NONE;
    for pair in points {
        let x = r00 * pair.x + r01 * pair.y + r02 * pair.z;
        let y = r10 * pair.x + r11 * pair.y + r12 * pair.z;
        let z = r20 * pair.x + r21 * pair.y + r22 * pair.z;
        (pair.x, pair.y, pair.z) = (x, y, z);
        moments = moments.and(Moments::of(pair));
    }
    moments.sums()
}

/// The same sums of the points as they stand.
fn sums(points: &[Pair]) -> Sums {
    let all = points.iter().map(Moments::of);
    all.fold(Moments::NONE, Moments::and).sums()
}

/// Σ m (|X|²E − XXᵀ), kg m², from Σ m XXᵀ.
fn inertia_of(second_moment: &Matrix3<f64>) -> Matrix3<f64> {
    let s = |row, column| second_moment[(row, column)];
    let (xx, yy, zz) = (s(0, 0), s(1, 1), s(2, 2));
    let (xy, xz, yz) = (s(0, 1), s(0, 2), s(1, 2));
    Matrix3::new(yy + zz, -xy, -xz, -xy, xx + zz, -yz, -xz, -yz, xx + yy)
}

impl Moments {
    const NONE: Self = {
        let zero = f64x2::ZERO;
        Self {
            x: zero,
            y: zero,
            z: zero,
            xx: zero,
            yy: zero,
            zz: zero,
            xy: zero,
            xz: zero,
            yz: zero,
        }
    };

    #[inline]
    fn of(pair: &Pair) -> Self {
        let (x, y, z) = (pair.x, pair.y, pair.z);
        let (mx, my, mz) = (pair.mass * x, pair.mass * y, pair.mass * z);
        Self {
            x: mx,
            y: my,
            z: mz,
            xx: mx * x,
            yy: my * y,
            zz: mz * z,
            xy: mx * y,
            xz: mx * z,
            yz: my * z,
        }
    }

    #[inline]
    fn and(self, more: Self) -> Self {
        Self {
            x: self.x + more.x,
            y: self.y + more.y,
            z: self.z + more.z,
            xx: self.xx + more.xx,
            yy: self.yy + more.yy,
            zz: self.zz + more.zz,
            xy: self.xy + more.xy,
            xz: self.xz + more.xz,
            yz: self.yz + more.yz,
        }
    }

    #[inline]
    fn sums(self) -> Sums {
        let [x, y, z] = [self.x, self.y, self.z].map(add_up);
        let [xx, yy, zz] = [self.xx, self.yy, self.zz].map(add_up);
        let [xy, xz, yz] = [self.xy, self.xz, self.yz].map(add_up);
        Sums {
            first_moment: Vector3::new(x, y, z),
            second_moment: Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz),
        }
    }
}

/// The sum of both lanes, without the library, whose order may differ between processors.
fn add_up(lanes: f64x2) -> f64 {
    let [a, b] = lanes.to_array();
    a + b
}
