//! Measured positions of the traced point, seen from above.

use super::TimeSeries;
use nalgebra::{Vector2, Vector3};

/// Fraction of its distance from the pivot. A traced point nearer to the axle than this is on the axle.
const PLACE_ON_AXLE: f64 = 1e-9;

/// A measured position of the traced point, seen from above.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeasuredPlace {
    pub time_s: f64,
    /// x and y, world frame, m.
    pub at: Vector2<f64>,
    /// Standard uncertainty of each, m, if given.
    pub sigmas: [Option<f64>; 2],
}

/// Returns the measured positions of the point `traced` (body frame, m). They come from x and y or, if the point is on
/// the axle, from tilt and azimuth. Empty if the columns of `series` do not determine them.
pub fn places(series: &TimeSeries, traced: &Vector3<f64>) -> Vec<MeasuredPlace> {
    let [x, y, tilt, azimuth] = ["x_m", "y_m", "tilt_deg", "azimuth_deg"].map(|name| {
        let mut curves = series.curves.iter();
        curves.find(|curve| curve.quantity.name == name)
    });
    let is_on_axle = traced.xy().norm() <= PLACE_ON_AXLE * traced.norm();
    let polar = tilt.zip(azimuth).filter(|_| is_on_axle);
    let (pair, is_polar) = match (x.zip(y), polar) {
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
        let (at, sigmas) = if is_polar {
            on_axle(traced.z, values, sigmas)
        } else {
            (values, sigmas)
        };
        places.push(MeasuredPlace {
            time_s: series.times_s[first.row],
            at: at.into(),
            sigmas,
        });
    }
    places
}

/// Returns x and y, and their uncertainties, of a point on the axle `length_m` from the pivot. Tilt and azimuth are in
/// degrees, with independent uncertainties.
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
    let outwards = length_m * cos_tilt * of_tilt.unwrap_or(0.0).to_radians();
    let around = length_m * sin_tilt * of_azimuth.unwrap_or(0.0).to_radians();
    let sigmas = [(cos, sin), (sin, cos)]
        .map(|(out, round)| Some(libm::hypot(outwards * out, around * round)));
    (at, sigmas)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::read;

    #[test]
    fn tilt_and_azimuth_give_the_position_from_above() {
        let measured = read(
            "test.csv",
            "t_s,tilt_deg,tilt_uncertainty_deg,azimuth_deg,azimuth_uncertainty_deg\n0,30,1,90,2\n1,,,90,2\n2,90,1,180,\n",
        );
        let series = measured.unwrap();
        let series = series.series().unwrap();
        let found = places(series, &Vector3::new(0.0, 0.0, 2.0));
        assert_eq!(found.len(), 2, "a row without a tilt is no place");
        let near = |a: f64, b: f64| (a - b).abs() < 1e-12;
        assert!(near(found[0].at.x, 0.0) && near(found[0].at.y, 1.0));
        let degree = 1_f64.to_radians();
        assert!(near(found[0].sigmas[0].unwrap(), 2.0 * degree));
        assert!(near(found[0].sigmas[1].unwrap(), 3_f64.sqrt() * degree));
        let aside = Vector3::new(0.1, 0.0, 1.0);
        assert!(places(series, &aside).is_empty());
    }
}
