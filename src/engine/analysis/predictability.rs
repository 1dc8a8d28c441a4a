//! How long a motion can be predicted: a second exact motion begins 1e-12 rad beside the first and is compared with it.
//!
//! No double-precision computation begins closer to a motion than rounding allows, and none keeps closer. A start that is
//! written with 16 digits is off by 1e-16, an integration adds about 1e-15 for every radian turned, and turning a thousand
//! radians so makes 1e-12. The companion stands for these errors: its offset is above all of them, so that two good
//! computations of one motion, the exact ones included, differ by less than the companion and the motion do. Where the
//! motion is chaotic the offset grows exponentially, and another size of it would move the time found by little: a hundred
//! times less offset adds 4.6 e-folding times to the 23 that an offset of 1e-12 needs to become 1 %.
//!
//! The two have parted when their traced points are more than 1 % of the arm apart, by the rule for the error of a run
//! ([`BELIEVED_WITHIN`]). They are compared at times that follow from the motion alone, not at the steps of a run: the
//! answer is the same for every scheme and time step.
//!
//! A body that is balanced and yet leaves its companion is in an unstable equilibrium. Balance means that the forces have
//! no torque and the rotation keeps its axis in the body: a slow top exactly upright, a pendulum standing on its pivot, a
//! free body that turns exactly about its middle axis. Such a motion stays only in exact arithmetic, and rounding decides
//! where a run goes. So a run is neither blamed nor praised for it.

use super::cost::{is_affordable, turning_rad_per_s};
use super::swings::BELIEVED_WITHIN;
use crate::physics::loads::torque;
use crate::physics::{State, observables};
use crate::run::Truth;
use crate::scenario::Scenario;
use nalgebra::Vector3;
use std::sync::Arc;

/// The rotation, rad, world frame, by which the companion's start differs. Its direction is that of no symmetry.
const OFFSET: Vector3<f64> = Vector3::new(0.48e-12, 0.64e-12, 0.60e-12);
/// The angle of that rotation, rad.
const OFFSET_RAD: f64 = 1e-12;
/// The motions are compared each time that the body has turned by this angle, rad, as it turns or swings now.
const BETWEEN_LOOKS_RAD: f64 = 0.5;
/// In closed form an error grows no faster than time, but near the vertical. There this part of the time since the forces
/// last changed may pass between two comparisons.
const BETWEEN_LOOKS: f64 = 0.005;
/// A balance in which an offset has grown by this factor is unstable. In a stable one it grows by less than this unless the
/// spin is within a millionth of the limit.
const UNSTABLE_GROWTH: f64 = 1000.0;

/// How far a motion can be predicted, as found up to some time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Predictability {
    /// The time from which on no double-precision computation can predict the motion, s; `None` up to that time.
    pub until_s: Option<f64>,
    /// The equilibrium that the motion is in, where that is unstable.
    pub unstable: Option<Equilibrium>,
}

/// An equilibrium of the whole motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Equilibrium {
    /// The axle is upright.
    Upright,
    /// The body stands otherwise, or turns about an axis that is fixed in it.
    Other,
}

/// A second exact motion that began beside another, and how far they have parted.
#[derive(Clone, Debug)]
pub(super) struct Companion {
    motion: Truth,
    next_look_s: f64,
    /// The time up to which the two were to be compared last, s.
    asked_s: f64,
    /// The largest difference of the orientations so far, rad.
    most_rad: f64,
    until_s: Option<f64>,
    is_balanced: bool,
}

impl Companion {
    /// Returns the companion of the exact motion of `scenario`, from the start on.
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

    /// Goes on beside the exact motion of `scenario`, whose past is the same.
    pub fn branch(&mut self, scenario: &Arc<Scenario>) {
        self.motion.branch(scenario);
        if self.until_s.is_none() {
            // When to look next follows from the forces, which are others now.
            self.next_look_s = self.next_look_s.min(self.asked_s);
        }
    }

    /// Returns when the two had parted, s.
    pub fn until_s(&self) -> Option<f64> {
        self.until_s
    }

    /// Compares the two up to `time_s`; `exact` has not been asked for a time later than the next comparison.
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

    /// Returns what has been found so far.
    pub fn found(&self) -> Predictability {
        let is_unstable = self.is_balanced && self.most_rad >= UNSTABLE_GROWTH * OFFSET_RAD;
        Predictability {
            until_s: self.until_s,
            unstable: is_unstable.then(|| Equilibrium::of_start(self.motion.scenario())),
        }
    }
}

impl Equilibrium {
    /// Returns that in which `scenario` begins.
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

/// Returns how far the motion of `scenario` can be predicted, found up to `end_s` (s); nothing is known where the exact
/// motion would take too long.
pub fn predictability(scenario: &Arc<Scenario>, end_s: f64) -> Predictability {
    if !is_affordable(scenario) {
        return Predictability::default();
    }
    let mut companion = Companion::new(scenario);
    companion.look_until(&mut Truth::new(Arc::clone(scenario)), end_s);
    companion.found()
}

/// Whether `exact`, in `state`, is no farther from balance than an error of `error_rad` puts it.
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

/// Returns when to compare the motions next after `exact` was in `state`, s: at the latest when the forces change.
fn next_look_s(exact: &Truth, state: &State) -> f64 {
    let motion = exact.motion();
    let apart_s = BETWEEN_LOOKS_RAD / turning_rad_per_s(exact.scenario(), exact.loads(), state);
    let apart_s = match motion.closed_form() {
        Some(_) => apart_s.max(BETWEEN_LOOKS * (state.time_s - motion.begin_s())),
        None => apart_s,
    };
    if apart_s.is_nan() || apart_s == 0.0 {
        return f64::INFINITY; // it turns faster than numbers reach
    }
    // Just after the change, so that the next distance follows from the new forces; and later than now in any case.
    (state.time_s + apart_s)
        .min(exact.end_s().next_up())
        .max(state.time_s.next_up())
}
