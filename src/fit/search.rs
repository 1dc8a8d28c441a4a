//! The whole of a fit: from the start values to the minimum, and what the data say there.

use super::free::Free;
use super::levenberg::{self, Bounds, Failure, Minimum, Problem, Stop};
use super::model::{GoOn, Model};
use super::solution::{Quality, SILENT, Solution, variance};
use super::thrown;
use super::weights::Weights;
use crate::cores;
use crate::data::Residual;
use crate::text::number::significant;
use nalgebra::{DMatrix, DVector};
use std::sync::{Mutex, MutexGuard, PoisonError};

#[derive(Clone, Debug)]
pub struct Fit {
    /// The keys with their values, in the order in which they were asked for.
    pub keys: Vec<Fitted>,
    /// What the data say of the keys; its covariances are for the uncertainties of `weights`.
    pub solution: Solution,
    /// Measured less model, one a datum; the uncertainty is that by which it was weighed, `None` where none is stated.
    pub residuals: Vec<Residual>,
    pub quality: Quality,
    pub weights: Weights,
    pub steps: u64,
    /// The factor of the covariances: 1, or for unweighted data (scatter times Student's factor) squared.
    pub variance: Option<f64>,
}

#[derive(Clone, Debug)]
pub struct Fitted {
    /// The key, where the search began, and its bounds.
    pub free: Free,
    pub value: f64,
    /// One standard uncertainty of it; `None` where it cannot be stated.
    pub sigma: Option<f64>,
    /// Whether it is held at a bound, beyond which the fit would be better.
    pub is_held: bool,
}

#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum NoFit {
    #[error(
        "{data} measured {} cannot say {keys} values: free fewer keys, or measure more",
        if *data == 1 { "value" } else { "values" }
    )]
    TooFew { data: usize, keys: usize },
    #[error("the model cannot be held against the data: {0}")]
    Impossible(String),
    #[error(
        "the fit did not converge in {most} steps, the last values are {at}: begin nearer by --set KEY=VALUE, give bounds by --free KEY=FROM..TO, or free fewer keys"
    )]
    TooLong { at: String, most: u64 },
    #[error(
        "the fit got stuck at {0}, where no step makes it better though the slopes say so: begin elsewhere by --set KEY=VALUE, or give bounds by --free KEY=FROM..TO that keep it where the scenario is possible"
    )]
    Stuck(String),
    #[error(
        "the fit did not converge: the weights that the uncertainties of the settings make go on changing; leave their columns out"
    )]
    Unsettled,
    #[error("the fit was ended before it converged")]
    Interrupted,
}

impl From<Stop> for NoFit {
    fn from(stop: Stop) -> Self {
        match stop {
            Stop::Impossible(why) => Self::Impossible(why),
            Stop::Interrupted => Self::Interrupted,
        }
    }
}

/// The change of a key by which slopes are taken, of its size.
const CHANGE: f64 = 1e-4;
/// A change that moves a datum by more than this part of its uncertainty may be too large for a slope.
const LARGE: f64 = 0.5;
/// The part that is aimed at then.
const AIM: f64 = 0.1;
/// How often the weights are computed anew.
const MOST_ROUNDS: u32 = 40;

