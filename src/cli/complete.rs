//! Completion in the shell: what fits after the words that are typed. The script that `gyrolab completions` prints asks
//! the program itself, so that presets, keys and names are always those of this version.

mod keys;

use super::manual::topics::names_and_commands;
use super::{command, print};
use crate::analysis::readouts::READOUTS;
use crate::export::columns::{COLUMNS, OPTIONAL_COLUMNS};
use crate::export::points::POINT_COLUMNS;
use crate::figure::kind;
use crate::measured::quantity::QUANTITIES;
use crate::measured::shipped::SHIPPED;
use crate::scenario::presets::PRESETS;
use crate::study::sweep::shipped::SWEEPS;
use crate::teach::shipped::LESSONS;
use crate::text::shipped::Shipped;
use anyhow::{Context, bail};
use clap::{Arg, Command};
use clap_complete::Shell;
use clap_complete::engine::{
    ArgValueCompleter, CompletionCandidate, PathCompleter, ValueCompleter,
};
use clap_complete::env::{CompleteEnv, Shells};
use keys::{free_keys, settings, varied};
use std::ffi::OsStr;
use std::fmt::Write;
use std::path::Path;
use std::process::ExitCode;

/// The environment variable by which the script asks; its value is the name of the shell.
pub(super) const VARIABLE: &str = "GYROLAB_COMPLETE";

/// What completes a value, of which the beginning is typed.
type Completer = fn(&OsStr) -> Vec<CompletionCandidate>;

/// What completes the values of the arguments called so, in every command that has one.
const COMPLETERS: &[(&str, Completer)] = &[
    ("scenario", scenarios),
    ("runs", scenarios),
    ("set", settings),
    ("vary", varied),
    ("free", free_keys),
    ("measured", measured),
    ("columns", columns),
    ("kind", kinds),
    ("measure", readouts),
    ("files", files),
    ("commands", toml_files),
    ("topic", topics),
];

/// The same for arguments whose name says less: command, argument.
const COMPLETERS_OF: &[(&str, &str, Completer)] = &[
    ("presets", "name", all_shipped),
    ("sweep", "scenario", sweeps_and_scenarios),
    ("lesson", "name", lessons),
    ("verify", "files", csv_files),
];

/// Answers the shell where it asks; gives whether it did.
///
/// # Errors
/// When it cannot be answered: another shell, or a closed stdout.
pub(super) fn answered() -> Result<bool, clap::Error> {
    let folder = std::env::current_dir().ok();
    CompleteEnv::with_factory(command)
        .var(VARIABLE)
        .bin("gyrolab")
        .completer("gyrolab")
        .try_complete(std::env::args_os(), folder.as_deref())
}

/// `command` and all of its commands with what completes their values.
pub(super) fn with_completers(command: Command) -> Command {
    let name = command.get_name().to_owned();
    let complete = |arg: Arg| match completer(&name, arg.get_id().as_str()) {
        Some(completer) => arg.add(ArgValueCompleter::new(completer)),
        None => arg,
    };
    command.mut_args(complete).mut_subcommands(with_completers)
}

fn completer(command: &str, arg: &str) -> Option<Completer> {
    let of_command = COMPLETERS_OF
        .iter()
        .find(|(of, id, _)| (*of, *id) == (command, arg));
    let of_all = || COMPLETERS.iter().find(|(id, _)| *id == arg);
    of_command
        .map(|(.., completer)| *completer)
        .or_else(|| of_all().map(|(_, completer)| *completer))
}

/// The scripts for shells in which clap's own do not know that a value holds `=`, as those of `--set` do, or do not
/// complete when they are loaded by name.
const SCRIPTS: [(Shell, &str); 2] = [
    (Shell::Bash, include_str!("completion.bash")),
    (Shell::Zsh, include_str!("completion.zsh")),
];

/// `gyrolab completions`: the script for a shell.
pub(super) fn completions(shell: Shell) -> anyhow::Result<ExitCode> {
    let first = match shell {
        Shell::Zsh => "#compdef gyrolab\n", // it must be the first line of a file that compinit finds
        _ => "",
    };
    let script = script(shell)?;
    print(&format!("{first}{}{script}", what_is_completed()))
}

fn script(shell: Shell) -> anyhow::Result<String> {
    if let Some((_, script)) = SCRIPTS.iter().find(|(of, _)| *of == shell) {
        return Ok(script.replace("VARIABLE", VARIABLE));
    }
    let name = shell.to_string();
    let shells = Shells::builtins();
    let Some(shell) = shells.completer(&name) else {
        bail!("no completion for {name}");
    };
    let mut script = Vec::new();
    shell.write_registration(VARIABLE, "gyrolab", "gyrolab", "gyrolab", &mut script)?;
    String::from_utf8(script).context("the completion script is not text")
}

/// What the script completes, as its comment: each command with its options.
fn what_is_completed() -> String {
    let mut text = String::from("# Completion for gyrolab. It asks the program as you type:\n");
    for command in command().get_subcommands() {
        let options = command.get_arguments().filter_map(Arg::get_long);
        let options: Vec<_> = options.map(|long| format!(" --{long}")).collect();
        // Writing to a text does not fail.
        let _ = writeln!(text, "#   {}{}", command.get_name(), options.concat());
    }
    text
}

