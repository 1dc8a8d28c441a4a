//! How well a model fits its data, in numbers.

use super::weights::Weights;
use statrs::function::gamma::checked_gamma_ur;

/// Below this probability a model does not fit; above 1 less this, the uncertainties are too large.
pub(super) const RARE: f64 = 0.01;
/// The fewest degrees of freedom from which the scatter of data without uncertainties says how uncertain they are: with
/// fewer, two data that agree by chance would make the keys as sure as one likes.
pub(super) const LEAST_FREEDOM: u64 = 3;

#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Quality {
    /// The sum of the squared residuals in units of their uncertainties; `None` where none are stated.
    pub chi_squared: Option<f64>,
    /// How many data there are beyond those that the fitted values take up.
    pub degrees_of_freedom: u64,
    /// The probability that a model that is right has so large a chi^2 or a larger one.
    pub probability: Option<f64>,
    /// The scatter of data without uncertainties about the model, in their unit: the root of the sum of the squared residuals
    /// over the degrees of freedom.
    pub scatter: Option<f64>,
}

/// The variance of data without uncertainties, from their scatter (`sum` is the sum of the squared residuals), times the
/// square of Student's factor; `None` where it cannot be stated.
pub(super) fn variance(sum: f64, freedom: u64) -> Option<f64> {
    (freedom >= LEAST_FREEDOM).then(|| sum / freedom as f64 * student(freedom).powi(2))
}

/// Student's factor: an uncertainty made of the scatter of few data is itself uncertain, and times this factor twice of it
/// still holds the truth in 95.45 % of all cases. The expansion of the quantile in 1/`freedom` (M. Abramowitz, I. Stegun,
/// Handbook of Mathematical Functions, 26.7.5), within 0.2 % from three degrees of freedom on.
pub(super) fn student(freedom: u64) -> f64 {
    let x = 1.0 / freedom as f64;
    1.0 + x * (1.25 + x * (1.53125 + x * (1.429_687_5 + x * 0.922_037)))
}

impl Quality {
    /// How well a model fits: `sum` is the sum of the squared residuals in the units of `weights`.
    pub(super) fn of(sum: f64, freedom: u64, weights: &Weights) -> Self {
        let mut quality = Self {
            degrees_of_freedom: freedom,
            ..Self::default()
        };
        if weights.are_stated {
            let probability = checked_gamma_ur(0.5 * freedom as f64, 0.5 * sum).ok();
            let probability = probability.filter(|probability| probability.is_finite());
            quality.chi_squared = Some(sum);
            quality.probability = probability.filter(|_| freedom > 0);
        } else if freedom > 0 {
            let unit = weights.sigma.first().copied().unwrap_or(1.0);
            quality.scatter = Some(sum.sqrt() * unit / (freedom as f64).sqrt());
        }
        quality
    }

    /// Whether the model fits, where that can be said: its chi^2 is not rare. Uncertainties that are too large are no reason
    /// against it.
    pub fn fits(&self) -> Option<bool> {
        self.probability.map(|probability| probability >= RARE)
    }
}
