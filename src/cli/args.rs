//! Arguments shared by several commands, and the scenario that they describe.

use super::argument_values::{frames, length, one_or_more, positive, setting, steps};
use crate::class::rehearsal::MOST_PLAYERS;
use crate::engine::data::{ColumnOptions, ColumnSigma};
use crate::engine::run::Simulation;
use crate::engine::scenario::csv::{Renaming, renaming};
use crate::engine::scenario::rescale::MOST_RUN_STEPS_BY_TIME;
use crate::engine::scenario::{Document, Problem, Problems, Scenario};
use crate::lab::view::theme::Background;
use crate::lab::view::theme::Marker;
use crate::physics::scheme;
use crate::tui::theme::ColorChoice;
use clap::builder::{PossibleValue, PossibleValuesParser};
use clap::{Args, ValueEnum};
use std::io;
use std::num::NonZeroU64;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(super) struct ScenarioArgs {
    /// Preset name, or a file: scenario or run file (.toml), or a CSV or figure of gyrolab
    pub(super) scenario: String,

    #[command(flatten)]
    pub(super) changes: SetArgs,
}

#[derive(Clone, Debug, Default, Args)]
pub(super) struct SetArgs {
    /// Change a value of the scenario, such as start.tilt_deg=30; can be repeated
    ///
    /// gyrolab keys lists the keys. VALUE is TOML: push.0.force_N=[0,0,-50].
    #[arg(long = "set", value_name = "KEY=VALUE", value_parser = setting)]
    pub(super) set: Vec<String>,

    /// Time step in s; the run and its pushes keep their length in seconds
    ///
    /// With --set motion.time_step_s they keep their number of steps instead.
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true, value_parser = positive)]
    pub(super) time_step: Option<f64>,

    /// Numerical scheme
    #[arg(long, value_name = "NAME", value_parser = PossibleValuesParser::new(scheme::names()))]
    pub(super) scheme: Option<String>,
}

impl SetArgs {
    pub(super) fn is_some(&self) -> bool {
        !self.set.is_empty() || self.time_step.is_some() || self.scheme.is_some()
    }
}

#[derive(Clone, Debug, Default, Args)]
pub(super) struct WorkbenchArgs {
    /// Preset name, or a file: scenario or run file (.toml), or a CSV or figure of gyrolab [default: method-2]
    pub(super) scenario: Option<String>,

    #[command(flatten)]
    pub(super) changes: SetArgs,

    /// Reopen a session at its step: the newest that is not open, or NAME
    ///
    /// gyrolab sessions lists the names.
    #[arg(long, value_name = "NAME", num_args = 0..=1, default_missing_value = "",
          conflicts_with_all = ["scenario", "set", "time_step", "scheme", "at"])]
    pub(super) resume: Option<String>,

    /// Restrict all file access to this folder
    ///
    /// SCENARIO is then a preset or a file in DIR, and sessions are kept in DIR/.gyrolab.
    #[arg(long, value_name = "DIR")]
    pub(super) folder: Option<PathBuf>,

    /// Ask for a seat in the class of DIR and open its lab (for ForceCommand in sshd_config)
    #[arg(long, requires = "folder",
          conflicts_with_all = ["scenario", "set", "time_step", "scheme", "at", "resume", "measured", "commands"])]
    pub(super) seat: bool,

    #[command(flatten)]
    pub(super) beside: MeasuredArgs,

    /// Open with the run paused
    #[arg(long)]
    pub(super) paused: bool,

    /// Open at this step
    #[arg(long, value_name = "STEP", allow_negative_numbers = true, value_parser = steps)]
    pub(super) at: Option<u64>,

    /// Run the commands in this file; - is standard input
    ///
    /// The file has [[do]] tables; gyrolab man lists the commands.
    #[arg(long = "do", value_name = "FILE")]
    pub(super) commands: Option<PathBuf>,

    #[command(flatten)]
    pub(super) look: DisplayArgs,

    /// Maximum frames per second [default: 15, or the value in config.toml]
    #[arg(long, value_name = "FRAMES", allow_negative_numbers = true, value_parser = frames)]
    pub(super) fps: Option<u32>,
}

/// Options for measured data that are drawn on a run.
#[derive(Clone, Debug, Default, Args)]
pub(super) struct MeasuredArgs {
    /// Draw measured data on the run
    ///
    /// FILE is a CSV with a column t_s, a shipped data set (heidelberg-spin-decay), or the output of your own program of the
    /// report's scheme.
    #[arg(long, value_name = "FILE")]
    pub(super) measured: Option<String>,

    #[command(flatten)]
    pub(super) columns: MapArgs,
}

