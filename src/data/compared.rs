//! Measured data compared with a run: each value beside the run's, and statistics of all.

use super::{Curve, Place, Quantity, Series, places, residuals};
use nalgebra::Vector3;

/// Measured data, each value beside the run's.
#[derive(Clone, Debug, Default)]
pub struct Compared {
    /// The values of each column, in the order of time.
    pub curves: Vec<Vec<Shown>>,
    /// Where the traced point was measured to be, from above; empty where the columns do not tell.
    pub places: Vec<Place>,
    pub sum: Sum,
    pub sums: Vec<Sum>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shown {
    pub time_s: f64,
    /// The value, in the unit of its column; of a direction, with the number of full turns at which it is nearest to the run.
    pub value: f64,
    /// One standard uncertainty of it, where it is stated.
    pub sigma: Option<f64>,
    /// The value in the run; `None` for times that it has not reached.
    pub model: Option<f64>,
}

#[derive(Clone, Debug, Default)]
pub struct Sum {
    pub points: usize,
    /// How many of them the run has reached.
    pub compared: usize,
    pub weighed: usize,
    /// The sum of the squares of their residuals in units of the uncertainty.
    pub chi_squared: f64,
    pub largest: Option<Largest>,
    /// The root of the mean square of the residuals without uncertainty, for each column that has some.
    pub scatter: Vec<(&'static Quantity, f64)>,
}

/// The largest residual in units of the uncertainty.
#[derive(Clone, Copy, Debug)]
pub struct Largest {
    pub sigmas: f64,
    pub quantity: &'static Quantity,
    pub time_s: f64,
}

impl Shown {
    pub fn residual(&self) -> Option<f64> {
        self.model.map(|model| self.value - model)
    }
}

impl Compared {
    /// `series` against the `model`, the values of a run at the first points of each curve, up to `now_s`. `traced` is the
    /// traced point, body frame, m.
    pub fn new(series: &Series, model: &[Vec<f64>], now_s: f64, traced: &Vector3<f64>) -> Self {
        let mut compared = Self {
            places: places(series, traced),
            ..Self::default()
        };
        for (curve, model) in series.curves.iter().zip(model) {
            let reached = reached(series, curve, now_s).min(model.len());
            let shown = shown(series, curve, &model[..reached]);
            compared.sum.take(curve.quantity, &shown);
            let mut own = Sum::default();
            own.take(curve.quantity, &shown);
            compared.sums.push(own);
            compared.curves.push(shown);
        }
        compared
    }
}

/// How many of the points of `curve` were measured at `now_s` or before.
fn reached(series: &Series, curve: &Curve, now_s: f64) -> usize {
    let is_reached = |point: &crate::data::Point| series.times_s[point.row] <= now_s;
    curve.points.partition_point(is_reached)
}

/// The points of `curve`. The first of them have the values `model` in the run.
fn shown(series: &Series, curve: &Curve, model: &[f64]) -> Vec<Shown> {
    let held = residuals(Some(curve.quantity), &curve.points, model);
    let mut shown: Vec<Shown> = Vec::with_capacity(curve.points.len());
    for (index, point) in curve.points.iter().enumerate() {
        let residual = held.get(index);
        // A direction that the run has not reached gets the number of turns that is nearest to the last one.
        let value = match (residual, shown.last()) {
            (Some(residual), _) => residual.measured,
            (None, Some(before)) if curve.quantity.is_direction => {
                point.value + (before.value - curve.points[index - 1].value)
            }
            (None, _) => point.value,
        };
        shown.push(Shown {
            time_s: series.times_s[point.row],
            value,
            sigma: point.sigma,
            model: residual.map(|residual| residual.model),
        });
    }
    shown
}

impl Sum {
    /// Takes in the values of `quantity`.
    fn take(&mut self, quantity: &'static Quantity, shown: &[Shown]) {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::read;

    fn series(text: &str) -> Series {
        read("test.csv", text).unwrap().series().unwrap().clone()
    }

    fn up() -> Vector3<f64> {
        Vector3::new(0.0, 0.0, 2.0)
    }

    #[test]
    fn what_the_run_has_not_reached_is_not_compared() {
        let series =
            series("t_s,spin_rpm,spin_uncertainty_rpm,tilt_deg\n0,10,2,5\n1,20,4,7\n2,30,2,\n");
        let model = [vec![11.0, 12.0, 30.0], vec![4.0, 10.0]];
        let at = |now_s| Compared::new(&series, &model, now_s, &up());
        let early = at(0.5);
        assert_eq!((early.sum.points, early.sum.compared), (5, 2));
        assert_eq!(early.sum.chi_squared, 0.25);
        assert_eq!(early.curves[0][1].model, None);
        let late = at(2.0).sum;
        assert_eq!((late.compared, late.weighed), (5, 3));
        assert_eq!(late.chi_squared, 0.25 + 4.0);
        let largest = late.largest.unwrap();
        assert_eq!((largest.sigmas, largest.time_s), (2.0, 1.0));
        assert_eq!(largest.quantity.name, "spin_rpm");
        // (5 - 4)^2 and (7 - 10)^2.
        let [(quantity, scatter)] = late.scatter[..] else {
            panic!("{:?}", late.scatter)
        };
        assert_eq!((quantity.name, scatter), ("tilt_deg", 5.0_f64.sqrt()));
    }

    #[test]
    fn directions_stay_on_the_turn_of_the_run() {
        let series = series("t_s,azimuth_deg\n0,350\n1,20\n2,40\n");
        let shown = Compared::new(&series, &[vec![-5.0, 375.0]], 1.0, &up()).curves;
        let values: Vec<f64> = shown[0].iter().map(|shown| shown.value).collect();
        assert_eq!(values, [-10.0, 380.0, 400.0]);
    }
}
