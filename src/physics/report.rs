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

use super::{Body, Loads, PointForce, Scheme, State, Workings, rotation};
use nalgebra::{Matrix3, Vector3};
use wide::f64x2;

const LANES: usize = 2;

/// Two points side by side, world frame; places past the last point hold no mass.
#[derive(Clone, Copy, Debug)]
struct Pair {
    x: f64x2,
    y: f64x2,
    z: f64x2,
    mass: f64x2,
}

/// Sums over all points, world frame.
#[derive(Clone, Copy, Debug)]
struct Sums {
    /// Σ m X, kg m.
    first_moment: Vector3<f64>,
    /// Σ m (|X|²E − XXᵀ), kg m².
    inertia: Matrix3<f64>,
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
    last: Workings,
}

impl Report {
    /// The scheme for `body`.
    pub fn new(body: &Body) -> Self {
        let nothing = Workings {
            inertia: Matrix3::zeros(),
            angular_velocity: Vector3::zeros(),
            rotation: Matrix3::identity(),
            torque: Vector3::zeros(),
        };
        Self {
            body: body.clone(),
            points: Vec::with_capacity(body.points().len().div_ceil(LANES)),
            gravity: 0.0,
            pushes: Vec::new(),
            inertia: body.inertia(),
            last: nothing,
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

    /// Σ X × F, N m, from Σ m X and the pushed points: weight has no moment about z, so L_z keeps its bits.
    fn torque(&self, first_moment: &Vector3<f64>) -> Vector3<f64> {
        let gravity = Vector3::new(
            -self.gravity * first_moment.y,
            self.gravity * first_moment.x,
            0.0,
        );
        self.pushes.iter().fold(gravity, |sum, push| {
            sum + self.position(push.point).cross(&push.force)
        })
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
        self.inertia = turn(&mut self.points, &Matrix3::identity()).inertia;
    }

    fn load(&mut self, loads: &Loads) {
        self.gravity = loads.gravity;
        self.pushes.clone_from(&loads.pushes);
    }

    fn step(&mut self, dt: f64, state: &mut State) {
        let inertia = self.inertia;
        let angular_velocity = solve(&inertia, &state.momentum);
        let rotation = rotation::about(&angular_velocity, dt);
        let sums = turn(&mut self.points, &rotation);
        let torque = self.torque(&sums.first_moment);
        state.orientation = rotation * state.orientation;
        state.momentum += dt * torque;
        self.inertia = sums.inertia;
        self.last = Workings {
            inertia,
            angular_velocity,
            rotation,
            torque,
        };
    }

    fn workings(&self) -> Option<Workings> {
        Some(self.last)
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
fn turn(points: &mut [Pair], rotation: &Matrix3<f64>) -> Sums {
    let r = |row, column| f64x2::splat(rotation[(row, column)]);
    let (r00, r01, r02) = (r(0, 0), r(0, 1), r(0, 2));
    let (r10, r11, r12) = (r(1, 0), r(1, 1), r(1, 2));
    let (r20, r21, r22) = (r(2, 0), r(2, 1), r(2, 2));
    let zero = f64x2::splat(0.0);
    let [
        mut sx,
        mut sy,
        mut sz,
        mut xx,
        mut yy,
        mut zz,
        mut xy,
        mut xz,
        mut yz,
    ] = [zero; 9];
    for pair in points {
        let x = r00 * pair.x + r01 * pair.y + r02 * pair.z;
        let y = r10 * pair.x + r11 * pair.y + r12 * pair.z;
        let z = r20 * pair.x + r21 * pair.y + r22 * pair.z;
        let (mx, my, mz) = (pair.mass * x, pair.mass * y, pair.mass * z);
        (sx, sy, sz) = (sx + mx, sy + my, sz + mz);
        (xx, yy, zz) = (xx + mx * x, yy + my * y, zz + mz * z);
        (xy, xz, yz) = (xy + mx * y, xz + mx * z, yz + my * z);
        (pair.x, pair.y, pair.z) = (x, y, z);
    }
    let [xx, yy, zz, xy, xz, yz] = [xx, yy, zz, xy, xz, yz].map(add_up);
    Sums {
        first_moment: Vector3::new(add_up(sx), add_up(sy), add_up(sz)),
        inertia: Matrix3::new(yy + zz, -xy, -xz, -xy, xx + zz, -yz, -xz, -yz, xx + yy),
    }
}

/// The sum of both lanes, without the library, whose order may differ between processors.
fn add_up(lanes: f64x2) -> f64 {
    let [a, b] = lanes.to_array();
    a + b
}
