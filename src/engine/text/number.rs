//! Formats numbers with as few digits as a reader needs. The text is short for any number, and never NaN or inf: a
//! number that is not finite is "n/a". Counts and sizes use `indicatif`'s `HumanCount` and `DecimalBytes`.

use std::fmt;

/// Text for a missing number.
pub const NOT_AVAILABLE: &str = "n/a";

/// Size from which on a number is written with an exponent.
const LARGE_NUMBER: f64 = 1e9;
/// Maximum decimals of a number that is written with an exponent although decimals were requested.
const MOST_EXPONENT_DIGITS: usize = 6;

/// Formats `number` with `decimals` digits after the point: `0.886033`. A number that rounds to zero has no sign:
/// `0.000000`.
pub fn fixed(number: f64, decimals: usize) -> String {
    if number.abs() < LARGE_NUMBER {
        return without_minus_zero(format!("{number:.decimals$}"));
    }
    exponent(number, decimals.min(MOST_EXPONENT_DIGITS))
}

/// Removes the sign of a zero from `text`, so that a negative number that rounds to 0 is written like 0.
pub fn without_minus_zero(text: String) -> String {
    match text.strip_prefix('-') {
        Some(rest) if rest.chars().all(|c| matches!(c, '0' | '.')) => rest.to_owned(),
        _ => text,
    }
}

/// Formats `number` like [`fixed`], with its sign: `+0.1160`, `+0.0000`.
pub fn signed(number: f64, decimals: usize) -> String {
    with_sign(fixed(number, decimals))
}

fn with_sign(text: String) -> String {
    if text.starts_with('-') || text == NOT_AVAILABLE {
        text
    } else {
        format!("+{text}")
    }
}

/// Formats `number` with an exponent and `digits` digits after the point: `2.4e-9`.
pub fn exponent(number: f64, digits: usize) -> String {
    if number.is_finite() {
        format!("{:.digits$e}", number + 0.0) // adding 0 makes 0 of -0
    } else {
        NOT_AVAILABLE.to_owned()
    }
}

/// Formats `number` like [`exponent`], with its sign: `+2.4e-9`.
pub fn signed_exponent(number: f64, digits: usize) -> String {
    with_sign(exponent(number, digits))
}

/// Returns the shortest text that parses as `number`: 0.1, 1e308.
pub fn shortest(number: f64) -> String {
    if !number.is_finite() {
        return NOT_AVAILABLE.to_owned();
    }
    let text = format!("{number:?}");
    text.strip_suffix(".0").map_or(text.clone(), str::to_owned)
}

/// Formats `number` with `digits` significant digits, without trailing zeros: 42.1, 3.333333e-10.
pub fn significant(number: f64, digits: usize) -> String {
    shortest(rounded(number, digits) + 0.0) // adding 0 makes 0 of -0
}

pub fn rounded(number: f64, digits: usize) -> f64 {
    let after_the_first = digits.saturating_sub(1);
    let text = format!("{number:.after_the_first$e}");
    text.parse().unwrap_or(number)
}

/// Formats `number` with at most six decimals, without trailing zeros: 230, 0.002, and not 0.30000000000000004. From a
/// million on, it uses an exponent and three decimals.
pub fn decimal(number: f64) -> String {
    match number.abs() {
        // Adding 0 makes 0 of -0.
        size if size < 1e6 => (libm::round(number * 1e6) / 1e6 + 0.0).to_string(),
        _ => exponent(number, 3),
    }
}

/// Formats `number` with three digits, without a row of zeros: `0.389`, `34.4`, `1.2e-7`.
pub fn short(number: f64) -> String {
    match number.abs() {
        0.0 => "0".to_owned(),
        size if (1e-3..1e5).contains(&size) => {
            let digits = (2.0 - libm::floor(libm::log10(size))).max(0.0) as usize;
            format!("{number:.digits$}")
        }
        _ => exponent(number, 1),
    }
}

/// Formats a number that is not negative with about three digits. Its width stays the same while its size does not
/// change.
pub fn steady(number: f64) -> String {
    match number {
        n if n >= 1e6 => exponent(n, 1),
        n if n >= 1.0 => fixed(n, 2),
        n if n >= 0.1 => fixed(n, 3),
        n => fixed(n, 4),
    }
}

