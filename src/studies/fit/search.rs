//! The complete fit: from the start values to the minimum, and the results there.

use super::chart::Chart;
use super::edge::{Edge, edges_at};
use super::fitted::{Fitted, Sides};
use super::levenberg::{self, Failure, LeastSquares, Minimum, Stop};
use super::model::{FitProgress, Model};
use super::solution::{FitSolution, Quality, SILENT_KEY, scatter_variance};
use super::thrown;
use super::weights::Weights;
use super::within::Limit;
use crate::engine::cores;
use crate::engine::data::Residual;
use crate::engine::text::number::significant;
use nalgebra::{DMatrix, DVector};
use std::sync::{Mutex, MutexGuard, PoisonError};

#[derive(Clone, Debug)]
pub struct Fit {
    /// The keys with their values, in the order requested.
    pub keys: Vec<Fitted>,
    /// Uncertainties and correlations of the keys. Its covariances assume the uncertainties in `weights`.
    pub solution: FitSolution,
    /// Measured minus model, one per datum, with the uncertainty that weighted it; `None` without stated uncertainties.
    pub residuals: Vec<Residual>,
    pub quality: Quality,
    pub weights: Weights,
    pub steps: u64,
    /// Factor of the covariances: 1, or for unweighted data (scatter times Student's factor) squared.
    pub variance: Option<f64>,
    /// The active limits.
    pub edges: Vec<Edge>,
}

#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum NoFit {
    #[error(
        "{data} measured {} cannot determine {keys} keys: free fewer keys, or measure more",
        if *data == 1 { "value" } else { "values" }
    )]
    TooFew { data: usize, keys: usize },
    #[error("the model cannot be compared with the data: {0}")]
    Impossible(String),
    #[error(
        "the fit did not converge in {most} steps; the last values are {at}: start closer with --set KEY=VALUE, set bounds with --free KEY=FROM..TO, or free fewer keys"
    )]
    TooLong { at: String, most: u64 },
    #[error(
        "the fit got stuck at {0}: no step improves it, although its slopes predict that one should; start elsewhere with --set KEY=VALUE, or set bounds with --free KEY=FROM..TO within which the scenario is possible"
    )]
    Stuck(String),
    #[error(
        "the fit did not converge: the weights keep changing with the uncertainties of the settings; remove the columns of these uncertainties"
    )]
    Unsettled,
    #[error("the fit was interrupted before it converged")]
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

/// Change of a key for computing slopes, relative to its size.
const SLOPE_CHANGE: f64 = 1e-4;
/// A change that moves a datum by more than this fraction of its uncertainty may be too large for a slope.
const LARGE_SLOPE_CHANGE: f64 = 0.5;
/// The fraction to aim at then.
const TARGET_SLOPE_EFFECT: f64 = 0.1;
/// Maximum change as a fraction of the distance to a limit that is not yet reached: near it the data may bend.
const LIMIT_FRACTION: f64 = 1e-3;
/// A limit closer than this fraction of a change counts as reached.
const REACHED_FRACTION: f64 = 1e-4;
/// Maximum number of start points.
const MOST_STARTS: usize = 4;
/// Maximum number of times the weights are recomputed.
const MOST_ROUNDS: u32 = 40;

/// Fits the free keys of `model` to its data. `on_step` is called at each step with the number of steps and chi^2.
pub fn fit(
    model: &Model,
    go_on: FitProgress<'_>,
    on_step: &(dyn Fn(u64, f64) + Sync),
) -> Result<Fit, NoFit> {
    let (data, keys) = (model.data.len(), model.free.len());
    if data < keys {
        return Err(NoFit::TooFew { data, keys });
    }
    let own: Vec<f64> = model.free.iter().map(|free| free.start).collect();
    let scenario = model.scenario(&own).map_err(Stop::Impossible)?;
    let chart = Chart::new(&model.free, &scenario);
    let mut first_failure = None;
    for start in starts(model, &chart, own, go_on)? {
        match fit_from(model, &chart, start, go_on, on_step) {
            Err(failure @ (NoFit::Stuck(_) | NoFit::TooLong { .. })) => {
                first_failure.get_or_insert(failure);
            }
            ended => return ended,
        }
    }
    Err(first_failure.unwrap_or(NoFit::Interrupted))
}

