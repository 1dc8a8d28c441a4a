//! Error messages for scenarios: each names file, line, key and rule, so that a user who has never seen the code can act
//! on it.

use crate::support::words::{has, has_all};
use gyrolab::engine::scenario::dotted::set_key;
use gyrolab::engine::scenario::keys::{self, KEYS};
use gyrolab::engine::scenario::{Document, Problem};
use gyrolab::engine::text::printable::is_steering;
use std::fs;
use std::path::Path;
use toml::{Table, Value};

/// A run file with every table and every key, except alternatives; [`SECONDS`] has the rest.
const WHOLE: &str = r#"title = "A top"
about = "About it."
source = "a book"
trace = "top"
[body.rim]
points = 10
radius_m = 0.8
height_m = 0.5
point_mass_kg = 0.5
[[body.point]]
name = "top"
at_m = [0, 0, 1]
mass_kg = 0
[start]
tilt_deg = 45
momentum_Js = [0, 0, 1000]
momentum_frame = "body"
[motion]
gravity_m_per_s2 = 9.8
scheme = "report"
time_step_s = 0.1
steps = 100
[[push]]
point = "top"
force_N = [0, 0, -100]
first_step = 1
steps = 20
accumulates = true
[view]
speed = 20
look_at = "Something."
[[expected]]
readout = "z_m"
at_step = 100
value = 0.8
tolerance = 1e-4
[[edit]]
step = 40
set = { "motion.time_step_s" = 0.05 }
[[edit]]
step = 40
set = { "push.0.force_N" = [0, 0, -50] }
"#;

/// The times of a `[[push]]` in seconds, which replace lines 26 to 28.
const SECONDS: &str = "from_s = 0\nfor_s = 2\n";

fn refusal(text: &str) -> String {
    match Document::parse("file.toml", text).and_then(|document| document.scenario()) {
        Ok(_) => panic!("accepted: {text}"),
        Err(problems) => problems.to_string(),
    }
}

/// Returns `text` with line `number` (from 1) replaced.
fn with_line(text: &str, number: usize, new: &str) -> String {
    let mut lines: Vec<_> = text.lines().collect();
    lines[number - 1] = new;
    lines.join("\n")
}

/// Returns the error message for [`WHOLE`] with these lines replaced.
fn mistakes(lines: &[(usize, &str)]) -> String {
    refusal(&lines.iter().fold(WHOLE.to_owned(), |text, (at, new)| {
        with_line(&text, *at, new)
    }))
}

