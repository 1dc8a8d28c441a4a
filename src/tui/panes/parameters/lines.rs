//! The lines of the pane. Each number has as many decimals as there is room for.

use crate::engine::analysis::Readouts;
use crate::engine::analysis::readouts::{InPane, PaneGroup, READOUTS};
use crate::engine::analysis::remarks::{short_no_drift, short_unit};
use crate::engine::analysis::theory::{AxlePath, TheoryAxis};
use crate::engine::scenario::{Motion, Scenario, Window};
use crate::engine::text::number::{
    NOT_AVAILABLE, exponent, fixed as decimals_of, shortest, significant, without_minus_zero,
};
use crate::lab::playback::reading::Reading;
use crate::physics::{Body, Friction};
use crate::tui::theme::Role;
use std::borrow::Cow;

pub(super) const VALUE_END: u16 = 18;

pub(super) const COLUMN: u16 = 26;

/// Digits of a number in a pane. The key line below the values, the dialog and files have all of them.
const PANE_DIGITS: usize = 7;

/// The label of what theory predicts for the number above it.
pub(super) const PREDICTED_LABEL: &str = "predicted";

#[derive(Clone)]
pub(super) struct ParameterLine {
    /// Where there is no room for all, lines of higher rank are left out first.
    pub(super) rank: u8,
    pub(super) label: Cow<'static, str>,
    pub(super) label_role: Role,
    pub(super) value: String,
    pub(super) value_role: Role,
    pub(super) unit: Cow<'static, str>,
    pub(super) is_selected: bool,
}

impl ParameterLine {
    pub(super) fn is_heading(&self) -> bool {
        self.label_role == Role::Heading
    }
}

pub(super) fn heading(label: impl Into<Cow<'static, str>>) -> ParameterLine {
    ParameterLine {
        label: label.into(),
        label_role: Role::Heading,
        ..value(0, "", String::new(), "")
    }
}

pub(super) fn value(
    rank: u8,
    label: &'static str,
    value: String,
    unit: &'static str,
) -> ParameterLine {
    ParameterLine {
        rank,
        label: label.into(),
        label_role: Role::Label,
        value,
        value_role: Role::Text,
        unit: unit.into(),
        is_selected: false,
    }
}

/// A number, which may not be known (yet), with `digits` decimals, or as many as there is room for beside its label.
fn number(
    rank: u8,
    label: &'static str,
    number: impl Into<Option<f64>>,
    digits: usize,
    unit: &'static str,
) -> ParameterLine {
    value(rank, label, fixed(label, number.into(), digits), unit)
}

/// As [`number`], of a quantity of the size `size`. A small number that would lose its digits has an exponent.
fn sized(
    rank: u8,
    label: &'static str,
    number: f64,
    size: f64,
    digits: usize,
    unit: &'static str,
) -> ParameterLine {
    /// A number smaller than this part of the size is rounding error.
    const ZERO_ROUNDING: f64 = 1e-9;
    let is_small = size > 0.0 && size < 0.1;
    if is_small && number.abs() > ZERO_ROUNDING * size {
        value(rank, label, exponent(number, 3), unit)
    } else {
        self::number(rank, label, number, digits, unit)
    }
}

/// A number of the scenario: with `digits` decimals where it has no more, else with as many as there is room for beside
/// its label.
fn given(
    rank: u8,
    label: &'static str,
    number: f64,
    digits: usize,
    unit: &'static str,
) -> ParameterLine {
    let usual = fixed(label, Some(number), digits);
    let is_whole = usual.parse() == Ok(number);
    let room = (VALUE_END as usize).saturating_sub(label.len() + 2);
    let text = if is_whole {
        usual
    } else {
        fewer_digits(&in_pane(number), room).into_owned()
    };
    value(rank, label, text, unit)
}

/// Quantities that follow from the body's values.
pub(super) fn derived_lines(scenario: &Scenario) -> Vec<ParameterLine> {
    let body: &Body = &scenario.body.mechanics;
    let height = body.first_moment().z / body.mass();
    vec![
        heading("body"),
        number(3, "mass", body.mass(), 3, "kg"),
        number(6, "mass at z", height, 4, "m"),
    ]
}

pub(super) fn body_lines(scenario: &Scenario) -> Vec<ParameterLine> {
    let mut lines = derived_lines(scenario);
    if let Some(rim) = &scenario.file.body.rim {
        lines.push(given(4, "rim radius", rim.radius_m, 4, "m"));
        lines.push(value(6, "rim points", rim.points.to_string(), ""));
    }
    lines
}

