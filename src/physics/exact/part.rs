//! The two Cayley-Klein parameters of a top (see [`lagrange`](super::lagrange)) as functions of time.

use super::theta::{Harmonics, Wave};
use crate::trig::round;
use core::f64::consts::TAU;
use nalgebra::Complex;

/// One Cayley-Klein parameter as a function of time.
#[derive(Clone, Copy, Debug)]
pub(super) struct Part {
    pub wave: Wave,
    /// Value of the whole at the start divided by that of its sum.
    pub amplitude: Complex<f64>,
    /// Mean rotation with the body's extra spin, turns per second.
    pub turns_per_s: f64,
}

/// The sums of alpha and of beta at one moment.
pub(super) struct Sums {
    /// Amplitude and rotation of each.
    pub turns: [Complex<f64>; 2],
    /// The sum of each without them.
    pub values: [Complex<f64>; 2],
    pub harmonics: [Harmonics; 2],
}

impl Part {
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

impl Sums {
    /// alpha and beta, short of one common real factor.
    #[inline]
    pub fn parameters(&self) -> (Complex<f64>, Complex<f64>) {
        let ([turn_a, turn_b], [value_a, value_b]) = (self.turns, self.values);
        (turn_a * value_a, turn_b * value_b)
    }
}
