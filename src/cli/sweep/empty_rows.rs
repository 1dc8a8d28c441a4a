//! The rows of a sweep without readouts, with the reasons: printed at the end of every command that writes or finds the file.

use crate::cli::tell;
use crate::study::sweep::{RowsThere, Sweep, SweepRow};
use crate::text::printable::printable_lines;

/// At most this many rows are named.
const MOST: usize = 8;

/// Where a run went well but none of the wanted numbers can be stated.
const NOTHING_STATED: &str = "none of its readouts can be stated";
/// Of a row that an earlier command has computed: a file does not say why a row is empty.
const NOT_KNOWN: &str = "gyrolab run with these values says why";

/// The rows without readouts: those that a file had before, and those that were computed now.
#[derive(Debug, Default)]
pub(super) struct EmptyRows {
    found: RowsThere,
    computed: u64,
    /// The first of those that were computed now, in words.
    told: Vec<String>,
}

impl EmptyRows {
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
    pub(super) fn tell(&self, sweep: &Sweep) {
        let count = self.found.empty() + self.computed;
        if count == 0 {
            return;
        }
        let all = sweep.rows();
        tell(format_args!(
            "gyrolab: rows without readouts: {count} of {all}"
        ));
        let found = self.found.first_empty().iter();
        let found = found.map(|row| format!("{}: {NOT_KNOWN}", sweep.point_in_words(*row)));
        let named: Vec<_> = found.chain(self.told.iter().cloned()).take(MOST).collect();
        for line in &named {
            tell(format_args!("  {}", printable_lines(line)));
        }
        if count > named.len() as u64 {
            tell(format_args!("  and {} more", count - named.len() as u64));
        }
    }
}

fn in_words(sweep: &Sweep, number: u64, row: &SweepRow) -> String {
    let why = row.failure.as_deref().unwrap_or(NOTHING_STATED);
    format!("{}: {why}", sweep.point_in_words(number))
}
