//! Elliptic integrals of the first kind, complete by Gauss's mean and incomplete by Carlson's duplication.
//!
//! Moduli come as pairs of parts that are known to full *relative* accuracy (`m` and `1 - m`, squared sine and squared
//! cosine), because near a steady or a sleeping top one of the two is far below the rounding of the other.

use core::f64::consts::PI;

/// K(m) = F(pi/2 | m), from the complementary parameter `1 - m` in 0..=1. Infinite at 0.
///
/// Source: Gauss, K = pi / (2 agm(1, sqrt(1 - m))); DLMF 19.8.5.
pub fn complete(one_minus_m: f64) -> f64 {
    if one_minus_m <= 0.0 {
        return f64::INFINITY;
    }
    PI / (2.0 * arithmetic_geometric_mean(1.0, one_minus_m.sqrt()))
}

/// F(phi | m) for 0 <= phi <= pi/2, from sin^2 phi : cos^2 phi (in any common unit) and `1 - m`.
///
/// Infinite where the integral is (phi = pi/2 with m = 1). Source: DLMF 19.25.5.
pub fn incomplete(sin2: f64, cos2: f64, one_minus_m: f64) -> f64 {
    let unit = sin2.max(cos2);
    if sin2 <= 0.0 || unit.is_nan() {
        return sin2.max(0.0);
    }
    let (sin2, cos2) = (sin2 / unit, cos2 / unit);
    sin2.sqrt() * carlson_rf(cos2, cos2 + one_minus_m * sin2, cos2 + sin2)
}

fn arithmetic_geometric_mean(mut a: f64, mut b: f64) -> f64 {
    // Convergence is quadratic; the count only bounds the loop for arguments that are not numbers.
    for _ in 0..40 {
        if (a - b).abs() <= 4.0 * f64::EPSILON * a {
            break;
        }
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
    }
    0.5 * (a + b)
}

/// Carlson's symmetric R_F(x, y, z) with x, y, z >= 0, at most one of them zero (infinite if two are).
///
/// Source: B. C. Carlson, Numerical Algorithms 10 (1995) 13-26; the series is DLMF 19.36.1.
fn carlson_rf(mut x: f64, mut y: f64, mut z: f64) -> f64 {
    if x + y <= 0.0 {
        return f64::INFINITY;
    }
    for _ in 0..1200 {
        let mean = (x + y + z) / 3.0;
        let spread = (mean - x).abs().max((mean - y).abs()).max((mean - z).abs());
        if spread <= 0.004 * mean || mean.is_nan() {
            break;
        }
        let (rx, ry, rz) = (x.sqrt(), y.sqrt(), z.sqrt());
        let shift = rx * ry + ry * rz + rz * rx;
        (x, y, z) = (0.25 * (x + shift), 0.25 * (y + shift), 0.25 * (z + shift));
    }
    carlson_series(x, y, z)
}

/// R_F of three nearly equal arguments: the Taylor series about their mean, good to the eighth power of the spread.
fn carlson_series(x: f64, y: f64, z: f64) -> f64 {
    let mean = (x + y + z) / 3.0;
    let (dx, dy) = (1.0 - x / mean, 1.0 - y / mean);
    let dz = -dx - dy;
    let (e2, e3) = (dx * dy - dz * dz, dx * dy * dz);
    let low = e2 * (-1.0 / 10.0 + e2 / 24.0 - 3.0 * e3 / 44.0);
    let high = e3 * (1.0 / 14.0 + 3.0 * e3 / 104.0) + e2 * e2 * (e3 / 16.0 - 5.0 * e2 / 208.0);
    (1.0 + low + high) / mean.sqrt()
}
