//! The files and messages in the README and the manual agree with the program.

use crate::support::ground::Ground;
use gyrolab::engine::scenario::schema::SchemaRow;
use gyrolab::lab::storage::settings;

/// Returns the code blocks of the language `kind` in the README, in order.
fn blocks(kind: &str) -> Vec<String> {
    let readme = include_str!("../../README.md");
    let begin = format!("```{kind}\n");
    let behind = readme.split(begin.as_str()).skip(1);
    behind
        .map(|rest| rest.split("```").next().unwrap().to_owned())
        .collect()
}

/// Returns the only code block of `kind` that contains `word`.
#[track_caller]
fn block(kind: &str, word: &str) -> String {
    let mut found = blocks(kind);
    found.retain(|block| block.contains(word));
    assert_eq!(found.len(), 1, "{word}: {found:?}");
    found.remove(0)
}

/// Returns the lines around `line` in the manual's `topic` that are indented like it.
#[track_caller]
fn example(topic: &str, line: &str) -> String {
    let ground = Ground::new();
    let manual = said(&ground.run(&format!("man {topic}")).stdout);
    let at = manual
        .lines()
        .position(|it| it.trim_start().starts_with(line));
    let lines: Vec<_> = manual.lines().collect();
    let at = at.unwrap_or_else(|| panic!("{topic} has no line {line}: {manual}"));
    let indent = lines[at].len() - lines[at].trim_start().len();
    assert!(indent > 0, "{line} is no example");
    let is_part = |text: &&&str| text.is_empty() || text.starts_with(&" ".repeat(indent));
    let above = lines[..at].iter().rev().take_while(is_part).count();
    let below = lines[at..].iter().take_while(is_part).count();
    let shown = &lines[at - above..at + below];
    shown
        .iter()
        .map(|text| text.get(indent..).unwrap_or_default().to_owned() + "\n")
        .collect()
}

fn said(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

#[test]
fn the_command_file_can_be_played_twice() {
    let ground = Ground::new();
    ground.write("demo.toml", &example("lab", "[[do]]"));
    for _ in 0..2 {
        let shown = ground.run("show --do demo.toml");
        assert!(shown.status.success(), "{}", said(&shown.stderr));
        assert!(ground.file("run.csv").exists());
    }
}

#[test]
fn the_scenario_is_valid_and_its_mistakes_are_reported_as_shown() {
    let ground = Ground::new();
    let scenario = block("toml", "title = ");
    ground.write("my.toml", &scenario);
    let checked = ground.run("check my.toml");
    assert!(checked.status.success(), "{}", said(&checked.stderr));
    let wrong = scenario
        .replace("point_mass_kg = 0.5", "point_mass_kg = -0.1")
        .replace("tilt_deg = 45 ", "tilt = 45 ");
    ground.write("with-mistakes.toml", &wrong);
    let told = said(&ground.run("check with-mistakes.toml").stderr);
    let shown = block("text", "gyrolab check with-mistakes.toml");
    assert_eq!(shown, format!("$ gyrolab check with-mistakes.toml\n{told}"));
}

/// Runs the command in the first line of the only block with `command`. Returns its output, and the output in the block.
fn printed_and_shown(command: &str) -> [String; 2] {
    let block = block("text", command);
    let (line, shown) = block.split_once('\n').unwrap();
    let args: Vec<_> = line.split_whitespace().skip(2).collect();
    let output = Ground::new().run(&args);
    assert!(output.status.success(), "{}", said(&output.stderr));
    [said(&output.stdout), shown.to_owned()]
}

#[test]
fn the_summary_is_printed_as_shown() {
    let texts = printed_and_shown("gyrolab run wobble-push");
    let [printed, shown] = texts.map(|text| {
        let lines = text.lines().filter(|line| !line.starts_with("  wall time"));
        lines.map(|line| format!("{line}\n")).collect::<String>()
    });
    assert_eq!(printed, shown);
}

#[test]
fn the_demonstration_can_be_recorded_to_its_end() {
    let ground = Ground::new();
    let demo = include_str!("../../presets/commands/demo.toml");
    ground.write("demo.toml", demo);
    let recorded = ground.run("cast demo.toml -o demo.cast");
    assert!(recorded.status.success(), "{}", said(&recorded.stderr));
    let cast = ground.read("demo.cast");
    let markers = cast.lines().filter(|line| line.contains("\"m\", ")).count();
    assert_eq!(markers, demo.matches("chapter = ").count());
}

/// The command below the picture at the top of the README draws it byte for byte.
#[test]
fn the_picture_equals_the_output_of_its_command() {
    let ground = Ground::new();
    let readme = include_str!("../../README.md");
    let command = readme
        .split("`gyrolab ")
        .nth(1)
        .unwrap()
        .split('`')
        .next()
        .unwrap();
    let args: Vec<_> = command.split_whitespace().collect();
    assert_eq!((args[0], args[args.len() - 1]), ("show", "wobble-push.svg"));
    let drawn = ground.run(&args);
    assert!(drawn.status.success(), "{}", said(&drawn.stderr));
    let shown = include_str!("../../presets/figures/wobble-push.svg");
    assert_eq!(ground.read("wobble-push.svg"), shown);
}

#[test]
fn the_example_of_a_steady_start_is_steady() {
    let ground = Ground::new();
    let scenario = block("toml", "title = ");
    let tables = example("scenario", "steady = true");
    let (above, _) = scenario.split_once("[start]").unwrap();
    ground.write("my.toml", &(above.to_owned() + &tables));
    let run = ground.run("run my.toml --json");
    let json: serde_json::Value = serde_json::from_slice(&run.stdout).unwrap();
    for name in ["measured_lowest_tilt_deg", "measured_highest_tilt_deg"] {
        let tilt = json[name].as_f64().unwrap();
        assert!((tilt - 30.0).abs() < 1e-6, "{name}: {tilt}");
    }
    let health = json["health"].as_str().unwrap();
    assert!(health.starts_with("The numbers are reliable"), "{health}");
}

#[test]
fn the_example_of_settings_is_valid_and_complete() {
    let ground = Ground::new();
    ground.write("config.toml", &example("lab", "marker = "));
    let read = settings::read_config(&ground.file("config.toml"));
    assert_eq!(read.problems, None);
    let is_shown = |row: &SchemaRow| read.settings.contains_key(row.path);
    assert!(settings::SETTINGS_KEYS.iter().all(is_shown));
}
