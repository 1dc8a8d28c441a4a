//! `gyrolab show`: the lab's picture as plain text, at one step or after commands.

use super::args::{Changes, MeasuredArgs, size, steps};
use super::new_lab::{DEFAULT, plain_lab};
use super::{print, progress, tell};
use crate::lab::command;
use crate::lab::view::theme::Marker;
use crate::storage::confined::Confined;
use crate::tui::screen;
use anyhow::Context;
use clap::Args;
use std::path::PathBuf;
use std::process::ExitCode;

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

    /// Show what the commands in this file, [[do]] tables, or of stdin for -, lead to from step 0; gyrolab man lists them.
    /// Nobody waits here: wait_s is over at once, and only step, go_to and run_until let the run go on
    #[arg(long = "do", value_name = "FILE")]
    pub(super) commands: Option<PathBuf>,

    #[command(flatten)]
    pub(super) beside: MeasuredArgs,

    /// Columns and lines of the picture
    #[arg(long, value_name = "WIDTHxHEIGHT", default_value = "80x24", value_parser = size)]
    pub(super) size: (u16, u16),

    /// What dots are made of [default: by locale and terminal]
    #[arg(long, value_enum, value_name = "KIND")]
    pub(super) markers: Option<Marker>,
}

pub(super) fn show(args: &ShowArgs) -> anyhow::Result<ExitCode> {
    print_picture(args, None, None)
}

/// Prints the lab's picture at the end of a run, or after commands, which do not leave the folder `confined`; `why` says
/// why there is a picture and not the lab.
pub(super) fn print_picture(
    args: &ShowArgs,
    why: Option<&str>,
    confined: Option<Confined>,
) -> anyhow::Result<ExitCode> {
    let name = args.scenario.as_deref().unwrap_or(DEFAULT);
    let mut lab = plain_lab(name, &args.changes, args.markers)?;
    if let Some(folder) = confined {
        lab.files_mut().confine(folder);
    }
    let beside = &args.beside;
    lab.begin_with_measured(beside.measured.as_deref(), &beside.columns.map)?;
    // What is not there is refused before a picture is promised; commands on stdin are waited for.
    why.iter().for_each(tell);
    let commands = args.commands.as_deref().map(command::open).transpose()?;
    let end = match commands {
        Some(_) => 0,
        None => lab.player().run().scenario().steps,
    };
    let interruption = progress::interruption()?;
    let ended = lab.begin_at(args.at.unwrap_or(end), interruption.meter());
    let mut done = Ok(());
    if let (Ok(()), Some(commands)) = (&ended, commands) {
        lab.take_commands(commands);
        done = lab.finish_script_while(interruption.meter());
    }
    interruption.may_act_at_once()?;
    let picture = screen::text(&lab, false, args.size);
    print(&picture)?;
    ended.with_context(|| name.to_owned())?; // the picture up to there is shown all the same
    done.map_err(anyhow::Error::msg)?;
    Ok(ExitCode::SUCCESS)
}
