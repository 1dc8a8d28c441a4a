//! Every shipped preset: it is complete, and it does what it says.

use crate::support::scenarios::preset as preset_named;
use gyrolab::analysis::health::{Advice, advise};
use gyrolab::analysis::{Monitor, Readouts};
use gyrolab::export::Column;
use gyrolab::run::Simulation;
use gyrolab::scenario::presets::PRESETS;
use std::collections::BTreeSet;
use std::path::Path;
use std::sync::Arc;

#[test]
fn the_table_of_presets_is_the_folder() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("presets");
    let files: BTreeSet<String> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| {
            entry
                .unwrap()
                .path()
                .file_stem()
                .unwrap()
                .to_str()
                .unwrap()
                .to_owned()
        })
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
            let value = column.value(&simulation.sample()).number();
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
    let scenario = preset_named(name, &[]);
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
    let push = preset_named("wobble-push", &[]);
    let Advice::TimeStep(step) = advise(&push) else {
        panic!("{:?}", advise(&push));
    };
    let note = format!("at dt = {step} it is gone");
    assert!(words("wobble-push").contains(&note), "{note}");
}
