//! Round numbers ..., 0.1, 0.2, 0.5, 1, 2, 5, 10, ..., each about twice the one before. They are rungs of a ladder, and
//! rung 0 is 1.

/// Relative differences below this are rounding: 0.01 · 100 is 1.
const RUNG_ROUNDING: f64 = 1e-12;

/// Returns the number on rung `number`: the float nearest to its decimal value.
pub fn rung(number: i64) -> f64 {
    let digit = ["1", "2", "5"][number.rem_euclid(3) as usize];
    let text = format!("{digit}e{}", number.div_euclid(3));
    text.parse().unwrap_or_default()
}

/// Returns the number of the largest rung that is not above `value` (> 0).
pub fn rung_below(value: f64) -> i64 {
    const FARTHEST_DECADE: i64 = 400; // there are no floats beyond
    let decade = (libm::log10(value).floor() as i64).clamp(-FARTHEST_DECADE, FARTHEST_DECADE);
    let top = 3 * decade + 3;
    (top - 4..=top)
        .rev()
        .find(|number| rung(*number) <= value * (1.0 + RUNG_ROUNDING))
        .unwrap_or(top - 4)
}

/// Returns the largest number of the ladder that is not above `value`. It is 0 if no positive number is.
pub fn at_or_below(value: f64) -> f64 {
    rung(rung_below(value))
}

/// Moves `value` up by `times` rungs, or down if `times` is negative. A value between two rungs moves to the next one
/// first.
pub fn climbed(value: f64, times: i32) -> f64 {
    let below = rung_below(value);
    let is_between = value > rung(below) * (1.0 + RUNG_ROUNDING);
    rung(below + i64::from(times) + i64::from(is_between && times < 0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_decade_has_1_2_and_5() {
        for (value, times, next) in [
            (0.1, 1, 0.2),
            (0.1, -1, 0.05),
            (0.5, 1, 1.0),
            (0.03, 1, 0.05),
            (0.03, -1, 0.02),
            (0.03, 2, 0.1),
            (0.03, -2, 0.01),
            (1.0 / 60.0, -1, 0.01),
            (1e-3, 3, 1e-2),
            (5.0, -3, 0.5),
            (1.0, 0, 1.0),
            (1e300, i32::MAX, f64::INFINITY),
            (1e-300, i32::MIN, 0.0),
        ] {
            assert_eq!(climbed(value, times), next, "{value} {times}");
        }
    }

    #[test]
    fn at_or_below_finds_the_nearest_rung_below() {
        let values = [1.0, 0.01 * 100.0, 1.99, 4.9, 9.99, 0.3, 7e-11, 0.0];
        let below = [1.0, 1.0, 1.0, 2.0, 5.0, 0.2, 5e-11, 0.0];
        assert_eq!(values.map(at_or_below), below);
        assert_eq!([-12, -1, 0, 1, 17].map(rung), [1e-4, 0.5, 1.0, 2.0, 5e5]);
    }
}
