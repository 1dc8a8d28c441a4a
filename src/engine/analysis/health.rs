//! Whether a run's numbers can be believed, and if not, what the time step did to them.
//!
//! For the report's scheme on a symmetric body, with ψ = |Ω|dt: frozen L multiplies the axle's small offset from L by
//! A = 1 − κ + κ e^{iψ} each step, where the truth is e^{iκψ}; a torque that turns L by δ = |τ|dt/|L| a step makes the
//! axle lag by δ/|1 − A|, where the truth is δ/(κψ).

use super::cost::{AFFORDABLE_RAD, integration_rad, is_affordable};
use super::deviation::{Deviation, ExactReference};
use super::predictability::Predictability;
use super::slowing::FrictionEffect;
pub use super::swings::BELIEVED_WITHIN;
use super::swings::SwingComparison;
use crate::journal::restart::in_force;
use crate::physics::loads::torque;
use crate::physics::{SchemeInfo, SymmetricTop, observables};
use crate::run::{Clock, EnergyUnit, Simulation, Step, resampled};
use crate::scenario::{Edit, Motion, Scenario, rescale};
use crate::text::nice_numbers::rung;
use nalgebra::Vector3;
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

/// Steps that a search for a better time step may take, of the report's 14 points; of more points as many fewer.
const SEARCH_STEPS: u64 = 2_000_000;
/// Where a time step is not to be mended, the first of these is tried that can be true to the scenario's friction.
const BETTER_SCHEMES: [&str; 2] = ["srkn11b", "strang"];
/// Number of looks at a trial, evenly spread, at which it may be given up; and the most steps between two looks.
const TRIAL_LOOKS: u64 = 1000;
const MOST_TOGETHER: u64 = 4096;
/// A nutation that swings by less than this (degrees) is none.
pub const LEAST_SWING_DEG: f64 = 1e-6;
/// A nutation that the scheme has changed by less than this part is as it was.
const LEAST_CHANGE: f64 = 0.05;

/// How a run stands at one step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Health {
    /// The scheme of the step taken last.
    pub scheme: &'static SchemeInfo,
    /// Turns of the body in one time step, |Ω|dt/2π.
    pub turns_per_step: f64,
    /// What that does to the picture of the wheel.
    pub picture: WheelPicture,
    /// Whether the body has a rim, and so is a wheel.
    pub has_rim: bool,
    /// The report's scheme alone: what it does to nutation and lag.
    pub nutation: Option<Nutation>,
    /// How the tilt has swung beside the exact motion's; `None` where the exact motion would take too long.
    pub swing: Option<SwingComparison>,
    /// Whether the body's orientation is a rotation, as a scheme that breaks down does not leave it.
    pub is_a_rotation: bool,
    /// Angle between axle and L now, degrees.
    pub lag_deg: f64,
    /// (E − E0 − W)/S, see [`Step::energy_drift`].
    pub energy_drift: Option<f64>,
    /// What S is; `None` where there is none.
    pub energy_unit: Option<EnergyUnit>,
    /// What friction does; `None` where there is none.
    pub slowing: Option<FrictionEffect>,
    /// How far off the exact motion it is now; `None` where the exact motion would take too long, or can be predicted no
    /// longer.
    pub deviation: Option<Deviation>,
    /// The largest distance of the traced point from the exact motion so far, m, while that could be predicted.
    pub most_distance_m: Option<f64>,
    /// How far the exact motion can be predicted.
    pub predictability: Predictability,
    /// Distance of the traced point from the pivot, m.
    pub arm_m: f64,
    pub steps: u64,
    /// Whether the whole run can be had at another time step by itself: no edits, no push that counts its own steps.
    pub can_be_rescaled: bool,
}

/// What the time step does to the picture of a wheel of n equal points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum WheelPicture {
    /// Each point is nearest to where it was: the turning shows as it is.
    Right,
    /// From π/n on one point moves to where another was.
    Strobed,
    /// The rest of a step's turning after whole turns is less than half a turn: too slow.
    TooSlow,
    /// It is more: backwards.
    Backwards,
    /// It turns further in a step than numbers reach.
    Unknown,
}

