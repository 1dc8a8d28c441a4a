//! Arguments that several commands have, and the scenario that they mean.

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
    /// A preset's name, or a file: a scenario, a run file (.toml), a CSV or a figure that gyrolab wrote
    pub(super) scenario: String,

    #[command(flatten)]
    pub(super) changes: SetArgs,
}

#[derive(Clone, Debug, Default, Args)]
pub(super) struct SetArgs {
    /// Change a value first: start.tilt_deg=30; may be repeated
    ///
    /// KEY is one that gyrolab keys lists, VALUE is TOML: push.0.force_N=[0,0,-50].
    #[arg(long = "set", value_name = "KEY=VALUE", value_parser = setting)]
    pub(super) set: Vec<String>,

    /// The time step, s; length and pushes keep their seconds
    ///
    /// With --set motion.time_step_s they keep their numbers of steps.
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true, value_parser = positive)]
    pub(super) time_step: Option<f64>,

    /// The numerical scheme
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
    /// A preset's name, or a file: a scenario, a run file (.toml), a CSV or a figure that gyrolab wrote [default: method-2]
    pub(super) scenario: Option<String>,

    #[command(flatten)]
    pub(super) changes: SetArgs,

    /// Come back to a session: the newest, or NAME
    ///
    /// To the step where it was left; the newest that is not in use, or the one that gyrolab sessions calls NAME.
    #[arg(long, value_name = "NAME", num_args = 0..=1, default_missing_value = "",
          conflicts_with_all = ["scenario", "set", "time_step", "scheme", "at"])]
    pub(super) resume: Option<String>,

    /// Read and write in this folder and nowhere else
    ///
    /// Whatever is typed: SCENARIO is a preset or a file in it, and sessions are kept in its folder .gyrolab.
    #[arg(long, value_name = "DIR")]
    pub(super) folder: Option<PathBuf>,

    /// Ask for a seat of the class in DIR, and open its lab: what ForceCommand runs for a student
    #[arg(long, requires = "folder",
          conflicts_with_all = ["scenario", "set", "time_step", "scheme", "at", "resume", "measured", "commands"])]
    pub(super) seat: bool,

    #[command(flatten)]
    pub(super) beside: MeasuredArgs,

    /// Open with the run standing still
    #[arg(long)]
    pub(super) paused: bool,

    /// Open at this step
    #[arg(long, value_name = "STEP", allow_negative_numbers = true, value_parser = steps)]
    pub(super) at: Option<u64>,

    /// Carry out the commands in this file, or of stdin for -
    ///
    /// The file holds [[do]] tables, which gyrolab man lists.
    #[arg(long = "do", value_name = "FILE")]
    pub(super) commands: Option<PathBuf>,

    #[command(flatten)]
    pub(super) look: DisplayArgs,

    /// Frames a second at most [default: 15, or as config.toml says]
    #[arg(long, value_name = "FRAMES", allow_negative_numbers = true, value_parser = frames)]
    pub(super) fps: Option<u32>,
}

/// Measured data beside a run.
#[derive(Clone, Debug, Default, Args)]
pub(super) struct MeasuredArgs {
    /// Put measured data beside the run
    ///
    /// FILE is a CSV with a column t_s, data that come with gyrolab (heidelberg-spin-decay), or rows that your own program
    /// of the report's scheme wrote.
    #[arg(long, value_name = "FILE")]
    pub(super) measured: Option<String>,

    #[command(flatten)]
    pub(super) columns: MapArgs,
}

#[derive(Clone, Debug, Default, Args)]
pub(super) struct MapArgs {
    /// What the columns of measured data are
    ///
    /// COLUMN is the name in the file, or the number from 1; NAME is gyrolab's, in any unit: gx_dps=w1_deg_per_s,
    /// theta=tilt_rad, x=x_cm. COLUMN=- leaves the column out.
    #[arg(long, value_name = "COLUMN=NAME,...", value_delimiter = ',', value_parser = renaming)]
    pub(super) map: Vec<Renaming>,

    /// The standard uncertainty of the values of a column that has none in the file
    ///
    /// COLUMN is the name in the file or gyrolab's; VALUE is in the unit of that name.
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
    /// Colors: auto honors NO_COLOR [default: as chosen last in the lab, or auto]
    #[arg(long, alias = "colour", value_enum, value_name = "WHEN")]
    pub(super) color: Option<ColorChoice>,

    /// Background of the terminal [default: as chosen last, or as COLORFGBG says, or dark]
    #[arg(long, value_enum, value_name = "SCREEN")]
    pub(super) background: Option<Background>,

    /// What dots are made of [default: as chosen last, or by locale and terminal]
    #[arg(long, value_enum, value_name = "KIND")]
    pub(super) markers: Option<Marker>,

    /// Leave the mouse to the terminal, to select text; c, the settings, takes it
    #[arg(long)]
    pub(super) no_mouse: bool,
}

