//! A symmetric top whose time steps are short enough to follow it: its turning points, found between the rows.

use super::swing::{Interpolation, Swing};
use super::turns::{Measured, ROUNDING, StraightLine, Turn, Turns};
use crate::physics::observables::Azimuth;
use crate::physics::{LagrangeTop, SymmetricTop};
use crate::run::Step;
use nalgebra::Vector3;
use std::f64::consts::{PI, TAU};

/// A swing of the height below this part of the squared sine of the tilt is no nutation.
const STEADY: f64 = 1e-9;
/// No swing of the height is told from rounding below this.
const LEAST_SWING: f64 = 1e-14;
/// An axle that comes nearer to the vertical than this (rad) has no azimuth to speak of.
const PASSES_RAD: f64 = 1e-7;
/// Schemes of a finite order are followed between their rows while the body or its axle turns by less than this (rad).
const FOLLOWED_RAD: f64 = 1.0;
/// A run that starts within this part of a time step of a turning point starts at it.
const AT_TURN: f64 = 1e-6;
/// Roundings in the rates of a run's own motion, in the time and in the azimuth of one turning point.
const ROUNDINGS: [f64; 3] = [1.0, 1.0, 1.0];
/// A time step in which the axle may turn by more than this (rad), and by half a turn as it passes the vertical, may hide
/// a whole turn of the azimuth though its rows are near to one another.
const HIDES_RAD: f64 = 1.5;
/// Axles that turn by more than this between two rows (rad) are not followed.
const TOO_FAR_RAD: f64 = 60.0;

/// The turning points of a nutation that moves the height no faster than so many times the error that a scheme of the first
/// order has in that rate are not where the rate changes its sign.
const BEYOND_ERROR: f64 = 2.0;

/// The instruments for one such top.
#[derive(Clone, Debug)]
pub(super) struct Between {
    /// One over the moment across the axle, 1/(kg m²).
    per_across: f64,
    /// The load over that moment, 1/s².
    pull: Vector3<f64>,
    time_step_s: f64,
    /// Rates that the motion is made of, rad/s: of the body, and of the axle.
    rates: [f64; 2],
    is_first_order: bool,
    is_exact: bool,
    /// Whether the azimuth's way has to be followed in every time step.
    may_turn_far: bool,
    /// The least and greatest height of the axle that the start leads to; `None` where it swings.
    steady_swing: Option<f64>,
    /// The axle must have gone so far from a turning point to confirm it.
    confirmed_by: f64,
    start: Row,
    now: Row,
    /// Full turns of the azimuth that the rows miss.
    missed: i64,
    is_rising: bool,
    heights: [f64; 2],
    candidate: Option<Crossing>,
    last: Option<(u64, Crossing)>,
    count: u64,
    turns: Turns,
    least_level: f64,
}

#[derive(Clone, Copy, Debug)]
struct Row {
    time_s: f64,
    swing: Swing,
    azimuth: Azimuth,
}

/// Two rows with a turning point between them, or a start that stands at one.
#[derive(Clone, Copy, Debug)]
struct Crossing {
    before: Row,
    after: Option<Row>,
    missed: i64,
    is_top: bool,
}

impl Crossing {
    /// The height of the row nearer to the turning point.
    fn height(&self) -> f64 {
        let [a, b] = [self.before, self.after.unwrap_or(self.before)].map(|row| row.swing.axle.z);
        match self.is_top {
            true => a.max(b),
            false => a.min(b),
        }
    }
}

