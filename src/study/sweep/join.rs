//! One CSV of a sweep's shards.

use super::grid::Sweep;
use super::part::{PartError, There, first_difference, is_writable, whole_rows};
use super::row::RowsThere;
use super::shard::Shard;
use crate::export::Destination;
use crate::export::destination::DestinationError;
use crate::scenario::Problems;
use crate::scenario::document::Document;
use crate::text::printable::Shown;
use std::fs::File;
use std::io::{self, BufReader, Read, Seek, SeekFrom, Write};
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
    #[error("the sweep has {of} shards, and these are missing: {missing}")]
    Missing {
        /// How many there must be.
        of: u64,
        /// The first of those that are not there.
        missing: String,
    },
    /// The file cannot be written.
    #[error(transparent)]
    Output(#[from] PartError),
    /// The file cannot be written.
    #[error(transparent)]
    Destination(#[from] DestinationError),
}

fn fails(path: &Path, why: impl Into<String>) -> JoinError {
    JoinError::Shard {
        path: path.to_owned(),
        why: why.into(),
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
    let mut shards = Vec::new();
    for part in parts {
        shards.push((Sweep::open(&Document::read(part)?)?, part.as_path()));
    }
    shards.sort_by_key(|(sweep, _)| sweep.shard().number());
    let whole = of_one_sweep(&shards)?;
    is_writable(path)?;
    if let Some(rows) = whole_rows(path, &whole, may_replace)? {
        return Ok((whole, rows));
    }
    let mut output = Destination::open_file(path, may_replace)?;
    let cannot_write = |error| DestinationError::Refused {
        path: path.to_owned(),
        error,
    };
    output
        .write_all(whole.header().as_bytes())
        .map_err(cannot_write)?;
    let mut rows = RowsThere::default();
    for (sweep, part) in &shards {
        let (of_part, mut lines) = rows_of(sweep, part)?;
        rows.append(&of_part);
        io::copy(&mut lines, &mut output).map_err(cannot_write)?;
    }
    output.keep()?;
    Ok((whole, rows))
}

/// The sweep whose shards, in the order of their numbers, these are.
fn of_one_sweep(shards: &[(Sweep, &Path)]) -> Result<Sweep, JoinError> {
    const MOST_TOLD: usize = 12;
    let Some((first, first_path)) = shards.first() else {
        let missing = "all".to_owned();
        return Err(JoinError::Missing { of: 1, missing });
    };
    let of = first.shard().of();
    let whole = first.clone().with_shard(Shard::WHOLE);
    let mut last = 0;
    for (sweep, path) in shards {
        let other = sweep.clone().with_shard(Shard::WHOLE);
        let (shard, first) = (sweep.shard(), Shown(first_path));
        let differs = first_difference(&other.header(), &whole.header());
        if shard.of() != of {
            let why = format!("is shard {shard}, and {first} is one of {of}");
            return Err(fails(path, why));
        }
        if let Some(what) = differs {
            let why = format!("is no shard of the sweep of {first}: {what}");
            return Err(fails(path, why));
        }
        if shard.number() == last {
            return Err(fails(path, format!("is shard {shard}, and so is another")));
        }
        last = shard.number();
    }
    let is_missing = |number: &u64| {
        let found = shards.binary_search_by_key(number, |(sweep, _)| sweep.shard().number());
        found.is_err()
    };
    let mut missing: Vec<_> = (1..=of)
        .filter(is_missing)
        .take(MOST_TOLD + 1)
        .map(|number| number.to_string())
        .collect();
    if missing.is_empty() {
        return Ok(whole);
    }
    if missing.len() > MOST_TOLD {
        missing[MOST_TOLD] = "and more".to_owned();
    }
    let missing = missing.join(", ");
    Err(JoinError::Missing { of, missing })
}

/// The rows of the shard `sweep` in the file `path`, and what reads their lines.
fn rows_of(sweep: &Sweep, path: &Path) -> Result<(RowsThere, impl Read), JoinError> {
    let cannot_read = |error: io::Error| fails(path, error.to_string());
    let file = File::open(path).map_err(cannot_read)?;
    let rows = There::of(&file, sweep).map_err(cannot_read)?.whole(sweep);
    let rows = rows.map_err(|why| {
        let shard = sweep.shard();
        fails(
            path,
            format!("is not the whole shard {shard}: {why}; run its command again"),
        )
    })?;
    let mut lines = BufReader::new(file);
    let begin = SeekFrom::Start(sweep.header().len() as u64);
    lines.seek(begin).map_err(cannot_read)?;
    Ok((rows, lines))
}
