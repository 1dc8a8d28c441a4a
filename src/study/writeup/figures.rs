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
use crate::text::number::{rounded, significant};
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
/// A run has it where it has more swings than this.
const MANY_SWINGS: f64 = 15.0;
/// So many swings are in it.
const FEW_SWINGS: f64 = 8.0;
/// Fewer steps a swing make a curve with corners.
const SMOOTH: f64 = 40.0;
/// Figures of measured data end where the data do, and this factor later.
const BEYOND_DATA: f64 = 1.05;

/// A figure that is to be drawn.
struct Planned {
    name: &'static str,
    kind: Kind,
    from_s: f64,
    /// `None`: to the end of the run.
    to_s: Option<f64>,
    caption: String,
    /// Whether it shows what was measured too.
    shows_measured: bool,
}

impl Planned {
    /// One of the whole run.
    fn whole(name: &'static str, kind: Kind, caption: String) -> Self {
        Self {
            name,
            kind,
            from_s: 0.0,
            to_s: None,
            caption,
            shows_measured: false,
        }
    }
}

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
    let has_places = beside.is_some_and(|beside| !beside.compared.places.is_empty());
    let measured = beside.map(|beside| (beside.reached(), beside.end_s));
    let mut planned = Vec::new();
    if let Some((measured, end_s)) = &measured
        && measured.count() > 0
        && let Ok(series) = measured.series()
    {
        let last_s = series.times_s.last().copied().unwrap_or_default();
        let end_s = end_s.min(BEYOND_DATA * last_s);
        let name = &measured.origin;
        let over_time = format!("What was measured, `{name}`, and the run{also}");
        let less = format!("What was measured, `{name}`, less what the run says");
        let of_data = |name, kind, caption| Planned {
            to_s: Some(end_s),
            shows_measured: true,
            ..Planned::whole(name, kind, caption)
        };
        planned.push(of_data(MEASURED, Kind::measured(series), over_time));
        planned.push(of_data(RESIDUALS, Kind::Residuals, less));
    }
    let caption = format!("x, y and z of the traced point over time{also}");
    planned.push(Planned::whole(TRACES, Kind::traces(), caption));
    if let Some((from_s, to_s)) = few_swings_s(scenario, readouts) {
        let to = significant(to_s, 9);
        let tilt = if from_s > 0.0 {
            let from = significant(from_s, 9);
            format!("Tilt from {from} s, when the forces last changed, to {to} s")
        } else {
            format!("Tilt in the first {to} s")
        };
        planned.push(Planned {
            from_s,
            to_s: Some(to_s),
            ..Planned::whole(SWINGS, Kind::named("tilt_deg")?, tilt + &also)
        });
    }
    let caption = format!("Path of the traced point from above{also}");
    planned.push(Planned {
        shows_measured: has_places,
        ..Planned::whole(ABOVE, Kind::Above, caption)
    });
    let caption = format!("Path of the traced point in space{also}");
    planned.push(Planned::whole(THREE_D, Kind::ThreeD, caption));
    let requests = planned.iter().map(|planned| Request {
        kind: planned.kind.clone(),
        from_s: planned.from_s,
        to_s: planned.to_s,
        // A run of the exact motion is drawn once, with the circles that bound it.
        exact: exact || is_exact,
        measured: measured
            .as_ref()
            .filter(|_| planned.shows_measured)
            .map(|(measured, _)| Arc::clone(measured)),
        width_pt: COLUMN_PT,
    });
    let requests: Vec<_> = requests.collect();
    let known = Known {
        recorded: Some(recorded),
        said: beside.map(|beside| beside.said.clone()),
    };
    let drawn = of_runs::figures(&runs, &requests, &known, watch)?;
    let has_swings = planned.iter().any(|planned| planned.name == SWINGS);
    let drawings = |drawn: Vec<Figure>| {
        let each = planned.into_iter().zip(drawn);
        each.map(|(planned, figure)| Drawing {
            remark: figure
                .dense
                .map(|dense| crowded(&dense, &planned.kind, exact, has_swings)),
            name: planned.name,
            caption: planned.caption,
            scene: figure.scene,
        })
        .collect()
    };
    Ok(drawn.map(drawings))
}

/// What is said of a figure of that kind in which something covers the paper.
fn crowded(dense: &Dense, kind: &Kind, exact: bool, has_swings: bool) -> String {
    let hidden = if exact {
        ", and the exact motion hides the run below it"
    } else {
        ""
    };
    let swings = if has_swings && matches!(kind, Kind::OverTime(_)) {
        format!("`{SWINGS}.pdf` shows a few of them; ")
    } else {
        String::new()
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

/// Where the run has many swings, the begin and the end of a few of them, s: of the first after the forces last changed, if that
/// leaves enough of the run.
fn few_swings_s(scenario: &Scenario, readouts: &Readouts) -> Option<(f64, f64)> {
    let swing_s = readouts.swing_s()?;
    let end_s = Clock::end_s(scenario);
    let few_s = rounded(FEW_SWINGS * swing_s, 2);
    // The first step under other forces: they changed where it began.
    let changed = readouts.since.saturating_sub(1);
    let from_s = Clock::at(scenario, changed).time_s(changed);
    let from_s = if from_s + few_s <= end_s { from_s } else { 0.0 };
    (end_s > MANY_SWINGS * swing_s).then_some((from_s, from_s + few_s))
}
