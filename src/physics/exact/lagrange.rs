//! The heavy symmetric top with a fixed point, in closed form.
//!
//! # The motion
//! A body with moments of inertia I1 across its axle and I3 along it, pulled at the axle by a constant load p (N m): the
//! torque about the pivot is a x p, a the axle. Gravity is p = (0, 0, -M g h); any constant force on the axle tilts and
//! stretches it. Against the vertical k = -p/|p|, L.k and L.a and the energy are constant, and u = a.k moves between two
//! roots of a cubic as u1 + (u2 - u1) sn^2(omega t | m).
//!
//! Euler's angles fail where the axle passes the vertical, and the elliptic integrals of the third kind that give them
//! become singular there. The Cayley-Klein parameters do neither. With the quaternion (q0, q1, q2, q3) from the body to a
//! frame with its third axis along k,
//!
//! ```text
//! alpha = q0 + i q3 = cos(tilt/2) exp(i (phi + psi)/2),       |alpha|^2 = (1 + u)/2,
//! beta  = q1 + i q2 = sin(tilt/2) exp(i (phi - psi)/2),       |beta|^2  = (1 - u)/2.
//! ```
//!
//! A body with I3 = I1 under the same load has the same a(t) and L(t); ours only spins about the axle by
//! (1/I3 - 1/I1) L.a more. For that body alpha and beta both solve Lame's equation, alpha'' = (const + c u) alpha with
//! c = |p|/I1, so each is a theta function over a common one, theta(z - i zeta)/theta_4(z), times exp(i mean t). Since
//! |alpha|^2 + |beta|^2 = 1 the common factor is never computed: normalising the pair supplies it. The derivative gives the
//! horizontal part of L, in which the common factor cancels too,
//!
//! ```text
//! (Lx + i Ly) = 2 I1 (alpha beta' - beta alpha'),      ax + i ay = -2 i alpha beta.
//! ```
//!
//! The phase rate of alpha is (l + s)/(2 (1 + u)), of beta (l - s)/(2 (1 - u)), with l = L.k/I1, s = L.a/I1; taken at the
//! turning point where it is smaller, with the theta function's own rate removed, it is the mean one. Every start is an
//! ordinary one: a steady top has one harmonic, a sleeping one beta = 0, the separatrix an infinite period.
//!
//! Source: F. Klein and A. Sommerfeld, Ueber die Theorie des Kreisels, chapter VI; E. T. Whittaker, A Treatise on the
//! Analytical Dynamics of Particles and Rigid Bodies, sections 71-72. The forms used here were derived afresh.

mod start;

use super::phases;
use super::theta::{Harmonics, Lattice, Parity, Wave, Zero};
use super::turning::{Turning, TurningStart};
use crate::trig::round;
use crate::workings::{Listener, Nobody};
use core::f64::consts::TAU;
use nalgebra::{Complex, Matrix3, Quaternion, UnitQuaternion, Vector3};
use start::{InFrame, cayley_klein, frame_along, quaternion, start_in, up};

/// One Cayley-Klein parameter as a function of time.
#[derive(Clone, Copy, Debug)]
pub(super) struct CayleyKleinParameter {
    pub wave: Wave,
    /// Value of the whole at the start divided by that of its sum.
    pub amplitude: Complex<f64>,
    /// Mean rotation with the body's extra spin, turns per second.
    pub turns_per_s: f64,
}

/// The sums of alpha and of beta at one moment.
pub(super) struct CayleyKleinSums {
    /// Amplitude and rotation of each.
    pub turns: [Complex<f64>; 2],
    /// The sum of each without them.
    pub values: [Complex<f64>; 2],
    pub harmonics: [Harmonics; 2],
}

impl CayleyKleinParameter {
    pub fn new(wave: Wave, extra_spin: f64) -> Self {
        Self {
            wave,
            amplitude: Complex::new(1.0, 0.0),
            turns_per_s: (wave.mean + extra_spin) / TAU,
        }
    }

    /// Amplitude and rotation at `t` s after the start, `fraction` of a period from the nearest origin, with that sine and
    /// cosine.
    pub fn turned(&self, t: f64, fraction: f64) -> Complex<f64> {
        let turns = self.turns_per_s * t;
        let (sin, cos) = libm::sincos(TAU * (turns - round(turns)) + self.wave.lag * fraction);
        self.amplitude * Complex::new(cos, sin)
    }
}

