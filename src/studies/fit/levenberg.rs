//! The search for the minimum sum of squares: the method of Levenberg and Marquardt, within limits.
//!
//! Sources: D. W. Marquardt, J. Soc. Indust. Appl. Math. 11, 431 (1963). J. J. Moré, Lecture Notes in Mathematics 630,
//! 105 (1978), for the scaling of the parameters, which never shrinks. H. B. Nielsen, Damping parameter in Marquardt's
//! method, IMM-REP-1999-05, Technical University of Denmark (1999), for the damping.
//!
//! Each step solves the linear least-squares problem [`within`](super::within) the limits of the parameters. The crate
//! levenberg-marquardt has this method too, but it needs another version of nalgebra and has no limits.

use super::within::{Limit, complement, least_squares};
use nalgebra::{DMatrix, DVector};

/// A problem whose sum of squares is minimized.
pub trait LeastSquares {
    /// Computes the residuals r at `p`, in units in which a standard uncertainty is 1.
    fn residuals(&self, p: &[f64]) -> Result<DVector<f64>, Stop>;

    /// Computes −∂r/∂p at `p`, one column per parameter.
    fn slopes(&self, p: &[f64]) -> Result<DMatrix<f64>, Stop>;

    /// Called after each step, with the number of steps and the sum of squares.
    fn on_iteration(&self, step: u64, sum: f64);
}

#[derive(Clone, Debug, PartialEq)]
pub enum Stop {
    /// The run is impossible, or it does not have one of the numbers.
    Impossible(String),
    Interrupted,
}

/// A point with a smaller sum of squares, and the residuals there.
type Better = (Vec<f64>, DVector<f64>);

#[derive(Clone, Debug)]
pub struct Minimum {
    pub p: Vec<f64>,
    pub residuals: DVector<f64>,
    /// −∂r/∂p at the minimum.
    pub slopes: DMatrix<f64>,
    /// Indices of the active limits: beyond each of them the sum would be smaller.
    pub held: Vec<usize>,
    pub steps: u64,
    pub failure: Option<Failure>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Failure {
    /// The sum was still falling after [`MOST_ITERATIONS`].
    TooManySteps,
    /// No step reduces the sum, however short, although the slopes predict that one should.
    Stuck,
}

pub const MOST_ITERATIONS: u64 = 200;

/// The search ends if the expected reduction of the sum is below this. The unit of the sum is a squared uncertainty.
const MIN_GAIN: f64 = 1e-8;
/// The same limit, relative to the sum.
const MIN_RELATIVE_GAIN: f64 = 1e-10;
/// If no step reduces the sum, an expected reduction below this is rounding error.
const GAIN_ROUNDING: f64 = 1e-3;
/// Singular values below this fraction of the largest are rounding error of the slopes.
pub const SINGULAR: f64 = 1e-6;
/// A limit closer than this, in uncertainties, counts as reached.
const REACHED_LIMIT: f64 = 1e-9;
/// Initial damping, for slopes whose columns have length 1.
const DAMPING: f64 = 1e-3;
const MOST_DAMPING: f64 = 1e12;

/// Searches for the minimum sum of squares from `start`, which must satisfy all `limits`.
pub fn search(
    problem: &dyn LeastSquares,
    start: &[f64],
    limits: &[Limit],
) -> Result<Minimum, Stop> {
    let mut p = start.to_vec();
    let mut r = problem.residuals(&p)?;
    let mut scale = DVector::zeros(p.len());
    let mut damping = DAMPING;
    for step in 0.. {
        let slopes = problem.slopes(&p)?;
        let sum = r.norm_squared();
        problem.on_iteration(step, sum);
        for (size, column) in scale.iter_mut().zip(slopes.column_iter()) {
            *size = column.norm().max(*size);
        }
        let linear = Linear::new(&slopes, &scale, &r, limits, &p);
        let held = linear.held();
        let gain = linear.gain(&held);
        let failure = if gain <= MIN_GAIN.max(MIN_RELATIVE_GAIN * sum) {
            None
        } else if step == MOST_ITERATIONS {
            Some(Failure::TooManySteps)
        } else if let Some(better) = linear.better(problem, &p, &r, limits, &mut damping)? {
            (p, r) = better;
            continue;
        } else {
            let is_rounding = gain <= GAIN_ROUNDING.max(GAIN_ROUNDING * GAIN_ROUNDING * sum);
            (!is_rounding).then_some(Failure::Stuck)
        };
        return Ok(Minimum {
            p,
            residuals: r,
            slopes,
            held,
            steps: step,
            failure,
        });
    }
    Err(Stop::Interrupted) // not reached: the steps are counted above
}

/// The linear problem at one point, J d = r, in units of the scales of the parameters.
struct Linear<'a> {
    slopes: &'a DMatrix<f64>,
    units: DVector<f64>,
    /// R of the decomposition Q R of the slopes. `along` is Q^T r.
    root: DMatrix<f64>,
    along: DVector<f64>,
    /// The limits of a step from this point.
    limits: Vec<Limit>,
}

