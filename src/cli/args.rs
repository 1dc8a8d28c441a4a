//! Arguments that several commands have, and those that several files read.

use super::values::{frames, length, one_or_more, positive, setting, steps};
use crate::lab::view::markers::Marker;
use crate::lab::view::theme::Background;
use crate::physics::scheme;
use crate::tui::surroundings::ColourChoice;
use clap::builder::{PossibleValue, PossibleValuesParser};
use clap::{Args, ValueEnum};
use std::num::NonZeroU64;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(super) struct ScenarioArgs {
    /// A preset's name, or a file (.toml or .csv): a scenario, a run file, or a CSV that gyrolab wrote
    pub(super) scenario: String,

    #[command(flatten)]
    pub(super) changes: Changes,
}

#[derive(Clone, Debug, Default, Args)]
pub(super) struct Changes {
    /// Change a value first, such as start.tilt_deg=30 or push.0.force_N=[0,0,-50]; may be repeated
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
    pub(super) fn is_some(&self) -> bool {
        !self.set.is_empty() || self.time_step.is_some() || self.scheme.is_some()
    }
}

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

    /// Ask for a seat of the class in DIR, and open its lab: what ForceCommand runs for a student
    #[arg(long, requires = "folder",
          conflicts_with_all = ["scenario", "set", "time_step", "scheme", "at", "resume", "measured", "commands"])]
    pub(super) seat: bool,

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

#[derive(Clone, Copy, Debug, Default, Args)]
pub(super) struct Look {
    /// Colours: auto honours NO_COLOR [default: as chosen last in the lab, or auto]
    #[arg(long, alias = "colour", value_enum, value_name = "WHEN")]
    pub(super) color: Option<ColourChoice>,

    /// What the colours are for [default: as chosen last, or as COLORFGBG says, or dark]
    #[arg(long, value_enum, value_name = "SCREEN")]
    pub(super) background: Option<Background>,

    /// What dots are made of [default: as chosen last, or by locale and terminal]
    #[arg(long, value_enum, value_name = "KIND")]
    pub(super) markers: Option<Marker>,

    /// Leave the mouse to the terminal, to select text; the key M takes it
    #[arg(long)]
    pub(super) no_mouse: bool,
}

impl ValueEnum for ColourChoice {
    fn value_variants<'a>() -> &'a [Self] {
        &[Self::Auto, Self::Always, Self::Never]
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        Some(PossibleValue::new(match self {
            Self::Auto => "auto",
            Self::Always => "always",
            Self::Never => "never",
        }))
    }
}

impl ValueEnum for Background {
    fn value_variants<'a>() -> &'a [Self] {
        &[Self::Dark, Self::Light]
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        Some(PossibleValue::new(self.name()))
    }
}

impl ValueEnum for Marker {
    fn value_variants<'a>() -> &'a [Self] {
        &Self::ALL
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        Some(PossibleValue::new(self.name()))
    }
}

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
    pub(super) fn is_some(&self) -> bool {
        self.steps.is_some() || self.duration.is_some()
    }
}

#[derive(Debug, Args)]
pub(super) struct ClassArgs {
    /// A shipped lesson's name, or a file (.md) in the folder
    #[arg(required_unless_present_any = ["resume", "board", "votes", "answers"])]
    pub(super) lesson: Option<String>,

    /// The folder of the class
    #[arg(long, value_name = "DIR")]
    pub(super) folder: PathBuf,

    /// Go on where the class was left: page, rounds and votes
    #[arg(long, group = "instead", conflicts_with = "lesson")]
    pub(super) resume: bool,

    /// Show the class on a second terminal: seats, votes, notes, the clock
    #[arg(long, group = "instead", conflicts_with = "lesson")]
    pub(super) board: bool,

    /// Print all votes as CSV
    #[arg(long, group = "instead", conflicts_with = "lesson")]
    pub(super) votes: bool,

    /// Write what each seat has predicted beside what came out, a Markdown file a seat
    #[arg(
        long,
        group = "instead",
        conflicts_with = "lesson",
        requires = "output"
    )]
    pub(super) answers: bool,

    /// The folder for the answers
    #[arg(short, long, requires = "answers", value_name = "FOLDER")]
    pub(super) output: Option<PathBuf>,

    /// Replace existing files
    #[arg(long, requires = "output")]
    pub(super) force: bool,

    #[command(flatten)]
    pub(super) look: Look,
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

    /// Read and write in this folder and nowhere else; its own lessons come first in the list
    #[arg(long, value_name = "DIR", conflicts_with_all = ["handout", "template", "notes"])]
    pub(super) folder: Option<PathBuf>,

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
