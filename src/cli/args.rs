//! The command line, as clap reads it.

use crate::physics::scheme;
use clap::builder::PossibleValuesParser;
use clap::{Args, Parser, Subcommand};
use std::num::NonZeroU64;
use std::path::PathBuf;

/// A terminal lab for the precession of a gyroscope: a report's stepper, better schemes, and any run as CSV.
#[derive(Debug, Parser)]
#[command(name = "gyrolab", version, about, arg_required_else_help = true, after_help = EXAMPLES)]
pub(super) struct Cli {
    #[command(subcommand)]
    pub(super) command: Command,
}

const EXAMPLES: &str = "\
Examples:
  gyrolab presets                                   what there is to run
  gyrolab run method-2                              the report's Method 2, how it ends
  gyrolab run method-2 -o method-2.csv              every step of it as CSV
  gyrolab run wobble-push --set motion.time_step_s=0.005 --duration 40 -o -
  gyrolab run method-2.csv -o again.csv             a CSV runs again: its header is the run file";

#[derive(Debug, Subcommand)]
pub(super) enum Command {
    /// Run a scenario without a terminal: a summary, or with -o its CSV
    Run(RunArgs),
    /// Hold schemes and time steps against the exact motion: errors, drifts, cost, measured order
    Compare(CompareArgs),
    /// List the shipped presets, or print one as TOML
    Presets {
        /// The preset to print
        name: Option<String>,
    },
    /// List the numerical schemes
    Schemes,
    /// Validate scenario files, run files and the headers of CSVs
    Check {
        /// Files to look at
        #[arg(required = true, value_name = "FILE")]
        files: Vec<PathBuf>,
    },
    /// Print a completion script for a shell
    Completions {
        /// The shell
        shell: clap_complete::Shell,
    },
    /// Print the manual page
    Man,
}

/// What is run, and what is changed in it first.
#[derive(Debug, Args)]
pub(super) struct ScenarioArgs {
    /// A preset's name, or a file (.toml or .csv): a scenario, a run file, or a CSV that gyrolab wrote
    pub(super) scenario: String,

    /// Change a value first, such as motion.time_step_s=0.05 or push.0.force_N=[0,0,-50]; may be repeated
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub(super) set: Vec<String>,

    /// The numerical scheme
    #[arg(long, value_name = "NAME", value_parser = PossibleValuesParser::new(scheme::names()))]
    pub(super) scheme: Option<String>,
}

/// How long a run is.
#[derive(Debug, Args)]
pub(super) struct LengthArgs {
    /// Length of the run in time steps [default: the scenario's]
    #[arg(long, value_name = "N", conflicts_with = "duration", value_parser = clap::value_parser!(u64).range(1..=i64::MAX as u64))]
    pub(super) steps: Option<u64>,

    /// Length of the run in simulated seconds
    #[arg(long, value_name = "SECONDS", value_parser = positive)]
    pub(super) duration: Option<f64>,
}

#[derive(Debug, Args)]
pub(super) struct RunArgs {
    #[command(flatten)]
    pub(super) scenario: ScenarioArgs,

    /// Write the CSV to this file, or to stdout for -
    #[arg(short, long, value_name = "FILE")]
    pub(super) output: Option<PathBuf>,

    #[command(flatten)]
    pub(super) length: LengthArgs,

    /// Write every N-th row only, and the last
    #[arg(long, value_name = "N", default_value = "1")]
    pub(super) every: NonZeroU64,

    /// Give the summary as one JSON object
    #[arg(long)]
    pub(super) json: bool,

    /// Replace an existing file
    #[arg(long)]
    pub(super) force: bool,
}

#[derive(Debug, Args)]
pub(super) struct CompareArgs {
    #[command(flatten)]
    pub(super) scenario: ScenarioArgs,

    #[command(flatten)]
    pub(super) length: LengthArgs,

    /// The schemes to compare [default: all that make an error]
    #[arg(long, value_name = "A,B", value_delimiter = ',', value_parser = PossibleValuesParser::new(scheme::names()))]
    pub(super) schemes: Vec<String>,

    /// The time steps, s [default: the scenario's, and a half, a quarter and an eighth of it]
    #[arg(long, value_name = "0.1,0.05", value_delimiter = ',', value_parser = positive)]
    pub(super) time_steps: Vec<f64>,

    /// Write the table as CSV to this file, or to stdout for -
    #[arg(short, long, value_name = "FILE")]
    pub(super) output: Option<PathBuf>,

    /// Replace an existing file
    #[arg(long)]
    pub(super) force: bool,
}

fn positive(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(number) if number > 0.0 && f64::is_finite(number) => Ok(number),
        _ => Err("must be a number greater than zero".to_owned()),
    }
}