/// What the report's scheme does to a symmetric body at one time step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nutation {
    /// |A|, the factor on the nutation's size each step; the truth is 1.
    pub multiplier: f64,
    /// How many times the true angle between axle and L in steady precession is the scheme's, for a small angle: κ ψ/|1 − A|.
    /// `None` without a torque, and where the scheme has no such angle.
    pub lag_ratio: Option<f64>,
    /// The true angle between axle and L in slow steady precession at this tilt and spin, degrees; `None` where there is no
    /// such precession.
    pub true_lag_deg: Option<f64>,
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
        name: &'static str,
        time_step_s: f64,
        /// The finest time step tried with the run's own, s.
        tried_s: f64,
    },
    /// Its pushes accumulate step by step, and are others at another time step; no other scheme mends it at this one.
    BoundToItsTimeStep,
    /// Nothing that could be tried in reasonable time.
    Nothing,
}

impl Health {
    /// Of the run at `step`, which `beside` has been shown up to there.
    pub fn new(step: &Step, beside: &mut ExactReference) -> Self {
        let scenario = step.scenario();
        let deviation = beside.deviation(step.after());
        // What is edited at this step is said at once: it is true of the step to come.
        let (motion, _) = in_force(scenario, step.number());
        let state = step.after();
        let psi = length(step.angular_velocity()) * motion.time_step_s;
        let axle = state.axle();
        // As a direction: the squares of a very large L leave the range of numbers.
        let towards = state.momentum / state.momentum.amax();
        let lag = libm::atan2(axle.cross(&towards).norm(), axle.dot(&towards));
        Self {
            scheme: motion.scheme,
            turns_per_step: psi / TAU,
            picture: WheelPicture::from_angle(
                psi,
                scenario.file.body.rim.as_ref().map_or(1, |rim| rim.points),
            ),
            has_rim: scenario.file.body.rim.is_some(),
            nutation: Nutation::from_step(step, &motion, psi),
            swing: beside.swing(),
            is_a_rotation: state.is_a_rotation(),
            lag_deg: if lag.is_finite() {
                lag.to_degrees()
            } else {
                0.0
            },
            energy_drift: step.energy_drift(),
            energy_unit: step.energy_unit(),
            slowing: FrictionEffect::new(step),
            deviation,
            most_distance_m: beside.most_distance_m(),
            predictability: beside.predictability(),
            arm_m: scenario.arm_m(),
            steps: step.number(),
            can_be_rescaled: rescale::can_be_rescaled(&scenario.file),
        }
    }

    /// Whether the run is believed: the traced point has kept near enough to the exact motion, and the tilt swings as it
    /// does, while that could be predicted. `None` where that is not known, the traced point is the pivot, or rounding
    /// decides whether the run leaves its unstable equilibrium.
    pub fn is_believed(&self) -> Option<bool> {
        if self.limits().unstable.is_some() {
            return None;
        }
        Some(self.point_holds()? && self.swing?.is_right())
    }

    /// Whether the run's numbers at this step are those of the motion. `None` where that is not known.
    pub fn is_reliable(&self) -> Option<bool> {
        match self.predictability.until_s {
            Some(_) => Some(false),
            None => self.is_believed(),
        }
    }

    /// Returns what limits every computation of the motion. A scheme that breaks down is to blame, not the equilibrium.
    pub fn limits(&self) -> Predictability {
        Predictability {
            unstable: self.predictability.unstable.filter(|_| self.is_a_rotation),
            ..self.predictability
        }
    }

    /// Whether the traced point has kept near enough to the exact motion; `None` where that is not known, or the traced
    /// point is the pivot.
    pub fn point_holds(&self) -> Option<bool> {
        self.most_distance_m
            .filter(|_| self.arm_m > 0.0)
            .map(|most| most <= BELIEVED_WITHIN * self.arm_m)
    }

    /// What the scheme has made of the nutation, where the tilt does not swing as it should and the scheme has changed a
    /// nutation by more than a twentieth since the start: how many times its size is left.
    pub fn changed_nutation(&self) -> Option<f64> {
        let left = libm::pow(self.nutation?.multiplier, self.steps as f64);
        let is_wrong = self
            .swing
            .is_some_and(|swing| !swing.is_right() && swing.is_there());
        (is_wrong && (left - 1.0).abs() > LEAST_CHANGE).then_some(left)
    }

