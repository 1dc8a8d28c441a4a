//! The one table of keys: what each is called, what it may hold, in which unit, and what it means.
//!
//! `check` holds every file and every `--set` against the table, so that a wrong name or value is refused in the same
//! words wherever it comes from. Rules that need more than one value are in `checks` and `parts`.

use super::dotted::{is_in, join};
pub use super::kind::{PITCH_DEG, Range, ValueKind, ZOOM_RANGE};
use super::limits::MOST_POINTS;
use super::problem::{Problem, Problems, nearest};
use super::screen::{ALL_ROWS, DETAILS, HIDEABLE, PHASES};
use super::solids;
use crate::physics::scheme;
use toml::Value;

/// One key a scenario or run file may hold.
#[derive(Debug, PartialEq)]
pub struct ScenarioKey {
    /// Dotted path; `*` stands for any place in an array.
    pub path: &'static str,
    pub kind: ValueKind,
    /// Whether its table is incomplete without it.
    pub required: bool,
    /// Names in its table any of which stands for it: with one of them it is not required.
    pub instead: &'static [&'static str],
    /// Meaning, unit and default, in one line.
    pub about: &'static str,
    /// How the lab shows and changes it; `None` where it does not.
    pub lab: Option<InLab>,
}

/// How the lab shows and changes the value of a key.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InLab {
    /// Short name; of a vector the stem to which x, y or z is added.
    pub label: &'static str,
    pub unit: &'static str,
    pub nudge: Nudge,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Nudge {
    /// Adds so much.
    By(f64),
    /// Adds the largest of 1, 2 and 5 times a power of ten that is not above a hundredth of the size (of a vector: of
    /// its norm), or so much where the size is 0.
    Hundredth(f64),
    /// The same in whole numbers, 1 at the least.
    WholeHundredth,
    /// To the next of ..., 1, 2, 5, 10, 20, ...
    Ladder,
    /// To the next choice, after the last one the first again.
    Turn,
    /// Nothing: it is typed.
    Typed,
}

/// The traced point where a scenario names none.
pub const TOP: &str = "top";

/// What of `[motion]` may be edited as a run goes on.
pub const EDITABLE_MOTION: [&str; 3] = [
    "motion.gravity_m_per_s2",
    "motion.scheme",
    "motion.time_step_s",
];

/// Gravity where a scenario gives none, m/s² (the report's figure).
pub const GRAVITY: f64 = 9.8;

/// Playback speed where a scenario gives none, simulated seconds a second.
pub const DEFAULT_SPEED: f64 = 1.0;

use Nudge::{By, Hundredth, Ladder, Turn, Typed, WholeHundredth};
use Range::{Any, NotNegative, Positive};
use ValueKind::{
    Flag, Line, Number, OneOf, Pane, Panes, Paragraph, Settings, Vector, Whole, WholeOr,
};

const fn must(path: &'static str, kind: ValueKind, about: &'static str) -> ScenarioKey {
    ScenarioKey {
        required: true,
        ..may(path, kind, about)
    }
}

const fn may(path: &'static str, kind: ValueKind, about: &'static str) -> ScenarioKey {
    ScenarioKey {
        path,
        kind,
        required: false,
        instead: &[],
        about,
        lab: None,
    }
}

impl ScenarioKey {
    const fn lab(mut self, label: &'static str, unit: &'static str, nudge: Nudge) -> Self {
        self.lab = Some(InLab { label, unit, nudge });
        self
    }

    /// Not required beside one of `names`.
    const fn unless(mut self, names: &'static [&'static str]) -> Self {
        self.instead = names;
        self
    }

    /// The value where a file has none, which stands at the end of `about`.
    pub fn default(&self) -> Option<Value> {
        let (_, told) = self.about.split_once("(default: ")?;
        let told = told.strip_suffix(')')?;
        match self.kind {
            Number(_) => told.parse().ok().map(Value::Float),
            Whole(..) => told.parse().ok().map(Value::Integer),
            Flag => told.parse().ok().map(Value::Boolean),
            _ => Some(Value::String(told.to_owned())),
        }
    }
}

/// The highest number of a phase of a time step that can be chosen.
pub const MOST_PHASES: i64 = 1000;

