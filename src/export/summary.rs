//! The summary of a finished run, as text for a reader and as JSON for a program.

use crate::analysis::theory::{Axis, Path, Theory};
use crate::analysis::{Measured, Readouts, remarks};
use crate::scenario::Scenario;
use crate::text::number::{NONE, exponent, fixed, shortest, significant};
use serde::Serialize;
use std::fmt;
use std::time::Duration;

/// The summary of a finished run. As JSON it is the table of [readouts](crate::analysis::readouts).
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(transparent)]
pub struct Summary {
    readouts: Readouts,
    /// How many steps of which time step it had, in words, where it had several.
    #[serde(skip)]
    steps: Option<String>,
}

/// A measured value and the theoretical one.
struct Comparison {
    unit: &'static str,
    measured: Option<Measured>,
    predicted: Option<f64>,
    /// Whether the steps are too far apart to see it.
    is_strobed: bool,
}

impl Summary {
    /// The summary of a run that has `readouts` at its end and spent the time `wall` on stepping.
    pub fn new(readouts: Readouts, wall: Duration) -> Self {
        Self {
            readouts: Readouts {
                stepping: Some(wall),
                ..readouts
            },
            steps: None,
        }
    }

    /// The same summary with all time steps that the run of `scenario` has had, not the last one only.
    pub fn with_time_steps_of(self, scenario: &Scenario) -> Self {
        let steps = steps_in_words(scenario, self.readouts.sample.step);
        Self {
            steps: Some(steps),
            ..self
        }
    }

    fn write_state(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Readouts {
            sample,
            extremes,
            health,
            ..
        } = &self.readouts;
        let (at, momentum) = (&sample.position, &sample.momentum);
        let steps = || {
            let step = shortest(self.readouts.time_step_s);
            format!("{} of {step} s", sample.step)
        };
        let steps = self.steps.clone().unwrap_or_else(steps);
        writeln!(f, "  steps         {steps}")?;
        writeln!(f, "  t             {} s", shortest(sample.time_s))?;
        let [x, y, z] = [at.x, at.y, at.z].map(|metres| fixed(metres, 9));
        writeln!(f, "  x, y, z       {x}, {y}, {z} m")?;
        let [x, y, z] = [momentum.x, momentum.y, momentum.z].map(|part| fixed(part, 6));
        writeln!(f, "  L             {x}, {y}, {z} J s")?;
        let [now, low, high] = [
            sample.tilt_deg,
            extremes.tilt.lowest_deg,
            extremes.tilt.highest_deg,
        ]
        .map(|tilt| fixed(tilt, 6));
        writeln!(
            f,
            "  tilt          {now} degrees; {low} to {high} in the run"
        )?;
        let [low, high] = [extremes.lowest_z_m, extremes.highest_z_m].map(|z| fixed(z, 9));
        writeln!(f, "  z             {low} to {high} m in the run")?;
        let azimuth = fixed(sample.azimuth_deg, 6);
        writeln!(f, "  azimuth       {azimuth} degrees")?;
        let drift = remarks::energy_in_full(health);
        writeln!(f, "  energy drift  {drift}")?;
        match &self.readouts.health.slowing {
            Some(slowing) => writeln!(f, "  friction      {slowing}"),
            None => Ok(()),
        }
    }

    fn write_rates(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let readouts = &self.readouts;
        // Under friction no motion goes on as theory has it.
        let theory = readouts.theory.filter(|theory| !theory.is_of_a_moment);
        let precession = Comparison {
            unit: "rad/s",
            measured: readouts.precession,
            predicted: theory.and_then(|theory| theory.precession),
            is_strobed: false,
        };
        let nutation = Comparison {
            unit: "s",
            measured: readouts.nutation,
            predicted: theory.and_then(|theory| theory.nutation_period_s),
            is_strobed: readouts.nutation_is_resolved() == Some(false),
        };
        let path = readouts.theory.as_ref().map(|theory| theory.path);
        let why = match (precession.predicted, path) {
            (None, Some(Path::ThroughVertical)) => ": the axle passes through the vertical",
            _ => "",
        };
        let precession = precession.in_words(readouts);
        writeln!(f, "  precession    {precession}{why}")?;
        writeln!(f, "  nutation      {}", nutation.in_words(readouts))
    }

    fn write_theory(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (kappa, theory) = match (self.readouts.kappa, &self.readouts.theory) {
            (None, _) => return writeln!(f, "  theory        none: the body is lopsided"),
            (Some(kappa), None) => {
                let (kappa, why) = (fixed(kappa, 4), "pushed off its axle, or too long a run");
                return writeln!(f, "  theory        kappa {kappa}; none now: {why}");
            }
            (Some(kappa), Some(theory)) => (fixed(kappa, 4), theory),
        };
        let Theory { path, axis, .. } = theory;
        let ceased = if theory.is_of_a_moment {
            "if friction ceased now: "
        } else {
            ""
        };
        let (low, high) = theory.tilt_range_deg;
        let [low, high] = [low, high].map(|tilt| fixed(tilt, 4));
        let from = match axis {
            Axis::Z => String::new(),
            axis => format!(" from {axis}"),
        };
        // The extremes above are those of the whole run.
        let since = match self.readouts.since {
            0 | 1 => "",
            _ => ", since the forces last changed",
        };
        writeln!(
            f,
            "  theory        {ceased}kappa {kappa}; path: {path}, tilt {low} to {high} degrees{from}{since}"
        )?;
        if *axis == Axis::Momentum {
            let why = "without a load the axle goes round L, and no spin is too small to stand";
            return writeln!(f, "  steady        {why}");
        }
        let about = about(axis);
        let rate = |rate: Option<f64>| rate.map_or("none".to_owned(), |rate| fixed(rate, 6));
        let steady = match (theory.slow_precession, theory.fast_precession) {
            (None, None) => {
                "none at this tilt: the top is too slow for a steady precession".to_owned()
            }
            (slow, fast) => {
                let [slow, fast] = [slow, fast].map(rate);
                format!("precession of {slow} (slow) or {fast} (fast) rad/s at this tilt")
            }
        };
        writeln!(f, "  steady        {steady}{about}")?;
        self.write_upright(f, theory, &about)
    }

