//! One CSV of a sweep's shards.

use super::file::Shard;
use super::grid::Sweep;
use super::part::{
    FoundRows, RowTally, SweepFileError, cannot_read, cannot_write, first_difference, refused,
    whole,
};
use crate::engine::export::Destination;
use crate::engine::scenario::document::Document;
use crate::engine::text::printable::PrintablePath;
use std::collections::BTreeSet;
use std::fs::File;
use std::io::{self, BufReader, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

/// Writes to `path` the sweep whose shards are `parts`, in any order; the bytes are those of the sweep made at once. A file
/// that is there and has them already is left as it is. Gives the sweep and what is to be said of its rows.
pub fn join(
    parts: &[PathBuf],
    path: &Path,
    may_replace: bool,
) -> Result<(Sweep, RowTally), SweepFileError> {
    let mut shards = Vec::new();
    for part in parts {
        shards.push((Sweep::open(&Document::read(part)?)?, part.as_path()));
    }
    shards.sort_by_key(|(sweep, _)| sweep.shard.number);
    let sweep = of_one_sweep(&shards)?;
    if let Some(tally) = whole(path, &sweep, may_replace)? {
        return Ok((sweep, tally));
    }
    let mut output = Destination::open_file(path, may_replace)?;
    let written = output.write_all(sweep.header().as_bytes());
    written.map_err(|error| cannot_write(path, &error))?;
    let (mut rows, mut tally) = (0, RowTally::default());
    for (shard, part) in &shards {
        let (of_shard, mut lines) = rows_of(shard, part)?;
        tally.append(of_shard, rows);
        rows += shard.rows();
        io::copy(&mut lines, &mut output).map_err(|error| cannot_write(path, &error))?;
    }
    output.keep()?;
    Ok((sweep, tally))
}

/// What is to be said of the rows in the file `path` of the whole `shard`, and a reader of its lines.
fn rows_of(shard: &Sweep, path: &Path) -> Result<(RowTally, impl Read), SweepFileError> {
    let (file, rows) = open_rows(path, shard).map_err(|error| cannot_read(path, &error))?;
    let tally = rows.whole(shard).map_err(|why| {
        let number = shard.shard;
        let rule = format!("is not the whole shard {number}: {why}; run its command again");
        refused(path, rule)
    })?;
    Ok((tally, file))
}

/// Opens `path` at its first row, and compares its rows with those of `shard`.
fn open_rows(path: &Path, shard: &Sweep) -> io::Result<(BufReader<File>, FoundRows)> {
    let file = File::open(path)?;
    let rows = FoundRows::read(&file, shard)?;
    let mut lines = BufReader::new(file);
    lines.seek(SeekFrom::Start(shard.header().len() as u64))?;
    Ok((lines, rows))
}

/// The sweep whose shards these are, all of them and each once.
fn of_one_sweep(shards: &[(Sweep, &Path)]) -> Result<Sweep, SweepFileError> {
    const MOST_MISSING_ROWS: usize = 12;
    let Some((first, first_path)) = shards.first() else {
        return Err(SweepFileError::Refused("there are no shards".to_owned()));
    };
    let (of, first_path) = (first.shard.of, PrintablePath(first_path));
    let whole = first.clone().with_shard(Shard::WHOLE);
    let mut numbers = BTreeSet::new();
    for (sweep, path) in shards {
        let shard = sweep.shard;
        let other = sweep.clone().with_shard(Shard::WHOLE).header();
        let why = if shard.of != of {
            format!("is shard {shard}, and {first_path} is one of {of}")
        } else if let Some(what) = first_difference(&other, &whole.header()) {
            format!("is no shard of the sweep of {first_path}: {what}")
        } else if !numbers.insert(shard.number) {
            format!("is shard {shard}, and so is another")
        } else {
            continue;
        };
        return Err(refused(path, why));
    }
    let mut missing = (1..=of).filter(|number| !numbers.contains(number));
    let named: Vec<_> = missing
        .by_ref()
        .take(MOST_MISSING_ROWS)
        .map(|number| number.to_string())
        .collect();
    if named.is_empty() {
        return Ok(whole);
    }
    let more = missing.next().map_or("", |_| ", and more");
    let why = format!(
        "the sweep has {of} shards, and these are missing: {}{more}",
        named.join(", ")
    );
    Err(SweepFileError::Refused(why))
}
