//! Parsers for the values of arguments.

use crate::tui::terminal::MOST_SCREEN_CELLS;
use std::num::NonZeroU64;
use std::str::FromStr;

/// Units of a time, and of a number of steps.
const MEANT_IN_SECONDS: &str = "in seconds";
const MEANT_IN_STEPS: &str = "in time steps";

pub(super) fn one_or_more(text: &str) -> Result<NonZeroU64, String> {
    text.parse()
        .map_err(|_| "must be a whole number, 1 or more".to_owned())
}

/// Parses the number `text`, checked by `fits`. The error is `rule`, or mentions the unit `meant` if `text` has a unit.
fn bare<T: FromStr>(
    text: &str,
    fits: fn(&T) -> bool,
    meant: &str,
    rule: &str,
) -> Result<T, String> {
    let number = text.parse().ok().filter(fits);
    number.ok_or_else(|| without_unit(text, meant).unwrap_or_else(|| rule.to_owned()))
}

pub(super) fn steps(text: &str) -> Result<u64, String> {
    let rule = "must be a whole number of steps, 0 or more, in digits";
    bare(text, |_| true, MEANT_IN_STEPS, rule)
}

pub(super) fn length(text: &str) -> Result<u64, String> {
    let rule = "must be a whole number of steps, 1 or more, in digits";
    let steps = bare(text, |steps| *steps > 0, MEANT_IN_STEPS, rule)?;
    if i64::try_from(steps).is_err() {
        return Err("is more steps than can be counted".to_owned());
    }
    Ok(steps)
}

pub(super) fn frames(text: &str) -> Result<u32, String> {
    match text.parse() {
        Ok(frames) if (1..=60).contains(&frames) => Ok(frames),
        _ => Err("must be a whole number from 1 to 60".to_owned()),
    }
}

pub(super) fn setting(text: &str) -> Result<String, String> {
    if text.contains('=') {
        Ok(text.to_owned())
    } else {
        Err("must be KEY=VALUE, such as motion.time_step_s=0.05".to_owned())
    }
}

pub(super) fn positive(text: &str) -> Result<f64, String> {
    bare(
        text,
        |number| *number > 0.0 && number.is_finite(),
        MEANT_IN_SECONDS,
        "must be a number greater than zero",
    )
}

pub(super) fn size(text: &str) -> Result<(u16, u16), String> {
    let (columns, lines) = MOST_SCREEN_CELLS;
    let number = |part: &str, most| {
        let number = part.parse().ok();
        number.filter(|number| (1..=most).contains(number))
    };
    text.split_once('x')
        .and_then(|(width, height)| Some((number(width, columns)?, number(height, lines)?)))
        .ok_or_else(|| {
            format!("must be columns x lines, such as 80x24, from 1x1 to {columns}x{lines}")
        })
}

/// Returns the error for a number followed by a unit, such as `20s`. `meant` is the expected unit.
fn without_unit(text: &str, meant: &str) -> Option<String> {
    let number = text.trim_end_matches(char::is_alphabetic).trim_end();
    let unit = text.strip_prefix(number)?.trim_start();
    let value: f64 = number.parse().ok()?;
    let is_unit = !unit.is_empty() && value.is_finite() && value >= 0.0;
    is_unit.then(|| match unit {
        "s" | "sec" | "second" | "seconds" if meant == MEANT_IN_SECONDS => {
            format!("must be a number without a unit: write {number}, {meant}")
        }
        _ => format!("must be a number without a unit ({unit}), {meant}"),
    })
}

/// Parses a time since the start of the run, s.
pub(super) fn time(text: &str) -> Result<f64, String> {
    bare(
        text,
        |seconds| *seconds >= 0.0 && seconds.is_finite(),
        MEANT_IN_SECONDS,
        "must be a time in seconds, 0 or more",
    )
}
