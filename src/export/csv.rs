//! A run as CSV: the run file in `# ` lines, one header line, then the rows. Each row is written when it is added, so that
//! memory does not grow with the run.

use super::columns::{COLUMNS, Row};
use crate::run::Sample;
use crate::scenario::Scenario;
use std::io::{self, Write};

/// Writes a run's CSV row by row.
#[derive(Debug)]
pub struct CsvWriter<W: Write> {
    rows: csv::Writer<W>,
    count: u64,
}

impl<W: Write> CsvWriter<W> {
    /// Begins a CSV on `out` with the run file of `scenario` and the header line.
    ///
    /// # Errors
    /// When `out` cannot be written.
    pub fn new(mut out: W, scenario: &Scenario) -> io::Result<Self> {
        out.write_all(commented(&scenario.to_toml()).as_bytes())?;
        let mut rows = csv::WriterBuilder::new()
            .has_headers(false)
            .from_writer(out);
        rows.write_record(COLUMNS.iter().map(|column| column.name))
            .map_err(plain)?;
        Ok(Self { rows, count: 0 })
    }

    /// Adds a row.
    ///
    /// # Errors
    /// When the row cannot be written.
    pub fn write(&mut self, sample: &Sample) -> io::Result<()> {
        self.rows.serialize(Row(sample)).map_err(plain)?;
        self.count += 1;
        Ok(())
    }

    /// How many rows have been added.
    pub fn count(&self) -> u64 {
        self.count
    }

    /// Writes what is still buffered, and returns the output.
    ///
    /// # Errors
    /// When the output cannot be written.
    pub fn finish(mut self) -> io::Result<W> {
        self.rows.flush()?;
        self.rows
            .into_inner()
            .map_err(csv::IntoInnerError::into_error)
    }
}

/// The system's error without csv's wrapping, which would hide its kind: a closed pipe is handled unlike a full disk.
fn plain(error: csv::Error) -> io::Error {
    match error.into_kind() {
        csv::ErrorKind::Io(error) => error,
        other => io::Error::other(format!("{other:?}")),
    }
}

/// `text` with "# " before every line, as the run file is written above the rows.
pub fn commented(text: &str) -> String {
    text.lines().flat_map(|line| ["# ", line, "\n"]).collect()
}
