//! The commands: what they are called, and what each does with the rooms below.
//!
//! Data goes to stdout, talk to stderr. Exit codes: 0 done (a closed pipe too), 1 failed, 2 wrong usage, 130 Ctrl-C.

mod args;
mod compare;
mod info;
mod progress;
mod run;
mod scenario;
mod workbench;

use args::{Cli, Command};
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
    let Some(command) = cli.command else {
        return workbench::open(&cli.workbench);
    };
    match command {
        Command::Run(args) => run::run(&args),
        Command::Show(args) => workbench::show(&args),
        Command::Compare(args) => compare::compare(&args),
        Command::Presets { name } => info::presets(name.as_deref()),
        Command::Schemes => info::schemes(),
        Command::Keys => info::keys(),
        Command::Check { files } => info::check(&files),
        Command::Completions { shell } => info::completions(shell),
        Command::Man => info::man(),
    }
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
