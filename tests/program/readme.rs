//! The files and messages that the README shows are what the program takes and says.

use crate::support::ground::Ground;

/// The blocks of `kind` in the README, in order.
fn blocks(kind: &str) -> Vec<String> {
    let readme = include_str!("../../README.md");
    let begin = format!("```{kind}\n");
    let behind = readme.split(begin.as_str()).skip(1);
    behind
        .map(|rest| rest.split("```").next().unwrap().to_owned())
        .collect()
}

/// The only block of `kind` that holds `word`.
#[track_caller]
fn block(kind: &str, word: &str) -> String {
    let mut found = blocks(kind);
    found.retain(|block| block.contains(word));
    assert_eq!(found.len(), 1, "{word}: {found:?}");
    found.remove(0)
}

fn said(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

#[test]
fn the_file_of_commands_can_be_played_again() {
    let ground = Ground::new();
    ground.write("demo.toml", &block("toml", "[[do]]"));
    for _ in 0..2 {
        let shown = ground.run(&["show", "--do", "demo.toml"]);
        assert!(shown.status.success(), "{}", said(&shown.stderr));
        assert!(ground.file("run.csv").exists());
    }
}

#[test]
fn the_scenario_is_good_and_its_mistakes_are_told_as_shown() {
    let ground = Ground::new();
    let scenario = block("toml", "title = ");
    ground.write("my.toml", &scenario);
    let checked = ground.run(&["check", "my.toml"]);
    assert!(checked.status.success(), "{}", said(&checked.stderr));
    let wrong = scenario
        .replace("point_mass_kg = 0.5", "point_mass_kg = -0.1")
        .replace("tilt_deg = 45 ", "tilt = 45 ");
    ground.write("my.toml", &wrong);
    let told = said(&ground.run(&["check", "my.toml"]).stderr);
    let shown = block("text", "gyrolab check my.toml");
    assert_eq!(shown, format!("$ gyrolab check my.toml\n{told}"));
}

#[test]
fn the_steady_start_is_steady() {
    let ground = Ground::new();
    let scenario = block("toml", "title = ");
    let tables = block("toml", "steady = true");
    let (above, _) = scenario.split_once("[start]").unwrap();
    ground.write("my.toml", &(above.to_owned() + &tables));
    let run = ground.run(&["run", "my.toml", "--json"]);
    let json: serde_json::Value = serde_json::from_slice(&run.stdout).unwrap();
    for name in ["measured_lowest_tilt_deg", "measured_highest_tilt_deg"] {
        let tilt = json[name].as_f64().unwrap();
        assert!((tilt - 30.0).abs() < 1e-6, "{name}: {tilt}");
    }
    let health = json["health"].as_str().unwrap();
    assert!(health.starts_with("The numbers hold"), "{health}");
}

#[test]
fn the_settings_are_good_and_all_of_them_are_shown() {
    let ground = Ground::new();
    ground.write("config.toml", &block("toml", "marker = "));
    let read = gyrolab::storage::settings::read_config(&ground.file("config.toml"));
    assert_eq!(read.problems, None);
    let settings = read.settings;
    assert!(settings.marker.is_some() && settings.colour.is_some());
    assert!(settings.background.is_some() && settings.fps.is_some() && settings.mouse.is_some());
}
