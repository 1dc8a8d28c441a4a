//! Recordings: `gyrolab cast`.

use crate::support::ground::{Ground, code, stderr};
use crate::support::words::has;
use serde_json::Value;
use std::fs;
use std::num::NonZero;

const DEMO: &str = r#"
[[do]]
open = "wobble-push"
[[do]]
chapter = "It falls"
[[do]]
speed = 4
[[do]]
run_until = "t_s >= 4"
[[do]]
chapter = "A \"push\""
[[do]]
push = true
[[do]]
run = true
[[do]]
wait_s = 1.5
[[do]]
export = "out.csv"
[[do]]
chapter = "The end"
[[do]]
wait_s = 0.5
"#;

/// Parses a recording into its header and its events, with their times since the start, ms.
fn parse_recording(text: &str) -> (Value, Vec<(u64, String, String)>) {
    let mut lines = text.lines();
    let head = serde_json::from_str(lines.next().unwrap()).unwrap();
    let mut now = 0;
    (
        head,
        lines
            .map(|line| {
                let event: (f64, String, String) = serde_json::from_str(line).unwrap();
                now += (event.0 * 1000.0).round() as u64;
                (now, event.1, event.2)
            })
            .collect(),
    )
}

fn record(ground: &Ground, name: &str, more: &[&str]) -> String {
    ground.write("demo.toml", DEMO);
    let args = [&["cast", "demo.toml", "-o", name], more].concat();
    let output = ground.run(&args);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    ground.read(name)
}

#[test]
fn a_recording_contains_size_chapters_and_picture() {
    let ground = Ground::new();
    let text = record(
        &ground,
        "a.cast",
        &["--size", "90x25", "--title", "A <b>\"demo\"\u{1b}"],
    );
    let (head, events) = parse_recording(&text);
    assert_eq!(head["version"], 3);
    assert_eq!(
        (&head["term"]["cols"], &head["term"]["rows"]),
        (&90.into(), &25.into())
    );
    assert_eq!(head["title"], "A <b>\"demo\"\\u{1b}");
    assert!(head.get("timestamp").is_none());

    let markers: Vec<_> = events.iter().filter(|event| event.1 == "m").collect();
    let titles: Vec<&str> = markers.iter().map(|event| event.2.as_str()).collect();
    assert_eq!(titles, ["It falls", "A \"push\"", "The end"]);
    let times: Vec<u64> = markers.iter().map(|event| event.0).collect();
    assert_eq!(times[0], 0);
    assert!(
        (950..=1200).contains(&times[1]),
        "4 s at four times the speed: {times:?}"
    );
    assert_eq!(times[2] - times[1], 1500);
    let (end, kind, status) = events.last().unwrap();
    assert_eq!(
        (*end - times[2], kind.as_str(), status.as_str()),
        (500, "x", "0")
    );

    let [rows, columns] = [25, 90].map(|n| NonZero::new(n).unwrap());
    let mut screen = vt100::Parser::new(rows, columns, 0);
    let mut seen = vec![];
    for (_, event, data) in &events {
        if event == "o" {
            screen.process(data.as_bytes());
            seen.push(screen.screen().contents());
        }
    }
    assert!(seen.len() > 20, "{}", seen.len());
    assert!(seen[0].contains("It falls"), "{}", seen[0]);
    assert!(
        seen.last().unwrap().contains("The end"),
        "{}",
        seen.last().unwrap()
    );
    assert!(
        (0..25)
            .flat_map(|row: u16| (0..90).map(move |column| (row, column)))
            .any(|(row, column)| {
                screen.screen().cell(row, column).unwrap().fgcolor() != vt100::Color::Default
            })
    );
    assert!(screen.screen().hide_cursor());
}

#[test]
fn recordings_do_not_depend_on_time_settings_or_environment() {
    let ground = Ground::new();
    let first = record(&ground, "a.cast", &[]);
    fs::remove_file(ground.file("out.csv")).unwrap();
    let config = ground.config().join("gyrolab/config.toml");
    fs::create_dir_all(config.parent().unwrap()).unwrap();
    fs::write(&config, "markers = \"ascii\"\ncolor = \"never\"\n").unwrap();
    let mut other = ground.command("cast demo.toml -o b.cast");
    other.envs([
        ("NO_COLOR", "1"),
        ("TERM", "dumb"),
        ("LANG", "C"),
        ("LC_ALL", "C"),
        ("COLUMNS", "20"),
        ("TZ", "Asia/Tokyo"),
    ]);
    assert!(other.output().unwrap().status.success());
    assert_eq!(ground.read("b.cast"), first);
}

#[test]
fn a_failed_recording_leaves_no_file() {
    let ground = Ground::new();
    for (commands, said) in [
        (
            "[[do]]\nstep = 3\n[[do]]\nundo = 1\n",
            "wrong.toml:3: undo: ",
        ),
        ("[[do]]\nchapter = 3\n", "do.0.chapter"),
        ("[[do]]\nchapter = \"two\\nlines\"\n", "do.0.chapter"),
        ("[[do]]\nwait_s = 5000\n", "longer than an hour"),
        ("", "contains no command"),
    ] {
        ground.write("wrong.toml", commands);
        let output = ground.run("cast wrong.toml -o x.cast");
        assert_eq!(code(&output), 1, "{commands}");
        assert!(stderr(&output).contains(said), "{}", stderr(&output));
        assert!(!ground.file("x.cast").exists());
    }
    ground.write("x.cast", "kept");
    ground.write("demo.toml", "[[do]]\nstep = 3\n");
    let refused = ground.run("cast demo.toml -o x.cast");
    assert_eq!(code(&refused), 1);
    has(stderr(&refused), "--force replaces it");
    assert_eq!(ground.read("x.cast"), "kept");
    assert_eq!(code(&ground.run("cast demo.toml -o x.cast --force")), 0);
    parse_recording(&ground.read("x.cast"));
}
