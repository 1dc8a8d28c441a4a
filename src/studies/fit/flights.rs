//! Finds the free flights in a recording of a body's three rates.
//!
//! In free flight, Euler's equations hold without a torque. w1 changes by g1 times the integral of w2 w3, and likewise
//! for the other axes. The factor g1 = (B - C)/A is within -1..1 for every body, whatever its moments are.
//!
//! A flight is a longest run of rows in which the body turns fast and one such g for each axis explains the rates
//! within the noise. A hand that turns or catches the body changes the rates in other ways.

use super::thrown::{flies, product, recorded};
use crate::engine::data::TimeSeries;
use crate::engine::scenario::Scenario;
use nalgebra::Vector3;
use std::ops::Range;

/// A free flight in a recording.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flight {
    /// Time of the first row, s. `to_s` is the time of the last row.
    pub from_s: f64,
    pub to_s: f64,
    pub rows: usize,
    /// Mean of |omega|, rad/s.
    pub rate: f64,
}

/// Result of the search for free flights in a recording.
#[derive(Clone, Debug, PartialEq)]
pub enum Found {
    /// The data are not the three rates of a body that flies freely in the scenario.
    NotThrown,
    /// The whole recording is one flight.
    Whole,
    Flights(Vec<Flight>),
}

/// Minimum duration of a flight, s, and its minimum number of rows.
const SHORTEST_S: f64 = 0.2;
const FEWEST_ROWS: usize = 12;
/// Minimum fraction of the shortest duration that must remain after the ends are trimmed.
const MIN_REMAINING_SHARE: f64 = 0.75;
/// Minimum mean of |omega| in a flight, rad/s: slower rotation cannot be distinguished from rest.
const MIN_RATE: f64 = 2.0;
/// Allowed deviation of the rates in addition to the noise, as a fraction of |omega|: sensors are slightly misaligned.
const MISALIGNMENT: f64 = 0.01;
/// Allowed excess of the noise's mean square over its expected value, in standard deviations.
const NOISE_TOLERANCE: f64 = 4.0;
/// Duration at each end, s. Its rows are trimmed if their mean deviates by more than `END_DEVIATION` standard
/// deviations; for a whole recording, `END_DEVIATION_OF_WHOLE`.
const END_S: f64 = 0.02;
const END_DEVIATION: f64 = 3.0;
const END_DEVIATION_OF_WHOLE: f64 = 6.0;
/// Additional margin trimmed at each end, s, at least one row, because a hand may still push a little.
const MARGIN_S: f64 = 0.015;
/// A pause longer than this multiple of the usual time between rows ends a flight.
const MAX_PAUSE: f64 = 4.5;

/// Finds the free flights of `series`, in order of time.
pub fn find(series: &TimeSeries, scenario: &Scenario) -> Found {
    let Some(recorded) = recorded(series).filter(|_| flies(scenario)) else {
        return Found::NotThrown;
    };
    let recording = Recording::new(recorded);
    let count = recording.times_s.len();
    if count < FEWEST_ROWS || recording.is_one_flight() {
        return Found::Whole;
    }
    let mut flights = Vec::new();
    let mut first = 0;
    while first < count {
        match recording
            .longest_from(first)
            .and_then(|rows| recording.trimmed(rows))
        {
            Some(rows) => {
                flights.push(recording.flight(&rows));
                first = rows.end;
            }
            None => first += 1,
        }
    }
    Found::Flights(flights)
}

struct Recording {
    times_s: Vec<f64>,
    rates: Vec<Vector3<f64>>,
    /// The products w2 w3, w3 w1, w1 w2, integrated from the first row.
    sums: Vec<Vector3<f64>>,
    /// Standard deviation of the noise of a rate, rad/s.
    noise: f64,
    /// Median time between rows, s.
    interval_s: f64,
}

/// Sums over rows, relative to the first row. For each axis they give the least-squares line w = offset + growth . sum,
/// with a growth that a body can have.
#[derive(Default)]
struct Squares {
    count: f64,
    speed: f64,
    rates: Vector3<f64>,
    sums: Vector3<f64>,
    rates_rates: Vector3<f64>,
    sums_sums: Vector3<f64>,
    rates_sums: Vector3<f64>,
}

