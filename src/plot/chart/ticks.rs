//! Positions and labels of the ticks on an axis.
//!
//! A tick is a whole multiple of 1, 2 or 5 times a power of ten, never a sum of steps, so that no label reads
//! 0.30000000000000004. Large and small numbers move a power of ten to the axis's title. Numbers that differ only in
//! distant digits move an offset to it.

use crate::engine::text::nice_numbers;
use crate::plot::ink::{self, LABEL_PT};

/// Numbers with at least this exponent, or at most the exponent below, move a power of ten to the title.
const LARGE_POWER: i32 = 4;
const SMALL_POWER: i32 = -3;
/// A step smaller than this fraction of the numbers moves an offset to the title, because all labels would repeat the
/// same digits.
const OFFSET: f64 = 2e-6;
/// Maximum number of ticks. An axis with more room gets minor ticks instead.
const MOST_TICKS: f64 = 8.0;
/// Relative differences below this are rounding errors.
const TICK_ROUNDING: f64 = 1e-9;

const MINUS: char = '\u{2212}';
/// Maximum number of zeros in an offset.
const MOST_ZEROS: i32 = 12;

#[derive(Clone, Debug, PartialEq)]
pub struct Tick {
    pub at: f64,
    pub label: String,
}

impl Tick {
    /// Returns half the width of its label, pt.
    pub fn half_width(&self) -> f64 {
        0.5 * ink::width(&self.label, LABEL_PT)
    }
}

#[derive(Clone, Debug, Default, PartialEq)]
pub struct Ticks {
    /// Ticks with a label, in ascending order.
    pub major: Vec<Tick>,
    pub minor: Vec<f64>,
    /// Exponent of the power of ten that is the unit of the labels.
    pub power: i32,
    /// Offset to add to the labels, as text for the title; `None` if it is 0.
    pub offset: Option<String>,
}

impl Ticks {
    /// Returns the ticks of a linear axis from `low` to `high`, both finite: the finest ticks whose labels have room
    /// according to `fits`. If no step has room, only the ends get labels.
    pub fn linear(low: f64, high: f64, fits: impl Fn(&[Tick]) -> bool) -> Self {
        let span = high - low;
        if !(span > 0.0 && span.is_finite()) {
            return Self::default();
        }
        let first = nice_numbers::rung_below(span / MOST_TICKS);
        let choices = (first..first + 6).map(|rung| Self::with_step(low, high, rung));
        let mut best = Self::default();
        for ticks in choices {
            if ticks.major.is_empty() {
                break;
            }
            let fit = ticks.major.len() <= MOST_TICKS as usize + 1 && fits(&ticks.major);
            let are_few = ticks.major.len() < 2 && best.major.len() >= 2;
            if are_few {
                break;
            }
            best = ticks;
            if fit {
                return best;
            }
        }
        best.with_few_labels(fits)
    }

    /// Keeps the labels of the first and last tick only; if these have no room either, only the last.
    fn with_few_labels(mut self, fits: impl Fn(&[Tick]) -> bool) -> Self {
        if fits(&self.major) || self.major.len() < 2 {
            return self;
        }
        let inner = self.major.drain(1..self.major.len() - 1);
        self.minor.extend(inner.map(|tick| tick.at));
        if !fits(&self.major) {
            self.minor.push(self.major.remove(0).at);
        }
        self.minor.sort_by(f64::total_cmp);
        self
    }

    /// Returns the ticks whose step is this rung of the ladder.
    fn with_step(low: f64, high: f64, rung: i64) -> Self {
        let step = nice_numbers::rung(rung);
        let numbers = RoundMultiples::of_rung(rung);
        let largest = low.abs().max(high.abs());
        let counts = between(low / step, high / step);
        let is_offset = step < OFFSET * largest;
        let power = if is_offset {
            leading_power(high - low)
        } else {
            leading_power(largest)
        };
        let base = if is_offset { counts.0 } else { 0 };
        let major = (counts.0..=counts.1).map(|count| Tick {
            at: numbers.value(count),
            label: numbers.label(count - base, power),
        });
        let parts = if numbers.digit == 2 { 4 } else { 5 };
        let fine = between(
            low / step * f64::from(parts),
            high / step * f64::from(parts),
        );
        let minor = (fine.0..=fine.1).filter(|count| count.rem_euclid(i64::from(parts)) != 0);
        Self {
            major: major.collect(),
            minor: minor
                .map(|count| step * (count as f64 / f64::from(parts)))
                .collect(),
            power,
            offset: is_offset.then(|| numbers.offset(base, leading_power(largest))),
        }
    }

