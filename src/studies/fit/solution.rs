//! Results at a minimum: uncertainties and correlations of the keys, indistinguishable keys, and the quality of the
//! fit.

use super::chart::Chart;
use super::free::Free;
use super::levenberg::{Minimum, SINGULAR};
use super::weights::Weights;
use super::within::complement;
use crate::engine::text::number::significant;
use nalgebra::{DMatrix, DVector};

#[derive(Clone, Debug, PartialEq)]
pub struct FitSolution {
    /// Covariances of the keys along the active limits, in their units, for data with uncertainty 1. `None` for a key
    /// that the data do not determine or that is held at a bound.
    pub covariance: Vec<Vec<Option<f64>>>,
    pub rank: usize,
    /// The keys that no datum depends on.
    pub silent: Vec<usize>,
    /// Combinations of keys that change no datum. Each lists the keys by index with their changes, the largest of which
    /// is 1.
    ///
    /// A change is relative to the key's value, or to [`Free::scale`](super::free::Free::scale) if the value is 0.
    pub alike: Vec<Vec<(usize, f64)>>,
    /// True for each key that can change the data while the active limits hold.
    pub is_moving: Vec<bool>,
}

/// A key has no effect if a change by its own size moves the data by less than this fraction of their uncertainty.
pub(super) const SILENT_KEY: f64 = 1e-5;
/// Components of a combination below this are rounding error.
pub(super) const COMBINATION_ROUNDING: f64 = 1e-2;
/// A key's component of a direction is rounding error below this.
const ROUNDING: f64 = 1e-9;

/// Returns the combination of keys along `direction`, for keys in `units`: the keys involved and their changes,
/// scaled so that the largest is 1.
fn alike(direction: &DVector<f64>, moving: &[usize], units: &[f64]) -> Vec<(usize, f64)> {
    let parts: Vec<f64> = direction
        .iter()
        .zip(units)
        .map(|(direction, unit)| direction / unit)
        .collect();
    // Of equal components, the first counts.
    let sizes = parts.iter().copied().rev();
    let largest = sizes
        .max_by(|a, b| a.abs().total_cmp(&b.abs()))
        .unwrap_or_default();
    let places = (0..moving.len()).filter(|&place| direction[place].abs() > COMBINATION_ROUNDING);
    let combined = places.map(|place| (moving[place], parts[place] / largest));
    combined.collect()
}

/// A direction of the keys along the active limits, for keys in units in which the slope of each is 1.
struct KeyDirection {
    singular: f64,
    parts: DVector<f64>,
}

/// Returns the directions in which the keys can move along the active limits.
fn singular_directions(slopes: &DMatrix<f64>, normals: &[DVector<f64>]) -> Vec<KeyDirection> {
    let free = complement(normals.iter(), slopes.ncols());
    if free.is_empty() {
        return Vec::new();
    }
    let svd = (slopes * &free).svd(false, true);
    let Some(v_t) = svd.v_t else {
        return Vec::new();
    };
    (0..v_t.nrows())
        .map(|k| KeyDirection {
            // With fewer data than keys, some directions have no singular value.
            singular: svd.singular_values.get(k).copied().unwrap_or(0.0),
            parts: &free * v_t.row(k).transpose(),
        })
        .collect()
}

impl FitSolution {
    pub fn new(minimum: &Minimum, chart: &Chart, free: &[Free]) -> Self {
        let slopes = &minimum.slopes * &chart.matrix;
        let keys = chart.keys(&minimum.p);
        let norms: Vec<f64> = slopes.column_iter().map(|column| column.norm()).collect();
        let all_units: Vec<f64> = (0..free.len())
            .map(|index| norms[index] * free[index].size(keys[index]))
            .collect();
        let (silent, effective): (Vec<usize>, Vec<usize>) =
            (0..free.len()).partition(|index| all_units[*index] <= SILENT_KEY);
        let mut solution = Self {
            covariance: vec![vec![None; free.len()]; free.len()],
            rank: 0,
            silent,
            alike: Vec::new(),
            is_moving: vec![false; free.len()],
        };
        if effective.is_empty() {
            return solution;
        }
        let columns: Vec<DVector<f64>> = effective
            .iter()
            .map(|&index| slopes.column(index) / norms[index])
            .collect();
        let normals: Vec<DVector<f64>> = minimum
            .held
            .iter()
            .map(|&place| {
                let normal = chart.matrix.tr_mul(&chart.limits[place].normal);
                let parts = effective.iter().map(|&index| normal[index] / norms[index]);
                DVector::from_iterator(effective.len(), parts)
            })
            .collect();
        let directions = singular_directions(&DMatrix::from_columns(&columns), &normals);
        let largest = directions
            .iter()
            .map(|direction| direction.singular)
            .fold(0.0, f64::max);
        let (seen, unseen): (Vec<&KeyDirection>, Vec<&KeyDirection>) =
            (directions.iter()).partition(|direction| direction.singular > SINGULAR * largest);
        solution.rank = seen.len();
        let units: Vec<f64> = effective.iter().map(|&index| all_units[index]).collect();
        let alike = unseen
            .iter()
            .map(|direction| alike(&direction.parts, &effective, &units));
        solution.alike = alike.collect();
        for (place, &index) in effective.iter().enumerate() {
            solution.is_moving[index] = directions
                .iter()
                .any(|direction| direction.parts[place].abs() > ROUNDING);
        }
        let known: Vec<usize> = (0..effective.len())
            .filter(|place| {
                solution.is_moving[effective[*place]]
                    && unseen
                        .iter()
                        .all(|direction| direction.parts[*place].abs() <= COMBINATION_ROUNDING)
            })
            .collect();
        for (&i, &j) in known.iter().flat_map(|i| known.iter().map(move |j| (i, j))) {
            let sum: f64 = seen
                .iter()
                .map(|direction| {
                    direction.parts[i] * direction.parts[j] / direction.singular.powi(2)
                })
                .sum();
            let covariance = sum / (norms[effective[i]] * norms[effective[j]]);
            solution.covariance[effective[i]][effective[j]] =
                Some(covariance).filter(|covariance| covariance.is_finite());
        }
        solution
    }

