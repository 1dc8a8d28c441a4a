//! Numbers of either precision, and the few operations on vectors that the report's step is made of.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// A floating-point number, f64 or f32.
pub trait Real:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    fn of(number: f64) -> Self;
    fn f64(self) -> f64;
}

impl Real for f64 {
    fn of(number: f64) -> Self {
        number
    }
    fn f64(self) -> f64 {
        self
    }
}

impl Real for f32 {
    fn of(number: f64) -> Self {
        number as Self
    }
    fn f64(self) -> f64 {
        self.into()
    }
}

pub(super) type Vector<T> = [T; 3];
pub(super) type Matrix<T> = [[T; 3]; 3];

pub(super) fn dot<T: Real>(a: &Vector<T>, b: &Vector<T>) -> T {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(super) fn cross<T: Real>(a: &Vector<T>, b: &Vector<T>) -> Vector<T> {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// Omega = I \ L, by Cramer's rule.
pub(super) fn solve<T: Real>(matrix: &Matrix<T>, vector: &Vector<T>) -> Vector<T> {
    let column = |j: usize| [0, 1, 2].map(|i| matrix[i][j]);
    let [a, b, c] = [0, 1, 2].map(column);
    let across = cross(&b, &c);
    let whole = dot(&a, &across);
    [
        dot(vector, &across) / whole,
        dot(&a, &cross(vector, &c)) / whole,
        dot(&a, &cross(&b, vector)) / whole,
    ]
}
