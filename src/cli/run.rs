//! `gyrolab run`: a run from its start to its end, without a terminal.

use super::args::{Cli, RunArgs};
use super::{INTERRUPTED, changed, complain};
use crate::export::stream::{self, Ended, Progress};
use crate::export::{CsvWriter, Destination, Summary};
use crate::run::Simulation;
use crate::scenario::{Problems, Scenario};
use anyhow::Context;
use clap::CommandFactory;
use clap::error::ErrorKind;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use signal_hook::consts::TERM_SIGNALS;
use std::io::{self, IsTerminal, Write};
use std::ops::ControlFlow;
use std::path::Path;
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

pub(super) fn run(args: &RunArgs) -> anyhow::Result<ExitCode> {
    let to_stdout = args.output.as_deref() == Some(Path::new("-"));
    if args.json && to_stdout {
        let message =
            "--json and -o - both claim stdout: write the CSV to a file, or leave --json out";
        Cli::command()
            .error(ErrorKind::ArgumentConflict, message)
            .exit();
    }
    let scenario = Arc::new(scenario_of(args)?);
    let mut output = match &args.output {
        Some(path) => {
            let destination = Destination::open(path, args.force)?;
            Some(CsvWriter::new(destination, &scenario).context(cannot_write(path))?)
        }
        None => None,
    };
    let mut simulation = Simulation::new(Arc::clone(&scenario));
    let (ended, wall) = play(&mut simulation, args.every.get(), output.as_mut())
        .with_context(|| cannot_write(args.output.as_deref().unwrap_or(Path::new("the output"))))?;
    if ended == Ended::Stopped {
        return Ok(ExitCode::from(INTERRUPTED)); // what was written so far goes with its temporary name
    }
    if let (Some(csv), Some(path)) = (output, &args.output) {
        csv.finish().with_context(|| cannot_write(path))?.keep()?;
    }
    report(args, &Summary::new(&simulation, wall))?;
    match ended {
        Ended::NotFinite(error) => {
            complain(&anyhow::Error::new(error).context(args.scenario.scenario.clone()));
            Ok(ExitCode::FAILURE)
        }
        Ended::Done | Ended::Stopped => Ok(ExitCode::SUCCESS),
    }
}

/// The scenario with all that the command line changes in it, so that its run file tells the whole run.
fn scenario_of(args: &RunArgs) -> Result<Scenario, Problems> {
    let mut document = changed(&args.scenario.scenario, &args.scenario.changes)?;
    if let Some(steps) = args.steps {
        document.set(&format!("motion.steps={steps}"))?;
    }
    let scenario = document.scenario()?;
    let Some(duration) = args.duration else {
        return Ok(scenario);
    };
    let steps = Simulation::step_at(&scenario, duration).clamp(1, i64::MAX as u64);
    document.set(&format!("motion.steps={steps}"))?;
    document.scenario()
}

fn cannot_write(path: &Path) -> String {
    match path == Path::new("-") {
        true => "cannot write to stdout".to_owned(),
        false => format!("cannot write {}", path.display()),
    }
}

/// Plays the run under the user's eyes: progress on stderr, a signal ends it.
fn play(
    simulation: &mut Simulation,
    every: u64,
    output: Option<&mut CsvWriter<Destination>>,
) -> io::Result<(Ended, Duration)> {
    let steps = simulation.scenario().steps;
    let interrupted = interruption()?;
    let mut meter = Meter::new();
    let ended = stream::play(simulation, steps, every, output, |progress| {
        meter.show(progress);
        match interrupted.load(Ordering::Relaxed) {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        }
    });
    meter.clear();
    ended
}

/// A flag that the first signal to end raises; a second one ends the process on the spot, should it be stuck.
fn interruption() -> io::Result<Arc<AtomicBool>> {
    let flag = Arc::new(AtomicBool::new(false));
    for &signal in TERM_SIGNALS {
        signal_hook::flag::register_conditional_shutdown(
            signal,
            INTERRUPTED.into(),
            Arc::clone(&flag),
        )?;
        signal_hook::flag::register(signal, Arc::clone(&flag))?;
    }
    Ok(flag)
}

/// Steps, rate and time left on stderr, for runs that take more than a second and have somebody to watch them.
struct Meter {
    begin: Instant,
    bar: Option<ProgressBar>,
}

impl Meter {
    const QUIET: Duration = Duration::from_secs(1);

    fn new() -> Self {
        Self {
            begin: Instant::now(),
            bar: None,
        }
    }

    fn show(&mut self, progress: &Progress) {
        if self.begin.elapsed() < Self::QUIET || !io::stderr().is_terminal() {
            return;
        }
        let bar = self.bar.get_or_insert_with(|| {
            let bar = ProgressBar::with_draw_target(
                Some(progress.steps),
                ProgressDrawTarget::stderr_with_hz(4),
            );
            let template = "{wide_bar} step {human_pos} of {human_len}, {per_sec}, {eta} left";
            let style = ProgressStyle::with_template(template)
                .unwrap_or_else(|_| ProgressStyle::default_bar());
            bar.with_style(style.progress_chars("=> "))
                .with_elapsed(self.begin.elapsed())
        });
        bar.set_position(progress.step);
    }

    fn clear(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

/// The summary: on stdout, or on stderr where stdout or a file has the rows.
fn report(args: &RunArgs, summary: &Summary) -> anyhow::Result<()> {
    if args.output.is_some() {
        writeln!(io::stderr(), "{summary}")?;
    }
    let mut stdout = io::stdout().lock();
    if args.json {
        writeln!(stdout, "{}", serde_json::to_string(summary)?)?;
    } else if args.output.is_none() {
        writeln!(stdout, "{summary}")?;
    }
    Ok(stdout.flush()?)
}
