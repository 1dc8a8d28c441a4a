//! Principal axes and moments of inertia by Jacobi's rotations.
//!
//! Why not a QR iteration: Jacobi's rotations leave a matrix that is diagonal already as it is, bit for bit, and find
//! a small moment beside large ones to full relative accuracy (Demmel & Veselic, SIAM J. Matrix Anal. Appl. 13, 1204, 1992).

use nalgebra::{Matrix3, Vector3};

/// What rounding leaves of a symmetry when moments are summed over points, relative: smaller differences are none, and a
/// matrix with smaller off-diagonal elements (beside the geometric mean of their diagonal ones) is diagonal.
pub const SYMMETRY_ROUNDING: f64 = 1e-14;
/// Convergence is quadratic; three or four sweeps do.
const MOST_SWEEPS: usize = 30;
const PAIRS: [(usize, usize); 3] = [(0, 1), (0, 2), (1, 2)];

/// Principal moments and axes of a symmetric matrix, in no particular order: (moments, unit axes as columns).
/// The axes are right-handed. Not finite in, not finite out.
pub fn principal_axes(inertia: &Matrix3<f64>) -> (Vector3<f64>, Matrix3<f64>) {
    let mut a = *inertia;
    let mut axes = Matrix3::identity();
    if is_diagonal(&a, SYMMETRY_ROUNDING) {
        return (a.diagonal(), axes);
    }
    for _ in 0..MOST_SWEEPS {
        PAIRS
            .iter()
            .for_each(|&(p, q)| rotate_away(&mut a, &mut axes, p, q));
        if is_diagonal(&a, 0.5 * f64::EPSILON) {
            break;
        }
    }
    (a.diagonal(), axes)
}

fn is_diagonal(a: &Matrix3<f64>, tolerance: f64) -> bool {
    PAIRS
        .iter()
        .all(|&(p, q)| a[(p, q)].abs() <= tolerance * (a[(p, p)] * a[(q, q)]).abs().sqrt())
}

/// Makes the element (p, q) zero.
fn rotate_away(a: &mut Matrix3<f64>, axes: &mut Matrix3<f64>, p: usize, q: usize) {
    let (app, aqq, apq) = (a[(p, p)], a[(q, q)], a[(p, q)]);
    if apq == 0.0 {
        return;
    }
    // The smaller root of t^2 + 2 ratio t - 1 = 0: the tangent of an angle of at most 45 degrees.
    let ratio = (aqq - app) / (2.0 * apq);
    let t = 1.0_f64.copysign(ratio) / (ratio.abs() + (ratio * ratio + 1.0).sqrt());
    let c = 1.0 / (t * t + 1.0).sqrt();
    let s = t * c;
    let r = 3 - p - q;
    let (arp, arq) = (a[(r, p)], a[(r, q)]);
    set(a, (p, p), app - t * apq);
    set(a, (q, q), aqq + t * apq);
    set(a, (p, q), 0.0);
    set(a, (r, p), c * arp - s * arq);
    set(a, (r, q), s * arp + c * arq);
    let (u, v) = (axes.column(p).into_owned(), axes.column(q).into_owned());
    axes.set_column(p, &(u * c - v * s));
    axes.set_column(q, &(u * s + v * c));
}

fn set(a: &mut Matrix3<f64>, (i, j): (usize, usize), value: f64) {
    a[(i, j)] = value;
    a[(j, i)] = value;
}
