//! What is wrong with the numbers, in words, from what the simulation gives.

use super::live::LiveRun;
use std::f64::consts::TAU;

/// From this many turns a time step on, the wheel's spin shown is a strobe picture: half a turn, past which nobody
/// can tell forwards from backwards.
const STROBED_FROM: f64 = 0.5;

/// How far the numbers can be trusted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Health {
    /// |Ω| dt / 2π of the last step; `None` at step 0.
    pub turns_per_step: Option<f64>,
    /// (E − E₀ − W)/S; `None` where it means nothing.
    pub energy_drift: Option<f64>,
    /// Distance of the traced point from the exact motion, m; `None` while that is not known.
    pub distance_m: Option<f64>,
    /// Whether the exact motion is shown and still on its way to now.
    pub exact_is_behind: bool,
    /// Whether the exact motion is shown.
    pub exact_is_shown: bool,
}

impl Health {
    /// Reads `run`.
    pub fn of(run: &LiveRun) -> Self {
        let turns = |record: crate::physics::StepRecord| {
            record.workings.angular_velocity.norm() * record.time_step_s / TAU
        };
        Self {
            turns_per_step: run.simulation().record().map(turns),
            energy_drift: run.simulation().energy_drift(),
            distance_m: run
                .overlay()
                .and_then(|overlay| overlay.distance(run.now())),
            exact_is_behind: run.overlay_is_behind(),
            exact_is_shown: run.overlay().is_some(),
        }
    }

    /// Whether the first of its [`sentences`](Self::sentences) is a warning.
    pub fn warns(&self) -> bool {
        self.turns_per_step
            .is_some_and(|turns| turns >= STROBED_FROM)
    }

    /// What there is to say, most important first.
    pub fn sentences(&self) -> Vec<String> {
        let mut sentences = Vec::new();
        if let Some(turns) = self.turns_per_step {
            sentences.push(match turns >= STROBED_FROM {
                true => format!("{turns:.2} turns a step: strobed"),
                false => format!("{turns:.4} turns a step"),
            });
        }
        sentences.push(match self.energy_drift {
            Some(drift) => format!("energy {drift:+.4} mgl"),
            None => "energy n/a".to_owned(),
        });
        sentences.push(
            match (self.exact_is_shown, self.exact_is_behind, self.distance_m) {
                (false, ..) => "press t for the exact motion".to_owned(),
                (true, false, Some(distance)) => format!("exact motion {} away", length(distance)),
                _ => "computing the exact motion".to_owned(),
            },
        );
        sentences
    }
}

/// A length in a column of its own width, from kilometres down to nanometres.
fn length(metres: f64) -> String {
    match metres {
        m if m >= 0.01 => format!("{m:.4} m"),
        m if m >= 1e-5 => format!("{:.4} mm", m * 1e3),
        m => format!("{m:.1e} m"),
    }
}
