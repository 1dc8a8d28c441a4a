//! The row of one point as it stands in the file, and the rows that are there.

use serde::Serialize;

/// One row of a sweep's CSV.
#[derive(Clone, Debug, PartialEq)]
pub struct SweepRow {
    /// The row as it stands in the file, with its line end.
    pub line: String,
    /// Whether at least one of its readouts has a value.
    pub holds_readouts: bool,
    /// Why it holds no readouts.
    pub failure: Option<String>,
}

/// Whether a row holds readouts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum KindOfRow {
    /// It holds at least one.
    Filled,
    /// All of them are missing, as where its point has failed.
    Empty,
}

/// The rows that stand in a file: how many there are, and which of them hold no readouts.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct RowsThere {
    count: u64,
    empty: u64,
    first_empty: Vec<u64>,
}

impl RowsThere {
    /// So many rows without readouts are kept by their number.
    const MOST_KEPT: usize = 8;

    /// How many rows there are.
    pub fn count(&self) -> u64 {
        self.count
    }

    /// How many of them hold no readouts.
    pub fn empty(&self) -> u64 {
        self.empty
    }

    /// The numbers of the first few that hold none, from 0.
    pub fn first_empty(&self) -> &[u64] {
        &self.first_empty
    }

    /// Counts the rows of `next` behind these.
    pub(super) fn append(&mut self, next: &Self) {
        let first = next.first_empty.iter().map(|row| self.count + row);
        let room = Self::MOST_KEPT - self.first_empty.len();
        self.first_empty
            .extend(first.take(room).collect::<Vec<_>>());
        self.count += next.count;
        self.empty += next.empty;
    }

    /// Counts the next row.
    pub(super) fn add(&mut self, kind: KindOfRow) {
        if kind == KindOfRow::Empty {
            self.empty += 1;
            if self.first_empty.len() < Self::MOST_KEPT {
                self.first_empty.push(self.count);
            }
        }
        self.count += 1;
    }
}

/// `cells` as one line of CSV.
pub(super) fn line(cells: &impl Serialize) -> String {
    let mut writer = csv::WriterBuilder::new()
        .has_headers(false)
        .from_writer(Vec::new());
    // Writing plain values to memory does not fail.
    let written = writer.serialize(cells).is_ok();
    let bytes = writer.into_inner().unwrap_or_default();
    debug_assert!(written);
    String::from_utf8(bytes).unwrap_or_default()
}
