//! A straight line through turning points whose distances beat.
//!
//! A lopsided body's nutations grow longer and shorter with the direction in which the body points as the axle turns back.
//! Where that direction comes round slowly, the points are off a straight line by an arc, and the line from the first to
//! the last is steeper or less steep than the mean of a longer run. How much a single point is off it says nothing of that.
//! So a line is also fitted together with the sines and cosines of that direction. Its slope is the long run's but for
//! what is left of the beats.

/// Harmonics of the direction that are fitted: the center of mass makes the first, unequal moments of inertia the second.
const HARMONICS: u8 = 2;
/// A column of which less than this is left is a combination of those before it.
const DEPENDENT: f64 = 1e-6;

/// One turning point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Point {
    pub x: f64,
    pub y: f64,
    /// The direction in which the body points, rad.
    pub phase: f64,
}

/// The slope of the line, with its standard error.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slope {
    pub value: f64,
    pub error: f64,
}

/// Fits the line by least squares; `None` for too few points.
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
    // Their size may be far beyond their differences.
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

/// `column` without its parts along the vectors of `basis`, which are of unit length and perpendicular to each other.
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
