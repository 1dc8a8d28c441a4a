//! Plays a run to its end and writes its rows as it goes.

use super::CsvWriter;
use crate::run::{NotFinite, Sample, Simulation, Step};
use std::io::{self, Write};
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

/// Steps per block times points of the body; the number of steps is then limited to 16 to 4096. The clock and the watcher
/// are asked once per block.
const BLOCK: usize = 1 << 18;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ended {
    Done,
    Stopped,
    /// The numbers stopped being finite; the rows before that are written.
    NotFinite(NotFinite),
}

/// Plays `simulation` to the step `steps`. To `csv`, if given, it writes the rows that the layout of the CSV asks for, from
/// the present step on. It calls `each` with every step, and `watch` with the step reached and the last one after each block of
/// steps; `watch` may stop it.
///
/// Returns how the stream ended, and the time spent on stepping alone.
pub fn play<W: Write>(
    simulation: &mut Simulation,
    steps: u64,
    mut csv: Option<&mut CsvWriter<W>>,
    mut each: impl FnMut(&Step),
    mut watch: impl FnMut(u64, u64) -> ControlFlow<()>,
) -> io::Result<(Ended, Duration)> {
    let points = simulation.scenario().body.mechanics.points().len();
    let block = (BLOCK / points).clamp(16, 4096);
    let mut rows = Vec::with_capacity(if csv.is_some() { block } else { 0 });
    let layout = csv.as_deref().map(|csv| csv.layout().clone());
    let has_row = |step: &Step| {
        let layout = layout.as_ref();
        layout.is_some_and(|layout| layout.has_row(step, steps))
    };
    if let Some(csv) = csv.as_deref_mut().filter(|_| has_row(simulation.now())) {
        csv.write(&simulation.sample())?;
    }
    let mut stepping = Duration::ZERO;
    let mut ended = None;
    while ended.is_none() {
        let begin = Instant::now();
        let result = take_block(simulation, steps, block, |step| {
            each(step);
            if has_row(step) {
                rows.push(step.sample());
            }
        });
        stepping += begin.elapsed();
        if let Some(csv) = csv.as_deref_mut() {
            rows.iter().try_for_each(|row| csv.write(row))?;
        }
        ended = match result {
            Err(error) => {
                write_last(simulation.now(), rows.last(), csv.as_deref_mut())?;
                Some(Ended::NotFinite(error))
            }
            Ok(()) if simulation.step_number() >= steps => Some(Ended::Done),
            Ok(()) => {
                let step = simulation.step_number();
                watch(step, steps).is_break().then_some(Ended::Stopped)
            }
        };
        rows.clear();
    }
    Ok((ended.unwrap_or(Ended::Done), stepping))
}

fn take_block(
    simulation: &mut Simulation,
    steps: u64,
    block: usize,
    mut each: impl FnMut(&Step),
) -> Result<(), NotFinite> {
    let end = steps.min(simulation.step_number() + block as u64);
    while simulation.step_number() < end {
        each(simulation.step()?);
    }
    Ok(())
}

/// Writes the row of the last finite step, unless it is written already: the last row is written whichever rows the layout
/// leaves out between.
fn write_last<W: Write>(
    last: &Step,
    written: Option<&Sample>,
    csv: Option<&mut CsvWriter<W>>,
) -> io::Result<()> {
    let Some(csv) = csv else {
        return Ok(());
    };
    let (step, every) = (last.number(), csv.layout().steps_between());
    let is_written = written.is_some_and(|row| row.step == step) || step.is_multiple_of(every);
    if !is_written && csv.layout().has_time(last) {
        csv.write(&last.sample())
    } else {
        Ok(())
    }
}
