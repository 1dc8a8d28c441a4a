//! Every shipped preset: it is complete, and it does what it says.

use crate::support::scenarios::preset as preset_named;
use gyrolab::analysis::{Monitor, Readouts, Trial};
use gyrolab::export::Column;
use gyrolab::run::Simulation;
use gyrolab::run::resampled;
use gyrolab::scenario::Scenario;
use gyrolab::scenario::presets::PRESETS;
use std::collections::BTreeSet;
use std::f64::consts::TAU;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;

#[test]
fn the_table_of_presets_is_the_folder() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("presets");
    let files: BTreeSet<String> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| {
            path.extension()
                .is_some_and(|extension| extension == "toml")
        })
        .map(|path| path.file_stem().unwrap().to_str().unwrap().to_owned())
        .collect();
    assert_eq!(
        files,
        PRESETS
            .iter()
            .map(|preset| preset.name.to_owned())
            .collect()
    );
}

#[test]
fn every_preset_says_what_it_is_and_what_to_look_at() {
    for preset in PRESETS {
        let file = preset_named(preset.name, &[]).file;
        assert!(
            file.about.is_some_and(|about| about.len() > 80),
            "{}",
            preset.name
        );
        assert!(
            file.source.is_some_and(|source| source.len() > 10),
            "{}",
            preset.name
        );
        let look_at = file.view.and_then(|view| view.look_at);
        assert!(
            look_at.is_some_and(|line| line.len() > 20 && line.len() <= 160),
            "{}",
            preset.name
        );
        assert!(
            file.expected.len() >= 2,
            "{} has something to be held to",
            preset.name
        );
    }
}

#[test]
fn every_preset_does_what_it_expects() {
    for preset in PRESETS {
        let scenario = preset_named(preset.name, &[]);
        let mut expected = scenario.file.expected.clone();
        expected.sort_by_key(|entry| entry.at_step);
        let mut simulation = Simulation::new(Arc::new(scenario));
        for entry in expected {
            simulation.step_to(entry.at_step).expect("finite");
            let column = Column::find(&entry.readout).expect("a column");
            let value = column.value(simulation.scenario(), &simulation.sample());
            let off = (value - entry.value).abs();
            println!(
                "{} {} at step {}: off by {off:.1e}",
                preset.name, entry.readout, entry.at_step
            );
            assert!(
                off <= entry.tolerance,
                "{}: {} at step {} is {value}, not {} within {:e}",
                preset.name,
                entry.readout,
                entry.at_step,
                entry.value,
                entry.tolerance
            );
        }
    }
}

/// The readouts at the end of the preset `name`.
fn readouts(name: &str) -> Readouts {
    readouts_of(preset_named(name, &[]))
}

fn readouts_of(scenario: Scenario) -> Readouts {
    let mut simulation = Simulation::new(Arc::new(scenario));
    let mut monitor = Monitor::new(simulation.now());
    while simulation.step_number() < simulation.scenario().steps {
        simulation.step().unwrap();
        monitor.follow(simulation.now());
    }
    let health = monitor.health(simulation.now());
    Readouts::new(&simulation, &mut monitor, &health, None)
}

/// What a preset says of itself, in one text.
fn words(name: &str) -> String {
    let file = preset_named(name, &[]).file;
    file.about.unwrap() + &file.view.unwrap().look_at.unwrap()
}

/// A figure in a text of the preset `name`: `before` it, the number with so many decimals, and `after` it.
fn figure(name: &str, before: &str, number: f64, decimals: usize, after: &str) {
    let text = words(name);
    let wanted = format!("{before}{number:.decimals$}{after}");
    assert!(says(&text, &wanted), "{name}: no {wanted:?} in {text}");
}

/// Whether `wanted` stands in `text`, however its lines are broken.
fn says(text: &str, wanted: &str) -> bool {
    text.replace('\n', " ").contains(wanted)
}

#[test]
fn a_figure_that_is_changed_is_no_longer_found() {
    let text = words("wobble-push-accumulating");
    let (place, wanted) = (text.find("100 N at each").unwrap(), "grows by 100 N");
    assert!(says(&text, wanted));
    for digit in 0..3 {
        let mut changed = text.clone();
        changed.replace_range(place + digit..=place + digit, "7");
        assert!(!says(&changed, wanted), "{changed}");
    }
}

