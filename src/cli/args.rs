//! The command line, as clap reads it.

use super::cast::CastArgs;
use super::figure::FigureArgs;
use super::fit::FitArgs;
use super::layout::LayoutArgs;
use super::manual::ManArgs;
use super::sweep::SweepArgs;
use super::verify::VerifyArgs;
use super::writeup::WriteupArgs;
use crate::physics::scheme;
use clap::builder::PossibleValuesParser;
use clap::{Args, Parser, Subcommand, ValueEnum};
use std::num::NonZeroU64;
use std::path::PathBuf;

/// A terminal lab for the precession of a gyroscope: a report's stepper, better schemes, and any run as CSV.
#[derive(Debug, Parser)]
#[command(name = "gyrolab", bin_name = "gyrolab", version, about, after_help = EXAMPLES, args_conflicts_with_subcommands = true)]
pub(super) struct Cli {
    #[command(subcommand)]
    pub(super) command: Option<Command>,

    #[command(flatten)]
    pub(super) workbench: WorkbenchArgs,
}

const EXAMPLES: &str = "\
Examples:
  gyrolab                                           open the lab: the report's Method 2, live
  gyrolab cusps --paused --at 500                   a screen prepared for the class
  gyrolab --resume                                  back to where the lab was left, or the line was lost
  gyrolab --do demo.toml                            play the commands in a file
  gyrolab lesson is-the-wobble-real                 a lesson beside the running lab
  gyrolab sessions                                  which labs were left; gyrolab --resume 3 takes the one named 3
  gyrolab presets                                   what there is to run
  gyrolab run method-2                              the report's Method 2, how it ends
  gyrolab run method-2 -o method-2.csv              every step of it as CSV
  gyrolab run wobble-push --time-step 0.01 -o -
  gyrolab run method-2.csv -o again.csv             a CSV runs again: its header is the run file";

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
    /// Record the lab while it carries out a file of commands, as asciinema plays it
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

/// What is run, and what is changed in it first.
#[derive(Debug, Args)]
pub(super) struct ScenarioArgs {
    /// A preset's name, or a file (.toml or .csv): a scenario, a run file, or a CSV that gyrolab wrote
    pub(super) scenario: String,

    #[command(flatten)]
    pub(super) changes: Changes,
}

/// What is changed in a scenario before it is run.
#[derive(Clone, Debug, Default, Args)]
pub(super) struct Changes {
    /// Change a value first, such as motion.time_step_s=0.05 or push.0.force_N=[0,0,-50]; may be repeated
    #[arg(long = "set", value_name = "KEY=VALUE", value_parser = setting)]
    pub(super) set: Vec<String>,

    /// The time step, s, with the run's length and its pushes held in seconds (--set motion.time_step_s holds their steps)
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true, value_parser = positive)]
    pub(super) time_step: Option<f64>,

    /// The numerical scheme
    #[arg(long, value_name = "NAME", value_parser = PossibleValuesParser::new(scheme::names()))]
    pub(super) scheme: Option<String>,
}

impl Changes {
    /// Whether anything is changed.
    pub(super) fn is_some(&self) -> bool {
        !self.set.is_empty() || self.time_step.is_some() || self.scheme.is_some()
    }
}

/// How the lab is opened.
#[derive(Clone, Debug, Default, Args)]
pub(super) struct WorkbenchArgs {
    /// A preset's name, or a file (.toml or .csv): a scenario, a run file, or a CSV that gyrolab wrote [default: method-2]
    pub(super) scenario: Option<String>,

    #[command(flatten)]
    pub(super) changes: Changes,

