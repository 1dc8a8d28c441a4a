//! The file of a sweep's rows while it is not whole, and the look at what is there before.
//!
//! Rows are appended to `FILE.part` in the order of the grid, whole lines at a time. What a kill leaves is therefore the
//! beginning of the whole file, and perhaps a torn line at its end. The same command goes on behind the last line that is
//! a row: it drops what follows. When all are there the file gets its name.

use super::grid::{Reliability, Sweep, SweepRow};
use crate::engine::export::Destination;
use crate::engine::export::destination::{DestinationError, is_workbook};
use crate::engine::scenario::Problems;
use crate::engine::text::io_errors::{unread, unwritten};
use crate::engine::text::number::counted;
use crate::engine::text::printable::{PrintablePath, brief};
use std::ffi::OsString;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, BufRead, BufReader, Read, Seek, SeekFrom, Write};
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Rows are forced onto the disk at least this often: a crash of the machine costs no more.
const SYNC: Duration = Duration::from_secs(2);

/// No row is longer, in bytes: what is there instead is not read whole.
const LONGEST_ROW: u64 = 1 << 20;

/// Why a sweep's file cannot be written, gone on with, or joined.
#[derive(Debug, thiserror::Error)]
pub enum SweepFileError {
    #[error("{0}")]
    Refused(String),
    #[error(transparent)]
    Sweep(#[from] Problems),
    #[error(transparent)]
    Destination(#[from] DestinationError),
}

pub(super) fn refused(path: &Path, why: impl AsRef<str>) -> SweepFileError {
    SweepFileError::Refused(format!("{}: {}", PrintablePath(path), why.as_ref()))
}

pub(super) fn cannot_read(path: &Path, error: &io::Error) -> SweepFileError {
    SweepFileError::Refused(format!("{}: {}", PrintablePath(path), unread(error)))
}

pub(super) fn cannot_write(path: &Path, error: &io::Error) -> SweepFileError {
    let why = unwritten(error);
    SweepFileError::Refused(format!("cannot write {}: {why}", PrintablePath(path)))
}

/// Time for finding out why a row is empty: a file does not say it.
const EMPTY_ROW_LIMIT: Duration = Duration::from_secs(1);

/// What is to be said of the rows of a sweep when they are all there.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct RowTally {
    pub empty: EmptyRows,
    pub reliability: ReliabilityCount,
}

/// How many rows say that the numbers of their runs hold, do not hold, and that this is not known.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ReliabilityCount {
    pub reliable: u64,
    pub unreliable: u64,
    pub unknown: u64,
}

impl RowTally {
    /// Counts the row of that number, from 0; `why` says why it is empty, where it is and that is known.
    pub(super) fn add(
        &mut self,
        row: u64,
        is_empty: bool,
        why: Option<String>,
        reliability: Reliability,
    ) {
        if is_empty {
            self.empty.add(row, why);
        }
        let count = match reliability {
            Reliability::NotAsked => return,
            Reliability::Reliable => &mut self.reliability.reliable,
            Reliability::Unreliable => &mut self.reliability.unreliable,
            Reliability::Unknown => &mut self.reliability.unknown,
        };
        *count += 1;
    }

    /// Adds those of another shard, whose first row is the row `begin` of all.
    pub(super) fn append(&mut self, shard: Self, begin: u64) {
        self.empty.append(shard.empty, begin);
        self.reliability.reliable += shard.reliability.reliable;
        self.reliability.unreliable += shard.reliability.unreliable;
        self.reliability.unknown += shard.reliability.unknown;
    }
}

impl ReliabilityCount {
    /// Returns the counts in words; `None` where the rows do not say it.
    pub fn in_words(&self) -> Option<String> {
        let all = self.reliable + self.unreliable + self.unknown;
        let others = [
            ("not reliable", self.unreliable),
            ("not known", self.unknown),
        ];
        let others = others.iter().filter(|(_, count)| *count > 0);
        let others: String = others
            .map(|(words, count)| format!("; {words}: {count}"))
            .collect();
        (all > 0).then(|| {
            format!(
                "reliable: {} of {}{others}",
                self.reliable,
                counted(all, "run")
            )
        })
    }
}

/// How many rows hold no readouts, and the first few, counted from 0, with their reasons where these are known.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct EmptyRows {
    pub count: u64,
    first: Vec<(u64, Option<String>)>,
}

impl EmptyRows {
    /// How many rows are named one by one.
    const MOST: usize = 8;

    fn add(&mut self, row: u64, why: Option<String>) {
        self.count += 1;
        if self.first.len() < Self::MOST {
            self.first.push((row, why));
        }
    }