#[test]
fn every_figure_in_the_texts_is_that_of_the_run() {
    let of = |name: &str| {
        let readouts = readouts(name);
        move |readout: &str| readouts.number(readout).unwrap()
    };
    const HIGHEST: &str = "measured_highest_tilt_deg";
    const PERIOD: &str = "predicted_nutation_period_s";
    const PRECESSION: &str = "predicted_precession_rad_per_s";
    const MEASURED: &str = "measured_precession_rad_per_s";
    let cusps = of("cusps");
    figure("cusps", "tilt 30 to ", cusps(HIGHEST), 2, " degrees");
    figure("cusps", "one arch in ", cusps(PERIOD), 4, " s");
    figure("loops", "tilt 30 to ", of("loops")(HIGHEST), 2, " degrees");
    figure("waves", "tilt 30 to ", of("waves")(HIGHEST), 2, " degrees");
    let falling = of("falling");
    figure(
        "falling",
        "From 10 degrees down to ",
        falling(HIGHEST),
        2,
        " and back",
    );
    figure("falling", "and back in ", falling(PERIOD), 2, " s");
    let fast = of("fast-top");
    figure(
        "fast-top",
        "mgl/L3 = ",
        fast("fast_top_precession_rad_per_s"),
        3,
        " rad/s",
    );
    figure(
        "fast-top",
        "Precession of ",
        fast(PRECESSION).to_degrees(),
        1,
        " degrees a second",
    );
    let swing = fast("predicted_highest_tilt_deg") - fast("predicted_lowest_tilt_deg");
    figure("fast-top", "swings by ", swing, 3, " degrees");
    let unstable = of("sleeping-unstable");
    figure(
        "sleeping-unstable",
        "is below ",
        unstable("sleeping_limit_Js"),
        2,
        ".",
    );
    figure(
        "sleeping-unstable",
        "it sinks to ",
        unstable(HIGHEST),
        0,
        " and rises again",
    );
    figure("sleeping-unstable", "every ", unstable(PERIOD), 1, " s");
    figure(
        "sleeping-unstable",
        "then sinks to ",
        unstable(HIGHEST),
        2,
        " degrees",
    );
    let sleeping = of("sleeping");
    figure(
        "sleeping",
        "L3 above ",
        sleeping("sleeping_limit_Js"),
        2,
        ".",
    );
    figure(
        "sleeping",
        "between 1 and ",
        sleeping(HIGHEST),
        2,
        " degrees",
    );
    figure(
        "steady-slow",
        "circle at ",
        of("steady-slow")(MEASURED),
        4,
        " rad/s",
    );
    figure(
        "steady-fast",
        "one, at ",
        of("steady-fast")(MEASURED),
        3,
        " rad/s",
    );
    let free = of("torque-free");
    figure("torque-free", "|L|/I1 = ", free(MEASURED), 2, " rad/s");
    figure("torque-free", "fixed at ", free(HIGHEST), 0, " degrees");
    let first = of("method-1");
    figure("method-1", "every ", first(PERIOD), 5, " s");
    let faster = of("method-1-steeper")("turns_per_step") / first("turns_per_step");
    figure(
        "method-1-steeper",
        " ",
        100.0 * (faster - 1.0),
        1,
        " % faster",
    );
    let slow = of("method-2-slow");
    let turn_s = TAU / slow(PRECESSION);
    figure("method-2-slow", "a turn takes ", turn_s, 0, " s");
    let thousands = turn_s / slow("time_step_s") / 1000.0;
    figure("method-2-slow", "is ", thousands, 0, ",000 of these");
    let turned = slow("t_s") * slow(PRECESSION).to_degrees();
    figure("method-2-slow", "its circle, ", turned, 0, " degrees");
    let second = of("method-2");
    figure("method-2", "turns ", second("turns_per_step"), 2, " times");
    figure("method-2", "one turn in ", TAU / second(MEASURED), 1, " s");
    let literal = preset_named("wobble-push-accumulating", &[]);
    let [pushed] = &literal.file.push[..] else {
        panic!("{} pushes", literal.file.push.len());
    };
    let force_down = -pushed.force_N[2];
    let name = "wobble-push-accumulating";
    figure(name, "F(12,3) - ", force_down, 0, " on a force array");
    figure(name, "grows by ", force_down, 0, " N");
    let pushed_steps = pushed.steps.unwrap() as f64;
    figure(name, "at each of ", pushed_steps, 0, " steps");
    figure(name, "its first ", literal.steps as f64, 0, " steps");
    let push = of("wobble-push");
    let percent = |z: f64| 100.0 * (z / 0.8 - 1.0);
    figure(
        "wobble-push",
        "",
        -percent(push("measured_lowest_z_m")),
        0,
        " % lower",
    );
    figure(
        "wobble-push",
        "",
        percent(push("measured_highest_z_m")),
        0,
        " % higher",
    );
    let truth = readouts_of(preset_named("wobble-push", &["motion.scheme=exact"]));
    let truth = |name: &str| truth.number(name).unwrap();
    let swing = truth("measured_highest_z_m") - truth("measured_lowest_z_m");
    figure("wobble-push", "true one is ", 100.0 * swing / 0.8, 2, " %");
}