    /// Whether what the scheme has made of the nutation is large enough to be what puts the traced point off.
    pub(super) fn nutation_is_the_cause(&self) -> bool {
        let (Some(left), Some(swing), Some(most)) =
            (self.changed_nutation(), self.swing, self.most_distance_m)
        else {
            return false;
        };
        let (low, high) = swing.exact_deg;
        (high - low).to_radians() * self.arm_m * (left - 1.0).abs() > most / 2.0
    }
}

impl WheelPicture {
    /// Of a wheel of `points` equal points that turns by `psi` radians a step.
    fn from_angle(psi: f64, points: usize) -> Self {
        match psi {
            psi if !psi.is_finite() => Self::Unknown,
            psi if psi > PI && psi % TAU < PI => Self::TooSlow,
            psi if psi > PI => Self::Backwards,
            psi if psi > PI / points as f64 => Self::Strobed,
            _ => Self::Right,
        }
    }
}

impl Nutation {
    fn from_step(step: &Step, motion: &Motion, psi: f64) -> Option<Self> {
        let scenario = step.scenario();
        let (state, loads) = (step.after(), step.loads());
        let body = &scenario.body.mechanics;
        let top = SymmetricTop::from_body(body).filter(|_| motion.scheme.name == "report")?;
        let kappa = top.kappa();
        let (sin, cos) = libm::sincos(psi);
        let ratio = psi / libm::hypot(1.0 - cos, sin);
        let has_torque = torque(&state.orientation, &loads.moment(body)).norm() > 0.0;
        let load = loads.on_axle(body, &top);
        let true_lag = load.and_then(|load| top.steady_lag(state, &load));
        psi.is_finite().then(|| Self {
            multiplier: (1.0 - 2.0 * kappa * (1.0 - kappa) * (1.0 - cos))
                .max(0.0)
                .sqrt(),
            lag_ratio: Some(ratio).filter(|ratio| has_torque && ratio.is_finite()),
            true_lag_deg: true_lag.map(f64::to_degrees).filter(|lag| lag.is_finite()),
        })
    }

    /// The scheme's angle between axle and L in slow steady precession, degrees; `None` where it has none.
    pub fn scheme_lag_deg(&self) -> Option<f64> {
        Some(self.true_lag_deg? * self.lag_ratio?)
    }
}

/// What would mend `scenario`: its own time step without the edits of time step and scheme, each finer one of the series
/// 1, 2, 5, then the better scheme, are tried by running them beside the exact motion, so that what is advised has been
/// seen to hold. A time step in which the body turns by more than half a turn may come near by luck (wobble-push does at
/// 0.05 s, and not at 0.02): it is not advised.
pub fn advise(scenario: &Scenario) -> Advice {
    advise_while(scenario, &|| true).unwrap_or(Advice::Nothing)
}

/// As [`advise`], given up soon after `is_wanted` returns false: then `None`.
pub fn advise_while(scenario: &Scenario, is_wanted: &dyn Fn() -> bool) -> Option<Advice> {
    let advice = tried(scenario, is_wanted);
    // Trials that were given up have found nothing out.
    is_wanted().then_some(advice)
}

/// Plays `scenario` beside the exact motion: the most turns of the body in one time step, where the run is to be believed;
/// `None` where it is not, or `is_wanted` returned false.
fn turns_if_believed(scenario: &Arc<Scenario>, is_wanted: &dyn Fn() -> bool) -> Option<f64> {
    let mut simulation = Simulation::new(Arc::clone(scenario));
    let mut beside = ExactReference::new(scenario);
    let together = (scenario.steps / TRIAL_LOOKS).clamp(1, MOST_TOGETHER);
    let mut most_turns = 0.0_f64;
    loop {
        let end = scenario.steps.min(simulation.step_number() + together);
        while simulation.step_number() < end {
            beside.hold(simulation.step().ok()?.after());
        }
        let health = Health::new(simulation.now(), &mut beside);
        most_turns = most_turns.max(health.turns_per_step);
        if health.point_holds() != Some(true) || !is_wanted() {
            return None;
        }
        if end == scenario.steps {
            // In an unstable equilibrium nobody knows more of a run than that it is a rotation.
            return (health.is_believed() != Some(false)).then_some(most_turns);
        }
    }
}

