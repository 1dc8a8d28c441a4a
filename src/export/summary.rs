//! How a run ended, as text for a reader and as JSON for a program.

use super::Readouts;
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
    #[serde(skip)]
    pub energy_unit: &'static str,
    /// Number of edits of time step, scheme or gravity.
    pub segment: u64,
    /// Theory, measurement and health.
    #[serde(flatten)]
    pub readouts: Readouts,
    /// Time spent on stepping alone, s: no start-up, no output.
    pub wall_s: f64,
    pub steps_per_second: f64,
}

impl Summary {
    /// The summary of `simulation` where it stands, after stepping for `wall`.
    pub fn new(simulation: &Simulation, readouts: Readouts, wall: Duration) -> Self {
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
            energy_unit: match simulation.scenario().motion.gravity == 0.0 {
                true => "of the kinetic energy at the start",
                false => "of M g |c|",
            },
            segment,
            readouts,
            wall_s,
            steps_per_second: if wall_s > 0.0 {
                step as f64 / wall_s
            } else {
                0.0
            },
        }
    }
}

impl fmt::Display for Summary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let drift = match self.energy_drift {
            Some(drift) => {
                format!("{drift:+.3e} {}", self.energy_unit)
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
        write!(f, "{}", self.readouts)?;
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
        write!(f, "\n{}", self.readouts.health)
    }
}