#[derive(Clone, Debug, Default, Args)]
pub(super) struct MapArgs {
    /// Say what the columns of the data are, such as theta=tilt_rad,x=x_cm
    ///
    /// COLUMN is the name in the file, or its number from 1. NAME is a name of gyrolab in any unit: gx_dps=w1_deg_per_s.
    /// COLUMN=- ignores the column.
    #[arg(long, value_name = "COLUMN=NAME,...", value_delimiter = ',', value_parser = renaming)]
    pub(super) map: Vec<Renaming>,

    /// Set the standard uncertainty of a column that has none in the file
    ///
    /// COLUMN is the name in the file or the name of gyrolab; VALUE is in its unit.
    #[arg(long, value_name = "COLUMN=VALUE,...", value_delimiter = ',')]
    pub(super) sigma: Vec<ColumnSigma>,
}

impl MapArgs {
    pub(super) fn options(&self) -> ColumnOptions {
        ColumnOptions {
            map: self.map.clone(),
            sigma: self.sigma.clone(),
        }
    }
}

#[derive(Clone, Copy, Debug, Default, Args)]
pub(super) struct DisplayArgs {
    /// Colors; auto honors NO_COLOR [default: the last choice in the lab, or auto]
    #[arg(long, alias = "colour", value_enum, value_name = "WHEN")]
    pub(super) color: Option<ColorChoice>,

    /// Background of the terminal [default: the last choice, COLORFGBG, or dark]
    #[arg(long, value_enum, value_name = "SCREEN")]
    pub(super) background: Option<Background>,

    /// Characters for the dots [default: the last choice, or chosen by locale and terminal]
    #[arg(long, value_enum, value_name = "KIND")]
    pub(super) markers: Option<Marker>,

    /// Leave the mouse to the terminal, so that it selects text
    #[arg(long)]
    pub(super) no_mouse: bool,
}

/// Implements `ValueEnum` for types whose values have names.
macro_rules! named_values {
    ($($kind:ty, $all:expr, $name:expr;)*) => {
        $(impl ValueEnum for $kind {
            fn value_variants<'a>() -> &'a [Self] {
                $all
            }

            fn to_possible_value(&self) -> Option<PossibleValue> {
                Some(PossibleValue::new($name(*self)))
            }
        })*
    };
}

named_values! {
    ColorChoice, &Self::ALL, Self::name;
    Background, &Self::ALL, Self::name;
    Marker, &Self::ALL, Self::name;
}

#[derive(Clone, Debug, Default, Args)]
pub(super) struct LengthArgs {
    /// Length of the run in time steps [default: from the scenario]
    #[arg(long, value_name = "N", conflicts_with = "duration", allow_negative_numbers = true, value_parser = length)]
    pub(super) steps: Option<u64>,

    /// Length of the run in simulated seconds
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true, value_parser = positive)]
    pub(super) duration: Option<f64>,
}

impl LengthArgs {
    pub(super) fn is_some(&self) -> bool {
        self.steps.is_some() || self.duration.is_some()
    }
}

#[derive(Debug, Args)]
pub(super) struct ClassArgs {
    /// Name of a shipped lesson, or a file (.md) in the folder
    #[arg(required_unless_present_any = ["instead", "new"], conflicts_with = "instead")]
    pub(super) lesson: Option<String>,

    /// Folder of the class
    #[arg(long, value_name = "DIR", required_unless_present = "rehearse")]
    pub(super) folder: Option<PathBuf>,

    /// Start with a new group; the previous group is moved to DIR/.gyrolab/earlier
    #[arg(long, conflicts_with = "instead")]
    pub(super) new: bool,

    /// Practice alone with 1 to 30 simulated students
    ///
    /// Uses a temporary folder, or DIR, which must be empty and is kept.
    #[arg(long, value_name = "PLAYERS", requires = "lesson", conflicts_with = "new",
          value_parser = clap::value_parser!(u64).range(1..=MOST_PLAYERS))]
    pub(super) rehearse: Option<u64>,

    /// Continue the class at its page, with its rounds and votes
    #[arg(long, group = "instead")]
    pub(super) resume: bool,

    /// Show seats, votes, notes and the clock on a second terminal
    #[arg(long, group = "instead")]
    pub(super) board: bool,

    /// Show page, run and votes on a projector, without notes and right answers
    #[arg(long, group = "instead")]
    pub(super) projector: bool,

    /// Print all votes as CSV
    #[arg(long, group = "instead")]
    pub(super) votes: bool,

    /// Print a gradebook table as CSV: one row per seat, one column per question, round and task
    #[arg(long, group = "instead")]
    pub(super) table: bool,

    /// Write the predictions and results of each seat to a Markdown file
    #[arg(long, group = "instead", requires = "output")]
    pub(super) answers: bool,

    /// Folder for the answers
    #[arg(short, long, requires = "answers", value_name = "FOLDER")]
    pub(super) output: Option<PathBuf>,

    /// Replace existing files
    #[arg(long, requires = "output")]
    pub(super) force: bool,

    #[command(flatten)]
    pub(super) look: DisplayArgs,
}

