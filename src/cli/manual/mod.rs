//! `gyrolab man`: the manual page of the program, a page for each command, and topics.

mod around;
mod lab;
mod plain;
mod roff;
pub(super) mod topics;

use super::{command, examples, pager, print, tell};
use crate::export::Destination;
use crate::scenario::problem::nearest;
use crate::text::printable::{Shown, printable};
use anyhow::{Context, bail};
use clap::{Args, Command};
use clap_mangen::Man;
use plain::text_of;
use roff::{synopsis, terms, title, verbatim};
use std::io::{self, IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::process::{self, ExitCode, Stdio};

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

    /// Print it at once, where a terminal would get it by a pager: $PAGER, or else less
    #[arg(long, conflicts_with = "all")]
    no_pager: bool,
}

pub(super) fn man(args: &ManArgs) -> anyhow::Result<ExitCode> {
    let mut gyrolab = command().disable_help_subcommand(true); // which has no page
    gyrolab.build();
    if let Some(folder) = args.output.as_deref() {
        return write_all(&gyrolab, folder, args.force);
    }
    let Some(topic) = args.topic.as_deref() else {
        return show(&page(&gyrolab)?, args);
    };
    let command = topics::commands(&gyrolab).find(|command| command.get_name() == topic);
    if let Some(mut text) = topics::text(topic)? {
        if command.is_some() {
            text += &format!("\nThe options of the command: gyrolab {topic} --help.\n");
        }
        return show_text(&text, args);
    }
    match command {
        Some(command) => show(&page_of(command)?, args),
        None => {
            let names = topics::names_and_commands(&gyrolab);
            let near = nearest(topic, names.iter().map(String::as_str));
            bail!(
                "no topic named {}, and no command: {near}",
                printable(topic)
            )
        }
    }
}

/// Writes every page into `folder`.
fn write_all(gyrolab: &Command, folder: &Path, replace: bool) -> anyhow::Result<ExitCode> {
    let cannot = || format!("cannot make the folder {}", Shown(folder));
    std::fs::create_dir_all(folder).with_context(cannot)?;
    let mut pages = vec![("gyrolab.1".to_owned(), page(gyrolab)?)];
    for command in topics::commands(gyrolab) {
        let name = format!("gyrolab-{}.1", command.get_name());
        pages.push((name, page_of(command)?));
    }
    let count = pages.len();
    for (name, page) in pages {
        let output = Destination::open_file(&folder.join(name), replace)?;
        output.write_and_keep(page.as_bytes())?;
    }
    tell(format_args!("gyrolab: {count} pages in {}", Shown(folder)));
    Ok(ExitCode::SUCCESS)
}

/// Shows a page: on a terminal as man(1) shows it; where there is none, or no terminal, as plain text.
fn show(page: &str, args: &ManArgs) -> anyhow::Result<ExitCode> {
    if !io::stdout().is_terminal() {
        return print(&text_of(page));
    }
    let mut man = process::Command::new("man");
    man.args(["-l", "-"]).stderr(Stdio::null());
    if args.no_pager {
        man.env("MANPAGER", "cat");
    }
    match pager::shown_by(man, page) {
        Ok(true) => Ok(ExitCode::SUCCESS),
        _ => show_text(&text_of(page), args),
    }
}

fn show_text(text: &str, args: &ManArgs) -> anyhow::Result<ExitCode> {
    if args.no_pager {
        print(text)
    } else {
        pager::show(text)
    }
}

/// The manual: the page of the program, then one section for each command.
fn page(gyrolab: &Command) -> anyhow::Result<String> {
    let mut page = Vec::new();
    let main = Man::new(gyrolab.clone());
    page.extend(title("gyrolab").as_bytes());
    main.render_name_section(&mut page)?;
    page.extend(synopsis(gyrolab).as_bytes());
    main.render_description_section(&mut page)?;
    main.render_options_section(&mut page)?;
    main.render_subcommands_section(&mut page)?;
    let examples = examples::of(gyrolab.get_name()).unwrap_or_default();
    page.extend(verbatim("Examples", examples).as_bytes());
    for command in topics::commands(gyrolab) {
        let title = format!("gyrolab {}", command.get_name());
        let man = Man::new(command.clone());
        writeln!(page, ".SH \"{}\"", title.to_uppercase())?;
        man.render_description_section(&mut page)?;
        page.extend(synopsis(command).as_bytes());
        man.render_options_section(&mut page)?;
    }
    let files = around::files();
    let files = files.iter().map(|(file, about)| (file.as_str(), *about));
    let codes = around::exit_codes();
    let codes = codes.iter().map(|(code, when)| (code.as_str(), *when));
    let topics = topics::names().map(|name| format!("gyrolab man {name}"));
    for section in [
        lab::keys_page(),
        lab::commands_page(),
        lab::settings_page(),
        terms("Environment", around::ENVIRONMENT.iter().copied()),
        terms("Files", files),
        terms("Exit status", codes),
        verbatim("See also", &topics.collect::<Vec<_>>().join("\n")),
    ] {
        page.extend(section.as_bytes());
    }
    finished(page)
}

/// The page of one command.
fn page_of(command: &Command) -> anyhow::Result<String> {
    let name = command.get_name();
    let full_name = format!("gyrolab-{name}");
    let mut page = title(&full_name).into_bytes();
    let man = Man::new(command.clone().display_name(full_name));
    man.render_name_section(&mut page)?;
    page.extend(synopsis(command).as_bytes());
    man.render_description_section(&mut page)?;
    man.render_options_section(&mut page)?;
    if let Some(examples) = examples::of(name) {
        page.extend(verbatim("Examples", examples).as_bytes());
    }
    if let Some(topic) = topics::text(name)? {
        page.extend(verbatim("Notes", &topic).as_bytes());
    }
    let codes = around::exit_codes();
    let codes = codes.iter().map(|(code, when)| (code.as_str(), *when));
    page.extend(terms("Exit status", codes).as_bytes());
    page.extend(verbatim("See also", "gyrolab man").as_bytes());
    finished(page)
}

fn finished(page: Vec<u8>) -> anyhow::Result<String> {
    let page = String::from_utf8(page).context("the manual is not text")?;
    // clap_mangen's space above possible values is two line breaks with an empty line between them.
    Ok(page.replace(".br\n\n.br\n", ".sp\n"))
}
