//! `gyrolab run`: a run from its start to its end, without a terminal.

use super::args::RunArgs;
use super::progress::{self, Interruption, Meter};
use super::scenario::scenario_of;
use super::{INTERRUPTED, complain, print, refuse, tell};
use crate::analysis::health::{Advice, advise};
use crate::analysis::{Health, Monitor, Readouts};
use crate::export::stream::{self, Ended};
use crate::export::{CsvWriter, Destination, Summary};
use crate::run::{Clock, Simulation, Step};
use crate::text::number::shortest;
use crate::text::printable::Shown;
use anyhow::{Context, bail};
use clap::error::ErrorKind;
use std::cell::RefCell;
use std::io;
use std::ops::ControlFlow;
use std::path::Path;
use std::process::ExitCode;
use std::sync::Arc;
use std::time::Duration;

pub(super) fn run(args: &RunArgs) -> anyhow::Result<ExitCode> {
    let to_stdout = args
        .output
        .as_deref()
        .is_some_and(Destination::is_for_stdout);
    if args.json && to_stdout {
        let message =
            "--json and -o - both claim stdout: write the CSV to a file, or leave --json out";
        refuse("run", ErrorKind::ArgumentConflict, message);
    }
    let layout = args.layout.layout();
    let scenario = Arc::new(scenario_of(&args.scenario, &args.length)?);
    if layout.begins_after(&scenario) {
        let end = shortest(Clock::end_s(&scenario));
        bail!("no row is left by --from: the run ends at {end} s");
    }
    let output_path = args.output.as_deref().unwrap_or(Path::new("the output"));
    let (output, interruption) = progress::open(args.output.as_deref(), args.force)?;
    let mut output = output
        .map(|destination| CsvWriter::with_layout(destination, &scenario, layout))
        .transpose()
        .with_context(|| cannot_write(output_path))?;
    let mut simulation = Simulation::new(Arc::clone(&scenario));
    let mut monitor = Monitor::new(simulation.now());
    let (ended, wall) = play(
        &mut simulation,
        &mut monitor,
        output.as_mut(),
        &interruption,
    )
    .with_context(|| cannot_write(output_path))?;
    if ended == Ended::Stopped {
        return Ok(ExitCode::from(INTERRUPTED)); // what was written so far goes with its temporary name
    }
    let mut rows = None;
    if let Some(csv) = output {
        rows = Some(csv.count());
        if csv.count() == 0 && ended == Ended::Done {
            bail!("no row lies between --from and --to: they are closer than the rows");
        }
        csv.finish()
            .with_context(|| cannot_write(output_path))?
            .keep()?;
    }
    if interruption.may_act_at_once() {
        return Ok(ExitCode::from(INTERRUPTED));
    }
    let health = monitor.health(simulation.now());
    let advice = advice(&health, &simulation);
    let readouts = Readouts::new(&simulation, &mut monitor, &health, advice.as_ref());
    let summary = Summary::new(readouts, wall).with_time_steps_of(&scenario);
    report(args, &summary)?;
    if let Some(rows) = rows.filter(|_| !to_stdout) {
        let plural = if rows == 1 { "" } else { "s" };
        tell(format_args!(
            "gyrolab: {rows} row{plural} in {}",
            Shown(output_path)
        ));
    }
    match ended {
        Ended::NotFinite(error) => {
            complain(&anyhow::Error::new(error).context(args.scenario.scenario.clone()));
            Ok(ExitCode::FAILURE)
        }
        Ended::Done | Ended::Stopped => Ok(ExitCode::SUCCESS),
    }
}

fn cannot_write(path: &Path) -> String {
    match path == Path::new("-") {
        true => "cannot write to stdout".to_owned(),
        false => format!("cannot write {}", Shown(path)),
    }
}

/// Plays the run under the user's eyes: progress on stderr, a signal ends it.
fn play(
    simulation: &mut Simulation,
    monitor: &mut Monitor,
    output: Option<&mut CsvWriter<Destination>>,
    interruption: &Interruption,
) -> io::Result<(Ended, Duration)> {
    let steps = simulation.scenario().steps;
    let mut meter = Meter::new();
    // Each step is followed at once and held against the exact motion after its block: that is no stepping.
    let monitor = RefCell::new(monitor);
    let each = |step: &Step| monitor.borrow_mut().follow_ahead(step);
    let ended = stream::play(simulation, steps, output, each, |progress| {
        monitor.borrow_mut().catch_up();
        meter.show(progress.step, progress.steps);
        match interruption.has_come() {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        }
    });
    meter.clear();
    ended
}

/// The summary: on stdout, or on stderr where stdout or a file has the rows.
fn report(args: &RunArgs, summary: &Summary) -> anyhow::Result<()> {
    if args.output.is_some() {
        tell(summary);
    }
    if args.json {
        print(&format!("{}\n", serde_json::to_string(summary)?))?;
    } else if args.output.is_none() {
        print(&format!("{summary}\n"))?;
    }
    Ok(())
}

/// What would mend the run, sought only where it is not to be believed.
fn advice(health: &Health, simulation: &Simulation) -> Option<Advice> {
    (health.is_believed() == Some(false)).then(|| advise(simulation.scenario()))
}
