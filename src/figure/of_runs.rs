//! Figures of runs: their curves over time, their paths from above and in space.

use super::chart::layout::Layout;
use super::chart::legend::longest_name;
use super::chart::{Axis, Chart, Panel, Series, Style};
use super::course::{self, Course, Wanted};
use super::dense;
use super::kind::{Kind, Plotted};
use super::measured;
use super::names::names;
use super::page::letters;
use super::page::scene::Scene;
use super::quantity;
use super::space;
use crate::measured::Measured;
use crate::run::Truth;
use crate::scenario::Scenario;
use std::ops::ControlFlow;
use std::sync::Arc;

/// What a figure of runs is to show.
#[derive(Clone, Debug)]
pub struct Request {
    /// What of the runs.
    pub kind: Kind,
    /// From when on, s.
    pub from_s: f64,
    /// Until when, s; `None`: to the end of the longest run.
    pub to_s: Option<f64>,
    /// Whether the exact motion is drawn beside them.
    pub exact: bool,
    /// What was measured on a run, to be drawn with them.
    pub measured: Option<Arc<Measured>>,
    /// Width of the page, pt.
    pub width_pt: f64,
}

/// A run that is drawn.
#[derive(Clone, Debug)]
pub struct Run {
    /// What is run.
    pub scenario: Arc<Scenario>,
    /// How the user named it.
    pub named: String,
}

/// A figure, and what its reader should know of it.
#[derive(Clone, Debug)]
pub struct Figure {
    /// The page.
    pub scene: Scene,
    /// Warnings, each a sentence without its end.
    pub warnings: Vec<String>,
    /// Which run's numbers stopped being finite, and at which step.
    pub broke: Option<String>,
}

/// A run with its numbers, or the exact motion beside it.
pub(super) struct Drawn {
    pub name: String,
    pub style: Style,
    pub course: Course,
}

/// The figure of `runs`, one at least. `watch` is told the step reached and the last one, and says whether to go on; `None`
/// where it said no.
///
/// # Errors
/// When the stretch of time lies beyond the ends of the runs.
pub fn figure(
    runs: &[Run],
    request: &Request,
    mut watch: impl FnMut(u64, u64) -> ControlFlow<()>,
) -> Result<Option<Figure>, String> {
    check_range(runs, request)?;
    let wanted = wanted(request);
    let mut warnings = Vec::new();
    let mut broke = None;
    let mut drawn = Vec::new();
    let is_beside = request.exact || request.measured.is_some();
    let named = names(runs, is_beside, longest_name(request.width_pt));
    if let Kind::Residuals = &request.kind {
        let title = title(runs);
        let name = |(run, name): (&Run, String)| (Arc::clone(&run.scenario), name);
        let runs: Vec<_> = runs.iter().zip(named).map(name).collect();
        return measured::residuals(title, &runs, request, watch);
    }
    for (index, (run, name)) in runs.iter().zip(named).enumerate() {
        let Some(course) = course::play(&run.scenario, &wanted, &mut watch) else {
            return Ok(None);
        };
        if let Some(error) = course.broke {
            broke.get_or_insert_with(|| format!("{}: {error}", run.named));
        }
        let style = Style::curve(index);
        drawn.push(Drawn {
            name,
            style,
            course,
        });
    }
    if request.exact {
        for (run, name) in truths(runs, longest_name(request.width_pt)) {
            let Some(course) = course::exact(&run.scenario, &wanted, &mut watch) else {
                return Ok(None);
            };
            let style = match drawn.len() {
                1 => Style::exact(),
                index => Style::curve(index),
            };
            drawn.push(Drawn {
                name,
                style,
                course,
            });
        }
    }
    if drawn.iter().all(|drawn| drawn.course.is_empty()) {
        return Err(match broke {
            Some(error) => error,
            None => "there is no step of the run in that stretch of time".to_owned(),
        });
    }
    let title = title(runs);
    let scene = match &request.kind {
        Kind::OverTime(columns) => {
            let mut chart = over_time(title, columns, &drawn, request);
            warnings.extend(measured::over_time(&mut chart, columns, runs, request)?);
            warnings.extend(dense::warning(&chart, &drawn, request));
            chart.scene()
        }
        Kind::Above => {
            let mut chart = above(title, runs, &drawn, request);
            warnings.extend(measured::above(&mut chart, runs, request)?);
            warnings.extend(path_warning(&chart, &drawn, request));
            chart.scene()
        }
        Kind::ThreeD => {
            let (scene, warning) = space::scene(&title, runs, &drawn, request);
            warnings.extend(warning);
            warnings.extend(measured::in_space(request));
            scene
        }
        Kind::Residuals => return Ok(None), // drawn above
    };
    Ok(Some(Figure {
        scene,
        warnings,
        broke,
    }))
}

fn wanted(request: &Request) -> Wanted {
    let (columns, path) = match &request.kind {
        Kind::OverTime(columns) => (columns.clone(), false),
        Kind::Above | Kind::ThreeD => (Vec::new(), true),
        Kind::Residuals => (Vec::new(), false),
    };
    Wanted {
        columns,
        path,
        from_s: request.from_s,
        to_s: request.to_s,
    }
}

