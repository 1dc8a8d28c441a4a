//! The figures of a write-up.

use super::page::sentence;
use super::{MeasuredComparison, RUN_FILE};
use crate::engine::analysis::Readouts;
use crate::engine::analysis::cost::is_affordable;
use crate::engine::analysis::verdict::caveat;
use crate::engine::run::Clock;
use crate::engine::scenario::Scenario;
use crate::engine::scenario::screen::{ABOVE, THREE_D, TRACES};
use crate::engine::text::number::{rounded, significant};
use crate::plot::{COLUMN_PT, PT_PER_MM, PageFormat, PageScene, Unwritable};
use crate::report::figure::course::{RunSampler, SampleRequest, SampledRun};
use crate::report::figure::kind::{FigureKind, RESIDUALS};
use crate::report::figure::of_runs::{self, DrawnFigure, FigureRun, KnownNumbers};
use crate::report::figure::{FigureSource, FigureSpec, arcs};
use std::ops::ControlFlow;
use std::sync::Arc;

#[derive(Clone, Debug)]
pub struct WriteupFigure {
    /// The name of its files, without their endings.
    pub name: &'static str,
    /// Markup, as in a document.
    pub caption: String,
    /// What its reader must know of it besides, as a sentence in markup.
    pub remark: Option<String>,
    pub scene: PageScene,
    pub source: FigureSource,
}

/// The figure of what was measured.
const MEASURED_FIGURE: &str = "measured";
/// The figure of the first swings of a run.
const SWINGS_FIGURE: &str = "swings";
/// Least number of swings of a run that has this figure.
const MANY_SWINGS: f64 = 15.0;
const FEW_FIGURE_SWINGS: f64 = 8.0;
/// Figures of measured data end where the data do, and this factor later.
const BEYOND_DATA: f64 = 1.05;

impl WriteupFigure {
    /// The width of the page, mm.
    pub fn width_mm(&self) -> f64 {
        rounded(self.scene.width_pt / PT_PER_MM, 6)
    }

    /// Its files, each with its name and its bytes.
    ///
    /// # Errors
    /// When the page is too large for a form.
    pub fn files(&self) -> Result<Vec<(String, Vec<u8>)>, Unwritable> {
        let formats = [
            ("svg", PageFormat::Svg),
            ("pdf", PageFormat::Pdf),
            ("png", PageFormat::Png),
        ];
        let files = formats.into_iter().map(|(ending, format)| {
            let bytes = self.source.write(&self.scene, format)?;
            Ok((format!("{}.{ending}", self.name), bytes))
        });
        files.collect()
    }
}

struct PlannedFigure {
    name: &'static str,
    caption: String,
    source: FigureSource,
}

/// What is to be shown the start and every step of the run of `scenario`, so that its figures need not play it once more.
pub fn recorder(scenario: &Arc<Scenario>, beside: Option<&MeasuredComparison>) -> RunSampler {
    let measured = beside.and_then(|beside| beside.measured.series().ok());
    let kinds = [
        Some(FigureKind::traces()),
        measured.map(FigureKind::measured),
    ];
    let columns = kinds.iter().flatten().flat_map(FigureKind::columns);
    let wanted = SampleRequest {
        columns: columns.copied().collect(),
        path: true,
        from_s: 0.0,
        to_s: None,
    };
    RunSampler::new(scenario, wanted)
}

/// The figures of the run of `scenario`, whose `readouts` were read at its end, and of which the [`recorder`] has `recorded`
/// what they need; with the exact motion where it is to be had in reasonable time. `watch` is told the step reached and the
/// last one, and says whether to go on; `None` where it said no.
///
/// # Errors
/// When no step of the run can be drawn.
pub fn figures(
    scenario: &Arc<Scenario>,
    readouts: &Readouts,
    recorded: SampledRun,
    beside: Option<&MeasuredComparison>,
    watch: impl FnMut(u64, u64) -> ControlFlow<()>,
) -> Result<Option<Vec<WriteupFigure>>, String> {
    let is_exact = of_runs::is_exact(scenario);
    let exact = is_affordable(scenario) && !is_exact;
    let caveat = caveat(&readouts.health);
    let also = also(scenario, is_exact, exact, caveat.as_deref());
    let whole = FigureSource {
        spec: FigureSpec {
            // A run of the exact motion is drawn once, with the circles that bound it.
            exact: exact || is_exact,
            width_pt: Some(COLUMN_PT),
            ..FigureSpec::default()
        },
        runs: vec![FigureRun::titled(Arc::clone(scenario))],
        ..FigureSource::default()
    };
    let mut planned = beside.map_or(Vec::new(), |beside| of_data(beside, &whole, &also));
    planned.extend(of_run(scenario, readouts, beside, &whole, &also)?);
    let sources: Vec<_> = planned.iter().map(|it| it.source.clone()).collect();
    let known = KnownNumbers {
        recorded: Some(recorded),
        said: beside.map(|beside| beside.said.clone()),
    };
    let Some(drawn) = of_runs::figures(&sources, &known, watch)? else {
        return Ok(None);
    };
    let figures = planned.into_iter().zip(drawn);
    let figures = figures.map(|(plan, mut figure)| {
        figure.scene.caveats = caveat.iter().cloned().collect();
        plan.drawn(figure, exact)
    });
    Ok(Some(figures.collect()))
}

