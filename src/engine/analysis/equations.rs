//! Solves the equations of motion of a symmetric top between two rows of its run, under a constant load on the axle.
//!
//! With l = L/I1 and p the load over I1, both in the world frame, da/dt = l × a and dl/dt = a × p. The spin about the
//! axle does not enter. Both right sides are products, so that a Taylor series follows term by term.

use super::turns::HeightExtreme;
use crate::physics::observables::Azimuth;
use crate::run::Step;
use nalgebra::Vector3;
use std::f64::consts::TAU;

/// Fraction of a time step. A run that starts this close to a turning point counts as starting at it.
pub(super) const AT_TURN: f64 = 1e-6;
const EQUATION_ORDER: usize = 18;
/// Size of the last term relative to the sum.
const EQUATION_LAST_TERM: f64 = f64::EPSILON / 16.0;
/// Maximum number of series steps between two rows. Beyond it, the motion is too fast to follow.
const MOST_SERIES_STEPS: usize = 64;

/// Terms of one series, beginning with the constant.
type PowerSeries = [Vector3<f64>; EQUATION_ORDER + 1];

/// Axle and momentum of a symmetric top at one moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct TopMotion {
    pub axle: Vector3<f64>,
    /// L divided by the moment of inertia across the axle, rad/s.
    pub momentum: Vector3<f64>,
}

impl TopMotion {
    /// Returns the rate of the axle's height, 1/s.
    pub fn climb(&self) -> f64 {
        self.momentum.x * self.axle.y - self.momentum.y * self.axle.x
    }

    /// Returns the second derivative of the axle's height, 1/s². `pull` is the load over the moment of inertia across
    /// the axle, 1/s².
    pub fn bend(&self, pull: &Vector3<f64>) -> f64 {
        let turning = self.momentum.cross(&self.axle);
        (self.axle.cross(pull).cross(&self.axle) + self.momentum.cross(&turning)).z
    }

    /// Returns the axle's rate of azimuth, rad/s.
    pub fn azimuth_rate(&self) -> f64 {
        let turning = self.momentum.cross(&self.axle);
        (self.axle.x * turning.y - self.axle.y * turning.x) / self.level().powi(2)
    }

    /// Returns the horizontal length of the axle's direction, which is the sine of the tilt.
    pub fn level(&self) -> f64 {
        libm::hypot(self.axle.x, self.axle.y)
    }

    /// Returns the azimuth from here to `other`, rad, in (−π, π].
    pub fn azimuth_to(&self, other: &Self) -> f64 {
        let (a, b) = (&self.axle, &other.axle);
        libm::atan2(a.x * b.y - a.y * b.x, a.x * b.x + a.y * b.y)
    }

    /// Returns the motion `time_s` later (earlier if negative).
    pub fn after(mut self, time_s: f64, pull: &Vector3<f64>) -> Self {
        let mut left = time_s;
        for _ in 0..MOST_SERIES_STEPS {
            let (axle, momentum, radius) = self.series(pull);
            let step = left.clamp(-radius, radius);
            self = Self {
                axle: sum(&axle, step),
                momentum: sum(&momentum, step),
            };
            left -= step;
            if left == 0.0 {
                break;
            }
        }
        self
    }

    /// Returns the series of axle and momentum, and the time for which they are accurate, s.
    fn series(&self, pull: &Vector3<f64>) -> (PowerSeries, PowerSeries, f64) {
        let zeros = [Vector3::zeros(); EQUATION_ORDER + 1];
        let (mut axle, mut momentum) = (zeros, zeros);
        (axle[0], momentum[0]) = (self.axle, self.momentum);
        for k in 0..EQUATION_ORDER {
            let next = (k + 1) as f64;
            let turning = (0..=k).map(|i| momentum[i].cross(&axle[k - i]));
            axle[k + 1] = turning.sum::<Vector3<f64>>() / next;
            momentum[k + 1] = axle[k].cross(pull) / next;
        }
        let [before_last, last] = [EQUATION_ORDER - 1, EQUATION_ORDER]
            .map(|k| libm::pow(EQUATION_LAST_TERM / axle[k].norm(), 1.0 / k as f64));
        (axle, momentum, before_last.min(last))
    }
}

/// Returns the sum of the series `terms` after the time `step`, s.
fn sum(terms: &PowerSeries, step: f64) -> Vector3<f64> {
    let rest = terms[1..].iter().rev();
    terms[0] + rest.fold(Vector3::zeros(), |sum, term| (sum + term) * step)
}

