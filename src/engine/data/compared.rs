//! Compares measured data with a model. Everything that shows or fits measured data uses the residuals computed here.
//! [`Compared`] has each value next to the run's, with statistics.

use super::{MeasuredCurve, MeasuredPlace, MeasuredPoint, RunQuantity, TimeSeries, places};
use nalgebra::Vector3;

/// Measured data, each value with the run's value.
#[derive(Clone, Debug, Default)]
pub struct Compared {
    /// Values of each column, in order of time.
    pub curves: Vec<Vec<ComparedPoint>>,
    /// Measured positions of the traced point, seen from above. Empty if the columns do not determine them.
    pub places: Vec<MeasuredPlace>,
    pub sum: Sum,
    pub sums: Vec<Sum>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ComparedPoint {
    pub time_s: f64,
    /// Value, in the unit of its column. For a direction, full turns are added to bring it nearest to the run.
    pub value: f64,
    /// Standard uncertainty of the value, if given.
    pub sigma: Option<f64>,
    /// Value in the run. `None` for times that the run has not reached.
    pub model: Option<f64>,
}

#[derive(Clone, Debug, Default)]
pub struct Sum {
    pub points: usize,
    /// Number of points that the run has reached.
    pub compared: usize,
    pub weighed: usize,
    /// Sum of the squared residuals in units of the uncertainty.
    pub chi_squared: f64,
    pub largest: Option<Largest>,
    /// Root mean square of the residuals without uncertainty, for each column that has some.
    pub scatter: Vec<(&'static RunQuantity, f64)>,
}

#[derive(Clone, Copy, Debug)]
pub struct Largest {
    pub sigmas: f64,
    pub quantity: &'static RunQuantity,
    pub time_s: f64,
}

impl ComparedPoint {
    pub fn residual(&self) -> Option<f64> {
        self.model.map(|model| self.value - model)
    }
}

impl Compared {
    /// Compares `series` with the `model`, which has the values of a run at the first points of each curve. Only points
    /// up to `now_s` (s) are compared. `traced` is the traced point, body frame, m.
    pub fn new(series: &TimeSeries, model: &[Vec<f64>], now_s: f64, traced: &Vector3<f64>) -> Self {
        let mut compared = Self {
            places: places(series, traced),
            ..Self::default()
        };
        for (curve, values) in series.curves.iter().zip(model) {
            let count = reached(series, curve, now_s).min(values.len());
            let points = shown(series, curve, &values[..count]);
            compared.sum.add_quantity(curve.quantity, &points);
            let mut own = Sum::default();
            own.add_quantity(curve.quantity, &points);
            compared.sums.push(own);
            compared.curves.push(points);
        }
        compared
    }
}

/// Returns the number of points of `curve` that were measured at or before `now_s`.
fn reached(series: &TimeSeries, curve: &MeasuredCurve, now_s: f64) -> usize {
    curve
        .points
        .partition_point(|point| series.times_s[point.row] <= now_s)
}

/// Returns the points of `curve`. The first of them have the values `model` in the run.
fn shown(series: &TimeSeries, curve: &MeasuredCurve, model: &[f64]) -> Vec<ComparedPoint> {
    let held = residuals(Some(curve.quantity), &curve.points, model);
    let mut shown: Vec<ComparedPoint> = Vec::with_capacity(curve.points.len());
    for (index, point) in curve.points.iter().enumerate() {
        let residual = held.get(index);
        // A direction that the run has not reached gets the number of turns nearest to the last one.
        let value = match (residual, shown.last()) {
            (Some(residual), _) => residual.measured,
            (None, Some(before)) if curve.quantity.is_direction => {
                point.value + (before.value - curve.points[index - 1].value)
            }
            (None, _) => point.value,
        };
        shown.push(ComparedPoint {
            time_s: series.times_s[point.row],
            value,
            sigma: point.sigma,
            model: residual.map(|residual| residual.model),
        });
    }
    shown
}

impl Sum {
    fn add_quantity(&mut self, quantity: &'static RunQuantity, shown: &[ComparedPoint]) {
        self.points += shown.len();
        let (mut squares, mut count) = (0.0, 0_u32);
        for point in shown {
            let Some(residual) = point.residual() else {
                continue;
            };
            self.compared += 1;
            let Some(sigma) = point.sigma else {
                squares += residual * residual;
                count += 1;
                continue;
            };
            let sigmas = residual / sigma;
            self.weighed += 1;
            self.chi_squared += sigmas * sigmas;
            let own = Largest {
                sigmas: sigmas.abs(),
                quantity,
                time_s: point.time_s,
            };
            if self
                .largest
                .is_none_or(|largest| own.sigmas > largest.sigmas)
            {
                self.largest = Some(own);
            }
        }
        if count > 0 {
            let scatter = (squares / f64::from(count)).sqrt();
            self.scatter.push((quantity, scatter));
        }
    }
}

/// Difference between a measured value and the model's value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Residual {
    pub row: usize,
    /// Measured value. For a direction, it includes the full turns that [`residuals`] adds.
    pub measured: f64,
    /// Standard uncertainty of the value, if given.
    pub sigma: Option<f64>,
    pub model: f64,
}

impl Residual {
    /// Returns the measured value minus the model's, in the unit of both.
    pub fn value(&self) -> f64 {
        self.measured - self.model
    }

