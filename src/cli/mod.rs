//! The subcommands of the command line, one file each.
//!
//! It uses every other module. Options, the manual and the completions belong here. The computation of a subcommand belongs
//! to a module below, so that the lab can use it too.
//!
//! Data goes to stdout, messages to stderr. Exit codes: 0 success (also for a closed pipe), 1 failure, 2 wrong usage,
//! 130 Ctrl-C.

mod answers;
mod args;
mod argument_values;
mod cast;
mod class;
mod compare;
mod complete;
mod figure;
mod fit;
mod info;
mod layout_args;
mod lesson;
mod manual;
mod new_lab;
mod notes;
mod progress;
mod rehearsal;
mod reproduce;
mod run;
mod sessions;
mod settings;
mod show;
mod sweep;
mod verify;
mod workbench;
mod writeup;

use crate::engine::export::destination::{Destination, DestinationError};
use crate::engine::scenario::presets;
use crate::engine::text::number::counted;
use crate::engine::text::printable::{PrintablePath, is_steering, printable, printable_lines};
use anyhow::Context;
use args::{ClassArgs, LessonArgs, WorkbenchArgs};
use clap::builder::StyledStr;
use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};
use progress::Interrupted;
use serde::Serialize;
use std::fmt::Display;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, Ordering};

/// A terminal lab for the precession of a gyroscope: a report's stepper, better schemes, and any run as CSV.
#[derive(Debug, Parser)]
#[command(
    name = "gyrolab",
    bin_name = "gyrolab",
    version,
    about,
    args_conflicts_with_subcommands = true
)]
struct Cli {
    #[command(subcommand)]
    command: Option<CliCommand>,

    /// Print only errors and warnings on stderr: no summary, no notes, no progress
    #[arg(short, long, global = true)]
    quiet: bool,

    #[command(flatten)]
    workbench: WorkbenchArgs,
}

#[derive(Debug, Subcommand)]
enum CliCommand {
    /// Run a scenario and print a summary, or export it as CSV
    Run(run::RunArgs),
    /// Print the lab's screen at the end of a run as text
    Show(show::ShowArgs),
    /// Compare schemes and time steps with the exact motion
    Compare(compare::CompareArgs),
    /// Draw runs, or a table of compare, sweep or fit, as SVG, PDF or PNG
    Figure(Box<figure::FigureArgs>),
    /// Write up a run, or the CSV of a fit: a folder with a document, figures, numbers and CSV
    Writeup(writeup::WriteupArgs),
    /// Repeat the report's computations and test its claims, as one document
    Reproduce(reproduce::ReproduceArgs),
    /// Recompute CSVs, figures and write-ups, and report any difference
    Verify(verify::VerifyArgs),
    /// Record the lab playing a file of commands, for asciinema 3
    Cast(cast::CastArgs),
    /// Run a grid of scenarios on all cores, or list the shipped sweeps
    Sweep(sweep::SweepArgs),
    /// Fit values of a scenario to measured data
    Fit(fit::FitArgs),
    /// List the presets, or print a preset, a sweep or shipped data
    Presets {
        /// Name of the preset, sweep or data set to print
        name: Option<String>,
    },
    /// List the sessions that --resume can reopen
    Sessions {
        /// List the sessions of gyrolab --folder DIR
        #[arg(long, value_name = "DIR")]
        folder: Option<PathBuf>,
    },
    /// List the numerical schemes
    Schemes,
    /// List the lessons, open one, or print it as a worksheet
    Lesson(LessonArgs),
    /// Teach a class: students' labs follow the lesson and vote
    Class(ClassArgs),
    /// Check scenario, run and sweep files, CSV headers, files of commands and lessons
    Check {
        /// Files to check
        #[arg(required = true, value_name = "FILE")]
        files: Vec<PathBuf>,
    },
    /// List the keys of scenario and run files
    Keys,
    /// List the numbers of a run: name, unit, meaning and source
    Readouts,
    /// Print a completion script for a shell
    Completions {
        /// The shell
        shell: clap_complete::Shell,
    },
    /// Print the manual, the page of a command, or a topic
    Man(manual::ManArgs),
}

/// Exit code after Ctrl-C, as shells define it.
const INTERRUPTED: u8 = 130;

pub fn main() -> ExitCode {
    match complete::answered() {
        Ok(false) => {}
        Ok(true) => return ExitCode::SUCCESS,
        Err(error) => return misused(&error),
    }
    let parsed = command()
        .try_get_matches()
        .and_then(|matches| Cli::from_arg_matches(&matches));
    match parsed.map_err(explained) {
        Ok(cli) => {
            IS_QUIET.store(cli.quiet, Ordering::Relaxed);
            ended(execute(cli))
        }
        Err(Ok(error)) => misused(&error),
        Err(Err(meant)) => {
            warn(format_args!("gyrolab: {}", printable_lines(&meant)));
            ExitCode::from(MISUSED)
        }
    }
}