fn check_range(runs: &[Run], request: &Request) -> Result<(), String> {
    let from_s = request.from_s;
    if let Some(to_s) = request.to_s.filter(|to_s| *to_s <= from_s) {
        return Err(format!("--from {from_s} is not before --to {to_s}"));
    }
    let ends = runs
        .iter()
        .map(|run| crate::run::Clock::end_s(&run.scenario));
    let end_s = ends.fold(0.0, f64::max);
    if from_s >= end_s {
        return Err(format!(
            "--from {from_s} is not before the end of the run, {end_s} s"
        ));
    }
    Ok(())
}

fn title(runs: &[Run]) -> String {
    let mut titles: Vec<&str> = Vec::new();
    for run in runs {
        let title = run.scenario.file.title.as_str();
        if !titles.contains(&title) {
            titles.push(title);
        }
    }
    titles.join("; ")
}

/// The runs whose exact motions differ, each with the name of that motion.
fn truths(runs: &[Run], room_pt: f64) -> Vec<(&Run, String)> {
    let mut distinct: Vec<&Run> = Vec::new();
    for run in runs {
        let motion = |run: &Run| {
            let mut file = run.scenario.file.clone();
            (
                file.motion.scheme,
                file.motion.time_step_s,
                file.motion.steps,
            ) = (None, 0.0, 0);
            (file.title, file.about, file.source) = (String::new(), None, None);
            (file.view, file.gyrolab) = (None, None);
            file.expected.clear();
            file
        };
        if distinct.iter().all(|other| motion(other) != motion(run)) {
            distinct.push(run);
        }
    }
    let name = |run: &Run| match distinct.len() {
        1 => "exact".to_owned(),
        _ => {
            let title = format!("{}, exact", run.scenario.file.title);
            letters::shortened(&title, super::page::ink::LABEL_PT, room_pt)
        }
    };
    distinct.iter().map(|run| (*run, name(run))).collect()
}

fn over_time(title: String, columns: &[Plotted], drawn: &[Drawn], request: &Request) -> Chart {
    let ends = drawn.iter().map(|drawn| drawn.course.end_s);
    let end_s = ends.fold(0.0, f64::max);
    let range = (end_s > request.from_s).then_some((request.from_s, end_s));
    let panel = |(place, column): (usize, &Plotted)| Panel {
        y: quantity::axis(column.name()),
        series: drawn
            .iter()
            .map(|drawn| Series {
                name: drawn.name.clone(),
                points: drawn.course.curves[place].points(),
                style: drawn.style.clone(),
                ..Series::default()
            })
            .collect(),
        ..Panel::default()
    };
    let mut panels: Vec<Panel> = columns.iter().enumerate().map(panel).collect();
    // Many swings beside each other are told apart by thin lines alone.
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
    }
}

fn above(title: String, runs: &[Run], drawn: &[Drawn], request: &Request) -> Chart {
    let series = drawn.iter().map(|drawn| Series {
        name: drawn.name.clone(),
        points: drawn.course.path.iter().map(|at| [at[0], at[1]]).collect(),
        style: drawn.style.clone(),
        ..Series::default()
    });
    let series: Vec<_> = series.collect();
    let circles = match (request.exact, runs) {
        (true, [run]) => circles(run),
        _ => Vec::new(),
    };
    let (x, y) = both_ranges(&series, &circles);
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
    }
}

/// What is said of a path from above that is solid black.
fn path_warning(chart: &Chart, drawn: &[Drawn], request: &Request) -> Option<String> {
    let layout = Layout::new(chart, 0.0);
    let placed = layout.panels.first()?;
    let series = &chart.panels.first()?.series;
    drawn.iter().zip(series).find_map(|(drawn, series)| {
        let places: Vec<_> = series.points.iter().map(|at| placed.place(at)).collect();
        dense::path_warning(&places, drawn.course.end_s, request)
    })
}

/// The radii of the circles between which the exact motion of the traced point stays, from above, m; none where pushes or
/// edits change the motion, or it has no closed form.
fn circles(run: &Run) -> Vec<f64> {
    const SAME: f64 = 0.01;
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
    let radius = |tilt: f64| at.norm() * libm::sin(tilt);
    let (inner, outer) = (radius(low), radius(high));
    if (outer - inner).abs() <= SAME * outer.max(inner) {
        return vec![0.5 * (inner + outer)];
    }
    vec![inner, outer]
}

/// The stretches of both axes: one is never less than half of the other, so that a path along a line has a picture too.
pub(super) fn both_ranges(series: &[Series], circles: &[f64]) -> ((f64, f64), (f64, f64)) {
    const LEAST: f64 = 0.5;
    let ends = || circles.iter().flat_map(|radius| [-radius, *radius]);
    let range = |index: usize| {
        let values = series.iter().flat_map(|series| &series.points);
        Axis::default().range_of(values.map(|point| point[index]).chain(ends()))
    };
    let (x, y) = (range(0), range(1));
    let least = LEAST * (x.1 - x.0).max(y.1 - y.0);
    let widened = |(low, high): (f64, f64)| {
        let missing = (least - (high - low)).max(0.0);
        (low - 0.5 * missing, high + 0.5 * missing)
    };
    (widened(x), widened(y))
}
