//! Single values of a scenario: listed, nudged, typed and changed.

use crate::support::scenarios::changed;
use crate::support::scenarios::{parse, preset};
use crate::support::words::{has, has_no};
use gyrolab::engine::journal::parameters::{Parameter, parameters, table_at, table_of};
use gyrolab::engine::scenario::Scenario;
use gyrolab::engine::scenario::file::ScenarioFile;
use gyrolab::engine::scenario::presets::PRESETS;
use toml::Value;

fn listed(scenario: &Scenario) -> Vec<Parameter> {
    parameters(&table_of(&scenario.file), scenario)
}

fn named(scenario: &Scenario, key: &str) -> Parameter {
    let mut list = listed(scenario).into_iter();
    list.find(|row| row.key == key)
        .unwrap_or_else(|| panic!("no {key}"))
}

fn keys(scenario: &Scenario, group: &str) -> Vec<String> {
    let rows = listed(scenario).into_iter();
    rows.filter(|row| row.group == group)
        .map(|row| row.key)
        .collect()
}

fn refusal(file: &ScenarioFile, key: &str, value: impl Into<Value>) -> String {
    changed(file, key, value.into()).unwrap_err().in_one_line()
}

const TWO_PUSHES: &str = "title = 'x'
[body.rim]
points = 4
radius_m = 1
height_m = 1
point_mass_kg = 1
[[body.point]]
name = 'top'
at_m = [0, 0, 2]
[[body.point]]
name = 'side'
at_m = [3, 0, 4]
[start]
momentum_Js = [0, 0, 60]
[motion]
time_step_s = 0.1
steps = 100
[[push]]
point = 'top'
force_N = [0, 3, 4]
steps = 5
[[push]]
point = 'side'
force_N = [0, 0, 0]
for_s = 2
";

#[test]
fn nudged_values_change_or_explain_why_not() {
    let mut nudged = 0;
    for preset in PRESETS {
        let scenario = self::preset(preset.name, &[]);
        for row in listed(&scenario) {
            for times in [1, -1, 10] {
                let case = format!("{} {}", preset.name, row.key);
                let value = match row.nudged(times) {
                    Ok(value) => value,
                    Err(why) => {
                        assert!(!why.is_empty(), "{case}");
                        continue;
                    }
                };
                match changed(&scenario.file, &row.key, value.clone()) {
                    Ok(other) => {
                        assert_eq!(named(&other, &row.key).value, value, "{case}");
                        nudged += 1;
                    }
                    Err(problems) => assert!(problems.in_one_line().len() > 10),
                }
            }
        }
    }
    assert!(nudged > 800, "{nudged}");
}

#[test]
fn shown_values_can_be_typed() {
    for preset in PRESETS {
        for row in listed(&self::preset(preset.name, &[])) {
            let shown = row.shown();
            assert!(!shown.contains('\n'), "{shown}");
            let case = format!("{} {}", preset.name, row.key);
            assert_eq!(row.typed(&shown), Ok(row.value.clone()), "{case}");
            if !row.unit().is_empty() {
                let with_unit = format!("{shown} {}", row.unit());
                assert_eq!(row.typed(&with_unit), Ok(row.value.clone()), "{case}");
            }
        }
    }
}

#[test]
fn every_value_of_a_file_is_listed_in_groups() {
    let scenario = parse(TWO_PUSHES);
    let rows = listed(&scenario);
    let mut groups: Vec<_> = rows.iter().map(|row| row.group.as_str()).collect();
    groups.dedup();
    let all =
        "scenario, body, point top, point side, start, motion, push 0, push 1, friction, view";
    assert_eq!(groups.join(", "), all);
    for (push, window) in [("0", "first_step steps accumulates"), ("1", "from_s for_s")] {
        let names = format!("point force_N.0 force_N.1 force_N.2 {window}");
        let of_push = names.split(' ').map(|key| format!("push.{push}.{key}"));
        let found = keys(&scenario, &format!("push {push}"));
        assert!(found.into_iter().eq(of_push));
    }
    let first = named(&scenario, "push.0.first_step");
    assert_eq!((first.value, first.is_default), (Value::Integer(1), true));
    assert_eq!(named(&scenario, "push.1.point").choices, ["top", "side"]);
    assert_eq!(named(&scenario, "body.point.1.at_m.0").label, "x");
}

#[test]
fn a_body_without_a_rim_has_no_rim_rows() {
    let rim = "[body.rim]\npoints = 4\nradius_m = 1\nheight_m = 1\npoint_mass_kg = 1\n";
    let rimless = TWO_PUSHES
        .replace(rim, "")
        .replace("at_m = [3, 0, 4]", "at_m = [3, 0, 4]\nmass_kg = 1")
        .replace("at_m = [0, 0, 2]", "at_m = [0, 1, 2]\nmass_kg = 1");
    assert_eq!(keys(&parse(&rimless), "body"), Vec::<String>::new());
}

