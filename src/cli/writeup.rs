//! `gyrolab writeup`: a run as a folder of files for a write-up.

use super::args::{LengthArgs, ScenarioArgs};
use super::progress::{self, Meter};
use super::run::played;
use super::scenario::scenario_of;
use super::{INTERRUPTED, complain, tell};
use crate::export::stream::Ended;
use crate::export::{CsvWriter, Folder};
use crate::study::writeup::figures::figures;
use crate::study::writeup::{CSV, Writeup};
use crate::text::printable::Shown;
use anyhow::Context;
use clap::Args;
use std::fs::{self, File};
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::Arc;

#[derive(Debug, Args)]
pub(super) struct WriteupArgs {
    #[command(flatten)]
    pub(super) scenario: ScenarioArgs,

    /// The folder: a new or an empty one
    #[arg(short, long, value_name = "FOLDER")]
    pub(super) output: PathBuf,

    #[command(flatten)]
    pub(super) length: LengthArgs,

    /// Write into a folder that holds files, and replace those of the same names
    #[arg(long)]
    pub(super) force: bool,
}

pub(super) fn writeup(args: &WriteupArgs) -> anyhow::Result<ExitCode> {
    let scenario = Arc::new(scenario_of(&args.scenario, &args.length)?);
    let (_, interruption) = progress::open(None, false)?;
    let folder = Folder::begin(&args.output, args.force)?;
    let cannot_write = || format!("cannot write {}", Shown(&args.output));
    let csv = File::create(folder.path().join(CSV)).with_context(cannot_write)?;
    let csv = CsvWriter::new(csv, &scenario).with_context(cannot_write)?;
    let mut played = played(&scenario, Some(csv), &interruption).with_context(cannot_write)?;
    if played.ended == Ended::Stopped {
        return Ok(ExitCode::from(INTERRUPTED)); // the folder goes with its temporary name
    }
    let broken = match played.ended {
        Ended::NotFinite(error) => Some(error),
        Ended::Done | Ended::Stopped => None,
    };
    let readouts = played.readouts();
    let mut meter = Meter::new();
    let drawings = figures(&scenario, &readouts, |step, of| {
        meter.show(step, of);
        interruption.go_on()
    });
    meter.clear();
    let Some(drawings) = drawings.map_err(anyhow::Error::msg)? else {
        return Ok(ExitCode::from(INTERRUPTED));
    };
    let writeup = Writeup::new(scenario, readouts, broken, drawings);
    for (name, bytes) in writeup.files()? {
        fs::write(folder.path().join(name), bytes).with_context(cannot_write)?;
    }
    if interruption.may_act_at_once() {
        return Ok(ExitCode::from(INTERRUPTED));
    }
    folder.keep()?;
    tell(format_args!(
        "gyrolab: the write-up is in {}; begin with README.md",
        Shown(&args.output)
    ));
    let Some(error) = broken else {
        return Ok(ExitCode::SUCCESS);
    };
    complain(&anyhow::Error::new(error).context(args.scenario.scenario.clone()));
    Ok(ExitCode::FAILURE)
}
