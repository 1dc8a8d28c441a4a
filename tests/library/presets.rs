//! Every shipped preset is complete and behaves as described.

use crate::support::ground::names;
use crate::support::scenarios::preset as preset_named;
use gyrolab::engine::analysis::compare::compare;
use gyrolab::engine::analysis::health::{Advice, advise};
use gyrolab::engine::analysis::{Monitor, Readouts};
use gyrolab::engine::export::CsvColumn;
use gyrolab::engine::run::Simulation;
use gyrolab::engine::scenario::file::ExpectedFile;
use gyrolab::engine::scenario::presets::{PRESETS, Preset};
use gyrolab::engine::scenario::{Document, Scenario};
use std::collections::BTreeSet;
use std::f64::consts::TAU;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;

#[test]
fn every_preset_in_the_folder_is_in_the_table() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("presets");
    let files: BTreeSet<_> = names(&folder)
        .into_iter()
        .filter_map(|name| name.strip_suffix(".toml").map(str::to_owned))
        .collect();
    let table = PRESETS.iter().map(|preset| preset.name.to_owned());
    assert_eq!(
        files,
        table.collect(),
        "the folder and PRESETS in src/engine/scenario/presets.rs differ"
    );
}

#[test]
fn every_preset_describes_itself_and_what_to_look_at() {
    for preset in PRESETS {
        let file = preset_named(preset.name, &[]).file;
        let look_at = file.viewed_text("look_at");
        let lengths = [file.about.as_deref(), file.source.as_deref(), look_at]
            .map(|text| text.unwrap().len());
        let [about, source, hint] = lengths;
        assert!(about > 80 && source > 10, "{}", preset.name);
        assert!((21..=160).contains(&hint), "{}", preset.name);
        // Presets have expected values; users' files have none.
        assert!(expected_of(preset).len() >= 2, "{}", preset.name);
        assert!(file.expected.is_empty());
    }
}

/// Returns the expected values in the file of a preset.
fn expected_of(preset: &Preset) -> Vec<ExpectedFile> {
    let document = Document::parse(preset.name, preset.text).unwrap();
    document.scenario().unwrap().file.expected
}

#[test]
fn every_preset_meets_its_expected_values() {
    for preset in PRESETS {
        let scenario = preset_named(preset.name, &[]);
        let mut expected = expected_of(preset);
        expected.sort_by_key(|entry| entry.at_step);
        let mut simulation = Simulation::new(Arc::new(scenario));
        for entry in expected {
            simulation.step_to(entry.at_step).expect("finite numbers");
            let column = CsvColumn::find(&entry.readout).expect("a column");
            let value = column.value(simulation.scenario(), &simulation.sample());
            let off = (value - entry.value).abs();
            let name = preset.name;
            assert!(off <= entry.tolerance, "{name}: {value}, not {entry:?}");
        }
    }
}

/// Returns the readouts at the end of the preset `name`.
fn readouts(name: &str) -> Readouts {
    readouts_of(preset_named(name, &[]))
}

fn readouts_of(scenario: Scenario) -> Readouts {
    let mut simulation = Simulation::new(Arc::new(scenario));
    let mut monitor = Monitor::new(simulation.now());
    while simulation.step_number() < simulation.scenario().steps {
        simulation.step().unwrap();
        monitor.record(simulation.now());
    }
    let health = monitor.health(simulation.now());
    Readouts::new(&simulation, &mut monitor, &health, None)
}

/// Returns all texts of a preset as one text.
fn texts_of(name: &str) -> String {
    let file = preset_named(name, &[]).file;
    file.about.clone().unwrap() + file.viewed_text("look_at").unwrap()
}

/// Asserts that a text of the preset `name` contains `wanted` with `number` in place of a format such as `{:.2}`.
#[track_caller]
fn assert_number(name: &str, wanted: &str, number: f64) {
    let (before, rest) = wanted.split_once("{:.").unwrap();
    let (decimals, after) = rest.split_once('}').unwrap();
    let decimals: usize = decimals.parse().unwrap();
    let (text, words_here) = (
        texts_of(name),
        format!("{before}{number:.decimals$}{after}"),
    );
    assert!(
        contains_text(&text, &words_here),
        "{name}: no {words_here:?} in {text}"
    );
}

/// True if `text` contains `wanted`, regardless of line breaks.
fn contains_text(text: &str, wanted: &str) -> bool {
    text.replace('\n', " ").contains(wanted)
}

#[test]
fn the_search_for_numbers_detects_a_changed_digit() {
    let text = texts_of("wobble-push-accumulating");
    let (place, wanted) = (text.find("100 N at each").unwrap(), "grows by 100 N");
    assert!(contains_text(&text, wanted));
    for digit in 0..3 {
        let mut changed = text.clone();
        changed.replace_range(place + digit..=place + digit, "7");
        assert!(!contains_text(&changed, wanted), "{changed}");
    }
}

