//! Errors of schemes over time steps, with slopes, or over cost.

use super::view::{TableKind, TableView};
use super::{grouped, numbers, points};
use crate::engine::scenario::Document;
use crate::engine::text::number::significant;
use crate::plot::chart::legend::longest_name;
use crate::plot::chart::ticks;
use crate::plot::chart::{ChartAxis, ChartSeries, Panel, SeriesStyle};
use crate::plot::ink::{self, LABEL_PT};
use crate::plot::letters;
use crate::report::figure::{quantity, size};
use crate::studies::table::{ComparisonSource, TableSource};

const TIME_STEP: &str = "time_step_s";
const ERROR: &str = "error_m";

/// Returns the axis of the time step, the cost or the requested column, and one panel per column.
pub(super) fn drawn(
    table: &TableSource,
    source: &ComparisonSource,
    view: &TableView,
    kind: TableKind,
) -> Result<(ChartAxis, Vec<Panel>), String> {
    let (x, along) = along(table, view, kind)?;
    let groups = grouped(&table.texts("scheme").unwrap_or_default());
    let error = [ERROR.to_owned()];
    let columns = if view.y.is_empty() {
        &error
    } else {
        &view.y[..]
    };
    let is_order = view.x.is_none() && kind == TableKind::Curves;
    let mut panels = Vec::new();
    for column in columns {
        let values = numbers(table, column)?;
        let curves = groups.iter().enumerate().map(|(index, (scheme, rows))| {
            let points = points(rows, &along, &values);
            let name = if points.iter().any(|point| point[1] > 0.0) {
                // Several panels share the names in the legend.
                let slope = slope(&points).filter(|_| is_order && columns.len() == 1);
                named(scheme, slope, view.width_pt)
            } else {
                String::new()
            };
            ChartSeries::new(name, points, SeriesStyle::marked_line(index))
        });
        let mut series: Vec<ChartSeries> = curves.collect();
        if column.starts_with(ERROR) || column == "error_at_end_m" {
            series.extend(rounding(source, &values));
        }
        panels.push(Panel::new(logarithmic(of_comparison(column)), series).of_column(column));
    }
    Ok((logarithmic(x), panels))
}

/// Returns the horizontal axis and the values along it.
fn along(
    table: &TableSource,
    view: &TableView,
    kind: TableKind,
) -> Result<(ChartAxis, Vec<f64>), String> {
    match (&view.x, kind) {
        (Some(column), _) => Ok((of_comparison(column), numbers(table, column)?)),
        (None, TableKind::WorkPrecision) => {
            // Cost at the fastest measured speed, which other work on the machine did not disturb.
            let [steps, step_ns] = ["steps", "ns_per_step"].map(|name| numbers(table, name));
            let costs = steps?.into_iter().zip(step_ns?);
            let axis = ChartAxis::new("computing time", "s");
            Ok((axis, costs.map(|(count, ns)| 1e-9 * count * ns).collect()))
        }
        (None, TableKind::Curves | TableKind::Map) => {
            Ok((of_comparison(TIME_STEP), numbers(table, TIME_STEP)?))
        }
    }
}

/// Returns the stripe of rounding errors, if one of `errors_m` lies in it.
fn rounding(source: &ComparisonSource, errors_m: &[f64]) -> Option<ChartSeries> {
    let document = Document::parse_header("", &source.run_file).ok()?;
    let floor_m = size::rounding_m(&document.scenario().ok()?);
    let is_below = errors_m.iter().any(|error_m| *error_m < floor_m);
    is_below.then(|| ChartSeries::below("rounding", floor_m))
}

fn logarithmic(axis: ChartAxis) -> ChartAxis {
    ChartAxis {
        is_log: true,
        ..axis
    }
}

