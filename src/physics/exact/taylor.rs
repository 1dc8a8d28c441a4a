//! Any rigid body about a fixed point, under any constant forces: a Taylor series held to rounding.
//!
//! With the orientation as a quaternion q (body to world, rotation matrix Q) and L in the world frame,
//!
//! ```text
//! dq/dt = q w / 2,      w = I^-1 Q^T L  (body frame),      dL_i/dt = sum_jk eps_ijk (Q M)_jk,
//! ```
//!
//! where M = sum over the forces of (body point)(world force)^T. Every right side is a polynomial in q and L, so that each
//! Taylor coefficient follows from the lower ones by Cauchy products, and no derivative is ever formed by hand. The step
//! follows from the last two coefficients. Since q' is always across q, the exact series keeps |q| = 1; setting |q| to 1
//! after a step takes out rounding alone and leaves the order as it is. Friction adds a torque that is a polynomial too,
//! piece by piece (`sliding`).
//!
//! Source: A. Jorba and M. Zou, A software package for the numerical integration of ODEs by means of high-order Taylor
//! methods, Experimental Mathematics 14 (2005) 99-117.

use super::series::{SERIES_ORDER, convolve};
use super::sliding::{FrictionCoefficients, FrictionStart, Sliding};
use crate::Damping;
use crate::loads::axial;
use nalgebra::{Matrix3, Quaternion, Rotation3, UnitQuaternion, Vector3};

/// Size of the last term of a step against the whole: below rounding, so that rounding alone is left.
const LAST_TERM: f64 = f64::EPSILON / 16.0;
/// The most series on the way to one time: with 1 to 3 rad to a series less than a second's work, which nothing interrupts.
const MOST_TAYLOR_SERIES: u32 = 200_000;

/// Motion of a rigid body about a fixed point under constant forces at body points, integrated to rounding.
///
/// Errors: about 1e-15 per radian turned. If the motion separates neighboring starts, the errors grow as much.
///
/// Source: A. Jorba and M. Zou, Experimental Mathematics 14 (2005) 99-117.
#[derive(Clone, Debug)]
pub struct AccurateMotion {
    inverse_inertia: Matrix3<f64>,
    moment: Matrix3<f64>,
    momentum_unit: f64,
    /// The center of the series.
    pub(super) time: f64,
    /// How far from `time` the series holds, s, to either side.
    radius: f64,
    turn: [Quaternion<f64>; SERIES_ORDER + 1],
    momentum: [Vector3<f64>; SERIES_ORDER + 1],
    /// What rounding has kept out of `momentum[0]`. A fast top turns an error of L into an angle that grows with time.
    carry: Vector3<f64>,
    pub(super) friction: Option<Box<Rubbing>>,
    pub(super) gave_up: bool,
}

/// Friction, and where to go back to: what it has stopped cannot be followed backwards.
#[derive(Clone, Debug)]
pub(super) struct Rubbing {
    sliding: Sliding,
    /// Centres of the series so far, every `apart`-th of them; the first is the start.
    centres: Vec<Center>,
    apart: u64,
    /// How many series there have been before this one.
    count: u64,
    /// Where in the series it was asked for last, s from the center.
    asked_s: f64,
}

/// Where a series begins.
#[derive(Clone, Copy, Debug)]
struct Center {
    count: u64,
    time: f64,
    turn: Quaternion<f64>,
    momentum: Vector3<f64>,
    carry: Vector3<f64>,
    friction: FrictionStart,
}

/// The most centres that are kept.
const MOST_CENTRES: usize = 512;

impl AccurateMotion {
    /// Makes the motion that has this state at t = 0.
    ///
    /// `inertia`: about the pivot, body frame, kg m^2. `moment`: sum of (body point, m)(world force, N)^T, N m; gravity is
    /// one force at the center of mass. `orientation`: rotation matrix from body to world components. `momentum`: L about
    /// the pivot, world frame, J s.
    ///
    /// Returns `None` if the inertia is not positive definite (all masses on one line), or if a number is not finite.
    pub fn new(
        inertia: Matrix3<f64>,
        moment: Matrix3<f64>,
        orientation: Matrix3<f64>,
        momentum: Vector3<f64>,
    ) -> Option<Self> {
        Self::damped(inertia, moment, orientation, momentum, None)
    }

