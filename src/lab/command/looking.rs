//! Reads the values of the commands that choose how the run is shown.

use super::reading::{Read, field, fields, number, number_in, of_view, place, text_in, wrong};
use super::{Command, CursorTo, MOST_MAGNIFIED, NEXT_TURN, NONE, TURN_BEFORE};
use crate::lab::view::step::Page;
use crate::lab::view::{Pane, Part};
use crate::observe::camera::{Camera, Zoom};
use crate::observe::pace::Speed;
use crate::scenario::Problem;
use crate::scenario::file::Choice;
use crate::scenario::keys::{PITCH_DEG, Range, ZOOM};
use toml::Value;

/// The text that `value` is as the key `view.name`.
pub(super) fn text_of(name: &str, value: &Value) -> Result<String, Vec<Problem>> {
    Ok(text_in(of_view(name, value)?).to_owned())
}

pub(super) fn flag_of(name: &str, value: &Value) -> Result<bool, Vec<Problem>> {
    Ok(of_view(name, value)?.as_bool().unwrap_or_default())
}

pub(super) fn number_of(name: &str, value: &Value) -> Result<f64, Vec<Problem>> {
    of_view(name, value).map(number_in)
}

pub(super) fn speed(value: &Value) -> Read {
    match value {
        Value::String(word) if word == "top" => Ok(Command::Speed(Speed::Top)),
        Value::String(_) => wrong(value, "must be a number greater than zero, or \"top\""),
        _ => Ok(Command::Speed(Speed::Times(number_of("speed", value)?))),
    }
}

pub(super) fn since(value: &Value) -> Read {
    if value.as_str() == Some(NONE) {
        return Ok(Command::Since(None));
    }
    number(Range::NotNegative, value).map(|since_s| Command::Since(Some(since_s)))
}

pub(super) fn magnify(value: &Value) -> Read {
    let times = number(Range::Positive, value)?;
    if (1.0..=MOST_MAGNIFIED).contains(&times) {
        Ok(Command::Magnify(times))
    } else {
        wrong(value, "must be between 1 and 1000000")
    }
}

pub(super) fn cursor(value: &Value) -> Read {
    let to = match value.as_str() {
        Some(NONE) => Some(CursorTo::Nowhere),
        Some(NEXT_TURN) => Some(CursorTo::NextTurn),
        Some(TURN_BEFORE) => Some(CursorTo::TurnBefore),
        _ => place(value).map(CursorTo::Place),
    };
    match to {
        Some(to) => Ok(Command::Cursor(to)),
        None => wrong(
            value,
            "must be a step from 0 on (421), a time (\"12.5 s\"), \"start\", \"end\", \"next turn\", \"turn before\" or \"none\"",
        ),
    }
}

pub(super) fn show(value: &Value) -> Read {
    let list = of_view("show", value)?.as_array();
    let ids = list.into_iter().flatten().map(text_in);
    Ok(Command::Show(ids.filter_map(Pane::named).collect()))
}

pub(super) fn hide(value: &Value) -> Read {
    let list = of_view("hide", value)?.as_array();
    let ids = list.into_iter().flatten().map(text_in);
    Ok(Command::Hide(ids.filter_map(Part::named).collect()))
}

pub(super) fn phase(value: &Value) -> Read {
    let choice = choice_in(of_view("phase", value)?);
    Ok(Command::Phase(Page::of(&choice).unwrap_or_default()))
}

pub(super) fn sum_to(value: &Value) -> Read {
    let rows = match choice_in(of_view("sum_to", value)?) {
        Choice::Number(rows) => usize::try_from(rows).ok(),
        Choice::Word(_) => None,
    };
    Ok(Command::SumTo(rows))
}

/// A whole number from 0 on, or the word.
fn choice_in(value: &Value) -> Choice {
    let number = value.as_integer().map(u64::try_from);
    match number {
        Some(Ok(number)) => Choice::Number(number),
        _ => Choice::Word(text_in(value).to_owned()),
    }
}

pub(super) fn camera(value: &Value) -> Read {
    let table = fields(value, &["yaw_deg", "pitch_deg"])?;
    let angle = |name: &str, range| field(table, name, |value| number(range, value));
    let usual = Camera::default();
    Ok(Command::Camera(Camera {
        yaw_deg: angle("yaw_deg", Range::Any)?.unwrap_or(usual.yaw_deg),
        pitch_deg: angle("pitch_deg", Range::Within(PITCH_DEG))?.unwrap_or(usual.pitch_deg),
    }))
}

pub(super) fn zoom(value: &Value) -> Read {
    let table = fields(value, &["above", "3d"])?;
    let factor = |name: &str| field(table, name, |value| number(Range::Within(ZOOM), value));
    let whole = Zoom::default();
    Ok(Command::Zoom(Zoom {
        above: factor("above")?.unwrap_or(whole.above),
        three_d: factor("3d")?.unwrap_or(whole.three_d),
    }))
}
