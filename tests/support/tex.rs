//! Checks TeX documents: by parsing, and by compiling if TeX is installed.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::Command;

/// Tolerance for lines wider than the page, pt.
const MOST_OVERFULL_PT: f64 = 15.0;

/// Checks the document `name` in `folder`: braces and environments are balanced, references and citations resolve, included
/// files exist, and pdflatex compiles it if installed.
#[track_caller]
pub fn check(folder: &Path, name: &str) {
    let text = fs::read_to_string(folder.join(name)).unwrap();
    check_braces(&text);
    check_environments(&text);
    let labels = arguments(&text, "\\label{");
    let unique: BTreeSet<_> = labels.iter().collect();
    assert_eq!(unique.len(), labels.len(), "labels are unique: {labels:?}");
    for label in arguments(&text, "\\ref{") {
        assert!(labels.contains(&label), "no label {label}");
    }
    for picture in text.lines().filter_map(picture) {
        assert!(folder.join(picture).is_file(), "no file {picture}");
    }
    for file in arguments(&text, "\\bibliography{") {
        let entries = fs::read_to_string(folder.join(format!("{file}.bib"))).unwrap();
        check_braces(&entries);
        for key in arguments(&text, "\\cite{") {
            assert!(entries.contains(&format!("{{{key},\n")), "no entry {key}");
        }
    }
    compile(folder, name);
}

/// Checks that unescaped braces are balanced.
#[track_caller]
fn check_braces(text: &str) {
    let (mut depth, mut is_escaped) = (0_i64, false);
    for c in text.chars() {
        match c {
            '{' if !is_escaped => depth += 1,
            '}' if !is_escaped => depth -= 1,
            _ => {}
        }
        is_escaped = c == '\\' && !is_escaped;
        assert!(depth >= 0, "a brace is closed that was not opened");
    }
    assert_eq!(depth, 0, "a brace is not closed");
}

#[track_caller]
fn check_environments(text: &str) {
    let mut open = Vec::new();
    for part in text.split('\\') {
        if let Some(name) = part.strip_prefix("begin{") {
            open.push(name.split('}').next().unwrap());
        } else if let Some(name) = part.strip_prefix("end{") {
            assert_eq!(open.pop(), name.split('}').next());
        }
    }
    assert!(open.is_empty(), "{open:?}");
}

/// Returns the arguments of a command, such as `\label{`.
fn arguments<'a>(text: &'a str, command: &str) -> Vec<&'a str> {
    let parts = text.split(command).skip(1);
    parts.map(|part| part.split('}').next().unwrap()).collect()
}

/// Returns the file that a line includes, if any.
fn picture(line: &str) -> Option<&str> {
    let options = line.split_once("\\includegraphics[")?.1;
    options.split_once("]{")?.1.split('}').next()
}

/// Compiles the document twice if TeX is installed. Asserts that no line is wider than the page.
#[track_caller]
fn compile(folder: &Path, name: &str) {
    let output = tempfile::tempdir().unwrap();
    for _ in 0..2 {
        let mut pdflatex = Command::new("pdflatex");
        pdflatex.args(["-interaction=nonstopmode", "-halt-on-error"]);
        pdflatex.arg("-output-directory").arg(output.path());
        let Ok(done) = pdflatex.arg(name).current_dir(folder).output() else {
            return; // no TeX
        };
        assert!(
            done.status.success(),
            "{}",
            String::from_utf8_lossy(&done.stdout)
        );
    }
    let log = output.path().join(name).with_extension("log");
    let log = String::from_utf8_lossy(&fs::read(log).unwrap()).into_owned();
    for line in log.lines().filter(|line| line.starts_with("Overfull")) {
        let width = line.split_once('(').unwrap().1.split("pt").next().unwrap();
        assert!(width.parse::<f64>().unwrap() < MOST_OVERFULL_PT, "{line}");
    }
}
