//! Judges whether a run's numbers can be trusted and, if not, finds a fix by trial.
//!
//! The formulas below describe the report's scheme on a symmetric body, with ψ = |Ω|dt. While L is frozen, each step
//! multiplies the axle's small offset from L by A = 1 − κ + κ e^{iψ}. The true factor is e^{iκψ}. A torque that turns L
//! by δ = |τ|dt/|L| per step makes the axle lag by δ/|1 − A|. The true lag is δ/(κψ).

use super::cost::{AFFORDABLE_RAD, integration_rad, is_affordable};
use super::deviation::{Deviation, ExactReference};
use super::predictability::Predictability;
use super::slowing::FrictionEffect;
use super::swings::SwingComparison;
pub use super::swings::{BELIEVED_WITHIN, SWING_TOLERANCE, tilt_tolerance_deg};
use crate::journal::restart::in_force;
use crate::physics::loads::torque;
use crate::physics::{SchemeInfo, SymmetricTop, observables};
use crate::run::{Clock, EnergyUnit, Simulation, Step, resampled};
use crate::scenario::{Edit, Motion, Scenario, rescale};
use crate::text::nice_numbers::rung;
use nalgebra::Vector3;
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

/// Maximum number of steps in a search for a better time step, for the report's 14 points. More points allow fewer
/// steps.
const SEARCH_STEPS: u64 = 2_000_000;
/// Schemes to try if no time step fixes the run. The first one that can model the scenario's friction is tried.
const BETTER_SCHEMES: [&str; 2] = ["srkn11b", "strang"];
/// Number of checks in a trial, evenly spread, at which it may be given up.
const TRIAL_LOOKS: u64 = 1000;
/// Maximum number of steps between two checks.
const MOST_TOGETHER: u64 = 4096;
/// Minimum swing of a nutation, degrees. A smaller one is not a nutation.
pub const LEAST_SWING_DEG: f64 = 1e-6;
/// Maximum relative change of a nutation by the scheme that counts as no change.
const LEAST_CHANGE: f64 = 0.05;

/// Health of a run at one step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Health {
    /// Scheme in force for the next step.
    pub scheme: &'static SchemeInfo,
    /// Turns of the body in one time step, |Ω|dt/2π.
    pub turns_per_step: f64,
    /// Effect of the time step on the picture of the wheel.
    pub picture: WheelPicture,
    /// True if the body has a rim, and so is a wheel.
    pub has_rim: bool,
    /// Effect of the report's scheme on nutation and lag. `None` for other schemes and for lopsided bodies.
    pub nutation: Option<Nutation>,
    /// Swing of the tilt compared with the exact motion. `None` if the exact motion would take too long.
    pub swing: Option<SwingComparison>,
    /// True if the body's orientation is a rotation. A scheme that breaks down deforms it.
    pub is_a_rotation: bool,
    /// Angle between axle and L now, degrees.
    pub lag_deg: f64,
    /// (E − E0 − W)/S, see [`Step::energy_drift`].
    pub energy_drift: Option<f64>,
    /// The unit S, or `None` if there is none.
    pub energy_unit: Option<EnergyUnit>,
    /// Effect of friction, or `None` without friction.
    pub slowing: Option<FrictionEffect>,
    /// Present deviation from the exact motion. `None` if the exact motion would take too long, or can no longer be
    /// predicted.
    pub deviation: Option<Deviation>,
    /// Largest distance of the traced point from the exact motion so far, m, while the motion could be predicted.
    pub most_distance_m: Option<f64>,
    /// Limits on predicting the exact motion.
    pub predictability: Predictability,
    /// Distance of the traced point from the pivot, m.
    pub arm_m: f64,
    pub steps: u64,
    /// True if the whole run can be repeated with another time step: no edits, and no push that counts its own steps.
    pub can_be_rescaled: bool,
}

/// Effect of the time step on the picture of a wheel of n equal points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum WheelPicture {
    /// Each point is nearest to its own previous position: the wheel appears to turn correctly.
    Right,
    /// Under-sampled: the step turns the wheel by more than π/n, and one point moves to where another was.
    Strobed,
    /// Under-sampled: after whole turns, a step adds less than half a turn. The wheel appears too slow.
    TooSlow,
    /// Under-sampled: after whole turns, a step adds more than half a turn. The wheel appears to turn backwards.
    Backwards,
    /// The turn per step is beyond the range of numbers.
    Unknown,
}