/// A number followed by its uncertainty in parentheses, in units of its last two digits: 0.886033(24) is 0.886033 ±
/// 0.000024 (JCGM 100:2008, 7.2.2).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Uncertain {
    /// The digits, such as `8.86033(24)`.
    pub digits: String,
    /// Power of ten by which they are multiplied. It is 0 if the number is written without one.
    pub exponent: i32,
}

/// Returns `number` with its `uncertainty`. `None` if one of them is not finite, or the uncertainty is not positive. An
/// uncertainty below the rounding error of `number` is replaced by it.
pub fn uncertain(number: f64, uncertainty: f64) -> Option<Uncertain> {
    if !(number.is_finite() && uncertainty.is_finite() && uncertainty > 0.0) {
        return None;
    }
    let stated = uncertainty.max(number.abs() * f64::EPSILON);
    // In "2.4e-5", the first digit is at 10^-5. The second, which is the last to be written, is at 10^-6.
    let (leading, first) = scientific(stated, 1);
    let last = first - 1;
    let two_digits = leading.replace('.', "");
    let top = if number == 0.0 {
        first
    } else {
        scientific(number, 16).1.max(first)
    };
    if (-3..=5).contains(&top) && last <= 0 {
        let decimals = last.unsigned_abs() as usize;
        let digits = without_minus_zero(format!("{number:.decimals$}"));
        return Some(Uncertain {
            digits: digits + &in_brackets(&two_digits, decimals),
            exponent: 0,
        });
    }
    let decimals = (top - last).unsigned_abs() as usize;
    let digits = match scientific(number, decimals) {
        (digits, at) if at == top => digits,
        // The number is smaller than its uncertainty, or rounds up to the next power of ten.
        _ => {
            let scaled = number / libm::exp10(f64::from(top));
            without_minus_zero(format!("{scaled:.decimals$}"))
        }
    };
    Some(Uncertain {
        digits: digits + &in_brackets(&two_digits, decimals),
        exponent: top,
    })
}

/// Returns the two digits of an uncertainty in parentheses. Its last digit is `decimals` digits after the point. With
/// one decimal, as in 1.2, the point is between the two digits.
fn in_brackets(two_digits: &str, decimals: usize) -> String {
    match decimals {
        1 => format!("({}.{})", &two_digits[..1], &two_digits[1..]),
        _ => format!("({two_digits})"),
    }
}

/// Returns the digits of `number`, with `decimals` of them after the point, and its power of ten.
fn scientific(number: f64, decimals: usize) -> (String, i32) {
    let text = format!("{number:.decimals$e}");
    match text.split_once('e') {
        Some((digits, power)) => (digits.to_owned(), power.parse().unwrap_or(0)),
        None => (text, 0),
    }
}

impl Uncertain {
    /// Formats `number` with the same last digit and the same power of ten.
    pub fn to_the_same_digit(&self, number: f64) -> String {
        let digits = self.digits.split('(').next().unwrap_or_default();
        let decimals = digits.split_once('.').map_or(0, |(_, after)| after.len());
        let scaled = number / libm::exp10(f64::from(self.exponent));
        let rounded = without_minus_zero(format!("{scaled:.decimals$}"));
        Self {
            digits: rounded,
            ..*self
        }
        .to_string()
    }
}

impl fmt::Display for Uncertain {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.exponent {
            0 => f.write_str(&self.digits),
            power => write!(f, "{}e{power}", self.digits),
        }
    }
}

/// Returns a count with its noun: `1 row`, `2 rows`.
pub fn counted(count: u64, one: &str) -> String {
    match count {
        1 => format!("1 {one}"),
        _ => format!("{count} {one}s"),
    }
}

