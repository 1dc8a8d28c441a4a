//! The time axis under the strips, and the value axes next to them.

use crate::engine::text::number::{decimal, exponent, fixed, significant};
use crate::engine::text::wrap::columns;
use crate::lab::playback::scale::{self, StripScale};
use crate::lab::playback::strip::Strip;
use crate::lab::view::theme::Theme;
use crate::plot::chart::ticks::round_values;
use crate::tui::panes::write;
use crate::tui::theme::Role;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

/// Time from which times have more digits than a tick has room for, s.
const LONG_TIME_S: f64 = 1e6;
/// Time from which times are written with an exponent, s.
const MOST_TIME_S: f64 = 1e15;
/// Minimum rows of a strip for round values between its ends, and for three of them.
const ROWS_FOR_BETWEEN: usize = 7;
const MANY_ROWS: usize = 9;
/// Rows kept free next to the ends.
const ROWS_FROM_ENDS: usize = 2;
/// Maximum decimals of a value, and the significant digits of values that would need more.
const MOST_DECIMALS: usize = 7;
const EXPONENT_DIGITS: usize = 3;
/// Columns per label of the time axis.
const COLUMNS_PER_TIME: usize = 11;
/// Minimum number of labels that are tried.
const FEW_TIMES: usize = 3;
/// Minimum columns between two labels.
const TICK_LABEL_COLUMNS: usize = 2;
/// Unit after the first label, or after the last of two.
const SECONDS_SUFFIX: &str = " s";

/// First column and text of a label.
pub type PlacedTick = (usize, String);

/// Returns the labels of the time axis of `strip` on `width` cells, in order: round times, each centered under its
/// time.
pub fn times(strip: &Strip, width: usize) -> Vec<PlacedTick> {
    if strip.end_s() >= LONG_TIME_S {
        return both_ends(strip, width);
    }
    let mut most = (width / COLUMNS_PER_TIME).max(FEW_TIMES);
    loop {
        let ticks = round_values(strip.begin_s, strip.end_s(), most);
        let count = ticks.len();
        match round_times(strip, width, &ticks) {
            Some(placed) => return placed,
            // As many times or more would give the same labels again.
            None if count > 1 => most = count - 1,
            None => return Vec::new(),
        }
    }
}

/// Returns the labels of `ticks` (s), if there is room for them all.
fn round_times(strip: &Strip, width: usize, ticks: &[f64]) -> Option<Vec<PlacedTick>> {
    let apart = match ticks {
        [first, second, ..] => second - first,
        _ => strip.window_s,
    };
    let digits = scale::decimals(apart);
    if ticks.is_empty() {
        return None;
    }
    let mut placed: Vec<PlacedTick> = Vec::with_capacity(ticks.len());
    let mut free_from = 0;
    for (index, &time_s) in ticks.iter().enumerate() {
        let label = fixed(time_s + 0.0, digits);
        let share = (time_s - strip.begin_s) / strip.window_s;
        let middle = (share * width as f64).min(width as f64 - 1.0) as usize;
        let unit = if index == 0 { SECONDS_SUFFIX } else { "" };
        let length = label.len() + unit.len();
        let at = middle
            .saturating_sub(label.len() / 2)
            .min(width.checked_sub(length)?);
        if at < free_from {
            return None;
        }
        free_from = at + length + if index == 0 { 1 } else { TICK_LABEL_COLUMNS };
        placed.push((at, label + unit));
    }
    Some(placed)
}

/// Returns labels at both ends of a window of times with many digits. If there is no room, the right one states the
/// difference.
fn both_ends(strip: &Strip, width: usize) -> Vec<PlacedTick> {
    let (begin, end) = ends(strip, width);
    if begin.len() + end.len() >= width {
        return vec![(0, begin)];
    }
    vec![(0, begin), (width - end.len(), end)]
}

fn ends(strip: &Strip, width: usize) -> (String, String) {
    let digits = scale::decimals(strip.window_s / 10.0).min(6);
    // Whole numbers that distinguish the two ends, up to [`MOST_TIME_S`].
    let [begin, end] = [strip.begin_s, strip.end_s()].map(|time_s| {
        if time_s < MOST_TIME_S {
            format!("{time_s:.digits$}")
        } else {
            exponent(time_s, 3)
        }
    });
    let end_s = end + SECONDS_SUFFIX;
    if begin.len() + end_s.len() < width {
        return (begin, end_s);
    }
    let later = format!("+ {} s", decimal(strip.window_s));
    let whole = begin + SECONDS_SUFFIX;
    if whole.len() + later.len() < width {
        return (whole, later);
    }
    (exponent(strip.begin_s, 3) + SECONDS_SUFFIX, later)
}

