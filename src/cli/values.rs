//! How the values of several commands' arguments are read.

use std::num::NonZeroU64;

pub(super) fn one_or_more(text: &str) -> Result<NonZeroU64, String> {
    text.parse()
        .map_err(|_| "must be a whole number, 1 or more".to_owned())
}

pub(super) fn steps(text: &str) -> Result<u64, String> {
    text.parse()
        .map_err(|_| "must be a whole number of steps, 0 or more, in digits".to_owned())
}

pub(super) fn length(text: &str) -> Result<u64, String> {
    match text.parse() {
        Ok(steps) if (1..=i64::MAX as u64).contains(&steps) => Ok(steps),
        Ok(0) | Err(_) => Err("must be a whole number of steps, 1 or more, in digits".to_owned()),
        Ok(_) => Err("is more steps than can be counted".to_owned()),
    }
}

pub(super) fn frames(text: &str) -> Result<u32, String> {
    match text.parse() {
        Ok(frames) if (1..=60).contains(&frames) => Ok(frames),
        _ => Err("must be a whole number from 1 to 60".to_owned()),
    }
}

pub(super) fn setting(text: &str) -> Result<String, String> {
    match text.contains('=') {
        true => Ok(text.to_owned()),
        false => Err("must be KEY=VALUE, such as motion.time_step_s=0.05".to_owned()),
    }
}

pub(super) fn positive(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(number) if number > 0.0 && f64::is_finite(number) => Ok(number),
        _ => Err("must be a number greater than zero".to_owned()),
    }
}

/// The largest picture, columns and lines.
const LARGEST: u16 = 1000;

pub(super) fn size(text: &str) -> Result<(u16, u16), String> {
    let number = |text: &str| {
        text.parse()
            .ok()
            .filter(|number| (1..=LARGEST).contains(number))
    };
    text.split_once('x')
        .and_then(|(width, height)| Some((number(width)?, number(height)?)))
        .ok_or_else(|| format!("must be columns x lines, such as 80x24, each from 1 to {LARGEST}"))
}
