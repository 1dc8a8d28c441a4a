//! The sections of the manual beside the help of the commands, as plain text. What the program has in a table is made of
//! that table.

use super::{WIDTH, topics};
use crate::cli::complete;
use crate::cli::{INTERRUPTED, MISUSED};
use crate::lab::command::COMMANDS;
use crate::scenario::keys::Kind;
use crate::storage::settings;
use crate::text::wrap::wrapped;
use crate::tui::panes::help;
use clap::Command;
use std::fmt;

/// A title, and the text below it.
pub(super) type Section = (&'static str, String);

pub(super) fn of_program() -> Result<Vec<Section>, fmt::Error> {
    let topics = topics::names().map(|name| format!("  gyrolab man {name}\n"));
    Ok(vec![
        ("KEYS IN THE LAB", keys()),
        ("FILES OF COMMANDS", commands()),
        ("SETTINGS", chosen()),
        ("ENVIRONMENT", terms(ENVIRONMENT)),
        ("FILES", terms(FILES)),
        ("EXIT STATUS", exit_status()),
        ("SEE ALSO", topics.collect()),
    ])
}

pub(super) fn of_command(command: &Command) -> Result<Vec<Section>, fmt::Error> {
    let notes = topics::text(command.get_name())?;
    let notes = notes.map(|text| ("NOTES", text));
    let exit_status = ("EXIT STATUS", exit_status());
    Ok(notes.into_iter().chain([exit_status]).collect())
}

/// Each term on a line, and what it means indented below.
fn terms<T: AsRef<str>>(rows: &[(T, &str)]) -> String {
    const INDENT: &str = "      ";
    let row = |(term, meaning): &(T, &str)| {
        let meaning = wrapped(meaning, WIDTH - INDENT.len());
        let meaning = meaning.join(&format!("\n{INDENT}"));
        let term = wrapped(term.as_ref(), WIDTH - 4).join("\n    ");
        format!("  {term}\n{INDENT}{meaning}\n")
    };
    rows.iter().map(row).collect()
}

fn paragraph(text: &str) -> String {
    wrapped(text, WIDTH).join("\n") + "\n\n"
}

/// The keys of each purpose, pane and place under its name.
fn keys() -> String {
    let entries = help::entries();
    let keys = entries.iter().filter(|entry| entry.binding.is_some());
    let keys: Vec<_> = keys.collect();
    let mut text =
        paragraph("The same list is shown by ? in the lab, with the words on its screen.");
    for group in keys.chunk_by(|one, next| one.group == next.group) {
        let focus = group[0].pane.map(|_| ", while this pane has the focus");
        text += &format!("{}{}\n", group[0].group, focus.unwrap_or_default());
        let rows = group.iter().map(|entry| (entry.name(), entry.text));
        let rows: Vec<_> = rows.collect();
        text += &terms(&rows);
    }
    text
}

fn commands() -> String {
    let rows = COMMANDS
        .iter()
        .map(|row| (format!("{} = {}", row.name, row.value), row.about));
    paragraph(
        "A file for --do is a list of [[do]] tables with one command each, carried out in order:",
    ) + "  [[do]]\n  set = { \"motion.time_step_s\" = 0.05 }\n\n  [[do]]\n  go_to = \"60 s\"\n\n"
        + &paragraph(
            "The next begins when the one before is done. Refusals count the commands from 0: do.0 is the first. \
             Conditions hold numbers, the names of the CSV's columns and of the scenario's keys, + - * / ( ), abs, \
             comparisons, and, or.",
        )
        + &terms(&rows.collect::<Vec<_>>())
}

fn chosen() -> String {
    let rows = settings::KEYS.iter().map(|(key, kind, about)| {
        let value = match kind {
            Kind::OneOf(words) => format!("\"{}\"", words.join("\", \"")),
            Kind::Whole(least, most) => format!("{least} to {most}"),
            _ => "true, false".to_owned(),
        };
        (format!("{key} = {value}"), *about)
    });
    paragraph(
        "The lab's settings, each a line of $XDG_CONFIG_HOME/gyrolab/config.toml (by default \
         ~/.config/gyrolab/config.toml). What is chosen in the lab is remembered in settings.toml beside the sessions; \
         config.toml wins, and is never written; options win over both. No setting changes a number, and show reads none.",
    ) + &terms(&rows.collect::<Vec<_>>())
}

fn exit_status() -> String {
    terms(&[
        (
            "0".to_owned(),
            "Done; a reader that has gone, as head does, is no failure.",
        ),
        (
            "1".to_owned(),
            "Failed: a bad file, an output that cannot be written, numbers no longer finite, a CSV that differs.",
        ),
        (
            MISUSED.to_string(),
            "Wrong usage: an unknown option, a value that cannot be.",
        ),
        (
            INTERRUPTED.to_string(),
            "Ended by Ctrl-C, or another signal to end.",
        ),
    ])
}

const ENVIRONMENT: &[(&str, &str)] = &[
    (
        "NO_COLOR",
        "Set to anything: no colours, unless --color always or config.toml asks for them.",
    ),
    (
        "COLORFGBG",
        "A light background, as some terminals tell it, gives the colours for one; --background wins.",
    ),
    (
        "TERM",
        "The terminal. dumb gets ASCII and no colours, linux gets half blocks.",
    ),
    (
        "LC_ALL",
        "The locale, before LC_CTYPE and LANG: one without UTF-8 gets ASCII.",
    ),
    ("LC_CTYPE", "See LC_ALL."),
    ("LANG", "See LC_ALL."),
    ("HOME", "The home folder, where the next two are not set."),
    (
        "XDG_STATE_HOME",
        "Where sessions and settings.toml are kept, in its folder gyrolab; by default ~/.local/state.",
    ),
    (
        "XDG_CONFIG_HOME",
        "Where config.toml is read, in its folder gyrolab; by default ~/.config.",
    ),
    (
        "SSH_CONNECTION",
        "The port that the line with scp names after an export.",
    ),
    ("USER", "The user whom that line names; else LOGNAME."),
    ("LOGNAME", "See USER."),
    (
        "RAYON_NUM_THREADS",
        "On how many cores gyrolab sweep, compare, fit and verify compute; by default on all. No number depends on it.",
    ),
    (
        complete::VARIABLE,
        "The shell that asks for completions; the script of gyrolab completions sets it.",
    ),
];

const FILES: &[(&str, &str)] = &[
    (
        "$XDG_STATE_HOME/gyrolab/",
        "The sessions of the lab, which gyrolab sessions lists and --resume comes back to.",
    ),
    (
        "$XDG_STATE_HOME/gyrolab/settings.toml",
        "What was chosen in the lab; gyrolab writes it.",
    ),
    (
        "$XDG_CONFIG_HOME/gyrolab/config.toml",
        "Your own settings; gyrolab never writes it. See SETTINGS.",
    ),
    ("DIR/.gyrolab/", "Both of gyrolab --folder DIR."),
    (
        "FILE.toml",
        "A scenario or a run file: gyrolab man scenario.",
    ),
    (
        "FILE.csv",
        "A run with its run file in the header: gyrolab man csv.",
    ),
    ("FILE.md", "A lesson: gyrolab lesson --template."),
];
