//! `gyrolab run`: a run from its start to its end, without a terminal.

use super::args::{LayoutArgs, LengthArgs, ScenarioArgs, scenario_of};
use super::progress::{self, Interrupted, Interruption};
use super::{ended_by, one_on_stdout, print_result, tell_of_rows};
use crate::engine::analysis::health::advise;
use crate::engine::analysis::{Monitor, Readouts};
use crate::engine::export::stream::{self, Ended};
use crate::engine::export::{CsvWriter, RunSummary};
use crate::engine::run::{Clock, Simulation, Step};
use crate::engine::scenario::Scenario;
use crate::engine::text::io_errors::advised;
use crate::engine::text::number::shortest;
use crate::engine::text::printable::PrintablePath;
use anyhow::{Context, anyhow, bail};
use clap::Args;
use std::cell::RefCell;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;
use std::time::Duration;

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

    /// Say all that is known of the run: theory, lag, what a time step does
    #[arg(long, conflicts_with = "json")]
    all: bool,

    /// Give the summary as one JSON object
    #[arg(long)]
    pub(super) json: bool,

    /// Replace an existing file
    #[arg(long)]
    pub(super) force: bool,
}

pub(super) fn run(args: &RunArgs) -> anyhow::Result<ExitCode> {
    let to_stdout = one_on_stdout("run", args.output.as_deref(), args.json);
    let layout = args.layout.layout();
    let scenario = Arc::new(scenario_of(&args.scenario, &args.length)?);
    if layout.begins_after(&scenario) {
        let end = shortest(Clock::end_s(&scenario));
        bail!("no row is left by --from: the run ends at {end} s");
    }
    let output_path = args.output.as_deref().unwrap_or(Path::new("the output"));
    let (output, interruption) = progress::open(args.output.as_deref(), args.force)?;
    let csv = output
        .map(|destination| CsvWriter::with_layout(destination, &scenario, layout))
        .transpose()
        .with_context(|| cannot_write(output_path))?;
    let mut played =
        played(&scenario, csv, |_| {}, &interruption).with_context(|| cannot_write(output_path))?;
    if played.ended == Ended::Stopped {
        bail!(Interrupted);
    }
    if played.rows == Some(0) && played.ended == Ended::Done {
        bail!("no row lies between --from and --to: they are closer than the rows");
    }
    if let Some(rows) = played.output.take() {
        interruption.may_keep()?;
        rows.keep()?;
    }
    interruption.may_act_at_once()?;
    let readouts = progress::with_clock(CHECKING, || played.readouts());
    let summary = RunSummary::new(readouts, played.wall)
        .with_time_steps_of(&scenario)
        .in_full(args.all);
    print_result(&summary, args.output.as_deref(), args.json)?;
    if let Some(rows) = played.rows.filter(|_| !to_stdout) {
        tell_of_rows(rows, output_path);
    }
    let name = args.scenario.scenario.clone();
    let broke = played.ended.not_finite();
    Ok(ended_by(broke.map(|error| anyhow!(error).context(name))))
}

/// What goes on while the readouts at the end of a run are computed.
pub(super) const CHECKING: &str = "comparing the run with the exact motion";

fn cannot_write(path: &Path) -> String {
    if path == Path::new("-") {
        "cannot write to stdout".to_owned()
    } else {
        format!("cannot write {}", PrintablePath(path))
    }
}

/// A run that was played to its end.
pub(super) struct FinishedRun<W> {
    pub(super) ended: Ended,
    /// Time spent on stepping alone.
    pub(super) wall: Duration,
    /// How many rows were written, where there was an output.
    pub(super) rows: Option<u64>,
    /// The output, all rows written to it.
    pub(super) output: Option<W>,
    simulation: Simulation,
    monitor: Monitor,
}

impl<W> FinishedRun<W> {
    /// What is read off it at its end. Where the run is not to be believed, what would mend it is sought, which takes a
    /// while.
    pub(super) fn readouts(&mut self) -> Readouts {
        let health = self.monitor.health(self.simulation.now());
        let is_doubtful = health.is_believed() == Some(false);
        let advice = is_doubtful.then(|| advise(self.simulation.scenario()));
        Readouts::new(
            &self.simulation,
            &mut self.monitor,
            &health,
            advice.as_ref(),
        )
    }
}

/// Plays the run of `scenario` to its end and writes its rows to `csv`; `also` is shown the start and every step.
pub(super) fn played<W: Write>(
    scenario: &Arc<Scenario>,
    mut csv: Option<CsvWriter<W>>,
    mut also: impl FnMut(&Step),
    interruption: &Interruption,
) -> io::Result<FinishedRun<W>> {
    let mut simulation = Simulation::new(Arc::clone(scenario));
    let monitor = RefCell::new(Monitor::new(simulation.now()));
    also(simulation.now());
    // Each step is followed at once; the exact motion is computed after the block, outside the time of stepping.
    let each = |step: &Step| {
        monitor.borrow_mut().record_ahead(step);
        also(step);
    };
    let meter = interruption.meter();
    let ended = stream::play(
        &mut simulation,
        scenario.steps,
        csv.as_mut(),
        each,
        |step, steps| {
            monitor.borrow_mut().catch_up(&mut || meter(step, steps))?;
            meter(step, steps)
        },
    );
    drop(meter);
    let (ended, wall) = ended.map_err(|error| advised(&error))?;
    let rows = csv.as_ref().map(CsvWriter::count);
    let output = csv
        .map(CsvWriter::finish)
        .transpose()
        .map_err(|error| advised(&error))?;
    Ok(FinishedRun {
        ended,
        wall,
        rows,
        output,
        simulation,
        monitor: monitor.into_inner(),
    })
}
