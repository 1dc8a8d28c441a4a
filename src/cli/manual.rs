//! `gyrolab man`: the manual as plain text, all of it, the part of a command or a topic; and the pages for man(1). What the
//! program has in a table is made of that table: in a topic its name in braces stands for it.

use super::{command, info, print, tell};
use crate::engine::export::Destination;
use crate::engine::export::columns::{COLUMNS, OPTIONAL_COLUMNS, POINT_COLUMNS};
use crate::engine::scenario::kind::ValueKind;
use crate::engine::scenario::problem::nearest;
use crate::engine::text::printable::{PrintablePath, printable};
use crate::engine::text::wrap::{columns, wrapped};
use crate::lab::command::COMMANDS;
use crate::lab::storage::settings;
use crate::tui::panes::help as keys_of_lab;
use anyhow::{Context, bail};
use clap::{Args, Command};
use clap_mangen::Man;
use clap_mangen::roff::{Roff, roman};
use std::fmt;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

#[derive(Debug, Args)]
pub(super) struct ManArgs {
    /// A topic or a command; an unknown name gets the nearest one, or the list [without it: the whole manual]
    topic: Option<String>,

    /// Write every page, gyrolab.1 and one for each command, into the folder of -o: for packages
    #[arg(long, requires = "output", conflicts_with = "topic")]
    all: bool,

    /// The folder for --all; it is made where there is none
    #[arg(short, long, value_name = "FOLDER", requires = "all")]
    output: Option<PathBuf>,

    /// Replace existing files
    #[arg(long, requires = "output")]
    force: bool,
}

/// Columns of a line.
const MANUAL_WIDTH: usize = 80;
/// The day on which the manual was last gone through.
const DATE: &str = "2026-11-22";

pub(super) fn man(args: &ManArgs) -> anyhow::Result<ExitCode> {
    let mut gyrolab = command()
        .disable_help_subcommand(true)
        .term_width(MANUAL_WIDTH);
    gyrolab.build();
    if let Some(folder) = args.output.as_deref() {
        return write_pages(&gyrolab, folder, args.force);
    }
    let Some(name) = args.topic.as_deref() else {
        return print(&whole(&gyrolab)?);
    };
    let command = commands(&gyrolab).find(|command| command.get_name() == name);
    if let Some(mut text) = topic(name)? {
        if command.is_some() {
            text += &format!("\nThe options of the command: gyrolab {name} --help.\n");
        }
        return print(&text);
    }
    let Some(command) = command else {
        let names = names_and_commands(&gyrolab);
        let near = nearest(name, names.iter().map(String::as_str));
        bail!("no topic named {}, and no command: {near}", printable(name))
    };
    print(&(help(command) + &in_plain(&of_command(command)?)))
}

/// The whole manual: help and sections of the program, then the help of each command.
fn whole(gyrolab: &Command) -> anyhow::Result<String> {
    let mut text = help(gyrolab) + &in_plain(&of_program()?);
    for command in commands(gyrolab) {
        let name = command.get_name().to_uppercase();
        text += &format!("\n\nGYROLAB {name}\n\n{}", help(command));
    }
    Ok(text)
}

/// The short help of a command and its examples.
fn help(command: &Command) -> String {
    let mut short = command.clone();
    if let Some(examples) = command.get_after_long_help() {
        short = short.after_help(examples.clone());
    }
    short.render_help().to_string()
}

fn in_plain(sections: &[ManualSection]) -> String {
    sections
        .iter()
        .map(|(title, text)| format!("\n{title}\n\n{}\n", text.trim_end()))
        .collect()
}

/// Writes the page of the program and that of each command into `folder`.
fn write_pages(gyrolab: &Command, folder: &Path, replace: bool) -> anyhow::Result<ExitCode> {
    std::fs::create_dir_all(folder)
        .with_context(|| format!("cannot make the folder {}", PrintablePath(folder)))?;
    let mut pages = vec![page(gyrolab, "gyrolab", &of_program()?)?];
    for command in commands(gyrolab) {
        let name = format!("gyrolab-{}", command.get_name());
        pages.push(page(command, &name, &of_command(command)?)?);
    }
    for (name, page) in &pages {
        let output = Destination::open_file(&folder.join(name), replace)?;
        output.write_and_keep(page.as_bytes())?;
    }
    let count = pages.len();
    tell(format_args!(
        "gyrolab: {count} pages in {}",
        PrintablePath(folder)
    ));
    Ok(ExitCode::SUCCESS)
}

