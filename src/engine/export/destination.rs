//! The output of an export: a file or a folder that appears only once it is complete, or a stream.

use super::temporary;
use crate::text::io_errors::unwritten;
use crate::text::printable::PrintablePath;
use std::ffi::{OsStr, OsString};
use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::os::unix::fs::{MetadataExt, PermissionsExt};
use std::path::{Path, PathBuf};
use tempfile::{NamedTempFile, TempDir};

#[derive(Debug)]
pub enum Destination {
    Stdout(io::Stdout),
    /// A device, FIFO or socket, which is written to directly.
    Stream(File, PathBuf),
    /// A regular file, which has a temporary name in the same folder until it is complete.
    File {
        temporary: NamedTempFile,
        path: PathBuf,
        /// Whether an existing file of that name may be replaced.
        replace: bool,
    },
}

#[derive(Debug, thiserror::Error)]
pub enum DestinationError {
    #[error("{} exists; --force replaces it", PrintablePath(.0))]
    Exists(PathBuf),
    #[error("{}: gyrolab writes CSV, and no workbook: let the name end in .csv (--excel makes it one that a double click opens)", PrintablePath(.0))]
    Workbook(PathBuf),
    #[error("{} is a folder: name a file in it", PrintablePath(.0))]
    Folder(PathBuf),
    #[error("{} is not a folder: name one that is empty or new", PrintablePath(.0))]
    NotAFolder(PathBuf),
    #[error("{} holds files; --force replaces those of the same names", PrintablePath(.0))]
    FolderInUse(PathBuf),
    #[error("cannot write {}: it is not a regular file but a device, a pipe or a socket, which may block; gyrolab run -o writes to such", PrintablePath(.0))]
    NotAFile(PathBuf),
    #[error(
        "cannot write {}: there is no folder {}",
        PrintablePath(path),
        PrintablePath(folder)
    )]
    NoFolder { path: PathBuf, folder: PathBuf },
    #[error("cannot write {}: {}", PrintablePath(path), unwritten(error))]
    Refused { path: PathBuf, error: io::Error },
}

impl DestinationError {
    pub fn refused(path: &Path, error: io::Error) -> Self {
        Self::Refused {
            path: path.to_owned(),
            error,
        }
    }

    /// The message without the advice that applies to the command line only.
    pub fn fact(&self) -> String {
        match self {
            Self::Exists(path) => format!("{} exists", PrintablePath(path)),
            other => other.to_string(),
        }
    }
}

/// Whether a file of that name would be taken for a workbook of a spreadsheet program.
pub fn is_workbook(path: &Path) -> bool {
    const ENDINGS: [&str; 4] = ["xlsx", "xls", "xlsm", "ods"];
    let ending = path.extension().map(OsStr::to_ascii_lowercase);
    ending.is_some_and(|ending| ENDINGS.iter().any(|other| ending == *other))
}

impl Destination {
    /// Opens `path` for writing; `-` is standard output. Devices, FIFOs and open file descriptors such as `/dev/stdout` are
    /// written to directly. An existing regular file is replaced only if `replace` is true, and only by a complete file.
    /// Call it before a long run, so that errors are reported early.
    pub fn open(path: &Path, replace: bool) -> Result<Self, DestinationError> {
        if Self::is_for_stdout(path) {
            return Ok(Self::Stdout(io::stdout()));
        }
        let is_descriptor = descriptor(path).is_some();
        if !is_descriptor && !Self::may_wait(path) {
            return Self::open_file(path, replace);
        }
        // What a descriptor already leads to is not overwritten.
        let mut options = OpenOptions::new();
        let opened = options
            .append(is_descriptor)
            .write(true)
            .open(path)
            .map_err(|error| DestinationError::refused(path, error))?;
        Ok(Self::Stream(opened, path.to_owned()))
    }

