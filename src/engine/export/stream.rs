//! Plays a run to its end and writes its rows as it goes.

use super::CsvWriter;
use crate::analysis::cost::has_closed_form;
use crate::run::{NotFinite, Simulation, Step};
use std::io::{self, Write};
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

/// Steps per block times points of the body; the number of steps is then limited to 16 to 4096. The watcher is asked once per
/// block.
const EXPORT_BLOCK_STEPS: usize = 1 << 18;
/// A block of steps that are integrated, any of which may take long, ends after this time.
const LONGEST_BLOCK: Duration = Duration::from_millis(100);

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ended {
    Done,
    Stopped,
    /// The numbers stopped being finite; the rows before that are written.
    NotFinite(NotFinite),
}

impl Ended {
    pub fn not_finite(self) -> Option<NotFinite> {
        match self {
            Self::NotFinite(error) => Some(error),
            Self::Done | Self::Stopped => None,
        }
    }
}

/// Plays `simulation` to the step `steps`. To `csv`, if given, it writes the rows that the layout of the CSV asks for, from
/// the present step on. It calls `each` with every step, and `watch` with the step reached and the last one after each block of
/// steps, the last one too; `watch` may stop it.
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
    let block = (EXPORT_BLOCK_STEPS / points).clamp(16, 4096);
    let may_take_long = !has_closed_form(simulation.scenario());
    let layout = csv.as_deref().map(|csv| csv.layout().clone());
    let has_row = |step: &Step| {
        layout
            .as_ref()
            .is_some_and(|layout| layout.has_row(step, steps))
    };
    let mut rows = Vec::new();
    if has_row(simulation.now()) {
        rows.push(simulation.sample());
    }
    let mut stepping = Duration::ZERO;
    loop {
        let begin = Instant::now();
        let end = steps.min(simulation.step_number() + block as u64);
        let mut result = Ok(());
        while simulation.step_number() < end {
            let step = match simulation.step() {
                Ok(step) => step,
                Err(error) => {
                    result = Err(error);
                    break;
                }
            };
            each(step);
            if has_row(step) {
                rows.push(step.sample());
            }
            if may_take_long && begin.elapsed() > LONGEST_BLOCK {
                break;
            }
        }
        stepping += begin.elapsed();
        let last = simulation.now();
        // The last finite step has a row whichever the layout leaves out between.
        let is_left_out = result.is_err() && !has_row(last);
        if is_left_out && layout.as_ref().is_some_and(|layout| layout.has_time(last)) {
            rows.push(last.sample());
        }
        if let Some(csv) = csv.as_deref_mut() {
            rows.iter().try_for_each(|row| csv.write(row))?;
        }
        rows.clear();
        let is_stopped = watch(last.number(), steps).is_break();
        let ended = match result {
            Err(error) => Ended::NotFinite(error),
            Ok(()) if is_stopped => Ended::Stopped,
            Ok(()) if last.number() >= steps => Ended::Done,
            Ok(()) => continue,
        };
        return Ok((ended, stepping));
    }
}