pub(super) fn start_lines(scenario: &Scenario) -> Vec<ParameterLine> {
    let tilt = scenario.file.start.tilt_deg.unwrap_or(0.0);
    let momentum = scenario.file.start.momentum_Js;
    let size = scenario.start.momentum.norm();
    let [x, y, z] = momentum.unwrap_or(scenario.start.momentum.into());
    // What was given is shown as it was given, what follows from it in the digits of |L|.
    let part = |label, number| match momentum {
        Some(_) => given(5, label, number, 3, "J s"),
        None => sized(5, label, number, size, 3, "J s"),
    };
    let frame = scenario.file.start.momentum_frame.unwrap_or_default();
    vec![
        heading("start"),
        given(2, "tilt", tilt, 3, "deg"),
        sized(0, "|L|", size, size, 3, "J s"),
        part("Lx", x),
        part("Ly", y),
        part("Lz", z),
        value(5, "L given in", frame.name().to_owned(), ""),
    ]
}

/// The friction, where there is one: its coefficient, or how many there are.
fn friction_line(friction: &Friction) -> Option<ParameterLine> {
    let coefficients = [
        (friction.spin_dry, "N m"),
        (friction.spin_viscous, "N m s"),
        (friction.spin_quadratic, "N m s2"),
        (friction.swing_viscous, "N m s"),
    ];
    let acting = coefficients.into_iter().filter(|(size, _)| *size > 0.0);
    let (value_of_it, unit) = match acting.clone().count() {
        0 => return None,
        1 => acting.map(|(size, unit)| (in_pane(size), unit)).next()?,
        count => (count.to_string(), "kinds"),
    };
    Some(value(2, "friction", value_of_it, unit))
}

pub(super) fn motion_lines(scenario: &Scenario, motion: &Motion) -> Vec<ParameterLine> {
    let (rank, pushes) = match &scenario.pushes[..] {
        [] => (5, "none".to_owned()),
        [push] => (2, format!("{} N", decimals_of(push.force.norm(), 0))),
        more => (2, more.len().to_string()),
    };
    let mut lines = vec![
        heading("motion"),
        value(0, "dt", in_pane(motion.time_step_s), "s"),
        value(3, "scheme", motion.scheme.name.to_owned(), ""),
        given(4, "gravity", motion.gravity, 3, "m/s2"),
        value(6, "steps", scenario.steps.to_string(), ""),
        value(rank, "push", pushes, ""),
    ];
    lines.extend(friction_line(&scenario.friction));
    if let [push] = &scenario.pushes[..] {
        let ([from, to], unit) = match push.window {
            Window::Steps { first, count } => {
                let last = (first - 1).saturating_add(count);
                ([first, last].map(|step| step.to_string()), "step")
            }
            Window::Time { from_s, for_s } => ([from_s, from_s + for_s].map(in_pane), "s"),
        };
        lines.push(value(3, "acts", format!("{from} to {to}"), unit));
    }
    lines
}

pub(super) fn now_lines(reading: &Reading) -> Vec<ParameterLine> {
    let sample = &reading.readouts.sample;
    let momentum = sample.momentum.norm();
    let kinetic = 0.5 * sample.momentum.dot(&sample.angular_velocity);
    // A scheme that has broken down leaves neither a position nor an energy of a rigid body.
    let of_body = |number: f64| reading.readouts.health.is_a_rotation.then_some(number);
    let axis = |label, role, metres: f64| ParameterLine {
        label_role: role,
        ..number(0, label, of_body(metres), 4, "m")
    };
    let mut lines = vec![
        heading("now"),
        axis("x", Role::Run, sample.position.x),
        axis("y", Role::Run, sample.position.y),
        axis("z", Role::Run, sample.position.z),
    ];
    lines.extend(watched_lines(reading));
    let after_nutation = lines.len() - 1;
    let predicted = reading.readouts.number("predicted_nutation_period_s");
    lines.insert(
        after_nutation,
        number(1, PREDICTED_LABEL, predicted, 5, "s"),
    );
    lines.extend([
        sized(3, "|L|", momentum, momentum, 3, "J s"),
        sized(4, "Lz", sample.momentum.z, momentum, 3, "J s"),
        match of_body(sample.energy) {
            Some(energy) => sized(4, "energy", energy, kinetic.max(energy.abs()), 2, "J"),
            None => number(4, "energy", None, 2, "J"),
        },
    ]);
    lines
}

/// The readouts that are shown too where there is room: the extremes so far, and how the wheel turns.
pub(super) fn further_lines(reading: &Reading) -> Vec<ParameterLine> {
    let readouts = &reading.readouts;
    let mut lines = vec![heading("so far")];
    lines.extend(readout_lines(PaneGroup::SoFar, readouts));
    lines.push(heading("wheel"));
    lines.extend(readout_lines(PaneGroup::Wheel, readouts));
    // Of a nearly symmetric body the predicted numbers are those of its mean moment.
    if let Some(asymmetry) = readouts.asymmetry.filter(|asymmetry| *asymmetry > 0.0) {
        let percent = significant(100.0 * asymmetry, 2);
        lines.push(value(8, "asymmetry", percent, "%"));
    }
    lines
}