/// The file of the page `name` and its text in roff, the language of man(1).
fn page(
    command: &Command,
    name: &str,
    sections: &[ManualSection],
) -> anyhow::Result<(String, String)> {
    let mut page = Vec::new();
    let man = Man::new(command.clone().display_name(name.to_owned()))
        .date(DATE)
        .source(concat!("gyrolab ", env!("CARGO_PKG_VERSION")))
        .manual("gyrolab manual");
    man.render_title(&mut page)?;
    man.render_name_section(&mut page)?;
    man.render_synopsis_section(&mut page)?;
    man.render_description_section(&mut page)?;
    man.render_options_section(&mut page)?;
    if command.has_subcommands() {
        man.render_subcommands_section(&mut page)?;
    }
    let examples = examples_of(command.get_name()).map(|text| ("EXAMPLES", text.to_owned()));
    for (title, text) in examples.iter().chain(sections) {
        let mut roff = Roff::new();
        roff.control("SH", [*title]);
        // A line may be as wide as the terminal.
        roff.control("nf", []).control("in", ["0"]);
        roff.text([roman(text.trim_end())]);
        roff.control("in", []).control("fi", []);
        page.extend(roff.to_roff().into_bytes());
    }
    let text = String::from_utf8(page).context("the manual is not text")?;
    // clap_mangen's space above possible values is two line breaks with an empty line between them.
    Ok((format!("{name}.1"), text.replace(".br\n\n.br\n", ".sp\n")))
}

/// Name, and text.
const TOPICS: &[(&str, &str)] = &[
    ("class", include_str!("topics/class.txt")),
    ("csv", include_str!("topics/csv.txt")),
    ("fit", include_str!("topics/fit.txt")),
    ("friction", include_str!("topics/friction.txt")),
    ("glossary", include_str!("topics/glossary.txt")),
    ("lab", include_str!("topics/lab.txt")),
    ("numbers", include_str!("topics/numbers.txt")),
    ("own-code", include_str!("topics/own-code.txt")),
    ("scenario", include_str!("topics/scenario.txt")),
    ("schemes", include_str!("topics/schemes.txt")),
    ("sweep", include_str!("topics/sweep.txt")),
];

fn topic_names() -> impl Iterator<Item = &'static str> + Clone {
    TOPICS.iter().map(|(name, _)| *name)
}

/// The topics, and the commands of `gyrolab` that are none.
pub(super) fn names_and_commands(gyrolab: &Command) -> Vec<String> {
    let names = commands(gyrolab)
        .map(|command| command.get_name().to_owned())
        .filter(|name| topic_names().all(|topic| topic != name));
    topic_names().map(str::to_owned).chain(names).collect()
}

/// The commands of `gyrolab` that have a page.
fn commands(gyrolab: &Command) -> impl Iterator<Item = &Command> {
    let commands = gyrolab.get_subcommands();
    commands.filter(|command| !command.is_hide_set() && command.get_name() != "help")
}

/// The text of the topic `name`, if there is one.
fn topic(name: &str) -> Result<Option<String>, fmt::Error> {
    let Some((_, text)) = TOPICS.iter().find(|(of, _)| *of == name) else {
        return Ok(None);
    };
    let mut text = (*text).to_owned();
    for (place, table) in TABLES {
        if text.contains(place) {
            text = text.replace(place, &in_width(table()?.trim_end()));
        }
    }
    Ok(Some(text))
}

/// The lines of a table. A line that is too long goes on below the beginning of its last column.
fn in_width(table: &str) -> String {
    let lines = table.lines().map(|line| {
        if columns(line) <= MANUAL_WIDTH {
            return line.to_owned();
        }
        let indent = line.len() - line.trim_start().len();
        let text = line.rfind("  ").map_or(indent, |gap| gap + 2);
        let (begin, text) = line.split_at(text);
        let hanging = columns(begin);
        let text = wrapped(text, MANUAL_WIDTH - hanging);
        begin.to_owned() + &text.join(&format!("\n{}", " ".repeat(hanging)))
    });
    lines.collect::<Vec<_>>().join("\n")
}