impl Squares {
    fn add(&mut self, rates: &Vector3<f64>, sums: &Vector3<f64>) {
        self.count += 1.0;
        self.rates += rates;
        self.sums += sums;
        self.rates_rates += rates.component_mul(rates);
        self.sums_sums += sums.component_mul(sums);
        self.rates_sums += rates.component_mul(sums);
    }

    /// Returns the covariance of two columns from the sum of their products, `products`, and their own sums.
    fn covariance(
        &self,
        products: &Vector3<f64>,
        a: &Vector3<f64>,
        b: &Vector3<f64>,
    ) -> Vector3<f64> {
        products / self.count - a.component_mul(b) / (self.count * self.count)
    }

    fn growth(&self) -> Vector3<f64> {
        let own = self.covariance(&self.sums_sums, &self.sums, &self.sums);
        let both = self.covariance(&self.rates_sums, &self.rates, &self.sums);
        both.zip_map(&own, |both, own| {
            if own > 0.0 {
                (both / own).clamp(-1.0, 1.0)
            } else {
                0.0
            }
        })
    }

    /// Returns the largest mean square deviation from the lines, of the three axes.
    fn mean_square(&self) -> f64 {
        let growth = self.growth();
        let rates = self.covariance(&self.rates_rates, &self.rates, &self.rates);
        let both = self.covariance(&self.rates_sums, &self.rates, &self.sums);
        let sums = self.covariance(&self.sums_sums, &self.sums, &self.sums);
        [0, 1, 2]
            .map(|axis| {
                let own = growth[axis];
                rates[axis] + own * (own * sums[axis] - 2.0 * both[axis])
            })
            .into_iter()
            .fold(0.0, f64::max)
    }
}

impl Recording {
    fn new(recorded: Vec<(f64, Vector3<f64>)>) -> Self {
        let (times_s, rates): (Vec<f64>, Vec<Vector3<f64>>) = recorded.into_iter().unzip();
        let mut sum = Vector3::zeros();
        let mut sums = Vec::with_capacity(rates.len());
        for row in 0..rates.len() {
            if let Some(before) = row.checked_sub(1) {
                let time_s = times_s[row] - times_s[before];
                sum += 0.5 * time_s * (product(&rates[before]) + product(&rates[row]));
            }
            sums.push(sum);
        }
        let interval_s = median(times_s.windows(2).map(|pair| pair[1] - pair[0]).collect());
        // The variance of the third differences is 20 times the variance of white noise. Smooth motion contributes
        // almost nothing.
        let thirds = rates
            .windows(4)
            .map(|row| row[3] - 3.0 * row[2] + 3.0 * row[1] - row[0])
            .flat_map(|third| <[f64; 3]>::from(third.abs()));
        Self {
            noise: median(thirds.collect()) / (0.6745 * 20.0_f64.sqrt()),
            times_s,
            rates,
            sums,
            interval_s,
        }
    }

    fn squares(&self, rows: Range<usize>) -> Squares {
        let first = rows.start;
        let mut squares = Squares::default();
        for row in rows {
            self.add(&mut squares, first, row);
        }
        squares
    }

    fn add(&self, squares: &mut Squares, first: usize, row: usize) {
        squares.speed += self.rates[row].norm();
        let (rates, sums) = (
            self.rates[row] - self.rates[first],
            self.sums[row] - self.sums[first],
        );
        squares.add(&rates, &sums);
    }

    fn is_explained(&self, squares: &Squares) -> bool {
        let misalignment = MISALIGNMENT * squares.speed / squares.count;
        let scatter = 1.0 + NOISE_TOLERANCE * (2.0 / squares.count).sqrt();
        squares.mean_square() <= self.noise * self.noise * scatter + misalignment * misalignment
    }

    /// Returns true if free flight explains all rows, including the ends, however slowly the body turns.
    fn is_one_flight(&self) -> bool {
        let all = 0..self.times_s.len();
        let pairs = self.times_s.windows(2);
        pairs
            .map(|pair| pair[1] - pair[0])
            .all(|it| it <= MAX_PAUSE * self.interval_s)
            && self.is_explained(&self.squares(all.clone()))
            && self.without_ends(all.clone(), END_DEVIATION_OF_WHOLE) == all
    }

