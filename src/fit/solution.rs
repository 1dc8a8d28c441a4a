//! What a minimum says of the keys: their uncertainties, how these hang together, and what cannot be told apart.

use super::free::Free;
use super::levenberg::{Minimum, SINGULAR};
use nalgebra::{DMatrix, DVector};

#[derive(Clone, Debug, PartialEq)]
pub struct Solution {
    /// The covariances of the keys, in their units, for data whose uncertainty is 1; `None` of a key whose value the data do
    /// not say, or that is held at a bound.
    pub covariance: Vec<Vec<Option<f64>>>,
    pub rank: usize,
    /// The keys on which no datum depends.
    pub silent: Vec<usize>,
    /// The combinations of keys that change no datum: the keys by their places, and the change of each, relative to its
    /// value, the largest of them 1; relative to [`Free::scale`](super::free::Free::scale) where the value is 0.
    pub alike: Vec<Vec<(usize, f64)>>,
}

/// A key that moves no datum by this part of its uncertainty when it changes by its own size moves none.
pub(super) const SILENT: f64 = 1e-5;
/// Parts of a combination below this are rounding.
const PART: f64 = 1e-2;

/// The combination of the keys in the `k`-th direction: the `moving` keys that take part, with their changes in `units`, the
/// largest of them 1.
fn alike(v_t: &DMatrix<f64>, k: usize, moving: &[usize], units: &[f64]) -> Vec<(usize, f64)> {
    let parts = units.iter().enumerate();
    let parts: Vec<f64> = parts.map(|(place, unit)| v_t[(k, place)] / unit).collect();
    // Of equal ones the first.
    let sizes = parts.iter().copied().rev();
    let largest = sizes.max_by(|a, b| a.abs().total_cmp(&b.abs()));
    let largest = largest.unwrap_or_default();
    let places = (0..moving.len()).filter(|&place| v_t[(k, place)].abs() > PART);
    let combined = places.map(|place| (moving[place], parts[place] / largest));
    combined.collect()
}

impl Solution {
    pub fn of(minimum: &Minimum, free: &[Free]) -> Self {
        let slopes = &minimum.slopes;
        let norms: Vec<f64> = slopes.column_iter().map(|column| column.norm()).collect();
        let size = |index: usize| free[index].size(minimum.p[index]);
        let is_silent = |index: usize| norms[index] * size(index) <= SILENT;
        let silent: Vec<usize> = (0..free.len()).filter(|&index| is_silent(index)).collect();
        let moves = |index: &usize| !minimum.held[*index] && !silent.contains(index);
        let moving: Vec<usize> = (0..free.len()).filter(moves).collect();
        let mut solution = Self {
            covariance: vec![vec![None; free.len()]; free.len()],
            rank: 0,
            silent,
            alike: Vec::new(),
        };
        if moving.is_empty() {
            return solution;
        }
        let columns = moving.iter();
        let columns = columns.map(|&index| slopes.column(index) / norms[index]);
        let svd = DMatrix::from_columns(&columns.collect::<Vec<DVector<f64>>>()).svd(false, true);
        let Some(v_t) = svd.v_t else {
            return solution;
        };
        // With fewer data than keys some directions have no singular value at all.
        let singular = |k: usize| svd.singular_values.get(k).copied().unwrap_or(0.0);
        let least = SINGULAR * svd.singular_values.amax();
        let (seen, unseen): (Vec<usize>, Vec<usize>) =
            (0..v_t.nrows()).partition(|&k| singular(k) > least);
        solution.rank = seen.len();
        let units = moving.iter().map(|&index| norms[index] * size(index));
        let units: Vec<f64> = units.collect();
        let alike = unseen.iter().map(|&k| alike(&v_t, k, &moving, &units));
        solution.alike = alike.collect();
        let is_known = |place: &usize| unseen.iter().all(|&k| v_t[(k, *place)].abs() <= PART);
        let known = (0..moving.len()).filter(is_known);
        for (i, j) in known
            .clone()
            .flat_map(|i| known.clone().map(move |j| (i, j)))
        {
            let term = |&k: &usize| v_t[(k, i)] * v_t[(k, j)] / singular(k).powi(2);
            let covariance = seen.iter().map(term).sum::<f64>();
            let covariance = covariance / (norms[moving[i]] * norms[moving[j]]);
            solution.covariance[moving[i]][moving[j]] =
                Some(covariance).filter(|covariance| covariance.is_finite());
        }
        solution
    }

    /// One standard uncertainty of the `index`-th key.
    pub fn sigma(&self, index: usize) -> Option<f64> {
        self.covariance[index][index].map(f64::sqrt)
    }

    pub fn correlation(&self, i: usize, j: usize) -> Option<f64> {
        let correlation = self.covariance[i][j]? / (self.sigma(i)? * self.sigma(j)?);
        if i == j {
            Some(1.0)
        } else {
            Some(correlation.clamp(-1.0, 1.0))
        }
    }
}
