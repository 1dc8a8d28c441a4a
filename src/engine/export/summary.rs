//! The summary of a finished run, as text for a reader and as JSON for a program.

use crate::analysis::theory::{AxlePath, Theory, TheoryAxis};
use crate::analysis::{MeasuredNumber, Readouts, WithoutNutation, remarks};
use crate::scenario::Scenario;
use crate::text::number::{NOT_AVAILABLE, counted, exponent, fixed, shortest, significant};
use nalgebra::Vector3;
use serde::Serialize;
use std::fmt;
use std::time::Duration;

/// The summary of a finished run. As JSON it is the table of [readouts](crate::analysis::readouts).
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(transparent)]
pub struct RunSummary {
    readouts: Readouts,
    /// How many steps of which time step it had, in words, where it had several.
    #[serde(skip)]
    steps: Option<String>,
    /// Whether its text says theory, lag and what else is known too.
    #[serde(skip)]
    is_full: bool,
}

/// Why a run shows no nutation although it has one.
const FAR_APART: &str = "the steps are too far apart to see it";

/// A line of the summary: what it is about, and what it says.
type SummaryLine = (&'static str, String);

impl RunSummary {
    /// The summary of a run that has `readouts` at its end and spent the time `wall` on stepping.
    pub fn new(readouts: Readouts, wall: Duration) -> Self {
        Self {
            readouts: Readouts {
                stepping: Some(wall),
                ..readouts
            },
            steps: None,
            is_full: false,
        }
    }

    /// The same summary, whose text leaves nothing out if `is_full`.
    pub fn in_full(self, is_full: bool) -> Self {
        Self { is_full, ..self }
    }

    /// The same summary with all time steps that the run of `scenario` has had, not the last one only.
    pub fn with_time_steps_of(self, scenario: &Scenario) -> Self {
        let steps = steps_in_words(scenario, self.readouts.sample.step);
        Self {
            steps: Some(steps),
            ..self
        }
    }

    fn extent(&self) -> Vec<SummaryLine> {
        let Readouts {
            sample, extremes, ..
        } = &self.readouts;
        let tilts = [
            sample.tilt_deg,
            extremes.tilt.lowest_deg,
            extremes.tilt.highest_deg,
        ];
        let [now, low, high] = tilts.map(|tilt| fixed(tilt, 6));
        let [lowest, highest] = [extremes.lowest_z_m, extremes.highest_z_m].map(|z| fixed(z, 9));
        vec![
            ("tilt", format!("{now} degrees; {low} to {high} in the run")),
            ("z", format!("{lowest} to {highest} m in the run")),
        ]
    }

    fn state(&self) -> Vec<SummaryLine> {
        let readouts = &self.readouts;
        let sample = &readouts.sample;
        let scheme = match &readouts.scheme_kind {
            Some(kind) => format!("{} ({kind})", readouts.scheme),
            None => readouts.scheme.to_owned(),
        };
        let steps = self
            .steps
            .clone()
            .unwrap_or_else(|| format!("{} of {} s", sample.step, shortest(readouts.time_step_s)));
        let wall = readouts.number("wall_s").map(|wall| fixed(wall, 3));
        let rate = readouts
            .number("steps_per_second")
            .map(|rate| exponent(rate, 3));
        let [wall, rate] = [wall, rate].map(|text| text.unwrap_or(NOT_AVAILABLE.to_owned()));
        vec![
            ("scheme", scheme),
            ("steps", steps),
            ("t", format!("{} s", shortest(sample.time_s))),
            ("x, y, z", vector(&sample.position, 9) + " m"),
            ("L", vector(&sample.momentum, 6) + " J s"),
            ("energy drift", remarks::energy_in_full(&readouts.health)),
            ("wall time", format!("{wall} s, {rate} steps a second")),
        ]
    }

    fn rates(&self) -> Vec<SummaryLine> {
        let readouts = &self.readouts;
        // Under friction no motion goes on as theory has it.
        let theory = readouts.theory.filter(|theory| !theory.is_of_a_moment);
        let predicted = theory.and_then(|theory| theory.precession);
        let path = readouts.theory.as_ref().map(|any| any.path);
        let why = match (predicted, path) {
            (None, Some(AxlePath::ThroughVertical)) => ": the axle passes through the vertical",
            _ => "",
        };
        let unmeasured = match why {
            "" => "too little of it was seen to state it",
            _ => "",
        };
        let precession =
            self.compared("rad/s", predicted, readouts.precession, false, unmeasured) + why;
        let period = theory.and_then(|theory| theory.nutation_period_s);
        let is_strobed = readouts.nutation_is_resolved() == Some(false);
        let nutation_unmeasured = readouts.without_nutation.map_or("", WithoutNutation::words);
        let nutation = self.compared(
            "s",
            period,
            readouts.nutation,
            is_strobed,
            nutation_unmeasured,
        );
        let mut lines = vec![("precession", precession), ("nutation", nutation)];
        let asymmetry = readouts.theory.and_then(|any| any.of_mean_moment());
        lines.extend(asymmetry.map(|asymmetry| ("asymmetry", asymmetry)));
        lines.extend(self.foot_force().map(|force| ("foot force", force)));
        lines
    }

    /// The mean force of the floor on the foot beside the weight; `None` under friction, and where nothing presses.
    fn foot_force(&self) -> Option<String> {
        let readouts = &self.readouts;
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

    /// A value by theory and as it was measured: "0.886033 rad/s by theory, 0.886033 +- 2.4e-9 rad/s in this run", with the axis
    /// where theory refers to another than +z. `is_strobed` says whether the steps are too far apart to see it, `unmeasured` why there is no number of the
    /// run although the motion may have one, or nothing where it has none.
    fn compared(
        &self,
        unit: &str,
        predicted: Option<f64>,
        measured: Option<MeasuredNumber>,
        is_strobed: bool,
        unmeasured: &str,
    ) -> String {
        let readouts = &self.readouts;
        let axis = readouts.theory.as_ref().map(|theory| theory.axis);
        let about = on(" about", &axis.unwrap_or(TheoryAxis::Z));
        let about_z = if about.is_empty() { "" } else { " about +z" };
        let theory = match predicted {
            Some(value) => format!("{} {unit} by theory{about}", fixed(value, 6)),
            None if readouts.health.slowing.is_some() => {
                "none by theory, as friction changes it".to_owned()
            }
            None if readouts.kappa.is_none() => {
                "none by theory, which is of symmetric bodies".to_owned()
            }
            None => format!("none by theory{about}"),
        };
        let finite = measured.filter(|it| it.value.is_finite() && it.uncertainty.is_finite());
        let in_run = match finite {
            Some(MeasuredNumber { value, .. }) if is_strobed => {
                let shown = significant(value, 3);
                format!("strobed: {FAR_APART}, and show {shown} {unit}{about_z}")
            }
            Some(MeasuredNumber {
                value, uncertainty, ..
            }) => {
                let (value, uncertainty) = (fixed(value, 6), exponent(uncertainty, 1));
                format!("{value} +- {uncertainty} {unit} in this run{about_z}")
            }
            None if is_strobed => format!("none in this run{about_z}: strobed, {FAR_APART}"),
            None if readouts.health.slowing.is_some() => "not stated in this run".to_owned(),
            None if unmeasured.is_empty() => format!("none in this run{about_z}"),
            None => format!("not stated in this run{about_z}: {unmeasured}"),
        };
        format!("{theory}, {in_run}")
    }

    fn theory(&self) -> Vec<SummaryLine> {
        let Some(kappa) = self.readouts.kappa else {
            return vec![("theory", "none: the body is lopsided".to_owned())];
        };
        let kappa = fixed(kappa, 4);
        let Some(theory) = &self.readouts.theory else {
            let why = "pushed off its axle, or too long a run";
            return vec![("theory", format!("kappa {kappa}; none now: {why}"))];
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
        let since = match self.readouts.since {
            0 | 1 => "",
            _ => ", since the forces last changed",
        };
        let motion = format!(
            "{ceased}kappa {kappa}; path: {path}, tilt {low} to {high} degrees{from}{since}"
        );
        if *axis == TheoryAxis::Momentum {
            let why = "without a load the axle goes round L, and no spin is too small to stand";
            return vec![("theory", motion), ("steady", why.to_owned())];
        }
        vec![
            ("theory", motion),
            ("steady", steady(theory)),
            ("upright", self.upright(theory)),
        ]
    }

    /// Whether the axle would sleep upright.
    fn upright(&self, theory: &Theory) -> String {
        let spin = self.readouts.axle_momentum;
        let Some(limit) = theory.sleeping_limit else {
            let about = on(" about", &theory.axis);
            return format!("stands{about} without spin too: the forces pull the axle up");
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
        format!("{along} with L.axle above {limit} J s; with {spin} {sleeps}")
    }

    fn health(&self) -> Vec<SummaryLine> {
        let readouts = &self.readouts;
        let health = &readouts.health;
        let azimuth = readouts.number("azimuth_deg");
        let azimuth_text = azimuth.map_or(NOT_AVAILABLE.to_owned(), |number| fixed(number, 6));
        let mut lines = vec![("azimuth", azimuth_text + " degrees")];
        lines.push(("a time step", remarks::step_in_full(health)));
        lines.push(("lag", remarks::lag_in_full(health)));
        lines.extend(remarks::constants_in_full(health).map(|constants| ("L", constants)));
        let slowing = health.slowing.as_ref();
        lines.extend(slowing.map(|slowing| ("friction", slowing.to_string())));
        let edits = readouts.sample.segment;
        if edits > 0 {
            lines.push(("edits", format!("{edits} of time step, scheme or gravity")));
        }
        lines
    }
}

/// The first `steps` steps of `scenario` with their time steps: "2300 of 0.1 s", or "2300: 40 of 0.1 s, then 2260 of
/// 0.05 s" where edits have changed the time step.
pub fn steps_in_words(scenario: &Scenario, steps: u64) -> String {
    let mut parts: Vec<(u64, f64)> = Vec::new();
    let (mut begin, mut time_step_s) = (0, scenario.motion.time_step_s);
    let edits = scenario.edits.iter().filter(|edit| edit.sets_time_step);
    for edit in edits.take_while(|edit| edit.step < steps) {
        parts.push((edit.step - begin, time_step_s));
        (begin, time_step_s) = (edit.step, edit.motion.time_step_s);
    }
    parts.push((steps - begin.min(steps), time_step_s));
    parts.retain(|(count, _)| *count > 0);
    parts.dedup_by(|next, before| {
        let is_same = next.1 == before.1;
        before.0 += if is_same { next.0 } else { 0 };
        is_same
    });
    match &parts[..] {
        [] => format!("{steps} of {} s", shortest(time_step_s)),
        [(count, step_s)] => format!("{count} of {} s", shortest(*step_s)),
        few if few.len() <= 4 => {
            let few: Vec<_> = few
                .iter()
                .map(|(count, step_s)| format!("{count} of {} s", shortest(*step_s)))
                .collect();
            format!("{steps}: {}", few.join(", then "))
        }
        many => {
            let least = many.iter().map(|part| part.1).fold(f64::INFINITY, f64::min);
            let most = many.iter().map(|part| part.1).fold(0.0, f64::max);
            let (least, most) = (shortest(least), shortest(most));
            format!(
                "{steps} of {least} to {most} s, changed {} times",
                many.len() - 1
            )
        }
    }
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

/// `word` and the axis where that is another than +z, else nothing.
fn on(word: &str, axis: &TheoryAxis) -> String {
    match axis {
        TheoryAxis::Z => String::new(),
        axis => format!("{word} {axis}"),
    }
}

impl fmt::Display for RunSummary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let readouts = &self.readouts;
        let first = text([self.extent(), self.rates()].concat());
        let verdict = readouts.health.sentence(readouts.advice.as_ref());
        let mut rest = self.state();
        if self.is_full {
            rest.extend([self.theory(), self.health()].concat());
        }
        write!(
            f,
            "{}\n{first}\n{verdict}\n\n{}",
            readouts.title,
            text(rest).trim_end()
        )
    }
}

fn text(lines: Vec<SummaryLine>) -> String {
    lines
        .into_iter()
        .map(|(name, said)| format!("  {name:<14}{said}\n"))
        .collect()
}
