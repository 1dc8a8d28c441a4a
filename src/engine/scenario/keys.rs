//! The schema of scenario and run files: name, kind of value, unit and meaning of each key.
//!
//! `check` compares every file and every `--set` with it. Rules for several values are in `checks` and `parts`.

use super::kind::Range::{self, Any, NotNegative, Positive};
use super::kind::ValueKind::{
    self, Flag, Line, Number, OneOf, Pane, Panes, Paragraph, Settings, Vector, Whole, WholeOr,
};
use super::kind::check_range;
pub use super::kind::{PITCH_DEG, ZOOM_RANGE};
use super::limits::MOST_POINTS;
use super::problem::{Problem, Problems, nearest};
use super::schema::Nudge::{By, Hundredth, Ladder, Turn, Typed, WholeHundredth};
use super::schema::{DefaultValue, Schema, SchemaRow, UNKNOWN_KEY, may, must, pattern};
use super::screen::{ALL_ROWS, AUTO, DETAILS, HIDEABLE, PHASES};
use super::solids;
use crate::physics::scheme;
use toml::{Table, Value};

/// Name of the traced point if a scenario names none.
pub const TOP: &str = "top";

/// Keys of `[motion]` that can be edited during a run.
pub const EDITABLE_MOTION: [&str; 3] = [
    "motion.gravity_m_per_s2",
    "motion.scheme",
    "motion.time_step_s",
];

/// Default gravity, m/s² (the report's value).
pub const GRAVITY: f64 = 9.8;

/// Default playback speed, simulated seconds per second.
pub const DEFAULT_SPEED: f64 = 1.0;

/// Highest number of a phase of a time step that can be selected.
pub const MOST_PHASES: i64 = 1000;

/// Meaning of `start.momentum_Js`, and the keys that can replace it.
pub(super) const STATED: &str = "angular momentum L about the pivot, J s; or give spin_rpm or spin_rad_per_s instead, or omega_rad_per_s, or Euler rates such as psi_dot_rad_per_s";

