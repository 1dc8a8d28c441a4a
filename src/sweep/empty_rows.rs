//! The rows of a sweep that hold no readouts, and why.

use super::grid::Sweep;
use std::time::{Duration, Instant};

/// Time for finding out why a row is empty: a file does not say it.
const PATIENCE: Duration = Duration::from_secs(1);

/// How many there are, and the first few, counted from 0, with their reasons where these are known.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct EmptyRows {
    pub count: u64,
    first: Vec<(u64, Option<String>)>,
}

impl EmptyRows {
    /// How many rows are named one by one.
    const MOST: usize = 8;

    pub fn add(&mut self, row: u64, why: Option<String>) {
        self.count += 1;
        if self.first.len() < Self::MOST {
            self.first.push((row, why));
        }
    }

    /// Adds those of another shard, whose first row is the row `begin` of all.
    pub(super) fn append(&mut self, shard: Self, begin: u64) {
        let count = self.count + shard.count;
        for (row, why) in shard.first {
            self.add(begin + row, why);
        }
        self.count = count;
    }

    /// The first few in words. Those whose reason is not known are computed again, as far as there is time and `goes_on`
    /// says yes.
    pub fn in_words(&self, sweep: &Sweep, goes_on: impl Fn() -> bool) -> Vec<String> {
        let begin = Instant::now();
        let goes_on = || begin.elapsed() < PATIENCE && goes_on();
        let again = |row: u64| goes_on().then(|| sweep.row(row, &goes_on)?.empty).flatten();
        let line = |(row, why): &(u64, Option<String>)| {
            let why = why.clone().or_else(|| again(*row));
            let why = why.unwrap_or_else(|| "gyrolab run with these values says why".to_owned());
            format!("{}: {why}", sweep.point_in_words(*row))
        };
        self.first.iter().map(line).collect()
    }
}