/// Returns what [`turns_if_believed`] does for `scenario` at another time step, s, with another scheme.
fn trial(
    scenario: &Scenario,
    time_step_s: f64,
    scheme: &'static SchemeInfo,
    is_wanted: &dyn Fn() -> bool,
) -> Option<f64> {
    let other = Arc::new(resampled(scenario, time_step_s, scheme));
    turns_if_believed(&other, is_wanted)
}

/// Returns whether a [`trial`] is believed and its steps turn the body by less than half a turn.
fn holds(
    scenario: &Scenario,
    time_step_s: f64,
    scheme: &'static SchemeInfo,
    is_wanted: &dyn Fn() -> bool,
) -> bool {
    trial(scenario, time_step_s, scheme, is_wanted).is_some_and(|most_turns| most_turns < 0.5)
}

/// What trials of `scenario` lead to; each ends as one that does not hold when `is_wanted` returns false.
fn tried(scenario: &Scenario, is_wanted: &dyn Fn() -> bool) -> Advice {
    let (own, scheme) = (scenario.motion.time_step_s, scenario.motion.scheme);
    if !is_affordable(scenario) || Clock::end_s(scenario) / own > most_steps(scenario) {
        return Advice::Nothing;
    }
    if trial(scenario, own, scheme, is_wanted).is_some() {
        return if scenario
            .edits
            .iter()
            .any(|edit: &Edit| edit.motion.scheme != scheme || edit.sets_time_step)
        {
            Advice::TimeStep(own)
        } else {
            Advice::Holds
        };
    }
    let better = better_scheme(scenario);
    let with_better = |time_step_s, tried_s| Advice::Scheme {
        name: better.name,
        time_step_s,
        tried_s,
    };
    if rescale::accumulates(scenario) {
        // At another time step it would be another run.
        return if better != scheme && holds(scenario, own, better, is_wanted) {
            with_better(own, own)
        } else {
            Advice::BoundToItsTimeStep
        };
    }
    let mut finer = finer_time_steps(scenario);
    if let Some(step) = finer.find(|&step| holds(scenario, step, scheme, is_wanted)) {
        return Advice::TimeStep(step);
    }
    let tried_s = finer_time_steps(scenario).last().unwrap_or(own);
    let mut steps = std::iter::once(own).chain(finer_time_steps(scenario));
    let found = steps.find(|&step| better != scheme && holds(scenario, step, better, is_wanted));
    found.map_or(Advice::Nothing, |step| with_better(step, tried_s))
}

/// The scheme that is tried where a time step is not to be mended.
fn better_scheme(scenario: &Scenario) -> &'static SchemeInfo {
    let mut better = BETTER_SCHEMES
        .iter()
        .filter_map(|name| SchemeInfo::find(name));
    better
        .find(|scheme| scheme.admits.why_not(&scenario.friction).is_none())
        .unwrap_or(scenario.motion.scheme)
}

/// The length of `vector`, also where its squares leave the range of numbers.
fn length(vector: &Vector3<f64>) -> f64 {
    match vector.amax() {
        0.0 => 0.0,
        size => size * (vector / size).norm(),
    }
}

/// How many steps a search may take with this many points.
fn most_steps(scenario: &Scenario) -> f64 {
    SEARCH_STEPS as f64 * 14.0 / scenario.body.mechanics.points().len().max(14) as f64
}

/// 5, 2 and 1 of every power of ten below the scenario's time step in which the body turns by less than half a turn,
/// while all of them together take no more steps than the search may.
fn finer_time_steps(scenario: &Scenario) -> impl Iterator<Item = f64> + use<> {
    let begin = scenario.motion.time_step_s;
    let (duration, most) = (Clock::end_s(scenario), most_steps(scenario));
    let spin = observables::angular_velocity(&scenario.body.mechanics, &scenario.start).norm();
    let coarsest = begin.min(PI / spin);
    let decade = libm::floor(libm::log10(coarsest)).max(-400.0) as i64;
    // An exact motion that has to be integrated is integrated anew for every trial.
    let trials = (AFFORDABLE_RAD / integration_rad(scenario)).clamp(4.0, 64.0) as usize;
    let mut spent = 0.0;
    (0..36)
        .map(move |down| rung(3 * decade + 2 - down))
        .filter(move |&step| step < 0.999 * coarsest)
        .take_while(move |step| {
            spent += duration / step;
            spent <= most
        })
        .take(trials)
}
