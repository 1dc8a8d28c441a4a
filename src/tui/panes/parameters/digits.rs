//! A number in the room that there is for it.

use crate::text::number::{shortest, significant};
use std::borrow::Cow;

/// Digits of a number in a pane. The key line below the values, the dialog and files have all of them.
const DIGITS: usize = 7;

/// `number` as a pane shows it.
pub(super) fn in_pane(number: f64) -> String {
    if number.fract() == 0.0 {
        return shortest(number);
    }
    significant(number, DIGITS)
}

/// `text`, or with fewer decimals where it is a number that is wider than `room`.
pub(super) fn fewer_digits(text: &str, room: usize) -> Cow<'_, str> {
    let is_wide = text.len() > room;
    let number = text.parse::<f64>().ok().filter(|_| is_wide);
    let Some(number) = number else {
        return text.into();
    };
    let decimals = (1..room).rev().map(|digits| format!("{number:.digits$}"));
    let exponents = (0..room).rev().map(|digits| format!("{number:.digits$e}"));
    let is_told = |text: &String| text.parse::<f64>().is_ok_and(|told| near(told, number));
    let mut fitting = decimals.chain(exponents).filter(|text| text.len() <= room);
    fitting.find(is_told).map_or(text.into(), Cow::from)
}

fn near(told: f64, number: f64) -> bool {
    (told - number).abs() <= 1e-3 * number.abs()
}
