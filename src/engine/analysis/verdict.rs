//! The verdict on a run, in one line for the screen: whether it is reliable, and if not, why.

use super::Health;
use super::health::WheelPicture;
use super::predictability::Equilibrium;
use crate::physics::observables;
use crate::scenario::{Motion, Scenario};
use crate::text::number::{exponent, rounded, short, steady};
use std::f64::consts::TAU;

/// From this number of turns per step on, a scheme that does not turn the body exactly cannot follow it.
const UNDER_SAMPLED_TURNS: f64 = 0.5;
/// Distances below this are rounding errors, m.
const ROUNDING_M: f64 = 1e-12;

/// Result of a verdict, in a few words.
#[derive(Clone, Debug, PartialEq)]
pub enum VerdictWord {
    Reliable,
    /// The run has not been compared with the exact motion yet.
    Checking,
    /// A word in a badge: the run needs attention.
    Badge(String),
}

/// Phrase of a verdict, with a shorter form for narrow screens.
#[derive(Clone, Debug, PartialEq)]
pub struct Phrase {
    pub long: String,
    pub short: String,
}

impl Phrase {
    pub fn new(long: impl Into<String>, short: impl Into<String>) -> Self {
        Self {
            long: long.into(),
            short: short.into(),
        }
    }
}

/// Verdict on a run, and the reasons for it, the most important first.
#[derive(Clone, Debug, PartialEq)]
pub struct Verdict {
    pub word: VerdictWord,
    pub reasons: Vec<Phrase>,
    /// Warning that a picture of the body is misleading although the run is reliable.
    pub hint: Option<Phrase>,
}

impl Verdict {
    pub fn new(health: &Health) -> Self {
        let limits = health.limits();
        match (limits.unstable, health.is_believed(), limits.until_s) {
            (Some(equilibrium), _, _) => {
                Self::badge("UNSTABLE BALANCE", vec![unstable(equilibrium)])
            }
            (None, Some(false), until_s) => {
                let reasons = cause(health).into_iter().chain(disagreement(health));
                let limit = until_s.map(|until_s| {
                    let text = format!("predictable to t = {} s", short(until_s));
                    Phrase::new(text.clone(), text)
                });
                Self::badge("NOT RELIABLE", reasons.chain(limit).collect())
            }
            (None, _, Some(until_s)) => {
                let long = "after that, no computation can predict the motion: it is chaotic";
                let badge = format!("PREDICTABLE to t = {} s", short(until_s));
                Self::badge(badge, vec![Phrase::new(long, "after that it is chaotic")])
            }
            (None, Some(true), None) if health.steps == 0 => Self {
                word: VerdictWord::Checking,
                reasons: Vec::new(),
                hint: None,
            },
            (None, Some(true), None) => Self {
                word: VerdictWord::Reliable,
                reasons: vec![agreement(health)],
                hint: picture(health),
            },
            (None, None, None) if health.most_distance_m.is_none() => {
                let long = "it would take too long to compute, or leaves the range of numbers";
                Self::badge(
                    "NO EXACT MOTION",
                    vec![Phrase::new(long, "takes too long to compute")],
                )
            }
            (None, None, None) => {
                let long = "the traced point is the pivot, which does not move";
                Self::badge(
                    "NOT JUDGED",
                    vec![Phrase::new(long, "the traced point is the pivot")],
                )
            }
        }
    }

    fn badge(word: impl Into<String>, reasons: Vec<Phrase>) -> Self {
        Self {
            word: VerdictWord::Badge(word.into()),
            reasons,
            hint: None,
        }
    }
}

/// Returns what a reader of the run's numbers must know, without a full stop: `not reliable: ...`. `None` if they hold.
pub fn caveat(health: &Health) -> Option<String> {
    let verdict = Verdict::new(health);
    let VerdictWord::Badge(word) = verdict.word else {
        return None;
    };
    let word = match word.as_str() {
        "NO EXACT MOTION" | "NOT JUDGED" => "not compared with the exact motion".to_owned(),
        badge if badge.chars().all(|c| !c.is_lowercase()) => badge.to_lowercase(),
        badge => badge.replacen("PREDICTABLE", "predictable", 1),
    };
    let reasons: Vec<String> = verdict
        .reasons
        .into_iter()
        .map(|reason| reason.long)
        .collect();
    Some(format!("{word}: {}", reasons.join("; ")))
}

