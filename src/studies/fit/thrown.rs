//! Start values for a body that was thrown. The rates about its own axes determine the ratios of its moments and the
//! rates at the start, without a search.
//!
//! Euler's equations A dw1 = (B - C) w2 w3 dt and so on, integrated over the recording, are linear in A, B, C. The
//! solution is the vector that comes closest to fulfilling all of them; its length is unknown.

use super::Free;
use super::chart::{moment, second_moments};
use super::model::Model;
use crate::engine::data::{DataKind, TimeSeries};
use crate::engine::scenario::Scenario;
use crate::engine::scenario::file::VectorFrame;
use nalgebra::{Matrix3, SymmetricEigen, Vector3};

const RATES: [&str; 3] = ["w1_rad_per_s", "w2_rad_per_s", "w3_rad_per_s"];
const START_OMEGA_KEY: &str = "start.omega_rad_per_s.";

/// Minimum second moment of mass at the start of the search, as a fraction of the sum of all three.
const LEAST_SHARE: f64 = 1e-3;

/// Ratios of the second moments of mass of compact, long and flat bodies. The search may also start from these, in case
/// noise hides the true ratios.
const SHARES: [[f64; 3]; 13] = [
    [1.0, 1.0, 1.0],
    [2.0, 1.0, 1.0],
    [1.0, 2.0, 1.0],
    [1.0, 1.0, 2.0],
    [8.0, 1.0, 1.0],
    [1.0, 8.0, 1.0],
    [1.0, 1.0, 8.0],
    [4.0, 1.0, 0.1],
    [1.0, 4.0, 0.1],
    [4.0, 0.1, 1.0],
    [1.0, 0.1, 4.0],
    [0.1, 4.0, 1.0],
    [0.1, 1.0, 4.0],
];

/// The keys that a throw determines. Free flight depends only on the ratios of the moments, so the third moment is
/// fixed.
const USUAL_KEYS: [&str; 5] = [
    "body.part.0.moments_kg_m2.0",
    "body.part.0.moments_kg_m2.1",
    "start.omega_rad_per_s.0",
    "start.omega_rad_per_s.1",
    "start.omega_rad_per_s.2",
];

/// Returns the keys that are free by default. Returns `None` if the data are not the three rates of a body in free
/// flight, or if the scenario does not give its moments.
pub fn usual_keys(series: &TimeSeries, scenario: &Scenario) -> Option<[&'static str; 5]> {
    let has_moments = scenario.file.body.part.first()?.moments_kg_m2.is_some();
    let is_thrown = flies(scenario) && recorded(series).is_some();
    (is_thrown && has_moments).then_some(USUAL_KEYS)
}

/// Returns start values of the free keys to use instead of `p`, the likeliest first. The list is empty if the data are
/// not the three rates of a body in free flight.
pub(super) fn starts(model: &Model, p: &[f64]) -> Vec<Vec<f64>> {
    let recorded = match &model.measured.data {
        DataKind::Series(series) => recorded(series).unwrap_or_default(),
        DataKind::Table(_) => Vec::new(),
    };
    let scenario = model.scenario(p).ok().filter(flies);
    let own = scenario.and_then(|it| it.file.body.part.first()?.moments_kg_m2);
    let (Some(own), Some(sums)) = (own, Sums::new(&recorded)) else {
        return Vec::new();
    };
    let mut all: Vec<Vector3<f64>> = sums.moments().into_iter().collect();
    if model
        .free
        .iter()
        .any(|free| free.keys.iter().any(|key| moment(key).is_some()))
    {
        all.extend(SHARES.map(|shares| moments_of(&Vector3::from(shares))));
    }
    all.iter()
        .map(|moments| start(model, p, &own.into(), &sums, moments))
        .collect()
}

/// Returns start values of the free keys for a body with these moments, known up to a factor.
fn start(
    model: &Model,
    p: &[f64],
    own: &Vector3<f64>,
    sums: &Sums,
    moments: &Vector3<f64>,
) -> Vec<f64> {
    // Fixed moments keep their values and determine the factor. If no moment is fixed, their sum is kept.
    let mut held: Vec<usize> = (0..3)
        .filter(|axis| {
            !model
                .free
                .iter()
                .any(|free| moment_axes(free).contains(axis))
        })
        .collect();
    if held.is_empty() {
        held = vec![0, 1, 2];
    }
    let [own_sum, sum] = [own, moments].map(|of| held.iter().map(|axis| of[*axis]).sum::<f64>());
    let factor = own_sum / sum;
    let rates = sums.rates_at_start(moments);
    model
        .free
        .iter()
        .zip(p)
        .map(|(free, rate): (&Free, &f64)| {
            let axes_of_key = moment_axes(free);
            let axis = free
                .key
                .strip_prefix(START_OMEGA_KEY)
                .and_then(|axis| axis.parse::<usize>().ok());
            let value = match (&axes_of_key[..], axis) {
                ([_, ..], _) => {
                    let moment: f64 = axes_of_key.iter().map(|place| moments[*place]).sum();
                    factor * moment / axes_of_key.len() as f64
                }
                ([], Some(axis)) => rates[axis.min(2)],
                ([], None) => *rate,
            };
            value.clamp(free.from, free.to)
        })
        .collect()
}

