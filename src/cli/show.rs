//! `gyrolab show`: the lab's picture as plain text, at one step or after commands.

use super::args::{Changes, Markers};
use super::new_lab::{DEFAULT, lab};
use super::progress::{self, Meter};
use super::values::{size, steps};
use super::{INTERRUPTED, print, tell};
use crate::lab::Lab;
use crate::lab::command;
use crate::lab::view::theme::{Background, Theme};
use crate::run::NotFinite;
use crate::storage::confined::Confined;
use crate::tui::screen;
use anyhow::Context;
use clap::Args;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::{Duration, Instant};

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

/// Prints the lab's picture at the end of a run, or after commands.
pub(super) fn show(args: &ShowArgs) -> anyhow::Result<ExitCode> {
    print_picture(Picture {
        why: None,
        confined: None,
        name: args.scenario.as_deref().unwrap_or(DEFAULT),
        changes: &args.changes,
        at: args.at,
        commands: args.commands.as_deref(),
        measured: args.measured.as_deref(),
        size: args.size,
        markers: args.markers,
    })
}

/// What a picture is to show.
pub(super) struct Picture<'a> {
    /// Why there is a picture and not the lab, where that is to be said.
    pub(super) why: Option<String>,
    /// The folder that its commands do not leave, if there is one.
    pub(super) confined: Option<Confined>,
    pub(super) name: &'a str,
    pub(super) changes: &'a Changes,
    pub(super) at: Option<u64>,
    pub(super) commands: Option<&'a Path>,
    /// Measured data beside the run.
    pub(super) measured: Option<&'a str>,
    /// Columns and lines.
    pub(super) size: (u16, u16),
    pub(super) markers: Option<Markers>,
}

pub(super) fn print_picture(wanted: Picture<'_>) -> anyhow::Result<ExitCode> {
    let plain = Theme {
        colour: false,
        background: Background::Dark,
    };
    let mut lab = lab(wanted.name, wanted.changes, wanted.markers, plain, false)?;
    if let Some(folder) = wanted.confined {
        lab.files_mut().confine(folder);
    }
    lab.begin_with_measured(wanted.measured)?;
    // What is not there is refused before a picture is promised; commands on stdin are waited for.
    wanted.why.iter().for_each(tell);
    let commands = wanted.commands.map(command::open).transpose()?;
    let end = match commands {
        Some(_) => 0,
        None => lab.player().run().scenario().steps,
    };
    let (_, interruption) = progress::open(None, false)?;
    let go_on = |_, _| interruption.go_on();
    let ended = go_to(&mut lab, wanted.at.unwrap_or(end), go_on);
    let mut done = Ok(());
    if let (Ok(()), Some(commands)) = (&ended, commands) {
        lab.take_commands(commands);
        let mut meter = Meter::new();
        done = lab.finish_script_while(|step, of| {
            meter.show(step, of);
            go_on(step, of)
        });
        meter.clear();
    }
    if interruption.may_act_at_once() {
        return Ok(ExitCode::from(INTERRUPTED));
    }
    let picture = screen::text(&lab, false, wanted.size);
    print(&picture)?;
    ended.with_context(|| wanted.name.to_owned())?; // the picture up to there is shown all the same
    done.map_err(anyhow::Error::msg)?;
    Ok(ExitCode::SUCCESS)
}

/// Plays from the start to `step`, a part at a time and while `go_on` says so, with progress where that takes long and
/// stderr is a terminal.
///
/// # Errors
/// Where the numbers stop being finite on the way.
pub(super) fn go_to(
    lab: &mut Lab,
    step: u64,
    mut go_on: impl FnMut(u64, u64) -> ControlFlow<()>,
) -> Result<(), NotFinite> {
    const LOOK: Duration = Duration::from_millis(100);
    let mut meter = Meter::new();
    let mut part = 1_u64;
    loop {
        let (here, begin) = (lab.player().playback().step_number(), Instant::now());
        let arrived = lab.begin_at(here.saturating_add(part).min(step));
        let here = lab.player().playback().step_number();
        if arrived.is_err() || here >= step || go_on(here, step).is_break() {
            meter.clear();
            return arrived;
        }
        meter.show(here, step);
        part = if begin.elapsed() < LOOK {
            part.saturating_mul(2)
        } else {
            (part / 2).max(1)
        };
    }
}