    /// Adds those of another shard, whose first row is the row `begin` of all.
    fn append(&mut self, shard: Self, begin: u64) {
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
        let has_time = || begin.elapsed() < EMPTY_ROW_LIMIT && goes_on();
        let lines = self.first.iter().map(|(row, known)| {
            let why = match known {
                Some(why) => Some(why.clone()),
                None if has_time() => sweep.row(*row, &has_time).and_then(|row| row.empty),
                None => None,
            };
            let why = why
                .as_deref()
                .unwrap_or("gyrolab run with these values says why");
            format!("{}: {why}", sweep.point_in_words(*row))
        });
        lines.collect()
    }
}

#[derive(Debug)]
pub enum Opened {
    /// It is there, whole, and of this sweep.
    Whole(RowTally),
    /// Rows are to be added.
    Part(PartialSweep),
}

/// The rows of a sweep while they are not all there.
#[derive(Debug)]
pub struct PartialSweep {
    file: File,
    pub path: PathBuf,
    /// The name that it gets when it is whole.
    last: PathBuf,
    may_replace: bool,
    pub rows: u64,
    /// What is to be said of them.
    pub tally: RowTally,
    synced: Instant,
}

impl PartialSweep {
    /// Opens what is to become `path` with the rows of `sweep`; with `may_replace` even where the rows of something else are.
    ///
    /// # Errors
    /// When there is something else and may not be replaced, somebody else is writing, or the system reports an error.
    pub fn open(path: &Path, sweep: &Sweep, may_replace: bool) -> Result<Opened, SweepFileError> {
        if let Some(tally) = whole(path, sweep, may_replace)? {
            return Ok(Opened::Whole(tally));
        }
        // A symbolic link is kept: the file to which it leads is replaced.
        let last = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
        let part_path = part_of(&last);
        is_writable(&part_path)?;
        let file = locked(&part_path)?;
        // Another process may have made it whole meanwhile.
        if let Some(tally) = whole(&last, sweep, may_replace)? {
            let _ = fs::remove_file(&part_path); // an empty file
            return Ok(Opened::Whole(tally));
        }
        let there =
            FoundRows::read(&file, sweep).map_err(|error| cannot_read(&part_path, &error))?;
        if !may_replace && let Some(why) = there.other {
            let why = format!("has the rows of another sweep: {why}; --force discards them");
            return Err(refused(&part_path, why));
        }
        let mut part = Self {
            file,
            path: part_path,
            last,
            may_replace,
            rows: there.rows,
            tally: there.tally,
            synced: Instant::now(),
        };
        let cut = part.file.set_len(there.bytes);
        let at_end = cut.and_then(|()| part.file.seek(SeekFrom::End(0)));
        at_end.map_err(|error| cannot_write(&part.path, &error))?;
        if there.bytes == 0 {
            part.write(&sweep.header())?;
        }
        Ok(Opened::Part(part))
    }

    pub fn add(&mut self, rows: Vec<SweepRow>) -> Result<(), SweepFileError> {
        let lines: String = rows.iter().map(|row| row.line.as_str()).collect();
        self.write(&lines)?;
        for row in rows {
            self.tally
                .add(self.rows, row.empty.is_some(), row.empty, row.reliability);
            self.rows += 1;
        }
        if self.synced.elapsed() >= SYNC {
            let synced = self.file.sync_data();
            synced.map_err(|error| cannot_write(&self.path, &error))?;
            self.synced = Instant::now();
        }
        Ok(())
    }

    /// Gives the file, to which the last row has been added, its name.
    pub fn keep(self) -> Result<(), SweepFileError> {
        let synced = self.file.sync_all();
        synced.map_err(|error| cannot_write(&self.path, &error))?;
        if !self.may_replace && self.last.exists() {
            return Err(DestinationError::Exists(self.last).into());
        }
        fs::rename(&self.path, &self.last).map_err(|error| cannot_write(&self.last, &error))
    }

    fn write(&mut self, text: &str) -> Result<(), SweepFileError> {
        let written = self.file.write_all(text.as_bytes());
        written.map_err(|error| cannot_write(&self.path, &error))
    }
}

/// The name that the rows for `path` have until they are whole.
pub fn part_of(path: &Path) -> PathBuf {
    let mut name = OsString::from(path);
    name.push(".part");
    name.into()
}

/// Refuses what is no regular file and could not become one.
fn is_writable(path: &Path) -> Result<(), SweepFileError> {
    if Destination::is_for_stdout(path) {
        let why =
            "a sweep is not written to stdout, but to a file, in which it can be gone on with";
        return Err(refused(path, why));
    }
    if is_workbook(path) {
        let why = "a sweep is written as CSV: let the name end in .csv";
        return Err(refused(path, why));
    }
    Destination::open_file(path, true)?;
    Ok(())
}

