//! What the time step makes of the numbers, in words for one line: the health that [`crate::analysis`] finds, most
//! important first.

use crate::analysis::Health;
use crate::analysis::health::{Advice, BETTER_SCHEME, Nutation, Picture};

/// Distances smaller than this are what decimals leave over, m.
const ROUNDING_M: f64 = 1e-12;

/// One thing to say, at length where there is room, and in short.
#[derive(Clone, Debug, PartialEq)]
pub struct Remark {
    /// In full.
    pub long: String,
    /// In few words.
    pub short: String,
    /// Whether something is wrong.
    pub warns: bool,
}

/// What there is to say of `health`, and of what would mend it, where that is known.
pub fn remarks(health: &Health, advice: Option<&Advice>) -> Vec<Remark> {
    let mut remarks = vec![turns(health), distance(health)];
    if health.is_believed() == Some(false) {
        remarks.extend(advice.and_then(mend));
    }
    remarks.push(energy(health));
    remarks.extend(health.nutation.iter().flat_map(swing));
    remarks
}

fn mend(advice: &Advice) -> Option<Remark> {
    let (long, short) = match advice {
        Advice::TimeStep(step) => (
            format!("--time-step {step} would mend it"),
            format!("dt {step} s mends it"),
        ),
        Advice::Scheme { time_step_s, .. } => (
            format!("--scheme {BETTER_SCHEME} --time-step {time_step_s} would mend it"),
            format!("{BETTER_SCHEME}, dt {time_step_s} s mends it"),
        ),
        Advice::Holds | Advice::Nothing => return None,
    };
    Some(Remark {
        long,
        short,
        warns: false,
    })
}

fn swing(nutation: &Nutation) -> [Remark; 2] {
    let (ratio, multiplier) = (nutation.lag_ratio(), nutation.multiplier);
    let (lag, warns) = match ratio {
        0.5..2.0 => ("axle lags L as far as it should".to_owned(), false),
        2.0.. => (format!("axle lags L {} times too far", times(ratio)), true),
        _ => (
            format!("axle lags L {} of what it should", times(ratio)),
            true,
        ),
    };
    let nutation = format!("nutation ×{multiplier:.4} a step");
    [(lag, warns), (nutation, false)].map(|(text, warns)| Remark {
        long: text.clone(),
        short: text,
        warns,
    })
}

fn turns(health: &Health) -> Remark {
    let turns = significant(health.turns_per_step);
    let (long, short, warns) = match (health.picture, health.nutation) {
        (Picture::Right, _) => (String::new(), String::new(), false),
        (Picture::Strobed, _) => (
            format!(": {}", health.picture),
            ": strobed".to_owned(),
            false,
        ),
        (picture, None) => (format!(": {picture}"), ": aliased".to_owned(), true),
        (_, Some(_)) => (
            ", so that the swing is the time step's".to_owned(),
            " make the swing".to_owned(),
            true,
        ),
    };
    Remark {
        long: format!("the wheel turns {turns} times a step{long}"),
        short: format!("{turns} turns a step{short}"),
        warns,
    }
}

fn distance(health: &Health) -> Remark {
    let Some(deviation) = health.deviation else {
        let unknown = "not held against the exact motion";
        return Remark {
            long: unknown.to_owned(),
            short: unknown.to_owned(),
            warns: false,
        };
    };
    let metres = length(deviation.distance_m);
    Remark {
        long: format!("{metres} off the exact motion"),
        short: format!("{metres} off exact"),
        warns: health.is_believed() == Some(false),
    }
}

fn energy(health: &Health) -> Remark {
    let text = match health.energy_drift {
        Some(drift) => format!("energy drift {drift:+.4} mgl"),
        None => "energy n/a".to_owned(),
    };
    Remark {
        long: text.clone(),
        short: text,
        warns: false,
    }
}

/// Three digits, as a fixed number of characters while the size does not change.
fn significant(number: f64) -> String {
    match number {
        n if n >= 1e6 => format!("{n:.1e}"),
        n if n >= 1.0 => format!("{n:.2}"),
        n if n >= 0.1 => format!("{n:.3}"),
        n => format!("{n:.4}"),
    }
}

/// How many times, without digits that only flicker.
fn times(ratio: f64) -> String {
    match ratio {
        r if r >= 1e6 => format!("{r:.1e}"),
        r if r < 10.0 => format!("{r:.1}"),
        r => format!("{r:.0}"),
    }
}

/// A distance in metres, as many characters whatever its size; rounding is no distance.
fn length(metres: f64) -> String {
    match metres {
        m if m < ROUNDING_M => "0 m".to_owned(),
        m if m >= 1e-3 => format!("{m:.4} m"),
        m => format!("{m:.1e} m"),
    }
}
