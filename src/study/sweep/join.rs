//! One CSV of a sweep's shards.

use super::grid::Sweep;
use super::part::{PartError, is_writable, whole_rows};
use super::row::{KindOfRow, RowsThere};
use super::shard::Shard;
use super::there::kind_of_row;
use crate::export::Destination;
use crate::export::destination::DestinationError;
use crate::scenario::Problems;
use crate::scenario::document::Document;
use crate::study::sweep::difference::of_headers;
use crate::text::printable::Shown;
use crate::text::unread;
use std::fs::File;
use std::io::{self, BufRead, BufReader, BufWriter, Read, Write};
use std::os::unix::fs::FileExt;
use std::path::{Path, PathBuf};

/// Why shards cannot be joined.
#[derive(Debug, thiserror::Error)]
pub enum JoinError {
    /// A file that is no sweep's CSV.
    #[error(transparent)]
    Sweep(#[from] Problems),
    /// A file that is no shard of the sweep of the others, or not whole.
    #[error("{}: {why}", Shown(path))]
    Shard {
        /// The file.
        path: PathBuf,
        /// Why not.
        why: String,
    },
    /// Some are not there.
    #[error("the sweep has {of} shards, and {} missing: {}", if missing.len() == 1 { "one is" } else { "some are" }, numbers(missing))]
    Missing {
        /// How many there must be.
        of: u64,
        /// Those that are not.
        missing: Vec<u64>,
    },
    /// The file cannot be written.
    #[error(transparent)]
    Output(#[from] PartError),
    /// The file cannot be written.
    #[error(transparent)]
    Destination(#[from] DestinationError),
    /// A file cannot be read.
    #[error("{}: {}", Shown(path), unread::why(error))]
    Unread {
        /// The file.
        path: PathBuf,
        /// The system's error.
        error: io::Error,
    },
}

/// The first dozen of the numbers.
fn numbers(list: &[u64]) -> String {
    const MOST: usize = 12;
    let shown: Vec<_> = list.iter().take(MOST).map(u64::to_string).collect();
    match list.len().saturating_sub(MOST) {
        0 => shown.join(", "),
        more => format!("{} and {more} more", shown.join(", ")),
    }
}

/// A shard's file, read up to its first row.
struct Part {
    path: PathBuf,
    sweep: Sweep,
    rows: BufReader<Reopened>,
}

/// A file that is open only while bytes are read from it: a sweep may have more shards than files may be open at once.
struct Reopened {
    path: PathBuf,
    /// How many bytes have been read.
    at: u64,
}

impl Read for Reopened {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        let count = File::open(&self.path)?.read_at(bytes, self.at)?;
        self.at += count as u64;
        Ok(count)
    }
}

/// Writes to `path` the sweep whose shards are `parts`, in any order; the bytes are those of the sweep made at once. A file
/// that is there and has them already is left as it is. Gives the sweep and its rows.
///
/// # Errors
/// When the parts are not all shards of one sweep, whole, and each once, or the file cannot be written.
pub fn join(
    parts: &[PathBuf],
    path: &Path,
    may_replace: bool,
) -> Result<(Sweep, RowsThere), JoinError> {
    let mut parts = parts
        .iter()
        .map(|path| Part::open(path))
        .collect::<Result<Vec<_>, _>>()?;
    parts.sort_by_key(|part| part.sweep.shard().number());
    let whole = of_one_sweep(&parts)?;
    is_writable(path)?;
    if let Some(rows) = whole_rows(path, &whole, may_replace)? {
        return Ok((whole, rows));
    }
    let mut output = BufWriter::new(Destination::open_file(path, may_replace)?);
    let cannot_write = |error| DestinationError::Refused {
        path: path.to_owned(),
        error,
    };
    output
        .write_all(whole.header().as_bytes())
        .map_err(cannot_write)?;
    let of = parts.len() as u64;
    let (mut rows, mut line) = (RowsThere::default(), Vec::new());
    for point in 0..whole.points() {
        rows.add(parts[(point % of) as usize].next(point / of, &mut line)?);
        output.write_all(&line).map_err(cannot_write)?;
    }
    parts.iter_mut().try_for_each(Part::has_ended)?;
    let output = output.into_inner();
    output
        .map_err(|error| cannot_write(error.into_error()))?
        .keep()?;
    Ok((whole, rows))
}

/// The sweep whose shards `parts`, in the order of their numbers, are.
fn of_one_sweep(parts: &[Part]) -> Result<Sweep, JoinError> {
    let Some(first) = parts.first() else {
        return Err(JoinError::Missing {
            of: 1,
            missing: vec![1],
        });
    };
    let whole = first.sweep.clone().with_shard(Shard::WHOLE);
    let of = first.sweep.shard().of();
    for part in parts {
        let other = part.sweep.clone().with_shard(Shard::WHOLE);
        let differs = match part.sweep.shard().of() {
            count if count != of => format!("one is a shard of {of}, the other of {count}"),
            _ if other.header() == whole.header() => continue,
            _ => {
                let words = ["in it", "in the other"];
                of_headers(&other.file_lines(), &whole.file_lines(), words).to_string()
            }
        };
        return Err(part.fails(format!(
            "is no shard of the sweep of {}: {differs}",
            Shown(&first.path)
        )));
    }
    for pair in parts.windows(2) {
        if pair[0].sweep.shard() == pair[1].sweep.shard() {
            return Err(pair[1].fails(format!(
                "is shard {}, and so is {}",
                pair[1].sweep.shard(),
                Shown(&pair[0].path)
            )));
        }
    }
    let is_missing = |number: &u64| {
        let found = parts.binary_search_by_key(number, |part| part.sweep.shard().number());
        found.is_err()
    };
    let missing: Vec<_> = (1..=of).filter(is_missing).collect();
    match missing.is_empty() {
        true => Ok(whole),
        false => Err(JoinError::Missing { of, missing }),
    }
}

impl Part {
    fn open(path: &Path) -> Result<Self, JoinError> {
        let cannot_read = |error| JoinError::Unread {
            path: path.to_owned(),
            error,
        };
        let sweep = Sweep::open(&Document::read(path)?)?;
        let header = sweep.header();
        let mut rows = BufReader::new(Reopened {
            path: path.to_owned(),
            at: 0,
        });
        let mut there = Vec::new();
        let mut begin = (&mut rows).take(header.len() as u64);
        begin.read_to_end(&mut there).map_err(cannot_read)?;
        let part = Self {
            path: path.to_owned(),
            sweep,
            rows,
        };
        match there == header.as_bytes() {
            true => Ok(part),
            false => {
                let there = String::from_utf8_lossy(&there);
                let differs = of_headers(&there, &header, ["in it", "by this program"]);
                Err(part.fails(format!(
                    "its sweep file is not as this gyrolab writes it: {differs}"
                )))
            }
        }
    }

    fn fails(&self, why: String) -> JoinError {
        JoinError::Shard {
            path: self.path.clone(),
            why,
        }
    }

    fn next(&mut self, row: u64, line: &mut Vec<u8>) -> Result<KindOfRow, JoinError> {
        line.clear();
        let read = self.rows.read_until(b'\n', line);
        read.map_err(|error| JoinError::Unread {
            path: self.path.clone(),
            error,
        })?;
        match line.last() {
            Some(b'\n') => kind_of_row(line, &self.sweep, row).ok_or_else(|| {
                let (row, shard) = (row + 1, self.sweep.shard());
                self.fails(format!("its row {row} is no row of shard {shard}"))
            }),
            _ => {
                let (sweep, rows) = (&self.sweep, self.sweep.rows());
                Err(self.fails(format!(
                    "shard {} is not whole, it has {row} of {rows} rows: run its command again",
                    sweep.shard()
                )))
            }
        }
    }

    fn has_ended(&mut self) -> Result<(), JoinError> {
        match self.rows.fill_buf() {
            Ok([]) => Ok(()),
            Ok(_) => Err(self.fails("it has more rows than its shard".to_owned())),
            Err(error) => Err(JoinError::Unread {
                path: self.path.clone(),
                error,
            }),
        }
    }
}
