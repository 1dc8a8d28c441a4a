//! Shell completion of the words on the command line. The script that `gyrolab completions` prints asks the program
//! itself, so presets, keys and names always match its version.

use super::manual::names_and_commands;
use super::{command, print};
use crate::engine::analysis::readouts::READOUTS;
use crate::engine::data::SHIPPED;
use crate::engine::export::columns::{COLUMNS, CsvColumn, OPTIONAL_COLUMNS, POINT_COLUMNS};
use crate::engine::scenario::keys::{Effect, KEYS};
use crate::engine::scenario::kind::ValueKind;
use crate::engine::scenario::presets::PRESETS;
use crate::engine::scenario::schema::SchemaRow;
use crate::engine::text::shipped::Shipped;
use crate::lessons::shipped::LESSONS;
use crate::report::figure::kind;
use crate::report::figure::of_table::TABLE_KIND_NAMES;
use crate::studies::sweep::SWEEPS;
use anyhow::{Context, bail};
use clap::Command;
use clap_complete::Shell;
use clap_complete::engine::{
    ArgValueCompleter, CompletionCandidate, PathCompleter, ValueCompleter,
};
use clap_complete::env::{CompleteEnv, Shells};
use std::ffi::OsStr;
use std::process::ExitCode;

/// The environment variable through which the script asks. Its value is the name of the shell.
pub(super) const VARIABLE: &str = "GYROLAB_COMPLETE";

/// A function that returns names with their meanings. Its arguments are the typed text up to the last comma or `=`, and
/// the text after it.
type CompletionSource = fn(&str, &str) -> Vec<(String, String)>;

/// Returns the names that complete the argument `arg` of `command`, and the suitable file extensions; `None` if clap
/// completes it.
fn completing(command: &str, arg: &str) -> Option<(CompletionSource, &'static [&'static str])> {
    let names: CompletionSource = match (command, arg) {
        ("presets", "name") => |_, _| [presets(), shipped(SWEEPS), shipped(SHIPPED)].concat(),
        ("sweep", "scenario") => |_, _| [shipped(SWEEPS), presets()].concat(),
        ("lesson", "name") => |_, _| shipped(LESSONS),
        (_, "scenario" | "runs") => |_, _| presets(),
        (_, "set" | "vary") => settings,
        (_, "free") => |_, begin| keys(begin, is_free, ""),
        (_, "measured") => |_, _| shipped(SHIPPED),
        (_, "columns") => |_, _| columns(),
        (_, "kind") => |_, _| {
            [
                named(&kind::FIGURE_KIND_NAMES, |name| (name, "")),
                named(&TABLE_KIND_NAMES, |name| (name, "")),
                columns(),
            ]
            .concat()
        },
        ("figure", "x") => |_, begin| [readouts(), keys(begin, |_| true, "")].concat(),
        ("figure", "y") => |_, _| readouts(),
        ("figure", "log") => |_, _| named(&["x", "y", "z", "xy"], |axes| (axes, "")),
        (_, "measure") => |_, _| readouts(),
        (_, "topic") => |_, _| topics(),
        (_, "files" | "commands") => |_, _| Vec::new(),
        _ => return None,
    };
    let endings: &[_] = match (command, arg) {
        (_, "scenario" | "runs") => &["toml", "csv"],
        ("lesson", "name") => &["md"],
        ("verify", "files") | (_, "measured") => &["csv"],
        (_, "files") => &["toml", "csv", "md"],
        (_, "commands") => &["toml"],
        _ => &[],
    };
    Some((names, endings))
}

/// Answers a request of the shell. Returns true if there was one.
pub(super) fn answered() -> Result<bool, clap::Error> {
    let folder = std::env::current_dir().ok();
    CompleteEnv::with_factory(command)
        .var(VARIABLE)
        .bin("gyrolab")
        .completer("gyrolab")
        .try_complete(std::env::args_os(), folder.as_deref())
}

/// Adds completions of argument values to `command` and its subcommands.
pub(super) fn with_completers(command: Command) -> Command {
    let name = command.get_name().to_owned();
    command
        .mut_args(|arg| match completing(&name, arg.get_id().as_str()) {
            Some((names, endings)) => arg.add(ArgValueCompleter::new(move |current: &OsStr| {
                completed(current, names, endings)
            })),
            None => arg,
        })
        .mut_subcommands(with_completers)
}

/// Replacements for clap's scripts, which split a value at `=` (bash) or do nothing on first use (zsh).
const SCRIPTS: [(Shell, &str); 2] = [
    (Shell::Bash, include_str!("completion.bash")),
    (Shell::Zsh, include_str!("completion.zsh")),
];

/// Prints the completion script for a shell.
pub(super) fn completions(shell: Shell) -> anyhow::Result<ExitCode> {
    let first = match shell {
        Shell::Zsh => "#compdef gyrolab\n", // it must be the first line of a file that compinit finds
        _ => "",
    };
    print(&format!("{first}{}", script(shell)?))
}