/// Formats a ratio for "... times", without digits that only flicker.
pub fn times(ratio: f64) -> String {
    match ratio {
        r if r >= 1e6 => exponent(r, 1),
        r if r < 10.0 => fixed(r, 1),
        r => fixed(r, 0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn numbers_are_short_and_a_rounded_zero_has_no_minus() {
        let zeros = [-0.0, -1e-300, -4e-7].map(|n| [fixed(n, 6), signed(n, 6), decimal(n)]);
        assert_eq!(zeros, [["0.000000", "+0.000000", "0"]; 3]);
        for (text, expected) in [
            (exponent(-0.0, 1), "0.0e0"),
            (fixed(-6e-7, 6), "-0.000001"),
            (fixed(-0.4, 0), "0"),
            (fixed(-10.0, 0), "-10"),
            (fixed(0.886033, 6), "0.886033"),
            (fixed(1.5e300, 9), "1.500000e300"),
            (signed(-6e-7, 6), "-0.000001"),
            (signed(0.116, 4), "+0.1160"),
            (signed_exponent(-2.4e-9, 1), "-2.4e-9"),
            (shortest(0.1), "0.1"),
            (shortest(20.0), "20"),
            (shortest(1e-7), "1e-7"),
            (shortest(1e308), "1e308"),
            (shortest(f64::NAN), "n/a"),
            (short(34.4321), "34.4"),
            (short(5e-324), "4.9e-324"),
            (times(106.7), "107"),
            (significant(-0.0, 3), "0"),
            (significant(421.0 * 0.1, 7), "42.1"),
            (significant(0.0, 7), "0"),
            (significant(1e-9 / 3.0, 7), "3.333333e-10"),
            (decimal(0.1 * 3.0), "0.3"),
            (decimal(230.0), "230"),
            (decimal(1.13e6), "1.130e6"),
        ] {
            assert_eq!(text, expected);
        }
        assert_eq!(rounded(1234.0, 2), 1200.0);
        assert!(rounded(f64::NAN, 2).is_nan());
    }

    #[test]
    fn an_uncertainty_has_two_digits_and_aligns_with_the_number() {
        let cases = [
            (0.886_033_098, 2.4e-5, "0.886033(24)"),
            (0.886_033_098, 0.000_099_6, "0.88603(10)"),
            (-12.345, 0.31, "-12.35(31)"),
            (12.345, 1.24, "12.3(1.2)"),
            (123.4, 12.0, "123(12)"),
            (123_456.0, 120.0, "1.2346(12)e5"),
            (6.0e7, 1.5e3, "6.00000(15)e7"),
            (1.234e-5, 2.0e-8, "1.2340(20)e-5"),
            (0.0, 0.002, "0.0000(20)"),
            (1.0e-9, 2.0e-8, "0.1(2.0)e-8"),
            (9.99996, 0.001, "10.0000(10)"),
            (0.5, 1e-300, "0.50000000000000000(11)"),
        ];
        for (number, uncertainty, text) in cases {
            let stated = uncertain(number, uncertainty).map(|stated| stated.to_string());
            assert_eq!(stated.as_deref(), Some(text), "{number} +- {uncertainty}");
        }
        for uncertainty in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert_eq!(uncertain(1.0, uncertainty), None);
        }
        assert_eq!(uncertain(f64::NAN, 1.0), None);
    }

    const NUMBER_FORMATS: [fn(f64) -> String; 9] = [
        |n| fixed(n, 9),
        |n| signed(n, 4),
        |n| exponent(n, 3),
        |n| signed_exponent(n, 3),
        shortest,
        decimal,
        short,
        steady,
        times,
    ];

    proptest! {
        #[test]
        fn formatted_numbers_are_short_and_finite(bits in any::<u64>()) {
            let number = f64::from_bits(bits);
            for text in NUMBER_FORMATS.map(|way| way(number)) {
                prop_assert!(text.len() <= 24, "{text}");
                prop_assert_eq!(text == NOT_AVAILABLE, !number.is_finite(), "{}", text);
                prop_assert!(!text.contains("inf") && !text.contains("NaN"));
            }
        }

        #[test]
        fn shortest_round_trips(number in any::<f64>().prop_filter("finite", |n| n.is_finite())) {
            prop_assert_eq!(shortest(number).parse::<f64>().unwrap(), number);
        }
    }
}
