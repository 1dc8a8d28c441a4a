//! The numbers on the screen, read off a few times a second: digits that change in every frame can be read by nobody,
//! and a slow line has better things to carry.

use super::live::LiveRun;
use super::pace::{Pace, Speed};
use crate::analysis::{Health, Measured};
use crate::run::Sample;
use std::time::Duration;

/// Time between two readings while the run goes on.
pub const EVERY: Duration = Duration::from_millis(250);

/// A precession without nutations counts as measured from this relative uncertainty on.
const SETTLED: f64 = 0.05;

/// One reading.
#[derive(Clone, Debug, PartialEq)]
pub struct Readouts {
    /// The run's numbers at its step.
    pub sample: Sample,
    /// Precession as it was measured so far, degrees a second.
    pub precession_deg_per_s: Option<f64>,
    /// The exact motion's mean precession, degrees a second.
    pub predicted_precession_deg_per_s: Option<f64>,
    /// Nutation period as it was measured so far, s.
    pub nutation_s: Option<f64>,
    /// The exact motion's nutation period, s.
    pub predicted_nutation_s: Option<f64>,
    /// Whether it is shorter than two time steps: what is measured then is a strobe's picture of it.
    pub nutation_is_strobed: bool,
    /// How far the numbers can be trusted.
    pub health: Health,
    /// Whether the run goes on, and how fast.
    pub pace: String,
}

impl Readouts {
    /// Reads `run`, which is played at `pace`.
    pub fn new(run: &mut LiveRun, pace: &Pace) -> Self {
        let (health, theory) = (run.health(), run.theory());
        let (precession, nutation) = (
            run.instruments().precession_rad_per_s(),
            run.instruments().nutation_period_s(),
        );
        let predicted = theory.and_then(|theory| theory.precession);
        let predicted_nutation_s = theory.and_then(|theory| theory.nutation_period_s);
        let two_steps_s = 2.0 * run.simulation().motion().time_step_s;
        Self {
            sample: run.simulation().sample(),
            precession_deg_per_s: precession
                .filter(is_settled)
                .map(|measured| measured.value.to_degrees()),
            predicted_precession_deg_per_s: predicted.map(f64::to_degrees),
            nutation_s: nutation.map(|measured| measured.value),
            predicted_nutation_s,
            nutation_is_strobed: predicted_nutation_s
                .is_some_and(|period_s| period_s < two_steps_s),
            health,
            pace: pace_in_words(pace),
        }
    }
}

/// Whether `measured` says something: known to a half from whole nutations, or settled without any. An axle that passes
/// through the vertical has nutations and no azimuth to speak of.
fn is_settled(measured: &Measured) -> bool {
    let within = if measured.nutations > 0 { 0.5 } else { SETTLED };
    measured.uncertainty <= within * measured.value.abs()
}

fn pace_in_words(pace: &Pace) -> String {
    match (pace.is_running(), pace.speed()) {
        (false, Speed::Times(speed)) => format!("paused ×{}", short(speed)),
        (false, Speed::Top) => "paused, top".to_owned(),
        (true, Speed::Top) => format!("► top ×{}", short(two_digits(pace.achieved()))),
        (true, Speed::Times(_)) if pace.falls_behind() => {
            format!("► ×{} max", short(two_digits(pace.achieved())))
        }
        (true, Speed::Times(speed)) => format!("► ×{}", short(speed)),
    }
}

/// `number` without the digits that only flicker.
fn two_digits(number: f64) -> f64 {
    if !(number > 0.0 && number.is_finite()) {
        return 0.0;
    }
    let unit = libm::exp10(number.log10().floor() - 1.0);
    (number / unit).round() * unit
}

/// As few digits as say it: 20, 0.002, 5e5.
fn short(number: f64) -> String {
    match number {
        n if n >= 1e5 => format!("{n:.0e}"),
        n if n >= 10.0 => format!("{n:.0}"),
        n if n >= 1e-3 => format!("{}", (n * 1e6).round() / 1e6),
        n => format!("{n:.0e}"),
    }
}