/// Returns the start points to try in turn, closest to the data first.
fn starts(
    model: &Model,
    chart: &Chart,
    own: Vec<f64>,
    go_on: FitProgress<'_>,
) -> Result<Vec<Vec<f64>>, Stop> {
    let of_flight = thrown::starts(model, &own);
    let mut all = vec![own];
    all.extend(of_flight.into_iter().filter(|start| chart.holds(start)));
    if all.len() == 1 {
        return Ok(all);
    }
    let mut summed = Vec::with_capacity(all.len());
    for start in all {
        summed.push((sum_of_squares(model, &start, go_on)?, start));
    }
    summed.sort_by(|a, b| a.0.total_cmp(&b.0));
    let nearest = summed.into_iter().take(MOST_STARTS);
    Ok(nearest.map(|(_, start)| start).collect())
}

fn fit_from(
    model: &Model,
    chart: &Chart,
    mut p: Vec<f64>,
    go_on: FitProgress<'_>,
    on_step: &(dyn Fn(u64, f64) + Sync),
) -> Result<Fit, NoFit> {
    let mut weights = Weights::at(model, &p, go_on)?;
    let changes = Mutex::new(
        model
            .free
            .iter()
            .map(|free| SLOPE_CHANGE * free.scale)
            .collect::<Vec<f64>>(),
    );
    let mut steps = 0;
    for _ in 0..MOST_ROUNDS {
        let start = chart.parameters(&p);
        let limits = chart.limits_around(&start);
        let weighed = Weighed {
            model,
            chart,
            limits: &limits,
            weights: &weights,
            changes: &changes,
            go_on,
            on_step: &|step, sum| on_step(steps + step, sum),
        };
        let minimum = levenberg::search(&weighed, &start, &limits)?;
        steps += minimum.steps;
        p = chart.keys(&minimum.p);
        if let Some(failure) = minimum.failure {
            return Err(NoFit::at(model, &p, failure));
        }
        let Some(next) = weights.renewed(model, &p, go_on)? else {
            return finished(model, &minimum, chart, weights, steps, go_on);
        };
        weights = next;
    }
    Err(NoFit::Unsettled)
}

/// Returns the sum of squared residuals at `p`; infinity if that run is impossible.
fn sum_of_squares(model: &Model, p: &[f64], go_on: FitProgress<'_>) -> Result<f64, Stop> {
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
    /// Creates the error for a search that ended with `failure` at these values of the keys.
    fn at(model: &Model, p: &[f64], failure: Failure) -> Self {
        let pairs = model
            .free
            .iter()
            .zip(p)
            .map(|(free, value)| format!("{} = {}", free.key, significant(*value, 6)));
        let at = pairs.collect::<Vec<_>>().join(", ");
        match failure {
            Failure::TooManySteps => Self::TooLong {
                at,
                most: levenberg::MOST_ITERATIONS,
            },
            Failure::Stuck => Self::Stuck(at),
        }
    }
}

fn finished(
    model: &Model,
    minimum: &Minimum,
    chart: &Chart,
    weights: Weights,
    steps: u64,
    go_on: FitProgress<'_>,
) -> Result<Fit, NoFit> {
    let p = chart.keys(&minimum.p);
    let solution = FitSolution::new(minimum, chart, &model.free);
    let values = model.values(&p, None, go_on)?;
    let mut residuals = model.residuals(&values);
    for (residual, sigma) in residuals.iter_mut().zip(&weights.sigma) {
        residual.sigma = weights.are_stated.then_some(*sigma);
    }
    let freedom = model.data.len().saturating_sub(solution.rank) as u64;
    let sum = minimum.residuals.norm_squared();
    let quality = Quality::new(sum, freedom, &weights);
    let variance = if weights.are_stated {
        Some(1.0)
    } else {
        scatter_variance(sum, freedom)
    };
    let edges = edges_at(minimum, chart, &model.free, variance);
    let places = model.free.iter().enumerate();
    let keys = places.map(|(index, free)| {
        let sides = sides_of(index, p[index], &solution, &edges, variance);
        Fitted {
            free: free.clone(),
            value: p[index],
            sigma: sides.map(|sides| sides.below.max(sides.above)),
            sides,
            is_held: edges.iter().any(|edge| edge.holds[index]),
        }
    });
    Ok(Fit {
        keys: keys.collect(),
        solution,
        residuals,
        quality,
        weights,
        steps,
        variance,
        edges,
    })
}