    /// Whether the axle would sleep upright.
    fn write_upright(
        &self,
        f: &mut fmt::Formatter<'_>,
        theory: &Theory,
        about: &str,
    ) -> fmt::Result {
        let spin = self.readouts.spin;
        let Some(limit) = theory.sleeping_limit else {
            let why = "without spin too: the forces pull the axle up";
            return writeln!(f, "  upright       stands{about} {why}");
        };
        let sleeps = if spin.abs() > limit {
            "it would"
        } else {
            "it would not"
        };
        let along = match &theory.axis {
            Axis::Z => "sleeps".to_owned(),
            axis => format!("along {axis} it sleeps"),
        };
        let [limit, spin] = [limit, spin].map(|momentum| fixed(momentum, 3));
        writeln!(
            f,
            "  upright       {along} with L.axle above {limit} J s; with {spin} {sleeps}"
        )
    }

    fn write_health(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let health = &self.readouts.health;
        writeln!(f, "  a time step   {}", remarks::step_in_full(health))?;
        writeln!(f, "  lag           {}", remarks::lag_in_full(health))?;
        match remarks::constants_in_full(health) {
            Some(constants) => writeln!(f, "  L             {constants}"),
            None => Ok(()),
        }
    }
}

/// The first `steps` steps of `scenario` with their time steps: "2300 of 0.1 s", or "2300: 40 of 0.1 s, then 2260 of
/// 0.05 s" where edits have changed the time step.
pub fn steps_in_words(scenario: &Scenario, steps: u64) -> String {
    let mut parts: Vec<(u64, f64)> = Vec::new();
    let (mut begin, mut time_step_s) = (0, scenario.motion.time_step_s);
    let edits = scenario.edits.iter().filter(|edit| edit.touches.time_step);
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
    let one = |(count, step_s): &(u64, f64)| format!("{count} of {} s", shortest(*step_s));
    match &parts[..] {
        [] => format!("{steps} of {} s", shortest(time_step_s)),
        [only] => one(only),
        [first, rest @ ..] if rest.len() < 4 => {
            let rest: Vec<_> = rest.iter().map(one).collect();
            format!("{steps}: {}, then {}", one(first), rest.join(", then "))
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

impl Comparison {
    /// "0.886033 rad/s by theory, 0.886033 +- 2.4e-9 rad/s measured", with the axis where theory refers to another than +z.
    fn in_words(&self, readouts: &Readouts) -> String {
        let unit = self.unit;
        let axis = readouts
            .theory
            .as_ref()
            .map_or(Axis::Z, |theory| theory.axis);
        let about = about(&axis);
        let about_z = match axis {
            Axis::Z => "",
            _ => " about +z",
        };
        let theory = match self.predicted {
            Some(value) => format!("{} {unit} by theory{about}", fixed(value, 6)),
            None if readouts.health.slowing.is_some() => {
                "none by theory, as friction changes it".to_owned()
            }
            None if readouts.kappa.is_none() => {
                "none by theory, which is of symmetric bodies".to_owned()
            }
            None => format!("none by theory{about}"),
        };
        let measured = match self.measured {
            Some(Measured {
                value, uncertainty, ..
            }) if value.is_finite() && uncertainty.is_finite() => {
                if self.is_strobed {
                    let shown = significant(value, 3);
                    return format!(
                        "{theory}, strobed: the steps are too far apart to see it, and show {shown} {unit}{about_z}"
                    );
                }
                let (value, uncertainty) = (fixed(value, 6), exponent(uncertainty, 1));
                format!("{value} +- {uncertainty} {unit} measured{about_z}")
            }
            _ if self.is_strobed => {
                format!("none measured{about_z}: strobed, the steps are too far apart to see it")
            }
            _ => format!("none measured{about_z}"),
        };
        format!("{theory}, {measured}")
    }
}

/// " about AXIS" where the axis is another than +z, else empty.
fn about(axis: &Axis) -> String {
    match axis {
        Axis::Z => String::new(),
        axis => format!(" about {axis}"),
    }
}

impl fmt::Display for Summary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let readouts = &self.readouts;
        writeln!(f, "{}", readouts.title)?;
        match &readouts.scheme_kind {
            Some(kind) => writeln!(f, "  scheme        {} ({kind})", readouts.scheme)?,
            None => writeln!(f, "  scheme        {}", readouts.scheme)?,
        }
        self.write_state(f)?;
        self.write_rates(f)?;
        self.write_theory(f)?;
        self.write_health(f)?;
        if readouts.sample.segment > 0 {
            writeln!(
                f,
                "  edits         {} of time step, scheme or gravity",
                readouts.sample.segment
            )?;
        }
        let number =
            |name, write: fn(f64) -> String| readouts.number(name).map_or(NONE.to_owned(), write);
        writeln!(
            f,
            "  wall time     {} s, {} steps a second",
            number("wall_s", |wall| fixed(wall, 3)),
            number("steps_per_second", |rate| exponent(rate, 3))
        )?;
        write!(
            f,
            "\n{}",
            readouts.health.sentence(readouts.advice.as_ref())
        )
    }
}
