//! Figures of runs: curves over time, and paths from above and in space.

pub(super) mod charts;

use super::arcs;
use super::chords;
use super::course::{self, SampleRequest, SampledRun};
use super::dense;
use super::job::{Dense, FigureJob, SampledRunNumbers};
pub use super::job::{DrawnFigure, FigureRun, KnownNumbers};
use super::kind::FigureKind;
use super::measured;
use super::names::{EXACT_CURVE_NAME, names};
use super::source::FigureSource;
use super::space;
use super::spec::FigureSpec;
use crate::engine::analysis::Predictability;
use crate::engine::analysis::health::LEAST_SWING_DEG;
use crate::engine::analysis::verdict::caveat;
use crate::engine::export::CsvColumn;
use crate::engine::run::{Clock, Truth};
use crate::engine::scenario::{Scenario, ScenarioFile};
use crate::engine::text::nice_numbers;
use crate::engine::text::number::{short, shortest};
use crate::plot::chart::legend::longest_name;
use crate::plot::chart::{Chart, MOST_CURVES, SeriesStyle};
use crate::plot::letters;
use std::ops::ControlFlow;
use std::sync::Arc;

struct SampledRuns {
    drawn: Vec<SampledRunNumbers>,
    warnings: Vec<String>,
    caveats: Vec<String>,
    broke: Option<String>,
}

