//! The closed form at many times at once: where one point of the body is, within a few units of rounding.
//!
//! What takes the time of [`LagrangeTop::orientation_at`] are sines to the last bit, and choices which depend on the angle.
//! Here every time goes through the same operations, without a choice: angles are reduced to one turn, their fourth part
//! lies where the polynomials hold, and two doublings lead back. So the processor takes several times together.

use super::lagrange::{CayleyKleinParameter, LagrangeTop};
use crate::trig::kernels;
use core::f64::consts::FRAC_PI_2;
use nalgebra::{Complex, Matrix3, Vector3};

/// So many times are taken at once.
pub const AT_ONCE: usize = 8;

/// Adding and subtracting 1.5 * 2^52 rounds to the nearest integer, below 2^51.
const POSITION_ROUNDER: f64 = 6755399441055744.0;
/// With more cells or turns than this there is no place in a turn left to be found.
const MOST_PHASE_TURNS: f64 = 1e12;

impl LagrangeTop {
    /// Where the point `at` of the body (body frame, m) is at `times`, s after the start: x, y and z, m, world frame, within
    /// 3e-15 of its distance from the pivot of where [`orientation_at`](Self::orientation_at) has it, in less time. `None`
    /// where the motion has no sines (near the separatrix), or a time is out of all proportion.
    pub fn positions_near(
        &self,
        at: &Vector3<f64>,
        times: &[f64; AT_ONCE],
    ) -> Option<[[f64; AT_ONCE]; 3]> {
        let per_s = (self.alpha.turns_per_s.abs())
            .max(self.beta.turns_per_s.abs())
            .max(self.lattice.per_period);
        let latest = times.iter().fold(0.0_f64, |latest, t| latest.max(t.abs()));
        if self.lattice.pulsed || (latest + self.since_origin.abs()) * per_s > MOST_PHASE_TURNS {
            return None;
        }
        let period = if self.lattice.per_period == 0.0 {
            0.0
        } else {
            // it is none, and there is one cell
            self.lattice.period
        };
        let vertical = self.vertical.to_rotation_matrix();
        let mut positions = [[0.0; AT_ONCE]; 3];
        for (place, t) in times.iter().enumerate() {
            let position = self.position_near(*t, period, at, vertical.matrix());
            for axis in 0..3 {
                positions[axis][place] = position[axis];
            }
        }
        Some(positions)
    }

    #[inline(always)]
    fn position_near(
        &self,
        t: f64,
        period: f64,
        at: &Vector3<f64>,
        vertical: &Matrix3<f64>,
    ) -> Vector3<f64> {
        let since = t + self.since_origin;
        let local = since - whole(since * self.lattice.per_period) * period;
        let (sin, cos) = doubled_twice(0.5 * self.lattice.rate * local);
        let [alpha, beta] =
            [&self.alpha, &self.beta].map(|part| parameter(part, part.turns_per_s * t, sin, cos));
        let norm2 = alpha.norm_sqr() + beta.norm_sqr();
        // The turn of `at` by the quaternion (alpha.re, beta.re, beta.im, alpha.im), whose square is norm2.
        let axis = Vector3::new(beta.re, beta.im, alpha.im);
        let across = axis.cross(at);
        let turned = (across * alpha.re + axis.cross(&across)) * (2.0 / norm2);
        vertical * (at + turned)
    }
}

/// Alpha or beta short of a common real factor, after so many turns, where twice the argument of its sum has this sine and
/// cosine. A sum of harmonics has no [lag](super::theta::Wave::lag).
#[inline(always)]
fn parameter(part: &CayleyKleinParameter, turns: f64, sin: f64, cos: f64) -> Complex<f64> {
    let (turn_sin, turn_cos) = doubled_twice(FRAC_PI_2 * (turns - whole(turns)));
    part.amplitude * Complex::new(turn_cos, turn_sin) * part.wave.value_at(sin, cos)
}

/// The nearest whole number, of halves either one.
#[inline(always)]
fn whole(x: f64) -> f64 {
    (x + POSITION_ROUNDER) - POSITION_ROUNDER
}

/// Sine and cosine of four times `quarter`, |`quarter`| up to π/4.
#[inline(always)]
fn doubled_twice(quarter: f64) -> (f64, f64) {
    let (s, c) = kernels(quarter, 0.0);
    let (s2, c2) = (2.0 * s * c, 1.0 - 2.0 * s * s);
    (2.0 * s2 * c2, 1.0 - 2.0 * s2 * s2)
}