/// Fits the free keys of `model` to its data. `tell` hears of each step: how many, and chi^2.
pub fn fit(model: &Model, go_on: GoOn<'_>, tell: &(dyn Fn(u64, f64) + Sync)) -> Result<Fit, NoFit> {
    let (data, keys) = (model.data.len(), model.free.len());
    if data < keys {
        return Err(NoFit::TooFew { data, keys });
    }
    let mut p: Vec<f64> = model.free.iter().map(|free| free.start).collect();
    if let Some(nearer) = thrown::start(model, &p) {
        let off = |p: &[f64]| sum_of_squares(model, p, go_on);
        if off(&nearer)? < off(&p)? {
            p = nearer;
        }
    }
    let bounds = model.free.iter().map(|free| (free.from, free.to));
    let bounds: Vec<Bounds> = bounds.collect();
    let mut weights = Weights::at(model, &p, go_on)?;
    let changes = model.free.iter().map(|free| CHANGE * free.scale);
    let changes = Mutex::new(changes.collect::<Vec<f64>>());
    let mut steps = 0;
    for _ in 0..MOST_ROUNDS {
        let weighed = Weighed {
            model,
            weights: &weights,
            changes: &changes,
            go_on,
            tell: &|step, sum| tell(steps + step, sum),
        };
        let minimum = levenberg::search(&weighed, &p, &bounds)?;
        steps += minimum.steps;
        if let Some(failure) = minimum.failure {
            return Err(NoFit::at(model, &minimum.p, failure));
        }
        let Some(next) = weights.renewed(model, &minimum.p, go_on)? else {
            return finished(model, &minimum, weights, steps, go_on);
        };
        p.clone_from(&minimum.p);
        weights = next;
    }
    Err(NoFit::Unsettled)
}

/// How far the data are from the run with these values; infinitely where there is no such run.
fn sum_of_squares(model: &Model, p: &[f64], go_on: GoOn<'_>) -> Result<f64, Stop> {
    match model.values(p, None, go_on) {
        Ok(values) => {
            let residuals = model.residuals(&values);
            Ok(residuals.iter().map(|it| it.value() * it.value()).sum())
        }
        Err(Stop::Impossible(_)) => Ok(f64::INFINITY),
        Err(stop) => Err(stop),
    }
}

impl NoFit {
    /// The search has ended by `failure` at these values of the keys.
    fn at(model: &Model, p: &[f64], failure: Failure) -> Self {
        let pairs = model.free.iter().zip(p);
        let pairs = pairs.map(|(free, value)| format!("{} = {}", free.key, significant(*value, 6)));
        let at = pairs.collect::<Vec<_>>().join(", ");
        match failure {
            Failure::TooManySteps => Self::TooLong {
                at,
                most: levenberg::MOST_STEPS,
            },
            Failure::Stuck => Self::Stuck(at),
        }
    }
}

fn finished(
    model: &Model,
    minimum: &Minimum,
    weights: Weights,
    steps: u64,
    go_on: GoOn<'_>,
) -> Result<Fit, NoFit> {
    let solution = Solution::of(minimum, &model.free);
    let values = model.values(&minimum.p, None, go_on)?;
    let mut residuals = model.residuals(&values);
    for (residual, sigma) in residuals.iter_mut().zip(&weights.sigma) {
        residual.sigma = weights.are_stated.then_some(*sigma);
    }
    let freedom = model.data.len().saturating_sub(solution.rank) as u64;
    let sum = minimum.residuals.norm_squared();
    let quality = Quality::of(sum, freedom, &weights);
    let scattered = || variance(sum, freedom);
    let variance = weights.are_stated.then_some(1.0).or_else(scattered);
    let places = model.free.iter().enumerate();
    let keys = places.map(|(index, free)| Fitted {
        free: free.clone(),
        value: minimum.p[index],
        sigma: solution
            .sigma(index)
            .zip(variance)
            .map(|(sigma, variance)| sigma * variance.sqrt())
            .filter(|sigma| *sigma > 0.0 && sigma.is_finite()),
        is_held: minimum.held[index],
    });
    Ok(Fit {
        keys: keys.collect(),
        solution,
        residuals,
        quality,
        weights,
        steps,
        variance,
    })
}

/// The model with its data weighed, as the search sees it.
struct Weighed<'a> {
    model: &'a Model,
    weights: &'a Weights,
    /// The change of each key by which slopes are taken, in its unit.
    changes: &'a Mutex<Vec<f64>>,
    go_on: GoOn<'a>,
    tell: &'a (dyn Fn(u64, f64) + Sync),
}

