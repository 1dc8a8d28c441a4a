//! The parameters of the search, and their limits.
//!
//! Each key is a parameter, except for moments of a part. No moment of a body is larger than the sum of the two others;
//! for a flat body they are equal. Half the difference is the second moment of mass along an axis, the integral of x^2
//! dm, which is at least 0.
//!
//! If several moments are free, the search uses the same number of second moments instead. It can then always change
//! one of them up or down, even for a flat body or a rod.

use super::free::Free;
use super::within::Limit;
use crate::engine::scenario::Scenario;
use crate::physics::part::PlacedSolid;
use nalgebra::{DMatrix, DVector, Vector3};
use std::collections::BTreeSet;

#[derive(Clone, Debug)]
pub struct Chart {
    /// The parameters are matrix . keys + offset.
    pub matrix: DMatrix<f64>,
    offset: DVector<f64>,
    pub inverse: DMatrix<f64>,
    /// The moments of each part that has a free moment, by the index of the part.
    moments: Vec<(usize, [Row; 3])>,
    pub rules: Vec<Rule>,
    /// Limits of the parameters, one per rule.
    pub limits: Vec<Limit>,
}

/// Reason for a limit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rule {
    /// Lower bound of the key with this index. `Greatest` is its upper bound.
    Least(usize),
    Greatest(usize),
    /// The second moment of mass of a part along one of its axes is at least 0.
    SecondMoment {
        part: usize,
        axis: usize,
    },
    /// A moment of a part is at least [`LEAST_MOMENT`] times the sum of its moments.
    Moment {
        part: usize,
        axis: usize,
    },
}

impl Rule {
    /// Returns true for a physical limit, false for a bound set by the user.
    pub fn is_of_nature(self, free: &[Free]) -> bool {
        match self {
            Self::Least(key) => free[key].from == free[key].least,
            Self::Greatest(_) => false,
            Self::SecondMoment { .. } | Self::Moment { .. } => true,
        }
    }
}

/// Minimum moment of a part, as a fraction of the sum of all three: a rod without thickness has no defined rotation
/// about its axis.
pub const LEAST_MOMENT: f64 = 1e-6;

/// A linear function of the keys.
#[derive(Clone, Debug)]
struct Row {
    slopes: DVector<f64>,
    at_zero: f64,
}

impl Chart {
    /// Creates the parameters for the `free` keys of `scenario`. All other values of the scenario stay fixed.
    pub fn new(free: &[Free], scenario: &Scenario) -> Self {
        let count = free.len();
        let unit =
            |place: usize| DVector::from_fn(count, |row, _| f64::from(u8::from(row == place)));
        let mut moments = Vec::new();
        for part in parts(free) {
            moments.push((part, of_part(free, part, scenario)));
        }
        let places: Vec<usize> = (0..count)
            .filter(|place| free[*place].keys.iter().any(|key| moment(key).is_some()))
            .collect();
        let mut chart = Self {
            matrix: DMatrix::identity(count, count),
            offset: DVector::zeros(count),
            inverse: DMatrix::identity(count, count),
            moments: Vec::new(),
            rules: Vec::new(),
            limits: Vec::new(),
        };
        let second: Vec<Row> = moments.iter().flat_map(|(_, rows)| second(rows)).collect();
        if places.len() > 1 {
            for (&place, &row) in places.iter().zip(&independent(&second, places.len())) {
                chart.matrix.set_row(place, &second[row].slopes.transpose());
                chart.offset[place] = second[row].at_zero;
            }
            match chart.matrix.clone().try_inverse() {
                Some(inverse) => chart.inverse = inverse,
                None => {
                    chart.matrix = DMatrix::identity(count, count);
                    chart.offset = DVector::zeros(count);
                }
            }
        }
        for (place, key) in free.iter().enumerate() {
            chart.limit(Rule::Least(place), &unit(place), key.from);
            chart.limit(Rule::Greatest(place), &-unit(place), -key.to);
        }
        for ((part, rows), second_row) in moments.iter().zip(second.chunks(3)) {
            let sum: DVector<f64> = rows.iter().map(|row| &row.slopes).sum();
            let sum_at_zero: f64 = rows.iter().map(|row| row.at_zero).sum();
            for axis in 0..3 {
                let (part, of_second, of_moment) = (*part, &second_row[axis], &rows[axis]);
                let rule = Rule::SecondMoment { part, axis };
                chart.limit(rule, &of_second.slopes, -of_second.at_zero);
                let slopes = &of_moment.slopes - LEAST_MOMENT * &sum;
                let at_zero = of_moment.at_zero - LEAST_MOMENT * sum_at_zero;
                chart.limit(Rule::Moment { part, axis }, &slopes, -at_zero);
            }
        }
        chart.moments = moments;
        chart
    }