/// What `start.momentum_Js` is, and what may stand for it.
pub(super) const STATED: &str = "angular momentum L about the pivot, J s; or give spin_rpm or spin_rad_per_s instead, or omega_rad_per_s, or Euler rates such as psi_dot_rad_per_s";

/// Every key there is, in the order in which files are written.
#[rustfmt::skip]
pub static KEYS: &[ScenarioKey] = &[
    may("gyrolab", Line, "version of gyrolab that wrote the run file"),
    must("title", Line, "name of the scenario").lab("title", "", Typed),
    may("about", Paragraph, "one paragraph for the list of presets").lab("about", "", Typed),
    may("source", Paragraph, "where the set-up comes from").lab("source", "", Typed),
    may("trace", Line, "name of the point whose path is shown; if there is no top, the point farthest from the pivot (default: top)").lab("traced point", "", Turn),
    must("body.rim.points", Whole(1, MOST_POINTS), "equal masses on a circle across the axle; point j at angle 2 pi j/n from +x towards +y").lab("rim points", "", WholeHundredth),
    must("body.rim.radius_m", Number(Positive), "radius of the circle, m").lab("rim radius", "m", Hundredth(0.01)),
    must("body.rim.height_m", Number(Any), "height of the circle above the pivot, m").lab("rim height", "m", Hundredth(0.01)),
    must("body.rim.point_mass_kg", Number(Positive), "mass of each point, kg").lab("mass each", "kg", Hundredth(0.01)),
    must("body.point.*.name", Line, "the point's name, its own").lab("name", "", Typed),
    must("body.point.*.at_m", Vector, "position in the upright pose, m, pivot at the origin").lab("", "m", Hundredth(0.01)),
    may("body.point.*.mass_kg", Number(NotNegative), "mass, kg (default: 0)").lab("mass", "kg", Hundredth(0.01)),
    must("body.part.*.shape", OneOf(&SHAPES), "what kind of solid: it says which dimensions it has").lab("shape", "", Turn),
    must("body.part.*.name", Line, "the part's name, its own; its centre can be pushed and traced by it").lab("name", "", Typed),
    must("body.part.*.mass_kg", Number(Positive), "its mass, kg").lab("mass", "kg", Hundredth(0.01)),
    must("body.part.*.at_m", Vector, "its centre of mass in the upright pose, m, pivot at the origin").lab("", "m", Hundredth(0.01)),
    may("body.part.*.axis", Vector, "direction of its axis; its own x and y are carried by the shortest turn from +z to it, half a turn about x for -z (if absent: [0, 0, 1])").lab("axis ", "", Hundredth(0.01)),
    may("body.part.*.radius_m", Number(Positive), "ring, cylinder, ball, shell, cone (its base): radius, m").lab("radius", "m", Hundredth(0.01)),
    may("body.part.*.inner_radius_m", Number(NotNegative), "tube: radius of the hole, m").lab("inner radius", "m", Hundredth(0.01)),
    may("body.part.*.outer_radius_m", Number(Positive), "tube: radius of the outside, m").lab("outer radius", "m", Hundredth(0.01)),
    may("body.part.*.length_m", Number(NotNegative), "tube, rod, cone (its apex against the axis), cylinder (if absent: 0, a disk): along the axis, m").lab("length", "m", Hundredth(0.01)),
    may("body.part.*.size_m", Vector, "block: its sides along its x, y and axis, m").lab("size ", "m", Hundredth(0.01)),
    may("body.part.*.moments_kg_m2", Vector, "moments: about its center, or as about says; across (x), across (y) and about the axis, kg m^2").lab("I", "kg m2", Hundredth(0.01)),
    may("body.part.*.about", OneOf(&["center", "pivot"]), "moments: \"pivot\": they are about the pivot, about axes parallel to its own (default: center)").lab("I about", "", Turn),
    may("start.tilt_deg", Number(Any), "turns the upright body about +x, degrees (default: 0)").lab("tilt", "deg", By(1.0)),
    may("start.turn_deg", Number(Any), "then turns the tilted body about +z, degrees (default: 0)").lab("turn", "deg", By(1.0)),
    may("start.roll_deg", Number(Any), "first turns the upright body about its own axle, degrees (default: 0)").lab("roll", "deg", By(1.0)),
    must("start.momentum_Js", Vector, STATED).unless(&["spin_rpm", "spin_rad_per_s", "omega_rad_per_s", "precession_rad_per_s", "nutation_rad_per_s", "psi_dot_rad_per_s"]).lab("L", "J s", Hundredth(1.0)),
    may("start.momentum_frame", OneOf(&["world", "body"]), "\"body\": L is turned with the body (default: world)").lab("L given in", "", Turn),
    may("start.spin_rpm", Number(Any), "instead of momentum_Js: the body turns about its axle, revolutions a minute (rpm); omega = spin * axle").lab("spin", "rpm", Hundredth(1.0)),
    may("start.spin_rad_per_s", Number(Any), "the same in rad/s: omega_3, along the axle; many books mean psi_dot_rad_per_s by the spin").lab("spin", "rad/s", Hundredth(0.1)),
    may("start.steady", Flag, "true, with a spin: L is such that the top precesses steadily at this tilt, the slow way; pushes do not count (default: false)").lab("steady", "", Turn),
    may("start.omega_rad_per_s", Vector, "instead of momentum_Js: angular velocity, rad/s; L = I omega").lab("w", "rad/s", Hundredth(0.1)),
    may("start.omega_frame", OneOf(&["world", "body"]), "\"body\": omega is turned with the body (default: world)").lab("w given in", "", Turn),
    may("start.precession_rad_per_s", Number(Any), "instead of momentum_Js: Euler rates, as Goldstein has them; phi-dot, rate of turn_deg about +z, rad/s (if absent: 0)").lab("precession", "rad/s", Hundredth(0.1)),
    may("start.nutation_rad_per_s", Number(Any), "Euler rate theta-dot, rate of tilt_deg, rad/s (if absent: 0)").lab("nutation", "rad/s", Hundredth(0.1)),
    may("start.psi_dot_rad_per_s", Number(Any), "Euler rate psi-dot, rate of roll_deg about the axle, rad/s; omega_3 = psi-dot + phi-dot cos(tilt) (if absent: 0)").lab("psi-dot", "rad/s", Hundredth(0.1)),
    may("start.rotor", Line, "name of the part that spins while the rest of the body does not: L along the axle is that part's moment times the spin").lab("rotor", "", Turn),
    may("motion.gravity_m_per_s2", Number(Any), "acceleration of gravity along -z, m/s^2 (default: 9.8)").lab("gravity", "m/s2", By(0.1)),
    may("motion.scheme", OneOf(&SCHEME_NAMES), "the numerical scheme (default: report)").lab("scheme", "", Turn),
    must("motion.time_step_s", Number(Positive), "time step dt, s").lab("dt", "s", Ladder),
    must("motion.steps", Whole(1, i64::MAX), "length of the run in steps").lab("steps", "", WholeHundredth),
    must("push.*.point", Line, "name of the pushed point").lab("point", "", Turn),
    must("push.*.force_N", Vector, "force, world frame, N").lab("F", "N", Hundredth(1.0)),
    may("push.*.first_step", Whole(1, i64::MAX), "first step on which it acts; step 1 ends at t = dt; an edit of dt keeps its time (default: 1)").lab("first step", "", WholeHundredth),
    may("push.*.steps", Whole(1, i64::MAX), "on how many steps it acts; an edit of dt keeps their time, and changes their number").lab("steps", "", WholeHundredth),
    may("push.*.from_s", Number(NotNegative), "or, instead: from this time, s (default: 0)").lab("from", "s", Hundredth(0.1)),
    may("push.*.for_s", Number(Positive), "for so long, s").lab("for", "s", Hundredth(0.1)),
    may("push.*.accumulates", Flag, "true: j times the force on its j-th step, then steps times it to the end (default: false)").lab("accumulates", "", Turn),
    may("friction.spin_dry_Nm", Number(NotNegative), "dry friction on the spin: this torque against it, N m; it holds a body that does not spin (default: 0)").lab("dry", "N m", Hundredth(0.001)),
    may("friction.spin_viscous_Nms", Number(NotNegative), "viscous friction on the spin: this times the spin in rad/s, N m s (default: 0)").lab("viscous", "N m s", Hundredth(0.001)),
    may("friction.spin_quadratic_Nms2", Number(NotNegative), "friction on the spin as of air: this times the square of the spin, N m s^2 (default: 0)").lab("quadratic", "N m s2", Hundredth(1e-5)),
    may("friction.swing_viscous_Nms", Number(NotNegative), "viscous friction on the swing: this times the part of the angular velocity across the axle, N m s (default: 0)").lab("on swing", "N m s", Hundredth(0.001)),
    may("view.speed", Number(Positive), "what the workbench starts with: simulated seconds a second (default: 1)").lab("speed", "s/s", Ladder),
    may("view.look_at", Line, "one line: what there is to see").lab("look at", "", Typed),
    may("view.next", Line, "one line: what to try after the run (default, for a preset: its own)"),
    may("view.window_s", Number(Positive), "length of time that the traces show, s (default: the run, or what is played of it in two minutes)"),
    may("view.detail_s", Number(Positive), "length of time that the strip of the fast motion shows, s (default: about ten swings of the axle)"),
    may("view.detail_of", OneOf(&DETAILS), "what that strip shows (default: auto, the tilt, or x where the tilt does not swing)"),
    may("view.exact", Flag, "whether the exact motion is drawn beside the run (default: false)"),
    may("view.show", Panes(&[]), "the panes that share the screen, where it has room for them; empty: as many as there is room for, without those that are shown on request only (default)"),
    may("view.hide", Panes(&HIDEABLE), "what is not shown: panes, the line about the numbers' health, theory's predicted numbers, the line look_at (default: empty)"),
    may("view.fill", Pane(&["none"]), "the pane that fills the screen (default: none)"),
    may("view.phase", WholeOr(MOST_PHASES, &PHASES), "the phase that the pane step shows: its number or name, last, or why: why sideways, not down? (default: 1)"),
    may("view.sum_to", WholeOr(MOST_POINTS, &[ALL_ROWS]), "how many rows of a phase's table the pane step adds up (default: all)"),
    may("view.bare", Flag, "whether the screen is bare: two panes, or one, and nothing around them but title and time (default: false)"),
    may("view.measured", Line, "measured data beside the run: data that come with gyrolab (heidelberg-spin-decay), or a CSV file (default: none)"),
    may("view.residuals", Flag, "whether measured data are shown less what the run says (default: false)"),
    may("view.camera.yaw_deg", Number(Any), "from where the 3-D view is seen: angle of the eye about +z, from -y, degrees"),
    may("view.camera.pitch_deg", Number(Range::Within(PITCH_DEG)), "height of the eye above the horizontal, degrees, -90 to 90"),
    may("view.zoom.above", Number(Range::Within(ZOOM_RANGE)), "how much larger than the whole the path from above is shown, 0.5 to 100 (default: 1)"),
    may("view.zoom.3d", Number(Range::Within(ZOOM_RANGE)), "how much larger than the whole the scene in space is shown, 0.5 to 100 (default: 1)"),
    must("expected.*.readout", Line, "a column of the CSV that the preset's test checks"),
    must("expected.*.at_step", Whole(0, i64::MAX), "at which step"),
    must("expected.*.value", Number(Any), "its value there"),
    must("expected.*.tolerance", Number(NotNegative), "how far off it may be"),
    must("edit.*.step", Whole(0, i64::MAX), "the step at which the edit was made; it acts from the next one on"),
    must("edit.*.set", Settings, "dotted keys of motion or push and their new values"),
];

