//! How long a motion can be predicted. A second exact motion, which begins 1e-12 rad from the first, is compared with
//! it.
//!
//! No double-precision computation begins closer to a motion than rounding allows, and none stays closer. A start with
//! 16 digits is off by 1e-16. An integration adds about 1e-15 for every radian turned, which makes 1e-12 in a thousand
//! radians. The companion represents these errors. Its offset is larger than all of them, so two good computations of
//! one motion differ by less than the companion and the motion do.
//!
//! In a chaotic motion the offset grows exponentially, and another offset would change the resulting time little. An
//! offset a hundred times smaller adds 4.6 e-folding times to the 23 that an offset of 1e-12 needs to become 1 %.
//!
//! The two have separated when their traced points are more than 1 % of the arm apart, which is also the limit for the
//! error of a run ([`BELIEVED_WITHIN`]). The times of comparison depend on the motion alone, not on the steps of a run.
//! The result is therefore the same for every scheme and time step.
//!
//! A body that is balanced, and yet departs from its companion, is in an unstable equilibrium. Balance means that the
//! forces have no torque and the rotation keeps its axis in the body. Examples are a slow top exactly upright, a
//! pendulum upside down on its pivot, and a free body that turns exactly about its middle axis. Such a motion lasts
//! only in exact arithmetic, and rounding decides where a run goes. The run is therefore neither accepted nor rejected.

use super::cost::{is_affordable, turning_rad_per_s};
use super::swings::BELIEVED_WITHIN;
use crate::physics::loads::torque;
use crate::physics::{State, observables};
use crate::run::Truth;
use crate::scenario::Scenario;
use nalgebra::Vector3;
use std::sync::Arc;

/// Rotation by which the companion's start differs, rad, world frame. It is along no direction of symmetry.
const OFFSET: Vector3<f64> = Vector3::new(0.48e-12, 0.64e-12, 0.60e-12);
/// Angle of that rotation, rad.
const OFFSET_RAD: f64 = 1e-12;
/// Angle by which the body turns or swings between two comparisons at its present rate, rad.
const BETWEEN_LOOKS_RAD: f64 = 0.5;
/// Fraction of the time since the forces last changed that may pass between two comparisons, for motions in closed
/// form. There, an error grows no faster than time, except near the vertical.
const BETWEEN_LOOKS: f64 = 0.005;
/// Growth factor of the offset from which on a balance is unstable. In a stable balance it grows by less, unless the
/// spin is within a millionth of the limit.
const UNSTABLE_GROWTH: f64 = 1000.0;

/// Limits on predicting a motion, as found up to some time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Predictability {
    /// Time after which no double-precision computation can predict the motion, s. `None` if that time has not been
    /// reached.
    pub until_s: Option<f64>,
    /// The equilibrium that the motion is in, if it is unstable.
    pub unstable: Option<Equilibrium>,
}

/// An equilibrium of the whole motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Equilibrium {
    /// The axle is upright.
    Upright,
    /// The body rests in another position, or turns about an axis that is fixed in it.
    Other,
}

/// A second exact motion that began near another, and the distance between the two.
#[derive(Clone, Debug)]
pub(super) struct Companion {
    motion: Truth,
    next_look_s: f64,
    /// Time up to which the last comparison was requested, s.
    asked_s: f64,
    /// Largest difference of the orientations so far, rad.
    most_rad: f64,
    until_s: Option<f64>,
    is_balanced: bool,
}

impl Companion {
    /// Returns the companion of the exact motion of `scenario`, at the start.
    pub fn new(scenario: &Arc<Scenario>) -> Self {
        let start = scenario.start;
        let beside = State {
            orientation: start.orientation + OFFSET.cross_matrix() * start.orientation,
            ..start
        };
        Self {
            motion: Truth::from_start(Arc::clone(scenario), beside),
            next_look_s: 0.0,
            asked_s: 0.0,
            most_rad: OFFSET_RAD,
            until_s: None,
            is_balanced: true,
        }
    }

    /// Continues with the exact motion of `scenario`, which has the same past.
    pub fn branch(&mut self, scenario: &Arc<Scenario>) {
        self.motion.branch(scenario);
        if self.until_s.is_none() {
            // The time of the next comparison depends on the forces, which have changed.
            self.next_look_s = self.next_look_s.min(self.asked_s);
        }
    }

