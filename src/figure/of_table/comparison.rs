//! Errors of schemes over their time steps, with their slopes.

use super::{grouped, numbers};
use crate::figure::chart::legend::longest_name;
use crate::figure::chart::ticks;
use crate::figure::chart::{Axis, Panel, Series, Style};
use crate::figure::page::ink::{self, LABEL_PT};
use crate::figure::page::letters;
use crate::figure::quantity;
use crate::figure::table::Table;
use crate::text::number::significant;

/// The axis of the time step, and a panel for each column.
pub(super) fn drawn(
    table: &Table,
    columns: &[&str],
    width_pt: f64,
) -> Result<(Axis, Vec<Panel>), String> {
    let steps = numbers(table, "time_step_s")?;
    let schemes = table.texts("scheme").unwrap_or_default();
    let groups = grouped(&schemes);
    let columns = if columns.is_empty() {
        &["error_m"]
    } else {
        columns
    };
    let panel = |name: &&str| -> Result<Panel, String> {
        let values = numbers(table, name)?;
        let mut best: Option<(usize, f64)> = None;
        let series = groups.iter().enumerate().map(|(index, (scheme, rows))| {
            let points = sorted(rows.iter().map(|&row| [steps[row], values[row]]));
            let slope = slope(&points);
            if let Some((count, slope)) = slope
                && best.is_none_or(|best| (count, slope) > best)
            {
                best = Some((count, slope));
            }
            // Panels beside each other share their names.
            let slope = slope.filter(|_| columns.len() == 1);
            let slope = slope.map(|(_, slope)| format!(", slope {}", significant(slope, 2)));
            let slope = ticks::with_minus(&slope.unwrap_or_default());
            let room = longest_name(width_pt) - ink::width(&slope, LABEL_PT);
            Series {
                name: letters::shortened(scheme, LABEL_PT, room) + &slope,
                points,
                errors: Vec::new(),
                errors_across: Vec::new(),
                style: Style::marked_line(index),
            }
        });
        let series: Vec<_> = series.collect();
        Ok(Panel {
            y: Axis {
                is_log: true,
                ..of_comparison(name)
            },
            series,
            slope: best.map(|(_, slope)| slope),
            circles: Vec::new(),
        })
    };
    let panels = columns.iter().map(panel).collect::<Result<Vec<_>, _>>()?;
    let x = Axis {
        is_log: true,
        ..quantity::axis("time_step_s")
    };
    Ok((x, panels))
}

/// The axis of a column of a comparison.
fn of_comparison(name: &str) -> Axis {
    match name {
        "error_m" => Axis::new("largest error", "m"),
        "ns_per_step" => Axis::new("cost of a step", "ns"),
        name => quantity::axis(name),
    }
}

/// The slope of a line of errors on logarithmic axes: the middle one of those between two points, where the error still falls
/// evenly, and between how many points it was found. What no longer falls is rounding.
fn slope(points: &[[f64; 2]]) -> Option<(usize, f64)> {
    const LEAST: f64 = 0.3;
    let is_sound = |point: &&[f64; 2]| point[0] > 0.0 && point[1] > 0.0 && point[1].is_finite();
    let points: Vec<_> = points.iter().filter(is_sound).collect();
    let slope = |pair: &[&[f64; 2]]| {
        libm::log(pair[1][1] / pair[0][1]) / libm::log(pair[1][0] / pair[0][0])
    };
    let slopes = points.windows(2).map(slope);
    let mut slopes: Vec<f64> = slopes
        .filter(|slope| slope.is_finite() && *slope > LEAST)
        .collect();
    slopes.sort_by(f64::total_cmp);
    // Two pairs are the least that tell a slope.
    let middle = *slopes.get(slopes.len() / 2)?;
    (slopes.len() >= 2).then_some((slopes.len(), (middle * 10.0).round() / 10.0))
}

/// `points` in the order of their first numbers.
fn sorted(points: impl Iterator<Item = [f64; 2]>) -> Vec<[f64; 2]> {
    let mut points: Vec<_> = points.filter(|point| point[0].is_finite()).collect();
    points.sort_by(|a, b| a[0].total_cmp(&b[0]));
    points
}