/// Returns a warning about a run of `scenario` that is known before its first step: its scheme cannot follow the body. `None`
/// if there is nothing to warn of.
pub fn warning_at_start(scenario: &Scenario) -> Option<String> {
    let Motion {
        scheme,
        time_step_s,
        ..
    } = scenario.motion;
    let spin = observables::angular_velocity(&scenario.body.mechanics, &scenario.start).norm();
    let turns = spin * time_step_s / TAU;
    // Not `turns < 0.5`: a turn beyond the range of numbers is too far as well.
    let follows = turns < UNDER_SAMPLED_TURNS;
    (!scheme.turns_exactly && !follows).then(|| {
        let turns = if turns.is_finite() { short(turns) } else { "too many".to_owned() };
        format!(
            "not reliable: under-sampled from the start, the body turns {turns} times per time step, and the scheme {} cannot \
             follow it",
            scheme.name
        )
    })
}

fn unstable(equilibrium: Equilibrium) -> Phrase {
    match equilibrium {
        Equilibrium::Upright => Phrase::new(
            "it stays upright only in exact arithmetic: rounding decides when and where it falls",
            "rounding decides when it falls",
        ),
        Equilibrium::Other => Phrase::new(
            "it stays as it is only in exact arithmetic: rounding decides when it leaves",
            "rounding decides when it leaves",
        ),
    }
}

/// Returns why the run departs from the exact motion, if this is known.
fn cause(health: &Health) -> Option<Phrase> {
    let name = health.scheme.name;
    let (turns, body) = (steady(health.turns_per_step), body(health));
    if !health.is_a_rotation {
        let long = format!("{name} breaks down at this time step: the body is deformed");
        return Some(Phrase::new(long, format!("{name} breaks down")));
    }
    match health.picture {
        WheelPicture::Unknown => {
            let text = format!("{body} turns too far in a step for any number");
            Some(Phrase::new(text.clone(), text))
        }
        WheelPicture::TooSlow | WheelPicture::Backwards => {
            let long = format!("{body} turns {turns} times per step (under-sampled)");
            Some(Phrase::new(long, format!("{turns} {body} turns per step")))
        }
        WheelPicture::Right | WheelPicture::Strobed => {
            let nutation = health.nutation?;
            health.changed_nutation()?;
            let change = nutation.multiplier - 1.0;
            let verb = if change < 0.0 { "damped" } else { "amplified" };
            let percent = short(100.0 * change.abs());
            let text = format!("nutation {verb} by {percent} % per step");
            Some(Phrase::new(text.clone(), text))
        }
    }
}

/// Describes how the run differs from the exact motion.
fn disagreement(health: &Health) -> Option<Phrase> {
    let most = distance(health.most_distance_m?);
    if health.point_holds() == Some(false) {
        let long = format!("up to {most} from the exact motion");
        return Some(Phrase::new(long, format!("up to {most} off")));
    }
    let swing = health.swing.filter(|swing| !swing.is_right())?;
    let long = format!("only the nutation is wrong: {swing}");
    Some(Phrase::new(
        long,
        format!("only the nutation: {}", swing.in_short()),
    ))
}

fn agreement(health: &Health) -> Phrase {
    match health.most_distance_m {
        Some(0.0) if health.scheme.order.is_none() => {
            let text = "the run is the exact motion";
            Phrase::new(text, text)
        }
        Some(most) => {
            let most = distance(most);
            let long = format!("within {most} of the exact motion");
            Phrase::new(long, format!("within {most}"))
        }
        None => Phrase::new("", ""),
    }
}

/// Describes how a picture of the turning body misleads.
fn picture(health: &Health) -> Option<Phrase> {
    let body = body(health);
    let (long, short) = match health.picture {
        WheelPicture::Right | WheelPicture::Unknown => return None,
        WheelPicture::Strobed | WheelPicture::TooSlow => (
            format!("the {body} looks slow: it is seen once per step"),
            format!("the {body} looks slow"),
        ),
        WheelPicture::Backwards => (
            format!("the {body} seems to turn backwards: it is seen once per step"),
            format!("the {body} seems to turn backwards"),
        ),
    };
    Some(Phrase::new(long, short))
}

fn body(health: &Health) -> &'static str {
    if health.has_rim { "wheel" } else { "body" }
}

/// Formats a distance with two significant digits: `0.12 m`, `8.2e-6 m`.
fn distance(meters: f64) -> String {
    match meters {
        m if m < ROUNDING_M => "0 m".to_owned(),
        m if m >= 1e-3 => format!("{} m", rounded(m, 2)),
        m => format!("{} m", exponent(m, 1)),
    }
}
