//! Measures a symmetric top whose time steps are short enough to follow it, by finding its turning points between the
//! rows.

use super::equations::{AT_TURN, Crossing, Equations, StepEquation, TopMotion};
use super::turns::{HEIGHT_SWING_ROUNDING, MeasuredNumber, StraightLine, Turns, WithoutNutation};
use crate::physics::{LagrangeTop, SchemeInfo, SymmetricTop};
use crate::run::Step;
use nalgebra::Vector3;
use std::f64::consts::{PI, TAU};

/// Minimum swing of the height in a nutation, as a fraction of the squared sine of the tilt.
const STEADY: f64 = 1e-9;
/// Swings of the height below this cannot be distinguished from rounding.
const LEAST_SWING: f64 = 1e-14;
/// Angle from the vertical below which the azimuth of an axle is undefined, rad.
const NO_AZIMUTH_RAD: f64 = 1e-7;
/// Maximum turn of the body or its axle per time step, up to which schemes of finite order are followed between rows,
/// rad.
const FOLLOWED_RAD: f64 = 1.0;
/// Rotation of the axle per time step, rad, above which the step may hide a whole turn of the azimuth although its rows
/// are close together. Near the vertical, the azimuth turns by half a turn in an instant.
const HIDES_RAD: f64 = 1.5;
/// Maximum turn of an axle between two rows, rad. A faster one is not followed.
const MOST_TURN_RAD: f64 = 60.0;

/// Minimum ratio of the rate at which a nutation moves the height to the error of a first-order scheme in that rate.
/// Below it, the turning points are not where the rate changes its sign.
const BEYOND_ERROR: f64 = 2.0;

#[derive(Clone, Debug)]
pub struct TurningPoints {
    /// One over the moment of inertia across the axle, 1/(kg m²).
    per_across: f64,
    equations: Equations,
    /// Order of the scheme. `None` if the scheme is exact.
    order: Option<u32>,
    /// True if the change of azimuth must be followed in every time step.
    may_turn_far: bool,
    /// Range of the axle's height predicted from the start, if it is too small to be a swing.
    steady_swing: Option<f64>,
    /// Distance from a turning point at which the turning point is confirmed.
    confirmed_by: f64,
    start: StepEquation,
    now: StepEquation,
    /// Full turns of the azimuth that the rows do not show.
    missed: i64,
    is_rising: bool,
    heights: [f64; 2],
    candidate: Option<Crossing>,
    last: Option<(u64, Crossing)>,
    count: u64,
    turns: Turns,
    least_level: f64,
}

