//! The commands: what they are called, and what each does with the rooms below.
//!
//! Data goes to stdout, talk to stderr. Exit codes: 0 done (a closed pipe too), 1 failed, 2 wrong usage, 130 Ctrl-C.

mod args;
mod info;
mod run;
mod workbench;

use crate::scenario::{Document, Problems};
use args::{Changes, Cli, Command};
use clap::Parser;
use std::io;
use std::process::ExitCode;

/// Ended by the user's Ctrl-C, as shells count it.
const INTERRUPTED: u8 = 130;

/// Runs the command line of this process.
pub fn main() -> ExitCode {
    match execute(Cli::parse()) {
        Ok(code) => code,
        Err(error) if is_closed_pipe(&error) => ExitCode::SUCCESS,
        Err(error) => {
            complain(&error);
            ExitCode::FAILURE
        }
    }
}

fn execute(cli: Cli) -> anyhow::Result<ExitCode> {
    match cli.command {
        None => workbench::open(&cli.workbench),
        Some(Command::Run(args)) => run::run(&args),
        Some(Command::Show(args)) => workbench::show(&args),
        Some(Command::Presets { name }) => info::presets(name.as_deref()),
        Some(Command::Schemes) => info::schemes(),
        Some(Command::Check { files }) => info::check(&files),
        Some(Command::Completions { shell }) => info::completions(shell),
        Some(Command::Man) => info::man(),
    }
}

/// What SCENARIO names, with what the command line changes in it.
fn changed(scenario: &str, changes: &Changes) -> Result<Document, Problems> {
    let mut document = Document::open(scenario)?;
    for set in &changes.set {
        document.set(set)?;
    }
    if let Some(scheme) = &changes.scheme {
        document.set(&format!("motion.scheme={scheme}"))?;
    }
    Ok(document)
}

/// Says on stderr what went wrong; where even that cannot be written there is nobody to tell.
fn complain(error: &anyhow::Error) {
    use io::Write;
    let _ = writeln!(io::stderr(), "gyrolab: {error:#}");
}

/// Whether the reader of our output has gone, as in `gyrolab run ... -o - | head`: that is no failure.
fn is_closed_pipe(error: &anyhow::Error) -> bool {
    error
        .chain()
        .filter_map(|cause| cause.downcast_ref::<io::Error>())
        .any(|cause| cause.kind() == io::ErrorKind::BrokenPipe)
}