/// Effect of the report's scheme on a symmetric body at one time step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nutation {
    /// |A|, the factor on the nutation's size per step. The true factor is 1.
    pub multiplier: f64,
    /// Ratio of the scheme's angle between axle and L in steady precession to the true one, for a small angle: κψ/|1 −
    /// A|. `None` without a torque, or if the scheme has no such angle.
    pub lag_ratio: Option<f64>,
    /// True angle between axle and L in slow steady precession at this tilt and spin, degrees. `None` if there is no
    /// such precession.
    pub true_lag_deg: Option<f64>,
}

/// Advice that would fix a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Advice {
    /// The run needs no fix.
    Holds,
    /// This time step, s, which was found by trial.
    TimeStep(f64),
    /// Another scheme at this time step, s. The run's own scheme failed down to `tried_s`.
    Scheme {
        name: &'static str,
        time_step_s: f64,
        /// Shortest time step tried with the run's own scheme, s.
        tried_s: f64,
    },
    /// The run's pushes accumulate per step, and would differ at another time step. No other scheme fixes the run at
    /// this one.
    BoundToItsTimeStep,
    /// No fix could be found in reasonable time.
    Nothing,
}

impl Health {
    /// Returns the health of the run at `step`. `beside` has received all steps up to it.
    pub fn new(step: &Step, beside: &mut ExactReference) -> Self {
        let scenario = step.scenario();
        let deviation = beside.deviation(step.after());
        // An edit at this step shows at once, because it applies to the next step.
        let (motion, _) = in_force(scenario, step.number());
        let state = step.after();
        let psi = length(step.angular_velocity()) * motion.time_step_s;
        let axle = state.axle();
        // Only the direction counts here. The squares of a very large L would leave the range of numbers.
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

    /// Returns true if the run is accepted: while the motion could be predicted, the traced point stayed near the exact
    /// motion, and the tilt swings like the exact tilt.
    ///
    /// `None` if this is unknown, if the traced point is the pivot, or if rounding decides whether the run leaves its
    /// unstable equilibrium.
    pub fn is_believed(&self) -> Option<bool> {
        if self.limits().unstable.is_some() {
            return None;
        }
        Some(self.point_holds()? && self.swing?.is_right())
    }

    /// Returns true if the run's numbers at this step agree with the motion. `None` if this is unknown.
    pub fn is_reliable(&self) -> Option<bool> {
        match self.predictability.until_s {
            Some(_) => Some(false),
            None => self.is_believed(),
        }
    }

    /// Returns the limits on predicting the motion. If a scheme breaks down, the scheme is to blame and not the
    /// equilibrium.
    pub fn limits(&self) -> Predictability {
        Predictability {
            unstable: self.predictability.unstable.filter(|_| self.is_a_rotation),
            ..self.predictability
        }
    }

    /// Returns true if the traced point has stayed near the exact motion. `None` if this is unknown, or the traced
    /// point is the pivot.
    pub fn point_holds(&self) -> Option<bool> {
        self.most_distance_m
            .filter(|_| self.arm_m > 0.0)
            .map(|most| most <= BELIEVED_WITHIN * self.arm_m)
    }

    /// Returns the factor by which the scheme has changed a nutation's size since the start. `None` unless the tilt
    /// swings wrongly and the change is more than a twentieth.
    pub fn changed_nutation(&self) -> Option<f64> {
        let left = libm::pow(self.nutation?.multiplier, self.steps as f64);
        let is_wrong = self
            .swing
            .is_some_and(|swing| !swing.is_right() && swing.is_there());
        (is_wrong && (left - 1.0).abs() > LEAST_CHANGE).then_some(left)
    }

    /// Returns true if the change of the nutation is large enough to explain the error of the traced point.
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
    /// Returns the picture of a wheel of `points` equal points that turns by `psi` radians per step.
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

    /// Returns the scheme's angle between axle and L in slow steady precession, degrees. `None` if there is none.
    pub fn scheme_lag_deg(&self) -> Option<f64> {
        Some(self.true_lag_deg? * self.lag_ratio?)
    }
}

/// Returns advice that would fix `scenario`, found by trial.
///
/// It first tries the scenario's own time step without the edits of time step and scheme. Then it tries each shorter
/// one of the series 1, 2, 5, and then the better scheme. Each trial is compared with the exact motion, so that the
/// advice is known to work.
///
/// A time step in which the body turns by more than half a turn is never advised. It may succeed by luck, as
/// wobble-push does at 0.05 s, but not at 0.02 s.
pub fn advise(scenario: &Scenario) -> Advice {
    advise_while(scenario, &|| true).unwrap_or(Advice::Nothing)
}

/// Does the same as [`advise`], but gives up soon after `is_wanted` returns false, and then returns `None`.
pub fn advise_while(scenario: &Scenario, is_wanted: &dyn Fn() -> bool) -> Option<Advice> {
    let advice = find_advice(scenario, is_wanted);
    // Trials that were given up have no result.
    is_wanted().then_some(advice)
}

/// Compares a run of `scenario` with the exact motion. If the run is accepted, returns the maximum turns of the body in
/// one time step. `None` if it is not accepted, or if `is_wanted` returned false.
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
            // In an unstable equilibrium, the only possible check is that the orientation is a rotation.
            return (health.is_believed() != Some(false)).then_some(most_turns);
        }
    }
}

