//! The order of the rooms: no import leads upward, and the terminal's libraries are used in one room only.

use std::fs;
use std::path::{Path, PathBuf};

/// The rooms from the lowest to the highest: each may import those before it.
const ORDER: [&str; 23] = [
    "text", "cores", "origin", "physics", "scenario", "run", "journal", "analysis", "playback",
    "export", "data", "figure", "fit", "sweep", "verify", "own_code", "writeup", "storage", "lab",
    "lessons", "class", "tui", "cli",
];
/// The room of the terminal, and the libraries that only it may use.
const TERMINAL: &str = "tui";
const TERMINAL_LIBRARIES: [&str; 2] = ["ratatui", "crossterm"];

/// A source file of a room: its path from `src` on, its room, and its code without comments.
struct Source {
    path: String,
    room: String,
    code: String,
}

fn sources() -> Vec<Source> {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut files = Vec::new();
    collect(&src, &mut files);
    assert!(files.len() > 100, "only {} files found", files.len());
    let source = |file: &PathBuf| {
        let path = file.strip_prefix(&src).unwrap().display().to_string();
        let room = path.split('/').next().unwrap().trim_end_matches(".rs");
        Source {
            room: room.to_owned(),
            code: without_comments(&fs::read_to_string(file).unwrap()),
            path,
        }
    };
    files.iter().map(source).collect()
}

fn collect(folder: &Path, files: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            collect(&path, files);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            files.push(path);
        }
    }
}

/// `code` without the comments that run to the end of a line; no other kind is used here.
fn without_comments(code: &str) -> String {
    let kept = |line: &str| line.split("//").next().unwrap_or_default().to_owned() + "\n";
    code.lines().map(kept).collect()
}

/// Every place in `code` that names something of this crate, from the room's name on.
fn imports(code: &str) -> impl Iterator<Item = &str> {
    code.match_indices("crate::")
        .map(|(at, found)| &code[at + found.len()..])
}

#[test]
fn no_import_leads_upward() {
    let place = |room: &str| ORDER.iter().position(|name| *name == room);
    let mut upward = Vec::new();
    for source in sources() {
        if source.room == "physics" {
            continue; // a crate of its own, which knows no other room
        }
        let Some(here) = place(&source.room) else {
            assert!(
                ["lib", "main"].contains(&source.room.as_str()),
                "{}",
                source.path
            );
            continue;
        };
        for import in imports(&source.code) {
            let room = import
                .split(|c: char| !(c.is_alphanumeric() || c == '_'))
                .next();
            if place(room.unwrap_or_default()).is_none_or(|there| there > here) {
                let line = import.lines().next().unwrap_or_default();
                upward.push(format!("{} imports {line}", source.path));
            }
        }
    }
    assert!(upward.is_empty(), "{upward:#?}");
}

#[test]
fn only_one_room_knows_the_terminals_libraries() {
    let outside: Vec<_> = sources()
        .into_iter()
        .filter(|source| source.room != TERMINAL)
        .filter(|source| {
            TERMINAL_LIBRARIES
                .iter()
                .any(|name| source.code.contains(name))
        })
        .map(|source| source.path)
        .collect();
    assert!(outside.is_empty(), "{outside:?}");
}

#[test]
fn the_lab_itself_stands_in_two_files() {
    let own = sources()
        .into_iter()
        .filter(|source| source.code.contains("impl Lab {"))
        .map(|source| source.path);
    let mut own: Vec<_> = own.collect();
    own.sort_unstable();
    assert_eq!(
        own,
        ["lab/mod.rs", "lab/routing.rs"],
        "its parts do the rest"
    );
}
