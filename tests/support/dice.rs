//! Random numbers for tests, the same on every machine.

#![allow(dead_code, reason = "no test needs all of them")]

use nalgebra::{Matrix3, Rotation3, Vector3};

/// A small generator of numbers in 0..1 (Marsaglia's xorshift).
pub struct Dice(pub u64);

impl Dice {
    pub fn unit(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// Returns a number from `low` to `high` with a uniformly distributed logarithm.
    pub fn scale(&mut self, low: f64, high: f64) -> f64 {
        (self.between(low.ln(), high.ln())).exp()
    }

    /// Returns a whole number from `low` to `high`, both inclusive.
    pub fn whole(&mut self, low: u64, high: u64) -> u64 {
        low + (self.unit() * (high - low + 1) as f64) as u64
    }

    /// Returns a random element of `list`.
    pub fn pick<T: Copy>(&mut self, list: &[T]) -> T {
        list[(self.unit() * list.len() as f64) as usize]
    }

    pub fn vector(&mut self) -> Vector3<f64> {
        Vector3::new(
            self.between(-1.0, 1.0),
            self.between(-1.0, 1.0),
            self.between(-1.0, 1.0),
        )
    }

    pub fn orientation(&mut self) -> Matrix3<f64> {
        *Rotation3::new(self.vector() * 3.0).matrix()
    }
}
