//! What the time step makes of the numbers, in words for one line: the health that [`crate::analysis`] finds, most
//! important first.

use crate::analysis::Health;
use crate::analysis::health::Picture;

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

/// What there is to say of `health`.
pub fn remarks(health: &Health) -> Vec<Remark> {
    let mut remarks = vec![turns(health), distance(health), energy(health)];
    if let Some(nutation) = health.nutation {
        let ratio = nutation.lag_ratio();
        remarks.push(Remark {
            long: format!("lag ×{ratio:.1} the true one"),
            short: format!("lag ×{ratio:.0}"),
            warns: !(0.5..2.0).contains(&ratio),
        });
        let multiplier = nutation.multiplier;
        remarks.push(Remark {
            long: format!("nutation ×{multiplier:.6} a step"),
            short: format!("nutation ×{multiplier:.4}"),
            warns: false,
        });
    }
    remarks
}

fn turns(health: &Health) -> Remark {
    let turns = significant(health.turns_per_step);
    let swing = "the swing is the time step's";
    let (long, short, warns) = match (health.picture, health.nutation) {
        (Picture::Right, _) => (String::new(), String::new(), false),
        (Picture::Strobed, _) => (
            format!(": {}", health.picture),
            ": strobed".to_owned(),
            false,
        ),
        (picture, None) => (format!(": {picture}"), ": aliased".to_owned(), true),
        (_, Some(_)) => (format!(", so that {swing}"), format!(": {swing}"), true),
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
        Some(drift) => format!("energy drift {drift:+.4}"),
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
        n if n >= 1.0 => format!("{n:.2}"),
        n if n >= 0.1 => format!("{n:.3}"),
        n => format!("{n:.4}"),
    }
}

/// A length from metres down to nothing.
fn length(metres: f64) -> String {
    match metres {
        m if m >= 0.01 => format!("{m:.4} m"),
        m if m >= 1e-5 => format!("{:.4} mm", m * 1e3),
        m => format!("{m:.1e} m"),
    }
}