    /// As [`open`](Self::open), but for regular files only: for a caller that must neither wait for a reader nor write to
    /// standard output. `-` is an ordinary file name.
    pub fn open_file(path: &Path, replace: bool) -> Result<Self, DestinationError> {
        let refused = |error| DestinationError::refused(path, error);
        match fs::metadata(path) {
            _ if is_workbook(path) => Err(DestinationError::Workbook(path.to_owned())),
            Ok(there) if there.is_dir() => Err(DestinationError::Folder(path.to_owned())),
            Err(_) if !names_a_file(path) => Err(DestinationError::Folder(path.to_owned())),
            Ok(there) if !there.is_file() => Err(DestinationError::NotAFile(path.to_owned())),
            _ if descriptor(path).is_some() => Err(DestinationError::NotAFile(path.to_owned())),
            Ok(_) if !replace => Err(DestinationError::Exists(path.to_owned())),
            // A symbolic link is kept: the file to which it leads is replaced.
            Ok(_) => {
                let target = fs::canonicalize(path).map_err(refused)?;
                Self::file(target, replace).map_err(refused)
            }
            Err(_) if path.is_symlink() => {
                let error = io::Error::other("a symbolic link that leads nowhere");
                Err(refused(error))
            }
            Err(_) if !folder_of(path).is_dir() => Err(DestinationError::NoFolder {
                path: path.to_owned(),
                folder: folder_of(path).to_owned(),
            }),
            Err(_) => Self::file(path.to_owned(), replace).map_err(refused),
        }
    }

    /// Whether `path` means standard output.
    pub fn is_for_stdout(path: &Path) -> bool {
        path == Path::new("-") || descriptor(path) == Some(1)
    }

    /// Whether opening `path` may wait without end, as a FIFO waits for its reader.
    pub fn may_wait(path: &Path) -> bool {
        fs::metadata(path).is_ok_and(|there| !there.is_file() && !there.is_dir())
    }

    fn file(path: PathBuf, replace: bool) -> io::Result<Self> {
        let permissions = fs::Permissions::from_mode(0o666); // before the umask
        let file = temporary::file_in(folder_of(&path), &permissions)?;
        if let Ok(there) = fs::metadata(&path) {
            copy_permissions(file.as_file(), &there)?;
        }
        Ok(Self::File {
            temporary: file,
            path,
            replace,
        })
    }

    /// The present size of the file, bytes; 0 for a stream.
    pub fn bytes(&self) -> io::Result<u64> {
        match self {
            Self::File { temporary, .. } => Ok(temporary.as_file().metadata()?.len()),
            Self::Stdout(_) | Self::Stream(..) => Ok(0),
        }
    }

    /// Writes `bytes`, all that there is to write.
    pub fn write_whole(&mut self, bytes: &[u8]) -> Result<(), DestinationError> {
        let written = self.write_all(bytes);
        written.map_err(|error| self.refused(error))
    }

    /// Writes `bytes`, all that there is to write, and [`keep`](Self::keep)s them.
    pub fn write_and_keep(mut self, bytes: &[u8]) -> Result<(), DestinationError> {
        self.write_whole(bytes)?;
        self.keep()
    }

    fn refused(&self, error: io::Error) -> DestinationError {
        let path = match self {
            Self::File { path, .. } | Self::Stream(_, path) => path,
            Self::Stdout(_) => Path::new("stdout"),
        };
        DestinationError::refused(path, error)
    }

    /// Flushes the output and gives a temporary file its final name.
    pub fn keep(mut self) -> Result<(), DestinationError> {
        let flushed = self.flush();
        flushed.map_err(|error| self.refused(error))?;
        let Self::File {
            temporary,
            path,
            replace,
        } = self
        else {
            return Ok(());
        };
        let kept = if replace {
            temporary.persist(&path)
        } else {
            temporary.persist_noclobber(&path)
        };
        kept.map(|_| ()).map_err(|failed| match failed.error {
            error if error.kind() == io::ErrorKind::AlreadyExists => DestinationError::Exists(path),
            error => DestinationError::Refused { path, error },
        })
    }
}

/// Gives the new `file` the permissions of the file that it replaces (`there`), whatever the umask, where both have the
/// same owner and group. The set-ID and sticky bits are never copied.
fn copy_permissions(file: &File, there: &fs::Metadata) -> io::Result<()> {
    let new = file.metadata()?;
    if (new.uid(), new.gid()) != (there.uid(), there.gid()) {
        return Ok(());
    }
    file.set_permissions(fs::Permissions::from_mode(there.mode() & 0o777))
}

/// The file descriptor that `path` names, directly or through links, as `/dev/stdout` and `/dev/fd/3` do.
fn descriptor(path: &Path) -> Option<u32> {
    const MOST_LINKS: usize = 40;
    let own = fs::canonicalize("/proc/self/fd").ok();
    let mut place = path.to_owned();
    for _ in 0..MOST_LINKS {
        let folder = fs::canonicalize(folder_of(&place)).ok()?;
        let number = place.file_name()?.to_str()?.parse().ok();
        if number.is_some() && (folder == Path::new("/dev/fd") || Some(&folder) == own.as_ref()) {
            return number;
        }
        place = folder_of(&place).join(fs::read_link(&place).ok()?);
    }
    None
}

