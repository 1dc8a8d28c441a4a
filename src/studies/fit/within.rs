//! Linear least squares within linear limits, by the primal active-set method (J. Nocedal, S. J. Wright, Numerical
//! Optimization, 2nd ed., section 16.5).

use nalgebra::{DMatrix, DVector};

/// The half-space of all points p for which normal . p is at least `least`.
#[derive(Clone, Debug, PartialEq)]
pub struct Limit {
    pub normal: DVector<f64>,
    pub least: f64,
}

impl Limit {
    /// Returns the distance of `p` from the limit, in the limit's own unit; negative outside.
    pub fn room(&self, p: &[f64]) -> f64 {
        let along = self.normal.iter().zip(p).map(|(normal, p)| normal * p);
        along.sum::<f64>() - self.least
    }

    /// Returns the index of the parameter, if the limit involves only one.
    pub fn only(&self) -> Option<usize> {
        let mut places = (0..self.normal.len()).filter(|&place| self.normal[place] != 0.0);
        places.next().filter(|_| places.next().is_none())
    }
}

/// Solution of a least-squares problem within limits.
#[derive(Clone, Debug)]
pub struct Within {
    pub y: DVector<f64>,
    /// Indices of the active limits: beyond each of them the sum of squares would be smaller.
    pub held: Vec<usize>,
}

/// Relative size below which a number is rounding error.
const ROUNDING: f64 = 1e-12;

/// Returns the y that minimizes |`a` y - `c`|^2 within `limits`. The point 0 must satisfy all limits, and the columns
/// of `a` must be independent.
pub fn least_squares(a: &DMatrix<f64>, c: &DVector<f64>, limits: &[Limit]) -> Within {
    let mut y = DVector::zeros(a.ncols());
    let mut held: Vec<usize> = Vec::new();
    // Each round adds or removes one limit. The bound stops a cycle between limits that meet in one point.
    for _ in 0..4 * (limits.len() + 1) {
        let free = complement(held.iter().map(|&place| &limits[place].normal), a.ncols());
        let step = &free * solved(&(a * &free), &(c - a * &y));
        let (fraction, blocking) = reach(&y, &step, limits, &held);
        y += fraction * step;
        if let Some(place) = blocking {
            held.push(place);
            continue;
        }
        let pull = a.tr_mul(&(c - a * &y));
        match outward(&pull, limits, &held) {
            Some(place) => held.retain(|it| *it != place),
            None => break,
        }
    }
    Within { y, held }
}

/// Returns the fraction of `step`, at most 1, that leads from `y` to the first limit, and the index of this limit.
fn reach(
    y: &DVector<f64>,
    step: &DVector<f64>,
    limits: &[Limit],
    held: &[usize],
) -> (f64, Option<usize>) {
    let (mut fraction, mut blocking) = (1.0, None);
    for (place, limit) in limits.iter().enumerate() {
        let speed = limit.normal.dot(step);
        if held.contains(&place) || speed >= -ROUNDING * limit.normal.norm() * step.norm() {
            continue;
        }
        let to_limit = limit.room(y.as_slice()).max(0.0) / -speed;
        if to_limit < fraction {
            (fraction, blocking) = (to_limit, Some(place));
        }
    }
    (fraction, blocking)
}

/// Returns the index of the `held` limit that `pull` leaves fastest toward the inside; `None` if `pull` leads outside
/// all of them.
fn outward(pull: &DVector<f64>, limits: &[Limit], held: &[usize]) -> Option<usize> {
    if held.is_empty() {
        return None;
    }
    let normals = held.iter().map(|&place| limits[place].normal.normalize());
    let inward = solved(&DMatrix::from_columns(&normals.collect::<Vec<_>>()), pull);
    let most = inward.imax();
    (inward[most] > ROUNDING * pull.norm()).then(|| held[most])
}

/// Returns an orthonormal basis of the directions perpendicular to the independent `normals`. Without normals, these
/// are the directions of the parameters.
pub fn complement<'a>(
    normals: impl Iterator<Item = &'a DVector<f64>>,
    count: usize,
) -> DMatrix<f64> {
    let mut basis: Vec<DVector<f64>> = Vec::new();
    for normal in normals {
        let next = across(normal.normalize(), &basis);
        basis.extend(next.try_normalize(ROUNDING));
    }
    let held_count = basis.len();
    let mut units: Vec<DVector<f64>> = (0..count)
        .map(|place| DVector::from_fn(count, |row, _| f64::from(u8::from(row == place))))
        .collect();
    while basis.len() < count {
        let left = units.iter().map(|unit| across(unit.clone(), &basis).norm());
        let left = DVector::from_iterator(units.len(), left);
        let next = across(units.remove(left.imax()), &basis);
        basis.push(next.normalize());
    }
    DMatrix::from_fn(count, count - held_count, |row, column| {
        basis[held_count + column][row]
    })
}

/// Returns the shortest x that minimizes |`a` x - `c`|^2.
fn solved(a: &DMatrix<f64>, c: &DVector<f64>) -> DVector<f64> {
    if a.ncols() == 0 {
        return DVector::zeros(0);
    }
    let svd = a.clone().svd(true, true);
    let least = ROUNDING * ROUNDING * svd.singular_values.amax();
    svd.solve(c, least)
        .unwrap_or_else(|_| DVector::zeros(a.ncols()))
}

/// Returns the component of `vector` perpendicular to the `basis`. The projection is repeated to reduce rounding
/// errors.
fn across(mut vector: DVector<f64>, basis: &[DVector<f64>]) -> DVector<f64> {
    for _ in 0..2 {
        basis.iter().for_each(|it| vector -= it * it.dot(&vector));
    }
    vector
}