#[test]
fn nudges_scale_with_the_value() {
    let scenario = parse(TWO_PUSHES);
    let next = |key: &str, times| named(&scenario, key).nudged(times);
    assert_eq!(next("push.0.force_N.0", 1), Ok(Value::Float(0.05))); // norm 5
    assert_eq!(next("push.1.force_N.0", -1), Ok(Value::Float(-1.0))); // norm 0
    assert_eq!(next("start.momentum_Js.2", 10), Ok(Value::Float(65.0)));
    assert_eq!(next("start.tilt_deg", -1), Ok(Value::Float(-1.0)));
    assert_eq!(next("motion.gravity_m_per_s2", 2), Ok(Value::Float(10.0)));
    assert_eq!(next("motion.time_step_s", 1), Ok(Value::Float(0.2)));
    assert_eq!(next("motion.steps", 1), Ok(Value::Integer(101)));
    assert_eq!(
        next("push.0.first_step", -1),
        Err("must be 1 or more".to_owned())
    );
    assert_eq!(next("motion.scheme", -1), Ok(Value::from("exact")));
    assert_eq!(next("push.1.point", 1), Ok(Value::from("top")));
    assert_eq!(next("push.0.accumulates", 1), Ok(Value::from(true)));
    assert_eq!(next("title", 1), Err("is text: type it".to_owned()));
}

#[test]
fn typed_values_are_checked_against_their_rule() {
    let scenario = parse(TWO_PUSHES);
    let typed = |key: &str, text| named(&scenario, key).typed(text);
    assert_eq!(
        typed("motion.time_step_s", "0.05 s"),
        Ok(Value::Float(0.05))
    );
    assert_eq!(typed("motion.steps", "2e3"), Ok(Value::Integer(2000)));
    assert_eq!(typed("push.0.accumulates", "yes"), Ok(Value::Boolean(true)));
    let refused = |key: &str, text| typed(key, text).unwrap_err();
    for (key, text, rule) in [
        ("motion.time_step_s", "-0.1", "must be greater than zero"),
        ("motion.time_step_s", "nan", "must be a finite number"),
        ("motion.time_step_s", "1 kg", "is in s, not in \"kg\""),
        ("motion.steps", "0", "must be 1 or more"),
        ("motion.steps", "1.5", "must be a whole number"),
        ("title", " ", "must not be empty"),
    ] {
        assert_eq!(refused(key, text), rule, "{key} {text}");
    }
    has(refused("motion.scheme", "rk5"), "did you mean rk4?");
    has(refused("title", "a\u{1b}b"), "control");
}

#[test]
fn a_rejected_change_is_reported_in_one_line() {
    let file = parse(TWO_PUSHES).file;
    assert_eq!(
        refusal(&file, "motion.time_step_s", -0.1),
        "motion.time_step_s (-0.1) must be greater than zero"
    );
    assert_eq!(
        refusal(&file, "trace", "tip"),
        "trace (\"tip\") is not a point of this body: did you mean top?"
    );
    for (key, value) in [
        ("body.rim.radius_m", Value::from("x")),
        ("motion.stepz", Value::from(1)),
        ("motion.steps.3", Value::from(1)),
    ] {
        let line = refusal(&file, key, value);
        assert!(line.starts_with(key.trim_end_matches(".3")), "{line}");
        for words in ["--set", "line ", "\n"] {
            has_no(&line, words);
        }
    }
}

#[test]
fn the_values_of_a_run_include_its_edits() {
    let text = format!(
        "{TWO_PUSHES}[[edit]]\nstep = 7\nset = {{ 'motion.time_step_s' = 0.02, 'push.1.for_s' = 9 }}\n"
    );
    let run = parse(&text);
    let at = |step, key: &str| {
        let mut rows = parameters(&table_at(&run, step), &run).into_iter();
        rows.find(|row| row.key == key).map(|row| row.value)
    };
    assert_eq!(at(6, "motion.time_step_s"), Some(Value::Float(0.1)));
    assert_eq!(at(7, "motion.time_step_s"), Some(Value::Float(0.02)));
    assert_eq!(at(7, "push.1.for_s"), Some(Value::Float(9.0)));
}

#[test]
fn only_the_first_fifty_points_are_listed() {
    let points: String = (0..120)
        .map(|index| {
            format!("[[body.point]]\nname = 'p{index}'\nat_m = [0, {index}, 1]\nmass_kg = 1\n")
        })
        .collect();
    let text = format!(
        "title = 'x'\ntrace = 'p99'\n{points}[start]\nmomentum_Js = [0, 0, 1]\n[motion]\ntime_step_s = 0.1\nsteps = 1\n"
    );
    let scenario = parse(&text);
    assert_eq!(
        listed(&scenario)
            .iter()
            .filter(|row| row.key.ends_with(".name"))
            .count(),
        50
    );
    let trace = named(&scenario, "trace");
    assert_eq!(trace.nudged(1), Ok(Value::from("p0")));
    assert_eq!(trace.nudged(-1), Ok(Value::from("p49")));
    assert_eq!(trace.typed("p70"), Ok(Value::from("p70")));
    let whole = toml::Table::try_from(&scenario.file).unwrap();
    assert_eq!(parameters(&whole, &scenario).len(), listed(&scenario).len());
}
