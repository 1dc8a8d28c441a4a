//! The equations of motion of a symmetric top between two rows of its run.

use super::AT_TURN;
use crate::analysis::swing::{Interpolation, Swing};
use crate::analysis::turns::Turn;
use crate::physics::observables::Azimuth;
use crate::run::Step;
use nalgebra::Vector3;
use std::f64::consts::TAU;

/// The equations of motion of one such top, and the time step between its rows.
#[derive(Clone, Debug)]
pub(super) struct Equations {
    /// The load over the moment across the axle, 1/s².
    pub pull: Vector3<f64>,
    /// Time from one row to the next, s.
    pub time_step_s: f64,
    /// Rates that the motion is made of, rad/s: of the body, and of the axle.
    pub rates: [f64; 2],
}

impl Equations {
    /// When the motion from `row` on comes to its highest point (else its lowest), s from it, between `low` and `high`.
    fn time_of_turn(
        &self,
        row: &Swing,
        is_top: bool,
        guess: f64,
        [mut low, mut high]: [f64; 2],
    ) -> (f64, Swing) {
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

    /// The turning point by interpolation, and how far it is off the one by the equations of motion.
    pub fn turn(&self, crossing: &Crossing) -> Turn {
        let (before, step, is_top) = (crossing.before, self.time_step_s, crossing.is_top);
        let from = before.swing;
        // The equations of motion from the row before it, and from the one after it.
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
        let way = self.way(&from, time);
        let (bend, level) = (swing.bend(&self.pull), swing.level());
        let time_s = before.time_s + time + off_s;
        let rounding_s = f64::EPSILON * (self.rates[1] / bend.abs() + time_s.abs());
        let rounding = f64::EPSILON * (1.0 / level + self.rates[1] * time_s);
        Turn {
            time_s,
            time_off_s: off_s,
            time_error_s: rounding_s.hypot(0.5 * apart_s),
            azimuth: before.azimuth_rad() + TAU * crossing.missed as f64 + way + off,
            azimuth_off: off,
            azimuth_error: rounding.hypot(0.5 * apart),
            azimuth_rate: swing.azimuth_rate(),
            level,
        }
    }

    /// The azimuth's way in `time_s` from `from` on, rad.
    fn way(&self, from: &Swing, time_s: f64) -> f64 {
        let mut at = *from;
        let pieces = (4.0 * self.rates[1] * time_s.abs()).ceil().max(1.0);
        let mut way = 0.0;
        for _ in 0..pieces as u32 {
            let next = at.after(time_s / pieces, &self.pull);
            way += at.azimuth_to(&next);
            at = next;
        }
        way
    }

    /// The full turns of the azimuth from the row `before` to the next one, `now`, that their azimuths do not show.
    #[cold]
    pub fn missed_turns(&self, before: &Row, now: &Row) -> i64 {
        let (from, to) = (before.swing, now.swing);
        let (begin, end) = (from.climb(), to.climb());
        // Near the vertical it turns fast where the tilt turns back: no piece of the way leads past that point.
        let turn = if (begin > 0.0) != (end > 0.0) {
            let guess = begin / (begin - end) * self.time_step_s;
            self.time_of_turn(&from, begin > 0.0, guess, [0.0, self.time_step_s])
        } else {
            (0.0, from)
        };
        let rest = self.time_step_s - turn.0;
        let arrived = turn.1.after(rest, &self.pull);
        let way = self.way(&from, turn.0) + self.way(&turn.1, rest) + arrived.azimuth_to(&to);
        let seen = from.azimuth_to(&to);
        ((way - seen) / TAU).round() as i64
    }
}

/// What is known of the axle after a time step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Row {
    pub time_s: f64,
    /// Where the axle is, and how it moves.
    pub swing: Swing,
    pub azimuth: Azimuth,
}

impl Row {
    /// The row after `step`; `per_across` is one over the moment across the axle, 1/(kg m²).
    #[inline]
    pub fn of(step: &Step, per_across: f64) -> Self {
        let state = step.after();
        Self {
            time_s: state.time_s,
            swing: Swing {
                axle: state.axle(),
                momentum: state.momentum * per_across,
            },
            azimuth: *step.azimuth(),
        }
    }

    /// The azimuth, rad, with all full turns.
    pub fn azimuth_rad(&self) -> f64 {
        self.azimuth.degrees().to_radians()
    }
}

/// Two rows with a turning point between them, or a start that stands at one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Crossing {
    pub before: Row,
    /// The row after it; `None` at a start that stands there.
    pub after: Option<Row>,
    /// Full turns of the azimuth that the rows up to `before` miss.
    pub missed: i64,
    /// Whether the axle is highest there, and not lowest.
    pub is_top: bool,
}

impl Crossing {
    /// The height of the row nearer to the turning point.
    pub fn height(&self) -> f64 {
        let [a, b] = [self.before, self.after.unwrap_or(self.before)].map(|row| row.swing.axle.z);
        if self.is_top { a.max(b) } else { a.min(b) }
    }
}