#[test]
fn numbers_in_the_texts_of_tops_match_their_runs() {
    let of = |name: &str| {
        let readouts = readouts(name);
        move |readout: &str| readouts.number(readout).unwrap()
    };
    const HIGHEST: &str = "measured_highest_tilt_deg";
    const PERIOD: &str = "predicted_nutation_period_s";
    const PRECESSION: &str = "predicted_precession_rad_per_s";
    const MEASURED: &str = "measured_precession_rad_per_s";
    let cusps = of("cusps");
    assert_number("cusps", "tilt 30 to {:.2} degrees", cusps(HIGHEST));
    assert_number("cusps", "one arch in {:.4} s", cusps(PERIOD));
    assert_number("loops", "tilt 30 to {:.2} degrees", of("loops")(HIGHEST));
    assert_number("waves", "tilt 30 to {:.2} degrees", of("waves")(HIGHEST));
    let falling = of("falling");
    assert_number(
        "falling",
        "From 10 degrees down to {:.2} and back",
        falling(HIGHEST),
    );
    assert_number("falling", "and back in {:.2} s", falling(PERIOD));
    let fast = of("fast-top");
    assert_number(
        "fast-top",
        "mgl/L3 = {:.3} rad/s",
        fast("fast_top_precession_rad_per_s"),
    );
    assert_number(
        "fast-top",
        "Precession of {:.1} degrees a second",
        fast(PRECESSION).to_degrees(),
    );
    let swing = fast("predicted_highest_tilt_deg") - fast("predicted_lowest_tilt_deg");
    assert_number("fast-top", "swings by {:.3} degrees", swing);
    let unstable = of("sleeping-unstable");
    assert_number(
        "sleeping-unstable",
        "is below {:.2}.",
        unstable("sleeping_limit_Js"),
    );
    assert_number(
        "sleeping-unstable",
        "it sinks to {:.0} and rises again",
        unstable(HIGHEST),
    );
    assert_number("sleeping-unstable", "every {:.1} s", unstable(PERIOD));
    assert_number(
        "sleeping-unstable",
        "then sinks to {:.2} degrees",
        unstable(HIGHEST),
    );
    let sleeping = of("sleeping");
    assert_number("sleeping", "L3 above {:.2}.", sleeping("sleeping_limit_Js"));
    assert_number("sleeping", "between 1 and {:.2} degrees", sleeping(HIGHEST));
    assert_number(
        "steady-slow",
        "circle at {:.4} rad/s",
        of("steady-slow")(MEASURED),
    );
    assert_number(
        "steady-fast",
        "one, at {:.3} rad/s",
        of("steady-fast")(MEASURED),
    );
    let free = of("torque-free");
    assert_number("torque-free", "|L|/I1 = {:.2} rad/s", free(MEASURED));
    assert_number("torque-free", "stays at {:.0} degrees", free(HIGHEST));
    let first = of("method-1");
    assert_number("method-1", "every {:.5} s", first(PERIOD));
    let faster = of("method-1-steeper")("turns_per_step") / first("turns_per_step");
    assert_number(
        "method-1-steeper",
        " {:.1} % faster",
        100.0 * (faster - 1.0),
    );
    let slow = of("method-2-slow");
    let turn_s = TAU / slow(PRECESSION);
    assert_number("method-2-slow", "a turn takes {:.0} s", turn_s);
    let thousands = turn_s / slow("time_step_s") / 1000.0;
    assert_number("method-2-slow", "is {:.0},000 of these", thousands);
    let turned = slow("t_s") * slow(PRECESSION).to_degrees();
    assert_number("method-2-slow", "its circle, {:.0} degrees", turned);
    let second = of("method-2");
    assert_number("method-2", "turns {:.2} times", second("turns_per_step"));
    assert_number("method-2", "one turn in {:.1} s", TAU / second(MEASURED));
    let literal = preset_named("wobble-push-accumulating", &[]);
    let [pushed] = &literal.file.push[..] else {
        panic!("{} pushes", literal.file.push.len());
    };
    let force_down = -pushed.force_N[2];
    let name = "wobble-push-accumulating";
    assert_number(name, "F(12,3) - {:.0} on a force array", force_down);
    assert_number(name, "grows by {:.0} N", force_down);
    let pushed_steps = pushed.steps.unwrap() as f64;
    assert_number(name, "at each of {:.0} steps", pushed_steps);
    assert_number(name, "its first {:.0} steps", literal.steps as f64);
    let push = of("wobble-push");
    let percent = |z: f64| 100.0 * (z / 0.8 - 1.0);
    assert_number(
        "wobble-push",
        "swings by {:.0} % down",
        -percent(push("measured_lowest_z_m")),
    );
    assert_number(
        "wobble-push",
        "and {:.0} % up",
        percent(push("measured_highest_z_m")),
    );
    let exact = readouts_of(preset_named("wobble-push", &["motion.scheme=exact"]));
    let [highest, lowest] = ["measured_highest_z_m", "measured_lowest_z_m"]
        .map(|measure| exact.number(measure).unwrap());
    assert_number(
        "wobble-push",
        "true one is {:.2} %",
        100.0 * (highest - lowest) / 0.8,
    );
}

