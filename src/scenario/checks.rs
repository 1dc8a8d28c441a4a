//! From the file's shape to numbers that make sense together: points that exist, an inertia that can be inverted,
//! pushes that say how long they act, edits that touch what may be edited.

use super::document::set_key;
use super::file::{BodyFile, EditFile, Frame, MotionFile, PushFile, ScenarioFile, StartFile};
use super::keys::{self, KEYS, MOST_POINTS};
use super::problem::{Problem, listed, nearest};
use crate::physics::{self, PointMass, SchemeInfo, State, observables, rotation};
use nalgebra::Vector3;
use std::collections::HashMap;
use std::f64::consts::TAU;

/// Gravity where a scenario gives none, m/s² (the report's figure).
const GRAVITY: f64 = 9.8;
/// The traced point where a scenario names none.
const TOP: &str = "top";

/// A scenario, or a run with its edits, whose numbers have been checked.
#[derive(Clone, Debug)]
pub struct Scenario {
    /// The file it came from, as it is written again.
    pub file: ScenarioFile,
    /// What turns, with the names of its points.
    pub body: Body,
    /// Index of the point whose path is shown.
    pub trace: usize,
    /// Orientation and momentum at t = 0.
    pub start: State,
    /// How it moves at the start.
    pub motion: Motion,
    /// Length of the run in steps.
    pub steps: u64,
    /// The time step for which its step counts were written, s.
    pub written_for_s: f64,
    /// The pushes at the start.
    pub pushes: Vec<Push>,
    /// What the user changed during the run, in the order of the steps.
    pub edits: Vec<Edit>,
}

/// The body and the names of its points.
#[derive(Clone, Debug)]
pub struct Body {
    /// The mechanics.
    pub mechanics: physics::Body,
    names: HashMap<String, usize>,
}

/// Gravity, scheme and time step: what edits may change as the run goes on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion {
    /// Acceleration of gravity along −z, m/s².
    pub gravity: f64,
    /// The numerical scheme.
    pub scheme: &'static SchemeInfo,
    /// dt, s.
    pub time_step_s: f64,
}

/// A force on one point for a while.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Push {
    /// Index of the pushed point.
    pub point: usize,
    /// Force, world frame, N.
    pub force: Vector3<f64>,
    /// When it acts.
    pub window: Window,
    /// Whether it is the report's line taken literally: j times the force on its j-th step, and kept to the end.
    pub accumulates: bool,
}

/// When a push acts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Window {
    /// On `count` steps from step `first` on; step 1 ends at t = dt.
    Steps {
        /// The first step on which it acts.
        first: u64,
        /// On how many.
        count: u64,
    },
    /// From one time for so long, s.
    Time {
        /// The beginning, s.
        from_s: f64,
        /// The length, s.
        for_s: f64,
    },
}

/// A change during the run: made at `step`, it acts from the next step on.
#[derive(Clone, Debug, PartialEq)]
pub struct Edit {
    /// The step at which it was made.
    pub step: u64,
    /// How the body moves from then on.
    pub motion: Motion,
    /// The pushes from then on.
    pub pushes: Vec<Push>,
    /// What it set.
    pub touches: Touches,
}

/// Which parts of the motion an edit set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Touches {
    /// The time step: t is counted anew from here, and pushes keep their seconds.
    pub time_step: bool,
    /// The time step, the scheme or gravity: a new segment begins.
    pub segment: bool,
}

impl Body {
    /// Index of the point called `name`.
    pub fn point(&self, name: &str) -> Option<usize> {
        self.names.get(name).copied()
    }

    /// The names of the points that have one, in the order in which the body lists them.
    pub fn names(&self) -> Vec<&str> {
        let mut names: Vec<_> = self
            .names
            .iter()
            .map(|(name, index)| (*index, name.as_str()))
            .collect();
        names.sort_unstable();
        names.into_iter().map(|(_, name)| name).collect()
    }

    fn find(&self, key: &str, name: &str) -> Result<usize, Vec<Problem>> {
        self.point(name).ok_or_else(|| {
            let near = nearest(name, self.names().into_iter());
            let value = toml::Value::String(name.to_owned());
            vec![Problem::with_value(
                key,
                &value,
                format!("is no point of this body: {near}"),
            )]
        })
    }
}

impl Scenario {
    /// Distance of the traced point from the pivot, m: the measure of how far off a run may be.
    pub fn arm_m(&self) -> f64 {
        self.body.mechanics.points()[self.trace].at.norm()
    }

    /// The run file: the scenario with its edits, and the version that wrote it. Reading it gives this scenario again.
    pub fn to_toml(&self) -> String {
        let version = Some(env!("CARGO_PKG_VERSION").to_owned());
        let file = ScenarioFile {
            gyrolab: version,
            ..self.file.clone()
        };
        // A checked file holds nothing that TOML cannot write.
        toml::to_string(&file).unwrap_or_default()
    }
}