/// Those of `names` that begin as `current` does, each with what it means.
fn named<'a>(
    current: &OsStr,
    names: impl Iterator<Item = (&'a str, &'a str)>,
) -> Vec<CompletionCandidate> {
    let begin = current.to_string_lossy();
    let fitting = names.filter(|(name, _)| name.starts_with(&*begin));
    fitting
        .map(|(name, about)| candidate(name, about))
        .collect()
}

fn candidate(value: &str, about: &str) -> CompletionCandidate {
    let about = Some(about).filter(|about| !about.is_empty());
    CompletionCandidate::new(value).help(about.map(|about| about.to_owned().into()))
}

fn presets(current: &OsStr) -> Vec<CompletionCandidate> {
    named(current, PRESETS.iter().map(|preset| (preset.name, "")))
}

fn shipped(current: &OsStr, list: &'static [Shipped]) -> Vec<CompletionCandidate> {
    named(current, list.iter().map(|file| (file.name, "")))
}

/// All that `gyrolab presets` prints.
fn all_shipped(current: &OsStr) -> Vec<CompletionCandidate> {
    let lists = [
        presets(current),
        shipped(current, SWEEPS),
        shipped(current, SHIPPED),
    ];
    lists.into_iter().flatten().collect()
}

fn sweeps_and_scenarios(current: &OsStr) -> Vec<CompletionCandidate> {
    let lists = [shipped(current, SWEEPS), scenarios(current)];
    lists.into_iter().flatten().collect()
}

fn lessons(current: &OsStr) -> Vec<CompletionCandidate> {
    with_files(current, shipped(current, LESSONS), &["md"])
}

fn scenarios(current: &OsStr) -> Vec<CompletionCandidate> {
    with_files(current, presets(current), &["toml", "csv"])
}

fn files(current: &OsStr) -> Vec<CompletionCandidate> {
    with_files(current, Vec::new(), &["toml", "csv", "md"])
}

fn csv_files(current: &OsStr) -> Vec<CompletionCandidate> {
    with_files(current, Vec::new(), &["csv"])
}

fn toml_files(current: &OsStr) -> Vec<CompletionCandidate> {
    with_files(current, Vec::new(), &["toml"])
}

/// `candidates`, and the files that end so, and the folders.
fn with_files(
    current: &OsStr,
    mut candidates: Vec<CompletionCandidate>,
    endings: &'static [&'static str],
) -> Vec<CompletionCandidate> {
    let ends_so = |path: &Path| {
        let ending = path.extension().and_then(OsStr::to_str);
        path.is_dir() || ending.is_some_and(|ending| endings.contains(&ending))
    };
    let files = PathCompleter::any().filter(ends_so);
    candidates.extend(files.complete(current));
    candidates
}

fn columns(current: &OsStr) -> Vec<CompletionCandidate> {
    let columns = COLUMNS.iter().map(|column| (column.name, column.about));
    let optional = OPTIONAL_COLUMNS.iter();
    let optional = optional.map(|column| (column.name, column.about));
    let mut found = named(current, columns.chain(optional));
    let of_points = POINT_COLUMNS
        .iter()
        .filter(|point| COLUMNS.iter().all(|column| column.name != point.name));
    found.extend(named(
        current,
        of_points.map(|column| (column.name, column.about)),
    ));
    found
}

/// Measured data that come with the program, and files of such.
fn measured(current: &OsStr) -> Vec<CompletionCandidate> {
    with_files(current, shipped(current, SHIPPED), &["csv"])
}

fn readouts(current: &OsStr) -> Vec<CompletionCandidate> {
    let readouts = READOUTS.iter();
    named(
        current,
        readouts.map(|readout| (readout.name, readout.meaning)),
    )
}

/// The kinds of figures; columns behind those that are typed with commas between them.
fn kinds(current: &OsStr) -> Vec<CompletionCandidate> {
    let text = current.to_string_lossy();
    let (typed, begin) = behind_comma(&text);
    let mut names: Vec<_> = COLUMNS.iter().map(|of| (of.name, of.about)).collect();
    let others = QUANTITIES.iter().filter(|quantity| !quantity.is_column());
    names.extend(others.map(|quantity| (quantity.name, "")));
    if typed.is_empty() {
        names.extend(kind::NAMES.map(|name| (name, "")));
    }
    let fitting = names.iter().filter(|(name, _)| name.starts_with(begin));
    fitting
        .map(|(name, about)| candidate(&format!("{typed}{name}"), about))
        .collect()
}

/// `text` up to its last comma, and what is behind it.
fn behind_comma(text: &str) -> (&str, &str) {
    text.split_at(text.rfind(',').map_or(0, |comma| comma + 1))
}

fn topics(current: &OsStr) -> Vec<CompletionCandidate> {
    let topics = names_and_commands(&command());
    named(current, topics.iter().map(|name| (name.as_str(), "")))
}