/// All keys, in the order in which files are written.
#[rustfmt::skip]
pub const KEYS: &[SchemaRow] = &[
    may("gyrolab", Line, "version of gyrolab that wrote the run file"),
    must("title", Line, "name of the scenario").lab("title", "", Typed),
    may("about", Paragraph, "one paragraph for the list of presets").lab("about", "", Typed),
    may("source", Paragraph, "source of the set-up").lab("source", "", Typed),
    may("trace", Line, "name of the point whose path is shown; if there is no top, the point farthest from the pivot").or(DefaultValue::Word(TOP)).lab("traced point", "", Turn),
    must("body.rim.points", Whole(1, MOST_POINTS), "equal masses on a circle across the axle; point j at angle 2 pi j/n from +x towards +y").lab("rim points", "", WholeHundredth),
    must("body.rim.radius_m", Number(Positive), "radius of the circle, m").lab("rim radius", "m", Hundredth(0.01)),
    must("body.rim.height_m", Number(Any), "height of the circle above the pivot, m").lab("rim height", "m", Hundredth(0.01)),
    must("body.rim.point_mass_kg", Number(Positive), "mass of each point, kg").lab("mass each", "kg", Hundredth(0.01)),
    must("body.point.*.name", Line, "unique name of the point").lab("name", "", Typed),
    must("body.point.*.at_m", Vector, "position in the upright pose, m, pivot at the origin").lab("", "m", Hundredth(0.01)),
    may("body.point.*.mass_kg", Number(NotNegative), "mass, kg").or(DefaultValue::Number(0.0)).lab("mass", "kg", Hundredth(0.01)),
    must("body.part.*.shape", OneOf(&SHAPES), "shape of the solid, which determines its dimensions").lab("shape", "", Turn),
    must("body.part.*.name", Line, "unique name of the part; its center can be pushed and traced by this name").lab("name", "", Typed),
    must("body.part.*.mass_kg", Number(Positive), "mass, kg").lab("mass", "kg", Hundredth(0.01)),
    must("body.part.*.at_m", Vector, "center of mass in the upright pose, m, pivot at the origin").lab("", "m", Hundredth(0.01)),
    may("body.part.*.axis", Vector, "direction of its axis; its own x and y turn along by the shortest way from +z, for -z by half a turn about x (if absent: [0, 0, 1])").lab("axis ", "", Hundredth(0.01)),
    may("body.part.*.radius_m", Number(Positive), "ring, cylinder, ball, shell, cone (its base): radius, m").lab("radius", "m", Hundredth(0.01)),
    may("body.part.*.inner_radius_m", Number(NotNegative), "tube: radius of the hole, m").lab("inner radius", "m", Hundredth(0.01)),
    may("body.part.*.outer_radius_m", Number(Positive), "tube: radius of the outside, m").lab("outer radius", "m", Hundredth(0.01)),
    may("body.part.*.length_m", Number(NotNegative), "tube, rod, cone (its apex against the axis), cylinder (if absent: 0, a disk): along the axis, m").lab("length", "m", Hundredth(0.01)),
    may("body.part.*.size_m", Vector, "block: sides along its x, y and axis, m").lab("size ", "m", Hundredth(0.01)),
    may("body.part.*.moments_kg_m2", Vector, "moments: about its center, or as about says; across (x), across (y) and about the axis, kg m^2").lab("I", "kg m2", Hundredth(0.01)),
    may("body.part.*.about", OneOf(&["center", "pivot"]), "moments: \"pivot\" for moments about the pivot, with axes parallel to its own").or(DefaultValue::Word("center")).lab("I about", "", Turn),
    may("start.tilt_deg", Number(Any), "turns the upright body about +x, degrees").or(DefaultValue::Number(0.0)).lab("tilt", "deg", By(1.0)),
    may("start.turn_deg", Number(Any), "then turns the tilted body about +z, degrees").or(DefaultValue::Number(0.0)).lab("turn", "deg", By(1.0)),
    may("start.roll_deg", Number(Any), "first turns the upright body about its own axle, degrees").or(DefaultValue::Number(0.0)).lab("roll", "deg", By(1.0)),
    must("start.momentum_Js", Vector, STATED).unless(&["spin_rpm", "spin_rad_per_s", "omega_rad_per_s", "precession_rad_per_s", "nutation_rad_per_s", "psi_dot_rad_per_s"]).lab("L", "J s", Hundredth(1.0)),
    may("start.momentum_frame", OneOf(&["world", "body"]), "\"body\": L is turned with the body").or(DefaultValue::Word("world")).lab("L given in", "", Turn),
    may("start.spin_rpm", Number(Any), "instead of momentum_Js: spin about the axle, revolutions per minute (rpm); omega = spin * axle").lab("spin", "rpm", Hundredth(1.0)),
    may("start.spin_rad_per_s", Number(Any), "instead of momentum_Js: spin about the axle, rad/s (omega_3); in many books, spin means psi_dot_rad_per_s").lab("spin", "rad/s", Hundredth(0.1)),
    may("start.steady", Flag, "true, with a spin: L is chosen for the slow steady precession at this tilt, without pushes").or(DefaultValue::Flag(false)).lab("steady", "", Turn),
    may("start.omega_rad_per_s", Vector, "instead of momentum_Js: angular velocity, rad/s; L = I omega").lab("w", "rad/s", Hundredth(0.1)),
    may("start.omega_frame", OneOf(&["world", "body"]), "\"body\": omega is turned with the body").or(DefaultValue::Word("world")).lab("w given in", "", Turn),
    may("start.precession_rad_per_s", Number(Any), "instead of momentum_Js: Euler rates as in Goldstein; phi-dot, rate of turn_deg about +z, rad/s (if absent: 0)").lab("precession", "rad/s", Hundredth(0.1)),
    may("start.nutation_rad_per_s", Number(Any), "Euler rate theta-dot, rate of tilt_deg, rad/s (if absent: 0)").lab("nutation", "rad/s", Hundredth(0.1)),
    may("start.psi_dot_rad_per_s", Number(Any), "Euler rate psi-dot, rate of roll_deg about the axle, rad/s; omega_3 = psi-dot + phi-dot cos(tilt) (if absent: 0)").lab("psi-dot", "rad/s", Hundredth(0.1)),
    may("start.rotor", Line, "name of the part that spins alone: L along the axle is the moment of this part times the spin").lab("rotor", "", Turn),
    may("motion.gravity_m_per_s2", Number(Any), "acceleration of gravity along -z, m/s^2").or(DefaultValue::Number(GRAVITY)).lab("gravity", "m/s2", By(0.1)),
    may("motion.scheme", OneOf(&SCHEME_NAMES), "the numerical scheme").or(DefaultValue::Word("report")).lab("scheme", "", Turn),
    must("motion.time_step_s", Number(Positive), "time step dt, s").lab("dt", "s", Ladder),
    must("motion.steps", Whole(1, i64::MAX), "length of the run in steps").lab("steps", "", WholeHundredth),
    must("push.*.point", Line, "name of the pushed point").lab("point", "", Turn),
    must("push.*.force_N", Vector, "force, world frame, N").lab("F", "N", Hundredth(1.0)),
    may("push.*.first_step", Whole(1, i64::MAX), "first step on which it acts; step 1 ends at t = dt; an edit of dt keeps its time in seconds").or(DefaultValue::Whole(1)).lab("first step", "", WholeHundredth),
    may("push.*.steps", Whole(1, i64::MAX), "number of steps on which it acts; an edit of dt keeps their time in seconds").lab("steps", "", WholeHundredth),
    may("push.*.from_s", Number(NotNegative), "instead of steps: time at which it begins, s").or(DefaultValue::Number(0.0)).lab("from", "s", Hundredth(0.1)),
    may("push.*.for_s", Number(Positive), "duration, s").lab("for", "s", Hundredth(0.1)),
    may("push.*.accumulates", Flag, "true: the force is multiplied by j on its j-th step, and then by steps to the end").or(DefaultValue::Flag(false)).lab("accumulates", "", Turn),
    may("friction.spin_dry_Nm", Number(NotNegative), "dry friction on the spin: torque against it, N m; it keeps a body at rest from spinning").or(DefaultValue::Number(0.0)).lab("dry", "N m", Hundredth(0.001)),
    may("friction.spin_viscous_Nms", Number(NotNegative), "viscous friction on the spin: torque per spin in rad/s, N m s").or(DefaultValue::Number(0.0)).lab("viscous", "N m s", Hundredth(0.001)),
    may("friction.spin_quadratic_Nms2", Number(NotNegative), "friction on the spin as in air: torque per square of the spin, N m s^2").or(DefaultValue::Number(0.0)).lab("quadratic", "N m s2", Hundredth(1e-5)),
    may("friction.swing_viscous_Nms", Number(NotNegative), "viscous friction on the swing: torque per angular velocity across the axle, N m s").or(DefaultValue::Number(0.0)).lab("on swing", "N m s", Hundredth(0.001)),
    may("view.speed", Number(Positive), "playback speed at the start, simulated seconds per second").or(DefaultValue::Number(DEFAULT_SPEED)).lab("speed", "s/s", Ladder),
    may("view.look_at", Line, "one line: what to watch for").lab("look at", "", Typed),
    may("view.next", Line, "one line: what to try after the run (default, for a preset: its own)"),
    may("view.window_s", Number(Positive), "time range of the overview, s (default: the whole run)"),
    may("view.detail_s", ValueKind::By(is_window), "time range of the traces, s, or auto: a few swings of the axle, or the whole run if it has few").or(DefaultValue::Word("auto")),
    may("view.detail_of", OneOf(&DETAILS), "strip of the traces below x, y and z: a column of the CSV, or tilt; distance: from the exact motion; auto: distance or tilt, on a large screen").or(DefaultValue::Word("auto")),
    may("view.detail_range", ValueKind::By(check_range), "minimum and maximum of the strip detail_of, in its unit: [0, 130]; auto: from the run in its window").or(DefaultValue::Word("auto")),
    may("view.z_range_m", ValueKind::By(check_range), "minimum and maximum of the strip of z, m: [0.6, 0.95]; auto: from the run in its window").or(DefaultValue::Word("auto")),
    may("view.exact", Flag, "draw the exact motion with the run").or(DefaultValue::Flag(false)),
    may("view.show", Panes(&[]), "panes on the screen, if there is room for them; empty: as many as fit, without panes that are shown only on request (default)"),
    may("view.hide", Panes(&HIDEABLE), "hidden parts of the screen: panes, the line about reliability, the predicted numbers, the line look_at, the arrows of the 3-D view (default: empty)"),
    may("view.fill", Pane(&["none"]), "pane that fills the screen").or(DefaultValue::Word("none")),
    may("view.phase", WholeOr(MOST_PHASES, &PHASES), "phase shown in the pane step: its number or name, last, or why (why sideways, not down?)").or(DefaultValue::Whole(1)),
    may("view.sum_to", WholeOr(MOST_POINTS, &[ALL_ROWS]), "number of rows that the pane step adds up in a phase's table").or(DefaultValue::Word("all")),
    may("view.bare", Flag, "bare screen: one or two panes with only title and time").or(DefaultValue::Flag(false)),
    may("view.measured", Line, "measured data to show with the run: data that come with gyrolab (heidelberg-spin-decay), or a CSV file").or(DefaultValue::Word("none")),
    may("view.residuals", Flag, "show residuals: measured data minus the run's values").or(DefaultValue::Flag(false)),
    may("view.camera.yaw_deg", Number(Any), "viewpoint of the 3-D view: angle of the eye about +z, from -y, degrees"),
    may("view.camera.pitch_deg", Number(Range::Within(PITCH_DEG)), "height of the eye above the horizontal, degrees, -90 to 90"),
    may("view.zoom.above", Number(Range::Within(ZOOM_RANGE)), "magnification of the path from above, 0.5 to 100").or(DefaultValue::Number(1.0)),
    may("view.zoom.3d", Number(Range::Within(ZOOM_RANGE)), "magnification of the scene in space, 0.5 to 100").or(DefaultValue::Number(1.0)),
    must("expected.*.readout", Line, "a column of the CSV that the preset's test checks"),
    must("expected.*.at_step", Whole(0, i64::MAX), "step of the check"),
    must("expected.*.value", Number(Any), "expected value"),
    must("expected.*.tolerance", Number(NotNegative), "tolerance of the value"),
    must("edit.*.step", Whole(0, i64::MAX), "step of the edit, which applies from the next step on"),
    must("edit.*.set", Settings, "dotted keys of motion or push and their new values"),
];

