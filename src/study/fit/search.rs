//! The whole of a fit: from the start values to the minimum, and what the data say there.

use super::free::Free;
use super::levenberg::{self, Bounds, Failure, Minimum, Problem, Stop};
use super::model::Model;
use super::quality::{self, Quality};
use super::solution::{SILENT, Solution};
use super::weights::Weights;
use crate::cores;
use crate::measured::Residual;
use crate::text::number::significant;
use nalgebra::{DMatrix, DVector};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// A fit that has found its minimum.
#[derive(Clone, Debug)]
pub struct Fit {
    /// The keys with their values, in the order in which they were asked for.
    pub keys: Vec<Fitted>,
    /// What the data say of the keys; its covariances are for the uncertainties of `weights`.
    pub solution: Solution,
    /// Measured less model, one a datum; the uncertainty is that by which it was weighed, `None` where none is stated.
    pub residuals: Vec<Residual>,
    /// How well the model fits.
    pub quality: Quality,
    /// What the data were weighed by.
    pub weights: Weights,
    /// How many steps the search took.
    pub steps: u64,
    /// By what the covariances are multiplied: 1, or of unweighted data the square of their scatter times that of
    /// Student's factor.
    pub variance: Option<f64>,
}

/// A key and what was found for it.
#[derive(Clone, Debug)]
pub struct Fitted {
    /// The key, where the search began, and its bounds.
    pub free: Free,
    /// Its value at the minimum.
    pub value: f64,
    /// One standard uncertainty of it; `None` where it cannot be stated.
    pub sigma: Option<f64>,
    /// Whether it is held at a bound, beyond which the fit would be better.
    pub is_held: bool,
}

/// Why there is no fit.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum NoFit {
    /// There are fewer data than keys.
    #[error(
        "{data} measured {} cannot say {keys} values: free fewer keys, or measure more",
        if *data == 1 { "value" } else { "values" }
    )]
    TooFew {
        /// How many values were measured.
        data: usize,
        /// How many keys are free.
        keys: usize,
    },
    /// The model has nothing to say.
    #[error("the model cannot be held against the data: {0}")]
    Impossible(String),
    /// The search took too many steps.
    #[error(
        "the fit did not converge in {most} steps, the last values are {at}: begin nearer by --set KEY=VALUE, give bounds by --free KEY=FROM..TO, or free fewer keys"
    )]
    TooLong {
        /// The keys with their last values.
        at: String,
        /// How many.
        most: u64,
    },
    /// No step made it better, though one should.
    #[error(
        "the fit got stuck at {0}, where no step makes it better though the slopes say so: begin elsewhere by --set KEY=VALUE, or give bounds by --free KEY=FROM..TO that keep it where the scenario is possible"
    )]
    Stuck(String),
    /// The uncertainties that the settings make do not settle.
    #[error(
        "the fit did not converge: the weights that the uncertainties of the settings make go on changing; leave their columns out"
    )]
    Unsettled,
    /// Somebody ended it.
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
/// A change that moves a datum by more than this part of its uncertainty may be too large for a slope, and one that moves it by
/// this is aimed at then.
const LARGE: f64 = 0.5;
const AIM: f64 = 0.1;
/// How often the weights are computed anew, and the change at which they have settled.
const MOST_ROUNDS: u32 = 40;
const SETTLED: f64 = 1e-7;

/// Fits the free keys of `model` to its data. `tell` hears of each step: how many, and chi^2.
///
/// # Errors
/// When there are too few data, no runs, no minimum is found, or `go_on` says no.
pub fn fit(
    model: &Model,
    go_on: &(dyn Fn() -> bool + Sync),
    tell: &dyn Fn(u64, f64),
) -> Result<Fit, NoFit> {
    let (data, keys) = (model.data.len(), model.free.len());
    if data < keys {
        return Err(NoFit::TooFew { data, keys });
    }
    let mut p: Vec<f64> = model.free.iter().map(|free| free.start).collect();
    let bounds: Vec<Bounds> = model
        .free
        .iter()
        .map(|free| Bounds {
            from: free.from,
            to: free.to,
        })
        .collect();
    let mut weights = Weights::at(model, &p, go_on)?;
    let changes = model.free.iter().map(|free| CHANGE * free.scale);
    let changes = Mutex::new(changes.collect::<Vec<f64>>());
    let mut steps = 0;
    for _ in 0..MOST_ROUNDS {
        let weighed = Weighed {
            model,
            weights: &weights,
            bounds: &bounds,
            changes: &changes,
            go_on,
            tell: &|step, sum| tell(steps + step, sum),
        };
        let minimum = levenberg::search(&weighed, &p, &bounds)?;
        steps += minimum.steps;
        if let Some(failure) = minimum.failure {
            let at = told(model, &minimum.p);
            return Err(match failure {
                Failure::TooManySteps => NoFit::TooLong {
                    at,
                    most: levenberg::MOST_STEPS,
                },
                Failure::Stuck => NoFit::Stuck(at),
            });
        }
        if !weights.count_settings {
            return finished(model, &minimum, weights, steps, go_on);
        }
        let next = Weights::at(model, &minimum.p, go_on)?;
        let change = next.change_from(&weights);
        p.clone_from(&minimum.p);
        if change <= SETTLED {
            return finished(model, &minimum, weights, steps, go_on);
        }
        weights = next;
    }
    Err(NoFit::Unsettled)
}

