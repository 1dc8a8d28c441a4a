//! A run as its rows show it, for a lopsided body, a load aside, or time steps too long for the motion: the highest points
//! of the axle by parabolas through three rows.

use super::beats::{Point, slope};
use super::turns::{
    HEIGHT_SWING_ROUNDING, HeightExtreme, MeasuredNumber, StraightLine, Turns, WithoutNutation,
};
use crate::physics::SymmetricTop;
use crate::physics::observables::Azimuth;
use crate::run::Step;
use std::f64::consts::TAU;

/// Fewer nutations than this do not say how much they differ from one another: of a symmetric body, and of a lopsided one,
/// whose nutations grow longer and shorter over several of them.
const FEWEST_NUTATIONS: [u64; 2] = [4, 16];
/// Where a swing of a lopsided body's axle is less than this part of all that it rises and sinks, how many there are
/// depends on which count.
const LEAST_SWING_PART: f64 = 0.1;
/// The directions about a lopsided body's axle in which the vertical was at a turning point are counted in so many parts
/// of a turn.
const DIRECTIONS: u32 = u16::BITS;
/// More of them in a row than this were not seen: what its nutations are like there is not known.
const MOST_UNSEEN: u32 = 5;
/// Between rows that are further apart than this part of a nutation a highest point may be missed.
const ROWS_TO_SEE_IT: f64 = 8.0;
/// Nutations of a lopsided body that differ by more than this factor in length: between two of their highest points lay
/// one that was too shallow to be seen.
const MOST_UNLIKE: f64 = 1.5;
/// Largest difference of equally long nutations as the rows show them, in rows.
const ROWS_OF_CHANCE: f64 = 1.5;
/// Weight of the scatter of nutations that differ at random, against the scatter of single points.
const AT_RANDOM: f64 = 1.75;

#[derive(Clone, Debug)]
pub struct Parabolas {
    /// The last three steps, the newest last.
    looks: [AxleSample; 3],
    seen: u64,
    /// The last highest point of the axle, still to be confirmed by a lower one after it.
    candidate: Option<(HeightExtreme, f64)>,
    lowest_since: f64,
    last: Option<(u64, HeightExtreme)>,
    count: u64,
    turns: Turns,
    is_lopsided: bool,
    /// The height of the last highest or lowest row, and the smallest swing between two; the first is seen in part.
    turned_at: Option<f64>,
    smallest_swing: f64,
    /// The directions in which the vertical was at the turning points, a bit each.
    directions: u16,
    /// The shortest and the longest time between two highest points, s.
    nutations_s: [f64; 2],
    heights: [f64; 2],
    /// Whether the azimuth has turned so far in one step that it cannot be told which way.
    is_ambiguous: bool,
    start: AxleSample,
    /// A step about half as far into the run as the newest.
    half: AxleSample,
    next_half: AxleSample,
}

#[derive(Clone, Copy, Debug)]
struct AxleSample {
    time_s: f64,
    axle: [f64; 3],
    azimuth: Azimuth,
    /// The vertical across the axle, seen from the body.
    vertical: [f64; 2],
}

impl AxleSample {
    fn at(step: &Step) -> Self {
        let state = step.after();
        Self {
            time_s: state.time_s,
            axle: state.axle().into(),
            azimuth: *step.azimuth(),
            vertical: [state.orientation[(2, 0)], state.orientation[(2, 1)]],
        }
    }

    fn azimuth_rad(&self) -> f64 {
        self.azimuth.degrees().to_radians()
    }
}

impl Parabolas {
    /// Instruments for the run that begins at `step`.
    pub fn new(step: &Step) -> Self {
        let look = AxleSample::at(step);
        let is_lopsided = SymmetricTop::from_body(&step.scenario().body.mechanics).is_none();
        Self {
            looks: [look; 3],
            seen: 1,
            candidate: None,
            lowest_since: look.axle[2],
            last: None,
            count: 0,
            turns: if is_lopsided {
                Turns::of_beats()
            } else {
                Turns::new()
            },
            is_lopsided,
            turned_at: None,
            smallest_swing: f64::INFINITY,
            directions: 0,
            nutations_s: [f64::INFINITY, 0.0],
            heights: [look.axle[2]; 2],
            is_ambiguous: false,
            start: look,
            half: look,
            next_half: look,
        }
    }