/// Cubic interpolation of the axle between two rows, from its directions and their rates at both.
struct Interpolation {
    ends: [Vector3<f64>; 2],
    /// Rates times the time between the rows.
    displacements: [Vector3<f64>; 2],
    step_s: f64,
}

impl Interpolation {
    pub fn between(from: &TopMotion, to: &TopMotion, step_s: f64) -> Self {
        Self {
            ends: [from.axle, to.axle],
            displacements: [from, to].map(|swing| swing.momentum.cross(&swing.axle) * step_s),
            step_s,
        }
    }

    /// Returns the time after the first row at which the height has an extreme, s: a root of a quadratic.
    pub fn time_of_turn(&self, is_top: bool) -> f64 {
        let [begin, end] = self.displacements.map(|change| change.z);
        let rise = self.ends[1].z - self.ends[0].z;
        let (square, linear) = (
            3.0 * (begin + end) - 6.0 * rise,
            6.0 * rise - 4.0 * begin - 2.0 * end,
        );
        // Of the two roots, take the extreme of the right kind: linear + 2 square t is negative at a top.
        let root = (linear * linear - 4.0 * square * begin).max(0.0).sqrt();
        let signed = if is_top { -root } else { root };
        let share = if linear * signed > 0.0 {
            -2.0 * begin / (linear + signed)
        } else {
            (signed - linear) / (2.0 * square)
        };
        share.clamp(0.0, 1.0) * self.step_s
    }

    pub fn at(&self, time_s: f64) -> TopMotion {
        let t = time_s / self.step_s;
        let [from, to] = self.ends;
        let [begin, end] = self.displacements;
        let rise = to - from;
        let axle = from
            + t * (begin + t * ((3.0 * rise - 2.0 * begin - end) + t * (begin + end - 2.0 * rise)));
        TopMotion {
            axle,
            momentum: Vector3::zeros(),
        }
    }
}

/// Equations of motion of one symmetric top, and the time step between its rows.
#[derive(Clone, Debug)]
pub(super) struct Equations {
    /// Load over the moment of inertia across the axle, 1/s².
    pub pull: Vector3<f64>,
    /// Time from one row to the next, s.
    pub time_step_s: f64,
    /// Rates of the motion, rad/s: the body's and the axle's.
    pub rates: [f64; 2],
}

impl Equations {
    /// Returns the time after `row` at which the motion reaches its highest point (its lowest if not `is_top`), s, and
    /// the motion there. The time lies between `low` and `high`.
    fn time_of_turn(
        &self,
        row: &TopMotion,
        is_top: bool,
        guess: f64,
        [mut low, mut high]: [f64; 2],
    ) -> (f64, TopMotion) {
        let mut time = guess.clamp(low, high);
        let mut swing = row.after(time, &self.pull);
        for _ in 0..16 {
            let (climb, bend) = (swing.climb(), swing.bend(&self.pull));
            if (climb > 0.0) == is_top {
                low = time;
            } else {
                high = time;
            }
            let next = time - climb / bend;
            let next = if next >= low && next <= high {
                next
            } else {
                0.5 * (low + high)
            };
            let is_found = (next - time).abs() <= f64::EPSILON * self.time_step_s;
            if !next.is_finite() {
                break;
            }
            (time, swing) = (next, row.after(next, &self.pull));
            if is_found {
                break;
            }
        }
        (time, swing)
    }

