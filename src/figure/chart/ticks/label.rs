//! What is written at a tick.

const MINUS: char = '\u{2212}';
/// The longest row of zeros that an offset has.
const MOST_ZEROS: i32 = 12;

pub fn power_of_ten(power: i32) -> String {
    format!("10^{{{}}}", with_minus(&power.to_string()))
}

pub fn with_minus(number: &str) -> String {
    number.replace('-', &MINUS.to_string())
}

/// The whole multiples of 1, 2 or 5 (`digit`) times ten to the power `decade`.
#[derive(Clone, Copy)]
pub(super) struct Numbers {
    pub(super) digit: i64,
    pub(super) decade: i32,
}

impl Numbers {
    pub(super) fn value(self, count: i64) -> f64 {
        let text = format!(
            "{}e{}",
            i128::from(count) * i128::from(self.digit),
            self.decade
        );
        text.parse().unwrap_or_default()
    }

    /// The multiple in full; of the order of ten to a `power` beyond [`MOST_ZEROS`], as a multiple of that.
    pub(super) fn offset(self, count: i64, power: i32) -> String {
        if power.abs() <= MOST_ZEROS {
            return self.label(count, 0);
        }
        format!("{}·{}", self.label(count, power), power_of_ten(power))
    }

    /// The multiple in units of ten to `power`, with all of its digits and no more.
    pub(super) fn label(self, count: i64, power: i32) -> String {
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
