//! The charts of runs: curves over time, and paths from above.

use crate::engine::export::CsvColumn;
use crate::engine::run::Truth;
use crate::engine::run::marks::Marks;
use crate::plot::chart::layout::ChartLayout;
use crate::plot::chart::{Chart, ChartAxis, ChartSeries, Panel, SeriesStyle};
use crate::report::figure::job::{Dense, FigureJob, FigureRun, SampledRunNumbers};
use crate::report::figure::spec::FigureSpec;
use crate::report::figure::{chords, dense, quantity, size};
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

/// Number of points above which the lines are thinner, and their width relative to the default.
const MANY_POINTS: usize = 600;
const THIN: f64 = 0.75;

/// Creates the chart of columns over time, one panel per column.
pub(super) fn over_time(
    job: &FigureJob<'_>,
    columns: &[&'static CsvColumn],
    drawn: &[SampledRunNumbers],
) -> Chart {
    let from_s = job.spec.from_s;
    let ends = drawn.iter().map(|drawn| drawn.course.end_s);
    let end_s = ends.fold(0.0, f64::max);
    let mut x = quantity::axis("t_s");
    x.range = (end_s > from_s).then_some((from_s, end_s));
    let panels = columns.iter().map(|column| {
        let mut series: Vec<_> = drawn
            .iter()
            .map(|drawn| {
                let points = drawn.course.points(column);
                ChartSeries::new(&drawn.name, points, drawn.style.clone())
            })
            .collect();
        // Many swings in several panels are only visible with thin lines.
        if columns.len() > 1
            && series
                .iter()
                .any(|series| series.points.len() > MANY_POINTS)
        {
            for curve in &mut series {
                curve.style.width_pt *= THIN;
            }
        }
        series.extend(pushes(job.runs, from_s, end_s));
        series.extend(unpredictable(drawn, from_s, end_s));
        Panel::new(size::axis(job.runs, column.name), series).of_column(column.name)
    });
    job.chart(x, panels.collect())
}

/// Fraction of the time range, from its start, in which the errors do not extend their axis, because they start at 0.
const BEGINNING: f64 = 0.01;
/// Lower end of an axis of errors, relative to the limit of rounding, and relative to the maximum of a curve below this
/// limit.
const ROUNDING_SHOWN: f64 = 0.1;
const CURVE_SHOWN: f64 = 0.3;

/// Gives `chart`, which shows distances of `runs` from the exact motion over time, a logarithmic axis.
///
/// The axis reaches neither 0, where the errors start, nor far below the limit of rounding, where the size of a
/// distance is meaningless. A stripe marks the values below this limit.
pub(super) fn as_errors(chart: &mut Chart, runs: &[FigureRun]) {
    let floors = runs.iter().map(|run| size::rounding_m(&run.scenario));
    let floor_m = floors.fold(0.0, f64::max);
    let (from_s, to_s) = chart.x.range.unwrap_or_default();
    let first_s = from_s + BEGINNING * (to_s - from_s);
    for panel in &mut chart.panels {
        panel.y = ChartAxis {
            is_log: true,
            ..ChartAxis::new("distance from exact motion", panel.y.unit.clone())
        };
        let of_curves: Vec<Vec<f64>> = panel
            .series
            .iter()
            .map(|series| {
                let later = series.points.iter().filter(|point| point[0] >= first_s);
                later.map(|point| point[1]).collect()
            })
            .collect();
        let (lowest, highest) = panel.y.range_of(of_curves.iter().flatten().copied());
        let highest_of_each = of_curves
            .iter()
            .map(|values| values.iter().copied().fold(0.0, f64::max));
        let least_m = highest_of_each
            .filter(|value| *value > 0.0)
            .fold(f64::INFINITY, f64::min);
        let end = lowest.max((ROUNDING_SHOWN * floor_m).min(CURVE_SHOWN * least_m));
        panel.y.range = Some((end, highest.max(end / ROUNDING_SHOWN)));
        if end < floor_m {
            panel.series.push(ChartSeries::below("rounding", floor_m));
        }
    }
}

/// Returns the stripes of the pushes of `runs` between two times, s; each time range once.
fn pushes(runs: &[FigureRun], from_s: f64, end_s: f64) -> Vec<ChartSeries> {
    let mut stretches: Vec<(f64, f64)> = Vec::new();
    for (begin, end) in runs.iter().flat_map(|run| Marks::new(&run.scenario).pushes) {
        let stretch = (begin.max(from_s), end.min(end_s));
        if stretch.0 < stretch.1 && !stretches.contains(&stretch) {
            stretches.push(stretch);
        }
    }
    let stripes = stretches
        .iter()
        .map(|(begin, end)| ChartSeries::push(*begin, *end));
    stripes.collect()
}

/// Returns the stripe of the time after which the motion of one of the runs `drawn` cannot be predicted, between two
/// times, s.
fn unpredictable(drawn: &[SampledRunNumbers], from_s: f64, end_s: f64) -> Option<ChartSeries> {
    let times = drawn.iter().filter_map(|it| it.course.predictable_until_s);
    let until_s = times.fold(f64::INFINITY, f64::min);
    (until_s < end_s).then(|| ChartSeries::unpredictable(until_s.max(from_s), end_s))
}

/// Creates the chart of the paths from above, with the `measured` positions.
pub(super) fn above(
    job: &FigureJob<'_>,
    drawn: &[SampledRunNumbers],
    measured: Option<ChartSeries>,
) -> Chart {
    let mut series: Vec<_> = drawn
        .iter()
        .map(|drawn| {
            let path = &drawn.course.above;
            let (name, style) = chords::as_drawn(drawn, path);
            let points = path.points.iter().map(|at| [at[0], at[1]]);
            ChartSeries::new(name, points.collect(), style)
        })
        .chain(measured)
        .collect();
    if job.spec.from_s == 0.0 {
        let starts = starts(&series[..drawn.len()]);
        series.extend(starts);
    }
    let [x, y] = both_ranges(&series, job.runs);
    if let (true, [run]) = (job.spec.exact, job.runs) {
        series.extend(limits(run, job.spec.page_width_pt() / (x.1 - x.0)));
    }
    let panel = Panel::new(quantity::axis("y_m").within(y), series);
    Chart {
        is_true_to_scale: true,
        ..job.chart(quantity::axis("x_m").within(x), vec![panel])
    }
}

/// Starts closer together than this are one, m.
const SAME_START_M: f64 = 1e-6;

/// Returns an open circle at the start of each of `paths`, one where several paths start at the same place.
fn starts(paths: &[ChartSeries]) -> Vec<ChartSeries> {
    let mut starts: Vec<ChartSeries> = Vec::new();
    for path in paths {
        let is_new = |start: &&[f64; 2]| {
            let mut others = starts.iter().map(|other| other.points[0]);
            !others
                .any(|other| libm::hypot(other[0] - start[0], other[1] - start[1]) < SAME_START_M)
        };
        if let Some(start) = path.points.first().filter(is_new) {
            let name = if starts.is_empty() { "start" } else { "" };
            let style = SeriesStyle::start(&path.style);
            starts.push(ChartSeries::new(name.to_owned(), vec![*start], style));
        }
    }
    starts
}

pub(super) fn path_warning(
    chart: &Chart,
    drawn: &[SampledRunNumbers],
    spec: &FigureSpec,
) -> Option<Dense> {
    let layout = ChartLayout::new(chart, 0.0);
    let placed = layout.panels.first()?;
    dense::of_paths(
        drawn,
        spec,
        |course| &course.above,
        |at| placed.place(&[at[0], at[1]]),
    )
}

/// Returns the circles between which the exact motion of the traced point stays, seen from above. There are none if the
/// motion is a circle, if pushes or edits change it, or if it has no closed form. A meter is `pt_per_m` long on the
/// page.
fn limits(run: &FigureRun, pt_per_m: f64) -> Vec<ChartSeries> {
    const SAME_CURVE: f64 = 0.01;
    let scenario = &run.scenario;
    let at = scenario.body.mechanics.points()[scenario.trace].at;
    let is_on_axle = at.xy().norm() <= 1e-9 * at.norm();
    let truth = Truth::new(Arc::clone(scenario));
    let closed = truth.motion().closed_form();
    let is_steady = scenario.pushes.is_empty() && scenario.edits.is_empty();
    let is_heavy = scenario.motion.gravity > 0.0;
    let Some(motion) = closed.filter(|_| is_steady && is_on_axle && is_heavy) else {
        return Vec::new();
    };
    let (low, high) = motion.tilt_range();
    let [inner, outer] = [low, high].map(|tilt| at.norm() * libm::sin(tilt));
    if (outer - inner).abs() <= SAME_CURVE * outer.max(inner) {
        return Vec::new(); // the exact motion itself is the circle
    }
    [inner, outer]
        .map(|radius| {
            let points = circle(radius, pt_per_m);
            ChartSeries::new("limits of exact motion", points, SeriesStyle::limit())
        })
        .into()
}

/// Returns a circle around the origin as straight lines, since it may be far larger than the page.
fn circle(radius_m: f64, pt_per_m: f64) -> Vec<[f64; 2]> {
    /// Maximum distance of the lines from the circle, pt, and their maximum number.
    const OFF_PT: f64 = 0.02;
    const MOST_CURVE_STEPS: f64 = 1e5;
    let count = PI * (0.5 * radius_m * pt_per_m / OFF_PT).sqrt();
    let count = count.ceil().clamp(8.0, MOST_CURVE_STEPS);
    let places = (0..=count as u32).map(|number| {
        let angle = TAU * f64::from(number) / count;
        [radius_m * libm::cos(angle), radius_m * libm::sin(angle)]
    });
    places.collect()
}

/// Returns the ranges of both axes of a path. Even a straight path has a picture: y has at least half the range of x. The
/// picture is not much higher than wide: x has at least three quarters of the range of y.
fn both_ranges(series: &[ChartSeries], runs: &[FigureRun]) -> [(f64, f64); 2] {
    const LEAST_SHARES: [f64; 2] = [0.75, 0.5];
    let size = size::axis(runs, "x_m");
    let ranges = [0, 1].map(|axis| {
        let values = series.iter().flat_map(|series| series.reach(axis));
        size.range_of(values)
    });
    let lengths = ranges.iter().map(|(low, high)| high - low);
    let longest = lengths.fold(0.0, f64::max);
    [0, 1].map(|axis| {
        let (low, high) = ranges[axis];
        let missing = (LEAST_SHARES[axis] * longest - (high - low)).max(0.0);
        (low - 0.5 * missing, high + 0.5 * missing)
    })
}
