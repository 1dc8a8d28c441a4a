//! Errors of schemes over their time steps, with their slopes.

use super::{grouped, numbers, points};
use crate::engine::text::number::significant;
use crate::plot::chart::legend::longest_name;
use crate::plot::chart::ticks;
use crate::plot::chart::{ChartAxis, ChartSeries, Panel, SeriesStyle};
use crate::plot::ink::{self, LABEL_PT};
use crate::plot::letters;
use crate::report::figure::quantity;
use crate::studies::table::TableSource;

/// The axis of the time step, and a panel for each column.
pub(super) fn drawn(
    table: &TableSource,
    columns: &[&str],
    width_pt: f64,
) -> Result<(ChartAxis, Vec<Panel>), String> {
    let steps = numbers(table, "time_step_s")?;
    let groups = grouped(&table.texts("scheme").unwrap_or_default());
    let columns = columns_or_default(columns);
    let mut panels = Vec::new();
    for column in columns {
        let values = numbers(table, column)?;
        let curves = groups.iter().enumerate().map(|(index, (scheme, rows))| {
            let points = points(rows, &steps, &values);
            let name = if points.iter().any(|point| point[1] > 0.0) {
                // Panels beside each other share their names.
                let slope = slope(&points).filter(|_| columns.len() == 1);
                named(scheme, slope, width_pt)
            } else {
                String::new()
            };
            ChartSeries::new(name, points, SeriesStyle::marked_line(index))
        });
        let y = logarithmic(of_comparison(column));
        panels.push(Panel::new(y, curves.collect()));
    }
    Ok((logarithmic(quantity::axis("time_step_s")), panels))
}

fn logarithmic(axis: ChartAxis) -> ChartAxis {
    ChartAxis {
        is_log: true,
        ..axis
    }
}

/// A scheme and the slope of its errors, as markup.
fn named(scheme: &str, slope: Option<f64>, width_pt: f64) -> String {
    let said = slope.map(|slope| format!(", slope {}", significant(slope, 2)));
    let markup = ticks::with_minus(&said.unwrap_or_default());
    let room = longest_name(width_pt) - ink::width(&markup, LABEL_PT);
    letters::shortened(scheme, LABEL_PT, room) + &markup
}

/// The columns that are drawn where `columns` were asked for.
fn columns_or_default<'a>(columns: &'a [&'a str]) -> &'a [&'a str] {
    if columns.is_empty() {
        &["error_m"]
    } else {
        columns
    }
}

fn of_comparison(name: &str) -> ChartAxis {
    match name {
        "error_m" => ChartAxis::new("largest error", "m"),
        "energy_drift" => ChartAxis::new("relative energy drift", ""),
        "L_axle_drift" => ChartAxis::new("relative drift of *L*_{3}", ""),
        "Lz_drift" => ChartAxis::new("relative drift of *L*_{*z*}", ""),
        "ns_per_step" => ChartAxis::new("cost of a step", "ns"),
        name => quantity::axis(name),
    }
}

/// The measured order of a scheme: the slope of its errors on logarithmic axes. It is taken from end to end of the longest stretch of at least three points in which neighbouring slopes differ by a
/// sixteenth at most. Coarser steps do not show the order yet; of finer ones the error is rounding.
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
    // Of two that are as long, the one of the shorter steps, which come first.
    let longest = even.into_iter().rev().max_by_key(ExactSizeIterator::len)?;
    let whole = slope_between(shown[longest.start], shown[longest.end]);
    Some((whole * 10.0).round() / 10.0)
}

/// Returns the slope of the line from one point to another on logarithmic axes.
fn slope_between(from: &[f64; 2], to: &[f64; 2]) -> f64 {
    libm::log(to[1] / from[1]) / libm::log(to[0] / from[0])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Errors that fall by these powers from each time step to its half, from the shortest on.
    fn errors(slopes: &[f64]) -> Vec<[f64; 2]> {
        let mut points = vec![[1e-3, 1e-6]];
        for slope in slopes {
            let [step, error] = points[points.len() - 1];
            points.push([2.0 * step, error * libm::exp2(*slope)]);
        }
        points
    }

    #[test]
    fn a_slope_is_told_where_the_error_falls_evenly_over_three_points_and_not_by_leaps() {
        let told: &[(&[f64], _)] = &[
            (&[2.0, 2.01, 1.99, 2.4], Some(2.0)),
            (&[0.02, -0.1, 4.0, 3.9], Some(4.0)),
            (&[10.9, 11.1], Some(11.0)),
            // strang on method-2: between its coarsest steps the error falls by a factor of 280, and rises then.
            (&[0.78, -2.19, 8.16], None),
            (&[1.0, 2.0, 4.0], None),
            // srkn11b on method-2: it has not come to its order yet.
            (&[5.98, 4.98, 3.18], None),
            (&[2.0], None),
        ];
        for (slopes, expected) in told {
            assert_eq!(slope(&errors(slopes)), *expected, "{slopes:?}");
        }
    }
}
