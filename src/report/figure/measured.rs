//! Measured data in figures of runs: points with error bars over time and from above, and residuals.

use super::job::{DrawnFigure, FigureJob, FigureRun};
use super::names::names;
use super::quantity;
use super::spec::FigureSpec;
use crate::engine::data::{
    self, MeasuredCurve, MeasuredData, MeasuredPoint, Residual, at_times, places,
    residuals as held_against,
};
use crate::engine::export::CsvColumn;
use crate::engine::text::number::shortest;
use crate::plot::chart::legend::longest_name;
use crate::plot::chart::{Chart, ChartAxis, ChartSeries, Panel, SeriesStyle};
use crate::plot::ink::LABEL_PT;
use crate::plot::letters;
use std::cell::RefCell;
use std::ops::ControlFlow;
use std::path::Path;

/// Margin before the first and after the last residual, relative to the time between them.
const RESIDUAL_MARGIN: f64 = 0.02;

/// Margin before the first and after the last point if it would lie on the frame, relative to the time range.
const BESIDE_POINTS: f64 = 0.015;

/// Adds the points to the panels of `columns`, and extends the time axis to them. Returns a warning if no panel shows
/// measured data.
///
/// # Errors
/// Returns an error if the data are not a time series, or if the numbers of a run stop being finite.
pub(super) fn over_time(
    job: &FigureJob<'_>,
    chart: &mut Chart,
    columns: &[&'static CsvColumn],
) -> Result<Option<String>, String> {
    let Some(measured) = job.measured else {
        return Ok(None);
    };
    let series = series(measured)?;
    let mut added = Vec::new();
    for (index, column) in columns.iter().enumerate() {
        let mut curves = series.curves.iter();
        if let Some(place) = curves.position(|curve| curve.quantity.name == column.name) {
            let points = turned(job, series, place)?;
            added.push((index, drawn(job, series, &points)));
        }
    }
    let times_s: Vec<f64> = added
        .iter()
        .flat_map(|(_, it)| it.points.iter().map(|at| at[0]))
        .collect();
    if let Some(range) = &mut chart.x.range {
        if job.spec.to_s.is_none() {
            range.1 = times_s.iter().copied().fold(range.1, f64::max);
        }
        make_room(range, &times_s);
    }
    let count = times_s.len();
    for (index, it) in added {
        chart.panels[index].series.push(ChartSeries {
            name: name(measured, count, job.spec),
            style: SeriesStyle::measured(it.points.len()),
            ..it
        });
    }
    let names: Vec<_> = series.curves.iter().map(|it| it.quantity.name).collect();
    Ok((count == 0).then(|| {
        format!(
            "this figure shows no point of {}, which has {}: use --kind {} to show them",
            measured.origin,
            names.join(", "),
            names.join(",")
        )
    }))
}

/// Widens the `range` of an axis if one of `times_s` would lie on the frame and hide its error bar.
fn make_room(range: &mut (f64, f64), times_s: &[f64]) {
    let room = BESIDE_POINTS * (range.1 - range.0);
    let (least, most) = (range.0 + room, range.1 - room);
    if times_s.iter().any(|time_s| *time_s < least) {
        range.0 -= room;
    }
    if times_s.iter().any(|time_s| *time_s > most) {
        range.1 += room;
    }
}

/// Returns the measured positions from above, or a warning if the data contain none.
///
/// # Errors
/// Returns an error if the data are not a time series.
pub(super) fn above(job: &FigureJob<'_>) -> Result<(Option<ChartSeries>, Option<String>), String> {
    let (Some(measured), Some(run)) = (job.measured, job.runs.first()) else {
        return Ok((None, None));
    };
    let scenario = &run.scenario;
    let traced = scenario.body.mechanics.points()[scenario.trace].at;
    let mut shown = places(series(measured)?, &traced);
    shown.retain(|place| job.has(place.time_s));
    if shown.is_empty() {
        let origin = &measured.origin;
        return Ok((
            None,
            Some(format!(
                "this figure shows no point of {origin}: a view from above needs x_m and y_m, or tilt_deg and azimuth_deg of a point on the axle"
            )),
        ));
    }
    let places = ChartSeries {
        name: name(measured, shown.len(), job.spec),
        points: shown.iter().map(|place| [place.at.x, place.at.y]).collect(),
        errors: [0, 1].map(|part| {
            let sigmas = shown.iter().map(|place| place.sigmas[part]);
            sigmas.map(|sigma| sigma.unwrap_or(f64::NAN)).collect()
        }),
        style: SeriesStyle::measured(shown.len()),
        ..ChartSeries::default()
    };
    Ok((Some(places), None))
}

/// Returns a warning if the runs end before the last measured point of the figure.
pub(super) fn beyond_runs(job: &FigureJob<'_>) -> Option<String> {
    let measured = job.measured?;
    let series = measured.series().ok()?;
    let end_s = job.end_s();
    let last_s = shortest(
        *series
            .times_s
            .iter()
            .rfind(|time_s| **time_s > end_s && job.has(**time_s))?,
    );
    Some(format!(
        "the run ends at {} s, before the last point of {} at {last_s} s: use --duration {last_s} to extend the run",
        shortest(end_s),
        measured.origin
    ))
}

/// Returns a warning if there are measured data in a figure in space.
pub(super) fn in_space(job: &FigureJob<'_>) -> Option<String> {
    let measured = job.measured?;
    Some(format!(
        "the points of {} are not drawn in space: use --kind above or columns to show them",
        measured.origin
    ))
}

/// Draws the figure of the residuals: measured values minus the values of each run.
///
/// # Errors
/// Returns an error if there are no measured data, or if the numbers of a run stop being finite.
pub(super) fn residuals(
    job: &FigureJob<'_>,
    mut watch: impl FnMut(u64, u64) -> ControlFlow<()>,
) -> Result<Option<DrawnFigure>, String> {
    let &FigureJob { runs, spec, .. } = job;
    let Some(measured) = job.measured else {
        return Err("residuals need measured data: use --measured FILE".to_owned());
    };
    let series = series(measured)?;
    let last_s = series.times_s.last().copied().unwrap_or(0.0);
    let end_s = spec.to_s.unwrap_or(job.end_s().max(last_s));
    let margin_s = RESIDUAL_MARGIN * (end_s - spec.from_s);
    let range = (spec.from_s - margin_s, end_s + margin_s);
    let curves = &series.curves;
    let mut panels: Vec<Panel> = curves.iter().map(|curve| empty(curve, range)).collect();
    let count = curves
        .iter()
        .map(|curve| drawn(job, series, &curve.points).points.len())
        .sum();
    for (index, (run, run_name)) in runs.iter().zip(names(job)).enumerate() {
        let Some(model) = said(job, series, run, &mut watch)? else {
            return Ok(None);
        };
        let (name, style) = match runs {
            [_] => (name(measured, count, spec), SeriesStyle::measured(0)),
            _ => (run_name, SeriesStyle::points(index)),
        };
        for ((panel, curve), values) in panels.iter_mut().zip(curves).zip(&model) {
            let points = beside(curve, values, Residual::value);
            panel.series.push(ChartSeries {
                name: name.clone(),
                style: style.clone(),
                ..drawn(job, series, &points)
            });
        }
    }
    let mut chart = job.chart(quantity::axis("t_s").within(range), panels);
    spec.labels.apply(&mut chart)?;
    spec.labels.check_ranges(&chart)?;
    spec.set_height(&mut chart)?;
    let scene = spec.on_page(chart.scene());
    Ok(Some(DrawnFigure::without_remarks(scene)))
}

/// Creates the panel for the residuals of `curve`, with only the zero line.
fn empty(curve: &MeasuredCurve, range: (f64, f64)) -> Panel {
    let axis = quantity::axis(curve.quantity.name);
    let y = ChartAxis::new(format!("{}, measured − run", axis.name), axis.unit);
    Panel::new(y, vec![ChartSeries::level(range)]).of_column(curve.quantity.name)
}

/// Returns the values of `run` for each curve of `series`; `None` if `watch` stopped the computation.
fn said(
    job: &FigureJob<'_>,
    series: &data::TimeSeries,
    run: &FigureRun,
    watch: impl FnMut(u64, u64) -> ControlFlow<()>,
) -> Result<Option<Vec<Vec<f64>>>, String> {
    if let Some(said) = &job.known.said {
        return Ok(Some(said.clone()));
    }
    let watch = RefCell::new(watch);
    at_times(series, &run.scenario, &|| {
        watch.borrow_mut()(0, run.scenario.steps).is_continue()
    })
    .map_err(|error| error.to_string())
}

/// Returns the points of `curve` with values that `value` computes from each point and its value in the run, `model`.
fn beside(
    curve: &MeasuredCurve,
    model: &[f64],
    value: impl Fn(&Residual) -> f64,
) -> Vec<MeasuredPoint> {
    let pairs = held_against(Some(curve.quantity), &curve.points, model);
    pairs
        .iter()
        .map(|pair| MeasuredPoint {
            row: pair.row,
            value: value(pair),
            sigma: pair.sigma,
        })
        .collect()
}

fn series(measured: &MeasuredData) -> Result<&data::TimeSeries, String> {
    let series = measured.series();
    series.map_err(|problems| format!("{}: {}", problems.origin, problems.in_one_line()))
}

/// Returns the legend's name of the data, as markup, with the number of points in the figure.
fn name(measured: &MeasuredData, count: usize, spec: &FigureSpec) -> String {
    let file = Path::new(&measured.origin)
        .file_stem()
        .map_or(measured.origin.as_str().into(), |stem| {
            stem.to_string_lossy()
        });
    let points = match count {
        1 => "1 point".to_owned(),
        _ => format!("{count} points"),
    };
    let whole = format!("measured: {file} ({points})");
    letters::shortened(&whole, LABEL_PT, longest_name(spec.page_width_pt()))
}

/// Returns the points in the figure's time range with their errors; NaN if no error is stated.
fn drawn(
    job: &FigureJob<'_>,
    series: &data::TimeSeries,
    measured: &[MeasuredPoint],
) -> ChartSeries {
    let (points, errors) = measured
        .iter()
        .map(|point| (series.times_s[point.row], point))
        .filter(|(time_s, _)| job.has(*time_s))
        .map(|(time_s, point)| ([time_s, point.value], point.sigma.unwrap_or(f64::NAN)))
        .unzip();
    ChartSeries {
        points,
        errors: [Vec::new(), errors],
        ..ChartSeries::default()
    }
}

/// Returns the points of the curve at index `place`. A direction gets the number of full turns that brings it closest
/// to the first run.
fn turned(
    job: &FigureJob<'_>,
    series: &data::TimeSeries,
    place: usize,
) -> Result<Vec<MeasuredPoint>, String> {
    let curve = &series.curves[place];
    match job.runs.first() {
        Some(run) if curve.quantity.is_direction => {
            let model = said(job, series, run, |_, _| ControlFlow::Continue(()))?
                .and_then(|mut curves| curves.get_mut(place).map(std::mem::take));
            Ok(beside(curve, &model.unwrap_or_default(), |pair| {
                pair.measured
            }))
        }
        _ => Ok(curve.points.clone()),
    }
}
