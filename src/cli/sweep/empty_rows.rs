//! The rows of a sweep that hold no readouts, and why: told at the end of every command that makes the file or finds it.

use crate::cli::progress::Interruption;
use crate::cli::tell;
use crate::study::sweep::{RowsThere, Sweep, SweepRow};
use crate::text::printable::printable_lines;
use std::time::{Duration, Instant};

/// So many rows are told one by one.
const MOST: usize = 8;
/// A file does not say why a row is empty. So much time is spent on finding out.
const PATIENCE: Duration = Duration::from_secs(1);

/// Where a run went well but none of the wanted numbers can be stated.
const NOTHING_STATED: &str = "none of its readouts can be stated";
/// Where the time was not enough to find out.
const NOT_FOUND_OUT: &str = "gyrolab run with these values says why";

/// The rows without readouts: those that a file had before, and those that were computed now.
#[derive(Debug, Default)]
pub(super) struct EmptyRows {
    found: RowsThere,
    computed: u64,
    /// The first of those that were computed now, in words.
    told: Vec<String>,
}

impl EmptyRows {
    /// Those among the rows that stand in a file.
    pub(super) fn of_file(found: RowsThere) -> Self {
        Self {
            found,
            ..Self::default()
        }
    }

    /// Counts `row` of the sweep, the `number`-th from 0, if it holds no readouts.
    pub(super) fn add(&mut self, sweep: &Sweep, number: u64, row: &SweepRow) {
        if row.holds_readouts {
            return;
        }
        self.computed += 1;
        if self.told.len() < MOST {
            self.told.push(in_words(sweep, number, row));
        }
    }

    /// Says how many there are, and of the first few which points they are, and why.
    pub(super) fn tell(&self, sweep: &Sweep, interruption: &Interruption) {
        let count = self.found.empty() + self.computed;
        if count == 0 {
            return;
        }
        let all = sweep.rows();
        tell(format_args!(
            "gyrolab: rows without readouts: {count} of {all}"
        ));
        let found = self.found_in_words(sweep, interruption);
        let lines = found.iter().chain(&self.told).take(MOST);
        let told = lines
            .map(|line| tell(format_args!("  {}", printable_lines(line))))
            .count();
        match count - told as u64 {
            0 => {}
            more => tell(format_args!("  and {more} more")),
        }
    }

    /// The first few that were in the file, computed again for their reasons as far as there is time.
    fn found_in_words(&self, sweep: &Sweep, interruption: &Interruption) -> Vec<String> {
        let begin = Instant::now();
        let goes_on = || begin.elapsed() < PATIENCE && !interruption.has_come();
        let numbers = self.found.first_empty().iter().take(MOST);
        let line = |&number: &u64| match goes_on().then(|| sweep.row(number, &goes_on)).flatten() {
            Some(row) => in_words(sweep, number, &row),
            None => format!("{}: {NOT_FOUND_OUT}", sweep.point_in_words(number)),
        };
        numbers.map(line).collect()
    }
}

fn in_words(sweep: &Sweep, number: u64, row: &SweepRow) -> String {
    let why = row.failure.as_deref().unwrap_or(NOTHING_STATED);
    format!("{}: {why}", sweep.point_in_words(number))
}
