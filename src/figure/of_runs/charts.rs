//! The charts of runs: their curves over time, their paths from above.

use crate::export::Column;
use crate::figure::chart::layout::Layout;
use crate::figure::chart::{Axis, Chart, Circles, Errors, Panel, Series};
use crate::figure::dense::Dense;
use crate::figure::request::{Drawn, Request, Run};
use crate::figure::{chords, dense, quantity, size};
use crate::run::Truth;
use std::sync::Arc;

/// Columns of the runs over time, a panel each.
pub(super) fn over_time(
    title: String,
    runs: &[Run],
    columns: &[&'static Column],
    drawn: &[Drawn],
    request: &Request,
) -> Chart {
    let ends = drawn.iter().map(|drawn| drawn.course.end_s);
    let end_s = ends.fold(0.0, f64::max);
    let range = (end_s > request.from_s).then_some((request.from_s, end_s));
    let panel = |column: &&Column| Panel {
        y: Axis {
            size: size::of(runs, column.name),
            flat_below: size::flat_below(column.name),
            ..quantity::axis(column.name)
        },
        series: drawn
            .iter()
            .map(|drawn| Series {
                name: drawn.name.clone(),
                points: drawn.course.points(*column),
                style: drawn.style.clone(),
                ..Series::default()
            })
            .collect(),
        ..Panel::default()
    };
    let mut panels: Vec<Panel> = columns.iter().map(panel).collect();
    // Only thin lines show many swings beside each other.
    for panel in &mut panels {
        for series in &mut panel.series {
            if series.points.len() > 600 && columns.len() > 1 {
                series.style.width_pt *= 0.75;
            }
        }
    }
    Chart {
        title,
        width_pt: request.width_pt,
        x: Axis {
            range,
            ..quantity::axis("t_s")
        },
        panels,
        is_true_to_scale: false,
        errors: Errors::OfData,
    }
}

pub(super) fn above(title: String, runs: &[Run], drawn: &[Drawn], request: &Request) -> Chart {
    let series = drawn.iter().map(|drawn| {
        let (name, style) = chords::as_drawn(drawn, &drawn.course.above);
        Series {
            name,
            points: drawn
                .course
                .above
                .points
                .iter()
                .map(|at| [at[0], at[1]])
                .collect(),
            style,
            ..Series::default()
        }
    });
    let series: Vec<_> = series.collect();
    let circles = match (request.exact, runs) {
        (true, [run]) => circles(run),
        _ => Circles::default(),
    };
    let (x, y) = both_ranges(&series, size::of(runs, "x_m"));
    Chart {
        title,
        width_pt: request.width_pt,
        x: Axis {
            range: Some(x),
            ..quantity::axis("x_m")
        },
        panels: vec![Panel {
            y: Axis {
                range: Some(y),
                ..quantity::axis("y_m")
            },
            series,
            slope: None,
            circles,
        }],
        is_true_to_scale: true,
        errors: Errors::OfData,
    }
}

pub(super) fn path_warning(chart: &Chart, drawn: &[Drawn], request: &Request) -> Option<Dense> {
    let layout = Layout::new(chart, 0.0);
    let placed = layout.panels.first()?;
    dense::of_paths(drawn, request, |course| {
        let lines = course.above.lines(|at| placed.place(&[at[0], at[1]]));
        (lines, &course.above)
    })
}

/// The radii of the circles between which the exact motion of the traced point stays, from above, m; none where pushes or
/// edits change the motion, or it has no closed form.
fn circles(run: &Run) -> Circles {
    const SAME: f64 = 0.01;
    let scenario = &run.scenario;
    let at = scenario.body.mechanics.points()[scenario.trace].at;
    let is_on_axle = at.xy().norm() <= 1e-9 * at.norm();
    let truth = Truth::new(Arc::clone(scenario));
    let closed = truth.motion().closed_form();
    let is_steady = scenario.pushes.is_empty() && scenario.edits.is_empty();
    let is_heavy = scenario.motion.gravity > 0.0;
    let Some(motion) = closed.filter(|_| is_steady && is_on_axle && is_heavy) else {
        return Circles::default();
    };
    let (low, high) = motion.tilt_range();
    let radius = |tilt: f64| at.norm() * libm::sin(tilt);
    let (inner, outer) = (radius(low), radius(high));
    if (outer - inner).abs() <= SAME * outer.max(inner) {
        return Circles {
            name: "radius of exact".to_owned(),
            radii: vec![0.5 * (inner + outer)],
        };
    }
    Circles {
        name: "limits of exact".to_owned(),
        radii: vec![inner, outer],
    }
}

/// The stretches of both axes of paths of that `size`, m: one is never less than half of the other, so that a path along a
/// line has a picture too.
pub(in crate::figure) fn both_ranges(series: &[Series], size: f64) -> ((f64, f64), (f64, f64)) {
    const LEAST: f64 = 0.5;
    let range = |index: usize| {
        let values = series.iter().flat_map(|series| {
            let errors = [&series.errors_across, &series.errors][index];
            let error = |place: usize| errors.get(place).copied().filter(|it| it.is_finite());
            let points = series.points.iter().enumerate();
            points.flat_map(move |(place, point)| {
                let error = error(place).unwrap_or(0.0);
                [point[index] - error, point[index] + error]
            })
        });
        let axis = Axis {
            size,
            flat_below: size::flat_below("x_m"),
            ..Axis::default()
        };
        axis.range_of(values)
    };
    let (x, y) = (range(0), range(1));
    let least = LEAST * (x.1 - x.0).max(y.1 - y.0);
    let widened = |(low, high): (f64, f64)| {
        let missing = (least - (high - low)).max(0.0);
        (low - 0.5 * missing, high + 0.5 * missing)
    };
    (widened(x), widened(y))
}