/// Returns two turning points of the tilt of the preset `name`, s: the first of the initial kind after the start, and the
/// first of the other kind. Each comes from a parabola through the three rows around it.
fn turning_points_s(name: &str, set: &[&str]) -> Vec<f64> {
    let scenario = preset_named(name, set);
    let dt = scenario.motion.time_step_s;
    let steps = scenario.steps;
    let mut simulation = Simulation::new(Arc::new(scenario));
    let mut tilts = vec![simulation.sample().tilt_deg];
    for _ in 0..steps {
        simulation.step().unwrap();
        tilts.push(simulation.sample().tilt_deg);
    }
    let turns = tilts.windows(3).enumerate().filter_map(|(index, rows)| {
        let (before, after) = (rows[0] - rows[1], rows[2] - rows[1]);
        let offset = 0.5 * (before - after) / (before + after);
        (before * after > 0.0).then_some((index as f64 + 1.0 + offset) * dt)
    });
    turns.collect()
}

#[test]
fn numbers_in_the_texts_of_free_bodies_match_their_runs() {
    let nut = turning_points_s("wing-nut", &[]);
    assert_number("wing-nut", "turns over every {:.3} s", nut[0]);
    assert_number("wing-nut", "at once, every {:.3} s", nut[0]);
    let brick = turning_points_s("poinsot", &[]);
    assert_number("poinsot", "from L, once in {:.3} s", brick[1]);
    let of_brick = readouts("poinsot");
    let least = of_brick.number("measured_lowest_tilt_deg").unwrap();
    assert_number("poinsot", "between 40 and {:.2} degrees", least);
    let caught = readouts_of(preset_named("phone", &["motion.steps=500"]));
    let edge = caught.number("tilt_deg").unwrap();
    assert_number("phone", "screen at {:.2} degrees", edge);
    let pass = readouts("rugby-pass");
    // Without forces, the axle circles L at |L|/I1; theory states this rate about L.
    let about_momentum = pass.theory.unwrap().precession.unwrap();
    assert_number(
        "rugby-pass",
        "line of L once in {:.3} s",
        TAU / about_momentum,
    );
    let spin = pass.number("spin_rpm").unwrap() * TAU / 60.0;
    assert_number(
        "rugby-pass",
        "0.164 s, {:.2} times for each turn",
        about_momentum / spin,
    );
    let earth = readouts("earth");
    let rate = -earth.number("measured_precession_rad_per_s").unwrap();
    assert_number("earth", "backwards, once in {:.2} s", TAU / rate);
    assert_number(
        "earth",
        "stays at {:.3} degrees",
        earth.number("tilt_deg").unwrap(),
    );
    // A century of 36 525 days in a second.
    assert_number("earth", "it would last {:.0} millionths", 1e6 / 36525.0);
}

#[test]
fn numbers_in_the_other_texts_match_their_runs() {
    let swing = |name: &str| {
        let readouts = readouts(name);
        let number = |measure: &str| readouts.number(measure).unwrap();
        number("measured_highest_z_m") - number("measured_lowest_z_m")
    };
    let slow_mm = 1e3 * swing("method-2-slow");
    assert_number("method-2-slow", "z swings by {:.1} mm", slow_mm);
    let percent = 100.0 * swing("method-2") / 0.8;
    assert_number("method-2", "makes z swing by {:.1} %", percent);
    let fast = readouts("steady-fast");
    let rate = |name: &str| fast.number(name).unwrap();
    let ratio = rate("fast_precession_rad_per_s") / rate("slow_precession_rad_per_s");
    let ratio = format!("{ratio:.2} times round");
    assert!(texts_of("steady-fast").contains(&ratio), "{ratio}");
    let step = 0.002;
    let note = format!("with dt {step} s the top keeps its height");
    assert!(texts_of("wobble-push").contains(&note), "{note}");
    let push = preset_named("wobble-push", &[]);
    assert_eq!(advise(&push), Advice::TimeStep(step));
    let rows = compare(&push, &[push.motion.scheme], &[step], |_, _| {
        ControlFlow::Continue(())
    })
    .unwrap();
    assert!(rows[0].error_m.unwrap() < 0.002 * push.arm_m(), "{rows:?}");
}
