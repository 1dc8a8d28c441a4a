//! How large the CSV of a run will be.

use crate::export::{COLUMNS, CsvWriter};
use crate::run::{Clock, Sample, Simulation};
use crate::scenario::Scenario;
use std::io;
use std::num::NonZeroU64;
use std::sync::Arc;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Estimate {
    /// Number of rows. The export has fewer only if the numbers stop being finite.
    pub rows: u64,
    /// Number of bytes, within a few percent.
    pub bytes: u64,
}

/// Estimates the size of the export of `scenario` with every `every`-th row. It takes a few milliseconds: it writes
/// 64 rows with the numbers of the run's beginning and with steps and times spread over the whole run.
pub fn estimate(scenario: &Arc<Scenario>, every: NonZeroU64) -> Estimate {
    let rows = rows(scenario.steps, every.get());
    let text = sample_rows(scenario, every.get()).unwrap_or_default(); // writing to memory does not fail
    let text = String::from_utf8_lossy(&text);
    let lines = text
        .lines()
        .rev()
        .take_while(|line| !line.starts_with(COLUMNS[0].name));
    let lengths: Vec<_> = lines.map(|line| line.len() + 1).collect();
    let few: usize = lengths.iter().sum();
    let row = few as f64 / lengths.len().max(1) as f64;
    Estimate {
        rows,
        bytes: ((row * rows as f64).round() as u64).saturating_add((text.len() - few) as u64),
    }
}

/// The number of rows of a run that ends at step `last`: rows 0, `every`, twice `every` and so on, and the last.
fn rows(last: u64, every: u64) -> u64 {
    last / every + 1 + u64::from(!last.is_multiple_of(every))
}

/// A CSV of 64 rows that have the numbers of the run's beginning, and steps and times spread over the whole run.
fn sample_rows(scenario: &Arc<Scenario>, every: u64) -> io::Result<Vec<u8>> {
    const ROWS: u64 = 64;
    let points = scenario.body.mechanics.points().len() as u64;
    let apart = ((1 << 15) / points).clamp(4, 32); // steps between rows; a step of a larger body takes longer
    let apart = apart.min(scenario.steps / ROWS).max(1);
    let mut simulation = Simulation::new(Arc::clone(scenario));
    let mut csv = CsvWriter::new(Vec::new(), scenario)?;
    for row in 0..ROWS {
        let part = row as f64 / (ROWS - 1) as f64;
        let step = (part * scenario.steps as f64) as u64 / every * every;
        csv.write(&Sample {
            step,
            time_s: Clock::at(scenario, step).time_s(step),
            ..simulation.sample()
        })?;
        let _ = simulation.step_to(((row + 1) * apart).min(scenario.steps)); // where the numbers stop being finite it repeats the last state
    }
    csv.finish()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_row_count_is_the_number_of_rows_written() {
        for (last, every, count) in [(0, 1, 1), (10, 1, 11), (10, 5, 3), (10, 7, 3), (10, 20, 2)] {
            assert_eq!(rows(last, every), count, "{last} {every}");
        }
    }
}
