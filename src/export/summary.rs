//! How a run ended, as text for a reader and as JSON for a program.

use crate::analysis::health::Advice;
use crate::analysis::{Health, Measured, Monitor};
use crate::physics::SymmetricTop;
use crate::run::{Sample, Simulation};
use serde::Serialize;
use std::fmt;
use std::time::Duration;

/// The end of a run.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[allow(non_snake_case, reason = "names carry their unit as it is written")]
#[allow(missing_docs, reason = "the names are those of the columns")]
pub struct Summary {
    pub title: String,
    pub scheme: &'static str,
    /// How the scheme went about it, where it has more than one way (`exact`).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub scheme_kind: Option<String>,
    pub steps: u64,
    pub time_step_s: f64,
    pub t_s: f64,
    pub x_m: f64,
    pub y_m: f64,
    pub z_m: f64,
    pub Lx_Js: f64,
    pub Ly_Js: f64,
    pub Lz_Js: f64,
    pub tilt_deg: f64,
    pub azimuth_deg: f64,
    pub energy_J: f64,
    /// (E − E₀ − W)/S, see [`Simulation::energy_drift`]; `None` (null in JSON) where it means nothing.
    pub energy_drift: Option<f64>,
    /// Number of edits of time step, scheme or gravity.
    pub segment: u64,
    /// Turns of the body in one time step.
    pub turns_per_step: f64,
    /// Largest distance of the traced point from the exact motion so far; `None` where that was not to be had.
    pub most_distance_m: Option<f64>,
    pub distance_m: Option<f64>,
    /// κ = I3/I1; `None` for a lopsided body, as all that theory says. What it says is `None` too while a push acts off
    /// the axle, or where the exact motion would take too long.
    pub kappa: Option<f64>,
    pub predicted_precession_rad_per_s: Option<f64>,
    pub measured_precession_rad_per_s: Option<f64>,
    pub measured_precession_uncertainty_rad_per_s: Option<f64>,
    pub predicted_nutation_period_s: Option<f64>,
    pub measured_nutation_period_s: Option<f64>,
    pub measured_nutation_uncertainty_s: Option<f64>,
    /// Whether the numbers hold, in one sentence.
    pub health: String,
    /// Time spent on stepping alone, s: no start-up, no output.
    pub wall_s: f64,
    pub steps_per_second: f64,
}

impl Summary {
    /// The summary of `simulation` where it stands, after stepping for `wall`.
    /// `monitor` has followed it, `health` is how it stands, and `advice` what would mend it.
    pub fn new(
        simulation: &Simulation,
        monitor: &mut Monitor,
        health: &Health,
        advice: Option<&Advice>,
        wall: Duration,
    ) -> Self {
        let theory = monitor.theory(simulation.state().time_s);
        let precession = monitor.instruments().precession_rad_per_s();
        let nutation = monitor.instruments().nutation_period_s();
        let Sample {
            step,
            time_s,
            position,
            momentum,
            tilt_deg,
            azimuth_deg,
            energy,
            segment,
            ..
        } = simulation.sample();
        let wall_s = wall.as_secs_f64();
        Self {
            title: simulation.scenario().file.title.clone(),
            scheme: simulation.motion().scheme.name,
            scheme_kind: simulation.remark(),
            steps: step,
            time_step_s: simulation.motion().time_step_s,
            t_s: time_s,
            x_m: position.x,
            y_m: position.y,
            z_m: position.z,
            Lx_Js: momentum.x,
            Ly_Js: momentum.y,
            Lz_Js: momentum.z,
            tilt_deg,
            azimuth_deg,
            energy_J: energy,
            energy_drift: simulation.energy_drift(),
            segment,
            turns_per_step: health.turns_per_step,
            most_distance_m: health.most_distance_m,
            distance_m: health.deviation.map(|deviation| deviation.distance_m),
            kappa: SymmetricTop::of(&simulation.scenario().body.mechanics).map(|top| top.kappa()),
            predicted_precession_rad_per_s: theory.and_then(|theory| theory.precession),
            measured_precession_rad_per_s: value(precession),
            measured_precession_uncertainty_rad_per_s: precession
                .map(|measured| measured.uncertainty),
            predicted_nutation_period_s: theory.and_then(|theory| theory.nutation_period_s),
            measured_nutation_period_s: value(nutation),
            measured_nutation_uncertainty_s: nutation.map(|measured| measured.uncertainty),
            health: health.sentence(advice),
            wall_s,
            steps_per_second: if wall_s > 0.0 {
                step as f64 / wall_s
            } else {
                0.0
            },
        }
    }
}