    /// Come back to a session, to the step where it was left: the newest that is not in use, or the one that
    /// gyrolab sessions calls NAME
    #[arg(long, value_name = "NAME", num_args = 0..=1, default_missing_value = "",
          conflicts_with_all = ["scenario", "set", "time_step", "scheme", "at"])]
    pub(super) resume: Option<String>,

    /// Read and write in this folder and nowhere else, whatever is typed: SCENARIO is a preset or a file in it, and
    /// sessions are kept in its folder .gyrolab
    #[arg(long, value_name = "DIR")]
    pub(super) folder: Option<PathBuf>,

    /// Put measured data beside the run: a CSV with a column t_s, or data that come with gyrolab (heidelberg-spin-decay)
    #[arg(long, value_name = "FILE")]
    pub(super) measured: Option<String>,

    /// Open with the run standing still
    #[arg(long)]
    pub(super) paused: bool,

    /// Open at this step
    #[arg(long, value_name = "STEP", allow_negative_numbers = true, value_parser = steps)]
    pub(super) at: Option<u64>,

    /// Carry out the commands in this file, [[do]] tables, or of stdin for -; gyrolab man lists them
    #[arg(long = "do", value_name = "FILE")]
    pub(super) commands: Option<PathBuf>,

    #[command(flatten)]
    pub(super) look: Look,

    /// Frames a second at most [default: 15, or as config.toml says]
    #[arg(long, value_name = "FRAMES", allow_negative_numbers = true, value_parser = frames)]
    pub(super) fps: Option<u32>,
}

/// What the lab looks like.
#[derive(Clone, Copy, Debug, Default, Args)]
pub(super) struct Look {
    /// Colours: auto honours NO_COLOR [default: as chosen last in the lab, or auto]
    #[arg(long, alias = "colour", value_enum, value_name = "WHEN")]
    pub(super) color: Option<Color>,

    /// What the colours are for [default: as chosen last, or as COLORFGBG says, or dark]
    #[arg(long, value_enum, value_name = "SCREEN")]
    pub(super) background: Option<Screen>,

    /// What dots are made of [default: as chosen last, or by locale and terminal]
    #[arg(long, value_enum, value_name = "KIND")]
    pub(super) markers: Option<Markers>,

    /// Leave the mouse to the terminal, to select text; the key M takes it
    #[arg(long)]
    pub(super) no_mouse: bool,
}

/// `--background`
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(super) enum Screen {
    Dark,
    Light,
}

/// `--color`
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(super) enum Color {
    Auto,
    Always,
    Never,
}

/// `--markers`
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(super) enum Markers {
    Braille,
    HalfBlock,
    Dot,
    Ascii,
}

#[derive(Debug, Args)]
pub(super) struct ShowArgs {
    /// A preset's name, or a file (.toml or .csv): a scenario, a run file, or a CSV that gyrolab wrote [with --do by default: method-2]
    #[arg(required_unless_present = "commands")]
    pub(super) scenario: Option<String>,

    #[command(flatten)]
    pub(super) changes: Changes,

    /// Show this step instead of the run's end
    #[arg(long, value_name = "STEP", allow_negative_numbers = true, value_parser = steps)]
    pub(super) at: Option<u64>,

    /// Show what the commands in this file, [[do]] tables, or of stdin for -, lead to from step 0; gyrolab man lists them
    #[arg(long = "do", value_name = "FILE")]
    pub(super) commands: Option<PathBuf>,

    /// Put measured data beside the run: a CSV with a column t_s, or data that come with gyrolab (heidelberg-spin-decay)
    #[arg(long, value_name = "FILE")]
    pub(super) measured: Option<String>,

    /// Columns and lines of the picture
    #[arg(long, value_name = "WIDTHxHEIGHT", default_value = "80x24", value_parser = size)]
    pub(super) size: (u16, u16),

    /// What dots are made of [default: by locale and terminal]
    #[arg(long, value_enum, value_name = "KIND")]
    pub(super) markers: Option<Markers>,
}

/// How long a run is.
#[derive(Debug, Args)]
pub(super) struct LengthArgs {
    /// Length of the run in time steps [default: the scenario's]
    #[arg(long, value_name = "N", conflicts_with = "duration", allow_negative_numbers = true, value_parser = length)]
    pub(super) steps: Option<u64>,

    /// Length of the run in simulated seconds
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true, value_parser = positive)]
    pub(super) duration: Option<f64>,
}