impl Between {
    /// Instruments for the run that begins at `step`; `None` where its rows do not show the motion between them.
    pub fn new(step: &Step) -> Option<Self> {
        let body = &step.scenario().body.mechanics;
        let top = SymmetricTop::of(body)?;
        let load = step.loads().on_axle(body, &top)?;
        // The equations of motion that are used here are those of a body without friction.
        if !step.loads().friction.is_none() || load.x.hypot(load.y) > 1e-12 * load.z.abs() {
            return None;
        }
        let (state, motion) = (step.after(), step.motion());
        let per_across = 1.0 / top.across;
        let start = Row::of(step, per_across);
        let pull = load * per_across;
        let (swing, length) = (start.swing, start.swing.momentum.norm());
        let exact = LagrangeTop::new(
            top.across,
            top.along,
            load,
            state.orientation,
            state.momentum,
        );
        let spin = step.angular_velocity().norm();
        let axle_rate = length + pull.norm().sqrt();
        let is_followed = match (motion.scheme.order, motion.scheme.turns_exactly) {
            (None, _) => axle_rate * motion.time_step_s < TOO_FAR_RAD,
            (Some(_), true) => axle_rate * motion.time_step_s < FOLLOWED_RAD,
            (Some(_), false) => spin.max(axle_rate) * motion.time_step_s < FOLLOWED_RAD,
        };
        let is_free = pull.norm() == 0.0;
        let period = match is_free {
            true => TAU / length,
            false => exact.nutation_period().unwrap_or(f64::INFINITY),
        };
        if !is_followed || 2.0 * motion.time_step_s >= period {
            return None;
        }
        let range = match is_free {
            true => {
                let along = swing.momentum / length;
                2.0 * along.cross(&swing.axle).norm() * along.x.hypot(along.y)
            }
            false => {
                let (low, high) = exact.tilt_range();
                2.0 * (0.5 * (high + low)).sin() * (0.5 * (high - low)).sin()
            }
        };
        let range = if range.is_finite() { range } else { 0.0 };
        let rate_error = 0.5 * motion.time_step_s * pull.norm() * swing.level();
        if motion.scheme.order == Some(1) && range * PI / period < BEYOND_ERROR * rate_error {
            return None;
        }
        let is_steady = range < (STEADY * swing.level().powi(2)).max(LEAST_SWING);
        let (climb, bend) = (swing.climb(), swing.bend(&pull));
        let starts_at_turn = !is_steady && climb.abs() <= AT_TURN * motion.time_step_s * bend.abs();
        let is_rising = if starts_at_turn {
            bend > 0.0
        } else {
            climb > 0.0
        };
        Some(Self {
            per_across,
            pull,
            time_step_s: motion.time_step_s,
            rates: [spin, axle_rate],
            may_turn_far: axle_rate * motion.time_step_s > HIDES_RAD,
            is_first_order: motion.scheme.order == Some(1),
            is_exact: motion.scheme.order.is_none(),
            steady_swing: is_steady.then_some(range),
            confirmed_by: match is_steady {
                true => ROUNDING,
                false => (1e-3 * range).min(ROUNDING),
            },
            start,
            now: start,
            missed: 0,
            is_rising,
            heights: [swing.axle.z; 2],
            candidate: starts_at_turn.then_some(Crossing {
                before: start,
                after: None,
                missed: 0,
                is_top: !is_rising,
            }),
            last: None,
            count: 0,
            turns: Turns::new(),
            least_level: swing.level(),
        })
    }

    /// Takes in `step`.
    #[inline]
    pub fn follow(&mut self, step: &Step) {
        let before = self.now;
        let now = Row::of(step, self.per_across);
        self.now = now;
        let (a, b) = (&before.swing.axle, &now.swing.axle);
        let missed = self.missed;
        if self.may_turn_far || a.x * b.x + a.y * b.y < 0.0 {
            self.count_missed_turns(&before);
        }
        self.heights = [self.heights[0].min(b.z), self.heights[1].max(b.z)];
        self.confirm();
        let climb = now.swing.climb();
        if climb != 0.0 && (climb > 0.0) != self.is_rising {
            let is_top = self.is_rising;
            self.is_rising = !is_top;
            self.candidate = Some(Crossing {
                before,
                after: Some(now),
                missed,
                is_top,
            });
            self.confirm();
        }
    }