    /// Returns the ticks of a logarithmic axis from `low` to `high`, both above 0: powers of ten as close as `fits`
    /// allows. Over less than one and a half decades, their multiples by 2 and 5 are used too, or the ticks of a linear
    /// axis.
    pub fn log(low: f64, high: f64, fits: impl Fn(&[Tick]) -> bool) -> Self {
        let (first, last) = (ceil(libm::log10(low)), floor(libm::log10(high)));
        if high / low < 32.0 {
            let close = Self::of_rungs(low, high);
            let are_enough = close.major.len() >= 2 && fits(&close.major);
            return if are_enough {
                close
            } else {
                Self::linear(low, high, fits)
            };
        }
        let every = (1..=last - first + 1)
            .find(|&every| fits(&decades(first, last, every)))
            .unwrap_or(last - first + 1);
        let minor = match every {
            1 => (first - 1..=last).flat_map(parts_of_decade).collect(),
            _ => (first..=last)
                .filter(|power| power.rem_euclid(every) != 0)
                .map(|power| nice_numbers::rung(3 * power))
                .collect::<Vec<_>>(),
        };
        Self {
            major: decades(first, last, every),
            minor: minor
                .into_iter()
                .filter(|at| (low..=high).contains(at))
                .collect(),
            ..Self::default()
        }
    }

    fn of_rungs(low: f64, high: f64) -> Self {
        let begin = nice_numbers::rung_below(low);
        let rungs: Vec<_> = (begin..)
            .map(|rung| (rung, nice_numbers::rung(rung)))
            .take_while(|(_, at)| *at <= high * (1.0 + TICK_ROUNDING))
            .filter(|(_, at)| *at >= low * (1.0 - TICK_ROUNDING))
            .collect();
        let power = leading_power(high);
        let major = rungs.iter().map(|&(rung, at)| Tick {
            at,
            label: RoundMultiples::of_rung(rung).label(1, power),
        });
        let minor = (floor(libm::log10(low))..=floor(libm::log10(high))).flat_map(parts_of_decade);
        Self {
            major: major.collect(),
            minor: minor.filter(|at| (low..=high).contains(at)).collect(),
            power,
            offset: None,
        }
    }
}

/// Returns the finest round values from `low` to `high`, at most `most` of them.
pub fn round_values(low: f64, high: f64, most: usize) -> Vec<f64> {
    let range = high - low;
    if !(range > 0.0 && range.is_finite()) || most == 0 {
        return Vec::new();
    }
    let first = nice_numbers::rung_below(range / most as f64);
    let finest = (first..first + 4).find_map(|rung| {
        let step = nice_numbers::rung(rung);
        let (from, to) = between(low / step, high / step);
        let numbers = RoundMultiples::of_rung(rung);
        (to - from < most as i64).then(|| (from..=to).map(|count| numbers.value(count)).collect())
    });
    finest.unwrap_or_default()
}

fn between(low: f64, high: f64) -> (i64, i64) {
    (ceil(low), floor(high))
}

fn ceil(number: f64) -> i64 {
    (number - TICK_ROUNDING).ceil() as i64
}

fn floor(number: f64) -> i64 {
    (number + TICK_ROUNDING).floor() as i64
}

/// Returns the exponent that numbers up to `largest` move to the title: a multiple of 3, and 0 for ordinary numbers.
fn leading_power(largest: f64) -> i32 {
    let exponent = libm::log10(largest).floor() as i32;
    if (SMALL_POWER + 1..LARGE_POWER).contains(&exponent) {
        0
    } else {
        exponent.div_euclid(3) * 3
    }
}

