//! Measured data held against a run: each value with what the run says of it, and all of them in a few numbers.

use crate::measured::{Curve, Quantity, Series, residuals};
use nalgebra::{Vector2, Vector3};

/// A traced point that is nearer to the axle than this part of its distance from the pivot is on it.
const ON_AXLE: f64 = 1e-9;

/// Measured data and what the run says of them.
#[derive(Clone, Debug, Default)]
pub struct Compared {
    /// The values of each column, in the order of time.
    pub curves: Vec<Vec<Shown>>,
    /// Where the traced point was measured to be, from above; empty where the columns do not tell.
    pub places: Vec<Place>,
    /// All of it in a few numbers.
    pub sum: Sum,
}

/// A measured value as it is shown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shown {
    /// When it was measured, s.
    pub time_s: f64,
    /// The value, in the unit of its column; of a direction, with the number of full turns at which it is nearest to the run.
    pub value: f64,
    /// One standard uncertainty of it, where it is stated.
    pub sigma: Option<f64>,
    /// What the run says; `None` for times that it has not reached.
    pub model: Option<f64>,
}

/// Where the traced point was measured to be, from above.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// When, s.
    pub time_s: f64,
    /// x and y, m.
    pub at: Vector2<f64>,
    /// One standard uncertainty of each, m, where it is stated.
    pub sigmas: [Option<f64>; 2],
}

/// How far data and run are apart, in a few numbers.
#[derive(Clone, Debug, Default)]
pub struct Sum {
    /// How many values were measured.
    pub points: usize,
    /// How many of them the run has reached.
    pub compared: usize,
    /// How many of these have an uncertainty.
    pub weighed: usize,
    /// The sum of the squares of their residuals in units of the uncertainty.
    pub chi_squared: f64,
    /// The largest of these residuals.
    pub largest: Option<Largest>,
    /// The root of the mean square of the residuals without uncertainty, for each column that has some.
    pub scatter: Vec<(&'static Quantity, f64)>,
}

/// The largest residual in units of the uncertainty.
#[derive(Clone, Copy, Debug)]
pub struct Largest {
    /// Its size.
    pub sigmas: f64,
    /// What was measured.
    pub quantity: &'static Quantity,
    /// When, s.
    pub time_s: f64,
}

impl Shown {
    /// Measured less run.
    pub fn residual(&self) -> Option<f64> {
        self.model.map(|model| self.value - model)
    }
}

impl Compared {
    /// `series` against the `model`, the values of a run at the first points of each curve, up to `now_s`. `traced` is the
    /// traced point, body frame, m.
    pub fn new(series: &Series, model: &[Vec<f64>], now_s: f64, traced: &Vector3<f64>) -> Self {
        let mut sum = Sum::default();
        let curves = series.curves.iter().zip(model);
        let curves = curves.map(|(curve, model)| {
            let reached = reached(series, curve, now_s).min(model.len());
            let shown = shown(series, curve, &model[..reached]);
            sum.take(curve.quantity, &shown);
            shown
        });
        Self {
            curves: curves.collect(),
            places: places(series, traced),
            sum,
        }
    }
}

/// How many of the points of `curve` were measured at `now_s` or before.
fn reached(series: &Series, curve: &Curve, now_s: f64) -> usize {
    let is_reached = |point: &crate::measured::Point| series.times_s[point.row] <= now_s;
    curve.points.partition_point(is_reached)
}

/// The points of `curve`, of which the first have the values `model`.
fn shown(series: &Series, curve: &Curve, model: &[f64]) -> Vec<Shown> {
    let held = residuals(Some(curve.quantity), &curve.points, model);
    let mut shown: Vec<Shown> = Vec::with_capacity(curve.points.len());
    for (index, point) in curve.points.iter().enumerate() {
        let residual = held.get(index);
        // A direction that the run has not reached is taken at the turn that is nearest to the last one.
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
            if self
                .largest
                .is_none_or(|largest| sigmas.abs() > largest.sigmas)
            {
                self.largest = Some(Largest {
                    sigmas: sigmas.abs(),
                    quantity,
                    time_s: point.time_s,
                });
            }
        }
        if count > 0 {
            let scatter = (squares / f64::from(count)).sqrt();
            self.scatter.push((quantity, scatter));
        }
    }
}

