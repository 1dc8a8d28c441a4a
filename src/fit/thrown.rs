//! Where to begin for a body that was thrown: its rates about its own axes tell the ratios of its moments and the rates at
//! the start, without a search.
//!
//! Euler's equations A dw1 = (B - C) w2 w3 dt and so on, summed up over the recording, are linear in A, B, C, which are known
//! up to a factor: the vector that comes nearest to fulfilling all of them.

use super::Free;
use super::model::Model;
use crate::data::{Data, Series};
use crate::scenario::Scenario;
use crate::scenario::file::Frame;
use nalgebra::{Matrix3, SymmetricEigen, Vector3};

const RATES: [&str; 3] = ["w1_rad_per_s", "w2_rad_per_s", "w3_rad_per_s"];
const MOMENTS: &str = "body.part.0.moments_kg_m2.";
const OMEGA: &str = "start.omega_rad_per_s.";

/// The largest share of the other two moments together that the third may begin with.
const LARGEST: f64 = 0.999;

/// Values of the free keys to begin from in place of `p`; `None` where the data are not the three rates of a body that flies
/// freely.
pub(super) fn start(model: &Model, p: &[f64]) -> Option<Vec<f64>> {
    let Data::Series(series) = &model.measured.data else {
        return None;
    };
    let scenario = model.scenario(p).ok().filter(flies)?;
    let own = scenario.file.body.part.first()?.moments_kg_m2?;
    let (moments, rates) = of_recording(&recorded(series)?)?;
    let is_free = |axis: &usize| {
        let key = format!("{MOMENTS}{axis}");
        model.free.iter().any(|free| free.key == key)
    };
    // The moments that are held are what they are; where none is, their sum stays.
    let mut held: Vec<usize> = (0..3).filter(|axis| !is_free(axis)).collect();
    if held.is_empty() {
        held = vec![0, 1, 2];
    }
    let sum = |of: &dyn Fn(usize) -> f64| held.iter().map(|axis| of(*axis)).sum::<f64>();
    let factor = sum(&|axis| own[axis]) / sum(&|axis| moments[axis]);
    let value = |(free, own): (&Free, &f64)| {
        let axis = |front| free.key.strip_prefix(front)?.parse::<usize>().ok();
        let value = match (axis(MOMENTS), axis(OMEGA)) {
            (Some(axis), _) => factor * moments[axis.min(2)],
            (_, Some(axis)) => rates[axis.min(2)],
            _ => *own,
        };
        value.clamp(free.from, free.to)
    };
    Some(model.free.iter().zip(p).map(value).collect())
}

/// Whether nothing turns the body of `scenario`, and its start is stated by rates about its own axes.
fn flies(scenario: &Scenario) -> bool {
    scenario.motion.gravity == 0.0
        && scenario.pushes.is_empty()
        && scenario.edits.is_empty()
        && scenario.friction.is_none()
        && scenario.file.start.omega_frame == Some(Frame::Body)
}

/// The times, s, with the three rates, rad/s.
fn recorded(series: &Series) -> Option<Vec<(f64, Vector3<f64>)>> {
    let points = |name| {
        let mut curves = series.curves.iter();
        let curve = curves.find(|curve| curve.quantity.name == name)?;
        Some(curve.points.iter())
    };
    let rows = points(RATES[0])?
        .zip(points(RATES[1])?)
        .zip(points(RATES[2])?);
    let whole = rows.filter(|((a, b), c)| a.row == b.row && b.row == c.row);
    let rates = whole.map(|((a, b), c)| {
        let rates = Vector3::new(a.value, b.value, c.value);
        (series.times_s[a.row], rates)
    });
    Some(rates.collect())
}

/// The moments about the body's axes, up to a factor, and the rates at time 0, rad/s.
fn of_recording(rows: &[(f64, Vector3<f64>)]) -> Option<(Vector3<f64>, Vector3<f64>)> {
    let product = |w: &Vector3<f64>| Vector3::new(w.y * w.z, w.z * w.x, w.x * w.y);
    // The products of the rates, summed up from time 0, at each row.
    let (mut before_s, mut before, mut sum) = (0.0, product(&rows.first()?.1), Vector3::zeros());
    let mut sums = Vec::with_capacity(rows.len());
    for (time_s, rates) in rows {
        let now = product(rates);
        sum += 0.5 * (time_s - before_s) * (before + now);
        (before_s, before) = (*time_s, now);
        sums.push(sum);
    }
    let count = rows.len() as f64;
    let mean_rate = rows.iter().map(|(_, rates)| rates).sum::<Vector3<f64>>() / count;
    let mean_sum = sums.iter().sum::<Vector3<f64>>() / count;
    let mut squares = Matrix3::zeros();
    for ((_, rates), sum) in rows.iter().zip(&sums) {
        let (w, s) = (rates - mean_rate, sum - mean_sum);
        for equation in [
            Vector3::new(w.x, -s.x, s.x),
            Vector3::new(s.y, w.y, -s.y),
            Vector3::new(-s.z, s.z, w.z),
        ] {
            squares += equation * equation.transpose();
        }
    }
    if !squares.iter().all(|number| number.is_finite()) {
        return None;
    }
    let all = SymmetricEigen::new(squares);
    let nearest = all.eigenvectors.column(all.eigenvalues.imin());
    let mut moments = nearest * nearest.sum().signum();
    // No moment of a body is larger than the other two together; noise makes one of a flat body so.
    let (largest, others) = (moments.imax(), moments.sum() - moments.max());
    moments[largest] = moments[largest].min(LARGEST * others);
    let [a, b, c] = moments.into();
    let growth = Vector3::new((b - c) / a, (c - a) / b, (a - b) / c);
    let is_body = moments.iter().all(|moment| *moment > 0.0);
    is_body.then(|| (moments, mean_rate - growth.component_mul(&mean_sum)))
}
