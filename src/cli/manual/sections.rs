//! The sections of the manual beside the help of the commands, as plain text. What the program has in a table is made of
//! that table.

use super::{WIDTH, topics};
use crate::cli::examples::part;
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
        fixed("ENVIRONMENT"),
        fixed("FILES"),
        fixed("EXIT STATUS"),
        ("SEE ALSO", topics.collect()),
    ])
}

pub(super) fn of_command(command: &Command) -> Result<Vec<Section>, fmt::Error> {
    let notes = topics::text(command.get_name())?;
    let notes = notes.map(|text| ("NOTES", text));
    Ok(notes.into_iter().chain([fixed("EXIT STATUS")]).collect())
}

/// The section `title` of those that no table of the program makes.
fn fixed(title: &'static str) -> Section {
    let text = part(include_str!("sections.txt"), title);
    (title, text.unwrap_or_default().to_owned())
}

/// Each term on a line, and what it means indented below.
fn terms(rows: &[(String, &str)]) -> String {
    const INDENT: &str = "      ";
    let row = |(term, meaning): &(String, &str)| {
        let meaning = wrapped(meaning, WIDTH - INDENT.len());
        let meaning = meaning.join(&format!("\n{INDENT}"));
        let term = wrapped(term, WIDTH - 4).join("\n    ");
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