/// Returns 2, 3, ..., 9 times this power of ten.
fn parts_of_decade(power: i64) -> impl Iterator<Item = f64> {
    (2..10).map(move |digit| f64::from(digit) * nice_numbers::rung(3 * power))
}

/// Returns ticks at the powers of ten from `first` to `last` whose exponents are multiples of `every`.
fn decades(first: i64, last: i64, every: i64) -> Vec<Tick> {
    let powers = (first..=last).filter(|power| power.rem_euclid(every) == 0);
    powers.map(|power| decade(power as i32)).collect()
}

fn decade(power: i32) -> Tick {
    let label = match power {
        0 => "1".to_owned(),
        1 => "10".to_owned(),
        power => power_of_ten(power),
    };
    Tick {
        at: nice_numbers::rung(3 * i64::from(power)),
        label,
    }
}

pub fn power_of_ten(power: i32) -> String {
    format!("10^{{{}}}", with_minus(&power.to_string()))
}

pub fn with_minus(number: &str) -> String {
    number.replace('-', &MINUS.to_string())
}

/// The whole multiples of 1, 2 or 5 (`digit`) times ten to the power `decade`.
#[derive(Clone, Copy)]
struct RoundMultiples {
    digit: i64,
    decade: i32,
}

impl RoundMultiples {
    /// Returns the multiples of this rung of the ladder.
    fn of_rung(rung: i64) -> Self {
        Self {
            digit: [1, 2, 5][rung.rem_euclid(3) as usize],
            decade: rung.div_euclid(3) as i32,
        }
    }

    fn value(self, count: i64) -> f64 {
        let text = format!(
            "{}e{}",
            i128::from(count) * i128::from(self.digit),
            self.decade
        );
        text.parse().unwrap_or_default()
    }

    /// Formats the multiple in full. If `power` exceeds [`MOST_ZEROS`], it is written as a multiple of ten to that
    /// power.
    fn offset(self, count: i64, power: i32) -> String {
        if power.abs() <= MOST_ZEROS {
            return self.label(count, 0);
        }
        format!("{}·{}", self.label(count, power), power_of_ten(power))
    }