    /// Counts the candidate once the axle has truly gone away from it. A turning point of the same kind as the last is
    /// rounding.
    fn confirm(&mut self) {
        let Some(candidate) = self.candidate else {
            return;
        };
        let away = candidate.height() - self.now.swing.axle.z;
        let away = if candidate.is_top { away } else { -away };
        if away <= self.confirmed_by {
            return;
        }
        self.candidate = None;
        if self
            .last
            .is_some_and(|(_, last)| last.is_top == candidate.is_top)
        {
            return;
        }
        if self.turns.wants(self.count) {
            let turn = self.turn(&candidate);
            self.least_level = self.least_level.min(turn.level);
            self.turns.keep(self.count, turn);
        }
        self.last = Some((self.count, candidate));
        self.count += 1;
    }

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
            match (climb > 0.0) == is_top {
                true => low = time,
                false => high = time,
            }
            let next = time - climb / bend;
            let next = match next >= low && next <= high {
                true => next,
                false => 0.5 * (low + high),
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
    fn turn(&self, crossing: &Crossing) -> Turn {
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
        let [_, of_time, of_azimuth] = ROUNDINGS.map(|n| n * f64::EPSILON);
        let rounding_s = of_time * (self.rates[1] / bend.abs() + time_s.abs());
        let rounding = of_azimuth * (1.0 / level + self.rates[1] * time_s);
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

    /// Whether the azimuth has turned by more than half a turn since `before`, where its change seems to be less.
    #[cold]
    fn count_missed_turns(&mut self, before: &Row) {
        let (from, to) = (before.swing, self.now.swing);
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
        self.missed += ((way - seen) / TAU).round() as i64;
    }

    fn line(&self) -> Option<StraightLine> {
        let (number, crossing) = self.last.as_ref()?;
        self.turns.line_to(*number, self.turn(crossing))
    }

    /// What the error of a scheme may do to a single turning point, s. Where the scheme lets the tilt drift, highest points
    /// come late and lowest ones early, so that half nutations have another length than whole ones have halves.
    fn lag_s(&self, line: &StraightLine) -> f64 {
        if line.between >= 3 || self.is_exact {
            return 0.0; // more of them show it
        }
        if self.is_first_order {
            return 0.5 * self.time_step_s;
        }
        if line.intervals.is_multiple_of(2) {
            return 0.0;
        }
        // The error of a step is known in the rate of the height; the drift is that of the height, by so many times more.
        let of_ends = line.first.time_error_s.hypot(line.last.time_error_s);
        of_ends / (self.rates[1] * self.time_step_s)
    }

    pub fn nutation_period_s(&self) -> Option<Measured> {
        let line = self.line()?;
        let of_one = 2.0 / line.intervals as f64;
        let value = line.time_s() * of_one;
        let error = line.time_error_s(1.0).hypot(self.lag_s(&line)) * of_one;
        Some(Measured {
            value,
            uncertainty: error.hypot(ROUNDINGS[0] * f64::EPSILON * value),
            nutations: line.intervals.div_ceil(2),
        })
    }

    pub fn precession_rad_per_s(&self) -> Option<Measured> {
        if self.least_level < PASSES_RAD {
            return None;
        }
        let of_rates = ROUNDINGS[0] * f64::EPSILON * (self.rates[0] + self.rates[1]);
        let Some(line) = self.line() else {
            return self.steady_precession(of_rates);
        };
        let value = line.rate();
        let lag = (line.last.azimuth_rate - value) * self.lag_s(&line) / line.time_s();
        Some(Measured {
            value,
            uncertainty: line.rate_error(1.0).hypot(lag).hypot(of_rates),
            nutations: line.intervals.div_ceil(2),
        })
    }

    /// The whole way of the azimuth over the time, for an axle that keeps its height.
    fn steady_precession(&self, of_rates: f64) -> Option<Measured> {
        let [lowest, highest] = self.heights;
        let swing = self.steady_swing?.max(highest - lowest);
        let time = self.now.time_s - self.start.time_s;
        let (now, start) = (self.now.azimuth_rad(), self.start.azimuth_rad());
        let value = (now - start + TAU * self.missed as f64) / time;
        if swing > ROUNDING || !value.is_finite() {
            return None;
        }
        let Swing { axle, momentum } = self.start.swing;
        let (level, along) = (self.start.swing.level().powi(2), momentum.dot(&axle));
        // The azimuth's rate is (l_z - l3 u)/(1 - u²) at the height u.
        let by_height = (2.0 * axle.z * (momentum.z - along * axle.z) / level - along) / level;
        let of_ends = ROUNDINGS[2] * f64::EPSILON * (1.0 / level.sqrt() / time + self.rates[1]);
        let of_swing = 0.25 * by_height * swing;
        Some(Measured {
            value,
            uncertainty: of_rates.hypot(of_ends).hypot(of_swing),
            nutations: 0,
        })
    }
}

impl Row {
    fn of(step: &Step, per_across: f64) -> Self {
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

    fn azimuth_rad(&self) -> f64 {
        self.azimuth.degrees().to_radians()
    }
}
