//! The two theta functions that carry the motion of a Lagrange top, as short sums of harmonics.
//!
//! Each of the two Cayley-Klein parameters of the top (see `lagrange`) is a theta function of a complex argument divided
//! by one common real factor, times a steady rotation. The theta function is *odd* about the turning point at which its
//! parameter can vanish (theta_1) and *even* about the other (theta_2). With q the nome, z the real argument (half a turn
//! per period) and i zeta the place of its zero,
//!
//! ```text
//! theta_1(z - i zeta) ~ sum_n (-1)^n q^(n(n+1)) sin (2n+1)(z - i zeta),      theta_2: cos, without the signs.
//! ```
//!
//! For m > 1/2 the same functions are summed in the other direction of their lattice (Jacobi's imaginary transformation),
//! as hyperbolic functions of x with the nome q' of 1 - m. So no nome exceeds exp(-pi) = 0.0432, and four terms reach
//! rounding. That second form has the separatrix (q' = 0, no period) as an ordinary case: one pulse, sinh and cosh.
//!
//! Source: DLMF 20.2, 20.7(viii); F. Klein and A. Sommerfeld, Ueber die Theorie des Kreisels, chapter VI.

use core::f64::consts::PI;
use nalgebra::Complex;

const TERMS: usize = 4;
/// Below this the period exceeds a few hundred e-foldings: taken as the separatrix itself, whose sums cannot overflow.
const NO_RETURN: f64 = 1e-250;
/// The same limit for the argument: a pulse this old has settled to far below rounding.
const SETTLED_PULSE: f64 = 300.0;

/// Whether a theta function vanishes near the origin of its argument, or half a period away.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Parity {
    Odd,
    Even,
}

/// Where a parameter vanishes off the real axis, how fast it turns opposite to that place, and which way.
#[derive(Clone, Copy, Debug)]
pub struct Zero {
    pub parity: Parity,
    /// sc^2(w | 1 - m) of the zero's distance w from the real axis, as a fraction: numerator and denominator.
    pub sin2: f64,
    pub cos2: f64,
    /// sc^2(K' - w | 1 - m), as a fraction.
    pub co_sin2: f64,
    pub co_cos2: f64,
    /// Phase rate at the turning point farther from the zero, rad/s, and its sign.
    pub rate: f64,
    pub sign: f64,
}

/// The period lattice of the motion: which of the two sums to use, with its nome, and how its argument runs with time.
#[derive(Clone, Copy, Debug)]
pub struct Lattice {
    /// Whether it is summed over pulses, and not over harmonics.
    pub pulsed: bool,
    m: f64,
    one_minus_m: f64,
    quarter: f64,
    other_quarter: f64,
    nome: f64,
    /// Rate of the elliptic functions' argument, rad/s.
    elliptic_rate: f64,
    /// d(argument)/dt, rad/s.
    pub rate: f64,
    /// Time from one lower turning point to the next, s; infinite on the separatrix and for a top that does not nutate.
    pub period: f64,
    pub per_period: f64,
}

/// Harmonics of the argument at one instant: cosines and sines, or cosh and sinh, in the order that makes the
/// coefficients of the first real and of the second imaginary.
#[derive(Clone, Copy, Debug)]
pub struct Harmonics {
    x: [f64; TERMS],
    y: [f64; TERMS],
}

/// One theta function of time with its steady rotation.
#[derive(Clone, Copy, Debug)]
pub struct Wave {
    real: [f64; TERMS],
    imaginary: [f64; TERMS],
    real_rate: [f64; TERMS],
    imaginary_rate: [f64; TERMS],
    /// Mean phase rate, rad/s.
    pub mean: f64,
    /// Phase that the sum itself loses over one period, rad; taken out of the rotation within a period.
    pub lag: f64,
    /// Phase rate of the rotation within a period, rad/s.
    pub local: f64,
}

impl Lattice {
    /// `rate` is the rate of the elliptic functions' argument, rad/s; `m` and `1 - m` both to full relative accuracy.
    pub fn new(m: f64, one_minus_m: f64, rate: f64) -> Self {
        let one_minus_m = if one_minus_m < NO_RETURN {
            0.0
        } else {
            one_minus_m
        };
        let (quarter, other_quarter) = (complete(one_minus_m), complete(m));
        let pulsed = m > 0.5;
        let (long, short) = if pulsed {
            (quarter, other_quarter)
        } else {
            (other_quarter, quarter)
        };
        let period = 2.0 * quarter / rate;
        Self {
            pulsed,
            m,
            one_minus_m,
            quarter,
            other_quarter,
            nome: libm::exp(-PI * long / short),
            elliptic_rate: rate,
            rate: rate * PI / (2.0 * short),
            period,
            per_period: 1.0 / period,
        }
    }