const SHAPES: [&str; solids::FORMS.len()] = solids::names();

const SCHEME_NAMES: [&str; scheme::SCHEMES.len()] = scheme::names();

/// The dotted `key` with `*` in the place of each number.
fn pattern(key: &str) -> String {
    let names = key.split('.').map(|name| {
        if !name.is_empty() && name.bytes().all(|byte| byte.is_ascii_digit()) {
            "*"
        } else {
            name
        }
    });
    names.collect::<Vec<_>>().join(".")
}

/// The row of the dotted `key`, numbers for places in arrays, and what a value there may be: of a number in a vector any
/// finite number.
pub fn find(key: &str) -> Result<(&'static ScenarioKey, ValueKind), String> {
    let row = |pattern: &str| KEYS.iter().find(|known| known.path == pattern);
    if let Some(row) = row(&pattern(key)) {
        return Ok((row, row.kind));
    }
    if let Some((vector, place)) = key.rsplit_once('.')
        && let Some(row) = row(&pattern(vector)).filter(|row| row.kind == Vector)
    {
        return match place {
            "0" | "1" | "2" => Ok((row, Number(Any))),
            _ => Err("unknown key: a vector's numbers are .0, .1 and .2".to_owned()),
        };
    }
    let near = match meant(key) {
        Some(meant) => format!("did you mean {meant}?"),
        None => nearest(&pattern(key), KEYS.iter().map(|key| key.path)),
    };
    Err(format!("{UNKNOWN_KEY}: {near}"))
}