    /// Returns one standard uncertainty of the `index`-th key.
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

/// A model whose probability is below this does not fit. Above 1 minus this, the stated uncertainties are too large.
pub(super) const RARE: f64 = 0.01;
/// Minimum degrees of freedom for estimating uncertainties from the scatter of the data. With fewer, two data that
/// agree by chance would make the keys look far too certain.
pub(super) const LEAST_FREEDOM: u64 = 3;

#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Quality {
    /// The sum of the squared residuals in units of their uncertainties; `None` if none are stated.
    pub chi_squared: Option<f64>,
    /// The number of data minus the number of fitted values that they determine.
    pub degrees_of_freedom: u64,
    /// The probability of this chi^2 or a larger one if the model is right.
    pub probability: Option<f64>,
    /// The scatter of data without uncertainties about the model, in their unit: the root of the sum of the squared
    /// residuals divided by the degrees of freedom.
    pub scatter: Option<f64>,
}

/// Returns the variance of data without uncertainties, from their scatter, times the square of Student's factor. `sum`
/// is the sum of the squared residuals. Returns `None` if there are too few degrees of freedom.
pub(super) fn scatter_variance(sum: f64, freedom: u64) -> Option<f64> {
    (freedom >= LEAST_FREEDOM).then(|| sum / freedom as f64 * student(freedom).powi(2))
}

/// Returns Student's factor for `freedom` degrees of freedom.
///
/// An uncertainty estimated from the scatter of few data is itself uncertain. Multiplied by this factor, twice the
/// uncertainty contains the true value in 95.45 % of all cases.
///
/// The formula is the expansion of the quantile in 1/`freedom` (M. Abramowitz, I. Stegun, Handbook of Mathematical
/// Functions, 26.7.5). It is accurate to 0.2 % from three degrees of freedom on.
pub fn student(freedom: u64) -> f64 {
    let x = 1.0 / freedom as f64;
    1.0 + x * (1.25 + x * (1.53125 + x * (1.429_687_5 + x * 0.922_037)))
}

/// Computes the probability that chi^2 with `freedom` degrees of freedom is at least `chi_squared` (M. Abramowitz, I.
/// Stegun, Handbook of Mathematical Functions, 26.4.4 and 26.4.5).
fn at_least(chi_squared: f64, freedom: u64) -> f64 {
    let half = 0.5 * chi_squared;
    if half == 0.0 {
        return 1.0;
    }
    let (begin, first) = match freedom % 2 {
        0 => (0.0, 0.0),
        _ => (0.5, libm::erfc(half.sqrt())),
    };
    first
        + (0..freedom / 2)
            .map(|index: u64| {
                let power = begin + index as f64;
                libm::exp(power * libm::log(half) - half - libm::lgamma(power + 1.0))
            })
            .sum::<f64>()
}

/// Returns a remark on the stated uncertainties if chi^2 is improbably small for `freedom` degrees of freedom.
pub fn too_large(chi_squared: f64, freedom: u64) -> Option<String> {
    let is_rare = freedom > 0 && chi_squared > 0.0 && at_least(chi_squared, freedom) > 1.0 - RARE;
    is_rare.then(|| {
        let times = significant((freedom as f64 / chi_squared).sqrt(), 2);
        format!("the uncertainties given look too large: by their scatter the data are about {times} times as good as stated")
    })
}

impl Quality {
    /// Computes the quality of a fit. `sum` is the sum of the squared residuals in the units of `weights`.
    pub(super) fn new(sum: f64, freedom: u64, weights: &Weights) -> Self {
        let mut quality = Self {
            degrees_of_freedom: freedom,
            ..Self::default()
        };
        if weights.are_stated {
            let probability = (freedom > 0).then(|| at_least(sum, freedom));
            quality.chi_squared = Some(sum);
            quality.probability = probability.filter(|probability| probability.is_finite());
        } else if freedom > 0 {
            let unit = weights.sigma.first().copied().unwrap_or(1.0);
            quality.scatter = Some(sum.sqrt() * unit / (freedom as f64).sqrt());
        }
        quality
    }

    /// Returns true if the model fits: its chi^2 is not improbably large. Returns `None` if this cannot be decided. Too
    /// large uncertainties do not count against the model.
    pub fn fits(&self) -> Option<bool> {
        self.probability.map(|probability| probability >= RARE)
    }
}

#[cfg(test)]
mod tests {
    use super::at_least;

    #[test]
    fn chi_squared_probabilities_match_the_tables() {
        // Values from the tables, at 5 %, 5 %, 1 %, 95 % and 50 %.
        let rows = [
            (3.841_458_821, 1, 0.05),
            (5.991_464_547, 2, 0.05),
            (24.724_970_311, 11, 0.01),
            (3.940_299_136, 10, 0.95),
            (99.334_129_24, 100, 0.5),
        ];
        for (chi_squared, freedom, expected) in rows {
            let found = at_least(chi_squared, freedom);
            assert!((found - expected).abs() < 1e-9, "{freedom}: {found}");
        }
        assert_eq!(at_least(0.0, 7), 1.0);
        assert!((at_least(1e6, 1_000_000) - 0.4998).abs() < 1e-3);
        assert!(at_least(f64::NAN, 4).is_nan());
    }
}