    /// Time since the turning point that squared sine and cosine of the amplitude place the state at, s.
    pub fn time_at(&self, sin2: f64, cos2: f64) -> f64 {
        incomplete(sin2, cos2, self.one_minus_m) / self.elliptic_rate
    }

    /// Harmonics (odd, even) at `time` s from the nearest origin, with that sine and cosine.
    pub fn harmonics(&self, time: f64) -> (Harmonics, Harmonics) {
        if self.pulsed {
            self.hyperbolic(self.rate * time)
        } else {
            let h = circular(self.rate * time);
            (h, h)
        }
    }

    fn hyperbolic(&self, x: f64) -> (Harmonics, Harmonics) {
        let grow = libm::exp(x.clamp(-SETTLED_PULSE, SETTLED_PULSE));
        let fall = 1.0 / grow;
        let (ahead, behind) = (self.nome * grow * grow, self.nome * fall * fall);
        let (mut odd, mut even) = (Harmonics::ZERO, Harmonics::ZERO);
        let (mut a, mut b) = (0.5, 0.5);
        for n in 0..TERMS {
            (odd.x[n], odd.y[n]) = (grow * a - fall * b, grow * a + fall * b);
            (even.x[n], even.y[n]) = (a + b, a - b);
            (a, b) = (a * ahead, b * behind);
        }
        (odd, even)
    }

    /// The theta function with this zero.
    pub fn wave(&self, zero: Zero) -> Wave {
        if self.pulsed {
            self.pulsed_wave(zero)
        } else {
            self.circular_wave(zero)
        }
    }

    /// Fourier form. The sum's leading harmonic exp(i z) is counted into the rotation, where it makes `mean` the mean.
    fn circular_wave(&self, zero: Zero) -> Wave {
        let (p, r) = (
            self.decay(zero.sin2, zero.cos2),
            self.decay(zero.co_sin2, zero.co_cos2),
        );
        let alternate = if zero.parity == Parity::Odd {
            -1.0
        } else {
            1.0
        };
        let mut wave = Wave::ZERO;
        let (mut with, mut against, mut sign, mut step) = (1.0, 1.0, 1.0, 1.0);
        let (mut total, mut excess) = (0.0, 0.0);
        for k in 0..TERMS {
            let n = k as f64;
            if k == 0 {
                wave.real[0] = 1.0;
            } else {
                wave.set(
                    k,
                    sign * (with + against),
                    zero.sign * sign * (with - against),
                    [-2.0 * n, 2.0 * n],
                    self.rate,
                );
            }
            let next = if k == 0 { p } else { against * step * p };
            total += with + next;
            excess += (2.0 * n + 2.0) * next - 2.0 * n * with;
            with *= step * self.nome * r;
            against = next;
            step *= self.nome * self.nome;
            sign *= alternate;
        }
        wave.mean = zero.sign * (zero.rate + self.rate * excess / total);
        wave.local = wave.mean;
        wave
    }

    /// exp(-pi w / K) for a distance w from the real axis given by its sc^2.
    fn decay(&self, sin2: f64, cos2: f64) -> f64 {
        libm::exp(-PI * incomplete(sin2, cos2, self.m) / self.quarter)
    }

    /// Pulse form.
    fn pulsed_wave(&self, zero: Zero) -> Wave {
        let y = PI * incomplete(zero.sin2, zero.cos2, self.m) / (2.0 * self.other_quarter);
        let odd = zero.parity == Parity::Odd;
        let mut wave = Wave::ZERO;
        let (mut sign, mut power, mut step) = (1.0, 1.0, if odd { self.nome } else { 1.0 });
        for k in 0..TERMS {
            let n = if odd {
                (2 * k + 1) as f64
            } else {
                (2 * k) as f64
            };
            let size = sign * if odd || k == 0 { power } else { 2.0 * power };
            let (sin, cos) = libm::sincos(n * y);
            wave.set(k, size * cos, -zero.sign * size * sin, [n, n], self.rate);
            // Odd sums carry q'^(k^2), even ones q'^(k^2 - k): the harmonics bring the rest.
            power *= step;
            step *= self.nome * self.nome;
            sign = -sign;
        }
        let local = zero.rate - self.rate * self.drift(y);
        let lost = PI - 2.0 * y;
        wave.local = zero.sign * local;
        wave.mean = zero.sign * (local + lost * self.per_period);
        wave.lag = -zero.sign * lost;
        wave
    }