/// Returns the name of a scheme with the slope of its errors, as markup.
fn named(scheme: &str, slope: Option<f64>, width_pt: f64) -> String {
    let said = slope.map(|slope| format!(", slope {}", significant(slope, 2)));
    let markup = ticks::with_minus(&said.unwrap_or_default());
    let room = longest_name(width_pt) - ink::width(&markup, LABEL_PT);
    letters::shortened(scheme, LABEL_PT, room) + &markup
}

fn of_comparison(name: &str) -> ChartAxis {
    match name {
        "error_m" => ChartAxis::new("largest error", "m"),
        "energy_drift" => ChartAxis::new("relative energy drift", ""),
        "L_axle_drift" => ChartAxis::new("relative drift of *L*_{3}", ""),
        "Lz_drift" => ChartAxis::new("relative drift of *L*_{*z*}", ""),
        "error_at_end_m" => ChartAxis::new("error at the end", "m"),
        "ns_per_step" => ChartAxis::new("cost of a step", "ns"),
        "wall_s" => ChartAxis::new("computing time", "s"),
        name => quantity::axis(name),
    }
}

/// Returns the measured order of a scheme: the slope of its errors on logarithmic axes.
///
/// The slope is measured over the longest range of at least three points in which neighboring slopes differ by at most
/// a sixteenth. Longer steps do not show the order yet, and with shorter steps the error is rounding.
fn slope(points: &[[f64; 2]]) -> Option<f64> {
    const LEAST_DECADE_SPAN: f64 = 0.3;
    const EVEN_DECADES: f64 = 1.0 / 16.0;
    let shown: Vec<&[f64; 2]> = points
        .iter()
        .filter(|point| point[0] > 0.0 && point[1] > 0.0 && point[1].is_finite())
        .collect();
    let slopes: Vec<f64> = shown
        .windows(2)
        .map(|pair| slope_between(pair[0], pair[1]))
        .collect();
    let mut first = 0;
    let even: Vec<_> = slopes
        .chunk_by(|a, b| (a - b).abs() <= EVEN_DECADES * a.max(*b))
        .filter_map(|even| {
            let place = first..first + even.len();
            first = place.end;
            (even.len() >= 2 && even.iter().all(|slope| *slope > LEAST_DECADE_SPAN))
                .then_some(place)
        })
        .collect();
    // Of two ranges of equal length, the one with shorter steps wins; these come first.
    let longest = even.into_iter().rev().max_by_key(ExactSizeIterator::len)?;
    let whole = slope_between(shown[longest.start], shown[longest.end]);
    Some((whole * 10.0).round() / 10.0)
}

/// Returns the slope of the line between two points on logarithmic axes.
fn slope_between(from: &[f64; 2], to: &[f64; 2]) -> f64 {
    libm::log(to[1] / from[1]) / libm::log(to[0] / from[0])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Errors that decrease with these powers each time the time step is halved, starting at the shortest.
    fn errors(slopes: &[f64]) -> Vec<[f64; 2]> {
        let mut points = vec![[1e-3, 1e-6]];
        for slope in slopes {
            let [step, error] = points[points.len() - 1];
            points.push([2.0 * step, error * libm::exp2(*slope)]);
        }
        points
    }

    #[test]
    fn a_slope_needs_three_points_with_a_steady_decrease() {
        let told: &[(&[f64], _)] = &[
            (&[2.0, 2.01, 1.99, 2.4], Some(2.0)),
            (&[0.02, -0.1, 4.0, 3.9], Some(4.0)),
            (&[10.9, 11.1], Some(11.0)),
            // strang on method-2: between the longest steps the error falls by a factor of 280, and then rises.
            (&[0.78, -2.19, 8.16], None),
            (&[1.0, 2.0, 4.0], None),
            // srkn11b on method-2: it has not reached its order yet.
            (&[5.98, 4.98, 3.18], None),
            (&[2.0], None),
        ];
        for (slopes, expected) in told {
            assert_eq!(slope(&errors(slopes)), *expected, "{slopes:?}");
        }
    }
}