#[derive(Debug, Args)]
pub(super) struct LessonArgs {
    /// Name of a shipped lesson, or a file (.md) [without it: list the lessons]
    pub(super) name: Option<String>,

    /// Page, counted from 1
    #[arg(long, value_name = "N", requires = "name", value_parser = one_or_more)]
    pub(super) page: Option<NonZeroU64>,

    /// List the lessons in order, with minutes, level and requirements
    #[arg(long, conflicts_with_all = ["name", "page", "printed", "notes"])]
    pub(super) list: bool,

    /// Print a worksheet with questions and space for answers [-o FILE.html: with figures, to print from a browser]
    #[arg(long, group = "printed", requires = "name", conflicts_with = "page")]
    pub(super) handout: bool,

    /// With --handout: print the pages with their results, to read after the lesson
    #[arg(long, requires = "handout")]
    pub(super) results: bool,

    /// Print a sheet for the teacher: goals, minutes, right answers, common mistakes, explanations
    #[arg(long, group = "printed", requires = "name", conflicts_with = "page")]
    pub(super) teacher: bool,

    /// Print the predictions of the newest session with their results, to hand in
    #[arg(long, group = "printed", requires = "name", conflicts_with = "page")]
    pub(super) answers: bool,

    /// Print a program without the physics, in this language, for the lesson to complete
    #[arg(long, group = "printed", requires = "name", conflicts_with = "page", value_name = "LANGUAGE", value_parser = ["octave", "matlab", "python"])]
    pub(super) frame: Option<String>,

    /// Show the notes of an open lesson on a second terminal, with the next page and a clock
    #[arg(long, value_name = "SESSION", num_args = 0..=1, default_missing_value = "", conflicts_with_all = ["name", "page", "printed"])]
    pub(super) notes: Option<String>,

    /// Restrict all file access to this folder; its lessons are listed first
    #[arg(long, value_name = "DIR", conflicts_with_all = ["handout", "teacher", "template", "notes"])]
    pub(super) folder: Option<PathBuf>,

    /// Print a small lesson to start from, with comments
    #[arg(long, group = "printed", conflicts_with = "name")]
    pub(super) template: bool,

    /// Write to this file instead of stdout; with .html a handout, answers or teacher's sheet prints from a browser
    #[arg(short, long, requires = "printed", value_name = "FILE")]
    pub(super) output: Option<PathBuf>,

    /// Replace an existing file
    #[arg(long, requires = "output")]
    pub(super) force: bool,

    #[command(flatten)]
    pub(super) look: DisplayArgs,
}

/// Returns the scenario with all changes of the command line, so that its run file describes the whole run.
pub(super) fn scenario_of(args: &ScenarioArgs, length: &LengthArgs) -> Result<Scenario, Problems> {
    changed(open(&args.scenario)?, &args.changes, length)
}

/// File name that means standard input.
pub(super) const STDIN: &str = "-";
pub(super) const STDIN_WORDS: &str = "standard input";

/// Opens the scenario named on the command line, or standard input.
pub(super) fn open(scenario: &str) -> Result<Document, Problems> {
    if scenario == STDIN {
        return Document::read_from(STDIN_WORDS, io::stdin().lock());
    }
    Document::open(scenario)
}

/// Applies these changes to `document` and returns its scenario.
pub(super) fn changed(
    mut document: Document,
    changes: &SetArgs,
    length: &LengthArgs,
) -> Result<Scenario, Problems> {
    change(&mut document, changes)?;
    change_length(&mut document, length)?;
    document.scenario()
}

/// Sets the length of the run of `document` if the command line gives one.
pub(super) fn change_length(document: &mut Document, length: &LengthArgs) -> Result<(), Problems> {
    if let Some(steps) = length.steps {
        document.set(&format!("motion.steps={steps}"))?;
    }
    let Some(duration) = length.duration else {
        return Ok(());
    };
    let scenario = document.scenario()?;
    if duration / scenario.motion.time_step_s > MOST_RUN_STEPS_BY_TIME {
        let rule = format!("{duration:e} s are more than {MOST_RUN_STEPS_BY_TIME:e} time steps");
        let mut problem = Problem::at("", rule);
        problem.place = Some("--duration".to_owned());
        return Err(Problems::one(document.origin(), problem));
    }
    let steps = Simulation::step_at(&scenario, duration).max(1);
    document.set(&format!("motion.steps={steps}"))
}

pub(super) fn change(document: &mut Document, changes: &SetArgs) -> Result<(), Problems> {
    for set in &changes.set {
        document.set(set)?;
    }
    if let Some(scheme) = &changes.scheme {
        document.set(&format!("motion.scheme={scheme}"))?;
    }
    if let Some(time_step_s) = changes.time_step {
        document.set_time_step(time_step_s)?;
    }
    Ok(())
}