impl Weighed<'_> {
    fn kept(&self) -> MutexGuard<'_, Vec<f64>> {
        self.changes.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The change of every datum with the `index`-th key by central differences, as far as the bounds and the scenario
    /// allow, and the change of the key by which it was found.
    fn slope(&self, p: &[f64], index: usize, mut change: f64) -> Result<(Vec<f64>, f64), Stop> {
        /// How often a change that was too large is made smaller.
        const TRIES: u32 = 4;
        for try_ in 0.. {
            let (slope, width) = self.slope_by(p, index, change)?;
            let moved = slope.iter().zip(&self.weights.resolution);
            let most = moved.map(|(slope, size)| (slope * width / size).abs());
            let most = most.fold(0.0, f64::max);
            if most <= LARGE || try_ == TRIES || !most.is_finite() {
                return Ok((slope, change));
            }
            change *= AIM / most;
        }
        Err(Stop::Interrupted) // not reached: the tries are counted
    }

    /// The same by this change, and how far apart the two values of the key were.
    fn slope_by(&self, p: &[f64], index: usize, change: f64) -> Result<(Vec<f64>, f64), Stop> {
        let Free { from, to, .. } = self.model.free[index];
        let at = |value: f64| {
            let mut there = p.to_vec();
            there[index] = value.clamp(from, to);
            let values = self.model.values(&there, None, self.go_on);
            values.map(|values| (there[index], values))
        };
        let (high, low) = (at(p[index] + change), at(p[index] - change));
        let why = match (&high, &low) {
            (Err(Stop::Impossible(why)), _) | (_, Err(Stop::Impossible(why))) => why.clone(),
            _ => "the data depend on digits of it beyond its last one".to_owned(),
        };
        let either = |side: Result<_, Stop>| match side {
            Err(Stop::Impossible(_)) => at(p[index]),
            side => side,
        };
        let ((high, above), (low, below)) = (either(high)?, either(low)?);
        let width = high - low;
        if width == 0.0 {
            return Err(Stop::Impossible(format!(
                "{} can be changed neither up nor down from {}: {why}",
                self.model.free[index].key,
                significant(p[index], 6)
            )));
        }
        let pairs = above.iter().zip(&below);
        let slope = pairs.map(|(above, below)| (above - below) / width);
        Ok((slope.collect(), width))
    }
}

impl Problem for Weighed<'_> {
    fn residuals(&self, p: &[f64]) -> Result<DVector<f64>, Stop> {
        let values = self.model.values(p, None, self.go_on)?;
        let residuals = self.model.residuals(&values);
        let residuals: Vec<f64> = residuals.iter().map(Residual::value).collect();
        let white = self.weights.whitened(&residuals);
        are_numbers(white.norm_squared())?;
        Ok(white)
    }

    fn slopes(&self, p: &[f64]) -> Result<DMatrix<f64>, Stop> {
        let changes = self.kept().clone();
        let of = |(index, change): &(usize, _)| self.slope(p, *index, *change);
        let changes: Vec<_> = changes.into_iter().enumerate().collect();
        let found: Result<Vec<(Vec<f64>, f64)>, Stop> = cores::map(&changes, of);
        let found = found?;
        let column = |(index, (slope, _)): (usize, &(Vec<f64>, f64))| {
            let column = self.weights.whitened(slope);
            // The slope of what does not move is rounding, and would lead anywhere.
            if column.norm() * self.model.free[index].size(p[index]) <= SILENT {
                DVector::zeros(column.len())
            } else {
                column
            }
        };
        let columns: Vec<DVector<f64>> = found.iter().enumerate().map(column).collect();
        *self.kept() = found.iter().map(|(_, change)| *change).collect();
        let slopes = DMatrix::from_columns(&columns);
        // The decomposition of a matrix with a NaN would not end.
        are_numbers(slopes.norm_squared())?;
        Ok(slopes)
    }

    fn tell(&self, step: u64, sum: f64) {
        (self.tell)(step, sum);
    }
}

fn are_numbers(sum: f64) -> Result<(), Stop> {
    if sum.is_finite() {
        return Ok(());
    }
    Err(Stop::Impossible(
        "the residuals in units of their uncertainties are beyond the range of numbers".to_owned(),
    ))
}
