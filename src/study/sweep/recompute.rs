//! A sweep's CSV, computed again and held against what stands in it.

use super::grid::Sweep;
use super::in_order::in_order;
use crate::scenario::document::Document;
use crate::scenario::{Problem, Problems};
use std::fs::File;
use std::io::{self, BufRead, BufReader, Read};
use std::ops::ControlFlow;
use std::path::Path;

/// How a sweep's CSV stands beside what this program computes.
#[derive(Clone, Debug, PartialEq)]
pub enum Verdict {
    /// Every row has the same bytes.
    Same,
    /// A row has others.
    Differs(Difference),
    /// `go_on` said no.
    Stopped,
}

/// The first row that differs.
#[derive(Clone, Debug, PartialEq)]
pub struct Difference {
    /// Its number, from 1.
    pub row: u64,
    /// The line of the file, from 1.
    pub line: u64,
    /// The point, in words; empty behind the last one.
    pub point: String,
    /// What stands in the file, without the line end; `None` where the file ends before it.
    pub there: Option<String>,
    /// What is computed, likewise; `None` behind the last row.
    pub here: Option<String>,
}

/// A sweep's CSV, verified.
#[derive(Clone, Debug, PartialEq)]
pub struct Verified {
    /// The version that wrote it.
    pub version: Option<String>,
    /// How many rows the sweep has.
    pub rows: u64,
    /// How many of them are points that failed.
    pub failures: u64,
    /// How it stands.
    pub verdict: Verdict,
}

/// Computes every row of the sweep's CSV at `path` again, on all cores, and holds it against what stands there. `go_on` is
/// asked now and then whether to, and `show` is told how many rows of how many have been compared.
///
/// # Errors
/// When the file cannot be read, or is no sweep's CSV.
pub fn verify(
    path: &Path,
    go_on: &(dyn Fn() -> bool + Sync),
    mut show: impl FnMut(u64, u64),
) -> Result<Verified, Problems> {
    let document = Document::read(path)?;
    let cannot_read = |error: io::Error| {
        Problems::one(
            document.origin(),
            Problem::at("", format!("cannot be read: {error}")),
        )
    };
    let sweep = Sweep::open(&document)?;
    let version = document
        .table()
        .get("gyrolab")
        .and_then(toml::Value::as_str);
    let mut lines = Lines::open(path).map_err(cannot_read)?;
    let mut verified = Verified {
        version: version.map(str::to_owned),
        rows: sweep.rows(),
        failures: 0,
        verdict: Verdict::Same,
    };
    let header = sweep.header();
    let columns = header.lines().last().unwrap_or_default();
    if lines.columns != columns {
        let rule = format!("its columns are not those of its sweep file: {columns}");
        return Err(Problems::one(document.origin(), Problem::at("", rule)));
    }
    let (mut compared, mut failed) = (0, None);
    let of = |row: u64, goes_on: &dyn Fn() -> bool| sweep.row(row, &|| goes_on() && go_on());
    in_order(0..sweep.rows(), of, |rows| {
        for row in rows {
            verified.failures += u64::from(row.failure.is_some());
            match lines.next() {
                Ok(there) if there.as_deref() == Some(row.line.trim_end_matches('\n')) => {
                    compared += 1;
                }
                Ok(there) => {
                    verified.verdict = Verdict::Differs(Difference {
                        row: compared + 1,
                        line: lines.number,
                        point: sweep.point_in_words(compared),
                        there,
                        here: Some(row.line.trim_end_matches('\n').to_owned()),
                    });
                    return ControlFlow::Break(());
                }
                Err(error) => {
                    failed = Some(error);
                    return ControlFlow::Break(());
                }
            }
        }
        show(compared, sweep.rows());
        ControlFlow::Continue(())
    });
    if let Some(error) = failed {
        return Err(cannot_read(error));
    }
    if verified.verdict == Verdict::Same && compared < sweep.rows() {
        verified.verdict = Verdict::Stopped;
    } else if verified.verdict == Verdict::Same
        && let Some(there) = lines.next().map_err(cannot_read)?
    {
        verified.verdict = Verdict::Differs(Difference {
            row: compared + 1,
            line: lines.number,
            point: String::new(),
            there: Some(there),
            here: None,
        });
    }
    Ok(verified)
}

/// The rows of a CSV as they stand in it.
struct Lines {
    reader: BufReader<File>,
    /// The line of the columns' names.
    columns: String,
    /// The number of the line read last, from 1.
    number: u64,
}

impl Lines {
    /// Opens `path` and goes to its first row.
    fn open(path: &Path) -> io::Result<Self> {
        let mut lines = Self {
            reader: BufReader::new(File::open(path)?),
            columns: String::new(),
            number: 0,
        };
        while let Some(line) = lines.next()? {
            if !line.trim_start_matches('\u{feff}').starts_with('#') {
                lines.columns = line;
                break;
            }
        }
        Ok(lines)
    }

    fn next(&mut self) -> io::Result<Option<String>> {
        const LONGEST: u64 = 1 << 20;
        let mut line = Vec::new();
        (&mut self.reader)
            .take(LONGEST)
            .read_until(b'\n', &mut line)?;
        if line.is_empty() {
            return Ok(None);
        }
        self.number += 1;
        let line = line.strip_suffix(b"\n").unwrap_or(&line);
        Ok(Some(String::from_utf8_lossy(line).into_owned()))
    }
}