    /// Returns the time at which the two had separated, s.
    pub fn until_s(&self) -> Option<f64> {
        self.until_s
    }

    /// Compares the two up to `time_s`. `exact` must not have been asked for a time later than the next comparison.
    #[inline]
    pub fn look_until(&mut self, exact: &mut Truth, time_s: f64) {
        self.asked_s = time_s;
        while self.next_look_s <= time_s {
            self.look(exact);
        }
    }

    fn look(&mut self, exact: &mut Truth) {
        let now_s = self.next_look_s;
        let (state, beside) = (exact.state_at(now_s), self.motion.state_at(now_s));
        let scenario = exact.scenario();
        let at = &scenario.body.mechanics.points()[scenario.trace].at;
        let difference = beside.orientation - state.orientation;
        if !difference.norm().is_finite() {
            self.next_look_s = f64::INFINITY; // the motion has left the range of numbers
            return;
        }
        // The norm of the difference of two near rotations is √2 times the angle between them.
        self.most_rad = self.most_rad.max(difference.norm() / 2.0_f64.sqrt());
        self.is_balanced &= is_balanced(exact, &state, self.most_rad);
        if (difference * at).norm() > BELIEVED_WITHIN * scenario.arm_m() {
            self.until_s = Some(now_s);
            self.next_look_s = f64::INFINITY;
        } else {
            self.next_look_s = next_look_s(exact, &state);
        }
    }

    /// Returns the limits found so far.
    pub fn found(&self) -> Predictability {
        let is_unstable = self.is_balanced && self.most_rad >= UNSTABLE_GROWTH * OFFSET_RAD;
        Predictability {
            until_s: self.until_s,
            unstable: is_unstable.then(|| Equilibrium::of_start(self.motion.scenario())),
        }
    }
}

impl Equilibrium {
    /// Returns the equilibrium in which `scenario` begins.
    fn of_start(scenario: &Scenario) -> Self {
        let axle = scenario.start.axle();
        let rate = observables::angular_velocity(&scenario.body.mechanics, &scenario.start);
        let is_upright = axle.z > 0.0 && axle.xy().norm() <= OFFSET_RAD;
        let turns_about_axle = axle.cross(&rate).norm() <= OFFSET_RAD * rate.norm();
        if is_upright && turns_about_axle {
            Self::Upright
        } else {
            Self::Other
        }
    }
}

/// Returns how far the motion of `scenario` can be predicted, as found up to `end_s` (s). Reports no limits if the
/// exact motion would take too long.
pub fn predictability(scenario: &Arc<Scenario>, end_s: f64) -> Predictability {
    if !is_affordable(scenario) {
        return Predictability::default();
    }
    let mut companion = Companion::new(scenario);
    companion.look_until(&mut Truth::new(Arc::clone(scenario)), end_s);
    companion.found()
}

/// Returns true if `exact`, in `state`, is balanced to within an error of `error_rad`.
fn is_balanced(exact: &Truth, state: &State, error_rad: f64) -> bool {
    let scenario = exact.scenario();
    let body = &scenario.body.mechanics;
    let moment = exact.loads().moment(body);
    let [first, now] = [&scenario.start, state].map(|at| {
        let rate = observables::angular_velocity(body, at);
        at.orientation.tr_mul(&rate)
    });
    torque(&state.orientation, &moment).norm() <= error_rad * moment.norm()
        && first.cross(&now).norm() <= error_rad * first.norm_squared()
}

/// Returns the time at which to compare the motions after `exact` was in `state`, s. It is no later than the next
/// change of forces.
fn next_look_s(exact: &Truth, state: &State) -> f64 {
    let motion = exact.motion();
    let apart_s = BETWEEN_LOOKS_RAD / turning_rad_per_s(exact.scenario(), exact.loads(), state);
    let apart_s = match motion.closed_form() {
        Some(_) => apart_s.max(BETWEEN_LOOKS * (state.time_s - motion.begin_s())),
        None => apart_s,
    };
    if apart_s.is_nan() || apart_s == 0.0 {
        return f64::INFINITY; // the rate is beyond the range of numbers
    }
    // Just after the change, so that the next interval follows from the new forces, and always later than now.
    (state.time_s + apart_s)
        .min(exact.end_s().next_up())
        .max(state.time_s.next_up())
}