    /// Returns the longest flight that begins at row `first` or soon after. Its ends are not yet trimmed.
    fn longest_from(&self, first: usize) -> Option<Range<usize>> {
        let mut longest = self.explained_from(first)?;
        let until_s = self.times_s[first] + SHORTEST_S;
        for later in first + 1..longest.end {
            if self.times_s[later] > until_s {
                break;
            }
            let rows = self.explained_from(later);
            longest = rows
                .filter(|rows| rows.len() > longest.len())
                .unwrap_or(longest);
        }
        Some(longest)
    }

    /// Returns the longest flight that begins at row `first`.
    fn explained_from(&self, first: usize) -> Option<Range<usize>> {
        let mut squares = Squares::default();
        let mut found = None;
        for row in first..self.times_s.len() {
            let before = row.max(first + 1) - 1;
            if self.times_s[row] - self.times_s[before] > MAX_PAUSE * self.interval_s {
                break;
            }
            self.add(&mut squares, first, row);
            let rows = first..row + 1;
            if rows.len() < FEWEST_ROWS || self.seconds(&rows) < SHORTEST_S {
                continue;
            }
            if !self.is_explained(&squares) {
                break;
            }
            found = Some(rows);
        }
        found.filter(|rows| self.speed(rows) >= MIN_RATE)
    }

    /// Trims deviating rows at the ends of `rows`, and a margin. Returns `None` if the rest is too short.
    fn trimmed(&self, rows: Range<usize>) -> Option<Range<usize>> {
        let rows = self.without_ends(rows, END_DEVIATION);
        let margin = (MARGIN_S / self.interval_s).ceil().max(1.0) as usize;
        let last = self.times_s.len();
        // If the recording itself begins or ends in flight, there is no hand.
        let start = if rows.start == 0 {
            0
        } else {
            rows.start + margin
        };
        let end = if rows.end == last {
            last
        } else {
            rows.end.saturating_sub(margin)
        };
        let kept = start..end.max(start);
        let is_long =
            kept.len() >= FEWEST_ROWS && self.seconds(&kept) >= MIN_REMAINING_SHARE * SHORTEST_S;
        is_long.then_some(kept)
    }

    /// Trims rows at the ends that deviate from the lines of all rows by more than `most` standard deviations.
    fn without_ends(&self, mut rows: Range<usize>, most: f64) -> Range<usize> {
        let block = (END_S / self.interval_s).clamp(1.0, FEWEST_ROWS as f64 / 2.0) as usize;
        while rows.len() > FEWEST_ROWS {
            let squares = self.squares(rows.clone());
            let growth = squares.growth();
            let offset = (squares.rates - growth.component_mul(&squares.sums)) / squares.count;
            let misalignment = MISALIGNMENT * squares.speed / squares.count;
            let first = rows.start;
            let both_ends = [first..first + block, rows.end - block..rows.end];
            let [starts, ends] = both_ends.map(|end| {
                let count = end.len() as f64;
                let mean = end
                    .map(|row| {
                        let sums = self.sums[row] - self.sums[first];
                        self.rates[row] - self.rates[first] - offset - growth.component_mul(&sums)
                    })
                    .sum::<Vector3<f64>>()
                    / count;
                mean.amax() > most * self.noise / count.sqrt() + misalignment
            });
            if !starts && !ends {
                break;
            }
            rows = rows.start + usize::from(starts)..rows.end - usize::from(ends);
        }
        rows
    }

    fn seconds(&self, rows: &Range<usize>) -> f64 {
        self.times_s[rows.end - 1] - self.times_s[rows.start]
    }

    fn speed(&self, rows: &Range<usize>) -> f64 {
        let speeds = self.rates[rows.clone()].iter().map(Vector3::norm);
        speeds.sum::<f64>() / rows.len() as f64
    }

    fn flight(&self, rows: &Range<usize>) -> Flight {
        Flight {
            from_s: self.times_s[rows.start],
            to_s: self.times_s[rows.end - 1],
            rows: rows.len(),
            rate: self.speed(rows),
        }
    }
}

fn median(mut numbers: Vec<f64>) -> f64 {
    numbers.sort_by(f64::total_cmp);
    numbers.get(numbers.len() / 2).copied().unwrap_or(0.0)
}
