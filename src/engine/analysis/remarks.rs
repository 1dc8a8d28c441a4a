//! The health of a run in words: the sentence after a run, and lines of the summary.

use super::Health;
use super::health::{Advice, Nutation, WheelPicture};
use super::predictability::{Equilibrium, Predictability};
use crate::run::EnergyUnit;
use crate::text::number::{NOT_AVAILABLE, fixed, short, shortest, signed_exponent};
use std::f64::consts::{PI, TAU};
use std::fmt;

/// Problem of a run whose scheme has broken down.
const NO_ROTATION: &str = "its orientation is no longer a rotation";

impl fmt::Display for WheelPicture {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Right => "it appears correctly",
            Self::Strobed => "under-sampled, its points are mistaken for one another",
            Self::TooSlow => "under-sampled, it appears to turn too slowly",
            Self::Backwards => "under-sampled, it appears to turn backwards",
            Self::Unknown => "beyond the range of numbers",
        })
    }
}

/// Returns the fix for the run. It consists of command-line options if the run can be repeated with them.
fn remedy(health: &Health, advice: &Advice) -> Option<String> {
    Some(match advice {
        Advice::TimeStep(step) if health.can_be_rescaled => {
            format!("--time-step {}", shortest(*step))
        }
        Advice::TimeStep(step) => format!("dt {} s throughout", shortest(*step)),
        Advice::Scheme {
            name,
            time_step_s,
            tried_s,
        } => {
            let step = shortest(*time_step_s);
            if health.can_be_rescaled {
                format!("--scheme {name} --time-step {step}")
            } else if time_step_s == tried_s {
                format!("--scheme {name}")
            } else {
                format!("{name} at {step} s throughout")
            }
        }
        Advice::Holds | Advice::Nothing | Advice::BoundToItsTimeStep => return None,
    })
}

/// Largest ratio of the scheme's lag to the true lag that is not reported. The scheme's lag is never smaller than the
/// true lag.
const LAG_IS_RIGHT: f64 = 1.05;

impl fmt::Display for Predictability {
    /// Writes the words that follow "the motion is", or nothing if there is no limit.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.unstable {
            Some(Equilibrium::Upright) => {
                f.write_str("an unstable equilibrium: stays upright only in exact arithmetic")?;
            }
            Some(Equilibrium::Other) => {
                f.write_str("an unstable equilibrium: stays as it is only in exact arithmetic")?;
            }
            None => {}
        }
        let Some(until_s) = self.until_s else {
            return Ok(());
        };
        f.write_str(self.unstable.map_or("", |_| "; "))?;
        let until = short(until_s);
        write!(
            f,
            "predictable until t = {until} s; after that, no double-precision computation can predict the motion"
        )
    }
}

fn no_drift(health: &Health) -> &'static str {
    match health.energy_unit {
        None => "neither weight nor kinetic energy to measure it by",
        Some(_) => "beyond the range of numbers",
    }
}

/// Returns the unit of an energy error as a short label for a column of the lab.
pub fn short_unit(unit: Option<EnergyUnit>) -> &'static str {
    match unit {
        Some(EnergyUnit::Weight) => "mgl",
        Some(EnergyUnit::KineticAtStart) => "Ekin",
        None => "",
    }
}

/// Returns the energy error in words: its size and unit, or why there is none.
pub fn energy_in_full(health: &Health) -> String {
    match (health.energy_drift, health.energy_unit) {
        (Some(drift), Some(unit)) => format!("{} of {unit}", signed_exponent(drift, 3)),
        _ => format!("{NOT_AVAILABLE}: {}", no_drift(health)),
    }
}

/// Describes the effect of a time step on the body and its nutation, for a line of the summary.
pub fn step_in_full(health: &Health) -> String {
    let turns = match health.turns_per_step {
        _ if !health.is_a_rotation => format!("turns the body {NOT_AVAILABLE}: {NO_ROTATION}"),
        turns if turns.is_finite() => format!("turns the body {} times", fixed(turns, 4)),
        _ => format!("turns the body {NOT_AVAILABLE}: beyond the range of numbers"),
    };
    match health.nutation {
        Some(Nutation { multiplier, .. }) => {
            format!("{turns}, multiplies nutation by {}", fixed(multiplier, 6))
        }
        None => turns,
    }
}

/// Describes the angle between axle and L, for a line of the summary.
pub fn lag_in_full(health: &Health) -> String {
    let now = format!("{} degrees now", fixed(health.lag_deg, 4));
    let Some(nutation) = health.nutation else {
        return now;
    };
    let (Some(truth), Some(ratio)) = (nutation.true_lag_deg, nutation.lag_ratio) else {
        return now;
    };
    format!(
        "{now}; in steady precession {} by the scheme, {} times the true {}",
        fixed(ratio * truth, 4),
        fixed(ratio, 1),
        fixed(truth, 4)
    )
}

/// Formats a small number with its sign. Zero has no sign.
fn of_rounding(number: f64) -> String {
    match number {
        0.0 => "0".to_owned(),
        number => signed_exponent(number, 1),
    }
}