impl<'a> Linear<'a> {
    fn new(
        slopes: &'a DMatrix<f64>,
        scale: &DVector<f64>,
        r: &DVector<f64>,
        limits: &[Limit],
        p: &[f64],
    ) -> Self {
        let units = scale.map(|scale| if scale > 0.0 { scale.recip() } else { 1.0 });
        let scaled = slopes * DMatrix::from_diagonal(&units);
        let (q, root) = scaled.qr().unpack();
        Self {
            slopes,
            limits: limits
                .iter()
                .map(|limit: &Limit| {
                    let normal = limit.normal.component_mul(&units);
                    Limit {
                        least: -limit.room(p).max(0.0) / normal.norm(),
                        normal: normal.normalize(),
                    }
                })
                .collect(),
            along: q.tr_mul(r),
            root,
            units,
        }
    }

    /// Returns the limits that hold the parameters at this point: the direction of steepest descent crosses them.
    fn held(&self) -> Vec<usize> {
        let here: Vec<usize> = (0..self.limits.len())
            .filter(|place| self.limits[*place].least >= -REACHED_LIMIT)
            .collect();
        let cone: Vec<Limit> = here
            .iter()
            .map(|&place| Limit {
                least: 0.0,
                normal: self.limits[place].normal.clone(),
            })
            .collect();
        let down = self.root.tr_mul(&self.along);
        let unit = DMatrix::identity(down.len(), down.len());
        let within = least_squares(&unit, &down, &cone);
        within.held.into_iter().map(|place| here[place]).collect()
    }

    /// Returns the reduction of the sum along the `held` limits if the residuals were linear.
    fn gain(&self, held: &[usize]) -> f64 {
        let normals = held.iter().map(|&place| &self.limits[place].normal);
        let free = complement(normals, self.units.len());
        if free.is_empty() {
            return 0.0;
        }
        let svd = (&self.root * free).svd(true, false);
        let Some(u) = svd.u else {
            return 0.0;
        };
        let least = SINGULAR * svd.singular_values.amax();
        let along = u.tr_mul(&self.along);
        let pairs = svd.singular_values.iter().zip(along.iter());
        let seen = pairs.filter(|(singular, _)| **singular > least);
        seen.map(|(_, part)| part * part).sum()
    }

    /// Returns the result of the longest step that reduces the sum; `None` if no step does.
    fn better(
        &self,
        problem: &dyn LeastSquares,
        p: &[f64],
        r: &DVector<f64>,
        limits: &[Limit],
        damping: &mut f64,
    ) -> Result<Option<Better>, Stop> {
        let (sum, mut growth) = (r.norm_squared(), 2.0);
        loop {
            let trial = moved(p, &self.step(*damping), limits);
            let moved = DVector::from_iterator(p.len(), trial.iter().zip(p).map(|(a, b)| a - b));
            let foreseen = sum - (r - self.slopes * &moved).norm_squared();
            let there = match problem.residuals(&trial) {
                Err(Stop::Impossible(_)) => None,
                there => Some(there?),
            };
            if let Some(there) = there
                && sum - there.norm_squared() > 0.0
            {
                let gained = sum - there.norm_squared();
                let ratio = 2.0 * (gained / foreseen).min(1.0) - 1.0;
                *damping *= (1.0 - ratio * ratio * ratio).clamp(1.0 / 3.0, 2.0);
                return Ok(Some((trial, there)));
            }
            *damping *= growth;
            growth *= 2.0;
            if *damping > MOST_DAMPING {
                return Ok(None);
            }
        }
    }

    /// Returns the step for this `damping`, in the parameters' own units.
    fn step(&self, damping: f64) -> DVector<f64> {
        let (rows, count) = self.root.shape();
        let own = DMatrix::from_diagonal_element(count, count, damping.sqrt());
        let mut damped = self.root.clone().resize_vertically(rows + count, 0.0);
        damped.view_mut((rows, 0), (count, count)).copy_from(&own);
        let along = self.along.clone().resize_vertically(rows + count, 0.0);
        let within = least_squares(&damped, &along, &self.limits);
        let mut step = within.y.component_mul(&self.units);
        for (change, slopes) in step.iter_mut().zip(self.root.column_iter()) {
            // A parameter without effect on the data keeps its value exactly; rounding would move it.
            if slopes.amax() == 0.0 {
                *change = 0.0;
            }
        }
        step
    }
}

/// Returns `p` after `step`. A limit on a single parameter then holds exactly, without rounding errors.
fn moved(p: &[f64], step: &DVector<f64>, limits: &[Limit]) -> Vec<f64> {
    let mut moved: Vec<f64> = p
        .iter()
        .zip(step.iter())
        .map(|(p, step)| p + step)
        .collect();
    for limit in limits {
        if let Some(place) = limit.only()
            && limit.room(&moved) < 0.0
        {
            moved[place] = limit.least / limit.normal[place];
        }
    }
    moved
}