/// Runs [`turns_if_believed`] for `scenario` with another time step, s, and another scheme.
fn trial(
    scenario: &Scenario,
    time_step_s: f64,
    scheme: &'static SchemeInfo,
    is_wanted: &dyn Fn() -> bool,
) -> Option<f64> {
    let other = Arc::new(resampled(scenario, time_step_s, scheme));
    turns_if_believed(&other, is_wanted)
}

/// Returns true if a [`trial`] is accepted and its steps turn the body by less than half a turn.
fn holds(
    scenario: &Scenario,
    time_step_s: f64,
    scheme: &'static SchemeInfo,
    is_wanted: &dyn Fn() -> bool,
) -> bool {
    trial(scenario, time_step_s, scheme, is_wanted).is_some_and(|most_turns| most_turns < 0.5)
}

/// Returns the advice that trials of `scenario` lead to. Once `is_wanted` returns false, each trial counts as failed.
fn find_advice(scenario: &Scenario, is_wanted: &dyn Fn() -> bool) -> Advice {
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
        // At another time step, it would be a different run.
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

/// Returns the scheme to try if no time step fixes the run.
fn better_scheme(scenario: &Scenario) -> &'static SchemeInfo {
    let mut better = BETTER_SCHEMES
        .iter()
        .filter_map(|name| SchemeInfo::find(name));
    better
        .find(|scheme| scheme.admits.why_not(&scenario.friction).is_none())
        .unwrap_or(scenario.motion.scheme)
}

/// Returns the length of `vector`, even if its squares leave the range of numbers.
fn length(vector: &Vector3<f64>) -> f64 {
    match vector.amax() {
        0.0 => 0.0,
        size => size * (vector / size).norm(),
    }
}

/// Returns the maximum number of steps of a search with this number of points.
fn most_steps(scenario: &Scenario) -> f64 {
    SEARCH_STEPS as f64 * 14.0 / scenario.body.mechanics.points().len().max(14) as f64
}

/// Returns the time steps to try: 5, 2 and 1 times each power of ten below the scenario's time step. With each, the
/// body turns by less than half a turn, and all of them together take no more steps than a search may.
fn finer_time_steps(scenario: &Scenario) -> impl Iterator<Item = f64> + use<> {
    let begin = scenario.motion.time_step_s;
    let (duration, most) = (Clock::end_s(scenario), most_steps(scenario));
    let spin = observables::angular_velocity(&scenario.body.mechanics, &scenario.start).norm();
    let coarsest = begin.min(PI / spin);
    let decade = libm::floor(libm::log10(coarsest)).max(-400.0) as i64;
    // An exact motion without closed form is integrated again for every trial.
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