impl CayleyKleinSums {
    /// alpha and beta, short of one common real factor.
    #[inline]
    pub fn parameters(&self) -> (Complex<f64>, Complex<f64>) {
        let ([turn_a, turn_b], [value_a, value_b]) = (self.turns, self.values);
        (turn_a * value_a, turn_b * value_b)
    }
}

/// Closed-form motion of a heavy symmetric top about a fixed point, under a constant load on its axle.
///
/// Errors: a few units of rounding in the state, plus t times a few units of rounding of the frequencies. If a top comes
/// within an angle d of upright rest, the time that it stays there depends strongly on its start, and rounding of the start
/// counts 1/d^2 times. (A start near upright rest is accurate to rounding.)
///
/// Source: F. Klein and A. Sommerfeld, Ueber die Theorie des Kreisels, chapter VI.
#[derive(Clone, Debug)]
pub struct LagrangeTop {
    across: f64,
    /// Turns the frame with its third axis along the vertical into the world frame.
    pub(super) vertical: UnitQuaternion<f64>,
    momentum_vertical: f64,
    turning: Turning,
    pub(super) lattice: Lattice,
    /// Time between the start and the turning point the sums are centered on, s.
    pub(super) since_origin: f64,
    starts_low: bool,
    pub(super) alpha: CayleyKleinParameter,
    pub(super) beta: CayleyKleinParameter,
    loaded: bool,
}

impl LagrangeTop {
    /// Makes the top that has this state at t = 0.
    ///
    /// `across`, `along`: moments of inertia about the pivot, across the axle and along it, kg m^2, above zero. `load`: p in
    /// N m, world frame; the torque is axle x p. Zero is a free top. `orientation`: a rotation matrix from body to world
    /// components; its third column is the axle. `momentum`: L about the pivot, J s, world frame.
    ///
    /// Nothing is checked. If a value is not finite, the motion is NaN.
    pub fn new(
        across: f64,
        along: f64,
        load: Vector3<f64>,
        orientation: Matrix3<f64>,
        momentum: Vector3<f64>,
    ) -> Self {
        let axle: Vector3<f64> = orientation.column(2).into();
        let upward = up(load, momentum, axle);
        let vertical = frame_along(upward.normalize());
        let frame = InFrame {
            vertical,
            up: upward,
        };
        let start = start_in(across, load, &frame, axle, momentum);
        let turning = Turning::new(&start);
        let (m, one_minus_m) = turning.parameters(&start);
        let lattice = Lattice::new(m, one_minus_m, 0.5 * turning.whole.sqrt());
        let (since_origin, starts_low) = origin(&turning, &lattice, &start, one_minus_m);
        let extra_spin = 0.5 * (across / along - 1.0) * start.spin_along();
        let (alpha_zero, beta_zero) = zeros(&start, &turning, starts_low);
        let mut top = Self {
            across,
            vertical,
            momentum_vertical: start.spin_vertical * across,
            turning,
            lattice,
            since_origin,
            starts_low,
            alpha: CayleyKleinParameter::new(lattice.wave(alpha_zero), extra_spin),
            beta: CayleyKleinParameter::new(lattice.wave(beta_zero), -extra_spin),
            loaded: start.pull > 0.0,
        };
        top.fit(&start, vertical.inverse() * quaternion(orientation));
        top
    }

    /// Returns the orientation (from body to world components) and L (J s, world frame) at `t` s after the start; `t` may
    /// be negative.
    pub fn at(&self, t: f64) -> (Matrix3<f64>, Vector3<f64>) {
        self.at_heard(t, &mut Nobody)
    }

    /// The same, with each phase told to `listener`.
    pub(super) fn at_heard<L: Listener>(
        &self,
        t: f64,
        listener: &mut L,
    ) -> (Matrix3<f64>, Vector3<f64>) {
        let sums = self.sums_at(t);
        let (alpha, beta) = sums.parameters();
        let norm2 = alpha.norm_sqr() + beta.norm_sqr();
        listener.hear(|| phases::parameters(t, [alpha, beta], norm2));
        let (turn, orientation) = self.turned_by(alpha, beta, norm2);
        listener.hear(|| phases::orientation(&turn, &orientation));
        let level = self.bracket(&sums) * (2.0 * self.across / norm2);
        let in_frame = Vector3::new(level.re, level.im, self.momentum_vertical);
        let momentum = self.vertical * in_frame;
        listener.hear(|| phases::momentum(&in_frame, &momentum));
        (orientation, momentum)
    }