impl LengthArgs {
    /// Whether a length is given.
    pub(super) fn is_some(&self) -> bool {
        self.steps.is_some() || self.duration.is_some()
    }
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

    #[command(flatten)]
    pub(super) layout: LayoutArgs,

    /// Give the summary as one JSON object
    #[arg(long)]
    pub(super) json: bool,

    /// Replace an existing file
    #[arg(long)]
    pub(super) force: bool,
}

#[derive(Debug, Args)]
pub(super) struct LessonArgs {
    /// A shipped lesson's name, or a file (.md) [without it: the list of the lessons]
    pub(super) name: Option<String>,

    /// The page, counted from 1
    #[arg(long, value_name = "N", requires = "name", value_parser = one_or_more)]
    pub(super) page: Option<NonZeroU64>,

    /// Print the lesson for paper, as Markdown: pictures as text, room for predictions, no notes
    #[arg(long, group = "printed", requires = "name", conflicts_with = "page")]
    pub(super) handout: bool,

    /// Print what was predicted, in the newest session that holds it, beside what came out: to hand in
    #[arg(long, group = "printed", requires = "name", conflicts_with = "page")]
    pub(super) answers: bool,

    /// Follow a lab of this login on a second terminal: the notes of its page, what comes next, a clock
    #[arg(long, value_name = "SESSION", num_args = 0..=1, default_missing_value = "", conflicts_with_all = ["name", "page", "printed"])]
    pub(super) notes: Option<String>,

    /// Print a small lesson to begin from, with a comment on each part
    #[arg(long, group = "printed", conflicts_with = "name")]
    pub(super) template: bool,

    /// Write the handout, the answers or the template to this file, or to stdout for -
    #[arg(short, long, requires = "printed", value_name = "FILE")]
    pub(super) output: Option<PathBuf>,

    /// Replace an existing file
    #[arg(long, requires = "output")]
    pub(super) force: bool,

    #[command(flatten)]
    pub(super) look: Look,
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

    /// Give the table as one JSON object
    #[arg(long)]
    pub(super) json: bool,

    /// Replace an existing file
    #[arg(long)]
    pub(super) force: bool,
}

pub(super) fn one_or_more(text: &str) -> Result<NonZeroU64, String> {
    text.parse()
        .map_err(|_| "must be a whole number, 1 or more".to_owned())
}

fn steps(text: &str) -> Result<u64, String> {
    text.parse()
        .map_err(|_| "must be a whole number of steps, 0 or more, in digits".to_owned())
}

fn length(text: &str) -> Result<u64, String> {
    match text.parse() {
        Ok(steps) if (1..=i64::MAX as u64).contains(&steps) => Ok(steps),
        Ok(0) | Err(_) => Err("must be a whole number of steps, 1 or more, in digits".to_owned()),
        Ok(_) => Err("is more steps than can be counted".to_owned()),
    }
}

fn frames(text: &str) -> Result<u32, String> {
    match text.parse() {
        Ok(frames) if (1..=60).contains(&frames) => Ok(frames),
        _ => Err("must be a whole number from 1 to 60".to_owned()),
    }
}

fn setting(text: &str) -> Result<String, String> {
    match text.contains('=') {
        true => Ok(text.to_owned()),
        false => Err("must be KEY=VALUE, such as motion.time_step_s=0.05".to_owned()),
    }
}

pub(super) fn positive(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(number) if number > 0.0 && f64::is_finite(number) => Ok(number),
        _ => Err("must be a number greater than zero".to_owned()),
    }
}

/// The largest picture, columns and lines.
const LARGEST: u16 = 1000;

pub(super) fn size(text: &str) -> Result<(u16, u16), String> {
    let number = |text: &str| {
        text.parse()
            .ok()
            .filter(|number| (1..=LARGEST).contains(number))
    };
    text.split_once('x')
        .and_then(|(width, height)| Some((number(width)?, number(height)?)))
        .ok_or_else(|| format!("must be columns x lines, such as 80x24, each from 1 to {LARGEST}"))
}