fn value(measured: Option<Measured>) -> Option<f64> {
    measured.map(|measured| measured.value)
}

impl Summary {
    /// Theory beside measurement, a line each.
    fn theory_lines(&self) -> [String; 2] {
        let predicted = |number: Option<f64>, unit: &str| match (self.kappa, number) {
            (None, _) => "lopsided".to_owned(),
            (_, Some(number)) => format!("{number:.6} {unit}"),
            (_, None) => "none".to_owned(),
        };
        let measured =
            |number: Option<f64>, uncertainty: Option<f64>, unit: &str| match (number, uncertainty)
            {
                (Some(number), Some(uncertainty)) => {
                    format!("{number:.6} +- {uncertainty:.1e} {unit}")
                }
                _ => "none".to_owned(),
            };
        [
            format!(
                "{} by theory, {} measured",
                predicted(self.predicted_precession_rad_per_s, "rad/s"),
                measured(
                    self.measured_precession_rad_per_s,
                    self.measured_precession_uncertainty_rad_per_s,
                    "rad/s"
                ),
            ),
            format!(
                "{} by theory, {} measured",
                predicted(self.predicted_nutation_period_s, "s"),
                measured(
                    self.measured_nutation_period_s,
                    self.measured_nutation_uncertainty_s,
                    "s"
                ),
            ),
        ]
    }
}

impl fmt::Display for Summary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let drift = match self.energy_drift {
            Some(drift) => {
                format!("{drift:+.3e} (of M g |c|, or of the kinetic energy where that is 0)")
            }
            None => "n/a".to_owned(),
        };
        writeln!(f, "{}", self.title)?;
        match &self.scheme_kind {
            Some(kind) => writeln!(f, "  scheme        {} ({kind})", self.scheme)?,
            None => writeln!(f, "  scheme        {}", self.scheme)?,
        }
        writeln!(
            f,
            "  steps         {} of {} s",
            self.steps, self.time_step_s
        )?;
        writeln!(f, "  t             {} s", self.t_s)?;
        writeln!(
            f,
            "  x, y, z       {:.9}, {:.9}, {:.9} m",
            self.x_m, self.y_m, self.z_m
        )?;
        writeln!(
            f,
            "  L             {:.6}, {:.6}, {:.6} J s",
            self.Lx_Js, self.Ly_Js, self.Lz_Js
        )?;
        writeln!(f, "  tilt          {:.6} degrees", self.tilt_deg)?;
        writeln!(f, "  azimuth       {:.6} degrees", self.azimuth_deg)?;
        writeln!(f, "  energy drift  {drift}")?;
        let [precession, nutation] = self.theory_lines();
        writeln!(f, "  precession    {precession}")?;
        writeln!(f, "  nutation      {nutation}")?;
        writeln!(
            f,
            "  turns         {:.4} in a time step",
            self.turns_per_step
        )?;
        if self.segment > 0 {
            writeln!(
                f,
                "  edits         {} of time step, scheme or gravity",
                self.segment
            )?;
        }
        writeln!(
            f,
            "  wall time     {:.3} s, {:.3e} steps a second",
            self.wall_s, self.steps_per_second
        )?;
        write!(f, "\n{}", self.health)
    }
}