/// Whether `path` ends in a name, not in `/`, `/.` or `..`.
fn names_a_file(path: &Path) -> bool {
    let text = path.as_os_str().as_encoded_bytes();
    path.file_name()
        .is_some_and(|name| text.ends_with(name.as_encoded_bytes()))
}

fn folder_of(path: &Path) -> &Path {
    path.parent()
        .filter(|folder| !folder.as_os_str().is_empty())
        .unwrap_or(Path::new("."))
}

impl Destination {
    fn out(&mut self) -> &mut dyn Write {
        match self {
            Self::Stdout(out) => out,
            Self::Stream(out, _) => out,
            Self::File { temporary, .. } => temporary.as_file_mut(),
        }
    }
}

impl Write for Destination {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.out().write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out().flush()
    }
}

/// A folder that is being written, under a temporary name beside the place that it will have.
#[derive(Debug)]
pub struct OutputFolder {
    temporary: TempDir,
    path: PathBuf,
    replace: bool,
    _lock: File,
}

impl OutputFolder {
    /// Begins a folder that will be at `path`. One that is there already must be empty, unless `replace` is true: then its
    /// files of the same names are replaced, and its others stay.
    pub fn begin(folder: &Path, replace: bool) -> Result<Self, DestinationError> {
        let path: PathBuf = folder.components().collect(); // without a slash at its end
        let in_folder = folder_of(&path);
        if !in_folder.is_dir() {
            return Err(DestinationError::NoFolder {
                path: path.clone(),
                folder: in_folder.to_owned(),
            });
        }
        may_be_written(&path, replace)?;
        let permissions = fs::Permissions::from_mode(0o777); // before the umask
        let (temporary, lock) = temporary::folder_in(in_folder, &permissions)
            .map_err(|error| DestinationError::refused(&path, error))?;
        Ok(Self {
            temporary,
            path,
            replace,
            _lock: lock,
        })
    }

    pub fn path(&self) -> &Path {
        self.temporary.path()
    }

    /// Gives it its final name: the files written to it are complete. Returns the names of the files that were there before
    /// and are none of those, in their order.
    pub fn keep(self) -> Result<Vec<String>, DestinationError> {
        let refused = |error| DestinationError::refused(&self.path, error);
        may_be_written(&self.path, self.replace)?;
        if fs::rename(self.temporary.path(), &self.path).is_ok() {
            let _ = self.temporary.keep(); // its old name is gone already
            return Ok(Vec::new());
        }
        // There are files: each new one replaces the file of its name.
        fs::create_dir_all(&self.path).map_err(refused)?;
        let new = names(self.temporary.path()).map_err(refused)?;
        for name in &new {
            move_to(&self.temporary.path().join(name), &self.path.join(name)).map_err(refused)?;
        }
        Self::others(&self.path, &new).map_err(refused)
    }

    /// The names in `folder` that are none of `own`, in their order.
    pub fn others(folder: &Path, own: &[OsString]) -> io::Result<Vec<String>> {
        let mut others = names(folder)?;
        others.retain(|name| !own.contains(name));
        others.sort();
        Ok(others
            .iter()
            .map(|name| name.to_string_lossy().into_owned())
            .collect())
    }
}

fn names(folder: &Path) -> io::Result<Vec<OsString>> {
    let files = fs::read_dir(folder)?;
    files.map(|file| Ok(file?.file_name())).collect()
}

/// Moves a file or folder. If there is a folder at `to` already, the files of the moved one replace those of the same names.
fn move_to(from: &Path, to: &Path) -> io::Result<()> {
    if !(from.is_dir() && to.is_dir()) {
        return fs::rename(from, to);
    }
    for name in names(from)? {
        move_to(&from.join(&name), &to.join(&name))?;
    }
    Ok(())
}

fn may_be_written(path: &Path, replace: bool) -> Result<(), DestinationError> {
    let there = match fs::metadata(path) {
        Ok(there) => there,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(()),
        Err(error) => return Err(DestinationError::refused(path, error)),
    };
    if !there.is_dir() {
        return Err(DestinationError::NotAFolder(path.to_owned()));
    }
    let mut files = fs::read_dir(path).map_err(|error| DestinationError::refused(path, error))?;
    match files.next() {
        Some(_) if !replace => Err(DestinationError::FolderInUse(path.to_owned())),
        _ => Ok(()),
    }
}