pub(super) const UNKNOWN_KEY: &str = "unknown key";

/// What the screen calls some values, and their keys.
const ON_SCREEN: [(&str, &str); 4] = [
    ("dt", "motion.time_step_s"),
    ("g", "motion.gravity_m_per_s2"),
    ("L", "start.momentum_Js"),
    ("rpm", "start.spin_rpm"),
];

/// The whole key of which the unknown `key` has a part: its name in another table, the name without its unit, or what the
/// screen calls its value. `None` where it may be several, or none.
pub(super) fn meant(key: &str) -> Option<&'static str> {
    let name = key.rsplit('.').next().unwrap_or(key);
    let on_screen = ON_SCREEN.iter().find(|(word, _)| *word == name);
    let without_unit = |last: &str| {
        let unit = last.strip_prefix(name);
        unit.is_some_and(|unit| unit.starts_with('_'))
    };
    on_screen
        .map(|(_, key)| *key)
        .or_else(|| only(|last| last == name).filter(|path| *path != key))
        .or_else(|| only(without_unit))
}

/// The one key whose last name is such as `is_it` wants, where it is in no array.
fn only(is_it: impl Fn(&str) -> bool) -> Option<&'static str> {
    let mut found = KEYS
        .iter()
        .map(|key| key.path)
        .filter(|path| path.rsplit('.').next().is_some_and(&is_it));
    let first = found.next()?;
    (found.next().is_none() && !first.contains('*')).then_some(first)
}