/// Mistakes: the replaced line, its replacement, and the expected message: line (0: whole file), beginning (from the key
/// on), and other words in it.
#[rustfmt::skip]
const TABLE: &[(usize, &str, usize, &str, &str)] = &[
    // not TOML
    (1, "title = ", 1, "TOML parse error", "string"),
    (1, "title", 1, "TOML parse error", "="),
    (1, "= 3", 1, "TOML parse error", "key"),
    (1, "title = \"A top", 1, "TOML parse error", "string"),
    (18, "[motion", 18, "TOML parse error", "]"),
    (18, "[motion]]", 18, "TOML parse error", ""),
    (21, "time_step_s = 0.1.2", 21, "TOML parse error", ""),
    (21, "time_step_s = 0,1", 21, "TOML parse error", ""),
    (21, "time_step_s = .1", 21, "TOML parse error", ""),
    (22, "steps = 99999999999999999999", 22, "TOML parse error", ""),
    (22, "steps = 100\nsteps = 100", 23, "TOML parse error", "duplicate"),
    (29, "[motion]", 29, "TOML parse error", "duplicate"),
    (16, "momentum_Js = [0, 0, 1000", 17, "TOML parse error", ""),
    (1, "title = \"a\u{1}b\"", 1, "TOML parse error", ""),
    (1, "title = \"a\u{1b}[2Jb\"", 1, "TOML parse error", ""),
    // unknown keys
    (1, "title = \"A top\"\ncolour = 3", 2, "colour: unknown key", "there is gyrolab, title, about"),
    (1, "titel = \"A top\"", 1, "titel: unknown key", "did you mean title?"),
    (1, "titel = \"A top\"", 1, "", "title: is missing (name of the scenario)"),
    (5, "[body.rym]", 5, "body.rym: unknown key", "did you mean rim?"),
    (6, "point = 10", 6, "body.rim.point: unknown key", "did you mean points?"),
    (7, "radius = 0.8", 7, "body.rim.radius: unknown key", "did you mean radius_m?"),
    (9, "point_mass_g = 500", 9, "body.rim.point_mass_g: unknown key", "did you mean point_mass_kg?"),
    (13, "mass = 0", 13, "body.point.0.mass: unknown key", "did you mean mass_kg?"),
    (15, "tilt = 45", 15, "start.tilt: unknown key", "did you mean tilt_deg?"),
    (18, "[moton]", 18, "moton: unknown key", "did you mean motion?"),
    (19, "gravity = 9.8", 19, "motion.gravity: unknown key", "did you mean gravity_m_per_s2?"),
    (21, "dt = 0.1", 18, "motion.time_step_s: is missing", "s)"),
    (23, "[[pushes]]", 23, "pushes: unknown key", "did you mean push?"),
    (25, "force = [0, 0, -100]", 25, "push.0.force: unknown key", "did you mean force_N?"),
    (30, "sped = 20", 30, "view.sped: unknown key", "did you mean speed?"),
    (33, "readouts = \"z_m\"", 33, "expected.0.readouts: unknown key", "did you mean readout?"),
    (38, "steps = 40", 38, "edit.0.steps: unknown key", "did you mean step?"),
    (4, "'motion.steps' = 3", 4, "\"motion.steps\": unknown key", ""),
    (4, "\"a\\nb\" = 3", 4, "a\\nb: unknown key", ""),
    (4, "\"a\\u202eb\" = 3", 4, "a\\u{202e}b: unknown key", ""),
    // missing keys and tables
    (1, "", 0, "title: is missing", "name of the scenario"),
    (6, "", 5, "body.rim.points: is missing", "equal masses on a circle"),
    (7, "", 5, "body.rim.radius_m: is missing", ""),
    (8, "", 5, "body.rim.height_m: is missing", ""),
    (9, "", 5, "body.rim.point_mass_kg: is missing", ""),
    (11, "", 10, "body.point.0.name: is missing", ""),
    (12, "", 10, "body.point.0.at_m: is missing", ""),
    (16, "", 14, "start.momentum_Js: is missing", "spin_rpm or spin_rad_per_s"),
    (21, "", 18, "motion.time_step_s: is missing", ""),
    (22, "", 18, "motion.steps: is missing", ""),
    (24, "", 23, "push.0.point: is missing", ""),
    (25, "", 23, "push.0.force_N: is missing", ""),
    (33, "", 32, "expected.0.readout: is missing", ""),
    (34, "", 32, "expected.0.at_step: is missing", ""),
    (35, "", 32, "expected.0.value: is missing", ""),
    (36, "", 32, "expected.0.tolerance: is missing", ""),
    (38, "", 37, "edit.0.step: is missing", ""),
    (39, "", 37, "edit.0.set: is missing", ""),
    // wrong types; another test covers every key
    (1, "title = 3", 1, "title (3) must be text, not a number", ""),
    (2, "about = true", 2, "about (true) must be text, not true or false", ""),
    (3, "source = [\"a\"]", 3, "source ([\"a\"]) must be text, not an array", ""),
    (4, "trace = 1979-05-27", 4, "trace (1979-05-27) must be text, not a date", ""),
    (4, "body = 3", 5, "TOML parse error", ""),
    (6, "points = 10.0", 6, "body.rim.points (10.0) must be a whole number", ""),
    (8, "height_m = {}", 8, "body.rim.height_m (a table) must be a number, not a table", ""),
    (12, "at_m = 3", 12, "body.point.0.at_m (3) must be three numbers in brackets, not a number", ""),
    (12, "at_m = [0, 1]", 12, "body.point.0.at_m ([0, 1]) must be three numbers, not 2", ""),
    (12, "at_m = [0, 0, \"1\"]", 12, "body.point.0.at_m", "each must be a number, not text"),
    (16, "momentum_Js = nan", 16, "start.momentum_Js (nan) must be three numbers in brackets, and NaN is not finite", ""),
    (17, "roll_deg = inf", 17, "start.roll_deg (inf) must be a finite number", ""),
    (17, "spin_rpm = 300", 17, "start.spin_rpm (300.0) is given in addition to momentum_Js", "keep only one"),
    (17, "steady = true", 17, "start.steady (true) needs a spin", "give spin_rpm"),
    (17, "momentum_frame = \"bdy\"", 17, "start.momentum_frame (\"bdy\") must be one of world, body", "did you mean body?"),
    (20, "scheme = \"reprot\"", 20, "motion.scheme (\"reprot\") must be one of report, ", "did you mean report?"),
    (30, "speed = \"fast\"", 30, "view.speed (\"fast\") must be a number", ""),
    (39, "set = 3", 39, "edit.0.set (3) must be a table of keys and values, not a number", ""),
    (23, "[push]", 23, "push (a table) must be an array of tables", "[[push]]"),
    (10, "[body.point]", 10, "body.point (a table) must be an array of tables", "[[body.point]]"),
    (18, "[[motion]]", 18, "motion (1 tables) must be a table: write [motion]", ""),
    (29, "[[view]]", 29, "view (1 tables) must be a table: write [view]", ""),
    // numbers out of range
    (6, "points = 0", 6, "body.rim.points (0) must be 1 or more", ""),
    (6, "points = 100001", 6, "body.rim.points (100001) must be at most 100000", ""),
    (6, "points = 100000", 5, "body: has 100001 points; at most 100000 are allowed", ""),
    (7, "radius_m = 0", 7, "body.rim.radius_m (0) must be greater than zero", ""),
    (7, "radius_m = -0.8", 7, "body.rim.radius_m (-0.8) must be greater than zero", ""),
    (8, "height_m = inf", 8, "body.rim.height_m (inf) must be a finite number", ""),
    (9, "point_mass_kg = -0.1", 9, "body.rim.point_mass_kg (-0.1) must be greater than zero", ""),
    (9, "point_mass_kg = nan", 9, "body.rim.point_mass_kg (nan) must be a finite number", ""),
    (12, "at_m = [0, 0, nan]", 12, "body.point.0.at_m", "each must be a finite number"),
    (12, "at_m = [0, -inf, 0]", 12, "body.point.0.at_m", "each must be a finite number"),
    (13, "mass_kg = -1e-300", 13, "body.point.0.mass_kg", "must not be negative"),
    (15, "tilt_deg = nan", 15, "start.tilt_deg (nan) must be a finite number", ""),
    (16, "momentum_Js = [0, 0, inf]", 16, "start.momentum_Js", "each must be a finite number"),
    (16, "momentum_Js = [0, 0, 1e200]", 14, "start", "range of floating-point numbers"),
    (19, "gravity_m_per_s2 = -inf", 19, "motion.gravity_m_per_s2 (-inf) must be a finite number", ""),
    (21, "time_step_s = 0", 21, "motion.time_step_s (0) must be greater than zero", ""),
    (21, "time_step_s = -0.1", 21, "motion.time_step_s (-0.1) must be greater than zero", ""),
    (21, "time_step_s = nan", 21, "motion.time_step_s (nan) must be a finite number", ""),
    (21, "time_step_s = 1e999", 21, "TOML parse error", "overflow"),
    (22, "steps = 0", 22, "motion.steps (0) must be 1 or more", ""),
    (22, "steps = -1", 22, "motion.steps (-1) must be 1 or more", ""),
    (25, "force_N = [nan, 0, 0]", 25, "push.0.force_N", "each must be a finite number"),
    (26, "first_step = 0", 26, "push.0.first_step (0) must be 1 or more", ""),
    (27, "steps = 0", 27, "push.0.steps (0) must be 1 or more", ""),
    (30, "speed = 0", 30, "view.speed (0) must be greater than zero", ""),
    (30, "window_s = -1", 30, "view.window_s (-1) must be greater than zero", ""),
    (30, "detail_s = 0", 30, "view.detail_s (0) must be greater than zero", ""),
    (30, "detail_of = \"w\"", 30, "view.detail_of (\"w\") must be one of", "tilt"),
    (30, "z_range_m = [1, 1]", 30, "view.z_range_m", "the lower one first"),
    (30, "show = \"x\"", 30, "view.show (\"x\") must be a list", "not text"),
    (30, "hide = [\"x\"]", 30, "view.hide ([\"x\"]) each must be one of", "health"),
    (30, "fill = \"x\"", 30, "view.fill (\"x\") must be one of", "none"),
    (30, "phase = 0", 30, "view.phase (0) must be 1 or more", ""),
    (30, "phase = \"torqe\"", 30, "view.phase (\"torqe\") must be one of", "did you mean torque?"),
    (30, "sum_to = \"some\"", 30, "view.sum_to (\"some\") must be all", "or a whole number from 1 to 100000"),
    (30, "camera = { pitch_deg = 91 }", 30, "view.camera.pitch_deg (91) must be from -90 to 90", ""),
    (30, "zoom = { above = 0 }", 30, "view.zoom.above (0) must be from 0.5 to 100", ""),
    (30, "zoom = { 3d = 101 }", 30, "view.zoom.3d (101) must be from 0.5 to 100", ""),
    (34, "at_step = -1", 34, "expected.0.at_step (-1) must be 0 or more", ""),
    (35, "value = nan", 35, "expected.0.value (nan) must be a finite number", ""),
    (36, "tolerance = -1", 36, "expected.0.tolerance (-1) must not be negative", ""),
    (38, "step = -1", 38, "edit.0.step (-1) must be 0 or more", ""),
    // text
    (1, "title = \"\"", 1, "title (\"\") must not be empty", ""),
    (1, "title = \"  \"", 1, "title", "must not be empty"),
    (1, "title = \"a\\nb\"", 1, "title", "(here U+000A)"),
    (1, "title = \"a\\u001b[31m\"", 1, "title", "(here U+001B)"),
    (1, "title = \"a\\u0085b\"", 1, "title", "(here U+0085)"),
    (1, "title = \"a\u{202e}b\"", 1, "title", "(here U+202E)"),
    (2, "about = \"a\\tb\"", 2, "about", "(here U+0009)"),
    (2, "about = \"a\u{2066}b\"", 2, "about", "(here U+2066)"),
    (3, "source = \"a\\rb\"", 3, "source", "(here U+000D)"),
    (3, "source = \"a\u{200f}b\"", 3, "source", "(here U+200F)"),
    (11, "name = \"to\u{200e}p\"", 11, "body.point.0.name", "(here U+200E)"),
    (11, "name = \"\"", 11, "body.point.0.name", "must not be empty"),
    (24, "point = \"top\\u0000\"", 24, "push.0.point", "(here U+0000)"),
    (31, "look_at = \"a\\nb\"", 31, "view.look_at", "(here U+000A)"),
    // rules for more than one value
    (4, "trace = \"tpo\"", 4, "trace (\"tpo\") is not a point of this body: did you mean top?", ""),
    (4, "trace = \"nose of the ship\"", 4, "trace (\"nose of the ship\") is not a point of this body: there is top", ""),
    (13, "[[body.point]]\nname = \"top\"\nat_m = [0, 0, 2]", 14, "body.point.1.name (\"top\") is also the name of another point", ""),
    (24, "point = \"Top\"", 24, "push.0.point (\"Top\") is not a point of this body: did you mean top?", ""),
    (24, "point = \"bow of the ship\"", 24, "push.0.point (\"bow of the ship\") is not a point of this body: there is top", ""),
    (7, "radius_m = 1e-9", 5, "body: singular inertia", "put mass off the axle"),
    (7, "radius_m = 1e200", 5, "body: the inertia about the pivot leaves the range of numbers", ""),
    (27, "", 23, "push.0: has no duration: add steps", ""),
    (27, "for_s = 3", 23, "push.0: has times in steps and in seconds", "keep first_step and steps, or from_s and for_s"),
    // friction
    (13, "[friction]\nspin_dry_Nm = -1", 14, "friction.spin_dry_Nm (-1) must not be negative", ""),
    (13, "[friction]\nspin_viscous_Nms = nan", 14, "friction.spin_viscous_Nms (nan) must be a finite number", ""),
    (13, "[friction]\nswing_viscous_Nms = 1e200", 14, "friction.swing_viscous_Nms (", "is too large for this body, whose smallest moment is"),
    (13, "[friction]\nspin_dry = 1", 14, "friction.spin_dry: unknown key", "spin_dry_Nm"),
    // parts
    (13, "[[body.part]]\nshape = \"egg\"", 14, "body.part.0.shape (\"egg\") must be one of ring, cylinder", ""),
    (13, "[[body.part]]\nmass_kg = -1", 14, "body.part.0.mass_kg (-1) must be greater than zero", ""),
    (13, "[[body.part]]\nat_m = [0, 0, inf]", 14, "body.part.0.at_m", "each must be a finite number"),
    (13, "[[body.part]]\nradius_m = 0", 14, "body.part.0.radius_m (0) must be greater than zero", ""),
    (13, "[[body.part]]\ninner_radius_m = -1", 14, "body.part.0.inner_radius_m (-1) must not be negative", ""),
    (13, "[[body.part]]\nouter_radius_m = 0", 14, "body.part.0.outer_radius_m (0) must be greater than zero", ""),
    (13, "[[body.part]]\nradius = 1", 14, "body.part.0.radius: unknown key", "did you mean radius_m?"),
    // starts with an angular velocity, and a rotor
    (17, "omega_rad_per_s = [0, 0, 1]", 17, "start.omega_rad_per_s ([0.0, 0.0, 1.0]) is given in addition to momentum_Js", "keep only one"),
    (17, "omega_frame = \"bdy\"", 17, "start.omega_frame (\"bdy\") must be one of world, body", ""),
    (13, "[[body.part]]\nabout = \"pvot\"", 14, "body.part.0.about (\"pvot\") must be one of center, pivot", "did you mean pivot?"),
    (17, "omega_frame = \"body\"", 17, "start.omega_frame: belongs to omega_rad_per_s, but momentum_Js is given", "remove it"),
    (17, "rotor = \"top\"", 17, "start.rotor (\"top\") is not a part of this body", "there is none"),
    // edits
    (38, "step = 41", 41, "edit.1.step (40) comes before the edit above it (step 41)", ""),
    (39, "set = { \"motion.time_step_s\" = 0 }", 39, "edit.0.set.motion.time_step_s (0) must be greater than zero", ""),
    (39, "set = { \"motion.time_step\" = 1 }", 39, "edit.0.set.motion.time_step", "did you mean motion.time_step_s?"),
    (39, "set = { motion.time_step_s = 1 }", 39, "edit.0.set.motion", "in quotes"),
    (39, "set = { \"motion.steps\" = 5 }", 39, "edit.0.set.motion.steps", "cannot be edited during a run"),
    (39, "set = { \"start.tilt_deg\" = 5 }", 39, "edit.0.set.start.tilt_deg", "cannot be edited during a run"),
    (39, "set = { \"title\" = \"x\" }", 39, "edit.0.set.title", "cannot be edited during a run"),
    (39, "set = { \"motion.scheme\" = \"rk5\" }", 39, "edit.0.set.motion.scheme (\"rk5\") must be one of", ""),
    (39, "set = { \"motion.gravity_m_per_s2\" = nan }", 39, "edit.0.set.motion.gravity_m_per_s2 (nan) must be a finite number", ""),
    (39, "set = { \"push.1.force_N\" = [0, 0, 1] }", 39, "edit.0.set.push.1.point: is missing", ""),
    (39, "set = { \"push.2.force_N\" = [0, 0, 1] }", 39, "edit.0.set.push.2.force_N: leads past the end", "1 element"),
    (39, "set = { \"push.x.force_N\" = [0, 0, 1] }", 39, "edit.0.set.push.x.force_N", "a number from 0"),
    (39, "set = { \"push.0.point\" = \"hub\" }", 39, "edit.0.set.push.0.point (\"hub\") is not a point of this body", ""),
    (39, "set = { \"push.0.first_step\" = 0 }", 39, "edit.0.set.push.0.first_step (0) must be 1 or more", ""),
    (39, "set = { \"push.0.a.a.a.a.a.a.a.a\" = 0 }", 39, "edit.0.set.push.0.a.a", "is too deep: a key has"),
];