    /// Phase rate that the pulse form adds at its middle, per unit of the argument: -Im of theta_4'/theta_4 (i y).
    fn drift(&self, y: f64) -> f64 {
        let (mut total, mut turning) = (1.0, 0.0);
        let (mut size, mut step) = (-2.0 * self.nome, -self.nome * self.nome * self.nome);
        for k in 1..=TERMS {
            let twice = (2 * k) as f64;
            let (sin, cos) = libm::sincos(twice * y);
            total += size * cos;
            turning -= twice * size * sin;
            size *= step;
            step *= self.nome * self.nome;
        }
        turning / total
    }
}

fn circular(z: f64) -> Harmonics {
    let (sin, cos) = libm::sincos(2.0 * z);
    harmonics_of(sin, cos)
}

/// The harmonics of an angle with this sine and cosine.
#[inline(always)]
fn harmonics_of(sin: f64, cos: f64) -> Harmonics {
    let mut h = Harmonics::ZERO;
    h.x[0] = 1.0;
    for k in 1..TERMS {
        h.x[k] = h.x[k - 1] * cos - h.y[k - 1] * sin;
        h.y[k] = h.y[k - 1] * cos + h.x[k - 1] * sin;
    }
    h
}

impl Harmonics {
    const ZERO: Self = Self {
        x: [0.0; TERMS],
        y: [0.0; TERMS],
    };
}

impl Wave {
    const ZERO: Self = Self {
        real: [0.0; TERMS],
        imaginary: [0.0; TERMS],
        real_rate: [0.0; TERMS],
        imaginary_rate: [0.0; TERMS],
        mean: 0.0,
        lag: 0.0,
        local: 0.0,
    };

    /// Term `k`: its coefficients, and those of its time derivative, in which the harmonics x and y change places.
    fn set(&mut self, k: usize, real: f64, imaginary: f64, [x, y]: [f64; 2], rate: f64) {
        (self.real[k], self.imaginary[k]) = (real, imaginary);
        (self.real_rate[k], self.imaginary_rate[k]) = (real * x * rate, imaginary * y * rate);
    }

    /// The sum without its rotation.
    #[inline(always)]
    pub fn value(&self, h: &Harmonics) -> Complex<f64> {
        Complex::new(dot(&self.real, &h.x), dot(&self.imaginary, &h.y))
    }

    /// The same where twice the argument has this sine and cosine.
    #[inline(always)]
    pub fn value_at(&self, sin: f64, cos: f64) -> Complex<f64> {
        self.value(&harmonics_of(sin, cos))
    }

    /// Its time derivative, 1/s, with the rotation's rate included and the rotation itself left out.
    pub fn slope(&self, h: &Harmonics, value: Complex<f64>) -> Complex<f64> {
        let turned = Complex::new(-value.im, value.re) * self.local;
        Complex::new(dot(&self.real_rate, &h.y), dot(&self.imaginary_rate, &h.x)) + turned
    }
}

#[inline(always)]
fn dot(a: &[f64; TERMS], b: &[f64; TERMS]) -> f64 {
    (a[0] * b[0] + a[1] * b[1]) + (a[2] * b[2] + a[3] * b[3])
}

// Elliptic integrals of the first kind, complete by Gauss's mean and incomplete by Carlson's duplication. Moduli come as
// pairs of parts that are known to full *relative* accuracy (`m` and `1 - m`, squared sine and squared cosine), because
// near a steady or a sleeping top one of the two is far below the rounding of the other.

/// K(m) = F(pi/2 | m), from the complementary parameter `1 - m` in 0..=1. Infinite at 0.
///
/// Source: Gauss, K = pi / (2 agm(1, sqrt(1 - m))); DLMF 19.8.5.
fn complete(one_minus_m: f64) -> f64 {
    if one_minus_m <= 0.0 {
        return f64::INFINITY;
    }
    PI / (2.0 * arithmetic_geometric_mean(1.0, one_minus_m.sqrt()))
}

/// F(phi | m) for 0 <= phi <= pi/2, from sin^2 phi : cos^2 phi (in any common unit) and `1 - m`.
///
/// Infinite where the integral is (phi = pi/2 with m = 1). Source: DLMF 19.25.5.
fn incomplete(sin2: f64, cos2: f64, one_minus_m: f64) -> f64 {
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
