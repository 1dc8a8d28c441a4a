//! Finds measured data that cannot be right for a scenario, most often because of a unit.

use super::hint::MOST_TILT_RAD;
use super::{MeasuredData, TimeSeries, at_times};
use crate::scenario::Scenario;
use crate::text::number::significant;
use crate::text::printable::printable;
use std::sync::Arc;

/// Tolerance on the measured distance of a point from the pivot, as a fraction of its arm.
const MARGIN: f64 = 0.05;
/// Maximum number of times at which the run's tilt is read.
const MOST_TIMES: usize = 100;
/// Maximum number of steps for reading the run's tilt.
const MOST_STEPS: f64 = 1e5;

/// Describes what cannot be right in `measured` for the body of `scenario`. Empty if nothing is found.
pub fn doubts(measured: &MeasuredData, scenario: &Arc<Scenario>) -> Vec<String> {
    let Ok(series) = measured.series() else {
        return Vec::new();
    };
    let found = [
        point_beyond_arm(series, scenario.arm_m()),
        tilt_in_radians(series, scenario),
    ];
    let origin = printable(&measured.origin);
    found
        .into_iter()
        .flatten()
        .map(|doubt| format!("{origin}: {doubt}"))
        .collect()
}

/// Returns a warning if a point was measured farther from the pivot than its arm.
fn point_beyond_arm(series: &TimeSeries, arm_m: f64) -> Option<String> {
    let mut squares = vec![0.0; series.times_s.len()];
    let (mut names, mut sigma) = (Vec::new(), 0.0_f64);
    for curve in &series.curves {
        if ["x_m", "y_m", "z_m"].contains(&curve.quantity.name) {
            names.push(curve.quantity.name);
            for point in &curve.points {
                squares[point.row] += point.value * point.value;
                sigma = sigma.max(point.sigma.unwrap_or(0.0));
            }
        }
    }
    let farthest_m = squares.into_iter().fold(0.0, f64::max).sqrt();
    if farthest_m - 3.0 * sigma <= (1.0 + MARGIN) * arm_m {
        return None;
    }
    let unit = match farthest_m / arm_m {
        30.0..300.0 => "cm",
        300.0..3000.0 => "mm",
        _ => "",
    };
    let cure = match unit {
        "" => "check the unit and the origin of the coordinates".to_owned(),
        unit => {
            let columns: Vec<String> = names
                .iter()
                .map(|name| {
                    let axis = name.trim_end_matches("_m");
                    format!("{axis}={axis}_{unit}")
                })
                .collect();
            format!("are they in {unit}? --map {}", columns.join(","))
        }
    };
    Some(format!(
        "{}: the point was measured up to {} m from the pivot, but its distance is {} m: {cure}",
        names.join(", "),
        significant(farthest_m, 3),
        significant(arm_m, 3)
    ))
}

/// Returns a warning if a tilt may be in radians, because it never exceeds pi while the run's tilt does.
fn tilt_in_radians(series: &TimeSeries, scenario: &Arc<Scenario>) -> Option<String> {
    let curve = series
        .curves
        .iter()
        .find(|curve| curve.quantity.name == "tilt_deg")?;
    let values_deg = curve.points.iter().map(|point| point.value.abs());
    let most_deg = values_deg.fold(0.0, f64::max);
    if most_deg > MOST_TILT_RAD || curve.points.is_empty() {
        return None;
    }
    let last_s = series.times_s.last().copied().unwrap_or(0.0);
    let mut few = TimeSeries {
        times_s: series.times_s.clone(),
        curves: vec![curve.clone()],
    };
    let every = curve.points.len().div_ceil(MOST_TIMES);
    few.curves[0].points = curve.points.iter().copied().step_by(every).collect();
    if last_s / scenario.motion.time_step_s > MOST_STEPS {
        few.curves[0].points.truncate(1);
    }
    let of_run = at_times(&few, scenario, &|| true).ok()??;
    let of_run_deg = of_run.into_iter().flatten().fold(0.0, f64::max);
    (of_run_deg > MOST_TILT_RAD).then(|| {
        format!(
            "tilt_deg never exceeds {}, and the run's tilt reaches {} degrees: is it in radians? --map COLUMN=tilt_rad",
            significant(most_deg, 3),
            significant(of_run_deg, 3)
        )
    })
}