fn ended(result: anyhow::Result<ExitCode>) -> ExitCode {
    match result {
        Ok(code) => code,
        Err(error) if is_closed_pipe(&error) => ExitCode::SUCCESS,
        Err(error) if error.is::<Interrupted>() => ExitCode::from(INTERRUPTED),
        Err(error) => ended_by(Some(error)),
    }
}

/// Returns the command line with its examples and the completers of its values.
fn command() -> clap::Command {
    complete::with_completers(manual::with_examples(Cli::command()))
}

fn execute(cli: Cli) -> anyhow::Result<ExitCode> {
    let Some(command) = cli.command else {
        return open_lab(&cli.workbench);
    };
    match command {
        CliCommand::Run(args) => run::run(&args),
        CliCommand::Show(args) => show::show(&args),
        CliCommand::Compare(args) => compare::compare(&args),
        CliCommand::Figure(args) => figure::figure(&args),
        CliCommand::Sweep(args) => sweep::sweep(&args),
        CliCommand::Fit(args) => fit::fit(&args),
        CliCommand::Verify(args) => verify::verify(&args),
        CliCommand::Cast(args) => cast::cast(&args),
        CliCommand::Presets { name } => info::presets(name.as_deref()),
        CliCommand::Sessions { folder } => sessions::list(folder.as_deref()),
        CliCommand::Schemes => print(&info::scheme_list()?),
        CliCommand::Keys => print(&info::key_list()?),
        CliCommand::Readouts => print(&info::readout_list()?),
        CliCommand::Writeup(args) => writeup::writeup(&args),
        CliCommand::Reproduce(args) => reproduce::reproduce(&args),
        CliCommand::Class(args) => class::class(&args),
        CliCommand::Lesson(args) => lesson::lesson(&args),
        CliCommand::Check { files } => info::check(&files),
        CliCommand::Completions { shell } => complete::completions(shell),
        CliCommand::Man(args) => manual::man(&args),
    }
}

/// Opens the lab. Refuses a command's name after options, which clap would take for a scenario.
fn open_lab(args: &WorkbenchArgs) -> anyhow::Result<ExitCode> {
    let name = args.scenario.as_deref().unwrap_or_default();
    anyhow::ensure!(
        Cli::command().find_subcommand(name).is_none(),
        "{name} is a command, and commands come before their options: gyrolab {name} ..."
    );
    match &args.folder {
        Some(folder) if args.seat => class::seat(args, folder),
        _ => workbench::open(args),
    }
}

const MISUSED: u8 = 2;

/// Adds a tip to `error` if the option belongs to another command. Returns a message instead if a command was meant.
fn explained(mut error: clap::Error) -> Result<clap::Error, String> {
    if error.kind() == ErrorKind::ArgumentConflict
        && let Some(meant) = command_behind_options().or_else(misspelt_command)
    {
        return Err(meant);
    }
    let unknown = match (error.kind(), error.get(ContextKind::InvalidArg)) {
        (ErrorKind::UnknownArgument, Some(ContextValue::String(argument))) => argument.as_str(),
        _ => "",
    };
    if let Some(tip) = tip_for(unknown) {
        error.remove(ContextKind::SuggestedArg);
        error.remove(ContextKind::Usage); // it would speak of that argument
        let tip = StyledStr::from(tip.to_owned());
        error.insert(ContextKind::Suggested, ContextValue::StyledStrs(vec![tip]));
    }
    Ok(error)
}

/// Returns the error message for lab options before a command, which clap would take for a scenario.
fn command_behind_options() -> Option<String> {
    let mut typed = std::env::args_os()
        .skip(1)
        .map_while(|word| word.into_string().ok());
    let first = typed.next().filter(|first| first.starts_with('-'))?;
    let command = Cli::command();
    let name = typed.find(|word| command.find_subcommand(word).is_some())?;
    let first = printable(&first);
    Some(format!(
        "{name} is a command, and commands come before their options: gyrolab {name} ...; {first} is an option of the lab"
    ))
}

/// Returns a tip for an option that the command does not have, if the intention is known.
fn tip_for(unknown: &str) -> Option<&'static str> {
    match unknown {
        "--folder" => Some(
            "--folder is for the lab: gyrolab --folder DIR; this command reads and writes the files that it is given",
        ),
        "--dt" => Some(
            "the time step: --time-step 0.05 holds the seconds of a run and of its pushes, --set motion.time_step_s=0.05 their steps",
        ),
        "--measured" => Some(
            "measured data stand beside a run in the lab (gyrolab SCENARIO --measured FILE), in gyrolab show, figure and writeup; gyrolab fit FILE --in SCENARIO --free KEY fits a run to them",
        ),
        _ => None,
    }
}

