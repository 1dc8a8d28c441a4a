//! Numbers in as few digits as a reader needs. Counts and sizes are `indicatif`'s `HumanCount` and `DecimalBytes`.

/// The shortest text that is read back as `number`.
pub fn shortest(number: f64) -> String {
    let text = format!("{number:?}");
    text.strip_suffix(".0").map_or(text.clone(), str::to_owned)
}

/// `number` to `digits` significant digits, without zeros at its end: 42.1, 3.333333e-10.
pub fn significant(number: f64, digits: usize) -> String {
    shortest(rounded(number, digits))
}

/// The number nearest to `number` that has `digits` significant digits.
pub fn rounded(number: f64, digits: usize) -> f64 {
    let after_the_first = digits.saturating_sub(1);
    let text = format!("{number:.after_the_first$e}");
    text.parse().unwrap_or(number)
}

/// `number` to six decimals at most, without zeros at its end: 230, 0.002, and not 0.30000000000000004; from a million on
/// with an exponent and three decimals.
pub fn decimal(number: f64) -> String {
    match number.abs() {
        size if size >= 1e6 => format!("{number:.3e}"),
        _ => (libm::round(number * 1e6) / 1e6).to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        assert_eq!(shortest(20.0), "20");
        assert_eq!(shortest(1e-7), "1e-7");
        assert_eq!(significant(421.0 * 0.1, 7), "42.1");
        assert_eq!(significant(0.0, 7), "0");
        assert_eq!(significant(1e-9 / 3.0, 7), "3.333333e-10");
        assert_eq!(rounded(1234.0, 2), 1200.0);
        assert_eq!(decimal(0.1 * 3.0), "0.3");
        assert_eq!(decimal(230.0), "230");
        assert_eq!(decimal(1.13e6), "1.130e6");
        assert!(rounded(f64::NAN, 2).is_nan());
    }
}