    /// Returns the orientation of [`at`](Self::at) without L, in half the time.
    pub fn orientation_at(&self, t: f64) -> Matrix3<f64> {
        let (alpha, beta) = self.sums_at(t).parameters();
        let norm2 = alpha.norm_sqr() + beta.norm_sqr();
        self.turned_by(alpha, beta, norm2).1
    }

    /// The quaternion that alpha and beta make, as seen from the world, and its rotation matrix.
    #[inline]
    fn turned_by(
        &self,
        alpha: Complex<f64>,
        beta: Complex<f64>,
        norm2: f64,
    ) -> (Quaternion<f64>, Matrix3<f64>) {
        let turn = self.vertical.as_ref() * Quaternion::new(alpha.re, beta.re, beta.im, alpha.im);
        (turn, rotation_matrix(&turn, 1.0 / norm2))
    }

    /// Returns the time from one minimum of the tilt to the next, s. Returns `None` if the tilt does not repeat: for a free
    /// top, on the separatrix, and at rest.
    pub fn nutation_period(&self) -> Option<f64> {
        Some(self.lattice.period).filter(|period| self.loaded && period.is_finite())
    }

    /// Returns the mean rate of precession about the vertical of the load, rad/s (about L for a free top).
    ///
    /// If the axle passes exactly through the vertical, the half turn at each passage does not count.
    pub fn mean_precession(&self) -> f64 {
        self.alpha.wave.mean + self.beta.wave.mean
    }

    /// Returns the smallest and the largest angle of the axle from the vertical (opposite to the load; along L for a free
    /// top), rad.
    pub fn tilt_range(&self) -> (f64, f64) {
        let tilt = |below: f64, above: f64| 2.0 * libm::atan2(below.sqrt(), above.sqrt());
        let t = &self.turning;
        (tilt(t.below_top, t.rise), tilt(t.reach, t.above_bottom))
    }

    /// Both sums at `t` s after the start. Always inlined: what a caller does not use of them need not be stored.
    #[inline(always)]
    fn sums_at(&self, t: f64) -> CayleyKleinSums {
        let since = t + self.since_origin;
        let cells = round(since * self.lattice.per_period);
        // A motion without a period has one cell, and its length must not enter: 0 * infinity is no number.
        let local = if cells == 0.0 {
            since
        } else {
            since - cells * self.lattice.period
        };
        let (a, b) = self.ordered(self.lattice.harmonics(local));
        let fraction = local * self.lattice.per_period;
        CayleyKleinSums {
            turns: [&self.alpha, &self.beta].map(|part| part.turned(t, fraction)),
            values: [self.alpha.wave.value(&a), self.beta.wave.value(&b)],
            harmonics: [a, b],
        }
    }

    /// alpha beta' - beta alpha' (of the body without extra spin), short of the square of the common real factor.
    fn bracket(&self, sums: &CayleyKleinSums) -> Complex<f64> {
        let ([turn_a, turn_b], [value_a, value_b]) = (sums.turns, sums.values);
        let [a, b] = &sums.harmonics;
        let (slope_a, slope_b) = (
            self.alpha.wave.slope(a, value_a),
            self.beta.wave.slope(b, value_b),
        );
        (turn_a * turn_b) * (value_a * slope_b - value_b * slope_a)
    }

    /// Harmonics for alpha and beta: alpha can vanish at the bottom, beta at the top.
    fn ordered(&self, (odd, even): (Harmonics, Harmonics)) -> (Harmonics, Harmonics) {
        if self.starts_low {
            (odd, even)
        } else {
            (even, odd)
        }
    }