    /// Adds the limit `slopes` . keys >= `least`.
    fn limit(&mut self, rule: Rule, slopes: &DVector<f64>, least: f64) {
        if slopes.amax() == 0.0 || !least.is_finite() {
            return;
        }
        // A key that is itself a parameter is limited exactly, without the rounding errors of the inverse.
        let own = (0..slopes.len()).find(|&place| self.matrix.row(place).transpose() == *slopes);
        let limit = match own {
            Some(place) => Limit {
                normal: DVector::from_fn(slopes.len(), |row, _| f64::from(u8::from(row == place))),
                least: least + self.offset[place],
            },
            None => Limit {
                least: least + self.inverse.tr_mul(slopes).dot(&self.offset),
                normal: self.inverse.tr_mul(slopes),
            },
        };
        self.rules.push(rule);
        self.limits.push(limit);
    }

    /// Converts values of the keys to parameters.
    pub fn parameters(&self, keys: &[f64]) -> Vec<f64> {
        let keys = DVector::from_column_slice(keys);
        (&self.matrix * keys + &self.offset).as_slice().to_vec()
    }

    /// Converts parameters to values of the keys.
    pub fn keys(&self, parameters: &[f64]) -> Vec<f64> {
        let parameters = DVector::from_column_slice(parameters);
        (&self.inverse * (parameters - &self.offset))
            .as_slice()
            .to_vec()
    }

    /// Returns the limits around `parameters`. A limit that they violate by rounding is moved so that it holds.
    pub fn limits_around(&self, parameters: &[f64]) -> Vec<Limit> {
        self.limits
            .iter()
            .map(|limit| Limit {
                least: limit.least + limit.room(parameters).min(0.0),
                normal: limit.normal.clone(),
            })
            .collect()
    }

    /// Returns the moment of `part` about `axis` for these values of the keys; `None` if the part has no free moment.
    pub fn moment(&self, part: usize, axis: usize, keys: &[f64]) -> Option<f64> {
        let (_, rows) = self.moments.iter().find(|(own, _)| *own == part)?;
        let row = &rows[axis];
        let free = row.slopes.iter().zip(keys).map(|(slope, key)| slope * key);
        Some(row.at_zero + free.sum::<f64>())
    }

    /// Returns true if these values of the keys satisfy all limits.
    pub fn holds(&self, keys: &[f64]) -> bool {
        let parameters = self.parameters(keys);
        self.limits
            .iter()
            .all(|limit| limit.room(&parameters) >= 0.0)
    }
}

/// Parses the key of a moment and returns its part and axis.
pub fn moment(key: &str) -> Option<(usize, usize)> {
    let (part, axis) = key
        .strip_prefix("body.part.")?
        .split_once(".moments_kg_m2.")?;
    Some((
        part.parse().ok()?,
        axis.parse().ok().filter(|axis| *axis < 3)?,
    ))
}

/// Returns the parts with a free moment.
fn parts(free: &[Free]) -> BTreeSet<usize> {
    let keys = free.iter().flat_map(|free| &free.keys);
    keys.filter_map(|key| Some(moment(key)?.0)).collect()
}

/// Returns the three moments of `part` about its center as functions of the keys.
fn of_part(free: &[Free], part: usize, scenario: &Scenario) -> [Row; 3] {
    let own = Vector3::from(
        scenario
            .file
            .body
            .part
            .get(part)
            .and_then(|part| part.moments_kg_m2)
            .unwrap_or_default(),
    );
    let about_center = scenario
        .body
        .parts
        .get(part)
        .map_or(own, PlacedSolid::moments);
    let shift = own - about_center; // 0, unless the file gives the moments about the pivot
    [0, 1, 2].map(|axis| {
        let slopes = DVector::from_fn(free.len(), |row, _| {
            let mut keys = free[row].keys.iter();
            f64::from(u8::from(keys.any(|key| moment(key) == Some((part, axis)))))
        });
        let is_free = slopes.iter().any(|slope| *slope > 0.0);
        Row {
            slopes,
            at_zero: if is_free { 0.0 } else { own[axis] } - shift[axis],
        }
    })
}

/// Returns the second moments of mass of a body with these moments, as functions of the keys.
fn second(moments: &[Row; 3]) -> [Row; 3] {
    [0, 1, 2].map(|axis| {
        let [own, next, last] = [0, 1, 2].map(|turn| &moments[(axis + turn) % 3]);
        Row {
            slopes: 0.5 * (&next.slopes + &last.slopes - &own.slopes),
            at_zero: 0.5 * (next.at_zero + last.at_zero - own.at_zero),
        }
    })
}

/// Returns the indices of `count` of the `rows` that are linearly independent.
fn independent(rows: &[Row], count: usize) -> Vec<usize> {
    let mut basis: Vec<DVector<f64>> = Vec::new();
    let mut places = Vec::new();
    for (place, row) in rows.iter().enumerate() {
        let mut rest = row.slopes.clone();
        basis.iter().for_each(|it| rest -= it * it.dot(&rest));
        if let Some(rest) = rest.try_normalize(1e-6)
            && places.len() < count
        {
            basis.push(rest);
            places.push(place);
        }
    }
    places
}

/// Returns the second moments of mass along the axes of a body with these moments.
pub fn second_moments(moments: &Vector3<f64>) -> Vector3<f64> {
    Vector3::repeat(0.5 * moments.sum()) - moments
}
