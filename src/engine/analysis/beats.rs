//! Straight-line fit through turning points whose intervals beat.
//!
//! The nutations of a lopsided body vary in length with the direction in which the body points when the axle turns
//! back. If that direction changes slowly, the points deviate from a straight line in an arc. The line from the first
//! to the last point is then steeper or flatter than the mean of a longer run. The scatter of single points does not
//! show this error.
//!
//! So the line is fitted together with sines and cosines of that direction. Its slope is the slope of a long run, apart
//! from a remainder of the beats.

/// Number of fitted harmonics of the direction. The center of mass causes the first, unequal moments of inertia the
/// second.
const HARMONICS: u8 = 2;
/// A column is a combination of the earlier ones if less than this fraction of it remains.
const DEPENDENT: f64 = 1e-6;

/// One turning point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Point {
    pub x: f64,
    pub y: f64,
    /// Direction in which the body points, rad.
    pub phase: f64,
}

/// Slope of the line, with its standard error.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slope {
    pub value: f64,
    pub error: f64,
}

/// Fits the line by least squares. Returns `None` if there are too few points.
pub(super) fn slope(points: &[Point]) -> Option<Slope> {
    let mut columns = vec![vec![1.0; points.len()]];
    for harmonic in 1..=HARMONICS {
        let times = f64::from(harmonic);
        columns.push(column(points, |point| libm::cos(times * point.phase)));
        columns.push(column(points, |point| libm::sin(times * point.phase)));
    }
    let mut basis: Vec<Vec<f64>> = Vec::new();
    for values in columns {
        let left = without(&basis, &values);
        let size = norm(&left);
        if size > DEPENDENT * norm(&values) {
            basis.push(left.iter().map(|it| it / size).collect());
        }
    }
    let freedom = points.len().checked_sub(basis.len() + 1)?;
    // Differences from the first point, which may be much smaller than the values themselves.
    let first = points.first()?;
    let x = without(&basis, &column(points, |point| point.x - first.x));
    let y = without(&basis, &column(points, |point| point.y - first.y));
    let value = dot(&x, &y) / dot(&x, &x);
    let rest: Vec<f64> = x.iter().zip(&y).map(|(x, y)| y - value * x).collect();
    let error = (dot(&rest, &rest) / freedom as f64 / dot(&x, &x)).sqrt();
    (value.is_finite() && error.is_finite()).then_some(Slope { value, error })
}

fn column(points: &[Point], of: impl Fn(&Point) -> f64) -> Vec<f64> {
    points.iter().map(of).collect()
}

/// Returns `column` without its components along the vectors of `basis`, which are orthonormal.
fn without(basis: &[Vec<f64>], column: &[f64]) -> Vec<f64> {
    let mut left = column.to_vec();
    for vector in basis {
        let part = dot(vector, &left);
        left.iter_mut()
            .zip(vector)
            .for_each(|(it, of)| *it -= part * of);
    }
    left
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn norm(a: &[f64]) -> f64 {
    dot(a, a).sqrt()
}