/// Makes a scenario of `file`.
///
/// # Errors
/// Every rule that its numbers break together.
pub fn scenario(file: ScenarioFile) -> Result<Scenario, Vec<Problem>> {
    let body = body(&file.body)?;
    let trace = match &file.trace {
        Some(name) => body.find("trace", name)?,
        None => body.point(TOP).ok_or_else(|| no_top(&body))?,
    };
    let start = start(&file.start);
    let motion = motion(&file.motion);
    let pushes = pushes(&file.push, &body, "push")?;
    let edits = edits(&file, &body)?;
    if !is_readable(&body, trace, &start, motion.gravity) {
        let rule = "energy or traced point leave the range of floating-point numbers: use momentum, gravity and distances nearer to 1";
        return Err(vec![Problem::at("start", rule)]);
    }
    Ok(Scenario {
        body,
        trace,
        start,
        motion,
        steps: file.motion.steps,
        written_for_s: motion.time_step_s,
        pushes,
        edits,
        file,
    })
}

/// Whether the first row of the run's CSV is made of finite numbers.
fn is_readable(body: &Body, trace: usize, start: &State, gravity: f64) -> bool {
    let body = &body.mechanics;
    let energy = observables::kinetic_energy(body, start)
        + gravity * observables::weight_height(body, start);
    let traced = observables::position(body, start, trace);
    energy.is_finite() && traced.iter().all(|c| c.is_finite())
}

fn no_top(body: &Body) -> Vec<Problem> {
    let names = body.names();
    let known = match names.len() {
        0 => "it has no named point: add a [[body.point]]".to_owned(),
        _ => format!(
            "name one of its points with trace = \"...\": {}",
            listed(names.into_iter())
        ),
    };
    vec![Problem::at(
        "trace",
        format!("the body has no point \"{TOP}\" whose path could be shown; {known}"),
    )]
}

fn body(file: &BodyFile) -> Result<Body, Vec<Problem>> {
    let rim = file.rim.as_ref().map_or(0, |rim| rim.points);
    let count = rim + file.point.len();
    if count > usize::try_from(MOST_POINTS).unwrap_or(usize::MAX) {
        return Err(vec![Problem::at(
            "body",
            format!("has {count} points; at most {MOST_POINTS} are allowed"),
        )]);
    }
    let mut points = rim_points(file);
    let mut names = HashMap::with_capacity(file.point.len());
    let mut problems = Vec::new();
    for (index, point) in file.point.iter().enumerate() {
        if names.insert(point.name.clone(), points.len()).is_some() {
            let value = toml::Value::String(point.name.clone());
            let key = format!("body.point.{index}.name");
            problems.push(Problem::with_value(
                key,
                &value,
                "is the name of another point too: each needs its own",
            ));
        }
        points.push(PointMass {
            at: Vector3::from(point.at_m),
            mass: point.mass_kg.unwrap_or(0.0),
        });
    }
    if !problems.is_empty() {
        return Err(problems);
    }
    let mechanics =
        physics::Body::new(points).map_err(|error| vec![Problem::at("body", error.to_string())])?;
    Ok(Body { mechanics, names })
}

fn rim_points(file: &BodyFile) -> Vec<PointMass> {
    let Some(rim) = &file.rim else {
        return Vec::new();
    };
    let point = |j: usize| {
        let (sin, cos) = libm::sincos(TAU * j as f64 / rim.points as f64);
        let at = Vector3::new(rim.radius_m * cos, rim.radius_m * sin, rim.height_m);
        PointMass {
            at,
            mass: rim.point_mass_kg,
        }
    };
    (0..rim.points).map(point).collect()
}

fn start(file: &StartFile) -> State {
    let tilt = file.tilt_deg.unwrap_or(0.0).to_radians();
    let orientation = rotation::about(&Vector3::x(), tilt);
    let momentum = Vector3::from(file.momentum_Js);
    let momentum = match file.momentum_frame.unwrap_or_default() {
        Frame::World => momentum,
        Frame::Body => orientation * momentum,
    };
    State {
        time_s: 0.0,
        orientation,
        momentum,
    }
}

fn motion(file: &MotionFile) -> Motion {
    let named = file.scheme.as_deref().and_then(SchemeInfo::find);
    Motion {
        gravity: file.gravity_m_per_s2.unwrap_or(GRAVITY),
        scheme: named.unwrap_or(&physics::scheme::SCHEMES[0]), // an unknown name has been refused by the keys
        time_step_s: file.time_step_s,
    }
}

fn pushes(files: &[PushFile], body: &Body, key: &str) -> Result<Vec<Push>, Vec<Problem>> {
    files
        .iter()
        .enumerate()
        .map(|(index, file)| push(file, body, &format!("{key}.{index}")))
        .collect()
}

