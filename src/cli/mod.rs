//! The subcommands of the command line: a file for each, with its options and what it does.
//!
//! It uses every other module. Options, the manual and the completions belong here. What a subcommand computes belongs to a
//! module below, so that the lab can use it too.
//!
//! Data goes to stdout, talk to stderr. Exit codes: 0 done (a closed pipe too), 1 failed, 2 wrong usage, 130 Ctrl-C.

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

    #[command(flatten)]
    workbench: WorkbenchArgs,
}

#[derive(Debug, Subcommand)]
enum CliCommand {
    /// Run a scenario without a terminal: a summary, or with -o its CSV
    Run(run::RunArgs),
    /// Print the lab's picture at the end of a run, as plain text
    Show(show::ShowArgs),
    /// Hold schemes and time steps against the exact motion: errors, drifts, cost, measured order
    Compare(compare::CompareArgs),
    /// Draw runs, or a table of compare, of a sweep or of a fit, on paper: SVG, PDF or PNG
    Figure(figure::FigureArgs),
    /// Make a folder for a write-up of a run: CSV, figures, measured numbers beside theory, and how to make it again
    Writeup(writeup::WriteupArgs),
    /// Make CSVs, figures and write-ups again from what they carry: the same, or what differs
    Verify(verify::VerifyArgs),
    /// Record the lab while it carries out a file of commands, as asciinema 3 plays it
    Cast(cast::CastArgs),
    /// Run a grid of runs on all cores and write a row for each, or list the shipped sweeps
    Sweep(sweep::SweepArgs),
    /// Fit keys of a scenario to measured data: values with uncertainties, and whether the model fits
    Fit(fit::FitArgs),
    /// List the shipped presets, or print one, or a shipped sweep, as TOML, or shipped measured data as CSV
    Presets {
        /// The preset, sweep or measured data to print
        name: Option<String>,
    },
    /// List the sessions that --resume can come back to: name, time, step, whether it is in use, run
    Sessions {
        /// Those of gyrolab --folder DIR
        #[arg(long, value_name = "DIR")]
        folder: Option<PathBuf>,
    },
    /// List the numerical schemes
    Schemes,
    /// List the lessons, open the lab with one, or print it for paper
    Lesson(LessonArgs),
    /// Teach a class: a lesson that the students' labs follow, with their votes
    Class(ClassArgs),
    /// Validate scenario files, run files, sweep files, the headers of CSVs, files of commands, and lessons (.md), which are played
    Check {
        /// Files to look at; a preset is none
        #[arg(required = true, value_name = "FILE")]
        files: Vec<PathBuf>,
    },
    /// List every key that a scenario or run file may hold; the keys to press are in gyrolab man, and ? in the lab
    Keys,
    /// List every number that is read off a run: name, unit, meaning, where it comes from
    Readouts,
    /// Print a completion script for a shell
    Completions {
        /// The shell
        shell: clap_complete::Shell,
    },
    /// Print the manual: all of it, the page of a command, or a topic
    Man(manual::ManArgs),
}

/// Ended by the user's Ctrl-C, as shells count it.
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
        Ok(cli) => ended(execute(cli)),
        Err(Ok(error)) => misused(&error),
        Err(Err(meant)) => {
            tell(format_args!("gyrolab: {}", printable_lines(&meant)));
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

/// The command line with its examples, and with what completes its values.
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
        CliCommand::Class(args) => class::class(&args),
        CliCommand::Lesson(args) => lesson::lesson(&args),
        CliCommand::Check { files } => info::check(&files),
        CliCommand::Completions { shell } => complete::completions(shell),
        CliCommand::Man(args) => manual::man(&args),
    }
}

/// Opens the lab. A command's name behind options is refused: clap takes it for the name of a scenario.
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

/// `error` with the option of another command that a user may have meant; or, instead of it, which command.
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

/// The refusal of options of the lab before a command, which clap then takes for a scenario.
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

/// What is said of an option that a command does not have, where what is meant is known.
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

/// What is said where the first word is one or two letters off a command's name, and no scenario.
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

/// Prints what clap has to say instead of going on: help, or why it takes no such arguments. clap repeats the arguments
/// as they are: where one holds a character that could steer a terminal, the text is printed escaped and without colors.
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

/// Refuses the command `name` whose `output` and whose JSON would both go to stdout. Returns whether the output goes there.
fn one_on_stdout(name: &str, output: Option<&Path>, json: bool) -> bool {
    let is_on_stdout = output.is_some_and(Destination::is_for_stdout);
    if json && is_on_stdout {
        let message =
            "--json and -o - both claim stdout: write the CSV to a file, or leave --json out";
        refuse(name, ErrorKind::ArgumentConflict, message);
    }
    is_on_stdout
}

/// Ends the process as clap does where it refuses: `message` is about the command `name`.
fn refuse(name: &str, kind: ErrorKind, message: &str) -> ! {
    let mut command = Cli::command();
    command.build();
    let error = match command.find_subcommand_mut(name) {
        Some(command) => command.error(kind, message),
        None => command.error(kind, message),
    };
    error.exit()
}

/// What is said where stdout takes no more.
const NO_STDOUT: &str = "cannot write to stdout";

fn print(text: &str) -> anyhow::Result<ExitCode> {
    let mut stdout = io::stdout().lock();
    let printed = stdout.write_all(text.as_bytes());
    printed.and_then(|()| stdout.flush()).context(NO_STDOUT)?;
    Ok(ExitCode::SUCCESS)
}

/// Prints what came out: on stdout, with `json` as one object; and as text on stderr where stdout or a file, `output`, has
/// the rows.
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

/// Prints `text` on stderr; a stderr that cannot be written ends nothing.
fn tell(text: impl Display) {
    let _ = writeln!(io::stderr(), "{text}");
}

/// Says what is not read of measured data, or what cannot be right about them.
fn tell_notes(notes: &[String]) {
    for note in notes {
        tell(format_args!("gyrolab: {note}"));
    }
}

/// Says how many rows are in the file `path`.
fn tell_of_rows(rows: u64, path: &Path) {
    let rows = counted(rows, "row");
    tell(format_args!("gyrolab: {rows} in {}", PrintablePath(path)));
}

/// The exit code of a command that ends with `error`, which is told, or without one.
fn ended_by(error: Option<anyhow::Error>) -> ExitCode {
    error.map_or(ExitCode::SUCCESS, |error| {
        complain(&error);
        ExitCode::FAILURE
    })
}

fn complain(error: &anyhow::Error) {
    let error = format!("{error:#}");
    tell(format_args!("gyrolab: {}", printable_lines(&error)));
}

/// Whether the reader of our output has gone, as in `gyrolab run ... -o - | head`: that is no failure.
fn is_closed_pipe(error: &anyhow::Error) -> bool {
    error
        .chain()
        .filter_map(|cause| match cause.downcast_ref() {
            Some(DestinationError::Refused { error: source, .. }) => Some(source),
            _ => cause.downcast_ref::<io::Error>(),
        })
        .any(|cause| cause.kind() == io::ErrorKind::BrokenPipe)
}
