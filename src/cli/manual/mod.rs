//! `gyrolab man`: the manual as plain text, all of it, the part of a command or a topic; and the pages for man(1).

mod sections;
pub(super) mod topics;

use super::{command, examples, print, tell};
use crate::export::Destination;
use crate::scenario::problem::nearest;
use crate::text::printable::{Shown, printable};
use anyhow::{Context, bail};
use clap::{Args, Command};
use clap_mangen::Man;
use clap_mangen::roff::{Roff, roman};
use sections::Section;
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
const WIDTH: usize = 80;
/// The day on which the manual was last gone through.
const DATE: &str = "2026-11-22";

pub(super) fn man(args: &ManArgs) -> anyhow::Result<ExitCode> {
    let mut gyrolab = command().disable_help_subcommand(true).term_width(WIDTH);
    gyrolab.build();
    if let Some(folder) = args.output.as_deref() {
        return write_pages(&gyrolab, folder, args.force);
    }
    let Some(topic) = args.topic.as_deref() else {
        return print(&whole(&gyrolab)?);
    };
    let command = topics::commands(&gyrolab).find(|command| command.get_name() == topic);
    if let Some(mut text) = topics::text(topic)? {
        if command.is_some() {
            text += &format!("\nThe options of the command: gyrolab {topic} --help.\n");
        }
        return print(&text);
    }
    let Some(command) = command else {
        let names = topics::names_and_commands(&gyrolab);
        let near = nearest(topic, names.iter().map(String::as_str));
        bail!(
            "no topic named {}, and no command: {near}",
            printable(topic)
        )
    };
    print(&(help(command) + &in_plain(&sections::of_command(command)?)))
}

/// The whole manual: help and sections of the program, then the help of each command.
fn whole(gyrolab: &Command) -> anyhow::Result<String> {
    let mut text = help(gyrolab) + &in_plain(&sections::of_program()?);
    for command in topics::commands(gyrolab) {
        let name = command.get_name().to_uppercase();
        text += &format!("\n\nGYROLAB {name}\n\n{}", help(command));
    }
    Ok(text)
}

fn help(command: &Command) -> String {
    command.clone().render_long_help().to_string()
}

fn in_plain(sections: &[Section]) -> String {
    let sections = sections.iter();
    let sections = sections.map(|(title, text)| format!("\n{title}\n\n{}\n", text.trim_end()));
    sections.collect()
}

/// Writes the page of the program and that of each command into `folder`.
fn write_pages(gyrolab: &Command, folder: &Path, replace: bool) -> anyhow::Result<ExitCode> {
    let cannot = || format!("cannot make the folder {}", Shown(folder));
    std::fs::create_dir_all(folder).with_context(cannot)?;
    let mut pages = vec![page(gyrolab, "gyrolab", &sections::of_program()?)?];
    for command in topics::commands(gyrolab) {
        let name = format!("gyrolab-{}", command.get_name());
        pages.push(page(command, &name, &sections::of_command(command)?)?);
    }
    for (name, page) in &pages {
        let output = Destination::open_file(&folder.join(name), replace)?;
        output.write_and_keep(page.as_bytes())?;
    }
    let count = pages.len();
    tell(format_args!("gyrolab: {count} pages in {}", Shown(folder)));
    Ok(ExitCode::SUCCESS)
}

/// The file of the page `name` and its text in roff, the language of man(1).
fn page(command: &Command, name: &str, sections: &[Section]) -> anyhow::Result<(String, String)> {
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
    let examples = examples::of(command.get_name()).map(|text| ("EXAMPLES", text.to_owned()));
    for (title, text) in examples.iter().chain(sections) {
        let mut roff = Roff::new();
        roff.control("SH", [*title]);
        // A line may be as wide as the terminal.
        roff.control("nf", []).control("in", ["0"]);
        roff.text([roman(text.trim_end())]);
        roff.control("in", []).control("fi", []);
        page.extend(roff.to_roff().into_bytes());
    }
    let page = String::from_utf8(page).context("the manual is not text")?;
    // clap_mangen's space above possible values is two line breaks with an empty line between them.
    let page = page.replace(".br\n\n.br\n", ".sp\n");
    Ok((format!("{name}.1"), page))
}