/// Returns the uncertainties of a key: those along the active limits, combined with the allowed distance inside each
/// limit.
fn sides_of(
    index: usize,
    value: f64,
    solution: &FitSolution,
    edges: &[Edge],
    variance: Option<f64>,
) -> Option<Sides> {
    let along = solution
        .sigma(index)
        .zip(variance)
        .map(|(sigma, factor)| sigma * factor.sqrt());
    let mut squares = [along.unwrap_or(0.0).powi(2); 2];
    let is_unknown = along.is_none() && solution.is_moving[index]
        || edges
            .iter()
            .any(|edge| edge.is_of_nature && edge.most.is_none() && edge.holds[index]);
    let of_part = edges
        .iter()
        .filter(|edge| edge.holds[index] && edge.of_part().is_some());
    let is_corner = of_part.count() > 1;
    for edge in edges {
        let moved = edge.most.map_or(0.0, |most| most.at_68 * edge.moves[index]);
        squares[usize::from(moved > 0.0)] += moved * moved;
    }
    let [below, above] = squares.map(f64::sqrt);
    // Inside a corner of limits, a key may move either way.
    let most = below.max(above);
    let [below, above] = if is_corner { [most; 2] } else { [below, above] };
    let is_rounding = most <= f64::EPSILON * value.abs();
    let is_stated = !is_unknown && !is_rounding && most > 0.0 && most.is_finite();
    is_stated.then_some(Sides { below, above })
}

/// The model with weighted data, as a problem for the search.
struct Weighed<'a> {
    model: &'a Model,
    chart: &'a Chart,
    limits: &'a [Limit],
    weights: &'a Weights,
    /// Change of each parameter for computing slopes, in the parameter's unit.
    changes: &'a Mutex<Vec<f64>>,
    go_on: FitProgress<'a>,
    on_step: &'a (dyn Fn(u64, f64) + Sync),
}

