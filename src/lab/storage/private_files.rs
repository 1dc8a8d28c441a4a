//! Files in a folder to which other users may be able to write: only regular files of the user's own are opened, no
//! symbolic link is followed, and no FIFO is waited for.

use crate::engine::export::temporary;
use rustix::fs::OFlags;
use rustix::io::Errno;
use std::fs::{DirBuilder, File, OpenOptions, Permissions};
use std::io::{self, Read, Write};
use std::os::unix::fs::{DirBuilderExt, MetadataExt, OpenOptionsExt, PermissionsExt};
use std::path::Path;

/// Opens the file at `path`. It is refused if it belongs to another user or is not a regular file.
pub(super) fn open(path: &Path, options: &mut OpenOptions) -> io::Result<File> {
    let file = open_regular(path, options)?;
    if file.metadata()?.uid() != rustix::process::geteuid().as_raw() {
        return Err(refused("it belongs to another user"));
    }
    Ok(file)
}

/// Opens the file at `path`, whoever owns it. It is refused if it is not a regular file.
pub(super) fn open_regular(path: &Path, options: &mut OpenOptions) -> io::Result<File> {
    let flags = OFlags::NOFOLLOW | OFlags::NONBLOCK;
    let opened = options.custom_flags(flags.bits() as i32).open(path);
    let file = opened.map_err(|error| match Errno::from_io_error(&error) {
        Some(Errno::LOOP) => refused("it is a symbolic link"),
        Some(Errno::NXIO | Errno::ISDIR) => refused("it is not a file"),
        _ => error,
    })?;
    if !file.metadata()?.is_file() {
        return Err(refused("it is not a file"));
    }
    Ok(file)
}

pub(super) fn refused(reason: &str) -> io::Error {
    io::Error::new(io::ErrorKind::PermissionDenied, reason)
}

/// Reads the file at `path`. It is refused as [`open`] refuses it, and if it has more than `most` bytes.
pub(super) fn read(path: &Path, most: usize) -> io::Result<Vec<u8>> {
    read_at_most(open(path, OpenOptions::new().read(true))?, most)
}

/// Reads the rest of `file`, which is refused, and read no further, if that has more than `most` bytes.
pub(super) fn read_at_most(file: File, most: usize) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    file.take(most as u64 + 1).read_to_end(&mut bytes)?;
    if bytes.len() > most {
        return Err(io::Error::other(format!("it is longer than {most} bytes")));
    }
    Ok(bytes)
}

/// Replaces the file at `path` by one that contains `text` and that is the user's alone. The file is complete at any
/// moment; where the new one cannot be written, the old one stays.
pub(super) fn replace(path: &Path, text: &str) -> io::Result<()> {
    replace_with_mode(path, text, 0o600)
}

/// The same with this mode, whatever the umask is.
pub(super) fn replace_with_mode(path: &Path, text: &str, mode: u32) -> io::Result<()> {
    let permissions = Permissions::from_mode(mode);
    let folder = path.parent().unwrap_or(Path::new("."));
    let mut file = temporary::file_in(folder, &permissions)?;
    file.as_file().set_permissions(permissions)?;
    file.as_file_mut().write_all(text.as_bytes())?; // whose errors do not speak of the temporary name
    file.persist(path)?;
    Ok(())
}

/// Creates the folder if it does not exist, accessible to the user alone.
pub(super) fn make_folder(folder: &Path) -> io::Result<()> {
    DirBuilder::new().recursive(true).mode(0o700).create(folder)
}
