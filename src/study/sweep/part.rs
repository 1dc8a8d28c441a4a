//! The file of a sweep's rows while it is not whole, and the look at what is there before.
//!
//! Rows are appended to `FILE.part` in the order of the grid, whole lines at a time. What a kill leaves is therefore the
//! beginning of the whole file, and perhaps a torn line at its end. The same command goes on behind the last line that is
//! a row: it drops what follows. When all are there the file gets its name.

use super::grid::Sweep;
use super::row::{KindOfRow, RowsThere};
use crate::analysis::readouts::Readout;
use crate::export::Destination;
use crate::export::destination::is_workbook;
use crate::text::printable::{Shown, brief};
use crate::text::{unread, unwritten};
use std::ffi::OsString;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, BufRead, BufReader, Read, Seek, SeekFrom, Write};
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Rows are forced onto the disk at least this often: a crash of the machine costs no more.
const SYNC: Duration = Duration::from_secs(2);

/// Why a sweep's file cannot be written or gone on with.
#[derive(Debug, thiserror::Error)]
pub enum PartError {
    /// There is something else under the file's name.
    #[error(
        "{} is not the whole of this sweep: {why}; --force replaces it",
        Shown(path)
    )]
    Other {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        why: String,
    },
    /// There are the rows of another sweep under the name that these have until they are whole.
    #[error(
        "{} has the rows of another sweep: {why}; --force discards them",
        Shown(path)
    )]
    OtherPart {
        /// The part file.
        path: PathBuf,
        /// What differs.
        why: String,
    },
    /// Somebody else is at it.
    #[error("{} is being written by another gyrolab now", Shown(.0))]
    Busy(PathBuf),
    /// It is a folder, a device, a FIFO or the like, or its folder is not there.
    #[error("cannot write {}: {why}", Shown(path))]
    NotAFile {
        /// The path.
        path: PathBuf,
        /// Why not.
        why: &'static str,
    },
    /// What is there cannot be read.
    #[error("{}: {}", Shown(path), unread::why(error))]
    Unread {
        /// The file.
        path: PathBuf,
        /// The system's error.
        error: io::Error,
    },
    /// The system reported an error in writing.
    #[error("cannot write {}: {}", Shown(path), unwritten::why(error))]
    Refused {
        /// The file.
        path: PathBuf,
        /// The system's error.
        error: io::Error,
    },
}

/// What there is to do for a file.
#[derive(Debug)]
pub enum Opened {
    /// It is there, whole, and of this sweep; its rows.
    Whole(RowsThere),
    /// Rows are to be added.
    Part(PartFile),
}

/// The rows of a sweep while they are not all there.
#[derive(Debug)]
pub struct PartFile {
    file: File,
    /// Its name for now.
    path: PathBuf,
    /// The name that it gets when it is whole.
    last: PathBuf,
    may_replace: bool,
    rows: u64,
    /// Those that were there when it was opened.
    found: RowsThere,
    synced: Instant,
}

impl PartFile {
    /// Opens what is to become `path` with the rows of `sweep`; with `may_replace` even where the rows of something else are.
    ///
    /// # Errors
    /// When there is something else and may not be replaced, somebody else is writing, or the system reports an error.
    pub fn open(path: &Path, sweep: &Sweep, may_replace: bool) -> Result<Opened, PartError> {
        is_writable(path)?;
        if let Some(rows) = whole_rows(path, sweep, may_replace)? {
            return Ok(Opened::Whole(rows));
        }
        // A symbolic link is kept: the file to which it leads is replaced.
        let behind_link = if path.is_symlink() {
            fs::canonicalize(path).map_err(|error| unread(path, error))?
        } else {
            path.to_owned()
        };
        let path = behind_link.as_path();
        let part = part_of(path);
        is_writable(&part)?;
        let refused = |error| PartError::Refused {
            path: part.clone(),
            error,
        };
        let file = locked(&part)?;
        // Another process may have made it whole meanwhile.
        if let Some(rows) = whole_rows(path, sweep, may_replace)? {
            let _ = fs::remove_file(&part); // of which nothing but the name is left
            return Ok(Opened::Whole(rows));
        }
        let mut part = Self {
            file,
            path: part.clone(),
            last: path.to_owned(),
            may_replace,
            rows: 0,
            found: RowsThere::default(),
            synced: Instant::now(),
        };
        let there = There::of(&part.file, sweep).map_err(|error| unread(&part.path, error))?;
        if !may_replace && let Some(why) = there.other {
            return Err(PartError::OtherPart {
                path: part.path,
                why,
            });
        }
        part.file.set_len(there.bytes).map_err(refused)?;
        part.file.seek(SeekFrom::End(0)).map_err(refused)?;
        if there.bytes == 0 {
            part.write(sweep.header().as_bytes())?;
        }
        part.rows = there.rows.count();
        part.found = there.rows;
        Ok(Opened::Part(part))
    }