/// The name of a table in a topic, and what is written in its place.
type ManualTable = (&'static str, fn() -> Result<String, fmt::Error>);

const TABLES: [ManualTable; 7] = [
    ("{COLUMNS}", || {
        Ok(two_columns(COLUMNS, |it| (it.name, it.about)))
    }),
    ("{COLUMNS ON REQUEST}", || {
        Ok(two_columns(OPTIONAL_COLUMNS, |it| (it.name, it.about)))
    }),
    ("{COLUMNS OF POINTS}", || {
        Ok(two_columns(POINT_COLUMNS, |it| (it.name, it.about)))
    }),
    ("{GLOSSARY}", || Ok(glossary())),
    ("{KEYS}", info::key_list),
    ("{READOUTS}", info::readout_list),
    ("{SCHEMES}", info::scheme_list),
];

/// Two columns of text.
fn two_columns<T>(rows: &[T], row: fn(&T) -> (&'static str, &'static str)) -> String {
    rows.iter()
        .map(row)
        .map(|(name, about)| format!("  {name:<14} {about}\n"))
        .collect()
}

/// A title, and the text below it.
type ManualSection = (&'static str, String);

fn of_program() -> Result<Vec<ManualSection>, fmt::Error> {
    let names: Vec<_> = topic_names().collect();
    let topics = paragraph(&format!("gyrolab man TOPIC, of {}.", names.join(", ")));
    Ok(vec![
        ("KEYS IN THE LAB", keys()),
        ("FILES OF COMMANDS", files_of_commands()),
        ("SETTINGS", chosen()),
        fixed("ENVIRONMENT"),
        fixed("FILES"),
        fixed("EXIT STATUS"),
        ("SEE ALSO", topics),
    ])
}

fn of_command(command: &Command) -> Result<Vec<ManualSection>, fmt::Error> {
    let notes = topic(command.get_name())?.map(|text| ("NOTES", text));
    Ok(notes.into_iter().chain([fixed("EXIT STATUS")]).collect())
}

/// The section `title` of those that no table of the program makes.
fn fixed(title: &'static str) -> ManualSection {
    let text = part(include_str!("manual/sections.txt"), title);
    (title, text.unwrap_or_default().to_owned())
}

/// Each term and what it means beside it; a long term has its meaning below it.
fn terms(rows: &[(String, &str)]) -> String {
    const MANUAL_INDENT: usize = 16;
    rows.iter()
        .map(|(term, meaning): &(String, &str)| {
            let meaning = wrapped(meaning, MANUAL_WIDTH - MANUAL_INDENT)
                .join(&format!("\n{:MANUAL_INDENT$}", ""));
            let begin = match wrapped(term, MANUAL_WIDTH - 4).join("\n    ") {
                short if columns(&short) + 4 <= MANUAL_INDENT => format!("  {short:<14}"),
                long => format!("  {long}\n{:MANUAL_INDENT$}", ""),
            };
            format!("{begin}{meaning}\n")
        })
        .collect()
}

/// Formats the words of the lab's help with their meanings.
fn glossary() -> String {
    let words = keys_of_lab::glossary().map(|(word, meaning)| (word.to_owned(), meaning));
    terms(&words.collect::<Vec<_>>())
}

fn paragraph(text: &str) -> String {
    wrapped(text, MANUAL_WIDTH).join("\n") + "\n\n"
}

/// The keys of each purpose, pane and place under its name.
fn keys() -> String {
    let entries = keys_of_lab::entries();
    let keys: Vec<_> = entries
        .iter()
        .filter(|entry| entry.binding.is_some())
        .collect();
    let mut text =
        paragraph("The same list is shown by ? in the lab, with the words on its screen.");
    for group in keys.chunk_by(|one, next| one.group == next.group) {
        let focus = group[0].pane.map(|_| ", while this pane has the focus");
        text += &format!("{}{}\n", group[0].group, focus.unwrap_or_default());
        let rows: Vec<_> = group
            .iter()
            .map(|entry| (entry.name(), entry.text))
            .collect();
        text += &terms(&rows);
    }
    text
}

fn files_of_commands() -> String {
    let rows = COMMANDS
        .iter()
        .map(|row| (format!("{} = {}", row.name, row.value), &*row.about));
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
    let rows = settings::SETTINGS_KEYS.iter().map(|row| {
        let value = match row.kind {
            ValueKind::OneOf(words) => format!("\"{}\"", words.join("\", \"")),
            ValueKind::Whole(least, most) => format!("{least} to {most}"),
            _ => "true, false".to_owned(),
        };
        (format!("{} = {value}", row.path), row.about)
    });
    paragraph(
        "The lab's settings, each a line of $XDG_CONFIG_HOME/gyrolab/config.toml (by default \
         ~/.config/gyrolab/config.toml). What is chosen in the lab is remembered in settings.toml beside the sessions; \
         config.toml wins, and is never written; options win over both. No setting changes a number, and show reads none.",
    ) + &terms(&rows.collect::<Vec<_>>())
}

/// Examples of each command, below its help and in its page. They are lines for a shell: what an example does stands above
/// it as a comment, and a long one is broken with a backslash, so that it can be pasted as it is.
const EXAMPLES: &str = include_str!("examples.txt");

/// The part of `text` below the line `== name`.
fn part(text: &'static str, name: &str) -> Option<&'static str> {
    let mut parts = text
        .strip_prefix("== ")?
        .split("\n== ")
        .filter_map(|part| part.split_once('\n'));
    parts.find_map(|(of, part)| (of == name).then(|| part.trim_end()))
}

/// The examples of the command `name`, or of the program itself: lines for a shell.
fn examples_of(name: &str) -> Option<&'static str> {
    part(EXAMPLES, name)
}

/// `command` with its examples below its long help, behind what it says there itself, and so for its commands.
pub(super) fn with_examples(command: Command) -> Command {
    let Some(examples) = examples_of(command.get_name()) else {
        return command.mut_subcommands(with_examples);
    };
    let own = command.get_after_help().map(|own| format!("{own}\n\n"));
    let lines = examples.lines().map(|line| format!("\n  {line}"));
    let text = own.unwrap_or_default() + "Examples:" + &lines.collect::<String>();
    command.after_long_help(text).mut_subcommands(with_examples)
}
