//! Sine and cosine in plain double arithmetic: the same bits on every machine.
//!
//! The standard library's sine is the C library's, which differs from system to system; `libm`'s is the same
//! everywhere but slower. Here the argument is reduced to [-pi/4, pi/4] in two parts after Cody & Waite (Software
//! Manual for the Elementary Functions, 1980), and two polynomials do the rest. They are minimax fits (Remez), made
//! for this file; their errors are below 4e-18. What the two-part reduction cannot do goes to `libm`.

use std::f64::consts::{FRAC_2_PI, FRAC_PI_4};

/// The first 33 bits of pi/2: a multiple of up to 20 bits is exact.
const HALF_PI_HEAD: f64 = 1.5707963267341256;
/// pi/2 less its head, to 2^-88.
const HALF_PI_TAIL: f64 = 6.077100506506192e-11;

/// Below, the reduction's 20 bits are enough.
const LARGEST_ANGLE: f64 = 1e6;
/// Below, sin x = x and cos x = 1 in double precision, and the polynomials would lose the sign of -0.
const SMALLEST_ANGLE: f64 = 1e-8;
/// A remainder nearer to zero than this for each quarter turn taken off has lost bits in two parts.
const CANCELLED: f64 = 1.862645149230957e-9; // 2^-29

/// Adding and subtracting 1.5 * 2^52 rounds to the nearest integer, and leaves it in the last bits of the sum.
const ROUNDER: f64 = 6755399441055744.0;

/// Sine and cosine of an angle in radians, each within one unit in the last place.
///
/// Not a number or infinite: both are NaN.
#[inline]
pub fn sin_cos(x: f64) -> (f64, f64) {
    // One test for tiny, huge and NaN: the comparison is false for the last.
    if !(SMALLEST_ANGLE..LARGEST_ANGLE).contains(&x.abs()) {
        return rare(x);
    }
    if x.abs() <= FRAC_PI_4 {
        return kernels(x, 0.0);
    }
    let rounder = x * FRAC_2_PI + ROUNDER;
    let quarters = rounder - ROUNDER;
    let head = x - quarters * HALF_PI_HEAD; // exact
    let tail = quarters * HALF_PI_TAIL;
    let angle = head - tail;
    if angle.abs() < quarters.abs() * CANCELLED {
        return rare(x);
    }
    let (sine, cosine) = kernels(angle, (head - angle) - tail);
    // A branch, not a selection: a body that turns evenly meets the same quadrants again, and a right guess costs nothing.
    match rounder.to_bits() & 3 {
        0 => (sine, cosine),
        1 => (cosine, -sine),
        2 => (-sine, -cosine),
        _ => (-cosine, sine),
    }
}

/// The nearest whole number, halves away from zero: [`f64::round`], which is a call to a library where the processor has no
/// instruction for it.
#[inline]
pub fn round(x: f64) -> f64 {
    const EXACT_BELOW: f64 = 2251799813685248.0; // 2^51
    if x.is_nan() || x.abs() >= EXACT_BELOW {
        return x.round();
    }
    let even = (x + ROUNDER) - ROUNDER; // halves to the even number
    let rest = (x - even).abs();
    let is_half_below = rest == 0.5 && even.abs() < x.abs();
    let away = if is_half_below { 1.0 } else { 0.0 };
    (even.abs() + away).copysign(x)
}

/// Sine and cosine of `angle + rest`, |angle| up to pi/4 and |rest| up to half a unit in its last place.
#[inline(always)]
pub(super) fn kernels(angle: f64, rest: f64) -> (f64, f64) {
    let z = angle * angle;
    let zz = z * z;
    let cube = angle * z;
    // Summed in pairs, so that few operations wait for one another, and small terms first, so that only the last sum rounds.
    let s = (-0.16666666666666632 + 0.008333333333322488 * z)
        + zz * (-0.00019841269829855583 + 2.7557313706031597e-6 * z);
    let s_high = (cube * (zz * zz)) * (-2.505076006454724e-8 + 1.5896897758421305e-10 * z);
    let c = (0.0416666666666666 - 0.0013888888888874472 * z)
        + zz * (2.4801587289669253e-5 - 2.755731440016906e-7 * z);
    let c_high = (zz * zz) * (2.087572914218656e-9 - 1.1359926095089697e-11 * z);
    let half = 0.5 * z;
    let near_one = 1.0 - half;
    let lost = (1.0 - near_one) - half;
    let sine = angle + (cube * s + (s_high + rest * near_one));
    let cosine = near_one + (zz * (c + c_high) + (lost - angle * rest));
    (sine, cosine)
}

