//! Measures a run by its highest points, found by parabolas through three rows. This is used for lopsided bodies, loads
//! off the axle, and time steps too long for the motion.

use super::beats::{Point, slope};
use super::turns::{
    HEIGHT_SWING_ROUNDING, HeightExtreme, MeasuredNumber, StraightLine, Turns, WithoutNutation,
};
use crate::physics::SymmetricTop;
use crate::physics::observables::Azimuth;
use crate::run::Step;
use std::f64::consts::TAU;

/// Minimum number of nutations for an uncertainty: of a symmetric body, and of a lopsided body. The nutations of a
/// lopsided body grow longer and shorter over several of them.
const FEWEST_NUTATIONS: [u64; 2] = [4, 16];
/// Minimum swing of a lopsided body's axle, as a fraction of its whole range of heights. If some swings are smaller,
/// the number of nutations depends on which swings are counted.
const LEAST_SWING_PART: f64 = 0.1;
/// Number of sectors in a turn. For each sector, the instruments note whether the vertical was in it at a turning
/// point, as seen from a lopsided body.
const DIRECTIONS: u32 = u16::BITS;
/// Maximum number of adjacent sectors that may be unseen. Beyond it, nutations in these directions are unknown.
const MOST_UNSEEN: u32 = 5;
/// Minimum number of rows per nutation. With fewer, a highest point may be missed.
const ROWS_TO_SEE_IT: f64 = 8.0;
/// Maximum ratio of the longest to the shortest nutation of a lopsided body. Beyond it, a highest point between two
/// others was too shallow to be seen.
const MOST_UNLIKE: f64 = 1.5;
/// Largest difference, in rows, that equally long nutations show because of the rows.
const ROWS_OF_CHANCE: f64 = 1.5;
/// Weight of the scatter of nutations that differ at random, relative to the scatter of single points.
const AT_RANDOM: f64 = 1.75;

#[derive(Clone, Debug)]
pub struct Parabolas {
    /// The last three steps, the newest last.
    looks: [AxleSample; 3],
    seen: u64,
    /// The last highest point of the axle and its height, until a lower row confirms it.
    candidate: Option<(HeightExtreme, f64)>,
    lowest_since: f64,
    last: Option<(u64, HeightExtreme)>,
    count: u64,
    turns: Turns,
    is_lopsided: bool,
    /// Height of the last highest or lowest row.
    turned_at: Option<f64>,
    /// Smallest swing between two such rows. The first swing, seen only in part, does not count.
    smallest_swing: f64,
    /// Sectors of the vertical's direction that were seen at turning points, one bit each.
    directions: u16,
    /// Shortest and longest time between two highest points, s.
    nutations_s: [f64; 2],
    heights: [f64; 2],
    /// True if the azimuth has turned so far in one step that its direction is ambiguous.
    is_ambiguous: bool,
    start: AxleSample,
    /// A step about halfway between the start and the newest step.
    half: AxleSample,
    next_half: AxleSample,
}

#[derive(Clone, Copy, Debug)]
struct AxleSample {
    time_s: f64,
    axle: [f64; 3],
    azimuth: Azimuth,
    /// Components of the vertical across the axle, body frame.
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
    /// Creates instruments for a run that begins at `step`.
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

    /// Returns the turning point between the last three steps: the vertex of the parabola through them.
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

    /// Records that the axle turns back at this height.
    fn swing_to(&mut self, height: f64) {
        match self.turned_at {
            Some(last) if (height - last).abs() <= HEIGHT_SWING_ROUNDING => return,
            Some(last) => self.smallest_swing = self.smallest_swing.min((height - last).abs()),
            None => {}
        }
        self.turned_at = Some(height);
    }

    /// Returns true if a lopsided body has no swing so small that counting it would be a matter of convention.
    fn is_even(&self) -> bool {
        let [lowest, highest] = self.heights;
        self.smallest_swing >= LEAST_SWING_PART * (highest - lowest)
    }

    /// Returns true if a lopsided body has turned far enough about its axle to show the lengths of all its nutations.
    fn has_seen_beat(&self) -> bool {
        // Each pass keeps only the unseen sectors that have an unseen neighbor.
        let mut unseen = !self.directions;
        for _ in 0..MOST_UNSEEN {
            unseen &= unseen.rotate_left(1);
        }
        unseen == 0
    }

    /// Counts the candidate once the axle has sunk below it by more than rounding.
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

    /// Returns the line through the highest points, with the possible error of a parabola at its ends. Through three
    /// steps of a swing's top, ψ apart, this error is at most (2/3√3) ψ²/12 of a step.
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

    /// Returns true if the rows are close enough together to show each highest point. If they are not, nutations seem
    /// to differ because some are merged. For a lopsided body this is not a sufficient test: nutations differ anyway,
    /// and merged ones may look alike.
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
            return self.mean_azimuth_rate();
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

    /// Returns how far `value` is from the slope that allows for a lopsided body's beats; 0 for a symmetric body.
    /// `value` is the slope from the first to the last turning point, and `point` makes the points of the line.
    fn beats(&self, value: f64, point: impl Fn((u64, HeightExtreme)) -> Point) -> f64 {
        let Some(last) = self.last.filter(|_| self.is_lopsided) else {
            return 0.0;
        };
        let turns = self.turns.before(last.0).copied().chain([last]);
        let points: Vec<Point> = turns.map(point).collect();
        slope(&points).map_or(0.0, |slope| libm::hypot(slope.value - value, slope.error))
    }

    /// Returns the mean rate of the azimuth over the whole time, for an axle that keeps its height.
    fn mean_azimuth_rate(&self) -> Option<MeasuredNumber> {
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

/// Returns slope and bend at the middle of the parabola through three equally spaced numbers.
fn parabola([a, b, c]: [f64; 3]) -> (f64, f64) {
    ((c - a) / 2.0, a - 2.0 * b + c)
}
