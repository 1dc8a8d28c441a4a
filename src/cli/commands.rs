//! The command line: its commands, and the lab that opens without one.

use super::args::{ClassArgs, LessonArgs, WorkbenchArgs};
use super::cast::CastArgs;
use super::compare::CompareArgs;
use super::figure::FigureArgs;
use super::fit::FitArgs;
use super::manual::ManArgs;
use super::run::RunArgs;
use super::show::ShowArgs;
use super::sweep::SweepArgs;
use super::verify::VerifyArgs;
use super::writeup::WriteupArgs;
use clap::{Parser, Subcommand};
use std::path::PathBuf;

/// A terminal lab for the precession of a gyroscope: a report's stepper, better schemes, and any run as CSV.
#[derive(Debug, Parser)]
#[command(
    name = "gyrolab",
    bin_name = "gyrolab",
    version,
    about,
    args_conflicts_with_subcommands = true
)]
pub(super) struct Cli {
    #[command(subcommand)]
    pub(super) command: Option<Command>,

    #[command(flatten)]
    pub(super) workbench: WorkbenchArgs,
}

#[derive(Debug, Subcommand)]
pub(super) enum Command {
    /// Run a scenario without a terminal: a summary, or with -o its CSV
    Run(RunArgs),
    /// Print the lab's picture at the end of a run, as plain text
    Show(ShowArgs),
    /// Hold schemes and time steps against the exact motion: errors, drifts, cost, measured order
    Compare(CompareArgs),
    /// Draw runs, or a table of compare, of a sweep or of a fit, on paper: SVG, PDF or PNG
    Figure(FigureArgs),
    /// Make a folder for a write-up of a run: CSV, figures, measured numbers beside theory, and how to make it again
    Writeup(WriteupArgs),
    /// Compute a CSV again from its header: the same, or the first row that differs
    Verify(VerifyArgs),
    /// Record the lab while it carries out a file of commands, as asciinema 3 plays it
    Cast(CastArgs),
    /// Run a grid of runs on all cores and write a row for each, or list the shipped sweeps
    Sweep(SweepArgs),
    /// Fit keys of a scenario to measured data: values with uncertainties, and whether the model fits
    Fit(FitArgs),
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
    Man(ManArgs),
}
