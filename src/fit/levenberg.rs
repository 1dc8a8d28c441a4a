//! The search for the least sum of squares: Levenberg and Marquardt's, within bounds.
//!
//! Sources: D. W. Marquardt, J. Soc. Indust. Appl. Math. 11, 431 (1963); J. J. Moré, Lecture Notes in Mathematics 630, 105
//! (1978), for the scaling of the parameters, which never shrinks; H. B. Nielsen, Damping parameter in Marquardt's method,
//! IMM-REP-1999-05, Technical University of Denmark (1999), for the damping. Bounds are held by projection: a parameter at a
//! bound, beyond which the sum would fall, stays there while the others are looked for (D. P. Bertsekas, SIAM J. Control
//! Optim. 20, 221 (1982)). A well-kept crate with this method, levenberg-marquardt, needs another version of nalgebra.

use nalgebra::{DMatrix, DVector};

/// What is to be made small.
pub trait Problem {
    /// The residuals r at `p`, in units in which a standard uncertainty is 1.
    fn residuals(&self, p: &[f64]) -> Result<DVector<f64>, Stop>;

    /// −∂r/∂p at `p`: a column for each parameter.
    fn slopes(&self, p: &[f64]) -> Result<DMatrix<f64>, Stop>;

    /// Called after each step, with the number of steps and the sum.
    fn tell(&self, step: u64, sum: f64);
}

#[derive(Clone, Debug, PartialEq)]
pub enum Stop {
    /// There is no such run, or no such number of it.
    Impossible(String),
    Interrupted,
}

/// The least and the greatest value of a parameter.
pub type Bounds = (f64, f64);

/// A place where the sum is less, and the residuals there.
type Better = (Vec<f64>, DVector<f64>);

#[derive(Clone, Debug)]
pub struct Minimum {
    pub p: Vec<f64>,
    pub residuals: DVector<f64>,
    /// −∂r/∂p there.
    pub slopes: DMatrix<f64>,
    /// Which parameters are held at a bound, beyond which the sum would be less.
    pub held: Vec<bool>,
    pub steps: u64,
    pub failure: Option<Failure>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Failure {
    /// The sum was still falling after [`MOST_STEPS`].
    TooManySteps,
    /// However short a step is, it makes nothing better, though the slopes say that it should.
    Stuck,
}

pub const MOST_STEPS: u64 = 200;

/// A foreseen gain below this ends the search; in the sum 1 is a standard uncertainty.
const ENOUGH: f64 = 1e-8;
/// The same as a part of the sum.
const ENOUGH_OF_SUM: f64 = 1e-10;
/// Where no step reduces the sum, a foreseen gain below this is rounding.
const ROUNDING: f64 = 1e-3;
/// Singular values below this part of the largest are the rounding of the slopes.
pub const SINGULAR: f64 = 1e-6;
/// The damping at the beginning, of slopes whose columns have length 1.
const DAMPING: f64 = 1e-3;
const MOST_DAMPING: f64 = 1e12;

/// Looks for the least sum of squares from `start` on.
pub fn search(problem: &dyn Problem, start: &[f64], bounds: &[Bounds]) -> Result<Minimum, Stop> {
    let mut p = start.to_vec();
    let mut r = problem.residuals(&p)?;
    let mut scale = DVector::zeros(p.len());
    let mut damping = DAMPING;
    for step in 0.. {
        let slopes = problem.slopes(&p)?;
        let sum = r.norm_squared();
        problem.tell(step, sum);
        for (scale, column) in scale.iter_mut().zip(slopes.column_iter()) {
            *scale = column.norm().max(*scale);
        }
        let held = held(&p, bounds, &slopes, &r);
        let linear = Linear::new(&slopes, &scale, &held, &r);
        let gain = linear.gain();
        let failure = if gain <= ENOUGH.max(ENOUGH_OF_SUM * sum) {
            None
        } else if step == MOST_STEPS {
            Some(Failure::TooManySteps)
        } else if let Some(better) = linear.better(problem, &p, &r, bounds, &mut damping)? {
            (p, r) = better;
            continue;
        } else {
            let is_rounding = gain <= ROUNDING.max(ROUNDING * ROUNDING * sum);
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

fn held(p: &[f64], bounds: &[Bounds], slopes: &DMatrix<f64>, r: &DVector<f64>) -> Vec<bool> {
    let pull = slopes.tr_mul(r); // upwards where it is positive
    let is_held = |index: usize| {
        let (at, pull) = (p[index], pull[index]);
        at <= bounds[index].0 && pull < 0.0 || at >= bounds[index].1 && pull > 0.0
    };
    (0..p.len()).map(is_held).collect()
}

fn projected(p: &[f64], step: &DVector<f64>, bounds: &[Bounds]) -> Vec<f64> {
    let moved = p.iter().zip(step.iter()).zip(bounds);
    moved
        .map(|((p, step), (from, to))| (p + step).clamp(*from, *to))
        .collect()
}

/// The linear problem at one place: J δ = r for the parameters that are not held, in units of their scales.
struct Linear<'a> {
    slopes: &'a DMatrix<f64>,
    scale: &'a DVector<f64>,
    moving: Vec<usize>,
    singular: DVector<f64>,
    /// Uᵀ r.
    along: DVector<f64>,
    v_t: DMatrix<f64>,
}

impl<'a> Linear<'a> {
    fn new(
        slopes: &'a DMatrix<f64>,
        scale: &'a DVector<f64>,
        held: &[bool],
        r: &DVector<f64>,
    ) -> Self {
        let moves = |index: &usize| !held[*index] && scale[*index] > 0.0;
        let moving: Vec<usize> = (0..held.len()).filter(moves).collect();
        let columns = moving
            .iter()
            .map(|&index| slopes.column(index) / scale[index]);
        let columns: Vec<DVector<f64>> = columns.collect();
        let (mut singular, mut along) = (DVector::zeros(0), DVector::zeros(0));
        let mut v_t = DMatrix::zeros(0, 0);
        if !columns.is_empty() && !r.is_empty() {
            let svd = DMatrix::from_columns(&columns).svd(true, true);
            if let (Some(u), Some(rows)) = (svd.u, svd.v_t) {
                (singular, along, v_t) = (svd.singular_values, u.tr_mul(r), rows);
            }
        }
        Self {
            slopes,
            scale,
            moving,
            singular,
            along,
            v_t,
        }
    }

    /// Where the longest step leads that reduces the sum; `None` where there is none.
    fn better(
        &self,
        problem: &dyn Problem,
        p: &[f64],
        r: &DVector<f64>,
        bounds: &[Bounds],
        damping: &mut f64,
    ) -> Result<Option<Better>, Stop> {
        let (sum, mut growth) = (r.norm_squared(), 2.0);
        loop {
            let trial = projected(p, &self.step(*damping), bounds);
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

    /// By how much the sum would fall, were the residuals linear.
    fn gain(&self) -> f64 {
        let least = SINGULAR * self.singular.amax();
        let pairs = self.singular.iter().zip(self.along.iter());
        let seen = pairs.filter(|(singular, _)| **singular > least);
        seen.map(|(_, along)| along * along).sum()
    }

    /// The step under `damping`, in the parameters' own units.
    fn step(&self, damping: f64) -> DVector<f64> {
        let mut step = DVector::zeros(self.scale.len());
        let damped = self.singular.zip_map(&self.along, |singular, along| {
            singular * along / (singular * singular + damping)
        });
        let moved = self.v_t.tr_mul(&damped);
        for (&index, moved) in self.moving.iter().zip(moved.iter()) {
            step[index] = moved / self.scale[index];
        }
        step
    }
}