impl TurningPoints {
    /// Creates instruments for a run that begins at `step`. `None` if its rows do not show the motion between them.
    pub fn new(step: &Step) -> Option<Self> {
        let body = &step.scenario().body.mechanics;
        let top = SymmetricTop::from_body(body)?;
        let load = step.loads().on_axle(body, &top)?;
        // The equations of motion used here hold for a body without friction.
        if !step.loads().friction.is_none() || libm::hypot(load.x, load.y) > 1e-12 * load.z.abs() {
            return None;
        }
        let per_across = 1.0 / top.across;
        let (start, motion) = (StepEquation::from_step(step, per_across), step.motion());
        let (swing, pull) = (start.swing, load * per_across);
        let axle_rate = swing.momentum.norm() + pull.norm().sqrt();
        let equations = Equations {
            pull,
            time_step_s: motion.time_step_s,
            rates: [step.angular_velocity().norm(), axle_rate],
        };
        let (period_s, range) = swing_of_height(step, &top, load, &swing);
        if !is_followed(motion.scheme, &equations, &swing, period_s, range) {
            return None;
        }
        let is_steady = range < (STEADY * swing.level().powi(2)).max(LEAST_SWING);
        let confirmed_by = if is_steady { 1.0 } else { 1e-3 * range }.min(HEIGHT_SWING_ROUNDING);
        let (climb, bend) = (swing.climb(), swing.bend(&pull));
        let starts_at_turn = !is_steady && climb.abs() <= AT_TURN * motion.time_step_s * bend.abs();
        let is_rising = if starts_at_turn { bend } else { climb } > 0.0;
        Some(Self {
            per_across,
            equations,
            may_turn_far: axle_rate * motion.time_step_s > HIDES_RAD,
            order: motion.scheme.order,
            steady_swing: is_steady.then_some(range),
            confirmed_by,
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

    #[inline]
    pub fn record(&mut self, step: &Step) {
        // Assigned directly. A copy would be stored in parts and read as a whole, which stalls processors.
        let before = self.now;
        self.now = StepEquation::from_step(step, self.per_across);
        let (a, b) = (&before.swing.axle, &self.now.swing.axle);
        let missed = self.missed;
        if self.may_turn_far || a.x * b.x + a.y * b.y < 0.0 {
            self.missed += self.equations.missed_turns(&before, &self.now);
        }
        self.heights = [self.heights[0].min(b.z), self.heights[1].max(b.z)];
        self.confirm();
        let climb = self.now.swing.climb();
        if climb != 0.0 && (climb > 0.0) != self.is_rising {
            let is_top = self.is_rising;
            self.is_rising = !is_top;
            self.candidate = Some(Crossing {
                before,
                after: Some(self.now),
                missed,
                is_top,
            });
            self.confirm();
        }
    }

    /// Counts the candidate once the axle has moved away from it by more than rounding. A turning point of the same
    /// kind as the last one is rounding.
    fn confirm(&mut self) {
        let Some(candidate) = &self.candidate else {
            return;
        };
        let away = candidate.height() - self.now.swing.axle.z;
        let away = if candidate.is_top { away } else { -away };
        if away <= self.confirmed_by {
            return;
        }
        let Some(confirmed) = self.candidate.take() else {
            return;
        };
        if self
            .last
            .is_some_and(|(_, last)| last.is_top == confirmed.is_top)
        {
            return;
        }
        if self.turns.wants(self.count) {
            let turn = self.equations.turn(&confirmed);
            self.least_level = self.least_level.min(turn.level);
            self.turns.keep(self.count, turn);
        }
        self.last = Some((self.count, confirmed));
        self.count += 1;
    }

    fn line(&self) -> Option<StraightLine> {
        let (number, crossing) = self.last.as_ref()?;
        self.turns.line_to(*number, self.equations.turn(crossing))
    }

    /// Returns the possible effect of a scheme's error on a single turning point, s. If the scheme lets the tilt drift,
    /// highest points come late and lowest ones early. Half nutations then differ in length from half the length of
    /// whole ones.
    fn lag_s(&self, line: &StraightLine) -> f64 {
        if line.between >= 3 || self.order.is_none() {
            return 0.0; // their scatter shows it
        }
        if self.order == Some(1) {
            return 0.5 * self.equations.time_step_s;
        }
        if line.intervals.is_multiple_of(2) {
            return 0.0;
        }
        // The error of a step is known for the rate of the height. The drift of the height is larger by this factor.
        let of_ends = libm::hypot(line.first.time_error_s, line.last.time_error_s);
        of_ends / (self.equations.rates[1] * self.equations.time_step_s)
    }

    pub fn nutation_period_s(&self) -> Result<MeasuredNumber, WithoutNutation> {
        let line = self.line().ok_or(match self.steady_swing {
            Some(_) => WithoutNutation::Steady,
            None => WithoutNutation::TooFew,
        })?;
        let of_one = 2.0 / line.intervals as f64;
        let value = line.time_s() * of_one;
        let error = libm::hypot(line.time_error_s(1.0), self.lag_s(&line)) * of_one;
        Ok(MeasuredNumber {
            value,
            uncertainty: libm::hypot(error, f64::EPSILON * value),
            nutations: line.intervals.div_ceil(2),
        })
    }

    pub fn precession_rad_per_s(&self) -> Option<MeasuredNumber> {
        if self.least_level < NO_AZIMUTH_RAD {
            return None;
        }
        let of_rates = f64::EPSILON * (self.equations.rates[0] + self.equations.rates[1]);
        let Some(line) = self.line() else {
            return self.steady_precession(of_rates);
        };
        let value = line.rate();
        let lag = (line.last.azimuth_rate - value) * self.lag_s(&line) / line.time_s();
        Some(MeasuredNumber {
            value,
            uncertainty: libm::hypot(libm::hypot(line.rate_error(1.0), lag), of_rates),
            nutations: line.intervals.div_ceil(2),
        })
    }

    /// Returns the whole change of azimuth over the time, for an axle that keeps its height.
    fn steady_precession(&self, of_rates: f64) -> Option<MeasuredNumber> {
        let [lowest, highest] = self.heights;
        let swing = self.steady_swing?.max(highest - lowest);
        let time = self.now.time_s - self.start.time_s;
        let (now, start) = (self.now.azimuth_rad(), self.start.azimuth_rad());
        let value = (now - start + TAU * self.missed as f64) / time;
        if swing > HEIGHT_SWING_ROUNDING || !value.is_finite() {
            return None;
        }
        let TopMotion { axle, momentum } = self.start.swing;
        let (level, along) = (self.start.swing.level().powi(2), momentum.dot(&axle));
        // The azimuth's rate is (l_z - l3 u)/(1 - u²) at the height u.
        let by_height = (2.0 * axle.z * (momentum.z - along * axle.z) / level - along) / level;
        let of_ends = f64::EPSILON * (1.0 / level.sqrt() / time + self.equations.rates[1]);
        let of_swing = 0.25 * by_height * swing;
        Some(MeasuredNumber {
            value,
            uncertainty: libm::hypot(libm::hypot(of_rates, of_ends), of_swing),
            nutations: 0,
        })
    }
}

/// Returns the period of the axle's height after `step`, s, and the maximum height minus the minimum. The height swings
/// by nutation or, for a free top, because the axle turns about L.
fn swing_of_height(
    step: &Step,
    top: &SymmetricTop,
    load: Vector3<f64>,
    swing: &TopMotion,
) -> (f64, f64) {
    let length = swing.momentum.norm();
    let (period_s, range) = if (load * (1.0 / top.across)).norm() == 0.0 {
        let along = swing.momentum / length;
        let range = 2.0 * along.cross(&swing.axle).norm() * libm::hypot(along.x, along.y);
        (TAU / length, range)
    } else {
        let state = step.after();
        let (across, along) = (top.across, top.along);
        let exact = LagrangeTop::new(across, along, load, state.orientation, state.momentum);
        let (low, high) = exact.tilt_range();
        let range = 2.0 * libm::sin(0.5 * (high + low)) * libm::sin(0.5 * (high - low));
        (exact.nutation_period().unwrap_or(f64::INFINITY), range)
    };
    (period_s, if range.is_finite() { range } else { 0.0 })
}

/// Returns true if the time step is short enough for the equations of motion to follow the results of `scheme` from row
/// to row. The height swings by `range` in `period_s`, and begins with the motion `swing`.
fn is_followed(
    scheme: &SchemeInfo,
    equations: &Equations,
    swing: &TopMotion,
    period_s: f64,
    range: f64,
) -> bool {
    let rate_error = 0.5 * equations.time_step_s * equations.pull.norm() * swing.level();
    let is_lost = scheme.order == Some(1) && range * PI / period_s < BEYOND_ERROR * rate_error;
    if is_lost || 2.0 * equations.time_step_s >= period_s {
        return false;
    }
    let [spin, axle_rate] = equations.rates.map(|rate| rate * equations.time_step_s);
    match (scheme.order, scheme.turns_exactly) {
        (None, _) => axle_rate < MOST_TURN_RAD,
        (Some(_), true) => axle_rate < FOLLOWED_RAD,
        (Some(_), false) => spin.max(axle_rate) < FOLLOWED_RAD,
    }
}
