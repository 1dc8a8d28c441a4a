//! Every shipped preset: it is complete, and it does what it says.

use crate::support::scenarios::preset as preset_named;
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