    /// The file's name for now.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// How many rows are in it.
    pub fn rows(&self) -> u64 {
        self.rows
    }

    /// The rows that were there when it was opened.
    pub fn found(&self) -> &RowsThere {
        &self.found
    }

    /// Adds `count` rows, which are whole `lines`.
    ///
    /// # Errors
    /// When they cannot be written. What was there before stays, and can be gone on with.
    pub fn add(&mut self, lines: &str, count: u64) -> Result<(), PartError> {
        self.write(lines.as_bytes())?;
        self.rows += count;
        if self.synced.elapsed() >= SYNC {
            self.file.sync_data().map_err(|error| self.refused(error))?;
            self.synced = Instant::now();
        }
        Ok(())
    }

    /// Gives the file, to which the last row has been added, its name.
    ///
    /// # Errors
    /// When the system reports an error, or another file has got that name meanwhile and may not be replaced.
    pub fn keep(self) -> Result<(), PartError> {
        self.file.sync_all().map_err(|error| self.refused(error))?;
        let named = if self.may_replace {
            fs::rename(&self.path, &self.last)
        } else {
            rename_to_new(&self.path, &self.last)
        };
        named.map_err(|error| PartError::Refused {
            path: self.last.clone(),
            error,
        })?;
        // The new name, too, is to outlive a crash of the machine; not every file system can do that.
        let _ = File::open(folder_of(&self.last)).and_then(|folder| folder.sync_all());
        Ok(())
    }

    fn write(&mut self, bytes: &[u8]) -> Result<(), PartError> {
        let written = self.file.write_all(bytes);
        written.map_err(|error| self.refused(error))
    }

    fn refused(&self, error: io::Error) -> PartError {
        PartError::Refused {
            path: self.path.clone(),
            error,
        }
    }
}

fn unread(path: &Path, error: io::Error) -> PartError {
    PartError::Unread {
        path: path.to_owned(),
        error,
    }
}

/// The name that the rows for `path` have until they are whole.
pub fn part_of(path: &Path) -> PathBuf {
    let mut name = OsString::from(path);
    name.push(".part");
    name.into()
}

/// Renames `from` to `to`, where there is nothing yet.
fn rename_to_new(from: &Path, to: &Path) -> io::Result<()> {
    match fs::hard_link(from, to) {
        Ok(()) => fs::remove_file(from),
        Err(error) if error.kind() == io::ErrorKind::AlreadyExists => Err(error),
        // A file system without links.
        Err(_) => fs::rename(from, to),
    }
}

/// Whether `path` is a regular file, or could become one.
pub(super) fn is_writable(path: &Path) -> Result<(), PartError> {
    let text = path.as_os_str().as_encoded_bytes();
    let has_name = path
        .file_name()
        .is_some_and(|name| text.ends_with(name.as_encoded_bytes()));
    let why = match fs::metadata(path) {
        _ if is_workbook(path) => "a sweep is written as CSV: let the name end in .csv",
        _ if Destination::is_for_stdout(path) => {
            "a sweep is not written to stdout, but to a file, in which it can be gone on with"
        }
        Ok(there) if there.is_dir() => "it is a folder: name a file in it",
        Ok(there) if !there.is_file() => {
            "it is not a regular file, and a sweep is kept in one, to be gone on with"
        }
        Ok(_) => return Ok(()),
        Err(_) if !has_name => "it is a folder: name a file in it",
        Err(_) if path.is_symlink() => "it is a symbolic link that leads nowhere",
        Err(_) if !folder_of(path).is_dir() => "there is no such folder",
        Err(_) => return Ok(()),
    };
    Err(PartError::NotAFile {
        path: path.to_owned(),
        why,
    })
}

fn folder_of(path: &Path) -> &Path {
    path.parent()
        .filter(|folder| !folder.as_os_str().is_empty())
        .unwrap_or(Path::new("."))
}

/// The rows in `path`, where all rows of `sweep` are there.
///
/// # Errors
/// When something else is there and may not be replaced.
pub(super) fn whole_rows(
    path: &Path,
    sweep: &Sweep,
    may_replace: bool,
) -> Result<Option<RowsThere>, PartError> {
    let unread = |error| unread(path, error);
    let file = match File::open(path) {
        Ok(file) => file,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
        Err(error) => return Err(unread(error)),
    };
    match There::of(&file, sweep).map_err(unread)?.whole(sweep) {
        Ok(rows) => Ok(Some(rows)),
        Err(_) if may_replace => Ok(None),
        Err(why) => Err(PartError::Other {
            path: path.to_owned(),
            why,
        }),
    }
}

