//! Whether a run's numbers can be believed, and if not, what the time step did to them.
//!
//! For the report's scheme on a symmetric body, with ψ = |Ω|dt: frozen L multiplies the axle's small offset from L by
//! A = 1 − κ + κ e^{iψ} each step, where the truth is e^{iκψ}; a torque that turns L by δ = |τ|dt/|L| a step makes the
//! axle lag by δ/|1 − A|, where the truth is δ/(κψ).

use super::cost::{AFFORDABLE_RAD, integration_rad, is_affordable};
use super::trial::{Deviation, Trial};
use crate::physics::loads::torque;
use crate::physics::{SchemeInfo, SymmetricTop, observables};
use crate::run::resample::resampled;
use crate::run::{Clock, Simulation};
use crate::scenario::{Edit, Scenario, rescale};
use std::f64::consts::{PI, TAU};
use std::fmt;
use std::ops::ControlFlow;
use std::sync::Arc;

/// A run is believed while its traced point keeps within this part of its arm (its distance from the pivot) of the
/// exact motion: what an eye sees on a plot.
pub const BELIEVED_WITHIN: f64 = 0.01;
/// Steps that a search for a better time step may take, of the report's 14 points; of more points as many fewer.
const SEARCH_STEPS: u64 = 2_000_000;
/// Where a time step is not to be mended, this scheme is tried.
pub const BETTER_SCHEME: &str = "srkn11b";
/// Radians a step beyond which no scheme that follows the rotation by polynomials keeps up.
const TOO_FAR_RAD: f64 = 1.0;

/// How a run stands at one step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Health {
    /// The scheme of the step taken last.
    pub scheme: &'static SchemeInfo,
    /// Turns of the body in one time step, |Ω|dt/2π.
    pub turns_per_step: f64,
    /// What that does to the picture of the wheel.
    pub picture: Picture,
    /// The report's scheme alone: what it does to nutation and lag.
    pub nutation: Option<Nutation>,
    /// Angle between axle and L now, degrees.
    pub lag_deg: f64,
    /// (E − E0 − W)/S, see [`Simulation::energy_drift`].
    pub energy_drift: Option<f64>,
    /// How far off the exact motion it is now; `None` where the exact motion would take too long.
    pub deviation: Option<Deviation>,
    /// The largest distance of the traced point from the exact motion so far, m.
    pub most_distance_m: Option<f64>,
    /// Distance of the traced point from the pivot, m.
    pub arm_m: f64,
    /// Steps taken.
    pub steps: u64,
    /// Whether the whole run can be had at another time step by itself: no edits, no push that counts its own steps.
    pub can_be_rescaled: bool,
}

/// What the time step does to the picture of a wheel of n equal points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Picture {
    /// Each point is nearest to where it was: the turning shows as it is.
    Right,
    /// From π/n on one point moves to where another was.
    Strobed,
    /// The rest of a step's turning after whole turns is less than half a turn: too slow.
    TooSlow,
    /// It is more: backwards.
    Backwards,
}

/// What the report's scheme does to a symmetric body at one time step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nutation {
    /// |A|, the factor on the nutation's size each step; the truth is 1.
    pub multiplier: f64,
    /// Lag of the axle behind L in steady precession under the scheme, degrees.
    pub scheme_lag_deg: f64,
    /// The true one, degrees.
    pub true_lag_deg: f64,
}

/// What would mend a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Advice {
    /// It needs no mending.
    Holds,
    /// This time step, s, found by trial.
    TimeStep(f64),
    /// Another scheme at this time step, s: the run's own was tried down to `tried_s` without success.
    Scheme {
        /// The time step of the other scheme, s.
        time_step_s: f64,
        /// The finest time step tried with the run's own, s.
        tried_s: f64,
    },
    /// Nothing that could be tried in reasonable time.
    Nothing,
}

impl Health {
    /// Of `simulation` as it stands; `deviation` and `most_distance_m` from the exact motion.
    pub fn new(
        simulation: &Simulation,
        deviation: Option<Deviation>,
        most_distance_m: Option<f64>,
    ) -> Self {
        let scenario = simulation.scenario();
        let (state, motion) = (simulation.state(), simulation.motion());
        let omega = observables::angular_velocity(&scenario.body.mechanics, state).norm();
        let psi = omega * motion.time_step_s;
        let axle = state.axle();
        let lag = axle
            .cross(&state.momentum)
            .norm()
            .atan2(axle.dot(&state.momentum));
        Self {
            scheme: motion.scheme,
            turns_per_step: psi / TAU,
            picture: Picture::of(
                psi,
                scenario.file.body.rim.as_ref().map_or(1, |rim| rim.points),
            ),
            nutation: Nutation::of(simulation, psi),
            lag_deg: if state.momentum.norm() > 0.0 {
                lag.to_degrees()
            } else {
                0.0
            },
            energy_drift: simulation.energy_drift(),
            deviation,
            most_distance_m,
            arm_m: scenario.arm_m(),
            steps: simulation.step_number(),
            can_be_rescaled: rescale::can_be_rescaled(&scenario.file),
        }
    }