    /// Like [`new`](Self::new), with friction. `damping` must be of this body.
    pub(super) fn damped(
        inertia: Matrix3<f64>,
        moment: Matrix3<f64>,
        orientation: Matrix3<f64>,
        momentum: Vector3<f64>,
        damping: Option<Damping>,
    ) -> Option<Self> {
        let matrices = [inertia, moment, orientation];
        let mut numbers = matrices.iter().flatten().chain(&momentum);
        if !numbers.all(|number| number.is_finite()) {
            return None;
        }
        let turn =
            UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(orientation));
        let mut motion = Self {
            inverse_inertia: inertia.cholesky()?.inverse(),
            moment,
            momentum_unit: momentum.norm() + (moment.norm() * inertia.norm()).sqrt(),
            time: 0.0,
            radius: 0.0,
            turn: [Quaternion::new(0.0, 0.0, 0.0, 0.0); SERIES_ORDER + 1],
            momentum: [Vector3::zeros(); SERIES_ORDER + 1],
            carry: Vector3::zeros(),
            friction: damping.map(|damping| Box::new(Rubbing::new(damping, moment))),
            gave_up: false,
        };
        motion.expand(*turn.as_ref(), momentum);
        Some(motion)
    }

    /// Returns the work of friction from the start to the last requested time, J.
    pub(super) fn friction_work(&self) -> f64 {
        let rubbing = self.friction.as_ref();
        rubbing.map_or(0.0, |rubbing| rubbing.sliding.work(rubbing.asked_s))
    }

    /// Returns the orientation (from body to world components) and L (J s, world frame) at `t` s after the start.
    ///
    /// Times in increasing order cost one short polynomial each. An earlier time is integrated backwards or, with friction,
    /// forwards from a stored state.
    ///
    /// The result is NaN if `t` is not finite, if it is so large that its rounding is a large angle of the body, or, with
    /// friction, if it is negative. If the body turns by more than 2e5 to 6e5 rad since the last requested time, the motion
    /// gives up: this and all later results are NaN.
    pub fn state_at(&mut self, t: f64) -> (Matrix3<f64>, Vector3<f64>) {
        if t < self.time || t - self.time > self.radius {
            self.go_to_centre(t);
        }
        let mut left = MOST_TAYLOR_SERIES;
        while (t - self.time).abs() > self.radius {
            self.gave_up |= left == 0;
            left = left.saturating_sub(1);
            if self.gave_up || !self.step_towards(t) {
                return (Matrix3::repeat(f64::NAN), Vector3::repeat(f64::NAN));
            }
        }
        let (turn, change) = self.evaluate(t - self.time);
        if let Some(rubbing) = &mut self.friction {
            rubbing.asked_s = t - self.time;
        }
        (
            rotation(turn.normalize()),
            self.momentum[0] + (change + self.carry),
        )
    }

    /// One step; false if time would stand still.
    fn step_towards(&mut self, t: f64) -> bool {
        let next = self.time + self.radius.copysign(t - self.time);
        // The step is what the sum became, not what it was meant to be: no error of time builds up.
        let step = next - self.time;
        if step == 0.0 || !t.is_finite() || (step < 0.0 && self.friction.is_some()) {
            return false;
        }
        let (turn, change_of_step) = self.evaluate(step);
        let change = change_of_step + self.carry;
        let momentum = self.momentum[0] + change;
        self.carry = change - (momentum - self.momentum[0]);
        self.time = next;
        if let Some(rubbing) = &mut self.friction {
            rubbing.count += 1;
            rubbing.sliding.go_on_from(step);
        }
        self.expand(turn.normalize(), momentum);
        true
    }

    /// With friction, goes to the last center that was kept before `t`, unless `t` is ahead and this one is as near.
    fn go_to_centre(&mut self, t: f64) {
        let Some(rubbing) = &mut self.friction else {
            return;
        };
        let before = rubbing.centres.partition_point(|center| center.time <= t);
        let Some(&center) = rubbing.centres.get(before.saturating_sub(1)) else {
            return;
        };
        if t >= self.time && center.count <= rubbing.count {
            return;
        }
        rubbing.count = center.count;
        rubbing.sliding.go_back(center.friction);
        (self.time, self.carry) = (center.time, center.carry);
        self.expand(center.turn, center.momentum);
    }

    /// The quaternion, and the change of L, at `t` s from the center of the series, by Horner's rule.
    fn evaluate(&self, t: f64) -> (Quaternion<f64>, Vector3<f64>) {
        let (mut turn, mut momentum) = (self.turn[SERIES_ORDER], self.momentum[SERIES_ORDER]);
        for k in (1..SERIES_ORDER).rev() {
            turn = turn * t + self.turn[k];
            momentum = momentum * t + self.momentum[k];
        }
        (turn * t + self.turn[0], momentum * t)
    }

    /// All coefficients from the state at the center, and with them the radius.
    fn expand(&mut self, turn: Quaternion<f64>, momentum: Vector3<f64>) {
        let mut spin = [Vector3::zeros(); SERIES_ORDER];
        let mut matrix = [Matrix3::zeros(); SERIES_ORDER];
        (self.turn[0], self.momentum[0]) = (turn, momentum);
        if let Some(rubbing) = &mut self.friction {
            rubbing.keep(self.time, turn, momentum, self.carry);
            let series = &mut self.momentum[0];
            rubbing
                .sliding
                .begin(&rotation(turn), series, self.momentum_unit);
        }
        for k in 0..SERIES_ORDER {
            matrix[k] = convolve(k, |i, j| product_matrix(&self.turn[i], &self.turn[j]));
            spin[k] =
                self.inverse_inertia * convolve(k, |i, j| matrix[i].tr_mul(&self.momentum[j]));
            let rate = convolve(k, |i, j| times_vector(&self.turn[i], &spin[j]));
            let next = (k + 1) as f64;
            self.turn[k + 1] = rate * 0.5 / next;
            let torque = axial(&(matrix[k] * self.moment));
            let torque = match &mut self.friction {
                None => torque,
                Some(rubbing) => {
                    let (matrix, omega) = (&matrix[..=k], &spin[..=k]);
                    torque
                        + rubbing
                            .sliding
                            .coefficient(k, &FrictionCoefficients { matrix, omega })
                }
            };
            self.momentum[k + 1] = torque / next;
        }
        self.radius = self.reach(SERIES_ORDER - 1).min(self.reach(SERIES_ORDER));
        if let Some(rubbing) = &mut self.friction
            && let Some(event) = rubbing.sliding.find_event(self.radius)
        {
            self.radius = event;
        }
    }

    /// Distance at which term `k` falls to `LAST_TERM` of the state, s.
    fn reach(&self, k: usize) -> f64 {
        let momentum = self.momentum[k].norm();
        let momentum = if momentum > 0.0 {
            momentum / self.momentum_unit
        } else {
            0.0
        };
        let size = self.turn[k].norm().max(momentum);
        libm::pow(LAST_TERM / size, 1.0 / k as f64)
    }
}

