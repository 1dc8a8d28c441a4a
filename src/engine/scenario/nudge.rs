//! Arithmetic for numbers that are nudged or typed: steps of 1, 2 and 5 times a power of ten without binary noise, and
//! units.

use super::schema::Nudge;
use crate::text::nice_numbers::{at_or_below, climbed};
use crate::text::printable::brief;

/// Nudges `value` by the rule `nudge`, `times` times. `size` is the size that the rule refers to. `None` if the rule is
/// not for numbers.
pub fn number(value: f64, size: f64, nudge: Nudge, times: i32) -> Option<f64> {
    match nudge {
        Nudge::By(step) => Some(added(value, step, times)),
        Nudge::Hundredth(zero) => Some(added(value, hundredth(size).unwrap_or(zero), times)),
        Nudge::Ladder => Some(climbed(value, times)),
        Nudge::WholeHundredth | Nudge::Turn | Nudge::Typed => None,
    }
}

/// Nudges the whole number `value`, `times` times.
pub fn whole(value: i64, times: i32) -> i64 {
    let hundredth = hundredth(value.unsigned_abs() as f64);
    let step = hundredth.unwrap_or(1.0).max(1.0) as i64;
    value.saturating_add(step.saturating_mul(i64::from(times)))
}

/// Returns `value` + `times` · `step` with no more decimals than the two have: 0.1 + 0.2 is 0.3.
fn added(value: f64, step: f64, times: i32) -> f64 {
    let sum = value + step * f64::from(times);
    let most = decimals(value).max(decimals(step));
    let clean: f64 = format!("{sum:.most$}").parse().unwrap_or(sum);
    clean + 0.0 // no -0
}

/// Returns the number of decimals in the shortest text that parses as `value`.
fn decimals(value: f64) -> usize {
    let text = value.to_string();
    text.split_once('.').map_or(0, |(_, behind)| behind.len())
}

/// Returns the element `times` positions after the one for which `is_now` is true. The list is cyclic. If there is no
/// such element, counting begins before the first, or after the last if `times` is negative. `None` for an empty list.
pub fn cycled<T>(list: &[T], is_now: impl Fn(&T) -> bool, times: i32) -> Option<&T> {
    let count = i64::try_from(list.len()).ok().filter(|count| *count > 0)?;
    let now = match list.iter().position(is_now) {
        Some(now) => now as i64,
        None if times < 0 => 0,
        None => -1,
    };
    list.get((now + i64::from(times)).rem_euclid(count) as usize)
}

/// Returns the largest rung that is not above a hundredth of `size`. `None` if that is 0.
fn hundredth(size: f64) -> Option<f64> {
    let step = at_or_below(size / 100.0);
    (step > 0.0).then_some(step)
}

/// Parses the number at the beginning of `text`, which its unit `unit` may follow.
pub fn typed(text: &str, unit: &str) -> Result<f64, String> {
    let text = text.trim();
    let wrong = || match text {
        "" => "must be a number".to_owned(),
        _ => format!("must be a number, not \"{}\"", brief(text, 20)),
    };
    let ends = text.char_indices().map(|(at, c)| at + c.len_utf8()).rev();
    let (number, rest) = ends
        .take(LONGEST_TYPED_NUMBER)
        .find_map(|end| Some((text[..end].trim_end().parse().ok()?, text[end..].trim())))
        .ok_or_else(wrong)?;
    if rest.is_empty() || plain(rest) == plain(unit) {
        return Ok(number);
    }
    if rest.starts_with(',') {
        return Err("must have a decimal point: 0.5, not 0,5".to_owned());
    }
    match unit {
        "" => Err(wrong()),
        _ => Err(format!("is in {unit}, not in \"{}\"", brief(rest, 20))),
    }
}

/// Maximum length of a typed number, characters.
const LONGEST_TYPED_NUMBER: usize = 400;

/// Normalizes the spelling of a unit.
fn plain(unit: &str) -> String {
    unit.replace([' ', '^', '*', '·'], "")
        .replace('²', "2")
        .replace('°', "deg")
        .replace("×", "s/s")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_have_no_binary_noise() {
        assert_eq!(added(0.1, 0.2, 1), 0.3);
        assert_eq!(added(8.41, 0.01, 1), 8.42);
        assert_eq!(added(9.8, 0.1, -98), 0.0);
        assert!(added(-0.1, 0.1, 1).is_sign_positive());
        assert_eq!(added(0.565685424949238, 0.005, 1), 0.570685424949238);
    }
}