    /// Whether the traced point has kept near enough to the exact motion; `None` where that is not known, or the traced
    /// point is the pivot.
    pub fn is_believed(&self) -> Option<bool> {
        self.most_distance_m
            .filter(|_| self.arm_m > 0.0)
            .map(|most| most <= BELIEVED_WITHIN * self.arm_m)
    }

    /// In one sentence: whether the numbers hold, what is wrong with them, and what would mend it.
    pub fn sentence(&self, advice: Option<&Advice>) -> String {
        let Some(most) = self.most_distance_m else {
            return "Not held against the exact motion, which would take too long or leaves the range of numbers.".to_owned();
        };
        if self.arm_m == 0.0 {
            return "Nothing can be said: the traced point is the pivot, which stands still in every run.".to_owned();
        }
        let far = format!(
            "{} m ({} % of its arm)",
            short(most),
            short(100.0 * most / self.arm_m)
        );
        if self.is_believed() == Some(true) {
            let picture = match self.picture {
                Picture::Right => String::new(),
                _ => format!(
                    " (the wheel turns {} times a step: {})",
                    short(self.turns_per_step),
                    self.picture
                ),
            };
            return format!(
                "The numbers hold: the traced point has kept within {far} of the exact motion{picture}."
            );
        }
        let mend = advice.map_or(String::new(), |advice| self.mend(advice));
        format!(
            "Do not believe this run: {}, and the traced point is up to {far} off the exact motion{mend}.",
            self.cause()
        )
    }

    fn cause(&self) -> String {
        let psi = TAU * self.turns_per_step;
        let turns = short(self.turns_per_step);
        let (name, faded) = (self.scheme.name, self.faded());
        match self.nutation {
            Some(_) if psi >= PI => {
                format!(
                    "the wheel turns {turns} times in a time step, so that the swing of the axle is the time step's"
                )
            }
            Some(nutation) if faded.abs() > 0.05 => {
                let verb = if faded < 0.0 { "damps" } else { "feeds" };
                let percent = 100.0 * (nutation.multiplier - 1.0).abs();
                format!(
                    "the scheme {verb} the nutation by {} % a step, which should last as it is",
                    short(percent)
                )
            }
            _ if psi >= TOO_FAR_RAD => {
                format!(
                    "the body turns {turns} times in a time step, more than the scheme {name} can follow"
                )
            }
            _ if self.scheme.order.is_none() => {
                "what another scheme did before the edit is carried on exactly".to_owned()
            }
            _ => format!("the error that the scheme {name} makes at this time step has added up"),
        }
    }

    /// Natural logarithm of what the scheme has made of a nutation since the start.
    fn faded(&self) -> f64 {
        self.nutation
            .map_or(0.0, |nutation| nutation.multiplier.ln() * self.steps as f64)
    }

    fn mend(&self, advice: &Advice) -> String {
        match advice {
            Advice::Holds => String::new(),
            Advice::Nothing => {
                "; nothing that could be tried in reasonable time mends it".to_owned()
            }
            Advice::TimeStep(step) => {
                let option = match self.can_be_rescaled {
                    true => format!(" (--time-step {step})"),
                    false => String::new(),
                };
                format!("; a time step of {step} s{option} keeps it within 1 %")
            }
            Advice::Scheme {
                time_step_s,
                tried_s,
            } => format!(
                "; no time step down to {tried_s} s mends it, but the scheme {BETTER_SCHEME} at {time_step_s} s does"
            ),
        }
    }
}

impl Picture {
    /// Of a wheel of `points` equal points that turns by `psi` radians a step.
    fn of(psi: f64, points: usize) -> Self {
        match psi {
            psi if psi > PI && psi % TAU < PI => Self::TooSlow,
            psi if psi > PI => Self::Backwards,
            psi if psi > PI / points as f64 => Self::Strobed,
            _ => Self::Right,
        }
    }
}

impl fmt::Display for Picture {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Right => "it shows as it is",
            Self::Strobed => "its points are taken for one another, a strobe's picture",
            Self::TooSlow => "it seems to turn too slowly",
            Self::Backwards => "it seems to turn backwards",
        })
    }
}