/// The keys with these values, as they are told.
fn told(model: &Model, p: &[f64]) -> String {
    let pairs = model.free.iter().zip(p);
    let pairs = pairs.map(|(free, value)| format!("{} = {}", free.key, significant(*value, 6)));
    pairs.collect::<Vec<_>>().join(", ")
}

/// What the data say at `minimum`.
fn finished(
    model: &Model,
    minimum: &Minimum,
    weights: Weights,
    steps: u64,
    go_on: &(dyn Fn() -> bool + Sync),
) -> Result<Fit, NoFit> {
    let solution = Solution::of(minimum, &model.free);
    let values = model.values(&minimum.p, go_on)?;
    let mut residuals = model.residuals(&values);
    for (residual, sigma) in residuals.iter_mut().zip(&weights.sigma) {
        residual.sigma = weights.are_stated.then_some(*sigma);
    }
    let freedom = model.data.len().saturating_sub(solution.rank) as u64;
    let sum = minimum.residuals.norm_squared();
    let quality = if weights.are_stated {
        Quality::weighted(sum, freedom, &residuals)
    } else {
        let unit = weights.sigma.first().copied().unwrap_or(1.0);
        Quality::unweighted(sum.sqrt() * unit, freedom)
    };
    let scattered = || quality::variance(sum, freedom);
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
    bounds: &'a [Bounds],
    /// The change of each key by which slopes are taken, in its unit.
    changes: &'a Mutex<Vec<f64>>,
    go_on: &'a (dyn Fn() -> bool + Sync),
    tell: &'a dyn Fn(u64, f64),
}

impl Weighed<'_> {
    fn kept(&self) -> MutexGuard<'_, Vec<f64>> {
        self.changes.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Problem for Weighed<'_> {
    fn residuals(&self, p: &[f64]) -> Result<DVector<f64>, Stop> {
        let values = self.model.values(p, self.go_on)?;
        let residuals = self.model.residuals(&values);
        let residuals: Vec<f64> = residuals.iter().map(Residual::value).collect();
        let white = self.weights.whitened(&residuals);
        if white.norm_squared().is_finite() {
            Ok(white)
        } else {
            Err(beyond())
        }
    }

    fn slopes(&self, p: &[f64]) -> Result<DMatrix<f64>, Stop> {
        let changes = self.kept().clone();
        let slopes = Slopes {
            model: self.model,
            resolution: &self.weights.resolution,
            bounds: self.bounds,
            go_on: self.go_on,
        };
        let of = |(index, change): &(usize, _)| slopes.of(p, *index, *change);
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
        if slopes.norm_squared().is_finite() {
            Ok(slopes)
        } else {
            Err(beyond())
        }
    }

    fn tell(&self, step: u64, sum: f64) {
        (self.tell)(step, sum);
    }
}

fn beyond() -> Stop {
    Stop::Impossible(
        "the residuals in units of their uncertainties are beyond the range of numbers".to_owned(),
    )
}

/// Slopes by central differences, as far as the bounds and the scenario allow.
struct Slopes<'a> {
    model: &'a Model,
    resolution: &'a [f64],
    bounds: &'a [Bounds],
    go_on: &'a (dyn Fn() -> bool + Sync),
}

impl Slopes<'_> {
    /// The change of every datum with the `index`-th key, and the change of the key by which it was found.
    fn of(&self, p: &[f64], index: usize, mut change: f64) -> Result<(Vec<f64>, f64), Stop> {
        /// How often a change that was too large is made smaller.
        const TRIES: u32 = 4;
        for try_ in 0.. {
            let (slope, width) = self.by(p, index, change)?;
            let moved = slope.iter().zip(self.resolution);
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
    fn by(&self, p: &[f64], index: usize, change: f64) -> Result<(Vec<f64>, f64), Stop> {
        let Bounds { from, to } = self.bounds[index];
        let at = |value: f64| {
            let mut there = p.to_vec();
            there[index] = value.clamp(from, to);
            let values = self.model.values(&there, self.go_on);
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
        Ok((
            pairs
                .map(|(above, below)| (above - below) / width)
                .collect(),
            width,
        ))
    }
}