    #[inline]
    pub fn record(&mut self, step: &Step) {
        let look = AxleSample::at(step);
        let before = self.looks[2].axle;
        self.is_ambiguous |= before[0] * look.axle[0] + before[1] * look.axle[1] < 0.0;
        self.looks = [self.looks[1], self.looks[2], look];
        self.seen += 1;
        let [a, b, c] = self.looks.map(|sample| sample.axle[2]);
        self.heights = [self.heights[0].min(c), self.heights[1].max(c)];
        if self.seen > 2 && b >= a && b > c {
            self.candidate = Some((self.turn(), b));
            self.lowest_since = f64::INFINITY;
        }
        if self.seen > 2 && ((b >= a && b > c) || (b <= a && b < c)) {
            self.swing_to(b);
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
    fn turn(&self) -> HeightExtreme {
        let [a, b, c] = self.looks;
        let (slope, bend) = parabola(self.looks.map(|look| look.axle[2]));
        let shift = -slope / bend;
        let azimuths = self.looks.map(|look| look.azimuth_rad());
        let (way, curve) = parabola(azimuths);
        let step = if shift < 0.0 {
            b.time_s - a.time_s
        } else {
            c.time_s - b.time_s
        };
        HeightExtreme {
            time_s: b.time_s + shift * step,
            time_off_s: 0.0,
            time_error_s: 0.0,
            azimuth: azimuths[1] + shift * way + shift * shift * curve / 2.0,
            azimuth_off: 0.0,
            azimuth_error: 0.0,
            azimuth_rate: (way + shift * curve) / step,
            level: libm::hypot(b.axle[0], b.axle[1]),
            phase: libm::atan2(b.vertical[0], b.vertical[1]),
        }
    }

    /// Takes in that the axle turns back at this height.
    fn swing_to(&mut self, height: f64) {
        match self.turned_at {
            Some(last) if (height - last).abs() <= HEIGHT_SWING_ROUNDING => return,
            Some(last) => self.smallest_swing = self.smallest_swing.min((height - last).abs()),
            None => {}
        }
        self.turned_at = Some(height);
    }

    /// Whether a lopsided body has no swing so small that another rule might not count it.
    fn is_even(&self) -> bool {
        let [lowest, highest] = self.heights;
        self.smallest_swing >= LEAST_SWING_PART * (highest - lowest)
    }

    /// Whether a lopsided body has turned so far about its axle that the lengths of all its nutations were seen.
    fn has_seen_beat(&self) -> bool {
        // Each pass leaves those that are unseen together with their neighbor.
        let mut unseen = !self.directions;
        for _ in 0..MOST_UNSEEN {
            unseen &= unseen.rotate_left(1);
        }
        unseen == 0
    }

    /// Counts the candidate once the axle has truly sunk below it.
    fn confirm(&mut self) {
        let Some((turn, _)) = self
            .candidate
            .filter(|(_, height)| height - self.lowest_since > HEIGHT_SWING_ROUNDING)
        else {
            return;
        };
        self.candidate = None;
        let part = (turn.phase / TAU).rem_euclid(1.0) * f64::from(DIRECTIONS);
        self.directions |= 1 << (part as u32).min(DIRECTIONS - 1);
        if self.turns.wants(self.count) {
            self.turns.keep(self.count, turn);
        }
        if let Some((_, last)) = self.last {
            let [shortest, longest] = self.nutations_s;
            let time_s = turn.time_s - last.time_s;
            self.nutations_s = [shortest.min(time_s), longest.max(time_s)];
        }
        self.last = Some((self.count, turn));
        self.count += 1;
    }

    /// The line through the highest points, with what a parabola may be off by at its ends: through three steps of a
    /// swing's top, ψ apart, up to (2/3√3) ψ²/12 of a step.
    fn line(&self) -> Option<StraightLine> {
        let fewest = FEWEST_NUTATIONS[usize::from(self.is_lopsided)];
        let (number, last) = self.last.filter(|(number, _)| *number >= fewest)?;
        let mut line = self.turns.line_to(number, last)?;
        let step = self.looks[2].time_s - self.looks[1].time_s;
        let psi = TAU * step * number as f64 / line.time_s();
        let off_s = 2.0 / 27_f64.sqrt() * psi * psi / 12.0 * step;
        for end in [&mut line.first, &mut line.last] {
            end.time_error_s = off_s;
            end.azimuth_error = (end.azimuth_rate * off_s).abs();
        }
        Some(line)
    }

    /// Whether the rows are near enough to one another to show each highest point: where they are not, nutations seem to
    /// differ because some are taken for one. Of a lopsided body they may differ, and be taken for one, without seeming to.
    fn shows_each(&self) -> bool {
        let row = self.looks[2].time_s - self.looks[1].time_s;
        let [shortest, longest] = self.nutations_s;
        let seem_alike = longest - shortest <= ROWS_OF_CHANCE * row;
        let is_near = shortest >= ROWS_TO_SEE_IT * row;
        if self.is_lopsided {
            is_near && longest <= MOST_UNLIKE * shortest
        } else {
            is_near || seem_alike
        }
    }

    pub fn nutation_period_s(&self) -> Result<MeasuredNumber, WithoutNutation> {
        let [lowest, highest] = self.heights;
        if highest - lowest <= HEIGHT_SWING_ROUNDING {
            return Err(WithoutNutation::Steady);
        }
        let line = self.line().ok_or(WithoutNutation::TooFew)?;
        if self.is_lopsided && !self.is_even() {
            return Err(WithoutNutation::Uneven);
        }
        if !self.shows_each() {
            return Err(WithoutNutation::RowsTooFarApart);
        }
        if self.is_lopsided && !self.has_seen_beat() {
            return Err(WithoutNutation::BeatUnseen);
        }
        let count = line.intervals as f64;
        let value = line.time_s() / count;
        let beats = self.beats(value, |(number, turn)| Point {
            x: number as f64,
            y: turn.time_s,
            phase: turn.phase,
        });
        let uncertainty = libm::hypot(line.time_error_s(AT_RANDOM) / count, beats);
        Ok(MeasuredNumber {
            value,
            uncertainty: uncertainty.max(f64::EPSILON * value),
            nutations: line.intervals,
        })
    }

    pub fn precession_rad_per_s(&self) -> Option<MeasuredNumber> {
        if self.is_ambiguous {
            return None;
        }
        let Some(line) = self.line() else {
            return self.way_of_the_azimuth();
        };
        if self.is_lopsided && !self.has_seen_beat() {
            return None;
        }
        let value = line.rate();
        let beats = self.beats(value, |(_, turn)| Point {
            x: turn.time_s,
            y: turn.azimuth,
            phase: turn.phase,
        });
        let uncertainty = libm::hypot(line.rate_error(AT_RANDOM), beats);
        Some(MeasuredNumber {
            value,
            uncertainty: uncertainty.max(f64::EPSILON * value.abs()),
            nutations: line.intervals,
        })
    }

    /// How far `value`, the slope from the first to the last of the turning points' `points`, is off the slope that allows
    /// for a lopsided body's beats; 0 of a symmetric one.
    fn beats(&self, value: f64, point: impl Fn((u64, HeightExtreme)) -> Point) -> f64 {
        let Some(last) = self.last.filter(|_| self.is_lopsided) else {
            return 0.0;
        };
        let turns = self.turns.before(last.0).copied().chain([last]);
        let points: Vec<Point> = turns.map(point).collect();
        slope(&points).map_or(0.0, |slope| libm::hypot(slope.value - value, slope.error))
    }

    /// The whole way of the azimuth over the time, for an axle that keeps its height.
    fn way_of_the_azimuth(&self) -> Option<MeasuredNumber> {
        let now = self.looks[2];
        let [whole, later] = [&self.start, &self.half]
            .map(|from| (now.azimuth_rad() - from.azimuth_rad()) / (now.time_s - from.time_s));
        let [lowest, highest] = self.heights;
        let is_steady = highest - lowest <= HEIGHT_SWING_ROUNDING;
        (is_steady && whole.is_finite() && later.is_finite()).then(|| MeasuredNumber {
            value: whole,
            uncertainty: (whole - later).abs().max(f64::EPSILON * whole.abs()),
            nutations: 0,
        })
    }
}

/// Slope and bend at the middle of the parabola through three numbers one apart.
fn parabola([a, b, c]: [f64; 3]) -> (f64, f64) {
    ((c - a) / 2.0, a - 2.0 * b + c)
}
