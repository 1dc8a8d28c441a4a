//! The figures of a write-up.

use super::{Beside, RUN_FILE};
use crate::analysis::Readouts;
use crate::analysis::cost::is_affordable;
use crate::figure::course::{Recorded, Recorder, Wanted};
use crate::figure::dense::Dense;
use crate::figure::kind::Kind;
use crate::figure::of_runs::{self, Figure, Known, Request, Run};
use crate::figure::{COLUMN_PT, Scene};
use crate::run::Clock;
use crate::scenario::Scenario;
use crate::scenario::screen::{ABOVE, THREE_D, TRACES};
use crate::text::number::{rounded, shortest};
use std::ops::ControlFlow;
use std::sync::Arc;

/// A figure of a write-up.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawing {
    /// The name of its files, without their endings.
    pub name: &'static str,
    /// What is to be seen.
    pub caption: String,
    /// What its reader must know of it besides, as a sentence.
    pub remark: Option<String>,
    /// The page.
    pub scene: Scene,
}

/// The figures of what was measured, and of measured less run.
const MEASURED: &str = "measured";
const RESIDUALS: &str = "residuals";
/// That of the first swings of a run of many.
const SWINGS: &str = "swings";
/// A run of more swings than this has a figure of its first few of its own.
const MANY_SWINGS: f64 = 15.0;
/// Fewer steps a swing make a curve with corners.
const SMOOTH: f64 = 40.0;
/// Figures of measured data end where the data do, and this factor later.
const BEYOND_DATA: f64 = 1.05;
/// So many swings are in that one.
const FEW_SWINGS: f64 = 8.0;

/// What is to be shown the start and every step of the run of `scenario`, so that its figures need not play it once more.
pub fn recorder(scenario: &Arc<Scenario>, beside: Option<&Beside>) -> Recorder {
    let measured = beside.and_then(|beside| beside.measured.series().ok());
    let kinds = [Some(Kind::traces()), measured.map(Kind::measured)];
    let columns = kinds.iter().flatten().flat_map(Kind::columns);
    let wanted = Wanted {
        columns: columns.copied().collect(),
        path: true,
        from_s: 0.0,
        to_s: None,
    };
    Recorder::new(scenario, wanted)
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
    recorded: Recorded,
    beside: Option<&Beside>,
    watch: impl FnMut(u64, u64) -> ControlFlow<()>,
) -> Result<Option<Vec<Drawing>>, String> {
    let runs = [Run {
        scenario: Arc::clone(scenario),
        named: scenario.file.title.clone(),
    }];
    let is_exact = of_runs::is_exact(scenario);
    let exact = is_affordable(scenario) && !is_exact;
    let dashed = match (exact, is_exact) {
        (true, _) => ", the exact motion dashed",
        (_, true) => "; the run is the exact motion itself",
        _ => "",
    };
    let joined = readouts
        .swing_s()
        .map(|swing_s| swing_s / scenario.motion.time_step_s)
        .filter(|steps| *steps < SMOOTH)
        .map(|steps| format!("; straight lines join the run's steps, about {steps:.0} a swing"));
    let also = format!("{dashed}{}", joined.unwrap_or_default());
    let mut wanted = vec![
        (
            TRACES,
            Kind::traces(),
            None,
            format!("x, y and z of the traced point over time{also}"),
        ),
        (
            ABOVE,
            Kind::Above,
            None,
            format!("Path of the traced point from above{also}"),
        ),
        (
            THREE_D,
            Kind::ThreeD,
            None,
            format!("Path of the traced point in space{also}"),
        ),
    ];
    if let Some(to_s) = few_swings_s(scenario, readouts) {
        let caption = format!("Tilt in the first {} s{also}", shortest(to_s));
        wanted.insert(1, (SWINGS, Kind::named("tilt_deg")?, Some(to_s), caption));
    }
    let measured = beside.map(|beside| (beside.reached(), beside.end_s));
    if let Some((measured, end_s)) = &measured
        && measured.count() > 0
        && let Ok(series) = measured.series()
    {
        let last_s = series.times_s.last().copied().unwrap_or_default();
        let end_s = end_s.min(BEYOND_DATA * last_s);
        let name = &measured.origin;
        let over_time = format!("What was measured, `{name}`, and the run{also}");
        let less = format!("What was measured, `{name}`, less what the run says");
        let kinds = [
            (MEASURED, Kind::measured(series), over_time),
            (RESIDUALS, Kind::Residuals, less),
        ];
        for (place, (name, kind, caption)) in kinds.into_iter().enumerate() {
            wanted.insert(place, (name, kind, Some(end_s), caption));
        }
    }
    let has_places = beside.is_some_and(|beside| !beside.compared.places.is_empty());
    let is_beside = |name: &str| match name {
        ABOVE => has_places,
        name => [MEASURED, RESIDUALS].contains(&name),
    };
    let requests = wanted.iter().map(|(name, kind, to_s, _)| Request {
        kind: kind.clone(),
        from_s: 0.0,
        to_s: *to_s,
        // A run of the exact motion is drawn once, with the circles that bound it.
        exact: exact || is_exact,
        measured: measured
            .as_ref()
            .filter(|_| is_beside(name))
            .map(|(measured, _)| Arc::clone(measured)),
        width_pt: COLUMN_PT,
    });
    let requests: Vec<_> = requests.collect();
    let known = Known {
        recorded: Some(recorded),
        said: beside.map(|beside| beside.said.clone()),
    };
    let drawn = of_runs::figures(&runs, &requests, &known, watch)?;
    let has_swings = wanted.iter().any(|(name, ..)| *name == SWINGS);
    let drawings = |drawn: Vec<Figure>| {
        let each = wanted.into_iter().zip(drawn);
        each.map(|((name, kind, _, caption), figure)| Drawing {
            name,
            caption,
            remark: figure
                .dense
                .map(|dense| crowded(&dense, &kind, exact, has_swings)),
            scene: figure.scene,
        })
        .collect()
    };
    Ok(drawn.map(drawings))
}

/// What is said of a figure of that kind in which something covers the paper.
fn crowded(dense: &Dense, kind: &Kind, exact: bool, has_swings: bool) -> String {
    let hidden = match exact {
        true => ", and the exact motion hides the run below it",
        false => "",
    };
    let swings = match has_swings && matches!(kind, Kind::OverTime(_)) {
        true => format!("`{SWINGS}.pdf` shows the first of them; "),
        false => String::new(),
    };
    format!(
        "On {} mm {} cover the paper: none is told from the next{hidden}. {swings}`gyrolab figure {RUN_FILE} --kind {}{} {} -o part.pdf` \
         draws a part of the run.",
        dense.width_mm,
        dense.what,
        kind.name(),
        if exact { " --exact" } else { "" },
        dense.options(),
    )
}

/// Where the run has many swings, the time that a few of them take, s.
fn few_swings_s(scenario: &Scenario, readouts: &Readouts) -> Option<f64> {
    let swing_s = readouts.swing_s()?;
    let is_long = Clock::end_s(scenario) > MANY_SWINGS * swing_s;
    is_long.then(|| rounded(FEW_SWINGS * swing_s, 2))
}