impl Nutation {
    fn of(simulation: &Simulation, psi: f64) -> Option<Self> {
        let scenario = simulation.scenario();
        let (state, motion) = (simulation.state(), simulation.motion());
        let body = &scenario.body.mechanics;
        let top = SymmetricTop::of(body).filter(|_| motion.scheme.name == "report")?;
        let (kappa, momentum) = (top.kappa(), state.momentum.norm());
        let (sin, cos) = psi.sin_cos();
        let off_one = kappa * (1.0 - cos).hypot(sin);
        let kick = torque(&state.orientation, &simulation.loads().moment(body)).norm()
            * motion.time_step_s
            / momentum;
        Some(Self {
            multiplier: (1.0 - 2.0 * kappa * (1.0 - kappa) * (1.0 - cos))
                .max(0.0)
                .sqrt(),
            scheme_lag_deg: (kick / off_one).to_degrees(),
            true_lag_deg: (kick / (kappa * psi)).to_degrees(),
        })
        .filter(|nutation| nutation.scheme_lag_deg.is_finite() && nutation.true_lag_deg.is_finite())
    }

    /// How many times the true lag the scheme's is.
    pub fn lag_ratio(&self) -> f64 {
        self.scheme_lag_deg / self.true_lag_deg
    }
}

/// What would mend `scenario`: its own time step without the edits of time step and scheme, each finer one of the series
/// 1, 2, 5, then the better scheme, are tried by running them beside the exact motion, so that what is advised has been
/// seen to hold. A time step in which the body turns by more than half a turn may come near by luck (wobble-push does at
/// 0.05 s, and not at 0.02): it is not advised.
pub fn advise(scenario: &Scenario) -> Advice {
    let (own, scheme) = (scenario.motion.time_step_s, scenario.motion.scheme);
    let trial = |step: f64, scheme| {
        let other = Arc::new(resampled(scenario, step, scheme));
        Trial::run(&other, |_| ControlFlow::Continue(()))
            .filter(|trial| trial.broke.is_none())
            .filter(|trial| trial.most_distance_m <= BELIEVED_WITHIN * scenario.arm_m())
    };
    let holds = |step: f64, scheme| trial(step, scheme).is_some_and(|trial| trial.most_turns < 0.5);
    if !is_affordable(scenario) || duration_s(scenario) / own > most_steps(scenario) {
        return Advice::Nothing;
    }
    if trial(own, scheme).is_some() {
        let is_edited = |edit: &Edit| edit.motion.scheme != scheme || edit.touches.time_step;
        return match scenario.edits.iter().any(is_edited) {
            true => Advice::TimeStep(own),
            false => Advice::Holds,
        };
    }
    let mut tried_s = own;
    for step in finer_time_steps(scenario) {
        if holds(step, scheme) {
            return Advice::TimeStep(step);
        }
        tried_s = step;
    }
    let better = SchemeInfo::find(BETTER_SCHEME).unwrap_or(scheme);
    let mut steps = std::iter::once(own).chain(finer_time_steps(scenario));
    match steps.find(|&step| better != scheme && holds(step, better)) {
        Some(time_step_s) => Advice::Scheme {
            time_step_s,
            tried_s,
        },
        None => Advice::Nothing,
    }
}

fn duration_s(scenario: &Scenario) -> f64 {
    Clock::end_s(scenario)
}

/// How many steps a search may take with this many points.
fn most_steps(scenario: &Scenario) -> f64 {
    SEARCH_STEPS as f64 * 14.0 / scenario.body.mechanics.points().len().max(14) as f64
}

/// 5, 2 and 1 of every power of ten below the scenario's time step in which the body turns by less than half a turn,
/// while all of them together take no more steps than the search may.
fn finer_time_steps(scenario: &Scenario) -> impl Iterator<Item = f64> + use<> {
    let begin = scenario.motion.time_step_s;
    let (duration, most) = (duration_s(scenario), most_steps(scenario));
    let spin = observables::angular_velocity(&scenario.body.mechanics, &scenario.start).norm();
    let coarsest = begin.min(PI / spin);
    let decade = libm::floor(libm::log10(coarsest)) as i32;
    // An exact motion that has to be integrated is integrated anew for every trial.
    let trials = (AFFORDABLE_RAD / integration_rad(scenario)).clamp(4.0, 64.0) as usize;
    let mut spent = 0.0;
    (0..12)
        .flat_map(move |down| [5, 2, 1].map(|digit| rounded(digit, decade - down)))
        .filter(move |&step| step < 0.999 * coarsest)
        .take_while(move |step| {
            spent += duration / step;
            spent <= most
        })
        .take(trials)
}

/// digit · 10^power as it is written: the nearest number to that decimal.
fn rounded(digit: i32, power: i32) -> f64 {
    format!("{digit}e{power}").parse().unwrap_or(f64::NAN)
}

/// Three digits, without a train of zeros.
fn short(number: f64) -> String {
    match number.abs() {
        0.0 => "0".to_owned(),
        size if (1e-3..1e5).contains(&size) => {
            let digits = (2.0 - libm::floor(libm::log10(size))).max(0.0) as usize;
            format!("{number:.digits$}")
        }
        _ => format!("{number:.1e}"),
    }
}