/// Checks the length of the traces' time window, s.
fn is_window(value: &Value) -> Result<(), String> {
    match value.as_str() {
        Some(AUTO) => Ok(()),
        Some(_) => Err(format!("must be a number greater than zero, or \"{AUTO}\"")),
        None => Number(Positive).check(value),
    }
}

const SHAPES: [&str; solids::FORMS.len()] = solids::names();

const SCHEME_NAMES: [&str; scheme::SCHEMES.len()] = scheme::names();

/// Scenario and run files.
pub const SCENARIO: Schema = Schema(&[KEYS]);

/// Returns the row of the dotted `key`, with numbers for positions in arrays, and the kind of value allowed there. For
/// a number in a vector, that is any finite number.
pub fn find(key: &str) -> Result<(&'static SchemaRow, ValueKind), String> {
    if let Some(row) = SCENARIO.row(&pattern(key)) {
        return Ok((row, row.kind));
    }
    if let Some((vector, place)) = key.rsplit_once('.')
        && let Some(row) = SCENARIO.row(&pattern(vector))
        && row.kind == Vector
    {
        return match place {
            "0" | "1" | "2" => Ok((row, Number(Any))),
            _ => Err("unknown key: a vector's numbers are .0, .1 and .2".to_owned()),
        };
    }
    let near = match meant(key) {
        Some(meant) => format!("did you mean {meant}?"),
        None => nearest(&pattern(key), KEYS.iter().map(|row| row.path)),
    };
    Err(format!("{UNKNOWN_KEY}: {near}"))
}