/// Describes the errors of the constants of motion, for a line of the summary. `None` if they are unknown.
pub fn constants_in_full(health: &Health) -> Option<String> {
    let off = health.deviation?;
    Some(format!(
        "L.axle is off by {} J s, L_z by {} J s",
        of_rounding(off.axle_momentum),
        of_rounding(off.lz)
    ))
}

/// Rotation per step from which on no scheme that approximates the rotation by polynomials is accurate, rad.
const TOO_FAR_RAD: f64 = 1.0;

impl Health {
    /// Returns a sentence of at most 40 words: whether the numbers are reliable, and if not, what is wrong and how to
    /// fix it. If the run continues beyond the time that can be predicted, one more sentence says so.
    pub fn sentence(&self, advice: Option<&Advice>) -> String {
        let Some(most) = self.most_distance_m else {
            return "Not compared with the exact motion, which would take too long or leaves the range of numbers.".to_owned();
        };
        if self.arm_m == 0.0 {
            return "Not judged: the traced point is the pivot, which does not move in any run."
                .to_owned();
        }
        let is_exact = self.scheme.order.is_none() && most == 0.0;
        let far = format!(
            "{} m ({} % of its arm)",
            short(most),
            short(100.0 * most / self.arm_m)
        );
        let limits = self.limits();
        if limits.unstable.is_some() {
            return format!("The motion is {limits}.");
        }
        let limit = limits
            .until_s
            .map_or(String::new(), |_| format!(" The motion is {limits}."));
        let fix = advice.map_or(String::new(), |advice| fix_words(self, advice));
        if self.point_holds() == Some(false) {
            return format!(
                "Not reliable: {}, and the traced point is up to {far} from the exact motion{fix}.{limit}",
                cause(self)
            );
        }
        if let Some(swing) = self.swing.filter(|swing| !swing.is_right()) {
            let cause = cause_of_swing(self).map_or(String::new(), |cause| format!(": {cause}"));
            return format!(
                "The traced point is right, but not the nutation: {swing}{cause}{fix}.{limit}"
            );
        }
        if limits.until_s.is_some() {
            // Two exact motions differ only by rounding, which is of no interest.
            let within = match self.scheme.order {
                Some(_) => format!(": the traced point stayed within {far} of the exact motion"),
                None => String::new(),
            };
            return format!("The motion is {limits}. Until then the numbers are reliable{within}.");
        }
        let warning = picture(self);
        if is_exact {
            format!("The numbers are reliable: the run is the exact motion itself{warning}.")
        } else {
            format!(
                "The numbers are reliable: the traced point stayed within {far} of the exact motion{warning}."
            )
        }
    }
}

/// Describes how the turning body appears, if it appears wrong.
fn picture(health: &Health) -> String {
    match health.picture {
        WheelPicture::Right => String::new(),
        picture => format!("; only a picture of the turning body is misleading: {picture}"),
    }
}

/// Returns why the tilt swings wrongly, if this is known.
fn cause_of_swing(health: &Health) -> Option<String> {
    let nutation = health.nutation;
    let too_far = nutation
        .and_then(|nutation| nutation.lag_ratio)
        .filter(|ratio| *ratio > LAG_IS_RIGHT);
    if let (Some(nutation), Some(_)) = (nutation, health.changed_nutation()) {
        Some(changed(&nutation))
    } else if let Some(ratio) = too_far {
        let ratio = short(ratio);
        Some(format!("axle lags L {ratio} times too far"))
    } else {
        let turns = health.turns_per_step;
        let is_far = TAU * turns >= TOO_FAR_RAD;
        is_far.then(|| format!("the body turns {} times per step", short(turns)))
    }
}

/// Describes the change of a nutation: "damped by 0.1 % per step".
fn changed(nutation: &Nutation) -> String {
    let change = nutation.multiplier - 1.0;
    let verb = if change < 0.0 { "damped" } else { "amplified" };
    format!("{verb} by {} % per step", short(100.0 * change.abs()))
}

fn cause(health: &Health) -> String {
    let psi = TAU * health.turns_per_step;
    let (turns, name) = (short(health.turns_per_step), health.scheme.name);
    match health.nutation {
        _ if !health.is_a_rotation => {
            format!("the scheme {name} breaks down (its orientation is not a rotation)")
        }
        Some(_) if psi >= PI => {
            format!("the body turns {turns} times per step, so the swing is under-sampled")
        }
        Some(nutation) if health.nutation_is_the_cause() => {
            format!("the nutation is {}", changed(&nutation))
        }
        _ if !psi.is_finite() => "the turn per step is beyond the range of numbers".to_owned(),
        _ if psi >= TOO_FAR_RAD => {
            format!("at {turns} turns per step, the scheme {name} cannot follow the motion")
        }
        _ if health.scheme.order.is_none() => {
            "the error of another scheme before the edit remains".to_owned()
        }
        _ => format!("the errors of the scheme {name} have added up"),
    }
}

fn fix_words(health: &Health, advice: &Advice) -> String {
    match advice {
        Advice::Holds => String::new(),
        Advice::Nothing => "; no fix was found".to_owned(),
        Advice::BoundToItsTimeStep => "; no other scheme corrects it".to_owned(),
        _ => remedy(health, advice).map_or(String::new(), |it| format!("; {it} corrects it")),
    }
}