    /// Returns the difference in units of the uncertainty.
    pub fn in_sigmas(&self) -> Option<f64> {
        self.sigma.map(|sigma| self.value() / sigma)
    }
}

/// Returns the residuals of `points` from the values of `model`, one for each.
///
/// For a direction, such as the azimuth, the number of full turns depends on the zero that was chosen. If the values
/// stay within one turn, they are read as directions, and each is moved to the turn nearest to the model. If full turns
/// were counted, the count stays as measured, and all values are shifted by the same number of turns so that the first
/// is nearest to the model.
pub fn residuals(
    quantity: Option<&RunQuantity>,
    points: &[MeasuredPoint],
    model: &[f64],
) -> Vec<Residual> {
    let is_direction = quantity.is_some_and(|quantity| quantity.is_direction);
    let first = points.iter().zip(model).next();
    let common = first
        .filter(|_| is_counted(points))
        .map(|(point, value)| turns_deg(value - point.value));
    let pairs = points.iter().zip(model);
    let all = pairs.map(|(point, &value)| Residual {
        row: point.row,
        measured: if is_direction {
            point.value + common.unwrap_or_else(|| turns_deg(value - point.value))
        } else {
            point.value
        },
        sigma: point.sigma,
        model: value,
    });
    all.collect()
}

/// Returns true if the directions of `points`, degrees, count full turns.
pub fn is_counted(points: &[MeasuredPoint]) -> bool {
    let (least, most) = points.iter().map(|point| point.value).fold(
        (f64::INFINITY, f64::NEG_INFINITY),
        |(least, most), value| (least.min(value), most.max(value)),
    );
    most - least > 360.0
}

fn turns_deg(angle_deg: f64) -> f64 {
    360.0 * (angle_deg / 360.0).round()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::read;

    fn series(text: &str) -> TimeSeries {
        read("test.csv", text).unwrap().series().unwrap().clone()
    }

    fn up() -> Vector3<f64> {
        Vector3::new(0.0, 0.0, 2.0)
    }

    #[test]
    fn directions_stay_on_the_turn_of_the_run() {
        let series = series("t_s,azimuth_deg\n0,350\n1,20\n2,40\n");
        let shown = Compared::new(&series, &[vec![-5.0, 375.0]], 1.0, &up()).curves;
        let values: Vec<f64> = shown[0].iter().map(|shown| shown.value).collect();
        assert_eq!(values, [-10.0, 380.0, 400.0]);
    }

    fn between(name: &str, values: &[f64], model: &[f64]) -> Vec<Residual> {
        let points: Vec<_> = values
            .iter()
            .enumerate()
            .map(|(row, &value)| MeasuredPoint {
                row,
                value,
                sigma: Some(2.0),
            })
            .collect();
        residuals(RunQuantity::find(name), &points, model)
    }

    #[test]
    fn directions_use_the_nearest_turn_and_counted_turns_stay() {
        for (measured, model, expected) in [
            (
                [352.0, 171.0, 349.0, 172.0],
                [-10.0, 170.0, 350.0, 530.0],
                [2.0, 1.0, -1.0, 2.0],
            ),
            // The model turns twice as fast: read as directions, the values would fit it.
            (
                [360.0, 540.0, 720.0, 900.0],
                [0.0, 540.0, 1080.0, 1620.0],
                [0.0, -360.0, -720.0, -1080.0],
            ),
        ] {
            let all = between("azimuth_deg", &measured, &model);
            let values: Vec<_> = all.iter().map(Residual::value).collect();
            assert_eq!(values, expected);
        }
    }
}