/// Draws the figures of `sources`, which all have the same runs.
///
/// Figures with the same time range play the runs only once, and not at all if there is a single run with enough
/// `known` numbers. `watch` is called with the current and the last step. Returns `None` if `watch` stopped the
/// computation.
///
/// # Errors
/// Returns an error if the time range lies beyond the ends of the runs.
pub fn figures(
    sources: &[FigureSource],
    known: &KnownNumbers,
    mut watch: impl FnMut(u64, u64) -> ControlFlow<()>,
) -> Result<Option<Vec<DrawnFigure>>, String> {
    let nothing = KnownNumbers::default();
    let kinds: Vec<FigureKind> = sources
        .iter()
        .map(FigureSource::kind)
        .collect::<Result<_, _>>()?;
    let jobs: Vec<FigureJob<'_>> = sources
        .iter()
        .zip(&kinds)
        .map(|(source, kind)| {
            let is_single = source.runs.len() == 1;
            source.job(kind, if is_single { known } else { &nothing })
        })
        .collect();
    let mut figures = Vec::new();
    let mut all_played: Vec<(&FigureJob<'_>, SampledRuns)> = Vec::new();
    for job in &jobs {
        check_range(job)?;
        check_count(job)?;
        if let FigureKind::Residuals = job.kind {
            match measured::residuals(job, &mut watch)? {
                Some(figure) => figures.push(figure),
                None => return Ok(None),
            }
            continue;
        }
        if !all_played.iter().any(|(it, _)| it.is_alike(job)) {
            let alike = jobs.iter().filter(|it| it.is_alike(job));
            let samples = wanted(job, alike.map(|it| it.kind));
            match play(job, &samples, &mut watch)? {
                Some(played) => all_played.push((job, played)),
                None => return Ok(None),
            }
        }
        for (_, played) in all_played.iter().filter(|(it, _)| it.is_alike(job)) {
            let Some(figure) = draw(job, played, &mut watch)? else {
                return Ok(None);
            };
            figures.push(figure);
        }
    }
    Ok(Some(figures))
}

fn play(
    job: &FigureJob<'_>,
    wanted: &SampleRequest,
    mut watch: impl FnMut(u64, u64) -> ControlFlow<()>,
) -> Result<Option<SampledRuns>, String> {
    let &FigureJob {
        runs, spec, kind, ..
    } = job;
    let Some(mut drawn) = play_runs(job, wanted, &mut watch) else {
        return Ok(None);
    };
    let mut broke = None;
    let mut warnings = Vec::new();
    let mut caveats = Vec::new();
    for (run, SampledRunNumbers { course, .. }) in runs.iter().zip(&drawn) {
        if let Some(error) = course.broke {
            broke.get_or_insert_with(|| format!("{}: {error}", run.named));
        }
        let is_curve = !wanted.columns.is_empty() && !shows_all_times(run, wanted);
        warnings.extend(
            not_believed(
                run,
                course,
                spec.exact || matches!(kind, FigureKind::Error(_)),
            )
            .or_else(|| few_a_swing(run).filter(|_| is_curve)),
        );
        warnings.extend(limited(run, course));
        let caveat = course.health.as_ref().and_then(caveat);
        caveats.extend(caveat.map(|caveat| format!("{}: {caveat}", run.named)));
    }
    if spec.exact {
        if runs.iter().any(|run| is_exact(&run.scenario)) {
            warnings.push(IS_EXACT.to_owned());
        }
        let Some(truths) = play_truths(job, wanted, watch) else {
            return Ok(None);
        };
        drawn.extend(truths);
    }
    if drawn.iter().all(|drawn| drawn.course.is_empty) {
        return Err(broke
            .unwrap_or_else(|| "there is no step of the run in that stretch of time".to_owned()));
    }
    Ok(Some(SampledRuns {
        drawn,
        warnings,
        caveats,
        broke,
    }))
}

/// Plays the runs, unless their numbers are known. Returns `None` if `watch` stopped the computation.
fn play_runs(
    job: &FigureJob<'_>,
    wanted: &SampleRequest,
    mut watch: impl FnMut(u64, u64) -> ControlFlow<()>,
) -> Option<Vec<SampledRunNumbers>> {
    let named = job.runs.iter().zip(names(job)).enumerate();
    let drawn = named.map(|(index, (run, name))| {
        let recorded = job
            .known
            .recorded
            .as_ref()
            .and_then(|all| all.part(&run.scenario, wanted));
        let is_exact = is_exact(&run.scenario);
        Some(SampledRunNumbers {
            name,
            style: if is_exact && job.runs.len() > 1 {
                SeriesStyle::exact(exact_before(&job.runs[..index]))
            } else {
                SeriesStyle::curve(index, job.runs.len())
            },
            course: if is_exact && !wanted.counts_steps() && is_coarse(run) {
                // The exact motion is known between its steps too.
                course::exact(&run.scenario, wanted, &mut watch)?
            } else {
                recorded.or_else(|| course::play(&run.scenario, wanted, &mut watch))?
            },
            is_exact: false,
        })
    });
    drawn.collect()
}

/// Computes the exact motions to draw with the runs. Returns `None` if `watch` stopped the computation.
fn play_truths(
    job: &FigureJob<'_>,
    wanted: &SampleRequest,
    mut watch: impl FnMut(u64, u64) -> ControlFlow<()>,
) -> Option<Vec<SampledRunNumbers>> {
    let room_pt = longest_name(job.spec.page_width_pt());
    let truths = (exact_before(job.runs)..).zip(truths(job.runs, room_pt));
    let drawn = truths.map(|(index, (run, name))| {
        Some(SampledRunNumbers {
            name,
            style: SeriesStyle::exact(index),
            course: course::exact(&run.scenario, wanted, &mut watch)?,
            is_exact: true,
        })
    });
    drawn.collect()
}

/// Draws the figure. Returns `None` if `watch` stopped the computation.
///
/// # Errors
/// Returns an error if the measured data cannot be drawn in this figure.
fn draw(
    job: &FigureJob<'_>,
    played: &SampledRuns,
    watch: impl FnMut(u64, u64) -> ControlFlow<()>,
) -> Result<Option<DrawnFigure>, String> {
    let drawn = &played.drawn;
    let mut warnings = played.warnings.clone();
    let labels = &job.spec.labels;
    let dense;
    let scene = match job.kind {
        FigureKind::OverTime(columns) | FigureKind::Error(columns) => {
            let (mut chart, told) = over_time(job, columns, drawn)?;
            warnings.extend(told);
            warnings.extend(measured::beyond_runs(job));
            labels.check_ranges(&chart)?;
            job.spec.set_height(&mut chart)?;
            dense = dense::over_time(&chart, columns, drawn, job.spec);
            if let Some(dense) = &dense {
                let Some(magnified) = magnified(job, columns, dense, watch)? else {
                    return Ok(None);
                };
                chart.magnified = Some(Box::new(magnified));
                dense::draw_bands(&mut chart, columns, drawn);
            }
            chart.scene()
        }
        FigureKind::Above => {
            let (measured, none) = measured::above(job)?;
            warnings.extend(none);
            let mut chart = charts::above(job, drawn, measured);
            labels.apply(&mut chart)?;
            dense = charts::path_warning(&chart, drawn, job.spec);
            warnings.extend(chords::warning(drawn, |course| &course.above));
            job.spec.fitted(|spec| {
                chart.width_pt = spec.page_width_pt();
                chart.scene()
            })
        }
        FigureKind::ThreeD | FigureKind::Residuals => {
            labels.check_in_space()?;
            let mut proposed = None;
            let scene = job.spec.fitted(|spec| {
                let (path, shorter) = space::scene(&FigureJob { spec, ..*job }, drawn);
                proposed = shorter;
                path
            });
            dense = proposed;
            warnings.extend(chords::warning(drawn, |course| &course.path));
            warnings.extend(measured::in_space(job));
            scene
        }
    };
    let mut page = job.spec.on_page(scene);
    page.caveats.clone_from(&played.caveats);
    Ok(Some(DrawnFigure {
        scene: page,
        warnings,
        dense,
        broke: played.broke.clone(),
    }))
}

/// Returns the chart of `columns` with measured data and the requested axes, and its warnings.
fn over_time(
    job: &FigureJob<'_>,
    columns: &[&'static CsvColumn],
    drawn: &[SampledRunNumbers],
) -> Result<(Chart, Vec<String>), String> {
    let mut chart = charts::over_time(job, columns, drawn);
    if let FigureKind::Error(_) = job.kind {
        charts::as_errors(&mut chart, job.runs);
    }
    let none = measured::over_time(job, &mut chart, columns)?;
    let hidden = job.spec.labels.apply(&mut chart)?;
    Ok((chart, none.into_iter().chain(hidden).collect()))
}

/// Returns the chart of the time range that resolves the `dense` curves. Returns `None` if `watch` stopped the
/// computation.
fn magnified(
    job: &FigureJob<'_>,
    columns: &[&'static CsvColumn],
    dense: &Dense,
    watch: impl FnMut(u64, u64) -> ControlFlow<()>,
) -> Result<Option<Chart>, String> {
    let spec = FigureSpec {
        to_s: Some(dense.to_s),
        ..job.spec.clone()
    };
    let part = FigureJob {
        spec: &spec,
        ..*job
    };
    let samples = wanted(&part, [job.kind].into_iter());
    let Some(played) = play(&part, &samples, watch)? else {
        return Ok(None);
    };
    let (chart, _) = over_time(&part, columns, &played.drawn)?;
    Ok(Some(chart))
}

fn wanted<'a>(job: &FigureJob<'_>, kinds: impl Iterator<Item = &'a FigureKind>) -> SampleRequest {
    let mut wanted = SampleRequest {
        columns: Vec::new(),
        path: false,
        from_s: job.spec.from_s,
        to_s: job.spec.to_s,
    };
    for kind in kinds {
        wanted.columns.extend(kind.columns());
        wanted.path |= matches!(kind, FigureKind::Above | FigureKind::ThreeD);
    }
    wanted
}

fn check_range(job: &FigureJob<'_>) -> Result<(), String> {
    let (from_s, end_s) = (job.spec.from_s, job.end_s());
    let from = shortest(from_s);
    if let Some(to_s) = job.spec.to_s.filter(|to_s| *to_s <= from_s) {
        let to = shortest(to_s);
        return Err(format!("--from {from} is not before --to {to}"));
    }
    if from_s >= end_s {
        let end = shortest(end_s);
        return Err(format!(
            "--from {from} is not before the end of the run, {end} s"
        ));
    }
    Ok(())
}

/// Hint at the option that adds the exact motion.
pub const EXACT_BESIDE: &str = "--exact draws that beside it";

/// Returns a warning if `run` is not accurate enough.
fn not_believed(run: &FigureRun, course: &SampledRun, exact: bool) -> Option<String> {
    let health = course
        .health
        .filter(|health| health.is_believed() == Some(false))?;
    let (most_m, swing) = (health.most_distance_m?, health.swing?);
    let motion = run.scenario.first_motion();
    let of = format!(
        "{} with the scheme {} at {} s",
        run.named,
        motion.scheme.name,
        shortest(motion.time_step_s),
    );
    let what = if health.point_holds() == Some(true) {
        format!("the nutation of {of}: {swing}, as in the exact motion")
    } else {
        let end_s = Clock::end_s(&run.scenario);
        let until = if course.end_s < end_s {
            format!(" in the first {} s", shortest(course.end_s))
        } else {
            String::new()
        };
        format!(
            "{of}: its traced point is up to {} m ({} % of its arm) off the exact motion{until}",
            short(most_m),
            short(100.0 * most_m / health.arm_m),
        )
    };
    let beside = if exact {
        String::new()
    } else {
        format!("; {EXACT_BESIDE}")
    };
    Some(format!("do not believe {what}{beside}"))
}

/// Returns a warning if something limits every computation of the motion of `run`.
fn limited(run: &FigureRun, course: &SampledRun) -> Option<String> {
    let limits = course.health?.limits();
    (limits != Predictability::default())
        .then(|| format!("the motion of {} is {limits}", run.named))
}

/// Minimum number of time steps per nutation for which straight lines show the nutation.
const LEAST_A_SWING: f64 = 6.0;
/// Number of time steps per nutation that show it as a smooth curve.
const A_SMOOTH_SWING: f64 = 20.0;

/// Returns whether what is `wanted` of `run` is known between its steps too.
fn shows_all_times(run: &FigureRun, wanted: &SampleRequest) -> bool {
    let is_exact = is_exact(&run.scenario) && !wanted.counts_steps();
    is_exact || arcs::are_drawn(&run.scenario, wanted)
}

/// Returns whether the time steps of `run`, an exact motion, do not show it as a smooth curve.
fn is_coarse(run: &FigureRun) -> bool {
    let truth = Truth::new(Arc::clone(&run.scenario));
    match truth.motion().closed_form() {
        Some(motion) => motion.nutation_period().is_some_and(|period_s| {
            period_s < A_SMOOTH_SWING * run.scenario.first_motion().time_step_s
        }),
        None => arcs::are_bent(&run.scenario),
    }
}

/// Returns a warning if `run` has too few time steps per nutation for a curve over time.
fn few_a_swing(run: &FigureRun) -> Option<String> {
    let truth = Truth::new(Arc::clone(&run.scenario));
    let motion = truth.motion().closed_form()?;
    let ((low, high), period_s) = (motion.tilt_range(), motion.nutation_period()?);
    let steps = period_s / run.scenario.first_motion().time_step_s;
    let is_there = (high - low).to_degrees() > LEAST_SWING_DEG;
    (is_there && steps < LEAST_A_SWING).then(|| {
        format!(
            "{} has {} time steps in a nutation of {} s: the lines between them show slow swings that the motion does not have; a time step of {} s would show the nutation",
            run.named,
            short(steps),
            short(period_s),
            shortest(nice_numbers::at_or_below(period_s / A_SMOOTH_SWING))
        )
    })
}

/// Returns an error for more curves than can be distinguished.
fn check_count(job: &FigureJob<'_>) -> Result<(), String> {
    let room_pt = longest_name(job.spec.page_width_pt());
    let exact = if job.spec.exact {
        truths(job.runs, room_pt).len()
    } else {
        0
    };
    let count = job.runs.len() + exact;
    if count <= MOST_CURVES {
        return Ok(());
    }
    Err(format!(
        "{count} curves: a figure shows at most {MOST_CURVES}, since more are not told apart; draw fewer runs, or a figure for each group of them"
    ))
}

/// Returns the number of exact motions among `runs`.
fn exact_before(runs: &[FigureRun]) -> usize {
    runs.iter().filter(|run| is_exact(&run.scenario)).count()
}

/// Returns true if every step of `scenario` is exact.
pub(crate) fn is_exact(scenario: &Scenario) -> bool {
    let edited = scenario.edits.iter().map(|edit| &edit.motion);
    let mut motions = edited.chain([&scenario.motion]);
    motions.all(|motion| motion.scheme.order.is_none())
}

/// Warning for a run that is itself the exact motion.
const IS_EXACT: &str =
    "the scheme exact gives the exact motion itself: no second curve of it is drawn";

/// Returns the runs with different exact motions that none of `runs` shows, each with the name of that motion.
fn truths(runs: &[FigureRun], room_pt: f64) -> Vec<(&FigureRun, String)> {
    let mut distinct: Vec<&FigureRun> = Vec::new();
    for run in runs {
        if distinct.iter().all(|other| motion(other) != motion(run)) {
            distinct.push(run);
        }
    }
    let is_alone = distinct.len() == 1;
    distinct.retain(|run| {
        let mut exact = runs.iter().filter(|other| is_exact(&other.scenario));
        !exact.any(|other| motion(other) == motion(run))
    });
    distinct
        .into_iter()
        .map(|run| {
            if is_alone {
                return (run, EXACT_CURVE_NAME.to_owned());
            }
            let title = format!("{}, {EXACT_CURVE_NAME}", run.scenario.file.title);
            let name = letters::shortened(&title, crate::plot::ink::LABEL_PT, room_pt);
            (run, name)
        })
        .collect()
}

/// Returns the part of the file of `run` that determines the exact motion: without title, view, scheme and time step.
fn motion(run: &FigureRun) -> ScenarioFile {
    let mut file = run.scenario.file.clone();
    (file.motion.scheme, file.motion.time_step_s) = (None, 0.0);
    file.motion.steps = 0;
    (file.title, file.about, file.source) = (String::new(), None, None);
    (file.view, file.gyrolab) = (None, None);
    file.expected.clear();
    file
}