#[cold]
#[inline(never)]
fn rare(x: f64) -> (f64, f64) {
    if x.abs() < SMALLEST_ANGLE {
        (x, 1.0)
    } else {
        libm::sincos(x)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_2;

    /// Returns the distance in units in the last place, for numbers of the same sign.
    fn ulps(a: f64, b: f64) -> u64 {
        a.to_bits().abs_diff(b.to_bits())
    }

    fn assert_near(x: f64, (sine, cosine): (f64, f64)) {
        let (s, c) = sin_cos(x);
        assert!(
            ulps(s, sine) <= 1 && ulps(c, cosine) <= 1,
            "{x:e}: ({s:e}, {c:e}), not ({sine:e}, {cosine:e})"
        );
    }

    fn assert_near_libm(x: f64) {
        assert_near(x, libm::sincos(x));
    }

    /// Returns a number with a random exponent in the range, from a counter (splitmix64).
    fn scattered(i: u64, lowest: i32, highest: i32) -> f64 {
        let mut z = i.wrapping_mul(0x9e37_79b9_7f4a_7c15);
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^= z >> 31;
        let exponent = 1023 + lowest + (z % (highest - lowest + 1) as u64) as i32;
        f64::from_bits(
            ((z >> 63) << 63) | ((exponent as u64) << 52) | ((z >> 10) & ((1 << 52) - 1)),
        )
    }

    #[test]
    fn agrees_with_libm_within_one_ulp_at_millions_of_points() {
        for i in 0..3_000_000 {
            assert_near_libm(scattered(i, -30, 25));
        }
        for i in 0..200_000 {
            assert_near_libm(scattered(i, -1022, 1023));
        }
    }

    #[test]
    fn agrees_with_libm_around_every_multiple_of_an_eighth_turn() {
        for n in 0..700_000_u32 {
            for multiple in [f64::from(n) * FRAC_PI_2, f64::from(n) * FRAC_PI_4] {
                for x in [multiple.next_down(), multiple, multiple.next_up()] {
                    assert_near_libm(x);
                    assert_near_libm(-x);
                }
            }
        }
    }

    #[test]
    fn rounds_like_the_standard_library_bit_for_bit() {
        let near_halves = (0..2000)
            .map(|n| 0.5 * f64::from(n))
            .flat_map(|x| [x.next_down(), x, x.next_up()]);
        let anything = (0..300_000).map(|i| scattered(i, -60, 60));
        let edges = [f64::NAN, f64::INFINITY, f64::MAX, f64::MIN_POSITIVE];
        for x in near_halves.chain(anything).chain(edges) {
            for signed in [x, -x] {
                assert_eq!(
                    round(signed).to_bits(),
                    signed.round().to_bits(),
                    "{signed:e}"
                );
            }
        }
    }

    /// Computed with sixty digits (mpmath): numbers with an unusually small remainder.
    #[test]
    fn agrees_with_known_digits_near_multiples_of_a_quarter_turn() {
        for (x, sine, cosine) in [
            (45.553093477052, 1.0, -6.189806365883577e-19),
            (-45.553093477052, -1.0, -6.189806365883577e-19),
            (91.106186954104, -1.2379612731767154e-18, -1.0),
            (1457.698991265664, 1.9807380370827447e-17, 1.0),
            (321307.9594422229, -1.0, -4.429600834596129e-17),
        ] {
            assert_near(x, (sine, cosine));
        }
    }

    #[test]
    fn zeros_keep_their_sign_and_non_finite_input_is_nan() {
        for zero in [0.0_f64, -0.0] {
            assert_eq!(sin_cos(zero).0.to_bits(), zero.to_bits());
        }
        let tiny = f64::MIN_POSITIVE / 8.0;
        assert_eq!(sin_cos(tiny), (tiny, 1.0));
        for x in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert!(sin_cos(x).0.is_nan() && sin_cos(x).1.is_nan());
        }
    }
}
