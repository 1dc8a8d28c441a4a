//! What a run did, measured on its steps as they come: precession and nutation, each with its uncertainty.
//!
//! Method. The axle's tilt turns back once in every nutation. Where it is least, a parabola through three steps gives
//! time and azimuth of the turning point. Nutation is the mean time from one such point to the next, precession the
//! change of azimuth from the first to the last over the time between them; the uncertainty is the standard error of
//! the single nutations, or one time step where there was only one, with what the parabola may be off by. A run without
//! nutation has its precession from the whole way of the azimuth, with the difference between the rates of the whole and
//! of its later half as uncertainty.
//!
//! What is measured is the run as its steps show it: the error of its scheme is not in the uncertainty, and a nutation of
//! less than two time steps is seen as a slower one, as it is on the screen.

use crate::physics::observables::Azimuth;
use crate::run::Simulation;
use std::f64::consts::TAU;

/// A measured number with its uncertainty, in its own unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured {
    /// The best value.
    pub value: f64,
    /// One standard error.
    pub uncertainty: f64,
    /// How many nutations it was taken from; 0 where there was none.
    pub nutations: u64,
}

/// A swing of the axle's height smaller than this is rounding, not nutation.
const ROUNDING: f64 = 1e-9;

/// The instruments that follow a run; to be shown every step of it.
#[derive(Clone, Debug)]
pub struct Instruments {
    /// The last three steps, the newest last.
    looks: [Look; 3],
    seen: u64,
    /// The last highest point of the axle, still to be confirmed by a lower one after it.
    candidate: Option<Turn>,
    lowest_since: f64,
    tops: Tops,
    start: Look,
    /// A step about half as far into the run as the newest.
    half: Look,
    next_half: Look,
}

#[derive(Clone, Copy, Debug)]
struct Look {
    time_s: f64,
    height: f64,
    azimuth: Azimuth,
}

#[derive(Clone, Copy, Debug)]
struct Turn {
    time_s: f64,
    azimuth_deg: f64,
    height: f64,
}

/// The highest points so far: the first, the last, and the spread of what lies between.
#[derive(Clone, Copy, Debug, Default)]
struct Tops {
    first: Option<Turn>,
    last: Option<Turn>,
    periods: Spread,
    rates: Spread,
}

/// Count, mean and sum of squared deviations (Welford, Technometrics 4, 419, 1962).
#[derive(Clone, Copy, Debug, Default)]
struct Spread {
    count: u64,
    mean: f64,
    squares: f64,
}

impl Spread {
    fn add(&mut self, number: f64) {
        self.count += 1;
        let off = number - self.mean;
        self.mean += off / self.count as f64;
        self.squares += off * (number - self.mean);
    }

    fn standard_error(&self, of_one: f64) -> f64 {
        match self.count {
            0 | 1 => of_one,
            n => (self.squares / ((n - 1) as f64 * n as f64)).sqrt(),
        }
    }
}

/// No number is known better than to its rounding, however well its parts agree.
fn at_least_rounding(uncertainty: f64, value: f64) -> f64 {
    uncertainty.max(f64::EPSILON * value.abs())
}

impl Tops {
    /// How far off, as a part, the first and the last point together may put the mean. A parabola through three steps of
    /// a swing's top, ψ apart, is off by up to (2/3√3) ψ²/12 of a step; where a swing takes almost a whole number of
    /// steps that is the same each time, and does not show in the spread.
    fn resolution(&self, step_s: f64) -> f64 {
        let psi = TAU * step_s / self.periods.mean;
        let of_a_step = 2.0 / 27_f64.sqrt() * psi * psi / 12.0;
        2.0 * of_a_step * step_s / (self.periods.mean * self.periods.count as f64)
    }
}

impl Look {
    fn at(simulation: &Simulation) -> Self {
        let state = simulation.state();
        Self {
            time_s: state.time_s,
            height: state.axle().z,
            azimuth: *simulation.azimuth(),
        }
    }
}

impl Instruments {
    /// Instruments that begin to follow `simulation` where it stands.
    pub fn new(simulation: &Simulation) -> Self {
        let look = Look::at(simulation);
        Self {
            looks: [look; 3],
            seen: 1,
            candidate: None,
            lowest_since: f64::INFINITY,
            tops: Tops::default(),
            start: look,
            half: look,
            next_half: look,
        }
    }

