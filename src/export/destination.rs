//! Where an export goes: a file that appears whole or not at all, or a stream.

use crate::text::printable::Shown;
use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::os::unix::fs::{MetadataExt, PermissionsExt, fchown};
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
    #[error("{} exists; --force replaces it", Shown(.0))]
    Exists(PathBuf),
    /// The name is that of a folder.
    #[error("{} is a folder: name a file in it", Shown(.0))]
    Folder(PathBuf),
    /// It is a device, a FIFO or a socket, where a file is wanted.
    #[error("cannot write {}: it is not a regular file, and could take no bytes for as long as it likes; gyrolab run -o writes to such", Shown(.0))]
    NotAFile(PathBuf),
    /// There is no folder to put the file in.
    #[error("cannot write {}: there is no folder {}", Shown(path), Shown(folder))]
    NoFolder {
        /// The place.
        path: PathBuf,
        /// The folder that is not there.
        folder: PathBuf,
    },
    /// The system refused.
    #[error("cannot write {}: {error}", Shown(path))]
    Refused {
        /// The place.
        path: PathBuf,
        /// What the system said.
        error: io::Error,
    },
}

impl DestinationError {
    /// What is wrong, without the remedy that only the command line has.
    pub fn fact(&self) -> String {
        match self {
            Self::Exists(path) => format!("{} exists", Shown(path)),
            other => other.to_string(),
        }
    }
}

impl Destination {
    /// Opens `path` for writing, before the long run begins; `-` is standard output. A device, a FIFO, and what the
    /// process was given open, such as `/dev/stdout`, are written as they are. An existing regular file is replaced
    /// only if `replace`, and only by a whole one.
    ///
    /// # Errors
    /// When it exists and is not to be replaced, is a folder, or the system refuses.
    pub fn open(path: &Path, replace: bool) -> Result<Self, DestinationError> {
        if Self::is_for_stdout(path) {
            return Ok(Self::Stdout(io::stdout()));
        }
        let mut options = OpenOptions::new();
        let is_stream = match (descriptor(path), fs::metadata(path)) {
            (Some(_), _) => {
                options.append(true); // what has been written to it stays
                true
            }
            (None, Ok(there)) => !there.is_file() && !there.is_dir(),
            (None, Err(_)) => false,
        };
        if !is_stream {
            return Self::open_file(path, replace);
        }
        let opened = options.write(true).open(path);
        opened
            .map(Self::Stream)
            .map_err(|error| DestinationError::Refused {
                path: path.to_owned(),
                error,
            })
    }

    /// The same for a regular file alone, for where nothing may wait and stdout is not to be written to; `-` is a name
    /// like others.
    ///
    /// # Errors
    /// When it exists and is not to be replaced, is anything but a regular file, or the system refuses.
    pub fn open_file(path: &Path, replace: bool) -> Result<Self, DestinationError> {
        let refused = |error| DestinationError::Refused {
            path: path.to_owned(),
            error,
        };
        match fs::metadata(path) {
            Ok(there) if there.is_dir() => Err(DestinationError::Folder(path.to_owned())),
            Err(_) if !names_a_file(path) => Err(DestinationError::Folder(path.to_owned())),
            Ok(there) if !there.is_file() => Err(DestinationError::NotAFile(path.to_owned())),
            _ if descriptor(path).is_some() => Err(DestinationError::NotAFile(path.to_owned())),
            Ok(_) if !replace => Err(DestinationError::Exists(path.to_owned())),
            // A link stays a link: the file it leads to is replaced.
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
        let temporary = tempfile::Builder::new()
            .prefix(".gyrolab-")
            .suffix(".part")
            .permissions(new_permissions())
            .tempfile_in(folder_of(&path))
            .map_err(|error| plain(&error))?;
        if let Ok(there) = fs::metadata(&path) {
            keep_rights(temporary.as_file(), &there)?;
        }
        Ok(Self::File {
            temporary,
            path,
            replace,
        })
    }

    /// How long a file has become so far, bytes; 0 for a stream.
    ///
    /// # Errors
    /// When the system does not tell.
    pub fn bytes(&self) -> io::Result<u64> {
        match self {
            Self::File { temporary, .. } => Ok(temporary.as_file().metadata()?.len()),
            Self::Stdout(_) | Self::Stream(_) => Ok(0),
        }
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

/// Gives the new `file` the rights of the one that it replaces and that was `there`, whatever the umask. Set-user-ID
/// and its like are never passed on; of a file that belongs to another user nothing is.
fn keep_rights(file: &File, there: &fs::Metadata) -> io::Result<()> {
    let new = file.metadata()?;
    if new.uid() != there.uid() {
        return Ok(());
    }
    let mut mode = there.mode() & 0o777;
    if new.gid() != there.gid() && fchown(file, None, Some(there.gid())).is_err() {
        // The new file's group is another one: it may do no more than others may.
        let of_others = (mode & 0o007) << 3;
        mode = mode & 0o707 | mode & of_others;
    }
    file.set_permissions(fs::Permissions::from_mode(mode))
}

/// The number of the open file that `path` names, by itself or through links, as `/dev/stdout` and `/dev/fd/3` do.
fn descriptor(path: &Path) -> Option<u32> {
    const MOST_LINKS: usize = 40;
    let own = fs::canonicalize("/proc/self/fd").ok();
    let mut path = path.to_owned();
    for _ in 0..MOST_LINKS {
        let folder = fs::canonicalize(folder_of(&path)).ok()?;
        let number = path.file_name()?.to_str()?.parse().ok();
        if number.is_some() && (folder == Path::new("/dev/fd") || Some(&folder) == own.as_ref()) {
            return number;
        }
        path = folder_of(&path).join(fs::read_link(&path).ok()?);
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

/// The rights of a new file are those the user's umask leaves.
fn new_permissions() -> fs::Permissions {
    fs::Permissions::from_mode(0o666)
}

/// The system's words without the temporary name, which means nothing to the user.
fn plain(error: &io::Error) -> io::Error {
    let text = error.to_string();
    let words = text.split(" at path ").next().unwrap_or(&text);
    io::Error::new(error.kind(), words.to_owned())
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