/// Whether the dotted `key` leads to a table of keys, or to an element of an array of such.
pub fn is_table(key: &str) -> bool {
    let pattern = pattern(key);
    KEYS.iter()
        .any(|known| known.path != pattern && is_in(known.path, &pattern))
}

/// What setting a key does to a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effect {
    /// It acts from the next step on.
    FromHere,
    NewRun,
    None,
}

impl Effect {
    pub fn of(key: &str) -> Self {
        const IDLE_KEYS: [&str; 4] = ["title", "about", "source", "motion.steps"];
        const IDLE_TABLES: [&str; 2] = ["view.", "expected."];
        if EDITABLE_MOTION.contains(&key) || key.starts_with("push.") {
            Self::FromHere
        } else if IDLE_KEYS.contains(&key) || IDLE_TABLES.iter().any(|table| key.starts_with(table))
        {
            Self::None
        } else {
            Self::NewRun
        }
    }
}

const REQUIRED_TABLES: [&str; 2] = ["start", "motion"];

/// Checks the whole `table`: unknown names, wrong types, numbers out of range, missing keys.
pub fn check(table: &toml::Table) -> Problems {
    let mut problems = Problems::default();
    check_table(table, "", "", &mut problems);
    problems
}

/// Checks `value`, a part of a file: the key or table at the dotted `path`.
pub fn check_part(value: &Value, path: &str) -> Problems {
    let mut problems = Problems::default();
    let pattern = pattern(path);
    let is_key = KEYS.iter().any(|key| key.path == pattern);
    match value {
        _ if is_key => check_value(value, &pattern, path, &mut problems),
        Value::Table(table) => check_table(table, &pattern, path, &mut problems),
        other => problems.add(|| {
            let rule = format!("must be a table of {}", names(&pattern).join(", "));
            Problem::with_value(path, other, rule)
        }),
    }
    problems
}

/// Checks `table`, whose keys begin with the pattern `under`, and which stands at `path` in the file.
fn check_table(table: &toml::Table, under: &str, path: &str, problems: &mut Problems) {
    let names = names(under);
    for (name, value) in table {
        let key = join(path, name);
        if !names.contains(&name.as_str()) {
            problems.add(|| {
                // It may belong into another table.
                let home = only(|last| last == name).filter(|home| home != name);
                let near = match home {
                    Some(home) => format!("did you mean {home}?"),
                    None => nearest(name, names.iter().copied()),
                };
                // In quotes, or a dot in the name would make it the path of another key.
                let key = if name.contains('.') {
                    join(path, &format!("\"{name}\""))
                } else {
                    key
                };
                Problem::at(key, format!("unknown key: {near}"))
            });
        } else {
            check_value(value, &join(under, name), &key, problems);
        }
    }
    check_missing(table, under, path, problems);
}

