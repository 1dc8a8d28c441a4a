//! `gyrolab run`: plays a run from start to end, without a terminal.

use super::args::{LengthArgs, ScenarioArgs, changed, open};
use super::layout_args::LayoutArgs;
use super::progress::{self, Interrupted, Interruption};
use super::{ended_by, one_on_stdout, print_result, tell_of_rows};
use crate::engine::analysis::cost;
use crate::engine::export::columns::DISTANCE;
use crate::engine::export::layout::{LayoutFile, above_run_file};
use crate::engine::export::stream::Ended;
use crate::engine::export::{CsvLayout, CsvWriter, PlayedRun, RunSummary};
use crate::engine::run::Clock;
use crate::engine::scenario::{Document, Problems, Scenario};
use crate::engine::text::io_errors::advised;
use crate::engine::text::number::shortest;
use crate::engine::text::printable::PrintablePath;
use anyhow::{Context, anyhow, bail};
use clap::Args;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;

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

    /// Print all information on the run, including theory, lag, and effects of the time step
    #[arg(long, conflicts_with = "json")]
    all: bool,

    /// Print the summary as one JSON object
    #[arg(long)]
    pub(super) json: bool,

    /// Replace an existing file
    #[arg(long)]
    pub(super) force: bool,
}

pub(super) fn run(args: &RunArgs) -> anyhow::Result<ExitCode> {
    let to_stdout = one_on_stdout("run", args.output.as_deref(), args.json);
    let document = open(&args.scenario.scenario)?;
    let (scenario, layout) = laid_out(document, &args.scenario, &args.length, &args.layout)?;
    if args.output.is_some() && layout.begins_after(&scenario) {
        let end = shortest(Clock::end_s(&scenario));
        bail!("--from leaves no row: the run ends at {end} s");
    }
    if layout.names().contains(&DISTANCE)
        && let Some(why) = cost::why_exact_unavailable(&scenario)
    {
        bail!("the column {DISTANCE} cannot be computed: {why}: give a shorter --duration");
    }
    let output_path = args.output.as_deref().unwrap_or(Path::new("the output"));
    let (output, interruption) = progress::open(args.output.as_deref(), args.force)?;
    let cannot_write = || cannot_write(output_path);
    let mut csv = output
        .map(|destination| CsvWriter::with_layout(destination, &scenario, layout))
        .transpose()
        .with_context(cannot_write)?;
    let mut played = PlayedRun::play(&scenario, csv.as_mut(), |_| {}, interruption.meter())
        .map_err(|error| advised(&error))
        .with_context(cannot_write)?;
    let rows = csv.as_ref().map(CsvWriter::count);
    let written = csv
        .map(CsvWriter::finish)
        .transpose()
        .map_err(|error| advised(&error))
        .with_context(cannot_write)?;
    if played.ended == Ended::Stopped {
        bail!(Interrupted);
    }
    if rows == Some(0) && played.ended == Ended::Done {
        bail!("there is no row between --from and --to: choose times further apart than the rows");
    }
    if let Some(file) = written {
        interruption.may_keep()?;
        file.keep()?;
    }
    interruption.may_act_at_once()?;
    let readouts = progress::with_clock(CHECKING, || played.readouts());
    let summary = RunSummary::new(readouts, played.wall)
        .with_time_steps_of(&scenario)
        .in_full(args.all);
    print_result(&summary, args.output.as_deref(), args.json)?;
    if let Some(rows) = rows.filter(|_| !to_stdout) {
        tell_of_rows(rows, output_path);
    }
    let name = args.scenario.scenario.clone();
    let broke = played.ended.not_finite();
    Ok(ended_by(broke.map(|error| anyhow!(error).context(name))))
}

/// Computes the CSV that the command writes.
pub(super) fn csv(args: &RunArgs, interruption: &Interruption) -> anyhow::Result<Vec<u8>> {
    let document = open(&args.scenario.scenario)?;
    let (scenario, layout) = laid_out(document, &args.scenario, &args.length, &args.layout)?;
    let mut csv = CsvWriter::with_layout(Vec::new(), &scenario, layout)?;
    let played = PlayedRun::play(&scenario, Some(&mut csv), |_| {}, interruption.meter())?;
    match played.ended {
        Ended::Done => Ok(csv.finish()?),
        Ended::Stopped => bail!(Interrupted),
        Ended::NotFinite(error) => bail!(error),
    }
}

/// Applies the changes of the command line to `document`. Returns its scenario, and the layout of its CSV: as in the header of
/// a CSV, with the options over it.
pub(super) fn laid_out(
    document: Document,
    scenario: &ScenarioArgs,
    length: &LengthArgs,
    layout: &LayoutArgs,
) -> anyhow::Result<(Arc<Scenario>, CsvLayout)> {
    let mut of_header = layout_in_header(&document)?;
    if scenario.changes.is_some() || length.is_some() {
        of_header.note = None; // it describes another run
    }
    let layout = layout.layout(of_header);
    let scenario = changed(document, &scenario.changes, length)?;
    Ok((Arc::new(scenario), layout))
}

/// Returns the layout in the header of a run's CSV, so that the new CSV has the same layout. Other documents have none:
/// a fit's CSV has the fit above its run file.
fn layout_in_header(document: &Document) -> Result<LayoutFile, Problems> {
    let header = document.header_of_csv().unwrap_or_default();
    let above: toml::Table = above_run_file(header).parse().unwrap_or_default();
    if above.contains_key("fit") {
        return Ok(LayoutFile::default());
    }
    match CsvLayout::read(header) {
        Ok(layout) => Ok(layout.file().clone()),
        Err(problem) => Err(Problems::one(document.origin(), problem)),
    }
}

/// Progress message while the readouts are computed at the end of a run.
pub(super) const CHECKING: &str = "comparing the run with the exact motion";

fn cannot_write(path: &Path) -> String {
    if path == Path::new("-") {
        "cannot write to stdout".to_owned()
    } else {
        format!("cannot write {}", PrintablePath(path))
    }
}