fn script(shell: Shell) -> anyhow::Result<String> {
    if let Some((_, script)) = SCRIPTS.iter().find(|(of, _)| *of == shell) {
        return Ok(script.replace("VARIABLE", VARIABLE));
    }
    let name = shell.to_string();
    let shells = Shells::builtins();
    let Some(completer) = shells.completer(&name) else {
        bail!("no completion for {name}");
    };
    let mut script = Vec::new();
    completer.write_registration(VARIABLE, "gyrolab", "gyrolab", "gyrolab", &mut script)?;
    String::from_utf8(script).context("the completion script is not text")
}

/// Returns the names that continue `current` after its last `,` or `=`, and folders and files with these extensions.
fn completed(
    current: &OsStr,
    names: CompletionSource,
    endings: &'static [&'static str],
) -> Vec<CompletionCandidate> {
    let text = current.to_string_lossy();
    let (typed, begin) = text.split_at(text.rfind([',', '=']).map_or(0, |mark| mark + 1));
    let fitting = names(typed, begin)
        .into_iter()
        .filter(|(name, _)| name.starts_with(begin));
    let mut candidates: Vec<_> = fitting
        .map(|(name, about)| {
            let about = (!about.is_empty()).then(|| about.into());
            CompletionCandidate::new(format!("{typed}{name}")).help(about)
        })
        .collect();
    if !endings.is_empty() {
        candidates.extend(
            PathCompleter::any()
                .filter(|path| {
                    let ending = path.extension().and_then(OsStr::to_str);
                    path.is_dir() || ending.is_some_and(|ending| endings.contains(&ending))
                })
                .complete(current),
        );
    }
    candidates
}

fn named<T>(table: &[T], row: fn(&T) -> (&'static str, &'static str)) -> Vec<(String, String)> {
    let rows = table.iter().map(row);
    rows.map(|(name, about)| (name.to_owned(), about.to_owned()))
        .collect()
}

fn presets() -> Vec<(String, String)> {
    named(PRESETS, |preset| (preset.name, ""))
}

fn shipped(list: &'static [Shipped]) -> Vec<(String, String)> {
    named(list, |file| (file.name, ""))
}

fn readouts() -> Vec<(String, String)> {
    named(READOUTS, |readout| (readout.name, readout.meaning))
}

fn columns() -> Vec<(String, String)> {
    let of_points = named(POINT_COLUMNS, |column| (column.name, column.about)).into_iter();
    let mut columns = named(COLUMNS, |column| (column.name, column.about));
    columns.extend(named(OPTIONAL_COLUMNS, |column| {
        (column.name, column.about)
    }));
    columns.extend(of_points.filter(|(name, _)| CsvColumn::find(name).is_none()));
    columns
}

fn topics() -> Vec<(String, String)> {
    let names = names_and_commands(&command()).into_iter();
    names.map(|name| (name, String::new())).collect()
}

/// Returns dotted keys with `=`, or the possible values after the `=`.
fn settings(typed: &str, begin: &str) -> Vec<(String, String)> {
    let Some((key, _)) = typed.split_once('=') else {
        return keys(begin, |_| true, "=");
    };
    let row = KEYS.iter().find(|row| instance(row.path, key) == key);
    let words = row.map_or_else(Vec::new, |row| row.kind.words());
    named(&words, |word| (word, ""))
}

/// Returns the `wanted` dotted keys, each followed by `end`. A vector that is typed in full gets its three components.
fn keys(begin: &str, wanted: fn(&SchemaRow) -> bool, end: &str) -> Vec<(String, String)> {
    let mut found = Vec::new();
    let of_scenario = KEYS.iter().filter(|key| !key.path.starts_with("edit."));
    for key in of_scenario.filter(|key| wanted(key)) {
        let path = instance(key.path, begin);
        if key.kind == ValueKind::Vector && begin.starts_with(&format!("{path}.")) {
            found
                .extend([0, 1, 2].map(|place| (format!("{path}.{place}{end}"), key.description())));
        } else {
            found.push((path + end, key.description()));
        }
    }
    found
}

fn is_free(key: &SchemaRow) -> bool {
    Effect::of_key(key.path) != Effect::None
        && matches!(key.kind, ValueKind::Number(_) | ValueKind::Vector)
}

/// Replaces each `*` in the key `path` by the number at that position in `typed`, or by 0.
fn instance(path: &str, typed: &str) -> String {
    let mut typed_parts = typed.split('.');
    path.split('.')
        .map(|part| {
            let number = typed_parts
                .next()
                .filter(|typed_part| typed_part.parse::<usize>().is_ok());
            if part == "*" {
                number.unwrap_or("0")
            } else {
                part
            }
        })
        .collect::<Vec<_>>()
        .join(".")
}