/// Names of some values on the screen, and their keys.
const ON_SCREEN: [(&str, &str); 4] = [
    ("dt", "motion.time_step_s"),
    ("g", "motion.gravity_m_per_s2"),
    ("L", "start.momentum_Js"),
    ("rpm", "start.spin_rpm"),
];

/// Returns the whole key that the unknown `key` probably means. The unknown key may be a name from another table, a
/// name without its unit, or the screen's name of the value. `None` if there are several candidates, or none.
pub(super) fn meant(key: &str) -> Option<&'static str> {
    let name = key.rsplit('.').next().unwrap_or(key);
    let on_screen = ON_SCREEN.iter().find(|(word, _)| *word == name);
    on_screen
        .map(|(_, path)| *path)
        .or_else(|| {
            SCENARIO
                .only(|last| last == name)
                .filter(|path| *path != key)
        })
        .or_else(|| {
            SCENARIO.only(|last| {
                let unit = last.strip_prefix(name);
                unit.is_some_and(|unit| unit.starts_with('_'))
            })
        })
}

/// Effect of setting a key on a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effect {
    /// The new value applies from the next step on.
    FromHere,
    NewRun,
    None,
}

impl Effect {
    pub fn of_key(key: &str) -> Self {
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

/// Checks the whole `table` of a scenario or run file.
pub fn check(table: &Table) -> Problems {
    let mut problems = SCENARIO.check(table);
    for name in REQUIRED_TABLES {
        if !table.contains_key(name) {
            let rule = format!(
                "is missing: add a table [{name}], for instance at the end of the file; gyrolab keys lists its keys"
            );
            problems.add(|| Problem::at(name, rule));
        }
    }
    problems
}

/// Checks `value`, the part of a file at the dotted `path`: a key or a table.
pub fn check_part(value: &Value, path: &str) -> Problems {
    SCENARIO.check_part(value, path, path)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_have_short_labels_documented_units_and_valid_defaults() {
        for key in KEYS {
            let default = key.default.map(Value::from);
            let is_allowed = |value: Value| key.kind.check(&value).is_ok();
            assert!(default.is_none_or(is_allowed), "{}", key.path);
            let Some(lab) = key.lab else { continue };
            assert!(lab.label.len() <= 12, "{}", key.path);
            let about = key.about.replace("^2", "2").replace("degrees", "deg");
            let is_documented = about.contains(key.unit) || key.unit == "s/s";
            assert!(is_documented, "{}: {}", key.path, key.unit);
        }
        let default = |path: &str| Value::from(find(path).unwrap().0.default.unwrap());
        assert_eq!(default("motion.scheme"), scheme::SCHEMES[0].name.into());
    }

    #[test]
    fn paths_in_the_table_are_unique() {
        let mut paths: Vec<_> = KEYS.iter().map(|key| key.path).collect();
        paths.sort_unstable();
        paths.dedup();
        assert_eq!(paths.len(), KEYS.len());
    }
}