impl Rubbing {
    fn new(damping: Damping, moment: Matrix3<f64>) -> Self {
        Self {
            sliding: Sliding::new(damping, moment),
            centres: Vec::new(),
            apart: 1,
            count: 0,
            asked_s: 0.0,
        }
    }

    /// Keeps the center of the series that begins, if its turn has come and it is not kept yet.
    fn keep(
        &mut self,
        time: f64,
        turn: Quaternion<f64>,
        momentum: Vector3<f64>,
        carry: Vector3<f64>,
    ) {
        let is_kept = self
            .centres
            .last()
            .is_some_and(|last| last.count >= self.count);
        if is_kept || !self.count.is_multiple_of(self.apart) {
            return;
        }
        if self.centres.len() == MOST_CENTRES {
            self.apart *= 2;
            let apart = self.apart;
            self.centres
                .retain(|center| center.count.is_multiple_of(apart));
            if !self.count.is_multiple_of(apart) {
                return;
            }
        }
        self.centres.push(Center {
            count: self.count,
            time,
            turn,
            momentum,
            carry,
            friction: self.sliding.before(),
        });
    }
}

/// The rotation matrix as a bilinear form of two quaternions, half of the symmetric one; summed over both it is the matrix.
fn product_matrix(p: &Quaternion<f64>, q: &Quaternion<f64>) -> Matrix3<f64> {
    let (ww, xx, yy, zz) = (p.w * q.w, p.i * q.i, p.j * q.j, p.k * q.k);
    let (xy, xz, yz) = (2.0 * p.i * q.j, 2.0 * p.i * q.k, 2.0 * p.j * q.k);
    let (wx, wy, wz) = (2.0 * p.w * q.i, 2.0 * p.w * q.j, 2.0 * p.w * q.k);
    #[rustfmt::skip]
    let matrix = Matrix3::new(
        ww + xx - yy - zz, xy - wz, xz + wy,
        xy + wz, ww - xx + yy - zz, yz - wx,
        xz - wy, yz + wx, ww - xx - yy + zz,
    );
    matrix
}

/// q (0, v), for v in the body frame.
fn times_vector(q: &Quaternion<f64>, v: &Vector3<f64>) -> Quaternion<f64> {
    Quaternion::new(
        -(q.i * v.x + q.j * v.y + q.k * v.z),
        q.w * v.x + q.j * v.z - q.k * v.y,
        q.w * v.y + q.k * v.x - q.i * v.z,
        q.w * v.z + q.i * v.y - q.j * v.x,
    )
}

fn rotation(q: Quaternion<f64>) -> Matrix3<f64> {
    product_matrix(&q, &q)
}
