//! What a run's numbers are worth, under the names by which it leaves the program: theory, measurement, health.

use crate::analysis::health::Advice;
use crate::analysis::{Health, Measured, Monitor};
use crate::physics::SymmetricTop;
use crate::run::Simulation;
use serde::Serialize;
use std::fmt;

/// Theory beside measurement, and the health of a run at one step. What does not hold, or was not to be had, is
/// `None` (null in JSON): all of theory for a lopsided body.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[allow(non_snake_case, reason = "names carry their unit as it is written")]
#[allow(
    missing_docs,
    reason = "the names say it; see Theory, Instruments and Health"
)]
pub struct Readouts {
    pub turns_per_step: f64,
    pub nutation_multiplier: Option<f64>,
    pub lag_deg: f64,
    pub steady_lag_deg: Option<f64>,
    pub true_steady_lag_deg: Option<f64>,
    pub distance_m: Option<f64>,
    pub most_distance_m: Option<f64>,
    pub L_axle_drift_Js: Option<f64>,
    pub Lz_drift_Js: Option<f64>,
    pub kappa: Option<f64>,
    pub path: Option<String>,
    pub lowest_tilt_deg: Option<f64>,
    pub highest_tilt_deg: Option<f64>,
    pub cusp_tilt_deg: Option<f64>,
    pub predicted_precession_rad_per_s: Option<f64>,
    pub measured_precession_rad_per_s: Option<f64>,
    pub measured_precession_uncertainty_rad_per_s: Option<f64>,
    pub slow_precession_rad_per_s: Option<f64>,
    pub fast_precession_rad_per_s: Option<f64>,
    pub fast_top_precession_rad_per_s: Option<f64>,
    pub predicted_nutation_period_s: Option<f64>,
    pub measured_nutation_period_s: Option<f64>,
    pub measured_nutation_uncertainty_s: Option<f64>,
    /// Whether two time steps are shorter than the nutation: else what is measured is a strobe's picture of it.
    pub nutation_is_resolved: Option<bool>,
    pub fast_top_nutation_rad_per_s: Option<f64>,
    pub L_axle_Js: Option<f64>,
    pub sleeping_limit_Js: Option<f64>,
    /// Whether the numbers hold, in one sentence.
    pub health: String,
}

impl Readouts {
    /// The readouts of `simulation` as it stands: `monitor` has followed it, `health` is how it stands, and `advice`
    /// what would mend it.
    pub fn new(
        simulation: &Simulation,
        monitor: &mut Monitor,
        health: &Health,
        advice: Option<&Advice>,
    ) -> Self {
        let theory = monitor.theory(simulation.state().time_s);
        let precession = monitor.instruments().precession_rad_per_s();
        let nutation = monitor.instruments().nutation_period_s();
        Self {
            turns_per_step: health.turns_per_step,
            nutation_multiplier: health.nutation.map(|nutation| nutation.multiplier),
            lag_deg: health.lag_deg,
            steady_lag_deg: health.nutation.map(|nutation| nutation.scheme_lag_deg),
            true_steady_lag_deg: health.nutation.map(|nutation| nutation.true_lag_deg),
            distance_m: health.deviation.map(|off| off.distance_m),
            most_distance_m: health.most_distance_m,
            L_axle_drift_Js: health.deviation.map(|off| off.spin),
            Lz_drift_Js: health.deviation.map(|off| off.lz),
            kappa: SymmetricTop::of(&simulation.scenario().body.mechanics).map(|top| top.kappa()),
            path: theory.map(|theory| theory.path.to_string()),
            lowest_tilt_deg: theory.map(|theory| theory.tilt_range_deg.0),
            highest_tilt_deg: theory.map(|theory| theory.tilt_range_deg.1),
            cusp_tilt_deg: theory.and_then(|theory| theory.cusp_tilt_deg),
            predicted_precession_rad_per_s: theory.and_then(|theory| theory.precession),
            measured_precession_rad_per_s: precession.map(|measured| measured.value),
            measured_precession_uncertainty_rad_per_s: uncertainty(precession),
            slow_precession_rad_per_s: theory.and_then(|theory| theory.slow_precession),
            fast_precession_rad_per_s: theory.and_then(|theory| theory.fast_precession),
            fast_top_precession_rad_per_s: theory.and_then(|theory| theory.fast_top_precession),
            predicted_nutation_period_s: theory.and_then(|theory| theory.nutation_period_s),
            measured_nutation_period_s: nutation.map(|measured| measured.value),
            measured_nutation_uncertainty_s: uncertainty(nutation),
            nutation_is_resolved: theory
                .and_then(|theory| theory.nutation_period_s)
                .map(|period| 2.0 * simulation.motion().time_step_s < period),
            fast_top_nutation_rad_per_s: theory.map(|theory| theory.fast_top_nutation),
            L_axle_Js: theory.map(|theory| theory.spin),
            sleeping_limit_Js: theory.map(|theory| theory.sleeping_limit),
            health: health.sentence(advice),
        }
    }