/// Returns the moments of a body with these second moments of mass, raised where one is too small.
fn moments_of(second: &Vector3<f64>) -> Vector3<f64> {
    let least = LEAST_SHARE * second.map(|it| it.max(0.0)).sum();
    let raised = second.map(|it| it.max(least));
    Vector3::repeat(raised.sum()) - raised
}

/// Returns true if no torque acts on the body of `scenario` and its start is given by rates about its own axes.
pub(super) fn flies(scenario: &Scenario) -> bool {
    scenario.motion.gravity == 0.0
        && scenario.pushes.is_empty()
        && scenario.edits.is_empty()
        && scenario.friction.is_none()
        && scenario.file.start.omega_frame == Some(VectorFrame::Body)
}

/// Returns the times, s, with the three rates, rad/s. Returns `None` if one of the rates was not measured.
pub(super) fn recorded(series: &TimeSeries) -> Option<Vec<(f64, Vector3<f64>)>> {
    let [x, y, z] = RATES.map(|name| {
        let mut curves = series.curves.iter();
        curves.find(|curve| curve.quantity.name == name)
    });
    let rows = x?.points.iter().zip(&y?.points).zip(&z?.points);
    let whole = rows.filter(|((a, b), c)| a.row == b.row && b.row == c.row);
    let rates = whole.map(|((a, b), c)| {
        let rates = Vector3::new(a.value, b.value, c.value);
        (series.times_s[a.row], rates)
    });
    Some(rates.collect())
}

/// Returns the products of each pair of the three rates.
pub(super) fn product(w: &Vector3<f64>) -> Vector3<f64> {
    Vector3::new(w.y * w.z, w.z * w.x, w.x * w.y)
}

/// The rates of a recording, and their products integrated from time 0.
struct Sums {
    mean_rate: Vector3<f64>,
    mean_sum: Vector3<f64>,
    /// The rates and the integrals of each row, minus their means.
    rows: Vec<(Vector3<f64>, Vector3<f64>)>,
}

impl Sums {
    fn new(recorded: &[(f64, Vector3<f64>)]) -> Option<Self> {
        let (mut before_s, mut before) = (0.0, product(&recorded.first()?.1));
        let mut sum = Vector3::zeros();
        let mut rows = Vec::with_capacity(recorded.len());
        for (time_s, rates) in recorded {
            let now = product(rates);
            sum += 0.5 * (time_s - before_s) * (before + now);
            (before_s, before) = (*time_s, now);
            rows.push((*rates, sum));
        }
        let count = rows.len() as f64;
        let mean_rate = rows.iter().map(|row| row.0).sum::<Vector3<f64>>() / count;
        let mean_sum = rows.iter().map(|row| row.1).sum::<Vector3<f64>>() / count;
        for row in &mut rows {
            row.0 -= mean_rate;
            row.1 -= mean_sum;
        }
        Some(Self {
            mean_rate,
            mean_sum,
            rows,
        })
    }

    /// Returns the moments about the body's axes, up to a factor; `None` if the rates do not determine them.
    fn moments(&self) -> Option<Vector3<f64>> {
        let mut squares = Matrix3::zeros();
        for (w, s) in &self.rows {
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
        let moments = nearest * nearest.sum().signum();
        // Noise can make second moments of mass of a flat body, or moments of a thin one, negative.
        let is_body = moments.iter().all(|moment| *moment > 0.0);
        is_body.then(|| moments_of(&second_moments(&moments)))
    }

    /// Computes the rates at time 0 of a body with these `moments`, known up to a factor; rad/s.
    fn rates_at_start(&self, moments: &Vector3<f64>) -> Vector3<f64> {
        let [a, b, c] = (*moments).into();
        let growth = Vector3::new((b - c) / a, (c - a) / b, (a - b) / c);
        self.mean_rate - growth.component_mul(&self.mean_sum)
    }
}

/// Returns the axes of the first part whose moments `free` sets.
fn moment_axes(free: &Free) -> Vec<usize> {
    free.keys
        .iter()
        .filter_map(|key| moment(key))
        .filter(|(part, _)| *part == 0)
        .map(|(_, axis)| axis)
        .collect()
}