impl Weighed<'_> {
    fn lock_changes(&self) -> MutexGuard<'_, Vec<f64>> {
        self.changes.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn values(&self, p: &[f64]) -> Result<Vec<f64>, Stop> {
        self.model.values(&self.chart.keys(p), None, self.go_on)
    }

    /// Returns the lowest and highest value that the `index`-th parameter can have at `p`, the others fixed.
    ///
    /// Limits that involve several parameters are left to the scenario, which rejects impossible values. A parameter
    /// never gets stuck at a bound set by the user.
    fn ends(&self, p: &[f64], index: usize) -> (f64, f64) {
        let (mut from, mut to) = (f64::NEG_INFINITY, f64::INFINITY);
        for limit in self.limits.iter().filter(|it| it.only() == Some(index)) {
            let edge = p[index] - limit.room(p) / limit.normal[index];
            if limit.normal[index] > 0.0 {
                from = from.max(edge);
            } else {
                to = to.min(edge);
            }
        }
        (from, to)
    }

    /// Returns `change` of the `index`-th parameter from `p`, or a smaller change if a limit is near.
    fn before_limits(&self, p: &[f64], index: usize, change: f64) -> f64 {
        let distances = self
            .limits
            .iter()
            .map(|limit| limit.room(p) / limit.normal[index].abs());
        let near = distances.filter(|distance| *distance > REACHED_FRACTION * change);
        near.fold(change, |change, distance| {
            change.min(LIMIT_FRACTION * distance)
        })
    }

    /// Returns the slope of every datum along the `index`-th parameter, and the change that it was computed with.
    ///
    /// The differences are central, as far as the limits and the scenario allow.
    fn slope(&self, p: &[f64], index: usize, mut change: f64) -> Result<(Vec<f64>, f64), Stop> {
        /// How often a too large change is reduced.
        const TRIES: u32 = 4;
        for try_ in 0.. {
            let near = self.before_limits(p, index, change);
            let (slope, width) = self.slope_by(p, index, near)?;
            let moved = slope.iter().zip(&self.weights.resolution);
            let most = moved
                .map(|(steepness, size)| (steepness * width / size).abs())
                .fold(0.0, f64::max);
            if most <= LARGE_SLOPE_CHANGE || try_ == TRIES || !most.is_finite() {
                return Ok((slope, change));
            }
            change *= TARGET_SLOPE_EFFECT / most;
        }
        Err(Stop::Interrupted) // not reached: the tries are counted
    }

    /// Returns the slopes computed with `change`, and the distance between the two values of the parameter.
    fn slope_by(&self, p: &[f64], index: usize, change: f64) -> Result<(Vec<f64>, f64), Stop> {
        let ends = [change, -change].map(|by| self.values_at(p, index, p[index] + by));
        let why = match &ends {
            [Err(Stop::Impossible(why)), _] | [_, Err(Stop::Impossible(why))] => why.clone(),
            _ => "the change is smaller than the last digit of the value".to_owned(),
        };
        let [upper, lower] = ends.map(|side| match side {
            Err(Stop::Impossible(_)) => self.values_at(p, index, p[index]),
            side => side,
        });
        let ((high, above), (low, below)) = (upper?, lower?);
        let width = high - low;
        if width == 0.0 {
            return Err(Stop::Impossible(format!(
                "{} can be changed neither up nor down from {}: {why}",
                self.model.free[index].key,
                significant(self.chart.keys(p)[index], 6)
            )));
        }
        let pairs = above.iter().zip(&below);
        let slope = pairs.map(|(up, down)| (up - down) / width);
        Ok((slope.collect(), width))
    }

    /// Computes the values with parameter `index` as close to `value` as its bounds allow. Returns the value used, too.
    fn values_at(&self, p: &[f64], index: usize, value: f64) -> Result<(f64, Vec<f64>), Stop> {
        let (from, to) = self.ends(p, index);
        let mut there = p.to_vec();
        there[index] = value.max(from).min(to);
        Ok((there[index], self.values(&there)?))
    }
}

impl LeastSquares for Weighed<'_> {
    fn residuals(&self, p: &[f64]) -> Result<DVector<f64>, Stop> {
        let residuals: Vec<f64> = self
            .model
            .residuals(&self.values(p)?)
            .iter()
            .map(Residual::value)
            .collect();
        let white = self.weights.whitened(&residuals);
        are_numbers(white.norm_squared())?;
        Ok(white)
    }

    fn slopes(&self, p: &[f64]) -> Result<DMatrix<f64>, Stop> {
        let changes: Vec<(usize, f64)> = self.lock_changes().iter().copied().enumerate().collect();
        let found: Vec<(Vec<f64>, f64)> =
            cores::map::<_, _, Result<_, Stop>>(&changes, |(index, change)| {
                self.slope(p, *index, *change)
            })?;
        let keys = self.chart.keys(p);
        let columns: Vec<DVector<f64>> = found
            .iter()
            .enumerate()
            .map(|(index, (slope, _)): (usize, &(Vec<f64>, f64))| {
                let whitened = self.weights.whitened(slope);
                // A slope without effect is rounding error and would lead anywhere.
                if whitened.norm() * self.model.free[index].size(keys[index]) <= SILENT_KEY {
                    DVector::zeros(whitened.len())
                } else {
                    whitened
                }
            })
            .collect();
        *self.lock_changes() = found.iter().map(|(_, change)| *change).collect();
        let slopes = DMatrix::from_columns(&columns);
        // The decomposition of a matrix that contains a NaN would never end.
        are_numbers(slopes.norm_squared())?;
        Ok(slopes)
    }

    fn on_iteration(&self, step: u64, sum: f64) {
        (self.on_step)(step, sum);
    }
}

fn are_numbers(sum: f64) -> Result<(), Stop> {
    if sum.is_finite() {
        return Ok(());
    }
    Err(Stop::Impossible(
        "the residuals, in units of their uncertainties, are too large for floating-point numbers"
            .to_owned(),
    ))
}
