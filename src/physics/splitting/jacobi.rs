//! The elliptic functions of a free rigid body.
//!
//! Jacobi's functions enter as S(t), the solution of (dS/dt)^2 = (1 - p S^2)(1 - q S^2) with S(0) = 0, dS/dt(0) = 1,
//! that is S = sn(sqrt(p) t) / sqrt(p) with the modulus k^2 = q/p; and C = sqrt(1 - p S^2) = cn, D = sqrt(1 - q S^2) = dn.
//! In this form p and q are equals: it does not matter which is the larger, nothing happens where they pass each other
//! (k = 1, the separatrix), and p = q = 0 is S = t.

use crate::trig::sin_cos;

/// The levels of the arithmetic-geometric mean: it converges quadratically, even from 1 and 1e-150 in eleven.
const LEVELS: usize = 16;

/// S, C and D at one time, and what brings the time into the first half period.
#[derive(Clone, Copy, Debug)]
pub struct Jacobi {
    pub s: f64,
    pub c: f64,
    pub d: f64,
    /// The number of half periods, 2K / sqrt(p), nearest to the time.
    pub half_periods: f64,
}

impl Jacobi {
    /// At time `t` for p, q >= 0 and `difference` = p - q, which the caller may know to more digits than a subtraction gives.
    ///
    /// The descending Gauss transformation (DLMF 22.7(i)): with the means a_n, b_n of a^2 = p, b^2 = p - q,
    /// S_n = S_{n+1} / (1 + g), C_n = C_{n+1} D_{n+1} / (1 + g), D_n = (1 - g) / (1 + g), where
    /// g = (a_n^2 - b_n^2) / 4 S_{n+1}^2; down where a_n = b_n it is S = sin(a t) / a.
    pub fn new(t: f64, p: f64, q: f64, difference: f64) -> Self {
        if difference < 0.0 {
            let swapped = Self::new(t, q, p, -difference);
            return Self {
                c: swapped.d,
                d: swapped.c,
                ..swapped
            };
        }
        if p == 0.0 {
            return Self {
                s: t,
                c: 1.0,
                d: 1.0,
                half_periods: 0.0,
            };
        }
        let mut a = p.sqrt();
        // On the separatrix the mean would creep to zero; this k' is felt after 350 e-folds only.
        let mut b = difference.sqrt().max(1e-150 * a);
        let mut levels = [(0.0, 0.0); LEVELS];
        let mut depth = 0;
        // Quadratic convergence: a level that begins with a difference of 1e-8 ends with 1e-17.
        let mut apart = true;
        while apart && depth < LEVELS {
            apart = a - b > 1e-8 * a;
            let mean = 0.5 * (a + b);
            levels[depth] = (mean * (0.5 * (a - b)), mean * b);
            (a, b) = (mean, (a * b).sqrt());
            depth += 1;
        }
        let phase = a * t;
        let (sine, c) = sin_cos(phase);
        let bottom = Self {
            s: sine / a,
            c,
            d: 1.0,
            half_periods: (phase / std::f64::consts::PI).round(),
        };
        levels[..depth]
            .iter()
            .rev()
            .fold(bottom, |below, level| below.up(*level))
    }

    /// One level up. 1 - g is written as a sum of positive terms, C^2 + a_{n+1} b_n S^2: near the separatrix D is small.
    fn up(self, (gain, rest): (f64, f64)) -> Self {
        let square = self.s * self.s;
        let scale = 1.0 / (1.0 + gain * square);
        Self {
            s: self.s * scale,
            c: self.c * self.d * scale,
            d: (self.c * self.c + rest * square) * scale,
            half_periods: self.half_periods,
        }
    }
}

/// Carlson's symmetric elliptic integral R_J(x, y, z, p) for x, y, z >= 0, at most one of them 0, and p > 0.
///
/// Duplication until the fifth-order series holds to rounding: B. C. Carlson, Numerical computation of real or complex
/// elliptic integrals, Numer. Algorithms 10, 13 (1995), algorithm 3; the series is DLMF 19.36.2.
pub fn carlson_rj(x: f64, y: f64, z: f64, p: f64) -> f64 {
    let start = 0.2 * (x + y + z + 2.0 * p);
    let spread = [x, y, z, p]
        .iter()
        .fold(0.0_f64, |most, v| most.max((start - v).abs()));
    let product = (p - x) * (p - y) * (p - z);
    let (mut x_n, mut y_n, mut z_n, mut p_n, mut mean) = (x, y, z, p, start);
    let (mut quarter, mut sum) = (1.0, 0.0);
    // The neglected terms are of the eighth order: (1/100)^8 = 1e-16.
    while quarter * spread > 0.01 * mean {
        let (rx, ry, rz, rp) = (x_n.sqrt(), y_n.sqrt(), z_n.sqrt(), p_n.sqrt());
        let shift = rx * ry + rx * rz + ry * rz;
        let d = (rp + rx) * (rp + ry) * (rp + rz);
        sum += quarter / d * arc(quarter * quarter * quarter * product / (d * d));
        quarter *= 0.25;
        (x_n, y_n, z_n, p_n) = (
            0.25 * (x_n + shift),
            0.25 * (y_n + shift),
            0.25 * (z_n + shift),
            0.25 * (p_n + shift),
        );
        mean = 0.25 * (mean + shift);
    }
    let part = |v: f64| (start - v) * quarter / mean;
    6.0 * sum + quarter * rj_series(part(x), part(y), part(z)) / (mean * mean.sqrt())
}

/// R_C(1, 1 + e) = atan(sqrt(e)) / sqrt(e), e >= 0.
fn arc(e: f64) -> f64 {
    if e < 1e-3 {
        return 1.0
            + e * (-1.0 / 3.0 + e * (1.0 / 5.0 + e * (-1.0 / 7.0 + e * (1.0 / 9.0 - e / 11.0))));
    }
    let root = e.sqrt();
    libm::atan(root) / root
}

/// DLMF 19.36.2, all terms to the seventh order.
fn rj_series(x: f64, y: f64, z: f64) -> f64 {
    let p = -0.5 * (x + y + z);
    let xyz = x * y * z;
    let e2 = x * y + x * z + y * z - 3.0 * p * p;
    let e3 = xyz + 2.0 * e2 * p + 4.0 * p * p * p;
    let e4 = (2.0 * xyz + e2 * p + 3.0 * p * p * p) * p;
    let e5 = xyz * p * p;
    1.0 - 3.0 / 14.0 * e2 + e3 / 6.0 + 9.0 / 88.0 * e2 * e2 - 3.0 / 22.0 * e4 - 9.0 / 52.0 * e2 * e3
        + 3.0 / 26.0 * e5
        - e2 * e2 * e2 / 16.0
        + 3.0 / 40.0 * e3 * e3
        + 3.0 / 20.0 * e2 * e4
        + 45.0 / 272.0 * e2 * e2 * e3
        - 9.0 / 68.0 * (e3 * e4 + e2 * e5)
}