/// Where the traced point was measured to be: by x and y, or else by tilt and azimuth, where it is on the axle.
fn places(series: &Series, traced: &Vector3<f64>) -> Vec<Place> {
    let of = |name: &str| {
        let mut curves = series.curves.iter();
        curves.find(|curve| curve.quantity.name == name)
    };
    let is_on_axle = traced.xy().norm() <= ON_AXLE * traced.norm();
    let polar = || Some((of("tilt_deg")?, of("azimuth_deg")?)).filter(|_| is_on_axle);
    let (pair, is_polar) = match (of("x_m").zip(of("y_m")), polar()) {
        (Some(pair), _) => (pair, false),
        (None, Some(pair)) => (pair, true),
        (None, None) => return Vec::new(),
    };
    let mut second = pair.1.points.iter().peekable();
    let mut places = Vec::new();
    for first in &pair.0.points {
        while second.next_if(|point| point.row < first.row).is_some() {}
        let Some(other) = second.next_if(|point| point.row == first.row) else {
            continue;
        };
        let (values, sigmas) = ([first.value, other.value], [first.sigma, other.sigma]);
        let (at, sigmas) = match is_polar {
            true => on_axle(traced.z, values, sigmas),
            false => (values, sigmas),
        };
        places.push(Place {
            time_s: series.times_s[first.row],
            at: at.into(),
            sigmas,
        });
    }
    places
}

/// x and y, and their uncertainties, of a point on the axle `length_m` from the pivot, from tilt and azimuth, degrees, which
/// are uncertain independently of each other.
fn on_axle(
    length_m: f64,
    [tilt, azimuth]: [f64; 2],
    [of_tilt, of_azimuth]: [Option<f64>; 2],
) -> ([f64; 2], [Option<f64>; 2]) {
    let (sin_tilt, cos_tilt) = libm::sincos(tilt.to_radians());
    let (sin, cos) = libm::sincos(azimuth.to_radians());
    let at = [length_m * sin_tilt * cos, length_m * sin_tilt * sin];
    if (of_tilt, of_azimuth) == (None, None) {
        return (at, [None, None]);
    }
    let radians = |sigma: Option<f64>| sigma.unwrap_or(0.0).to_radians();
    let outwards = length_m * cos_tilt * radians(of_tilt);
    let around = length_m * sin_tilt * radians(of_azimuth);
    let sigma = |out: f64, round: f64| Some(libm::hypot(outwards * out, around * round));
    (at, [sigma(cos, sin), sigma(sin, cos)])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measured::{Data, read};

    fn series(text: &str) -> Series {
        match read("test.csv", text).unwrap().data {
            Data::Series(series) => series,
            Data::Table(_) => panic!("a series was expected"),
        }
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
    fn tilt_and_azimuth_tell_the_place_from_above() {
        let series = series(
            "t_s,tilt_deg,tilt_uncertainty_deg,azimuth_deg,azimuth_uncertainty_deg\n0,30,1,90,2\n1,,,90,2\n2,90,1,180,\n",
        );
        let none = [Vec::new(), Vec::new()];
        let places = Compared::new(&series, &none, 0.0, &up()).places;
        assert_eq!(places.len(), 2, "a row without a tilt is no place");
        let near = |a: f64, b: f64| (a - b).abs() < 1e-12;
        assert!(near(places[0].at.x, 0.0) && near(places[0].at.y, 1.0));
        let degree = 1_f64.to_radians();
        assert!(near(places[0].sigmas[0].unwrap(), 2.0 * degree));
        assert!(near(places[0].sigmas[1].unwrap(), 3_f64.sqrt() * degree));
        let aside = Vector3::new(0.1, 0.0, 1.0);
        assert!(Compared::new(&series, &none, 0.0, &aside).places.is_empty());
    }

    #[test]
    fn directions_stay_on_the_turn_of_the_run() {
        let series = series("t_s,azimuth_deg\n0,350\n1,20\n2,40\n");
        let shown = Compared::new(&series, &[vec![-5.0, 375.0]], 1.0, &up()).curves;
        let values: Vec<f64> = shown[0].iter().map(|shown| shown.value).collect();
        assert_eq!(values, [-10.0, 380.0, 400.0]);
    }
}
