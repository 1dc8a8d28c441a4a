//! The lines of a run's summary: the readout of each line, and its text.

use super::table::READOUTS;
use super::{Readout, Readouts};
use crate::analysis::theory::{AxlePath, Theory, TheoryAxis};
use crate::analysis::{MeasuredNumber, WithoutNutation, remarks};
use crate::text::number::{NOT_AVAILABLE, counted, exponent, fixed, shortest, significant};
use nalgebra::Vector3;

/// Reason why a run shows no nutation although it has one.
const FAR_APART: &str = "the steps are too far apart to see it";

/// Line of a readout in the summary. The line may contain further readouts.
#[derive(Clone, Copy, Debug)]
pub struct SummaryRow {
    pub part: SummaryPart,
    /// Position among the lines of its part.
    pub place: u8,
    pub label: &'static str,
    text: fn(&Readouts) -> Option<String>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SummaryPart {
    /// Above the verdict.
    Motion,
    /// Below the verdict.
    State,
    /// In the full summary only.
    Further,
}

pub(super) const fn summary(
    part: SummaryPart,
    place: u8,
    label: &'static str,
    text: fn(&Readouts) -> Option<String>,
) -> SummaryRow {
    SummaryRow {
        part,
        place,
        label,
        text,
    }
}

impl SummaryRow {
    /// Returns the text of the line for `readouts`. `None` if this run has no such line.
    pub fn read(&self, readouts: &Readouts) -> Option<String> {
        (self.text)(readouts)
    }
}

/// Returns the lines of `part` with their readouts, in order.
pub fn summary_rows(part: SummaryPart) -> Vec<(&'static Readout, SummaryRow)> {
    let rows = READOUTS
        .iter()
        .filter_map(|readout| Some((readout, readout.summary?)));
    let mut of_part: Vec<_> = rows.filter(|(_, row)| row.part == part).collect();
    of_part.sort_by_key(|(_, row)| row.place);
    of_part
}

pub(super) fn tilt(readouts: &Readouts) -> Option<String> {
    let range = &readouts.extremes.tilt;
    let tilts = [
        readouts.sample.tilt_deg,
        range.lowest_deg,
        range.highest_deg,
    ];
    let [now, low, high] = tilts.map(|tilt| fixed(tilt, 6));
    Some(format!("{now} degrees; {low} to {high} in the run"))
}

pub(super) fn height(readouts: &Readouts) -> Option<String> {
    let extremes = &readouts.extremes;
    let [lowest, highest] = [extremes.lowest_z_m, extremes.highest_z_m].map(|z| fixed(z, 9));
    Some(format!("{lowest} to {highest} m in the run"))
}

pub(super) fn precession(readouts: &Readouts) -> Option<String> {
    let predicted = lasting_theory(readouts).and_then(|theory| theory.precession);
    let path = readouts.theory.as_ref().map(|any| any.path);
    let (unmeasured, why) = match (predicted, path) {
        (None, Some(AxlePath::ThroughVertical)) => ("", ": the axle passes through the vertical"),
        _ => ("not enough of it was seen", ""),
    };
    let measured = readouts.precession;
    let text = compared(readouts, "rad/s", predicted, measured, false, unmeasured);
    Some(text + why)
}

pub(super) fn nutation(readouts: &Readouts) -> Option<String> {
    let period = lasting_theory(readouts).and_then(|theory| theory.nutation_period_s);
    let is_under_sampled = readouts.nutation_is_resolved() == Some(false);
    let unmeasured = readouts.without_nutation.map_or("", WithoutNutation::words);
    let measured = readouts.nutation;
    Some(compared(
        readouts,
        "s",
        period,
        measured,
        is_under_sampled,
        unmeasured,
    ))
}

/// Returns the theory, unless friction keeps the motion from following it.
fn lasting_theory(readouts: &Readouts) -> Option<&Theory> {
    let theory = readouts.theory.as_ref();
    theory.filter(|theory| !theory.is_of_a_moment)
}

pub(super) fn asymmetry(readouts: &Readouts) -> Option<String> {
    readouts.theory.and_then(|any| any.of_mean_moment())
}

/// Describes the mean force of the floor on the foot next to the weight. `None` with friction, and if nothing presses
/// on the foot.
pub(super) fn foot_force(readouts: &Readouts) -> Option<String> {
    let predicted = readouts.predicted_mean_foot_force?;
    let weight = readouts.weight;
    if weight == 0.0 && predicted == 0.0 {
        return None;
    }
    let pressed = if predicted == weight {
        String::new()
    } else {
        format!(" and {} N by pushes", fixed(predicted - weight, 3))
    };
    let measured = match readouts.mean_foot_force {
        Some(MeasuredNumber {
            value,
            uncertainty,
            nutations,
        }) => {
            let (value, uncertainty) = (fixed(value, 3), significant(uncertainty, 2));
            let nutations = counted(nutations, "whole nutation");
            format!("{value} +- {uncertainty} N on average over {nutations}")
        }
        None if readouts.nutation_is_resolved() == Some(false) => {
            format!("{NOT_AVAILABLE}: {FAR_APART}")
        }
        None => format!("{NOT_AVAILABLE}: no whole nutation was seen"),
    };
    Some(format!("M g {} N{pressed}, {measured}", fixed(weight, 3)))
}

/// Describes a value by theory and by measurement: "0.886033 rad/s by theory, 0.886033 +- 2.4e-9 rad/s in this run".
/// The axis is named if theory refers to another axis than +z.
///
/// `is_under_sampled` is true if the steps are too far apart to show the value. `unmeasured` is the reason why the run has no
/// number although the motion may have one. It is empty if the motion has none.
fn compared(
    readouts: &Readouts,
    unit: &str,
    predicted: Option<f64>,
    measured: Option<MeasuredNumber>,
    is_under_sampled: bool,
    unmeasured: &str,
) -> String {
    let axis = readouts.theory.as_ref().map(|theory| theory.axis);
    let about = on(" about", &axis.unwrap_or(TheoryAxis::Z));
    let about_z = if about.is_empty() { "" } else { " about +z" };
    let theory = match predicted {
        Some(value) => format!("{} {unit} by theory{about}", fixed(value, 6)),
        None if readouts.health.slowing.is_some() => {
            "none by theory, because friction changes it".to_owned()
        }
        None if readouts.kappa.is_none() => {
            "none by theory, which covers symmetric bodies only".to_owned()
        }
        None => format!("none by theory{about}"),
    };
    let finite = measured.filter(|it| it.value.is_finite() && it.uncertainty.is_finite());
    let in_run = match finite {
        Some(MeasuredNumber { value, .. }) if is_under_sampled => {
            let shown = significant(value, 3);
            format!("under-sampled: {FAR_APART}, and show {shown} {unit}{about_z}")
        }
        Some(MeasuredNumber {
            value, uncertainty, ..
        }) => {
            let (value, uncertainty) = (fixed(value, 6), exponent(uncertainty, 1));
            format!("{value} +- {uncertainty} {unit} in this run{about_z}")
        }
        None if is_under_sampled => {
            format!("none in this run{about_z}: under-sampled, {FAR_APART}")
        }
        None if readouts.health.slowing.is_some() => "not measured in this run".to_owned(),
        None if unmeasured.is_empty() => format!("none in this run{about_z}"),
        None => format!("not measured in this run{about_z}: {unmeasured}"),
    };
    format!("{theory}, {in_run}")
}

pub(super) fn scheme(readouts: &Readouts) -> Option<String> {
    Some(match &readouts.scheme_kind {
        Some(kind) => format!("{} ({kind})", readouts.scheme),
        None => readouts.scheme.to_owned(),
    })
}

pub(super) fn steps(readouts: &Readouts) -> Option<String> {
    let step_s = shortest(readouts.time_step_s);
    Some(format!("{} of {step_s} s", readouts.sample.step))
}

pub(super) fn time(readouts: &Readouts) -> Option<String> {
    Some(format!("{} s", shortest(readouts.sample.time_s)))
}

pub(super) fn position(readouts: &Readouts) -> Option<String> {
    Some(vector(&readouts.sample.position, 9) + " m")
}

pub(super) fn momentum(readouts: &Readouts) -> Option<String> {
    Some(vector(&readouts.sample.momentum, 6) + " J s")
}

pub(super) fn energy(readouts: &Readouts) -> Option<String> {
    Some(remarks::energy_in_full(&readouts.health))
}

pub(super) fn wall_time(readouts: &Readouts) -> Option<String> {
    let wall = readouts.number("wall_s").map(|wall| fixed(wall, 3));
    let rate = readouts
        .number("steps_per_second")
        .map(|rate| exponent(rate, 3));
    let [wall, rate] = [wall, rate].map(|text| text.unwrap_or(NOT_AVAILABLE.to_owned()));
    Some(format!("{wall} s, {rate} steps a second"))
}

pub(super) fn theory(readouts: &Readouts) -> Option<String> {
    let Some(kappa) = readouts.kappa else {
        return Some("none: the body is lopsided".to_owned());
    };
    let kappa = fixed(kappa, 4);
    let Some(theory) = &readouts.theory else {
        let why = "pushed off its axle, or too long a run";
        return Some(format!("kappa {kappa}; none now: {why}"));
    };
    let Theory { path, axis, .. } = theory;
    let ceased = if theory.is_of_a_moment {
        "if friction ceased now: "
    } else {
        ""
    };
    let (low, high) = theory.tilt_range_deg;
    let [low, high] = [low, high].map(|tilt| fixed(tilt, 4));
    let from = on(" from", axis);
    // The extremes above are those of the whole run.
    let since = match readouts.since {
        0 | 1 => "",
        _ => ", since the forces last changed",
    };
    Some(format!(
        "{ceased}kappa {kappa}; path: {path}, tilt {low} to {high} degrees{from}{since}"
    ))
}

pub(super) fn steady_precession(readouts: &Readouts) -> Option<String> {
    readouts.kappa?;
    let theory = readouts.theory.as_ref()?;
    Some(match theory.axis {
        TheoryAxis::Momentum => "without a load, the axle goes round L at any spin".to_owned(),
        _ => steady(theory),
    })
}

/// Describes whether the axle would sleep upright.
pub(super) fn upright(readouts: &Readouts) -> Option<String> {
    readouts.kappa?;
    let theory = readouts.theory.as_ref()?;
    if theory.axis == TheoryAxis::Momentum {
        return None;
    }
    let spin = readouts.axle_momentum;
    let Some(limit) = theory.sleeping_limit else {
        let about = on(" about", &theory.axis);
        return Some(format!(
            "stable{about} even without spin: the forces pull the axle up"
        ));
    };
    let sleeps = if spin.abs() > limit {
        "it would"
    } else {
        "it would not"
    };
    let along = match &theory.axis {
        TheoryAxis::Z => "sleeps".to_owned(),
        axis => format!("along {axis} it sleeps"),
    };
    let [limit, spin] = [limit, spin].map(|momentum| fixed(momentum, 3));
    Some(format!(
        "{along} if L.axle exceeds {limit} J s; at {spin} {sleeps}"
    ))
}

pub(super) fn azimuth(readouts: &Readouts) -> Option<String> {
    Some(fixed(readouts.sample.azimuth_deg, 6) + " degrees")
}

pub(super) fn time_step(readouts: &Readouts) -> Option<String> {
    Some(remarks::step_in_full(&readouts.health))
}

pub(super) fn lag(readouts: &Readouts) -> Option<String> {
    Some(remarks::lag_in_full(&readouts.health))
}

pub(super) fn constants(readouts: &Readouts) -> Option<String> {
    remarks::constants_in_full(&readouts.health)
}

pub(super) fn friction(readouts: &Readouts) -> Option<String> {
    let slowing = readouts.health.slowing.as_ref();
    slowing.map(ToString::to_string)
}

pub(super) fn edits(readouts: &Readouts) -> Option<String> {
    let edits = readouts.sample.segment;
    (edits > 0).then(|| format!("{edits} of time step, scheme or gravity"))
}

fn steady(theory: &Theory) -> String {
    let about = on(" about", &theory.axis);
    let (slow, fast) = (theory.slow_precession, theory.fast_precession);
    if slow.or(fast).is_none() {
        return format!("none at this tilt: the top is too slow for a steady precession{about}");
    }
    let [slow, fast] =
        [slow, fast].map(|rate| rate.map_or("none".to_owned(), |rate| fixed(rate, 6)));
    format!("precession of {slow} (slow) or {fast} (fast) rad/s at this tilt{about}")
}

fn vector(at: &Vector3<f64>, digits: usize) -> String {
    let [x, y, z] = [at.x, at.y, at.z].map(|part| fixed(part, digits));
    format!("{x}, {y}, {z}")
}

/// Returns `word` and the axis, or nothing if the axis is +z.
fn on(word: &str, axis: &TheoryAxis) -> String {
    match axis {
        TheoryAxis::Z => String::new(),
        axis => format!("{word} {axis}"),
    }
}