fn push(file: &PushFile, body: &Body, key: &str) -> Result<Push, Vec<Problem>> {
    let wrong = |rule: &str| Err(vec![Problem::at(key, rule)]);
    let window = match (file.first_step, file.steps, file.from_s, file.for_s) {
        (first, Some(count), None, None) => Window::Steps {
            first: first.unwrap_or(1),
            count,
        },
        (None, None, from, Some(for_s)) => Window::Time {
            from_s: from.unwrap_or(0.0),
            for_s,
        },
        (None, None, Some(_), None) => return wrong("does not say for how long: add for_s"),
        (first, steps, None, None) if first.is_some() || steps.is_some() => {
            return wrong("does not say for how long: add steps");
        }
        (None, None, None, None) => return wrong("does not say for how long: add steps, or for_s"),
        _ => {
            return wrong(
                "counts in steps and in seconds: keep first_step and steps, or from_s and for_s",
            );
        }
    };
    let accumulates = file.accumulates.unwrap_or(false);
    if accumulates && matches!(window, Window::Time { .. }) {
        return wrong("accumulates step by step: give first_step and steps instead of seconds");
    }
    let point = body.find(&format!("{key}.point"), &file.point)?;
    Ok(Push {
        point,
        force: Vector3::from(file.force_N),
        window,
        accumulates,
    })
}

/// The part of a file that edits may change.
#[derive(serde::Serialize, serde::Deserialize)]
struct Editable {
    motion: MotionFile,
    #[serde(default)]
    push: Vec<PushFile>,
}

fn edits(file: &ScenarioFile, body: &Body) -> Result<Vec<Edit>, Vec<Problem>> {
    if file.edit.is_empty() {
        return Ok(Vec::new());
    }
    let unwritable = |error: toml::ser::Error| vec![Problem::at("motion", error.to_string())];
    let editable = Editable {
        motion: file.motion.clone(),
        push: file.push.clone(),
    };
    let mut table = toml::Table::try_from(&editable).map_err(unwritable)?;
    let mut last = 0;
    file.edit
        .iter()
        .enumerate()
        .map(|(index, entry)| edit(entry, index, &mut table, &mut last, body))
        .collect()
}

/// One edit, on top of those before it in `table`; `last` is the step of the one before.
fn edit(
    entry: &EditFile,
    index: usize,
    table: &mut toml::Table,
    last: &mut u64,
    body: &Body,
) -> Result<Edit, Vec<Problem>> {
    let here = format!("edit.{index}");
    if entry.step < *last {
        let rule = format!(
            "comes before the edit above it (step {last}): edits stand in the order of their steps"
        );
        let step = toml::Value::Integer(i64::try_from(entry.step).unwrap_or(i64::MAX));
        return Err(vec![Problem::with_value(
            format!("{here}.step"),
            &step,
            rule,
        )]);
    }
    *last = entry.step;
    let mut touches = Touches {
        time_step: false,
        segment: false,
    };
    for (key, value) in &entry.set {
        let inside = |problem: Problem| vec![moved(problem, &here, key)];
        may_edit(key, value).map_err(inside)?;
        set_key(table, key, value.clone()).map_err(inside)?;
        touches.time_step |= key == "motion.time_step_s";
        touches.segment |= key.starts_with("motion.");
    }
    // The title and the start are not in this table, and cannot be edited.
    let problems: Vec<_> = keys::check(table)
        .into_iter()
        .filter(|problem| problem.key.starts_with("motion") || problem.key.starts_with("push"))
        .map(|problem| moved(problem.clone(), &here, &problem.key))
        .collect();
    if !problems.is_empty() {
        return Err(problems);
    }
    let editable: Editable = table
        .clone()
        .try_into()
        .map_err(|error: toml::de::Error| vec![Problem::at(&here, error.message().to_owned())])?;
    let pushes = pushes(&editable.push, body, "push").map_err(|list| {
        list.into_iter()
            .map(|p| moved(p.clone(), &here, &p.key))
            .collect::<Vec<_>>()
    })?;
    Ok(Edit {
        step: entry.step,
        motion: motion(&editable.motion),
        pushes,
        touches,
    })
}

/// `problem` at the edit that caused it.
fn moved(problem: Problem, here: &str, key: &str) -> Problem {
    Problem {
        key: format!("{here}.set.{key}"),
        ..problem
    }
}

fn may_edit(key: &str, value: &toml::Value) -> Result<(), Problem> {
    const MOTION: [&str; 3] = [
        "motion.gravity_m_per_s2",
        "motion.scheme",
        "motion.time_step_s",
    ];
    if MOTION.contains(&key) || key.starts_with("push.") {
        return Ok(());
    }
    if value.is_table() {
        let rule = "must be a dotted key in quotes, such as \"motion.time_step_s\" = 0.05";
        return Err(Problem::at(key, rule));
    }
    let rule = match nearest(key, MOTION.into_iter()) {
        near if near.starts_with("did") && !KEYS.iter().any(|known| known.path == key) => {
            format!("unknown key: {near}")
        }
        _ => format!(
            "cannot be edited during a run (only {} and push.N can): set it in the scenario",
            MOTION.join(", ")
        ),
    };
    Err(Problem::at(key, rule))
}