/// A value next to a strip.
#[derive(Clone, Debug, PartialEq)]
pub struct ValueTick {
    /// Row of the strip.
    pub row: usize,
    pub label: String,
}

/// Returns the values next to a strip of `rows`: its maximum and minimum, and round values between them if there is
/// room.
pub fn values(scale: &StripScale, rows: usize) -> Vec<ValueTick> {
    let digits = scale.decimals();
    let end = |row: usize, value: f64| ValueTick {
        row,
        label: value_text(value, digits),
    };
    let mut placed = vec![end(0, scale.high)];
    if rows > 1 {
        placed.push(end(rows - 1, scale.low));
    }
    if rows < ROWS_FOR_BETWEEN {
        return placed;
    }
    let most = if rows < MANY_ROWS { 2 } else { 3 };
    let ticks = round_values(scale.low, scale.high, most);
    let apart = match ticks[..] {
        [first, second, ..] => second - first,
        _ => scale.high - scale.low,
    };
    let between = ticks.into_iter().map(|value| ValueTick {
        row: (scale.from_top(value) * (rows - 1) as f64).round() as usize,
        label: value_text(value, scale::decimals(apart)),
    });
    placed
        .extend(between.filter(|tick| (ROWS_FROM_ENDS..rows - ROWS_FROM_ENDS).contains(&tick.row)));
    placed
}

/// Returns a value of a strip with `digits` decimals, or with an exponent if these are too many to count.
pub fn value_text(value: f64, digits: usize) -> String {
    with_minus_sign(&if digits <= MOST_DECIMALS {
        fixed(value, digits)
    } else {
        significant(value, EXPONENT_DIGITS)
    })
}

/// Returns `number` with a minus sign as wide as a plus sign.
pub fn with_minus_sign(number: &str) -> String {
    number.replace('-', "−")
}

/// Columns of ticks next to the strips, as wide as the widest tick.
pub struct Gutter {
    pub width: u16,
}

impl Gutter {
    /// Returns the gutter for `scales` in strips of `rows` on a pane of `width` columns. It is empty if it would need
    /// more than half of them.
    pub fn new(scales: &[StripScale], rows: usize, width: u16) -> Self {
        let ticks = scales.iter().flat_map(|scale| values(scale, rows));
        let widest = ticks.map(|tick| columns(&tick.label) as u16).max();
        let needed = widest.unwrap_or(0) + 1;
        Self {
            width: if needed > width / 2 { 0 } else { needed },
        }
    }

    /// Writes the values of `scale` to the left of `sheet`.
    pub fn write(&self, scale: &StripScale, sheet: Rect, theme: &Theme, buf: &mut Buffer) {
        let Some(x) = sheet.x.checked_sub(self.width).filter(|_| self.width > 0) else {
            return;
        };
        let area = Rect {
            x,
            width: self.width,
            ..sheet
        };
        let style = theme.style(Role::Label);
        for tick in values(scale, sheet.height.into()) {
            let before = self.width.saturating_sub(1 + columns(&tick.label) as u16);
            write(area, (before, tick.row as u16), &tick.label, style, buf);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(strip: &Strip, width: usize) -> String {
        let mut line = String::new();
        for (at, label) in times(strip, width) {
            line += &" ".repeat(at - line.len());
            line += &label;
        }
        line
    }

    #[test]
    fn times_are_round_and_centered() {
        let of = |begin_s, window_s, width| line(&Strip::new(begin_s, window_s, 2 * width), width);
        assert_eq!(
            of(0.0, 230.0, 56),
            "0 s        50          100         150         200"
        );
        assert_eq!(of(0.0, 230.0, 25), "0 s      100        200");
        assert_eq!(of(0.0, 230.0, 12), "0 s 100  200");
        assert_eq!(of(12.0, 0.5, 30), "12.0 s   12.2         12.4");
        assert_eq!(of(0.0, 230.0, 4), "0 s");
        assert_eq!(of(0.0, 230.0, 1), "");
    }

    #[test]
    fn late_times_are_labeled_at_both_ends() {
        let at = |begin_s, width| ends(&Strip::new(begin_s, 230.0, 50), width);
        assert_eq!(
            at(1_130_220.0, 25),
            ("1130220".to_owned(), "1130450 s".to_owned())
        );
        assert_eq!(at(1.1303e12, 25).1, "+ 230 s");
        assert_eq!(at(1.1303e12, 18).0, "1.130e12 s");
    }
}