/// Opens the part file, which nobody else may be writing.
fn locked(part: &Path) -> Result<File, PartError> {
    let refused = |error| PartError::Refused {
        path: part.to_owned(),
        error,
    };
    loop {
        let mut options = OpenOptions::new();
        options.read(true).write(true).create(true).truncate(false);
        let file = options.open(part).map_err(refused)?;
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => return Err(PartError::Busy(part.to_owned())),
            // Some file systems have no locks.
            Err(TryLockError::Error(_)) => return Ok(file),
        }
        // The one who had it may have given it its last name between the opening and the lock.
        let [ours, there] =
            [file.metadata(), fs::metadata(part)].map(|data| data.map(|data| data.ino()));
        if ours.map_err(refused)? == there.unwrap_or_default() {
            return Ok(file);
        }
    }
}

/// What stands in a file, held against a sweep.
pub(super) struct There {
    /// The rows at its beginning that are those of the sweep.
    rows: RowsThere,
    /// How many bytes they and the header take.
    bytes: u64,
    /// How many bytes there are.
    length: u64,
    /// Why what stands above the rows is not of this sweep.
    other: Option<String>,
}

impl There {
    /// Reads `file` up to the first line that is no row of `sweep`.
    pub(super) fn of(file: &File, sweep: &Sweep) -> io::Result<Self> {
        let mut there = Self {
            rows: RowsThere::default(),
            bytes: 0,
            length: file.metadata()?.len(),
            other: None,
        };
        let mut reader = BufReader::with_capacity(1 << 16, file);
        reader.rewind()?;
        let header = sweep.header();
        let mut begin = Vec::new();
        let mut above = (&mut reader).take(header.len() as u64);
        above.read_to_end(&mut begin)?;
        if begin != header.as_bytes() {
            if !header.as_bytes().starts_with(&begin) {
                there.other = first_difference(&String::from_utf8_lossy(&begin), &header);
            }
            return Ok(there);
        }
        let mut line = begin;
        loop {
            there.bytes += line.len() as u64;
            line.clear();
            reader.read_until(b'\n', &mut line)?;
            let row = there.rows.count();
            match kind_of_row(&line, sweep, row).filter(|_| row < sweep.rows()) {
                Some(kind) => there.rows.add(kind),
                None => break,
            }
        }
        Ok(there)
    }

    /// The rows, where they are all there and nothing else.
    ///
    /// # Errors
    /// What is wrong.
    pub(super) fn whole(self, sweep: &Sweep) -> Result<RowsThere, String> {
        let (rows, all) = (self.rows.count(), sweep.rows());
        let line = sweep.header().lines().count() as u64 + rows + 1;
        match self.other {
            Some(why) => Err(why),
            None if self.bytes == self.length && rows == all && self.bytes > 0 => Ok(self.rows),
            None if rows == all => Err("it has more than the rows of the sweep".to_owned()),
            None if self.bytes == self.length => Err(format!("it has {rows} of the {all} rows")),
            None => Err(format!("its line {line} is not row {} of {all}", rows + 1)),
        }
    }
}

/// What kind of row `line` is as the `row`-th of `sweep`, from 0; `None` where it cannot be that one: the values that vary
/// must be those of its point, and behind them stands a number or nothing for each readout, or text for one that is text.
fn kind_of_row(line: &[u8], sweep: &Sweep, row: u64) -> Option<KindOfRow> {
    let begin = sweep.row_begins(row);
    let rest = line.strip_suffix(b"\n")?.strip_prefix(begin.as_bytes())?;
    let mut cells = csv::StringRecord::new();
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .from_reader(rest);
    // A line of one empty cell is taken for none.
    if !reader.read_record(&mut cells).ok()? {
        cells.push_field("");
    }
    let fits = |(cell, readout): (&str, &&Readout)| {
        cell.is_empty()
            || readout.is_text
            || cell == "true"
            || cell == "false"
            || cell.parse().is_ok_and(f64::is_finite)
    };
    let is_row =
        cells.len() == sweep.measure().len() && cells.iter().zip(sweep.measure()).all(fits);
    let is_empty = cells.iter().all(str::is_empty);
    is_row.then_some(if is_empty {
        KindOfRow::Empty
    } else {
        KindOfRow::Filled
    })
}

/// The first line in which `there`, what stands above some rows, is not as `wanted`, in words.
pub(super) fn first_difference(there: &str, wanted: &str) -> Option<String> {
    const MOST_SHOWN: usize = 60;
    const BEFORE: usize = 30;
    let (mut lines, mut others) = (there.split('\n'), wanted.split('\n'));
    for number in 1.. {
        let (line, other) = match (lines.next(), others.next()) {
            (None, None) => return None,
            (line, other) => (line.unwrap_or_default(), other.unwrap_or_default()),
        };
        if line != other {
            let same = line.chars().zip(other.chars()).take_while(|(a, b)| a == b);
            let begin = same.count().saturating_sub(BEFORE);
            let shown =
                |line: &str| brief(&line.chars().skip(begin).collect::<String>(), MOST_SHOWN);
            let dots = if begin > 0 { "..." } else { "" };
            return Some(format!(
                "its line {number} is \"{dots}{}\", not \"{dots}{}\"",
                shown(line),
                shown(other)
            ));
        }
    }
    None
}