    /// Takes in the step that `simulation` stands at.
    #[inline]
    pub fn follow(&mut self, simulation: &Simulation) {
        let look = Look::at(simulation);
        self.looks = [self.looks[1], self.looks[2], look];
        self.seen += 1;
        let [a, b, c] = self.looks.map(|look| look.height);
        if self.seen > 2 && b >= a && b > c {
            self.candidate = Some(self.turn());
            self.lowest_since = f64::INFINITY;
        }
        if c < self.lowest_since {
            self.lowest_since = c;
            self.confirm();
        }
        if look.time_s - self.start.time_s >= 2.0 * (self.next_half.time_s - self.start.time_s) {
            (self.half, self.next_half) = (self.next_half, look);
        }
    }

    /// The turning point between the last three steps: the top of a parabola through them.
    fn turn(&self) -> Turn {
        let [a, b, c] = self.looks;
        let parabola = |a: f64, b: f64, c: f64| ((c - a) / 2.0, a - 2.0 * b + c);
        let (slope, bend) = parabola(a.height, b.height, c.height);
        let shift = -slope / bend;
        let [before, middle, after] = [a, b, c].map(|look| look.azimuth.degrees());
        let (way, curve) = parabola(before, middle, after);
        let step = if shift < 0.0 {
            b.time_s - a.time_s
        } else {
            c.time_s - b.time_s
        };
        Turn {
            time_s: b.time_s + shift * step,
            azimuth_deg: middle + shift * way + shift * shift * curve / 2.0,
            height: b.height,
        }
    }

    /// Counts the candidate once the axle has truly sunk below it.
    fn confirm(&mut self) {
        let Some(turn) = self
            .candidate
            .filter(|turn| turn.height - self.lowest_since > ROUNDING)
        else {
            return;
        };
        self.candidate = None;
        if let Some(last) = self.tops.last {
            let period = turn.time_s - last.time_s;
            self.tops.periods.add(period);
            self.tops
                .rates
                .add((turn.azimuth_deg - last.azimuth_deg).to_radians() / period);
        }
        self.tops.first.get_or_insert(turn);
        self.tops.last = Some(turn);
    }

    /// Nutation period of the run so far, s.
    pub fn nutation_period_s(&self) -> Option<Measured> {
        let Spread { count, mean, .. } = self.tops.periods;
        let step = self.looks[2].time_s - self.looks[1].time_s;
        let spread = self.tops.periods.standard_error(step);
        let uncertainty = at_least_rounding(spread.hypot(mean * self.tops.resolution(step)), mean);
        (count > 0).then_some(Measured {
            value: mean,
            uncertainty,
            nutations: count,
        })
    }

    /// Precession of the run so far, rad/s.
    pub fn precession_rad_per_s(&self) -> Option<Measured> {
        match (self.tops.first, self.tops.last) {
            (Some(first), Some(last)) if self.tops.rates.count > 0 => {
                let time = last.time_s - first.time_s;
                let value = (last.azimuth_deg - first.azimuth_deg).to_radians() / time;
                let step = self.looks[2].time_s - self.looks[1].time_s;
                let spread = self.tops.rates.standard_error(value.abs() * step / time);
                // At the top of its nutation the axle turns at up to about twice the mean rate.
                let resolution = 2.0 * value * self.tops.resolution(step);
                let uncertainty = at_least_rounding(spread.hypot(resolution), value);
                Some(Measured {
                    value,
                    uncertainty,
                    nutations: self.tops.rates.count,
                })
            }
            _ => self.way_of_the_azimuth(),
        }
    }

    fn way_of_the_azimuth(&self) -> Option<Measured> {
        let now = self.looks[2];
        let rate = |from: &Look| {
            let way = now.azimuth.degrees() - from.azimuth.degrees();
            way.to_radians() / (now.time_s - from.time_s)
        };
        let (whole, later) = (rate(&self.start), rate(&self.half));
        whole.is_finite().then(|| Measured {
            value: whole,
            uncertainty: if later.is_finite() {
                at_least_rounding((whole - later).abs(), whole)
            } else {
                whole.abs()
            },
            nutations: 0,
        })
    }
}