/// The lines of the readouts of `group`, below each what theory predicts for it.
fn readout_lines(group: PaneGroup, readouts: &Readouts) -> Vec<ParameterLine> {
    let in_pane = READOUTS.iter().filter_map(|row| Some((row, row.in_pane?)));
    let mut shown: Vec<_> = in_pane.filter(|(_, line)| line.group == group).collect();
    shown.sort_by_key(|(_, line)| line.place);
    let mut lines = Vec::new();
    for (
        row,
        InPane {
            label,
            decimals,
            rank,
            unit,
            ..
        },
    ) in shown
    {
        let shown_unit = unit.unwrap_or(row.unit);
        let is_lost = row.is_of_body() && !readouts.health.is_a_rotation;
        let known = row.read_from(readouts).number().filter(|_| !is_lost);
        lines.push(number(rank, label, known, decimals, shown_unit));
        if let Some(predicted) = row.predicted() {
            let number_of_theory = predicted.read_from(readouts).number();
            lines.push(number(
                rank + 1,
                PREDICTED_LABEL,
                number_of_theory,
                decimals,
                shown_unit,
            ));
        }
    }
    lines
}

/// The readouts to watch while values are edited; the last is the energy's drift.
pub(super) fn watched_lines(reading: &Reading) -> [ParameterLine; 5] {
    let readouts = &reading.readouts;
    let health = &readouts.health;
    let nutation = match readouts.nutation_is_resolved() {
        Some(false) => "nutation?", // strobed: the line below the panes says whose swing it is
        _ => "nutation",
    };
    let period_s = readouts.number("measured_nutation_period_s");
    let tilt = health.is_a_rotation.then_some(readouts.sample.tilt_deg);
    // An axle that passes through the vertical has no precession. Any other has none so far.
    let theory = readouts.theory.as_ref();
    let has_none = theory.is_some_and(|theory| {
        theory.axis == TheoryAxis::Z && theory.path == AxlePath::ThroughVertical
    });
    let rate = |rank, label, rate: Option<f64>| match rate {
        None if has_none => value(rank, label, "none".to_owned(), ""),
        rate => number(rank, label, rate, 3, "deg/s"),
    };
    let predicted = readouts.number("predicted_precession_rad_per_s");
    let energy_unit = health.energy_unit;
    let (drift, unit) = match health.energy_drift {
        Some(_) if !health.is_a_rotation => ("-".to_owned(), short_unit(energy_unit)),
        Some(drift) => (signed("E drift", drift, 4), short_unit(energy_unit)),
        None => (short_no_drift(energy_unit).to_owned(), ""),
    };
    [
        number(0, "tilt", tilt, 3, "deg"),
        rate(0, "precession", reading.precession_deg_per_s()),
        rate(1, PREDICTED_LABEL, predicted.map(f64::to_degrees)),
        number(1, nutation, period_s, 5, "s"),
        value(2, "E drift", drift, unit),
    ]
}

/// `number` beside `label` with `digits` decimals, or fewer; a dash where there is none.
fn fixed(label: &str, number: Option<f64>, digits: usize) -> String {
    number.map_or("-".to_owned(), |number| {
        fitted(
            label,
            digits,
            |digits| without_minus_zero(format!("{number:.digits$}")),
            number,
        )
    })
}

/// As [`fixed`], with its sign.
fn signed(label: &str, number: f64, digits: usize) -> String {
    let is_zero = decimals_of(number, digits).parse() == Ok(0.0);
    let number = if is_zero { 0.0 } else { number }; // no -0.0000
    fitted(
        label,
        digits,
        |digits| format!("{number:+.digits$}"),
        number,
    )
}

/// `number` with the most decimals for which `format` leaves a blank after `label`, or with an exponent.
fn fitted(label: &str, digits: usize, format: impl Fn(usize) -> String, number: f64) -> String {
    if !number.is_finite() {
        return NOT_AVAILABLE.to_owned();
    }
    let room = (VALUE_END as usize).saturating_sub(label.len() + 2);
    let decimals = (0..=digits).rev().map(format);
    let exponents = (0..=3).rev().map(|few| exponent(number, few));
    let text = decimals.chain(exponents).find(|text| text.len() <= room);
    text.unwrap_or_else(|| exponent(number, 0))
}

/// `number` as a pane shows it.
pub(super) fn in_pane(number: f64) -> String {
    if number.fract() == 0.0 {
        return shortest(number);
    }
    significant(number, PANE_DIGITS)
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
    let mut fitting = decimals
        .chain(exponents)
        .filter(|shorter| shorter.len() <= room);
    fitting
        .find(|shorter: &String| {
            shorter
                .parse()
                .is_ok_and(|told: f64| (told - number).abs() <= 1e-3 * number.abs())
        })
        .map_or(text.into(), Cow::from)
}
