//! `gyrolab writeup`: a run as a folder of files for a write-up.

use super::args::{LengthArgs, MapArgs, ScenarioArgs, open};
use super::fit::again::{FitCopy, command_of};
use super::layout_args::LayoutArgs;
use super::progress::{self, Interrupted, Interruption};
use super::run::{CHECKING, laid_out};
use super::{ended_by, tell, tell_notes};
use crate::engine::data::{self, MeasuredData, doubts};
use crate::engine::export::stream::Ended;
use crate::engine::export::{CsvLayout, CsvWriter, OutputFolder, PlayedRun};
use crate::engine::journal::changed::Original;
use crate::engine::scenario::head::Head;
use crate::engine::scenario::{Document, Scenario};
use crate::engine::text::io_errors::advised;
use crate::engine::text::printable::{PrintablePath, printable};
use crate::report::writeup::figures::{figures, recorder};
use crate::report::writeup::{
    CSV, DocumentFormats, ExactNumbers, MeasuredComparison, TEX_FILE, WRITEUP_PAGE, Writeup,
};
use crate::studies::verify::FileComparison;
use anyhow::{Context, anyhow, ensure};
use clap::{Args, ValueEnum};
use std::fs::{self, File};
use std::io::{self, BufReader, Write};
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

    #[command(flatten)]
    layout: LayoutArgs,

    /// Write the document in one format only: md (README.md) or tex (report.tex and refs.bib) [default: both]
    #[arg(long, value_enum)]
    format: Option<DocumentFormat>,

    /// Write into a folder that holds files, and replace those of the same names
    #[arg(long)]
    pub(super) force: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum DocumentFormat {
    Md,
    Tex,
}

impl WriteupArgs {
    fn formats(&self) -> DocumentFormats {
        DocumentFormats {
            markdown: self.format != Some(DocumentFormat::Tex),
            tex: self.format != Some(DocumentFormat::Md),
        }
    }
}

pub(super) fn writeup(args: &WriteupArgs) -> anyhow::Result<ExitCode> {
    let name = &args.scenario.scenario;
    let document = open(name)?;
    if let Some(command) = command_of(&document) {
        return fit_writeup(args, &command);
    }
    let (scenario, layout) = laid_out(document, &args.scenario, &args.length, &args.layout)?;
    ensure!(
        !layout.begins_after(&scenario),
        "no row is left by --from: the run ends before that time"
    );
    let scenario = marked(&scenario, name);
    let data = args
        .measured
        .as_deref()
        .map(|file| measured(file, &args.columns))
        .transpose()?;
    if let Some(measured) = &data {
        tell_notes(&doubts(measured, &scenario));
    }
    let beside = data.map(MeasuredComparison::new);
    let interruption = progress::interruption()?;
    let folder = OutputFolder::begin(&args.output, args.force)?;
    let cannot_write = || format!("cannot write {}", PrintablePath(&args.output));
    let csv = CsvWriter::with_layout(
        File::create(folder.path().join(CSV)).with_context(cannot_write)?,
        &scenario,
        layout,
    )
    .with_context(cannot_write)?;
    let (writeup, _) = made(scenario, beside, Some(csv), cannot_write, &interruption)?;
    let formats = args.formats();
    let files = progress::with_clock("drawing the figures", || writeup.files(formats))?;
    finish(args, folder, files, &interruption)?;
    let broken = writeup.broken;
    Ok(ended_by(
        broken.map(|error| anyhow!(error).context(name.clone())),
    ))
}

/// Writes the write-up of the fit `command`.
fn fit_writeup(args: &WriteupArgs, command: &str) -> anyhow::Result<ExitCode> {
    ensure!(
        !args.scenario.changes.is_some() && !args.length.is_some() && args.measured.is_none(),
        "a write-up of a fit takes neither changes of the run nor --measured: the fit has both"
    );
    let interruption = progress::interruption()?;
    let folder = OutputFolder::begin(&args.output, args.force)?;
    let csv = Path::new(&args.scenario.scenario);
    let from = csv.parent().unwrap_or(Path::new(""));
    let fit = FitCopy::begin(command, from, folder.path())?;
    let files = fit.files(folder.path(), args.formats(), &interruption)?;
    finish(args, folder, files, &interruption)?;
    Ok(ExitCode::SUCCESS)
}

/// Writes `files` into `folder`, keeps it, and says where it is.
fn finish(
    args: &WriteupArgs,
    folder: OutputFolder,
    files: Vec<(String, Vec<u8>)>,
    interruption: &Interruption,
) -> anyhow::Result<()> {
    for (file, bytes) in files {
        fs::write(folder.path().join(file), bytes)
            .map_err(|error| advised(&error))
            .with_context(|| format!("cannot write {}", PrintablePath(&args.output)))?;
    }
    interruption.may_keep()?;
    let others = folder.keep()?;
    let first = if args.formats().markdown {
        WRITEUP_PAGE
    } else {
        TEX_FILE
    };
    tell(format_args!(
        "gyrolab: the write-up is in {}; begin with {first}",
        PrintablePath(&args.output)
    ));
    if !others.is_empty() {
        tell(format_args!(
            "gyrolab: not of this write-up, left as found: {}",
            printable(&others.join(", "))
        ));
    }
    Ok(())
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
        .then(|| compared_with(csv, &scenario))
        .transpose()
        .with_context(cannot_read)?;
    made(scenario, beside, rows, cannot_read, interruption)
}

/// Compares the rows of the run of `scenario` with those of the file `csv`, which has rows and columns as its header says.
fn compared_with(csv: &Path, scenario: &Scenario) -> io::Result<CsvWriter<FileComparison>> {
    let head = Head::read(&mut BufReader::new(File::open(csv)?))?;
    let header = head.header().unwrap_or_default();
    // A header that cannot be read is a difference, which the comparison finds.
    let layout = CsvLayout::read(&header).unwrap_or_default();
    let mut comparison = FileComparison::open(csv)?;
    comparison.delimiter = layout.delimiter();
    CsvWriter::with_layout(comparison, scenario, layout)
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
    let exact = ExactNumbers::play(&scenario, &readouts, interruption.meter());
    let exact = exact.ok_or(Interrupted)?;
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
        exact,
        broken,
        beside,
        drawings: drawings.map_err(anyhow::Error::msg)?.ok_or(Interrupted)?,
    };
    Ok((writeup, output))
}

/// `scenario`; where the command line has changed its motion, its words say so, as in the lab.
fn marked(scenario: &Arc<Scenario>, name: &str) -> Arc<Scenario> {
    let opened = Document::open(name)
        .and_then(|document| document.scenario())
        .map_or_else(|_| Arc::clone(scenario), Arc::new);
    Original::find(name, &opened).flag_stale_text(scenario)
}

/// Measured data that stand beside a run.
pub(super) fn measured(name: &str, columns: &MapArgs) -> anyhow::Result<MeasuredData> {
    let measured = data::open_with(name, &columns.options())?;
    tell_notes(&measured.notes());
    measured.series()?; // a table of runs is refused before anything is run
    Ok(measured)
}