impl PlannedFigure {
    /// The figure of `whole` of this `kind`.
    fn new(name: &'static str, kind: &FigureKind, caption: String, whole: &FigureSource) -> Self {
        let mut source = whole.clone();
        source.spec.kind = Some(kind.name());
        Self {
            name,
            caption,
            source,
        }
    }

    fn drawn(self, figure: DrawnFigure, exact: bool) -> WriteupFigure {
        WriteupFigure {
            name: self.name,
            remark: figure.dense.map(|dense| {
                let exact = if exact { " --exact" } else { "" };
                let kind = self.source.spec.kind.as_deref().unwrap_or_default();
                let part = dense.options();
                format!(
                    "In this figure, {dense}: `gyrolab figure {RUN_FILE} --kind {kind}{exact} {part} -o part.pdf`."
                )
            }),
            caption: self.caption,
            scene: figure.scene,
            source: self.source,
        }
    }
}

/// Returns what the captions say of the exact motion, of the lines between the steps, and of numbers that are not reliable.
fn also(scenario: &Scenario, is_exact: bool, exact: bool, caveat: Option<&str>) -> String {
    let mut also = String::from(match (exact, is_exact) {
        (true, _) => ". The exact motion is dashed.",
        (_, true) => ". The run is the exact motion itself.",
        (false, false) => ".",
    });
    if !is_exact && !arcs::show_whole_run(scenario) {
        also += " Straight lines join the run's steps.";
    }
    if let Some(caveat) = caveat {
        also += &format!(" **{}.**", sentence(caveat));
    }
    also
}

/// The figure of what was measured.
fn of_data(beside: &MeasuredComparison, whole: &FigureSource, also: &str) -> Vec<PlannedFigure> {
    let measured = beside.reached();
    let Some(series) = measured
        .series()
        .ok()
        .filter(|it| it.curves.iter().any(|curve| !curve.points.is_empty()))
    else {
        return Vec::new();
    };
    let last_s = series.times_s.last().copied().unwrap_or_default();
    let mut whole = whole.clone();
    whole.spec.to_s = Some(beside.end_s.min(BEYOND_DATA * last_s));
    whole.draw_with(Some(Arc::clone(&measured)));
    let name = beside.name();
    let over_time = format!("The measured data `{name}` and the run{also}");
    let less = format!("Residuals: the measured data `{name}` less the run.");
    let kind = FigureKind::measured(series);
    vec![
        PlannedFigure::new(MEASURED_FIGURE, &kind, over_time, &whole),
        PlannedFigure::new(RESIDUALS, &FigureKind::Residuals, less, &whole),
    ]
}

fn of_run(
    scenario: &Scenario,
    readouts: &Readouts,
    beside: Option<&MeasuredComparison>,
    whole: &FigureSource,
    also: &str,
) -> Result<Vec<PlannedFigure>, String> {
    let plan = |name, kind, caption: &str| {
        PlannedFigure::new(name, &kind, format!("{caption}{also}"), whole)
    };
    let over_time = "x, y and z of the traced point over time";
    let mut planned = vec![plan(TRACES, FigureKind::traces(), over_time)];
    if let Some((from_s, to_s)) = few_swings_s(scenario, readouts) {
        let to = significant(to_s, 9);
        let tilt = if from_s > 0.0 {
            let from = significant(from_s, 9);
            format!("Tilt from {from} s, when the forces last changed, to {to} s")
        } else {
            format!("Tilt in the first {to} s")
        };
        let mut swings = plan(SWINGS_FIGURE, FigureKind::named("tilt_deg")?, &tilt);
        (swings.source.spec.from_s, swings.source.spec.to_s) = (from_s, Some(to_s));
        planned.push(swings);
    }
    let from_above = "Path of the traced point from above";
    let mut above = plan(ABOVE, FigureKind::Above, from_above);
    let measured = beside
        .filter(|beside| !beside.compared.places.is_empty())
        .map(MeasuredComparison::reached);
    above.source.draw_with(measured);
    planned.push(above);
    let in_space = "Path of the traced point in space";
    planned.push(plan(THREE_D, FigureKind::ThreeD, in_space));
    Ok(planned)
}

/// Where the run has many swings, the begin and the end of a few of them, s: of the first after the forces last changed, if that
/// leaves enough of the run.
fn few_swings_s(scenario: &Scenario, readouts: &Readouts) -> Option<(f64, f64)> {
    let swing_s = readouts.swing_s()?;
    let end_s = Clock::end_s(scenario);
    let few_s = rounded(FEW_FIGURE_SWINGS * swing_s, 2);
    // The first step under other forces: they changed where it began.
    let changed = readouts.since.saturating_sub(1);
    let from_s = Clock::at(scenario, changed).time_s(changed);
    let from_s = if from_s + few_s <= end_s { from_s } else { 0.0 };
    (end_s > MANY_SWINGS * swing_s).then_some((from_s, from_s + few_s))
}