/// Makes each of these values an argument by its name.
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
    /// Length of the run in time steps [default: the scenario's]
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
    /// A shipped lesson's name, or a file (.md) in the folder
    #[arg(required_unless_present_any = ["instead", "new"], conflicts_with = "instead")]
    pub(super) lesson: Option<String>,

    /// The folder of the class
    #[arg(long, value_name = "DIR", required_unless_present = "rehearse")]
    pub(super) folder: Option<PathBuf>,

    /// Begin with a new group: keep seats and votes of the group before in DIR/.gyrolab/earlier
    #[arg(long, conflicts_with = "instead")]
    pub(super) new: bool,

    /// Practice alone: this many players, 1 to 30, take seats and answer
    ///
    /// In a folder of its own, which is removed at the end; or in DIR, which must be empty, and is kept.
    #[arg(long, value_name = "PLAYERS", requires = "lesson", conflicts_with = "new",
          value_parser = clap::value_parser!(u64).range(1..=MOST_PLAYERS))]
    pub(super) rehearse: Option<u64>,

    /// Go on where the class was left: page, rounds and votes
    #[arg(long, group = "instead")]
    pub(super) resume: bool,

    /// Show the class on a second terminal: seats, votes, notes, the clock
    #[arg(long, group = "instead")]
    pub(super) board: bool,

    /// Show the class's page, run and bars to all: nothing that only the teacher may see
    #[arg(long, group = "instead")]
    pub(super) projector: bool,

    /// Print all votes as CSV
    #[arg(long, group = "instead")]
    pub(super) votes: bool,

    /// Print a table for a gradebook as CSV: a row for each seat, a column for each question, round and task
    #[arg(long, group = "instead")]
    pub(super) table: bool,

    /// Write what each seat has predicted beside what came out, a Markdown file a seat
    #[arg(long, group = "instead", requires = "output")]
    pub(super) answers: bool,

    /// The folder for the answers
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
    /// A shipped lesson's name, or a file (.md) [without it: the list of the lessons]
    pub(super) name: Option<String>,

    /// The page, counted from 1
    #[arg(long, value_name = "N", requires = "name", value_parser = one_or_more)]
    pub(super) page: Option<NonZeroU64>,

    /// List the lessons with minutes, level and what each needs, in the order to take them
    #[arg(long, conflicts_with_all = ["name", "page", "printed", "notes"])]
    pub(super) list: bool,

    /// Print a worksheet: it asks, has room for predictions and outcomes, and answers nothing [-o FILE.html: with figures, to print from a browser]
    #[arg(long, group = "printed", requires = "name", conflicts_with = "page")]
    pub(super) handout: bool,

    /// With --handout: the results for afterwards, with the words and numbers of every page
    #[arg(long, requires = "handout")]
    pub(super) results: bool,

    /// Print a sheet for the teacher: goals, minutes, right answers, common wrong ones, and what to explain
    #[arg(long, group = "printed", requires = "name", conflicts_with = "page")]
    pub(super) teacher: bool,

    /// Print what was predicted, in the newest session that holds it, beside what came out: to hand in
    #[arg(long, group = "printed", requires = "name", conflicts_with = "page")]
    pub(super) answers: bool,

    /// Print the frame of the program that the lesson asks for, in this language: it runs, the physics is left out
    #[arg(long, group = "printed", requires = "name", conflicts_with = "page", value_name = "LANGUAGE", value_parser = ["octave", "matlab", "python"])]
    pub(super) frame: Option<String>,

    /// Follow a lab of this login on a second terminal: the notes of its page, what comes next, a clock
    #[arg(long, value_name = "SESSION", num_args = 0..=1, default_missing_value = "", conflicts_with_all = ["name", "page", "printed"])]
    pub(super) notes: Option<String>,

    /// Read and write in this folder and nowhere else; its own lessons come first in the list
    #[arg(long, value_name = "DIR", conflicts_with_all = ["handout", "teacher", "template", "notes"])]
    pub(super) folder: Option<PathBuf>,

    /// Print a small lesson to begin from, with a comment on each part
    #[arg(long, group = "printed", conflicts_with = "name")]
    pub(super) template: bool,

    /// Write what is printed to this file, or to stdout for -; .html for a handout, answers or a teacher's sheet: a page to print from a browser
    #[arg(short, long, requires = "printed", value_name = "FILE")]
    pub(super) output: Option<PathBuf>,

    /// Replace an existing file
    #[arg(long, requires = "output")]
    pub(super) force: bool,

    #[command(flatten)]
    pub(super) look: DisplayArgs,
}

/// The scenario with all that the command line changes in it, so that its run file tells the whole run.
pub(super) fn scenario_of(args: &ScenarioArgs, length: &LengthArgs) -> Result<Scenario, Problems> {
    changed(open(&args.scenario)?, &args.changes, length)
}

/// In place of a file's name: standard input.
pub(super) const STDIN: &str = "-";
pub(super) const STDIN_WORDS: &str = "standard input";

/// Opens what SCENARIO names, which may be standard input.
pub(super) fn open(scenario: &str) -> Result<Document, Problems> {
    if scenario == STDIN {
        return Document::read_from(STDIN_WORDS, io::stdin().lock());
    }
    Document::open(scenario)
}

/// The scenario of `document` with these changes.
pub(super) fn changed(
    mut document: Document,
    changes: &SetArgs,
    length: &LengthArgs,
) -> Result<Scenario, Problems> {
    change(&mut document, changes)?;
    change_length(&mut document, length)?;
    document.scenario()
}

/// Gives the run of `document` the length that the command line asks for, if it does.
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
