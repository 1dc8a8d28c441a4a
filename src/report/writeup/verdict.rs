//! The verdict on one number of a run, in words.

use crate::engine::analysis::health::{BELIEVED_WITHIN, SWING_TOLERANCE, tilt_tolerance_deg};
use crate::engine::text::number::{Uncertain, short, significant, uncertain};
use crate::report::document::quantity;
use std::fmt;

/// A number with its standard uncertainty, if it has one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stated {
    pub number: f64,
    pub sigma: Option<f64>,
}

/// How far a number may be from the exact one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Tolerance {
    /// In the number's unit.
    Absolute(f64),
    /// As a fraction of the exact number.
    Relative(f64),
}

/// Digits of a number without an uncertainty.
const DIGITS: usize = 6;
/// A difference of so many standard uncertainties is explained by them.
const EXPLAINED_SIGMAS: f64 = 3.0;
/// From this ratio on, a difference is stated as a ratio and not in percent.
const LARGE_RATIO: f64 = 10.0;

impl Tolerance {
    pub const OF_NUTATION: Self = Self::Relative(SWING_TOLERANCE);
    pub const OF_RATE: Self = Self::Relative(BELIEVED_WITHIN);
    /// As for the energy in the lab.
    pub const OF_ENERGY: Self = Self::Absolute(0.05);

    /// For a place of a point that is `arm_m` from the pivot, m.
    pub fn of_place(arm_m: f64) -> Self {
        Self::Absolute(BELIEVED_WITHIN * arm_m)
    }

    /// For a tilt that swings within `exact_deg` in the exact motion, degrees.
    pub fn of_tilt(exact_deg: (f64, f64)) -> Self {
        Self::Absolute(tilt_tolerance_deg(exact_deg))
    }
}

impl Stated {
    fn uncertain(self) -> Option<Uncertain> {
        uncertain(self.number, self.sigma?)
    }

    /// Writes another number to the last digit of this one.
    pub fn with_digits(self, number: f64) -> String {
        match self.uncertain() {
            Some(uncertain) => uncertain.to_the_same_digit(number),
            None => significant(number, DIGITS),
        }
    }
}

impl fmt::Display for Stated {
    /// Writes the number to the last digit of its uncertainty, or with six digits.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.uncertain() {
            Some(uncertain) => uncertain.fmt(f),
            None => f.write_str(&significant(self.number, DIGITS)),
        }
    }
}

/// Returns the verdict on the number of a `run` beside the `right` one, as markup.
pub fn compare(run: Stated, right: f64, tolerance: Tolerance, unit: &str) -> String {
    let off = run.number - right;
    let size = off.abs();
    if size == 0.0 || (run.sigma.is_none() && run.to_string() == run.with_digits(right)) {
        return format!("agrees to {DIGITS} digits");
    }
    if run
        .sigma
        .is_some_and(|sigma| size <= EXPLAINED_SIGMAS * sigma)
    {
        return "agrees within the uncertainty".to_owned();
    }
    let most = match tolerance {
        Tolerance::Absolute(most) => most,
        Tolerance::Relative(part) => part * right.abs(),
    };
    let verdict = if size <= most { "agrees" } else { "wrong" };
    let side = if off > 0.0 { "above" } else { "below" };
    let amount = quantity(&significant(size, 2), unit);
    let ratio = size / right.abs();
    let relative = if !ratio.is_finite() || tolerance == Tolerance::OF_ENERGY {
        String::new()
    } else if ratio >= LARGE_RATIO {
        let times = quantity(&short((run.number / right).abs()), "");
        format!(" ({times} times as large)")
    } else {
        format!(" ({} %)", quantity(&short(100.0 * ratio), ""))
    };
    format!("{verdict}: {amount} {side}{relative}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_verdict_states_the_difference_and_its_significance() {
        let verdict = |number, sigma| {
            let run = Stated { number, sigma };
            compare(run, 2.0, Tolerance::OF_RATE, "s")
        };
        assert_eq!(verdict(2.000_000_1, None), "agrees to 6 digits");
        assert_eq!(verdict(2.2, Some(0.1)), "agrees within the uncertainty");
        assert_eq!(
            verdict(2.01, Some(0.001)),
            "agrees: {0.01 s} above ({0.500} %)"
        );
        assert_eq!(verdict(1.5, None), "wrong: {0.5 s} below ({25.0} %)");
        assert_eq!(
            verdict(-200.0, None),
            "wrong: {200 s} below ({100} times as large)"
        );
    }
}
