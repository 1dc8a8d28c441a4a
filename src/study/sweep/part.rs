//! The file of a sweep's rows while it is not whole, and the look at what is there before.
//!
//! Rows are appended to `FILE.part` in the order of the grid, whole lines at a time. What a kill leaves is therefore the
//! beginning of the whole file, and perhaps a torn line at its end. The same command drops that line, sees how many rows
//! there are, and goes on behind them. When all are there the file gets its name.

use super::difference::Differs;
use super::grid::Sweep;
use super::row::RowsThere;
use super::there::{There, look};
use crate::export::Destination;
use crate::export::destination::is_workbook;
use crate::text::printable::Shown;
use crate::text::{unread, unwritten};
use std::ffi::OsString;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, Seek, SeekFrom, Write};
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Rows are forced onto the disk at least this often: a crash of the machine costs no more.
const SYNC: Duration = Duration::from_secs(2);

/// Why a sweep's file cannot be written or gone on with.
#[derive(Debug, thiserror::Error)]
pub enum PartError {
    /// There is something else under the file's name.
    #[error("{} {what}; --force replaces it", Shown(path))]
    Other {
        /// The file.
        path: PathBuf,
        /// What it holds, beginning with a verb.
        what: String,
    },
    /// There are the rows of another sweep under the name that these have until they are whole.
    #[error(
        "{} has the rows of another sweep, which is not whole: {differs}; --force discards them",
        Shown(path)
    )]
    OtherPart {
        /// The part file.
        path: PathBuf,
        /// What differs.
        differs: Differs,
    },
    /// Behind rows of this sweep there is something else.
    #[error(
        "{} is damaged: its first {rows} rows are of this sweep, and the line behind them is none of its rows. \
         Remove that line and all below it, and the same command goes on behind row {rows}; --force begins again",
        Shown(path)
    )]
    Damaged {
        /// The part file.
        path: PathBuf,
        /// How many rows are good.
        rows: u64,
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
        let behind_link = match path.is_symlink() {
            true => fs::canonicalize(path).map_err(|error| unread(path, error))?,
            false => path.to_owned(),
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
        let there = look(&part.file, sweep).map_err(|error| unread(&part.path, error))?;
        match there {
            There::Rows(rows, bytes) => {
                part.file.set_len(bytes).map_err(refused)?;
                part.file.seek(SeekFrom::End(0)).map_err(refused)?;
                part.rows = rows.count();
                part.found = rows;
            }
            There::Damaged(rows) if !may_replace => {
                return Err(PartError::Damaged {
                    path: part.path,
                    rows,
                });
            }
            There::Other(differs) if !may_replace => {
                return Err(PartError::OtherPart {
                    path: part.path,
                    differs,
                });
            }
            There::Nothing | There::Damaged(_) | There::Other(_) => {
                part.file.set_len(0).map_err(refused)?;
                part.file.rewind().map_err(refused)?;
                part.write(sweep.header().as_bytes())?;
            }
        }
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
        let named = match self.may_replace {
            true => fs::rename(&self.path, &self.last),
            false => rename_to_new(&self.path, &self.last),
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
    let length = file.metadata().map_err(unread)?.len();
    let what = match look(&file, sweep).map_err(unread)? {
        There::Rows(rows, bytes) if rows.count() == sweep.rows() && bytes == length => {
            return Ok(Some(rows));
        }
        There::Rows(rows, _) => {
            let (rows, all) = (rows.count(), sweep.rows());
            format!("is not the whole of this sweep: it has {rows} of the {all} rows")
        }
        There::Damaged(rows) => {
            let row = rows + 1;
            format!("is not this sweep: its row {row} is no row of it")
        }
        There::Nothing => "is no sweep's CSV".to_owned(),
        There::Other(Differs::Sweep(key)) => format!("holds another sweep: {key}"),
        There::Other(Differs::Form(form)) => format!("is not this sweep: {form}"),
    };
    match may_replace {
        true => Ok(None),
        false => Err(PartError::Other {
            path: path.to_owned(),
            what,
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