fn check_refusal(text: &str, line: usize, begin: &str, words: &str) -> Result<(), String> {
    let message = refusal(text);
    let place = match line {
        0 => "file.toml: ".to_owned(),
        line => format!("file.toml:{line}: "),
    };
    // The expected problem need not be the first of several.
    let named = message
        .lines()
        .any(|one| one.starts_with(&format!("{place}{begin}")));
    let steering = message.chars().any(|c| c != '\n' && is_steering(c));
    if named && message.contains(words) && !steering {
        Ok(())
    } else {
        Err(format!(
            "expected \"{place}{begin}...{words}\", got:\n{message}\n"
        ))
    }
}

#[test]
fn the_reference_file_is_valid() {
    let good = |text: &str| {
        Document::parse("file.toml", text)
            .and_then(|document| document.scenario())
            .map(|_| ())
    };
    assert_eq!(good(WHOLE), Ok(()));
    assert_eq!(good(&seconds()), Ok(()));
    assert!(TABLE.len() >= 70);
}

fn seconds() -> String {
    WHOLE.replace("first_step = 1\nsteps = 20\naccumulates = true\n", SECONDS)
}

#[test]
fn every_error_names_line_key_and_rule() {
    let mut wrong = Vec::new();
    for &(at, new, line, begin, words) in TABLE {
        if let Err(text) = check_refusal(&with_line(WHOLE, at, new), line, begin, words) {
            wrong.push(format!("line {at} = {new:?}: {text}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn mistakes_in_pushes_in_seconds_are_reported() {
    #[rustfmt::skip]
    let table: &[(usize, &str, usize, &str)] = &[
        (26, "from_s = -1", 26, "push.0.from_s (-1) must not be negative"),
        (26, "from_s = nan", 26, "push.0.from_s (nan) must be a finite number"),
        (26, "from_s = \"0\"", 26, "push.0.from_s (\"0\") must be a number, not text"),
        (27, "for_s = 0", 27, "push.0.for_s (0) must be greater than zero"),
        (27, "for_s = inf", 27, "push.0.for_s (inf) must be a finite number"),
        (27, "for_s = true", 27, "push.0.for_s (true) must be a number"),
        (27, "", 23, "push.0: has no duration: add for_s"),
        (27, "for_s = 2\nsteps = 3", 23, "push.0: has times in steps and in seconds"),
        (27, "for_s = 2\naccumulates = true", 23, "push.0: accumulates step by step"),
    ];
    for &(at, new, line, begin) in table {
        check_refusal(&with_line(&seconds(), at, new), line, begin, "").unwrap();
    }
}

/// No key accepts a date.
#[test]
fn every_key_rejects_a_value_of_another_type() {
    for row in KEYS {
        let key = row.path.replace('*', "0");
        let mut table: Table = WHOLE.parse().unwrap();
        let date = "1979-05-27".parse().map(Value::Datetime).unwrap();
        set_key(&mut table, &key, date).unwrap();
        let problems = keys::check(&table).list;
        let is_refused = |problem: &Problem| problem.key == key && problem.rule.ends_with("a date");
        assert!(problems.iter().any(is_refused), "{key}: {problems:?}");
    }
}

#[test]
fn without_top_the_farthest_point_is_traced() {
    const RIM: &str = "title = 'x'\n[start]\nmomentum_Js = [0, 0, 1]\n[motion]\ntime_step_s = 0.1\nsteps = 3\n\
                       [body.rim]\npoints = 5\nradius_m = 1\nheight_m = 1\npoint_mass_kg = 1\n";
    let traced = |points: &str| {
        let document = Document::parse("x.toml", &format!("{RIM}{points}")).unwrap();
        let scenario = document.scenario().unwrap();
        (scenario.traced_name().to_owned(), scenario.arm_m())
    };
    let point =
        |name: &str, z: f64| format!("[[body.point]]\nname = '{name}'\nat_m = [0, 0, {z}]\n");
    let hub = point("hub", 0.5);
    assert_eq!(
        traced(&(hub.clone() + &point("tip", -0.75))),
        ("tip".to_owned(), 0.75)
    );
    assert_eq!(
        traced(&(hub.clone() + &point("top", 0.25))),
        ("top".to_owned(), 0.25)
    );
    // Of equally distant points, the first is traced. A point at the pivot has no path.
    assert_eq!(
        traced(&(hub + &point("other", -0.5))),
        ("hub".to_owned(), 0.5)
    );
    for none in [String::new(), point("pivot", 0.0)] {
        assert!((traced(&none).1 - 2_f64.sqrt()).abs() < 1e-12);
    }
}

#[test]
fn missing_tables_of_a_scenario_are_reported() {
    check_refusal("", 0, "start: is missing", "[start]").unwrap();
    check_refusal("", 0, "motion: is missing", "at the end of the file").unwrap();
    check_refusal("", 0, "title: is missing", "name of the scenario").unwrap();
    check_refusal("# nothing\n\n", 0, "title: is missing", "").unwrap();
    let bare =
        "title = 'x'\n[start]\nmomentum_Js = [0, 0, 1]\n[motion]\ntime_step_s = 0.1\nsteps = 3\n";
    check_refusal(bare, 0, "body: ", "singular inertia").unwrap();
    // All mass is on one line, but not on the axle.
    let line = format!(
        "{bare}[[body.point]]\nname = 'top'\nat_m = [1, 2, 3]\nmass_kg = 1\n[[body.point]]\nname = 'hub'\nat_m = [-2, -4, -6]\nmass_kg = 1\n"
    );
    check_refusal(&line, 7, "body: ", "singular inertia").unwrap();
}

#[test]
fn line_numbers_are_right_with_crlf_and_a_byte_order_mark() {
    let broken = with_line(WHOLE, 21, "time_step_s = 0");
    let rule = "motion.time_step_s (0) must be greater than zero";
    let of_windows = broken.replace('\n', "\r\n");
    for text in [&broken, &of_windows] {
        check_refusal(text, 21, rule, "").unwrap();
        check_refusal(&format!("\u{feff}{text}"), 21, rule, "").unwrap();
    }
}

#[test]
fn all_problems_are_reported_in_file_order() {
    let message = mistakes(&[
        (21, "time_step_s = 0"),
        (6, "points = 0"),
        (30, "speed = -1"),
    ]);
    let lines = message.lines().map(|line| line.split(' ').next().unwrap());
    let places = ["file.toml:6:", "file.toml:21:", "file.toml:30:"];
    assert!(lines.eq(places), "{message}");
}

/// Long, deep or numerous mistakes get a short message in reasonable time.
#[test]
fn huge_invalid_files_get_short_messages() {
    let points = |row: &str| WHOLE.to_owned() + &format!("[[body.point]]\n{row}\n").repeat(50_000);
    let named = |count: usize| {
        (0..count)
            .map(|n| format!("[[body.point]]\nname = \"p{n}\"\nat_m = [0, 0, 1]\n"))
            .collect::<String>()
    };
    let deep = ["a"; 50_000].join(".");
    let long = "t".repeat(3_000_000);
    let texts = [
        format!("{} = 1\n{WHOLE}", "k".repeat(3_000_000)),
        format!("{deep} = 1\n{WHOLE}"),
        format!("x = {}{}\n{WHOLE}", "[".repeat(50_000), "]".repeat(50_000)),
        format!("x = {}\n{WHOLE}", "{a=".repeat(50_000)),
        format!("x {}\n{WHOLE}", "y ".repeat(1_000_000)),
        with_line(WHOLE, 1, &format!("title = \"{long}\\u0000\"")),
        with_line(WHOLE, 4, &format!("trace = \"{long}\"")),
        with_line(WHOLE, 39, &format!("set = {{ \"push.0.{deep}\" = 1 }}")),
        with_line(WHOLE, 24, "point = \"none of these\"") + &named(50_000),
        points("name = \"p\"\nat_m = [0, 0, 1]"),
        points("colour = 1"),
        WHOLE.to_owned() + &named(100_001),
    ];
    for text in texts {
        let message = refusal(&text);
        let begin: String = message.chars().take(300).collect();
        assert!(message.len() < 2_000, "{} bytes: {begin}", message.len());
    }
}

fn read_refusal(path: &Path) -> String {
    match Document::read(path).and_then(|document| document.scenario()) {
        Ok(_) => panic!("accepted: {}", path.display()),
        Err(problems) => problems.to_string(),
    }
}

#[test]
fn files_that_are_not_scenarios_are_rejected() {
    let lab = tempfile::tempdir().unwrap();
    let header = with_line(WHOLE, 21, "time_step_s = 0")
        .trim_end()
        .replace('\n', "\n# ");
    let wrong = format!("# {header}\nstep,t_s,x_m\n");
    for (name, bytes, words) in [
        ("empty.toml", &b""[..], &["title: is missing"][..]),
        (
            "latin.toml",
            b"title = 'x'\nabout = 'caf\xe9'\n",
            &["latin.toml:2: ", "UTF-8"],
        ),
        (
            "binary.toml",
            b"\x7fELF\x02\x01\x01\0\0\0",
            &["binary.toml:1: "],
        ),
        (
            "utf16.toml",
            b"\xff\xfet\0i\0t\0l\0e\0",
            &["utf16.toml:1: ", "UTF-8"],
        ),
        (
            "latin.csv",
            b"# title = 'caf\xe9'\nstep,t_s,x_m\n",
            &["latin.csv:1: ", "UTF-8"],
        ),
        ("empty.csv", b"", &["is not the CSV of a run"]),
        (
            "other.csv",
            b"a,b,c\n1,2,3\n",
            &["is not the CSV of a run", "step,t_s,"],
        ),
        (
            "no-columns.csv",
            b"# title = 'x'\n0,0,0\n",
            &["is not the CSV of a run"],
        ),
        (
            "no-header.csv",
            b"step,t_s,x_m\n0,0,0\n",
            &["without a run file"],
        ),
        (
            "broken.csv",
            b"# title = 'x'\n# [motion\nstep,t_s,x_m\n",
            &["broken.csv:2: TOML parse error"],
        ),
        (
            "wrong.csv",
            wrong.as_bytes(),
            &["wrong.csv:21: motion.time_step_s (0)"],
        ),
    ] {
        let path = lab.path().join(name);
        fs::write(&path, bytes).unwrap();
        let told = read_refusal(&path);
        has(&told, name);
        has_all(&told, words);
    }
    has(read_refusal(lab.path()), "is a folder");
    let none = lab.path().join("none.toml");
    has(read_refusal(&none), "there is no such file");
    if Path::new("/dev/zero").exists() {
        let message = read_refusal(Path::new("/dev/zero"));
        assert!(message.contains("larger than 4 MB"), "{message}");
    }
}

fn set(arguments: &[&str]) -> Result<(), String> {
    let mut document = Document::parse("file.toml", WHOLE).unwrap();
    let mut arguments = arguments.iter();
    let set = arguments.try_for_each(|argument| document.set(argument));
    let scenario = set.and_then(|()| document.scenario());
    scenario
        .map(|_| ())
        .map_err(|problems| problems.to_string())
}

#[test]
fn invalid_settings_are_rejected() {
    #[rustfmt::skip]
    let table: &[(&str, &str)] = &[
        ("motion.time_step_s", "must be KEY=VALUE"),
        ("", "must be KEY=VALUE"),
        ("=5", "is not a dotted key"),
        (".=5", "is not a dotted key"),
        ("motion.=5", "is not a dotted key"),
        ("motion..steps=5", "is not a dotted key"),
        ("nonsense=5", "nonsense: unknown key: there is gyrolab"),
        ("motion.nonsense=5", "motion.nonsense: unknown key"),
        ("motion.time_step=5", "motion.time_step: unknown key: did you mean motion.time_step_s?"),
        ("dt=5", "dt: unknown key: did you mean motion.time_step_s?"),
        ("gravity=5", "gravity: unknown key: did you mean motion.gravity_m_per_s2?"),
        ("tilt=5", "tilt: unknown key: did you mean start.tilt_deg?"),
        ("moton.steps=5", "moton: unknown key: did you mean motion?"),
        ("motion.time_step_s=abc", "motion.time_step_s (\"abc\") must be a number, not text"),
        ("motion.time_step_s=", "motion.time_step_s (\"\") must be a number, not text"),
        ("motion.time_step_s=0.1=2", "motion.time_step_s (\"0.1=2\") must be a number, not text"),
        ("motion.time_step_s=nan", "must be a finite number"),
        ("motion.time_step_s=-1", "must be greater than zero"),
        ("motion.time_step_s=0,05", "must be a number, not text"),
        ("motion.time_step_s.x=1", "motion.time_step_s (0.1) has no x"),
        ("motion.steps=1e3", "must be a whole number"),
        ("motion.steps=5\nscheme=\"rk4\"", "must be a whole number, not text"),
        ("motion=5", "motion (5) must be a table"),
        ("motion.0=5", "motion.0: unknown key"),
        ("start.momentum_Js=[1,2]", "must be three numbers, not 2"),
        ("start.momentum_Js.3=1", "must be three numbers, not 4"),
        ("start.momentum_Js.4=1", "leads past the end: the array has 3 elements"),
        ("start.momentum_Js.-1=1", "a number from 0"),
        ("start.momentum_Js.x=1", "a number from 0"),
        ("start.momentum_Js.99999999999999999999999=1", "a number from 0"),
        ("start.momentum_Js.2=inf", "each must be a finite number"),
        ("push=5", "push (5) must be an array of tables"),
        ("push.0=5", "push.0 (5) must be a table"),
        ("push.1.force_N=[0,0,1]", "push.1.point: is missing"),
        ("push.7.force_N=[0,0,1]", "push.7: leads past the end: the array has 1 element"),
        ("push.x.force_N=[0,0,1]", "push.x: "),
        ("push.0.point=hub", "push.0.point (\"hub\") is not a point of this body"),
        ("push.0.from_s=3", "push.0: has times in steps and in seconds"),
        ("body.point.0.name=a\nb", "(here U+000A)"),
        ("title=\u{202e}", "(here U+202E)"),
        ("title=", "must not be empty"),
        ("body.rim.point_mass_kg=1e308", "range of numbers"),
        ("body.rim.radius_m=1e-9", "singular inertia"),
        ("a.a.a.a.a.a.a.a.a.a=1", "is too deep: a key has"),
    ];
    let mut wrong = Vec::new();
    for &(argument, words) in table {
        match set(&[argument]) {
            Ok(()) => wrong.push(format!("{argument:?}: not refused")),
            Err(message) => {
                let good = message.contains(words)
                    && message.contains("--set ")
                    && !message.chars().any(|c| c != '\n' && is_steering(c));
                if !good {
                    wrong.push(format!("{argument:?}: expected \"{words}\", got {message}"));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    let long = format!("{}b=1", "a.".repeat(60_000));
    assert!(set(&[&long]).unwrap_err().len() < 500);
}

#[test]
fn valid_settings_are_accepted() {
    for arguments in [
        &["motion.time_step_s=0.05"][..],
        &[" motion.time_step_s = 0.05 "],
        &["start.momentum_Js.2=500"],
        &["title=a = b"],
        &["title=\"quoted\""],
        &["about=\"two\\nlines\""],
        &["motion.scheme=rk4"],
        &["push=[]", "edit=[]"],
        &[
            "push.1.point=top",
            "push.1.force_N=[0,0,1]",
            "push.1.for_s=2",
        ],
        &["push.1={point=\"top\",force_N=[0,0,1],steps=2}"],
        &["motion.steps=0", "motion.steps=5"],
    ] {
        assert_eq!(set(arguments), Ok(()), "{arguments:?}");
    }
}

/// Wrong values, unknown keys and unknown names are reported together.
#[test]
fn all_kinds_of_mistakes_are_reported_together() {
    let value = (21, "time_step_s = -1");
    let told = mistakes(&[value, (24, "point = \"topp\""), (4, "trace = \"tpo\"")]);
    has_all(
        &told,
        [
            "file.toml:21: motion.time_step_s (-1) must be greater than zero",
            "file.toml:24: push.0.point (\"topp\") is not a point of this body: did you mean top?",
            "file.toml:4: trace (\"tpo\") is not a point of this body",
        ],
    );
    assert_eq!(told.lines().count(), 3, "{told}");
    // Two names; a name and a push without a time; a name and a start given twice.
    for (other, words) in [
        ((4, "trace = \"tpo\""), "trace"),
        ((27, ""), "push.0: has no duration"),
        ((15, "spin_rpm = 3"), "start.spin_rpm"),
    ] {
        let both = mistakes(&[(24, "point = \"topp\""), other]);
        has_all(&both, ["push.0.point", words]);
        assert_eq!(both.lines().count(), 2, "{both}");
    }
    // If the body is invalid, its points are unknown.
    let of_body = mistakes(&[(24, "point = \"topp\""), (6, "points = 0")]);
    assert!(!of_body.contains("topp"), "{of_body}");
}

/// Only the first hundred wrong names are reported, and a nearest name is searched only for them.
#[test]
fn thousands_of_wrong_names_are_reported_quickly() {
    let points: String = (0..2_500)
        .map(|index| format!("[[body.point]]\nname = \"p{index}\"\nat_m = [0, 0, 1]\n"))
        .collect();
    let push = "[[push]]\npoint = \"nobody\"\nforce_N = [0, 0, 1]\nsteps = 1\n";
    let text = format!("{WHOLE}{points}{}", push.repeat(9_000));
    for (wrong, others) in [("", 0), ("[friction]\nspin_dry_Nm = -1\n", 1)] {
        let document = Document::parse("file.toml", &format!("{text}{wrong}")).unwrap();
        let problems = document.scenario().unwrap_err();
        assert_eq!(problems.list.len(), 100);
        assert_eq!(problems.list.len() + problems.more, 9_000 + others);
    }
}
