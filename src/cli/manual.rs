//! `gyrolab man`: prints the manual as plain text (all of it, a command or a topic), or writes pages for man(1). A
//! table of the program is inserted where a topic has its name in braces.

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
    /// A topic or a command [default: the whole manual]
    topic: Option<String>,

    /// Write all man pages into the folder of -o: gyrolab.1 and one for each command, for packages
    #[arg(long, requires = "output", conflicts_with = "topic")]
    all: bool,

    /// The folder for --all; it is created if necessary
    #[arg(short, long, value_name = "FOLDER", requires = "all")]
    output: Option<PathBuf>,

    /// Replace existing files
    #[arg(long, requires = "output")]
    force: bool,
}

/// Width of a line, in columns.
const MANUAL_WIDTH: usize = 80;
/// Date of the last review of the manual.
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
        bail!("no topic or command named {}: {near}", printable(name))
    };
    print(&(help(command) + &in_plain(&of_command(command)?)))
}

/// Returns the whole manual: help and sections of the program, then the help of each command.
fn whole(gyrolab: &Command) -> anyhow::Result<String> {
    let mut text = help(gyrolab) + &in_plain(&of_program()?);
    for command in commands(gyrolab) {
        let name = command.get_name().to_uppercase();
        text += &format!("\n\nGYROLAB {name}\n\n{}", help(command));
    }
    Ok(text)
}

/// Returns the short help of a command and its examples.
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

/// Writes the page of the program and of each command into `folder`.
fn write_pages(gyrolab: &Command, folder: &Path, replace: bool) -> anyhow::Result<ExitCode> {
    std::fs::create_dir_all(folder)
        .with_context(|| format!("cannot create the folder {}", PrintablePath(folder)))?;
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
        "gyrolab: wrote {count} pages into {}",
        PrintablePath(folder)
    ));
    Ok(ExitCode::SUCCESS)
}

/// Returns the file name of the page `name`, and its text in roff, the language of man(1).
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
        // Lines may be as wide as the terminal.
        roff.control("nf", []).control("in", ["0"]);
        roff.text([roman(text.trim_end())]);
        roff.control("in", []).control("fi", []);
        page.extend(roff.to_roff().into_bytes());
    }
    let text = String::from_utf8(page).context("the manual is not text")?;
    // clap_mangen puts two line breaks with an empty line between them above possible values.
    Ok((format!("{name}.1"), text.replace(".br\n\n.br\n", ".sp\n")))
}

/// Name and text of each topic.
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

/// Returns the topics, and the commands of `gyrolab` without a topic.
pub(super) fn names_and_commands(gyrolab: &Command) -> Vec<String> {
    let names = commands(gyrolab)
        .map(|command| command.get_name().to_owned())
        .filter(|name| topic_names().all(|topic| topic != name));
    topic_names().map(str::to_owned).chain(names).collect()
}

/// Returns the commands of `gyrolab` that have a page.
fn commands(gyrolab: &Command) -> impl Iterator<Item = &Command> {
    let commands = gyrolab.get_subcommands();
    commands.filter(|command| !command.is_hide_set() && command.get_name() != "help")
}

/// Returns the text of the topic `name`, if there is one.
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

/// Wraps the lines of a table. A long line continues below the start of its last column.
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

/// The placeholder of a table in a topic, and the function that writes the table.
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

/// Formats rows as two columns of text.
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
    let topics = paragraph(&format!("gyrolab man TOPIC; topics: {}.", names.join(", ")));
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

/// Returns the section `title` with fixed text, which no table of the program provides.
fn fixed(title: &'static str) -> ManualSection {
    let text = part(include_str!("manual/sections.txt"), title);
    (title, text.unwrap_or_default().to_owned())
}

/// Formats each term with its meaning on the right; below it if the term is long.
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

/// Lists the keys, grouped by purpose, pane and place.
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
            "Each command starts when the previous one is done. Error messages count the commands from 0: do.0 is the \
             first. Conditions consist of numbers, names of CSV columns and scenario keys, + - * / ( ), abs, comparisons, \
             and, or.",
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
        "Each setting is a line of $XDG_CONFIG_HOME/gyrolab/config.toml (by default ~/.config/gyrolab/config.toml). \
         Choices in the lab are saved in settings.toml, next to the sessions. Command-line options override config.toml, \
         which overrides settings.toml. The lab never writes config.toml. Settings do not change numbers, and show ignores \
         them.",
    ) + &terms(&rows.collect::<Vec<_>>())
}

/// Examples of each command, for its help and its page. They can be pasted into a shell: a comment above an example
/// describes it, and a long line is broken with a backslash.
const EXAMPLES: &str = include_str!("examples.txt");

/// Returns the section of `text` below the line `== name`.
fn part(text: &'static str, name: &str) -> Option<&'static str> {
    let mut parts = text
        .strip_prefix("== ")?
        .split("\n== ")
        .filter_map(|part| part.split_once('\n'));
    parts.find_map(|(of, part)| (of == name).then(|| part.trim_end()))
}

/// Returns the examples of the command `name`, or of the program itself, as lines for a shell.
fn examples_of(name: &str) -> Option<&'static str> {
    part(EXAMPLES, name)
}

/// Adds the examples below the long help of `command` and its subcommands.
pub(super) fn with_examples(command: Command) -> Command {
    let Some(examples) = examples_of(command.get_name()) else {
        return command.mut_subcommands(with_examples);
    };
    let own = command.get_after_help().map(|own| format!("{own}\n\n"));
    let lines = examples.lines().map(|line| format!("\n  {line}"));
    let text = own.unwrap_or_default() + "Examples:" + &lines.collect::<String>();
    command.after_long_help(text).mut_subcommands(with_examples)
}
