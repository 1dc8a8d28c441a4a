//! `gyrolab reproduce`: the report's computations and claims beside the exact motion, as one document.

use super::progress::{self, Interrupted, Interruption};
use super::{Cli, CliCommand, figure, run, sweep, tell};
use crate::engine::export::OutputFolder;
use crate::engine::text::io_errors::advised;
use crate::engine::text::printable::{PrintablePath, printable};
use crate::plot::PageFormat;
use crate::report::figure::FigureSource;
use crate::report::reproduce::{FIGURES, Made, REPRODUCTION_PAGE, TABLES, Tables, texts};
use crate::studies::table::TableSource;
use anyhow::{Context, anyhow, bail};
use clap::{Args, Parser};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

#[derive(Debug, Args)]
pub(super) struct ReproduceArgs {
    /// The folder: a new or an empty one
    #[arg(short, long, value_name = "FOLDER")]
    output: PathBuf,

    /// Write into a folder that contains files, and replace those of the same names
    #[arg(long)]
    force: bool,
}

pub(super) fn reproduce(args: &ReproduceArgs) -> anyhow::Result<ExitCode> {
    let interruption = progress::interruption()?;
    let folder = OutputFolder::begin(&args.output, args.force)?;
    for (name, bytes) in files(&interruption)? {
        let written = write(&folder.path().join(name), &bytes);
        written
            .map_err(|error| advised(&error))
            .with_context(|| format!("cannot write {}", PrintablePath(&args.output)))?;
    }
    interruption.may_keep()?;
    let others = folder.keep()?;
    tell(format_args!(
        "gyrolab: the reproduced report is in {}; begin with {REPRODUCTION_PAGE}",
        PrintablePath(&args.output)
    ));
    if !others.is_empty() {
        tell(format_args!(
            "gyrolab: other files, left as they were: {}",
            printable(&others.join(", "))
        ));
    }
    Ok(ExitCode::SUCCESS)
}

/// Writes a file, and makes its folder.
fn write(path: &Path, bytes: &[u8]) -> std::io::Result<()> {
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder)?;
    }
    fs::write(path, bytes)
}

/// Computes all files of the reproduced report. Returns their paths from its folder on, and their bytes.
pub(super) fn files(interruption: &Interruption) -> anyhow::Result<Vec<(String, Vec<u8>)>> {
    let mut tables = Tables::default();
    let mut files = Vec::new();
    for made in TABLES {
        let text = String::from_utf8(table(made, interruption)?)?;
        tables.add(made, &text)?;
        files.push((made.path(), text));
    }
    let mut pictures = Vec::new();
    for made in FIGURES {
        let source = figure_source(made, &files)?;
        let drawn = source.draw(interruption.meter());
        let drawn = drawn.map_err(anyhow::Error::msg)?.ok_or(Interrupted)?;
        for (ending, format) in [("svg", PageFormat::Svg), ("pdf", PageFormat::Pdf)] {
            let path = Path::new(&made.path()).with_extension(ending);
            let bytes = source.write(&drawn.scene, format)?;
            pictures.push((path.to_string_lossy().into_owned(), bytes));
        }
    }
    let written = files
        .into_iter()
        .map(|(path, text)| (path, text.into_bytes()));
    Ok(texts(&tables)?
        .into_iter()
        .chain(written)
        .chain(pictures)
        .collect())
}

/// Parses the command that makes a file.
fn command(made: &Made) -> anyhow::Result<CliCommand> {
    let words = shlex::split(&made.command()).unwrap_or_default();
    let command = Cli::try_parse_from(words)?.command;
    command.ok_or_else(|| no_command_for(made))
}

fn no_command_for(made: &Made) -> anyhow::Error {
    anyhow!("{} makes no file of that kind", made.command())
}

/// Computes the CSV that the command of `made` writes.
fn table(made: &Made, interruption: &Interruption) -> anyhow::Result<Vec<u8>> {
    match command(made)? {
        CliCommand::Run(args) => run::csv(&args, interruption),
        CliCommand::Sweep(args) => sweep::csv(&args, interruption),
        _ => bail!(no_command_for(made)),
    }
}

/// Returns what the figure of `made` shows: runs, or one of the `tables`.
fn figure_source(made: &Made, tables: &[(String, String)]) -> anyhow::Result<FigureSource> {
    let CliCommand::Figure(args) = command(made)? else {
        bail!(no_command_for(made));
    };
    let named = tables.iter().find(|(path, _)| args.runs.contains(path));
    match named {
        Some((path, text)) => {
            let table = TableSource::from_csv(path, text.clone())?;
            figure::of_table(&args, table.ok_or_else(|| no_command_for(made))?)
        }
        None => figure::read_source(&args),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_command_parses_as_a_gyrolab_command() {
        for made in TABLES {
            let command = command(made).unwrap();
            assert!(
                matches!(command, CliCommand::Run(_) | CliCommand::Sweep(_)),
                "{}",
                made.name
            );
        }
        for made in FIGURES {
            assert!(
                matches!(command(made).unwrap(), CliCommand::Figure(_)),
                "{}",
                made.name
            );
        }
    }
}