/// When the tilt of the preset `name` first comes back to a turning point of the kind it began at, and when it first
/// reaches the other kind, s: by a parabola through the three rows around each.
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
fn the_figures_of_the_free_bodies_are_those_of_their_runs() {
    let nut = turning_points_s("wing-nut", &[]);
    figure("wing-nut", "turns over every ", nut[0], 3, " s");
    figure("wing-nut", "all at once: every ", nut[0], 3, " s");
    let brick = turning_points_s("poinsot", &[]);
    figure("poinsot", "from L, once in ", brick[1], 3, " s");
    let brick = readouts("poinsot");
    let least = brick.number("measured_lowest_tilt_deg").unwrap();
    figure("poinsot", "between 40 and ", least, 2, " degrees");
    let caught = readouts_of(preset_named("phone", &["motion.steps=500"]));
    let edge = caught.number("tilt_deg").unwrap();
    figure("phone", "screen at ", edge, 2, " degrees");
    let pass = readouts("rugby-pass");
    // Free of forces the axle goes round L at |L|/I1, which theory gives about that axis.
    let about_momentum = pass.theory.unwrap().precession.unwrap();
    figure(
        "rugby-pass",
        "line of L once in ",
        TAU / about_momentum,
        3,
        " s",
    );
    let spin = pass.number("spin_rpm").unwrap() * TAU / 60.0;
    figure(
        "rugby-pass",
        "0.164 s, ",
        about_momentum / spin,
        2,
        " times for each turn",
    );
    let earth = readouts("earth");
    let rate = -earth.number("measured_precession_rad_per_s").unwrap();
    figure("earth", "backwards, once in ", TAU / rate, 2, " s");
    figure(
        "earth",
        "stays at ",
        earth.number("tilt_deg").unwrap(),
        3,
        " degrees",
    );
    // 36 525 days of a century in a second.
    figure("earth", "it would last ", 1e6 / 36525.0, 0, " millionths");
}

#[test]
fn the_figures_in_the_texts_are_those_of_the_runs() {
    let swing = |name: &str| {
        let readouts = readouts(name);
        let number = |name: &str| readouts.number(name).unwrap();
        number("measured_highest_z_m") - number("measured_lowest_z_m")
    };
    let slow = format!("z swings by {:.1e} m", swing("method-2-slow"));
    assert!(words("method-2-slow").contains(&slow), "{slow}");
    let percent = 100.0 * swing("method-2") / 0.8;
    let percent = format!("z swings by {percent:.1} %");
    assert!(words("method-2").contains(&percent), "{percent}");
    let fast = readouts("steady-fast");
    let rate = |name: &str| fast.number(name).unwrap();
    let ratio = rate("fast_precession_rad_per_s") / rate("slow_precession_rad_per_s");
    let ratio = format!("{ratio:.2} times round");
    assert!(words("steady-fast").contains(&ratio), "{ratio}");
    let step = 0.01;
    let note = format!("at dt = {step} it is gone");
    assert!(words("wobble-push").contains(&note), "{note}");
    let push = preset_named("wobble-push", &[]);
    let push = Arc::new(resampled(&push, step, push.motion.scheme));
    let trial = Trial::run(&push, |_| ControlFlow::Continue(())).unwrap();
    assert!(trial.most_distance_m < 0.002 * push.arm_m(), "{trial:?}");
}