    /// Returns the turning point by interpolation, with its difference from the turning point by the equations of
    /// motion.
    pub fn turn(&self, crossing: &Crossing) -> HeightExtreme {
        let (before, step, is_top) = (crossing.before, self.time_step_s, crossing.is_top);
        let from = before.swing;
        // Solve the equations of motion from the row before the turning point, and from the row after it.
        let (guess, range) = match crossing.after {
            None => (0.0, [-AT_TURN * step, AT_TURN * step]),
            Some(after) => {
                let climb = from.climb();
                (climb / (climb - after.swing.climb()) * step, [0.0, step])
            }
        };
        let (time, swing) = self.time_of_turn(&from, is_top, guess, range);
        let (mut apart_s, mut apart) = (0.0, 0.0);
        let (mut off_s, mut off) = (0.0, 0.0);
        if let Some(after) = crossing.after {
            let to = after.swing;
            let (late, other) = self.time_of_turn(&to, is_top, time - step, [-step, 0.0]);
            (apart_s, apart) = (late + step - time, swing.azimuth_to(&other));
            let seen = Interpolation::between(&from, &to, step);
            let at = seen.time_of_turn(is_top);
            (off_s, off) = (at - time, swing.azimuth_to(&seen.at(at)));
        }
        let change = self.azimuth_change(&from, time);
        let (bend, level) = (swing.bend(&self.pull), swing.level());
        let time_s = before.time_s + time + off_s;
        let rounding_s = f64::EPSILON * (self.rates[1] / bend.abs() + time_s.abs());
        let rounding = f64::EPSILON * (1.0 / level + self.rates[1] * time_s);
        HeightExtreme {
            time_s,
            time_off_s: off_s,
            time_error_s: libm::hypot(rounding_s, 0.5 * apart_s),
            azimuth: before.azimuth_rad() + TAU * crossing.missed as f64 + change + off,
            azimuth_off: off,
            azimuth_error: libm::hypot(rounding, 0.5 * apart),
            azimuth_rate: swing.azimuth_rate(),
            level,
            phase: 0.0, // a symmetric body does not depend on it
        }
    }

    /// Returns the change of azimuth in the time `time_s` after `from`, rad, with all full turns.
    fn azimuth_change(&self, from: &TopMotion, time_s: f64) -> f64 {
        let mut at = *from;
        let pieces = (4.0 * self.rates[1] * time_s.abs()).ceil().max(1.0);
        let mut change = 0.0;
        for _ in 0..pieces as u32 {
            let next = at.after(time_s / pieces, &self.pull);
            change += at.azimuth_to(&next);
            at = next;
        }
        change
    }

    /// Returns the full turns of the azimuth from the row `before` to the next one, `now`, that the azimuths of the
    /// rows do not show.
    #[cold]
    pub fn missed_turns(&self, before: &StepEquation, now: &StepEquation) -> i64 {
        let (from, to) = (before.swing, now.swing);
        let (begin, end) = (from.climb(), to.climb());
        // Near the vertical the azimuth turns fast where the tilt turns back, so no interval crosses that point.
        let turn = if (begin > 0.0) != (end > 0.0) {
            let guess = begin / (begin - end) * self.time_step_s;
            self.time_of_turn(&from, begin > 0.0, guess, [0.0, self.time_step_s])
        } else {
            (0.0, from)
        };
        let rest = self.time_step_s - turn.0;
        let arrived = turn.1.after(rest, &self.pull);
        let change = self.azimuth_change(&from, turn.0)
            + self.azimuth_change(&turn.1, rest)
            + arrived.azimuth_to(&to);
        let seen = from.azimuth_to(&to);
        ((change - seen) / TAU).round() as i64
    }
}

/// The axle after a time step.
#[derive(Clone, Copy, Debug)]
pub(super) struct StepEquation {
    pub time_s: f64,
    /// Direction and motion of the axle.
    pub swing: TopMotion,
    pub azimuth: Azimuth,
}

impl StepEquation {
    /// Returns the row after `step`. `per_across` is one over the moment of inertia across the axle, 1/(kg m²).
    #[inline]
    pub fn from_step(step: &Step, per_across: f64) -> Self {
        let state = step.after();
        Self {
            time_s: state.time_s,
            swing: TopMotion {
                axle: state.axle(),
                momentum: state.momentum * per_across,
            },
            azimuth: *step.azimuth(),
        }
    }

    /// Returns the azimuth, rad, with all full turns.
    pub fn azimuth_rad(&self) -> f64 {
        self.azimuth.degrees().to_radians()
    }
}

/// Two rows with a turning point between them, or a start at a turning point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Crossing {
    pub before: StepEquation,
    /// The row after the turning point. `None` if the run starts at it.
    pub after: Option<StepEquation>,
    /// Full turns of the azimuth that the rows up to `before` do not show.
    pub missed: i64,
    /// True if the axle is highest there, false if it is lowest.
    pub is_top: bool,
}

impl Crossing {
    /// Returns the height of the row nearer to the turning point.
    pub fn height(&self) -> f64 {
        let [a, b] = [self.before, self.after.unwrap_or(self.before)].map(|row| row.swing.axle.z);
        if self.is_top { a.max(b) } else { a.min(b) }
    }
}
