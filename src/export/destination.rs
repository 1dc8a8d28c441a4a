//! Where an export goes: a file that appears whole or not at all, or a stream.

use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// A place that is being written to.
#[derive(Debug)]
pub enum Destination {
    /// Standard output.
    Stdout(io::Stdout),
    /// A device, FIFO or socket: written as it comes.
    Stream(File),
    /// A regular file, under a temporary name beside its place until it is whole.
    File {
        /// What has been written so far.
        temporary: NamedTempFile,
        /// The name it will have.
        path: PathBuf,
        /// Whether a file of that name may be replaced.
        replace: bool,
    },
}

/// Why a place cannot be written to.
#[derive(Debug, thiserror::Error)]
pub enum DestinationError {
    /// There is such a file, and it was not said that it may go.
    #[error("{} exists; --force replaces it", .0.display())]
    Exists(PathBuf),
    /// The name is that of a folder.
    #[error("{} is a folder: name a file in it", .0.display())]
    Folder(PathBuf),
    /// The system refused.
    #[error("cannot write {}: {error}", path.display())]
    Refused {
        /// The place.
        path: PathBuf,
        /// What the system said.
        error: io::Error,
    },
}

impl Destination {
    /// Opens `path` for writing, before the long run begins; `-` is standard output. An existing regular file is
    /// replaced only if `replace`, and only by a whole one.
    ///
    /// # Errors
    /// When it exists and is not to be replaced, is a folder, or the system refuses.
    pub fn open(path: &Path, replace: bool) -> Result<Self, DestinationError> {
        if path == Path::new("-") {
            return Ok(Self::Stdout(io::stdout()));
        }
        let refused = |error| DestinationError::Refused {
            path: path.to_owned(),
            error,
        };
        match fs::metadata(path) {
            Ok(there) if there.is_dir() => Err(DestinationError::Folder(path.to_owned())),
            Ok(there) if !there.is_file() => OpenOptions::new()
                .write(true)
                .open(path)
                .map(Self::Stream)
                .map_err(refused),
            Ok(_) if !replace => Err(DestinationError::Exists(path.to_owned())),
            // A link stays a link: the file it leads to is replaced.
            Ok(_) => Self::file(fs::canonicalize(path).map_err(refused)?, replace).map_err(refused),
            Err(_) if path.is_symlink() => {
                let error = io::Error::other("a symbolic link that leads nowhere");
                Err(refused(error))
            }
            Err(_) => Self::file(path.to_owned(), replace).map_err(refused),
        }
    }

    fn file(path: PathBuf, replace: bool) -> io::Result<Self> {
        let folder = path
            .parent()
            .filter(|folder| !folder.as_os_str().is_empty())
            .unwrap_or(Path::new("."));
        let mut builder = tempfile::Builder::new();
        builder.prefix(".gyrolab-").suffix(".part");
        if let Some(permissions) = permissions(&path) {
            builder.permissions(permissions);
        }
        let temporary = builder.tempfile_in(folder).map_err(|error| plain(&error))?;
        Ok(Self::File {
            temporary,
            path,
            replace,
        })
    }

    /// Whether this is standard output.
    pub fn is_stdout(&self) -> bool {
        matches!(self, Self::Stdout(_))
    }

    /// Gives what has been written its name.
    ///
    /// # Errors
    /// When the system refuses, or a file of that name has come up meanwhile and is not to be replaced.
    pub fn keep(mut self) -> Result<(), DestinationError> {
        let flushed = self.flush();
        match self {
            Self::File {
                temporary,
                path,
                replace,
            } => {
                let refused = |error| DestinationError::Refused {
                    path: path.clone(),
                    error,
                };
                flushed.map_err(refused)?;
                let kept = if replace {
                    temporary.persist(&path)
                } else {
                    temporary.persist_noclobber(&path)
                };
                match kept {
                    Ok(_) => Ok(()),
                    Err(failed) if failed.error.kind() == io::ErrorKind::AlreadyExists => {
                        Err(DestinationError::Exists(path))
                    }
                    Err(failed) => Err(DestinationError::Refused {
                        path,
                        error: failed.error,
                    }),
                }
            }
            Self::Stdout(_) | Self::Stream(_) => {
                flushed.map_err(|error| DestinationError::Refused {
                    path: PathBuf::from("the output"),
                    error,
                })
            }
        }
    }
}

/// The rights of a new file are those the user's umask leaves; one that is replaced keeps its own.
#[cfg(unix)]
fn permissions(path: &Path) -> Option<fs::Permissions> {
    use std::os::unix::fs::PermissionsExt;
    let kept = fs::metadata(path).ok().map(|there| there.permissions());
    Some(kept.unwrap_or_else(|| fs::Permissions::from_mode(0o666)))
}

#[cfg(not(unix))]
fn permissions(_: &Path) -> Option<fs::Permissions> {
    None
}

/// The system's words without the temporary name, which means nothing to the user.
fn plain(error: &io::Error) -> io::Error {
    match error.raw_os_error().or_else(|| inner_code(error)) {
        Some(code) => io::Error::from_raw_os_error(code),
        None => io::Error::from(error.kind()),
    }
}

fn inner_code(error: &io::Error) -> Option<i32> {
    let source = std::error::Error::source(error.get_ref()?)?;
    source.downcast_ref::<io::Error>()?.raw_os_error()
}

impl Write for Destination {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self {
            Self::Stdout(out) => out.write(bytes),
            Self::Stream(out) => out.write(bytes),
            Self::File { temporary, .. } => temporary.as_file_mut().write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match self {
            Self::Stdout(out) => out.flush(),
            Self::Stream(out) => out.flush(),
            Self::File { temporary, .. } => temporary.as_file_mut().flush(),
        }
    }
}