    /// Sets both amplitudes from the state at the start.
    ///
    /// The even one never vanishes near the origin, so its value decides. The odd one may be zero at the start, and a small
    /// one may be known better by its rate: both its value and L decide, each by the weight it has (least squares).
    fn fit(&mut self, start: &TurningStart, turn: UnitQuaternion<f64>) {
        let (alpha, beta) = cayley_klein(start, turn);
        let (low, one) = (self.starts_low, Complex::new(1.0, 0.0));
        (self.alpha.amplitude, self.beta.amplitude) = (one, one);
        let sums = self.sums_at(0.0);
        let ((sum_a, sum_b), bracket) = (sums.parameters(), self.bracket(&sums));
        let (odd, odd_sum, even, even_sum) = if low {
            (alpha, sum_a, beta, sum_b)
        } else {
            (beta, sum_b, alpha, sum_a)
        };
        let even_amplitude = even / even_sum;
        let rate = self.lattice.rate + self.alpha.wave.local.abs() + self.beta.wave.local.abs();
        let weight = if rate > 0.0 { 1.0 / rate } else { 0.0 };
        let moving = even_amplitude * bracket * (2.0 * weight);
        let size = odd_sum.norm_sqr() + moving.norm_sqr();
        let product = odd_sum.conj() * odd + moving.conj() * start.spin * weight;
        let odd_amplitude = if size > 0.0 {
            product / size
        } else {
            Complex::new(0.0, 0.0)
        };
        (self.alpha.amplitude, self.beta.amplitude) = if low {
            (odd_amplitude, even_amplitude)
        } else {
            (even_amplitude, odd_amplitude)
        };
    }
}

/// Time from the turning point nearer to the start (negative before it), s, and whether that is the lower one.
fn origin(
    turning: &Turning,
    lattice: &Lattice,
    start: &TurningStart,
    one_minus_m: f64,
) -> (f64, bool) {
    let (above, below) = (turning.start_above, turning.start_below);
    let direction = if start.climb() < 0.0 { -1.0 } else { 1.0 };
    if turning.swing <= 0.0 {
        return (0.0, true);
    }
    let low = above * one_minus_m.sqrt() <= below && below > 0.0;
    let time = if low {
        direction * lattice.time_at(above, below)
    } else if below > 0.0 {
        -direction * lattice.time_at(below, one_minus_m * above)
    } else {
        0.0
    };
    (time, low)
}

/// Where alpha and beta vanish off the real axis; both from the gaps between the roots of the cubic.
fn zeros(start: &TurningStart, t: &Turning, starts_low: bool) -> (Zero, Zero) {
    let two_c = 2.0 * start.pull;
    let parity = |low: bool| {
        if low == starts_low {
            Parity::Odd
        } else {
            Parity::Even
        }
    };
    let rate = |twice: f64, gap: f64| {
        if gap > 0.0 {
            0.5 * twice.abs() / gap
        } else {
            0.0
        }
    };
    let alpha = Zero {
        parity: parity(true),
        sin2: t.above_bottom,
        cos2: t.swing,
        co_sin2: t.whole,
        co_cos2: two_c * t.above_bottom,
        rate: rate(start.spin_sum(), t.rise),
        sign: sign(start.spin_sum()),
    };
    let beta = Zero {
        parity: parity(false),
        sin2: t.below_top * t.whole,
        cos2: t.beyond_top * t.swing,
        co_sin2: t.beyond_top,
        co_cos2: two_c * t.below_top,
        rate: rate(start.spin_difference(), t.reach),
        sign: sign(start.spin_difference()),
    };
    (alpha, beta)
}

fn sign(x: f64) -> f64 {
    if x < 0.0 { -1.0 } else { 1.0 }
}

/// Rotation matrix of a quaternion with squared length 1/`scale`.
fn rotation_matrix(q: &Quaternion<f64>, scale: f64) -> Matrix3<f64> {
    let (w, x, y, z) = (q.w, q.i, q.j, q.k);
    let s = 2.0 * scale;
    let (xx, yy, zz) = (s * x * x, s * y * y, s * z * z);
    let (xy, xz, yz) = (s * x * y, s * x * z, s * y * z);
    let (wx, wy, wz) = (s * w * x, s * w * y, s * w * z);
    #[rustfmt::skip]
    let matrix = Matrix3::new(
        1.0 - (yy + zz), xy - wz, xz + wy,
        xy + wz, 1.0 - (xx + zz), yz - wx,
        xz - wy, yz + wx, 1.0 - (xx + yy),
    );
    matrix
}
