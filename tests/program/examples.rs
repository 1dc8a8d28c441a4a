//! The examples in the help texts and the manual, executed as printed.

use crate::support::ground::{GYROLAB, Ground, stderr};
use std::os::unix::fs::symlink;

/// Words of example lines that are not executed, each with the reason.
const NOT_CARRIED_OUT: &[(&str, &str)] = &[
    ("gyrolab --resume", "needs a terminal and a session"),
    ("asciinema ", "another program"),
    ("demo.toml", "a file of the user's own"),
    ("lab.csv", "a file of the user's own"),
    ("fit.csv", "made from files of the user's own"),
    ("sweep.toml", "a file of the user's own, and a cluster"),
    ("--join part-*", "files that a cluster has made"),
    ("spin_rpm,friction.", "a fit that takes seconds"),
    (
        "start.spin_rpm=1000",
        "750 s of the exact motion with friction take half a second",
    ),
    (
        "gyrolab reproduce",
        "half a minute of computing; a test of its own does it",
    ),
    ("gyrolab verify report", "what that would have made"),
    ("gyrolab lesson is-the-wobble-real\n", "needs a terminal"),
    ("--rehearse", "needs a terminal"),
];

/// Returns the commands below "Examples:" in a help text, each with its continuation lines.
fn examples(help: &str) -> Vec<String> {
    let text = help.split("\nExamples:\n").nth(1).unwrap_or_default();
    assert!(!text.is_empty(), "{help}");
    let mut commands: Vec<String> = Vec::new();
    for line in text.lines() {
        assert!(line.starts_with("  "), "{line}");
        let line = &line[2..];
        match commands.last_mut() {
            Some(last) if last.ends_with("\\\n") => *last += &format!("{line}\n"),
            _ => commands.push(format!("{line}\n")),
        }
    }
    commands
}

/// Returns the commands of several words on their own lines in the topic `text`, with their continuation lines.
fn commands_of_topic(text: &str) -> Vec<String> {
    let mut commands: Vec<String> = Vec::new();
    let mut is_continued = false;
    for line in text.lines() {
        let command = line.trim_start();
        let is_prose = command.contains("runs it again") || command.contains(" lists them");
        // Words in capitals are placeholders.
        let is_whole = !command.split(' ').any(|word| {
            word.len() > 2 && word.chars().all(|c| c.is_uppercase() || ".".contains(c))
        });
        if is_continued {
            let last = commands.last_mut().unwrap();
            *last += &format!("{command}\n");
        } else if line.starts_with("  gyrolab ") || line.starts_with("    gyrolab ") {
            let ends =
                line.ends_with('\\') || line.starts_with("    ") || line.contains(" --schemes ");
            if ends && !is_prose && is_whole {
                commands.push(format!("{command}\n"));
            } else {
                continue;
            }
        } else {
            continue;
        }
        is_continued = line.ends_with('\\');
    }
    commands
}

/// Executes the commands one after the other in a new folder, in a shell that stops at the first failure.
#[track_caller]
fn carry_out(of: &str, commands: &[String]) -> usize {
    let ground = Ground::named("examples");
    let bin = ground.file("bin");
    std::fs::create_dir(&bin).unwrap();
    symlink(GYROLAB, bin.join("gyrolab")).unwrap();
    let script: String = commands
        .iter()
        .filter(|command| {
            !NOT_CARRIED_OUT
                .iter()
                .any(|(words, _)| command.contains(words))
        })
        .cloned()
        .collect();
    let script = format!("set -e\nPATH={}:$PATH HOME=$PWD\n{script}", bin.display());
    let output = ground.shell(&script);
    assert!(output.status.success(), "{of}:\n{script}{output:?}");
    let has_empty_rows = stderr(&output).contains("without readouts");
    assert!(!has_empty_rows, "{of}: {}", stderr(&output));
    script
        .lines()
        .filter(|line| line.starts_with("gyrolab "))
        .count()
}

#[test]
fn examples_in_every_help_work_as_printed() {
    let ground = Ground::new();
    let mut count = carry_out("gyrolab", &examples(&ground.stdout("--help")));
    for command in ground.subcommands() {
        let help = ground.stdout(&format!("{command} --help"));
        count += carry_out(&command, &examples(&help));
    }
    assert!(count > 45, "{count}");
}

#[test]
fn commands_in_manual_topics_work_as_printed() {
    let ground = Ground::new();
    let mut count = 0;
    for topic in ["fit", "schemes", "sweep"] {
        let text = ground.stdout(&format!("man {topic}"));
        count += carry_out(topic, &commands_of_topic(&text));
    }
    assert!(count >= 4, "{count}");
}
