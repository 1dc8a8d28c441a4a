//! What was measured, drawn with runs: points with error bars over time and from above, and their residuals.

use super::chart::legend::longest_name;
use super::chart::{Axis, Chart, Errors, Panel, Series, Style};
use super::of_runs::charts::both_ranges;
use super::page::ink::LABEL_PT;
use super::page::letters;
use super::quantity;
use super::request::{Figure, Known, Request, Run};
use super::size;
use crate::export::Column;
use crate::measured::{self, Curve, Measured, Point, at_times, places, residuals as held_against};
use crate::run::Clock;
use crate::scenario::Scenario;
use crate::text::number::shortest;
use std::cell::RefCell;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;

/// The room before the first and after the last residual, of the time between them.
const MARGIN: f64 = 0.02;

/// The room before a first and after a last point that would stand on the frame, of the time that is drawn.
const BESIDE_POINTS: f64 = 0.015;

/// Adds the points to the panels of `columns`, and the time in which they were measured to the axis of the time. Returns
/// what is to be said where no panel shows what was measured.
///
/// # Errors
/// Where the data are no series, or the numbers of a run stop being finite.
pub(super) fn over_time(
    chart: &mut Chart,
    columns: &[&'static Column],
    runs: &[Run],
    request: &Request,
    known: &Known,
) -> Result<Option<String>, String> {
    let Some(measured) = &request.measured else {
        return Ok(None);
    };
    let series = series(measured)?;
    let mut drawn_on = Vec::new();
    for (index, column) in columns.iter().enumerate().take(chart.panels.len()) {
        let is_this = |curve: &Curve| curve.quantity.name == column.name;
        let Some(place) = series.curves.iter().position(is_this) else {
            continue;
        };
        let curve = &series.curves[place];
        let points = if curve.quantity.is_direction {
            turned(series, place, runs, known)?
        } else {
            curve.points.clone()
        };
        let shown = drawn(series, &points, request);
        if let (Some(range), None) = (&mut chart.x.range, request.to_s) {
            let last = shown.last().map_or(range.1, |(at, _)| at[0]);
            range.1 = range.1.max(last);
        }
        drawn_on.push((index, shown));
    }
    let times = drawn_on.iter().flat_map(|(_, shown)| shown);
    if let Some(range) = &mut chart.x.range {
        make_room(range, times.map(|(at, _)| at[0]));
    }
    let count = drawn_on.iter().map(|(_, shown)| shown.len()).sum();
    for (index, shown) in drawn_on {
        let (points, errors): (Vec<_>, Vec<_>) = shown.into_iter().unzip();
        chart.panels[index].series.push(Series {
            name: name(measured, count, request),
            style: Style::measured(points.len()),
            points,
            errors,
            ..Series::default()
        });
    }
    let columns: Vec<_> = names(series).collect();
    Ok((count == 0).then(|| {
        format!(
            "no point of {} is in this figure: it has {}; --kind {} shows them",
            measured.origin,
            columns.join(", "),
            columns.join(",")
        )
    }))
}

/// Widens the `range` of an axis where one of `times` would stand on the frame: its error bar would lie on it.
fn make_room((begin, end): &mut (f64, f64), times: impl Iterator<Item = f64>) {
    let room = BESIDE_POINTS * (*end - *begin);
    let (least, most) = (*begin + room, *end - room);
    let ends = times.fold((false, false), |(first, last), time| {
        (first || time < least, last || time > most)
    });
    if ends.0 {
        *begin -= room;
    }
    if ends.1 {
        *end += room;
    }
}

/// Adds the places from above. Returns what is to be said where the data do not tell any.
///
/// # Errors
/// Where the data are no series.
pub(super) fn above(
    chart: &mut Chart,
    runs: &[Run],
    request: &Request,
) -> Result<Option<String>, String> {
    let (Some(measured), Some(run)) = (&request.measured, runs.first()) else {
        return Ok(None);
    };
    let scenario = &run.scenario;
    let traced = scenario.body.mechanics.points()[scenario.trace].at;
    let all = places(series(measured)?, &traced);
    let shown: Vec<_> = all
        .iter()
        .filter(|place| is_wanted(place.time_s, request))
        .collect();
    if shown.is_empty() {
        let origin = &measured.origin;
        return Ok(Some(format!(
            "no point of {origin} is in this figure: from above are x_m and y_m, or tilt_deg and azimuth_deg of a point on the axle"
        )));
    }
    let errors = |part: usize| {
        let sigmas = shown.iter().map(|place| place.sigmas[part]);
        sigmas.map(|sigma| sigma.unwrap_or(f64::NAN)).collect()
    };
    let added = Series {
        name: name(measured, shown.len(), request),
        points: shown.iter().map(|place| [place.at.x, place.at.y]).collect(),
        errors: errors(1),
        errors_across: errors(0),
        style: Style::measured(shown.len()),
    };
    if let [panel] = &mut chart.panels[..] {
        panel.series.push(added);
        let (x, y) = both_ranges(&panel.series, size::of(runs, "x_m"));
        (chart.x.range, panel.y.range) = (Some(x), Some(y));
    }
    Ok(None)
}

/// What is said where the runs end before the last point of a figure.
pub(super) fn beyond_runs(runs: &[Run], request: &Request) -> Option<String> {
    let measured = request.measured.as_ref()?;
    let series = measured.series().ok()?;
    let ends = runs.iter().map(|run| Clock::end_s(&run.scenario));
    let end_s = ends.fold(0.0, f64::max);
    let is_beyond = |time_s: &&f64| **time_s > end_s && is_wanted(**time_s, request);
    let last_s = shortest(*series.times_s.iter().rfind(is_beyond)?);
    Some(format!(
        "the run ends at {} s, before the last point of {} at {last_s} s: --duration {last_s} draws the run up to there",
        shortest(end_s),
        measured.origin
    ))
}

/// What is said where measured points are asked for in space.
pub(super) fn in_space(request: &Request) -> Option<String> {
    let measured = request.measured.as_ref()?;
    Some(format!(
        "the points of {} are not drawn in space: --kind above or columns show them",
        measured.origin
    ))
}

/// The figure of what was measured less what each of `runs`, which have names, says.
///
/// # Errors
/// Where there is nothing measured, or the numbers of a run stop being finite.
pub(super) fn residuals(
    title: String,
    runs: &[(Arc<Scenario>, String)],
    request: &Request,
    known: &Known,
    watch: impl FnMut(u64, u64) -> ControlFlow<()>,
) -> Result<Option<Figure>, String> {
    let Some(measured) = &request.measured else {
        return Err("residuals are of measured data: --measured FILE".to_owned());
    };
    let series = series(measured)?;
    let watch = RefCell::new(watch);
    let ends = runs.iter().map(|(scenario, _)| Clock::end_s(scenario));
    let last_s = series.times_s.last().copied().unwrap_or(0.0);
    let end_s = request.to_s.unwrap_or(ends.fold(last_s, f64::max));
    let axis = |curve: &Curve| {
        let axis = quantity::axis(curve.quantity.name);
        Axis::new(format!("{}, measured − run", axis.name), axis.unit)
    };
    let margin_s = MARGIN * (end_s - request.from_s);
    let range = (request.from_s - margin_s, end_s + margin_s);
    let zero = || Series {
        points: vec![[range.0, 0.0], [range.1, 0.0]],
        style: Style::theory(0, 0),
        ..Series::default()
    };
    let panel = |curve: &Curve| Panel {
        y: axis(curve),
        series: vec![zero()],
        ..Panel::default()
    };
    let mut panels: Vec<Panel> = series.curves.iter().map(panel).collect();
    let all = series.curves.iter().flat_map(|curve| &curve.points);
    let count = all
        .filter(|point| is_wanted(series.times_s[point.row], request))
        .count();
    for (index, (scenario, name)) in runs.iter().enumerate() {
        let go_on = || watch.borrow_mut()(0, scenario.steps).is_continue();
        let said = match &known.said {
            Some(said) => Some(said.clone()),
            None => at_times(series, scenario, &go_on).map_err(|error| error.to_string())?,
        };
        let Some(model) = said else {
            return Ok(None);
        };
        let style = match runs.len() {
            1 => Style::measured(0),
            _ => Style::points(index),
        };
        for ((panel, curve), model) in panels.iter_mut().zip(&series.curves).zip(&model) {
            let points = less_run(curve, model);
            let (points, errors) = drawn(series, &points, request).into_iter().unzip();
            panel.series.push(Series {
                name: match runs.len() {
                    1 => self::name(measured, count, request),
                    _ => name.clone(),
                },
                points,
                errors,
                style: style.clone(),
                ..Series::default()
            });
        }
    }
    let chart = Chart {
        title,
        width_pt: request.width_pt,
        x: Axis {
            range: Some(range),
            ..quantity::axis("t_s")
        },
        panels,
        is_true_to_scale: false,
        errors: Errors::OfData,
    };
    Ok(Some(Figure {
        scene: chart.scene(),
        warnings: Vec::new(),
        dense: None,
        broke: None,
    }))
}

/// The points of `curve` less what the run says of each, `model`.
fn less_run(curve: &Curve, model: &[f64]) -> Vec<Point> {
    let held = held_against(Some(curve.quantity), &curve.points, model);
    let less = held.iter().map(|held| Point {
        row: held.row,
        value: held.value(),
        sigma: held.sigma,
    });
    less.collect()
}

fn series(measured: &Measured) -> Result<&measured::Series, String> {
    let series = measured.series();
    series.map_err(|problems| format!("{}: {}", problems.origin, problems.in_one_line()))
}

fn names(series: &measured::Series) -> impl Iterator<Item = &'static str> + '_ {
    series.curves.iter().map(|curve| curve.quantity.name)
}

/// The name of the data in the legend, as markup, with the `count` of the points that the figure has of them.
fn name(measured: &Measured, count: usize, request: &Request) -> String {
    let file = Path::new(&measured.origin).file_stem();
    let file = file.map_or(measured.origin.as_str().into(), |file| {
        file.to_string_lossy()
    });
    let count = match count {
        1 => "1 point".to_owned(),
        count => format!("{count} points"),
    };
    let name = format!("measured: {file} ({count})");
    letters::shortened(&name, LABEL_PT, longest_name(request.width_pt))
}

fn is_wanted(time_s: f64, request: &Request) -> bool {
    time_s >= request.from_s && request.to_s.is_none_or(|to_s| time_s <= to_s)
}

/// `points` in the stretch of time that is drawn, each with its error: NaN where none is stated.
fn drawn(series: &measured::Series, points: &[Point], request: &Request) -> Vec<([f64; 2], f64)> {
    let at = |point: &Point| {
        let time_s = series.times_s[point.row];
        ([time_s, point.value], point.sigma.unwrap_or(f64::NAN))
    };
    let all = points.iter().map(at);
    all.filter(|(at, _)| is_wanted(at[0], request)).collect()
}

/// The directions of the curve at `place`, each with the number of full turns at which it is nearest to the first of `runs`.
fn turned(
    series: &measured::Series,
    place: usize,
    runs: &[Run],
    known: &Known,
) -> Result<Vec<Point>, String> {
    let curve = &series.curves[place];
    let Some(run) = runs.first() else {
        return Ok(curve.points.clone());
    };
    let said = known.said.as_ref().and_then(|said| said.get(place));
    let model = match said {
        Some(said) => Some(said.clone()),
        None => {
            let alone = measured::Series {
                curves: vec![curve.clone()],
                ..series.clone()
            };
            let model = at_times(&alone, &run.scenario, &|| true);
            let model = model.map_err(|error| error.to_string())?;
            model.and_then(|model| model.into_iter().next())
        }
    };
    let held = held_against(
        Some(curve.quantity),
        &curve.points,
        &model.unwrap_or_default(),
    );
    let turned = held.iter().map(|held| Point {
        row: held.row,
        value: held.measured,
        sigma: held.sigma,
    });
    Ok(turned.collect())
}