/// Finds the keys and tables that `table` lacks.
fn check_missing(table: &toml::Table, under: &str, path: &str, problems: &mut Problems) {
    let is_there = |name: &&str| table.contains_key(*name);
    for (name, key) in below(under).filter(|(_, key)| key.required) {
        if name.contains('.') || is_there(&name) || key.instead.iter().any(is_there) {
            continue;
        }
        let rule = format!("is missing ({})", key.about);
        problems.add(|| Problem::at(join(path, name), rule));
    }
    for name in REQUIRED_TABLES {
        if under.is_empty() && !is_there(&name) {
            let rule = format!(
                "is missing: add a table [{name}], at the end of the file for instance; gyrolab keys lists what it holds"
            );
            problems.add(|| Problem::at(name, rule));
        }
    }
}

fn check_value(value: &Value, pattern: &str, path: &str, problems: &mut Problems) {
    if let Some(key) = KEYS.iter().find(|key| key.path == pattern) {
        if let Err(rule) = key.kind.check(value) {
            problems.add(|| Problem::with_value(path, value, rule));
        }
        return;
    }
    let element = format!("{pattern}.*");
    let is_list = is_table(&element);
    match value {
        Value::Array(items) if is_list => {
            for (index, item) in items.iter().enumerate() {
                let path = join(path, &index.to_string());
                match item {
                    Value::Table(table) => check_table(table, &element, &path, problems),
                    other => problems.add(|| Problem::with_value(path, other, "must be a table")),
                }
            }
        }
        Value::Table(table) if !is_list => check_table(table, pattern, path, problems),
        other => problems.add(|| {
            let rule = if is_list {
                format!("must be an array of tables: write [[{pattern}]]")
            } else {
                format!("must be a table: write [{pattern}]")
            };
            Problem::with_value(path, other, rule)
        }),
    }
}

/// The names that may stand in the tables of the pattern `under`, each once.
pub(super) fn names(under: &str) -> Vec<&'static str> {
    let mut names: Vec<_> = below(under)
        .filter_map(|(rest, _)| rest.split('.').next())
        .filter(|name| *name != "*")
        .collect();
    names.dedup();
    names
}

/// The keys below the pattern `under`, and what their paths have after it.
fn below(under: &str) -> impl Iterator<Item = (&'static str, &'static ScenarioKey)> {
    let under = if under.is_empty() {
        String::new()
    } else {
        format!("{under}.")
    };
    KEYS.iter()
        .filter_map(move |key| Some((key.path.strip_prefix(&under)?, key)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_are_short_and_units_and_defaults_are_told() {
        for key in KEYS {
            let Some(lab) = key.lab else { continue };
            assert!(lab.label.len() <= 12, "{}", key.path);
            let is_told = key.about.contains("(default: ");
            let default = key.default();
            assert_eq!(default.is_some(), is_told, "{}", key.path);
            assert!(
                default.is_none_or(|value| key.kind.check(&value).is_ok()),
                "{}",
                key.path
            );
            let about = key.about.replace("^2", "2").replace("degrees", "deg");
            let is_told = about.contains(lab.unit) || lab.unit == "s/s";
            assert!(is_told, "{}: {}", key.path, lab.unit);
        }
        let default = |path: &str| find(path).unwrap().0.default().unwrap();
        assert_eq!(default("motion.gravity_m_per_s2"), GRAVITY.into());
        assert_eq!(default("motion.scheme"), scheme::SCHEMES[0].name.into());
        assert_eq!(default("view.speed"), DEFAULT_SPEED.into());
        assert_eq!(default("trace"), TOP.into());
    }

    #[test]
    fn no_path_stands_twice_in_the_table() {
        let mut paths: Vec<_> = KEYS.iter().map(|key| key.path).collect();
        paths.sort_unstable();
        paths.dedup();
        assert_eq!(paths.len(), KEYS.len());
    }
}