/// Returns a message if the first word is one or two letters away from a command's name and is not a scenario.
fn misspelt_command() -> Option<String> {
    let typed = std::env::args_os().nth(1)?.into_string().ok()?;
    if typed.starts_with('-') || typed.contains(['/', '.']) || presets::find(&typed).is_some() {
        return None;
    }
    let command = Cli::command();
    let names = command.get_subcommands().map(clap::Command::get_name);
    let near = names.map(|name| (strsim::damerau_levenshtein(&typed, name), name));
    let (distance, near) = near.min_by_key(|(distance, _)| *distance)?;
    let typed = printable(&typed);
    (1..=2)
        .contains(&distance)
        .then(|| format!("there is no command {typed}: did you mean gyrolab {near}?"))
}

/// Prints the help or the error of clap. clap repeats the arguments unchanged. If one contains control characters, the text
/// is printed escaped and without colors.
fn misused(error: &clap::Error) -> ExitCode {
    let is_hostile =
        std::env::args_os().any(|argument| argument.to_string_lossy().contains(is_steering));
    let text = error.render().to_string();
    let plain = printable_lines(&text);
    let is_help = !error.use_stderr();
    let printed = match (is_hostile, error.use_stderr()) {
        (false, _) => error.print(),
        (true, true) => io::stderr().write_all(plain.as_bytes()),
        (true, false) => io::stdout().write_all(plain.as_bytes()),
    };
    match printed.context(NO_STDOUT) {
        Err(failure) if is_help && !is_closed_pipe(&failure) => ended_by(Some(failure)),
        _ => ExitCode::from(u8::try_from(error.exit_code()).unwrap_or(2)),
    }
}

/// Ends the process if both the `output` and the JSON of the command `name` would go to stdout. Returns true if the output
/// goes there.
fn one_on_stdout(name: &str, output: Option<&Path>, json: bool) -> bool {
    let is_on_stdout = output.is_some_and(Destination::is_for_stdout);
    if json && is_on_stdout {
        let message =
            "--json and -o - both claim stdout: write the CSV to a file, or leave --json out";
        refuse(name, ErrorKind::ArgumentConflict, message);
    }
    is_on_stdout
}

/// Ends the process with `message` about the command `name`, as clap does.
fn refuse(name: &str, kind: ErrorKind, message: &str) -> ! {
    let mut command = Cli::command();
    command.build();
    let error = match command.find_subcommand_mut(name) {
        Some(command) => command.error(kind, message),
        None => command.error(kind, message),
    };
    error.exit()
}

/// Error message when stdout cannot be written.
const NO_STDOUT: &str = "cannot write to stdout";

fn print(text: &str) -> anyhow::Result<ExitCode> {
    let mut stdout = io::stdout().lock();
    let printed = stdout.write_all(text.as_bytes());
    printed.and_then(|()| stdout.flush()).context(NO_STDOUT)?;
    Ok(ExitCode::SUCCESS)
}

/// Prints `result` on stdout, with `json` as one JSON object. If `output` has the rows, the text goes to stderr.
fn print_result<T: Display + Serialize>(
    result: &T,
    output: Option<&Path>,
    json: bool,
) -> anyhow::Result<()> {
    if output.is_some() {
        tell(result);
    }
    if json {
        print(&format!("{}\n", serde_json::to_string(result)?))?;
    } else if output.is_none() {
        print(&format!("{result}\n"))?;
    }
    Ok(())
}

/// Set by `--quiet`.
static IS_QUIET: AtomicBool = AtomicBool::new(false);

fn is_quiet() -> bool {
    IS_QUIET.load(Ordering::Relaxed)
}

/// Prints a message on stderr, unless `--quiet` was given.
fn tell(text: impl Display) {
    if !is_quiet() {
        warn(text);
    }
}

/// Prints an error or a warning on stderr, and ignores errors there.
fn warn(text: impl Display) {
    let _ = writeln!(io::stderr(), "{text}");
}

/// Prints notes about measured data, such as ignored columns.
fn tell_notes(notes: &[String]) {
    for note in notes {
        warn(format_args!("gyrolab: {note}"));
    }
}

/// Prints the number of rows in the file `path`.
fn tell_of_rows(rows: u64, path: &Path) {
    let rows = counted(rows, "row");
    tell(format_args!("gyrolab: {rows} in {}", PrintablePath(path)));
}

/// Returns the exit code of a command, and prints its error if there is one.
fn ended_by(error: Option<anyhow::Error>) -> ExitCode {
    error.map_or(ExitCode::SUCCESS, |error| {
        complain(&error);
        ExitCode::FAILURE
    })
}

fn complain(error: &anyhow::Error) {
    let error = format!("{error:#}");
    warn(format_args!("gyrolab: {}", printable_lines(&error)));
}

/// True if the reader of the output has closed the pipe, as in `gyrolab run ... -o - | head`, which is not a failure.
fn is_closed_pipe(error: &anyhow::Error) -> bool {
    error
        .chain()
        .filter_map(|cause| match cause.downcast_ref() {
            Some(DestinationError::Refused { error: source, .. }) => Some(source),
            _ => cause.downcast_ref::<io::Error>(),
        })
        .any(|cause| cause.kind() == io::ErrorKind::BrokenPipe)
}