    fn write_theory(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (kappa, path) = match (self.kappa, &self.path) {
            (None, _) => return writeln!(f, "  theory        none: the body is lopsided"),
            (Some(kappa), None) => {
                let why = "pushed off its axle, or too long a run";
                return writeln!(f, "  theory        kappa {kappa:.4}; none now: {why}");
            }
            (Some(kappa), Some(path)) => (kappa, path),
        };
        let low = number(self.lowest_tilt_deg, 4);
        let high = number(self.highest_tilt_deg, 4);
        writeln!(
            f,
            "  theory        kappa {kappa:.4}; path: {path}, tilt {low} to {high} degrees"
        )?;
        let [slow, fast] = [
            self.slow_precession_rad_per_s,
            self.fast_precession_rad_per_s,
        ];
        let [slow, fast] = [slow, fast].map(|rate| number(rate, 6));
        writeln!(
            f,
            "  steady        precession of {slow} (slow) or {fast} (fast) rad/s at this tilt"
        )?;
        let [limit, spin] = [self.sleeping_limit_Js, self.L_axle_Js];
        let sleeps = if spin.map(f64::abs) > limit {
            "it would"
        } else {
            "it would not"
        };
        let [limit, spin] = [limit, spin].map(|momentum| number(momentum, 3));
        writeln!(
            f,
            "  upright       sleeps with L.axle above {limit} J s; with {spin} {sleeps}"
        )
    }

    fn write_scheme(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "  a time step   turns the body {:.4} times",
            self.turns_per_step
        )?;
        match self.nutation_multiplier {
            Some(factor) => writeln!(f, ", multiplies nutation by {factor:.6}")?,
            None => writeln!(f)?,
        }
        write!(f, "  lag           {:.4} degrees now", self.lag_deg)?;
        match (self.steady_lag_deg, self.true_steady_lag_deg) {
            (Some(lag), Some(truth)) => {
                writeln!(
                    f,
                    "; steady: {lag:.4} by the scheme, {truth:.4} in truth, {:.1} times",
                    lag / truth
                )
            }
            _ => writeln!(f),
        }
    }
}

fn uncertainty(measured: Option<Measured>) -> Option<f64> {
    measured.map(|measured| measured.uncertainty)
}

fn number(value: Option<f64>, decimals: usize) -> String {
    value.map_or("none".to_owned(), |value| format!("{value:.decimals$}"))
}

/// "0.886033 rad/s by theory, 0.886033 +- 2.4e-9 rad/s measured".
fn beside(
    [unit, none]: [&str; 2],
    predicted: Option<f64>,
    measured: Option<f64>,
    uncertainty: Option<f64>,
) -> String {
    let measured = match (measured, uncertainty) {
        (Some(value), Some(uncertainty)) => {
            format!("{value:.6} +- {uncertainty:.1e} {unit} measured")
        }
        _ => "none measured".to_owned(),
    };
    match predicted {
        Some(value) => format!("{value:.6} {unit} by theory, {measured}"),
        None => format!("{none} by theory, {measured}"),
    }
}

impl fmt::Display for Readouts {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let none = if self.kappa.is_some() {
            "none"
        } else {
            "lopsided"
        };
        let precession = beside(
            ["rad/s", none],
            self.predicted_precession_rad_per_s,
            self.measured_precession_rad_per_s,
            self.measured_precession_uncertainty_rad_per_s,
        );
        let nutation = beside(
            ["s", none],
            self.predicted_nutation_period_s,
            self.measured_nutation_period_s,
            self.measured_nutation_uncertainty_s,
        );
        writeln!(f, "  precession    {precession}")?;
        let strobed = match self.nutation_is_resolved {
            Some(false) => ": a strobe's picture, the time step is too long to see it",
            _ => "",
        };
        writeln!(f, "  nutation      {nutation}{strobed}")?;
        self.write_theory(f)?;
        self.write_scheme(f)?;
        if let (Some(spin), Some(lz)) = (self.L_axle_drift_Js, self.Lz_drift_Js) {
            writeln!(
                f,
                "  L             L.axle is off by {spin:+.1e} J s, L_z by {lz:+.1e} J s"
            )?;
        }
        Ok(())
    }
}