/// What is to be said of the rows in the file `path`, where it has all rows of `sweep`; `None` where it is not there, or is
/// something else that may be replaced.
pub(super) fn whole(
    path: &Path,
    sweep: &Sweep,
    may_replace: bool,
) -> Result<Option<RowTally>, SweepFileError> {
    is_writable(path)?;
    if !path.exists() {
        return Ok(None);
    }
    let found = File::open(path)
        .and_then(|file| FoundRows::read(&file, sweep))
        .map_err(|error| cannot_read(path, &error))?;
    match found.whole(sweep) {
        Ok(tally) => Ok(Some(tally)),
        Err(_) if may_replace => Ok(None),
        Err(why) => {
            let why = format!("is not the whole of this sweep: {why}; --force replaces it");
            Err(refused(path, why))
        }
    }
}

/// Opens the part file, which nobody else may be writing.
fn locked(part: &Path) -> Result<File, SweepFileError> {
    loop {
        let mut options = OpenOptions::new();
        options.read(true).write(true).create(true).truncate(false);
        let opened = options.open(part);
        let file = opened.map_err(|error| cannot_write(part, &error))?;
        // Some file systems have no locks.
        if let Err(TryLockError::WouldBlock) = file.try_lock() {
            return Err(refused(part, "is being written by another gyrolab now"));
        }
        // Another process may have renamed or removed its file between the opening and the lock.
        let metadata = file.metadata();
        let inode = metadata.map_err(|error| cannot_write(part, &error))?.ino();
        if fs::metadata(part).is_ok_and(|named| named.ino() == inode) {
            return Ok(file);
        }
    }
}

/// The content of a file, compared with a sweep.
#[derive(Default)]
pub(super) struct FoundRows {
    /// How many rows at its beginning are those of the sweep.
    pub rows: u64,
    tally: RowTally,
    /// How many bytes they and the header take.
    bytes: u64,
    /// How many bytes there are.
    length: u64,
    /// Why the header is not of this sweep.
    other: Option<String>,
}

impl FoundRows {
    /// Reads `file` up to the first line that is no row of `sweep`.
    pub(super) fn read(file: &File, sweep: &Sweep) -> io::Result<Self> {
        let mut there = Self {
            length: file.metadata()?.len(),
            ..Self::default()
        };
        let mut reader = BufReader::with_capacity(1 << 16, file);
        reader.rewind()?;
        let header = sweep.header();
        let mut line = Vec::new();
        let mut above = (&mut reader).take(header.len() as u64);
        above.read_to_end(&mut line)?;
        if line != header.as_bytes() {
            if !header.as_bytes().starts_with(&line) {
                there.other = first_difference(&String::from_utf8_lossy(&line), &header);
            }
            return Ok(there);
        }
        loop {
            there.bytes += line.len() as u64;
            line.clear();
            let mut one_row = (&mut reader).take(LONGEST_ROW);
            one_row.read_until(b'\n', &mut line)?;
            let is_one_more = there.rows < sweep.rows();
            let parsed = is_one_more.then(|| sweep.parse_row(there.rows, &line));
            let Some(readouts) = parsed.flatten() else {
                return Ok(there);
            };
            let is_empty = sweep.lacks_readouts(&readouts);
            let reliability = sweep.reliability(&readouts);
            there.tally.add(there.rows, is_empty, None, reliability);
            there.rows += 1;
        }
    }

    /// What is to be said of the rows, where all are there and nothing else.
    pub(super) fn whole(self, sweep: &Sweep) -> Result<RowTally, String> {
        let (rows, all) = (self.rows, sweep.rows());
        let line = sweep.header().lines().count() as u64 + rows + 1;
        match self.other {
            Some(why) => Err(why),
            None if self.bytes == self.length && rows == all && self.bytes > 0 => Ok(self.tally),
            None if rows == all => Err("it has more than the rows of the sweep".to_owned()),
            None if self.bytes == self.length => Err(format!("it has {rows} of the {all} rows")),
            None => Err(format!("its line {line} is not row {} of {all}", rows + 1)),
        }
    }
}

/// The first line in which the header `there` differs from the `wanted` one, in words.
pub(super) fn first_difference(there: &str, wanted: &str) -> Option<String> {
    const MOST_SHOWN: usize = 60;
    const ERROR_CONTEXT: usize = 30;
    let lines: [Vec<&str>; 2] = [there, wanted].map(|text| text.split('\n').collect());
    let mut all = 0..lines[0].len().max(lines[1].len());
    let at = all.find(|&at| lines[0].get(at) != lines[1].get(at))?;
    let differing = lines.map(|lines| lines.get(at).copied().unwrap_or_default());
    let pairs = differing[0].chars().zip(differing[1].chars());
    let same = pairs.take_while(|(a, b)| a == b);
    let begin = same.count().saturating_sub(ERROR_CONTEXT);
    let dots = if begin > 0 { "..." } else { "" };
    let [is, should_be] = differing.map(|line| {
        let rest: String = line.chars().skip(begin).collect();
        brief(&rest, MOST_SHOWN)
    });
    let line = at + 1;
    Some(format!(
        "its line {line} is \"{dots}{is}\", not \"{dots}{should_be}\""
    ))
}
