//! Completion of the dotted keys of a scenario, and of what they may hold.

use super::{behind_comma, candidate};
use crate::cli::new_lab::DEFAULT;
use crate::scenario::Document;
use crate::scenario::keys::{Effect, KEYS, Key, Kind};
use clap_complete::engine::CompletionCandidate;
use std::ffi::OsStr;

/// `--set`: a key, and behind `=` what it may hold.
pub(super) fn settings(current: &OsStr) -> Vec<CompletionCandidate> {
    let text = current.to_string_lossy();
    match text.split_once('=') {
        None => keys(&text),
        Some((key, begin)) => values(key, "", begin),
    }
}

/// `--vary`: the same, with several values.
pub(super) fn varied(current: &OsStr) -> Vec<CompletionCandidate> {
    let text = current.to_string_lossy();
    match text.split_once('=') {
        None => keys(&text),
        Some((key, list)) => {
            let (typed, begin) = behind_comma(list);
            values(key, typed, begin)
        }
    }
}

/// `--free`: keys that hold a number, behind those that are typed with commas between them; of vectors each number.
pub(super) fn free_keys(current: &OsStr) -> Vec<CompletionCandidate> {
    let text = current.to_string_lossy();
    let (typed, begin) = behind_comma(&text);
    let mut found = Vec::new();
    for key in scenario_keys().filter(|key| Effect::of(key.path) != Effect::None) {
        let path = instance(key.path, begin);
        let names = match key.kind {
            Kind::Number(_) => vec![path],
            Kind::Vector => elements(&path).to_vec(),
            _ => Vec::new(),
        };
        let fitting = names.iter().filter(|name| name.starts_with(begin));
        found.extend(fitting.map(|name| candidate(&format!("{typed}{name}"), key.about)));
    }
    found
}

fn scenario_keys() -> impl Iterator<Item = &'static Key> {
    KEYS.iter().filter(|key| !key.path.starts_with("edit."))
}

/// The key `path` with a number for each `*`: the one that stands there in `typed`, or else 0.
fn instance(path: &str, typed: &str) -> String {
    let mut typed = typed.split('.');
    let part = |part| {
        let number = typed.next().filter(|typed| is_number(typed));
        if part == "*" {
            number.unwrap_or("0")
        } else {
            part
        }
    };
    path.split('.').map(part).collect::<Vec<_>>().join(".")
}

fn is_number(part: &str) -> bool {
    part.parse::<usize>().is_ok()
}

/// The three numbers of the vector `path`.
fn elements(path: &str) -> [String; 3] {
    [0, 1, 2].map(|place| format!("{path}.{place}"))
}

/// Dotted keys that begin as `begin` does, each with its `=`; the numbers of a vector where that is typed.
fn keys(begin: &str) -> Vec<CompletionCandidate> {
    let mut found = Vec::new();
    for key in scenario_keys() {
        let path = instance(key.path, begin);
        let is_in_vector = key.kind == Kind::Vector && begin.starts_with(&format!("{path}."));
        let names = if is_in_vector {
            elements(&path).to_vec()
        } else {
            vec![path]
        };
        let fitting = names.iter().filter(|name| name.starts_with(begin));
        found.extend(fitting.map(|name| candidate(&format!("{name}="), key.about)));
    }
    found
}

/// What `key` may hold, where that are words that begin as `begin` does; `typed` stands before them.
fn values(key: &str, typed: &str, begin: &str) -> Vec<CompletionCandidate> {
    let row = KEYS.iter().find(|row| instance(row.path, key) == key);
    let Some(row) = row else {
        return Vec::new();
    };
    let words: Vec<String> = match row.kind {
        Kind::OneOf(words) | Kind::WholeOr(_, words) => {
            words.iter().map(ToString::to_string).collect()
        }
        Kind::Words(words) => words.iter().map(|word| format!("[\"{word}\"]")).collect(),
        Kind::Flag => vec!["true".to_owned(), "false".to_owned()],
        Kind::Line if row.path == "push.*.point" || row.path == "trace" => points(),
        _ => Vec::new(),
    };
    let fitting = words.iter().filter(|word| word.starts_with(begin));
    fitting
        .map(|word| CompletionCandidate::new(format!("{key}={typed}{word}")))
        .collect()
}

/// The names of the points of the scenario that is typed.
fn points() -> Vec<String> {
    let typed = std::env::args_os().skip_while(|word| word != "--").skip(2);
    let typed = typed.filter_map(|word| word.into_string().ok());
    let is_one = |name: &String| !name.starts_with('-') && !name.contains('=');
    let scenario = typed
        .filter(is_one)
        .chain([DEFAULT.to_owned()])
        .find_map(|name| Document::open(&name).ok()?.scenario().ok());
    let names = scenario.iter().flat_map(|scenario| scenario.body.names());
    names.map(str::to_owned).collect()
}