    /// Formats the multiple in units of ten to `power`, with exactly its digits.
    fn label(self, count: i64, power: i32) -> String {
        let exponent = self.decade - power;
        let whole = i128::from(count) * i128::from(self.digit);
        let text = match u32::try_from(exponent) {
            Ok(zeros) if whole != 0 => format!("{whole}{}", "0".repeat(zeros as usize)),
            Ok(_) => "0".to_owned(),
            Err(_) => {
                let decimals = exponent.unsigned_abs() as usize;
                let digits = format!("{:0>width$}", whole.abs(), width = decimals + 1);
                let (before, after) = digits.split_at(digits.len() - decimals);
                let sign = if whole < 0 { "-" } else { "" };
                format!("{sign}{before}.{after}")
            }
        };
        with_minus(&text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn labels(ticks: &Ticks) -> Vec<&str> {
        ticks.major.iter().map(|tick| tick.label.as_str()).collect()
    }

    fn at_most(most: usize) -> impl Fn(&[Tick]) -> bool {
        move |ticks| ticks.len() <= most
    }

    #[test]
    fn tick_labels_are_the_tick_values() {
        let tenths = Ticks::linear(0.0, 0.41, at_most(9));
        assert_eq!(labels(&tenths)[3], "0.15");
        assert!(tenths.major.iter().any(|tick| tick.at == 0.15));
    }

    #[test]
    fn labels_omit_the_power_or_offset_in_the_title() {
        let far = [30.000_000_1, 30.000_000_5];
        for ([low, high], most, expected, power, offset) in [
            ([0.0, 230.0], 6, "0 50 100 150 200", 0, None),
            ([-0.95, 0.93], 5, "−0.5 0.0 0.5", 0, None),
            ([0.0, 100_000.0], 6, "0 20 40 60 80 100", 3, None),
            ([0.0, 4e-9], 5, "0 1 2 3 4", -9, None),
            (far, 5, "0 100 200 300 400", -9, Some("30.0000001")),
        ] {
            let ticks = Ticks::linear(low, high, at_most(most));
            let found = (
                labels(&ticks).join(" "),
                ticks.power,
                ticks.offset.as_deref(),
            );
            assert_eq!(found, (expected.to_owned(), power, offset));
        }
        // An offset of many digits has a power of ten.
        let offset = |at: f64| Ticks::linear(at, at + 1e-7 * at, at_most(5)).offset;
        assert!(offset(1e-30).unwrap().ends_with("·10^{−30}"));
        assert!(offset(1e30).unwrap().ends_with("·10^{30}"));
    }

    #[test]
    fn a_logarithmic_axis_has_as_many_decades_as_fit() {
        let wide = Ticks::log(1e-14, 1.0, at_most(8));
        assert_eq!(labels(&wide).first(), Some(&"10^{−14}"));
        assert_eq!(labels(&wide).last(), Some(&"1"));
        assert_eq!(wide.major.len(), 8);
        let close = Ticks::log(0.011, 0.11, at_most(8));
        assert_eq!(labels(&close), ["0.02", "0.05", "0.1"]);
        let narrow = Ticks::log(0.031, 0.034, at_most(8));
        assert!(narrow.major.len() >= 3);
    }

    #[test]
    fn tick_values_are_round_and_fit_the_room() {
        for (low, high, most, expected) in [
            (0.0, 230.0, 6, &[0.0, 50.0, 100.0, 150.0, 200.0][..]),
            (0.0, 230.0, 2, &[0.0, 200.0]),
            (-0.8, 0.8, 5, &[-0.5, 0.0, 0.5]),
            (12.25, 12.35, 3, &[12.25, 12.3, 12.35]),
            (1.0, 1.0, 5, &[]),
            (0.0, f64::INFINITY, 5, &[]),
            (0.0, 1.0, 0, &[]),
        ] {
            assert_eq!(round_values(low, high, most), expected, "{low} to {high}");
        }
    }

    proptest! {
        #[test]
        fn every_label_parses_to_its_tick_value(low in -1e6_f64..1e6, exponent in -9_i32..12, most in 2_usize..9) {
            let span = libm::exp10(f64::from(exponent));
            prop_assume!(span > 1e-9 * low.abs()); // an axis shows no rounding
            let ticks = Ticks::linear(low, low + span, at_most(most));
            prop_assert!(!ticks.major.is_empty());
            let offset: f64 = ticks.offset.as_deref().map_or(0.0, |text| text.replace('−', "-").parse().unwrap());
            for tick in &ticks.major {
                let label: f64 = tick.label.replace('−', "-").parse().unwrap();
                let told = offset + label * libm::exp10(f64::from(ticks.power));
                prop_assert!((told - tick.at).abs() <= 1e-9 * span + 1e-15 * tick.at.abs(), "{tick:?}");
                prop_assert!(tick.at >= low - 1e-6 * span && tick.at <= low + span * (1.0 + 1e-6));
                prop_assert!(!tick.label.contains('-') && tick.label.len() < 16, "{tick:?}");
            }
            prop_assert!(ticks.major.windows(2).all(|pair| pair[0].at < pair[1].at));
            prop_assert!(ticks.major.len() <= most.max(3));
        }

        #[test]
        fn any_range_has_a_limited_number_of_ticks(low in any::<f64>(), high in any::<f64>()) {
            let ticks = Ticks::linear(low.min(high), low.max(high), at_most(6));
            prop_assert!(ticks.major.len() <= 9 && ticks.minor.len() <= 60);
            let (low, high) = (low.abs().min(high.abs()), low.abs().max(high.abs()));
            if low > 0.0 && high.is_finite() && high > low {
                let decades = Ticks::log(low, high, at_most(6));
                prop_assert!(decades.major.len() <= 9, "{:?}", decades.major);
            }
        }
    }
}
