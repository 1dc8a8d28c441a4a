//! `gyrolab writeup`: a run as a folder of files for a write-up.

use super::args::scenario_of;
use super::args::{LengthArgs, MapArgs, ScenarioArgs};
use super::progress::{self, Interrupted, Interruption};
use super::run::CHECKING;
use super::{ended_by, tell, tell_notes};
use crate::engine::data::{self, MeasuredData, doubts};
use crate::engine::export::stream::Ended;
use crate::engine::export::{CsvWriter, OutputFolder, PlayedRun};
use crate::engine::journal::changed::Original;
use crate::engine::scenario::{Document, Scenario};
use crate::engine::text::io_errors::advised;
use crate::engine::text::printable::{PrintablePath, printable};
use crate::report::writeup::figures::{figures, recorder};
use crate::report::writeup::{CSV, MeasuredComparison, Writeup};
use crate::studies::verify::FileComparison;
use anyhow::{Context, anyhow, ensure};
use clap::Args;
use std::fs::{self, File};
use std::io::Write;
use std::path::{Path, PathBuf};
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

    /// Add measured data: a CSV with a column t_s, or data that come with gyrolab (heidelberg-spin-decay); a copy, figures
    /// of them and of measured less run, and chi^2
    #[arg(long, value_name = "FILE")]
    pub(super) measured: Option<String>,

    #[command(flatten)]
    pub(super) columns: MapArgs,

    /// Write into a folder that holds files, and replace those of the same names
    #[arg(long)]
    pub(super) force: bool,
}

pub(super) fn writeup(args: &WriteupArgs) -> anyhow::Result<ExitCode> {
    let scenario = marked(
        scenario_of(&args.scenario, &args.length)?,
        &args.scenario.scenario,
    );
    let data = args
        .measured
        .as_deref()
        .map(|name| measured(name, &args.columns))
        .transpose()?;
    if let Some(measured) = &data {
        tell_notes(&doubts(measured, &scenario));
    }
    let beside = data.map(MeasuredComparison::new);
    let interruption = progress::interruption()?;
    let folder = OutputFolder::begin(&args.output, args.force)?;
    let cannot_write = || format!("cannot write {}", PrintablePath(&args.output));
    let csv = CsvWriter::new(
        File::create(folder.path().join(CSV)).with_context(cannot_write)?,
        &scenario,
    )
    .with_context(cannot_write)?;
    let (writeup, _) = made(scenario, beside, Some(csv), cannot_write, &interruption)?;
    for (name, bytes) in progress::with_clock("drawing the figures", || writeup.files())? {
        let written = fs::write(folder.path().join(name), bytes);
        written
            .map_err(|error| advised(&error))
            .with_context(cannot_write)?;
    }
    interruption.may_keep()?;
    let others = folder.keep()?;
    tell(format_args!(
        "gyrolab: the write-up is in {}; begin with README.md",
        PrintablePath(&args.output)
    ));
    if !others.is_empty() {
        tell(format_args!(
            "gyrolab: not of this write-up, left as found: {}",
            printable(&others.join(", "))
        ));
    }
    let name = args.scenario.scenario.clone();
    let broken = writeup.broken;
    Ok(ended_by(broken.map(|error| anyhow!(error).context(name))))
}

/// The write-up of the run of `scenario`, and of the measured data of that name, once more. Its rows are compared with those
/// of the file `csv`, where that is there.
pub(super) fn again(
    scenario: Arc<Scenario>,
    data: Option<&str>,
    csv: &Path,
    interruption: &Interruption,
) -> anyhow::Result<(Writeup, Option<FileComparison>)> {
    let measured_data = data
        .map(|name| measured(name, &MapArgs::default()))
        .transpose()?;
    let beside = measured_data.map(MeasuredComparison::new);
    let cannot_read = || format!("{}: cannot be read", PrintablePath(csv));
    let rows = csv
        .is_file()
        .then(|| CsvWriter::new(FileComparison::open(csv)?, &scenario))
        .transpose()
        .with_context(cannot_read)?;
    made(scenario, beside, rows, cannot_read, interruption)
}

/// The write-up of the run of `scenario`, which is played, and its rows written to `csv`.
fn made<W: Write>(
    scenario: Arc<Scenario>,
    mut beside: Option<MeasuredComparison>,
    mut csv: Option<CsvWriter<W>>,
    cannot: impl Fn() -> String,
    interruption: &Interruption,
) -> anyhow::Result<(Writeup, Option<W>)> {
    let mut recording = recorder(&scenario, beside.as_ref());
    let mut run = PlayedRun::play(
        &scenario,
        csv.as_mut(),
        |step| recording.follow(step),
        interruption.meter(),
    )
    .map_err(|error| advised(&error))
    .with_context(&cannot)?;
    let output = csv
        .map(CsvWriter::finish)
        .transpose()
        .map_err(|error| advised(&error))
        .with_context(&cannot)?;
    ensure!(run.ended != Ended::Stopped, Interrupted);
    let broken = run.ended.not_finite();
    let readouts = progress::with_clock(CHECKING, || run.readouts());
    if let Some(beside) = &mut beside {
        let end_s = readouts.sample.time_s;
        let held = progress::with_clock("comparing the run with the measured data", || {
            beside.hold(&scenario, end_s, &|| !interruption.has_come())
        });
        ensure!(held.map_err(anyhow::Error::msg)?, Interrupted);
    }
    let drawings = figures(
        &scenario,
        &readouts,
        recording.end(broken),
        beside.as_ref(),
        interruption.meter(),
    );
    let writeup = Writeup {
        scenario,
        readouts,
        broken,
        beside,
        drawings: drawings.map_err(anyhow::Error::msg)?.ok_or(Interrupted)?,
    };
    Ok((writeup, output))
}

/// `scenario`; where the command line has changed its motion, its words say so, as in the lab.
fn marked(scenario: Scenario, name: &str) -> Arc<Scenario> {
    let scenario = Arc::new(scenario);
    let opened = Document::open(name)
        .and_then(|document| document.scenario())
        .map_or_else(|_| Arc::clone(&scenario), Arc::new);
    Original::find(name, &opened).flag_stale_text(&scenario)
}

/// Measured data that stand beside a run.
pub(super) fn measured(name: &str, columns: &MapArgs) -> anyhow::Result<MeasuredData> {
    let measured = data::open_with(name, &columns.options())?;
    tell_notes(&measured.notes());
    measured.series()?; // a table of runs is refused before anything is run
    Ok(measured)
}
