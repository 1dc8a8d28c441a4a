//! The health of a run in one sentence.

use super::{LAG_IS_RIGHT, NO_ROTATION, change};
use crate::analysis::Health;
use crate::analysis::health::{Advice, Picture};
use crate::text::number::{short, shortest};
use std::f64::consts::{PI, TAU};

/// Radians a step beyond which no scheme that follows the rotation by polynomials keeps up.
const TOO_FAR_RAD: f64 = 1.0;

impl Health {
    /// In one sentence: whether the numbers hold, what is wrong with them, and what would mend it.
    pub fn sentence(&self, advice: Option<&Advice>) -> String {
        let Some(most) = self.most_distance_m else {
            return "Not held against the exact motion, which would take too long or leaves the range of numbers.".to_owned();
        };
        if self.arm_m == 0.0 {
            return "Nothing can be said: the traced point is the pivot, which stands still in every run.".to_owned();
        }
        let is_exact = self.scheme.order.is_none() && most == 0.0;
        let far = format!(
            "{} m ({} % of its arm)",
            short(most),
            short(100.0 * most / self.arm_m)
        );
        let mend = advice.map_or(String::new(), |advice| how_to_mend(self, advice));
        if self.point_holds() == Some(false) {
            return format!(
                "Do not believe this run: {}, and the traced point is up to {far} off the exact motion{mend}.",
                cause(self)
            );
        }
        if let Some(swing) = self.swing.filter(|swing| !swing.is_right()) {
            return format!(
                "The traced point holds, and the nutation does not: the point has kept within {far} of the exact motion, but {swing}{}{mend}.",
                cause_of_swing(self)
            );
        }
        let picture = picture(self);
        if is_exact {
            format!("The numbers hold: the run is the exact motion itself{picture}.")
        } else {
            format!(
                "The numbers hold: the traced point has kept within {far} of the exact motion{picture}."
            )
        }
    }
}

/// What the time step makes of the picture of the turning body, where that is not right.
fn picture(health: &Health) -> String {
    match health.picture {
        Picture::Right => String::new(),
        Picture::Unknown => {
            format!(" (in a step the body turns {})", health.picture)
        }
        _ => format!(
            "; only a picture of the turning body would mislead, which turns {} times a step: {}",
            short(health.turns_per_step),
            health.picture
        ),
    }
}

/// Why the tilt does not swing as it should, where that is known.
fn cause_of_swing(health: &Health) -> String {
    let lag_ratio = health.nutation.and_then(|nutation| nutation.lag_ratio);
    if let (Some(nutation), Some(left)) = (health.nutation, health.changed_nutation()) {
        let now = match left {
            left if left < 1e-3 => "is gone".to_owned(),
            left => format!("has {} times its size", short(left)),
        };
        let (verb, percent) = change(&nutation);
        format!(": the scheme {verb} the nutation by {percent} % a step, so that it {now}")
    } else if let Some(ratio) = lag_ratio.filter(|ratio| *ratio > LAG_IS_RIGHT) {
        let ratio = short(ratio);
        format!(
            ": at this time step the scheme's axle lags behind L {ratio} times as far as it should and swings about that"
        )
    } else if TAU * health.turns_per_step >= TOO_FAR_RAD {
        let turns = short(health.turns_per_step);
        format!(": the body turns {turns} times in a time step")
    } else {
        String::new()
    }
}

fn cause(health: &Health) -> String {
    let psi = TAU * health.turns_per_step;
    let (turns, name) = (short(health.turns_per_step), health.scheme.name);
    match health.nutation {
        _ if !health.is_a_rotation => {
            format!("the scheme {name} breaks down at this time step, {NO_ROTATION}")
        }
        Some(_) if psi >= PI => {
            format!(
                "the body turns {turns} times in a time step, so that the swing of the axle is strobed: it is the time step's"
            )
        }
        Some(nutation) if health.nutation_is_the_cause() => {
            let (verb, percent) = change(&nutation);
            format!(
                "the scheme {verb} the nutation by {percent} % a step, which should last as it is"
            )
        }
        _ if !psi.is_finite() => {
            "the body turns further in a time step than numbers reach".to_owned()
        }
        _ if psi >= TOO_FAR_RAD => {
            format!(
                "the body turns {turns} times in a time step, more than the scheme {name} can follow with this body"
            )
        }
        _ if health.scheme.order.is_none() => {
            "what another scheme did before the edit is carried on exactly".to_owned()
        }
        _ => format!("the error that the scheme {name} makes at this time step has added up"),
    }
}

fn how_to_mend(health: &Health, advice: &Advice) -> String {
    // A run with edits at steps is refused another time step: it has to be written anew.
    let throughout = if health.can_be_rescaled {
        ""
    } else {
        " throughout, with its edits of gravity and pushes at the same times,"
    };
    let step_in = |time_step_s: &f64| format!("{} s{throughout}", shortest(*time_step_s));
    match advice {
        Advice::Holds => String::new(),
        Advice::Nothing => "; nothing that could be tried in reasonable time mends it".to_owned(),
        Advice::BoundToItsTimeStep => {
            "; no other scheme mends it at this time step, and at another one its accumulating pushes make it another run"
                .to_owned()
        }
        Advice::TimeStep(step) if health.can_be_rescaled => {
            let step = shortest(*step);
            format!("; a time step of {step} s (--time-step {step}) mends it")
        }
        Advice::TimeStep(step) => format!("; a time step of {} mends it", step_in(step)),
        Advice::Scheme {
            name,
            time_step_s,
            tried_s,
        } => {
            let step = step_in(time_step_s);
            if time_step_s == tried_s {
                return format!("; the scheme {name} at {step} mends it");
            }
            let tried = shortest(*tried_s);
            format!("; no time step down to {tried} s mends it, but the scheme {name} at {step} does")
        }
    }
}
